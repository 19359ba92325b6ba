// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the consumers' programs on the system's libccd and on this library, judges
//! what they say, and makes rows of the swap table. Shared by the test (`swap.rs`)
//! and by the command that prints the table (`table.rs`).

// Each driver uses a part. Comparisons are negated so that NaN counts against.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use crate::harness::{Executable, Program, fields};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The deepest overlap that libccd's MPR takes for a miss: two of its tolerances.
const LOST: f64 = 2e-6;

/// What ccdMPRPenetration may leave above the minimum, of the depth.
const MPR_GAP: f64 = 0.003;

/// The share of a simulation's contacts that a local minimum, or a search that stopped
/// early, may put off the truth.
const OFTEN_OFF: f64 = 2e-3;

/// A program on one library.
#[derive(Clone)]
pub struct Way {
    pub name: &'static str,
    /// Whose answers it goes on with, in compare.sh's words.
    side: &'static str,
    program: Executable,
    /// Its command line's last words.
    more: &'static str,
}

impl Way {
    pub fn new(name: &'static str, side: &'static str, program: Executable) -> Way {
        Way { name, side, program, more: "" }
    }

    pub fn with(mut self, more: &'static str) -> Way {
        self.more = more;
        self
    }

    /// What it writes. Its first line names the library found in the process.
    pub fn said(&self, args: &str) -> String {
        let args = args.split_whitespace().chain(self.more.split_whitespace());
        let said = self.program.run(args).stdout;
        let expected = if self.side == "theirs" { "library libccd" } else { "library warmccd " };
        assert!(said.starts_with(expected), "{}: on `{:?}`", self.name, said.lines().next());
        said
    }
}

/// Output of every way, side by side.
fn run_all(ways: &[Way], args: &str) -> Vec<String> {
    std::thread::scope(|scope| {
        let runs: Vec<_> = ways.iter().map(|w| scope.spawn(|| w.said(args))).collect();
        runs.into_iter().map(|run| run.join().expect("a run")).collect()
    })
}

/// One program of a consumer's, on libccd and on this library.
pub struct Swapped {
    pub consumer: &'static str,
    pub ways: [Way; 2],
}

impl Swapped {
    /// Watched by compare.sh, which judges one query in `every`.
    fn new(consumer: &'static str, program: Program, every: &str) -> Swapped {
        let program = program.flag("-rdynamic").link_system().without_tools();
        let program = program.build().quiet();
        let theirs = program.compared(&["--no-times", "--every", every]);
        let ours = theirs.with_options(&["--swap"]);
        Swapped { consumer, ways: [Way::new("libccd", "theirs", theirs), Way::new("this library", "ours", ours)] }
    }

    /// For judges of this library alone: libccd's side is not watched, and so nothing is judged there.
    pub fn theirs_unjudged(mut self) -> Swapped {
        self.ways[0].program = self.ways[0].program.uncompared();
        self
    }

    pub fn run(&self, args: &str) -> Vec<String> {
        run_all(&self.ways, args)
    }
}

fn c(source: &str) -> Program {
    Program::c(source).standard("gnu99").source(format!("engines/{source}.c"))
}

pub fn cpp(source: &str) -> Program {
    Program::cpp(source)
        .source(format!("engines/{source}.cpp"))
        .flag("-D_GNU_SOURCE")
        .flag("-isystem/usr/include/eigen3")
}

/// Of each kind of body, on either library: how far FCL's contact positions are off, metres rms.
pub fn fcl_positions() -> Vec<(String, [f64; 2])> {
    let program = Swapped::new("FCL", cpp("fcl_position").library("fcl"), "0");
    let rms = |line: &str| {
        let words: Vec<&str> = line.strip_prefix("position ")?.split(' ').collect();
        Some((words[0].to_owned(), words[4].parse().expect("metres")))
    };
    let said = program.run("1 200");
    let both = said[0].lines().filter_map(rms).zip(said[1].lines().filter_map(rms));
    both.map(|((kind, a), (_, b))| (kind, [a, b])).collect()
}

pub fn fcl_static() -> Swapped {
    Swapped::new("FCL", cpp("fcl_static").library("fcl"), "0")
}

pub fn ode_static() -> Swapped {
    Swapped::new("ODE", c("ode_static").library("ode"), "0")
}

pub fn ode_pile() -> Swapped {
    Swapped::new("ODE", c("ode_pile").library("ode"), "1")
}

pub fn mujoco_pile() -> Swapped {
    Swapped::new("MuJoCo", c("mujoco_pile").library("mujoco"), "1")
}

pub fn dart_pile() -> Swapped {
    Swapped::new("DART", cpp("dart_pile").library("dart"), "1")
}

/// A program of each consumer's: its title, and its arguments, of which one is the number of steps.
fn consumers() -> [(&'static str, Program, &'static str, f64); 4] {
    let scene = cpp("fcl_scene").library("fcl").flag("-DTIMED");
    let dart = cpp("dart_pile").library("dart");
    let mujoco = c("mujoco_pile").library("mujoco");
    let ode = c("ode_pile").library("ode");
    [
        ("ODE, a pile", ode, "1 1500 32 pile", 1500.0),
        ("MuJoCo 2, a pile", mujoco, "1 1500 30 pile", 1500.0),
        ("DART over FCL, a pile", dart, "1 3000 15 fcl", 3000.0),
        ("FCL, bodies that drift", scene, "300 200 0 0", 300.0),
    ]
}

/// compare.sh's screens of a program of each consumer's, as they come.
pub fn screens() -> [String; 4] {
    consumers().map(|(_, program, args, _)| {
        let program = program.link_system().without_tools().build().quiet();
        let told = program.compared(&[]).with_screen().run(args.split(' '));
        let path = program.path.to_string_lossy();
        let name = path.rsplit('/').next().unwrap_or_default();
        let name = name.split('-').next().unwrap_or_default();
        let told = told.stderr.replace(&*path, &format!("./{name} {args}"));
        // What the program says itself comes before.
        let text = told.find("== ").map_or("", |at| &told[at..]);
        text.trim().to_owned()
    })
}

/// Processor time of this process' ended children, seconds, in the kernel's hundredths.
fn children_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name, which may hold anything: fields 16 and 17 of proc(5), from field 3 on.
    let fields = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks = fields.split_whitespace().skip(13).take(2);
    ticks.filter_map(|t| t.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Milliseconds of processor that a step of each consumer's program takes on either library: the
/// least of some rounds in which the libraries take turns.
pub fn step_table(rounds: usize) -> String {
    let mut out = String::from("| program | libccd, ms a step | here | ratio |\n|---|---|---|---|\n");
    for (title, program, args, steps) in consumers() {
        let system = program.link_system().without_tools().build().quiet();
        let ways = [system.swapped(), system];
        let mut least = [f64::INFINITY; 2];
        for _ in 0..rounds {
            for (way, least) in ways.iter().zip(&mut least) {
                let before = children_seconds();
                way.run(args.split(' '));
                *least = least.min(children_seconds() - before);
            }
        }
        let [ours, theirs] = least.map(|seconds| 1000.0 * seconds / steps);
        let _ = writeln!(out, "| {title} | {theirs:.3} | {ours:.3} | {:.2} |", ours / theirs);
    }
    out
}

/// A line of figures that a program writes, or compare.sh.
type Run = BTreeMap<String, f64>;

/// Of these keys those that are told, and are not to be.
fn told_of(run: &Run, keys: &str) -> Vec<String> {
    let told = keys.split(' ').filter(|key| run.get(*key).is_some_and(|n| *n != 0.0));
    told.map(|key| format!("{key}: {}", run[key])).collect()
}

// --- static queries -------------------------------------------------------------

/// FCL's or ODE's answers, counted by the program against exact truth: on libccd, on this library.
#[derive(Debug)]
pub struct Static {
    pub what: &'static str,
    pub collide: [Run; 2],
    asked: [Run; 2],
    /// Where a callback of the consumer's own was wrong, so that no answer can be right.
    pub astray: [Run; 2],
    /// Why this library may not replace the other, one line each.
    pub against: Vec<String>,
}

pub fn judge_collide(what: &'static str, said: &[String]) -> Static {
    let both = |name: &str| [0, 1].map(|i| fields(&said[i], name));
    let (collide, astray, asked) = (both("collide"), both("astray"), both("asked"));
    let all = |i: usize| collide[i]["queries"] + astray[i]["queries"] + asked[i]["threw"];
    assert_eq!(all(0), all(1), "{what}: not the same was asked");
    let wrong = said[1].lines().filter(|line| line.starts_with("wrong: "));
    let mut against: Vec<String> = wrong.map(String::from).collect();
    // Of the program's own answers, before FCL or ODE has read them.
    against.extend(told_of(&fields(&said[1], "watched"), "zero not_finite not_unit"));
    if asked[1]["threw"] > asked[0]["threw"] {
        against.push(format!("threw: {asked:?}"));
    }
    if !(collide[0]["lost"] <= LOST) {
        against.push(format!("libccd loses {} m", collide[0]["lost"]));
    }
    if !(collide[1]["excess"] <= MPR_GAP) {
        against.push(format!("too deep by {} of the depth", collide[1]["excess"]));
    }
    // A contact must not be lost, and no greater share of the depths be off.
    let off = |run: &Run| -> f64 {
        let off = ["spurious", "broken", "deep", "unsound"].map(|key| run[key]);
        off.iter().sum::<f64>() / run["queries"].max(1.0)
    };
    if astray[1]["missed"] > 0.0 || off(&astray[1]) > off(&astray[0]) {
        against.push(format!("wrong callbacks: {astray:?}"));
    }
    Static { what, collide, astray, asked, against }
}

/// FCL's signed distances, by GJK and EPA of its own on libccd's polytope functions: how many, and
/// of these how many differ; in which FCL threw, on either library; what speaks against this one.
pub fn judge_distances(said: &[String]) -> (usize, usize, [usize; 2], Vec<String>) {
    let of = |said: &str| -> Vec<[f64; 2]> {
        let told = said.lines().filter_map(|line| line.strip_prefix("distance "));
        let number = |word: &str| word.parse().expect("a distance");
        told.map(|line| line.split_once(' ').expect("two numbers"))
            .map(|(value, truth)| [value, truth].map(number))
            .collect()
    };
    let [theirs, ours] = [0, 1].map(|i| of(&said[i]));
    assert_eq!(theirs.len(), ours.len(), "not the same was asked");
    let (mut differ, mut threw, mut against) = (0, [0; 2], Vec::new());
    for ([there, _], [here, truth]) in theirs.iter().zip(&ours) {
        threw = [threw[0] + usize::from(there.is_nan()), threw[1] + usize::from(here.is_nan())];
        if !there.is_nan() && !((here - there).abs() <= 1e-6) {
            differ += 1;
            if !((here - truth).abs() <= (there - truth).abs()) {
                against.push(format!("{here}, libccd {there}, truth {truth}"));
            }
        }
    }
    (ours.len(), differ, threw, against)
}

/// A table's head and the rule below it.
pub fn head(columns: &[&str]) -> String {
    let rule = "---|".repeat(columns.len());
    format!("| {} |\n|{rule}\n", columns.join(" | "))
}

fn verdict(against: &[String]) -> String {
    match against.len() {
        0 => "passes".to_owned(),
        n => format!("**{n} against**"),
    }
}

// --- simulations ----------------------------------------------------------------

/// What the program says of its pile, and what compare.sh counts of the library whose answers
/// it went on with.
fn run_of(said: &str, side: &str) -> Run {
    let mut run = fields(said, "pile");
    if !said.contains("\nwatched ") {
        return run;
    }
    run.extend(fields(said, "watched"));
    for key in ["supports", "slanted", "missed", "spurious", "unsound"] {
        if let Some(count) = run.get(&format!("{side}_{key}")).copied() {
            run.insert(key.to_owned(), count);
        }
    }
    // Support points are counted of those that were judged, where not all were.
    let asked = *run.get("judged").unwrap_or(&run["queries"]);
    run.insert("asked".to_owned(), asked);
    // ODE's contacts against exact truth; those apart where a callback was wrong.
    if said.contains("\nright ") {
        let (right, astray) = (fields(said, "right"), fields(said, "astray"));
        let off = right["deep"] + right["unsound"];
        let told = [("judged", right["queries"]), ("lost", right["missed"])];
        let told = told.into_iter().chain([("spurious", right["spurious"]), ("off", off)]);
        run.extend(told.map(|(key, n)| (key.to_owned(), n)));
        run.insert("wrong_lost".to_owned(), astray["missed"]);
    }
    run
}

/// The same scene from several slightly moved starts, in each of some ways.
pub struct Piles {
    pub consumer: &'static str,
    pub scene: &'static str,
    names: Vec<&'static str>,
    steps: usize,
    runs: Vec<Vec<Run>>,
    pub against: Vec<String>,
}

/// From starts 1, 2, …, `starts`; `after` follows SEED and STEPS on the command line.
fn run_piles(
    (consumer, scene): (&'static str, &'static str),
    ways: &[Way],
    starts: usize,
    steps: usize,
    after: &str,
) -> Piles {
    let mut runs = vec![Vec::new(); ways.len()];
    for seed in 1..=starts {
        eprintln!("{consumer} {scene}: start {seed} of {starts}");
        let all = run_all(ways, &format!("{seed} {steps} {after}"));
        for ((way, said), runs) in ways.iter().zip(&all).zip(&mut runs) {
            runs.push(run_of(said, way.side));
        }
    }
    Piles { consumer, scene, names: ways.iter().map(|way| way.name).collect(), steps, runs, against: Vec::new() }
}

pub fn piles(program: &Swapped, scene: &'static str, starts: usize, steps: usize, after: &str) -> Piles {
    let of = (program.consumer, scene);
    let mut p = run_piles(of, &program.ways, starts, steps, after);
    p.judge();
    p
}

/// An ODE scene through libccd as ODE asks it (`ode_pile`), and through this library behind ODE's own class of
/// geoms, with one contact a pair and with several.
pub fn worlds(libccd: Swapped, scene: &'static str, starts: usize, steps: usize, bodies: usize) -> Piles {
    let world = c("ode_world").library("ode").flag("-D_GNU_SOURCE");
    let world = world.flag("-DOURS_ALONE").link_ours_shared();
    let world = world.without_tools().build().quiet();
    let [libccd, _] = libccd.ways;
    let ways = [
        libccd,
        Way::new("this library, one contact a pair", "ours", world.clone()).with("one"),
        Way::new("this library, `ccdContacts`", "ours", world).with("many"),
    ];
    let after = format!("{bodies} {scene}");
    let mut p = run_piles(("ODE, a world", scene), &ways, starts, steps, &after);
    p.judge_several();
    p
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    0.5 * (values[(n - 1) / 2] + values[n / 2])
}

impl Piles {
    /// A quantity over the starts; none where the program does not tell it.
    fn all(&self, way: usize, key: &str) -> Option<Vec<f64>> {
        self.runs[way].iter().map(|run| run.get(key).copied()).collect()
    }

    fn told(&self, way: usize, key: &str) -> Vec<f64> {
        let told = self.all(way, key);
        told.unwrap_or_else(|| panic!("no {key} from {}", self.consumer))
    }

    fn range(&self, way: usize, key: &str) -> (f64, f64) {
        let all = self.told(way, key);
        (all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    }

    fn judge(&mut self) {
        let none = "escaped bad zero not_finite not_unit slanted lost spurious wrong_lost missed unsound contradicted";
        self.against = self.runs[1].iter().flat_map(|run| told_of(run, none)).collect();
        if let Some(off) = self.all(1, "off") {
            let judged: f64 = self.told(1, "judged").iter().sum();
            if off.iter().sum::<f64>() > OFTEN_OFF * judged {
                self.against.push(format!("off: {off:?} of {judged}"));
            }
        }
        if self.runs[0].len() < 10 {
            return; // too few starts to speak of a spread
        }
        for key in ["kinetic", "depth"] {
            let (least, most) = self.range(0, key);
            let width = most - least;
            // The same in ratios: nothing is below zero to fail the difference.
            let floor = (least - width).max(least * least / most);
            let ours = median(self.told(1, key));
            if !(floor <= ours && ours <= most + width) {
                let there = self.names[0];
                let against = format!("{key}: median {ours:e}, {there} {least:e} to {most:e}");
                self.against.push(against);
            }
        }
    }

    /// Several contacts are to hold as well as libccd's one at its worst.
    fn judge_several(&mut self) {
        let none = |run| told_of(run, "escaped bad limits");
        self.against = self.runs[2].iter().flat_map(none).collect();
        for key in ["gained", "deepest"] {
            let (here, there) = (median(self.told(2, key)), self.range(0, key).1);
            if !(here <= there) {
                let against = format!("{key}: median {here}, libccd's largest {there}");
                self.against.push(against);
            }
        }
    }

    /// What speaks against a scene that is to stay as it is: gained, J, and the deepest contact,
    /// metres, of this library's runs, at most so much.
    pub fn restless(&self, gained: f64, deepest: f64) -> Vec<String> {
        let mut against = self.against.clone();
        for (key, bound) in [("gained", gained), ("deepest", deepest)] {
            let most = self.range(1, key).1;
            if !(most <= bound) {
                against.push(format!("{key} {most}, {bound} asked"));
            }
        }
        against
    }
}

/// What every simulation did, in each way; lengths in millimetres. A dash: the program does not
/// tell.
pub fn pile_table(rows: &[Piles]) -> String {
    let spreads = [("gained", 1.0), ("deepest", 1e3)];
    let sums = "queries bad zero not_finite not_unit escaped judged lost spurious off";
    let sums: Vec<&str> = sums.split(' ').collect();
    let first = "consumer|scene|starts × steps|library|supports a query";
    let first: Vec<&str> = first.split('|').collect();
    let middle = spreads.map(|(key, _)| key);
    let mut out = head(&[&first[..], &middle, &sums, &["swap"]].concat());
    for p in rows {
        for (way, name) in p.names.iter().enumerate() {
            let start = format!("{} × {}", p.runs[way].len(), p.steps);
            let [supports, asked] = ["supports", "asked"].map(|key| p.told(way, key).iter().sum::<f64>());
            let supports = format!("{:.1}", supports / asked);
            let cells = [p.consumer, p.scene, &start, name, &supports];
            let mut cells = cells.map(String::from).to_vec();
            cells.extend(spreads.map(|(key, unit)| {
                let (least, most) = p.range(way, key);
                let all = [median(p.told(way, key)), least, most].map(|x| x * unit);
                format!("{:.3} ({:.3} to {:.3})", all[0], all[1], all[2])
            }));
            cells.extend(sums.iter().map(|key| match p.all(way, key) {
                Some(all) => all.iter().sum::<f64>().to_string(),
                None => "–".to_owned(),
            }));
            cells.push(match way + 1 == p.names.len() {
                true => verdict(&p.against),
                false => String::new(),
            });
            let row = format!("| {} |\n", cells.join(" | "));
            // Compared with two others, this library has one row.
            if !out.contains(&row) {
                out.push_str(&row);
            }
        }
    }
    out
}
