// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The shared library answers to libccd's own SONAME, and GNU ld links it where there is
//! one; nothing else is built here. The tests, and the benchmark, whose package has this
//! script too, learn what they are compiled for, to compile C for the same.

use std::env::var;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if var("CARGO_PKG_NAME").is_ok_and(|name| name == "warmccd") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libccd.so.2");
        if has_gnu_ld() {
            println!("cargo::rustc-cdylib-link-arg={GNU_LD}");
        }
    }
    for name in ["HOST", "TARGET"] {
        let triple = var(name).expect("cargo names both");
        println!("cargo::rustc-env={name}={triple}");
    }
}

/// GNU ld leaves out what nothing calls of Rust's standard library. LLVM's, which newer Rusts
/// call by themselves, keeps all that its unwinder names, the unwinder as well, though no
/// frame of the library needs it: 300,000 bytes.
const GNU_LD: &str = "-fuse-ld=bfd";

/// Whether the C compiler that cargo links with has it.
fn has_gnu_ld() -> bool {
    println!("cargo::rerun-if-env-changed=RUSTC_LINKER");
    let linker = var("RUSTC_LINKER").unwrap_or_else(|_| "cc".to_owned());
    let said = Command::new(linker)
        .args([GNU_LD, "-Wl,--version"])
        .output();
    said.is_ok_and(|said| said.status.success() && said.stdout.starts_with(b"GNU ld"))
}
