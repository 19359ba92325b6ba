// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pairs of shapes in many poses, each with the global minimum of its penetration depth: pair sets of
//! `c-tests/bench/pairs` and the recorded contacts of `c-tests/tools/record`.

use std::ffi::CString;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::ptr::null_mut;

use super::libraries::Libraries;
pub use super::pair::{Pair, Truth};
use crate::harness;

/// Kinds and depths of random pairs, in the order of `bench_random` in `callbacks.c`.
pub const KINDS: [&str; 8] = [
    "boxes",
    "hulls",
    "capsules",
    "cylinders and cones",
    "ellipsoids",
    "hulls of 42 corners",
    "hulls of 642 corners",
    "hull of 162 corners and capsule",
];
pub const DEPTHS: [&str; 5] = ["shallow", "medium", "deep", "near", "far"];

/// Kinds of bodies on floors, in the order of `c-tests/harness/floor.h`.
pub const FLOOR_KINDS: [&str; 3] = ["boxes", "round bodies", "hulls of 42 and 162 corners"];

/// Names of the scenes of [`Scene::floors`], and their poses, as many as of a pair set.
pub const FLOORS: [&str; 3] = ["boxes on a floor", "round bodies on a floor", "hulls on a floor"];
const NUM_ON_FLOOR: usize = 500;

/// Pairs of one kind.
#[derive(Clone)]
pub struct Scene {
    pub name: String,
    pub pairs: Vec<Pair>,
}

impl Scene {
    /// Reads at most `limit` poses of a pair set.
    pub fn load(libraries: &Libraries, name: &str, limit: usize) -> Self {
        let file = harness::root().join(format!("c-tests/bench/pairs/{name}.bin"));
        let mut scene = Self::read(libraries, name, &file);
        scene.pairs.truncate(limit);
        scene
    }

    /// Reads the recorded contacts, each of which is a motion. Pairs apart have a negative depth; normals and guesses
    /// are missing.
    pub fn recorded(libraries: &Libraries) -> Self {
        Self::read(libraries, "recorded", &harness::root().join("c-tests/tools/record/contacts.bin"))
    }

    /// Makes pairs of two shapes of a kind at a depth. Normals and guesses are missing.
    pub fn random(libraries: &Libraries, kind: usize, depth: usize, num_pairs: usize) -> Self {
        let make = libraries.callbacks.random;
        let index = |i: usize| i.try_into().expect("a small number");
        // SAFETY: the indices are those of the tables, which have callbacks.c's order.
        let pairs = Self::pairs(|poses| unsafe { make(index(kind), index(depth), num_pairs, poses) });
        Self { name: format!("{} {}", KINDS[kind], DEPTHS[depth]), pairs }
    }

    /// Makes motions of two frames of a box that slides on a larger one. Normals and guesses are missing.
    pub fn sliding(libraries: &Libraries, num_motions: usize) -> Self {
        // SAFETY: any number.
        let pairs = Self::pairs(|poses| unsafe { (libraries.callbacks.sliding)(num_motions, poses) });
        Self { name: "sliding boxes".to_owned(), pairs }
    }

    /// Makes motions of two frames of a body on a plate, by the half width of the plate, metres: 1 mm deep, or as much above
    /// it.
    pub fn floor(libraries: &Libraries, kind: usize, half: f64, is_above: bool, num_motions: usize) -> Self {
        let make = libraries.callbacks.floor;
        let index = kind.try_into().expect("a small number");
        // SAFETY: the index is one of the table, which has floor.h's order.
        let pairs = Self::pairs(|poses| unsafe { make(index, half, is_above.into(), num_motions, poses) });
        let place = if is_above { "above" } else { "on" };
        Self { name: format!("{} {place} a plate of {half} m", FLOOR_KINDS[kind]), pairs }
    }

    /// Returns at most `limit` independent poses of every kind of body, 1 mm deep in plates of 20 m.
    pub fn floors(libraries: &Libraries, limit: usize) -> [Self; 3] {
        [0, 1, 2].map(|kind| {
            let mut scene = Self::floor(libraries, kind, 20.0, false, limit.min(NUM_ON_FLOOR));
            scene.pairs.retain(|pair| pair.frame == 0);
            Self { name: FLOORS[kind].to_owned(), ..scene }
        })
    }

    /// Returns the pairs of a motion's second frames, for queries without a memory.
    pub fn second_frames(&self) -> Self {
        let mut alone = self.clone();
        alone.pairs.retain(|pair| pair.frame > 0);
        alone
    }

    /// Returns the pairs that a function of callbacks.c makes.
    fn pairs(make: impl FnOnce(*mut *mut Pair) -> usize) -> Vec<Pair> {
        let mut poses = null_mut();
        match make(&mut poses) {
            0 => Vec::new(),
            // SAFETY: the contract of callbacks.c: so many poses, which are never freed.
            count => unsafe { std::slice::from_raw_parts(poses, count).to_vec() },
        }
    }

    fn read(libraries: &Libraries, name: &str, path: &Path) -> Self {
        let file = CString::new(path.as_os_str().as_bytes()).expect("a path without NUL");
        // SAFETY: a path.
        let mut pairs = Self::pairs(|poses| unsafe { (libraries.callbacks.scene)(file.as_ptr(), poses) });
        assert!(!pairs.is_empty(), "{} is neither a pair set nor a recording", path.display());
        pairs.sort_by_key(|pair| pair.motion);
        let mut last = (usize::MAX, 0);
        let mut position = 0;
        for pair in &mut pairs {
            let now = (pair.motion, pair.frame);
            position = if now == (last.0, last.1 + 1) { position + 1 } else { 0 };
            pair.frame = position;
            last = now;
        }
        Self { name: name.to_owned(), pairs }
    }

    /// Whether poses follow each other; otherwise they are independent.
    pub fn is_motion(&self) -> bool {
        self.pairs.iter().any(|pair| pair.frame > 0)
    }
}
