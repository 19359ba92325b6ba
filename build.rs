// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Names the shared library as libccd's own, binds its functions to each other, and links it by
//! GNU ld on ELF systems that have it; nothing else is built here. The tests, and the lab, whose
//! package (c-tests/lab) has this script too, learn what they are compiled for, to compile C for
//! the same.

use std::env::var;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if var("CARGO_PKG_NAME").is_ok_and(|name| name == "warmccd") {
        for argument in link_arguments() {
            println!("cargo::rustc-cdylib-link-arg={argument}");
        }
    }
    for name in ["HOST", "TARGET"] {
        let triple = var(name).expect("cargo names both");
        println!("cargo::rustc-env={name}={triple}");
    }
}

/// Returns how the shared library is linked for the platform that it is built for.
fn link_arguments() -> Vec<&'static str> {
    let vendor = var("CARGO_CFG_TARGET_VENDOR").unwrap_or_default();
    let family = var("CARGO_CFG_TARGET_FAMILY").unwrap_or_default();
    if vendor == "apple" {
        // A program is told these versions of libccd's library too.
        return vec![
            "-Wl,-install_name,@rpath/libccd.2.dylib",
            "-Wl,-compatibility_version,2.0.0,-current_version,2.0.0",
        ];
    }
    if family != "unix" {
        // A DLL has no other name than that of its file.
        return Vec::new();
    }
    let mut arguments = vec!["-Wl,-soname,libccd.so.2"];
    if prints_version(OWN_FUNCTIONS).is_some() {
        arguments.push(OWN_FUNCTIONS);
    }
    if prints_version(GNU_LD).is_some_and(|version| version.starts_with(b"GNU ld")) {
        arguments.push(GNU_LD);
    }
    arguments
}

/// Binds the library's functions to each other at link time, so that none runs a function of another
/// libccd in the process.
const OWN_FUNCTIONS: &str = "-Wl,-Bsymbolic-functions";

/// GNU ld leaves out what nothing calls of Rust's standard library. LLVM's, which newer Rusts
/// call by themselves, keeps all that its unwinder names, the unwinder as well, though no
/// frame of the library needs it: 300,000 bytes.
const GNU_LD: &str = "-fuse-ld=bfd";

/// Returns what the linker prints as its version, by the C compiler that cargo links with; None where
/// either does not know the argument.
fn prints_version(argument: &str) -> Option<Vec<u8>> {
    println!("cargo::rerun-if-env-changed=RUSTC_LINKER");
    let linker = var("RUSTC_LINKER").unwrap_or_else(|_| "cc".to_owned());
    let mut command = Command::new(linker);
    let said = command.args([argument, "-Wl,--version"]).output().ok()?;
    said.status.success().then_some(said.stdout)
}
