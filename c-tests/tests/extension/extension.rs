// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The extension, `<ccd/warm.h>` and `<ccd/ccd.hpp>`, from C and C++.

#[path = "../../harness/mod.rs"]
mod harness;

use harness::{Precision, Program};
use std::path::Path;
use std::process::Command;

const NO_ARGS: [&str; 0] = [];

/// A C program of this directory on this library.
fn program(name: &str) -> Program {
    let program = Program::c(name).source(format!("tests/extension/{name}.c"));
    strict(program)
}

/// The same in C++.
fn cpp(name: &str) -> Program {
    Program::cpp(name).source(format!("tests/extension/{name}.cpp"))
}

/// A program of c-tests/examples on this library.
fn example(file: &str) -> Program {
    let (name, language) = file.split_once('.').expect("a file's ending");
    let program = match language {
        "cpp" => Program::cpp(name),
        _ => Program::c(name),
    };
    strict(program.source(format!("examples/{file}")))
}

/// One scene in how many is made: in so many under a tool, which looks at memory.
fn one_in(many: u32) -> String {
    if harness::under_tool() { many } else { 1 }.to_string()
}

fn strict(program: Program) -> Program {
    let program = program.flag("-pedantic").flag("-Werror");
    program.flag("-DOURS_ALONE").link_ours_shared()
}

#[test]
fn cpp_wrapper() {
    // A tool looks at memory, which is the same in both standards.
    let standards = if harness::under_tool() { &["c++17"][..] } else { &["c++17", "c++20"] };
    for standard in standards {
        let wrapper = strict(cpp("wrapper")).standard(standard);
        wrapper.build().run(NO_ARGS);
    }
}

/// Every call with every argument that none can work with; and what is wanted.
#[test]
fn bad_input_and_what_may_be_null() {
    program("bad_input").build().run(NO_ARGS);
}

/// What ccdCheck finds wrong with a support function, and that it finds nothing wrong with others.
#[test]
fn odd_support_functions_are_told() {
    program("support_check").build().run(NO_ARGS);
}

#[test]
fn answers_from_every_kind_of_state() {
    program("warm_states").build().run([harness::rounds(400)]);
}

/// pos against an integral, along bodies that tilt, tip, slide and roll.
#[test]
fn pos_is_the_centre_of_pressure() {
    program("pressure").build().run([one_in(8)]);
}

#[test]
fn contacts_are_the_exact_ones() {
    program("contacts").build().run([one_in(10)]);
}

/// `<ccd/fcl.hpp>`. In single precision all of FCL is compiled here: it is made of templates.
/// A tool takes gcc half a minute for each standard.
#[test]
fn fcl_header() {
    let (standards, flags): (&[&str], [&str; 2]) = match Precision::CURRENT {
        Precision::Double if harness::under_tool() => (&["c++17"], ["-O1", "-g"]),
        Precision::Double => (&["c++11", "c++17"], ["-O1", "-g0"]),
        Precision::Single => (&["c++11"], ["-O0", "-g0"]),
    };
    for standard in standards {
        let mut program = cpp("fcl").standard(standard).library("fcl");
        for flag in ["-D_GNU_SOURCE", flags[0], flags[1], "-isystem/usr/include/eigen3"] {
            program = program.flag(flag);
        }
        let poses = if harness::under_tool() { "1" } else { "2" };
        program.link_ours_shared().build().run([poses]);
    }
}

/// The example for FCL: nothing meets at first; then the box rests on its corners, the ball on a point.
#[cfg(not(feature = "single"))]
#[test]
fn fcl_example() {
    let example = Program::cpp("fcl_example").source("examples/fcl.cpp");
    let example = example.flag("-isystem/usr/include/eigen3").library("fcl");
    let said = example.link_ours_shared().build().run(NO_ARGS).stdout;
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(
        lines[..4],
        [
            "frame 0: 0 contacts, box and ball 0.200 m apart",
            "frame 1: 0 contacts, box and ball 0.180 m apart",
            "frame 2: 0 contacts, box and ball 0.160 m apart",
            "frame 3: 5 contacts, box and ball 0.140 m apart",
        ]
    );
    let deep = lines[4..].iter().filter(|l| l.ends_with("3.0 mm deep"));
    assert_eq!(deep.count(), 5);
}

/// What the hash table of states prints: no more room than the pairs that meet need, and a tenth of
/// the callbacks saved for these pairs, fast as they turn.
#[test]
fn states_in_a_hash_table() {
    let lines = example("pair_table.c").build().run(NO_ARGS).stdout;
    let lines: Vec<&str> = lines.lines().collect();
    assert_eq!(lines.len(), 6);
    for line in lines {
        let numbers = line.split(' ').filter_map(|word| word.parse::<f64>().ok());
        let [near, _, warm, cold, places] = numbers.collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        assert!(near > 150.0 && warm <= 0.9 * cold && places <= 1024.0, "{line}");
    }
}

/// What the world in Rust prints.
fn rust_world() -> String {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(harness::root());
    cargo.args(["run", "--quiet", "--offline", "--example", "world", "--target-dir"]);
    cargo.arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join(".."));
    if Precision::CURRENT == Precision::Single {
        cargo.args(["--features", "single"]);
    }
    let out = cargo.output().expect("cargo runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8_lossy(&out.stdout).into_owned()
}

/// What the small worlds print, the same in each language: everything comes to rest on the table, the box on four
/// points, the capsule on two, the hull, a square pyramid, on four; the hull and the capsule
/// fall side by side, the nearest of what is apart, and the box comes no nearer to either.
#[test]
fn small_worlds() {
    let c = example("world.c").build().run(NO_ARGS).stdout;
    let cpp = example("world.cpp").build().run(NO_ARGS).stdout;
    assert_eq!(c, cpp);
    if !harness::under_tool() && !harness::emulated() {
        assert_eq!(c, rust_world());
    }
    let lines: Vec<&str> = c.lines().collect();
    assert_eq!(lines[0], "frame 9: 0 contacts, other pairs are 0.87 m apart");
    assert_eq!(lines[5], "frame 59: 10 contacts, other pairs are 0.31 m apart");
}
