// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! One number or vector for each of four samples, coordinate by coordinate, two at a time:
//! what is computed for all samples needs no loop and compiles to vector instructions.

use core::array::from_fn;
use core::ops::{Add, Div, Index, IndexMut, Mul, Sub};

use crate::math::{Real, Vec3};

/// Samples kept: three active cuts and the newest.
pub const CUTS: usize = 4;

/// The sample that is meant: in range whatever `i` is, and the compiler sees it.
#[inline(always)]
pub fn lane(i: usize) -> usize {
    i % CUTS
}

/// One number for each sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes([Real; CUTS]);

impl Lanes {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(a: Real) -> Self {
        Self([a; CUTS])
    }

    /// A number for each sample's index.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> Real) -> Self {
        Self(from_fn(f))
    }

    /// A lane-by-lane function.
    #[inline(always)]
    pub fn map(self, f: impl FnMut(Real) -> Real) -> Self {
        Self(self.0.map(f))
    }

    /// A function of two, lane by lane.
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(Real, Real) -> Real) -> Self {
        Self(from_fn(|i| f(self.0[i], o.0[i])))
    }

    /// The least of those lanes that are `free`; `None` where there is none, or none of them
    /// is a number below infinity.
    #[inline]
    pub fn lowest(&self, free: impl Fn(usize) -> bool) -> Option<usize> {
        let mut least = Real::INFINITY;
        let mut lowest = None;
        for i in (0..CUTS).filter(|&i| free(i)) {
            if self[i] < least {
                least = self[i];
                lowest = Some(i);
            }
        }
        lowest
    }
}

impl Index<usize> for Lanes {
    type Output = Real;
    /// The number of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    fn index(&self, i: usize) -> &Real {
        &self.0[lane(i)]
    }
}

impl IndexMut<usize> for Lanes {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut Real {
        &mut self.0[lane(i)]
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.zip(o, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.zip(o, |a, b| a / b)
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
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// Sets the vector of sample `i`, which is taken modulo [`CUTS`].
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: &Vec3) {
        self.x[i] = v.x;
        self.y[i] = v.y;
        self.z[i] = v.z;
    }

    /// The products with `v`.
    #[inline(always)]
    pub fn dot(&self, v: &Vec3) -> Lanes {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_numbers_side_by_side() {
        let mut a = Lanes::all(2.0);
        (a[1], a[3]) = (-3.0, 5.0);
        let b = a * 2.0 - Lanes::all(1.0) + a * a;
        assert_eq!(core::array::from_fn(|i| b[i]), [7.0, 2.0, 7.0, 34.0]);
        assert_eq!(a.map(Real::abs)[1], 3.0);
        assert_eq!(a.lowest(|i| i != 1), Some(0));
        assert_eq!(a.lowest(|_| false), None);
        let mut v = Vectors::default();
        v.set(2, &Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(v.get(2), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(v.dot(&Vec3::new(3.0, 2.0, 1.0))[2], 10.0);
    }
}
