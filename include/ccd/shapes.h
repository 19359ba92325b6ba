/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Ready support functions of the usual shapes: sphere, capsule, box, cylinder, cone, ellipsoid and convex
 * hull. Header only, C99 and C++, double and float; libccd's queries take them too.
 *
 *     ccd_shape_t slab = ccdShapeBox(2, 2, 0.5), ball = ccdShapeSphere(0.5);
 *     ccdVec3Set(&ball.pos, 1.9, 0, 0.9);
 *     ccd.support1 = ccd.support2 = ccdShapeSupport;
 *     ccd.center1 = ccd.center2 = ccdShapeCenter;
 *
 * A shape is a plain struct: copy it, move it, pass its address to a query. Sizes are metres, none negative;
 * zero makes a flat shape, a segment or a point. A direction has any length but zero: a query's own is a
 * unit vector, of libccd's GJK not. A support point is exact along the axes of a shape that is not rotated,
 * and elsewhere off by a few roundings; where a face or an edge is perpendicular to the
 * direction, it is one of its corners. The functions read the shape alone: any threads may share it.
 *
 * Rust's `ccd::shapes` computes the same bits, where the C compiler fuses no multiplication with an addition
 * (-ffp-contract=off; on x86-64 no compiler does unless told to use such instructions). */

#ifndef __CCD_SHAPES_H__
#define __CCD_SHAPES_H__

#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <math.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The kinds of shapes; the axis of a capsule, a cylinder and a cone is z. */
typedef enum {
    CCD_SHAPE_SPHERE,    /**< size: radius */
    CCD_SHAPE_CAPSULE,   /**< size: radius, half length of the segment between the centers of its ends */
    CCD_SHAPE_BOX,       /**< size: half lengths of its edges */
    CCD_SHAPE_CYLINDER,  /**< size: radius, half height */
    CCD_SHAPE_CONE,      /**< size: radius, half height; the tip is at +z, the base at -z */
    CCD_SHAPE_ELLIPSOID, /**< size: half axes */
    CCD_SHAPE_HULL       /**< the convex hull of points */
} ccd_shape_kind_t;

/** Points of a convex hull, which must outlive the shape. */
typedef struct _ccd_hull_t {
    const ccd_real_t *points; /**< x, y, z of each, in the shape's frame */
    int count;                /**< number of points, at least 1 */
    const int *first;         /**< NULL: every call scans all points. Else the neighbors of point i are
                                   neighbors[first[i]] to neighbors[first[i + 1] - 1]. */
    const int *neighbors;     /**< indices of the points that share an edge with each point */
    int start[6];             /**< the farthest points along x, y, z, -x, -y, -z */
} ccd_hull_t;

/** A shape with its pose. */
typedef struct _ccd_shape_t {
    ccd_vec3_t pos;        /**< position of the shape's own origin */
    ccd_quat_t quat;       /**< rotation, a unit quaternion (x, y, z, w); all zeros: none */
    ccd_shape_kind_t kind; /**< which shape */
    ccd_real_t size[3];    /**< metres, by the kind; of a hull the mean of its points */
    ccd_hull_t hull;       /**< of a hull */
} ccd_shape_t;

/* --- support points in the shape's own frame -------------------------------------------------------- */

/** Returns h with the sign of d, also of a zero. */
_ccd_inline ccd_real_t ccdShapeToward(ccd_real_t d, ccd_real_t h) {
    return (ccd_real_t)copysign((double)h, (double)d);
}

/** Returns the length of v, zero only if v is. Scales v where its square under- or overflows. */
_ccd_inline ccd_real_t ccdShapeLength(ccd_real_t v[3]) {
    /* Squares below lose digits: the smallest normal number over the epsilon. */
    const ccd_real_t least = sizeof(ccd_real_t) == sizeof(float) ? (ccd_real_t)(FLT_MIN / FLT_EPSILON)
                                                                 : (ccd_real_t)(DBL_MIN / DBL_EPSILON);
    ccd_real_t len2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], most = 0;
    int i;
    if (len2 > least && len2 <= CCD_REAL_MAX) {
        return CCD_SQRT(len2);
    }
    for (i = 0; i < 3; i++) {
        most = CCD_FABS(v[i]) > most ? CCD_FABS(v[i]) : most;
    }
    if (!(most > 0)) {
        return 0;
    }
    for (i = 0; i < 3; i++) {
        v[i] /= most;
    }
    return CCD_SQRT(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/** Writes the point of a sphere farthest along d. */
_ccd_inline void ccdShapeSphereSupport(ccd_real_t radius, const ccd_real_t d[3], ccd_real_t out[3]) {
    ccd_real_t e[3], len;
    e[0] = d[0];
    e[1] = d[1];
    e[2] = d[2];
    len = ccdShapeLength(e);
    len = len > 0 ? radius / len : 0;
    out[0] = e[0] * len;
    out[1] = e[1] * len;
    out[2] = e[2] * len;
}

/** Writes the point of a capsule farthest along d. */
_ccd_inline void ccdShapeCapsuleSupport(ccd_real_t radius, ccd_real_t half, const ccd_real_t d[3], ccd_real_t out[3]) {
    ccdShapeSphereSupport(radius, d, out);
    out[2] += ccdShapeToward(d[2], half);
}

/** Writes the corner of a box farthest along d. */
_ccd_inline void ccdShapeBoxSupport(const ccd_real_t half[3], const ccd_real_t d[3], ccd_real_t out[3]) {
    out[0] = ccdShapeToward(d[0], half[0]);
    out[1] = ccdShapeToward(d[1], half[1]);
    out[2] = ccdShapeToward(d[2], half[2]);
}

/** Writes x and y of the point of a disc around the z axis farthest along d. */
_ccd_inline void ccdShapeRim(ccd_real_t radius, const ccd_real_t d[3], ccd_real_t out[3]) {
    ccd_real_t e[3], len;
    e[0] = d[0];
    e[1] = d[1];
    e[2] = 0;
    len = ccdShapeLength(e);
    if (len > 0) {
        out[0] = radius * (e[0] / len);
        out[1] = radius * (e[1] / len);
    } else {
        out[0] = ccdShapeToward(d[0], radius);
        out[1] = 0;
    }
}

/** Writes the point of a cylinder farthest along d. */
_ccd_inline void ccdShapeCylinderSupport(ccd_real_t radius, ccd_real_t half, const ccd_real_t d[3], ccd_real_t out[3]) {
    ccdShapeRim(radius, d, out);
    out[2] = ccdShapeToward(d[2], half);
}

/** Writes the point of a cone farthest along d: the tip, or a point of the rim. */
_ccd_inline void ccdShapeConeSupport(ccd_real_t radius, ccd_real_t half, const ccd_real_t d[3], ccd_real_t out[3]) {
    ccdShapeRim(radius, d, out);
    out[2] = -half;
    if (2 * half * d[2] - (out[0] * d[0] + out[1] * d[1]) >= 0) {
        out[0] = out[1] = 0;
        out[2] = half;
    }
}

/** Writes the point of an ellipsoid farthest along d. */
_ccd_inline void ccdShapeEllipsoidSupport(const ccd_real_t half[3], const ccd_real_t d[3], ccd_real_t out[3]) {
    ccd_real_t e[3], len;
    e[0] = half[0] * d[0];
    e[1] = half[1] * d[1];
    e[2] = half[2] * d[2];
    len = ccdShapeLength(e);
    len = len > 0 ? len : 1; /* a flat one: its center */
    out[0] = half[0] * (e[0] / len);
    out[1] = half[1] * (e[1] / len);
    out[2] = half[2] * (e[2] / len);
}

/** Returns how far point i of a hull is along d. */
_ccd_inline ccd_real_t ccdShapeHullValue(const ccd_real_t *points, int i, const ccd_real_t d[3]) {
    const ccd_real_t *p = points + 3 * (size_t)i;
    return p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
}

/** Returns the index of the farthest of all points along d, the first of equal ones. */
_ccd_inline int ccdShapeHullScan(const ccd_real_t *points, int count, const ccd_real_t d[3]) {
    ccd_real_t most = ccdShapeHullValue(points, 0, d);
    int i, best = 0;
    for (i = 1; i < count; i++) {
        const ccd_real_t value = ccdShapeHullValue(points, i, d);
        if (value > most) {
            most = value;
            best = i;
        }
    }
    return best;
}

/** Returns the index of a farthest point along d, by hill climbing: from the farthest point along the axis
 * that is closest to d on to the farthest neighbor, until none is farther. Ends, because the value of each
 * point is above the last one's. */
_ccd_inline int ccdShapeHullClimb(const ccd_hull_t *hull, const ccd_real_t d[3]) {
    ccd_real_t most;
    int i, at, best, axis = 0;
    for (i = 1; i < 3; i++) {
        axis = CCD_FABS(d[i]) > CCD_FABS(d[axis]) ? i : axis;
    }
    best = hull->start[d[axis] < 0 ? axis + 3 : axis];
    most = ccdShapeHullValue(hull->points, best, d);
    do {
        at = best;
        for (i = hull->first[at]; i < hull->first[at + 1]; i++) {
            const ccd_real_t value = ccdShapeHullValue(hull->points, hull->neighbors[i], d);
            if (value > most) {
                most = value;
                best = hull->neighbors[i];
            }
        }
    } while (best != at);
    return best;
}

/** Writes the point of a hull farthest along d. */
_ccd_inline void ccdShapeHullSupport(const ccd_hull_t *hull, const ccd_real_t d[3], ccd_real_t out[3]) {
    const int best = hull->first ? ccdShapeHullClimb(hull, d) : ccdShapeHullScan(hull->points, hull->count, d);
    out[0] = hull->points[3 * (size_t)best];
    out[1] = hull->points[3 * (size_t)best + 1];
    out[2] = hull->points[3 * (size_t)best + 2];
}

/* --- making ----------------------------------------------------------------------------------------- */

/** Returns a shape of any kind but a hull at the origin, not rotated; a kind of fewer sizes ignores the others. */
_ccd_inline ccd_shape_t ccdShape(ccd_shape_kind_t kind, ccd_real_t size0, ccd_real_t size1, ccd_real_t size2) {
    ccd_shape_t shape;
    int i;
    ccdVec3Set(&shape.pos, 0, 0, 0);
    ccdQuatSet(&shape.quat, 0, 0, 0, 1);
    shape.kind = kind;
    shape.size[0] = size0;
    shape.size[1] = size1;
    shape.size[2] = size2;
    shape.hull.points = NULL;
    shape.hull.count = 0;
    shape.hull.first = shape.hull.neighbors = NULL;
    for (i = 0; i < 6; i++) {
        shape.hull.start[i] = 0;
    }
    return shape;
}

/** Returns a sphere. */
_ccd_inline ccd_shape_t ccdShapeSphere(ccd_real_t radius) {
    return ccdShape(CCD_SHAPE_SPHERE, radius, 0, 0);
}

/** Returns a capsule along z; half: half the length of the segment between the centers of its ends. */
_ccd_inline ccd_shape_t ccdShapeCapsule(ccd_real_t radius, ccd_real_t half) {
    return ccdShape(CCD_SHAPE_CAPSULE, radius, half, 0);
}

/** Returns a box with these half lengths of its edges. */
_ccd_inline ccd_shape_t ccdShapeBox(ccd_real_t x, ccd_real_t y, ccd_real_t z) {
    return ccdShape(CCD_SHAPE_BOX, x, y, z);
}

/** Returns a cylinder along z; half: half its height. */
_ccd_inline ccd_shape_t ccdShapeCylinder(ccd_real_t radius, ccd_real_t half) {
    return ccdShape(CCD_SHAPE_CYLINDER, radius, half, 0);
}

/** Returns a cone along z with its tip at z = half, its base at z = -half. */
_ccd_inline ccd_shape_t ccdShapeCone(ccd_real_t radius, ccd_real_t half) {
    return ccdShape(CCD_SHAPE_CONE, radius, half, 0);
}

/** Returns an ellipsoid with these half axes. */
_ccd_inline ccd_shape_t ccdShapeEllipsoid(ccd_real_t x, ccd_real_t y, ccd_real_t z) {
    return ccdShape(CCD_SHAPE_ELLIPSOID, x, y, z);
}

/** Returns the convex hull of count points (x, y, z of each), at least one, which must outlive it; every call
 * scans all of them. */
_ccd_inline ccd_shape_t ccdShapeHull(const ccd_real_t *points, int count) {
    ccd_shape_t shape = ccdShape(CCD_SHAPE_HULL, 0, 0, 0);
    int i, k;
    shape.hull.points = points;
    shape.hull.count = count;
    for (k = 0; k < 3; k++) {
        double sum = 0;
        ccd_real_t d[3];
        for (i = 0; i < count; i++) {
            sum += (double)points[3 * (size_t)i + (size_t)k];
        }
        shape.size[k] = (ccd_real_t)(sum / count);
        d[0] = d[1] = d[2] = 0;
        d[k] = 1;
        shape.hull.start[k] = ccdShapeHullScan(points, count, d);
        d[k] = -1;
        shape.hull.start[k + 3] = ccdShapeHullScan(points, count, d);
    }
    return shape;
}

/** Returns the same for points that are all corners of their hull, with the neighbors along its edges (see
 * ccd_hull_t): calls climb from point to point, which is faster from about 100 points on. Neighbors that
 * share no edge do not matter; if one that does is missing, a support point may be wrong. */
_ccd_inline ccd_shape_t ccdShapeHullWithNeighbors(const ccd_real_t *points, int count, const int *first, const int *neighbors) {
    ccd_shape_t shape = ccdShapeHull(points, count);
    shape.hull.first = first;
    shape.hull.neighbors = neighbors;
    return shape;
}

/* --- the callbacks ---------------------------------------------------------------------------------- */

/** The support function of every ccd_shape_t, a ccd_support_fn. */
_ccd_inline void ccdShapeSupport(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out) {
    const ccd_shape_t *shape = (const ccd_shape_t *)obj;
    const ccd_real_t *size = shape->size;
    ccd_quat_t back = shape->quat;
    ccd_vec3_t d = *dir, p;
    /* The matrix of the opposite rotation is the transposed one: the point is the farthest one of the rotated
     * shape also where a quaternion is not quite a unit one. */
    back.q[0] = -back.q[0];
    back.q[1] = -back.q[1];
    back.q[2] = -back.q[2];
    ccdQuatRotVec(&d, &back);
    p = d;
    switch (shape->kind) {
    case CCD_SHAPE_SPHERE:
        ccdShapeSphereSupport(size[0], d.v, p.v);
        break;
    case CCD_SHAPE_CAPSULE:
        ccdShapeCapsuleSupport(size[0], size[1], d.v, p.v);
        break;
    case CCD_SHAPE_BOX:
        ccdShapeBoxSupport(size, d.v, p.v);
        break;
    case CCD_SHAPE_CYLINDER:
        ccdShapeCylinderSupport(size[0], size[1], d.v, p.v);
        break;
    case CCD_SHAPE_CONE:
        ccdShapeConeSupport(size[0], size[1], d.v, p.v);
        break;
    case CCD_SHAPE_ELLIPSOID:
        ccdShapeEllipsoidSupport(size, d.v, p.v);
        break;
    case CCD_SHAPE_HULL:
        ccdShapeHullSupport(&shape->hull, d.v, p.v);
        break;
    }
    ccdQuatRotVec(&p, &shape->quat);
    ccdVec3Set(out, p.v[0] + shape->pos.v[0], p.v[1] + shape->pos.v[1], p.v[2] + shape->pos.v[2]);
}

/** The center of every ccd_shape_t, a ccd_center_fn: the shape's origin, of a hull the mean of its points. */
_ccd_inline void ccdShapeCenter(const void *obj, ccd_vec3_t *out) {
    const ccd_shape_t *shape = (const ccd_shape_t *)obj;
    ccd_vec3_t p;
    ccdVec3Set(&p, 0, 0, 0);
    if (shape->kind == CCD_SHAPE_HULL) {
        ccdVec3Set(&p, shape->size[0], shape->size[1], shape->size[2]);
    }
    ccdQuatRotVec(&p, &shape->quat);
    ccdVec3Set(out, p.v[0] + shape->pos.v[0], p.v[1] + shape->pos.v[1], p.v[2] + shape->pos.v[2]);
}

#ifdef __cplusplus
}
#endif

#endif
