// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's figure over numbers of vertices: hulls of spheres against a capsule, beside EPA.

use std::path::Path;

use super::poses::Poses;
use super::{ALGORITHM_4_5, EPA, Evaluation, INCREMENTAL, VERTICES};
use crate::charts::figure::{self, Panel, SUPPORTS, TIME};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;

pub fn measure(evaluation: &Evaluation, poses: &[Poses]) -> Vec<Row> {
    let list = [
        (ALGORITHM_4_5, Start::Guess5),
        (ALGORITHM_4_5, Start::Guess45),
        (EPA, Start::None),
        ("ccdPenetrationLocal", Start::Guess5),
        ("ccdPenetrationLocal", Start::Guess45),
        ("ccdPenetrationProven", Start::None),
        ("ccdMPRPenetration", Start::None),
        (INCREMENTAL, Start::Guess5),
    ];
    let rows = |poses: &Poses| evaluation.runner().rows(&poses.scene, evaluation.methods(&list));
    poses.iter().flat_map(rows).collect()
}

pub fn draw(path: &Path, rows: &[Row], notes: &[String]) {
    let panel = |title: &str, y| Panel { title: title.to_owned(), x: VERTICES, y, rows: rows.iter().collect() };
    let panels = vec![panel("time", TIME), panel("support points", SUPPORTS)];
    figure::grid(path, "Hull of a sphere against a capsule, guesses 5° and 45° off", 2, panels, notes)
        .expect("a picture");
}
