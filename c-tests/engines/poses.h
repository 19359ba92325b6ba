/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Pairs of random convex bodies in poses of certified signed depth, and counts of what is wrong with
 * an engine's results for them.
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
#include "harness/verdict.h"

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

static inline void body_turn(body_t *b)
{
    double q[4], rot[9];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(&b->shape, rot);
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
        body_turn(a);
        body_turn(b);
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

/* --- counts of results --------------------------------------------------------------- */

typedef struct {
    long queries, hits, wrong[VERDICTS];
    long off;            /* hits beyond what ccdMPRPenetration guarantees: 0.1 % and a tolerance */
    double deepest_miss; /* overlap */
    double excess;       /* largest part of the true depth beyond it and two tolerances */
    double error;        /* largest, metres */
} tally_t;

static inline verdict_t tally_add(tally_t *t, const verdict_truth_t *truth, int hit, double depth, double length)
{
    const verdict_answer_t answer = { hit, 1, depth, length * length };
    const verdict_t v = verdict(&answer, truth);
    const double above = depth - fmax(truth->upper, 0), below = truth->lower - depth;
    t->queries++;
    t->hits += hit;
    t->wrong[v]++;
    if (v == VERDICT_MISSED)
        t->deepest_miss = fmax(t->deepest_miss, truth->lower);
    if (!hit)
        return v;
    if (truth->upper > 0)
        t->excess = fmax(t->excess, (above - 2 * truth->tolerance) / truth->upper);
    t->error = fmax(t->error, fmax(above, below));
    t->off += !(above <= fmax(truth->tolerance, 1e-3 * truth->upper) + truth->contact_eps
                && below <= truth->tolerance + truth->contact_eps);
    return v;
}

static inline void tally_print(const char *line, const tally_t *t)
{
    const long *wrong = t->wrong;
    printf("%s queries %ld hits %ld missed %ld spurious %ld broken %ld deep %ld unsound %ld", line, t->queries, t->hits,
           wrong[VERDICT_MISSED], wrong[VERDICT_SPURIOUS], wrong[VERDICT_INVALID], wrong[VERDICT_DEEP], wrong[VERDICT_UNSOUND]);
    printf(" off %ld deepest_miss %.9g excess %.9g error %.9g\n", t->off, t->deepest_miss, t->excess, t->error);
}

/* ODE's cylinder callback is wrong for directions within about 1e-15 of the axis: it normalises
 * what rounding leaves across the axis, and returns a point up to a radius off. Queries with a point that is off by more
 * than a tenth of the tolerance are about no convex shape, and counted apart: by the second tally. Points that are less off
 * make a depth uncertain by as much. */
static tally_t tally[2];

/* Computes the support point along dir; returns by how much the support value of v is off it. */
static inline double support_error(const shape_t *s, const ccd_vec3_t *dir, const ccd_vec3_t *v, double point[3])
{
    static const double origin[3] = { 0, 0, 0 };
    const double n[3] = { dir->v[0], dir->v[1], dir->v[2] };
    truth_support(s, origin, n, point);
    const double off[3] = { v->v[0] - point[0], v->v[1] - point[1], v->v[2] - point[2] };
    return fabs(truth_dot3(n, off));
}

/* --- single queries of every pair of kinds -------------------------------------------- */

/* Signed depths of every placed pair, in sizes, after that of the random pose. */
static const double DEPTHS[] = { 1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 2e-9,
                                 -2e-9, -1e-8, -1e-7, -1e-6, -3e-6, -1e-5, -1e-3, -1e-1 };
enum { DEPTH_COUNT = sizeof DEPTHS / sizeof DEPTHS[0] };

/* FCL's and ODE's, metres. */
static const double POSE_TOLERANCE = 1e-6;

static long threw; /* queries in which FCL threw */

/* Counts a result. support_off: the largest error of a support value, metres. Where a callback was wrong, none is right, and
 * what is within two tolerances of the true depth will do. */
static inline void pose_judge(const body_t *a, const body_t *b, const pose_truth_t *pose, double support_off, int hit,
                              double depth, double length)
{
    const int invalid_support = support_off > 0.1 * POSE_TOLERANCE;
    const double contact_eps = invalid_support ? 2 * POSE_TOLERANCE : 1e-9 * pose->size + 2 * support_off;
    const verdict_truth_t truth = { pose->lower, pose->upper, POSE_TOLERANCE, contact_eps };
    const verdict_t v = tally_add(&tally[invalid_support], &truth, hit, depth, length);
    if (v != VERDICT_RIGHT && !invalid_support)
        printf("wrong: %s %s %s, signed depth %.9g to %.9g, returned %.9g\n", KIND_NAME[a->kind], KIND_NAME[b->kind],
               VERDICT_NAME[v], pose->lower, pose->upper, depth);
}

/* Calls `query` for every pose of `poses` pairs of each two kinds, and `make` for every new pair; prints the
 * counts. */
static inline void pose_all(const int *kinds, int count, long poses, body_t *a, body_t *b, void (*make)(void),
                            void (*query)(const pose_truth_t *pose))
{
    long queried = 0; /* pairs of kinds */
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++) {
            const long before = tally[0].queries + tally[1].queries;
            for (long k = 0; k < poses && (kinds[i] != KIND_TRIANGLE || kinds[j] != KIND_TRIANGLE); k++) {
                pose_truth_t pose;
                body_random(a, kinds[i]);
                body_random(b, kinds[j]);
                pose_overlapping(a, b, &pose);
                make();
                query(&pose);
                for (int d = 0; d < DEPTH_COUNT; d++)
                    if (DEPTHS[d] * pose.size < pose.upper) {
                        pose_at_depth(b, &pose, DEPTHS[d] * pose.size);
                        query(&pose);
                    }
            }
            queried += tally[0].queries + tally[1].queries > before;
        }
    printf("poses kinds %ld threw %ld\n", queried, threw);
    tally_print("collide", &tally[0]);
    tally_print("invalid_support", &tally[1]);
}

#endif
