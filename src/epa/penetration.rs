// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, from start to end.
//!
//! 1. *Separating axis*: evaluate the first direction: the warm state's or the *ray* (centers to origin, else
//!    `first_dir`). Most queries of separated objects end here.
//! 2. *Interior point*: the difference of the centers if they are given; else the middle of the
//!    support points along the ray and opposite to it, which is always in D.
//! 3. *Portal*: discovery and refinement ([`crate::portal`]).
//! 4. *Certificate*: if the tetrahedron of interior point and portal contains the ball around the origin whose radius
//!    is the upper bound less the allowed gap ([`GapLimit`](crate::minkowski::tolerance::GapLimit)), the minimum is
//!    proven. Most shallow contacts end here.
//! 5. *Polytope*: EPA ([`crate::epa::expand`]) from that tetrahedron; if it does not come to contain the origin, or
//!    rounding ends it, from two tetrahedra of GJK. Full buffers are replaced by larger ones.
//! 6. *Result*: depth and direction are those of the upper bound; lower bound and witness points are the polytope's.
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

use crate::epa::expand::{EpaCorners, EpaLimits, ExpandEnd, exit_face, expand};
use crate::epa::polytope::EpaPolytope;
use crate::geometry::barycentric;
use crate::geometry::plane::{PLANE_ERROR_ULPS, Tetrahedron, base_distance};
use crate::gjk::intersect::{CAPACITY, Enclosing, contains_origin};
use crate::math::{Vec3, larger, lesser, normalise_unscaled};
use crate::minkowski::sphere_fit::SphereFit;
use crate::minkowski::support::{Fault, SupportMap, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::minkowski::warm_start::{WarmKind, WarmStart};
use crate::portal::{discover, refine};
use crate::trace;
use crate::types::{Penetration, Status};

/// The limit of support points of a default query, up to the end of its polytope.
pub const MAX_DEFAULT_POINTS: u64 = 160;
/// The limit of support points of a query that proves the tolerance, up to the end of its polytope, and of the published
/// method (along, incremental, planar).
///
/// No query is to take more than 400 support points in all. Derived: 400 − 80. Measured (`cargo run --release --example
/// campaigns -- wide`): up to 80 more, on nearly coincident bodies, are evaluated beyond this limit, for starts of the
/// polytope that do not contain the origin yet and in the local search that follows
/// ([`MAX_WALK_POINTS`](crate::local::MAX_WALK_POINTS)). Queries without a polytope have
/// [`ITERATION_CAP`](crate::math::ITERATION_CAP).
pub const MAX_PROVEN_POINTS: u64 = 320;

/// The number of vertices of the small buffers, 6 KB on the stack with their corners and faces: enough for shallow
/// contacts and most polytopes. (The compiler initialises less than 2 KB by stores, more by a slower loop.)
pub const SMALL_VERTICES: usize = 24;
const SMALL_CORNERS: usize = 32;
const SMALL_FACES: usize = max_faces(SMALL_CORNERS);
/// The number of vertices of the large buffers, on the stack.
const LARGE_VERTICES: usize = MAX_DEFAULT_POINTS as usize + SPARE_VERTICES;
/// The number of faces of the large buffers: what 44 KB of stack leave (test `costs`).
const LARGE_FACES: usize = 352;
/// The number of corners that these faces are enough for: a closed surface of C corners has 2 C − 4 faces, and an insertion
/// makes a few new faces before it frees the old ones. The corners above the number of vertices are known differences.
const LARGE_CORNERS: usize = LARGE_FACES / 2 - 2;
/// The number of vertices of the buffers of an [`Arena`].
const ARENA_VERTICES: usize = MAX_PROVEN_POINTS as usize + SPARE_VERTICES;
const ARENA_CORNERS: usize = 2 * ARENA_VERTICES;
const ARENA_FACES: usize = max_faces(ARENA_CORNERS);
/// The room for support points above the limit, which applies only while the origin is inside the polytope.
const SPARE_VERTICES: usize = 4;
/// The number of entries that a start of the polytope adds to the vertex set: the corners of a tetrahedron.
const START_VERTICES: usize = 4;

/// Returns the number of faces for C corners: a closed surface has 2 C − 4 faces, and an insertion makes the new faces
/// before it frees the old ones.
const fn max_faces(corners: usize) -> usize {
    (2 * corners).next_multiple_of(8)
}

const _: () = assert!(LARGE_CORNERS > LARGE_VERTICES);
const _: () = assert!(ARENA_CORNERS < 32768 && ARENA_FACES <= crate::epa::polytope::MAX_FACES);
const _: () = assert!(ARENA_VERTICES <= 1024 && START_VERTICES < SMALL_VERTICES);

/// The gap above the tolerance that counts as converged if rounding ended the search, in support epsilons. Derived: 20
/// for the rounding of a plane and of a point above it if the size of D is twice the world extent; the rest is a
/// reserve.
const ROUNDING_GAP_EPS: f64 = 32.0;
/// The number of iterations above which D counts as curved at the minimum ([`WarmKind::CurvedOverlap`]).
const MAX_POLYHEDRON_ITERATIONS: u64 = 3;

/// Buffers for the largest polytopes. All bytes zero is a valid value.
pub struct EpaBuffers {
    set: VertexSet<ARENA_VERTICES>,
    corners: EpaCorners<ARENA_CORNERS>,
    polytope: EpaPolytope<ARENA_FACES>,
}

/// A source of [`EpaBuffers`], used once and only if a query needs them.
pub trait Arena {
    /// Returns buffers with any contents.
    ///
    /// # Errors
    /// [`Fault::NoMemory`].
    fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault>;
}

/// The input of a query besides the support functions.
#[derive(Clone, Copy, Debug)]
pub struct EpaRequest<'a> {
    /// The difference of the centers, which is trusted to lie in D: the interior point.
    pub center: Option<&'a SupportPoint>,
    /// The unit direction of a cold start: from an interior point through the origin.
    pub ray: Vec3,
    /// The state of the last query; cold if the pair was separated.
    pub warm: WarmStart,
    /// The limits of the query.
    pub limits: EpaLimits,
    /// False if the witness points are not read; they are then zero.
    pub wants_points: bool,
}

/// Result of the search without a polytope.
enum PortalEnd {
    /// The minimum is proven, and the result is written.
    Certified,
    /// The minimum is not proven; a portal, if one was found.
    Open(Option<[Vertex; 3]>),
}

/// A tetrahedron to start the polytope from.
type Start = [Vertex; 4];

/// The state of a query.
struct Solver<'q, 'm, A, B> {
    query: &'q mut SupportQuery<'m, A, B>,
    limits: &'q EpaLimits,
    /// The interior point, and the points of the objects whose difference it is.
    interior: SupportPoint,
    fit: SphereFit,
    /// The number of support points that expanded polytopes.
    iterations: u64,
    /// The gap between the bounds in `hit`, metres; infinite before the first result.
    gap: f64,
    /// See [`EpaRequest::wants_points`].
    wants_points: bool,
    /// True if a support function contradicts the plane of the result.
    is_inconsistent: bool,
    hit: &'q mut Penetration,
}

/// Finds the global minimum of the penetration depth, by the steps at the head of this file, and writes it to `hit`,
/// without a contact position. `first`: the support point along the warm state's direction or the ray, which does not separate
/// ([`SupportQuery::evaluate_first`]: most queries of separated objects end there, before this function's stack is in
/// use). Without an `arena` there are only the buffers on the stack. Returns the state for the next query; `set` has the
/// vertices of the first support calls, for the contact position.
///
/// # Errors
/// [`Stop::Separated`]: the objects are separated, or in contact within rounding. [`Fault::NonFinite`];
/// [`Fault::NoMemory`].
#[inline(always)]
pub fn penetration<A: SupportMap, B: SupportMap>(
    query: &mut SupportQuery<'_, A, B>,
    first: &SupportPoint,
    request: &EpaRequest<'_>,
    mut arena: Option<&mut dyn Arena>,
    set: &mut VertexSet<SMALL_VERTICES>,
    hit: &mut Penetration,
) -> Result<WarmStart, Stop> {
    set.push(&query.upper.dir, first);
    let warm = &request.warm;
    let is_warm = warm.kind == WarmKind::Overlap;
    // The ray is evaluated too if the warm direction is only a guess (its depth is 0), if its support value is more
    // than twice the last depth, or if both objects are round, where its vertex is a poor corner of a portal. Negated
    // for NaN.
    let is_round = warm.radius[0] * warm.radius[1] > 0.0;
    if is_warm && (is_round || !(query.upper.depth <= 2.0 * warm.depth)) {
        query.evaluate(set, &request.ray)?;
    }
    let mut solver = Solver {
        limits: &request.limits,
        interior: SupportPoint::default(),
        fit: SphereFit::warm(warm.radius),
        query,
        iterations: 0,
        gap: f64::INFINITY,
        wants_points: request.wants_points,
        is_inconsistent: false,
        hit,
    };
    let mut status = solver.run(set, request, is_warm, &mut arena)?;
    // A support plane excludes the center from D: the polytope may contain an origin that is outside.
    if request.center.is_some() && solver.query.interior.is_none() {
        let dir = solver.query.upper.dir;
        solver.prove_overlap(&dir)?;
        solver.is_inconsistent = true;
    }
    if solver.is_inconsistent {
        solver.hit.depth_lower = 0.0;
        status = Status::InconsistentSupport;
    }
    solver.hit.status = status;
    let SupportPlane { dir, depth, .. } = solver.query.upper;
    let radius = solver.fit.confirmed_radius();
    let is_round = solver.iterations > MAX_POLYHEDRON_ITERATIONS;
    Ok(WarmStart::hit(dir, depth, radius, is_round))
}

impl<A: SupportMap, B: SupportMap> Solver<'_, '_, A, B> {
    /// Runs steps 2 to 6.
    #[inline(always)]
    fn run(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        request: &EpaRequest<'_>,
        is_warm: bool,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<Status, Stop> {
        match self.run_without_polytope(set, request.center, &request.ray, is_warm)? {
            PortalEnd::Certified => Ok(Status::Converged),
            PortalEnd::Open(portal) => self.expand_from(set, portal.as_ref(), is_warm, arena),
        }
    }

    /// Runs steps 2 to 4. Not inlined, so that its frame is released before a polytope is made.
    #[inline(never)]
    fn run_without_polytope(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        center: Option<&SupportPoint>,
        ray: &Vec3,
        is_warm: bool,
    ) -> Result<PortalEnd, Stop> {
        let mut ray = *ray;
        let opposite = match center {
            Some(center) => {
                self.interior = *center;
                None
            }
            None => Some(self.find_interior(set, &mut ray)?),
        };
        let portal = self.find_portal(set, &ray)?;
        // Not into a full set: it would replace the last entry, which may be a corner.
        if let Some((dir, point)) = opposite.as_ref().filter(|_| !set.is_full()) {
            set.push(dir, point);
        }
        if let Some(portal) = &portal {
            if self.certify(set, portal, is_warm)? {
                return Ok(PortalEnd::Certified);
            }
        }
        Ok(PortalEnd::Open(portal))
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
            if turn2 > 0.3 {
                self.query.evaluate(set, ray)?;
            }
        }
        Ok(opposite)
    }

    /// Finds a portal of the ray and refines it.
    #[inline(always)]
    fn find_portal<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &Vec3,
    ) -> Result<Option<[Vertex; 3]>, Stop> {
        let query = &mut *self.query;
        let gap = self.limits.gap.allowed(&query.scale, query.upper.depth);
        let length = query.upper.depth - self.interior.v.dot(ray);
        let Some(mut portal) = discover(query, set, ray, length, gap, (2.0 * gap / length).sqrt())?
        else {
            return Ok(None);
        };
        refine(
            query,
            set,
            &mut self.fit,
            ray,
            &mut portal,
            &self.limits.gap,
        )?;
        Ok(Some(portal))
    }

    /// Returns the interior point as a corner.
    fn interior_vertex(&self) -> Vertex {
        Vertex {
            w: self.interior.v,
            pair: VertexPair::INTERIOR,
        }
    }

    /// Tries to prove the minimum from the tetrahedron of interior point and portal. Returns whether it is proven and
    /// written.
    #[inline(always)]
    fn certify(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: &[Vertex; 3],
        is_warm: bool,
    ) -> Result<bool, Stop> {
        let [a, b, c] = portal.each_ref().map(|v| v.w);
        let scale = &self.query.scale;
        let size = scale.size();
        let tolerance = scale.tolerance(self.limits.gap.tolerance);
        let allowed = self.limits.gap.allowed(scale, self.query.upper.depth);
        let error = PLANE_ERROR_ULPS * f64::EPSILON * size + scale.support_eps();
        // A lower bound of at most the contact epsilon proves no overlap.
        let least = larger(self.query.upper.depth - allowed, scale.contact_eps()) + error;
        let Some(distance) = base_distance(&self.interior.v, &[a, b, c], least, size) else {
            return Ok(false);
        };
        let lower = distance - error;
        if is_warm && self.query.upper.depth - lower > tolerance {
            let normal = (b - a).cross(&(c - a));
            self.refine_direction(set, portal, &normal)?;
        }
        self.write_result_on_face(set, || *portal, lower, allowed);
        Ok(true)
    }

    /// Evaluates one more direction, after a warm start has ended within the gap but not within the tolerance, so that
    /// the direction tracks the motion of the pair: the prediction of the sphere fits if they are confirmed, else the
    /// normal of the closest face.
    fn refine_direction<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
    ) -> Result<(), Stop> {
        trace::stage("warm refinement");
        let upper = &self.query.upper;
        let predicted = match self.fit.is_confirmed {
            true => self.fit.predict(set, corners, &upper.dir),
            false => normalise_unscaled(normal).map(|n| (n, 0.0)),
        };
        match predicted {
            Some((n, value)) if value < upper.depth && !set.is_full() => {
                self.query.evaluate(set, &n)?;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Expands polytopes from up to three starts, until one contains the origin and is not ended by rounding: the
    /// tetrahedron of interior point and portal, and those of GJK from both sides. Measured (`campaigns -- wide`, per
    /// 100,000 queries): without the second start 95, without both 450 proofs end by rounding, at tolerance 0.
    #[inline(never)]
    fn expand_from(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: Option<&[Vertex; 3]>,
        is_warm: bool,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<Status, Stop> {
        let mut status = Status::Rounding;
        for attempt in 0..3 {
            if attempt > 0 {
                set.truncate(SMALL_VERTICES - START_VERTICES);
            }
            let dir = self.query.upper.dir;
            let start = match attempt {
                0 => portal.map(|[a, b, c]| [self.interior_vertex(), *a, *b, *c]),
                1 => Some(self.find_gjk_tetrahedron(set, &-dir)?),
                _ => Some(self.find_gjk_tetrahedron(set, &dir)?),
            };
            let Some(start) = start else { continue };
            let mut corners = EpaCorners::EMPTY;
            let mut polytope = EpaPolytope::blank(self.query.scale.size());
            let end = self.expand_small(set, &mut corners, &mut polytope, &start)?;
            let found = match end {
                None => None,
                Some(ExpandEnd::NoRoom) => self.expand_large(set, &corners, &polytope, arena)?,
                Some(end) => self.compute_result(set, &corners, &polytope, end, is_warm)?,
            };
            // If rounding ended the expansion, one from the next start may end closer to the minimum.
            if let Some(found) = found {
                status = found;
                if status != Status::Rounding {
                    if !(self.hit.depth_lower > self.query.scale.contact_eps()) {
                        self.prove_overlap(&dir)?;
                    }
                    return Ok(status);
                }
            }
        }
        if self.gap == f64::INFINITY {
            self.write_upper_bound();
            status = Status::Rounding;
        }
        Ok(status)
    }

    /// Expands a polytope from a tetrahedron in the small buffers; `None` if the tetrahedron is flat. Not inlined: the
    /// small buffers are alive while larger ones are in use, this frame is not.
    #[inline(never)]
    fn expand_small(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        corners: &mut EpaCorners<SMALL_CORNERS>,
        polytope: &mut EpaPolytope<SMALL_FACES>,
        start: &Start,
    ) -> Result<Option<ExpandEnd>, Stop> {
        let ulp = f64::EPSILON * self.query.scale.size();
        let Some(tetrahedron) = Tetrahedron::new(start.map(|v| v.w), ulp) else {
            return Ok(None);
        };
        let is_exact = self.limits.needs_exact_planes(&self.query.scale);
        polytope.start(&tetrahedron, is_exact);
        corners.start(start);
        self.expand_in(set, corners, polytope, true).map(Some)
    }

    /// Continues an expansion in the large buffers and, if these become full, in those of the arena if there is one.
    /// Returns as [`Solver::compute_result`].
    #[cold]
    #[inline(never)]
    fn expand_large(
        &mut self,
        small_set: &VertexSet<SMALL_VERTICES>,
        small_corners: &EpaCorners<SMALL_CORNERS>,
        small_polytope: &EpaPolytope<SMALL_FACES>,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<Option<Status>, Stop> {
        let mut set = VertexSet::<LARGE_VERTICES>::EMPTY;
        let mut corners = EpaCorners::<LARGE_CORNERS>::EMPTY;
        let mut polytope = EpaPolytope::<LARGE_FACES>::BLANK;
        set.copy_from(small_set);
        corners.copy_from(small_corners);
        polytope.copy_from(small_polytope);
        let end = self.expand_in(&mut set, &mut corners, &mut polytope, arena.is_some())?;
        match arena.take() {
            Some(arena) if end == ExpandEnd::NoRoom => {
                let buffers = arena.buffers()?;
                buffers.set.copy_from(&set);
                buffers.corners.copy_from(&corners);
                buffers.polytope.copy_from(&polytope);
                self.expand_in_arena(buffers)
            }
            _ => self.compute_result(&mut set, &corners, &polytope, end, false),
        }
    }

    /// Continues an expansion in the buffers of an arena. Returns as [`Solver::compute_result`].
    #[cold]
    #[inline(never)]
    fn expand_in_arena(&mut self, buffers: &mut EpaBuffers) -> Result<Option<Status>, Stop> {
        let EpaBuffers {
            set,
            corners,
            polytope,
        } = buffers;
        let end = self.expand_in(set, corners, polytope, false)?;
        self.compute_result(set, corners, polytope, end, false)
    }

    /// Expands a polytope in these buffers. `has_larger`: true if the expansion is continued when they are full.
    #[inline(always)]
    fn expand_in<const N: usize, const C: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &mut EpaCorners<C>,
        polytope: &mut EpaPolytope<F>,
        has_larger: bool,
    ) -> Result<ExpandEnd, Stop> {
        expand(
            self.query,
            set,
            &mut self.fit,
            &self.interior.v,
            corners,
            polytope,
            &mut self.iterations,
            self.limits,
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
    fn find_gjk_tetrahedron<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        dir: &Vec3,
    ) -> Result<Start, Stop> {
        let found = self.prove_overlap(dir)?;
        // The points need not be support points, so they are stored without a direction.
        Ok(found.corners.map(|point| {
            let pair = VertexSet::<N>::pair_of_entry(set.push(&Vec3::zeros(), &point));
            Vertex { w: point.v, pair }
        }))
    }

    /// Writes the result of an expansion, unless the gap of an earlier result is as small. Returns its status; `None` if
    /// the polytope does not provably contain the origin.
    #[inline(never)]
    fn compute_result<const N: usize, const C: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &EpaCorners<C>,
        polytope: &EpaPolytope<F>,
        end: ExpandEnd,
        is_warm: bool,
    ) -> Result<Option<Status>, Stop> {
        let closest = polytope.closest_face();
        let support_eps = self.query.scale.support_eps();
        let tolerance = self.query.scale.tolerance(self.limits.gap.tolerance);
        let is_inside = polytope.encloses_interior_point() && closest.key >= 0.0;
        let lower = if is_inside {
            larger(polytope.lower_bound(&closest) - support_eps, 0.0)
        } else {
            0.0
        };
        let interior = self.interior.v;
        if is_warm && end == ExpandEnd::Converged && self.query.upper.depth - lower > tolerance {
            let face = corners.face(set, &interior, polytope.corners(closest.face));
            self.refine_direction(set, &face, &polytope.normal(closest.face))?;
        }
        let upper = self.query.upper;
        if self.gap == f64::INFINITY || upper.depth - lower < self.gap {
            let gap = self.limits.gap.allowed(&self.query.scale, upper.depth);
            let face = || {
                let corner = |id: usize| corners.vertex(set, &interior, id).w;
                let (dir, depth) = (&upper.dir, upper.depth);
                let face = exit_face(polytope, &corner, closest.face, dir, depth, gap);
                corners.face(set, &interior, polytope.corners(face))
            };
            self.write_result_on_face(set, face, lower, gap);
        }
        // Converged is decided by the lower bound as rounded down, whatever ended the expansion.
        let gap = &self.limits.gap;
        let allowed = larger(
            gap.allowed(&self.query.scale, upper.depth),
            larger(gap.tolerance, tolerance) + ROUNDING_GAP_EPS * support_eps,
        );
        let status = match end {
            _ if upper.depth - lower <= allowed => Status::Converged,
            ExpandEnd::Converged | ExpandEnd::Rounding => Status::Rounding,
            ExpandEnd::SupportLimit | ExpandEnd::NoRoom => Status::SupportLimit,
            ExpandEnd::IterationLimit => Status::IterationLimit,
        };
        Ok(is_inside.then_some(status))
    }

    /// Writes the result of the upper bound. `face`: returns the face through which the ray along its direction leaves
    /// the polytope.
    #[inline(always)]
    fn write_result_on_face<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        face: impl FnOnce() -> [Vertex; 3],
        lower: f64,
        gap: f64,
    ) {
        self.is_inconsistent = self.query.is_inconsistent(set);
        let points = if self.wants_points {
            self.witness_points(set, &face(), gap)
        } else {
            [Vec3::zeros(); 2]
        };
        self.write_result(lower, points);
    }

    /// Returns the witness points of the upper bound. They are those of the point closest to the foot, depth · dir, on
    /// one of these triangles:
    ///
    /// 1. the face, if that point is within the gap of the foot;
    /// 2. otherwise, if closer, the face with one corner replaced by the support point of the direction;
    /// 3. or with one corner replaced by the interior point.
    #[inline(always)]
    fn witness_points<const N: usize>(
        &self,
        set: &VertexSet<N>,
        face: &[Vertex; 3],
        gap: f64,
    ) -> [Vec3; 2] {
        let upper = &self.query.upper;
        let foot = upper.dir * upper.depth;
        let closest = |[a, b, c]: &[Vec3; 3]| barycentric::triangle(&foot, a, b, c);
        let [a, b, c] = face;
        let corners = [a.w, b.w, c.w];
        let mut best = closest(&corners);
        let mut replaced = None;
        if best.distance2 > gap * lesser(gap, upper.depth) {
            for point in [&upper.point, &self.interior] {
                for i in 0..3 {
                    let mut triangle = corners;
                    triangle[i] = point.v;
                    let other = closest(&triangle);
                    if other.distance2 < best.distance2 {
                        (best, replaced) = (other, Some((i, *point)));
                    }
                }
            }
        }
        let mut points = [Vec3::zeros(); 2];
        for (i, (weight, v)) in best.weights.iter().zip(face).enumerate() {
            let point = match replaced {
                Some((k, point)) if k == i => point,
                _ if v.pair.is_interior() => self.interior,
                _ => set.point(v.pair),
            };
            points[0] += point.v1 * *weight;
            points[1] += point.v2 * *weight;
        }
        points
    }

    /// Writes a result with only the upper bound.
    fn write_upper_bound(&mut self) {
        let point = self.query.upper.point;
        self.write_result(0.0, [point.v1, point.v2]);
    }

    #[inline(always)]
    fn write_result(&mut self, lower: f64, [point1, point2]: [Vec3; 2]) {
        let upper = &self.query.upper;
        let lower = lower.min(upper.depth);
        self.gap = upper.depth - lower;
        *self.hit = Penetration {
            depth: upper.depth,
            depth_lower: lower,
            dir: upper.dir,
            normal: upper.dir,
            point1,
            point2,
            iterations: self.iterations,
            ..Penetration::default()
        };
    }
}
