// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Evaluates one object of a contact along directions inclined from its outward normal.
//!
//! Points are given by their coordinates along the frame's axes, from the deepest point, and their *drop*: the distance
//! below the object's support plane, in units of the depth. The *height* of a point along a unit vector `out` of the
//! contact plane is its component along the inclined direction, divided by the slope.

use crate::contact::frame::ContactFrame;
use crate::contact::tuning::{
    COMMON_DROP_FACTOR, DROP_TOL, MAX_SLOPE, SLOPE_FACTOR, VERTEX_OFFSET_REL,
};
use crate::geometry::polygon::Vec2;
use crate::math::{EPSILON, Vec3, larger, lesser};
use crate::minkowski::support::{Difference, Fault};
use crate::minkowski::vertex_set::VertexSet;
use core::cell::Cell;

/// The objects of a contact, evaluated along inclined directions.
pub struct InclinedSupport<'q, D> {
    md: &'q D,
    pub frame: ContactFrame,
    /// The smaller object's extent: the distance of its center from the contact, metres; without centers that of its
    /// farthest known vertex.
    pub extent: f64,
    /// The reciprocal of the unit of drops, 1/metres.
    per_depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half_overlap: f64,
    /// T, a tangent.
    pub slope: f64,
    /// The components along the normal and the axes of a unit direction of slope T.
    normal: Vec3,
    axes: [Vec3; 2],
    /// The unit of drops over T, metres.
    pub depth_over_slope: f64,
    /// Distance by which vertices are moved outwards, and below which two are the same, metres.
    pub vertex_offset: f64,
    /// The sum of all evaluated points' distances from the origin, to the fourth power.
    squares: Cell<f64>,
    /// The least drop of the object's vertices that were evaluated, at most 1. A point on a chord between two of them is none:
    /// it has a drop of one depth beside a face too.
    pub least_drop: Cell<f64>,
}

impl<'q, D: Difference> InclinedSupport<'q, D> {
    /// Prepares the evaluation. The frame's origin is midway between the support planes. `extent`: of the smaller object.
    /// `overlap`: the distance of the support planes, metres. `depth`: the larger of that and the tolerance, metres.
    #[inline(always)]
    pub fn new(md: &'q D, frame: ContactFrame, extent: f64, [overlap, depth]: [f64; 2]) -> Self {
        let slope = lesser(SLOPE_FACTOR * (depth / extent).sqrt(), MAX_SLOPE);
        let cosine = cosine(slope);
        Self {
            md,
            frame,
            extent,
            per_depth: 1.0 / depth,
            half_overlap: 0.5 * overlap,
            slope,
            normal: frame.normal * cosine,
            axes: frame.axes.map(|axis| axis * (slope * cosine)),
            depth_over_slope: depth / slope,
            vertex_offset: larger(depth * VERTEX_OFFSET_REL, 64.0 * EPSILON * extent),
            squares: Cell::new(0.0),
            least_drop: Cell::new(1.0),
        }
    }

    /// Evaluates an object along its outward normal inclined by T towards an axis, 0 or 1, or its opposite, 2 or 3.
    #[inline(always)]
    pub fn evaluate_along_axis(&self, object: usize, axis: usize) -> Vec3 {
        let sign = if axis < 2 { 1.0 } else { -1.0 };
        self.vertex_along(object, self.normal, self.axes[axis % 2] * sign)
    }

    /// Evaluates an object along its outward normal inclined by T towards unit `out`.
    #[inline(always)]
    pub fn evaluate(&self, object: usize, out: Vec2) -> Vec3 {
        let aside = self.axes[0] * out.x + self.axes[1] * out.y;
        self.vertex_along(object, self.normal, aside)
    }

    /// Evaluates an object along its outward normal inclined by `slope`, a tangent, towards unit `out`.
    #[inline(always)]
    pub fn evaluate_at(&self, object: usize, out: Vec2, slope: f64) -> Vec3 {
        let cosine = cosine(slope);
        let axes = &self.frame.axes;
        let aside = (axes[0] * out.x + axes[1] * out.y) * (slope * cosine);
        self.vertex_along(object, self.frame.normal * cosine, aside)
    }

    /// Evaluates an object along a direction with these components across and in the contact plane.
    #[inline(always)]
    fn vertex_along(&self, object: usize, across: Vec3, aside: Vec3) -> Vec3 {
        // Directions are those of obj1; obj2 is evaluated along their opposites.
        let sign = if object == 0 { 1.0 } else { -1.0 };
        let p = self.md.support_of_object(object, &(across + aside * sign)) - self.frame.origin;
        let square = p.norm_squared();
        self.squares.set(self.squares.get() + square * square);
        let [e1, e2] = &self.frame.axes;
        let drop = (self.half_overlap - self.frame.normal.dot(&p) * sign) * self.per_depth;
        let drop = larger(drop, 0.0);
        self.least_drop.set(lesser(drop, self.least_drop.get()));
        Vec3::new(e1.dot(&p), e2.dot(&p), drop)
    }

    /// Returns the drop that the vertices of an object have in common, in depths.
    #[inline(always)]
    pub fn common_drop(&self) -> f64 {
        COMMON_DROP_FACTOR * self.least_drop.get()
    }

    /// Returns an error if a point that was evaluated is not finite, or so far away that squares of squares overflow.
    #[inline(always)]
    pub fn validate(&self) -> Result<(), Fault> {
        // Fails for NaN too.
        match self.squares.get().is_finite() {
            true => Ok(()),
            false => Err(Fault::NonFinite),
        }
    }

    /// Returns the height of a point along `out` at the slope T, metres.
    #[inline(always)]
    pub fn height(&self, v: &Vec3, out: &Vec2) -> f64 {
        out.dot(&v.xy()) - v.z * self.depth_over_slope
    }

    /// Calls `f` with the known vertices of an object in its support plane.
    #[inline(always)]
    pub fn for_each_flat<const N: usize>(
        &self,
        set: &VertexSet<N>,
        object: usize,
        mut f: impl FnMut(Vec2),
    ) {
        // The set has the vertices of obj2 with the opposite sign.
        let k = object % 2;
        let sign = if k == 0 { 1.0 } else { -1.0 };
        let origin = self.frame.origin * sign;
        let ([e1, e2], n) = (self.frame.axes.map(|axis| axis * sign), self.frame.normal);
        let least = n.dot(&origin) + self.half_overlap - DROP_TOL / self.per_depth;
        for [x, y, z] in set.all_coords() {
            let p = Vec3::new(x[k], y[k], z[k]);
            if n.dot(&p) >= least {
                let p = p - origin;
                f(Vec2::new(e1.dot(&p), e2.dot(&p)));
            }
        }
    }
}

/// Returns the cosine of an angle by its tangent.
#[inline(always)]
fn cosine(tangent: f64) -> f64 {
    1.0 / (1.0 + tangent * tangent).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Random, ball, corners, difference, hull};

    /// Tests that an object has the same vertices as obj1 and as obj2 of the swapped pair.
    #[test]
    fn swapped_objects_have_the_same_vertices() {
        let mut r = Random::new(3);
        let points = corners(Vec3::new(0.1, 0.2, 0.3));
        for _ in 0..100 {
            let (n, at) = (r.direction(), r.vector(0.1));
            let md = difference(hull(&points), ball(Vec3::zeros(), 0.2));
            let swapped = difference(ball(Vec3::zeros(), 0.2), hull(&points));
            let frame = |n| ContactFrame::new(&n, &at);
            let one = InclinedSupport::new(&md, frame(n), 0.3, [0.01; 2]);
            let two = InclinedSupport::new(&swapped, frame(-n), 0.3, [0.01; 2]);
            let out = Vec2::new(0.6, -0.8);
            assert_eq!(one.evaluate(0, out), two.evaluate(1, out));
            for axis in 0..4 {
                let [a, b] = [
                    one.evaluate_along_axis(0, axis),
                    two.evaluate_along_axis(1, axis),
                ];
                assert_eq!(a, b);
            }
            let lowered = [one.evaluate_at(0, out, 0.01), two.evaluate_at(1, out, 0.01)];
            assert_eq!(lowered[0], lowered[1]);
        }
    }
}
