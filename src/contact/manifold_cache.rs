// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Stores the contact manifold of a pair from one query to the next: both faces, and the contacts with their ids.
//!
//! A contact keeps its id while it moves with either object, or beside it by less than a quarter of the region: the
//! closest of the old ones, moved along, has its id.

use crate::contact::face::MAX_CORNERS;
use crate::contact::frame::ContactFrame;
use crate::contact::manifold::MAX_CONTACTS;
use crate::contact::polygon::{Corner, Point2, cross, dot, norm, vector};
use crate::math::{Vec3, larger};
use core::mem::swap;

/// Contacts whose ids are stored.
const MAX_IDS: usize = 8;
/// Corners are stored as `f32`: their error, as a share of the size of the face.
const F32_REL_TOL: f64 = 4.0 * f32::EPSILON as f64;

/// Converts to what is stored.
#[allow(clippy::unnecessary_cast, reason = "it is one in double precision")]
pub fn to_f32(x: f64) -> f32 {
    x as f32
}

/// Converts from what is stored.
#[allow(clippy::useless_conversion, reason = "it is none in double precision")]
pub fn to_f64(x: f32) -> f64 {
    f64::from(x)
}

/// A corner of a cached face.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CachedCorner {
    /// Its place in the frame.
    pub at: [f32; 2],
    /// How far below the support plane.
    pub low: f32,
    /// The tilt of a direction that found it.
    pub tilt: [f32; 2],
    /// How much it moves for each tilt.
    pub radius: f32,
}

impl CachedCorner {
    /// Returns the corner.
    pub fn corner(&self) -> Corner {
        Corner {
            at: self.at.map(to_f64),
            low: to_f64(self.low),
        }
    }
}

/// A cached face: its corners, counterclockwise; a tilt of 0 stands for none.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CachedFace {
    pub tilt_size: f32,
    pub slop: f32,
    /// The number of corners.
    pub len: f32,
    /// Not 0: a polygon inscribed in a face that is curved or has more corners.
    pub inscribed: f32,
    /// Not 0: the support plane is higher than the corners, and is queried too.
    pub own: f32,
    pub corners: [CachedCorner; MAX_CORNERS],
}

impl CachedFace {
    /// Returns the corners.
    pub fn corners(&self) -> &[CachedCorner] {
        // NaN and what is below 0 become 0.
        let len = (self.len as usize).min(MAX_CORNERS);
        self.corners.get(..len).unwrap_or(&[])
    }

    /// Returns a corner.
    pub fn corner(&self, i: usize) -> &CachedCorner {
        &self.corners[i.min(MAX_CORNERS - 1)]
    }

    /// Returns how the corners moved to where they are now, if they did as one body, within the slack.
    pub fn motion(&self, now: &[Corner], slack: f64) -> Option<Motion> {
        let (from, to) = (self.corner(0).at.map(to_f64), now.first()?.at);
        let spokes = || {
            let ways = self.corners().iter().zip(now);
            ways.map(|(a, b)| (vector(&from, &a.at.map(to_f64)), vector(&to, &b.at)))
        };
        let mut motion = Motion {
            turn: [1.0, 0.0],
            from,
            to,
        };
        let (mut reach, mut turn) = (0.0, motion.turn);
        for (a, b) in spokes() {
            if norm(&a) > reach {
                (reach, turn) = (norm(&a), [dot(&a, &b), cross(&a, &b)]);
            }
        }
        let slack = slack + F32_REL_TOL * reach;
        // A face no longer than its rounding has no measurable turn.
        if reach > 64.0 * slack {
            let whole = norm(&turn);
            motion.turn = turn.map(|x| x / whole);
        }
        let as_one = |(a, b): (Point2, Point2)| norm(&vector(&motion.turned(&a), &b)) <= slack;
        spokes().all(as_one).then_some(motion)
    }

    /// Turns the face round, as the frame of the swapped pair sees it.
    fn mirror(&mut self) {
        let count = self.corners().len();
        for known in &mut self.corners {
            known.at[1] = -known.at[1];
            known.tilt[1] = -known.tilt[1];
        }
        if let Some(corners) = self.corners.get_mut(..count) {
            corners.reverse();
        }
    }
}

/// How a face moved in the frame from one query to the next.
#[derive(Clone, Copy)]
pub struct Motion {
    /// Cosine and sine of the angle.
    turn: Point2,
    from: Point2,
    to: Point2,
}

impl Motion {
    /// Returns a vector turned.
    pub fn turned(&self, [x, y]: &Point2) -> Point2 {
        let [c, s] = self.turn;
        [c * x - s * y, s * x + c * y]
    }

    /// Returns where a point that moved along is now.
    fn of(&self, at: &Point2) -> Point2 {
        let [x, y] = self.turned(&vector(&self.from, at));
        [self.to[0] + x, self.to[1] + y]
    }
}

/// All zero is cold. Any other bits are harmless: where the checksum is wrong it is cold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct ManifoldCache {
    normal: [f32; 3],
    /// The first axis of the frame.
    axis: [f32; 3],
    /// The slop in force when the faces were found.
    slop: f32,
    rings: [CachedFace; 2],
    points: [[f32; 2]; MAX_IDS],
    ids: [u32; MAX_IDS],
    count: u32,
    /// The last id.
    last: u32,
    checksum: u32,
}

/// The ids of the corners of a region, 0 for none, and which of them was the first contact.
#[derive(Default)]
pub struct ContactIds {
    of: [u32; MAX_CONTACTS],
    pub first: Option<usize>,
}

impl ContactIds {
    /// Returns the id of corner `i`.
    pub fn of(&self, i: usize) -> u32 {
        self.of.get(i).copied().unwrap_or(0)
    }
}

impl ManifoldCache {
    /// Returns the frame as it was, turned as little as the normal turned; None where the cache is of another
    /// one. The cache of the swapped pair is turned round first.
    pub fn frame(&mut self, normal: &Vec3) -> Option<ContactFrame> {
        if self.checksum != self.checksum() {
            *self = Self::default();
        }
        let vector = |v: [f32; 3]| Vec3::from(v.map(to_f64));
        let mut along = vector(self.normal).dot(normal);
        if along < 0.0 {
            self.flip();
            along = -along;
        }
        // NaN is no normal.
        let is_same = along > 0.5 && along < 2.0;
        let frame = ContactFrame::along_axis(normal, &vector(self.axis));
        frame.filter(|_| is_same)
    }

    /// Returns whether the faces were found with a slop, or with one that is a little less: of a deep
    /// overlap it changes with the depth.
    pub fn has_slop(&self, slop: f64) -> bool {
        let (old, new) = (self.slop, to_f32(slop));
        0.8 * new <= old && old <= new
    }

    /// Returns the checksum.
    fn checksum(&self) -> u32 {
        let mut sum = self.count ^ self.last.rotate_left(16);
        let mut mix = |x: f32| sum = (sum.rotate_left(5) ^ x.to_bits()).wrapping_mul(0x9e37_79b1);
        self.normal.into_iter().for_each(&mut mix);
        self.axis.into_iter().for_each(&mut mix);
        mix(self.slop);
        for ring in &self.rings {
            let head = [
                ring.tilt_size,
                ring.slop,
                ring.len,
                ring.inscribed,
                ring.own,
            ];
            head.into_iter().for_each(&mut mix);
            for known in &ring.corners {
                let ([x, y], [u, v]) = (known.at, known.tilt);
                let all = [x, y, known.low, u, v, known.radius];
                all.into_iter().for_each(&mut mix);
            }
        }
        self.points.iter().flatten().copied().for_each(&mut mix);
        let ids = self.ids.map(f32::from_bits);
        ids.into_iter().for_each(&mut mix);
        sum
    }

    fn flip(&mut self) {
        let [one, two] = &mut self.rings;
        swap(one, two);
        self.rings.iter_mut().for_each(CachedFace::mirror);
        self.points.iter_mut().for_each(|p| p[1] = -p[1]);
    }

    /// Returns the cached faces.
    pub fn rings(&self) -> &[CachedFace; 2] {
        &self.rings
    }

    /// Returns the ids of the corners of a region.
    pub fn ids(&self, motions: [Option<Motion>; 2], corners: &[Corner], slop: f64) -> ContactIds {
        let mut ids = ContactIds::default();
        let root = corners.first().map_or([0.0; 2], |c| c.at);
        let square = |a: &Point2, b: &Point2| dot(&vector(a, b), &vector(a, b));
        let reach = corners.iter().map(|c| square(&root, &c.at));
        let near = 0.25 * reach.fold(0.0, larger).sqrt() + slop;
        // The closest of the old contacts to each corner that is the closest to it.
        let mut closest = [(near * near, MAX_IDS); MAX_CONTACTS];
        let count = (self.count as usize).min(MAX_IDS);
        for (k, old) in self.points.iter().enumerate().take(count) {
            let old = old.map(to_f64);
            let mut best = (near * near, MAX_CONTACTS);
            for now in motions.iter().flatten().map(|m| m.of(&old)) {
                for (i, corner) in corners.iter().enumerate() {
                    let apart = square(&now, &corner.at);
                    if apart < best.0 {
                        best = (apart, i);
                    }
                }
            }
            if let Some(closest) = closest.get_mut(best.1) {
                if best.0 < closest.0 {
                    *closest = (best.0, k);
                }
            }
        }
        for (i, ((_, k), id)) in closest.iter().zip(&mut ids.of).enumerate() {
            if let Some(old) = self.ids.get(*k) {
                *id = (*old).max(1);
                if *k == 0 {
                    ids.first = Some(i);
                }
            }
        }
        ids
    }

    /// Returns a new id.
    pub fn new_id(&mut self) -> u32 {
        self.last = self.last.wrapping_add(1).max(1);
        self.last
    }

    /// Stores what the query found.
    pub fn store(
        &mut self,
        frame: &ContactFrame,
        slop: f64,
        rings: [CachedFace; 2],
        points: &[(Point2, u32)],
    ) {
        self.normal = frame.normal.map(to_f32).into();
        self.axis = frame.axes[0].map(to_f32).into();
        self.slop = to_f32(slop);
        self.rings = rings;
        let places = self.points.iter_mut().zip(&mut self.ids);
        for ((at, id), (place, old)) in points.iter().zip(places) {
            (*place, *old) = (at.map(to_f32), *id);
        }
        self.count = points.len().min(MAX_IDS) as u32;
        self.checksum = self.checksum();
    }
}
