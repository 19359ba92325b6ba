// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tables of the charts' page, which is its own template: a table is written between its marks.

use super::Page;
use super::paper::{AS_PUBLISHED, PAPER};
use crate::harness;
use crate::measuring::ledger::Cost;
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::measuring::scene::{DEPTHS, KINDS};

/// Returns a table; `|` separates the cells of its head.
pub fn markdown<const N: usize>(head: &str, lines: impl IntoIterator<Item = [String; N]>) -> String {
    let head = format!("| {} |\n|{}", head.split('|').collect::<Vec<_>>().join(" | "), "---|".repeat(N));
    let lines = lines.into_iter().map(|cells| format!("\n| {} |", cells.join(" | ")));
    std::iter::once(head).chain(lines).collect()
}

pub fn times_faster(rows: &[Row]) -> String {
    let lines = PAPER.iter().map(|(set, faster)| {
        let ns = |method: &str, start: Start, tolerance: f64| {
            let is_wanted =
                |r: &&Row| (&*r.set, &*r.method, r.start, r.tolerance) == (*set, method, start, Some(tolerance));
            rows.iter().find(is_wanted).and_then(|r| r.ns)
        };
        let ratio = |method: &str, start: Start, tolerance: f64, epa_tolerance: f64| {
            let epa = ns("libccd ccdGJKPenetration", Start::None, epa_tolerance);
            let ratio = epa.zip(ns(method, start, tolerance)).map(|(epa, ns)| format!("{:.1}", epa / ns));
            ratio.unwrap_or("-".to_owned())
        };
        [
            super::kind(set),
            ratio("ccdPenetrationLocal", Start::Guess5, 1e-6, 1e-6),
            ratio("ccdPenetrationLocal", Start::Guess5, 1e-6, 1e-10),
            ratio("ccdPenetrationProven", Start::None, 1e-6, 1e-6),
            ratio("Gao 2023, Algorithm 4/5", Start::Guess5, AS_PUBLISHED, 1e-6),
            ratio("Gao 2023, Algorithm 4/5", Start::Guess5, AS_PUBLISHED, 1e-10),
            faster.to_string(),
        ]
    });
    let head = "pair|local, EPA 1e-6|local, EPA 1e-10|proven, EPA 1e-6|\
                Algorithm 4/5, EPA 1e-6|Algorithm 4/5, EPA 1e-10|*in the paper*";
    markdown(head, lines)
}

pub fn coherence(rows: &[Row]) -> String {
    let mut sets: Vec<&str> = rows.iter().map(|row| &*row.set).collect();
    sets.dedup();
    let lines = sets.into_iter().map(|set| {
        let supports = |method: &str, start: Start, degrees: f64| {
            let is_wanted = |r: &&Row| (&*r.set, &*r.method, r.start, r.x) == (set, method, start, Some(degrees));
            rows.iter().find(is_wanted).map_or("-".to_owned(), |r| format!("{:.1}", r.supports))
        };
        [
            super::kind(set),
            supports("ccdPenetrationLocal", Start::Warm, 0.1),
            supports("ccdPenetrationLocal", Start::Warm, 0.5),
            supports("ccdPenetrationLocal", Start::Warm, 2.0),
            supports("ccdPenetrationLocal", Start::Cold, 0.5),
            supports("ccdPenetrationProven", Start::Warm, 0.1),
            supports("ccdPenetrationProven", Start::Warm, 0.5),
            supports("ccdPenetrationProven", Start::Warm, 2.0),
            supports("ccdPenetrationProven", Start::None, 0.5),
            supports("libccd ccdGJKPenetration", Start::None, 0.5),
        ]
    });
    let head = "pair|local, warm, 0.1°|0.5°|2°|local, cold|\
                proven, warm, 0.1°|0.5°|2°|proven, cold|libccd EPA";
    markdown(head, lines)
}

/// Returns instructions and, in parentheses, mispredicted branches of a query.
fn cost(cost: Option<&Cost>) -> String {
    cost.map_or("-".to_owned(), |c| format!("{:.0} ({:.0})", c.instructions, c.mispredictions))
}

/// Returns the costs of every call on the recorded contacts.
pub fn instructions(costs: &[Cost]) -> String {
    let hits = costs.iter().filter(|c| c.set == "recorded hits");
    let lines = hits.map(|hit| {
        let is_miss = |c: &&Cost| (&*c.set, &c.method) == ("recorded misses", &hit.method);
        let share = format!("{:.0}", 100.0 * hit.callbacks / hit.instructions);
        [hit.method.clone(), cost(Some(hit)), share, cost(costs.iter().find(is_miss))]
    });
    markdown("call|hit|of it support functions, %|miss", lines)
}

/// Returns the costs of `ccdMPRPenetration` by kind and depth of the pairs.
pub fn instructions_by_depth(costs: &[Cost]) -> String {
    let line = |kind: &str, method: &str| {
        let of = |depth| {
            let is_wanted = |c: &&Cost| c.method == method && c.set == format!("{kind} {depth}");
            cost(costs.iter().find(is_wanted))
        };
        let [shallow, medium, deep, near, far] = DEPTHS.map(of);
        [kind.to_owned(), method.to_owned(), shallow, medium, deep, near, far]
    };
    let lines = KINDS
        .iter()
        .flat_map(|kind| ["libccd ccdMPRPenetration", "ccdMPRPenetration"].map(|method| line(kind, method)));
    markdown(&format!("pair|method|{}", DEPTHS.join("|")), lines)
}

/// Writes the page's tables between their marks.
pub fn write(page: &Page, tables: &[(&str, String)]) {
    let committed = harness::root().join("c-tests/bench/charts/README.md");
    let mut text = std::fs::read_to_string(&committed).expect("the charts' page");
    for (name, table) in tables {
        text = harness::between_marks(&text, &format!("table {name}"), &format!("{table}\n"));
    }
    let path = page.out.join("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
