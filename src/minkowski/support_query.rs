// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Evaluates the support function of D: counts and checks the calls, and keeps the sizes and the upper bound.
//!
//! h(n), the support value of a unit direction n, is a sound depth: moving obj2 by h(n) n separates
//! the objects. The least support value evaluated is the *upper bound* of the penetration depth. A support value of
//! at most the contact epsilon proves that the objects are separated, and ends a query for overlaps
//! ([`Stop::Separated`]).
//!
//! # Inconsistent support functions
//!
//! A faulty callback can contradict itself: the point that it returns for n is less far along n than a vertex
//! that it returned before (cylinders that divide by the sine near their axis, hill climbing that stops early).
//! Directions in general position ([`general_position`](crate::minkowski::general_position)) avoid the most frequent
//! cause. The end of a query tests the plane of its result ([`SupportQuery::is_inconsistent`]).
//!
//! # Interior point
//!
//! The callers' centers are trusted to lie in their objects. If their difference lies beyond
//! an evaluated support plane, a center is outside its object: [`SupportQuery::center`] becomes `None`, and
//! results that are based on it are discarded. Only evaluated directions can detect this.

use crate::math::{Vec3, from_real, larger, lesser, to_real};
use crate::minkowski::general_position::{HAS_TILT, MAX_TILT_RAD, MIN_TILT_RAD, TiltRule};
use crate::minkowski::support::{Difference, Fault, SupportPoint};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::tuning::NEGLIGIBLE_GAPS;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::trace;
use crate::types::Direction;

/// Reason why an evaluation of the support function ends the query.
#[derive(Clone, Copy, Debug, PartialEq)]

pub enum Stop {
    /// The objects are separated, or in contact within rounding: the direction is a separating axis.
    Separated(Direction),
    /// An argument or a callback's point is invalid, or an allocation failed.
    Fault(Fault),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// Returns the result of a query; `None` if the objects are separated.
#[inline(always)]
pub fn if_overlapping<T>(found: Result<T, Stop>) -> Result<Option<T>, Fault> {
    match found {
        Ok(found) => Ok(Some(found)),
        Err(Stop::Separated(_)) => Ok(None),
        Err(Stop::Fault(fault)) => Err(fault),
    }
}

/// One evaluated direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportSample {
    /// The support point of D.
    pub w: Vec3,
    /// The support value, metres.
    pub h: f64,
    /// The vertices of `w` in the vertex set.
    pub pair: VertexPair,
}

impl SupportSample {
    /// Returns the sample as a corner.
    #[inline(always)]
    pub fn vertex(&self) -> Vertex {
        Vertex {
            w: self.w,
            pair: self.pair,
        }
    }
}

/// A support plane of D: an evaluated direction with its support point.
#[derive(Clone, Copy, Debug)]
pub struct SupportPlane {
    /// The direction as the callbacks received it, unit.
    pub dir: Vec3,
    /// The support value, metres: a sound depth, unless negative.
    pub depth: f64,
    /// The support point along the direction.
    pub point: SupportPoint,
    /// The tilt of the direction: [`Direction::tilt`].
    pub tilt: f64,
}

impl SupportPlane {
    /// Returns the direction with its tilt.
    #[inline(always)]
    pub fn direction(&self) -> Direction {
        Direction {
            n: self.dir,
            tilt: self.tilt,
        }
    }

    /// Returns whether neither plane's point is beyond the other plane by more than rounding, `tie_eps` in metres.
    pub fn is_consistent(&self, other: &Self, tie_eps: f64) -> bool {
        let has_farthest =
            |plane: &Self, other: &Self| plane.dir.dot(&other.point.v) <= plane.depth + tie_eps;
        has_farthest(self, other) && has_farthest(other, self)
    }
}

/// The state of a query: the support function of one pair and the results of its evaluations.
pub struct SupportQuery<'q, D> {
    /// The Minkowski difference.
    pub md: &'q D,
    /// How directions are tilted.
    pub tilt_rule: TiltRule,
    /// The sizes of the points evaluated so far.
    pub scale: Scale,
    /// The upper bound: the plane of the least support value so far, infinite before the first evaluation. Holds its
    /// point, because entries of a vertex set are moved and removed.
    pub upper: SupportPlane,
    /// The difference of the callers' centers, as long as no support plane excludes it from D.
    pub center: Option<&'q SupportPoint>,
}

impl<'q, D: Difference> SupportQuery<'q, D> {
    /// Makes a query without evaluations. `center`: the difference of trusted centers. `tolerance`: the one that the caller
    /// requested, metres.
    #[inline(always)]
    pub fn new(md: &'q D, center: Option<&'q SupportPoint>, tolerance: f64) -> Self {
        let mut scale = Scale::default();
        if let Some(point) = center {
            scale.note(point);
        }
        Self {
            md,
            tilt_rule: TiltRule {
                tolerance,
                least: match md.is_contradicted() {
                    true => MIN_TILT_RAD,
                    false => 0.0,
                },
            },
            scale,
            upper: SupportPlane {
                depth: f64::INFINITY,
                dir: Vec3::new(1.0, 0.0, 0.0),
                point: SupportPoint::default(),
                tilt: 0.0,
            },
            center,
        }
    }

    /// Returns the number of support points evaluated so far.
    #[inline(always)]
    pub fn support_points(&self) -> u64 {
        self.md.supports()
    }

    /// Evaluates the support point along unit `dir` and records its sizes, nothing else: for queries that store points
    /// themselves.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_point(&mut self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        let point = self.md.support(dir)?;
        self.scale.note(&point);
        Ok(point)
    }

    /// Evaluates unit `n` by the tilt rule and returns what `then` makes of the plane. `tilt`: not 0 for the direction of a state,
    /// which is evaluated as it is, so that a pair at rest does not turn. `confirms`: true to confirm a separating plane.
    /// The path that most tolerances take is inlined and ends in a `then` of its own: a plane that a function may have
    /// returned, and a [`Direction`], would be stored for the other paths. For the same reason their results are copied.
    /// Codegen, see README.
    #[inline(always)]
    fn evaluate_plane<T, E: From<Fault>>(
        &mut self,
        n: &Vec3,
        tilt: f64,
        confirms: bool,
        then: impl FnOnce(&mut Self, &SupportPlane) -> Result<T, E>,
    ) -> Result<T, E> {
        if tilt > 0.0 || !self.tilt_rule.allows_largest(&self.scale) {
            let rare = self.continue_with_tilt(*n, tilt, confirms, then)?;
            return Ok(rare);
        }
        let plane = self.evaluate_tilted(n, MAX_TILT_RAD)?;
        if self.may_separate(n, &plane) {
            let rare = self.continue_untilted(*n, then)?;
            return Ok(rare);
        }
        then(self, &plane)
    }

    /// Continues [`SupportQuery::evaluate_plane`] with any other tilt than the largest.
    #[inline(never)]
    fn continue_with_tilt<T, E: From<Fault>>(
        &mut self,
        n: Vec3,
        tilt: f64,
        confirms: bool,
        then: impl FnOnce(&mut Self, &SupportPlane) -> Result<T, E>,
    ) -> Result<T, E> {
        let plane = self.evaluate_with_tilt(&n, tilt, confirms)?;
        then(self, &plane)
    }

    /// Continues [`SupportQuery::evaluate_plane`] if unit `n` may separate where the tilted direction does not. Evaluates the
    /// tilted direction again: a plane that is passed would be stored before each such test. Measured: misses take 3 % more time.
    #[cold]
    #[inline(never)]
    fn continue_untilted<T, E: From<Fault>>(
        &mut self,
        n: Vec3,
        then: impl FnOnce(&mut Self, &SupportPlane) -> Result<T, E>,
    ) -> Result<T, E> {
        let tilted = self.evaluate_tilted(&n, MAX_TILT_RAD)?;
        let plane = self.evaluate_untilted(&n, tilted)?;
        then(self, &plane)
    }

    /// Continues [`SupportQuery::evaluate_plane`] with any other tilt than the largest. With none, because the tolerance
    /// allows none, the plane is compared with the upper bound.
    #[inline(never)]
    fn evaluate_with_tilt(
        &mut self,
        n: &Vec3,
        tilt: f64,
        confirms: bool,
    ) -> Result<SupportPlane, Fault> {
        if tilt > 0.0 {
            let plane = self.evaluate_tilted(n, 0.0)?;
            return Ok(SupportPlane { tilt, ..plane });
        }
        let plane = self.evaluate_tilted(n, self.tilt_rule.tilt(&self.scale))?;
        if self.may_separate(n, &plane) {
            return self.evaluate_untilted(n, plane);
        }
        if !(plane.tilt > 0.0) {
            if self.upper.depth < f64::INFINITY {
                self.compare(&plane, &{ self.upper });
            }
            if confirms && !self.scale.is_depth(plane.depth) {
                self.confirm(&plane)?;
            }
        }
        Ok(plane)
    }

    /// Returns whether a tilted direction does not separate, but its point does not prove that unit `n` does not either.
    #[inline(always)]
    fn may_separate(&self, n: &Vec3, tilted: &SupportPlane) -> bool {
        tilted.tilt > 0.0
            && self.scale.is_depth(tilted.depth)
            && !self.scale.is_depth(n.dot(&tilted.point.v))
    }

    /// Evaluates unit `n` tilted by `tilt`, radians; 0 to evaluate it as it is.
    #[inline(always)]
    fn evaluate_tilted(&mut self, n: &Vec3, tilt: f64) -> Result<SupportPlane, Fault> {
        let dir = representable(&Direction::tilted(n, tilt).n);
        let point = self.evaluate_point(&dir)?;
        let depth = dir.dot(&point.v);
        trace::direction(&dir, depth, lesser(depth, self.upper.depth));
        Ok(SupportPlane {
            dir,
            depth,
            point,
            tilt,
        })
    }

    /// Evaluates unit `n` as it is after `tilted`. Returns `tilted` if the two points contradict each other.
    #[cold]
    #[inline(never)]
    fn evaluate_untilted(&mut self, n: &Vec3, tilted: SupportPlane) -> Result<SupportPlane, Fault> {
        let exact = self.evaluate_tilted(n, 0.0)?;
        let is_consistent = exact.is_consistent(&tilted, self.scale.tie_eps());
        Ok(if is_consistent { exact } else { tilted })
    }

    /// Confirms the plane of the upper bound, the result of a query.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn confirm_upper(&mut self) -> Result<(), Fault> {
        if HAS_TILT && !self.upper.direction().is_general() {
            let upper = self.upper;
            return self.confirm(&upper);
        }
        Ok(())
    }

    /// Confirms a plane whose direction is not tilted: evaluates the tilted direction, unless the tolerance allows a tilt,
    /// because the plane was then chosen beside a tilted one.
    #[cold]
    #[inline(never)]
    fn confirm(&mut self, exact: &SupportPlane) -> Result<(), Fault> {
        if self.tilt_rule.tilt(&self.scale) == 0.0 {
            let tilted = self.evaluate_tilted(&exact.dir, MIN_TILT_RAD)?;
            self.compare(exact, &tilted);
        }
        Ok(())
    }

    /// Compares two planes. If their points contradict each other, all directions are tilted from here on, and the query
    /// runs again ([`Pair::run`](crate::query::Pair::run)).
    fn compare(&mut self, one: &SupportPlane, other: &SupportPlane) {
        if !one.is_consistent(other, self.scale.tie_eps()) {
            self.md.note_contradiction();
            self.tilt_rule.least = MIN_TILT_RAD;
        }
    }

    /// Evaluates the first direction, before there is a vertex set. Most queries of separated objects end here.
    /// The caller adds the point to the set as entry 0, with the direction of the upper bound.
    ///
    /// # Errors
    /// [`Stop::Separated`], [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_first(&mut self, dir: &Direction) -> Result<SupportPoint, Stop> {
        self.evaluate_plane(&dir.n, dir.tilt, true, |query, plane| {
            // Negated for NaN.
            if !query.scale.is_depth(plane.depth) {
                return Err(Stop::Separated(plane.direction()));
            }
            query.store_upper(plane);
            Ok(plane.point)
        })
    }

    /// Evaluates unit `n` and adds the sample to the set, which must have room.
    ///
    /// # Errors
    /// [`Stop::Separated`], [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        n: &Vec3,
    ) -> Result<SupportSample, Stop> {
        self.evaluate_plane(n, 0.0, true, |query, plane| {
            // Negated for NaN.
            if !query.scale.is_depth(plane.depth) {
                return Err(Stop::Separated(plane.direction()));
            }
            Ok(query.store_sample(set, plane))
        })
    }

    /// Evaluates like [`SupportQuery::evaluate`], for a query that continues after a separating axis: the upper
    /// bound is then negative. `tilt`: that of unit `n`, radians.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_signed<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        n: &Vec3,
        tilt: f64,
    ) -> Result<SupportSample, Fault> {
        self.evaluate_plane(n, tilt, false, |query, plane| {
            Ok(query.store_sample(set, plane))
        })
    }

    /// Adds a sample to the set, and stores its support value if it is the least.
    #[inline(always)]
    fn store_sample<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        plane: &SupportPlane,
    ) -> SupportSample {
        let index = set.push(&plane.dir, &plane.point);
        self.store_upper(plane);
        SupportSample {
            w: plane.point.v,
            h: plane.depth,
            pair: VertexSet::<N>::pair_of_entry(index),
        }
    }

    /// Stores a plane if its support value is the least, and tests the center against it.
    #[inline(always)]
    fn store_upper(&mut self, plane: &SupportPlane) {
        if plane.depth < self.upper.depth {
            self.upper = *plane;
        }
        if let Some(center) = self.center {
            let height = plane.dir.dot(&center.v) - plane.depth;
            if height > 0.0 {
                self.test_center(height);
            }
        }
    }

    /// Drops the center if it is beyond a support plane by more than rounding, `height` in metres.
    #[cold]
    #[inline(never)]
    fn test_center(&mut self, height: f64) {
        if height > self.scale.tie_eps() {
            self.center = None;
        }
    }

    /// Returns the support plane of the set's entry `k`.
    #[inline(always)]
    pub fn plane<const N: usize>(&self, set: &VertexSet<N>, k: usize) -> SupportPlane {
        let (dir, point) = (set.dir(k), set.point(VertexSet::<N>::pair_of_entry(k)));
        SupportPlane {
            dir,
            depth: dir.dot(&point.v),
            point,
            tilt: self.tilt_rule.tilt(&self.scale),
        }
    }

    /// Returns whether a support function contradicts itself at the upper bound: a known difference is beyond the
    /// support plane by more than rounding and [`NEGLIGIBLE_GAPS`]: a lower one leaves the depth right. Answers are
    /// insensitive: 0 to 4.
    #[inline(always)]
    pub fn is_inconsistent<const N: usize>(&self, set: &VertexSet<N>) -> bool {
        let SupportPlane { dir, depth, .. } = self.upper;
        let height = dir.dot(&set.farthest_vertex(&dir).w) - depth;
        let tolerance = self.scale.tolerance(self.tilt_rule.tolerance);
        height > larger(self.scale.tie_eps(), NEGLIGIBLE_GAPS * tolerance)
    }
}

/// Returns the direction rounded to the callers' scalar, as the callback receives it.
#[inline(always)]
fn representable(dir: &Vec3) -> Vec3 {
    from_real(to_real(dir))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::test_shapes::{ball, difference};
    #[cfg(not(feature = "single"))]
    use crate::test_shapes::{corners, hull};

    #[test]
    fn samples_are_stored_with_the_upper_bound() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 1.5, 1.0));
        let mut query = SupportQuery::new(&md, None, 0.0);
        let mut set = VertexSet::<4>::EMPTY;
        let first = query.evaluate(&mut set, &Vec3::y()).unwrap();
        assert_eq!((first.h, first.w), (2.0, set.difference(first.pair)));
        let second = query.evaluate(&mut set, &Vec3::x()).unwrap();
        assert_eq!(second.w, Vec3::x() * 0.5);
        let SupportPlane {
            depth, dir, point, ..
        } = query.upper;
        assert_eq!((depth, dir, point.v), (0.5, Vec3::x(), second.w));
        assert_eq!(query.support_points(), 2);
        // The upper bound does not depend on the set.
        set.truncate(1);
        query.evaluate(&mut set, &Vec3::y()).unwrap();
        let SupportPlane {
            depth, dir, point, ..
        } = query.upper;
        assert_eq!(
            (depth, dir, point.v1 - point.v2),
            (0.5, Vec3::x(), second.w)
        );
    }

    #[test]
    fn a_gap_and_a_contact_are_separated() {
        for gap in [1.0, 0.0] {
            let other = ball(Vec3::x() * (2.0 + gap), 1.0);
            let md = difference(ball(Vec3::zeros(), 1.0), other);
            let mut set = VertexSet::<4>::EMPTY;
            let mut query = SupportQuery::new(&md, None, 0.0);
            let dir = Direction::exact(Vec3::x());
            let stop = query.evaluate(&mut set, &dir.n).unwrap_err();
            assert_eq!(stop, Stop::Separated(dir));
            let stop = query.evaluate_first(&dir).unwrap_err();
            assert_eq!(stop, Stop::Separated(dir));
            // The direction of a state is known to be in general position.
            let general = Direction::remembered(dir.n, true);
            let stop = query.evaluate_first(&general).unwrap_err();
            assert_eq!(stop, Stop::Separated(general));
            assert_eq!(general.is_general(), HAS_TILT);
        }
    }

    /// A plate on a plate, closer than the tilt can decide: n itself is evaluated, and separates.
    #[test]
    #[cfg(not(feature = "single"))]
    fn a_direction_whose_tilt_does_not_separate_is_evaluated_as_it_is() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.1));
        for (gap, is_separated) in [(1e-10, true), (0.0, true), (-1e-10, false)] {
            let other: Vec<Vec3> = plate.iter().map(|p| p + Vec3::z() * (0.2 + gap)).collect();
            let md = difference(hull(&plate), hull(&other));
            let mut query = SupportQuery::new(&md, None, 1e-6);
            let mut set = VertexSet::<4>::EMPTY;
            let found = query.evaluate(&mut set, &Vec3::z());
            let expected = Err(Stop::Separated(Direction::exact(Vec3::z())));
            assert!(if is_separated {
                found == expected
            } else {
                found.unwrap().h > 0.0
            });
            // The tilted direction's point proves that n does not separate either; else both are evaluated once more.
            assert_eq!(query.support_points(), if is_separated { 3 } else { 1 });
        }
    }

    /// A disc whose points along its exact axis are 5 cm too low: the tilted direction overrules them.
    #[test]
    #[cfg(not(feature = "single"))]
    fn a_point_that_contradicts_that_of_the_tilted_direction_is_not_used() {
        let disc = |n: &Vec3| {
            let r = n.x.hypot(n.y);
            if r < 1e-12 {
                Vec3::z() * -0.05
            } else {
                Vec3::new(n.x / r, n.y / r, 0.0)
            }
        };
        let md = difference(disc, |_: &Vec3| Vec3::z() * -1e-10);
        let mut query = SupportQuery::new(&md, None, 1e-6);
        let mut set = VertexSet::<4>::EMPTY;
        let found = query.evaluate(&mut set, &Vec3::z()).unwrap();
        assert!(found.h > 0.0 && found.h < 2e-8, "{}", found.h);
        assert!(!query.is_inconsistent(&set));
        // A vertex that was too high.
        let wrong = SupportPoint {
            v: Vec3::z() * 1e-3,
            v1: Vec3::z() * 1e-3,
            v2: Vec3::zeros(),
        };
        set.push(&Vec3::x(), &wrong);
        assert!(query.is_inconsistent(&set));
    }

    /// The same disc, and a tolerance that allows no tilt: the separation and the upper bound are not confirmed.
    #[test]
    #[cfg(not(feature = "single"))]
    fn a_point_that_is_not_confirmed_makes_the_query_run_again() {
        for wrong in [-0.05, 0.05, 0.0] {
            let disc = move |n: &Vec3| {
                let r = n.x.hypot(n.y);
                if r < 1e-12 {
                    Vec3::z() * wrong
                } else {
                    Vec3::new(n.x / r, n.y / r, 0.0)
                }
            };
            let md = difference(disc, |_: &Vec3| Vec3::z() * -0.01);
            let mut query = SupportQuery::new(&md, None, 0.0);
            let mut set = VertexSet::<4>::EMPTY;
            if query.evaluate(&mut set, &Vec3::z()).is_ok() {
                query.confirm_upper().unwrap();
            }
            assert_eq!(md.is_contradicted(), wrong != 0.0);
            assert_eq!(query.support_points(), 2);
            // Tilted from here on: the disc is as high as it is.
            if wrong != 0.0 {
                let h = query.evaluate(&mut set, &Vec3::z()).unwrap().h;
                assert!((h - 0.01).abs() < 1e-9, "{h}");
            }
        }
    }

    #[test]
    fn a_center_beyond_a_plane_is_dropped() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 1.0));
        for (x, is_inside) in [(1.9, true), (2.0, true), (2.0 + 1e3 * EPSILON, false)] {
            let v1 = Vec3::x() * x;
            let point = SupportPoint {
                v: v1,
                v1,
                v2: Vec3::zeros(),
            };
            let mut query = SupportQuery::new(&md, Some(&point), 0.0);
            let mut set = VertexSet::<4>::EMPTY;
            query.evaluate(&mut set, &Vec3::y()).unwrap();
            query.evaluate(&mut set, &Vec3::x()).unwrap();
            assert_eq!(query.center.is_some(), is_inside, "{x}");
        }
    }

    #[test]
    fn a_point_that_is_not_finite_is_a_fault() {
        let md = difference(|_: &Vec3| Vec3::x() * f64::NAN, |_: &Vec3| Vec3::zeros());
        let mut set = VertexSet::<4>::EMPTY;
        let stop = SupportQuery::new(&md, None, 0.0)
            .evaluate(&mut set, &Vec3::x())
            .unwrap_err();
        assert_eq!(stop, Stop::Fault(Fault::NonFinite));
    }
}
