// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Flags: outputs that a call computes only if they are requested.

use core::ffi::c_uint;

/// Requests pos. Costs, on average, 3 to 7 support points where the face of one object contains that of
/// the other, 9 where neither does; in all tests at most 24. May call one support function without the
/// other.
pub const CCD_WANT_POS: c_uint = 1;
/// Requests point1 and point2, at no cost.
pub const CCD_WANT_POINTS: c_uint = 2;
/// Requests all of these.
pub const CCD_WANT_ALL: c_uint = 3;
