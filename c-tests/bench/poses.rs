// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Poses for scenes that no pair set holds, and their truth: of spheres and capsules by a
//! closed form, of anything else by this library's own proof.

use std::ffi::c_void;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::query::ClosestPoints;
use parry3d_f64::query::details::closest_points_segment_segment;
use parry3d_f64::shape::Segment;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use ccd::internals::ffi::{CCD_LIMIT, CCD_WANT_ALL, ccd_penetration_t};

use crate::lab::libraries::{COLD, Libraries, Truth, zeroed};
use crate::lab::scene::{Body, Form, Pose, Scene, room};

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

/// `n` overlapping random poses of two spheres or capsules: rotations uniform,
/// the second shape's centre uniform in the ball that reaches an overlap.
pub fn random_rounded(
    libraries: &Libraries,
    name: &str,
    forms: [&Form; 2],
    n: usize,
    seed: u64,
) -> Scene {
    let mut rng = Pcg64::seed_from_u64(seed);
    let reach: f64 = forms.iter().map(|f| f.rounded().0 + f.rounded().1).sum();
    let mut poses = Vec::with_capacity(n);
    while poses.len() < n {
        let still = Pose {
            position: Vector3::from_fn(|_, _| rng.random_range(-0.5..0.5)),
            rotation: rotation(&mut rng),
        };
        let turn = rotation(&mut rng);
        let away = Vector3::from_fn(|_, _| rng.random_range(-reach..reach));
        let moved = Pose {
            position: still.position + away,
            rotation: turn,
        };
        let pose = [still, moved];
        if let Some(truth) = rounded_truth(forms, &pose, &mut rng) {
            poses.push((pose, truth));
        }
    }
    Scene::placed(libraries, name, forms, &poses, 0)
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
        // SAFETY: numbers.
        let mut out: ccd_penetration_t = unsafe { zeroed() };
        let mut state = COLD;
        let ask = self.libraries.extension.minimum;
        // SAFETY: room for two shapes, placed before they are asked about.
        let code = unsafe {
            let at: [*mut c_void; 2] = [0, 1].map(|k| shapes.as_mut_ptr().add(k * words).cast());
            for k in 0..2 {
                self.bodies[k].place(callbacks, at[k], &poses[k]);
            }
            ask(at[0], at[1], &settings, &mut state, CCD_WANT_ALL, &mut out)
        };
        // At the cap the bound is as honest, only wider.
        (code == 0 || code == CCD_LIMIT).then(|| Proven {
            depth: out.depth,
            normal: out.dir.v.into(),
            gap: out.depth - out.depth_lower,
        })
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
