// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests a support function and a center.
//!
//! 1. Support planes: the support function s(n) of any set satisfies n·s(n) >= n·s(m) for all
//!    directions n and m, so no point is beyond the support plane of another direction. The
//!    greatest violation is the *noise*: some ulps from rounding, some 1e-7 of the coordinates from
//!    single precision; more from another object, a wrong frame or an incomplete search.
//! 2. Repetition: the same directions in the opposite order must return the same support values.
//! 3. Center: it must not lie beyond any support plane.
//!
//! Outputs. With [`Check::not_finite`] nothing else is computed except `dir`, the direction of the point (zero if
//! the center is not finite). With [`Check::opposite`] the center is not tested.

use crate::math::{EPSILON, Vec3, larger, lesser, max_abs, perpendicular};
use crate::minkowski::support::SupportMap;

/// The number of directions: those of a hemisphere, their opposites, and the former inclined.
const NUM_DIRECTIONS: usize = 3 * NUM_HEMISPHERE;
/// The number of directions of a hemisphere: the three axes and a spiral.
const NUM_HEMISPHERE: usize = 64;
/// The angle to the latter, radians. For a ball of radius r the point of the inclined direction is r · angle² / 2 below
/// the support plane of the original one; greater noise is detected. Derived: angle² / 2 is 23 ulps
/// (single precision: 4).
const INCLINATION_RAD: f64 = if cfg!(feature = "single") { 1e-3 } else { 1e-7 };
/// The largest noise that counts as rounding, in ulps of the largest coordinate. Derived: the rotation and the
/// translation of a point by a callback, and its product with a direction, times two.
const ROUNDING_ULPS: f64 = 32.0;

/// Result of [`check`](crate::check). Lengths are metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Check {
    /// True if a point or the center is not finite; nothing else is tested then.
    pub not_finite: bool,
    /// True if the points are the farthest ones along the opposite direction: a sign is wrong.
    pub opposite: bool,
    /// True if a point is beyond the support plane of another direction by more than rounding: a wrong
    /// frame, points of another object, a search that stops too early, or single precision.
    pub contradicts: bool,
    /// True if the same direction returns another point later: the point depends on earlier calls.
    pub changes: bool,
    /// True if the center is outside: queries then miss overlaps, and report overlaps of separated shapes.
    pub center_outside: bool,
    /// Approximate greatest width of the shape.
    pub size: f64,
    /// Greatest distance of a point beyond the support plane of another direction.
    pub noise: f64,
    /// Greatest change of a support value in the repeated calls.
    pub change: f64,
    /// Distance of the center from the shape; negative inside. 0 without a center.
    pub outside: f64,
    /// Direction of the worst fault, unit; meaningless without a fault.
    pub dir: [f64; 3],
}

impl Check {
    /// Returns whether no fault was found.
    pub fn is_fine(&self) -> bool {
        !(self.not_finite
            || self.opposite
            || self.contradicts
            || self.changes
            || self.center_outside)
    }
}

/// The directions of a check, unit, or the points along them.
type Directions = [Vec3; NUM_DIRECTIONS];

/// Returns the directions, the same bits in every build.
fn directions() -> Directions {
    #[allow(clippy::excessive_precision)] // In single precision.
    const GOLDEN: (f64, f64) = (-0.7373688780783197, 0.6754902942615238);
    let mut dirs = [Vec3::zeros(); NUM_DIRECTIONS];
    // Cosine and sine of i golden angles.
    let (mut cos, mut sin) = (1.0, 0.0);
    for i in 0..NUM_HEMISPHERE {
        let n = match i {
            0 => Vec3::x(),
            1 => Vec3::y(),
            2 => Vec3::z(),
            _ => {
                // Equal steps in height; the golden angle from each to the next.
                let z = (i as f64 - 2.5) / (NUM_HEMISPHERE as f64 - 3.0);
                let r = (1.0 - z * z).sqrt();
                Vec3::new(r * cos, r * sin, z).normalize()
            }
        };
        dirs[i] = n;
        dirs[NUM_HEMISPHERE + i] = -n;
        dirs[2 * NUM_HEMISPHERE + i] = (n + perpendicular(&n) * INCLINATION_RAD).normalize();
        (cos, sin) = (
            cos * GOLDEN.0 - sin * GOLDEN.1,
            cos * GOLDEN.1 + sin * GOLDEN.0,
        );
    }
    dirs
}

/// Tests a support function and its center, if there is one.
pub fn check(object: &impl SupportMap, center: Option<&Vec3>) -> Check {
    let dirs = directions();
    let mut points = [Vec3::zeros(); NUM_DIRECTIONS];
    let mut report = Check::default();
    let mut max_coordinate = center.map_or(0.0, max_abs);
    for (point, n) in points.iter_mut().zip(&dirs) {
        *point = object.support(n);
        // A finite sum has finite terms.
        if !point.sum().is_finite() {
            report.not_finite = true;
            report.dir = (*n).into();
            return report;
        }
        max_coordinate = larger(max_abs(point), max_coordinate);
    }
    if !center.is_none_or(|c| c.sum().is_finite()) {
        report.not_finite = true;
        return report;
    }
    let rounding = ROUNDING_ULPS * EPSILON * max_coordinate;
    check_planes(&dirs, &points, &mut report, rounding);
    check_repetition(object, &dirs, &points, &mut report, rounding);
    if let Some(center) = center.filter(|_| !report.opposite) {
        report.outside = f64::NEG_INFINITY;
        let mut worst = Vec3::zeros();
        for (n, point) in dirs.iter().zip(&points) {
            let outside = n.dot(&(center - point));
            if outside > report.outside {
                (report.outside, worst) = (outside, *n);
            }
        }
        report.center_outside = report.outside > rounding + report.noise;
        if report.center_outside {
            report.dir = worst.into();
        }
    }
    report
}

/// Compares each point with the support planes of all directions.
fn check_planes(dirs: &Directions, points: &Directions, report: &mut Check, rounding: f64) {
    // The planes that have all points on their outer side: all planes, if a sign is wrong.
    let mut num_opposite = 0;
    for (n, point) in dirs.iter().zip(points) {
        let (mut highest, mut lowest) = (f64::NEG_INFINITY, f64::INFINITY);
        for other in points {
            let height = n.dot(&(other - point));
            highest = larger(height, highest);
            lowest = lesser(height, lowest);
        }
        num_opposite += usize::from(lowest >= -rounding && highest > rounding);
        report.size = larger(highest - lowest, report.size);
        if highest > report.noise {
            report.noise = highest;
            report.dir = (*n).into();
        }
    }
    report.opposite = 4 * num_opposite > 3 * NUM_DIRECTIONS;
    report.contradicts = !report.opposite && report.noise > rounding;
}

/// Evaluates the same directions again, from the last to the first.
fn check_repetition(
    object: &impl SupportMap,
    dirs: &Directions,
    points: &Directions,
    report: &mut Check,
    rounding: f64,
) {
    let mut worst = Vec3::zeros();
    for (n, point) in dirs.iter().zip(points).rev() {
        let change = n.dot(&(object.support(n) - point)).abs();
        // Negated, so that NaN counts as a change.
        if !(change <= report.change) {
            (report.change, worst) = (change, *n);
        }
    }
    report.changes = !(report.change <= rounding);
    if report.changes {
        report.dir = worst.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{ball, capsule, corners, hull};
    use core::cell::Cell;

    #[test]
    fn directions_are_unit_and_cover_the_sphere() {
        let dirs = directions();
        for n in &dirs {
            assert!((n.norm() - 1.0).abs() < 4.0 * EPSILON);
        }
        let sum: Vec3 = dirs[..2 * NUM_HEMISPHERE].iter().sum();
        assert!(sum.norm() < 1e-5);
        let has_close_direction = |n: Vec3| dirs.iter().any(|dir| dir.dot(&n) > 0.9);
        for n in [
            Vec3::x(),
            -Vec3::y(),
            Vec3::repeat(0.577),
            Vec3::new(-0.8, 0.6, 0.0),
        ] {
            assert!(has_close_direction(n));
        }
    }

    #[test]
    fn valid_support_functions_have_no_fault() {
        let at = Vec3::new(3.0, -2.0, 70.0);
        let report = check(&ball(at, 0.5), Some(&at));
        assert!(report.is_fine(), "{report:?}");
        assert!((report.size - 1.0).abs() < 0.01 && (report.outside + 0.5).abs() < 0.01);
        assert!(check(&capsule(Vec3::x(), -Vec3::x(), 0.1), None).is_fine());
        let points = corners(Vec3::new(0.5, 1e-6, 2.0));
        assert!(check(&hull(&points), Some(&Vec3::zeros())).is_fine());
        // A point, and a flat box.
        assert!(check(&|_: &Vec3| at, Some(&at)).is_fine());
        let points = corners(Vec3::new(0.5, 0.0, 2.0));
        assert!(check(&hull(&points), Some(&Vec3::zeros())).is_fine());
    }

    #[test]
    fn each_fault_is_reported() {
        let at = Vec3::new(1.0, 0.0, 0.0);
        let opposite = check(&|n: &Vec3| at - n * 0.5, Some(&at));
        assert!(opposite.opposite && !opposite.contradicts);
        // The frame of another pose: the inverse rotation.
        let points = corners(Vec3::new(0.5, 0.2, 1.0));
        let turned = check(
            &|n: &Vec3| {
                let p = hull(&points)(n);
                Vec3::new(p.y, p.z, p.x)
            },
            None,
        );
        assert!(turned.contradicts && turned.noise > 0.1, "{turned:?}");
        let outside = check(&ball(at, 0.5), Some(&Vec3::zeros()));
        assert!(outside.center_outside && (outside.outside - 0.5).abs() < 0.01);
        assert!(outside.dir[0] < -0.9);
        let nan = check(&|n: &Vec3| n * if n.x > 0.5 { f64::NAN } else { 1.0 }, None);
        assert!(nan.not_finite && nan.dir[0] > 0.5);
        assert!(check(&ball(at, 0.5), Some(&Vec3::repeat(f64::NAN))).not_finite);
        let num_calls = Cell::new(0);
        let grows = check(
            &|n: &Vec3| {
                num_calls.set(num_calls.get() + 1);
                n * (1.0 + num_calls.get() as f64 * 1e-3)
            },
            None,
        );
        assert!(grows.changes && grows.change > 0.05);
        // Rounded to single precision.
        #[cfg(not(feature = "single"))]
        {
            let rounded = check(
                &|n: &Vec3| (at + n * 0.3).map(|x| f64::from(x as f32)),
                Some(&at),
            );
            assert!(rounded.contradicts && rounded.noise > 1e-9 && rounded.noise < 1e-6);
            assert!(!rounded.center_outside && !rounded.changes);
        }
    }
}
