// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the scenes that are judged before a release alone, and prints the counters of all as tables.

// Comparisons are negated so that NaN counts as a failure.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

use super::consumers::{self, CONSUMERS};
use super::programs::{Method, Output, compared, on_both, program, run_all};
use super::results::{Simulation, median, range, simulate, values};
use crate::pages::markdown;

// --- single queries -------------------------------------------------------------

/// Returns a row for each library.
pub fn collide_table(title: &str, outputs: &[Output]) -> String {
    let keys = ["counted.judged", "own.missed", "own.deep", "own.spurious own.broken own.unsound"];
    let line = |o: &Output| [vec![o.method.to_owned()], keys.map(|keys| o.sum(keys).to_string()).into()].concat();
    markdown(&format!("{title}|queries|missed|> 1 % too deep|false, broken, unsound"), outputs.iter().map(line))
}

/// The sets of pairs of `fcl_distance`.
pub const DISTANCE_SETS: [&str; 3] = ["configurations", "kissing", "random"];

pub fn distance_table(outputs: &[Output]) -> String {
    let line = |(set, o): (&str, &Output)| {
        let count = |key: &str| o.value(&format!("{set}.{key}"));
        let counts = [count("queries"), count("threw"), count("endless"), count("wrong") + count("outside")];
        let time = format!("{:.1}", count("microseconds"));
        [vec![set.to_owned(), o.method.to_owned()], counts.map(|n| n.to_string()).into(), vec![time]].concat()
    };
    let rows = DISTANCE_SETS.iter().flat_map(|set| outputs.iter().map(move |output| (*set, output)));
    markdown("pairs||pairs|threw|endless|wrong|µs a distance", rows.map(line))
}

/// The counters of wrong answers.
pub const WRONG: &str = "own.missed own.spurious own.broken own.deep own.unsound";

// --- FCL by use -----------------------------------------------------------------

/// How FCL is used: its name in `fcl_scene`, what a reader calls it, frames and number of pairs.
const FCL_USES: [(&str, &str, usize, usize); 4] = [
    ("yes-no", "yes or no, random poses", 200, 120),
    ("touching", "contacts of touching bodies", 100, 120),
    ("through", "contacts of bodies that drift through each other", 150, 120),
    ("random", "contacts in random poses", 100, 120),
];

/// FCL's narrow phases in one use and with one kind of bodies.
pub struct FclCost {
    pub row: String,
    /// FCL's own narrow phase on either library, by its answers.
    pub judged: [Output; 2],
    /// Time over that on libccd: median of the rounds.
    ratios: [f64; 4],
}

/// Judges each use of FCL with primitives and with hulls in a tenth of the frames, and times it in so many rounds, in which
/// the narrow phases take turns.
pub fn fcl_costs(rounds: usize) -> Vec<FclCost> {
    let judged = compared(program("fcl_scene.cpp"), "1").map(|method| method.first("0"));
    let timed = consumers::fcl_scene();
    let rows = FCL_USES.iter().flat_map(|row| ["primitives", "hulls"].map(|bodies| (row, bodies)));
    let cost = |((name, title, frames, count), bodies): (&(&str, &str, usize, usize), &str)| {
        let judged = run_all(&judged, &format!("{name} {bodies} {} {count}", frames / 10));
        let arguments = format!("{name} {bodies} {frames} {count}");
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
    100.0 * output.sum(WRONG) / output.sum("own.hits own.missed")
}

pub fn fcl_table(costs: &[FclCost]) -> String {
    let line = |cost: &FclCost| {
        let wrong = cost.judged.each_ref().map(|output| format!("{:.1} %", wrong_percent(output)));
        let times = cost.ratios[1..].iter().map(|ratio| format!("{ratio:.2}"));
        [cost.row.clone()].into_iter().chain(wrong).chain(times).collect()
    };
    let head = "use|bodies|libccd wrong|here wrong|swap: time|`ccd/fcl.hpp`, one contact|up to 8";
    markdown(head, costs.iter().map(line))
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

/// Returns milliseconds of processor that a step of each consumer's program takes on either library: the mean of so many
/// starts, of each the least of so many rounds in which the libraries take turns.
pub fn step_table(rounds: usize, starts: usize) -> String {
    let line = |(title, file, arguments, steps): (&str, &str, &str, f64)| {
        let methods = on_both(program(file));
        let mut sums = [0.0; 2];
        for start in 1..=starts {
            let arguments = arguments.replace("START", &start.to_string());
            let seconds = least_of(rounds, &methods, &arguments, "processor.seconds");
            sums.iter_mut().zip(seconds).for_each(|(sum, seconds)| *sum += seconds);
        }
        let [theirs, ours] = sums.map(|sum| 1000.0 * sum / (steps * starts as f64));
        vec![title.to_owned(), format!("{theirs:.3}"), format!("{ours:.3}"), format!("{:.2}", ours / theirs)]
    };
    markdown("program|libccd, ms a step|here|ratio", CONSUMERS.map(line))
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
    let line = |(simulation, runs): (&Simulation, &Vec<Output>)| {
        let sum = |key| values(runs, key).iter().sum::<f64>();
        let deep = runs[0].get("own.deep").map(|_| format!("{} of {}", sum("own.deep"), sum("own.queries")));
        vec![
            simulation.scene.clone(),
            format!("{} × {}", runs.len(), simulation.steps),
            runs[0].method.to_owned(),
            format!("{:.3}", median(runs, "pile.gained")),
            format!("{:.1}", 1e3 * median(runs, "pile.deepest")),
            format!("{:.1}", 1e3 * range(runs, "pile.deepest").1),
            format!("{:.1}", sum("own.supports") / sum("own.queries")),
            deep.unwrap_or_default(),
        ]
    };
    let head = "scene|starts × steps|library|energy gained, J|deepest contact, mm|of all starts|supports a query|\
                > 1 % too deep";
    markdown(head, simulations.iter().flat_map(|s| s.runs.iter().map(move |runs| (s, runs))).map(line))
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
