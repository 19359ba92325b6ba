// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The search as long as all cuts are exact: of polytopes, and of polytopes with a ball
//! around them (spheres, capsules, rounded boxes), whose balls are taken off.
//!
//! With ρ = ρ₁ + ρ₂ the radii of the two objects' balls, u = v − ρ n is a vertex of what is
//! left, and its cut is exact: the support value along d is at least u·d + ρ|d|. No
//! curvature is needed, and the only doubt is whether a ball is round where it was not seen.
//!
//! *Found*: the model's least value within the trust region ([`Cuts::minimise`]) is where to
//! ask next. If it is stationary and the support value there is as low as foretold, it is a
//! local minimum, and the weights of the active cuts give the witness points: with
//! W = Σ wᵢ uᵢ on the line of the direction n, obj1's point is the mean of its own.
//!
//! *Balls*: each object by itself, from two of its own points: p′ − p = r (n′ − n), exactly
//! parallel. *A ball is part of a piece only*: the hull of a ball and a tip is a ball on one
//! side. So an answer stands on vertices that were seen along two directions, which no other
//! point than one of the ball can bring about; or so near to the minimum that the cut is
//! right without the ball. Where one was not, the model's minimum is asked by a hair on that
//! vertex's side.
//!
//! *The end*: a pair of samples that is smooth and no ball's, points that contradict each
//! other, a trust region that has shrunk to nothing. Then the search with curvature goes on
//! with the samples of this one.

use super::curvature::{ALIKE, CLOSE, smooth};
use super::cuts::{Cuts, Step};
use super::lanes::{CUTS, Lanes, Vectors};
use super::memory::{Memory, Queue, Smooth};
use super::model::basis;
use super::samples::Sample;
use super::trust_region::{FIRST, TrustRegion};
use crate::contact::{Penetration, Settings};
use crate::contact_patch;
use crate::math::{self, EPSILON, Real, Vec3, larger, perpendicular, unit};
use crate::support::{Fault, Known, MinkowskiDifference, SupportMap};

/// Squared sine of the angle within which two vectors are parallel: what rounding leaves of
/// differences over a first step of a few hundredths of a radian. Measured: ×10, ÷10 nothing.
const PARALLEL: Real = if EPSILON > 1e-10 { 1e-6 } else { 1e-11 };
/// Support points after which balls are looked for in smooth pairs alone. Measured: 0 +0.2 %, +4 %
/// (shallow spheres in capsules); twice as many nothing.
const LOOK: usize = 3;
/// Share of the tolerance by which two vertices that are the same may differ: a radius is in error
/// by more than rounding. Free: measured, 0, ÷2, ×2 nothing.
const SAME: Real = 0.06;
/// Support points that show a vertex again and nothing else, after which the search has lost
/// its way, or the balls do not fit. Measured: ÷2 no change, ×2 nothing.
const DOUBTS: u32 = 6;

/// How a search of exact cuts ends.
pub enum Outcome {
    /// At a local minimum.
    Found(Minimum),
    /// All of D is on the far side of this unit direction's support plane.
    Apart(Vec3),
    /// Not here: what was asked, to go on from.
    Open(Asked),
}

/// A local minimum.
pub struct Minimum {
    /// The answer, its overlap not proven.
    pub hit: Penetration,
    /// The gradients of the active cuts, metres.
    pub slopes: [Vec3; 3],
    /// How many cuts are active.
    pub count: usize,
    /// The radii of the balls, metres; 0 for none.
    pub radius: [Real; 2],
}

impl Minimum {
    /// Leaves behind what finds the same cuts again.
    #[inline]
    pub fn remember(&self, memory: &mut Memory) {
        let smooth = if self.radius == [0.0; 2] {
            Smooth::Unknown
        } else {
            Smooth::Round(self.radius)
        };
        memory.keep(&self.hit.dir, &self.slopes, self.count, smooth);
    }
}

/// The samples kept, and the last one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    samples: [Sample; CUTS + 1],
    len: usize,
    /// The trust radius, radians.
    pub trust: Real,
    /// How many samples were asked and are not kept.
    pub dropped: u64,
}

impl Asked {
    /// The samples, the last one last.
    pub fn samples(&self) -> &[Sample] {
        self.samples.get(..self.len).unwrap_or(&[])
    }
}

/// What comes after a support point.
enum Next {
    Ask(Vec3),
    Found(Minimum),
    Open,
}

/// A search of exact cuts.
pub struct Flat {
    n: Vectors,
    u: Vectors,
    /// The support values less ρ, metres.
    h: Lanes,
    samples: [Sample; CUTS],
    /// The samples whose vertex of that object was seen along two directions, as bits.
    seen: [u32; 2],
    newest: usize,
    /// The best sample, …
    best: Sample,
    /// … and its support value less ρ, metres.
    best_h: Real,
    /// The place of the next sample.
    spare: usize,
    /// The radii of the balls taken off, metres; 0 for none.
    radius: [Real; 2],
    cuts: Cuts,
    /// The chart of the best direction.
    e1: Vec3,
    e2: Vec3,
    trust: TrustRegion,
    /// The step to the direction asked last, if the minimum is there should the depth foretold
    /// come true.
    step: Option<Step>,
    /// Squared extent of D from its centre, m².
    extent2: Real,
    tolerance: Real,
    asked: usize,
    doubts: u32,
    levelled: bool,
    /// Was a vertex seen twice: a polytope, it seems?
    flat: bool,
}

impl Flat {
    /// Nothing asked yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            n: Vectors::default(),
            u: Vectors::default(),
            h: Lanes::default(),
            samples: [Sample::default(); CUTS],
            seen: [0; 2],
            newest: 0,
            best: Sample::default(),
            best_h: 0.0,
            spare: 0,
            radius: [0.0; 2],
            cuts: Cuts::default(),
            e1: Vec3::zeros(),
            e2: Vec3::zeros(),
            trust: TrustRegion::new(FIRST),
            step: None,
            extent2: 0.0,
            tolerance: 0.0,
            asked: 0,
            doubts: 0,
            levelled: false,
            flat: false,
        }
    }

    /// The directions to ask first: what the memory leads to, else `start`.
    #[inline]
    pub fn recall(&mut self, memory: &Memory, start: &Vec3) -> (Vec3, Queue) {
        let Some(dir) = unit(&memory.dir) else {
            return (*start, Queue::EMPTY);
        };
        if let Smooth::Round(radius) = memory.smooth() {
            self.radius = radius;
        }
        let (mut queue, angle) = memory.recall(&dir);
        match queue.pop() {
            Some(n) => {
                self.trust.recall(angle);
                (n, queue)
            }
            None => (dir, queue),
        }
    }

    /// Searches from `n`, after the queued directions.
    ///
    /// `centre`: any inner point of D, its distance is the size of what was not seen.
    /// `known` gains the points of a minimum: the active ones, the one there, the others.
    ///
    /// # Errors
    /// [`Fault::NonFinite`] from a support mapping.
    pub fn run<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        centre: &Vec3,
        mut n: Vec3,
        queue: &mut Queue,
        settings: &Settings,
        known: &mut Known,
    ) -> Result<Outcome, Fault> {
        loop {
            let new = Sample::new(&n, md.support(&n)?);
            self.asked += 1;
            if new.h < 0.0 {
                // D holds what was seen: where that lies beyond, a callback errs.
                let beyond = self.u.dot(&n) + self.n.dot(&n) * self.rho();
                return Ok(if self.cuts.len == 0 || !(beyond.most() > 0.0) {
                    Outcome::Apart(n)
                } else {
                    self.open(None)
                });
            }
            if !self.take(&new, centre, settings.tolerance) {
                return Ok(self.open(Some(&new)));
            }
            if let Some(minimum) = self.came_true(&new, known) {
                return Ok(Outcome::Found(minimum));
            }
            if self.asked as u64 >= settings.max_iterations {
                return Ok(self.open(None));
            }
            if let Some(queued) = queue.pop() {
                n = queued;
                continue;
            }
            match self.next(known) {
                Next::Ask(next) => n = next,
                Next::Found(minimum) => return Ok(Outcome::Found(minimum)),
                Next::Open => return Ok(self.open(None)),
            }
        }
    }

    /// The end without a minimum; `last` was not taken.
    #[cold]
    fn open(&self, last: Option<&Sample>) -> Outcome {
        let mut asked = Asked {
            trust: self.trust.radius,
            ..Asked::default()
        };
        let kept = self.samples.iter().take(self.cuts.len);
        for (place, sample) in asked.samples.iter_mut().zip(kept.chain(last)) {
            *place = *sample;
            asked.len += 1;
        }
        asked.dropped = self.asked.saturating_sub(asked.len) as u64;
        Outcome::Open(asked)
    }

    #[inline(always)]
    fn rho(&self) -> Real {
        self.radius[0] + self.radius[1]
    }

    /// How far apart two vertices may be that are the same, metres: where a ball was taken
    /// off its radius is uncertain.
    #[inline(always)]
    fn same(&self) -> Real {
        if self.rho() > 0.0 {
            larger(self.cuts.rounding, self.tolerance * SAME)
        } else {
            self.cuts.rounding
        }
    }

    /// Takes a support point. Not, if it is of no exact cut.
    #[inline(always)]
    fn take(&mut self, new: &Sample, centre: &Vec3, tolerance: Real) -> bool {
        let p = &new.p;
        let rounding = larger(new.rounding(), self.cuts.rounding);
        self.cuts.rounding = rounding;
        self.extent2 = larger((p.v - centre).norm_squared(), self.extent2);
        if self.cuts.len == 0 {
            self.tolerance = math::tolerance(tolerance, self.extent2.sqrt(), 0.0);
            self.tolerance = larger(self.tolerance, rounding);
            for radius in &mut self.radius {
                // A remembered ball larger than the object was another's.
                if *radius * *radius > 1.1 * self.extent2 {
                    *radius = 0.0;
                }
            }
            let rho = self.rho();
            let (u, k) = (p.v - new.n * rho, new.h - rho);
            // Of all lanes: those beyond the samples repeat the first one.
            for i in (0..CUTS).rev() {
                self.put(i, new, &u, k, 0);
            }
            (self.cuts.len, self.spare) = (1, 1);
            (self.best, self.best_h) = (*new, k);
            return true;
        }
        self.tolerance = larger(self.tolerance, rounding);
        self.trust.compare(&new.n, new.h, self.best.h);
        let lopsided = (self.radius[0] > 0.0) != (self.radius[1] > 0.0);
        if self.asked <= LOOK || lopsided {
            let best = self.best;
            self.look(&best, new);
        }
        self.compare(new)
    }

    /// Compares a new sample with those that are kept, and keeps it.
    #[inline(always)]
    fn compare(&mut self, new: &Sample) -> bool {
        let (n, rho) = (&new.n, self.rho());
        let (u, k) = (new.p.v - n * rho, new.h - rho);
        let ahead = Lanes::all(k) - self.u.dot(n);
        let behind = self.h - self.n.dot(&u);
        let rounding = self.cuts.rounding;
        // A cut above a support value.
        if ahead.lesser(&behind).least() < -self.same() {
            return false;
        }
        let seen = if rho > 0.0 { self.see(new) } else { 0 };
        let unlike = (ahead - behind).map(Real::abs) - (ahead + behind) * ALIKE;
        let mut twin = None;
        if unlike.least() > rounding {
            return self.keep(new, &u, k, seen, twin);
        }
        let mut nearest = Real::INFINITY;
        let same2 = self.same() * self.same();
        for i in 0..self.cuts.len.min(CUTS) {
            if unlike[i] > rounding {
                continue;
            }
            let dn2 = (n - self.n.get(i)).norm_squared();
            let ds2 = (u - self.u.get(i)).norm_squared();
            if ds2 <= same2 {
                self.flat |= dn2 > CLOSE;
                if dn2 < nearest {
                    (twin, nearest) = (Some(i), dn2);
                }
            } else if self.smooth(ahead[i], behind[i], ds2, dn2) {
                // Of one ball more, or of none.
                let old = self.samples[i];
                return self.look(&old, new) && self.compare(new);
            }
        }
        self.keep(new, &u, k, seen, twin)
    }

    /// Does a pair with these excesses, this far apart, look smooth?
    #[inline(always)]
    fn smooth(&self, ahead: Real, behind: Real, ds2: Real, dn2: Real) -> bool {
        dn2 > CLOSE
            && ahead + behind > self.cuts.rounding
            && smooth(self.flat, ahead, behind, ds2, self.extent2 * dn2)
    }

    /// Keeps the sample: in the place of its `twin`, of the same vertex, if it is nearer to
    /// the best direction. False, where too many have said nothing new.
    #[inline(always)]
    fn keep(&mut self, new: &Sample, u: &Vec3, k: Real, seen: u32, twin: Option<usize>) -> bool {
        let better = k < self.best_h;
        let place = match twin {
            Some(twin) => {
                let best = self.cuts.best;
                let b = &self.best.n;
                let nearer = twin != best && self.n.get(twin).dot(b) < new.n.dot(b);
                if !(better || nearer) {
                    self.newest = best;
                    self.see_again(twin, seen);
                    self.doubts += 1;
                    return self.doubts <= DOUBTS;
                }
                twin
            }
            None => self.spare,
        };
        self.put(place, new, u, k, seen);
        self.newest = place;
        if place == self.cuts.len {
            self.cuts.len += 1;
            self.spare += 1;
        } else if twin.is_some() {
            for i in self.cuts.len..CUTS {
                self.put(i, new, u, k, seen);
            }
        }
        if better {
            self.cuts.best = place;
            (self.best, self.best_h) = (*new, k);
        }
        true
    }

    #[inline(always)]
    fn put(&mut self, i: usize, new: &Sample, u: &Vec3, k: Real, seen: u32) {
        self.n.set(i, &new.n);
        self.u.set(i, u);
        self.h[i] = k;
        self.samples[i % CUTS] = *new;
        // Nothing is to be seen of what has no ball.
        if self.rho() > 0.0 {
            for (o, bits) in self.seen.iter_mut().enumerate() {
                *bits = *bits & !(1 << i) | (seen >> o & 1) << i;
            }
        }
    }

    /// Notes that a vertex kept in another sample was seen.
    #[inline(always)]
    fn see_again(&mut self, i: usize, seen: u32) {
        for (o, bits) in self.seen.iter_mut().enumerate() {
            *bits |= (seen >> o & 1) << i;
        }
    }

    /// Looks for balls: each object by itself, its points of two samples, and takes them off
    /// all samples. Returns whether there was one.
    #[inline]
    fn look(&mut self, old: &Sample, new: &Sample) -> bool {
        let dn = new.n - old.n;
        let turned = dn.norm_squared();
        if !(turned > CLOSE) {
            return false;
        }
        let moves = [new.p.v1 - old.p.v1, old.p.v2 - new.p.v2];
        let least = self.cuts.rounding * self.cuts.rounding;
        let mut found = false;
        for (radius, d) in self.radius.iter_mut().zip(moves) {
            let (along, moved) = (d.dot(&dn), d.norm_squared());
            let parallel = along > 0.0
                && moved > 4.0 * least
                && moved * turned - along * along <= PARALLEL * moved * turned
                // No larger than the object.
                && along * along <= 1.02 * self.extent2 * turned * turned;
            if parallel && *radius == 0.0 {
                *radius = along / turned;
                self.u.add(&self.n, -*radius);
                self.h = self.h - Lanes::all(*radius);
                self.best_h -= *radius;
                found = true;
            }
        }
        self.flat &= !found;
        found
    }

    /// Notes which vertices a new sample shows again from another direction. Returns whose
    /// were: a bit for each object.
    #[inline(always)]
    fn see(&mut self, new: &Sample) -> u32 {
        let same = self.same();
        let mut seen = 0;
        for i in 0..self.cuts.len.min(CUTS) {
            let old = &self.samples[i];
            let dn = new.n - old.n;
            let moves = [new.p.v1 - old.p.v1, old.p.v2 - new.p.v2];
            for (o, d) in moves.into_iter().enumerate() {
                let r = self.radius[o];
                // The ball must have moved by more than a vertex without it would need to
                // pass for one with it.
                let moved2 = r * r * dn.norm_squared();
                let least = larger(CLOSE * r * r, 16.0 * same * same);
                if moved2 > least && (d - dn * r).norm_squared() <= same * same {
                    self.seen[o] |= 1 << i;
                    seen |= 1 << o;
                }
            }
        }
        seen
    }

    /// The samples of which a ball's vertex was not seen twice, as bits; but for those so near
    /// to unit `n` that their cuts are right without the ball, within a quarter of the
    /// tolerance.
    #[inline(always)]
    fn unseen(&self, n: &Vec3) -> u32 {
        let mut unseen = 0;
        for (radius, seen) in self.radius.iter().zip(self.seen) {
            if *radius > 0.0 {
                unseen |= !seen;
            }
        }
        if unseen == 0 {
            return 0;
        }
        let lift = (Lanes::all(1.0) - self.n.dot(n)) * self.rho();
        unseen & lift.mask(|lift| lift > 0.25 * self.tolerance)
    }

    /// The answer, if the last step was to the minimum, came true there, and no cut shows a
    /// lower place.
    #[inline(always)]
    fn came_true(&mut self, new: &Sample, known: &mut Known) -> Option<Minimum> {
        let step = self.step.take()?;
        let k = new.h - self.rho();
        let came = self.trust.came_true(new.h, self.tolerance);
        if !came || self.unseen(&new.n) & step.bits() != 0 || !self.is_lowest(&new.n, k, &step) {
            return None;
        }
        self.conclude(new, k, &step, known)
    }

    /// Is it nowhere lower within the trust radius, as far as the active cuts tell?
    ///
    /// Around the minimum the model is k + max g·x − ½ k x² with the active gradients g. Of
    /// three that surround the origin max g·x is least across the nearest side of their
    /// triangle, where it is the side's distance times |x|: no lower, if that distance is at
    /// least ½ k Δ. (Vertices of equal height are as far apart as their gradients.)
    #[inline(always)]
    fn is_lowest(&self, n: &Vec3, k: Real, step: &Step) -> bool {
        if !(k > 0.0) {
            return true;
        }
        let [u, v, w] = step.set.map(|i| self.u.get(i));
        let least = 0.5 * k * self.trust.radius;
        let far = |a: &Vec3, b: &Vec3| {
            let area = n.dot(&a.cross(b));
            area * area >= least * least * (a - b).norm_squared()
        };
        step.count == 3 && far(&v, &w) && far(&w, &u) && far(&u, &v)
    }

    /// Where to ask next, or the answer.
    #[inline(always)]
    fn next(&mut self, known: &mut Known) -> Next {
        let h = self.best_h;
        let rho = self.rho();
        // A touch cannot be lower, and is for others to tell.
        if !(h + rho > self.cuts.rounding) || self.trust.is_stuck() {
            return Next::Open;
        }
        if self.cuts.len == 1 && !(rho > 0.0) {
            let size = self.extent2.sqrt();
            return Next::Ask(self.trust.first_step(&self.best.n, &self.best.p.v, size));
        }
        self.chart();
        let Some((step, gain)) = self.predict() else {
            return Next::Open;
        };
        self.trust
            .foretell(h - gain + rho, !step.inside, &self.best.n);
        self.step = step.inside.then_some(step);
        let d = self.best.n + self.e1 * step.x + self.e2 * step.y;
        let mut n = d * (1.0 / d.norm());
        let close = gain.abs() <= self.tolerance;
        if step.inside || close && rho > 0.0 && self.trust.radius >= FIRST {
            let doubtful = self.doubtful(&step, &n);
            if doubtful != 0 {
                self.doubts += 1;
                if self.doubts > DOUBTS {
                    return Next::Open;
                }
                self.trust.no_forecast();
                self.step = None;
                n += self.towards(&step, doubtful);
                n *= 1.0 / n.norm();
            } else if close {
                let minimum = self.conclude(&self.best, h, &step, known);
                return minimum.map_or(Next::Open, Next::Found);
            }
        }
        if self.cuts.len == CUTS {
            self.evict(&step);
        }
        Next::Ask(n)
    }

    /// The step to where the model is least, and how much lower it is there, metres. `None`: it
    /// is no guide.
    #[inline(always)]
    fn predict(&mut self) -> Option<(Step, Real)> {
        let mut step = self.cuts.minimise(self.trust.radius);
        let mut gain = self.gain(&step);
        let level = gain.abs() <= self.tolerance && !step.inside;
        if level && self.rho() > 0.0 && self.trust.radius < FIRST && !self.levelled {
            // Level so far: is it as far as the first radius?
            self.levelled = true;
            self.trust.radius = FIRST;
            step = self.cuts.minimise(self.trust.radius);
            gain = self.gain(&step);
        }
        let lost = gain < -self.tolerance;
        let close = gain <= self.tolerance && step.inside;
        if lost || close && !self.is_lowest(&self.best.n, self.best_h, &step) {
            // The walk ended above b, or before the end: is it lower anywhere?
            step = self.cuts.lowest(self.trust.radius);
            gain = self.gain(&step);
        }
        // Also NaN.
        (gain >= -self.tolerance && gain < Real::INFINITY).then_some((step, gain))
    }

    /// How much lower the model is at a step, metres.
    #[inline(always)]
    fn gain(&self, step: &Step) -> Real {
        self.best_h - step.level / (1.0 + step.length2()).sqrt()
    }

    /// The chart of the best direction, and the cuts in it.
    #[inline(always)]
    fn chart(&mut self) {
        let b = self.best.n;
        (self.e1, self.e2) = basis(&b);
        self.cuts.height = self.best_h;
        self.cuts.a = self.u.dot(&b);
        self.cuts.x = self.u.dot(&self.e1);
        self.cuts.y = self.u.dot(&self.e2);
        // Where a direction ties the vertices of a face, one below the origin says nothing
        // that the others do not.
        let (cuts, best) = (&self.cuts, self.cuts.best);
        let flat = larger(cuts.x[best].abs(), cuts.y[best].abs()) <= cuts.rounding;
        let ties = |i: &usize| *i != best && cuts.a[*i] >= cuts.height - cuts.rounding;
        if let (true, Some(other)) = (flat, (0..cuts.len.min(CUTS)).find(ties)) {
            self.cuts.best = other;
        }
    }

    /// The active cuts whose balls must be seen, as bits. Of three cuts the best one's own
    /// point is as good as any.
    #[inline(always)]
    fn doubtful(&self, step: &Step, n: &Vec3) -> u32 {
        if self.asked == 1 {
            // A remembered ball is no more than a guess.
            return step.bits();
        }
        let unseen = self.unseen(n);
        if unseen == 0 {
            return 0;
        }
        let exempt = if step.count == 3 {
            1 << self.cuts.best
        } else {
            0
        };
        unseen & step.bits() & !exempt
    }

    /// From the model's minimum to where these vertices show, by so little that the depth
    /// there is the minimum's within the tolerance.
    #[cold]
    fn towards(&self, step: &Step, doubtful: u32) -> Vec3 {
        let b = self.best.n;
        let mut side = Vec3::zeros();
        for &i in step.active() {
            let sign = if doubtful & (1 << i) != 0 { 1.0 } else { -1.0 };
            side += self.u.get(i) * sign;
        }
        if doubtful.count_ones() as usize == step.count {
            side = self.n.get(step.set[0]) - b;
        }
        let side = side - b * b.dot(&side);
        let side = unit(&side).unwrap_or_else(|| perpendicular(&b));
        let radius = larger(self.radius[0], self.radius[1]);
        let tilt = if step.count == 1 {
            larger(10.0 * CLOSE.sqrt(), 8.0 * self.same() / radius)
        } else {
            0.25 * self.tolerance / self.extent2.sqrt()
        };
        side * tilt
    }

    /// The place of the next sample: of the lowest cut that is not needed.
    #[inline(always)]
    fn evict(&mut self, step: &Step) {
        let kept = step.bits() | 1 << self.newest | 1 << self.cuts.best;
        self.spare = self.cuts.least(kept, step);
    }

    /// The answer at a sample, with witness points, if the objects' own points show them:
    /// the points of the active cuts, or, where a direction ties several vertices, of any
    /// three.
    #[inline(always)]
    fn conclude(&self, at: &Sample, k: Real, step: &Step, known: &mut Known) -> Option<Minimum> {
        let n = &at.n;
        let depth = k + self.rho();
        let near2 = 2.0 * depth * self.tolerance;
        let rounding = self.cuts.rounding;
        let near2 = larger(near2, rounding * rounding);
        let least = k - self.tolerance;
        let own = |set: &[usize; 3], weights: &[Real; 3]| {
            let mut foot = Vec3::zeros();
            for (&i, &w) in set.iter().zip(weights) {
                foot += self.u.get(i) * w;
            }
            let height = foot.dot(n);
            let across2 = (foot - n * height).norm_squared();
            (height >= least && across2 <= near2).then_some(foot)
        };
        let serves = |(set, weights, count)| Some((own(&set, &weights)?, set, weights, count));
        let active = serves((step.set, self.weights(step, n), step.count));
        let of_three = || self.enclosing(n).find_map(|(set, w)| serves((set, w, 3)));
        let (foot, set, weights, count) = active.or_else(of_three)?;
        let mut point1 = n * self.radius[0];
        for (&i, &w) in set.iter().zip(&weights) {
            point1 += (self.samples[i % CUTS].p.v1 - self.n.get(i) * self.radius[0]) * w;
        }
        let mut point2 = point1 - foot - n * self.rho();
        // Onto the support planes of both objects.
        point1 += n * n.dot(&(at.p.v1 - point1));
        point2 += n * n.dot(&(at.p.v2 - point2));
        for &i in step.active() {
            known.push(&self.samples[i % CUTS].p);
        }
        // The one here, which may have been seen as another's twin.
        known.put(&at.p, &[]);
        for i in (0..self.cuts.len).filter(|&i| step.bits() & (1 << i) == 0) {
            known.add(&self.samples[i % CUTS].p);
        }
        let slope = |i: usize| {
            let u = self.u.get(i);
            u - n * n.dot(&u)
        };
        Some(Minimum {
            hit: Penetration {
                depth,
                depth_lower: 0.0,
                dir: *n,
                normal: *n,
                point1,
                point2,
                width: contact_patch::width(known.points(), n, self.tolerance, self.extent2.sqrt()),
                iterations: self.asked as u64,
            },
            slopes: set.map(slope),
            count,
            radius: self.radius,
        })
    }

    /// Weights of the active cuts whose vertices have a mean on the line of `n`, or come
    /// nearest to it.
    #[inline(always)]
    fn weights(&self, step: &Step, n: &Vec3) -> [Real; 3] {
        let [u, v, w] = step.set.map(|i| self.u.get(i));
        match step.count {
            3 => {
                let shares = [
                    n.dot(&v.cross(&w)),
                    n.dot(&w.cross(&u)),
                    n.dot(&u.cross(&v)),
                ];
                let sum = shares[0] + shares[1] + shares[2];
                shares.map(|w| w / sum)
            }
            2 => {
                let d = v - u;
                let d = d - n * n.dot(&d);
                // NaN becomes 0.
                let t = -u.dot(&d) / d.norm_squared();
                let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
                [1.0 - t, t, 0.0]
            }
            _ => [1.0, 0.0, 0.0],
        }
    }

    /// Each three samples whose triangle the line of `n` meets, and the weights of where it
    /// does.
    #[cold]
    fn enclosing(&self, n: &Vec3) -> impl Iterator<Item = ([usize; 3], [Real; 3])> + use<'_> {
        let n = *n;
        let len = self.cuts.len.min(CUTS);
        let triples = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
        triples
            .into_iter()
            .filter(move |t| t[2] < len)
            .filter_map(move |set| {
                let step = Step {
                    x: 0.0,
                    y: 0.0,
                    level: 0.0,
                    value: 0.0,
                    set,
                    count: 3,
                    inside: true,
                };
                let w = self.weights(&step, &n);
                // False for NaN: three points on a line.
                w.iter().all(|&w| w >= 0.0).then_some((set, w))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, capsule, corners, hull, placed};

    const TOLERANCE: Real = if EPSILON > 1e-10 { 1e-5 } else { 1e-8 };

    fn run(
        a: impl Fn(&Vec3) -> Vec3,
        b: impl Fn(&Vec3) -> Vec3,
        centre: &Vec3,
        start: &Vec3,
    ) -> (Outcome, u64) {
        let md = MinkowskiDifference::new(a, b);
        let settings = Settings {
            tolerance: TOLERANCE,
            max_iterations: 60,
        };
        let mut known = Known::default();
        let n = start.normalize();
        let mut queue = Queue::EMPTY;
        let outcome = Flat::new().run(&md, centre, n, &mut queue, &settings, &mut known);
        (outcome.unwrap(), md.supports())
    }

    fn found(outcome: Outcome) -> Penetration {
        match outcome {
            Outcome::Found(minimum) => minimum.hit,
            Outcome::Apart(n) => panic!("apart along {n}"),
            Outcome::Open(asked) => panic!("open: {asked:?}"),
        }
    }

    fn ball(c: Vec3, r: Real) -> impl Fn(&Vec3) -> Vec3 {
        move |d| c + d * r
    }

    #[test]
    fn boxes_are_exact() {
        let mut random = Random::new(1);
        let half = Vec3::new(0.5, 0.6, 0.7);
        // Corners that look like points of one smooth surface.
        let mut open = 0;
        for _ in 0..200 {
            let turn = random.rotation();
            let place = |at: Vec3| placed(&corners(half), &turn, at);
            let a = place(Vec3::zeros());
            // Shallow along the first axis of the boxes.
            let axis = turn * Vec3::x();
            let b = place(axis * 0.98);
            let start = axis + random.vector(0.05);
            let (outcome, supports) = run(hull(&a), hull(&b), &(axis * -0.98), &start);
            if let Outcome::Open(_) = outcome {
                open += 1;
                continue;
            }
            let hit = found(outcome);
            assert!((hit.depth - 0.02).abs() < 64.0 * EPSILON, "{}", hit.depth);
            assert!((hit.dir - axis).norm() < 64.0 * EPSILON);
            assert!((hit.point1 - hit.point2 - hit.dir * hit.depth).norm() < 64.0 * EPSILON);
            assert!(supports <= 12, "{supports}");
        }
        assert!(open <= 4, "{open}");
    }

    /// The core of a ball is a point: the second support point shows it, the third is the
    /// minimum.
    #[test]
    fn balls_are_taken_off() {
        let mut random = Random::new(2);
        for _ in 0..200 {
            let c = random.direction() * random.within(0.4, 1.2);
            let (outcome, supports) = run(
                ball(Vec3::zeros(), 1.0),
                ball(c, 0.5),
                &-c,
                &(c.normalize() + random.vector(0.2)),
            );
            let hit = found(outcome);
            assert!((hit.depth - (1.5 - c.norm())).abs() < TOLERANCE);
            assert!((hit.dir.dot(&c) - c.norm()).abs() < TOLERANCE);
            assert!((hit.point1 - hit.dir).norm() < TOLERANCE.sqrt());
            assert!(supports <= 4, "{supports}");
        }
    }

    /// Two crossed capsules: the nearest points of their segments.
    #[test]
    fn crossed_capsules() {
        let (x, y) = (Vec3::x(), Vec3::y());
        let up = Vec3::z() * 0.3;
        let (outcome, supports) = run(
            capsule(-x, x, 0.25),
            capsule(up - y, up + y, 0.15),
            &-up,
            &Vec3::new(0.06, -0.05, 1.0),
        );
        let hit = found(outcome);
        assert!((hit.depth - 0.1).abs() < TOLERANCE, "{}", hit.depth);
        assert!((hit.dir - Vec3::z()).norm() < TOLERANCE.sqrt());
        assert!(supports <= 10, "{supports}");
    }

    /// The hull of a unit ball and the point (3, 0, 0), and a point at (2.6, 0, 0): round
    /// where the search starts, and a cone at its minimum, 0.4 / 3 deep.
    #[test]
    fn a_tip_is_no_ball() {
        let mut random = Random::new(3);
        let tip = |d: &Vec3| {
            let top = Vec3::x() * 3.0;
            if top.dot(d) > 1.0 { top } else { *d }
        };
        for _ in 0..200 {
            let start = random.direction();
            match run(tip, ball(Vec3::x() * 2.6, 0.0), &(Vec3::x() * -2.6), &start).0 {
                Outcome::Found(minimum) => {
                    let depth = minimum.hit.depth;
                    assert!((depth - 0.4 / 3.0).abs() < 1e-3, "{depth} from {start}");
                }
                Outcome::Open(_) => {}
                Outcome::Apart(n) => panic!("apart along {n}"),
            }
        }
    }

    /// What is smooth and no ball is left to the search with curvature, with all that is
    /// known of it.
    #[test]
    fn an_ellipsoid_is_left_open() {
        let r = Vec3::new(0.5, 0.35, 0.25);
        let ellipsoid = |d: &Vec3| {
            let w = r.component_mul(&r.component_mul(d));
            w / w.dot(d).sqrt()
        };
        let (outcome, supports) = run(
            ellipsoid,
            ball(Vec3::new(0.3, 0.2, 0.1), 0.2),
            &Vec3::new(-0.3, -0.2, -0.1),
            &Vec3::new(1.0, 0.5, 0.3),
        );
        match outcome {
            Outcome::Open(asked) => assert_eq!(asked.samples().len() as u64, supports),
            _ => panic!("exact cuts of an ellipsoid"),
        }
    }

    #[test]
    fn apart_is_told() {
        let (outcome, supports) = run(
            ball(Vec3::zeros(), 1.0),
            ball(Vec3::x() * 3.0, 1.0),
            &(Vec3::x() * -3.0),
            &Vec3::new(1.0, 0.1, 0.0),
        );
        assert!(matches!(outcome, Outcome::Apart(_)) && supports == 1);
    }

    /// A callback that contradicts what it showed before separates nothing.
    #[test]
    fn contradictions_separate_nothing() {
        let calls = core::cell::Cell::new(0);
        let liar = |d: &Vec3| {
            calls.set(calls.get() + 1);
            if calls.get() == 1 {
                Vec3::repeat(5.0)
            } else {
                -d
            }
        };
        let (outcome, _) = run(liar, ball(Vec3::zeros(), 0.1), &Vec3::zeros(), &Vec3::x());
        assert!(matches!(outcome, Outcome::Open(_)));
    }
}
