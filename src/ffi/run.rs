// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the queries of a C caller, stores its state and outputs, and translates the ends of queries to codes.

use core::ffi::{c_int, c_uint};
use core::mem::ManuallyDrop;

use super::arena::LargeBuffers;
use super::callbacks::{Interface, QueryArgs};
use super::types::ccd_vec3_t;
use super::warm::codes::{CCD_BAD_INPUT, CCD_HIT, CCD_LIMIT, CCD_MISS, CCD_NO_MEMORY};
use super::warm::state::{ccd_warm_t, read, store};
use super::warm::want::CCD_WANT_POS;
use super::write;
use crate::math::Real;
use crate::minkowski::support::Fault;
use crate::minkowski::support_query::Stop;
use crate::query::Solver;
use crate::types::{Solution, Status};

/// Runs a query with the caller's state, or a cold one where `warm` is NULL, and with memory that is allocated if the query
/// needs it. Stores the new state unless there is a fault. `want`: CCD_WANT_ flags.
///
/// # Errors
/// As [`Pair::run`](crate::query::Pair::run) and [`QueryArgs::pair`].
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract; nothing with a destructor is alive while callbacks run.
#[inline(always)]
pub unsafe fn run_query(
    args: QueryArgs,
    interface: Interface,
    solver: Solver,
    warm: *mut ccd_warm_t,
    want: c_uint,
) -> Result<Solution, Stop> {
    // SAFETY: the caller's guarantees are those of the callees; the buffers are dropped once, after their last use.
    unsafe {
        let pair = args.pair(interface, &solver, want)?;
        let mut state = read(warm);
        let mut buffers = ManuallyDrop::new(LargeBuffers::default());
        let found = pair.run(solver, &mut state, &mut *buffers);
        ManuallyDrop::drop(&mut buffers);
        if !warm.is_null() && !matches!(found, Err(Stop::Fault(_))) {
            state.note_separation(&found);
            store(warm, &state);
        }
        found
    }
}

/// Runs a penetration query of one of libccd's interfaces and writes those outputs that are not NULL. Returns libccd's
/// code.
///
/// # Safety
/// As [`run_query`].
#[inline(always)]
pub unsafe fn libccd_penetration(
    args: QueryArgs,
    interface: Interface,
    warm: *mut ccd_warm_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    let solver = match interface {
        Interface::Gjk => Solver::Proven,
        Interface::Mpr | Interface::Extension => Solver::Global,
    };
    let want = if pos.is_null() { 0 } else { CCD_WANT_POS };
    // SAFETY: the caller's guarantees are those of the callee; [outputs].
    unsafe {
        let hit = match run_query(args, interface, solver, warm, want) {
            Ok(hit) => hit,
            Err(Stop::Fault(Fault::NoMemory)) => return -2,
            Err(_) => return -1,
        };
        write(depth, hit.depth as Real);
        write(dir, hit.dir.into());
        write(pos, hit.pos.into());
    }
    0
}

/// Tests a pair for overlap with the caller's state. Returns 1 or 0: a fault counts as no overlap.
///
/// # Safety
/// As [`run_query`].
pub unsafe fn intersect(args: QueryArgs, interface: Interface, warm: *mut ccd_warm_t) -> c_int {
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { run_query(args, interface, Solver::Intersect, warm, 0) }
        .is_ok()
        .into()
}

/// Runs a query of the extension and fills `out`. Returns the extension's code.
///
/// # Safety
/// As [`run_query`].
#[inline(always)]
pub unsafe fn fill<T: From<Solution>>(
    args: QueryArgs,
    solver: Solver,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut T,
) -> c_int {
    if out.is_null() {
        return CCD_BAD_INPUT;
    }
    let is_distance = matches!(solver, Solver::Distance(_));
    // SAFETY: the caller's guarantees are those of the callee.
    match unsafe { run_query(args, Interface::Extension, solver, warm, want) } {
        Ok(found) => {
            // SAFETY: [outputs].
            unsafe { *out = found.into() };
            match found.status {
                Status::Converged if is_distance && !(found.depth > 0.0) => CCD_MISS,
                Status::Converged => CCD_HIT,
                _ => CCD_LIMIT,
            }
        }
        Err(Stop::Separated(_)) => CCD_MISS,
        Err(Stop::Fault(Fault::NoMemory)) => CCD_NO_MEMORY,
        Err(Stop::Fault(_)) => CCD_BAD_INPUT,
    }
}
