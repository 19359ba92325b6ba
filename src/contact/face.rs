// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the contact face of one object: its corners are support vertices of directions close to the normal.
//!
//! No reference is known to us. Steps:
//! 1. *Face.* The face of an object along the normal n is what lies at most the slop below its support plane.
//!    The support vertex of n + t, with a small tilt t across n, maximises t·r − low, r its place in the
//!    contact frame and low its depth below the plane. With |t| = 2 slop / size a corner half the slop low has
//!    a larger value than all that lies a quarter of the size closer. A vertex more than the slop low is not of
//!    the face; half the tilt is queried then. The size is how far apart [`WIDE_TILT`] finds vertices.
//! 2. *All corners.* The direction across the side of two corners, in which both have the same value, finds
//!    what is beyond that side. A face of k corners is complete after 3 + k + (k − 3) queries; a curved one
//!    becomes an inscribed polygon, whose gaps are halved in a fixed order, so that it moves with the object.
//! 3. *Roundness.* A corner that two directions found is sharp. Others are queried with half the tilt: on a
//!    round surface p = c + R t, and c = 2 p(t/2) − p(t) is the corner. A smooth piece is known by equal gains
//!    of both points in their directions (trapezoidal rule). A point that moves by more than
//!    sqrt(slop · size / 2) stays: it would leave a circle as large as the object by the slop.
//! 4. *Cached face.* Each side is queried once, across it, with a [`CACHED_LEAN`] to its second corner: so each
//!    corner is confirmed, and nothing is beyond a side. A point is queried in three directions, and is their
//!    mean. Each end of a line is queried beyond it too, which gives its radius along the line. An inscribed
//!    polygon is queried along the directions that found it. Where the corners moved otherwise than as one
//!    body, or are no longer of the face, the face is found from nothing.
//!
//! One file, because every step adds to the same samples; the steps are its parts.

use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::{
    CachedCorner, CachedFace, ManifoldCache, Motion, to_f32, to_f64,
};
use crate::contact::polygon::{
    Corner, FixedVec, Point2, Polygon, across, cross, dot, lerp, norm, vector,
};
use crate::math::{EPSILON, larger, largest, lesser};
use crate::minkowski::support::{Fault, SupportMap};
use core::mem::swap;

/// Queries of one object at most: eight corners, each found twice, and the size.
const MAX_QUERIES: u32 = 24;
/// Corners of a face at most: one more than eight, so that a face of eight is known to be complete.
pub const MAX_CORNERS: usize = 9;
/// Tilt of the first directions, a tangent: 14°. With less, round objects seem smaller than the circle that
/// their points move on; with more, the flanks beside a face are taken for it.
const WIDE_TILT: f64 = 0.25;
/// Points closer than this, in units of tilt times size, may be one round corner: those of a ball are 4 apart.
const ROUND_CORNER_TILTS: f64 = 8.0;
/// How far a direction across a side leans to its second corner, in tilts. A corner beyond the side by less
/// than this angle may be missed: 0.01 % of the square of the side.
const SIDE_LEAN: f64 = 1.0 / 4096.0;
/// The same for a cached face: 3.6°, by which it may have turned about the normal since. Insensitive: 1/64 to
/// 1/8 tried.
const CACHED_LEAN: f64 = 1.0 / 16.0;
/// Cosine and sine of the first directions.
#[allow(clippy::excessive_precision)] // In single precision.
const THREE_WAYS: [Point2; 3] = [
    [1.0, 0.0],
    [-0.5, 0.866_025_403_784_438_6],
    [-0.5, -0.866_025_403_784_438_6],
];

/// A support vertex in the contact frame, and how it was found.
#[derive(Clone, Copy, Default)]
struct Sample {
    /// The vertex.
    found: Corner,
    /// The corner without roundness, once it is settled.
    corner: Corner,
    /// The tilt of its direction.
    tilt: Point2,
    /// How much it moves for each tilt, metres.
    radius: f64,
    /// Whether roundness is removed, or there is none.
    is_settled: bool,
    /// Whether no corner is beyond the side to the next sample, or no query is left to find one.
    is_closed: bool,
}

impl Sample {
    /// Returns by how much its vertex has a larger value in its own direction than another one.
    fn gain_over(&self, other: &Self) -> f64 {
        dot(&self.tilt, &vector(&other.found.at, &self.found.at)) + other.found.low - self.found.low
    }
}

/// The face of one object.
pub struct Face {
    pub corners: Polygon<MAX_CORNERS>,
    /// The height of its support plane, outwards.
    pub top: f64,
    /// The slop in force.
    pub slop: f64,
    /// The rounding of a coordinate, metres.
    pub rounding: f64,
    /// The part that the cache stores.
    pub ring: CachedFace,
    /// How it moved, where it was cached.
    pub motion: Option<Motion>,
}

/// The least slop, as a share of the depth. Along a normal whose depth is 0.1 % above the minimum the corners of
/// a face differ in height by that, times the ratio of two distances: that of the corners, and that of the
/// contact from the closer one. Measured on 17,351 pairs of boxes and of a box and an ellipsoid, 1 cm deep,
/// slop 0: a share of 0 finds a corner in place of a face or an edge in 212, 0.001 in 21, 0.002 in 12, 0.01 in 1.
const MIN_SLOP_REL: f64 = 0.01;
/// The least slop, in roundings of a coordinate: the tilt that finds corners must be well above what a callback
/// rounds its direction by.
const MIN_SLOP_ROUNDINGS: f64 = 4.0;

/// Finds both faces, cached or from nothing. Returns them with the slop in force: the caller's, or the least one
/// of the depth. The first vertex of obj1 becomes the origin of the frame.
///
/// # Errors
/// [`Fault::NonFinite`].
pub fn faces<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    frame: &mut ContactFrame,
    slop: f64,
    known: Option<&ManifoldCache>,
) -> Result<([Face; 2], f64), Fault> {
    let [ring1, ring2] = [0, 1].map(|i| known.map(|known| &known.rings()[i]));
    let mut one = FaceSearch::new(obj1, frame, 1.0, false);
    let found1 = one.find_cached_or_plane(ring1)?;
    *frame = one.frame;
    let mut two = FaceSearch::new(obj2, frame, -1.0, true);
    let found2 = two.find_cached_or_plane(ring2)?;
    let slop = larger(slop, MIN_SLOP_REL * (one.top + two.top));
    let has_slop = known.is_some_and(|known| known.has_slop(slop));
    let faces = [
        one.face_of(found1, has_slop, slop)?,
        two.face_of(found2, has_slop, slop)?,
    ];
    Ok((faces, slop))
}

impl Face {
    /// Returns how far below its support plane it is at a place.
    pub fn low(&self, at: &Point2) -> f64 {
        self.corners.low(at, self.rounding)
    }

    /// Returns how far beside a round corner the surface is the slop low; of a segment that of the less round
    /// end.
    pub fn round(&self) -> f64 {
        let radii = || self.ring.corners().iter().map(|c| to_f64(c.radius));
        let radius = match self.ring.corners() {
            [_, _] => radii().fold(f64::INFINITY, lesser),
            _ => radii().fold(0.0, larger),
        };
        (2.0 * radius * self.slop).sqrt()
    }

    /// Returns how far beside its corners a contact may be: half the slop, and as far as it is round for a line
    /// that is long for that, because a curved rim is round along it and not across.
    pub fn reach(&self) -> f64 {
        let round = self.round();
        match &*self.corners {
            [a, b] if norm(&vector(&a.at, &b.at)) > 2.0 * round => larger(round, 0.5 * self.slop),
            _ => 0.5 * self.slop,
        }
    }
}

/// Finds the corners of one face.
struct FaceSearch<'a, S> {
    object: &'a S,
    frame: ContactFrame,
    /// Whether the frame has its origin; else the first vertex becomes it.
    has_origin: bool,
    sign: f64,
    /// The height of the support plane, and the vertex on it.
    top: f64,
    first: Sample,
    slop: f64,
    size: f64,
    /// The tilt that finds corners.
    tilt_size: f64,
    rounding: f64,
    query_count: u32,
    ring: FixedVec<Sample, MAX_CORNERS>,
    /// The largest radius of a corner.
    radius: f64,
}

impl<'a, S: SupportMap> FaceSearch<'a, S> {
    fn new(object: &'a S, frame: &ContactFrame, sign: f64, has_origin: bool) -> Self {
        FaceSearch {
            object,
            frame: *frame,
            has_origin,
            sign,
            top: 0.0,
            first: Sample::default(),
            slop: 0.0,
            size: 0.0,
            tilt_size: 0.0,
            rounding: 0.0,
            query_count: 0,
            ring: FixedVec::default(),
            radius: 0.0,
        }
    }

    fn query(&mut self, tilt: Point2) -> Result<Sample, Fault> {
        let p = self
            .object
            .support(&self.frame.tilted_direction(self.sign, tilt));
        if !self.has_origin {
            (self.frame.origin, self.has_origin) = (p, true);
        }
        self.query_count += 1;
        self.rounding = larger(self.rounding, 8.0 * EPSILON * largest(&p));
        let p = p - self.frame.origin;
        // NaN ends here too; beyond that squares of squares overflow.
        let q = p.norm_squared();
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        let [e1, e2] = &self.frame.axes;
        let found = Corner {
            at: [e1.dot(&p), e2.dot(&p)],
            low: self.top - self.sign * self.frame.normal.dot(&p),
        };
        Ok(Sample {
            found,
            corner: found,
            tilt,
            ..Sample::default()
        })
    }

    fn is_same(&self, a: &Sample, b: &Sample) -> bool {
        norm(&vector(&a.found.at, &b.found.at)) <= self.rounding
            && (a.found.low - b.found.low).abs() <= self.rounding
    }

    /// Finds a corner of the face: with the tilt, else with half of it.
    fn corner(&mut self, tilt: Point2) -> Result<Option<Sample>, Fault> {
        for share in [1.0, 0.5] {
            if self.query_count >= MAX_QUERIES {
                break;
            }
            let p = self.query(tilt.map(|x| share * x))?;
            if p.found.low <= self.slop {
                return Ok(Some(p));
            }
        }
        Ok(None)
    }

    /// Finds the cached face, or the support plane where it is another.
    fn find_cached_or_plane(&mut self, ring: Option<&CachedFace>) -> Result<Option<Face>, Fault> {
        if let Some(ring) = ring {
            let found = self.find_cached(ring)?;
            if found.is_some() {
                return Ok(found);
            }
        }
        self.find_plane()?;
        Ok(None)
    }

    /// Returns the cached face, or finds it from nothing where its slop was another.
    fn face_of(mut self, found: Option<Face>, has_slop: bool, slop: f64) -> Result<Face, Fault> {
        if let Some(face) = found {
            if has_slop {
                return Ok(face);
            }
            self.find_plane()?;
        }
        self.find(slop)
    }

    /// Queries the support plane.
    fn find_plane(&mut self) -> Result<(), Fault> {
        (self.top, self.query_count) = (0.0, 0);
        let mut first = self.query([0.0; 2])?;
        self.top = -first.found.low;
        first.found.low = 0.0;
        first.corner.low = 0.0;
        first.is_settled = true;
        self.first = first;
        Ok(())
    }

    /// Finds the size, and the first corners.
    fn start(&mut self, slop: f64) -> Result<(), Fault> {
        let top = self.first;
        let mut wide = [top; 3];
        for i in 0..3 {
            let new = self.query(THREE_WAYS[i].map(|x| WIDE_TILT * x))?;
            for known in &wide {
                let apart = norm(&vector(&known.found.at, &new.found.at));
                self.size = larger(self.size, apart);
            }
            wide[i] = new;
        }
        // No coarser than the face, no finer than what rounding does to it.
        self.slop = slop.min(self.size).max(MIN_SLOP_ROUNDINGS * self.rounding);
        if self.size > self.rounding {
            self.tilt_size = (2.0 * self.slop / self.size).min(WIDE_TILT);
            for (sample, way) in wide.into_iter().zip(THREE_WAYS) {
                let found = if sample.found.low <= self.slop {
                    Some(sample)
                } else {
                    self.corner(way.map(|x| self.tilt_size * x))?
                };
                match found {
                    Some(new) if !self.is_found(&new) => self.ring.push(new),
                    _ => {}
                }
            }
        }
        if self.ring.is_empty() {
            self.ring.push(top);
        }
        self.is_found(&top);
        if let [a, b, c] = &mut *self.ring {
            if cross(
                &vector(&a.found.at, &b.found.at),
                &vector(&a.found.at, &c.found.at),
            ) < 0.0
            {
                swap(b, c);
            }
        }
        Ok(())
    }

    /// Returns whether a vertex is one of those found; from another direction it is sharp then.
    fn is_found(&mut self, new: &Sample) -> bool {
        let known = (0..self.ring.len()).find(|i| self.is_same(self.ring.at(*i), new));
        if let Some(i) = known {
            let (least, known) = (0.25 * self.tilt_size, self.ring.at_mut(i));
            known.is_settled |= norm(&vector(&known.tilt, &new.tilt)) >= least;
        }
        known.is_some()
    }

    /// Finds the corners between those found, in passes around the face.
    fn refine(&mut self) -> Result<(), Fault> {
        loop {
            let before = self.ring.len();
            let mut i = 0;
            while i < self.ring.len() {
                if !self.ring.at(i).is_closed {
                    if let Some(new) = self.beyond(i)? {
                        self.ring.insert(i + 1, new);
                        i += 1;
                    } else {
                        self.ring.at_mut(i).is_closed = true;
                    }
                }
                i += 1;
            }
            if self.ring.len() == before {
                return Ok(());
            }
        }
    }

    /// Finds the corner beyond the side from sample `i` to the next, if there is one.
    fn beyond(&mut self, i: usize) -> Result<Option<Sample>, Fault> {
        let ends = |s: &Self| [*s.ring.at(i), *s.ring.at(i + 1)];
        let apart = |s: &Self| {
            let [a, b] = ends(s);
            norm(&vector(&a.corner.at, &b.corner.at))
        };
        if apart(self) <= ROUND_CORNER_TILTS * self.tilt_size * self.size {
            self.remove_roundness(i)?;
            self.remove_roundness(i + 1)?;
            if apart(self) <= self.slop {
                return Ok(None);
            }
        }
        // A new corner costs up to two, and one to settle it.
        let limit = MAX_QUERIES
            .saturating_sub(self.pending_queries() + 1)
            .min(self.query_limit());
        if self.ring.len() == MAX_CORNERS || self.query_count + 2 > limit {
            return Ok(None);
        }
        let [a, b] = ends(self).map(|sample| sample.found);
        let whole = norm(&vector(&a.at, &b.at));
        let bias = 2.0 * self.rounding / whole;
        let bias = bias
            .max(SIDE_LEAN * self.tilt_size)
            .min(self.tilt_size / 64.0);
        let Some(new) = self.corner(across(&a, &b, self.tilt_size, bias))? else {
            return Ok(None);
        };
        if self.is_found(&new) {
            return Ok(None);
        }
        let beyond = cross(&vector(&a.at, &new.found.at), &vector(&a.at, &b.at));
        Ok((beyond > self.flat() * whole).then_some(new))
    }

    /// Returns how far a corner is beyond a side at least: rounding, and what is left of roundness, is less.
    fn flat(&self) -> f64 {
        self.rounding + self.tilt_size * self.slop
    }

    /// Returns the limit of queries: few corners, all of them sharp, need half.
    fn query_limit(&self) -> u32 {
        if self.ring.len() > 4 || self.radius > 0.0 {
            MAX_QUERIES
        } else {
            MAX_QUERIES / 2
        }
    }

    /// Returns the queries that the samples still need.
    fn pending_queries(&self) -> u32 {
        let open = self.ring.iter().filter(|s| !s.is_settled);
        open.map(|s| 1 + u32::from(self.is_wide(s))).sum()
    }

    fn is_wide(&self, sample: &Sample) -> bool {
        norm(&sample.tilt) > 2.0 * self.tilt_size
    }

    /// Removes roundness: what moves in proportion to the tilt.
    fn remove_roundness(&mut self, i: usize) -> Result<(), Fault> {
        let mut full = *self.ring.at(i);
        let wide = self.is_wide(&full);
        if full.is_settled || self.query_count + 1 + u32::from(wide) > self.query_limit() {
            return Ok(());
        }
        self.ring.at_mut(i).is_settled = true;
        if wide {
            let share = self.tilt_size / norm(&full.tilt);
            let near = self.query(full.tilt.map(|x| share * x))?;
            if self.is_same(&full, &near) || near.found.low > self.slop || self.is_found(&near) {
                return Ok(());
            }
            full = near;
        }
        self.ring.at_mut(i).corner = full.found;
        let mut tilt = full.tilt.map(|x| 0.5 * x);
        for _ in 0..2 {
            if self.query_count >= self.query_limit() {
                break;
            }
            let near = self.query(tilt)?;
            let way = vector(&near.found.at, &full.found.at);
            let moved = norm(&way);
            if self.is_same(&full, &near) {
                break;
            }
            let radius = moved / norm(&vector(&tilt, &full.tilt));
            let (there, back) = (full.gain_over(&near), near.gain_over(&full));
            let smooth = (there - back).abs() <= 0.5 * (there + back) + self.rounding;
            if moved * moved <= 0.5 * self.slop * self.size && smooth {
                self.radius = larger(self.radius, radius);
                let corner = Corner {
                    at: lerp(&full.found.at, &near.found.at, 2.0),
                    low: larger((4.0 * near.found.low - full.found.low) / 3.0, 0.0),
                };
                *self.ring.at_mut(i) = Sample {
                    tilt: full.tilt,
                    radius,
                    corner,
                    ..*self.ring.at(i)
                };
                break;
            }
            // Another corner: half the tilt finds the higher one of two round ends of a line. A lean that makes
            // them level, and more, finds this one.
            let lean = (0.125 * self.tilt_size + back / moved).min(self.tilt_size);
            tilt = [0, 1].map(|k| tilt[k] + way[k] / moved * lean);
        }
        Ok(())
    }

    /// Finds the face from nothing.
    fn find(mut self, slop: f64) -> Result<Face, Fault> {
        self.start(slop)?;
        if self.ring.len() > 1 {
            self.refine()?;
        }
        for i in 0..self.ring.len() {
            self.remove_roundness(i)?;
        }
        let samples = &self.ring;
        let mut corners = Polygon::default();
        samples.iter().for_each(|s| corners.push(s.corner));
        // One that was found twice is one, to the rounding of both.
        let corners = corners.tidied(larger(self.slop, 4.0 * self.rounding), self.flat());
        let least = corners.iter().map(|c| c.low);
        let least = least.fold(f64::INFINITY, lesser);
        let mut ring = CachedFace {
            tilt_size: to_f32(self.tilt_size),
            slop: to_f32(self.slop),
            len: corners.len() as f32,
            // There may be corners between those of a full ring.
            inscribed: f32::from(u8::from(self.ring.len() == MAX_CORNERS)),
            own: f32::from(u8::from(self.radius > 0.0 || least > 0.0625 * self.slop)),
            ..CachedFace::default()
        };
        for (known, corner) in ring.corners.iter_mut().zip(&*corners) {
            let apart = |s: &Sample| norm(&vector(&s.corner.at, &corner.at));
            let here = || samples.iter().filter(|s| apart(s) <= self.slop);
            let tilts = here().filter(|s| s.corner == *corner).map(|s| s.tilt);
            let radius = match &*corners {
                [_] => self.radius,
                _ => here().map(|s| s.radius).fold(0.0, larger),
            };
            *known = CachedCorner {
                at: corner.at.map(to_f32),
                low: to_f32(corner.low),
                tilt: tilts.fold([0.0; 2], |_, tilt| tilt).map(to_f32),
                radius: to_f32(radius),
            };
        }
        Ok(self.face(corners, ring))
    }

    fn face(&self, corners: Polygon<MAX_CORNERS>, ring: CachedFace) -> Face {
        Face {
            corners,
            top: self.top,
            slop: self.slop,
            rounding: self.rounding,
            ring,
            motion: None,
        }
    }

    /// Confirms the cached face; None where it is another.
    fn find_cached(&mut self, ring: &CachedFace) -> Result<Option<Face>, Fault> {
        let count = ring.corners().len();
        let tilt_size = to_f64(ring.tilt_size);
        if !(tilt_size > 0.0) || count == 0 {
            return Ok(None);
        }
        // The ends of a line are each the other's second corner.
        let inscribed = ring.inscribed != 0.0 && count > 2;
        let mut next = [Corner::default(); MAX_CORNERS];
        for i in 0..larger(count, if count == 1 { 3 } else { 0 }) {
            // Across a side its second corner is found.
            let j = if count == 1 || inscribed {
                i
            } else {
                (i + 1) % count
            };
            let (known, other) = (ring.corner(i % count), ring.corner(j % count));
            let mut tilt = if count == 1 {
                THREE_WAYS[i % 3].map(|x| x * tilt_size)
            } else if inscribed {
                known.tilt.map(to_f64)
            } else {
                across(
                    &known.corner(),
                    &other.corner(),
                    tilt_size,
                    CACHED_LEAN * tilt_size,
                )
            };
            // NaN ends here too.
            if !(norm(&tilt) <= 0.5) {
                return Ok(None);
            }
            let mut found = self.query(tilt)?.found;
            let mut radius = to_f64(other.radius);
            if count == 2 {
                // The end of a line may be as round along it as across, or sharp.
                let along = vector(&known.corner().at, &other.corner().at);
                let whole = norm(&along);
                let beyond = along.map(|x| x * tilt_size / whole);
                let end = self.query(beyond)?.found;
                let (more, moved) = (vector(&tilt, &beyond), vector(&found.at, &end.at));
                let slack = 0.25 * to_f64(ring.slop) + self.rounding;
                let is_one = norm(&moved) <= 2.0 * radius * tilt_size + slack;
                if !(is_one && (found.low - end.low).abs() <= slack) {
                    return Ok(None);
                }
                radius = dot(&moved, &beyond) / dot(&more, &beyond);
                (found, tilt) = (end, beyond);
            }
            next[j % MAX_CORNERS] = Corner {
                at: [0, 1].map(|k| found.at[k] - radius * tilt[k]),
                low: found.low - 0.5 * radius * dot(&tilt, &tilt),
            };
        }
        if ring.own != 0.0 {
            self.top = -self.query([0.0; 2])?.found.low;
        } else {
            let lows = next.iter().take(count).map(|c| c.low);
            self.top = -lows.fold(f64::INFINITY, lesser);
        }
        self.slop = larger(to_f64(ring.slop), self.rounding);
        let slack = 0.25 * self.slop + self.rounding;
        if let (1, [a, b, c, ..]) = (count, next) {
            let across = slack + to_f64(ring.corner(0).radius) * tilt_size;
            match mean(&[a, b, c], across, slack) {
                Some(mean) => next[0] = mean,
                None => return Ok(None),
            }
        }
        let next = next.get(..count).unwrap_or(&[]);
        let Some(motion) = ring.motion(next, slack) else {
            return Ok(None);
        };
        let mut ring = *ring;
        let mut corners = Polygon::default();
        // In the order of the hull that they were.
        for (corner, known) in next.iter().zip(&mut ring.corners) {
            let low = corner.low + self.top;
            if !(low <= self.slop + self.rounding) {
                return Ok(None);
            }
            let low = larger(low, 0.0);
            corners.push(Corner { low, ..*corner });
            known.at = corner.at.map(to_f32);
            known.low = to_f32(low);
            known.tilt = motion.turned(&known.tilt.map(to_f64)).map(to_f32);
        }
        Ok(Some(Face {
            motion: Some(motion),
            ..self.face(corners, ring)
        }))
    }
}

/// Returns the mean of three corners, if they differ by no more than this across and along.
fn mean(three: &[Corner; 3], across: f64, along: f64) -> Option<Corner> {
    let third = |of: &dyn Fn(&Corner) -> f64| three.iter().map(of).sum::<f64>() / 3.0;
    let mean = Corner {
        at: [third(&|c| c.at[0]), third(&|c| c.at[1])],
        low: third(&|c| c.low),
    };
    let is_one =
        |c: &Corner| norm(&vector(&c.at, &mean.at)) <= across && (c.low - mean.low).abs() <= along;
    three.iter().all(is_one).then_some(mean)
}
