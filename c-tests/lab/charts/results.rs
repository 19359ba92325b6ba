// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tables of the charts' page, which is its own template: a table is written between its marks.

use std::path::Path;

use super::{coherence, local};
use crate::harness;
use crate::measuring::csv;
use crate::measuring::ledger::{self, Cost};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::measuring::scene::{DEPTHS, KINDS};
use crate::pages::{between_marks, markdown};
use crate::paper::ALGORITHM_4_5;

fn number(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.1}"))
}

/// Methods of the tables of directions, at 1e-6; local searches from guesses 5° off, on motions warm.
const DIRECTIONS: [(&str, Start, Start); 7] = [
    ("libccd ccdMPRPenetration", Start::None, Start::None),
    ("libccd ccdGJKPenetration", Start::None, Start::None),
    (ALGORITHM_4_5, Start::Guess5, Start::Warm),
    ("ccdPenetrationLocal", Start::Guess5, Start::Warm),
    ("ccdPenetrationProven", Start::None, Start::Warm),
    ("ccdMPRPenetration", Start::None, Start::None),
    ("FCL EPA", Start::None, Start::None),
];

/// Returns milliradians with two digits.
fn mrad(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(v) if v < 1e-3 => "0.00".to_owned(),
        Some(v) => format!("{v:.*}", (1 - v.log10().floor() as i32).clamp(0, 3) as usize),
    }
}

/// Returns the least and the largest of numbers, with two digits.
fn range(values: &[f64]) -> String {
    let digits = |v: f64| (1 - v.abs().log10().floor() as i32).clamp(0, 2) as usize;
    let text = |v: f64| if v == 0.0 { "0".to_owned() } else { format!("{v:.*}", digits(v)) };
    let [low, high] = [f64::min, f64::max].map(|f| text(values.iter().copied().reduce(f).unwrap_or(f64::NAN)));
    if low == high { low } else { format!("{low} to {high}") }
}

/// Says in three sentences what the independent poses show at a tolerance of 1e-6.
fn found(rows: &[Row]) -> String {
    let of = |set: &str, method: &str| {
        let is_wanted = |r: &&Row| (&*r.set, &*r.method) == (set, method) && r.tolerance.is_none_or(|t| t == 1e-6);
        rows.iter().find(is_wanted)
    };
    let values = |method: &str, value: fn(&Row) -> f64| -> Vec<f64> {
        super::sets().into_iter().filter_map(|set| of(set, method)).map(value).collect()
    };
    // Two spheres are apart: libccd's line of centers is their direction.
    let ratio = |method: &str, over: &str, value: fn(&Row) -> f64| {
        let sets = super::sets().into_iter().filter(|set| *set != "sph_sph");
        let ratios = sets.filter_map(|set| Some(value(of(set, method)?) / value(of(set, over)?)));
        range(&ratios.collect::<Vec<_>>())
    };
    let (mpr, libccd, proven) = ("ccdMPRPenetration", "libccd ccdMPRPenetration", "ccdPenetrationProven");
    let wrong = |methods: &[&str]| range(&methods.iter().flat_map(|m| values(m, |row| row.wrong)).collect::<Vec<_>>());
    let ns = |row: &Row| row.ns.unwrap_or(f64::NAN);
    let supports = |row: &Row| row.supports;
    format!(
        "Of libccd's MPR {} % of the answers about a kind of pair are wrong at a tolerance of 1e-6, of its EPA (1 mm) {} %, of this library's \
         {} %: missed, or depth or direction off by more than 1 % and two tolerances. `ccdMPRPenetration` takes {} times the support \
         points of libccd's MPR and {} times its time; two spheres, which lie on libccd's line of centers, are left out. \
         `{proven}` takes {} times the time of FCL's EPA, and {} times that of parry's.",
        wrong(&[libccd]),
        wrong(&["libccd ccdGJKPenetration"]),
        wrong(&[mpr, "ccdPenetrationLocal", proven]),
        ratio(mpr, libccd, supports),
        ratio(mpr, libccd, ns),
        ratio(proven, "FCL EPA", ns),
        ratio(proven, "parry EPA", ns),
    )
}

/// Returns the errors of the directions of independent poses: root of the mean square, 99 %, largest.
fn directions(rows: &[Row]) -> String {
    let lines = super::sets().into_iter().map(|set| {
        let cell = |(method, start, _)| {
            let is_wanted = |r: &&Row| (&*r.set, &*r.method, r.start, r.tolerance) == (set, method, start, Some(1e-6));
            rows.iter()
                .find(is_wanted)
                .map_or("-".to_owned(), |r| [r.direction_rms, r.direction_p99, r.direction_max].map(mrad).join(" / "))
        };
        [vec![super::kind(set)], DIRECTIONS.map(cell).into()].concat()
    });
    let head =
        "pair|libccd MPR|libccd EPA|Algorithm 4/5, 5°|`ccdPenetrationLocal`, 5°|`…Proven`|`ccdMPRPenetration`|FCL EPA";
    markdown(head, lines)
}

/// Returns support points over motions, cold and warm side by side.
fn coherence(rows: &[Row]) -> String {
    let lines = coherence::sets().map(|(set, degrees)| {
        let supports = |(method, start)| number(coherence::find(rows, &set, method, start).map(|row| row.supports));
        [vec![super::kind(&set), format!("{degrees}°")], coherence::METHODS.map(supports).into()].concat()
    });
    let head = "pair|a frame|libccd MPR|libccd EPA|Algorithm 4/5|warm|`ccdMPRPenetration`|warm|\
                `ccdPenetrationLocal`|warm|`ccdPenetrationProven`|warm";
    markdown(head, lines)
}

/// Returns how far directions turn from frame to frame beside the true turn.
fn jitter(rows: &[Row]) -> String {
    let lines = coherence::sets().map(|(set, degrees)| {
        let of = |(method, start)| coherence::find(rows, &set, method, start);
        let turn = mrad(of(coherence::METHODS[0]).and_then(|row| row.true_turn));
        let jitter = |method| mrad(of(method).and_then(|row| row.jitter));
        [vec![super::kind(&set), format!("{degrees}°"), turn], coherence::METHODS.map(jitter).into()].concat()
    });
    let head = "pair|a frame|true turn|libccd MPR|libccd EPA|Algorithm 4/5|warm|`ccdMPRPenetration`|warm|\
                `ccdPenetrationLocal`|warm|`ccdPenetrationProven`|warm";
    markdown(head, lines)
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

/// Writes the page's tables between their marks: of these rows, of those of motions and of local searches,
/// and of the recorded costs.
pub fn write(out: &Path, machine: &str, rows: &[Row], motions: &[Row], local: &[Row]) {
    let (_, costs) = csv::read::<Cost>(&ledger::file());
    let tables = [
        ("FOUND", found(rows)),
        ("MACHINE", machine.to_owned()),
        ("DIRECTIONS", directions(rows)),
        ("COHERENCE", coherence(motions)),
        ("JITTER", jitter(motions)),
        ("LOCAL", local::table(local)),
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
