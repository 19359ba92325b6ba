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

use core::ffi::c_int;

/// The objects overlap by more than rounding.
pub const CCD_HIT: c_int = 0;
/// The result is sound, but less exact than requested: max_iterations, the library's limit of
/// support points or rounding ended the search. All bounds hold. A penetration query has found an
/// overlap; for ccdSignedDistance the overlap may be undecided (distance < 0 < distance_upper).
pub const CCD_LIMIT: c_int = 1;
/// The objects are apart, or touch within rounding.
pub const CCD_MISS: c_int = -1;
/// malloc failed.
pub const CCD_NO_MEMORY: c_int = -2;
/// An argument, a field of ccd or a point of a callback is invalid: NULL where a pointer is
/// required, NaN, a negative length, a zero direction, an unknown flag, a point that is not finite.
pub const CCD_BAD_INPUT: c_int = -3;
