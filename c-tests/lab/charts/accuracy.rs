// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Speed against accuracy: every method at every tolerance on every kind of pair.

use std::path::Path;

use super::figure::{self, Axis, Panel, SUPPORTS, TIME};
use super::peers::Peers;
use super::times;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::{MOTIONS, RANDOM};
use crate::measuring::scene::Scene;

pub fn measure(libraries: &Libraries, peers: &Peers, is_quick: bool) -> Vec<Row> {
    let (num_poses, repetitions, step) = if is_quick { (100, 3, 2) } else { (usize::MAX, 9, 1) };
    let rows = |set: &&str| {
        eprintln!("speed against accuracy: {set}");
        let scene = Scene::load(libraries, set, num_poses);
        let is_motion = scene.is_motion();
        let (local, proven) = if is_motion { (Start::Warm, Start::Warm) } else { (Start::Guess5, Start::None) };
        let mut list = Vec::new();
        // Metres; libccd's EPA compares squares with it.
        for t in (2..=12).step_by(step).map(|k| 10_f64.powi(-k)) {
            list.extend([
                ("libccd ccdMPRPenetration", Start::None, t),
                ("libccd ccdGJKPenetration", Start::None, t),
                ("Gao 2023, Algorithm 4/5", local, t),
                ("Gao 2023, Algorithm 3", local, t),
                ("ccdMPRPenetration", Start::None, t),
                ("ccdPenetrationLocal", local, t),
                ("ccdPenetrationProven", proven, t),
            ]);
        }
        let mut methods = select(libraries, &list);
        methods.extend(peers.methods(libraries));
        times::runner(libraries, repetitions).rows(&scene, methods)
    };
    [&RANDOM[..], &MOTIONS].concat().iter().flat_map(rows).collect()
}

/// The last digit of a metre is the finest error.
const ERROR: Axis = ("mean |depth error|, m", |row| Some(row.mean_error.max(1e-16)));

/// Draws time and support points over the error: a panel for each set and a curve for each method.
pub fn draw(out: &Path, machine: &str, rows: &[Row]) {
    let (place, rest) = machine.split_once("; ").unwrap_or((machine, ""));
    let version = rest.split(" (").next().unwrap_or("");
    let notes = [
        "left of the dashes the truth is not known".to_owned(),
        format!("thick: this library; {place}; {version}; all in one process, rustc and gcc -O3"),
    ];
    for (sets, file, what) in [
        (&RANDOM[..], "accuracy", "independent poses, guesses 5° off"),
        (&MOTIONS, "frames", "motions of 0.1° and 0.1 mm a frame, warm"),
    ] {
        for (cost, name, y) in [("Time", "time", TIME), ("Support points", "supports", SUPPORTS)] {
            let panel = |set: &&str| {
                let rows: Vec<&Row> = rows.iter().filter(|row| row.set == *set).collect();
                let limit = rows.first().map(|row| row.truth_gap);
                Panel { title: super::kind(set), x: ERROR, y, rows, limit }
            };
            let path = out.join(format!("{file}_{name}.svg"));
            let title = format!("{cost} against error: {what}");
            figure::grid(&path, &title, sets.iter().map(panel).collect(), &notes).expect("a picture");
        }
    }
}
