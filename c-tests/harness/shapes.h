/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Convex shapes for the C tests, as support functions over <ccd/ccd.h>. Header
 * only, C99 and C++11, computes in ccd_real_t.
 *
 * A shape is a value: copy it, place it, pass its address to a query. Its
 * support function counts its calls in it. Only polytopes refer to memory that
 * they do not own: their vertices. */

#ifndef TESTS_SHAPES_H
#define TESTS_SHAPES_H

#include <ccd/ccd.h>
#include <ccd/shapes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The shapes of every C test, and of the benchmark in Rust through bench/measuring/callbacks.c. The callbacks of
 * the first seven are those of <ccd/shapes.h>, the truth has its own for all (shape_support.h).
 * No switch over them has a `default:`, so what a new one lacks does not compile: its support
 * point (shape_support.h) and its size (shape_reach in truth.h). */
#pragma GCC diagnostic error "-Wswitch"
typedef enum {
    SHAPE_SPHERE,    /* p = radius */
    SHAPE_CAPSULE,   /* p = radius, half length of the core segment along z */
    SHAPE_BOX,       /* p = half extents */
    SHAPE_CYLINDER,  /* p = radius, half height along z */
    SHAPE_CONE,      /* p = radius, half height; apex at +z, the base at -z */
    SHAPE_ELLIPSOID, /* p = half axes */
    SHAPE_POLYTOPE,  /* the hull of verts: also a polygon, a segment or a point */
    /* shapes of the stability tests alone */
    SHAPE_FRUSTUM,        /* p = radius and height of one end, of the other */
    SHAPE_SUPERELLIPSOID, /* p = half axes, exponent e: sum |x / p|^e <= 1 */
    SHAPE_HALF_DISC,      /* p = radius; y > 0, in the plane z = 0 */
    SHAPE_TEARDROP,       /* p = radius of a ball, height of a tip above its centre */
    SHAPE_HALF_BALL,      /* p = radius of the lower half of a ball, height of a tip above its flat, or 0 */
    SHAPE_CUT_BALL,       /* p = radius of a ball, height of the plane that cuts off its cap */
    SHAPE_SUM             /* parts[0] + parts[1] + a ball; p = its radius */
} shape_type_t;

enum { SHAPE_TYPES = SHAPE_POLYTOPE + 1 }; /* the first of them, of programs of users */

/* The support point of a face or an edge that is exactly perpendicular to the direction. */
enum {
    SHAPE_TIE_SIGN,  /* the vertex by the sign of the zero, +0 or -0 */
    SHAPE_TIE_CENTRE /* the middle of the tied face or edge */
};

typedef struct shape {
    shape_type_t type;
    int tie;
    ccd_real_t p[4];
    int nverts;
    const ccd_real_t *verts;   /* 3 * nverts coordinates in the local frame */
    const struct shape *parts; /* two, in this shape's frame: their poses are not read */
    ccd_real_t centre[3];    /* an inner point in the local frame */
    ccd_real_t pos[3];       /* pose: world = rot * local + pos, rot row-major */
    ccd_real_t rot[9];
    unsigned long calls;     /* support calls so far */
} shape_t;

/* --- making and placing ---------------------------------------------------- */

/* Makes a shape of any type but SHAPE_POLYTOPE; types with fewer sizes ignore the others. */
static inline shape_t shape_make(int type, double p0, double p1, double p2)
{
    shape_t s;
    memset(&s, 0, sizeof s);
    s.type = (shape_type_t)type;
    s.p[0] = (ccd_real_t)p0;
    s.p[1] = (ccd_real_t)p1;
    s.p[2] = (ccd_real_t)p2;
    s.rot[0] = s.rot[4] = s.rot[8] = (ccd_real_t)1;
    return s;
}

static inline shape_t shape_sphere(double r) { return shape_make(SHAPE_SPHERE, r, 0, 0); }
static inline shape_t shape_capsule(double r, double half) { return shape_make(SHAPE_CAPSULE, r, half, 0); }
static inline shape_t shape_box(double x, double y, double z) { return shape_make(SHAPE_BOX, x, y, z); }
static inline shape_t shape_cylinder(double r, double half) { return shape_make(SHAPE_CYLINDER, r, half, 0); }
static inline shape_t shape_cone(double r, double half) { return shape_make(SHAPE_CONE, r, half, 0); }
static inline shape_t shape_ellipsoid(double x, double y, double z) { return shape_make(SHAPE_ELLIPSOID, x, y, z); }

/* Makes the hull of n points; verts must outlive the shape. */
static inline shape_t shape_polytope(const ccd_real_t *verts, int n)
{
    shape_t s = shape_make(SHAPE_POLYTOPE, 0, 0, 0);
    s.verts = verts;
    s.nverts = n;
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < n; i++)
            sum += (double)verts[3 * i + k];
        s.centre[k] = (ccd_real_t)(sum / n);
    }
    return s;
}

static inline void shape_move(shape_t *s, double x, double y, double z)
{
    s->pos[0] = (ccd_real_t)x;
    s->pos[1] = (ccd_real_t)y;
    s->pos[2] = (ccd_real_t)z;
}

/* Moves the shape along n. */
static inline void shape_shift(shape_t *s, double by, const double n[3])
{
    shape_move(s, (double)s->pos[0] + by * n[0], (double)s->pos[1] + by * n[1], (double)s->pos[2] + by * n[2]);
}

static inline void shape_turn(shape_t *s, const double rot[9])
{
    for (int i = 0; i < 9; i++)
        s->rot[i] = (ccd_real_t)rot[i];
}

/* Row-major rotation by angle about an axis of any length; zero axis: identity. */
static inline void rotation_about(double x, double y, double z, double angle, double rot[9])
{
    double l = sqrt(x * x + y * y + z * z), c = cos(angle), s = sin(angle), t = 1 - c;
    if (!(l > 0)) {
        x = y = z = 0;
        c = 1;
        s = t = 0;
    } else {
        x /= l;
        y /= l;
        z /= l;
    }
    rot[0] = c + t * x * x;     rot[1] = t * x * y - s * z; rot[2] = t * x * z + s * y;
    rot[3] = t * x * y + s * z; rot[4] = c + t * y * y;     rot[5] = t * y * z - s * x;
    rot[6] = t * x * z - s * y; rot[7] = t * y * z + s * x; rot[8] = c + t * z * z;
}

/* Row-major rotation of the quaternion w + xi + yj + zk of any length. */
static inline void rotation_quaternion(double w, double x, double y, double z, double rot[9])
{
    double l = sqrt(w * w + x * x + y * y + z * z);
    w /= l;
    x /= l;
    y /= l;
    z /= l;
    rot[0] = 1 - 2 * (y * y + z * z); rot[1] = 2 * (x * y - w * z);     rot[2] = 2 * (x * z + w * y);
    rot[3] = 2 * (x * y + w * z);     rot[4] = 1 - 2 * (x * x + z * z); rot[5] = 2 * (y * z - w * x);
    rot[6] = 2 * (x * z - w * y);     rot[7] = 2 * (y * z + w * x);     rot[8] = 1 - 2 * (x * x + y * y);
}

/* a * b for row-major rotations; out may not alias either. */
static inline void rotation_times(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/* Rotates the shape about the world's origin, and then moves it. */
static inline void shape_turn_by(shape_t *s, const double rot[9], double x, double y, double z)
{
    double old[9], all[9], p[3];
    for (int i = 0; i < 9; i++)
        old[i] = (double)s->rot[i];
    rotation_times(rot, old, all);
    shape_turn(s, all);
    for (int i = 0; i < 3; i++)
        p[i] = rot[3 * i] * (double)s->pos[0] + rot[3 * i + 1] * (double)s->pos[1] + rot[3 * i + 2] * (double)s->pos[2];
    shape_move(s, p[0] + x, p[1] + y, p[2] + z);
}

/* --- the callbacks ---------------------------------------------------------- */

static inline void shape_farthest(const shape_t *s, const ccd_real_t d[3], ccd_real_t v[3])
{
    const int best = ccdShapeHullScan(s->verts, s->nverts, d);
    const ccd_real_t value = ccdShapeHullValue(s->verts, best, d);
    int i, ties;
    v[0] = s->verts[3 * best];
    v[1] = s->verts[3 * best + 1];
    v[2] = s->verts[3 * best + 2];
    if (s->tie != SHAPE_TIE_CENTRE)
        return;
    for (i = 0, ties = 1; i < s->nverts; i++)
        if (i != best && !(ccdShapeHullValue(s->verts, i, d) < value)) {
            v[0] += s->verts[3 * i];
            v[1] += s->verts[3 * i + 1];
            v[2] += s->verts[3 * i + 2];
            ties++;
        }
    v[0] /= (ccd_real_t)ties;
    v[1] /= (ccd_real_t)ties;
    v[2] /= (ccd_real_t)ties;
}

#define REAL ccd_real_t
#define FN(name) shape_##name
#define ROOT CCD_SQRT
#define POWER(x, y) (ccd_real_t)pow((double)(x), (double)(y))
#include "harness/shape_support.h"
#undef REAL
#undef FN
#undef ROOT
#undef POWER

/* A function of its own: benchmarks count the instructions of users' shapes, whose points stay in registers. */
__attribute__((noinline)) static void shape_odd_support(const shape_t *s, const ccd_real_t d[3], ccd_real_t v[3])
{
    shape_local_support(s, d, v);
}

/* Writes the support point in the local frame: of a shape of <ccd/shapes.h> by that header. */
__attribute__((always_inline)) static inline void shape_callback(const shape_t *s, const ccd_real_t d[3], ccd_real_t v[3])
{
    const ccd_real_t *p = s->p;
    if (s->tie != SHAPE_TIE_CENTRE)
        switch (s->type) {
        case SHAPE_SPHERE: ccdShapeSphereSupport(p[0], d, v); return;
        case SHAPE_CAPSULE: ccdShapeCapsuleSupport(p[0], p[1], d, v); return;
        case SHAPE_BOX: ccdShapeBoxSupport(p, d, v); return;
        case SHAPE_CYLINDER: ccdShapeCylinderSupport(p[0], p[1], d, v); return;
        case SHAPE_CONE: ccdShapeConeSupport(p[0], p[1], d, v); return;
        case SHAPE_ELLIPSOID: ccdShapeEllipsoidSupport(p, d, v); return;
        case SHAPE_POLYTOPE: {
            const ccd_real_t *best = s->verts + 3 * ccdShapeHullScan(s->verts, s->nverts, d);
            v[0] = best[0];
            v[1] = best[1];
            v[2] = best[2];
            return;
        }
        case SHAPE_FRUSTUM:
        case SHAPE_SUPERELLIPSOID:
        case SHAPE_HALF_DISC:
        case SHAPE_TEARDROP:
        case SHAPE_HALF_BALL:
        case SHAPE_CUT_BALL:
        case SHAPE_SUM: break;
        }
    const ccd_real_t direction[3] = {d[0], d[1], d[2]};
    ccd_real_t e[3] = {0, 0, 0};
    shape_odd_support(s, direction, e);
    v[0] = e[0];
    v[1] = e[1];
    v[2] = e[2];
}

/* Transforms a local point to the world. */
static inline void shape_to_world(const shape_t *s, const ccd_real_t v[3], ccd_real_t out[3])
{
    const ccd_real_t *r = s->rot;
    out[0] = r[0] * v[0] + r[1] * v[1] + r[2] * v[2] + s->pos[0];
    out[1] = r[3] * v[0] + r[4] * v[1] + r[5] * v[2] + s->pos[1];
    out[2] = r[6] * v[0] + r[7] * v[1] + r[8] * v[2] + s->pos[2];
}

/* ccd_support_fn */
static inline void shape_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    shape_t *s = (shape_t *)obj;
    const ccd_real_t *r = s->rot, *w = dir->v;
    ccd_real_t d[3], v[3] = {0, 0, 0};
    s->calls++;
    d[0] = r[0] * w[0] + r[3] * w[1] + r[6] * w[2];
    d[1] = r[1] * w[0] + r[4] * w[1] + r[7] * w[2];
    d[2] = r[2] * w[0] + r[5] * w[1] + r[8] * w[2];
    shape_callback(s, d, v);
    shape_to_world(s, v, out->v);
}

/* ccd_center_fn */
static inline void shape_center(const void *obj, ccd_vec3_t *out)
{
    const shape_t *s = (const shape_t *)obj;
    shape_to_world(s, s->centre, out->v);
}

/* Returns the settings of CCD_INIT with the callbacks of two shapes. */
static inline ccd_t shape_query(void)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = shape_support;
    ccd.center1 = ccd.center2 = shape_center;
    return ccd;
}

#endif
