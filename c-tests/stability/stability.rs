// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where penetration methods fail: configurations, categories of pairs, continuity,
//! termination, memory, determinism. The work is done by C programs, as the
//! library's users write them; here they are built and run.

#[path = "../harness/mod.rs"]
mod harness;

use harness::{Executable, Precision, Program};

const NO_ARGS: [&str; 0] = [];

/// A program of this directory that holds this library, and in double precision
/// system libccd beside it.
fn program(name: &str) -> Executable {
    let program = Program::c(name)
        .source(format!("stability/{name}.c"))
        .flag("-pedantic")
        .flag("-Werror")
        .flag("-DSTABILITY_PARTIAL");
    match Precision::CURRENT {
        Precision::Double => program.link_ours_renamed_and_system().build(),
        Precision::Single => program.flag("-DOURS_ALONE").link_ours_static().build(),
    }
}

/// Every pair set under c-tests/pairs.
fn pair_sets() -> Vec<String> {
    let dir = harness::root().join("c-tests/pairs");
    let mut sets: Vec<String> = std::fs::read_dir(&dir)
        .unwrap_or_else(|e| panic!("{}: {e}", dir.display()))
        .map(|entry| entry.expect("a directory entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "bin"))
        .map(|path| path.display().to_string())
        .collect();
    sets.sort();
    assert!(!sets.is_empty());
    sets
}

/// The judge itself.
#[test]
#[cfg(not(feature = "single"))]
fn truth_agrees_with_itself_and_the_certified_sets() {
    let mut args = vec!["2000".to_owned(), "25".to_owned()];
    args.extend(pair_sets());
    program("truth").run(args);
}

/// Every category of pairs, 2,000 pairs each, both tie rules, on system libccd and
/// on this library: `cargo test --test stability -- --ignored --nocapture campaign`.
#[test]
#[ignore = "takes minutes; prints the rate tables"]
fn campaign() {
    let campaign = program("campaign");
    for tie in ["0", "1"] {
        campaign.run(["2000", tie]);
    }
}
