// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The pair sets in groups, and the recorded support counts and errors over them, which no change may exceed.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::libraries::Libraries;
use super::measure::{Row, Runner};
use super::methods::{Start, select};
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
const SHALLOW: [&str; 6] = ["sph_cap_sh", "cap_cap_sh", "box_box_sh", "p162_p162_sh", "cyl_box_sh", "ell_ell_sh"];
/// Motions of 0.1° and 0.1 mm a step.
pub const MOTIONS: [&str; 6] =
    ["box_box_trajS", "p162_p162_trajS", "cyl_box_trajS", "p642_cap_trajS", "cap_cap_trajS", "ell_ell_trajS"];

/// This library's calls on independent poses, from every start.
const ON_POSES: [(&str, Start, f64); 8] = [
    ("ccdMPRPenetration", Start::None, 1e-6),
    ("ccdPenetrationLocal", Start::Guess5, 1e-6),
    ("ccdPenetrationLocal", Start::Guess25, 1e-6),
    ("ccdPenetrationLocal", Start::Guess45, 1e-6),
    ("ccdPenetrationLocal", Start::Cold, 1e-6),
    ("ccdPenetrationLocal", Start::Guess5, 1e-10),
    ("ccdPenetrationProven", Start::None, 1e-6),
    ("ccdPenetrationProven", Start::None, 1e-10),
];
/// The same on motions.
const ON_MOTIONS: [(&str, Start, f64); 7] = [
    ("ccdMPRPenetration", Start::None, 1e-6),
    ("ccdPenetrationLocal", Start::Cold, 1e-6),
    ("ccdPenetrationLocal", Start::Warm, 1e-6),
    ("ccdPenetrationLocal", Start::Warm, 1e-10),
    ("ccdMPRPenetrationWarm", Start::Warm, 1e-6),
    ("ccdPenetrationProven", Start::Warm, 1e-6),
    ("ccdPenetrationProven", Start::None, 1e-6),
];

/// The columns of a row that are recorded.
#[derive(Debug, Serialize, Deserialize)]
pub struct Recorded {
    pub set: String,
    pub method: String,
    pub start: Start,
    pub tolerance: f64,
    pub supports: f64,
    pub mean_error_1mm: f64,
    pub nonminimal: f64,
}

impl From<Row> for Recorded {
    fn from(row: Row) -> Self {
        let Row { set, method, start, supports, mean_error_1mm, nonminimal, .. } = row;
        Self { set, method, start, tolerance: row.tolerance.unwrap_or_default(), supports, mean_error_1mm, nonminimal }
    }
}

pub fn file() -> PathBuf {
    harness::root().join("c-tests/bench/measuring/support_counts.csv")
}

/// Measures every set.
pub fn measure(libraries: &Libraries) -> Vec<Row> {
    let rows = |set: &&str| {
        let scene = Scene::load(libraries, set, usize::MAX);
        let list = if scene.is_motion() { &ON_MOTIONS[..] } else { &ON_POSES };
        Runner::new(libraries).rows(&scene, select(libraries, list))
    };
    [&RANDOM[..], &SHALLOW, &MOTIONS].concat().iter().flat_map(rows).collect()
}
