// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A proof of a shallow contact without a hull.
//!
//! What is known of each object makes a polytope P in D ([`crate::known::points`]): a corner over a face
//! needs three corners of the face, and of the other object the one point that the face's normal
//! finds; an edge across an edge two points of each. The portal is refined in P for no callback
//! ([`crate::hull::portal`]), and its normal is asked.
//!
//! *The proof.* Let h be the least depth met, and r = h − the gap allowed. Where the portal's plane
//! is at least r from the origin, and what closes the surface behind it too, the ball of radius r is in
//! P, and the depth proven. Mostly that takes one question beyond the portal, along its normal; where
//! objects are round, one where their round parts tell the minimum ([`crate::hull::cores`]), and its
//! corners. What is not proven after a few goes to a hull, with all that is known.

use crate::hull::cores::{Aim, Cores};
use crate::hull::expansion::Limits;
use crate::hull::global::{Basis, FIRST};
use crate::hull::portal::{Plane, Portal, Step, View};
use crate::hull::start::{self, Ball, Sample};
use crate::known::points::Points;
use crate::known::precision::Precision;
use crate::known::support_set::{Inquiry, Lowest, Stop, SupportSet};
use crate::math::{EPSILON, Vec3, as_unit, larger, normalised, replace_if};
use crate::minkowski::support::{SupportMap, SupportPoint};

/// A portal is where it belongs within this share of the tolerance. Insensitive: 0.02 to 0.2 tried, within
/// 1 % of the instructions.
pub(super) const LEVEL: f64 = 0.05;
/// Steps of a portal between two questions. Measured on the recorded contacts: with 2 of them 1.6 % more
/// support points, with more than 3 no fewer.
pub(super) const STEPS: usize = 3;
/// A hull does not begin with a corner that one question found and so many after it did not. Measured on
/// ODE's cylinder, whose faults stay corners: with 3, 2 % more contacts are wrong; with 1 as many, and hits
/// take 0.4 % more instructions.
const AGE: usize = 2;
/// Directions besides the first that a state may have ([`Basis::ROOM`]).
const START: usize = Basis::ROOM - 1;
/// Directions asked beyond the portal for a proof, warm and cold: a face takes one, what is round its
/// minimum and two corners. Measured on the recorded contacts: with two fewer hits take 1.4 % more
/// instructions, warm 7 % more; with more 0.3 % fewer, but ODE's cylinder errs along its axis more often.
const ROUNDS: [u64; 2] = [4, 5];
/// Points before a ball is looked for instead of a portal, and round parts ahead of the first question beyond
/// it. Measured: for the ball with 2 shallow capsules take 22 % more support points, warm contacts 1 %,
/// ellipsoids 3 % fewer, and without one these 3 %, in motion 9 % more; for the round parts with 2 boxes take
/// a tenth more instructions.
const EARLY: usize = 3;

/// What a hull keeps its points in.
type Known = SupportSet<{ FIRST.0 }>;

/// What counts for nothing.
pub(super) struct Sizes {
    /// The gap allowed, metres.
    pub(super) tolerance: f64,
    /// [`Precision::tie`].
    tie: f64,
    /// What three products of lengths round by.
    tiny: f64,
}

impl Sizes {
    #[inline(always)]
    pub(super) fn of(precision: &Precision, tolerance: f64) -> Self {
        Self {
            tolerance: precision.tolerance(tolerance),
            tie: precision.tie(),
            tiny: 64.0 * EPSILON * (precision.size2() * precision.size()),
        }
    }
}

/// The depth that a portal has to prove, metres; `None` where it is no more than rounding, or where
/// c is no farther inside than the origin.
#[inline(always)]
fn least(lowest: &Lowest, c: &Vec3, sizes: &Sizes) -> Option<f64> {
    let Lowest { depth, dir } = lowest;
    let Sizes { tolerance, tie, .. } = *sizes;
    let least = larger(depth - tolerance + tie, 0.5 * depth);
    (dir.dot(c) < -tie && least > 2.0 * tie).then_some(least)
}

/// A try at a proof: what is known of the pair.
pub struct Try {
    pub(super) c: Vec3,
    /// What is known.
    pub points: Points,
    /// The number of the lowest direction.
    pub lowest: usize,
    /// The places of the corners of the portal that a hull begins with.
    begin: Option<[[usize; 2]; 3]>,
    /// The portal, once there is one.
    pub portal: Option<Portal>,
    /// The places of the corners of the face that the objects touch in, and the weights of these.
    pub exit: Option<([[usize; 2]; 3], [f64; 3])>,
    /// Support points beyond the portal.
    pub rounds: u64,
    /// The direction whose point the portal is looked for from.
    pub(super) from: usize,
    /// Does a callback contradict itself?
    pub lies: bool,
}

impl Try {
    /// From the first point, found along `dir`.
    #[inline(always)]
    pub fn new(dir: &Vec3, first: &SupportPoint) -> Self {
        let mut new = Self {
            c: Vec3::zeros(),
            points: Points::EMPTY,
            lowest: 0,
            portal: None,
            exit: None,
            begin: None,
            rounds: 0,
            from: 0,
            lies: false,
        };
        new.points.first(dir, first);
        new
    }

    /// Asks against the first direction, where there is no centre: the middle of the two is an apex.
    /// `None`: the callback contradicts itself.
    ///
    /// A `cold` query's first direction may have nothing to do with where the objects are. Then it is only
    /// good for an apex, and the portal is looked for from the point along the way from there through
    /// the origin.
    ///
    /// # Errors
    /// As [`Try::run`].
    #[inline(never)]
    pub fn opposite<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        cold: bool,
    ) -> Result<Option<SupportPoint>, Stop> {
        let dir = self.points.direction(0);
        let opposite = inquiry.point(&-dir)?;
        // NaN is no depth.
        if !inquiry.precision.is_depth(-dir.dot(&opposite.v)) {
            self.apart(inquiry, &-dir, &opposite)?;
            return Ok(None);
        }
        let apex = self.points.point([0; 2]) + opposite.v;
        if let Some(n) = normalised(&-apex).filter(|n| cold && start::is_far(n, &dir)) {
            if self.ask(inquiry, &n)?.is_none() {
                return Ok(None);
            }
            self.from = self.points.asked() - 1;
        }
        Ok(Some(opposite))
    }

    /// Asks along the directions of a state, zero for none. `false`: the callback contradicts itself.
    ///
    /// # Errors
    /// As [`Try::run`].
    #[inline(always)]
    pub fn recall<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        others: &[Vec3],
    ) -> Result<bool, Stop> {
        for n in others.iter().filter_map(as_unit).take(START) {
            if self.ask(inquiry, &n)?.is_none() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// What is proven of the depth, if anything; else the points and the portal, if there is one,
    /// are for a hull, as they are at once where a `hull` is better. `c`: the apex. `cold`: there was no
    /// state.
    ///
    /// # Errors
    /// [`Stop::Apart`]: apart, or touching within rounding. Else a callback's answer that is not
    /// finite.
    #[inline(always)]
    pub fn run<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        c: &Vec3,
        limits: &Limits,
        cold: bool,
        hull: bool,
        hint: u32,
    ) -> Result<Option<f64>, Stop> {
        // From an apex at the origin (also NaN) the ray is the lowest direction. What stands in for the apex
        // there may be outside of D: it proves nothing.
        let Lowest { depth, dir } = inquiry.lowest;
        let rounding = inquiry.precision.rounding();
        let at_origin = !(c.norm_squared() > rounding * rounding);
        self.c = if at_origin { -dir * depth } else { *c };
        let hull = hull || at_origin;
        let sizes = Sizes::of(&inquiry.precision, limits.tolerance);
        if hull && !cold {
            let points = &self.points;
            let names = |k| points.names(k);
            let known = start::known(c, points.asked(), |k| points.point(names(k)));
            if let Some(corners) = known {
                self.begin = Some(corners.map(names));
                return Ok(None);
            }
        }
        if hint >= Basis::PORTAL {
            let portal = Portal::hinted(&self.points, hint);
            self.portal = Some(portal).filter(|portal| portal.is_pierced(&self.c, sizes.tiny));
        }
        if self.portal.is_none() && !self.find(inquiry, cold, sizes.tolerance)? {
            return Ok(None);
        }
        match self.portal {
            Some(portal) if hull => {
                self.begin = Some(portal.names);
                Ok(None)
            }
            Some(portal) => self.prove(inquiry, portal, limits, cold, &sizes),
            None => Ok(None),
        }
    }

    /// Asks along `n`: the point of D, and its support value. `None`: the callback contradicts
    /// itself.
    #[inline(always)]
    pub(super) fn ask<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        n: &Vec3,
    ) -> Result<Option<(Vec3, f64)>, Stop> {
        let point = inquiry.point(n)?;
        let h = n.dot(&point.v);
        // NaN is no depth.
        if !inquiry.precision.is_depth(h) {
            self.apart(inquiry, n, &point)?;
            return Ok(None);
        }
        let Lowest { depth, dir } = &mut inquiry.lowest;
        let lower = h < *depth;
        replace_if(lower, depth, h);
        for (x, y) in dir.iter_mut().zip(n.iter()) {
            replace_if(lower, x, *y);
        }
        let asked = self.points.asked();
        self.lowest = if lower { asked } else { self.lowest };
        self.points.add(n, &point);
        Ok(Some((point.v, h)))
    }

    /// The answer along `n` separates, unless [`Inquiry::apart`] finds a point farther: then that
    /// answer is none, and the callback contradicts itself.
    #[cold]
    #[inline(never)]
    fn apart<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        n: &Vec3,
        answer: &SupportPoint,
    ) -> Result<(), Stop> {
        let points = &self.points;
        let [one, two] = points.witnesses(points.extreme(n));
        let far = larger(n.dot(&one), n.dot(&answer.v1)) + larger(-n.dot(&two), -n.dot(&answer.v2));
        if !(far > inquiry.beyond(n, answer)) {
            return Err(Stop::Apart(*n));
        }
        let mut set = Known::EMPTY;
        set.push(&Vec3::zeros(), answer);
        for k in 0..points.asked() {
            let [v1, v2] = points.witnesses(points.names(k));
            set.push(&points.direction(k), &SupportPoint { v: v1 - v2, v1, v2 });
        }
        self.lies = true;
        inquiry.apart(&mut set, *n, answer)?;
        Ok(())
    }

    /// Finds the portal: in P, else by support points along the lowest direction tilted to where P
    /// ends. Not where D looks like a ball, which a hull has a ring for.
    #[inline(always)]
    pub(super) fn find<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        cold: bool,
        tolerance: f64,
    ) -> Result<bool, Stop> {
        let c = self.c;
        let mut view = View::of(&self.points, self.from, &c);
        let mut vain = 0;
        if !cold {
            self.portal = view.portal(&self.points, &c);
            if self.portal.is_some() {
                return Ok(true);
            }
        }
        let far = c.norm();
        // On the ray: a ball's.
        if cold && view.is_at(tolerance, far) {
            return Ok(false);
        }
        let from = self.points.point(self.points.names(self.from));
        let length = far - c.dot(&from) / far;
        // Each turn takes a place, or is the last one.
        while !self.points.is_full() {
            let Lowest { depth, dir } = inquiry.lowest;
            if self.may_be_round() && self.is_ball(&dir, inquiry.precision.tie()) {
                return Ok(false);
            }
            let n = match view.tilt(depth, far, length, vain) {
                Some(way) => dir + way,
                None => view.way,
            };
            let Some(n) = normalised(&n) else { break };
            let Some((p, _)) = self.ask(inquiry, &n)? else {
                break;
            };
            let names = self.points.names(self.points.asked() - 1);
            if !(view.way.dot(&p) > 0.0) {
                if start::is_widest(vain) {
                    break;
                }
                vain += 1;
            }
            if let Step::Portal(portal) = view.step(names, &p, &c) {
                self.portal = Some(portal);
                return Ok(true);
            }
            if !cold {
                self.portal = view.portal(&self.points, &c);
                if self.portal.is_some() {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// May both objects be round, after so many points?
    #[inline(always)]
    fn may_be_round(&self) -> bool {
        let points = &self.points;
        points.asked() > EARLY && points.is_new(0) && points.is_new(1)
    }

    /// Does D look like a ball, which a hull has a ring for?
    #[inline(always)]
    fn is_ball(&self, dir: &Vec3, tie: f64) -> bool {
        let points = &self.points;
        let sample = |k| Sample::of(points.direction(k), points.point(points.names(k)));
        Ball::seen((0..points.asked()).map(sample), dir, tie).is_some()
    }

    /// Moves the portal outwards, by known points as far as they go, else by a question along its
    /// normal, until it proves the depth: what it proves.
    #[inline(never)]
    fn prove<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        mut portal: Portal,
        limits: &Limits,
        cold: bool,
        sizes: &Sizes,
    ) -> Result<Option<f64>, Stop> {
        let c = self.c;
        let first = portal.names;
        let (level, rounds) = (LEVEL * sizes.tolerance, ROUNDS[usize::from(cold)]);
        let (mut plane, mut cores) = (portal.plane(), None);
        // Steps since the last question; has that found nothing above the portal, nor known points?
        let (mut steps, mut settled) = (0, false);
        loop {
            let lowest = &inquiry.lowest;
            let Some(least) = least(lowest, &c, sizes) else {
                break;
            };
            let mut open = None;
            if plane.reaches(least, sizes.tiny) {
                open = portal.open_side(&self.points, &c, least, sizes.tiny);
                if open.is_none() && self.touch(&portal, &plane, lowest, least, sizes.tolerance) {
                    if !settled && !self.is_honest(sizes.tie) {
                        break;
                    }
                    self.portal = Some(portal);
                    // Rounded down by what was asked for beyond.
                    return Ok(Some(least - sizes.tie));
                }
            }
            if open.is_none() {
                if settled || plane.is_deep(inquiry.precision.size2()) {
                    break;
                }
                if steps < STEPS && portal.advance(&self.points, &plane, &c, level) {
                    steps += 1;
                    plane = portal.plane();
                    continue;
                }
            }
            if self.rounds >= rounds.min(limits.iterations) || self.points.is_full() {
                break;
            }
            let before = lowest.depth;
            let seen = (&portal, &plane);
            let Some(aim) = self.question(inquiry, &mut cores, open, seen, sizes) else {
                break;
            };
            let (Aim::Normal(m) | Aim::Minimum(m) | Aim::Beside(m)) = aim;
            let Some((p, h)) = self.ask(inquiry, &m)? else {
                break;
            };
            self.rounds += 1;
            let above = match aim {
                Aim::Normal(_) => h - m.dot(&portal.points[2]),
                _ => plane.above(&p),
            };
            if above > level {
                let last = self.points.names(self.points.asked() - 1);
                portal.replace(last, &p, &c);
                plane = portal.plane();
            } else if let Aim::Normal(_) = aim {
                if !self.settles(inquiry, (&m, h), above, before, sizes) {
                    break;
                }
                settled = steps < STEPS;
                continue;
            }
            (steps, settled) = (0, false);
            if let (Aim::Minimum(_), Some(cores)) = (aim, &mut cores) {
                cores.learn(h, before);
            }
        }
        let doubted = self.is_doubted(&portal);
        self.begin = Some(if doubted { first } else { portal.names });
        Ok(None)
    }

    /// Where to ask next: beyond an open side of the portal's surface, if there is one, whose limit this
    /// is; where round parts tell, if they do; along its normal.
    #[inline(always)]
    fn question<A: SupportMap, B: SupportMap>(
        &self,
        inquiry: &Inquiry<'_, A, B>,
        cores: &mut Option<Cores>,
        open: Option<Vec3>,
        (portal, plane): (&Portal, &Plane),
        sizes: &Sizes,
    ) -> Option<Aim> {
        if let Some(limit) = open {
            return normalised(&limit).map(Aim::Beside);
        }
        let points = &self.points;
        // Before the first question only where both objects may be round.
        let early = self.rounds == 0;
        if !early || self.may_be_round() {
            let Inquiry {
                lowest, precision, ..
            } = inquiry;
            let cores = cores.get_or_insert(Cores::NONE);
            let scale = (precision.size2(), sizes.tolerance);
            let aim = cores.aim(points, portal, lowest, scale, early);
            if aim.is_some() || cores.is_curved() {
                return aim;
            }
        }
        normalised(&plane.n).map(Aim::Normal)
    }

    /// A question along the portal's normal has found nothing above it. Is its plane as low as the lowest,
    /// within the tolerance? Then it is the lowest from here on.
    #[inline(always)]
    fn settles<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        (m, h): (&Vec3, f64),
        above: f64,
        before: f64,
        sizes: &Sizes,
    ) -> bool {
        self.lies = above < -sizes.tie;
        let low = !self.lies && h < before + (1.0 - LEVEL) * sizes.tolerance;
        if low {
            inquiry.lowest = Lowest { depth: h, dir: *m };
            self.lowest = self.points.asked() - 1;
        }
        low
    }

    /// Is a corner of the portal made of a point that a question along a portal's normal found, and none of
    /// the [`AGE`] after it? One that a callback erred in stays so.
    #[cold]
    #[inline(never)]
    fn is_doubted(&self, portal: &Portal) -> bool {
        let points = &self.points;
        let asked = points.asked();
        let first = asked.saturating_sub(self.rounds as usize);
        portal.names.iter().any(|names| {
            (0..2).any(|o| {
                let by = points.found(o, names[o]) as usize;
                let again = || (by + 1..asked).any(|k| points.names(k)[o] == names[o]);
                by >= first && by + AGE < asked && !again()
            })
        })
    }

    /// Do the objects touch in the portal, or in another face of P? Keeps where.
    #[inline(always)]
    fn touch(
        &mut self,
        portal: &Portal,
        plane: &Plane,
        lowest: &Lowest,
        least: f64,
        tolerance: f64,
    ) -> bool {
        self.exit = match portal.touches(plane, lowest, least, tolerance) {
            Some(weights) => Some((portal.names, weights)),
            None => self.elsewhere(portal, lowest, least, tolerance),
        };
        self.exit.is_some()
    }

    /// The face of P that the ray along the lowest direction leaves through, and the weights there.
    #[cold]
    #[inline(never)]
    fn elsewhere(
        &self,
        portal: &Portal,
        lowest: &Lowest,
        least: f64,
        tolerance: f64,
    ) -> Option<([[usize; 2]; 3], [f64; 3])> {
        // As seen from far behind the origin.
        let c = -lowest.dir;
        let mut portal = portal.moved(&self.points, &c)?;
        for _ in 0..2 * STEPS {
            let plane = portal.plane();
            if let Some(weights) = portal.touches(&plane, lowest, least, tolerance) {
                return Some((portal.names, weights));
            }
            if !portal.advance(&self.points, &plane, &c, LEVEL * tolerance) {
                break;
            }
        }
        None
    }

    /// Does no known point of an object lie beyond a plane that was asked of it? One does that a
    /// callback erred in, or that it stopped short of.
    #[inline(always)]
    pub fn is_honest(&mut self, tie: f64) -> bool {
        self.lies = !(self.points.beyond() <= tie);
        !self.lies
    }

    /// What the proof stands on.
    #[inline(always)]
    pub fn basis(&self, portal: &Portal, basis: &mut Basis) {
        let (points, lowest) = (&self.points, self.lowest);
        // What asking along the minimum's has found it finds again.
        let first = points.names(lowest);
        let by = portal.names.map(|names| {
            [0, 1].map(|object| match names[object] == first[object] {
                true => lowest as u32,
                false => points.found(object, names[object]),
            })
        });
        let mut left = by.as_flattened().iter().fold(0, |all, k| all | 1_u32 << k);
        left &= !(1 << lowest);
        (basis.directions[0], basis.len) = (points.direction(lowest), 1);
        // Of each direction, two bits, the number that it has now. In the order in which they were
        // asked: the swapped pair's is the same.
        let mut numbers = 0_u32;
        while left != 0 && usize::from(basis.len) < Basis::ROOM {
            let k = left.trailing_zeros();
            basis.directions[usize::from(basis.len) % Basis::ROOM] = points.direction(k as usize);
            numbers |= u32::from(basis.len) << (2 * k);
            basis.len += 1;
            left &= left - 1;
        }
        // Where no room is left a portal of fewer is looked for.
        if usize::from(basis.len) < Basis::ROOM {
            let all = by.as_flattened().iter().rev();
            basis.hint = all.fold(1, |hint, k| hint << 2 | numbers >> (2 * k) & 3);
        }
    }

    /// What a hull may begin with.
    #[inline(never)]
    pub fn hand_over(&self, apex: &SupportPoint, opposite: Option<&SupportPoint>, to: &mut Handed) {
        let points = &self.points;
        let put = |set: &mut Known, n: &Vec3, names| {
            let [v1, v2] = points.witnesses(names);
            set.push(n, &SupportPoint { v: v1 - v2, v1, v2 })
        };
        to.set.push(&Vec3::zeros(), apex);
        for k in 0..points.asked() {
            put(&mut to.set, &points.direction(k), points.names(k));
        }
        if let Some(corners) = self.begin {
            let [a, b, c] = corners.map(|corner| {
                match (0..points.asked()).find(|&k| points.names(k) == corner) {
                    Some(k) => k + 1,
                    None => put(&mut to.set, &Vec3::zeros(), corner),
                }
            });
            to.names = [0, a, b, c].map(|i| i as u16);
        }
        to.opposite = opposite.map(|point| (-points.direction(0), *point));
        (to.rounds, to.known) = (self.rounds as u16, true);
    }
}

/// What a try leaves to a hull.
pub struct Handed {
    /// The apex, and the points asked for; and those of the portal's corners that are none.
    pub set: Known,
    /// The corners of a tetrahedron to begin with; all 0 for none.
    pub names: [u16; 4],
    /// Where there was no centre the point opposite to the first, and its direction: one of a hull like
    /// others, but no corner of a portal or a ring.
    pub opposite: Option<(Vec3, SupportPoint)>,
    /// Support points beyond the first tetrahedron.
    pub rounds: u16,
    /// Is there anything?
    pub known: bool,
}

impl Handed {
    /// Nothing.
    pub const EMPTY: Self = Self {
        set: SupportSet::EMPTY,
        names: [0; 4],
        opposite: None,
        rounds: 0,
        known: false,
    };

    /// Nothing again.
    pub fn clear(&mut self) {
        self.set.truncate(0);
        (self.names, self.rounds, self.known) = ([0; 4], 0, false);
        self.opposite = None;
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::shapes::{Random, capsule, corners, hull, placed};

    const TOLERANCE: f64 = if EPSILON < 1e-10 { 1e-7 } else { 1e-4 };

    /// The corner of a box below the face of a plate: proven by four or five support points, and what is
    /// proven is no more than the depth.
    #[test]
    fn a_corner_in_a_face_needs_no_hull() {
        let mut r = Random::new(6);
        let plate = corners(Vec3::new(2.0, 2.0, 0.5));
        let (mut proven, mut asked) = (0, 0);
        for _ in 0..200 {
            let rotation = r.rotation();
            let turned = placed(&corners(Vec3::new(0.5, 0.6, 0.7)), &rotation, Vec3::zeros());
            let low = turned
                .iter()
                .fold(0.0, |low, p: &Vec3| crate::math::lesser(low, p.z));
            let depth = 0.01;
            let at = Vec3::new(0.3, -0.2, 0.5 - low - depth);
            let b = placed(&turned, &crate::shapes::Rotation::identity(), at);
            let md = MinkowskiDifference::new(hull(&plate), hull(&b));
            let c = SupportPoint {
                v: -at,
                v1: Vec3::zeros(),
                v2: at,
            };
            let dir = at / at.norm();
            let mut inquiry = Inquiry::new(&md);
            let first = inquiry.first(&dir, None).unwrap();
            inquiry.precision.note(&c);
            let limits = Limits {
                tolerance: TOLERANCE,
                gap: 1e-3,
                supports: 160,
                iterations: 100,
            };
            let mut attempt = Try::new(&dir, &first);
            let lower = attempt.run(&mut inquiry, &c.v, &limits, true, false, 0);
            let lower = lower.unwrap();
            if let Some(lower) = lower {
                proven += 1;
                asked += md.supports();
                assert!(lower <= depth && inquiry.lowest.depth <= depth + TOLERANCE);
                assert!(inquiry.lowest.depth >= depth - 64.0 * EPSILON);
            }
        }
        assert!(proven > 190 && asked <= 5 * proven, "{proven} {asked}");
    }

    /// A lying cylinder's side or a capsule across a capsule: their minimum is told by their round parts,
    /// exactly, and proven by two corners more.
    #[test]
    fn round_sides_that_cross_need_no_hull() {
        let mut r = Random::new(7);
        let (mut proven, mut asked) = (0, 0);
        for round in 0..400 {
            let turn = r.rotation();
            let (along, across) = (turn * Vec3::x(), turn * Vec3::y());
            let up = turn * Vec3::z();
            let depth = 0.002;
            let at = along * r.within(-0.2, 0.2) + across * r.within(-0.2, 0.2);
            let at = at + up * (0.3 - depth);
            let end = across * 0.5;
            let upper = capsule(at - end, at + end, 0.1);
            let lower = move |d: &Vec3| {
                let x = along.dot(d);
                let side = d - along * x;
                let round = if round % 2 == 0 {
                    *d
                } else {
                    side / side.norm()
                };
                along * (0.5 as f64).copysign(x) + round * 0.2
            };
            let md = MinkowskiDifference::new(lower, upper);
            let c = SupportPoint {
                v: -at,
                v1: Vec3::zeros(),
                v2: at,
            };
            let dir = at / at.norm();
            let mut inquiry = Inquiry::new(&md);
            let first = inquiry.first(&dir, None).unwrap();
            inquiry.precision.note(&c);
            let limits = Limits {
                tolerance: 10.0 * TOLERANCE,
                gap: 1e-3,
                supports: 160,
                iterations: 100,
            };
            let mut attempt = Try::new(&dir, &first);
            let lower = attempt.run(&mut inquiry, &c.v, &limits, true, false, 0);
            let lower = lower.unwrap();
            if let Some(lower) = lower {
                proven += 1;
                asked += md.supports();
                let off = (inquiry.lowest.dir - up).norm();
                assert!(lower <= depth && inquiry.lowest.depth <= depth + limits.tolerance);
                assert!(off * off * 0.3 <= 2.0 * limits.tolerance, "{off}");
            }
        }
        assert!(proven > 350 && asked <= 8 * proven, "{proven} {asked}");
    }
}
