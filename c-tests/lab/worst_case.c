/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints what a query costs at worst: callbacks and microseconds of random pairs, the mean, the
 * 99.9th percentile and the largest, of each call of this library and, where it is linked, of libccd.
 *
 *   worst_case QUERIES [SEED]
 *
 * Pairs of all shapes, sizes over a factor of 20, depths from a touch to one centre in another,
 * tolerance 1e-6 m, at most 500 iterations. A time above 20 us is the least of four: another
 * process' turn is no cost of a query. */

#define _POSIX_C_SOURCE 199309L
#include "harness/random.h"
#include "harness/this_library.h"

#include <stdio.h>
#include <time.h>

enum { HULL_VERTICES = 60 };
static const double REPEAT_ABOVE = 20; /* microseconds */

typedef struct {
    const char *name;
    int is_libccd, call, has_pos, is_warm;
    float *callbacks, *micros; /* of each query */
} method_t;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

/* Makes a shape of a random type, size and orientation; verts holds the vertices of a hull. */
static shape_t random_shape(ccd_real_t *verts)
{
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = 0.05 * exp(uniform(0, 3));
    const int type = (int)uniform(0, SHAPE_TYPES);
    if (type != SHAPE_POLYTOPE)
        return shape_make(type, p[0], p[1], p[2]);
    for (int i = 0; i < HULL_VERTICES; i++) {
        double x[3], length;
        do {
            x[0] = uniform(-1, 1), x[1] = uniform(-1, 1), x[2] = uniform(-1, 1);
            length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        } while (length > 1 || length < 0.1);
        for (int k = 0; k < 3; k++)
            verts[3 * i + k] = (ccd_real_t)(p[k] * x[k] / length);
    }
    return shape_polytope(verts, HULL_VERTICES);
}

/* Returns the distance of the support plane along x, or with sign -1 against it, from the centre. */
static double reach_along_x(const shape_t *s, double sign)
{
    const ccd_vec3_t dir = {{(ccd_real_t)sign, 0, 0}};
    ccd_vec3_t support, center;
    shape_support(s, &dir, &support);
    shape_center(s, &center);
    return sign * (double)(support.v[0] - center.v[0]);
}

static void query(const method_t *m, const shape_t *a, const shape_t *b, const ccd_t *ccd, ccd_warm_t *warm)
{
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    ccd_penetration_t penetration;
    ccd_distance_t distance;
    const call_args_t args = {.depth = &depth, .dir = &dir, .pos = m->has_pos ? &pos : NULL, .penetration = &penetration,
                              .distance = &distance, .max_distance = (ccd_real_t)HUGE_VAL, .warm = m->is_warm ? warm : NULL,
                              .want = m->has_pos ? CCD_WANT_ALL : CCD_WANT_POINTS};
    (m->is_libccd ? call_libccd : call_library)(m->call, a, b, ccd, &args);
}

static void measure(method_t *m, long k, const shape_t *a, const shape_t *b, const ccd_t *ccd, const ccd_warm_t *state)
{
    const unsigned long before = a->calls + b->calls;
    double least = HUGE_VAL;
    for (int turn = 0; turn < 4 && (turn == 0 || least > REPEAT_ABOVE); turn++) {
        ccd_warm_t warm = *state;
        const double start = now();
        query(m, a, b, ccd, &warm);
        least = fmin(least, now() - start);
        if (turn == 0)
            m->callbacks[k] = (float)(a->calls + b->calls - before);
    }
    m->micros[k] = (float)least;
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Prints the mean, the 99.9th percentile and the largest. */
static void print_costs(float *costs, long n, int digits)
{
    double sum = 0;
    for (long k = 0; k < n; k++)
        sum += (double)costs[k];
    qsort(costs, (size_t)n, sizeof *costs, compare_floats);
    printf(" %.*f | %.*f | %.0f |", digits + 1, sum / (double)n, digits, (double)costs[n - 1 - n / 1000], (double)costs[n - 1]);
}

int main(int argc, char **argv)
{
    static method_t methods[] = {
#ifndef OURS_ALONE
        {"libccd `ccdMPRPenetration`", 1, CALL_MPR, 1, 0, NULL, NULL},
        {"libccd `ccdGJKPenetration`", 1, CALL_GJK, 1, 0, NULL, NULL},
#endif
        {"`ccdMPRPenetration`", 0, CALL_MPR, 1, 0, NULL, NULL},
        {"`ccdMPRPenetration`, `pos` NULL", 0, CALL_MPR, 0, 0, NULL, NULL},
        {"`ccdPenetration`, warm, no `pos`", 0, CALL_PENETRATION, 0, 1, NULL, NULL},
        {"`ccdGJKPenetration`", 0, CALL_GJK, 1, 0, NULL, NULL},
        {"`ccdPenetrationLocal`, no `pos`", 0, CALL_LOCAL, 0, 0, NULL, NULL},
        {"`ccdSignedDistance`", 0, CALL_DISTANCE, 0, 0, NULL, NULL},
        {"`ccdIntersect`", 0, CALL_INTERSECT, 0, 0, NULL, NULL},
    };
    enum { METHODS = sizeof methods / sizeof methods[0] };
    static ccd_real_t verts[2][3 * HULL_VERTICES];
    const long n = argc > 1 ? atol(argv[1]) : 0;
    const method_t previous_frame = {"", 0, CALL_PENETRATION, 0, 1, NULL, NULL};
    if (n < 1000) {
        fprintf(stderr, "usage: worst_case QUERIES [SEED], at least 1000\n");
        return 2;
    }
    uniform_seed(argc > 2 ? strtoull(argv[2], NULL, 10) : 1);
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)1e-6;
    ccd.max_iterations = 500;
    for (int m = 0; m < METHODS; m++) {
        methods[m].callbacks = (float *)calloc((size_t)(2 * n), sizeof(float));
        methods[m].micros = methods[m].callbacks + n;
        if (!methods[m].callbacks)
            return 1;
    }
    for (long k = 0; k < n; k++) {
        shape_t a = random_shape(verts[0]), b = random_shape(verts[1]);
        ccd_warm_t state = {0};
        turn_at_random(&a);
        turn_at_random(&b);
        double gap = (reach_along_x(&a, 1) + reach_along_x(&b, -1)) * uniform(0, 1.02);
        shape_move(&b, gap, uniform(-0.2, 0.2) * gap, uniform(-0.2, 0.2) * gap);
        query(&previous_frame, &a, &b, &ccd, &state);
        /* the next frame, for the calls that start from the state */
        shape_move(&b, gap * 0.998, (double)b.pos[1], (double)b.pos[2]);
        for (int m = 0; m < METHODS; m++)
            measure(&methods[m], k, &a, &b, &ccd, &state);
    }
    printf("| call | callbacks, mean | 99.9 %% | most | us, mean | 99.9 %% | most |\n|---|---|---|---|---|---|---|\n");
    for (int m = 0; m < METHODS; m++) {
        printf("| %s |", methods[m].name);
        print_costs(methods[m].callbacks, n, 0);
        print_costs(methods[m].micros, n, 1);
        printf("\n");
    }
    return 0;
}
