// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The loop. The derivation stands at the head of `local.rs`.
//!
//! Find the model's minimum near the best direction, for no support point ([`Search::lowest`]);
//! ask there; done, if the objects are as deep as the model foretold; else their two new points join
//! it.

use super::learn::Shown;
use super::memory::{Kind, Memory};
use super::object::{Found, Object, Told};
use super::trust_region::{FIRST, TrustRegion};
use super::walk::{End, Model, ROOM};
use crate::contact::{Penetration, Settings};
use crate::contacts::polygon::Flat;
use crate::known::points::Points;
use crate::known::round::{ALIKE, Move, Same, Seen};
use crate::known::support_set::Stop;
use crate::math::{self, EPSILON, Vec3, larger, unit};
use crate::minkowski::support::{Known, MinkowskiDifference, SupportMap, SupportPoint};
use core::ops::ControlFlow::{self, Break, Continue};

/// Share of the tolerance by which two vertices that are the same may differ: a radius is in error
/// by more than rounding. Insensitive: 0, ÷2, ×2 tried.
pub(super) const SAME: f64 = 0.06;
/// Share of the tolerance by which a depth may differ for what a round part is not: it leaves room
/// for rounding, the radius and the model. Measured: ÷2.5 +0.2 %, +10 % (ellipsoids in motion); ×2 no
/// change, +3 % (cylinders in motion).
pub(super) const HAIR: f64 = 0.25;
/// How much less alike a pair of D may be than one of an object. Measured: ÷2 +0.4 %, +12 % (ellipsoids
/// from 25°); ×1.5 +0.1 %.
const JOINT: f64 = 2.0;
/// Support points that were asked for what they tell, after which the search has lost its way.
/// Measured: ÷2 −0.1 %, ×2 +0.2 %, +2 %.
const DOUBTS: u32 = 4;
/// Support points of one search. Measured: ÷2 +0.3 %, 4 more answers that are no global minimum; ×2
/// +0.3 %.
pub(super) const MOST: usize = 24;
/// The samples kept: the latest.
pub(super) const LATEST: usize = 6;

/// A support point, asked.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    /// Unit direction.
    pub(super) n: Vec3,
    /// The support point there.
    pub(super) p: SupportPoint,
    /// n·p, the support value.
    pub(super) h: f64,
}

impl Sample {
    /// Rounding error of the support value, metres.
    #[inline(always)]
    fn rounding(&self) -> f64 {
        let p = &self.p;
        let size = (p.v1.x.abs() + p.v1.y.abs() + p.v1.z.abs())
            + (p.v2.x.abs() + p.v2.y.abs() + p.v2.z.abs());
        8.0 * EPSILON * size
    }
}

/// The model's minimum.
#[derive(Clone, Copy, Default)]
pub(super) struct Step {
    pub(super) end: End,
    /// The unit direction there, and the depth, metres.
    pub(super) n: Vec3,
    pub(super) depth: f64,
}

/// What comes after a support point: a direction to ask, or the end; `true`: at a local minimum, which is
/// written.
type Next = ControlFlow<bool, Vec3>;

/// A search for a local minimum.
// In this order what is zero at first is two pieces, each less than memset fills word by word.
#[derive(Default)]
#[repr(C)]
pub struct Search {
    pub(super) objects: [Object; 2],
    pub(super) trust: TrustRegion,
    pub(super) model: Model,
    /// The chart of the last walk.
    pub(super) b: Vec3,
    pub(super) e1: Vec3,
    pub(super) e2: Vec3,
    /// Where the best direction is in it.
    pub(super) middle: Flat,
    pub(super) samples: [Sample; LATEST],
    /// The best one, …
    pub(super) best: Sample,
    /// … and the places of its points.
    pub(super) places: [usize; 2],
    /// The last step.
    pub(super) step: Step,
    /// Is the minimum in the direction asked last, should the depth foretold come true?
    pub(super) told: bool,
    /// Where both objects may have discs: the slope of the pair that they were seen by, metres, until
    /// the next sample shows them; else 0.
    pub(super) slope: f64,
    pub(super) extent2: f64,
    pub(super) tolerance: f64,
    /// Before rounding made it larger.
    pub(super) finest: f64,
    pub(super) rounding: f64,
    pub(super) asked: usize,
    pub(super) doubts: u32,
    pub(super) slopes: [Vec3; 3],
    pub(super) count: usize,
}

impl Search {
    /// The directions to ask first: what the memory leads to, else `start`'s.
    #[inline]
    pub fn recall(&mut self, memory: &Memory, start: impl Fn() -> Vec3) -> [Option<Vec3>; 3] {
        let Some(dir) = unit(&memory.dir) else {
            return [Some(start()), None, None];
        };
        if memory.curved != 0 {
            for (object, round) in self.objects.iter_mut().zip(&memory.round()) {
                object.recall(round);
            }
        }
        match memory.recall(&dir) {
            [None, None, None] => [Some(dir), None, None],
            first => first,
        }
    }

    #[inline(always)]
    pub(super) fn rho(&self) -> f64 {
        self.objects[0].ball() + self.objects[1].ball()
    }

    #[inline(always)]
    pub(super) fn is_round(&self) -> bool {
        self.objects[0].is_round() || self.objects[1].is_round()
    }

    #[inline(always)]
    pub(super) fn is_curved(&self) -> bool {
        self.objects
            .iter()
            .any(|object| object.kind == Kind::Curved)
    }

    #[inline(always)]
    pub(super) fn same(&self) -> Same {
        Same {
            rounding: self.rounding,
            round: larger(self.rounding, self.tolerance * SAME),
            extent2: self.extent2,
        }
    }

    /// Searches, from what was `seen` already, then from these directions on.
    ///
    /// `centre`: any inner point of D, its distance is the size of what was not seen.
    /// `known` gains the points of a minimum: the active ones, the one there, the others.
    ///
    /// `true`: at a local minimum, which is written; `false`: not here, [`Search::lowest_met`].
    ///
    /// # Errors
    /// [`Stop::Apart`]; [`Stop::Fault`], where a support mapping answers no number.
    pub fn run<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        centre: &Vec3,
        (seen, first): (Option<&Points>, [Option<Vec3>; 3]),
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let mut first = first.into_iter().flatten();
        loop {
            let k = self.asked;
            let (n, p) = if let Some(seen) = seen.filter(|seen| k < seen.asked()) {
                (seen.direction(k), seen.asked_point(k))
            } else {
                let n = match first.next() {
                    Some(n) => n,
                    None => match self.next(known, hit) {
                        Continue(n) => n,
                        Break(end) => return Ok(end),
                    },
                };
                (n, md.support(&n)?)
            };
            let h = n.dot(&p.v);
            let new = Sample { n, p, h };
            if new.h < 0.0 {
                // D holds what was seen: where that lies beyond, a callback errs.
                let mut seen = self.samples.iter().take(self.asked);
                let errs = seen.any(|sample| sample.p.v.dot(&n) > 0.0);
                return if errs { Ok(false) } else { Err(Stop::Apart(n)) };
            }
            self.samples[self.asked % LATEST] = new;
            self.asked += 1;
            let told = self.told && self.trust.came_true(new.h, self.tolerance);
            self.told = false;
            self.take(&new, centre, settings.tolerance);
            if told
                && !self.is_curved()
                && self.step.end.is_lowest(self.trust.radius)
                && !self.is_doubtful(&n, HAIR * self.tolerance)
                && self.conclude(&new, known, hit)
            {
                return Ok(true);
            }
            if self.asked as u64 >= settings.max_iterations || self.asked >= MOST {
                return Ok(false);
            }
        }
    }

    /// The two points of a sample, as points of D.
    #[inline(always)]
    pub(super) fn points(sample: &Sample) -> [Seen; 2] {
        let n = sample.n;
        [sample.p.v1, -sample.p.v2].map(|p| Seen { n, p })
    }

    /// Takes a support point.
    #[inline(always)]
    fn take(&mut self, new: &Sample, centre: &Vec3, tolerance: f64) {
        let (n, h, p) = (new.n, new.h, &new.p);
        self.rounding = larger(new.rounding(), self.rounding);
        self.extent2 = larger((p.v - centre).norm_squared(), self.extent2);
        let first = self.asked == 1;
        if first {
            self.tolerance = math::tolerance(tolerance, self.extent2.sqrt(), 0.0);
            let least = 8.0 * EPSILON * self.extent2.sqrt();
            self.finest = larger(self.tolerance, least);
        }
        self.tolerance = larger(self.tolerance, self.rounding);
        let same = self.same();
        let points = Self::points(new);
        let before = self.best.h;
        let mut twins = [None; 2];
        if first {
            for object in &mut self.objects {
                object.forget_unless_fits(self.extent2, larger(same.round, tolerance));
            }
        } else {
            self.trust.compare(h, before);
            twins = self.learn(&points, &same);
        }
        let better = first || h < before;
        let best = if better { n } else { self.best.n };
        let mut places = [0; 2];
        for o in 0..2 {
            let kept = self.places[o];
            places[o] = self.objects[o].take(&points[o], twins[o], &best, kept, &same);
        }
        if better {
            (self.best, self.places) = (*new, places);
        }
    }

    /// Looks for what is round: a new point of each object beside those before. Returns which
    /// vertices the new points are, if known.
    #[inline(always)]
    fn learn(&mut self, points: &[Seen; 2], same: &Same) -> [Option<usize>; 2] {
        let mut twins = [None; 2];
        let mut smooth = false;
        for object in &mut self.objects {
            object.pieces = 0;
        }
        if self.is_curved() {
            self.pieces(points, same);
        }
        for o in 0..2 {
            let object = &mut self.objects[o];
            match object.learn(self.places[o], &points[o], same) {
                Shown::Nothing => (),
                Shown::Twin(k) => twins[o] = Some(k),
                Shown::Ball(radius) => {
                    let best = &mut self.places[o];
                    *best = object.take_off((&Found::ball(radius), Told::More), *best, same.round);
                }
                Shown::Smooth => smooth = true,
            }
        }
        if smooth {
            if !self.is_curved() {
                self.pieces(points, same);
            }
            self.learn_discs(points, same);
        }
        twins
    }

    /// The points of each object whose samples show one smooth piece of D with the new one, as bits:
    /// what each of the objects shows there is smooth, too. What its excesses differ by is small
    /// beside D's. Not where one of them shows a vertex of its own.
    #[inline(never)]
    fn pieces(&mut self, points: &[Seen; 2], same: &Same) {
        let new = Seen {
            n: points[0].n,
            p: points[0].p + points[1].p,
        };
        let least = same.rounding * same.rounding;
        for ((object, new), best) in self.objects.iter().zip(points).zip(self.places) {
            let d = new.p - object.at[best % ROOM].p;
            if object.is_exact() || d.norm_squared() <= least {
                return;
            }
        }
        for old in self.samples.iter().take(self.asked) {
            let (n, p) = (old.n, old.p.v);
            if Move::of(&Seen { n, p }, &new).is_smooth(same, JOINT * ALIKE) {
                for object in &mut self.objects {
                    object.note_piece(&old.n);
                }
            }
        }
    }

    /// Looks for discs of the objects whose points look smooth. What is none has R.
    #[inline(never)]
    fn learn_discs(&mut self, points: &[Seen; 2], same: &Same) {
        let shown = [0, 1].map(|o| {
            let object = &self.objects[o];
            object.learn_disc(self.places[o], &points[o], same)
        });
        let curved = [0, 1].map(|o| {
            let none = shown[o]
                .as_ref()
                .is_some_and(|smooth| smooth.found.is_none());
            none || self.objects[o].kind == Kind::Curved
        });
        // Any surface shows two discs at first: the next sample is to tell, where it may be.
        let both = shown
            .iter()
            .flatten()
            .filter(|smooth| smooth.told == Told::Pair)
            .count()
            == 2
            && curved == [false; 2];
        let wait = both && self.asked == 2 && shown.iter().flatten().any(|smooth| smooth.aside);
        if wait {
            let [old, new, ..] = &self.samples;
            let dn = new.n - old.n;
            self.slope = (new.p.v - old.p.v).dot(&dn) / dn.norm_squared();
        }
        for (o, smooth) in shown.into_iter().enumerate() {
            let Some(smooth) = smooth else { continue };
            // Beside what is curved a suspicion is not enough.
            let enough = smooth.told == Told::More || wait || !(both || curved[1 - o]);
            match smooth.found.filter(|_| enough) {
                Some(found) => {
                    let found = (&found, smooth.told);
                    let best = &mut self.places[o];
                    *best = self.objects[o].take_off(found, *best, same.round);
                }
                None => self.objects[o].curve(smooth.with, &points[o]),
            }
        }
    }

    /// Where to ask next, or the answer.
    #[inline(always)]
    fn next(&mut self, known: &mut Known, hit: &mut Penetration) -> Next {
        let best = self.best;
        // A touch cannot be lower, and is for others to tell.
        if !(best.h > self.rounding) {
            return Break(false);
        }
        let round = self.is_round();
        let pair = self.asked == 2 && self.slope > 0.0;
        if self.asked == 1 && !round || pair {
            let (n, v) = (best.n, best.p.v);
            let size = if pair {
                self.slope
            } else {
                self.extent2.sqrt()
            };
            return Continue(self.trust.first_step(&n, &v, size));
        }
        let b = best.n;
        self.lowest();
        if round && self.gain() < -self.tolerance {
            // Above what was seen: what it took for round is not, or not any more.
            self.objects.iter_mut().for_each(Object::unround);
            self.lowest();
        }
        let level = round && self.gain().abs() <= self.tolerance && self.step.end.on_border;
        if level && self.trust.radius != FIRST {
            // Level so far: is it as far as the first radius?
            self.trust.radius = FIRST;
            let near = self.step;
            self.lowest();
            if !(self.step.depth <= near.depth) {
                self.step = near;
            }
        }
        if self.gain() <= self.tolerance
            && !self.step.end.on_border
            && !self.step.end.is_lowest(self.trust.radius)
        {
            self.look_around();
        }
        let gain = self.gain();
        // Also NaN.
        if self.step.end.lost || !(gain >= -self.tolerance && gain < f64::INFINITY) {
            return Break(false);
        }
        let inside = !self.step.end.on_border;
        self.trust.foretell(self.step.depth, !inside);
        let settled = gain <= self.tolerance && (inside || round && self.trust.radius >= FIRST);
        self.told = inside && !settled;
        let n = if settled {
            self.settle(&best, known, hit)?
        } else if inside && round {
            self.towards_unseen()
        } else {
            self.step.n
        };
        if (n - b).norm_squared() < EPSILON * EPSILON {
            return Break(false);
        }
        Continue(n)
    }

    /// How much lower than the best sample the model is, metres.
    #[inline(always)]
    fn gain(&self) -> f64 {
        self.best.h - self.step.depth
    }

    /// The best direction is as deep as the model's minimum: the answer, or what is to be asked
    /// before it is, if that was not done too often.
    #[inline(always)]
    fn settle(&mut self, best: &Sample, known: &mut Known, hit: &mut Penetration) -> Next {
        let b = &best.n;
        let n = if let Some(n) = self.open(b) {
            n
        } else if self.is_doubtful(b, HAIR * self.tolerance) {
            self.trust.no_forecast();
            self.beside()
        } else if self.conclude(best, known, hit) {
            return Break(true);
        } else {
            // Shallow, the best direction is near enough for the depth and not for witness points:
            // the minimum itself is, if the model is right.
            self.step.n
        };
        self.doubts += 1;
        if self.doubts > DOUBTS {
            return Break(false);
        }
        Continue(n)
    }
}

// In single precision more of them are left to the paper's method.
#[cfg(all(test, not(feature = "single")))]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, capsule, corners, hull, placed};

    const TOLERANCE: f64 = if EPSILON > 1e-10 { 1e-5 } else { 1e-8 };

    /// How a search ends, and with what.
    enum End {
        Found(Penetration),
        Apart(Vec3),
        Open,
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
        let mut hit = Penetration::default();
        let mut exact = Search::default();
        let outcome = exact.run(
            &md,
            centre,
            (None, [Some(n), None, None]),
            &settings,
            &mut known,
            &mut hit,
        );
        let end = match outcome {
            Ok(true) => End::Found(hit),
            Ok(false) => End::Open,
            Err(Stop::Apart(n)) => End::Apart(n),
            Err(fault) => panic!("{fault:?}"),
        };
        (end, md.supports())
    }

    fn found(end: End) -> Penetration {
        match end {
            End::Found(hit) => hit,
            End::Apart(n) => panic!("apart along {n}"),
            End::Open => panic!("open"),
        }
    }

    fn ball(c: Vec3, r: f64) -> impl Fn(&Vec3) -> Vec3 {
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
            if let End::Open = end {
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
                End::Open => {}
                End::Apart(n) => panic!("apart along {n}"),
            }
        }
    }

    /// Of this radius about the z axis, its upper rim in the plane z = 0.
    fn cylinder(radius: f64) -> impl Fn(&Vec3) -> Vec3 {
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
            if let End::Open = end {
                open += 1;
                continue;
            }
            let hit = found(end);
            let depth = (2.0 as f64).sqrt() * e;
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
            if let End::Open = end {
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
            let z = (1.0 as f64).copysign(d.z);
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
                End::Open => {}
                End::Apart(n) => panic!("apart along {n}"),
            }
        }
        assert!(met > 50, "{met}");
    }

    /// What is smooth and no ball has R: an ellipsoid and a ball, whose centre is on the way of a
    /// normal of the ellipsoid.
    #[test]
    fn an_ellipsoid_shows_its_curvature() {
        let mut random = Random::new(7);
        let r = Vec3::new(0.5, 0.35, 0.25);
        let ellipsoid = |d: &Vec3| {
            let w = r.component_mul(&r.component_mul(d));
            w / w.dot(d).sqrt()
        };
        let mut open = 0;
        for _ in 0..200 {
            let n = random.direction();
            let at = ellipsoid(&n) + n * 0.15;
            let (end, supports) = run(ellipsoid, ball(at, 0.2), &-at, &(n + random.vector(0.1)));
            if let End::Open = end {
                open += 1;
                continue;
            }
            let hit = found(end);
            assert!((hit.depth - 0.05).abs() < 2.0 * TOLERANCE, "{}", hit.depth);
            let near = (2.0 * hit.depth * TOLERANCE).sqrt();
            assert!((hit.point1 - ellipsoid(&n)).norm() < 2.0 * near);
            assert!(supports <= 16, "{supports}");
        }
        assert!(open <= 4, "{open}");
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
        assert!(matches!(end, End::Open));
    }
}
