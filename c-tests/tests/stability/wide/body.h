/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Convex bodies of many kinds, with the same support function as a callback and in 128
 * bits. A body is the Minkowski sum of one or two parts and a ball, in a pose. */

#ifndef STABILITY_WIDE_BODY_H
#define STABILITY_WIDE_BODY_H

#include "harness/random.h"

/* 113 bits; x86's long double has 64. */
__extension__ typedef __float128 quad_t;
#ifdef __clang__
extern quad_t powf128(quad_t, quad_t); /* the C library's, declared by its headers for gcc alone */
#endif

typedef enum {
    PART_POINT,
    PART_POINTS,
    PART_BOX,
    PART_SEGMENT,
    PART_ELLIPSOID,
    PART_SUPERELLIPSOID,
    PART_DISC,
    PART_HALF_DISC,
    PART_FRUSTUM,
    PART_TEARDROP,
    PART_HALF_BALL,
    PART_CUT_BALL
} part_kind_t;

typedef struct {
    part_kind_t kind;
    double p[4];
    const double *points;
    int count;
} part_t;

typedef struct {
    part_t part, child;
    double margin, rot[9], pos[3];
    double centre[3]; /* in the local frame */
} body_t;

static const double world_origin[3] = {0, 0, 0};

/* Returns the square root, by a step of Newton's from double: 106 bits. */
static quad_t quad_root(quad_t x)
{
    quad_t y = sqrt((double)x);
    return x > 0 ? (y + x / y) / 2 : 0;
}

static void narrow_farthest(const part_t *s, const double d[3], double o[3])
{
    const double *best = s->points, *v = s->points;
    double most = -HUGE_VAL;
    for (int i = 0; i < s->count; i++, v += 3) {
        const double x = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        if (x > most) {
            most = x;
            best = v;
        }
    }
    memcpy(o, best, 3 * sizeof *o);
}

/* The farthest in 128 bits of the points that are farthest in double. */
static void wide_farthest(const part_t *s, const quad_t d[3], quad_t o[3])
{
    const double n[3] = {(double)d[0], (double)d[1], (double)d[2]}, *v = s->points;
    double far[3], most, size = 0;
    quad_t best = -HUGE_VAL;
    int k;
    narrow_farthest(s, n, far);
    most = far[0] * n[0] + far[1] * n[1] + far[2] * n[2];
    for (int i = 0; i < 3; i++)
        size += fabs(n[i]);
    for (int i = 0; i < s->count; i++, v += 3)
        if (v[0] * n[0] + v[1] * n[1] + v[2] * n[2] >= most - 1e-14 * s->p[0] * size) {
            const quad_t x = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
            if (x > best)
                for (best = x, k = 0; k < 3; k++)
                    o[k] = v[k];
        }
}

#define REAL double
#define FN(name) narrow_##name
#define ROOT sqrt
#define POWER pow
#include "support.h"
#undef REAL
#undef FN
#undef ROOT
#undef POWER
#define REAL quad_t
#define FN(name) wide_##name
#define ROOT quad_root
#define POWER powf128
#include "support.h"
#undef REAL
#undef FN
#undef ROOT
#undef POWER

/* --- callbacks -------------------------------------------------------------------- */

static unsigned long body_calls; /* of support functions */

static void body_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const double d[3] = {(double)dir->v[0], (double)dir->v[1], (double)dir->v[2]};
    double o[3];
    body_calls++;
    narrow_body((const body_t *)obj, world_origin, d, o);
    for (int i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)o[i];
}

static void body_centre(const void *obj, ccd_vec3_t *out)
{
    const body_t *s = (const body_t *)obj;
    for (int i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)(s->pos[i] + s->rot[3 * i] * s->centre[0] + s->rot[3 * i + 1] * s->centre[1]
                                 + s->rot[3 * i + 2] * s->centre[2]);
}

/* --- sizes ------------------------------------------------------------------------ */

/* Returns the radius of a ball about the position that encloses the body, at most 1.7 times the least. */
static double body_reach(const body_t *s)
{
    double most = 0;
    for (int i = 0; i < 6; i++) {
        double d[3] = {0, 0, 0}, o[3];
        d[i / 2] = i % 2 ? 1 : -1;
        narrow_body(s, s->pos, d, o);
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(o[k]));
    }
    return most * 1.7320508;
}

static double body_farthest(const body_t *s)
{
    return sqrt(s->pos[0] * s->pos[0] + s->pos[1] * s->pos[1] + s->pos[2] * s->pos[2]) + body_reach(s);
}

#endif
