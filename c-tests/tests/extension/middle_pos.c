/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks libwarmccd-middle.so's functions beside the library's, on random pairs, overlapping and apart: the same codes and bits
 * of depth and direction; pos midway between the two support planes, for as many calls of the callbacks as without a pos.
 * And missing arguments and invalid tolerances. */

#include "harness/shapes.h"
#include "tests/contract/check.h"

#include <ccd/warm.h>

#define ccdMPRPenetration middle_mpr
#define ccdGJKPenetration middle_gjk
#include "../../../cmake/fcl/middle_pos.c"
#undef ccdMPRPenetration
#undef ccdGJKPenetration

typedef __typeof__(&ccdMPRPenetration) call_t;
static const call_t OF_LIBRARY[] = {ccdMPRPenetration, ccdGJKPenetration}, OF_MIDDLE[] = {middle_mpr, middle_gjk};

typedef struct {
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
} outputs_t;

static shape_t a, b;

/* Makes a call. Returns the calls of the callbacks. */
static unsigned long ask(call_t call, const ccd_t *ccd, int with_pos, int *code, outputs_t *out)
{
    memset(out, 7, sizeof *out);
    a.calls = b.calls = 0;
    *code = call(&a, &b, ccd, &out->depth, &out->dir, with_pos ? &out->pos : NULL);
    return a.calls + b.calls;
}

/* Returns by how much pos is off the plane midway between the support planes. */
static double off_midway(const ccd_t *ccd, const outputs_t *out)
{
    const ccd_vec3_t opposite = {{-out->dir.v[0], -out->dir.v[1], -out->dir.v[2]}};
    ccd_vec3_t p, q;
    ccd->support1(&a, &out->dir, &p);
    ccd->support2(&b, &opposite, &q);
    return fabs((double)(ccdVec3Dot(&out->dir, &out->pos) - (ccdVec3Dot(&out->dir, &p) + ccdVec3Dot(&out->dir, &q)) / 2));
}

static void check_same(const ccd_t *ccd, double tolerance, unsigned long hits[2], unsigned long saved[2])
{
    for (int i = 0; i < 2; i++) {
        int code, own_code;
        outputs_t out, own, all;
        const unsigned long without = ask(OF_LIBRARY[i], ccd, 0, &code, &out), with = ask(OF_LIBRARY[i], ccd, 1, &code, &all),
                            needed = ask(OF_MIDDLE[i], ccd, 1, &own_code, &own);
        CHECK(code == own_code, "%d and %d", code, own_code);
        CHECK(same_bits(&out.depth, &own.depth, sizeof own.depth) && same_bits(&out.dir, &own.dir, sizeof own.dir),
              "depths %g and %g", (double)out.depth, (double)own.depth);
        CHECK(needed == without, "%lu calls, %lu without pos", needed, without);
        saved[i] += with - needed;
        if (code == 0) {
            hits[i]++;
            /* Witness points lie on their planes within the error of the depth. */
            CHECK(off_midway(ccd, &own) <= fmax(tolerance, 1e-3 * (double)own.depth), "pos is %g m off", off_midway(ccd, &own));
        } else
            CHECK(same_bits(&out.pos, &own.pos, sizeof own.pos), "pos of a miss is written");
    }
}

static void check_arguments(const ccd_t *valid)
{
    static const double tolerances[] = {-1, NAN};
    unsigned long hits[2] = {0, 0}, saved[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        ccd_t ccd = *valid;
        int code, own_code;
        outputs_t out, own;
        CHECK(OF_MIDDLE[i](&a, &b, NULL, NULL, NULL, NULL) == -1, "no ccd");
        CHECK(OF_MIDDLE[i](&a, &b, &ccd, NULL, NULL, NULL) == 0, "no outputs");
        ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)tolerances[i];
        check_same(&ccd, 1e-4, hits, saved); /* the default */
        for (int missing = 0; missing < 4; missing++) {
            ccd = *valid;
            if (missing == 0)
                ccd.support2 = NULL;
            else if (missing == 1)
                ccd.center1 = NULL;
            else if (missing == 2)
                ccd.center2 = NULL;
            else
                ccd.first_dir = NULL;
            ask(OF_LIBRARY[i], &ccd, 0, &code, &out);
            ask(OF_MIDDLE[i], &ccd, 1, &own_code, &own);
            CHECK(code == own_code, "callback %d missing: %d and %d", missing, code, own_code);
        }
    }
}

int main(int argc, char **argv)
{
    const int pairs = argc > 1 ? atoi(argv[1]) : 2000;
    ccd_t ccd = shape_query();
    unsigned long hits[2] = {0, 0}, saved[2] = {0, 0};
    ccd.max_iterations = 500;
    for (int k = 0; k < pairs; k++) {
        const double tolerance = k % 2 ? 1e-3 : sizeof(ccd_real_t) == sizeof(float) ? 1e-5 : 1e-6;
        ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)tolerance;
        a = shape_make((shape_type_t)random_below(SHAPE_POLYTOPE), uniform(.2, .5), uniform(.2, .5), uniform(.2, .5));
        b = shape_make((shape_type_t)random_below(SHAPE_POLYTOPE), uniform(.2, .5), uniform(.2, .5), uniform(.2, .5));
        turn_at_random(&a);
        turn_at_random(&b);
        shape_move(&b, uniform(-.5, .5), uniform(-.5, .5), uniform(-.5, .5));
        check_same(&ccd, tolerance, hits, saved);
    }
    a = b = shape_box(1, 1, 1);
    shape_move(&b, 1.9, 0, 0);
    check_arguments(&ccd);
    printf("%lu and %lu hits of %d pairs, %.1f and %.1f calls of the callbacks less than with the library's pos\n", hits[0], hits[1],
           pairs, (double)saved[0] / (double)hits[0], (double)saved[1] / (double)hits[1]);
    CHECK(hits[0] > (unsigned long)pairs / 3 && saved[0] > hits[0] && saved[1] > hits[1], "few hits, or nothing saved");
    return checks_end();
}
