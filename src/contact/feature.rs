// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Evaluates one object of a contact along directions tilted from the normal.
//!
//! The *drop* of a vertex is its distance below the support plane, in units of the depth. Its *height* along a unit
//! vector `out` perpendicular to the normal n is its component along n + T out, divided by T.
//!
//! obj2 is mirrored through the contact (−b for b), so that the normal points out of both objects and all later steps
//! serve either.

use crate::contact::frame::ContactFrame;
use crate::contact::tuning::{MAX_TILT_TAN, TILT_FACTOR, VERTEX_OFFSET_REL};
use crate::geometry::polygon::Vec2;
use crate::math::{EPSILON, Vec3, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::vertex_set::VertexSet;

/// Returns unit `out` and the directions at right angles to it, counterclockwise.
#[inline(always)]
pub fn four_directions(out: Vec2) -> [Vec2; 4] {
    let left = Vec2::new(-out.y, out.x);
    [out, left, -out, -left]
}

/// A contact of two objects: its frame, the tilt, and the evaluation of their vertices.
pub struct ContactQuery<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    pub frame: ContactFrame,
    /// The object of smaller extent, 0 or 1.
    pub smaller: usize,
    /// Its extent: the distance of its center from the contact, metres; without centers that of its
    /// farthest known vertex.
    pub extent: f64,
    /// The reciprocal of the unit of drops, 1/metres.
    per_depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half_gap: f64,
    /// T, a tangent, and the cosine of that angle.
    tilt: f64,
    cosine: f64,
    /// Depth divided by T, metres.
    pub depth_over_tilt: f64,
    /// Distance by which vertices are moved outwards, and below which two are the same, metres.
    pub vertex_offset: f64,
}

impl<'q, A: SupportMap, B: SupportMap> ContactQuery<'q, A, B> {
    /// Prepares the evaluation of a contact. The frame's origin is midway between the support planes. `extents`: of both
    /// objects. `gap`: the distance of the support planes, metres. `depth`: the larger of that and the tolerance, metres.
    #[inline(always)]
    pub fn new(
        md: &'q MinkowskiDifference<A, B>,
        frame: ContactFrame,
        extents: [f64; 2],
        [gap, depth]: [f64; 2],
    ) -> Self {
        let smaller = usize::from(extents[1] < extents[0]);
        let extent = extents[smaller];
        let tilt = lesser(TILT_FACTOR * (depth / extent).sqrt(), MAX_TILT_TAN);
        Self {
            md,
            frame,
            smaller,
            extent,
            per_depth: 1.0 / depth,
            half_gap: 0.5 * gap,
            tilt,
            cosine: 1.0 / (1.0 + tilt * tilt).sqrt(),
            depth_over_tilt: depth / tilt,
            vertex_offset: larger(depth * VERTEX_OFFSET_REL, 64.0 * EPSILON * extent),
        }
    }

    /// Evaluates an object along n + T `out`.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn evaluate(&self, object: usize, out: Vec2) -> Result<Vec3, Fault> {
        let [e1, e2] = &self.frame.axes;
        let aside = (e1 * out.x + e2 * out.y) * (self.tilt * self.cosine);
        let dir = self.frame.normal * self.cosine + aside;
        let p = self.md.support_of_object(object, &dir);
        let p = self.frame.project(&p)? * if object == 0 { 1.0 } else { -1.0 };
        Ok(Vec3::new(p.x, p.y, self.drop(p.z)))
    }

    /// Returns the height of a vertex along n + T `out`, divided by T.
    #[inline(always)]
    pub fn height(&self, v: &Vec3, out: &Vec2) -> f64 {
        out.dot(&v.xy()) - v.z * self.depth_over_tilt
    }

    /// Returns the drop of a point by its coordinate along the normal.
    #[inline(always)]
    fn drop(&self, z: f64) -> f64 {
        larger((self.half_gap - z) * self.per_depth, 0.0)
    }

    /// Returns the known vertices of an object from index `first` on.
    #[inline(always)]
    pub fn known<const N: usize>(
        &self,
        set: &'q VertexSet<N>,
        object: usize,
        first: usize,
    ) -> impl Iterator<Item = Vec3> + '_ {
        let k = object % 2;
        let sign = if k == 0 { 1.0 } else { -1.0 };
        let origin = self.frame.origin * sign;
        let ([e1, e2], n) = (self.frame.axes, self.frame.normal);
        set.coords_from(first).map(move |[x, y, z]| {
            let p = Vec3::new(x[k], y[k], z[k]) - origin;
            Vec3::new(e1.dot(&p), e2.dot(&p), self.drop(n.dot(&p)))
        })
    }
}
