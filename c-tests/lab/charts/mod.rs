// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts: speed against accuracy as CSV, pictures and a table, other engines as a table; and tables of the recorded
//! costs.

pub mod accuracy;
pub mod coherence;
pub mod engines;
pub mod figure;
pub mod front;
pub mod local;
pub mod peers;
pub mod ratios;
pub mod results;
pub mod times;

use std::path::Path;

use crate::measuring::csv;
use crate::measuring::libraries::Libraries;
use crate::measuring::recorded::RANDOM;
use crate::measuring::scene::{FLOORS, Scene};
use peers::Peers;

/// Folder of the committed figures and pictures.
pub const OUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../bench/charts");

/// Names of the figures in their folder: speed against accuracy, and motions by step.
const FIGURES: &str = "accuracy.csv";
const MOTIONS: &str = "coherence.csv";
/// That of local searches at equal errors.
const LOCAL: &str = "local.csv";
/// That of other engines on recorded contacts.
pub const ENGINES: &str = "engines.csv";

/// Returns the names of all independent poses: pair sets, and bodies on floors.
pub fn sets() -> Vec<&'static str> {
    [&RANDOM[..], &FLOORS].concat()
}

/// Returns at most `limit` poses of each of them.
pub fn scenes(libraries: &Libraries, limit: usize) -> Vec<Scene> {
    let sets = RANDOM.map(|set| Scene::load(libraries, set, limit));
    sets.into_iter().chain(Scene::floors(libraries, limit)).collect()
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

/// Returns processor, libraries and versions of a line that names the machine, for the foot of a picture.
pub fn short(machine: &str) -> String {
    let (place, rest) = machine.split_once("; ").unwrap_or((machine, ""));
    let version = rest.split(" (").next().unwrap_or("");
    format!("{place}; {version}; all in one process, rustc and gcc -O3")
}

/// Draws the pictures and writes the page from the figures that are there.
pub fn redraw(out: &Path) {
    let (machine, rows) = csv::read(&out.join(FIGURES));
    accuracy::draw(out, &machine, &rows);
    // Always of the committed figures: `engines` measures them.
    let (machine_of_engines, engines) = csv::read(&Path::new(OUT).join(ENGINES));
    front::draw(&out.join("front.svg"), &machine_of_engines, &engines);
    let (machine_of_local, local) = csv::read(&out.join(LOCAL));
    local::draw(&out.join("local.svg"), &machine_of_local, &local);
    results::write(out, &machine, &rows, &csv::read(&out.join(MOTIONS)).1, &local);
}

/// Measures and draws; `is_quick`: fewer poses, tolerances and repetitions.
pub fn run(out: &Path, is_quick: bool) {
    let libraries = Libraries::open();
    let peers = Peers::build(&libraries);
    println!("{}", libraries.machine);
    peers.print_missing();
    std::fs::create_dir_all(out).expect("the folder for the charts");
    csv::write(&out.join(FIGURES), &libraries.machine, &accuracy::measure(&libraries, &peers, is_quick));
    csv::write(&out.join(MOTIONS), &libraries.machine, &coherence::measure(&libraries, is_quick));
    csv::write(&out.join(LOCAL), &libraries.machine, &local::measure(&libraries, is_quick));
    redraw(out);
}
