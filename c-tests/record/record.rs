// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The recorded contact sequence: its truth, its recorder, and what both methods and
//! the extension answer on it.

// The recording and Debian's libccd are double.
#![cfg(not(feature = "single"))]

#[path = "../harness/mod.rs"]
mod harness;

use harness::{Executable, Program, output_dir, root};
use std::path::PathBuf;

fn recording() -> PathBuf {
    root().join("c-tests/record/contacts.bin")
}

fn program(name: &str) -> Program {
    Program::c(name)
        .source(format!("record/{name}.c"))
        .flag("-pedantic")
}

/// Asks no libccd anything, so that none needs to be found when it runs.
fn certify() -> Executable {
    program("certify").link_ours_static().build()
}

/// The cells of a table's rows, by the first.
fn rows(table: &str) -> Vec<Vec<String>> {
    table
        .lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| method"))
        .map(|line| {
            let cells = line.trim_matches('|').split(" | ");
            cells.map(|cell| cell.trim().to_owned()).collect()
        })
        .collect()
}

fn number(cell: &str) -> f64 {
    let digits = cell.trim_end_matches(" %");
    digits
        .parse()
        .unwrap_or_else(|e| panic!("`{cell}` is no number: {e}"))
}

/// Columns of the table, as replay.h prints them.
const MISSED: usize = 4;
const SPURIOUS: usize = 5;
const BROKEN: usize = 6;
const TOO_DEEP: usize = 10;
const UNSOUND: usize = 11;

#[test]
fn the_committed_truth_is_true() {
    let certify = certify();
    certify.run([recording().as_os_str(), "10".as_ref()]);
}

#[test]
fn a_recording_can_be_made_anew() {
    let new = output_dir().join("new-recording.bin");
    program("recorder")
        .library("ode")
        .link_system() // that ODE's own dependency brings along
        .without_tools()
        .build()
        .run([&new]);
    let certify = certify();
    certify.run([&new]);
    certify.run([new.as_os_str(), "100".as_ref()]);
    program("replay").link_ours_shared().build().run([&new]);
}

/// The same binary on the system's libccd and on this library: this one misses
/// nothing, invents nothing, and its depths are the minimum and sound.
#[test]
fn replay_on_both_libraries() {
    let system = program("replay").link_system().build();
    let ours = system.swapped();
    let theirs = rows(&system.run([recording()]).stdout);
    let rows = rows(&ours.run([recording()]).stdout);
    assert_eq!(rows.len(), 2);
    assert_eq!(theirs.len(), 2);
    for (row, libccd) in rows.iter().zip(&theirs) {
        assert_eq!(row[1], libccd[1], "not the same queries");
        for column in [MISSED, SPURIOUS, BROKEN, UNSOUND] {
            assert_eq!(number(&row[column]), 0.0, "column {column} of {row:?}");
        }
        assert!(number(&row[TOO_DEEP]) <= 1.0, "{row:?}");
    }
}

#[test]
fn the_extension_cold_and_warm() {
    let warm = program("warm")
        .flag("-DOURS_ALONE")
        .link_ours_shared()
        .build();
    let rows = rows(&warm.run([recording()]).stdout);
    assert_eq!(rows.len(), 6);
    for row in rows {
        for column in [MISSED, SPURIOUS, BROKEN, UNSOUND] {
            assert_eq!(number(&row[column]), 0.0, "column {column} of {row:?}");
        }
        // The bare local method may end in a local minimum.
        if !row[0].starts_with("local") {
            assert!(number(&row[TOO_DEEP]) <= 1.0, "{row:?}");
        }
    }
}
