// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tilts the directions of a search into general position.
//!
//! Some support functions are wrong in directions of a symmetry. ODE's cylinder divides the part of the direction across
//! its axis by the length of that part, which is rounding noise within 1e-15 rad of the axis: the point is off by up to
//! the radius, along the axis too. A search evaluates just such directions, because they are the normals of faces.
//! Therefore n + tilt · ω × n is evaluated in place of n, and stored as the direction of the sample; ω is a fixed vector.
//! Ties between the vertices of parallel faces are broken in the same way each time, too. This is the perturbation of
//! computational geometry (H. Edelsbrunner, E. Mücke, "Simulation of Simplicity", 1990) with a number for the symbol.
//!
//! 1. *Vector.* No ω turns the directions parallel to it. Two are in use, chosen by the z of n ([`MAX_POLE_Z`]).
//! 2. *Size.* The support value of the tilted direction is at most tilt · size above that of n, a rise that
//!    [`MAX_RISE_TOLERANCES`] limits. The error that such a callback has left is about 7e-16 / tilt times the radius, so a
//!    tilt below [`MIN_TILT_RAD`] is of no use.
//! 3. *Confirmation.* If the tolerance allows no tilt, directions are evaluated as they are, and a separation or a
//!    result counts only if it and one more direction, tilted by [`MIN_TILT_RAD`], do not contradict each other
//!    ([`SupportQuery::confirm_upper`](crate::minkowski::support_query::SupportQuery::confirm_upper)). If they do, the query runs again
//!    with the least tilt, whatever the tolerance ([`Pair::run`](crate::query::Pair::run)).
//! 4. *Memory.* The direction of a state is evaluated as it is if it is in general position, so that a pair at rest does
//!    not turn; otherwise it is tilted.
//!
//! Measured: wrong answers in ODE's pile (`compare.sh --swap`, 26,000 queries of `ode_pile`, two starts, any size of D),
//! mean error of the depth, support points:
//!
//! | tilt, rad | 0 | 1e-9 | 3e-9 | 1e-8 | 1e-7 | 1e-6 |
//! |---|---|---|---|---|---|---|
//! | wrong | 164 | 0 | 0 | 0 | 0 | 156 |
//! | error, µm | 2.4 | 0.05 | 0.05 | 0.07 | 0.10 | 0.65 |
//! | support points | 6.2 | 5.8 | 6.2 | 6.3 | 6.2 | 7.5 |
//!
//! Exact callbacks take the same support points with and without (mean of `support_counts.csv`).
//!
//! The published method ([`crate::paper::gao`]) evaluates its directions as they are, except those of a planar query,
//! which are tilted within the plane. In single precision the error of such a callback is too large for any tilt, and
//! nothing is tilted.

use core::hint::black_box;

use crate::math::{EPSILON, POLE, Vec3, lesser};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::tuning::NEGLIGIBLE_GAPS;
use crate::types::{Direction, Solution};

/// The largest tilt, radians. At a tolerance of 1 µm it is allowed up to a size of 100 m. Measured: with 1e-8, which is allowed
/// up to 25 m, bodies on plates of 20 m take 9 % more time, because each direction waits for a root and a division.
pub const MAX_TILT_RAD: f64 = if HAS_TILT { 2.5e-9 } else { 0.0 };
/// The least useful tilt, radians, 1e-10. Measured with ODE's cylinder of radius 0.3, 20,000 rotations, the share of points
/// that are off by more than 12 µm, and that are low by more than 1 mm: without tilt 29 %, 16 %; 2.5e-12 66 %, 0.01 %. With
/// this one no depth is (`ode_cylinder`).
pub const MIN_TILT_RAD: f64 = if HAS_TILT { 4.5e5 * EPSILON } else { 0.0 };
/// The largest increase of the support value by the tilt, in tolerances. Measured: with 0.01 the same answers, but fewer
/// tolerances allow a tilt; with 5 depths are off by more than the tolerance.
const MAX_RISE_TOLERANCES: f64 = NEGLIGIBLE_GAPS;
/// Whether directions are tilted at all.
pub const HAS_TILT: bool = cfg!(not(feature = "single"));
/// The largest |z| of a unit direction that is turned about [`POLE`]; others are turned about POLE without its z. Each
/// is turned by at least 0.33 of the tilt.
const MAX_POLE_Z: f64 = 0.55;

impl Direction {
    /// Makes the direction of unit `n`, which is not tilted.
    #[inline(always)]
    pub const fn exact(n: Vec3) -> Self {
        Self { n, tilt: 0.0 }
    }

    /// Makes the direction of a state. `is_general`: true if unit `n` is in general position.
    #[inline(always)]
    pub fn remembered(n: Vec3, is_general: bool) -> Self {
        let tilt = if is_general { MIN_TILT_RAD } else { 0.0 };
        Self { n, tilt }
    }

    /// Tilts unit `n` by at most `tilt` radians; 0 leaves it as it is.
    #[inline(always)]
    pub fn tilted(n: &Vec3, tilt: f64) -> Self {
        if tilt == 0.0 {
            return Self::exact(*n);
        }
        let z = if n.z.abs() > MAX_POLE_Z { 0.0 } else { POLE.z };
        let pole = Vec3::new(POLE.x, POLE.y, z);
        // The tilt lengthens n by less than 1e-16.
        let n = n + (pole * tilt).cross(n);
        // Z by itself, so that x and y, not y and z, are one packed store for the callbacks: codegen, see README.
        let n = Vec3::new(n.x, n.y, black_box(n.z));
        Self { n, tilt }
    }

    /// Tilts unit `n` by `tilt` radians within the plane with unit normal `m`, which may point to either side.
    pub fn tilted_in_plane(n: &Vec3, m: &Vec3, tilt: f64) -> Self {
        let n = n + (m * tilt.copysign(m.dot(&POLE))).cross(n);
        Self { n, tilt }
    }

    /// Returns the direction in general position, whatever the pair's size: for one that a later query evaluates.
    #[inline(always)]
    pub fn general(&self) -> Self {
        match self.is_general() {
            true => *self,
            false => Self::tilted(&self.n, MAX_TILT_RAD),
        }
    }
}

impl Solution {
    /// Returns the normal as the callbacks received it.
    #[inline(always)]
    pub fn direction(&self) -> Direction {
        Direction::remembered(self.normal, self.is_general)
    }
}

/// How the directions of a query are tilted.
#[derive(Clone, Copy, Debug)]
pub struct TiltRule {
    /// The tolerance that the caller requested, metres: the rise of a support value by the tilt is at most
    /// [`MAX_RISE_TOLERANCES`] of it.
    pub tolerance: f64,
    /// The tilt if the tolerance is too small for a useful one, radians.
    pub least: f64,
}

impl TiltRule {
    /// Returns whether the tilt for points of this scale is the largest.
    #[inline(always)]
    pub fn allows_largest(&self, scale: &Scale) -> bool {
        let size = MAX_RISE_TOLERANCES * self.tolerance / MAX_TILT_RAD;
        !HAS_TILT || size * size > scale.size2()
    }

    /// Returns the tilt for points of this scale, radians: at least [`MIN_TILT_RAD`], or 0.
    pub fn tilt(&self, scale: &Scale) -> f64 {
        let tilt = lesser(
            MAX_TILT_RAD,
            MAX_RISE_TOLERANCES * self.tolerance / scale.size(),
        );
        if tilt >= MIN_TILT_RAD {
            tilt
        } else {
            self.least
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::SupportPoint;
    use crate::test_shapes::Random;

    const TILT: f64 = 2.5e-9;

    #[test]
    fn tilted_directions_are_unit_opposite_and_turned_by_the_tilt() {
        let mut r = Random::new(31);
        for _ in 0..1000 {
            let n = r.direction();
            let tilted = |n: &Vec3| Direction::tilted(n, TILT).n;
            let m = tilted(&n);
            assert!((m.norm() - 1.0).abs() <= 2.0 * f64::EPSILON, "{}", m.norm());
            assert_eq!(tilted(&-n), -m);
            let turn = (m - n).norm() / TILT;
            assert!(turn > 0.33 && turn < 1.01, "{n} {turn}");
        }
        let flat = Vec3::new(0.6, 0.8, 0.0);
        for n in [POLE, flat, Vec3::x(), Vec3::y(), Vec3::z()] {
            assert!((Direction::tilted(&n, TILT).n - n).norm() > 0.33 * TILT);
        }
    }

    #[test]
    fn the_tilt_is_a_share_of_the_tolerance_over_the_size() {
        let is_double = EPSILON < 1e-10;
        let tilt = |tolerance: f64, size: f64| {
            let mut scale = Scale::default();
            let v = Vec3::x() * size;
            let point = SupportPoint {
                v,
                v1: v,
                v2: Vec3::zeros(),
            };
            scale.note(&point);
            let rule = TiltRule {
                tolerance,
                least: 0.0,
            };
            rule.tilt(&scale)
        };
        for (tolerance, size, expected) in [
            (1e-6, 1.0, MAX_TILT_RAD),
            (1e-6, 200.0, 1.25e-9),
            (1e-6, 1000.0, 2.5e-10),
            (1e-9, 1.0, 2.5e-10),
            // Too small to be of use.
            (1e-6, 1e4, 0.0),
            (1e-10, 1.0, 0.0),
            (0.0, 0.0, 0.0),
            (f64::NAN, 1.0, 0.0),
            // No size is known before the first evaluation.
            (1e-6, 0.0, MAX_TILT_RAD),
            (f64::INFINITY, 1.0, MAX_TILT_RAD),
        ] {
            let expected = if is_double { expected } else { 0.0 };
            let error = (tilt(tolerance, size) - expected).abs();
            assert!(error <= 1e-20, "{tolerance} {size}");
        }
    }
}
