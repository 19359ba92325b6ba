// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How far apart two objects are, or how deep they overlap: one continuous function.
//!
//! The signed distance is −min h(n) over unit n, apart and overlapping alike: apart the
//! minimum is the one plane between the objects that is farthest from both, overlapping it is the
//! penetration depth. For *any* n, −h(n) is a lower bound (moving obj2 nearer by it along
//! n keeps the plane between them), and apart any two points of the objects are an upper
//! one. Apart both come from the distance algorithm ([`crate::distance`]): the simplex's
//! nearest point, and the support plane asked across the way to it. Overlapping they are the
//! global minimum's.
//!
//! **Margins** are balls added all around: h grows by their radii, for every n. The signed
//! distance of the rounded objects is that of the cores less both margins, exactly, on both
//! sides of the touch.
//!
//! The centres and the state choose where to look first, and prove nothing.

use crate::contact::{Answer, Penetration, Settings};
use crate::distance::{Simplex, direction};
use crate::math::{EPSILON, Real, Vec3, larger};
use crate::precision::Precision;
use crate::support::{Fault, SupportMap};
use crate::support_set::SupportSet;
use crate::warm::{Pair, State};

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
            Answer::Miss(_) | Answer::Undecided(_) => {}
        }
    }
    let start = match cores(pair, state, wanted)? {
        Cores::Apart(gap) => return Ok(apart(&gap, wanted)),
        Cores::Overlap(n) => n,
    };
    *state = State::guess(&start);
    match minimum(pair, state, &wanted.settings)? {
        Answer::Hit(hit) => Ok(deep(&hit, wanted, false)),
        Answer::Limit(hit) | Answer::Undecided(hit) => Ok(deep(&hit, wanted, true)),
        // The proof's word: a touch.
        Answer::Miss(normal) => {
            let point = pair.md.support(&normal)?;
            let mut precision = Precision::default();
            precision.note(&point);
            Ok(apart(
                &Gap {
                    lower: -normal.dot(&point.v),
                    normal,
                    point1: point.v1,
                    point2: point.v1 - normal * normal.dot(&point.v),
                    iterations: 0,
                    limit: false,
                    touch: precision.touch(),
                },
                wanted,
            ))
        }
    }
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

/// Steps that bring the simplex no nearer before rounding is all that is left.
const STALLS: u32 = 3;

/// The gap between the cores, from the state, else from the centres, else from the caller's
/// first direction.
fn cores<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
) -> Result<Cores, Fault> {
    let mut search = Search {
        pair,
        set: SupportSet::EMPTY,
        simplex: Simplex::new(),
        precision: Precision::default(),
        lower: -Real::INFINITY,
        normal: Vec3::x(),
    };
    let (mut nearest, mut stalls, mut iterations) = (Real::INFINITY, 0, 0);
    let mut n = match state.separating() {
        Some(n) => n,
        None => pair.cold_start(),
    };
    let (limit, (point1, point2)) = loop {
        iterations += 1;
        let Some((mut way, mut upper)) = search.ask(&n)? else {
            return Ok(Cores::Overlap(search.normal));
        };
        let touch = search.precision.touch();
        let tolerance = search.precision.tolerance(wanted.settings.tolerance);
        // A plane between the objects is wanted even where the tolerance would not ask.
        let told = |upper: Real| {
            search.lower - wanted.margin() > -touch || !(upper - wanted.margin() > touch)
        };
        let far = search.lower - wanted.margin() > wanted.beyond;
        if far || told(upper) && upper - search.lower <= tolerance {
            let witnesses = search.simplex.witnesses(&search.set, &Vec3::zeros());
            let length = (witnesses.0 - witnesses.1).norm();
            if far || told(length) && length - search.lower <= tolerance {
                break (false, witnesses);
            }
            // In the plane of a touching face the last point was no nearer than others.
            (way, upper) = search.settle();
        }
        if !(upper < nearest) {
            stalls += 1;
        }
        nearest = upper;
        let next = direction(&way).filter(|_| stalls <= STALLS);
        if next.is_none() && !(search.lower >= -touch) {
            return Ok(Cores::Overlap(search.normal));
        }
        // No way on: callbacks that err by more than rounding.
        match next {
            Some(next) if iterations < wanted.settings.max_iterations => n = next,
            _ => {
                let witnesses = search.simplex.witnesses(&search.set, &Vec3::zeros());
                break (true, witnesses);
            }
        }
    };
    let gap = Gap {
        lower: search.lower,
        normal: search.normal,
        point1,
        point2,
        iterations,
        limit,
        touch: search.precision.touch(),
    };
    // The length is the margin to aim at; a touch has none.
    *state = State::apart(gap.normal * larger(gap.lower, gap.touch));
    Ok(Cores::Apart(gap))
}

/// The distance algorithm on two cores.
struct Search<'p, A, B> {
    pair: &'p Pair<A, B>,
    set: SupportSet<4>,
    simplex: Simplex,
    precision: Precision,
    /// The greatest −h(n), metres, and its n.
    lower: Real,
    normal: Vec3,
}

impl<A: SupportMap, B: SupportMap> Search<'_, A, B> {
    /// Asks along unit `n`: the way from the simplex to the origin and the distance, metres;
    /// `None` where the simplex holds it.
    fn ask(&mut self, n: &Vec3) -> Result<Option<(Vec3, Real)>, Fault> {
        let point = self.pair.md.support(n)?;
        self.precision.note(&point);
        let lower = -n.dot(&point.v);
        if lower > self.lower {
            (self.lower, self.normal) = (lower, *n);
        }
        let place = self.simplex.place();
        self.set.place(place, n, &point);
        let (touch, size2) = (self.precision.touch(), self.precision.size2());
        let seen = self.simplex.add(place, point.v, touch, size2);
        Ok(seen.map(|(way, distance2)| (way, distance2.sqrt())))
    }

    /// The way and the distance anew, from every face of the simplex.
    fn settle(&mut self) -> (Vec3, Real) {
        let (way, distance2) = self.simplex.settle(self.precision.touch());
        (way, distance2.sqrt())
    }
}
