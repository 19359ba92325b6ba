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
//!    Missed, 1 in 100,000: of a face that leans so much that only an edge and a corner beside it are within the
//!    slop, that corner; every tilt finds the edge or what is lower than the slop.
//! 3. *Roundness.* A corner that two directions found is sharp. Others are queried with half the tilt: on a
//!    round surface p = c + R t, and c = 2 p(t/2) − p(t) is the corner. A smooth piece is known by equal gains
//!    of both points in their directions (trapezoidal rule). A point that moves by more than
//!    sqrt(slop · size / 2) stays: it would leave a circle as large as the object by the slop.
//! 4. *Cached face* ([`crate::contact::manifold_cache`]). The cached directions are queried again. Where what they
//!    find moved as one body, so did the corners; else the face is found from nothing.

use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::{CachedFace, ManifoldCache, Motion};
use crate::contact::polygon::{FixedVec, Polygon, Vec2, way};
use crate::math::{EPSILON, Vec3, larger, largest, lesser};
use crate::minkowski::support::{Fault, SupportMap};
use core::mem::swap;

/// Queries of one object at most: eight corners, each found twice, and the size.
const MAX_QUERIES: u32 = 24;
/// Corners of a face at most: one more than eight, so that a face of eight is known to be complete.
pub const MAX_CORNERS: usize = 9;
/// Tilt of the first directions, a tangent: 14°. With less, round objects seem smaller than the circle that
/// their points move on; with more, the flanks beside a face are taken for it.
const WIDE_TILT: f64 = 0.25;
/// Points closer than this many slops may be one round corner: those of a ball are 8 apart.
const ROUND_CORNER_SLOPS: f64 = 16.0;
/// How far a direction across a side leans to its second corner, in tilts. A corner beyond the side by less
/// than this angle may be missed: 0.01 % of the square of the side.
const SIDE_LEAN: f64 = 1.0 / 4096.0;
/// The first directions: their tilts, over the tilt.
pub const THREE_WAYS: [Vec2; 3] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(-0.5, 0.866_025_403_784_438_6),
    Vec2::new(-0.5, -0.866_025_403_784_438_6),
];
/// The least slop, as a share of the depth. Along a normal whose depth is 0.1 % above the minimum the corners of
/// a face differ in height by that, times the ratio of two distances: that of the corners, and that of the
/// contact from the closer one. Measured on 17,351 pairs of boxes and of a box and an ellipsoid, 1 cm deep,
/// slop 0: a share of 0 finds a corner in place of a face or an edge in 212, 0.001 in 21, 0.002 in 12, 0.01 in 1.
const MIN_SLOP_REL: f64 = 0.01;
/// The least slop, in roundings of a coordinate: the tilt that finds corners must be well above what a callback
/// rounds its direction by.
const MIN_SLOP_ROUNDINGS: f64 = 4.0;

/// A support vertex in the contact frame (z: how low), and how it was found.
#[derive(Clone, Copy, Default)]
pub struct FaceSample {
    /// The tilt of its direction.
    pub tilt: Vec2,
    /// The vertex.
    pub found: Vec3,
    /// The corner without roundness, once it is settled.
    pub corner: Vec3,
    /// How much it moves for each tilt, metres.
    radius: f64,
    /// Whether roundness is removed, or there is none.
    is_settled: bool,
    /// Whether no corner is beyond the side to the next sample, or no query is left to find one.
    is_closed: bool,
}

impl FaceSample {
    /// Returns by how much its vertex has a larger value in its own direction than another one.
    fn gain_over(&self, other: &Self) -> f64 {
        self.tilt.dot(&way(&other.found, &self.found)) + other.found.z - self.found.z
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
    /// How far beside its corners the surface is the slop low; of a segment beside the less round end.
    pub round: f64,
    /// The part that the cache stores.
    pub cached: CachedFace,
    /// How it moved, where it was cached.
    pub motion: Option<Motion>,
}

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
    cache: Option<&ManifoldCache>,
) -> Result<([Face; 2], f64), Fault> {
    let mut one = FaceSearch::new(obj1, frame, 1.0, false);
    let found1 = one.find_cached_or_plane(cache.map(|cache| &cache.faces[0]))?;
    *frame = one.frame;
    let mut two = FaceSearch::new(obj2, frame, -1.0, true);
    let found2 = two.find_cached_or_plane(cache.map(|cache| &cache.faces[1]))?;
    let slop = larger(slop, MIN_SLOP_REL * (one.top + two.top));
    let has_slop = cache.is_some_and(|cache| cache.has_slop(slop));
    let faces = [
        one.face_of(found1, has_slop, slop)?,
        two.face_of(found2, has_slop, slop)?,
    ];
    Ok((faces, slop))
}

impl Face {
    /// Returns how far beside its corners a contact may be: half the slop, and as far as it is round for a line
    /// that is long for that, because a curved rim is round along it and not across.
    pub fn reach(&self) -> f64 {
        match &*self.corners {
            [a, b] if way(a, b).norm() > 2.0 * self.round => larger(self.round, 0.5 * self.slop),
            _ => 0.5 * self.slop,
        }
    }
}

/// Returns the tilt of the direction across the side from `a` to `b` of a face, outwards, in which both have the
/// same value, but for a `lean` to `b`.
pub fn across(a: &Vec3, b: &Vec3, tilt: f64, lean: f64) -> Vec2 {
    let along = way(a, b);
    let length = along.norm();
    let lean = ((b.z - a.z) / length).max(-tilt).min(tilt) + lean;
    (Vec2::new(along.y, -along.x) * tilt + along * lean) / length
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
    first: FaceSample,
    slop: f64,
    size: f64,
    /// The tilt that finds corners.
    tilt_size: f64,
    rounding: f64,
    query_count: u32,
    /// The corners found, in their order.
    ring: FixedVec<FaceSample, MAX_CORNERS>,
}

impl<'a, S: SupportMap> FaceSearch<'a, S> {
    fn new(object: &'a S, frame: &ContactFrame, sign: f64, has_origin: bool) -> Self {
        FaceSearch {
            object,
            frame: *frame,
            has_origin,
            sign,
            top: 0.0,
            first: FaceSample::default(),
            slop: 0.0,
            size: 0.0,
            tilt_size: 0.0,
            rounding: 0.0,
            query_count: 0,
            ring: FixedVec::default(),
        }
    }

    fn query(&mut self, tilt: Vec2) -> Result<FaceSample, Fault> {
        let dir = self.frame.tilted_direction(self.sign, tilt.into());
        let p = self.object.support(&dir);
        if !self.has_origin {
            (self.frame.origin, self.has_origin) = (p, true);
        }
        self.query_count += 1;
        self.rounding = larger(self.rounding, 8.0 * EPSILON * largest(&p));
        let [x, y, height] = self.frame.project(&p)?.into();
        let found = Vec3::new(x, y, self.top - self.sign * height);
        Ok(FaceSample {
            tilt,
            found,
            corner: found,
            ..FaceSample::default()
        })
    }

    /// Finds what may be a corner of the face: with the tilt, else with half of it.
    fn corner(&mut self, tilt: Vec2) -> Result<FaceSample, Fault> {
        let new = self.query(tilt)?;
        if new.found.z <= self.slop {
            return Ok(new);
        }
        self.query(tilt * 0.5)
    }

    /// Finds the cached face, or the support plane where it is another.
    fn find_cached_or_plane(&mut self, cached: Option<&CachedFace>) -> Result<Option<Face>, Fault> {
        if let Some(cached) = cached {
            let found = self.find_cached(cached)?;
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
        (self.top, self.query_count, self.ring) = (0.0, 0, FixedVec::default());
        self.first = self.query(Vec2::zeros())?;
        self.top = -self.first.found.z;
        (self.first.found.z, self.first.corner.z) = (0.0, 0.0);
        Ok(())
    }

    /// Finds the size, and the first corners.
    fn start(&mut self, slop: f64) -> Result<(), Fault> {
        let mut wide = [self.first; 3];
        for i in 0..3 {
            let new = self.query(THREE_WAYS[i] * WIDE_TILT)?;
            for known in &wide {
                self.size = larger(self.size, way(&known.found, &new.found).norm());
            }
            wide[i] = new;
        }
        // No coarser than the face, no finer than what rounding does to it.
        self.slop = slop.min(self.size).max(MIN_SLOP_ROUNDINGS * self.rounding);
        if self.size > self.rounding {
            self.tilt_size = lesser(2.0 * self.slop / self.size, WIDE_TILT);
            for mut new in wide {
                if new.found.z > self.slop {
                    new = self.corner(new.tilt * (self.tilt_size / WIDE_TILT))?;
                }
                if new.found.z <= self.slop && !self.is_found(&new) {
                    self.ring.push(new);
                }
            }
        }
        let first = self.first;
        if !self.is_found(&first) && self.ring.len() < 2 {
            self.ring.push(first);
        }
        if let [a, b, c] = &mut *self.ring {
            if way(&a.found, &b.found).perp(&way(&a.found, &c.found)) < 0.0 {
                swap(b, c);
            }
        }
        Ok(())
    }

    fn is_same(&self, a: &FaceSample, b: &FaceSample) -> bool {
        let apart = a.found - b.found;
        apart.xy().norm() <= self.rounding && apart.z.abs() <= self.rounding
    }

    /// Returns whether a vertex is one of those found; from another direction it is sharp then.
    fn is_found(&mut self, new: &FaceSample) -> bool {
        let known = (0..self.ring.len()).find(|i| self.is_same(self.ring.at(*i), new));
        if let Some(i) = known {
            let (least, known) = (0.25 * self.tilt_size, self.ring.at_mut(i));
            known.is_settled |= (known.tilt - new.tilt).norm() >= least;
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
    fn beyond(&mut self, i: usize) -> Result<Option<FaceSample>, Fault> {
        // A corner costs up to two, and those that are not settled one.
        let pending = self.ring.iter().filter(|s| !s.is_settled).count() as u32;
        let count = self.query_count + 2;
        let is_last = count > self.query_limit() || count + pending > MAX_QUERIES;
        if self.ring.len() == MAX_CORNERS || is_last {
            return Ok(None);
        }
        let [a, b] = [i, i + 1].map(|i| self.ring.at(i).found);
        let length = way(&a, &b).norm();
        let bias = larger(2.0 * self.rounding / length, SIDE_LEAN * self.tilt_size);
        let bias = lesser(bias, self.tilt_size / 64.0);
        let new = self.corner(across(&a, &b, self.tilt_size, bias))?;
        if new.found.z > self.slop || self.is_found(&new) {
            return Ok(None);
        }
        // One more of a round corner tells nothing.
        let apart = [a, b].map(|end| way(&end, &new.found).norm());
        if lesser(apart[0], apart[1]) <= ROUND_CORNER_SLOPS * self.slop {
            self.remove_roundness(if apart[0] < apart[1] { i } else { i + 1 })?;
            if self.round_corner_at(&new).is_some() {
                return Ok(None);
            }
        }
        let beyond = way(&a, &new.found).perp(&way(&a, &b));
        Ok((beyond > self.flat() * length).then_some(new))
    }

    /// Returns how far a corner is beyond a side at least: rounding, and what is left of roundness, is less.
    fn flat(&self) -> f64 {
        self.rounding + self.tilt_size * self.slop
    }

    /// Returns the limit of queries: few corners, all of them sharp, need half.
    fn query_limit(&self) -> u32 {
        let is_round = self.ring.iter().any(|s| s.radius > 0.0);
        let share = if self.ring.len() > 4 || is_round {
            1
        } else {
            2
        };
        MAX_QUERIES / share
    }

    /// Removes roundness: what moves in proportion to the tilt.
    fn remove_roundness(&mut self, i: usize) -> Result<(), Fault> {
        let mut full = *self.ring.at(i);
        if full.is_settled || self.query_count >= self.query_limit() {
            return Ok(());
        }
        self.ring.at_mut(i).is_settled = true;
        if self.round_corner_at(&full).is_some() {
            return Ok(());
        }
        let share = self.tilt_size / full.tilt.norm();
        if share < 0.5 {
            // One of the first directions found it.
            let new = self.query(full.tilt * share)?;
            if self.is_found(&new) {
                return Ok(());
            }
            full = new;
        }
        let mut tilt = full.tilt * 0.5;
        for _ in 0..2 {
            if self.query_count >= self.query_limit() {
                break;
            }
            let near = self.query(tilt)?;
            let outwards = way(&near.found, &full.found);
            let (moved, most) = (outwards.norm(), (0.5 * self.slop * self.size).sqrt());
            let (there, back) = (full.gain_over(&near), near.gain_over(&full));
            let is_smooth = (there - back).abs() <= 0.5 * (there + back) + self.rounding;
            if self.is_same(&full, &near) {
                break;
            }
            if moved <= most && is_smooth {
                full.radius = moved / (full.tilt - near.tilt).norm();
                full.corner = near.found * 2.0 - full.found;
                full.corner.z = larger((4.0 * near.found.z - full.found.z) / 3.0, 0.0);
                break;
            }
            // Half the tilt finds the higher one of two round ends of a line. A lean that makes them level, and
            // more, finds this one.
            let lean = lesser(0.125 * self.tilt_size + back / moved, self.tilt_size);
            tilt += outwards * (lean / moved);
        }
        *self.ring.at_mut(i) = FaceSample {
            is_settled: true,
            is_closed: self.ring.at(i).is_closed,
            ..full
        };
        Ok(())
    }

    /// Returns the sample of a round corner that another sample is one more of.
    fn round_corner_at(&self, new: &FaceSample) -> Option<FaceSample> {
        let apart = |s: &FaceSample| way(&s.found, &new.found).norm();
        let is_here = |s: &&FaceSample| apart(s) <= ROUND_CORNER_SLOPS * self.slop;
        let mut round = self.ring.iter().filter(|s| s.radius > 0.0);
        round.find(is_here).copied()
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
        for i in 0..self.ring.len() {
            if let Some(round) = self.round_corner_at(self.ring.at(i)) {
                let sample = self.ring.at_mut(i);
                (sample.corner, sample.radius) = (round.corner, round.radius);
            }
        }
        Ok(self.face(None))
    }

    /// Returns the face of the samples, which are the cached ones if it is cached.
    fn face(&self, cached: Option<(&CachedFace, Motion)>) -> Face {
        // One that was found twice is one, to the rounding of both.
        let merged = larger(self.slop, 4.0 * self.rounding);
        let corners: Polygon<MAX_CORNERS> = self.ring.iter().map(|s| s.corner).collect();
        let corners = corners.tidied(merged, self.flat());
        let (round, is_complete) = if let Some((cached, _)) = cached {
            (cached.round.into(), cached.is_complete != 0.0)
        } else {
            let radius = corners.iter().map(|corner| {
                let is_here = |s: &&FaceSample| way(&s.corner, corner).norm() <= merged;
                let radii = self.ring.iter().filter(is_here).map(|s| s.radius);
                radii.fold(0.0, larger)
            });
            let radius = radius.fold(f64::INFINITY, lesser);
            // There may be corners between those of a full ring, and the support plane may be higher than all.
            let is_sharp = self.ring.iter().all(|s| s.corner == s.found);
            let has_highest = corners.iter().any(|corner| corner.z <= self.rounding);
            let is_complete = is_sharp && has_highest && self.ring.len() < MAX_CORNERS;
            ((2.0 * radius * self.slop).sqrt(), is_complete)
        };
        let mut new = if is_complete {
            CachedFace::of_polygon(&corners, self.tilt_size)
        } else {
            CachedFace::of_samples(&self.ring, self.tilt_size)
        };
        (new.slop, new.round) = (self.slop as f32, round as f32);
        Face {
            corners,
            top: self.top,
            slop: self.slop,
            rounding: self.rounding,
            round,
            cached: new,
            motion: cached.map(|(_, motion)| motion),
        }
    }

    /// Confirms the cached face; None where it is another.
    fn find_cached(&mut self, cached: &CachedFace) -> Result<Option<Face>, Fault> {
        for sample in cached.samples() {
            // NaN ends here too, and what has no tilt.
            let [tilt, ..] = sample.parts();
            if !(tilt.norm() > 0.0 && tilt.norm() <= 0.5) {
                return Ok(None);
            }
            let new = self.query(tilt)?;
            self.ring.push(new);
        }
        (self.tilt_size, self.slop) = (cached.tilt_size.into(), cached.slop.into());
        self.slop = larger(self.slop, self.rounding);
        let slack = 0.25 * self.slop + self.rounding;
        let Some(motion) = cached.motion(&self.ring, slack) else {
            return Ok(None);
        };
        for (new, old) in self.ring.iter_mut().zip(cached.samples()) {
            let [tilt, _, offset] = old.parts();
            let low = 0.5 * offset.dot(&tilt);
            let offset = motion.turn * offset;
            new.corner += Vec3::new(offset.x, offset.y, low);
            new.tilt = motion.turn * tilt;
        }
        self.top = if cached.is_complete != 0.0 {
            let heights = self.ring.iter().map(|s| -s.corner.z);
            heights.fold(f64::NEG_INFINITY, larger)
        } else {
            -self.query(Vec2::zeros())?.found.z
        };
        for sample in self.ring.iter_mut() {
            sample.found.z += self.top;
            sample.corner.z = larger(sample.corner.z + self.top, 0.0);
        }
        let is_low = |s: &FaceSample| s.corner.z > self.slop + self.rounding;
        let is_face = !self.ring.iter().any(is_low);
        Ok(is_face.then(|| self.face(Some((cached, motion)))))
    }
}
