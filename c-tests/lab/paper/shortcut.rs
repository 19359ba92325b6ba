// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's figure of the shortcut: Algorithm 4/5 beside Algorithm 3, which is the same without it, on hulls of spheres
//! against a capsule, guesses 45° off.

use std::path::Path;

use super::poses::Poses;
use super::{ALGORITHM_3, ALGORITHM_4_5, Evaluation, INCREMENTAL, VERTICES};
use crate::charts::figure::{self, Panel, SUPPORTS, TIME};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;

pub fn measure(evaluation: &Evaluation, poses: &[Poses]) -> Vec<Row> {
    let list = [
        (ALGORITHM_4_5, Start::Guess45),
        (ALGORITHM_3, Start::Guess45),
        (INCREMENTAL, Start::Guess45),
        ("ccdPenetrationLocal", Start::Guess45),
    ];
    let rows = |poses: &Poses| evaluation.runner().rows(&poses.scene, evaluation.methods(&list));
    poses.iter().flat_map(rows).collect()
}

pub fn draw(path: &Path, rows: &[Row], notes: &[String]) {
    let panel = |title: &str, y| Panel { title: title.to_owned(), x: VERTICES, y, rows: rows.iter().collect() };
    let panels = vec![panel("(a) support points", SUPPORTS), panel("(b) time", TIME)];
    figure::grid(path, "With the shortcut (Algorithm 4/5) and without (Algorithm 3)", 2, panels, notes)
        .expect("a picture");
}
