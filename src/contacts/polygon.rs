// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Convex polygons in a plane, whose corners lie a little below it; segments and points
//! are polygons of two corners and of one.

use crate::contacts::list::List;
use crate::math::{larger, lesser};
use core::mem::swap;

/// A point of the plane.
pub type Flat = [f64; 2];

/// `b - a`.
#[inline]
pub fn side(a: &Flat, b: &Flat) -> Flat {
    [b[0] - a[0], b[1] - a[1]]
}

/// The scalar product.
#[inline]
pub fn dot(a: &Flat, b: &Flat) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Twice the area of the triangle from the origin to `a` and `b`; positive
/// counterclockwise.
#[inline]
pub fn cross(a: &Flat, b: &Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The length.
#[inline]
pub fn length(a: &Flat) -> f64 {
    dot(a, a).sqrt()
}

/// The point at `t` on the way from `a` (0) to `b` (1).
#[inline]
pub fn between(a: &Flat, b: &Flat, t: f64) -> Flat {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
}

/// How far along the way from `a` (0) to `b` (1) the nearest point to `p` is.
#[inline]
fn nearest_to(p: &Flat, a: &Flat, b: &Flat) -> f64 {
    let along = side(a, b);
    let t = dot(&along, &side(a, p)) / dot(&along, &along);
    // NaN, of a side without length, becomes 0.
    if t > 0.0 { t.min(1.0) } else { 0.0 }
}

/// The nearest point to `p` on the way from `a` to `b`.
pub fn onto(p: &Flat, a: &Flat, b: &Flat) -> Flat {
    between(a, b, nearest_to(p, a, b))
}

/// A corner: where it is in the plane, and how far below it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// Where in the plane.
    pub at: Flat,
    /// How far below the plane.
    pub low: f64,
}

/// The tilt of the direction across the side from `a` to `b` of a face, outwards, in which both win alike,
/// but for a `lean` to `b`.
pub fn across(a: &Corner, b: &Corner, tilt: f64, lean: f64) -> Flat {
    let along = side(&a.at, &b.at);
    let whole = length(&along);
    let [x, y] = along.map(|x| x / whole);
    let lean = ((b.low - a.low) / whole).max(-tilt).min(tilt) + lean;
    [y * tilt + x * lean, -x * tilt + y * lean]
}

/// A convex polygon of at most `ROOM` corners, counterclockwise.
pub type Polygon<const ROOM: usize> = List<Corner, ROOM>;

impl<const ROOM: usize> Polygon<ROOM> {
    /// A place of the plane.
    pub fn point(at: Flat) -> Self {
        let mut point = Self::default();
        point.push(Corner { at, low: 0.0 });
        point
    }

    /// Its sides, from corner to corner; a point has one without length.
    pub fn sides(&self) -> impl Iterator<Item = (Corner, Corner)> + Clone + '_ {
        (0..self.len()).map(|i| (*self.at(i), *self.at(i + 1)))
    }

    /// Twice its area.
    pub fn area(&self) -> f64 {
        let Some(first) = self.first() else {
            return 0.0;
        };
        // About a corner: far from the origin the products would round.
        self.sides()
            .map(|(p, q)| cross(&side(&first.at, &p.at), &side(&first.at, &q.at)))
            .sum()
    }

    /// The same without what is no corner: of those nearer than `merged` to each other the first stays;
    /// what sticks out by `flat` or less goes.
    pub fn tidy(&self, merged: f64, flat: f64) -> Self {
        let mut rest = Self::default();
        for p in self.iter() {
            let near = |k: &Corner| length(&side(&k.at, &p.at)) <= merged;
            if !rest.iter().any(near) {
                rest.push(*p);
            }
        }
        // As long as one goes.
        let mut i = 0;
        while i < rest.len() && rest.len() > 2 {
            // The first one becomes the last.
            let mut first = *rest.at(0);
            let places = rest.iter_mut().rev();
            places.for_each(|place| swap(place, &mut first));
            i += 1;
            if let [q, .., p, r] = &*rest {
                let t = nearest_to(&r.at, &p.at, &q.at);
                let out = side(&between(&p.at, &q.at, t), &r.at);
                let is_inside = cross(&side(&p.at, &q.at), &out) > 0.0;
                if length(&out) <= flat || is_inside && t > 0.0 && t < 1.0 {
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
    pub fn inside<const OTHER: usize>(&self, other: &Polygon<OTHER>, slack: f64) -> Self {
        let mut rest = other.sides().fold(*self, |rest, (p, q)| {
            let [x, y] = side(&p.at, &q.at);
            rest.cut(&p.at, &[-y, x], slack)
        });
        for corner in rest.iter_mut() {
            corner.at = other.closest(&corner.at);
        }
        rest
    }

    /// Returns the closest point to `p` of a polygon of three corners or more.
    fn closest(&self, p: &Flat) -> Flat {
        let (mut best, mut least) = (*p, f64::INFINITY);
        let mut is_inside = true;
        for (a, b) in self.sides() {
            is_inside &= cross(&side(&a.at, &b.at), &side(&a.at, p)) >= 0.0;
            let at = onto(p, &a.at, &b.at);
            let apart = length(&side(&at, p));
            if apart < least {
                (best, least) = (at, apart);
            }
        }
        if is_inside { *p } else { best }
    }

    /// What of it is no farther than `slack` behind the line through a place across a way.
    pub fn cut(&self, from: &Flat, way: &Flat, slack: f64) -> Self {
        let room = slack * length(way);
        let within = |a: &Corner| dot(way, &side(from, &a.at)) + room;
        let mut rest = Self::default();
        for (a, b) in self.sides() {
            let (at_a, at_b) = (within(&a), within(&b));
            if at_a >= 0.0 {
                rest.push(a);
            }
            if (at_a >= 0.0) != (at_b >= 0.0) {
                let at = between(&a.at, &b.at, at_a / (at_a - at_b));
                rest.push(Corner { at, low: 0.0 });
            }
        }
        rest
    }

    /// How far below the plane it is at a point of it: between its corners, as triangles
    /// about the first of them span it. Differences by `rounding` are none.
    pub fn low(&self, at: &Flat, rounding: f64) -> f64 {
        let Some(first) = self.first() else {
            return 0.0;
        };
        let (mut least, mut most) = (first.low, first.low);
        for corner in self.iter() {
            (least, most) = (lesser(corner.low, least), larger(corner.low, most));
        }
        if most - least <= rounding {
            return least;
        }
        let mut best = (f64::NEG_INFINITY, first.low);
        for (a, b) in self.sides() {
            let [u, v, p] = [&a.at, &b.at, at].map(|x| side(&first.at, x));
            let whole = cross(&u, &v);
            let (least, low) = if whole > 0.0 {
                let (s, t) = (cross(&p, &v) / whole, cross(&u, &p) / whole);
                let low = first.low + (a.low - first.low) * s + (b.low - first.low) * t;
                (s.min(t).min(1.0 - s - t), low)
            } else {
                // A segment; the sides of a polygon at its first corner.
                let t = nearest_to(at, &a.at, &b.at);
                let least = if self.len() > 2 {
                    f64::NEG_INFINITY
                } else {
                    0.0
                };
                (least, a.low + (b.low - a.low) * t)
            };
            if least > best.0 {
                best = (least, low);
            }
        }
        // A sliver cannot tell how high it is beside itself.
        best.1.max(least).min(most)
    }

    /// The two sides, of this polygon and of another, that are nearest to each other, and a
    /// nearest point of each; of polygons that do not overlap.
    pub fn nearest<const OTHER: usize>(
        &self,
        other: &Polygon<OTHER>,
    ) -> Option<([[Flat; 2]; 2], [Flat; 2])> {
        let (mut best, mut least) = (None, f64::INFINITY);
        for (a, b) in self.sides() {
            for (c, d) in other.sides() {
                let [a, b, c, d] = [a, b, c, d].map(|corner| corner.at);
                // One of the points is an end.
                let mine = [a, b].map(|p| [p, onto(&p, &c, &d)]);
                let its = [c, d].map(|p| [onto(&p, &a, &b), p]);
                for points in mine.into_iter().chain(its) {
                    let apart = length(&side(&points[0], &points[1]));
                    if apart < least {
                        (best, least) = (Some(([[a, b], [c, d]], points)), apart);
                    }
                }
            }
        }
        best
    }

    /// At most `most` of its corners, `first` among them and leading, the others in their
    /// order: the polygon with the largest area, or of two corners the longest side.
    ///
    /// An inscribed polygon is a fan of triangles about `first`, so the best that ends at a
    /// corner is the best that ends at the one before, and a triangle.
    pub fn reduced(&self, first: usize, most: usize) -> Self {
        let mut turned = Self::default();
        (first..first + self.len()).for_each(|i| turned.push(*self.at(i)));
        if turned.len() <= most || most == 0 {
            return turned;
        }
        let spoke = |j: usize| side(&turned.at(0).at, &turned.at(j).at);
        // The best area of a fan that ends at a corner, and its corners, a bit each: a fan of no triangle
        // is a spoke, and then of one triangle more.
        let mut best: [(f64, u32); ROOM] = core::array::from_fn(|j| (0.0, 1 | 1 << j));
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
            let score = if most == 2 { length(&spoke(j)) } else { area };
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

    fn corners(points: &[Flat]) -> Vec<Corner> {
        let low = |at: &Flat| at[0] + 2.0 * at[1];
        let corner = |at: &Flat| Corner {
            at: *at,
            low: low(at),
        };
        points.iter().map(corner).collect()
    }

    fn polygon(points: &[Flat]) -> Eight {
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
            let tidy = polygon(&turned).tidy(1e-6, 1e-6);
            assert_eq!(tidy.len(), 4);
            assert!((tidy.area() - 2.0).abs() < 1e-8);
            let line = [[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]];
            turned[0] = line[k % 3];
            turned[1] = line[(k + 1) % 3];
            turned[2] = line[(k + 2) % 3];
            let ends = polygon(turned.get(..3).unwrap()).tidy(1e-6, 1e-6);
            assert_eq!(ends.len(), 2);
            let apart = side(&ends[0].at, &ends[1].at);
            assert_eq!(length(&apart), (8.0 as f64).sqrt());
        }
        assert_eq!(polygon(&[[3.0, 3.0]; 5]).tidy(0.0, 0.0).len(), 1);
        assert!(Eight::default().tidy(0.0, 0.0).is_empty());
    }

    #[test]
    fn inside_of_another() {
        let shared = square(0.0, 0.0, 1.0).inside(&square(1.0, 1.0, 1.0), 0.0);
        assert_eq!(shared.area(), 2.0);
        let segment = polygon(&[[-3.0, 0.5], [0.5, 0.5]]).inside(&square(0.0, 0.0, 1.0), 0.0);
        let ends = segment.tidy(EPSILON, 0.0);
        assert_eq!(
            ends.iter().map(|c| c.at).collect::<Vec<_>>(),
            [[-1.0, 0.5], [0.5, 0.5]]
        );
        // The slack reaches farther beyond a sharp corner.
        let sliver = polygon(&[[0.0, 0.0], [1.0, -1e-3], [1.0, 1e-3]]);
        let ends = polygon(&[[-1.0, 0.0], [0.5, 0.0]]).inside(&sliver, 1e-6);
        assert!(ends.iter().all(|c| c.at[0] >= 0.0), "{:?}", &*ends);
        assert!(
            polygon(&[[3.0, 0.0]])
                .inside(&square(0.0, 0.0, 1.0), 0.0)
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
    fn nearest_sides() {
        let near = square(0.0, 0.0, 1.0)
            .nearest(&square(4.0, 0.5, 1.0))
            .unwrap();
        assert_eq!(length(&side(&near.1[0], &near.1[1])), 2.0);
        let point = polygon(&[[0.0, 3.0]]);
        assert_eq!(
            square(0.0, 0.0, 1.0).nearest(&point).unwrap().1,
            [[0.0, 1.0], [0.0, 3.0]]
        );
        let [p, q] = point.nearest(&polygon(&[[4.0, 0.0]])).unwrap().1;
        assert_eq!(length(&side(&p, &q)), 5.0);
        assert!(Eight::default().nearest(&point).is_none());
    }

    /// Against all subsets.
    #[test]
    fn reduced_to_the_largest_area() {
        let points: [Flat; 7] = [
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
                        let chosen: Vec<Flat> = (0..7)
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
            let far = length(&side(&two[0].at, &two[1].at));
            let longest = points
                .iter()
                .map(|p| length(&side(&points[first], p)))
                .fold(0.0, f64::max);
            assert_eq!(far, longest);
        }
    }
}
