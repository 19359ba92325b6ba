// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where penetration methods fail: configurations, categories of pairs, continuity,
//! termination, memory, determinism. The work is done by C programs, as the
//! library's users write them; here they are built and run.

#[path = "../harness/mod.rs"]
mod harness;

use harness::{Executable, Precision, Program};

const NO_ARGS: [&str; 0] = [];

/// A program of this directory that holds this library alone.
fn alone(name: &str) -> Executable {
    source(name).flag("-DOURS_ALONE").link_ours_static().build()
}

/// A program of this directory that holds this library, and in double precision
/// system libccd beside it.
fn program(name: &str) -> Executable {
    match Precision::CURRENT {
        Precision::Double => source(name).link_ours_renamed_and_system().build(),
        Precision::Single => alone(name),
    }
}

fn source(name: &str) -> Program {
    strict(name).source(format!("stability/{name}.c"))
}

fn strict(name: &str) -> Program {
    Program::c(name).flag("-pedantic").flag("-Werror")
}

/// Every pair set under c-tests/pairs.
#[cfg(not(feature = "single"))]
fn pair_sets() -> Vec<String> {
    let dir = harness::root().join("c-tests/pairs");
    let mut sets: Vec<String> = std::fs::read_dir(&dir)
        .unwrap_or_else(|e| panic!("{}: {e}", dir.display()))
        .map(|entry| entry.expect("a directory entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "bin"))
        .map(|path| path.display().to_string())
        .collect();
    sets.sort();
    assert!(!sets.is_empty());
    sets
}

/// The judge itself.
#[test]
#[cfg(not(feature = "single"))]
fn truth_agrees_with_itself_and_the_certified_sets() {
    let mut args = vec!["2000".to_owned(), "25".to_owned()];
    args.extend(pair_sets());
    alone("truth").run(args);
}

/// T01 to T24 and the cases of other projects, on libccd's entry points, cold and warm.
#[test]
fn configurations() {
    program("configurations").run(["compatible"]);
}

/// The same on the extension's own.
#[test]
fn configurations_of_the_extension() {
    program("configurations").run(["proven"]);
}

/// The same on the local query.
#[test]
#[cfg_attr(feature = "single", ignore = "witness points of the local query")]
fn configurations_of_the_local_query() {
    program("configurations").run(["local"]);
}

/// Wrong answers that were found, as promises. A known failure that is repaired fails this
/// too: take its mark out of the table at the program's end.
#[test]
#[cfg(not(feature = "single"))]
fn known_failures() {
    program("failures").run(NO_ARGS);
}

/// What a query may cost in support points and stack, in the same way.
#[test]
#[cfg(not(feature = "single"))]
fn known_costs() {
    program("costs").run(NO_ARGS);
}

/// The slowest query of a million: prints a table, fails if one is too slow.
#[test]
#[ignore = "takes minutes"]
#[cfg(not(feature = "single"))]
fn slowest_of_a_million() {
    let status = program("costs")
        .command()
        .args(["--mix", "1000000"])
        .status();
    assert!(status.is_ok_and(|s| s.success()));
}

/// T25, and the planar query.
#[test]
fn wrong_starts() {
    alone("starts").run(["1500"]);
}

/// A sample of every category of pairs, both tie rules, on libccd's entry points, cold
/// and warm.
#[test]
fn categories() {
    let campaign = program("campaign");
    campaign.run(["100", "0", "-1", "compatible"]);
    campaign.run(["100", "1", "-1", "compatible"]);
}

/// The proven minimum against the exact one, on a sample of every kind of pair.
#[test]
fn exact_minima() {
    alone("exact").run(["300"]);
}

/// Every call on bodies that are hard for one method or another, judged in 128 bits: a
/// sample of every row. Other processors than x86 have no such numbers, or by another name.
#[test]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn judged_in_128_bits() {
    wide().run([harness::rounds(60)]);
}

/// The same, a thousand pairs a row: `cargo test --test stability -- --ignored --nocapture
/// wide_campaign`. Three minutes; more, of one row, from another pair or another seed with
/// `WIDE_PAIRS`, `WIDE_ROW`, `WIDE_FIRST` and `WIDE_SEED`, the program's arguments.
#[test]
#[ignore = "takes minutes; prints tables"]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn wide_campaign() {
    let args = [
        ("WIDE_PAIRS", "1000"),
        ("WIDE_ROW", "-1"),
        ("WIDE_FIRST", "0"),
        ("WIDE_SEED", "1"),
    ]
    .map(|(name, value)| std::env::var(name).unwrap_or(value.to_owned()));
    let status = wide().command().args(args).status();
    assert!(status.is_ok_and(|s| s.success()));
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn wide() -> Executable {
    strict("wide")
        .source("stability/wide/wide.c")
        .flag("-DOURS_ALONE")
        .link_ours_static()
        .build()
}

/// The table of 100,000 pairs a kind, with its progress:
/// `cargo test --test stability -- --ignored --nocapture exact_campaign`. Three quarters of
/// an hour; in parts with `EXACT_PAIRS`, `EXACT_FIRST` and `EXACT_KIND`, the program's
/// arguments.
#[test]
#[ignore = "takes three quarters of an hour; prints a table"]
fn exact_campaign() {
    let or = |name: &str, value: &str| std::env::var(name).unwrap_or(value.to_owned());
    let args = [
        or("EXACT_PAIRS", "100000"),
        or("EXACT_FIRST", "0"),
        or("EXACT_KIND", "-1"),
    ];
    let status = alone("exact").command().args(args).status();
    assert!(status.is_ok_and(|s| s.success()));
}

/// The same on the extension's own.
#[test]
fn categories_of_the_extension() {
    let campaign = program("campaign");
    campaign.run(["100", "0", "-1", "proven"]);
    campaign.run(["100", "1", "-1", "proven"]);
}

/// The same on the local query.
#[test]
fn categories_of_the_local_query() {
    let campaign = program("campaign");
    campaign.run(["100", "0", "-1", "local"]);
    campaign.run(["100", "1", "-1", "local"]);
}

/// Both libraries in one process, against each other and the truth.
#[test]
#[cfg(not(feature = "single"))]
fn no_answer_worse_than_libccd() {
    program("beside_libccd").run(["60"]);
}

/// Swapped, rotated, translated, scaled.
#[test]
fn metamorphic() {
    alone("metamorphic").run(["2000"]);
}

/// Sliding, rolling, rocking: directions and depths.
#[test]
fn continuity() {
    program("continuity").run(["motion"]);
}

/// The same: contact positions, and the bare local method.
#[test]
fn continuity_of_positions() {
    let continuity = program("continuity");
    continuity.run(["position"]);
    continuity.run(["local"]);
}

/// Support functions that no convex shape has.
#[test]
fn adversarial_callbacks() {
    alone("adversary").run(["4", "1"]);
}

/// Tolerances, limits, outputs and shapes at and over the edge of what is allowed.
#[test]
fn bad_input() {
    alone("input").run(NO_ARGS);
}

fn determinism_program() -> Executable {
    source("determinism")
        .standard("c11")
        .flag("-DOURS_ALONE")
        .flag("-pthread")
        .link_ours_shared()
        .build()
}

/// What cross.sh compares between processors.
#[test]
#[ignore = "prints a list"]
fn determinism_listed() {
    determinism_program().run(["150", "list"]);
}

/// Same bits in threads, in two runs, and in the debug and release builds.
#[test]
fn determinism() {
    let program = determinism_program();
    let first = program.run(["12"]).stdout;
    assert_eq!(first, program.run(["12"]).stdout, "two runs differ");

    // This test's own build of the library: the debug one in an ordinary test run.
    let test = std::env::current_exe().expect("the test's own path");
    let library = test.with_file_name("libccd.so");
    assert!(library.exists(), "no {}", library.display());
    let dir = harness::output_dir().join(format!("as-tested-{}", Precision::CURRENT.name()));
    std::fs::create_dir_all(&dir).expect("a directory for the library");
    std::fs::copy(&library, dir.join("libccd.so.2")).expect("a copy of the library");
    let (status, written) = harness::run_command(
        program.command().arg("12").env("LD_LIBRARY_PATH", &dir),
        std::time::Duration::from_secs(120),
    );
    assert!(status.success(), "{}", written.stderr);
    assert_eq!(first, written.stdout, "builds differ");
}

/// Every category of pairs, 2,000 pairs each, both tie rules, on system libccd and
/// on this library: `cargo test --test stability -- --ignored --nocapture campaign`.
#[test]
#[ignore = "takes minutes; prints the rate tables"]
fn campaign() {
    let campaign = program("campaign");
    for tie in ["0", "1"] {
        campaign.run(["2000", tie]);
    }
}

/// A longer look at what the test run samples:
/// `cargo test --test stability -- --ignored --nocapture long`.
#[test]
#[ignore = "takes minutes"]
fn long() {
    alone("metamorphic").run(["20000"]);
    let adversary = alone("adversary");
    for seed in 2..12 {
        adversary.run(["40".to_owned(), seed.to_string()]);
    }
    #[cfg(not(feature = "single"))]
    {
        program("beside_libccd").run(["1000"]);
        let mut args = vec!["100000".to_owned(), "1".to_owned()];
        args.extend(pair_sets());
        alone("truth").run(args);
    }
}

/// The ledger of differences: where libccd is wrong among the configurations.
/// `cargo test --test stability -- --ignored --nocapture ledger`.
#[test]
#[ignore = "prints a table"]
#[cfg(not(feature = "single"))]
fn ledger() {
    program("configurations").run_to_end(["--ledger"]);
}
