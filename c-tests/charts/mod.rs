// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts: speed against accuracy, the paper redone, coherence, models and
//! tolerances, and where the time goes; each as CSV and as a picture.

pub mod accuracy;
pub mod coherence;
pub mod figure;
pub mod models;
pub mod paper;
pub mod phases;
pub mod results;
pub mod split;

use std::path::PathBuf;

use clap::Args;
use plotters::style::RGBColor;

use crate::lab::libraries::Libraries;
use crate::lab::measure::Row;
use crate::lab::methods::Method;
use crate::lab::peers::Compiled;
use crate::lab::progress;
use figure::{Look, Mark};

#[derive(Args)]
pub struct Options {
    /// Fewer poses, tolerances and repetitions: two minutes.
    #[arg(long)]
    pub quick: bool,
    /// Leave out the instruction counts (which run this program under valgrind).
    #[arg(long)]
    pub no_instructions: bool,
    /// Where CSV and pictures go.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/c-tests/charts"))]
    pub out: PathBuf,
}

/// What every chart needs.
pub struct Bench<'a> {
    pub libraries: &'a Libraries,
    pub compiled: &'a Compiled,
    pub quick: bool,
    pub out: PathBuf,
}

impl Bench<'_> {
    /// Poses of a pair set.
    pub fn poses(&self) -> usize {
        if self.quick { 100 } else { usize::MAX }
    }

    pub fn repetitions(&self) -> usize {
        if self.quick { 3 } else { 9 }
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }

    pub fn write_csv(&self, name: &str, rows: &[Row]) {
        progress::write_csv(&self.file(name), self.libraries, rows);
    }

    /// The last line of a legend: what, where, when.
    pub fn notes(&self) -> Vec<String> {
        progress::short(self.libraries)
    }
}

/// A method's colour and mark, the same in every picture: ours blue and green,
/// libccd red, the paper's purple, the rest in earth.
pub fn look(row: &Row) -> Look {
    let (r, g, b, mark, bold) = match (row.method.as_str(), row.start.as_str()) {
        ("local", "warm") => (14, 124, 134, Mark::Dot, true),
        ("local", "centres" | "45") => (96, 165, 250, Mark::Ring, true),
        ("local", _) => (37, 99, 235, Mark::Dot, true),
        ("minimum", "warm") => (74, 180, 100, Mark::Ring, true),
        ("minimum", _) => (22, 145, 70, Mark::Dot, true),
        ("MPR", _) => (70, 130, 180, Mark::Triangle, true),
        ("MPR warm", _) => (100, 149, 180, Mark::Cross, true),
        ("libccd MPR", _) => (240, 110, 60, Mark::Triangle, false),
        ("libccd EPA", _) => (220, 38, 38, Mark::Dot, false),
        ("Algorithm 4/5", "45") => (190, 130, 240, Mark::Ring, false),
        ("Algorithm 4/5", _) => (147, 51, 234, Mark::Dot, false),
        ("Algorithm 3", _) => (147, 51, 234, Mark::Cross, false),
        ("DEEP", _) => (219, 39, 119, Mark::Triangle, false),
        ("Bullet EPA", _) => (161, 98, 7, Mark::Dot, false),
        ("FCL EPA", _) => (202, 138, 4, Mark::Ring, false),
        ("Coal EPA", _) => (13, 180, 180, Mark::Cross, false),
        ("parry EPA", _) => (120, 113, 108, Mark::Triangle, false),
        _ => (120, 113, 108, Mark::Cross, false),
    };
    Look {
        colour: RGBColor(r, g, b),
        mark,
        bold,
    }
}

/// A method's name in pictures.
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
    match method {
        "MPR" => "warmccd MPR (cold)".to_owned(),
        "MPR warm" => format!("warmccd MPR{start}"),
        "GJK" | "MPR intersect" => format!("warmccd {method}{start}"),
        "local" | "minimum" => format!("warmccd {method}{start}"),
        method => format!("{method}{start}"),
    }
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
            Some(n) => format!("{} vertices", n.replace("hc", "")),
            None => s.to_owned(),
        },
    };
    let (a, b) = (shape(parts.next()), shape(parts.next()));
    format!("{a} – {b}")
}

pub fn run(options: &Options) {
    let libraries = Libraries::open();
    let compiled = Compiled::build(&libraries);
    std::fs::create_dir_all(&options.out).expect("the folder for the charts");
    let bench = Bench {
        libraries: &libraries,
        compiled: &compiled,
        quick: options.quick,
        out: options.out.clone(),
    };
    println!("{}", progress::machine(&libraries));
    for (name, why) in &compiled.missing {
        println!(
            "not measured here: {name}: {}",
            why.lines().next().unwrap_or("")
        );
    }
    let accuracy = accuracy::run(&bench);
    let (paper, vertices) = paper::run(&bench);
    let (coherence, recorded) = coherence::run(&bench);
    let models = models::run(&bench);
    let split = if options.no_instructions {
        Vec::new()
    } else {
        split::run(&bench)
    };
    let results = results::Results {
        accuracy,
        paper,
        vertices,
        coherence,
        recorded,
        models,
        split,
    };
    results::write(&bench, &results);
}
