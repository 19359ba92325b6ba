// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The outline of an object in a contact: vertices in order around the deepest point, from the search to the integrals.

use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, ZERO, larger};
use core::ops::Deref;

/// The area that an outline encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Footprint {
    /// No area: the deepest point is the center of pressure.
    Point,
    /// The inside of the outline.
    Area,
    /// All that the other object's outline encloses; no outline was searched.
    Plane,
}

/// Largest number of corners: the first four, one beyond each side, and one beyond each of its halves.
const MAX_CORNERS: usize = 4 + 4 + 8;
/// Largest number of vertices: the corners, and one that encloses the deepest point.
const MAX_VERTICES: usize = MAX_CORNERS + 1;

/// The vertices of an object in a contact, counterclockwise around the deepest point, the origin. x and y are coordinates
/// along the frame's axes, metres; z is the drop, in depths.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// `vertices[len]` repeats the first one once the outline is closed.
    vertices: [Vec3; MAX_VERTICES + 1],
    len: usize,
}

impl Deref for Outline {
    type Target = [Vec3];

    #[inline(always)]
    fn deref(&self) -> &[Vec3] {
        self.vertices.get(..self.len).unwrap_or(&[])
    }
}

impl Outline {
    /// The outline without vertices.
    pub const EMPTY: Self = Self {
        vertices: [ZERO; MAX_VERTICES + 1],
        len: 0,
    };

    /// Appends a corner, unless it is the last one, within `same` along both axes.
    #[inline(always)]
    pub fn push(&mut self, v: Vec3, same: f64) {
        let last = self.vertices[self.len.wrapping_sub(1).min(MAX_VERTICES)];
        if self.len == 0 || !are_same(&last, &v, same) {
            self.vertices[self.len.min(MAX_VERTICES)] = v;
            self.len = (self.len + 1).min(MAX_VERTICES);
        }
    }

    /// Returns vertex `i`; that after the last one is the first one.
    #[inline(always)]
    pub fn vertex(&self, i: usize) -> &Vec3 {
        &self.vertices[i.min(MAX_VERTICES)]
    }

    /// Returns the sides of a closed outline, counterclockwise.
    #[inline(always)]
    pub fn sides(&self) -> impl Iterator<Item = (&Vec3, &Vec3)> {
        self.vertices
            .iter()
            .zip(self.vertices.iter().skip(1))
            .take(self.len)
    }

    /// Makes the corners an outline around the deepest point: raises them by `common`, the drop that all have, moves them
    /// outwards by `margin`, metres, and encloses the deepest point. Each end of an edge, and a point, becomes two vertices
    /// or more. An outline that is nowhere farther than `point_size` from the deepest point is a point.
    #[inline(always)]
    pub fn close(&mut self, margin: f64, point_size: f64, common: f64) -> Footprint {
        let last = *self.vertex(self.len.wrapping_sub(1));
        if self.len > 1 && are_same(&self.vertices[0], &last, margin) {
            self.len -= 1;
        }
        let sum = self.iter().fold(Vec2::zeros(), |sum, v| sum + v.xy());
        if self.len > 2 {
            let mean = sum * (1.0 / self.len as f64);
            let far = self.vertices[0].xy() - mean;
            let scale = 1.0 + margin / (far.x.abs() + far.y.abs() + f64::MIN_POSITIVE);
            let shift = mean * (1.0 - scale);
            for v in self.vertices.iter_mut().take(self.len) {
                *v = Vec3::new(v.x * scale + shift.x, v.y * scale + shift.y, v.z - common);
            }
        } else {
            self.widen(margin, common);
        }
        self.repeat_first();
        let (mut is_point, mut is_inside, mut turns) = (true, true, 0);
        for (p, q) in self.sides() {
            is_inside &= area2(p, q) > 0.0;
            turns += usize::from(p.y < 0.0) & usize::from(q.y >= 0.0);
            let size = point_size * larger(q.z, 1.0);
            is_point &= q.xy().norm_squared() <= size * size;
        }
        let is_around = is_inside && turns == 1;
        if !is_point && (is_around || self.enclose_deepest_point(margin)) {
            Footprint::Area
        } else {
            Footprint::Point
        }
    }

    /// Repeats the first vertex after the last one.
    #[inline(always)]
    fn repeat_first(&mut self) {
        self.vertices[self.len.min(MAX_VERTICES)] = self.vertices[0];
    }

    /// Replaces the ends of an edge, or a point, by vertices at a distance, metres, and raises them by a drop.
    #[inline(always)]
    fn widen(&mut self, distance: f64, raised: f64) {
        let (a, b) = (self.vertices[0], *self.vertex(self.len.wrapping_sub(1)));
        let along = offset(&a, &b);
        let length = along.norm();
        let along = if length > 0.0 {
            along / length
        } else {
            Vec2::x()
        } * distance;
        let left = Vec2::new(-along.y, along.x);
        let corners = [(a, -along), (a, -left), (b, along), (b, left)];
        for (place, (v, out)) in self.vertices.iter_mut().zip(corners) {
            *place = Vec3::new(v.x + out.x, v.y + out.y, v.z - raised);
        }
        self.len = corners.len();
    }

    /// Orders the vertices around the deepest point and, if it is outside, adds a vertex at `distance` behind it. Returns
    /// false if there is no area.
    ///
    /// The vertices are mostly in order, but not always around an edge: the vertex along a direction may be high, in
    /// place of one farther along it and lower.
    #[cold]
    #[inline(never)]
    fn enclose_deepest_point(&mut self, distance: f64) -> bool {
        let is_before = |a: &Vec3, b: &Vec3| {
            let half = |v: &Vec3| u8::from(v.y < 0.0 || v.y == 0.0 && v.x < 0.0);
            half(a) < half(b) || half(a) == half(b) && area2(a, b) > 0.0
        };
        // Insertion sort.
        for end in 1..self.len.min(MAX_VERTICES) {
            let mut i = end;
            while i > 0 && i <= MAX_VERTICES {
                let (earlier, later) = (self.vertices[i - 1], self.vertices[i]);
                if !is_before(&later, &earlier) {
                    break;
                }
                (self.vertices[i - 1], self.vertices[i]) = (later, earlier);
                i -= 1;
            }
        }
        self.repeat_first();
        let is_open = |(p, q): (&Vec3, &Vec3)| {
            let area = area2(p, q);
            area < 0.0 || area == 0.0 && p.xy().dot(&q.xy()) <= 0.0
        };
        let open = self.sides().position(is_open);
        if let Some(open) = open {
            let (p, q) = (self.vertex(open), self.vertex(open + 1));
            // Opposite to the bisector of the directions to p and q, also if both are on one side.
            let [a, b] = [p, q].map(|v| 1.0 / (v.xy().norm_squared() + f64::MIN_POSITIVE).sqrt());
            let (x, y) = (q.y * b - p.y * a, p.x * a - q.x * b);
            let scale = distance / (x * x + y * y + f64::MIN_POSITIVE).sqrt();
            let mut behind = Vec3::new(x * scale, y * scale, 0.0);
            let places = self.vertices.iter_mut().skip(open + 1);
            places.for_each(|place| core::mem::swap(place, &mut behind));
            self.len = (self.len + 1).min(MAX_VERTICES);
            self.repeat_first();
        }
        self.len > 2
    }
}

/// Returns twice the area of the triangle of the deepest point and two vertices, positive if counterclockwise.
#[inline(always)]
pub fn area2(a: &Vec3, b: &Vec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns whether two points are no farther apart than `distance` along either axis.
#[inline(always)]
pub fn are_same(a: &Vec3, b: &Vec3, distance: f64) -> bool {
    larger((a.x - b.x).abs(), (a.y - b.y).abs()) <= distance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Random;

    /// Tests outlines from a triangle to a sliver that points at the deepest point, and one in the wrong order: all areas
    /// are positive once the deepest point is enclosed. A point has none.
    #[test]
    fn enclosed_outline_contains_the_deepest_point() {
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
            let mut outline = Outline::EMPTY;
            for (x, y) in corners {
                let (x, y) = (x * cos - y * sin, x * sin + y * cos);
                outline.push(Vec3::new(x, y, 0.0), 0.0);
            }
            assert_eq!(outline.close(1e-3, 0.0, 0.0), Footprint::Area, "{round}");
            for (p, q) in outline.sides() {
                assert!(area2(p, q) > 0.0, "{round} {outline:?}");
            }
        }
        let mut point = Outline::EMPTY;
        point.push(Vec3::x(), 0.0);
        assert_eq!(point.close(1e-3, 2.0, 0.0), Footprint::Point);
    }
}
