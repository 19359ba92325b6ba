// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Settings and results of the solvers, and the contact position.

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
    /// Largest error of the depth, metres; not negative and not NaN, but possibly infinite. Solvers
    /// floor it at a few ulps of the size of the objects.
    pub tolerance: f64,
    /// Limit on the iterations of any loop; at most `ITERATION_CAP`.
    pub max_iterations: u64,
}

/// Cause of a solver's end. The depth is sound with all but the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// The gap between the bounds is within the tolerance.
    #[default]
    Converged,
    /// `max_iterations` was reached.
    IterationLimit,
    /// The library's limit of support points was reached.
    SupportLimit,
    /// Rounding ended the search.
    Rounding,
    /// A support function contradicts itself; nothing is proven.
    InconsistentSupport,
}

/// An overlap: depth, direction, position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// Metres, >= 0. Moving obj2 by `depth * dir` separates the objects.
    pub depth: f64,
    /// Proven lower bound of the globally least depth, metres; 0 where none is proven.
    pub depth_lower: f64,
    /// Penetration direction, unit: obj2 moves along it.
    pub dir: Vec3,
    /// Contact normal, unit: normal of the separating plane. Equal to `dir` except in a query along
    /// a given direction.
    pub normal: Vec3,
    /// Contact position; zero where it was not requested.
    pub pos: Vec3,
    /// Witness point on obj1.
    pub point1: Vec3,
    /// Witness point on obj2.
    pub point2: Vec3,
    /// Number of iterations of the solver.
    pub iterations: u64,
    /// A limit or rounding ended the search before the tolerance was met.
    pub limit: bool,
}

impl Penetration {
    /// Returns whether the witness points are `depth` apart along the normal within the tolerance, and
    /// perpendicular to it no more than sqrt(2 · depth · tolerance).
    pub fn has_sound_witnesses(&self, tolerance: f64) -> bool {
        let difference = self.point1 - self.point2;
        let along = difference.dot(&self.normal);
        let across2 = (difference - self.normal * along).norm_squared();
        (along - self.depth).abs() <= tolerance && across2 <= 2.0 * self.depth * tolerance
    }

    /// Returns the middle of the witness points.
    pub fn middle(&self) -> Vec3 {
        (self.point1 + self.point2) * 0.5
    }
}
