// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds and runs the programs of this folder on libccd and on this library, and reads the
//! counters that they print. The tests (`swap.rs`) and the tables (`table.rs`) share it.

// Each driver uses a part.
#![allow(dead_code)]

use crate::harness::{self, Executable, Precision, Program, must_succeed, output_dir, root, run_command};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// Returns a program of this folder, linked to the library that its name begins with.
pub fn program(file: &str) -> Program {
    let (name, extension) = file.split_once('.').expect("a source file");
    let program = match extension {
        "c" => Program::c(name).standard("gnu99"),
        _ => Program::cpp(name).flag("-isystem/usr/include/eigen3"),
    };
    let library = name.split('_').next().expect("a library");
    program.source(format!("engines/{file}")).flag("-D_GNU_SOURCE").library(library).without_tools()
}

/// The programs whose simulation steps are timed and whose queries compare.sh's screen shows: title, file,
/// arguments, number of steps.
pub const CONSUMERS: [(&str, &str, &str, f64); 4] = [
    ("ODE, a pile", "ode_pile.c", "1 1500 32 pile", 1500.0),
    ("MuJoCo 2, a pile", "mujoco_pile.c", "1 1500 30 pile", 1500.0),
    ("DART over FCL, a pile", "dart_pile.cpp", "1 3000 15 fcl", 3000.0),
    ("FCL, bodies that drift", "fcl_scene.cpp", "0 300 200 0", 300.0),
];

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

    /// Returns the support points of a query, of those that were counted.
    pub fn supports_per_query(&self) -> f64 {
        self.value("own.supports") / self.value("own.queries")
    }

    /// Sets a counter that was measured otherwise.
    pub fn set(&mut self, key: &str, value: f64) {
        self.counters.insert(key.to_owned(), value);
    }

    /// Describes those of these counters that were printed and are not zero.
    pub fn nonzero(&self, keys: &str) -> Vec<String> {
        let nonzero = keys.split(' ').filter_map(|key| Some((key, self.get(key).filter(|n| *n != 0.0)?)));
        nonzero.map(|(key, n)| format!("{}: {key} {n}", self.method)).collect()
    }

    /// Returns the lines about wrong results, `wrong: …`.
    pub fn wrong(&self) -> Vec<String> {
        let is_wrong = |line: &&str| line.split(' ').next().is_some_and(|word| word.ends_with(':'));
        self.text.lines().filter(is_wrong).map(String::from).collect()
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
    preloaded: Option<PathBuf>,
}

impl Method {
    pub fn libccd(name: &'static str, program: Executable) -> Method {
        Method { name, is_ours: false, program, first: Vec::new(), preloaded: None }
    }

    pub fn ours(name: &'static str, program: Executable) -> Method {
        Method { is_ours: true, ..Method::libccd(name, program) }
    }

    /// Adds a first argument.
    pub fn first(mut self, argument: impl Into<OsString>) -> Method {
        self.first.push(argument.into());
        self
    }

    /// Loads a library before the others of the program.
    pub fn preload(mut self, library: PathBuf) -> Method {
        self.preloaded = Some(library);
        self
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = self.program.command();
        command.args(&self.first).args(arguments.split_whitespace());
        if let Some(library) = &self.preloaded {
            harness::preload(&mut command, library);
        }
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

/// Runs a program by each method at once.
pub fn run_all<const N: usize>(methods: &[Method; N], arguments: &str) -> [Output; N] {
    std::thread::scope(|scope| {
        let runs = methods.each_ref().map(|method| scope.spawn(|| method.run(arguments)));
        runs.map(|run| run.join().expect("a run"))
    })
}

/// Returns a program on libccd and on this library.
pub fn on_both(program: Program) -> [Method; 2] {
    let program = program.link_system().build().quiet();
    let ours = program.swapped();
    [Method::libccd("libccd", program), Method::ours("this library", ours)]
}

/// Returns a program on libccd and on this library under compare.sh, which judges one query in `every`.
pub fn compared(program: Program, every: &str) -> [Method; 2] {
    let program = program.flag("-rdynamic").link_system().build().quiet();
    let options = ["--no-times", "--every", every, "--swap"];
    let [theirs, ours] = [&options[..3], &options].map(|options| program.compared(options));
    [Method::libccd("libccd", theirs), Method::ours("this library", ours)]
}

/// Returns the same with every query judged on this library, and none on libccd.
pub fn ours_judged(program: Program) -> [Method; 2] {
    let [_, ours] = compared(program.clone(), "1");
    let theirs = program.flag("-rdynamic").link_system().build().quiet();
    [Method::libccd("libccd", theirs), ours]
}

/// Returns the screen that compare.sh prints about a program.
pub fn screen(file: &str, arguments: &str) -> String {
    let program = program(file).flag("-DTIMED").link_system().build().quiet();
    let written = program.compared(&[]).with_screen().run(arguments.split(' '));
    let name = file.split('.').next().unwrap_or_default();
    let path = program.path.to_string_lossy();
    let screen = written.stderr.replace(&*path, &format!("./{name} {arguments}"));
    // The program's own output on stderr comes before.
    screen[screen.find("== ").unwrap_or(0)..].trim().to_owned()
}

/// Returns FCL's signed distance on libccd, on this library, and on this library with
/// `libwarmccd-fcl.so` preloaded.
pub fn fcl_distance() -> [Method; 3] {
    // The rows of configurations.h name the fields that they set.
    let [theirs, ours] = on_both(program("fcl_distance.cpp").flag("-Wno-missing-field-initializers"));
    let library = output_dir().join("libwarmccd-fcl.so");
    let mut compile = harness::compile_with(&harness::compiler(true));
    compile.args(["-std=c++11", "-fPIC", "-shared", "-Wextra", "-Werror"]);
    compile.args(["-fvisibility=hidden", "-isystem/usr/include/eigen3"]);
    compile.arg("-I").arg(root().join("include"));
    compile.arg(root().join("cmake/fcl/signed_distance.cpp")).arg("-o").arg(&library);
    compile.arg("-L").arg(&harness::library(Precision::Double).dir).arg("-lccd");
    must_succeed(&mut compile, "the compiler (for libwarmccd-fcl.so)");
    let preloaded = Method { name: "this library and `libwarmccd-fcl.so`", ..ours.clone() };
    [theirs, ours, preloaded.preload(library)]
}

/// Returns the four narrow phases of `fcl_scene`, judged by their answers; or timed, without the judge.
pub fn fcl_scene(is_timed: bool) -> [Method; 4] {
    let program = || match is_timed {
        true => program("fcl_scene.cpp").flag("-DTIMED"),
        false => program("fcl_scene.cpp"),
    };
    let [theirs, ours] = if is_timed {
        on_both(program())
    } else {
        let both = program().link_ours_renamed_and_system().build().quiet();
        let options = ["--every", "1", "--no-times", "--swap"];
        let [theirs, ours] = [&options[..3], &options].map(|options| both.compared(options));
        [Method::libccd("", theirs), Method::ours("", ours)]
    };
    let header = program().flag("-DBY_HEADER").flag("-DOURS_ALONE").link_ours_shared().build().quiet();
    [
        Method { name: "`fcl::collide` on libccd", ..theirs }.first("0"),
        Method { name: "`fcl::collide` on this library", ..ours }.first("0"),
        Method::ours("`ccd/fcl.hpp`, one contact a pair", header.clone()).first("1"),
        Method::ours("`ccd/fcl.hpp`, up to 8 contacts", header).first("8"),
    ]
}

/// Returns an ODE scene on libccd as ODE queries it, and with geometries that this library collides, with one
/// contact a pair and with several.
pub fn ode_world(libccd: Method) -> [Method; 3] {
    let world = |contacts| {
        let program = program("ode_pile.c").flag(format!("-DCONTACTS={contacts}")).flag("-DOURS_ALONE");
        program.link_ours_shared().build().quiet()
    };
    [
        libccd,
        Method::ours("this library, one contact a pair", world(1)),
        Method::ours("this library, `ccdContacts`", world(8)),
    ]
}

/// Returns python-fcl's wheel on the libccd that it carries and with this library preloaded; an error where
/// pip cannot install it.
pub fn python_wheel() -> Result<[Method; 2], String> {
    let dir = output_dir().join("wheel");
    let python = dir.join("bin/python");
    let try_to = |command: &mut Command| {
        let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        output.status.success().then_some(()).ok_or(error)
    };
    if try_to(Command::new(&python).args(["-c", "import fcl"])).is_err() {
        try_to(Command::new("python3").args(["-m", "venv"]).arg(&dir))?;
        let mut pip = Command::new(&python);
        try_to(pip.args(["-m", "pip", "install", "--only-binary=:all:", "python-fcl"]))?;
    }
    let python = Executable::from_path("python-fcl", python);
    let script = root().join("c-tests/engines/wheel.py");
    let theirs = Method::libccd("the wheel's libccd", python.clone()).first(&script);
    let ours = Method::ours("this library", python).first(&script);
    let library = harness::library(Precision::Double).dir.join("libccd.so");
    Ok([theirs, ours.preload(library)])
}

/// A column of a table: heading and cell.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

/// Returns a Markdown table with a row for each of `rows`.
pub fn markdown<T>(rows: &[T], columns: &[Column<T>]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let head = line(columns.iter().map(|(heading, _)| (*heading).to_owned()).collect());
    let rule = format!("|{}\n", "---|".repeat(columns.len()));
    let rows = rows.iter().map(|row| line(columns.iter().map(|(_, cell)| cell(row)).collect()));
    [head, rule].into_iter().chain(rows).collect()
}
