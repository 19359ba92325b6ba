// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Measures what a state saves: the motions of the pair sets, by growing steps a frame.

use super::Bench;
use crate::measuring::measure::{self, Row};
use crate::measuring::methods::{self, Ask, Start};
use crate::measuring::recorded::MOTIONS;
use crate::measuring::scene::Scene;
use crate::progress;

/// The motions' names, and how many degrees they turn a frame.
const STEPS: [(&str, f64); 3] = [("trajS", 0.1), ("trajM", 0.5), ("trajL", 2.0)];

/// Support points alone, which repeat exactly: the times of the smallest steps are charted with
/// those of independent poses.
pub fn measure(bench: &Bench) -> Vec<Row> {
    let mut all = Vec::new();
    for small in progress::over(&MOTIONS, "coherence") {
        let pair = small.strip_suffix("_trajS").expect("a motion");
        for (name, degrees) in STEPS {
            let scene = Scene::load(bench.libraries, &format!("{pair}_{name}"), bench.poses());
            all.extend(roster(bench).iter_mut().map(|method| Row {
                set: pair.to_owned(),
                x: Some(degrees),
                ..measure::judge(bench.libraries, &scene, method)
            }));
        }
    }
    all
}

fn roster<'a>(bench: &Bench<'a>) -> Vec<methods::Method<'a>> {
    let asked = [
        (Ask::SystemMpr, Start::None),
        (Ask::SystemEpa, Start::None),
        (Ask::Paper, Start::Warm),
        (Ask::Mpr, Start::None),
        (Ask::MprWarm, Start::Warm),
        (Ask::Local, Start::Centres),
        (Ask::Local, Start::Warm),
        (Ask::Minimum, Start::None),
        (Ask::Minimum, Start::Warm),
    ];
    let of = |(ask, start)| methods::of(bench.libraries, ask, start, 1e-6);
    asked.map(of).into()
}
