// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The polygon of an object in a contact, and its overlap with a plane: the volume between them, in depths, with the deepest
//! point as the apex of all triangles.

use crate::geometry::polygon::{Polygon, Vec2};
use crate::math::{Vec3, larger};

/// Largest number of corners of a contact polygon.
pub const MAX_POLYGON_CORNERS: usize = 12;
/// The polygon of an object in a contact.
pub type ContactPolygon = Polygon<MAX_POLYGON_CORNERS>;

/// The overlap of a polygon with a plane.
#[derive(Clone, Copy)]
pub struct Overlap {
    /// Twice the volume, in depths, m².
    pub volume: f64,
    /// The sum of its vertices, metres.
    pub sum: Vec2,
    /// The number of its vertices.
    pub count: f64,
}

impl Overlap {
    /// No overlap.
    pub const EMPTY: Self = Self {
        volume: 0.0,
        sum: Vec2::new(0.0, 0.0),
        count: 0.0,
    };

    /// Adds a vertex and a volume.
    #[inline(always)]
    pub fn add(&mut self, volume: f64, v: &Vec3) {
        self.volume += volume;
        self.sum += v.xy();
        self.count += 1.0;
    }
}

/// Returns twice the volume over the triangle of the deepest point and two vertices, in depths.
#[inline(always)]
pub fn volume_of(a: &Vec3, b: &Vec3) -> f64 {
    a.xy().perp(&b.xy()) * (1.0 - (a.z + b.z) * (1.0 / 3.0))
}

/// Returns twice the volume, in depths, by which a vertex beyond the side from `a` to `b` enlarges the overlap.
#[inline(always)]
pub fn volume_beyond(a: &Vec3, at: &Vec3, b: &Vec3) -> f64 {
    volume_of(a, at) + volume_of(at, b) - volume_of(a, b)
}

/// Returns a vertex raised by the common drop; if it is then below the overlap (a drop above 1), the point of its ray from
/// the deepest point at which the linear drop is 1.
#[inline(always)]
pub fn in_overlap(v: &Vec3, common: f64) -> Vec3 {
    let z = larger(v.z - common, 0.0);
    if z <= 1.0 {
        return Vec3::new(v.x, v.y, z);
    }
    let scale = 1.0 / z;
    Vec3::new(v.x * scale, v.y * scale, 1.0)
}
