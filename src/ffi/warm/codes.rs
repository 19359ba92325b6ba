// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Codes: what every call that fills a struct returns.
//!
//! 0 and above: *out is filled. Below 0: nothing is written, but that ccdSignedDistance fills
//! *out on a CCD_MISS too, for it has an answer then. With CCD_BAD_INPUT and CCD_NO_MEMORY the
//! state stays as it was; with every other code it is one for the next query.
//!
//! (ccdIntersect returns 1 or 0, ccdContacts how many contacts, or CCD_BAD_INPUT; what has MPR
//! in its name returns what libccd returns.)

use core::ffi::c_int;

/// The objects overlap, by more than rounding.
pub const CCD_HIT: c_int = 0;
/// An answer, but a less exact one than was asked for: max_iterations or the library's own cap
/// came first, or rounding. The depth or distance is sound, its bounds are honest; a penetration
/// is an overlap, of a distance the sign tells.
pub const CCD_LIMIT: c_int = 1;
/// The objects are apart, or touch within rounding.
pub const CCD_MISS: c_int = -1;
/// Memory was needed and not to be had.
pub const CCD_NO_MEMORY: c_int = -2;
/// An argument, a field of ccd, or a callback's answer that no query can work with: NULL where
/// something is needed, NaN, a length below 0, a direction of zero, an unknown flag.
pub const CCD_BAD_INPUT: c_int = -3;
