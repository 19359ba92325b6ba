// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The ledger of costs: the recorded support points, instructions and mispredicted branches of a query, which no change
//! may raise.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::libraries::Libraries;
use super::measure::{Row, Runner, support_value};
use super::methods::{Start, select};
use super::scene::{DEPTHS, FLOOR_KINDS, KINDS, Pair, Scene};
use crate::harness;

/// Recorded hits, and misses, evenly spaced. Their mean instructions are within 5 % of those of ten times as many.
const NUM_RECORDED: usize = 500;

/// Random pairs of each kind and depth. Their mean instructions are within 10 % of those of four times as many.
const NUM_RANDOM: usize = 100;

/// A method of the table with its start and tolerance.
type Listed = (&'static str, Start, f64);

const ON_RECORDED: [Listed; 6] = [
    ("ccdMPRPenetration, pos", Start::None, 1e-6),
    ("ccdMPRPenetration", Start::None, 1e-6),
    ("ccdGJKPenetration", Start::None, 1e-6),
    ("ccdPenetrationProven", Start::Cold, 1e-6),
    ("ccdPenetrationLocal", Start::Cold, 1e-6),
    ("ccdIntersect", Start::Cold, 1e-6),
];
const AFTER_A_FRAME: [Listed; 1] = [("ccdMPRPenetrationWarm", Start::Warm, 1e-6)];
const ON_SLIDING: [Listed; 2] = [("ccdMPRPenetrationWarm, pos", Start::Warm, 1e-6), AFTER_A_FRAME[0]];
const ON_FLOORS: [Listed; 5] = [
    ON_RECORDED[0],
    ON_RECORDED[1],
    ON_RECORDED[2],
    ("ccdMPRIntersect", Start::None, 1e-6),
    ("ccdPenetrationLocal", Start::Cold, 1e-6),
];
const BY_ONE_POINT: [Listed; 1] = [("ccdSignedDistance", Start::Cold, 1e-6)];
const ON_RANDOM: [Listed; 1] = [("ccdMPRPenetration", Start::None, 1e-6)];

/// libccd's calls, which are recorded beside them and not judged.
const LIBCCD_ON_RECORDED: [Listed; 3] = [
    ("libccd ccdMPRPenetration", Start::None, 1e-6),
    ("libccd ccdGJKPenetration", Start::None, 1e-6),
    ("libccd ccdMPRIntersect", Start::None, 1e-6),
];
const LIBCCD_ON_RANDOM: [Listed; 1] = [LIBCCD_ON_RECORDED[0]];

/// Half widths of floors, metres.
const FLOORS: [f64; 2] = [1.0, 20.0];

/// A row of the file: means over the queries of a method on a set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    pub set: String,
    pub method: String,
    pub start: Start,
    /// Support points of the Minkowski difference.
    pub supports: f64,
    /// In solver and callbacks.
    pub instructions: f64,
    /// Of these in the callbacks.
    pub callbacks: f64,
    pub mispredictions: f64,
}

/// Support points may rise by this ratio and by so many a query. They repeat exactly; the slack is for another compiler's
/// rounding.
const SUPPORTS_RATIO: f64 = 1.02;
const SUPPORTS_MORE: f64 = 0.05;
/// Instructions may rise by so much. They repeat to 0.002 %, whichever program runs the queries: memcpy takes a few more or
/// less by the alignment of the stack.
const INSTRUCTIONS_RATIO: f64 = 1.03;
/// Mispredictions may rise by this ratio and by so many a query. They repeat to 0.1 % in one program, and to 4 % from the one
/// that records to the one that tests; but callgrind's model tells branches apart by seven bits of their addresses, so that
/// moving the same code (functions aligned to 32, 64 or 128 bytes, blocks to 16 or 32) changes a row by up to 15 %, or by 2.2
/// a query where there are few.
const MISPREDICTIONS_RATIO: f64 = 1.15;
const MISPREDICTIONS_MORE: f64 = 2.5;

impl Cost {
    fn of(row: Row) -> Self {
        let rounded = |x: f64| (1e3 * x).round() / 1e3;
        Self {
            supports: rounded(row.supports),
            instructions: rounded(row.instructions()),
            callbacks: rounded(row.callbacks.unwrap_or_default()),
            mispredictions: rounded(row.mispredictions.unwrap_or_default()),
            set: row.set,
            method: row.method,
            start: row.start,
        }
    }

    /// Finds the row of the same queries.
    pub fn find<'a>(&self, rows: &'a [Self]) -> Option<&'a Self> {
        rows.iter().find(|row| (&row.set, &row.method, row.start) == (&self.set, &self.method, self.start))
    }

    /// Returns whether it costs more than is allowed.
    pub fn is_above(&self, then: &Self) -> bool {
        self.supports > then.supports * SUPPORTS_RATIO + SUPPORTS_MORE
            || self.instructions > then.instructions * INSTRUCTIONS_RATIO
            || self.mispredictions > then.mispredictions * MISPREDICTIONS_RATIO + MISPREDICTIONS_MORE
    }

    /// Returns both costs and their difference as a line.
    pub fn beside(&self, then: &Self) -> String {
        let difference = |what: &str, then: f64, now: f64| {
            format!("{what} {then:.1} -> {now:.1} ({:+.2} %)", 100.0 * (now / then - 1.0))
        };
        let supports = difference("support points", then.supports, self.supports);
        let instructions = difference("instructions", then.instructions, self.instructions);
        let mispredictions = difference("mispredicted", then.mispredictions, self.mispredictions);
        format!("{}, {}: {supports}, {instructions}, {mispredictions}", self.set, self.method)
    }
}

pub fn file() -> PathBuf {
    harness::root().join("c-tests/bench/measuring/instruction_counts.csv")
}

/// Returns so many of the recorded pairs for which `is_wanted`, each behind the pair of the frame before: two frames of a
/// motion.
fn sampled(recorded: &Scene, name: &str, is_wanted: impl Fn(&Pair) -> bool) -> Scene {
    let frames = recorded.pairs.windows(2).filter(|frames| frames[1].frame > 0 && is_wanted(&frames[1]));
    let frames: Vec<_> = frames.collect();
    let chosen = (0..NUM_RECORDED).map(|k| frames[k * frames.len() / NUM_RECORDED]);
    let motion = |frames: &[Pair]| [Pair { frame: 0, ..frames[0] }, Pair { frame: 1, ..frames[1] }];
    Scene { name: format!("recorded {name}"), pairs: chosen.flat_map(motion).collect() }
}

/// Measures every row, or in the process under callgrind returns none. The command runs this function in this program.
pub fn measure(libraries: &Libraries, command: &[&str], with_libccd: bool) -> Result<Vec<Cost>, String> {
    let mut runner = Runner::new(libraries).with_instructions(1, command)?;
    let mut rows = Vec::new();
    let mut add = |scene: &Scene, ours: &[Listed], libccds: &[Listed]| {
        let list = [if with_libccd { libccds } else { &[] }, ours].concat();
        rows.extend(runner.rows(scene, select(libraries, &list)).into_iter().map(Cost::of));
    };
    let recorded = Scene::recorded(libraries);
    let is_apart = |pair: &Pair| pair.truth.depth < -1e-9;
    let frames = [sampled(&recorded, "hits", |pair| pair.truth.depth > 1e-9), sampled(&recorded, "misses", is_apart)];
    for frames in &frames {
        add(&frames.second_frames(), &ON_RECORDED, &LIBCCD_ON_RECORDED);
        add(frames, &AFTER_A_FRAME, &[]);
    }
    // The line of the centers separates them.
    let is_decided = |pair: &Pair| is_apart(pair) && support_value(libraries, pair, pair.truth.cold.into()) < -1e-9;
    let decided = sampled(&recorded, "misses by one point", is_decided);
    add(&decided.second_frames(), &BY_ONE_POINT, &[]);
    let sliding = Scene::sliding(libraries, NUM_RANDOM);
    add(&sliding, &ON_SLIDING, &[]);
    add(&sliding.second_frames(), &ON_RANDOM, &LIBCCD_ON_RANDOM);
    for half in FLOORS {
        for (kind, is_above) in (0..FLOOR_KINDS.len()).flat_map(|kind| [(kind, false), (kind, true)]) {
            let frames = Scene::floor(libraries, kind, half, is_above, NUM_RANDOM);
            add(&frames.second_frames(), &ON_FLOORS, &LIBCCD_ON_RECORDED);
            add(&frames, &AFTER_A_FRAME, &[]);
        }
    }
    for kind in 0..KINDS.len() {
        for depth in 0..DEPTHS.len() {
            add(&Scene::random(libraries, kind, depth, NUM_RANDOM), &ON_RANDOM, &LIBCCD_ON_RANDOM);
        }
    }
    Ok(rows)
}
