// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The benchmark: `cargo bench --bench charts -- tables` prints supports, times and
//! errors per pair set beside system libccd's and the paper's; `-- phases` instructions
//! of each query by phase, beside libccd's and Bullet's.
//!
//! Double precision only, as Debian's libccd is.

#[cfg(not(feature = "single"))]
#[path = "../charts/mod.rs"]
mod charts;
#[cfg(not(feature = "single"))]
#[path = "../harness/mod.rs"]
mod harness;
#[cfg(not(feature = "single"))]
mod lab;
#[cfg(not(feature = "single"))]
mod tables;

#[cfg(not(feature = "single"))]
mod command {
    use clap::{Parser, Subcommand};

    use crate::{charts, tables};

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
        /// Supports, times and errors of every pair set, as Markdown.
        Tables(tables::Options),
        /// Writes the support counts and errors with which a test compares changes.
        Record,
        /// Every chart as CSV and SVG.
        Charts(charts::Options),
        /// The pictures and their page again, from the CSV that is there.
        Redraw(charts::Options),
        /// Instructions of a query by phase, as Markdown; runs this program under valgrind.
        Phases(charts::phases::Options),
        /// One method over one set, for a profiler to watch.
        #[command(hide = true)]
        Once(charts::split::Once),
    }

    pub fn run() {
        match Arguments::parse().command {
            Command::Tables(options) => tables::run(&options),
            Command::Record => tables::record(),
            Command::Charts(options) => charts::run(&options),
            Command::Redraw(options) => charts::redraw(&options),
            Command::Phases(options) => charts::phases::run(&options),
            Command::Once(options) => charts::split::once(&options),
        }
    }
}

fn main() {
    #[cfg(not(feature = "single"))]
    command::run();
    #[cfg(feature = "single")]
    eprintln!("the benchmark measures double precision, beside Debian's libccd");
}
