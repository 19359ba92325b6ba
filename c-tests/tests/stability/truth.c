/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks the truth that other tests are judged by: its two methods against each other
 * over random pairs, and against the certified depths of the pair sets.
 *
 *   truth random-pairs step pair-set...     every step-th pose of each set */

#include "categories.h"
#include "harness/pairs.h"

static int failed;

static void fail(const char *what, const shape_t *a, const shape_t *b, double got, double low, double high)
{
    if (failed++ < 10) {
        printf("FAILED %s: %.17g not in [%.17g, %.17g]\n", what, got, low, high);
        print_shape("a", a);
        print_shape("b", b);
    }
}

/* Checks that the enumerated depth is inside the bounds of branch and bound, is the support value of its
 * direction, and is zero after moving obj2 by it. */
static void compare_methods(int pairs)
{
    int compared = 0;
    for (int i = 0; i < pairs; i++) {
        static const int kinds[] = {SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_TYPES};
        static pair_t p;
        rng_t d = rng(1000, (uint64_t)i);
        double u[3], at, eps;
        for (int k = 0; k < 2; k++) {
            int kind = kinds[rng_below(&d, 5)];
            shape_t *s = pair_side(&p, k);
            *s = kind == SHAPE_TYPES ? random_polygon(&d, p.verts[k], 1) : random_shape_of(&d, p.verts[k], kind, .1, 1);
            pair_turn(&d, s);
        }
        rng_unit_vector(&d, u);
        at = rng_uniform(&d, 0, 1) * pair_size(&p.a, &p.b);
        pair_place(&p, at, u);
        truth_t t = truth_depth(&p.a, &p.b);
        truth_t s = truth_branch(&p.a, &p.b, 1e-9, 40000);
        eps = 64 * real_eps() * pair_size(&p.a, &p.b);
        compared += t.enumerated;
        if (!t.enumerated)
            fail("not enumerated", &p.a, &p.b, 0, 1, 1);
        if (!(t.depth >= s.lower - eps && t.depth <= s.depth + eps))
            fail("enumeration outside the search's bounds", &p.a, &p.b, t.depth, s.lower, s.depth);
        if (!(fabs(truth_support_value(&p.a, &p.b, t.n) - t.depth) <= eps))
            fail("depth is not the support value", &p.a, &p.b, truth_support_value(&p.a, &p.b, t.n), t.depth, t.depth);
        if (t.depth > 0) {
            shape_t moved = p.b;
            shape_shift(&moved, t.depth, t.n);
            s = truth_depth(&p.a, &moved);
            if (!(fabs(s.depth) <= eps))
                fail("not touching after the move", &p.a, &moved, s.depth, 0, 0);
            /* along a random direction: touching after that move too */
            rng_unit_vector(&d, u);
            t = truth_along(&p.a, &p.b, u);
            moved = p.b;
            shape_shift(&moved, t.depth, u);
            s = truth_depth(&p.a, &moved);
            if (!(fabs(s.depth) <= eps + (t.depth - t.lower)))
                fail("along: not touching after the move", &p.a, &moved, s.depth, 0, 0);
        }
    }
    printf("%d random pairs, both methods\n", compared);
}

int main(int argc, char **argv)
{
    int step = argc > 2 ? atoi(argv[2]) : 1, i, k;
    compare_methods(argc > 1 ? atoi(argv[1]) : 1000);
    for (k = 3; k < argc; k++) {
        pair_set_t set;
        double worst = 0, widest = 0;
        if (pair_set_read(argv[k], &set) != 0) {
            printf("FAILED cannot read %s\n", argv[k]);
            return 1;
        }
        for (i = 0; i < set.n; i += step) {
            shape_t a, b;
            pair_truth_t certified;
            double eps = 128 * DBL_EPSILON;
            pair_set_pose(&set, i, &a, &b, &certified);
            truth_t t = truth_depth(&a, &b);
            worst = fmax(worst, fabs(t.depth - certified.depth));
            widest = fmax(widest, t.depth - t.lower);
            if (!(t.lower <= certified.depth + eps && t.depth >= certified.depth - certified.gap - eps))
                fail("outside the certified bounds", &a, &b, certified.depth, t.lower, t.depth);
            if (!(t.depth - t.lower <= 2e-12 * pair_size(&a, &b)))
                fail("bounds do not close", &a, &b, t.depth, t.lower, t.depth);
        }
        printf("%s: largest difference %.2g, widest bounds %.2g\n", strrchr(argv[k], '/') ? strrchr(argv[k], '/') + 1 : argv[k],
               worst, widest);
        pair_set_free(&set);
    }
    printf("%d failures\n", failed);
    return failed > 0;
}
