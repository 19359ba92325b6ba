// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Counts the instructions of a query in the callbacks and in the solver, beside libccd's.

use clap::Args;

use super::{Bench, results};
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::{Start, select};
use crate::measuring::scene::Scene;

/// The sets of the page: a cheap support function and an expensive one, and their motions.
const ON_THE_PAGE: [&str; 4] = ["box_box", "p642_p642", "box_box_trajS", "p642_cap_trajS"];

/// Poses of a pair set.
const POSES: usize = 100;

/// The calls on independent poses; the first five are on the page.
const ON_POSES: [(&str, Start, f64); 8] = [
    ("libccd ccdMPRPenetration", Start::None, 1e-6),
    ("libccd ccdGJKPenetration", Start::None, 1e-6),
    ("ccdMPRPenetration", Start::None, 1e-6),
    ("ccdPenetrationLocal", Start::Guess5, 1e-6),
    ("ccdPenetrationProven", Start::None, 1e-6),
    ("libccd ccdMPRIntersect", Start::None, 1e-6),
    ("ccdGJKPenetration", Start::None, 1e-6),
    ("ccdMPRIntersect", Start::None, 1e-6),
];
/// The calls on motions; the first two are on the page.
const ON_MOTIONS: [(&str, Start, f64); 4] = [
    ("ccdPenetrationLocal", Start::Warm, 1e-6),
    ("ccdPenetrationProven", Start::Warm, 1e-6),
    ("ccdMPRPenetrationWarm", Start::Warm, 1e-6),
    ("ccdMPRIntersectWarm", Start::Warm, 1e-6),
];

#[derive(Args)]
pub struct Options {
    /// Every call over a pair set of c-tests/bench/pairs, in place of the page's.
    #[arg(long)]
    set: Option<String>,
}

/// Returns the rows with their counts; none without valgrind, and in the process under it.
fn counted(libraries: &Libraries, options: &Options, is_counting: bool) -> Vec<Row> {
    let mut command = vec!["instructions"];
    command.extend(options.set.iter().flat_map(|set| ["--set", set]));
    let mut runner = Runner::new(libraries, 0).with_instructions(1, &command, is_counting);
    let rows = |set: &str| {
        let scene = Scene::load(libraries, set, POSES);
        let (list, num_on_the_page) = if scene.is_motion() { (&ON_MOTIONS[..], 2) } else { (&ON_POSES[..], 5) };
        let shown = if options.set.is_some() { list } else { &list[..num_on_the_page] };
        runner.rows(&scene, select(libraries, shown))
    };
    let sets = options.set.as_deref().map_or(ON_THE_PAGE.to_vec(), |set| vec![set]);
    sets.into_iter().flat_map(rows).filter(|row| row.solver.is_some()).collect()
}

pub fn run(options: &Options, is_counting: bool) {
    let libraries = Libraries::open();
    let rows = counted(&libraries, options, is_counting);
    println!("{}\n\n{}", libraries.machine, results::instructions(&rows));
}

pub fn measure(bench: &Bench) -> Vec<Row> {
    counted(bench.libraries, &Options { set: None }, false)
}
