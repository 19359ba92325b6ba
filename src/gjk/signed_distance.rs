// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The signed distance of two objects: one continuous function through the touch.
//!
//! 1. The signed distance is −min h(n) over unit n. Apart, the minimum is the separating plane farthest
//!    from both objects; overlapping, it is the penetration depth. −h(n) is a lower bound for every n.
//! 2. Apart, both bounds come from [`closest_points`]. Overlapping, they are those of the global minimum,
//!    which the caller provides.
//! 3. *Margins* are balls added all around: h grows by their radii for every n, so the signed distance is
//!    that of the cores less both margins, exactly, on both sides of the touch.
//!
//! The state of the last query chooses where the next one starts, and proves nothing.
//!
//! Outputs: both bounds are proven, whatever `is_limited` says; the points are on the surfaces with their
//! margins.

use crate::contact::{Penetration, Settings};
use crate::gjk::closest_points::{ClosestPoints, End, Goal, closest_points};
use crate::math::{EPSILON, Vec3, larger};
use crate::minkowski::query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::round_fit::SphereFit;
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::query::warm_start::WarmStart;

/// The input of a query besides the objects.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Radius of the ball around obj1, metres, not negative.
    pub margin1: f64,
    /// Radius of the ball around obj2, metres, not negative.
    pub margin2: f64,
    /// Distances greater than this need not be refined, metres.
    pub max_distance: f64,
    /// The tolerance is that of the gap between the bounds.
    pub settings: Settings,
}

impl Wanted {
    fn margin(&self) -> f64 {
        self.margin1 + self.margin2
    }
}

/// A signed distance with its bounds: positive apart, negative overlapping.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    pub is_hit: bool,
    /// The bounds have not met within the support limit.
    pub is_limited: bool,
}

/// Computes the signed distance of the objects with their margins, from the state of the last query of the pair, or
/// unit `cold`. `minimum` computes the penetration depth of the cores from a state; where they are apart, it stores
/// the axis that separates them.
///
/// # Errors
/// [`Fault`].
pub fn signed_distance<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    wanted: &Wanted,
    cold: &Vec3,
    state: &mut WarmStart,
    mut minimum: impl FnMut(&mut WarmStart, &mut Penetration) -> Result<(), Stop>,
) -> Result<Distance, Fault> {
    // Returns the answer for cores that overlap, `None` where they are apart.
    let mut depth = |state: &mut WarmStart| {
        let mut hit = Penetration::default();
        let found = if_overlapping(minimum(state, &mut hit))?;
        Ok(found.map(|()| overlapping_distance(&hit, wanted)))
    };
    if state.is_overlap() {
        if let Some(distance) = depth(state)? {
            return Ok(distance);
        }
    }
    let start = state.separating_axis().map_or(*cold, |axis| axis.dir);
    let (mut cores, radius, mut touch) = find_cores(md, wanted, &start, state.radius)?;
    // Without a separating plane the proof decides, however close the bounds are.
    let is_open = cores.end != End::Limit && !(cores.lower >= -touch);
    if cores.end == End::Inside || is_open {
        *state = WarmStart::guess(&cores.normal);
        if let Some(distance) = depth(state)? {
            return Ok(distance);
        }
        // The proof decides, whatever one support value is. The points stay those where the origin was
        // met.
        let normal = state.dir;
        let h = normal.dot(&md.support(&normal)?.v);
        touch = larger(touch, h.abs());
        (cores.lower, cores.normal, cores.iterations) = (-h, normal, 0);
        let is_closed = cores.upper <= larger(touch, wanted.settings.tolerance);
        cores.end = if is_closed { End::Met } else { End::Limit };
    }
    let distance = distance_apart(&cores, touch, wanted);
    *state = WarmStart::apart(cores.normal, larger(distance.lower, 0.0), radius);
    Ok(distance)
}

/// Finds the closest points of the cores. Returns them with the radii of the sphere fits and the contact
/// epsilon, metres. In a frame of its own, which is left before a minimum is looked for.
#[inline(never)]
fn find_cores<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    wanted: &Wanted,
    start: &Vec3,
    radius: [f64; 2],
) -> Result<(ClosestPoints, [f64; 2], f64), Fault> {
    let mut query = SupportQuery::new(md, None);
    let mut fit = SphereFit::from_radius(radius);
    let goal = Goal {
        tolerance: wanted.settings.tolerance,
        margin: wanted.margin(),
        max_distance: wanted.max_distance,
        max_samples: wanted.settings.max_iterations,
    };
    let cores = closest_points(&mut query, &mut fit, start, &goal)?;
    Ok((cores, fit.confirmed_radius(), query.scale.contact_eps()))
}

/// Returns the distance of cores that overlap.
fn overlapping_distance(hit: &Penetration, wanted: &Wanted) -> Distance {
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
        is_hit: lower < 0.0,
        is_limited: hit.limit,
    }
}

/// Returns the distance of cores that are apart, `touch` being rounding, metres.
fn distance_apart(cores: &ClosestPoints, touch: f64, wanted: &Wanted) -> Distance {
    let margin = wanted.margin();
    // Points of the surfaces on the line through the closest points of the cores. Of cores that touch, the
    // line is rounding.
    let along = if cores.upper > touch {
        (cores.point2 - cores.point1) / cores.upper
    } else {
        cores.normal
    };
    let (mut lower, mut upper) = (cores.lower - margin, cores.upper - margin);
    // Of cores that touch within rounding no query tells more.
    let is_touch = cores.lower >= -touch && cores.upper <= touch;
    let mut is_limited = cores.end != End::Met && !is_touch;
    if lower.abs() <= touch + 4.0 * EPSILON * margin {
        lower = 0.0;
        upper = larger(upper, 0.0);
        // The bounds that are returned decide.
        is_limited &= !(upper <= larger(touch, wanted.settings.tolerance));
    }
    Distance {
        lower,
        upper: larger(upper, lower),
        normal: cores.normal,
        point1: cores.point1 + along * wanted.margin1,
        point2: cores.point2 - along * wanted.margin2,
        iterations: cores.iterations,
        is_hit: lower < 0.0,
        is_limited,
    }
}
