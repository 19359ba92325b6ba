// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! For programs that call libccd's MPR: the same calls with one argument more. What they return
//! and what they need is what libccd says, so center1 and center2 must be given.

use core::ffi::{c_int, c_void};

use super::super::callbacks::Query;
use super::super::collide::{mpr_penetration, write};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_HIT, CCD_MISS};
use super::intersect::intersect;
use super::state::{ccd_warm_t, read, store};
use crate::contact::Answer;
use crate::math::Real;

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
    // SAFETY: passed on.
    unsafe {
        let mut state = read(warm);
        let answer = mpr_penetration(
            Query { obj1, obj2, ccd },
            &mut state,
            !warm.is_null(),
            !pos.is_null(),
        );
        if answer.is_ok() {
            store(warm, &state);
        }
        match &answer {
            Ok(Answer::Hit(hit) | Answer::Limit(hit)) => {
                write(hit, depth, dir, pos);
                CCD_HIT
            }
            _ => CCD_MISS,
        }
    }
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
    unsafe { intersect(query.pair(!warm.is_null()), warm) }
}
