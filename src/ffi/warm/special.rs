// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Special penetration queries: local minimum, proven minimum, along a direction, in a plane.

use core::ffi::{c_int, c_uint, c_void};

use super::super::callbacks::QueryArgs;
use super::super::run::fill;
use super::super::types::{ccd_t, ccd_vec3_t};
use super::direction;
use super::penetration::ccd_penetration_t;
use super::state::ccd_warm_t;
use crate::query::Solver;

/// Computes a local minimum of the penetration depth by a local search from the state's direction.
/// Faster than ccdPenetration if that direction is roughly right; from a distant one it may find
/// another minimum. If the search does not converge, ccdPenetration's search follows.
///
/// `warm`: may be NULL. `want`: CCD_WANT_ flags.
///
/// Reads mpr_tolerance. Allocates nothing.
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
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { fill(args, Solver::Local, warm, want, out) }
}

/// Computes the globally least penetration depth with a certificate: depth - depth_lower <=
/// epa_tolerance on CCD_HIT. Does not rely on the centers.
///
/// `warm`: may be NULL. `want`: CCD_WANT_ flags.
///
/// Reads epa_tolerance. Allocates only if the minimum is (nearly) not unique, as for coaxial
/// cylinders and concentric spheres; the bounds may then not meet, and CCD_LIMIT is returned: for
/// balls whose centers are closer than 5 % of the sum of their radii, at a tolerance of 1e-6 of the
/// size 8 %.
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
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { fill(args, Solver::Proven, warm, want, out) }
}

/// Computes the directional penetration depth: the least distance by which obj2 must move along
/// `dir` to separate the objects.
///
/// `dir`: of any length; NULL, zero or not finite is CCD_BAD_INPUT. `warm`: may be NULL. `want`:
/// CCD_WANT_ flags.
///
/// Reads mpr_tolerance, measured along `dir`. Allocates nothing.
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
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callees.
    unsafe { fill(args, Solver::Along(direction(dir)), warm, want, out) }
}

/// Computes a local minimum of the penetration depth over the directions in a plane, for objects
/// that lie in a common plane.
///
/// `plane_normal`: of any length; NULL, zero or not finite is CCD_BAD_INPUT. `warm`: may be NULL.
/// `want`: CCD_WANT_ flags.
///
/// Reads mpr_tolerance. Allocates nothing.
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
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callees.
    unsafe {
        fill(
            args,
            Solver::Planar(direction(plane_normal)),
            warm,
            want,
            out,
        )
    }
}
