// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's setup: random overlapping poses of shapes of 1 m, their true depths, and guesses off the true direction.
//!
//! Rotations are uniform, the second shape's position is uniform where the two overlap. The truth of spheres and
//! capsules is a closed form: the distance of their core segments. That of hulls are certified bounds (`harness/truth.h`).

use std::ffi::c_int;
use std::ptr::null;

use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3, Vector4};
use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::ClosestPoints;
use parry3d_f64::query::details::closest_points_segment_segment;
use parry3d_f64::shape::Segment;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::measuring::libraries::Libraries;
use crate::measuring::scene::{Pair, Scene, Truth};

type V = Vector3<f64>;

/// A closed triangle mesh, counterclockwise from outside.
pub struct Mesh {
    pub vertices: Vec<V>,
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// Returns the neighbours of every vertex.
    fn neighbours(&self) -> Vec<Vec<usize>> {
        let mut all = vec![Vec::new(); self.vertices.len()];
        // Every edge is in two triangles, once in each direction.
        self.triangles.iter().for_each(|t| (0..3).for_each(|k| all[t[k]].push(t[(k + 1) % 3])));
        all
    }

    /// Returns the icosahedron, its edges halved so often, with its vertices on the sphere of diameter 1.
    pub fn icosphere(halvings: usize) -> Self {
        let golden = (1.0 + 5_f64.sqrt()) / 2.0;
        let mut vertices = Vec::new();
        for k in 0..3 {
            for (x, y) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
                let mut v = V::zeros();
                (v[(k + 1) % 3], v[(k + 2) % 3]) = (x, y);
                vertices.push(v.normalize() * 0.5);
            }
        }
        // Vertices at the least distance share an edge; three that do are a face.
        let is_edge = |i: usize, j: usize| (vertices[i] - vertices[j]).norm() < 0.6;
        let mut triangles = Vec::new();
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    if is_edge(i, j) && is_edge(j, k) && is_edge(k, i) {
                        let n = (vertices[j] - vertices[i]).cross(&(vertices[k] - vertices[i]));
                        triangles.push(if n.dot(&vertices[i]) > 0.0 { [i, j, k] } else { [i, k, j] });
                    }
                }
            }
        }
        let mut mesh = Self { vertices, triangles };
        (0..halvings).for_each(|_| mesh.halve());
        mesh
    }

    fn halve(&mut self) {
        let mut middles = std::collections::HashMap::new();
        let vertices = &mut self.vertices;
        let mut middle = |i: usize, j: usize| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                vertices.push((vertices[i] + vertices[j]).normalize() * 0.5);
                vertices.len() - 1
            })
        };
        let quarter = |&[i, j, k]: &[usize; 3]| {
            let [ij, jk, ki] = [middle(i, j), middle(j, k), middle(k, i)];
            [[i, ij, ki], [j, jk, ij], [k, ki, jk], [ij, jk, ki]]
        };
        self.triangles = self.triangles.iter().flat_map(quarter).collect();
    }
}

/// A shape with a characteristic dimension of 1 m.
pub enum Shape {
    Sphere,
    /// Its axis is as long as its diameter.
    Capsule,
    Hull(Mesh),
}

impl Shape {
    const RADIUS: f64 = 0.5;

    /// Returns half the length of the core segment; of a hull that of the ball around it.
    fn half_axis(&self) -> f64 {
        if matches!(self, Shape::Capsule) { 0.5 } else { 0.0 }
    }

    /// Returns the number of its type in `harness/shapes.h`.
    fn number(&self) -> i32 {
        match self {
            Shape::Sphere => 0,
            Shape::Capsule => 1,
            Shape::Hull(_) => 6,
        }
    }
}

/// Rotation, from local to world, and position.
pub struct Pose {
    pub turn: Matrix3<f64>,
    pub at: V,
}

/// A scene, and the poses of its pairs by [`Pair::motion`].
pub struct Poses {
    pub scene: Scene,
    pub placed: Vec<[Pose; 2]>,
}

/// Returns a random unit vector.
fn direction(rng: &mut Pcg64) -> V {
    loop {
        let v = V::from_fn(|_, _| rng.random_range(-1.0..1.0));
        if v.norm() > 1e-3 && v.norm() <= 1.0 {
            return v.normalize();
        }
    }
}

/// Returns a random rotation.
fn rotation(rng: &mut Pcg64) -> Matrix3<f64> {
    loop {
        let q = Quaternion::from(Vector4::from_fn(|_, _| rng.random_range(-1.0..1.0)));
        if q.norm() > 1e-3 && q.norm() <= 1.0 {
            return UnitQuaternion::from_quaternion(q).to_rotation_matrix().into_inner();
        }
    }
}

/// Returns `n` turned by so many degrees about a random axis perpendicular to it.
fn off(n: &V, degrees: f64, rng: &mut Pcg64) -> [f64; 3] {
    let axis = Unit::new_normalize(n.cross(&direction(rng)));
    (UnitQuaternion::from_axis_angle(&axis, degrees.to_radians()) * n).into()
}

/// Returns the depth of two spheres or capsules, negative if they are apart, and its direction: D is the difference of the core
/// segments, which is a parallelogram, with a ball around it. Hulls count as the balls around them.
fn closed_form(shapes: [&Shape; 2], poses: &[Pose; 2]) -> (f64, V) {
    let core = |k: usize| {
        let half = poses[k].turn.column(2) * shapes[k].half_axis();
        let end = |v: V| ParryVector::new(v.x, v.y, v.z);
        Segment::new(end(poses[k].at - half), end(poses[k].at + half))
    };
    let found = closest_points_segment_segment(&ParryPose::IDENTITY, &core(0), &core(1), f64::MAX);
    let ClosestPoints::WithinMargin(p, q) = found else { panic!("segments have closest points") };
    let apart = V::new(q.x - p.x, q.y - p.y, q.z - p.z);
    (2.0 * Shape::RADIUS - apart.norm(), apart.normalize())
}

/// A mesh for callbacks.c.
#[derive(Clone, Copy)]
struct Arrays {
    vertices: *const f64,
    number: c_int,
    first: *const c_int,
    neighbours: *const c_int,
}

impl Default for Arrays {
    fn default() -> Self {
        Self { vertices: null(), number: 0, first: null(), neighbours: null() }
    }
}

impl Arrays {
    fn leak(mesh: &Mesh) -> Self {
        let index = |i: usize| c_int::try_from(i).expect("a small number");
        let vertices: Vec<f64> = mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        let (mut first, mut neighbours) = (vec![0], Vec::new());
        for of in mesh.neighbours() {
            neighbours.extend(of.into_iter().map(index));
            first.push(index(neighbours.len()));
        }
        Self {
            vertices: vertices.leak().as_ptr(),
            number: index(mesh.vertices.len()),
            first: first.leak().as_ptr(),
            neighbours: neighbours.leak().as_ptr(),
        }
    }
}

/// Depths of hulls are known within this, metres: a hundredth of the errors in the paper's Table I.
const CERTIFIED: f64 = 1e-8;
/// Overlaps that are not deeper are left out.
const SHALLOWEST: f64 = 1e-6;

/// Makes so many overlapping pairs of two shapes, which live as long as the program; the same ones in every run.
pub fn random(libraries: &Libraries, name: &str, shapes: [&'static Shape; 2], number: usize) -> Poses {
    let mut rng = Pcg64::seed_from_u64(2023);
    let reach: f64 = shapes.iter().map(|shape| Shape::RADIUS + shape.half_axis()).sum();
    let (mut pairs, mut placed) = (Vec::with_capacity(number), Vec::with_capacity(number));
    let meshes = shapes.map(|shape| match shape {
        Shape::Hull(mesh) => Some(Arrays::leak(mesh)),
        _ => None,
    });
    let place = |k: usize, pose: &Pose| {
        let p = [Shape::RADIUS, shapes[k].half_axis(), 0.0];
        let turn = std::array::from_fn(|i| pose.turn[(i / 3, i % 3)]);
        let Arrays { vertices, number, first, neighbours } = meshes[k].unwrap_or_default();
        let place = libraries.callbacks.place;
        // SAFETY: arrays of the sizes of callbacks.c; those of a mesh are never freed.
        let shape = unsafe {
            place(shapes[k].number(), p.as_ptr(), &pose.at.into(), &turn, vertices, number, first, neighbours)
        };
        assert!(!shape.is_null(), "no memory");
        shape
    };
    while pairs.len() < number {
        let at = V::from_fn(|_, _| rng.random_range(-0.5..0.5));
        let away = V::from_fn(|_, _| rng.random_range(-reach..reach));
        let poses = [Pose { turn: rotation(&mut rng), at }, Pose { turn: rotation(&mut rng), at: at + away }];
        let (mut depth, mut normal) = closed_form(shapes, &poses);
        let mut gap = 0.0;
        if depth <= SHALLOWEST {
            continue;
        }
        let [a, b] = [0, 1].map(|k| place(k, &poses[k]));
        if meshes.iter().any(Option::is_some) {
            let mut n = [0.0; 3];
            // SAFETY: two shapes and room for the results.
            depth = unsafe { (libraries.callbacks.truth)(a, b, CERTIFIED, &mut n, &mut gap) };
            normal = n.into();
            if depth <= SHALLOWEST {
                continue;
            }
        }
        let truth = Truth {
            depth,
            gap,
            normal: normal.into(),
            init5: off(&normal, 5.0, &mut rng),
            init25: off(&normal, 25.0, &mut rng),
            init45: off(&normal, 45.0, &mut rng),
            cold: away.normalize().into(),
        };
        pairs.push(Pair { a, b, truth, motion: pairs.len(), frame: 0 });
        placed.push(poses);
    }
    Poses { scene: Scene { name: name.to_owned(), pairs }, placed }
}
