// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the queries of a C caller, and translates their ends to codes.

use core::ffi::c_int;

use super::arena::LargeBuffers;
use super::callbacks::{Interface, QueryArgs};
use super::warm::codes::{CCD_BAD_INPUT, CCD_MISS, CCD_NO_MEMORY};
use super::warm::state::{ccd_warm_t, read, store};
use crate::minkowski::support::Fault;
use crate::minkowski::support_query::Stop;
use crate::minkowski::warm_start::WarmStart;
use crate::solver::Solver;
use crate::trace;
use crate::types::{Penetration, Want};

/// Returns the extension's code of a query without a result.
pub fn code_of(stop: &Stop) -> c_int {
    match stop {
        Stop::Separated(_) => CCD_MISS,
        Stop::Fault(Fault::NoMemory) => CCD_NO_MEMORY,
        Stop::Fault(_) => CCD_BAD_INPUT,
    }
}

/// Returns libccd's code of a query without a result.
pub fn libccd_code_of(stop: &Stop) -> c_int {
    match stop {
        Stop::Fault(Fault::NoMemory) => -2,
        _ => -1,
    }
}

/// Runs a query with the caller's state, or a cold one where `warm` is NULL, and with memory that is allocated if the query
/// needs it. Stores the new state unless there is a fault.
///
/// # Errors
/// As [`Solver::run`]; [`Fault::BadInput`] for an argument.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract; nothing with a destructor is alive while callbacks run.
#[inline(always)]
pub unsafe fn run_query(
    args: QueryArgs,
    interface: Interface,
    solver: Solver,
    warm: *mut ccd_warm_t,
    want: Want,
) -> Result<Penetration, Stop> {
    // SAFETY: the caller's guarantees are those of the callees.
    unsafe {
        let settings = args.settings(interface, &solver).ok_or(Fault::BadInput)?;
        let pair = args
            .pair(interface, settings, want)
            .ok_or(Fault::BadInput)?;
        let (mut state, mut buffers) = (read(warm), LargeBuffers::default());
        let mut found = solver.run(&pair, &mut state, &mut buffers);
        buffers.free();
        if let Ok(hit) = &mut found {
            hit.finish(pair.difference.supports(), want);
        }
        trace::end(found.as_ref().ok());
        store_state(warm, state, &found);
        found
    }
}

/// Stores the state after a query unless there is a fault or `warm` is NULL.
///
/// # Safety
/// \[outputs\] of the module contract.
pub unsafe fn store_state<R>(warm: *mut ccd_warm_t, mut state: WarmStart, found: &Result<R, Stop>) {
    if !warm.is_null() && !matches!(found, Err(Stop::Fault(_))) {
        state.note_separation(found);
        // SAFETY: the caller's guarantees are those of the callee.
        unsafe { store(warm, &state) };
    }
}
