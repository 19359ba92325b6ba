// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the C programs of this folder.

use crate::harness::{Executable, Link, Precision, Program};

/// Returns a program of this folder, not yet linked.
pub fn source(name: &str) -> Program {
    Program::new(format!("tests/stability/{name}.c")).strict()
}

/// Returns a program with this library, and in double precision system libccd beside it.
pub fn program(name: &str) -> Program {
    match Precision::CURRENT {
        Precision::Double => source(name).link(Link::Renamed),
        Precision::Single => source(name).flag("-DOURS_ALONE").link(Link::Static),
    }
}

/// Builds the program that prints the same bits in all runs and builds.
pub fn determinism() -> Executable {
    source("determinism").flag("-DOURS_ALONE").build()
}
