// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Instructions of a query by phase, counted by callgrind on this very program: the
//! search for a direction, the proof, the contact position, the callbacks, the rest.
//!
//! Phases are told by module. Inlined code keeps its source file in the debug
//! information, so an instruction belongs to the module of its own line; where that is
//! one of those that every phase uses, or another crate's, to the module of ours that
//! came last in the same function.

use std::path::Path;
use std::process::Command;

use super::libraries::Libraries;
use super::methods::Method;
use super::scene::Scene;
use crate::harness;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Finds a direction, or yes or no.
    Search,
    /// Encloses the origin until the bounds meet.
    Proof,
    /// Where the objects touch.
    Patch,
    /// C interface, state, bookkeeping, memory.
    Rest,
    /// In the callbacks' own object.
    Callbacks,
}

/// The folders and files of `src`; `None` is used by every phase and counts as its user's. A
/// module that is missing here fails this file's test.
const MODULES: &[(&str, Option<Phase>)] = &[
    ("gjk", Some(Phase::Search)),
    ("local", Some(Phase::Search)),
    ("paper", Some(Phase::Search)),
    ("hull", Some(Phase::Proof)),
    ("contacts", Some(Phase::Patch)),
    ("api", Some(Phase::Rest)),
    ("contact", Some(Phase::Rest)),
    ("ffi", Some(Phase::Rest)),
    ("query", Some(Phase::Rest)),
    ("shapes", Some(Phase::Rest)),
    ("state", Some(Phase::Rest)),
    ("known", None),
    ("lib", None),
    ("math", None),
];

/// Instructions of one method over one scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    pub search: u64,
    pub proof: u64,
    pub patch: u64,
    pub rest: u64,
    pub callbacks: u64,
}

impl Count {
    fn of(&mut self, phase: Phase) -> &mut u64 {
        match phase {
            Phase::Search => &mut self.search,
            Phase::Proof => &mut self.proof,
            Phase::Patch => &mut self.patch,
            Phase::Rest => &mut self.rest,
            Phase::Callbacks => &mut self.callbacks,
        }
    }

    pub fn solver(&self) -> u64 {
        self.search + self.proof + self.patch + self.rest
    }
}

/// What a module's name says, if it is one of ours: outer `None` if not.
fn module(name: &str) -> Option<Option<Phase>> {
    MODULES.iter().find(|(m, _)| *m == name).map(|(_, p)| *p)
}

/// The module of a source file under `src`.
fn file_module<'a>(file: &'a str, src: &str) -> Option<&'a str> {
    let inner = file.strip_prefix(src)?.trim_start_matches('/');
    inner.split('/').next()?.split('.').next()
}

/// The module that a function's path begins with: `ccd::gjk::…`, `<ccd::gjk::… as …>::…`.
fn function_module(function: &str) -> Option<&str> {
    let (_, path) = function.split_once("ccd::")?;
    path.split(|c: char| !c.is_alphanumeric() && c != '_')
        .next()
}

/// Self cost by phase of a callgrind file written without name compression, but for what
/// the watched program itself spends.
fn parse(text: &str, src: &str, program: &str) -> Count {
    let mut count = Count::default();
    let (mut object, mut called) = ("", false);
    let (mut phase, mut own) = (Phase::Rest, Phase::Rest);
    for line in text.lines() {
        let file = ["fl=", "fi=", "fe="]
            .iter()
            .find_map(|key| line.strip_prefix(key));
        if let Some(name) = line.strip_prefix("ob=") {
            object = name;
        } else if let Some(name) = line.strip_prefix("fn=") {
            own = function_module(name)
                .and_then(module)
                .flatten()
                .unwrap_or(Phase::Rest);
            phase = own;
        } else if let Some(file) = file {
            match file_module(file, src).and_then(module) {
                Some(Some(told)) => phase = told,
                // The line of a shared module, or of another crate: as it was.
                _ if line.starts_with("fl=") => phase = own,
                _ => (),
            }
        } else if line.starts_with("calls=") {
            // The next line is the callee's cost, counted where it is spent.
            called = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let cost = line
                .split_whitespace()
                .nth(1)
                .and_then(|c| c.parse::<u64>().ok());
            if !std::mem::take(&mut called) && object != program {
                let phase = if object.ends_with("callbacks.so") {
                    Phase::Callbacks
                } else {
                    phase
                };
                *count.of(phase) += cost.unwrap_or(0);
            }
        }
    }
    count
}

/// What callgrind counts: the method over the scene, once.
pub fn watched(libraries: &Libraries, scene: &Scene, method: &mut Method) {
    // SAFETY: does nothing.
    unsafe { (libraries.callbacks.begin)() };
    for pair in &scene.pairs {
        std::hint::black_box(method.query(scene, pair));
    }
    // SAFETY: does nothing.
    unsafe { (libraries.callbacks.end)() };
}

/// Runs this program with these arguments under callgrind: the counts in the order in which they were made.
pub fn counts(arguments: &[&str]) -> Result<Vec<Count>, String> {
    let work = tempfile::tempdir().map_err(|e| e.to_string())?;
    let out = work.path().join("out");
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--compress-strings=no"])
        .args(["--compress-pos=no"])
        .args(["--zero-before=bench_begin", "--dump-after=bench_end"])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(&program)
        .args(arguments)
        // A lazy binding would be counted as the query's.
        .env("LD_BIND_NOW", "1")
        .output()
        .map_err(|e| format!("valgrind: {e}"))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let src = harness::root().join("src").display().to_string();
    let file = |i: usize| Path::new(&out).with_extension(i.to_string());
    Ok((1..)
        .map_while(|i| std::fs::read_to_string(file(i)).ok())
        .map(|text| parse(&text, &src, &program.display().to_string()))
        .collect())
}

#[cfg(test)]
mod tests {
    #[test]
    fn callgrind_self_cost_by_phase() {
        let text = "ob=/t/callbacks.so\nfl=/t/shapes.h\nfn=f\n1 10\nob=/l/libccd.so\nfl=/w/src/hull/expansion.rs\n\
            fn=ccd::hull::expansion::minimum\n1 5\nfi=/rustc/core/arith.rs\n2 7\nfi=/w/src/contacts/fan.rs\n3 100\n\
            fi=/w/src/math.rs\n4 200\nfe=/w/src/hull/expansion.rs\n5 1\ncob=/t/callbacks.so\ncfn=f\ncalls=2 1\n3 15\n6 2\n\
            fl=/rustc/core/zip.rs\nfn=<core::Zip<ccd::paper::incremental::M> as X>::next\n7 1000\n\
            ob=/bin/charts\nfl=/w/c-tests/lab.rs\nfn=run\n1 77\nob=/l/libccd.so\n\
            fl=/w/src/ffi/collide.rs\nfn=ccdMPRPenetration\n8 10000\nfi=/w/src/paper/portal.rs\n9 3\n";
        let expected = super::Count {
            search: 1003,
            proof: 15,
            patch: 300,
            rest: 10000,
            callbacks: 10,
        };
        assert_eq!(super::parse(text, "/w/src", "/bin/charts"), expected);
    }

    #[test]
    fn every_module_has_its_phase() {
        let src = crate::harness::root().join("src");
        let names = std::fs::read_dir(src).expect("the sources");
        for entry in names {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|e| e != "rs") {
                continue;
            }
            let name = path.file_stem().and_then(|n| n.to_str()).expect("a name");
            assert!(
                super::MODULES.iter().any(|(m, _)| *m == name),
                "{name} is missing in the table of phases"
            );
        }
    }
}
