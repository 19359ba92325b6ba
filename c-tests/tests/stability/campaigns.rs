// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Longer runs of the programs that the tests run on a sample, and their tables:
//! `cargo run --release --example campaigns -- NAME [ARGUMENT...]`.
//!
//! | name | what | arguments, and what they are without |
//! |---|---|---|
//! | `rates` | every category of pairs, both tie rules, on libccd and on this library | pairs a category: 2000 |
//! | `wide` | every call on bodies that are hard for one method or another, judged in 128 bits | pairs a row, row, first pair, seed: 1000 -1 0 1 |
//! | `worst` | callbacks and microseconds of a query at worst | queries, seed: 1000000 1 |
//! | `truth` | the truth against itself and all of the certified pairs | |
//! | `ledger` | the configurations where libccd is wrong | |
//! | `determinism` | what `cmake/packages/cross.sh` compares between processors | |

#[path = "../../harness/mod.rs"]
mod harness;
mod programs;

use harness::Executable;
#[cfg(not(feature = "single"))]
use programs::alone;
use programs::program;

/// Runs a program in sight, with the caller's arguments before what stands for the rest.
fn show(program: &Executable, given: &[String], rest: &[&str]) {
    let rest = rest.iter().skip(given.len()).map(|s| (*s).to_owned());
    let status = program.command().args(given.iter().cloned().chain(rest)).status();
    if !status.is_ok_and(|s| s.success()) {
        std::process::exit(1);
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_default();
    let given: Vec<String> = arguments.collect();
    match name.as_str() {
        "rates" => show(&program("campaign"), &given, &["2000"]),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        "wide" => show(&programs::wide(), &given, &["1000", "-1", "0", "1"]),
        "worst" => show(&program("worst_case"), &given, &["1000000", "1"]),
        #[cfg(not(feature = "single"))]
        "truth" => {
            let mut args = vec!["100000".to_owned(), "1".to_owned()];
            args.extend(programs::pair_sets());
            show(&alone("truth"), &args, &[]);
        }
        #[cfg(not(feature = "single"))]
        "ledger" => show(&program("configurations"), &[], &["--ledger"]),
        "determinism" => show(&programs::determinism(), &[], &["150"]),
        _ => {
            eprintln!("usage: campaigns rates|wide|worst|truth|ledger|determinism [ARGUMENT...]");
            std::process::exit(2);
        }
    }
}
