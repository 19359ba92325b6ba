// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs `fcl.cpp`, which checks `<ccd/fcl.hpp>`. In single precision this compiles FCL's templates for float.

use crate::harness::{Precision, Program, under_tool};

/// (With a sanitizer gcc takes half a minute for each standard.)
#[test]
fn fcl_header() {
    let (standards, flags): (&[&str], [&str; 2]) = match Precision::CURRENT {
        Precision::Double if under_tool() => (&["c++17"], ["-O1", "-g"]),
        Precision::Double => (&["c++11", "c++17"], ["-O1", "-g0"]),
        Precision::Single => (&["c++11"], ["-O0", "-g0"]),
    };
    for standard in standards {
        let program = Program::new("lab/fcl.cpp").flag(format!("-std={standard}")).flag("-lfcl");
        let program = [flags[0], flags[1], "-D_GNU_SOURCE", "-DOURS_ALONE", "-isystem/usr/include/eigen3"]
            .into_iter()
            .fold(program, Program::flag);
        program.build().run([if under_tool() { "1" } else { "2" }]);
    }
}
