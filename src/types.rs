// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The settings and the result of a query.
//!
//! All guarantees assume convex objects and support functions that return a farthest point. If a query notices that a
//! support function contradicts itself ([`Status::InconsistentSupport`]), `depth_lower` is 0, and `depth` is the least
//! support value of the points that were returned. Moving obj2 by it need not separate the objects.

use crate::math::{ITERATION_CAP, Real, Vec3, lower_to_real};

/// Tolerance, iteration limit and requested results of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest error of the depth or distance, metres, not negative. It is raised to a few units in
    /// the last place of the coordinates, so 0 selects the smallest, and lowered to 2.5e-4 of the size
    /// of the Minkowski difference.
    pub tolerance: f64,
    /// Limit on the support points after the first tetrahedron or portal, in `penetration_planar` on
    /// the portal steps. The library's own limits are 160, 320 for proofs, along a direction and
    /// planar, 380 for distances. No query takes more than 500 support points in the tests.
    pub max_iterations: u64,
    /// True to request the contact position; it is zero otherwise. Costs 2 to 6 support points, at
    /// most 24 for faces of more than four corners, none if a state shows that nothing has moved. May
    /// evaluate one shape without the other.
    pub pos: bool,
    /// True to request the witness points, at no cost; they are zero otherwise.
    pub points: bool,
}

impl Settings {
    /// Returns the settings with this tolerance, metres, the library's iteration limit and every result.
    pub const fn new(tolerance: f64) -> Self {
        Settings {
            tolerance,
            max_iterations: ITERATION_CAP,
            pos: true,
            points: true,
        }
    }
}

impl Default for Settings {
    /// Returns the settings with a tolerance of 0.1 mm, that of CCD_INIT.
    fn default() -> Self {
        Settings::new((1e-4 as Real).into())
    }
}

/// The cause of the end of a search, which tells which outputs are valid. The results are as exact as requested only
/// for [`Status::Converged`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The search ended within the tolerance. All outputs are valid.
    #[default]
    Converged,
    /// `max_iterations` was reached. Depth, directions, bounds and witness points are valid.
    IterationLimit,
    /// The library's own limit of support points was reached. Valid as for [`Status::IterationLimit`].
    SupportLimit,
    /// Rounding ended the search: more support points would not help. Valid as for [`Status::IterationLimit`].
    Rounding,
    /// Two points of a support function contradict each other, or a center is outside its object. The depth is sound for
    /// the points that were returned, nothing is proven, and the lower bound of the depth is 0.
    InconsistentSupport,
}

impl Status {
    /// Returns the status of a search that ended early, with `iterations` left of `max_iterations`, of which the
    /// library allows `cap`.
    pub(crate) fn of_early_end(iterations_left: u64, max_iterations: u64, cap: u64) -> Self {
        match (iterations_left, max_iterations < cap) {
            (0, true) => Status::IterationLimit,
            (0, false) => Status::SupportLimit,
            _ => Status::Rounding,
        }
    }

    /// Returns [`Status::Converged`] if the criterion is met, else this status.
    pub(crate) fn unless(self, is_met: bool) -> Self {
        if is_met { Status::Converged } else { self }
    }
}

/// Depth, direction and position of an overlap, or of the gap of separated objects, whose depth is negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// Metres. Moving obj2 by `depth * dir` separates the objects. Negative only in a signed distance, for separated
    /// objects: minus the lower bound of their distance.
    pub depth: f64,
    /// Proven lower bound of the globally least depth, metres; 0 if none is proven. For separated objects minus the
    /// upper bound of their distance.
    pub depth_lower: f64,
    /// Penetration direction, unit: obj2 moves along it.
    pub dir: Vec3,
    /// Contact normal, unit: normal of the separating plane. Equal to `dir` except in a query along
    /// a given direction.
    pub normal: Vec3,
    /// Contact position; zero if it was not requested.
    pub pos: Vec3,
    /// Witness point on obj1.
    pub point1: Vec3,
    /// Witness point on obj2.
    pub point2: Vec3,
    /// Number of support points, all searches of the query together.
    pub support_points: u64,
    /// Number of iterations of the solver, as [`Settings::max_iterations`] counts them.
    pub iterations: u64,
    /// Why the search ended.
    pub status: Status,
    /// True if `normal` is in general position ([`crate::minkowski::general_position`]).
    pub is_general: bool,
}

impl Penetration {
    /// Returns whether the distance of the witness points is `depth` along the normal, within the tolerance, and
    /// at most sqrt(2 · depth · tolerance) perpendicular to it.
    pub fn has_sound_witnesses(&self, tolerance: f64) -> bool {
        let difference = self.point1 - self.point2;
        let along = difference.dot(&self.normal);
        let perpendicular2 = (difference - self.normal * along).norm_squared();
        (along - self.depth).abs() <= tolerance && perpendicular2 <= 2.0 * self.depth * tolerance
    }

    /// Stores the number of support points, and sets the points that are not requested to zero.
    #[inline(always)]
    pub fn finish(&mut self, support_points: u64, settings: &Settings) {
        self.support_points = support_points;
        if !settings.pos {
            self.pos = Vec3::zeros();
        }
        if !settings.points {
            (self.point1, self.point2) = (Vec3::zeros(), Vec3::zeros());
        }
    }

    /// Returns the lower and the upper bound of the signed distance, metres, rounded outwards; 0 is +0.
    pub fn distance_bounds(&self) -> (Real, Real) {
        (
            lower_to_real(0.0 - self.depth),
            0.0 - lower_to_real(self.depth_lower),
        )
    }

    /// Returns the middle of the witness points.
    pub fn middle(&self) -> Vec3 {
        (self.point1 + self.point2) * 0.5
    }
}
