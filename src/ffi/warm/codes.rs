// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Codes: returned by every call that fills a struct.
//!
//! Code >= 0: *out is filled. Code < 0: nothing is written, except that ccdSignedDistance fills
//! *out on CCD_MISS too. CCD_BAD_INPUT and CCD_NO_MEMORY leave the state unchanged; every other
//! code updates it for the next query.
//!
//! ccdIntersect returns 1 or 0, ccdContacts the number of contacts or CCD_BAD_INPUT, and calls
//! with MPR in their name libccd's codes.
//!
//! The field status of a filled struct is the cause of the end of the search, a CCD_STATUS_ value.
//! The code is CCD_LIMIT if and only if status is not CCD_STATUS_CONVERGED.

use core::ffi::c_int;

/// The objects overlap by more than rounding.
pub const CCD_HIT: c_int = 0;
/// The result is less exact than requested; status says why, and which outputs are valid. A
/// penetration query has found an overlap; for ccdSignedDistance the overlap may be undecided
/// (distance < 0 < distance_upper).
pub const CCD_LIMIT: c_int = 1;
/// The objects are apart, or touch within rounding.
pub const CCD_MISS: c_int = -1;
/// malloc failed.
pub const CCD_NO_MEMORY: c_int = -2;
/// An argument, a field of ccd or a point of a callback is invalid: NULL where a pointer is
/// required, NaN, a negative length, a zero direction, an unknown flag, a point that is not finite.
pub const CCD_BAD_INPUT: c_int = -3;

/// The search ended within the tolerance. All outputs are valid.
pub const CCD_STATUS_CONVERGED: c_int = 0;
/// max_iterations was reached. Depth, distances, bounds, directions and witness points are valid;
/// their error is at most the gap between the bounds.
pub const CCD_STATUS_ITERATION_LIMIT: c_int = 1;
/// The library's own limit of support points was reached. Valid as for CCD_STATUS_ITERATION_LIMIT.
pub const CCD_STATUS_SUPPORT_LIMIT: c_int = 2;
/// Rounding ended the search: more support points would not help. Valid as for
/// CCD_STATUS_ITERATION_LIMIT.
pub const CCD_STATUS_ROUNDING: c_int = 3;
/// Two points of a support function contradict each other, or a center is outside its object.
/// depth is sound for the points that were returned; nothing is proven, and depth_lower is 0.
/// ccdCheck finds such faults.
pub const CCD_STATUS_INCONSISTENT_SUPPORT: c_int = 4;
