// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants of the search for a depth or a distance, with what was tried.

use crate::math::EPSILON;

// Tolerances.

/// The part that counts as small, of
/// - an allowed gap: a known difference that is this high above a plane replaces a support call, a prediction that gains
///   less is not evaluated, and one that misses its gain by less agrees. Measured: 0.2 to 0.5 differ by 1.5 %; evaluating
///   every prediction costs 7 % of the support points of proofs;
/// - the size: an upper bound below it is that of a *shallow* contact, whose portal is near the minimum and is refined
///   after the origin is on its inner side. Measured: if every portal is refined so, deep overlaps take 4 to 13 %
///   more instructions; with 0.15 boxes at medium depth take 11 % more, and spheres 8 % more support points;
/// - the square of a turn, in radians: a ray that turns less, 29 degrees, is not evaluated again;
/// - the radius of a ring: a vertex closer to the ray counts as near it, and a ring is evaluated;
/// - a segment: an interior point is that far from its ends. Measured: with 0.05 separated pairs take 7 % more support
///   points, with 0.5 10 %;
/// - the tilt of portal discovery, see [`LARGE_PART`];
/// - a tolerance: the increase of the support value that the tilt into general position may cause;
/// - [`CONFIRM_TILT_RAD`]: a known direction between this part and its inverse of that tilt confirms a minimum in place of
///   a tilted one. Measured: against 0.4 0.3 % fewer support points of local searches.
pub const SMALL_PART: f64 = 0.25;
/// The part that counts as most of it: a known difference that closes this much of the gap between the closest face and
/// the upper bound is inserted into the polytope without a support call, and two depths of a local search that differ by
/// less than this part of the tolerance are equal. The radius of the ring of a contact that is not deep is this part of upper
/// bound / [`SMALL_PART`], 3 upper bounds. (Measured: with 2 warm queries of ellipsoids take 6 % more support points, with 4
/// proofs of them 3 %.) Derived: all but a small part; in a local search that is left for the
/// error of the witness points. Insensitive: 0.45 to 0.8; without it deep boxes take 50 % more instructions.
///
/// The largest tilt of portal discovery is this part of max(distance of v1 from the ray / [`SMALL_PART`], |v1 v2|) / length
/// of the ray in D. Measured: without the edge 21 % more support points; 4 times the distance in place of 3 takes 1 % fewer
/// for the global minimum, and 13 % more for a local one of hulls, whose portals then extend into other valleys.
pub const LARGE_PART: f64 = 1.0 - SMALL_PART;

/// The least useful tilt, radians, 1e-10. Measured with ODE's cylinder of radius 0.3, 20,000 rotations, the share of points
/// that are off by more than 12 µm, and that are low by more than 1 mm: without tilt 29 %, 16 %; 2.5e-12 66 %, 0.01 %. With
/// this one no depth is (`ode_cylinder`).
pub const MIN_TILT_RAD: f64 = 4.5e5 * EPSILON;

/// The number of attempts that may fail before another way is taken: axes of the last query, tilts of portal discovery,
/// steps of GJK that come no closer, and predictions of a model of D. Measured: with 3 in place of 5 support points and
/// instructions differ by less than 0.1 %, but with 3 or 4 predictions local searches without centers end at their limit in
/// 1.5 % of the pairs of category CENTRED_SPHERE of c-tests/tests/stability/categories.h; without a limit some take 60
/// support points more. With one axis pairs that stay separated take 6 % more instructions. With 3 rays out of boxes and
/// cylinders take 3 % fewer support points.
pub const MAX_FAILURES: u32 = 5;

// Models of D.

/// The largest tangent of the angle from the normal of the best plane to a direction that GJK evaluates. Measured: without a
/// limit distances take 4 to 12 % more support points; with 1.0 two of 2,100 exactly touching pairs take 882 of them (campaign
/// `wide`, seed 4242).
pub const MAX_EXTRAPOLATION_TAN: f64 = 0.6;
/// The largest ratio of the widths of two rings. Measured: without it 14 % more support points in proofs to 1e-10 m of shallow
/// round pairs, 1.5 % more instructions of warm hits.
pub const MAX_RING_RATIO: f64 = 100.0;

// The separating axis.

/// The separation at which an axis is aimed, relative to the size of D. Measured (test U14 of
/// c-tests/tests/stability/costs.c): pairs that stay apart take 1.016 support points a query; 1.03 if the axis is aimed at
/// 0.95 of the last separation too, 1.29 without a target.
pub const TARGET_REL: f64 = 0.0035;

// Portal discovery and refinement.

/// The first tilt in discovery, in units of upper bound / distance from the ray, and the factor by which the tilt grows
/// after each attempt that finds no point on the other side of the ray. Insensitive: 1.3 to 1.5; 1.15 takes 4 % more
/// support points in intersection tests. Without growth nearly touching spheres take up to 17 support points, not 15.
pub const TILT_GROWTH: f64 = 1.4;

// GJK.

/// Weight of the second of two points in a point between them that is in no plane of symmetry. Insensitive: 0.4 to
/// 0.48; with 0.5 the origin is on an edge of the tetrahedron more often, and the case stays undecided; with 0.25 6 of 15
/// million touches of turned hulls count as hits.
pub const GENERIC_FRACTION: f64 = 0.44;

// The local search.

/// The tilt of the directions that confirm a minimum, radians: no support value at this angle may be lower. A face
/// that is narrower, as seen from the origin, needs such a confirmation.
pub const CONFIRM_TILT_RAD: f64 = 0.015;
/// The least cosine between a face's normal and the direction of the upper bound at which they count as in the same
/// valley: 11 degrees. Measured on hulls, started 5 degrees from a minimum: with 0.9 2.2 % of the pairs end in another
/// minimum, with 0.98 1.0 %.
pub const SAME_VALLEY_COS: f64 = 0.98;

// Newton's step, and arcs.

/// The largest relative difference of e and f at which D counts as smooth between two entries, and an object as an arc
/// (measured: with 0.3 proofs of cones and cylinders to 1e-10 m take 8 % more support points, shallow ellipsoids as many);
/// and the least squared sine between the changes of direction of the two entries.
pub const SMOOTH_REL_TOL: f64 = 0.1;
