// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The queries of a pair, and the order of steps that those for the depth share. (Yes or no
//! is [`crate::gjk::intersect`]'s, the distance [`crate::gjk::signed_distance`].)
//!
//! 1. A pair that was apart is asked about the direction that separated it: while
//!    that still separates, one support point is the whole answer.
//! 2. The solver starts from what the state holds, else from the centres, else from
//!    the caller's first direction. (`along` starts from the last portal, `planar` from
//!    the part of that direction in its plane.)
//! 3. An overlap is proven. A local minimum of the support function can be positive
//!    though the objects are apart (a plate that an object has passed through, seen
//!    from the old side), so the origin must be shown to lie among points of D: in a
//!    tetrahedron of the centres' difference and three others ([`contains_origin`]). It puts
//!    the points the solver saw together anew, and asks for more only where these leave a side open. The global search (`mpr`, `minimum`) proves its
//!    overlaps itself.
//! 4. Where the contact position is wanted, it is the centre of pressure ([`pressure`]); the middle
//!    of the witness points in `along` and `planar`, and where a cap came first.
//! 5. What was learned stays behind in the [`State`]; where the caller keeps none, nothing
//!    is spent on it.

mod local_minimum;
pub mod warm_start;

use crate::contact::{Penetration, Settings, Status};
use crate::contacts::pressure::{self, Aside};
use crate::contacts::seen::Seen;
use crate::epa::penetration::{Arena, EpaAnswer, EpaRequest, MAX_PROVEN_SAMPLES, MAX_SAMPLES};
use crate::epa::{self, expand::EpaLimits};
use crate::gjk::intersect::{contains_origin, intersect};
use crate::gjk::separating_axis::SeparatingAxis;
use crate::gjk::signed_distance::{Distance, Start, Wanted, signed_distance};
use crate::math::{Vec3, larger, perpendicular, unit};
use crate::minkowski::query::{Stop, SupportQuery};
use crate::minkowski::round_fit::SphereFit;
use crate::minkowski::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::tolerance::{GAP_REL, GapLimit, Scale};
use crate::minkowski::vertex_set::VertexSet;
use crate::mpr::{
    self,
    gao::{self, Until},
};
use crate::state::State;
use warm_start::{WarmKind, WarmStart};

/// A pair and what the caller knows of it besides the state.
pub struct Pair<A, B> {
    /// The Minkowski difference.
    pub md: MinkowskiDifference<A, B>,
    /// The difference of the centres, where the caller gives them.
    pub centre: Option<SupportPoint>,
    /// The caller's first direction, where it gives one.
    pub first_dir: Option<Vec3>,
    /// Whether the caller keeps the state: then what is left in it may cost a few support
    /// points.
    pub lasting: bool,
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Steps 1 and 5 around what comes between: `solve` is asked where the direction that separated
    /// the pair last time does not; a miss leaves behind what the next query asks first.
    #[inline(always)]
    fn asked(
        &self,
        state: &mut State,
        solve: impl FnOnce(&mut State) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        let aim = self.still_apart(state)?;
        let found = solve(state);
        if let Err(Stop::Apart(n)) = &found {
            *state = State::apart(&SeparatingAxis { dir: *n, aim }, state.radius());
        }
        found
    }

    /// Step 1: [`Stop::Apart`] where the axis of the state still separates. Else the margin to aim at with
    /// another one, metres.
    #[inline(always)]
    fn still_apart(&self, state: &mut State) -> Result<f64, Stop> {
        let Some(mut axis) = state.separating() else {
            return Ok(0.0);
        };
        let found = axis.test(&mut SupportQuery::new(&self.md, None))?;
        if let Some(n) = found {
            *state = State::apart(&axis, state.radius());
            return Err(Stop::Apart(n));
        }
        Ok(axis.aim)
    }

    /// The way from the centre of D through the origin, or the caller's first
    /// direction, or any.
    pub fn cold_start(&self) -> Vec3 {
        let from_centre = self.centre.and_then(|c| unit(&-c.v));
        from_centre
            .or_else(|| self.first_dir.and_then(|d| unit(&d)))
            .unwrap_or(Vec3::x())
    }

    /// Step 3: proves the overlap of a solver's `hit`, from points that are known, or refutes it:
    /// [`Stop::Apart`]. `planar`: D lies in a plane.
    fn prove(
        &self,
        hit: &mut Penetration,
        known: &mut Known,
        settings: &Settings,
        planar: bool,
    ) -> Result<(), Stop> {
        let mut scale = Scale::default();
        let met = SupportPoint {
            v: hit.point1 - hit.point2,
            v1: hit.point1,
            v2: hit.point2,
        };
        scale.note(&met);
        // A touch within rounding is a miss, in every query.
        if !(hit.depth * hit.dir.dot(&hit.normal) > scale.contact_eps()) {
            return Err(Stop::Apart(hit.normal));
        }
        // A depth of a few times a touch's tells nothing of where.
        let tolerance = larger(settings.tolerance, 4.0 * scale.contact_eps());
        if known.points().is_empty() {
            known.push(&met);
        }
        self.touching(self.centre.as_ref(), hit, known, tolerance, planar)
    }

    /// Shows that the origin lies among support points, known ones and others, and the `centre`,
    /// where it is trusted. Where a touch, within the tolerance, has witness points that do not
    /// meet, the points that meet at the origin take their place.
    #[inline(never)]
    fn touching(
        &self,
        centre: Option<&SupportPoint>,
        hit: &mut Penetration,
        known: &Known,
        tolerance: f64,
        planar: bool,
    ) -> Result<(), Stop> {
        let mut query = SupportQuery::new(&self.md, centre);
        let mut set = VertexSet::<16>::EMPTY;
        let dir = centre.and_then(|c| unit(&-c.v)).unwrap_or(hit.normal);
        for point in known.points() {
            query.scale.note(point);
            // All were asked for near there.
            set.push(&hit.normal, point);
        }
        let found = contains_origin(&mut query, &mut set, centre, &dir, planar)?;
        let apart = hit.point1 - hit.point2 - hit.dir * hit.depth;
        if hit.depth <= tolerance && apart.norm() > tolerance {
            let (p1, p2) = found.witnesses();
            // What the rounding of the weights leaves between them.
            let rest = (p1 - p2) * 0.5;
            (hit.point1, hit.point2) = (p1 - rest, p2 + rest);
        }
        Ok(())
    }

    /// The state tells where the centres are.
    fn face(&self, state: &mut State) {
        if let Some(centre) = &self.centre {
            state.face(&centre.v);
        }
    }

    /// Do the objects overlap? With memory, or cold. [`Stop::Apart`] where they do not.
    #[inline]
    pub fn intersect(&self, state: Option<&mut State>) -> Result<(), Stop> {
        let Some(state) = state else {
            let first = self.cold_start();
            return intersect(&self.md, self.centre.as_ref(), &first).map(|_| ());
        };
        self.asked(state, |state| {
            let first = match state.was_apart() {
                true => self.cold_start(),
                false => state.leaving().unwrap_or_else(|| self.cold_start()),
            };
            let dir = intersect(&self.md, self.centre.as_ref(), &first)?;
            // What a depth query left is worth more than this.
            if !state.overlapped() {
                *state = State::towards(dir);
                self.face(state);
            }
            Ok(())
        })
    }

    /// How far apart, or how deep; `minimum` is the global minimum of the depth of objects that overlap.
    pub fn signed_distance(
        &self,
        state: &mut State,
        wanted: &Wanted,
        minimum: impl Fn(&Self, &mut State, &Settings, &mut Penetration) -> Result<(), Stop>,
    ) -> Result<Distance, Fault> {
        let start = Start {
            dir: state
                .separating()
                .map_or_else(|| self.cold_start(), |axis| axis.dir),
            radius: state.radius(),
            is_overlapping: state.overlapped(),
        };
        let depth = |from: Option<&Vec3>, hit: &mut Penetration| {
            if let Some(dir) = from {
                *state = State::guess(dir);
            }
            minimum(self, state, &wanted.settings, hit)
        };
        let (distance, left) = signed_distance(&self.md, wanted, &start, depth)?;
        if let Some(left) = left {
            let axis = SeparatingAxis {
                dir: left.dir,
                aim: 0.0,
            };
            *state = State::apart(&axis, left.radius);
        }
        Ok(distance)
    }

    /// Finds a local minimum of the depth by a walk on the known vertices; where that ends without one, the
    /// global minimum, from the direction of the least support value.
    pub fn local(
        &self,
        state: &mut State,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let status = self.walk(state, settings, wants_pos, hit)?;
        if status == Status::Converged {
            return Ok(());
        }
        let walked = hit.iterations;
        let limits = EpaLimits {
            gap: GapLimit {
                tolerance: settings.tolerance,
                share: 0.0,
            },
            max_samples: MAX_SAMPLES,
            max_iterations: settings.max_iterations.saturating_sub(walked),
        };
        self.global(self.centre.as_ref(), state, &limits, None, wants_pos, hit)?;
        hit.iterations += walked;
        // A trusted centre was part of its proof.
        hit.depth_lower = 0.0;
        Ok(())
    }

    /// Walks to a local minimum. (In a frame of its own: the global query needs its stack.)
    #[inline(never)]
    fn walk(
        &self,
        state: &mut State,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<Status, Stop> {
        let aim = self.still_apart(state)?;
        let warm = state.warm_start();
        let start = match warm.kind {
            WarmKind::Cold => self.cold_start(),
            _ => warm.dir,
        };
        let mut query = SupportQuery::new(&self.md, self.centre.as_ref());
        let mut set = VertexSet::<{ mpr::local::MAX_SAMPLES }>::EMPTY;
        let mut fit = SphereFit::default();
        (fit.radius, fit.is_warm) = (warm.radius, warm.radius != [0.0; 2]);
        let found = mpr::local::penetration(&mut query, &mut set, &mut fit, &start, settings);
        let left = match &found {
            Ok((walked, _)) => WarmStart {
                dir: walked.dir,
                depth: walked.depth,
                radius: if fit.is_confirmed {
                    fit.radius
                } else {
                    [0.0; 2]
                },
                kind: WarmKind::Plain,
            },
            Err(Stop::Apart(axis)) => WarmStart {
                dir: *axis,
                depth: aim,
                kind: WarmKind::Apart,
                ..warm
            },
            Err(Stop::Fault(fault)) => return Err((*fault).into()),
        };
        state.store(&left);
        let (walked, status) = found?;
        self.face(state);
        *hit = walked;
        if status == Status::Converged && wants_pos {
            let mut seen = Seen::Nothing;
            let known = |i: usize| (i < set.len()).then(|| [set.vertex1(i), set.vertex2(i)]);
            seen.rest(&known, hit);
            hit.pos = self.position(hit, settings.tolerance, &seen)?;
        }
        Ok(status)
    }

    /// A local minimum of the depth by the paper's method, shortcut on (Algorithms 4, 5): from
    /// the last direction, else from the centres.
    pub fn incremental(
        &self,
        state: &mut State,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.as_published(None, state, settings, wants_pos, hit)
    }

    /// The same among the directions perpendicular to the unit vector `m`.
    pub fn planar(
        &self,
        m: Vec3,
        state: &mut State,
        settings: &Settings,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.as_published(Some(m), state, settings, false, hit)
    }

    /// The paper's method; in the plane with unit normal `flat`, where there is one.
    fn as_published(
        &self,
        flat: Option<Vec3>,
        state: &mut State,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.asked(state, |state| {
            let mut start = state.leaving().unwrap_or_else(|| self.cold_start());
            if let Some(m) = flat {
                let in_plane = |d: Vec3| unit(&(d - m * m.dot(&d)));
                start = in_plane(start).unwrap_or_else(|| perpendicular(&m));
            }
            let until = Until::Shortcut;
            *hit = gao::penetration(&self.md, start, flat, until, settings, |_| ())?;
            self.prove(hit, &mut Known::default(), settings, flat.is_some())?;
            *state = State::towards(hit.normal);
            self.face(state);
            hit.pos = if wants_pos && !hit.limit {
                self.position(hit, settings.tolerance, &Seen::Nothing)?
            } else {
                hit.middle()
            };
            Ok(())
        })
    }

    /// The minimum depth at MPR's price: within the tolerance or a thousandth of the depth,
    /// in at most [`MPR_SUPPORTS`] support points; where these do not do, a local search lowers
    /// the depth. Trusts the centre.
    pub fn mpr(
        &self,
        state: &mut State,
        settings: &Settings,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits {
            gap: GapLimit {
                tolerance: settings.tolerance,
                share: GAP_REL,
            },
            max_samples: MAX_SAMPLES,
            max_iterations: settings.max_iterations,
        };
        self.global(self.centre.as_ref(), state, &limits, None, wants_pos, hit)
    }

    /// The global minimum of the depth, proven by support points alone: from the state,
    /// else from the centres, else from the first direction.
    pub fn minimum(
        &self,
        state: &mut State,
        settings: &Settings,
        arena: &mut dyn Arena,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let limits = EpaLimits {
            gap: GapLimit {
                tolerance: settings.tolerance,
                share: 0.0,
            },
            max_samples: MAX_PROVEN_SAMPLES,
            max_iterations: settings.max_iterations,
        };
        self.global(None, state, &limits, Some(arena), wants_pos, hit)
    }

    /// The global search, from the state; `apex` is a point that is trusted to be in D.
    #[inline(never)]
    fn global(
        &self,
        apex: Option<&SupportPoint>,
        state: &mut State,
        limits: &EpaLimits,
        arena: Option<&mut dyn Arena>,
        wants_pos: bool,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        let aim = self.still_apart(state)?;
        let was_apart = state.was_apart();
        let request = EpaRequest {
            center: apex,
            ray: self.cold_start(),
            // Its axis has been queried.
            warm: if was_apart {
                WarmStart::COLD
            } else {
                state.warm_start()
            },
            limits: *limits,
            wants_pos,
        };
        let mut warm = WarmStart::COLD;
        let mut set = VertexSet::EMPTY;
        let mut answer = EpaAnswer {
            hit,
            warm: &mut warm,
            set: &mut set,
        };
        let query = SupportQuery::new(&self.md, apex);
        let arena = arena.map(|arena| arena as &mut dyn Arena);
        let found = epa::penetration::penetration(query, &request, arena, &mut answer);
        if self.lasting && !matches!(found, Err(Stop::Fault(_))) {
            state.store(&WarmStart {
                depth: if found.is_ok() { warm.depth } else { aim },
                ..warm
            });
            if found.is_ok() {
                self.face(state);
            }
        }
        let status = found?;
        hit.limit = status != Status::Converged;
        if hit.limit {
            if status != Status::InconsistentSupport {
                self.floor(hit, limits)?;
            }
            hit.pos = hit.middle();
        } else if wants_pos {
            let mut seen = Seen::Nothing;
            let known = |i: usize| (i < set.len()).then(|| [set.vertex1(i), set.vertex2(i)]);
            seen.rest(&known, hit);
            hit.pos = self.position(hit, limits.gap.tolerance, &seen)?;
        }
        Ok(())
    }

    /// The position of a hit, of which nothing is kept.
    fn position(&self, hit: &Penetration, tolerance: f64, seen: &Seen) -> Result<Vec3, Fault> {
        let aside = Aside {
            centre: self.centre.as_ref(),
            seen,
            others: &[],
            around: None,
        };
        pressure::centre(&self.md, hit, tolerance, aside)
    }

    /// How far obj2 must move along the unit direction `dir`.
    pub fn along(
        &self,
        dir: Vec3,
        state: &mut State,
        settings: &Settings,
        hit: &mut Penetration,
    ) -> Result<(), Stop> {
        self.asked(state, |state| {
            let last = state.portal();
            let capped = Settings {
                max_iterations: settings.max_iterations.min(MAX_PROVEN_SAMPLES),
                ..*settings
            };
            let (found, portal) = mpr::directional::along(&self.md, &dir, last, &capped)?;
            *hit = found;
            let mut known = Known::default();
            for plane in portal.iter().flat_map(|p| &p.planes) {
                known.add(&plane.point);
            }
            self.prove(hit, &mut known, settings, false)?;
            *state = State::towards(hit.normal);
            self.face(state);
            if let Some(portal) = portal {
                state.keep_portal(portal.planes.map(|plane| plane.normal));
            }
            hit.pos = hit.middle();
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Rotation, capsule, corners, hull, placed};
    use nalgebra::Unit;

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-7 } else { 1e-4 },
        max_iterations: 1000,
    };

    /// What a query from this state costs and answers.
    fn ask<A: SupportMap, B: SupportMap>(a: A, b: B, mut state: State) -> (u64, f64, State) {
        let pair = Pair {
            md: MinkowskiDifference::new(a, b),
            centre: None,
            first_dir: None,
            lasting: true,
        };
        let mut hit = Penetration::default();
        pair.local(&mut state, &SETTINGS, false, &mut hit).unwrap();
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
            let start = State::guess(&r.direction());
            let (_, _, after) = ask(cube(), rod(), start);
            let (supports, depth, _) = ask(cube(), rod(), after);
            let mut flipped = after;
            flipped.flip();
            let (swapped_supports, swapped_depth, _) = ask(rod(), cube(), flipped);
            assert_eq!(supports, swapped_supports);
            assert!((depth - swapped_depth).abs() < 16.0 * EPSILON);
        }
    }

    /// Where the proof of an overlap may lean on a centre, it proves no bound.
    #[test]
    fn no_bound_leans_on_a_centre() {
        let mut r = Random::new(8);
        let a = corners(Vec3::repeat(1.0));
        for _ in 0..100 {
            let b = placed(&a, &r.rotation(), r.vector(1.0));
            let v1 = r.vector(3.0);
            let pair = Pair {
                md: MinkowskiDifference::new(hull(&a), hull(&b)),
                centre: Some(SupportPoint {
                    v: v1,
                    v1,
                    v2: Vec3::zeros(),
                }),
                first_dir: None,
                lasting: true,
            };
            let mut state = State::guess(&r.direction());
            let mut hit = Penetration::default();
            if pair.local(&mut state, &SETTINGS, true, &mut hit).is_ok() {
                assert_eq!(hit.depth_lower, 0.0);
            }
        }
    }
}
