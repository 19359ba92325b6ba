// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The recorded contact sequence: its truth, and what both methods and the extension answer
//! on it.

// The recording and Debian's libccd are double.
#![cfg(not(feature = "single"))]

#[path = "../../harness/mod.rs"]
mod harness;

use harness::{Program, root};
use std::path::PathBuf;

fn recording() -> PathBuf {
    root().join("c-tests/tools/record/contacts.bin")
}

fn program(name: &str) -> Program {
    Program::c(name).source(format!("tools/record/{name}.c")).flag("-pedantic")
}

/// One method's line of the table that replay.h prints: its counts are missed, false, broken, deep
/// and unsound.
type Row = (String, [u64; 5]);

/// How many pairs overlap, and the table's rows.
fn table(written: &str) -> (u64, Vec<Row>) {
    let counted = written.lines().find_map(|line| line.strip_suffix(" of them overlap"));
    let overlaps = counted.and_then(|line| line.rsplit(' ').next()?.parse().ok());
    let lines = written.lines().skip_while(|l| !l.starts_with("method"));
    let row = |line: &str| {
        // A name may have blanks, the ten figures after it have none.
        let words: Vec<&str> = line.split_whitespace().collect();
        let (name, figures) = words.split_at(words.len() - 10);
        let wrong = [0, 1, 2, 3, 4].map(|i| figures[i].parse().expect("a count"));
        (name.join(" "), wrong)
    };
    let lines = lines.skip(1).take_while(|l| !l.is_empty());
    (overlaps.expect("a line that counts the pairs"), lines.map(row).collect())
}

/// Misses nothing, invents nothing, no answer unsound or without a direction; at most `most`
/// are more than 1 % too deep.
fn assert_right((method, wrong): &Row, most: u64) {
    let [missed, spurious, broken, deep, unsound] = *wrong;
    assert_eq!([missed, spurious, broken, unsound], [0; 4], "{method}");
    assert!(deep <= most, "{method}: {deep}");
}

#[test]
fn the_committed_truth_is_true() {
    let certify = program("certify").link_ours_static().build();
    certify.run([recording().as_os_str(), "10".as_ref()]);
}

/// The same binary on the system's libccd and on this library: this one misses
/// nothing, invents nothing, and its depths are the minimum and sound.
#[test]
fn replay_on_both_libraries() {
    let system = program("replay").link_system().build();
    let ours = system.swapped();
    let (of_theirs, theirs) = table(&system.run([recording()]).stdout);
    let (overlaps, rows) = table(&ours.run([recording()]).stdout);
    assert_eq!((rows.len(), theirs.len()), (2, 2));
    assert_eq!(overlaps, of_theirs, "not the same queries");
    rows.iter().for_each(|row| assert_right(row, overlaps / 100));
}

#[test]
fn the_extension_cold_and_warm() {
    let warm = program("replay_extension").flag("-DOURS_ALONE").link_ours_shared().build();
    let (overlaps, rows) = table(&warm.run([recording()]).stdout);
    assert_eq!(rows.len(), 8);
    for row in &rows {
        // The bare local method may end in a local minimum.
        let local = row.0.starts_with("local");
        assert_right(row, if local { overlaps } else { overlaps / 100 });
    }
}
