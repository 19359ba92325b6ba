// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! One number or vector for each of four samples, coordinate by coordinate, two at a time:
//! what is computed for all samples needs no loop and compiles to vector instructions.

use core::array::from_fn;
use core::ops::{Add, Mul, Sub};

use crate::math::{self, Real, Vec3};

/// How many samples there are.
pub const CUTS: usize = 4;

/// Two numbers side by side.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Two([Real; 2]);

/// One number for each sample.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub struct Lanes([Two; CUTS / 2]);

impl Two {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(Real, Real) -> Real) -> Self {
        Self([f(self.0[0], o.0[0]), f(self.0[1], o.0[1])])
    }
}

impl Lanes {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(a: Real) -> Self {
        Self([Two([a; 2]); CUTS / 2])
    }

    /// The number of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    pub fn get(&self, i: usize) -> Real {
        self.0[(i / 2) % (CUTS / 2)].0[i % 2]
    }

    /// Sets the number of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    pub fn set(&mut self, i: usize, a: Real) {
        self.0[(i / 2) % (CUTS / 2)].0[i % 2] = a;
    }

    /// A lane-by-lane function.
    #[inline(always)]
    pub fn map(self, f: impl Fn(Real) -> Real) -> Self {
        Self(from_fn(|i| Two(self.0[i].0.map(&f))))
    }

    /// The lanes in which `f` holds, as bits.
    #[inline(always)]
    pub fn mask(&self, f: impl Fn(Real) -> bool) -> u32 {
        let [Two([a, b]), Two([c, d])] = self.0;
        u32::from(f(a)) | u32::from(f(b)) << 1 | u32::from(f(c)) << 2 | u32::from(f(d)) << 3
    }

    /// The lesser of each two.
    #[inline(always)]
    pub fn lesser(&self, o: &Self) -> Self {
        Self(from_fn(|i| self.0[i].zip(o.0[i], math::lesser)))
    }

    /// The least.
    #[inline(always)]
    pub fn least(&self) -> Real {
        let [a, b] = self.0[0].zip(self.0[1], math::lesser).0;
        math::lesser(a, b)
    }

    /// The largest.
    #[inline(always)]
    pub fn most(&self) -> Real {
        let [a, b] = self.0[0].zip(self.0[1], math::larger).0;
        math::larger(a, b)
    }

    /// The absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(Real::abs)
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(from_fn(|i| self.0[i].zip(o.0[i], |a, b| a + b)))
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(from_fn(|i| self.0[i].zip(o.0[i], |a, b| a - b)))
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(from_fn(|i| self.0[i].zip(o.0[i], |a, b| a * b)))
    }
}

impl Mul<Real> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, f: Real) -> Self {
        self * Self::all(f)
    }
}

/// One vector for each sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vectors {
    x: Lanes,
    y: Lanes,
    z: Lanes,
}

impl Vectors {
    /// The vector of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x.get(i), self.y.get(i), self.z.get(i))
    }

    /// Sets the vector of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: &Vec3) {
        self.x.set(i, v.x);
        self.y.set(i, v.y);
        self.z.set(i, v.z);
    }

    /// The products with `v`.
    #[inline(always)]
    pub fn dot(&self, v: &Vec3) -> Lanes {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// The differences from other vectors.
    #[inline(always)]
    pub fn minus(&self, o: &Self) -> Self {
        Self {
            x: self.x - o.x,
            y: self.y - o.y,
            z: self.z - o.z,
        }
    }

    /// Adds multiples of other vectors.
    #[inline]
    pub fn add(&mut self, o: &Self, f: Real) {
        self.x = self.x + o.x * f;
        self.y = self.y + o.y * f;
        self.z = self.z + o.z * f;
    }

    /// The squared distances from `v`.
    #[inline(always)]
    pub fn distance2(&self, v: &Vec3) -> Lanes {
        let (x, y, z) = (
            self.x - Lanes::all(v.x),
            self.y - Lanes::all(v.y),
            self.z - Lanes::all(v.z),
        );
        x * x + y * y + z * z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_numbers_side_by_side() {
        let mut a = Lanes::all(2.0);
        a.set(1, -3.0);
        a.set(3, 5.0);
        let b = a * 2.0 - Lanes::all(1.0) + a * a;
        assert_eq!(core::array::from_fn(|i| b.get(i)), [7.0, 2.0, 7.0, 34.0]);
        assert_eq!(a.mask(|a| a < 3.0), 0b0111);
        assert_eq!(a.abs().get(1), 3.0);
        assert_eq!(a.map(|a| a + 1.0).get(3), 6.0);
        let mut v = Vectors::default();
        v.set(2, &Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(v.get(2), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(v.dot(&Vec3::new(3.0, 2.0, 1.0)).get(2), 10.0);
        assert_eq!(v.distance2(&Vec3::new(1.0, 0.0, 3.0)).get(2), 4.0);
    }
}
