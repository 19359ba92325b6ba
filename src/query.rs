// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The queries of a pair, and the steps that the penetration queries share. (The intersection test is in
//! [`crate::gjk::intersect`], the signed distance in [`mod@signed_distance`].)
//!
//! 1. *Separating axis*: evaluate the separating axis of the last query. If it still separates, the query
//!    ends after one support point.
//! 2. *Solver*: run it from the warm start state, else from the difference of the centers, else from the
//!    caller's first direction.
//! 3. *Overlap*: a local minimum of the support function can be positive though the objects are separated,
//!    e.g. for a thin plate with the object on its far side. Therefore the solvers of local minima prove the overlap
//!    separately ([`contains_origin`]); the certificate of the global minimum implies it.
//! 4. *Contact position*: compute the [`contact_position`], or take the middle of the witness points.
//! 5. *Warm start state*: store it in the [`WarmStart`], if the caller keeps one.
//!
//! `include/README.md` has the outputs of each query. All assume valid support functions ([`crate::types`]).

pub mod signed_distance;

use crate::contact::center_of_pressure::contact_position;
use crate::epa::penetration::{Arena, EpaRequest, MAX_DEFAULT_POINTS, MAX_PROVEN_POINTS};
use crate::epa::{self, expand::EpaLimits};
use crate::gjk::intersect::{CAPACITY, contains_origin, intersect};
use crate::local;
use crate::math::{Vec3, larger, unit};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::tolerance::GAP_REL;
use crate::minkowski::vertex_set::VertexSet;
use crate::minkowski::warm_start::{WarmKind, WarmStart};
use crate::query::signed_distance::{Distance, Wanted, signed_distance};
use crate::types::{Penetration, Settings, Status};

/// The input of a query: two objects, their centers, and the first direction.
pub struct Pair<A, B> {
    /// The Minkowski difference of the objects.
    pub difference: MinkowskiDifference<A, B>,
    /// The difference of the callers' centers and the centers themselves, if both are given.
    pub centers: Option<SupportPoint>,
    /// The caller's first direction, if given.
    pub first_dir: Option<Vec3>,
    /// True if the caller keeps the state.
    pub keeps_state: bool,
    /// True if the caller reads the witness points or the contact position.
    pub wants_points: bool,
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Evaluates the separating axis of the last query and, if it does not separate, runs `solve`. Stores the
    /// separating axis found by either.
    #[inline(always)]
    pub fn with_separating_axis<R>(
        &self,
        state: &mut WarmStart,
        solve: impl FnOnce(&mut WarmStart) -> Result<R, Stop>,
    ) -> Result<R, Stop> {
        let mut target_separation = 0.0;
        if let Some(mut axis) = state.separating_axis() {
            let found = axis.test(&mut SupportQuery::new(&self.difference, None, 0.0))?;
            target_separation = axis.target_separation;
            if let Some(n) = found {
                *state = WarmStart::separated(axis.dir, target_separation, state.radius);
                return Err(Stop::Separated(n));
            }
        }
        let found = solve(state);
        if let Err(Stop::Separated(n)) = &found {
            *state = WarmStart::separated(*n, target_separation, state.radius);
        }
        found
    }

    /// Returns the start direction of a cold query, unit: from the difference of the centers to the origin, else
    /// the caller's first direction, else x.
    pub fn cold_start(&self) -> Vec3 {
        let from_center = self.centers.and_then(|c| unit(&-c.v));
        from_center
            .or_else(|| self.first_dir.and_then(|d| unit(&d)))
            .unwrap_or(Vec3::x())
    }

    /// Proves the overlap of a solver's `hit`, with the known vertices of `set` first, and queries if needed. If
    /// the depth is at most the tolerance and the witness points, moved by it, do not coincide, replaces them by
    /// two coincident points of the objects. `is_planar`: D lies in a plane.
    ///
    /// # Errors
    /// [`Stop::Separated`]: a queried direction separates. [`Fault::NonFinite`].
    #[inline(never)]
    pub fn prove_overlap(
        &self,
        hit: &mut Penetration,
        set: &mut VertexSet<CAPACITY>,
        settings: &Settings,
        is_planar: bool,
    ) -> Result<(), Stop> {
        let tolerance = settings.tolerance;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let witness = SupportPoint {
            v: hit.point1 - hit.point2,
            v1: hit.point1,
            v2: hit.point2,
        };
        query.scale.note(&witness);
        // Objects that touch within rounding count as separated, in every query.
        if !(hit.depth * hit.dir.dot(&hit.normal) > query.scale.contact_eps()) {
            return Err(Stop::Separated(hit.normal));
        }
        if set.len() == 0 {
            // Without a direction: no support call returned this point.
            set.push(&Vec3::zeros(), &witness);
        }
        // Below a few contact epsilons the witness points are mostly rounding error.
        let tolerance = larger(settings.tolerance, 4.0 * query.scale.contact_eps());
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
        Ok(())
    }

    /// Returns the state with the direction of the difference of the centers, if both are given.
    pub fn with_centers(&self, mut state: WarmStart) -> WarmStart {
        if let Some(center) = &self.centers {
            state.set_center_direction(&center.v);
        }
        state
    }

    /// Tests whether the objects overlap; returns [`Stop::Separated`] if they do not.
    #[inline]
    pub fn intersect(&self, state: Option<&mut WarmStart>) -> Result<(), Stop> {
        let Some(state) = state else {
            let first = self.cold_start();
            return intersect(&self.difference, self.centers.as_ref(), &first, false).map(|_| ());
        };
        self.with_separating_axis(state, |state| {
            let is_remembered = state.is_overlap();
            let first = if is_remembered {
                state.dir
            } else {
                self.cold_start()
            };
            let centers = self.centers.as_ref();
            let dir = intersect(&self.difference, centers, &first, is_remembered)?;
            // A state with a depth, from a penetration query, is more useful: keep it.
            if !(state.is_overlap() && state.depth > 0.0) {
                *state = self.with_centers(WarmStart::towards(dir));
            }
            Ok(())
        })
    }

    /// Computes the signed distance. `minimum` computes the least depth of overlapping objects.
    pub fn signed_distance(
        &self,
        state: &mut WarmStart,
        wanted: &Wanted,
        minimum: impl Fn(&Self, &mut WarmStart, &Settings, &mut Penetration) -> Result<(), Stop>,
    ) -> Result<Distance, Fault> {
        let depth = |state: &mut WarmStart, hit: &mut Penetration| {
            minimum(self, state, &wanted.settings, hit)
        };
        let centers = self.centers.as_ref();
        signed_distance(
            &self.difference,
            centers,
            wanted,
            &self.cold_start(),
            state,
            depth,
        )
    }

    /// Finds a local minimum of the depth by the local search ([`crate::local`]). If that ends without one,
    /// runs the global search from the direction of the upper bound.
    pub fn local(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.run_local(state, settings, wants_pos, hit)?;
        if hit.status == Status::Converged {
            return Ok(());
        }
        let local_iterations = hit.iterations;
        let mut limits = EpaLimits::new(settings, 0.0, MAX_DEFAULT_POINTS);
        limits.max_iterations -= local_iterations;
        // A local minimum suffices here.
        if self.run_global(self.centers.as_ref(), state, &limits, None, wants_pos, hit)? {
            hit.status = Status::Converged;
            if wants_pos {
                hit.pos = self.cold_contact_position(hit, settings.tolerance)?;
            }
        }
        if self.centers.is_some() {
            // The lower bound would depend on the caller's centers.
            hit.depth_lower = 0.0;
        }
        hit.iterations += local_iterations;
        Ok(())
    }

    /// Computes the contact position without known vertices. Not inlined, so that its set is on the stack only here.
    #[cold]
    #[inline(never)]
    fn cold_contact_position(&self, hit: &Penetration, tolerance: f64) -> Result<Vec3, Fault> {
        let set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        self.contact_position(&set, hit, tolerance)
    }

    /// Runs the local search. Not inlined, so that its stack frame is released before the global search runs.
    #[inline(never)]
    fn run_local(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.with_separating_axis(state, |state| {
            if self.centers.is_some_and(|c| state.is_swapped(&c.v)) {
                *state = WarmStart::COLD;
            }
            let start = state.direction().unwrap_or_else(|| self.cold_start());
            let is_remembered = state.direction().is_some();
            let tolerance = settings.tolerance;
            let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
            let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
            *hit = local::penetration(&mut query, &mut set, &start, is_remembered, settings)?;
            *state = self.with_centers(WarmStart::hit(hit.dir, hit.depth, [0.0; 2], false));
            if hit.status == Status::Converged && wants_pos {
                hit.pos = self.contact_position(&set, hit, settings.tolerance)?;
            }
            Ok(())
        })
    }

    /// Improves an uncertified depth by a local search from its direction, to a hundredth of the tolerance. If the
    /// minimum is not unique, a polytope may not certify it within the limits, and the upper bound may exceed it
    /// by more than the tolerance; but the direction of the upper bound is close to a minimum.
    /// Returns whether the depth is a local minimum within the tolerance. The status stays, why it is not certified,
    /// unless the lower depth closes the gap to the lower bound.
    #[cold]
    #[inline(never)]
    fn improve_locally(&self, hit: &mut Penetration, limits: &EpaLimits) -> Result<bool, Fault> {
        let settings = Settings {
            tolerance: limits.gap.tolerance * 0.01,
            max_iterations: limits.max_iterations.saturating_sub(hit.iterations),
        };
        let tolerance = settings.tolerance;
        let mut query = SupportQuery::new(&self.difference, self.centers.as_ref(), tolerance);
        let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        let start = hit.normal;
        let found = local::penetration(&mut query, &mut set, &start, true, &settings);
        let Some(found) = if_overlapping(found)? else {
            return Ok(false);
        };
        let is_minimum = found.status == Status::Converged
            && found.depth <= hit.depth + query.scale.tolerance(settings.tolerance);
        if is_minimum {
            *hit = Penetration {
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

    /// Finds the global minimum of the depth within the larger of the tolerance and 0.1 % of it, with at most
    /// [`MAX_DEFAULT_POINTS`] support points; if these do not suffice, a local search improves the depth. Assumes that
    /// the centers lie in their objects.
    pub fn penetration(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits::new(settings, GAP_REL, MAX_DEFAULT_POINTS);
        self.run_global(self.centers.as_ref(), state, &limits, None, wants_pos, hit)?;
        Ok(())
    }

    /// Finds the global minimum of the depth within the tolerance. The proof uses only support points; the
    /// centers select only where the search starts.
    pub fn proven(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        arena: &mut dyn Arena,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits::new(settings, 0.0, MAX_PROVEN_POINTS);
        self.run_global(None, state, &limits, Some(arena), wants_pos, hit)?;
        Ok(())
    }

    /// Finds the global minimum of the depth from the state. `interior`: a point trusted to lie in D. Returns
    /// whether a depth that is not certified is a local minimum within the tolerance.
    #[inline(never)]
    fn run_global(
        &self,
        interior: Option<&SupportPoint>,
        state: &mut WarmStart,
        limits: &EpaLimits,
        arena: Option<&mut dyn Arena>,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        self.with_separating_axis(state, |state| {
            let ray = self.cold_start();
            let is_remembered = state.kind == WarmKind::Overlap;
            let dir = if is_remembered { state.dir } else { ray };
            let tolerance = limits.gap.tolerance;
            let mut query = SupportQuery::new(&self.difference, interior, tolerance);
            // Most queries of separated objects end here, before the request is made.
            let first = query.evaluate_first(&dir, is_remembered)?;
            let request = EpaRequest {
                center: interior,
                ray,
                // A separating axis has been evaluated already.
                warm: match state.kind {
                    WarmKind::Separated => WarmStart::COLD,
                    _ => *state,
                },
                limits: *limits,
                wants_points: self.wants_points,
            };
            self.run_global_from_first(&mut query, &first, &request, arena, state, wants_pos, hit)
        })
    }

    /// Continues [`Pair::run_global`] if the first direction does not separate, and computes the contact
    /// position.
    #[inline(never)]
    #[allow(
        clippy::too_many_arguments,
        reason = "a separate stack frame holds the known vertices"
    )]
    fn run_global_from_first(
        &self,
        query: &mut SupportQuery<'_, A, B>,
        first: &SupportPoint,
        request: &EpaRequest<'_>,
        arena: Option<&mut dyn Arena>,
        state: &mut WarmStart,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let mut set = VertexSet::EMPTY;
        let warm = epa::penetration::penetration(query, first, request, arena, &mut set, hit)?;
        if self.keeps_state {
            *state = self.with_centers(warm);
        }
        if hit.status == Status::Converged {
            if wants_pos {
                hit.pos = self.contact_position(&set, hit, request.limits.gap.tolerance)?;
            }
            return Ok(false);
        }
        let is_minimum = hit.status != Status::InconsistentSupport
            && self.improve_locally(hit, &request.limits)?;
        let is_certified = hit.status == Status::Converged;
        hit.pos = if is_certified && wants_pos {
            self.cold_contact_position(hit, request.limits.gap.tolerance)?
        } else {
            hit.middle()
        };
        Ok(is_minimum && !is_certified)
    }

    /// Returns the contact position of a hit. `set`: the known vertices of its search.
    #[inline(always)]
    pub fn contact_position<const N: usize>(
        &self,
        set: &VertexSet<N>,
        hit: &Penetration,
        tolerance: f64,
    ) -> Result<Vec3, Fault> {
        contact_position(&self.difference, set, hit, self.centers.as_ref(), tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, capsule, corners, difference, hull, placed};

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-7 } else { 1e-4 },
        max_iterations: 1000,
    };

    /// Returns the number of support points, the depth and the new state of a query from this state.
    fn local_query<A: SupportMap, B: SupportMap>(
        a: A,
        b: B,
        mut state: WarmStart,
    ) -> (u64, f64, WarmStart) {
        let pair = Pair {
            difference: difference(a, b),
            centers: None,
            first_dir: None,
            keeps_state: true,
            wants_points: true,
        };
        let mut hit = Penetration::default();
        pair.local(&mut state, &SETTINGS, true, &mut hit).unwrap();
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
            let pair = Pair {
                difference: difference(hull(&a), hull(&b)),
                centers: Some(SupportPoint {
                    v: v1,
                    v1,
                    v2: Vec3::zeros(),
                }),
                first_dir: None,
                keeps_state: true,
                wants_points: true,
            };
            let mut state = WarmStart::guess(&r.direction());
            let mut hit = Penetration::default();
            if pair.local(&mut state, &SETTINGS, true, &mut hit).is_ok() {
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
            let pair = Pair {
                difference: difference(hull(&a), hull(&b)),
                centers: Some(SupportPoint {
                    v: -at,
                    v1: Vec3::zeros(),
                    v2: at,
                }),
                first_dir: None,
                keeps_state: true,
                wants_points: true,
            };
            let mut state = WarmStart::guess(&r.direction());
            if pair.intersect(Some(&mut state)).is_ok() {
                let before = pair.difference.supports();
                pair.intersect(Some(&mut state)).unwrap();
                let after = pair.difference.supports();
                pair.intersect(None).unwrap();
                (again, cold) = (
                    again + after - before,
                    cold + pair.difference.supports() - after,
                );
            }
        }
        assert!(cold > 300 && 10 * again <= 9 * cold, "{again} {cold}");
    }
}
