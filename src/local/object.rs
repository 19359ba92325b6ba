// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a search knows of one object: its points, and the ball, the disc or R that is taken off
//! them.
//!
//! With the ball of radius ρ, or the disc of radius r, of a support point p along n (`known/round.rs`)
//! c = p − ρ n, or c = p − r m(n), is a vertex of what is left, and its cut is exact: the support
//! value along unit d is at least c·d + ρ, or c·d + r |d⊥|. The only doubt is whether a ball or a
//! disc is round where it was not seen.
//!
//! *Balls* are told by two points, p′ − p = r (n′ − n), exactly parallel. *A ball is part of a piece
//! only*: the hull of a ball and a tip is a ball on one side. So an answer stands on vertices that
//! were seen along two directions, which no other point than one of the ball can bring about; or so
//! near to the minimum that the cut is right without the ball.
//!
//! *Discs* likewise; but any two points of a smooth object could be a disc's, so a third one must
//! confirm it. A vertex carries the disc if it is above or below the one that did where the disc was
//! found: a cone's tip has a cut without it. A *remembered* disc ends where its axis has turned with the
//! object: its points show it anew ([`Disc::of`]).
//!
//! *R* bends the cuts of the points that were seen to be of a smooth piece. It leads to no witness
//! point: what it is right about to second order lies beside the object to third.

use super::curved::Curved;
use super::memory::{Kind, Round};
use super::walk::{Cuts, ROOM, Row, each};
use crate::known::round::{ALIKE, Disc, Seen, Symmetric, fits};
use crate::math::{Vec3, ZERO, larger};

/// How many times as far from where it was seen as the directions are apart that showed it what is
/// round is believed: the body may be cut off beyond. Measured: 1 +1.1 %, +8 % (cylinders); 2 −0.1 %,
/// and half a disc is taken for a disc half a radian beyond its end.
const FAR: f64 = 1.4;
/// How much more alike the excesses of a smooth pair must be once a vertex was seen twice (a
/// polytope, it seems). Measured: ×2, ÷2 nothing; 1 +0.1 %, +1.5 %.
const FLAT: f64 = 0.05;

/// A ball, which is a disc of no axis, or a disc, and how it was found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub disc: Disc,
    /// The directions of the pair.
    pub(super) pair: [Vec3; 2],
    /// The vertex that carries it there.
    pub(super) carrier: Vec3,
}

impl Found {
    /// A ball, by its radius.
    pub(super) const fn ball(radius: f64) -> Self {
        Self {
            disc: Disc { radius, axis: ZERO },
            ..Self::NONE
        }
    }

    pub(super) const NONE: Self = Self {
        disc: Disc::NONE,
        pair: [ZERO; 2],
        carrier: ZERO,
    };

    pub(super) fn of(disc: Disc, old: &Seen, new: &Seen) -> Self {
        Self {
            disc,
            pair: [old.n, new.n],
            carrier: new.p - disc.point(&new.n),
        }
    }

    /// Does this point carry it, too? Of another smooth surface it would be off by a third order of
    /// the angles between the three directions.
    pub(super) fn is_shown_by(&self, at: &Seen) -> bool {
        let [a, b] = self.pair;
        let order = (at.n - a).norm() * (at.n - b).norm() * (a - b).norm();
        // Above or below is as good: a cylinder's other end.
        let apart = at.p - self.disc.point(&at.n) - self.carrier;
        let apart = self.disc.across(&apart).norm();
        order > 0.0 && apart <= ALIKE * self.disc.radius * order
    }
}

/// What a ball or disc was told by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// The query before: all points carry it.
    Before,
    /// A pair.
    Pair,
    /// More than that, as a ball always is.
    More,
}

/// One object's points, obj1's or those of −obj2.
pub struct Object {
    /// Support points, each where it was seen nearest to the best direction.
    pub at: [Seen; ROOM],
    /// The same without the ball or disc.
    pub(super) core: [Row; 3],
    pub len: usize,
    /// How far apart, squared, the directions are that showed a point's vertex twice; 0 for none.
    pub(super) span: Row,
    /// What is round of it.
    pub kind: Kind,
    /// The ball or disc, …
    pub(super) found: Found,
    /// … and what told it.
    pub(super) told: Told,
    /// The points that carry it, as bits; else those that R bends.
    pub(super) carried: u32,
    /// R of what is neither.
    pub curved: Curved,
    /// The points that make a smooth pair with the new one, as bits: as those of D do.
    pub pieces: u32,
    /// A vertex was seen twice: a polytope, it seems.
    pub(super) flat: bool,
}

impl Default for Object {
    /// Nothing: of a constant it is zeroed in its place, not copied there.
    #[inline(always)]
    fn default() -> Self {
        const NONE: Object = Object {
            at: [Seen::NONE; ROOM],
            core: [[0.0; ROOM]; 3],
            len: 0,
            span: [0.0; ROOM],
            kind: Kind::None,
            found: Found::NONE,
            told: Told::Before,
            carried: 0,
            curved: Curved::NONE,
            pieces: 0,
            flat: false,
        };
        NONE
    }
}

impl Object {
    /// What was round of it in the query before, if that makes sense.
    pub fn recall(&mut self, (kind, numbers): &Round) {
        let [x, y, z, ..] = *numbers;
        let size: f64 = numbers.iter().map(|number| number.abs()).sum();
        // Also NaN.
        if !(size > 0.0 && size < f64::INFINITY) {
            return;
        }
        self.kind = *kind;
        match kind {
            Kind::None => (),
            Kind::Ball => (self.found, self.told) = (Found::ball(size), Told::More),
            Kind::Disc => {
                let axis = Vec3::new(x, y, z);
                self.found = Found::ball(axis.norm());
                self.found.disc.axis = axis * (1.0 / axis.norm());
            }
            Kind::Curved => {
                (self.curved, self.carried) = (Curved::recall(Symmetric(*numbers)), !0);
            }
        }
    }

    /// What is round of it for the next query, of an answer along unit `n`. Along a disc's axis its
    /// points are those of a polytope.
    #[inline(always)]
    pub fn round(&self, n: &Vec3) -> Round {
        let disc = &self.found.disc;
        let small = |v: Vec3| [v.x, v.y, v.z, 0.0, 0.0, 0.0];
        match self.kind {
            Kind::Ball => (self.kind, small(Vec3::x() * disc.radius)),
            Kind::Disc if !disc.is_along(n) => (self.kind, small(disc.axis * disc.radius)),
            Kind::Curved => (self.kind, self.curved.r().0),
            _ => (Kind::None, [0.0; 6]),
        }
    }

    /// How alike the excesses of a smooth pair must be.
    #[inline(always)]
    pub(super) fn alike(&self) -> f64 {
        if self.flat { ALIKE * FLAT } else { ALIKE }
    }

    #[inline(always)]
    pub fn disc(&self) -> &Disc {
        &self.found.disc
    }

    #[inline(always)]
    pub fn is_round(&self) -> bool {
        self.kind != Kind::None
    }

    /// The radius of its ball, metres.
    #[inline(always)]
    pub fn ball(&self) -> f64 {
        if self.kind == Kind::Ball {
            self.disc().radius
        } else {
            0.0
        }
    }

    /// Has it a ball or a disc, whose cuts are exact?
    #[inline(always)]
    pub fn is_cored(&self) -> bool {
        matches!(self.kind, Kind::Ball | Kind::Disc)
    }

    /// Is its round part exact, or has it none, as a vertex showed that was seen twice?
    #[inline(always)]
    pub fn is_exact(&self) -> bool {
        self.flat || self.is_cored()
    }

    /// Is its disc no more than a pair's?
    #[inline(always)]
    pub fn is_doubted(&self) -> bool {
        self.kind == Kind::Disc && self.told == Told::Pair
    }

    /// A round part larger than the object was another's; one of no more than `least`, metres, is none.
    pub fn forget_unless_fits(&mut self, extent2: f64, least: f64) {
        let size = larger(self.curved.size(), self.disc().radius);
        if self.is_round() && !(fits(size, extent2) && size > least) {
            *self = Self::default();
        }
    }

    #[inline(always)]
    pub fn core(&self, k: usize) -> Vec3 {
        Vec3::from(self.core.each_ref().map(|row| row[k % ROOM]))
    }

    #[inline(always)]
    pub(super) fn carries(&self, k: usize) -> bool {
        self.carried >> k & 1 != 0
    }

    /// The vertex of a point, and whether it carries the ball or disc.
    #[inline(always)]
    pub(super) fn vertex(&self, at: &Seen, same: f64) -> (Vec3, bool) {
        let core = at.p - self.disc().point(&at.n);
        let aside = || self.disc().across(&(core - self.found.carrier));
        let carries = self.kind == Kind::Ball
            || self.told == Told::Before
            || aside().norm_squared() <= same * same;
        (if carries { core } else { at.p }, carries)
    }

    /// Takes a ball or disc off all points. Returns where the `best` one is now: of points that are
    /// one vertex now the best stays, and else the latest.
    #[inline(never)]
    pub fn take_off(&mut self, (found, told): (&Found, Told), best: usize, same: f64) -> usize {
        (self.found, self.told) = (*found, told);
        let ball = found.disc.axis == ZERO;
        self.kind = if ball { Kind::Ball } else { Kind::Disc };
        self.flat = false;
        let mut place = best;
        let len = self.len.min(ROOM);
        self.len = 0;
        for k in 0..len {
            let at = self.at[k];
            let (core, carries) = self.vertex(&at, same);
            let twin = self.twin(&core, carries, same);
            let to = twin.unwrap_or(self.len);
            if k == best {
                place = to;
            }
            if twin.is_none() {
                self.len += 1;
                self.span[to % ROOM] = 0.0;
            } else if carries && told == Told::More {
                self.see(to, (at.n - self.at[to % ROOM].n).norm_squared());
                if place == to && k > best {
                    continue;
                }
            }
            self.at[to % ROOM] = at;
            self.set(to, &core, carries);
        }
        place
    }

    /// The vertex in that place was seen along directions that are so far apart, squared.
    #[inline(always)]
    pub(super) fn see(&mut self, k: usize, apart2: f64) {
        self.span[k % ROOM] = larger(apart2, self.span[k % ROOM]);
    }

    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, core: &Vec3, carries: bool) {
        let k = k % ROOM;
        for (row, x) in self.core.iter_mut().zip(core.iter()) {
            row[k] = *x;
        }
        self.carried = self.carried & !(1 << k) | u32::from(carries) << k;
    }

    /// The point that is the same vertex as this one.
    #[inline(always)]
    pub(super) fn twin(&self, core: &Vec3, carries: bool, same: f64) -> Option<usize> {
        (0..self.len.min(ROOM)).find(|&k| {
            let apart = core - self.core(k);
            apart.norm_squared() <= same * same && carries == self.carries(k)
        })
    }

    /// The lowest point along `b` that is not to be kept.
    #[cold]
    pub(super) fn lowest(&self, b: &Vec3, kept: usize) -> usize {
        let level = |k: &usize| self.core(*k).dot(b);
        let others = (0..ROOM).filter(|k| *k != kept);
        let least = others.reduce(|i, k| if level(&k) < level(&i) { k } else { i });
        least.unwrap_or(0)
    }

    /// The cuts in the chart of unit `b`.
    #[inline(always)]
    pub fn chart(&self, b: &Vec3, [e1, e2]: [&Vec3; 2], cuts: &mut Cuts) {
        let [px, py, pz] = &self.core;
        each(self.len, |k| {
            let [x, y, z] = [px[k], py[k], pz[k]];
            cuts.a[k] = x * b.x + y * b.y + z * b.z;
            cuts.x[k] = x * e1.x + y * e1.y + z * e1.z;
            cuts.y[k] = x * e2.x + y * e2.y + z * e2.z;
        });
        (cuts.len, cuts.carried, cuts.bend) = (self.len, 0, [0.0; 3]);
        match self.kind {
            Kind::Disc => self.carry(b, [e1, e2], cuts),
            Kind::Curved => self.bend(b, [e1, e2], cuts),
            _ => (),
        }
    }

    /// The same of R: with y where a point's direction is in the chart, and G = E'R E, its cut is
    /// α + ½ y'Gy + (β − G y)·x + ½ x'Gx. No cut is above the object's value at b.
    #[inline(never)]
    fn bend(&self, b: &Vec3, [e1, e2]: [&Vec3; 2], cuts: &mut Cuts) {
        let (rho, axx, axy) = self.curved.r().within(e1, e2);
        let g = [rho + axx, axy, rho - axx];
        (cuts.bend, cuts.carried) = (g, self.carried);
        if !self.curved.is_believed() {
            return;
        }
        let len = self.len.min(ROOM);
        let top = cuts.a.iter().take(len).copied().fold(cuts.a[0], larger);
        for k in (0..len).filter(|k| self.carries(*k)) {
            let n = &self.at[k].n;
            let along = n.dot(b);
            let y = [e1.dot(n) / along, e2.dot(n) / along];
            let gy = [g[0] * y[0] + g[1] * y[1], g[1] * y[0] + g[2] * y[1]];
            let lift = 0.5 * (gy[0] * y[0] + gy[1] * y[1]);
            // Above the object's value at b: another piece.
            if lift > top - cuts.a[k] && cuts.a[k] < top {
                cuts.carried &= !(1 << k);
                continue;
            }
            cuts.a[k] += lift;
            cuts.x[k] -= gy[0];
            cuts.y[k] -= gy[1];
        }
    }

    #[inline(never)]
    fn carry(&self, b: &Vec3, [e1, e2]: [&Vec3; 2], cuts: &mut Cuts) {
        let m = self.disc().point(b);
        let (h, x, y) = (m.dot(b), m.dot(e1), m.dot(e2));
        for k in (0..ROOM).filter(|k| self.carries(*k)) {
            cuts.a[k] += h;
            cuts.x[k] += x;
            cuts.y[k] += y;
        }
        cuts.carried = self.carried;
        let across = self.disc().across(b);
        let l2 = across.norm_squared();
        let t = self.disc().axis.cross(&across);
        let f = self.disc().radius / (l2 * l2.sqrt());
        let (x, y) = (t.dot(e1), t.dot(e2));
        if f.is_finite() {
            cuts.bend = [f * x * x, f * x * y, f * y * y];
        }
    }

    /// The support value of the known points along unit `n`.
    pub fn height(&self, n: &Vec3) -> f64 {
        let disc = self.disc().radius * self.disc().across(n).norm();
        let level = |k| self.core(k).dot(n) + if self.carries(k) { disc } else { 0.0 };
        let levels = (0..self.len.min(ROOM)).map(level);
        levels.fold(f64::NEG_INFINITY, larger)
    }

    /// The `k`th point where it is along unit `n`: on its ball or disc where that was seen, and behind all
    /// support planes of the points but for `same`, metres.
    #[inline(always)]
    pub fn point(&self, k: usize, n: &Vec3, same: f64) -> Vec3 {
        let is_seen = self.is_cored() && self.carries(k) && self.was_seen(k, n);
        let moved = is_seen.then(|| self.core(k) + self.disc().point(n));
        let mut seen = self.at.iter().take(self.len);
        let is_behind = |p: &Vec3| seen.all(|at| (p - at.p).dot(&at.n) <= same);
        moved.filter(is_behind).unwrap_or(self.at[k % ROOM].p)
    }

    /// How far what is round lifts the cut of the `k`th point along unit `n` above the point itself,
    /// metres.
    #[inline(always)]
    pub fn lift(&self, k: usize, n: &Vec3) -> f64 {
        let at = &self.at[k % ROOM];
        if !self.carries(k) {
            0.0
        } else if self.kind == Kind::Curved {
            let dn = n - at.n;
            0.5 * self.curved.r().times(&dn).dot(&dn)
        } else {
            self.disc().point(n).dot(n) - (at.p - self.core(k)).dot(n)
        }
    }

    /// Was the round part of the `k`th point seen from two directions, and not too far from unit `n`?
    #[inline(always)]
    fn was_seen(&self, k: usize, n: &Vec3) -> bool {
        let dn2 = (self.at[k % ROOM].n - n).norm_squared();
        self.seen_twice(k) && !(dn2 > FAR * FAR * self.span[k % ROOM])
    }

    /// Is the `k`th point's round part in doubt along unit `n`? Not seen twice, or too far from
    /// where, and lifting its cut by more than `hair`, metres.
    #[inline(always)]
    pub fn is_unseen(&self, k: usize, n: &Vec3, hair: f64) -> bool {
        let doubted = match self.kind {
            Kind::Curved => self.curved.is_believed(),
            _ => !self.was_seen(k, n),
        };
        self.carries(k) && doubted && self.lift(k, n) > hair
    }

    /// Was the `k`th point seen along two directions?
    #[inline(always)]
    pub fn seen_twice(&self, k: usize) -> bool {
        self.span[k % ROOM] > 0.0
    }
}

// In single precision two points tell no disc as near as this.
#[cfg(all(test, not(feature = "single")))]
mod tests {
    use super::super::learn::Shown;
    use super::*;
    use crate::known::round::Same;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    const NEAR: f64 = if EPSILON > 1e-10 { 1e-4 } else { 1e-9 };
    const SAME: Same = Same {
        rounding: 4.0 * EPSILON,
        round: NEAR,
        extent2: 4.0,
    };

    fn ask(shape: impl Fn(&Vec3) -> Vec3, d: Vec3) -> Seen {
        let n = d.normalize();
        Seen { n, p: shape(&n) }
    }

    /// Of radius 0.5, about the z axis, from −0.4 to 0.4.
    fn cylinder(d: &Vec3) -> Vec3 {
        let f = 0.5 / d.x.hypot(d.y);
        Vec3::new(d.x * f, d.y * f, (0.4 as f64).copysign(d.z))
    }

    /// The same rim, and a tip at z = 0.9.
    fn cone(d: &Vec3) -> Vec3 {
        let tip = Vec3::z() * 0.9;
        let base = cylinder(&Vec3::new(d.x, d.y, -1.0));
        if tip.dot(d) > base.dot(d) { tip } else { base }
    }

    fn ellipsoid(d: &Vec3) -> Vec3 {
        let r = Vec3::new(0.5, 0.35, 0.25);
        let w = r.component_mul(&r.component_mul(d));
        w / w.dot(d).sqrt()
    }

    /// An object that has seen these, and what the last one shows.
    fn object(points: &[Seen]) -> (Object, Shown) {
        let mut object = Object::default();
        let mut shown = Shown::Nothing;
        for (i, at) in points.iter().enumerate() {
            if i > 0 {
                shown = object.learn(0, at, &SAME);
                match &shown {
                    Shown::Ball(radius) => {
                        object.take_off((&Found::ball(*radius), Told::More), 0, SAME.round);
                    }
                    Shown::Smooth => {
                        let smooth = object.learn_disc(0, at, &SAME).unwrap();
                        if let Some(found) = &smooth.found {
                            object.take_off((found, smooth.told), 0, SAME.round);
                        }
                    }
                    _ => (),
                }
            }
            object.take(at, None, &points[0].n, 0, &SAME);
        }
        (object, shown)
    }

    #[test]
    fn two_points_show_a_ball() {
        let mut r = Random::new(1);
        for _ in 0..200 {
            let c = r.vector(1.0);
            let n = r.direction();
            let points = [n, n + r.vector(0.3)].map(|d| ask(|n| c + n * 0.3, d));
            let (object, shown) = object(&points);
            assert!(matches!(shown, Shown::Ball(_)) && object.len == 1);
            assert!((object.ball() - 0.3).abs() < NEAR && (object.core(0) - c).norm() < NEAR);
            // Seen twice; but not as far aside.
            assert!(!object.is_unseen(0, &n, NEAR));
            assert!(object.is_unseen(0, &-n, NEAR));
        }
    }

    #[test]
    fn a_third_point_confirms_what_two_could_be_by_chance() {
        let dirs = [(1.0, 0.0, 0.6), (1.0, 0.2, 0.5), (1.0, 0.1, 0.7)];
        let points = dirs.map(|(x, y, z)| ask(cylinder, Vec3::new(x, y, z)));
        let (pair, _) = object(&points[..2]);
        assert!(pair.is_doubted() && (pair.disc().radius - 0.5).abs() < NEAR);
        assert!(pair.disc().axis.cross(&Vec3::z()).norm() < NEAR);
        assert!(pair.is_unseen(0, &points[1].n, 0.0));
        let (three, _) = object(&points);
        assert!(!three.is_doubted() && three.seen_twice(0) && three.len == 1);
        assert!((three.core(0) - Vec3::z() * 0.4).norm() < NEAR);
        // The rim where it is along another direction, and its support value.
        let n = Vec3::new(0.8, 0.05, 0.45).normalize();
        assert!((three.point(0, &n, NEAR) - cylinder(&n)).norm() < NEAR);
        assert!((three.height(&n) - cylinder(&n).dot(&n)).abs() < NEAR);
    }

    /// Of an ellipsoid any two points could be a disc's; a third one shows that they are not.
    #[test]
    fn an_ellipsoid_refutes_what_two_of_its_points_show() {
        let mut random = Random::new(2);
        let mut met = 0;
        for _ in 0..200 {
            let n = random.direction();
            let near = |random: &mut Random| ask(ellipsoid, n + random.vector(0.05));
            let (mut found, _) = object(&[ask(ellipsoid, n), near(&mut random)]);
            if found.is_doubted() {
                met += 1;
                let third = near(&mut random);
                found.take(&third, None, &n, 0, &SAME);
                assert!(found.kind != Kind::Disc);
            }
        }
        assert!(met > 20, "{met}");
    }

    #[test]
    fn a_tip_carries_no_disc() {
        let dirs = [(1.0, 0.0, -0.6), (1.0, 0.2, -0.5), (1.0, 0.1, 0.45)];
        let points = dirs.map(|(x, y, z)| ask(cone, Vec3::new(x, y, z)));
        let (object, _) = object(&points);
        assert_eq!((object.len, object.carried), (2, 1));
        let up = Vec3::new(0.1, 0.0, 1.0).normalize();
        assert_eq!(object.height(&up), 0.9 * up.z);
        // A cut that bends, and one that does not.
        let b = Vec3::new(0.8, 0.0, 0.6);
        let (e1, e2) = (Vec3::y(), Vec3::new(-0.6, 0.0, 0.8));
        let mut cuts = Cuts::default();
        object.chart(&b, [&e1, &e2], &mut cuts);
        let rim = cone(&Vec3::new(0.8, 0.0, -1.0));
        assert!((cuts.a[0] - rim.dot(&b)).abs() < NEAR && (cuts.y[0] - rim.dot(&e2)).abs() < NEAR);
        assert!((cuts.a[1] - 0.54).abs() < NEAR && cuts.carried == 1);
        // r/|b across| along the rim.
        assert!((cuts.bend[0] - 0.5 / 0.8).abs() < NEAR && cuts.bend[2].abs() < NEAR);
    }

    #[test]
    fn the_lowest_point_makes_room() {
        let b = Vec3::z();
        let mut object = Object::default();
        for k in 0..2 * ROOM {
            let p = Vec3::new(k as f64, 1.0, (k * 7 % (2 * ROOM)) as f64);
            let at = Seen { n: b, p };
            let place = object.take(&at, None, &b, 2, &SAME);
            assert_eq!(object.core(place), p);
        }
        assert!(object.len == ROOM && object.core(2).x == 2.0);
    }
}
