/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A mix of pairs to look for the slowest query in: boxes, spheres, capsules, cylinders,
 * cones, ellipsoids and hulls of 4 to 63 points, 0.1 to 1 large, placed in every way
 * that is hard for one method or another. Pair i is always the same pair. */

#ifndef STABILITY_MIX_H
#define STABILITY_MIX_H

#include "categories.h"

enum { MIX_VERTICES = 63 };

enum { /* how they are placed */
    MIX_RANDOM,
    MIX_NEAR,       /* apart or overlapping by 1e-8 to 0.1 along some direction */
    MIX_CORNERS,    /* the same with the support points in a random direction */
    MIX_GRID,       /* sizes, turns and positions on a grid of 1/8 */
    MIX_COINCIDENT, /* centres 1e-12 to 0.1 of the size apart */
    MIX_RESTING,    /* the flat sides of both across one axis, within 1e-2 of touching */
    MIX_PLACEMENTS
};

/* Holds its hulls' points: refer to it by pointer, do not copy it. */
typedef struct {
    shape_t a, b;
    ccd_real_t verts[2][3 * MIX_VERTICES];
    int placement;
} mix_t;

static inline double mix_length(dice_t *d, int grid) { return grid ? (1 + dice_below(d, 8)) / 8. : dice_in(d, .1, 1); }

static inline shape_t mix_shape(dice_t *d, ccd_real_t *verts, int grid)
{
    const int kind = dice_below(d, SHAPE_TYPES);
    const double x = mix_length(d, grid), y = mix_length(d, grid), z = mix_length(d, grid), axis[3] = {x, y, z};
    int i, k, n;
    if (kind != SHAPE_POLYTOPE) {
        shape_t s = shape_make(kind, x, y, z);
        return s;
    }
    n = 4 + dice_below(d, MIX_VERTICES - 3);
    for (i = 0; i < n; i++) {
        double p[3];
        dice_unit(d, p);
        for (k = 0; k < 3; k++)
            verts[3 * i + k] = (ccd_real_t)(grid ? floor(8 * axis[k] * p[k]) / 8 : axis[k] * p[k]);
    }
    for (i = 0; grid && i < 4; i++) /* never flat */
        for (k = 0; k < 3; k++)
            verts[3 * i + k] = (ccd_real_t)(i == k + 1 ? .5 : 0);
    return shape_polytope(verts, n);
}

static inline void mix_near(dice_t *d, mix_t *p)
{
    static const entry_t libccd = {"libccd MPR", 1, ASK_MPR, STATE_NONE};
    const double part = dice_in(d, .1, .7), deep = dice_sign(d) * dice_log(d, 1e-8, .1);
    double at = part * pair_size(&p->a, &p->b), u[3];
    answer_t x;
    int i;
    dice_unit(d, u);
    for (i = 0; i < 8; i++, at /= 2) {
        shape_move(&p->b, at * u[0], at * u[1], at * u[2]);
        x = ask(&libccd, &p->a, &p->b, 1e-6, u, 100000);
        if (x.code == CCD_HIT && truth_dot3(x.dir, x.dir) > .5) {
            const double by = truth_value(&p->a, &p->b, x.dir) - deep;
            shape_move(&p->b, (double)p->b.pos[0] + by * x.dir[0], (double)p->b.pos[1] + by * x.dir[1],
                       (double)p->b.pos[2] + by * x.dir[2]);
            return;
        }
    }
}

static inline void mix_place(dice_t *d, mix_t *p)
{
    static const double quarter[4][9] = {
        {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -1, 0, 1, 0, 0, 0, 0, 1}, {1, 0, 0, 0, 0, -1, 0, 1, 0}, {0, 0, 1, 0, 1, 0, -1, 0, 0}};
    const double size = pair_size(&p->a, &p->b);
    double u[3], v[3], s[3], at, aside, rot[9];
    int k;
    dice_unit(d, u);
    if (p->placement != MIX_GRID) {
        pair_turn(d, &p->a);
        pair_turn(d, &p->b);
    }
    switch (p->placement) {
    case MIX_RANDOM:
        at = dice_in(d, 0, 1.2) * size;
        shape_move(&p->b, at * u[0], at * u[1], at * u[2]);
        break;
    case MIX_NEAR:
        mix_near(d, p);
        break;
    case MIX_CORNERS:
        at = dice_log(d, 1e-8, .1);
        truth_difference(&p->a, &p->b, u, s);
        shape_move(&p->b, s[0] - at * u[0], s[1] - at * u[1], s[2] - at * u[2]);
        break;
    case MIX_GRID:
        shape_turn(&p->a, quarter[dice_below(d, 4)]);
        shape_turn(&p->b, quarter[dice_below(d, 4)]);
        shape_move(&p->b, (dice_below(d, 17) - 8) / 8., (dice_below(d, 17) - 8) / 8., (dice_below(d, 17) - 8) / 8.);
        break;
    case MIX_COINCIDENT:
        if (dice_below(d, 2))
            memcpy(p->b.rot, p->a.rot, sizeof p->b.rot);
        at = dice_log(d, 1e-12, .1) * size;
        shape_move(&p->b, at * u[0], at * u[1], at * u[2]);
        break;
    default:
        /* about one axis, the second perhaps head down: a half turn about its own x */
        for (k = 0; k < 9; k++)
            rot[k] = (double)p->a.rot[k];
        if (dice_below(d, 2))
            for (k = 0; k < 9; k++)
                rot[k] *= k % 3 ? -1 : 1;
        shape_turn(&p->b, rot);
        for (k = 0; k < 3; k++) {
            u[k] = (double)p->a.rot[3 * k + 2];
            v[k] = (double)p->a.rot[3 * k];
        }
        truth_difference(&p->a, &p->b, u, s);
        at = truth_dot3(s, u) - dice_sign(d) * dice_log(d, 1e-12, 1e-2);
        aside = dice_in(d, 0, 1) * shape_reach(&p->a);
        shape_move(&p->b, at * u[0] + aside * v[0], at * u[1] + aside * v[1], at * u[2] + aside * v[2]);
        break;
    }
}

/* Pair number index; placement < 0: any. */
static inline void mix_pair(uint64_t index, int placement, mix_t *p)
{
    dice_t dd = dice(3000, index), *d = &dd;
    int k;
    p->placement = placement >= 0 ? placement : dice_below(d, MIX_PLACEMENTS);
    for (k = 0; k < 2; k++)
        *(k ? &p->b : &p->a) = mix_shape(d, p->verts[k], p->placement == MIX_GRID);
    mix_place(d, p);
}

#endif
