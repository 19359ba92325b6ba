/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Pairs of random convex bodies in poses of certified signed depth.
 *
 * A pair is first placed at random so that the shapes overlap, by a depth s with
 * normal n that truth.h certifies. Then the second shape is moved along n until
 * s is t: the support value of n is then t, and that of any other direction m is
 * at least s - (s - t) m.n >= t. So t is the signed depth of the new pose, for
 * every t <= s, positive or not. */

#ifndef ENGINES_POSES_H
#define ENGINES_POSES_H

#include "engines/hull.h"
#include "harness/truth.h"

#include <stdio.h>

/* Kinds of bodies: those of shapes.h first, then special sizes of them. */
enum {
    KIND_TRIANGLE = SHAPE_POLYTOPE + 1, /* one flat triangle */
    KIND_PLATE,                         /* a box 1/200 as thick as wide */
    KINDS
};
static const char *const KIND_NAME[KINDS] = { "sphere", "capsule",  "box",      "cylinder", "cone",
                                              "ellipsoid", "convex", "triangle", "plate" };

typedef struct {
    int kind;
    shape_t shape;
    hull_t hull; /* of a convex; a triangle's three vertices */
} body_t;

/* Makes the body of its hull; it must stay where it is. */
static inline void body_set_hull(body_t *b) { b->shape = shape_polytope(b->hull.vertex, b->hull.vertices); }

/* Makes a body of this kind, 0.1 to 1 across, about its own origin; it must stay where it is. */
static inline void body_random(body_t *b, int kind)
{
    const double x = uniform(0.05, 0.5), y = uniform(0.05, 0.5), z = uniform(0.05, 0.5);
    b->kind = kind;
    if (kind == SHAPE_POLYTOPE) {
        hull_random(&b->hull, 6 + (int)uniform(0, 7), x, y, z);
        body_set_hull(b);
    } else if (kind == KIND_TRIANGLE) {
        double plane[4];
        b->hull.vertices = 3;
        do {
            for (int i = 0; i < 9; i++)
                b->hull.vertex[i] = (float)uniform(-0.5, 0.5); /* ODE keeps floats */
        } while (hull_plane(&b->hull, 0, 1, 2, plane) < 0.04);
        body_set_hull(b);
    } else
        b->shape = kind == KIND_PLATE ? shape_box(x, y, 0.005 * x) : shape_make(kind, x, y, z);
}

typedef struct {
    double size;         /* unit of relative tolerances */
    double lower, upper; /* bounds of the signed depth */
    double n[3];         /* the direction in which b leaves */
} pose_truth_t;

/* Places a at the origin and b at random so that they overlap. */
static inline void pose_overlapping(body_t *a, body_t *b, pose_truth_t *truth)
{
    truth_t t;
    do {
        const double reach = shape_reach(&a->shape) + shape_reach(&b->shape);
        double at[3];
        turn_at_random(&a->shape);
        turn_at_random(&b->shape);
        shape_move(&a->shape, 0, 0, 0);
        for (int i = 0; i < 3; i++)
            at[i] = uniform(-0.7, 0.7) * reach;
        shape_move(&b->shape, at[0], at[1], at[2]);
        /* loose bounds find the overlap, which is then measured */
        t = truth_depth_within(&a->shape, &b->shape, 1e-3 * reach);
        if (t.lower > 1e-3 * reach)
            t = truth_depth_within(&a->shape, &b->shape, 1e-11 * reach);
        else
            t.lower = -1;
    } while (!(t.lower > 1e-3 * pair_size(&a->shape, &b->shape) && t.depth - t.lower < 1e-10));
    truth->size = pair_size(&a->shape, &b->shape);
    truth->lower = t.lower;
    truth->upper = t.depth;
    memcpy(truth->n, t.n, sizeof truth->n);
}

/* From an overlapping pose: moves b until the signed depth is `depth`, no deeper than it was. */
static inline void pose_at_depth(body_t *b, pose_truth_t *truth, double depth)
{
    const double by = truth->upper - depth, *n = truth->n;
    shape_move(&b->shape, b->shape.pos[0] + by * n[0], b->shape.pos[1] + by * n[1], b->shape.pos[2] + by * n[2]);
    truth->lower -= by;
    truth->upper = depth;
}

/* --- single queries of every pair of kinds -------------------------------------------- */

/* Signed depths of every placed pair, in sizes, after that of the random pose. */
static const double DEPTHS[] = { 1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 2e-9,
                                 -2e-9, -1e-8, -1e-7, -1e-6, -3e-6, -1e-5, -1e-3, -1e-1 };
enum { DEPTH_COUNT = sizeof DEPTHS / sizeof DEPTHS[0] };

/* Calls `query` for every pose of `poses` pairs of each two kinds, and `make` for every new pair; returns the number of
 * poses. */
static inline long pose_all(const int *kinds, int count, long poses, body_t *a, body_t *b, void (*make)(void), void (*query)(void))
{
    long queried = 0;
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++)
            for (long k = 0; k < poses && (kinds[i] != KIND_TRIANGLE || kinds[j] != KIND_TRIANGLE); k++) {
                pose_truth_t pose;
                body_random(a, kinds[i]);
                body_random(b, kinds[j]);
                pose_overlapping(a, b, &pose);
                make();
                query();
                queried++;
                for (int d = 0; d < DEPTH_COUNT; d++)
                    if (DEPTHS[d] * pose.size < pose.upper) {
                        pose_at_depth(b, &pose, DEPTHS[d] * pose.size);
                        query();
                        queried++;
                    }
            }
    return queried;
}

#endif
