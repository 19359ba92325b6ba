// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Convex polygons in a contact frame: x and y of a corner are along the axes, z is how far it lies below a support
//! plane. Segments and points are polygons of two corners and of one.

use crate::contact::fixed_vec::FixedVec;
use crate::math::{Vec3, larger, lesser};

/// A vector of the frame.
pub type Vec2 = nalgebra::Vector2<f64>;

/// Returns the way from `a` to `b` in the frame.
#[inline]
pub fn way(a: &Vec3, b: &Vec3) -> Vec2 {
    (b - a).xy()
}

/// Returns how far along the way from `a` (0) to `b` (1) the closest point to `p` is.
fn segment_parameter(p: &Vec3, a: &Vec3, b: &Vec3) -> f64 {
    let along = way(a, b);
    let t = along.dot(&way(a, p)) / along.norm_squared();
    // NaN, of a side without length, becomes 0.
    if t > 0.0 { t.min(1.0) } else { 0.0 }
}

/// Returns the closest point to `p` of the segment from `a` to `b`.
fn closest_on_segment(p: &Vec3, a: &Vec3, b: &Vec3) -> Vec3 {
    a.lerp(b, segment_parameter(p, a, b))
}

/// A convex polygon of at most `CAPACITY` corners, counterclockwise.
pub type Polygon<const CAPACITY: usize> = FixedVec<Vec3, CAPACITY>;

impl<const CAPACITY: usize> Polygon<CAPACITY> {
    /// Returns the sides, from corner to corner; a point has one without length.
    pub fn sides(&self) -> impl Iterator<Item = (Vec3, Vec3)> + Clone + '_ {
        (0..self.len()).map(|i| (*self.at(i), *self.at(i + 1)))
    }

    /// Returns the area vector (Newell), twice as long: z is twice the area, and it is across the mean plane.
    fn area_vector(&self) -> Vec3 {
        // About a corner: far from the origin the products would round.
        let first = self.at(0);
        let triangles = self.sides().map(|(p, q)| (p - first).cross(&(q - first)));
        triangles.sum()
    }

    /// Returns twice the area.
    pub fn area(&self) -> f64 {
        self.area_vector().z
    }

    /// Returns the polygon without what is no corner: of those closer than `merged` the first stays; those that
    /// are outside the side of their neighbours by `flat` or less go.
    pub fn tidied(&self, merged: f64, flat: f64) -> Self {
        let mut rest = Self::default();
        for p in self.iter() {
            if !rest.iter().any(|k| way(k, p).norm() <= merged) {
                rest.push(*p);
            }
        }
        let is_flat = |rest: &Self, i: usize| {
            let [p, r, q] = [i + rest.len() - 1, i, i + 1].map(|i| rest.at(i));
            let t = segment_parameter(r, p, q);
            let out = way(&p.lerp(q, t), r);
            out.norm() <= flat || way(p, q).perp(&out) > 0.0 && t > 0.0 && t < 1.0
        };
        while let Some(i) = (0..rest.len()).find(|i| rest.len() > 2 && is_flat(&rest, *i)) {
            let others = (0..rest.len()).filter(|k| *k != i);
            rest = others.map(|k| *rest.at(k)).collect();
        }
        rest
    }

    /// Returns what of it is inside another polygon of three corners or more (Sutherland and Hodgman,
    /// Reentrant polygon clipping, CACM 17(1), 1974). What is no farther than `slack` outside is moved
    /// onto it: beyond a sharp corner the lines of two sides, moved by the slack, meet farther away.
    pub fn clipped_by<const OTHER: usize>(&self, other: &Polygon<OTHER>, slack: f64) -> Self {
        let mut rest = *self;
        for (p, q) in other.sides() {
            let along = way(&p, &q);
            rest = rest.clipped(&p, &Vec2::new(-along.y, along.x), slack);
        }
        rest.iter().map(|corner| other.closest(corner)).collect()
    }

    /// Returns the closest point to `p` of a polygon of three corners or more.
    fn closest(&self, p: &Vec3) -> Vec3 {
        let is_inside = |(a, b)| way(&a, &b).perp(&way(&a, p)) >= 0.0;
        if self.sides().all(is_inside) {
            return *p;
        }
        let point = Polygon::<1>::from_iter([*p]);
        self.closest_sides(&point).map_or(*p, |(_, [at, _])| at)
    }

    /// Returns what of it is no farther than `slack` behind the line through `from` across `inwards`.
    pub fn clipped(&self, from: &Vec3, inwards: &Vec2, slack: f64) -> Self {
        let room = slack * inwards.norm();
        let within = |a: &Vec3| inwards.dot(&way(from, a)) + room;
        let mut rest = Self::default();
        for (a, b) in self.sides() {
            let (at_a, at_b) = (within(&a), within(&b));
            if at_a >= 0.0 {
                rest.push(a);
            }
            if (at_a >= 0.0) != (at_b >= 0.0) {
                rest.push(a.lerp(&b, at_a / (at_a - at_b)));
            }
        }
        rest
    }

    /// Returns how far below the support plane it is at a place: on its mean plane, or between the ends of a
    /// segment.
    pub fn low(&self, at: &Vec3) -> f64 {
        let lows = || self.iter().map(|c| c.z);
        let (least, most) = (lows().fold(f64::INFINITY, lesser), lows().fold(0.0, larger));
        let [a, b] = [self.at(0), self.at(1)];
        let low = if self.len() == 2 {
            a.z + (b.z - a.z) * segment_parameter(at, a, b)
        } else {
            let across = self.area_vector();
            let mean = self.iter().sum::<Vec3>() / self.len() as f64;
            mean.z - across.xy().dot(&way(&mean, at)) / across.z
        };
        // The plane of a sliver means nothing beside it. NaN becomes the least.
        lesser(larger(low, least), most)
    }

    /// Returns the two sides, of this polygon and of another, that are closest to each other, and the closest
    /// point of each; of polygons that do not overlap.
    pub fn closest_sides<const OTHER: usize>(
        &self,
        other: &Polygon<OTHER>,
    ) -> Option<([[Vec3; 2]; 2], [Vec3; 2])> {
        let (mut best, mut least) = (None, f64::INFINITY);
        for (a, b) in self.sides() {
            for (c, d) in other.sides() {
                // One of the points is an end.
                let mine = [a, b].map(|p| [p, closest_on_segment(&p, &c, &d)]);
                let its = [c, d].map(|p| [closest_on_segment(&p, &a, &b), p]);
                for [p, q] in mine.into_iter().chain(its) {
                    let apart = way(&p, &q).norm();
                    if apart < least {
                        (best, least) = (Some(([[a, b], [c, d]], [p, q])), apart);
                    }
                }
            }
        }
        best
    }

    /// Returns the indices, from the first one on, of at most `most` corners, `first` among them and leading, the
    /// others in their order: the polygon with the largest area, or of two corners the longest side.
    ///
    /// Dynamic programming: the best fan of triangles about `first` that ends at a corner is the best that ends at
    /// one before, and a triangle.
    pub fn reduced(&self, first: usize, most: usize) -> FixedVec<usize, CAPACITY> {
        let all = first..first + self.len();
        if self.len() <= most {
            return all.collect();
        }
        let spoke = |j: usize| way(self.at(first), self.at(first + j));
        // Of the fans that end at a corner: the largest area, and the corners, a bit each. A fan of no triangle is a
        // spoke; each pass adds a triangle.
        let length = |j: usize| if most == 2 { spoke(j).norm() } else { 0.0 };
        let mut best: [(f64, u32); CAPACITY] = core::array::from_fn(|j| (length(j), 1 | 1 << j));
        let larger_fan = |a: (f64, u32), b: (f64, u32)| if b.0 > a.0 { b } else { a };
        for _ in 2..most {
            let shorter = best;
            for (j, best) in best.iter_mut().enumerate().skip(1) {
                let fans = shorter.iter().enumerate().take(j).skip(1);
                let longer = fans.map(|(i, (area, fan))| {
                    let triangle = spoke(i).perp(&spoke(j));
                    (area + triangle, fan | 1 << j)
                });
                *best = longer.fold((f64::NEG_INFINITY, 0), larger_fan);
            }
        }
        let fans = best.into_iter().take(self.len()).skip(1);
        let (_, taken) = fans.fold((f64::NEG_INFINITY, 1), larger_fan);
        all.filter(|i| taken >> (i - first) & 1 != 0)
            .take(most)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;

    type Eight = Polygon<8>;

    type Point2 = [f64; 2];

    fn polygon(points: &[Point2]) -> Eight {
        let corner = |[x, y]: &Point2| Vec3::new(*x, *y, x + 2.0 * y);
        points.iter().map(corner).collect()
    }

    fn point(corner: &Vec3) -> Point2 {
        corner.xy().into()
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
            let apart = way(&ends[0], &ends[1]);
            assert_eq!(apart.norm(), (8.0 as f64).sqrt());
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
            ends.iter().map(point).collect::<Vec<_>>(),
            [[-1.0, 0.5], [0.5, 0.5]]
        );
        // The slack reaches farther beyond a sharp corner.
        let sliver = polygon(&[[0.0, 0.0], [1.0, -1e-3], [1.0, 1e-3]]);
        let ends = polygon(&[[-1.0, 0.0], [0.5, 0.0]]).clipped_by(&sliver, 1e-6);
        assert!(ends.iter().all(|c| c.x >= 0.0), "{:?}", &*ends);
        assert!(
            polygon(&[[3.0, 0.0]])
                .clipped_by(&square(0.0, 0.0, 1.0), 0.0)
                .is_empty()
        );
    }

    #[test]
    fn low_is_linear_between_corners() {
        for at in [[0.1, 0.2], [-0.7, 0.9], [1.0, 1.0], [0.0, 0.0]] {
            let low = square(0.0, 0.0, 1.0).low(&Vec3::new(at[0], at[1], 0.0));
            assert!((low - (at[0] + 2.0 * at[1])).abs() < 8.0 * EPSILON);
        }
        assert!(
            (polygon(&[[0.0, 0.0], [1.0, 0.0]]).low(&Vec3::new(0.25, 0.3, 0.0)) - 0.25).abs()
                < EPSILON
        );
        assert_eq!(polygon(&[[1.0, 1.0]]).low(&Vec3::new(5.0, 5.0, 0.0)), 3.0);
    }

    #[test]
    fn closest_sides_of_two() {
        let near = square(0.0, 0.0, 1.0)
            .closest_sides(&square(4.0, 0.5, 1.0))
            .unwrap();
        assert_eq!(way(&near.1[0], &near.1[1]).norm(), 2.0);
        let tip = polygon(&[[0.0, 3.0]]);
        assert_eq!(
            square(0.0, 0.0, 1.0)
                .closest_sides(&tip)
                .unwrap()
                .1
                .map(|p| point(&p)),
            [[0.0, 1.0], [0.0, 3.0]]
        );
        let [p, q] = tip.closest_sides(&polygon(&[[4.0, 0.0]])).unwrap().1;
        assert_eq!(way(&p, &q).norm(), 5.0);
        assert!(Eight::default().closest_sides(&tip).is_none());
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
                let indices = whole.reduced(first, most);
                let rest: Eight = indices.iter().map(|i| *whole.at(*i)).collect();
                assert_eq!(rest.len(), most);
                assert_eq!(point(&rest[0]), points[first]);
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
            let far = way(whole.at(two[0]), whole.at(two[1])).norm();
            let ways = whole.iter().map(|p| way(&whole[first], p).norm());
            let longest = ways.fold(0.0, f64::max);
            assert_eq!(far, longest);
        }
    }
}
