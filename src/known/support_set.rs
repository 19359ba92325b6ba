// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The support points of a query, each kept once and named by its index, and where a
//! solver that needs no more than h(n) > 0 asks for them.
//!
//! [`Inquiry::ask`] notes the sizes, keeps the lowest support plane, and ends the query
//! where the objects are apart. (What goes on after a direction separates, as the distance
//! does, asks by [`Inquiry::point`].) The points live in a
//! [`SupportSet`], whose room is the solver's to choose: an inquiry goes on when its points
//! move to a larger one.
//!
//! A callback that is no support function can contradict itself: what it answers along n
//! is less far along n than a point it gave before. D reaches as far as all its known
//! points, and as those that points of the two objects make, where these are found again from
//! [`beside`]. So where an answer would separate, the farther point stands in; and whoever
//! gives the lowest plane for an answer looks through the points first.

use crate::known::precision::Precision;
use crate::math::{Vec3, larger, perpendicular};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// What is known of each object: room for `N` points of it with the directions they were asked
/// along.
///
/// Index i names obj1's point and obj2's that one direction found (asked along, and against it).
/// Their difference is a support point of D; it is not stored, being that difference to the bit,
/// and rooms are small. But D holds the difference of *any* point of obj1 and any of obj2, so k
/// support points are worth k² points of D. The farthest of these costs no callback:
/// [`SupportSet::extreme`].
pub struct SupportSet<const N: usize> {
    /// obj1's points, and obj2's.
    points: [[Vec3; N]; 2],
    directions: [Vec3; N],
    len: usize,
}

/// The farthest point of D along a direction, of all that known points of the objects make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The places of obj1's and of obj2's point.
    pub names: [usize; 2],
    /// How far it is, metres, times the length of the direction.
    pub reach: f64,
}

impl Extreme {
    /// Along `n`, of these points of obj1 and of obj2, the first of equal ones. It reaches -∞ where
    /// there is none.
    #[inline(always)]
    pub fn of<'a>(n: &Vec3, points: impl Iterator<Item = (&'a Vec3, &'a Vec3)>) -> Self {
        let (mut top, mut low) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut names = [0; 2];
        for (i, (v1, v2)) in points.enumerate() {
            let (a, b) = (n.dot(v1), n.dot(v2));
            if a > top {
                (top, names[0]) = (a, i);
            }
            if b < low {
                (low, names[1]) = (b, i);
            }
        }
        let reach = top - low;
        Self { names, reach }
    }
}

impl<const N: usize> SupportSet<N> {
    /// No point.
    pub const EMPTY: Self = Self {
        points: [[Vec3::new(0.0, 0.0, 0.0); N]; 2],
        directions: [Vec3::new(0.0, 0.0, 0.0); N],
        len: 0,
    };

    /// A place that is in range whatever `i` is: the compiler sees it, and checks nothing.
    #[inline(always)]
    fn at(i: usize) -> usize {
        if N.is_power_of_two() {
            i & (N - 1)
        } else {
            i.min(N - 1)
        }
    }

    /// How many points there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Is there no room for another point?
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.len >= N
    }

    /// The point of D with this index.
    #[inline(always)]
    pub fn v(&self, i: usize) -> Vec3 {
        self.made([i; 2])
    }

    /// The point of D that obj1's point and obj2's with these indices make.
    #[inline(always)]
    pub fn made(&self, [i, j]: [usize; 2]) -> Vec3 {
        self.points[0][Self::at(i)] - self.points[1][Self::at(j)]
    }

    /// The farthest point along `n`, which need not be unit, that the points of obj1 and of obj2
    /// make from index `first` on.
    #[inline(always)]
    pub fn extreme(&self, n: &Vec3, first: usize) -> Extreme {
        let [one, two] = self
            .points
            .each_ref()
            .map(|points| points.get(first..self.len).unwrap_or(&[]));
        let Extreme { names, reach } = Extreme::of(n, one.iter().zip(two));
        Extreme {
            names: names.map(|i| first + i),
            reach,
        }
    }

    /// The point with its witnesses.
    #[inline(always)]
    pub fn point(&self, i: usize) -> SupportPoint {
        let [v1, v2] = self.witnesses(i);
        SupportPoint { v: v1 - v2, v1, v2 }
    }

    /// The points of obj1 and obj2 that the point with this index is the difference of.
    #[inline(always)]
    pub fn witnesses(&self, i: usize) -> [Vec3; 2] {
        // Spelt out: in a map that is not inlined the bounds are checked.
        let i = Self::at(i);
        [self.points[0][i], self.points[1][i]]
    }

    /// The unit direction that the point was asked along; zero for one that was not.
    #[inline(always)]
    pub fn direction(&self, i: usize) -> Vec3 {
        self.directions[Self::at(i)]
    }

    /// Adds a point and returns its index; where there is no room it takes the place of
    /// the last.
    #[inline(always)]
    pub fn push(&mut self, direction: &Vec3, point: &SupportPoint) -> usize {
        let i = self.len.min(N - 1);
        self.place(i, direction, point);
        i
    }

    /// Puts a point in the place of another, or behind the last.
    #[inline(always)]
    pub fn place(&mut self, i: usize, direction: &Vec3, point: &SupportPoint) {
        let at = Self::at(i);
        self.points[0][at] = point.v1;
        self.points[1][at] = point.v2;
        self.directions[at] = *direction;
        self.len = self.len.max(at + 1);
    }

    /// Forgets all points from this index on.
    #[inline(always)]
    pub fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// Takes the points of a smaller set, with their indices.
    pub fn take<const M: usize>(&mut self, other: &SupportSet<M>) {
        let len = other.len.min(M).min(N);
        for (points, others) in self.points.iter_mut().zip(&other.points) {
            points[..len].copy_from_slice(&others[..len]);
        }
        self.directions[..len].copy_from_slice(&other.directions[..len]);
        self.len = len;
    }

    /// The point with the least support value in the direction it was asked along, if there
    /// is one.
    pub fn lowest(&self) -> Option<usize> {
        let reach = |i: usize| self.directions[i].dot(&self.v(i));
        let mut best = (None, f64::INFINITY);
        for i in 0..self.len.min(N) {
            if reach(i) < best.1 {
                best = (Some(i), reach(i));
            }
        }
        best.0
    }

    /// The point farthest along `n` of those that were asked for, if it reaches beyond
    /// `reach`.
    #[inline(always)]
    pub fn farther(&self, n: &Vec3, mut reach: f64) -> Option<usize> {
        let mut best = None;
        for i in 0..self.len.min(N) {
            let d = n.dot(&self.v(i));
            if d > reach && self.directions[i] != Vec3::zeros() {
                reach = d;
                best = Some(i);
            }
        }
        best
    }
}

/// A support plane of D: h(dir) = dir · s(dir).
#[derive(Clone, Copy, Debug)]
pub struct Lowest {
    /// The support value, metres: moving obj2 by depth · dir separates the objects.
    pub depth: f64,
    /// Unit.
    pub dir: Vec3,
}

/// A support point that was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Its index in the set.
    pub i: usize,
    /// Its support value, metres.
    pub h: f64,
    /// The point of D.
    pub v: Vec3,
}

pub use crate::minkowski::query::{Stop, if_overlapping};

/// What a query has learned by asking, wherever its points are kept.
pub struct Inquiry<'q, A, B> {
    /// What is asked.
    pub md: &'q MinkowskiDifference<A, B>,
    /// Sizes and roundings.
    pub precision: Precision,
    /// The lowest support plane met; of infinite depth before the first.
    pub lowest: Lowest,
}

impl<'q, A: SupportMap, B: SupportMap> Inquiry<'q, A, B> {
    /// Nothing asked yet.
    #[inline(always)]
    pub fn new(md: &'q MinkowskiDifference<A, B>) -> Self {
        Self {
            md,
            precision: Precision::default(),
            lowest: Lowest {
                depth: f64::INFINITY,
                dir: Vec3::x(),
            },
        }
    }

    /// The support point along unit `dir`, counted, checked, and its sizes noted; for those who go
    /// on where a direction separates, or keep the point themselves.
    ///
    /// # Errors
    /// A callback's answer that is not finite.
    #[inline(always)]
    pub fn point(&mut self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        let point = self.md.support(dir)?;
        self.precision.note(&point);
        Ok(point)
    }

    /// Asks for the first support point, unless it has been asked for. It needs no set.
    #[inline(always)]
    pub fn first(&mut self, dir: &Vec3, asked: Option<SupportPoint>) -> Result<SupportPoint, Stop> {
        let point = match asked {
            Some(point) => point,
            None => self.md.support(dir)?,
        };
        self.precision.note(&point);
        let depth = dir.dot(&point.v);
        if !self.precision.is_depth(depth) {
            return Err(Stop::Apart(*dir));
        }
        self.lowest = Lowest { depth, dir: *dir };
        Ok(point)
    }

    /// Asks for the support point along unit `dir`, and puts it into the set.
    ///
    /// Where the answer separates, but a known point lies farther along `dir`, that point is
    /// returned and nothing is put.
    #[inline(always)]
    pub fn ask<const N: usize>(
        &mut self,
        set: &mut SupportSet<N>,
        dir: &Vec3,
    ) -> Result<Asked, Stop> {
        let point = self.point(dir)?;
        let h = dir.dot(&point.v);
        // NaN is no depth.
        if !self.precision.is_depth(h) {
            // Taken apart: what is returned by way of memory would come from there always.
            let Asked { i, h, v } = self.apart(set, *dir, &point)?;
            return Ok(Asked { i, h, v });
        }
        self.lower(dir, h);
        let i = set.push(dir, &point);
        Ok(Asked { i, h, v: point.v })
    }

    /// Keeps a support plane if it is the lowest.
    #[inline(always)]
    fn lower(&mut self, dir: &Vec3, h: f64) {
        if h < self.lowest.depth {
            self.lowest = Lowest {
                depth: h,
                dir: *dir,
            };
        }
    }

    /// As [`Inquiry::ask`], for a query that wants yes or no: the point goes to this place
    /// in the set, and the lowest plane is not kept. It, and [`Precision::touch`], metres; `None`: the
    /// answer contradicts a point of the set.
    #[inline(always)]
    pub fn ask_at<const N: usize>(
        &mut self,
        set: &mut SupportSet<N>,
        place: usize,
        dir: &Vec3,
    ) -> Result<Option<(Vec3, f64)>, Stop> {
        let point = self.point(dir)?;
        let h = dir.dot(&point.v);
        let touch = self.precision.touch();
        // NaN is no depth.
        if h > touch {
            set.place(place, dir, &point);
            return Ok(Some((point.v, touch)));
        }
        let known = set.farther(dir, larger(h + self.precision.grain(), touch));
        known.map(|_| None).ok_or(Stop::Apart(*dir))
    }

    /// How far along `dir` a point is that contradicts an answer which separates, at least.
    #[inline(always)]
    pub fn beyond(&self, dir: &Vec3, answer: &SupportPoint) -> f64 {
        let h = dir.dot(&answer.v);
        larger(h + self.precision.grain(), self.precision.touch())
    }

    /// The answer along `dir` separates, or touches within rounding: unless the callback
    /// contradicts itself, and a known point is farther along `dir`, or one that known points of
    /// the two objects make.
    #[cold]
    #[inline(never)]
    pub fn apart<const N: usize>(
        &mut self,
        set: &mut SupportSet<N>,
        dir: Vec3,
        answer: &SupportPoint,
    ) -> Result<Asked, Stop> {
        let least = self.beyond(&dir, answer);
        let i = match set.farther(&dir, least) {
            Some(i) => i,
            None => {
                let made = self.made_beyond(set, &dir, answer, least)?;
                set.push(&Vec3::zeros(), &made)
            }
        };
        let v = set.v(i);
        let h = dir.dot(&v);
        self.lower(&dir, h);
        Ok(Asked { i, h, v })
    }

    /// A point farther along `dir` than `least`, made of obj1's point and obj2's that are farthest,
    /// of the answer there and of the known ones. A known one that is farther than the answer is
    /// asked for again from beside its direction: one that a callback erred in is not found there.
    fn made_beyond<const N: usize>(
        &mut self,
        set: &SupportSet<N>,
        dir: &Vec3,
        answer: &SupportPoint,
        least: f64,
    ) -> Result<SupportPoint, Stop> {
        let Extreme { names, .. } = set.extreme(dir, 1);
        let [mut v1, mut v2] = [answer.v1, answer.v2];
        for (o, name) in names.into_iter().enumerate() {
            let n = set.direction(name);
            let [p, q] = set.witnesses(name);
            let farther = if o == 0 { p - v1 } else { v2 - q };
            if dir.dot(&farther) > self.precision.grain() && n != Vec3::zeros() {
                let again = self.point(&beside(&n))?;
                let nearer = |a: &Vec3, b: &Vec3| if dir.dot(a) < dir.dot(b) { *a } else { *b };
                if o == 0 {
                    let found = nearer(&p, &again.v1);
                    v1 = -nearer(&-found, &-v1);
                } else {
                    let found = -nearer(&-q, &-again.v2);
                    v2 = nearer(&found, &v2);
                }
            }
        }
        let v = v1 - v2;
        if dir.dot(&v) > least {
            Ok(SupportPoint { v, v1, v2 })
        } else {
            Err(Stop::Apart(*dir))
        }
    }
}

/// How far beside a point's direction it is asked for again, radians. Measured on ODE's cylinder,
/// which errs within 1e-3 of its axis.
const BESIDE: f64 = 0.02;

/// A unit vector that far beside one: what a callback gave along that, and does not give here, it
/// erred in.
pub fn beside(n: &Vec3) -> Vec3 {
    let aside = n + perpendicular(n) * BESIDE;
    aside / aside.norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, ball};
    use core::cell::Cell;

    #[test]
    fn points_have_names_and_the_lowest_plane_is_kept() {
        let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 1.5, 1.0));
        let mut inquiry = Inquiry::new(&md);
        let mut set = SupportSet::<4>::EMPTY;
        let Asked { i: a, h, v } = inquiry.ask(&mut set, &Vec3::y()).unwrap();
        assert_eq!((a, h, v), (0, 2.0, set.v(0)));
        let Asked { i: b, h, .. } = inquiry.ask(&mut set, &Vec3::x()).unwrap();
        assert_eq!((b, h, inquiry.lowest.depth), (1, 0.5, 0.5));
        assert_eq!(set.point(b).v1, Vec3::x());
        assert_eq!(set.v(b), Vec3::x() * 0.5);
        assert_eq!(set.direction(b), Vec3::x());
        assert_eq!(md.supports(), 2);
    }

    #[test]
    fn apart_and_touching_end_the_query() {
        for gap in [1.0, 0.0] {
            let other = ball(Vec3::x() * (2.0 + gap), 1.0);
            let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), other);
            let mut set = SupportSet::<4>::EMPTY;
            let stop = Inquiry::new(&md).ask(&mut set, &Vec3::x()).unwrap_err();
            assert_eq!(stop, Stop::Apart(Vec3::x()));
        }
    }

    #[test]
    fn a_callback_that_contradicts_itself_separates_nothing() {
        let asked = Cell::new(0);
        let lying = |_: &Vec3| {
            asked.set(asked.get() + 1);
            Vec3::x() * if asked.get() == 1 { 1.0 } else { -1.0 }
        };
        let md = MinkowskiDifference::new(lying, |_: &Vec3| Vec3::zeros());
        let mut inquiry = Inquiry::new(&md);
        let mut set = SupportSet::<4>::EMPTY;
        inquiry.ask(&mut set, &Vec3::x()).unwrap();
        let again = inquiry.ask(&mut set, &Vec3::x()).unwrap();
        assert_eq!((again.i, again.h, again.v), (0, 1.0, Vec3::x()));
        assert_eq!(inquiry.lowest.depth, 1.0);
    }

    #[test]
    fn points_that_are_not_finite_are_faults() {
        let md =
            MinkowskiDifference::new(|_: &Vec3| Vec3::x() * f64::NAN, |_: &Vec3| Vec3::zeros());
        let mut set = SupportSet::<4>::EMPTY;
        let stop = Inquiry::new(&md).ask(&mut set, &Vec3::x()).unwrap_err();
        assert_eq!(stop, Stop::Fault(Fault::NonFinite));
    }

    #[test]
    fn any_two_points_make_one() {
        let mut r = Random::new(5);
        let mut set = SupportSet::<8>::EMPTY;
        assert_eq!(set.extreme(&Vec3::x(), 0).reach, f64::NEG_INFINITY);
        for _ in 0..7 {
            let [v1, v2] = [r.vector(1.0), r.vector(1.0)];
            set.push(&Vec3::zeros(), &SupportPoint { v: v1 - v2, v1, v2 });
        }
        for first in [0, 1, 6] {
            let n = r.vector(3.0);
            let all = (first..7).flat_map(|i| (first..7).map(move |j| [i, j]));
            let far = |names: [usize; 2]| n.dot(&set.made(names));
            let best = all.max_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap();
            let found = set.extreme(&n, first);
            assert_eq!(found.names, best);
            assert!((found.reach - far(best)).abs() < 64.0 * EPSILON);
        }
        assert_eq!(set.extreme(&Vec3::x(), 7).reach, f64::NEG_INFINITY);
        assert_eq!(set.extreme(&Vec3::x(), 9).reach, f64::NEG_INFINITY);
    }

    #[test]
    fn a_larger_room_keeps_the_names() {
        let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 1.0));
        let mut inquiry = Inquiry::new(&md);
        let mut small = SupportSet::<4>::EMPTY;
        for n in [Vec3::x(), Vec3::y(), Vec3::z()] {
            inquiry.ask(&mut small, &n).unwrap();
        }
        let mut large = SupportSet::<6>::EMPTY;
        large.take(&small);
        assert_eq!(large.len(), 3);
        for i in 0..3 {
            assert_eq!(large.point(i), small.point(i));
            assert_eq!(large.direction(i), small.direction(i));
        }
    }
}
