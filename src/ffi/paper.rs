// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The method of a paper as published, for comparisons: W. Gao, Efficient Incremental
//! Penetration Depth Estimation between Convex Geometries. warm.h's ccdPenetrationLocal answers
//! the same in fewer support points, and ccdPenetration answers the least depth of all. Made by
//! cbindgen from src/ffi/paper.rs; edit there.

use core::ffi::{c_int, c_uint, c_void};

use super::callbacks::{Call, Query};
use super::types::ccd_t;
use super::warm::penetration::{answer, ccd_penetration_t};
use super::warm::state::ccd_warm_t;
use crate::query::Pair;

/// A local minimum of the penetration depth by the paper's Algorithms 4 and 5, the shortcut on,
/// with a sound answer: the depth is that of the least support plane met, and an overlap is
/// proven. From the state's direction, else from the centres, else from first_dir.
///
/// Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
/// flags. Allocates nothing.
///
/// Returns warm.h's codes: CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationIncremental(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe { answer(query, Call::Refined, warm, want, out, Pair::incremental) }
}
