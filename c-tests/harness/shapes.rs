// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Support functions for the unit tests: closures, so that `cargo test --lib` needs no C compiler and
//! Miri can run it. (The shapes of the C tests: `c-tests/harness/shapes.h`.)

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::math::{Vec3, unit};
use crate::minkowski::support::{MinkowskiDifference, SupportMap};

pub type Rotation = nalgebra::Rotation3<f64>;

/// Shape of any kind: the solvers are compiled once.
pub type Shape<'a> = Box<dyn Fn(&Vec3) -> Vec3 + 'a>;

/// Returns the Minkowski difference of two bodies.
pub fn difference<'a>(
    a: impl SupportMap + 'a,
    b: impl SupportMap + 'a,
) -> MinkowskiDifference<Shape<'a>, Shape<'a>> {
    MinkowskiDifference::new(
        Box::new(move |d: &Vec3| a.support(d)),
        Box::new(move |d: &Vec3| b.support(d)),
    )
}

/// Random numbers, the same on every machine.
pub struct Random(Pcg64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0.random_range(low..high)
    }

    pub fn vector(&mut self, size: f64) -> Vec3 {
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

    /// Returns `n` points on a sphere.
    pub fn points(&mut self, n: usize, radius: f64) -> Vec<Vec3> {
        (0..n).map(|_| self.direction() * radius).collect()
    }
}

/// Returns the hull of the points.
pub fn hull(points: &[Vec3]) -> Shape<'static> {
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

/// Returns the corners of a box with these half extents about the origin.
pub fn corners(half: Vec3) -> Vec<Vec3> {
    (0..8)
        .map(|i| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            half.component_mul(&Vec3::new(sign(1), sign(2), sign(4)))
        })
        .collect()
}

/// Moves points rigidly.
pub fn placed(points: &[Vec3], rotation: &Rotation, at: Vec3) -> Vec<Vec3> {
    points.iter().map(|p| rotation * p + at).collect()
}

pub fn ball(at: Vec3, radius: f64) -> Shape<'static> {
    Box::new(move |d| at + d * radius)
}

/// Returns the points within `radius` of a segment.
pub fn capsule(a: Vec3, b: Vec3, radius: f64) -> Shape<'static> {
    Box::new(move |d| (if d.dot(&(b - a)) > 0.0 { b } else { a }) + d * radius)
}

pub fn ellipsoid(radii: Vec3, rotation: Rotation, at: Vec3) -> Shape<'static> {
    Box::new(move |d| {
        let e = radii.component_mul(&(rotation.inverse() * d));
        rotation * radii.component_mul(&(e / e.norm())) + at
    })
}
