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
//! One wrong vertex makes the k known differences that it is part of wrong. A contradiction is detected in two
//! places, when a plane separates and at the end of a query: a known difference lies beyond an evaluated support
//! plane. From then on every direction n is evaluated twice, along n and along a perturbed direction
//! ([`SupportQuery::evaluate_twice`]), and the query starts again without known vertices.
//!
//! # Interior point
//!
//! The callers' centers are trusted to lie in their objects. If their difference, the interior point, lies beyond
//! an evaluated support plane, a center is outside its object: [`SupportQuery::interior`] becomes `None`, and
//! results that are based on it are discarded. Only evaluated directions can detect this.

use crate::math::{Vec3, from_real, larger, perpendicular, to_real};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The angle between a direction and the perturbed one of its second evaluation, radians. Measured on ODE's
/// cylinder, whose points are wrong for directions within 1e-3 of its axis.
const REQUERY_ANGLE_RAD: f64 = 0.002;

/// Reason why an evaluation of the support function ends the query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The objects are separated, or in contact within rounding: the unit vector is a separating axis.
    Separated(Vec3),
    /// A callback returned an unusable point, or an allocation failed.
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

/// The least support value evaluated so far.
#[derive(Clone, Copy, Debug)]
pub struct UpperBound {
    /// The support value, metres: a sound depth.
    pub depth: f64,
    /// Its direction, unit.
    pub dir: Vec3,
    /// The support point along it. Held here, because entries of a vertex set are moved and removed.
    pub point: SupportPoint,
}

/// The state of a query: the support function of one pair and the results of its evaluations.
pub struct SupportQuery<'q, A, B> {
    /// The Minkowski difference.
    pub md: &'q MinkowskiDifference<A, B>,
    /// The sizes of the points evaluated so far.
    pub scale: Scale,
    /// The upper bound; its depth is infinite before the first evaluation.
    pub upper: UpperBound,
    /// The difference of the callers' centers, as long as no support plane excludes it from D.
    pub interior: Option<Vec3>,
    /// True if a callback has contradicted itself; directions are then evaluated twice.
    pub is_inconsistent: bool,
}

impl<'q, A: SupportMap, B: SupportMap> SupportQuery<'q, A, B> {
    /// Makes a query without evaluations. `interior`: the difference of trusted centers.
    #[inline(always)]
    pub fn new(md: &'q MinkowskiDifference<A, B>, interior: Option<&SupportPoint>) -> Self {
        let mut scale = Scale::default();
        if let Some(point) = interior {
            scale.note(point);
        }
        Self {
            md,
            scale,
            upper: UpperBound {
                depth: f64::INFINITY,
                dir: Vec3::new(1.0, 0.0, 0.0),
                point: SupportPoint::default(),
            },
            interior: interior.map(|point| point.v),
            is_inconsistent: false,
        }
    }

    /// Returns the number of support points evaluated so far.
    #[inline(always)]
    pub fn support_points(&self) -> u64 {
        self.md.supports()
    }

    /// Evaluates the support point along unit `dir` and records its sizes, nothing else: for queries that
    /// continue after a separating axis or store points themselves.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_point(&mut self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        let point = self.md.support(dir)?;
        self.scale.note(&point);
        Ok(point)
    }

    /// Evaluates the first direction, before there is a vertex set. Most queries of separated objects end here.
    /// The caller adds the point to the set as entry 0.
    ///
    /// # Errors
    /// [`Stop::Separated`], [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_first(&mut self, dir: &Vec3) -> Result<SupportPoint, Stop> {
        let dir = representable(dir);
        let point = self.evaluate_point(&dir)?;
        let h = dir.dot(&point.v);
        // Negated for NaN.
        if !self.scale.is_depth(h) {
            return Err(Stop::Separated(dir));
        }
        self.store_upper(&dir, h, &point);
        Ok(point)
    }

    /// Evaluates unit `dir` and adds the sample to the set, which must have room.
    ///
    /// # Errors
    /// [`Stop::Separated`], [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        dir: &Vec3,
    ) -> Result<SupportSample, Stop> {
        let dir = representable(dir);
        let mut point = self.evaluate_point(&dir)?;
        let mut h = dir.dot(&point.v);
        if self.is_inconsistent {
            point = self.evaluate_twice(&dir, &point)?;
            h = dir.dot(&point.v);
        }
        // Negated for NaN.
        if !self.scale.is_depth(h) {
            point = self.confirm_separation(set, &dir, &point)?;
            h = dir.dot(&point.v);
        }
        Ok(self.store_sample(set, &dir, &point, h))
    }

    /// Evaluates like [`SupportQuery::evaluate`], for a query that continues after a separating axis: the upper
    /// bound is then negative.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_signed<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        dir: &Vec3,
    ) -> Result<SupportSample, Fault> {
        let dir = representable(dir);
        let point = self.evaluate_point(&dir)?;
        let h = dir.dot(&point.v);
        Ok(self.store_sample(set, &dir, &point, h))
    }

    /// Adds a sample to the set, and stores its support value if it is the least.
    #[inline(always)]
    fn store_sample<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        dir: &Vec3,
        point: &SupportPoint,
        h: f64,
    ) -> SupportSample {
        let index = set.push(dir, point);
        self.store_upper(dir, h, point);
        SupportSample {
            w: point.v,
            h,
            pair: VertexSet::<N>::pair_of_entry(index),
        }
    }

    /// Stores a support value if it is the least, and tests the interior point against its support plane.
    #[inline(always)]
    fn store_upper(&mut self, dir: &Vec3, h: f64, point: &SupportPoint) {
        if h < self.upper.depth {
            self.upper = UpperBound {
                depth: h,
                dir: *dir,
                point: *point,
            };
        }
        if let Some(interior) = self.interior {
            if dir.dot(&interior) > h {
                self.test_interior(dir.dot(&interior) - h);
            }
        }
    }

    /// Drops the interior point if it is beyond a support plane by more than rounding, `height` in metres.
    #[cold]
    #[inline(never)]
    fn test_interior(&mut self, height: f64) {
        if height > self.scale.tie_eps() {
            self.interior = None;
        }
    }

    /// Evaluates `dir` again if its point, `answer`, separates although known vertices lie beyond its support plane:
    /// the point or one of the vertices is wrong.
    ///
    /// # Errors
    /// [`Stop::Separated`]: the axis separates. [`Fault::NonFinite`].
    #[cold]
    #[inline(never)]
    fn confirm_separation<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        dir: &Vec3,
        answer: &SupportPoint,
    ) -> Result<SupportPoint, Stop> {
        let h = dir.dot(&answer.v);
        let least = larger(h + self.scale.support_eps(), self.scale.contact_eps());
        // For each object the farther one of the answer and the known vertices.
        let VertexPair { a, b } = set.farthest(dir);
        let known = larger(dir.dot(&set.vertex1(a.into())), dir.dot(&answer.v1))
            + larger(-dir.dot(&set.vertex2(b.into())), -dir.dot(&answer.v2));
        if self.is_inconsistent || set.len() == 0 || !(known > least) {
            return Err(Stop::Separated(*dir));
        }
        self.is_inconsistent = true;
        let point = self.evaluate_twice(dir, answer)?;
        if dir.dot(&point.v) > least {
            Ok(point)
        } else {
            Err(Stop::Separated(*dir))
        }
    }

    /// Evaluates a perturbed direction too. Returns, for each object, the vertex found along it if that contradicts the
    /// vertex of `answer`, the support point along `dir`: if it is farther along `dir`, or if the vertex of `answer`
    /// is beyond its support plane. Otherwise returns the vertex of `answer`.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[cold]
    #[inline(never)]
    fn evaluate_twice(&mut self, dir: &Vec3, answer: &SupportPoint) -> Result<SupportPoint, Fault> {
        let perturbed_dir = perturbed(dir);
        let other = self.evaluate_point(&perturbed_dir)?;
        let eps = self.scale.support_eps();
        // n and p: `dir` and its vertex; m and q: the perturbed direction and its vertex.
        let choose = |n: &Vec3, m: &Vec3, p: &Vec3, q: &Vec3| {
            let is_wrong = n.dot(q) > n.dot(p) + eps || m.dot(p) > m.dot(q) + eps;
            if is_wrong { *q } else { *p }
        };
        let v1 = choose(dir, &perturbed_dir, &answer.v1, &other.v1);
        let v2 = choose(&-dir, &-perturbed_dir, &answer.v2, &other.v2);
        Ok(SupportPoint { v: v1 - v2, v1, v2 })
    }

    /// Returns whether a known difference is beyond the support plane of an entry by more than rounding.
    #[inline(always)]
    pub fn has_contradiction<const N: usize>(&self, set: &VertexSet<N>) -> bool {
        let tie = self.scale.tie_eps();
        (0..set.len()).any(|i| set.excess(i) > tie)
    }

    /// Resets the upper bound, and from now on evaluates every direction twice.
    pub fn restart_inconsistent(&mut self) {
        self.is_inconsistent = true;
        self.upper.depth = f64::INFINITY;
    }
}

/// Returns unit `n` tilted by [`REQUERY_ANGLE_RAD`], unit.
fn perturbed(n: &Vec3) -> Vec3 {
    let tilted = n + perpendicular(n) * REQUERY_ANGLE_RAD;
    tilted / tilted.norm()
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
    use crate::shapes::{ball, difference};
    use core::cell::Cell;

    #[test]
    fn samples_are_stored_with_the_upper_bound() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 1.5, 1.0));
        let mut query = SupportQuery::new(&md, None);
        let mut set = VertexSet::<4>::EMPTY;
        let first = query.evaluate(&mut set, &Vec3::y()).unwrap();
        assert_eq!((first.h, first.w), (2.0, set.difference(first.pair)));
        let second = query.evaluate(&mut set, &Vec3::x()).unwrap();
        assert_eq!(second.w, Vec3::x() * 0.5);
        let UpperBound { depth, dir, point } = query.upper;
        assert_eq!((depth, dir, point.v), (0.5, Vec3::x(), second.w));
        assert_eq!(query.support_points(), 2);
        // The upper bound does not depend on the set.
        set.truncate(1);
        query.evaluate(&mut set, &Vec3::y()).unwrap();
        let UpperBound { depth, dir, point } = query.upper;
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
            let mut query = SupportQuery::new(&md, None);
            let stop = query.evaluate(&mut set, &Vec3::x()).unwrap_err();
            assert_eq!(stop, Stop::Separated(Vec3::x()));
            let stop = query.evaluate_first(&Vec3::x()).unwrap_err();
            assert_eq!(stop, Stop::Separated(Vec3::x()));
        }
    }

    /// A callback that returns a wrong vertex only along x.
    #[test]
    fn a_vertex_of_the_perturbed_direction_contradicts_a_separating_axis() {
        let short = |n: &Vec3| Vec3::x() * if *n == Vec3::x() { -1.0 } else { 1.0 };
        let md = difference(short, |_: &Vec3| Vec3::zeros());
        let mut query = SupportQuery::new(&md, None);
        let mut set = VertexSet::<4>::EMPTY;
        query.evaluate(&mut set, &Vec3::new(0.8, 0.6, 0.0)).unwrap();
        let again = query.evaluate(&mut set, &Vec3::x()).unwrap();
        assert_eq!((again.h, again.w), (1.0, Vec3::x()));
        assert!(query.is_inconsistent);
    }

    /// A callback that returned a wrong vertex once.
    #[test]
    fn an_axis_that_separates_twice_overrules_a_wrong_vertex() {
        let calls = Cell::new(0);
        let wrong = |_: &Vec3| {
            calls.set(calls.get() + 1);
            Vec3::x() * if calls.get() == 1 { 1.0 } else { -1.0 }
        };
        let md = difference(wrong, |_: &Vec3| Vec3::zeros());
        let mut query = SupportQuery::new(&md, None);
        let mut set = VertexSet::<4>::EMPTY;
        query.evaluate(&mut set, &Vec3::new(0.8, 0.6, 0.0)).unwrap();
        let stop = query.evaluate(&mut set, &Vec3::x()).unwrap_err();
        assert_eq!(stop, Stop::Separated(Vec3::x()));
    }

    /// A disc whose vertices are 5 cm too high within 1e-3 of its axis: the second evaluation replaces them by the
    /// vertex of the perturbed direction.
    #[test]
    fn a_vertex_beyond_the_perturbed_plane_is_replaced() {
        let disc = |n: &Vec3| {
            let r = n.x.hypot(n.y);
            let height = if r < 1e-3 { 0.05 } else { 0.0 };
            Vec3::new(n.x / r.max(1e-300), n.y / r.max(1e-300), height)
        };
        let md = difference(disc, |_: &Vec3| -Vec3::z());
        let mut query = SupportQuery::new(&md, None);
        let mut set = VertexSet::<4>::EMPTY;
        assert_eq!(query.evaluate(&mut set, &Vec3::z()).unwrap().h, 1.05);
        query.restart_inconsistent();
        assert_eq!(query.evaluate(&mut set, &Vec3::z()).unwrap().h, 1.0);
    }

    #[test]
    fn an_interior_point_beyond_a_plane_is_dropped() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 1.0));
        for (x, is_inside) in [(1.9, true), (2.0, true), (2.0 + 1e3 * EPSILON, false)] {
            let v1 = Vec3::x() * x;
            let point = SupportPoint {
                v: v1,
                v1,
                v2: Vec3::zeros(),
            };
            let mut query = SupportQuery::new(&md, Some(&point));
            let mut set = VertexSet::<4>::EMPTY;
            query.evaluate(&mut set, &Vec3::y()).unwrap();
            query.evaluate(&mut set, &Vec3::x()).unwrap();
            assert_eq!(query.interior.is_some(), is_inside, "{x}");
        }
    }

    #[test]
    fn a_point_that_is_not_finite_is_a_fault() {
        let md = difference(|_: &Vec3| Vec3::x() * f64::NAN, |_: &Vec3| Vec3::zeros());
        let mut set = VertexSet::<4>::EMPTY;
        let stop = SupportQuery::new(&md, None)
            .evaluate(&mut set, &Vec3::x())
            .unwrap_err();
        assert_eq!(stop, Stop::Fault(Fault::NonFinite));
    }
}
