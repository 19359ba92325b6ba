// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pairs of shapes in many poses, each with the global minimum of its
//! penetration depth: read from `c-tests/bench/pairs` or `c-tests/tools/record`.

use std::ffi::{c_int, c_uint, c_void};

use nalgebra::Vector3;

use ccd::internals::ffi::ccd_vec3_t;

use super::libraries::{Callbacks, Libraries, Recorded, Truth};
use crate::harness;

/// One pose: two shapes that the callbacks know, and what is true of them.
pub struct Pair {
    pub a: *mut c_void,
    pub b: *mut c_void,
    pub truth: Truth,
    /// Position in its motion; 0 starts a new one.
    pub frame: usize,
}

/// Pairs of one kind.
pub struct Scene {
    pub name: String,
    pub pairs: Vec<Pair>,
    /// Poses follow each other; else they are independent.
    pub motion: usize,
    /// Where the shapes live.
    _shapes: Vec<u64>,
}

/// Memory for `n` shapes, and the size of one in words.
pub fn room(callbacks: &Callbacks, n: usize) -> (Vec<u64>, usize) {
    // SAFETY: takes nothing.
    let words = unsafe { (callbacks.shape_size)() }.div_ceil(8);
    (vec![0; words * n], words)
}

impl Scene {
    /// A pair set of `c-tests/bench/pairs`. At most `limit` poses.
    pub fn load(libraries: &Libraries, name: &str, limit: usize) -> Self {
        let callbacks = libraries.callbacks;
        let path = harness::root().join(format!("c-tests/bench/pairs/{name}.bin"));
        // SAFETY: the functions of callbacks.c, called as it says; what they point to stays.
        unsafe {
            let (mut n, mut motion) = (0, 0);
            let file = Libraries::c_path(&path);
            let set = (callbacks.set)(file.as_ptr(), &mut n, &mut motion);
            assert!(!set.is_null(), "{} is not a pair set", path.display());
            let n = (n as usize).min(limit);
            let motion = motion as usize;
            let (mut shapes, words) = room(&callbacks, 2 * n);
            let base = shapes.as_mut_ptr();
            let pairs: Vec<Pair> = (0..n)
                .map(|i| {
                    let a = base.add(2 * i * words).cast();
                    let b = base.add((2 * i + 1) * words).cast();
                    let mut truth = Truth::default();
                    (callbacks.set_pose)(set, i as c_int, a, b, &mut truth);
                    let frame = i.checked_rem(motion).unwrap_or(0);
                    Pair { a, b, truth, frame }
                })
                .collect();
            Self { name: name.to_owned(), pairs, motion, _shapes: shapes }
        }
    }

    /// The recorded contact sequence of `c-tests/tools/record`, its first `frames` frames,
    /// queries sorted by pair: each contact is a motion of its own. Pairs that are
    /// apart have a negative depth; normals and guesses are not known.
    pub fn recorded(libraries: &Libraries, frames: usize) -> Self {
        let callbacks = libraries.callbacks;
        let path = harness::root().join("c-tests/tools/record/contacts.bin");
        let name = Libraries::c_path(&path);
        let frames = c_uint::try_from(frames).unwrap_or(c_uint::MAX);
        let read = |shapes: *mut u64, out: *mut Recorded| {
            // SAFETY: room for as many as it says it has, or none.
            unsafe { (callbacks.recording)(name.as_ptr(), frames, shapes.cast(), out) }
        };
        let count = read(std::ptr::null_mut(), std::ptr::null_mut());
        assert!(count > 0, "{} is not a recording", path.display());
        let (mut shapes, words) = room(&callbacks, 2 * count);
        let mut found = vec![Recorded::default(); count];
        read(shapes.as_mut_ptr(), found.as_mut_ptr());
        let base = shapes.as_mut_ptr();
        // SAFETY: one of the shapes.
        let shape = |k: usize| -> *mut c_void { unsafe { base.add(k * words).cast() } };
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|&k| (found[k].a, found[k].b));
        let mut pairs: Vec<Pair> = Vec::with_capacity(count);
        let mut last = Recorded::default();
        for k in order {
            let now = found[k];
            let goes_on = (now.a, now.b, now.frame) == (last.a, last.b, last.frame + 1);
            let age = pairs.last().map_or(0, |pair| pair.frame + 1);
            last = now;
            let (a, b) = (shape(2 * k), shape(2 * k + 1));
            let [pa, pb] = [a, b].map(|s| {
                let mut at = ccd_vec3_t::default();
                // SAFETY: a shape that was placed.
                unsafe { (callbacks.center)(s, &mut at) };
                Vector3::from(at.v)
            });
            let truth = Truth {
                depth: (now.lower + now.upper) / 2.0,
                gap: now.upper - now.lower,
                cold: (pb - pa).try_normalize(0.0).unwrap_or(Vector3::x()).into(),
                ..Truth::default()
            };
            let frame = if goes_on { age } else { 0 };
            pairs.push(Pair { a, b, truth, frame });
        }
        Self { name: "recorded".to_owned(), pairs, motion: 1, _shapes: shapes }
    }
}
