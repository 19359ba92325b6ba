// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The loop: ask, learn, keep, look where the model is least, judge. The derivation stands at
//! the head of `local.rs`.

use core::ops::ControlFlow;

use super::curvature::Curvature;
use super::memory::{Memory, Queue, Smooth};
use super::model::{Model, Step};
use super::samples::{CUTS, Sample, Samples};
use super::trust_region::{self, ASIDE, TrustRegion};
use super::verdict::{Next, Verdict, judge};
use super::witness::{INSIDE, Witnesses};
use crate::contact::{Answer, Settings};
use crate::known::support::{Fault, Known, MinkowskiDifference, SupportMap};
use crate::math::{EPSILON, Real, Vec3, larger, perpendicular, tolerance, unit};

/// Support points asked to see witness points that only R leads to: as many as are kept. Derived:
/// each makes one point the objects' own. Without any there are 11 more.
pub const WITNESS_QUERIES: usize = CUTS;
/// Support points after which curvature is given up. Measured: ×2 no change, +2 %; ÷2 no change,
/// +1.4 %; never +44 % on touches of random pairs.
pub const TRUST_CURVATURE: u64 = 40;

/// A search for a local minimum.
pub struct Search<'a> {
    samples: Samples<'a>,
    curvature: Curvature,
    trust: TrustRegion,
    queue: Queue,
    /// Samples asked before, not yet taken.
    asked: &'a [Sample],
    /// The sample whose error the next one settles, and whose place it takes.
    probed: Option<usize>,
    /// The last sample contradicted another, or lay beyond the origin: the next one, a little
    /// beside it, is taken as it is.
    again: bool,
    /// Any inner point of D: how far the support points lie from it is what curvature is first
    /// guessed from.
    inner: Vec3,
    settings: Settings,
    /// In force, metres.
    tolerance: Real,
    iterations: u64,
    witness_queries: usize,
}

impl<'a> Search<'a> {
    #[inline]
    pub fn new(inner: Option<&Vec3>, settings: &Settings, known: &'a mut Known) -> Self {
        Self {
            samples: Samples::new(known),
            curvature: Curvature::new(),
            trust: TrustRegion::new(trust_region::FIRST),
            queue: Queue::EMPTY,
            asked: &[],
            probed: None,
            again: false,
            inner: inner.copied().unwrap_or_default(),
            settings: *settings,
            tolerance: settings.tolerance,
            iterations: 0,
            witness_queries: WITNESS_QUERIES,
        }
    }

    /// The first direction to ask: what the memory leads to, else `start`.
    #[inline]
    pub fn recall(&mut self, memory: &Memory, start: &Vec3) -> Vec3 {
        let Some(dir) = unit(&memory.dir) else {
            return *start;
        };
        if let Smooth::Curved(r, part) = memory.smooth() {
            self.curvature.recall(r, part);
        }
        let (queue, angle) = memory.recall(&dir);
        self.queue = queue;
        match self.queue.pop() {
            Some(n) => {
                self.trust.recall(angle);
                n
            }
            None => dir,
        }
    }

    /// Goes on from what a search of exact cuts has asked: the first direction to go through.
    #[inline]
    pub fn resume(&mut self, asked: &'a [Sample], trust: Real, memory: &Memory) -> Option<Vec3> {
        let first = asked.first()?;
        if let Smooth::Curved(r, part) = memory.smooth() {
            self.curvature.recall(r, part);
        }
        self.asked = asked;
        self.trust.radius = trust;
        Some(first.n)
    }

    /// Searches from the unit vector n on.
    #[inline]
    pub fn run<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        mut n: Vec3,
        memory: &mut Memory,
    ) -> Result<Answer, Fault> {
        loop {
            let Some(new) = self.ask(md, &n)? else {
                return Ok(Answer::Miss(n));
            };
            n = match self.take(&new) {
                Some(newest) => match self.next(newest, memory) {
                    ControlFlow::Continue(n) => n,
                    ControlFlow::Break(answer) => return Ok(answer),
                },
                // A callback that errs here is asked again a little beside.
                None => {
                    self.again = true;
                    unit(&(n + perpendicular(&n) * EPSILON.sqrt())).unwrap_or(n)
                }
            };
        }
    }

    /// Learns from a sample and keeps it; returns where. `None` where it contradicts what was
    /// seen: nothing is learnt from it.
    #[inline]
    pub fn take(&mut self, new: &Sample) -> Option<usize> {
        self.iterations += 1;
        if self.iterations == TRUST_CURVATURE {
            self.curvature.give_up();
        }
        self.measure(new);
        let twin = if self.samples.len == 0 {
            self.curvature.forget_unless_fits(self.samples.size);
            None
        } else {
            self.learn(new)?
        };
        self.again = false;
        let newest = self.keep(new, twin);
        self.probed = None;
        Some(newest)
    }

    /// The direction to ask after the `newest` sample, or the answer.
    #[inline]
    pub fn next(&mut self, newest: usize, memory: &mut Memory) -> ControlFlow<Answer, Vec3> {
        if let Some(n) = self.planned() {
            return ControlFlow::Continue(n);
        }
        loop {
            let model = Model::new(&self.samples, &self.curvature);
            let step = model.minimise(newest, self.trust.radius, self.samples.rounding);
            let next = match self.judge(&model, &step) {
                Verdict::Ask(next) => Some(next),
                Verdict::End(minimum) => self.end(&model, &step, minimum, memory)?,
            };
            if let Some(next) = next {
                let n = self.turn(&model, &step, &next);
                if self.samples.len == CUTS {
                    self.make_room(newest, &model, &step);
                }
                return ControlFlow::Continue(n);
            }
            // R has led astray: on from here by exact cuts, and what the next pairs tell.
            self.curvature.known = false;
        }
    }

    /// The sample along n; `None` where it separates the objects.
    #[inline]
    fn ask<A: SupportMap, B: SupportMap>(
        &mut self,
        md: &MinkowskiDifference<A, B>,
        n: &Vec3,
    ) -> Result<Option<Sample>, Fault> {
        if let Some((first, rest)) = self.asked.split_first() {
            self.asked = rest;
            return Ok(Some(*first));
        }
        let new = Sample::new(n, md.support(n)?);
        if !(new.h < 0.0) {
            return Ok(Some(new));
        }
        Ok(match self.samples.farthest(n) {
            // D holds what was seen: no miss.
            Some(seen) if self.again || self.samples.len == 0 => Some(Sample::new(n, seen)),
            Some(_) => Some(new),
            None => None,
        })
    }

    /// The size of D, its rounding errors, and the tolerance that they allow.
    #[inline]
    fn measure(&mut self, new: &Sample) {
        let rounding = new.rounding();
        let samples = &mut self.samples;
        if rounding > samples.rounding {
            samples.rounding = rounding;
            self.tolerance = larger(rounding, self.tolerance);
        }
        let extent = (new.p.v - self.inner).norm();
        if samples.len == 0 {
            samples.size = extent;
            let asked = tolerance(self.settings.tolerance, extent, 0.0);
            self.tolerance = larger(rounding, asked);
        } else {
            samples.size = larger(extent, samples.size);
        }
    }

    /// Learns R from a sample. Returns the one that it makes a smooth pair with, and `None`
    /// where the sample is not to be kept.
    #[inline]
    fn learn(&mut self, new: &Sample) -> Option<Option<usize>> {
        let learnt = self.curvature.learn(&mut self.samples, new, self.again);
        let twin = learnt.ok()?;
        if new.h < 0.0 && !self.again {
            return None;
        }
        if let Some(twin) = twin {
            self.samples.error[twin] = self.curvature.error;
        }
        Some(twin)
    }

    /// Keeps a sample, in place of the one whose error it settles, or of its twin where that
    /// tells nothing more; returns where.
    #[inline]
    fn keep(&mut self, new: &Sample, twin: Option<usize>) -> usize {
        let samples = &mut self.samples;
        if samples.len == 0 {
            samples.set(0, new, 1.0);
            return 0;
        }
        self.trust.compare(&new.n, new.h, samples.depth());
        // A serious step moves the centre, a null step adds a cut.
        let serious = new.h < samples.depth();
        let dir = samples.dir();
        let centre = samples.centre;
        let free = |i: &usize| serious || *i != centre;
        // The same vertex within R, and farther off: it tells nothing more.
        let outdated = |i: &usize| serious || samples.n.get(*i).dot(&dir) <= new.n.dot(&dir);
        let error = twin.map_or(1.0, |_| self.curvature.error);
        let place = self.probed.filter(free);
        let place = place.or_else(|| twin.filter(free).filter(outdated));
        let newest = place.unwrap_or(samples.len);
        if serious {
            samples.centre = newest;
        }
        samples.set(newest, new, error);
        newest
    }

    /// May nothing more be asked?
    #[inline]
    fn last(&self) -> bool {
        self.iterations >= self.settings.max_iterations
    }

    /// What to ask without a model.
    #[inline]
    fn planned(&mut self) -> Option<Vec3> {
        if let Some(next) = self.asked.first() {
            if self.samples.len == CUTS {
                self.samples.evict_any();
            }
            return Some(next.n);
        }
        if self.last() {
            return None;
        }
        self.queue.pop().or_else(|| {
            let samples = &self.samples;
            let alone = samples.len == 1 && !self.curvature.known && !samples.touch();
            alone.then(|| {
                self.trust
                    .first_step(&samples.n.get(0), &samples.v.get(0), samples.size)
            })
        })
    }

    #[inline]
    fn judge(&self, model: &Model, step: &Step) -> Verdict {
        let (samples, curvature, trust) = (&self.samples, &self.curvature, &self.trust);
        judge(
            samples,
            curvature,
            model,
            step,
            trust,
            self.tolerance,
            self.last(),
        )
    }

    /// The search ends, in a `minimum` or not: a witness query, or the answer. `None` where
    /// there is neither, because R has led astray.
    fn end(
        &mut self,
        model: &Model,
        step: &Step,
        minimum: bool,
        memory: &mut Memory,
    ) -> ControlFlow<Answer, Option<Next>> {
        let (samples, curvature) = (&self.samples, &self.curvature);
        // As asked for, also where rounding allows the depth less; but no finer than is promised.
        let fine = self.tolerance.min(self.settings.tolerance);
        let fine = larger(fine, INSIDE * samples.size);
        let witnesses = Witnesses::of(samples, curvature, model, step, fine);
        // A minimum is where the support plane touches D below the origin: witness points
        // farther apart across the normal than a curve of the object's size may be within the
        // tolerance (twice the root of tolerance · size; measured: ×2 nothing, ÷2 +0.2 %) are not
        // witnesses of one.
        let size = samples.size.max(samples.depth());
        let apart2 = witnesses.apart2();
        let met = samples.touch() || minimum && apart2 <= 4.0 * self.tolerance * size;
        let enough = samples.touch() || self.last() || self.witness_queries == 0;
        if met && !enough && !witnesses.believed {
            self.witness_queries -= 1;
            return ControlFlow::Continue(Some(witnesses.query(samples, model, fine)));
        }
        // The queries are used up, or R is not known: own points, or none.
        let met = met && (samples.touch() || witnesses.believed);
        if !met && !self.last() && curvature.known {
            return ControlFlow::Continue(None);
        }
        let gradient = |i: usize| model.e1 * model.x[i] + model.e2 * model.y[i];
        let smooth = match curvature.known {
            true => Smooth::Curved(curvature.r, curvature.part()),
            false => Smooth::Unknown,
        };
        memory.keep(&model.b, &step.set.map(gradient), step.count, smooth);
        let answer = witnesses.answer(samples, model, self.iterations);
        self.samples.lead();
        ControlFlow::Break(if met {
            Answer::Hit(answer)
        } else {
            Answer::Limit(answer)
        })
    }

    /// The direction that `next` means.
    #[inline]
    fn turn(&mut self, model: &Model, step: &Step, next: &Next) -> Vec3 {
        self.trust.foretell(step.value, !step.inside, &model.b);
        let mut d = model.direction(step.x, step.y);
        if !matches!(next, Next::Minimum) {
            self.trust.no_forecast();
        }
        match next {
            Next::Minimum => (),
            Next::Beside(i, share) => {
                d += (self.samples.n.get(*i) - d) * *share;
                self.probed = Some(*i);
            }
            Next::Across => {
                let line = &self.curvature.line;
                let across = line.and_then(|line| unit(&line.cross(&model.b)));
                let across = across.unwrap_or(model.e1);
                self.curvature.spread = line.is_some();
                let slope = self.samples.v.get(self.samples.centre).dot(&across);
                d += across * ASIDE.copysign(-slope);
            }
            Next::Aside(by) => d += by,
        }
        d * (1.0 / d.norm())
    }

    /// Makes room for the next sample.
    #[inline]
    fn make_room(&mut self, newest: usize, model: &Model, step: &Step) {
        let levels = model.a + model.x * step.x + model.y * step.y;
        let samples = &mut self.samples;
        self.probed = samples.evict(newest, &step.set, &levels, &model.a, self.probed);
    }
}
