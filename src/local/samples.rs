// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The samples that a bundle keeps, and which of them is its centre.

use super::lanes::Vectors;
pub use super::lanes::{CUTS, Lanes, lane};
use crate::known::support::{Known, SupportPoint};
use crate::math::{EPSILON, Real, Vec3};

/// The lanes beside one, the last of them twice.
pub const OTHERS: [[usize; CUTS]; CUTS] = [[1, 2, 3, 3], [0, 2, 3, 3], [0, 1, 3, 3], [0, 1, 2, 2]];

/// A support point, asked.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Unit direction.
    pub n: Vec3,
    /// The support point there.
    pub p: SupportPoint,
    /// n·p, the support value.
    pub h: Real,
}

impl Sample {
    #[inline(always)]
    pub fn new(n: &Vec3, p: SupportPoint) -> Self {
        let h = n.dot(&p.v);
        Self { n: *n, p, h }
    }

    /// Rounding error of the support value, metres.
    #[inline(always)]
    pub fn rounding(&self) -> Real {
        let p = &self.p;
        let size = (p.v1.x.abs() + p.v1.y.abs() + p.v1.z.abs())
            + (p.v2.x.abs() + p.v2.y.abs() + p.v2.z.abs());
        8.0 * EPSILON * size
    }
}

/// The samples kept.
pub struct Samples<'a> {
    /// Unit directions, …
    pub n: Vectors,
    /// … their support points of D, …
    pub v: Vectors,
    /// … and support values.
    pub h: Lanes,
    /// Relative error of R as a pair of this sample told it; 1 where none did.
    pub error: Lanes,
    /// Where in `known` the support points are.
    at: [usize; CUTS],
    /// Every support point asked, as long as there is room.
    known: &'a mut Known,
    /// Samples in use; lanes beyond repeat the last one set.
    pub len: usize,
    /// The one with the least support value: the centre of the bundle.
    pub centre: usize,
    /// Rounding error of a support value, metres.
    pub rounding: Real,
    /// The extent of the object, metres.
    pub size: Real,
}

impl<'a> Samples<'a> {
    #[inline]
    pub fn new(known: &'a mut Known) -> Self {
        Self {
            n: Vectors::default(),
            v: Vectors::default(),
            h: Lanes::default(),
            error: Lanes::default(),
            at: [Known::NONE; CUTS],
            known,
            len: 0,
            centre: 0,
            rounding: 0.0,
            size: 0.0,
        }
    }

    /// The support point farthest along `n`, if it lies beyond the origin.
    pub fn farthest(&self, n: &Vec3) -> Option<SupportPoint> {
        self.known.farthest(n)
    }

    /// The support point of sample `i`.
    #[inline]
    pub fn point(&self, i: usize) -> &SupportPoint {
        self.known.get(self.at[lane(i)])
    }

    /// The support points asked, as far as there was room for them.
    pub fn known(&self) -> &[SupportPoint] {
        self.known.points()
    }

    /// The direction of the bundle's centre.
    #[inline(always)]
    pub fn dir(&self) -> Vec3 {
        self.n.get(self.centre)
    }

    /// The least support value seen.
    #[inline(always)]
    pub fn depth(&self) -> Real {
        self.h[self.centre]
    }

    /// A depth of zero within rounding, which cannot be lower.
    #[inline(always)]
    pub fn touch(&self) -> bool {
        self.depth() <= self.rounding
    }

    /// Names the centre first among the points known.
    pub fn lead(&mut self) {
        self.known.lead(self.at[lane(self.centre)]);
    }

    /// Makes it sample `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, new: &Sample, error: Real) {
        self.len = self.len.max(i + 1);
        let at = self.known.put(&new.p, &self.at);
        let last = self.len;
        for j in core::iter::once(i).chain(last..CUTS) {
            self.n.set(j, &new.n);
            self.v.set(j, &new.p.v);
            self.h[j] = new.h;
            self.error[j] = error;
            self.at[lane(j)] = at;
        }
    }

    /// Drops sample `i`; the last one takes its place. Returns where sample `j` is now.
    #[inline]
    fn drop(&mut self, i: usize, j: Option<usize>) -> Option<usize> {
        let last = self.len - 1;
        let (n, v) = (self.n.get(last), self.v.get(last));
        self.n.set(i, &n);
        self.v.set(i, &v);
        self.h[i] = self.h[last];
        self.at[lane(i)] = self.at[lane(last)];
        self.error[i] = self.error[last];
        if self.centre == last {
            self.centre = i;
        }
        self.len = last;
        j.map(|j| if j == last { i } else { j })
    }

    /// Drops any sample but the centre.
    pub fn evict_any(&mut self) {
        self.drop(usize::from(self.centre == 0), None);
    }

    /// Makes room for the next sample: evicts the cut that is lowest at the minimum of the
    /// model, where the cuts have these `levels`, but for the centre, the `newest` (it may
    /// have settled an error) and the `active` ones. Where these are all, the lowest one at
    /// the centre goes, where the levels are `home`. Returns where the sample `kept` is now.
    #[inline]
    pub fn evict(
        &mut self,
        newest: usize,
        active: &[usize; 3],
        levels: &Lanes,
        home: &Lanes,
        kept: Option<usize>,
    ) -> Option<usize> {
        let centre = self.centre;
        let evicted = levels
            .lowest(|i| i != centre && i != newest && !active.contains(&i))
            .or_else(|| home.lowest(|i| i != centre))
            .unwrap_or((centre + 1) % CUTS);
        self.drop(evicted, kept)
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::math::unit;
    use crate::shapes::{Random, Shape, corners, hull};

    /// The sample of D = shape, obj2 a point.
    pub fn ask(shape: &Shape, n: &Vec3) -> Sample {
        let v = shape(n);
        let p = SupportPoint {
            v,
            v1: v,
            v2: Vec3::zeros(),
        };
        Sample::new(n, p)
    }

    /// The samples along these directions, the lowest of them the centre.
    pub fn samples<'a>(known: &'a mut Known, shape: &Shape, dirs: &[Vec3]) -> Samples<'a> {
        let mut samples = Samples::new(known);
        for (i, n) in dirs.iter().enumerate() {
            let new = ask(shape, n);
            samples.rounding = samples.rounding.max(new.rounding());
            samples.size = samples.size.max(new.p.v.norm());
            if i == 0 || new.h < samples.depth() {
                samples.centre = i;
            }
            samples.set(i, &new, 1.0);
        }
        samples
    }

    /// So many directions, no farther from the first than so many radians.
    pub fn around(r: &mut Random, count: usize, angle: Real) -> Vec<Vec3> {
        let b = r.direction();
        let aside = |r: &mut Random| unit(&(b + r.direction() * r.within(0.1, 1.0) * angle));
        let others: Vec<_> = (1..count).filter_map(|_| aside(r)).collect();
        core::iter::once(b).chain(others).collect()
    }

    #[test]
    fn lanes_beyond_the_last_sample_repeat_one() {
        let cube = hull(&corners(Vec3::new(1.0, 1.0, 1.0)));
        let mut r = Random::new(1);
        let mut known = Known::default();
        let samples = samples(&mut known, &cube, &around(&mut r, 2, 0.5));
        assert_eq!(samples.len, 2);
        for i in 2..CUTS {
            assert_eq!(samples.n.get(i), samples.n.get(1));
            assert_eq!(samples.v.get(i), samples.v.get(1));
            assert_eq!(samples.point(i), samples.point(1));
        }
    }

    #[test]
    fn the_lowest_cut_that_serves_nothing_is_evicted() {
        let cube = hull(&corners(Vec3::new(1.0, 1.0, 1.0)));
        let mut r = Random::new(2);
        for _ in 0..50 {
            let dirs = around(&mut r, CUTS, 0.5);
            let levels = Lanes::default().map(|_| r.within(-1.0, 1.0));
            let newest = 3;
            for active in [[0, 0, 0], [0, 1, 1], [0, 1, 2]] {
                let mut known = Known::default();
                let mut samples = samples(&mut known, &cube, &dirs);
                samples.centre = 0;
                let before: Vec<_> = (0..CUTS).map(|i| samples.n.get(i)).collect();
                let probed = samples.evict(newest, &active, &levels, &levels, Some(newest));
                let spare = |i: &usize| *i != newest && !active.contains(i);
                let below = |i: &usize, j: &usize| levels[*i].total_cmp(&levels[*j]);
                let evicted = (0..CUTS)
                    .filter(spare)
                    .min_by(below)
                    .or_else(|| (1..CUTS).min_by(below))
                    .unwrap();
                assert_eq!(samples.len, CUTS - 1);
                let kept: Vec<_> = (0..samples.len).map(|i| samples.n.get(i)).collect();
                assert!(!kept.contains(&before[evicted]));
                if evicted != newest {
                    assert_eq!(kept[probed.unwrap()], before[newest]);
                }
                assert_eq!(samples.dir(), before[0]);
            }
        }
    }

    #[test]
    fn levels_that_are_no_numbers_evict_another_than_the_centre() {
        let cube = hull(&corners(Vec3::new(1.0, 1.0, 1.0)));
        let dirs = around(&mut Random::new(3), CUTS, 0.5);
        let nan = Lanes::all(Real::NAN);
        for centre in 0..CUTS {
            let mut known = Known::default();
            let mut samples = samples(&mut known, &cube, &dirs);
            samples.centre = centre;
            samples.evict(centre, &[centre; 3], &nan, &nan, None);
            assert_eq!(samples.dir(), dirs[centre]);
        }
    }
}
