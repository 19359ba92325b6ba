// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Speed against accuracy: every method at every tolerance on every kind of pair.

use std::path::Path;

use super::figure::{self, Axis, Panel, SUPPORTS, TIME, Unit};
use super::peers::Peers;
use super::times;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::{MOTIONS, RANDOM};
use crate::measuring::scene::Scene;
use crate::paper::{ALGORITHM_4_5, published};

pub fn measure(libraries: &Libraries, peers: &Peers, is_quick: bool) -> Vec<Row> {
    let (num_poses, repetitions, step) = if is_quick { (100, 3, 2) } else { (usize::MAX, 9, 1) };
    let rows = |set: &&str| {
        eprintln!("speed against accuracy: {set}");
        let scene = Scene::load(libraries, set, num_poses);
        let is_motion = scene.is_motion();
        let (local, proven) = if is_motion { (Start::Warm, Start::Warm) } else { (Start::Guess5, Start::None) };
        let (mut list, mut algorithm_4_5) = (Vec::new(), Vec::new());
        // Metres; libccd's EPA compares squares with it.
        for t in (2..=12).step_by(step).map(|k| 10_f64.powi(-k)) {
            algorithm_4_5.push(published::method(libraries, ALGORITHM_4_5, local, t));
            list.extend([
                ("libccd ccdMPRPenetration", Start::None, t),
                ("libccd ccdGJKPenetration", Start::None, t),
                ("ccdMPRPenetration", Start::None, t),
                ("ccdPenetrationLocal", local, t),
                ("ccdPenetrationProven", proven, t),
            ]);
        }
        let mut methods = select(libraries, &list);
        methods.extend(algorithm_4_5);
        methods.extend(peers.methods(libraries));
        times::runner(libraries, repetitions).rows(&scene, methods)
    };
    [&RANDOM[..], &MOTIONS].concat().iter().flat_map(rows).collect()
}

/// The last digit of a metre is the finest error.
const ERROR: Axis =
    Axis { title: "mean error of the depth", unit: Unit::Prefixed("m"), value: |row| Some(row.mean_error.max(1e-16)) };
const DIRECTION: Axis = Axis {
    title: "error of the direction, 99 %",
    unit: Unit::Prefixed("rad"),
    value: |row| row.direction_p99.map(|mrad| (1e-3 * mrad).max(1e-16)),
};
const JITTER: Axis = Axis {
    title: "jitter a frame, root of the mean square",
    unit: Unit::Prefixed("rad"),
    value: |row| row.jitter.map(|mrad| (1e-3 * mrad).max(1e-16)),
};

/// The lines of the pictures; the file has the others too.
const SHOWN: [&str; 8] = [
    "libccd ccdMPRPenetration",
    "libccd ccdGJKPenetration",
    ALGORITHM_4_5,
    "ccdMPRPenetration",
    "ccdPenetrationLocal",
    "ccdPenetrationProven",
    "Bullet EPA",
    "FCL EPA",
];

/// Draws time and support points over errors: for each set a panel of depths and one of directions, of motions one of jitter.
pub fn draw(out: &Path, machine: &str, rows: &[Row]) {
    let notes = [
        "left is more exact, down is cheaper; left of the dots the truth is not known".to_owned(),
        format!("thick: this library; {}", super::short(machine)),
    ];
    for (sets, file, beside, what) in [
        (&RANDOM[..], "accuracy", DIRECTION, "independent poses, guesses 5° off"),
        (&MOTIONS, "frames", JITTER, "motions of 0.1° and 0.1 mm a frame"),
    ] {
        for (cost, name, y) in [("Time", "time", TIME), ("Support points", "supports", SUPPORTS)] {
            let panels = |set: &&str| {
                let rows: Vec<&Row> =
                    rows.iter().filter(|row| row.set == *set && SHOWN.contains(&&*row.method)).collect();
                let limit = rows.first().map(|row| row.truth_gap);
                let depths = Panel { title: super::kind(set), x: ERROR, y, rows: rows.clone(), limit };
                [depths, Panel { title: super::kind(set), x: beside, y, rows, limit: None }]
            };
            let path = out.join(format!("{file}_{name}.svg"));
            let title = format!("{cost} against errors: {what}");
            figure::grid(&path, &title, 2, sets.iter().flat_map(panels).collect(), &notes).expect("a picture");
        }
    }
}
