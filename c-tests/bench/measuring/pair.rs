// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A pair of shapes in a pose, as `callbacks.c` makes it.

use std::ffi::c_void;

/// `pair_truth_t` of `c-tests/harness/pairs.h`.
#[repr(C)]
#[derive(Clone, Copy, Default, Debug)]
pub struct Truth {
    pub depth: f64,
    pub gap: f64,
    pub normal: [f64; 3],
    pub init5: [f64; 3],
    pub init25: [f64; 3],
    pub init45: [f64; 3],
    pub cold: [f64; 3],
}

/// `bench_pose_t` of `callbacks.c`: two placed shapes of the callbacks.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Pair {
    pub a: *mut c_void,
    pub b: *mut c_void,
    pub truth: Truth,
    pub motion: usize,
    /// Position in its motion; 0 starts a new one.
    pub frame: usize,
}
