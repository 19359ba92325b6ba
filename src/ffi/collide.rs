// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exports libccd's own queries, its first direction and its support function of the Minkowski difference. CCD_INIT's
//! value replaces a tolerance that is negative or NaN.

use core::ffi::{c_int, c_void};
use core::ptr::null_mut;

use super::callbacks::{Interface, QueryArgs};
use super::run::{intersect, libccd_penetration};
use super::types::{ccd_support_t, ccd_t, ccd_vec3_t};
use crate::math::{Real, Vec3};

/// Reports whether the objects overlap. Starts from the centers, which must lie in their objects.
///
/// Reads no tolerance and no max_iterations. Allocates nothing.
///
/// Returns 1 when they overlap; 0 when they are apart or touch within rounding, when a support or
/// center callback is NULL, or when a point is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(QueryArgs { obj1, obj2, ccd }, Interface::Mpr, null_mut()) }
}

/// Reports whether the objects overlap. Starts from first_dir and calls no center.
///
/// Reads no tolerance and no max_iterations. Allocates nothing.
///
/// Returns the codes of [`ccdMPRIntersect`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(QueryArgs { obj1, obj2, ccd }, Interface::Gjk, null_mut()) }
}

/// Computes penetration depth, direction and contact position. Starts from the centers, which must
/// lie in their objects.
///
/// `depth`: metres; moving obj2 by depth * dir separates the objects. `dir`: unit. `pos`: the
/// center of pressure, the centroid of the common volume except for its coordinate along dir. Each
/// may be NULL.
///
/// Reads mpr_tolerance: depth exceeds the least depth by at most mpr_tolerance or 0.1 % of the
/// depth, the larger of the two; after 160 support points or max_iterations it is a sound upper
/// bound. Allocates nothing.
///
/// Returns 0 when the objects overlap; -1, with the outputs unchanged, when they are apart or touch
/// within rounding, when a support or center callback is NULL, or when a point is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRPenetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { libccd_penetration(args, Interface::Mpr, null_mut(), depth, dir, pos) }
}

/// Runs [`ccdGJKPenetration`]. No exported function calls another: the linker would bind that call to a function of the
/// same name in another library of the process.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract.
#[inline(never)]
unsafe fn gjk_penetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { libccd_penetration(args, Interface::Gjk, null_mut(), depth, dir, pos) }
}

/// Computes the globally least penetration depth, its direction and the contact position. Starts
/// from first_dir and calls no center.
///
/// `depth`, `dir`, `pos`: as of [`ccdMPRPenetration`]; each may be NULL.
///
/// Reads epa_tolerance, the largest error of depth, metres; after 320 support points or
/// max_iterations depth is a sound upper bound. Allocates, and frees before it returns, only where
/// the minima (nearly) form a curve or a surface.
///
/// Returns 0 when the objects overlap; with the outputs unchanged -2 when malloc fails, and -1 when
/// they are apart or touch within rounding, when support or first_dir is NULL, or when a point is not
/// finite.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKPenetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { gjk_penetration(obj1, obj2, ccd, depth, dir, pos) }
}

/// Computes the shortest translation of obj2 that separates the objects: `sep` = depth * dir, metres;
/// may be NULL. Callbacks, tolerance, memory and codes are those of [`ccdGJKPenetration`].
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdGJKSeparate(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    sep: *mut ccd_vec3_t,
) -> c_int {
    let (mut depth, mut dir) = (0.0, ccd_vec3_t::default());
    // SAFETY: the caller's guarantees are those of the callee; [outputs].
    unsafe {
        let code = gjk_penetration(obj1, obj2, ccd, &mut depth, &mut dir, null_mut());
        if let (0, Some(sep)) = (code, sep.as_mut()) {
            *sep = (Vec3::from(dir) * f64::from(depth)).into();
        }
        code
    }
}

/// Writes (1, 0, 0) to `dir`. `CCD_INIT` sets this callback.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdFirstDirDefault(
    _obj1: *const c_void,
    _obj2: *const c_void,
    dir: *mut ccd_vec3_t,
) {
    // SAFETY: [outputs].
    unsafe { *dir = Vec3::x().into() };
}

/// Writes the support point of the Minkowski difference along `dir` to `supp`; no effect where a
/// support callback is NULL. `dir` is passed to the callbacks without normalisation and may be part
/// of `supp`.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn __ccdSupport(
    obj1: *const c_void,
    obj2: *const c_void,
    dir: *const ccd_vec3_t,
    ccd: *const ccd_t,
    supp: *mut ccd_support_t,
) {
    // SAFETY: [inputs]; copied, because the callbacks write to `supp`.
    let dir = unsafe { *dir };
    // SAFETY: [ccd]; only the two fields are read.
    let callbacks = unsafe { ((*ccd).support1, (*ccd).support2) };
    let (Some(support1), Some(support2)) = callbacks else {
        return;
    };
    // SAFETY: [callbacks].
    unsafe { support1(obj1, &dir, &raw mut (*supp).v1) };
    let opposite: ccd_vec3_t = (-Vec3::from(dir)).into();
    // SAFETY: [callbacks].
    unsafe { support2(obj2, &opposite, &raw mut (*supp).v2) };
    // SAFETY: [outputs].
    unsafe { (*supp).v = (Vec3::from((*supp).v1) - Vec3::from((*supp).v2)).into() };
}
