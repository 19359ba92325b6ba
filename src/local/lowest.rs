// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the model is least: the chart, and the walks in it.
//!
//! *Discs bend the chart*: there the walk is taken again from the chart of its end, until that does
//! not move (Newton's method). R bends it too; but it is right to second order about the best
//! direction only, and so is one walk. Along its axis a disc's support function has its least value
//! and a kink, which no chart knows: where that is within the trust radius the model's exact value
//! there is compared. No vertex is known of a sample along the axis, so it ends the search, one way
//! or the other.

use super::object::Object;
use super::search::Search;
use super::walk::End;
use crate::contacts::polygon::{Flat, dot};
use crate::math::{Real, Vec3, basis, larger};

/// Charts of one walk where discs bend, …
const CHARTS: usize = 6;
/// … until what they are off by is this share of the tolerance. Insensitive: 0.03 to 0.3 tried,
/// within 1 % of the support points.
const NEWTON: Real = 0.1;
/// Where walks start beside the best direction, in trust radii: on all sides, off the axes.
const AROUND: [Flat; 4] = [[0.9, 0.1], [-0.1, 0.9], [-0.9, -0.1], [0.1, -0.9]];

impl Search {
    /// The chart of unit `b`, and the cuts in it.
    #[inline(never)]
    pub(super) fn chart(&mut self, b: &Vec3) {
        self.b = *b;
        (self.e1, self.e2) = basis(b);
        for (object, cuts) in self.objects.iter().zip(&mut self.model.cuts) {
            object.chart(b, [&self.e1, &self.e2], cuts);
        }
    }

    #[inline(always)]
    pub(super) fn direction(&self, x: &Flat) -> Vec3 {
        let d = self.b + self.e1 * x[0] + self.e2 * x[1];
        d * (1.0 / d.norm())
    }

    /// The model's minimum near the best direction.
    #[inline(never)]
    pub(super) fn lowest(&mut self) {
        let b = self.best().n;
        let radius = self.trust.radius;
        self.model.level = self.tolerance;
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
    pub(super) fn is_lowest(&self) -> bool {
        let end = &self.step.end;
        end.count < 2 || end.is_lowest(self.trust.radius)
    }

    /// Walks from the sides of the trust region: the lowest end stays.
    #[inline(never)]
    pub(super) fn look_around(&mut self) {
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
    pub(super) fn depth(&self, n: &Vec3) -> Real {
        self.objects[0].height(n).0 + self.objects[1].height(n).0 + self.rho()
    }

    #[inline(always)]
    pub(super) fn is_bent(&self) -> bool {
        let bent = |object: &Object| object.disc().is_there() || object.curved.is_there();
        self.objects.iter().any(bent)
    }

    /// The same where discs bend.
    #[inline(never)]
    pub(super) fn lowest_bent(&mut self, best: &Vec3) {
        let radius = self.trust.radius;
        let discs = self.objects.iter().any(|object| object.disc().is_there());
        for _ in 0..CHARTS {
            let end = &mut self.step.end;
            let middle = &self.middle;
            self.model.walk::<true>(&[0.0; 2], middle, radius, end);
            let x2 = dot(&end.x, &end.x);
            let x = end.x;
            let n = self.direction(&x);
            self.step.n = n;
            // A chart is off by third order in its slope, so its least value by fourth.
            if !(discs && x2 * x2 * self.extent2.sqrt() > NEWTON * self.tolerance) {
                break;
            }
            self.chart(&n);
            let along = best.dot(&n);
            self.middle = [best.dot(&self.e1) / along, best.dot(&self.e2) / along];
        }
        if !discs {
            self.step.depth = self.step.end.value + self.rho();
            return;
        }
        self.step.depth = self.depth(&self.step.n);
        self.axis(best, radius);
    }

    /// The step to the axis of a disc, where its support value is least, if it is within the
    /// trust radius, lower, and that disc alone balances the points there.
    #[inline(always)]
    pub(super) fn axis(&mut self, b: &Vec3, radius: Real) {
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

    /// May R bend by its error less, and the model be no lower than the tolerance? On one cut of each
    /// object it falls by ½ β'K⁻¹β with K = G − h I: by no more than twice as much, where the error
    /// of G is no more than half of K.
    pub(super) fn is_stiff(&self) -> bool {
        let [p, q] = &self.model.cuts;
        let [i, j] = self.step.end.active;
        let bend = self.model.bend([p.carries(i), q.carries(j)]);
        let (mean, half) = (0.5 * (bend[0] + bend[2]), 0.5 * (bend[0] - bend[2]));
        let spread = (half * half + bend[1] * bend[1]).sqrt();
        let error = larger(
            self.objects[0].curved.worst(),
            self.objects[1].curved.worst(),
        );
        let twice = 2.0 * (self.best().h - self.step.depth);
        let low = mean - spread - self.best().h;
        self.step.end.count == 0 && twice <= self.tolerance && 2.0 * error * (mean + spread) <= low
    }

    /// How much lower than the best sample the model is, metres, if R bends by its error less.
    pub(super) fn gain_by_less(&mut self) -> Real {
        for (object, cuts) in self.objects.iter().zip(&mut self.model.cuts) {
            if object.curved.is_there() {
                let left = larger(1.0 - object.curved.worst(), 0.0);
                cuts.bend = cuts.bend.map(|g| g * left);
            }
        }
        let mut end = End::NONE;
        let (middle, radius) = (&self.middle, self.trust.radius);
        self.model.walk::<true>(&[0.0; 2], middle, radius, &mut end);
        self.best().h - (end.value + self.rho())
    }
}
