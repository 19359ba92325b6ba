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
use crate::gjk::distance::{Approach, Step};
use crate::known::support::{Fault, SupportMap};
use crate::known::support_set::Inquiry;
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
    pub max_distance: Real,
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
    /// They overlap, or so nearly that only a proof tells. Along this unit direction the overlap
    /// was least, and these points of the two are at most a touch apart.
    Overlap(Vec3, [Vec3; 2]),
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
    let (start, met) = match cores(pair, state, wanted)? {
        Cores::Apart(gap) => return Ok(apart(&gap, wanted)),
        Cores::Overlap(n, met) => (n, met),
    };
    *state = State::guess(&start);
    match minimum(pair, state, &wanted.settings)? {
        Answer::Hit(hit) => Ok(deep(&hit, wanted, false)),
        Answer::Limit(hit) => Ok(deep(&hit, wanted, true)),
        Answer::Miss(normal) => Ok(apart(&touching(pair, normal, met)?, wanted)),
    }
}

/// Where the cores touch: the proof's word, whatever one support value says of it. The points
/// `met` where the search came upon the origin.
fn touching<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    normal: Vec3,
    [point1, point2]: [Vec3; 2],
) -> Result<Gap, Fault> {
    let mut inquiry = Inquiry::new(&pair.md);
    let h = normal.dot(&inquiry.point(&normal)?.v);
    Ok(Gap {
        lower: -h,
        normal,
        point1,
        point2,
        iterations: 0,
        limit: false,
        touch: larger(inquiry.precision.touch(), h.abs()),
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

/// Corners nearer to each other than this share of the size, once the ball is off, are one
/// round part. Insensitive: 0.01 to 0.04 tried on the distances of the recorded contacts.
const ONE_PART: Real = 0.02;

/// The gap between the cores, from the state, else from the centres, else from the caller's
/// first direction. A frame of its own, that is left before a minimum is looked for.
#[inline(never)]
fn cores<A: SupportMap, B: SupportMap>(
    pair: &Pair<A, B>,
    state: &mut State,
    wanted: &Wanted,
) -> Result<Cores, Fault> {
    let mut inquiry = Inquiry::new(&pair.md);
    let mut search = Approach::new(&mut inquiry);
    let margin = wanted.margin();
    if !resume(&mut search, state)? {
        let start = state.separating().unwrap_or_else(|| pair.cold_start());
        search.ask(&start)?;
    }
    let limit = loop {
        let touch = search.inquiry.precision.touch();
        let tolerance = search
            .inquiry
            .precision
            .tolerance(wanted.settings.tolerance);
        // A plane between the objects is wanted even where the tolerance would not ask.
        let far = search.lower - margin > wanted.max_distance;
        let told = |search: &Approach<'_, '_, A, B>| {
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
        // The cap on iterations, or callbacks that err by more than rounding.
        if search.iterations >= wanted.settings.max_iterations {
            break true;
        }
        let step = search.step(tolerance)?;
        if step == Step::Inside || step == Step::Stalled && !(search.lower >= -touch) {
            let (point1, point2) = search.witnesses();
            return Ok(Cores::Overlap(search.normal, [point1, point2]));
        }
        if step == Step::Stalled {
            break true;
        }
    };
    let (point1, point2) = search.witnesses();
    let gap = Gap {
        lower: search.lower,
        normal: search.normal,
        point1,
        point2,
        iterations: search.iterations,
        limit,
        touch: search.inquiry.precision.touch(),
    };
    *state = left_behind(&search);
    Ok(Cores::Apart(gap))
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
