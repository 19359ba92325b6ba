// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tolerances of the solvers: the effective tolerance, the contact epsilon, rounding. (The published
//! method, [`crate::paper::gao`], and the contact faces, [`crate::contact::face`], have rounding terms of
//! their own.)
//!
//! All follow from two lengths. The *world extent* is the largest distance of a vertex from the world's
//! origin: callbacks round their points to about an ulp of it, and the difference of two points is rounded
//! to the same. The *size* is the largest distance of a point of D from the origin of D: arithmetic on
//! points of D rounds to ulps of it. The world extent is at least half the size, and larger than the size
//! for objects far from the world's origin.

use crate::math::{EPSILON, larger, lesser};
use crate::minkowski::support::SupportPoint;
use crate::minkowski::tuning::INSERT_HEIGHT_GAPS;

/// The relative tolerance of a default query: the largest gap between the bounds, as a fraction of the depth.
pub const GAP_REL: f64 = 1e-3;
/// The largest effective tolerance, as a fraction of the size of D.
const MAX_TOLERANCE_REL: f64 = 0.25 * GAP_REL;

/// The error of a triple product of points or edges of D, in ulps of the product of their lengths. Derived: 8
/// for the products and their sums. In double precision more is allowed, because support functions are less exact.
/// Measured: those of rotated cylinders return points of the rim that are off by 25 ulps, and each of the three
/// points can be. Not in single precision, where 256 ulps are a depth of 3e-5 of the size.
pub const TRIPLE_PRODUCT_ULPS: f64 = if EPSILON < 1e-10 { 256.0 } else { 8.0 };

/// The largest lengths of a pair so far, and the tolerances that follow from them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scale {
    size2: f64,
    world_extent2: f64,
}

impl Scale {
    /// Takes a point into account.
    #[inline(always)]
    pub fn note(&mut self, point: &SupportPoint) {
        // `larger` returns its second number if the first is NaN.
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
    fn world_extent(&self) -> f64 {
        self.world_extent2.sqrt()
    }

    /// Returns the support epsilon, metres: the error of a point of D. Derived: half an ulp of each
    /// coordinate of each vertex as the callback rounds it, and of their difference.
    #[inline(always)]
    pub fn support_eps(&self) -> f64 {
        2.0 * EPSILON * self.world_extent()
    }

    /// Returns the rounding error of a unit vector times a point of D, metres. Derived: three products, two
    /// sums, and the length of the unit vector.
    #[inline(always)]
    fn product_eps(&self) -> f64 {
        4.0 * EPSILON * self.size()
    }

    /// Returns the height up to which a point counts as on a plane, metres: both are rounded.
    #[inline(always)]
    pub fn height_eps(&self) -> f64 {
        self.product_eps() + 2.0 * self.support_eps()
    }

    /// Returns the largest rounding difference of two equal support values of one direction, metres.
    #[inline(always)]
    pub fn tie_eps(&self) -> f64 {
        2.0 * self.height_eps()
    }

    /// Returns the contact epsilon, metres. Objects with a least support value of at most this are in contact
    /// within rounding, and count as separated in every query.
    #[inline(always)]
    pub fn contact_eps(&self) -> f64 {
        4.0 * self.support_eps()
    }

    /// Returns whether a support value is greater than the contact epsilon; `false` for NaN. Compares squares:
    /// every step of a solver would wait for the square root.
    #[inline(always)]
    pub fn is_depth(&self, h: f64) -> bool {
        const CONTACT: f64 = 8.0 * EPSILON;
        h > 0.0 && h * h > CONTACT * CONTACT * self.world_extent2
    }

    /// Returns the effective tolerance for the `requested` one, metres: it is lowered to [`MAX_TOLERANCE_REL`]
    /// of the size, and raised to the contact epsilon. NaN counts as infinite.
    #[inline(always)]
    pub fn tolerance(&self, requested: f64) -> f64 {
        let lowered = lesser(requested, MAX_TOLERANCE_REL * self.size());
        larger(lowered, self.contact_eps())
    }
}

/// Largest gap between the bounds at which a query stops.
#[derive(Clone, Copy, Debug)]
pub struct GapLimit {
    /// The absolute tolerance that the caller requested, metres.
    pub tolerance: f64,
    /// The relative tolerance as a fraction of the upper bound; 0 for a query that proves the absolute one.
    rel: f64,
}

/// The tolerances of one iteration of a search, metres.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// The gap that is allowed between the upper and the lower bound.
    pub allowed: f64,
    /// The height up to which a point counts as on a plane: [`Scale::height_eps`].
    pub rounding: f64,
    /// The height above which a known difference is taken in place of a support call: [`INSERT_HEIGHT_GAPS`].
    pub insert_height: f64,
}

impl GapLimit {
    /// Makes the limit. `tolerance`: metres. `rel_tol`: a fraction of the lower bound.
    pub const fn new(tolerance: f64, rel_tol: f64) -> Self {
        let rel = rel_tol / (1.0 + rel_tol);
        Self { tolerance, rel }
    }

    /// Returns the gap that is allowed below an upper bound, metres: the larger of the effective tolerance and the
    /// relative one times the lower bound.
    #[inline(always)]
    pub fn allowed(&self, scale: &Scale, upper: f64) -> f64 {
        larger(self.rel * upper, scale.tolerance(self.tolerance))
    }

    /// Returns the tolerances of an iteration with this upper bound, metres.
    #[inline(always)]
    pub fn bounds(&self, scale: &Scale, upper: f64) -> Bounds {
        let (allowed, rounding) = (self.allowed(scale, upper), scale.height_eps());
        Bounds {
            allowed,
            rounding,
            insert_height: rounding + INSERT_HEIGHT_GAPS * allowed,
        }
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
        let eps = scale.contact_eps();
        assert!(!scale.is_depth(0.5 * eps) && scale.is_depth(2.0 * eps));
        assert!(!scale.is_depth(f64::NAN));
    }

    #[test]
    fn nan_changes_no_size_and_is_the_largest_tolerance() {
        let mut scale = Scale::default();
        scale.note(&point(Vec3::x(), Vec3::zeros()));
        scale.note(&point(Vec3::repeat(f64::NAN), Vec3::zeros()));
        assert_eq!(scale.size(), 1.0);
        assert_eq!(scale.tolerance(f64::NAN), 2.5e-4);
    }

    #[test]
    fn the_gap_is_relative_to_the_lower_bound() {
        let gap = GapLimit::new(1e-6, GAP_REL);
        let mut scale = Scale::default();
        scale.note(&point(Vec3::x(), Vec3::zeros()));
        let Bounds {
            allowed,
            rounding,
            insert_height,
        } = gap.bounds(&scale, 1.001);
        assert!((allowed - GAP_REL * (1.001 - allowed)).abs() < 1e-15);
        assert!(rounding == scale.height_eps() && insert_height > INSERT_HEIGHT_GAPS * allowed);
        assert_eq!(gap.allowed(&scale, 1e-5), 1e-6);
    }
}
