// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The end of a search: its answer, witness points, and what is handed on.

use super::memory::{EDGES, Memory};
use super::search::{HAIR, LATEST, Sample, Search};
use super::walk::{End, ROOM};
use crate::contact::{INSIDE, Penetration};
use crate::contacts::pressure;
use crate::known::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{Real, Vec3, larger, perpendicular, unit};

/// How far beside a disc's axis its rim is asked for, radians: enough to tell it from the others'
/// points by five digits.
const BESIDE: Real = 1e-4;

impl Search {
    /// The answer of a search that found a minimum; what finds its cuts again stays behind.
    #[inline]
    pub fn minimum(&self, memory: &mut Memory) -> &Penetration {
        let dir = &self.hit.dir;
        let round = [0, 1].map(|o: usize| self.objects[o % 2].round(dir));
        memory.keep(dir, &self.slopes, self.count, &round);
        &self.hit
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

    /// Does the disc whose axis is along `n` lack the rim above which the origin is, as a part of a
    /// disc does? Asked beside the axis. The answer's slopes are three points of the disc, the
    /// first one there.
    #[cold]
    pub(super) fn is_cut_short<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        n: &Vec3,
        o: usize,
    ) -> Result<bool, Fault> {
        let [rim, side, other] = self.slopes;
        let Some(way) = unit(&(rim * 2.0 - side - other)) else {
            return Ok(false);
        };
        let d = n + way * BESIDE;
        let d = d * (1.0 / d.norm());
        let sample = Sample::new(&d, md.support(&d)?);
        self.put(&sample);
        self.hit.iterations += 1;
        let same = larger(self.same().round, self.tolerance);
        let at = Self::points(&sample);
        Ok(!self.objects[o % 2].is_on_rim(&at[o % 2], same))
    }

    /// The answer at a sample, with witness points, if the active points show them.
    #[inline(never)]
    pub(super) fn conclude(&mut self, at: usize, known: &mut Known) -> bool {
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
        let curved = self.is_curved();
        let finest = if curved { self.finest } else { self.tolerance };
        let near2 = larger(2.0 * depth * finest, self.rounding * self.rounding);
        let meets = |points: &[Vec3; 2]| {
            let foot = points[0] + points[1];
            let height = foot.dot(n);
            let across2 = (foot - n * height).norm_squared();
            height >= depth - self.tolerance && across2 <= near2
        };
        // Where they are near enough the points of the bodies themselves, else those that R leads to.
        let (mut points, mut slopes) = self.witnesses(n, out);
        if !meets(&points) {
            if !curved || end.on_border || fine {
                return false;
            }
            (points, slopes) = self.witnesses(&step.n, out);
            if !meets(&points) {
                return false;
            }
        }
        let (mut point1, mut point2) = (points[0], -points[1]);
        // Of one cut the point here is the witness; but of a disc along its axis, all of which is as
        // far.
        if end.count == 0 {
            let same = self.same().round;
            let own = Self::points(at);
            for o in 0..2 {
                let (object, own) = (&self.objects[o], &own[o]);
                let exact = step.axis != Some(o) && !object.curved.is_there();
                let off = object.point(end.active[o], n, out) - own.p;
                if exact && off.norm_squared() > same * same {
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
        if let Some(o) = step.axis {
            let sum = self.objects[0].core(end.active[0]) + self.objects[1].core(end.active[1]);
            self.slopes = rim_below(&sum, n, self.objects[o % 2].disc().radius);
            self.count = 3;
        }
        self.hit = Penetration {
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
        let step = &self.step;
        let end = &step.end;
        let mut points =
            [0, 1].map(|o: usize| self.objects[o % 2].point(end.active[o % 2], m, out));
        let mut slopes = [points[0] + points[1]; 3];
        if let Some(o) = step.axis {
            // All of the disc is as far: its point below the origin.
            let disc = self.objects[o % 2].disc();
            let core = self.objects[o % 2].core(end.active[o % 2]);
            points[o % 2] = core;
            let sum = points[0] + points[1];
            points[o % 2] -= disc.across(&sum);
        }
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
        let crossed = end.count == 2 && end.kinks[0].object != end.kinks[1].object;
        let [s, t] = end.weights;
        if !crossed || s + t <= 1.0 {
            put(&a, &b);
        }
        for i in 0..end.count.min(2) {
            if end.kinks[i].object == 0 {
                put(&own(i), &b);
            } else {
                put(&a, &own(i));
            }
        }
        if crossed && s + t > 1.0 {
            let first = usize::from(end.kinks[0].object != 0);
            put(&own(first), &own(1 - first));
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

/// Three points of a disc of this radius whose axis is along unit `n`, around a vertex that is aside
/// of the origin by less: their triangle has the origin inside. Across `n`.
#[cold]
fn rim_below(vertex: &Vec3, n: &Vec3, radius: Real) -> [Vec3; 3] {
    let middle = vertex - n * n.dot(vertex);
    // One opposite to the vertex, the others a third of a turn away.
    let to = unit(&-middle).unwrap_or_else(|| perpendicular(n)) * radius;
    let (half, side) = (to * -0.5, n.cross(&to) * (3.0 as Real).sqrt() * 0.5);
    [middle + to, middle + half + side, middle + half - side]
}
