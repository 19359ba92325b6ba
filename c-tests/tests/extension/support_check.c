/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks that ccdCheck reports each kind of fault by its flag, and none of a valid support function. (Finer faults and
 * their sizes: src/minkowski/validate.rs.) */

#include "tests/contract/check.h"
#include "harness/this_library.h"
#include "harness/shapes.h"

#include <math.h>

typedef enum { NO_FAULT, WRONG_SIGN, NOT_FINITE, NOT_TURNED_BACK, CHANGING } fault_t;

/* Ball of radius 0.5 with a fault. */
typedef struct {
    fault_t fault;
    ccd_real_t x, center; /* along the x axis */
    unsigned long calls;
} faulty_t;

static void faulty_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    faulty_t *s = (faulty_t *)obj;
    const ccd_real_t half[3] = {CCD_REAL(0.5), 1, 2};
    ccd_real_t radius = CCD_REAL(0.5);
    if (s->fault == WRONG_SIGN)
        radius = -radius;
    if (s->fault == CHANGING && ++s->calls > 200)
        radius = CCD_REAL(0.4);
    for (int i = 0; i < 3; i++) {
        out->v[i] = (i == 0 ? s->x : 0) + radius * dir->v[i];
        if (s->fault == NOT_FINITE && dir->v[2] > CCD_REAL(0.9))
            out->v[i] = (ccd_real_t)NAN;
        /* a box: the direction is turned to its frame, the point is not turned back */
        if (s->fault == NOT_TURNED_BACK)
            out->v[i] = dir->v[(i + 1) % 3] < 0 ? -half[(i + 1) % 3] : half[(i + 1) % 3];
    }
}

static void faulty_center(const void *obj, ccd_vec3_t *out) { ccdVec3Set(out, ((const faulty_t *)obj)->center, 0, 0); }

static void check_faults(void)
{
    const struct {
        faulty_t object;
        int flags;
        const char *name;
    } rows[] = {
        {{WRONG_SIGN, 3, 3, 0}, CCD_CHECK_OPPOSITE, "a wrong sign"},
        {{NOT_FINITE, 0, 0, 0}, CCD_CHECK_NOT_FINITE, "not finite"},
        {{NOT_TURNED_BACK, 0, 0, 0}, CCD_CHECK_CONTRADICTS, "not turned back"},
        {{NO_FAULT, 3, 0, 0}, CCD_CHECK_CENTER_OUTSIDE, "a center in the body's own frame"},
        {{CHANGING, 3, 3, 0}, CCD_CHECK_CHANGES, "changes between calls"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int has_output = 0; has_output < 2; has_output++) {
            faulty_t s = rows[i].object;
            ccd_check_t found;
            const int flags = OURS(ccdCheck)(&s, faulty_support, faulty_center, has_output ? &found : NULL);
            CHECK(s.fault == CHANGING ? (flags & rows[i].flags) != 0 : flags == rows[i].flags, "%s: %d", rows[i].name, flags);
        }
}

static void check_missing_callbacks(void)
{
    faulty_t s = {NO_FAULT, 0, 0, 0};
    ccd_check_t found, before;
    memset(&found, 7, sizeof found);
    before = found;
    CHECK(OURS(ccdCheck)(&s, NULL, faulty_center, &found) == CCD_BAD_INPUT, "no support function");
    CHECK(same_bits(&found, &before, sizeof found), "written");
    CHECK(OURS(ccdCheck)(&s, faulty_support, NULL, &found) == CCD_CHECK_CENTER_MISSING, "no center");
    CHECK(found.size > .99 && found.size <= 1.000001, "size %g", (double)found.size);
}

/* Checks every shape of the tests in several sizes. */
static void check_valid_shapes(void)
{
    static const ccd_real_t points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, (ccd_real_t).5, (ccd_real_t).5, (ccd_real_t).5};
    for (int type = 0; type < SHAPE_TYPES; type++)
        for (int scale = -6; scale <= 6; scale += 3) {
            const double x = pow(10, scale);
            double rot[9];
            ccd_check_t found;
            if (type == SHAPE_POLYTOPE && scale != 0)
                continue;
            shape_t s = type == SHAPE_POLYTOPE ? shape_polytope(points, 5) : shape_make((shape_type_t)type, x, .3 * x, 1e-3 * x);
            rotation_about(1, 2, -3, 1.1, rot);
            shape_turn(&s, rot);
            shape_move(&s, 4 * x, -70 * x, x);
            int flags = OURS(ccdCheck)(&s, shape_support, shape_center, &found);
            CHECK(flags == 0, "type %d, size %g: %d, noise %g, outside %g", type, x, flags, (double)found.noise,
                  (double)found.center_outside);
        }
}

int main(void)
{
    check_faults();
    check_missing_callbacks();
    check_valid_shapes();
    return checks_end();
}
