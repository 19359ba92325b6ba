// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Scalars, vectors, normalisation and the largest iteration limit.

use nalgebra::{RealField, Vector3};

/// The scalar of the callers: `f64`, or `f32` with feature `single`. The solvers compute in `f64`
/// in both builds; `ffi` and `api` convert.
#[cfg(not(feature = "single"))]
pub type Real = f64;
/// The scalar of the callers: `f64`, or `f32` with feature `single`. The solvers compute in `f64`
/// in both builds; `ffi` and `api` convert.
#[cfg(feature = "single")]
pub type Real = f32;

/// A point (metres) or a direction.
pub type Vec3 = nalgebra::Vector3<f64>;

/// The zero vector.
pub const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// Distance from 1 to the next larger [`Real`], the precision of support functions.
pub const EPSILON: f64 = Real::EPSILON as f64;

/// Converts a vector from the caller's scalars.
#[inline(always)]
pub fn from_real(v: [Real; 3]) -> Vec3 {
    v.map(f64::from).into()
}

/// Converts a vector to the caller's scalars.
#[inline(always)]
pub fn to_real(v: &Vec3) -> [Real; 3] {
    [v.x as Real, v.y as Real, v.z as Real]
}

/// Converts a lower bound to the caller's scalar, rounding down.
#[inline(always)]
pub fn lower_to_real(x: f64) -> Real {
    let rounded = x as Real;
    if f64::from(rounded) > x {
        rounded - Real::EPSILON * rounded.abs()
    } else {
        rounded
    }
}

/// Returns `v / |v|` for vectors of any length; `None` if `v` is zero or not finite.
#[inline]
pub fn unit(v: &Vec3) -> Option<Vec3> {
    // Squares of tiny and huge vectors under- or overflow; 0/0 and ∞/∞ are NaN.
    normalise_unscaled(v).or_else(|| normalise_unscaled(&(v / max_abs(v))))
}

/// Returns `v / |v|`; `None` if |v|² under- or overflows. Faster than [`unit()`], which scales such vectors.
#[inline(always)]
pub fn normalise_unscaled(v: &Vec3) -> Option<Vec3> {
    let n2 = v.norm_squared();
    (n2 > f64::MIN_POSITIVE && n2 < f64::INFINITY).then(|| v * (1.0 / n2.sqrt()))
}

/// Returns the larger of two numbers, the second if one is NaN. Compiles to one instruction;
/// `max` takes several, because it skips a NaN on either side.
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// Returns the smaller of two numbers, the second if one is NaN, like [`larger`].
#[inline(always)]
pub fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// Returns the largest absolute coordinate.
#[inline(always)]
pub fn max_abs(v: &Vec3) -> f64 {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

/// Returns the normal of the triangle abc; its length is twice the area. For slivers one factor is the
/// shortest edge: the cross product of two long, almost parallel edges is mostly rounding error.
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

/// Returns a unit vector perpendicular to `n`, a nonzero vector of any length.
#[inline]
pub fn perpendicular(n: &Vec3) -> Vec3 {
    let a = n.abs();
    // With the axis least aligned with n the cross product is at least sqrt(2/3) |n|.
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

/// Returns two unit vectors perpendicular to unit `n` and to each other; the second is n × the first.
#[inline(always)]
pub fn tangents(n: &Vec3) -> [Vec3; 2] {
    let e1 = perpendicular(n);
    [e1, n.cross(&e1)]
}

/// Returns `i` if it is below `len`, else another index below it, so that no access is checked.
#[inline(always)]
pub fn index_below(len: usize, i: usize) -> usize {
    if len.is_power_of_two() {
        i & (len - 1)
    } else {
        i.min(len - 1)
    }
}

/// The reference direction of contact frames, unit. Parallel to no axis, face diagonal or space diagonal of a
/// box that is aligned with the world's axes.
pub const POLE: Vec3 = Vec3::new(0.36, 0.48, 0.8);

/// The library's upper limit of [`Settings::max_iterations`](crate::types::Settings). It acts in the
/// query that has no smaller limit of its own: the distance. The other limits, and the sum of
/// support points that a query may take, are at [`MAX_PROVEN_POINTS`](crate::epa::buffers::MAX_PROVEN_POINTS).
/// Measured (`cargo run --release -p lab --bin campaigns -- wide`): most minima that are not proven after 360 support
/// points are not proven after 1,400 either.
pub const ITERATION_CAP: u64 = 380;
