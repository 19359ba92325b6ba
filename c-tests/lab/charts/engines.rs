// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Compares this library with the penetration solvers of other engines over the overlapping pairs of the recorded
//! contacts: instructions, support points, time, wrong answers.

use std::path::Path;
use std::process::Command;

use super::{ENGINES, OUT};
use crate::charts::peers::{self, Peers};
use crate::harness;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Row;
use crate::measuring::methods::{Start, select};
use crate::measuring::scene::Scene;
use crate::measuring::{callgrind, csv};
use crate::pages::{markdown, write_between_marks};

/// To which times are relative.
const BASE: &str = "libccd ccdMPRPenetration";

/// Of every engine whose tolerance is not built in, in metres; this library's as unchanged programs call it, and its own call
/// without positions.
const METHODS: [(&str, Start, f64); 4] = [
    ("ccdMPRPenetration, pos", Start::None, 1e-6),
    ("ccdPenetration", Start::None, 1e-6),
    (BASE, Start::None, 1e-6),
    ("libccd ccdGJKPenetration", Start::None, 1e-6),
];

/// Instructions are counted for every n-th contact; the rest is measured for all.
const EVERY: usize = 5;

fn table(rows: &[Row]) -> String {
    let base = rows.iter().find(|r| r.method == BASE).and_then(|r| r.ns);
    let percent = |p: f64| if p == 0.0 { "0".to_owned() } else { format!("{p:.2} %") };
    let lines = rows.iter().map(|r| {
        vec![
            r.method.clone(),
            format!("{:.0}", r.instructions()),
            format!("{:.1}", r.supports),
            r.ns.zip(base).map_or("-".to_owned(), |(ns, base)| format!("{:.2}", ns / base)),
            percent(r.missed),
            percent(r.deep),
            percent(r.shallow),
            percent(r.wrong_direction),
        ]
    });
    let head = "solver|instructions|support points|time|missed|too deep|too shallow|wrong direction";
    markdown(head, lines)
}

/// Downloads what engines.sh can, measures all, and writes the table and its numbers.
pub fn run() {
    let libraries = Libraries::open();
    if !callgrind::is_counting() {
        let script = harness::root().join("c-tests/lab/charts/engines.sh");
        if let Err(why) = Command::new("sh").arg(script).arg(peers::engines()).status() {
            println!("nothing downloaded: {why}");
        }
    }
    let peers = Peers::build(&libraries);
    let mut scene = Scene::recorded(&libraries);
    scene.pairs.retain(|pair| pair.truth.depth > 1e-9);
    let mut methods = select(&libraries, &METHODS);
    methods.extend(peers.methods(&libraries));
    let timed = || super::times::runner(&libraries, 5);
    let mut runner = timed().with_instructions(EVERY, &["engines"]).unwrap_or_else(|why| {
        println!("instructions not counted: {}", why.lines().last().unwrap_or_default());
        timed()
    });
    let mut rows = runner.rows(&scene, methods);
    if callgrind::is_counting() {
        return;
    }
    peers.print_missing();
    rows.sort_by(|a, b| a.instructions().total_cmp(&b.instructions()));
    csv::write(&Path::new(OUT).join(ENGINES), &libraries.machine, &rows);
    super::front::draw(&Path::new(OUT).join("front.svg"), &libraries.machine, &rows);
    let table = table(&rows);
    println!("{table}");
    write_between_marks("include/README.md", "table engines", &format!("{table}\n"));
}
