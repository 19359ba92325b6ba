// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Yes or no.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Call, Object, Query};
use super::super::types::ccd_t;
use super::state::{ccd_warm_t, with_state};
use crate::minkowski::query::if_overlapping;
use crate::{query::Pair, state::State};

/// Yes or no of a pair, with the caller's state.
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
    let ask = |state: &mut State| {
        let overlap = if_overlapping(pair.intersect(Some(state)))?;
        Ok(c_int::from(overlap.is_some()))
    };
    // SAFETY: passed on. Without an answer the code is below 0.
    unsafe { with_state(warm, ask) }.max(0)
}

/// Do the objects overlap? A pair that stays apart costs one call of each support function while
/// its last separating direction still separates. From the state, else from the centres, else
/// from first_dir.
///
/// Reads no tolerance and no max_iterations. center1 and center2 may be NULL; where they are
/// given they must lie in their objects. `warm` may be NULL. Allocates nothing.
///
/// Returns 1 when they overlap, 0 when they do not; a touch within rounding is no overlap, nor
/// is what CCD_BAD_INPUT stands for.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdIntersect(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe { intersect(query.pair(Call::Refined, !warm.is_null()), warm) }
}
