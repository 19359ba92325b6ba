// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Instructions and mispredicted branches of a query in the solver and in the callbacks, counted by callgrind on this
//! program itself.

use std::ffi::c_void;
use std::fs;
use std::hint::black_box;
use std::ops::AddAssign;
use std::process::Command;

use super::libraries::Libraries;
use super::methods::Method;
use super::scene::{Pair, Scene};
use crate::harness::Written;

/// Set in the process under callgrind.
const COUNTING: &str = "WARMCCD_COUNTING";

/// Returns whether this process is the one under callgrind: it runs the methods and measures nothing itself.
pub fn is_counting() -> bool {
    std::env::var_os(COUNTING).is_some()
}

/// What a part of the queries costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Without memset's: `rep stosb` counts one a byte, though it takes next to no time. memcpy's count.
    pub instructions: u64,
    /// Of conditional and of indirect branches, by callgrind's model of a processor.
    pub mispredictions: u64,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.instructions += other.instructions;
        self.mispredictions += other.mispredictions;
    }
}

/// Costs of one method over one scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    pub solver: Cost,
    pub callbacks: Cost,
    /// Of this program itself.
    pub program: Cost,
}

/// Sums the self cost in a callgrind file written without name compression.
fn parse(text: &str, program: &str) -> Count {
    let mut count = Count::default();
    let (mut object, mut function, mut is_callee) = ("", "", false);
    let mut events = Vec::new();
    for line in text.lines() {
        if let Some(names) = line.strip_prefix("events: ") {
            events = names.split(' ').collect();
        } else if let Some(name) = line.strip_prefix("ob=") {
            object = name;
        } else if let Some(name) = line.strip_prefix("fn=") {
            function = name;
        } else if line.starts_with("calls=") {
            // The next line repeats the cost of the callee.
            is_callee = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            if std::mem::take(&mut is_callee) || function.contains("memset") {
                continue;
            }
            // The line in the source, then a number for each event; zeros at the end are left out.
            let numbers: Vec<u64> = line.split(' ').skip(1).filter_map(|word| word.parse().ok()).collect();
            let number = |event| {
                let at = events.iter().position(|name| *name == event);
                at.and_then(|at| numbers.get(at)).copied().unwrap_or_default()
            };
            let part = match object {
                _ if object == program || function == "bench_counted" => &mut count.program,
                _ if object.ends_with("callbacks.so") => &mut count.callbacks,
                _ => &mut count.solver,
            };
            *part += Cost { instructions: number("Ir"), mispredictions: number("Bcm") + number("Bim") };
        }
    }
    count
}

/// Runs the method over every n-th pair of the scene, for callgrind to count.
pub fn count(libraries: &Libraries, scene: &Scene, method: &mut Method, every: usize) {
    /// A method and a pair for `bench_counted`.
    type Query<'a, 'b> = (&'a mut Method<'b>, &'a Pair);
    unsafe extern "C-unwind" fn query(data: *mut c_void) {
        // SAFETY: below.
        let (method, pair) = unsafe { &mut *data.cast::<Query>() };
        black_box((method.query)(pair));
    }
    for pair in scene.pairs.iter().step_by(every) {
        if method.is_measured(pair) {
            let mut data: Query = (&mut *method, pair);
            // SAFETY: the data outlive the call.
            unsafe { (libraries.callbacks.counted)(query, (&raw mut data).cast()) };
        } else {
            black_box((method.query)(pair));
        }
    }
    // SAFETY: does nothing.
    unsafe { (libraries.callbacks.end)() };
}

/// Runs a command under callgrind with these options and uncompressed names. Returns its output and
/// the text of each dump.
pub fn run(plain: &Command, options: &[&str]) -> Result<(Written, Vec<String>), String> {
    let work = tempfile::tempdir().map_err(|e| e.to_string())?;
    let out = work.path().join("out");
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--compress-strings=no", "--compress-pos=no"]).args(options);
    command.arg(format!("--callgrind-out-file={}", out.display()));
    command.arg(plain.get_program()).args(plain.get_args());
    command.envs(plain.get_envs().filter_map(|(name, to)| Some((name, to?))));
    // Lazy binding would be counted as part of the query.
    let output = command.env("LD_BIND_NOW", "1").output().map_err(|e| format!("valgrind: {e}"))?;
    let written = Written::of(&output);
    if !output.status.success() {
        return Err(written.stderr);
    }
    let dumps = (1..).map(|i: usize| out.with_extension(i.to_string())).take_while(|file| file.exists());
    let texts = std::iter::once(out.clone()).chain(dumps).filter_map(|file| fs::read_to_string(file).ok());
    Ok((written, texts.collect()))
}

/// Runs this program under callgrind with the words of a command. Returns the counts in their order.
pub fn counts(command: &[&str]) -> Result<Vec<Count>, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let mut plain = Command::new(&program);
    plain.args(command).env(COUNTING, "1");
    let options = ["--branch-sim=yes", "--toggle-collect=bench_counted", "--dump-after=bench_end"];
    let (_, texts) = run(&plain, &options)?;
    let program = program.display().to_string();
    // The first is the end of the program.
    Ok(texts.iter().skip(1).map(|text| parse(text, &program)).collect())
}

#[cfg(test)]
mod tests {
    #[test]
    fn callgrind_self_cost() {
        use super::{Cost, Count};
        let text = "events: Ir Bc Bcm Bi Bim\nob=/t/callbacks.so\nfl=/t/shapes.h\nfn=f\n1 10 4 3 2 1\n\
            ob=/l/libccd.so\nfl=/w/a.rs\nfn=g\n1 5\nfi=/rustc/b.rs\n2 7 1 1\ncob=/t/callbacks.so\ncfn=f\ncalls=2 1\n\
            3 15 9 9\n6 2\nob=/bin/charts\nfl=/w/c-tests/bench.rs\nfn=run\n1 77\nob=/l/libccd.so\nfn=h\n8 1000\n\
            ob=/l/libc.so.6\nfn=__memset_avx2_unaligned_erms\n0 3200 5 5\nfn=memcpy\n0 20\n";
        let cost = |instructions, mispredictions| Cost { instructions, mispredictions };
        let expected = Count { solver: cost(1034, 1), callbacks: cost(10, 4), program: cost(77, 0) };
        assert_eq!(super::parse(text, "/bin/charts"), expected);
    }
}
