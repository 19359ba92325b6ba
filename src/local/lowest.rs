// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the model is least: the chart, and the walks in it.
//!
//! *Discs bend the chart*: there the walk is taken again from the chart of its end, until that does
//! not move (Newton's method). R bends it too; but it is right to second order about the best
//! direction only, and so is one walk. Along its axis a disc's support function has its least value
//! and a kink, which no chart knows: there the rim's own points, which are a polytope's, lead on.

use super::memory::Kind;
use super::search::Search;
use super::walk::End;
use crate::contacts::polygon::{Flat, dot};
use crate::math::{Vec3, basis};

/// Charts of one walk where discs bend: Newton's method needs few. Insensitive: 3 to 12, …
const CHARTS: usize = 6;
/// … until what they are off by is this share of the tolerance. Insensitive: 0.03 to 0.3 tried,
/// within 1 % of the support points.
const NEWTON: f64 = 0.1;
/// Where walks start beside the best direction, in trust radii: on all sides, off the axes. Measured:
/// ÷2, and outside by a tenth, 21 and 30 more answers that are no global minimum.
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
        let b = self.best.n;
        let discs = self.objects.iter().any(|object| object.kind == Kind::Disc);
        self.model.level = self.tolerance;
        self.middle = [0.0; 2];
        self.chart(&b);
        for _ in 0..CHARTS {
            let end = &mut self.step.end;
            let (middle, radius) = (&self.middle, self.trust.radius);
            self.model.walk(&[0.0; 2], middle, radius, end);
            let x2 = dot(&end.x, &end.x);
            let x = end.x;
            let n = self.direction(&x);
            self.step.n = n;
            // A chart is off by third order in its slope, so its least value by fourth.
            if !(discs && x2 * x2 * self.extent2.sqrt() > NEWTON * self.tolerance) {
                break;
            }
            self.chart(&n);
            let along = b.dot(&n);
            self.middle = [b.dot(&self.e1) / along, b.dot(&self.e2) / along];
        }
        self.step.depth = if discs {
            self.depth(&self.step.n)
        } else {
            self.step.end.value + self.rho()
        };
    }

    /// Walks from the sides of the trust region: the lowest end stays.
    #[inline(never)]
    pub(super) fn look_around(&mut self) {
        let (middle, radius) = (self.middle, self.trust.radius);
        for at in AROUND {
            let from = [0, 1].map(|i| middle[i] + at[i] * radius);
            let mut end = End::default();
            self.model.walk(&from, &middle, radius, &mut end);
            let n = self.direction(&end.x);
            let depth = self.depth(&n);
            // False for NaN.
            if depth < self.step.depth - self.tolerance {
                (self.step.end, self.step.n, self.step.depth) = (end, n, depth);
            }
        }
    }

    /// The model's depth along unit `n`.
    pub(super) fn depth(&self, n: &Vec3) -> f64 {
        self.objects[0].height(n) + self.objects[1].height(n)
    }
}
