// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The larger object's vertices in its support plane: if they contain the smaller one's outline, the larger object is a
//! plane there.

use crate::contact::outline::Outline;
use crate::contact::tuning::DROP_TOL;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, larger};

/// The face of the larger object in its support plane, and the outline of the smaller object.
pub struct FlatFace<'o> {
    outline: &'o Outline,
    /// Vertices in the support plane, those farthest along the axes and their opposites. At first the deepest point.
    corners: [Vec2; 4],
    /// Distance by which the outline may be outside of them, metres.
    slack: f64,
}

impl<'o> FlatFace<'o> {
    /// Makes the face of the deepest point alone.
    #[inline(always)]
    pub fn new(outline: &'o Outline, slack: f64) -> Self {
        let corners = [Vec2::zeros(); 4];
        Self {
            outline,
            corners,
            slack,
        }
    }

    /// Adds a vertex in the support plane. Returns whether it is farther than the others.
    #[inline(always)]
    pub fn add(&mut self, v: Vec2) -> bool {
        let [a, b, c, d] = &mut self.corners;
        let farther = [v.x > a.x, v.y > b.y, v.x < c.x, v.y < d.y];
        for (corner, is_farther) in [a, b, c, d].into_iter().zip(farther) {
            *corner = if is_farther { v } else { *corner };
        }
        farther
            .iter()
            .fold(false, |any, is_farther| any | is_farther)
    }

    /// Adds a vertex if it is in the support plane. Returns whether the face now contains the outline, and did not before.
    #[inline(always)]
    pub fn is_completed_by(&mut self, v: &Vec3) -> bool {
        v.z <= DROP_TOL && self.add(v.xy()) && self.contains_outline()
    }

    /// Returns whether the vertices contain the outline: then so does the face, which is convex.
    #[inline(always)]
    pub fn contains_outline(&self) -> bool {
        let [a, b, c, d] = &self.corners;
        let (first, second) = (c - a, d - b);
        // A quadrilateral without area contains nothing. Negated for NaN.
        let sum = first.x.abs() + first.y.abs() + second.x.abs() + second.y.abs();
        if !(first.perp(&second) > self.slack * sum) {
            return false;
        }
        for [p, q] in [[a, b], [b, c], [c, d], [d, a]] {
            let side = q - p;
            let least = side.perp(p) - self.slack * (side.x.abs() + side.y.abs());
            for v in self.outline.iter() {
                if !(side.perp(&v.xy()) >= least) {
                    return false;
                }
            }
        }
        true
    }

    /// Returns whether the outline reaches beyond the side from `p` to `q`, counterclockwise.
    #[inline(always)]
    pub fn is_exceeded_beyond(&self, p: &Vec3, q: &Vec3) -> bool {
        let side = offset(p, q);
        let level = p.xy().perp(&side) + self.slack * side.norm();
        let farthest = |most, v: &Vec3| larger(v.xy().perp(&side), most);
        self.outline.iter().fold(level, farthest) > level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn face_of_known_vertices_contains_what_it_encloses() {
        let mut outline = Outline::EMPTY;
        for (x, y) in [(0.5, 0.0), (0.0, 0.5), (-0.5, 0.0), (0.0, -0.5)] {
            outline.push(Vec3::new(x, y, 0.2), 0.0);
        }
        let mut face = FlatFace::new(&outline, 1e-9);
        let corners = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
        for corner in &corners {
            assert!(!face.is_completed_by(corner));
        }
        // Below the support plane.
        assert!(!face.is_completed_by(&Vec3::new(0.0, -1.0, 0.5)));
        assert!(face.is_exceeded_beyond(&corners[2], &Vec3::new(1.0, -0.1, 0.0)));
        assert!(face.is_completed_by(&Vec3::new(0.0, -1.0, 0.0)));
        let [p, q] = [Vec3::new(-1.0, -0.6, 0.0), Vec3::new(1.0, -0.6, 0.0)];
        assert!(!face.is_exceeded_beyond(&p, &q));
        // The deepest point alone.
        assert!(!FlatFace::new(&outline, 1e-9).contains_outline());
    }
}
