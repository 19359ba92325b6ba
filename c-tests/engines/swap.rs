// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The swap: programs linked to Debian's FCL and ODE run on this library as they run on libccd. MuJoCo, DART and
//! longer scenes: `c-tests/lab/engines`.

#[path = "programs.rs"]
mod programs;

#[path = "results.rs"]
mod results;

use crate::harness::{Link, Precision, library};
use programs::{Method, Output, compared, fcl_distance, program, run_all, with_fcl_preload};

fn assert_right(outputs: &[Output; 2]) {
    let failures = results::collide_failures(outputs);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(outputs[1].value("counted.judged") > 1000.0, "{}", outputs[1].text);
    assert!(outputs[0].value("own.deep") > 100.0, "libccd is right too: {}", outputs[0].text);
}

#[test]
fn fcl_collide() {
    assert_right(&run_all(&compared(program("fcl_static.cpp"), "1"), "1 20"));
}

/// A library loaded before a program takes the place of its libccd under any name, as of that in python-fcl's wheel
/// (`lab/engines/simulations.rs`).
#[test]
fn preloading_replaces_libccd() {
    let on_libccd = program("fcl_static.cpp").link(Link::System).build();
    let built = library(Precision::Double).dir.join("libccd.so");
    // Panics unless the program runs on this library.
    let output = Method::ours("preloaded", on_libccd).preload(built).run("1 2");
    assert!(output.value("poses.queried") > 1000.0, "{}", output.text);
}

/// With `libwarmccd-fcl.so` FCL answers every configuration, touching boxes, random pairs and spheres beside capsules right,
/// with witness points |distance| apart, and throws nothing. On libccd and in more pairs: `lab/engines/simulations.rs`.
#[test]
fn fcl_signed_distance() {
    let [_, _, preloaded] = fcl_distance();
    let output = preloaded.run("300");
    assert!(output.text.contains("\nfunction libwarmccd-fcl.so\n"), "{}", output.text);
    for set in ["configurations", "kissing", "random", "round"] {
        assert!(output.value(&format!("{set}.queries")) >= 90.0, "{}", output.text);
        for key in ["threw", "endless", "wrong", "outside", "unequal"] {
            // Where the bounds have not met, the depth is more than the distance of the witness points.
            let allowed = if (set, key) == ("configurations", "unequal") { 10.0 } else { 0.0 };
            assert!(output.value(&format!("{set}.{key}")) <= allowed, "{set} {key}: {}", output.text);
        }
    }
}

/// With it FCL's conservative advancement finds every impact, on libccd and on this library alone all but a few; and the witness
/// points of boxes that nearly touch are |distance| apart along the normal.
#[test]
fn fcl_continuous_collision() {
    let outputs = run_all(&with_fcl_preload(program("fcl_continuous.cpp")), "800");
    let [theirs, ours, preloaded] = outputs.each_ref().map(|output| output.sum("head_on.missed turned.missed"));
    assert!(0.0 < theirs && ours <= theirs && preloaded == 0.0, "{theirs}, {ours}, {preloaded}");
    let wrong = outputs[2].nonzero("near.threw near.unequal near.aside");
    assert!(wrong.is_empty() && outputs[0].value("near.aside") > 100.0, "{}", wrong.join("\n"));
}

#[test]
fn ode_collide() {
    assert_right(&run_all(&compared(program("ode_static.c"), "1"), "1 60"));
}

/// Towers on the one contact a pair that ODE takes from libccd, and a tower whose hulls just touch.
#[test]
fn towers_on_one_contact_a_pair() {
    let [_, ours] = compared(program("ode_pile.c"), "1");
    for arguments in ["1 1500 20 stack", "1 1500 6 tower"] {
        let failures = results::pile_failures(&[ours.run(arguments)], 1.0, 5e-3);
        assert!(failures.is_empty(), "{arguments}: {}", failures.join("\n"));
    }
}
