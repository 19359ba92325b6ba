// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Provides the method of W. Gao, Efficient Incremental Penetration Depth Estimation between Convex
//! Geometries (2023), as published, for comparisons. ccdPenetrationLocal of warm.h also computes a
//! local minimum, with fewer support points, and ccdPenetration the global one. cbindgen makes
//! include/ccd/paper.h from src/ffi/paper.rs; edit there.

use core::ffi::{c_int, c_uint, c_void};

use super::callbacks::QueryArgs;
use super::run::fill;
use super::types::ccd_t;
use super::warm::penetration::ccd_penetration_t;
use super::warm::state::ccd_warm_t;
use crate::query::Solver;

/// Computes a local minimum of the penetration depth by the paper's Algorithms 4 and 5 with the
/// shortcut of its Section III-C. The result is sound: depth is the least support value evaluated,
/// and an overlap is proven. Directions are evaluated as they are, not tilted: a support function
/// that is wrong along its own axis, as ODE's cylinder, gives wrong depths and misses.
///
/// `warm`: may be NULL. `want`: CCD_WANT_ flags.
///
/// Reads mpr_tolerance. Allocates nothing.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationIncremental(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { fill(args, Solver::Incremental, warm, want, out) }
}
