// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How far apart two objects are: the distance algorithm of Gilbert, Johnson and Keerthi (1988),
//! between two bounds.
//!
//! For any unit n, −h(n) is a lower bound on the distance: D lies behind its support plane. The
//! point of the simplex nearest to the origin is an upper one. [`Approach::step`] asks where the
//! bounds are to meet, and [`Approach::run`] goes on until they do, or a [`Goal`] says otherwise:
//! [`separate`] leaves off where they are near enough for a direction that is
//! to separate for long; [`crate::gjk::signed_distance`] at its tolerance.
//!
//! **Balls are taken off to choose where to ask.** On a round part of D of radius ρ the points
//! of directions n are s = u + ρ n around a fixed u, and two of them tell ρ: with
//! e = n′·(s′ − s) and e′ = n·(s − s′), which agree there, ρ = (e + e′) / |n′ − n|². The point
//! nearest to the origin of the corners u tells the way to ask, which for balls rolled over
//! a polytope is the right one at once, where the simplex itself would take many halvings.
//! It promises a distance; one that was not kept is not asked for a while.

use crate::gjk::barycentric;
use crate::gjk::simplex::{Simplex, direction};
use crate::known::support_set::{Inquiry, SupportSet};
use crate::math::{Vec3, larger};
use crate::minkowski::support::{Fault, SupportMap, SupportPoint};

/// How far the two measures of a ball may differ, as a share of their sum. (Measured on the
/// random sets moved apart: a fifth of it costs ellipsoids one support point more, six times
/// it boxes 0.3 and cylinders 0.7.)
const ALIKE: f64 = 0.05;
/// The share of what a ball promises that makes it believed again. Insensitive: 0.25 to 0.75 tried
/// on the distances of the recorded contacts, at most 0.3 %.
const KEPT: f64 = 0.5;
/// The share of the tolerance that a promise must be worth: less does not pay for a support
/// point, and rounding is less. Insensitive: 0.1 to 1 tried there.
const WORTH: f64 = 0.3;
/// Steps that bring the simplex no nearer before rounding is all that is left.
const STALLS: u32 = 3;

/// How near the bounds are to come.
pub struct Goal {
    /// The width between them, metres.
    pub tolerance: f64,
    /// The same as a share of the upper one, where that is more.
    pub share: f64,
    /// What is taken off the distance, metres: the tolerance does not tell a touch from a gap, and a
    /// plane between the objects is wanted.
    pub margin: f64,
    /// What is farther apart than this, metres, need not be refined.
    pub far: f64,
    /// Support points, at most.
    pub iterations: u64,
}

/// Where an approach ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where the goal is.
    Met,
    /// The new simplex holds the origin inside.
    Inside,
    /// There is no way to ask, or steps bring the simplex no nearer: what is left is rounding.
    Stalled,
    /// The iterations were used up, or callbacks err by more than rounding.
    Limit,
}

/// Two objects on their way to their distance.
pub struct Approach<'s, 'q, A, B> {
    /// Asks, and knows the sizes.
    pub inquiry: &'s mut Inquiry<'q, A, B>,
    /// The simplex's points, each in its place.
    pub set: SupportSet<4>,
    /// The simplex.
    pub simplex: Simplex,
    /// The place of the newest point, where the origin is inside.
    inside: Option<usize>,
    /// The greatest −h(n), metres, and its n.
    pub lower: f64,
    /// See `lower`; any before the first point.
    pub normal: Vec3,
    /// From the simplex to the origin, of any length.
    way: Vec3,
    /// Its length, metres: the least so far was `nearest`.
    pub upper: f64,
    nearest: f64,
    stalls: u32,
    /// The last direction asked, and its point.
    last: Option<(Vec3, Vec3)>,
    /// Radius of the ball taken off, metres; 0 for none.
    pub ball: f64,
    /// Steps without a try, and how many the next failure costs.
    pause: u32,
    penalty: u32,
    /// Support points asked for.
    pub iterations: u64,
}

impl<'s, 'q, A: SupportMap, B: SupportMap> Approach<'s, 'q, A, B> {
    /// Nothing asked yet.
    pub fn new(inquiry: &'s mut Inquiry<'q, A, B>) -> Self {
        Self {
            inquiry,
            set: SupportSet::EMPTY,
            simplex: Simplex::new(),
            inside: None,
            lower: -f64::INFINITY,
            normal: Vec3::x(),
            way: Vec3::x(),
            upper: f64::INFINITY,
            nearest: f64::INFINITY,
            stalls: 0,
            last: None,
            ball: 0.0,
            pause: 0,
            penalty: 1,
            iterations: 0,
        }
    }

    /// From support point to support point.
    pub fn run(&mut self, goal: &Goal) -> Result<End, Fault> {
        loop {
            // In the plane of a touching face the last point was no nearer than others.
            if self.has_met(goal) {
                self.settle();
                if self.has_met(goal) {
                    return Ok(End::Met);
                }
            }
            if self.iterations >= goal.iterations {
                return Ok(End::Limit);
            }
            if let Some(end) = self.step(self.width(goal))? {
                return Ok(end);
            }
        }
    }

    /// The width that the bounds are to have, metres; NaN is none.
    fn width(&self, goal: &Goal) -> f64 {
        let least = self.inquiry.precision.tolerance(goal.tolerance);
        larger(goal.share * self.upper, least)
    }

    /// Are the bounds near enough?
    fn has_met(&self, goal: &Goal) -> bool {
        let touch = self.inquiry.precision.touch();
        let (lower, upper) = (self.lower - goal.margin, self.upper - goal.margin);
        // A plane between the objects is wanted even where the width would not ask.
        let told = lower > -touch || !(upper > touch);
        lower > goal.far || told && self.upper - self.lower <= self.width(goal)
    }

    /// One more support point, for bounds that are to come within `tolerance`, metres: where a ball
    /// foretells the distance, else along the way. Asks for none where that is stalled.
    fn step(&mut self, tolerance: f64) -> Result<Option<End>, Fault> {
        let aim = self.aim(tolerance);
        if aim.is_none() {
            if !(self.upper < self.nearest) {
                self.stalls += 1;
            }
            self.nearest = self.upper;
        }
        let plain = direction(&self.way).filter(|_| self.stalls <= STALLS);
        let Some(plain) = plain else {
            return Ok(Some(End::Stalled));
        };
        let inside = match aim {
            Some((n, promise)) => self.try_out(&n, promise)?,
            None => self.ask(&plain)?,
        };
        Ok(inside.then_some(End::Inside))
    }

    /// Asks along unit `n`, and learns what there is to learn without the simplex.
    fn sample(&mut self, n: &Vec3) -> Result<SupportPoint, Fault> {
        self.iterations += 1;
        let point = self.inquiry.point(n)?;
        let lower = -n.dot(&point.v);
        if lower > self.lower {
            (self.lower, self.normal) = (lower, *n);
        }
        if let Some((m, v)) = self.last {
            let (e, f) = (n.dot(&(point.v - v)), m.dot(&(v - point.v)));
            let ball = (e + f) / (n - m).norm_squared();
            // Not rounding, not two corners of a polytope, not larger than D.
            let rounding = self.inquiry.precision.touch();
            if e + f > 4.0 * rounding
                && (e - f).abs() <= ALIKE * (e + f)
                && ball < self.inquiry.precision.size()
            {
                self.ball = ball;
            }
        }
        self.last = Some((*n, point.v));
        Ok(point)
    }

    /// Asks along the way of the simplex, unit `n`, or anywhere where there is none.
    /// Returns whether the new simplex holds the origin.
    pub fn ask(&mut self, n: &Vec3) -> Result<bool, Fault> {
        let point = self.sample(n)?;
        self.pause = self.pause.saturating_sub(1);
        if self.beyond(&point) {
            return Ok(self.add(n, &point));
        }
        // What is left is rounding, or the plane of a touching face, in which the simplex's
        // last point was no nearer than the others.
        self.settle();
        Ok(false)
    }

    /// Asks along unit `n`, and makes the point a corner, one of at most three: for directions that
    /// are known to have found corners. [`Approach::settle`] tells the bounds.
    pub fn ask_again(&mut self, n: &Vec3) -> Result<(), Fault> {
        let point = self.sample(n)?;
        let place = self.simplex.place();
        self.set.place(place, n, &point);
        self.simplex.put(place, point.v);
        Ok(())
    }

    /// Does the point lie beyond the simplex, as seen along the way, by more than rounding?
    /// Only such a one is a corner of the next.
    fn beyond(&self, point: &SupportPoint) -> bool {
        if self.simplex.len() == 0 {
            return true;
        }
        let corner = self.set.v(self.simplex.ids()[0]);
        let ahead = self.way.dot(&(point.v - corner));
        ahead > 0.5 * self.inquiry.precision.touch() * self.way.norm()
    }

    fn add(&mut self, n: &Vec3, point: &SupportPoint) -> bool {
        let place = self.simplex.place();
        self.set.place(place, n, point);
        let precision = &self.inquiry.precision;
        let (touch, size2) = (precision.touch(), precision.size2());
        match self.simplex.add(place, point.v, touch, size2) {
            Some((way, distance2)) => {
                (self.way, self.upper) = (way, distance2.sqrt());
                false
            }
            None => {
                self.inside = Some(place);
                true
            }
        }
    }

    /// Asks along unit `n`, which a ball chose and which promises this distance, metres.
    fn try_out(&mut self, n: &Vec3, promise: f64) -> Result<bool, Fault> {
        let before = self.lower;
        let point = self.sample(n)?;
        let inside = self.beyond(&point) && self.add(n, &point);
        if !(self.lower - before >= KEPT * (promise - before)) {
            self.pause = self.penalty;
            self.penalty += 2;
        }
        Ok(inside)
    }

    /// The simplex's corners with the ball taken off.
    pub fn bare(&self) -> [Vec3; 3] {
        let ids = self.simplex.ids();
        ids.map(|i| self.set.v(i) - self.set.direction(i) * self.ball)
    }

    /// The direction that the ball foretells to be best, and the distance, metres, that it
    /// promises there; none where that is not worth a support point.
    fn aim(&self, tolerance: f64) -> Option<(Vec3, f64)> {
        if !(self.ball > 0.0) || self.pause > 0 {
            return None;
        }
        let [a, b, c] = self.bare();
        let origin = Vec3::zeros();
        let w = match self.simplex.len() {
            1 => a,
            2 => barycentric::segment(&origin, &a, &b).point,
            _ => barycentric::triangle(&origin, &a, &b, &c).point,
        };
        let n = direction(&-w)?;
        let promise = w.norm() - self.ball;
        let gain = promise - self.lower;
        (gain > WORTH * tolerance && promise < self.upper + tolerance).then_some((n, promise))
    }

    /// The way and the distance anew, from every face of the simplex.
    pub fn settle(&mut self) {
        let (way, distance2) = self.simplex.settle(self.inquiry.precision.touch());
        (self.way, self.upper) = (way, distance2.sqrt());
    }

    /// The points of the objects whose difference is the simplex's point nearest to the origin.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        self.simplex.witnesses(&self.set, self.inside)
    }
}

/// From a unit direction that separates to one that separates by a good part of the
/// distance, and so for longer while the objects move: steps of the distance algorithm until
/// the margin −n·s(n) is [`WIDE`] enough. Returns n and its margin, metres.
///
/// # Errors
/// A callback's answer that is not finite.
pub fn separate<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    separating: &Vec3,
) -> Result<(Vec3, f64), Fault> {
    let mut approach = Approach::new(inquiry);
    approach.ask(separating)?;
    approach.run(&Goal {
        tolerance: 0.0,
        share: 1.0 - WIDE,
        margin: 0.0,
        far: f64::INFINITY,
        iterations: WIDENING,
    })?;
    Ok((approach.normal, larger(approach.lower, 0.0)))
}

/// The share of the distance that is wide enough.
const WIDE: f64 = 0.8;
/// Support points that [`separate`] may ask for.
const WIDENING: u64 = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::shapes::{Random, ball, capsule, corners, hull, placed};

    /// Boxes face to face and balls: the bounds close around the known distance, and the points
    /// are that far apart.
    #[test]
    fn bounds_meet_at_the_distance() {
        let mut r = Random::new(61);
        for round in 0..200 {
            let gap = r.within(1e-3, 2.0);
            let turn = r.rotation();
            let cube = placed(&corners(Vec3::repeat(0.5)), &turn, Vec3::zeros());
            let at = turn * Vec3::new(r.within(-0.9, 0.9), 0.0, 1.0 + gap);
            let other = placed(&corners(Vec3::repeat(0.5)), &turn, at);
            let (a, b) = if round % 2 == 0 {
                (hull(&cube), hull(&other))
            } else {
                let up = turn * Vec3::z();
                (ball(up * 0.5, 0.5), ball(-up * (0.5 + gap), 0.5))
            };
            let md = MinkowskiDifference::new(&a, &b);
            let mut inquiry = Inquiry::new(&md);
            let mut approach = Approach::new(&mut inquiry);
            approach.ask(&r.direction()).unwrap();
            while approach.upper - approach.lower > 1e-6 && approach.iterations < 60 {
                assert_ne!(approach.step(1e-6).unwrap(), Some(End::Inside));
            }
            let (p, q) = approach.witnesses();
            assert!((approach.lower - gap).abs() <= 1e-5, "round {round}");
            assert!(((p - q).norm() - gap).abs() <= 1e-5, "round {round}");
        }
    }

    /// A direction that hardly separates, if at all, is turned to one that separates by most of the distance.
    #[test]
    fn a_separating_direction_is_turned() {
        let mut r = Random::new(62);
        for _ in 0..200 {
            let gap = r.within(0.01, 1.0);
            let up = r.direction();
            let a = capsule(up * -0.6, up * -0.2, 0.2);
            let b = ball(up * (0.2 + gap), 0.2);
            let md = MinkowskiDifference::new(&a, &b);
            let mut inquiry = Inquiry::new(&md);
            let (n, margin) =
                separate(&mut inquiry, &(up + r.direction() * 0.9).normalize()).unwrap();
            let h = n.dot(&md.support(&n).unwrap().v);
            assert!((margin + h).abs() <= 1e-6 && margin >= WIDE * gap - 1e-6);
            assert!(md.supports() <= WIDENING + 1);
        }
    }
}
