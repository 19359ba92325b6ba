// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The contact frame: the contact normal and two axes perpendicular to it.
//!
//! The axes are a fixed pair perpendicular to [`POLE`], rotated by the shortest rotation from POLE to the
//! normal or to its opposite, whichever is closer (Rodrigues' rotation formula). So they rotate no faster than the
//! normal while POLE · normal keeps its sign, and are the same for the swapped objects.

use crate::geometry::polygon::{Vec2, offset};
use crate::math::{POLE, Vec3, larger, lesser};
use crate::minkowski::support::Fault;

/// Unit, perpendicular to [`POLE`]. Chosen so that no two corners of a box with the world's axes are equally far
/// along it.
const AXIS: Vec3 = Vec3::new(37.6 / 61.0, 31.8 / 61.0, -36.0 / 61.0);

/// A frame at a point of a contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactFrame {
    /// The origin, between the support planes of the two objects.
    pub origin: Vec3,
    /// The contact normal, unit.
    pub normal: Vec3,
    /// Unit, perpendicular to the normal and to each other.
    pub axes: [Vec3; 2],
}

impl ContactFrame {
    /// Returns the frame at `origin` with unit `normal`. The axes are those of the head.
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

    /// Returns the frame at the world's origin with unit `normal` whose first axis is the part of `axes[0]`
    /// perpendicular to it, normalised. The second axis keeps the orientation of `axes`, also for the reversed
    /// normal. None if the normal differs from that of `axes`, or from its opposite, by more than 60°.
    pub fn following(normal: &Vec3, axes: &[Vec3; 2]) -> Option<Self> {
        let along = axes[0].cross(&axes[1]).dot(normal);
        let perpendicular = axes[0] - normal * normal.dot(&axes[0]);
        let norm = perpendicular.norm();
        // False for NaN.
        let is_same = [along.abs(), norm].iter().all(|x| *x > 0.5 && *x < 2.0);
        is_same.then(|| {
            let e1 = perpendicular / norm;
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

    /// Returns the unit direction of the normal (`sign` 1) or its opposite (-1), inclined. `slope`: the tangents of
    /// the angles towards the two axes.
    #[inline(always)]
    pub fn inclined_direction(&self, sign: f64, slope: Vec2) -> Vec3 {
        let scale = 1.0 / (1.0 + slope.norm_squared()).sqrt();
        (self.normal * sign + (self.axes[0] * slope.x + self.axes[1] * slope.y)) * scale
    }

    /// Returns the coordinates of a point along both axes and the normal.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn project(&self, p: &Vec3) -> Result<Vec3, Fault> {
        let p = p - self.origin;
        // Fails for NaN too. Beyond this limit squares of squares overflow.
        let square = p.norm_squared();
        if !(square * square).is_finite() {
            return Err(Fault::NonFinite);
        }
        let [e1, e2] = &self.axes;
        Ok(Vec3::new(e1.dot(&p), e2.dot(&p), self.normal.dot(&p)))
    }

    /// Returns the point with these coordinates along the axes, in the plane of the origin.
    #[inline(always)]
    pub fn point(&self, at: Vec2) -> Vec3 {
        self.origin + self.axes[0] * at.x + self.axes[1] * at.y
    }
}

/// Returns the unit direction out of the side from `a` to `b` along which both ends have the same height, if a drop lowers it
/// by `per_drop`; turned by a small `lean` towards `b`.
#[inline(always)]
pub fn outwards(a: &Vec3, b: &Vec3, per_drop: f64, lean: f64) -> Vec2 {
    let side = offset(a, b);
    let per_length = 1.0 / side.norm();
    let along = side * per_length;
    let level = (b.z - a.z) * per_drop * per_length + lean;
    let level = lesser(larger(level, -1.0), 1.0);
    Vec2::new(along.y, -along.x) * (1.0 - level * level).sqrt() + along * level
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Random;

    #[test]
    fn axes_rotate_no_faster_than_the_normal() {
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
