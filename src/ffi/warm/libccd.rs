// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's MPR calls with a state, for programs that use libccd: outputs and codes are libccd's,
//! and center1 and center2 are required.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{QueryArgs, QueryKind};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_HIT, CCD_LIMIT, CCD_MISS, CCD_NO_MEMORY};
use super::intersect::intersect;
use super::penetration::run_query;
use super::state::ccd_warm_t;
use crate::math::Real;
use crate::types::Penetration;

/// Converts a code of the extension to libccd's.
pub(in crate::ffi) fn libccd_code(code: c_int) -> c_int {
    match code {
        CCD_HIT | CCD_LIMIT => 0,
        CCD_NO_MEMORY => -2,
        _ => CCD_MISS,
    }
}

/// Writes those outputs of libccd's calls that are not NULL.
///
/// # Safety
/// \[outputs\] of the module contract.
pub(in crate::ffi) unsafe fn write_outputs(
    hit: &Penetration,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) {
    // SAFETY: [outputs].
    unsafe {
        if let Some(depth) = depth.as_mut() {
            *depth = hit.depth as Real;
        }
        if let Some(dir) = dir.as_mut() {
            *dir = hit.dir.into();
        }
        if let Some(pos) = pos.as_mut() {
            *pos = hit.pos.into();
        }
    }
}

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
    // SAFETY: the caller's guarantees are those of the callee; [outputs].
    libccd_code(unsafe {
        run_query(
            QueryArgs { obj1, obj2, ccd },
            QueryKind::Mpr,
            warm,
            !pos.is_null(),
            |pair, state, settings, hit| pair.penetration(state, settings, !pos.is_null(), hit),
            |hit, _| write_outputs(hit, depth, dir, pos),
        )
    })
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
    let query = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(query.pair(QueryKind::Mpr, !warm.is_null()), warm) }
}
