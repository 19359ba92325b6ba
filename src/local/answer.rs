// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The end of a search: its answer, witness points, and what is handed on.

use super::memory::{EDGES, Kind, Memory};
use super::search::{HAIR, LATEST, Sample, Search};
use super::walk::{End, ROOM};
use crate::contact::{INSIDE, Penetration};
use crate::contacts::pressure;
use crate::known::support::{Known, SupportPoint};
use crate::math::{Real, Vec3, larger};

impl Search {
    /// What finds the cuts of the minimum along unit `dir` again stays behind.
    #[inline]
    pub fn leave(&self, dir: &Vec3, memory: &mut Memory) {
        let round = [0, 1].map(|o: usize| self.objects[o % 2].round(dir));
        memory.keep(dir, &self.slopes, self.count, &round);
    }

    /// The lowest direction met, after a search that found no minimum: the witness points are points
    /// of the support planes, in the middle between its support points. `known` gains the points.
    #[cold]
    pub fn lowest_met(&self, known: &mut Known) -> Penetration {
        let Sample { n, p, h } = self.best();
        known.put(p, &[]);
        for sample in self.samples.iter().take(self.asked) {
            known.add(&sample.p);
        }
        let half = (p.v - n * *h) * 0.5;
        Penetration {
            depth: *h,
            depth_lower: 0.0,
            dir: *n,
            normal: *n,
            point1: p.v1 - half,
            point2: p.v2 + half,
            pos: Vec3::zeros(),
            extent: [0.0; 2],
            iterations: self.asked as u64,
        }
    }

    /// The answer at a sample, with witness points, if the active points show them.
    #[inline(never)]
    pub(super) fn conclude(&mut self, at: usize, known: &mut Known, hit: &mut Penetration) -> bool {
        let at = &self.samples[at % LATEST];
        let step = &self.step;
        let n = at.n;
        let n = &n;
        let depth = at.h;
        let end = &step.end;
        // Of what bends the witnesses are at the model's minimum: as deep, and below the origin.
        let out = HAIR * self.finest;
        // As fine as rounding R leads to none.
        let fine = self.finest * self.finest <= INSIDE * INSIDE * self.extent2;
        let near2 = larger(2.0 * depth * self.finest, self.rounding * self.rounding);
        let meets = |points: &[Vec3; 2]| {
            let foot = points[0] + points[1];
            let height = foot.dot(n);
            let across2 = (foot - n * height).norm_squared();
            height >= depth - self.tolerance && across2 <= near2
        };
        // Where they are near enough the points of the bodies themselves, else those that R leads to.
        let (mut points, mut slopes) = self.witnesses(n, out);
        if !meets(&points) {
            if !self.is_curved() || end.on_border || fine {
                return false;
            }
            (points, slopes) = self.witnesses(&step.n, out);
            if !meets(&points) {
                return false;
            }
        }
        let (mut point1, mut point2) = (points[0], -points[1]);
        // Of one cut the point here is the witness.
        if end.count == 0 {
            let same = self.same().round;
            let own = Self::points(at);
            for o in 0..2 {
                let (object, own) = (&self.objects[o], &own[o]);
                let off = object.point(end.active[o], n, out) - own.p;
                if object.kind != Kind::Curved && off.norm_squared() > same * same {
                    return false;
                }
            }
        }
        // Onto the support planes of both objects.
        point1 += n * n.dot(&(at.p.v1 - point1));
        point2 += n * n.dot(&(at.p.v2 - point2));
        self.show(at, end, known);
        let across = |v: &Vec3| v - n * n.dot(v);
        self.slopes = slopes.map(|v| across(&v));
        self.count = end.count + 1;
        if end.count == 2 && end.kinks[0].object != end.kinks[1].object {
            self.count = EDGES as usize;
        }
        *hit = Penetration {
            depth,
            depth_lower: 0.0,
            dir: *n,
            normal: *n,
            point1,
            point2,
            pos: Vec3::zeros(),
            extent: pressure::extent(
                known.points().iter().map(|p| [p.v1, p.v2]),
                [&point1, &point2],
            ),
            iterations: self.asked as u64,
        };
        true
    }

    /// The means of the active points of both objects, obj2's turned about, and three points of D's face,
    /// each of what is round where unit `m` looks to.
    #[inline(always)]
    fn witnesses(&self, m: &Vec3, out: Real) -> ([Vec3; 2], [Vec3; 3]) {
        let end = &self.step.end;
        let mut points =
            [0, 1].map(|o: usize| self.objects[o % 2].point(end.active[o % 2], m, out));
        let mut slopes = [points[0] + points[1]; 3];
        for (i, kink) in end.kinks.iter().take(end.count).enumerate() {
            let object = &self.objects[kink.object % 2];
            let there = object.point(kink.point, m, out);
            let e = there - object.point(end.active[kink.object % 2], m, out);
            points[kink.object % 2] += e * end.weights[i];
            slopes[i + 1] += e;
        }
        (points, slopes)
    }

    /// Names the points of D for the proof: the active ones, the one here, the others.
    #[inline(always)]
    pub(super) fn show(&self, at: &Sample, end: &End, known: &mut Known) {
        let [a, b] = [0, 1].map(|o: usize| self.objects[o % 2].at[end.active[o % 2] % ROOM].p);
        let mut put = |p: &Vec3, q: &Vec3| {
            known.push(&SupportPoint {
                v: p + q,
                v1: *p,
                v2: -q,
            });
        };
        let own = |i: usize| {
            let kink = &end.kinks[i % 2];
            self.objects[kink.object % 2].at[kink.point % ROOM].p
        };
        put(&a, &b);
        for i in 0..end.count.min(2) {
            if end.kinks[i].object == 0 {
                put(&own(i), &b);
            } else {
                put(&a, &own(i));
            }
        }
        // The one here, which may be none of these.
        known.put(&at.p, &[]);
        // Three active ones are mostly enough; of what is round they were seen elsewhere.
        if end.count == 1 || end.count == 2 && self.is_round() || self.is_curved() {
            for sample in self.samples.iter().take(self.asked) {
                known.add(&sample.p);
            }
        }
    }
}
