// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests compare.sh and replay.sh on the recorded contacts. All that the tool promises about other programs:
//! `c-tests/lab/compare`.

use crate::harness::{self, Link, Precision, Program, fields, root};
use std::process::Command;

/// Checks that this library's answers are right and libccd's are not all, and that a wrong answer is kept and repeats.
#[test]
fn recorded_contacts_are_judged_and_a_wrong_answer_repeats() {
    let dir = tempfile::tempdir().expect("a directory");
    let keep = dir.path().to_str().expect("a path");
    let program = Program::new("tools/record/replay.c").link(Link::System).without_tools().build();
    let compared = program.compared(&["--fields", "--every", "100", "--keep", keep]);
    let counted = fields(&compared.run([root().join("c-tests/tools/record/contacts.bin")]).stdout, "counted");
    // MPR, and GJK at two tolerances.
    assert_eq!(counted["queries"], 3.0 * 37458.0);
    assert!(counted["judged"] > 500.0 && counted["theirs_right"] < 0.9 * counted["judged"], "{counted:?}");
    assert_eq!((counted["ours_right"], counted["contradicted"]), (counted["judged"], 0.0));

    let mut replay = Command::new("sh");
    replay.arg(root().join("c-tests/replay.sh")).arg("--library");
    replay.arg(harness::library(Precision::Double).dir.join("libccd.so")).arg(dir.path().join("libccd-deep.txt"));
    let shown = harness::must_succeed(&mut replay, "replay.sh").stdout;
    assert!(shown.contains("== libccd: ") && shown.contains("== this library") && shown.contains(": right"), "{shown}");
}

/// Checks that directions of zero are counted on every query, though none is judged.
#[test]
fn directions_of_zero_are_counted_on_every_query() {
    let program = Program::new("tools/compare/touch.c").link(Link::System).without_tools().build();
    let count = |options: &[&str]| fields(&program.compared(options).run([""; 0]).stdout, "counted");
    let [theirs, ours] = [count(&["--fields", "--every", "0"]), count(&["--fields", "--every", "0", "--swap"])];
    assert_eq!((theirs["queries"], theirs["judged"], theirs["broken"]), (1000.0, 0.0, 1000.0));
    assert_eq!((ours["queries"], ours["broken"]), (1000.0, 0.0));
    let screen = program.compared(&["--every", "0"]).run([""; 0]).stderr;
    assert!(screen.contains("1,000 of all 1,000 hits, judged or not"), "{screen}");
}
