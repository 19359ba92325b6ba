// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants that several files of the search for a depth or a distance use, with what was tried. One that a
//! single file uses is in that file.

// Gaps: the allowed difference of the bounds; in a local search the tolerance.

/// The part of an allowed gap that does not count. Measured together for all that derive from it: 0.2 to 0.5 differ by 1.5 %
/// of the support points.
pub const NEGLIGIBLE_GAPS: f64 = 0.25;
/// The height above a plane, in allowed gaps, from which a known difference is taken in place of a support call.
pub const INSERT_HEIGHT_GAPS: f64 = NEGLIGIBLE_GAPS;
/// The least difference of two support values, in allowed gaps, that counts as a gain: a prediction that gains less is not
/// evaluated, and an inclined direction that gains less confirms a minimum. Measured: evaluating every prediction costs 7 % of
/// the support points of proofs.
pub const MIN_GAIN_GAPS: f64 = NEGLIGIBLE_GAPS;
/// The largest difference of an evaluated support value from a prediction that agrees with it, in predicted gains.
pub const MAX_MISS_REL: f64 = NEGLIGIBLE_GAPS;

/// The number of attempts that may fail before another way is taken: predictions of a model of D; steps of GJK that come no
/// closer to the origin, one of which is normal if the origin lies on a face, whose other side it finds; slopes of a discovery
/// that find no point on the other side of the ray; separating axes. Measured: with 3 or with 4 predictions, local searches
/// without centers end at their limit in 1.5 % of the pairs of category CENTRED_SPHERE of
/// c-tests/tests/stability/categories.h; without a limit, some take 60 support points more. With 3 of another kind, support
/// points and instructions differ by less than 0.1 %; with one axis, pairs that stay separated take 6 % more instructions.
pub const MAX_FAILURES: u32 = 5;

// Minima of the local search.

/// The angle from a minimum to the directions that confirm it, radians: no support value there may be lower. Also the angle, as
/// seen from the origin, below which a face is narrow.
pub const CONFIRM_ANGLE_RAD: f64 = 0.015;
/// The least and the largest angle of a known direction that confirms a minimum in place of an inclined one, radians. Measured:
/// with 0.4 and 2.5 of it in place of 0.25 and 4, local searches take 0.3 % more support points. Up to the least, the normal of
/// a narrow face and the direction of the upper bound are one minimum; without that, those of cones, cylinders and ellipsoids
/// take 2 to 3 % more.
pub const CONFIRM_RANGE_RAD: [f64; 2] = [0.25 * CONFIRM_ANGLE_RAD, 4.0 * CONFIRM_ANGLE_RAD];
/// The least cosine between a face's normal and the direction of the upper bound at which they count as in the same
/// valley: 11 degrees. Measured on hulls, started 5 degrees from a minimum: 2.2 % of the pairs end in another minimum with
/// 0.9, 1.0 % with 0.98.
pub const SAME_VALLEY_COS: f64 = 0.98;

// Newton's step, and arcs.

/// The largest relative difference of e and f at which D counts as smooth between two entries, and an object as an arc.
/// Measured: with 0.3, proofs of cones and cylinders to 1e-10 m take 8 % more support points, shallow ellipsoids as many.
pub const SMOOTH_REL_TOL: f64 = 0.1;
