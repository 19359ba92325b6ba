// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the polygon of an object in a contact: support vertices along directions n + T out, for unit `out` perpendicular
//! to the normal n ([`crate::contact::feature`]).
//!
//! 1. Evaluate four directions at right angles. Equal vertices are one corner.
//! 2. Estimate for each side how far a corner beyond it could move the centroid of the overlap. The corner is in the triangle
//!    between the side and the support lines of the directions that returned its ends; or it is on the side but higher than
//!    both, by what these directions allow. It is an estimate, because corners differ in their drops.
//! 3. Evaluate the side with the largest shift, along the direction in which both of its ends have the same height. A higher
//!    vertex is a new corner; otherwise the side is closed.
//! 4. End where no side could move the centroid by more than [`CORNER_SHIFT_REL`], or at [`MAX_CORNERS`].
//!
//! Of the larger object only what cuts the outline of the smaller one matters. It is a plane if vertices in its support plane
//! contain that outline.
//!
//! There are no classes of objects: a face, an edge and a corner are polygons of many corners, two and one, and a
//! curved outline is a polygon whose sides close early. All corners are vertices at the same tilt, so that they
//! do not depend on what was known before.

use crate::contact::feature::{ContactQuery, four_directions};
use crate::contact::frame::outwards;
use crate::contact::tuning::{COMMON_DROP_FACTOR, CORNER_SHIFT_REL, DROP_TOL, TILT_FACTOR};
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::support::{Fault, SupportMap};

/// Largest number of corners of a polygon.
pub const MAX_CORNERS: usize = 12;
/// Largest number of queries of a search: each corner is found once and each side closed once.
const MAX_QUERIES: usize = 2 * MAX_CORNERS;
/// Largest number of steps: a side may be limited once by the other outline before it is queried.
const MAX_STEPS: usize = 2 * MAX_QUERIES;
/// Least drop of both ends of a side, in depths, beyond which no corner is in the overlap: between two directions tilted by T
/// a surface whose radius is the extent rises by TILT_FACTOR² / 2 depths at most.
const MAX_SIDE_DROP: f64 = 1.0 + 0.5 * TILT_FACTOR * TILT_FACTOR;

/// A corner, and the side from it to the next one, counterclockwise.
#[derive(Clone, Copy, Default)]
pub struct Corner {
    pub at: Vec3,
    /// The first and the last direction, counterclockwise, that returned the corner.
    first: Vec2,
    last: Vec2,
    /// The direction out of the side.
    out: Vec2,
    /// By how much a corner beyond the side may be higher than its ends, at most, metres.
    gap: f64,
    /// By how much that corner could move the centroid, metres; not more than 0 if there is none.
    shift: f64,
    /// True if there is no corner beyond the side.
    is_closed: bool,
}

/// The corners found so far, counterclockwise.
pub type Corners = FixedVec<Corner, MAX_CORNERS>;

/// The overlap of a polygon with a plane.
#[derive(Clone, Copy)]
struct Overlap {
    /// Twice the volume, in depths, m².
    volume: f64,
    /// The sum of its vertices, and their number.
    sum: Vec2,
    count: f64,
    /// The drop that all corners have in common.
    common: f64,
}

/// What limits the search of the larger object.
pub struct Limit<'f> {
    /// The outline of the smaller object, mirrored, beyond which no corner matters.
    pub outline: &'f [Vec3],
    /// Vertices in the support plane, those farthest along the axes and their opposites.
    face: [Vec3; 4],
    /// Distance by which the outline may be outside of them, metres.
    slack: f64,
}

impl<'f> Limit<'f> {
    /// Makes the limit without vertices in the support plane.
    pub fn new(outline: &'f [Vec3], slack: f64) -> Self {
        Self {
            outline,
            face: [Vec3::zeros(); 4],
            slack,
        }
    }

    /// Adds a vertex if it is in the support plane.
    #[inline(always)]
    pub fn add(&mut self, v: &Vec3) {
        if v.z <= DROP_TOL {
            for (k, place) in self.face.iter_mut().enumerate() {
                let height = |p: &Vec3| if k % 2 == 0 { p.x } else { p.y };
                let is_farther = if k < 2 {
                    height(v) > height(place)
                } else {
                    height(v) < height(place)
                };
                *place = if is_farther { *v } else { *place };
            }
        }
    }

    /// Returns whether the vertices in the support plane contain the outline: then so does the face, which is convex.
    #[inline(always)]
    pub fn is_plane(&self) -> bool {
        let [a, b, c, d] = &self.face;
        let (first, second) = (offset(a, c), offset(b, d));
        // A quadrilateral without area contains nothing. Negated for NaN.
        let sum = first.x.abs() + first.y.abs() + second.x.abs() + second.y.abs();
        if !(first.perp(&second) > self.slack * sum) {
            return false;
        }
        for i in 0..4 {
            let corner = &self.face[i % 4];
            let side = offset(corner, &self.face[(i + 1) % 4]);
            let least = side.perp(&corner.xy()) - self.slack * (side.x.abs() + side.y.abs());
            for p in self.outline {
                // The other object's outline is mirrored. It is scaled where its drop exceeds the depth.
                if !(side.y * p.x - side.x * p.y >= least * larger(p.z, 1.0)) {
                    return false;
                }
            }
        }
        true
    }

    /// Returns how far the outline is beyond the side of a corner, metres; 0 if it is not.
    #[inline(always)]
    fn reach_beyond(&self, p: &Vec3, q: &Vec3) -> f64 {
        let side = offset(p, q);
        let level = p.xy().perp(&side);
        let length = side.norm();
        let mut most = self.slack * length;
        let least = most;
        for v in self.outline {
            most = larger(-v.xy().perp(&side) / larger(v.z, 1.0) - level, most);
        }
        if most > least { most / length } else { 0.0 }
    }
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
        corners: &mut Corners,
    ) -> Result<bool, Fault> {
        for out in four_directions(Vec2::x()) {
            let at = self.query(object, out)?;
            self.add_first(corners, at, out);
            if let Some(limit) = &mut limit {
                limit.add(&at);
                if limit.is_plane() {
                    return Ok(false);
                }
            }
        }
        if corners.len() < 2 {
            return Ok(true);
        }
        // That of the smaller object, mirrored.
        let limiting = limit
            .as_ref()
            .map(|limit| Overlap::of(limit.outline.iter(), 0.0));
        let mut own = Overlap::of([].iter(), 1.0);
        let mut overlap = own;
        let mut is_new = true;
        let tolerance = CORNER_SHIFT_REL * self.extent;
        for _ in 0..MAX_STEPS {
            if is_new {
                // The drop that all corners have in common has fallen.
                let least = corners.iter().fold(1.0, |least, c| lesser(c.at.z, least));
                own = Overlap::of(corners.iter().map(|c| &c.at), COMMON_DROP_FACTOR * least);
                overlap = own.limited(&limiting);
                for i in 0..corners.len() {
                    if !corners.cyclic(i).is_closed {
                        self.open_side(corners, i, &overlap);
                    }
                }
                is_new = false;
            }
            let (mut side, mut most) = (MAX_CORNERS, tolerance);
            for (i, corner) in corners.iter().enumerate() {
                (side, most) = if corner.shift > most {
                    (i, corner.shift)
                } else {
                    (side, most)
                };
            }
            if side == MAX_CORNERS {
                break;
            }
            let [p, q] = [side, side + 1].map(|i| corners.cyclic(i));
            let (from, to, out, gap) = (p.at, q.at, p.out, p.gap);
            // The overlap has grown since the estimate.
            let reach = limit
                .as_ref()
                .map_or(gap, |limit| lesser(limit.reach_beyond(&from, &to), gap));
            let shift = overlap.shift(&from, &to, reach, self.depth_over_tilt);
            if !(shift > tolerance) {
                corners.cyclic_mut(side).shift = shift;
                continue;
            }
            let at = self.query(object, out)?;
            let level = larger(self.height(&from, &out), self.height(&to, &out));
            if !(self.height(&at, &out) > level + 2.0 * self.vertex_offset) {
                (
                    corners.cyclic_mut(side).shift,
                    corners.cyclic_mut(side).is_closed,
                ) = (0.0, true);
                continue;
            }
            if corners.len() == MAX_CORNERS {
                break;
            }
            let new = Corner {
                at,
                first: out,
                last: out,
                ..Corner::default()
            };
            corners.insert(side + 1, new);
            is_new = COMMON_DROP_FACTOR * at.z < overlap.common;
            if !is_new {
                own.add(&from, &at, &to);
                overlap = own.limited(&limiting);
                self.open_side(corners, side, &overlap);
                self.open_side(corners, side + 1, &overlap);
            }
        }
        Ok(true)
    }

    /// Adds the vertex of one of the first directions, unless it is the last or the first corner.
    #[inline(always)]
    fn add_first(&self, corners: &mut Corners, at: Vec3, out: Vec2) {
        let is_same = |c: &Corner| {
            let distance = offset(&c.at, &at);
            larger(distance.x.abs(), distance.y.abs()) <= self.vertex_offset
        };
        if let Some(last) = corners.last_mut().filter(|c| is_same(c)) {
            last.last = out;
        } else if let Some(first) = corners.first_mut().filter(|c| is_same(c)) {
            first.first = out;
        } else {
            corners.push(Corner {
                at,
                first: out,
                last: out,
                ..Corner::default()
            });
        }
    }

    /// Prepares the search beyond a side.
    #[inline(always)]
    fn open_side(&self, corners: &mut Corners, i: usize, overlap: &Overlap) {
        let [p, q] = [i, i + 1].map(|i| corners.cyclic(i));
        let (out, gap) = self.gap_beyond(p, q);
        let shift = overlap.shift(&p.at, &q.at, gap, self.depth_over_tilt);
        let corner = corners.cyclic_mut(i);
        (corner.out, corner.gap, corner.shift) = (out, gap, shift);
    }

    /// Returns the direction out of a side, and by how much a corner beyond it may be higher than its ends, at most.
    #[inline(always)]
    fn gap_beyond(&self, p: &Corner, q: &Corner) -> (Vec2, f64) {
        let out = outwards(&p.at, &q.at, self.depth_over_tilt, 0.0);
        let length = offset(&p.at, &q.at).norm();
        // Negated for NaN.
        if !(length > self.vertex_offset && lesser(p.at.z, q.at.z) < MAX_SIDE_DROP) {
            return (out, 0.0);
        }
        // By how much each end is higher along its direction than the other one.
        let rise_p = self.height(&p.at, &p.last) - self.height(&q.at, &p.last);
        let rise_q = self.height(&q.at, &q.first) - self.height(&p.at, &q.first);
        // turn · out = α last + β first.
        let turn = p.last.perp(&q.first);
        let (alpha, beta) = (out.perp(&q.first), p.last.perp(&out));
        let rise = 0.5 * (alpha * larger(rise_p, 0.0) + beta * larger(rise_q, 0.0));
        let is_bounded = rise < turn * length && alpha >= 0.0 && beta >= 0.0;
        (out, if is_bounded { rise / turn } else { length })
    }
}

impl Overlap {
    /// Returns the overlap of a polygon, without the common drop.
    #[inline(always)]
    fn of<'v>(polygon: impl Iterator<Item = &'v Vec3> + Clone, common: f64) -> Self {
        let mut overlap = Self {
            volume: 0.0,
            sum: Vec2::zeros(),
            count: 0.0,
            common,
        };
        let mut last = in_overlap(polygon.clone().last().unwrap_or(&Vec3::zeros()), common);
        for v in polygon {
            let v = in_overlap(v, common);
            overlap.volume += volume_of(&last, &v);
            overlap.sum += v.xy();
            overlap.count += 1.0;
            last = v;
        }
        overlap.volume = overlap.volume.abs();
        overlap
    }

    /// Returns the overlap with the other object's, which is mirrored: the one of less volume.
    #[inline(always)]
    fn limited(&self, limiting: &Option<Self>) -> Self {
        match limiting {
            Some(limiting) if limiting.volume < self.volume => Self {
                sum: -limiting.sum,
                common: self.common,
                ..*limiting
            },
            _ => *self,
        }
    }

    /// Adds a corner beyond a side.
    #[inline(always)]
    fn add(&mut self, from: &Vec3, at: &Vec3, to: &Vec3) {
        let [from, at, to] = [from, at, to].map(|v| in_overlap(v, self.common));
        self.volume += volume_of(&from, &at) + volume_of(&at, &to) - volume_of(&from, &to);
        self.sum += at.xy();
        self.count += 1.0;
    }

    /// Estimates by how far a corner beyond a side could move the centroid: by its area, or by being above the interpolated
    /// surface, by more than the common drop.
    #[inline(always)]
    fn shift(&self, p: &Vec3, q: &Vec3, gap: f64, depth_over_tilt: f64) -> f64 {
        let [a, b] = [p, q].map(|v| in_overlap(v, self.common));
        let drop = 0.5 * (p.z + q.z) - self.common;
        let raised = lesser(larger(gap / depth_over_tilt - self.common, 0.0), drop);
        let gain = larger(1.0 - drop + raised, 0.0) - larger(1.0 - drop, 0.0);
        let length = offset(&a, &b).norm();
        let beyond = length * gap * (1.0 - lesser(a.z, b.z)) / larger(drop, 1.0);
        let above = a.xy().perp(&b.xy()).abs() * gain * (1.0 / 3.0);
        let missing = larger(beyond, above);
        // The corner may be beyond either end.
        let lever = ((a.xy() + b.xy()) * 0.5 - self.sum / self.count).norm() + length * (1.0 / 6.0);
        missing * lever / (self.volume + missing)
    }
}

/// Returns twice the volume over the triangle of the deepest point and two vertices, in depths.
#[inline(always)]
pub fn volume_of(a: &Vec3, b: &Vec3) -> f64 {
    a.xy().perp(&b.xy()) * (1.0 - (a.z + b.z) * (1.0 / 3.0))
}

/// Returns a vertex without the common drop, and at the end of the overlap if it is beyond it.
#[inline(always)]
pub fn in_overlap(v: &Vec3, common: f64) -> Vec3 {
    let z = larger(v.z - common, 0.0);
    if z <= 1.0 {
        return Vec3::new(v.x, v.y, z);
    }
    let scale = 1.0 / z;
    Vec3::new(v.x * scale, v.y * scale, 1.0)
}
