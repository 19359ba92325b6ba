// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The local search: finds a local minimum of the penetration depth by a walk from portal to portal on the known
//! vertices.
//!
//! Reference: W. Gao, 2023, Algorithm 4, see [`crate::paper::gao`].
//!
//! Terms. The *inner model* is the hull of the known differences ([`crate::minkowski`]). A *ray* starts at the origin
//! of D. The *foot* of a face is the projection of the origin on its plane. The *valley* of a minimum is the set of
//! directions from which descent of the support function ends in it. The *upper bound* is the least support value
//! evaluated, with its direction.
//!
//! 1. *Portal*: find one for the ray ([`discover`]), at first along the start direction, and refine it with known
//!    differences as long as one is above it. This gives the face of the inner model through which the ray leaves.
//! 2. *Minimum*: if the foot is in the face, the upper bound is equal to its distance, and its direction is within a
//!    small angle of the normal of the face, it is a candidate: go to step 6.
//! 3. *Other valley*: if the face is farther from the origin than the upper bound, the next ray is along the direction
//!    of the upper bound.
//! 4. *Prediction* of the sphere fits, else of a Newton step on a smooth D ([`Predictor`]): evaluated if it would
//!    lower the upper bound. If the evaluated value agrees, the next ray is along it. A prediction that is equal to the
//!    upper bound, or agrees with the evaluated value within most of the tolerance, is a candidate.
//! 5. *Normal*: if the foot is outside the face, the next ray is along the face's normal, without a callback. If it is
//!    inside, the normal is evaluated, and is a candidate if no point is above the face.
//! 6. *Confirmation* of a candidate: a face, unless the upper bound is lower; the prediction of a model, which a sharp tip
//!    can satisfy, by directions inclined by [`CONFIRM_ANGLE_RAD`], which are evaluated if no known direction is near.
//! 7. *Overlap*: proven if the tetrahedron of interior point and face contains the origin, else by GJK; or an evaluated
//!    direction separates.
//!
//! Departures. An outer step of the paper's Algorithm 4 takes a support call; here it is a step on the inner model.
//! Unlike in the paper, a ray is not followed until callbacks confirm its portal: it is left as soon as the inner model
//! suggests a better one. Steps 4 and 6 are new. A ray that is found again without a new support point is tilted
//! ([`STUCK_TILT_RAD`]).
//!
//! Outputs. [`Status::Converged`]: the overlap is proven, `dir` is a local minimum of the support function, and the
//! witness points are in their bodies, `depth` apart along `dir`. Any other status: `depth` and `dir` are sound if the
//! objects overlap, which is not proven: use the global query. [`Status::InconsistentSupport`]: also if a center is
//! outside its object.

use crate::geometry::barycentric;
use crate::geometry::plane::Tetrahedron;
use crate::gjk::overlap::contains_origin;
use crate::math::{Vec3, lesser, normalise_unscaled, tangents};
use crate::minkowski::predictor::{Model, Prediction, Predictor};
use crate::minkowski::sphere_fit::MIN_ANGLE2;
use crate::minkowski::support::{self, Difference};
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery, SupportSample};
use crate::minkowski::tuning::{
    CONFIRM_ANGLE_RAD, CONFIRM_RANGE_RAD, INSERT_HEIGHT_GAPS, MIN_GAIN_GAPS, NEGLIGIBLE_GAPS,
    SAME_VALLEY_COS,
};
use crate::minkowski::vertex_set::VertexSet;
use crate::portal::{Exact, MAX_STEPS, NearRay, Portal, PortalPlane, discover};
use crate::trace;
use crate::types::{Direction, Settings, Solution, Status};

/// The limit of support points of a walk. Measured: with it 12 of 12,000 walks on the recorded pairs end without a
/// minimum, the longest that ends with one takes 45; with 48, 2 % of coincident centers end so at fine tolerances. A power
/// of two: the index into a set of 60 takes 1 to 2 % more instructions.
pub const MAX_WALK_POINTS: usize = 64;
/// The difference of two depths, in tolerances, up to which they are equal. The rest of the tolerance is left for the error of
/// the witness points. Answers are insensitive to 0.25; with 1.5 one proof in 420 more has
/// witness points that are not the depth apart.
const EQUAL_TOLERANCES: f64 = 1.0 - NEGLIGIBLE_GAPS;

/// The tilt of a ray that is found again with no new entry, radians: it is in the plane of an edge of its portal, so that the
/// signs by which corners are replaced are rounding, and the face is one that it does not cross. Bodies of revolution on one
/// axis have such rays.
const STUCK_TILT_RAD: f64 = 1e-3 * CONFIRM_ANGLE_RAD;

/// The next step of a walk.
enum Step {
    /// Follow the ray along this unit vector.
    Ray(Vec3),
    /// Confirm a candidate: the foot is in the face, and the support plane is at the same distance.
    Face(SupportPlane),
    /// Confirm a candidate: the upper bound agrees with the prediction of this model.
    Fit(Model),
    /// End without a minimum.
    End(Status),
}

/// The state of a walk.
struct Walk<'w, 'q, D, const N: usize> {
    query: &'w mut SupportQuery<'q, D>,
    set: &'w mut VertexSet<N>,
    /// The portal of the ray; once it is refined, a face of the inner model.
    portal: Portal,
    predictor: Predictor,
    settings: &'w Settings,
    /// The difference of the centers, else the middle of the support points along the start direction and opposite
    /// to it.
    interior: Vec3,
    /// True if the interior point is the difference of the centers.
    is_centered: bool,
    iterations: u64,
}

/// Finds a local minimum of the penetration depth from `start`, by the steps at the head of this file. The set may have
/// entries. Any status but [`Status::Converged`] comes with the upper bound and the vertices of its support point.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
pub fn local_minimum<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    start: &Direction,
    settings: &Settings,
) -> Result<Solution, Stop> {
    const { assert!(N >= MAX_WALK_POINTS) };
    let mut walk = Walk {
        interior: query.center.map(|point| point.v).unwrap_or_default(),
        is_centered: query.center.is_some(),
        query,
        set,
        portal: Portal::default(),
        predictor: Predictor::exact(),
        settings,
        iterations: 0,
    };
    let ray = walk.start(start)?;
    walk.walk(ray)
}

impl<D: Difference, const N: usize> Walk<'_, '_, D, N> {
    /// Evaluates the start direction, and others if it is no good start. Returns the first ray.
    fn start(&mut self, start: &Direction) -> Result<Vec3, Stop> {
        trace::stage("local search");
        let first = self.query.evaluate_first(start)?;
        self.set.push(&self.query.upper.dir, &first);
        if !self.is_centered {
            // Not stored in the set: as a corner it would make the portals wide.
            let opposite = self.query.evaluate_point(&-start.n)?;
            self.interior = (first.v + opposite.v) * 0.5;
        }
        let to_origin = normalise_unscaled(&-self.interior).unwrap_or(start.n);
        // Without centers, or if the start direction leads to the far side: evaluate the direction from the interior
        // point to the origin too.
        if !self.is_centered || to_origin.dot(&start.n) < 0.0 {
            self.query.evaluate(self.set, &to_origin)?;
        }
        Ok(self.query.upper.dir)
    }

    /// Walks from ray to ray until a minimum is confirmed, and proves the overlap.
    fn walk(&mut self, mut ray: Vec3) -> Result<Solution, Stop> {
        for _ in 0..MAX_STEPS {
            if let Some(status) = self.limit() {
                return Ok(self.upper_bound(status));
            }
            let tolerance = self.tolerance();
            let known = self.set.len();
            let first = self.set.farthest_vertex(&ray);
            // The approximate length of the ray in D from the interior point.
            let length = (first.w - self.interior).dot(&ray);
            // The slope of the ring is half of that of the directions that confirm a minimum.
            let slope = 0.5 * CONFIRM_ANGLE_RAD;
            let ring = NearRay::Ring { axis: &ray, slope };
            let near2 = 0.5 * tolerance * length;
            let portal = discover(
                self.query,
                self.set,
                &ray,
                length,
                f64::INFINITY,
                near2,
                ring,
            )?;
            let Some(portal) = portal else {
                return Ok(self.upper_bound(Status::Rounding));
            };
            self.portal = portal;
            ray = match self.refine(&ray, tolerance)? {
                // The same portal would be found again.
                Step::Ray(next) if next == ray && self.set.len() == known => {
                    Direction::tilted(&next, STUCK_TILT_RAD).n
                }
                Step::Ray(next) => next,
                Step::End(status) => return Ok(self.upper_bound(status)),
                Step::Face(plane) => {
                    // Else a lower valley is known: the walk continues there.
                    if !(plane.depth > self.query.upper.depth + MIN_GAIN_GAPS * tolerance) {
                        return self.result(&plane, None);
                    }
                    self.query.upper.dir
                }
                Step::Fit(model) => {
                    if self.confirm_fit(model, tolerance)? {
                        let plane = self.query.upper;
                        return self.result(&plane, Some(model));
                    }
                    self.query.upper.dir
                }
            };
        }
        Ok(self.upper_bound(Status::Rounding))
    }

    /// Returns the effective tolerance, metres.
    fn tolerance(&self) -> f64 {
        self.query.scale.tolerance(self.settings.tolerance)
    }

    /// Returns why no further direction may be evaluated; `None` if one may.
    fn limit(&self) -> Option<Status> {
        if self.iterations >= self.settings.max_iterations {
            return Some(Status::IterationLimit);
        }
        (self.set.len() >= MAX_WALK_POINTS).then_some(Status::SupportLimit)
    }

    /// Evaluates unit `dir` and counts an iteration.
    fn evaluate(&mut self, dir: &Vec3) -> Result<SupportSample, Stop> {
        self.iterations += 1;
        self.query.evaluate(self.set, dir)
    }

    /// Refines the portal of the ray until there is a next step.
    ///
    /// One loop over one portal: the tests share its plane, and each ends the loop or evaluates a direction.
    fn refine(&mut self, ray: &Vec3, tolerance: f64) -> Result<Step, Stop> {
        for _ in 0..MAX_STEPS {
            let rounding = self.query.scale.height_eps();
            let level = INSERT_HEIGHT_GAPS * tolerance + rounding;
            let climbed = self.portal.climb(self.set, ray, Exact::Nothing, |face| {
                Some(level * face.length)
            });
            let Some(face) = climbed.and_then(|face| face.unit()) else {
                return Ok(Step::End(Status::Rounding));
            };
            let is_inside =
                face.offset > 0.0 && self.portal.is_crossed(&face.normal, 4.0 * rounding);
            if let Some(step) = self.step_on_known(&face, is_inside, tolerance) {
                return Ok(step);
            }
            let mut prediction = None;
            let worthwhile = self.query.upper.depth - MIN_GAIN_GAPS * tolerance;
            if !self.predictor.has_failed_above(&face.normal) {
                prediction = self.predict(&face.normal);
                if let Some(p) = prediction.filter(|p| !(p.value < worthwhile)) {
                    if self.is_upper_bound(&p, tolerance) {
                        return Ok(Step::Fit(p.model));
                    }
                    // Equal to the upper bound, but in another direction: evaluated too.
                    prediction = Some(p).filter(|p| self.equals_upper_bound(p.value, tolerance));
                }
                // The normal is a new ray in the same valley.
                let is_same_valley = !is_inside
                    && face.offset > 0.0
                    && face.normal.dot(&self.query.upper.dir) > SAME_VALLEY_COS
                    && !is_same(&face.normal, ray);
                if is_same_valley && prediction.is_none() {
                    return Ok(Step::Ray(face.normal));
                }
            }
            if let Some(status) = self.limit() {
                return Ok(Step::End(status));
            }
            let before = self.query.upper.depth;
            let sample = self.evaluate(&prediction.map_or(face.normal, |p| p.dir))?;
            if let Some(p) = &prediction {
                if self.predictor.judge(p, sample.h, before, tolerance) {
                    return Ok(match self.is_minimum(p, sample.h, tolerance) {
                        true => Step::Fit(p.model),
                        false => Step::Ray(p.dir),
                    });
                }
            }
            if face.height(&sample.w) > level {
                self.portal
                    .replace_corner(ray, sample.vertex(), Exact::Nothing);
            } else if prediction.is_some() {
                self.predictor.fail_above(&face.normal);
            } else {
                let plane = self.query.plane(self.set, sample.pair.a.into());
                return Ok(match is_inside {
                    true => Step::Face(plane),
                    false => Step::Ray(face.normal),
                });
            }
        }
        Ok(Step::End(Status::Rounding))
    }

    /// Returns the next step from a face with no known difference above it, if it can be taken without a callback.
    fn step_on_known(&self, face: &PortalPlane, is_inside: bool, tolerance: f64) -> Option<Step> {
        let upper = &self.query.upper;
        let angle2 = 2.0 * (1.0 - face.normal.dot(&upper.dir));
        if is_inside && self.equals_upper_bound(face.offset, tolerance) {
            // Up to this angle, whose plane is lower by depth × angle² / 2, the witness points are the depth apart within the
            // tolerance.
            let cone = 2.0 * self.portal.foot_depth(&face.normal) / face.offset;
            let allowed2 = if cone < CONFIRM_ANGLE_RAD {
                lesser(
                    CONFIRM_RANGE_RAD[0].powi(2),
                    2.0 * NEGLIGIBLE_GAPS * tolerance / upper.depth,
                )
            } else {
                0.25 * cone * cone
            };
            if angle2 <= allowed2 {
                return Some(Step::Face(*upper));
            }
        }
        // The upper bound is in a lower valley.
        let is_lower = face.offset > upper.depth + tolerance && !is_same(&face.normal, &upper.dir);
        is_lower.then_some(Step::Ray(upper.dir))
    }

    /// Returns the minimum that a model predicts near the portal. Its direction was not evaluated yet, or is that of the upper
    /// bound. (Measured: if directions may be evaluated again, the longest walks of balls and capsules take twice as many
    /// support points.)
    fn predict(&mut self, normal: &Vec3) -> Option<Prediction> {
        let (set, upper, corners) = (&*self.set, &self.query.upper, &self.portal.corners);
        (self.predictor).minimum(set, corners, normal, upper, |p| is_new(set, upper, &p.dir))
    }

    /// Returns whether the upper bound is `value`, metres.
    fn equals_upper_bound(&self, value: f64, tolerance: f64) -> bool {
        (value - self.query.upper.depth).abs() <= EQUAL_TOLERANCES * tolerance
    }

    /// Returns whether a prediction is the upper bound, and the model's witness points coincide after obj2 is moved by
    /// the upper bound.
    fn is_upper_bound(&self, prediction: &Prediction, tolerance: f64) -> bool {
        let SupportPlane { depth, dir, .. } = self.query.upper;
        let turn2 = (prediction.dir - dir).norm_squared();
        let is_coincident = match prediction.model {
            Model::Sphere => {
                let off = (self.predictor.fit.sum() - depth).powi(2);
                turn2 * self.predictor.fit.sum() <= EQUAL_TOLERANCES * tolerance
                    && turn2 * off <= depth * tolerance
            }
            _ => self.vertices_coincide(tolerance),
        };
        is_coincident && self.equals_upper_bound(prediction.value, tolerance)
    }

    /// Returns whether the two vertices of the upper bound coincide after obj2 is moved by it.
    fn vertices_coincide(&self, tolerance: f64) -> bool {
        let SupportPlane {
            depth, dir, point, ..
        } = self.query.upper;
        (point.v - dir * depth).norm_squared() <= depth * tolerance
    }

    /// Returns whether a prediction that came true with the support value `h`, metres, is a candidate.
    fn is_minimum(&self, prediction: &Prediction, h: f64, tolerance: f64) -> bool {
        (h - prediction.value).abs() <= EQUAL_TOLERANCES * tolerance
            && (prediction.model == Model::Sphere || self.vertices_coincide(tolerance))
    }

    /// Returns whether the upper bound, which a model predicts, is a minimum. A sharp tip can satisfy the sphere fit.
    fn confirm_fit(&mut self, model: Model, tolerance: f64) -> Result<bool, Stop> {
        let n = self.query.upper.dir;
        if model != Model::Sphere {
            let flattest = self.predictor.flattest;
            return self.is_lowest(&n, &[flattest, -flattest], None, tolerance);
        }
        let [e1, e2] = tangents(&n);
        let e2 = e2 * 0.75_f64.sqrt();
        let ring = [e1, e2 - e1 * 0.5, -e2 - e1 * 0.5];
        // The largest distance of two estimates of a sphere's center.
        let center_tolerance = tolerance + self.query.scale.height_eps();
        if !self.is_lowest(&n, &ring, Some(center_tolerance), tolerance)? {
            return Ok(false);
        }
        let upper = &self.query.upper;
        let fit = &mut self.predictor.fit;
        let corners = &self.portal.corners;
        let is_confirmed = fit.are_spheres_confirmed(self.set, corners, upper, center_tolerance);
        if !is_confirmed {
            fit.refute();
        }
        Ok(is_confirmed)
    }

    /// Returns whether no support value of unit `n` inclined towards one of the unit vectors `directions`, which are
    /// perpendicular to it, is lower than the upper bound. Evaluates them, unless a direction near the inclined one was
    /// evaluated; `false` too if a limit is reached. `center_tolerance`: for spheres, metres, see
    /// [`is_confirmed_twice`](crate::minkowski::sphere_fit::SphereFit::is_confirmed_twice).
    fn is_lowest(
        &mut self,
        n: &Vec3,
        directions: &[Vec3],
        center_tolerance: Option<f64>,
        tolerance: f64,
    ) -> Result<bool, Stop> {
        trace::stage("confirmation");
        let before = self.query.upper.depth;
        let [near, far] = CONFIRM_RANGE_RAD;
        // The center of a sphere is the same however far the direction.
        let far = center_tolerance.map_or(far, |_| f64::INFINITY);
        let mut is_known = [false; 3];
        for k in 0..self.set.len() {
            let dir = self.set.dir(k);
            let cosine = dir.dot(n);
            let off = dir - n * cosine;
            let sine2 = off.norm_squared();
            if !(cosine > 0.0 && sine2 > near * near && sine2 < far * far) {
                continue;
            }
            let pair = VertexSet::<N>::pair_of_entry(k);
            let is_accepted = center_tolerance.is_none_or(|tolerance| {
                self.predictor
                    .fit
                    .is_confirmed_twice(self.set, pair, tolerance)
            });
            for (is_known, direction) in is_known.iter_mut().zip(directions) {
                let along = off.dot(direction);
                // Within 60 degrees: a known direction confirms the closest of three.
                *is_known |= is_accepted && along > 0.0 && along * along > 0.25 * sine2;
            }
        }
        for (direction, _) in directions.iter().zip(is_known).filter(|(_, known)| !known) {
            if self.limit().is_some() {
                return Ok(false);
            }
            let inclined = n + direction * CONFIRM_ANGLE_RAD;
            let sample = self.evaluate(&(inclined / inclined.norm()))?;
            if sample.h < before - MIN_GAIN_GAPS * tolerance {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Proves the overlap. Returns the confirmed minimum with its witness points: those of the face without a model.
    fn result(&mut self, plane: &SupportPlane, model: Option<Model>) -> Result<Solution, Stop> {
        let SupportPlane {
            dir, depth, point, ..
        } = plane;
        let (point1, point2) = match model {
            Some(Model::Sphere) => self
                .predictor
                .fit
                .witnesses(self.set, &self.portal.corners, dir)
                .into(),
            Some(_) => (point.v1, point.v2),
            None => {
                let [a, b, c] = self.portal.points();
                let weights = barycentric::triangle(&(dir * *depth), &a, &b, &c).weights;
                let corners = self.portal.corners.map(|v| self.set.point(v.pair));
                support::witnesses(&weights, corners.each_ref())
            }
        };
        let is_center_outside = self.is_centered && self.query.center.is_none();
        if is_center_outside || self.query.is_inconsistent(self.set) {
            return Ok(self.upper_bound(Status::InconsistentSupport));
        }
        self.prove_overlap()?;
        self.query.confirm_upper()?;
        let mut hit = Solution {
            depth: *depth,
            dir: *dir,
            normal: *dir,
            is_general: plane.direction().is_general(),
            point1,
            point2,
            ..self.upper_bound(Status::Converged)
        };
        // A face and its support plane differ by the rounding of both.
        if !hit.has_sound_witnesses(self.tolerance() + self.query.scale.height_eps()) {
            hit.status = Status::Rounding;
        }
        Ok(hit)
    }

    /// Returns the upper bound, with the vertices of its support point for witness points.
    fn upper_bound(&self, status: Status) -> Solution {
        let SupportPlane {
            depth, dir, point, ..
        } = self.query.upper;
        Solution {
            depth,
            dir,
            normal: dir,
            is_general: self.query.upper.direction().is_general(),
            point1: point.v1,
            point2: point.v2,
            iterations: self.iterations,
            status,
            ..Solution::default()
        }
    }

    /// Proves that the origin is in D: by the tetrahedron of interior point and face if it contains the origin, else by
    /// GJK, which evaluates directions if the known vertices are not enough.
    fn prove_overlap(&mut self) -> Result<(), Stop> {
        let [a, b, c] = self.portal.points();
        let v = self.interior;
        let ulp = f64::EPSILON * self.query.scale.size();
        let tetrahedron = Tetrahedron::new([v, a, b, c], ulp);
        if tetrahedron.is_some_and(|t| t.inner_radius() > t.error) {
            return Ok(());
        }
        let center = self.query.center;
        let dir = normalise_unscaled(&-v).unwrap_or(self.query.upper.dir);
        contains_origin(self.query, self.set, center, &dir, false).map(|_| ())
    }
}

/// Returns whether unit `dir` was not evaluated yet, or is the direction of the upper bound.
fn is_new<const N: usize>(set: &VertexSet<N>, upper: &SupportPlane, dir: &Vec3) -> bool {
    is_same(&upper.dir, dir) || !(0..set.len()).any(|k| is_same(&set.dir(k), dir))
}

/// Returns whether two unit vectors count as the same, by their difference: the product of vectors that are rounded to single
/// precision differs from 1 by as much as that of vectors 3e-4 rad apart.
fn is_same(a: &Vec3, b: &Vec3) -> bool {
    (a - b).norm_squared() <= MIN_ANGLE2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{EPSILON, perpendicular};
    use crate::minkowski::support::{Fault, SupportMap, SupportPoint};
    use crate::test_shapes::{
        Random, Rotation, ball, capsule, corners, difference, ellipsoid, hull, placed,
    };

    const SETTINGS: Settings = Settings {
        max_iterations: 1000,
        ..Settings::new(if EPSILON < 1e-10 { 1e-7 } else { 1e-4 })
    };

    type Walked = Result<Solution, Stop>;

    /// Returns the hull of a ball about `at` and the point `at` + `tip`.
    fn drop(radius: f64, tip: Vec3, at: Vec3) -> impl Fn(&Vec3) -> Vec3 {
        move |n: &Vec3| {
            at + if n.dot(&tip) > radius {
                tip
            } else {
                n * radius
            }
        }
    }

    /// Returns the result and the number of support points.
    fn walk<D: Difference>(
        md: &D,
        center: Option<Vec3>,
        start: &Vec3,
        settings: &Settings,
    ) -> (Walked, u64) {
        let center = center.map(|v| SupportPoint {
            v,
            v1: v,
            v2: Vec3::zeros(),
        });
        let before = md.supports();
        let mut query = SupportQuery::new(md, center.as_ref(), 0.0);
        let mut set = VertexSet::<MAX_WALK_POINTS>::EMPTY;
        let start = Direction::exact(*start);
        let found = local_minimum(&mut query, &mut set, &start, settings);
        (found, md.supports() - before)
    }

    /// Asserts that no direction near that of the result is lower, and that the witness points are in their bodies and
    /// coincide after obj2 is moved by the depth.
    fn check<D: Difference>(md: &D, hit: &Solution, r: &mut Random) {
        let tolerance = SETTINGS.tolerance;
        let h = |n: &Vec3| n.dot(&md.support(n).unwrap().v);
        assert!((h(&hit.dir) - hit.depth).abs() <= 64.0 * EPSILON);
        let w = hit.point1 - hit.point2;
        let along = w.dot(&hit.dir);
        assert!(
            (along - hit.depth).abs() <= 1.5 * tolerance,
            "{along} {hit:?}"
        );
        let across = (w - hit.dir * along).norm();
        let most = (2.0 * hit.depth * tolerance).sqrt() + tolerance;
        assert!(across <= 1.5 * most, "{across} {most} {hit:?}");
        for step in [1e-3, 0.01, 0.02, 1.0] {
            for _ in 0..20 {
                let n = (hit.dir + r.vector(step)).normalize();
                let s = md.support(&n).unwrap();
                if step < 0.1 {
                    assert!(h(&n) >= hit.depth - 4.0 * tolerance, "{} {hit:?}", h(&n));
                }
                let inside = [n.dot(&(s.v1 - hit.point1)), n.dot(&(hit.point2 - s.v2))];
                assert!(inside.iter().all(|d| *d >= -64.0 * EPSILON), "{inside:?}");
            }
        }
    }

    /// Walks from many starts, with and without centers, and checks each result.
    fn check_walks<A: SupportMap, B: SupportMap>(
        r: &mut Random,
        mut pair: impl FnMut(&mut Random, Vec3) -> (A, B),
    ) {
        let mut converged = 0;
        for round in 0..200 {
            let at = r.direction() * r.within(0.2, 0.6);
            let (a, b) = pair(r, at);
            let md = difference(a, b);
            let center = (round % 2 == 0).then_some(-at);
            let start = r.direction();
            let (found, count) = walk(&md, center, &start, &SETTINGS);
            assert!(count <= MAX_WALK_POINTS as u64 + 30, "{count}");
            match found {
                Ok(hit) if hit.status == Status::Converged => {
                    converged += 1;
                    check(&md, &hit, r);
                }
                Ok(_) => {}
                Err(Stop::Separated(Direction { n, .. })) => {
                    assert!(n.dot(&md.support(&n).unwrap().v) <= 64.0 * EPSILON)
                }
                Err(Stop::Fault(fault)) => panic!("{fault:?}"),
            }
        }
        assert!(converged >= 190, "{converged}");
    }

    /// A direction that was rounded to single precision is the same; one that differs by more is not.
    #[test]
    fn rounded_directions_are_the_same() {
        let mut r = Random::new(20);
        for _ in 0..1000 {
            let n = r.direction();
            let rounded = n.map(|x| f64::from(x as f32));
            assert!(is_same(&n, &rounded) && is_same(&rounded, &rounded), "{n}");
            let other = n + perpendicular(&n) * 2e-5;
            assert!(!is_same(&rounded, &other) && !is_same(&n, &(n * f64::NAN)));
        }
    }

    #[test]
    fn polytopes_end_in_a_local_minimum() {
        let mut r = Random::new(21);
        check_walks(&mut r, |r, at| {
            let cube = corners(Vec3::new(0.5, 0.6, 0.7));
            let [a, b] = [Vec3::zeros(), at].map(|at| placed(&cube, &r.rotation(), at));
            (
                move |n: &Vec3| hull(&a).support(n),
                move |n: &Vec3| hull(&b).support(n),
            )
        });
    }

    #[test]
    fn round_shapes_end_in_a_local_minimum() {
        let mut r = Random::new(22);
        check_walks(&mut r, |r, at| {
            let axis = r.direction() * 0.5;
            (capsule(-axis, axis, 0.4), ball(at, r.within(0.3, 0.6)))
        });
        check_walks(&mut r, |r, at| {
            let cube = corners(Vec3::new(0.5, 0.6, 0.7));
            let cube = placed(&cube, &r.rotation(), Vec3::zeros());
            let axis = r.direction() * 0.5;
            (
                move |n: &Vec3| hull(&cube).support(n),
                capsule(at - axis, at + axis, 0.4),
            )
        });
    }

    #[test]
    fn smooth_shapes_end_in_a_local_minimum() {
        let mut r = Random::new(23);
        check_walks(&mut r, |r, at| {
            let mut radii = || Vec3::from_fn(|_, _| r.within(0.4, 0.9));
            let (one, two) = (radii(), radii());
            (
                ellipsoid(one, r.rotation(), Vec3::zeros()),
                ellipsoid(two, r.rotation(), at),
            )
        });
    }

    /// The depth is within the tolerance, with and without centers, and takes at most 15 support points.
    #[test]
    fn nearly_touching_spheres_take_few_support_points() {
        let mut r = Random::new(24);
        for round in 0..400 {
            let radius = [12.97, 0.3][round % 2];
            let depth = if EPSILON < 1e-10 { 1.18e-7 } else { 1e-3 };
            let way = r.direction();
            let at = way * (radius + 0.001_08 - depth);
            let md = difference(ball(Vec3::zeros(), 0.001_08), ball(at, radius));
            let tolerance = [1e-4, 1e-6, 1e-9, 0.0][round / 2 % 4];
            let settings = Settings {
                tolerance,
                ..SETTINGS
            };
            let center = (round / 8 % 2 == 0).then_some(-at);
            let (found, count) = walk(&md, center, &Vec3::x(), &settings);
            let hit = found.unwrap();
            assert_eq!(hit.status, Status::Converged);
            assert!(count <= 15, "{round}: {count}");
            let ulps = 64.0 * EPSILON * radius;
            assert!((hit.depth - depth).abs() <= tolerance.max(ulps), "{hit:?}");
        }
    }

    /// Any direction is a minimum: the fits predict none, and other searches take dozens of support points.
    #[test]
    fn concentric_balls_take_few_support_points() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.5));
        let (found, count) = walk(&md, Some(Vec3::zeros()), &Vec3::x(), &SETTINGS);
        let hit = found.unwrap();
        assert_eq!(hit.status, Status::Converged);
        assert!(
            (hit.depth - 1.5).abs() <= 64.0 * EPSILON && count <= 15,
            "{count}"
        );
    }

    /// The depth is within the tolerance, however close to it the distance of the centers is.
    #[test]
    fn nearly_concentric_balls_take_few_support_points() {
        let mut r = Random::new(26);
        for round in 0..300 {
            let finest = if EPSILON < 1e-10 { 1e-9 } else { 1e-3 };
            let tolerance = [1.0, 10.0, 100.0][round % 3] * finest;
            let at = r.direction() * (tolerance * r.within(0.1, 3.0));
            let md = difference(ball(Vec3::zeros(), 1.0), ball(at, 0.5));
            let settings = Settings {
                tolerance,
                ..SETTINGS
            };
            let (found, count) = walk(&md, Some(-at), &r.direction(), &settings);
            let hit = found.unwrap();
            assert_eq!(hit.status, Status::Converged, "{round}");
            assert!(count <= 25, "{round}: {count}");
            assert!((hit.depth - 1.5 + at.norm()).abs() <= tolerance, "{hit:?}");
        }
    }

    /// The face y = 1 and one tilted by 30 degrees share an edge at x = 0: along y the foot is on the edge, and the
    /// support value decreases to 0.87 towards the normal of the other face.
    #[test]
    fn a_stationary_edge_is_no_minimum() {
        let wall = |x: f64, y: f64| [Vec3::new(x, y, -2.0), Vec3::new(x, y, 2.0)];
        let slope = (30.0_f64).to_radians().tan();
        let points = [
            wall(0.0, 1.0),
            wall(-3.0, 1.0),
            wall(2.0, 1.0 - 2.0 * slope),
            wall(2.0, -3.0),
            wall(-3.0, -3.0),
        ]
        .concat();
        let md = difference(hull(&points), |_: &Vec3| Vec3::zeros());
        for center in [None, Some(Vec3::new(-0.5, -1.0, 0.0))] {
            let (found, _) = walk(&md, center, &Vec3::y(), &SETTINGS);
            let hit = found.unwrap();
            assert_eq!(hit.status, Status::Converged);
            let depth = (30.0_f64).to_radians().cos();
            assert!((hit.depth - depth).abs() <= 1e-6, "{hit:?}");
        }
    }

    /// The tip of a drop satisfies the sphere fit in one direction.
    #[test]
    fn the_tip_of_a_drop_is_no_minimum() {
        let mut r = Random::new(25);
        for _ in 0..200 {
            let turn = r.rotation();
            let tip = turn * Vec3::z() * r.within(0.8, 1.5);
            let md = difference(drop(0.5, tip, Vec3::zeros()), ball(tip * 0.3, 0.1));
            let start = (tip.normalize() + r.vector(0.2)).normalize();
            let hit = walk(&md, Some(tip * -0.3), &start, &SETTINGS).0.unwrap();
            if hit.status == Status::Converged {
                check(&md, &hit, &mut r);
            }
        }
    }

    /// Two drops, nearly concentric: at the minimum, ball and tip often have equal support values, and D is none of the
    /// spheres that a fit has found.
    #[test]
    fn drops_whose_balls_coincide_have_sound_witness_points() {
        let mut r = Random::new(29);
        let mut converged = 0;
        for round in 0..1000 {
            let tips = [r.direction() * 0.77, r.direction() * 0.32];
            let at = r.vector(0.005);
            let md = difference(drop(0.3, tips[0], Vec3::zeros()), drop(0.09, tips[1], at));
            let settings = Settings {
                tolerance: 0.0,
                ..SETTINGS
            };
            let center = (round % 2 == 0).then_some(-at);
            let hit = walk(&md, center, &r.direction(), &settings).0.unwrap();
            if hit.status == Status::Converged {
                converged += 1;
                check(&md, &hit, &mut r);
            }
        }
        assert!(converged > 500, "{converged}");
    }

    /// The foot is in a face of the inner model of two drops, and a nearby direction has a lower support value.
    #[test]
    fn a_face_above_the_least_support_value_is_no_minimum() {
        let axes = [
            Vec3::new(-0.932_477_614_117, -0.171_060_354_810, 0.318_156_964_693),
            Vec3::new(0.556_685_227_222, 0.630_027_878_454, -0.541_448_454_236),
        ];
        let at = Vec3::new(-0.000_234_222_086, -0.000_430_533_990, -0.000_294_359_649);
        let md = difference(
            drop(
                0.326_002_707_228,
                axes[0] * 1.042_213_933_554,
                Vec3::zeros(),
            ),
            drop(0.215_498_975_870, axes[1] * 0.820_162_066_817, at),
        );
        let settings = Settings {
            tolerance: if EPSILON < 1e-10 { 3.2e-6 } else { 3.2e-4 },
            ..SETTINGS
        };
        let h = |n: &Vec3| n.dot(&md.support(n).unwrap().v);
        let mut r = Random::new(30);
        let mut converged = 0;
        for round in 0..20 {
            // The first start leads to that face.
            let start = [Vec3::x(), r.direction()][usize::from(round > 0)];
            let hit = walk(&md, None, &start, &settings).0.unwrap();
            if hit.status != Status::Converged {
                continue;
            }
            converged += 1;
            for _ in 0..200 {
                let n = (hit.dir + r.vector(0.05)).normalize();
                let lower = h(&n);
                assert!(
                    lower >= hit.depth - 4.0 * settings.tolerance,
                    "{round}: {lower} {hit:?}"
                );
            }
        }
        assert!(converged > 5, "{converged}");
    }

    /// Cones on one axis, walks from near their slanted sides: the rays are in the plane of an edge and the axis.
    #[test]
    fn cones_on_one_axis_end_in_a_local_minimum() {
        let cone = |radius: f64, half: f64, z: f64| {
            move |n: &Vec3| {
                let r = n.x.hypot(n.y);
                if half * n.z * 2.0 > radius * r {
                    return Vec3::z() * (z + half);
                }
                // The middle of the base along the axis.
                let rim = if r > 0.0 { radius / r } else { 0.0 };
                Vec3::new(n.x * rim, n.y * rim, z - half)
            }
        };
        let mut r = Random::new(31);
        for round in 0..2000 {
            let (one, two) = (r.within(0.3, 0.6), r.within(0.3, 0.6));
            let heights = [r.within(0.6, 1.0), r.within(0.2, 0.4)];
            let md = difference(cone(one, heights[0], 0.0), cone(two, heights[1], 0.01));
            let side = Vec3::new(1.0, 0.0, 0.5 * one / heights[0]);
            let turn = Rotation::from_axis_angle(&Vec3::z_axis(), r.within(0.0, 6.0));
            let start = (turn * side + Vec3::z() * r.within(-1e-4, 1e-4)).normalize();
            let hit = walk(&md, None, &start, &SETTINGS).0.unwrap();
            assert_eq!(hit.status, Status::Converged, "{round}");
            check(&md, &hit, &mut r);
        }
    }

    /// A ball that has passed through a plate: along the normal of the side where it was there is a local minimum of
    /// the support function, but no overlap.
    #[test]
    fn a_minimum_of_separated_objects_is_a_miss() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.01));
        for z in [0.12, 0.2, 0.5] {
            let at = Vec3::new(0.1, 0.05, z);
            let md = difference(hull(&plate), ball(at, 0.1));
            for center in [None, Some(-at)] {
                let (found, _) = walk(&md, center, &-Vec3::z(), &SETTINGS);
                let Err(Stop::Separated(Direction { n, .. })) = found else {
                    panic!("{found:?}");
                };
                assert!(n.dot(&md.support(&n).unwrap().v) <= 0.0);
            }
        }
    }

    #[test]
    fn limits_are_kept_and_the_depth_is_sound() {
        let mut r = Random::new(26);
        let one = ellipsoid(
            Vec3::new(0.9, 0.5, 0.7),
            Rotation::identity(),
            Vec3::zeros(),
        );
        let md = difference(one, ball(Vec3::x() * 0.4, 0.5));
        for max_iterations in 0..12 {
            let settings = Settings {
                max_iterations,
                ..SETTINGS
            };
            let (found, _) = walk(&md, Some(Vec3::x() * -0.4), &r.direction(), &settings);
            let hit = found.unwrap();
            assert!(hit.iterations <= max_iterations);
            assert!(max_iterations > 0 || hit.status == Status::IterationLimit);
            let h = hit.dir.dot(&md.support(&hit.dir).unwrap().v);
            assert!((h - hit.depth).abs() <= 64.0 * EPSILON);
        }
    }

    #[test]
    fn bad_callbacks_end_the_walk() {
        let mut r = Random::new(27);
        let nan = |n: &Vec3| {
            if n.x > 0.3 {
                Vec3::repeat(f64::NAN)
            } else {
                *n
            }
        };
        let md = difference(nan, ball(Vec3::x() * 0.5, 1.0));
        let (found, _) = walk(&md, None, &Vec3::x(), &SETTINGS);
        assert!(matches!(found, Err(Stop::Fault(Fault::NonFinite))));
        // Noise of a tenth of the size.
        let noise = core::cell::RefCell::new(Random::new(28));
        let rough = |n: &Vec3| n + noise.borrow_mut().vector(0.1);
        let md = difference(rough, ball(Vec3::x() * 0.5, 1.0));
        for _ in 0..200 {
            let (_, count) = walk(&md, None, &r.direction(), &SETTINGS);
            assert!(count <= 2 * MAX_WALK_POINTS as u64, "{count}");
        }
    }
}
