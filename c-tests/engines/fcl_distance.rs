// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! FCL's signed distance on libccd, on this library, and on this library with
//! `libwarmccd-fcl.so` preloaded.

// Each driver uses a part.
#![allow(dead_code)]

use crate::checks::{cpp, head};
use crate::harness::{self, Executable, Precision, Program, fields, must_succeed};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

pub const SETS: [&str; 3] = ["configurations", "kissing", "random"];

/// What FCL answered with one choice of libraries.
pub struct Distances {
    name: &'static str,
    /// The file that FCL's function was taken from.
    pub function: String,
    /// The counts of each of [`SETS`].
    pub sets: [BTreeMap<String, f64>; 3],
    /// A line for each answer that is wrong.
    pub wrong: Vec<String>,
}

/// Compiles `libwarmccd-fcl.so`.
fn preloaded() -> PathBuf {
    let library = harness::library(Precision::Double);
    let path = harness::output_dir().join("libwarmccd-fcl.so");
    let mut compile = harness::compile_with(&harness::compiler(true));
    let source = harness::root().join("cmake/fcl/signed_distance.cpp");
    compile.args(["-std=c++11", "-fPIC", "-shared", "-Wextra", "-Werror"]);
    compile.args(["-fvisibility=hidden", "-isystem/usr/include/eigen3"]);
    compile.arg("-I").arg(harness::root().join("include"));
    compile.arg(source).arg("-o").arg(&path);
    compile.arg("-L").arg(&library.dir).arg("-lccd");
    must_succeed(&mut compile, "the compiler (for libwarmccd-fcl.so)");
    path
}

/// What the program says with so many pairs: none of any set for 0.
fn said(program: &Executable, preload: bool, pairs: u32) -> String {
    let mut command = program.command();
    command.arg(pairs.to_string());
    if preload {
        harness::preload(&mut command, &preloaded());
    }
    let (status, written) = harness::run_command(&mut command, Duration::from_secs(300));
    assert!(status.success(), "{status}\n{}", written.stderr);
    written.stdout
}

/// The file that FCL's signed distance is taken from.
fn function(said: &str) -> String {
    let function = said.lines().find_map(|line| line.strip_prefix("function "));
    function.expect("a file").to_owned()
}

fn run(name: &'static str, program: &Executable, preload: bool, pairs: u32) -> Distances {
    let said = said(program, preload, pairs);
    let library = ["library libccd", "library warmccd "][usize::from(name.contains("this"))];
    assert!(said.starts_with(library), "{name}: on {said}");
    Distances {
        name,
        function: function(&said),
        sets: SETS.map(|set| fields(&said, set)),
        wrong: said
            .lines()
            .filter(|line| line.split(' ').next().is_some_and(|w| w.ends_with(':')))
            .map(String::from)
            .collect(),
    }
}

/// The program on libccd, and on this library.
fn programs() -> [Executable; 2] {
    let program: Program = cpp("fcl_distance").library("fcl").without_tools();
    // The rows of configurations.h name the fields that they set.
    let program = program.flag("-Wno-missing-field-initializers");
    let theirs = program.link_system().build().quiet();
    let ours = theirs.swapped();
    [theirs, ours]
}

const PRELOADED: &str = "this library and `libwarmccd-fcl.so`";

/// The files that FCL's signed distance is taken from without preloading, on either library; and the answers with it.
pub fn preloaded_distances(pairs: u32) -> ([String; 2], Distances) {
    let programs = programs();
    let functions = programs.each_ref().map(|program| function(&said(program, false, 0)));
    (functions, run(PRELOADED, &programs[1], true, pairs))
}

pub fn distances(pairs: u32) -> [Distances; 3] {
    let [theirs, ours] = programs();
    [
        run("FCL on libccd", &theirs, false, pairs),
        run("FCL on this library", &ours, false, pairs),
        run(PRELOADED, &ours, true, pairs),
    ]
}

/// Markdown.
pub fn table(all: &[Distances]) -> String {
    let columns = ["", "pairs", "threw", "endless", "wrong", "µs a distance"];
    let mut out = head(&columns);
    for (i, set) in SETS.iter().enumerate() {
        for d in all {
            let of = |key: &str| d.sets[i][key];
            let _ = writeln!(
                out,
                "| {set}: {} | {} | {} | {} | {} | {:.1} |",
                d.name,
                of("queries"),
                of("threw"),
                of("endless"),
                of("wrong") + of("outside"),
                1e-3 * of("nanoseconds"),
            );
        }
    }
    out
}
