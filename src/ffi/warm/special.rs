// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! For special wishes: one valley, a proof, a direction, a plane.

use core::ffi::{c_int, c_uint, c_void};

use super::super::arena;
use super::super::callbacks::{Call, Query};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::CCD_BAD_INPUT;
use super::penetration::{answer, ccd_penetration_t};
use super::state::ccd_warm_t;
use super::unit_of;
use crate::contact::Settings;
use crate::query::{Pair, warm_start::WarmStart};

/// Returns a local minimum of the penetration depth, by a walk on known vertices. Faster than
/// ccdPenetration with a state or a guess that is roughly right; from far off it may end in
/// another minimum. Where the walk ends without one, the global search follows. From the state, else from the centres, else from first_dir.
///
/// Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
/// flags. Allocates nothing.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationLocal(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe { answer(query, Call::Refined, warm, want, out, Pair::local) }
}

/// The least penetration depth with its proof: depth - depth_lower <= epa_tolerance on CCD_HIT.
/// From the state, else from the centres, else from first_dir.
///
/// Reads epa_tolerance. center1 and center2 may be NULL, and are not trusted. `warm` may be NULL.
/// `want`: CCD_WANT_ flags. Takes memory from malloc only where the minima (nearly) form a curve
/// or a surface; there the bounds may stay open: CCD_LIMIT.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS, CCD_BAD_INPUT or CCD_NO_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationProven(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    let solve =
        |pair: &Pair<_, _>, state: &mut WarmStart, settings: &Settings, wants, hit: &mut _| {
            arena::with(|arena| pair.minimum(state, settings, arena, wants, hit))
        };
    // SAFETY: passed on.
    unsafe { answer(query, Call::Proven, warm, want, out, solve) }
}

/// How far obj2 must move along `dir` to separate (directional penetration depth).
///
/// `dir` need not be unit; zero, not finite or NULL is CCD_BAD_INPUT. Reads mpr_tolerance,
/// measured along `dir`. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
/// flags. Allocates nothing.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationAlong(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    dir: *const ccd_vec3_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let Some(dir) = unit_of(dir) else {
            return CCD_BAD_INPUT;
        };
        let query = Query { obj1, obj2, ccd };
        let solve =
            |pair: &Pair<_, _>, state: &mut WarmStart, settings: &Settings, _, hit: &mut _| {
                pair.along(dir, state, settings, hit)
            };
        answer(query, Call::Refined, warm, want, out, solve)
    }
}

/// A local minimum of the penetration depth among the directions of a plane, for shapes that lie
/// in a common plane with this normal. From the state, else from the centres, else from first_dir.
///
/// `plane_normal` need not be unit; zero, not finite or NULL is CCD_BAD_INPUT. Reads
/// mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_ flags.
/// Allocates nothing.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationPlanar(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    plane_normal: *const ccd_vec3_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let Some(m) = unit_of(plane_normal) else {
            return CCD_BAD_INPUT;
        };
        let query = Query { obj1, obj2, ccd };
        let solve =
            |pair: &Pair<_, _>, state: &mut WarmStart, settings: &Settings, _, hit: &mut _| {
                pair.planar(m, state, settings, hit)
            };
        answer(query, Call::Refined, warm, want, out, solve)
    }
}
