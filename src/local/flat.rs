// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The search as long as all cuts are exact: of polytopes, and of polytopes with a ball or a disc
//! around them (spheres, capsules, rounded boxes; cylinders, cones), which are taken off.
//!
//! With ρ = ρ₁ + ρ₂ the radii of the two objects' balls, and r, m(n) of each disc (`discs.rs`),
//! u = v − ρ n − Σ r m(n) is a vertex of what is left, and its cut is exact: the support value
//! along d is at least u·d + ρ|d| + Σ r|d⊥|. No curvature is to be learned, and the only doubt is
//! whether a ball or a disc is round where it was not seen.
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
//! *Discs* likewise, but three samples must show one, because two always do. To second order
//! they add (r/|b⊥|) t t' to K, for as much weight as the active cuts have that carry them. Along
//! its axis a disc's support function has its least value and a kink, which the model knows
//! nothing of: where that is within the trust radius its exact value there is compared, too. No
//! vertex is known of a sample along the axis, so it ends the search, one way or the other.
//!
//! *The end*: a pair of samples that is smooth and no ball's or disc's, points that contradict
//! each other, a trust region that has shrunk to nothing. Then the search with curvature goes
//! on with the samples of this one.
//!
//! Polytopes and balls need none of what discs need: `BENT` is false until one is met.

use super::curvature::{BALL, FAR, alike};
use super::cuts::{Cuts, Step};
use super::discs::{Discs, Shown, moves, shows};
use super::lanes::{CUTS, Lanes, Vectors};
use super::memory::{Memory, Queue, Smooth};
use super::model::basis;
use super::samples::{OTHERS, Sample};
use super::trust_region::{FIRST, TrustRegion};
use super::witness::hull;
use crate::contact::{Penetration, Settings};
use crate::contacts::pressure;
use crate::known::round::{ALIKE, TOLD, fits, is_smooth};
use crate::known::support::{Fault, Known, MinkowskiDifference, SupportMap};
use crate::math::{self, Real, Vec3, larger, perpendicular, unit};

/// Share of the tolerance by which two vertices that are the same may differ: a radius is in error
/// by more than rounding. Free: measured, 0, ÷2, ×2 nothing.
const SAME: Real = 0.06;
/// Share of the tolerance by which a depth may differ for what a round part is not: it leaves room
/// for rounding, the radius and the model. Free.
const HAIR: Real = 0.25;
/// How far beside a disc's axis its rim is asked for, radians: enough to tell it from the others'
/// points by five digits.
const BESIDE: Real = 1e-4;
/// Support points that show a vertex again and nothing else, after which the search has lost
/// its way, or the balls do not fit: as many as are kept.
const DOUBTS: u32 = CUTS as u32;

/// How a search of exact cuts ends.
#[derive(Debug)]
pub enum Outcome {
    /// At a local minimum: [`Flat::minimum`].
    Found,
    /// All of D is on the far side of this unit direction's support plane.
    Apart(Vec3),
    /// Not here; [`Flat::asked`] to go on from.
    Open,
}

/// A local minimum.
#[derive(Clone, Copy, Debug, Default)]
pub struct Minimum {
    /// The answer, its overlap not proven.
    pub hit: Penetration,
    /// The gradients of the active cuts, metres.
    pub slopes: [Vec3; 3],
    /// How many cuts are active.
    pub count: usize,
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

/// Cuts, their weights, and how many are active.
type Active = ([usize; 3], [Real; 3], usize);

/// What comes after a support point.
enum Next {
    Ask(Vec3),
    Found,
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
    /// How far apart the directions are that showed it, squared.
    span: Lanes,
    /// The same of the latest sample.
    widest: Real,
    newest: usize,
    /// The best sample, …
    best: Sample,
    /// … and its support value less ρ, metres.
    best_h: Real,
    /// The place of the next sample.
    spare: usize,
    /// The radii of the balls taken off, metres; 0 for none.
    radius: [Real; 2],
    /// The discs taken off.
    discs: Option<Discs>,
    /// Where both objects may have discs, if the next sample shows them: the slope of the pair
    /// that they were seen by, metres; else 0.
    slope: Real,
    /// The last sample that was not kept beside its twin, or no longer; told of discs only.
    dropped: Option<Sample>,
    /// With this sample a new one makes a smooth pair that is no ball's.
    pair: Option<usize>,
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
    /// The last sample, if it was not taken.
    last: Option<Sample>,
    /// What was found.
    minimum: Minimum,
    /// Did the search before find balls where there are any?
    recalled: bool,
    asked: usize,
    doubts: u32,
    levelled: bool,
    /// Was the model's minimum asked because the best direction showed no witness points?
    asked_there: bool,
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
            span: Lanes::default(),
            widest: 0.0,
            newest: 0,
            best: Sample::default(),
            best_h: 0.0,
            spare: 0,
            radius: [0.0; 2],
            discs: None,
            slope: 0.0,
            dropped: None,
            pair: None,
            cuts: Cuts::default(),
            e1: Vec3::zeros(),
            e2: Vec3::zeros(),
            trust: TrustRegion::new(FIRST),
            step: None,
            extent2: 0.0,
            tolerance: 0.0,
            last: None,
            minimum: Minimum::default(),
            recalled: false,
            asked: 0,
            doubts: 0,
            levelled: false,
            asked_there: false,
            flat: false,
        }
    }

    /// The directions to ask first: what the memory leads to, else `start`'s.
    #[inline]
    pub fn recall(&mut self, memory: &Memory, start: impl Fn() -> Vec3) -> (Vec3, Queue) {
        let Some(dir) = unit(&memory.dir) else {
            return (start(), Queue::EMPTY);
        };
        if let Smooth::Round { balls, discs } = memory.smooth() {
            self.radius = balls;
            self.discs = Discs::recall(&discs);
        }
        self.recalled = memory.count > 0 || memory.curved != 0;
        let (mut queue, angle) = memory.recall(&dir);
        match queue.pop() {
            Some(n) => {
                self.trust.recall(angle);
                (n, queue)
            }
            None => (dir, queue),
        }
    }

    /// Is there a disc?
    pub fn bends(&self) -> bool {
        self.discs.is_some()
    }

    /// The answer of a search that found a minimum; what finds its cuts again stays behind.
    #[inline]
    pub fn minimum(&self, memory: &mut Memory) -> &Penetration {
        let minimum = &self.minimum;
        let dir = &minimum.hit.dir;
        // Along a disc's axis its points are those of a polytope.
        let discs = self.discs.as_ref().filter(|discs| !discs.along_axis(dir));
        let smooth = if self.rho() > 0.0 || discs.is_some() {
            Smooth::Round {
                balls: self.radius,
                discs: discs.map_or_else(Default::default, Discs::discs),
            }
        } else {
            match memory.smooth() {
                // Not needed this time.
                curved @ Smooth::Curved(..) => curved,
                _ => Smooth::Unknown,
            }
        };
        memory.keep(dir, &minimum.slopes, minimum.count, smooth);
        &minimum.hit
    }

    /// Searches from `n`, after the queued directions; without `n` from what was taken. `BENT`: with
    /// discs, which the search without goes over to when it meets one.
    ///
    /// `centre`: any inner point of D, its distance is the size of what was not seen.
    /// `known` gains the points of a minimum: the active ones, the one there, the others.
    ///
    /// # Errors
    /// [`Fault::NonFinite`] from a support mapping.
    pub fn run<const BENT: bool, A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        centre: &Vec3,
        mut n: Option<Vec3>,
        queue: &mut Queue,
        settings: &Settings,
        known: &mut Known,
    ) -> Result<Outcome, Fault> {
        loop {
            if let Some(n) = n {
                let new = Sample::new(&n, md.support(&n)?);
                self.asked += 1;
                if new.h < 0.0 {
                    // D holds what was seen: where that lies beyond, a callback errs.
                    let mut kept = self.samples.iter().take(self.cuts.len);
                    return Ok(if !kept.any(|sample| sample.p.v.dot(&n) > 0.0) {
                        Outcome::Apart(n)
                    } else {
                        Outcome::Open
                    });
                }
                // No vertex is left of a disc there.
                let axial = self
                    .discs::<BENT>()
                    .is_some_and(|discs| discs.along_axis(&n));
                if !axial && !self.take::<BENT>(&new, centre, settings.tolerance) {
                    return match self.pair.take() {
                        Some(i) if !BENT && self.take_smooth(i, &new) => {
                            self.run::<true, A, B>(md, centre, None, queue, settings, known)
                        }
                        _ => {
                            self.last = Some(new);
                            Ok(Outcome::Open)
                        }
                    };
                }
                let found = self.came_true::<BENT>(&new, known);
                if found && !(axial && self.is_cut_short(md, &n)?) {
                    return Ok(Outcome::Found);
                }
                if axial {
                    self.last = Some(new);
                    return Ok(Outcome::Open);
                }
            }
            if self.asked as u64 >= settings.max_iterations {
                return Ok(Outcome::Open);
            }
            n = queue.pop();
            if n.is_none() {
                match self.next::<BENT>(known) {
                    Next::Ask(next) => n = Some(next),
                    Next::Found => return Ok(Outcome::Found),
                    Next::Open => return Ok(Outcome::Open),
                }
            }
        }
    }

    /// Does the disc whose axis is along `n` lack the rim above which the origin is, as a part of a
    /// disc does? Asked beside the axis. The answer's slopes are three points of the disc, the
    /// first one there.
    #[cold]
    fn is_cut_short<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        n: &Vec3,
    ) -> Result<bool, Fault> {
        let [rim, side, other] = self.minimum.slopes;
        let (Some(discs), Some(way)) = (self.discs, unit(&(rim * 2.0 - side - other))) else {
            return Ok(false);
        };
        let d = n + way * BESIDE;
        let d = d * (1.0 / d.norm());
        self.asked += 1;
        self.minimum.hit.iterations += 1;
        let same = larger(self.same_round(), self.tolerance);
        Ok(!discs.is_on_rim(n, &Sample::new(&d, md.support(&d)?), same))
    }

    /// What was asked, after a search that found no minimum.
    #[cold]
    pub fn asked(&self) -> Asked {
        let mut asked = Asked {
            trust: self.trust.radius,
            ..Asked::default()
        };
        let kept = self.samples.iter().take(self.cuts.len);
        let doubted = self.discs.as_ref().is_some_and(Discs::is_doubted);
        let room = doubted && self.cuts.len < CUTS;
        let dropped = self.dropped.iter().filter(|_| room);
        for (place, sample) in asked
            .samples
            .iter_mut()
            .zip(kept.chain(dropped).chain(&self.last))
        {
            *place = *sample;
            asked.len += 1;
        }
        asked.dropped = self.asked.saturating_sub(asked.len) as u64;
        asked
    }

    /// The vertex of sample `i` with those of these points of the discs that it carries.
    #[inline(always)]
    fn with_discs<const BENT: bool>(&self, i: usize, points: &[Vec3; 2]) -> Vec3 {
        let u = self.u.get(i);
        match self.discs::<BENT>() {
            Some(discs) => {
                let seen = &self.seen;
                u + discs.carried(i, 0, points, seen) + discs.carried(i, 1, points, seen)
            }
            None => u,
        }
    }

    /// The vertex of a sample, and its support value.
    #[inline(always)]
    fn vertex<const BENT: bool>(&mut self, sample: &Sample) -> (Vec3, Real) {
        let n = &sample.n;
        let u = sample.p.v - n * self.rho();
        let same = self.same_round();
        match &mut self.discs {
            Some(discs) if BENT => {
                let u = u - discs.look_at(sample, same);
                (u, u.dot(n))
            }
            _ => (u, sample.h - self.rho()),
        }
    }

    #[inline(always)]
    fn rho(&self) -> Real {
        self.radius[0] + self.radius[1]
    }

    #[inline(always)]
    fn discs<const BENT: bool>(&self) -> Option<&Discs> {
        if BENT { self.discs.as_ref() } else { None }
    }

    /// Is there a ball or a disc?
    #[inline(always)]
    fn is_round<const BENT: bool>(&self) -> bool {
        self.rho() > 0.0 || self.discs::<BENT>().is_some()
    }

    /// How far apart two vertices may be that are the same, metres: where a ball was taken
    /// off its radius is uncertain.
    #[inline(always)]
    fn same<const BENT: bool>(&self) -> Real {
        if self.is_round::<BENT>() {
            self.same_round()
        } else {
            self.cuts.rounding
        }
    }

    #[inline(always)]
    fn same_round(&self) -> Real {
        larger(self.cuts.rounding, self.tolerance * SAME)
    }

    /// Takes a support point. Not, if it is of no exact cut.
    #[inline(always)]
    fn take<const BENT: bool>(&mut self, new: &Sample, centre: &Vec3, tolerance: Real) -> bool {
        let p = &new.p;
        let rounding = larger(new.rounding(), self.cuts.rounding);
        self.cuts.rounding = rounding;
        self.extent2 = larger((p.v - centre).norm_squared(), self.extent2);
        if self.cuts.len == 0 {
            self.tolerance = math::tolerance(tolerance, self.extent2.sqrt(), 0.0);
            self.tolerance = larger(self.tolerance, rounding);
            for radius in &mut self.radius {
                // A remembered ball larger than the object was another's.
                if !fits(*radius, self.extent2) {
                    *radius = 0.0;
                }
            }
            if let (true, Some(discs)) = (BENT, &mut self.discs) {
                discs.forget_unless_fits(self.extent2);
                if !discs.is_there() {
                    self.discs = None;
                }
            }
            let (u, k) = self.vertex::<BENT>(new);
            self.put::<BENT>(0, new, &u, k, 0);
            (self.cuts.len, self.spare) = (1, 1);
            self.repeat::<BENT>(0);
            (self.best, self.best_h) = (*new, new.h - self.rho());
            return true;
        }
        self.tolerance = larger(self.tolerance, rounding);
        self.trust.compare(&new.n, new.h, self.best.h);
        if BENT && self.slope > 0.0 && !self.settle(new) {
            return false;
        }
        let lopsided = (self.radius[0] > 0.0) != (self.radius[1] > 0.0);
        if !self.recalled && (self.asked < CUTS || lopsided) {
            let best = self.best;
            self.look(&best, new);
        }
        let same = self.same_round();
        if let (true, Some(discs)) = (BENT && self.recalled, &mut self.discs) {
            if discs.turn(&self.best, new, same, self.asked) {
                self.take_off();
            }
        }
        self.compare::<BENT>(new)
    }

    /// Compares a new sample with those that are kept, and keeps it.
    #[inline(always)]
    fn compare<const BENT: bool>(&mut self, new: &Sample) -> bool {
        let n = &new.n;
        let (u, k) = self.vertex::<BENT>(new);
        let mut ahead = Lanes::all(k) - self.u.dot(n);
        let mut behind = self.h - self.n.dot(&u);
        if let Some(discs) = self.discs::<BENT>() {
            if discs.refuted_by(new, &self.samples[..self.cuts.len.min(CUTS)]) {
                return false;
            }
            ahead = ahead - discs.heights(n) + Lanes::all(new.h - self.rho() - k);
            behind = behind + discs.heights_less_latest();
        }
        let rounding = self.cuts.rounding;
        // A cut above a support value.
        if ahead.lesser(&behind).least() < -self.same::<BENT>() {
            return false;
        }
        let seen = if self.is_round::<BENT>() {
            self.see::<BENT>(new)
        } else {
            0
        };
        let unlike = (ahead - behind).map(Real::abs) - (ahead + behind) * ALIKE;
        let mut twin = None;
        if unlike.least() > rounding {
            return self.keep::<BENT>(new, &u, k, seen, twin);
        }
        let mut nearest = Real::INFINITY;
        let same2 = self.same::<BENT>() * self.same::<BENT>();
        for i in 0..self.cuts.len.min(CUTS) {
            if unlike[i] > rounding || self.discs::<BENT>().is_some_and(|discs| !discs.alike(i)) {
                continue;
            }
            let dn2 = (n - self.n.get(i)).norm_squared();
            let ds2 = (u - self.u.get(i)).norm_squared();
            if ds2 <= same2 {
                self.flat |= dn2 > TOLD * TOLD;
                if dn2 < nearest {
                    (twin, nearest) = (Some(i), dn2);
                }
            } else if self.smooth(ahead[i], behind[i], ds2, dn2) {
                // Of one ball or disc more, or of none.
                let old = self.samples[i];
                if self.look(&old, new) {
                    return self.compare::<BENT>(new);
                }
                self.pair = Some(i);
                return BENT && self.take_smooth(i, new);
            }
        }
        self.keep::<BENT>(new, &u, k, seen, twin)
    }

    /// Takes the discs off that a new sample shows with sample `i`, and that sample. Not, if there
    /// are none.
    #[inline(never)]
    fn take_smooth(&mut self, i: usize, new: &Sample) -> bool {
        self.step = None;
        let old = self.samples[i % CUTS];
        match self.look_for_discs(&old, new) {
            Shown::Discs => self.compare::<true>(new),
            Shown::Maybe if self.suspect(&old, new) => {
                let (u, k) = self.vertex::<true>(new);
                self.keep::<true>(new, &u, k, 0, None)
            }
            _ => false,
        }
    }

    /// Does a pair with these excesses, this far apart, look smooth?
    #[inline(always)]
    fn smooth(&self, ahead: Real, behind: Real, ds2: Real, dn2: Real) -> bool {
        dn2 > TOLD * TOLD
            && ahead + behind > self.cuts.rounding
            && is_smooth([ahead, behind], ds2, self.extent2 * dn2, alike(self.flat))
    }

    /// Keeps the sample: in the place of its `twin`, of the same vertex, if it is nearer to
    /// the best direction. False, where too many have said nothing new.
    #[inline(always)]
    fn keep<const BENT: bool>(
        &mut self,
        new: &Sample,
        u: &Vec3,
        k: Real,
        seen: u32,
        twin: Option<usize>,
    ) -> bool {
        let better = new.h < self.best.h;
        let place = match twin {
            Some(twin) => {
                let best = self.cuts.best;
                let b = &self.best.n;
                let nearer = twin != best && self.n.get(twin).dot(b) < new.n.dot(b);
                if BENT {
                    let kept = self.samples[twin % CUTS];
                    self.dropped = Some(if better || nearer { kept } else { *new });
                }
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
        self.put::<BENT>(place, new, u, k, seen);
        self.newest = place;
        if place == self.cuts.len {
            self.cuts.len += 1;
            self.spare += 1;
        } else if twin.is_some() {
            self.repeat::<BENT>(place);
        }
        if better {
            self.cuts.best = place;
            (self.best, self.best_h) = (*new, new.h - self.rho());
        }
        true
    }

    #[inline(always)]
    fn put<const BENT: bool>(&mut self, i: usize, new: &Sample, u: &Vec3, k: Real, seen: u32) {
        self.n.set(i, &new.n);
        self.u.set(i, u);
        self.h[i] = k;
        self.samples[i % CUTS] = *new;
        if let (true, Some(discs)) = (BENT, &mut self.discs) {
            discs.put(i);
        }
        // Nothing is to be seen of what is not round.
        if self.is_round::<BENT>() {
            self.span[i] = self.widest;
            for (o, bits) in self.seen.iter_mut().enumerate() {
                *bits = *bits & !(1 << i) | (seen >> o & 1) << i;
            }
        }
    }

    /// The lanes beyond the samples are those of sample `i`.
    #[inline(always)]
    fn repeat<const BENT: bool>(&mut self, i: usize) {
        let (n, u, k) = (self.n.get(i), self.u.get(i), self.h[i]);
        for beyond in self.cuts.len..CUTS {
            self.n.set(beyond, &n);
            self.u.set(beyond, &u);
            self.h[beyond] = k;
            if let (true, Some(discs)) = (BENT, &mut self.discs) {
                discs.repeat(beyond, i);
            }
        }
    }

    /// Notes that a vertex kept in another sample was seen.
    #[inline(always)]
    fn see_again(&mut self, i: usize, seen: u32) {
        self.span[i] = larger(self.widest, self.span[i]);
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
        if !(turned > TOLD * TOLD) {
            return false;
        }
        let moves = moves(old, new);
        let least = self.cuts.rounding * self.cuts.rounding;
        let mut found = false;
        for (o, d) in moves.into_iter().enumerate() {
            let (along, moved) = (d.dot(&dn), d.norm_squared());
            // Two points, each off by the rounding.
            let parallel = along > 0.0
                && moved > 4.0 * least
                && moved * turned - along * along <= BALL * BALL * moved * turned
                && fits(along / turned, self.extent2);
            // Across the axis the points of a disc move like a ball's.
            let disc = self.discs.as_ref().is_some_and(|discs| discs.has(o));
            if parallel && !disc && self.radius[o] == 0.0 {
                let radius = along / turned;
                self.radius[o] = radius;
                self.u.add(&self.n, -radius);
                self.h = self.h - Lanes::all(radius);
                self.best_h -= radius;
                found = true;
            }
        }
        self.flat &= !found;
        found
    }

    /// Looks for discs, and takes them off all samples.
    #[inline(never)]
    fn look_for_discs(&mut self, old: &Sample, new: &Sample) -> Shown {
        let same = self.same_round();
        let kept = &self.samples[..self.cuts.len.min(CUTS)];
        let discs = self.discs.get_or_insert_default();
        let (extent2, asked) = (self.extent2, self.asked);
        let shown = discs.look([old, new], kept, &self.radius, same, extent2, asked);
        match shown {
            Shown::Discs => self.take_off(),
            Shown::Maybe => (),
            Shown::Nothing if discs.is_there() => (),
            Shown::Nothing => self.discs = None,
        }
        shown
    }

    /// Both objects may have discs: the next sample is to tell, a step down that serves the
    /// search with curvature as well if these are none. Only of the first two samples.
    #[inline(never)]
    fn suspect(&mut self, old: &Sample, new: &Sample) -> bool {
        let [d, e] = moves(old, new);
        let dn = new.n - old.n;
        self.slope = (d + e).dot(&dn) / dn.norm_squared();
        self.cuts.len == 1
    }

    /// Were both suspected discs ones? Then they are taken off.
    #[inline(never)]
    fn settle(&mut self, new: &Sample) -> bool {
        self.slope = 0.0;
        let discs = self.discs.as_mut();
        let settled = discs.is_some_and(|discs| discs.settle(new, self.asked));
        if settled {
            self.take_off();
        }
        settled
    }

    /// Takes the discs off all samples.
    fn take_off(&mut self) {
        self.flat = false;
        for i in 0..self.cuts.len.min(CUTS) {
            let sample = self.samples[i];
            let (u, k) = self.vertex::<true>(&sample);
            self.u.set(i, &u);
            self.h[i] = k;
            if let Some(discs) = &mut self.discs {
                discs.put(i);
            }
        }
        self.repeat::<true>(0);
    }

    /// Notes which vertices a new sample shows again from another direction. Returns whose
    /// were: a bit for each object.
    #[inline(always)]
    fn see<const BENT: bool>(&mut self, new: &Sample) -> u32 {
        let same = self.same::<BENT>();
        let kept = &self.samples[..self.cuts.len.min(CUTS)];
        let mut seen = 0;
        self.widest = 0.0;
        if self.rho() > 0.0 {
            for (i, old) in kept.iter().enumerate() {
                let dn = new.n - old.n;
                for (o, d) in moves(old, new).into_iter().enumerate() {
                    let radius = self.radius[o];
                    if shows(radius, &(dn * radius), &d, same) {
                        self.seen[o] |= 1 << i;
                        seen |= 1 << o;
                        let turned = dn.norm_squared();
                        self.span[i] = larger(turned, self.span[i]);
                        self.widest = larger(turned, self.widest);
                    }
                }
            }
        }
        if let (true, Some(discs)) = (BENT, &mut self.discs) {
            let (whose, widest) =
                discs.see(new, kept, &mut self.seen, &mut self.span, same, self.asked);
            seen |= whose;
            self.widest = larger(widest, self.widest);
        }
        seen
    }

    /// The samples of which a ball's vertex was not seen twice, as bits; but for those so near
    /// to unit `n` that their cuts are right without the ball, within a quarter of the
    /// tolerance. Where n is to be the direction that `answers`, also those that were seen too far
    /// from it.
    #[inline(always)]
    fn unseen<const BENT: bool>(&self, n: &Vec3, answers: bool) -> u32 {
        let mut unseen = 0;
        for (radius, seen) in self.radius.iter().zip(self.seen) {
            if *radius > 0.0 {
                unseen |= !seen;
            }
        }
        if let Some(discs) = self.discs::<BENT>() {
            unseen |= discs.unseen(&self.seen);
        }
        let dn2 = (Lanes::all(1.0) - self.n.dot(n)) * 2.0;
        if answers && self.is_round::<BENT>() {
            unseen |= (dn2 - self.span * (FAR * FAR)).mask(|beyond| beyond > 0.0);
        }
        if unseen == 0 {
            return 0;
        }
        let mut lift = dn2 * (0.5 * self.rho());
        if let Some(discs) = self.discs::<BENT>() {
            lift = lift + discs.lifts(n);
        }
        unseen & lift.mask(|lift| lift > HAIR * self.tolerance)
    }

    /// The answer, if the last step was to the minimum, came true there, and no cut shows a
    /// lower place.
    #[inline(always)]
    fn came_true<const BENT: bool>(&mut self, new: &Sample, known: &mut Known) -> bool {
        let Some(step) = self.step.take() else {
            return false;
        };
        let k = new.h - self.rho();
        let came = self.trust.came_true(new.h, self.tolerance);
        if !came
            || self.unseen::<BENT>(&new.n, true) & step.bits() != 0
            || !self.is_lowest::<BENT>(&new.n, k, &step)
        {
            return false;
        }
        self.conclude::<BENT>(new, k, &step, &new.n, known)
    }

    /// Is it nowhere lower within the trust radius, as far as the active cuts tell?
    ///
    /// Around the minimum the model is k + max g·x − ½ k x² with the active gradients g. Of
    /// three that surround the origin max g·x is least across the nearest side of their
    /// triangle, where it is the side's distance times |x|: no lower, if that distance is at
    /// least ½ k Δ. (Vertices of equal height are as far apart as their gradients.)
    #[inline(always)]
    fn is_lowest<const BENT: bool>(&self, n: &Vec3, k: Real, step: &Step) -> bool {
        if !(k > 0.0) {
            return true;
        }
        match self.discs::<BENT>() {
            Some(_) if step.count == 2 => return self.cuts.is_ridge(step, self.trust.radius),
            // The disc around an axis is, and no sample along it can be kept.
            Some(discs) if step.count == 1 => return discs.along_axis(n),
            _ => (),
        }
        let discs = self.discs_below::<BENT>(n, step);
        let [u, v, w] = step.set.map(|i| self.with_discs::<BENT>(i, &discs));
        let least = 0.5 * k * self.trust.radius;
        let far = |a: &Vec3, b: &Vec3| {
            let area = n.dot(&a.cross(b));
            area * area >= least * least * (a - b).norm_squared()
        };
        step.count == 3 && far(&v, &w) && far(&w, &u) && far(&u, &v)
    }

    /// Where to ask next, or the answer.
    #[inline(always)]
    fn next<const BENT: bool>(&mut self, known: &mut Known) -> Next {
        let h = self.best_h;
        let rho = self.rho();
        // A touch cannot be lower, and is for others to tell.
        if !(h + rho > self.cuts.rounding) || self.trust.is_stuck() {
            return Next::Open;
        }
        if self.cuts.len == 1 && !self.is_round::<BENT>() {
            let size = self.extent2.sqrt();
            return Next::Ask(self.trust.first_step(&self.best.n, &self.best.p.v, size));
        }
        if BENT && self.slope > 0.0 {
            let best = &self.best;
            return Next::Ask(self.trust.first_step(&best.n, &best.p.v, self.slope));
        }
        self.chart::<BENT>();
        let Some((step, gain)) = self.predict::<BENT>() else {
            return Next::Open;
        };
        self.trust
            .foretell(h - gain + rho, !step.inside, &self.best.n);
        self.step = step.inside.then_some(step);
        let mut n = self.direction(&step);
        let close = gain.abs() <= self.tolerance;
        if step.inside || close && self.is_round::<BENT>() && self.trust.radius >= FIRST {
            let doubtful = self.doubtful::<BENT>(&step, &n, close);
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
                let best = self.best;
                if self.conclude::<BENT>(&best, h, &step, &n, known) {
                    return Next::Found;
                }
                // Shallow, the best direction is near enough for the depth and not for witness
                // points: the minimum itself is, if the model is right.
                if self.step.is_none() || self.asked_there {
                    return Next::Open;
                }
                self.asked_there = true;
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
    fn predict<const BENT: bool>(&mut self) -> Option<(Step, Real)> {
        let mut step = self.cuts.minimise(self.trust.radius);
        if BENT && self.weigh(&step) {
            self.chart::<BENT>();
            step = self.cuts.minimise(self.trust.radius);
        }
        let mut gain = self.gain::<BENT>(&step);
        let level = gain.abs() <= self.tolerance && !step.inside;
        if level && self.is_round::<BENT>() && self.trust.radius < FIRST && !self.levelled {
            // Level so far: is it as far as the first radius?
            self.levelled = true;
            self.trust.radius = FIRST;
            step = self.cuts.minimise(self.trust.radius);
            gain = self.gain::<BENT>(&step);
        }
        let lost = gain < -self.tolerance;
        let close = gain <= self.tolerance && step.inside;
        if lost || close && !self.is_lowest::<BENT>(&self.best.n, self.best_h, &step) {
            // The walk ended above b, or before the end: is it lower anywhere?
            step = self.cuts.lowest(self.trust.radius);
            gain = self.gain::<BENT>(&step);
        }
        let apex = if BENT { self.apex() } else { None };
        if let Some(apex) = apex.filter(|(_, lower)| !(gain >= *lower)) {
            (step, gain) = apex;
        }
        // Also NaN.
        (gain >= -self.tolerance && gain < Real::INFINITY).then_some((step, gain))
    }

    /// Weighs the cuts that are active at a step, for what they bend. Returns whether that is
    /// another than thought.
    #[cold]
    fn weigh(&mut self, step: &Step) -> bool {
        match &mut self.discs {
            Some(discs) => discs.weigh(&step.set, &self.cuts.weights(step)),
            None => false,
        }
    }

    /// How much lower the model is at a step, metres.
    #[inline(always)]
    fn gain<const BENT: bool>(&self, step: &Step) -> Real {
        if BENT {
            let n = self.direction(step);
            return self.best_h - self.levels(&n).most();
        }
        self.best_h - step.level / (1.0 + step.length2()).sqrt()
    }

    /// The unit direction that a step leads to.
    #[inline(always)]
    fn direction(&self, step: &Step) -> Vec3 {
        let d = self.best.n + self.e1 * step.x + self.e2 * step.y;
        d * (1.0 / d.norm())
    }

    /// The step to the axis of a disc, where its support value is least, if it is within the
    /// trust radius, and how much lower the model is there.
    #[cold]
    fn apex(&self) -> Option<(Step, Real)> {
        let discs = self.discs.as_ref()?;
        let b = &self.best.n;
        let n = discs.axis_near(b, self.trust.radius)?;
        let cos = n.dot(b);
        let levels = self.levels(&n);
        let top = levels.most();
        let i = (0..CUTS).find(|&i| levels[i] >= top)?;
        let step = Step {
            x: n.dot(&self.e1) / cos,
            y: n.dot(&self.e2) / cos,
            level: top,
            value: top,
            set: [i; 3],
            count: 1,
            inside: discs.balances(&n, i, &self.u.get(i))?,
        };
        Some((step, self.best_h - top))
    }

    /// The support values of the kept vertices along unit `n`, with their discs.
    fn levels(&self, n: &Vec3) -> Lanes {
        let levels = self.u.dot(n);
        self.discs
            .as_ref()
            .map_or(levels, |discs| levels + discs.heights(n))
    }

    /// The chart of the best direction, and the cuts in it.
    #[inline(always)]
    fn chart<const BENT: bool>(&mut self) {
        let b = self.best.n;
        (self.e1, self.e2) = basis(&b);
        self.cuts.bend = [-self.best_h; 2];
        if self.discs::<BENT>().is_some() {
            self.bend();
            return;
        }
        self.cuts.a = self.u.dot(&b);
        self.cuts.x = self.u.dot(&self.e1);
        self.cuts.y = self.u.dot(&self.e2);
        // Where a direction ties the vertices of a face, one below the origin says nothing
        // that the others do not.
        let (cuts, best) = (&self.cuts, self.cuts.best);
        let flat = larger(cuts.x[best].abs(), cuts.y[best].abs()) <= cuts.rounding;
        let ties = |i: &usize| *i != best && cuts.a[*i] >= self.best_h - cuts.rounding;
        if let (true, Some(other)) = (flat, (0..cuts.len.min(CUTS)).find(ties)) {
            self.cuts.best = other;
        }
    }

    /// The chart along the principal directions of K, K along these, and the cuts in it.
    #[inline(never)]
    fn bend(&mut self) {
        let b = self.best.n;
        let Some(discs) = &self.discs else { return };
        // K along e1 and e2, and across.
        let (mut k, mut l, mut m) = (0.0, 0.0, 0.0);
        for (t, bend) in discs.bends(&b) {
            let (x, y) = (t.dot(&self.e1), t.dot(&self.e2));
            k += bend * x * x;
            l += bend * y * y;
            m += bend * x * y;
        }
        let (half, mean) = (0.5 * (k - l), 0.5 * (k + l));
        let spread = (half * half + m * m).sqrt();
        let cos2 = if spread > 0.0 { half / spread } else { 1.0 };
        // Of half the angle; the sine has m's sign.
        let cos = (0.5 * (1.0 + cos2)).sqrt();
        let sin = (0.5 * (1.0 - cos2)).sqrt().copysign(m);
        let (e1, e2) = (self.e1, self.e2);
        self.e1 = e1 * cos + e2 * sin;
        self.e2 = e2 * cos - e1 * sin;
        let h = self.best_h;
        let cuts = &mut self.cuts;
        cuts.bend = [mean + spread - h, mean - spread - h];
        let points = discs.points(&b, &Vec3::zeros());
        for (lanes, along) in [
            (&mut cuts.a, &b),
            (&mut cuts.x, &self.e1),
            (&mut cuts.y, &self.e2),
        ] {
            *lanes = self.u.dot(along);
            discs.add_along(lanes, &points, along);
        }
    }

    /// The active cuts whose balls must be seen, as bits. Of three cuts the best one's own
    /// point is as good as any.
    #[inline(always)]
    fn doubtful<const BENT: bool>(&self, step: &Step, n: &Vec3, close: bool) -> u32 {
        if self.asked == 1 {
            // A remembered ball is no more than a guess.
            return step.bits();
        }
        let unseen = self.unseen::<BENT>(n, close);
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
        let mut radius = larger(self.radius[0], self.radius[1]);
        for disc in self.discs.iter().flat_map(Discs::discs) {
            radius = larger(radius, disc.radius);
        }
        let tilt = if step.count == 1 {
            // Enough, and to spare, for [`shows`].
            larger(10.0 * TOLD, 8.0 * self.same_round() / radius)
        } else {
            HAIR * self.tolerance / self.extent2.sqrt()
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
    fn conclude<const BENT: bool>(
        &mut self,
        at: &Sample,
        k: Real,
        step: &Step,
        foot: &Vec3,
        known: &mut Known,
    ) -> bool {
        let n = &at.n;
        let depth = k + self.rho();
        let near2 = 2.0 * depth * self.tolerance;
        let rounding = self.cuts.rounding;
        let near2 = larger(near2, rounding * rounding);
        let least = k - self.tolerance;
        let discs = self.discs_below::<BENT>(foot, step);
        let own = |set: &[usize; 3], weights: &[Real; 3]| {
            let mut foot = Vec3::zeros();
            for (&i, &w) in set.iter().zip(weights) {
                // Discs bend between here and where the step began: there its weights were none
                // negative. Else one is by rounding, or the walk over the cuts had no end, and
                // the mean is outside.
                let outside = w * w * self.extent2 > self.tolerance * self.tolerance;
                if w < 0.0 && (BENT || outside) {
                    return None;
                }
                foot += self.with_discs::<BENT>(i, &discs) * w;
            }
            let height = foot.dot(n);
            let across2 = (foot - n * height).norm_squared();
            (height >= least && across2 <= near2).then_some(foot)
        };
        let serves =
            |(set, weights, count): Active| Some((own(&set, &weights)?, set, weights, count));
        let active = serves((step.set, self.weights::<BENT>(step, n, &discs), step.count));
        let of_any = || {
            let any = self.nearest::<BENT>(&(n * k), &discs)?;
            // A ball holds for the points that showed it.
            let unseen = self.unseen::<BENT>(n, true);
            let shown = |(i, w): (&usize, &Real)| *w == 0.0 || unseen >> (i % CUTS) & 1 == 0;
            let all = any.0.iter().zip(&any.1).all(shown);
            all.then(|| serves(any)).flatten()
        };
        let Some((foot, set, weights, mut count)) = active.or_else(of_any) else {
            return false;
        };
        let mut point1 = self.point1::<BENT>(n, &set, &weights, &discs);
        let mut point2 = point1 - foot - n * self.rho();
        // Of one cut the point here is the witness; but of a disc along its axis, all of which is
        // as far.
        if count == 1 {
            let along = self
                .discs::<BENT>()
                .map_or([false; 2], |discs| discs.along(n));
            let same2 = self.same_round() * self.same_round();
            for (along, point, own) in [
                (along[0], &mut point1, &at.p.v1),
                (along[1], &mut point2, &at.p.v2),
            ] {
                if !along && (*point - own).norm_squared() > same2 {
                    return false;
                }
            }
        }
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
            let u = self.with_discs::<BENT>(i, &discs);
            u - n * n.dot(&u)
        };
        let mut slopes = set.map(slope);
        match self.discs::<BENT>() {
            Some(discs) if count == 1 && discs.along_axis(n) => {
                (slopes, count) = (discs.rim_below(&self.u.get(set[0]), n), 3);
            }
            _ => (),
        }
        self.minimum = Minimum {
            hit: Penetration {
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
            },
            slopes,
            count,
        };
        true
    }

    /// The mean of obj1's points, below the origin along `n`.
    #[inline(always)]
    fn point1<const BENT: bool>(
        &self,
        n: &Vec3,
        set: &[usize; 3],
        weights: &[Real; 3],
        discs: &[Vec3; 2],
    ) -> Vec3 {
        let ball = self.radius[0];
        let mut point1 = n * ball;
        for (&i, &w) in set.iter().zip(weights) {
            let at = &self.n.get(i);
            let mut own = self.samples[i % CUTS].p.v1 - at * ball;
            if let Some(taken) = self.discs::<BENT>() {
                own += taken.carried(i, 0, discs, &self.seen) - taken.kept(i, 0);
            }
            point1 += own * w;
        }
        point1
    }

    /// The points of the discs at a minimum along `n`: the farthest; along an axis, where all of
    /// a disc is, the one below the origin.
    #[inline(always)]
    fn discs_below<const BENT: bool>(&self, n: &Vec3, step: &Step) -> [Vec3; 2] {
        let vertex = self.u.get(step.set[0]);
        self.discs::<BENT>()
            .map_or_else(Default::default, |discs| discs.points(n, &vertex))
    }

    /// Weights of the active cuts whose vertices have a mean on the line of `n`, or come
    /// nearest to it.
    #[inline(always)]
    fn weights<const BENT: bool>(&self, step: &Step, n: &Vec3, discs: &[Vec3; 2]) -> [Real; 3] {
        let [u, v, w] = step.set.map(|i| self.with_discs::<BENT>(i, discs));
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

    /// The three vertices, of all kept, that have a mean nearest to this point, and its weights.
    #[cold]
    fn nearest<const BENT: bool>(&self, to: &Vec3, discs: &[Vec3; 2]) -> Option<Active> {
        if self.cuts.len < 3 {
            return None;
        }
        let at = core::array::from_fn(|i| self.with_discs::<BENT>(i, discs) - to);
        let weights = hull(&at, self.cuts.len).1;
        // Rust 1.85 does not see that these are in range.
        let weight = |i: usize| weights[i % CUTS];
        let least = (0..CUTS).min_by(|i, j| weight(*i).total_cmp(&weight(*j)))?;
        let [i, j, k, _] = OTHERS[least % CUTS];
        Some(([i, j, k], [i, j, k].map(weight), 3))
    }
}

// In single precision the search begins with curvature, and not here.
#[cfg(all(test, not(feature = "single")))]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, capsule, corners, hull, placed};

    const TOLERANCE: Real = if EPSILON > 1e-10 { 1e-5 } else { 1e-8 };

    /// How a search ends, and with what.
    enum End {
        Found(Penetration),
        Apart(Vec3),
        Open(Asked),
    }

    fn run(
        a: impl Fn(&Vec3) -> Vec3,
        b: impl Fn(&Vec3) -> Vec3,
        centre: &Vec3,
        start: &Vec3,
    ) -> (End, u64) {
        let md = MinkowskiDifference::new(a, b);
        let settings = Settings {
            tolerance: TOLERANCE,
            max_iterations: 60,
        };
        let mut known = Known::default();
        let n = start.normalize();
        let mut queue = Queue::EMPTY;
        let mut flat = Flat::new();
        let outcome =
            flat.run::<false, _, _>(&md, centre, Some(n), &mut queue, &settings, &mut known);
        let end = match outcome.unwrap() {
            Outcome::Found => End::Found(*flat.minimum(&mut Memory::default())),
            Outcome::Apart(n) => End::Apart(n),
            Outcome::Open => End::Open(flat.asked()),
        };
        (end, md.supports())
    }

    fn found(end: End) -> Penetration {
        match end {
            End::Found(hit) => hit,
            End::Apart(n) => panic!("apart along {n}"),
            End::Open(asked) => panic!("open: {asked:?}"),
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
            let (end, supports) = run(hull(&a), hull(&b), &(axis * -0.98), &start);
            if let End::Open(_) = end {
                open += 1;
                continue;
            }
            let hit = found(end);
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
            let (end, supports) = run(
                ball(Vec3::zeros(), 1.0),
                ball(c, 0.5),
                &-c,
                &(c.normalize() + random.vector(0.2)),
            );
            let hit = found(end);
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
        let (end, supports) = run(
            capsule(-x, x, 0.25),
            capsule(up - y, up + y, 0.15),
            &-up,
            &Vec3::new(0.06, -0.05, 1.0),
        );
        let hit = found(end);
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
                End::Found(hit) => {
                    let depth = hit.depth;
                    assert!((depth - 0.4 / 3.0).abs() < 1e-3, "{depth} from {start}");
                }
                End::Open(_) => {}
                End::Apart(n) => panic!("apart along {n}"),
            }
        }
    }

    /// Of this radius about the z axis, its upper rim in the plane z = 0.
    fn cylinder(radius: Real) -> impl Fn(&Vec3) -> Vec3 {
        move |d| {
            let f = radius / d.x.hypot(d.y);
            Vec3::new(d.x * f, d.y * f, if d.z > 0.0 { 0.0 } else { -2.0 })
        }
    }

    /// A straight line over a cylinder's rim, by e inside of it at 45°: across the line the rim
    /// bends, and the depth is √2 e. Two exact cuts, and K along the line.
    #[test]
    fn an_edge_on_a_rim() {
        let mut random = Random::new(4);
        let n = Vec3::new(1.0, 0.0, 1.0).normalize();
        let along = Vec3::new(1.0, 0.0, -1.0) * 3.0;
        let mut open = 0;
        for _ in 0..100 {
            let (r, e) = (random.within(0.3, 1.5), random.within(0.01, 0.1));
            let at = Vec3::new(r - e, 0.0, -e);
            let (end, supports) = run(
                cylinder(r),
                hull(&[at + along, at - along]),
                &(-at - Vec3::z()),
                &(n + random.vector(0.15)),
            );
            // Ends of the line that look like points of one smooth surface.
            if let End::Open(_) = end {
                open += 1;
                continue;
            }
            let hit = found(end);
            let depth = (2.0 as Real).sqrt() * e;
            assert!((hit.depth - depth).abs() < 2.0 * TOLERANCE, "{}", hit.depth);
            assert!((hit.dir - n).norm() < TOLERANCE.sqrt() * 2.0);
            let near = (4.0 * depth * TOLERANCE).sqrt() + TOLERANCE;
            assert!((hit.point1 - Vec3::x() * r).norm() < near, "{}", hit.point1);
            assert!((hit.point1 - hit.point2 - hit.dir * hit.depth).norm() < near);
            assert!(supports <= 12, "{supports}");
        }
        assert!(open <= 10, "{open}");
    }

    /// A cylinder's flat end on a vertex: least along its axis, where its disc has no curvature.
    #[test]
    fn a_vertex_in_a_flat_end() {
        let mut random = Random::new(5);
        let mut open = 0;
        for _ in 0..100 {
            let at = Vec3::new(0.2, random.within(-0.2, 0.2), random.within(-0.2, -0.01));
            let (end, supports) = run(
                cylinder(0.5),
                ball(at, 0.0),
                &(-at - Vec3::z()),
                &(Vec3::z() + random.vector(0.15)),
            );
            // Started so near the axis that the rim turned by more than a quarter.
            if let End::Open(_) = end {
                open += 1;
                continue;
            }
            let hit = found(end);
            assert!((hit.depth + at.z).abs() < TOLERANCE, "{} {at}", hit.depth);
            assert!((hit.dir - Vec3::z()).norm() < 1e-4);
            assert!((hit.point2 - at).norm() < TOLERANCE.sqrt());
            assert!(supports <= 12, "{supports}");
        }
        assert!(open <= 30, "{open}");
    }

    /// The hull of a cylinder and an edge beside it, parallel to its axis, and a point: round
    /// where the search starts, and a wedge at its minimum, 0.4 / 3 deep; 1 at the flat ends.
    #[test]
    fn a_wedge_is_no_cylinder() {
        let mut random = Random::new(6);
        let wedge = |d: &Vec3| {
            let f = 1.0 / d.x.hypot(d.y);
            let z = (1.0 as Real).copysign(d.z);
            if 3.0 * d.x * f > 1.0 {
                Vec3::new(3.0, 0.0, z)
            } else {
                Vec3::new(d.x * f, d.y * f, z)
            }
        };
        let mut met = 0;
        for _ in 0..400 {
            let start = random.direction();
            match run(
                wedge,
                ball(Vec3::x() * 2.6, 0.0),
                &(Vec3::x() * -2.6),
                &start,
            )
            .0
            {
                End::Found(hit) => {
                    met += 1;
                    let depth = hit.depth;
                    let right = (depth - 0.4 / 3.0).abs() < 1e-3 || (depth - 1.0).abs() < 1e-6;
                    assert!(right, "{depth} from {start}");
                }
                End::Open(_) => {}
                End::Apart(n) => panic!("apart along {n}"),
            }
        }
        assert!(met > 50, "{met}");
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
        let (end, supports) = run(
            ellipsoid,
            ball(Vec3::new(0.3, 0.2, 0.1), 0.2),
            &Vec3::new(-0.3, -0.2, -0.1),
            &Vec3::new(1.0, 0.5, 0.3),
        );
        match end {
            End::Open(asked) => assert_eq!(asked.samples().len() as u64, supports),
            _ => panic!("exact cuts of an ellipsoid"),
        }
    }

    #[test]
    fn apart_is_told() {
        let (end, supports) = run(
            ball(Vec3::zeros(), 1.0),
            ball(Vec3::x() * 3.0, 1.0),
            &(Vec3::x() * -3.0),
            &Vec3::new(1.0, 0.1, 0.0),
        );
        assert!(matches!(end, End::Apart(_)) && supports == 1);
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
        let (end, _) = run(liar, ball(Vec3::zeros(), 0.1), &Vec3::zeros(), &Vec3::x());
        assert!(matches!(end, End::Open(_)));
    }
}
