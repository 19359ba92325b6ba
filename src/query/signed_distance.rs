// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The signed distance of two objects with margins: a function that is continuous at contact.
//!
//! 1. The signed distance is −min h(n) over all unit n: the distance of separated objects, minus the
//!    penetration depth of overlapping ones. −h(n) is a lower bound for every n.
//! 2. For separated objects both bounds come from [`closest_points`], for overlapping ones from the proven minimum of
//!    the depth.
//! 3. A *margin* is the radius of a ball added to an object, the *core*. It increases h(n) by its
//!    radius for every n, so the signed distance is exactly that of the cores minus both margins, for
//!    separated and for overlapping objects.
//!
//! The state of the last query only selects where the search starts; no bound depends on it.
//!
//! Outputs, in the terms of a penetration: `depth` is minus the lower bound, `depth_lower` minus the upper bound of the
//! distance, and `normal` the direction along which obj2 moves to increase it. The objects overlap if `depth` > 0; those
//! that touch within rounding do not, and their depth is 0. Both bounds are valid, whatever the status, except for
//! [`Status::InconsistentSupport`]. The points lie on the surfaces of the objects with their margins.

use crate::epa::buffers::Arena;
use crate::gjk::closest_points::{ClosestPoints, Goal, closest_points};
use crate::math::{EPSILON, Real, larger, lesser};
use crate::minkowski::predictor::Predictor;
use crate::minkowski::support::{Difference, Fault, SupportMap};
use crate::minkowski::support_query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::warm_start::WarmStart;
use crate::query::Pair;
use crate::types::{Settings, Solution, Status};

/// Margins and largest distance of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceOptions {
    /// Radius of a ball added to the first shape, metres, not negative.
    pub margin1: Real,
    /// Radius of a ball added to the second shape, metres, not negative.
    pub margin2: Real,
    /// The search ends when the distance is proven to be greater than this, metres, not negative.
    pub max_distance: Real,
}

impl Default for DistanceOptions {
    /// Returns options without margins and without a largest distance.
    fn default() -> Self {
        DistanceOptions {
            margin1: 0.0,
            margin2: 0.0,
            max_distance: Real::INFINITY,
        }
    }
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Computes the signed distance of the objects with their margins, from the state of the last query.
    ///
    /// # Errors
    /// [`Stop::Fault`], also for an option that is invalid.
    #[inline(never)]
    pub(super) fn signed_distance(
        &self,
        options: DistanceOptions,
        state: &mut WarmStart,
        arena: &mut dyn Arena,
    ) -> Result<Solution, Stop> {
        let (margin1, margin2) = (f64::from(options.margin1), f64::from(options.margin2));
        let is_finite = margin1 + margin2 < Real::MAX.into();
        if !(margin1 >= 0.0 && margin2 >= 0.0 && is_finite && options.max_distance >= 0.0) {
            return Err(Fault::DistanceOptions.into());
        }
        if state.is_overlap() {
            if let Some(hit) = self.depth(state, arena)? {
                return Ok(with_margins(hit, [margin1, margin2]));
            }
        }
        let (mut cores, radius, mut contact_eps) =
            self.find_cores(margin1 + margin2, options.max_distance.into(), state)?;
        // Without a separating plane the overlap test decides, however close the bounds are.
        let is_at_limit = matches!(cores.status, Status::IterationLimit | Status::SupportLimit);
        if cores.is_inside || !is_at_limit && !(cores.lower >= -contact_eps) {
            *state = WarmStart::towards(cores.normal);
            if let Some(hit) = self.depth(state, arena)? {
                return Ok(with_margins(hit, [margin1, margin2]));
            }
            // The overlap test found no overlap. Use its axis, even if the support value there is positive within
            // rounding, and keep the witness points, which are rounded too.
            let normal = state.dir;
            let h = normal.n.dot(&self.difference.support(&normal.n)?.v);
            contact_eps = 2.0 * larger(contact_eps, h.abs());
            (cores.lower, cores.normal, cores.iterations) = (-h, normal, 0);
            let is_met = cores.upper <= larger(contact_eps, self.settings.tolerance);
            cores.status = Status::Rounding.unless(is_met);
        }
        let tolerance = self.settings.tolerance;
        let found = separated_distance(&cores, contact_eps, tolerance, [margin1, margin2]);
        *state = WarmStart::separated(cores.normal, radius);
        Ok(found)
    }

    /// Finds the penetration depth of the cores. `None` if they are separated; the state then has the separating axis.
    #[inline(always)]
    fn depth(
        &self,
        state: &mut WarmStart,
        arena: &mut dyn Arena,
    ) -> Result<Option<Solution>, Fault> {
        let found = self.proven(state, arena);
        state.note_separation(&found);
        if_overlapping(found)
    }

    /// Finds the closest points of the cores, from the separating axis of the state. `margin`: the sum of both, metres.
    /// Returns them with the radii of the sphere fits and the contact epsilon, metres. Not inlined, so that its stack frame
    /// is released before the depth is computed.
    #[inline(never)]
    fn find_cores(
        &self,
        margin: f64,
        max_distance: f64,
        state: &WarmStart,
    ) -> Result<(ClosestPoints, [f64; 2], f64), Fault> {
        let Settings {
            tolerance,
            max_iterations,
            ..
        } = self.settings;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let mut predictor = Predictor::warm(state.radius);
        let goal = Goal {
            tolerance,
            margin,
            max_distance,
            max_samples: max_iterations,
        };
        let start = self.start(state, state.separating_axis().is_some());
        let cores = closest_points(&mut query, &mut predictor, &start, &goal)?;
        Ok((
            cores,
            predictor.confirmed_radius(),
            query.scale.contact_eps(),
        ))
    }
}

/// Adds the margins to the result of the cores.
fn with_margins(cores: Solution, [margin1, margin2]: [f64; 2]) -> Solution {
    let (n, margin) = (cores.normal, margin1 + margin2);
    let depth = cores.depth + margin;
    Solution {
        depth,
        depth_lower: lesser(cores.depth_lower + margin, depth),
        point1: cores.point1 + n * margin1,
        point2: cores.point2 - n * margin2,
        ..cores
    }
}

/// Returns the signed distance of objects with separated cores. `contact_eps`, `tolerance`: metres.
#[inline(always)]
fn separated_distance(
    cores: &ClosestPoints,
    contact_eps: f64,
    tolerance: f64,
    [margin1, margin2]: [f64; 2],
) -> Solution {
    let margin = margin1 + margin2;
    // The witness points are on the line through the closest points of the cores; if the cores touch, that
    // line is rounding error, and the normal replaces it.
    let along = if cores.upper > contact_eps {
        (cores.point2 - cores.point1) / cores.upper
    } else {
        cores.normal.n
    };
    let (mut depth, mut depth_lower) = (margin - cores.lower, margin - cores.upper);
    // If the cores touch within rounding, further support points cannot improve the bounds.
    let is_touch = cores.lower >= -contact_eps && cores.upper <= contact_eps;
    let mut status = cores.status.unless(is_touch);
    if depth.abs() <= contact_eps + 4.0 * EPSILON * margin {
        depth = 0.0;
        depth_lower = lesser(depth_lower, 0.0);
        // The gap is that of the clamped bounds.
        status = status.unless(-depth_lower <= larger(contact_eps, tolerance));
    }
    Solution {
        depth,
        depth_lower: lesser(depth_lower, depth),
        dir: cores.normal.n,
        normal: cores.normal.n,
        is_general: cores.normal.is_general(),
        point1: cores.point1 + along * margin1,
        point2: cores.point2 - along * margin2,
        iterations: cores.iterations,
        status,
        ..Solution::default()
    }
}
