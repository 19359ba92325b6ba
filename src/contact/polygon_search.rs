// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the polygon of a polytope in a contact: the corners of a face, the ends of an edge, or a corner.
//!
//! It begins with the evaluated vertices of greatest height along ±e1 and ±e2. Beyond each side the direction is evaluated
//! along which both of its ends have the same height, until no side has a corner beyond it; so the polygon is the same
//! whatever was known. If four corners are a parallelogram and its longest side has no corner beyond it, neither has any
//! other. A corner and an edge are known if evaluated directions around them returned them.
//!
//! A known vertex below the overlap may not be that of greatest height (on the rim of a cone on its side it is far from it):
//! a query replaces it as the end of an edge, before the sides of that edge are searched.

use crate::contact::fan::{Fan, moved};
use crate::contact::feature::{FeatureQuery, KnownPair, four_directions, is_within};
use crate::contact::frame::outwards;
use crate::contact::tuning::{DROP_TOL, MIN_COVER, POINT_REL, TILT_FACTOR};
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::support::{Fault, SupportMap};

/// Largest number of corners of a polygon.
pub const MAX_CORNERS: usize = 10;
/// Largest number of steps of its search: each corner is found once and each side closed once.
const MAX_STEPS: usize = 2 * MAX_CORNERS + 4;
/// Least drop of both ends of a side, in depths, beyond which no corner is in the overlap: between two directions tilted by T
/// a surface whose radius is the extent rises by TILT_FACTOR² / 2 depths at most.
const MAX_SIDE_DROP: f64 = 1.0 + 0.5 * TILT_FACTOR * TILT_FACTOR;

impl<A: SupportMap, B: SupportMap> FeatureQuery<'_, A, B> {
    /// Finds the polygon of a polytope and makes its fan. Returns false if `may_fail` and the first two queries return
    /// new vertices: two directions in a plane with a disc's axis return the same rim point, so a vertex returned twice
    /// does not prove a polytope. `extremes` then has the corners found too.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn find_polygon(
        &self,
        object: usize,
        extremes: &mut [Vec3; 4],
        may_fail: bool,
        fan: &mut Fan,
    ) -> Result<bool, Fault> {
        let same = self.vertex_offset;
        let mut polygon = Polygon::default();
        for v in extremes.iter() {
            polygon.push_distinct(v, same);
        }
        for i in 0..polygon.len {
            polygon.open(i);
        }
        let least_side = POINT_REL * self.extent;
        // The number of directions done around a corner or an edge, and that of queries that returned known vertices
        // and new ones.
        let (mut step, mut hits, mut misses) = (0, 0, 0);
        for _ in 0..MAX_STEPS {
            let n = polygon.len;
            let Some((side, out)) = self.next_direction(&polygon, step, least_side) else {
                break;
            };
            let ends = polygon.side(side);
            let [p, q] = ends.map(|end| self.height(end, &out));
            let least = larger(p, q) + 2.0 * self.vertex_offset;
            let mut found = None;
            let is_side = n > 2 || n == 2 && step >= 2;
            let is_covered = may_fail && n < 3 && self.is_covered(object, out, ends);
            if !is_covered {
                let v = self.query(object, out)?;
                if self.height(&v, &out) > least {
                    (found, misses) = (Some(v), misses + 1);
                } else {
                    hits += 1;
                }
                if may_fail && n < 3 && hits == 0 && misses == 2 {
                    let corners = polygon.corners.iter().take(n);
                    corners
                        .chain([&v])
                        .for_each(|v| self.raise_extremes(extremes, v));
                    return Ok(false);
                }
            }
            step += 1;
            match found {
                None => {
                    if is_side && !is_covered {
                        polygon.open_length2[side % MAX_CORNERS] = 0.0;
                    }
                    if n == 4 && polygon.is_parallelogram(POINT_REL * self.extent) {
                        break;
                    }
                }
                // Beyond an end of an edge.
                Some(v) if !is_side && n == 2 => {
                    polygon.corners[usize::from(step == 1)] = v;
                    polygon.open(0);
                    polygon.open(1);
                    step = 0;
                }
                Some(v) => {
                    polygon.insert(side, &v);
                    step = 0;
                }
            }
        }
        polygon.write_fan(fan, self.vertex_offset);
        Ok(true)
    }

    /// Returns the side of a polygon beyond which a corner is to be searched next, and the direction; None if the polygon
    /// is complete. Around a corner, directions are the axes; around an edge those beyond both ends and then to both sides.
    #[inline(always)]
    fn next_direction(
        &self,
        polygon: &Polygon,
        step: usize,
        least_side: f64,
    ) -> Option<(usize, Vec2)> {
        let out_of = |side: usize| {
            let [p, q] = polygon.side(side);
            Some((side, outwards(p, q, self.depth_over_tilt, 0.0)))
        };
        match (polygon.len, step) {
            (1, 0..4) => Some((0, four_directions(Vec2::x())[step])),
            (2, 0..2) => {
                let [p, q] = polygon.side(step);
                let along = offset(p, q);
                Some((0, along * (1.0 / along.norm())))
            }
            (2, 2..4) => out_of(step - 2),
            (0..3 | MAX_CORNERS, _) => None,
            _ => {
                let side = polygon.longest_open_side(least_side * least_side)?;
                out_of(side)
            }
        }
    }

    /// Returns whether an evaluated direction tilted towards `out`, within 27° of it, returned one of two vertices, in the
    /// overlap. (The directions that return a vertex form a convex set, which mostly contains the normal.)
    #[inline(always)]
    fn is_covered(&self, object: usize, out: Vec2, ends: [&Vec3; 2]) -> bool {
        let same = self.vertex_offset;
        let is_end = |v: &Vec3| v.z <= 1.0 && ends.iter().any(|end| is_within(v, end, same));
        let is_cover = |pair: &KnownPair| {
            let tilt = Vec2::from(pair.tilt);
            let towards = tilt.dot(&out) - 2.0 * tilt.perp(&out).abs();
            towards >= MIN_COVER * self.tilt && is_end(&pair.vertex(object))
        };
        self.known.iter().any(is_cover)
    }
}

/// The corners of a polytope found so far, counterclockwise.
#[derive(Default)]
struct Polygon {
    corners: [Vec3; MAX_CORNERS],
    /// The square of the length of the side from each corner to the next, m²; 0 if there is no corner beyond it.
    open_length2: [f64; MAX_CORNERS],
    len: usize,
}

impl Polygon {
    /// Appends a corner unless it is the last or the first one.
    #[inline(always)]
    fn push_distinct(&mut self, v: &Vec3, same: f64) {
        let n = self.len % MAX_CORNERS;
        let last = n.saturating_sub(1);
        let is_old =
            is_within(v, &self.corners[last], same) || is_within(v, &self.corners[0], same);
        if n == 0 || !is_old {
            self.corners[n] = *v;
            self.len = n + 1;
        }
    }

    /// Returns the ends of side `i`, modulo the number of corners, for `i` below twice that.
    #[inline(always)]
    fn side(&self, i: usize) -> [&Vec3; 2] {
        let i = if i < self.len { i } else { i - self.len };
        let next = if i + 1 < self.len { i + 1 } else { 0 };
        [i, next].map(|i| &self.corners[i.min(MAX_CORNERS - 1)])
    }

    /// Marks a side as one beyond which a corner may be.
    #[inline(always)]
    fn open(&mut self, i: usize) {
        let [p, q] = self.side(i);
        let may_matter = f64::from(u8::from(lesser(p.z, q.z) < MAX_SIDE_DROP));
        let length2 = offset(p, q).norm_squared() * may_matter;
        self.open_length2[i % MAX_CORNERS] = length2;
    }

    /// Returns the longest open side that is longer than the root of `least2`.
    #[inline(always)]
    fn longest_open_side(&self, least2: f64) -> Option<usize> {
        // The index of a side is in the low bits of its length, so that the maximum carries it.
        const MASK: u64 = MAX_CORNERS.next_power_of_two() as u64 - 1;
        let mut longest = least2.to_bits() | MASK;
        for (i, length2) in self.open_length2.iter().take(self.len).enumerate() {
            longest = longest.max(length2.to_bits() & !MASK | i as u64);
        }
        let i = (longest & MASK) as usize;
        (i < MAX_CORNERS).then_some(i)
    }

    /// Inserts a corner beyond a side.
    #[inline(always)]
    fn insert(&mut self, side: usize, v: &Vec3) {
        let mut i = self.len.min(MAX_CORNERS - 1);
        while i > side + 1 {
            self.corners[i] = self.corners[i - 1];
            self.open_length2[i] = self.open_length2[i - 1];
            i -= 1;
        }
        self.corners[i] = *v;
        self.len += 1;
        self.open(side);
        self.open(i);
    }

    /// Returns whether four corners are a parallelogram, in space too.
    #[inline(always)]
    fn is_parallelogram(&self, tolerance: f64) -> bool {
        let [a, b, c, d, ..] = &self.corners;
        let gap = a + c - b - d;
        gap.xy().norm_squared() < tolerance * tolerance && gap.z.abs() < DROP_TOL
    }

    /// Makes the fan of the corners, each moved outwards; of an edge, its ends also to both sides.
    #[inline(always)]
    fn write_fan(&self, fan: &mut Fan, distance: f64) {
        let corners = self.corners.get(..self.len).unwrap_or(&[]);
        fan.len = 0;
        if let [a, b] = corners {
            let along = offset(a, b);
            let out = four_directions(along * (1.0 / along.norm()));
            for (v, k) in [(a, 2), (a, 3), (b, 0), (b, 1)] {
                fan.push(moved(v, out[k], distance, 0.0));
            }
            return;
        }
        let mean = corners.iter().sum::<Vec3>() * (1.0 / corners.len() as f64);
        for v in corners {
            let out = offset(&mean, v);
            let norm2 = larger(out.norm_squared(), f64::MIN_POSITIVE);
            fan.push(moved(v, out, distance / norm2.sqrt(), 0.0));
        }
    }
}
