// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The benchmark: `cargo bench -p charts -- charts` measures supports, times and errors beside
//! system libccd's and other libraries'; `-- instructions` prints those of each query,
//! beside libccd's; `-- record` writes the support counts of every pair set.

#[path = "figures/mod.rs"]
mod charts;
#[path = "../harness/mod.rs"]
mod harness;
#[path = "measuring/mod.rs"]
mod measuring;
mod peers;
mod progress;

use clap::{Parser, Subcommand};

/// Speed and accuracy of penetration depth, this library beside others.
#[derive(Parser)]
#[command(name = "charts")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Cargo says so to every benchmark.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Writes the support counts and errors with which a test compares changes.
    Record,
    /// Every chart as CSV and SVG.
    Charts(charts::Options),
    /// The pictures and their page again, from the CSV that is there.
    Redraw(charts::Options),
    /// This library beside other engines, over the recorded contacts; downloads what it can.
    Engines(charts::engines::Options),
    /// Instructions of a query, as Markdown; runs this program under valgrind.
    Instructions(charts::instructions::Options),
}

fn main() {
    match Arguments::parse().command {
        Command::Record => measuring::recorded::record(),
        Command::Charts(options) => charts::run(&options),
        Command::Redraw(options) => charts::redraw(&options),
        Command::Engines(options) => charts::engines::run(&options),
        Command::Instructions(options) => charts::instructions::run(&options),
    }
}
