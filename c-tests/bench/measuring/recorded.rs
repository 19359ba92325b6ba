// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The pair sets in groups, and the support counts and errors over them that a later
//! change may not lose.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::csv;
use super::libraries::Libraries;
use super::measure::{self, Row};
use super::methods::{self, Ask, Method, Start};
use super::scene::Scene;
use crate::harness;

/// The sets over which averages are taken: independent poses of every depth.
pub const RANDOM: [&str; 11] = [
    "box_box",
    "p12_p12",
    "p162_p162",
    "p642_p642",
    "cyl_box",
    "cone_cyl",
    "p162_cap",
    "cap_cap",
    "sph_cap",
    "ell_ell",
    "sph_sph",
];
/// Shallow contacts.
pub const SHALLOW: [&str; 6] = ["sph_cap_sh", "cap_cap_sh", "box_box_sh", "p162_p162_sh", "cyl_box_sh", "ell_ell_sh"];
/// The motions whose frames are near each other: 0.1° and 0.1 mm a step.
pub const MOTIONS: [&str; 6] =
    ["box_box_trajS", "p162_p162_trajS", "cyl_box_trajS", "p642_cap_trajS", "cap_cap_trajS", "ell_ell_trajS"];

/// Cost and error of one method on one set, which no later change may exceed.
#[derive(Debug, Serialize, Deserialize)]
pub struct Recorded {
    pub set: String,
    pub method: String,
    pub start: String,
    pub tolerance: f64,
    pub supports: f64,
    pub mean_error_1mm: f64,
    pub nonminimal: f64,
}

pub fn file() -> PathBuf {
    harness::root().join("c-tests/bench/measuring/support_counts.csv")
}

/// Every method of ours over the random and the shallow sets and the small motions.
pub fn measure(libraries: &Libraries) -> Vec<Row> {
    let sets = RANDOM.iter().chain(&SHALLOW).chain(&MOTIONS);
    let of = |set: &&str| {
        let scene = Scene::load(libraries, set, usize::MAX);
        let mut methods = ours(libraries, &scene);
        let rows = methods.iter_mut().map(|m| measure::judge(libraries, &scene, m));
        rows.collect::<Vec<Row>>()
    };
    sets.flat_map(of).collect()
}

/// Writes what is recorded anew, from what is measured now.
pub fn record() {
    let libraries = Libraries::open();
    let rows: Vec<Recorded> = measure(&libraries)
        .into_iter()
        .map(|row| Recorded {
            set: row.set,
            method: row.method,
            start: row.start,
            tolerance: row.tolerance.unwrap_or_default(),
            supports: row.supports,
            mean_error_1mm: row.mean_error_1mm,
            nonminimal: row.nonminimal,
        })
        .collect();
    csv::write(&file(), &libraries.machine(), &rows);
}

/// This library's queries on a scene, from every start it has.
pub fn ours<'a>(libraries: &'a Libraries, scene: &Scene) -> Vec<Method<'a>> {
    let of = |(ask, start, tolerance)| methods::of(libraries, ask, start, tolerance);
    let all = [(Ask::Mpr, Start::None, 1e-6)].into_iter();
    if scene.motion > 0 {
        let others = [
            (Ask::Local, Start::Centres, 1e-6),
            (Ask::Local, Start::Warm, 1e-6),
            (Ask::Local, Start::Warm, 1e-10),
            (Ask::MprWarm, Start::Warm, 1e-6),
            (Ask::Minimum, Start::Warm, 1e-6),
            (Ask::Minimum, Start::None, 1e-6),
        ];
        return all.chain(others).map(of).collect();
    }
    let guesses = Start::GUESSES.map(|start| (Ask::Local, start, 1e-6));
    let others = [
        (Ask::Local, Start::Centres, 1e-6),
        (Ask::Local, Start::Five, 1e-10),
        (Ask::Minimum, Start::None, 1e-6),
        (Ask::Minimum, Start::None, 1e-10),
    ];
    all.chain(guesses).chain(others).map(of).collect()
}
