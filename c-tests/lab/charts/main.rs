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
#[path = "../paper/mod.rs"]
mod paper;

use std::path::{Path, PathBuf};

use measuring::ledger::{self, Cost};
use measuring::libraries::Libraries;
use measuring::recorded::{self, Recorded};
use measuring::{callgrind, csv};

const USAGE: &str = "\
usage: cargo bench -p lab -- COMMAND
  charts            speed against accuracy, as CSV and SVG, and the page
  paper             the tables and figures of W. Gao's paper, as CSV and SVG, and their page
  charts --quick, paper --quick   the same of fewer poses, in target/quick, beside what is published
  local             the local search beside the published method at equal errors: prints the charts' table
  ratios            times over libccd's by kind and depth of the pairs, misses too: prints them
  redraw            the pictures and their pages from the CSV files that are there
  record            the support counts, errors, instructions and mispredictions that a test judges
  engines           this library beside other engines on recorded contacts; downloads what it can";

fn main() {
    // cargo adds --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let out = Path::new(charts::OUT);
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["record"] => record(),
        ["charts"] => charts::run(out, false),
        ["charts", "--quick"] => charts::run(&quick("charts"), true),
        ["paper"] => paper::run(Path::new(paper::OUT), false),
        ["paper", "--quick"] => paper::run(&quick("paper"), true),
        ["local"] => charts::local::run(),
        ["ratios"] => charts::ratios::run(),
        ["redraw"] => {
            charts::redraw(out);
            paper::redraw(Path::new(paper::OUT));
        }
        ["engines"] => charts::engines::run(),
        _ => {
            eprintln!("{USAGE}");
            std::process::exit(2);
        }
    }
}

/// Makes and names the folder of a quick run.
fn quick(name: &str) -> PathBuf {
    let out = harness::output_dir().with_file_name("quick").join(name);
    std::fs::create_dir_all(&out).expect("a folder");
    println!("{}", out.display());
    out
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
