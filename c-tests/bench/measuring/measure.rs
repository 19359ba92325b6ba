// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Judges a method's answers on a scene by the truth, and measures its cost.
//!
//! Supports and errors are exact and repeatable. Times are medians over
//! repetitions in which all methods take turns.

use std::ffi::{c_int, c_long};
use std::hint::black_box;

use ccd::internals::ffi::ccd_vec3_t;
use nalgebra::Vector3;

use serde::{Deserialize, Serialize};

use super::libraries::Libraries;
use super::methods::Method;
use super::scene::{Pair, Scene};

/// One method on one scene. Lengths in metres.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Row {
    pub set: String,
    pub method: String,
    /// Where the search starts: `5`, `25`, `45` degrees off the truth, `centres`,
    /// `warm` (the last frame's state) or nothing.
    pub start: String,
    pub tolerance: Option<f64>,
    pub ours: bool,
    /// The variable of a chart: vertices, degrees a frame.
    pub x: Option<f64>,
    pub queries: usize,
    /// Of these, overlaps deeper than 1 nm: the ones that are judged.
    pub overlaps: usize,
    /// Support points of D per query.
    pub supports: f64,
    /// Mean time of a query, of medians over repetitions; none when not timed.
    pub ns: Option<f64>,
    /// |depth - truth| over all overlaps; one that is missed counts as depth 0.
    pub mean_error: f64,
    pub max_error: f64,
    /// Mean over the answers within 1 mm of the truth.
    pub mean_error_1mm: f64,
    /// Share of answers more than 1 mm too deep (percent).
    pub nonminimal: f64,
    /// Share of answers more than 1 mm too shallow (percent).
    pub shallow: f64,
    /// Share of overlaps answered by no hit or by a failure (percent).
    pub missed: f64,
    /// Largest h(dir) - depth: how far from separated the shapes may be left.
    pub unsound: f64,
    /// Widest uncertainty of the truth itself.
    pub truth_gap: f64,
}

/// The support value of D along `dir`.
pub fn support_value(libraries: &Libraries, pair: &Pair, dir: &[f64; 3]) -> f64 {
    let n = Vector3::from(*dir);
    let at = |shape, d: Vector3<f64>| {
        let (d, mut v) = (ccd_vec3_t::from(d), ccd_vec3_t::default());
        // SAFETY: a shape of the scene, a direction and room for a point.
        unsafe { (libraries.callbacks.support)(shape, &d, &mut v) };
        Vector3::from(v.v)
    };
    n.dot(&(at(pair.a.cast_const(), n) - at(pair.b.cast_const(), -n)))
}

/// 0 of none.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// NaN of any NaN; 0 of none, and never less.
fn largest(values: &[f64]) -> f64 {
    let larger = |m: f64, v: f64| if m >= v || m.is_nan() { m } else { v };
    values.iter().copied().fold(0.0, larger)
}

/// 0 of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let of = |k: usize| sorted.get(k).copied().unwrap_or_default();
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { of(half) } else { (of(half.saturating_sub(1)) + of(half)) / 2.0 }
}

/// Runs the method over the scene and judges every answer. A warm method's first
/// frame of each motion has no memory yet and is left out.
pub fn judge(libraries: &Libraries, scene: &Scene, method: &mut Method) -> Row {
    let calls = |pair: &Pair| {
        // SAFETY: shapes of the scene.
        unsafe { (libraries.callbacks.calls)(pair.a) + (libraries.callbacks.calls)(pair.b) }
    };
    let (mut errors, mut near) = (vec![], vec![]);
    let (mut unsound, mut missed, mut nonminimal, mut shallow) = (vec![], 0, 0, 0);
    let (mut queries, mut hits, mut supports, mut truth_gap) = (0_usize, 0_usize, 0, 0.0_f64);
    for pair in &scene.pairs {
        let before = calls(pair);
        let answer = method.query(scene, pair);
        let asked = calls(pair) - before;
        if method.is_warm() && pair.frame == 0 {
            continue;
        }
        queries += 1;
        supports += asked;
        truth_gap = truth_gap.max(pair.truth.gap);
        // Pairs apart or touching are asked about, not judged here.
        if pair.truth.depth <= 1e-9 {
            continue;
        }
        hits += 1;
        let Some(answer) = answer else {
            // As if the depth had been 0.
            errors.push(pair.truth.depth);
            missed += 1;
            continue;
        };
        let off = answer.depth - pair.truth.depth;
        errors.push(off.abs());
        unsound.push(support_value(libraries, pair, &answer.dir) - answer.depth);
        // Written so that NaN counts as non-minimal.
        if off < -1e-3 {
            shallow += 1;
        } else if off <= 1e-3 {
            near.push(off.abs());
        } else {
            nonminimal += 1;
        }
    }
    let percent = |k: usize| 100.0 * k as f64 / hits.max(1) as f64;
    Row {
        set: scene.name.clone(),
        method: method.name.clone(),
        start: method.start.name().to_owned(),
        tolerance: method.tolerance,
        ours: method.ours,
        x: None,
        queries,
        overlaps: hits,
        supports: supports as f64 / 2.0 / queries as f64,
        ns: None,
        mean_error: mean(&errors),
        max_error: largest(&errors),
        mean_error_1mm: mean(&near),
        nonminimal: percent(nonminimal),
        shallow: percent(shallow),
        missed: percent(missed),
        unsound: largest(&unsound),
        truth_gap,
    }
}

/// Processor time of this thread, nanoseconds: what other processes do meanwhile does not count.
fn thread_nanoseconds() -> f64 {
    unsafe extern "C" {
        fn clock_gettime(clock: c_int, time: *mut [c_long; 2]) -> c_int;
    }
    /// Linux' CLOCK_THREAD_CPUTIME_ID.
    const THREAD: c_int = 3;
    let mut time = [0; 2];
    // SAFETY: a timespec on 64-bit Linux, which this is: the benchmark compares with Debian's libccd.
    unsafe { clock_gettime(THREAD, &mut time) };
    1e9 * time[0] as f64 + time[1] as f64
}

/// Poses timed in one go, where they are independent: long against the clock's
/// resolution, short against a time slice.
const CHUNK: usize = 25;

/// Mean time of a query of each method, ns. All methods take turns over the scene,
/// `repetitions` times; of every chunk of poses (or motion) the median counts, so that
/// what else the machine does meanwhile does not.
pub fn times(scene: &Scene, methods: &mut [Method], repetitions: usize) -> Vec<f64> {
    let mut passes = vec![Vec::with_capacity(repetitions); methods.len()];
    for _ in 0..repetitions {
        for (method, times) in methods.iter_mut().zip(&mut passes) {
            times.push(pass(scene, method));
        }
    }
    let of = |passes: Vec<Vec<(f64, usize)>>| {
        let chunks = passes.first().map_or(0, Vec::len);
        let (mut ns, mut queries) = (0.0, 0);
        for k in 0..chunks {
            let chunk: Vec<f64> = passes.iter().map(|p| p[k].0).collect();
            ns += median(&chunk);
            queries += passes[0][k].1;
        }
        ns / queries as f64
    };
    passes.into_iter().map(of).collect()
}

/// Time, ns, and number of the queries of every chunk; a warm method's first frames untimed.
fn pass(scene: &Scene, method: &mut Method) -> Vec<(f64, usize)> {
    let time = |method: &mut Method, pairs: &[Pair]| {
        let begin = thread_nanoseconds();
        for pair in pairs {
            black_box(method.query(scene, pair));
        }
        (thread_nanoseconds() - begin, pairs.len())
    };
    if !method.is_warm() {
        return scene.pairs.chunks(CHUNK).map(|c| time(method, c)).collect();
    }
    let motions = scene.pairs.chunk_by(|_, next| next.frame > 0);
    let rests = motions.filter_map(|motion| {
        let (first, rest) = motion.split_first()?;
        black_box(method.query(scene, first));
        Some(time(method, rest))
    });
    rests.collect()
}
