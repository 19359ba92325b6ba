// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests what is measured exactly: recorded support counts, errors, instructions and mispredicted branches, which no
//! change may exceed.

use crate::harness;
use crate::measuring::ledger::{self, Cost};
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::Runner;
use crate::measuring::methods::{Start, select};
use crate::measuring::recorded::{self, Recorded};
use crate::measuring::scene::Scene;
use crate::measuring::{callgrind, csv};

/// Compares every set with `support_counts.csv`, which `cargo bench -p lab -- record` writes anew.
#[test]
fn no_set_needs_more_supports_or_errs_more() {
    let libraries = Libraries::open();
    let (_, recorded): (_, Vec<Recorded>) = csv::read(&recorded::file());
    assert!(recorded.len() > 50, "{} lines recorded", recorded.len());
    let mut lost = Vec::new();
    for now in recorded::measure(&libraries) {
        let then = recorded.iter().find(|then| {
            (&then.set, &then.method, then.start, Some(then.tolerance))
                == (&now.set, &now.method, now.start, now.tolerance)
        });
        let then = then.unwrap_or_else(|| panic!("not recorded: {} {}", now.set, now.method));
        // Counts and errors repeat exactly; the slack is for another compiler's rounding, and for one local minimum more
        // or less: one pose in 500 is 0.2 percent.
        let more = now.supports > then.supports * 1.02 + 0.05
            || now.mean_error_1mm > then.mean_error_1mm * 1.5 + 1e-7
            || now.nonminimal > then.nonminimal + 0.61
            || now.missed > 0.0
            || now.shallow > 0.0
            || now.unsound > 1e-12;
        if more {
            lost.push(format!("then {then:?}\nnow  {now:?}"));
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

/// Tests that the state of the frame before costs no support points, in motions of 0.1°, 0.5° and 2° a frame.
#[test]
fn no_state_costs_support_points() {
    const METHODS: [(&str, &str); 2] =
        [("ccdMPRPenetration", "ccdMPRPenetrationWarm"), ("ccdPenetrationProven", "ccdPenetrationProven")];
    let libraries = Libraries::open();
    let mut dearer = Vec::new();
    for small in recorded::MOTIONS {
        let pair = small.strip_suffix('S').expect("a motion of 0.1°");
        for step in ["S", "M", "L"] {
            let scene = Scene::load(&libraries, &format!("{pair}{step}"), usize::MAX);
            for (cold, warm) in METHODS {
                let list = [(cold, Start::None, 1e-6), (warm, Start::Warm, 1e-6)];
                let rows = Runner::new(&libraries).rows(&scene, select(&libraries, &list));
                let [cold, warm] = [&rows[0], &rows[1]].map(|row| row.supports);
                // Measured: at most 1.02 times as many, of boxes that are proven.
                if warm > 1.02 * cold + 0.05 {
                    dearer.push(format!("{pair}{step}, {}: cold {cold}, warm {warm}", rows[1].method));
                }
            }
        }
    }
    assert!(dearer.is_empty(), "{}", dearer.join("\n"));
}

/// Compares every cost with `instruction_counts.csv`, which the same command writes anew. Another toolchain has other
/// counts: there differences are printed.
#[test]
fn no_query_takes_more_instructions() {
    if !harness::installed("valgrind") || harness::emulated() {
        println!("skipped: valgrind is not installed, or not for this processor");
        return;
    }
    let libraries = Libraries::open();
    let command = ["--exact", "support_counts::no_query_takes_more_instructions", "--test-threads=1"];
    let rows = ledger::measure(&libraries, &command, false).unwrap_or_else(|why| panic!("not counted: {why}"));
    if callgrind::is_counting() {
        return;
    }
    let (toolchain, recorded): (_, Vec<Cost>) = csv::read(&ledger::file());
    let mut raised = Vec::new();
    for now in &rows {
        let then = now.find(&recorded);
        let then = then.unwrap_or_else(|| panic!("not recorded: {} {}", now.set, now.method));
        let line = now.beside(then);
        if now != then {
            println!("{line}");
        }
        if now.is_above(then) {
            raised.push(line);
        }
    }
    if toolchain == libraries.toolchain {
        assert!(raised.is_empty(), "{}", raised.join("\n"));
    } else {
        println!("not judged: recorded with\n{toolchain}\nhere\n{}", libraries.toolchain);
    }
}
