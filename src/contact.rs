// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a query answers.

pub mod center_of_pressure;
pub mod feature;
pub mod frame;

use crate::math::Vec3;

/// How much work a query may do, and how exact its depth must be.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Largest error of the depth, metres; already checked to be no NaN and not negative, but
    /// it may be infinite. Solvers floor it at a few ulps of the size they see.
    pub tolerance: f64,
    /// Cap on the iterations of any one loop; at most the library's own cap.
    pub max_iterations: u64,
}

/// How a solver ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// The bounds are as close as wanted.
    #[default]
    Converged,
    /// `max_iterations` came first; the answer is sound.
    IterationLimit,
    /// The library's own limit of support calls came first; the answer is sound.
    SupportLimit,
    /// Rounding ended the search; the answer is sound.
    Rounding,
    /// A callback contradicts itself; nothing is proven.
    InconsistentSupport,
}

/// An overlap: how far, which way, where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// Metres, >= 0. Moving obj2 by `depth * dir` separates the objects.
    pub depth: f64,
    /// Proven lower bound on the global minimum depth; 0 where none is proven.
    pub depth_lower: f64,
    /// Unit; the way obj2 moves.
    pub dir: Vec3,
    /// Unit; normal of the separating plane (equal to `dir` but in a query along
    /// a given direction).
    pub normal: Vec3,
    /// Contact position; zero where nobody asked for it.
    pub pos: Vec3,
    /// Witness point on obj1.
    pub point1: Vec3,
    /// Witness point on obj2.
    pub point2: Vec3,
    /// Iterations of the solver.
    pub iterations: u64,
    /// A cap or rounding came before the tolerance: the best sound answer.
    pub limit: bool,
}

impl Penetration {
    /// Returns whether the witness points are the depth apart along the normal, within the tolerance, and
    /// across it as far as a plane of that tolerance allows.
    pub fn has_sound_witnesses(&self, tolerance: f64) -> bool {
        let apart = self.point1 - self.point2;
        let along = apart.dot(&self.normal);
        let across2 = (apart - self.normal * along).norm_squared();
        (along - self.depth).abs() <= tolerance && across2 <= 2.0 * self.depth * tolerance
    }

    /// The middle of the witness points.
    pub fn middle(&self) -> Vec3 {
        (self.point1 + self.point2) * 0.5
    }
}
