// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What Tables I to III are made of: spheres and capsules of 1 m, each method from guesses 5°, 25° and 45° off.

use super::poses::{self, Poses, Shape};
use super::{ALGORITHM_4_5, EPA, Evaluation, INCREMENTAL, NEW_PORTALS, find, number};
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::pages::markdown;

/// Pairs of the tables, in the paper's order.
pub const PAIRS: [(&str, [&Shape; 2]); 3] = [
    ("sph_sph", [&Shape::Sphere, &Shape::Sphere]),
    ("cap_cap", [&Shape::Capsule, &Shape::Capsule]),
    ("sph_cap", [&Shape::Sphere, &Shape::Capsule]),
];

pub const STARTS: [Start; 3] = [Start::Guess5, Start::Guess25, Start::Guess45];

/// Columns of the tables: those of the paper, then this library's calls.
pub const COLUMNS: [(&str, Start); 11] = [
    (ALGORITHM_4_5, Start::Guess5),
    (ALGORITHM_4_5, Start::Guess25),
    (ALGORITHM_4_5, Start::Guess45),
    (EPA, Start::None),
    (INCREMENTAL, Start::Guess5),
    ("ccdPenetrationLocal", Start::Guess5),
    ("ccdPenetrationLocal", Start::Guess25),
    ("ccdPenetrationLocal", Start::Guess45),
    ("ccdPenetrationProven", Start::None),
    ("ccdMPRPenetration", Start::None),
    ("ccdMPRPenetrationWarm", Start::Guess5),
];

pub fn poses(libraries: &Libraries, number: usize) -> Vec<Poses> {
    PAIRS.map(|(name, shapes)| poses::random(libraries, name, shapes, number)).into()
}

pub fn measure(evaluation: &Evaluation, poses: &[Poses]) -> Vec<Row> {
    let list = [&COLUMNS[..], &[(NEW_PORTALS, Start::Guess5)]].concat();
    let rows = |poses: &Poses| evaluation.runner().rows(&poses.scene, evaluation.methods(&list));
    poses.iter().flat_map(rows).collect()
}

/// A line of a table: what it has, and its number of a row.
pub type Line<'a> = (&'a str, fn(&Row) -> f64);

/// Returns a table with a line of the paper's numbers for each pair, and lines of what is measured here.
pub fn table(rows: &[Row], published: [[f64; 4]; 3], lines: &[Line]) -> String {
    let head = "pair||Algorithm 4/5, 5°|25°|45°|EPA|`ccdPenetrationIncremental`, 5°|`ccdPenetrationLocal`, 5°|25°|45°|`…Proven`|\
                `ccdMPRPenetration`|`…Warm`, 5°";
    let of = |((set, _), published): (&(&str, _), [f64; 4])| {
        let paper = published.map(|x| format!("*{}*", number(x)));
        let blank = vec![String::new(); COLUMNS.len() - paper.len()];
        let paper = [vec![crate::charts::kind(set), "*paper*".to_owned()], paper.into(), blank].concat();
        let measured = lines.iter().map(|(name, value)| {
            let cells = COLUMNS.map(|(method, start)| number(value(find(rows, set, method, start))));
            [vec![String::new(), (*name).to_owned()], cells.into()].concat()
        });
        [vec![paper], measured.collect()].concat()
    };
    markdown(head, PAIRS.iter().zip(published).flat_map(of))
}
