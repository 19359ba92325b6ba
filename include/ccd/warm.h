/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What this library adds to libccd: penetration queries that start from the last answer,
 * along a direction and in a plane, with witness points and bounds. Made by cbindgen from
 * src/ffi/warm.rs; edit that.
 *
 * Tolerances are depths in metres; the library floors them at a few ulps of the objects'
 * size, so 0 asks for the best the precision can give. Object pointers are handed to the
 * callbacks and never looked at. A query is re-entrant and keeps nothing but the state that
 * the caller hands it. */

#ifndef __CCD_WARM_H__
#define __CCD_WARM_H__

#include <ccd/ccd.h>

/**
 * The objects overlap, by more than rounding.
 */
#define CCD_HIT 0

/**
 * The objects are apart, or touch within rounding.
 */
#define CCD_MISS -1

/**
 * Memory was needed and not to be had.
 */
#define CCD_NO_MEMORY -2

/**
 * An argument or a callback's answer that no query can work with; nothing was written.
 */
#define CCD_BAD_INPUT -3

/**
 * max_iterations came before the tolerance: the best sound answer was written.
 */
#define CCD_LIMIT -4

/**
 * How many numbers a ccd_warm_t holds.
 */
#define CCD_WARM_REALS 19

/**
 * State of one pair between queries. Plain data, no pointers, nothing to free: all
 * bytes zero is cold, and it may be copied and stored freely.
 *
 * One state is for one pair in one order: the state of (a, b) is a foreign one to a query of
 * (b, a), until ccdWarmFlip turns it round. Every call takes what any other call has left in
 * it. Two threads must not use one state at once.
 *
 * A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to
 * another local minimum; every answer stays sound. The fields are the library's own.
 */
typedef struct ccd_warm_t {
  /**
   * Private.
   */
  ccd_real_t reals[CCD_WARM_REALS];
  /**
   * Private.
   */
  unsigned int words[4];
} ccd_warm_t;

/**
 * What a query of the extension answers.
 */
typedef struct ccd_penetration_t {
  /**
   * Metres, >= 0: moving obj2 by depth * dir separates the objects. It is the support
   * value of normal, divided by dir . normal.
   */
  ccd_real_t depth;
  /**
   * Proven lower bound on the global minimum depth (in ccdPenetrationAlong: on the
   * depth along dir), metres; 0 where none was proven.
   */
  ccd_real_t depth_lower;
  /**
   * Unit; the way obj2 moves.
   */
  ccd_vec3_t dir;
  /**
   * Unit; normal of the separating plane. Equal to dir except in ccdPenetrationAlong.
   */
  ccd_vec3_t normal;
  /**
   * Contact position: the middle of the witness points. Where a face rests on a face or
   * an edge these are in the middle of where the two touch, and move as the objects do.
   */
  ccd_vec3_t pos;
  /**
   * Witness point of obj1, within the tolerance of its supporting plane.
   */
  ccd_vec3_t point1;
  /**
   * Witness point of obj2, within the tolerance of its supporting plane.
   */
  ccd_vec3_t point2;
  /**
   * Support points of the Minkowski difference evaluated; one is one call of support1
   * and one of support2.
   */
  unsigned long supports;
  /**
   * Iterations of the solver.
   */
  unsigned long iterations;
} ccd_penetration_t;

/**
 * One point of a contact manifold.
 */
typedef struct ccd_contact_t {
  /**
   * Within slop of the surface of obj1.
   */
  ccd_vec3_t point1;
  /**
   * point1 - depth * normal; within slop of the surface of obj2.
   */
  ccd_vec3_t point2;
  /**
   * Metres: at least the support value of normal less 2 slop; negative where the objects
   * are apart.
   */
  ccd_real_t depth;
} ccd_contact_t;

/**
 * What ccdSignedDistance answers.
 */
typedef struct ccd_distance_t {
  /**
   * Metres: the gap along normal where the objects are apart, minus the depth where they
   * overlap. Never more than the true signed distance: obj2 may come nearer by it.
   */
  ccd_real_t distance;
  /**
   * Metres, never less than the true signed distance: apart |point1 - point2|, overlapping
   * minus the least depth proven. distance_upper - distance <= dist_tolerance unless
   * CCD_LIMIT was returned or distance > beyond.
   */
  ccd_real_t distance_upper;
  /**
   * Unit, from obj1 to obj2: the way obj2 moves to be farther.
   */
  ccd_vec3_t normal;
  /**
   * Witness point on the surface of obj1 with its margin.
   */
  ccd_vec3_t point1;
  /**
   * Witness point on the surface of obj2 with its margin.
   */
  ccd_vec3_t point2;
  /**
   * Support points of the Minkowski difference evaluated; one is one call of support1
   * and one of support2.
   */
  unsigned long supports;
  /**
   * Iterations of the solver.
   */
  unsigned long iterations;
} ccd_distance_t;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Makes `warm` a fresh state that starts from `dir`, the caller's guess of the way obj2
 * leaves.
 *
 * `dir` need not be unit; zero, not finite or NULL makes a cold state. `warm` NULL: nothing
 * happens.
 */
CCD_EXPORT void ccdWarmGuess(struct ccd_warm_t *warm, const ccd_vec3_t *dir);

/**
 * Makes a state of the pair (obj1, obj2) one of (obj2, obj1): for a caller who keeps one
 * state a pair and meets its objects in either order.
 *
 * Cold stays cold. `warm` NULL: nothing happens.
 */
CCD_EXPORT void ccdWarmFlip(struct ccd_warm_t *warm);

/**
 * ccdMPRPenetration with memory.
 *
 * `warm` may be NULL (cold). Returns and outputs as ccdMPRPenetration.
 */
CCD_EXPORT
int ccdMPRPenetrationWarm(const void *obj1,
                          const void *obj2,
                          const ccd_t *ccd,
                          struct ccd_warm_t *warm,
                          ccd_real_t *depth,
                          ccd_vec3_t *dir,
                          ccd_vec3_t *pos);

/**
 * ccdMPRIntersect with memory: a pair that stays apart costs one support point while its
 * last separating direction still separates.
 *
 * `warm` may be NULL (cold). Returns as ccdMPRIntersect: 1 or 0.
 */
CCD_EXPORT
int ccdMPRIntersectWarm(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        struct ccd_warm_t *warm);

/**
 * A local minimum of the penetration depth, by the fastest search there is: cutting planes
 * with curvature, not the paper's method, which is ccdPenetrationIncremental. From the
 * state, else from the centres, else from first_dir.
 *
 * Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
 *
 * Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT and leaves it
 * alone.
 */
CCD_EXPORT
int ccdPenetrationLocal(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        struct ccd_warm_t *warm,
                        struct ccd_penetration_t *out);

/**
 * A local minimum of the penetration depth by the paper's method as published (Algorithms
 * 4 and 5, the shortcut on), with a sound answer: the depth is that of the least support
 * plane met, and an overlap is proven. For comparisons; ccdPenetrationLocal answers the
 * same in fewer support points. From the state's direction, else from the centres, else
 * from first_dir.
 *
 * Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
 *
 * Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT and leaves it
 * alone.
 */
CCD_EXPORT
int ccdPenetrationIncremental(const void *obj1,
                              const void *obj2,
                              const ccd_t *ccd,
                              struct ccd_warm_t *warm,
                              struct ccd_penetration_t *out);

/**
 * The global minimum of the penetration depth, proven: depth - depth_lower <=
 * epa_tolerance on CCD_HIT. From the state, else from the centres, else from first_dir.
 *
 * Reads epa_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
 * Takes memory from malloc only where the minima (nearly) form a curve or a surface.
 *
 * Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS, CCD_BAD_INPUT or CCD_NO_MEMORY
 * and leaves it alone.
 */
CCD_EXPORT
int ccdPenetrationMinimum(const void *obj1,
                          const void *obj2,
                          const ccd_t *ccd,
                          struct ccd_warm_t *warm,
                          struct ccd_penetration_t *out);

/**
 * How far obj2 must move along `dir` to separate: where the origin ray leaves the
 * Minkowski difference (the paper's Algorithm 1).
 *
 * `dir` need not be unit. mpr_tolerance is measured along `dir`. `warm` may be NULL (cold).
 *
 * Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT (also for a `dir`
 * that is zero, not finite or NULL) and leaves it alone.
 */
CCD_EXPORT
int ccdPenetrationAlong(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        const ccd_vec3_t *dir,
                        struct ccd_warm_t *warm,
                        struct ccd_penetration_t *out);

/**
 * A local minimum of the penetration depth among the directions of a plane (the paper's
 * two-dimensional case), for shapes that lie in a common plane with this normal.
 *
 * `plane_normal` need not be unit. Reads mpr_tolerance. `warm` may be NULL (cold).
 *
 * Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT (also for a
 * `plane_normal` that is zero, not finite or NULL) and leaves it alone.
 */
CCD_EXPORT
int ccdPenetrationPlanar(const void *obj1,
                         const void *obj2,
                         const ccd_t *ccd,
                         const ccd_vec3_t *plane_normal,
                         struct ccd_warm_t *warm,
                         struct ccd_penetration_t *out);

/**
 * Where two objects touch, not only how deep: the region in which the faces that look along
 * `normal` lie over each other, reduced to at most `max` points: the deepest first, the
 * others in order around the normal, spread to the largest area.
 *
 * `normal`: of an answer for this pose (dir where there is no other), not necessarily unit.
 * `slop`, metres, >= 0: how far below its support plane a corner may lie and still belong to
 * the face; a thousandth of the objects' size is good for contacts that rest. Corners
 * between half the slop and the slop may be either. It is floored at a few ulps of the
 * coordinates and is no more than the size of the face.
 *
 * Roundness is taken off: a sphere gives one point, a lying capsule or cylinder its two ends.
 * Faces of more than 8 corners are inscribed. Where the faces do not lie over each other:
 * one point, midway between them. The region moves as the objects do. Points carry no names:
 * match those of two frames by position. For objects that are meant with margins, move the
 * points by them along the normal.
 *
 * Reads no tolerance, centre or max_iterations; at most 24 support points of each object, 12
 * of a box. Allocates nothing.
 *
 * Returns how many points were written to `contacts`, at least 1; or CCD_BAD_INPUT (a normal
 * that is zero, not finite or NULL, a slop that is negative or NaN, max < 1, no contacts, a
 * callback's point that is not finite), and nothing was written.
 */
CCD_EXPORT
int ccdContacts(const void *obj1,
                const void *obj2,
                const ccd_t *ccd,
                const ccd_vec3_t *normal,
                ccd_real_t slop,
                struct ccd_contact_t *contacts,
                int max);

/**
 * How far apart, or how deep: one continuous function through the touch.
 *
 * margin1, margin2, metres, >= 0: the objects are meant with a ball of that radius added all
 * around, and the support functions give the cores. (A sphere is a point with a margin, a
 * capsule a segment, a rounded box a box.) The signed distance is the cores' minus both
 * margins, overlapping cores included.
 *
 * `beyond`, metres, >= 0: the search ends as soon as the distance is known to be greater.
 * INFINITY: it is always refined. Reads dist_tolerance. center1, center2 and first_dir may
 * be NULL. `warm` may be NULL (cold). Takes no memory from malloc while the cores are apart.
 *
 * Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding, whose distance is
 * 0) or CCD_LIMIT (the bounds are still open) and fills `out`; CCD_BAD_INPUT or
 * CCD_NO_MEMORY (cores that overlap only) and leaves it alone.
 */
CCD_EXPORT
int ccdSignedDistance(const void *obj1,
                      const void *obj2,
                      const ccd_t *ccd,
                      ccd_real_t margin1,
                      ccd_real_t margin2,
                      ccd_real_t beyond,
                      struct ccd_warm_t *warm,
                      struct ccd_distance_t *out);

/**
 * Which library a process really runs, and in which precision: "warmccd 0.2.0 double", a
 * string that lives as long as the library.
 */
CCD_EXPORT const char *ccdImplementation(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* __CCD_WARM_H__ */
