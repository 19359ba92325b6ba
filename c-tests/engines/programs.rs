// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds and runs the programs of this folder on libccd and on this library, and reads the
//! counters that they print. The tests (`swap.rs`) and the lab share it.

// Each driver uses a part.
#![allow(dead_code)]

use crate::harness::{Executable, Link, Program, cargo_dir, locked, must_succeed, output_dir, root, run_command};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// Returns a program of this folder or of `lab/engines`, linked to the library that its name begins with.
pub fn program(file: &str) -> Program {
    let tests = root().join("c-tests");
    let sources = ["engines", "lab/engines"].map(|folder| tests.join(folder).join(file));
    let source = sources.iter().find(|source| source.exists()).expect("a source file");
    let (library, _) = file.split_once('_').expect("a library's program");
    let own = if file.ends_with(".c") { "-std=gnu99" } else { "-isystem/usr/include/eigen3" };
    let program = Program::new(source).flag(own).flag("-D_GNU_SOURCE").flag(format!("-l{library}")).without_tools();
    // FCL's octrees are those of octomap.
    let octomap: &[&str] = if library == "fcl" { &["-loctomap", "-loctomath"] } else { &[] };
    octomap.iter().fold(program, |program, flag| program.flag(*flag))
}

/// Output of a program.
pub struct Output {
    pub method: &'static str,
    pub text: String,
    counters: BTreeMap<String, f64>,
}

impl Output {
    /// Reads the lines `line key value key value …` as counters named `line.key`. Those that compare.sh
    /// prints about the library `side` are named `own.key` as well.
    fn parse(method: &'static str, text: String, side: &str) -> Output {
        let mut counters = BTreeMap::new();
        for line in text.lines().filter(|line| !line.contains(':')) {
            let words: Vec<&str> = line.split_whitespace().collect();
            for pair in words.get(1..).unwrap_or_default().chunks_exact(2) {
                let Ok(value) = pair[1].parse() else { continue };
                counters.insert(format!("{}.{}", words[0], pair[0]), value);
                if let Some(key) = pair[0].strip_prefix(side) {
                    counters.insert(format!("own.{key}"), value);
                }
            }
        }
        if let Some(judged) = counters.get("counted.judged").copied() {
            counters.insert("own.queries".to_owned(), judged);
        }
        Output { method, text, counters }
    }

    pub fn get(&self, key: &str) -> Option<f64> {
        self.counters.get(key).copied()
    }

    /// Returns the counter of this name, which the program must have printed.
    pub fn value(&self, key: &str) -> f64 {
        self.get(key).unwrap_or_else(|| panic!("{}: no `{key}` in {}", self.method, self.text))
    }

    pub fn sum(&self, keys: &str) -> f64 {
        keys.split(' ').map(|key| self.value(key)).sum()
    }

    /// Describes those of these counters, which the program must have printed, that are not zero.
    pub fn nonzero(&self, keys: &str) -> Vec<String> {
        let counters = keys.split(' ').map(|key| (key, self.value(key)));
        counters.filter(|(_, n)| *n != 0.0).map(|(key, n)| format!("{}: {key} {n}", self.method)).collect()
    }
}

/// A program on one of the libraries.
#[derive(Clone)]
pub struct Method {
    pub name: &'static str,
    is_ours: bool,
    program: Executable,
    /// Its first arguments.
    first: Vec<OsString>,
    /// In the order of `LD_PRELOAD`.
    preloaded: Vec<PathBuf>,
}

impl Method {
    pub fn libccd(name: &'static str, program: Executable) -> Method {
        Method { name, is_ours: false, program, first: Vec::new(), preloaded: Vec::new() }
    }

    pub fn ours(name: &'static str, program: Executable) -> Method {
        Method { is_ours: true, ..Method::libccd(name, program) }
    }

    /// Gives it another name.
    pub fn named(self, name: &'static str) -> Method {
        Method { name, ..self }
    }

    /// Adds a first argument.
    pub fn first(mut self, argument: impl Into<OsString>) -> Method {
        self.first.push(argument.into());
        self
    }

    /// Loads a library before the others of the program, after those that this was said of before.
    pub fn preload(mut self, library: PathBuf) -> Method {
        self.preloaded.push(library);
        self
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = self.program.command();
        command.args(&self.first).args(arguments.split_whitespace());
        preload(&mut command, &self.preloaded);
        command
    }

    /// Runs the program, which names the library in its process first; panics unless it is the right one
    /// and the program succeeds.
    pub fn run(&self, arguments: &str) -> Output {
        let (status, written) = run_command(&mut self.command(arguments), Duration::from_secs(300));
        assert!(status.success(), "{}: {status}\n{}", self.name, written.stderr);
        let (library, side) = if self.is_ours { ("library warmccd ", "ours_") } else { ("library libccd", "theirs_") };
        let first = written.stdout.lines().next();
        assert!(written.stdout.starts_with(library), "{}: on {first:?}", self.name);
        Output::parse(self.name, written.stdout, side)
    }
}

/// Loads libraries before the others of a command's program. By their file names: the dynamic linker
/// splits `LD_PRELOAD` at blanks, which a path may contain.
fn preload(command: &mut Command, libraries: &[PathBuf]) {
    if libraries.is_empty() {
        return;
    }
    let mut dirs: Vec<_> =
        libraries.iter().map(|library| library.parent().expect("a file in a directory").to_owned()).collect();
    let own = command.get_envs().find(|(name, _)| *name == "LD_LIBRARY_PATH");
    dirs.extend(own.and_then(|(_, dir)| dir).map(PathBuf::from));
    let names = libraries.iter().map(|library| library.file_name().expect("a file"));
    command.env("LD_PRELOAD", names.collect::<Vec<_>>().join(OsStr::new(":")));
    command.env("LD_LIBRARY_PATH", std::env::join_paths(dirs).expect("paths without a colon"));
}

/// Runs a program by each method at once.
pub fn run_all<const N: usize>(methods: &[Method; N], arguments: &str) -> [Output; N] {
    std::thread::scope(|scope| {
        let runs = methods.each_ref().map(|method| scope.spawn(|| method.run(arguments)));
        runs.map(|run| run.join().expect("a run"))
    })
}

/// Returns a program on libccd and on this library.
pub fn on_both(program: Program) -> [Method; 2] {
    let program = program.link(Link::System).build();
    let ours = program.swapped();
    [Method::libccd("libccd", program), Method::ours("this library", ours)]
}

/// Returns a program on libccd and on this library under compare.sh, which judges one query in `every`.
pub fn compared(program: Program, every: &str) -> [Method; 2] {
    let program = program.link(Link::System).build();
    let options = ["--fields", "--no-times", "--every", every, "--swap"];
    let [theirs, ours] = [&options[..4], &options].map(|options| program.compared(options));
    [Method::libccd("libccd", theirs), Method::ours("this library", ours)]
}

/// Returns FCL's signed distance, as [`with_fcl_preload`].
pub fn fcl_distance() -> [Method; 3] {
    // The rows of configurations.h name the fields that they set.
    with_fcl_preload(program("fcl_distance.cpp").flag("-Wno-missing-field-initializers"))
}

/// Returns a program on libccd, on this library, and on this library with `libwarmccd-fcl.so` preloaded.
pub fn with_fcl_preload(program: Program) -> [Method; 3] {
    let [theirs, ours] = on_both(program);
    let preloaded = ours.clone().named("this library and `libwarmccd-fcl.so`");
    [theirs, ours, preloaded.preload(preload_library("libwarmccd-fcl.so"))]
}

/// Builds the libraries that are preloaded for FCL as cmake/README.md says, and returns one; the flags are the tests' own.
pub fn preload_library(name: &str) -> PathBuf {
    let build = output_dir().join("fcl");
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(root().join("cmake")).arg("-B").arg(&build).args([
        "-DCCD_FCL=ON",
        "-DCMAKE_C_FLAGS=-Wextra -Werror",
        "-DCMAKE_CXX_FLAGS=-Wextra -Werror",
    ]);
    cmake.arg(format!("-DCCD_CARGO_TARGET_DIR={}", cargo_dir().display()));
    let lock = locked(&output_dir().join("fcl.lock"));
    must_succeed(&mut cmake, "cmake");
    must_succeed(Command::new("cmake").arg("--build").arg(&build), "cmake --build");
    drop(lock);
    build.join("lib").join(name)
}
