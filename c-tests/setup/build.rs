// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Stops `cargo test`, `cargo bench` and `cargo run --example` with one line on a machine that is not
//! set up. With `C_TESTS_PARTLY=1` they continue, and tests that need a missing program fail.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-env-changed=C_TESTS_PARTLY");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../setup.sh");
    if std::env::var_os("C_TESTS_PARTLY").is_some() {
        return;
    }
    // Without a shell the tests themselves fail.
    let Ok(output) = Command::new("sh").args(["../setup.sh", "check"]).output() else {
        return;
    };
    if !output.status.success() {
        let line = [output.stdout, output.stderr].concat();
        println!("cargo::error={}", String::from_utf8_lossy(&line).trim());
    }
}
