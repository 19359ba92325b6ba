// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Sphere fits of the two objects, which choose the directions to evaluate. They prove no bound; the local
//! search takes the prediction of an *exact* fit for a minimum if support values around it confirm it.
//!
//! No reference is known to us. Terms: the *core point* of a vertex that was found along n is the vertex less
//! radius × n; the *core* of D is D without the spheres, and ρ is the sum of the two radii. w is the point of a
//! triangle of core points that is closest to the origin. The *allowed gap* is the largest difference of the bounds
//! at which a query stops.
//!
//! 1. *Fit.* Two samples (n, p) and (n′, p′) of a sphere of radius ρ lie below each other's support planes by
//!    ρ |n′ − n|² / 2: with e = n′·(p′ − p) and f = n·(p − p′), e = f and ρ = (e + f) / |n′ − n|². Each new entry
//!    of the vertex set is compared with the entry of the upper bound.
//! 2. *Prediction.* The core points of a face's corners are a triangle of the core of D. If the origin is on its
//!    outer side, the foot w predicts the least support value ρ − |w|, along −w / |w|; otherwise ρ + |w|, along
//!    w / |w|.
//! 3. *Confirmation.* A prediction that agrees with the evaluated support value confirms the fit; one that does
//!    not resets the radii, and after [`MAX_FAILURES`] of them the fit is not used any more.
//! 4. *Tilted direction.* The direction of the upper bound is tilted towards a face until the chord of its support point
//!    and the new one is as close to the origin as the allowed gap permits: with the radius of a confirmed fit, else with
//!    that of an *arc*, two samples between which e and f nearly agree, and which need be on no sphere.
//!
//! Outputs. [`SphereFit::radius`]: a guess. A direction of [`SphereFit::predict`] or
//! [`SphereFit::tilted_from_lowest`] must be evaluated; the support value decides.

use crate::geometry::barycentric;
use crate::math::{EPSILON, Vec3, larger, lesser, normalise_unscaled};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery, SupportSample};
use crate::minkowski::tuning::{
    CONFIRM_RANGE_RAD, MAX_FAILURES, MAX_MISS_REL, MIN_GAIN_GAPS, SMOOTH_REL_TOL,
};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The largest relative difference of e and f, and the largest angle, radians, between the change of direction and the
/// change of vertex, of two samples of one sphere in fits that only choose directions. Measured: with 0.1 ellipsoids take 2
/// to 18 % fewer support points and hulls 2 to 3 % more, but the direction jumps once for a hull that turns in a hull (test
/// `continuity`).
const LOOSE_REL_TOL: f64 = 0.03;
/// The same in exact fits: far above the rounding error of the callbacks.
const EXACT_REL_TOL: f64 = if EPSILON < 1e-10 { 1e-6 } else { 1e-3 };
/// The distance up to which two points of exact fits, or the difference of the centers and the origin, coincide, in radii.
pub const SAME_CENTER_REL: f64 = if EPSILON < 1e-10 { 1e-9 } else { 1e-5 };
/// The least distance of the core from the origin, in radii, that has a direction. Insensitive: 1e-15 to 1e-14 in double
/// precision; with 1e-9, local searches of spheres whose centers are 1e-9 m apart take 220 support points in place of 6 at a
/// tolerance of as much: no direction is predicted, and the radii alone predict a value that none has. In single precision
/// the points are rounded by more.
const MIN_CORE_DISTANCE_REL: f64 = if EPSILON < 1e-10 {
    16.0 * EPSILON
} else {
    SAME_CENTER_REL
};
/// The least squared angle, radians, between two samples from which a radius or a curvature is computed, and between two
/// directions that are not one. The local search is insensitive: 1e-16 to 1e-6.
pub const MIN_ANGLE2: f64 = 1e-10;
/// The largest ratio of the radii of two successive circles of corners. Measured: without it, proofs to 1e-10 m of shallow
/// round pairs take 14 % more support points, warm hits 1.5 % more instructions.
const MAX_CIRCLE_RATIO: f64 = 100.0;

/// The source of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectionSource {
    /// The normal of the face.
    Normal,
    /// The prediction of the sphere fit.
    Prediction,
    /// The direction of the upper bound, tilted towards the face.
    Tilted,
}

/// A direction to evaluate.
#[derive(Clone, Copy, Debug)]
struct QueryDirection {
    /// Unit.
    dir: Vec3,
    source: DirectionSource,
    /// The predicted support value, metres; the upper bound without a prediction.
    value: f64,
}

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
    /// True if the last prediction was confirmed.
    pub is_confirmed: bool,
    /// True if two samples must lie on one sphere within rounding; a prediction may then be a minimum of the local search.
    is_exact: bool,
    /// The number of entries that were compared.
    compared: usize,
    /// The number of failed predictions.
    failures: u32,
}

impl SphereFit {
    /// Returns the radius of the sphere of D, metres; 0 without a fit.
    #[inline(always)]
    pub fn sum(&self) -> f64 {
        self.radius[0] + self.radius[1]
    }

    /// Compares the new entries of the set with the sample of the upper bound. An exact fit compares each with the
    /// previous entry too. If an object has several spheres, the one of the upper bound is taken.
    pub fn update<const N: usize>(&mut self, set: &VertexSet<N>, upper: &SupportPlane) {
        let tolerance = if self.is_exact {
            EXACT_REL_TOL
        } else {
            LOOSE_REL_TOL
        };
        let lowest = FitSample::of_upper(upper);
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
        (self.compared, self.failures) = (0, 0);
    }

    /// Returns a fit that has compared nothing yet, with radii of an earlier one, metres.
    pub fn from_radius(radius: [f64; 2]) -> Self {
        Self {
            radius,
            ..Self::default()
        }
    }

    /// Returns a fit with the radii of a warm state, which count as confirmed, metres.
    pub fn warm(radius: [f64; 2]) -> Self {
        Self {
            is_confirmed: radius[0] + radius[1] > 0.0,
            ..Self::from_radius(radius)
        }
    }

    /// Returns a fit whose samples must lie on one sphere within rounding.
    pub fn exact() -> Self {
        Self {
            is_exact: true,
            ..Self::default()
        }
    }

    /// Returns the radii if a prediction has confirmed them, metres; else 0.
    pub fn confirmed_radius(&self) -> [f64; 2] {
        if self.is_confirmed {
            self.radius
        } else {
            [0.0; 2]
        }
    }

    /// Returns the core points of the corners.
    #[inline(always)]
    pub fn core<const N: usize>(&self, set: &VertexSet<N>, corners: &[Vertex; 3]) -> [Vec3; 3] {
        let [r1, r2] = self.radius;
        corners.map(|v| v.w - set.dir(v.pair.a.into()) * r1 - set.dir(v.pair.b.into()) * r2)
    }

    /// Returns the direction, unit, and the value of the least support value that the fit predicts near a face with
    /// the outward normal `normal`; `None` without a prediction.
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
            return None;
        }
        let dir = foot / distance;
        if normal.dot(&foot) < 0.0 {
            Some((-dir, rho - distance))
        } else {
            let is_inside = closest.weights.iter().all(|weight| *weight > 0.0);
            is_inside.then_some((dir, rho + distance))
        }
    }

    /// Returns the direction of the upper bound, tilted towards the unit normal of a face, and the least support value that
    /// is predicted there, metres. `None` if the surface of D is no arc there, if the angle to the normal is less than the
    /// tilt, or not acute. The interior point may be a corner.
    ///
    /// On a sphere of radius ρ, with the origin at the distance e = ρ − upper from its center, a chord between the
    /// angles α and γ from the direction of the upper bound is at least as far from the origin as the upper bound if
    /// (γ − α)² ρ <= (γ + α)² e: the next corner is at γ = r α, r = (1 + k) / (1 − k), k² = e / ρ. Corners at equal
    /// angles lie on a circle; the first circle is as wide as the gap allows. Without a confirmed fit ρ is that of an arc
    /// ([`arc_radius`]), the lowest point of which may be farther from the upper bound than the circle: then that is next.
    fn tilted_from_lowest<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        upper: &SupportPlane,
        normal: &Vec3,
        gap: f64,
    ) -> Option<(Vec3, f64)> {
        let is_sphere = self.is_confirmed && self.sum() > 0.0;
        let lowest = &upper.dir;
        let along = normal.dot(lowest);
        if !(along > 0.0) {
            return None;
        }
        let perpendicular = normal - lowest * along;
        // The cosine of the corner closest to `lowest`, and the corner that reaches farthest towards the normal.
        let (mut near, mut far, mut far_corner) = (0.0, 0.0, VertexPair::INTERIOR);
        for v in corners.iter().filter(|v| !v.pair.is_interior()) {
            let products = |i: u16| {
                let dir = set.dir(i.into());
                (dir.dot(lowest), dir.dot(&perpendicular))
            };
            let (mut cosine, mut reach) = products(v.pair.a);
            if v.pair.b != v.pair.a {
                let other = products(v.pair.b);
                (cosine, reach) = (lesser(other.0, cosine), lesser(other.1, reach));
            }
            near = larger(near, cosine);
            if reach > far {
                (far, far_corner) = (reach, v.pair);
            }
        }
        let rho = if is_sphere {
            self.sum()
        } else {
            arc_radius(set, far_corner, upper)?
        };
        if !(rho > upper.depth) {
            return None;
        }
        let least = (1.0 - near * near).max(0.0).sqrt();
        let sine = perpendicular.norm();
        let way = perpendicular / sine;
        let k = (1.0 - upper.depth / rho).sqrt();
        let ratio = lesser((1.0 + k) / (1.0 - k), MAX_CIRCLE_RATIO);
        // Faces as wide as the first circle are within the gap.
        let first = 2.0 * (gap / rho).sqrt();
        let (mut tilt, mut value) = (larger(ratio * least, first), upper.depth);
        let shift = -upper.point.v.dot(&way) / (rho - upper.depth);
        if !is_sphere && shift > tilt {
            (tilt, value) = (shift, value - 0.5 * (rho - upper.depth) * shift * shift);
        }
        if !(sine > tilt * along) {
            return None;
        }
        let dir = lowest + way * tilt;
        Some((dir / dir.norm(), value))
    }

    /// Returns the next direction to evaluate for a face with these corners and this unit normal. `gap`: the allowed
    /// difference of the bounds, metres.
    #[inline(never)]
    fn choose<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: Vec3,
        upper: &SupportPlane,
        gap: f64,
    ) -> QueryDirection {
        self.update(set, upper);
        let is_used = self.failures < MAX_FAILURES;
        let has_interior = corners.iter().any(|v| v.pair.is_interior());
        let predicted = (is_used && !has_interior).then(|| self.predict(set, corners, &normal));
        if let Some((dir, value)) = predicted.flatten() {
            if (value - upper.depth).abs() <= MIN_GAIN_GAPS * gap {
                // The upper bound is what the fit predicts.
                self.is_confirmed = true;
            }
            if value < upper.depth - MIN_GAIN_GAPS * gap {
                let source = DirectionSource::Prediction;
                return QueryDirection { dir, source, value };
            }
        }
        let tilted = is_used.then(|| self.tilted_from_lowest(set, corners, upper, &normal, gap));
        let (dir, source, value) = match tilted.flatten() {
            Some((dir, value)) => (dir, DirectionSource::Tilted, value),
            None => (normal, DirectionSource::Normal, upper.depth),
        };
        QueryDirection { dir, source, value }
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

/// Returns the sum of the radii of two arcs, metres: that of obj1 and that of obj2, from the vertex of the upper bound to that
/// of a corner. `None` if there is no turn, or if e and f of an object differ by more than [`SMOOTH_REL_TOL`] of their sum. A
/// vertex that stays where it is is an arc of radius 0.
fn arc_radius<const N: usize>(
    set: &VertexSet<N>,
    pair: VertexPair,
    upper: &SupportPlane,
) -> Option<f64> {
    if pair.is_interior() {
        return None;
    }
    let lowest = [upper.point.v1, -upper.point.v2];
    let mut radius = 0.0;
    for (object, i) in [pair.a, pair.b].into_iter().enumerate() {
        let coords = set.coords(i.into());
        let change = Vec3::from(coords.map(|c| c[object])) - lowest[object];
        let turn = set.dir(i.into()) - upper.dir;
        // e + f and f.
        let (sum, f) = (turn.dot(&change), -upper.dir.dot(&change));
        let turn2 = turn.norm_squared();
        if !((sum - 2.0 * f).abs() <= SMOOTH_REL_TOL * sum && turn2 > MIN_ANGLE2) {
            return None;
        }
        radius += sum / turn2;
    }
    Some(radius)
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
    let mut radii = [0.0; 2];
    let min_cos2 = 1.0 - tolerance * tolerance;
    for lane in 0..2 {
        let is_parallel = along[lane] * along[lane] > min_cos2 * turn2 * length2[lane];
        if !(is_parallel && along[lane] > 0.0 && turn2 > MIN_ANGLE2) {
            continue;
        }
        let off = (0..3).fold(0.0, |off, axis| {
            off + sum[axis] * (to[axis][lane] - from[axis][lane])
        });
        if off.abs() <= tolerance * along[lane] {
            radii[lane] = along[lane] / turn2;
        }
    }
    radii
}

/// Evaluates the support function for a face with this normal, which need not be unit: along the direction that the fit
/// predicts, else along the tilted direction, else along the normal. `along_normal`: true if it must be the normal;
/// `corners`, which returns the corners of the face, is then not called. `gap`: the allowed difference of the bounds,
/// metres.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn evaluate_beyond<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    fit: &mut SphereFit,
    corners: impl FnOnce(&VertexSet<N>) -> [Vertex; 3],
    normal: &Vec3,
    gap: f64,
    along_normal: bool,
) -> Result<(SupportSample, DirectionSource), Stop> {
    let upper = query.upper.depth;
    let mut dir = normalise_unscaled(normal).unwrap_or(query.upper.dir);
    let (mut source, mut value) = (DirectionSource::Normal, upper);
    // Once more is known than three corners. (Measured: with fits at once shallow boxes take 9 % more instructions, with
    // fits from three points on 7 %.)
    if !along_normal && (set.len() > 3 || fit.is_confirmed) {
        let corners = corners(set);
        let next = fit.choose(set, &corners, dir, &query.upper, gap);
        // Number by number: codegen, see README.
        dir = Vec3::new(next.dir.x, next.dir.y, next.dir.z);
        (source, value) = (next.source, next.value);
    }
    let sample = query.evaluate(set, &dir)?;
    match source {
        DirectionSource::Normal => {}
        DirectionSource::Prediction => {
            fit.is_confirmed = sample.h < value + MAX_MISS_REL * (upper - value);
            if !fit.is_confirmed {
                fit.failures += 1;
                fit.radius = [0.0; 2];
            }
        }
        DirectionSource::Tilted => {
            // If D is this sphere, no direction near the one of the upper bound has a lower support value.
            fit.is_confirmed = !(sample.h < upper);
            let is_wrong = upper - sample.h > (1.0 + MAX_MISS_REL) * (upper - value);
            fit.failures += u32::from(is_wrong);
        }
    }
    Ok((sample, source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::test_shapes::{Random, Rotation, Shape, ball, corners, difference, ellipsoid, hull};

    const ROUNDING: f64 = 1e3 * EPSILON;

    type Balls = MinkowskiDifference<Shape<'static>, Shape<'static>>;

    /// Balls of the radii 0.5 and 0.25, whose centers are 0.6 apart along x: the least support value is 0.15, along x.
    fn balls() -> Balls {
        difference(ball(Vec3::zeros(), 0.5), ball(Vec3::x() * 0.6, 0.25))
    }

    /// Evaluates three directions around x.
    fn corners_around_x(
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

    #[test]
    fn a_prediction_is_evaluated_and_confirmed() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        query.evaluate(&mut set, &Vec3::z()).unwrap();
        let mut fit = SphereFit::default();
        let normal = Vec3::new(1.0, 0.1, 0.1);
        let mut beyond = |fit: &mut SphereFit, along_normal| {
            let corners = |_: &VertexSet<24>| corners;
            evaluate_beyond(
                &mut query,
                &mut set,
                fit,
                corners,
                &normal,
                1e-6,
                along_normal,
            )
            .unwrap()
        };
        let (sample, source) = beyond(&mut fit, true);
        assert!(source == DirectionSource::Normal && sample.h > 0.151 && fit.radius == [0.0; 2]);
        let (sample, source) = beyond(&mut fit, false);
        assert!(source == DirectionSource::Prediction && (sample.h - 0.15).abs() < ROUNDING);
        assert!(fit.is_confirmed && fit.confirmed_radius() == fit.radius);
        // The upper bound is what the fit predicts: a direction beside it is next.
        let (sample, source) = beyond(&mut fit, false);
        assert!(source != DirectionSource::Prediction && sample.h > 0.15 - ROUNDING);
    }

    #[test]
    fn wrong_predictions_reset_the_radii_and_end_the_fit() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        query.evaluate(&mut set, &Vec3::z()).unwrap();
        let mut fit = SphereFit {
            compared: usize::MAX,
            ..SphereFit::default()
        };
        let mut evaluate = |fit: &mut SphereFit| {
            // The core points of these radii predict a lower support value than the balls have.
            fit.radius = [0.2, 0.2];
            let corners = |_: &VertexSet<24>| corners;
            let (query, set) = (&mut query, &mut set);
            let (_, source) =
                evaluate_beyond(query, set, fit, corners, &Vec3::x(), 1e-6, false).unwrap();
            source
        };
        for i in 0..MAX_FAILURES {
            let source = evaluate(&mut fit);
            assert_eq!((source, fit.failures), (DirectionSource::Prediction, i + 1));
            assert!(
                fit.radius == [0.0; 2] && !fit.is_confirmed && fit.confirmed_radius() == [0.0; 2]
            );
        }
        let source = evaluate(&mut fit);
        assert_eq!(source, DirectionSource::Normal);
    }

    /// An ellipsoid fits no sphere. Between x, along which its support value is least, and a direction 0.1 rad towards y it is
    /// an arc of the radius 0.35² / 0.25.
    #[test]
    fn a_direction_is_tilted_along_an_arc_of_no_sphere() {
        let body = ellipsoid(
            Vec3::new(0.25, 0.35, 0.5),
            Rotation::identity(),
            Vec3::zeros(),
        );
        let md = difference(body, ball(Vec3::zeros(), 0.0));
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::<24>::EMPTY);
        let corners = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[y, z]| {
            let n = Vec3::new(1.0, y, z).normalize();
            query.evaluate(&mut set, &n).unwrap().vertex()
        });
        let radius = arc_radius(&set, corners[1].pair, &query.upper).unwrap();
        assert!((radius - 0.49).abs() < 0.01, "{radius}");
        let (gap, normal) = (1e-4, Vec3::new(1.0, 0.05, 0.0).normalize());
        let tilted = |upper: &SupportPlane| {
            SphereFit::default().tilted_from_lowest(&set, &corners, upper, &normal, gap)
        };
        let (n, value) = tilted(&query.upper).unwrap();
        let first = 2.0 * (gap / radius).sqrt();
        assert!(
            (n.y / n.x - first).abs() < 1e-6 && n.z.abs() < ROUNDING && value == 0.25,
            "{n}"
        );
        // If the lowest point of the arc is farther from the upper bound, that is next.
        let mut upper = query.upper;
        upper.point.v.y -= 0.01;
        let (n, value) = tilted(&upper).unwrap();
        let shift = 0.01 / (radius - 0.25);
        assert!(
            (n.y / n.x - shift).abs() < 1e-6 && value < 0.25,
            "{n} {value}"
        );
        // A corner of a box is no arc.
        let md = difference(
            hull(&crate::test_shapes::corners(Vec3::repeat(1.0))),
            ball(Vec3::zeros(), 0.0),
        );
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::<24>::EMPTY);
        for n in [[1.0, 0.3, 0.2], [1.0, -0.1, 0.3]] {
            query
                .evaluate(&mut set, &Vec3::from(n).normalize())
                .unwrap();
        }
        let pairs = [0, 1].map(VertexSet::<24>::pair_of_entry);
        assert!(
            pairs
                .iter()
                .all(|pair| arc_radius(&set, *pair, &query.upper).is_none())
        );
    }

    #[test]
    fn a_tilted_direction_is_between_the_lowest_and_the_normal() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        let fit = SphereFit::warm([0.5, 0.25]);
        let gap = 1e-4;
        let upper = query
            .evaluate(&mut set, &Vec3::x())
            .map(|_| query.upper)
            .unwrap();
        for (normal, expected) in [
            (Vec3::new(1.0, 1.0, 0.0), true),
            (Vec3::x(), false),
            (Vec3::y(), false),
        ] {
            let tilted = fit.tilted_from_lowest(&set, &corners, &upper, &normal.normalize(), gap);
            assert!(
                tilted.is_none_or(|(n, value)| (n.norm() - 1.0).abs() < ROUNDING
                    && n.x > normal.normalize().x
                    && n.y > 0.0
                    && value == upper.depth)
            );
            assert!(expected || tilted.is_none(), "{tilted:?}");
        }
        let near = [Vec3::x(); 3].map(|n| query.evaluate(&mut set, &n).unwrap().vertex());
        let n = Vec3::new(1.0, 1.0, 0.0).normalize();
        let (tilted, _) = fit
            .tilted_from_lowest(&set, &near, &upper, &n, gap)
            .unwrap();
        // The first circle is as wide as the gap allows.
        let first = 2.0 * (gap / 0.75).sqrt();
        assert!((tilted.y / tilted.x - first).abs() < 1e-6, "{tilted}");
    }
}
