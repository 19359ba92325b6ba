// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Stores the warm start data of the contact manifold of a pair: the directions that reproduce both faces, and the
//! contacts with their ids.
//!
//! 1. *Faces.* For a polygon whose corners are all known, the outward direction of each side, leaning by
//!    [`CACHED_LEAN`] to its second corner, is evaluated again; this confirms each corner, and that there is no corner
//!    beyond a side. For other faces the directions that found the corners are evaluated again.
//! 2. *Motion.* If the vertices moved as one rigid body within a quarter of the slop, the face is the same.
//! 3. *Ids.* A contact keeps its id while it moves with either object, within a quarter of the region's size: each
//!    id goes to the contact closest to its old position, moved with either face.
//!
//! Valid for the swapped pair too: faces are stored by the orientation of the frame, not by object.

use crate::contact::face::{
    ContactFace, FaceSample, MAX_CONTACTS, MAX_FACE_CORNERS, Motion, THREE_DIRECTIONS,
};
use crate::contact::frame::{ContactFrame, outwards};
use crate::contact::tuning::CACHED_LEAN;
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Polygon, Vec2, offset};
use crate::math::{Vec3, larger};
use nalgebra::UnitComplex;

/// The number of contacts whose ids are stored.
const MAX_IDS: usize = 8;
/// Error of the vertices, which are stored as `f32`, relative to the size of the face.
const F32_REL_TOL: f64 = 4.0 * f32::EPSILON as f64;

/// A direction and its vertex, as x and y of the frame: the slope, the vertex, and the displacement from that to the
/// core of the corner.
type CachedSample = [[f32; 2]; 3];

/// A cached face.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CachedFace {
    /// The number of samples; 0 if no face is cached.
    len: f32,
    /// The effective slop of the face, metres.
    pub slop: f32,
    /// The slope that finds corners, a tangent.
    pub slope: f32,
    /// Not 0 if the samples are all corners of a polygon.
    pub is_complete: f32,
    samples: [CachedSample; MAX_FACE_CORNERS],
}

/// Warm start data of the contact manifold of one pair. All zeros: empty.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct ManifoldCache {
    /// The axes of the frame.
    axes: [[f32; 3]; 2],
    /// The effective slop at which the faces were found, metres.
    slop: f32,
    /// The face whose outward normal is along the cross product of the axes, and the opposite face; during a query
    /// the faces of obj1 and obj2.
    pub faces: [CachedFace; 2],
    /// The contacts, x and y in the frame.
    points: [[f32; 2]; MAX_IDS],
    /// The ids of the contacts; 0 for none.
    pub ids: [u32; MAX_IDS],
    /// The id given last.
    last: u32,
}

/// Returns samples whose directions reproduce a polygon of which all corners are known: the outward direction of each
/// side, three directions for a point, and also the two directions along a segment.
fn confirming_samples(
    corners: &Polygon<MAX_FACE_CORNERS>,
    slope: f64,
) -> FixedVec<FaceSample, MAX_FACE_CORNERS> {
    let n = corners.len().max(1);
    let count = [3, 3, 4].get(n).copied().unwrap_or(n);
    let sample = |i: usize| {
        let (last, corner) = (corners.cyclic(i % n + n - 1), corners.cyclic(i % n));
        let slope = match n {
            1 => THREE_DIRECTIONS[i % 3] * slope,
            2 if i > 1 => offset(last, corner).normalize() * slope,
            _ => outwards(last, corner, 1.0 / slope, CACHED_LEAN) * slope,
        };
        FaceSample::new(slope, *corner)
    };
    (0..count).map(sample).collect()
}

impl CachedFace {
    /// Packs the samples that reproduce a face; positions are relative to `origin`.
    fn new(face: &ContactFace, origin: &Vec3) -> Self {
        let samples = if face.is_complete {
            confirming_samples(&face.corners, face.slope)
        } else {
            face.samples
        };
        let mut cached = Self {
            len: samples.len() as f32,
            slop: face.slop as f32,
            slope: face.slope as f32,
            is_complete: f32::from(u8::from(face.is_complete)),
            ..Self::default()
        };
        for (stored, s) in cached.samples.iter_mut().zip(samples.iter()) {
            let to_core = offset(&s.found, &s.corner);
            let parts = [s.slope, offset(origin, &s.found), to_core];
            *stored = parts.map(|v| [v.x as f32, v.y as f32]);
        }
        cached
    }

    /// Returns the slope of each sample, its vertex, and the displacement from that to the core.
    pub fn samples(&self) -> impl Iterator<Item = [Vec2; 3]> + '_ {
        // NaN and negative lengths become 0.
        let samples = self.samples.iter().take(self.len as usize);
        samples.map(|s| s.map(|v| v.map(f64::from).into()))
    }

    /// Returns the rigid motion of the cached vertices to those of `now`; None if they do not match within `slack`,
    /// metres.
    pub fn motion(&self, now: &[FaceSample], slack: f64) -> Option<Motion> {
        let ([_, from, _], to) = (self.samples().next()?, now.first()?.found.xy());
        let spoke =
            |([_, old, _], new): ([Vec2; 3], &FaceSample)| (old - from, new.found.xy() - to);
        let spokes = || self.samples().zip(now).map(spoke);
        let longer = |a: (Vec2, Vec2), b: (Vec2, Vec2)| if b.0.norm() > a.0.norm() { b } else { a };
        let (a, b) = spokes().fold((Vec2::zeros(), Vec2::zeros()), longer);
        let slack = slack + F32_REL_TOL * a.norm();
        let mut rotation = UnitComplex::identity();
        // A face not much larger than the slack has no measurable rotation.
        if a.norm() > 64.0 * slack {
            // Not nalgebra's rotation_between: it goes by the angle, whose functions differ from one C library to the next.
            let turn = Vec2::new(a.dot(&b), a.perp(&b)).normalize();
            rotation = UnitComplex::from_cos_sin_unchecked(turn.x, turn.y);
        }
        let is_one = |(a, b): (Vec2, Vec2)| (rotation * a - b).norm() <= slack;
        let motion = Motion { rotation, from, to };
        spokes().all(is_one).then_some(motion)
    }
}

impl ManifoldCache {
    /// Returns the stored frame, rotated with the normal; None if the cache belongs to another normal. Swaps the faces
    /// if the cache is that of the swapped pair.
    pub fn frame(&mut self, normal: &Vec3) -> Option<ContactFrame> {
        let axes = self.axes.map(|axis| axis.map(f64::from).into());
        let frame = ContactFrame::following(normal, &axes)?;
        self.order_faces(&frame);
        Some(frame)
    }

    /// Converts between the order of the objects and that of the frame's orientation.
    fn order_faces(&mut self, frame: &ContactFrame) {
        if !frame.is_right_handed() {
            self.faces.reverse();
        }
    }

    /// Returns whether the faces were found with this slop or a slightly smaller one. (The slop of a deep overlap
    /// changes with the depth.)
    pub fn has_slop(&self, slop: f64) -> bool {
        let (old, new) = (self.slop, slop as f32);
        0.8 * new <= old && old <= new
    }

    /// Returns the ids of the corners of a region; 0 for a corner without one.
    pub fn ids(
        &self,
        motions: [Option<Motion>; 2],
        region: &Polygon<MAX_CONTACTS>,
        slop: f64,
    ) -> FixedVec<u32, MAX_CONTACTS> {
        let mut ids: FixedVec<u32, MAX_CONTACTS> = region.iter().map(|_| 0).collect();
        let distances = region.iter().map(|c| offset(c, region.cyclic(0)).norm());
        let near = 0.25 * distances.fold(0.0, larger) + slop;
        for (old, id) in self.points.iter().zip(self.ids) {
            // The closest corner without an id.
            let (mut best, mut least) = (MAX_CONTACTS, near);
            for motion in motions.iter().flatten() {
                let now = motion.apply(old.map(f64::from).into());
                for (i, corner) in region.iter().enumerate() {
                    let distance = (corner.xy() - now).norm();
                    if distance < least && ids.get(i) == Some(&0) {
                        (best, least) = (i, distance);
                    }
                }
            }
            if let Some(best) = ids.get_mut(best) {
                *best = id;
            }
        }
        ids
    }

    /// Returns a new id.
    pub fn new_id(&mut self) -> u32 {
        self.last = self.last.wrapping_add(1).max(1);
        self.last
    }

    /// Stores the faces and the contacts with their ids.
    pub fn store(
        &mut self,
        frame: &ContactFrame,
        slop: f64,
        faces: [&ContactFace; 2],
        points: &[(Vec3, u32)],
    ) {
        let origin = faces[0].samples.cyclic(0).found;
        self.axes = frame.axes.map(|axis| axis.map(|x| x as f32).into());
        (self.slop, self.faces) = (
            slop as f32,
            faces.map(|face| CachedFace::new(face, &origin)),
        );
        self.order_faces(frame);
        self.ids = [0; MAX_IDS];
        let places = self.points.iter_mut().zip(&mut self.ids);
        for ((at, id), (place, old)) in points.iter().zip(places) {
            let at = offset(&origin, at);
            (*place, *old) = ([at.x as f32, at.y as f32], *id);
        }
    }
}
