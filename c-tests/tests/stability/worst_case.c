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
#include "harness/this_library.h"
#include "harness/shapes.h"
#include "harness/random.h"

#include <stdio.h>
#include <time.h>

enum { CORNERS = 60 };
static const double AGAIN = 20; /* microseconds */

typedef struct {
    const char *name;
    int call;     /* of call_library; -1 libccd's MPR, -2 its GJK */
    int has_pos, is_warm;
    unsigned short *calls;
    float *micros;
    long worst; /* the query that asked most */
} method_t;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

/* A shape of a random kind and size, a hull's corners in `corners`. */
static shape_t random_shape(ccd_real_t *corners)
{
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = 0.05 * exp(uniform(0, 3));
    const int kind = (int)uniform(0, SHAPE_TYPES);
    if (kind != SHAPE_POLYTOPE)
        return shape_make(kind, p[0], p[1], p[2]);
    for (int i = 0; i < CORNERS; i++) {
        double x[3], length;
        do {
            x[0] = uniform(-1, 1), x[1] = uniform(-1, 1), x[2] = uniform(-1, 1);
            length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        } while (length > 1 || length < 0.1);
        for (int k = 0; k < 3; k++)
            corners[3 * i + k] = (ccd_real_t)(p[k] * x[k] / length);
    }
    return shape_polytope(corners, CORNERS);
}

/* How far the shape reaches from its centre along x. */
static double reach(const shape_t *s, double sign)
{
    const ccd_vec3_t dir = {{(ccd_real_t)sign, 0, 0}};
    ccd_vec3_t out, at;
    shape_support(s, &dir, &out);
    shape_center(s, &at);
    return sign * (double)(out.v[0] - at.v[0]);
}

static void turn_at_random(shape_t *s)
{
    double q[4], rot[9];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(s, rot);
}

static void query(const method_t *m, const shape_t *a, const shape_t *b, const ccd_t *ccd, ccd_warm_t *warm)
{
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    ccd_penetration_t full;
    ccd_distance_t distance;
    call_args_t rest = {.depth = &depth, .dir = &dir, .penetration = &full, .distance = &distance};
#ifndef OURS_ALONE
    if (m->call < 0) {
        (m->call == -1 ? ccdMPRPenetration : ccdGJKPenetration)(a, b, ccd, &depth, &dir, &pos);
        return;
    }
#endif
    rest.max_distance = (ccd_real_t)HUGE_VAL;
    rest.pos = m->has_pos ? &pos : NULL;
    rest.want = m->has_pos ? CCD_WANT_ALL : CCD_WANT_POINTS;
    if (m->call == CALL_DISTANCE)
        rest.want = CCD_WANT_POINTS;
    rest.warm = m->is_warm ? warm : NULL;
    call_library(m->call, a, b, ccd, &rest);
}

static void measure(method_t *m, long k, const shape_t *a, const shape_t *b, const ccd_t *ccd, const ccd_warm_t *state)
{
    const unsigned long before = a->calls + b->calls;
    double least = HUGE_VAL;
    for (int turn = 0; turn < 4 && (turn == 0 || least > AGAIN); turn++) {
        ccd_warm_t warm = *state;
        const double start = now();
        query(m, a, b, ccd, &warm);
        least = fmin(least, now() - start);
        if (turn == 0) {
            m->calls[k] = (unsigned short)(a->calls + b->calls - before);
            m->worst = m->calls[k] > m->calls[m->worst] ? k : m->worst;
        }
    }
    m->micros[k] = (float)least;
}

static int by_calls(const void *a, const void *b) { return *(const unsigned short *)a - *(const unsigned short *)b; }

static int by_micros(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void report(method_t *m, long n)
{
    const long high = n - 1 - n / 1000;
    double calls = 0, micros = 0;
    for (long k = 0; k < n; k++) {
        calls += m->calls[k];
        micros += (double)m->micros[k];
    }
    qsort(m->calls, (size_t)n, sizeof *m->calls, by_calls);
    qsort(m->micros, (size_t)n, sizeof *m->micros, by_micros);
    printf("| %s | %.1f | %u | %u | %.2f | %.1f | %.0f |\n", m->name, calls / (double)n, m->calls[high], m->calls[n - 1],
           micros / (double)n, (double)m->micros[high], (double)m->micros[n - 1]);
}

int main(int argc, char **argv)
{
    static method_t methods[] = {
#ifndef OURS_ALONE
        {"libccd `ccdMPRPenetration`", -1, 1, 0, NULL, NULL, 0},
        {"libccd `ccdGJKPenetration`", -2, 1, 0, NULL, NULL, 0},
#endif
        {"`ccdMPRPenetration`", CALL_MPR, 1, 0, NULL, NULL, 0},
        {"`ccdMPRPenetration`, `pos` NULL", CALL_MPR, 0, 0, NULL, NULL, 0},
        {"`ccdPenetration`, warm, no `pos`", CALL_PENETRATION, 0, 1, NULL, NULL, 0},
        {"`ccdGJKPenetration`", CALL_GJK, 1, 0, NULL, NULL, 0},
        {"`ccdPenetrationLocal`, no `pos`", CALL_LOCAL, 0, 0, NULL, NULL, 0},
        {"`ccdSignedDistance`", CALL_DISTANCE, 0, 0, NULL, NULL, 0},
        {"`ccdIntersect`", CALL_INTERSECT, 0, 0, NULL, NULL, 0},
    };
    enum { METHODS = sizeof methods / sizeof methods[0] };
    static ccd_real_t corners[2][3 * CORNERS];
    const long n = argc > 1 ? atol(argv[1]) : 0;
    const method_t leave_state = {"", CALL_PENETRATION, 0, 1, NULL, NULL, 0};
    if (n < 1000) {
        fprintf(stderr, "usage: worst_case QUERIES [SEED], at least 1000\n");
        return 2;
    }
    uniform_seed(argc > 2 ? strtoull(argv[2], NULL, 10) : 1);
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)1e-6;
    ccd.max_iterations = 500;
    for (int m = 0; m < METHODS; m++) {
        methods[m].calls = (unsigned short *)calloc((size_t)n, sizeof *methods[m].calls);
        methods[m].micros = (float *)calloc((size_t)n, sizeof *methods[m].micros);
        if (!methods[m].calls || !methods[m].micros)
            return 1;
    }
    for (long k = 0; k < n; k++) {
        shape_t a = random_shape(corners[0]), b = random_shape(corners[1]);
        ccd_warm_t state = {0};
        turn_at_random(&a);
        turn_at_random(&b);
        double gap = (reach(&a, 1) + reach(&b, -1)) * uniform(0, 1.02);
        shape_move(&b, gap, uniform(-0.2, 0.2) * gap, uniform(-0.2, 0.2) * gap);
        query(&leave_state, &a, &b, &ccd, &state);
        /* the next frame, for the calls that start from the state */
        shape_move(&b, gap * 0.998, (double)b.pos[1], (double)b.pos[2]);
        for (int m = 0; m < METHODS; m++)
            measure(&methods[m], k, &a, &b, &ccd, &state);
    }
    printf("| call | callbacks, mean | 99.9 %% | most | us, mean | 99.9 %% | most |\n|---|---|---|---|---|---|---|\n");
    for (int m = 0; m < METHODS; m++)
        report(&methods[m], n);
    return 0;
}
