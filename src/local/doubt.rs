// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is not certain at the model's minimum, and where to ask for it.

use super::memory::Kind;
use super::search::{SAME, Search};
use super::trust_region::{ASIDE, FIRST};
use super::walk::ROOM;
use crate::known::round::TOLD;
use crate::math::{Vec3, larger, perpendicular, unit};

impl Search {
    /// Are the round parts of an active point in doubt at unit `n`?
    #[inline(always)]
    pub(super) fn is_doubtful(&self, n: &Vec3, hair: f64) -> bool {
        let unseen = |(o, k): (usize, usize)| self.objects[o % 2].is_unseen(k, n, hair);
        self.step.end.points().any(unseen)
    }

    /// What R leaves open at the best direction, whose depth is the model's least: where it was
    /// measured in one direction, across that.
    #[inline(never)]
    pub(super) fn open(&mut self, b: &Vec3) -> Option<Vec3> {
        for object in &mut self.objects {
            let curved = &mut object.curved;
            let across = curved.across(b).filter(|_| object.kind == Kind::Curved);
            if let Some(across) = across {
                curved.spread = true;
                let way = unit(&across).unwrap_or_else(|| perpendicular(b));
                let slope = self.best.p.v.dot(&way);
                let d = b + way * ASIDE.copysign(-slope);
                self.trust.no_forecast();
                return Some(d * (1.0 / d.norm()));
            }
        }
        None
    }

    /// From the model's minimum a hair towards the points of kinks that were not seen twice, so that
    /// the sample there sees them.
    #[inline(never)]
    pub(super) fn towards_unseen(&self) -> Vec3 {
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
    pub(super) fn beside(&self) -> Vec3 {
        let n = self.step.n;
        let (mut side, mut worst) = (Vec3::zeros(), -1.0);
        for (o, k) in self.step.end.points() {
            let object = &self.objects[o % 2];
            let lift = object.lift(k, &n);
            if lift > worst && object.is_unseen(k, &self.best.n, 0.0) {
                (side, worst) = (object.at[k % ROOM].n - n, lift);
            }
        }
        let size = 2.0 * worst / side.norm_squared();
        let side = side - n * n.dot(&side);
        let side = unit(&side).unwrap_or_else(|| perpendicular(&n));
        let same = self.same().round;
        // Enough, and to spare, to be told from a vertex.
        let tilt = larger(10.0 * TOLD, 8.0 * same / size);
        // Not NaN, whose tilt is none.
        let n = n + side * if tilt < FIRST { tilt } else { FIRST };
        n * (1.0 / n.norm())
    }
}
