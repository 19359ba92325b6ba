// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Support mappings for the unit tests, and where to put them. The shapes of the C tests,
//! with their exact truth, are those of `c-tests/shapes.h`; these are closures, so that
//! `cargo test --lib` needs no C compiler and Miri can run it.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::math::{Real, Vec3, unit};

pub type Rotation = nalgebra::Rotation3<Real>;

/// One type for all: the solvers are compiled once for it, not once for each pair of
/// shapes.
pub type Shape = Box<dyn Fn(&Vec3) -> Vec3>;

/// The same numbers on every machine.
pub struct Random(Pcg64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    pub fn within(&mut self, low: Real, high: Real) -> Real {
        self.0.random_range(low..high)
    }

    pub fn vector(&mut self, size: Real) -> Vec3 {
        Vec3::from_fn(|_, _| self.within(-size, size))
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if v.norm() <= 1.0
                && let Some(n) = unit(&v)
            {
                return n;
            }
        }
    }

    pub fn rotation(&mut self) -> Rotation {
        let q = nalgebra::Quaternion::from_vector(nalgebra::Vector4::from_fn(|_, _| {
            self.within(-1.0, 1.0)
        }));
        nalgebra::UnitQuaternion::from_quaternion(q).to_rotation_matrix()
    }

    /// `n` points on a sphere.
    pub fn points(&mut self, n: usize, radius: Real) -> Vec<Vec3> {
        (0..n).map(|_| self.direction() * radius).collect()
    }
}

/// The hull of the points.
pub fn hull(points: &[Vec3]) -> Shape {
    let points = points.to_vec();
    Box::new(move |d| {
        let mut best = points[0];
        for p in &points {
            if p.dot(d) > best.dot(d) {
                best = *p;
            }
        }
        best
    })
}

/// The corners of a box with these half extents about the origin.
pub fn corners(half: Vec3) -> Vec<Vec3> {
    (0..8)
        .map(|i| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            half.component_mul(&Vec3::new(sign(1), sign(2), sign(4)))
        })
        .collect()
}

/// The shape as seen from `1 / scale` as far: borrowed, so that its type is the same.
pub fn scaled(shape: &Shape, scale: Real) -> Box<dyn Fn(&Vec3) -> Vec3 + '_> {
    Box::new(move |d| shape(d) * scale)
}

/// Points moved rigidly.
pub fn placed(points: &[Vec3], rotation: &Rotation, at: Vec3) -> Vec<Vec3> {
    points.iter().map(|p| rotation * p + at).collect()
}

pub fn ball(at: Vec3, radius: Real) -> Shape {
    Box::new(move |d| at + d * radius)
}

/// All points within `radius` of the segment.
pub fn capsule(a: Vec3, b: Vec3, radius: Real) -> Shape {
    Box::new(move |d| (if d.dot(&(b - a)) > 0.0 { b } else { a }) + d * radius)
}

pub fn ellipsoid(radii: Vec3, rotation: Rotation, at: Vec3) -> Shape {
    Box::new(move |d| {
        let e = radii.component_mul(&(rotation.inverse() * d));
        rotation * radii.component_mul(&(e / e.norm())) + at
    })
}

/// How many kinds of [`pair`] there are.
pub const KINDS: usize = 10;

/// A pair of unit size whose distance is `gap` (less than zero: the depth).
pub fn pair(kind: usize, gap: Real, r: &mut Random) -> (Shape, Shape) {
    let rot = r.rotation();
    let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
    let cube = placed(&corners(half), &rot, Vec3::zeros());
    let [x, y, up] = [0, 1, 2].map(|i| rot * Vec3::ith(i, 1.0));
    // A point of the cube's upper face.
    let top = x * r.within(-0.9, 0.9) * half.x + y * r.within(-0.9, 0.9) * half.y + up * half.z;
    let lifted = |points: &[Vec3], by: Vec3| points.iter().map(|p| p + by).collect::<Vec<_>>();
    match kind {
        // A vertex over a face.
        0 => {
            let points = r.points(12, 1.0);
            let low = hull(&points)(&-up);
            let points = lifted(&points, top + up * gap - low);
            (hull(&cube), hull(&points))
        }
        // A face on the same face, on a part of it, along an edge, at a corner.
        1..=4 => {
            let shift = match kind {
                1 => Vec3::zeros(),
                2 => x * (0.8 * half.x) + y * (0.3 * half.y),
                3 => x * (2.0 * half.x),
                _ => x * (2.0 * half.x) + y * (2.0 * half.y),
            };
            let other = lifted(&cube, shift + up * (2.0 * half.z + gap));
            (hull(&cube), hull(&other))
        }
        // An edge across an edge.
        5 => {
            let n = unit(&(x + y)).unwrap();
            let edge = n.cross(&up) + up * 0.5;
            let at = x * half.x + y * half.y + n * gap + up * r.within(-0.2, 0.2);
            let other = [at - edge, at + edge, at + n + up, at + n - up];
            (hull(&cube), hull(&other))
        }
        6 => (hull(&cube), ball(top + up * (gap + 0.5), 0.5)),
        7 => (ball(Vec3::zeros(), 1.0), ball(up * (1.5 + gap), 0.5)),
        8 => {
            let at = up * (1.0 + gap) + x * r.within(-0.5, 0.5) + y * r.within(-0.5, 0.5);
            (capsule(-x, x, 0.5), capsule(at - y, at + y, 0.5))
        }
        // Two ellipsoids with a common normal.
        _ => {
            let mut side = |n: Vec3, at: Vec3| {
                let radii = Vec3::from_fn(|_, _| r.within(0.2, 1.0));
                let turn = r.rotation();
                let extreme = ellipsoid(radii, turn, Vec3::zeros())(&n);
                ellipsoid(radii, turn, at - extreme)
            };
            (side(up, Vec3::zeros()), side(-up, up * gap))
        }
    }
}
