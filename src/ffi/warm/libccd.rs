// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's MPR calls with a state, for programs that use libccd: outputs and codes are libccd's,
//! and center1 and center2 are required.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Interface, QueryArgs};
use super::super::run::{intersect, libccd_penetration};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::state::ccd_warm_t;
use crate::math::Real;

/// Computes the penetration depth as ccdMPRPenetration does, with a state.
///
/// `warm`: may be NULL. `depth`, `dir`, `pos`: each may be NULL; NULL for `pos` saves the cost of
/// CCD_WANT_POS.
///
/// Reads mpr_tolerance; CCD_INIT's value replaces a negative or NaN one. Allocates nothing.
///
/// Returns 0 where ccdPenetration returns CCD_HIT or CCD_LIMIT; -1, with the outputs unchanged,
/// where it returns CCD_MISS or CCD_BAD_INPUT, or when a center callback is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRPenetrationWarm(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { libccd_penetration(args, Interface::Mpr, warm, depth, dir, pos) }
}

/// Reports whether the objects overlap as ccdMPRIntersect does, with a state.
///
/// `warm`: may be NULL.
///
/// Reads no tolerance and no max_iterations. Allocates nothing.
///
/// Returns the value of ccdIntersect; 0 when a center callback is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRIntersectWarm(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(QueryArgs { obj1, obj2, ccd }, Interface::Mpr, warm) }
}
