// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants that several files of the search for a depth or a distance use, with what was tried. One that a
//! single file uses is in that file.

// Gaps: the allowed difference of the bounds; in a local search the tolerance.

/// The height above a plane, in allowed gaps, from which a known difference is taken in place of a support call. Measured
/// together with [`MIN_GAIN_GAPS`] and [`MAX_MISS_REL`]: 0.2 to 0.5 differ by 1.5 % of the support points.
pub const INSERT_HEIGHT_GAPS: f64 = 0.25;
/// The least difference of two support values, in allowed gaps, that counts as a gain: a prediction that gains less is not
/// evaluated, and a tilted direction that gains less confirms a minimum. Measured: evaluating every prediction costs 7 % of
/// the support points of proofs. See [`INSERT_HEIGHT_GAPS`].
pub const MIN_GAIN_GAPS: f64 = 0.25;
/// The largest difference of an evaluated support value from a prediction that agrees with it, relative to the predicted
/// gain. See [`INSERT_HEIGHT_GAPS`].
pub const MAX_MISS_REL: f64 = 0.25;

// Attempts that may fail before another way is taken.

/// The number of failed predictions of a model of D after which it is not used any more. Measured: with 3 or with 4, local
/// searches without centers end at their limit in 1.5 % of the pairs of category CENTRED_SPHERE of
/// c-tests/tests/stability/categories.h; without a limit, some take 60 support points more.
pub const MAX_FAILED_PREDICTIONS: u32 = 5;
/// The number of steps of GJK that come no closer to the origin after which it ends. One such step is normal if the origin
/// lies on a face: it finds the other side of that face. Measured: with 3, support points and instructions differ by less
/// than 0.1 %.
pub const MAX_STALLS: u32 = 5;

// Minima of the local search.

/// The tilt of the directions that confirm a minimum, radians: no support value at this angle may be lower. A face
/// that is narrower, as seen from the origin, needs such a confirmation.
pub const CONFIRM_TILT_RAD: f64 = 0.015;
/// The least and the largest angle of a known direction that confirms a minimum in place of a tilted one, radians. Measured:
/// with 0.4 and 2.5 tilts in place of 0.25 and 4, local searches take 0.3 % more support points.
pub const CONFIRM_RANGE_RAD: [f64; 2] = [0.25 * CONFIRM_TILT_RAD, 4.0 * CONFIRM_TILT_RAD];
/// The least cosine between a face's normal and the direction of the upper bound at which they count as in the same
/// valley: 11 degrees. Measured on hulls, started 5 degrees from a minimum: 2.2 % of the pairs end in another minimum with
/// 0.9, 1.0 % with 0.98.
pub const SAME_VALLEY_COS: f64 = 0.98;

// Newton's step, and arcs.

/// The largest relative difference of e and f at which D counts as smooth between two entries, and an object as an arc.
/// Measured: with 0.3, proofs of cones and cylinders to 1e-10 m take 8 % more support points, shallow ellipsoids as many.
pub const SMOOTH_REL_TOL: f64 = 0.1;
