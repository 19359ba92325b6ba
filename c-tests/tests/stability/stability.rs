// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where penetration methods fail: configurations, categories of pairs, continuity,
//! termination, memory, determinism. The work is done by C programs, as the
//! library's users write them; here they are built and run. Longer runs of the same
//! programs are `campaigns.rs`.

#[path = "../../harness/mod.rs"]
mod harness;

mod programs;

use harness::Precision;
#[cfg(not(feature = "single"))]
use programs::alone;
#[cfg(not(feature = "single"))]
use programs::pair_sets;
use programs::program;

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
fn configurations_of_the_local_query() {
    program("configurations").run(["local"]);
}

/// What a query may cost in support points and stack. A broken promise that is repaired fails this
/// too: take its mark out of the table at the program's end.
#[test]
fn known_costs() {
    let costs = program("costs");
    match Precision::CURRENT {
        Precision::Double => costs.run([""; 0]),
        Precision::Single => costs.run(["U14"]),
    };
}

/// The table of costs at worst, of few queries: no call of this library takes a thousand callbacks.
#[test]
fn worst_case() {
    let table = program("worst_case").run(["2000"]).stdout;
    let ours = table.lines().filter(|line| line.starts_with("| `ccd"));
    let most = ours.map(|line| line.split('|').nth(4).map(|cell| cell.trim().parse::<u32>()));
    let most: Vec<u32> = most.map(|n| n.expect("a cell").expect("a number")).collect();
    assert!(most.len() == 7 && most.iter().all(|n| (1..1000).contains(n)), "{table}");
}

/// A sample of every category of pairs, both tie rules.
fn sample(pairs: &str, group: &str) {
    program("campaign").run([pairs, "-1", group]);
}

/// On libccd's entry points, cold and warm.
#[test]
fn categories() {
    sample("300", "compatible");
}

#[test]
fn categories_of_the_extension() {
    sample("100", "proven");
}

#[test]
fn categories_of_the_local_query() {
    sample("100", "local");
}

/// Every call on bodies that are hard for one method or another, judged in 128 bits: a
/// sample of every row. Other processors than x86 have no such numbers, or by another name.
#[test]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn judged_in_128_bits() {
    programs::wide().run([harness::rounds(60)]);
}

/// Sliding, rolling, rocking: directions, depths and contact positions.
#[test]
fn continuity() {
    program("continuity").run([""; 0]);
}

/// Same bits in two runs, and in the debug and release builds.
#[test]
fn determinism() {
    let program = programs::determinism();
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
