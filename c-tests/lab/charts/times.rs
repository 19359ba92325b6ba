// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Times of queries: medians over repetitions in which all methods take turns.

use std::ffi::{c_int, c_long};
use std::hint::black_box;

use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Runner;
use crate::measuring::methods::Method;
use crate::measuring::scene::{Pair, Scene};

/// Returns a runner that takes times of so many repetitions.
pub fn runner(libraries: &Libraries, repetitions: usize) -> Runner<'_> {
    let mut runner = Runner::new(libraries);
    runner.times = Some(Box::new(move |scene, methods| times(scene, methods, repetitions)));
    runner
}

/// Returns the median; 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let value = |k: usize| values.get(k).copied().unwrap_or_default();
    let half = values.len() / 2;
    if values.len() % 2 == 1 { value(half) } else { (value(half.saturating_sub(1)) + value(half)) / 2.0 }
}

/// Returns the processor time of this thread in nanoseconds, which leaves out other processes.
fn thread_nanoseconds() -> f64 {
    unsafe extern "C" {
        fn clock_gettime(clock: c_int, time: *mut [c_long; 2]) -> c_int;
    }
    /// CLOCK_THREAD_CPUTIME_ID of Linux.
    const THREAD: c_int = 3;
    let mut time = [0; 2];
    // SAFETY: a timespec of 64-bit Linux: the benchmark compares with Debian's libccd.
    unsafe { clock_gettime(THREAD, &mut time) };
    1e9 * time[0] as f64 + time[1] as f64
}

/// Independent poses timed in one go: long against the clock's resolution, short against a time slice.
const CHUNK: usize = 25;

/// Returns the mean time of a query of each method, ns. All methods take turns over the scene;
/// the median of every chunk of poses (or motion) counts, which leaves out what else the machine does meanwhile.
fn times(scene: &Scene, methods: &mut [Method], repetitions: usize) -> Vec<f64> {
    let mut passes = vec![Vec::with_capacity(repetitions); methods.len()];
    for _ in 0..repetitions {
        for (method, times) in methods.iter_mut().zip(&mut passes) {
            times.push(pass(scene, method));
        }
    }
    let mean_of_medians = |passes: Vec<Vec<(f64, usize)>>| {
        let first = passes.first()?;
        let chunks = 0..first.len();
        let ns: f64 = chunks.map(|k| median(passes.iter().map(|pass| pass[k].0).collect())).sum();
        Some(ns / first.iter().map(|(_, queries)| queries).sum::<usize>() as f64)
    };
    passes.into_iter().filter_map(mean_of_medians).collect()
}

/// Returns the time of a method over a scene divided by another's: the median over repetitions in which both take turns. One
/// time a pass: reading the clock takes as long as a few misses.
pub fn ratio(scene: &Scene, method: &mut Method, other: &mut Method, repetitions: usize) -> f64 {
    let time = |method: &mut Method| {
        let begin = thread_nanoseconds();
        scene.pairs.iter().for_each(|pair| _ = black_box((method.query)(pair)));
        thread_nanoseconds() - begin
    };
    median((0..repetitions).map(|_| time(method) / time(other)).collect())
}

/// Returns time, ns, and number of the queries of every chunk; a warm method's first frames are not timed.
fn pass(scene: &Scene, method: &mut Method) -> Vec<(f64, usize)> {
    let (chunks, num_untimed): (Vec<&[Pair]>, _) = match method.is_warm() {
        true => (scene.pairs.chunk_by(|_, next| next.frame > 0).collect(), 1),
        false => (scene.pairs.chunks(CHUNK).collect(), 0),
    };
    let time = |chunk: &[Pair]| {
        let (untimed, timed) = chunk.split_at(num_untimed);
        untimed.iter().for_each(|pair| _ = black_box((method.query)(pair)));
        let begin = thread_nanoseconds();
        timed.iter().for_each(|pair| _ = black_box((method.query)(pair)));
        (thread_nanoseconds() - begin, timed.len())
    };
    chunks.into_iter().map(time).collect()
}
