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
//!
//! The faces of the swapped pair are the same in the same frame.

use crate::contact::face::{Face, FaceSample, MAX_CORNERS, THREE_WAYS, across};
use crate::contact::fixed_vec::FixedVec;
use crate::contact::frame::ContactFrame;
use crate::contact::manifold::MAX_CONTACTS;
use crate::contact::polygon::{Polygon, Vec2, way};
use crate::math::{Vec3, larger};
use nalgebra::UnitComplex;

/// Contacts whose ids are stored.
const MAX_IDS: usize = 8;
/// Lean of a direction across a side towards its second corner, in tilts: 3.6°, by which the face may turn about
/// the normal. Insensitive: 1/64 to 1/8 tried.
const CACHED_LEAN: f64 = 1.0 / 16.0;
/// Vertices are stored as `f32`: their error, as a share of the size of the face.
const F32_REL_TOL: f64 = 4.0 * f32::EPSILON as f64;

/// A direction and what it finds, as x and y of the frame: its tilt, the vertex, and the way from that to the corner
/// without roundness.
type CachedSample = [[f32; 2]; 3];

/// A cached face.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CachedFace {
    /// The number of samples: 0 where nothing is cached.
    len: f32,
    pub slop: f32,
    pub tilt_size: f32,
    /// Not 0: the samples are a polygon's corners, all of them.
    pub is_complete: f32,
    samples: [CachedSample; MAX_CORNERS],
}

/// Motion of a face in the frame from one query to the next.
#[derive(Clone, Copy)]
pub struct Motion {
    pub turn: UnitComplex<f64>,
    from: Vec2,
    to: Vec2,
}

/// All zero is cold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct ManifoldCache {
    /// The axes of the frame.
    axes: [[f32; 3]; 2],
    /// The slop in force when the faces were found.
    slop: f32,
    /// The face whose outward normal is along the cross product of the axes, and the opposite one. While a pair is
    /// queried: those of obj1 and obj2.
    pub faces: [CachedFace; 2],
    points: [[f32; 2]; MAX_IDS],
    /// 0 for none.
    pub ids: [u32; MAX_IDS],
    /// The last id.
    last: u32,
}

/// Returns what finds a polygon again of which all corners are known. A point is found by three directions, and the
/// ends of a segment by those along it too.
fn confirming_samples(
    corners: &Polygon<MAX_CORNERS>,
    tilt_size: f64,
) -> FixedVec<FaceSample, MAX_CORNERS> {
    let n = corners.len().max(1);
    let count = [3, 3, 4].get(n).copied().unwrap_or(n);
    let sample = |i: usize| {
        let (last, corner) = (corners.at(i % n + n - 1), corners.at(i % n));
        let tilt = match n {
            1 => THREE_WAYS[i % 3] * tilt_size,
            2 if i > 1 => way(last, corner).normalize() * tilt_size,
            _ => across(last, corner, tilt_size, CACHED_LEAN * tilt_size),
        };
        FaceSample::new(tilt, *corner)
    };
    (0..count).map(sample).collect()
}

impl CachedFace {
    /// Packs what finds a face again, from `origin`.
    fn new(face: &Face, origin: &Vec3) -> Self {
        let samples = if face.is_complete {
            confirming_samples(&face.corners, face.tilt_size)
        } else {
            face.samples
        };
        let mut cached = Self {
            len: samples.len() as f32,
            slop: face.slop as f32,
            tilt_size: face.tilt_size as f32,
            is_complete: f32::from(u8::from(face.is_complete)),
            ..Self::default()
        };
        for (place, s) in cached.samples.iter_mut().zip(samples.iter()) {
            let parts = [s.tilt, way(origin, &s.found), way(&s.found, &s.corner)];
            *place = parts.map(|v| [v.x as f32, v.y as f32]);
        }
        cached
    }

    /// Returns the tilt of each sample, the vertex and the way from that to the corner.
    pub fn samples(&self) -> impl Iterator<Item = [Vec2; 3]> + '_ {
        // NaN and what is below 0 become 0.
        let samples = self.samples.iter().take(self.len as usize);
        samples.map(|s| s.map(|v| v.map(f64::from).into()))
    }

    /// Returns how the vertices moved to where they are now, if they did as one body, within the slack.
    pub fn motion(&self, now: &[FaceSample], slack: f64) -> Option<Motion> {
        let ([_, from, _], to) = (self.samples().next()?, now.first()?.found.xy());
        let spoke =
            |([_, old, _], new): ([Vec2; 3], &FaceSample)| (old - from, new.found.xy() - to);
        let spokes = || self.samples().zip(now).map(spoke);
        let longer = |a: (Vec2, Vec2), b: (Vec2, Vec2)| if b.0.norm() > a.0.norm() { b } else { a };
        let (a, b) = spokes().fold((Vec2::zeros(), Vec2::zeros()), longer);
        let slack = slack + F32_REL_TOL * a.norm();
        let mut turn = UnitComplex::identity();
        // A face no longer than its rounding has no measurable turn.
        if a.norm() > 64.0 * slack {
            turn = UnitComplex::rotation_between(&a, &b);
        }
        let is_one = |(a, b): (Vec2, Vec2)| (turn * a - b).norm() <= slack;
        spokes().all(is_one).then_some(Motion { turn, from, to })
    }
}

impl Motion {
    /// Returns where a point that moved along is now.
    fn of(&self, at: Vec2) -> Vec2 {
        self.to + self.turn * (at - self.from)
    }
}

impl ManifoldCache {
    /// Returns the frame as it was, turned as little as the normal turned; None where the cache is of another
    /// one. The faces of the swapped pair are swapped first.
    pub fn frame(&mut self, normal: &Vec3) -> Option<ContactFrame> {
        let axes = self.axes.map(|axis| axis.map(f64::from).into());
        let frame = ContactFrame::following(normal, &axes)?;
        self.order_faces(&frame);
        Some(frame)
    }

    fn order_faces(&mut self, frame: &ContactFrame) {
        if !frame.is_right_handed() {
            self.faces.reverse();
        }
    }

    /// Returns whether the faces were found with a slop, or with one that is a little less: of a deep
    /// overlap it changes with the depth.
    pub fn has_slop(&self, slop: f64) -> bool {
        let (old, new) = (self.slop, slop as f32);
        0.8 * new <= old && old <= new
    }

    /// Returns the ids of the corners of a region, 0 for none.
    pub fn ids(
        &self,
        motions: [Option<Motion>; 2],
        region: &Polygon<MAX_CONTACTS>,
        slop: f64,
    ) -> FixedVec<u32, MAX_CONTACTS> {
        let mut ids: FixedVec<u32, MAX_CONTACTS> = region.iter().map(|_| 0).collect();
        let reach = region.iter().map(|c| way(c, region.at(0)).norm());
        let near = 0.25 * reach.fold(0.0, larger) + slop;
        for (old, id) in self.points.iter().zip(self.ids) {
            // The closest corner that has none.
            let (mut best, mut least) = (MAX_CONTACTS, near);
            for motion in motions.iter().flatten() {
                let now = motion.of(old.map(f64::from).into());
                for (i, corner) in region.iter().enumerate() {
                    let apart = (corner.xy() - now).norm();
                    if apart < least && ids.get(i) == Some(&0) {
                        (best, least) = (i, apart);
                    }
                }
            }
            if let Some(place) = ids.get_mut(best) {
                *place = id;
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
        faces: [&Face; 2],
        points: &[(Vec3, u32)],
    ) {
        let origin = faces[0].samples.at(0).found;
        self.axes = frame.axes.map(|axis| axis.map(|x| x as f32).into());
        (self.slop, self.faces) = (
            slop as f32,
            faces.map(|face| CachedFace::new(face, &origin)),
        );
        self.order_faces(frame);
        self.ids = [0; MAX_IDS];
        let places = self.points.iter_mut().zip(&mut self.ids);
        for ((at, id), (place, old)) in points.iter().zip(places) {
            let at = way(&origin, at);
            (*place, *old) = ([at.x as f32, at.y as f32], *id);
        }
    }
}
