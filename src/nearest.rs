// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The point of a segment or a triangle nearest to a given point.
//!
//! Projection by modified Gram-Schmidt and the search of the violated edges only
//! (the regions are those of Ericson, Real-Time Collision Detection, 5.1.5). libccd
//! solves the normal equations, whose condition is the square of the triangle's, and
//! calls a triangle degenerate by an absolute area; here no triangle is special.

use crate::math::{Real, Vec3};

/// The point of segment `ab` nearest to `p` and its squared distance, m².
///
/// An end that is nearest is returned bit for bit. Equal ends are a point.
#[inline]
pub fn on_segment(p: &Vec3, a: &Vec3, b: &Vec3) -> (Vec3, Real) {
    let ab = b - a;
    let t = (p - a).dot(&ab) / ab.norm_squared();
    // 0/0 of equal ends is NaN and lands at `a`.
    let nearest = if t >= 1.0 {
        *b
    } else if t > 0.0 {
        a + ab * t
    } else {
        *a
    };
    (nearest, (nearest - p).norm_squared())
}

/// The point of triangle `abc` nearest to `p` and its squared distance, m².
///
/// The distance is right within a few ulps of the largest coordinate whatever the
/// triangle's shape.
///
/// The projection of p is a + s·ab + t·ac where s and t solve a least squares problem
/// of two columns. With d = ac − k·ab perpendicular to ab, k = ac·ab / ab², and
/// r = (p − a) − x·ab, x = (p − a)·ab / ab²,
///
///   t = r·d / d²,   s = x − k·t.
///
/// Taking x·ab away *before* the product with d is what makes the solution that of a
/// triangle whose corners are moved by rounding errors only (Björck, Numerical Methods
/// for Least Squares Problems, 2.4). s, t and 1 − s − t are the weights of b, c and a:
/// the projection is inside when none is negative, otherwise the nearest point lies on
/// the edge opposite to a corner of negative weight. Where d vanishes against rounding,
/// (s, t) is noise, but still a point of the plane, and the edges it is outside of
/// cover the collapsed triangle; where d is 0, NaN makes every edge a candidate.
#[inline]
pub fn on_triangle(p: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> (Vec3, Real) {
    let ab = b - a;
    let ac = c - a;
    let ap = p - a;
    let per_length2 = 1.0 / ab.norm_squared();
    let k = ac.dot(&ab) * per_length2;
    let x = ap.dot(&ab) * per_length2;
    let d = ac - ab * k;
    let r = ap - ab * x;
    let t = r.dot(&d) / d.norm_squared();
    let s = x - k * t;

    let (in_s, in_t, in_rest) = (s >= 0.0, t >= 0.0, s + t <= 1.0);
    if in_s && in_t && in_rest {
        let nearest = a + ab * s + ac * t;
        return (nearest, (nearest - p).norm_squared());
    }
    // NaN: no candidate yet. It stays when the input holds one.
    let mut best = (*a, Real::NAN);
    for (inside, (from, to)) in [(in_t, (a, b)), (in_s, (a, c)), (in_rest, (b, c))] {
        if !inside {
            let candidate = on_segment(p, from, to);
            if best.1.is_nan() || candidate.1 < best.1 {
                best = candidate;
            }
        }
    }
    best
}
