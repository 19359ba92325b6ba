// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, from start to end.
//!
//! 1. *Separating axis*: evaluate the first direction: the warm state's or the *ray* (centers to origin, else
//!    `first_dir`). Most queries of separated objects end here.
//! 2. *Interior point*: the difference of the centers if they are given; else the middle of the
//!    support points along the ray and opposite to it, which is always in D.
//! 3. *Portal*: discovery and refinement ([`crate::portal`]); if the vertex of the first direction is near the ray, as
//!    that of a warm state is, a ring of three support points around the direction of the upper bound; if the center is near
//!    the origin, a wide ring around the ray.
//! 4. *Certificate*: if the tetrahedron of interior point and portal contains the ball around the origin whose radius
//!    is the upper bound less the allowed gap ([`GapLimit`](crate::minkowski::tolerance::GapLimit)), the minimum is
//!    proven. Most shallow contacts end here.
//! 5. *Polytope*: EPA ([`crate::epa::expand`]) from that tetrahedron, where a support point replaces a center near the
//!    origin; if the polytope does not come to contain the origin, or rounding ends it, from a
//!    tetrahedron of GJK, then from one of four wide directions. Full buffers are replaced by larger ones.
//! 6. *Direction*: up to four more directions where the bounds differ by more than the tolerance ([`crate::epa::direction`]).
//! 7. *Result*: bounds, direction and witness points of the portal or polytope with the least gap.
//!
//! Departures. Steps 3 to 5 take known differences before callbacks. If a known difference is beyond the plane of the
//! result, a callback has contradicted itself; if the difference of the centers is beyond an evaluated plane, a center
//! is outside its object. Both end as [`Status::InconsistentSupport`].
//!
//! Outputs. All assume valid support functions, and centers that are in their objects.
//!
//! | output | valid |
//! |---|---|
//! | `depth`, `dir` | always; sound |
//! | `depth_lower` | always, of the global minimum; 0 if nothing is proven |
//! | witness points | always, each in its object; zero if they are not wanted |
//!
//! [`Status::Converged`]: depth − depth_lower is within the allowed gap. [`Status::InconsistentSupport`]: `depth_lower`
//! is 0, and `depth` is sound only for the points that the support functions returned.

use crate::epa::buffers::{
    Arena, EpaBuffers, LARGE_FACES, LARGE_VERTICES, SMALL_FACES, SMALL_VERTICES, START_VERTICES,
};
use crate::epa::direction::refine_direction;
use crate::epa::expand::{EpaLimits, expand};
use crate::epa::polytope::EpaPolytope;
use crate::epa::witness::{exit_face, max_foot_distance2, witness_points};
use crate::geometry::plane::{PLANE_ERROR_ULPS, base_distance};
use crate::gjk::intersect::{CAPACITY, Enclosing, contains_origin};
use crate::math::{Vec3, larger, lesser, normalise_unscaled};
use crate::minkowski::sphere_fit::SphereFit;
use crate::minkowski::support::{SupportMap, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::minkowski::warm_start::WarmStart;
use crate::portal::{FAR_UPPER_REL, NearRay, Portal, WIDEST_RING_TAN, discover, refine, ring};
use crate::trace;
use crate::types::{Solution, Status};

/// The gap above the tolerance that counts as converged if rounding ended the search, in support epsilons. Derived: 20
/// for the rounding of a plane and of a point above it if the size of D is twice the world extent; the rest is a
/// reserve.
const ROUNDING_GAP_EPS: f64 = 32.0;

/// The largest tangent of the tilt of the ring of a contact that is not deep: 19°. Measured: without a limit, two spheres 0.3
/// of a diameter deep take 32 support points in place of 20, and hulls of 642 corners 5 % more; hulls of 162 corners take
/// 3 % more with 0.25, 8 % more with 0.15.
const WIDE_RING_TAN: f64 = 0.35;
/// The radius of that ring, in upper bounds. Measured: with 2, warm queries of ellipsoids take 6 % more support points; with
/// 4, proofs of them 3 %.
const WIDE_RING_DEPTHS: f64 = 3.0;
/// The distance from the ray, in radii of the ring, below which a vertex counts as near it and a ring is evaluated. Measured:
/// with 1 boxes take 15 % and hulls 7 to 26 % more support points; below 0.25 the counts change by less than 1 %.
const NEAR_RING_REL: f64 = 0.25;
/// The distance of the center from the origin, in sizes of D, up to which it can be close to the origin. Measured: with 0.4,
/// boxes that slide on a plate take 5.4 support points in place of 3.6; with 0.25, bodies on a plate of 20 m 3 % more, with 0.1
/// 4 % fewer; other sets differ by at most 1 %.
const CENTRAL_REL: f64 = 0.2;
/// The squared turn of the ray, radians, above which the new ray is evaluated too: 29 degrees. Measured: without that misses
/// of `ccdGJKPenetration` take 5.6 support points in place of 4.3; from 6 degrees on hulls without centers take 4 to 7 % more.
const MAX_RAY_TURN2: f64 = 0.25;

/// The input of a query besides the support functions.
pub struct EpaRequest<'a> {
    /// The difference of the centers, which is trusted to lie in D: the interior point.
    pub center: Option<&'a SupportPoint>,
    /// The unit direction of a cold start: from an interior point through the origin.
    pub ray: Vec3,
    /// The limits of the query.
    pub limits: EpaLimits,
    /// False if the witness points are not read; they are then zero.
    pub wants_points: bool,
}

/// The bounds and the witness points of a polytope or portal.
#[derive(Clone, Copy)]
struct Proof {
    /// The upper bound, metres.
    upper: f64,
    /// Its direction, unit.
    dir: Vec3,
    /// The lower bound of the depth, metres; 0 if none is proven.
    lower: f64,
    /// The witness points of the upper bound.
    points: [Vec3; 2],
    /// True if a support function contradicts the plane of the upper bound.
    is_inconsistent: bool,
}

/// Result of the steps before a polytope is made.
enum Outcome {
    /// The minimum is proven.
    Proven(Proof),
    /// The portal from which the polytope starts; `None` if none was found.
    Open(Option<Portal>),
}

/// The state of a query.
struct EpaSolver<'q, 'm, A, B> {
    query: &'q mut SupportQuery<'m, A, B>,
    request: &'q EpaRequest<'q>,
    /// The interior point, and the points of the objects whose difference it is.
    interior: SupportPoint,
    fit: SphereFit,
    /// [`FAR_UPPER_REL`] for a cold start. The direction of an overlap's state says where the minimum is, however deep.
    far_upper_rel: f64,
    /// The number of support points that expanded polytopes.
    iterations: u64,
}

/// Finds the global minimum of the penetration depth, by the steps at the head of this file, without a contact position.
/// `first`: the support point along the warm state's direction or the ray, which does not separate
/// ([`SupportQuery::evaluate_first`]: most queries of separated objects end there, before this function's stack is in
/// use). Without an `arena` there are only the buffers on the stack. `state`: of the last query. `set`: without
/// entries; then it has the vertices of the first support calls, for the contact position.
///
/// # Errors
/// [`Stop::Separated`]: the objects are separated, or in contact within rounding. [`Stop::Fault`].
#[inline(always)]
pub fn penetration<A: SupportMap, B: SupportMap>(
    query: &mut SupportQuery<'_, A, B>,
    first: &SupportPoint,
    request: &EpaRequest<'_>,
    mut arena: Option<&mut dyn Arena>,
    set: &mut VertexSet<SMALL_VERTICES>,
    state: &WarmStart,
) -> Result<Solution, Stop> {
    set.push(&query.upper.dir, first);
    let is_warm = state.is_overlap();
    // The axis of a separated pair has been evaluated already; nothing else of its state is used.
    let radius = if is_warm { state.radius } else { [0.0; 2] };
    // The ray is evaluated too if the warm direction is only a guess (its depth is 0).
    let is_guess = is_warm && !(state.depth > 0.0);
    if is_guess {
        query.evaluate(set, &request.ray)?;
    }
    let mut solver = EpaSolver {
        query,
        request,
        interior: request.center.copied().unwrap_or_default(),
        fit: SphereFit::warm(radius),
        far_upper_rel: if is_warm && !is_guess {
            f64::INFINITY
        } else {
            FAR_UPPER_REL
        },
        iterations: 0,
    };
    let (proof, mut status) = match solver.run_without_polytope(set)? {
        Outcome::Proven(proof) => (proof, Status::Converged),
        Outcome::Open(portal) => solver.expand_from(set, portal.as_ref(), &mut arena)?,
    };
    let Proof {
        upper: depth,
        dir,
        mut lower,
        points,
        mut is_inconsistent,
    } = proof;
    // A support plane excludes the center from D: the polytope may contain an origin that is outside.
    if request.center.is_some() && solver.query.center.is_none() {
        solver.prove_overlap(&dir)?;
        is_inconsistent = true;
    }
    if is_inconsistent {
        (lower, status) = (0.0, Status::InconsistentSupport);
    }
    solver.query.confirm_upper()?;
    // A direction that was evaluated before the upper bound of a later polytope is tilted by the next query.
    let upper = &solver.query.upper;
    let is_general = upper.direction().is_general() && dir == upper.dir;
    Ok(Solution {
        depth,
        depth_lower: lower.min(depth),
        dir,
        normal: dir,
        is_general,
        point1: points[0],
        point2: points[1],
        iterations: solver.iterations,
        status,
        radius: solver.fit.confirmed_radius(),
        ..Solution::default()
    })
}

impl<A: SupportMap, B: SupportMap> EpaSolver<'_, '_, A, B> {
    /// Runs steps 2 to 4. Not inlined, so that its frame is released before a polytope is made.
    #[inline(never)]
    fn run_without_polytope(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
    ) -> Result<Outcome, Stop> {
        let mut ray = self.request.ray;
        let opposite = match self.request.center {
            Some(_) => None,
            None => Some(self.find_interior(set, &mut ray)?),
        };
        let portal = self.find_portal(set, &ray)?;
        // Not into a full set: it would replace the last entry, which may be a corner.
        if let Some((dir, point)) = opposite.as_ref().filter(|_| !set.is_full()) {
            set.push(dir, point);
        }
        if let Some(portal) = &portal {
            if let Some(proof) = self.certify(set, portal)? {
                return Ok(Outcome::Proven(proof));
            }
        }
        Ok(Outcome::Open(portal))
    }

    /// Sets the interior point to the middle of the support points along the ray and opposite to it, and `ray` to the
    /// direction from there to the origin. Returns the opposite direction and its point, which are removed from the
    /// set: as a corner the point would make the portal wide.
    fn find_interior<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &mut Vec3,
    ) -> Result<(Vec3, SupportPoint), Stop> {
        trace::stage("interior point");
        let newest = set.point(VertexSet::<N>::pair_of_entry(set.len().saturating_sub(1)));
        let sample = self.query.evaluate(set, &-*ray)?;
        let index = usize::from(sample.pair.a);
        let opposite = (set.dir(index), set.point(sample.pair));
        set.truncate(index);
        self.interior = newest.towards(&opposite.1, 0.5);
        if let Some(n) = normalise_unscaled(&-self.interior.v) {
            let turn2 = (n - *ray).norm_squared();
            *ray = n;
            // Else the support point of the old ray is close enough for the start of a portal.
            if turn2 > MAX_RAY_TURN2 {
                self.query.evaluate(set, ray)?;
            }
        }
        Ok(opposite)
    }

    /// Returns whether the center is close to the origin, and along unit `dir` closer than the upper bound: the polytope will
    /// then reach all around the origin. The second alone is true of a body on a wide plate too, where `dir` is nearly
    /// parallel to the plate.
    #[inline(always)]
    fn is_central(&self, dir: &Vec3) -> bool {
        let query = &*self.query;
        let largest2 = CENTRAL_REL * CENTRAL_REL * query.scale.size2();
        let center = self.request.center;
        center.is_some_and(|center| {
            -center.v.dot(dir) < query.upper.depth && center.v.norm_squared() < largest2
        })
    }

    /// Finds a portal of the ray and refines it; a wide ring if the center is close to the origin.
    #[inline(always)]
    fn find_portal<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &Vec3,
    ) -> Result<Option<Portal>, Stop> {
        let gap = self.allowed_gap();
        let is_central = self.is_central(ray);
        let query = &mut *self.query;
        if is_central {
            if let Some(portal) = ring(query, set, ray, WIDEST_RING_TAN)? {
                return Ok(Some(portal));
            }
        }
        let length = query.upper.depth - self.interior.v.dot(ray);
        // As wide as the gap allows, or as the ball that the tetrahedron of a shallow contact has to contain.
        let wide = lesser(WIDE_RING_DEPTHS * query.upper.depth, WIDE_RING_TAN * length);
        let ring_radius = larger((2.0 * gap * length).sqrt(), wide);
        let near2 = NEAR_RING_REL * NEAR_RING_REL * ring_radius * ring_radius;
        // The vertex of the warm direction of two round objects is on a flat side of D, and a poor corner: the ray is evaluated
        // too, unless a ring is next.
        if self.fit.radius[0] * self.fit.radius[1] > 0.0 && set.len() == 1 {
            let v1 = set.farthest_vertex(ray).w;
            if (ray * v1.dot(ray) - v1).norm_squared() > near2 {
                query.evaluate(set, ray)?;
            }
        }
        let lowest = query.upper.dir;
        let near_ray = NearRay::Ring {
            axis: &lowest,
            tilt: ring_radius / length,
        };
        let Some(mut portal) = discover(
            query,
            set,
            ray,
            length,
            self.far_upper_rel * length,
            near2,
            near_ray,
        )?
        else {
            return Ok(None);
        };
        refine(
            query,
            set,
            &mut self.fit,
            ray,
            &mut portal,
            &self.request.limits.gap,
        )?;
        Ok(Some(portal))
    }

    /// Returns the gap that is allowed below the upper bound, metres.
    #[inline(always)]
    fn allowed_gap(&self) -> f64 {
        let query = &*self.query;
        let gap = &self.request.limits.gap;
        gap.allowed(&query.scale, query.upper.depth)
    }

    /// Returns the fourth corner of the tetrahedron of the portal: the interior point; in place of a center close to the
    /// origin, the support point opposite to the upper bound.
    fn find_apex(&mut self, set: &mut VertexSet<SMALL_VERTICES>) -> Result<Vertex, Stop> {
        let dir = self.query.upper.dir;
        if self.is_central(&dir) && !set.is_full() {
            return Ok(self.query.evaluate(set, &-dir)?.vertex());
        }
        Ok(Vertex {
            w: self.interior.v,
            pair: VertexPair::INTERIOR,
        })
    }

    /// Tries to prove the minimum from the tetrahedron of interior point and portal. Returns the proof.
    #[inline(always)]
    fn certify(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: &Portal,
    ) -> Result<Option<Proof>, Stop> {
        let scale = &self.query.scale;
        let size = scale.size();
        let tolerance = scale.tolerance(self.request.limits.gap.tolerance);
        let allowed = self.allowed_gap();
        let error = PLANE_ERROR_ULPS * f64::EPSILON * size + scale.support_eps();
        // A lower bound of at most the contact epsilon proves no overlap.
        let least = larger(self.query.upper.depth - allowed, scale.contact_eps()) + error;
        let Some(distance) = base_distance(&self.interior.v, &portal.points(), least, size) else {
            return Ok(None);
        };
        let lower = distance - error;
        let mut face = *portal;
        if self.query.upper.depth - lower > tolerance {
            refine_direction(self.query, set, &mut face, lower, tolerance)?;
        }
        Ok(Some(self.proof(
            set,
            &face.corners,
            || portal.corners,
            lower,
            allowed,
        )))
    }

    /// Expands polytopes from up to three starts, until one contains the origin and is not ended by rounding: the
    /// tetrahedron of interior point and portal, that of GJK, and that of four wide directions. Measured (`judged hard 2000
    /// 18`, seeds 11 to 14): with GJK's from the other side in place of the last 3 of 8,000 nearly coincident pairs end
    /// up to 63 % too deep, because the same flat tetrahedron is found.
    #[inline(never)]
    fn expand_from(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: Option<&Portal>,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<(Proof, Status), Stop> {
        // The proof with the least gap.
        let mut best: Option<Proof> = None;
        for attempt in 0..3 {
            if attempt > 0 {
                set.truncate(SMALL_VERTICES - START_VERTICES);
            }
            let dir = self.query.upper.dir;
            let start = match (attempt, portal) {
                (0, None) => continue,
                (0, Some(Portal { corners: [a, b, c] })) => [self.find_apex(set)?, *a, *b, *c],
                (1, _) => self.find_gjk_tetrahedron(set, &-dir)?,
                _ => match self.find_wide_tetrahedron(set, &dir)? {
                    Some(start) => start,
                    None => break,
                },
            };
            let mut polytope = EpaPolytope::<SMALL_FACES>::blank(self.query.scale.size());
            let (found, status) = match self.expand_small(set, &mut polytope, &start)? {
                _ if polytope.is_blank() => continue,
                Some(status) => self.compute_result(set, &polytope, status)?,
                None => self.expand_large(set, &polytope, arena)?,
            };
            let proof = match best {
                Some(best) if !(found.upper - found.lower < best.upper - best.lower) => best,
                _ => found,
            };
            if status != Status::Rounding {
                if !(proof.lower > self.query.scale.contact_eps()) {
                    self.prove_overlap(&dir)?;
                }
                return Ok((proof, status));
            }
            best = Some(proof);
        }
        let proof = match best {
            Some(proof) => proof,
            None => {
                // No tetrahedron has a volume: the depth is mostly of the order of rounding. The points that GJK finds
                // coincide, and are off by the depth; the support points may be less far off.
                let SupportPlane {
                    dir, depth, point, ..
                } = self.query.upper;
                let mut points = [point.v1, point.v2];
                if self.request.wants_points && !((point.v - dir * depth).norm() <= depth) {
                    points = self.prove_overlap(&dir)?.witnesses().into();
                }
                Proof {
                    upper: depth,
                    dir,
                    lower: 0.0,
                    points,
                    is_inconsistent: false,
                }
            }
        };
        Ok((proof, Status::Rounding))
    }

    /// Expands a polytope from a tetrahedron in the small buffers, which stay blank if it is flat. Returns as [`expand`].
    /// Not inlined: the small buffers are alive while larger ones are in use, this frame is not.
    #[inline(never)]
    fn expand_small(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        polytope: &mut EpaPolytope<SMALL_FACES>,
        start: &[Vertex; 4],
    ) -> Result<Option<Status>, Stop> {
        let scale = &self.query.scale;
        let is_exact = self.request.limits.needs_exact_planes(scale);
        if !polytope.start(start, scale.size(), is_exact) {
            return Ok(Some(Status::Rounding));
        }
        self.expand_in(set, polytope, true)
    }

    /// Continues an expansion in the large buffers and, if these become full, in those of the arena if there is one.
    /// Returns as [`EpaSolver::compute_result`].
    #[cold]
    #[inline(never)]
    fn expand_large(
        &mut self,
        small_set: &VertexSet<SMALL_VERTICES>,
        small_polytope: &EpaPolytope<SMALL_FACES>,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<(Proof, Status), Stop> {
        let mut set = VertexSet::<LARGE_VERTICES>::EMPTY;
        let mut polytope = EpaPolytope::<LARGE_FACES>::BLANK;
        set.copy_from(small_set);
        polytope.copy_from(small_polytope);
        let status = self.expand_in(&mut set, &mut polytope, arena.is_some())?;
        match (status, arena.take()) {
            (None, Some(arena)) => {
                let buffers = arena.buffers()?;
                buffers.set.copy_from(&set);
                buffers.polytope.copy_from(&polytope);
                self.expand_in_arena(buffers)
            }
            _ => self.compute_result(&mut set, &polytope, status.unwrap_or(Status::SupportLimit)),
        }
    }

    /// Continues an expansion in the buffers of an arena. Returns as [`EpaSolver::compute_result`].
    #[cold]
    #[inline(never)]
    fn expand_in_arena(&mut self, buffers: &mut EpaBuffers) -> Result<(Proof, Status), Stop> {
        let EpaBuffers { set, polytope } = buffers;
        let status = self.expand_in(set, polytope, false)?;
        self.compute_result(set, polytope, status.unwrap_or(Status::SupportLimit))
    }

    /// Expands a polytope in these buffers. Returns as [`expand`].
    #[inline(always)]
    fn expand_in<const N: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        polytope: &mut EpaPolytope<F>,
        has_larger: bool,
    ) -> Result<Option<Status>, Stop> {
        expand(
            self.query,
            set,
            &mut self.fit,
            &self.interior.v,
            polytope,
            &mut self.iterations,
            &self.request.limits,
            has_larger,
        )
    }

    /// Proves by GJK, from unit `dir`, that the objects overlap by more than the contact epsilon.
    ///
    /// # Errors
    /// As [`contains_origin`].
    #[cold]
    #[inline(never)]
    fn prove_overlap(&mut self, dir: &Vec3) -> Result<Enclosing, Stop> {
        let mut known = VertexSet::<CAPACITY>::EMPTY;
        contains_origin(self.query, &mut known, None, dir, false)
    }

    /// Returns the tetrahedron with which GJK, from unit `dir`, proves the overlap.
    #[cold]
    #[inline(never)]
    fn find_gjk_tetrahedron(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        dir: &Vec3,
    ) -> Result<[Vertex; 4], Stop> {
        let found = self.prove_overlap(dir)?;
        // The points need not be support points, so they are stored without a direction.
        Ok(found.corners.map(|point| {
            let pair = VertexSet::<SMALL_VERTICES>::pair_of_entry(set.push(&Vec3::zeros(), &point));
            Vertex { w: point.v, pair }
        }))
    }

    /// Returns the tetrahedron of the support points along unit `dir` and of a wide ring around the opposite direction; `None`
    /// if those of the ring are nearly on a line.
    #[cold]
    #[inline(never)]
    fn find_wide_tetrahedron(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        dir: &Vec3,
    ) -> Result<Option<[Vertex; 4]>, Stop> {
        let apex = self.query.evaluate(set, dir)?.vertex();
        let base = ring(self.query, set, &-dir, WIDEST_RING_TAN)?;
        Ok(base.map(|Portal { corners: [a, b, c] }| [apex, a, b, c]))
    }

    /// Returns the proof of an expansion that ended with `end`, and its status: [`Status::Rounding`] if the polytope does
    /// not provably contain the origin.
    #[inline(never)]
    fn compute_result<const N: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        polytope: &EpaPolytope<F>,
        end: Status,
    ) -> Result<(Proof, Status), Stop> {
        let closest = polytope.closest_face();
        let support_eps = self.query.scale.support_eps();
        let gap_limit = &self.request.limits.gap;
        let tolerance = self.query.scale.tolerance(gap_limit.tolerance);
        let is_inside = polytope.encloses_interior_point() && closest.key >= 0.0;
        let lower = if is_inside {
            larger(polytope.lower_bound(&closest) - support_eps, 0.0)
        } else {
            0.0
        };
        let interior = self.interior.v;
        let exit_face = |upper: &SupportPlane, set: &VertexSet<N>, gap: f64| {
            exit_face(upper, &interior, set, polytope, closest.face, gap)
        };
        let mut refined = None;
        if end == Status::Converged && self.query.upper.depth - lower > tolerance {
            let corners = exit_face(&self.query.upper, set, self.allowed_gap());
            let mut face = Portal { corners };
            refine_direction(self.query, set, &mut face, lower, tolerance)?;
            refined = Some(face.corners);
        }
        let upper = self.query.upper.depth;
        let gap = self.allowed_gap();
        let face = match refined {
            Some(face) => face,
            None if self.request.wants_points => exit_face(&self.query.upper, set, gap),
            None => [Vertex::default(); 3],
        };
        let other = || exit_face(&self.query.upper, set, gap);
        let proof = self.proof(set, &face, other, lower, gap);
        // Converged is decided by the lower bound as rounded down, whatever ended the expansion.
        let rounding = ROUNDING_GAP_EPS * support_eps;
        let allowed = larger(gap, larger(gap_limit.tolerance, tolerance) + rounding);
        let status = match end {
            _ if !is_inside => Status::Rounding,
            _ if upper - lower <= allowed => Status::Converged,
            Status::Converged => Status::Rounding,
            _ => end,
        };
        Ok((proof, status))
    }

    /// Returns the proof of the upper bound. `face`: a face of the inner model near it, read for witness points alone.
    /// `other`: returns a second face, for a foot that is not close to the first; the ray of a refined direction may cross
    /// neither.
    #[inline(always)]
    fn proof<const N: usize>(
        &self,
        set: &VertexSet<N>,
        face: &[Vertex; 3],
        other: impl FnOnce() -> [Vertex; 3],
        lower: f64,
        gap: f64,
    ) -> Proof {
        let upper = &self.query.upper;
        let mut points = [Vec3::zeros(); 2];
        if self.request.wants_points {
            let closest =
                |face: &[Vertex; 3]| witness_points(upper, &self.interior, set, face, gap);
            let distance2;
            (points, distance2) = closest(face);
            if distance2 > max_foot_distance2(upper, gap) {
                let found = closest(&other());
                if found.1 < distance2 {
                    points = found.0;
                }
            }
        }
        Proof {
            upper: upper.depth,
            dir: upper.dir,
            lower,
            points,
            is_inconsistent: self.query.is_inconsistent(set),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epa::buffers::{MAX_DEFAULT_POINTS, MAX_PROVEN_POINTS};
    use crate::math::EPSILON;
    use crate::minkowski::support::{Fault, MinkowskiDifference};
    use crate::test_shapes::{Random, ball, corners, difference, ellipsoid, hull, placed};
    use crate::types::{Direction, Settings};
    use core::cell::Cell;

    const TOLERANCE: f64 = if EPSILON < 1e-10 { 1e-9 } else { 1e-4 };

    struct Heap(Box<EpaBuffers>, bool);

    impl Heap {
        fn new() -> Self {
            let (set, polytope) = (VertexSet::EMPTY, EpaPolytope::BLANK);
            Self(Box::new(EpaBuffers { set, polytope }), false)
        }
    }

    impl Arena for Heap {
        fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault> {
            self.1 = true;
            Ok(&mut self.0)
        }
    }

    /// Returns the result of a cold query along the ray from `center`, or along x.
    fn run<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        center: Option<&SupportPoint>,
        max_points: u64,
        arena: Option<&mut dyn Arena>,
    ) -> Result<Solution, Stop> {
        let settings = Settings {
            max_iterations: 1000,
            ..Settings::new(TOLERANCE)
        };
        let request = EpaRequest {
            center,
            ray: center
                .and_then(|c| normalise_unscaled(&-c.v))
                .unwrap_or(Vec3::x()),
            limits: EpaLimits::new(&settings, 0.0, max_points),
            wants_points: true,
        };
        let mut query = SupportQuery::new(md, center, TOLERANCE);
        let first = query.evaluate_first(&Direction::exact(request.ray))?;
        let mut set = VertexSet::EMPTY;
        let cold = WarmStart::COLD;
        penetration(&mut query, &first, &request, arena, &mut set, &cold)
    }

    /// Returns a point as the difference of the centers of an object there and one at the origin.
    fn center(v: Vec3) -> SupportPoint {
        SupportPoint {
            v,
            v1: v,
            v2: Vec3::zeros(),
        }
    }

    fn point() -> impl SupportMap {
        |_: &Vec3| Vec3::zeros()
    }

    /// A tetrahedron around the origin with faces at known distances: the closest one is the depth.
    #[test]
    fn the_depth_of_a_point_in_a_tetrahedron_is_its_distance_from_the_closest_face() {
        let mut r = Random::new(41);
        for _ in 0..300 {
            // A simplex of corner 0 and three unit edges, seen from a point inside it.
            let inside = Vec3::new(
                r.within(0.05, 0.3),
                r.within(0.05, 0.3),
                r.within(0.05, 0.3),
            );
            let turn = r.rotation();
            let points = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
            let points = points.map(|p| turn * (p - inside));
            let slanted = (1.0 - inside.sum()) / 3f64.sqrt();
            let depth = inside.min().min(slanted);
            let md = difference(hull(&points), point());
            let mean = center((points[0] + points[1] + points[2] + points[3]) * 0.25);
            for center in [None, Some(&mean)] {
                let hit = run(&md, center, MAX_PROVEN_POINTS, None).unwrap();
                assert_eq!(hit.status, Status::Converged);
                assert!((hit.depth - depth).abs() <= TOLERANCE, "{hit:?} {depth}");
                assert!(hit.depth_lower <= depth && hit.depth_lower >= depth - TOLERANCE);
                assert!(hit.has_sound_witnesses(TOLERANCE), "{hit:?}");
                assert_eq!(hit.point2, Vec3::zeros());
            }
        }
    }

    #[test]
    fn boxes_one_in_the_other_have_the_depth_of_the_shortest_way_out() {
        let mut r = Random::new(42);
        for _ in 0..100 {
            let half = Vec3::new(r.within(1.0, 2.0), r.within(1.0, 2.0), r.within(1.0, 2.0));
            let (at, turn) = (r.vector(0.3), r.rotation());
            let (a, b) = (corners(half), corners(Vec3::repeat(0.2)));
            let (a, b) = (
                placed(&a, &turn, Vec3::zeros()),
                placed(&b, &turn, turn * at),
            );
            let md = difference(hull(&a), hull(&b));
            let depth = (half + Vec3::repeat(0.2) - at.abs()).min();
            for center in [None, Some(&center(-(turn * at)))] {
                let hit = run(&md, center, MAX_PROVEN_POINTS, None).unwrap();
                assert_eq!(hit.status, Status::Converged);
                assert!((hit.depth - depth).abs() <= TOLERANCE, "{hit:?} {depth}");
            }
        }
    }

    /// A plate of a thickness of the order of rounding: no tetrahedron of its corners has a volume.
    #[test]
    #[cfg(not(feature = "single"))]
    fn the_witness_points_of_an_overlap_without_volume_are_close_to_each_other() {
        let mut r = Random::new(45);
        let thin = 8e-15;
        for _ in 0..100 {
            let at = Vec3::new(r.within(-0.9, 0.9), r.within(-0.9, 0.9), 0.0);
            let plate: Vec<Vec3> = (corners(Vec3::new(1.0, 1.0, thin)).iter())
                .map(|p| p + at)
                .collect();
            let md = difference(hull(&plate), point());
            let hit = run(&md, None, MAX_PROVEN_POINTS, None).unwrap();
            let apart = (hit.point1 - hit.point2).norm();
            assert!(apart <= 4.0 * thin, "{hit:?} {apart}");
        }
    }

    #[test]
    fn separated_objects_have_a_separating_axis() {
        let mut r = Random::new(43);
        let a = corners(Vec3::repeat(1.0));
        for _ in 0..100 {
            let b = placed(&a, &r.rotation(), r.direction() * 3.5);
            let md = difference(hull(&a), hull(&b));
            let Err(Stop::Separated(Direction { n, .. })) = run(&md, None, MAX_PROVEN_POINTS, None)
            else {
                panic!("the boxes do not overlap");
            };
            assert!(md.support(&n).unwrap().v.dot(&n) < 0.0);
        }
    }

    /// The support function is right until one of its calls returns a NaN.
    #[test]
    fn a_nan_of_any_call_is_a_fault() {
        let boxes = corners(Vec3::new(1.0, 1.1, 1.2));
        let mut faults = 0;
        for bad in 0..100 {
            let calls = Cell::new(0);
            let a = |n: &Vec3| {
                calls.set(calls.get() + 1);
                let wrong = if calls.get() > bad { f64::NAN } else { 0.0 };
                hull(&boxes).support(n) + Vec3::repeat(wrong)
            };
            let md = difference(
                a,
                hull(&placed(
                    &boxes,
                    &nalgebra::Rotation3::new(Vec3::repeat(0.4)),
                    Vec3::repeat(0.3),
                )),
            );
            match run(&md, None, MAX_PROVEN_POINTS, None) {
                Ok(hit) => assert!(calls.get() <= bad && hit.status == Status::Converged),
                Err(stop) => {
                    assert_eq!(stop, Stop::Fault(Fault::NonFinite));
                    assert_eq!(calls.get(), bad + 1);
                    faults += 1;
                }
            }
        }
        assert!(faults > 5 && faults < 100, "{faults}");
    }

    /// Two triangles in one plane: D is flat, and the objects are in contact at most.
    #[test]
    fn a_flat_difference_contains_no_ball() {
        let triangle = [Vec3::new(-1.0, -1.0, 0.0), Vec3::x() * 2.0, Vec3::y() * 2.0];
        let md = difference(hull(&triangle), hull(&triangle));
        for center in [None, Some(&center(Vec3::new(0.1, 0.2, 0.0)))] {
            let found = run(&md, center, MAX_PROVEN_POINTS, None);
            assert!(
                matches!(found, Err(Stop::Separated(Direction { n, .. })) if n.z.abs() > 0.999),
                "{found:?}"
            );
        }
    }

    /// A plate of this thickness: the depth is half of it, whatever the start.
    #[test]
    fn a_thin_difference_has_its_thickness_as_depth() {
        for thickness in [1e-2, 1e-3] {
            let plate = corners(Vec3::new(1.0, 1.0, 0.5 * thickness));
            let md = difference(hull(&plate), point());
            let hit = run(&md, None, MAX_PROVEN_POINTS, None).unwrap();
            assert_eq!(hit.status, Status::Converged);
            assert!((hit.depth - 0.5 * thickness).abs() <= TOLERANCE, "{hit:?}");
        }
    }

    /// Nearly concentric, nearly round ellipsoids need more vertices than the buffers on the stack have.
    #[test]
    fn full_buffers_are_continued_in_larger_ones() {
        let radii = Vec3::new(1.0, 1.01, 1.02);
        let at = Vec3::new(0.005, 0.002, 0.001);
        let md = || {
            difference(
                ellipsoid(radii, nalgebra::Rotation3::identity(), Vec3::zeros()),
                ellipsoid(
                    radii,
                    nalgebra::Rotation3::new(Vec3::new(0.3, 0.2, 0.1)),
                    at,
                ),
            )
        };
        let mut heap = Heap::new();
        let large = run(&md(), None, MAX_PROVEN_POINTS, Some(&mut heap)).unwrap();
        assert!(heap.1, "the buffers on the stack were enough");
        // Without larger buffers, and with fewer points, the bounds are honest and wider.
        let stack = run(&md(), None, MAX_PROVEN_POINTS, None).unwrap();
        let few = run(&md(), None, 40, None).unwrap();
        for hit in [&stack, &few] {
            assert_eq!(hit.status, Status::SupportLimit);
            assert!(hit.depth >= large.depth_lower && hit.depth_lower <= large.depth);
        }
        assert!(0.0 < few.depth_lower && few.depth_lower < stack.depth_lower);
        assert!(stack.depth_lower < large.depth_lower);
    }

    /// A center beyond a support plane: the depth is still one of a separating direction, and nothing is proven.
    #[test]
    fn a_center_outside_its_object_proves_nothing() {
        let mut r = Random::new(44);
        let mut found = 0;
        for _ in 0..400 {
            let md = difference(
                ball(Vec3::x() * r.within(0.5, 2.5), 1.0),
                ball(Vec3::zeros(), 1.0),
            );
            match run(
                &md,
                Some(&center(r.direction() * 5.0)),
                MAX_PROVEN_POINTS,
                None,
            ) {
                Ok(hit) => {
                    let h = md.support(&hit.dir).unwrap().v.dot(&hit.dir);
                    assert!((h - hit.depth).abs() < 1e3 * EPSILON, "{hit:?}");
                    if hit.status == Status::InconsistentSupport {
                        assert_eq!(hit.depth_lower, 0.0);
                        found += 1;
                    }
                }
                Err(stop) => {
                    assert!(
                        matches!(stop, Stop::Separated(Direction { n, .. }) if md.support(&n).unwrap().v.dot(&n) < 1e-5)
                    );
                }
            }
        }
        assert!(found > 10, "{found}");
    }

    /// Flat cones around a ball at their center: the tetrahedron of the first start has the origin on a face or an edge, and
    /// a face of no area must not take the same point until the limit. The depth is that of the side.
    #[test]
    fn a_face_without_area_does_not_take_a_point_twice() {
        let mut r = Random::new(43);
        for _ in 0..4000 {
            let (turn, radius, height) = (r.rotation(), r.within(0.4, 0.8), r.within(0.1, 0.2));
            let ball_radius = r.within(0.2, 0.5);
            // Centered on its axis, with the apex above.
            let cone = move |d: &Vec3| {
                let local = turn.inverse() * d;
                let across = Vec3::new(local.x, local.y, 0.0);
                let rim = across * (radius / across.norm().max(1e-300)) - Vec3::z() * height;
                let apex = Vec3::z() * height;
                let is_apex = apex.dot(&local) > rim.dot(&local);
                turn * if is_apex { apex } else { rim }
            };
            let offset = r.direction() * 10f64.powf(r.within(-18.0, -8.0));
            let md = difference(cone, ball(offset, ball_radius));
            let hit = run(&md, Some(&center(-offset)), MAX_DEFAULT_POINTS, None).unwrap();
            let side = radius * height / radius.hypot(2.0 * height);
            assert!(hit.depth <= 1.01 * (side + ball_radius), "{hit:?}");
        }
    }

    /// Closer centers need more corners than the limit allows, see [`MAX_PROVEN_POINTS`].
    #[test]
    fn balls_whose_centers_are_apart_are_proven() {
        let mut r = Random::new(46);
        for _ in 0..100 {
            let at = r.direction() * r.within(0.17, 0.95);
            let md = difference(ball(Vec3::zeros(), 0.5), ball(at, 0.5));
            let mut heap = Heap::new();
            let hit = run(&md, None, MAX_PROVEN_POINTS, Some(&mut heap)).unwrap();
            assert_eq!(hit.status, Status::Converged, "{at}");
            assert!((hit.depth - (1.0 - at.norm())).abs() <= TOLERANCE);
        }
    }
}
