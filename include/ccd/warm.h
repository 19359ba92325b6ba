/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What this library adds to libccd's ccd.h: queries that start from a pair's last answer.
 * Made by cbindgen from src/ffi/warm/; edit there.
 *
 * To begin with: one ccd_warm_t a pair, kept between frames, all bytes zero at first, and
 * ccdPenetration. Then, from here to the end:
 *
 *   codes      what every call that fills a struct returns
 *   states     ccd_warm_t, ccdWarmGuess, ccdWarmFlip
 *   the one    ccdPenetration: do they overlap, how deep, which way out, where
 *   yes or no  ccdIntersect
 *   distance   ccdSignedDistance
 *   contacts   ccdContacts
 *   special    ccdPenetrationLocal, ...Proven, ...Along, ...Planar
 *   libccd's   ccdMPRPenetrationWarm, ccdMPRIntersectWarm
 *   is it odd? ccdCheck: what is wrong with a support function
 *
 * Lengths and tolerances are metres; the library floors tolerances at a few ulps of the objects'
 * size, so 0 asks for the best the precision can give. A call reads the one tolerance that it
 * names. Object pointers are handed to the callbacks and never looked at. A query is re-entrant
 * and keeps nothing but the state that the caller hands it. */

#ifndef __CCD_WARM_H__
#define __CCD_WARM_H__

#include <ccd/ccd.h>

#ifdef __cplusplus
extern "C" {
#endif


/* Codes: what every call that fills a struct returns.
 *
 * 0 and above: *out is filled. Below 0: nothing is written, but that ccdSignedDistance fills
 * *out on a CCD_MISS too, for it has an answer then. With CCD_BAD_INPUT and CCD_NO_MEMORY the
 * state stays as it was; with every other code it is one for the next query.
 *
 * (ccdIntersect returns 1 or 0, ccdContacts how many contacts, or CCD_BAD_INPUT; what has MPR
 * in its name returns what libccd returns.) */

/**
 * The objects overlap, by more than rounding.
 */
#define CCD_HIT 0

/**
 * An answer, but a less exact one than was asked for: max_iterations or the library's own cap
 * came first, or rounding. The depth or distance is sound, its bounds are honest; a penetration
 * is an overlap, of a distance the sign tells.
 */
#define CCD_LIMIT 1

/**
 * The objects are apart, or touch within rounding.
 */
#define CCD_MISS (-1)

/**
 * Memory was needed and not to be had.
 */
#define CCD_NO_MEMORY (-2)

/**
 * An argument, a field of ccd, or a callback's answer that no query can work with: NULL where
 * something is needed, NaN, a length below 0, a direction of zero, an unknown flag.
 */
#define CCD_BAD_INPUT (-3)


/* States: what one query of a pair leaves for the next. */

/**
 * How many numbers a ccd_warm_t holds.
 */
#define CCD_WARM_REALS 6

/**
 * State of one pair between queries. Plain data, no pointers, nothing to free: all
 * bytes zero is cold, and it may be copied and stored freely.
 *
 * One state is for one pair in one order: the state of (a, b) is a foreign one to a query of
 * (b, a), until ccdWarmFlip turns it round. Every call takes what any other call has left in
 * it. Two threads must not use one state at once. Wherever a call takes a state, NULL is cold,
 * and saves what it costs to leave one.
 *
 * A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to
 * another local minimum; every answer stays sound. The fields are the library's own.
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
 * Makes `warm` a fresh state that starts from `dir`, the caller's guess of the way obj2
 * leaves.
 *
 * `dir` need not be unit; zero, not finite or NULL makes a cold state. `warm` NULL: nothing
 * happens.
 */
CCD_EXPORT void ccdWarmGuess(ccd_warm_t *warm, const ccd_vec3_t *dir);

/**
 * Makes a state of the pair (obj1, obj2) one of (obj2, obj1): for a caller who keeps one
 * state a pair and meets its objects in either order.
 *
 * Cold stays cold. `warm` NULL: nothing happens.
 */
CCD_EXPORT void ccdWarmFlip(ccd_warm_t *warm);


/* The one call to begin with: do two objects overlap, how deep, which way out, where? */

/**
 * Wanted: pos. It costs 2 to 4 support points, 8 at most where a face has more than four corners, none
 * where a state shows that nothing has moved (ccdPenetration, ccdPenetrationProven). For it the objects
 * are asked one by one.
 */
#define CCD_WANT_POS 1

/**
 * Wanted: point1 and point2. They cost nothing.
 */
#define CCD_WANT_POINTS 2

/**
 * Everything.
 */
#define CCD_WANT_ALL 3

/**
 * What a penetration query answers. What was not wanted is zero.
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
   * Contact position, CCD_WANT_POS: the centre of pressure, which is the centroid of the volume
   * that the objects share, but for its height along normal. It moves as the objects do, where
   * a deepest point jumps from corner to corner. For objects of a quarter metre that are no deeper
   * than a millimetre it is off by 3 mm (boxes) to 7 mm (round ones) at most, a cone on its side by
   * 15 mm, root mean square; deeper, by 3 % of the smaller object's size where the depth is 3 % of
   * that, 6 % at 10 %, 20 % at 30 %. Of CCD_LIMIT, and of ccdPenetrationAlong and
   * ccdPenetrationPlanar, the middle of the witness points.
   */
  ccd_vec3_t pos;
  /**
   * Witness point of obj1, CCD_WANT_POINTS, at the deepest place: a point of obj1, and of its
   * supporting plane, each to within what the depth may be off, or 1e-12 of the size (in single
   * precision 1e-5).
   */
  ccd_vec3_t point1;
  /**
   * Witness point of obj2, the same.
   */
  ccd_vec3_t point2;
  /**
   * Half of the calls of support1 and support2 together, rounded up: a support point of the
   * Minkowski difference is one call of each. Positions need further calls of one alone.
   */
  unsigned long support_calls;
  /**
   * Iterations of the solver.
   */
  unsigned long iterations;
} ccd_penetration_t;

/**
 * The penetration depth: the least distance by which obj2 must move to separate the objects,
 * within the larger of mpr_tolerance and 0.1 % of it, in CCD_LIMIT's case a sound one.
 * The call to take unless one of those below says what is wanted better. From the state, else
 * from the centres, else from first_dir.
 *
 * `warm`: NULL, or the pair's state: a pair that stays apart costs one call of each support
 * function, and one that overlaps fewer than without. `want`: CCD_WANT_ flags; 0 for depth,
 * bounds and directions alone. Reads mpr_tolerance. center1 and center2 may be NULL; where they
 * are given they must lie in their objects, and save calls; depth_lower leans on them too.
 * Allocates nothing.
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


/* Yes or no. */

/**
 * Do the objects overlap? A pair that stays apart costs one call of each support function while
 * its last separating direction still separates. From the state, else from the centres, else
 * from first_dir.
 *
 * Reads no tolerance and no max_iterations. center1 and center2 may be NULL; where they are
 * given they must lie in their objects. `warm` may be NULL. Allocates nothing.
 *
 * Returns 1 when they overlap, 0 when they do not; a touch within rounding is no overlap, nor
 * is what CCD_BAD_INPUT stands for.
 */
CCD_EXPORT int ccdIntersect(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm);


/* Distance: how far apart, or how deep. */

/**
 * What ccdSignedDistance answers. What was not wanted is zero.
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
   * CCD_LIMIT was returned or distance > max_distance.
   */
  ccd_real_t distance_upper;
  /**
   * Unit, from obj1 to obj2: the way obj2 moves to be farther.
   */
  ccd_vec3_t normal;
  /**
   * Witness point on the surface of obj1 with its margin; CCD_WANT_POINTS.
   */
  ccd_vec3_t point1;
  /**
   * Witness point on the surface of obj2 with its margin; CCD_WANT_POINTS.
   */
  ccd_vec3_t point2;
  /**
   * Half of the calls of support1 and support2 together, rounded up: a support point of the
   * Minkowski difference is one call of each. Positions need further calls of one alone.
   */
  unsigned long support_calls;
  /**
   * Iterations of the solver.
   */
  unsigned long iterations;
} ccd_distance_t;

/**
 * How far apart, or how deep: one continuous function through the touch.
 *
 * margin1, margin2, metres, >= 0: the objects are meant with a ball of that radius added all
 * around, and the support functions give the cores. (A sphere is a point with a margin, a
 * capsule a segment, a rounded box a box.) The signed distance is the cores' minus both
 * margins, overlapping cores included.
 *
 * `max_distance`, metres, >= 0: the search ends as soon as the distance is known to be greater.
 * INFINITY: it is always refined. Reads dist_tolerance. center1, center2 and first_dir may
 * be NULL. `warm` may be NULL. `want`: CCD_WANT_POINTS; 0 saves support points where objects
 * overlap. Takes no memory from malloc while the cores are apart.
 *
 * Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding, whose distance is
 * 0; *out is filled) or CCD_LIMIT (the bounds are still open); CCD_BAD_INPUT, or CCD_NO_MEMORY
 * (cores that overlap only).
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
 * How many numbers a ccd_manifold_t holds.
 */
#define CCD_MANIFOLD_REALS 141

/**
 * The contacts of one pair between queries: for ccdContacts what a ccd_warm_t is for the
 * others. All bytes zero is cold; plain data, to be copied and stored freely. It serves either
 * order of the pair. A stale, foreign or random one costs time alone.
 */
typedef struct ccd_manifold_t {
  /**
   * Private.
   */
  float reals[CCD_MANIFOLD_REALS];
  /**
   * Private.
   */
  unsigned int words[11];
} ccd_manifold_t;

/**
 * One point of a contact manifold.
 */
typedef struct ccd_contact_t {
  /**
   * Within the slop in force of the surface of obj1.
   */
  ccd_vec3_t point1;
  /**
   * point1 - depth * normal; within the slop of the surface of obj2. Of faces that do not lie
   * over each other, the closest point of obj2's face: beside that.
   */
  ccd_vec3_t point2;
  /**
   * Metres: at least the support value of normal less 2 slops in force; negative where the
   * objects are apart.
   */
  ccd_real_t depth;
  /**
   * Its name, not 0, while it moves with obj1 or with obj2; 0 without a memory.
   */
  unsigned int id;
} ccd_contact_t;

/**
 * Where two objects touch, not only how deep: the region in which the faces that look along
 * `normal` lie over each other, reduced to at most `max` points: the deepest first, the
 * others in order around the normal, spread to the largest area.
 *
 * `normal`: of an answer for this pose (dir where there is no other), not necessarily unit.
 * `slop`, metres, >= 0: how far below its support plane a corner may lie and still belong to
 * the face; a thousandth of the objects' size is good for contacts that rest. Corners
 * between half the slop and the slop may be either. A normal that is off by an angle needs that
 * angle times the extent of the face: with less, a corner or an edge is found in place of the
 * face. The normals of this library's answers are good to 0.1 % of the depth, for which 1 % of
 * the depth is enough. So the slop in force is at least 1 % of the depth along `normal`, and 32
 * ulps of the largest coordinate; and no more than the size of the face.
 *
 * Roundness is taken off: a sphere gives one point, a lying capsule or cylinder its two ends.
 * Faces of more than 8 corners are inscribed. Where the faces do not lie over each other:
 * one point, the nearest of each. The region moves as the objects do. For objects that are
 * meant with margins, move the points by them along the normal.
 *
 * `memory`: NULL, or the pair's: an object that has the same face as the last time is asked
 * half as often, and points keep their ids, so that a solver can begin with the impulses of
 * the last frame. Which points are left where there are more than `max` then changes less.
 *
 * Reads no tolerance, centre or max_iterations; at most 24 support points of each object, 12
 * of a box; up to 10 more where a memory no longer fits. Allocates nothing.
 *
 * Returns how many points were written to `contacts`, at least 1; or CCD_BAD_INPUT (a normal
 * that is zero, not finite or NULL, a slop that is negative or NaN, max < 1, no contacts, a
 * callback's point that is not finite), and nothing is written.
 */
CCD_EXPORT
int ccdContacts(const void *obj1,
                const void *obj2,
                const ccd_t *ccd,
                const ccd_vec3_t *normal,
                ccd_real_t slop,
                ccd_manifold_t *memory,
                ccd_contact_t *contacts,
                int max);


/* For special wishes: one valley, a proof, a direction, a plane. */

/**
 * Returns a local minimum of the penetration depth, by a walk on known vertices. Faster than
 * ccdPenetration with a state or a guess that is roughly right; from far off it may end in
 * another minimum. Where the walk ends without one, the global search follows. From the state, else from the centres, else from first_dir.
 *
 * Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
 * flags. Allocates nothing.
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
 * The least penetration depth with its proof: depth - depth_lower <= epa_tolerance on CCD_HIT.
 * From the state, else from the centres, else from first_dir.
 *
 * Reads epa_tolerance. center1 and center2 may be NULL, and are not trusted. `warm` may be NULL.
 * `want`: CCD_WANT_ flags. Takes memory from malloc only where the minima (nearly) form a curve
 * or a surface; there the bounds may stay open: CCD_LIMIT.
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
 * How far obj2 must move along `dir` to separate (directional penetration depth).
 *
 * `dir` need not be unit; zero, not finite or NULL is CCD_BAD_INPUT. Reads mpr_tolerance,
 * measured along `dir`. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
 * flags. Allocates nothing.
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
 * A local minimum of the penetration depth among the directions of a plane, for shapes that lie
 * in a common plane with this normal. From the state, else from the centres, else from first_dir.
 *
 * `plane_normal` need not be unit; zero, not finite or NULL is CCD_BAD_INPUT. Reads
 * mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_ flags.
 * Allocates nothing.
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


/* For programs that call libccd's MPR: the same calls with one argument more. What they return
 * and what they need is what libccd says, so center1 and center2 must be given. */

/**
 * ccdMPRPenetration with memory: ccdPenetration with libccd's outputs and codes.
 *
 * `warm` may be NULL. Returns 0 and writes the outputs that are not NULL (a `pos` of NULL saves
 * what CCD_WANT_POS costs), or -1: apart, or an argument or a callback's answer that no query can
 * work with.
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
 * ccdMPRIntersect with memory: ccdIntersect where centres are given.
 *
 * `warm` may be NULL. Returns 1 or 0.
 */
CCD_EXPORT
int ccdMPRIntersectWarm(const void *obj1,
                        const void *obj2,
                        const ccd_t *ccd,
                        ccd_warm_t *warm);


/* Something is odd? What is wrong with an object's support function and centre. */

/**
 * A point, or the centre, is NaN or infinite. Nothing else is told.
 */
#define CCD_CHECK_NOT_FINITE 1

/**
 * The points are the farthest *against* the direction: a sign is wrong.
 */
#define CCD_CHECK_OPPOSITE 2

/**
 * Points contradict each other by `noise`, more than rounding: one answered along one direction
 * is farther along another than that one's own. By as little as single precision: ask for no
 * tolerance finer than some times the noise. By more: a wrong frame (the direction is to be
 * turned into the body's, the point back), points of another object, or a search over the
 * vertices that stops too early.
 */
#define CCD_CHECK_CONTRADICTS 4

/**
 * The same direction asked again is answered otherwise: the answer depends on earlier calls.
 */
#define CCD_CHECK_CHANGES 8

/**
 * The centre lies outside of the object. The MPR calls and ccdPenetration then miss overlaps, and
 * answer what is apart as deep.
 */
#define CCD_CHECK_CENTER_OUTSIDE 16

/**
 * There is no centre: `center` is NULL. libccd's MPR calls need one; the extension's others do
 * not.
 */
#define CCD_CHECK_CENTER_MISSING 32

/**
 * What ccdCheck found. Lengths are metres.
 */
typedef struct ccd_check_t {
  /**
   * The greatest width of the object, about: is it what you think it is?
   */
  ccd_real_t size;
  /**
   * How far a point lies beyond the support plane of another at most.
   */
  ccd_real_t noise;
  /**
   * How far the answer along one direction moved along it when asked again at most.
   */
  ccd_real_t change;
  /**
   * How far the centre lies outside; negative: how deep inside, the deeper the better. 0 without
   * one.
   */
  ccd_real_t center_outside;
  /**
   * Unit: the direction in which the worst was found; of no meaning where nothing is wrong.
   */
  ccd_vec3_t dir;
} ccd_check_t;

/**
 * What is wrong with an object's support function and centre, as far as 192 directions tell,
 * each asked twice. For when an answer is odd, and for tests; not for every frame.
 *
 * It finds what the queries cannot tell from another object: a forgotten centre, a wrong sign, a
 * frame mixed up. What is found is wrong for certain; a fault that shows in few directions may
 * be missed. `obj` is handed to the callbacks. `center` may be NULL. `out` may be NULL; else it is
 * filled unless CCD_BAD_INPUT is returned.
 *
 * Returns 0 where nothing is wrong, CCD_CHECK_ flags where something is, or CCD_BAD_INPUT: `support`
 * is NULL.
 */
CCD_EXPORT
int ccdCheck(const void *obj,
             ccd_support_fn support,
             ccd_center_fn center,
             ccd_check_t *out);


/* Which library this is. */

/**
 * Which library a process really runs, and in which precision: "warmccd 0.2.0 double", a
 * string that lives as long as the library.
 */
CCD_EXPORT const char *ccdImplementation(void);

#ifdef __cplusplus
}
#endif

#endif /* __CCD_WARM_H__ */
