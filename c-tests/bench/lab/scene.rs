// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pairs of shapes in many poses, each with the global minimum of its
//! penetration depth: read from `c-tests/pairs`, or placed at random where a
//! closed form gives the truth (spheres and capsules).

use std::collections::BTreeMap;
use std::ffi::{c_int, c_uint, c_void};

use nalgebra::{Matrix3, Unit, UnitQuaternion, Vector3};
use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::query::ClosestPoints;
use parry3d_f64::query::details::closest_points_segment_segment;
use parry3d_f64::shape::Segment;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::libraries::{CPenetration, Callbacks, Libraries, Truth, Warm};
use crate::harness;

/// One pose: two shapes that the callbacks know, and what is true of them.
pub struct Pair {
    pub a: *mut c_void,
    pub b: *mut c_void,
    pub truth: Truth,
    /// Position in its motion; 0 starts a new one.
    pub frame: usize,
}

impl Pair {
    /// Rotation (local to world) and position of the first or second shape.
    pub fn pose(&self, libraries: &Libraries, which: usize) -> (Matrix3<f64>, Vector3<f64>) {
        // SAFETY: a shape of the scene.
        let shape = unsafe {
            Shape::read(
                &libraries.callbacks,
                if which == 0 { self.a } else { self.b },
            )
        };
        (
            Matrix3::from_row_slice(&shape.rotation),
            shape.position.into(),
        )
    }
}

/// What the callbacks know of a shape.
#[derive(Default)]
struct Shape {
    position: [f64; 3],
    rotation: [f64; 9],
    kind: c_int,
    p: [f64; 3],
}

impl Shape {
    /// # Safety
    /// `shape` is one of the callbacks' shapes.
    unsafe fn read(callbacks: &Callbacks, shape: *const c_void) -> Self {
        let mut s = Self::default();
        let (position, rotation) = (s.position.as_mut_ptr(), s.rotation.as_mut_ptr());
        // SAFETY: the caller's contract, and room for what is written.
        unsafe { (callbacks.shape_pose)(shape, position, rotation, &mut s.kind, s.p.as_mut_ptr()) };
        s
    }
}

/// A polytope's mesh, in its own frame.
#[derive(Clone, Default)]
pub struct Mesh {
    pub vertices: Vec<Vector3<f64>>,
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// A box by its half extents.
    pub fn cuboid(half: [f64; 3]) -> Self {
        let half = ParryVector::from(half);
        let (vertices, triangles) = parry3d_f64::shape::Cuboid::new(half).to_trimesh();
        Self {
            vertices: vertices
                .iter()
                .map(|v| Vector3::new(v.x, v.y, v.z))
                .collect(),
            triangles: triangles.iter().map(|t| t.map(|i| i as usize)).collect(),
        }
    }
}

/// Pairs of one kind.
pub struct Scene {
    pub name: String,
    pub pairs: Vec<Pair>,
    /// Poses follow each other; else they are independent.
    pub motion: usize,
    /// The two polytopes, where they are.
    pub meshes: [Mesh; 2],
    /// Where the shapes live.
    _shapes: Vec<u64>,
    /// What the shapes refer to: an open file, or bodies.
    _source: Option<Source>,
    _bodies: Vec<Body>,
}

/// An open file of the callbacks'.
enum Source {
    Set(*mut c_void, Callbacks),
    Recording(*mut c_void, Callbacks),
}

impl Source {
    fn pointer(&self) -> *mut c_void {
        let (Self::Set(p, _) | Self::Recording(p, _)) = *self;
        p
    }
}

impl Drop for Source {
    fn drop(&mut self) {
        // SAFETY: opened by the function beside the one that closes it; closed once.
        unsafe {
            match self {
                Self::Set(p, callbacks) => (callbacks.set_close)(*p),
                Self::Recording(p, callbacks) => (callbacks.recording_close)(*p),
            }
        }
    }
}

/// A shape to place: its type number and parameters as in `c-tests/shapes.h`.
#[derive(Clone)]
pub struct Form {
    pub kind: c_int,
    pub p: [f64; 3],
    pub mesh: Mesh,
    /// Support points by climbing over the mesh's edges, not by a scan of its vertices.
    pub climb: bool,
}

impl Form {
    pub fn sphere(radius: f64) -> Self {
        Self {
            kind: 0,
            p: [radius, 0.0, 0.0],
            mesh: Mesh::default(),
            climb: false,
        }
    }

    /// Along z.
    pub fn capsule(radius: f64, half: f64) -> Self {
        Self {
            kind: 1,
            p: [radius, half, 0.0],
            mesh: Mesh::default(),
            climb: false,
        }
    }

    pub fn polytope(mesh: Mesh) -> Self {
        Self {
            kind: 6,
            p: [0.0; 3],
            mesh,
            climb: false,
        }
    }

    /// The point or segment inside, and the radius around it: all of the shape, where it is
    /// a sphere or a capsule, and nothing around it else.
    pub fn core(&self) -> (Self, f64) {
        match self.kind {
            0 | 1 => {
                let mut core = self.clone();
                core.p[0] = 0.0;
                (core, self.p[0])
            }
            _ => (self.clone(), 0.0),
        }
    }

    /// Half length of the core segment, and the radius around it.
    fn rounded(&self) -> (f64, f64) {
        match self.kind {
            0 => (0.0, self.p[0]),
            1 => (self.p[1], self.p[0]),
            _ => panic!("closed forms are known for spheres and capsules only"),
        }
    }
}

/// Where a shape is: local point x at `rotation * x + position`.
#[derive(Clone, Copy)]
pub struct Pose {
    pub position: Vector3<f64>,
    pub rotation: UnitQuaternion<f64>,
}

/// Memory for `n` shapes, and the size of one in words.
fn room(callbacks: &Callbacks, n: usize) -> (Vec<u64>, usize) {
    // SAFETY: takes nothing.
    let words = unsafe { (callbacks.shape_size)() }.div_ceil(8);
    (vec![0; words * n], words)
}

/// The unit vector `angle` degrees from `n`, turned about an axis across it
/// that `rng` draws.
pub fn tilted(n: &Vector3<f64>, degrees: f64, rng: &mut Pcg64) -> Vector3<f64> {
    let across = n.cross(&direction(rng));
    UnitQuaternion::from_axis_angle(&Unit::new_normalize(across), degrees.to_radians()) * n
}

/// Uniform on the unit sphere.
pub fn direction(rng: &mut Pcg64) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let l: f64 = v.norm();
        if l > 1e-3 && l <= 1.0 {
            return v / l;
        }
    }
}

/// Uniform over all rotations.
pub fn rotation(rng: &mut Pcg64) -> UnitQuaternion<f64> {
    loop {
        let q = nalgebra::Quaternion::from(nalgebra::Vector4::from_fn(|_, _| {
            rng.random_range(-1.0..1.0)
        }));
        if q.norm() > 1e-3 && q.norm() <= 1.0 {
            return UnitQuaternion::new_normalize(q);
        }
    }
}

impl Scene {
    /// A pair set of `c-tests/pairs`. `hc` behind a polytope's name (`p642hc_p642hc`)
    /// asks for hill climbing in place of the scan over all vertices. At most `limit` poses.
    pub fn load(libraries: &Libraries, name: &str, limit: usize) -> Self {
        let callbacks = libraries.callbacks;
        let climb = name.contains("hc");
        let path = harness::root().join(format!("c-tests/pairs/{}.bin", name.replace("hc", "")));
        // SAFETY: the functions of callbacks.c, called as it says; every pointer
        // read is theirs until the set is closed, which waits for the scene's end.
        unsafe {
            let set = (callbacks.set_open)(Libraries::c_path(&path).as_ptr(), climb.into());
            assert!(!set.is_null(), "{} is not a pair set", path.display());
            let source = Source::Set(set, callbacks);
            let (mut n, mut motion) = (0, 0);
            (callbacks.set_count)(set, &mut n, &mut motion);
            let n = (n as usize).min(limit);
            let motion = motion as usize;
            let (mut shapes, words) = room(&callbacks, 2 * n);
            let base = shapes.as_mut_ptr();
            let pairs: Vec<Pair> = (0..n)
                .map(|i| {
                    let a = base.add(2 * i * words).cast();
                    let b = base.add((2 * i + 1) * words).cast();
                    let mut truth = Truth::default();
                    (callbacks.set_pose)(set, i as c_int, a, b, &mut truth);
                    let frame = i.checked_rem(motion).unwrap_or(0);
                    Pair { a, b, truth, frame }
                })
                .collect();
            let meshes = [0, 1].map(|k| {
                let (mut nv, mut nt) = (0, 0);
                let (mut v, mut t) = (std::ptr::null(), std::ptr::null());
                (callbacks.set_mesh)(set, k, &mut nv, &mut v, &mut nt, &mut t);
                let v = std::slice::from_raw_parts(v, 3 * nv as usize);
                let t = std::slice::from_raw_parts(t, 3 * nt as usize);
                let shape = pairs.first().map(|p| if k == 0 { p.a } else { p.b });
                let shape = shape.map(|s| Shape::read(&callbacks, s));
                // A box.
                if let Some(shape) = shape.filter(|s| s.kind == 2) {
                    return Mesh::cuboid(shape.p);
                }
                Mesh {
                    vertices: v.chunks_exact(3).map(Vector3::from_column_slice).collect(),
                    triangles: t
                        .chunks_exact(3)
                        .map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
                        .collect(),
                }
            });
            Self {
                name: name.to_owned(),
                pairs,
                motion,
                meshes,
                _shapes: shapes,
                _source: Some(source),
                _bodies: Vec::new(),
            }
        }
    }

    /// Moves the second shape of every pair out along its least direction until they
    /// are `gap` apart, metres.
    pub fn part(&mut self, libraries: &Libraries, gap: f64) {
        for pair in &mut self.pairs {
            let by = pair.truth.normal.map(|n| n * (pair.truth.depth + gap));
            // SAFETY: a shape of the scene.
            unsafe { (libraries.callbacks.shape_shift)(pair.b, by.as_ptr()) };
            pair.truth.depth = -gap;
        }
    }

    /// Shapes at given poses, `motion` steps to a motion.
    pub fn placed(
        libraries: &Libraries,
        name: &str,
        forms: [&Form; 2],
        poses: &[([Pose; 2], Truth)],
        motion: usize,
    ) -> Self {
        let callbacks = libraries.callbacks;
        let bodies = forms.map(|f| Body::of(&callbacks, f));
        let (mut shapes, words) = room(&callbacks, 2 * poses.len());
        let base = shapes.as_mut_ptr();
        let pairs = poses
            .iter()
            .enumerate()
            .map(|(i, (pose, truth))| {
                let at: [*mut c_void; 2] = [0, 1].map(|k| {
                    // SAFETY: room for 2 n shapes; the scene keeps the bodies.
                    unsafe {
                        let s = base.add((2 * i + k) * words).cast();
                        bodies[k].place(&callbacks, s, &pose[k]);
                        s
                    }
                });
                let frame = i.checked_rem(motion).unwrap_or(0);
                Pair {
                    a: at[0],
                    b: at[1],
                    truth: *truth,
                    frame,
                }
            })
            .collect();
        Self {
            name: name.to_owned(),
            pairs,
            motion,
            meshes: forms.map(|f| f.mesh.clone()),
            _shapes: shapes,
            _source: None,
            _bodies: bodies.into(),
        }
    }

    /// The recorded contact sequence of `c-tests/record`, its first `frames` frames,
    /// queries sorted by pair: each contact is a motion of its own. Pairs that are
    /// apart have a negative depth; normals and guesses are not known.
    pub fn recorded(libraries: &Libraries, frames: usize) -> Self {
        let callbacks = libraries.callbacks;
        let path = harness::root().join("c-tests/record/contacts.bin");
        // SAFETY: the functions of callbacks.c, called as it says.
        unsafe {
            let recording = (callbacks.recording_open)(Libraries::c_path(&path).as_ptr());
            assert!(
                !recording.is_null(),
                "{} is not a recording",
                path.display()
            );
            let recording = Source::Recording(recording, callbacks);
            let of = recording.pointer();
            let (mut n, mut bodies, mut count) = (0, 0, 0);
            (callbacks.recording_count)(of, &mut n, &mut bodies);
            // By pair, in time: the frame number and where the two shapes are.
            let mut found: BTreeMap<(c_uint, c_uint), Vec<_>> = BTreeMap::new();
            let (mut world, words) = room(&callbacks, bodies as usize);
            let mut shapes: Vec<u64> = Vec::new();
            let mut queries = 0;
            for frame in 0..(n as usize).min(frames) {
                (callbacks.recording_frame)(
                    of,
                    frame as c_uint,
                    world.as_mut_ptr().cast(),
                    &mut count,
                );
                for k in 0..count {
                    let (mut a, mut b, mut low, mut high) = (0, 0, 0.0, 0.0);
                    (callbacks.recording_pair)(
                        of,
                        frame as c_uint,
                        k,
                        queries,
                        &mut a,
                        &mut b,
                        &mut low,
                        &mut high,
                    );
                    queries += 1;
                    let [pa, pb] = [a, b].map(|k| {
                        Vector3::from(
                            Shape::read(&callbacks, world.as_ptr().add(k as usize * words).cast())
                                .position,
                        )
                    });
                    let truth = Truth {
                        depth: (low + high) / 2.0,
                        gap: high - low,
                        cold: (pb - pa).try_normalize(0.0).unwrap_or(Vector3::x()).into(),
                        ..Truth::default()
                    };
                    found
                        .entry((a, b))
                        .or_default()
                        .push((frame, shapes.len(), truth));
                    for body in [a as usize, b as usize] {
                        shapes.extend_from_slice(&world[body * words..(body + 1) * words]);
                    }
                }
            }
            let base = shapes.as_mut_ptr();
            let mut pairs = Vec::new();
            for contact in found.values() {
                let mut last = usize::MAX - 1;
                let mut age = 0;
                for &(frame, at, truth) in contact {
                    age = if frame == last + 1 { age + 1 } else { 0 };
                    last = frame;
                    let (a, b) = (base.add(at).cast(), base.add(at + words).cast());
                    pairs.push(Pair {
                        a,
                        b,
                        truth,
                        frame: age,
                    });
                }
            }
            Self {
                name: "recorded".to_owned(),
                pairs,
                motion: 1,
                meshes: Default::default(),
                _shapes: shapes,
                _source: Some(recording),
                _bodies: Vec::new(),
            }
        }
    }

    /// `n` overlapping random poses of two spheres or capsules: rotations uniform,
    /// the second shape's centre uniform in the ball that reaches an overlap.
    pub fn random_rounded(
        libraries: &Libraries,
        name: &str,
        forms: [&Form; 2],
        n: usize,
        seed: u64,
    ) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed);
        let reach: f64 = forms.iter().map(|f| f.rounded().0 + f.rounded().1).sum();
        let mut poses = Vec::with_capacity(n);
        while poses.len() < n {
            let pose = [
                Pose {
                    position: Vector3::from_fn(|_, _| rng.random_range(-0.5..0.5)),
                    rotation: rotation(&mut rng),
                },
                Pose {
                    position: Vector3::zeros(),
                    rotation: rotation(&mut rng),
                },
            ];
            let away = Vector3::from_fn(|_, _| rng.random_range(-reach..reach));
            let pose = [
                pose[0],
                Pose {
                    position: pose[0].position + away,
                    ..pose[1]
                },
            ];
            if let Some(truth) = rounded_truth(forms, &pose, &mut rng) {
                poses.push((pose, truth));
            }
        }
        Self::placed(libraries, name, forms, &poses, 0)
    }
}

/// The global minimum of two shapes in any pose, from this library's own proof.
pub struct Oracle<'a> {
    libraries: &'a Libraries,
    bodies: [Body; 2],
}

/// What the oracle proves: the depth is within `gap` of the minimum.
pub struct Proven {
    pub depth: f64,
    pub normal: Vector3<f64>,
    pub gap: f64,
}

impl<'a> Oracle<'a> {
    pub fn new(libraries: &'a Libraries, forms: [&Form; 2]) -> Self {
        let bodies = forms.map(|f| Body::of(&libraries.callbacks, f));
        Self { libraries, bodies }
    }

    /// None when the shapes are apart.
    pub fn depth(&self, poses: &[Pose; 2]) -> Option<Proven> {
        let callbacks = &self.libraries.callbacks;
        let settings = self.libraries.ours.settings(callbacks, 1e-10);
        let (mut shapes, words) = room(callbacks, 2);
        let mut out = CPenetration::default();
        let mut state = Warm::COLD;
        let ask = self.libraries.extension.minimum;
        // SAFETY: room for two shapes, placed before they are asked about.
        let code = unsafe {
            let at: [*mut c_void; 2] = [0, 1].map(|k| shapes.as_mut_ptr().add(k * words).cast());
            for k in 0..2 {
                self.bodies[k].place(callbacks, at[k], &poses[k]);
            }
            ask(at[0], at[1], &settings, &mut state, &mut out)
        };
        // At the cap (-4) the bound is as honest, only wider.
        (code == 0 || code == -4).then(|| Proven {
            depth: out.depth,
            normal: out.dir.v.into(),
            gap: out.depth - out.depth_lower,
        })
    }
}

/// What the callbacks' shapes of one form have in common.
struct Body {
    kind: c_int,
    p: [f64; 3],
    vertices: Vec<f64>,
    /// The edges to climb over; empty: scan.
    graph: Vec<c_int>,
}

impl Body {
    fn of(callbacks: &Callbacks, form: &Form) -> Self {
        let mesh = &form.mesh;
        let mut graph = Vec::new();
        if form.climb {
            let triangles: Vec<c_int> = mesh
                .triangles
                .iter()
                .flatten()
                .map(|&i| i as c_int)
                .collect();
            graph = vec![0; mesh.vertices.len() + 1 + 6 * mesh.triangles.len()];
            // SAFETY: indices of the mesh, and room for its graph.
            let code = unsafe {
                (callbacks.graph)(
                    mesh.vertices.len() as c_int,
                    triangles.as_ptr(),
                    mesh.triangles.len() as c_int,
                    graph.as_mut_ptr(),
                )
            };
            assert_eq!(code, 0, "memory for a mesh's edges");
        }
        Self {
            kind: form.kind,
            p: form.p,
            vertices: mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect(),
            graph,
        }
    }

    /// Makes a shape at a pose.
    ///
    /// # Safety
    /// `at` has room for a shape, which must not outlive the body.
    unsafe fn place(&self, callbacks: &Callbacks, at: *mut c_void, pose: &Pose) {
        let rot = pose.rotation.to_rotation_matrix();
        let graph = if self.graph.is_empty() {
            std::ptr::null()
        } else {
            self.graph.as_ptr()
        };
        // SAFETY: the caller's contract; p[3], pos[3] and rot[9] row by row are read.
        unsafe {
            (callbacks.shape)(
                at,
                self.kind,
                self.p.as_ptr(),
                self.vertices.as_ptr(),
                (self.vertices.len() / 3) as c_int,
                graph,
                pose.position.as_ptr(),
                rot.matrix().transpose().as_ptr(),
            );
        }
    }
}

/// Signed depth of two spheres or capsules and the direction of it: D is the
/// difference of their core segments, a parallelogram, with a ball around it. With
/// the origin off the parallelogram the minimum lies along the shortest way to it;
/// crossing cores have no answer here.
pub fn rounded_depth(forms: [&Form; 2], pose: &[Pose; 2]) -> Option<(f64, Vector3<f64>)> {
    let core = |k: usize| {
        let half = pose[k].rotation * Vector3::new(0.0, 0.0, forms[k].rounded().0);
        let end = |v: Vector3<f64>| ParryVector::new(v.x, v.y, v.z);
        Segment::new(end(pose[k].position - half), end(pose[k].position + half))
    };
    let near = closest_points_segment_segment(
        &parry3d_f64::math::Pose::IDENTITY,
        &core(0),
        &core(1),
        f64::MAX,
    );
    let ClosestPoints::WithinMargin(p, q) = near else {
        return None;
    };
    let apart = Vector3::new(q.x - p.x, q.y - p.y, q.z - p.z);
    let depth = forms[0].rounded().1 + forms[1].rounded().1 - apart.norm();
    (apart.norm() > 1e-9).then(|| (depth, apart.normalize()))
}

/// The truth of an overlap of two spheres or capsules.
pub fn rounded_truth(forms: [&Form; 2], pose: &[Pose; 2], rng: &mut Pcg64) -> Option<Truth> {
    let (depth, normal) = rounded_depth(forms, pose).filter(|d| d.0 > 0.0)?;
    let cold = pose[1].position - pose[0].position;
    Some(Truth {
        depth,
        gap: 0.0,
        normal: normal.into(),
        init5: tilted(&normal, 5.0, rng).into(),
        init25: tilted(&normal, 25.0, rng).into(),
        init45: tilted(&normal, 45.0, rng).into(),
        cold: cold.try_normalize(0.0).unwrap_or(normal).into(),
    })
}
