// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Support functions, and the Minkowski difference D = obj1 − obj2 that every solver works on
//! (W. Gao, 2023, Sec. II-A and II-B, see [`crate::paper::gao`]).

use core::cell::Cell;

use crate::geometry::barycentric;
use crate::math::{Vec3, larger, max_abs};

/// A convex object, given by its support function.
pub trait SupportMap {
    /// Returns a point of the object farthest along `dir` (unit, finite).
    fn support(&self, dir: &Vec3) -> Vec3;
}

impl<F: Fn(&Vec3) -> Vec3> SupportMap for F {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        self(dir)
    }
}

/// A point of D, and the points of the objects whose difference it is: a support point with its two vertices, or a point
/// between such points or of the centers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SupportPoint {
    /// `v1 - v2`, the point of D.
    pub v: Vec3,
    /// The point of obj1; of a support point, its vertex along the evaluated direction.
    pub v1: Vec3,
    /// The point of obj2; of a support point, its vertex along the opposite direction.
    pub v2: Vec3,
}

impl SupportPoint {
    /// Pairs a point of obj1 and a point of obj2.
    #[inline(always)]
    pub fn new(v1: Vec3, v2: Vec3) -> Self {
        let v = v1 - v2;
        Self { v, v1, v2 }
    }

    /// Returns the largest absolute coordinate of `v1` and `v2`, metres: the rounding error of `v` is proportional to it.
    #[inline]
    pub fn magnitude(&self) -> f64 {
        larger(max_abs(&self.v1), max_abs(&self.v2))
    }

    /// Returns the point at parameter `t` (0 to 1) of the segment to `other`.
    #[inline]
    pub fn towards(&self, other: &Self, t: f64) -> Self {
        Self {
            v: self.v.lerp(&other.v, t),
            v1: self.v1.lerp(&other.v1, t),
            v2: self.v2.lerp(&other.v2, t),
        }
    }
}

/// Returns the weighted means of the points of obj1 and of those of obj2. Their difference is the weighted mean
/// of the points of D.
#[inline]
pub fn witnesses<const N: usize>(weights: &[f64; N], points: [&SupportPoint; N]) -> (Vec3, Vec3) {
    (
        barycentric::mix(weights, points.map(|p| &p.v1)),
        barycentric::mix(weights, points.map(|p| &p.v2)),
    )
}

/// Cause of a query without a result. The caller's state is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// A support function returned a point that is not finite, or the fourth power of its distance from
    /// a point of the other shape overflows (above 1e77 m).
    NonFinite,
    /// An allocation failed.
    NoMemory,
    /// An argument or a callback is missing, or a flag is unknown.
    Missing,
    /// The tolerance is negative or NaN.
    Tolerance,
    /// A center is not finite.
    Center,
    /// A direction is zero or not finite.
    Direction,
    /// A margin is negative or not finite, or the largest distance is negative or NaN.
    DistanceOptions,
    /// The slop is negative or NaN, or there is no room for a contact.
    ContactOptions,
}

/// D = obj1 − obj2, evaluated by its support function; counts the calls. Variables of this type are
/// called `md`.
pub struct MinkowskiDifference<A, B> {
    obj1: A,
    obj2: B,
    /// The number of calls of both objects' support functions.
    calls: Cell<u64>,
    /// True if a query has found points that contradict each other.
    is_contradicted: Cell<bool>,
}

/// The Minkowski difference of two objects, by what queries ask of it.
pub trait Difference {
    /// Returns the support point of D along `dir` (unit, finite). Evaluates obj1 along `dir`, then
    /// obj2 along `-dir`.
    ///
    /// # Errors
    /// `Fault::NonFinite`.
    fn support(&self, dir: &Vec3) -> Result<SupportPoint, Fault>;

    /// Returns the support point of one object for direction `dir` of D: of obj1 along `dir` if `object` is
    /// 0, else of obj2 along `-dir`. It is not tested for finite coordinates.
    fn support_of_object(&self, object: usize, dir: &Vec3) -> Vec3;

    /// Returns whether a query has noted a contradiction.
    fn is_contradicted(&self) -> bool;

    /// Notes that two points contradict each other: a support function is wrong in a direction that was evaluated as it
    /// is, so that later queries tilt all directions.
    fn note_contradiction(&self);

    /// Returns the number of support points evaluated: half the number of calls, rounded up.
    fn supports(&self) -> u64;
}

impl<A: SupportMap, B: SupportMap> MinkowskiDifference<A, B> {
    /// Makes the difference of two objects, without evaluations.
    pub fn new(obj1: A, obj2: B) -> Self {
        Self {
            obj1,
            obj2,
            calls: Cell::new(0),
            is_contradicted: Cell::new(false),
        }
    }
}

impl<A: SupportMap, B: SupportMap> Difference for MinkowskiDifference<A, B> {
    #[inline]
    fn support(&self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        self.calls.set(self.calls.get() + 2);
        let v1 = self.obj1.support(dir);
        let v2 = self.obj2.support(&-dir);
        let v = v1 - v2;
        // Solvers multiply four lengths, so a point for which that product overflows counts as infinite.
        // NaN and infinity in v1 or v2 fail this test too.
        let q = v.norm_squared();
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        Ok(SupportPoint { v, v1, v2 })
    }

    #[inline]
    fn support_of_object(&self, object: usize, dir: &Vec3) -> Vec3 {
        self.calls.set(self.calls.get() + 1);
        match object {
            0 => self.obj1.support(dir),
            _ => self.obj2.support(&-dir),
        }
    }

    #[inline(always)]
    fn is_contradicted(&self) -> bool {
        self.is_contradicted.get()
    }

    fn note_contradiction(&self) {
        self.is_contradicted.set(true);
    }

    #[inline]
    fn supports(&self) -> u64 {
        self.calls.get().div_ceil(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::test_shapes::Random;

    #[test]
    fn witnesses_differ_by_the_point() {
        let mut r = Random::new(33);
        for _ in 0..1000 {
            // Far from the world's origin.
            let base = r.vector(1e3);
            let points = [0; 3].map(|_| {
                let (v1, v2) = (base + r.vector(1.0), base + r.vector(1.0));
                SupportPoint { v: v1 - v2, v1, v2 }
            });
            let [a, b, c] = &points;
            let found = barycentric::triangle(&Vec3::zeros(), &a.v, &b.v, &c.v);
            let (p1, p2) = witnesses(&found.weights, [a, b, c]);
            assert!((p1 - p2 - found.point).norm() <= 1e3 * 8.0 * EPSILON);
        }
    }
}
