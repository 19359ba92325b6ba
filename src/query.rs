// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The queries of a pair. [`Pair::run`] runs the one that a [`Solver`] names:
//!
//! 1. *Separate*: evaluate the separating axis of the last query. If it still separates, the query ends after one
//!    support point.
//! 2. *Minimize* or *descend*: find the global or a local minimum of the depth, from the state of the last query, else
//!    along the line of the centers, else along the caller's first direction.
//! 3. *Prove the overlap*: a local minimum of the support function can be positive though the objects are separated,
//!    e.g. for a thin plate with the object on its far side. The certificate of the global minimum implies the overlap;
//!    the local search tests its last face; queries without either use [`Pair::prove_overlap`].
//! 4. *Contact position*: compute the [`contact_position`], or take the middle of the witness points.
//! 5. *Note the result*: the state for the next query keeps the separating axis, or what the solver returned of an overlap.
//!
//! `include/README.md` has the outputs of each query. All assume valid support functions ([`crate::types`]).

pub mod signed_distance;

use core::hint::black_box;

use crate::along;
use crate::contact::center_of_pressure::contact_position;
use crate::epa::buffers::{Arena, MAX_DEFAULT_POINTS, MAX_PROVEN_POINTS};
use crate::epa::global_minimum::EpaRequest;
use crate::epa::{self, expand::EpaLimits};
use crate::gjk::overlap::{CAPACITY, contains_origin, overlap};
use crate::local;
use crate::math::{ITERATION_CAP, Vec3, larger, unit};
use crate::minkowski::general_position::MAX_TILT_RAD;
use crate::minkowski::separating_axis::test_axis;
use crate::minkowski::support::{Difference, Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::tolerance::{GAP_REL, Scale};
use crate::minkowski::vertex_set::VertexSet;
use crate::minkowski::warm_start::{WarmKind, WarmStart};
use crate::paper::gao::{self, Until};
use crate::query::signed_distance::DistanceOptions;
use crate::trace;
use crate::types::{Direction, Settings, Solution, Status};

/// A query by name: what C and Rust callers choose between.
#[derive(Clone, Copy, Debug)]
pub enum Solver {
    /// [`Pair::intersect`]: whether the objects overlap; its result is blank.
    Intersect,
    /// The global minimum of the depth within the larger of the tolerance and 0.1 %, with at most
    /// [`MAX_DEFAULT_POINTS`] support points; if these do not suffice, a local search improves the depth. Assumes that
    /// the centers lie in their objects.
    Global,
    /// [`Pair::proven`]: the global minimum within the tolerance, without the centers.
    Proven,
    /// [`Pair::local`]: a local minimum.
    Local,
    /// [`Pair::along`]: the depth along this direction, of any length.
    Along(Vec3),
    /// [`Pair::incremental`] in the plane with this normal, of any length.
    Planar(Vec3),
    /// [`Pair::incremental`]: the published method.
    Incremental,
    /// [`Pair::signed_distance`] of the objects with these margins.
    Distance(DistanceOptions),
}

impl Solver {
    /// Returns the solver with a unit direction.
    ///
    /// # Errors
    /// [`Fault::Direction`].
    #[inline(always)]
    fn normalised(self) -> Result<Self, Fault> {
        Ok(match self {
            Solver::Along(dir) => Solver::Along(unit_direction(&dir)?),
            Solver::Planar(normal) => Solver::Planar(unit_direction(&normal)?),
            solver => solver,
        })
    }
}

/// Returns a caller's direction as a unit vector.
///
/// # Errors
/// [`Fault::Direction`].
pub fn unit_direction(dir: &Vec3) -> Result<Vec3, Fault> {
    unit(dir).ok_or(Fault::Direction)
}

/// A pair of objects, and what its caller wants to know of it: the input of a query.
pub struct Pair<A, B> {
    /// The Minkowski difference of the objects.
    difference: MinkowskiDifference<A, B>,
    /// The difference of the callers' centers and the centers themselves, if both are given.
    centers: Option<SupportPoint>,
    /// The caller's first direction, if given.
    first_dir: Option<Vec3>,
    /// The tolerance, the limits and the requested results.
    settings: Settings,
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Pairs two objects.
    ///
    /// # Errors
    /// [`Fault::Tolerance`], [`Fault::Center`].
    #[inline(always)]
    pub fn new(
        (obj1, obj2): (A, B),
        centers: Option<SupportPoint>,
        first_dir: Option<Vec3>,
        settings: &Settings,
    ) -> Result<Self, Fault> {
        if centers.is_some_and(|c| !c.v.sum().is_finite()) {
            return Err(Fault::Center);
        }
        if !(settings.tolerance >= 0.0) {
            return Err(Fault::Tolerance);
        }
        Ok(Self {
            difference: MinkowskiDifference::new(obj1, obj2),
            centers,
            first_dir,
            settings: Settings {
                max_iterations: settings.max_iterations.min(ITERATION_CAP),
                ..*settings
            },
        })
    }

    /// Runs a query from the state of the last one, and stores the state of an overlap in it. The caller stores that of a
    /// separation by [`WarmStart::note_separation`]. `arena`: used by [`Solver::Proven`] and [`Solver::Distance`] alone.
    ///
    /// # Errors
    /// [`Stop::Separated`], not of [`Solver::Distance`]; [`Stop::Fault`], also for a direction or an option that is
    /// invalid: the state is then not for use.
    #[inline(always)]
    pub fn run(
        &self,
        solver: Solver,
        state: &mut WarmStart,
        arena: &mut dyn Arena,
    ) -> Result<Solution, Stop> {
        let solver = solver.normalised()?;
        // A distance starts from the axis.
        if !matches!(solver, Solver::Distance(_)) {
            self.separate(state)?;
        }
        let mut found;
        let mut attempts = 0;
        loop {
            found = self.solve(solver, state, arena);
            attempts += 1;
            // If points contradict each other, once more from a cold state, with all directions tilted.
            if attempts == 2 || !self.difference.is_contradicted() {
                break;
            }
            *state = WarmStart::COLD;
        }
        if let Ok(hit) = &mut found {
            hit.finish(self.difference.supports(), &self.settings);
        }
        trace::end(found.as_ref().ok());
        found
    }

    /// Runs the solver.
    ///
    /// # Errors
    /// As [`Pair::run`].
    #[inline(always)]
    fn solve(
        &self,
        solver: Solver,
        state: &mut WarmStart,
        arena: &mut dyn Arena,
    ) -> Result<Solution, Stop> {
        match solver {
            Solver::Intersect => self.intersect(state),
            Solver::Global => {
                let limits = EpaLimits::new(&self.settings, GAP_REL, MAX_DEFAULT_POINTS);
                self.minimize(self.centers.as_ref(), &limits, false, state, None)
            }
            Solver::Proven => self.proven(state, arena),
            Solver::Local => self.local(state),
            Solver::Along(dir) => self.along(&dir, state),
            Solver::Planar(normal) => self.incremental(Some(normal), state),
            Solver::Incremental => self.incremental(None, state),
            Solver::Distance(options) => self.signed_distance(options, state, arena),
        }
    }

    /// Evaluates the separating axis of the last query, if there is one.
    ///
    /// # Errors
    /// [`Stop::Separated`] with the axis for the next query: the axis separates. [`Fault::NonFinite`].
    #[inline(always)]
    fn separate(&self, state: &mut WarmStart) -> Result<(), Stop> {
        let Some(mut axis) = state.separating_axis() else {
            return Ok(());
        };
        axis = axis.general();
        if test_axis(&self.difference, &mut axis.n)? {
            trace::end(None);
            return Err(Stop::Separated(axis));
        }
        Ok(())
    }

    /// Returns the direction of the state if it is used, else that of a cold query.
    #[inline(always)]
    fn start(&self, state: &WarmStart, is_used: bool) -> Direction {
        match is_used {
            true => state.dir,
            false => Direction::exact(self.cold_start()),
        }
    }

    /// Returns the start direction of a cold query, unit: from the difference of the centers to the origin, else
    /// the caller's first direction, else x.
    #[inline(always)]
    fn cold_start(&self) -> Vec3 {
        let first = match (&self.centers, &self.first_dir) {
            (Some(c), _) => {
                // Three loads: codegen, see README.
                let [x, y, z] = [c.v.x, c.v.y, c.v.z].map(black_box);
                unit(&Vec3::new(-x, -y, -z))
            }
            (None, Some(dir)) => unit(dir),
            (None, None) => None,
        };
        first.unwrap_or(Vec3::x())
    }

    /// Proves the overlap of a solver's `hit`, with the known vertices of `set` first, and support calls if needed. If
    /// the depth is at most the tolerance and the witness points, moved by it, do not coincide, replaces them by
    /// two coincident points of the objects. `is_planar`: D lies in a plane. Returns the lengths of the pair.
    ///
    /// # Errors
    /// [`Stop::Separated`]: an evaluated direction separates. [`Fault::NonFinite`].
    #[inline(never)]
    fn prove_overlap(
        &self,
        hit: &mut Solution,
        set: &mut VertexSet<CAPACITY>,
        is_planar: bool,
    ) -> Result<Scale, Stop> {
        let tolerance = self.settings.tolerance;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let witness = SupportPoint::new(hit.point1, hit.point2);
        query.scale.note(&witness);
        // Objects that touch within rounding count as separated, in every query.
        if !(hit.depth * hit.dir.dot(&hit.normal) > query.scale.contact_eps()) {
            return Err(Stop::Separated(hit.direction()));
        }
        if set.len() == 0 {
            // Without a direction: no support call returned this point.
            set.push(&Vec3::zeros(), &witness);
        }
        // Below a few contact epsilons the witness points are mostly rounding error.
        let tolerance = larger(tolerance, 4.0 * query.scale.contact_eps());
        let center = self.centers.as_ref();
        let dir = center.and_then(|c| unit(&-c.v)).unwrap_or(hit.normal);
        let found = contains_origin(&mut query, set, center, &dir, is_planar)?;
        let error = hit.point1 - hit.point2 - hit.dir * hit.depth;
        if hit.depth <= tolerance && error.norm() > tolerance {
            let (p1, p2) = found.witnesses();
            // The weights are rounded: take the midpoint of both.
            let half = (p1 - p2) * 0.5;
            (hit.point1, hit.point2) = (p1 - half, p2 + half);
        }
        Ok(query.scale)
    }

    /// Tests whether the objects overlap; returns [`Stop::Separated`] if they do not. The result is blank.
    #[inline(always)]
    fn intersect(&self, state: &mut WarmStart) -> Result<Solution, Stop> {
        let first = self.start(state, state.is_overlap());
        let dir = overlap(&self.difference, self.centers.as_ref(), &first)?;
        // A state with a depth, from a penetration query, is more useful: keep it.
        if !(state.is_overlap() && state.depth > 0.0) {
            *state = WarmStart::towards(Direction::remembered(dir, true));
        }
        Ok(Solution::default())
    }

    /// Finds a local minimum of the depth by the local search ([`crate::local`]). If that ends without one,
    /// runs the global search from the direction of the upper bound.
    fn local(&self, state: &mut WarmStart) -> Result<Solution, Stop> {
        // One variable, not unpacked: codegen, see README.
        let mut found = self.descend(state);
        if let Ok(hit) = &found {
            if hit.status != Status::Converged {
                found = self.search_globally(hit.iterations, state);
            }
        }
        found
    }

    /// Continues [`Pair::local`], whose walk took so many iterations, by the global search from the state.
    #[cold]
    #[inline(never)]
    fn search_globally(&self, iterations: u64, state: &mut WarmStart) -> Result<Solution, Stop> {
        let mut limits = EpaLimits::new(&self.settings, 0.0, MAX_DEFAULT_POINTS);
        limits.max_iterations -= iterations;
        let mut hit = self.minimize(self.centers.as_ref(), &limits, true, state, None)?;
        if self.centers.is_some() {
            // The lower bound would depend on the caller's centers.
            hit.depth_lower = 0.0;
        }
        hit.iterations += iterations;
        Ok(hit)
    }

    /// Runs the local search. Not inlined, so that its stack frame is released before the global search runs.
    #[inline(never)]
    fn descend(&self, state: &mut WarmStart) -> Result<Solution, Stop> {
        let start = self.start(state, state.kind != WarmKind::Cold);
        let tolerance = self.settings.tolerance;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        let mut found = local::local_minimum(&mut query, &mut set, &start, &self.settings);
        if let Ok(hit) = &mut found {
            *state = WarmStart::hit(hit);
            if hit.status == Status::Converged && self.settings.pos {
                match self.contact_position(&set, hit, &query.scale) {
                    Ok(pos) => hit.pos = pos,
                    Err(fault) => found = Err(fault.into()),
                }
            }
        }
        found
    }

    /// Improves an uncertified depth by a local search from its direction, to a hundredth of the tolerance. If the
    /// minimum is not unique, a polytope may not certify it within the limits, and the upper bound may exceed it
    /// by more than the tolerance; but the direction of the upper bound is close to a minimum.
    /// Returns whether the depth is a local minimum within the tolerance. The status changes only if the new depth closes
    /// the gap to the lower bound.
    #[cold]
    #[inline(never)]
    fn improve_locally(&self, hit: &mut Solution, limits: &EpaLimits) -> Result<bool, Fault> {
        let settings = Settings {
            tolerance: limits.gap.tolerance * 0.01,
            max_iterations: limits.max_iterations.saturating_sub(hit.iterations),
            ..self.settings
        };
        let tolerance = settings.tolerance;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        let found = local::local_minimum(&mut query, &mut set, &hit.direction(), &settings);
        let Some(found) = if_overlapping(found)? else {
            return Ok(false);
        };
        let is_minimum = found.status == Status::Converged
            && found.depth <= hit.depth + query.scale.tolerance(settings.tolerance);
        if is_minimum {
            *hit = Solution {
                depth_lower: hit.depth_lower.min(found.depth),
                iterations: hit.iterations + found.iterations,
                status: hit.status,
                ..found
            };
            if hit.depth - hit.depth_lower <= limits.gap.allowed(&query.scale, hit.depth) {
                hit.status = Status::Converged;
            }
        }
        Ok(is_minimum)
    }

    /// Finds the global minimum of the depth within the tolerance. The proof uses only support points; the
    /// centers select only where the search starts.
    #[inline(always)]
    fn proven(&self, state: &mut WarmStart, arena: &mut dyn Arena) -> Result<Solution, Stop> {
        let limits = EpaLimits::new(&self.settings, 0.0, MAX_PROVEN_POINTS);
        self.minimize(None, &limits, false, state, Some(arena))
    }

    /// Computes the least distance by which obj2 must move along unit `dir` to separate the objects.
    #[inline(never)]
    fn along(&self, dir: &Vec3, state: &mut WarmStart) -> Result<Solution, Stop> {
        let mut set = VertexSet::EMPTY;
        let mut hit = along::depth_along(&self.difference, &mut set, dir, &self.settings)?;
        self.prove_overlap(&mut hit, &mut set, false)?;
        *state = WarmStart::towards(hit.direction());
        hit.pos = hit.middle();
        Ok(hit)
    }

    /// Finds a local minimum of the depth by W. Gao's method with the shortcut (Algorithms 4 and 5), from the
    /// last direction, else from the start direction of a cold query. `plane`: a unit normal; only directions
    /// perpendicular to it are searched.
    fn incremental(&self, plane: Option<Vec3>, state: &mut WarmStart) -> Result<Solution, Stop> {
        let mut start = self.start(state, state.kind != WarmKind::Cold);
        if let Some(m) = plane.filter(|_| !start.is_general()) {
            start = Direction::tilted_in_plane(&start.n, &m, MAX_TILT_RAD);
        }
        // Each iteration takes one support point; the start, the overlap and the contact position take the rest of the
        // limit of the tests (`call_limit` in c-tests/tests/stability/entries.h).
        let settings = Settings {
            max_iterations: self.settings.max_iterations.min(MAX_PROVEN_POINTS),
            ..self.settings
        };
        let until = Until::Shortcut;
        let mut hit =
            gao::incremental_minimum(&self.difference, start.n, plane, until, &settings, |_| ())?;
        let mut set = VertexSet::EMPTY;
        let scale = self.prove_overlap(&mut hit, &mut set, plane.is_some())?;
        *state = WarmStart::towards(hit.direction());
        hit.pos = if settings.pos && hit.status == Status::Converged && plane.is_none() {
            self.contact_position(&set, &hit, &scale)?
        } else {
            hit.middle()
        };
        Ok(hit)
    }

    /// Finds the global minimum of the depth from the state. `center`: the difference of trusted centers.
    /// `accepts_local`: a local minimum within the tolerance counts as converged.
    #[inline(never)]
    fn minimize(
        &self,
        center: Option<&SupportPoint>,
        limits: &EpaLimits,
        accepts_local: bool,
        state: &mut WarmStart,
        arena: Option<&mut dyn Arena>,
    ) -> Result<Solution, Stop> {
        let ray = self.cold_start();
        let dir = match state.is_overlap() {
            true => state.dir,
            false => Direction::exact(ray),
        };
        let mut query = SupportQuery::new(&self.difference, center, limits.gap.tolerance);
        // Most queries of separated objects end here, before the request is made.
        let first = query.evaluate_first(&dir)?;
        let request = EpaRequest {
            center,
            ray,
            limits: *limits,
            wants_points: self.settings.points || self.settings.pos,
        };
        self.minimize_from(&mut query, &first, &request, accepts_local, state, arena)
    }

    /// Continues [`Pair::minimize`] after the first direction, which does not separate, and computes the contact
    /// position. Not inlined, so that the known vertices are on the stack only here.
    #[inline(never)]
    fn minimize_from(
        &self,
        query: &mut SupportQuery<'_, MinkowskiDifference<A, B>>,
        first: &SupportPoint,
        request: &EpaRequest<'_>,
        accepts_local: bool,
        state: &mut WarmStart,
        arena: Option<&mut dyn Arena>,
    ) -> Result<Solution, Stop> {
        let mut set = VertexSet::EMPTY;
        let mut hit =
            epa::global_minimum::global_minimum(query, first, request, arena, &mut set, state)?;
        *state = WarmStart::hit(&hit);
        if hit.status == Status::Converged {
            if self.settings.pos {
                hit.pos = self.contact_position(&set, &hit, &query.scale)?;
            }
            return Ok(hit);
        }
        let is_minimum = hit.status != Status::InconsistentSupport
            && self.improve_locally(&mut hit, &request.limits)?;
        hit.status = hit.status.unless(is_minimum && accepts_local);
        hit.pos = hit.middle();
        if hit.status == Status::Converged && self.settings.pos {
            hit.pos = self.cold_contact_position(&hit, &query.scale)?;
        }
        Ok(hit)
    }

    /// Returns the contact position of a hit. `set`, `scale`: the known vertices and the lengths of its search. The
    /// tolerance of the position is the effective one: the requested one may be larger than the objects.
    #[inline(always)]
    fn contact_position<const N: usize>(
        &self,
        set: &VertexSet<N>,
        hit: &Solution,
        scale: &Scale,
    ) -> Result<Vec3, Fault> {
        let tolerance = scale.tolerance(self.settings.tolerance);
        contact_position(&self.difference, set, hit, self.centers.as_ref(), tolerance)
    }

    /// Computes the contact position without known vertices. Not inlined, so that its set is on the stack only here.
    #[cold]
    #[inline(never)]
    fn cold_contact_position(&self, hit: &Solution, scale: &Scale) -> Result<Vec3, Fault> {
        let set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        self.contact_position(&set, hit, scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::test_shapes::{Random, capsule, corners, hull, placed};

    const SETTINGS: Settings = Settings {
        max_iterations: 1000,
        ..Settings::new(if EPSILON < 1e-10 { 1e-7 } else { 1e-4 })
    };

    /// Returns the pair of two objects, whose caller reads everything.
    fn pair_of<A: SupportMap, B: SupportMap>(a: A, b: B, centers: Option<[Vec3; 2]>) -> Pair<A, B> {
        let centers = centers.map(|[v1, v2]| SupportPoint::new(v1, v2));
        Pair::new((a, b), centers, None, &SETTINGS).unwrap()
    }

    /// Returns the number of support points, the depth and the new state of a query from this state.
    fn local_query<A: SupportMap, B: SupportMap>(
        a: A,
        b: B,
        mut state: WarmStart,
    ) -> (u64, f64, WarmStart) {
        let pair = pair_of(a, b, None);
        let hit = pair.local(&mut state).unwrap();
        assert_eq!(hit.status, Status::Converged);
        (pair.difference.supports(), hit.depth, state)
    }

    #[test]
    fn flipped_state_serves_the_swapped_pair() {
        let mut r = Random::new(7);
        for _ in 0..100 {
            let points = placed(
                &corners(Vec3::new(0.5, 0.6, 0.7)),
                &r.rotation(),
                r.vector(0.2),
            );
            let (p, q) = (r.vector(0.5), r.vector(0.5));
            let (cube, rod) = (|| hull(&points), || capsule(p, q, 0.3));
            let start = WarmStart::guess(&r.direction());
            let (_, _, after) = local_query(cube(), rod(), start);
            let (supports, depth, _) = local_query(cube(), rod(), after);
            let mut flipped = after;
            flipped.flip();
            let (swapped_supports, swapped_depth, _) = local_query(rod(), cube(), flipped);
            assert!(
                swapped_supports <= supports + 2,
                "{swapped_supports} {supports}"
            );
            assert!((depth - swapped_depth).abs() <= SETTINGS.tolerance);
        }
    }

    /// Tests that a local query with centers, on which its overlap may depend, returns no lower bound.
    #[test]
    fn local_query_has_no_lower_bound() {
        let mut r = Random::new(8);
        let a = corners(Vec3::repeat(1.0));
        for _ in 0..100 {
            let b = placed(&a, &r.rotation(), r.vector(1.0));
            let v1 = r.vector(3.0);
            let pair = pair_of(hull(&a), hull(&b), Some([v1, Vec3::zeros()]));
            let mut state = WarmStart::guess(&r.direction());
            if let Ok(hit) = pair.local(&mut state) {
                assert_eq!(hit.depth_lower, 0.0);
            }
        }
    }

    /// Tests that an intersection test stores its direction in place of a guess, so that the next test takes fewer
    /// support points than a cold one.
    #[test]
    fn intersection_test_stores_its_direction() {
        let mut r = Random::new(9);
        let (mut again, mut cold) = (0, 0);
        for _ in 0..200 {
            // Plates that overlap by the rims of their faces.
            let (plate, turn) = (corners(Vec3::new(0.5, 0.5, 0.1)), r.rotation());
            let at = turn * Vec3::new(r.within(0.3, 0.8), r.within(0.3, 0.8), 0.19);
            let (a, b) = (
                placed(&plate, &turn, Vec3::zeros()),
                placed(&plate, &turn, at),
            );
            let pair = pair_of(hull(&a), hull(&b), Some([Vec3::zeros(), at]));
            let mut state = WarmStart::guess(&r.direction());
            if pair.intersect(&mut state).is_ok() {
                let before = pair.difference.supports();
                pair.intersect(&mut state).unwrap();
                let after = pair.difference.supports();
                pair.intersect(&mut { WarmStart::COLD }).unwrap();
                (again, cold) = (
                    again + after - before,
                    cold + pair.difference.supports() - after,
                );
            }
        }
        assert!(cold > 300 && 10 * again <= 9 * cold, "{again} {cold}");
    }
}
