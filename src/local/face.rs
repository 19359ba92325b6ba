// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A face of the inner model, with its foot: the projection of the origin on its plane ([`crate::local`]).

use crate::math::{Vec3, lesser, normalise_unscaled};
use crate::minkowski::vertex_set::Vertex;

/// A face of the inner model: the last portal of a ray.
#[derive(Clone, Copy)]
pub struct Face {
    pub corners: [Vertex; 3],
    /// Unit, outward.
    pub normal: Vec3,
    /// The distance of its plane from the origin, metres.
    pub offset: f64,
}

impl Face {
    /// Returns the face of three corners with the outward normal `n`, of any length; `None` if they lie on a line.
    pub fn new(corners: &[Vertex; 3], n: &Vec3) -> Option<Self> {
        let normal = normalise_unscaled(n)?;
        Some(Self {
            corners: *corners,
            normal,
            offset: normal.dot(&corners[0].w),
        })
    }

    /// Returns whether the foot is in the face, or at most `eps`, metres, outside.
    pub fn has_foot(&self, eps: f64) -> bool {
        (0..3).all(|i| {
            let (side, length2) = self.side(i);
            side >= 0.0 || side * side <= eps * eps * length2
        })
    }

    /// Returns the distance of the foot from the closest edge, metres; negative outside the face.
    pub fn foot_depth(&self) -> f64 {
        (0..3).fold(f64::INFINITY, |least, i| {
            let (side, length2) = self.side(i);
            lesser(side / length2.sqrt(), least)
        })
    }

    /// Returns the distance of the foot from the line of edge `i`, positive inside, times the length of the edge;
    /// and the square of that length.
    fn side(&self, i: usize) -> (f64, f64) {
        let edge = self.corners[(i + 1) % 3].w - self.corners[i].w;
        // The foot is on the normal.
        let side = -self.normal.dot(&edge.cross(&self.corners[i].w));
        (side, edge.norm_squared())
    }
}
