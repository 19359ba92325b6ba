// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Judges the counters of the programs and prints them as tables. The tests (`swap.rs`) and the
//! tables (`table.rs`) share it.

// Each driver uses a part. Comparisons are negated so that NaN counts as a failure.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use super::programs::{self, CONSUMERS, Column, Method, Output, markdown, program, run_all};
use crate::harness::callgrind;

/// The deepest overlap that libccd's MPR takes for a miss: two of its tolerances, metres.
const LIBCCD_MISS_DEPTH: f64 = 2e-6;

/// Largest part of the depth by which ccdMPRPenetration's may exceed the minimum.
const MPR_REL_TOL: f64 = 0.003;

/// The largest share of a simulation's depths that are more than 1 % too deep, by a local minimum or a search
/// that stopped early.
const MAX_DEEP_SHARE: f64 = 2e-3;

/// The counters of wrong depths and directions.
const WRONG: [&str; 4] = ["spurious", "broken", "deep", "unsound"];

// --- single queries -------------------------------------------------------------

fn wrong_of(output: &Output, line: &str) -> f64 {
    WRONG.iter().map(|key| output.value(&format!("{line}.{key}"))).sum()
}

/// Returns why the answers of `collide` on this library, the second, are worse than allowed.
pub fn collide_failures([theirs, ours]: &[Output; 2]) -> Vec<String> {
    let all = |output: &Output| output.sum("collide.queries invalid_support.queries poses.threw");
    assert_eq!(all(theirs), all(ours), "not the same queries");
    let mut failures = ours.wrong();
    // The program's own results, before FCL or ODE has read them.
    failures.extend(ours.nonzero("counted.broken"));
    let mut expect = |is_right: bool, what: &str| {
        if !is_right {
            failures.push(format!("{what}:\n{}{}", theirs.text, ours.text));
        }
    };
    expect(ours.value("poses.threw") <= theirs.value("poses.threw"), "exceptions");
    expect(theirs.value("collide.deepest_miss") <= LIBCCD_MISS_DEPTH, "libccd misses more than two tolerances");
    expect(ours.value("collide.excess") <= MPR_REL_TOL, "too deep");
    // Where the engine's callback is wrong: a contact must not be missed, and no greater share of the depths be wrong.
    let share =
        |output: &Output| wrong_of(output, "invalid_support") / output.value("invalid_support.queries").max(1.0);
    expect(ours.value("invalid_support.missed") == 0.0, "misses with a wrong callback");
    expect(share(ours) <= share(theirs), "wrong depths with a wrong callback");
    failures
}

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
    let mut scenes = programs::fcl_scene(false).map(|method| method.run(&arguments));
    let least = least_of(rounds, &programs::fcl_scene(true), &arguments, "timed.seconds");
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
    let [libccd, _, header, _] = programs::fcl_scene(true);
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
        let methods = programs::on_both(program(file).flag("-DTIMED"));
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

/// A scene from several slightly different starts, by some methods.
pub struct Simulation {
    scene: String,
    steps: usize,
    /// By method and start.
    runs: Vec<Vec<Output>>,
    pub failures: Vec<String>,
}

/// Runs a scene from starts 1, 2, …, `starts`; `arguments` are those after SEED and STEPS.
pub fn simulate<const N: usize>(
    scene: &str,
    methods: &[Method; N],
    starts: usize,
    steps: usize,
    arguments: &str,
) -> Simulation {
    let mut runs: Vec<_> = methods.iter().map(|_| Vec::new()).collect();
    for seed in 1..=starts {
        eprintln!("{scene}: start {seed} of {starts}");
        for (runs, output) in runs.iter_mut().zip(run_all(methods, &format!("{seed} {steps} {arguments}"))) {
            runs.push(output);
        }
    }
    Simulation { scene: scene.to_owned(), steps, runs, failures: Vec::new() }
}

/// Runs and judges a scene on both libraries.
pub fn swapped(scene: &str, methods: &[Method; 2], starts: usize, steps: usize, arguments: &str) -> Simulation {
    let mut simulation = simulate(scene, methods, starts, steps, arguments);
    simulation.judge();
    simulation
}

/// Runs and judges an ODE scene by the three methods of [`programs::ode_world`].
pub fn world(libccd: Method, scene: &str, starts: usize, steps: usize, bodies: usize) -> Simulation {
    let methods = programs::ode_world(libccd);
    let mut simulation = simulate(scene, &methods, starts, steps, &format!("{bodies} {scene}"));
    simulation.judge_contacts();
    simulation
}

fn values(runs: &[Output], key: &str) -> Vec<f64> {
    let mut values: Vec<f64> = runs.iter().map(|run| run.value(key)).collect();
    values.sort_by(f64::total_cmp);
    values
}

fn median(runs: &[Output], key: &str) -> f64 {
    let values = values(runs, key);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

/// Returns the least and the largest.
fn range(runs: &[Output], key: &str) -> (f64, f64) {
    let values = values(runs, key);
    (values[0], values[values.len() - 1])
}

impl Simulation {
    fn judge(&mut self) {
        let [theirs, ours] = &self.runs[..] else { unreachable!() };
        let forbidden = "pile.escaped pile.bad counted.broken counted.contradicted own.slanted own.missed own.spurious \
                         own.unsound";
        self.failures.extend(ours.iter().flat_map(|run| run.nonzero(forbidden)));
        let sum = |keys: &str| ours.iter().map(|run| run.sum(keys)).sum::<f64>();
        let (deep, judged) = (sum("own.deep"), sum("own.queries"));
        if !(deep <= MAX_DEEP_SHARE * judged) {
            self.failures.push(format!("{deep} of {judged} depths too deep"));
        }
        if theirs.len() < 10 {
            return; // too few starts to speak of a spread
        }
        for key in ["pile.kinetic", "pile.depth"] {
            let (least, most) = range(theirs, key);
            let width = most - least;
            // The same in ratios: nothing is below zero to fail the difference.
            let floor = (least - width).max(least * least / most);
            let median = median(ours, key);
            if !(floor <= median && median <= most + width) {
                self.failures.push(format!("{key}: median {median:e}, libccd {least:e} to {most:e}"));
            }
        }
    }

    /// Judges several contacts a pair, which are to hold as well as libccd's one at its worst.
    fn judge_contacts(&mut self) {
        let [theirs, _, several] = &self.runs[..] else { unreachable!() };
        self.failures.extend(several.iter().flat_map(|run| run.nonzero("pile.escaped pile.bad own.limits")));
        for key in ["pile.gained", "pile.deepest"] {
            let (median, most) = (median(several, key), range(theirs, key).1);
            if !(median <= most) {
                self.failures.push(format!("{key}: median {median}, libccd's largest {most}"));
            }
        }
    }

    /// Judges a scene at rest: energy gained, J, and the deepest contact, metres, of this library's runs,
    /// are at most these.
    pub fn judge_rest(&mut self, gained: f64, deepest: f64) {
        for (key, bound) in [("pile.gained", gained), ("pile.deepest", deepest)] {
            let most = range(&self.runs[1], key).1;
            if !(most <= bound) {
                self.failures.push(format!("{key} {most}, at most {bound} expected"));
            }
        }
    }

    pub fn assert_passes(&self) {
        assert!(self.failures.is_empty(), "{}:\n{}", self.scene, self.failures.join("\n"));
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
