// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the scenes that are judged before a release alone, and prints the counters of all as tables.

// Comparisons are negated so that NaN counts as a failure.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

use super::consumers::{self, CONSUMERS};
use super::programs::{Method, Output, on_both, program, run_all};
use super::results::{Simulation, median, range, simulate, values};

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
    let sum = |keys: &'static str| move |o: &Output| o.sum(keys).to_string();
    markdown(
        outputs,
        &[
            (title, &|o| o.method.to_owned()),
            ("queries", &sum("counted.judged")),
            ("missed", &sum("own.missed")),
            ("> 1 % too deep", &sum("own.deep")),
            ("false, broken, unsound", &sum("own.spurious own.broken own.unsound")),
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

// --- FCL by use -----------------------------------------------------------------

/// How FCL is used: its name in `fcl_scene`, what a reader calls it, frames and number of pairs or bodies.
pub const FCL_USES: [(&str, &str, usize, usize); 5] = [
    ("yes-no", "yes or no, random poses", 200, 120),
    ("touching", "contacts of touching bodies", 100, 120),
    ("through", "contacts of bodies that drift through each other", 150, 100),
    ("random", "contacts in random poses", 100, 120),
    ("mesh", "contacts of a mesh of 128 triangles", 10, 60),
];

/// FCL's narrow phases in one use and with one kind of bodies.
pub struct FclCost {
    pub row: String,
    /// By their answers.
    pub judged: [Output; 4],
    /// Time over that on libccd: median of the rounds.
    ratios: [f64; 4],
}

/// Judges each use of FCL with primitives and with hulls, and times it in so many rounds, in which the narrow phases
/// take turns. The frames are divided by `part`.
pub fn fcl_costs(rounds: usize, part: usize) -> Vec<FclCost> {
    let [judged, timed] = [false, true].map(consumers::fcl_scene);
    let rows = FCL_USES.iter().flat_map(|row| ["primitives", "hulls"].map(|bodies| (row, bodies)));
    let cost = |((name, title, frames, count), bodies): (&(&str, &str, usize, usize), &str)| {
        let judged = run_all(&judged, &format!("{name} {bodies} {} {count} 100", (frames / 10).div_ceil(part)));
        let arguments = format!("{name} {bodies} {frames} {count} 1");
        let mut seconds = [const { Vec::new() }; 4];
        for _ in 0..rounds {
            for (method, seconds) in timed.iter().zip(&mut seconds) {
                seconds.push(method.run(&arguments).value("timed.seconds"));
            }
        }
        let ratios = seconds.each_ref().map(|ours| {
            let mut ratios: Vec<_> = ours.iter().zip(&seconds[0]).map(|(ours, theirs)| ours / theirs).collect();
            ratios.sort_by(f64::total_cmp);
            ratios.get(rounds / 2).copied().unwrap_or(f64::NAN)
        });
        FclCost { row: format!("{title} | {bodies}"), judged, ratios }
    };
    rows.map(cost).collect()
}

/// Returns the share of wrong answers, in percent of the hits and misses of overlapping pairs.
fn wrong_percent(output: &Output) -> f64 {
    let wrong = output.sum("put.missed put.spurious put.broken put.deep put.unsound");
    100.0 * wrong / output.sum("put.hits put.missed")
}

pub fn fcl_table(costs: &[FclCost]) -> String {
    let ratio = |method: usize| move |cost: &FclCost| format!("{:.2}", cost.ratios[method]);
    markdown(
        costs,
        &[
            ("use | bodies", &|cost| cost.row.clone()),
            ("libccd wrong", &|cost| format!("{:.1} %", wrong_percent(&cost.judged[0]))),
            ("here wrong", &|cost| format!("{:.1} %", wrong_percent(&cost.judged[1]))),
            ("swap: time", &ratio(1)),
            ("`ccd/fcl.hpp`, one contact", &ratio(2)),
            ("up to 8", &ratio(3)),
        ],
    )
    .replacen("|---|", "|---|---|", 1)
}

// --- whole programs -------------------------------------------------------------

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
    markdown(&rows, &columns)
}

/// Faults of a scene on either library: scene, counter and reason. Known if libccd has them in as many starts.
const KNOWN: [(&str, &str, &str); 1] =
    [("DART over ODE", "pile.escaped", "the first impacts, which are deep, throw a body out of the pen")];

/// Returns a line for each known fault of the simulations, and the failures that are not known.
pub fn failures(simulations: &[Simulation]) -> (String, Vec<String>) {
    let (mut known, mut failures) = (String::new(), Vec::new());
    for Simulation { scene, runs, failures: all, .. } in simulations {
        let starts = |method: usize, key| values(&runs[method], key).iter().filter(|n| **n != 0.0).count();
        let is_known = |key| starts(1, key) <= starts(0, key);
        let reason = KNOWN.iter().find(|(name, key, _)| name == scene && is_known(key));
        let unknown = all.iter().filter(|text| reason.is_none_or(|(_, key, _)| !text.contains(key)));
        failures.extend(unknown.map(|text| format!("{scene}: {text}")));
        if let Some((_, key, why)) = reason.filter(|(_, key, _)| starts(1, key) > 0) {
            let [theirs, ours] = [0, 1].map(|method| starts(method, key));
            known += &format!("{scene}, known: {key} in {theirs} starts on libccd, {ours} here: {why}\n");
        }
    }
    (known, failures)
}
