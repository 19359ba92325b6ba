// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Stops `cargo test`, `cargo bench` and `cargo run --example` on a machine that is not
//! set up, with one line. `C_TESTS_PARTLY=1` goes on all the same: what needs a missing
//! program will fail.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-env-changed=C_TESTS_PARTLY");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../setup.sh");
    if std::env::var_os("C_TESTS_PARTLY").is_some() {
        return;
    }
    // Without a shell there is no setup.sh to run either: the tests themselves will tell.
    let Ok(said) = Command::new("sh").args(["../setup.sh", "check"]).output() else {
        return;
    };
    if !said.status.success() {
        let line = [said.stdout, said.stderr].concat();
        println!("cargo::error={}", String::from_utf8_lossy(&line).trim());
    }
}
