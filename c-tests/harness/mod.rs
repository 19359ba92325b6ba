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
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

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

// --- the library ------------------------------------------------------------------------------

/// A release build of the library, ready to link against.
#[derive(Debug)]
pub struct LibraryBuild {
    /// Folder of libccd.so, libccd.so.2, libccd.a and librs_ccd.a.
    pub dir: PathBuf,
}

/// Returns the release library, which it builds once per process and precision.
pub fn library(precision: Precision) -> &'static LibraryBuild {
    static LIBRARIES: [OnceLock<LibraryBuild>; 2] = [OnceLock::new(), OnceLock::new()];
    LIBRARIES[precision as usize].get_or_init(|| {
        let release = if emulated() { cargo_dir().join(TARGET) } else { cargo_dir() }.join("release");
        let target = emulated().then(|| format!("--target={TARGET}"));
        let features = (precision == Precision::Single).then_some("--features=single");
        let variables = [
            ("REPOSITORY", quoted([root()])),
            ("BUILT", quoted([cargo_dir()])),
            ("FROM", quoted([release])),
            ("INTO", precision.name().to_owned()),
            ("FLAGS", quoted([rust_flags()])),
            ("FEATURES", quoted(features)),
            ("PLATFORM", quoted(target)),
        ];
        // Both precisions share their crates. Of parallel processes one builds, the others wait.
        let _lock = locked(&output_dir().join("library.lock"));
        make("library", &variables, "make (for the library)");
        LibraryBuild { dir: output_dir().join(precision.name()) }
    })
}

/// Returns the folder in which cargo builds the library for programs. CMake builds it there again with the same flags, so
/// that each precision is compiled once.
pub fn cargo_dir() -> PathBuf {
    output_dir().join("library")
}

/// Returns the flags of rustc with which `cmake/CMakeLists.txt` builds the library.
fn rust_flags() -> String {
    let variable = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let home = variable("CARGO_HOME").or_else(|| Some(variable("HOME")? + "/.cargo")).unwrap_or_default();
    let own = [format!("--remap-path-prefix={home}=/cargo"), format!("--remap-path-prefix={}=.", root().display())];
    let given = variable("CARGO_ENCODED_RUSTFLAGS").map(|flags| vec![flags]);
    [given.unwrap_or_else(|| words("RUSTFLAGS")), own.to_vec()].concat().join("\u{1f}")
}

/// Makes a target of `programs.mk`.
fn make(target: &str, variables: &[(&str, String)], what: &str) -> Written {
    let mut make = Command::new("make");
    make.args(["-s", "--no-print-directory", "-C"]).arg(output_dir()).env_remove("MAKEFLAGS");
    make.arg("-f").arg(root().join("c-tests/harness/programs.mk")).arg(target);
    must_succeed(make.args(variables.iter().map(|(name, value)| format!("{name}={value}"))), what)
}

/// Quotes words for a shell within make.
fn quoted(words: impl IntoIterator<Item = impl AsRef<OsStr>>) -> String {
    let quote = |word: &OsStr| format!("'{}'", word.to_string_lossy().replace('\'', "'\\''").replace('$', "$$"));
    words.into_iter().map(|word| quote(word.as_ref())).collect::<Vec<_>>().join(" ")
}

/// Opens a file and locks it against all other threads and processes.
#[allow(clippy::incompatible_msrv, reason = "the tests' own crates need 1.89 too")]
pub fn locked(path: &Path) -> File {
    let file = File::options().create(true).append(true).open(path);
    file.and_then(|file| file.lock().map(|()| file)).unwrap_or_else(|e| panic!("cannot lock {}: {e}", path.display()))
}

// --- tools ------------------------------------------------------------------------------------

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

// --- running ----------------------------------------------------------------------------------

/// Output of a program.
#[derive(Clone, Debug)]
pub struct Written {
    pub stdout: String,
    pub stderr: String,
}

impl Written {
    pub fn of(output: &Output) -> Written {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Written { stdout: text(&output.stdout), stderr: text(&output.stderr) }
    }
}

/// Runs a tool; panics with its output unless it succeeds.
pub fn must_succeed(command: &mut Command, what: &str) -> Written {
    let output = command.output();
    let output = output.unwrap_or_else(|e| panic!("{what} does not run ({e}): run `sh c-tests/setup.sh` first"));
    let written = Written::of(&output);
    let Written { stdout, stderr } = &written;
    assert!(output.status.success(), "{what} failed ({}): {command:?}\n{stdout}{stderr}", output.status);
    written
}

/// Runs a command under `timeout`; panics where it does not end in time.
pub fn run_command(command: &mut Command, timeout: Duration) -> (ExitStatus, Written) {
    let mut limited = Command::new("timeout");
    limited.arg(timeout.as_secs_f64().to_string());
    limited.arg(command.get_program()).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => limited.env(name, value),
            None => limited.env_remove(name),
        };
    }
    let output = limited.stdin(Stdio::null()).output();
    let output = output.unwrap_or_else(|e| panic!("cannot run {limited:?}: {e}"));
    let written = Written::of(&output);
    let timed_out = output.status.code() == Some(124);
    assert!(!timed_out, "{command:?} did not end in {timeout:?}\n{}{}", written.stdout, written.stderr);
    (output.status, written)
}

/// Parses the line `first key value key value …` of a program's output.
pub fn fields(text: &str, first: &str) -> BTreeMap<String, f64> {
    let line = text.lines().find(|line| line.split(' ').next() == Some(first));
    let words: Vec<&str> = line.unwrap_or_else(|| panic!("no `{first}` line in {text}")).split(' ').skip(1).collect();
    let number = |word: &str| word.parse().unwrap_or_else(|e| panic!("{word}: {e}"));
    words.chunks(2).map(|pair| (pair[0].to_owned(), number(pair[1]))).collect()
}

// --- programs ---------------------------------------------------------------------------------

/// The libccd of a program, by its name in `programs.mk`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Link {
    /// This library's `libccd.so.2`.
    Shared,
    /// This library's `libccd.a`.
    Static,
    /// The system's `libccd.so.2`, and this library with `rs_` before every name.
    Renamed,
    /// The system's; [`Executable::swapped`] gives the same program on this library.
    System,
}

/// C or C++ program to compile.
#[derive(Clone, Debug)]
pub struct Program {
    source: PathBuf,
    cpp: bool,
    system_headers: bool,
    flags: Vec<OsString>,
    link: Link,
    tools: bool,
}

impl Program {
    /// Returns the program of a source file in `c-tests/` (or elsewhere, by an absolute path) on this library: C99, or C++17
    /// where the file is called so.
    pub fn new(source: impl AsRef<Path>) -> Program {
        let source = root().join("c-tests").join(source);
        let cpp = source.extension() == Some("cpp".as_ref());
        Program { source, cpp, system_headers: false, flags: Vec::new(), link: Link::Shared, tools: true }
    }

    /// Compiles a C source as C++.
    pub fn in_cpp(self) -> Program {
        Program { cpp: true, ..self }
    }

    /// Includes the system's headers of libccd instead of those in `include/`.
    pub fn system_headers(self) -> Program {
        Program { system_headers: true, ..self }
    }

    /// Adds a flag for compiling and linking, which may replace one of [`compiler`]'s, or a library before libccd.
    pub fn flag(mut self, flag: impl AsRef<OsStr>) -> Program {
        self.flags.push(flag.as_ref().to_owned());
        self
    }

    /// Makes the compiler strict: a warning is an error.
    pub fn strict(self) -> Program {
        self.flag("-pedantic").flag("-Werror")
    }

    pub fn link(self, link: Link) -> Program {
        Program { link, ..self }
    }

    /// Ignores `C_TESTS_FLAGS` and `C_TESTS_RUNNER`, for a program that fails under a sanitizer or
    /// valgrind, such as one with its own malloc.
    pub fn without_tools(self) -> Program {
        Program { tools: false, ..self }
    }

    /// Compiles and links; panics with the compiler's messages where that fails.
    pub fn build(self) -> Executable {
        // The system's libccd is double.
        let is_single = Precision::CURRENT == Precision::Single && matches!(self.link, Link::Shared | Link::Static);
        let precision = if is_single { Precision::Single } else { Precision::Double };
        let mut compile = compiler(self.cpp);
        // clang compiles a C source as C++ only with -x.
        let [language, standard] = if self.cpp { ["c++", "c++17"] } else { ["c", "c99"] };
        compile.args(["-x", language]).arg(&self.source).args(["-x", "none"]).arg(format!("-std={standard}"));
        compile.args(is_single.then_some("-DCCD_SINGLE")).arg("-I").arg(root().join("c-tests"));
        if !self.system_headers {
            compile.arg("-I").arg(root().join("include"));
        }
        compile.args(if self.tools { words("C_TESTS_FLAGS") } else { Vec::new() }).args(&self.flags);

        // The hash of the command distinguishes programs of one name. All tests and runs share the program until one of its
        // files changes.
        let command = quoted(std::iter::once(compile.get_program()).chain(compile.get_args()));
        let mut hash = DefaultHasher::new();
        (&command, self.link, precision.name()).hash(&mut hash);
        let name = self.source.file_stem().unwrap_or_default().to_string_lossy();
        let program = format!("programs/{name}-{:016x}", hash.finish());
        let path = output_dir().join(&program);
        fs::create_dir_all(path.parent().expect("a folder")).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let variables = [
            ("PROGRAM", program.clone()),
            ("COMPILE", command),
            ("LINK", format!("{:?}", self.link)),
            ("INTO", precision.name().to_owned()),
        ];
        let library_path = (self.link != Link::System).then(|| library(precision).dir.clone());
        let lock = locked(&path.with_extension("lock"));
        print!("{}", make(&program, &variables, &format!("the compiler (for {name})")).stderr);
        drop(lock);

        let library_path = library_path.filter(|_| self.link == Link::Shared);
        let executable = Executable { library_path, tools: self.tools, ..Executable::new(path) };
        match self.link {
            Link::Static => assert_eq!(executable.loaded_ccd(), None, "linked statically"),
            _ => executable.assert_loads_its_ccd(),
        }
        executable
    }
}

/// Compiled program.
#[derive(Clone, Debug)]
pub struct Executable {
    pub path: PathBuf,
    /// Words of a command that runs the program.
    launcher: Vec<OsString>,
    /// Folder of this library, on which the program runs, if not on the system's.
    library_path: Option<PathBuf>,
    tools: bool,
}

impl Executable {
    /// Returns a program that another tool compiled, with its own search path for libraries.
    pub fn new(path: impl Into<PathBuf>) -> Executable {
        Executable { path: path.into(), launcher: Vec::new(), library_path: None, tools: true }
    }

    /// Returns the same program with this library instead of the system's.
    pub fn swapped(&self) -> Executable {
        let swapped = Executable { library_path: Some(library(Precision::Double).dir.clone()), ..self.clone() };
        swapped.assert_loads_its_ccd();
        swapped
    }

    /// Returns the same program run by compare.sh with these options.
    pub fn compared(&self, options: &[&str]) -> Executable {
        let mut launcher: Vec<OsString> =
            vec!["sh".into(), root().join("c-tests/compare.sh").into(), "--library".into()];
        launcher.push(library(Precision::Double).dir.join("libccd.so").into());
        launcher.extend(options.iter().map(OsString::from));
        Executable { library_path: None, launcher, ..self.clone() }
    }

    /// Runs the program and prints its output; panics unless it exits with 0 in time.
    pub fn run(&self, args: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Written {
        let (status, written) = self.run_to_end(args);
        assert!(status.success(), "{status}: {:?}\n{}", self.command(), written.stderr);
        written
    }

    /// Runs the program as [`run`](Self::run) does, with any exit code. It has 300 s, under a tool or an emulator twenty
    /// times that. Output that is too long to read is not printed.
    pub fn run_to_end(&self, args: impl IntoIterator<Item = impl AsRef<OsStr>>) -> (ExitStatus, Written) {
        let seconds = if self.runner().is_empty() { 300 } else { 6000 };
        let (status, written) = run_command(self.command().args(args), Duration::from_secs(seconds));
        if written.stdout.len() < 20_000 {
            println!("--- {}\n{}{}", self.path.display(), written.stdout, written.stderr);
        }
        (status, written)
    }

    /// Returns the words before the program.
    fn runner(&self) -> Vec<String> {
        let tool = if self.tools { words("C_TESTS_RUNNER") } else { Vec::new() };
        [emulator(), tool].concat()
    }

    /// Returns the command that runs the program, without arguments.
    pub fn command(&self) -> Command {
        let runner = self.runner().into_iter().map(OsString::from);
        self.command_of(runner.chain(self.launcher.clone()))
    }

    /// Returns the command that runs the program with the words of `runner` before it.
    fn command_of(&self, runner: impl Iterator<Item = OsString>) -> Command {
        let mut words = runner.chain([self.path.clone().into()]);
        let mut command = Command::new(words.next().expect("a path at least"));
        match &self.library_path {
            Some(dir) => command.env("LD_LIBRARY_PATH", dir),
            None => command.env_remove("LD_LIBRARY_PATH"),
        };
        // The linker resolves every symbol at the start: a missing one fails at once.
        command.args(words).env("LD_BIND_NOW", "1");
        command
    }

    /// Returns the libccd.so.2 that the dynamic linker finds for this program, as ldd does.
    pub fn loaded_ccd(&self) -> Option<PathBuf> {
        let mut command = self.command_of(emulator().into_iter().map(OsString::from));
        let written = must_succeed(command.env("LD_TRACE_LOADED_OBJECTS", "1"), &self.path.display().to_string());
        let line = written.stdout.lines().find(|line| line.contains("libccd.so"))?;
        // The path may contain blanks.
        let (path, _address) = line.split_once("=> ")?.1.rsplit_once(" (0x")?;
        Some(PathBuf::from(path))
    }

    /// Asserts that the program loads this library from its folder, or, without one, a libccd that is not this library:
    /// installed in /usr/local, this one is found first.
    fn assert_loads_its_ccd(&self) {
        let loaded = self.loaded_ccd();
        let is_ours = |file: &PathBuf| {
            fs::read(file).is_ok_and(|bytes| bytes.windows(17).any(|word| word == b"ccdImplementation"))
        };
        let is_right = loaded.as_ref().is_some_and(|file| match &self.library_path {
            Some(dir) => is_ours(file) && file.parent() == Some(dir),
            None => !is_ours(file),
        });
        assert!(is_right, "{} runs on {loaded:?}", self.path.display());
    }
}

/// Returns the command that runs a program for [`TARGET`]; empty for this machine's own.
fn emulator() -> Vec<String> {
    words(&format!("CARGO_TARGET_{}_RUNNER", TARGET.to_uppercase().replace('-', "_")))
}
