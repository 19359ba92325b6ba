// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where penetration methods fail: configurations, categories of pairs, continuity,
//! termination, memory, determinism. The tests build and run C programs, as the library's
//! users write them; `c-tests/lab/campaigns.rs` runs the same programs for longer.

mod programs;

use crate::harness::{self, Precision};
use programs::program;

run_programs! {
    /// T01 to U15 and the cases of other projects, on every call, cold and warm.
    configurations: program("judged"), ["configurations"];
    /// Random pairs of every category, both tie rules.
    categories: program("judged"), ["categories", "300"];
    /// A sample of every row of bodies that are hard for one method or another.
    hard_bodies: program("judged"), ["hard", &harness::rounds(60)];
    /// Support points and stack of queries.
    known_costs: program("costs"), if cfg!(feature = "single") { &["U14", "U16"][..] } else { &[] };
    /// The callback that is wrong along the normals of its caps. (Single precision has no tilt.)
    #[cfg(not(feature = "single"))]
    ode_cylinder: programs::source("ode_cylinder").flag("-DOURS_ALONE").link(harness::Link::Static), [""; 0];
    /// Errors and jitter of directions. (In single precision a proof to 1e-11 m has no meaning.)
    #[cfg(not(feature = "single"))]
    directions: programs::source("directions").flag("-DOURS_ALONE").link(harness::Link::Static), [""; 0];
    /// Sliding, rolling, rocking: directions, depths and contact positions.
    continuity: program("continuity"), [""; 0];
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
