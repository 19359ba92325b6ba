// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Ready support functions of the usual shapes, with the bits of C's `ccd/shapes.h`.
//!
//! ```
//! use ccd::{Settings, shapes::Posed};
//!
//! let slab = Posed::cuboid([2.0, 2.0, 0.5]);
//! let ball = Posed::sphere(0.5).at([1.9, 0.0, 0.9]);
//! let hit = ccd::penetration(&slab, &ball, &Settings::new(1e-6), None)?.expect("an overlap");
//! assert!((hit.depth - 0.1).abs() < 1e-3);
//! # Ok::<(), ccd::Error>(())
//! ```
//!
//! Sizes are metres, none negative; zero makes a flat shape, a segment or a point. A support point is exact
//! along the axes of a shape that is not rotated, and elsewhere off by a few roundings.

use crate::api::Shape;
use crate::math::Real;

/// Points of a convex hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<'a> {
    points: &'a [[Real; 3]],
    /// Where the neighbors of each point begin, and all neighbors.
    neighbors: Option<(&'a [usize], &'a [usize])>,
    mean: [Real; 3],
    /// The farthest points along x, y, z, -x, -y, -z.
    start: [usize; 6],
}

/// The kinds of shapes; the axis of a capsule, a cylinder and a cone is z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind<'a> {
    /// A ball of this radius.
    Sphere(Real),
    /// Radius, half length of the segment between the centers of its ends.
    Capsule(Real, Real),
    /// Half lengths of the edges.
    Cuboid([Real; 3]),
    /// Radius, half height.
    Cylinder(Real, Real),
    /// Radius, half height; the tip is at +z, the base at -z.
    Cone(Real, Real),
    /// Half axes.
    Ellipsoid([Real; 3]),
    /// The convex hull of points.
    Hull(Hull<'a>),
}

/// A shape with its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed<'a> {
    /// Which shape, and its sizes.
    pub kind: Kind<'a>,
    /// Position of the shape's own origin.
    pub pos: [Real; 3],
    /// Rotation, a unit quaternion (x, y, z, w); all zeros: none.
    pub quat: [Real; 4],
}

impl<'a> Posed<'a> {
    /// Returns a shape at the origin, not rotated.
    #[inline]
    pub const fn new(kind: Kind<'a>) -> Self {
        let (pos, quat) = ([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
        Posed { kind, pos, quat }
    }

    /// Returns a sphere at the origin.
    #[inline]
    pub const fn sphere(radius: Real) -> Self {
        Posed::new(Kind::Sphere(radius))
    }

    /// Returns a capsule along z; `half`: half the length of the segment between the centers of its ends.
    #[inline]
    pub const fn capsule(radius: Real, half: Real) -> Self {
        Posed::new(Kind::Capsule(radius, half))
    }

    /// Returns a box with these half lengths of its edges.
    #[inline]
    pub const fn cuboid(half: [Real; 3]) -> Self {
        Posed::new(Kind::Cuboid(half))
    }

    /// Returns a cylinder along z; `half`: half its height.
    #[inline]
    pub const fn cylinder(radius: Real, half: Real) -> Self {
        Posed::new(Kind::Cylinder(radius, half))
    }

    /// Returns a cone along z with its tip at z = `half`, its base at z = -`half`.
    #[inline]
    pub const fn cone(radius: Real, half: Real) -> Self {
        Posed::new(Kind::Cone(radius, half))
    }

    /// Returns an ellipsoid with these half axes.
    #[inline]
    pub const fn ellipsoid(half: [Real; 3]) -> Self {
        Posed::new(Kind::Ellipsoid(half))
    }

    /// Returns the convex hull of points, at least one; every call scans all of them.
    ///
    /// # Panics
    /// Without a point.
    #[inline]
    pub fn hull(points: &'a [[Real; 3]]) -> Self {
        let mean = [0, 1, 2].map(|k| {
            let sum = points.iter().fold(0.0, |sum, p| sum + f64::from(p[k]));
            (sum / points.len() as f64) as Real
        });
        let start = [0, 1, 2, 3, 4, 5].map(|i| {
            let mut d = [0.0; 3];
            d[i % 3] = if i < 3 { 1.0 } else { -1.0 };
            scan(points, &d)
        });
        let neighbors = None;
        Posed::new(Kind::Hull(Hull {
            points,
            neighbors,
            mean,
            start,
        }))
    }

    /// Returns the convex hull of points that are all corners of it. The neighbors of point `i` along its
    /// edges are `neighbors[first[i]..first[i + 1]]`: calls climb from point to point, which is faster from
    /// about 100 points on. If an edge is missing, a support point may be wrong.
    ///
    /// # Panics
    /// Without a point; a call, at an index beyond a slice.
    #[inline]
    pub fn hull_with_neighbors(
        points: &'a [[Real; 3]],
        first: &'a [usize],
        neighbors: &'a [usize],
    ) -> Self {
        let mut posed = Posed::hull(points);
        if let Kind::Hull(hull) = &mut posed.kind {
            hull.neighbors = Some((first, neighbors));
        }
        posed
    }

    /// Returns the shape at a position.
    #[inline]
    pub const fn at(self, pos: [Real; 3]) -> Self {
        Posed { pos, ..self }
    }

    /// Returns the shape with a rotation, a unit quaternion (x, y, z, w).
    #[inline]
    pub const fn turned(self, quat: [Real; 4]) -> Self {
        Posed { quat, ..self }
    }

    /// Returns a point of the shape's own frame in the world.
    #[inline]
    fn world_point(&self, p: &[Real; 3]) -> [Real; 3] {
        let [p, at] = [rotate(p, &self.quat), self.pos];
        [p[0] + at[0], p[1] + at[1], p[2] + at[2]]
    }
}

impl Shape for Posed<'_> {
    #[inline]
    fn support(&self, dir: [Real; 3]) -> [Real; 3] {
        // The matrix of the opposite rotation is the transposed one.
        let [x, y, z, w] = self.quat;
        let d = rotate(&dir, &[-x, -y, -z, w]);
        self.world_point(&match self.kind {
            Kind::Sphere(radius) => sphere(radius, &d),
            Kind::Capsule(radius, half) => {
                let [x, y, z] = sphere(radius, &d);
                [x, y, z + half.copysign(d[2])]
            }
            Kind::Cuboid(half) => [0, 1, 2].map(|i| half[i].copysign(d[i])),
            Kind::Cylinder(radius, half) => {
                let [x, y] = rim(radius, &d);
                [x, y, half.copysign(d[2])]
            }
            Kind::Cone(radius, half) => {
                let [x, y] = rim(radius, &d);
                if 2.0 * half * d[2] - (x * d[0] + y * d[1]) >= 0.0 {
                    [0.0, 0.0, half]
                } else {
                    [x, y, -half]
                }
            }
            Kind::Ellipsoid(half) => {
                let (e, length) = with_length([0, 1, 2].map(|i| half[i] * d[i]));
                // A flat one: its center.
                let length = if length > 0.0 { length } else { 1.0 };
                [0, 1, 2].map(|i| half[i] * (e[i] / length))
            }
            Kind::Hull(hull) => hull.points[hull.farthest(&d)],
        })
    }

    #[inline]
    fn center(&self) -> Option<[Real; 3]> {
        let inside = match self.kind {
            Kind::Hull(hull) => hull.mean,
            _ => [0.0; 3],
        };
        Some(self.world_point(&inside))
    }
}

impl Hull<'_> {
    /// Returns the index of a farthest point along `d`: by hill climbing from the farthest point along the axis
    /// that is closest to `d`. Ends, because the value of each point is above the last one's.
    #[inline]
    fn farthest(&self, d: &[Real; 3]) -> usize {
        let Some((first, neighbors)) = self.neighbors else {
            return scan(self.points, d);
        };
        let mut axis = 0;
        for i in 1..3 {
            axis = if d[i].abs() > d[axis].abs() { i } else { axis };
        }
        let mut best = self.start[if d[axis] < 0.0 { axis + 3 } else { axis }];
        let mut most = value(&self.points[best], d);
        loop {
            let at = best;
            for &i in &neighbors[first[at]..first[at + 1]] {
                let value = value(&self.points[i], d);
                if value > most {
                    (most, best) = (value, i);
                }
            }
            if best == at {
                return best;
            }
        }
    }
}

/// Returns the index of the farthest point along `d`, the first of equal ones.
#[inline]
fn scan(points: &[[Real; 3]], d: &[Real; 3]) -> usize {
    let (mut best, mut most) = (0, value(&points[0], d));
    for (i, p) in points.iter().enumerate().skip(1) {
        let value = value(p, d);
        if value > most {
            (most, best) = (value, i);
        }
    }
    best
}

/// Returns how far a point is along `d`.
#[inline]
fn value(p: &[Real; 3], d: &[Real; 3]) -> Real {
    p[0] * d[0] + p[1] * d[1] + p[2] * d[2]
}

/// Rotates `v` by the quaternion (u, w): v + 2 u x (u x v + w v).
#[inline]
fn rotate(&[vx, vy, vz]: &[Real; 3], &[ux, uy, uz, w]: &[Real; 4]) -> [Real; 3] {
    let cx = uy * vz - uz * vy + w * vx;
    let cy = uz * vx - ux * vz + w * vy;
    let cz = ux * vy - uy * vx + w * vz;
    [
        vx + 2.0 * (uy * cz - uz * cy),
        vy + 2.0 * (uz * cx - ux * cz),
        vz + 2.0 * (ux * cy - uy * cx),
    ]
}

/// Returns the point of a ball farthest along `d`.
#[inline]
fn sphere(radius: Real, d: &[Real; 3]) -> [Real; 3] {
    let (e, length) = with_length(*d);
    let scale = if length > 0.0 { radius / length } else { 0.0 };
    e.map(|x| x * scale)
}

/// Returns x and y of the point of a disc around the z axis farthest along `d`.
#[inline]
fn rim(radius: Real, d: &[Real; 3]) -> [Real; 2] {
    let (e, length) = with_length([d[0], d[1], 0.0]);
    if length > 0.0 {
        [radius * (e[0] / length), radius * (e[1] / length)]
    } else {
        [radius.copysign(d[0]), 0.0]
    }
}

/// Returns `v` and its length, zero only if `v` is; a scaled `v` where its square under- or overflows.
#[inline]
fn with_length(v: [Real; 3]) -> ([Real; 3], Real) {
    let square = |v: &[Real; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let squared = square(&v);
    // Squares below lose digits.
    if squared > Real::MIN_POSITIVE / Real::EPSILON && squared <= Real::MAX {
        return (v, squared.sqrt());
    }
    let most = v
        .iter()
        .fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most });
    if !(most > 0.0) {
        return (v, 0.0);
    }
    let v = v.map(|x| x / most);
    (v, square(&v).sqrt())
}
