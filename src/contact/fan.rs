// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The vertices of a feature, in order around the deepest point.

use crate::contact::feature::four_directions;
use crate::contact::overlap::{ContactPolygon, MAX_POLYGON_CORNERS, in_overlap, volume_of};
use crate::contact::tuning::{COMMON_DROP_FACTOR, DROP_TOL};
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, ZERO, larger, lesser};

/// Returns twice the area of the triangle of the deepest point and two vertices, positive if counterclockwise.
#[inline(always)]
pub fn area2(a: &Vec3, b: &Vec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns a vertex moved along unit `out` and raised by a drop.
#[inline(always)]
fn moved(v: &Vec3, out: Vec2, distance: f64, raised: f64) -> Vec3 {
    Vec3::new(v.x + distance * out.x, v.y + distance * out.y, v.z - raised)
}

/// The vertices of a feature, counterclockwise around the deepest point.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// `vertices[len]` repeats the first one.
    pub vertices: [Vec3; Fan::CAPACITY],
    pub len: usize,
}

impl Fan {
    /// Largest number of vertices: those of a polygon, one that encloses the deepest point, and the repeated first one.
    pub const CAPACITY: usize = MAX_POLYGON_CORNERS + 2;
    /// The fan without vertices.
    pub const EMPTY: Self = Self {
        vertices: [ZERO; Self::CAPACITY],
        len: 0,
    };

    /// Sets the vertices to the corners of a polygon, moved outwards by `distance`, metres, and raised by the drop that all
    /// have in common. Each end of an edge becomes two vertices, one of them to the side; a point becomes four.
    #[inline(always)]
    pub fn set(&mut self, corners: &ContactPolygon, distance: f64) {
        self.len = 0;
        let least = corners.iter().fold(1.0, |least, c| lesser(c.z, least));
        let common = COMMON_DROP_FACTOR * least;
        match &**corners {
            [a] => {
                for out in four_directions(Vec2::x()) {
                    self.push(moved(a, out, distance, common));
                }
            }
            [a, b] => {
                let along = offset(a, b);
                let out = four_directions(along * (1.0 / along.norm()));
                for (v, k) in [(a, 2), (a, 3), (b, 0), (b, 1)] {
                    self.push(moved(v, out[k], distance, common));
                }
            }
            _ => {
                let mean = corners.iter().sum::<Vec3>() / corners.len() as f64;
                for v in corners.iter() {
                    let out = offset(&mean, v);
                    let norm2 = larger(out.norm_squared(), f64::MIN_POSITIVE);
                    self.push(moved(v, out, distance / norm2.sqrt(), common));
                }
            }
        }
        self.remove_steep();
    }

    /// Returns the vertices.
    pub fn outline(&self) -> &[Vec3] {
        self.vertices.get(..self.len).unwrap_or(&[])
    }

    /// Appends a vertex; a full fan ignores it.
    #[inline(always)]
    pub fn push(&mut self, v: Vec3) {
        if self.len < Self::CAPACITY - 1 {
            self.vertices[self.len] = v;
            self.len += 1;
        }
    }

    /// Repeats the first vertex. Returns whether the outline is farther than `size` from the deepest point anywhere, and
    /// whether the vertices are once around that, counterclockwise.
    #[inline(always)]
    pub fn close(&mut self, size: f64) -> [bool; 2] {
        let n = self.len.min(Self::CAPACITY - 1);
        self.vertices[n] = self.vertices[0];
        let mut turns = 0;
        let (mut is_inside, mut is_point) = (true, true);
        let mut p = self.vertices[0];
        for q in self.vertices.iter().skip(1).take(n) {
            is_inside &= area2(&p, q) > 0.0;
            turns += usize::from(p.y < 0.0) & usize::from(q.y >= 0.0);
            let limit = size * larger(q.z, 1.0);
            is_point &= q.xy().norm_squared() <= limit * limit;
            p = *q;
        }
        [!is_point, is_inside && turns == 1]
    }

    /// Returns twice the area of the triangle of the deepest point, vertex `i` and the next one.
    #[inline(always)]
    pub fn area(&self, i: usize) -> f64 {
        let i = i.min(Self::CAPACITY - 2);
        area2(&self.vertices[i], &self.vertices[i + 1])
    }

    /// Orders the vertices around the deepest point and, if it is outside, adds a vertex at `distance` behind it. Returns
    /// false if there is no area.
    ///
    /// The vertices are mostly in order, but not always around an edge: the vertex along a direction may be high, in
    /// place of one farther along it and lower.
    #[cold]
    #[inline(never)]
    pub fn enclose_deepest_point(&mut self, distance: f64) -> bool {
        let is_before = |a: &Vec3, b: &Vec3| {
            let half = |v: &Vec3| u8::from(v.y < 0.0 || v.y == 0.0 && v.x < 0.0);
            half(a) < half(b) || half(a) == half(b) && area2(a, b) > 0.0
        };
        let n = self.len.min(Self::CAPACITY - 2);
        // Insertion sort.
        for end in 1..n {
            let mut i = end;
            while i > 0 && i < Self::CAPACITY {
                if !is_before(&self.vertices[i], &self.vertices[i - 1]) {
                    break;
                }
                (self.vertices[i], self.vertices[i - 1]) = (self.vertices[i - 1], self.vertices[i]);
                i -= 1;
            }
        }
        self.len = n;
        self.vertices[n] = self.vertices[0];
        let is_gap = |i: &usize| {
            let [p, q] = self.side(*i);
            let area = area2(p, q);
            area < 0.0 || area == 0.0 && p.xy().dot(&q.xy()) <= 0.0
        };
        if let Some(gap) = (0..n).find(is_gap) {
            let [p, q] = self.side(gap);
            // Opposite to the bisector of the directions to p and q, also if both are on one side.
            let [a, b] = [p, q].map(|v| 1.0 / (v.xy().norm_squared() + f64::MIN_POSITIVE).sqrt());
            let (x, y) = (q.y * b - p.y * a, p.x * a - q.x * b);
            let scale = distance / (x * x + y * y + f64::MIN_POSITIVE).sqrt();
            let mut behind = Vec3::new(x * scale, y * scale, 0.0);
            let places = self.vertices.iter_mut().skip(gap + 1);
            places.for_each(|place| core::mem::swap(place, &mut behind));
            self.len = n + 1;
            self.vertices[n + 1] = self.vertices[0];
        }
        self.remove(Self::is_dent);
        self.len > 2
    }

    /// Removes vertices on surfaces beside the face, with which less volume is in the overlap. (The drop of a convex surface is
    /// not greater than any interpolation, so the one with more volume is closer.)
    #[inline(always)]
    fn remove_steep(&mut self) {
        if self.outline().iter().any(|v| v.z > 1.0) {
            self.remove(Self::is_steep);
        }
    }

    /// Removes vertices while more than two are left. Repeats the first one.
    #[cold]
    #[inline(never)]
    fn remove(&mut self, is_wrong: impl Fn(&Self, usize) -> bool) {
        self.vertices[self.len.min(Self::CAPACITY - 1)] = self.vertices[0];
        let mut i = 0;
        while i < self.len && self.len > 2 {
            if is_wrong(self, i) {
                for k in 1..Self::CAPACITY {
                    if k > i {
                        self.vertices[k - 1] = self.vertices[k];
                    }
                }
                self.len -= 1;
                self.vertices[self.len.min(Self::CAPACITY - 1)] = self.vertices[0];
                i = 0;
            } else {
                i += 1;
            }
        }
    }

    /// Returns whether vertex `i` is below the overlap, and the overlap has more volume without it.
    fn is_steep(&self, i: usize) -> bool {
        let [p, _] = self.side(if i > 0 { i - 1 } else { self.len - 1 });
        let [v, q] = self.side(i);
        let [p, at, q] = [p, v, q].map(|v| in_overlap(v, 0.0));
        v.z > 1.0 && volume_of(&p, &at) + volume_of(&at, &q) < volume_of(&p, &q)
    }

    /// Returns the ends of side `i`, below the length.
    #[inline(always)]
    fn side(&self, i: usize) -> [&Vec3; 2] {
        let i = i.min(Self::CAPACITY - 2);
        [&self.vertices[i], &self.vertices[i + 1]]
    }

    /// Returns whether vertex `i` is on the inner side of the line of its neighbours, and not higher than the plane of these
    /// and the deepest point. (The object is convex, so the surface extends to that line.)
    fn is_dent(&self, i: usize) -> bool {
        let [p, _] = self.side(if i > 0 { i - 1 } else { self.len - 1 });
        let [v, q] = self.side(i);
        let per_area = 1.0 / area2(p, q);
        let (weight_p, weight_q) = (area2(v, q) * per_area, area2(p, v) * per_area);
        per_area > 0.0
            && weight_p + weight_q < 1.0
            && weight_p * p.z + weight_q * q.z < v.z + DROP_TOL
    }

    /// Mirrors the fan through the deepest point.
    #[inline(always)]
    pub fn mirror(&mut self) {
        for v in self.vertices.iter_mut().take(self.len + 1) {
            (v.x, v.y) = (-v.x, -v.y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Random;

    /// Tests fans from a triangle to a sliver that points at the deepest point, and one in the wrong order: all areas
    /// are positive once the deepest point is enclosed. A point has none.
    #[test]
    fn enclosed_fan_contains_the_deepest_point() {
        let mut r = Random::new(1);
        for round in 0..1000 {
            let width = 10.0_f64.powf(-r.within(0.0, 4.0));
            let mut corners = vec![
                (2.0, width),
                (1.0, -width),
                (3.0, -width * r.within(-0.4, 0.9)),
            ];
            if round % 2 == 0 {
                corners.extend([(-0.25, -0.061), (-0.05, -0.3)]);
            }
            let (sin, cos) = r.within(0.0, core::f64::consts::TAU).sin_cos();
            let mut fan = Fan::EMPTY;
            for (x, y) in corners {
                let (x, y) = (x * cos - y * sin, x * sin + y * cos);
                fan.push(Vec3::new(x, y, 0.0));
            }
            assert!(!fan.close(0.0)[1]);
            assert!(fan.enclose_deepest_point(1e-3));
            assert!(fan.close(0.0)[1], "{round} {fan:?}");
        }
        let mut point = Fan::EMPTY;
        point.push(Vec3::x());
        point.close(0.0);
        assert!(!point.enclose_deepest_point(1e-3));
    }
}
