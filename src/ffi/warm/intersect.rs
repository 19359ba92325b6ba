// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Overlap: yes or no.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Interface, QueryArgs};
use super::super::run::intersect;
use super::super::types::ccd_t;
use super::state::ccd_warm_t;

/// Reports whether the objects overlap.
///
/// `warm`: the pair's state, may be NULL; with a state a pair costs one support point while its
/// last separating axis still separates.
///
/// Reads no tolerance and no max_iterations. Allocates nothing.
///
/// Returns 1 if they overlap; 0 if they are apart or touch within rounding, when support1 or
/// support2 is NULL, or when a center or a point is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(QueryArgs { obj1, obj2, ccd }, Interface::Extension, warm) }
}
