// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The separating axis of a pair that stays apart: queried first, and turned as the objects move.
//!
//! A support point s of the axis n tells how to turn it: h(n) = −margin is to fall to −aim, its gradient is
//! g, the part of s across n, and the step −g (h + aim) / g² is Polyak's (B. Polyak, "Minimization of
//! Unsmooth Functionals", 1969). So an axis that turns is followed at one support call a query. Measured on
//! pairs that stay apart and turn by 0.1° a frame (`costs`, U14): 1.29 support calls a query without.

use crate::math::{Vec3, larger, unit};
use crate::minkowski::query::SupportQuery;
use crate::minkowski::support::{Fault, SupportMap};

/// Axes tried before a pair is queried as if it were new.
const MAX_TRIES: u32 = 2;
/// The share of the last aim that is aimed at next, where the margin is less. Insensitive: 0.8 to 0.99, at
/// most 0.3 % of the support points of recorded contacts.
const KEPT_AIM: f64 = 0.95;
/// The share of the size that is aimed at, at least, where an axis has failed. Measured: 0.01 costs as much
/// as none for a cylinder over a box.
const MIN_AIM_REL: f64 = 0.0035;

/// An axis that separated the objects.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeparatingAxis {
    /// Unit.
    pub dir: Vec3,
    /// The margin that it is to separate them by, metres.
    pub aim: f64,
}

impl SeparatingAxis {
    /// Queries the axis, and what it is turned to where it does not separate. Returns the axis that separates,
    /// or touches within rounding, `None` where none does. `self` becomes the axis for the next query.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    pub fn test<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut SupportQuery<'_, A, B>,
    ) -> Result<Option<Vec3>, Fault> {
        for _ in 0..MAX_TRIES {
            let n = self.dir;
            let point = query.evaluate_point(&n)?;
            let margin = -n.dot(&point.v);
            // NaN separates.
            let is_apart = !query.scale.is_depth(-margin);
            let least = if is_apart {
                0.0
            } else {
                MIN_AIM_REL * query.scale.size()
            };
            self.aim = larger(larger(margin, KEPT_AIM * self.aim), least);
            if margin < self.aim {
                let g = point.v + n * margin;
                let turned = n - g * ((self.aim - margin) / g.norm_squared());
                self.dir = unit(&turned).unwrap_or(n);
            }
            if is_apart {
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

    /// An axis that hardly separates is turned to one that separates by most of the distance.
    #[test]
    fn an_axis_follows_the_objects() {
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
                aim: gap,
            };
            let mut query = SupportQuery::new(&md, None);
            for _ in 0..5 {
                let n = axis.test(&mut query).unwrap().unwrap();
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
            let (dir, aim) = (r.direction(), r.within(0.0, 1.0));
            let mut axis = SeparatingAxis { dir, aim };
            let found = axis.test(&mut SupportQuery::new(&md, None)).unwrap();
            assert!(found.is_none() && (axis.dir.norm() - 1.0).abs() < 1e-12);
        }
    }
}
