// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the polygon of an object in a contact: support vertices along directions n + T out, for unit `out` perpendicular
//! to the normal n ([`crate::contact::feature`]).
//!
//! 1. Evaluate four directions at right angles. Equal vertices are one corner.
//! 2. Estimate for each side how far a corner beyond it could move the centroid of the overlap. The corner is in the triangle
//!    between the side and the support lines of the directions that returned its ends; or it is on the side but higher than
//!    both, by what these directions allow. It is an estimate, because corners differ in their drops.
//! 3. Go around the sides. Where the shift is more than [`CORNER_SHIFT_REL`], evaluate the direction in which both ends have
//!    the same height. A vertex that is higher and enlarges the overlap is a new corner; otherwise the side is closed.
//! 4. End after a round without a new corner, or at [`MAX_POLYGON_CORNERS`].
//!
//! A round takes the sides in the order in which they were found, not the one with the largest shift first: those of a disc
//! are all alike, and their rounding errors would choose which of them still become corners.
//!
//! Of the larger object only what cuts the outline of the smaller one matters. It is a plane if vertices in its support plane
//! contain that outline.
//!
//! There are no classes of objects: a face, an edge and a corner are polygons of many corners, two and one, and a
//! curved outline is a polygon whose sides close early. All corners are vertices at the same tilt, so that they
//! do not depend on what was known before.

use crate::contact::feature::{ContactQuery, four_directions};
use crate::contact::frame::outwards;
use crate::contact::limit::Limit;
use crate::contact::overlap::{
    ContactPolygon, MAX_POLYGON_CORNERS, Overlap, in_overlap, volume_beyond, volume_of,
};
use crate::contact::tuning::{COMMON_DROP_FACTOR, CORNER_SHIFT_REL, LEAST_GROWTH, TILT_FACTOR};
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::support::{Fault, SupportMap};

/// Largest number of rounds: each but the last finds a corner.
const MAX_ROUNDS: usize = MAX_POLYGON_CORNERS;
/// Least drop of both ends of a side, in depths, beyond which no corner is in the overlap: between two directions tilted by T
/// a surface whose radius is the extent rises by TILT_FACTOR² / 2 depths at most.
const MAX_SIDE_DROP: f64 = 1.0 + 0.5 * TILT_FACTOR * TILT_FACTOR;

/// A corner, and the side from it to the next one, counterclockwise.
#[derive(Clone, Copy, Default)]
struct Corner {
    at: Vec3,
    /// The same in the overlap ([`in_overlap`]).
    inside: Vec3,
    /// The first and the last direction, counterclockwise, that returned the corner.
    first: Vec2,
    last: Vec2,
    /// The direction out of the side.
    out: Vec2,
    /// By how much a corner beyond the side may be higher than its ends, at most, metres; 0 if there is none.
    gap: f64,
    /// The index of the next corner.
    next: usize,
}

/// The corners found so far, in the order of finding; `next` is their order around the polygon.
struct Found {
    corners: FixedVec<Corner, MAX_POLYGON_CORNERS>,
    /// The drop that all corners have in common.
    common: f64,
    /// The overlap of the polygon with a plane.
    own: Overlap,
}

impl<A: SupportMap, B: SupportMap> ContactQuery<'_, A, B> {
    /// Finds the polygon of an object. Returns false if the object is a plane within the limit.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn find_polygon(
        &self,
        object: usize,
        mut limit: Option<&mut Limit>,
        corners: &mut ContactPolygon,
    ) -> Result<bool, Fault> {
        let mut found = Found {
            corners: FixedVec::default(),
            common: 1.0,
            own: Overlap::EMPTY,
        };
        for out in four_directions(Vec2::x()) {
            let at = self.evaluate(object, out)?;
            found.add_first(at, out, self.vertex_offset);
            if let Some(limit) = &mut limit {
                if limit.add(&at) && limit.is_plane() {
                    return Ok(false);
                }
            }
        }
        if found.corners.len() > 1 {
            self.search_sides(object, limit.as_deref(), &mut found)?;
        }
        found.write_to(corners);
        Ok(true)
    }

    /// Searches beyond the sides in rounds, until a round finds no corner.
    #[inline(always)]
    fn search_sides(
        &self,
        object: usize,
        limit: Option<&Limit>,
        found: &mut Found,
    ) -> Result<(), Fault> {
        for i in 0..found.corners.len() {
            self.open_side(found, i);
        }
        found.set_common_drop();
        let mut overlap = found.own.limited(limit);
        for _ in 0..MAX_ROUNDS {
            let count = found.corners.len();
            for side in 0..count {
                let p = found.corners.at(side);
                let q = found.corners.at(p.next);
                if !self.matters(p, q, limit, found.common, &overlap) {
                    continue;
                }
                let out = p.out;
                let at = self.evaluate(object, out)?;
                let level = larger(self.height(&p.at, &out), self.height(&q.at, &out));
                let inside = in_overlap(&at, found.common);
                let volume = volume_beyond(&p.inside, &inside, &q.inside);
                if !(self.height(&at, &out) > level + 2.0 * self.vertex_offset
                    && volume.abs() > LEAST_GROWTH * overlap.volume.abs())
                {
                    found.corners.at_mut(side).gap = 0.0;
                    continue;
                }
                let new = found.corners.len();
                if new == MAX_POLYGON_CORNERS {
                    return Ok(());
                }
                found.insert(side, at, inside, out);
                self.open_side(found, side);
                self.open_side(found, new);
                if COMMON_DROP_FACTOR * at.z < found.common {
                    found.set_common_drop();
                } else {
                    found.own.add(volume, &inside);
                }
                overlap = found.own.limited(limit);
            }
            if found.corners.len() == count {
                break;
            }
        }
        Ok(())
    }

    /// Returns whether a corner beyond a side could move the centroid, within the limit.
    #[inline(always)]
    fn matters(
        &self,
        p: &Corner,
        q: &Corner,
        limit: Option<&Limit>,
        common: f64,
        overlap: &Overlap,
    ) -> bool {
        let gap = match limit {
            Some(limit) if p.gap > 0.0 => lesser(limit.reach_beyond(&p.at, &q.at), p.gap),
            _ => p.gap,
        };
        gap > 0.0
            && shift(overlap, [p, q], gap, common, self.depth_over_tilt)
                > CORNER_SHIFT_REL * self.extent
    }

    /// Finds the direction out of a side, and by how much a corner beyond it may be higher than its ends, at most.
    #[inline(always)]
    fn open_side(&self, found: &mut Found, i: usize) {
        let p = found.corners.at(i);
        let q = found.corners.at(p.next);
        let out = outwards(&p.at, &q.at, self.depth_over_tilt, 0.0);
        let gap = self.gap_beyond(p, q, out);
        let side = found.corners.at_mut(i);
        (side.out, side.gap) = (out, gap);
    }

    /// Returns by how much a corner beyond a side may be higher than its ends along `out`, at most.
    #[inline(always)]
    fn gap_beyond(&self, p: &Corner, q: &Corner, out: Vec2) -> f64 {
        let length = offset(&p.at, &q.at).norm();
        // Negated for NaN.
        if !(length > self.vertex_offset && lesser(p.at.z, q.at.z) < MAX_SIDE_DROP) {
            return 0.0;
        }
        // By how much each end is higher along its direction than the other one.
        let rise_p = self.height(&p.at, &p.last) - self.height(&q.at, &p.last);
        let rise_q = self.height(&q.at, &q.first) - self.height(&p.at, &q.first);
        // turn · out = α last + β first.
        let turn = p.last.perp(&q.first);
        let (alpha, beta) = (out.perp(&q.first), p.last.perp(&out));
        let rise = 0.5 * (alpha * larger(rise_p, 0.0) + beta * larger(rise_q, 0.0));
        let is_bounded = rise < turn * length && alpha >= 0.0 && beta >= 0.0;
        if is_bounded { rise / turn } else { length }
    }
}

impl Found {
    /// Adds the vertex of one of the first directions, unless it is the last or the first corner.
    #[inline(always)]
    fn add_first(&mut self, at: Vec3, out: Vec2, vertex_offset: f64) {
        let is_same = |c: &Corner| {
            let distance = offset(&c.at, &at);
            larger(distance.x.abs(), distance.y.abs()) <= vertex_offset
        };
        if let Some(last) = self.corners.last_mut().filter(|c| is_same(c)) {
            last.last = out;
        } else if let Some(first) = self.corners.first_mut().filter(|c| is_same(c)) {
            first.first = out;
        } else {
            self.append(at, out, 0);
        }
    }

    /// Appends a corner, after the last one found.
    #[inline(always)]
    fn append(&mut self, at: Vec3, out: Vec2, next: usize) {
        let end = self.corners.len();
        if let Some(last) = self.corners.last_mut() {
            last.next = end;
        }
        self.corners.push(Corner {
            at,
            first: out,
            last: out,
            next,
            ..Corner::default()
        });
    }

    /// Inserts a corner into a side.
    #[inline(always)]
    fn insert(&mut self, side: usize, at: Vec3, inside: Vec3, out: Vec2) {
        let new = self.corners.len();
        let from = self.corners.at_mut(side);
        let next = core::mem::replace(&mut from.next, new);
        self.corners.push(Corner {
            at,
            inside,
            first: out,
            last: out,
            next,
            ..Corner::default()
        });
    }

    /// Sets the drop that all corners have in common, and the overlap.
    #[inline(always)]
    fn set_common_drop(&mut self) {
        let least = |least, c: &Corner| lesser(c.at.z, least);
        self.common = COMMON_DROP_FACTOR * self.corners.iter().fold(1.0, least);
        for c in self.corners.iter_mut() {
            c.inside = in_overlap(&c.at, self.common);
        }
        self.own = Overlap::EMPTY;
        for p in self.corners.iter() {
            let q = &self.corners.at(p.next).inside;
            self.own.add(volume_of(&p.inside, q), q);
        }
    }

    /// Writes the corners, counterclockwise.
    #[inline(always)]
    fn write_to(&self, corners: &mut ContactPolygon) {
        let mut i = 0;
        for _ in 0..self.corners.len() {
            let c = self.corners.at(i);
            corners.push(c.at);
            i = c.next;
        }
    }
}

/// Estimates by how far a corner beyond a side could move the centroid: by its area, or by being above the interpolated
/// surface, by more than the common drop.
#[inline(always)]
fn shift(
    overlap: &Overlap,
    [p, q]: [&Corner; 2],
    gap: f64,
    common: f64,
    depth_over_tilt: f64,
) -> f64 {
    let (a, b) = (&p.inside, &q.inside);
    let drop = 0.5 * (p.at.z + q.at.z) - common;
    let raised = lesser(larger(gap / depth_over_tilt - common, 0.0), drop);
    let gain = larger(1.0 - drop + raised, 0.0) - larger(1.0 - drop, 0.0);
    let length = offset(a, b).norm();
    let beyond = length * gap * (1.0 - lesser(a.z, b.z)) / larger(drop, 1.0);
    let above = a.xy().perp(&b.xy()).abs() * gain * (1.0 / 3.0);
    let missing = larger(beyond, above);
    // The corner may be beyond either end.
    let lever =
        ((a.xy() + b.xy()) * 0.5 - overlap.sum / overlap.count).norm() + length * (1.0 / 6.0);
    missing * lever / (overlap.volume.abs() + missing)
}
