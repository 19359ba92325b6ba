// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Measures what a state saves: the motions of the pair sets, by growing steps a frame.

use super::Bench;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::MOTIONS;
use crate::measuring::scene::Scene;

/// The motions' names, and how many degrees they turn a frame.
const STEPS: [(&str, f64); 3] = [("trajS", 0.1), ("trajM", 0.5), ("trajL", 2.0)];

const METHODS: [(&str, Start, f64); 9] = [
    ("libccd ccdMPRPenetration", Start::None, 1e-6),
    ("libccd ccdGJKPenetration", Start::None, 1e-6),
    ("Gao 2023, Algorithm 4/5", Start::Warm, 1e-6),
    ("ccdMPRPenetration", Start::None, 1e-6),
    ("ccdMPRPenetrationWarm", Start::Warm, 1e-6),
    ("ccdPenetrationLocal", Start::Cold, 1e-6),
    ("ccdPenetrationLocal", Start::Warm, 1e-6),
    ("ccdPenetrationProven", Start::None, 1e-6),
    ("ccdPenetrationProven", Start::Warm, 1e-6),
];

/// Measures support points, which repeat exactly; the times of the smallest steps are charted with those of independent
/// poses.
pub fn measure(bench: &Bench) -> Vec<Row> {
    let mut all = Vec::new();
    for small in super::progress(&MOTIONS, "coherence") {
        let pair = small.strip_suffix("_trajS").expect("a motion");
        for (name, degrees) in STEPS {
            let scene = Scene::load(bench.libraries, &format!("{pair}_{name}"), bench.poses());
            let rows = Runner::new(bench.libraries).rows(&scene, select(bench.libraries, &METHODS));
            all.extend(rows.into_iter().map(|row| Row { set: pair.to_owned(), x: Some(degrees), ..row }));
        }
    }
    all
}
