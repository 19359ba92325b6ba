// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the release library and C or C++ programs that link it, by make (`programs.mk`), runs them, and asserts which
//! libccd they load. The programs of tests and of the lab include this file as their module `harness`.
//!
//! ```ignore
//! let program = Program::new("tests/contract/touches.c").flag("-DOURS_ALONE").link(Link::Static).build();
//! program.run(["100"]);
//! ```
//!
//! The `cc` crate finds the compilers and reads `CC`, `CXX`, `CFLAGS`, `CXXFLAGS`; `NM` and `OBJCOPY` name other tools.
//! All programs but those marked `without_tools` are compiled and linked with `C_TESTS_FLAGS` (`-fsanitize=address`) and run
//! by `C_TESTS_RUNNER` (`valgrind --error-exitcode=99`). Programs for another platform are run by
//! `CARGO_TARGET_<its name>_RUNNER` (`qemu-aarch64`), as the test itself.

// Each driver uses a part of this module.
#![allow(dead_code, unused_imports)]

mod build;
mod run;

pub use build::{Link, Program, cargo_dir, library, locked};
pub use run::{Executable, Written, fields, must_succeed, run_command};

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The scalar of a build of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    Double,
    Single,
}

impl Precision {
    /// Precision that this test is compiled for.
    pub const CURRENT: Precision = if cfg!(feature = "single") { Precision::Single } else { Precision::Double };

    /// Returns the last word of `ccdImplementation()`.
    pub fn name(self) -> &'static str {
        ["double", "single"][self as usize]
    }
}

/// Returns the repository's root.
pub fn root() -> &'static Path {
    // The lab's package is in a subfolder.
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    folders.find(|dir| dir.join("c-tests").is_dir()).expect("a package of the repository")
}

/// Returns the folder of all output of this module, `target/c-tests`.
pub fn output_dir() -> PathBuf {
    // Cargo passes the path of target/tmp to tests and benchmarks.
    let tmp = option_env!("CARGO_TARGET_TMPDIR").map(|tmp| PathBuf::from(tmp).join(".."));
    let dir = tmp.unwrap_or_else(|| root().join("target")).join("c-tests");
    let made = fs::create_dir_all(&dir).and_then(|()| dir.canonicalize());
    made.unwrap_or_else(|e| panic!("{}: {e}", dir.display()))
}

/// Target of this test, its programs and the library.
const TARGET: &str = env!("TARGET");

/// Returns whether the programs are for another processor than this machine's.
pub fn emulated() -> bool {
    TARGET != env!("HOST")
}

/// Splits an environment variable at blanks; empty where it is not set.
fn words(variable: &str) -> Vec<String> {
    std::env::var(variable).unwrap_or_default().split_whitespace().map(String::from).collect()
}

/// Returns the command of a tool for object files, which the variable of its name in capitals may give.
pub fn binutils(name: &str) -> Command {
    let given = words(&name.to_uppercase());
    let mut command = Command::new(given.first().map_or(name, |name| name));
    command.args(given.iter().skip(1));
    command
}

/// Returns the C or C++ compiler that the `cc` crate finds, with the flags of all programs.
pub fn compiler_builder(cpp: bool) -> cc::Build {
    let mut build = cc::Build::new();
    build.cpp(cpp).target(TARGET).host(env!("HOST")).out_dir(output_dir()).cargo_metadata(false);
    build.opt_level(2).warnings(true).extra_warnings(true);
    // It takes a third of the compile time of C++.
    build.debug(!cpp || under_tool());
    // One rounding per operation gives the same bits on every machine.
    build.flag("-ffp-contract=off");
    if cfg!(target_arch = "x86") {
        build.flag("-msse2").flag("-mfpmath=sse");
    }
    build
}

/// Returns the command of the compiler; panics where there is none.
pub fn compiler(cpp: bool) -> Command {
    let found = compiler_builder(cpp).try_get_compiler();
    found.unwrap_or_else(|e| panic!("{e}: run `sh c-tests/setup.sh` first")).to_command()
}

/// Returns whether `command --version` succeeds.
pub fn installed(command: &str) -> bool {
    let output = Command::new(command).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

/// Returns the value of the first line of a file that starts with `key`.
fn value_in(file: impl AsRef<Path>, key: &str) -> String {
    let text = fs::read_to_string(file).unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with(key));
    let value = line.and_then(|line| line.split_once(['=', ':']));
    value.map_or("unknown".to_owned(), |(_, value)| value.replace('"', "").trim().to_owned())
}

/// Returns `version` or `rust-version` of the library's package.
pub fn of_package(key: &str) -> String {
    value_in(root().join("Cargo.toml"), key)
}

/// Returns the system's release and the processor, for figures measured on this machine.
pub fn machine() -> String {
    let [name, release] = ["NAME=", "VERSION_ID="].map(|key| value_in("/etc/os-release", key));
    let name = name.split(' ').next().unwrap_or_default();
    format!("{name} {release}, {}", value_in("/proc/cpuinfo", "model name"))
}

/// Returns the maker and family of the processor, by which the C library chooses among its functions.
pub fn processor_family() -> String {
    ["vendor_id", "cpu family"].map(|key| value_in("/proc/cpuinfo", key)).join(" ")
}

/// Returns whether programs are compiled for a tool, or run under one.
pub fn under_tool() -> bool {
    ["C_TESTS_FLAGS", "C_TESTS_RUNNER"].iter().any(|name| !words(name).is_empty())
}

/// Returns the number of a program's inputs: all, or a tenth under a tool, which checks memory and is
/// ten times slower.
pub fn rounds(all: u32) -> String {
    (all / if under_tool() { 10 } else { 1 }).to_string()
}
