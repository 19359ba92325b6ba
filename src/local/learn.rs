// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a new point of an object shows: a vertex again, a ball, a disc, R; or that one of them is
//! not.

use super::curved::Curved;
use super::object::{Found, Object};
use super::walk::ROOM;
use crate::known::round::{ALIKE, BLUNT, Disc, Move, Pair, Same, Seen, Symmetric, TOLD, fits};
use crate::math::{EPSILON, Real, Vec3, larger};

/// Relative difference of a remembered disc's radius and that of a pair that shows it again.
/// Measured: ×2, ÷2 nothing; 1e-9 +0.1 %, +3 %.
const BALL: Real = if EPSILON > 1e-10 { 3e-5 } else { 1e-6 };
/// Relative difference of the two excesses of one object's points up to which they are taken for
/// those of another smooth surface, before a disc is confirmed; a kink's are what they like.
/// Measured: ×2 nothing, ÷3 ellipsoids beside a ball two support points more.
const OWN: Real = 0.1;

/// What a point shows with the points before.
pub enum Shown {
    /// Nothing new.
    Nothing,
    /// The vertex in that place.
    Twin(usize),
    /// A ball of this radius, metres.
    Ball(Real),
    /// A smooth surface that is no ball.
    Smooth,
    /// One of them is no support point.
    Contradiction,
}

/// What a point of a smooth surface shows.
pub enum Smooth {
    /// It is none.
    None,
    /// Maybe a disc; by another point than the pair too; and moved more aside than along.
    Disc(Found, bool, bool),
    /// No disc; the point that it makes a smooth pair with.
    Other(usize),
}

impl Object {
    /// Notes that the point seen along `n`, if it is kept, is of one piece with the new one.
    pub fn note_piece(&mut self, n: &Vec3) {
        let kept = (0..self.len.min(ROOM)).find(|&k| self.at[k].n == *n);
        self.pieces |= kept.map_or(0, |k| 1 << k);
    }

    /// What a new point shows with those before.
    #[inline(never)]
    pub fn learn(&mut self, best: &mut usize, new: &Seen, same: &Same) -> Shown {
        if self.curved.is_there() {
            return self.learn_curved(best, new, same);
        }
        if self.is_round() {
            return Shown::Nothing;
        }
        if let Some(k) = self.twin(&new.p, false, same.rounding) {
            return Shown::Twin(k);
        }
        let others = if self.flat {
            *best..*best + 1
        } else {
            0..self.len
        };
        let mut smooth = false;
        for k in others {
            match Pair::of(&self.at[k % ROOM], new, same) {
                Pair::Ball(radius) => return Shown::Ball(radius),
                Pair::Smooth => smooth = true,
                _ => (),
            }
        }
        if smooth {
            Shown::Smooth
        } else {
            Shown::Nothing
        }
    }

    /// What a new point of a curved object shows with those before: its R, and the point of the same
    /// piece nearest to it.
    #[inline(never)]
    pub(super) fn learn_curved(&mut self, best: &mut usize, new: &Seen, same: &Same) -> Shown {
        let rounding = same.rounding;
        let mut twin = ROOM;
        let mut nearest = Real::INFINITY;
        let mut vertex = false;
        let mut room = Real::INFINITY;
        for k in 0..self.len.min(ROOM) {
            let old = &self.at[k];
            let by = Move::of(old, new);
            // Also NaN.
            let [ahead, behind] = by.excess();
            if !(ahead >= -rounding && behind >= -rounding) {
                return Shown::Contradiction;
            }
            let repeated = by.d2 <= 4.0 * rounding * rounding;
            let one_piece = if by.dn2 > TOLD * TOLD {
                by.is_smooth(same, self.alike())
                    || self.pieces >> k & 1 != 0
                    || self.curved.foretells(&by.d, &by.dn)
            } else {
                by.d2 <= BLUNT * BLUNT * same.extent2 * by.dn2
            };
            if repeated || one_piece {
                if by.dn2 < nearest {
                    (twin, nearest, vertex) = (k, by.dn2, repeated);
                }
            } else if k == *best {
                room = 2.0 * ahead.min(behind);
            }
        }
        if room < Real::INFINITY {
            self.curved
                .refute(&(new.n - self.at[*best % ROOM].n), larger(room, 0.0));
        }
        let k = twin;
        if k < ROOM && nearest > TOLD * TOLD {
            if vertex {
                self.flat = true;
                self.curved.doubt();
                self.carried &= !(1 << k);
            } else {
                let old = &self.at[k % ROOM];
                self.curved.learn(&(new.p - old.p), &(new.n - old.n));
                self.carried |= 1 << k;
            }
            self.seen |= 1 << k;
            self.span[k % ROOM] = larger(nearest, self.span[k % ROOM]);
        }
        self.note();
        if twin < ROOM {
            Shown::Twin(twin)
        } else {
            Shown::Nothing
        }
    }

    /// What is smooth and no disc: R, by the point in that place and a new one.
    #[cold]
    pub fn curve(&mut self, k: usize, new: &Seen) {
        let old = &self.at[k % ROOM];
        self.curved.learn(&(new.p - old.p), &(new.n - old.n));
        self.carried |= 1 << k;
        self.pieces |= 1 << k;
        self.note();
    }

    /// Looks for a disc that a new point shows with those before. Of others than the `best` one only
    /// what a third point confirms: corners far from each other look smooth by chance.
    #[inline(never)]
    pub fn learn_disc(&self, best: usize, new: &Seen, same: &Same) -> Smooth {
        if self.is_round() {
            return Smooth::None;
        }
        let others = if self.flat {
            best..best + 1
        } else {
            0..self.len
        };
        for k in others {
            match self.disc_of(k, best, new, same) {
                Smooth::None => (),
                Smooth::Other(_) | Smooth::Disc(_, false, _) if k != best => (),
                shown => return shown,
            }
        }
        Smooth::None
    }

    pub(super) fn disc_of(&self, k: usize, best: usize, new: &Seen, same: &Same) -> Smooth {
        let old = &self.at[k % ROOM];
        let by = Move::of(old, new);
        let one = k == best && self.pieces >> k & 1 != 0;
        if !(one || by.is_smooth(same, self.alike())) {
            return Smooth::None;
        }
        let Some(disc) = Disc::of(old, new).filter(|disc| fits(disc.radius, same.extent2)) else {
            return Smooth::Other(k);
        };
        let found = Found::of(disc, old, new);
        let third = |at: &Seen| found.is_shown_by(at);
        let confirmed = self.at.iter().take(self.len).any(third);
        Smooth::Disc(found, confirmed, 2.0 * by.along * by.along < by.d2 * by.dn2)
    }

    /// Turns a remembered disc to where two points show it.
    #[inline(never)]
    pub fn turn(&mut self, k: usize, new: &Seen, same: &Same, asked: usize) -> usize {
        let disc = *self.disc();
        if !disc.is_there() || self.found_at > 0 || self.confirmed {
            return k;
        }
        let old = self.at[k % ROOM];
        let d = new.p - old.p;
        let moved = disc.point(&new.n) - disc.point(&old.n);
        if (d - moved).norm_squared() <= same.round * same.round {
            return k;
        }
        let anew = Disc::of(&old, new)
            .filter(|anew| (anew.radius - disc.radius).abs() <= BALL * disc.radius);
        if let Some(disc) = anew.or_else(|| disc.turned(&old, new, same.round)) {
            let found = Found::of(disc, &old, new);
            return self.take_disc((&found, anew.is_some()), asked, k, same);
        }
        k
    }

    /// Does a new point agree with the disc? Notes which vertices it shows again from another
    /// direction: not before the disc is confirmed.
    #[inline(never)]
    pub(super) fn agrees(
        &mut self,
        new: &Seen,
        core: &Vec3,
        carries: bool,
        same: Real,
        asked: usize,
    ) -> bool {
        let len = self.len.min(ROOM);
        let disc = *self.disc();
        let least = larger(TOLD * TOLD * disc.radius * disc.radius, 16.0 * same * same);
        let height = |carries: bool, n: &Vec3| {
            if carries {
                disc.radius * disc.across(n).norm()
            } else {
                0.0
            }
        };
        let (value, here) = (new.p.dot(&new.n), height(true, &new.n));
        let at = disc.point(&new.n);
        let (mut shown, mut again): (u32, bool) = (0, false);
        let mut refuted = false;
        for k in 0..len {
            let (old, old_core) = (self.at[k], self.core(k));
            let old_carries = self.carries(k);
            let ahead = value - old_core.dot(&new.n) - if old_carries { here } else { 0.0 };
            let behind = (old.p - core).dot(&old.n) - height(carries, &old.n);
            // A cut above a support value.
            if !(ahead >= -same && behind >= -same) {
                return false;
            }
            let d = new.p - old.p;
            if self.is_doubted() && !carries {
                let (e, f) = (d.dot(&new.n), -d.dot(&old.n));
                refuted |= (e - f).abs() <= OWN * (e + f);
            }
            if !old_carries || !carries {
                continue;
            }
            let moved = at - (old.p - old_core);
            let off2 = (d - moved).norm_squared();
            if moved.norm_squared() > least && off2 <= same * same {
                shown |= 1 << k;
                // A remembered one, whose axis has not turned.
                let turned = (new.n - old.n).norm_squared();
                again |= off2 <= ALIKE * ALIKE * turned * moved.norm_squared();
            }
        }
        if refuted {
            return false;
        }
        let mut pair = 0;
        self.confirmed |= self.found_at == 0 && again;
        if self.is_doubted() && self.found_at != asked && self.found.is_shown_by(new) {
            self.confirmed = true;
            // The pair's vertex was seen twice.
            for k in (0..len).filter(|k| self.carries(*k)) {
                let apart = disc.across(&(self.core(k) - self.found.carrier));
                pair |= u32::from(apart.norm_squared() <= same * same) << k;
            }
        }
        if !self.confirmed {
            return true;
        }
        self.seen |= shown | pair;
        let [a, b] = self.found.pair;
        for k in 0..len {
            if shown >> k & 1 != 0 {
                self.span[k] = larger((new.n - self.at[k].n).norm_squared(), self.span[k]);
            }
            if pair >> k & 1 != 0 {
                self.span[k] = larger((a - b).norm_squared(), self.span[k]);
            }
        }
        true
    }

    /// The point whose vertex in the ball is a new one's, which was seen again then. `None`: the new
    /// one lies beyond a cut, or another beyond its.
    #[inline(always)]
    pub(super) fn among(&mut self, new: &Seen, core: &Vec3, same: Real) -> Option<Option<usize>> {
        for k in 0..self.len.min(ROOM) {
            let e = core - self.core(k);
            if e.norm_squared() <= same * same {
                let turned = (new.n - self.at[k].n).norm_squared();
                let moved2 = self.radius * self.radius * turned;
                if turned > TOLD * TOLD && moved2 > 16.0 * same * same {
                    self.seen |= 1 << k;
                    self.span[k] = larger(turned, self.span[k]);
                }
                return Some(Some(k));
            }
            // Also NaN.
            if !(e.dot(&new.n) >= -same && e.dot(&self.at[k].n) <= same) {
                return None;
            }
        }
        Some(None)
    }

    /// A ball or disc that was refuted is no more than a curvature.
    #[cold]
    pub fn unround(&mut self) {
        let (radius, disc, [a, b]) = (self.radius, *self.disc(), self.found.pair);
        let (carried, found) = (self.seen, disc.is_there() && self.found_at > 0);
        self.forget();
        if radius > 0.0 {
            self.curved = Curved::recall(Symmetric::scaled_identity(radius));
        } else if found {
            self.curved
                .learn(&(disc.point(&b) - disc.point(&a)), &(b - a));
        }
        // The points that were seen to be of it bend.
        self.carried = carried;
        self.note();
    }

    /// Nothing of it is round, but the points as they were seen are its.
    #[cold]
    pub fn forget(&mut self) {
        (self.radius, self.found, self.confirmed) = (0.0, Found::NONE, false);
        (self.curved, self.carried, self.seen) = (Curved::NONE, 0, 0);
        for k in 0..self.len.min(ROOM) {
            let p = self.at[k].p;
            self.set(k, &p, false);
        }
        self.note();
    }

    /// Takes a new point, the vertex in place `twin` if known; returns its place. `best`: the best
    /// direction. `kept`: the place that must stay. `None`: it contradicts what is known.
    #[inline(never)]
    pub fn take(
        &mut self,
        new: &Seen,
        mut twin: Option<usize>,
        best: &Vec3,
        kept: &mut usize,
        same: &Same,
        asked: usize,
    ) -> Option<usize> {
        let (mut core, mut carries) = (new.p, false);
        if self.is_round() && !self.curved.is_there() {
            let near = same.round;
            (core, carries) = self.vertex(new, near);
            let agreed = if !self.disc().is_there() {
                self.among(new, &core, near)
            } else if self.agrees(new, &core, carries, near, asked) {
                Some(self.twin(&core, carries, near))
            } else {
                None
            };
            match agreed {
                Some(known) => twin = known,
                None => {
                    self.unround();
                    core = new.p;
                    twin = match self.learn_curved(kept, new, same) {
                        Shown::Contradiction => return None,
                        Shown::Twin(k) => Some(k),
                        _ => None,
                    };
                }
            }
        }
        let curved = self.curved.is_there();
        if curved {
            // The first one is as R is remembered.
            let k = twin.unwrap_or(ROOM);
            carries = if k < ROOM {
                self.carries(k)
            } else {
                self.pieces != 0 || self.len == 0
            };
        }
        if let Some(place) = twin {
            // Each point by the direction nearest to the best one.
            let old = &mut self.at[place % ROOM];
            let nearer = old.n.dot(best) < new.n.dot(best);
            self.flat |= !curved && (new.n - old.n).norm_squared() > TOLD * TOLD;
            if nearer {
                *old = *new;
                self.set(place, &core, carries);
            }
            return Some(place);
        }
        let mut place = self.len;
        if place >= ROOM {
            place = self.lowest(best, *kept);
        } else {
            self.len += 1;
        }
        self.at[place % ROOM] = *new;
        self.set(place, &core, carries);
        self.seen &= !(1 << place);
        Some(place)
    }
}
