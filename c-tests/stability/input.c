/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Bad input: tolerances and iteration limits out of range, missing outputs, callbacks
 * that answer nonsense from the start, the same object twice, points and flat shapes.
 * Each has its documented code, leaves outputs alone where there is no answer, and
 * ends within a bounded number of calls. */

#include "categories.h"

#include <limits.h>

static int failed, asked;

static const unsigned long most_calls = 40000;

static void fail(const char *what, const entry_t *e, const answer_t *x)
{
    if (failed++ < 30) {
        printf("FAILED %s, %s: ", e->name, what);
        print_answer(stdout, x);
        printf("\n");
    }
}

static int is_extension(const entry_t *e) { return e->ask >= ASK_PENETRATION; }

static int is_verdict(const entry_t *e)
{
    return e->ask == ASK_MPR_INTERSECT || e->ask == ASK_GJK_INTERSECT || e->ask == ASK_MPR_INTERSECT_WARM;
}

static answer_t put(const entry_t *e, const shape_t *a, const shape_t *b, ccd_t *ccd)
{
    static const double along[3] = {0.6, 0, 0.8};
    answer_t x;
    asked++;
    x = ask_objects(e, a, b, ccd, along, most_calls);
    if (x.code == ANSWER_LOOP || x.code == ANSWER_CRASH || x.code > CCD_LIMIT || x.code < CCD_BAD_INPUT)
        fail("loop, crash or undocumented code", e, &x);
    if (x.touched)
        fail("outputs written without an answer", e, &x);
    return x;
}

/* Is an answer that claims to be one sound? */
static void check_sound(const char *what, const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b)
{
    if ((x->code != CCD_HIT && x->code != CCD_LIMIT) || is_verdict(e) || (e->ask == ASK_SEPARATE && x->depth == 0))
        return;
    if (!(fabs(sqrt(truth_dot3(x->dir, x->dir)) - 1) <= 4 * tolerance(TOL_UNIT)) || !isfinite(x->depth)) {
        fail(what, e, x);
        return;
    }
    if (e->ask != ASK_ALONG && !(fabs(x->depth - fmax(truth_value(a, b, x->dir), 0)) <= 2 * pair_noise(a, b)))
        fail(what, e, x);
}

static void nonsense_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    judge_count();
    (void)dir;
    out->v[0] = out->v[1] = out->v[2] = *(const ccd_real_t *)obj;
}

/* Apart, for two equal centres are an answer without any support point. */
static void nonsense_center1(const void *obj, ccd_vec3_t *out)
{
    (void)obj;
    out->v[0] = out->v[1] = out->v[2] = (ccd_real_t).1;
}

static void nonsense_center2(const void *obj, ccd_vec3_t *out)
{
    (void)obj;
    out->v[0] = out->v[1] = out->v[2] = (ccd_real_t).2;
}

/* A centre that is not finite, where all else is good. */
static void lost_center(const void *obj, ccd_vec3_t *out)
{
    shape_center(obj, out);
    out->v[obj != NULL] = (ccd_real_t)NAN;
}

static void far_center(const void *obj, ccd_vec3_t *out)
{
    shape_center(obj, out);
    out->v[2] = (ccd_real_t)HUGE_VAL;
}

static void bad_centers(const entry_t *e)
{
    static const ccd_center_fn center[3] = {shape_center, lost_center, far_center};
    const int unread = e->ask == ASK_GJK || e->ask == ASK_SEPARATE || e->ask == ASK_GJK_INTERSECT;
    int i, k;
    for (i = 0; i < 3; i++)
        for (k = 0; k < 3; k++) {
            const shape_t a = shape_box(1, 1, 1);
            shape_t b = shape_box(1, 1, 1);
            ccd_t ccd;
            answer_t x;
            shape_move(&b, .3, .2, .1);
            shape_query(&ccd);
            ccd.support1 = ccd.support2 = judge_support;
            ccd.center1 = center[i];
            ccd.center2 = center[k];
            x = put(e, &a, &b, &ccd);
            if (x.code != (unread || i + k == 0 ? CCD_HIT : is_extension(e) ? CCD_BAD_INPUT : CCD_MISS))
                fail("a centre that is not finite", e, &x);
        }
}

static void bad_numbers(const shape_t *a, const shape_t *b, int overlap, const entry_t *e)
{
    static const double tols[] = {0, -1, NAN, HUGE_VAL, 1e-300};
    static const unsigned long limits[] = {0, 1, 2, 10, ULONG_MAX};
    int i, k;
    shape_t sa = *a, sb = *b;
    ccd_t ccd;
    for (i = 0; i < 5; i++) {
        answer_t x;
        shape_query(&ccd);
        ccd.support1 = ccd.support2 = judge_support;
        ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)tols[i];
        x = put(e, &sa, &sb, &ccd);
        if (is_extension(e) && !(tols[i] >= 0)) {
            if (x.code != CCD_BAD_INPUT)
                fail("a negative or NaN tolerance is bad input", e, &x);
        } else if (tols[i] < HUGE_VAL && (overlap ? x.code != CCD_HIT && x.code != CCD_LIMIT : x.code != CCD_MISS)) {
            fail("wrong verdict at an odd tolerance", e, &x);
        }
        check_sound("unsound at an odd tolerance", e, &x, a, b);
    }
    for (i = 0; i < 5; i++)
        for (k = 0; k < 2; k++) {
            answer_t x;
            shape_query(&ccd);
            ccd.support1 = ccd.support2 = judge_support;
            ccd.max_iterations = limits[i];
            ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)(k ? 1e-4 : 1e-12);
            x = put(e, &sa, &sb, &ccd);
            if (overlap ? x.code == CCD_MISS && limits[i] == ULONG_MAX : x.code == CCD_HIT)
                fail("wrong verdict at a limit of iterations", e, &x);
            check_sound("unsound at a limit of iterations", e, &x, a, b);
        }
}

static void bad_callbacks(const entry_t *e)
{
    static const double values[] = {NAN, HUGE_VAL, -HUGE_VAL};
    int i, k;
    for (i = 0; i < 3; i++)
        for (k = 0; k < 3; k++) {
            ccd_real_t nonsense = (ccd_real_t)values[i];
            shape_t good = shape_box(1, 1, 1);
            const void *one = k == 1 ? (const void *)&good : &nonsense, *two = k == 0 ? (const void *)&good : &nonsense;
            ccd_t ccd;
            answer_t x;
            shape_query(&ccd);
            ccd.support1 = k == 1 ? judge_support : nonsense_support;
            ccd.support2 = k == 0 ? judge_support : nonsense_support;
            ccd.center1 = k == 1 ? shape_center : nonsense_center1;
            ccd.center2 = k == 0 ? shape_center : nonsense_center2;
            x = put(e, (const shape_t *)one, (const shape_t *)two, &ccd);
            if (x.code != (is_extension(e) ? CCD_BAD_INPUT : CCD_MISS))
                fail("a callback's point that is not finite", e, &x);
        }
    {
        /* a pose that is not finite */
        shape_t a = shape_box(1, 1, 1), b = shape_box(1, 1, 1);
        ccd_t ccd;
        answer_t x;
        shape_query(&ccd);
        ccd.support1 = ccd.support2 = judge_support;
        b.pos[1] = (ccd_real_t)NAN;
        x = put(e, &a, &b, &ccd);
        if (x.code != (is_extension(e) ? CCD_BAD_INPUT : CCD_MISS))
            fail("a pose that is not finite", e, &x);
    }
}

/* The same object twice, points, segments and polygons on and in each other. */
static void degenerate(const entry_t *e)
{
    static const ccd_real_t point[3] = {0, 0, 0};
    static const ccd_real_t segment[6] = {-1, 0, 0, 1, 0, 0};
    static const ccd_real_t square[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    shape_t shapes[8];
    int i, k;
    shapes[0] = shape_polytope(point, 1);
    shapes[1] = shape_polytope(segment, 2);
    shapes[2] = shape_polytope(square, 4);
    shapes[3] = shape_box(1, 1, 1);
    shapes[4] = shape_sphere(1);
    shapes[5] = shape_cylinder(1, 0);
    shapes[6] = shape_capsule(0, 1);
    shapes[7] = shape_ellipsoid(1, 0, 1);
    for (i = 0; i < 8; i++)
        for (k = 0; k < 8; k++) {
            truth_t t = truth_depth(&shapes[i], &shapes[k]);
            shape_t a = shapes[i], b = shapes[k];
            ccd_t ccd;
            answer_t x;
            shape_query(&ccd);
            ccd.support1 = ccd.support2 = judge_support;
            x = put(e, &a, i == k ? &a : &b, &ccd);
            if (t.lower > pair_noise(&a, &b) && x.code != CCD_HIT && !(x.code == CCD_LIMIT && is_extension(e)))
                fail("missed an overlap of points, flat shapes or one object twice", e, &x);
            check_sound("unsound for points or flat shapes", e, &x, &a, &b);
            if (entry_is_minimum(e) && x.code == CCD_HIT && x.depth > fmax(t.depth, 0) + 1e-4 + 2 * pair_noise(&a, &b))
                fail("not the minimum of points, flat shapes or one object twice", e, &x);
        }
}

/* Missing outputs: ccd.h allows them, one by one and all. */
static void missing_outputs(void)
{
    shape_t a = shape_box(1, 1, 1), b = shape_box(1, 1, 1);
    ccd_t ccd;
    int m, k;
    shape_move(&b, .3, .2, 1.9);
    shape_query(&ccd);
    for (m = 0; m < 8; m++)
        for (k = 0; k < 3; k++) {
            ccd_real_t depth = 0;
            ccd_vec3_t dir, pos;
            ccd_real_t *pd = m & 1 ? &depth : NULL;
            ccd_vec3_t *pn = m & 2 ? &dir : NULL, *pp = m & 4 ? &pos : NULL;
            int code;
            memset(&dir, 0, sizeof dir);
            if (k == 0)
                code = OURS(ccdMPRPenetration)(&a, &b, &ccd, pd, pn, pp);
            else if (k == 1)
                code = OURS(ccdGJKPenetration)(&a, &b, &ccd, pd, pn, pp);
            else
                code = OURS(ccdMPRPenetrationWarm)(&a, &b, &ccd, NULL, pd, pn, pp);
            asked++;
            if (code != 0 || (m & 1 && !(fabs((double)depth - .1) < 1e-3)) || (m & 2 && !(fabs((double)dir.v[2] - 1) < 1e-2))) {
                printf("FAILED missing outputs %d, function %d: code %d depth %g\n", m, k, code, (double)depth);
                failed++;
            }
        }
}

int main(void)
{
    int k, i;
    judge_begin();
    for (k = 0; k < (int)ENTRIES; k++) {
        const entry_t *e = &entries[k];
        static pair_t p;
        if (e->system)
            continue;
        for (i = 0; i < 40; i++) {
            category_pair(i % 2 ? CATEGORY_GENERIC : CATEGORY_APART, (uint64_t)i, SHAPE_TIE_SIGN, &p);
            bad_numbers(&p.a, &p.b, p.truth.depth > 0, e);
        }
        bad_callbacks(e);
        bad_centers(e);
        degenerate(e);
    }
    missing_outputs();
    printf("%d questions, %d failures\n", asked, failed);
    return failed > 0;
}
