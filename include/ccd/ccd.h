/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Overlap and penetration of two convex objects that are given by support functions. All calls
 * are re-entrant and keep no state. Object pointers are passed to the callbacks and never
 * dereferenced. A callback may throw a C++ exception or longjmp out of a query. Lengths and
 * tolerances are metres; CCD_INIT's value replaces a tolerance that is negative or NaN.
 *
 * support1 and center1 are called with obj1, support2 and center2 with obj2. Moving obj2 by
 * depth * dir separates the objects; with the objects swapped depth is the same and dir the
 * opposite. */

#ifndef __CCD_H__
#define __CCD_H__

#include <ccd/vec3.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Stores in vec a point of obj farthest along dir. The library's queries pass unit, finite
 * directions. */
typedef void (*ccd_support_fn)(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *vec);

/** Stores in dir the first direction of a GJK query. */
typedef void (*ccd_first_dir_fn)(const void *obj1, const void *obj2, ccd_vec3_t *dir);

/** Stores in center a point inside the object, the deeper the better. */
typedef void (*ccd_center_fn)(const void *obj1, ccd_vec3_t *center);

/** Callbacks and settings of a query. A query reads only the fields that it names. */
typedef struct _ccd_t {
    ccd_first_dir_fn first_dir;   /**< first direction of the GJK queries */
    ccd_support_fn support1;      /**< support function of obj1 */
    ccd_support_fn support2;      /**< support function of obj2 */
    ccd_center_fn center1;        /**< center of obj1, for the MPR queries */
    ccd_center_fn center2;        /**< center of obj2, for the MPR queries */
    unsigned long max_iterations; /**< limit on the support points of a query after its first tetrahedron */
    ccd_real_t epa_tolerance;     /**< largest error of a GJK query's depth, metres */
    ccd_real_t mpr_tolerance;     /**< largest error of an MPR query's depth, metres */
    ccd_real_t dist_tolerance;    /**< largest error of ccdSignedDistance, metres */
} ccd_t;

/** Stores (1, 0, 0) in dir; the default of first_dir. */
CCD_EXPORT void ccdFirstDirDefault(const void *o1, const void *o2, ccd_vec3_t *dir);

/** Sets *ccd to the defaults. The caller must set support1 and support2, and for the MPR queries
 * center1 and center2. */
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

/** Reports whether the objects overlap, by GJK. Calls first_dir, no center. Reads no tolerance and
 * no max_iterations. Allocates nothing. Returns 1 if they overlap; 0 if they are apart or touch
 * within rounding, if a required callback is NULL or a point is not finite. */
CCD_EXPORT int ccdGJKIntersect(const void *obj1, const void *obj2, const ccd_t *ccd);

/** Computes the shortest translation of obj2 that separates the objects: sep = depth * dir, metres;
 * may be NULL. Callbacks, tolerance, memory and codes are those of ccdGJKPenetration. */
CCD_EXPORT int ccdGJKSeparate(const void *obj1, const void *obj2, const ccd_t *ccd,
                              ccd_vec3_t *sep);

/** Computes the penetration depth, the least translation that separates the objects, proven within
 * epa_tolerance. Calls first_dir, no center.
 *
 * depth: metres. dir: unit. pos: the contact position, the center of pressure. Each may be NULL.
 * Reads epa_tolerance; if 320 support points or max_iterations are used up first, depth is an
 * upper bound of the least depth. Allocates, and frees before it returns, only if the minimum is
 * (nearly) not unique, as for coaxial cylinders and concentric spheres.
 * Returns  0 when the objects overlap;
 *         -1 when they are apart or touch within rounding, when a required callback is NULL or a
 *            point is not finite; -2 when malloc fails. The outputs are unchanged then. */
CCD_EXPORT int ccdGJKPenetration(const void *obj1, const void *obj2, const ccd_t *ccd,
                                 ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);

/** Reports whether the objects overlap. Calls the centers, which must lie in their objects, not
 * first_dir. Reads no tolerance and no max_iterations. Allocates nothing. Returns the values of
 * ccdGJKIntersect. */
CCD_EXPORT int ccdMPRIntersect(const void *obj1, const void *obj2, const ccd_t *ccd);

/** Computes the penetration depth, the least translation that separates the objects. Calls the
 * centers, which must lie in their objects, not first_dir; a center outside makes the result wrong.
 *
 * depth, dir, pos: as of ccdGJKPenetration.
 * Reads mpr_tolerance: depth exceeds the least depth by at most mpr_tolerance or 0.1 % of the
 * depth, the larger of the two. If 160 support points or max_iterations are used up first, as for
 * balls whose centers are closer than 7 % of the sum of their radii, a local search follows and
 * depth is an upper bound of the least depth; ccdPenetration reports this case. Allocates nothing;
 * uses at most 44 KB of stack on x86-64.
 * Returns 0 or -1, as ccdGJKPenetration does. */
CCD_EXPORT int ccdMPRPenetration(const void *obj1, const void *obj2, const ccd_t *ccd,
                                 ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);

#ifdef __cplusplus
}
#endif

#endif
