// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Convex polygons in a contact frame. x and y of a corner are its coordinates along the axes, metres; z is its *drop*, the
//! distance below the support plane: in metres for a contact manifold, in depths for a contact position. Segments and
//! points are polygons of two corners and of one.

use crate::geometry::fixed_vec::FixedVec;
use crate::math::{Vec3, larger, lesser};

/// A vector along the two axes of a contact frame.
pub type Vec2 = nalgebra::Vector2<f64>;

/// Returns the displacement from `a` to `b` along the two axes.
#[inline]
pub fn offset(a: &Vec3, b: &Vec3) -> Vec2 {
    (b - a).xy()
}

/// Returns the parameter (`a`: 0, `b`: 1) of the point of the segment from `a` to `b` closest to `p`.
fn segment_parameter(p: &Vec3, a: &Vec3, b: &Vec3) -> f64 {
    let along = offset(a, b);
    let t = along.dot(&offset(a, p)) / along.norm_squared();
    // NaN, for a segment of length 0, becomes 0.
    if t > 0.0 { t.min(1.0) } else { 0.0 }
}

/// Returns the point of the segment from `a` to `b` closest to `p`.
fn closest_on_segment(p: &Vec3, a: &Vec3, b: &Vec3) -> Vec3 {
    a.lerp(b, segment_parameter(p, a, b))
}

/// A convex polygon of at most `CAPACITY` corners, counterclockwise.
pub type Polygon<const CAPACITY: usize> = FixedVec<Vec3, CAPACITY>;

impl<const CAPACITY: usize> Polygon<CAPACITY> {
    /// Returns the sides, from corner to corner; a point has one side of length 0.
    fn sides(&self) -> impl Iterator<Item = (Vec3, Vec3)> + Clone + '_ {
        (0..self.len()).map(|i| (*self.cyclic(i), *self.cyclic(i + 1)))
    }

    /// Returns twice the area vector (Newell): z is twice the area, m², and it is perpendicular to the mean plane.
    fn double_area_vector(&self) -> Vec3 {
        // Relative to a corner: far from the origin the products would be less exact.
        let first = self.cyclic(0);
        let triangles = self.sides().map(|(p, q)| (p - first).cross(&(q - first)));
        triangles.sum()
    }

    /// Returns twice the area, m².
    pub fn double_area(&self) -> f64 {
        self.double_area_vector().z
    }

    /// Returns the polygon without duplicate corners (no farther than `merged` from an earlier one) and without
    /// nearly collinear corners (at most `min_height` outside the line of their neighbours).
    pub fn simplified(&self, merged: f64, min_height: f64) -> Self {
        let mut rest = Self::default();
        for p in self.iter() {
            if !rest.iter().any(|k| offset(k, p).norm() <= merged) {
                rest.push(*p);
            }
        }
        let is_collinear = |rest: &Self, i: usize| {
            let [p, r, q] = [i + rest.len() - 1, i, i + 1].map(|i| rest.cyclic(i));
            let t = segment_parameter(r, p, q);
            let out = offset(&p.lerp(q, t), r);
            out.norm() <= min_height || offset(p, q).perp(&out) > 0.0 && t > 0.0 && t < 1.0
        };
        while let Some(i) = (0..rest.len()).find(|i| rest.len() > 2 && is_collinear(&rest, *i)) {
            let others = (0..rest.len()).filter(|k| *k != i);
            rest = others.map(|k| *rest.cyclic(k)).collect();
        }
        rest
    }

    /// Returns the part inside another polygon of three corners or more (I. Sutherland and G. Hodgman,
    /// "Reentrant polygon clipping", CACM 17(1), 1974). Each side of the other polygon is first moved outwards by
    /// `slack`; corners of the result are then moved to the closest point of the other polygon. (At a sharp corner
    /// the moved sides intersect farther away than the slack.)
    pub fn clipped_by<const OTHER: usize>(&self, other: &Polygon<OTHER>, slack: f64) -> Self {
        let mut rest = *self;
        for (p, q) in other.sides() {
            let along = offset(&p, &q);
            rest = rest.clipped(&p, &Vec2::new(-along.y, along.x), slack);
        }
        rest.iter().map(|corner| other.closest(corner)).collect()
    }

    /// Returns the point closest to `p` of a polygon of three corners or more.
    fn closest(&self, p: &Vec3) -> Vec3 {
        let is_inside = |(a, b)| offset(&a, &b).perp(&offset(&a, p)) >= 0.0;
        if self.sides().all(is_inside) {
            return *p;
        }
        let point = Polygon::<1>::from_iter([*p]);
        self.closest_sides(&point).map_or(*p, |(_, [at, _])| at)
    }

    /// Returns the part on the side of `inwards` of the line through `from` perpendicular to it, and up to `slack`
    /// on the other side.
    pub fn clipped(&self, from: &Vec3, inwards: &Vec2, slack: f64) -> Self {
        let scaled_slack = slack * inwards.norm();
        let height = |a: &Vec3| inwards.dot(&offset(from, a)) + scaled_slack;
        let mut rest = Self::default();
        for (a, b) in self.sides() {
            let (height_a, height_b) = (height(&a), height(&b));
            if height_a >= 0.0 {
                rest.push(a);
            }
            if (height_a >= 0.0) != (height_b >= 0.0) {
                rest.push(a.lerp(&b, height_a / (height_a - height_b)));
            }
        }
        rest
    }

    /// Returns the drop at a position: that of the mean plane, or interpolated between the ends of a segment.
    pub fn drop_at(&self, at: &Vec3) -> f64 {
        let drops = || self.iter().map(|c| c.z);
        let least = drops().fold(f64::INFINITY, lesser);
        let most = drops().fold(0.0, larger);
        let [a, b] = [self.cyclic(0), self.cyclic(1)];
        let drop = if self.len() == 2 {
            a.z + (b.z - a.z) * segment_parameter(at, a, b)
        } else {
            let normal = self.double_area_vector();
            let mean = self.iter().sum::<Vec3>() / self.len() as f64;
            mean.z - normal.xy().dot(&offset(&mean, at)) / normal.z
        };
        // Limited to the corners' range, because the plane of a sliver is inaccurate. NaN becomes the least drop.
        lesser(larger(drop, least), most)
    }

    /// Returns the two sides, one of this polygon and one of another, that are closest to each other, and the
    /// closest point of each. The polygons must not overlap.
    pub fn closest_sides<const OTHER: usize>(
        &self,
        other: &Polygon<OTHER>,
    ) -> Option<([[Vec3; 2]; 2], [Vec3; 2])> {
        let (mut best, mut least) = (None, f64::INFINITY);
        for (a, b) in self.sides() {
            for (c, d) in other.sides() {
                // At least one of the closest points is an end.
                let mine = [a, b].map(|p| [p, closest_on_segment(&p, &c, &d)]);
                let its = [c, d].map(|p| [closest_on_segment(&p, &a, &b), p]);
                for [p, q] in mine.into_iter().chain(its) {
                    let distance = offset(&p, &q).norm();
                    if distance < least {
                        (best, least) = (Some(([[a, b], [c, d]], [p, q])), distance);
                    }
                }
            }
        }
        best
    }

    /// Returns the indices of at most `most` corners, `first` and then the others in their order, which span the
    /// largest area; of two corners, the longest distance. Indices beyond the length are for [`FixedVec::cyclic`].
    ///
    /// Dynamic programming: the largest fan of triangles about `first` that ends at a corner consists of the
    /// largest fan that ends at an earlier corner and one triangle.
    pub fn reduced(&self, first: usize, most: usize) -> FixedVec<usize, CAPACITY> {
        let all = first..first + self.len();
        if self.len() <= most {
            return all.collect();
        }
        let spoke = |j: usize| offset(self.cyclic(first), self.cyclic(first + j));
        // For each corner: the largest area of a fan that ends there, and a bit mask of the fan's corners. Initially a
        // fan without triangles; each pass adds a triangle.
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
    fn simplified_removes_duplicate_and_collinear_corners() {
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
            let simplified = polygon(&turned).simplified(1e-6, 1e-6);
            assert_eq!(simplified.len(), 4);
            assert!((simplified.double_area() - 2.0).abs() < 1e-8);
            let line = [[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]];
            turned[0] = line[k % 3];
            turned[1] = line[(k + 1) % 3];
            turned[2] = line[(k + 2) % 3];
            let ends = polygon(turned.get(..3).unwrap()).simplified(1e-6, 1e-6);
            assert_eq!(ends.len(), 2);
            let side = offset(&ends[0], &ends[1]);
            assert_eq!(side.norm(), (8.0 as f64).sqrt());
        }
        assert_eq!(polygon(&[[3.0, 3.0]; 5]).simplified(0.0, 0.0).len(), 1);
        assert!(Eight::default().simplified(0.0, 0.0).is_empty());
    }

    #[test]
    fn clipped_polygon_is_the_common_part() {
        let shared = square(0.0, 0.0, 1.0).clipped_by(&square(1.0, 1.0, 1.0), 0.0);
        assert_eq!(shared.double_area(), 2.0);
        let segment = polygon(&[[-3.0, 0.5], [0.5, 0.5]]).clipped_by(&square(0.0, 0.0, 1.0), 0.0);
        let ends = segment.simplified(EPSILON, 0.0);
        assert_eq!(
            ends.iter().map(point).collect::<Vec<_>>(),
            [[-1.0, 0.5], [0.5, 0.5]]
        );
        // The moved sides intersect farther away than the slack at a sharp corner.
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
    fn drop_is_linear_between_corners() {
        for at in [[0.1, 0.2], [-0.7, 0.9], [1.0, 1.0], [0.0, 0.0]] {
            let drop = square(0.0, 0.0, 1.0).drop_at(&Vec3::new(at[0], at[1], 0.0));
            assert!((drop - (at[0] + 2.0 * at[1])).abs() < 8.0 * EPSILON);
        }
        assert!(
            (polygon(&[[0.0, 0.0], [1.0, 0.0]]).drop_at(&Vec3::new(0.25, 0.3, 0.0)) - 0.25).abs()
                < EPSILON
        );
        assert_eq!(
            polygon(&[[1.0, 1.0]]).drop_at(&Vec3::new(5.0, 5.0, 0.0)),
            3.0
        );
    }

    #[test]
    fn closest_sides_of_two_polygons() {
        let near = square(0.0, 0.0, 1.0)
            .closest_sides(&square(4.0, 0.5, 1.0))
            .unwrap();
        assert_eq!(offset(&near.1[0], &near.1[1]).norm(), 2.0);
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
        assert_eq!(offset(&p, &q).norm(), 5.0);
        assert!(Eight::default().closest_sides(&tip).is_none());
    }

    /// Compares with all subsets.
    #[test]
    fn reduced_polygon_has_the_largest_area() {
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
                let rest: Eight = indices.iter().map(|i| *whole.cyclic(*i)).collect();
                assert_eq!(rest.len(), most);
                assert_eq!(point(&rest[0]), points[first]);
                let mut best: f64 = 0.0;
                for set in 0..128_usize {
                    if set & (1 << first) != 0 && set.count_ones() as usize == most {
                        let chosen: Vec<Point2> = (0..7)
                            .filter(|i| set & (1 << i) != 0)
                            .map(|i| points[i])
                            .collect();
                        best = best.max(polygon(&chosen).double_area());
                    }
                }
                assert!(
                    (rest.double_area() - best).abs() < 64.0 * EPSILON,
                    "{first} {most}"
                );
            }
            let two = whole.reduced(first, 2);
            let far = offset(whole.cyclic(two[0]), whole.cyclic(two[1])).norm();
            let distances = whole.iter().map(|p| offset(&whole[first], p).norm());
            let longest = distances.fold(0.0, f64::max);
            assert_eq!(far, longest);
        }
    }
}
