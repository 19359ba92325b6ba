// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Settings and results of the solvers, the contact position and the contact manifold.
//!
//! All guarantees assume convex objects and support functions that return a farthest point. If the global query
//! notices that a support function contradicts itself ([`Status::InconsistentSupport`]), it sets
//! [`Penetration::limit`]: `depth_lower` is then 0, and `depth` is the least support value of the points that the
//! support functions returned when each direction was evaluated twice. Moving obj2 by it need not separate the objects.

pub mod center_of_pressure;
pub mod face;
pub mod feature;
pub mod fixed_vec;
pub mod frame;
pub mod manifold;
pub mod manifold_cache;
pub mod polygon;

use crate::math::Vec3;

/// The tolerance and the limits of a query.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Largest error of the depth, metres; not negative and not NaN, but possibly infinite. Solvers clamp it
    /// (`Scale::tolerance`).
    pub tolerance: f64,
    /// Limit on the iterations of a query, all stages together; at most `ITERATION_CAP`.
    /// An iteration is a support point after the first tetrahedron or portal: one that expands a polytope, or that
    /// refines or confirms a face in the local search. In `along`, `planar` and `incremental` it is a step of portal
    /// discovery or refinement, or a change of the ray; in a distance any support point, and the depth of objects
    /// that overlap is counted anew. Support points that decide whether the objects overlap are not limited, except
    /// in a distance.
    pub max_iterations: u64,
}

/// Cause of a solver's end. The depth is sound for all causes except [`Status::InconsistentSupport`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// The gap between the bounds is within the tolerance.
    #[default]
    Converged,
    /// `max_iterations` was reached.
    IterationLimit,
    /// The library's own limit of support points was reached.
    SupportLimit,
    /// Rounding ended the search.
    Rounding,
    /// A support function contradicts itself, or (local search only) a center is outside its object. Nothing is
    /// proven.
    InconsistentSupport,
}

/// An overlap: depth, direction, position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// Metres, >= 0. Moving obj2 by `depth * dir` separates the objects.
    pub depth: f64,
    /// Proven lower bound of the globally least depth, metres; 0 if none is proven.
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
    /// Number of iterations of the solver, as [`Settings::max_iterations`] counts them.
    pub iterations: u64,
    /// True if a limit, rounding or an inconsistent support function ended the search before the tolerance was met.
    pub limit: bool,
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

    /// Returns the middle of the witness points.
    pub fn middle(&self) -> Vec3 {
        (self.point1 + self.point2) * 0.5
    }
}
