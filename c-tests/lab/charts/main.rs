// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The benchmark (`c-tests/bench/README.md`): one runner over one table of methods.

#[path = "mod.rs"]
mod charts;
#[path = "../../harness/mod.rs"]
mod harness;
#[path = "../../bench/measuring/mod.rs"]
mod measuring;

use clap::{Parser, Subcommand};
use measuring::libraries::Libraries;
use measuring::{callgrind, ledger, recorded};

/// Speed and accuracy of penetration depth, this library beside others.
#[derive(Parser)]
#[command(name = "bench")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Passed by cargo to every benchmark.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Writes the support counts, errors, instructions and mispredictions with which a test compares changes.
    Record,
    /// Every chart as CSV and SVG.
    Charts(charts::Options),
    /// The pictures and their page from the CSV files that are there.
    Redraw(charts::Options),
    /// This library beside other engines, over the recorded contacts; downloads what it can.
    Engines,
}

fn main() {
    match Arguments::parse().command {
        Command::Record => record(),
        Command::Charts(options) => charts::run(&options),
        Command::Redraw(options) => charts::redraw(&options),
        Command::Engines => charts::engines::run(),
    }
}

fn record() {
    let libraries = Libraries::open();
    ledger::record(&libraries);
    if !callgrind::is_counting() {
        recorded::record(&libraries);
    }
}
