// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Overlap: yes or no.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Object, QueryArgs, QueryKind};
use super::super::types::ccd_t;
use super::state::{ccd_warm_t, with_state};
use crate::minkowski::support_query::if_overlapping;
use crate::minkowski::warm_start::WarmStart;
use crate::query::Pair;

/// Tests a pair for overlap with the caller's state. Returns 1 or 0.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract.
pub(in crate::ffi) unsafe fn intersect(
    pair: Option<Pair<Object, Object>>,
    warm: *mut ccd_warm_t,
) -> c_int {
    let Some(pair) = pair else {
        return 0;
    };
    if warm.is_null() {
        return c_int::from(pair.intersect(None).is_ok());
    }
    let solve = |state: &mut WarmStart| {
        let overlap = if_overlapping(pair.intersect(Some(state)))?;
        Ok(c_int::from(overlap.is_some()))
    };
    // Faults have negative codes; they count as no overlap.
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { with_state(warm, solve) }.max(0)
}

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
    let query = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { intersect(query.pair(QueryKind::Penetration, !warm.is_null()), warm) }
}
