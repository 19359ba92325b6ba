// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The loop of EPA: expands the polytope at its closest face until the bounds meet.
//!
//! Reference: G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects" (2001).
//!
//! 1. Find the closest face. Its distance, less the error, is the lower bound of the depth. If the origin is inside
//!    and the gap to the upper bound is allowed, the loop has converged.
//! 2. Insert the known difference farthest along the face's normal, without a callback, if it closes at least
//!    [`INSERT_GAIN_REL`] of the gap between the face and the upper bound: of all known vertices, in a deep overlap with more
//!    than [`MAX_SCANNED`] entries of those of the face's corners.
//! 3. Otherwise evaluate the callbacks, along the face's normal or along the direction that the predictor proposes
//!    ([`Predictor::evaluate_beyond`]). Insert the point if it is above the face.
//! 4. If no point above the face is found along its normal, the support value may lower the upper bound. If it does
//!    not, the loop ends with [`Status::Rounding`].
//!
//! Departures. Planes are interpolated, not computed from corners ([`crate::epa::polytope`]). Known differences are
//! inserted before callbacks are evaluated. The origin may be outside the polytope at first (its distance to a face is
//! then negative), so that the polytope is the separation test too.
//!
//! Outputs. The upper bound is valid for every end. [`EpaPolytope::lower_bound`] is valid if the polytope encloses its interior
//! point and the distance of the closest face is not negative.

use crate::epa::direction::MAX_REFINEMENTS;
use crate::epa::polytope::EpaPolytope;
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::predictor::{Model, Predictor};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportQuery};
use crate::minkowski::tolerance::{Bounds, GapLimit, Scale};
use crate::minkowski::tuning::NEGLIGIBLE_GAPS;
use crate::minkowski::vertex_set::VertexSet;
use crate::portal::is_shallow;
use crate::trace;
use crate::types::{Settings, Status};

/// The tolerance, in sizes of D, below which interpolated planes are too inexact: above what the insertions of a polytope
/// add to their error. Measured (`campaigns -- wide`): without exact planes four times as many proofs at tolerance 0 end
/// above it.
const EXACT_PLANES_REL: f64 = 1e-11;
/// The number of entries up to which the whole set is looked through for the farthest known difference in a deep overlap too.
/// Measured: without a limit, deep ellipsoids take 15 % more instructions, hulls of 162 corners and capsules 4 %; with 6,
/// hulls of 42 corners take 5 % more support points, with 12, 1.5 %. In shallow overlaps, proofs of ellipsoids to 1e-10 m
/// would take 10 to 28 % more support points.
const MAX_SCANNED: usize = 16;
/// The part of the gap between the closest face and the upper bound that a known difference must close to be inserted without
/// a support call. Insensitive: 0.45 to 0.8; without it deep boxes take 50 % more instructions.
const INSERT_GAIN_REL: f64 = 1.0 - NEGLIGIBLE_GAPS;

/// The limits of a query.
#[derive(Clone, Copy, Debug)]
pub struct EpaLimits {
    /// The largest gap between the bounds.
    pub gap: GapLimit,
    /// The limit of support points of the query, including those before the polytope.
    pub max_points: u64,
    /// The limit of support points that expand the polytopes, see [`Settings::max_iterations`].
    pub max_iterations: u64,
}

impl EpaLimits {
    /// Returns the limits of a query whose depth may be off by the larger of the tolerance and `rel_tol` times the
    /// depth.
    pub fn new(settings: &Settings, rel_tol: f64, max_points: u64) -> Self {
        Self {
            gap: GapLimit::new(settings.tolerance, rel_tol),
            max_points,
            max_iterations: settings.max_iterations,
        }
    }

    /// Returns whether the tolerance is too small for interpolated planes.
    pub fn needs_exact_planes(&self, scale: &Scale) -> bool {
        let tolerance = scale.tolerance(self.gap.tolerance);
        !(tolerance > EXACT_PLANES_REL * scale.size())
    }
}

/// The parameters of an expansion besides its buffers, which have three sizes.
pub struct Expansion<'e, 'm, D> {
    pub query: &'e mut SupportQuery<'m, D>,
    pub predictor: &'e mut Predictor,
    /// The interior point of the query.
    pub interior: &'e Vec3,
    pub limits: &'e EpaLimits,
    /// The number of support points that expanded polytopes of the query, which continues.
    pub iterations: &'e mut u64,
}

/// Expands the polytope until the bounds meet, by the steps at the head of this file. Returns why it ended; `None` if a
/// buffer is full. `has_larger`: true if the caller continues in larger buffers then.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn expand<D: Difference, const N: usize, const F: usize>(
    expansion: Expansion<'_, '_, D>,
    set: &mut VertexSet<N>,
    polytope: &mut EpaPolytope<F>,
    has_larger: bool,
) -> Result<Option<Status>, Stop> {
    trace::stage("expansion");
    let Expansion {
        query,
        predictor,
        interior,
        limits,
        iterations,
    } = expansion;
    // The normal of the face above which the last point was inserted.
    let mut last_normal = Vec3::zeros();
    // Terminates: each turn adds a vertex to the set or a corner.
    loop {
        let closest = polytope.closest_face();
        polytope.set_size(query.scale.size());
        let upper = query.upper.depth;
        let Bounds {
            allowed,
            rounding,
            insert_height,
        } = limits.gap.bounds(&query.scale, upper);
        let error = polytope.error() + polytope.key_error(upper) + rounding;
        let target = upper - allowed + lesser(error, 0.5 * allowed);
        let target_key = target * target.abs();
        let is_inside = closest.key >= 0.0;
        trace::lower_bound(larger(closest.key, 0.0).sqrt());
        if is_inside && closest.key >= target_key {
            return Ok(Some(Status::Converged));
        }
        // While the origin is outside, the buffers are the only limit: the caller's limits must not
        // change an overlap into a separation.
        if is_inside && *iterations >= limits.max_iterations {
            return Ok(Some(Status::IterationLimit));
        }
        if is_inside && query.support_points() >= limits.max_points {
            return Ok(Some(Status::SupportLimit));
        }
        if set.len() + MAX_REFINEMENTS >= N || !polytope.has_room(0) {
            return Ok(None);
        }
        let face = closest.face;
        let (normal, offset) = (polytope.normal(face), polytope.offset(face));
        let level = if is_inside { insert_height } else { rounding };
        let mut w = if set.len() <= MAX_SCANNED || is_shallow(query) {
            set.farthest_vertex(&normal)
        } else {
            set.farthest_of_corners(&normal, &polytope.corners(face))
        };
        let height = normal.dot(&w.w) - offset;
        let distance = closest.key.sqrt();
        let is_gain = !(closest.key > 0.0)
            || height * distance > INSERT_GAIN_REL * (upper - distance) * offset;
        // In the largest buffers, room for the corners of the remaining support calls is reserved.
        let has_room = || has_larger || polytope.has_room(N - MAX_REFINEMENTS - set.len());
        if !(height > level && is_gain && has_room()) {
            let along_normal = !is_inside || !is_shallow(query);
            let vertices = |set: &VertexSet<N>| polytope.face(set, interior, face);
            let (sample, model) =
                predictor.evaluate_beyond(query, set, vertices, &normal, allowed, along_normal)?;
            *iterations += 1;
            let queried_height = normal.dot(&sample.w) - offset;
            if queried_height > rounding {
                w = sample.vertex();
            } else if model != Model::Face {
                predictor.fail_above(&normal);
                continue;
            } else if query.upper.depth < upper {
                continue;
            } else if !(height > level) {
                return Ok(Some(Status::Rounding));
            }
            // Otherwise the callbacks returned less than a known difference, in contradiction: insert that.
        }
        // A face of no area has the plane of the visible face that it replaced, and its corner is above that: without an end
        // the same point would be inserted again.
        if normal == last_normal {
            return Ok(Some(Status::Rounding));
        }
        last_normal = normal;
        let corner = |pair| set.vertex(pair, interior).w;
        if !polytope.insert(face, &w, rounding, &corner, has_larger) {
            return Ok(None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::minkowski::support::Fault;
    use crate::minkowski::vertex_set::{Vertex, VertexPair};
    use crate::test_shapes::{corners, difference, hull};
    use crate::types::Direction;

    const LIMITS: EpaLimits = EpaLimits {
        gap: GapLimit::new(if EPSILON < 1e-10 { 1e-9 } else { 1e-4 }, 0.0),
        max_points: 1000,
        max_iterations: 1000,
    };

    /// The directions of four support points whose tetrahedron contains the middle of a box.
    const START: [[f64; 3]; 4] = [
        [1.0, 1.0, 1.0],
        [-1.0, -1.0, 1.0],
        [-1.0, 1.0, -1.0],
        [1.0, -1.0, -1.0],
    ];

    /// Expands the tetrahedron of the support points along [`START`] of a box around the origin with half extents 1, 2
    /// and 3, moved by `at`, with room for `N` vertices. Support calls after the start return `after`, if given. Returns
    /// the end, the upper and the lower bound, and the number of iterations.
    fn expand_box<const N: usize>(
        at: Vec3,
        limits: &EpaLimits,
        after: Option<Vec3>,
    ) -> Result<(Option<Status>, f64, f64, u64), Stop> {
        let points: Vec<Vec3> = (corners(Vec3::new(1.0, 2.0, 3.0)).iter())
            .map(|p| p + at)
            .collect();
        let calls = core::cell::Cell::new(0);
        let shape = hull(&points);
        let a = |n: &Vec3| {
            calls.set(calls.get() + 1);
            after
                .filter(|_| calls.get() > START.len())
                .unwrap_or_else(|| shape(n))
        };
        let md = difference(a, |_: &Vec3| Vec3::zeros());
        let mut query = SupportQuery::new(&md, None, 0.0);
        let mut set = VertexSet::<N>::EMPTY;
        let mut start = [Vertex {
            w: at,
            pair: VertexPair::INTERIOR,
        }; 4];
        for (corner, n) in start.iter_mut().zip(START) {
            *corner = query
                .evaluate(&mut set, &Vec3::from(n).normalize())?
                .vertex();
        }
        let mut polytope = EpaPolytope::<64>::blank(query.scale.size());
        assert!(polytope.start(&start, query.scale.size(), false));
        let mut iterations = 0;
        let expansion = Expansion {
            query: &mut query,
            predictor: &mut Predictor::default(),
            interior: &at,
            limits,
            iterations: &mut iterations,
        };
        let end = expand(expansion, &mut set, &mut polytope, false)?;
        let lower = polytope.lower_bound(&polytope.closest_face());
        Ok((end, query.upper.depth, lower, iterations))
    }

    #[test]
    fn the_bounds_meet_at_the_distance_of_the_closest_side() {
        let tolerance = LIMITS.gap.tolerance;
        for (at, depth) in [
            (Vec3::zeros(), 1.0),
            (Vec3::x() * 0.75, 0.25),
            (Vec3::y() * 1.5, 0.5),
        ] {
            let (end, upper, lower, iterations) = expand_box::<32>(at, &LIMITS, None).unwrap();
            assert_eq!(end, Some(Status::Converged));
            assert!((upper - depth).abs() <= tolerance, "{at} {upper}");
            assert!(lower <= depth && lower >= depth - tolerance, "{at} {lower}");
            assert!(iterations > 0);
        }
    }

    #[test]
    fn limits_and_full_buffers_end_with_honest_bounds() {
        let few = EpaLimits {
            max_iterations: 1,
            ..LIMITS
        };
        let none = EpaLimits {
            max_points: 4,
            ..LIMITS
        };
        for (found, end) in [
            (
                expand_box::<32>(Vec3::zeros(), &few, None),
                Some(Status::IterationLimit),
            ),
            (
                expand_box::<32>(Vec3::zeros(), &none, None),
                Some(Status::SupportLimit),
            ),
            (expand_box::<5>(Vec3::zeros(), &LIMITS, None), None),
        ] {
            let (found, upper, lower, _) = found.unwrap();
            assert_eq!(found, end);
            assert!(
                upper >= 1.0 && (0.0..=1.0).contains(&lower),
                "{upper} {lower}"
            );
        }
    }

    #[test]
    fn a_nan_is_a_fault() {
        let nan = Some(Vec3::repeat(f64::NAN));
        let found = expand_box::<32>(Vec3::zeros(), &LIMITS, nan);
        assert_eq!(found.unwrap_err(), Stop::Fault(Fault::NonFinite));
    }

    /// The origin is outside the first tetrahedron, and inside the box.
    #[test]
    fn the_polytope_comes_to_contain_an_origin_that_is_outside_at_first() {
        let at = Vec3::new(0.9, 1.9, 2.9);
        let (end, upper, lower, _) = expand_box::<32>(at, &LIMITS, None).unwrap();
        assert_eq!(end, Some(Status::Converged));
        let tolerance = LIMITS.gap.tolerance;
        assert!(
            (upper - 0.1).abs() <= tolerance && lower >= 0.1 - tolerance,
            "{upper} {lower}"
        );
    }

    #[test]
    fn a_box_beside_the_origin_is_separated() {
        let found = expand_box::<32>(Vec3::new(0.0, 2.5, 0.0), &LIMITS, None);
        assert!(
            matches!(found, Err(Stop::Separated(Direction { n, .. })) if n.y < -0.5),
            "{found:?}"
        );
    }
}
