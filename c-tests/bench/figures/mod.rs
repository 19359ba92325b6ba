// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts: speed against accuracy, the paper redone, coherence, and where the
//! time goes; each as CSV, and as a picture or a table.

pub mod accuracy;
pub mod coherence;
pub mod engines;
pub mod figure;
pub mod instructions;
pub mod paper;
pub mod results;

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::measuring::csv;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{self, Row};
use crate::measuring::methods::Method;
use crate::measuring::scene::Scene;
use crate::peers::Compiled;
use figure::{Axis, Curve, Look, Mark, Unit};

#[derive(Args)]
pub struct Options {
    /// Fewer poses, tolerances and repetitions: two minutes.
    #[arg(long)]
    pub quick: bool,
    /// Leave out the instruction counts (which run this program under valgrind).
    #[arg(long)]
    pub no_instructions: bool,
    /// The figures of this name alone, as `coherence`; the others stay as they are.
    #[arg(long)]
    pub only: Option<String>,
    /// Where CSV and pictures go.
    #[arg(long, default_value = OUT)]
    pub out: PathBuf,
}

const OUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/charts");

impl Options {
    pub fn default_out() -> PathBuf {
        PathBuf::from(OUT)
    }
}

/// Inputs of every measurement.
pub struct Bench<'a> {
    pub libraries: &'a Libraries,
    pub compiled: &'a Compiled,
    pub quick: bool,
}

/// Where figures, pictures and the text about them go, and what was measured where and when.
pub struct Page {
    pub out: PathBuf,
    pub machine: String,
}

impl Page {
    pub fn file(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }

    /// The line under a picture: date, machine, versions.
    pub fn footer(&self) -> String {
        let (place, rest) = self.machine.split_once("; ").unwrap_or((&self.machine, ""));
        let version = rest.split(" (").next().unwrap_or("");
        format!("thick: this library; {place}; {version}; all in one process, rustc and gcc -O3")
    }

    /// None where the file is missing, as instructions.csv without valgrind.
    fn read<T: DeserializeOwned>(&self, name: &str) -> Vec<T> {
        csv::read(&self.file(&format!("{name}.csv")))
    }
}

impl Bench<'_> {
    /// Poses of a pair set.
    pub fn poses(&self) -> usize {
        if self.quick { 100 } else { usize::MAX }
    }

    pub fn repetitions(&self) -> usize {
        if self.quick { 3 } else { 9 }
    }
}

/// A method's look, the same in every picture. Ours are bold, a colour a query: MPR blue,
/// local amber, minimum green; libccd's are red, the paper's purple, the rest grey.
pub fn look(row: &Row) -> Look {
    let (colour, mark, bold) = match (row.method.as_str(), row.start.as_str()) {
        ("local, climbing", _) => ((217, 119, 6), Mark::Triangle, true),
        ("local", "45") => ((244, 170, 40), Mark::Ring, true),
        ("local", _) => ((217, 119, 6), Mark::Dot, true),
        ("minimum", _) => ((22, 145, 70), Mark::Dot, true),
        ("MPR" | "MPR warm", _) => ((37, 99, 235), Mark::Triangle, true),
        ("libccd MPR", _) => ((239, 68, 68), Mark::Triangle, false),
        ("libccd EPA", _) => ((153, 27, 27), Mark::Dot, false),
        ("Algorithm 4/5", "45") => ((190, 130, 240), Mark::Ring, false),
        ("Algorithm 4/5", _) => ((147, 51, 234), Mark::Dot, false),
        ("Algorithm 3", _) => ((147, 51, 234), Mark::Cross, false),
        ("Bullet EPA", _) => (GREY, Mark::Dot, false),
        ("FCL EPA", _) => (GREY, Mark::Ring, false),
        ("MuJoCo 3 ccd", _) => (TEAL, Mark::Dot, false),
        ("Coal 3 EPA", _) => (TEAL, Mark::Ring, false),
        ("Jolt 5 EPA", _) => (TEAL, Mark::Cross, false),
        ("DEEP", _) => ((219, 39, 119), Mark::Triangle, false),
        _ => (GREY, Mark::Triangle, false),
    };
    Look::new(colour, mark, bold)
}

const TEAL: (u8, u8, u8) = (13, 148, 136);
const GREY: (u8, u8, u8) = (107, 114, 128);

pub const SUPPORTS: Axis = ("support points per query", Unit::Count);
pub const TIME: Axis = ("time per query", Unit::Seconds);

/// Cost of a query, on either axis.
pub type Cost = fn(&Row) -> Option<f64>;

pub const COUNTED: Cost = |r| Some(r.supports);
pub const TIMED: Cost = |r| r.ns.map(|n| n * 1e-9);

/// A curve a method: what it costs over `x`.
pub fn curves<'a>(rows: impl IntoIterator<Item = &'a Row>, x: Cost, cost: Cost) -> Vec<Curve> {
    let point = |r: &'a Row| Some((name(r), look(r), (x(r)?, cost(r)?)));
    figure::curves(rows.into_iter().filter_map(point))
}

/// The sets that rows are about, each once.
pub fn sets(rows: &[Row]) -> Vec<&str> {
    let mut sets: Vec<&str> = Vec::new();
    for row in rows {
        if !sets.contains(&row.set.as_str()) {
            sets.push(&row.set);
        }
    }
    sets
}

/// A method's name in pictures: the call, or the paper's or the other library's.
pub fn name(row: &Row) -> String {
    named(&row.method, &row.start)
}

/// The same, before it has run.
pub fn name_of(method: &Method) -> String {
    named(&method.name, method.start.name())
}

fn named(method: &str, start: &str) -> String {
    let start = match start {
        "" => String::new(),
        "warm" => ", warm".to_owned(),
        "centres" => ", cold".to_owned(),
        degrees => format!(", guess {degrees}° off"),
    };
    let call = match method {
        "MPR" => "ccdMPRPenetration, cold",
        "MPR warm" => "ccdMPRPenetrationWarm",
        "GJK" => "ccdGJKPenetration",
        "MPR intersect" => "ccdMPRIntersect",
        "local" => "ccdPenetrationLocal",
        "local, climbing" => "ccdPenetrationLocal, climbing",
        "minimum" => "ccdPenetrationProven",
        "distance" => "ccdSignedDistance",
        "libccd MPR" => "libccd ccdMPRPenetration",
        "libccd EPA" => "libccd ccdGJKPenetration",
        "libccd MPR intersect" => "libccd ccdMPRIntersect",
        "Algorithm 4/5" => "Gao 2023, Algorithm 4/5",
        "Algorithm 3" => "Gao 2023, Algorithm 3",
        other => other,
    };
    format!("{call}{start}")
}

/// A pair set's name in words.
pub fn kind(set: &str) -> String {
    let mut parts = set.split('_');
    let shape = |s: Option<&str>| match s.unwrap_or("") {
        "sph" => "sphere".to_owned(),
        "cap" => "capsule".to_owned(),
        "cyl" => "cylinder".to_owned(),
        "ell" => "ellipsoid".to_owned(),
        s => match s.strip_prefix('p') {
            Some(n) => format!("{n} vertices"),
            None => s.to_owned(),
        },
    };
    let (a, b) = (shape(parts.next()), shape(parts.next()));
    format!("{a} – {b}")
}

/// Times and judges `methods` on a scene.
pub fn rows(bench: &Bench, scene: &Scene, mut methods: Vec<Method>, x: Option<f64>) -> Vec<Row> {
    let ns = measure::times(scene, &mut methods, bench.repetitions());
    let judged = methods.iter_mut().zip(ns).map(|(method, ns)| Row {
        ns: Some(ns),
        x,
        ..measure::judge(bench.libraries, scene, method)
    });
    judged.collect()
}

/// The pictures and the page from the figures that are there.
pub fn redraw(options: &Options) {
    let page = Page { out: options.out.clone(), machine: csv::origin(&options.out.join("accuracy.csv")) };
    let (sets, vertices) = (page.read("accuracy"), page.read("vertices"));
    accuracy::draw(&page, &sets);
    paper::draw(&page, &vertices);
    let tables = [
        ("MACHINE", page.machine.clone()),
        ("FASTER", results::times_faster(&sets)),
        ("COHERENCE", results::coherent(&page.read("coherence"))),
        ("INSTRUCTIONS", results::instructions(&page.read("instructions"))),
    ];
    results::write(&page, &tables);
}

pub fn run(options: &Options) {
    let libraries = Libraries::open();
    let compiled = Compiled::build(&libraries);
    std::fs::create_dir_all(&options.out).expect("the folder for the charts");
    let bench = Bench { libraries: &libraries, compiled: &compiled, quick: options.quick };
    let machine = libraries.machine();
    println!("{machine}");
    for (name, why) in &compiled.missing {
        let why = why.lines().next().unwrap_or("");
        println!("not measured here: {name}: {why}");
    }
    let wanted = |name: &str| match &options.only {
        Some(only) => only == name,
        None => name != "instructions" || !options.no_instructions,
    };
    fn keep<T: Serialize>(file: PathBuf, machine: &str, rows: Vec<T>) {
        if !rows.is_empty() {
            csv::write(&file, machine, &rows);
        }
    }
    // Each is written as it comes.
    macro_rules! measure {
        ($($name:literal: $measure:path),*) => {$(
            if wanted($name) {
                let file = options.out.join(concat!($name, ".csv"));
                keep(file, &machine, $measure(&bench));
            }
        )*};
    }
    measure!(
        "accuracy": accuracy::measure, "vertices": paper::vertices,
        "coherence": coherence::measure,
        "instructions": instructions::measure
    );
    redraw(options);
}
