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
use crate::measuring::recorded::MOTIONS;
use crate::measuring::scene::Scene;
use crate::paper::{ALGORITHM_4_5, published};

pub fn measure(libraries: &Libraries, peers: &Peers, is_quick: bool) -> Vec<Row> {
    let (num_poses, repetitions, step) = if is_quick { (100, 3, 2) } else { (usize::MAX, 9, 1) };
    let rows = |scene: Scene| {
        eprintln!("speed against accuracy: {}", scene.name);
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
    let motions = MOTIONS.map(|set| Scene::load(libraries, set, num_poses));
    super::scenes(libraries, num_poses).into_iter().chain(motions).flat_map(rows).collect()
}

/// A nanometre and a microradian are exact for every use; the truth is known to 0.2 nm.
pub const ERROR: Axis = Axis {
    title: "mean error of the depth",
    unit: Unit::Prefixed("m"),
    value: |row| Some(row.mean_error),
    least: 1e-9,
};
const DIRECTION: Axis = Axis {
    title: "error of the direction, 99 %",
    unit: Unit::Prefixed("rad"),
    value: |row| row.direction_p99.map(|mrad| 1e-3 * mrad),
    least: 1e-6,
};
const JITTER: Axis = Axis {
    title: "jitter a frame, root of the mean square",
    unit: Unit::Prefixed("rad"),
    value: |row| row.jitter.map(|mrad| 1e-3 * mrad),
    least: 1e-6,
};

/// The pairs of the page's picture; the other pictures have all.
const MAIN: [&str; 4] = ["box_box", "p162_p162", "cyl_box", "ell_ell"];

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

/// Draws time over the error of the depth for the page, four pairs; and apart from it time and support points for all pairs:
/// a panel of depths and one of directions, of motions one of jitter.
pub fn draw(out: &Path, machine: &str, rows: &[Row]) {
    let notes = [
        "left is more exact, down is cheaper; at the left end 1 nm, 1 µrad or less".to_owned(),
        format!("thick, blue: this library; {}", super::short(machine)),
    ];
    let panel = |set: &str, x: Axis, y: Axis| {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.set == set && SHOWN.contains(&&*row.method)).collect();
        Panel { title: super::kind(set), x, y, rows }
    };
    let grid = |file: &str, title: &str, panels: Vec<Panel>| {
        figure::grid(&out.join(file), title, 2, panels, &notes).expect("a picture");
    };
    let main = MAIN.map(|set| panel(set, ERROR, TIME)).into();
    grid("accuracy.svg", "Time against the error of the depth: independent poses, guesses 5° off", main);
    for (sets, file, beside, what) in [
        (&super::sets()[..], "accuracy", DIRECTION, "independent poses, guesses 5° off"),
        (&MOTIONS, "frames", JITTER, "motions of 0.1° and 0.1 mm a frame"),
    ] {
        for (cost, name, y) in [("Time", "time", TIME), ("Support points", "supports", SUPPORTS)] {
            let panels = sets.iter().flat_map(|set| [panel(set, ERROR, y), panel(set, beside, y)]).collect();
            grid(&format!("{file}_{name}.svg"), &format!("{cost} against errors: {what}"), panels);
        }
    }
}
