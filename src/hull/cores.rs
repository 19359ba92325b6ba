// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where to ask for a proof without a hull, where an object is round.
//!
//! Over what is round the normals of portals halve the way to the minimum, one question each. But with
//! its balls and discs taken off ([`crate::known::round`]) D is a polytope Q, as far as a portal reaches,
//! and where D's minimum is three vertices of Q tell: three that differ span a face, whatever is round
//! about it; two an edge, about which the normal turns; one a vertex. With R(n) what was taken off, and
//! v(n) = q + R(n) the point of D along n, the depth n·v(n) is least where v(n) is parallel to n, across
//! the edge if there is one: Newton's method, in one dimension or two; of balls alone there is a formula.
//!
//! Where that has come true, what holds the portal back are corners that were found farther beside the
//! minimum than the tolerance lets what is round fall back. They are asked for again from near to it.
//!
//! *It chooses where to ask, and proves nothing*: a ball is believed after two points, a disc after
//! three, and neither once it has foretold what is not so.

use crate::hull::portal::Portal;
use crate::known::points::Points;
use crate::known::round::{Disc, Seen, TOLD};
use crate::known::support_set::Lowest;
use crate::math::{EPSILON, Vec3, normalised, perpendicular};

/// The square of the sine of the angle up to which the moves of a point and of its direction are parallel:
/// a ball's. Derived: a tenth of what [`TOLD`] leaves of a move.
const PARALLEL: f64 = 0.01 * TOLD * TOLD;
/// The share of the size within which two vertices of Q are one, and a disc is confirmed by a third point.
/// Derived: what is left of a disc that two points tell.
const SAME: f64 = if EPSILON > 1e-10 { 1e-3 } else { 1e-6 };
/// The excesses of two points of a disc over each other's planes are alike within this factor, or it is not
/// looked for. Insensitive: 1.5 and 3 tried, as all below, on the recorded contacts.
const ALIKE: f64 = 2.0;
/// Smooth pairs with one point of which none is a disc's, after which none is looked for. Measured in
/// MuJoCo's pile, a hit of an ellipsoid: with 3 it takes 4 % more time, where one is always looked for
/// 60 % more; the recorded contacts take the same.
const ENOUGH: u32 = 2;
/// Steps of Newton's method: mostly two are taken.
const STEPS: usize = 4;
/// Radians of a step after which there is none. Derived: the next one is its square.
const NEAR: f64 = 1e-3;
/// The share of the tolerance that a minimum is to be lower by to be asked for. Insensitive: 0.03 and 0.3.
const PROMISE: f64 = 0.1;
/// The share of what was foretold that may be missed. Insensitive: 0.05 and 0.5.
const MISSED: f64 = 0.2;
/// A corner beside an edge is looked for along it too, by this share of across. Insensitive: 0.2 and 1.
const ALONG: f64 = 0.5;

/// What is round of one object.
#[derive(Clone, Copy)]
struct Part {
    /// Metres; 0 where nothing is yet, negative where nothing will be ([`Part::NEITHER`]).
    radius: f64,
    /// Of a disc, unit; zero of a ball.
    axis: Vec3,
}

/// What is round of the two objects, obj2's turned about.
pub struct Cores {
    parts: [Part; 2],
    /// The depth that was foretold last, metres.
    foretold: f64,
    /// Was it not as deep?
    failed: bool,
    /// The corner that was asked for last.
    corner: Vec3,
    /// Has it come true?
    is_at: bool,
    /// The edge of Q that it is about, unit; else zero.
    edge: Vec3,
}

/// Where to ask, and for what.
#[derive(Clone, Copy)]
pub enum Aim {
    /// What is above the portal.
    Normal(Vec3),
    /// The minimum.
    Minimum(Vec3),
    /// A corner beside it.
    Beside(Vec3),
}

impl Part {
    /// Smooth, and neither a ball nor a disc: an ellipsoid's. Beside the other object's radius it is nothing.
    const NEITHER: Self = Self {
        radius: -f64::MIN_POSITIVE,
        axis: Vec3::new(0.0, 0.0, 0.0),
    };

    /// How far its farthest point along unit `n` is from the vertex that carries it.
    #[inline(always)]
    fn point(&self, n: &Vec3) -> Vec3 {
        if self.is_ball() {
            return n * self.radius;
        }
        let across = n - self.axis * self.axis.dot(n);
        across * (self.radius / across.norm())
    }

    /// Is it no disc?
    #[inline(always)]
    fn is_ball(&self) -> bool {
        self.axis == Vec3::zeros()
    }
}

impl Cores {
    pub const NONE: Self = Self {
        parts: [Part {
            radius: 0.0,
            axis: Vec3::new(0.0, 0.0, 0.0),
        }; 2],
        foretold: 0.0,
        failed: false,
        corner: Vec3::new(0.0, 0.0, 0.0),
        is_at: false,
        edge: Vec3::new(0.0, 0.0, 0.0),
    };

    /// Where the portal is to be asked for, if that is told by what is round.
    #[inline(never)]
    pub fn aim(
        &mut self,
        points: &Points,
        portal: &Portal,
        lowest: &Lowest,
        (size2, tolerance): (f64, f64),
        early: bool,
    ) -> Option<Aim> {
        if !self.is_at {
            for o in 0..2 {
                // What shows a point twice is a polytope.
                if self.parts[o].radius == 0.0 && points.is_new(o) {
                    self.look(points, o, size2);
                }
            }
        }
        let [r, s] = [self.parts[0].radius, self.parts[1].radius];
        // Of an object that is not round, and has shown another point each time, others are to come.
        let fresh = |o: usize, radius: f64| !(radius > 0.0) && (early || points.is_new(o));
        // Of two discs the first portal tells little.
        let discs = early && !self.parts.iter().any(Part::is_ball);
        if discs || fresh(0, r) || fresh(1, s) {
            return None;
        }
        let radius = r + s;
        if self.failed || !(radius > 0.0) {
            return None;
        }
        if !self.is_at {
            let n = self.foretell(points, portal, lowest, size2, tolerance)?;
            if n.is_some() {
                return n.map(Aim::Minimum);
            }
        }
        self.beside(portal, &lowest.dir, tolerance / radius)
            .map(Aim::Beside)
    }

    /// Where the minimum is; `None` within, where that is the lowest direction. `None`: nothing is told.
    #[inline(always)]
    fn foretell(
        &mut self,
        points: &Points,
        portal: &Portal,
        lowest: &Lowest,
        size2: f64,
        tolerance: f64,
    ) -> Option<Option<Vec3>> {
        let Lowest { depth, dir } = lowest;
        let same2 = SAME * SAME * size2;
        // Spelt out: a map would go by way of memory.
        let [a, b, c] = portal.names;
        let q = [
            self.vertex(points, a),
            self.vertex(points, b),
            self.vertex(points, c),
        ];
        let n;
        (n, self.edge) = self.minimum(&q, dir, same2)?;
        self.foretold = n.dot(&(q[0] + self.round(&n).0));
        if self.foretold > depth + tolerance {
            return None;
        }
        Some((self.foretold < depth - PROMISE * tolerance).then_some(n))
    }

    /// Where the corner farthest below the lowest plane is to be asked for, as far beside that as a point of
    /// a ball of the radius whose tolerance this is, in radii, is half the tolerance below: `tilt2`.
    #[inline(always)]
    fn beside(&mut self, portal: &Portal, dir: &Vec3, tilt2: f64) -> Option<Vec3> {
        let [a, b, c] = &portal.points;
        let (mut low, mut p) = (dir.dot(a), a);
        for q in [b, c] {
            let level = dir.dot(q);
            if level < low {
                (low, p) = (level, q);
            }
        }
        let mut u = p - dir * low;
        if self.edge != Vec3::zeros() {
            let along = self.edge.dot(&u);
            let across = u - self.edge * along;
            u = across * (1.0 / across.norm()) + self.edge * ALONG.copysign(along);
        }
        let n = dir + u * (tilt2 / u.norm_squared()).sqrt();
        // It is not asked twice.
        if (n - self.corner).norm_squared() < 1e-2 * tilt2 {
            return None;
        }
        self.corner = n;
        normalised(&n)
    }

    /// Are both objects smooth, and neither a ball nor a disc? A hull has a ring for them.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.parts.iter().all(|part| part.radius < 0.0)
    }

    /// What was foretold: has that come true?
    pub fn learn(&mut self, h: f64, before: f64) {
        self.is_at = h - self.foretold <= MISSED * (before - self.foretold);
        self.failed = !self.is_at;
    }

    /// What the point of object `o` that direction `k` found was asked along, and where it is.
    fn seen(points: &Points, o: usize, k: usize) -> Seen {
        let n = points.direction(k);
        let [p, q] = points.witnesses(points.names(k));
        let p = if o == 0 { p } else { -q };
        Seen { n, p }
    }

    /// Looks for a round part that the last point of object `o` shows with those before.
    fn look(&mut self, points: &Points, o: usize, size2: f64) {
        let last = points.asked() - 1;
        let new = Self::seen(points, o, last);
        let mut smooth = 0_u32;
        for j in 0..last {
            let old = Self::seen(points, o, j);
            let (d, dn) = (new.p - old.p, new.n - old.n);
            let (moved, turned, along) = (d.norm_squared(), dn.norm_squared(), d.dot(&dn));
            // No farther than an object of this size bends.
            if !(moved <= size2 * turned && turned > TOLD * TOLD && along > 0.0) {
                continue;
            }
            let aside2 = moved * turned - along * along;
            if aside2 <= PARALLEL * moved * turned {
                self.parts[o].radius = along / turned;
                return;
            }
            let ahead = d.dot(&new.n);
            let behind = along - ahead;
            if ahead < ALIKE * behind && behind < ALIKE * ahead {
                smooth |= 1 << j;
            }
        }
        let pairs = smooth.count_ones();
        for j in (0..last).rev().filter(|j| smooth >> j & 1 != 0) {
            let old = Self::seen(points, o, j);
            let Some(disc) = Disc::of(&old, &new) else {
                continue;
            };
            let core = new.p - disc.point(&new.n);
            for i in (0..last).filter(|i| *i != j) {
                let third = Self::seen(points, o, i);
                let apart = disc.across(&(third.p - disc.point(&third.n) - core));
                if apart.norm_squared() <= SAME * SAME * size2 {
                    let Disc { radius, axis } = disc;
                    self.parts[o] = Part { radius, axis };
                    return;
                }
            }
        }
        if pairs >= ENOUGH {
            self.parts[o] = Part::NEITHER;
        }
    }

    /// The vertex of Q of a corner of P.
    #[inline(always)]
    fn vertex(&self, points: &Points, names: [usize; 2]) -> Vec3 {
        let mut v = points.point(names);
        for (o, part) in self.parts.iter().enumerate() {
            if part.radius > 0.0 {
                v -= part.point(&points.direction(points.found(o, names[o]) as usize));
            }
        }
        v
    }

    /// R(n); and of its derivative the ball's part, and of each disc the way that it turns and how fast.
    #[inline(always)]
    fn round(&self, n: &Vec3) -> (Vec3, f64, [(Vec3, f64); 2]) {
        let (mut r, mut ball, mut turns) = (Vec3::zeros(), 0.0, [(Vec3::zeros(), 0.0); 2]);
        for (part, turn) in self.parts.iter().zip(&mut turns) {
            let Part { radius, axis } = part;
            if part.is_ball() {
                r += n * *radius;
                ball += radius;
            } else {
                let across = n - axis * axis.dot(n);
                let long2 = across.norm_squared();
                if long2 > EPSILON {
                    let bend = radius / long2.sqrt();
                    r += across * bend;
                    *turn = (axis.cross(&across), bend / long2);
                }
            }
        }
        (r, ball, turns)
    }

    /// Is nothing round but balls?
    fn is_ball(&self) -> bool {
        self.parts.iter().all(Part::is_ball)
    }

    /// The minimum of the depth of three vertices of Q, near the unit direction `dir`; and the edge that
    /// it is about, unit, if it is about one, else zero.
    fn minimum(&self, [a, b, c]: &[Vec3; 3], dir: &Vec3, same2: f64) -> Option<(Vec3, Vec3)> {
        let (x, y) = (b - a, c - a);
        let (x2, y2) = (x.norm_squared(), y.norm_squared());
        let (edge, other, e2) = if x2 > y2 { (x, y, x2) } else { (y, x, y2) };
        if !(e2 > same2) {
            return Some((self.about_vertex(a, dir)?, Vec3::zeros()));
        }
        let n = edge.cross(&other);
        if n.norm_squared() > same2 * e2 {
            let n = if n.dot(dir) < 0.0 { -n } else { n };
            return Some((normalised(&n)?, Vec3::zeros()));
        }
        let edge = edge * (1.0 / e2.sqrt());
        Some((self.about_edge(a, &edge, dir)?, edge))
    }

    fn about_edge(&self, a: &Vec3, e: &Vec3, dir: &Vec3) -> Option<Vec3> {
        if self.is_ball() {
            let w = e * e.dot(a) - a;
            return normalised(&w).filter(|n| n.dot(dir) > 0.0);
        }
        let mut n = normalised(&(dir - e * e.dot(dir)))?;
        for _ in 0..STEPS {
            let t = e.cross(&n);
            let (r, ball, turns) = self.round(&n);
            let v = a + r;
            let bend = turns.iter().fold(ball - n.dot(&v), |bend, (turn, fast)| {
                bend + fast * (turn.dot(&t) * turn.dot(&t))
            });
            let step = -t.dot(&v) / bend;
            if !(bend > 0.0 && step.abs() < 1.0) {
                return None;
            }
            n = normalised(&(n + t * step))?;
            if step.abs() < NEAR {
                break;
            }
        }
        Some(n)
    }

    fn about_vertex(&self, a: &Vec3, dir: &Vec3) -> Option<Vec3> {
        if self.is_ball() {
            return normalised(&-a).filter(|n| n.dot(dir) > 0.0);
        }
        let mut n = *dir;
        for _ in 0..STEPS {
            let s = perpendicular(&n);
            let t = n.cross(&s);
            let (r, ball, turns) = self.round(&n);
            let v = a + r;
            let level = ball - n.dot(&v);
            let (mut xx, mut xy, mut yy) = (level, 0.0, level);
            for (turn, fast) in &turns {
                let (x, y) = (turn.dot(&s), turn.dot(&t));
                (xx, xy, yy) = (xx + fast * x * x, xy + fast * x * y, yy + fast * y * y);
            }
            let (x, y) = (-s.dot(&v), -t.dot(&v));
            let det = xx * yy - xy * xy;
            let step = (s * (yy * x - xy * y) + t * (xx * y - xy * x)) * (1.0 / det);
            let step2 = step.norm_squared();
            if !(xx > 0.0 && det > 0.0 && step2 < 1.0) {
                return None;
            }
            n = normalised(&(n + step))?;
            if step2 < NEAR * NEAR {
                break;
            }
        }
        Some(n)
    }
}
