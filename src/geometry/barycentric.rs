// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Computes the point of a segment, a triangle or a tetrahedron closest to a given point p, with its
//! barycentric coordinates (weights), and weighted means of points.
//!
//! 1. Project p to the line, plane or space of the corners.
//! 2. If a weight is negative, test only the edges or faces that it violates (the regions of C. Ericson,
//!    Real-Time Collision Detection, 5.1.5).
//!
//! Departures. libccd treats a triangle as degenerate below an absolute area and then tests only its edges;
//! here no triangle is special. For slivers many weights give nearly the same point. So the point is always
//! computed from its weights, and candidates are compared by distance, not by weights.

use crate::math::{Vec3, normal};

/// The point of a simplex of `N` corners closest to a given point.
#[derive(Clone, Copy, Debug)]
pub struct ClosestPoint<const N: usize> {
    /// The closest point.
    pub point: Vec3,
    /// The square of its distance from the given point, m²; NaN if that contains a NaN.
    pub distance2: f64,
    /// The barycentric coordinates: one for each corner, none negative, their sum 1 to an ulp; exactly 0 for
    /// the corners that do not contribute.
    pub weights: [f64; N],
}

impl<const N: usize> ClosestPoint<N> {
    /// Returns the same point for a simplex of more corners, in which `indices` are the corners of this one.
    #[inline(always)]
    fn with_corners_at<const M: usize>(self, indices: [usize; N]) -> ClosestPoint<M> {
        let mut weights = [0.0; M];
        for (weight, index) in self.weights.into_iter().zip(indices) {
            // The remainder is always in range, so the access needs no check.
            weights[index % M] = weight;
        }
        ClosestPoint {
            point: self.point,
            distance2: self.distance2,
            weights,
        }
    }
}

/// Returns the weighted mean of points; the weights sum to 1.
///
/// Computed as an offset from the first point: far from the world's origin, a sum of the weights that differs
/// from 1 by rounding would move the mean. If a weight is 1, the mean is that point to an ulp.
#[inline]
pub fn mix<const N: usize>(weights: &[f64; N], points: [&Vec3; N]) -> Vec3 {
    let mut mixed = *points[0];
    for i in 1..N {
        mixed += (points[i] - points[0]) * weights[i];
    }
    mixed
}

/// Returns the point of segment `ab` closest to `p`.
///
/// If an end is the closest point, it is returned bit for bit. The ends may be equal.
#[inline]
pub fn segment(p: &Vec3, a: &Vec3, b: &Vec3) -> ClosestPoint<2> {
    let ab = b - a;
    let t = (p - a).dot(&ab) / ab.norm_squared();
    // For equal ends t is 0/0, NaN, and the result is `a`.
    let (point, weights) = if t >= 1.0 {
        (*b, [0.0, 1.0])
    } else if t > 0.0 {
        (a + ab * t, [1.0 - t, t])
    } else {
        (*a, [1.0, 0.0])
    };
    ClosestPoint {
        point,
        distance2: (point - p).norm_squared(),
        weights,
    }
}

/// Returns the point of triangle `abc` closest to `p`.
///
/// The error of the distance is a few ulps of the largest coordinate; if p is nearly in the triangle's
/// plane, up to 1 / sin(α) times that, α being the angle between ab and ac, but at most 1000 times
/// (single: 10).
///
/// The projection of p is a + s·ab + t·ac where s and t solve a least squares problem of
/// two columns. s, t and 1 − s − t are the weights of b, c and a: the projection is
/// inside if none is negative, otherwise the closest point is on the edge opposite
/// to a corner of negative weight.
///
/// *Normal equations*, v s + r t = −pb and r s + w t = −pc, unless ab and ac are almost
/// parallel. The order of the operations is that of libccd, because FCL's EPA, which calls
/// this function, amplifies a difference in the last bit to 1e-5 m in its result: any other
/// order changes one result in a thousand.
///
/// *Modified Gram-Schmidt* if they are: with d = ac − k·ab perpendicular to ab, k = r/v,
/// and rest = (p − a) − x·ab, x = −pb/v,
///
///   t = rest·d / d²,   s = x − k·t.
///
/// Subtracting x·ab *before* the product with d makes the solution that of a triangle
/// whose corners are moved by rounding errors only (Björck, Numerical Methods for Least
/// Squares Problems, 2.4). If d is no more than rounding, (s, t) is noise, but still a point
/// of the plane, and the edges that it violates cover the collapsed triangle; if d is 0,
/// NaN makes every edge a candidate.
///
/// The fourth power of the coordinates must not overflow (coordinates below 1e77).
#[inline]
pub fn triangle(p: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> ClosestPoint<3> {
    let (ab, ac, pa) = (b - a, c - a, a - p);
    let (v, w, r) = (ab.norm_squared(), ac.norm_squared(), ab.dot(&ac));
    let (pb, pc) = (pa.dot(&ab), pa.dot(&ac));
    // v w sin²(α).
    let det = w * v - r * r;
    let min_det = PARALLEL_SINE2 * (w * v);
    let (s, t);
    // False if a fourth power of a length overflows or is too small to be exact.
    if det > min_det && min_det > f64::MIN_POSITIVE {
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
        let point = a + ab * s + ac * t;
        return ClosestPoint {
            point,
            distance2: (point - p).norm_squared(),
            weights: [1.0 - (s + t), s, t],
        };
    }
    // NaN: no candidate yet. It remains if the input contains a NaN.
    let mut best = ClosestPoint {
        point: *a,
        distance2: f64::NAN,
        weights: [1.0, 0.0, 0.0],
    };
    for (is_inside, (from, to), indices) in [
        (in_t, (a, b), [0, 1]),
        (in_s, (a, c), [0, 2]),
        (in_rest, (b, c), [1, 2]),
    ] {
        if !is_inside {
            let candidate = segment(p, from, to);
            if best.distance2.is_nan() || candidate.distance2 < best.distance2 {
                best = candidate.with_corners_at(indices);
            }
        }
    }
    best
}

/// Returns the point of tetrahedron `abcd` closest to `p`: `p` itself, to rounding, if the tetrahedron
/// contains it.
///
/// A weight grows linearly from 0 on a face to 1 at the opposite corner. The closest points of the four faces
/// are candidates as well: the closest one is the result if `p` is outside, and if the tetrahedron is flat
/// within rounding, so that the signs of the weights are meaningless.
#[inline]
pub fn tetrahedron(p: &Vec3, corners: [&Vec3; 4]) -> ClosestPoint<4> {
    // Each face, and its opposite corner.
    const FACES: [[usize; 4]; 4] = [[1, 2, 3, 0], [0, 2, 3, 1], [0, 1, 3, 2], [0, 1, 2, 3]];
    let gradients = FACES.map(|face| {
        let [a, b, c, opposite] = face.map(|i| corners[i % 4]);
        let n = normal(a, b, c);
        n / n.dot(&(opposite - a))
    });
    // Two iterations, starting at the centroid: the first result is off by ulps / thickness.
    let mut weights = [0.25; 4];
    for _ in 0..2 {
        let missing = p - mix(&weights, corners);
        for (weight, gradient) in weights.iter_mut().zip(&gradients) {
            *weight += gradient.dot(&missing);
        }
        // The weights sum to 1, as `mix` assumes.
        weights[0] = 1.0 - (weights[1] + weights[2] + weights[3]);
    }
    let point = mix(&weights, corners);
    let is_inside = weights.iter().all(|weight| *weight >= 0.0);
    // NaN: no candidate yet, as for a flat tetrahedron.
    let mut best = ClosestPoint {
        point,
        distance2: if is_inside {
            (point - p).norm_squared()
        } else {
            f64::NAN
        },
        weights,
    };
    for [i, j, k, _] in FACES {
        let [a, b, c] = [i, j, k].map(|i| corners[i % 4]);
        let face = triangle(p, a, b, c).with_corners_at([i, j, k]);
        if best.distance2.is_nan() || face.distance2 < best.distance2 {
            best = face;
        }
    }
    best
}

/// Squared sine of the angle below which two edges count as almost parallel. At that angle the normal
/// equations have lost three digits; in single precision, one.
const PARALLEL_SINE2: f64 = if cfg!(feature = "single") { 1e-2 } else { 1e-6 };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::test_shapes::Random;

    /// Returns the corners of one kind of simplex: solid, flat, a needle, or with equal corners.
    fn corners(kind: usize, r: &mut Random) -> [Vec3; 4] {
        let mut c = [0; 4].map(|_| r.vector(1.0));
        let thin = [1e-2, 1e-8, 1e-15, 0.0][r.within(0.0, 4.0) as usize];
        // `distance_bound` is not exact enough for such a needle.
        let thin = if kind == 2 && thin == 1e-8 {
            1e-15
        } else {
            thin
        };
        match kind {
            0 => {}
            // Flat.
            1 => c.iter_mut().for_each(|p| p.z *= thin),
            // A needle.
            2 => c
                .iter_mut()
                .for_each(|p| (p.y, p.z) = (p.y * thin, p.z * thin)),
            // Two corners (nearly) equal.
            3 => c[3] = c[0] + r.vector(1.0) * thin,
            4 => c[2] = c[1] + r.vector(1.0) * thin,
            // All corners (nearly) equal.
            _ => c = c.map(|p| c[0] + p * thin),
        }
        let rotation = r.rotation();
        c.map(|p| rotation * p)
    }

    /// Returns a lower bound of the distance of the corners from `p`, by separating planes: perpendicular to
    /// the normals of faces, and to the shortest lines to edges and corners.
    fn distance_bound(p: &Vec3, corners: &[&Vec3]) -> f64 {
        let c: Vec<Vec3> = corners.iter().map(|c| *c - p).collect();
        let mut axes = c.clone();
        for (i, a) in c.iter().enumerate() {
            for (j, b) in c[..i].iter().enumerate() {
                let along = (b - a).try_normalize(0.0).unwrap_or_default();
                // Twice, because the first projection is rounded.
                let project = |w: Vec3| w - along * w.dot(&along);
                axes.push(project(project(*a)));
                for d in &c[..j] {
                    let n = normal(a, b, d);
                    axes.extend([n, -n]);
                }
            }
        }
        let distance = |n: &Vec3| c.iter().map(|c| n.dot(c)).fold(f64::INFINITY, f64::min);
        let units = axes.iter().filter_map(|w| w.try_normalize(0.0));
        units.map(|n| distance(&n)).fold(0.0, f64::max)
    }

    fn check<const N: usize>(p: &Vec3, corners: [&Vec3; N], found: &ClosestPoint<N>, what: &str) {
        let size = corners.iter().fold(p.norm(), |m, c| m.max(c.norm()));
        // A few times the derived error for a point nearly in a sliver's plane.
        let error = size * EPSILON * if cfg!(feature = "single") { 500.0 } else { 5e4 };
        assert!(found.weights.iter().all(|w| *w >= 0.0), "{what} {found:?}");
        let sum: f64 = found.weights.iter().sum();
        assert!((sum - 1.0).abs() <= 4.0 * EPSILON, "{what} {found:?}");
        let mixed = mix(&found.weights, corners);
        assert!(
            (mixed - found.point).norm() <= 8.0 * EPSILON * size,
            "{what}"
        );
        let distance = (found.point - p).norm();
        assert!((distance * distance - found.distance2).abs() <= 8.0 * EPSILON * size * size);
        let excess = distance - distance_bound(p, &corners);
        assert!(excess <= error, "{what} {excess} {found:?}");
    }

    #[test]
    fn no_point_is_closer_than_the_closest_point() {
        let mut r = Random::new(31);
        for kind in 0..6 {
            for round in 0..3000 {
                let c = corners(kind, &mut r);
                let [a, b, c, d] = &c;
                let inside = mix(&[0.1, 0.2, 0.3, 0.4], [a, b, c, d]);
                let far = r.vector(2.0);
                let targets = [far, Vec3::zeros(), inside, *b, (a + c) * 0.5];
                for p in targets {
                    let what = format!("kind {kind} round {round}");
                    check(&p, [a, b], &segment(&p, a, b), &what);
                    check(&p, [a, b, c], &triangle(&p, a, b, c), &what);
                    let four = [a, b, c, d];
                    check(&p, four, &tetrahedron(&p, four), &what);
                }
            }
        }
    }

    #[test]
    fn point_inside_is_its_own_closest_point() {
        let mut r = Random::new(32);
        for _ in 0..3000 {
            let corners = [0; 4].map(|_| r.vector(1.0));
            let [a, b, c, d] = &corners;
            let volume = (b - a).cross(&(c - a)).dot(&(d - a)).abs();
            let w = [0; 4].map(|_| r.within(0.01, 1.0));
            let sum: f64 = w.iter().sum();
            let w = w.map(|x| x / sum);
            let p = mix(&w, [a, b, c, d]);
            let found = tetrahedron(&p, [a, b, c, d]);
            assert!((found.point - p).norm() <= 32.0 * EPSILON / volume);
            for (x, y) in w.iter().zip(found.weights) {
                assert!((x - y).abs() <= 200.0 * EPSILON / volume);
            }
        }
    }

    #[test]
    fn nan_input_gives_nan_distance() {
        let nan = Vec3::repeat(f64::NAN);
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        assert!(segment(&nan, &x, &y).distance2.is_nan());
        assert!(triangle(&nan, &x, &y, &z).distance2.is_nan());
        assert!(
            tetrahedron(&nan, [&x, &y, &z, &Vec3::zeros()])
                .distance2
                .is_nan()
        );
    }
}
