/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks the truth that other tests are judged by: by support values and moves of random pairs, by the certified depths of
 * the pair sets, and by the recorded contacts. (The known depths of configurations.h check it too.)
 *
 *   truth random-pairs step recording pair-set...     every step-th pose of the recording and of each set */

#include "tests/stability/categories.h"
#include "harness/pairs.h"
#include "tools/record/recording.h"

static int failed;

static void fail(const char *what, const shape_t *a, const shape_t *b, double got, double low, double high)
{
    if (failed++ < 10) {
        printf("FAILED %s: %.17g not in [%.17g, %.17g]\n", what, got, low, high);
        print_shape("a", a);
        print_shape("b", b);
    }
}

/* Checks that no direction has less than the lower bound, that the depth is the support value of its direction, and is
 * zero after moving obj2 by it, as the depth along a random direction. */
static void check_moves(int pairs)
{
    static pair_t p;
    for (int i = 0; i < pairs; i++) {
        rng_t d = rng(1000, (uint64_t)i);
        double u[3], least = HUGE_VAL;
        category_pair(i % CATEGORY_COUNT, (uint64_t)(i / CATEGORY_COUNT), SHAPE_TIE_SIGN, &p);
        const double eps = 64 * real_eps() * largest_coordinate(&p.a, &p.b);
        const truth_t t = p.truth;
        for (int k = 0; k < 200; k++) {
            rng_unit_vector(&d, u);
            for (int j = 0; k >= 100 && j < 3; j++) /* near the minimum too */
                u[j] = t.n[j] + pow(10, -.1 * (k - 100)) * u[j];
            least = fmin(least, truth_support_value(&p.a, &p.b, u));
        }
        if (!(t.lower <= least + eps) || !(t.lower <= t.depth))
            fail("a support value below the bound", &p.a, &p.b, least, t.lower, t.depth);
        if (!(fabs(truth_support_value(&p.a, &p.b, t.n) - t.depth) <= eps))
            fail("depth is not the support value", &p.a, &p.b, truth_support_value(&p.a, &p.b, t.n), t.depth, t.depth);
        const double width = eps + t.depth - t.lower;
        rng_unit_vector(&d, u);
        for (int k = 0; k < 2 && t.lower > 0; k++) {
            const truth_t by = k ? truth_along(&p.a, &p.b, u) : t;
            shape_t moved = p.b;
            shape_shift(&moved, by.depth, k ? u : t.n);
            const truth_t rest = truth_depth(&p.a, &moved);
            if (!(rest.lower <= width + by.depth - by.lower && rest.depth >= -width - (by.depth - by.lower)))
                fail("not touching after the move", &p.a, &moved, rest.depth, 0, 0);
        }
    }
    printf("%d random pairs\n", pairs);
}

static void check_set(const char *path, int step)
{
    const char *name = strrchr(path, '/');
    pair_set_t set;
    double worst = 0, widest = 0;
    if (pair_set_read(path, &set) != 0) {
        printf("FAILED cannot read %s\n", path);
        exit(1);
    }
    for (int i = 0; i < set.n; i += step) {
        shape_t a, b;
        pair_truth_t certified;
        const double eps = 128 * DBL_EPSILON;
        pair_set_pose(&set, i, &a, &b, &certified);
        truth_t t = truth_depth(&a, &b);
        worst = fmax(worst, fabs(t.depth - certified.depth));
        widest = fmax(widest, t.depth - t.lower);
        if (!(t.lower <= certified.depth + eps && t.depth >= certified.depth - certified.gap - eps))
            fail("outside the certified bounds", &a, &b, certified.depth, t.lower, t.depth);
        if (!(t.depth - t.lower <= 2e-12 * pair_size(&a, &b)))
            fail("bounds do not close", &a, &b, t.depth, t.lower, t.depth);
    }
    printf("%s: largest difference %.2g, widest bounds %.2g\n", name ? name + 1 : path, worst, widest);
    pair_set_free(&set);
}

/* Checks that the recorded interval and the truth's have a common number. */
static void check_recording(const char *path, size_t step)
{
    recording_t r;
    size_t k = 0;
    if (recording_read(path, &r) != 0) {
        printf("FAILED cannot read %s\n", path);
        exit(1);
    }
    shape_t *body = (shape_t *)malloc(r.bodies * sizeof *body);
    for (uint32_t f = 0; body && f < r.frames; f++) {
        recording_place(&r, f, body);
        for (uint32_t i = 0; i < r.frame_pairs[f]; i++, k++) {
            const recording_pair_t *p = &r.pair[k];
            if (k % step)
                continue;
            const truth_t t = truth_depth_within(&body[p->a], &body[p->b], 1e-10);
            if (!(p->lower <= t.depth + 1e-12 && t.lower <= p->upper + 1e-12))
                fail("recorded bounds", &body[p->a], &body[p->b], t.depth, p->lower, p->upper);
        }
    }
    printf("%zu recorded pairs\n", k / step);
}

int main(int argc, char **argv)
{
    const int step = argc > 2 ? atoi(argv[2]) : 1;
    check_moves(argc > 1 ? atoi(argv[1]) : 1000);
    if (argc > 3)
        check_recording(argv[3], (size_t)step);
    for (int k = 4; k < argc; k++)
        check_set(argv[k], step);
    printf("%d failures\n", failed);
    return failed > 0;
}
