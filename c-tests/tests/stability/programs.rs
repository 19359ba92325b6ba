// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the C programs of this folder.

use crate::harness::{Executable, Precision, Program};

/// Returns a program of this folder, not yet linked.
pub fn source(name: &str) -> Program {
    Program::c(name).strict().source(format!("tests/stability/{name}.c"))
}

/// Returns a program with this library, and in double precision system libccd beside it.
pub fn program(name: &str) -> Program {
    beside_libccd(source(name))
}

/// Links a program of another folder so.
pub fn beside_libccd(program: Program) -> Program {
    match Precision::CURRENT {
        Precision::Double => program.link_ours_renamed_and_system(),
        Precision::Single => program.flag("-DOURS_ALONE").link_ours_static(),
    }
}

/// Builds the program that prints the same bits in all runs and builds.
pub fn determinism() -> Executable {
    source("determinism").flag("-DOURS_ALONE").link_ours_shared().build().quiet()
}
