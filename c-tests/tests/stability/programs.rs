// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The C programs of this folder: how each is built.

use crate::harness::{Executable, Precision, Program};

/// A program of this directory that holds this library alone.
pub fn alone(name: &str) -> Executable {
    source(name).flag("-DOURS_ALONE").link_ours_static().build()
}

/// A program of this directory that holds this library, and in double precision
/// system libccd beside it.
pub fn program(name: &str) -> Executable {
    match Precision::CURRENT {
        Precision::Double => source(name).link_ours_renamed_and_system().build(),
        Precision::Single => alone(name),
    }
}

fn source(name: &str) -> Program {
    strict(name).source(format!("tests/stability/{name}.c"))
}

fn strict(name: &str) -> Program {
    Program::c(name).flag("-pedantic").flag("-Werror")
}

/// Every pair set under c-tests/bench/pairs.
#[cfg(not(feature = "single"))]
pub fn pair_sets() -> Vec<String> {
    let dir = crate::harness::root().join("c-tests/bench/pairs");
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

/// The judge in 128 bits. Other processors than x86 have no such numbers, or by another name.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
pub fn wide() -> Executable {
    strict("wide").source("tests/stability/wide/wide.c").flag("-DOURS_ALONE").link_ours_static().build()
}

/// The same answers in all runs and builds.
pub fn determinism() -> Executable {
    let program = source("determinism").flag("-DOURS_ALONE");
    program.link_ours_shared().build().quiet()
}
