// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the feature of an object in a contact: the vertices of its surface around the deepest point.
//!
//! The feature consists of the support vertices along all directions tilted from the normal n by T, n + T out for unit
//! `out` perpendicular to n: all corners of a face, the ends of an edge, points around the deepest one of a curved
//! surface. The *drop* of a vertex is its distance below the support plane, in units of the depth. Its *height* along
//! `out` is its component along n + T out, divided by T.
//!
//! 1. *Project* the known vertices of both objects into the contact frame, in one pass. obj2 is mirrored (−b for b), so
//!    that the normal points out of both objects and all later steps serve either.
//! 2. *Polytope or curved*: an object is taken for a polytope if two different directions returned the same vertex, and
//!    for curved otherwise; for the other if the queries contradict.
//! 3. *Polytope*: [`crate::contact::polygon_search`] finds its polygon.
//! 4. *Curved*: [`crate::contact::curved`] finds four or eight points.
//! 5. *Fan*: [`crate::contact::fan`] encloses the deepest point.
//!
//! Related: Bullet (`btConvexConvexAlgorithm`) and MuJoCo (`multiccd`) rotate an object by small angles and repeat
//! the whole query; here only the support function is evaluated along tilted normals. Errors are those of
//! `c-tests/tests/extension/pos.c`.

use crate::contact::fan::Fan;
use crate::contact::frame::ContactFrame;
use crate::contact::tuning::{MAX_KNOWN, MAX_TILT_TAN, POINT_REL, TILT_FACTOR, VERTEX_OFFSET_REL};
use crate::geometry::polygon::Vec2;
use crate::math::{EPSILON, Vec3, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::vertex_set::VertexSet;

/// Returns whether the distance of two vertices along each axis is at most `distance`.
#[inline(always)]
pub fn is_within(a: &Vec3, b: &Vec3, distance: f64) -> bool {
    larger((a.x - b.x).abs(), (a.y - b.y).abs()) <= distance
}

/// Returns unit `out` and the directions at right angles to it, counterclockwise.
#[inline(always)]
pub fn four_directions(out: Vec2) -> [Vec2; 4] {
    let left = Vec2::new(-out.y, out.x);
    [out, left, -out, -left]
}

/// The vertices of both objects that the same evaluated direction returned, in the contact frame.
#[derive(Clone, Copy)]
pub struct KnownPair {
    x: [f64; 2],
    y: [f64; 2],
    /// In depths.
    drop: [f64; 2],
    /// The tilt of the direction, tangents.
    pub tilt: [f64; 2],
}

impl KnownPair {
    /// Two vertices at the deepest point.
    pub const ZERO: Self = Self {
        x: [0.0; 2],
        y: [0.0; 2],
        drop: [0.0; 2],
        tilt: [0.0; 2],
    };

    /// Returns the vertex of an object.
    #[inline(always)]
    pub fn vertex(&self, object: usize) -> Vec3 {
        let k = object % 2;
        Vec3::new(self.x[k], self.y[k], self.drop[k])
    }
}

/// The projected known vertices of both objects of a contact, and queries of further ones.
pub struct FeatureQuery<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    pub frame: ContactFrame,
    pub known: &'q [KnownPair],
    /// The extreme known vertices of both objects, and which of them are polytopes.
    evidence: Evidence,
    /// x and y of the center of each object; 0 without centers.
    pub centers: [Vec2; 2],
    pub has_centers: bool,
    /// The object of smaller extent, as far as its vertices are known, 0 or 1.
    pub smaller: usize,
    /// Largest distance of its known vertices and center from the contact, metres.
    pub extent: f64,
    /// The reciprocal of the unit of drops, 1/metres.
    per_depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half_gap: f64,
    /// T, a tangent, and the cosine of that angle.
    pub tilt: f64,
    cosine: f64,
    /// Depth divided by T, metres.
    pub depth_over_tilt: f64,
    /// Distance by which vertices are moved outwards, and below which two are the same, metres.
    pub vertex_offset: f64,
}

impl<'q, A: SupportMap, B: SupportMap> FeatureQuery<'q, A, B> {
    /// Projects the known vertices and stores them in `known`. The frame's origin is midway between the support planes.
    /// `gap`: the distance of these, metres. `depth`: the larger of that and the tolerance, metres.
    #[inline(always)]
    pub fn new<const N: usize>(
        md: &'q MinkowskiDifference<A, B>,
        set: &'q VertexSet<N>,
        known: &'q mut [KnownPair; MAX_KNOWN],
        frame: ContactFrame,
        centers: Option<[Vec3; 2]>,
        [gap, depth]: [f64; 2],
    ) -> Self {
        let (half_gap, per_depth) = (0.5 * gap, 1.0 / depth);
        let (o, n, [e1, e2]) = (frame.origin, frame.normal, frame.axes);
        let origin = [[o.x, -o.x], [o.y, -o.y], [o.z, -o.z]];
        let mut far2 = [0.0; 2];
        let mut project = |[x, y, z]: [[f64; 2]; 3]| {
            let mut pair = KnownPair::ZERO;
            for k in 0..2 {
                let (x, y) = (x[k] - origin[0][k], y[k] - origin[1][k]);
                let z = z[k] - origin[2][k];
                far2[k] = larger(x * x + y * y + z * z, far2[k]);
                pair.x[k] = e1.x * x + e1.y * y + e1.z * z;
                pair.y[k] = e2.x * x + e2.y * y + e2.z * z;
                let height = n.x * x + n.y * y + n.z * z;
                pair.drop[k] = larger((half_gap - height) * per_depth, 0.0);
            }
            pair
        };
        let first_known = set.len().saturating_sub(MAX_KNOWN);
        let mut len = 0;
        for (coords, dir) in set.coords_from(first_known).zip(set.dirs_from(first_known)) {
            let pair = project(coords);
            // A point that no call returned has no direction.
            let cosine = n.dot(dir);
            if cosine > 0.0 {
                let tilt = [e1.dot(dir) / cosine, e2.dot(dir) / cosine];
                known[len % MAX_KNOWN] = KnownPair { tilt, ..pair };
                len += 1;
            }
        }
        let center = match &centers {
            Some([c1, c2]) => project([[c1.x, -c2.x], [c1.y, -c2.y], [c1.z, -c2.z]]),
            None => KnownPair::ZERO,
        };
        let smaller = usize::from(far2[1] < far2[0]);
        let extent = far2[smaller].sqrt();
        let tilt = lesser(TILT_FACTOR * (depth / extent).sqrt(), MAX_TILT_TAN);
        let depth_over_tilt = depth / tilt;
        let known = known.get(..len).unwrap_or(&[]);
        let rounding = 64.0 * EPSILON * extent;
        let vertex_offset = larger(depth * VERTEX_OFFSET_REL, rounding);
        let evidence = Evidence::new(known, depth_over_tilt, rounding);
        Self {
            md,
            frame,
            known,
            evidence,
            centers: [0, 1].map(|k| Vec2::new(center.x[k], center.y[k])),
            has_centers: centers.is_some(),
            smaller,
            extent,
            per_depth,
            half_gap,
            tilt,
            cosine: 1.0 / (1.0 + tilt * tilt).sqrt(),
            depth_over_tilt,
            vertex_offset,
        }
    }

    /// Returns the known vertices of an object with the greatest height along e1, e2, -e1 and -e2; the deepest point if
    /// none is known.
    #[inline(always)]
    pub fn extremes(&self, object: usize) -> [Vec3; 4] {
        self.evidence.farthest.map(|indices| {
            let pair = self.known.get(indices[object % 2]);
            pair.unwrap_or(&KnownPair::ZERO).vertex(object)
        })
    }

    /// Puts a queried vertex in the place of lower ones of [`FeatureQuery::extremes`].
    #[cold]
    #[inline(never)]
    pub fn raise_extremes(&self, extremes: &mut [Vec3; 4], v: &Vec3) {
        for (extreme, out) in extremes.iter_mut().zip(four_directions(Vec2::x())) {
            if self.height(v, &out) > self.height(extreme, &out) {
                *extreme = *v;
            }
        }
    }

    /// Evaluates an object along n + T `out`.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    pub fn query(&self, object: usize, out: Vec2) -> Result<Vec3, Fault> {
        let [e1, e2] = &self.frame.axes;
        let aside = (e1 * out.x + e2 * out.y) * (self.tilt * self.cosine);
        let dir = self.frame.normal * self.cosine + aside;
        let p = self.md.support_of_object(object, &dir);
        let p = self.frame.project(&p)? * if object == 0 { 1.0 } else { -1.0 };
        let drop = larger((self.half_gap - p.z) * self.per_depth, 0.0);
        Ok(Vec3::new(p.x, p.y, drop))
    }

    /// Returns the height of a vertex along n + T `out`, divided by T.
    #[inline(always)]
    pub fn height(&self, v: &Vec3, out: &Vec2) -> f64 {
        out.dot(&v.xy()) - v.z * self.depth_over_tilt
    }

    /// Finds the feature of an object and makes its fan. Returns false if the deepest point is the center of pressure:
    /// the feature is a point, or the fan has no area.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn build_fan(&self, object: usize, fan: &mut Fan) -> Result<bool, Fault> {
        let is_polytope = self.evidence.is_polytope[object % 2];
        let mut extremes = self.extremes(object);
        if !(is_polytope && self.find_polygon(object, &mut extremes, true, fan)?
            || self.find_curved(object, &mut extremes, fan)?)
        {
            self.find_polygon(object, &mut extremes, false, fan)?;
        }
        let [has_size, is_around] = fan.close(POINT_REL * self.extent);
        Ok(has_size && (is_around || fan.enclose_deepest_point(self.vertex_offset)))
    }
}

/// The extreme known vertices of both objects, and which of them are polytopes.
struct Evidence {
    /// The indices of the vertices of greatest height along e1, e2, -e1 and -e2.
    farthest: [[usize; 2]; 4],
    /// Whether different directions returned the same vertex, of which an object is taken for a polytope.
    is_polytope: [bool; 2],
}

impl Evidence {
    /// Compares each known vertex with the one before it and with the last. `same`: the distance up to which two are the
    /// same, metres.
    #[inline(always)]
    fn new(known: &[KnownPair], depth_over_tilt: f64, same: f64) -> Self {
        // The index of a vertex is in the low bits of its height, so that the maximum carries it.
        const MASK: u64 = MAX_KNOWN as u64 - 1;
        let mut best = [[f64::NEG_INFINITY; 2]; 4];
        let mut repeated = [0_u64; 2];
        let last = known.last().unwrap_or(&KnownPair::ZERO);
        let mut previous = last;
        for (i, v) in known.iter().enumerate() {
            let in_overlap = v.drop.map(|drop| u64::from(drop <= 1.0));
            for k in 0..2 {
                let fall = v.drop[k] * depth_over_tilt;
                let (x, y) = (v.x[k], v.y[k]);
                for (best, height) in
                    best.iter_mut()
                        .zip([x - fall, y - fall, -x - fall, -y - fall])
                {
                    let height = f64::from_bits(height.to_bits() & !MASK | i as u64);
                    best[k] = larger(height, best[k]);
                }
            }
            for w in [previous, last] {
                let is_other = u64::from(v.tilt != w.tilt);
                for (k, repeated) in repeated.iter_mut().enumerate() {
                    let distance = larger((v.x[k] - w.x[k]).abs(), (v.y[k] - w.y[k]).abs());
                    *repeated |= u64::from(distance <= same) & is_other & in_overlap[k];
                }
            }
            previous = v;
        }
        Self {
            farthest: best.map(|best| best.map(|height| (height.to_bits() & MASK) as usize)),
            is_polytope: repeated.map(|n| n > 0),
        }
    }
}
