// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The settings of a query; its [`Solution`], as the solvers compute it; and the records that callers get: [`Penetration`],
//! [`Distance`] and [`Contact`], in the callers' scalar. Here alone results are rounded to it. The C structs of
//! `ffi/warm/` are copies of the records.
//!
//! All guarantees assume convex objects and support functions that return a farthest point. If a query notices that a
//! support function contradicts itself ([`Status::InconsistentSupport`]), `depth_lower` is 0, and `depth` is the least
//! support value of the points that were returned. Moving obj2 by it need not separate the objects.

use crate::math::{ITERATION_CAP, Real, Vec3, lower_to_real, to_real};

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
    /// most 24 for faces of more than four corners, also of a pair at rest. May evaluate one shape
    /// without the other.
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
    /// Returns the status of a search that ended early, with `iterations_left` of `max_iterations`, of which the library
    /// allows `cap`.
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

/// A direction of D, and by how much it was tilted into general position
/// ([`general_position`](crate::minkowski::general_position)).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Direction {
    /// Unit.
    pub n: Vec3,
    /// Radians; 0 if it was not tilted. A number, because a `bool` would hold the variant of a `Result`: codegen, see
    /// README.
    pub tilt: f64,
}

impl Direction {
    /// Returns whether the direction is in general position.
    #[inline(always)]
    pub fn is_general(&self) -> bool {
        self.tilt > 0.0
    }
}

/// Depth, direction and position of an overlap, or of the gap of separated objects, whose depth is negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solution {
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
    /// True if `normal` is in general position. Not a [`Direction`]: codegen, see README.
    pub is_general: bool,
    /// The radii of the sphere fits of obj1 and obj2, metres, for the state of the next query; 0 unless a prediction was
    /// confirmed.
    pub radius: [f64; 2],
}

impl Solution {
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

    /// Returns the middle of the witness points.
    pub fn middle(&self) -> Vec3 {
        (self.point1 + self.point2) * 0.5
    }
}

/// Result of a penetration query: an overlap. A depth is sound if moving the second shape by
/// `depth * dir` separates the two; it may exceed the least depth.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Penetration {
    /// Penetration depth, metres, >= 0: moving the second shape by `depth * dir` separates the two.
    pub depth: Real,
    /// Lower bound of the globally least depth (in [`penetration_along`](crate::penetration_along): of the depth along its
    /// direction), metres; 0 if there is none. Proven if the centers lie in their shapes; only
    /// [`penetration_proven`](crate::penetration_proven) does not rely on them.
    pub depth_lower: Real,
    /// Penetration direction, unit: the second shape moves along it.
    pub dir: [Real; 3],
    /// Contact normal, unit: normal of the separating plane. Equal to `dir` except in
    /// [`penetration_along`](crate::penetration_along).
    pub normal: [Real; 3],
    /// Contact position, [`Settings::pos`]: the center of pressure, an estimate of the centroid of the
    /// overlap volume, projected along `normal` to the plane midway between the two support planes; the
    /// deeper the overlap, the nearer it is instead to a point between the centers, beside that plane.
    /// If `status` is not converged, and in [`penetration_along`](crate::penetration_along) and
    /// [`penetration_planar`](crate::penetration_planar), the middle of the witness points.
    pub pos: [Real; 3],
    /// Witness point of the first shape, [`Settings::points`]: in the shape and on its support plane,
    /// within the larger of the error of the depth and 1e-12 of the size (1e-5 in single precision).
    pub point1: [Real; 3],
    /// Witness point of the second shape, [`Settings::points`]: as `point1`.
    pub point2: [Real; 3],
    /// Number of support points: half of the calls of both shapes' [`Shape::support`](crate::Shape::support) together,
    /// rounded up.
    pub support_points: u64,
    /// Number of iterations of the solver.
    pub iterations: u64,
    /// Why the search ended; the result is less exact than requested unless this is
    /// [`Status::Converged`].
    pub status: Status,
}

impl From<Solution> for Penetration {
    #[inline(always)]
    fn from(hit: Solution) -> Self {
        Self {
            depth: hit.depth as Real,
            depth_lower: lower_to_real(hit.depth_lower),
            dir: to_real(&hit.dir),
            normal: to_real(&hit.normal),
            pos: to_real(&hit.pos),
            point1: to_real(&hit.point1),
            point2: to_real(&hit.point2),
            support_points: hit.support_points,
            iterations: hit.iterations,
            status: hit.status,
        }
    }
}

/// Result of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Distance {
    /// Proven lower bound of the signed distance, metres: the gap along `normal`, or minus the depth
    /// if the shapes overlap.
    pub distance: Real,
    /// Proven upper bound of the signed distance, metres; at most the tolerance above `distance`
    /// if `status` is converged, unless `distance` is above `max_distance`.
    pub distance_upper: Real,
    /// Unit, from the first shape to the second: moving the second along it increases the distance.
    pub normal: [Real; 3],
    /// Witness point on the surface of the first shape with its margin, [`Settings::points`].
    pub point1: [Real; 3],
    /// Witness point on the surface of the second shape with its margin, [`Settings::points`].
    pub point2: [Real; 3],
    /// Number of support points: half of the calls of both shapes' [`Shape::support`](crate::Shape::support) together,
    /// rounded up.
    pub support_points: u64,
    /// Number of iterations of the solver.
    pub iterations: u64,
    /// Why the search ended; the bounds may differ by more than the tolerance, and the overlap may be
    /// undecided (`distance < 0 < distance_upper`), unless this is [`Status::Converged`].
    pub status: Status,
}

impl From<Solution> for Distance {
    /// Rounds the bounds outwards; 0 is +0.
    #[inline(always)]
    fn from(found: Solution) -> Self {
        Self {
            distance: lower_to_real(0.0 - found.depth),
            distance_upper: 0.0 - lower_to_real(found.depth_lower),
            normal: to_real(&found.normal),
            point1: to_real(&found.point1),
            point2: to_real(&found.point2),
            support_points: found.support_points,
            iterations: found.iterations,
            status: found.status,
        }
    }
}

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Point within the slop of the surface of the first shape.
    pub point1: [Real; 3],
    /// `point1 - depth * normal`, a point within the slop of the surface of the second shape. If the
    /// faces do not overlap in projection, the closest point of the second shape's face instead.
    pub point2: [Real; 3],
    /// Depth at the contact, metres; negative if the shapes are apart there.
    pub depth: Real,
    /// Contact id: the same while the contact moves with either shape, never 0; 0 without a cache. When a contact vanishes, a new
    /// one within a quarter of the overlap's extent takes its id.
    pub id: u32,
}
