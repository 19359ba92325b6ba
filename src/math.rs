// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Scalars and vectors, and the policies that every solver shares: how small a
//! tolerance may be, how many iterations are allowed, what counts as a unit vector.

use nalgebra::{RealField, Vector3};

/// The scalar of the callers: `f64`, or `f32` with feature `single`. The solvers compute in `f64`
/// in both builds; `ffi` and `api` convert.
#[cfg(not(feature = "single"))]
pub type Real = f64;
/// The scalar of the callers: `f64`, or `f32` with feature `single`. The solvers compute in `f64`
/// in both builds; `ffi` and `api` convert.
#[cfg(feature = "single")]
pub type Real = f32;

/// A point or direction in three dimensions, metres.
pub type Vec3 = nalgebra::Vector3<f64>;

/// No vector, where a constant is wanted.
pub const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// Distance from 1 to the next larger [`Real`]: support functions round to it.
pub const EPSILON: f64 = Real::EPSILON as f64;

/// Converts a vector of the caller's.
#[inline(always)]
pub fn from_real(v: [Real; 3]) -> Vec3 {
    v.map(f64::from).into()
}

/// Converts a vector to the caller's scalars.
#[inline(always)]
pub fn to_real(v: &Vec3) -> [Real; 3] {
    [v.x as Real, v.y as Real, v.z as Real]
}

/// Converts a lower bound to the caller's scalar, and never upwards.
#[inline(always)]
pub fn lower_to_real(x: f64) -> Real {
    let near = x as Real;
    if f64::from(near) > x {
        near - Real::EPSILON * near.abs()
    } else {
        near
    }
}

/// Returns `v / |v|`, or `None` when `v` is zero or not finite.
#[inline]
pub fn unit(v: &Vec3) -> Option<Vec3> {
    // 0/0 and ∞/∞ are NaN, and so is then the norm.
    normalised(v).or_else(|| normalised(&(v / largest(v))))
}

/// Returns `v / |v|` of a vector whose length can be squared, else `None`.
#[inline(always)]
pub fn normalised(v: &Vec3) -> Option<Vec3> {
    let n2 = v.norm_squared();
    (n2 > f64::MIN_POSITIVE && n2 < f64::INFINITY).then(|| v * (1.0 / n2.sqrt()))
}

/// The larger of two numbers, the second where one is NaN: one instruction, where `max`
/// takes several to pass over a NaN on either side.
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller of two numbers, the second where one is NaN, as in [`larger`].
#[inline(always)]
pub fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The largest absolute coordinate.
#[inline(always)]
pub fn largest(v: &Vec3) -> f64 {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

/// The normal of the triangle abc, as long as twice its area. Near the end of a search
/// triangles are slivers, and the cross product of two long edges that are almost parallel
/// is mostly rounding error: there the short edge is one of the two.
#[inline]
pub fn normal<T: RealField + Copy>(a: &Vector3<T>, b: &Vector3<T>, c: &Vector3<T>) -> Vector3<T> {
    let [ab, ac, bc] = [b - a, c - a, c - b];
    let [x, y, z] = [&ab, &ac, &bc].map(Vector3::norm_squared);
    let four: T = nalgebra::convert(4.0);
    if four * z < x && four * z < y {
        if x < y { ab.cross(&bc) } else { ac.cross(&bc) }
    } else {
        ab.cross(&ac)
    }
}

/// A unit vector perpendicular to `n`, which need not be unit, but is not zero.
#[inline]
pub fn perpendicular(n: &Vec3) -> Vec3 {
    let a = n.abs();
    // The axis least aligned with n keeps the cross product at least sqrt(2/3) as long.
    let axis = if a.x <= a.y && a.x <= a.z {
        Vec3::x()
    } else if a.y <= a.z {
        Vec3::y()
    } else {
        Vec3::z()
    };
    let p = n.cross(&axis);
    p / p.norm()
}

/// A unit vector that nothing stands along.
pub const POLE: Vec3 = Vec3::new(0.36, 0.48, 0.8);

/// Two unit vectors across the unit vector `n`, and each other, that turn as little as it does: those
/// of a fixed frame, turned the shortest way from [`POLE`].
pub fn axes(n: &Vec3) -> [Vec3; 2] {
    let axis = Vec3::new(0.8, -0.6, 0.0);
    let cosine = 1.0 + POLE.dot(n);
    let e1 = if cosine > 1e-3 {
        axis - (POLE + n) * (axis.dot(n) / cosine)
    } else {
        perpendicular(n)
    };
    let e1 = e1 / e1.norm();
    [e1, n.cross(&e1)]
}

/// The library's own cap on the iterations of a query, whatever the caller allows. A search
/// that comes this far makes no progress: with what is asked before and after, 400 support
/// points are the most that a query takes. Measured (`campaigns -- wide`): of the minima that 360
/// support points do not prove, most are not proven by 1,400.
pub const ITERATION_CAP: u64 = 380;
