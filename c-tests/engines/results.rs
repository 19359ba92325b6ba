// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Judges the counters of the programs. The tests (`swap.rs`) and the lab share it.

// Each driver uses a part. Comparisons are negated so that NaN counts as a failure.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use super::programs::{Method, Output, run_all};

/// The largest share of a simulation's depths that are more than 1 % too deep, by a local minimum or a search
/// that stopped early.
const MAX_DEEP_SHARE: f64 = 2e-3;

/// The counters of compare.sh that are zero on this library: hits with a direction or depth that is no number, as the
/// program got them; proofs that a support value contradicts; wrong answers.
const FORBIDDEN: &str = "counted.broken counted.contradicted own.missed own.spurious own.unsound";

/// Returns why the answers to single queries on this library, the second, are worse than allowed.
pub fn collide_failures([theirs, ours]: &[Output; 2]) -> Vec<String> {
    assert_eq!(theirs.value("poses.queried"), ours.value("poses.queried"), "not the same poses");
    let mut failures = ours.nonzero(FORBIDDEN);
    failures.extend(ours.nonzero("own.deep counted.threw counted.endless counted.memory counted.no_shape"));
    // ODE's cylinder contradicts itself at touches; the judge allows for it there.
    let [uncertain, judged] = ["uncertain", "judged"].map(|key| ours.value(&format!("counted.{key}")));
    if uncertain > 0.01 * judged {
        failures.push(format!("{uncertain} of {judged} right only within the error of the callbacks"));
    }
    let threw = |output: &Output| output.get("poses.threw").unwrap_or_default();
    if threw(ours) > threw(theirs) {
        failures.push(format!("{} exceptions, on libccd {}", threw(ours), threw(theirs)));
    }
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
        let ours = &self.runs[1];
        let forbidden = format!("pile.escaped pile.bad own.slanted {FORBIDDEN}");
        self.failures.extend(ours.iter().flat_map(|run| run.nonzero(&forbidden)));
        let sum = |keys: &str| ours.iter().map(|run| run.sum(keys)).sum::<f64>();
        let (deep, judged) = (sum("own.deep"), sum("own.queries"));
        if !(deep <= MAX_DEEP_SHARE * judged) {
            self.failures.push(format!("{deep} of {judged} depths too deep"));
        }
    }

    /// Judges a pile: motion and depth at rest, the medians of the starts, are within libccd's spread and its width.
    pub fn judge_spread(&mut self) {
        let [theirs, ours] = &self.runs[..] else { unreachable!() };
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
