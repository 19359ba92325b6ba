// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Installs the library with CMake and uses it from throw-away projects, in
//! every way its users do: find_package, add_subdirectory, FetchContent and
//! pkg-config, shared and static, in the precision of this test binary. What is
//! installed is small, the same wherever it is built, and names whose work is in it.

#[path = "../../harness/mod.rs"]
mod harness;

use harness::{Executable, Precision, Program, must_succeed, output_dir, root};
use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock};

/// An empty directory of this name, for one test.
fn fresh(name: &str) -> PathBuf {
    let dir = output_dir().join("packaging").join(Precision::CURRENT.name()).join(name);
    if dir.exists() {
        fs::remove_dir_all(&dir).expect("an old run's directory can be removed");
    }
    fs::create_dir_all(&dir).expect("a directory can be made");
    dir
}

/// Runs a tool to a good end; what it writes.
fn ran(mut tool: Command, args: &[&dyn AsRef<OsStr>]) -> String {
    tool.args(args);
    let name = tool.get_program().to_string_lossy().into_owned();
    must_succeed(&mut tool, &name).stdout
}

fn cmake(args: &[&dyn AsRef<OsStr>]) {
    ran(Command::new("cmake"), args);
}

/// Configures a folder in another.
fn configure(source: &Path, build: &Path) -> Command {
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(source).arg("-B").arg(build);
    cmake
}

fn c_compiler() -> Command {
    harness::compile_with(&harness::compiler(false))
}

fn define(name: &str, value: impl AsRef<OsStr>) -> OsString {
    let mut definition = OsString::from(format!("-D{name}="));
    definition.push(value);
    definition
}

fn precision_option() -> OsString {
    let double = ["OFF", "ON"][usize::from(Precision::CURRENT == Precision::Double)];
    define("ENABLE_DOUBLE_PRECISION", double)
}

/// How cargo builds the library.
#[derive(Clone, Copy)]
enum Cargo {
    /// As it is installed, at one place for all tests of this file.
    Release,
    /// Not optimised, at another: for one more way to find and link the library, where what
    /// it computes is not looked at.
    Quick,
}

impl Cargo {
    /// What configures a build of the library.
    fn options(self) -> [OsString; 2] {
        let name = match self {
            Cargo::Release => "cargo",
            Cargo::Quick => "cargo-quick",
        };
        // Crates are compiled once for both precisions.
        let dir = output_dir().join("packaging").join(name);
        [precision_option(), define("CCD_CARGO_TARGET_DIR", dir)]
    }

    /// Builds what is configured.
    fn build(self, tree: &Path) {
        let mut make = Command::new("cmake");
        make.arg("--build").arg(tree);
        // Sources of two places are built there, one after the other.
        static QUICK: Mutex<()> = Mutex::new(());
        let mut _one = None;
        if let Cargo::Quick = self {
            _one = Some(QUICK.lock());
            make.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0");
            make.env("CARGO_PROFILE_RELEASE_DEBUG", "false");
        }
        must_succeed(&mut make, "cmake");
    }
}

fn build_library(build: &Path, prefix: &Path, cargo: Cargo, options: &[OsString]) {
    let mut configure = configure(&root().join("cmake"), build);
    configure.arg(define("CMAKE_INSTALL_PREFIX", prefix));
    must_succeed(configure.args(cargo.options()).args(options), "cmake");
    cargo.build(build);
}

/// The library installed under a prefix, then moved: nothing in it may
/// remember where it was built or first lay.
fn installed_and_moved() -> &'static Path {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let dir = fresh("installed");
        let (build, first, prefix) = (dir.join("build"), dir.join("first"), dir.join("prefix"));
        build_library(&build, &first, Cargo::Release, &[]);
        cmake(&[&"--install", &build]);
        fs::remove_dir_all(&build).expect("the build tree can be removed");
        fs::rename(&first, &prefix).expect("the prefix can be moved");
        prefix
    })
}

/// Configures and builds the consumer; what else CMake is to know.
fn consumer(name: &str, way: &str, cargo: Cargo, options: &[OsString]) -> PathBuf {
    let build = fresh(name);
    let mut configure = configure(&root().join("c-tests/tests/packaging/consumer"), &build);
    configure.args([define("WAY", way), define("REPOSITORY", root())]);
    must_succeed(configure.args(cargo.options()).args(options), "cmake");
    cargo.build(&build);
    build
}

/// The program runs, and on this repository's library: on the shared one under
/// `shared_under`, or on the static one.
fn runs_on_ours(program: &Path, shared_under: Option<&Path>) {
    let name = program.file_name().expect("a program").to_string_lossy();
    let program = Executable::made_elsewhere(&name, program);
    let loaded = program.loaded_ccd();
    match shared_under {
        Some(dir) => assert!(loaded.as_ref().is_some_and(|path| path.starts_with(dir)), "{name} runs on {loaded:?}"),
        None => assert_eq!(loaded, None, "{name} is linked statically"),
    }
    let expected = format!("warmccd {} {}\n", env!("CARGO_PKG_VERSION"), Precision::CURRENT.name());
    assert_eq!(program.run([""; 0]).stdout, expected);
}

/// Of the consumer's programs: those on the shared library, and the one on the archive.
fn all_run_on_ours(programs: &Path, shared_under: &Path, names: &[&str]) {
    for name in names {
        runs_on_ours(&programs.join(name), Some(shared_under));
    }
    runs_on_ours(&programs.join("static"), None);
}

#[test]
fn find_package() {
    let prefix = installed_and_moved();
    let there = [define("CMAKE_PREFIX_PATH", prefix)];
    let build = consumer("find_package", "find_package", Cargo::Release, &there);
    all_run_on_ours(&build, prefix, &["plain", "namespaced", "variables"]);
}

/// As a part of another project, which installs this library only if it asks to. Ninja and a
/// generator of several configurations build what make does.
#[test]
fn add_subdirectory_and_fetch_content() {
    for (name, way, option, programs) in [
        ("part", "add_subdirectory", None, ""),
        ("asked", "add_subdirectory", Some("-DCCD_INSTALL=ON"), ""),
        ("fetched", "FetchContent", None, ""),
        ("Ninja", "add_subdirectory", Some("-GNinja"), ""),
        ("several", "add_subdirectory", Some("-GNinja Multi-Config"), "Debug"),
    ] {
        let prefix = fresh("parent").join(name);
        let mut options = vec![define("CMAKE_INSTALL_PREFIX", &prefix)];
        options.extend(option.map(OsString::from));
        let build = consumer(name, way, Cargo::Release, &options);
        all_run_on_ours(&build.join(programs), &build, &["plain", "namespaced"]);
        let cache = fs::read_to_string(build.join("CMakeCache.txt")).expect("CMake's cache");
        assert!(!cache.contains("BUILD_SHARED_LIBS"), "set for its parent");
        if programs.is_empty() {
            cmake(&[&"--install", &build]);
            assert!(prefix.join("bin/plain").is_file());
            assert_eq!(prefix.join("include").exists(), name == "asked");
        }
        // The same in both precisions.
        if Precision::CURRENT == Precision::Single && name == "fetched" {
            break;
        }
    }
}

/// By FetchContent from a repository, of its branch as cmake/README.md says it.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn git_tag() {
    if !root().join(".git").exists() {
        println!("skipped: not a git repository");
        return;
    }
    let git = |dir: &Path, args: &[&dyn AsRef<OsStr>]| {
        let args = [&[&"-C" as &dyn AsRef<OsStr>, &dir], args].concat();
        ran(Command::new("git"), &args).trim().to_owned()
    };
    let page = page("cmake/README.md");
    let tag = page
        .split_once("GIT_TAG ")
        .and_then(|(_, rest)| rest.split([' ', ')']).next())
        .expect("the page names a branch");
    assert_eq!(tag, "main");
    // The files as they are now, copied into a repository of their own: the time stamps of the
    // index and the name of whoever works here do not matter.
    let upstream = fresh("upstream");
    let branch = format!("--initial-branch={tag}");
    git(&upstream, &[&"init", &"--quiet", &branch]);
    let files = git(root(), &[&"ls-files", &"-z", &"--cached"]);
    for file in files.split_terminator('\0') {
        let to = upstream.join(file);
        fs::create_dir_all(to.parent().expect("a directory")).expect("a directory can be made");
        // One that is deleted and not committed is not there.
        if root().join(file).exists() {
            fs::copy(root().join(file), to).expect("a file can be copied");
        }
    }
    git(&upstream, &[&"add", &"--all", &"--force"]);
    let mut commit = Command::new("git");
    commit.arg("-C").arg(&upstream);
    commit.args(["-c", "user.name=Test", "-c", "user.email=test@localhost"]);
    commit.args(["commit", "--quiet", "--no-gpg-sign", "-m", "files"]);
    ran(commit, &[]);

    // Behind the consumer's own.
    let options = [define("TAG", tag), define("REPOSITORY", upstream)];
    let build = consumer("git", "git", Cargo::Quick, &options);
    all_run_on_ours(&build, &build, &["plain", "namespaced"]);
}

/// BUILD_SHARED_LIBS=OFF: `ccd` is the archive, in a build tree and installed.
#[test]
fn the_archive_alone_without_shared_libraries() {
    let dir = fresh("static-alone");
    let (build, prefix) = (dir.join("build"), dir.join("prefix"));
    let cargo = Cargo::Quick;
    let off = define("BUILD_SHARED_LIBS", "OFF");
    build_library(&build, &prefix, cargo, std::slice::from_ref(&off));
    cmake(&[&"--install", &build]);
    find(&prefix, "libccd.a");
    assert!(!prefix.join("lib/libccd.so").exists());
    for (name, way, option) in [
        ("static-installed", "find_package", define("CMAKE_PREFIX_PATH", &prefix)),
        ("static-part", "add_subdirectory", off),
    ] {
        let build = consumer(name, way, cargo, &[option]);
        for program in ["plain", "namespaced", "static"] {
            runs_on_ours(&build.join(program), None);
        }
    }
}

/// Writes a program that says one line.
fn executable(path: &Path, line: &str) {
    fs::write(path, format!("#!/bin/sh\necho '{line}'\n")).expect("a script");
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(path, mode).expect("a mode");
}

/// A Rust that is missing or too old is named when CMake configures.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn a_missing_or_old_rust_is_named() {
    let dir = fresh("rust");
    let says = |name: &str, line: &str| {
        let script = dir.join(name);
        executable(&script, line);
        define("CARGO", script)
    };
    let oldest = env!("CARGO_PKG_RUST_VERSION");
    let missing = define("CARGO", "CARGO-NOTFOUND");
    let (old, odd) = ("cargo 1.63.0", "no such toolchain");
    for (name, option, expected) in [
        ("missing", missing, "cargo is missing"),
        ("old", says("old-cargo", old), "is Rust 1.63"),
        ("odd", says("odd-cargo", odd), odd),
    ] {
        let mut configure = configure(&root().join("cmake"), &dir.join(name));
        // find_program finds nothing anywhere.
        for place in ["CMAKE_SYSTEM_PATH", "SYSTEM_ENVIRONMENT_PATH"] {
            configure.arg(define(&format!("CMAKE_FIND_USE_{place}"), "OFF"));
        }
        configure.env("CARGO_HOME", &dir).env("HOME", &dir);
        configure.arg(option);
        let said = configure.output().expect("cmake runs");
        assert!(!said.status.success(), "{name}");
        let said = String::from_utf8_lossy(&said.stderr);
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(expected), "{name}: {said}");
        if name != "odd" {
            let sentence = format!("Rust {oldest} or later (Debian 12's or 13's rustc-web");
            assert!(said.contains(&sentence), "{said}");
        }
    }
}

/// setup.sh names a Rust that is too old, and Debian's packages of a newer one.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn setup_names_where_a_newer_rust_is() {
    let dir = fresh("old-rust");
    for tool in ["cargo", "rustc"] {
        executable(&dir.join(tool), &format!("{tool} 1.63.0 (fd9c4297c 2022-07-01)"));
    }
    let path = std::env::var("PATH").expect("a path");
    for job in ["check", "main", "tests"] {
        let mut setup = Command::new("sh");
        setup.arg(root().join("c-tests/setup.sh")).arg(job);
        setup.env("PATH", format!("{}:{path}", dir.display()));
        let said = setup.output().expect("a shell runs");
        assert_eq!(said.status.code(), Some(1), "{job}");
        let said = String::from_utf8_lossy(&said.stderr);
        assert!(said.contains("cargo is 1.63.0, too old: Rust 1."), "{said}");
        assert!(said.contains("13's rustc-web and cargo-web"), "{said}");
    }
}

/// The source archive builds without a network, and gives the same bytes wherever it
/// is unpacked. (By its name the first to start: it takes longest.)
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn a_build_of_the_source_archive_is_offline_and_reproducible() {
    if !root().join(".git").exists() {
        println!("skipped: not a git repository");
        return;
    }
    let dir = fresh("source");
    let source = root().join("cmake/packages/source.sh");
    let archive = ran(Command::new("sh"), &[&source, &dir]);
    let name = concat!("warmccd-", env!("CARGO_PKG_VERSION"), ".tar.xz");
    assert_eq!(Path::new(archive.trim()), dir.join(name));
    let libraries: Vec<[Vec<u8>; 2]> = ["a", "another/place"]
        .into_iter()
        .map(|place| {
            let place = dir.join(place);
            fs::create_dir_all(&place).expect("a directory");
            let (archive, strip) = (archive.trim(), "--strip-components=1");
            ran(Command::new("tar"), &[&"-xf", &archive, &"-C", &place, &strip]);
            let build = place.join("build");
            ran(configure(&place.join("cmake"), &build), &[&precision_option()]);
            let mut make = Command::new("cmake");
            // No crate that was fetched before, and no way to fetch one.
            make.env("CARGO_HOME", place.join("cargo-home"));
            make.env("CARGO_NET_OFFLINE", "true");
            ran(make, &[&"--build", &build]);
            ["libccd.so.2.0", "libccd.a"].map(|name| fs::read(build.join("lib").join(name)).expect("a library"))
        })
        .collect();
    for (name, i) in [("libccd.so.2.0", 0), ("libccd.a", 1)] {
        assert!(libraries[0][i] == libraries[1][i], "{name} differs");
    }
}

/// The notices that are installed name each crate that is compiled in.
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
    let tree = ran(cargo, &[&"--edges=normal,no-proc-macro", &"--format={p} {l}"]);
    let lines = tree.lines().filter(|line| !line.starts_with("warmccd "));
    let other = lines.clone().find(|line| !line.contains("Apache-2.0"));
    assert_eq!(other, None, "another licence");
    let compiled = lines.filter_map(|line| line.split(' ').next());
    assert_eq!(named, compiled.collect());
}

/// What is installed, as CMake makes it, carries no debug information and is small; and what
/// `cargo build --release` makes. (The aim is 430,000; each solver stands once for every room
/// that it works in.) Of the archive our own objects count: the rest is Rust's standard library,
/// of 10 to 20 MB as it was built.
#[test]
fn sizes_of_the_libraries() {
    let prefix = installed_and_moved();
    let [shared, archive] = ["libccd.so.2.0", "libccd.a"].map(|name| find(prefix, name));
    let bare = fresh("stripped").join("libccd.so");
    let built = harness::library(Precision::CURRENT).dir.join("libccd.so");
    ran(harness::binutils("strip"), &[&"-o", &bare, &built]);
    for file in [&shared, &bare] {
        assert_small(&file.to_string_lossy(), size(file), 680_000);
    }
    let own = size_of_own_objects(&archive);
    assert_small("our own objects in libccd.a", own, 750_000);
    for file in [shared, archive] {
        let sections = ran(Command::new("readelf"), &[&"--wide", &"--sections", &file]);
        assert!(sections.contains(".text"), "{file:?}");
        assert!(!sections.contains(".debug_"), "{file:?}");
    }
}

/// In bytes.
fn assert_small(name: &str, size: u64, most: u64) {
    println!("{name}: {size} bytes, at most {most}");
    assert!(size <= most, "{name}: {size} bytes");
}

/// Sums up the members that rustc made of this crate, which their names begin with.
fn size_of_own_objects(archive: &Path) -> u64 {
    let members = ran(harness::binutils("ar"), &[&"tv", &archive]);
    let sizes = members.lines().filter_map(|line| {
        // mode, owner, size, date, name
        let words: Vec<&str> = line.split_whitespace().collect();
        let own = words.last()?.strip_prefix("ccd")?.starts_with(['.', '-']);
        own.then(|| words[2].parse::<u64>().expect("a size"))
    });
    let size = sizes.sum();
    assert!(size > 0, "none is ours:\n{members}");
    size
}

fn size(path: &Path) -> u64 {
    fs::metadata(path).expect("a file").len()
}

/// What the archive adds to a program that calls one query: it is without Rust's panic messages
/// and backtraces as long as no function of the library can panic: 300 KB.
#[test]
fn a_program_s_growth() {
    let prefix = installed_and_moved();
    let archive = find(prefix, "libccd.a");
    let programs = fresh("sizes");
    let program = |name: &str, code: &str, libraries: &[&OsStr]| {
        let source = programs.join(format!("{name}.c"));
        fs::write(&source, code).expect("a file can be written");
        let path = programs.join(name);
        let mut cc = c_compiler();
        cc.arg("-I").arg(prefix.join("include")).arg(&source);
        cc.args(libraries).args(["-Wl,--gc-sections", "-s"]);
        ran(cc, &[&"-o", &path]);
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
    let programs = fresh("pkg-config");
    let archive = find(prefix, "libccd.a");
    let libdir = archive.parent().expect("a directory");
    let ask = |args: &[&str]| -> Vec<String> {
        let mut ask = Command::new("pkg-config");
        ask.env("PKG_CONFIG_PATH", libdir.join("pkgconfig"));
        let said = must_succeed(ask.args(args).arg("ccd"), "pkg-config");
        // A shell takes the words apart: blanks within a path are escaped.
        let mut split = Command::new("sh");
        split.arg("-c").arg(format!("printf '%s\\n' {}", said.stdout.trim()));
        must_succeed(&mut split, "sh").stdout.lines().map(String::from).collect()
    };
    assert_eq!(ask(&["--modversion"]), ["2.0"]);
    let compile = |name: &str, flags: &[String]| {
        let program = programs.join(name);
        let mut cc = c_compiler();
        cc.arg(root().join("c-tests/tests/packaging/consumer/main.c")).args(flags);
        ran(cc, &[&"-o", &program]);
        program
    };

    let mut shared = ask(&["--cflags", "--libs"]);
    shared.push(format!("-Wl,-rpath,{}", libdir.display()));
    runs_on_ours(&compile("shared", &shared), Some(prefix));

    // libccd alone from its archive, the rest shared.
    let mut one = ask(&["--static", "--cflags", "--libs"]);
    for flag in one.iter_mut().filter(|flag| *flag == "-lccd") {
        *flag = "-l:libccd.a".to_owned();
    }
    runs_on_ours(&compile("one-static", &one), None);

    // Everything static: the C library and the unwinder too.
    let mut all = ask(&["--static", "--cflags", "--libs"]);
    all.push("-static".to_owned());
    runs_on_ours(&compile("all-static", &all), None);
}

/// DESTDIR and multiarch, as a Debian package is made: the files lie where
/// Debian's own libccd has them, and none names a directory of the build.
#[test]
fn destdir_and_multiarch() {
    let dir = fresh("destdir");
    let (build, stage) = (dir.join("build"), dir.join("stage"));
    build_library(&build, Path::new("/usr"), Cargo::Release, &[]);
    let mut install = Command::new("cmake");
    install.env("DESTDIR", &stage);
    ran(install, &[&"--install", &build]);
    let triplet = ran(c_compiler(), &[&"-print-multiarch"]);
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

/// A program that asks for the other precision does not compile.
#[test]
fn the_other_precision_does_not_compile() {
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

/// The oldest Rust that Cargo.toml promises builds the library without a warning:
/// rustup's, or the system's where it is that one (Debian 13).
#[test]
fn oldest_rust() {
    let version = env!("CARGO_PKG_RUST_VERSION");
    let is_that_one = |command: &&[&str]| {
        let said = Command::new(command[0]).args(&command[1..]).arg("--version").output();
        let wanted = format!("cargo {version}.");
        said.is_ok_and(|said| said.stdout.starts_with(wanted.as_bytes()))
    };
    let choices = [&["rustup", "run", version, "cargo"][..], &["/usr/bin/cargo"]];
    let Some(cargo) = choices.into_iter().find(is_that_one) else {
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
    // What cargo told this test about the compiler it was made with.
    for variable in ["CARGO", "RUSTC", "RUSTUP_TOOLCHAIN", "CARGO_ENCODED_RUSTFLAGS"] {
        build.env_remove(variable);
    }
    if Precision::CURRENT == Precision::Single {
        build.args(["--features", "single"]);
    }
    must_succeed(&mut build, "cargo");
    // It sees fewer bounds than a newer one, and builds Debian's packages. The `contract` test
    // of the same name tells where a panic stands.
    let library = output_dir().join("oldest-rust/release/libccd.so");
    let symbols = must_succeed(harness::binutils("nm").arg(library), "nm").stdout;
    assert!(symbols.contains(" t "), "no local symbols: nothing to see");
    assert!(!symbols.contains("panicking"), "a panic is linked by Rust {version}");
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).expect("a page")
}

/// A page's program in a language, in a file of its own below `place`.
fn program_of(place: &str, name: &str, language: &str) -> PathBuf {
    let page = page(name);
    let program =
        page.split_once(&format!("```{language}\n")).and_then(|(_, rest)| rest.split_once("```")).expect("a program").0;
    let source = fresh(place).join(format!("program.{language}"));
    fs::write(&source, program).expect("a file can be written");
    source
}

/// The numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    let words = line.split(|c: char| !"+-.e".contains(c) && !c.is_ascii_digit());
    words.filter_map(|word| word.parse().ok()).collect()
}

/// The box of include/README.md is 1 cm deep in its slab, face on face, and 1 mm deeper in each of
/// two more frames.
fn assert_depth_of_the_box(said: &str) {
    assert_eq!(said.lines().count(), 3, "{said}");
    for line in said.lines() {
        let [frame, depth, up, contacts] = numbers(line)[..] else {
            panic!("{line}");
        };
        assert!((depth - 0.01 - 0.001 * frame).abs() < 1e-5, "{line}");
        assert!(up > 0.999_999 && contacts == 4.0, "{line}");
    }
}

/// The README's ball is 10 cm deep in its slab, and the page shows what the program prints.
fn assert_depth_of_the_ball(said: &str) {
    let page = page("README.md");
    let shown = page.lines().find(|line| line.starts_with("depth 0.100"));
    for line in [said.trim(), shown.expect("what it prints")] {
        for (found, truth) in numbers(line).iter().zip([0.1, 0.0, 1.0, 1.9, 0.45]) {
            assert!((found - truth).abs() < 2e-3, "{line}");
        }
        assert_eq!(numbers(line).len(), 5, "{line}");
    }
}

/// A page's program compiles without a warning.
fn strict(program: Program, page: &str, language: &str) -> Executable {
    let program = program.source(program_of(&format!("{page}-{language}"), page, language));
    let program = program.flag("-pedantic").flag("-Werror");
    program.link_ours_shared().build()
}

/// The README's C program, here and, in libccd's precision, on libccd.
#[test]
fn readme_c_program() {
    let program = strict(Program::c("readme"), "README.md", "c");
    assert_depth_of_the_ball(&program.run([""; 0]).stdout);
    if harness::Precision::CURRENT == Precision::Double {
        let program = Program::c("readme-libccd").source(program_of("readme-libccd", "README.md", "c"));
        let said = program.link_system().build().run([""; 0]).stdout;
        assert!(page("README.md").contains(said.trim()), "{said}");
    }
}

/// The C program of the headers' page.
#[test]
fn header_page_c_program() {
    let program = strict(Program::c("frames"), "include/README.md", "c");
    assert_depth_of_the_box(&program.run([""; 0]).stdout);
}

/// The README's two lines that link it, as they stand there, in a folder with its files.
#[test]
#[cfg(not(feature = "single"))]
fn readme_links_its_program() {
    let library = harness::library(Precision::CURRENT);
    let here = fresh("readme-links");
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
        // Of the archive's 15 MB what is not needed is left out.
        assert_small(line, size(&here.join("a.out")), 550_000);
    }
}

/// The C++ program, of unit spheres (0.3, 0.2, 0.1) apart: the sum of the radii less the distance.
/// In single precision its double radius would be narrowed.
#[test]
#[cfg(not(feature = "single"))]
fn readme_cpp_program() {
    let program = strict(Program::cpp("readme"), "include/README.md", "cpp");
    let depth = numbers(&program.run([""; 0]).stdout)[0];
    assert!((depth - (2.0 - 0.14_f64.sqrt())).abs() < 1e-5, "{depth}");
}

/// The one file of this name below a directory.
fn find(dir: &Path, name: &str) -> PathBuf {
    let found = ran(Command::new("find"), &[&dir, &"-name", &name]);
    assert_eq!(found.lines().count(), 1, "{name}: {found}");
    PathBuf::from(found.trim_end())
}
