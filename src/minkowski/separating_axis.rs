// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The axis test for pairs that stay separated: the axis of the last query is evaluated first, and rotated
//! as the objects move.
//!
//! 1. Evaluate the support point s of the axis n. The separation along n is −h(n) = −n·s.
//! 2. If it is less than the target separation, rotate n by one subgradient step with Polyak's step length
//!    (B. Polyak, "Minimization of Unsmooth Functionals", 1969): n − g (h(n) + target) / g², where g, the
//!    part of s perpendicular to n, is the gradient of h.
//! 3. If n did not separate, repeat with the rotated axis, [`MAX_FAILURES`] axes in all.
//!
//! So a pair whose axis rotates slowly takes one support point per query. Without the rotation, pairs that
//! stay separated and turn by 0.1° per frame take 1.29 support points per query (test U14 of
//! `c-tests/tests/stability/costs.c`).
//!
//! Outputs: `Some(n)`: n separates, or the objects touch along n within rounding. `None`: no evaluated axis
//! separates. In both cases `dir` and `target_separation` are the values for the next query; after `None`
//! they are only a guess.

use crate::math::{Vec3, larger, unit};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::tuning::{MAX_FAILURES, MIN_TARGET_REL, TARGET_DECAY};
use crate::trace;

/// An axis that separated the objects.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeparatingAxis {
    /// Unit.
    pub dir: Vec3,
    /// The separation that rotating the axis aims at, metres.
    pub target_separation: f64,
}

impl SeparatingAxis {
    /// Evaluates the axis and, if it does not separate, the rotated axis. Returns the first axis that
    /// separates the objects or along which they touch within rounding; `None` if neither does. `self`
    /// becomes the axis of the next query.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn test<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
    ) -> Result<Option<Vec3>, Fault> {
        trace::stage("separating axis");
        let mut scale = Scale::default();
        for _ in 0..MAX_FAILURES {
            let n = self.dir;
            let point = md.support(&n)?;
            scale.note(&point);
            let separation = -n.dot(&point.v);
            trace::direction(&n, -separation, f64::INFINITY);
            // NaN counts as separated.
            let is_separated = !scale.is_depth(-separation);
            let least = if is_separated {
                0.0
            } else {
                MIN_TARGET_REL * scale.size()
            };
            let kept = TARGET_DECAY * self.target_separation;
            let target = larger(larger(separation, kept), least);
            self.target_separation = target;
            if separation < target {
                let gradient = point.v + n * separation;
                let rotated = n - gradient * ((target - separation) / gradient.norm_squared());
                self.dir = unit(&rotated).unwrap_or(n);
            }
            if is_separated {
                return Ok(Some(n));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, ball, capsule, difference};

    /// Rotates an axis that hardly separates to one that separates by most of the distance.
    #[test]
    fn axis_is_rotated_towards_the_target_separation() {
        let mut r = Random::new(62);
        for _ in 0..200 {
            let gap = r.within(0.05, 1.0);
            let up = r.direction();
            let md = difference(
                capsule(up * -0.6, up * -0.2, 0.2),
                ball(up * (0.2 + gap), 0.2),
            );
            let mut axis = SeparatingAxis {
                dir: (up + r.direction() * 0.3).normalize(),
                target_separation: gap,
            };
            for _ in 0..5 {
                let n = axis.test(&md).unwrap().unwrap();
                assert!(n.dot(&md.support(&n).unwrap().v) <= 0.0);
            }
            let n = axis.dir;
            assert!(-n.dot(&md.support(&n).unwrap().v) >= 0.5 * gap);
        }
    }

    #[test]
    fn no_axis_separates_objects_that_intersect() {
        let mut r = Random::new(63);
        for _ in 0..200 {
            let md = difference(ball(Vec3::zeros(), 1.0), ball(r.direction(), 0.5));
            let (dir, target_separation) = (r.direction(), r.within(0.0, 1.0));
            let mut axis = SeparatingAxis {
                dir,
                target_separation,
            };
            let found = axis.test(&md).unwrap();
            assert!(found.is_none() && (axis.dir.norm() - 1.0).abs() < 1e-12);
        }
    }
}
