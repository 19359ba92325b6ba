/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Scalars and vectors in three dimensions. Lengths are metres. An output may alias an input in every
 * function here. */

#ifndef __CCD_VEC3_H__
#define __CCD_VEC3_H__

#include <ccd/ccd_export.h>
#include <ccd/compiler.h>
#include <ccd/config.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#if defined(CCD_SINGLE) == defined(CCD_DOUBLE)
#error "exactly one of CCD_SINGLE and CCD_DOUBLE must be defined"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* CCD_REAL(0.1) is a literal of ccd_real_t; CCD_EPS is the distance from 1 to the next number. */
#ifdef CCD_SINGLE
typedef float ccd_real_t;
#define CCD_EPS FLT_EPSILON
#define CCD_REAL_MAX FLT_MAX
#define CCD_REAL(x) (x##f)
#define CCD_SQRT(x) (sqrtf(x))
#define CCD_FABS(x) (fabsf(x))
#define CCD_FMAX(x, y) (fmaxf((x), (y)))
#ifndef CCD_FMIN
#define CCD_FMIN(x, y) (fminf((x), (y)))
#endif
#else
typedef double ccd_real_t;
#define CCD_EPS DBL_EPSILON
#define CCD_REAL_MAX DBL_MAX
#define CCD_REAL(x) (x)
#define CCD_SQRT(x) (sqrt(x))
#define CCD_FABS(x) (fabs(x))
#define CCD_FMAX(x, y) (fmax((x), (y)))
#ifndef CCD_FMIN
#define CCD_FMIN(x, y) (fmin((x), (y)))
#endif
#endif
#define CCD_ZERO CCD_REAL(0.)
#define CCD_ONE CCD_REAL(1.)

/** A point (metres) or a direction. */
typedef struct _ccd_vec3_t {
    ccd_real_t v[3]; /**< x, y, z */
} ccd_vec3_t;

/** Initialiser of a ccd_vec3_t, and definition of a variable with it. */
#define CCD_VEC3_STATIC(x, y, z) {{(x), (y), (z)}}
#define CCD_VEC3(name, x, y, z) ccd_vec3_t name = CCD_VEC3_STATIC((x), (y), (z))

/** Read-only data: the origin, and unit vectors distributed evenly over the sphere with their
 * number. */
CCD_EXPORT extern ccd_vec3_t *ccd_vec3_origin;
CCD_EXPORT extern ccd_vec3_t *ccd_points_on_sphere;
CCD_EXPORT extern size_t ccd_points_on_sphere_len;

/** Returns the squared distance of point P from segment ab, and stores the closest point of the
 * segment in witness unless that is NULL. */
CCD_EXPORT ccd_real_t ccdVec3PointSegmentDist2(const ccd_vec3_t *P, const ccd_vec3_t *a,
                                               const ccd_vec3_t *b, ccd_vec3_t *witness);

/** Returns the squared distance of point P from triangle abc, and stores the closest point of the
 * triangle in witness unless that is NULL. */
CCD_EXPORT ccd_real_t ccdVec3PointTriDist2(const ccd_vec3_t *P, const ccd_vec3_t *a,
                                           const ccd_vec3_t *b, const ccd_vec3_t *c,
                                           ccd_vec3_t *witness);

/** Returns whether |val| is below CCD_EPS, an absolute tolerance. */
_ccd_inline int ccdIsZero(ccd_real_t val) {
    return CCD_FABS(val) < CCD_EPS;
}

/** Returns the sign, -1 or 1, or 0 where ccdIsZero. */
_ccd_inline int ccdSign(ccd_real_t val) {
    return ccdIsZero(val) ? 0 : val < CCD_ZERO ? -1 : 1;
}

/** Returns whether a and b differ by less than CCD_EPS, or by less than CCD_EPS times the larger. */
_ccd_inline int ccdEq(ccd_real_t a, ccd_real_t b) {
    const ccd_real_t difference = CCD_FABS(a - b);
    const ccd_real_t abs_a = CCD_FABS(a), abs_b = CCD_FABS(b);
    return difference < CCD_EPS || difference < CCD_EPS * (abs_b > abs_a ? abs_b : abs_a);
}

/** Return a coordinate. */
_ccd_inline ccd_real_t ccdVec3X(const ccd_vec3_t *v) {
    return v->v[0];
}

_ccd_inline ccd_real_t ccdVec3Y(const ccd_vec3_t *v) {
    return v->v[1];
}

_ccd_inline ccd_real_t ccdVec3Z(const ccd_vec3_t *v) {
    return v->v[2];
}

/** Sets v = (x, y, z). */
_ccd_inline void ccdVec3Set(ccd_vec3_t *v, ccd_real_t x, ccd_real_t y, ccd_real_t z) {
    v->v[0] = x;
    v->v[1] = y;
    v->v[2] = z;
}

/** Sets v = w. */
_ccd_inline void ccdVec3Copy(ccd_vec3_t *v, const ccd_vec3_t *w) {
    *v = *w;
}

/** Adds w to v. */
_ccd_inline void ccdVec3Add(ccd_vec3_t *v, const ccd_vec3_t *w) {
    ccdVec3Set(v, v->v[0] + w->v[0], v->v[1] + w->v[1], v->v[2] + w->v[2]);
}

/** Sets d = v - w. */
_ccd_inline void ccdVec3Sub2(ccd_vec3_t *d, const ccd_vec3_t *v, const ccd_vec3_t *w) {
    ccdVec3Set(d, v->v[0] - w->v[0], v->v[1] - w->v[1], v->v[2] - w->v[2]);
}

/** Subtracts w from v. */
_ccd_inline void ccdVec3Sub(ccd_vec3_t *v, const ccd_vec3_t *w) {
    ccdVec3Sub2(v, v, w);
}

/** Multiplies d by k. */
_ccd_inline void ccdVec3Scale(ccd_vec3_t *d, ccd_real_t k) {
    ccdVec3Set(d, d->v[0] * k, d->v[1] * k, d->v[2] * k);
}

/** Returns the dot product. */
_ccd_inline ccd_real_t ccdVec3Dot(const ccd_vec3_t *a, const ccd_vec3_t *b) {
    return a->v[0] * b->v[0] + a->v[1] * b->v[1] + a->v[2] * b->v[2];
}

/** Sets d = a x b. */
_ccd_inline void ccdVec3Cross(ccd_vec3_t *d, const ccd_vec3_t *a, const ccd_vec3_t *b) {
    ccdVec3Set(d, a->v[1] * b->v[2] - a->v[2] * b->v[1], a->v[2] * b->v[0] - a->v[0] * b->v[2],
               a->v[0] * b->v[1] - a->v[1] * b->v[0]);
}

/** Returns the squared length. */
_ccd_inline ccd_real_t ccdVec3Len2(const ccd_vec3_t *v) {
    return ccdVec3Dot(v, v);
}

/** Returns the squared distance of two points. */
_ccd_inline ccd_real_t ccdVec3Dist2(const ccd_vec3_t *a, const ccd_vec3_t *b) {
    ccd_vec3_t ab;
    ccdVec3Sub2(&ab, a, b);
    return ccdVec3Len2(&ab);
}

/** Normalises d; the result is not finite when d is zero. */
_ccd_inline void ccdVec3Normalize(ccd_vec3_t *d) {
    ccdVec3Scale(d, CCD_ONE / CCD_SQRT(ccdVec3Len2(d)));
}

/** Returns whether all coordinates are equal by ccdEq. */
_ccd_inline int ccdVec3Eq(const ccd_vec3_t *a, const ccd_vec3_t *b) {
    return ccdEq(a->v[0], b->v[0]) && ccdEq(a->v[1], b->v[1]) && ccdEq(a->v[2], b->v[2]);
}

#ifdef __cplusplus
}
#endif

#endif
