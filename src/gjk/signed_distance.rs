// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How far apart two objects are, or how deep they overlap: one continuous function.
//!
//! The signed distance is −min h(n) over unit n, apart and overlapping alike: apart the
//! minimum is the one plane between the objects that is farthest from both, overlapping it is the
//! penetration depth. For *any* n, −h(n) is a lower bound (moving obj2 nearer by it along
//! n keeps the plane between them), and apart any two points of the objects are an upper
//! one. Apart both come from the distance algorithm ([`crate::gjk::distance`]): the simplex's
//! nearest point, and the support plane asked across the way to it. Overlapping they are the
//! global minimum's.
//!
//! **Margins** are balls added all around: h grows by their radii, for every n. The signed
//! distance of the rounded objects is that of the cores less both margins, exactly, on both
//! sides of the touch.
//!
//! The centres and the state choose where to look first, and prove nothing.

use crate::contact::{Answer, Penetration, Settings};
use crate::gjk::barycentric;
use crate::gjk::distance::{Simplex, direction, witnesses};
use crate::known::precision::Precision;
use crate::known::support::{Fault, SupportMap, SupportPoint};
use crate::known::support_set::{Inquiry, SupportSet};
use crate::math::{EPSILON, Real, Vec3, larger, unit};
use crate::{query::Pair, state::State};

/// What is asked for besides the objects.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Radius of the ball around obj1, metres, not negative.
    pub margin1: Real,
    /// Radius of the ball around obj2, metres, not negative.
    pub margin2: Real,
    /// Distances greater than this need not be refined, metres.
    pub beyond: Real,
    /// The tolerance is the width of the bounds.
    pub settings: Settings,
}

impl Wanted {
    fn margin(&self) -> Real {
        self.margin1 + self.margin2
    }
}

/// How far apart, or how deep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// −h(normal), metres: proven, apart and overlapping.
    pub lower: Real,
    /// Proven too, metres.
    pub upper: Real,
    /// Unit, the way obj2 moves to be farther.
    pub normal: Vec3,
    /// On the surface of obj1 with its margin.
    pub point1: Vec3,
    /// On the surface of obj2 with its margin.
    pub point2: Vec3,
    /// Of the solver.
    pub iterations: u64,
    /// Overlap; a touch within rounding is none, and its distance is 0.
    pub hit: bool,
    /// The iterations were used up before the bounds met.
    pub limit: bool,
}

/// What the distance algorithm leaves of two cores.
enum Cores {
    /// Apart, or touching within rounding.
    Apart(Gap),
    /// They overlap, or so nearly that only a proof tells. Along this unit direction
    /// the overlap was least.
    Overlap(Vec3),
}

/// The gap between two cores.
#[derive(Clone, Copy)]
struct Gap {
    lower: Real,
    normal: Vec3,
    point1: Vec3,
    point2: Vec3,
    iterations: u64,
    limit: bool,
    /// Rounding of it, metres.
    touch: Real,
}

/// The signed distance of a pair's objects with their margins. `minimum` is the global
/// minimum of the depth of objects that overlap.
pub fn signed_distance<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
    minimum: impl Fn(&Pair<A, B>, &mut State, &Settings) -> Result<Answer, Fault>,
) -> Result<Distance, Fault> {
    // Cores that overlapped are asked for their depth at once.
    let overlapped = state.overlapped();
    if overlapped {
        match minimum(pair, state, &wanted.settings)? {
            Answer::Hit(hit) => return Ok(deep(&hit, wanted, false)),
            Answer::Limit(hit) => return Ok(deep(&hit, wanted, true)),
            Answer::Miss(_) => {}
        }
    }
    let start = match cores(pair, state, wanted)? {
        Cores::Apart(gap) => return Ok(apart(&gap, wanted)),
        Cores::Overlap(n) => n,
    };
    *state = State::guess(&start);
    match minimum(pair, state, &wanted.settings)? {
        Answer::Hit(hit) => Ok(deep(&hit, wanted, false)),
        Answer::Limit(hit) => Ok(deep(&hit, wanted, true)),
        Answer::Miss(normal) => Ok(apart(&touching(pair, &normal)?, wanted)),
    }
}

/// Where the cores touch: the proof's word, whatever one support value says of it.
fn touching<A: SupportMap, B: SupportMap>(pair: &Pair<A, B>, normal: &Vec3) -> Result<Gap, Fault> {
    let mut inquiry = Inquiry::new(&pair.md);
    let mut set = SupportSet::<TOUCHED>::EMPTY;
    let point = inquiry.point(normal)?;
    set.push(normal, &point);
    let h = normal.dot(&point.v);
    let touch = larger(inquiry.precision.touch(), h.abs());
    let (point1, point2, _) = witnesses(
        &mut inquiry,
        &mut set,
        &(normal * h),
        normal,
        touch,
        TOUCHED,
    )?;
    Ok(Gap {
        lower: -h,
        normal: *normal,
        point1,
        point2,
        iterations: 0,
        limit: false,
        touch,
    })
}

/// The answer for cores that overlap by this much.
fn deep(hit: &Penetration, wanted: &Wanted, limit: bool) -> Distance {
    let n = hit.normal;
    let margin = wanted.margin();
    // No depth is minus nothing.
    let lower = if hit.depth + margin > 0.0 {
        -hit.depth - margin
    } else {
        0.0
    };
    Distance {
        lower,
        upper: larger(-hit.depth_lower - margin, lower),
        normal: n,
        point1: hit.point1 + n * wanted.margin1,
        point2: hit.point2 - n * wanted.margin2,
        iterations: hit.iterations,
        hit: lower < 0.0,
        limit,
    }
}

/// The answer for cores with this gap.
fn apart(gap: &Gap, wanted: &Wanted) -> Distance {
    let margin = wanted.margin();
    let between = gap.point2 - gap.point1;
    let length = between.norm();
    // Points of the surfaces on the line between the cores' points, as far apart as those
    // less the margins. Of points that touch the line is rounding.
    let along = if length > gap.touch {
        between / length
    } else {
        gap.normal
    };
    let touch = gap.touch + 4.0 * EPSILON * margin;
    let (mut lower, mut upper) = (gap.lower - margin, length - margin);
    if lower.abs() <= touch {
        lower = 0.0;
        upper = larger(upper, 0.0);
    }
    Distance {
        lower,
        upper: larger(upper, lower),
        normal: gap.normal,
        point1: gap.point1 + along * wanted.margin1,
        point2: gap.point2 - along * wanted.margin2,
        iterations: gap.iterations,
        hit: lower < 0.0,
        limit: gap.limit,
    }
}

/// Support points to find where a touch is. (Three of a face, and as many again for each of two
/// round parts: free.)
const TOUCHED: usize = 16;

/// Steps that bring the simplex no nearer before rounding is all that is left.
const STALLS: u32 = 3;

/// The gap between the cores, from the state, else from the centres, else from the caller's
/// first direction.
fn cores<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
) -> Result<Cores, Fault> {
    let mut search = Search::new(pair);
    let (mut nearest, mut stalls) = (Real::INFINITY, 0);
    let margin = wanted.margin();
    if !search.resume(state)? {
        let start = state.separating().unwrap_or_else(|| pair.cold_start());
        search.ask(&start)?;
    }
    let limit = loop {
        let touch = search.precision.touch();
        let tolerance = search.precision.tolerance(wanted.settings.tolerance);
        // A plane between the objects is wanted even where the tolerance would not ask.
        let far = search.lower - margin > wanted.beyond;
        let told = |search: &Search<'_, A, B>| {
            (search.lower - margin > -touch || !(search.upper - margin > touch))
                && search.upper - search.lower <= tolerance
        };
        if far || told(&search) {
            // In the plane of a touching face the last point was no nearer than others.
            search.settle();
            if far || told(&search) {
                break false;
            }
        }
        let aim = search.aim(tolerance);
        if aim.is_none() {
            if !(search.upper < nearest) {
                stalls += 1;
            }
            nearest = search.upper;
        }
        let plain = direction(&search.way).filter(|_| stalls <= STALLS);
        if plain.is_none() && !(search.lower >= -touch) {
            return Ok(Cores::Overlap(search.normal));
        }
        // The cap on iterations, or callbacks that err by more than rounding.
        let (Some(plain), true) = (plain, search.iterations < wanted.settings.max_iterations)
        else {
            break true;
        };
        let inside = match aim {
            Some((n, promise)) => search.try_out(&n, promise)?,
            None => search.ask(&plain)?,
        };
        if inside {
            return Ok(Cores::Overlap(search.normal));
        }
    };
    let (point1, point2) = search.simplex.witnesses(&search.set, &Vec3::zeros());
    let gap = Gap {
        lower: search.lower,
        normal: search.normal,
        point1,
        point2,
        iterations: search.iterations,
        limit,
        touch: search.precision.touch(),
    };
    search.leave(state);
    Ok(Cores::Apart(gap))
}

/// The distance algorithm on two cores.
///
/// **Balls are taken off to choose where to ask.** On a round part of D of radius ρ the points
/// of directions n are s = u + ρ n around a fixed u, and two of them tell ρ: with
/// e = n′·(s′ − s) and e′ = n·(s − s′), which agree there, ρ = (e + e′) / |n′ − n|². The point
/// nearest to the origin of the corners u tells the way to ask, which for balls rolled over
/// a polytope is the right one at once, where the simplex itself would take many halvings.
/// It promises a distance; one that was not kept is not asked for a while.
///
/// **Warm**, the directions that found the corners are asked again. Where a face is nearest,
/// three find its corners and a fourth proves its plane: fewer cannot do, for after any turn a
/// support point says nothing of another direction's. (Measured on six slow motions, the `_trajS` pair
/// sets, moved apart, tolerance 1e-6: boxes and hulls 4.0 to 4.2 support points, 6.3 in the mean of all.)
struct Search<'p, A, B> {
    pair: &'p Pair<A, B>,
    set: SupportSet<4>,
    simplex: Simplex,
    precision: Precision,
    /// The greatest −h(n), metres, and its n.
    lower: Real,
    normal: Vec3,
    /// From the simplex to the origin, of any length, and the distance, metres.
    way: Vec3,
    upper: Real,
    /// The last direction asked, and its point.
    last: Option<(Vec3, Vec3)>,
    /// Radius of the ball taken off, metres; 0 for none.
    ball: Real,
    /// Steps without a try, and how many the next failure costs.
    pause: u32,
    penalty: u32,
    iterations: u64,
}

/// How far the two measures of a ball may differ, as a share of their sum. (Measured on the
/// random sets moved apart: a fifth of it costs ellipsoids one support point more, six times
/// it boxes 0.3 and cylinders 0.7.)
const ALIKE: Real = 0.05;
/// The share of what a ball promises that makes it believed again. (Free.)
const KEPT: Real = 0.5;
/// Corners nearer to each other than this share of the size, once the ball is off, are one
/// round part. (Free.)
const ONE_PART: Real = 0.02;

impl<'p, A: SupportMap, B: SupportMap> Search<'p, A, B> {
    fn new(pair: &'p Pair<A, B>) -> Self {
        Self {
            pair,
            set: SupportSet::EMPTY,
            simplex: Simplex::new(),
            precision: Precision::default(),
            lower: -Real::INFINITY,
            normal: Vec3::x(),
            way: Vec3::x(),
            upper: Real::INFINITY,
            last: None,
            ball: 0.0,
            pause: 0,
            penalty: 1,
            iterations: 0,
        }
    }

    /// Asks along unit `n`, and learns what there is to learn without the simplex.
    fn sample(&mut self, n: &Vec3) -> Result<SupportPoint, Fault> {
        self.iterations += 1;
        let point = self.pair.md.support(n)?;
        self.precision.note(&point);
        let lower = -n.dot(&point.v);
        if lower > self.lower {
            (self.lower, self.normal) = (lower, *n);
        }
        if let Some((m, v)) = self.last {
            let (e, f) = (n.dot(&(point.v - v)), m.dot(&(v - point.v)));
            let ball = (e + f) / (n - m).norm_squared();
            // Not rounding, not two corners of a polytope, not larger than D.
            let rounding = self.precision.touch();
            if e + f > 4.0 * rounding
                && (e - f).abs() <= ALIKE * (e + f)
                && ball < self.precision.size()
            {
                self.ball = ball;
            }
        }
        self.last = Some((*n, point.v));
        Ok(point)
    }

    /// Asks along the way of the simplex, unit `n`, or anywhere where there is none.
    /// Returns whether the new simplex holds the origin.
    fn ask(&mut self, n: &Vec3) -> Result<bool, Fault> {
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

    /// Does the point lie beyond the simplex, as seen along the way, by more than rounding?
    /// Only such a one is a corner of the next.
    fn beyond(&self, point: &SupportPoint) -> bool {
        if self.simplex.len() == 0 {
            return true;
        }
        let corner = self.set.v(self.simplex.ids()[0]);
        let ahead = self.way.dot(&(point.v - corner));
        ahead > 0.5 * self.precision.touch() * self.way.norm()
    }

    fn add(&mut self, n: &Vec3, point: &SupportPoint) -> bool {
        let place = self.simplex.place();
        self.set.place(place, n, point);
        let (touch, size2) = (self.precision.touch(), self.precision.size2());
        match self.simplex.add(place, point.v, touch, size2) {
            Some((way, distance2)) => {
                (self.way, self.upper) = (way, distance2.sqrt());
                false
            }
            None => true,
        }
    }

    /// Asks along unit `n`, which a ball chose and which promises this distance, metres.
    fn try_out(&mut self, n: &Vec3, promise: Real) -> Result<bool, Fault> {
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
    fn bare(&self) -> [Vec3; 3] {
        let ids = self.simplex.ids();
        ids.map(|i| self.set.v(i) - self.set.direction(i) * self.ball)
    }

    /// The direction that the ball foretells to be best, and the distance, metres, that it
    /// promises there; none where that is not worth a support point.
    fn aim(&self, tolerance: Real) -> Option<(Vec3, Real)> {
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
        // (A third of the tolerance: less is not worth it, and rounding is less.)
        (gain > 0.3 * tolerance && promise < self.upper + tolerance).then_some((n, promise))
    }

    /// The way and the distance anew, from every face of the simplex.
    fn settle(&mut self) {
        let (way, distance2) = self.simplex.settle(self.precision.touch());
        (self.way, self.upper) = (way, distance2.sqrt());
    }

    /// Starts from the directions that the state holds, if it holds any.
    fn resume(&mut self, state: &State) -> Result<bool, Fault> {
        let (corners, ball) = state.nearest();
        for n in corners.iter().filter_map(unit) {
            let point = self.sample(&n)?;
            let place = self.simplex.place();
            self.set.place(place, &n, &point);
            self.simplex.put(place, point.v);
        }
        if self.iterations == 0 {
            return Ok(false);
        }
        // What the state says of it counts where the points say nothing.
        if self.ball == 0.0 && ball > 0.0 && ball < self.precision.size() {
            self.ball = ball;
        }
        self.settle();
        Ok(true)
    }

    /// Leaves the directions behind that find the corners again: one for each part, the
    /// best direction for the part that it touches.
    fn leave(&self, state: &mut State) {
        let ids = self.simplex.ids();
        let bare = self.bare();
        let near2 = ONE_PART * ONE_PART * self.precision.size2();
        let mut directions = [Vec3::zeros(); 3];
        for i in 0..self.simplex.len().min(3) {
            let alone = (0..i).all(|k| (bare[k] - bare[i]).norm_squared() > near2);
            if self.ball == 0.0 || alone {
                directions[i] = self.set.direction(ids[i]);
            }
        }
        if directions[1] == directions[2] {
            directions[0] = self.normal;
        }
        // The length is the margin to aim at; a touch has none.
        let margin = larger(self.lower, self.precision.touch());
        *state = State::near(self.normal * margin, directions, self.ball);
    }
}
