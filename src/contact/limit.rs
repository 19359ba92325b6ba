// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The limit of the search for the polygon of the larger object: the outline of the smaller one.

use crate::contact::fan::Fan;
use crate::contact::overlap::{Overlap, in_overlap, volume_of};
use crate::contact::tuning::DROP_TOL;
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, ZERO, larger};

/// The outline of the smaller object, beyond which the larger one is not searched.
pub struct Limit {
    /// The outline of the smaller object, mirrored, beyond which no corner matters.
    outline: FixedVec<Vec2, { Fan::CAPACITY }>,
    /// The overlap of the smaller object with a plane, mirrored.
    overlap: Overlap,
    /// Vertices in the support plane, those farthest along the axes and their opposites.
    face: [Vec2; 4],
    /// Distance by which the outline may be outside of them, metres.
    slack: f64,
}

impl Limit {
    /// Makes the limit without vertices in the support plane. `outline`: of the smaller object, in its own frame.
    #[inline(always)]
    pub fn new(outline: &[Vec3], slack: f64) -> Self {
        let mut limit = Self {
            outline: FixedVec::default(),
            overlap: Overlap::EMPTY,
            face: [Vec2::zeros(); 4],
            slack,
        };
        let mut last = in_overlap(outline.last().unwrap_or(&ZERO), 0.0);
        for v in outline {
            let v = in_overlap(v, 0.0);
            limit.overlap.add(volume_of(&last, &v), &-v);
            limit.outline.push(-v.xy());
            last = v;
        }
        limit
    }

    /// Adds a vertex if it is in the support plane. Returns whether it is farther than the others.
    #[inline(always)]
    pub fn add(&mut self, v: &Vec3) -> bool {
        if !(v.z <= DROP_TOL) {
            return false;
        }
        let [a, b, c, d] = &mut self.face;
        let farther = [v.x > a.x, v.y > b.y, v.x < c.x, v.y < d.y];
        for (place, is_farther) in [a, b, c, d].into_iter().zip(farther) {
            *place = if is_farther { v.xy() } else { *place };
        }
        farther
            .iter()
            .fold(false, |any, is_farther| any | is_farther)
    }

    /// Returns whether the vertices in the support plane contain the outline: then so does the face, which is convex.
    #[inline(always)]
    pub fn is_plane(&self) -> bool {
        let [a, b, c, d] = &self.face;
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
                if !(side.perp(v) >= least) {
                    return false;
                }
            }
        }
        true
    }

    /// Returns how far the outline is beyond the side from `p` to `q`, metres; 0 if it is not.
    #[inline(always)]
    pub fn reach_beyond(&self, p: &Vec3, q: &Vec3) -> f64 {
        let side = offset(p, q);
        let level = p.xy().perp(&side);
        let length = side.norm();
        let least = self.slack * length;
        let most = |most, v: &Vec2| larger(v.perp(&side) - level, most);
        let most = self.outline.iter().fold(least, most);
        if most > least { most / length } else { 0.0 }
    }
}

impl Overlap {
    /// Returns the overlap with the other object's: the one of less volume.
    #[inline(always)]
    pub fn limited(&self, limit: Option<&Limit>) -> Self {
        match limit {
            Some(limit) if limit.overlap.volume.abs() < self.volume.abs() => limit.overlap,
            _ => *self,
        }
    }
}
