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
use crate::pages::{between_marks, markdown};

fn number(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.1}"))
}

pub fn times_faster(rows: &[Row]) -> String {
    // Method, start and tolerance, and the tolerance of libccd's EPA.
    let columns = [
        ("ccdPenetrationLocal", Start::Guess5, 1e-6, 1e-6),
        ("ccdPenetrationLocal", Start::Guess5, 1e-6, 1e-10),
        ("ccdPenetrationProven", Start::None, 1e-6, 1e-6),
        ("Gao 2023, Algorithm 4/5", Start::Guess5, AS_PUBLISHED, 1e-6),
        ("Gao 2023, Algorithm 4/5", Start::Guess5, AS_PUBLISHED, 1e-10),
    ];
    let lines = PAPER.iter().map(|(set, faster)| {
        let ns = |wanted| {
            let of = |r: &&Row| (&*r.set, (&*r.method, r.start, r.tolerance)) == (*set, wanted);
            rows.iter().find(of).and_then(|r| r.ns)
        };
        let ratio = |(method, start, tolerance, epa)| {
            let epa = ns(("libccd ccdGJKPenetration", Start::None, Some(epa)));
            number(epa.zip(ns((method, start, Some(tolerance)))).map(|(epa, ns)| epa / ns))
        };
        [vec![super::kind(set)], columns.map(ratio).into(), vec![faster.to_string()]].concat()
    });
    let head = "pair|local, EPA 1e-6|local, EPA 1e-10|proven, EPA 1e-6|\
                Algorithm 4/5, EPA 1e-6|Algorithm 4/5, EPA 1e-10|*in the paper*";
    markdown(head, lines)
}

pub fn coherence(rows: &[Row]) -> String {
    // Method, start, degrees a frame.
    let columns = [
        ("ccdPenetrationLocal", Start::Warm, 0.1),
        ("ccdPenetrationLocal", Start::Warm, 0.5),
        ("ccdPenetrationLocal", Start::Warm, 2.0),
        ("ccdPenetrationLocal", Start::Cold, 0.5),
        ("ccdPenetrationProven", Start::Warm, 0.1),
        ("ccdPenetrationProven", Start::Warm, 0.5),
        ("ccdPenetrationProven", Start::Warm, 2.0),
        ("ccdPenetrationProven", Start::None, 0.5),
        ("libccd ccdGJKPenetration", Start::None, 0.5),
    ];
    let lines = rows.chunk_by(|a, b| a.set == b.set).map(|rows| {
        let supports = |(method, start, degrees)| {
            let of = |r: &&Row| (&*r.method, r.start, r.x) == (method, start, Some(degrees));
            number(rows.iter().find(of).map(|r| r.supports))
        };
        [vec![super::kind(&rows[0].set)], columns.map(supports).into()].concat()
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
        vec![hit.method.clone(), cost(Some(hit)), share, cost(costs.iter().find(is_miss))]
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
        [vec![kind.to_owned(), method.to_owned()], DEPTHS.map(of).into()].concat()
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
        text = between_marks(&text, &format!("table {name}"), &format!("{table}\n"));
    }
    let path = page.out.join("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
