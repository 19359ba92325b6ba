// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exports libccd's first direction and its support function of the Minkowski difference.

use core::ffi::c_void;

use super::types::{ccd_support_t, ccd_t, ccd_vec3_t};
use crate::math::Vec3;

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

/// Writes the support point of the Minkowski difference along `dir` to `supp`. `dir` is passed to
/// the callbacks without normalisation and may be part of `supp`.
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
