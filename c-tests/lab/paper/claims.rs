// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What the paper says of its tables and figures, what is measured here, and this library's own calls.

use super::primitives::{PAIRS, STARTS};
use super::{ALGORITHM_3, ALGORITHM_4_5, EPA, Results, find, number, table1, table2, table3};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::pages::markdown;

const LOCAL: &str = "ccdPenetrationLocal";
const PROVEN: &str = "ccdPenetrationProven";

/// Numbers of several sets, as the range that they span.
#[derive(Clone)]
struct Range(Vec<f64>);

impl Range {
    fn low(&self) -> f64 {
        self.0.iter().copied().fold(f64::MAX, f64::min)
    }

    fn high(&self) -> f64 {
        self.0.iter().copied().fold(f64::MIN, f64::max)
    }

    fn text(&self, unit: &str) -> String {
        let [low, high] = [self.low(), self.high()].map(number);
        if low == high { format!("{low}{unit}") } else { format!("{low} to {high}{unit}") }
    }

    /// Whether the numbers are at least these, of all sets, of some or of none.
    fn reaches(&self, least: f64) -> &'static str {
        match least {
            l if self.low() >= l => "yes",
            l if self.high() >= l => "in part",
            _ => "no",
        }
    }
}

/// Returns a value of one method over that of another for every set of the rows.
fn ratios(rows: &[Row], of: (&str, Start), over: (&str, Start), value: fn(&Row) -> f64) -> Range {
    let mut sets: Vec<&str> = rows.iter().map(|row| &*row.set).collect();
    sets.dedup();
    let ratio = |set: &&str| value(find(rows, set, of.0, of.1)) / value(find(rows, set, over.0, over.1));
    Range(sets.iter().map(ratio).collect())
}

fn join(ranges: impl IntoIterator<Item = Range>) -> Range {
    Range(ranges.into_iter().flat_map(|range| range.0).collect())
}

fn ns(row: &Row) -> f64 {
    row.ns.unwrap_or(f64::NAN)
}

/// Returns how many times faster than EPA a method is from guesses.
fn faster(rows: &[Row], method: &str, starts: &[Start]) -> Range {
    join(starts.iter().map(|start| ratios(rows, (EPA, Start::None), (method, *start), ns)))
}

/// Returns ratios of two columns of a published table.
fn published(table: [[f64; 4]; 3], of: usize, over: usize) -> Range {
    Range(table.map(|row| row[of] / row[over]).into())
}

pub fn table(results: &Results) -> String {
    let Results { primitives, vertices, deep, shortcut } = results;
    let (near, far) = (Start::Guess5, Start::Guess45);
    let error = |row: &Row| row.mean_error_1mm;
    let direction = |row: &Row| row.direction_mean_1mm.unwrap_or(f64::NAN);
    let values = |method: &str, value: fn(&Row) -> f64| {
        let of = |start: &Start| Range(PAIRS.map(|(set, _)| value(find(primitives, set, method, *start))).into());
        join(STARTS.iter().map(of))
    };
    let our_speed = |rows: &[Row], starts: &[Start]| {
        let [local, proven] = [faster(rows, LOCAL, starts), faster(rows, PROVEN, &[Start::None])];
        format!("`…Local` {}, `…Proven` {}", local.text("×"), proven.text("×"))
    };
    let mut lines = Vec::new();
    let mut add = |claim: &str, paper: String, measured: &Range, unit: &str, holds: &str, ours: String| {
        lines.push(vec![claim.to_owned(), paper, measured.text(unit), holds.to_owned(), ours]);
    };

    let micrometres = |row: &Row| 1e6 * row.mean_error_1mm;
    let depths = values(ALGORITHM_4_5, micrometres);
    let published_depths = join(table1::PUBLISHED.map(|row| Range(row[..3].to_vec())));
    add(
        "Depths are accurate to about 1 µm, from every guess (Table I; the tolerance is chosen for it)",
        published_depths.text(" µm"),
        &depths,
        " µm",
        if depths.high() <= 2.0 * published_depths.high() { "yes" } else { "no" },
        format!("`…Local` {}", values(LOCAL, micrometres).text(" µm")),
    );
    let far_off = ratios(primitives, (ALGORITHM_4_5, far), (ALGORITHM_4_5, near), error);
    add(
        "… despite the large error of the guess: depth error at 45° over that at 5° (Table I)",
        published(table1::PUBLISHED, 2, 0).text("×"),
        &far_off,
        "×",
        if far_off.high() <= 1.2 { "yes" } else { "no" },
        format!(
            "more than 1 mm off from 45°: Algorithm 4/5 {}, `…Local` {}",
            Range(PAIRS.map(|(set, _)| find(primitives, set, ALGORITHM_4_5, far).beyond_1mm).into()).text(" %"),
            Range(PAIRS.map(|(set, _)| find(primitives, set, LOCAL, far).beyond_1mm).into()).text(" %"),
        ),
    );
    let better = ratios(primitives, (EPA, Start::None), (ALGORITHM_4_5, near), direction);
    add(
        "Directions are more accurate than EPA's: its error over that of Algorithm 4/5 (Table II)",
        published(table2::PUBLISHED, 3, 0).text("×"),
        &better,
        "×",
        better.reaches(1.0),
        format!("`…Local` {}", values(LOCAL, direction).text(" mrad")),
    );
    let speed = faster(primitives, ALGORITHM_4_5, &STARTS);
    let published_speed = join([0, 1, 2].map(|k| published(table3::PUBLISHED, 3, k)));
    add(
        "\"20x-30x speed up compared to EPA\" (Table III)",
        published_speed.text("×"),
        &speed,
        "×",
        speed.reaches(20.0),
        our_speed(primitives, &STARTS),
    );
    let slower = ratios(primitives, (ALGORITHM_4_5, far), (ALGORITHM_4_5, near), ns);
    let published_slower = published(table3::PUBLISHED, 2, 0);
    add(
        "The speed hardly depends on the guess: time from 45° over that from 5° (Table III)",
        published_slower.text("×"),
        &slower,
        "×",
        if slower.high() <= 1.1 * published_slower.high() { "yes" } else { "no" },
        format!("`…Local` {}", ratios(primitives, (LOCAL, far), (LOCAL, near), ns).text("×")),
    );
    let hulls = faster(vertices, ALGORITHM_4_5, &[near, far]);
    add(
        "\"6-10x speedup\" over EPA on hulls of 12 to 2,562 vertices (figure over vertices)",
        "6 to 10×".to_owned(),
        &hulls,
        "×",
        hulls.reaches(6.0),
        our_speed(vertices, &[near, far]),
    );
    let walk = ratios(deep, ("DEEP", near), (ALGORITHM_4_5, near), ns);
    add(
        "\"About 2x faster\" than DEEP (figure beside DEEP)",
        "2×".to_owned(),
        &walk,
        "×",
        walk.reaches(1.8),
        format!("`…Local` {}", ratios(deep, ("DEEP", near), (LOCAL, near), ns).text("×")),
    );
    let (with, without) = ((ALGORITHM_4_5, far), (ALGORITHM_3, far));
    let supports = |row: &Row| row.supports;
    let halved = ratios(shortcut, without, with, supports);
    add(
        "The shortcut halves the support calls (figure of the shortcut)",
        "2×".to_owned(),
        &halved,
        "×",
        halved.reaches(1.8),
        format!("fewer than Algorithm 4/5: `…Local` {}", ratios(shortcut, with, (LOCAL, far), supports).text("×")),
    );
    let saved = ratios(shortcut, without, with, ns);
    add(
        "… and saves \"2-3x\" of the time (the same figure)",
        "2 to 3×".to_owned(),
        &saved,
        "×",
        saved.reaches(1.8),
        format!("faster than Algorithm 4/5: `…Local` {}", ratios(shortcut, with, (LOCAL, far), ns).text("×")),
    );
    markdown("claim|paper|measured here|holds here|this library's calls", lines)
}
