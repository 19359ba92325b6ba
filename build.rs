// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The shared library answers to libccd's own SONAME; nothing else is built here.
//! The tests, and the benchmark, whose package has this script too, learn what they are
//! compiled for, to compile C for the same.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_PKG_NAME").is_ok_and(|name| name == "warmccd") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libccd.so.2");
    }
    for name in ["HOST", "TARGET"] {
        let triple = std::env::var(name).expect("cargo names both");
        println!("cargo::rustc-env={name}={triple}");
    }
}
