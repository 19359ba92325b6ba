// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! compare.sh on programs whose callbacks throw, jump, return wrong points, have memory, and query from many
//! threads: the program's results are those without the tool, and the counts are those known by other means.

use crate::harness::{self, Executable, Link, Program, fields, root};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

fn on_libccd(program: Program) -> Executable {
    program.link(Link::System).without_tools().build()
}

fn callbacks() -> Executable {
    let program = Program::new("lab/compare/callbacks.cpp");
    on_libccd(program.flag("-pthread"))
}

/// The results of the program itself, without and with the tool, and the tool's counts.
struct Compared {
    alone: BTreeMap<String, f64>,
    with: BTreeMap<String, f64>,
    counted: BTreeMap<String, f64>,
}

impl Compared {
    fn run(mode: &str, options: &[&str]) -> Compared {
        let program = callbacks();
        let alone = program.run([mode]).stdout;
        let with = program.compared(&[&["--fields"], options].concat()).run([mode]).stdout;
        let [alone, with_tool] = [&alone, &with].map(|stdout| fields(stdout, "results"));
        Compared { alone, with: with_tool, counted: fields(&with, "counted") }
    }

    /// Runs with every query judged; the program's results must be those without the tool.
    fn unchanged(mode: &str) -> Compared {
        let compared = Compared::run(mode, EVERY);
        for key in ["hits", "left", "depth", "uncaught"] {
            assert_eq!(compared.alone[key], compared.with[key], "{mode}: {key}");
        }
        compared
    }

    fn assert(&self, expected: &[(&str, f64)]) {
        for (key, count) in expected {
            assert_eq!(self.counted[*key], *count, "{key}: {:?}", self.counted);
        }
    }

    /// No answer of this library was judged wrong.
    fn assert_ours_right(&self) {
        let judged = self.counted["judged"];
        assert!(judged > 0.0);
        self.assert(&[("ours_right", judged), ("contradicted", 0.0)]);
    }
}

const EVERY: &[&str] = &["--every", "1"];

#[test]
fn all_calls_are_counted_and_judged() {
    let w = Compared::unchanged("plain");
    w.assert(&[("queries", 500.0), ("returned", 500.0), ("judged", 500.0)]);
    w.assert(&[("memory", 0.0), ("no_shape", 0.0), ("threw", 0.0)]);
    assert_eq!(w.counted["hits"], w.with["hits"]);
    w.assert_ours_right();
    assert!(w.counted["theirs_deep"] > 10.0, "{:?}", w.counted);
}

/// Judges one query in so many; with 0 the tool makes no call of its own.
#[test]
fn a_share_is_judged() {
    let w = Compared::run("plain", &["--every", "10"]);
    let judged = w.counted["judged"];
    assert!((25.0..=100.0).contains(&judged), "{judged}");
    w.assert(&[("queries", 500.0), ("sampled", judged)]);
    Compared::run("plain", &["--every", "0"]).assert(&[("queries", 500.0), ("sampled", 0.0)]);
}

/// ld.so splits LD_PRELOAD at blanks.
#[test]
fn the_temporary_folder_may_have_a_blank() {
    let dir = tempfile::Builder::new().prefix("a folder").tempdir().expect("a directory");
    let mut command = callbacks().compared(&["--fields"]).command();
    let written = harness::must_succeed(command.arg("plain").env("TMPDIR", dir.path()), "compare.sh");
    assert_eq!(fields(&written.stdout, "counted")["queries"], 500.0);
}

/// The whole process uses this library then, as its first line says.
#[test]
fn swapped_program_gets_the_answers_of_this_library() {
    let stdout = callbacks().compared(&["--swap"]).run(["plain"]).stdout;
    assert!(stdout.starts_with("library warmccd "), "{stdout}");
    let w = Compared::run("plain", EVERY);
    let swapped = Compared::run("plain", &["--swap", "--every", "1"]);
    assert!(swapped.with["depth"] < w.with["depth"]);
    assert_eq!(swapped.counted["theirs_deep"], w.counted["theirs_deep"]);
}

#[test]
fn exceptions_and_jumps_pass_through() {
    for mode in ["throw", "jump"] {
        let w = Compared::unchanged(mode);
        assert!(w.with["left"] > 100.0);
        w.assert(&[("queries", 500.0), ("returned", 500.0 - w.with["left"])]);
        w.assert_ours_right();
    }
}

/// Exceptions and jumps out of the tool's own calls do not reach the program.
#[test]
fn exceptions_and_jumps_out_of_the_tools_calls_are_caught() {
    for mode in ["later", "jump-later"] {
        let w = Compared::unchanged(mode);
        assert_eq!(w.with["left"], 0.0);
        assert!(w.counted["threw"] > 10.0, "{:?}", w.counted);
        w.assert(&[("queries", 500.0), ("returned", 500.0)]);
    }
    let within = Compared::unchanged("within");
    within.assert(&[("judged", 500.0), ("threw", 0.0)]);
}

/// In many directions, or in few that give the upper bound: no library is blamed for the callback.
#[test]
fn wrong_support_points_are_counted() {
    for (mode, least) in [("wrong", 100.0), ("rarely-wrong", 50.0)] {
        let w = Compared::unchanged(mode);
        assert!(w.counted["no_shape"] > least && w.counted["judged"] > 50.0, "{:?}", w.counted);
        assert_eq!(w.counted["no_shape"] + w.counted["judged"], 500.0);
        w.assert_ours_right();
    }
}

#[test]
fn callbacks_with_memory_are_reported() {
    let w = Compared::unchanged("memory");
    assert!(w.counted["memory"] > 100.0, "{:?}", w.counted);
    let screen = screen("memory", &["--every", "1"]).1;
    assert!(screen.contains("callbacks with memory"), "{screen}");
}

#[test]
fn threads_children_and_nested_queries_are_counted() {
    for (mode, queries) in [("threads", 2000.0), ("fork", 1000.0)] {
        let w = Compared::unchanged(mode);
        w.assert(&["queries", "returned", "judged"].map(|key| (key, queries)));
        w.assert_ours_right();
    }
    let nested = Compared::unchanged("nested");
    assert!(nested.counted["queries"] > 1000.0);
    nested.assert_ours_right();
}

/// Returns the exit code, or 128 and the signal as in a shell, and the tool's output.
fn screen_of(program: &Path, args: &[&str], options: &[&str]) -> (i32, String) {
    let (status, written) = Executable::new(program).compared(options).run_to_end(args);
    (status.code().expect("a code"), written.stderr)
}

fn screen(mode: &str, options: &[&str]) -> (i32, String) {
    screen_of(&callbacks().path, &[mode], options)
}

#[test]
fn exit_codes_are_passed_on_and_the_screen_is_printed() {
    for (mode, code) in [("plain", 0), ("exit", 7), ("_exit", 3), ("abort", 134)] {
        let (status, screen) = screen(mode, &[]);
        assert_eq!(status, code, "{mode}\n{screen}");
        for part in [&format!("exit code {code}"), "ccdMPRPenetration", "this library ", "A query takes "] {
            assert!(screen.contains(part), "{mode}: no `{part}`\n{screen}");
        }
    }
}

/// Returns the words after `before` in the last line.
fn verdict_after<'a>(screen: &'a str, before: &str) -> &'a str {
    let last = screen.trim_end().lines().next_back().expect("a line");
    last.split_once(before).unwrap_or_else(|| panic!("no `{before}` in `{last}`")).1
}

/// The times of queries promise a lower bound; runs of the program itself give the last line its price.
#[test]
fn the_last_line_is_the_verdict() {
    let (_, forecast) = screen("plain", &["--every", "1"]);
    let last = verdict_after(&forecast, "libccd: ");
    let (deep, rest) = last.split_once(" of ").expect("a count");
    assert!(deep.parse::<f64>().expect("a number") > 10.0, "{last}");
    assert!(rest.contains(" overlaps more than 1 % too deep"), "{last}");
    assert!(rest.contains("; this library: 0; the program takes ") && rest.ends_with(" times the time."), "{last}");
    assert!(forecast.contains("timed on warm caches") && forecast.contains("`--runs 5` measures it"), "{forecast}");

    let (code, measured) = screen("exit", &["--every", "1", "--runs", "3"]);
    assert_eq!(code, 7);
    let price = verdict_after(&measured, "; this library: 0; the program takes ");
    let times: f64 = price.strip_suffix(" times the time.").expect("a ratio").parse().expect("a number");
    assert!((0.2..5.0).contains(&times), "{price}");
    for library in ["libccd", "this library"] {
        let line = measured
            .lines()
            .find(|line| line.trim_start().starts_with(library) && line.contains("the median of 3 runs"));
        assert!(line.is_some(), "{library}\n{measured}");
    }
}

/// A program that hangs or crashes on libccd: each run ends at the limit with its children, and the last line says so.
#[test]
fn runs_that_do_not_end_are_ended() {
    // 124, the harness's own code at its limit, is passed on here.
    let command = callbacks().compared(&["--runs", "2", "--limit", "3"]).command().arg("hang").output();
    let command = command.expect("a shell");
    let hung = String::from_utf8_lossy(&command.stderr);
    assert_eq!(command.status.code(), Some(124), "{hung}");
    assert_eq!(verdict_after(&hung, "this library: "), "0; on libccd the program does not end in 3 s.");
    assert!(hung.contains("1 ended at the limit") && hung.contains("the median of 2 runs"), "{hung}");
    let (code, crashed) = screen("crash", &["--runs", "2"]);
    assert_eq!(
        (code, verdict_after(&crashed, "this library: ")),
        (134, "0; on libccd the program ends with exit code 134.")
    );
    let (code, swapped) = screen("crash", &["--swap"]);
    assert!(code == 0 && swapped.contains("; the program takes "), "{swapped}");
}

/// Errors have the unit that a person reads.
#[test]
fn lengths_have_units() {
    let (_, screen) = screen("plain", &["--every", "1"]);
    let units: Vec<&str> =
        screen.lines().filter(|line| line.starts_with("libccd  ")).flat_map(str::split_whitespace).collect();
    assert!(units.contains(&"mm") && units.iter().all(|word| !word.contains("e+")), "{screen}");
}

#[test]
fn programs_that_cannot_be_compared_get_one_line() {
    let dir = tempfile::tempdir().expect("a directory");
    let [file, statically] = ["static.c", "static"].map(|name| dir.path().join(name));
    std::fs::write(&file, "int main(void) { return 0; }").expect("a file");
    let mut compile = harness::compiler(false);
    compile.arg("-static").arg(&file).arg("-o").arg(&statically);
    harness::must_succeed(&mut compile, "the compiler");
    let of = |program: &str| screen_of(Path::new(program), &[], &[]);
    for ((code, stderr), expected, part) in [
        (screen("nothing", &[]), 0, "did not query libccd"),
        (of("/bin/true"), 0, "is not linked to libccd"),
        (of("/nowhere/at/all"), 125, "no such program"),
        (of(statically.to_str().expect("a path")), 125, "not a dynamically linked"),
    ] {
        assert_eq!((code, stderr.trim_end().lines().count()), (expected, 1), "{stderr}");
        assert!(stderr.contains(part), "{stderr}");
    }
}

/// The tool's counts of the recorded contacts are those of the benchmark, by a truth that neither
/// library made.
#[test]
fn recorded_contacts_are_counted_as_by_the_benchmark() {
    let replay = on_libccd(Program::new("tools/record/replay.c").flag("-DONE_TOLERANCE"));
    let recording = root().join("c-tests/tools/record/contacts.bin");
    let theirs = replay.run([&recording]).stdout;
    let ours = replay.swapped().run([&recording]).stdout;
    let counted = fields(&replay.compared(&["--fields", "--every", "1"]).run([&recording]).stdout, "counted");
    for (side, text) in [("theirs", &theirs), ("ours", &ours)] {
        // missed, false, broken, deep, unsound, wrong directions, mean and largest error, supports; from the end
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().rev().collect()).collect();
        let rows = rows.iter().filter(|row| row.last().is_some_and(|method| ["MPR", "GJK"].contains(method)));
        let column = |c: usize| rows.clone().map(move |row| row[c].parse::<f64>().expect("a number"));
        let sum = |c: usize| column(c).sum::<f64>();
        let count = |key: &str| counted[&format!("{side}_{key}")];
        for (key, c) in [("missed", 10), ("spurious", 9), ("broken", 8), ("deep", 7)] {
            assert_eq!(count(key), sum(c), "{side} {key}");
        }
        // The tool also counts moves of the right length in another direction.
        // And it proves its truth to the tolerance alone: one move may be just within that.
        let unsound = count("unsound") - count("aside") - sum(6);
        assert!(unsound.abs() <= 1e-4 * sum(6), "{side}: {unsound}");
        let supports = count("supports") / counted["judged"];
        assert!((supports - sum(2) / 2.0).abs() < 0.01, "{side}: {supports}");
        let (largest, expected) = (1e6 * count("error_max"), column(3).fold(0.0, f64::max));
        assert!((largest - expected).abs() < 0.51, "{side}: {largest} {expected}");
    }
    assert_eq!(counted["judged"], 2.0 * 37458.0);
    assert_eq!(counted["overlaps"], 2.0 * 23004.0);
    for key in ["memory", "no_shape", "threw", "contradicted"] {
        assert_eq!(counted[key], 0.0, "{key}");
    }
}

/// Where the program loads this library, as after an installation, the scripts compare it with the system's other libccd.
#[test]
fn the_other_libccd_is_found() {
    let ours = harness::library(harness::Precision::Double);
    let script = |name: &str, rest: &[&Path]| {
        let mut command = Command::new("sh");
        command.arg(root().join("c-tests").join(name)).arg("--library").arg(ours.dir.join("libccd.so")).args(rest);
        command.env("LD_LIBRARY_PATH", &ours.dir);
        let (_, written) = harness::run_command(&mut command, Duration::from_secs(300));
        written.stdout + &written.stderr
    };
    let screen = script("compare.sh", &[&callbacks().path, Path::new("plain")]);
    let named = screen.lines().find_map(|line| line.strip_prefix("   libccd: ")).expect("a library");
    assert!(named.ends_with("/libccd.so.2") && !Path::new(named).starts_with(&ours.dir), "{screen}");
    assert!(screen.contains("A query takes "), "{screen}");
}

/// A case shows libccd's fault again, and is answered right by this library.
#[test]
fn written_cases_replay() {
    let dir = tempfile::tempdir().expect("a directory");
    let keep = dir.path().to_str().expect("a path");
    let (_, screen) = screen("plain", &["--every", "1", "--keep", keep]);
    let kept: Vec<_> =
        std::fs::read_dir(dir.path()).expect("the directory").map(|file| file.expect("a file").path()).collect();
    assert!(kept.len() >= 2, "{screen}");
    for path in &kept {
        let name = path.to_str().expect("a path");
        assert!(name.contains("/libccd-") && screen.contains(name), "{screen}");
        let mut replay = Command::new("sh");
        replay.arg(root().join("c-tests/replay.sh"));
        replay.arg("--library").arg(harness::library(harness::Precision::Double).dir.join("libccd.so"));
        let stdout = harness::must_succeed(replay.arg(path), "replay.sh").stdout;
        let (theirs, ours) = stdout.split_once("== this library").expect("two answers");
        assert!(theirs.contains("== libccd: ") && !theirs.contains(": right") && ours.contains(": right"), "{stdout}");
    }
}

/// The trace of a kept case has a line for each support point, and the end with bounds that have met.
#[test]
fn a_trace_shows_every_direction_and_the_end() {
    let dir = tempfile::tempdir().expect("a directory");
    screen("plain", &["--every", "1", "--keep", dir.path().to_str().expect("a path")]);
    let mut replay = Command::new("sh");
    replay.arg(root().join("c-tests/replay.sh")).arg("--trace").arg(dir.path().join("libccd-deep.txt"));
    let trace = harness::must_succeed(&mut replay, "replay.sh").stderr;
    let directions: Vec<_> = trace.lines().filter(|line| line.contains("  bounds ")).collect();
    assert!(directions.len() >= 4 && directions[0].starts_with("start "), "{trace}");
    assert!(directions.iter().all(|line| line.contains(" dir ") && line.contains("  h ")), "{trace}");
    assert!(trace.lines().any(|line| line.starts_with("end ") && line.contains("Converged, bounds ")), "{trace}");
}
