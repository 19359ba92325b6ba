// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests what is measured exactly: support counts and errors that no later change may lose.

#![cfg(not(feature = "single"))]

#[path = "../../harness/mod.rs"]
mod harness;
#[path = "mod.rs"]
mod measuring;

use measuring::csv;
use measuring::deep::{self, Polytope};
use measuring::libraries::Libraries;
use measuring::measure;
use measuring::methods::Start;
use measuring::recorded::{self, Recorded};
use measuring::scene::Scene;

/// No set needs more supports, or errs more, than `support_counts.csv` says.
/// `cargo bench -p charts -- record` writes the file anew.
#[test]
fn no_set_needs_more_supports_or_errs_more() {
    let libraries = Libraries::open();
    let recorded: Vec<Recorded> = csv::read(&recorded::file());
    assert!(recorded.len() > 50, "{} lines recorded", recorded.len());
    let mut lost = Vec::new();
    for now in recorded::measure(&libraries) {
        let then = recorded.iter().find(|h| {
            (&h.set, &h.method, &h.start) == (&now.set, &now.method, &now.start) && Some(h.tolerance) == now.tolerance
        });
        let then = then.unwrap_or_else(|| panic!("not recorded: {} {}", now.set, now.method));
        // Counts and errors repeat exactly; the slack is for another compiler's rounding
        // and for a valley more or less: one pose in 500 is 0.2 percent.
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

/// DEEP's depths are those of planes that support D, never below the certified least, and from 5°
/// nearly always the least.
#[test]
fn deep_walks_to_local_minima() {
    let libraries = Libraries::open();
    for name in ["p12_p12", "p42_p42", "p162_p162"] {
        let scene = Scene::load(&libraries, name, 200);
        let meshes = Polytope::of_set(name).expect("two polytopes");
        for method in &mut deep::methods(&libraries, &meshes, Start::Five) {
            let row = measure::judge(&libraries, &scene, method);
            assert!(row.unsound < 1e-12 && row.missed == 0.0, "{row:?}");
            assert!(row.shallow == 0.0 && row.nonminimal < 5.0, "{row:?}");
        }
    }
}
