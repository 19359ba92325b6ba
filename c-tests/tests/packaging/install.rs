// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Installs the library with CMake, and builds and runs programs on it.

// The tests and the lab each use a part.
#![allow(dead_code)]

use crate::harness::{self, Executable, Precision, must_succeed, output_dir, root};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Makes an empty directory of this name.
pub fn empty_dir(name: &str) -> PathBuf {
    let dir = output_dir().join("packaging").join(Precision::CURRENT.name()).join(name);
    if dir.exists() {
        fs::remove_dir_all(&dir).expect("an old run's directory can be removed");
    }
    fs::create_dir_all(&dir).expect("a directory can be made");
    dir
}

/// Runs a tool, which must succeed, and returns its standard output.
pub fn run(mut tool: Command, args: &[&dyn AsRef<OsStr>]) -> String {
    tool.args(args);
    let name = tool.get_program().to_string_lossy().into_owned();
    must_succeed(&mut tool, &name).stdout
}

pub fn cmake(args: &[&dyn AsRef<OsStr>]) {
    run(Command::new("cmake"), args);
}

/// Returns the command that configures `source` in the folder `build`.
pub fn configure(source: &Path, build: &Path) -> Command {
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(source).arg("-B").arg(build);
    cmake
}

pub fn c_compiler() -> Command {
    harness::compiler(false)
}

pub fn define(name: &str, value: impl AsRef<Path>) -> String {
    format!("-D{name}={}", value.as_ref().display())
}

pub fn precision_option() -> String {
    let double = ["OFF", "ON"][usize::from(Precision::CURRENT == Precision::Double)];
    define("ENABLE_DOUBLE_PRECISION", double)
}

/// Configures and builds `source` in the folder `build`, with the library that the other tests' programs have;
/// `options` may name another folder of cargo's.
pub fn build(source: &str, build: &Path, options: &[String]) {
    let cargo = define("CCD_CARGO_TARGET_DIR", harness::cargo_dir());
    let mut configure = configure(&root().join(source), build);
    must_succeed(configure.args([precision_option(), cargo]).args(options), "cmake");
    cmake(&[&"--build", &build]);
}

/// Installs the library under a prefix, then moves the prefix and removes the build tree: no file may
/// refer to either. Returns the new prefix.
pub fn installed_and_moved() -> &'static Path {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let dir = empty_dir("installed");
        let (tree, first, prefix) = (dir.join("build"), dir.join("first"), dir.join("prefix"));
        build("cmake", &tree, &[define("CMAKE_INSTALL_PREFIX", &first)]);
        cmake(&[&"--install", &tree]);
        fs::remove_dir_all(&tree).expect("the build tree can be removed");
        fs::rename(&first, &prefix).expect("the prefix can be moved");
        prefix
    })
}

/// Configures and builds the consumer in the folder `name`, which it returns. `options` override the
/// usual ones.
pub fn consumer(name: &str, way: &str, options: &[String]) -> PathBuf {
    let folder = empty_dir(name);
    let usual = [define("WAY", way), define("REPOSITORY", root())];
    build("c-tests/tests/packaging/consumer", &folder, &[&usual, options].concat());
    folder
}

/// Checks that the program runs on this repository's library: the shared one under `shared_under`, or
/// the static one.
pub fn assert_runs_on_ours(program: &Path, shared_under: Option<&Path>) {
    let name = program.file_name().expect("a program").to_string_lossy();
    let program = Executable::new(program);
    let loaded = program.loaded_ccd();
    match shared_under {
        Some(dir) => assert!(loaded.as_ref().is_some_and(|path| path.starts_with(dir)), "{name} runs on {loaded:?}"),
        None => assert_eq!(loaded, None, "{name} is linked statically"),
    }
    let expected = format!("warmccd {} {}\n", harness::of_package("version"), Precision::CURRENT.name());
    assert_eq!(program.run([""; 0]).stdout, expected);
}

/// Checks the consumer's programs `names`, which use the shared library, and `static`.
pub fn assert_all_run_on_ours(programs: &Path, shared_under: &Path, names: &[&str]) {
    for name in names {
        assert_runs_on_ours(&programs.join(name), Some(shared_under));
    }
    assert_runs_on_ours(&programs.join("static"), None);
}

pub fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).expect("a page")
}

/// Checks a size in bytes.
pub fn assert_small(name: &str, size: u64, most: u64) {
    println!("{name}: {size} bytes, at most {most}");
    assert!(size <= most, "{name}: {size} bytes");
}

pub fn size(path: &Path) -> u64 {
    fs::metadata(path).expect("a file").len()
}

/// Returns the one file of this name below a directory.
pub fn find(dir: &Path, name: &str) -> PathBuf {
    let found = run(Command::new("find"), &[&dir, &"-name", &name]);
    assert_eq!(found.lines().count(), 1, "{name}: {found}");
    PathBuf::from(found.trim_end())
}
