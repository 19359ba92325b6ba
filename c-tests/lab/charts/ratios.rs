// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Times of `ccdMPRPenetration` over libccd's, misses too: random pairs by kind and depth, bodies on and above floors, and the
//! recorded contacts. Identical code varies by a fifth from one build or machine to the next: no test judges these ratios, the
//! ledger of costs is for that.

use super::times;
use crate::measuring::libraries::Libraries;
use crate::measuring::methods::{Start, select};
use crate::measuring::scene::{DEPTHS, FLOOR_KINDS, KINDS, Scene};
use crate::pages::markdown;

const METHODS: [(&str, Start, f64); 2] =
    [("ccdMPRPenetration", Start::None, 1e-6), ("libccd ccdMPRPenetration", Start::None, 1e-6)];
/// Pairs of each kind and depth, more than a processor's predictor learns by heart.
const NUM_RANDOM: usize = 400;
const REPETITIONS: usize = 31;

/// Prints the ratios, and their geometric means over the kinds.
pub fn run() {
    let libraries = Libraries::open();
    let ratio = |scene: &Scene| {
        let [ours, theirs] = &mut select(&libraries, &METHODS)[..] else { unreachable!("two methods") };
        times::ratio(scene, ours, theirs, REPETITIONS)
    };
    let ratios = KINDS.iter().enumerate().map(|(kind, name)| {
        eprintln!("ratios of times: {name}");
        let of = |depth| ratio(&Scene::random(&libraries, kind, depth, NUM_RANDOM));
        (name.to_string(), (0..DEPTHS.len()).map(of).collect())
    });
    let ratios: Vec<(String, Vec<f64>)> = ratios.collect();
    let mean = |depth: usize| {
        let logs = ratios.iter().map(|(_, ratios)| ratios[depth].ln());
        (logs.sum::<f64>() / ratios.len() as f64).exp()
    };
    let all = ("all".to_owned(), (0..DEPTHS.len()).map(mean).collect());
    let lines = ratios.iter().chain([&all]).map(|(name, ratios): &(String, Vec<f64>)| {
        [vec![name.clone()], ratios.iter().map(|ratio| format!("{ratio:.2}")).collect()].concat()
    });
    println!("{}\n{}", libraries.machine, markdown(&format!("pair|{}", DEPTHS.join("|")), lines));
    for (kind, is_above) in (0..FLOOR_KINDS.len()).flat_map(|kind| [(kind, false), (kind, true)]) {
        let frames = Scene::floor(&libraries, kind, 20.0, is_above, NUM_RANDOM);
        println!("{}: {:.2}", frames.name, ratio(&frames.second_frames()));
    }
    let recorded = Scene::recorded(&libraries);
    for (name, sign) in [("hits", 1.0), ("misses", -1.0)] {
        let mut scene = recorded.clone();
        scene.pairs.retain(|pair| sign * pair.truth.depth > 1e-9);
        println!("recorded {name}: {:.2}", ratio(&scene));
    }
}
