// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Speed against accuracy: every method at every tolerance on every kind of pair.

use super::figure::{self, Panel, Unit};
use super::{Bench, COUNTED, Page, SUPPORTS, TIME, TIMED};
use crate::measuring::measure::Row;
use crate::measuring::methods::{self, Ask, Method, Start};
use crate::measuring::recorded::{MOTIONS, RANDOM};
use crate::measuring::scene::Scene;
use crate::{peers, progress};

/// Tolerances asked for, metres (libccd's EPA takes them as squares).
fn tolerances(quick: bool) -> Vec<f64> {
    let step = if quick { 2 } else { 1 };
    (2..=12).step_by(step).map(|k| 10_f64.powi(-k)).collect()
}

fn roster<'a>(bench: &Bench<'a>, scene: &Scene) -> Vec<Method<'a>> {
    let libraries = bench.libraries;
    let mut all = Vec::new();
    let frames = scene.motion > 0;
    let (start, proof) = match frames {
        true => (Start::Warm, Start::Warm),
        false => (Start::Five, Start::None),
    };
    for t in tolerances(bench.quick) {
        let asked = [
            (Ask::SystemMpr, Start::None),
            (Ask::SystemEpa, Start::None),
            (Ask::Paper, start),
            (Ask::PaperBare, start),
            (Ask::Mpr, Start::None),
            (Ask::Local, start),
            (Ask::Minimum, proof),
        ];
        all.extend(asked.map(|(ask, start)| methods::of(libraries, ask, start, t)));
    }
    all.extend(bench.compiled.all(libraries));
    all.push(peers::parry(libraries));
    all
}

/// The four kinds of pairs, and the methods, of the picture in front.
const FRONT: [&str; 4] = ["box_box", "p642_p642", "cyl_box", "cap_cap"];
const IN_FRONT: [&str; 6] = ["libccd MPR", "libccd EPA", "Algorithm 4/5", "MPR", "local", "minimum"];

/// A panel a set, a curve a method: what it costs against its error.
fn picture(page: &Page, file: &str, title: &str, rows: &[&Row], sets: &[&str], columns: usize) {
    let (y, cost) = match file.ends_with("_supports.svg") {
        true => (SUPPORTS, COUNTED),
        false => (TIME, TIMED),
    };
    let panel = |set: &&str| {
        let of: Vec<&Row> = rows.iter().copied().filter(|r| r.set == *set).collect();
        // Below the last digit of a metre there is nothing to see.
        let curves = super::curves(of.iter().copied(), |r| Some(r.mean_error.max(1e-16)), cost);
        let x = ("mean |depth error|", Unit::Metres);
        let mut panel = Panel::new(&super::kind(set), x, y, curves);
        panel.limit = of.first().map(|r| r.truth_gap);
        panel
    };
    let panels: Vec<Panel> = sets.iter().map(panel).collect();
    let notes = ["left of the dashes the truth is not known".to_owned(), page.footer()];
    figure::grid(&page.file(file), title, columns, &panels, &notes);
}

pub fn measure(bench: &Bench) -> Vec<Row> {
    let sets = [&RANDOM[..], &MOTIONS].concat();
    let of = |set: &&str| {
        let scene = Scene::load(bench.libraries, set, bench.poses());
        super::rows(bench, &scene, roster(bench, &scene), None)
    };
    progress::over(&sets, "speed against accuracy").flat_map(of).collect()
}

pub fn draw(page: &Page, rows: &[Row]) {
    let all: Vec<&Row> = rows.iter().collect();
    let some = rows.iter().filter(|r| IN_FRONT.contains(&&*r.method));
    let (some, title) =
        (some.collect::<Vec<_>>(), "Time of a query over its error: left is more exact, down is faster");
    picture(page, "front.svg", title, &some, &FRONT, 2);
    for (sets, file, what) in [
        (&RANDOM[..], "accuracy", "independent poses, guesses 5° off"),
        (&MOTIONS[..], "frames", "motions of 0.1° and 0.1 mm a frame, warm"),
    ] {
        for (cost, title) in [("time", "Time"), ("supports", "Support points")] {
            let title = format!("{title} against error: {what}");
            picture(page, &format!("{file}_{cost}.svg"), &title, &all, sets, 3);
        }
    }
}
