// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is not certain at the model's minimum, and where to ask for it.

use super::object::Object;
use super::search::{HAIR, SAME, Search};
use super::trust_region::{ASIDE, FIRST};
use super::walk::{Kink, ROOM};
use crate::known::round::TOLD;
use crate::math::{Real, Vec3, larger, lesser, perpendicular, unit};

impl Search {
    /// Are the round parts of an active point in doubt at unit `n`, where the objects' own points are
    /// in these places? Also where an object's own is another one.
    #[inline(always)]
    pub(super) fn is_doubtful(&self, n: &Vec3, places: [usize; 2], hair: Real) -> bool {
        if !self.is_round() {
            return false;
        }
        let end = &self.step.end;
        let kinks = end.kinks.iter().take(end.count);
        let mut hair = hair;
        for (o, (object, place)) in self.objects.iter().zip(places).enumerate() {
            let own = |k: &Kink| k.object == o && k.point == place;
            if object.is_round() && end.active[o % 2] != place && !kinks.clone().any(own) {
                hair = 0.0;
            }
        }
        let unseen = |o: usize, k: usize| self.objects[o % 2].is_unseen(k, n, hair);
        unseen(0, end.active[0])
            || unseen(1, end.active[1])
            || kinks.clone().any(|k| unseen(k.object, k.point))
    }

    /// What R leaves open at the best direction, whose depth is the model's least: where it was
    /// measured in one direction, across that; and where the depth may fall by more than the
    /// tolerance, if R bends by its error less, at the model's minimum.
    #[inline(never)]
    pub(super) fn open(&mut self, b: &Vec3) -> Option<Vec3> {
        let curved = |object: &Object| object.curved.is_there();
        if !self.objects.iter().any(curved) {
            return None;
        }
        // So near to the best direction another point would tell nothing.
        let far = (self.step.n - b).norm_squared() > TOLD * TOLD;
        if far && !self.is_stiff() && !(self.gain_by_less() <= self.tolerance) {
            return Some(self.step.n);
        }
        if self.step.end.count == 2 {
            return None;
        }
        for object in &mut self.objects {
            if let Some(across) = object.curved.across(b) {
                object.curved.spread = true;
                let way = unit(&across).unwrap_or_else(|| perpendicular(b));
                let slope = self.best().p.v.dot(&way);
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
    pub(super) fn beside(&mut self) -> Vec3 {
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
        let mut far = Real::INFINITY;
        let mut which = (2, 0);
        for (o, k) in places.into_iter().chain(kinks) {
            let object = &self.objects[o % 2];
            let doubted = self.asked == 1 || object.is_unseen(k, &self.best().n, 0.0);
            let off = object.at[k % ROOM].n - n;
            let radius = object.radius(k, &n);
            let lift = radius * off.norm_squared();
            if object.is_round() && doubted && lift > worst {
                (side, worst, size, which) = (off, lift, radius, (o, k));
                far = off.norm();
            }
        }
        let side = side - n * n.dot(&side);
        let mut side = unit(&side).unwrap_or_else(|| perpendicular(&n));
        if which == self.doubted {
            // It showed nothing there.
            side = n.cross(&side);
        }
        self.doubted = which;
        let same = self.same().round;
        let tilt = if end.count == 0 {
            // Enough, and to spare, to be told from a vertex.
            larger(10.0 * TOLD, 8.0 * same / size)
        } else {
            larger(lesser((0.8 * hair / size).sqrt(), 0.5 * far), 10.0 * TOLD)
        };
        // Not NaN, whose tilt is none.
        let n = n + side * if tilt < FIRST { tilt } else { FIRST };
        n * (1.0 / n.norm())
    }
}
