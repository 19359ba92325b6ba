// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The plane across the normal of a contact, in which the faces of both objects are seen.

use crate::contacts::polygon::{Corner, Flat};
use crate::math::{Vec3, axes};
use crate::minkowski::support::Fault;

/// The plane through `origin` across the unit vector `n`.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub n: Vec3,
    /// Unit, across n and each other.
    pub axes: [Vec3; 2],
    pub origin: Vec3,
}

impl Plane {
    /// Through the world's origin, with axes that turn as little as `n` does.
    pub fn of(n: &Vec3) -> Self {
        Self {
            n: *n,
            axes: axes(n),
            origin: Vec3::zeros(),
        }
    }

    /// The unit direction that looks along the normal (`sign` 1) or against it, tilted `aside`.
    #[inline(always)]
    pub fn direction(&self, sign: f64, aside: &Flat) -> Vec3 {
        let [e1, e2] = &self.axes;
        let share = 1.0 / (1.0 + aside[0] * aside[0] + aside[1] * aside[1]).sqrt();
        (self.n * sign + (e1 * aside[0] + e2 * aside[1])) * share
    }

    /// A point of the object whose face looks along the normal or against it: where it is in the plane, and
    /// how far below it.
    #[inline(always)]
    pub fn corner(&self, sign: f64, p: &Vec3) -> Result<Corner, Fault> {
        let p = p - self.origin;
        // NaN ends here too; beyond that squares of squares overflow.
        let q = p.norm_squared();
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        let [e1, e2] = &self.axes;
        Ok(Corner {
            at: [e1.dot(&p), e2.dot(&p)],
            low: -sign * self.n.dot(&p),
        })
    }

    /// The point at a place of the plane, so high above it.
    #[inline(always)]
    pub fn point(&self, [x, y]: &Flat, height: f64) -> Vec3 {
        let [e1, e2] = &self.axes;
        self.origin + e1 * *x + e2 * *y + self.n * height
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    /// The axes in the plane turn no faster than the normal.
    #[test]
    fn the_plane_turns_with_its_normal() {
        let mut r = Random::new(6);
        for _ in 0..1000 {
            let n = r.direction();
            let m = (n + r.vector(1e-3)).normalize();
            let (p, q) = (Plane::of(&n), Plane::of(&m));
            assert!(p.axes[0].dot(&n).abs() + p.axes[1].dot(&n).abs() < 64.0 * EPSILON);
            assert!((p.axes[0].cross(&p.axes[1]) - n).norm() < 64.0 * EPSILON);
            if n.dot(&Vec3::new(0.36, 0.48, 0.8)) > -0.9 {
                assert!((p.axes[0] - q.axes[0]).norm() < 10.0 * (n - m).norm() + 64.0 * EPSILON);
            }
        }
    }
}
