// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The loop of EPA: expands the polytope at its closest face until the bounds meet.
//!
//! 1. The closest face; its distance, less the error, is the lower bound of the depth. Where the origin is
//!    inside and the gap to the upper bound is allowed: converged.
//! 2. The known difference farthest along its normal becomes a corner, without a callback, where it closes
//!    [`GAIN_REL`] of the gap between the face and the upper bound.
//! 3. Else the callbacks are evaluated: along the face's normal, or where a sphere fit tells ([`evaluate_beyond`]). The point becomes a corner if it is above the face.
//! 4. A normal that finds nothing above lowers the upper bound, or rounding ends the search.
//!
//! Departures from van den Bergen's EPA: planes are interpolated, not computed from corners
//! ([`crate::epa::polytope`]); known differences come before callbacks; the origin may be outside at first
//! (its distance to a face is then negative), so that the polytope also is the separation test.
//!
//! Validity: with [`ExpandEnd::Converged`] and the limits, [`EpaPolytope::lower_bound`] is a proven lower
//! bound, if the polytope encloses its interior point. With [`ExpandEnd::Rounding`] and
//! [`ExpandEnd::NoRoom`] too, if the closest face is at a distance > 0; else nothing is known but the upper
//! bound.

use crate::contact::Settings;
use crate::epa::polytope::EpaPolytope;
use crate::gjk::barycentric::triangle;
use crate::math::{Vec3, lesser};
use crate::minkowski::query::{Stop, SupportQuery};
use crate::minkowski::round_fit::{DirectionSource, SphereFit, evaluate_beyond};
use crate::minkowski::support::SupportMap;
use crate::minkowski::tolerance::{GapLimit, Scale};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::mpr::portal::KNOWN_LEVEL;

/// The share of the gap between the closest face and the upper bound that a known difference must close to
/// be inserted without a query. Measured: flat from 0.45 to 0.8; without it deep pairs bury most of their
/// insertions (boxes 19.7k instructions for 12.7k).
const GAIN_REL: f64 = 0.6;
/// The share of the size below which a tolerance is too fine for interpolated planes.
const EXACT_PLANES_REL: f64 = 1e-11;

/// The limits of a query.
#[derive(Clone, Copy, Debug)]
pub struct EpaLimits {
    /// Largest gap between the bounds.
    pub gap: GapLimit,
    /// Support calls.
    pub max_points: u64,
    /// Support calls after the first tetrahedron.
    pub max_iterations: u64,
}

impl EpaLimits {
    /// Returns the limits of a query whose depth may be off by the larger of the tolerance and `rel_tol` times the
    /// depth.
    pub fn new(settings: &Settings, rel_tol: f64, max_points: u64) -> Self {
        let tolerance = settings.tolerance;
        Self {
            gap: GapLimit { tolerance, rel_tol },
            max_points,
            max_iterations: settings.max_iterations,
        }
    }

    /// Returns whether the tolerance is finer than what interpolated planes are good for.
    pub fn needs_exact_planes(&self, scale: &Scale) -> bool {
        let tolerance = scale.tolerance(self.gap.tolerance);
        !(tolerance > EXACT_PLANES_REL * scale.size() && tolerance > 64.0 * scale.support_eps())
    }
}

/// The corners of the polytope, by their indices: the interior point or known differences.
pub struct EpaCorners<const C: usize> {
    pairs: [VertexPair; C],
    len: usize,
}

impl<const C: usize> EpaCorners<C> {
    /// No corners. All zero, so that no pattern is copied.
    pub const EMPTY: Self = Self {
        pairs: [VertexPair { a: 0, b: 0 }; C],
        len: 0,
    };

    /// Begins with the corners of a tetrahedron.
    pub fn start(&mut self, corners: &[Vertex; 4]) {
        self.len = 0;
        for corner in corners {
            self.push(corner.pair);
        }
    }

    /// Returns whether another corner has no room.
    #[inline(always)]
    fn is_full(&self) -> bool {
        self.len >= C
    }

    /// Adds a corner and returns its index.
    #[inline(always)]
    fn push(&mut self, pair: VertexPair) -> usize {
        let id = self.len.min(C - 1);
        self.pairs[id] = pair;
        self.len = id + 1;
        id
    }

    /// Returns a corner. `interior`: the interior point.
    #[inline(always)]
    pub fn vertex<const N: usize>(&self, set: &VertexSet<N>, interior: &Vec3, id: usize) -> Vertex {
        let pair = self.pairs[id.min(C - 1)];
        let w = if pair.is_interior() {
            *interior
        } else {
            set.difference(pair)
        };
        Vertex { w, pair }
    }
}

/// Reason why an expansion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpandEnd {
    /// The bounds met.
    Converged,
    /// [`EpaLimits::max_points`].
    SupportLimit,
    /// [`EpaLimits::max_iterations`].
    IterationLimit,
    /// No point is above the closest face, which is not at the upper bound.
    Rounding,
    /// The vertices, the corners or the faces are full: go on in larger buffers.
    NoRoom,
}

/// Expands the polytope until the bounds meet. See the head of this file. `iterations`: of the query. `has_larger`: whether larger
/// buffers take over where these are full.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "the buffers have three sizes")]
pub fn expand<A: SupportMap, B: SupportMap, const N: usize, const C: usize, const F: usize>(
    query: &mut SupportQuery<'_, A, B>,
    set: &mut VertexSet<N>,
    fit: &mut SphereFit,
    interior: &Vec3,
    corners: &mut EpaCorners<C>,
    polytope: &mut EpaPolytope<F>,
    iterations: &mut u64,
    limits: &EpaLimits,
    has_larger: bool,
) -> Result<ExpandEnd, Stop> {
    // The key of the closest face when a fit's direction found nothing above it.
    let mut last_failed_key = -1.0;
    // Terminates: each turn evaluates, which fills the set, or inserts, which fills the corners, or makes a
    // key exact.
    loop {
        let closest = polytope.closest_face();
        polytope.set_size(query.scale.size());
        let tolerance = query.scale.tolerance(limits.gap.tolerance);
        let upper = query.upper.depth;
        let allowed = limits.gap.allowed(upper, tolerance);
        let error = polytope.error() + polytope.key_error(upper) + query.scale.support_eps();
        let target = upper - allowed + lesser(error, 0.5 * allowed);
        let target_key = target * target.abs();
        let is_inside = closest.key >= 0.0;
        if is_inside && closest.key >= target_key {
            if polytope.refresh_keys(target_key) {
                continue;
            }
            return Ok(ExpandEnd::Converged);
        }
        // While the origin is outside, the buffers are the only limit: the caller's limits must not make
        // a miss of an overlap.
        if is_inside && *iterations >= limits.max_iterations {
            return Ok(ExpandEnd::IterationLimit);
        }
        if is_inside && query.support_points() >= limits.max_points {
            return Ok(ExpandEnd::SupportLimit);
        }
        if set.is_full() || corners.is_full() {
            return Ok(ExpandEnd::NoRoom);
        }
        let face = closest.face;
        let (normal, offset) = (polytope.normal(face), polytope.offset(face));
        // A queried point is above the face by more than rounding; a known one is worth an insertion.
        let queried_level = query.scale.height_eps();
        let level = queried_level
            + if is_inside {
                KNOWN_LEVEL * allowed
            } else {
                0.0
            };
        let mut w = set.farthest_vertex(&normal);
        let height = normal.dot(&w.w) - offset;
        let distance = closest.key.sqrt();
        let is_gain =
            !(closest.key > 0.0) || height * distance > GAIN_REL * (upper - distance) * offset;
        // Of the largest buffers the queries that are left have theirs.
        let has_room = has_larger || C - corners.len > N - set.len();
        if !(height > level && is_gain && has_room) {
            let along_normal = !is_inside || closest.key == last_failed_key;
            let vertices = polytope
                .corners(face)
                .map(|id| corners.vertex(set, interior, id));
            let (sample, choice) =
                evaluate_beyond(query, set, fit, &vertices, &normal, allowed, along_normal)?;
            *iterations += 1;
            let queried_height = normal.dot(&sample.w) - offset;
            if queried_height > queried_level {
                w = sample.vertex();
            } else if choice != DirectionSource::Normal {
                last_failed_key = closest.key;
                continue;
            } else if query.upper.depth < upper {
                continue;
            } else if !(height > level) {
                return Ok(ExpandEnd::Rounding);
            }
            // Else the callbacks contradict a known difference, which was passed over for them.
        }
        let id = corners.push(w.pair);
        let corner = |id| corners.vertex(set, interior, id).w;
        if !polytope.insert(face, id, &w.w, queried_level, &corner) {
            corners.len -= 1;
            return Ok(ExpandEnd::NoRoom);
        }
    }
}

/// Returns the face through which the ray along `dir` leaves the polytope, about, and the point of it that
/// is closest to `foot`, `dir` times the depth.
///
/// Mostly that is the closest face, `closest`. Where several lie in one plane it is the one closest to the
/// foot, of all that the ray crosses no later than at the depth.
pub fn exit_face<const F: usize>(
    polytope: &EpaPolytope<F>,
    corner: &impl Fn(usize) -> Vec3,
    closest: usize,
    dir: &Vec3,
    depth: f64,
    tolerance: f64,
) -> usize {
    let foot = dir * depth;
    let distance2 = |f: usize| {
        let [a, b, c] = polytope.corners(f).map(corner);
        triangle(&foot, &a, &b, &c).distance2
    };
    let mut best = (closest, distance2(closest));
    if best.1 <= tolerance * lesser(tolerance, depth) {
        return best.0;
    }
    for f in polytope.faces() {
        let rise = polytope.normal(f).dot(dir);
        if rise > 0.0 && polytope.offset(f) <= rise * (depth + tolerance) {
            let other = distance2(f);
            if other < best.1 {
                best = (f, other);
            }
        }
    }
    best.0
}
