// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How large the objects are, as far as their support points tell, and what rounding
//! that means. What is asked through an [`Inquiry`](crate::known::support_set::Inquiry) takes its
//! tolerances from here; the paper's solvers, which keep no sizes, from the point at hand
//! ([`crate::mpr::gao::rounding`]).
//!
//! Two lengths count. The *reach* is the largest distance of a witness from the world's
//! origin: a callback computes its points to about an ulp of it, and so does the
//! difference v1 − v2. The *size* is the largest distance of a point of D from D's origin:
//! arithmetic on points of D rounds to ulps of it. Far from the world's origin the reach is
//! the larger one, and it is never less than half the size (|v| <= |v1| + |v2|).

use crate::math::{self, EPSILON, larger};
use crate::minkowski::support::SupportPoint;

/// Sizes seen so far, and the roundings that follow from them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Precision {
    /// Largest square of a point's distance from the origin of D, m².
    size2: f64,
    /// Largest square of a witness's distance from the world's origin, m².
    reach2: f64,
}

impl Precision {
    /// Takes a point into account.
    #[inline(always)]
    pub fn note(&mut self, point: &SupportPoint) {
        // `larger` is its second number where the first is NaN.
        self.size2 = larger(point.v.norm_squared(), self.size2);
        let reach2 = larger(point.v1.norm_squared(), point.v2.norm_squared());
        self.reach2 = larger(reach2, self.reach2);
    }

    /// Square of [`Precision::size`], m².
    #[inline(always)]
    pub fn size2(&self) -> f64 {
        self.size2
    }

    /// Largest distance of a point of D from the origin, metres.
    #[inline(always)]
    pub fn size(&self) -> f64 {
        self.size2.sqrt()
    }

    /// Square of [`Precision::reach`], m².
    #[inline(always)]
    pub fn reach2(&self) -> f64 {
        self.reach2
    }

    /// Largest distance of a witness from the world's origin, metres.
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        self.reach2.sqrt()
    }

    /// What a point of D is uncertain by, metres: half an ulp for each coordinate of each
    /// witness as the callback rounds it, and of their difference.
    #[inline(always)]
    pub fn grain(&self) -> f64 {
        2.0 * EPSILON * self.reach()
    }

    /// Rounding of a product of a unit vector with a point of D, metres: three products
    /// and two sums, and the unit vector's own length.
    #[inline(always)]
    pub fn rounding(&self) -> f64 {
        4.0 * EPSILON * self.size()
    }

    /// A support value no greater than this is no depth, metres: the objects touch within
    /// rounding, and a touch is a miss, in every query. Four times the grain: the points
    /// and the unit direction are rounded, and a hit must not hang on how.
    #[inline(always)]
    pub fn touch(&self) -> f64 {
        4.0 * self.grain()
    }

    /// Is a support value, metres, greater than [`Precision::touch`]? Told without its root,
    /// for which every step would wait. `false` for NaN.
    #[inline(always)]
    pub fn is_depth(&self, h: f64) -> bool {
        const TOUCH: f64 = 8.0 * EPSILON;
        h > 0.0 && h * h > TOUCH * TOUCH * self.reach2
    }

    /// What two products of one direction with points of D may differ by where the points
    /// are equally far along it, metres: both points and both products are rounded.
    #[inline(always)]
    pub fn tie(&self) -> f64 {
        2.0 * (self.rounding() + 2.0 * self.grain())
    }

    /// The tolerance in force where `asked` is wanted, metres: [`math::tolerance`] of these
    /// sizes, so never below [`Precision::touch`].
    #[inline(always)]
    pub fn tolerance(&self, asked: f64) -> f64 {
        math::tolerance(asked, self.size(), self.reach())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    fn point(v1: Vec3, v2: Vec3) -> SupportPoint {
        SupportPoint { v: v1 - v2, v1, v2 }
    }

    #[test]
    fn sizes_grow_and_follow_the_scale() {
        let mut p = Precision::default();
        p.note(&point(Vec3::new(3.0, 4.0, 0.0), Vec3::zeros()));
        p.note(&point(Vec3::x() * 100.0, Vec3::x() * 99.0));
        assert_eq!((p.size(), p.reach()), (5.0, 100.0));
        assert_eq!(p.tolerance(0.0), 800.0 * EPSILON);
        assert_eq!(p.tolerance(1.0), 2.5e-4 * 5.0);
        assert_eq!(p.tolerance(1e-3), 1e-3);
    }

    #[test]
    fn nan_is_no_size() {
        let mut p = Precision::default();
        p.note(&point(Vec3::x(), Vec3::zeros()));
        p.note(&point(Vec3::repeat(f64::NAN), Vec3::zeros()));
        assert_eq!(p.size(), 1.0);
        assert_eq!(p.tolerance(f64::NAN), 2.5e-4);
    }
}
