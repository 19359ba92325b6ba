// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Longer runs of the programs that the tests run on a sample, and their tables:
//! `cargo run --release -p lab --bin campaigns -- NAME [ARGUMENT...]`.
//!
//! | name | what | arguments and their defaults |
//! |---|---|---|
//! | `rates` | every category of pairs, both tie rules, on libccd and on this library | pairs a category: 2000 |
//! | `wide` | every call on bodies that are hard for one method or another | pairs a row, row, first pair, seed: 1000 -1 0 1 |
//! | `states` | every kind of warm start state (`tests/extension/warm_states.c`) | pairs a call, changed states: 400 1000000 |
//! | `positions` | how far `pos` is from the objects (`tests/extension/pos.c`) | N, for one in N of two million hits: 1 |
//! | `jumps` | how often `pos` jumps, by shape (`tests/extension/pos.c`) | steps, seed: 300000 1 |
//! | `touches` | objects that touch (`tests/contract/touches.c`) | random pairs: 200000 |
//! | `truth` | the truth (`truth.c`) against itself, the certified pairs and the recorded contacts | random pairs, step: 100000 1 |
//! | `ledger` | the configurations where libccd is wrong | |
//! | `determinism` | digests that `cmake/packages/cross.sh` compares between processors | |

#[path = "../harness/mod.rs"]
mod harness;
#[path = "../tests/stability/programs.rs"]
mod programs;

use harness::{Executable, Program};
use programs::{determinism, program};

/// Runs a program in the terminal with the given arguments, then the defaults of the others.
fn show(program: &Executable, given: &[String], defaults: &[&str]) {
    let status = program.command().args(given).args(defaults.iter().skip(given.len())).status();
    if !status.is_ok_and(|s| s.success()) {
        std::process::exit(1);
    }
}

/// Builds a program of another folder of tests, with this library alone.
fn elsewhere(path: &str) -> Executable {
    Program::new(format!("tests/{path}.c")).flag("-DOURS_ALONE").build()
}

/// Runs the check of the truth on the recorded contacts and on every pair set.
#[cfg(not(feature = "single"))]
fn truth(given: &[String]) {
    let folder = harness::root().join("c-tests");
    let entries = std::fs::read_dir(folder.join("bench/pairs")).expect("the pair sets");
    let sets =
        entries.map(|entry| entry.expect("a file").path()).filter(|path| path.extension().is_some_and(|e| e == "bin"));
    let mut files: Vec<_> = sets.map(|path| path.display().to_string()).collect();
    files.sort();
    files.insert(0, folder.join("tools/record/contacts.bin").display().to_string());
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let program = Program::new("lab/truth.c").strict().flag("-DOURS_ALONE").link(harness::Link::Static).build();
    show(&program, given, &[&["100000", "1"], &files[..]].concat());
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_default();
    let given: Vec<String> = arguments.collect();
    let list = |name: &str| [vec![name.to_owned()], given.clone()].concat();
    match name.as_str() {
        "rates" => show(&program("judged").build(), &list("categories"), &["", "2000"]),
        "wide" => show(&program("judged").build(), &list("hard"), &["", "1000", "-1", "0", "1"]),
        "states" => show(&elsewhere("extension/warm_states"), &given, &["400", "1000000"]),
        "positions" => show(&elsewhere("extension/pos"), &list("near"), &["", "1"]),
        "jumps" => show(&elsewhere("extension/pos"), &list("jumps"), &["", "300000", "1"]),
        "touches" => show(&elsewhere("contract/touches"), &given, &["200000"]),
        #[cfg(not(feature = "single"))]
        "truth" => truth(&given),
        #[cfg(not(feature = "single"))]
        "ledger" => show(&program("judged").build(), &[], &["ledger"]),
        "determinism" => show(&determinism(), &[], &["150"]),
        _ => {
            eprintln!(
                "usage: campaigns rates|wide|states|touches|positions|jumps|truth|ledger|determinism [ARGUMENT...]"
            );
            std::process::exit(2);
        }
    }
}
