// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts: speed against accuracy, the paper's figures, coherence and other engines, each as CSV and as a picture or a
//! table; and tables of the recorded costs.

pub mod accuracy;
pub mod coherence;
pub mod deep;
pub mod engines;
pub mod figure;
pub mod paper;
pub mod peers;
pub mod results;
pub mod times;

use std::path::PathBuf;

use crate::measuring::csv;
use crate::measuring::ledger::{self, Cost};
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use peers::Peers;

pub struct Options {
    /// Fewer poses, tolerances and repetitions: two minutes.
    pub quick: bool,
    /// Measure these figures alone, as `coherence`; the others stay as they are. Empty: all.
    pub only: Vec<String>,
    /// Folder of the CSV files and pictures.
    pub out: PathBuf,
}

pub const OUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../bench/charts");

/// Inputs of every measurement.
pub struct Bench<'a> {
    pub libraries: &'a Libraries,
    pub peers: &'a Peers,
    pub quick: bool,
}

impl<'a> Bench<'a> {
    /// Poses of a pair set.
    pub fn poses(&self) -> usize {
        if self.quick { 100 } else { usize::MAX }
    }

    /// Returns a runner that takes times.
    pub fn timed(&self) -> Runner<'a> {
        times::runner(self.libraries, if self.quick { 3 } else { 9 })
    }
}

/// Iterates over items, and prints each on standard error.
pub fn progress<'a, T: std::fmt::Debug>(items: &'a [T], what: &str) -> impl Iterator<Item = &'a T> {
    items.iter().inspect(move |item| eprintln!("{what}: {item:?}"))
}

/// Folder of figures and pictures, and the line that says what was measured where and when.
pub struct Page {
    pub out: PathBuf,
    pub machine: String,
}

impl Page {
    /// The line under a picture: date, machine, versions.
    pub fn footer(&self) -> String {
        let (place, rest) = self.machine.split_once("; ").unwrap_or((&self.machine, ""));
        let version = rest.split(" (").next().unwrap_or("");
        format!("thick: this library; {place}; {version}; all in one process, rustc and gcc -O3")
    }
}

/// Returns the name of a pair set in words.
pub fn kind(set: &str) -> String {
    let shape = |s: &str| match s {
        "sph" => "sphere".to_owned(),
        "cap" => "capsule".to_owned(),
        "cyl" => "cylinder".to_owned(),
        "ell" => "ellipsoid".to_owned(),
        s => s.strip_prefix('p').map_or(s.to_owned(), |n| format!("{n} vertices")),
    };
    let shapes: Vec<String> = set.split('_').take(2).map(shape).collect();
    shapes.join(" – ")
}

/// Draws the pictures and writes the page from the figures that are there.
pub fn redraw(options: &Options) {
    let read = |name: &str| -> (Page, Vec<Row>) {
        let (machine, rows) = csv::read(&options.out.join(name).with_extension("csv"));
        (Page { out: options.out.clone(), machine }, rows)
    };
    let (page, vertices) = read("vertices");
    paper::draw(&page, &vertices);
    let (page, rows) = read("accuracy");
    accuracy::draw(&page, &rows);
    let (_, costs) = csv::read::<Cost>(&ledger::file());
    let tables = [
        ("MACHINE", page.machine.clone()),
        ("FASTER", results::times_faster(&rows)),
        ("COHERENCE", results::coherence(&read("coherence").1)),
        ("INSTRUCTIONS", results::instructions(&costs)),
        ("DEPTHS", results::instructions_by_depth(&costs)),
    ];
    results::write(&page, &tables);
}

/// Measures the figures, each of which is written as it comes, and draws them.
pub fn run(options: &Options) {
    let libraries = Libraries::open();
    let peers = Peers::build(&libraries);
    std::fs::create_dir_all(&options.out).expect("the folder for the charts");
    let bench = Bench { libraries: &libraries, peers: &peers, quick: options.quick };
    let machine = &libraries.machine;
    println!("{machine}");
    peers.print_missing();
    type Measure = fn(&Bench) -> Vec<Row>;
    let figures: [(&str, Measure); 3] =
        [("accuracy", accuracy::measure), ("vertices", paper::measure), ("coherence", coherence::measure)];
    for (name, measure) in figures {
        if options.only.is_empty() || options.only.iter().any(|only| only == name) {
            csv::write(&options.out.join(name).with_extension("csv"), machine, &measure(&bench));
        }
    }
    redraw(options);
}
