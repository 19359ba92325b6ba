// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Checks the harness: each kind of link loads its library, and failures are reported.

use crate::harness::{Precision, Program, run_command};
use std::process::Command;
use std::time::Duration;

/// Returns this library's `ccdImplementation()`.
fn implementation() -> String {
    let precision = Precision::CURRENT.name();
    format!("warmccd {} {precision}", env!("CARGO_PKG_VERSION"))
}

fn identity() -> Program {
    Program::c("identity").source("harness/identity.c").strict()
}

const NO_ARGS: [&str; 0] = [];

#[test]
fn shared_and_static_programs_use_this_library() {
    let expected = format!("libccd: {}\n", implementation());
    assert_eq!(identity().link_ours_shared().build().run(NO_ARGS).stdout, expected);
    assert_eq!(identity().link_ours_static().build().run(NO_ARGS).stdout, expected);
}

/// Links this library and the system's, which is double, into one program.
#[cfg(not(feature = "single"))]
#[test]
fn one_process_has_both_libraries() {
    let both = identity().flag("-DLINK_BOTH").link_ours_renamed_and_system().build();
    let expected = format!("libccd: another\nrenamed: {}\n", implementation());
    assert_eq!(both.run(NO_ARGS).stdout, expected);
}

#[test]
fn failing_programs_fail_their_test() {
    let program = identity().link_ours_shared().build();
    let mut broken = program.clone();
    broken.path = "/bin/false".into();
    assert!(std::panic::catch_unwind(|| broken.run(NO_ARGS)).is_err());
    let run = || run_command(Command::new("sleep").arg("1000"), Duration::from_millis(20));
    assert!(std::panic::catch_unwind(run).is_err());
}
