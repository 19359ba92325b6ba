// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Installs the library with CMake and uses it from throw-away projects by find_package,
//! add_subdirectory, FetchContent and pkg-config, shared and static, in the precision of this test
//! binary. Checks the size, reproducibility and notices of the installed files, and runs the programs
//! of README.md and include/README.md.

use crate::harness::{self, Executable, Precision, Program, must_succeed, output_dir, root};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Makes an empty directory of this name.
fn empty_dir(name: &str) -> PathBuf {
    let dir = output_dir().join("packaging").join(Precision::CURRENT.name()).join(name);
    if dir.exists() {
        fs::remove_dir_all(&dir).expect("an old run's directory can be removed");
    }
    fs::create_dir_all(&dir).expect("a directory can be made");
    dir
}

/// Runs a tool, which must succeed, and returns its standard output.
fn run(mut tool: Command, args: &[&dyn AsRef<OsStr>]) -> String {
    tool.args(args);
    let name = tool.get_program().to_string_lossy().into_owned();
    must_succeed(&mut tool, &name).stdout
}

fn cmake(args: &[&dyn AsRef<OsStr>]) {
    run(Command::new("cmake"), args);
}

/// Returns the command that configures `source` in the folder `build`.
fn configure(source: &Path, build: &Path) -> Command {
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(source).arg("-B").arg(build);
    cmake
}

fn c_compiler() -> Command {
    harness::compile_with(&harness::compiler(false))
}

fn define(name: &str, value: impl AsRef<Path>) -> String {
    format!("-D{name}={}", value.as_ref().display())
}

fn precision_option() -> String {
    let double = ["OFF", "ON"][usize::from(Precision::CURRENT == Precision::Double)];
    define("ENABLE_DOUBLE_PRECISION", double)
}

/// Configures and builds `source` in the folder `build`. All builds share one folder of cargo's, in which
/// crates are compiled once for both precisions; `options` may name another.
fn build(source: &str, build: &Path, options: &[String]) {
    let cargo = define("CCD_CARGO_TARGET_DIR", output_dir().join("packaging/cargo"));
    let mut configure = configure(&root().join(source), build);
    must_succeed(configure.args([precision_option(), cargo]).args(options), "cmake");
    cmake(&[&"--build", &build]);
}

/// Installs the library under a prefix, then moves the prefix and removes the build tree: no file may
/// refer to either. Returns the new prefix.
fn installed_and_moved() -> &'static Path {
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
fn consumer(name: &str, way: &str, options: &[String]) -> PathBuf {
    let folder = empty_dir(name);
    let usual = [define("WAY", way), define("REPOSITORY", root())];
    build("c-tests/tests/packaging/consumer", &folder, &[&usual, options].concat());
    folder
}

/// Checks that the program runs on this repository's library: the shared one under `shared_under`, or
/// the static one.
fn assert_runs_on_ours(program: &Path, shared_under: Option<&Path>) {
    let name = program.file_name().expect("a program").to_string_lossy();
    let program = Executable::from_path(&name, program);
    let loaded = program.loaded_ccd();
    match shared_under {
        Some(dir) => assert!(loaded.as_ref().is_some_and(|path| path.starts_with(dir)), "{name} runs on {loaded:?}"),
        None => assert_eq!(loaded, None, "{name} is linked statically"),
    }
    let expected = format!("warmccd {} {}\n", env!("CARGO_PKG_VERSION"), Precision::CURRENT.name());
    assert_eq!(program.run([""; 0]).stdout, expected);
}

/// Checks the consumer's programs `names`, which use the shared library, and `static`.
fn assert_all_run_on_ours(programs: &Path, shared_under: &Path, names: &[&str]) {
    for name in names {
        assert_runs_on_ours(&programs.join(name), Some(shared_under));
    }
    assert_runs_on_ours(&programs.join("static"), None);
}

#[test]
fn find_package() {
    let prefix = installed_and_moved();
    let build = consumer("find_package", "find_package", &[define("CMAKE_PREFIX_PATH", prefix)]);
    assert_all_run_on_ours(&build, prefix, &["plain", "namespaced", "variables"]);
}

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

/// Fetches the library by FetchContent from a git repository, at the branch that cmake/README.md names.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn fetch_content_from_git() {
    if !root().join(".git").exists() {
        println!("skipped: not a git repository");
        return;
    }
    let git = |dir: &Path, args: &[&dyn AsRef<OsStr>]| {
        let args = [&[&"-C" as &dyn AsRef<OsStr>, &dir], args].concat();
        run(Command::new("git"), &args).trim().to_owned()
    };
    let page = page("cmake/README.md");
    let tag = page
        .split_once("GIT_TAG ")
        .and_then(|(_, rest)| rest.split([' ', ')']).next())
        .expect("the page names a branch");
    assert_eq!(tag, "main");
    // The tracked files as they are now, committed to a new repository: the time stamps of the
    // index and the user's git identity do not matter.
    let upstream = empty_dir("upstream");
    let branch = format!("--initial-branch={tag}");
    git(&upstream, &[&"init", &"--quiet", &branch]);
    let files = git(root(), &[&"ls-files", &"-z", &"--cached"]);
    for file in files.split_terminator('\0') {
        let to = upstream.join(file);
        fs::create_dir_all(to.parent().expect("a directory")).expect("a directory can be made");
        // A tracked file may be deleted in the working tree.
        if root().join(file).exists() {
            fs::copy(root().join(file), to).expect("a file can be copied");
        }
    }
    git(&upstream, &[&"add", &"--all", &"--force"]);
    let mut commit = Command::new("git");
    commit.arg("-C").arg(&upstream);
    commit.args(["-c", "user.name=Test", "-c", "user.email=test@localhost"]);
    commit.args(["commit", "--quiet", "--no-gpg-sign", "-m", "files"]);
    run(commit, &[]);

    // Cargo's folder is its own: sources of two places would replace each other's libraries.
    let cargo = define("CCD_CARGO_TARGET_DIR", output_dir().join("packaging/cargo-git"));
    let build = consumer("git", "git", &[define("TAG", tag), define("REPOSITORY", upstream), cargo]);
    assert_all_run_on_ours(&build, &build, &["plain", "namespaced"]);
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
        let advice = concat!("Rust ", env!("CARGO_PKG_RUST_VERSION"), " or later (Debian 12's or 13's rustc-web");
        assert!(message.contains(advice) || !names_a_package, "{message}");
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
    let name = concat!("warmccd-", env!("CARGO_PKG_VERSION"), ".tar.xz");
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
/// `cargo build --release` makes a small one. (The aim is 430,000; each solver is compiled once for
/// every capacity.) Of the archive only this crate's objects count: the rest is Rust's standard
/// library, of 10 to 20 MB.
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
    assert_small("our own objects in libccd.a", own, 750_000);
    for file in [shared, archive] {
        let sections = run(Command::new("readelf"), &[&"--wide", &"--sections", &file]);
        assert!(sections.contains(".text"), "{file:?}");
        assert!(!sections.contains(".debug_"), "{file:?}");
    }
}

/// Checks a size in bytes.
fn assert_small(name: &str, size: u64, most: u64) {
    println!("{name}: {size} bytes, at most {most}");
    assert!(size <= most, "{name}: {size} bytes");
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

fn size(path: &Path) -> u64 {
    fs::metadata(path).expect("a file").len()
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

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).expect("a page")
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
/// the page shows.
fn assert_depth_of_the_ball(output: &str) {
    let page = page("README.md");
    let shown = page.lines().find_map(|line| line.strip_prefix("# depth"));
    for line in [output.trim(), shown.expect("the program's output")] {
        for (found, truth) in numbers(line).iter().zip([0.1, 0.0, 1.0, 1.9, 0.45]) {
            assert!((found - truth).abs() < 2e-3, "{line}");
        }
        assert_eq!(numbers(line).len(), 5, "{line}");
    }
}

/// Compiles a page's program without a warning.
fn strict(program: Program, page: &str, language: &str) -> Executable {
    let program = program.source(program_of(&format!("{page}-{language}"), page, language));
    let program = program.flag("-pedantic").flag("-Werror");
    program.link_ours_shared().build()
}

/// Runs README.md's C program on this library and, in double precision, on libccd.
#[test]
fn readme_c_program() {
    let program = strict(Program::c("readme"), "README.md", "c");
    assert_depth_of_the_ball(&program.run([""; 0]).stdout);
    if Precision::CURRENT == Precision::Double {
        let program = Program::c("readme-libccd").source(program_of("readme-libccd", "README.md", "c"));
        let output = program.link_system().build().run([""; 0]).stdout;
        assert!(page("README.md").contains(output.trim()), "{output}");
    }
}

#[test]
fn include_readme_c_program() {
    let program = strict(Program::c("frames"), "include/README.md", "c");
    assert_depth_of_the_box(&program.run([""; 0]).stdout);
}

/// Runs README.md's two commands that link its program, in a folder with the files that they name.
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
    fs::copy(program_of("readme-linked", "README.md", "c"), here.join("program.c")).expect("a copy");
    let page = page("README.md");
    let lines = page
        .split(['`', '\n'])
        .filter(|code| code.starts_with("cc program.c "))
        .map(|code| code.trim_end_matches(" && ./a.out"));
    assert_eq!(lines.clone().count(), 2);
    for line in lines {
        let mut shell = Command::new("sh");
        shell.current_dir(&here).arg("-c").arg(format!("{line} && ./a.out"));
        assert_depth_of_the_ball(&must_succeed(&mut shell, line).stdout);
        // The linker leaves out most of the archive's 15 MB.
        assert_small(line, size(&here.join("a.out")), 550_000);
    }
}

/// Runs include/README.md's C++ program of two unit spheres (0.3, 0.2, 0.1) apart: the depth is the sum
/// of the radii less the distance. (In single precision its double radius would be narrowed.)
#[test]
#[cfg(not(feature = "single"))]
fn include_readme_cpp_program() {
    let program = strict(Program::cpp("readme"), "include/README.md", "cpp");
    let depth = numbers(&program.run([""; 0]).stdout)[0];
    assert!((depth - (2.0 - 0.14_f64.sqrt())).abs() < 1e-5, "{depth}");
}

/// Returns the one file of this name below a directory.
fn find(dir: &Path, name: &str) -> PathBuf {
    let found = run(Command::new("find"), &[&dir, &"-name", &name]);
    assert_eq!(found.lines().count(), 1, "{name}: {found}");
    PathBuf::from(found.trim_end())
}
