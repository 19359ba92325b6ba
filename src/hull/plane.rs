// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Homogeneous planes: all x with N·x = d, where N is not normalised.
//!
//! What the polytope computes most is written here in whole lanes of two numbers, and
//! lanes are taken apart last: plain expressions make the compiler pair other lanes and
//! write planes in small pieces (10 to 17 % more instructions for a whole query).

use crate::math::Vec3;

/// Two numbers side by side.
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

/// A plane (N, d); also a point (p, −1), so that their product is the height of p.
#[derive(Clone, Copy, Debug)]
pub struct Plane(Lanes, Lanes);

impl Plane {
    /// The plane with this normal, N·x = d.
    #[inline(always)]
    pub fn new(n: &Vec3, d: f64) -> Self {
        Self(Lanes([n.x, n.y]), Lanes([n.z, d]))
    }

    /// A point, to take heights of.
    #[inline(always)]
    pub fn point(p: &Vec3) -> Self {
        // Were the −1 known, its product would leave the lanes.
        Self::new(p, core::hint::black_box(-1.0))
    }

    /// From the four numbers N, d.
    #[inline(always)]
    pub fn of(a: &[f64; 4]) -> Self {
        Self(Lanes([a[0], a[1]]), Lanes([a[2], a[3]]))
    }

    /// The four numbers N, d.
    #[inline(always)]
    pub fn array(&self) -> [f64; 4] {
        [self.0.0[0], self.0.0[1], self.1.0[0], self.1.0[1]]
    }

    /// N.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        Vec3::new(self.0.0[0], self.0.0[1], self.1.0[0])
    }

    /// d.
    #[inline(always)]
    pub fn offset(&self) -> f64 {
        self.1.0[1]
    }

    /// N·p − d for a [`Plane::point`]: how far it lies outside, times |N|.
    #[inline(always)]
    pub fn height(&self, point: &Self) -> f64 {
        let x = self.0.times(point.0).plus(self.1.times(point.1));
        x.0[0] + x.0[1]
    }

    /// The plane a share `w` of the way to another: it holds their common line.
    #[inline(always)]
    pub fn towards(&self, other: &Self, w: f64) -> Self {
        let w = Lanes([w, w]);
        Self(
            self.0.plus(w.times(other.0.minus(self.0))),
            self.1.plus(w.times(other.1.minus(self.1))),
        )
    }

    /// The square of the distance from the origin with the sign of d, m², and |N|².
    #[inline(always)]
    pub fn signed_square(&self) -> (f64, f64) {
        let a = self.0.times(self.0);
        let b = self.1.times(self.1.abs());
        let n2 = (a.0[0] + a.0[1]) + b.0[0].abs();
        (b.0[1] / n2, n2)
    }

    /// The product of the two normals.
    #[inline(always)]
    pub fn along(&self, other: &Self) -> f64 {
        let q = self.0.times(other.0);
        (q.0[0] + self.1.0[0] * other.1.0[0]) + q.0[1]
    }

    /// The sum, number by number.
    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        Self(self.0.plus(other.0), self.1.plus(other.1))
    }

    /// The same plane with N and d times `k`.
    #[inline(always)]
    pub fn scaled(&self, k: f64) -> Self {
        let k = Lanes([k, k]);
        Self(self.0.times(k), self.1.times(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_distances_and_mixtures() {
        let x = Plane::new(&(Vec3::x() * 2.0), 6.0);
        let y = Plane::new(&Vec3::y(), -1.0);
        assert_eq!(x.height(&Plane::point(&Vec3::new(4.0, 9.0, 9.0))), 2.0);
        assert_eq!(x.signed_square(), (9.0, 4.0));
        assert_eq!(y.signed_square(), (-1.0, 1.0));
        assert_eq!(x.along(&y), 0.0);
        // A point of both planes is one of every mixture.
        let both = Plane::point(&Vec3::new(3.0, -1.0, 7.0));
        assert_eq!(x.towards(&y, 0.25).height(&both), 0.0);
        assert_eq!(x.towards(&y, 1.0).array(), y.array());
        assert_eq!(x.plus(&y).scaled(2.0).array(), [4.0, 2.0, 0.0, 10.0]);
    }
}
