// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Ways to build and install that no commit changes by accident: add_subdirectory, FetchContent, DESTDIR, the source
//! archive; a Rust that is too old; sizes and notices of the installed files.

use crate::harness::{self, Precision, root};
use crate::install::{
    assert_all_run_on_ours, assert_runs_on_ours, assert_small, build, c_compiler, cmake, configure, consumer, define,
    empty_dir, find, installed_and_moved, precision_option, run, size,
};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Checks that a project which includes the library's sources builds them with make, Ninja and a
/// generator of several configurations, and installs the library only with CCD_INSTALL.
#[test]
fn add_subdirectory_and_fetch_content() {
    for (name, way, option, programs) in [
        ("subdirectory", "add_subdirectory", None, ""),
        ("install", "add_subdirectory", Some("-DCCD_INSTALL=ON"), ""),
        ("FetchContent", "FetchContent", None, ""),
        ("Ninja", "add_subdirectory", Some("-GNinja"), ""),
        ("multi-config", "add_subdirectory", Some("-GNinja Multi-Config"), "Debug"),
    ] {
        let prefix = empty_dir("parent").join(name);
        let mut options = vec![define("CMAKE_INSTALL_PREFIX", &prefix)];
        options.extend(option.map(String::from));
        let build = consumer(name, way, &options);
        assert_all_run_on_ours(&build.join(programs), &build, &["plain", "namespaced"]);
        let cache = fs::read_to_string(build.join("CMakeCache.txt")).expect("CMake's cache");
        assert!(!cache.contains("BUILD_SHARED_LIBS"), "set in the parent project");
        if programs.is_empty() {
            cmake(&[&"--install", &build]);
            assert!(prefix.join("bin/plain").is_file());
            assert_eq!(prefix.join("include").exists(), name == "install");
        }
        // The same in both precisions.
        if Precision::CURRENT == Precision::Single && name == "FetchContent" {
            break;
        }
    }
}

/// Checks that with BUILD_SHARED_LIBS=OFF `ccd` is the static library, in a build tree and installed.
#[test]
fn static_library_only() {
    let dir = empty_dir("static-only");
    let (tree, prefix) = (dir.join("build"), dir.join("prefix"));
    let off = define("BUILD_SHARED_LIBS", "OFF");
    build("cmake", &tree, &[define("CMAKE_INSTALL_PREFIX", &prefix), off.clone()]);
    cmake(&[&"--install", &tree]);
    find(&prefix, "libccd.a");
    assert!(!prefix.join("lib/libccd.so").exists());
    for (name, way, option) in [
        ("static-installed", "find_package", define("CMAKE_PREFIX_PATH", &prefix)),
        ("static-subdirectory", "add_subdirectory", off),
    ] {
        let build = consumer(name, way, &[option]);
        for program in ["plain", "namespaced", "static"] {
            assert_runs_on_ours(&build.join(program), None);
        }
    }
}

/// Writes a shell script that prints one line.
fn write_script(path: &Path, line: &str) {
    fs::write(path, format!("#!/bin/sh\necho '{line}'\n")).expect("a script");
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(path, mode).expect("a mode");
}

/// Checks that CMake reports a Rust that is missing, too old or prints no version.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn cmake_reports_a_missing_or_old_rust() {
    let dir = empty_dir("rust");
    let cargo_printing = |line: &str| {
        let script = dir.join(line.split(' ').next_back().expect("a word"));
        write_script(&script, line);
        define("CARGO", script)
    };
    let missing = define("CARGO", "CARGO-NOTFOUND");
    for (name, option, expected, names_a_package) in [
        ("missing", missing, "cargo is missing", true),
        ("old", cargo_printing("cargo 1.63.0"), "is Rust 1.63", true),
        ("broken", cargo_printing("no such toolchain"), "no such toolchain", false),
    ] {
        let mut configure = configure(&root().join("cmake"), &dir.join(name));
        // find_program finds no other cargo.
        for place in ["CMAKE_SYSTEM_PATH", "SYSTEM_ENVIRONMENT_PATH"] {
            configure.arg(define(&format!("CMAKE_FIND_USE_{place}"), "OFF"));
        }
        configure.env("CARGO_HOME", &dir).env("HOME", &dir);
        configure.arg(option);
        let output = configure.output().expect("cmake runs");
        assert!(!output.status.success(), "{name}");
        let message = String::from_utf8_lossy(&output.stderr);
        let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(message.contains(expected), "{name}: {message}");
        let advice = format!("Rust {} or later (Debian 12's or 13's rustc-web", harness::of_package("rust-version"));
        assert!(message.contains(&advice) || !names_a_package, "{message}");
    }
}

/// Checks that setup.sh reports a Rust that is too old, and names Debian's packages of a newer one.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn setup_reports_an_old_rust() {
    let dir = empty_dir("old-rust");
    for tool in ["cargo", "rustc"] {
        write_script(&dir.join(tool), &format!("{tool} 1.63.0 (fd9c4297c 2022-07-01)"));
    }
    let path = std::env::var("PATH").expect("a path");
    for job in ["check", "main", "tests"] {
        let mut setup = Command::new("sh");
        setup.arg(root().join("c-tests/setup.sh")).arg(job);
        setup.env("PATH", format!("{}:{path}", dir.display()));
        let output = setup.output().expect("a shell runs");
        assert_eq!(output.status.code(), Some(1), "{job}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains("cargo is 1.63.0, too old: Rust 1."), "{message}");
        assert!(message.contains("13's rustc-web and cargo-web"), "{message}");
    }
}

/// Checks that the source archive builds without a network, to the same bytes in every folder.
/// (Its name makes it the first to start: it takes longest.)
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn a_build_of_the_source_archive_is_offline_and_reproducible() {
    if !root().join(".git").exists() {
        println!("skipped: not a git repository");
        return;
    }
    let dir = empty_dir("source");
    let source = root().join("cmake/packages/source.sh");
    let archive = run(Command::new("sh"), &[&source, &dir]);
    let name = format!("warmccd-{}.tar.xz", harness::of_package("version"));
    assert_eq!(Path::new(archive.trim()), dir.join(name));
    let names = ["libccd.so.2.0", "libccd.a"];
    let libraries = ["a", "another/place"].map(|place| {
        let place = dir.join(place);
        fs::create_dir_all(&place).expect("a directory");
        let (archive, strip) = (archive.trim(), "--strip-components=1");
        run(Command::new("tar"), &[&"-xf", &archive, &"-C", &place, &strip]);
        let build = place.join("build");
        run(configure(&place.join("cmake"), &build), &[&precision_option()]);
        let mut make = Command::new("cmake");
        // No cached crate, and no way to fetch one.
        make.env("CARGO_HOME", place.join("cargo-home"));
        make.env("CARGO_NET_OFFLINE", "true");
        run(make, &[&"--build", &build]);
        names.map(|name| fs::read(build.join("lib").join(name)).expect("a library"))
    });
    for (i, name) in names.iter().enumerate() {
        assert!(libraries[0][i] == libraries[1][i], "{name} differs");
    }
}

/// Checks that the installed notices name each crate that is compiled in.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn notices_name_every_crate() {
    let prefix = installed_and_moved();
    let installed = |name| fs::read_to_string(prefix.join("share/doc/ccd").join(name)).expect("an installed text");
    assert!(installed("LICENSE").starts_with("BSD 3-Clause License"));
    let notices = installed("THIRD-PARTY");
    let named: BTreeSet<&str> = notices
        .lines()
        .skip_while(|line| !line.starts_with("Taken from crates.io"))
        .skip_while(|line| !line.starts_with("  "))
        .map_while(|line| line.strip_prefix("  ")?.split(' ').next())
        .collect();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(root()).args(["tree", "--offline", "--prefix=none"]);
    let tree = run(cargo, &[&"--edges=normal,no-proc-macro", &"--format={p} {l}"]);
    let lines = tree.lines().filter(|line| !line.starts_with("warmccd "));
    let other = lines.clone().find(|line| !line.contains("Apache-2.0"));
    assert_eq!(other, None, "another licence");
    let compiled = lines.filter_map(|line| line.split(' ').next());
    assert_eq!(named, compiled.collect());
}

/// Checks that the installed libraries are small and carry no debug information, and that
/// `cargo build --release` makes a small one. Of the archive only this crate's objects count: the
/// rest is Rust's standard library, of 10 to 20 MB.
#[test]
fn libraries_are_small() {
    let prefix = installed_and_moved();
    let [shared, archive] = ["libccd.so.2.0", "libccd.a"].map(|name| find(prefix, name));
    let bare = empty_dir("stripped").join("libccd.so");
    let built = harness::library(Precision::CURRENT).dir.join("libccd.so");
    run(harness::binutils("strip"), &[&"-o", &bare, &built]);
    for file in [&shared, &bare] {
        assert_small(&file.to_string_lossy(), size(file), 680_000);
    }
    let own = size_of_own_objects(&archive);
    assert_small("our own objects in libccd.a", own, 770_000);
    for file in [shared, archive] {
        let sections = run(Command::new("readelf"), &[&"--wide", &"--sections", &file]);
        assert!(sections.contains(".text"), "{file:?}");
        assert!(!sections.contains(".debug_"), "{file:?}");
    }
}

/// Sums up the archive's members of this crate, whose names begin with it.
fn size_of_own_objects(archive: &Path) -> u64 {
    let members = run(harness::binutils("ar"), &[&"tv", &archive]);
    let sizes = members.lines().filter_map(|line| {
        // mode, owner, size, date, name
        let words: Vec<&str> = line.split_whitespace().collect();
        let own = words.last()?.strip_prefix("ccd")?.starts_with(['.', '-']);
        own.then(|| words[2].parse::<u64>().expect("a size"))
    });
    let size = sizes.sum();
    assert!(size > 0, "no member of this crate:\n{members}");
    size
}

/// Checks how much the archive adds to a program with one query: without Rust's panic messages and
/// backtraces, of 300 KB, as long as no function of the library can panic.
#[test]
fn static_link_adds_little() {
    let prefix = installed_and_moved();
    let archive = find(prefix, "libccd.a");
    let programs = empty_dir("sizes");
    let program = |name: &str, code: &str, libraries: &[&OsStr]| {
        let source = programs.join(format!("{name}.c"));
        fs::write(&source, code).expect("a file can be written");
        let path = programs.join(name);
        let mut cc = c_compiler();
        cc.arg("-I").arg(prefix.join("include")).arg(&source);
        cc.args(libraries).args(["-Wl,--gc-sections", "-s"]);
        run(cc, &[&"-o", &path]);
        size(&path)
    };
    let call = "#include <ccd/ccd.h>
        int main(int n, char **v) {
            ccd_t ccd; ccd_real_t d; ccd_vec3_t x, y;
            CCD_INIT(&ccd);
            return ccdMPRPenetration(v, v + n, &ccd, &d, &x, &y);
        }";
    let linked = program("linked", call, &[archive.as_os_str(), "-lm".as_ref()]);
    let growth = linked - program("empty", "int main(void) { return 0; }", &[]);
    assert_small("a program's growth", growth, 420_000);
}

/// Installs as a Debian package does, with DESTDIR and multiarch: the files are where Debian's own
/// libccd has them, and none names a directory of the build.
#[test]
fn destdir_and_multiarch() {
    let dir = empty_dir("destdir");
    let (tree, stage) = (dir.join("build"), dir.join("stage"));
    build("cmake", &tree, &[define("CMAKE_INSTALL_PREFIX", "/usr")]);
    let mut install = Command::new("cmake");
    install.env("DESTDIR", &stage);
    run(install, &[&"--install", &tree]);
    let triplet = run(c_compiler(), &[&"-print-multiarch"]);
    let libdir = Path::new("usr/lib").join(triplet.trim());
    for file in [
        "libccd.a",
        "libccd.so",
        "libccd.so.2",
        "libccd.so.2.0",
        "pkgconfig/ccd.pc",
        "ccd/ccd-config.cmake",
        "ccd/ccd-config-version.cmake",
    ] {
        assert!(stage.join(&libdir).join(file).is_file(), "{file}");
    }
    for link in ["libccd.so", "libccd.so.2"] {
        let target = fs::read_link(stage.join(&libdir).join(link)).expect("a link");
        assert!(target.is_relative(), "{link} -> {target:?}");
    }
    let headers = root().join("include/ccd");
    for header in fs::read_dir(headers).expect("include/ccd").flatten() {
        let installed = stage.join("usr/include/ccd").join(header.file_name());
        assert!(installed.is_file(), "{installed:?}");
    }
    for file in ["pkgconfig/ccd.pc", "ccd/ccd-config.cmake"] {
        let text = fs::read_to_string(stage.join(&libdir).join(file)).expect("a text file");
        for built in [root(), dir.as_path()] {
            assert!(!text.contains(&*built.to_string_lossy()), "{file}\n{text}");
        }
    }
}
