// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the corners of an object's outline in a contact, all of them support vertices along inclined directions
//! ([`crate::contact::inclined_support`]).
//!
//! 1. Evaluate four directions at right angles, inclined by T.
//! 2. Where a vertex is below the overlap, lower the slope to that of the chord from the deepest point to the vertex, until the
//!    surface proves straight or the vertex is in the overlap.
//! 3. A side matters if what it may hide moves the mean of the corners: a corner beyond it, in the triangle that the
//!    directions of its ends allow, or a vertex between its ends that is higher than both.
//! 4. Beyond a side that matters, and beyond each half of it that does, evaluate the direction in which both ends have the
//!    same height.
//! 5. Of the larger object only sides that cut the smaller one's outline matter, and it is a plane if vertices in its support
//!    plane contain that outline.
//!
//! There are no classes of objects: a face, an edge and a corner are outlines of many corners, two and one; the sides of a
//! curved outline cease to matter. T is the slope at which a surface whose radius is the extent has a drop of one depth, and
//! step 2 finds it for a flatter one. A known vertex is no corner: which vertices are known depends on the search before.

use crate::contact::flat_face::FlatFace;
use crate::contact::frame::outwards;
use crate::contact::inclined_support::InclinedSupport;
use crate::contact::outline::{Footprint, Outline, are_same};
use crate::contact::tuning::{CORNER_SHIFT_REL, MAX_DROP};
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, ZERO, larger, lesser};
use crate::minkowski::support::{Difference, Fault};

/// Largest number of times that a slope is lowered.
const MAX_CHORDS: usize = 3;

/// The rule by which a side matters.
struct SideRule<'f, 'o> {
    /// None for the smaller object.
    face: Option<&'f FlatFace<'o>>,
    /// The area of the first corners, m².
    area: f64,
    /// The larger of the extent and the root of the area, metres.
    size: f64,
}

/// The most that a side may hide.
struct Level {
    /// The area of the largest triangle beyond a side whose ends are farthest along directions at an angle α, over the square
    /// of its length: tan(α / 2) / 4.
    triangle: f64,
    /// The largest shift of the mean, relative to the size, by a corner that is not searched.
    shift: f64,
}

/// A side between two of the first corners: α is 90°.
const SIDE: Level = Level {
    triangle: 0.25,
    shift: CORNER_SHIFT_REL,
};
/// A half of it. What it may hide moves the mean of more corners.
const HALF: Level = Level {
    triangle: 0.1036,
    shift: 1.5 * CORNER_SHIFT_REL,
};

impl SideRule<'_, '_> {
    /// Returns whether a vertex beyond the side from `p` to `q` could move the mean of the corners. `common`: the drop that all
    /// vertices have in common.
    #[inline(always)]
    fn matters(&self, p: &Vec3, q: &Vec3, level: &Level, common: f64) -> bool {
        let moves_mean = |missing: f64, lever2: f64| {
            let allowed = level.shift * self.size * (self.area + missing);
            // False for NaN.
            missing * missing * lever2 > allowed * allowed
        };
        let length2 = offset(p, q).norm_squared();
        // Half of the triangle of the deepest point and the ends, times the height of a vertex between them that has the
        // common drop alone.
        let height = lesser(lesser(p.z, q.z) - common, 1.0);
        let raised = 0.25 * p.xy().perp(&q.xy()).abs() * larger(height, 0.0);
        let is_open = moves_mean(level.triangle * length2, length2)
            | moves_mean(raised, 0.25 * (p.xy() + q.xy()).norm_squared());
        is_open && self.face.is_none_or(|face| face.is_exceeded_beyond(p, q))
    }
}

impl<D: Difference> InclinedSupport<'_, D> {
    /// Finds the outline of an object. `face`: for the larger object its known face, with the smaller one's outline.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn find_outline(
        &self,
        object: usize,
        mut face: Option<&mut FlatFace>,
        outline: &mut Outline,
    ) -> Result<Footprint, Fault> {
        self.least_drop.set(1.0);
        let mut first = [ZERO; 4];
        for (axis, corner) in first.iter_mut().enumerate() {
            *corner = self.corner_along_axis(object, axis);
            if let Some(face) = &mut face {
                if face.is_completed_by(corner) {
                    self.validate()?;
                    return Ok(Footprint::Plane);
                }
            }
        }
        let diagonals = [offset(&first[0], &first[2]), offset(&first[1], &first[3])];
        let area = 0.5 * diagonals[0].perp(&diagonals[1]).abs();
        let rule = SideRule {
            face: face.as_deref(),
            area,
            size: larger(self.extent, area.sqrt()),
        };
        for k in 0..4 {
            let (p, q) = (&first[k], &first[(k + 1) % 4]);
            outline.push(*p, self.vertex_offset);
            let Some(m) = self.corner_beyond(object, p, q, &SIDE, &rule) else {
                continue;
            };
            if let Some(corner) = self.corner_beyond(object, p, &m, &HALF, &rule) {
                outline.push(corner, self.vertex_offset);
            }
            outline.push(m, self.vertex_offset);
            if let Some(corner) = self.corner_beyond(object, &m, q, &HALF, &rule) {
                outline.push(corner, self.vertex_offset);
            }
        }
        self.validate()?;
        Ok(outline.close(
            self.vertex_offset,
            CORNER_SHIFT_REL * self.extent,
            self.common_drop(),
        ))
    }

    /// Finds the vertex along an axis or its opposite, in the overlap if the surface is curved.
    #[inline(always)]
    fn corner_along_axis(&self, object: usize, axis: usize) -> Vec3 {
        let v = self.evaluate_along_axis(object, axis);
        if v.z > MAX_DROP {
            let out = [Vec2::x(), Vec2::y(), -Vec2::x(), -Vec2::y()];
            return self.lowered(object, out[axis % 4], v);
        }
        v
    }

    /// Finds the corner beyond a side, if the side matters and there is one.
    #[inline(always)]
    fn corner_beyond(
        &self,
        object: usize,
        p: &Vec3,
        q: &Vec3,
        level: &Level,
        rule: &SideRule,
    ) -> Option<Vec3> {
        let is_same = |a: &Vec3, b: &Vec3| are_same(a, b, self.vertex_offset);
        if is_same(p, q) || !rule.matters(p, q, level, self.common_drop()) {
            return None;
        }
        let out = outwards(p, q, self.depth_over_slope, 0.0);
        let mut v = self.evaluate(object, out);
        // Negated for NaN.
        if !(self.height(&v, &out) > self.height(p, &out) + 2.0 * self.vertex_offset) {
            return None;
        }
        let least = lesser(p.z, q.z);
        if v.z > MAX_DROP && least < MAX_DROP {
            v = self.lowered(object, out, v);
        }
        let is_beyond = offset(p, &v).perp(&offset(p, q)) > 0.0 || v.z < least;
        (is_beyond && !is_same(&v, p) && !is_same(&v, q)).then_some(v)
    }

    /// Lowers the slope towards `out` to that of the chord from the deepest point to a vertex below the overlap, until the
    /// surface between them is straight or the vertex is in the overlap.
    #[cold]
    #[inline(never)]
    fn lowered(&self, object: usize, out: Vec2, mut v: Vec3) -> Vec3 {
        let depth = self.depth_over_slope * self.slope;
        for _ in 0..MAX_CHORDS {
            let reach = out.dot(&v.xy());
            let slope = v.z * depth / reach;
            // Negated for NaN.
            if !(v.z > MAX_DROP && reach > 2.0 * self.vertex_offset && slope < 0.999 * self.slope) {
                break;
            }
            let above = self.evaluate_at(object, out, slope);
            if !(out.dot(&above.xy()) - above.z * depth / slope > CORNER_SHIFT_REL * reach) {
                break;
            }
            if above.z < 1.0 {
                return above.lerp(&v, (1.0 - above.z) / (v.z - above.z));
            }
            v = above;
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::frame::ContactFrame;
    use crate::contact::outline::area2;
    use crate::minkowski::support::{MinkowskiDifference, SupportMap};
    use crate::test_shapes::{difference, hull};
    use core::cell::Cell;
    use core::f64::consts::TAU;

    const DEPTH: f64 = 1e-3;

    /// Returns the outline of a body as object 1, `DEPTH` below z = 0, from its deepest point `at`; and the number of its
    /// vertices that were evaluated.
    fn outline_of(body: impl SupportMap, at: Vec3, extent: f64) -> (Outline, Footprint, u64) {
        let calls = Cell::new(0);
        let counted = |n: &Vec3| {
            calls.set(calls.get() + 1);
            body.support(n)
        };
        let md: MinkowskiDifference<_, _> = difference(|_: &Vec3| Vec3::zeros(), counted);
        let frame = ContactFrame::new(&Vec3::z(), &(at + Vec3::z() * (0.5 * DEPTH)));
        let support = InclinedSupport::new(&md, frame, extent, [DEPTH; 2]);
        let mut outline = Outline::EMPTY;
        let footprint = support.find_outline(1, None, &mut outline).unwrap();
        (outline, footprint, calls.get())
    }

    /// Tests regular faces, all of whose corners are found for little more than one evaluation each.
    #[test]
    fn face_has_its_corners() {
        for n in 3..=8 {
            let corner = |k: usize, z: f64| {
                let (y, x) = (TAU * (k as f64 + 0.2) / n as f64).sin_cos();
                Vec3::new(0.1 * x, 0.1 * y, z)
            };
            let points: Vec<_> = (0..2 * n)
                .map(|k| corner(k, if k < n { -DEPTH } else { 0.2 }))
                .collect();
            let (outline, footprint, calls) = outline_of(hull(&points), Vec3::z() * -DEPTH, 0.1);
            assert_eq!((outline.len(), footprint), (n, Footprint::Area));
            assert!(calls <= n as u64 + 6, "{n}: {calls}");
        }
    }

    /// Tests a lying bar whose underside is a tenth as curved as its extent tells: the outline reaches from end to end, and is
    /// as wide as the overlap, within a quarter.
    #[test]
    fn outline_of_a_flat_bar_is_the_overlap() {
        let (wide, high, half) = (0.1, 0.01, 0.1);
        let bar = move |n: &Vec3| {
            let norm = (wide * n.x).hypot(high * n.z);
            Vec3::new(
                wide * wide * n.x / norm,
                half * n.y.signum(),
                high * high * n.z / norm + high - DEPTH,
            )
        };
        let (outline, footprint, _) = outline_of(bar, Vec3::new(0.0, 0.03, -DEPTH), 0.05);
        assert_eq!(footprint, Footprint::Area);
        let area: f64 = outline.sides().map(|(p, q)| 0.5 * area2(p, q)).sum();
        // Where the drop is the depth.
        let width = wide * (1.0 - (1.0 - DEPTH / high).powi(2)).sqrt();
        let ratio = area / (4.0 * half * width);
        assert!((ratio - 1.0).abs() < 0.25, "{ratio}");
    }

    #[test]
    fn corner_is_a_point() {
        let tip = |n: &Vec3| Vec3::z() * if n.z < 0.3 { -DEPTH } else { 1.0 };
        let (_, footprint, calls) = outline_of(tip, Vec3::z() * -DEPTH, 1.0);
        assert_eq!((footprint, calls), (Footprint::Point, 4));
    }
}
