// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! States: what one query of a pair leaves for the next.

use core::ffi::{c_int, c_uint};

use super::super::types::ccd_vec3_t;
use super::codes::{CCD_BAD_INPUT, CCD_NO_MEMORY};
use crate::minkowski::support::Fault;
use crate::query::warm_start::WarmStart;

/// How many numbers a ccd_warm_t holds.
pub const CCD_WARM_REALS: usize = 6;

/// State of one pair between queries. Plain data, no pointers, nothing to free: all
/// bytes zero is cold, and it may be copied and stored freely.
///
/// One state is for one pair in one order: the state of (a, b) is a foreign one to a query of
/// (b, a), until ccdWarmFlip turns it round. Every call takes what any other call has left in
/// it. Two threads must not use one state at once. Wherever a call takes a state, NULL is cold,
/// and saves what it costs to leave one.
///
/// A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to
/// another local minimum; every answer stays sound. The fields are the library's own.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_warm_t {
    /// Private.
    pub reals: [f64; CCD_WARM_REALS],
    /// Private.
    pub words: [c_uint; 2],
}

const _: () = {
    assert!(CCD_WARM_REALS == WarmStart::REALS);
    assert!(size_of::<ccd_warm_t>() == 56);
};

/// The caller's state; cold where there is none.
///
/// # Safety
/// \[inputs\] of the module contract.
unsafe fn read(warm: *const ccd_warm_t) -> WarmStart {
    // SAFETY: [inputs].
    match unsafe { warm.as_ref() } {
        Some(warm) => WarmStart::unpack(warm.reals, warm.words),
        None => WarmStart::COLD,
    }
}

/// What `ask` returns: with the caller's state, or with a cold one where there is none. The state stays
/// as it was where there is no answer.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract; `ask` runs callbacks, so that nothing
/// with a destructor is alive here.
#[inline(always)]
pub(in crate::ffi) unsafe fn with_state(
    warm: *mut ccd_warm_t,
    ask: impl FnOnce(&mut WarmStart) -> Result<c_int, Fault>,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let mut state = read(warm);
        match ask(&mut state) {
            Ok(code) => {
                store(warm, &state);
                code
            }
            Err(Fault::NoMemory) => CCD_NO_MEMORY,
            Err(Fault::NonFinite) => CCD_BAD_INPUT,
        }
    }
}

/// # Safety
/// \[outputs\] of the module contract.
unsafe fn store(warm: *mut ccd_warm_t, state: &WarmStart) {
    if !warm.is_null() {
        let (reals, words) = state.pack();
        // SAFETY: [outputs].
        unsafe { *warm = ccd_warm_t { reals, words } };
    }
}

/// Makes `warm` a fresh state that starts from `dir`, the caller's guess of the way obj2
/// leaves.
///
/// `dir` need not be unit; zero, not finite or NULL makes a cold state. `warm` NULL: nothing
/// happens.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmGuess(warm: *mut ccd_warm_t, dir: *const ccd_vec3_t) {
    // SAFETY: [inputs], [outputs].
    unsafe {
        let guess = match dir.as_ref() {
            Some(dir) => WarmStart::guess(&(*dir).into()),
            None => WarmStart::COLD,
        };
        store(warm, &guess);
    }
}

/// Makes a state of the pair (obj1, obj2) one of (obj2, obj1): for a caller who keeps one
/// state a pair and meets its objects in either order.
///
/// Cold stays cold. `warm` NULL: nothing happens.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmFlip(warm: *mut ccd_warm_t) {
    // SAFETY: [inputs], [outputs].
    unsafe {
        let mut state = read(warm);
        state.flip();
        store(warm, &state);
    }
}
