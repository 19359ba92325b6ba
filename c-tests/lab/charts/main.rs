// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The benchmark (`c-tests/bench/README.md`): one runner over one table of methods.

#[path = "mod.rs"]
mod charts;
#[path = "../../harness/mod.rs"]
mod harness;
#[path = "../../bench/measuring/mod.rs"]
mod measuring;
#[path = "../pages.rs"]
mod pages;

use measuring::ledger::{self, Cost};
use measuring::libraries::Libraries;
use measuring::recorded::{self, Recorded};
use measuring::{callgrind, csv};

const USAGE: &str = "\
usage: cargo bench -p lab -- COMMAND
  charts [--quick] [--out DIR] [FIGURE...]  measure all figures or these (accuracy, vertices, coherence), as CSV and SVG
  redraw [--out DIR]                        the pictures and their page from the CSV files that are there
  record                                    the support counts, errors, instructions and mispredictions that a test judges
  engines                                   this library beside other engines on recorded contacts; downloads what it can";

fn main() {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let mut take = |option: &str, count: usize| {
        let at = words.iter().position(|word| word == option)?;
        words.drain(at..(at + count).min(words.len())).next_back()
    };
    take("--bench", 1); // from cargo
    let quick = take("--quick", 1).is_some();
    let out = take("--out", 2).unwrap_or(charts::OUT.to_owned()).into();
    let command = words.first().cloned().unwrap_or_default();
    let options = charts::Options { quick, out, only: words.into_iter().skip(1).collect() };
    match &*command {
        "record" => record(),
        "charts" => charts::run(&options),
        "redraw" => charts::redraw(&options),
        "engines" => charts::engines::run(),
        _ => {
            eprintln!("{USAGE}");
            std::process::exit(2);
        }
    }
}

/// Writes both files anew from what is measured now, and prints the costs that are above what is allowed.
fn record() {
    let libraries = Libraries::open();
    let costs = ledger::measure(&libraries, &["record"], true).unwrap_or_else(|why| panic!("not counted: {why}"));
    if callgrind::is_counting() {
        return;
    }
    let (_, recorded) = csv::read::<Cost>(&ledger::file());
    for (now, then) in costs.iter().filter_map(|now| Some((now, now.find(&recorded)?))) {
        if now.is_above(then) {
            println!("raised: {}", now.beside(then));
        }
    }
    csv::write(&ledger::file(), &libraries.toolchain, &costs);
    let rows = recorded::measure(&libraries).into_iter().map(Recorded::from);
    csv::write(&recorded::file(), &libraries.machine, &rows.collect::<Vec<_>>());
}
