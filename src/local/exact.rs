// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The search on what is known of each object: polytopes, and polytopes with a ball or a disc
//! around them (spheres, capsules, rounded boxes; cylinders, cones).
//!
//! *Loop*: find the model's minimum near the best direction, for no support point ([`Model::walk`]);
//! ask there; done, if the objects are as deep as the model foretold; else their two new points join
//! it. k support points are k² cuts of D, so that an edge over an edge is known from two samples.
//!
//! *Discs bend the chart*: there the walk is taken again from the chart of its end, until that does
//! not move (Newton's method). Along its axis a disc's support function has its least value and a
//! kink, which no chart knows: where that is within the trust radius the model's exact value
//! there is compared. No vertex is known of a sample along the axis, so it ends the search, one way
//! or the other.
//!
//! *The end*: a smooth surface that is neither, points that contradict each other, a trust region
//! that has shrunk to nothing. Then the search with curvature goes on.

use super::memory::{EDGES, Memory, Queue, Smooth};
use super::model::basis;
use super::object::{self, Found, Object, Same, Shown};
use super::samples::Sample;
use super::trust_region::{FIRST, TrustRegion};
use super::walk::{Cuts, End, Kink, Model, ROOM};
use crate::contact::{Penetration, Settings};
use crate::contacts::polygon::{Flat, dot};
use crate::contacts::pressure;
use crate::known::round::{Disc, Seen, TOLD};
use crate::known::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{self, EPSILON, Real, Vec3, larger, perpendicular, unit};

/// Share of the tolerance by which two vertices that are the same may differ: a radius is in error
/// by more than rounding. Insensitive: 0, ÷2, ×2 tried.
const SAME: Real = 0.06;
/// Share of the tolerance by which a depth may differ for what a round part is not: it leaves room
/// for rounding, the radius and the model. Insensitive.
const HAIR: Real = 0.25;
/// How far beside a disc's axis its rim is asked for, radians: enough to tell it from the others'
/// points by five digits.
const BESIDE: Real = 1e-4;
/// Support points that were asked for what they tell, after which the search has lost its way.
const DOUBTS: u32 = 4;
/// Support points of one search.
const MOST: usize = 24;
/// Charts of one walk where discs bend, …
const CHARTS: usize = 6;
/// … until what they are off by is this share of the tolerance. Insensitive: 0.03 to 0.3 tried,
/// within 1 % of the support points.
const NEWTON: Real = 0.1;
/// Where walks start beside the best direction, in trust radii: on all sides, off the axes.
const AROUND: [Flat; 4] = [[0.9, 0.1], [-0.1, 0.9], [-0.9, -0.1], [0.1, -0.9]];
/// The samples kept: the best one, and the latest.
const LATEST: usize = 6;

/// How a search of exact cuts ends.
#[derive(Debug)]
pub enum Outcome {
    /// At a local minimum: [`Exact::minimum`].
    Found,
    /// All of D is on the far side of this unit direction's support plane.
    Apart(Vec3),
    /// Not here; [`Exact::asked`] to go on from.
    Open,
}

/// The last samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    samples: [Sample; LATEST],
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

/// The model's minimum.
#[derive(Clone, Copy)]
struct Step {
    end: End,
    /// The unit direction there, and the depth, metres.
    n: Vec3,
    depth: Real,
    /// Along the axis of that object's disc.
    axis: Option<usize>,
}

/// What comes after a support point.
enum Next {
    Ask(Vec3),
    Found,
    Open,
}

/// A search of exact cuts.
pub struct Exact {
    objects: [Object; 2],
    model: Model,
    /// The chart of the last walk.
    b: Vec3,
    e1: Vec3,
    e2: Vec3,
    /// Where the best direction is in it.
    middle: Flat,
    samples: [Sample; LATEST],
    /// The best one's place, …
    best: usize,
    /// … those of its points, …
    places: [usize; 2],
    /// … and of the newest one's.
    newest_places: [usize; 2],
    trust: TrustRegion,
    /// The last step.
    step: Step,
    /// Is the minimum in the direction asked last, should the depth foretold come true?
    told: bool,
    /// Where both objects may have discs: the slope of the pair that they were seen by, metres, until
    /// the next sample shows them; else 0.
    slope: Real,
    extent2: Real,
    tolerance: Real,
    rounding: Real,
    newest: usize,
    asked: usize,
    doubts: u32,
    /// Did the search before find what is round?
    recalled: bool,
    levelled: bool,
    /// Was the model's minimum asked because the best direction showed no witness points?
    asked_there: bool,
    hit: Penetration,
    slopes: [Vec3; 3],
    count: usize,
}

impl Exact {
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            objects: [Object::NEW; 2],
            model: Model {
                cuts: [Cuts::NONE; 2],
            },
            b: Vec3::zeros(),
            e1: Vec3::zeros(),
            e2: Vec3::zeros(),
            middle: [0.0; 2],
            samples: [Sample::default(); LATEST],
            best: 0,
            places: [0; 2],
            newest_places: [0; 2],
            trust: TrustRegion::new(FIRST),
            step: Step {
                end: End::NONE,
                n: Vec3::zeros(),
                depth: 0.0,
                axis: None,
            },
            told: false,
            slope: 0.0,
            extent2: 0.0,
            tolerance: 0.0,
            rounding: 0.0,
            newest: 0,
            asked: 0,
            doubts: 0,
            recalled: false,
            levelled: false,
            asked_there: false,
            hit: Penetration::default(),
            slopes: [Vec3::zeros(); 3],
            count: 0,
        }
    }

    /// The directions to ask first: what the memory leads to, else `start`'s.
    #[inline]
    pub fn recall(&mut self, memory: &Memory, start: impl Fn() -> Vec3) -> (Vec3, Queue) {
        let Some(dir) = unit(&memory.dir) else {
            return (start(), Queue::EMPTY);
        };
        if let Smooth::Round { balls, discs } = memory.smooth() {
            for (o, object) in self.objects.iter_mut().enumerate() {
                object.recall(balls[o], discs[o]);
            }
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

    /// The answer of a search that found a minimum; what finds its cuts again stays behind.
    #[inline]
    pub fn minimum(&self, memory: &mut Memory) -> &Penetration {
        let dir = &self.hit.dir;
        // Along a disc's axis its points are those of a polytope.
        let discs = [0, 1].map(|o| {
            let disc = *self.objects[o % 2].disc();
            if disc.is_there() && disc.is_along(dir) {
                Disc::default()
            } else {
                disc
            }
        });
        let balls = [0, 1].map(|o: usize| self.objects[o % 2].radius);
        let round = balls[0] + balls[1] > 0.0 || discs.iter().any(Disc::is_there);
        let smooth = if round {
            Smooth::Round { balls, discs }
        } else {
            match memory.smooth() {
                // Not needed this time.
                curved @ Smooth::Curved(..) => curved,
                _ => Smooth::Unknown,
            }
        };
        memory.keep(dir, &self.slopes, self.count, smooth);
        &self.hit
    }

    /// What was asked, after a search that found no minimum.
    #[cold]
    pub fn asked(&self) -> Asked {
        let mut asked = Asked {
            trust: self.trust.radius,
            ..Asked::default()
        };
        let kept = self.asked.min(LATEST);
        let last = self.newest;
        let mut others = (0..kept).filter(|i| *i != last);
        for (place, i) in asked.samples.iter_mut().zip(&mut others) {
            *place = self.samples[i % LATEST];
            asked.len += 1;
        }
        if let Some(place) = asked.samples.get_mut(asked.len) {
            *place = self.samples[last % LATEST];
            asked.len += 1;
        }
        asked.dropped = (self.asked - asked.len) as u64;
        asked
    }

    #[inline(always)]
    fn rho(&self) -> Real {
        self.objects[0].radius + self.objects[1].radius
    }

    #[inline(always)]
    fn is_round(&self) -> bool {
        self.objects[0].is_round() || self.objects[1].is_round()
    }

    #[inline(always)]
    fn same(&self) -> Same {
        Same {
            rounding: self.rounding,
            round: larger(self.rounding, self.tolerance * SAME),
            extent2: self.extent2,
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
            if new.h < 0.0 {
                // D holds what was seen: where that lies beyond, a callback errs.
                let mut seen = self.samples.iter().take(self.asked);
                return Ok(if !seen.any(|sample| sample.p.v.dot(&n) > 0.0) {
                    Outcome::Apart(n)
                } else {
                    Outcome::Open
                });
            }
            let place = self.put(&new);
            let told = self.told && self.trust.came_true(new.h, self.tolerance);
            if let (true, Some(o)) = (self.told, self.step.axis) {
                let other = &self.objects[(o + 1) % 2];
                let seen =
                    !other.is_unseen(self.step.end.active[(o + 1) % 2], &n, HAIR * self.tolerance);
                let found = told && seen && self.conclude(place, known);
                let found = found && !self.is_cut_short(md, &n, o)?;
                return Ok(if found { Outcome::Found } else { Outcome::Open });
            }
            self.told = false;
            if !self.take(place, centre, settings.tolerance) {
                return Ok(Outcome::Open);
            }
            if told
                && self.is_lowest()
                && !self.is_doubtful(&n, self.newest_places)
                && self.conclude(place, known)
            {
                return Ok(Outcome::Found);
            }
            if self.asked as u64 >= settings.max_iterations || self.asked >= MOST {
                return Ok(Outcome::Open);
            }
            if let Some(next) = queue.pop() {
                n = next;
                continue;
            }
            match self.next(known) {
                Next::Ask(next) => n = next,
                Next::Found => return Ok(Outcome::Found),
                Next::Open => return Ok(Outcome::Open),
            }
        }
    }

    /// Keeps a sample in the place of the oldest one that is not the best.
    #[inline(always)]
    fn put(&mut self, new: &Sample) -> usize {
        let mut place = self.newest + 1;
        if self.asked < LATEST {
            place = self.asked;
        } else if place % LATEST == self.best {
            place += 1;
        }
        self.newest = place % LATEST;
        self.samples[self.newest] = *new;
        self.asked += 1;
        self.newest
    }

    /// The best sample.
    #[inline(always)]
    fn best(&self) -> &Sample {
        &self.samples[self.best % LATEST]
    }

    /// The two points of a sample, as points of D.
    #[inline(always)]
    fn points(sample: &Sample) -> [Seen; 2] {
        let n = sample.n;
        [sample.p.v1, -sample.p.v2].map(|p| Seen { n, p })
    }

    /// Takes a support point. Not, if it is of no exact cut.
    #[inline(always)]
    fn take(&mut self, place: usize, centre: &Vec3, tolerance: Real) -> bool {
        let new = &self.samples[place % LATEST];
        let (n, h, p) = (new.n, new.h, &new.p);
        self.rounding = larger(new.rounding(), self.rounding);
        self.extent2 = larger((p.v - centre).norm_squared(), self.extent2);
        let first = self.asked == 1;
        if first {
            self.tolerance = math::tolerance(tolerance, self.extent2.sqrt(), 0.0);
        }
        self.tolerance = larger(self.tolerance, self.rounding);
        let same = self.same();
        let points = Self::points(new);
        let before = self.best().h;
        let mut twins = [None; 2];
        if first {
            for object in &mut self.objects {
                object.forget_unless_fits(self.extent2);
            }
        } else {
            self.trust.compare(&n, h, before);
            if self.recalled {
                for (o, object) in self.objects.iter_mut().enumerate() {
                    self.places[o] = object.turn(self.places[o], &points[o], &same, self.asked);
                }
            }
            match self.learn(&points, &same) {
                Some(known) => twins = known,
                None => return false,
            }
        }
        let better = first || h < before;
        let best = if better { n } else { self.best().n };
        let mut places = [0; 2];
        for o in 0..2 {
            let object = &mut self.objects[o];
            let kept = self.places[o];
            let place = object.take(&points[o], twins[o], &best, kept, &same, self.asked);
            match place {
                Some(place) => places[o] = place,
                None => return false,
            }
        }
        if self.slope > 0.0 && self.asked > 2 {
            self.slope = 0.0;
            if self.objects.iter().any(Object::is_doubted) {
                return false;
            }
        }
        self.newest_places = places;
        if better {
            (self.best, self.places) = (place, places);
        }
        true
    }

    /// Looks for balls and discs: a new point of each object beside those before. Returns which
    /// vertices the new points are, if known; `None`, where there is something smooth that is
    /// neither.
    #[inline(always)]
    fn learn(&mut self, points: &[Seen; 2], same: &Same) -> Option<[Option<usize>; 2]> {
        let mut twins = [None; 2];
        let mut smooth = false;
        for o in 0..2 {
            let object = &mut self.objects[o];
            match object.learn(self.places[o], &points[o], same) {
                Shown::Nothing => (),
                Shown::Twin(k) => twins[o] = Some(k),
                Shown::Ball(radius) => {
                    self.places[o] = object.take_ball(radius, self.places[o], same);
                }
                Shown::Smooth => smooth = true,
            }
        }
        (!smooth || self.learn_discs(points, same)).then_some(twins)
    }

    /// Looks for discs of the objects whose points look smooth. False, where these are none.
    #[inline(never)]
    fn learn_discs(&mut self, points: &[Seen; 2], same: &Same) -> bool {
        let mut maybe: [Option<(Found, bool, bool)>; 2] = [None, None];
        for o in 0..2 {
            match self.objects[o].learn_disc(self.places[o], &points[o], same) {
                object::Smooth::None => (),
                object::Smooth::Disc(found, confirmed, aside) => {
                    maybe[o] = Some((found, confirmed, aside))
                }
                object::Smooth::Other => return false,
            }
        }
        match maybe {
            [None, None] => return true,
            [Some(_), None] | [None, Some(_)] => (),
            // Any surface shows two of them at first: the next sample is to tell, where it may be.
            [Some(p), Some(q)] if !p.1 && !q.1 => {
                if self.asked > 2 || !p.2 && !q.2 {
                    return false;
                }
                let [d, e] = [0, 1].map(|o| points[o].p - self.objects[o].at[0].p);
                let dn = points[0].n - self.best().n;
                self.slope = (d + e).dot(&dn) / dn.norm_squared();
            }
            _ => (),
        }
        for (o, maybe) in maybe.iter().enumerate() {
            if let Some((found, confirmed, _)) = maybe {
                let found = (found, *confirmed);
                let object = &mut self.objects[o];
                self.places[o] = object.take_disc(found, self.asked, self.places[o], same);
            }
        }
        true
    }

    /// Are the round parts of an active point in doubt at unit `n`, where the objects' own points are
    /// in these places? Also where an object's own is another one.
    #[inline(always)]
    fn is_doubtful(&self, n: &Vec3, places: [usize; 2]) -> bool {
        if !self.is_round() {
            return false;
        }
        let hair = HAIR * self.tolerance;
        let end = &self.step.end;
        let unseen = |o: usize, k: usize| self.objects[o % 2].is_unseen(k, n, hair);
        let kinks = end.kinks.iter().take(end.count);
        for o in (0..2).filter(|o| self.objects[*o].is_round()) {
            let own = |k: &Kink| k.object == o && k.point == places[o];
            if end.active[o] != places[o] && !kinks.clone().any(own) {
                return true;
            }
        }
        unseen(0, end.active[0])
            || unseen(1, end.active[1])
            || end
                .kinks
                .iter()
                .take(end.count)
                .any(|k| unseen(k.object, k.point))
    }

    /// Where to ask next, or the answer.
    #[inline(always)]
    fn next(&mut self, known: &mut Known) -> Next {
        let best = self.best();
        // A touch cannot be lower, and is for others to tell.
        if !(best.h > self.rounding) || self.trust.is_stuck() {
            return Next::Open;
        }
        let round = self.is_round();
        if self.asked == 1 && !round || self.slope > 0.0 {
            let (n, v) = (best.n, best.p.v);
            let size = if self.slope > 0.0 {
                self.slope
            } else {
                self.extent2.sqrt()
            };
            return Next::Ask(self.trust.first_step(&n, &v, size));
        }
        let (b, h) = (best.n, best.h);
        self.lowest();
        let mut gain = h - self.step.depth;
        if round
            && gain.abs() <= self.tolerance
            && self.step.end.on_border
            && self.trust.radius < FIRST
            && !self.levelled
        {
            // Level so far: is it as far as the first radius?
            self.levelled = true;
            self.trust.radius = FIRST;
            self.lowest();
            gain = h - self.step.depth;
        }
        if gain <= self.tolerance && !self.step.end.on_border && !self.is_lowest() {
            self.look_around();
            gain = h - self.step.depth;
        }
        // Also NaN.
        if !(gain >= -self.tolerance && gain < Real::INFINITY) || self.step.end.lost {
            return Next::Open;
        }
        let inside = !self.step.end.on_border;
        self.trust.foretell(self.step.depth, !inside, &b);
        self.told = inside;
        let mut n = self.step.n;
        if self.step.axis.is_some() {
            return Next::Ask(n);
        }
        if gain <= self.tolerance && (inside || round && self.trust.radius >= FIRST) {
            // A remembered ball is no more than a guess.
            if self.asked == 1 || self.is_doubtful(&b, self.places) {
                self.doubts += 1;
                if self.doubts > DOUBTS {
                    return Next::Open;
                }
                self.trust.no_forecast();
                self.told = false;
                n = self.beside();
            } else {
                if self.conclude(self.best, known) {
                    return Next::Found;
                }
                // Shallow, the best direction is near enough for the depth and not for witness
                // points: the minimum itself is, if the model is right.
                if !self.told || self.asked_there {
                    return Next::Open;
                }
                self.asked_there = true;
            }
        } else if inside && round {
            n = self.towards_unseen();
        }
        if (n - b).norm_squared() < EPSILON * EPSILON {
            return Next::Open;
        }
        Next::Ask(n)
    }

    /// From the model's minimum a hair towards the points of kinks that were not seen twice, so that
    /// the sample there sees them.
    #[inline(never)]
    fn towards_unseen(&self) -> Vec3 {
        let end = &self.step.end;
        let mut n = self.step.n;
        for kink in end.kinks.iter().take(end.count) {
            let object = &self.objects[kink.object % 2];
            let active = end.active[kink.object % 2];
            if !object.is_round() {
                continue;
            }
            let [there, here] = [kink.point, active].map(|k| object.seen_twice(k));
            if there != here {
                let e = object.core(kink.point) - object.core(active);
                let e = e - n * n.dot(&e);
                let hair = if here { SAME } else { -SAME } * 3.0 * self.tolerance;
                n += e * (hair / e.norm_squared());
            }
        }
        let n2 = n.norm_squared();
        if n2 > 0.0 && n2 < 2.0 {
            n * (1.0 / n2.sqrt())
        } else {
            self.step.n
        }
    }

    /// From the model's minimum to where a doubted vertex shows, by so little that the depth there
    /// is the minimum's within the tolerance.
    #[cold]
    fn beside(&self) -> Vec3 {
        let n = self.step.n;
        let hair = HAIR * self.tolerance;
        let end = &self.step.end;
        let places = [(0, end.active[0]), (1, end.active[1])];
        let kinks = end
            .kinks
            .iter()
            .take(end.count)
            .map(|k| (k.object, k.point));
        let mut side = Vec3::zeros();
        let mut worst = -1.0;
        let mut size: Real = 0.0;
        for (o, k) in places.into_iter().chain(kinks) {
            let object = &self.objects[o % 2];
            let doubted = self.asked == 1 || object.is_unseen(k, &self.best().n, hair);
            let off = object.at[k % ROOM].n - n;
            let radius = larger(object.radius, object.disc().radius);
            let lift = radius * off.norm_squared();
            if object.is_round() && doubted && lift > worst {
                (side, worst, size) = (off, lift, radius);
            }
        }
        let side = side - n * n.dot(&side);
        let side = unit(&side).unwrap_or_else(|| perpendicular(&n));
        let same = self.same().round;
        let tilt = if end.count == 0 {
            // Enough, and to spare, to be told from a vertex.
            larger(10.0 * TOLD, 8.0 * same / size)
        } else {
            larger((0.8 * hair / size).sqrt(), 10.0 * TOLD)
        };
        // Not NaN, whose tilt is none.
        let n = n + side * if tilt < FIRST { tilt } else { FIRST };
        n * (1.0 / n.norm())
    }

    /// The chart of unit `b`, and the cuts in it.
    #[inline(never)]
    fn chart(&mut self, b: &Vec3) {
        self.b = *b;
        (self.e1, self.e2) = basis(b);
        for (object, cuts) in self.objects.iter().zip(&mut self.model.cuts) {
            object.chart(b, [&self.e1, &self.e2], cuts);
        }
    }

    #[inline(always)]
    fn direction(&self, x: &Flat) -> Vec3 {
        let d = self.b + self.e1 * x[0] + self.e2 * x[1];
        d * (1.0 / d.norm())
    }

    /// The model's minimum near the best direction.
    #[inline(never)]
    fn lowest(&mut self) {
        let b = self.best().n;
        let radius = self.trust.radius;
        self.chart(&b);
        self.step.axis = None;
        self.middle = [0.0; 2];
        if self.is_bent() {
            return self.lowest_bent(&b);
        }
        let end = &mut self.step.end;
        self.model.walk::<false>(&[0.0; 2], &[0.0; 2], radius, end);
        let end = &self.step.end;
        (self.step.n, self.step.depth) = (self.direction(&end.x), end.value + self.rho());
    }

    /// Is the last step's minimum the lowest within the trust radius, as far as it tells by itself?
    #[inline(always)]
    fn is_lowest(&self) -> bool {
        let end = &self.step.end;
        end.count < 2 || end.is_lowest(self.trust.radius)
    }

    /// Walks from the sides of the trust region: the lowest end stays.
    #[inline(never)]
    fn look_around(&mut self) {
        let (middle, radius) = (self.middle, self.trust.radius);
        let bent = self.is_bent();
        for at in AROUND {
            let from = [0, 1].map(|i| middle[i] + at[i] * radius);
            let mut end = End::NONE;
            if bent {
                self.model.walk::<true>(&from, &middle, radius, &mut end);
            } else {
                self.model.walk::<false>(&from, &middle, radius, &mut end);
            }
            let n = self.direction(&end.x);
            let depth = self.depth(&n);
            // False for NaN.
            if depth < self.step.depth - self.tolerance {
                (self.step.end, self.step.n, self.step.depth) = (end, n, depth);
            }
        }
    }

    /// The model's depth along unit `n`.
    fn depth(&self, n: &Vec3) -> Real {
        self.objects[0].height(n).0 + self.objects[1].height(n).0 + self.rho()
    }

    #[inline(always)]
    fn is_bent(&self) -> bool {
        self.objects.iter().any(|object| object.disc().is_there())
    }

    /// The same where discs bend.
    #[inline(never)]
    fn lowest_bent(&mut self, best: &Vec3) {
        let radius = self.trust.radius;
        for _ in 0..CHARTS {
            let end = &mut self.step.end;
            let middle = &self.middle;
            self.model.walk::<true>(&[0.0; 2], middle, radius, end);
            let x2 = dot(&end.x, &end.x);
            let x = end.x;
            let n = self.direction(&x);
            self.step.n = n;
            // A chart is off by third order in its slope, so its least value by fourth.
            if !(x2 * x2 * self.extent2.sqrt() > NEWTON * self.tolerance) {
                break;
            }
            self.chart(&n);
            let along = best.dot(&n);
            self.middle = [best.dot(&self.e1) / along, best.dot(&self.e2) / along];
        }
        self.step.depth = self.depth(&self.step.n);
        self.axis(best, radius);
    }

    /// The step to the axis of a disc, where its support value is least, if it is within the
    /// trust radius, lower, and that disc alone balances the points there.
    #[inline(always)]
    fn axis(&mut self, b: &Vec3, radius: Real) {
        let near = |object: &Object| {
            let cos = object.disc().axis.dot(b);
            let aside2 = object.disc().across(b).norm_squared();
            object.is_confirmed() && aside2 <= cos * cos * radius * radius
        };
        let Some(o) = (0..2).find(|o| near(&self.objects[*o])) else {
            return;
        };
        let disc = *self.objects[o % 2].disc();
        let n = disc.axis * (1.0 as Real).copysign(disc.axis.dot(b));
        let [(h, i), (k, j)] = [self.objects[0].height(&n), self.objects[1].height(&n)];
        let depth = h + k + self.rho();
        let core = self.objects[0].core(i) + self.objects[1].core(j);
        let alone = !self.objects[1 - o].disc().is_there();
        if depth < self.step.depth && alone && disc.across(&core).norm() <= disc.radius {
            let end = &mut self.step.end;
            (end.active, end.count, end.on_border, end.lost) = ([i, j], 0, false, false);
            (self.step.n, self.step.depth, self.step.axis) = (n, depth, Some(o));
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
    fn conclude(&mut self, at: usize, known: &mut Known) -> bool {
        let at = &self.samples[at % LATEST];
        let step = &self.step;
        let n = at.n;
        let n = &n;
        let depth = at.h;
        let end = &step.end;
        let mut points = [0, 1].map(|o: usize| self.objects[o % 2].point(end.active[o % 2], n));
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
            let there = object.point(kink.point, n);
            let e = there - object.point(end.active[kink.object % 2], n);
            points[kink.object % 2] += e * end.weights[i];
            slopes[i + 1] += e;
        }
        let foot = points[0] + points[1];
        let height = foot.dot(n);
        let across2 = (foot - n * height).norm_squared();
        let near2 = larger(2.0 * depth * self.tolerance, self.rounding * self.rounding);
        if !(height >= depth - self.tolerance && across2 <= near2) {
            return false;
        }
        let (mut point1, mut point2) = (points[0], -points[1]);
        // Of one cut the point here is the witness; but of a disc along its axis, all of which is as
        // far.
        if end.count == 0 {
            let same = self.same().round;
            for (o, (point, own)) in [(&point1, &at.p.v1), (&point2, &at.p.v2)]
                .into_iter()
                .enumerate()
            {
                if step.axis != Some(o) && (point - own).norm_squared() > same * same {
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

    /// Names the points of D for the proof: the active ones, the one here, the others.
    #[inline(always)]
    fn show(&self, at: &Sample, end: &End, known: &mut Known) {
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
        if end.count == 1 || end.count == 2 && self.is_round() {
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

// In single precision more of them are left to the search with curvature.
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
        let mut exact = Exact::new();
        let outcome = exact.run(&md, centre, n, &mut queue, &settings, &mut known);
        let end = match outcome.unwrap() {
            Outcome::Found => End::Found(*exact.minimum(&mut Memory::default())),
            Outcome::Apart(n) => End::Apart(n),
            Outcome::Open => End::Open(exact.asked()),
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
