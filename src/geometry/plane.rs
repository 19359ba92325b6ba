// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Homogeneous planes N·x = d, where N is not normalised, and the four planes of a tetrahedron.
//!
//! Error model. The planes of a [`Tetrahedron`] have unit normals, and d is the least N·corner as computed. So each
//! corner is at most [`PLANE_ERROR_ULPS`] ulps of the size of D below its plane; the distance of the plane from the
//! origin has the same error. [`crate::epa::polytope`] adds to it what interpolation rounds.
//!
//! The arithmetic is on pairs of numbers: codegen, see README.

use crate::math::{Vec3, larger, lesser};

/// The height of a triangle up to which it counts as without area, in ulps of the size. Derived: twice the error of a
/// plane through its corners.
pub const MIN_EXTENT_ULPS: f64 = 2.0 * PLANE_ERROR_ULPS;
/// The error of a plane that is computed from its corners, in ulps of the size. Derived: two dot products of a
/// unit vector and a point, with three products and two sums each; the normalisation of the unit vector; and the
/// coordinates of the interior point.
pub const PLANE_ERROR_ULPS: f64 = 8.0;
/// The least six-fold volume of a tetrahedron, in ulps of the cube of its longest edge L. Derived: the normal of a
/// face, before it is normalised, has an error of 6 ulps of L². For a face of area A and a height H of the tetrahedron
/// above it, the plane is then off by 6 ulps · L³ / (2 A) in the distance L, and the middle of the tetrahedron is H / 4
/// below it. The error is at most half of that if 2 A H, the six-fold volume, is at least 48 ulps of L³; 64 leaves a
/// reserve.
const MIN_VOLUME_ULPS: f64 = 64.0;

/// A pair of numbers for packed arithmetic.
#[derive(Clone, Copy, Debug)]
struct Lanes([f64; 2]);

impl Lanes {
    #[inline(always)]
    fn plus(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1]])
    }

    #[inline(always)]
    fn minus(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1]])
    }

    #[inline(always)]
    fn times(self, o: Self) -> Self {
        Self([self.0[0] * o.0[0], self.0[1] * o.0[1]])
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self([self.0[0].abs(), self.0[1].abs()])
    }
}

/// A plane (N, d), or a point (p, −1). Their dot product is the height of p above the plane, times |N|.
#[derive(Clone, Copy, Debug)]
pub struct Plane(Lanes, Lanes);

impl Plane {
    /// Makes the plane N·x = d with the normal N = `n`.
    #[inline(always)]
    pub fn new(n: &Vec3, d: f64) -> Self {
        Self(Lanes([n.x, n.y]), Lanes([n.z, d]))
    }

    /// Makes the point (p, −1), for [`Plane::height`].
    #[inline(always)]
    pub fn point(p: &Vec3) -> Self {
        // codegen: see README.
        Self::new(p, core::hint::black_box(-1.0))
    }

    /// Makes the plane of the four numbers N, d.
    #[inline(always)]
    pub fn of(a: &[f64; 4]) -> Self {
        Self(Lanes([a[0], a[1]]), Lanes([a[2], a[3]]))
    }

    /// Returns the four numbers N, d.
    #[inline(always)]
    pub fn array(&self) -> [f64; 4] {
        [self.0.0[0], self.0.0[1], self.1.0[0], self.1.0[1]]
    }

    /// Returns N.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        Vec3::new(self.0.0[0], self.0.0[1], self.1.0[0])
    }

    /// Returns d.
    #[inline(always)]
    pub fn offset(&self) -> f64 {
        self.1.0[1]
    }

    /// Returns N·p − d for a [`Plane::point`]: the height of p above the plane, times |N|.
    #[inline(always)]
    pub fn height(&self, point: &Self) -> f64 {
        let x = self.0.times(point.0).plus(self.1.times(point.1));
        x.0[0] + x.0[1]
    }

    /// Returns the interpolated plane (1 − w) self + w other, which contains the common line of both.
    #[inline(always)]
    pub fn towards(&self, other: &Self, w: f64) -> Self {
        let w = Lanes([w, w]);
        Self(
            self.0.plus(w.times(other.0.minus(self.0))),
            self.1.plus(w.times(other.1.minus(self.1))),
        )
    }

    /// Returns the squared distance from the origin with the sign of d, m²; and |N|².
    #[inline(always)]
    pub fn signed_square(&self) -> (f64, f64) {
        let a = self.0.times(self.0);
        let b = self.1.times(self.1.abs());
        let n2 = (a.0[0] + a.0[1]) + b.0[0].abs();
        (b.0[1] / n2, n2)
    }

    /// Returns the same plane with N and d times `k`.
    #[inline(always)]
    pub fn scaled(&self, k: f64) -> Self {
        let k = Lanes([k, k]);
        Self(self.0.times(k), self.1.times(k))
    }
}

/// A tetrahedron with a volume above rounding, and its planes.
#[derive(Clone, Copy, Debug)]
pub struct Tetrahedron {
    /// The planes of the faces (0 2 1), (0 1 3), (1 2 3), (2 0 3), with outward unit normals.
    pub planes: [Plane; 4],
    /// True if points 1 and 2 are exchanged, so that the normals point outwards.
    pub is_flipped: bool,
    /// The mean of the four points.
    pub middle: Vec3,
    /// A lower bound of the distance of `middle` below every plane, metres.
    pub interior_clearance: f64,
    /// The error of the planes, metres.
    pub error: f64,
}

impl Tetrahedron {
    /// Makes the tetrahedron of four points; `None` if it is flat within rounding. `ulp`: an ulp of the size of D,
    /// metres.
    #[inline(always)]
    pub fn new([o, mut a, mut b, c]: [Vec3; 4], ulp: f64) -> Option<Self> {
        let extent = MIN_EXTENT_ULPS * ulp;
        // The edges from o to a, b and c.
        let (e, f, g) = (a - o, b - o, c - o);
        let base = e.cross(&f);
        let volume = base.dot(&g);
        let long2 = larger(larger(e.norm_squared(), f.norm_squared()), g.norm_squared());
        let min_area2 = extent * extent * long2;
        // For a smaller volume the sign, and thus the outward direction, is undecided.
        let min_volume = MIN_VOLUME_ULPS * f64::EPSILON * long2;
        // Negated for NaN.
        if !(volume * volume > min_volume * min_volume * long2) {
            return None;
        }
        let is_flipped = volume < 0.0;
        let (mut x, mut y, mut below) = (e, f, -base);
        if is_flipped {
            (x, y, below) = (f, e, base);
            (a, b) = (b, a);
        }
        // The third normal is not minus the sum of the others, which is mostly rounding for a thin tetrahedron.
        let normals = [below, x.cross(&g), (y - x).cross(&(g - x)), g.cross(&y)];
        let corners = [[o, b, a], [o, a, c], [a, b, c], [b, o, c]];
        let mut planes = [Plane::new(&o, 0.0); 4];
        let mut widest2 = 0.0;
        for ((plane, n), [p, q, r]) in planes.iter_mut().zip(normals).zip(corners) {
            let n2 = n.norm_squared();
            if !(n2 > min_area2) {
                return None;
            }
            let n = n / n2.sqrt();
            widest2 = larger(n2, widest2);
            *plane = Plane::new(&n, lesser(lesser(n.dot(&p), n.dot(&q)), n.dot(&r)));
        }
        let error = PLANE_ERROR_ULPS * ulp;
        // The distance of the middle below a face is a quarter of the opposite corner's.
        let interior_clearance = 0.25 * volume.abs() / widest2.sqrt();
        (interior_clearance >= error).then_some(Self {
            planes,
            is_flipped,
            middle: (o + a + b + c) * 0.25,
            interior_clearance,
            error,
        })
    }

    /// Returns the least signed distance of a plane from the origin, metres. The ball around the origin of that radius
    /// less `error` is in the tetrahedron.
    #[inline(always)]
    pub fn inner_radius(&self) -> f64 {
        let [a, b, c, d] = self.planes.each_ref().map(Plane::offset);
        lesser(lesser(a, b), lesser(c, d))
    }
}

/// Returns the distance of the plane of `base` from the origin, metres, if it is more than `least`, not negative, and
/// the ball of that radius around the origin is in the tetrahedron of `apex` and `base`, within the error of planes
/// ([`PLANE_ERROR_ULPS`]); `None` otherwise, also if another face is closer than the base, or nearly so. The corners of
/// `base` are in the order in which their normal points away from `apex`. `size`: the size of D, metres.
///
/// It needs one of the four square roots and divisions of a [`Tetrahedron`].
#[inline(always)]
pub fn base_distance(apex: &Vec3, base: &[Vec3; 3], least: f64, size: f64) -> Option<f64> {
    let [a, b, c] = base;
    let normal = (b - a).cross(&(c - a));
    let offset = lesser(lesser(normal.dot(a), normal.dot(b)), normal.dot(c));
    let distance = offset / normal.norm();
    // The error of the products below.
    let margin = MIN_VOLUME_ULPS * f64::EPSILON * size * size * size;
    // Whether the plane of apex, p and q is farther; its inward normal is (p − apex) × (q − apex).
    let is_farther = |p: &Vec3, q: &Vec3| {
        let n = (p - apex).cross(&(q - apex));
        let d = -n.dot(apex) - margin;
        d > 0.0 && d * d >= distance * distance * n.norm_squared()
    };
    // Written for NaN.
    let is_in = distance > least
        && normal.dot(apex) < 0.0
        && is_farther(a, b)
        && is_farther(b, c)
        && is_farther(c, a);
    is_in.then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_distances_and_interpolation() {
        let x = Plane::new(&(Vec3::x() * 2.0), 6.0);
        let y = Plane::new(&Vec3::y(), -1.0);
        assert_eq!(x.height(&Plane::point(&Vec3::new(4.0, 9.0, 9.0))), 2.0);
        assert_eq!(x.signed_square(), (9.0, 4.0));
        assert_eq!(y.signed_square(), (-1.0, 1.0));
        // A point of both planes is one of every mixture.
        let both = Plane::point(&Vec3::new(3.0, -1.0, 7.0));
        assert_eq!(x.towards(&y, 0.25).height(&both), 0.0);
        assert_eq!(x.towards(&y, 1.0).array(), y.array());
        assert_eq!(x.scaled(2.0).array(), [4.0, 0.0, 0.0, 12.0]);
    }

    #[test]
    fn a_tetrahedron_around_the_origin_has_its_inner_radius() {
        let points = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        let [o, a, b, c] = points.map(Vec3::from);
        for points in [[o, a, b, c], [o, b, a, c]] {
            let made = Tetrahedron::new(points, f64::EPSILON).unwrap();
            assert!((made.inner_radius() - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15);
            assert!(
                made.planes
                    .iter()
                    .all(|p| p.offset() - p.normal().dot(&made.middle) >= made.interior_clearance)
            );
        }
    }

    /// Compares with the planes of random tetrahedra, many of which do not contain the origin.
    #[test]
    fn the_base_distance_is_that_of_the_closest_plane() {
        let mut r = crate::test_shapes::Random::new(5);
        let mut found = [0; 2];
        for _ in 0..20000 {
            let apex = r.vector(0.5) - Vec3::z() * r.within(0.5, 2.0);
            let [a, mut b, mut c] = [0.0, 2.1, 4.2].map(|angle: f64| {
                let radial = Vec3::new(angle.cos(), angle.sin(), 0.0);
                radial * r.within(0.2, 2.0) + r.vector(0.5) + Vec3::z() * r.within(0.1, 0.5)
            });
            if (b - a).cross(&(c - a)).dot(&(a - apex)) < 0.0 {
                (b, c) = (c, b);
            }
            let size = [apex, a, b, c].iter().fold(0.0, |s, p| larger(p.norm(), s));
            let Some(planes) = Tetrahedron::new([apex, a, b, c], f64::EPSILON * size) else {
                continue;
            };
            let (inner, base) = (planes.inner_radius(), planes.planes[2].offset());
            let distance = base_distance(&apex, &[a, b, c], 0.1, size);
            // An origin on the outer side of the base is not in the tetrahedron.
            let is_outside = base_distance(&apex, &[a, b, c], 0.0, size).is_none();
            assert!(inner > 0.0 || is_outside);
            if inner == base && base > 0.1 + 1e-9 {
                found[0] += 1;
                assert!((distance.unwrap() - inner).abs() <= 2.0 * planes.error);
            } else if base < 0.1 - 1e-9 || inner < base - 1e-9 {
                found[1] += 1;
                assert!(distance.is_none());
            }
        }
        assert!(found[0] > 1000 && found[1] > 1000, "{found:?}");
    }

    #[test]
    fn flat_tetrahedra_are_refused() {
        let [o, x, y] = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        for d in [
            o,
            x,
            y * 0.5,
            x + y,
            Vec3::z() * f64::EPSILON,
            Vec3::repeat(f64::NAN),
        ] {
            assert!(Tetrahedron::new([o, x, y, d], f64::EPSILON).is_none());
        }
        assert!(Tetrahedron::new([o, x, y, Vec3::z()], f64::EPSILON).is_some());
    }
}
