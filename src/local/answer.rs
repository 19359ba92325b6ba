// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The end of a search: its answer, witness points, and what is handed on.

use super::memory::{EDGES, Memory};
use super::search::{HAIR, Sample, Search};
use super::walk::ROOM;
use crate::contact::Penetration;
use crate::contacts::pressure;
use crate::math::{Vec3, larger};
use crate::minkowski::support::{Known, SupportPoint};

impl Search {
    /// What finds the cuts of the minimum along unit `dir` again stays behind.
    #[inline]
    pub fn leave(&self, dir: &Vec3, memory: &mut Memory) {
        let round = self.objects.each_ref().map(|object| object.round(dir));
        memory.keep(dir, &self.slopes, self.count, &round);
    }

    /// The lowest direction met, after a search that found no minimum: the witness points are points
    /// of the support planes, in the middle between its support points. `known` gains the points.
    #[cold]
    pub fn lowest_met(&self, known: &mut Known) -> Penetration {
        let Sample { n, p, h } = &self.best;
        self.name(p, true, known);
        let half = (p.v - n * *h) * 0.5;
        Penetration {
            depth: *h,
            dir: *n,
            normal: *n,
            point1: p.v1 - half,
            point2: p.v2 + half,
            iterations: self.asked as u64,
            ..Penetration::default()
        }
    }

    /// The answer at a sample, with witness points, if the active points show them.
    #[inline(never)]
    pub(super) fn conclude(
        &mut self,
        at: &Sample,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> bool {
        let (n, depth) = (&at.n, at.h);
        let here = Self::points(at);
        let end = &self.step.end;
        let near2 = larger(2.0 * depth * self.finest, self.rounding * self.rounding);
        // The means of the active points of both objects, obj2's turned about, and three points of D's face.
        let own = |o: usize, k: usize| self.objects[o % 2].point(k, n, HAIR * self.finest);
        // Of an object of one point that is the one found here: what is round may end before.
        let active = |o: usize| {
            let mut kinks = end.kinks.iter().take(end.count);
            if self.objects[o % 2].is_round() && kinks.all(|kink| kink.object != o) {
                here[o % 2].p
            } else {
                own(o, end.active[o % 2])
            }
        };
        let mut points = [active(0), active(1)];
        let mut slopes = [points[0] + points[1]; 3];
        for (i, kink) in end.kinks.iter().take(end.count).enumerate() {
            let o = kink.object % 2;
            let e = own(o, kink.point) - own(o, end.active[o]);
            points[o] += e * end.weights[i];
            slopes[i + 1] += e;
        }
        let foot = points[0] + points[1];
        let height = foot.dot(n);
        let across2 = (foot - n * height).norm_squared();
        if !(height >= depth - self.tolerance && across2 <= near2) {
            return false;
        }
        // Onto the support planes of both objects.
        let onto = |p: Vec3, own: &Vec3| p + n * n.dot(&(own - p));
        let (point1, point2) = (onto(points[0], &at.p.v1), onto(-points[1], &at.p.v2));
        self.show(at, known);
        let across = |v: Vec3| v - n * n.dot(&v);
        self.slopes = slopes.map(across);
        let edges = end.count == 2 && end.kinks[0].object != end.kinks[1].object;
        self.count = if edges { EDGES as usize } else { end.count + 1 };
        let seen = known.points().iter().map(|p| [p.v1, p.v2]);
        *hit = Penetration {
            depth,
            dir: *n,
            normal: *n,
            point1,
            point2,
            extent: pressure::extent(seen, [&point1, &point2]),
            iterations: self.asked as u64,
            ..Penetration::default()
        };
        true
    }

    /// Names the points of D for the proof: the active ones, the one here, the others.
    #[inline(always)]
    fn show(&self, at: &Sample, known: &mut Known) {
        let end = &self.step.end;
        let own = |o: usize, k: usize| self.objects[o % 2].at[k % ROOM].p;
        let active = [own(0, end.active[0]), own(1, end.active[1])];
        let mut push = |[p, q]: [Vec3; 2]| {
            known.push(&SupportPoint {
                v: p + q,
                v1: p,
                v2: -q,
            });
        };
        push(active);
        for kink in end.kinks.iter().take(end.count) {
            let mut pair = active;
            pair[kink.object % 2] = own(kink.object, kink.point);
            push(pair);
        }
        // Three active ones are mostly enough; of what is round they were seen elsewhere.
        let few = end.count == 1 || end.count == 2 && self.is_round() || self.is_curved();
        self.name(&at.p, few, known);
    }

    /// Names a point, which may be none of those before, and maybe the others.
    #[inline(always)]
    fn name(&self, p: &SupportPoint, others: bool, known: &mut Known) {
        known.add(p);
        let others = if others { self.asked } else { 0 };
        for sample in self.samples.iter().take(others) {
            known.add(&sample.p);
        }
    }
}
