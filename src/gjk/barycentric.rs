// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The point of a segment, a triangle or a tetrahedron nearest to a given point, the
//! weights of the corners in it, and what points mix to with such weights.
//!
//! Projection, then the search of the violated edges or faces only (the regions are those
//! of Ericson, Real-Time Collision Detection, 5.1.5). libccd calls a triangle degenerate by
//! an absolute area and then looks at its edges alone; here no triangle is special.
//!
//! The weights of a sliver are mostly rounding, and any are good that lead to the right
//! place: here the point is what its weights lead to, and what is compared is where the
//! points are.

use crate::math::{Vec3, normal};
use crate::minkowski::support::SupportPoint;

/// The point of a simplex of `N` corners that is nearest to a given one.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<const N: usize> {
    /// The closest point.
    pub point: Vec3,
    /// The square of its distance from the given point, m²; NaN where that holds a
    /// NaN.
    pub distance2: f64,
    /// One for each corner: none is negative, and their sum is 1 to an ulp. Zero exactly
    /// for the corners of no part in it.
    pub weights: [f64; N],
}

impl<const N: usize> Nearest<N> {
    /// The same point, of a simplex with more corners: `places` are those of the corners
    /// that it has.
    #[inline(always)]
    fn among<const M: usize>(self, places: [usize; N]) -> Nearest<M> {
        let mut weights = [0.0; M];
        for (weight, place) in self.weights.into_iter().zip(places) {
            // In range for certain, so that no access is checked.
            weights[place % M] = weight;
        }
        Nearest {
            point: self.point,
            distance2: self.distance2,
            weights,
        }
    }
}

/// Returns the weighted mean of points; the weights sum to 1.
///
/// Counted from the first: far from the world's origin weights that miss 1 by a rounding
/// would move it. Where a weight is 1 it is that point to an ulp.
#[inline]
pub fn mix<const N: usize>(weights: &[f64; N], points: [&Vec3; N]) -> Vec3 {
    let mut mixed = *points[0];
    for i in 1..N {
        mixed += (points[i] - points[0]) * weights[i];
    }
    mixed
}

/// Returns the weighted means of the points of obj1 and of those of obj2: points of the objects, whose
/// difference is the weighted mean of the points of D.
#[inline]
pub fn witnesses<const N: usize>(weights: &[f64; N], points: [&SupportPoint; N]) -> (Vec3, Vec3) {
    (
        mix(weights, points.map(|p| &p.v1)),
        mix(weights, points.map(|p| &p.v2)),
    )
}

/// The point of segment `ab` nearest to `p`.
///
/// An end that is nearest is returned bit for bit. Equal ends are a point.
#[inline]
pub fn segment(p: &Vec3, a: &Vec3, b: &Vec3) -> Nearest<2> {
    let ab = b - a;
    let t = (p - a).dot(&ab) / ab.norm_squared();
    // 0/0 of equal ends is NaN and lands at `a`.
    let (point, weights) = if t >= 1.0 {
        (*b, [0.0, 1.0])
    } else if t > 0.0 {
        (a + ab * t, [1.0 - t, t])
    } else {
        (*a, [1.0, 0.0])
    };
    Nearest {
        point,
        distance2: (point - p).norm_squared(),
        weights,
    }
}

/// The point of triangle `abc` nearest to `p`.
///
/// The error of the distance is a few ulps of the largest coordinate; where p is as good
/// as in the triangle's plane, up to 1 / sin a times that, but never above 1000 times (single: 10).
///
/// The projection of p is a + s·ab + t·ac where s and t solve a least squares problem of
/// two columns. s, t and 1 − s − t are the weights of b, c and a: the projection is
/// inside when none is negative, otherwise the nearest point is on the edge opposite
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
pub fn triangle(p: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> Nearest<3> {
    let (ab, ac, pa) = (b - a, c - a, a - p);
    let (v, w, r) = (ab.norm_squared(), ac.norm_squared(), ab.dot(&ac));
    let (pb, pc) = (pa.dot(&ab), pa.dot(&ac));
    // v w sin² of the angle between ab and ac.
    let det = w * v - r * r;
    let least = PARALLEL * (w * v);
    let (s, t);
    // False for fourth powers of lengths that are not numbers, or too small to be exact.
    if det > least && least > f64::MIN_POSITIVE {
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
        return Nearest {
            point,
            distance2: (point - p).norm_squared(),
            weights: [1.0 - (s + t), s, t],
        };
    }
    // NaN: no candidate yet. It stays when the input holds one.
    let mut best = Nearest {
        point: *a,
        distance2: f64::NAN,
        weights: [1.0, 0.0, 0.0],
    };
    for (inside, (from, to), places) in [
        (in_t, (a, b), [0, 1]),
        (in_s, (a, c), [0, 2]),
        (in_rest, (b, c), [1, 2]),
    ] {
        if !inside {
            let candidate = segment(p, from, to);
            if best.distance2.is_nan() || candidate.distance2 < best.distance2 {
                best = candidate.among(places);
            }
        }
    }
    best
}

/// The point of tetrahedron `abcd` nearest to `p`: `p` itself, to rounding, where the
/// tetrahedron holds it.
///
/// A weight grows linearly from the face, where it is 0, to the corner opposite, where it is 1. Where `p` is
/// outside, the nearest of the faces' points is the tetrahedron's; and also where it is flat to rounding and
/// the signs of the weights tell nothing: what is nearest counts.
#[inline]
pub fn tetrahedron(p: &Vec3, corners: [&Vec3; 4]) -> Nearest<4> {
    // Each face, and the corner opposite.
    const FACES: [[usize; 4]; 4] = [[1, 2, 3, 0], [0, 2, 3, 1], [0, 1, 3, 2], [0, 1, 2, 3]];
    let gradients = FACES.map(|face| {
        let [a, b, c, opposite] = face.map(|i| corners[i % 4]);
        let n = normal(a, b, c);
        n / n.dot(&(opposite - a))
    });
    // From the middle to `p`, and again: where the weights lead is off by ulps over the thickness.
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
    // NaN: no candidate yet, as of a flat one.
    let mut best = Nearest {
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
        let face = triangle(p, a, b, c).among([i, j, k]);
        if best.distance2.is_nan() || face.distance2 < best.distance2 {
            best = face;
        }
    }
    best
}

/// Squared sine of the angle below which two edges are almost parallel: the normal
/// equations have lost three digits there; in single precision, which has none to spare, one.
const PARALLEL: f64 = if cfg!(feature = "single") { 1e-2 } else { 1e-6 };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    /// Corners of every kind of simplex: solid, flat, a needle, with two corners equal.
    fn corners(kind: usize, r: &mut Random) -> [Vec3; 4] {
        let mut c = [0; 4].map(|_| r.vector(1.0));
        let thin = [1e-2, 1e-8, 1e-15, 0.0][r.within(0.0, 4.0) as usize];
        // The truth below is not exact enough for a needle between thin and none.
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
            // All on one spot.
            _ => c = c.map(|p| c[0] + p * thin),
        }
        let rotation = r.rotation();
        c.map(|p| rotation * p)
    }

    /// Returns a lower bound of the distance of the corners from `p`, by planes between: across the normals of
    /// faces, and across the way to edges and corners, made exact where rounding turns it.
    fn least(p: &Vec3, corners: &[&Vec3]) -> f64 {
        let c: Vec<Vec3> = corners.iter().map(|c| *c - p).collect();
        let mut ways = c.clone();
        for (i, a) in c.iter().enumerate() {
            for (j, b) in c[..i].iter().enumerate() {
                let along = (b - a).try_normalize(0.0).unwrap_or_default();
                let across = |w: Vec3| w - along * w.dot(&along);
                ways.push(across(across(*a)));
                for d in &c[..j] {
                    let n = normal(a, b, d);
                    ways.extend([n, -n]);
                }
            }
        }
        let reach = |n: &Vec3| c.iter().map(|c| n.dot(c)).fold(f64::INFINITY, f64::min);
        let units = ways.iter().filter_map(|w| w.try_normalize(0.0));
        units.map(|n| reach(&n)).fold(0.0, f64::max)
    }

    fn check<const N: usize>(p: &Vec3, corners: [&Vec3; N], found: &Nearest<N>, what: &str) {
        let size = corners.iter().fold(p.norm(), |m, c| m.max(c.norm()));
        // A few times what the derivation allows where p is as good as in a sliver's plane.
        let error = size * EPSILON * if cfg!(feature = "single") { 500.0 } else { 5e4 };
        assert!(found.weights.iter().all(|w| *w >= 0.0), "{what} {found:?}");
        let sum: f64 = found.weights.iter().sum();
        assert!((sum - 1.0).abs() <= 4.0 * EPSILON, "{what} {found:?}");
        let led = mix(&found.weights, corners);
        assert!((led - found.point).norm() <= 8.0 * EPSILON * size, "{what}");
        let distance = (found.point - p).norm();
        assert!((distance * distance - found.distance2).abs() <= 8.0 * EPSILON * size * size);
        let over = distance - least(p, &corners);
        assert!(over <= error, "{what} {over} {found:?}");
    }

    #[test]
    fn no_corner_lies_before_the_nearest_point() {
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
    fn a_point_inside_is_its_own_nearest() {
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
    fn witnesses_differ_by_the_point() {
        let mut r = Random::new(33);
        for _ in 0..1000 {
            // Far from the world's origin.
            let base = r.vector(1e3);
            let points = [0; 3].map(|_| {
                let (v1, v2) = (base + r.vector(1.0), base + r.vector(1.0));
                SupportPoint { v: v1 - v2, v1, v2 }
            });
            let [a, b, c] = &points;
            let found = triangle(&Vec3::zeros(), &a.v, &b.v, &c.v);
            let (p1, p2) = witnesses(&found.weights, [a, b, c]);
            assert!((p1 - p2 - found.point).norm() <= 1e3 * 8.0 * EPSILON);
        }
    }

    #[test]
    fn nan_is_no_distance() {
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
