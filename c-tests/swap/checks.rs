// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs the consumers' programs on the system's libccd and on this library, judges
//! what they say, and makes rows of the swap table. Shared by the test (`swap.rs`)
//! and by the command that prints the table (`table.rs`).

// Each driver uses a part. Comparisons are negated so that NaN counts against.
#![allow(dead_code, clippy::neg_cmp_op_on_partial_ord)]

use crate::harness::{Executable, Program, fields};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// FCL's, ODE's and MuJoCo's setting, metres.
const MPR_TOLERANCE: f64 = 1e-6;
/// What two answers within their tolerances may differ by: twice the tolerance, and a
/// hundredth of the depth.
fn verdict_tolerance(truth: f64) -> f64 {
    0.01 * truth.max(0.0) + 2.0 * MPR_TOLERANCE
}

/// What ccdMPRPenetration may leave above the minimum, of the depth.
const MPR_GAP: f64 = 0.003;

/// The share of a simulation's contacts that a local minimum, or a search that stopped
/// early, may put off the truth.
const OFTEN_OFF: f64 = 2e-3;

/// A depth or gap of this many sizes is neither hit nor miss.
const TOUCH: f64 = 1e-9;

/// libccd's MPR takes overlaps thinner than its tolerance for misses; beyond twice that
/// the two libraries must agree on hit or miss.
const AGREE: f64 = 2.0 * MPR_TOLERANCE;

/// One program of a consumer's, on either library.
pub struct Swapped {
    pub consumer: &'static str,
    /// What runs first: libccd, or what stands in for it.
    names: Both<&'static str>,
    runs: Both<Executable>,
}

/// What a program wrote on either library, system's first.
type Both<T> = [T; 2];

impl Swapped {
    /// Watched by compare.sh, which judges one query in `every`.
    fn new(consumer: &'static str, program: Program, every: &str) -> Swapped {
        let program = program.flag("-rdynamic").link_system().without_tools();
        let program = program.build().quiet();
        let options = ["--no-times", "--every", every];
        Swapped {
            consumer,
            names: ["libccd", "this library"],
            runs: [&options[..], &[&["--swap"], &options[..]].concat()]
                .map(|options| program.compared(options)),
        }
    }

    /// The same, held against this library's proven minima instead of libccd.
    pub fn against_minimum(mut self) -> Swapped {
        self.names[0] = "proven minimum";
        self.runs[0] = self.runs[1].with_option("--minimum");
        self
    }

    /// Runs on both libraries side by side. Each run's first line names the library
    /// that the program found in its process.
    pub fn run(&self, args: &[String]) -> Both<Vec<String>> {
        std::thread::scope(|scope| {
            let system = scope.spawn(|| self.lines(0, args));
            let ours = self.lines(1, args);
            [system.join().expect("the system's run"), ours]
        })
    }

    /// Runs on one library.
    fn lines(&self, library: usize, args: &[String]) -> Vec<String> {
        let program = &self.runs[library];
        let expected = match self.names[library] {
            "libccd" => "library libccd",
            _ => "library warmccd ",
        };
        let mut lines: Vec<String> = program.run(args).stdout.lines().map(String::from).collect();
        let name = lines.remove(0);
        assert!(
            name.starts_with(expected),
            "{} {args:?}: runs on `{name}`, not on `{expected}`",
            self.consumer
        );
        lines
    }
}

fn c(source: &str) -> Program {
    Program::c(source)
        .standard("gnu99")
        .source(format!("swap/{source}.c"))
}

pub fn cpp(source: &str) -> Program {
    Program::cpp(source)
        .source(format!("swap/{source}.cpp"))
        .flag("-D_GNU_SOURCE")
        .flag("-isystem/usr/include/eigen3")
}

/// Of each kind of body, on either library: how far FCL's contact positions are off, metres rms.
pub fn fcl_positions() -> Vec<(String, Both<f64>)> {
    let program = Swapped::new("FCL", cpp("fcl_position").library("fcl"), "0");
    let told = |line: &&String| line.starts_with("position ");
    let rms = |line: &String| -> (String, f64) {
        let words: Vec<&str> = line.split(' ').collect();
        (words[1].to_owned(), words[5].parse().expect("metres"))
    };
    let [theirs, ours] = program.run(&["1".to_owned(), "200".to_owned()]);
    let both = theirs
        .iter()
        .filter(told)
        .map(rms)
        .zip(ours.iter().filter(told).map(rms));
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

/// A program of a consumer's, and what compare.sh shows of it.
pub struct Screen {
    pub program: &'static str,
    pub text: String,
}

/// compare.sh's screens of a program of each consumer's, as they come.
pub fn screens() -> [Screen; 4] {
    let screen = |title: &'static str, program: Program, args: &str| {
        let program = program.link_system().without_tools().build().quiet();
        let told = program.compared(&[]).with_screen().run(args.split(' '));
        let path = program.path.to_string_lossy();
        let name = path.rsplit('/').next().unwrap_or_default();
        let name = name.split('-').next().unwrap_or_default();
        let told = told.stderr.replace(&*path, &format!("./{name} {args}"));
        // What the program says itself comes before.
        let text = told.find("== ").map_or("", |at| &told[at..]).trim();
        Screen {
            program: title,
            text: text.to_owned(),
        }
    };
    let scene = cpp("fcl_scene").library("fcl").flag("-DTIMED");
    let dart = cpp("dart_pile").library("dart");
    let mujoco = c("mujoco_pile").library("mujoco");
    [
        screen(
            "ODE, a pile",
            c("ode_pile").library("ode"),
            "1 1500 32 pile",
        ),
        screen("MuJoCo, a pile", mujoco, "1 1500 30 pile"),
        screen("DART over FCL, a pile", dart, "1 3000 15 fcl"),
        screen("FCL, bodies adrift", scene, "300 200 0 0"),
    ]
}

/// For the front page: the last lines of the first screen, and a row for each.
pub fn front_table(screens: &[Screen]) -> String {
    let first = &screens[0].text;
    let price = first.find("A support point of both").expect("a price");
    let mut out = format!(
        "```text\n{}\n```\n\n\
         | program | wrong of judged, libccd | here | support points a query, libccd | here | time a query | the whole program |\n\
         |---|---|---|---|---|---|---|\n",
        &first[price..]
    );
    for Screen { program, text } in screens {
        // The words behind a start of a line, and what stands between two texts.
        let row = |start: &str| -> Vec<f64> {
            let line = text.lines().filter_map(|line| line.strip_prefix(start));
            line.flat_map(|line| line.split_whitespace().map_while(|word| word.parse().ok()))
                .collect()
        };
        let between = |before: &str, after: &str| {
            let rest = text.split_once(before).map_or("", |(_, rest)| rest);
            rest.split_once(after).map_or("?", |(word, _)| word)
        };
        let sides = ["libccd ", "this library "].map(row);
        let wrong = |side: &[f64]| -> f64 { side[..5].iter().sum() };
        let _ = writeln!(
            out,
            "| {program} | {} of {} | {} | {:.1} | {:.1} | {} | {} |",
            wrong(&sides[0]),
            between("What the swap changes, of ", " judged"),
            wrong(&sides[1]),
            sides[0][7],
            sides[1][7],
            between("a query takes ", " times"),
            between("the program would take ", ".\n"),
        );
    }
    out
}

// --- static queries -------------------------------------------------------------

/// One line of a static program.
#[derive(Clone, Debug)]
struct Query {
    line: String,
    size: f64,
    lower: f64,
    upper: f64,
    outcome: u8,
    value: f64,
    normal: f64,
    callback_wrong: bool,
}

impl Query {
    fn hit(&self) -> bool {
        self.outcome == HIT
    }

    fn threw(&self) -> bool {
        self.outcome >= THREW
    }

    fn missed(&self) -> bool {
        self.outcome == 0
    }

    /// Under a wrong callback, against the shape that was meant: a hit across a gap of more than
    /// [`AGREE`], or a depth that is wrong by more than `verdict_tolerance`.
    fn off(&self) -> bool {
        let least = self.lower - AGREE;
        let most = self.upper.max(0.0) + verdict_tolerance(self.upper);
        // Negated, so that NaN counts.
        let right = self.upper >= -AGREE && self.value >= least && self.value <= most;
        self.hit() && !right
    }
}

const HIT: u8 = 1;
const THREW: u8 = 2;

fn queries(lines: &[String], what: &str) -> BTreeMap<u64, Query> {
    lines
        .iter()
        .filter(|line| line.starts_with(what))
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let number = |i: usize| -> f64 {
                let word = words.get(i).copied().unwrap_or("0");
                word.parse().unwrap_or_else(|e| panic!("{line}: {e}"))
            };
            let query = Query {
                line: line.clone(),
                size: number(4),
                lower: number(5),
                upper: number(6),
                outcome: number(7) as u8,
                value: number(8),
                normal: number(9),
                callback_wrong: number(10) != 0.0,
            };
            (number(3) as u64, query)
        })
        .collect()
}

/// Counts over a set of static queries, for each library, by what is counted:
///
/// | | |
/// |---|---|
/// | missed, spurious | overlaps and gaps answered otherwise |
/// | deep | deeper than the truth by more than `verdict_tolerance` |
/// | unsound | depth below the truth by more than 2 tolerances |
/// | broken | direction not unit, or depth not a number |
/// | deeper | than libccd's answer, by more than two tolerances and [`MPR_GAP`] |
/// | threw | the consumer threw, or an assertion of its own failed |
/// | disagree | one library hits and the other misses; and of these, where the depth or gap is more than [`AGREE`] |
/// | wrong | a callback of the consumer's own was wrong, so that the query is about no convex shape: no answer can be right, but a contact must not be lost (wrong missed), and libccd must not do better (wrong off) |
/// | differ | signed distances that differ by more than 1e-6 |
#[derive(Debug)]
pub struct Static {
    pub consumer: &'static str,
    pub what: &'static str,
    pub kinds: usize,
    pub queries: usize,
    counts: BTreeMap<&'static str, Both<usize>>,
    /// Why this library may not replace the other, one line each.
    pub against: Vec<String>,
}

impl Static {
    fn of(consumer: &'static str, what: &'static str, runs: &Both<BTreeMap<u64, Query>>) -> Static {
        let same = runs[0].keys().eq(runs[1].keys());
        assert!(same, "{consumer}: the two runs did not ask the same");
        let kinds = |q: &Query| -> Vec<String> {
            let words = q.line.split(' ').skip(1).take(2);
            words.map(String::from).collect()
        };
        let kinds: BTreeSet<Vec<String>> = runs[1].values().map(kinds).collect();
        Static {
            consumer,
            what,
            kinds: kinds.len(),
            queries: runs[1].len(),
            counts: BTreeMap::new(),
            against: Vec::new(),
        }
    }

    /// Of either library.
    pub fn both(&self, key: &str) -> Both<usize> {
        self.counts.get(key).copied().unwrap_or_default()
    }

    fn count(&mut self, key: &'static str, is: Both<bool>) {
        let counts = self.counts.entry(key).or_default();
        for (count, is) in counts.iter_mut().zip(is) {
            *count += usize::from(is);
        }
    }

    /// Counts what this library's answer is not to be.
    fn forbid(&mut self, key: &'static str, is: Both<bool>, ours: &Query) {
        self.count(key, is);
        if is[1] {
            self.against.push(format!("{key}: {}", ours.line));
        }
    }

    pub fn verdict(&self) -> String {
        match self.against.len() {
            0 => "passes".to_owned(),
            n => format!("**{n} against**"),
        }
    }

    /// `libccd's / this library's`.
    fn cell(&self, key: &str) -> String {
        let [theirs, ours] = self.both(key);
        format!("{theirs} / {ours}")
    }
}

/// FCL's or ODE's yes, no and depth.
pub fn judge_collide(
    consumer: &'static str,
    what: &'static str,
    lines: &Both<Vec<String>>,
) -> Static {
    let runs = lines.each_ref().map(|l| queries(l, "collide"));
    let mut s = Static::of(consumer, what, &runs);
    for (system, ours) in runs[0].values().zip(runs[1].values()) {
        let Query {
            size, lower, upper, ..
        } = *ours;
        let both = |is: &dyn Fn(&Query) -> bool| [is(system), is(ours)];
        // Negated, so that NaN counts.
        let broken = |q: &Query| !((q.normal - 1.0).abs() < 1e-9) || !q.value.is_finite();
        s.forbid("broken", both(&|q| q.hit() && broken(q)), ours);
        s.count("threw", both(&Query::threw));
        s.forbid(
            "threw alone",
            [false, ours.threw() && !system.threw()],
            ours,
        );
        if system.callback_wrong || ours.callback_wrong {
            s.count("wrong", [true; 2]);
            s.count("wrong missed", both(&|q| q.lower > AGREE && q.missed()));
            s.count("wrong off", both(&Query::off));
            continue;
        }
        let disagree = system.hit() != ours.hit();
        let clearly = disagree && !(lower <= AGREE && upper >= -AGREE);
        s.forbid("disagree", [disagree, clearly], ours);
        let (overlap, apart) = (lower > TOUCH * size, upper < -TOUCH * size);
        let deep = upper.max(0.0) + verdict_tolerance(upper);
        s.count("hits", both(&Query::hit));
        s.count("deep", both(&|q| q.hit() && q.value > deep));
        s.forbid("missed", both(&|q| overlap && q.missed()), ours);
        s.forbid("spurious", both(&|q| apart && q.hit()), ours);
        let unsound = lower - 2.0 * MPR_TOLERANCE;
        s.forbid("unsound", both(&|q| q.hit() && q.value < unsound), ours);
        let most = (1.0 + MPR_GAP) * system.value + 2.0 * MPR_TOLERANCE;
        let deeper = ours.hit() && system.hit() && !(ours.value <= most);
        s.forbid("deeper", [false, deeper], ours);
    }
    let off = s.both("wrong off");
    if s.both("wrong missed")[1] > 0 || off[1] > off[0] {
        s.against.push(format!("wrong callbacks: {:?}", s.counts));
    }
    s
}

const DISTANCE: &str = "signed distance";

/// FCL's signed distance: GJK and EPA of its own on libccd's polytope functions.
pub fn judge_distance(consumer: &'static str, lines: &Both<Vec<String>>) -> Static {
    let runs = lines.each_ref().map(|l| queries(l, "distance"));
    let mut s = Static::of(consumer, DISTANCE, &runs);
    for (system, ours) in runs[0].values().zip(runs[1].values()) {
        let both = |is: &dyn Fn(&Query) -> bool| [is(system), is(ours)];
        s.count("threw", both(&Query::threw));
        s.forbid(
            "threw alone",
            [false, ours.threw() && !system.threw()],
            ours,
        );
        s.forbid(
            "broken",
            both(&|q| !q.threw() && !q.value.is_finite()),
            ours,
        );
        s.count("hits", both(&|q| !q.threw() && q.value < 0.0));
        if system.threw() || ours.threw() {
            continue;
        }
        let differ = !((ours.value - system.value).abs() <= 1e-6);
        let exact = -0.5 * (ours.lower + ours.upper);
        let farther = !((ours.value - exact).abs() <= (system.value - exact).abs());
        s.forbid("differ", [differ, differ && farther], ours);
    }
    s
}

/// How long FCL's own EPA takes on either library's polytope functions: a sentence. The
/// least processor time of three runs.
pub fn epa_time(program: &Swapped, args: &[String]) -> String {
    let mut least = [f64::INFINITY; 2];
    let mut queries = 0.0;
    for _ in 0..3 {
        for (library, least) in least.iter_mut().enumerate() {
            let timed = fields(&program.lines(library, args), "timed");
            queries = timed["queries"];
            *least = least.min(1e-3 * timed["nanoseconds"] / queries);
        }
    }
    let [theirs, ours] = least;
    format!(
        "FCL's signed distance where objects overlap ({queries} queries, its own EPA on the polytope functions): \
         {theirs:.1} us a query on libccd, {ours:.1} us on this library ({:.2} times).",
        ours / theirs
    )
}

/// The static half of the swap table.
pub fn static_table(rows: &[Static]) -> String {
    let mut out = String::from(
        "| consumer | query | pairs of kinds | queries | hits | missed overlaps | spurious hits \
         | hit on one alone (beyond 2 tolerances) | > 1 % too deep | deeper than libccd | unsound \
         | NaN or zero normal | consumer threw | wrong callbacks: missed, wrong depth | distances that differ | swap |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for s in rows {
        let ([all, clear], [_, deeper]) = (s.both("disagree"), s.both("deeper"));
        let wrong = s.both("wrong")[0];
        let (missed, off) = (s.cell("wrong missed"), s.cell("wrong off"));
        let cells = match s.what {
            DISTANCE => ["–"; 7].map(String::from),
            _ => [
                s.cell("missed"),
                s.cell("spurious"),
                format!("{all} ({clear})"),
                s.cell("deep"),
                deeper.to_string(),
                s.cell("unsound"),
                format!("{wrong}: {missed}, {off}"),
            ],
        };
        let [missed, spurious, disagree, deep, deeper, unsound, wrong] = cells;
        let differ = match s.what {
            DISTANCE => s.both("differ")[0].to_string(),
            _ => "–".to_owned(),
        };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {missed} | {spurious} | {disagree} | {deep} | {deeper} \
             | {unsound} | {} | {} | {wrong} | {differ} | {} |",
            s.consumer,
            s.what,
            s.kinds,
            s.queries,
            s.cell("hits"),
            s.cell("broken"),
            s.cell("threw"),
            s.verdict(),
        );
    }
    out
}

// --- simulations ----------------------------------------------------------------

/// One simulation: what the program says of its pile, and what compare.sh counts.
type Run = BTreeMap<String, f64>;

/// What compare.sh counts of each library.
const SIDE: [&str; 5] = ["supports", "slanted", "missed", "spurious", "unsound"];

/// `side`: whose answers the program went on with, in compare.sh's words.
fn run_of(lines: &[String], side: &str) -> Run {
    let mut run = fields(lines, "watched");
    for key in SIDE {
        if let Some(count) = run.get(&format!("{side}_{key}")).copied() {
            run.insert(key.to_owned(), count);
        }
    }
    // Support points are counted of those that were judged, where not all were.
    let asked = run.get("judged").or(run.get("queries")).copied();
    run.insert("asked".to_owned(), asked.unwrap_or_default());
    run.extend(fields(lines, "pile"));
    run
}

/// The same scene from several slightly moved starts, on what runs first and on this library; of
/// ODE worlds in a third way.
pub struct Piles {
    pub consumer: &'static str,
    names: Vec<&'static str>,
    pub scene: &'static str,
    pub steps: usize,
    runs: Vec<Vec<Run>>,
    pub against: Vec<String>,
}

/// Runs starts 1, 2, …, `starts`; `after` follows SEED and STEPS on the command line.
pub fn piles(
    program: &Swapped,
    scene: &'static str,
    starts: usize,
    steps: usize,
    after: &str,
) -> Piles {
    let mut p = Piles::new(program.consumer, &program.names, scene, steps);
    for seed in 1..=starts {
        eprintln!("{} {scene}: start {seed} of {starts}", program.consumer);
        let both = program.run(&pile_args(seed, steps, after));
        for (i, lines) in both.iter().enumerate() {
            let run = run_of(lines, p.side(i));
            p.runs[i].push(run);
        }
    }
    p.judge();
    p
}

/// As [`piles`], but this library's runs take over libccd's in the middle, and the second
/// halves are compared.
///
/// Which bodies come to lie on which is decided by the first impacts, where libccd's
/// depths are the farthest off: from its own start a pile may settle in another way on
/// each library, for good reason, and one body that lies on a face, held by one contact
/// that hops from corner to corner, can make most of the mean depth. From one state both
/// must keep the same pile. (From its own start a pile of this library must be as with
/// [`Swapped::against_minimum`].)
pub fn taken_over(
    program: &Swapped,
    scene: &'static str,
    starts: usize,
    steps: usize,
    after: &str,
) -> Piles {
    let mut p = Piles::new(program.consumer, &program.names, scene, steps);
    let file = tempfile::NamedTempFile::new().expect("a file for the state");
    let state = file.path().to_string_lossy();
    for seed in 1..=starts {
        eprintln!("{} {scene}: start {seed} of {starts}", program.consumer);
        for (library, way) in ["save", "load"].into_iter().enumerate() {
            let mut args = pile_args(seed, steps, after);
            args.extend([way.to_owned(), state.to_string()]);
            let run = run_of(&program.lines(library, &args), p.side(library));
            p.runs[library].push(run);
        }
    }
    p.judge();
    p
}

/// An ODE scene through libccd as ODE asks it, and through this library behind ODE's own class of
/// geoms, with one contact a pair and with several.
pub fn worlds(scene: &'static str, starts: usize, steps: usize, bodies: usize) -> Piles {
    let ode = ode_pile();
    let world = c("ode_world")
        .library("ode")
        .flag("-D_GNU_SOURCE")
        .flag("-DOURS_ALONE")
        .link_ours_shared()
        .without_tools()
        .build()
        .quiet();
    let names = [
        "libccd",
        "this library, one contact a pair",
        "this library, `ccdContacts`",
    ];
    let mut p = Piles::new("ODE, a world", &names, scene, steps);
    for seed in 1..=starts {
        eprintln!("{scene}: start {seed} of {starts}");
        let args = pile_args(seed, steps, &format!("{bodies} {scene}"));
        p.runs[0].push(run_of(&ode.lines(0, &args), "theirs"));
        for (way, contacts) in [(1, "one"), (2, "many")] {
            let said = world.run(args.iter().map(String::as_str).chain([contacts]));
            let lines: Vec<String> = said.stdout.lines().map(String::from).collect();
            p.runs[way].push(run_of(&lines, "ours"));
        }
    }
    p.judge_several();
    p
}

fn pile_args(seed: usize, steps: usize, after: &str) -> Vec<String> {
    let all = format!("{seed} {steps} {after}");
    all.split(' ').map(String::from).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    0.5 * (values[(n - 1) / 2] + values[n / 2])
}

impl Piles {
    fn new(
        consumer: &'static str,
        names: &[&'static str],
        scene: &'static str,
        steps: usize,
    ) -> Self {
        Self {
            consumer,
            names: names.to_vec(),
            scene,
            steps,
            runs: vec![Vec::new(); names.len()],
            against: Vec::new(),
        }
    }

    /// Whose answers a run goes on with.
    fn side(&self, way: usize) -> &'static str {
        match self.names[way] {
            "libccd" => "theirs",
            "proven minimum" => "minimum",
            _ => "ours",
        }
    }

    /// Not every program tells everything.
    fn has(&self, way: usize, key: &str) -> bool {
        self.runs[way][0].contains_key(key)
    }

    /// A quantity over the starts.
    fn all(&self, way: usize, key: &str) -> Vec<f64> {
        let of = |run: &Run| run.get(key).copied();
        let told = self.runs[way].iter().map(of);
        told.map(|x| x.unwrap_or_else(|| panic!("no {key} from {}", self.consumer)))
            .collect()
    }

    fn sum(&self, way: usize, key: &str) -> f64 {
        self.all(way, key).iter().sum()
    }

    fn range(&self, way: usize, key: &str) -> (f64, f64) {
        let all = self.all(way, key);
        (
            all.iter().copied().fold(f64::INFINITY, f64::min),
            all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// These are to be none.
    fn judge_none(&mut self, way: usize, keys: &[&str]) {
        for key in keys {
            if self.has(way, key) && self.sum(way, key) != 0.0 {
                self.against
                    .push(format!("{key}: {:?}", self.all(way, key)));
            }
        }
    }

    fn judge(&mut self) {
        let none = "escaped bad zero not_finite not_unit slanted lost spurious wrong_lost missed unsound contradicted";
        self.judge_none(1, &none.split(' ').collect::<Vec<_>>());
        if self.has(1, "off") && self.sum(1, "off") > OFTEN_OFF * self.sum(1, "judged") {
            self.against.push(format!("off: {:?}", self.all(1, "off")));
        }
        if self.runs[0].len() < 10 {
            return; // too few starts to speak of a spread
        }
        for key in ["kinetic", "depth"] {
            let (least, most) = self.range(0, key);
            let width = most - least;
            // The same in ratios: nothing is below zero to fail the difference.
            let floor = (least - width).max(least * least / most);
            let ours = median(self.all(1, key));
            // Negated, so that NaN counts.
            if !(floor <= ours && ours <= most + width) {
                self.against.push(format!(
                    "{key}: median {ours:e}, {} {least:e} to {most:e}",
                    self.names[0]
                ));
            }
        }
    }

    /// Several contacts are to hold as well as libccd's one at its worst.
    fn judge_several(&mut self) {
        for key in ["gained", "deepest"] {
            let (here, there) = (median(self.all(2, key)), self.range(0, key).1);
            if !(here <= there) {
                self.against
                    .push(format!("{key}: median {here}, libccd's largest {there}"));
            }
        }
        self.judge_none(2, &["escaped", "bad", "limits"]);
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

/// What every simulation did, in each way; depths in millimetres. A dash: the program does not
/// tell.
pub fn pile_table(rows: &[Piles]) -> String {
    let mut out = String::from(
        "| consumer | scene | starts × steps | library | penetration queries | hits | supports a query \
         | NaN, zero or bent normals, exceptions, warnings | escaped | energy gained, J: median (min to max) \
         | kinetic energy, J: median (min to max) | mean contact depth, mm: median (min to max) | deepest, mm: median (max) \
         | pairs judged | contacts lost | contacts spurious | depths off by > 1 % and 2 tolerances | largest error of a depth, mm \
         | wrong callbacks: pairs, lost, spurious | error, mm | swap |\n",
    );
    out += &format!("|{}\n", "---|".repeat(21));
    for p in rows {
        for (way, name) in p.names.iter().enumerate() {
            let told = |key: &str, text: &dyn Fn() -> String| match p.has(way, key) {
                true => text(),
                false => "–".to_owned(),
            };
            let sum = |key: &str| told(key, &|| p.sum(way, key).to_string());
            let most = |key: &str| told(key, &|| format!("{:.4}", 1e3 * p.range(way, key).1));
            let spread = |key: &str, unit: f64| {
                told(key, &|| {
                    let (least, most) = p.range(way, key);
                    let [middle, least, most] =
                        [median(p.all(way, key)), least, most].map(|x| x * unit);
                    format!("{middle:.3} ({least:.3} to {most:.3})")
                })
            };
            let bad = ["bad", "zero", "not_finite", "not_unit"];
            let bad = bad.iter().filter(|key| p.has(way, key));
            let row = format!(
                "| {} | {} | {} × {} | {name} | {} | {} | {:.1} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                p.consumer,
                p.scene,
                p.runs[way].len(),
                p.steps,
                sum("queries"),
                sum("hits"),
                p.sum(way, "supports") / p.sum(way, "asked"),
                bad.map(|key| p.sum(way, key)).sum::<f64>(),
                sum("escaped"),
                spread("gained", 1.0),
                spread("kinetic", 1.0),
                spread("depth", 1e3),
                spread("deepest", 1e3),
                sum("judged"),
                sum("lost"),
                sum("spurious"),
                sum("off"),
                most("error"),
                ["wrong", "wrong_lost", "wrong_spurious"]
                    .map(sum)
                    .join(", "),
                most("wrong_error"),
                match (way + 1 == p.names.len(), p.against.is_empty()) {
                    (false, _) => String::new(),
                    (true, true) => "passes".to_owned(),
                    (true, false) => format!("**{}**", p.against.join("; ")),
                },
            );
            // Compared with two others, this library has one row.
            if !out.contains(&row) {
                out.push_str(&row);
            }
        }
    }
    out
}
