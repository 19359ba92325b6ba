// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! This library's local search beside the published method, behind the same C interface, at equal errors: both at every
//! tolerance from guesses 5° and 45° off, and their costs where the curves of cost over error reach the same error.

use std::path::Path;

use super::accuracy::ERROR;
use super::figure::{self, Panel, TIME};
use super::times;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::{Method, Start, select};
use crate::measuring::scene::Scene;
use crate::pages::markdown;
use crate::paper::{ALGORITHM_4_5, published};

const LOCAL: &str = "ccdPenetrationLocal";
const STARTS: [Start; 2] = [Start::Guess5, Start::Guess45];
/// Mean errors of the depth at which costs are compared, metres.
const ERRORS: [f64; 2] = [1e-6, 1e-9];

/// An error of more tolerances than these (and 1 nm, for the error of the truth) is that of another minimum. 100 leave out four
/// poses more, and give the same ratios.
const MAX_TOLERANCES: f64 = 1000.0;

/// Returns both methods at a tolerance.
fn methods(libraries: &Libraries, start: Start, tolerance: f64) -> [Method<'_>; 2] {
    let [local] = select(libraries, &[(LOCAL, start, tolerance)]).try_into().ok().expect("one method");
    [local, published::method(libraries, ALGORITHM_4_5, start, tolerance)]
}

pub fn measure(libraries: &Libraries, is_quick: bool) -> Vec<Row> {
    let (num_poses, repetitions, step) = if is_quick { (100, 3, 3) } else { (usize::MAX, 15, 1) };
    let rows = |(scene, start): (&Scene, Start)| {
        eprintln!("local searches at equal errors: {}", scene.name);
        let mut scene = scene.clone();
        let mut methods: Vec<_> =
            (3..=12).step_by(step).flat_map(|k| methods(libraries, start, 10_f64.powi(-k))).collect();
        for method in &mut methods {
            let most = MAX_TOLERANCES * method.tolerance.unwrap_or_default() + ERRORS[1];
            scene.pairs.retain(|pair| {
                (method.query)(pair).is_some_and(|answer| (answer.depth - pair.truth.depth).abs() <= most)
            });
        }
        times::runner(libraries, repetitions).rows(&scene, methods)
    };
    let scenes = super::scenes(libraries, num_poses);
    scenes.iter().flat_map(|scene| STARTS.map(|start| (scene, start))).flat_map(rows).collect()
}

/// Returns time and support points at which a method reaches an error: at the first tolerance that does, or between it and
/// the one before, on straight lines between the logarithms. None if no tolerance does.
fn cost_at(rows: &[Row], set: &str, method: &str, start: Start, error: f64) -> Option<[f64; 2]> {
    let is_wanted = |row: &&Row| (&*row.set, &*row.method, row.start) == (set, method, start);
    let curve: Vec<_> = rows.iter().filter(is_wanted).collect();
    let at = curve.iter().position(|row| row.mean_error <= error)?;
    let (coarse, exact) = (curve[at.saturating_sub(1)], curve[at]);
    let log_error = |row: &Row| row.mean_error.max(ERRORS[1]).ln();
    let length = log_error(coarse) - log_error(exact);
    let share = if length > 0.0 { (log_error(coarse) - error.ln()) / length } else { 1.0 };
    let between = |coarse: f64, exact: f64| (coarse.ln() + share * (exact.ln() - coarse.ln())).exp();
    Some([between(coarse.ns?, exact.ns?), between(coarse.supports, exact.supports)])
}

/// Returns the time of the local search over that of the published method, and the support points of both.
pub fn table(rows: &[Row]) -> String {
    let cell = |set: &str, start, error| {
        let cost = |method| cost_at(rows, set, method, start, error);
        cost(LOCAL).zip(cost(ALGORITHM_4_5)).map_or("-".to_owned(), |(ours, theirs)| {
            format!("{:.2} ({:.1} / {:.1})", ours[0] / theirs[0], ours[1], theirs[1])
        })
    };
    let poses = |set: &str, start| {
        let row = rows.iter().find(|row| (&*row.set, row.start) == (set, start));
        row.map_or("-".to_owned(), |row| row.queries.to_string())
    };
    let lines = super::sets().into_iter().map(|set| {
        let cells = STARTS.map(|start| [poses(set, start), cell(set, start, ERRORS[0]), cell(set, start, ERRORS[1])]);
        [vec![super::kind(set)], cells.concat()].concat()
    });
    markdown("pair|from 5°: poses|at 1 µm|at 1 nm|from 45°: poses|at 1 µm|at 1 nm", lines)
}

/// Draws time over error of both, a panel for each pair.
pub fn draw(path: &Path, machine: &str, rows: &[Row]) {
    let panel = |set: &str| {
        let rows = rows.iter().filter(|row| row.set == set).collect();
        Panel { title: super::kind(set), x: ERROR, y: TIME, rows }
    };
    let notes = [
        "left is more exact, down is cheaper; at the left end 1 nm or less; dotted: guesses 45° off".to_owned(),
        super::short(machine),
    ];
    let title = "The local search and the published method: guesses 5° and 45° off";
    figure::grid(path, title, 2, super::sets().into_iter().map(panel).collect(), &notes).expect("a picture");
}

/// Measures, and prints the table alone.
pub fn run() {
    let libraries = Libraries::open();
    println!("{}\n{}", libraries.machine, table(&measure(&libraries, false)));
}
