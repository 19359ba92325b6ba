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

use crate::contact::fixed_vec::FixedVec;
use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::{CachedFace, ManifoldCache, Motion};
use crate::contact::polygon::{Polygon, Vec2, way};
use crate::math::{EPSILON, Vec3, larger, lesser, max_abs};
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
/// Lean of a direction across a side towards its second corner, in tilts. A corner beyond the side by less
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
    /// Motion of the sample for each tilt, metres.
    radius: f64,
    /// Roundness is removed, or there is none.
    is_settled: bool,
    /// No corner is beyond the side to the next sample, or no query is left to find one.
    is_closed: bool,
}

impl FaceSample {
    pub fn new(tilt: Vec2, found: Vec3) -> Self {
        Self {
            tilt,
            found,
            corner: found,
            ..Self::default()
        }
    }

    /// Returns by how much its vertex has a larger value in its own direction than another one.
    fn gain_over(&self, other: &Self) -> f64 {
        self.tilt.dot(&way(&other.found, &self.found)) + other.found.z - self.found.z
    }
}

/// The face of one object.
#[derive(Clone, Copy, Default)]
pub struct Face {
    pub corners: Polygon<MAX_CORNERS>,
    /// The height of its support plane, outwards.
    pub top: f64,
    /// The slop in force.
    pub slop: f64,
    /// The rounding of a coordinate, metres.
    pub rounding: f64,
    /// Distance beside the corners at which the surface is the slop low; of a segment at the less round end.
    pub round: f64,
    /// The samples that found the corners, in their order.
    pub samples: FixedVec<FaceSample, MAX_CORNERS>,
    /// The tilt that finds corners.
    pub tilt_size: f64,
    /// All corners are known, and all are sharp.
    pub is_complete: bool,
    /// Motion since the last query, where the face was cached.
    pub motion: Option<Motion>,
}

/// Finds both faces, cached or from nothing. Returns them with the slop in force: the caller's, or the least one
/// of the depth.
///
/// # Errors
/// [`Fault::NonFinite`].
pub fn faces<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    frame: &ContactFrame,
    slop: f64,
    cache: Option<&ManifoldCache>,
) -> Result<([Face; 2], f64), Fault> {
    let mut one = FaceSearch::new(obj1, frame, 1.0);
    let mut two = FaceSearch::new(obj2, frame, -1.0);
    one.find_cached_or_plane(cache.map(|cache| &cache.faces[0]))?;
    two.find_cached_or_plane(cache.map(|cache| &cache.faces[1]))?;
    let slop = larger(slop, MIN_SLOP_REL * (one.face.top + two.face.top));
    let has_slop = cache.is_some_and(|cache| cache.has_slop(slop));
    one.find(slop, has_slop)?;
    two.find(slop, has_slop)?;
    Ok(([one.face, two.face], slop))
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
    frame: &'a ContactFrame,
    sign: f64,
    query_count: u32,
    /// The vertex on the support plane.
    first: FaceSample,
    /// The face, as far as it is found.
    face: Face,
}

impl<'a, S: SupportMap> FaceSearch<'a, S> {
    fn new(object: &'a S, frame: &'a ContactFrame, sign: f64) -> Self {
        FaceSearch {
            object,
            frame,
            sign,
            query_count: 0,
            first: FaceSample::default(),
            face: Face::default(),
        }
    }

    fn query(&mut self, tilt: Vec2) -> Result<FaceSample, Fault> {
        let dir = self.frame.tilted_direction(self.sign, tilt);
        let p = self.object.support(&dir);
        self.query_count += 1;
        self.face.rounding = larger(self.face.rounding, 8.0 * EPSILON * max_abs(&p));
        let mut found = self.frame.project(&p)?;
        found.z = self.face.top - self.sign * found.z;
        Ok(FaceSample::new(tilt, found))
    }

    /// Finds what may be a corner of the face: with the tilt, else with half of it.
    fn corner(&mut self, tilt: Vec2) -> Result<FaceSample, Fault> {
        let new = self.query(tilt)?;
        if new.found.z <= self.face.slop {
            return Ok(new);
        }
        self.query(tilt * 0.5)
    }

    /// Finds the cached face, or the support plane where it is another.
    fn find_cached_or_plane(&mut self, cached: Option<&CachedFace>) -> Result<(), Fault> {
        if let Some(cached) = cached {
            self.face.motion = self.find_cached(cached)?;
        }
        if self.face.motion.is_none() {
            self.find_plane()?;
        }
        Ok(())
    }

    /// Queries the support plane.
    fn find_plane(&mut self) -> Result<(), Fault> {
        self.face.top = 0.0;
        self.first = self.query(Vec2::zeros())?;
        self.face.top = -self.first.found.z;
        (self.first.found.z, self.first.corner.z) = (0.0, 0.0);
        Ok(())
    }

    /// Finds the face from nothing, where it is not the cached one or that had another slop.
    fn find(&mut self, slop: f64, has_slop: bool) -> Result<(), Fault> {
        if self.face.motion.is_none() || !has_slop {
            if self.face.motion.is_some() {
                self.find_plane()?;
            }
            self.face.samples = FixedVec::default();
            self.query_count = 1;
            self.start(slop)?;
            if self.face.samples.len() > 1 {
                self.refine()?;
            }
            for i in 0..self.face.samples.len() {
                self.remove_roundness(i)?;
            }
            for i in 0..self.face.samples.len() {
                if let Some(round) = self.round_corner_at(self.face.samples.at(i)) {
                    let sample = self.face.samples.at_mut(i);
                    (sample.corner, sample.radius) = (round.corner, round.radius);
                }
            }
        }
        self.join_corners();
        Ok(())
    }

    /// Finds the size, and the first corners.
    fn start(&mut self, slop: f64) -> Result<(), Fault> {
        let mut size = 0.0;
        let mut wide = [self.first; 3];
        for i in 0..3 {
            let new = self.query(THREE_WAYS[i] * WIDE_TILT)?;
            for known in &wide {
                size = larger(size, way(&known.found, &new.found).norm());
            }
            wide[i] = new;
        }
        // No coarser than the face, no finer than what rounding does to it.
        self.face.slop = slop.min(size).max(MIN_SLOP_ROUNDINGS * self.face.rounding);
        if size > self.face.rounding {
            self.face.tilt_size = lesser(2.0 * self.face.slop / size, WIDE_TILT);
            for mut new in wide {
                if new.found.z > self.face.slop {
                    new = self.corner(new.tilt * (self.face.tilt_size / WIDE_TILT))?;
                }
                if new.found.z <= self.face.slop && !self.is_found(&new) {
                    self.face.samples.push(new);
                }
            }
        }
        let first = self.first;
        if !self.is_found(&first) && self.face.samples.len() < 2 {
            self.face.samples.push(first);
        }
        if let [a, b, c] = &mut *self.face.samples {
            if way(&a.found, &b.found).perp(&way(&a.found, &c.found)) < 0.0 {
                swap(b, c);
            }
        }
        Ok(())
    }

    fn is_same(&self, a: &FaceSample, b: &FaceSample) -> bool {
        let apart = a.found - b.found;
        apart.xy().norm() <= self.face.rounding && apart.z.abs() <= self.face.rounding
    }

    /// Returns whether two samples may be of one round corner.
    fn is_near(&self, a: &FaceSample, b: &FaceSample) -> bool {
        way(&a.found, &b.found).norm() <= ROUND_CORNER_SLOPS * self.face.slop
    }

    /// Returns whether a vertex is one of those found; from another direction it is sharp then. Of a round end two
    /// directions that differ along the line alone find one point: beside another sample it may still be round.
    fn is_found(&mut self, new: &FaceSample) -> bool {
        let samples = &self.face.samples;
        let known = (0..samples.len()).find(|i| self.is_same(samples.at(*i), new));
        if let Some(i) = known {
            let turned = (samples.at(i).tilt - new.tilt).norm();
            let near_count = samples.iter().filter(|s| self.is_near(s, new)).count();
            let is_sharp = near_count == 1 && turned >= 0.25 * self.face.tilt_size;
            self.face.samples.at_mut(i).is_settled |= is_sharp;
        }
        known.is_some()
    }

    /// Finds the corners between those found, around the face until every side is closed.
    fn refine(&mut self) -> Result<(), Fault> {
        let (mut i, mut closed) = (0, 0);
        while closed < self.face.samples.len() {
            i %= self.face.samples.len();
            closed += 1;
            if !self.face.samples.at(i).is_closed {
                if let Some(new) = self.beyond(i)? {
                    self.face.samples.insert(i + 1, new);
                    i += 1;
                    closed = 0;
                } else {
                    self.face.samples.at_mut(i).is_closed = true;
                }
            }
            i += 1;
        }
        Ok(())
    }

    /// Finds the corner beyond the side from sample `i` to the next, if there is one.
    fn beyond(&mut self, i: usize) -> Result<Option<FaceSample>, Fault> {
        // A corner costs up to two, and those that are not settled one.
        let pending = self.face.samples.iter().filter(|s| !s.is_settled).count() as u32;
        let count = self.query_count + 2;
        let is_last = count > self.query_limit() || count + pending > MAX_QUERIES;
        if self.face.samples.len() == MAX_CORNERS || is_last {
            return Ok(None);
        }
        let [a, b] = [i, i + 1].map(|i| self.face.samples.at(i).found);
        let (length, tilt_size) = (way(&a, &b).norm(), self.face.tilt_size);
        let lean = larger(2.0 * self.face.rounding / length, SIDE_LEAN * tilt_size);
        let lean = lesser(lean, tilt_size / 64.0);
        let new = self.corner(across(&a, &b, tilt_size, lean))?;
        if new.found.z > self.face.slop || self.is_found(&new) {
            return Ok(None);
        }
        // One more of a round corner tells nothing.
        let [to_a, to_b] = [a, b].map(|end| way(&end, &new.found).norm());
        let end = if to_a < to_b { i } else { i + 1 };
        if self.is_near(self.face.samples.at(end), &new) {
            self.remove_roundness(end)?;
            if self.round_corner_at(&new).is_some() || self.is_found(&new) {
                return Ok(None);
            }
        }
        let beyond = way(&a, &new.found).perp(&way(&a, &b));
        Ok((beyond > self.flat() * length).then_some(new))
    }

    /// Returns how far a corner is beyond a side at least: rounding, and what is left of roundness, is less.
    fn flat(&self) -> f64 {
        self.face.rounding + self.face.tilt_size * self.face.slop
    }

    /// Returns the limit of queries: few corners, all of them sharp, need half.
    fn query_limit(&self) -> u32 {
        let samples = &self.face.samples;
        let is_few = samples.len() <= 4 && samples.iter().all(|s| s.radius == 0.0);
        if is_few { MAX_QUERIES / 2 } else { MAX_QUERIES }
    }

    /// Removes roundness: what moves in proportion to the tilt.
    fn remove_roundness(&mut self, i: usize) -> Result<(), Fault> {
        let mut full = *self.face.samples.at(i);
        if full.is_settled || self.query_count >= self.query_limit() {
            return Ok(());
        }
        self.face.samples.at_mut(i).is_settled = true;
        if self.round_corner_at(&full).is_some() {
            return Ok(());
        }
        let share = self.face.tilt_size / full.tilt.norm();
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
            let moved = outwards.norm();
            let most = self.face.slop / self.face.tilt_size.sqrt();
            let (there, back) = (full.gain_over(&near), near.gain_over(&full));
            let is_smooth = (there - back).abs() <= 0.5 * (there + back) + self.face.rounding;
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
            let lean = lesser(
                0.125 * self.face.tilt_size + back / moved,
                self.face.tilt_size,
            );
            tilt += outwards * (lean / moved);
        }
        *self.face.samples.at_mut(i) = FaceSample {
            is_settled: true,
            is_closed: self.face.samples.at(i).is_closed,
            ..full
        };
        Ok(())
    }

    /// Returns the sample of a round corner that another sample is one more of.
    fn round_corner_at(&self, new: &FaceSample) -> Option<FaceSample> {
        let mut round = self.face.samples.iter().filter(|s| s.radius > 0.0);
        round.find(|s| self.is_near(s, new)).copied()
    }

    /// Makes the polygon of the samples.
    fn join_corners(&mut self) {
        // One that was found twice is one, to the rounding of both.
        let merged = larger(self.face.slop, 4.0 * self.face.rounding);
        let samples = self.face.samples;
        let corners: Polygon<MAX_CORNERS> = samples.iter().map(|s| s.corner).collect();
        let corners = corners.tidied(merged, self.flat());
        let radii = samples.iter().map(|s| s.radius);
        let radius = radii.fold(f64::INFINITY, lesser);
        // There may be corners between those of a full ring, and the support plane may be higher than all.
        let is_sharp = samples.iter().all(|s| s.corner == s.found);
        let has_highest = corners.iter().any(|corner| corner.z <= self.face.rounding);
        self.face.is_complete = is_sharp && has_highest && samples.len() < MAX_CORNERS;
        self.face.round = (2.0 * radius * self.face.slop).sqrt();
        self.face.corners = corners;
    }

    /// Confirms the cached face, and returns how it moved; None where it is another.
    fn find_cached(&mut self, cached: &CachedFace) -> Result<Option<Motion>, Fault> {
        for [tilt, ..] in cached.samples() {
            // NaN ends here too, and what has no tilt.
            if !(tilt.norm() > 0.0 && tilt.norm() <= 0.5) {
                return Ok(None);
            }
            let new = self.query(tilt)?;
            self.face.samples.push(new);
        }
        let slop = larger(f64::from(cached.slop), self.face.rounding);
        (self.face.slop, self.face.tilt_size) = (slop, cached.tilt_size.into());
        let slack = 0.25 * slop + self.face.rounding;
        let Some(motion) = cached.motion(&self.face.samples, slack) else {
            return Ok(None);
        };
        for (new, [tilt, _, offset]) in self.face.samples.iter_mut().zip(cached.samples()) {
            let low = 0.5 * offset.dot(&tilt);
            new.radius = offset.norm() / tilt.norm();
            let offset = motion.turn * offset;
            new.corner += Vec3::new(offset.x, offset.y, low);
            new.tilt = motion.turn * tilt;
        }
        if cached.is_complete != 0.0 {
            let heights = self.face.samples.iter().map(|s| -s.corner.z);
            self.face.top = heights.fold(f64::NEG_INFINITY, larger);
        } else {
            self.find_plane()?;
        }
        let top = self.face.top;
        for sample in self.face.samples.iter_mut() {
            sample.found.z += top;
            sample.corner.z = larger(sample.corner.z + top, 0.0);
        }
        let is_low = |s: &FaceSample| s.corner.z > slop + self.face.rounding;
        Ok((!self.face.samples.iter().any(is_low)).then_some(motion))
    }
}
