// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The queries of a pair, and the steps that the queries of the depth share. (The intersection test is
//! [`crate::gjk::intersect`], the distance [`crate::gjk::signed_distance`].)
//!
//! 1. *Separating axis*: the axis of the last query is evaluated first. While it separates, one support
//!    point is the whole query.
//! 2. *Solver*: starts from the warm state, else from the difference of the centers, else from the caller's
//!    first direction.
//! 3. *Overlap*: a local minimum of the support function can be positive though the objects are apart (a
//!    plate that an object has passed through, seen from the old side). So the origin is shown to be in
//!    a tetrahedron of points of D ([`contains_origin`]): of known vertices, and of queries where these
//!    leave a side open. The global search proves its overlaps itself.
//! 4. *Contact position*: the [`center_of_pressure`]; the middle of the witness points in `along` and
//!    `planar`, and of queries that did not converge.
//! 5. *Warm state*: stored in the [`WarmStart`], if the caller keeps one.

pub mod warm_start;

use crate::contact::center_of_pressure::center_of_pressure;
use crate::contact::{Penetration, Settings, Status};
use crate::epa::penetration::{Arena, EpaRequest, MAX_DEFAULT_POINTS, MAX_PROVEN_POINTS};
use crate::epa::{self, expand::EpaLimits};
use crate::gjk::intersect::{CAPACITY, contains_origin, intersect};
use crate::gjk::signed_distance::{Distance, Wanted, signed_distance};
use crate::math::{Vec3, larger, unit};
use crate::minkowski::query::{Stop, SupportQuery, if_overlapping};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::tolerance::GAP_REL;
use crate::minkowski::vertex_set::VertexSet;
use crate::mpr::gao::{self, Until};
use crate::mpr::{directional, local};
use warm_start::{WarmKind, WarmStart};

/// A pair and what the caller knows of it besides the state.
pub struct Pair<A, B> {
    /// The Minkowski difference.
    pub md: MinkowskiDifference<A, B>,
    /// The difference of the centers, where the caller gives them.
    pub center: Option<SupportPoint>,
    /// The caller's first direction, where it gives one.
    pub first_dir: Option<Vec3>,
    /// The caller keeps the state.
    pub keeps_state: bool,
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Runs `solve` if the axis of the last query does not separate, and stores the axis that does.
    #[inline(always)]
    fn with_separating_axis<R>(
        &self,
        state: &mut WarmStart,
        solve: impl FnOnce(&mut WarmStart) -> Result<R, Stop>,
    ) -> Result<R, Stop> {
        let mut aim = 0.0;
        if let Some(mut axis) = state.separating_axis() {
            let found = axis.test(&mut SupportQuery::new(&self.md, None))?;
            aim = axis.aim;
            if let Some(n) = found {
                *state = WarmStart::apart(axis.dir, aim, state.radius);
                return Err(Stop::Separated(n));
            }
        }
        let found = solve(state);
        if let Err(Stop::Separated(n)) = &found {
            *state = WarmStart::apart(*n, aim, state.radius);
        }
        found
    }

    /// The way from the center of D through the origin, or the caller's first
    /// direction, or any.
    pub fn cold_start(&self) -> Vec3 {
        let from_center = self.center.and_then(|c| unit(&-c.v));
        from_center
            .or_else(|| self.first_dir.and_then(|d| unit(&d)))
            .unwrap_or(Vec3::x())
    }

    /// Proves the overlap of a solver's `hit` from known vertices, and queries where they leave a side open.
    /// Replaces the witness points of a touch, within the tolerance, that do not meet by those that meet at the
    /// origin. `is_planar`: D is in a plane.
    ///
    /// # Errors
    /// [`Stop::Separated`]: a queried direction separates. [`Fault::NonFinite`].
    #[inline(never)]
    fn prove(
        &self,
        hit: &mut Penetration,
        set: &mut VertexSet<CAPACITY>,
        settings: &Settings,
        is_planar: bool,
    ) -> Result<(), Stop> {
        let mut query = SupportQuery::new(&self.md, self.center.as_ref());
        let met = SupportPoint {
            v: hit.point1 - hit.point2,
            v1: hit.point1,
            v2: hit.point2,
        };
        query.scale.note(&met);
        // A touch within rounding is a miss, in every query.
        if !(hit.depth * hit.dir.dot(&hit.normal) > query.scale.contact_eps()) {
            return Err(Stop::Separated(hit.normal));
        }
        if set.len() == 0 {
            // No support call returned it.
            set.push(&Vec3::zeros(), &met);
        }
        // A depth of a few contact epsilons has no place.
        let tolerance = larger(settings.tolerance, 4.0 * query.scale.contact_eps());
        let center = self.center.as_ref();
        let dir = center.and_then(|c| unit(&-c.v)).unwrap_or(hit.normal);
        let found = contains_origin(&mut query, set, center, &dir, is_planar)?;
        let apart = hit.point1 - hit.point2 - hit.dir * hit.depth;
        if hit.depth <= tolerance && apart.norm() > tolerance {
            let (p1, p2) = found.witnesses();
            // The weights are rounded.
            let rest = (p1 - p2) * 0.5;
            (hit.point1, hit.point2) = (p1 - rest, p2 + rest);
        }
        Ok(())
    }

    /// Returns the state with the direction of the difference of the centers, where they are given.
    fn facing(&self, mut state: WarmStart) -> WarmStart {
        if let Some(center) = &self.center {
            state.set_facing(&center.v);
        }
        state
    }

    /// Queries whether the objects overlap, from a state or cold. [`Stop::Separated`] where they do not.
    #[inline]
    pub fn intersect(&self, state: Option<&mut WarmStart>) -> Result<(), Stop> {
        let Some(state) = state else {
            let first = self.cold_start();
            return intersect(&self.md, self.center.as_ref(), &first).map(|_| ());
        };
        self.with_separating_axis(state, |state| {
            let first = match state.kind == WarmKind::Apart {
                true => self.cold_start(),
                false => state.direction().unwrap_or_else(|| self.cold_start()),
            };
            let dir = intersect(&self.md, self.center.as_ref(), &first)?;
            // The state of a depth query, which has a depth, is worth more.
            if !(state.is_overlap() && state.depth > 0.0) {
                *state = self.facing(WarmStart::towards(dir));
            }
            Ok(())
        })
    }

    /// Computes the signed distance; `minimum` computes the least depth of objects that overlap.
    pub fn signed_distance(
        &self,
        state: &mut WarmStart,
        wanted: &Wanted,
        minimum: impl Fn(&Self, &mut WarmStart, &Settings, &mut Penetration) -> Result<(), Stop>,
    ) -> Result<Distance, Fault> {
        let depth = |state: &mut WarmStart, hit: &mut Penetration| {
            minimum(self, state, &wanted.settings, hit)
        };
        signed_distance(&self.md, wanted, &self.cold_start(), state, depth)
    }

    /// Finds a local minimum of the depth by a walk on the known vertices; where that ends without one, the
    /// global minimum, from the direction of the least support value.
    pub fn local(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let status = self.walk(state, settings, wants_pos, hit)?;
        if status == Status::Converged {
            return Ok(());
        }
        let walked = hit.iterations;
        let mut limits = EpaLimits::new(settings, 0.0, MAX_DEFAULT_POINTS);
        limits.max_iterations -= walked;
        let is_minimum = self.global(self.center.as_ref(), state, &limits, None, wants_pos, hit)?;
        // No proof is wanted: a walk that ends at its direction is the answer.
        hit.limit &= !is_minimum;
        if self.center.is_some() {
            // The lower bound would rest on the caller's center.
            hit.depth_lower = 0.0;
        }
        hit.iterations += walked;
        Ok(())
    }

    /// Walks to a local minimum. (In a frame of its own: the global query needs its stack.)
    #[inline(never)]
    fn walk(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<Status, Stop> {
        self.with_separating_axis(state, |state| {
            if self.center.is_some_and(|c| state.is_swapped(&c.v)) {
                *state = WarmStart::COLD;
            }
            let start = state.direction().unwrap_or_else(|| self.cold_start());
            let mut query = SupportQuery::new(&self.md, self.center.as_ref());
            let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
            let (found, status) = local::penetration(&mut query, &mut set, &start, settings)?;
            *hit = found;
            *state = self.facing(WarmStart::hit(hit.dir, hit.depth, [0.0; 2], false));
            if status == Status::Converged && wants_pos {
                hit.pos = self.position(&set, hit, settings.tolerance)?;
            }
            Ok(status)
        })
    }

    /// Lowers a depth that the global query could not prove. Where minima form a curve or a surface, no polytope
    /// proves them in the steps there are, and the least depth met need not be theirs to the tolerance. But its
    /// direction is near them, and a walk from there finds one, to a hundredth of the tolerance.
    /// Returns whether the depth is that of a local minimum, within the tolerance.
    #[cold]
    #[inline(never)]
    fn lower(&self, hit: &mut Penetration, limits: &EpaLimits) -> Result<bool, Fault> {
        let settings = Settings {
            tolerance: limits.gap.tolerance * 0.01,
            max_iterations: limits.max_iterations.saturating_sub(hit.iterations),
        };
        let mut query = SupportQuery::new(&self.md, self.center.as_ref());
        let mut set = VertexSet::<{ local::MAX_WALK_POINTS }>::EMPTY;
        let start = hit.normal;
        let found = local::penetration(&mut query, &mut set, &start, &settings);
        let Some((found, Status::Converged)) = if_overlapping(found)? else {
            return Ok(false);
        };
        let is_minimum = found.depth <= hit.depth + query.scale.tolerance(settings.tolerance);
        if is_minimum {
            *hit = Penetration {
                depth_lower: hit.depth_lower.min(found.depth),
                iterations: hit.iterations + found.iterations,
                limit: true,
                ..found
            };
        }
        Ok(is_minimum)
    }

    /// Finds a local minimum of the depth by the paper's method, shortcut on (Algorithms 4, 5), from the last
    /// direction, else from the centers. `plane`: among the directions perpendicular to this unit vector; the
    /// position then is the middle of the witness points.
    pub fn incremental(
        &self,
        plane: Option<Vec3>,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.with_separating_axis(state, |state| {
            let start = state.direction().unwrap_or_else(|| self.cold_start());
            *hit = gao::penetration(&self.md, start, plane, Until::Shortcut, settings, |_| ())?;
            let mut set = VertexSet::EMPTY;
            self.prove(hit, &mut set, settings, plane.is_some())?;
            *state = self.facing(WarmStart::towards(hit.normal));
            hit.pos = if wants_pos && !hit.limit && plane.is_none() {
                self.position(&set, hit, settings.tolerance)?
            } else {
                hit.middle()
            };
            Ok(())
        })
    }

    /// Finds the minimum of the depth at MPR's price: within the tolerance or a thousandth of the depth, in at
    /// most [`MAX_DEFAULT_POINTS`] support points; where these do not do, a walk lowers the depth. Trusts the center.
    pub fn mpr(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits::new(settings, GAP_REL, MAX_DEFAULT_POINTS);
        self.global(self.center.as_ref(), state, &limits, None, wants_pos, hit)?;
        Ok(())
    }

    /// Finds the global minimum of the depth, proven by support points alone: from the state, else from the
    /// centers, else from the first direction.
    pub fn minimum(
        &self,
        state: &mut WarmStart,
        settings: &Settings,
        arena: &mut dyn Arena,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits::new(settings, 0.0, MAX_PROVEN_POINTS);
        self.global(None, state, &limits, Some(arena), wants_pos, hit)?;
        Ok(())
    }

    /// Finds the global minimum of the depth from the state. `apex`: a point that is trusted to be in D.
    /// Returns whether the depth is that of a minimum, a local one where `limit` is set.
    #[inline(never)]
    fn global(
        &self,
        apex: Option<&SupportPoint>,
        state: &mut WarmStart,
        limits: &EpaLimits,
        arena: Option<&mut dyn Arena>,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        self.with_separating_axis(state, |state| {
            let request = EpaRequest {
                center: apex,
                ray: self.cold_start(),
                // The axis of a state that was apart has been queried.
                warm: match state.kind {
                    WarmKind::Apart => WarmStart::COLD,
                    _ => *state,
                },
                limits: *limits,
            };
            let mut query = SupportQuery::new(&self.md, apex);
            let first = query.evaluate_first(&request.first_dir())?;
            self.overlap(query, &first, &request, arena, state, wants_pos, hit)
        })
    }

    /// Finds the global minimum of a pair whose first direction does not separate it, and the contact
    /// position.
    #[inline(never)]
    #[allow(
        clippy::too_many_arguments,
        reason = "a frame of its own, for the known vertices"
    )]
    fn overlap(
        &self,
        mut query: SupportQuery<'_, A, B>,
        first: &SupportPoint,
        request: &EpaRequest<'_>,
        arena: Option<&mut dyn Arena>,
        state: &mut WarmStart,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let mut set = VertexSet::EMPTY;
        let (status, warm) =
            epa::penetration::penetration(&mut query, first, request, arena, &mut set, hit)?;
        if self.keeps_state {
            *state = self.facing(warm);
        }
        hit.limit = status != Status::Converged;
        if !hit.limit {
            if wants_pos {
                hit.pos = self.position(&set, hit, request.limits.gap.tolerance)?;
            }
            return Ok(true);
        }
        let is_minimum =
            status != Status::InconsistentSupport && self.lower(hit, &request.limits)?;
        hit.pos = hit.middle();
        Ok(is_minimum)
    }

    /// Returns the center of pressure of a hit, from the vertices that its search has found.
    #[inline(always)]
    fn position<const N: usize>(
        &self,
        set: &VertexSet<N>,
        hit: &Penetration,
        tolerance: f64,
    ) -> Result<Vec3, Fault> {
        center_of_pressure(&self.md, set, hit, self.center.as_ref(), tolerance)
    }

    /// Computes how far obj2 must move along the unit direction `dir` to be separated.
    pub fn along(
        &self,
        dir: Vec3,
        state: &mut WarmStart,
        settings: &Settings,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.with_separating_axis(state, |state| {
            let capped = Settings {
                max_iterations: settings.max_iterations.min(MAX_PROVEN_POINTS),
                ..*settings
            };
            let (found, portal) = directional::along(&self.md, &dir, &capped)?;
            *hit = found;
            let mut set = VertexSet::EMPTY;
            for plane in portal.iter().flat_map(|p| &p.planes) {
                set.push(&plane.normal, &plane.point);
            }
            self.prove(hit, &mut set, settings, false)?;
            *state = self.facing(WarmStart::towards(hit.normal));
            hit.pos = hit.middle();
            Ok(())
        })
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

    /// Returns the support points, the depth and the state of a query from this state.
    fn local_query<A: SupportMap, B: SupportMap>(
        a: A,
        b: B,
        mut state: WarmStart,
    ) -> (u64, f64, WarmStart) {
        let pair = Pair {
            md: difference(a, b),
            center: None,
            first_dir: None,
            keeps_state: true,
        };
        let mut hit = Penetration::default();
        pair.local(&mut state, &SETTINGS, true, &mut hit).unwrap();
        assert!(!hit.limit);
        (pair.md.supports(), hit.depth, state)
    }

    #[test]
    fn a_flipped_state_serves_the_swapped_pair() {
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

    /// The overlap may rest on a center, and no bound is proven then.
    #[test]
    fn no_bound_leans_on_a_centre() {
        let mut r = Random::new(8);
        let a = corners(Vec3::repeat(1.0));
        for _ in 0..100 {
            let b = placed(&a, &r.rotation(), r.vector(1.0));
            let v1 = r.vector(3.0);
            let pair = Pair {
                md: difference(hull(&a), hull(&b)),
                center: Some(SupportPoint {
                    v: v1,
                    v1,
                    v2: Vec3::zeros(),
                }),
                first_dir: None,
                keeps_state: true,
            };
            let mut state = WarmStart::guess(&r.direction());
            let mut hit = Penetration::default();
            if pair.local(&mut state, &SETTINGS, true, &mut hit).is_ok() {
                assert_eq!(hit.depth_lower, 0.0);
            }
        }
    }

    /// An intersection test replaces the direction of the last one, and a guess: the next takes fewer support
    /// points than a cold one.
    #[test]
    fn an_intersection_leaves_the_direction_of_its_own() {
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
                md: difference(hull(&a), hull(&b)),
                center: Some(SupportPoint {
                    v: -at,
                    v1: Vec3::zeros(),
                    v2: at,
                }),
                first_dir: None,
                keeps_state: true,
            };
            let mut state = WarmStart::guess(&r.direction());
            if pair.intersect(Some(&mut state)).is_ok() {
                let before = pair.md.supports();
                pair.intersect(Some(&mut state)).unwrap();
                let after = pair.md.supports();
                pair.intersect(None).unwrap();
                (again, cold) = (again + after - before, cold + pair.md.supports() - after);
            }
        }
        assert!(cold > 300 && 10 * again <= 9 * cold, "{again} {cold}");
    }
}
