// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is wrong with a support mapping, as far as its answers along some hundred directions
//! tell.
//!
//! A support mapping s(n) of any set satisfies n·s(n) >= n·s(m) for all directions n and m: no
//! point that it ever answers lies beyond one of its own supporting planes. So each pair of
//! answers is held against each other. What a point is beyond by is *noise*: of rounding it is
//! some ulps, of a callback in single precision some 1e-7 of the coordinates; what is more comes of
//! another object, another frame, or a search that has not arrived. A centre is held against
//! the same planes. Asked again in the opposite order, a mapping that remembers what it should not
//! answers otherwise.

use crate::math::{EPSILON, Vec3, larger, largest, perpendicular};
use crate::minkowski::support::SupportMap;

/// Directions: each of [`HALF`], its opposite, and one hardly beside it.
const COUNT: usize = 3 * HALF;
/// Of one half of the sphere: the three axes, and a spiral between them.
const HALF: usize = 64;
/// How far beside, in radians: a ball's points fall back from each other's planes by half its square
/// of the radius, and a noise that is greater shows. Derived: where that is some ulps.
const BESIDE: f64 = if cfg!(feature = "single") { 1e-3 } else { 1e-7 };
/// Ulps of the largest coordinate that are rounding: a callback turns a point and moves it, and
/// its product with a direction is rounded too. Derived; twice what that comes to.
const ROUNDING: f64 = 32.0;

/// What [`check`](crate::check) found wrong with a shape. Lengths are metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Check {
    /// A point or the center is not finite: nothing else is told.
    pub not_finite: bool,
    /// The answers are the points farthest against the direction: a sign is wrong.
    pub opposite: bool,
    /// Points lie beyond the support planes of others by more than rounding: a wrong frame, another
    /// object's points, a search that stops too early, or single precision.
    pub contradicts: bool,
    /// The same direction asked again is answered otherwise: it depends on earlier calls.
    pub changes: bool,
    /// The center is outside: overlaps are missed then, and what is apart answered as deep.
    pub center_outside: bool,
    /// The greatest width of the object, about.
    pub size: f64,
    /// What a point is beyond another's plane by, at most.
    pub noise: f64,
    /// How far an answer moved along its direction when it was asked for again, at most.
    pub change: f64,
    /// How far the center is outside; negative: how deep inside. 0 without one.
    pub outside: f64,
    /// Unit: the direction in which the worst was found; of no meaning where nothing is wrong.
    pub dir: [f64; 3],
}

impl Check {
    /// Was nothing found wrong?
    pub fn is_fine(&self) -> bool {
        !(self.not_finite
            || self.opposite
            || self.contradicts
            || self.changes
            || self.center_outside)
    }
}

/// Direction number `i` of [`COUNT`]: unit.
fn direction(i: usize) -> Vec3 {
    let n = towards(i % HALF);
    match i / HALF {
        0 => n,
        1 => -n,
        _ => {
            let beside = n + perpendicular(&n) * BESIDE;
            beside / beside.norm()
        }
    }
}

/// One of the first [`HALF`].
fn towards(i: usize) -> Vec3 {
    match i {
        0 => Vec3::x(),
        1 => Vec3::y(),
        2 => Vec3::z(),
        _ => {
            // Equal steps down a hemisphere, the golden angle from one to the next.
            let z = (i as f64 - 2.5) / (HALF as f64 - 3.0);
            let (cos, sin) = turned(i);
            let r = (1.0 - z * z).sqrt();
            let n = Vec3::new(r * cos, r * sin, z);
            n / n.norm()
        }
    }
}

/// Cosine and sine of `i` golden angles, by complex powers: the same bits in every build.
fn turned(i: usize) -> (f64, f64) {
    #[allow(clippy::excessive_precision)] // In single precision.
    const GOLDEN: (f64, f64) = (-0.7373688780783197, 0.6754902942615238);
    let (mut cos, mut sin) = (1.0, 0.0);
    for _ in 0..i {
        (cos, sin) = (
            cos * GOLDEN.0 - sin * GOLDEN.1,
            cos * GOLDEN.1 + sin * GOLDEN.0,
        );
    }
    (cos, sin)
}

/// Looks at a support mapping and, where there is one, its centre.
pub fn check(object: &impl SupportMap, centre: Option<&Vec3>) -> Check {
    let mut points = [Vec3::zeros(); COUNT];
    let mut report = Check::default();
    let mut reach = centre.map_or(0.0, largest);
    for (i, point) in points.iter_mut().enumerate() {
        *point = object.support(&direction(i));
        // A sum that is finite has finite terms, or they are near the largest number.
        if !point.sum().is_finite() {
            report.not_finite = true;
            report.dir = direction(i).into();
            return report;
        }
        reach = larger(largest(point), reach);
    }
    if !centre.is_none_or(|c| c.sum().is_finite()) {
        report.not_finite = true;
        return report;
    }
    let rounding = ROUNDING * EPSILON * reach;
    against_each_other(&points, &mut report, rounding);
    again(object, &points, &mut report, rounding);
    if let Some(centre) = centre.filter(|_| !report.opposite) {
        report.outside = f64::NEG_INFINITY;
        let mut worst = Vec3::zeros();
        for (i, point) in points.iter().enumerate() {
            let n = direction(i);
            let outside = n.dot(&(centre - point));
            if outside > report.outside {
                (report.outside, worst) = (outside, n);
            }
        }
        report.center_outside = report.outside > rounding + report.noise;
        if report.center_outside {
            report.dir = worst.into();
        }
    }
    report
}

/// Each answer against the planes of all others.
fn against_each_other(points: &[Vec3; COUNT], report: &mut Check, rounding: f64) {
    // Planes that no answer is in front of: of the opposite of a support mapping all.
    let mut behind = 0;
    for (i, point) in points.iter().enumerate() {
        let n = direction(i);
        let (mut most, mut least) = (f64::NEG_INFINITY, f64::INFINITY);
        for other in points {
            let beyond = n.dot(&(other - point));
            most = larger(beyond, most);
            least = if beyond < least { beyond } else { least };
        }
        behind += usize::from(least >= -rounding && most > rounding);
        report.size = larger(most - least, report.size);
        if most > report.noise {
            report.noise = most;
            report.dir = n.into();
        }
    }
    report.opposite = 4 * behind > 3 * COUNT;
    report.contradicts = !report.opposite && report.noise > rounding;
}

/// The same directions from the last to the first.
fn again(object: &impl SupportMap, points: &[Vec3; COUNT], report: &mut Check, rounding: f64) {
    let mut worst = Vec3::zeros();
    for (i, point) in points.iter().enumerate().rev() {
        let n = direction(i);
        let change = n.dot(&(object.support(&n) - point)).abs();
        // NaN is a change too.
        if !(change <= report.change) {
            (report.change, worst) = (change, n);
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
    use crate::shapes::{ball, capsule, corners, hull};
    use core::cell::Cell;

    #[test]
    fn directions_are_unit_and_all_around() {
        for i in 0..COUNT {
            assert!((direction(i).norm() - 1.0).abs() < 4.0 * EPSILON);
        }
        let sum: Vec3 = (0..2 * HALF).map(direction).sum();
        assert!(sum.norm() < 1e-5);
        let all = |n: Vec3| (0..COUNT).any(|i| direction(i).dot(&n) > 0.9);
        for n in [
            Vec3::x(),
            -Vec3::y(),
            Vec3::repeat(0.577),
            Vec3::new(-0.8, 0.6, 0.0),
        ] {
            assert!(all(n));
        }
    }

    #[test]
    fn what_is_right_is_found_right() {
        let at = Vec3::new(3.0, -2.0, 70.0);
        let report = check(&ball(at, 0.5), Some(&at));
        assert!(report.is_fine(), "{report:?}");
        assert!((report.size - 1.0).abs() < 0.01 && (report.outside + 0.5).abs() < 0.01);
        assert!(check(&capsule(Vec3::x(), -Vec3::x(), 0.1), None).is_fine());
        let points = corners(Vec3::new(0.5, 1e-6, 2.0));
        assert!(check(&hull(&points), Some(&Vec3::zeros())).is_fine());
        // A point, and a flat one.
        assert!(check(&|_: &Vec3| at, Some(&at)).is_fine());
        let points = corners(Vec3::new(0.5, 0.0, 2.0));
        assert!(check(&hull(&points), Some(&Vec3::zeros())).is_fine());
    }

    #[test]
    fn what_is_wrong_is_named() {
        let at = Vec3::new(1.0, 0.0, 0.0);
        let opposite = check(&|n: &Vec3| at - n * 0.5, Some(&at));
        assert!(opposite.opposite && !opposite.contradicts);
        // The frame of another pose: turned the wrong way round.
        let points = corners(Vec3::new(0.5, 0.2, 1.0));
        let turned = check(
            &|n: &Vec3| {
                let p = hull(&points)(n);
                Vec3::new(p.y, p.z, p.x)
            },
            None,
        );
        assert!(turned.contradicts && turned.noise > 0.1, "{turned:?}");
        let centre = check(&ball(at, 0.5), Some(&Vec3::zeros()));
        assert!(centre.center_outside && (centre.outside - 0.5).abs() < 0.01);
        assert!(centre.dir[0] < -0.9);
        let nan = check(&|n: &Vec3| n * if n.x > 0.5 { f64::NAN } else { 1.0 }, None);
        assert!(nan.not_finite && nan.dir[0] > 0.5);
        assert!(check(&ball(at, 0.5), Some(&Vec3::repeat(f64::NAN))).not_finite);
        let asked = Cell::new(0);
        let grows = check(
            &|n: &Vec3| {
                asked.set(asked.get() + 1);
                n * (1.0 + asked.get() as f64 * 1e-3)
            },
            None,
        );
        assert!(grows.changes && grows.change > 0.05);
        // As exact as a float.
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
