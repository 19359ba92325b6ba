// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! For programs that call libccd's MPR: the same calls with one argument more. What they return
//! and what they need is what libccd says, so center1 and center2 must be given.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Call, Query};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_HIT, CCD_LIMIT, CCD_MISS, CCD_NO_MEMORY};
use super::intersect::intersect;
use super::penetration::run;
use super::state::ccd_warm_t;
use crate::contact::Penetration;
use crate::math::Real;

/// What libccd returns where the extension has this code.
pub(in crate::ffi) fn libccd_s(code: c_int) -> c_int {
    match code {
        CCD_HIT | CCD_LIMIT => 0,
        CCD_NO_MEMORY => -2,
        _ => CCD_MISS,
    }
}

/// Writes the outputs that are not NULL.
///
/// # Safety
/// \[outputs\] of the module contract.
pub(in crate::ffi) unsafe fn write(
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

/// ccdMPRPenetration with memory: ccdPenetration with libccd's outputs and codes.
///
/// `warm` may be NULL. Returns 0 and writes the outputs that are not NULL (a `pos` of NULL saves
/// what CCD_WANT_POS costs), or -1: apart, or an argument or a callback's answer that no query can
/// work with.
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
    // SAFETY: passed on; [outputs].
    libccd_s(unsafe {
        run(
            Query { obj1, obj2, ccd },
            Call::Mpr,
            warm,
            |pair, state, settings, hit| pair.mpr(state, settings, !pos.is_null(), hit),
            |hit, _| write(hit, depth, dir, pos),
        )
    })
}

/// ccdMPRIntersect with memory: ccdIntersect where centres are given.
///
/// `warm` may be NULL. Returns 1 or 0.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRIntersectWarm(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe { intersect(query.pair(Call::Mpr, !warm.is_null()), warm) }
}
