// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Builds the release library, and programs around it, by make.

use super::{Executable, Precision, TARGET, Written, compiler, emulated, must_succeed, output_dir, root, words};
use std::collections::hash_map::DefaultHasher;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

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
    /// Returns the program of a source file in `c-tests/` (or elsewhere, by an absolute path) on this library: C++17 if its
    /// name ends in `.cpp`, else C99.
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
        let executable = Executable::new(path).with(library_path, self.tools);
        match self.link {
            Link::Static => assert_eq!(executable.loaded_ccd(), None, "linked statically"),
            _ => executable.assert_loads_its_ccd(),
        }
        executable
    }
}
