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

use crate::contact::{Penetration, Settings};
use crate::gjk::distance::{Approach, End, Goal};
use crate::known::support_set::{Inquiry, Stop};
use crate::math::{EPSILON, Vec3, larger, unit};
use crate::minkowski::support::{Fault, SupportMap};
use crate::{query::Pair, state::State};

/// What is asked for besides the objects.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Radius of the ball around obj1, metres, not negative.
    pub margin1: f64,
    /// Radius of the ball around obj2, metres, not negative.
    pub margin2: f64,
    /// Distances greater than this need not be refined, metres.
    pub max_distance: f64,
    /// The tolerance is the width of the bounds.
    pub settings: Settings,
}

impl Wanted {
    fn margin(&self) -> f64 {
        self.margin1 + self.margin2
    }
}

/// How far apart, or how deep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// −h(normal), metres: proven, apart and overlapping.
    pub lower: f64,
    /// Proven too, metres.
    pub upper: f64,
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

/// The signed distance of a pair's objects with their margins. `minimum` is the global
/// minimum of the depth of objects that overlap.
pub fn signed_distance<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
    minimum: impl Fn(&Pair<A, B>, &mut State, &Settings, &mut Penetration) -> Result<(), Stop>,
) -> Result<Distance, Fault> {
    let depth = |state: &mut State| {
        let mut hit = Penetration::default();
        match minimum(pair, state, &wanted.settings, &mut hit) {
            Ok(()) => Ok(Ok(deep(&hit, wanted))),
            Err(Stop::Apart(normal)) => Ok(Err(normal)),
            Err(Stop::Fault(fault)) => Err(fault),
        }
    };
    // Cores that overlapped are asked for their depth at once.
    if state.overlapped() {
        if let Ok(distance) = depth(state)? {
            return Ok(distance);
        }
    }
    let (mut gap, mut touch) = cores(pair, state, wanted)?;
    if gap.hit {
        *state = State::guess(&gap.normal);
        let normal = match depth(state)? {
            Ok(distance) => return Ok(distance),
            Err(normal) => normal,
        };
        // The proof's word, whatever one support value says of it. The points are those where the
        // search came upon the origin, or left off before.
        let mut inquiry = Inquiry::new(&pair.md);
        let h = normal.dot(&inquiry.point(&normal)?.v);
        touch = larger(inquiry.precision.touch(), h.abs());
        (gap.lower, gap.normal, gap.iterations) = (-h, normal, 0);
        gap.limit = !(gap.upper <= larger(touch, wanted.settings.tolerance));
    }
    Ok(apart(&gap, touch, wanted))
}

/// The answer for cores that overlap by this much.
fn deep(hit: &Penetration, wanted: &Wanted) -> Distance {
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
        limit: hit.limit,
    }
}

/// The answer for cores that are this far apart, `touch` being rounding, metres.
fn apart(cores: &Distance, touch: f64, wanted: &Wanted) -> Distance {
    let margin = wanted.margin();
    let between = cores.point2 - cores.point1;
    // Points of the surfaces on the line between the cores' points, as far apart as those
    // less the margins. Of points that touch the line is rounding.
    let along = if cores.upper > touch {
        between / cores.upper
    } else {
        cores.normal
    };
    let (mut lower, mut upper) = (cores.lower - margin, cores.upper - margin);
    if lower.abs() <= touch + 4.0 * EPSILON * margin {
        lower = 0.0;
        upper = larger(upper, 0.0);
    }
    Distance {
        lower,
        upper: larger(upper, lower),
        point1: cores.point1 + along * wanted.margin1,
        point2: cores.point2 - along * wanted.margin2,
        hit: lower < 0.0,
        ..*cores
    }
}

/// Corners nearer to each other than this share of the size, once the ball is off, are one
/// round part. Insensitive: 0.01 to 0.04 tried on the distances of the recorded contacts.
const ONE_PART: f64 = 0.02;

/// The distance of the cores, from the state, else from the centres, else from the caller's first
/// direction, and what of it is rounding, metres. A hit where they overlap, or so nearly that only a
/// proof tells: along the normal the overlap was least, and the points are at most a touch apart. A
/// frame of its own, that is left before a minimum is looked for.
#[inline(never)]
fn cores<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
) -> Result<(Distance, f64), Fault> {
    let mut inquiry = Inquiry::new(&pair.md);
    let mut search = Approach::new(&mut inquiry);
    let margin = wanted.margin();
    if !resume(&mut search, state)? {
        let start = state.separating().unwrap_or_else(|| pair.cold_start());
        search.ask(&start)?;
    }
    let end = search.run(&Goal {
        tolerance: wanted.settings.tolerance,
        share: 0.0,
        margin,
        far: wanted.max_distance,
        iterations: wanted.settings.max_iterations,
    })?;
    let touch = search.inquiry.precision.touch();
    let hit = end == End::Inside || end == End::Stalled && !(search.lower >= -touch);
    let (point1, point2) = search.witnesses();
    if !hit {
        *state = left_behind(&search);
    }
    let distance = Distance {
        lower: search.lower,
        upper: (point2 - point1).norm(),
        normal: search.normal,
        point1,
        point2,
        iterations: search.iterations,
        hit,
        limit: !hit && end != End::Met,
    };
    Ok((distance, touch))
}

/// Starts from the directions that the state holds, if it holds any.
///
/// Where a face is nearest, three find its corners and a fourth proves its plane: fewer cannot do,
/// for after any turn a support point says nothing of another direction's. (Measured on six slow
/// motions, the `_trajS` pair sets, moved apart, tolerance 1e-6: boxes and hulls 4.0 to 4.2 support
/// points, 6.3 in the mean of all.)
fn resume<A: SupportMap, B: SupportMap>(
    search: &mut Approach<'_, '_, A, B>,
    state: &State,
) -> Result<bool, Fault> {
    let (corners, ball) = state.nearest();
    for n in corners.iter().filter_map(unit) {
        search.ask_again(&n)?;
    }
    if search.iterations == 0 {
        return Ok(false);
    }
    // What the state says of it counts where the points say nothing.
    if search.ball == 0.0 && ball > 0.0 && ball < search.inquiry.precision.size() {
        search.ball = ball;
    }
    search.settle();
    Ok(true)
}

/// The directions that find the corners again: one for each part, the best direction for the
/// part that it touches.
fn left_behind<A: SupportMap, B: SupportMap>(search: &Approach<'_, '_, A, B>) -> State {
    let ids = search.simplex.ids();
    let bare = search.bare();
    let near2 = ONE_PART * ONE_PART * search.inquiry.precision.size2();
    let mut directions = [Vec3::zeros(); 3];
    for i in 0..search.simplex.len().min(3) {
        let alone = (0..i).all(|k| (bare[k] - bare[i]).norm_squared() > near2);
        if search.ball == 0.0 || alone {
            directions[i] = search.set.direction(ids[i]);
        }
    }
    if directions[1] == directions[2] {
        directions[0] = search.normal;
    }
    // The length is the margin to aim at; a touch has none.
    let margin = larger(search.lower, search.inquiry.precision.touch());
    State::near(search.normal * margin, directions, search.ball)
}
