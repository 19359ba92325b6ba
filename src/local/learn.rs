// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a new point of an object shows: a vertex again, a ball, a disc, R; or that one of them is
//! not.

use super::curved::Curved;
use super::memory::Kind;
use super::object::{Found, Object, Told};
use super::walk::ROOM;
use crate::known::round::{ALIKE, BLUNT, Disc, Move, Same, Seen, Symmetric, TOLD, fits};
use crate::math::{Vec3, larger};

/// Relative difference of the two excesses of one object's points up to which they are taken for
/// those of another smooth surface, before a disc is confirmed; a kink's are what they like.
/// Measured: ×2 nothing, ÷3 ellipsoids beside a ball two support points more.
const OWN: f64 = 0.1;

/// What a point shows with the points before.
pub enum Shown {
    /// Nothing new.
    Nothing,
    /// The vertex in that place.
    Twin(usize),
    /// A ball of this radius, metres.
    Ball(f64),
    /// A smooth surface that is no ball.
    Smooth,
}

/// What a point of a smooth surface shows.
pub struct Smooth {
    /// The point that it makes a smooth pair with.
    pub with: usize,
    /// Maybe a disc, …
    pub found: Option<Found>,
    /// … by what, …
    pub told: Told,
    /// … and moved more aside than along.
    pub aside: bool,
}

impl Object {
    /// Notes that the point seen along `n`, if it is kept, is of one piece with the new one.
    pub fn note_piece(&mut self, n: &Vec3) {
        let kept = (0..self.len.min(ROOM)).find(|&k| self.at[k].n == *n);
        self.pieces |= kept.map_or(0, |k| 1 << k);
    }

    /// What a new point shows with those before.
    #[inline(never)]
    pub fn learn(&mut self, best: usize, new: &Seen, same: &Same) -> Shown {
        if self.kind == Kind::Curved {
            let twin = self.learn_curved(best, new, same);
            return twin.map_or(Shown::Nothing, Shown::Twin);
        }
        if self.kind == Kind::Disc && self.told == Told::Before {
            let core = |at: &Seen| at.p - self.disc().point(&at.n);
            let apart = self
                .disc()
                .across(&(core(new) - core(&self.at[best % ROOM])));
            if apart.norm_squared() > same.round * same.round {
                // The axis has turned with the object: its points are to show it.
                self.forget();
            }
        }
        if self.is_round() {
            return Shown::Nothing;
        }
        if let Some(k) = self.twin(&new.p, false, same.rounding) {
            return Shown::Twin(k);
        }
        let mut shown = Shown::Nothing;
        for k in 0..self.len {
            let by = Move::of(&self.at[k % ROOM], new);
            if let Some(radius) = by.ball(same) {
                return Shown::Ball(radius);
            }
            if by.is_smooth(same, ALIKE) {
                shown = Shown::Smooth;
            }
        }
        shown
    }

    /// What a new point of a curved object shows with those before: its R, and the point of the same
    /// piece nearest to it.
    #[inline(never)]
    fn learn_curved(&mut self, best: usize, new: &Seen, same: &Same) -> Option<usize> {
        let rounding = same.rounding;
        let mut twin = ROOM;
        let mut nearest = f64::INFINITY;
        let mut vertex = false;
        let mut room = f64::INFINITY;
        for k in 0..self.len.min(ROOM) {
            let old = &self.at[k];
            let by = Move::of(old, new);
            let [ahead, behind] = by.excess();
            let repeated = by.d2 <= 4.0 * rounding * rounding;
            let one_piece = if by.dn2 > TOLD * TOLD {
                by.is_smooth(same, self.alike()) || self.pieces >> k & 1 != 0
            } else {
                by.d2 <= BLUNT * BLUNT * same.extent2 * by.dn2
            };
            if repeated || one_piece {
                if by.dn2 < nearest {
                    (twin, nearest, vertex) = (k, by.dn2, repeated);
                }
            } else if k == best {
                room = 2.0 * ahead.min(behind);
            }
        }
        if room < f64::INFINITY {
            let dn = new.n - self.at[best % ROOM].n;
            let believed = self.curved.refute(&dn, larger(room, 0.0));
            self.believe(believed);
        }
        let k = twin;
        if k < ROOM && nearest > TOLD * TOLD {
            if vertex {
                // What no second pair confirmed ends.
                self.flat = true;
                self.believe(self.curved.is_believed());
                self.carried &= !(1 << k);
            } else {
                self.curve(k, new);
            }
            self.see(k, nearest);
        }
        (twin < ROOM).then_some(twin)
    }

    /// R ends, unless it is believed.
    fn believe(&mut self, believed: bool) {
        if self.kind == Kind::Curved && !believed {
            self.kind = Kind::None;
        }
    }

    /// What is smooth and no disc: R, by the point in that place and a new one.
    #[cold]
    pub fn curve(&mut self, k: usize, new: &Seen) {
        let old = &self.at[k % ROOM];
        let (d, dn) = (new.p - old.p, new.n - old.n);
        if self.kind == Kind::Curved {
            self.curved.learn(&d, &dn);
        } else {
            (self.kind, self.curved) = (Kind::Curved, Curved::first(&d, &dn));
        }
        self.carried |= 1 << k;
        self.pieces |= 1 << k;
    }

    /// Looks for a disc that a new point shows with those before. Of others than the `best` one only
    /// what a third point confirms: corners far from each other look smooth by chance.
    #[inline(never)]
    pub fn learn_disc(&self, best: usize, new: &Seen, same: &Same) -> Option<Smooth> {
        if self.is_round() {
            return None;
        }
        for k in 0..self.len {
            let old = &self.at[k % ROOM];
            let by = Move::of(old, new);
            let one = k == best && self.pieces >> k & 1 != 0;
            if !(one || by.is_smooth(same, self.alike())) {
                continue;
            }
            let disc = Disc::of(old, new).filter(|disc| fits(disc.radius, same.extent2));
            let found = disc.map(|disc| Found::of(disc, old, new));
            let mut points = self.at.iter().take(self.len);
            let confirmed = found.is_some_and(|found| points.any(|at| found.is_shown_by(at)));
            if k == best || confirmed {
                let aside = 2.0 * by.along * by.along < by.d2 * by.dn2;
                let told = if confirmed { Told::More } else { Told::Pair };
                return Some(Smooth {
                    with: k,
                    found,
                    told,
                    aside,
                });
            }
        }
        None
    }

    /// The point whose vertex is a new one's. Notes which were seen again from another direction: not
    /// before the disc is confirmed. `None`: the new one lies beyond a cut, or another beyond its.
    #[inline(always)]
    fn agrees(
        &mut self,
        new: &Seen,
        core: &Vec3,
        carries: bool,
        same: f64,
    ) -> Option<Option<usize>> {
        let len = self.len.min(ROOM);
        let (disc, doubted) = (self.found.disc, self.is_doubted());
        let least = larger(TOLD * TOLD * disc.radius * disc.radius, 16.0 * same * same);
        let height = |n: &Vec3| disc.radius * disc.across(n).norm();
        let (mut twin, mut turned, mut refuted) = (None, 0.0, false);
        for k in 0..len {
            let old = self.at[k];
            let e = core - self.core(k);
            let differ = carries != self.carries(k);
            if !differ && e.norm_squared() <= same * same {
                let moved2 = (new.p - old.p - e).norm_squared();
                twin = Some(k);
                if carries && moved2 > least {
                    turned = (new.n - old.n).norm_squared();
                    // A remembered one, whose axis has not turned.
                    if self.told == Told::Before
                        && e.norm_squared() <= ALIKE * ALIKE * turned * moved2
                    {
                        (self.found, self.told) = (Found::of(disc, &old, new), Told::More);
                    }
                }
                continue;
            }
            let (mut ahead, mut behind) = (e.dot(&new.n), -e.dot(&old.n));
            if differ {
                let sign = if carries { 1.0 } else { -1.0 };
                ahead += sign * height(&new.n);
                behind -= sign * height(&old.n);
            }
            // A cut above a support value; also NaN.
            if !(ahead >= -same && behind >= -same) {
                return None;
            }
            if doubted && !carries {
                let d = new.p - old.p;
                let (e, f) = (d.dot(&new.n), -d.dot(&old.n));
                refuted |= (e - f).abs() <= OWN * (e + f);
            }
        }
        if refuted {
            return None;
        }
        if doubted && self.found.is_shown_by(new) {
            self.told = Told::More;
            // The pair's vertex was seen twice.
            let [a, b] = self.found.pair;
            for k in 0..len {
                let apart = disc.across(&(self.core(k) - self.found.carrier));
                if self.carries(k) && apart.norm_squared() <= same * same {
                    self.see(k, (a - b).norm_squared());
                }
            }
        }
        if let (Some(k), true) = (twin, self.told == Told::More) {
            self.see(k, turned);
        }
        Some(twin)
    }

    /// A ball or disc that was refuted is no more than a curvature; a remembered disc, or R, nothing.
    #[cold]
    pub fn unround(&mut self) {
        let (kind, told, span) = (self.kind, self.told, self.span);
        let (disc, [a, b]) = (*self.disc(), self.found.pair);
        self.forget();
        self.curved = match kind {
            Kind::Ball => Curved::recall(Symmetric::scaled_identity(disc.radius)),
            Kind::Disc if told != Told::Before => {
                Curved::first(&(disc.point(&b) - disc.point(&a)), &(b - a))
            }
            _ => return,
        };
        self.kind = Kind::Curved;
        // The points that were seen to be of it bend.
        let bend = (0..ROOM).filter(|k| span[*k] > 0.0);
        self.carried = bend.fold(0, |bits, k| bits | 1 << k);
    }

    /// Nothing of it is round, but the points as they were seen are its.
    #[cold]
    pub fn forget(&mut self) {
        let (at, len, flat, pieces) = (self.at, self.len, self.flat, self.pieces);
        *self = Self {
            at,
            len,
            flat,
            pieces,
            ..Self::default()
        };
        for (k, seen) in at.iter().enumerate().take(len) {
            self.set(k, &seen.p, false);
        }
    }

    /// Takes a new point, the vertex in place `twin` if known; returns its place. `best`: the best
    /// direction. `kept`: the place that must stay.
    #[inline(never)]
    pub fn take(
        &mut self,
        new: &Seen,
        mut twin: Option<usize>,
        best: &Vec3,
        kept: usize,
        same: &Same,
    ) -> usize {
        let (mut core, mut carries) = (new.p, false);
        if self.is_cored() {
            (core, carries) = self.vertex(new, same.round);
            if let Some(known) = self.agrees(new, &core, carries, same.round) {
                twin = known;
            } else {
                let aside = core - self.core(kept);
                self.unround();
                (core, carries) = (new.p, false);
                twin = self.learn_curved(kept, new, same);
                self.curved.end(&new.n, &aside);
            }
        }
        let curved = self.kind == Kind::Curved;
        if curved {
            // The first one is as R is remembered.
            carries = match twin {
                Some(k) => self.carries(k),
                None => self.pieces != 0 || self.len == 0,
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
            return place;
        }
        let mut place = self.len;
        if place >= ROOM {
            place = self.lowest(best, kept);
        } else {
            self.len += 1;
        }
        self.at[place % ROOM] = *new;
        self.set(place, &core, carries);
        self.span[place % ROOM] = 0.0;
        place
    }
}
