// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum penetration, proven: where to ask, and when the bounds meet
//! (expanding polytope; G. van den Bergen, "Proximity Queries and Penetration Depth
//! Computation on 3D Game Objects", GDC 2001).
//!
//! PD = min over unit n of h(n), h(n) = n·s(n) the support value of D. *Upper bound*: the
//! least h met; moving obj2 by h(n)·n separates the objects. *Lower bound*: the distance
//! from the origin to the nearest face of a polytope of support points ([`crate::hull::polytope`]).
//! The nearest face is expanded until its distance is no less than the *target*, the upper
//! bound less the tolerance; faces at least that far away are never looked at, so the
//! polytope stays coarse where no minimum is.
//!
//! The polytope need not hold the origin: a face with the origin outside is the nearest of
//! all. Whether the objects overlap is found on the way, and does not depend on the
//! tolerance: while a face has the origin outside, points count as above it by more than
//! rounding. A support value no greater than rounding ends the query: a touch is a miss.
//!
//! # Where the apex comes from
//!
//! The first tetrahedron has a point inside D for a corner, the apex. The MPR calls rely on
//! the centres' difference, as libccd does. Without centres, and in every query that
//! trusts none, it is the middle of two support points in opposite directions, which is in
//! D for certain.
//!
//! # Aims
//!
//! The normal of the nearest face finds the point farthest above it; the mean of normals
//! around it is asked where several faces are to go ([`Polytope::mean_normal`]). Near a
//! round part both are behind what curvature tells: two samples (n, s), (n′, s′) of a ball
//! of radius ρ agree on ρ = (e + e′)/|n′ − n|², e = n′·(s′ − s), e′ = n·(s − s′). With
//! v_i = s_i − ρ n_i of the face's corners, the ball's centre or the core that the ball is
//! around, the minimum is foretold at −w/|w| with the depth ρ − |w|, w the point of the
//! triangle v nearest to the origin; where the core holds the origin, along the normal of
//! that triangle. *It chooses where to ask, and proves nothing.*
//!
//! A face with the apex for a corner is near the origin where the axis passes an edge of the
//! first portal closely. What is wanted is a point beyond that edge, near the minimum; the
//! face's own normal lies a quarter turn aside. So the lowest direction is asked, tilted
//! across the edge.
//!
//! # Where rounding has the last word
//!
//! Where no support point is above the nearest face the search ends with what it has, and the
//! caller begins again elsewhere; if the origin is outside of that face, by rounding then, yes or no
//! is left to the caller.

use crate::gjk::barycentric;
use crate::hull::plane::Plane;
use crate::hull::polytope::{Polytope, Top};
use crate::known::precision::Precision;
use crate::known::support_set::{Asked, Inquiry, Lowest, Stop, SupportSet};
use crate::math::{Vec3, larger, lesser, normalised, unit};
use crate::minkowski::support::SupportMap;

// Measured: support points of MPR and the minimum in the mean of sixteen pair sets and the
// recorded contacts (`cargo bench -p charts -- record`), when one number changes alone.

/// A point above a face by less than this share of the tolerance counts as on it. Measured:
/// from 0.005 to 0.05 no set changes by 0.3 %; the planes' error stays below it.
const LEVEL: f64 = 0.02;
/// Tolerances below this share of the size are finer than interpolated planes: derived from
/// their error, 20 ulps a point, at 160 points; planes are double whatever points are.
const EXACT: f64 = 2e4 * f64::EPSILON as f64;
/// Points before means of normals are asked: fewer make no neighbourhood. Measured: 6 costs
/// boxes 6 %, 14 costs spheres 8 %.
const FEW: usize = 10;
/// Points from which on a share of the depth is near enough. Derived: what flat faces meet in takes fewer.
const MANY: usize = 16;
/// Relative difference of e and e′ up to which a pair is of one ball. Measured: 0.001 and 0.01
/// change the mean by 0.3 % at most, 0.03 costs 0.6 %.
const ALIKE: f64 = 0.003;
/// The share of the allowed gap that the ball must promise. Measured: 0.3 costs shallow
/// ellipsoids 3 %, 0.6 costs them 5 %.
const PROMISE: f64 = 0.1;
/// The share of a promise that may be missed before the ball is distrusted. Measured: 0.1 to
/// 0.5 change no set by 0.2 %.
const MISSED: f64 = 0.2;
/// Steps of distrust for each failure. Measured: 2 to 8 change no set by more than 1.1 %.
const PAUSE: i32 = 4;
/// The tilt across an edge, as the depth's share of its length. Measured: 2 to 8 take up to
/// 0.7 % more; without it motions take 3 %, hulls in motion 5 % more.
const ASIDE: f64 = 4.0;
/// Every so many steps the plain normal is asked. Insensitive: 16 to 64 tried on the recorded
/// contacts.
const LOWER: u64 = 32;
/// Steps without a change of the nearest distance. Insensitive, 12 to 48 tried on the recorded
/// contacts: more than the faces of a symmetric object that tie.
const CIRCLES: u32 = 24;
/// |n′ − n|² within which two samples tell of one ball: below it rounding speaks, above it
/// other parts of D do.
const NEIGHBOURS: core::ops::Range<f64> = if cfg!(feature = "single") {
    1e-4..0.5
} else {
    1e-8..0.5
};

/// How far a search goes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    /// Largest gap between the bounds, metres, as asked for.
    pub tolerance: f64,
    /// The same as a share of the depth, for a search of [`MANY`] points: there the larger of the two
    /// counts.
    pub gap: f64,
    /// Cap on the support points of the query, once the origin is inside the polytope.
    pub supports: u64,
    /// Cap on those after the first tetrahedron, likewise.
    pub iterations: u64,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The bounds meet.
    Proven,
    /// A cap came first; the origin is inside.
    Inside,
    /// Rounding came first; the origin is inside.
    Stuck,
    /// A cap or rounding came first, and the origin is not shown to be inside.
    Open,
    /// There is no room for another point.
    NoRoom,
}

/// What a search knows besides the points and the polytope. A face's *key* is the signed
/// square of its distance from the origin, m².
#[derive(Default)]
pub struct Progress {
    limits: Limits,
    /// Support points after the tetrahedron.
    pub iterations: u64,
    /// The key of the nearest face, and for how many steps on end it has not changed.
    same: (f64, u32),
    /// The least depth met, metres, as far as the target knows.
    upper: f64,
    /// What planes may be off by for the target, metres; at most half of `allowed`.
    error: f64,
    /// Are there [`MANY`] points? From then on [`Limits::gap`] counts too.
    coarse: bool,
    /// A nearest face with this key or a greater one proves the upper bound.
    target: f64,
    /// The tolerance in force, metres: [`Limits::tolerance`] within what the sizes allow.
    pub tolerance: f64,
    /// The gap between the bounds that is allowed, metres: `tolerance`, or more if `coarse`.
    allowed: f64,
    /// While the origin is outside, a point is above a face by more than this, metres.
    rounding: f64,
    /// Its square: a face with a key beyond has the origin inside for certain.
    rounding2: f64,
    /// Once the origin is inside, a point is above a face by more than this, metres.
    level: f64,
    /// The square of the size that tolerance, rounding and level belong to.
    size2: f64,
    /// No mean of normals is asked in so many steps.
    plain: i32,
    /// How many means were asked in vain.
    vain: i32,
    /// The key of the face whose mean, or what is aside of it, was in vain last: it is not asked
    /// twice.
    lone: f64,
    core: Core,
    /// The known points that are no corners, a bit each: while one of them is above the nearest
    /// face none has to be asked for.
    spare: u64,
}

/// The ball that the samples tell of, see the head of this file.
#[derive(Default)]
struct Core {
    /// Its radius, metres; 0 while none is known.
    radius: f64,
    /// It is not asked in so many steps.
    pause: i32,
    /// How many promises were not kept.
    failures: i32,
    /// The key of the face it was asked for last: it is not asked twice.
    key: f64,
    /// The support value promised then, metres.
    foretold: f64,
    /// The upper bound then, metres.
    before: f64,
}

/// What a direction was chosen by.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// The nearest face's normal.
    Normal,
    /// The mean of normals around that face.
    Mean,
    /// The lowest direction, tilted across an edge of the portal.
    Aside,
    /// The ball.
    Core,
}

impl Progress {
    /// Before the first step. `points`: how many there are, of which `names` are corners.
    #[inline(always)]
    pub fn new(limits: &Limits, precision: &Precision, points: usize, names: [usize; 4]) -> Self {
        // Of 64 at most, and not the apex.
        let known = (1 << points) - 2_u64;
        let mut progress = Self {
            limits: *limits,
            plain: FEW as i32 - points as i32,
            spare: names.iter().fold(known, |spare, name| spare & !(1 << name)),
            ..Self::default()
        };
        progress.resize(precision);
        progress
    }

    /// The sizes are these.
    #[inline(always)]
    fn resize(&mut self, precision: &Precision) {
        self.size2 = precision.size2();
        self.tolerance = precision.tolerance(self.limits.tolerance);
        self.rounding = rounding(precision);
        self.rounding2 = self.rounding * self.rounding;
        self.level = self.rounding + LEVEL * self.tolerance;
        self.upper = f64::INFINITY;
    }

    /// Sizes and bounds as they are now.
    #[inline(always)]
    fn update<A: SupportMap, B: SupportMap, const F: usize>(
        &mut self,
        inquiry: &Inquiry<'_, A, B>,
        hull: &mut Polytope<F>,
    ) {
        let precision = &inquiry.precision;
        let depth = inquiry.lowest.depth;
        if precision.size2() > self.size2 {
            self.resize(precision);
            hull.grow(precision.size());
        }
        if depth < self.upper {
            self.upper = depth;
            self.aim_at(hull.error() + hull.untold(depth) + precision.grain());
        }
    }

    /// The target for planes that are off by up to `error`, metres, or a tenth more later.
    fn aim_at(&mut self, error: f64) {
        // A share of the least depth, not of this one.
        let gap = self.limits.gap / (1.0 + self.limits.gap);
        self.allowed = if self.coarse {
            larger(gap * self.upper, self.tolerance)
        } else {
            self.tolerance
        };
        self.error = lesser(1.1 * error, 0.5 * self.allowed);
        let target = self.upper - self.allowed + self.error;
        self.target = target * target.abs();
    }

    /// The nearest face has come to the target: is that still so with the error that planes
    /// have by now? Else the target is moved outwards. And are all faces there for certain?
    #[inline(always)]
    fn proven<const F: usize>(&mut self, hull: &mut Polytope<F>, grain: f64) -> bool {
        let error = hull.error() + hull.untold(self.upper) + grain;
        let good = !(error > self.error) || 0.5 * self.allowed <= self.error;
        if !good {
            self.aim_at(error);
        }
        good && !hull.is_nearer(self.target)
    }

    /// Has the nearest distance been the same for many steps? Of a thin D rounding can give
    /// each new face the plane of the one it replaces.
    #[inline(always)]
    fn circles(&mut self, top: &Top) -> bool {
        let moved = (top.key - self.same.0).abs() > 1e-11 * top.key.abs() + self.rounding2;
        self.same = (top.key, if moved { 0 } else { self.same.1 + 1 });
        self.same.1 > CIRCLES
    }

    /// Makes a known point a corner that is above a face by more than `level`, metres, if there
    /// is one: was there room for it?
    #[inline(never)]
    fn spend<const P: usize, const F: usize>(
        &mut self,
        set: &SupportSet<P>,
        hull: &mut Polytope<F>,
        face: usize,
        level: f64,
    ) -> Option<bool> {
        let mut left = self.spare;
        while left != 0 {
            let i = left.trailing_zeros() as usize;
            let v = set.v(i);
            if hull.height(face, &Plane::point(&v)) > level {
                let done = hull.insert(face, i, &v, level, &|i| set.v(i));
                if done {
                    self.spare &= !(1 << i);
                }
                return Some(done);
            }
            left &= left - 1;
        }
        None
    }

    /// The end where rounding leaves nothing to do. A face through the origin, to rounding, shows
    /// neither inside nor outside.
    #[inline(always)]
    fn stuck(&self, top: &Top) -> End {
        if top.key > self.rounding2 {
            End::Stuck
        } else {
            End::Open
        }
    }

    /// A point is above a face by more than this, metres.
    #[inline(always)]
    fn level(&self, inside: bool) -> f64 {
        if inside { self.level } else { self.rounding }
    }

    /// Has one of the caller's caps come?
    #[inline(always)]
    fn is_spent(&self, supports: u64) -> bool {
        self.iterations >= self.limits.iterations || supports >= self.limits.supports
    }

    /// A direction that was chosen so has this support value.
    #[inline(always)]
    fn step(&mut self, aim: Aim, h: f64) {
        self.iterations += 1;
        self.plain -= 1;
        self.core.pause -= 1;
        self.core.learn(aim, h);
    }

    /// An aim found nothing above the nearest face. Of means that is a reason for plain normals
    /// for a while, longer each time.
    #[inline(always)]
    fn was_in_vain(&mut self, aim: Aim, top: &Top) {
        if aim != Aim::Core {
            self.lone = top.key;
        }
        if aim == Aim::Mean {
            self.vain += 1;
            self.plain = 1 + 2 * self.vain;
        }
    }

    /// There are many points: from here on [`Limits::gap`] counts too.
    #[cold]
    fn coarsen(&mut self) {
        self.coarse = true;
        self.upper = f64::INFINITY;
    }
}

/// A point above a face by no more than this, metres, is on it: products round, and the
/// points of both are uncertain.
fn rounding(precision: &Precision) -> f64 {
    precision.rounding() + 2.0 * precision.grain()
}

/// Is this tolerance finer than what interpolated planes are good for?
pub fn exact(tolerance: f64, precision: &Precision) -> bool {
    !(tolerance > EXACT * precision.size() && tolerance > 64.0 * precision.grain())
}

/// Expands the polytope at its nearest face until the bounds meet, or [`End`] says why not.
///
/// Each turn asks along one direction, unless one of the start's points that are no corners yet
/// is above the nearest face. A point above it becomes a corner. Else what was asked along
/// decides: a promise of the ball, a mean or a step aside that found nothing is
/// forgotten; a normal that found nothing shows that no point lies above the face, so either
/// the upper bound has fallen, or rounding ends the search.
#[inline(always)]
pub fn expand<A: SupportMap, B: SupportMap, const P: usize, const F: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<P>,
    hull: &mut Polytope<F>,
    progress: &mut Progress,
) -> Result<End, Stop> {
    // Ends: a turn asks, up to the caps (outside, to the room or [`Progress::circles`]), or
    // moves the target, by a tenth of the error until that is half of what is allowed.
    loop {
        if set.len() >= MANY && !progress.coarse {
            progress.coarsen();
        }
        let top = hull.nearest();
        progress.update(inquiry, hull);
        let inside = top.key >= 0.0;
        if top.key >= progress.target && inside {
            if progress.proven(hull, inquiry.precision.grain()) {
                return Ok(End::Proven);
            }
            continue;
        }
        let stuck = progress.stuck(&top);
        if progress.circles(&top) {
            return Ok(stuck);
        }
        // While the origin is outside, the room is the only cap: the caller's caps are not
        // to make a miss of an overlap.
        if inside && progress.is_spent(inquiry.md.supports()) {
            return Ok(End::Inside);
        }
        let level = progress.level(inside);
        if progress.spare != 0 {
            match progress.spend(set, hull, top.face, level) {
                Some(true) => continue,
                Some(false) => return Ok(End::NoRoom),
                None => {}
            }
        }
        if set.is_full() {
            return Ok(End::NoRoom);
        }
        let (dir, aim) = progress.aim(set, hull, &top, &inquiry.lowest);
        let Some(n) = normalised(&dir).or_else(|| unit(&hull.normal(top.face))) else {
            return Ok(stuck);
        };
        let before = inquiry.lowest.depth;
        let count = set.len();
        let Asked { i, h, v } = inquiry.ask(set, &n)?;
        progress.step(aim, h);
        let height = hull.height(top.face, &Plane::point(&v));
        if height > level {
            // The start's own points are far apart.
            if progress.iterations > 1 {
                progress
                    .core
                    .measure(set, &hull.corners(top.face), [&n, &v], level);
            }
            if hull.insert(top.face, i, &v, level, &|i| set.v(i)) {
                continue;
            }
            // Its direction is asked again in the larger room.
            set.truncate(count);
            return Ok(End::NoRoom);
        }
        match aim {
            // A lower upper bound moves the target nearer in the next turn.
            Aim::Normal if inquiry.lowest.depth < before => {}
            Aim::Normal => return Ok(stuck),
            _ => {
                set.truncate(count);
                progress.was_in_vain(aim, &top);
            }
        }
    }
}

impl Progress {
    /// The direction to ask for the nearest face, not unit, and what chose it.
    #[inline(always)]
    fn aim<const P: usize, const F: usize>(
        &mut self,
        set: &SupportSet<P>,
        hull: &Polytope<F>,
        top: &Top,
        lowest: &Lowest,
    ) -> (Vec3, Aim) {
        let normal = (hull.normal(top.face), Aim::Normal);
        // What finds the best corners need not lower the upper bound: between the minima of a ring
        // and a cap the mean of their normals never does.
        if !(top.key > 0.0) || self.iterations % LOWER == LOWER - 1 {
            return normal;
        }
        let known = top.key == self.lone;
        let names = hull.corners(top.face);
        if names.contains(&0) {
            return if known {
                normal
            } else {
                (aside(set, hull, top.face, lowest), Aim::Aside)
            };
        }
        if self.core.radius > 0.0 && self.core.pause <= 0 && self.core.key != top.key {
            if let Some(n) = self.core.aim(set, hull, top, self.upper, self.allowed) {
                return (n, Aim::Core);
            }
        }
        if self.plain <= 0 && !known {
            return (hull.mean_normal(top.face, self.target), Aim::Mean);
        }
        normal
    }
}

/// The direction for a face with the apex for a corner, see the head of this file. Not unit.
#[cold]
#[inline(never)]
fn aside<const P: usize, const F: usize>(
    set: &SupportSet<P>,
    hull: &Polytope<F>,
    face: usize,
    lowest: &Lowest,
) -> Vec3 {
    let [a, b, c] = hull.corners(face);
    let (a, b) = if a == 0 {
        (b, c)
    } else if b == 0 {
        (a, c)
    } else {
        (a, b)
    };
    let edge = set.v(b) - set.v(a);
    let normal = hull.normal(face);
    let long = (edge.norm_squared() * normal.norm_squared()).sqrt();
    lowest.dir + normal * (ASIDE * lowest.depth / long)
}

impl Core {
    /// The direction in which the ball promises a lower depth near the nearest face, where that
    /// is worth a support point.
    #[inline(always)]
    fn aim<const P: usize, const F: usize>(
        &mut self,
        set: &SupportSet<P>,
        hull: &Polytope<F>,
        top: &Top,
        upper: f64,
        allowed: f64,
    ) -> Option<Vec3> {
        let names = hull.corners(top.face);
        let [a, b, c] = names.map(|i| set.v(i) - set.direction(i) * self.radius);
        let normal = hull.normal(top.face);
        let (n, foretold) = if self.radius <= upper {
            let m = normalised(&(b - a).cross(&(c - a)))?;
            let m = if m.dot(&normal) < 0.0 { -m } else { m };
            (m, m.dot(&a) + self.radius)
        } else {
            // The minimum is no farther from the origin than a corner.
            let near = self.radius - (upper - PROMISE * allowed);
            if [a, b, c].iter().any(|v| v.norm_squared() <= near * near) {
                return None;
            }
            let w = barycentric::triangle(&Vec3::zeros(), &a, &b, &c).point;
            let m = normalised(&-w)?;
            (m, self.radius - w.norm())
        };
        let along = n.dot(&normal);
        // Within 45 degrees of the face's normal, and no touch.
        let ahead = along > 0.0 && along * along > 0.5 * normal.norm_squared();
        if !(ahead && foretold > 0.0 && foretold < upper - PROMISE * allowed) {
            return None;
        }
        (self.key, self.foretold, self.before) = (top.key, foretold, upper);
        Some(n)
    }

    /// Was the promise kept?
    #[inline(always)]
    fn learn(&mut self, aim: Aim, h: f64) {
        if aim == Aim::Core && h > self.foretold + MISSED * (self.before - self.foretold) {
            self.failures += 1;
            self.pause = PAUSE * self.failures;
        }
    }

    /// The radius that a new sample, its direction and point, and the corners of the face it is
    /// above tell.
    #[inline(always)]
    fn measure<const P: usize>(
        &mut self,
        set: &SupportSet<P>,
        corners: &[usize; 3],
        new: [&Vec3; 2],
        least: f64,
    ) {
        // The newest corner is the last; the first one is mostly the oldest and far away.
        for &i in corners.iter().rev().take(2) {
            if i > 0 && self.pair([&set.direction(i), &set.v(i)], new, least) {
                return;
            }
        }
    }

    /// The radius that two samples tell: are they of one ball?
    #[inline(always)]
    fn pair(&mut self, [n, s]: [&Vec3; 2], [n_, s_]: [&Vec3; 2], least: f64) -> bool {
        let turn2 = 2.0 - 2.0 * n.dot(n_);
        if !NEIGHBOURS.contains(&turn2) {
            return false;
        }
        let between = s_ - s;
        let (e, e_) = (n_.dot(&between), -n.dot(&between));
        let sum = e + e_;
        let alike = (e - e_).abs() <= ALIKE * sum && sum > least;
        if alike {
            self.radius = sum / turn2;
        }
        alike
    }
}
