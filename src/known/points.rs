// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The few points of each object that a proof without a hull knows, kept so that a farthest one is
//! found in few instructions.
//!
//! D holds the difference of *any* point of obj1 and any of obj2, not only of the two that one
//! direction found: k support points are worth k² points of D. P is the polytope of all of them, the
//! difference of the two objects' polytopes, and its support points cost no callback.

use crate::math::{Vec3, larger};
use crate::minkowski::support::SupportPoint;

/// Points of each object: a portal's, mostly four, and of the rounds after it. Even, two are compared at a
/// time. Measured on the recorded contacts: with 10 hits take 0.8 % more instructions.
pub const ROOM: usize = 8;
/// Places that are looked at whether or not they are taken; the other ones only where one of them is. A loop
/// as long as there are points ends where no processor foretells it.
const HALF: usize = ROOM / 2;

/// Points of one object, coordinate by coordinate. The first one is there in all places that are not
/// taken.
struct Cloud([[[f64; 2]; ROOM / 2]; 3]);

type Bits = u64;

/// The low bits of a product that name its point: its place, and one bit more, which is set.
const NAME: Bits = 31;

/// A number that is the same to a few ulps, and tells which. (The sum is one to the compiler, and a
/// comparison of two an instruction.)
#[inline(always)]
fn named(x: f64, i: usize) -> f64 {
    f64::from_bits(x.to_bits() & !NAME | (16 + i) as Bits) + 0.0
}

impl Cloud {
    const EMPTY: Self = Self([[[0.0; 2]; ROOM / 2]; 3]);

    /// Of one point.
    #[inline(always)]
    fn fill(&mut self, p: &Vec3) {
        self.0 = [
            [[p.x; 2]; ROOM / 2],
            [[p.y; 2]; ROOM / 2],
            [[p.z; 2]; ROOM / 2],
        ];
    }

    #[inline(always)]
    fn put(&mut self, i: usize, p: &Vec3) {
        let [x, y, z] = self.0.each_mut().map(|all| all.as_flattened_mut());
        let i = i.min(ROOM - 1);
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
        let mut best = self.best::<0>(n, [f64::NEG_INFINITY; 2]);
        if len > HALF {
            best = self.best::<HALF>(n, best);
        }
        let name = (larger(best[0], best[1]).to_bits() & 15) as usize;
        // Beyond is the first one again.
        if name < len { name } else { 0 }
    }

    /// The [`named`] products of the farthest of half the places, those from one on, and of these: of even
    /// ones and of odd.
    #[inline(always)]
    fn best<const FROM: usize>(&self, n: &Vec3, mut best: [f64; 2]) -> [f64; 2] {
        let [x, y, z] = &self.0;
        for i in FROM / 2..(FROM + HALF) / 2 {
            let (x, y, z) = (x[i], y[i], z[i]);
            for l in 0..2 {
                let along = n.x * x[l] + n.y * y[l] + n.z * z[l];
                best[l] = larger(named(along, 2 * i + l), best[l]);
            }
        }
        best
    }

    /// Which of `len` points are at least `least` along a direction: a bit each.
    #[inline(always)]
    fn level(&self, n: &Vec3, len: usize, least: f64) -> u32 {
        let mut level = 0;
        let [x, y, z] = &self.0;
        for i in 0..len.div_ceil(2).min(ROOM / 2) {
            let (x, y, z) = (x[i], y[i], z[i]);
            for l in 0..2 {
                let along = n.x * x[l] + n.y * y[l] + n.z * z[l];
                level |= u32::from(along >= least) << (2 * i + l);
            }
        }
        level & ((1 << len) - 1)
    }

    /// The square of how far one of `len` points is from `p`, m².
    #[inline(always)]
    fn extent(&self, p: &Vec3, len: usize) -> f64 {
        let mut far2 = [0.0; 2];
        let [x, y, z] = &self.0;
        for i in 0..len.div_ceil(2).min(ROOM / 2) {
            for l in 0..2 {
                let (x, y, z) = (x[i][l] - p.x, y[i][l] - p.y, z[i][l] - p.z);
                far2[l] = larger(x * x + y * y + z * z, far2[l]);
            }
        }
        larger(far2[0], far2[1])
    }
}

/// What is known of the two objects: P is the difference of the points.
pub struct Points {
    one: Cloud,
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
    /// No point. (Made in its place and filled there it is not copied.)
    pub const EMPTY: Self = Self {
        one: Cloud::EMPTY,
        two: Cloud::EMPTY,
        lens: [0; 2],
        names: [[0; 2]; ROOM],
        found: [[0; ROOM]; 2],
        directions: [Vec3::new(0.0, 0.0, 0.0); ROOM],
        asked: 0,
    };

    /// The first point of each, found along `n`.
    #[inline(always)]
    pub fn first(&mut self, n: &Vec3, p: &SupportPoint) {
        self.one.fill(&p.v1);
        self.two.fill(&p.v2);
        self.lens = [1; 2];
        self.directions[0] = *n;
        self.asked = 1;
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
        let j = self.two.add(two, &p.v2, k, by_two);
        self.names[k] = [i as u8, j as u8];
        self.directions[k] = *n;
        self.asked = k + 1;
    }

    /// Has each direction found another point of obj1 (`object` 0) or of obj2?
    #[inline(always)]
    pub fn is_new(&self, object: usize) -> bool {
        self.lens[object % 2] == self.asked
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

    /// The support point that it found.
    #[inline(always)]
    pub fn asked_point(&self, k: usize) -> SupportPoint {
        let [v1, v2] = self.witnesses(self.names(k));
        SupportPoint { v: v1 - v2, v1, v2 }
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

    /// The places of the points of obj1 (`object` 0) or of obj2 that are at least `least` along a
    /// direction: a bit each.
    #[inline(always)]
    pub fn level(&self, object: usize, n: &Vec3, least: f64) -> u32 {
        let [one, two] = self.lens;
        match object {
            0 => self.one.level(n, one, least),
            _ => self.two.level(n, two, least),
        }
    }

    /// The point of obj1 (`object` 0) or of obj2 at this place.
    #[inline(always)]
    pub fn point_of(&self, object: usize, i: usize) -> Vec3 {
        match object {
            0 => self.one.get(i),
            _ => self.two.get(i),
        }
    }

    /// The points of obj1 and of obj2 of these places.
    #[inline(always)]
    pub fn witnesses(&self, [i, j]: [usize; 2]) -> [Vec3; 2] {
        [self.one.get(i), self.two.get(j)]
    }

    /// The point of P of these two.
    #[inline(always)]
    pub fn point(&self, [i, j]: [usize; 2]) -> Vec3 {
        self.one.get(i) - self.two.get(j)
    }

    /// How far a known point of one of the objects lies beyond what a direction found of it, at most,
    /// metres.
    #[inline(never)]
    pub fn beyond(&self) -> f64 {
        let mut beyond = [f64::NEG_INFINITY; 2];
        let ([x, y, z], [u, v, w]) = (&self.one.0, &self.two.0);
        let [one, two] = self.lens;
        let pairs = one.max(two).div_ceil(2).min(ROOM / 2);
        for (n, names) in self.directions.iter().zip(&self.names).take(self.asked) {
            let [i, j] = names.map(usize::from);
            let (p, q) = (n.dot(&self.one.get(i)), n.dot(&self.two.get(j)));
            for i in 0..pairs {
                let (x, y, z, u, v, w) = (x[i], y[i], z[i], u[i], v[i], w[i]);
                for l in 0..2 {
                    let along = n.x * x[l] + n.y * y[l] + n.z * z[l] - p;
                    let against = q - (n.x * u[l] + n.y * v[l] + n.z * w[l]);
                    beyond[l] = larger(larger(along, against), beyond[l]);
                }
            }
        }
        larger(beyond[0], beyond[1])
    }

    /// The squares of how far the objects are known to reach from these points of theirs, m².
    #[inline(never)]
    pub fn extent(&self, [p, q]: [&Vec3; 2]) -> [f64; 2] {
        let [one, two] = self.lens;
        [self.one.extent(p, one), self.two.extent(q, two)]
    }

    /// The farthest point of P along a direction that need not be unit.
    #[inline(always)]
    pub fn extreme(&self, n: &Vec3) -> [usize; 2] {
        let [one, two] = self.lens;
        [self.one.farthest(n, one), self.two.farthest(&-n, two)]
    }
}
#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    pub fn random_points(r: &mut Random, count: usize) -> Points {
        let mut points = Points::EMPTY;
        for k in 0..count {
            let (n, v1, v2) = (r.direction(), r.vector(1.0), r.vector(1.0));
            let point = SupportPoint { v: v1 - v2, v1, v2 };
            match k {
                0 => points.first(&n, &point),
                _ => points.add(&n, &point),
            }
        }
        points
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
                let best = all.fold(f64::NEG_INFINITY, |best, names| {
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
