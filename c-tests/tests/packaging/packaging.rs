// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Uses the installed library by find_package and pkg-config, builds it with the oldest Rust, and runs the programs of
//! README.md and include/README.md. Other ways to build and install: `c-tests/lab/packaging.rs`.

mod install;

use crate::harness::{self, Executable, Link, Precision, Program, must_succeed, output_dir, root};
use install::{
    assert_all_run_on_ours, assert_runs_on_ours, c_compiler, consumer, define, empty_dir, find, installed_and_moved,
    page, run,
};
#[cfg(not(feature = "single"))]
use install::{assert_small, size};
use std::fs;
#[cfg(not(feature = "single"))]
use std::path::Path;
use std::path::PathBuf;
use std::process::Command;

#[test]
fn find_package() {
    let prefix = installed_and_moved();
    let build = consumer("find_package", "find_package", &[define("CMAKE_PREFIX_PATH", prefix)]);
    assert_all_run_on_ours(&build, prefix, &["plain", "namespaced", "variables"]);
}

#[test]
fn pkg_config() {
    let prefix = installed_and_moved();
    let programs = empty_dir("pkg-config");
    let archive = find(prefix, "libccd.a");
    let libdir = archive.parent().expect("a directory");
    let pkg_config = |args: &[&str]| -> Vec<String> {
        let mut command = Command::new("pkg-config");
        command.env("PKG_CONFIG_PATH", libdir.join("pkgconfig"));
        let flags = must_succeed(command.args(args).arg("ccd"), "pkg-config").stdout;
        // A shell splits the flags: blanks within a path are escaped.
        let split = format!("printf '%s\\n' {}", flags.trim());
        run(Command::new("sh"), &[&"-c", &split]).lines().map(String::from).collect()
    };
    assert_eq!(pkg_config(&["--modversion"]), ["2.0"]);
    let compile = |name: &str, flags: &[String]| {
        let program = programs.join(name);
        let mut cc = c_compiler();
        cc.arg(root().join("c-tests/tests/packaging/consumer/main.c")).args(flags);
        run(cc, &[&"-o", &program]);
        program
    };

    let mut shared = pkg_config(&["--cflags", "--libs"]);
    shared.push(format!("-Wl,-rpath,{}", libdir.display()));
    assert_runs_on_ours(&compile("shared", &shared), Some(prefix));

    // Only libccd static.
    let mut one = pkg_config(&["--static", "--cflags", "--libs"]);
    for flag in one.iter_mut().filter(|flag| *flag == "-lccd") {
        *flag = "-l:libccd.a".to_owned();
    }
    assert_runs_on_ours(&compile("one-static", &one), None);

    // Everything static: the C library and the unwinder too.
    let mut all = pkg_config(&["--static", "--cflags", "--libs"]);
    all.push("-static".to_owned());
    assert_runs_on_ours(&compile("all-static", &all), None);
}

/// Checks that a program for the other precision does not compile.
#[test]
fn other_precision_does_not_compile() {
    let other = match Precision::CURRENT {
        Precision::Double => "-DCCD_SINGLE",
        Precision::Single => "-DCCD_DOUBLE",
    };
    let prefix = installed_and_moved();
    let compiles = |flags: &[&str]| {
        let mut cc = c_compiler();
        cc.arg("-I").arg(prefix.join("include")).arg("-fsyntax-only");
        cc.arg(root().join("c-tests/tests/packaging/consumer/main.c")).args(flags);
        cc.output().expect("cc runs").status.success()
    };
    assert!(compiles(&[]));
    assert!(!compiles(&[other]));
}

/// Checks that the oldest supported Rust builds the library without a warning: rustup's, or the
/// system's where it has that version (Debian 13).
#[test]
fn oldest_rust_builds_the_library() {
    let version = env!("CARGO_PKG_RUST_VERSION");
    let has_version = |command: &&[&str]| {
        let output = Command::new(command[0]).args(&command[1..]).arg("--version").output();
        output.is_ok_and(|output| output.stdout.starts_with(format!("cargo {version}.").as_bytes()))
    };
    let choices = [&["rustup", "run", version, "cargo"][..], &["/usr/bin/cargo"]];
    let Some(cargo) = choices.into_iter().find(has_version) else {
        println!("skipped: no Rust {version} (rustup toolchain install {version})");
        return;
    };
    let mut build = Command::new(cargo[0]);
    build
        .args(&cargo[1..])
        .args(["build", "--release", "--lib", "--locked"])
        .args(["--config", "profile.release.debug=false"])
        .current_dir(root())
        .arg("--target-dir")
        .arg(output_dir().join("oldest-rust"))
        .env("RUSTFLAGS", "-D warnings");
    // Cargo set these for the compiler of this test.
    for variable in ["CARGO", "RUSTC", "RUSTUP_TOOLCHAIN", "CARGO_ENCODED_RUSTFLAGS"] {
        build.env_remove(variable);
    }
    if Precision::CURRENT == Precision::Single {
        build.args(["--features", "single"]);
    }
    must_succeed(&mut build, "cargo");
    // It proves fewer bounds than a newer one, and builds Debian's packages.
    let symbols = run(harness::binutils("nm"), &[&output_dir().join("oldest-rust/release/libccd.so")]);
    assert!(symbols.contains(" t "), "no local symbols");
    assert!(!symbols.contains("panicking"), "a panic is linked by Rust {version}");
}

/// Extracts a page's program in a language into a file in the folder `place`.
fn program_of(place: &str, name: &str, language: &str) -> PathBuf {
    let page = page(name);
    let program =
        page.split_once(&format!("```{language}\n")).and_then(|(_, rest)| rest.split_once("```")).expect("a program").0;
    let source = empty_dir(place).join(format!("program.{language}"));
    fs::write(&source, program).expect("a file can be written");
    source
}

/// Returns the numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    let words = line.split(|c: char| !"+-.e".contains(c) && !c.is_ascii_digit());
    words.filter_map(|word| word.parse().ok()).collect()
}

/// Checks the output of include/README.md's C program: its box is 1 cm deep in the slab, face on face,
/// and 1 mm deeper in each of two more frames.
fn assert_depth_of_the_box(output: &str) {
    assert_eq!(output.lines().count(), 3, "{output}");
    for line in output.lines() {
        let [frame, depth, up, contacts] = numbers(line)[..] else {
            panic!("{line}");
        };
        assert!((depth - 0.01 - 0.001 * frame).abs() < 1e-5, "{line}");
        assert!(up > 0.999_999 && contacts == 4.0, "{line}");
    }
}

/// Checks the output of README.md's program, whose ball is 10 cm deep in its slab, and the output that
/// the page shows. (The contact position is an estimate: the slab ends beside the ball, and the centroid of the overlap is
/// at 1.849.)
fn assert_depth_of_the_ball(output: &str) {
    let page = page("README.md");
    let shown = page.lines().find_map(|line| line.strip_prefix("# depth"));
    for line in [output.trim(), shown.expect("the program's output")] {
        for (found, truth) in numbers(line).iter().zip([0.1, 0.0, 1.0, 1.897, 0.45]) {
            assert!((found - truth).abs() < 2e-3, "{line}");
        }
        assert_eq!(numbers(line).len(), 5, "{line}");
    }
}

/// Compiles a page's program without a warning.
fn strict(page: &str, language: &str) -> Executable {
    Program::new(program_of(&format!("{page}-{language}"), page, language)).strict().build()
}

/// Runs README.md's C program on this library and, in double precision, on libccd.
#[test]
fn readme_c_program() {
    let program = strict("README.md", "c");
    assert_depth_of_the_ball(&program.run([""; 0]).stdout);
    if Precision::CURRENT == Precision::Double {
        let program = Program::new(program_of("readme-libccd", "README.md", "c"));
        let output = program.link(Link::System).build().run([""; 0]).stdout;
        assert!(page("README.md").contains(output.trim()), "{output}");
    }
}

#[test]
fn include_readme_c_program() {
    let program = strict("include/README.md", "c");
    assert_depth_of_the_box(&program.run([""; 0]).stdout);
}

/// Runs the two commands of README.md and include/README.md that link the program, in a folder with the files that they name.
#[test]
#[cfg(not(feature = "single"))]
fn readme_link_commands() {
    let library = harness::library(Precision::CURRENT);
    let here = empty_dir("readme-links");
    fs::create_dir_all(here.join("target/swap")).expect("a directory");
    let link = |from: &Path, to: &str| {
        std::os::unix::fs::symlink(from, here.join(to)).expect("a link can be made");
    };
    link(&root().join("include"), "include");
    link(&library.dir, "target/release");
    link(&library.dir.join("libccd.so"), "target/swap/libccd.so.2");
    fs::copy(program_of("readme-linked", "README.md", "c"), here.join("target/program.c")).expect("a copy");
    let pages = page("README.md") + &page("include/README.md");
    let lines = pages
        .split(['`', '\n'])
        .filter(|code| code.starts_with("cc target/program.c "))
        .map(|code| code.trim_end_matches(" && target/program"));
    assert_eq!(lines.clone().count(), 2);
    for line in lines {
        let mut shell = Command::new("sh");
        shell.current_dir(&here).arg("-c").arg(format!("{line} && target/program"));
        assert_depth_of_the_ball(&must_succeed(&mut shell, line).stdout);
        // The linker leaves out most of the archive's 15 MB.
        assert_small(line, size(&here.join("target/program")), 550_000);
    }
}

/// Runs include/README.md's C++ program of two unit spheres (0.3, 0.2, 0.1) apart: the depth is the sum
/// of the radii less the distance. (In single precision its double radius would be narrowed.)
#[test]
#[cfg(not(feature = "single"))]
fn include_readme_cpp_program() {
    let program = strict("include/README.md", "cpp");
    let depth = numbers(&program.run([""; 0]).stdout)[0];
    assert!((depth - (2.0 - 0.14_f64.sqrt())).abs() < 1e-5, "{depth}");
}

/// Checks that every command of the pages is one that a step runs.
#[test]
fn commands_of_the_pages_are_run() {
    if !root().join(".git").exists() {
        println!("skipped: not a git repository");
        return;
    }
    run(Command::new("sh"), &[&root().join("c-tests/lab/commands.sh"), &"check"]);
}
