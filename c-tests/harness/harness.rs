// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Checks that the harness reports failures.

use crate::harness::{Executable, run_command};
use std::process::Command;
use std::time::Duration;

#[test]
fn failing_programs_fail_their_test() {
    let broken = Executable::new("/bin/false");
    assert!(std::panic::catch_unwind(|| broken.run([""; 0])).is_err());
    let run = || run_command(Command::new("sleep").arg("1000"), Duration::from_millis(20));
    assert!(std::panic::catch_unwind(run).is_err());
}
