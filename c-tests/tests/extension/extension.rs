// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The extension, `<ccd/warm.h>` and `<ccd/ccd.hpp>`, from C and C++.

use crate::harness::{self, Precision, Program};
use std::path::Path;
use std::process::Command;

const NO_ARGS: [&str; 0] = [];

/// Returns a C or C++ program of c-tests on this library.
fn program(path: &str) -> Program {
    Program::new(path).flag("-DOURS_ALONE")
}

/// Returns N where one scene in N is run: 1, or `under_tool` under a tool, which checks memory.
fn one_in(under_tool: u32) -> String {
    if harness::under_tool() { under_tool } else { 1 }.to_string()
}

run_programs! {
    cpp_wrapper: program("tests/extension/wrapper.cpp").strict(), NO_ARGS;
    cpp_wrapper_in_cpp20: program("tests/extension/wrapper.cpp").strict().flag("-std=c++20"), NO_ARGS;
    status_says_why_a_search_ended: program("tests/extension/status.c").strict(), NO_ARGS;
    results_from_every_kind_of_state: program("tests/extension/warm_states.c").strict(), [harness::rounds(400)];
    pos_is_the_center_of_pressure: program("tests/extension/pos.c").strict(), ["pressure", &one_in(8)];
    pos_is_near_both_objects: program("tests/extension/pos.c").strict(), ["near", "100"];
    pos_is_exact_on_rounded_bodies: program("tests/extension/pos.c").strict(), ["rounded", "400"];
    pos_of_coincident_cubes_is_their_center: program("tests/extension/pos.c").strict(), ["coincident"];
    pos_does_not_jump: program("tests/extension/pos.c").strict(), ["jumps", &harness::rounds(10000)];
    pos_of_faces_is_within_the_limits: program("tests/extension/pos.c").strict(), ["faces", &harness::rounds(300)];
    pos_of_flat_bars_is_on_their_middle: program("tests/extension/pos_flat.c").strict(), ["lying", &harness::rounds(300)];
    pos_of_leaning_bodies_does_not_jump: program("tests/extension/pos_flat.c").strict(), ["leaning", &harness::rounds(1000)];
    pos_does_not_jump_where_its_axes_change: program("tests/extension/pos_flat.c").strict(), ["axes", &harness::rounds(1000)];
    pos_in_the_middle: program("tests/extension/middle_pos.c").strict(), ["2000"];
    contacts_are_exact: program("tests/extension/contacts.c").strict(), [one_in(10)];
}

/// Checks the output of the example for FCL (all of `<ccd/fcl.hpp>`: `lab/fcl.rs`): no contact at first; then four of the box and one of the ball.
#[cfg(not(feature = "single"))]
#[test]
fn fcl_example() {
    let example = program("examples/fcl.cpp").flag("-isystem/usr/include/eigen3").flag("-lfcl");
    let output = example.build().run(NO_ARGS).stdout;
    let lines: Vec<&str> = output.lines().collect();
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

/// Checks the output of the hash table of states: its size follows the pairs that are near, and their
/// states save a tenth of the callbacks.
#[test]
fn pair_table_example() {
    let output = program("examples/pair_table.c").strict().build().run(NO_ARGS).stdout;
    assert_eq!(output.lines().count(), 6);
    for line in output.lines() {
        let numbers = line.split(' ').filter_map(|word| word.parse::<f64>().ok());
        let [near, _, warm, cold, slots] = numbers.collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        assert!(near > 150.0 && warm <= 0.9 * cold && slots <= 1024.0, "{line}");
    }
}

/// Runs the Rust example and returns its output.
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

/// Checks that the worlds in C, C++ and Rust print the same: on the table rest the box on four points, the
/// capsule on two and the square pyramid on four; pyramid and capsule are the closest pair apart.
#[test]
fn world_examples() {
    let [c, cpp] =
        ["examples/world.c", "examples/world.cpp"].map(|path| program(path).strict().build().run(NO_ARGS).stdout);
    assert_eq!(c, cpp);
    if !harness::under_tool() && !harness::emulated() {
        assert_eq!(c, rust_world());
    }
    let lines: Vec<&str> = c.lines().collect();
    assert_eq!(lines[0], "frame 9: 0 contacts, other pairs are 0.87 m apart");
    assert_eq!(lines[5], "frame 59: 10 contacts, other pairs are 0.31 m apart");
}
