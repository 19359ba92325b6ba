// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's figure beside DEEP: two hulls of spheres, guesses 5° off.

use std::path::Path;

use super::deep::{self, Polytope};
use super::poses::{Mesh, Poses};
use super::{ALGORITHM_4_5, Evaluation, HALVINGS, INCREMENTAL, VERTICES};
use crate::charts::figure::{self, Axis, Panel, TIME, Unit};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;

pub fn measure(evaluation: &Evaluation, poses: &[Poses]) -> Vec<Row> {
    let list = [
        (ALGORITHM_4_5, Start::Guess5),
        (INCREMENTAL, Start::Guess5),
        ("ccdPenetrationLocal", Start::Guess5),
        ("ccdPenetrationProven", Start::None),
        ("ccdMPRPenetration", Start::None),
    ];
    let rows = |(poses, halvings): (&Poses, usize)| {
        let hull = Polytope::new(&Mesh::icosphere(halvings));
        let mut methods = vec![deep::method(poses, [&hull, &hull], Start::Guess5)];
        methods.extend(evaluation.methods(&list));
        evaluation.runner().rows(&poses.scene, methods)
    };
    poses.iter().zip(HALVINGS).flat_map(rows).collect()
}

pub fn draw(path: &Path, rows: &[Row], notes: &[String]) {
    const BEYOND: Axis = Axis {
        title: "answers more than 1 mm too deep, %",
        unit: Unit::Plain,
        value: |row| (row.nonminimal > 0.0).then_some(row.nonminimal),
        least: 0.0,
    };
    let panel = |title: &str, y| Panel { title: title.to_owned(), x: VERTICES, y, rows: rows.iter().collect() };
    let panels = vec![panel("time", TIME), panel("other local minima", BEYOND)];
    figure::grid(path, "Two hulls of spheres, guesses 5° off", 2, panels, notes).expect("a picture");
}
