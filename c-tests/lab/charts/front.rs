// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The front page's picture: every solver on the recorded contacts, as one point of wrong answers and time.

use std::path::Path;

use super::figure::{self, Axis, NONE, Panel, TIME, Unit};
use crate::measuring::measure::Row;

pub fn draw(path: &Path, machine: &str, rows: &[Row]) {
    const WRONG: Axis = Axis { title: "wrong answers", unit: Unit::Share, value: |row| Some(row.wrong), least: NONE };
    let panel = Panel { title: String::new(), x: WRONG, y: TIME, rows: rows.iter().collect() };
    let notes = [
        "left: fewer wrong answers, down: cheaper; wrong: missed, or depth or direction off by more than 1 % + 2 µm"
            .to_owned(),
        super::short(machine),
    ];
    let title = "23,004 overlapping pairs recorded in a simulation: time against wrong answers";
    figure::grid(path, title, 1, vec![panel], &notes).expect("a picture");
}
