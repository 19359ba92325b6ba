// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Sphere fits of the two objects, which choose the directions to evaluate. They prove no bound; the local
//! search takes the prediction of an *exact* fit for a minimum if support values around it confirm it.
//!
//! No reference is known to us. Terms: the *core point* of a vertex that was found along n is the vertex less
//! radius × n; the *core* of D is D without the spheres, and ρ is the sum of the two radii. w is the point of a
//! triangle of core points that is closest to the origin.
//!
//! 1. *Fit.* Two samples (n, p) and (n′, p′) of a sphere of radius ρ lie below each other's support planes by
//!    ρ |n′ − n|² / 2: with e = n′·(p′ − p) and f = n·(p − p′), e = f and ρ = (e + f) / |n′ − n|². Each new entry
//!    of the vertex set is compared with the entry of the upper bound.
//! 2. *Prediction.* The core points of a face's corners are a triangle of the core of D. If the origin is on its
//!    outer side, the foot w predicts the least support value ρ − |w|, along −w / |w|; otherwise ρ + |w|, along
//!    w / |w|. If w is the origin within rounding, it is ρ, along the normal of the face.
//! 3. *Confirmation* of an exact fit: two directions show the same center of each sphere.
//!
//! Outputs. [`SphereFit::radius`]: a guess. A direction of [`SphereFit::predict`] must be evaluated; the support value
//! decides ([`Predictor`](crate::minkowski::predictor::Predictor)).

use crate::geometry::barycentric;
use crate::math::{EPSILON, Vec3, lesser};
use crate::minkowski::support_query::SupportPlane;
use crate::minkowski::tuning::CONFIRM_RANGE_RAD;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The largest relative difference of e and f, and the largest angle, radians, between the change of direction and the
/// change of vertex, of two samples of one sphere in fits that only choose directions. Measured: with 0.1 ellipsoids take 2
/// to 18 % fewer support points and hulls 2 to 3 % more, but the direction jumps once for a hull that turns in a hull (test
/// `continuity`).
const LOOSE_REL_TOL: f64 = 0.03;
/// The same in exact fits: far above the rounding error of the callbacks.
const EXACT_REL_TOL: f64 = if EPSILON < 1e-10 { 1e-6 } else { 1e-3 };
/// The distance up to which two points of exact fits, or the core and the origin, coincide, in radii.
const SAME_CENTER_REL: f64 = if EPSILON < 1e-10 { 1e-9 } else { 1e-5 };
/// The least distance of the core from the origin, in radii, that has a direction. Insensitive: 1e-15 to 1e-14 in double
/// precision; with 1e-9, the normal of a face is predicted for spheres whose centers are 1e-9 m apart, with a value that no
/// direction has, and their local search ends in no minimum at a tolerance of as much. In single precision the points are
/// rounded by more.
const MIN_CORE_DISTANCE_REL: f64 = if EPSILON < 1e-10 {
    16.0 * EPSILON
} else {
    SAME_CENTER_REL
};
/// The number of entries, from the last one, that a fit compares. Measured: with 3 capsules take 6 to 10 % more support points;
/// 6 to 12 differ by less than 0.1 %; without a limit deep ellipsoids take 6 % more instructions.
const MAX_COMPARED: usize = 8;
/// The least squared angle, radians, between two samples from which a radius or a curvature is computed, and between two
/// directions that are not one. The local search is insensitive: 1e-16 to 1e-6.
pub const MIN_ANGLE2: f64 = 1e-10;
/// A sample that is compared with another one.
struct FitSample {
    /// Unit.
    dir: Vec3,
    /// x, y and z: obj1's vertex, and minus obj2's.
    coords: [[f64; 2]; 3],
}

impl FitSample {
    #[inline(always)]
    fn of_entry<const N: usize>(set: &VertexSet<N>, i: usize) -> Self {
        Self {
            dir: set.dir(i),
            coords: set.coords(i),
        }
    }

    #[inline(always)]
    fn of_upper(upper: &SupportPlane) -> Self {
        let (v1, v2) = (upper.point.v1, upper.point.v2);
        Self {
            dir: upper.dir,
            coords: [[v1.x, -v2.x], [v1.y, -v2.y], [v1.z, -v2.z]],
        }
    }

    /// Returns the center of a sphere of this radius through the vertex of an object, 0 or 1; minus the center for
    /// obj2, 1.
    #[inline(always)]
    fn center(&self, object: usize, radius: f64) -> Vec3 {
        Vec3::from(self.coords.map(|c| c[object % 2])) - self.dir * radius
    }
}

/// The sphere fits of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereFit {
    /// The radii of obj1 and obj2, metres; 0 without a fit.
    pub radius: [f64; 2],
    /// True if two samples must lie on one sphere within rounding; a prediction may then be a minimum of the local search.
    is_exact: bool,
    /// The number of entries that were compared.
    compared: usize,
}

impl SphereFit {
    /// Returns the radius of the sphere of D, metres; 0 without a fit.
    #[inline(always)]
    pub fn sum(&self) -> f64 {
        self.radius[0] + self.radius[1]
    }

    /// Compares the last new entries of the set with the sample of the upper bound. An exact fit compares each with the
    /// previous entry too. If an object has several spheres, the one of the upper bound is taken.
    pub fn update<const N: usize>(&mut self, set: &VertexSet<N>, upper: &SupportPlane) {
        let tolerance = if self.is_exact {
            EXACT_REL_TOL
        } else {
            LOOSE_REL_TOL
        };
        let lowest = FitSample::of_upper(upper);
        self.compared = self.compared.max(set.len().saturating_sub(MAX_COMPARED));
        while self.compared < set.len() {
            let i = self.compared;
            self.compared += 1;
            let entry = FitSample::of_entry(set, i);
            let mut previous = [0.0; 2];
            if self.is_exact {
                let other = FitSample::of_entry(set, i.saturating_sub(1));
                previous = fit_radii(&other, &entry, tolerance);
            }
            let found = fit_radii(&lowest, &entry, tolerance);
            for ((radius, found), previous) in self.radius.iter_mut().zip(found).zip(previous) {
                if found > 0.0 {
                    *radius = found;
                } else if !(*radius > 0.0) {
                    *radius = previous;
                }
            }
        }
    }

    /// Makes [`SphereFit::update`] compare all entries again, because their indices have changed.
    pub fn restart(&mut self) {
        self.compared = 0;
    }

    /// Forgets the radii after a prediction that failed. Those of an exact fit are of spheres, whatever D is elsewhere.
    pub fn fail(&mut self) {
        if !self.is_exact {
            self.radius = [0.0; 2];
        }
    }

    /// Forgets the radii, and takes none any more.
    pub fn refute(&mut self) {
        (self.radius, self.compared) = ([0.0; 2], usize::MAX);
    }

    /// Returns a fit that has compared nothing yet, with radii of an earlier one, metres.
    pub fn from_radius(radius: [f64; 2]) -> Self {
        Self {
            radius,
            ..Self::default()
        }
    }

    /// Returns a fit whose samples must lie on one sphere within rounding.
    pub fn exact() -> Self {
        Self {
            is_exact: true,
            ..Self::default()
        }
    }

    /// Returns the core points of the corners.
    #[inline(always)]
    pub fn core<const N: usize>(&self, set: &VertexSet<N>, corners: &[Vertex; 3]) -> [Vec3; 3] {
        let [r1, r2] = self.radius;
        corners.map(|v| v.w - set.dir(v.pair.a.into()) * r1 - set.dir(v.pair.b.into()) * r2)
    }

    /// Returns the direction, unit, and the value of the least support value that the fit predicts near a face with
    /// the outward unit `normal`; `None` without a prediction.
    pub fn predict<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
    ) -> Option<(Vec3, f64)> {
        let rho = self.sum();
        if !(rho > 0.0) {
            return None;
        }
        let [a, b, c] = self.core(set, corners);
        let closest = barycentric::triangle(&Vec3::zeros(), &a, &b, &c);
        let foot = closest.point;
        let distance = foot.norm();
        if !(distance > MIN_CORE_DISTANCE_REL * rho) {
            return Some((*normal, rho));
        }
        let dir = foot / distance;
        if normal.dot(&foot) < 0.0 {
            Some((-dir, rho - distance))
        } else {
            let is_inside = closest.weights.iter().all(|weight| *weight > 0.0);
            is_inside.then_some((dir, rho + distance))
        }
    }
}

/// The exact fits of the local search, whose minimum a prediction may be: e = f, and the changes of direction and
/// vertex are parallel, within rounding.
impl SphereFit {
    /// Returns whether two directions, at least as far apart as those that confirm a minimum ([`CONFIRM_RANGE_RAD`]),
    /// confirm the center of each sphere, that of obj1's entry and that of obj2's entry in `pair`: the two estimates of a
    /// center differ by at most `tolerance`, metres. From one direction the tip of a drop fits a sphere, and from several
    /// nearby ones the rim of a thin disc nearly does.
    pub fn is_confirmed_twice<const N: usize>(
        &self,
        set: &VertexSet<N>,
        pair: VertexPair,
        tolerance: f64,
    ) -> bool {
        let samples = [pair.a, pair.b].map(|i| FitSample::of_entry(set, i.into()));
        self.are_centers_confirmed(set, &samples, tolerance)
    }

    /// Returns the same for the sphere of obj1 at the first sample and that of obj2 at the second.
    fn are_centers_confirmed<const N: usize>(
        &self,
        set: &VertexSet<N>,
        samples: &[FitSample; 2],
        tolerance: f64,
    ) -> bool {
        let max_distance = lesser(SAME_CENTER_REL * self.sum(), tolerance);
        let [min_turn, _] = CONFIRM_RANGE_RAD;
        (samples.iter().zip(self.radius).enumerate()).all(|(object, (sample, radius))| {
            let confirms = |k: usize| {
                let other = FitSample::of_entry(set, k);
                let distance = other.center(object, radius) - sample.center(object, radius);
                let turn2 = (other.dir - sample.dir).norm_squared();
                turn2 > min_turn * min_turn && distance.norm() <= max_distance
            };
            !(radius > 0.0) || (0..set.len()).any(confirms)
        })
    }

    /// Returns whether two directions confirm the spheres of a result: those of the upper bound, and those of the
    /// corners with a weight in the witness points.
    pub fn are_spheres_confirmed<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        upper: &SupportPlane,
        tolerance: f64,
    ) -> bool {
        let weights = self.weights(set, corners);
        let lowest = [(); 2].map(|()| FitSample::of_upper(upper));
        self.are_centers_confirmed(set, &lowest, tolerance)
            && (weights.iter().zip(corners)).all(|(weight, v)| {
                !(*weight > 0.0) || self.is_confirmed_twice(set, v.pair, tolerance)
            })
    }

    /// Returns the barycentric weights of the foot in the triangle of the corners' core points.
    fn weights<const N: usize>(&self, set: &VertexSet<N>, corners: &[Vertex; 3]) -> [f64; 3] {
        let [a, b, c] = self.core(set, corners);
        barycentric::triangle(&Vec3::zeros(), &a, &b, &c).weights
    }

    /// Returns the witness points for unit `dir` on the spheres of the corners: the foot in the triangle of the core
    /// points, which is on the line along `dir` through the origin, plus radius × direction.
    pub fn witnesses<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        dir: &Vec3,
    ) -> [Vec3; 2] {
        let weights = self.weights(set, corners);
        let [r1, r2] = self.radius;
        let mut points = [dir * r1, -dir * r2];
        for (weight, v) in weights.iter().zip(corners) {
            let (a, b) = (usize::from(v.pair.a), usize::from(v.pair.b));
            points[0] += (set.vertex1(a) - set.dir(a) * r1) * *weight;
            points[1] += (set.vertex2(b) + set.dir(b) * r2) * *weight;
        }
        points
    }
}

/// Returns the radii of the spheres of obj1 and obj2 on which two samples lie; 0 for an object without one.
#[inline(always)]
fn fit_radii(first: &FitSample, second: &FitSample, tolerance: f64) -> [f64; 2] {
    // e + f and e − f are the products of the change of vertex with these two.
    let (turn, sum) = (second.dir - first.dir, second.dir + first.dir);
    let turn2 = turn.norm_squared();
    let (from, to) = (&first.coords, &second.coords);
    let (mut along, mut length2) = ([0.0; 2], [0.0; 2]);
    for axis in 0..3 {
        for lane in 0..2 {
            let d = to[axis][lane] - from[axis][lane];
            along[lane] += turn[axis] * d;
            length2[lane] += d * d;
        }
    }
    let min_turn2 = (1.0 - tolerance * tolerance) * turn2;
    let is_parallel = [0, 1].map(|lane| along[lane] * along[lane] > min_turn2 * length2[lane]);
    let mut radii = [0.0; 2];
    // One branch for the vertices of polytopes, whose signs are as good as random.
    if !(is_parallel[0] | is_parallel[1]) {
        return radii;
    }
    for lane in 0..2 {
        let off = (0..3).fold(0.0, |off, axis| {
            off + sum[axis] * (to[axis][lane] - from[axis][lane])
        });
        let is_round = off.abs() <= tolerance * along[lane];
        if is_parallel[lane] && is_round && along[lane] > 0.0 && turn2 > MIN_ANGLE2 {
            radii[lane] = along[lane] / turn2;
        }
    }
    radii
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::minkowski::support_query::SupportQuery;
    use crate::test_shapes::{Random, Shape, ball, corners, difference, hull};

    pub const ROUNDING: f64 = 1e3 * EPSILON;

    pub type Balls = MinkowskiDifference<Shape<'static>, Shape<'static>>;

    /// Balls of the radii 0.5 and 0.25, whose centers are 0.6 apart along x: the least support value is 0.15, along x.
    pub fn balls() -> Balls {
        difference(ball(Vec3::zeros(), 0.5), ball(Vec3::x() * 0.6, 0.25))
    }

    /// Evaluates three directions around x.
    pub fn corners_around_x(
        query: &mut SupportQuery<'_, Balls>,
        set: &mut VertexSet<24>,
    ) -> [Vertex; 3] {
        [[0.4, 0.0], [-0.2, 0.3], [-0.2, -0.3]].map(|[y, z]| {
            let n = Vec3::new(1.0, y, z).normalize();
            query.evaluate(set, &n).unwrap().vertex()
        })
    }

    #[test]
    fn two_samples_of_balls_give_their_radii_and_the_least_support_value() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        for mut fit in [SphereFit::default(), SphereFit::exact()] {
            assert_eq!(fit.predict(&set, &corners, &Vec3::x()), None);
            fit.update(&set, &query.upper);
            assert!(
                (fit.radius[0] - 0.5).abs() < ROUNDING && (fit.radius[1] - 0.25).abs() < ROUNDING
            );
            let (dir, value) = fit.predict(&set, &corners, &Vec3::x()).unwrap();
            assert!(
                (dir - Vec3::x()).norm() < ROUNDING && (value - 0.15).abs() < ROUNDING,
                "{dir} {value}"
            );
            assert!(fit.are_spheres_confirmed(&set, &corners, &query.upper, 1e-3));
            let [p, q] = fit.witnesses(&set, &corners, &dir);
            assert!(
                (p - Vec3::x() * 0.5).norm() < ROUNDING && (q - Vec3::x() * 0.35).norm() < ROUNDING
            );
        }
    }

    #[test]
    fn vertices_of_polytopes_and_nan_give_no_radius() {
        let mut r = Random::new(45);
        let md = difference(
            hull(&corners(Vec3::repeat(1.0))),
            hull(&corners(Vec3::repeat(0.5))),
        );
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::<24>::EMPTY);
        // In one octant there is one corner; two corners of one edge look like a sphere from two directions alone.
        for _ in 0..10 {
            let n = r.direction().abs() + Vec3::repeat(0.01);
            query.evaluate(&mut set, &n.normalize()).unwrap();
        }
        let mut fit = SphereFit::default();
        fit.update(&set, &query.upper);
        assert_eq!(fit.radius, [0.0; 2]);
        let mut upper = query.upper;
        upper.point.v1 = Vec3::repeat(f64::NAN);
        upper.dir = Vec3::repeat(f64::NAN);
        fit.restart();
        fit.update(&set, &upper);
        assert_eq!(fit.radius, [0.0; 2]);
    }
}
