// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Evaluates the support function of D: counts, checks, keeps sizes and the least support value.
//!
//! h(n), the support value of a unit direction n, is a sound depth: moving obj2 by h(n) n separates
//! the objects. The least one met is the upper bound of the penetration depth. A support value that is
//! no greater than the contact epsilon proves that the objects are apart, and ends a query of overlaps
//! ([`Stop::Separated`]).
//!
//! # Inconsistent support functions
//!
//! A callback that is no support function can contradict itself: its answer along n is less far along n
//! than a vertex that it returned before (cylinders that divide by the sine near their axis, hill
//! climbing that stops early). One wrong vertex taints the k differences that it is part of. There is
//! one policy. A contradiction is noticed where a plane separates, and of the final plane of a query: a
//! known difference is beyond it. From then on every direction is evaluated twice, along n and beside
//! n ([`SupportQuery::evaluate_twice`]), and the query starts again without known vertices.
//!
//! # Interior point
//!
//! The callers' centers are trusted to lie in their objects. A plane that the interior point lies
//! beyond shows that it does not: [`SupportQuery::interior`] is then `None`, and what was derived
//! from it is void. Only what is queried can show it.

use crate::math::{Vec3, from_real, larger, perpendicular, to_real};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::tolerance::Scale;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The angle beside a direction at which it is evaluated a second time, radians. Measured on ODE's
/// cylinder, whose vertices are wrong within 1e-3 of its axis.
const REQUERY_ANGLE_RAD: f64 = 0.002;

/// Why a query ends where it evaluates the support function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The objects are apart, or touch within rounding: the unit vector is a separating axis.
    Separated(Vec3),
    /// A callback returned a point that no query can work with, or there is no memory.
    Fault(Fault),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// Returns what a query found, `None` for objects that are apart.
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

/// The least support value met.
#[derive(Clone, Copy, Debug)]
pub struct UpperBound {
    /// The support value, metres: a sound depth.
    pub depth: f64,
    /// Its direction, unit.
    pub dir: Vec3,
    /// The index of its entry in the vertex set.
    pub index: usize,
}

/// The evaluation of one pair's support function.
pub struct SupportQuery<'q, A, B> {
    /// The Minkowski difference.
    pub md: &'q MinkowskiDifference<A, B>,
    /// The sizes seen.
    pub scale: Scale,
    /// The least support value met; infinite before the first.
    pub upper: UpperBound,
    /// The difference of the callers' centers, while no plane contradicts it.
    pub interior: Option<Vec3>,
    /// A callback contradicted itself, so directions are evaluated twice.
    pub is_inconsistent: bool,
}

impl<'q, A: SupportMap, B: SupportMap> SupportQuery<'q, A, B> {
    /// Begins a query that has evaluated nothing. `interior`: the difference of trusted centers.
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
                index: 0,
            },
            interior: interior.map(|point| point.v),
            is_inconsistent: false,
        }
    }

    /// Returns the number of support calls so far.
    #[inline(always)]
    pub fn support_points(&self) -> u64 {
        self.md.supports()
    }

    /// Evaluates the support point along unit `dir`, notes its sizes, and does nothing else: for queries
    /// that go on beyond a separating axis or keep points themselves.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate_point(&mut self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        let point = self.md.support(dir)?;
        self.scale.note(&point);
        Ok(point)
    }

    /// Evaluates the first direction, before there is a vertex set. Most misses end here. The caller adds
    /// the point to the set as entry 0.
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
        self.store_upper(&dir, h, 0);
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

    /// As [`SupportQuery::evaluate`], for a query that goes on beyond a separating axis: the upper bound then
    /// is below 0.
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

    /// Adds a sample to the set, and keeps its support value if it is the least.
    #[inline(always)]
    fn store_sample<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        dir: &Vec3,
        point: &SupportPoint,
        h: f64,
    ) -> SupportSample {
        let index = set.push(dir, point);
        self.store_upper(dir, h, index);
        SupportSample {
            w: point.v,
            h,
            pair: VertexSet::<N>::pair_of_entry(index),
        }
    }

    /// Keeps a support value if it is the least, and tests the interior point against its plane.
    #[inline(always)]
    fn store_upper(&mut self, dir: &Vec3, h: f64, index: usize) {
        if h < self.upper.depth {
            self.upper = UpperBound {
                depth: h,
                dir: *dir,
                index,
            };
        }
        if let Some(c) = self.interior {
            if dir.dot(&c) > h {
                self.test_interior(dir.dot(&c) - h);
            }
        }
    }

    /// Gives the interior point up if it is beyond a plane by more than rounding.
    #[cold]
    #[inline(never)]
    fn test_interior(&mut self, height: f64) {
        if height > self.scale.tie_eps() {
            self.interior = None;
        }
    }

    /// Evaluates again where `answer` separates but known vertices lie beyond it: one of them is wrong.
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
        // Of each object the answer, or a known vertex that is farther.
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

    /// Evaluates beside `dir`. Returns, of each object, the vertex of `answer`, the support point along
    /// `dir`; or the one found beside, where that is farther along `dir` or has the other beyond its plane.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[cold]
    #[inline(never)]
    fn evaluate_twice(&mut self, dir: &Vec3, answer: &SupportPoint) -> Result<SupportPoint, Fault> {
        let perturbed_dir = perturbed(dir);
        let near = self.evaluate_point(&perturbed_dir)?;
        let eps = self.scale.support_eps();
        let choose = |n: &Vec3, m: &Vec3, p: &Vec3, q: &Vec3| {
            let is_wrong = n.dot(q) > n.dot(p) + eps || m.dot(p) > m.dot(q) + eps;
            if is_wrong { *q } else { *p }
        };
        let v1 = choose(dir, &perturbed_dir, &answer.v1, &near.v1);
        let v2 = choose(&-dir, &-perturbed_dir, &answer.v2, &near.v2);
        Ok(SupportPoint { v: v1 - v2, v1, v2 })
    }

    /// Returns whether a known difference is beyond a queried plane.
    #[inline(always)]
    pub fn has_contradiction<const N: usize>(&self, set: &VertexSet<N>) -> bool {
        let tie = self.scale.tie_eps();
        (0..set.len()).any(|i| set.excess(i) > tie)
    }

    /// Starts again with every direction evaluated twice: forgets the upper bound.
    pub fn restart_inconsistent(&mut self) {
        self.is_inconsistent = true;
        self.upper.depth = f64::INFINITY;
    }
}

/// Returns the unit vector [`REQUERY_ANGLE_RAD`] beside unit `n`.
fn perturbed(n: &Vec3) -> Vec3 {
    let tilted = n + perpendicular(n) * REQUERY_ANGLE_RAD;
    tilted / tilted.norm()
}

/// Returns the direction as the callback sees it, rounded to the callers' scalar.
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
    fn samples_are_kept_with_the_least_support_value() {
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 1.5, 1.0));
        let mut query = SupportQuery::new(&md, None);
        let mut set = VertexSet::<4>::EMPTY;
        let first = query.evaluate(&mut set, &Vec3::y()).unwrap();
        assert_eq!((first.h, first.w), (2.0, set.difference(first.pair)));
        let second = query.evaluate(&mut set, &Vec3::x()).unwrap();
        assert_eq!(second.w, Vec3::x() * 0.5);
        let UpperBound { depth, dir, index } = query.upper;
        assert_eq!((depth, dir, index), (0.5, Vec3::x(), 1));
        assert_eq!(query.support_points(), 2);
    }

    #[test]
    fn a_gap_and_a_touch_are_apart() {
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

    /// A callback that returns its vertex everywhere but along x.
    #[test]
    fn a_vertex_found_beside_contradicts_a_separating_axis() {
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
    fn a_wrong_vertex_contradicts_no_axis_that_separates_twice() {
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

    /// A disc whose vertices are 5 cm too high within 1e-3 of its axis: a second evaluation takes the
    /// vertex found beside.
    #[test]
    fn a_vertex_beyond_the_plane_beside_is_replaced() {
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
    fn an_interior_point_beyond_a_plane_is_given_up() {
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
