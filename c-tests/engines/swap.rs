// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The swap: programs linked to Debian's FCL, ODE, MuJoCo and DART run on this
//! library as they run on libccd. The table of `cargo run --release --example swap`
//! is made by the same checks.

// Debian's programs are compiled for double.
#![cfg(not(feature = "single"))]

#[path = "../harness/mod.rs"]
mod harness;

#[path = "checks.rs"]
mod checks;

#[path = "fcl_scene.rs"]
mod fcl_scene;

#[path = "fcl_distance.rs"]
mod fcl_distance;

#[path = "wheel.rs"]
mod wheel;

use checks::Piles;

fn piles_must_pass(p: &Piles) {
    let against = p.against.join("\n");
    assert!(against.is_empty(), "{} {}:\n{against}", p.consumer, p.scene);
}

/// To 7 mm, as `pos` itself (`tests/extension/pressure.c`); a point contact is where libccd has it.
#[test]
fn fcl_positions_are_the_centre_of_pressure() {
    let all = checks::fcl_positions();
    assert_eq!(all.len(), 6);
    for (kind, [theirs, ours]) in all {
        assert!(ours <= 0.007, "{kind}: {ours} m, libccd's {theirs}");
        assert!(ours <= 0.1 * theirs || ours <= 1e-4, "{kind}: {ours}");
    }
}

fn collide_must_pass(what: &'static str, said: &[String]) -> f64 {
    let s = checks::judge_collide(what, said);
    assert!(s.collide[1]["queries"] > 1000.0, "too few queries: {s:?}");
    assert!(s.against.is_empty(), "{what}:\n{}", s.against.join("\n"));
    s.astray[1]["queries"]
}

#[test]
fn fcl_collide_and_signed_distance() {
    let lines = checks::fcl_static().run("1 20");
    collide_must_pass("FCL", &lines);
    let (distances, _, [theirs, ours], against) = checks::judge_distances(&lines);
    assert!(distances > 1000 && ours <= theirs, "{distances}, {ours}");
    assert!(against.is_empty(), "{}", against.join("\n"));
}

/// With `libwarmccd-fcl.so` FCL answers every configuration, touching boxes and random pairs right,
/// and throws nothing; without it, it takes its own function.
#[test]
fn fcl_signed_distance_by_preloading() {
    let (own, preloaded) = fcl_distance::preloaded_distances(1000);
    assert!(own.iter().all(|file| file.starts_with("libfcl.so")), "{own:?}");
    assert_eq!(preloaded.function, "libwarmccd-fcl.so");
    for (set, counts) in fcl_distance::SETS.iter().zip(&preloaded.sets) {
        assert!(counts["queries"] >= 100.0, "{set}: {counts:?}");
        let bad = ["threw", "endless", "wrong", "outside"];
        let bad = bad.iter().any(|key| counts[*key] != 0.0);
        assert!(!bad, "{set}:\n{}", preloaded.wrong.join("\n"));
    }
}

/// A preloaded library takes the place of the shared libccd that python-fcl's wheel carries.
#[test]
fn python_wheel_by_preloading() {
    match wheel::wheels(1000) {
        Err(said) => println!("skipped: python-fcl does not install: {said}"),
        Ok([theirs, ours]) => {
            assert!(ours["missed"] == 0.0 && ours["deep"] == 0.0, "{ours:?}");
            assert!(theirs["deep"] > 0.0, "nothing to mend: {theirs:?}");
        }
    }
}

#[test]
fn ode_collide() {
    let ode = checks::ode_static();
    let astray =
        ["asis", "corrected"].map(|callbacks| collide_must_pass("ODE", &ode.run(&format!("1 60 {callbacks}"))));
    assert!(astray[0] > 0.0 && astray[1] == 0.0, "{astray:?}");
}

#[test]
fn ode_pile() {
    let program = checks::ode_pile().theirs_unjudged();
    piles_must_pass(&checks::piles(&program, "pile", 10, 1500, "32 pile"));
}

#[test]
fn mujoco_pile() {
    let program = checks::mujoco_pile().theirs_unjudged();
    piles_must_pass(&checks::piles(&program, "pile", 10, 1500, "30 pile"));
}

#[test]
fn dart_over_fcl_and_ode() {
    let program = checks::dart_pile().theirs_unjudged();
    for (scene, after) in [("fcl", "12 fcl"), ("ode", "12 ode")] {
        piles_must_pass(&checks::piles(&program, scene, 10, 800, after));
    }
}

/// Towers on several contacts a pair hold at least as well as on libccd's one.
#[test]
fn towers_stand() {
    piles_must_pass(&checks::worlds(checks::ode_pile().theirs_unjudged(), "stack", 10, 1500, 20));
}

/// Towers on the one contact a pair that ODE takes from libccd, and a tower whose hulls just touch.
#[test]
fn towers_stand_on_one_contact_a_pair() {
    let program = checks::ode_pile().theirs_unjudged();
    for (scene, after) in [("stack", "20 stack"), ("tower", "6 tower")] {
        let towers = checks::piles(&program, scene, 2, 3000, after);
        let against = towers.restless(1.0, 5e-3);
        assert!(against.is_empty(), "{scene}: {against:?}");
    }
}

/// A short run of the scene: this library misses nothing, and no depth is beyond its promise,
/// behind FCL's narrow phase and behind `<ccd/fcl.hpp>`.
#[test]
fn fcl_scene_with_a_state_a_pair() {
    let scenes = fcl_scene::scenes(12, 200, 20, 0);
    for scene in &scenes[1..] {
        assert!(scene.against().is_empty(), "{:?}", scene.against());
    }
    // It is the same scene for all, and one with something in it.
    for key in ["pairs", "hits", "exact"] {
        let [first, rest @ ..] = &scenes[..] else { unreachable!() };
        assert!(first.judged(key) > 100.0, "{key}: {}", first.judged(key));
        let same = |s: &fcl_scene::Scene| key == "hits" || s.judged(key) == first.judged(key);
        assert!(rest.iter().all(same), "{key}");
    }
}

/// `<ccd/fcl.hpp>` spends little outside the library and the callbacks.
#[test]
fn fcl_header_costs_little() {
    let costs = fcl_scene::header_costs(0);
    assert!(costs[0].share < 0.12, "{}", fcl_scene::header_table(&costs));
}
