/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ccdCheck: every kind of fault by its flag, and none where nothing is wrong. (How large what is found
 * is, and finer faults: src/minkowski/validate.rs.) */

#include "tests/contract/check.h"
#include "harness/this_library.h"
#include "harness/shapes.h"

#include <math.h>

/* A ball of radius 0.5 with a fault. */
typedef struct {
    enum { FINE, AGAINST, NOT_A_NUMBER, TURNED, TIRED } fault;
    ccd_vec3_t at, center;
    unsigned long asked;
} odd_t;

static void odd_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    odd_t *s = (odd_t *)obj;
    const ccd_real_t half[3] = {(ccd_real_t).5, 1, 2};
    s->asked++;
    for (int i = 0; i < 3; i++) {
        const int other = (i + 1) % 3;
        switch (s->fault) {
        case AGAINST: out->v[i] = s->at.v[i] - dir->v[i] / 2; break;
        case NOT_A_NUMBER: out->v[i] = dir->v[2] > (ccd_real_t).9 ? (ccd_real_t)NAN : dir->v[i]; break;
        /* a box whose direction is turned to its frame and whose point is not turned back */
        case TURNED: out->v[i] = dir->v[other] < 0 ? -half[other] : half[other]; break;
        case TIRED: out->v[i] = s->at.v[i] + dir->v[i] * (s->asked > 200 ? (ccd_real_t).4 : (ccd_real_t).5); break;
        default: out->v[i] = s->at.v[i] + dir->v[i] / 2; break;
        }
    }
}

static void odd_center(const void *obj, ccd_vec3_t *out) { *out = ((const odd_t *)obj)->center; }

static void faults_have_names(void)
{
    const struct {
        int fault, at, centre, flags;
        const char *what;
    } rows[] = {
        {AGAINST, 3, 3, CCD_CHECK_OPPOSITE, "a wrong sign"},
        {NOT_A_NUMBER, 0, 0, CCD_CHECK_NOT_FINITE, "not finite"},
        {TURNED, 0, 0, CCD_CHECK_CONTRADICTS, "not turned back"},
        {FINE, 3, 0, CCD_CHECK_CENTER_OUTSIDE, "a centre in the body's own frame"},
        {TIRED, 3, 3, CCD_CHECK_CHANGES, "worse from call to call"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        odd_t s;
        ccd_check_t found;
        memset(&s, 0, sizeof s);
        s.fault = rows[i].fault;
        s.at.v[0] = (ccd_real_t)rows[i].at;
        s.center.v[0] = (ccd_real_t)rows[i].centre;
        int flags = OURS(ccdCheck)(&s, odd_support, odd_center, &found);
        CHECK(rows[i].fault == TIRED ? (flags & CCD_CHECK_CHANGES) != 0 : flags == rows[i].flags, "%s: %d", rows[i].what, flags);
        CHECK((flags == 0) == (OURS(ccdCheck)(&s, odd_support, odd_center, NULL) == 0) || rows[i].fault == TIRED, "%s, no out",
              rows[i].what);
    }
}

static void without_what_is_needed(void)
{
    odd_t s;
    ccd_check_t found, before;
    memset(&s, 0, sizeof s);
    memset(&found, 7, sizeof found);
    before = found;
    CHECK(OURS(ccdCheck)(&s, NULL, odd_center, &found) == CCD_BAD_INPUT, "no support function");
    CHECK(same_bits(&found, &before, sizeof found), "written");
    CHECK(OURS(ccdCheck)(&s, odd_support, NULL, &found) == CCD_CHECK_CENTER_MISSING, "no centre");
    CHECK(found.size > .99 && found.size <= 1.000001, "size %g", (double)found.size);
}

/* Every shape of the tests, anywhere and of any size. */
static void nothing_is_wrong(void)
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
    faults_have_names();
    without_what_is_needed();
    nothing_is_wrong();
    return checks_end();
}
