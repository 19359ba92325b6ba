// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! FCL and python-fcl's wheel on libccd and on this library, and what `<ccd/fcl.hpp>` costs. (Whole simulations are judged
//! where their table is made: `cargo run --release -p lab --bin engines -- long`.)

use crate::engines::programs::{fcl_distance, on_both, preload_library, program, run_all};
use crate::engines::{consumers, tables};
use crate::measuring::callgrind;

/// This library changes nothing about FCL's own signed distance; with `libwarmccd-fcl.so` FCL answers every
/// configuration, touching boxes and random pairs right, and throws nothing.
#[test]
fn fcl_signed_distance() {
    let outputs = run_all(&fcl_distance(), "1000");
    let function = outputs.each_ref().map(|o| o.text.lines().find_map(|line| line.strip_prefix("function ")));
    let [Some(on_libccd), Some(on_ours), Some("libwarmccd-fcl.so")] = function else { panic!("{function:?}") };
    assert!([on_libccd, on_ours].iter().all(|file| file.starts_with("libfcl.so")), "{function:?}");
    let [theirs, ours, preloaded] = outputs;
    for set in tables::DISTANCE_SETS {
        let all = |keys: &str| keys.split(' ').map(|key| format!("{set}.{key}")).collect::<Vec<_>>().join(" ");
        assert!(preloaded.value(&all("queries")) >= 100.0, "{set}");
        let failures = preloaded.nonzero(&all("threw endless wrong outside"));
        assert!(failures.is_empty(), "{set}: {failures:?}\n{}", preloaded.text);
        for key in ["threw", "endless", "wrong", "outside"].map(all) {
            assert!(ours.value(&key) <= theirs.value(&key), "{key}\n{}", ours.text);
        }
    }
}

/// MuJoCo's issue 420: no cylinder slides on this library, most do on libccd. `libwarmccd-middle.so`, whose `pos` is the middle
/// of the witness points, lets all of them slide: it is for programs that use no position.
#[test]
fn mujoco_cylinders_stay_by_the_center_of_pressure() {
    let [theirs, ours] = on_both(program("mujoco_slide.c"));
    let middle = ours.clone().named("the middle for pos").preload(preload_library("libwarmccd-middle.so"));
    let [theirs, ours, middle] = run_all(&[theirs, ours, middle], "40").map(|output| output.value("slide.slid"));
    assert!(
        ours == 0.0 && theirs > 30.0 && middle == 40.0,
        "slid: {ours}, on libccd {theirs}, with the middle {middle}"
    );
}

/// Discs that rock on a floor in ODE by one contact lose their rotation as by the center of pressure; on libccd they do not.
/// (As before commit d39bf724, when positions jumped by 15 mm on leaning discs, the means differ by 0.34 rad/s.)
#[test]
fn ode_discs_rock_as_by_the_center_of_pressure() {
    let [theirs, ours] = run_all(&on_both(program("ode_disc.c")), "");
    let off = [&theirs, &ours].map(|output| output.value("disc.off"));
    assert!(off[1] < 0.12 && off[0] > 0.2 && ours.value("disc.rocking") > 1.0, "{}\n{}", ours.text, theirs.text);
}

/// A preloaded library takes the place of the shared libccd that python-fcl's wheel carries. The depth is 0.1 m. With
/// `libwarmccd-fcl.so` the signed distances of boxes that touch are right, which end the process on the plain wheel, or never end.
#[test]
fn python_wheel_by_preloading() {
    match consumers::python_wheel() {
        Err(error) => println!("skipped: python-fcl does not install: {error}"),
        Ok(methods) => {
            let outputs = run_all(&methods, "");
            let [theirs, ours, _] = outputs.each_ref().map(|output| output.value("wheel.depth"));
            let signed = &outputs[2];
            assert!(signed.value("signed.queries") == 3000.0 && signed.value("signed.wrong") == 0.0, "{}", signed.text);
            assert!((0.1 - 1e-6..=0.1001 + 1e-6).contains(&ours) && theirs > 0.101, "{ours}, on libccd {theirs}");
        }
    }
}

/// No answer of this library is wrong behind FCL's narrow phase, in every use of the table. (`<ccd/fcl.hpp>`: `fcl.cpp`.)
#[test]
fn fcl_uses_judged() {
    for cost in tables::fcl_costs(0) {
        let [theirs, ours] = &cost.judged;
        assert!(ours.value("counted.judged") > 500.0 && theirs.value("own.hits") > 50.0, "{}: {}", cost.row, ours.text);
        let failures = ours.nonzero(tables::WRONG);
        assert!(failures.is_empty(), "{}: {failures:?}", cost.row);
    }
}

/// `<ccd/fcl.hpp>` spends little outside the library and the callbacks.
#[test]
fn fcl_header_costs_little() {
    let [_, _, header, _] = consumers::fcl_scene();
    let command = header.command("through primitives 60 200 1000");
    // Each toggle switches counting at entry and at exit.
    let instructions = |functions: &[&str]| {
        let toggles: Vec<_> = functions.iter().map(|name| format!("--toggle-collect={name}")).collect();
        let toggles: Vec<_> = toggles.iter().map(String::as_str).collect();
        let (_, dumps) = callgrind::run(&command, &toggles).unwrap_or_else(|error| panic!("{error}"));
        let totals = dumps.iter().flat_map(|dump| dump.lines()).filter_map(|line| line.strip_prefix("totals: "));
        totals.map(|n| n.parse::<f64>().expect("a count")).sum::<f64>()
    };
    let collide = "collide(scene_pair const&*";
    let all = instructions(&[collide]);
    let outside = instructions(&[collide, "ccdPenetration", "ccdIntersect", "ccdContacts", "ccdSignedDistance"]);
    assert!(all > 1e6 && outside > 0.0 && outside < 0.13 * all, "{outside} of {all} instructions");
}
