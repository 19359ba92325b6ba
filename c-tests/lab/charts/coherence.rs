// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a state saves and how steady directions are: the motions of the pair sets, by growing steps a frame.

use super::times;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::MOTIONS;
use crate::measuring::scene::Scene;
use crate::paper::{ALGORITHM_4_5, published};

/// Ends of the sets' names, and how many degrees the bodies turn a frame.
const STEPS: [(&str, f64); 3] = [("trajS", 0.1), ("trajM", 0.5), ("trajL", 2.0)];

/// Each method cold, and warm where it can be.
pub const METHODS: [(&str, Start); 10] = [
    ("libccd ccdMPRPenetration", Start::None),
    ("libccd ccdGJKPenetration", Start::None),
    (ALGORITHM_4_5, Start::Cold),
    (ALGORITHM_4_5, Start::Warm),
    ("ccdMPRPenetration", Start::None),
    ("ccdMPRPenetrationWarm", Start::Warm),
    ("ccdPenetrationLocal", Start::Cold),
    ("ccdPenetrationLocal", Start::Warm),
    ("ccdPenetrationProven", Start::None),
    ("ccdPenetrationProven", Start::Warm),
];

const TOLERANCE: f64 = 1e-6;

/// Returns every motion with its degrees a frame.
pub fn sets() -> impl Iterator<Item = (String, f64)> {
    MOTIONS.into_iter().flat_map(|small| {
        let pair = small.strip_suffix(STEPS[0].0).expect("a motion");
        STEPS.map(|(step, degrees)| (format!("{pair}{step}"), degrees))
    })
}

pub fn find<'a>(rows: &'a [Row], set: &str, method: &str, start: Start) -> Option<&'a Row> {
    rows.iter().find(|row| (&*row.set, &*row.method, row.start) == (set, method, start))
}

pub fn measure(libraries: &Libraries, is_quick: bool) -> Vec<Row> {
    let (num_poses, repetitions) = if is_quick { (100, 3) } else { (usize::MAX, 9) };
    let rows = |(set, _): (String, f64)| {
        eprintln!("coherence: {set}");
        let scene = Scene::load(libraries, &set, num_poses);
        let methods = METHODS.iter().flat_map(|&(name, start)| match name {
            ALGORITHM_4_5 => vec![published::method(libraries, name, start, TOLERANCE)],
            _ => select(libraries, &[(name, start, TOLERANCE)]),
        });
        times::runner(libraries, repetitions).rows(&scene, methods.collect())
    };
    sets().flat_map(rows).collect()
}
