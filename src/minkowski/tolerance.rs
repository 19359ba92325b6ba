// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The one place that decides tolerances: the tolerance in force, the contact epsilon, rounding.
//!
//! Two lengths count. The *reach* is the largest distance of a vertex from the world's origin: a
//! callback rounds its points to about an ulp of it, and so does the difference of two. The *size* is
//! the largest distance of a point of D from the origin of D: arithmetic on points of D rounds to ulps
//! of it. Far from the world's origin the reach is the larger one; it is never less than half the size.

use crate::math::{EPSILON, larger};
use crate::minkowski::support::SupportPoint;

/// The share of the depth that the bounds of a default query may be apart.
pub const GAP_REL: f64 = 1e-3;
/// The share of the size above which no tolerance is in force: a coarser depth tells nothing.
const MAX_TOLERANCE_REL: f64 = 2.5e-4;

/// The error of a triple product of points or edges of D, in ulps of the product of their lengths. Derived: 8
/// for the products and their sums. Measured in double precision: callbacks that rotate a rim round its points
/// by 25 ulps, and each of the three points is off by that. In single precision such a margin would be a
/// depth of 3e-5 of the size.
pub const TRIPLE_PRODUCT_ULPS: f64 = if EPSILON < 1e-10 { 256.0 } else { 8.0 };

/// The largest sizes seen of a pair, and the tolerances that follow from them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scale {
    size2: f64,
    world_extent2: f64,
}

impl Scale {
    /// Takes a point into account.
    #[inline(always)]
    pub fn note(&mut self, point: &SupportPoint) {
        // `larger` returns its second number where the first is NaN.
        self.size2 = larger(point.v.norm_squared(), self.size2);
        let world_extent2 = larger(point.v1.norm_squared(), point.v2.norm_squared());
        self.world_extent2 = larger(world_extent2, self.world_extent2);
    }

    /// Returns the square of [`Scale::size`], m².
    #[inline(always)]
    pub fn size2(&self) -> f64 {
        self.size2
    }

    /// Returns the largest distance of a point of D from its origin, metres.
    #[inline(always)]
    pub fn size(&self) -> f64 {
        self.size2.sqrt()
    }

    /// Returns the largest distance of a vertex from the world's origin, metres.
    #[inline(always)]
    pub fn world_extent(&self) -> f64 {
        self.world_extent2.sqrt()
    }

    /// Returns the support epsilon, metres: what a point of D is uncertain by. Derived: half an ulp for
    /// each coordinate of each vertex as the callback rounds it, and of their difference.
    #[inline(always)]
    pub fn support_eps(&self) -> f64 {
        2.0 * EPSILON * self.world_extent()
    }

    /// Returns the rounding of a unit vector times a point of D, metres. Derived: three products, two
    /// sums, and the length of the unit vector.
    #[inline(always)]
    pub fn product_eps(&self) -> f64 {
        4.0 * EPSILON * self.size()
    }

    /// Returns the height below which a point is on a plane, metres: both are rounded.
    #[inline(always)]
    pub fn height_eps(&self) -> f64 {
        self.product_eps() + 2.0 * self.support_eps()
    }

    /// Returns what two support values of one direction may differ by where they are equal, metres.
    #[inline(always)]
    pub fn tie_eps(&self) -> f64 {
        2.0 * self.height_eps()
    }

    /// Returns the contact epsilon, metres: a support value no greater is no depth. The objects then
    /// touch within rounding, and a touch is a miss, in every query.
    #[inline(always)]
    pub fn contact_eps(&self) -> f64 {
        4.0 * self.support_eps()
    }

    /// Returns whether a support value is greater than the contact epsilon; `false` for NaN. It takes no
    /// root, for which every step would wait.
    #[inline(always)]
    pub fn is_depth(&self, h: f64) -> bool {
        const CONTACT: f64 = 8.0 * EPSILON;
        h > 0.0 && h * h > CONTACT * CONTACT * self.world_extent2
    }

    /// Returns the tolerance in force where `requested` is wanted, metres: no finer than the contact
    /// epsilon, no coarser than [`MAX_TOLERANCE_REL`] of the size. NaN counts as infinite.
    #[inline(always)]
    pub fn tolerance(&self, requested: f64) -> f64 {
        requested
            .min(MAX_TOLERANCE_REL * self.size())
            .max(self.contact_eps())
    }
}

/// Largest gap between the bounds at which a query stops.
#[derive(Clone, Copy, Debug)]
pub struct GapLimit {
    /// Metres, as the caller wants it.
    pub tolerance: f64,
    /// The share of the depth; 0 for a query that proves the tolerance.
    pub share: f64,
}

impl GapLimit {
    /// Returns the gap allowed below an upper bound, metres; `tolerance` is the one in force. A share of
    /// the lower bound, which is the smaller one.
    #[inline(always)]
    pub fn allowed(&self, upper: f64, tolerance: f64) -> f64 {
        larger(self.share / (1.0 + self.share) * upper, tolerance)
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
    fn sizes_grow_and_tolerances_follow() {
        let mut scale = Scale::default();
        scale.note(&point(Vec3::new(3.0, 4.0, 0.0), Vec3::zeros()));
        scale.note(&point(Vec3::x() * 100.0, Vec3::x() * 99.0));
        assert_eq!((scale.size(), scale.world_extent()), (5.0, 100.0));
        assert_eq!(scale.tolerance(0.0), scale.contact_eps());
        assert_eq!(scale.tolerance(1.0), 2.5e-4 * 5.0);
        assert_eq!(scale.tolerance(1e-3), 1e-3);
        let touch = scale.contact_eps();
        assert!(!scale.is_depth(0.5 * touch) && scale.is_depth(2.0 * touch));
        assert!(!scale.is_depth(f64::NAN));
    }

    #[test]
    fn nan_is_no_size_and_no_tolerance() {
        let mut scale = Scale::default();
        scale.note(&point(Vec3::x(), Vec3::zeros()));
        scale.note(&point(Vec3::repeat(f64::NAN), Vec3::zeros()));
        assert_eq!(scale.size(), 1.0);
        assert_eq!(scale.tolerance(f64::NAN), 2.5e-4);
    }

    #[test]
    fn the_gap_is_a_share_of_the_lower_bound() {
        let gap = GapLimit {
            tolerance: 1e-6,
            share: GAP_REL,
        };
        let allowed = gap.allowed(1.001, 1e-6);
        assert!((allowed - GAP_REL * (1.001 - allowed)).abs() < 1e-15);
        assert_eq!(gap.allowed(1e-5, 1e-6), 1e-6);
    }
}
