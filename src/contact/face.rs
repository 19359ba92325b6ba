// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The face of one object in a contact: its corners, the samples that found them, and its motion since the last query.

use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Polygon, Vec2, offset};
use crate::math::{Vec3, larger};
use nalgebra::UnitComplex;

/// Largest number of corners of a face: one more than eight, so that a face of eight is known to be complete.
pub const MAX_FACE_CORNERS: usize = 9;
/// The first three slope directions, unit.
pub const THREE_DIRECTIONS: [Vec2; 3] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(-0.5, 0.866_025_403_784_438_6),
    Vec2::new(-0.5, -0.866_025_403_784_438_6),
];
/// Largest number of corners of a region: each side of one face adds at most one to the corners of the other.
pub const MAX_CONTACTS: usize = 2 * MAX_FACE_CORNERS;

/// A support vertex in the contact frame (z: its drop), and its direction.
#[derive(Clone, Copy, Default)]
pub struct FaceSample {
    /// The slope of its direction.
    pub slope: Vec2,
    /// The vertex.
    pub found: Vec3,
    /// The core: the corner without its rounding, if `has_core`; else the vertex.
    pub corner: Vec3,
    /// Radius of the rounded corner, metres; 0 for a sharp one.
    pub radius: f64,
    /// True if the rounding of the corner was removed or the corner is sharp.
    pub has_core: bool,
    /// True if there is no corner beyond the side to the next sample, or no query is left to find one.
    pub is_side_complete: bool,
}

impl FaceSample {
    /// Makes the sample of an inclined direction and its vertex.
    pub fn new(slope: Vec2, found: Vec3) -> Self {
        Self {
            slope,
            found,
            corner: found,
            ..Self::default()
        }
    }
}

/// The face of one object.
#[derive(Clone, Copy, Default)]
pub struct ContactFace {
    pub corners: Polygon<MAX_FACE_CORNERS>,
    /// Height of the support plane along the outward normal, metres.
    pub support_height: f64,
    /// The effective slop, metres.
    pub slop: f64,
    /// The rounding error of a coordinate, metres.
    pub coord_eps: f64,
    /// Distance from the corners at which their rounded surface has a drop of the slop, sqrt(2 R slop), metres, for
    /// the smallest radius R.
    pub rounded_halfwidth: f64,
    /// The samples that found the corners, in their order.
    pub samples: FixedVec<FaceSample, MAX_FACE_CORNERS>,
    /// The slope that finds corners, a tangent.
    pub slope: f64,
    /// True if all corners are known and sharp.
    pub is_complete: bool,
    /// Motion since the last query, if the face is the cached one.
    pub motion: Option<Motion>,
}

/// Rigid motion of a face in the frame from one query to the next.
#[derive(Clone, Copy)]
pub struct Motion {
    /// The rotation about the normal.
    pub rotation: UnitComplex<f64>,
    /// The old position of one vertex.
    pub from: Vec2,
    /// Its new position.
    pub to: Vec2,
}

impl ContactFace {
    /// Returns the distance from the face within which a contact may lie, metres: half the slop; for a segment that
    /// is long compared with its rounding, at least the rounded half-width. (For a short segment, e.g. a part of a
    /// curved rim, the rounding is along it and not perpendicular to it.)
    pub fn contact_halfwidth(&self) -> f64 {
        match &*self.corners {
            [a, b] if offset(a, b).norm() > 2.0 * self.rounded_halfwidth => {
                larger(self.rounded_halfwidth, 0.5 * self.slop)
            }
            _ => 0.5 * self.slop,
        }
    }
}

impl Motion {
    /// Returns the new position of a point that moves with the face.
    pub fn apply(&self, at: Vec2) -> Vec2 {
        self.to + self.rotation * (at - self.from)
    }
}
