// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the results of libccd's calls and of the extension on the recorded contact sequence. (Its truth: `lab/truth.c`.)

use crate::harness::{Link, Program, root};
use std::path::PathBuf;

fn recording() -> PathBuf {
    root().join("c-tests/tools/record/contacts.bin")
}

fn program() -> Program {
    Program::new("tools/record/replay.c").flag("-pedantic")
}

/// Returns how many pairs overlap, and of each method in the printed table its name and its counts: missed, false,
/// broken, deep, unsound, wrong directions.
fn table(printed: &str) -> (u64, Vec<(&str, Vec<u64>)>) {
    let counted = printed.lines().find_map(|line| line.strip_suffix(" of them overlap"));
    let overlaps = counted.and_then(|line| line.rsplit(' ').next()?.parse().ok());
    let lines = printed.lines().skip_while(|l| !l.starts_with("method")).skip(1).take_while(|l| !l.is_empty());
    let rows = lines.map(|line| {
        let (name, figures) = line.split_at(17);
        let counts = figures.split_whitespace().take(6).map(|count| count.parse().expect("a count"));
        (name.trim(), counts.collect())
    });
    (overlaps.expect("a line that counts the pairs"), rows.collect())
}

/// Checks that nothing is missed, false, broken or unsound, no direction wrong where the depth is right, and at most one depth in a
/// hundred more than 1 % too deep.
fn assert_right(printed: &str, methods: usize) {
    let (overlaps, rows) = table(printed);
    assert_eq!(rows.len(), methods);
    for (method, counts) in rows {
        let deep = counts[3];
        assert_eq!(counts, [0, 0, 0, deep, 0, 0], "{method}");
        // The local method may end in a local minimum.
        assert!(method.starts_with("local") || deep <= overlaps / 100, "{method}: {deep}");
    }
}

/// One binary on the system's libccd and on this library.
#[test]
fn replay_on_both_libraries() {
    let system = program().link(Link::System).build();
    let theirs = system.run([recording()]).stdout;
    let ours = system.swapped().run([recording()]).stdout;
    let (theirs, rows) = table(&theirs);
    assert!(rows[0].1[5] > 100, "{rows:?}");
    assert_eq!((theirs, rows.len()), (table(&ours).0, 3), "not the same queries");
    assert_right(&ours, 3);
}

#[test]
fn replay_through_the_extension() {
    let extension = program().flag("-DOURS_ALONE").build();
    assert_right(&extension.run([recording()]).stdout, 10);
}
