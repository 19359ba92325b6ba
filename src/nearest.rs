// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The point of a segment or a triangle nearest to a given point.
//!
//! Projection, then the search of the violated edges only (the regions are those of
//! Ericson, Real-Time Collision Detection, 5.1.5). libccd calls a triangle degenerate by
//! an absolute area and then looks at its edges alone; here no triangle is special.

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
/// The error of the distance is a few ulps of the largest coordinate; where p is as good
/// as in the triangle's plane, up to 1 / sin a times that, but never above 1000 times (single: 10).
///
/// The projection of p is a + s·ab + t·ac where s and t solve a least squares problem of
/// two columns. s, t and 1 − s − t are the weights of b, c and a: the projection is
/// inside when none is negative, otherwise the nearest point lies on the edge opposite
/// to a corner of negative weight.
///
/// *Normal equations*, v s + r t = −pb and r s + w t = −pc, unless ab and ac are almost
/// parallel. They are written as libccd writes them, because FCL's EPA, which runs on
/// this function, carries a difference in the last bit to one of 1e-5 m in its answer:
/// with any other order of the operations, one answer in a thousand is another.
///
/// *Modified Gram-Schmidt* where they are: with d = ac − k·ab perpendicular to ab, k = r/v,
/// and rest = (p − a) − x·ab, x = −pb/v,
///
///   t = rest·d / d²,   s = x − k·t.
///
/// Taking x·ab away *before* the product with d makes the solution that of a triangle
/// whose corners are moved by rounding errors only (Björck, Numerical Methods for Least
/// Squares Problems, 2.4). Where d vanishes against rounding, (s, t) is noise, but still
/// a point of the plane, and the edges it is outside of cover the collapsed triangle;
/// where d is 0, NaN makes every edge a candidate.
///
/// The fourth power of the coordinates must be a number (below 1e77; single: 1e9).
#[inline]
pub fn on_triangle(p: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> (Vec3, Real) {
    let (ab, ac, pa) = (b - a, c - a, a - p);
    let (v, w, r) = (ab.norm_squared(), ac.norm_squared(), ab.dot(&ac));
    let (pb, pc) = (pa.dot(&ab), pa.dot(&ac));
    // v w sin² of the angle between ab and ac.
    let det = w * v - r * r;
    let least = PARALLEL * (w * v);
    let (s, t);
    // False for fourth powers of lengths that are not numbers, or too small to be exact.
    if det > least && least > Real::MIN_POSITIVE {
        s = (pc * r - w * pb) / det;
        t = (-s * r - pc) / w;
    } else {
        let k = r / v;
        let x = -pb / v;
        let d = ac - ab * k;
        let rest = -pa - ab * x;
        t = rest.dot(&d) / d.norm_squared();
        s = x - k * t;
    }

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

/// Squared sine of the angle below which two edges are almost parallel: the normal
/// equations have lost three digits there; in single precision, which has none to spare, one.
const PARALLEL: Real = if cfg!(feature = "single") { 1e-2 } else { 1e-6 };
