// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Stores the contact manifold of a pair from one query to the next: what finds both faces again, and the contacts
//! with their ids.
//!
//! 1. *Faces.* Of a polygon whose corners are all known, the direction across each side, with a [`CACHED_LEAN`] to
//!    its second corner, is queried again: so each corner is confirmed, and nothing is beyond a side. Of other faces
//!    the directions are that found their corners.
//! 2. *Motion.* Where the vertices found moved as one body, within a quarter of the slop, the face is the same.
//! 3. *Ids.* A contact keeps its id while it moves with either object, or beside it by less than a quarter of the
//!    region: the closest to an old one, moved along, has its id.

use crate::contact::face::{FaceSample, MAX_CORNERS, THREE_WAYS, across};
use crate::contact::frame::ContactFrame;
use crate::contact::manifold::MAX_CONTACTS;
use crate::contact::polygon::{Polygon, Vec2, way};
use crate::math::{Vec3, larger};
use nalgebra::{Complex, UnitComplex};

/// Contacts whose ids are stored.
const MAX_IDS: usize = 8;
/// How far a direction across a side leans to its second corner, in tilts: 3.6°, by which the face may turn about
/// the normal. Insensitive: 1/64 to 1/8 tried.
const CACHED_LEAN: f64 = 1.0 / 16.0;
/// Vertices are stored as `f32`: their error, as a share of the size of the face.
const F32_REL_TOL: f64 = 4.0 * f32::EPSILON as f64;

/// A direction and what it finds, as x and y of the frame: its tilt, the vertex, and the way from that to the corner
/// without roundness.
#[derive(Clone, Copy, Debug, Default)]
#[repr(transparent)]
pub struct CachedSample([[f32; 2]; 3]);

/// A cached face.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CachedFace {
    /// The number of samples: 0 where nothing is cached.
    pub len: f32,
    pub slop: f32,
    pub tilt_size: f32,
    /// How far beside its corners the surface is the slop low.
    pub round: f32,
    /// Not 0: the samples are a polygon's corners, all of them.
    pub is_complete: f32,
    samples: [CachedSample; MAX_CORNERS],
}

/// How a face moved in the frame from one query to the next.
#[derive(Clone, Copy)]
pub struct Motion {
    pub turn: UnitComplex<f64>,
    from: Vec2,
    to: Vec2,
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
    pub faces: [CachedFace; 2],
    points: [[f32; 2]; MAX_IDS],
    ids: [u32; MAX_IDS],
    count: u32,
    /// The last id.
    last: u32,
    checksum: u32,
}

impl CachedSample {
    fn new(tilt: Vec2, found: &Vec3, offset: Vec2) -> Self {
        Self([tilt, found.xy(), offset].map(|v| [v.x as f32, v.y as f32]))
    }

    /// Returns the tilt, the vertex and the way from that to the corner.
    pub fn parts(&self) -> [Vec2; 3] {
        self.0.map(|v| v.map(f64::from).into())
    }
}

impl CachedFace {
    /// Returns what finds a polygon again of which all corners are known. A point is found by three directions, and the
    /// ends of a segment by those along it too.
    pub fn of_polygon(corners: &Polygon<MAX_CORNERS>, tilt_size: f64) -> Self {
        let n = corners.len().max(1);
        let tilt = |i: usize| {
            let (last, corner) = (corners.at(i % n + n - 1), corners.at(i % n));
            match n {
                1 => THREE_WAYS[i % 3] * tilt_size,
                2 if i > 1 => way(last, corner).normalize() * tilt_size,
                _ => across(last, corner, tilt_size, CACHED_LEAN * tilt_size),
            }
        };
        let sample = |i: usize| CachedSample::new(tilt(i), corners.at(i % n), Vec2::zeros());
        let count = [3, 3, 4].get(n).copied().unwrap_or(n);
        Self::of((0..count).map(sample), tilt_size, 1.0)
    }

    /// Returns what finds samples again.
    pub fn of_samples(samples: &[FaceSample], tilt_size: f64) -> Self {
        let sample = |s: &FaceSample| CachedSample::new(s.tilt, &s.found, way(&s.found, &s.corner));
        Self::of(samples.iter().map(sample), tilt_size, 0.0)
    }

    fn of(all: impl Iterator<Item = CachedSample>, tilt_size: f64, is_complete: f32) -> Self {
        let mut face = Self {
            tilt_size: tilt_size as f32,
            is_complete,
            ..Self::default()
        };
        for (place, sample) in face.samples.iter_mut().zip(all) {
            *place = sample;
            face.len += 1.0;
        }
        face
    }

    /// Returns the samples.
    pub fn samples(&self) -> &[CachedSample] {
        // NaN and what is below 0 become 0.
        self.samples.get(..self.len as usize).unwrap_or(&[])
    }

    /// Returns how the vertices moved to where they are now, if they did as one body, within the slack.
    pub fn motion(&self, now: &[FaceSample], slack: f64) -> Option<Motion> {
        let ([_, from, _], to) = (self.samples[0].parts(), now.first()?.found.xy());
        let spoke = |(old, new): (&CachedSample, &FaceSample)| {
            let [_, old, _] = old.parts();
            (old - from, new.found.xy() - to)
        };
        let spokes = || self.samples().iter().zip(now).map(spoke);
        let (mut reach, mut ways) = (0.0, (Vec2::x(), Vec2::x()));
        for (a, b) in spokes() {
            if a.norm() > reach {
                (reach, ways) = (a.norm(), (a, b));
            }
        }
        let slack = slack + F32_REL_TOL * reach;
        let mut turn = UnitComplex::identity();
        // A face no longer than its rounding has no measurable turn.
        if reach > 64.0 * slack {
            let (a, b) = ways;
            turn = UnitComplex::new_normalize(Complex::new(a.dot(&b), a.perp(&b)));
        }
        let is_one = |(a, b): (Vec2, Vec2)| (turn * a - b).norm() <= slack;
        spokes().all(is_one).then_some(Motion { turn, from, to })
    }

    /// Turns the face round, as the frame of the swapped pair sees it.
    fn mirror(&mut self) {
        let len = self.samples().len();
        let samples = self.samples.get_mut(..len).unwrap_or(&mut []);
        samples.reverse();
        samples
            .iter_mut()
            .flat_map(|s| &mut s.0)
            .for_each(|v| v[1] = -v[1]);
    }
}

impl Motion {
    /// Returns where a point that moved along is now.
    fn of(&self, at: &Vec2) -> Vec2 {
        self.to + self.turn * (at - self.from)
    }
}

impl ManifoldCache {
    /// Returns the frame as it was, turned as little as the normal turned; None where the cache is of another
    /// one. The cache of the swapped pair is turned round first.
    pub fn frame(&mut self, normal: &Vec3) -> Option<ContactFrame> {
        if self.checksum != self.checksum() {
            *self = Self::default();
        }
        let mut along = Vec3::from(self.normal.map(f64::from)).dot(normal);
        if along < 0.0 {
            self.faces.reverse();
            self.faces.iter_mut().for_each(CachedFace::mirror);
            self.points.iter_mut().for_each(|p| p[1] = -p[1]);
            along = -along;
        }
        // NaN is no normal.
        let is_same = along > 0.5 && along < 2.0;
        let frame = ContactFrame::along_axis(normal, &self.axis.map(f64::from).into());
        frame.filter(|_| is_same)
    }

    /// Returns whether the faces were found with a slop, or with one that is a little less: of a deep
    /// overlap it changes with the depth.
    pub fn has_slop(&self, slop: f64) -> bool {
        let (old, new) = (self.slop, slop as f32);
        0.8 * new <= old && old <= new
    }

    /// Returns the checksum.
    fn checksum(&self) -> u32 {
        let of_face = |face: &CachedFace| {
            let head = [
                face.len,
                face.slop,
                face.tilt_size,
                face.round,
                face.is_complete,
            ];
            let samples = face.samples.into_iter().flat_map(|s| s.0).flatten();
            samples.chain(head)
        };
        let frame = self.normal.into_iter().chain(self.axis);
        let reals = frame
            .chain([self.slop])
            .chain(self.faces.iter().flat_map(of_face));
        let reals = reals
            .chain(self.points.into_iter().flatten())
            .map(f32::to_bits);
        let words = reals.chain(self.ids).chain([self.count, self.last]);
        words.fold(0, |sum: u32, x| {
            (sum.rotate_left(5) ^ x).wrapping_mul(0x9e37_79b1)
        })
    }

    /// Returns the ids of the corners of a region, 0 for none.
    pub fn ids(
        &self,
        motions: [Option<Motion>; 2],
        corners: &[Vec3],
        slop: f64,
    ) -> [u32; MAX_CONTACTS] {
        let mut ids = [0; MAX_CONTACTS];
        let first = corners.first().copied().unwrap_or_default();
        let reach = corners.iter().map(|c| way(c, &first).norm());
        let near = 0.25 * reach.fold(0.0, larger) + slop;
        let count = (self.count as usize).min(MAX_IDS);
        for (old, id) in self.points.iter().zip(self.ids).take(count) {
            // The closest corner that has none.
            let (mut best, mut least) = (MAX_CONTACTS, near);
            for now in motions
                .iter()
                .flatten()
                .map(|m| m.of(&old.map(f64::from).into()))
            {
                for (i, corner) in corners.iter().enumerate() {
                    let apart = (corner.xy() - now).norm();
                    if apart < least && ids.get(i) == Some(&0) {
                        (best, least) = (i, apart);
                    }
                }
            }
            if let Some(place) = ids.get_mut(best) {
                *place = id.max(1);
            }
        }
        ids
    }

    /// Returns the id of the first contact; 0 for none.
    pub fn first_id(&self) -> u32 {
        if self.count > 0 {
            self.ids[0].max(1)
        } else {
            0
        }
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
        faces: [CachedFace; 2],
        points: &[(Vec3, u32)],
    ) {
        self.normal = frame.normal.map(|x| x as f32).into();
        self.axis = frame.axes[0].map(|x| x as f32).into();
        (self.slop, self.faces) = (slop as f32, faces);
        let places = self.points.iter_mut().zip(&mut self.ids);
        for ((at, id), (place, old)) in points.iter().zip(places) {
            (*place, *old) = ([at.x as f32, at.y as f32], *id);
        }
        self.count = points.len().min(MAX_IDS) as u32;
        self.checksum = self.checksum();
    }
}
