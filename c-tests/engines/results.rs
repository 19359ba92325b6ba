// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Judges the counters of the programs. The tests (`swap.rs`) and the lab share it.

// Each driver uses a part. Comparisons are negated so that NaN counts as a failure.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use super::programs::{Method, Output, run_all};

/// The deepest overlap that libccd's MPR takes for a miss: two of its tolerances, metres.
const LIBCCD_MISS_DEPTH: f64 = 2e-6;

/// Largest part of the depth by which ccdMPRPenetration's may exceed the minimum.
const MPR_REL_TOL: f64 = 0.003;

/// The largest share of a simulation's depths that are more than 1 % too deep, by a local minimum or a search
/// that stopped early.
const MAX_DEEP_SHARE: f64 = 2e-3;

/// The counters of wrong depths and directions.
const WRONG: [&str; 4] = ["spurious", "broken", "deep", "unsound"];

// --- single queries -------------------------------------------------------------

pub fn wrong_of(output: &Output, line: &str) -> f64 {
    WRONG.iter().map(|key| output.value(&format!("{line}.{key}"))).sum()
}

/// Returns why the answers of `collide` on this library, the second, are worse than allowed.
pub fn collide_failures([theirs, ours]: &[Output; 2]) -> Vec<String> {
    let all = |output: &Output| output.sum("collide.queries invalid_support.queries poses.threw");
    assert_eq!(all(theirs), all(ours), "not the same queries");
    let mut failures = ours.wrong();
    // The program's own results, before FCL or ODE has read them.
    failures.extend(ours.nonzero("counted.broken"));
    let mut expect = |is_right: bool, what: &str| {
        if !is_right {
            failures.push(format!("{what}:\n{}{}", theirs.text, ours.text));
        }
    };
    expect(ours.value("poses.threw") <= theirs.value("poses.threw"), "exceptions");
    expect(theirs.value("collide.deepest_miss") <= LIBCCD_MISS_DEPTH, "libccd misses more than two tolerances");
    expect(ours.value("collide.excess") <= MPR_REL_TOL, "too deep");
    // Where the engine's callback is wrong: a contact must not be missed, and no greater share of the depths be wrong.
    let share =
        |output: &Output| wrong_of(output, "invalid_support") / output.value("invalid_support.queries").max(1.0);
    expect(ours.value("invalid_support.missed") == 0.0, "misses with a wrong callback");
    expect(share(ours) <= share(theirs), "wrong depths with a wrong callback");
    failures
}

// --- whole programs -------------------------------------------------------------

/// A scene from several slightly different starts, by some methods.
pub struct Simulation {
    pub scene: String,
    pub steps: usize,
    /// By method and start.
    pub runs: Vec<Vec<Output>>,
    pub failures: Vec<String>,
}

/// Runs a scene from starts 1, 2, …, `starts`; `arguments` are those after SEED and STEPS.
pub fn simulate<const N: usize>(
    scene: &str,
    methods: &[Method; N],
    starts: usize,
    steps: usize,
    arguments: &str,
) -> Simulation {
    let mut runs: Vec<_> = methods.iter().map(|_| Vec::new()).collect();
    for seed in 1..=starts {
        eprintln!("{scene}: start {seed} of {starts}");
        for (runs, output) in runs.iter_mut().zip(run_all(methods, &format!("{seed} {steps} {arguments}"))) {
            runs.push(output);
        }
    }
    Simulation { scene: scene.to_owned(), steps, runs, failures: Vec::new() }
}

/// Runs and judges a scene on both libraries.
pub fn swapped(scene: &str, methods: &[Method; 2], starts: usize, steps: usize, arguments: &str) -> Simulation {
    let mut simulation = simulate(scene, methods, starts, steps, arguments);
    simulation.judge();
    simulation
}

pub fn values(runs: &[Output], key: &str) -> Vec<f64> {
    let mut values: Vec<f64> = runs.iter().map(|run| run.value(key)).collect();
    values.sort_by(f64::total_cmp);
    values
}

pub fn median(runs: &[Output], key: &str) -> f64 {
    let values = values(runs, key);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

/// Returns the least and the largest.
pub fn range(runs: &[Output], key: &str) -> (f64, f64) {
    let values = values(runs, key);
    (values[0], values[values.len() - 1])
}

impl Simulation {
    fn judge(&mut self) {
        let [theirs, ours] = &self.runs[..] else { unreachable!() };
        let forbidden = "pile.escaped pile.bad counted.broken counted.contradicted own.slanted own.missed own.spurious \
                         own.unsound";
        self.failures.extend(ours.iter().flat_map(|run| run.nonzero(forbidden)));
        let sum = |keys: &str| ours.iter().map(|run| run.sum(keys)).sum::<f64>();
        let (deep, judged) = (sum("own.deep"), sum("own.queries"));
        if !(deep <= MAX_DEEP_SHARE * judged) {
            self.failures.push(format!("{deep} of {judged} depths too deep"));
        }
        if theirs.len() < 10 {
            return; // too few starts to speak of a spread
        }
        for key in ["pile.kinetic", "pile.depth"] {
            let (least, most) = range(theirs, key);
            let width = most - least;
            // The same in ratios: nothing is below zero to fail the difference.
            let floor = (least - width).max(least * least / most);
            let median = median(ours, key);
            if !(floor <= median && median <= most + width) {
                self.failures.push(format!("{key}: median {median:e}, libccd {least:e} to {most:e}"));
            }
        }
    }

    /// Judges a scene at rest: energy gained, J, and the deepest contact, metres, of this library's runs,
    /// are at most these.
    pub fn judge_rest(&mut self, gained: f64, deepest: f64) {
        for (key, bound) in [("pile.gained", gained), ("pile.deepest", deepest)] {
            let most = range(&self.runs[1], key).1;
            if !(most <= bound) {
                self.failures.push(format!("{key} {most}, at most {bound} expected"));
            }
        }
    }

    pub fn assert_passes(&self) {
        assert!(self.failures.is_empty(), "{}:\n{}", self.scene, self.failures.join("\n"));
    }
}
