// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The witness points of the upper bound, from the polytope of the lower bound.

use crate::epa::polytope::EpaPolytope;
use crate::geometry::barycentric::triangle;
use crate::math::{Vec3, lesser};
use crate::minkowski::support::SupportPoint;
use crate::minkowski::support_query::SupportPlane;
use crate::minkowski::vertex_set::{Vertex, VertexSet};

/// Returns the witness points of the upper bound. They are those of the point closest to the foot, depth · dir, on
/// one of these triangles:
///
/// 1. the face, if that point is close enough to the foot ([`max_foot_distance2`] of `gap`, metres);
/// 2. otherwise, if closer, the face with one corner replaced by the support point of the direction.
///
/// Returns them with the square of that distance, m².
#[inline(always)]
pub fn witness_points<const N: usize>(
    upper: &SupportPlane,
    interior: &SupportPoint,
    set: &VertexSet<N>,
    face: &[Vertex; 3],
    gap: f64,
) -> ([Vec3; 2], f64) {
    let foot = upper.dir * upper.depth;
    let closest = |[a, b, c]: &[Vec3; 3]| triangle(&foot, a, b, c);
    let corners = face.each_ref().map(|v| v.w);
    let mut best = closest(&corners);
    let mut replaced = None;
    if best.distance2 > max_foot_distance2(upper, gap) {
        for i in 0..3 {
            let mut triangle = corners;
            triangle[i] = upper.point.v;
            let other = closest(&triangle);
            if other.distance2 < best.distance2 {
                (best, replaced) = (other, Some(i));
            }
        }
    }
    let mut points = [Vec3::zeros(); 2];
    for (i, (weight, v)) in best.weights.iter().zip(face).enumerate() {
        let point = match replaced {
            Some(k) if k == i => upper.point,
            _ if v.pair.is_interior() => *interior,
            _ => set.point(v.pair),
        };
        points[0] += point.v1 * *weight;
        points[1] += point.v2 * *weight;
    }
    (points, best.distance2)
}

/// Returns the square of the distance from the foot, m², within which a face is as good as any other.
pub fn max_foot_distance2(upper: &SupportPlane, gap: f64) -> f64 {
    gap * lesser(gap, upper.depth)
}

/// Returns the corners of the face through which the ray along the direction of the upper bound leaves the polytope,
/// approximately.
///
/// This is the closest face, `closest`, if it is close enough to the foot, depth · dir ([`max_foot_distance2`] of `gap`,
/// metres). Otherwise it is the face closest to the foot among those whose plane the ray crosses before the depth plus the
/// gap: several faces may lie in one plane.
pub fn exit_face<const N: usize, const F: usize>(
    upper: &SupportPlane,
    interior: &Vec3,
    set: &VertexSet<N>,
    polytope: &EpaPolytope<F>,
    closest: usize,
    gap: f64,
) -> [Vertex; 3] {
    let foot = upper.dir * upper.depth;
    let distance2 = |f: usize| {
        let [a, b, c] = polytope.face(set, interior, f).map(|v| v.w);
        triangle(&foot, &a, &b, &c).distance2
    };
    let mut best = (closest, distance2(closest));
    if best.1 > max_foot_distance2(upper, gap) {
        for f in polytope.faces() {
            let rise = polytope.normal(f).dot(&upper.dir);
            if rise > 0.0 && polytope.offset(f) <= rise * (upper.depth + gap) {
                let other = distance2(f);
                if other < best.1 {
                    best = (f, other);
                }
            }
        }
    }
    polytope.face(set, interior, best.0)
}
