// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the scenes that are judged before a release alone, and prints the counters of all as tables.

use super::consumers::{self, CONSUMERS};
use super::programs::{Method, Output, compared, on_both, program, run_all};
use super::results::{median, most, values};
use crate::pages::markdown;

// --- single queries -------------------------------------------------------------

/// Returns a row for each library.
pub fn collide_table(title: &str, outputs: &[Output]) -> String {
    let keys = ["counted.judged", "own.missed", "own.deep", "own.spurious own.broken own.unsound"];
    let line = |o: &Output| [vec![o.method.to_owned()], keys.map(|keys| o.sum(keys).to_string()).into()].concat();
    markdown(&format!("{title}|queries|missed|> 1 % too deep|false, broken, unsound"), outputs.iter().map(line))
}

/// The sets of pairs of `fcl_distance`.
pub const DISTANCE_SETS: [&str; 4] = ["configurations", "kissing", "random", "round"];

pub fn distance_table(outputs: &[Output]) -> String {
    let line = |(set, o): (&str, &Output)| {
        let count = |key: &str| o.value(&format!("{set}.{key}"));
        let wrong = count("wrong") + count("outside");
        let counts = [count("queries"), count("threw"), count("endless"), wrong, count("unequal")];
        let time = format!("{:.1}", count("microseconds"));
        [vec![set.to_owned(), o.method.to_owned()], counts.map(|n| n.to_string()).into(), vec![time]].concat()
    };
    let rows = DISTANCE_SETS.iter().flat_map(|set| outputs.iter().map(move |output| (*set, output)));
    markdown("pairs||pairs|threw|endless|wrong|unequal|µs a distance", rows.map(line))
}

/// The counters of wrong answers.
pub const WRONG: &str = "own.missed own.spurious own.broken own.deep own.unsound";

// --- FCL by use -----------------------------------------------------------------

/// How FCL is used: its name in `fcl_scene`, what a reader calls it, kinds of bodies, frames, number of pairs, and the most
/// contacts of a query.
type FclUse = (&'static str, &'static str, &'static [&'static str], usize, usize, usize);

const CONVEX: &[&str] = &["primitives", "hulls"];
const CONCAVE: &[&str] = &["mesh", "octree", "octree-mesh"];

const FCL_USES: [FclUse; 6] = [
    ("yes-no", "yes or no, random poses", CONVEX, 200, 120, 1000),
    ("touching", "contacts of touching bodies", CONVEX, 100, 120, 1000),
    ("through", "contacts of bodies that drift through each other", CONVEX, 150, 120, 1000),
    ("random", "contacts in random poses", CONVEX, 100, 120, 1000),
    ("random", "one contact in random poses", CONCAVE, 200, 60, 1),
    ("random", "up to 100 contacts in random poses", CONCAVE, 30, 40, 100),
];

/// Returns what a reader calls a kind of bodies.
fn bodies_title(bodies: &str) -> &str {
    match bodies {
        "mesh" => "mesh and primitive",
        "octree" => "octree and primitive",
        "octree-mesh" => "octree and mesh",
        bodies => bodies,
    }
}

/// FCL's narrow phases in one use and with one kind of bodies.
pub struct FclCost {
    pub row: String,
    /// FCL's own narrow phase on either library, by its answers.
    pub judged: [Output; 2],
    /// Time over that on libccd: median of the rounds.
    ratios: [f64; 4],
}

/// Judges each use of FCL with every kind of bodies in a tenth of the frames, and times it in so many rounds, in which
/// the narrow phases take turns.
pub fn fcl_costs(rounds: usize) -> Vec<FclCost> {
    let judged = compared(program("fcl_scene.cpp"), "1").map(|method| method.first("0"));
    let timed = consumers::fcl_scene();
    let rows = FCL_USES.iter().flat_map(|row| row.2.iter().map(move |bodies| (row, *bodies)));
    let cost = |((name, title, _, frames, count, most), bodies): (&FclUse, &str)| {
        let judged = run_all(&judged, &format!("{name} {bodies} {} {count} {most}", frames / 10));
        let arguments = format!("{name} {bodies} {frames} {count} {most}");
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
        FclCost { row: format!("{title} | {}", bodies_title(bodies)), judged, ratios }
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

/// A scene on both libraries, from several slightly different starts.
pub struct Simulation {
    pub scene: &'static str,
    pub steps: usize,
    /// On libccd and on this library, by start.
    pub runs: [Vec<Output>; 2],
}

/// Runs a scene from starts 1, 2, …, `starts`; `arguments` are those after SEED and STEPS.
pub fn simulate(
    scene: &'static str,
    methods: &[Method; 2],
    starts: usize,
    steps: usize,
    arguments: &str,
) -> Simulation {
    let mut runs = [Vec::new(), Vec::new()];
    for seed in 1..=starts {
        eprintln!("{scene}: start {seed} of {starts}");
        for (runs, output) in runs.iter_mut().zip(run_all(methods, &format!("{seed} {steps} {arguments}"))) {
            runs.push(output);
        }
    }
    Simulation { scene, steps, runs }
}

/// Returns a row for each simulation, both libraries in each cell; the energy gained is the median of the starts.
pub fn simulation_table(simulations: &[Simulation]) -> String {
    let line = |simulation: &Simulation| {
        let runs = &simulation.runs;
        let cell = |has_it: bool, of: &dyn Fn(&[Output]) -> String| match has_it {
            true => format!("{} → {}", of(&runs[0]), of(&runs[1])),
            false => String::new(),
        };
        let sum = |runs: &[Output], key| values(runs, key).iter().sum::<f64>();
        let has_pile = runs[0][0].get("pile.gained").is_some();
        vec![
            simulation.scene.to_owned(),
            format!("{} × {}", runs[0].len(), simulation.steps),
            cell(has_pile, &|runs| format!("{:.3}", median(runs, "pile.gained"))),
            cell(has_pile, &|runs| format!("{:.1}", 1e3 * most(runs, "pile.deepest"))),
            cell(true, &|runs| format!("{} of {}", sum(runs, "own.deep"), sum(runs, "own.queries"))),
        ]
    };
    let head = "scene|starts × steps|energy gained, J|deepest contact, mm|> 1 % too deep, of one query in ten";
    markdown(head, simulations.iter().map(line))
}
