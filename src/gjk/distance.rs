// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How far apart two objects are: the distance algorithm of Gilbert, Johnson and Keerthi (1988),
//! between two bounds.
//!
//! For any unit n, −h(n) is a lower bound on the distance: D lies behind its support plane. The
//! point of the simplex nearest to the origin is an upper one. [`Approach::step`] asks where the
//! bounds are to meet, and [`Approach::run`] goes on until they do. Called by
//! [`crate::gjk::signed_distance`].
//!
//! **Balls are taken off to choose where to ask.** On a round part of D of radius ρ the points
//! of directions n are s = u + ρ n around a fixed u, and two of them tell ρ: with
//! e = n′·(s′ − s) and e′ = n·(s − s′), which agree there, ρ = (e + e′) / |n′ − n|². The point
//! nearest to the origin of the corners u tells the way to ask, which for balls rolled over
//! a polytope is the right one at once, where the simplex itself would take many halvings.
//! It promises a distance; after one that was not kept the next step is the simplex's.

use crate::contact::Settings;
use crate::gjk::barycentric;
use crate::gjk::simplex::{Simplex, direction};
use crate::known::support::{Fault, SupportMap, SupportPoint};
use crate::known::support_set::{Inquiry, SupportSet};
use crate::math::{Real, Vec3};

/// How far the two measures of a ball may differ, as a share of their sum. (Measured on the
/// random sets moved apart: a fifth of it costs ellipsoids one support point more, six times
/// it boxes 0.3 and cylinders 0.7.)
const ALIKE: Real = 0.05;
/// The share of what a ball promises that makes it believed again. Insensitive: 0.25 to 0.75 tried
/// on the distances of the recorded contacts, at most 0.3 %.
const KEPT: Real = 0.5;
/// The share of the tolerance that a promise must be worth: less does not pay for a support
/// point, and rounding is less. Insensitive: 0.1 to 1 tried there.
const WORTH: Real = 0.3;
/// Steps that bring the simplex no nearer before rounding is all that is left.
const STALLS: u32 = 3;

/// Where an approach ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The bounds have met, or the objects are far apart.
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
    pub lower: Real,
    /// See `lower`; any before the first point.
    pub normal: Vec3,
    /// From the simplex to the origin, of any length.
    way: Vec3,
    /// Its length, metres: the least so far was `nearest`.
    pub upper: Real,
    nearest: Real,
    stalls: u32,
    /// The last direction asked, and its point.
    last: Option<(Vec3, Vec3)>,
    /// Radius of the ball taken off, metres; 0 for none.
    pub ball: Real,
    /// Was the last promise not kept?
    is_broken: bool,
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
            lower: -Real::INFINITY,
            normal: Vec3::x(),
            way: Vec3::x(),
            upper: Real::INFINITY,
            nearest: Real::INFINITY,
            stalls: 0,
            last: None,
            ball: 0.0,
            is_broken: false,
            iterations: 0,
        }
    }

    /// From support point to support point, until the bounds are as near as the tolerance, or what is
    /// left of the distance without the `margin`, metres, is known to be more than `far`: a plane between
    /// the objects is wanted, and the tolerance does not tell a touch from a gap.
    pub fn run(&mut self, settings: &Settings, margin: Real, far: Real) -> Result<End, Fault> {
        loop {
            let (touch, tolerance) = {
                let precision = &self.inquiry.precision;
                (precision.touch(), precision.tolerance(settings.tolerance))
            };
            let (lower, upper) = (self.lower - margin, self.upper - margin);
            // A plane between the objects is wanted even where the width would not ask.
            let told = lower > -touch || !(upper > touch);
            if lower > far || told && self.upper - self.lower <= tolerance {
                return Ok(End::Met);
            }
            if self.iterations >= settings.max_iterations {
                return Ok(End::Limit);
            }
            if let Some(end) = self.step(tolerance)? {
                return Ok(end);
            }
        }
    }

    /// One more support point, for bounds that are to come within `tolerance`, metres: where a ball
    /// foretells the distance, else along the way. Asks for none where that is stalled.
    fn step(&mut self, tolerance: Real) -> Result<Option<End>, Fault> {
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
        self.is_broken = false;
        Ok(self.beyond(&point) && self.add(n, &point))
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
    fn try_out(&mut self, n: &Vec3, promise: Real) -> Result<bool, Fault> {
        let before = self.lower;
        let point = self.sample(n)?;
        let inside = self.beyond(&point) && self.add(n, &point);
        self.is_broken = !(self.lower - before >= KEPT * (promise - before));
        Ok(inside)
    }

    /// The simplex's corners with the ball taken off.
    pub fn bare(&self) -> [Vec3; 3] {
        let ids = self.simplex.ids();
        ids.map(|i| self.set.v(i) - self.set.direction(i) * self.ball)
    }

    /// The direction that the ball foretells to be best, and the distance, metres, that it
    /// promises there; none where that is not worth a support point.
    fn aim(&self, tolerance: Real) -> Option<(Vec3, Real)> {
        if !(self.ball > 0.0) || self.is_broken {
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

    /// The points of the objects whose difference is the simplex's point nearest to the origin.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        self.simplex.witnesses(&self.set, self.inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::support::MinkowskiDifference;
    use crate::shapes::{Random, ball, corners, hull, placed};

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
}
