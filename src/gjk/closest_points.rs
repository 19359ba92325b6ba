// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The distance of two objects, with a lower and an upper bound, and their closest points: the GJK algorithm
//! ([`Simplex`]) on known vertices ([`crate::minkowski`]).
//!
//! 1. The closest point of the simplex is an upper bound of the distance; −h(n), h being the support function of D,
//!    is a lower one for every unit n.
//! 2. Add known differences to the simplex, the farthest towards the origin first, as long as one is farther
//!    towards the origin than the simplex.
//! 3. Evaluate the direction from the simplex to the origin, or the direction in which the sphere fits
//!    ([`Predictor`]) predict the support plane closest to the origin; the prediction is exact at once for
//!    polytopes rounded by a sphere.
//! 4. The evaluated direction is limited to [`MAX_EXTRAPOLATION_TAN`] from the normal of the best plane found so far: a
//!    direction farther away returns a vertex on the far side of D instead of a corner of the closest face.
//! 5. Stop if the gap between the bounds is within the tolerance, if the origin is in the simplex, or if the
//!    distance is proven to be larger than `max_distance`.
//!
//! Outputs, valid for every [`Status`]: `lower` is a bound along `normal`; `upper` is the distance
//! of the two points. `is_inside`: the origin is in the simplex, and the points coincide.

use crate::gjk::overlap::{CAPACITY, OverlapProof};
use crate::gjk::simplex::Simplex;
use crate::math::{ITERATION_CAP, Vec3, larger, unit};
use crate::minkowski::predictor::Predictor;
use crate::minkowski::support::{self, Difference, Fault};
use crate::minkowski::support_query::SupportQuery;
use crate::minkowski::tuning::{INSERT_HEIGHT_GAPS, MAX_FAILURES, MIN_GAIN_GAPS};
use crate::minkowski::vertex_set::{Vertex, VertexSet};
use crate::portal::MAX_STEPS;
use crate::trace;
use crate::types::{Direction, Status};

/// The largest tangent of the angle from the normal of the best plane to a direction that is evaluated. Measured: without a
/// limit, distances take 4 to 12 % more support points; with 1.0, two of 2,100 exactly touching pairs take 882 of them
/// (campaign `wide`, seed 4242).
const MAX_EXTRAPOLATION_TAN: f64 = 0.6;

/// Stop criterion of the bounds.
pub struct Goal {
    /// Largest gap between the bounds, metres.
    pub tolerance: f64,
    /// Sum of the margins, subtracted from the distance, metres. If the result is near 0, the search continues
    /// until a separating plane is found or an overlap of the margins is known.
    pub margin: f64,
    /// The search ends when the distance is proven to be larger than this, metres.
    pub max_distance: f64,
    /// Limit on the support points.
    pub max_samples: u64,
}

/// The bounds of the distance and the closest points.
#[derive(Clone, Copy, Debug)]
pub struct ClosestPoints {
    /// The largest −h(n), metres.
    pub lower: f64,
    /// Its direction.
    pub normal: Direction,
    /// The distance of the points, metres.
    pub upper: f64,
    /// The closest point of obj1.
    pub point1: Vec3,
    /// The closest point of obj2.
    pub point2: Vec3,
    /// Number of support points.
    pub iterations: u64,
    /// Why the search ended; converged also if the origin is in the simplex.
    pub status: Status,
    /// True if the origin is in the simplex.
    pub is_inside: bool,
}

/// Finds the closest points. Starts along `start`. `predictor`: may hold the sphere radii of the last query.
///
/// # Errors
/// [`Fault::NonFinite`].
#[inline(always)]
pub fn closest_points<D: Difference>(
    query: &mut SupportQuery<'_, D>,
    predictor: &mut Predictor,
    start: &Direction,
    goal: &Goal,
) -> Result<ClosestPoints, Fault> {
    let mut search = ClosestPointsSearch {
        query,
        predictor,
        set: VertexSet::EMPTY,
        simplex: Simplex::EMPTY,
        to_origin: start.n,
        upper: f64::INFINITY,
        was_prediction: false,
        is_inside: false,
    };
    let before = search.query.support_points();
    let status = search.approach(goal, start)?;
    search.query.confirm_upper()?;
    let (point1, point2) = search.points();
    let iterations = search.query.support_points() - before;
    let bound = search.query.upper;
    Ok(ClosestPoints {
        lower: -bound.depth,
        normal: bound.direction(),
        upper: (point2 - point1).norm(),
        point1,
        point2,
        iterations,
        status,
        is_inside: search.is_inside,
    })
}

/// State of a search.
struct ClosestPointsSearch<'s, 'q, D> {
    query: &'s mut SupportQuery<'q, D>,
    predictor: &'s mut Predictor,
    set: VertexSet<CAPACITY>,
    simplex: Simplex,
    /// From the simplex to the origin, of any length.
    to_origin: Vec3,
    /// The distance of the simplex, metres.
    upper: f64,
    /// True if the last direction was a prediction; the next one is then none. With a radius that is far too large,
    /// e.g. of a foreign state, each prediction is confirmed but turns the plane by very little.
    was_prediction: bool,
    /// True if the simplex contains the origin.
    is_inside: bool,
}

impl<D: Difference> ClosestPointsSearch<'_, '_, D> {
    /// Returns the closest points; if the origin is in the simplex, two coincident points of the objects.
    fn points(&self) -> (Vec3, Vec3) {
        let point = |corner: Vertex| self.set.point(corner.pair);
        if self.is_inside {
            let corners = self.simplex.tetrahedron().map(point);
            return OverlapProof::Simplex(corners).witnesses();
        }
        let corners = self.simplex.corners().map(point);
        support::witnesses(&self.simplex.weights(), corners.each_ref())
    }

    /// Runs the search.
    fn approach(&mut self, goal: &Goal, start: &Direction) -> Result<Status, Fault> {
        trace::stage("closest points");
        let first = self
            .query
            .evaluate_signed(&mut self.set, &start.n, start.tilt)?
            .vertex();
        self.add(first);
        let mut closest = f64::INFINITY;
        let mut stalls = 0;
        // Whether the last evaluation was towards the origin; whether the last direction towards it was limited.
        let (mut is_step, mut was_limited) = (false, false);
        for _ in 1..larger(goal.max_samples, 1) {
            for _ in 0..MAX_STEPS {
                match self.add_farthest(INSERT_HEIGHT_GAPS * self.gap(goal)) {
                    None => return Ok(Status::Converged),
                    Some(true) => (),
                    Some(false) => break,
                }
            }
            if self.is_goal_met(goal) {
                return Ok(Status::Converged);
            }
            if is_step {
                if !(self.upper < closest) {
                    stalls += 1;
                }
                closest = self.upper;
            }
            let Some(dir) = unit(&self.to_origin).filter(|_| stalls <= MAX_FAILURES) else {
                return Ok(Status::Rounding);
            };
            is_step = !self.evaluate_prediction(&dir, self.gap(goal))?;
            if !is_step {
                continue;
            }
            let limited = self.limit_angle(&dir).filter(|_| !was_limited);
            was_limited = limited.is_some();
            if let Some(n) = limited {
                is_step = false;
                self.query.evaluate_signed(&mut self.set, &n, 0.0)?;
                continue;
            }
            let w = self
                .query
                .evaluate_signed(&mut self.set, &dir, 0.0)?
                .vertex();
            // By more than the errors of two points.
            let level = 2.0 * self.query.scale.support_eps();
            if self.height(&dir, &w.w) > level && !self.add(w) {
                return Ok(Status::Converged);
            }
        }
        Ok(Status::of_early_end(0, goal.max_samples, ITERATION_CAP).unless(self.is_goal_met(goal)))
    }

    /// Returns the largest accepted gap between the bounds, metres; a NaN tolerance counts as infinite.
    fn gap(&self, goal: &Goal) -> f64 {
        self.query.scale.tolerance(goal.tolerance)
    }

    /// Returns whether the bounds meet the goal.
    fn is_goal_met(&self, goal: &Goal) -> bool {
        let contact_eps = self.query.scale.contact_eps();
        let bound = -self.query.upper.depth;
        let (lower, upper) = (bound - goal.margin, self.upper - goal.margin);
        // Closed bounds do not suffice: the sign of the result must be decided too. It is if a plane separates
        // the objects, or if their margins overlap and the cores are known to be separated or to touch.
        let has_plane = |distance: f64| distance >= -contact_eps;
        let is_sign_decided = has_plane(lower)
            || !(upper > contact_eps) && (self.upper > contact_eps || has_plane(bound));
        lower > goal.max_distance || is_sign_decided && self.upper - bound <= self.gap(goal)
    }

    /// Returns by how much a point is farther along `n` than the simplex.
    #[inline(always)]
    fn height(&self, n: &Vec3, w: &Vec3) -> f64 {
        n.dot(&(w - self.simplex.corners()[0].w))
    }

    /// Returns the direction [`MAX_EXTRAPOLATION_TAN`] from the best plane's normal towards unit `dir`; `None` if `dir`
    /// itself is within that angle.
    fn limit_angle(&self, dir: &Vec3) -> Option<Vec3> {
        let best = self.query.upper.dir;
        let along = dir.dot(&best);
        let perpendicular = dir - best * along;
        let length = perpendicular.norm();
        if !(length > MAX_EXTRAPOLATION_TAN * along) || !(length > 0.0) {
            return None;
        }
        unit(&(best + perpendicular * (MAX_EXTRAPOLATION_TAN / length)))
    }

    /// Evaluates the direction in which the sphere fits predict the closest support plane. Returns whether there
    /// was a useful prediction. `dir`: unit direction from the simplex to the origin.
    fn evaluate_prediction(&mut self, dir: &Vec3, gap: f64) -> Result<bool, Fault> {
        if self.set.is_full() {
            self.set.compact(self.simplex.slots());
            self.predictor.fit.restart();
        }
        let bound = self.query.upper;
        if core::mem::take(&mut self.was_prediction) {
            return Ok(false);
        }
        let corners = self.simplex.corners();
        let predicted = self.predictor.sphere(&self.set, &corners, dir, &bound);
        // It raises the lower bound, and not above the upper one.
        let is_useful =
            |value: f64| value < bound.depth - MIN_GAIN_GAPS * gap && -value < self.upper + gap;
        let Some(prediction) = predicted.filter(|p| is_useful(p.value)) else {
            return Ok(false);
        };
        let sample = self
            .query
            .evaluate_signed(&mut self.set, &prediction.dir, 0.0)?;
        self.was_prediction = true;
        self.predictor
            .judge(&prediction, sample.h, bound.depth, gap);
        Ok(true)
    }

    /// Adds the known difference farthest towards the origin if it is farther than the simplex by more than
    /// `level`, metres. Returns whether it was added; `None` if the simplex then contains the origin.
    fn add_farthest(&mut self, level: f64) -> Option<bool> {
        let w = self.set.farthest_vertex(&self.to_origin);
        if self.height(&self.to_origin, &w.w) > level * self.to_origin.norm() {
            self.add(w).then_some(true)
        } else {
            Some(false)
        }
    }

    /// Adds a point to the simplex. Returns `false` if the simplex then contains the origin.
    fn add(&mut self, w: Vertex) -> bool {
        let scale = &self.query.scale;
        let (contact_eps, size2) = (scale.contact_eps(), scale.size2());
        let Some((to_origin, distance2)) = self.simplex.add(w, contact_eps, size2) else {
            self.is_inside = true;
            return false;
        };
        (self.to_origin, self.upper) = (to_origin, larger(distance2, 0.0).sqrt());
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{EPSILON, from_real, to_real};
    use crate::test_shapes::{Random, ball, corners, difference, hull, placed};

    /// Tests boxes face to face and balls: the bounds close around the known distance, which is the distance
    /// of the points, and the search ends early for a distance larger than `max_distance`.
    #[test]
    fn bounds_meet_at_the_distance() {
        let mut r = Random::new(61);
        for round in 0..200 {
            let gap = r.within(1e-3, 2.0);
            let turn = r.rotation();
            let cube = placed(&corners(Vec3::repeat(0.5)), &turn, Vec3::zeros());
            let at = turn * Vec3::new(r.within(-0.9, 0.9), 0.0, 1.0 + gap);
            let other = placed(&corners(Vec3::repeat(0.5)), &turn, at);
            let start = r.direction();
            let find = |max_distance: f64| {
                let goal = Goal {
                    tolerance: 1e-6,
                    margin: 0.0,
                    max_distance,
                    max_samples: 60,
                };
                let mut predictor = Predictor::default();
                if round % 2 == 0 {
                    let md = difference(hull(&cube), hull(&other));
                    closest_points(
                        &mut SupportQuery::new(&md, None, 0.0),
                        &mut predictor,
                        &Direction::exact(start),
                        &goal,
                    )
                } else {
                    let up = turn * Vec3::z();
                    let md = difference(ball(up * 0.5, 0.5), ball(-up * (0.5 + gap), 0.5));
                    closest_points(
                        &mut SupportQuery::new(&md, None, 0.0),
                        &mut predictor,
                        &Direction::exact(start),
                        &goal,
                    )
                }
            };
            let found = find(f64::INFINITY).unwrap();
            assert!(found.status == Status::Converged && !found.is_inside);
            assert!((found.lower - gap).abs() <= 1e-5, "round {round}");
            assert!((found.upper - gap).abs() <= 1e-5, "round {round}");
            assert!(found.lower <= gap + 1e-6 && found.upper >= gap - 1e-6);
            let early = find(0.5 * gap).unwrap();
            assert!(early.lower > 0.5 * gap && early.lower <= gap + 1e-6);
            assert!(early.iterations <= found.iterations);
        }
    }

    /// Tests boxes on one axis, so close that the direction from an edge below the origin is off by more than the
    /// tolerance.
    #[cfg(not(feature = "single"))]
    #[test]
    fn normal_of_a_face_is_used_close_to_the_origin() {
        let mut r = Random::new(64);
        let (mut most, gap) = (0, 3e-8);
        for round in 0..200 {
            let turn = r.rotation();
            let half = Vec3::new(1.0, 1.0, 0.5);
            let cube = placed(&corners(half), &turn, Vec3::zeros());
            let other = placed(&corners(half), &turn, turn * Vec3::z() * (1.0 + gap));
            let goal = Goal {
                tolerance: 1e-9,
                margin: 0.0,
                max_distance: f64::INFINITY,
                max_samples: 60,
            };
            let md = difference(hull(&cube), hull(&other));
            let mut query = SupportQuery::new(&md, None, 0.0);
            let mut predictor = Predictor::default();
            let start = turn * Vec3::new(1.0, 1.0, 1.0).normalize();
            let found = closest_points(&mut query, &mut predictor, &Direction::exact(start), &goal)
                .unwrap();
            assert_eq!(found.status, Status::Converged, "round {round}");
            assert!(found.lower <= gap + 1e-12 && gap - found.lower <= 1e-9);
            most = most.max(found.iterations);
        }
        assert!(most <= 8, "{most} support points");
    }

    #[test]
    fn intersecting_objects_have_the_origin_inside() {
        let mut r = Random::new(62);
        for _ in 0..200 {
            let cube = corners(Vec3::repeat(0.5));
            let a = placed(&cube, &r.rotation(), Vec3::zeros());
            let b = placed(&cube, &r.rotation(), r.direction() * 0.7);
            let md = difference(hull(&a), hull(&b));
            let goal = Goal {
                tolerance: 1e-6,
                margin: 0.0,
                max_distance: f64::INFINITY,
                max_samples: 60,
            };
            let mut predictor = Predictor::default();
            let start = r.direction();
            let mut query = SupportQuery::new(&md, None, 0.0);
            let found = closest_points(&mut query, &mut predictor, &Direction::exact(start), &goal)
                .unwrap();
            assert!(found.is_inside);
            assert!(found.upper < 1e-6 && found.lower < 0.0);
        }
    }

    /// Tests two polygons as thin as rounding, almost in one plane: if the goal is reported as met, the distance
    /// of the points is within the bounds.
    #[test]
    fn touching_plates_have_points_within_the_bounds() {
        let mut r = Random::new(63);
        for round in 0..3000 {
            let turn = r.rotation();
            let thin = EPSILON * r.within(0.0, 8.0);
            let mut plate = |at: Vec3| -> Vec<Vec3> {
                let rim = (0..60).map(|i| {
                    let (y, x) = (f64::from(i) * 0.21).sin_cos();
                    turn * (at + Vec3::new(x, y, r.within(-thin, thin)))
                });
                rim.map(|p| from_real(to_real(&p))).collect()
            };
            let a = plate(Vec3::zeros());
            let b = plate(Vec3::new(0.3, 0.1, 2.0 * thin));
            let md = difference(hull(&a), hull(&b));
            let goal = Goal {
                tolerance: 0.0,
                margin: 0.0,
                max_distance: f64::INFINITY,
                max_samples: 60,
            };
            let mut query = SupportQuery::new(&md, None, 0.0);
            let (mut predictor, start) = (Predictor::default(), r.direction());
            let found = closest_points(&mut query, &mut predictor, &Direction::exact(start), &goal)
                .unwrap();
            let gap = found.upper - found.lower;
            // The weights of the corners are rounded too.
            let is_closed = gap <= 16.0 * query.scale.contact_eps();
            assert!(
                found.status != Status::Converged || found.is_inside || is_closed,
                "round {round}: {gap}"
            );
        }
    }
}
