// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's own queries.

use core::ffi::{c_int, c_void};

use super::arena;
use super::callbacks::Query;
use super::types::{ccd_t, ccd_vec3_t};
use super::warm::libccd::{ccdMPRIntersectWarm, ccdMPRPenetrationWarm};
use crate::contact::{Answer, Penetration, Settings};
use crate::gjk::overlap;
use crate::known::support::Fault;
use crate::known::support_set::Stop;
use crate::math::{Real, Vec3, unit};
use crate::{query::Pair, state::State};

/// Tolerance of a compatible call whose own is NaN or negative: what CCD_INIT sets.
pub const DEFAULT_TOLERANCE: Real = 1e-4;

/// The tolerance a compatible call works with.
fn or_default(tolerance: Real) -> Real {
    // False for NaN.
    if tolerance >= 0.0 {
        tolerance
    } else {
        DEFAULT_TOLERANCE
    }
}

/// Writes the outputs that are not NULL.
///
/// # Safety
/// \[outputs\] of the module contract.
pub unsafe fn write(
    hit: &Penetration,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) {
    // SAFETY: [outputs].
    unsafe {
        if let Some(depth) = depth.as_mut() {
            *depth = hit.depth;
        }
        if let Some(dir) = dir.as_mut() {
            *dir = hit.dir.into();
        }
        if let Some(pos) = pos.as_mut() {
            *pos = hit.pos.into();
        }
    }
}

/// Do the objects overlap? Starts from the centres, and relies on their lying in the objects.
///
/// Returns 1 when they overlap, 0 when they do not (a touch within rounding is no overlap),
/// when a callback is NULL or a point not finite. max_iterations is not read.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe { ccdMPRIntersectWarm(obj1, obj2, ccd, core::ptr::null_mut()) }
}

/// # Safety
/// \[inputs\] of the module contract.
unsafe fn gjk_intersect(query: Query) -> Option<Result<(), Stop>> {
    // SAFETY: passed on.
    unsafe {
        let md = query.difference()?;
        let first = query.first_dir()?;
        let dir = unit(&first).unwrap_or(Vec3::x());
        Some(overlap::from_direction(&md, &dir))
    }
}

/// Do the objects overlap? Starts from first_dir; the centres are not asked for.
///
/// Returns as [`ccdMPRIntersect`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
) -> c_int {
    // SAFETY: passed on.
    match unsafe { gjk_intersect(Query { obj1, obj2, ccd }) } {
        Some(Ok(_)) => 1,
        _ => 0,
    }
}

/// ccdMPRPenetration with a state; a fault when nothing was decided.
///
/// # Safety
/// \[inputs\] of the module contract.
pub unsafe fn mpr_penetration(
    query: Query,
    state: &mut State,
    lasting: bool,
    wants_pos: bool,
) -> Result<Answer, Fault> {
    // SAFETY: passed on.
    unsafe {
        let pair = query.pair(lasting).ok_or(Fault::NonFinite)?;
        let settings = Settings {
            tolerance: or_default(query.mpr_tolerance()),
            max_iterations: query.max_iterations(),
        };
        pair.mpr(state, &settings, wants_pos)
    }
}

/// How deep do the objects overlap, which way out, where? Starts from the centres.
///
/// Returns 0 and writes the outputs that are not NULL when they overlap:
/// `depth` in metres, `dir` unit, the way obj2 moves, `pos` the centre of pressure, which is the
/// centroid of the volume that the objects share, but for its height along dir. Returns -1 and leaves the outputs alone when they do not, when a
/// callback is NULL or a point not finite.
///
/// Of a support function, depth exceeds the least depth by no more than mpr_tolerance or 0.1 %
/// of it; but where 160 support points or max_iterations came first, which is not told, it is
/// only sound: moving obj2 by depth along dir separates.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRPenetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe { ccdMPRPenetrationWarm(obj1, obj2, ccd, core::ptr::null_mut(), depth, dir, pos) }
}

/// The global minimum, from first_dir; the centres are not asked for. A hit is told to `put`. Returns
/// as [`ccdGJKPenetration`].
///
/// # Safety
/// \[inputs\] of the module contract.
#[inline(never)]
unsafe fn gjk_penetration(
    query: Query,
    wants_pos: bool,
    put: &mut dyn FnMut(&Penetration),
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let Some(md) = query.difference() else {
            return -1;
        };
        let Some(first) = query.first_dir() else {
            return -1;
        };
        let pair = Pair {
            md,
            centre: None,
            first_dir: Some(first),
            lasting: false,
        };
        let settings = Settings {
            tolerance: or_default(query.epa_tolerance()),
            max_iterations: query.max_iterations(),
        };
        let mut cold = State::default();
        let answer = arena::with(|arena| pair.minimum(&mut cold, &settings, arena, wants_pos));
        match &answer {
            Ok(Answer::Hit(hit) | Answer::Limit(hit)) => {
                put(hit);
                0
            }
            Ok(Answer::Miss(_)) | Err(Fault::NonFinite) => -1,
            Err(Fault::NoMemory) => -2,
        }
    }
}

/// How deep do the objects overlap, which way out, where? The global minimum, within
/// epa_tolerance. Starts from first_dir; the centres are not asked for.
///
/// Returns 0 and writes the outputs that are not NULL when they overlap, as
/// [`ccdMPRPenetration`] does; -2 when memory cannot be had and -1 otherwise, and leaves
/// the outputs alone. Where max_iterations or 360 support points came first, which is not
/// told, the depth is only sound.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKPenetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    // SAFETY: passed on; [outputs].
    unsafe {
        gjk_penetration(Query { obj1, obj2, ccd }, !pos.is_null(), &mut |hit| {
            write(hit, depth, dir, pos);
        })
    }
}

/// The shortest translation of obj2 that separates the objects, written to `sep` unless
/// that is NULL. Otherwise as [`ccdGJKPenetration`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKSeparate(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    sep: *mut ccd_vec3_t,
) -> c_int {
    // SAFETY: passed on; [outputs].
    unsafe {
        gjk_penetration(Query { obj1, obj2, ccd }, false, &mut |hit| {
            if let Some(sep) = sep.as_mut() {
                *sep = (hit.dir * hit.depth).into();
            }
        })
    }
}
