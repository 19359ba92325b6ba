// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the contact face of one object: its corners are support vertices along directions close to the normal.
//!
//! The *drop* of a point is its distance below the support plane of the normal n. The *size* is the largest distance
//! between the vertices found at the slope [`MAX_SLOPE`].
//!
//! 1. *Face.* The face consists of the points with a drop of at most the slop. The support vertex of n + t, with a
//!    small slope t perpendicular to n, maximises t·r − drop(r), r being its position in the contact frame. At
//!    |t| = 2 slop / size, a corner with a drop of half the slop has at least the value of any point size / 4 behind
//!    it along t. If the vertex has a drop greater than the slop, it is not in the face, and half the slope is
//!    evaluated.
//! 2. *All corners.* For each side of two corners, the outward direction in which both have the same value is
//!    evaluated; it finds a corner beyond that side. A face of k corners is complete after 3 + k + (k − 3) support calls.
//!    A curved face becomes an inscribed polygon, whose sides are refined in a fixed order, so that the polygon
//!    moves with the object.
//!    Known failure (1e-5 of faces): inclined faces of which only an edge and one more corner are within the slop.
//!    That corner is missed, because every slope finds the edge or a vertex with a drop greater than the slop.
//! 3. *Rounded corners.* A corner returned by two directions is sharp. Others are evaluated with half the slope: on
//!    a rounded corner of radius R the vertex is p(t) = c + R t, and the *core* c = 2 p(t/2) − p(t) replaces it, if
//!    p(3t/4) is midway between p(t/2) and p(t). Displacements greater than sqrt(slop · size / 2) are not treated as
//!    rounding of a corner.
//! 4. *Cached face* ([`crate::contact::manifold_cache`]). The cached directions are evaluated again. If their vertices
//!    moved as one rigid body, so did the corners; else the face is searched anew.
//!
//! Related: Bullet (`btConvexConvexAlgorithm`) and MuJoCo (`multiccd`) rotate an object by small angles and repeat
//! the whole query; here only the support function is evaluated along inclined normals.

use crate::contact::face::{ContactFace, FaceSample, MAX_FACE_CORNERS, Motion, THREE_DIRECTIONS};
use crate::contact::frame::{ContactFrame, outwards};
use crate::contact::manifold_cache::{CachedFace, ManifoldCache};
use crate::contact::tuning::{
    MAX_SLOPE, MIN_SLOP_REL, MIN_SLOP_ROUNDINGS, ROUND_CORNER_REL, ROUND_CORNER_SLOPS,
};
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Polygon, Vec2, offset};
use crate::math::{EPSILON, Vec3, larger, lesser, max_abs};
use crate::minkowski::support::{Fault, SupportMap};
use core::mem::swap;

/// Limit on the support calls of one object: eight corners, each found twice, and the size.
const MAX_CALLS: u32 = 24;

/// Finds both faces, cached or anew. Returns them with the effective slop: the larger of the caller's and the least
/// slop for the depth.
///
/// # Errors
/// [`Fault::NonFinite`].
pub fn faces<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    frame: &ContactFrame,
    slop: f64,
    cache: Option<&ManifoldCache>,
) -> Result<([ContactFace; 2], f64), Fault> {
    let mut one = FaceSearch::new(obj1, frame, 1.0);
    let mut two = FaceSearch::new(obj2, frame, -1.0);
    one.confirm_cached_or_find_plane(cache.map(|cache| &cache.faces[0]))?;
    two.confirm_cached_or_find_plane(cache.map(|cache| &cache.faces[1]))?;
    let depth = one.face.support_height + two.face.support_height;
    let slop = larger(slop, MIN_SLOP_REL * depth);
    let has_slop = cache.is_some_and(|cache| cache.has_slop(slop));
    one.find_face(slop, has_slop)?;
    two.find_face(slop, has_slop)?;
    Ok(([one.face, two.face], slop))
}

/// State of the search for the corners of one face.
struct FaceSearch<'a, S> {
    object: &'a S,
    frame: &'a ContactFrame,
    /// 1 for obj1, -1 for obj2: the outward normal is this times the normal of the frame.
    sign: f64,
    /// The number of support calls.
    calls: u32,
    /// The vertex on the support plane.
    first: FaceSample,
    /// The face, as far as it is known.
    face: ContactFace,
}

impl<'a, S: SupportMap> FaceSearch<'a, S> {
    /// Makes a search without support calls.
    fn new(object: &'a S, frame: &'a ContactFrame, sign: f64) -> Self {
        FaceSearch {
            object,
            frame,
            sign,
            calls: 0,
            first: FaceSample::default(),
            face: ContactFace::default(),
        }
    }

    /// Evaluates the object along the inclined outward normal.
    fn evaluate(&mut self, slope: Vec2) -> Result<FaceSample, Fault> {
        let dir = self.frame.inclined_direction(self.sign, slope);
        let p = self.object.support(&dir);
        self.calls += 1;
        self.face.coord_eps = larger(self.face.coord_eps, 8.0 * EPSILON * max_abs(&p));
        let mut found = self.frame.project(&p)?;
        found.z = self.face.support_height - self.sign * found.z;
        Ok(FaceSample::new(slope, found))
    }

    /// Evaluates a candidate for a corner: with the slope and, if that vertex is not in the face, with half of it.
    fn evaluate_corner(&mut self, slope: Vec2) -> Result<FaceSample, Fault> {
        let new = self.evaluate(slope)?;
        if new.found.z <= self.face.slop {
            return Ok(new);
        }
        self.evaluate(slope * 0.5)
    }

    /// Confirms the cached face or, if it has changed, evaluates the support plane.
    fn confirm_cached_or_find_plane(&mut self, cached: Option<&CachedFace>) -> Result<(), Fault> {
        if let Some(cached) = cached {
            self.face.motion = self.confirm_cached(cached)?;
        }
        if self.face.motion.is_none() {
            self.evaluate_support_plane()?;
        }
        Ok(())
    }

    /// Evaluates the support plane.
    fn evaluate_support_plane(&mut self) -> Result<(), Fault> {
        self.face.support_height = 0.0;
        self.first = self.evaluate(Vec2::zeros())?;
        self.face.support_height = -self.first.found.z;
        (self.first.found.z, self.first.corner.z) = (0.0, 0.0);
        Ok(())
    }

    /// Finds the face anew, unless it is the cached one with the same slop; then makes its polygon.
    fn find_face(&mut self, slop: f64, has_slop: bool) -> Result<(), Fault> {
        if self.face.motion.is_none() || !has_slop {
            if self.face.motion.is_some() {
                self.evaluate_support_plane()?;
            }
            self.face.samples = FixedVec::default();
            self.calls = 1;
            self.find_first_corners(slop)?;
            if self.face.samples.len() > 1 {
                self.find_remaining_corners()?;
            }
            for i in 0..self.face.samples.len() {
                self.find_core(i)?;
            }
            for i in 0..self.face.samples.len() {
                if let Some(rounded) = self.rounded_corner_at(self.face.samples.cyclic(i)) {
                    let sample = self.face.samples.cyclic_mut(i);
                    (sample.corner, sample.radius) = (rounded.corner, rounded.radius);
                }
            }
        }
        self.build_polygon();
        Ok(())
    }

    /// Finds the size and the first corners.
    fn find_first_corners(&mut self, slop: f64) -> Result<(), Fault> {
        let mut size = 0.0;
        let mut wide = [self.first; 3];
        for i in 0..3 {
            let new = self.evaluate(THREE_DIRECTIONS[i] * MAX_SLOPE)?;
            for known in &wide {
                size = larger(size, offset(&known.found, &new.found).norm());
            }
            wide[i] = new;
        }
        // At most the size of the face, at least some rounding errors.
        self.face.slop = slop.min(size).max(MIN_SLOP_ROUNDINGS * self.face.coord_eps);
        if size > self.face.coord_eps {
            self.face.slope = lesser(2.0 * self.face.slop / size, MAX_SLOPE);
            for mut new in wide {
                if new.found.z > self.face.slop {
                    new = self.evaluate_corner(new.slope * (self.face.slope / MAX_SLOPE))?;
                }
                if new.found.z <= self.face.slop && !self.mark_if_found(&new) {
                    self.face.samples.push(new);
                }
            }
        }
        let first = self.first;
        if !self.mark_if_found(&first) && self.face.samples.len() < 2 {
            self.face.samples.push(first);
        }
        if let [a, b, c] = &mut *self.face.samples {
            if offset(&a.found, &b.found).perp(&offset(&a.found, &c.found)) < 0.0 {
                swap(b, c);
            }
        }
        Ok(())
    }

    /// Returns whether the vertices of two samples are the same within rounding.
    fn is_same(&self, a: &FaceSample, b: &FaceSample) -> bool {
        max_abs(&(a.found - b.found)) <= self.face.coord_eps
    }

    /// Returns whether two samples may be of one rounded corner.
    fn is_near(&self, a: &FaceSample, b: &FaceSample) -> bool {
        offset(&a.found, &b.found).norm() <= ROUND_CORNER_SLOPS * self.face.slop
    }

    /// Returns whether a vertex was found before. If so, and if the directions differ, marks it as sharp.
    fn mark_if_found(&mut self, new: &FaceSample) -> bool {
        let samples = &self.face.samples;
        let known = (0..samples.len()).find(|i| self.is_same(samples.cyclic(*i), new));
        if let Some(i) = known {
            let slope_change = (samples.cyclic(i).slope - new.slope).norm();
            let is_sharp = slope_change >= 0.25 * self.face.slope;
            self.face.samples.cyclic_mut(i).has_core |= is_sharp;
        }
        known.is_some()
    }

    /// Finds the corners between the first ones, around the face until every side is complete.
    fn find_remaining_corners(&mut self) -> Result<(), Fault> {
        let (mut i, mut complete_count) = (0, 0);
        while complete_count < self.face.samples.len() {
            i %= self.face.samples.len();
            complete_count += 1;
            if !self.face.samples.cyclic(i).is_side_complete {
                if let Some(new) = self.find_corner_beyond_side(i)? {
                    self.face.samples.insert(i + 1, new);
                    i += 1;
                    complete_count = 0;
                } else {
                    self.face.samples.cyclic_mut(i).is_side_complete = true;
                }
            }
            i += 1;
        }
        Ok(())
    }

    /// Finds the corner beyond the side from sample `i` to the next; None if there is none.
    fn find_corner_beyond_side(&mut self, i: usize) -> Result<Option<FaceSample>, Fault> {
        // A corner costs up to two support calls, and each unknown core one.
        let is_last = self.calls + 2 + self.unknown_cores() > MAX_CALLS;
        if self.face.samples.len() == MAX_FACE_CORNERS || is_last {
            return Ok(None);
        }
        let [a, b] = [i, i + 1].map(|i| self.face.samples.cyclic(i).found);
        let (length, slope) = (offset(&a, &b).norm(), self.face.slope);
        let out = outwards(&a, &b, 1.0 / slope, 0.0);
        let new = self.evaluate_corner(out * slope)?;
        if new.found.z > self.face.slop || self.mark_if_found(&new) {
            return Ok(None);
        }
        // Another sample of a rounded corner is not a new corner.
        let [to_a, to_b] = [a, b].map(|end| offset(&end, &new.found).norm());
        let end = if to_a < to_b { i } else { i + 1 };
        if self.is_near(self.face.samples.cyclic(end), &new) {
            self.find_core(end)?;
            if self.rounded_corner_at(&new).is_some() || self.mark_if_found(&new) {
                return Ok(None);
            }
        }
        let beyond = offset(&a, &new.found).perp(&offset(&a, &b));
        Ok((beyond > self.min_corner_height() * length).then_some(new))
    }

    /// Returns the least height of a corner beyond a side, metres. Rounding errors and remaining roundings of corners
    /// are smaller.
    fn min_corner_height(&self) -> f64 {
        self.face.coord_eps + self.face.slope * self.face.slop
    }

    /// Finds the core of the corner of sample `i`, whose vertex moves in proportion to the slope if it is rounded.
    fn find_core(&mut self, i: usize) -> Result<(), Fault> {
        let mut full = *self.face.samples.cyclic(i);
        if full.has_core || self.calls >= MAX_CALLS {
            return Ok(());
        }
        self.face.samples.cyclic_mut(i).has_core = true;
        if self.rounded_corner_at(&full).is_some() {
            return Ok(());
        }
        let scale = self.face.slope / full.slope.norm();
        if scale < 0.5 {
            // The sample is one of the first directions, with a wide slope.
            let new = self.evaluate(full.slope * scale)?;
            if self.mark_if_found(&new) {
                return Ok(());
            }
            full = new;
        }
        if self.calls < MAX_CALLS {
            let near = self.evaluate(full.slope * 0.5)?;
            let moved = offset(&near.found, &full.found).norm();
            let max_moved = self.face.slop / self.face.slope.sqrt();
            let may_be_round = !self.is_same(&full, &near) && moved <= max_moved;
            if may_be_round && self.is_round_between(&near, &full)? {
                full.radius = moved / (full.slope - near.slope).norm();
                full.corner = near.found * 2.0 - full.found;
                full.corner.z = larger((4.0 * near.found.z - full.found.z) / 3.0, 0.0);
            }
        }
        *self.face.samples.cyclic_mut(i) = FaceSample {
            has_core: true,
            is_side_complete: self.face.samples.cyclic(i).is_side_complete,
            ..full
        };
        Ok(())
    }

    /// Returns whether two samples, at a slope and at half of it, are of one rounded corner, not two sharp ones: their drops
    /// are as p(t) has them, and the vertex between them is midway, unless the support call for it is needed for another core.
    fn is_round_between(&mut self, near: &FaceSample, full: &FaceSample) -> Result<bool, Fault> {
        let moved = offset(&near.found, &full.found);
        // c + R t has the drop R t²/2 below c.
        let drop = 0.75 * moved.dot(&full.slope);
        let off = (full.found.z - near.found.z - drop).abs();
        if off > ROUND_CORNER_REL * drop + self.face.coord_eps {
            return Ok(false);
        }
        if self.calls + self.unknown_cores() >= MAX_CALLS {
            return Ok(true);
        }
        let middle = self.evaluate((near.slope + full.slope) * 0.5)?;
        let off = offset(&((near.found + full.found) * 0.5), &middle.found).norm();
        Ok(off <= ROUND_CORNER_REL * moved.norm() + self.face.coord_eps)
    }

    /// Returns the number of samples whose core is not known, each of which costs a support call.
    fn unknown_cores(&self) -> u32 {
        self.face.samples.iter().filter(|s| !s.has_core).count() as u32
    }

    /// Returns the sample of the rounded corner to which another sample belongs.
    fn rounded_corner_at(&self, new: &FaceSample) -> Option<FaceSample> {
        let mut rounded = self.face.samples.iter().filter(|s| s.radius > 0.0);
        rounded.find(|s| self.is_near(s, new)).copied()
    }

    /// Makes the polygon of the samples.
    fn build_polygon(&mut self) {
        // A corner found twice may differ by the rounding of both.
        let merged = larger(self.face.slop, MIN_SLOP_ROUNDINGS * self.face.coord_eps);
        let samples = self.face.samples;
        let corners: Polygon<MAX_FACE_CORNERS> = samples.iter().map(|s| s.corner).collect();
        let corners = corners.simplified(merged, self.min_corner_height());
        let radii = samples.iter().map(|s| s.radius);
        let radius = radii.fold(f64::INFINITY, lesser);
        // A full list may lack corners, and the support plane may be higher than all corners.
        let is_sharp = samples.iter().all(|s| s.corner == s.found);
        let has_highest = corners.iter().any(|corner| corner.z <= self.face.coord_eps);
        self.face.is_complete = is_sharp && has_highest && samples.len() < MAX_FACE_CORNERS;
        self.face.rounded_halfwidth = (2.0 * radius * self.face.slop).sqrt();
        self.face.corners = corners;
    }

    /// Evaluates the cached directions. Returns the motion of the cached face; None if the face has changed.
    fn confirm_cached(&mut self, cached: &CachedFace) -> Result<Option<Motion>, Fault> {
        for [slope, ..] in cached.samples() {
            // Fails for NaN and for a zero slope too.
            if !(slope.norm() > 0.0 && slope.norm() <= 0.5) {
                return Ok(None);
            }
            let new = self.evaluate(slope)?;
            self.face.samples.push(new);
        }
        let slop = larger(f64::from(cached.slop), self.face.coord_eps);
        (self.face.slop, self.face.slope) = (slop, cached.slope.into());
        let slack = 0.25 * slop + self.face.coord_eps;
        let Some(motion) = cached.motion(&self.face.samples, slack) else {
            return Ok(None);
        };
        for (new, [slope, _, offset]) in self.face.samples.iter_mut().zip(cached.samples()) {
            let drop = 0.5 * offset.dot(&slope);
            new.radius = offset.norm() / slope.norm();
            let offset = motion.rotation * offset;
            new.corner += Vec3::new(offset.x, offset.y, drop);
            new.slope = motion.rotation * slope;
        }
        if cached.is_complete != 0.0 {
            let heights = self.face.samples.iter().map(|s| -s.corner.z);
            self.face.support_height = heights.fold(f64::NEG_INFINITY, larger);
        } else {
            self.evaluate_support_plane()?;
        }
        let height = self.face.support_height;
        for sample in self.face.samples.iter_mut() {
            sample.found.z += height;
            sample.corner.z = larger(sample.corner.z + height, 0.0);
        }
        let is_outside = |s: &FaceSample| s.corner.z > slop + self.face.coord_eps;
        Ok((!self.face.samples.iter().any(is_outside)).then_some(motion))
    }
}
