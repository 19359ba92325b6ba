// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The harness itself: each kind of link runs on the library it names.

#[path = "mod.rs"]
mod harness;

use harness::{Precision, Program};

fn name() -> String {
    let precision = Precision::CURRENT.name();
    format!("warmccd {} {precision}", env!("CARGO_PKG_VERSION"))
}

fn identity() -> Program {
    Program::c("identity").source("harness/identity.c").flag("-pedantic").flag("-Werror")
}

const NO_ARGS: [&str; 0] = [];

#[test]
fn shared_and_static_programs_run_on_ours() {
    let expected = format!("libccd: {}\n", name());
    assert_eq!(identity().link_ours_shared().build().run(NO_ARGS).stdout, expected);
    assert_eq!(identity().link_ours_static().build().run(NO_ARGS).stdout, expected);
}

/// The system's library is double.
#[cfg(not(feature = "single"))]
#[test]
fn one_process_holds_both() {
    let both = identity().flag("-DLINK_BOTH").link_ours_renamed_and_system().build();
    let expected = format!("libccd: another\nrenamed: {}\n", name());
    assert_eq!(both.run(NO_ARGS).stdout, expected);
}

#[test]
fn a_failing_program_fails_its_test() {
    let program = identity().link_ours_shared().build();
    let mut broken = program.clone();
    broken.path = "/bin/false".into();
    assert!(std::panic::catch_unwind(|| broken.run(NO_ARGS)).is_err());
    let mut hanging = program.timeout(std::time::Duration::from_millis(20));
    hanging.path = "/bin/sleep".into();
    assert!(std::panic::catch_unwind(|| hanging.run(["1000"])).is_err());
}
