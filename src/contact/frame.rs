// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The contact frame: the contact normal and two axes across it.

use crate::contact::polygon::Vec2;
use crate::math::{POLE, Vec3};
use crate::minkowski::support::Fault;

/// Unit, across [`POLE`]: of a box whose axes are the world's no two corners are equally far along it.
const AXIS: Vec3 = Vec3::new(37.6 / 61.0, 31.8 / 61.0, -36.0 / 61.0);

/// A frame at a point of a contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactFrame {
    /// The origin, between the support planes of the two objects.
    pub origin: Vec3,
    /// The contact normal, unit.
    pub normal: Vec3,
    /// Unit, across the normal and each other.
    pub axes: [Vec3; 2],
}

impl ContactFrame {
    /// Returns the frame at `origin` across unit `normal`. Its axes are a fixed pair, turned the shortest way
    /// from [`POLE`] to the normal or against it, whichever is closer: they turn as little as the normal
    /// does, and are the same for the objects swapped.
    #[inline(always)]
    pub fn new(normal: &Vec3, origin: &Vec3) -> Self {
        let n = normal * if POLE.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        let e1 = AXIS - (POLE + n) * (AXIS.dot(&n) / (1.0 + POLE.dot(&n)));
        Self {
            origin: *origin,
            normal: *normal,
            axes: [e1, n.cross(&e1)],
        }
    }

    /// Returns the frame at the world's origin across unit `normal` whose first axis is the part of `axes[0]` across
    /// it; a point is on the same side of that as with `axes`, also where the normal is turned round. None where the
    /// axes have no plane that is within 60° of it.
    pub fn following(normal: &Vec3, axes: &[Vec3; 2]) -> Option<Self> {
        let along = axes[0].cross(&axes[1]).dot(normal);
        let across = axes[0] - normal * normal.dot(&axes[0]);
        let norm = across.norm();
        // NaN is no axis.
        let is_same = [along.abs(), norm].iter().all(|x| *x > 0.5 && *x < 2.0);
        is_same.then(|| {
            let e1 = across / norm;
            Self {
                origin: Vec3::zeros(),
                normal: *normal,
                axes: [e1, normal.cross(&e1) * along.signum()],
            }
        })
    }

    /// Returns whether the axes and the normal are right-handed.
    pub fn is_right_handed(&self) -> bool {
        self.axes[0].cross(&self.axes[1]).dot(&self.normal) > 0.0
    }

    /// Returns the unit direction along the normal (`sign` 1) or against it (-1), tilted by two
    /// tangents.
    #[inline(always)]
    pub fn tilted_direction(&self, sign: f64, tilt: Vec2) -> Vec3 {
        let share = 1.0 / (1.0 + tilt.norm_squared()).sqrt();
        (self.normal * sign + (self.axes[0] * tilt.x + self.axes[1] * tilt.y)) * share
    }

    /// Returns how far a point is from the origin along each axis and along the normal.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn project(&self, p: &Vec3) -> Result<Vec3, Fault> {
        let p = p - self.origin;
        // NaN ends here too; beyond that squares of squares overflow.
        let square = p.norm_squared();
        if !(square * square).is_finite() {
            return Err(Fault::NonFinite);
        }
        let [e1, e2] = &self.axes;
        Ok(Vec3::new(e1.dot(&p), e2.dot(&p), self.normal.dot(&p)))
    }

    /// Returns the point that is so far from the origin along the axes.
    #[inline(always)]
    pub fn point(&self, at: Vec2) -> Vec3 {
        self.origin + self.axes[0] * at.x + self.axes[1] * at.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    #[test]
    fn the_axes_turn_no_faster_than_the_normal() {
        let mut r = Random::new(6);
        for _ in 0..1000 {
            let n = r.direction();
            let m = (n + r.vector(1e-3)).normalize();
            let [f, g, h] = [n, m, -n].map(|n| ContactFrame::new(&n, &Vec3::zeros()));
            let [e1, e2] = f.axes;
            let products = [e1.dot(&n), e2.dot(&n), e1.dot(&e2), e1.norm() - 1.0];
            assert!(products.iter().all(|x| x.abs() < 1e-14), "{products:?}");
            assert_eq!(f.axes, h.axes);
            for normal in [m, -m] {
                let next = ContactFrame::following(&normal, &f.axes).unwrap();
                assert_eq!(next.is_right_handed(), f.is_right_handed() == (normal == m));
                let turned = [0, 1].map(|i| (next.axes[i] - f.axes[i]).norm());
                assert!(
                    turned.iter().all(|x| *x < 3.0 * (n - m).norm()),
                    "{turned:?}"
                );
            }
            if POLE.dot(&n) * POLE.dot(&m) > 0.0 {
                assert!((e1 - g.axes[0]).norm() < 3.0 * (n - m).norm() + 1e-14);
            }
        }
    }
}
