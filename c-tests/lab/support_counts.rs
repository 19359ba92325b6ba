// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests of what is measured exactly: support counts and errors that no later change may
//! lose, and the DEEP baseline.

#![cfg(not(feature = "single"))]

#[path = "../harness/mod.rs"]
mod harness;
#[path = "mod.rs"]
mod lab;

use lab::csv;
use lab::deep::{Deep, Polytope};
use lab::libraries::Libraries;
use lab::measure;
use lab::methods::Start;
use lab::recorded::{self, Recorded};
use lab::scene::Scene;
use nalgebra::Vector3;

type V = Vector3<f64>;

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
            (&h.set, &h.method, &h.start) == (&now.set, &now.method, &now.start)
                && Some(h.tolerance) == now.tolerance
        });
        let then = then.unwrap_or_else(|| panic!("not recorded: {} {}", now.set, now.method));
        // Counts and errors repeat exactly; the slack is for another compiler's rounding
        // and for a valley more or less: one pose in 500 is 0.2 percent.
        let more = now.supports.is_none_or(|s| s > then.supports * 1.02 + 0.05)
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

/// DEEP's answers are planes that support D and that none a little beside is nearer than, never below
/// the certified least; from the true normal they are that, and nearly always from 5° beside it.
#[test]
fn deep_walks_to_local_minima() {
    let libraries = Libraries::open();
    for (name, poses) in [("box_box", 60), ("p12_p12", 60), ("p42_p42", 60)] {
        let scene = Scene::load(&libraries, name, poses);
        let [a, b] = [0, 1].map(|k| Polytope::new(&scene.meshes[k]));
        let (mut deep, mut global) = (Deep::default(), 0);
        for pair in &scene.pairs {
            let ((ra, pa), (rb, pb)) = (pair.pose(&libraries, 0), pair.pose(&libraries, 1));
            let (turn, shift) = (ra.transpose() * rb, ra.transpose() * (pb - pa));
            let truth = V::from(pair.truth.normal);
            let mut walk = |from: [f64; 3]| {
                let walked = deep.penetration(&a, &b, turn, shift, ra.transpose() * V::from(from));
                let (depth, n) = walked.expect("a start that has hubs");
                (depth, ra * n)
            };
            let h = |n: V| measure::support_value(&libraries, pair, &n.normalize().into());
            let least = pair.truth.depth;
            let guess = |start: Start| start.direction(&pair.truth).expect("a guess");
            let [five, twenty_five, forty_five] = Start::GUESSES.map(guess);
            let found = [truth.into(), five, twenty_five, forty_five].map(&mut walk);
            for (depth, n) in found {
                assert!((h(n) - depth).abs() < 1e-12, "{name}: {depth}, {}", h(n));
                assert!(depth >= least - 1e-12, "{name}: {depth} below {least}");
                // To each neighbour of the middle of a cube of 27.
                for k in (0..27_i32).filter(|k| *k != 13) {
                    let to = [k % 3, k / 3 % 3, k / 9].map(|x| f64::from(x - 1));
                    let beside = h(n + 1e-4 * V::from(to));
                    assert!(beside >= depth - 1e-12, "{name}: not a local minimum");
                }
            }
            let [(depth, n), (from_five, _), ..] = found;
            assert!((depth - least).abs() < 1e-12, "{name}: {depth}, {least}");
            assert!((n - truth).norm() < 1e-6, "{name}");
            global += usize::from(from_five < least + 1e-12);
        }
        assert!(
            global * 100 >= scene.pairs.len() * 95,
            "{name}: {global} global from 5°"
        );
    }
}
