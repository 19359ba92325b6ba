/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Pairs that stay apart: what a query with memory costs while two objects move past each
 * other and never come nearer than two steps of the motion.
 *
 * A motion is 50 steps of 0.1 mm and 0.1 degrees about directions that wander. A step is
 * as long as the way of the point that moves most. The distance is the truth's, checked
 * in every frame; a step that comes too near is followed by one straight out. */

#include "contract/check.h"
#include "ours.h"
#include "stability/dice.h"
#include "truth.h"

enum { MOTIONS = 40, STEPS = 50 };

static const ccd_real_t icosahedron[36] = {
    0, 1, 1.618f, 0, -1, 1.618f, 0, 1, -1.618f, 0, -1, -1.618f, 1, 1.618f, 0, -1, 1.618f, 0,
    1, -1.618f, 0, -1, -1.618f, 0, 1.618f, 0, 1, 1.618f, 0, -1, -1.618f, 0, 1, -1.618f, 0, -1};
static ccd_real_t p12[36];
static dice_t motion;

static shape_t shape_of(char c)
{
    switch (c) {
    case 'b': return shape_box(0.5, 0.4, 0.3);
    case 'c': return shape_capsule(0.5, 0.5);
    case 'y': return shape_cylinder(0.5, 0.5);
    case 'n': return shape_cone(0.5, 0.5);
    case 'e': return shape_ellipsoid(0.5, 0.35, 0.25);
    case 's': return shape_sphere(0.5);
    default: return shape_polytope(p12, 12);
    }
}

/* Another direction near u. */
static void wander(double u[3])
{
    double v[3], l = 0;
    int i;
    dice_unit(&motion, v);
    for (i = 0; i < 3; i++) {
        u[i] += 0.3 * v[i];
        l += u[i] * u[i];
    }
    for (i = 0, l = sqrt(l); i < 3; i++)
        u[i] /= l;
}

static double distance(const shape_t *a, const shape_t *b)
{
    return -truth_depth_within(a, b, 1e-5).depth;
}

/* One step of b, and then away from a until the gap is what it must be. */
static void step(const shape_t *a, shape_t *b, double along[3], double about[3], double gap)
{
    double turn[9], old[9], rot[9];
    int i, tries;
    wander(along);
    wander(about);
    rotation_about(about[0], about[1], about[2], 0.1 * 3.14159265358979 / 180, turn);
    for (i = 0; i < 9; i++)
        old[i] = (double)b->rot[i];
    rotation_times(turn, old, rot);
    shape_turn(b, rot);
    for (i = 0; i < 3; i++)
        b->pos[i] += (ccd_real_t)(1e-4 * along[i]);
    for (tries = 0; tries < 5; tries++) {
        const truth_t t = truth_depth_within(a, b, 1e-5);
        if (-t.depth >= gap)
            return;
        for (i = 0; i < 3; i++) {
            b->pos[i] += (ccd_real_t)(1.01 * (gap + t.depth) * t.n[i]);
            along[i] = t.n[i];
        }
    }
}

int main(void)
{
    static const char pairs[][3] = {"bb", "cc", "yb", "ee", "pc", "pp", "nb", "ss"};
    const size_t kinds = sizeof pairs / sizeof pairs[0];
    unsigned long all_intersect = 0, all_penetration = 0;
    double queries;
    size_t k;
    int i;
    for (i = 0; i < 36; i++)
        p12[i] = icosahedron[i] * (ccd_real_t)(0.5 / 1.9021130325903071);
    for (k = 0; k < kinds; k++) {
        unsigned long intersect = 0, penetration = 0, most = 0;
        double nearest = 1e9;
        int m, frame;
        motion = dice(8000, k);
        for (m = 0; m < MOTIONS; m++) {
            shape_t a = shape_of(pairs[k][0]), b = shape_of(pairs[k][1]);
            const double a_step = 1e-4 + 0.1 * 3.14159265358979 / 180 * shape_reach(&b);
            const double gap = 2 * a_step, start = gap + dice_in(&motion, 0, 20) * a_step;
            double along[3], about[3], out[3], rot[9], d;
            ccd_warm_t w1, w2;
            ccd_t ccd;
            shape_query(&ccd);
            ccd.mpr_tolerance = CCD_REAL(1e-6);
            memset(&w1, 0, sizeof w1);
            memset(&w2, 0, sizeof w2);
            dice_unit(&motion, along);
            dice_unit(&motion, about);
            dice_unit(&motion, out);
            dice_rotation(&motion, rot);
            shape_turn(&b, rot);
            shape_move(&b, 3 * out[0], 3 * out[1], 3 * out[2]);
            /* nearer along out until the distance is start */
            for (i = 0; i < 60 && fabs((d = distance(&a, &b)) - start) > 1e-3 * start; i++)
                shape_move(&b, (double)b.pos[0] - (d - start) * out[0], (double)b.pos[1] - (d - start) * out[1],
                           (double)b.pos[2] - (d - start) * out[2]);
            for (frame = 0; frame <= STEPS; frame++) {
                ccd_real_t depth;
                ccd_vec3_t dir, pos;
                unsigned long c1, c2;
                d = distance(&a, &b);
                nearest = fmin(nearest, d / a_step);
                CHECK(d >= 0.99 * gap, "%s: the pair is too near", pairs[k]);
                a.calls = 0;
                CHECK(OURS(ccdMPRIntersectWarm)(&a, &b, &ccd, &w1) == 0, "%s: %g apart", pairs[k], d);
                c1 = a.calls;
                a.calls = 0;
                CHECK(OURS(ccdMPRPenetrationWarm)(&a, &b, &ccd, &w2, &depth, &dir, &pos) == -1, "%s: %g apart",
                      pairs[k], d);
                c2 = a.calls;
                /* What the first query asks beyond one without a state is for the others. */
                if (frame == 0) {
                    a.calls = 0;
                    OURS(ccdMPRIntersect)(&a, &b, &ccd);
                    c1 -= a.calls < c1 ? a.calls : c1;
                    a.calls = 0;
                    OURS(ccdMPRPenetration)(&a, &b, &ccd, &depth, &dir, &pos);
                    c2 -= a.calls < c2 ? a.calls : c2;
                    intersect += c1;
                    penetration += c2;
                } else {
                    intersect += c1;
                    penetration += c2;
                    most = c1 > most ? c1 : most;
                    most = c2 > most ? c2 : most;
                }
                step(&a, &b, along, about, gap);
            }
        }
        printf("%s: %.3f supports per query of overlap, %.3f of penetration, at most %lu (nearest: %.1f steps)\n",
               pairs[k], (double)intersect / (MOTIONS * STEPS), (double)penetration / (MOTIONS * STEPS), most, nearest);
        all_intersect += intersect;
        all_penetration += penetration;
        CHECK(intersect <= 1.1 * MOTIONS * STEPS, "%s: overlap", pairs[k]);
        CHECK(penetration <= 1.15 * MOTIONS * STEPS, "%s: penetration", pairs[k]);
    }
    queries = (double)kinds * MOTIONS * STEPS;
    printf("all: %.3f supports per query of overlap, %.3f of penetration\n", (double)all_intersect / queries,
           (double)all_penetration / queries);
    CHECK((double)all_intersect <= 1.05 * queries, "overlap");
    CHECK((double)all_penetration <= 1.05 * queries, "penetration");
    return checks_end();
}
