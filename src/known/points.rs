// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The few points of each object that a proof without a hull knows, kept so that a farthest one is
//! found in few instructions.
//!
//! D holds the difference of *any* point of obj1 and any of obj2, not only of the two that one
//! direction found: k support points are worth k² points of D. P is the polytope of all of them, the
//! difference of the two objects' polytopes, and its support points cost no callback.

use crate::known::support::SupportPoint;
use crate::math::{Real, Vec3, larger};

/// Points of each object: a portal's, mostly four, and of the rounds after it. Derived; even, two are
/// compared at a time. Measured on the recorded contacts: with 8 cold ones take 1.5 % more
/// instructions, 12 cost warm ones 3 %.
pub const ROOM: usize = 10;

/// Points of one object, coordinate by coordinate. Where their number is odd the last one is there
/// twice.
struct Cloud([[[Real; 2]; ROOM / 2]; 3]);

#[cfg(not(feature = "single"))]
type Bits = u64;
#[cfg(feature = "single")]
type Bits = u32;

/// The low bits of a product that name its point: its place, and one bit more, which is set.
const NAME: Bits = 31;

/// A number that is the same to a few ulps, and tells which. (The sum is one to the compiler, and a
/// comparison of two an instruction.)
#[inline(always)]
fn named(x: Real, i: usize) -> Real {
    Real::from_bits(x.to_bits() & !NAME | (16 + i) as Bits) + 0.0
}

impl Cloud {
    #[inline(always)]
    fn of(p: &Vec3) -> Self {
        let mut cloud = Self([[[0.0; 2]; ROOM / 2]; 3]);
        cloud.put(0, p);
        cloud
    }

    #[inline(always)]
    fn put(&mut self, i: usize, p: &Vec3) {
        let [x, y, z] = self.0.each_mut().map(|all| all.as_flattened_mut());
        let i = i.min(ROOM - 1);
        (x[i], y[i], z[i]) = (p.x, p.y, p.z);
        // Of an odd place itself.
        let i = (i | 1).min(ROOM - 1);
        (x[i], y[i], z[i]) = (p.x, p.y, p.z);
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Vec3 {
        let [x, y, z] = self.0.each_ref().map(|all| all.as_flattened());
        let i = i.min(ROOM - 1);
        Vec3::new(x[i], y[i], z[i])
    }

    /// Adds a point that direction number `by` found, unless it is there. Returns its place.
    #[inline(always)]
    fn add(&mut self, len: &mut usize, p: &Vec3, by: usize, found: &mut [u8; ROOM]) -> usize {
        let [x, y, z] = self.0.each_ref().map(|all| all.as_flattened());
        for i in 0..(*len).min(ROOM) {
            if x[i] == p.x && y[i] == p.y && z[i] == p.z {
                return i;
            }
        }
        let i = (*len).min(ROOM - 1);
        self.put(i, p);
        found[i] = by as u8;
        *len = i + 1;
        i
    }

    /// The place of the point farthest along a direction that need not be unit, to a few ulps, of
    /// `len` points.
    #[inline(always)]
    fn farthest(&self, n: &Vec3, len: usize) -> usize {
        if len < 2 {
            return 0;
        }
        let mut best = [Real::NEG_INFINITY; 2];
        let [x, y, z] = &self.0;
        for i in 0..len.div_ceil(2).min(ROOM / 2) {
            let (x, y, z) = (x[i], y[i], z[i]);
            for l in 0..2 {
                let along = n.x * x[l] + n.y * y[l] + n.z * z[l];
                best[l] = larger(named(along, 2 * i + l), best[l]);
            }
        }
        let name = larger(best[0], best[1]).to_bits() & 15;
        (name as usize).min(len - 1)
    }

    /// How much farther along a unit direction one of `len` points is than the point at place `i`, at
    /// most, metres.
    #[inline(always)]
    fn beyond(&self, n: &Vec3, len: usize, i: usize) -> Real {
        let mut best = [Real::NEG_INFINITY; 2];
        let [x, y, z] = &self.0;
        for i in 0..len.div_ceil(2).min(ROOM / 2) {
            let (x, y, z) = (x[i], y[i], z[i]);
            for l in 0..2 {
                best[l] = larger(n.x * x[l] + n.y * y[l] + n.z * z[l], best[l]);
            }
        }
        larger(best[0], best[1]) - n.dot(&self.get(i))
    }
}

/// What is known of the two objects: P is the difference of the points.
pub struct Points {
    one: Cloud,
    /// Of obj2, turned round.
    two: Cloud,
    /// How many points each object has; one that comes again counts once.
    lens: [usize; 2],
    /// Of each direction asked, the places of obj1's and of obj2's point.
    names: [[u8; 2]; ROOM],
    /// Of each point, the number of the direction that found it first.
    found: [[u8; ROOM]; 2],
    directions: [Vec3; ROOM],
    asked: usize,
}

impl Points {
    /// One point of each, found along `n`.
    #[inline(always)]
    pub fn of(n: &Vec3, p: &SupportPoint) -> Self {
        let mut directions = [Vec3::zeros(); ROOM];
        directions[0] = *n;
        Self {
            one: Cloud::of(&p.v1),
            two: Cloud::of(&-p.v2),
            lens: [1; 2],
            names: [[0; 2]; ROOM],
            found: [[0; ROOM]; 2],
            directions,
            asked: 1,
        }
    }

    /// Is there no room?
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.asked >= ROOM
    }

    /// Adds a point of each, found along `n`.
    #[inline(always)]
    pub fn add(&mut self, n: &Vec3, p: &SupportPoint) {
        let k = self.asked.min(ROOM - 1);
        let [one, two] = &mut self.lens;
        let [by_one, by_two] = &mut self.found;
        let i = self.one.add(one, &p.v1, k, by_one);
        let j = self.two.add(two, &-p.v2, k, by_two);
        self.names[k] = [i as u8, j as u8];
        self.directions[k] = *n;
        self.asked = k + 1;
    }

    /// How many directions have been asked.
    #[inline(always)]
    pub fn asked(&self) -> usize {
        self.asked
    }

    /// The direction asked as number `k`.
    #[inline(always)]
    pub fn direction(&self, k: usize) -> Vec3 {
        self.directions[k.min(ROOM - 1)]
    }

    /// The places of the points that it found.
    #[inline(always)]
    pub fn names(&self, k: usize) -> [usize; 2] {
        self.names[k.min(ROOM - 1)].map(usize::from)
    }

    /// The number of the direction that found the point of obj1 (`object` 0) or of obj2 at this place.
    #[inline(always)]
    pub fn found(&self, object: usize, name: usize) -> u32 {
        u32::from(self.found[object % 2][name.min(ROOM - 1)])
    }

    /// The points of obj1 and of obj2 of these places.
    #[inline(always)]
    pub fn witnesses(&self, [i, j]: [usize; 2]) -> [Vec3; 2] {
        [self.one.get(i), -self.two.get(j)]
    }

    /// The point of P of these two.
    #[inline(always)]
    pub fn point(&self, [i, j]: [usize; 2]) -> Vec3 {
        self.one.get(i) + self.two.get(j)
    }

    /// How far a known point of one of the objects lies beyond what a direction found of it, at most,
    /// metres.
    #[inline(always)]
    pub fn beyond(&self) -> Real {
        let mut beyond = Real::NEG_INFINITY;
        let [one, two] = self.lens;
        for (n, found) in self.directions.iter().zip(&self.names).take(self.asked) {
            let [i, j] = found.map(usize::from);
            beyond = larger(self.one.beyond(n, one, i), beyond);
            beyond = larger(self.two.beyond(n, two, j), beyond);
        }
        beyond
    }

    /// The farthest point of P along a direction that need not be unit.
    #[inline(never)]
    pub fn extreme(&self, n: &Vec3) -> [usize; 2] {
        let [one, two] = self.lens;
        [self.one.farthest(n, one), self.two.farthest(n, two)]
    }
}
#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    pub fn random_points(r: &mut Random, count: usize) -> Points {
        let mut points = None;
        for _ in 0..count {
            let (n, v1, v2) = (r.direction(), r.vector(1.0), r.vector(1.0));
            let point = SupportPoint { v: v1 - v2, v1, v2 };
            match &mut points {
                None => points = Some(Points::of(&n, &point)),
                Some(points) => points.add(&n, &point),
            }
        }
        points.unwrap()
    }

    #[test]
    fn any_two_points_make_one() {
        let mut r = Random::new(3);
        for count in 1..=ROOM {
            for _ in 0..50 {
                let points = random_points(&mut r, count);
                let n = r.vector(3.0);
                let found = n.dot(&points.point(points.extreme(&n)));
                let all = (0..count).flat_map(|i| (0..count).map(move |j| [i, j]));
                let best = all.fold(Real::NEG_INFINITY, |best, names| {
                    larger(best, n.dot(&points.point(names)))
                });
                assert!(
                    (found - best).abs() < 512.0 * EPSILON,
                    "{count} {found} {best}"
                );
            }
        }
    }

    #[test]
    fn a_point_that_comes_again_counts_once() {
        let mut r = Random::new(4);
        let mut points = random_points(&mut r, 3);
        let [v1, v2] = points.witnesses([1, 2]);
        let n = r.direction();
        points.add(&n, &SupportPoint { v: v1 - v2, v1, v2 });
        assert_eq!((points.asked(), points.lens), (4, [3, 3]));
        assert_eq!((points.names(3), points.direction(3)), ([1, 2], n));
        assert_eq!((points.found(0, 1), points.found(1, 2)), (1, 2));
    }
}
