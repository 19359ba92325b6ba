/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks that the status of a result is the cause of the end of its search, for a pair of each cause, and that the code
 * is CCD_LIMIT if and only if it is not CCD_STATUS_CONVERGED. */

#include "tests/contract/every_call.h"

#include <math.h>

/* Calls a query on overlapping objects from a cold state. Returns the status; depth and bound are in `results`. */
static int status_of(const call_t *call, shape_t *a, shape_t *b, const ccd_t *ccd, results_t *results)
{
    const call_args_t args = valid_arguments(call, results);
    const int code = call_library(call->number, a, b, ccd, &args);
    const int is_distance = call->kind == KIND_DISTANCE;
    const int status = is_distance ? results->distance.status : results->penetration.status;
    CHECK(code == (status == CCD_STATUS_CONVERGED ? CCD_HIT : CCD_LIMIT), "%s: code %d, status %d", call->name, code, status);
    return status;
}

/* Returns a query with this tolerance in every call. */
static ccd_t query(double tolerance)
{
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)tolerance;
    return ccd;
}

/* Returns two overlapping ellipsoids. */
static void ellipsoids(shape_t *a, shape_t *b)
{
    *a = shape_ellipsoid(1, 0.5, 0.3);
    *b = shape_ellipsoid(0.3, 0.6, 0.2);
    turn_at_random(b);
    shape_move(b, 0.2, 0.1, 0.1);
}

static void converged_or_at_the_iteration_limit(const call_t *call)
{
    results_t results;
    shape_t a, b;
    ccd_t ccd = query(1e-4);
    ellipsoids(&a, &b);
    CHECK(status_of(call, &a, &b, &ccd, &results) == CCD_STATUS_CONVERGED, "%s", call->name);
    ccd.max_iterations = 1;
    const int status = status_of(call, &a, &b, &ccd, &results);
    CHECK(status == CCD_STATUS_ITERATION_LIMIT, "%s: status %d after an iteration", call->name, status);
}

/* Concentric spheres: every direction is a minimum, and the proof would take 1 / tolerance support points. */
static void support_limit(const call_t *call)
{
    results_t results;
    shape_t a = shape_sphere(1), b = shape_sphere(0.5);
    const ccd_t ccd = query(1e-6);
    const int status = status_of(call, &a, &b, &ccd, &results);
    const int is_proof = call->number == CALL_PENETRATION || (call->traits & MAY_ALLOCATE);
    CHECK(status == (is_proof ? CCD_STATUS_SUPPORT_LIMIT : CCD_STATUS_CONVERGED), "%s: status %d", call->name, status);
    const ccd_penetration_t *p = &results.penetration;
    CHECK(call->kind == KIND_DISTANCE || (p->depth >= p->depth_lower && fabs((double)p->depth - 1.5) < 1e-4),
          "%s: depth %g", call->name, (double)p->depth);
}

/* Balls whose centers are this part of the sum of their radii apart, in random directions: returns how many of 100 end at the
 * support limit. */
static int nearly_concentric(const call_t *call, double part, double tolerance)
{
    int limits = 0;
    for (int i = 0; i < 100; i++) {
        results_t results;
        shape_t a = shape_sphere(1), b = shape_sphere(0.5);
        const ccd_t ccd = query(tolerance);
        ccd_vec3_t at;
        do
            at = random_vec3(1);
        while (!(ccdVec3Len2(&at) > (ccd_real_t)0.01));
        ccdVec3Normalize(&at);
        shape_move(&b, 1.5 * part * (double)at.v[0], 1.5 * part * (double)at.v[1], 1.5 * part * (double)at.v[2]);
        limits += status_of(call, &a, &b, &ccd, &results) == CCD_STATUS_SUPPORT_LIMIT;
    }
    return limits;
}

/* What <ccd/ccd.h> and <ccd/warm.h> call nearly concentric. */
static void balls_from_which_on_proofs_end(void)
{
    static const struct { int call; double part, tolerance; int is_limit; } rows[] = {
        {CALL_PENETRATION, 0.06, 1e-4, 1}, {CALL_PENETRATION, 0.08, 1e-4, 0}, {CALL_PENETRATION, 0.08, 1e-6, 0},
        {CALL_PROVEN, 0.04, 1e-4, 1},      {CALL_PROVEN, 0.05, 1e-4, 0},      {CALL_PROVEN, 0.09, 1e-6, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const int limits = nearly_concentric(&call_table[rows[i].call], rows[i].part, rows[i].tolerance);
        CHECK(limits == (rows[i].is_limit ? 100 : 0), "%s, %g of the radii apart, %g: %d of 100 at the limit",
              call_table[rows[i].call].name, rows[i].part, rows[i].tolerance, limits);
    }
}

/* At tolerance 0 the bounds often cannot meet: the ray is at a small angle to the face through which it leaves, and the
 * rounding of the face is divided by the sine. (In single precision they do: the library computes in double.) */
static void rounding(void)
{
    const ccd_t ccd = query(0);
    const call_t *call = &call_table[CALL_ALONG];
    int count[CCD_STATUS_INCONSISTENT_SUPPORT + 1] = {0};
    for (int i = 0; i < 200; i++) {
        results_t results;
        shape_t a = shape_box(1, 1, 0.02), b = shape_box(0.01, 0.02, 0.03);
        turn_at_random(&a);
        count[status_of(call, &a, &b, &ccd, &results)]++;
        CHECK(results.penetration.depth_lower > 0, "bound %g", (double)results.penetration.depth_lower);
    }
    CHECK(count[CCD_STATUS_ROUNDING] > 20 && count[CCD_STATUS_INCONSISTENT_SUPPORT] == 0,
          "%d of 200 ended by rounding, %d by a contradiction", count[CCD_STATUS_ROUNDING],
          count[CCD_STATUS_INCONSISTENT_SUPPORT]);
}

/* Moves the points of a shape by up to a tenth of its size, at random. */
static void noisy_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const ccd_vec3_t noise = random_vec3(0.1);
    shape_support(obj, dir, out);
    ccdVec3Add(out, &noise);
}

/* The paper's method does not notice a contradiction; it goes on up to the library's limit. */
static void inconsistent_support(const call_t *call)
{
    const int is_paper = call->number == CALL_INCREMENTAL || call->number == CALL_PLANAR;
    results_t results;
    shape_t a, b;
    ccd_t ccd = query(0);
    ccd.support1 = ccd.support2 = noisy_support;
    ellipsoids(&a, &b);
    const int status = status_of(call, &a, &b, &ccd, &results);
    CHECK(status == (is_paper ? CCD_STATUS_SUPPORT_LIMIT : CCD_STATUS_INCONSISTENT_SUPPORT), "%s: status %d", call->name, status);
    CHECK(call->kind == KIND_DISTANCE || results.penetration.depth_lower == 0, "%s: a bound", call->name);
}

int main(void)
{
    for (const call_t *call = call_table; call < call_table + PAIR_CALL_COUNT; call++) {
        if (call->kind != KIND_PENETRATION && call->kind != KIND_PENETRATION_ALONG && call->kind != KIND_DISTANCE)
            continue;
        for (int i = 0; i < 20; i++)
            converged_or_at_the_iteration_limit(call);
        support_limit(call);
        for (int i = 0; i < 20 && call->number != CALL_ALONG; i++)
            inconsistent_support(call);
    }
    if (sizeof(ccd_real_t) == sizeof(double)) {
        balls_from_which_on_proofs_end();
        rounding();
    }
    return checks_end();
}
