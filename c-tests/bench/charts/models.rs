// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! No more model than a scene needs: one contact, its round body modelled as what
//! it is and as ever finer polytopes. More vertices make the model truer and the
//! query dearer; the primitive is both exact and cheap.

use nalgebra::Vector3;
use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::transformation::convex_hull;
use rand::SeedableRng;
use rand_pcg::Pcg64;

use serde::{Deserialize, Serialize};

use super::figure::{self, Look, Mark, Panel, Unit};
use super::paper::VERTICES;
use super::{Bench, Page, TIME};
use crate::lab::libraries::Truth;
use crate::lab::measure;
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::scene::{Form, Mesh, Pose, Scene};
use crate::poses::{self, Oracle};
use crate::progress;

/// One model of a body in contact with a capsule.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Model {
    /// What the body is.
    pub body: String,
    /// What it is modelled as.
    pub model: String,
    /// 0 for a primitive.
    pub vertices: usize,
    pub method: String,
    /// Mean |depth of the model - depth of the body|, metres.
    pub modelling_error: f64,
    /// Mean |answer - depth of the model|, metres.
    pub query_error: f64,
    pub supports: f64,
    pub ns: f64,
}

/// The hull of two copies of an icosphere, `half` up and down: a capsule's polytope.
fn stretched(mesh: &Mesh, half: f64) -> Mesh {
    let ends = mesh.vertices.iter().flat_map(|v| [(v, half), (v, -half)]);
    let points: Vec<ParryVector> = ends
        .map(|(v, up)| ParryVector::new(v.x, v.y, v.z + up))
        .collect();
    let (vertices, triangles) = convex_hull(&points);
    Mesh {
        vertices: vertices
            .iter()
            .map(|v| Vector3::new(v.x, v.y, v.z))
            .collect(),
        triangles: triangles.iter().map(|t| t.map(|i| i as usize)).collect(),
    }
}

/// Poses of a body and a capsule up to 5 cm deep in it, and the body's own depth.
fn poses(bench: &Bench, body: &Form, other: &Form) -> Vec<([Pose; 2], Truth)> {
    let mut rng = Pcg64::seed_from_u64(11);
    let n = if bench.quick { 50 } else { 500 };
    let mut found = Vec::with_capacity(n);
    while found.len() < n {
        let still = Pose {
            position: Vector3::zeros(),
            rotation: poses::rotation(&mut rng),
        };
        let moving = Pose {
            position: poses::direction(&mut rng) * 1.6,
            rotation: poses::rotation(&mut rng),
        };
        // Wherever it is, bring it to the depth that is wanted.
        let deep = 0.05 * (found.len() + 1) as f64 / n as f64;
        let Some((depth, normal)) = poses::rounded_depth([body, other], &[still, moving]) else {
            continue;
        };
        let pose = [
            still,
            Pose {
                position: moving.position + normal * (depth - deep),
                ..moving
            },
        ];
        found.extend(poses::rounded_truth([body, other], &pose, &mut rng).map(|t| (pose, t)));
    }
    found
}

/// A model against the body's poses. The answers are judged by the model's own depth,
/// as the oracle proves it; its distance from the body's depth is the modelling error.
fn measure(
    bench: &Bench,
    body: &str,
    model: &str,
    forms: [&Form; 2],
    poses: &[([Pose; 2], Truth)],
) -> Vec<Model> {
    let oracle = Oracle::new(bench.libraries, forms);
    let mut modelling = Vec::new();
    let mut placed = Vec::new();
    for (pose, truth) in poses {
        let proven = oracle.depth(pose);
        // A model too small to touch has no depth at all.
        modelling.push((proven.as_ref().map_or(0.0, |p| p.depth) - truth.depth).abs());
        if let Some(p) = proven {
            let truth = Truth {
                depth: p.depth,
                gap: p.gap,
                normal: p.normal.into(),
                ..*truth
            };
            placed.push((*pose, truth));
        }
    }
    let scene = Scene::placed(bench.libraries, body, forms, &placed, 0);
    let mut methods = vec![
        methods::of(bench.libraries, Ask::Local, Start::Five, 1e-6),
        methods::of(bench.libraries, Ask::Minimum, Start::None, 1e-6),
        methods::distance(bench.libraries, [0.0; 2], 1e-6),
        methods::of(bench.libraries, Ask::SystemEpa, Start::None, 1e-6),
    ];
    let ns = measure::times(&scene, &mut methods, bench.repetitions());
    let modelling_error = measure::mean(&modelling);
    let row_of = |model: &str, scene: &Scene, method: &mut Method, ns| {
        let row = measure::judge(bench.libraries, scene, method);
        Model {
            body: body.to_owned(),
            model: model.to_owned(),
            vertices: forms[0].mesh.vertices.len(),
            method: super::name(&row),
            modelling_error,
            query_error: row.mean_error,
            supports: row.supports,
            ns,
        }
    };
    let mut rows: Vec<Model> = (methods.iter_mut().zip(ns))
        .map(|(method, ns)| row_of(model, &scene, method, ns))
        .collect();
    // The bodies themselves once more, as a point or a segment with a margin.
    if forms[0].mesh.vertices.is_empty() {
        let [(a, one), (b, two)] = forms.map(Form::core);
        let cores = Scene::placed(bench.libraries, body, [&a, &b], &placed, 0);
        let mut methods = [methods::distance(bench.libraries, [one, two], 1e-6)];
        let ns = measure::times(&cores, &mut methods, bench.repetitions())[0];
        rows.push(row_of(CORES, &cores, &mut methods[0], ns));
    }
    rows
}

/// What spheres and capsules are modelled as by a point or a segment with a margin.
const CORES: &str = "core and margin";

/// Errors below this many metres are drawn as this: those of the polytopes are a
/// thousand times as large, and the decades between would press them together.
const NOTHING: f64 = 1e-7;

/// Modelling error against time, from the coarsest model to the finest.
fn panel<'a>(title: &str, models: impl Iterator<Item = &'a Model>) -> Panel {
    let point = |m: &'a Model| {
        let ours = m.method.starts_with("warmccd");
        let colour = match m.method.as_str() {
            "warmccd minimum" => (22, 145, 70),
            "warmccd distance" => (37, 99, 235),
            _ if ours => (217, 119, 6),
            _ => (153, 27, 27),
        };
        let (kind, mark) = match m.model.as_str() {
            "polytope, scan" => ("polytopes", Mark::Dot),
            "polytope, climbing" => ("climbing", Mark::Ring),
            CORES => ("core and margin", Mark::Cross),
            _ => ("the shape itself", Mark::Triangle),
        };
        // A primitive's modelling error is 0: what is left is its query's.
        let error = m.modelling_error.max(m.query_error).max(NOTHING);
        let label = format!("{}: {kind}", m.method);
        (label, Look::new(colour, mark, ours), (error, m.ns * 1e-9))
    };
    let x = ("mean error of the depth, model's or query's", Unit::Metres);
    Panel::new(title, x, TIME, figure::curves(models.map(point)))
}

pub fn measure_all(bench: &Bench) -> Vec<Model> {
    let capsule = Form::capsule(0.5, 0.5);
    let mut all = Vec::new();
    let bodies = [("sphere", Form::sphere(0.5)), ("capsule", capsule.clone())];
    for (body, form) in progress::over(&bodies, "models") {
        let poses = poses(bench, form, &capsule);
        all.extend(measure(bench, body, body, [form, &capsule], &poses));
        for n in VERTICES {
            let icosphere = Scene::load(bench.libraries, &format!("p{n}_cap"), 1).meshes[0].clone();
            let mesh = if *body == "sphere" {
                icosphere
            } else {
                stretched(&icosphere, 0.5)
            };
            for (climb, model) in [(false, "polytope, scan"), (true, "polytope, climbing")] {
                let polytope = Form {
                    climb,
                    ..Form::polytope(mesh.clone())
                };
                all.extend(measure(bench, body, model, [&polytope, &capsule], &poses));
            }
        }
    }
    all
}

pub fn draw(page: &Page, all: &[Model]) {
    let of = |body: &'static str| all.iter().filter(move |m| m.body == body);
    let panels = [
        panel("a sphere against a capsule", of("sphere")),
        panel("a capsule against a capsule", of("capsule")),
    ];
    figure::grid(
        &page.file("models.svg"),
        "No more model than the scene needs",
        2,
        &panels,
        &[
            "polytopes: 12 to 2,562 vertices, right to left; their vertices scanned, or climbed along the edges"
                .to_owned(),
            "at the left edge: errors of 0.1 µm and less".to_owned(),
            page.footer(),
        ],
    );
}
