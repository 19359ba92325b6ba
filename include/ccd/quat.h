/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Quaternions (x, y, z, w), for the caller's support functions; no query takes one. An output may
 * alias an input in every function here. */

#ifndef __CCD_QUAT_H__
#define __CCD_QUAT_H__

#include <ccd/compiler.h>
#include <ccd/vec3.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A quaternion. */
typedef struct _ccd_quat_t {
    ccd_real_t q[4]; /**< x, y, z, w */
} ccd_quat_t;

/** Defines an initialised variable. */
#define CCD_QUAT(name, x, y, z, w) ccd_quat_t name = {{x, y, z, w}}

/** Sets q = (x, y, z, w). */
_ccd_inline void ccdQuatSet(ccd_quat_t *q, ccd_real_t x, ccd_real_t y, ccd_real_t z,
                            ccd_real_t w) {
    q->q[0] = x;
    q->q[1] = y;
    q->q[2] = z;
    q->q[3] = w;
}

/** Sets dest = src. */
_ccd_inline void ccdQuatCopy(ccd_quat_t *dest, const ccd_quat_t *src) {
    *dest = *src;
}

/** Returns the squared length. */
_ccd_inline ccd_real_t ccdQuatLen2(const ccd_quat_t *q) {
    return q->q[0] * q->q[0] + q->q[1] * q->q[1] + q->q[2] * q->q[2] + q->q[3] * q->q[3];
}

/** Returns the length. */
_ccd_inline ccd_real_t ccdQuatLen(const ccd_quat_t *q) {
    return CCD_SQRT(ccdQuatLen2(q));
}

/** Multiplies q by the number k. */
_ccd_inline void ccdQuatScale(ccd_quat_t *q, ccd_real_t k) {
    ccdQuatSet(q, q->q[0] * k, q->q[1] * k, q->q[2] * k, q->q[3] * k);
}

/** Normalises q and returns 1; returns 0 and leaves q when its length is below CCD_EPS. */
_ccd_inline int ccdQuatNormalize(ccd_quat_t *q) {
    const ccd_real_t len = ccdQuatLen(q);
    if (len < CCD_EPS) {
        return 0;
    }
    ccdQuatScale(q, CCD_ONE / len);
    return 1;
}

/** Sets q to the rotation by angle (radians) about axis, of any length; to no rotation when the
 * axis is shorter than CCD_EPS. */
_ccd_inline void ccdQuatSetAngleAxis(ccd_quat_t *q, ccd_real_t angle, const ccd_vec3_t *axis) {
    const ccd_real_t half = angle / 2;
    const ccd_real_t len = CCD_SQRT(ccdVec3Len2(axis));
    if (len < CCD_EPS) {
        ccdQuatSet(q, CCD_ZERO, CCD_ZERO, CCD_ZERO, CCD_ONE);
    } else {
        const ccd_real_t k = (ccd_real_t)(sin(half) / len);
        ccdQuatSet(q, axis->v[0] * k, axis->v[1] * k, axis->v[2] * k, (ccd_real_t)cos(half));
        ccdQuatNormalize(q);
    }
}

/** Sets q = a b, the rotation by b and then by a. */
_ccd_inline void ccdQuatMul2(ccd_quat_t *q, const ccd_quat_t *a, const ccd_quat_t *b) {
    const ccd_real_t ax = a->q[0], ay = a->q[1], az = a->q[2], aw = a->q[3];
    const ccd_real_t bx = b->q[0], by = b->q[1], bz = b->q[2], bw = b->q[3];
    ccdQuatSet(q, aw * bx + ax * bw + ay * bz - az * by, aw * by + ay * bw - ax * bz + az * bx,
               aw * bz + az * bw + ax * by - ay * bx, aw * bw - ax * bx - ay * by - az * bz);
}

/** Sets q = q q2. */
_ccd_inline void ccdQuatMul(ccd_quat_t *q, const ccd_quat_t *q2) {
    ccdQuatMul2(q, q, q2);
}

/** Sets q = q^-1 and returns 0; returns -1 and leaves q when its squared length is below CCD_EPS. */
_ccd_inline int ccdQuatInvert(ccd_quat_t *q) {
    const ccd_real_t len2 = ccdQuatLen2(q);
    ccd_real_t k;
    if (len2 < CCD_EPS) {
        return -1;
    }
    k = CCD_ONE / len2;
    ccdQuatSet(q, -q->q[0] * k, -q->q[1] * k, -q->q[2] * k, q->q[3] * k);
    return 0;
}

/** Sets dest = src^-1 and returns 0; sets dest = src and returns -1 when the squared length of src
 * is below CCD_EPS. */
_ccd_inline int ccdQuatInvert2(ccd_quat_t *dest, const ccd_quat_t *src) {
    ccdQuatCopy(dest, src);
    return ccdQuatInvert(dest);
}

/** Rotates v by the unit quaternion q: v + 2 u x (u x v + w v), u the vector part of q. */
_ccd_inline void ccdQuatRotVec(ccd_vec3_t *v, const ccd_quat_t *q) {
    const ccd_real_t ux = q->q[0], uy = q->q[1], uz = q->q[2], w = q->q[3];
    const ccd_real_t vx = v->v[0], vy = v->v[1], vz = v->v[2];
    const ccd_real_t cx = uy * vz - uz * vy + w * vx;
    const ccd_real_t cy = uz * vx - ux * vz + w * vy;
    const ccd_real_t cz = ux * vy - uy * vx + w * vz;
    ccdVec3Set(v, vx + 2 * (uy * cz - uz * cy), vy + 2 * (uz * cx - ux * cz),
               vz + 2 * (ux * cy - uy * cx));
}

#ifdef __cplusplus
}
#endif

#endif
