// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's own queries.

use core::ffi::{c_int, c_void};

use super::arena;
use super::callbacks::{Call, Query};
use super::types::{ccd_t, ccd_vec3_t};
use super::warm::intersect::intersect;
use super::warm::libccd::{ccdMPRIntersectWarm, ccdMPRPenetrationWarm, libccd_s, write};
use super::warm::penetration::run;
use crate::contact::Penetration;
use crate::math::Real;

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
    unsafe {
        let pair = Query { obj1, obj2, ccd }.pair(Call::Gjk, false);
        intersect(pair, core::ptr::null_mut())
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
    libccd_s(unsafe {
        run(
            query,
            Call::Gjk,
            core::ptr::null_mut(),
            |pair, state, settings, hit| {
                arena::with(|arena| pair.minimum(state, settings, arena, wants_pos, hit))
            },
            |hit, _| put(hit),
        )
    })
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
