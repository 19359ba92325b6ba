/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Overlap and penetration of two convex objects that are known by their support
 * functions alone. All calls are re-entrant and keep no state.
 *
 * The order of a pair: support1 and center1 are asked about obj1, support2 and center2
 * about obj2. dir is the way obj2 moves, by depth, to leave obj1; with the objects swapped
 * the depth is the same and dir the opposite. */

#ifndef __CCD_H__
#define __CCD_H__

#include <ccd/vec3.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Stores in vec a point of the object that lies farthest along dir, which is unit and
 * finite in every call of this library's solvers. */
typedef void (*ccd_support_fn)(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *vec);

/** Stores in dir the direction a GJK query begins with. */
typedef void (*ccd_first_dir_fn)(const void *obj1, const void *obj2, ccd_vec3_t *dir);

/** Stores in center a point inside the object, the deeper the better. */
typedef void (*ccd_center_fn)(const void *obj1, ccd_vec3_t *center);

/** The two objects' functions and how exact the answer must be. */
typedef struct _ccd_t {
    ccd_first_dir_fn first_dir;   /**< GJK starts from it */
    ccd_support_fn support1;      /**< of the first object */
    ccd_support_fn support2;      /**< of the second object */
    ccd_center_fn center1;        /**< of the first object; MPR starts from the centers */
    ccd_center_fn center2;        /**< of the second object */
    unsigned long max_iterations; /**< cap on every loop */
    ccd_real_t epa_tolerance;     /**< largest error of a GJK query's depth, metres */
    ccd_real_t mpr_tolerance;     /**< largest error of an MPR query's depth, metres */
    ccd_real_t dist_tolerance;    /**< ccdSignedDistance alone */
} ccd_t;

/** Stores (1, 0, 0) in dir. */
CCD_EXPORT void ccdFirstDirDefault(const void *o1, const void *o2, ccd_vec3_t *dir);

/** Sets *ccd to the defaults; support1 and support2 (for MPR center1 and center2 too)
 * remain to be set. */
#define CCD_INIT(ccd)                                     \
    do {                                                  \
        (ccd)->first_dir = ccdFirstDirDefault;            \
        (ccd)->support1 = NULL;                           \
        (ccd)->support2 = NULL;                           \
        (ccd)->center1 = NULL;                            \
        (ccd)->center2 = NULL;                            \
        (ccd)->max_iterations = (unsigned long)-1;        \
        (ccd)->epa_tolerance = CCD_REAL(0.0001);          \
        (ccd)->mpr_tolerance = CCD_REAL(0.0001);          \
        (ccd)->dist_tolerance = CCD_REAL(1E-6);           \
    } while (0)

/** 1 when the objects overlap, 0 when they are apart. By GJK: uses first_dir, no centers. */
CCD_EXPORT int ccdGJKIntersect(const void *obj1, const void *obj2, const ccd_t *ccd);

/** As ccdGJKPenetration; sep = depth * dir, the shortest way for obj2 to leave obj1. */
CCD_EXPORT int ccdGJKSeparate(const void *obj1, const void *obj2, const ccd_t *ccd,
                              ccd_vec3_t *sep);

/** Penetration by GJK, and the global minimum of depth over all directions.
 *
 * Returns  0 when the objects overlap; then moving obj2 by depth * dir (dir unit)
 *            separates them, and pos is the contact position;
 *         -1 when they are apart, -2 when memory cannot be had; then nothing is stored.
 * depth, dir and pos may each be NULL. Uses first_dir, no centers. */
CCD_EXPORT int ccdGJKPenetration(const void *obj1, const void *obj2, const ccd_t *ccd,
                                 ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);

/** 1 when the objects overlap, 0 when they are apart or touch within rounding. By MPR: uses
 * the centers, which are to lie in their objects, not first_dir. */
CCD_EXPORT int ccdMPRIntersect(const void *obj1, const void *obj2, const ccd_t *ccd);

/** Penetration by MPR: the least depth, within mpr_tolerance or 0.1 % of the depth, the
 * larger of the two. Where 160 support points or max_iterations iterations (one a support
 * point after the first four) were used up first, as for nearly concentric round objects,
 * the answer is the lowest that was met. Who must know asks ccdPenetrationProven.
 * Relies on the centers lying in their objects: a center outside makes the answer wrong.
 * Returns 0 or -1 and stores as ccdGJKPenetration does. A touch within rounding is -1.
 * Uses the centers, not first_dir, and no heap: 12 KB of stack for up to 22 support points,
 * 44 KB beyond. */
CCD_EXPORT int ccdMPRPenetration(const void *obj1, const void *obj2, const ccd_t *ccd,
                                 ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);

#ifdef __cplusplus
}
#endif

#endif
