// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs programs and tools, and asserts on which libccd a program runs.

use super::{Precision, TARGET, library, root, words};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::PathBuf;
use std::process::{Command, ExitStatus, Output, Stdio};
use std::time::Duration;

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

    /// Sets the folder of this library (`None`: the program runs on the system's libccd), and whether `C_TESTS_RUNNER` runs it.
    pub fn with(self, library_path: Option<PathBuf>, tools: bool) -> Executable {
        Executable { library_path, tools, ..self }
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
    /// times that. Output that is too long to read is printed only if the program failed.
    pub fn run_to_end(&self, args: impl IntoIterator<Item = impl AsRef<OsStr>>) -> (ExitStatus, Written) {
        let seconds = if self.runner().is_empty() { 300 } else { 6000 };
        let (status, written) = run_command(self.command().args(args), Duration::from_secs(seconds));
        if !status.success() || written.stdout.len() < 20_000 {
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
    pub fn assert_loads_its_ccd(&self) {
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
