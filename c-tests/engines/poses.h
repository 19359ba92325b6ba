/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Pairs of convex shapes in poses of known signed depth, for the static queries
 * put to FCL and ODE.
 *
 * A pair is first placed at random so that the shapes overlap, by a depth s with
 * normal n that truth.h certifies. Then the second shape is moved along n until
 * s is t: the support value of n is then t, and that of any other direction m is
 * at least s - (s - t) m.n >= t. So t is the signed depth of the new pose, for
 * every t <= s, positive or not. */

#ifndef ENGINES_POSES_H
#define ENGINES_POSES_H

#include "engines/hull.h"
#include "engines/tally.h"

/* Kinds of shape; those of shapes.h first, then special sizes of them. */
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

/* A shape of this kind, 0.1 to 1 across, about its own origin. The body is where its vertices live. */
static inline void body_random(body_t *b, int kind)
{
    const double x = uniform(0.05, 0.5), y = uniform(0.05, 0.5), z = uniform(0.05, 0.5);
    b->kind = kind;
    switch (kind) {
    case KIND_PLATE: b->shape = shape_box(x, y, 0.005 * x); break;
    case SHAPE_POLYTOPE:
        hull_random(&b->hull, 6 + (int)uniform(0, 7), x, y, z);
        b->shape = shape_polytope(b->hull.vertex, b->hull.vertices);
        break;
    case KIND_TRIANGLE: {
        double area;
        do {
            for (int i = 0; i < 9; i++)
                b->hull.vertex[i] = (float)uniform(-0.5, 0.5); /* ODE keeps floats */
            {
                const ccd_real_t *v = b->hull.vertex;
                const double p[3] = { v[3] - v[0], v[4] - v[1], v[5] - v[2] }, q[3] = { v[6] - v[0], v[7] - v[1], v[8] - v[2] };
                const double c[3] = { p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0] };
                area = 0.5 * sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
            }
        } while (area < 0.02);
        b->hull.vertices = 3;
        b->shape = shape_polytope(b->hull.vertex, 3);
        break;
    }
    default: b->shape = shape_make(kind, x, y, z); break;
    }
}

static inline void body_turn(body_t *b)
{
    double q[4], rot[9];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(&b->shape, rot);
}

typedef struct {
    double size;         /* unit of relative tolerances */
    double lower, upper; /* of the signed depth */
    double n[3];         /* the way b leaves */
} known_t;

/* Places a at the origin and b at random so that they overlap. */
static inline void pose_overlapping(body_t *a, body_t *b, known_t *known)
{
    truth_t t;
    do {
        const double reach = shape_reach(&a->shape) + shape_reach(&b->shape);
        double at[3];
        body_turn(a);
        body_turn(b);
        shape_move(&a->shape, 0, 0, 0);
        for (int i = 0; i < 3; i++)
            at[i] = uniform(-0.7, 0.7) * reach;
        shape_move(&b->shape, at[0], at[1], at[2]);
        /* the loose bounds tell overlap; what is overlapping is then measured */
        t = truth_depth_within(&a->shape, &b->shape, 1e-3 * reach);
        if (t.lower > 1e-3 * reach)
            t = truth_depth_within(&a->shape, &b->shape, 1e-11 * reach);
        else
            t.lower = -1;
    } while (!(t.lower > 1e-3 * pair_size(&a->shape, &b->shape) && t.depth - t.lower < 1e-10));
    known->size = pair_size(&a->shape, &b->shape);
    known->lower = t.lower;
    known->upper = t.depth;
    memcpy(known->n, t.n, sizeof known->n);
}

/* From an overlapping pose: the same moved until the signed depth is `depth`, no deeper than it was. */
static inline void pose_at_depth(body_t *b, known_t *known, double depth)
{
    const double by = known->upper - depth;
    shape_move(&b->shape, b->shape.pos[0] + by * known->n[0], b->shape.pos[1] + by * known->n[1], b->shape.pos[2] + by * known->n[2]);
    known->lower -= by;
    known->upper = depth;
}

/* Depths put to every placed pair, in sizes; the pose as it fell is asked first. */
static const double DEPTHS[] = { 1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 2e-9, -2e-9, -1e-8, -1e-7, -1e-6, -3e-6, -1e-5, -1e-3, -1e-1 };
enum { DEPTH_COUNT = sizeof DEPTHS / sizeof DEPTHS[0] };

/* --- answers held against that --------------------------------------------------------- */

/* FCL's and ODE's, metres. */
static const double POSE_TOLERANCE = 1e-6;

/* The second: where a callback was wrong. There is no right answer then, and what is within two
 * tolerances of the meant one will do. */
static tally_t tally[2];
static long threw; /* queries in which FCL did */

static inline void pose_judge(const body_t *a, const body_t *b, const known_t *known, int astray, int hit, double depth,
                              double length)
{
    const double touch = astray ? 2 * POSE_TOLERANCE : 1e-9 * known->size;
    const verdict_truth_t truth = { known->lower, known->upper, POSE_TOLERANCE, touch };
    const verdict_t v = tally_add(&tally[astray], &truth, hit, depth, length);
    if (v != VERDICT_RIGHT && !astray)
        printf("wrong: %s %s %s, signed depth %.9g to %.9g, answered %.9g\n", KIND_NAME[a->kind], KIND_NAME[b->kind], VERDICT_NAME[v],
               known->lower, known->upper, depth);
}

/* Asks about every pose of `poses` pairs of each two kinds; `make` is told of a new pair. Then the
 * counts, in a line each. */
static inline void pose_all(const int *kinds, int count, long poses, body_t *a, body_t *b, void (*make)(void),
                            void (*ask)(const known_t *known))
{
    long k, asked = 0; /* pairs of kinds */
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++) {
            const long before = tally[0].queries + tally[1].queries;
            for (k = 0; k < poses && (kinds[i] != KIND_TRIANGLE || kinds[j] != KIND_TRIANGLE); k++) {
                known_t known;
                body_random(a, kinds[i]);
                body_random(b, kinds[j]);
                pose_overlapping(a, b, &known);
                make();
                ask(&known);
                for (int d = 0; d < DEPTH_COUNT; d++)
                    if (DEPTHS[d] * known.size < known.upper) {
                        pose_at_depth(b, &known, DEPTHS[d] * known.size);
                        ask(&known);
                    }
            }
            asked += tally[0].queries + tally[1].queries > before;
        }
    printf("asked kinds %ld threw %ld\n", asked, threw);
    tally_print("collide", &tally[0]);
    tally_print("astray", &tally[1]);
}

#endif
