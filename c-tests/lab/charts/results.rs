// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tables of the charts' page, which is its own template: a table is written between its marks.

use std::path::Path;

use crate::harness;
use crate::measuring::csv;
use crate::measuring::ledger::{self, Cost};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::measuring::recorded::{self, MOTIONS, Recorded};
use crate::measuring::scene::{DEPTHS, KINDS};
use crate::pages::{between_marks, markdown};

fn number(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.1}"))
}

/// Pair sets like those of the paper's Table III; how many times faster than EPA its method is there with guesses 5° off;
/// and the support points that its implementation (mind-fcl, its convergence checked once more) takes on the poses of the
/// set at a tolerance of 1e-6, through the same callbacks: measured once, elsewhere.
const PAPER: [(&str, f64, f64); 3] = [("sph_sph", 44.8, 56.4), ("cap_cap", 24.7, 48.0), ("sph_cap", 30.8, 54.5)];

/// The tolerance at which the paper's algorithms need the support points of that implementation.
const AS_PUBLISHED: f64 = 1e-5;

/// Compares the paper's method with this library's: time of libccd's EPA over theirs, and support points.
fn paper(rows: &[Row]) -> String {
    const GAO: (&str, Start, f64) = ("Gao 2023, Algorithm 4/5", Start::Guess5, AS_PUBLISHED);
    const LOCAL: (&str, Start, f64) = ("ccdPenetrationLocal", Start::Guess5, 1e-6);
    const PROVEN: (&str, Start, f64) = ("ccdPenetrationProven", Start::None, 1e-6);
    let lines = PAPER.iter().map(|(set, faster, published)| {
        let find = |(method, start, tolerance)| {
            let is_wanted =
                |r: &&Row| (&*r.set, &*r.method, r.start, r.tolerance) == (*set, method, start, Some(tolerance));
            rows.iter().find(is_wanted)
        };
        let ns = |method| find(method).and_then(|row| row.ns);
        let ratio = |method, epa| {
            let epa = ns(("libccd ccdGJKPenetration", Start::None, epa));
            number(epa.zip(ns(method)).map(|(epa, ns)| epa / ns))
        };
        let supports = |method| number(find(method).map(|row| row.supports));
        let figures = [
            ratio(LOCAL, 1e-6),
            ratio(LOCAL, 1e-10),
            ratio(PROVEN, 1e-6),
            ratio(GAO, 1e-6),
            ratio(GAO, 1e-10),
            faster.to_string(),
            supports(LOCAL),
            supports(GAO),
            number(Some(*published)),
        ];
        [vec![super::kind(set)], figures.into()].concat()
    });
    let head = "pair|local, EPA 1e-6|local, EPA 1e-10|proven, EPA 1e-6|\
                Algorithm 4/5, EPA 1e-6|Algorithm 4/5, EPA 1e-10|*in the paper*|\
                support points, local|Algorithm 4/5|*published*";
    markdown(head, lines)
}

/// Returns the recorded support points of the calls that start from a state, on motions, and cold.
fn coherence(recorded: &[Recorded]) -> String {
    let columns = [
        ("ccdMPRPenetration", Start::None),
        ("ccdMPRPenetrationWarm", Start::Warm),
        ("ccdPenetrationLocal", Start::Cold),
        ("ccdPenetrationLocal", Start::Warm),
        ("ccdPenetrationProven", Start::None),
        ("ccdPenetrationProven", Start::Warm),
    ];
    let lines = MOTIONS.map(|set| {
        let supports = |(method, start)| {
            let is_wanted = |r: &&Recorded| (&*r.set, &*r.method, r.start, r.tolerance) == (set, method, start, 1e-6);
            number(recorded.iter().find(is_wanted).map(|row| row.supports))
        };
        [vec![super::kind(set)], columns.map(supports).into()].concat()
    });
    markdown("pair|`ccdMPRPenetration`|warm|`ccdPenetrationLocal`|warm|`ccdPenetrationProven`|warm", lines)
}

/// Returns instructions and, in parentheses, mispredicted branches of a query.
fn cost(cost: Option<&Cost>) -> String {
    cost.map_or("-".to_owned(), |c| format!("{:.0} ({:.0})", c.instructions, c.mispredictions))
}

/// Returns the costs of every call on the recorded contacts.
fn instructions(costs: &[Cost]) -> String {
    let hits = costs.iter().filter(|c| c.set == "recorded hits");
    let lines = hits.map(|hit| {
        let is_miss = |c: &&Cost| (&*c.set, &c.method) == ("recorded misses", &hit.method);
        let share = format!("{:.0}", 100.0 * hit.callbacks / hit.instructions);
        vec![hit.method.clone(), cost(Some(hit)), share, cost(costs.iter().find(is_miss))]
    });
    markdown("call|hit|of it support functions, %|miss", lines)
}

/// Returns the costs of `ccdMPRPenetration` by kind and depth of the pairs.
fn instructions_by_depth(costs: &[Cost]) -> String {
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

/// Writes the page's tables between their marks: of these rows, and of the recorded costs.
pub fn write(out: &Path, machine: &str, rows: &[Row]) {
    let (_, costs) = csv::read::<Cost>(&ledger::file());
    let tables = [
        ("MACHINE", machine.to_owned()),
        ("PAPER", paper(rows)),
        ("COHERENCE", coherence(&csv::read(&recorded::file()).1)),
        ("INSTRUCTIONS", instructions(&costs)),
        ("DEPTHS", instructions_by_depth(&costs)),
    ];
    let committed = harness::root().join("c-tests/bench/charts/README.md");
    let mut text = std::fs::read_to_string(&committed).expect("the charts' page");
    for (name, table) in tables {
        text = between_marks(&text, &format!("table {name}"), &format!("{table}\n"));
    }
    let path = out.join("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
