// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! States: carried from one query of a pair to the next.

use core::ffi::c_uint;

use super::super::types::ccd_vec3_t;
use super::super::write;
use super::direction;
use crate::minkowski::warm_start::WarmStart;

/// Number of reals in a ccd_warm_t.
pub const CCD_WARM_REALS: usize = 6;

/// State of one pair between queries. Plain data without pointers, nothing to free: all bytes
/// zero is cold, and copies are valid.
///
/// A state belongs to one pair in one order: ccdWarmFlip converts the state of (a, b) to one of
/// (b, a). Every call accepts the state that any other call has written. Two threads must not use
/// one state at once. NULL in place of a state is a cold start; nothing is stored.
///
/// A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to another
/// local minimum; every result stays sound. The fields are private.
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

/// Returns the caller's state; cold where `warm` is NULL.
///
/// # Safety
/// \[inputs\] of the module contract.
pub(in crate::ffi) unsafe fn read(warm: *const ccd_warm_t) -> WarmStart {
    // SAFETY: [inputs].
    match unsafe { warm.as_ref() } {
        Some(warm) => WarmStart::unpack(warm.reals, warm.words),
        None => WarmStart::COLD,
    }
}

/// Writes the caller's state unless `warm` is NULL.
///
/// # Safety
/// \[outputs\] of the module contract.
pub(in crate::ffi) unsafe fn store(warm: *mut ccd_warm_t, state: &WarmStart) {
    let (reals, words) = state.pack();
    // SAFETY: [outputs].
    unsafe { write(warm, ccd_warm_t { reals, words }) };
}

/// Makes `warm` a new state that starts from `dir`, a guess of the penetration direction, along
/// which obj2 moves to separate.
///
/// `dir`: of any length; NULL, zero or not finite makes a cold state. `warm`: NULL has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmGuess(warm: *mut ccd_warm_t, dir: *const ccd_vec3_t) {
    // SAFETY: [inputs], [outputs].
    unsafe { store(warm, &WarmStart::guess(&direction(dir))) };
}

/// Converts a state of the pair (obj1, obj2) to one of (obj2, obj1), for a caller who keeps one
/// state for each pair and queries it in either order.
///
/// `warm`: cold stays cold; NULL has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmFlip(warm: *mut ccd_warm_t) {
    // SAFETY: [inputs], [outputs].
    unsafe {
        let mut state = read(warm);
        state.flip();
        store(warm, &state);
    }
}
