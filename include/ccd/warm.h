/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Extends libccd's ccd.h by queries that start warm: from the result of the pair's last query.
 * cbindgen makes include/ccd/warm.h from src/ffi/warm/; edit there.
 *
 * Start with ccdPenetration and one ccd_warm_t for each pair, zeroed at first and kept between
 * frames. The sections:
 *
 *   codes        returned by every call that fills a struct
 *   states       ccd_warm_t, ccdWarmGuess, ccdWarmFlip
 *   flags        CCD_WANT_: outputs that are computed only if they are requested
 *   penetration  ccdPenetration: overlap, depth, direction, contact position
 *   overlap      ccdIntersect
 *   distance     ccdSignedDistance
 *   contacts     ccdContacts
 *   special      ccdPenetrationLocal, ...Proven, ...Along, ...Planar
 *   libccd       ccdMPRPenetrationWarm, ccdMPRIntersectWarm
 *   check        ccdCheck: tests a support function
 *   identity     ccdImplementation
 *
 * A support point is a boundary point of the Minkowski difference D = obj1 - obj2: one call of
 * support1 along a direction and one of support2 along its opposite. A depth is sound if moving obj2
 * by depth * dir separates the objects; it may exceed the least depth. A cold start begins along the
 * line of the centers if both are given, else along first_dir, else along (1, 0, 0): in this header
 * center1, center2 and first_dir may be NULL except where stated. A center that is given must lie
 * in its object.
 *
 * Lengths and tolerances are metres. Tolerances are raised to a few units in the last place of the
 * coordinates, so 0 selects the smallest, and lowered to 2.5e-4 of the size of D, which is max |p|
 * for p in D. A call reads only the tolerance that it names. max_iterations limits the support
 * points after the first tetrahedron or portal (in ccdPenetrationPlanar the portal steps). The
 * library's own limits are 160, 320 for ...Proven, ...Along and ...Planar, 380 for distances; no
 * query takes more than 500 support points in the tests. Object pointers are passed to the callbacks
 * and never dereferenced. Queries are re-entrant and keep no data except the caller's state.
 *
 * C++ exceptions and longjmp pass from a callback through every call. Out of a proof of more than some
 * 160 support points (ccdPenetrationProven, ccdSignedDistance, libccd's GJK penetration and separation)
 * they leak its one block of malloc, 99 KB.
 *
 * All statements assume convex objects and support functions that return a farthest point. If points
 * of a support function contradict each other, depth is sound only for the points that it returned,
 * and status may be CCD_STATUS_INCONSISTENT_SUPPORT; ccdCheck finds such faults. */

#ifndef __CCD_WARM_H__
#define __CCD_WARM_H__

#include <ccd/ccd.h>

#ifdef __cplusplus
extern "C" {
#endif


/* Codes: returned by every call that fills a struct.
 *
 * Code >= 0: *out is filled. Code < 0: nothing is written, except that ccdSignedDistance fills
 * *out on CCD_MISS too. CCD_BAD_INPUT and CCD_NO_MEMORY leave the state unchanged; every other
 * code updates it for the next query.
 *
 * ccdIntersect returns 1 or 0, ccdContacts the number of contacts or CCD_BAD_INPUT, and calls
 * with MPR in their name libccd's codes.
 *
 * The field status of a filled struct is the cause of the end of the search, a CCD_STATUS_ value.
 * The code is CCD_LIMIT if and only if status is not CCD_STATUS_CONVERGED. */

/**
 * The objects overlap by more than rounding.
 */
#define CCD_HIT 0

/**
 * The result is less exact than requested; status says why, and which outputs are valid. A
 * penetration query has found an overlap; for ccdSignedDistance the overlap may be undecided
 * (distance < 0 < distance_upper).
 */
#define CCD_LIMIT 1

/**
 * The objects are apart, or touch within rounding.
 */
#define CCD_MISS (-1)

/**
 * malloc failed.
 */
#define CCD_NO_MEMORY (-2)

/**
 * An argument, a field of ccd or a point of a callback is invalid: NULL where a pointer is
 * required, NaN, a negative length, a zero direction, an unknown flag, a point that is not finite.
 */
#define CCD_BAD_INPUT (-3)

/**
 * The search ended within the tolerance. All outputs are valid.
 */
#define CCD_STATUS_CONVERGED 0

/**
 * max_iterations was reached. Depth, distances, bounds, directions and witness points are valid;
 * their error is at most the gap between the bounds.
 */
#define CCD_STATUS_ITERATION_LIMIT 1

/**
 * The library's own limit of support points was reached. Valid as for CCD_STATUS_ITERATION_LIMIT.
 */
#define CCD_STATUS_SUPPORT_LIMIT 2

/**
 * Rounding ended the search: more support points would not help. Valid as for
 * CCD_STATUS_ITERATION_LIMIT.
 */
#define CCD_STATUS_ROUNDING 3

/**
 * Two points of a support function contradict each other, or a center is outside its object.
 * depth is sound for the points that were returned; nothing is proven, and depth_lower is 0.
 * ccdCheck finds such faults.
 */
#define CCD_STATUS_INCONSISTENT_SUPPORT 4


/* States: carried from one query of a pair to the next. */

/**
 * Number of reals in a ccd_warm_t.
 */
#define CCD_WARM_REALS 6

/**
 * State of one pair between queries. Plain data without pointers, nothing to free: all bytes
 * zero is cold, and copies are valid.
 *
 * A state belongs to one pair in one order: ccdWarmFlip converts the state of (a, b) to one of
 * (b, a). Every call accepts the state that any other call has written. Two threads must not use
 * one state at once. NULL in place of a state is a cold start; nothing is stored.
 *
 * A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to another
 * local minimum; every result stays sound. The fields are private.
 */
typedef struct ccd_warm_t {
  /**
   * Private.
   */
  double reals[CCD_WARM_REALS];
  /**
   * Private.
   */
  unsigned int words[2];
} ccd_warm_t;

/**
 * Makes `warm` a new state that starts from `dir`, a guess of the penetration direction, along
 * which obj2 moves to separate.
 *
 * `dir`: of any length; NULL, zero or not finite makes a cold state. `warm`: NULL has no effect.
 */
CCD_EXPORT void ccdWarmGuess(ccd_warm_t *warm, const ccd_vec3_t *dir);

/**
 * Converts a state of the pair (obj1, obj2) to one of (obj2, obj1), for a caller who keeps one
 * state for each pair and queries it in either order.
 *
 * `warm`: cold stays cold; NULL has no effect.
 */
CCD_EXPORT void ccdWarmFlip(ccd_warm_t *warm);


/* Flags: outputs that a call computes only if they are requested. */

/**
 * Requests pos. Costs, on average, 3 to 7 support points where the face of one object contains that of
 * the other, 9 where neither does; in all tests at most 24. May call one support function without the
 * other.
 */
#define CCD_WANT_POS 1

/**
 * Requests point1 and point2, at no cost.
 */
#define CCD_WANT_POINTS 2

/**
 * Requests all of these.
 */
#define CCD_WANT_ALL 3


/* Penetration: overlap, depth, direction, contact position. The default call. */

/**
 * Result of a penetration query. A field that was not requested is zero.
 */
typedef struct ccd_penetration_t {
  /**
   * Penetration depth, metres, >= 0: moving obj2 by depth * dir separates the objects. The
   * support value of normal, divided by dir . normal.
   */
  ccd_real_t depth;
  /**
   * Lower bound of the globally least depth (in ccdPenetrationAlong: of the depth along dir),
   * metres; 0 if there is none. Proven if the centers lie in their objects; only
   * ccdPenetrationProven does not rely on them.
   */
  ccd_real_t depth_lower;
  /**
   * Penetration direction, unit: obj2 moves along it.
   */
  ccd_vec3_t dir;
  /**
   * Contact normal, unit: normal of the separating plane. Equal to dir except in
   * ccdPenetrationAlong.
   */
  ccd_vec3_t normal;
  /**
   * Contact position, CCD_WANT_POS: the center of pressure, an estimate of the centroid of the
   * overlap volume, projected along normal to the plane midway between the two support planes; the
   * deeper the overlap, the nearer it is instead to a point between the centers, beside that plane. At
   * most half the depth from both objects, within the tolerance. Root mean square error for objects
   * of a quarter metre and depths up to a millimetre: 0.2 mm for faces of 3 to 6 corners, and regular
   * ones of up to 10, on a floor; 3 mm for other faces and for boxes in any pose; 8 mm for round
   * objects and discs; 12 mm for flat bars with a curved underside; 15 mm for a cone on its side; in
   * single precision 1 mm more. For greater depths 2 % of the smaller object's radius at a depth of 3 %
   * of it, 6 % at 10 %, 20 % at 30 %. In a motion of 0.01 degrees pos of leaning discs jumps by at most
   * 6 mm, of cones and half balls by 13 mm, of flat bars by up to 55 mm. With CCD_LIMIT, in
   * ccdPenetrationAlong and ccdPenetrationPlanar, the middle of the witness points.
   */
  ccd_vec3_t pos;
  /**
   * Witness point of obj1, CCD_WANT_POINTS: in obj1 and on its support plane, within the larger
   * of the error of depth and 1e-12 of the size (1e-5 in single precision).
   */
  ccd_vec3_t point1;
  /**
   * Witness point of obj2, CCD_WANT_POINTS: as point1.
   */
  ccd_vec3_t point2;
  /**
   * Number of support points: half of the calls of support1 and support2 together, rounded up.
   */
  unsigned long support_points;
  /**
   * Number of iterations of the solver.
   */
  unsigned long iterations;
  /**
   * Why the search ended: a CCD_STATUS_ value.
   */
  int status;
} ccd_penetration_t;

/**
 * Computes the penetration depth: the least distance by which obj2 must move to separate the
 * objects. The default call.
 *
 * `warm`: the pair's state, may be NULL; with a state a pair that stays apart costs one support
 * point, and an overlap fewer than a cold start. `want`: CCD_WANT_ flags; 0 for only depth, bound
 * and directions. Centers save support points; overlap and depth_lower rely on them.
 *
 * Reads mpr_tolerance: depth exceeds the least depth by at most mpr_tolerance or 0.1 % of the
 * depth, the larger of the two; with CCD_LIMIT it is a sound upper bound. Allocates nothing.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
 */
CCD_EXPORT
int ccdPenetration(const void *obj1,
                   const void *obj2,
                   const ccd_t *ccd,
                   ccd_warm_t *warm,
                   unsigned int want,
                   ccd_penetration_t *out);


/* Overlap: yes or no. */

/**
 * Reports whether the objects overlap.
 *
 * `warm`: the pair's state, may be NULL; with a state a pair costs one support point while its
 * last separating axis still separates.
 *
 * Reads no tolerance and no max_iterations. Allocates nothing.
 *
 * Returns 1 if they overlap; 0 if they are apart or touch within rounding, when support1 or
 * support2 is NULL, or when a center or a point is not finite.
 */
CCD_EXPORT int ccdIntersect(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm);


/* Distance: gap or depth. */

/**
 * Result of ccdSignedDistance. A field that was not requested is zero.
 */
typedef struct ccd_distance_t {
  /**
   * Proven lower bound of the signed distance, metres: the gap along normal where the objects
   * are apart, minus the depth where they overlap.
   */
  ccd_real_t distance;
  /**
   * Proven upper bound of the signed distance, metres: |point1 - point2| where the objects are
   * apart, minus the lower bound of the depth where they overlap. distance_upper - distance <=
   * dist_tolerance unless CCD_LIMIT was returned or distance > max_distance.
   */
  ccd_real_t distance_upper;
  /**
   * Unit, from obj1 to obj2: moving obj2 along it increases the distance.
   */
  ccd_vec3_t normal;
  /**
   * Witness point on the surface of obj1 with its margin, CCD_WANT_POINTS.
   */
  ccd_vec3_t point1;
  /**
   * Witness point on the surface of obj2 with its margin, CCD_WANT_POINTS.
   */
  ccd_vec3_t point2;
  /**
   * Number of support points: half of the calls of support1 and support2 together, rounded up.
   */
  unsigned long support_points;
  /**
   * Number of iterations of the solver.
   */
  unsigned long iterations;
  /**
   * Why the search ended: a CCD_STATUS_ value.
   */
  int status;
} ccd_distance_t;

/**
 * Computes the signed distance: the gap of objects that are apart, minus the penetration depth of
 * objects that overlap; continuous at contact.
 *
 * `margin1`, `margin2`: metres, >= 0; radii of balls added all around the objects, whose support
 * functions return the cores (a sphere is a point with a margin, a capsule a segment, a rounded box
 * a box). The signed distance is that of the cores minus both margins, exactly. `max_distance`:
 * metres, >= 0; the search ends when the distance is proven to be greater, never with INFINITY.
 * `warm`: may be NULL. `want`: CCD_WANT_POINTS or 0; CCD_WANT_POS has no effect.
 *
 * Reads dist_tolerance. Allocates only if the cores overlap and their least depth is (nearly) not
 * unique, as for concentric spheres.
 *
 * Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding with distance 0; *out is
 * filled), CCD_LIMIT (the bounds have not met), CCD_BAD_INPUT or CCD_NO_MEMORY.
 */
CCD_EXPORT
int ccdSignedDistance(const void *obj1,
                      const void *obj2,
                      const ccd_t *ccd,
                      ccd_real_t margin1,
                      ccd_real_t margin2,
                      ccd_real_t max_distance,
                      ccd_warm_t *warm,
                      unsigned int want,
                      ccd_distance_t *out);


/* Contacts: where two objects touch. */

/**
 * Number of reals in a ccd_manifold_cache_t.
 */
#define CCD_MANIFOLD_CACHE_REALS 139

/**
 * Warm-start data of ccdContacts for one pair, in either order. All bytes zero: empty. Plain
 * data: it may be copied and stored. Stale or random contents only cost time.
 */
typedef struct ccd_manifold_cache_t {
  /**
   * Private.
   */
  float reals[CCD_MANIFOLD_CACHE_REALS];
  /**
   * Private.
   */
  unsigned int words[9];
  /**
   * Private.
   */
  unsigned int checksum;
} ccd_manifold_cache_t;

/**
 * One point of a contact manifold.
 */
typedef struct ccd_contact_t {
  /**
   * Within the slop of the surface of obj1.
   */
  ccd_vec3_t point1;
  /**
   * point1 - depth * normal; within the slop of the surface of obj2. If the faces do not overlap in
   * projection, the closest point of obj2's face instead.
   */
  ccd_vec3_t point2;
  /**
   * Metres, at least the support value of normal minus twice the slop; negative if the objects are
   * apart there.
   */
  ccd_real_t depth;
  /**
   * Contact id: the same while the contact moves with obj1 or obj2, never 0; 0 without a cache. When a
   * contact vanishes, a new one within a quarter of the overlap's extent takes its id.
   */
  unsigned int id;
} ccd_contact_t;

/**
 * Computes the contact manifold: the overlap of the two faces along `normal`, projected along it
 * and reduced to at most `max` contacts, the deepest first, the others in order around the normal,
 * chosen for the largest area.
 *
 * `normal`: of a result for this pose (`dir` of calls that have no normal), of any length.
 * `slop`, metres, >= 0: largest distance of a corner below its support plane at which it still
 * belongs to the face; a thousandth of the objects' size is good for resting contacts. Corners
 * between half the slop and the slop may be found or not. If `normal` is off by an angle, the
 * slop must be at least that angle times the extent of the face, or only an edge or a corner is
 * found. For normals of this library 1 % of the depth is enough. The slop is therefore raised to
 * 1 % of the depth along `normal` and to 32 ulps of the largest coordinate; it is at most the
 * size of the face.
 *
 * Rounded edges and corners are reduced to their core: a sphere gives one contact, a lying capsule
 * or cylinder two. A face of more than 9 corners is replaced by an inscribed polygon. If the faces
 * do not overlap in projection, there is one contact, with the closest point of each face. The
 * overlap moves continuously with the objects. For objects with margins, the caller moves the
 * points by the margins along the normal.
 *
 * `cache`: NULL, or the pair's. An object whose face is that of the last call then takes half the
 * support calls, and contacts keep their ids, with which a solver can reuse the last impulses. If
 * there are more than `max` contacts, the cache also makes the choice of those kept steadier.
 *
 * Reads no tolerance, center or max_iterations. At most 24 support calls for each object, 12 for a
 * box, and 10 more if the cache is out of date. Allocates nothing.
 *
 * Returns the number of contacts written, at least 1. Returns CCD_BAD_INPUT, and writes nothing, if
 * `normal` is zero, not finite or NULL, `slop` negative or NaN, `max` < 1, `contacts`, `ccd` or a
 * support callback NULL, or a point of a callback not finite.
 */
CCD_EXPORT
int ccdContacts(const void *obj1,
                const void *obj2,
                const ccd_t *ccd,
                const ccd_vec3_t *normal,
                ccd_real_t slop,
                ccd_manifold_cache_t *cache,
                ccd_contact_t *contacts,
                int max);


/* Special penetration queries: local minimum, proven minimum, along a direction, in a plane. */

/**
 * Computes a local minimum of the penetration depth by a local search from the state's direction.
 * Faster than ccdPenetration if that direction is roughly right; from a distant one it may find
 * another minimum. If the search does not converge, ccdPenetration's search follows.
 *
 * `warm`: may be NULL. `want`: CCD_WANT_ flags.
 *
 * Reads mpr_tolerance. Allocates nothing.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
 */
CCD_EXPORT
int ccdPenetrationLocal(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        ccd_warm_t *warm,
                        unsigned int want,
                        ccd_penetration_t *out);

/**
 * Computes the globally least penetration depth with a certificate: depth - depth_lower <=
 * epa_tolerance on CCD_HIT. Does not rely on the centers.
 *
 * `warm`: may be NULL. `want`: CCD_WANT_ flags.
 *
 * Reads epa_tolerance. Allocates only if the minimum is (nearly) not unique, as for coaxial
 * cylinders and concentric spheres; the bounds may then not meet, and CCD_LIMIT is returned: for
 * balls whose centers are closer than 5 % of the sum of their radii, at a tolerance of 1e-6 of the
 * size 8 %.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS, CCD_BAD_INPUT or CCD_NO_MEMORY.
 */
CCD_EXPORT
int ccdPenetrationProven(const void *obj1,
                         const void *obj2,
                         const ccd_t *ccd,
                         ccd_warm_t *warm,
                         unsigned int want,
                         ccd_penetration_t *out);

/**
 * Computes the directional penetration depth: the least distance by which obj2 must move along
 * `dir` to separate the objects.
 *
 * `dir`: of any length; NULL, zero or not finite is CCD_BAD_INPUT. `warm`: may be NULL. `want`:
 * CCD_WANT_ flags.
 *
 * Reads mpr_tolerance, measured along `dir`. Allocates nothing.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
 */
CCD_EXPORT
int ccdPenetrationAlong(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        const ccd_vec3_t *dir,
                        ccd_warm_t *warm,
                        unsigned int want,
                        ccd_penetration_t *out);

/**
 * Computes a local minimum of the penetration depth over the directions in a plane, for objects
 * that lie in a common plane.
 *
 * `plane_normal`: of any length; NULL, zero or not finite is CCD_BAD_INPUT. `warm`: may be NULL.
 * `want`: CCD_WANT_ flags.
 *
 * Reads mpr_tolerance. Allocates nothing.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
 */
CCD_EXPORT
int ccdPenetrationPlanar(const void *obj1,
                         const void *obj2,
                         const ccd_t *ccd,
                         const ccd_vec3_t *plane_normal,
                         ccd_warm_t *warm,
                         unsigned int want,
                         ccd_penetration_t *out);


/* libccd's MPR calls with a state, for programs that use libccd: outputs and codes are libccd's,
 * and center1 and center2 are required. */

/**
 * Computes the penetration depth as ccdMPRPenetration does, with a state.
 *
 * `warm`: may be NULL. `depth`, `dir`, `pos`: each may be NULL; NULL for `pos` saves the cost of
 * CCD_WANT_POS.
 *
 * Reads mpr_tolerance; CCD_INIT's value replaces a negative or NaN one. Allocates nothing.
 *
 * Returns 0 where ccdPenetration returns CCD_HIT or CCD_LIMIT; -1, with the outputs unchanged,
 * where it returns CCD_MISS or CCD_BAD_INPUT, or when a center callback is NULL.
 */
CCD_EXPORT
int ccdMPRPenetrationWarm(const void *obj1,
                          const void *obj2,
                          const ccd_t *ccd,
                          ccd_warm_t *warm,
                          ccd_real_t *depth,
                          ccd_vec3_t *dir,
                          ccd_vec3_t *pos);

/**
 * Reports whether the objects overlap as ccdMPRIntersect does, with a state.
 *
 * `warm`: may be NULL.
 *
 * Reads no tolerance and no max_iterations. Allocates nothing.
 *
 * Returns the value of ccdIntersect; 0 when a center callback is NULL.
 */
CCD_EXPORT
int ccdMPRIntersectWarm(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        ccd_warm_t *warm);


/* Check: tests an object's support function and center. */

/**
 * A point or the center is NaN or infinite. Nothing else is tested then.
 */
#define CCD_CHECK_NOT_FINITE 1

/**
 * The points are the farthest *against* the direction: a sign is wrong.
 */
#define CCD_CHECK_OPPOSITE 2

/**
 * A point is beyond the support plane of another direction by `noise`, more than rounding. If the
 * noise is of the order of single precision, use tolerances of several times the noise or more. A
 * greater noise shows a wrong frame (the direction must be rotated to the body's frame, the point
 * back), points of another object, or a search over the vertices that stops too early.
 */
#define CCD_CHECK_CONTRADICTS 4

/**
 * The same direction returns another point later: the point depends on earlier calls.
 */
#define CCD_CHECK_CHANGES 8

/**
 * The center is outside the object. Calls that rely on it may miss overlaps, and
 * report overlaps of objects that are apart.
 */
#define CCD_CHECK_CENTER_OUTSIDE 16

/**
 * `center` is NULL. Calls with MPR in their name require it, others do not.
 */
#define CCD_CHECK_CENTER_MISSING 32

/**
 * Result of ccdCheck. Lengths are metres.
 */
typedef struct ccd_check_t {
  /**
   * Greatest width of the object, approximately.
   */
  ccd_real_t size;
  /**
   * Greatest distance of a point beyond the support plane of another direction.
   */
  ccd_real_t noise;
  /**
   * Greatest change of a support value in the repeated calls.
   */
  ccd_real_t change;
  /**
   * Distance of the center from the object; negative inside, more negative if deeper. 0 without
   * a center.
   */
  ccd_real_t center_outside;
  /**
   * Direction of the worst fault, unit; meaningless where there is none.
   */
  ccd_vec3_t dir;
} ccd_check_t;

/**
 * Tests an object's support function and center along 192 directions, each evaluated twice. For
 * debugging and tests, too slow for every frame.
 *
 * Detects faults that a query cannot distinguish from another object: a missing center, a wrong
 * sign, a wrong frame. A reported fault is certain; a fault in few directions may be missed.
 *
 * `obj`: passed to the callbacks. `center`: may be NULL. `out`: may be NULL; else filled unless
 * CCD_BAD_INPUT is returned.
 *
 * Reads no tolerance. Allocates nothing.
 *
 * Returns 0 where no fault is found, CCD_CHECK_ flags where one is, or CCD_BAD_INPUT where
 * `support` is NULL.
 */
CCD_EXPORT
int ccdCheck(const void *obj,
             ccd_support_fn support,
             ccd_center_fn center,
             ccd_check_t *out);


/* Identity of the library. */

/**
 * Returns name, version and precision of the library that the process runs:
 * "warmccd 0.2.0 double", a static string.
 */
CCD_EXPORT const char *ccdImplementation(void);

#ifdef __cplusplus
}
#endif

#endif /* __CCD_WARM_H__ */
