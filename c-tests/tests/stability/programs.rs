// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the C programs of this folder.

use crate::harness::{Executable, Precision, Program};

fn source(name: &str) -> Program {
    Program::c(name).flag("-pedantic").flag("-Werror").source(format!("tests/stability/{name}.c"))
}

/// Builds a program with this library alone.
#[cfg(not(feature = "single"))]
pub fn alone(name: &str) -> Executable {
    source(name).flag("-DOURS_ALONE").link_ours_static().build()
}

/// Builds a program with this library, and in double precision system libccd beside it.
pub fn program(name: &str) -> Executable {
    beside_libccd(source(name))
}

/// Builds a program of another folder so.
pub fn beside_libccd(program: Program) -> Executable {
    match Precision::CURRENT {
        Precision::Double => program.link_ours_renamed_and_system().build(),
        Precision::Single => program.flag("-DOURS_ALONE").link_ours_static().build(),
    }
}

/// Builds the program that prints the same bits in all runs and builds.
pub fn determinism() -> Executable {
    source("determinism").flag("-DOURS_ALONE").link_ours_shared().build().quiet()
}

/// The arguments of `truth`, and every pair set under c-tests/bench/pairs.
#[cfg(not(feature = "single"))]
pub fn truth_arguments(pairs: &str, step: &str) -> Vec<String> {
    let dir = crate::harness::root().join("c-tests/bench/pairs");
    let entries = std::fs::read_dir(&dir).unwrap_or_else(|e| panic!("{}: {e}", dir.display()));
    let files = entries.map(|entry| entry.expect("a directory entry").path());
    let sets = files.filter(|path| path.extension().is_some_and(|e| e == "bin"));
    let mut sets: Vec<String> = sets.map(|path| path.display().to_string()).collect();
    assert!(!sets.is_empty());
    sets.sort();
    [vec![pairs.to_owned(), step.to_owned()], sets].concat()
}
