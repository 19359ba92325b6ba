// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the programs that run before a release alone: other consumers of libccd, and FCL collided by `<ccd/fcl.hpp>`.

use super::programs::{Method, on_both, preload_library, program};
use crate::harness::{self, Executable, Link, Precision, must_succeed, output_dir, root};
use std::process::Command;

/// The programs whose simulation steps are timed and whose queries compare.sh's screen shows: title, file,
/// arguments with START for the number of the start, number of steps.
pub const CONSUMERS: [(&str, &str, &str, f64); 4] = [
    ("ODE, a pile", "ode_pile.c", "START 1500 32 pile", 1500.0),
    ("MuJoCo 2, a pile", "mujoco_pile.c", "START 1500 30", 1500.0),
    ("DART over FCL, a pile", "dart_pile.cpp", "START 3000 15", 3000.0),
    ("FCL, primitives that drift", "fcl_scene.cpp", "0 through primitives 300 200 1000", 300.0),
];

/// Returns the screen that compare.sh prints about a program.
pub fn screen(file: &str, arguments: &str) -> String {
    let program = program(file).link(Link::System).build();
    let written = must_succeed(program.compared(&[]).command().args(arguments.split(' ')), file);
    let name = file.split('.').next().unwrap_or_default();
    let path = program.path.to_string_lossy();
    let screen = written.stderr.replace(&*path, &format!("./{name} {arguments}"));
    // The program's own output on stderr comes before.
    screen[screen.find("== ").unwrap_or(0)..].trim().to_owned()
}

/// Returns the four narrow phases of `fcl_scene`.
pub fn fcl_scene() -> [Method; 4] {
    let [theirs, ours] = on_both(program("fcl_scene.cpp"));
    let header = program("fcl_scene.cpp").flag("-DBY_HEADER").flag("-DOURS_ALONE").build();
    [
        theirs.first("0"),
        ours.first("0"),
        Method::ours("`ccd/fcl.hpp`, one contact a pair", header.clone()).first("1"),
        Method::ours("`ccd/fcl.hpp`, up to 8 contacts", header).first("8"),
    ]
}

/// Returns python-fcl's wheel on the libccd that it carries, with this library preloaded, and its signed distances with
/// `libwarmccd-fcl.so` too; an error where pip cannot install it.
pub fn python_wheel() -> Result<[Method; 3], String> {
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
    let python = Executable::new(python);
    let script = root().join("c-tests/lab/engines/wheel.py");
    let theirs = Method::libccd("the wheel's libccd", python.clone()).first(&script);
    let ours = Method::ours("this library", python).first(&script);
    // Its name is the one that `libwarmccd-fcl.so` asks for.
    let library = harness::library(Precision::Double).dir.join("libccd.so.2");
    let signed = ours
        .clone()
        .named("this library and `libwarmccd-fcl.so`")
        .preload(preload_library("libwarmccd-fcl.so"))
        .first("signed");
    Ok([theirs, ours.preload(library.clone()), signed.preload(library)])
}
