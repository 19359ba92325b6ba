// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tilts the directions of a search into general position.
//!
//! Some support functions are wrong in directions of a symmetry. ODE's cylinder divides the part of the direction across
//! its axis by the length of that part, which is rounding noise within 1e-15 rad of the axis: the point is off by up to
//! the radius, along the axis too. A search evaluates just such directions, because they are the normals of faces.
//! Therefore n + tilt · ω × n is evaluated in place of n, and stored as the direction of the sample; ω is [`POLE`].
//! Ties between the vertices of parallel faces are broken in the same way each time, too. This is the perturbation of
//! computational geometry (H. Edelsbrunner, E. Mücke, "Simulation of Simplicity", 1990) with a number for the symbol.
//!
//! Size. The support value of the tilted direction is at most tilt · size above that of n, which may be a quarter of the
//! tolerance. The error that such a callback has left is about 7e-16 / tilt times the radius. Measured: wrong
//! answers in ODE's pile (`compare.sh --swap`, 26,000 queries of `ode_pile`, two starts, any size of D), mean error of
//! the depth, support points:
//!
//! | tilt, rad | 0 | 1e-9 | 3e-9 | 1e-8 | 1e-7 | 1e-6 |
//! |---|---|---|---|---|---|---|
//! | wrong | 164 | 0 | 0 | 0 | 0 | 156 |
//! | error, µm | 2.4 | 0.05 | 0.05 | 0.07 | 0.10 | 0.65 |
//! | support points | 6.2 | 5.8 | 6.2 | 6.3 | 6.2 | 7.5 |
//!
//! Exact callbacks take the same support points with and without (mean of `support_counts.csv`).
//!
//! Limits. A direction along ω gets no tilt. A direction that an earlier query has evaluated is in general position and is
//! evaluated as it is, so that a pair at rest does not turn. The published method ([`crate::paper::gao`]) evaluates its
//! directions as they are.

use crate::math::{EPSILON, POLE, Vec3, lesser};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::tuning::SMALL_PART;

/// The largest tilt, radians.
const MAX_TILT_RAD: f64 = 1e-8;
/// The least useful tilt, radians, 1.1e-9: below it the error of such a callback is far above the tolerance. No tilt in
/// single precision is as large.
const MIN_TILT_RAD: f64 = 5e6 * EPSILON;

/// Returns the tilt for a query with this tolerance, metres, in radians. 0 if the tolerance is too small for one, and in
/// single precision.
#[inline(always)]
pub fn tilt_rad(tolerance: f64, scale: &Scale) -> f64 {
    let size = SMALL_PART * tolerance / MAX_TILT_RAD;
    // Most tolerances allow the largest tilt. Negated for NaN.
    if !(size * size > scale.size2()) || MAX_TILT_RAD < MIN_TILT_RAD {
        return small_tilt_rad(tolerance, scale.size());
    }
    MAX_TILT_RAD
}

/// Returns the tilt for a tolerance that does not allow the largest one, in radians.
#[cold]
fn small_tilt_rad(tolerance: f64, size: f64) -> f64 {
    let tilt = lesser(MAX_TILT_RAD, SMALL_PART * tolerance / size);
    if tilt >= MIN_TILT_RAD { tilt } else { 0.0 }
}

/// Returns unit `n` tilted by at most `tilt` radians, unit; `n` itself for 0.
#[inline(always)]
pub fn tilted(n: &Vec3, tilt: f64) -> Vec3 {
    if tilt == 0.0 {
        return *n;
    }
    // The tilt lengthens n by less than 1e-16.
    n + (POLE * tilt).cross(n)
}

/// Returns the unit direction `n` of a caller's guess in general position, unit: the pair's size is not known yet.
pub fn start_direction(n: &Vec3) -> Vec3 {
    tilted(n, tilt_rad(f64::INFINITY, &Scale::default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::SupportPoint;
    use crate::shapes::Random;

    #[test]
    fn tilted_directions_are_unit_opposite_and_turned_by_the_tilt() {
        let mut r = Random::new(31);
        for _ in 0..1000 {
            let n = r.direction();
            let m = tilted(&n, MAX_TILT_RAD);
            assert!((m.norm() - 1.0).abs() <= 2.0 * f64::EPSILON, "{}", m.norm());
            assert_eq!(tilted(&-n, MAX_TILT_RAD), -m);
            let (turn, sine) = ((m - n).norm(), POLE.cross(&n).norm());
            assert!((turn - MAX_TILT_RAD * sine).abs() <= 4.0 * f64::EPSILON);
        }
        assert!((tilted(&POLE, MAX_TILT_RAD) - POLE).norm() <= 2.0 * f64::EPSILON);
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
            tilt_rad(tolerance, &scale)
        };
        for (tolerance, size, expected) in [
            (1e-6, 1.0, 1e-8),
            (1e-6, 50.0, 5e-9),
            // Too small to be of use.
            (1e-6, 1000.0, 0.0),
            (1e-9, 1.0, 0.0),
            (0.0, 0.0, 0.0),
            (f64::NAN, 1.0, 0.0),
            // No size is known before the first evaluation.
            (1e-6, 0.0, 1e-8),
            (f64::INFINITY, 1.0, 1e-8),
        ] {
            let expected = if is_double { expected } else { 0.0 };
            let error = (tilt(tolerance, size) - expected).abs();
            assert!(error <= 1e-20, "{tolerance} {size}");
        }
    }
}
