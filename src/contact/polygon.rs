// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Convex polygons in a contact frame, whose corners lie a little below a support plane; segments and
//! points are polygons of two corners and of one.

use crate::math::{larger, lesser};
use core::mem::swap;
use core::ops::{Deref, DerefMut};

/// A point or vector of the frame.
pub type Point2 = [f64; 2];

/// Returns `b - a`.
#[inline]
pub fn vector(a: &Point2, b: &Point2) -> Point2 {
    [b[0] - a[0], b[1] - a[1]]
}

/// Returns the scalar product.
#[inline]
pub fn dot(a: &Point2, b: &Point2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns twice the area of the triangle from the origin to `a` and `b`; positive
/// counterclockwise.
#[inline]
pub fn cross(a: &Point2, b: &Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns the length.
#[inline]
pub fn norm(a: &Point2) -> f64 {
    dot(a, a).sqrt()
}

/// Returns the point at `t` on the way from `a` (0) to `b` (1).
#[inline]
pub fn lerp(a: &Point2, b: &Point2, t: f64) -> Point2 {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
}

/// Returns how far along the way from `a` (0) to `b` (1) the closest point to `p` is.
#[inline]
fn segment_parameter(p: &Point2, a: &Point2, b: &Point2) -> f64 {
    let along = vector(a, b);
    let t = dot(&along, &vector(a, p)) / dot(&along, &along);
    // NaN, of a side without length, becomes 0.
    if t > 0.0 { t.min(1.0) } else { 0.0 }
}

/// Returns the closest point to `p` of the segment from `a` to `b`.
pub fn closest_on_segment(p: &Point2, a: &Point2, b: &Point2) -> Point2 {
    lerp(a, b, segment_parameter(p, a, b))
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// Its place in the frame.
    pub at: Point2,
    /// How far below the support plane.
    pub low: f64,
}

/// Returns the tilt of the direction across the side from `a` to `b` of a face, outwards, in which both have the
/// same value, but for a `lean` to `b`.
pub fn across(a: &Corner, b: &Corner, tilt: f64, lean: f64) -> Point2 {
    let along = vector(&a.at, &b.at);
    let whole = norm(&along);
    let [x, y] = along.map(|x| x / whole);
    let lean = ((b.low - a.low) / whole).max(-tilt).min(tilt) + lean;
    [y * tilt + x * lean, -x * tilt + y * lean]
}

/// At most `CAPACITY` elements, in order; a full one takes no more.
#[derive(Clone, Copy, Debug)]
pub struct FixedVec<T, const CAPACITY: usize> {
    all: [T; CAPACITY],
    len: usize,
}

impl<T: Copy + Default, const CAPACITY: usize> Default for FixedVec<T, CAPACITY> {
    fn default() -> Self {
        Self {
            all: [T::default(); CAPACITY],
            len: 0,
        }
    }
}

impl<T, const CAPACITY: usize> Deref for FixedVec<T, CAPACITY> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        self.all.get(..self.len).unwrap_or(&[])
    }
}

impl<T, const CAPACITY: usize> DerefMut for FixedVec<T, CAPACITY> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        self.all.get_mut(..self.len).unwrap_or(&mut [])
    }
}

impl<T, const CAPACITY: usize> FixedVec<T, CAPACITY> {
    #[inline(always)]
    fn index(&self, i: usize) -> usize {
        let i = if i < self.len { i } else { i - self.len };
        i.min(CAPACITY - 1)
    }

    /// Returns the `i`th, counted on from the first after the last.
    #[inline(always)]
    pub fn at(&self, i: usize) -> &T {
        &self.all[self.index(i)]
    }

    /// Returns the same, mutable.
    #[inline(always)]
    pub fn at_mut(&mut self, i: usize) -> &mut T {
        &mut self.all[self.index(i)]
    }

    /// Adds one after the last.
    #[inline(always)]
    pub fn push(&mut self, new: T) {
        if let Some(end) = self.all.get_mut(self.len) {
            *end = new;
            self.len += 1;
        }
    }

    /// Inserts one; those from there on move up, the last out of a full one.
    #[inline(always)]
    pub fn insert(&mut self, i: usize, mut new: T) {
        self.len = (self.len + 1).min(CAPACITY);
        let places = self.iter_mut().skip(i);
        places.for_each(|place| swap(place, &mut new));
    }

    /// Removes the last.
    pub fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
    }
}

/// A convex polygon of at most `CAPACITY` corners, counterclockwise.
pub type Polygon<const CAPACITY: usize> = FixedVec<Corner, CAPACITY>;

impl<const CAPACITY: usize> Polygon<CAPACITY> {
    /// Returns a polygon of one corner.
    pub fn point(at: Point2) -> Self {
        let mut point = Self::default();
        point.push(Corner { at, low: 0.0 });
        point
    }

    /// Returns the sides, from corner to corner; a point has one without length.
    pub fn sides(&self) -> impl Iterator<Item = (Corner, Corner)> + Clone + '_ {
        (0..self.len()).map(|i| (*self.at(i), *self.at(i + 1)))
    }

    /// Returns twice the area.
    pub fn area(&self) -> f64 {
        let Some(first) = self.first() else {
            return 0.0;
        };
        // About a corner: far from the origin the products would round.
        self.sides()
            .map(|(p, q)| cross(&vector(&first.at, &p.at), &vector(&first.at, &q.at)))
            .sum()
    }

    /// Returns the polygon without what is no corner: of those closer than `merged` the first stays; those that
    /// are outside the side of their neighbours by `flat` or less go.
    pub fn tidied(&self, merged: f64, flat: f64) -> Self {
        let mut rest = Self::default();
        for p in self.iter() {
            let near = |k: &Corner| norm(&vector(&k.at, &p.at)) <= merged;
            if !rest.iter().any(near) {
                rest.push(*p);
            }
        }
        // Until none goes.
        let mut i = 0;
        while i < rest.len() && rest.len() > 2 {
            // The first one becomes the last.
            let mut first = *rest.at(0);
            let places = rest.iter_mut().rev();
            places.for_each(|place| swap(place, &mut first));
            i += 1;
            if let [q, .., p, r] = &*rest {
                let t = segment_parameter(&r.at, &p.at, &q.at);
                let out = vector(&lerp(&p.at, &q.at, t), &r.at);
                let is_inside = cross(&vector(&p.at, &q.at), &out) > 0.0;
                if norm(&out) <= flat || is_inside && t > 0.0 && t < 1.0 {
                    rest.pop();
                    i = 0;
                }
            }
        }
        rest
    }

    /// Returns what of it is inside another polygon of three corners or more (Sutherland and Hodgman,
    /// Reentrant polygon clipping, CACM 17(1), 1974). What is no farther than `slack` outside is moved
    /// onto it: beyond a sharp corner the lines of two sides, moved by the slack, meet farther away.
    pub fn clipped_by<const OTHER: usize>(&self, other: &Polygon<OTHER>, slack: f64) -> Self {
        let mut rest = other.sides().fold(*self, |rest, (p, q)| {
            let [x, y] = vector(&p.at, &q.at);
            rest.clipped(&p.at, &[-y, x], slack)
        });
        for corner in rest.iter_mut() {
            corner.at = other.closest(&corner.at);
        }
        rest
    }

    /// Returns the closest point to `p` of a polygon of three corners or more.
    fn closest(&self, p: &Point2) -> Point2 {
        let (mut best, mut least) = (*p, f64::INFINITY);
        let mut is_inside = true;
        for (a, b) in self.sides() {
            is_inside &= cross(&vector(&a.at, &b.at), &vector(&a.at, p)) >= 0.0;
            let at = closest_on_segment(p, &a.at, &b.at);
            let apart = norm(&vector(&at, p));
            if apart < least {
                (best, least) = (at, apart);
            }
        }
        if is_inside { *p } else { best }
    }

    /// Returns what of it is no farther than `slack` behind the line through `from` across `way`.
    pub fn clipped(&self, from: &Point2, way: &Point2, slack: f64) -> Self {
        let room = slack * norm(way);
        let within = |a: &Corner| dot(way, &vector(from, &a.at)) + room;
        let mut rest = Self::default();
        for (a, b) in self.sides() {
            let (at_a, at_b) = (within(&a), within(&b));
            if at_a >= 0.0 {
                rest.push(a);
            }
            if (at_a >= 0.0) != (at_b >= 0.0) {
                let at = lerp(&a.at, &b.at, at_a / (at_a - at_b));
                rest.push(Corner { at, low: 0.0 });
            }
        }
        rest
    }

    /// Returns how far below the support plane it is at a place: on its mean plane (Newell), or between the
    /// ends of a segment. Differences by `rounding` are none.
    pub fn low(&self, at: &Point2, rounding: f64) -> f64 {
        let lows = || self.iter().map(|c| c.low);
        let (least, most) = (lows().fold(f64::INFINITY, lesser), lows().fold(0.0, larger));
        if !(most - least > rounding) {
            return if self.is_empty() { 0.0 } else { least };
        }
        let [a, b] = [self.at(0), self.at(1)];
        if self.len() == 2 {
            return a.low + (b.low - a.low) * segment_parameter(at, &a.at, &b.at);
        }
        let (mut slope, mut area, mut mean) = ([0.0; 2], 0.0, Corner::default());
        let share = 1.0 / self.len() as f64;
        for (b, c) in self.sides() {
            let (v, w) = (vector(&a.at, &b.at), vector(&a.at, &c.at));
            let (p, q) = (b.low - a.low, c.low - a.low);
            area += cross(&v, &w);
            slope = [
                slope[0] + p * w[1] - q * v[1],
                slope[1] + q * v[0] - p * w[0],
            ];
            mean.at = [mean.at[0] + v[0] * share, mean.at[1] + v[1] * share];
            mean.low += p * share;
        }
        let low = dot(&slope, &vector(&mean.at, &vector(&a.at, at))) / area + mean.low + a.low;
        // The plane of a sliver means nothing beside it. NaN becomes the least.
        lesser(larger(low, least), most)
    }

    /// Returns the two sides, of this polygon and of another, that are closest to each other, and the closest
    /// point of each; of polygons that do not overlap.
    pub fn closest_sides<const OTHER: usize>(
        &self,
        other: &Polygon<OTHER>,
    ) -> Option<([[Point2; 2]; 2], [Point2; 2])> {
        let (mut best, mut least) = (None, f64::INFINITY);
        for (a, b) in self.sides() {
            for (c, d) in other.sides() {
                let [a, b, c, d] = [a, b, c, d].map(|corner| corner.at);
                // One of the points is an end.
                let mine = [a, b].map(|p| [p, closest_on_segment(&p, &c, &d)]);
                let its = [c, d].map(|p| [closest_on_segment(&p, &a, &b), p]);
                for points in mine.into_iter().chain(its) {
                    let apart = norm(&vector(&points[0], &points[1]));
                    if apart < least {
                        (best, least) = (Some(([[a, b], [c, d]], points)), apart);
                    }
                }
            }
        }
        best
    }

    /// Returns at most `most` of its corners, `first` among them and leading, the others in their
    /// order: the polygon with the largest area, or of two corners the longest side.
    ///
    /// Dynamic programming: the best fan of triangles about `first` that ends at a corner is the best that ends at
    /// one before, and a triangle.
    pub fn reduced(&self, first: usize, most: usize) -> Self {
        let mut turned = Self::default();
        (first..first + self.len()).for_each(|i| turned.push(*self.at(i)));
        if turned.len() <= most || most == 0 {
            return turned;
        }
        let spoke = |j: usize| vector(&turned.at(0).at, &turned.at(j).at);
        // The best area of a fan that ends at a corner, and its corners, a bit each: a fan of no triangle
        // is a spoke, and then of one triangle more.
        let mut best: [(f64, u32); CAPACITY] = core::array::from_fn(|j| (0.0, 1 | 1 << j));
        for _ in 2..most {
            let shorter = best;
            for (j, best) in best.iter_mut().enumerate().skip(1) {
                *best = (f64::NEG_INFINITY, 0);
                for (i, (area, fan)) in shorter.iter().enumerate().take(j).skip(1) {
                    let area = area + cross(&spoke(i), &spoke(j));
                    if area > best.0 {
                        *best = (area, fan | 1 << j);
                    }
                }
            }
        }
        let (mut largest, mut taken) = (f64::NEG_INFINITY, 1);
        for (j, (area, fan)) in best.into_iter().enumerate().take(turned.len()).skip(1) {
            let score = if most == 2 { norm(&spoke(j)) } else { area };
            if score > largest {
                (largest, taken) = (score, fan);
            }
        }
        let mut rest = Self::default();
        let corners = turned
            .iter()
            .enumerate()
            .filter(|(j, _)| taken >> j & 1 != 0);
        corners
            .take(most)
            .for_each(|(_, corner)| rest.push(*corner));
        rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;

    type Eight = Polygon<8>;

    fn corners(points: &[Point2]) -> Vec<Corner> {
        let low = |at: &Point2| at[0] + 2.0 * at[1];
        let corner = |at: &Point2| Corner {
            at: *at,
            low: low(at),
        };
        points.iter().map(corner).collect()
    }

    fn polygon(points: &[Point2]) -> Eight {
        let mut p = Eight::default();
        corners(points).iter().for_each(|c| p.push(*c));
        p
    }

    fn square(x: f64, y: f64, h: f64) -> Eight {
        polygon(&[
            [x - h, y - h],
            [x + h, y - h],
            [x + h, y + h],
            [x - h, y + h],
        ])
    }

    #[test]
    fn tidy_is_without_what_is_no_corner() {
        let points = [
            [0.0, 0.0],
            [0.5, 0.0],
            [1.0, 0.0],
            [1.0, 1e-9],
            [0.9, 0.5],
            [1.0, 1.0],
            [0.0, 1.0],
        ];
        for k in 0..points.len() {
            let mut turned = points;
            turned.rotate_left(k);
            let tidy = polygon(&turned).tidied(1e-6, 1e-6);
            assert_eq!(tidy.len(), 4);
            assert!((tidy.area() - 2.0).abs() < 1e-8);
            let line = [[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]];
            turned[0] = line[k % 3];
            turned[1] = line[(k + 1) % 3];
            turned[2] = line[(k + 2) % 3];
            let ends = polygon(turned.get(..3).unwrap()).tidied(1e-6, 1e-6);
            assert_eq!(ends.len(), 2);
            let apart = vector(&ends[0].at, &ends[1].at);
            assert_eq!(norm(&apart), (8.0 as f64).sqrt());
        }
        assert_eq!(polygon(&[[3.0, 3.0]; 5]).tidied(0.0, 0.0).len(), 1);
        assert!(Eight::default().tidied(0.0, 0.0).is_empty());
    }

    #[test]
    fn clipped_by_another() {
        let shared = square(0.0, 0.0, 1.0).clipped_by(&square(1.0, 1.0, 1.0), 0.0);
        assert_eq!(shared.area(), 2.0);
        let segment = polygon(&[[-3.0, 0.5], [0.5, 0.5]]).clipped_by(&square(0.0, 0.0, 1.0), 0.0);
        let ends = segment.tidied(EPSILON, 0.0);
        assert_eq!(
            ends.iter().map(|c| c.at).collect::<Vec<_>>(),
            [[-1.0, 0.5], [0.5, 0.5]]
        );
        // The slack reaches farther beyond a sharp corner.
        let sliver = polygon(&[[0.0, 0.0], [1.0, -1e-3], [1.0, 1e-3]]);
        let ends = polygon(&[[-1.0, 0.0], [0.5, 0.0]]).clipped_by(&sliver, 1e-6);
        assert!(ends.iter().all(|c| c.at[0] >= 0.0), "{:?}", &*ends);
        assert!(
            polygon(&[[3.0, 0.0]])
                .clipped_by(&square(0.0, 0.0, 1.0), 0.0)
                .is_empty()
        );
    }

    #[test]
    fn low_is_linear_between_corners() {
        for at in [[0.1, 0.2], [-0.7, 0.9], [1.0, 1.0], [0.0, 0.0]] {
            let low = square(0.0, 0.0, 1.0).low(&at, 0.0);
            assert!((low - (at[0] + 2.0 * at[1])).abs() < 8.0 * EPSILON);
        }
        assert!((polygon(&[[0.0, 0.0], [1.0, 0.0]]).low(&[0.25, 0.3], 0.0) - 0.25).abs() < EPSILON);
        assert_eq!(polygon(&[[1.0, 1.0]]).low(&[5.0, 5.0], 0.0), 3.0);
    }

    #[test]
    fn closest_sides_of_two() {
        let near = square(0.0, 0.0, 1.0)
            .closest_sides(&square(4.0, 0.5, 1.0))
            .unwrap();
        assert_eq!(norm(&vector(&near.1[0], &near.1[1])), 2.0);
        let point = polygon(&[[0.0, 3.0]]);
        assert_eq!(
            square(0.0, 0.0, 1.0).closest_sides(&point).unwrap().1,
            [[0.0, 1.0], [0.0, 3.0]]
        );
        let [p, q] = point.closest_sides(&polygon(&[[4.0, 0.0]])).unwrap().1;
        assert_eq!(norm(&vector(&p, &q)), 5.0);
        assert!(Eight::default().closest_sides(&point).is_none());
    }

    /// Against all subsets.
    #[test]
    fn reduced_to_the_largest_area() {
        let points: [Point2; 7] = [
            [0.0, 0.0],
            [2.0, -0.5],
            [3.0, 0.2],
            [3.3, 1.0],
            [2.0, 2.4],
            [1.0, 2.5],
            [-0.4, 1.0],
        ];
        let whole = polygon(&points);
        for first in 0..7 {
            for most in 1..=7 {
                let rest = whole.reduced(first, most);
                assert_eq!(rest.len(), most);
                assert_eq!(rest[0].at, points[first]);
                let mut best: f64 = 0.0;
                for set in 0..128_usize {
                    if set & (1 << first) != 0 && set.count_ones() as usize == most {
                        let chosen: Vec<Point2> = (0..7)
                            .filter(|i| set & (1 << i) != 0)
                            .map(|i| points[i])
                            .collect();
                        best = best.max(polygon(&chosen).area());
                    }
                }
                assert!(
                    (rest.area() - best).abs() < 64.0 * EPSILON,
                    "{first} {most}"
                );
            }
            let two = whole.reduced(first, 2);
            let far = norm(&vector(&two[0].at, &two[1].at));
            let longest = points
                .iter()
                .map(|p| norm(&vector(&points[first], p)))
                .fold(0.0, f64::max);
            assert_eq!(far, longest);
        }
    }
}
