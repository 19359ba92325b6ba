// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The signed distance of two objects with margins: a function that is continuous at contact.
//!
//! 1. The signed distance is −min h(n) over all unit n: the distance of separated objects, minus the
//!    penetration depth of overlapping ones. −h(n) is a lower bound for every n.
//! 2. For separated objects both bounds come from [`closest_points`], for overlapping ones from the global
//!    minimum of the depth, which the caller provides as a function.
//! 3. A *margin* is the radius of a ball added to an object, the *core*. It increases h(n) by its
//!    radius for every n, so the signed distance is exactly that of the cores minus both margins, for
//!    separated and for overlapping objects.
//!
//! The state of the last query only selects where the search starts; no bound depends on it.
//!
//! Outputs: both bounds are valid, whatever the status, except for [`Status::InconsistentSupport`]. The points lie on
//! the surfaces of the objects with their margins.

use crate::gjk::closest_points::{ClosestPoints, Goal, closest_points};
use crate::math::{EPSILON, Vec3, larger};
use crate::minkowski::sphere_fit::SphereFit;
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::warm_start::WarmStart;
use crate::types::{Penetration, Settings, Status};

/// The input of a query besides the objects.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Radius of the ball around obj1, metres, not negative.
    pub margin1: f64,
    /// Radius of the ball around obj2, metres, not negative.
    pub margin2: f64,
    /// The search ends when the distance is proven to be greater than this, metres.
    pub max_distance: f64,
    /// The tolerance (of the gap between the bounds) and the limits.
    pub settings: Settings,
}

impl Wanted {
    /// Returns the sum of the margins, metres.
    fn margin(&self) -> f64 {
        self.margin1 + self.margin2
    }
}

/// A signed distance with its bounds: positive for separated objects, negative for overlapping ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// Lower bound: −h(normal), metres.
    pub lower: f64,
    /// Upper bound, metres.
    pub upper: f64,
    /// Unit; moving obj2 along it increases the distance.
    pub normal: Vec3,
    /// Witness point on the surface of obj1 with its margin.
    pub point1: Vec3,
    /// Witness point on the surface of obj2 with its margin.
    pub point2: Vec3,
    /// Number of iterations of the solver.
    pub iterations: u64,
    /// True if the objects overlap. Objects that touch within rounding do not; their distance is 0.
    pub is_hit: bool,
    /// Why the search ended.
    pub status: Status,
}

/// Computes the signed distance of the objects with their margins. Starts from the state of the pair's last
/// query, else from unit `cold_dir`. `minimum` computes the penetration depth of the cores from a state; if
/// they are separated, it stores the separating axis in the state.
///
/// # Errors
/// [`Fault`].
pub fn signed_distance<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centers: Option<&SupportPoint>,
    wanted: &Wanted,
    cold_dir: &Vec3,
    state: &mut WarmStart,
    mut minimum: impl FnMut(&mut WarmStart, &mut Penetration) -> Result<(), Stop>,
) -> Result<Distance, Fault> {
    // Returns the result for overlapping cores; `None` if they are separated.
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
    let axis = state.separating_axis();
    let start = axis.map_or(*cold_dir, |axis| axis.dir);
    let (mut cores, radius, mut contact_eps) =
        find_cores(md, centers, wanted, &start, axis.is_some(), state.radius)?;
    // Without a separating plane the overlap test decides, however close the bounds are.
    let is_at_limit = matches!(cores.status, Status::IterationLimit | Status::SupportLimit);
    if cores.is_inside || !is_at_limit && !(cores.lower >= -contact_eps) {
        *state = WarmStart::towards(cores.normal);
        if let Some(distance) = depth(state)? {
            return Ok(distance);
        }
        // The overlap test found no overlap. Use its axis, even if the support value there is positive within
        // rounding, and keep the witness points, which are rounded too.
        let normal = state.dir;
        let h = normal.dot(&md.support(&normal)?.v);
        contact_eps = 2.0 * larger(contact_eps, h.abs());
        (cores.lower, cores.normal, cores.iterations) = (-h, normal, 0);
        let is_met = cores.upper <= larger(contact_eps, wanted.settings.tolerance);
        cores.status = Status::Rounding.unless(is_met);
    }
    let distance = separated_distance(&cores, contact_eps, wanted);
    *state = WarmStart::separated(cores.normal, larger(distance.lower, 0.0), radius);
    Ok(distance)
}

/// Finds the closest points of the cores. Returns them with the radii of the sphere fits and the contact
/// epsilon, metres. Not inlined, so that its stack frame is released before `minimum` runs.
#[inline(never)]
fn find_cores<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centers: Option<&SupportPoint>,
    wanted: &Wanted,
    start: &Vec3,
    is_remembered: bool,
    radius: [f64; 2],
) -> Result<(ClosestPoints, [f64; 2], f64), Fault> {
    let mut query = SupportQuery::new(md, centers, wanted.settings.tolerance);
    let mut fit = SphereFit::from_radius(radius);
    let goal = Goal {
        tolerance: wanted.settings.tolerance,
        margin: wanted.margin(),
        max_distance: wanted.max_distance,
        max_samples: wanted.settings.max_iterations,
    };
    let cores = closest_points(&mut query, &mut fit, start, is_remembered, &goal)?;
    Ok((cores, fit.confirmed_radius(), query.scale.contact_eps()))
}

/// Returns the signed distance of objects with overlapping cores.
fn overlapping_distance(hit: &Penetration, wanted: &Wanted) -> Distance {
    let n = hit.normal;
    let margin = wanted.margin();
    // Avoids returning -0.0.
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
        status: hit.status,
    }
}

/// Returns the signed distance of objects with separated cores. `contact_eps`: metres.
fn separated_distance(cores: &ClosestPoints, contact_eps: f64, wanted: &Wanted) -> Distance {
    let margin = wanted.margin();
    // The witness points are on the line through the closest points of the cores; if the cores touch, that
    // line is rounding error, and the normal replaces it.
    let along = if cores.upper > contact_eps {
        (cores.point2 - cores.point1) / cores.upper
    } else {
        cores.normal
    };
    let (mut lower, mut upper) = (cores.lower - margin, cores.upper - margin);
    // If the cores touch within rounding, further queries cannot improve the bounds.
    let is_touch = cores.lower >= -contact_eps && cores.upper <= contact_eps;
    let mut status = cores.status.unless(is_touch);
    if lower.abs() <= contact_eps + 4.0 * EPSILON * margin {
        lower = 0.0;
        upper = larger(upper, 0.0);
        // The gap is that of the clamped bounds.
        status = status.unless(upper <= larger(contact_eps, wanted.settings.tolerance));
    }
    Distance {
        lower,
        upper: larger(upper, lower),
        normal: cores.normal,
        point1: cores.point1 + along * wanted.margin1,
        point2: cores.point2 - along * wanted.margin2,
        iterations: cores.iterations,
        is_hit: lower < 0.0,
        status,
    }
}
