// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What memory is worth: contacts that roll and slide by growing steps a frame, and
//! the recorded contact sequence of a simulation.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::figure::{self, Curve, Panel, Unit as AxisUnit};
use super::{Bench, COUNTED, Page, SUPPORTS, TIME, TIMED};
use crate::lab::libraries::Truth;
use crate::lab::measure::Row;
use crate::lab::methods::{self, Ask, Start};
use crate::lab::scene::{Form, Pose, Scene};
use crate::poses::{Oracle, direction, rotation};
use crate::progress;

const STEPS: [f64; 8] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0];
const FRAMES: usize = 50;
/// Depth of every frame, metres.
const DEPTH: f64 = 0.01;

/// Pairs that are moved, by the names of the pair sets.
fn kinds(bench: &Bench) -> Vec<(&'static str, [Form; 2])> {
    let cuboid = || Form::solid(2, [0.5, 0.4, 0.3]);
    let cylinder = || Form::solid(3, [0.5, 0.5, 0.0]);
    let ellipsoid = || Form::solid(5, [0.5, 0.35, 0.25]);
    let capsule = || Form::capsule(0.5, 0.5);
    let mesh = Scene::load(bench.libraries, "p162_p162", 1).meshes[0].clone();
    let hull = || Form::polytope(mesh.clone());
    vec![
        ("box_box", [cuboid(), cuboid()]),
        ("p162_p162", [hull(), hull()]),
        ("cyl_box", [cylinder(), cuboid()]),
        ("p162_cap", [hull(), capsule()]),
        ("cap_cap", [capsule(), capsule()]),
        ("ell_ell", [ellipsoid(), ellipsoid()]),
    ]
}

/// `motions` motions in which the second shape turns by `step` degrees a frame about
/// an axis of its own and slides along the first by 2 mm a degree, 1 cm deep all the
/// while: after each step it is moved along the normal until it is. Then that normal
/// stays the global minimum, so the truth is known as well as the oracle proves it.
fn motion(bench: &Bench, name: &str, forms: [&Form; 2], step: f64, motions: usize) -> Scene {
    let mut rng = Pcg64::seed_from_u64(7);
    let oracle = Oracle::new(bench.libraries, forms);
    let mut poses = Vec::new();
    for _ in 0..motions {
        let turn = UnitQuaternion::from_axis_angle(
            &Unit::new_normalize(direction(&mut rng)),
            step.to_radians(),
        );
        let drift = direction(&mut rng) * (2e-3 * step);
        let still = Pose {
            position: Vector3::zeros(),
            rotation: rotation(&mut rng),
        };
        let mut moving = Pose {
            position: direction(&mut rng) * 0.2,
            rotation: rotation(&mut rng),
        };
        let mut normal = Vector3::zeros();
        for _ in 0..FRAMES {
            moving.rotation = turn * moving.rotation;
            moving.position += drift - normal * normal.dot(&drift);
            let found = loop {
                match oracle.depth(&[still, moving]) {
                    Some(found) => break found,
                    // Apart: nearer to the first shape's centre.
                    None => moving.position *= 0.9,
                }
            };
            normal = found.normal;
            moving.position += normal * (found.depth - DEPTH);
            let towards = normal.into();
            let truth = Truth {
                depth: DEPTH,
                gap: found.gap,
                normal: towards,
                init5: towards,
                init25: towards,
                init45: towards,
                cold: (moving.position - still.position).normalize().into(),
            };
            poses.push(([still, moving], truth));
        }
    }
    Scene::placed(bench.libraries, name, forms, &poses, FRAMES)
}

pub fn measure(bench: &Bench) -> Vec<Row> {
    let kinds = kinds(bench);
    let steps: &[f64] = if bench.quick {
        &[0.1, 1.0, 10.0]
    } else {
        &STEPS
    };
    let motions = if bench.quick { 3 } else { 10 };
    let mut all = Vec::new();
    for (name, forms) in progress::over(&kinds, "coherence") {
        for &step in steps {
            let scene = motion(bench, name, [&forms[0], &forms[1]], step, motions);
            all.extend(super::rows(bench, &scene, roster(bench), Some(step)));
        }
    }
    all
}

fn roster<'a>(bench: &Bench<'a>) -> Vec<methods::Method<'a>> {
    let asked = [
        (Ask::SystemMpr, Start::None),
        (Ask::SystemEpa, Start::None),
        (Ask::Paper, Start::Warm),
        (Ask::Mpr, Start::None),
        (Ask::MprWarm, Start::Warm),
        (Ask::Local, Start::Centres),
        (Ask::Local, Start::Warm),
        (Ask::Minimum, Start::None),
        (Ask::Minimum, Start::Warm),
    ];
    let of = |(ask, start)| methods::of(bench.libraries, ask, start, 1e-6);
    asked.map(of).into()
}

/// The step, degrees a frame, from which a warm query of this kind costs as many
/// supports as a cold one; none when it never does.
pub fn stops_paying(rows: &[Row], set: &str, method: &str) -> Option<f64> {
    let cold = if method == "local" { "centres" } else { "" };
    let of = |start: &str, x: f64| {
        rows.iter()
            .find(|r| r.set == set && r.method == method && r.start == start && r.x == Some(x))
    };
    let mut steps = rows
        .iter()
        .filter(|r| r.set == set && r.method == method && r.start == "warm");
    steps.find_map(|warm| {
        let x = warm.x?;
        (warm.supports >= of(cold, x)?.supports).then_some(x)
    })
}

/// Ours without a state as dashes, beside the same query with one.
fn cold_dashed(mut curves: Vec<Curve>) -> Vec<Curve> {
    for curve in &mut curves {
        curve.look.dashed = curve.look.bold && !curve.label.ends_with("warm");
    }
    curves
}

pub fn draw(page: &Page, all: &[Row]) {
    for (file, y, cost) in [
        ("coherence_supports.svg", SUPPORTS, COUNTED),
        ("coherence_time.svg", TIME, TIMED),
    ] {
        let panel = |set: &str| {
            let curves = super::curves(all.iter().filter(|r| r.set == set), |r| r.x, cost);
            let x = ("motion per frame", AxisUnit::Degrees);
            Panel::new(&super::kind(set), x, y, cold_dashed(curves))
        };
        let panels: Vec<Panel> = super::sets(all).into_iter().map(panel).collect();
        let title = "Cost of a query of a contact that moves, 1 cm deep";
        figure::grid(&page.file(file), title, 3, &panels, &[page.footer()]);
    }
}

/// The recorded contact sequence: queries in the order of their pair's frames.
pub fn recorded(bench: &Bench) -> Vec<Row> {
    let scene = Scene::recorded(bench.libraries, if bench.quick { 40 } else { usize::MAX });
    super::rows(bench, &scene, roster(bench), None)
}
