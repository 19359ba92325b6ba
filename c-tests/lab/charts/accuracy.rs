// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Speed against accuracy: every method at every tolerance on every kind of pair.

use super::figure::{self, Axis, Panel, SUPPORTS, TIME};
use super::{Bench, Page};
use crate::measuring::measure::Row;
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::{MOTIONS, RANDOM};
use crate::measuring::scene::Scene;

pub fn measure(bench: &Bench) -> Vec<Row> {
    let rows = |set: &&str| {
        let scene = Scene::load(bench.libraries, set, bench.poses());
        let is_motion = scene.is_motion();
        let (local, proven) = if is_motion { (Start::Warm, Start::Warm) } else { (Start::Guess5, Start::None) };
        let mut list = Vec::new();
        // Metres; libccd's EPA compares squares with it.
        for t in (2..=12).step_by(if bench.quick { 2 } else { 1 }).map(|k| 10_f64.powi(-k)) {
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
        let mut methods = select(bench.libraries, &list);
        methods.extend(bench.peers.methods(bench.libraries));
        bench.timed().rows(&scene, methods)
    };
    super::progress(&[&RANDOM[..], &MOTIONS].concat(), "speed against accuracy").flat_map(rows).collect()
}

/// The last digit of a metre is the finest error.
const ERROR: Axis = ("mean |depth error|, m", |row| Some(row.mean_error.max(1e-16)));

/// The four kinds of pairs, and the methods, of the front page's picture.
const FRONT: [&str; 4] = ["box_box", "p642_p642", "cyl_box", "cap_cap"];
const ON_THE_FRONT: [&str; 6] = [
    "libccd ccdMPRPenetration",
    "libccd ccdGJKPenetration",
    "Gao 2023, Algorithm 4/5",
    "ccdMPRPenetration",
    "ccdPenetrationLocal",
    "ccdPenetrationProven",
];

/// Draws a panel for each set and a curve for each method: its cost against its error.
fn picture<'a>(
    page: &Page,
    file: &str,
    title: &str,
    rows: impl Iterator<Item = &'a Row> + Clone,
    sets: &[&str],
    cost: Axis,
) {
    let panel = |set: &&str| {
        let rows: Vec<&Row> = rows.clone().filter(|r| r.set == *set).collect();
        let limit = rows.first().map(|r| r.truth_gap);
        Panel { title: super::kind(set), x: ERROR, y: cost, rows, limit }
    };
    let columns = if sets.len() == 4 { 2 } else { 3 };
    let notes = ["left of the dashes the truth is not known".to_owned(), page.footer()];
    figure::grid(&page.out.join(file), title, columns, sets.iter().map(panel).collect(), &notes).expect("a picture");
}

pub fn draw(page: &Page, rows: &[Row]) {
    let on_the_front = rows.iter().filter(|r| ON_THE_FRONT.contains(&&*r.method));
    let title = "Time of a query over its error: left is more exact, down is faster";
    picture(page, "front.svg", title, on_the_front, &FRONT, TIME);
    for (sets, file, what) in [
        (&RANDOM[..], "accuracy", "independent poses, guesses 5° off"),
        (&MOTIONS, "frames", "motions of 0.1° and 0.1 mm a frame, warm"),
    ] {
        let title = |cost| format!("{cost} against error: {what}");
        picture(page, &format!("{file}_time.svg"), &title("Time"), rows.iter(), sets, TIME);
        picture(page, &format!("{file}_supports.svg"), &title("Support points"), rows.iter(), sets, SUPPORTS);
    }
}
