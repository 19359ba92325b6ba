// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! compare.sh under programs whose callbacks throw, jump, lie, remember, and ask from many
//! threads: the program sees what it sees unwatched, and the counts are those known otherwise.

// Debian's libccd is double, and the tool compares with it.
#![cfg(not(feature = "single"))]

#[path = "../../harness/mod.rs"]
mod harness;

use harness::{Executable, Program, fields, root};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// For libccd, to be watched.
fn watchable(program: Program) -> Executable {
    program.link_system().without_tools().build().quiet()
}

fn callbacks() -> Executable {
    let program = Program::cpp("callbacks").source("tools/compare/callbacks.cpp");
    watchable(program.flag("-pthread"))
}

/// What the program itself saw, and what the tool counted, with every query judged.
struct Watched {
    alone: BTreeMap<String, f64>,
    seen: BTreeMap<String, f64>,
    counted: BTreeMap<String, f64>,
}

impl Watched {
    fn run(way: &str, options: &[&str]) -> Watched {
        let program = callbacks();
        let alone = program.run([way]).stdout;
        let with = program.compared(options).run([way]).stdout;
        Watched { alone: fields(&alone, "seen"), seen: fields(&with, "seen"), counted: fields(&with, "watched") }
    }

    /// The program went on as if nobody watched.
    fn assert_unchanged(&self) {
        for key in ["hits", "left", "depth", "uncaught"] {
            assert_eq!(self.alone[key], self.seen[key], "{key}");
        }
    }

    fn assert(&self, expected: &[(&str, f64)]) {
        for (key, count) in expected {
            assert_eq!(self.counted[*key], *count, "{key}: {:?}", self.counted);
        }
    }

    /// No query was judged wrong that is this library's.
    fn assert_ours_right(&self) {
        let judged = self.counted["judged"];
        assert!(judged > 0.0);
        self.assert(&[("ours_right", judged), ("contradicted", 0.0)]);
    }
}

const EVERY: &[&str] = &["--every", "1"];

#[test]
fn all_calls_are_counted_and_judged() {
    let w = Watched::run("plain", EVERY);
    w.assert_unchanged();
    w.assert(&[("queries", 500.0), ("returned", 500.0), ("judged", 500.0)]);
    w.assert(&[("memory", 0.0), ("no_shape", 0.0), ("threw", 0.0)]);
    assert_eq!(w.counted["hits"], w.seen["hits"]);
    w.assert_ours_right();
    assert!(w.counted["theirs_deep"] > 10.0, "{:?}", w.counted);
}

/// The share is one in so many, and without one nothing is asked beside the program.
#[test]
fn a_share_is_judged() {
    let w = Watched::run("plain", &["--every", "10"]);
    let judged = w.counted["judged"];
    assert!((25.0..=100.0).contains(&judged), "{judged}");
    w.assert(&[("queries", 500.0), ("sampled", judged)]);
    Watched::run("plain", &["--every", "0"]).assert(&[("queries", 500.0), ("sampled", 0.0)]);
}

/// The whole process is on this library then, as its first line says.
#[test]
fn swapped_the_program_goes_on_with_this_library() {
    let told = callbacks().compared(&["--swap"]).run(["plain"]).stdout;
    assert!(told.starts_with("library warmccd "), "{told}");
    let w = Watched::run("plain", EVERY);
    let swapped = Watched::run("plain", &["--swap", "--every", "1"]);
    assert!(swapped.seen["depth"] < w.seen["depth"]);
    assert_eq!(swapped.counted["theirs_deep"], w.counted["theirs_deep"]);
}

#[test]
fn exceptions_and_jumps_pass_through() {
    for way in ["throw", "jump"] {
        let w = Watched::run(way, EVERY);
        w.assert_unchanged();
        assert!(w.seen["left"] > 100.0);
        w.assert(&[("queries", 500.0), ("returned", 500.0 - w.seen["left"])]);
        w.assert_ours_right();
    }
}

/// What leaves a question of the tool's own stays with the tool.
#[test]
fn what_leaves_the_tools_own_questions_stays_there() {
    for way in ["later", "jump-later"] {
        let w = Watched::run(way, EVERY);
        w.assert_unchanged();
        assert_eq!(w.seen["left"], 0.0);
        assert!(w.counted["threw"] > 10.0, "{:?}", w.counted);
        w.assert(&[("queries", 500.0), ("returned", 500.0)]);
    }
    let within = Watched::run("within", EVERY);
    within.assert_unchanged();
    within.assert(&[("judged", 500.0), ("threw", 0.0)]);
}

#[test]
fn a_callback_that_lies_is_noticed() {
    let w = Watched::run("lie", EVERY);
    w.assert_unchanged();
    assert!(w.counted["no_shape"] > 100.0, "{:?}", w.counted);
    assert_eq!(w.counted["no_shape"] + w.counted["judged"], 500.0);
    w.assert_ours_right();
}

/// In few directions, which give the upper bound: no library is accused of what the callback does.
#[test]
fn a_callback_that_lies_in_few_directions_is_noticed() {
    let w = Watched::run("seldom", EVERY);
    w.assert_unchanged();
    assert!(w.counted["no_shape"] > 50.0, "{:?}", w.counted);
    assert!(w.counted["judged"] > 50.0, "{:?}", w.counted);
    w.assert_ours_right();
}

#[test]
fn a_callback_with_memory_is_noticed_and_said() {
    let w = Watched::run("drift", EVERY);
    w.assert_unchanged();
    assert!(w.counted["memory"] > 100.0, "{:?}", w.counted);
    let screen = screen("drift", &["--every", "1"]).1;
    assert!(screen.contains("callbacks with memory"), "{screen}");
}

#[test]
fn threads_children_and_nested_queries() {
    for (way, queries) in [("threads", 2000.0), ("fork", 1000.0)] {
        let w = Watched::run(way, EVERY);
        w.assert_unchanged();
        w.assert(&["queries", "returned", "judged"].map(|key| (key, queries)));
        w.assert_ours_right();
    }
    let nested = Watched::run("nested", EVERY);
    nested.assert_unchanged();
    assert!(nested.counted["queries"] > 1000.0);
    nested.assert_ours_right();
}

/// Exit code, or 128 and the signal as shells say, and what the tool wrote.
fn screen_of(program: &Path, args: &[&str], options: &[&str]) -> (i32, String) {
    let (status, written) =
        Executable::made_elsewhere("compared", program).quiet().compared(options).with_screen().run_to_end(args);
    (status.code().expect("a code"), written.stderr)
}

fn screen(way: &str, options: &[&str]) -> (i32, String) {
    screen_of(&callbacks().path, &[way], options)
}

#[test]
fn exit_codes_are_handed_on_and_the_screen_comes() {
    for (way, code) in [("plain", 0), ("exit", 7), ("_exit", 3), ("abort", 134)] {
        let (given, screen) = screen(way, &[]);
        assert_eq!(given, code, "{way}\n{screen}");
        for part in [
            &format!("exit code {code}"),
            "ccdMPRPenetration",
            "proven minimum",
            "A support point of both your objects costs",
            "What the swap changes",
        ] {
            assert!(screen.contains(part), "{way}: no `{part}`\n{screen}");
        }
    }
}

#[test]
fn what_cannot_be_watched_is_said_in_one_line() {
    let dir = tempfile::tempdir().expect("a directory");
    let [file, statically] = ["static.c", "static"].map(|name| dir.path().join(name));
    std::fs::write(&file, "int main(void) { return 0; }").expect("a file");
    let mut compile = harness::compile_with(&harness::compiler(false));
    compile.arg("-static").arg(&file).arg("-o").arg(&statically);
    harness::must_succeed(&mut compile, "the compiler");
    let of = |program: &str| screen_of(Path::new(program), &[], &[]);
    for ((code, told), expected, part) in [
        (screen("nothing", &[]), 0, "asked libccd nothing"),
        (of("/bin/true"), 0, "is not linked to libccd"),
        (of("/nowhere/at/all"), 125, "no such program"),
        (of(statically.to_str().expect("a path")), 125, "not a dynamically linked"),
    ] {
        assert_eq!((code, told.trim_end().lines().count()), (expected, 1), "{told}");
        assert!(told.contains(part), "{told}");
    }
}

/// The recorded contacts: the tool counts what the benchmark counts, by truth that neither
/// library made.
#[test]
fn the_recorded_contacts_are_counted_as_the_benchmark_counts_them() {
    let replay = watchable(Program::c("replay").source("tools/record/replay.c"));
    let recording = root().join("c-tests/tools/record/contacts.bin");
    let theirs = replay.run([&recording]).stdout;
    let ours = replay.swapped().run([&recording]).stdout;
    let told = replay.compared(EVERY).run([&recording]).stdout;
    let counted = fields(&told, "watched");
    // missed, false, broken, deep, unsound, mean and largest error, supports of both methods
    let column = |text: &str, column: usize| -> Vec<f64> {
        let rows = text.lines().filter(|l| l.starts_with("MPR") || l.starts_with("GJK"));
        rows.map(|row| {
            let words: Vec<&str> = row.split_whitespace().rev().collect();
            words[column].parse().expect("a number")
        })
        .collect()
    };
    for (side, text) in [("theirs", &theirs), ("ours", &ours)] {
        let sum = |c: usize| column(text, c).iter().sum::<f64>();
        let of = |key: &str| counted[&format!("{side}_{key}")];
        assert_eq!(of("missed"), sum(9), "{side}");
        assert_eq!(of("spurious"), sum(8), "{side}");
        assert_eq!(of("broken"), sum(7), "{side}");
        assert_eq!(of("deep"), sum(6), "{side}");
        // The tool also counts moves of the right length in another direction.
        // And it knows the truth by a proof to the tolerance alone: one move may be just within that.
        let unsound = of("unsound") - of("aside") - sum(5);
        assert!(unsound.abs() <= 1e-4 * sum(5), "{side}: {unsound}");
        let supports = of("supports") / counted["judged"];
        assert!((supports - sum(2) / 2.0).abs() < 0.01, "{side}: {supports}");
        let largest = 1e6 * of("error_max");
        let told = column(text, 3).into_iter().fold(0.0, f64::max);
        assert!((largest - told).abs() < 0.51, "{side}: {largest} {told}");
    }
    assert_eq!(counted["judged"], 2.0 * 37458.0);
    assert_eq!(counted["overlaps"], 2.0 * 23004.0);
    for key in ["memory", "no_shape", "threw", "contradicted"] {
        assert_eq!(counted[key], 0.0, "{key}");
    }
}

/// A kept case compiles by itself, shows libccd's fault again, and is answered right here.
#[test]
fn kept_cases_replay() {
    let dir = tempfile::tempdir().expect("a directory");
    let keep = dir.path().to_str().expect("a path");
    let (_, screen) = screen("plain", &["--every", "1", "--keep", keep]);
    let kept: Vec<_> = (1..=5).map(|i| dir.path().join(format!("libccd-{i}.c"))).filter(|path| path.exists()).collect();
    assert!(kept.len() >= 3, "{screen}");
    let left = std::fs::read_dir(dir.path()).expect("the directory").count();
    assert_eq!(left, kept.len(), "nothing else is left there");
    for path in &kept {
        assert!(screen.contains(path.to_str().expect("a path")), "{screen}");
        // libccd's header alone, and its own compiler's strictest words
        let case = Program::c("case").source(path).system_headers();
        let case = watchable(case.flag("-pedantic").flag("-Werror"));
        assert_eq!(case.run_to_end([""; 0]).0.code(), Some(1), "{path:?}");
        let right = case.swapped().run([""; 0]).stdout;
        assert!(right.contains(": right"), "{right}");
    }
    let library = harness::library(harness::Precision::Double);
    let mut replay = Command::new("sh");
    replay.arg(root().join("c-tests/replay.sh"));
    replay.arg("--library").arg(library.dir.join("libccd.so"));
    let said = harness::must_succeed(replay.arg(&kept[0]), "replay.sh").stdout;
    assert!(said.contains("== libccd: ") && said.contains("== this library"), "{said}");
}
