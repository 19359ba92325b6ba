// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pairs of shapes in many poses, each with the global minimum of its
//! penetration depth: read from `c-tests/pairs` or `c-tests/record`, or placed by
//! whoever knows the truth.

use std::ffi::{c_int, c_uint, c_void};

use nalgebra::{UnitQuaternion, Vector3};

use ccd::internals::ffi::ccd_vec3_t;

use super::libraries::{Callbacks, Libraries, Recorded, Truth};
use crate::harness;

/// One pose: two shapes that the callbacks know, and what is true of them.
pub struct Pair {
    pub a: *mut c_void,
    pub b: *mut c_void,
    pub truth: Truth,
    /// Position in its motion; 0 starts a new one.
    pub frame: usize,
}

/// A polytope's mesh, in its own frame.
#[derive(Clone, Default)]
pub struct Mesh {
    pub vertices: Vec<Vector3<f64>>,
    pub triangles: Vec<[usize; 3]>,
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
    /// What shapes that were placed refer to.
    _bodies: Vec<Body>,
}

/// A shape to place: its type number and parameters as in `c-tests/shapes.h`.
#[derive(Clone, Default)]
pub struct Form {
    pub kind: c_int,
    pub p: [f64; 3],
    pub mesh: Mesh,
    /// Support points by climbing over the mesh's edges, not by a scan of its vertices.
    pub climb: bool,
}

impl Form {
    pub fn solid(kind: c_int, p: [f64; 3]) -> Self {
        Self {
            kind,
            p,
            ..Self::default()
        }
    }

    pub fn sphere(radius: f64) -> Self {
        Self::solid(0, [radius, 0.0, 0.0])
    }

    /// Along z.
    pub fn capsule(radius: f64, half: f64) -> Self {
        Self::solid(1, [radius, half, 0.0])
    }

    pub fn polytope(mesh: Mesh) -> Self {
        Self {
            mesh,
            ..Self::solid(6, [0.0; 3])
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
    pub fn rounded(&self) -> (f64, f64) {
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
pub fn room(callbacks: &Callbacks, n: usize) -> (Vec<u64>, usize) {
    // SAFETY: takes nothing.
    let words = unsafe { (callbacks.shape_size)() }.div_ceil(8);
    (vec![0; words * n], words)
}

impl Scene {
    /// A pair set of `c-tests/pairs`. At most `limit` poses.
    pub fn load(libraries: &Libraries, name: &str, limit: usize) -> Self {
        let callbacks = libraries.callbacks;
        let path = harness::root().join(format!("c-tests/pairs/{name}.bin"));
        // SAFETY: the functions of callbacks.c, called as it says; what they point to stays.
        unsafe {
            let (mut n, mut motion) = (0, 0);
            let file = Libraries::c_path(&path);
            let set = (callbacks.set)(file.as_ptr(), &mut n, &mut motion);
            assert!(!set.is_null(), "{} is not a pair set", path.display());
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
                let indices = |t: &[c_int]| [0, 1, 2].map(|i| t[i] as usize);
                Mesh {
                    vertices: v.chunks_exact(3).map(Vector3::from_column_slice).collect(),
                    triangles: t.chunks_exact(3).map(indices).collect(),
                }
            });
            Self {
                name: name.to_owned(),
                pairs,
                motion,
                meshes,
                _shapes: shapes,
                _bodies: Vec::new(),
            }
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
        let pair = |(i, (pose, truth)): (usize, &([Pose; 2], Truth))| {
            // SAFETY: room for 2 n shapes; the scene keeps the bodies.
            let [a, b] = [0, 1].map(|k| unsafe {
                let s = base.add((2 * i + k) * words).cast();
                bodies[k].place(&callbacks, s, &pose[k]);
                s
            });
            let (truth, frame) = (*truth, i.checked_rem(motion).unwrap_or(0));
            Pair { a, b, truth, frame }
        };
        let pairs = poses.iter().enumerate().map(pair).collect();
        Self {
            name: name.to_owned(),
            pairs,
            motion,
            meshes: forms.map(|f| f.mesh.clone()),
            _shapes: shapes,
            _bodies: bodies.into(),
        }
    }

    /// The recorded contact sequence of `c-tests/record`, its first `frames` frames,
    /// queries sorted by pair: each contact is a motion of its own. Pairs that are
    /// apart have a negative depth; normals and guesses are not known.
    pub fn recorded(libraries: &Libraries, frames: usize) -> Self {
        let callbacks = libraries.callbacks;
        let path = harness::root().join("c-tests/record/contacts.bin");
        let name = Libraries::c_path(&path);
        let frames = c_uint::try_from(frames).unwrap_or(c_uint::MAX);
        let read = |shapes: *mut u64, out: *mut Recorded| {
            // SAFETY: room for as many as it says it has, or none.
            unsafe { (callbacks.recording)(name.as_ptr(), frames, shapes.cast(), out) }
        };
        let count = read(std::ptr::null_mut(), std::ptr::null_mut());
        assert!(count > 0, "{} is not a recording", path.display());
        let (mut shapes, words) = room(&callbacks, 2 * count);
        let mut found = vec![Recorded::default(); count];
        read(shapes.as_mut_ptr(), found.as_mut_ptr());
        let base = shapes.as_mut_ptr();
        // SAFETY: one of the shapes.
        let shape = |k: usize| -> *mut c_void { unsafe { base.add(k * words).cast() } };
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|&k| (found[k].a, found[k].b));
        let mut pairs: Vec<Pair> = Vec::with_capacity(count);
        let mut last = Recorded::default();
        for k in order {
            let now = found[k];
            let goes_on = (now.a, now.b, now.frame) == (last.a, last.b, last.frame + 1);
            let age = pairs.last().map_or(0, |pair| pair.frame + 1);
            last = now;
            let (a, b) = (shape(2 * k), shape(2 * k + 1));
            let [pa, pb] = [a, b].map(|s| {
                let mut at = ccd_vec3_t::default();
                // SAFETY: a shape that was placed.
                unsafe { (callbacks.center)(s, &mut at) };
                Vector3::from(at.v)
            });
            let truth = Truth {
                depth: (now.lower + now.upper) / 2.0,
                gap: now.upper - now.lower,
                cold: (pb - pa).try_normalize(0.0).unwrap_or(Vector3::x()).into(),
                ..Truth::default()
            };
            let frame = if goes_on { age } else { 0 };
            pairs.push(Pair { a, b, truth, frame });
        }
        Self {
            name: "recorded".to_owned(),
            pairs,
            motion: 1,
            meshes: Default::default(),
            _shapes: shapes,
            _bodies: Vec::new(),
        }
    }
}

/// What the callbacks' shapes of one form have in common.
pub struct Body {
    kind: c_int,
    p: [f64; 3],
    vertices: Vec<f64>,
    /// The edges to climb over; empty: scan.
    graph: Vec<c_int>,
}

impl Body {
    pub fn of(callbacks: &Callbacks, form: &Form) -> Self {
        let mesh = &form.mesh;
        let mut graph = Vec::new();
        if form.climb {
            let indices = mesh.triangles.iter().flatten();
            let indices: Vec<c_int> = indices.map(|&i| i as c_int).collect();
            let (nv, nt) = (mesh.vertices.len(), mesh.triangles.len());
            graph = vec![0; nv + 1 + 6 * nt];
            let (t, room) = (indices.as_ptr(), graph.as_mut_ptr());
            // SAFETY: indices of the mesh, and room for its graph.
            let code = unsafe { (callbacks.graph)(nv as c_int, t, nt as c_int, room) };
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
    pub unsafe fn place(&self, callbacks: &Callbacks, at: *mut c_void, pose: &Pose) {
        let rot = pose.rotation.to_rotation_matrix().matrix().transpose();
        let (p, pos, rot) = (self.p.as_ptr(), pose.position.as_ptr(), rot.as_ptr());
        let (v, n) = (self.vertices.as_ptr(), (self.vertices.len() / 3) as c_int);
        let scan = self.graph.is_empty();
        let graph = if scan {
            std::ptr::null()
        } else {
            self.graph.as_ptr()
        };
        // SAFETY: the caller's contract; p[3], pos[3] and rot[9] row by row are read.
        unsafe { (callbacks.shape)(at, self.kind, p, v, n, graph, pos, rot) };
    }
}
