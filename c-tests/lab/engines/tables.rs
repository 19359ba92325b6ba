// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the scenes that are judged before a release alone, and prints the counters of all as tables.

// Comparisons are negated so that NaN counts as a failure.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

use super::consumers::{self, CONSUMERS};
use super::programs::{Method, Output, on_both, program};
use super::results::{Simulation, median, range, simulate, values, wrong_of};
use crate::harness::callgrind;

/// A column of a table: heading and cell.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

/// Returns a Markdown table with a row for each of `rows`.
pub fn markdown<T>(rows: &[T], columns: &[Column<T>]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let head = line(columns.iter().map(|(heading, _)| (*heading).to_owned()).collect());
    let rule = format!("|{}\n", "---|".repeat(columns.len()));
    let rows = rows.iter().map(|row| line(columns.iter().map(|(_, cell)| cell(row)).collect()));
    [head, rule].into_iter().chain(rows).collect()
}

// --- single queries -------------------------------------------------------------

/// Returns a row for each library.
pub fn collide_table(title: &str, outputs: &[Output]) -> String {
    let count = |key: &'static str| move |o: &Output| o.value(key).to_string();
    markdown(
        outputs,
        &[
            (title, &|o| o.method.to_owned()),
            ("queries", &count("collide.queries")),
            ("missed", &count("collide.missed")),
            ("> 1 % too deep", &count("collide.deep")),
            ("false, broken, unsound", &|o| (wrong_of(o, "collide") - o.value("collide.deep")).to_string()),
            ("largest excess", &count("collide.excess")),
            ("queries with a wrong callback", &count("invalid_support.queries")),
        ],
    )
}

/// The sets of pairs of `fcl_distance`.
pub const DISTANCE_SETS: [&str; 3] = ["configurations", "kissing", "random"];

pub fn distance_table(outputs: &[Output]) -> String {
    let rows: Vec<_> = DISTANCE_SETS.iter().flat_map(|set| outputs.iter().map(move |output| (output, *set))).collect();
    let count = |key: &'static str| move |(o, set): &(&Output, &str)| o.value(&format!("{set}.{key}")).to_string();
    markdown(
        &rows,
        &[
            ("pairs", &|(_, set)| (*set).to_owned()),
            ("", &|(o, _)| o.method.to_owned()),
            ("pairs", &count("queries")),
            ("threw", &count("threw")),
            ("endless", &count("endless")),
            ("wrong", &|(o, set)| o.sum(&format!("{set}.wrong {set}.outside")).to_string()),
            ("µs a distance", &|(o, set)| format!("{:.1}", o.value(&format!("{set}.microseconds")))),
        ],
    )
}

// --- FCL's broad phase ----------------------------------------------------------

/// Runs `fcl_scene` by each of its narrow phases; one pair in `exact` is judged by exact truth too. The
/// time is the least of so many runs in which they take turns.
pub fn scenes(frames: usize, exact: usize, rounds: usize) -> [Output; 4] {
    let arguments = format!("{frames} 200 {exact}");
    let mut scenes = consumers::fcl_scene(false).map(|method| method.run(&arguments));
    let least = least_of(rounds, &consumers::fcl_scene(true), &arguments, "timed.seconds");
    for (scene, seconds) in scenes.iter_mut().zip(least) {
        scene.set("milliseconds", 1e3 * seconds / frames as f64);
    }
    scenes
}

/// Returns the least value of a counter over so many rounds in which the methods take turns.
fn least_of<const N: usize>(rounds: usize, methods: &[Method; N], arguments: &str, key: &str) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..rounds {
        for (method, least) in methods.iter().zip(&mut least) {
            *least = least.min(method.run(arguments).value(key));
        }
    }
    least
}

pub fn scene_table(scenes: &[Output]) -> String {
    let first = scenes[0].value("milliseconds");
    let count = |key: &'static str| move |s: &Output| s.value(key).to_string();
    markdown(
        scenes,
        &[
            ("narrow phase", &|s| s.method.to_owned()),
            ("time a frame, ms", &|s| format!("{:.3}", s.value("milliseconds"))),
            ("ratio", &|s| format!("{:.2}", s.value("milliseconds") / first)),
            ("supports a pair", &|s| format!("{:.2}", s.supports_per_query())),
            ("hits", &count("judged.hits")),
            ("contacts", &count("judged.contacts")),
            ("wrong", &|s| s.sum("put.missed put.spurious put.off").to_string()),
            ("largest error, mm", &|s| format!("{:.3}", 1e3 * s.value("put.error"))),
            ("of FCL's closed forms", &|s| format!("{:.3}", 1e3 * s.value("closed_form.error"))),
        ],
    )
}

/// Cost of `<ccd/fcl.hpp>` itself in a scene of 200 bodies, with one contact a pair.
pub struct HeaderCost {
    scene: &'static str,
    /// Over `fcl::collide` on libccd.
    time_ratio: f64,
    /// Instructions of a pair.
    instructions: f64,
    /// The share of instructions outside the library's functions, and so outside solver and callbacks.
    pub share: f64,
}

/// Measures the header; the times are the least of so many runs.
pub fn header_costs(rounds: usize) -> [HeaderCost; 3] {
    let [libccd, _, header, _] = consumers::fcl_scene(true);
    let methods = [libccd, header];
    ["mixed", "round", "hulls"].map(|scene| {
        let [libccd, header] = least_of(rounds, &methods, &format!("100 200 1 {scene}"), "timed.seconds");
        let command = methods[1].command(&format!("60 200 1 {scene}"));
        // Each toggle switches counting at entry and at exit.
        let count = |functions: &[&str]| {
            let toggles: Vec<_> = functions.iter().map(|name| format!("--toggle-collect={name}")).collect();
            let toggles: Vec<_> = toggles.iter().map(String::as_str).collect();
            let (written, dumps) = callgrind(&command, &toggles).unwrap_or_else(|error| panic!("{error}"));
            let totals = dumps.iter().flat_map(|dump| dump.lines()).filter_map(|line| line.strip_prefix("totals: "));
            (written.stdout, totals.map(|n| n.parse::<f64>().expect("a count")).sum::<f64>())
        };
        let callback = "*ccd_fcl::CollisionFunction*";
        let (text, all) = count(&[callback]);
        let (_, outside) = count(&[callback, "ccdPenetration", "ccdIntersect", "ccdContacts", "ccdSignedDistance"]);
        let pairs = crate::harness::fields(&text, "timed")["pairs"];
        HeaderCost { scene, time_ratio: header / libccd, instructions: all / pairs, share: outside / all }
    })
}

pub fn header_table(costs: &[HeaderCost]) -> String {
    markdown(
        costs,
        &[
            ("scene", &|c| c.scene.to_owned()),
            ("time ratio", &|c| format!("{:.2}", c.time_ratio)),
            ("instructions a pair", &|c| format!("{:.0}", c.instructions)),
            ("of them the header", &|c| format!("{:.1} %", 100.0 * c.share)),
        ],
    )
}

// --- whole programs -------------------------------------------------------------

/// Returns milliseconds of processor that a step of each consumer's program takes on either library: the
/// least of so many rounds in which the libraries take turns.
pub fn step_table(rounds: usize) -> String {
    let rows = CONSUMERS.map(|(title, file, arguments, steps)| {
        let methods = on_both(program(file).flag("-DTIMED"));
        let seconds = least_of(rounds, &methods, arguments, "processor.seconds");
        (title, seconds.map(|seconds| 1000.0 * seconds / steps))
    });
    markdown(
        &rows,
        &[
            ("program", &|(title, _)| (*title).to_owned()),
            ("libccd, ms a step", &|(_, [theirs, _])| format!("{theirs:.3}")),
            ("here", &|(_, [_, ours])| format!("{ours:.3}")),
            ("ratio", &|(_, [theirs, ours])| format!("{:.2}", ours / theirs)),
        ],
    )
}

/// Runs and judges an ODE scene by the three methods of [`consumers::ode_world`].
pub fn world(libccd: Method, scene: &str, starts: usize, steps: usize, bodies: usize) -> Simulation {
    let methods = consumers::ode_world(libccd);
    let mut simulation = simulate(scene, &methods, starts, steps, &format!("{bodies} {scene}"));
    judge_contacts(&mut simulation);
    simulation
}

/// Judges several contacts a pair, which are to hold as well as libccd's one at its worst.
fn judge_contacts(simulation: &mut Simulation) {
    let [theirs, _, several] = &simulation.runs[..] else { unreachable!() };
    simulation.failures.extend(several.iter().flat_map(|run| run.nonzero("pile.escaped pile.bad own.limits")));
    for key in ["pile.gained", "pile.deepest"] {
        let (median, most) = (median(several, key), range(theirs, key).1);
        if !(median <= most) {
            simulation.failures.push(format!("{key}: median {median}, libccd's largest {most}"));
        }
    }
}

/// Returns a row for each simulation and method; medians of the starts but for the deepest contact of all.
pub fn simulation_table(simulations: &[Simulation]) -> String {
    type Row<'a> = (&'a Simulation, &'a [Output]);
    let rows: Vec<Row> = simulations.iter().flat_map(|s| s.runs.iter().map(move |runs| (s, runs.as_slice()))).collect();
    let sum = |(_, runs): &Row, key| values(runs, key).iter().sum::<f64>();
    let columns: [Column<Row>; 8] = [
        ("scene", &|(s, _)| s.scene.clone()),
        ("starts × steps", &|(s, runs)| format!("{} × {}", runs.len(), s.steps)),
        ("library", &|(_, runs)| runs[0].method.to_owned()),
        ("energy gained, J", &|(_, runs)| format!("{:.3}", median(runs, "pile.gained"))),
        ("deepest contact, mm", &|(_, runs)| format!("{:.1}", 1e3 * median(runs, "pile.deepest"))),
        ("of all starts", &|(_, runs)| format!("{:.1}", 1e3 * range(runs, "pile.deepest").1)),
        ("supports a query", &|row| format!("{:.1}", sum(row, "own.supports") / sum(row, "own.queries"))),
        ("> 1 % too deep", &|row| match row.1[0].get("own.deep") {
            None => String::new(),
            Some(_) => format!("{} of {}", sum(row, "own.deep"), sum(row, "own.queries")),
        }),
    ];
    let failures: Vec<_> =
        simulations.iter().flat_map(|s| s.failures.iter().map(|f| format!("{}: {f}\n", s.scene))).collect();
    markdown(&rows, &columns) + &failures.concat()
}
