// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Judges the counters of the programs. The tests (`swap.rs`) and the lab share it.

// Each driver uses a part. Comparisons are negated so that NaN counts as a failure.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use super::programs::Output;

/// The counters of compare.sh that are zero on this library: hits with a direction or depth that is no number, as the
/// program got them; proofs that a support value contradicts; wrong answers.
const FORBIDDEN: &str = "counted.broken counted.contradicted own.missed own.spurious own.deep own.unsound";

/// Returns why the answers to single queries on this library, the second, are worse than allowed.
pub fn collide_failures([theirs, ours]: &[Output; 2]) -> Vec<String> {
    assert_eq!(theirs.value("poses.queried"), ours.value("poses.queried"), "not the same poses");
    let mut failures = ours.nonzero(FORBIDDEN);
    failures.extend(ours.nonzero("counted.threw counted.endless counted.memory counted.no_shape"));
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

/// Returns why the answers to a program's queries on this library, in all its runs, are worse than allowed.
pub fn answer_failures(ours: &[Output]) -> Vec<String> {
    let forbidden = format!("own.slanted {FORBIDDEN}");
    ours.iter().flat_map(|run| run.nonzero(&forbidden)).collect()
}

/// Returns the same of `ode_pile`, whose bodies stay in their pen and whose contacts are valid; energy gained, J, and the
/// deepest contact, metres, are at most these.
pub fn pile_failures(ours: &[Output], gained: f64, deepest: f64) -> Vec<String> {
    let mut failures = answer_failures(ours);
    failures.extend(ours.iter().flat_map(|run| run.nonzero("pile.escaped pile.bad")));
    for (key, bound) in [("pile.gained", gained), ("pile.deepest", deepest)] {
        let most = most(ours, key);
        if !(most <= bound) {
            failures.push(format!("{key} {most}, at most {bound} expected"));
        }
    }
    failures
}

/// Returns the values of a counter in ascending order.
pub fn values(runs: &[Output], key: &str) -> Vec<f64> {
    let mut values: Vec<f64> = runs.iter().map(|run| run.value(key)).collect();
    values.sort_by(f64::total_cmp);
    values
}

pub fn median(runs: &[Output], key: &str) -> f64 {
    let values = values(runs, key);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

/// Returns the largest value of a counter; NaN if one is.
pub fn most(runs: &[Output], key: &str) -> f64 {
    values(runs, key).last().copied().unwrap_or(f64::NAN)
}
