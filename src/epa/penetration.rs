// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, from start to end.
//!
//! 1. *Separating axis*: the first direction, the warm state's or the way from the interior point through
//!    the origin. Most misses end here.
//! 2. *Interior point*: the difference of the centers where they are trusted; else the middle of the
//!    support points along the ray and against it, which is in D for certain.
//! 3. *Portal*: discovery and refinement ([`crate::mpr::portal`]).
//! 4. *Certificate*: where the tetrahedron of interior point and portal holds the ball whose radius is the
//!    upper bound less the allowed gap, the minimum is proven. Most shallow contacts end here.
//! 5. *Polytope*: EPA from that tetrahedron ([`crate::epa::expand`]), else from the points farthest from a
//!    point, a line and a plane, else from the tetrahedron of GJK; in buffers that grow.
//! 6. *Result*: depth and direction are the upper bound's, lower bound and witness points the polytope's.
//!
//! Departures. Steps 3 to 5 take known differences before callbacks. A known difference beyond a queried
//! plane shows that a callback contradicts itself; a plane that has the difference of the centers beyond it
//! shows that this is outside D. The query then starts again, once, with every direction evaluated twice
//! or without the centers.
//!
//! Validity. `depth`, `dir`: always; a sound depth. `depth_lower`: proven, of the global minimum (a trusted
//! center is part of the proof); 0 where nothing is proven. Witness points: always, each in its object.
//! [`Status::Converged`]: depth − depth_lower is within the gap.

use crate::contact::{Penetration, Status};
use crate::epa::expand::{EpaCorners, EpaLimits, ExpandEnd, exit_face, expand};
use crate::epa::plane::Tetrahedron;
use crate::epa::polytope::EpaPolytope;
use crate::gjk::barycentric;
use crate::gjk::intersect::{CAPACITY, contains_origin};
use crate::math::{Vec3, larger, lesser, normalise_unscaled, perpendicular};
use crate::minkowski::query::{Stop, SupportQuery, UpperBound};
use crate::minkowski::round_fit::SphereFit;
use crate::minkowski::support::{Fault, SupportMap, SupportPoint};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::mpr::portal::{discover, refine};
use crate::query::warm_start::{WarmKind, WarmStart};

/// The support calls of a default query, at most.
pub const MAX_DEFAULT_POINTS: u64 = 160;
/// The support calls of a query that proves the tolerance, at most. Derived: no call takes more than 400,
/// and what comes before and after takes up to 80 on nearly coincident bodies (`campaigns -- wide`).
pub const MAX_PROVEN_POINTS: u64 = 320;

/// The vertices of the small buffers, 6 KB on the stack with their corners and faces: enough for shallow
/// contacts and most polytopes. Less than 2 KB is zeroed by stores, more byte by byte.
pub const SMALL_VERTICES: usize = 24;
const SMALL_CORNERS: usize = 32;
const SMALL_FACES: usize = max_faces(SMALL_CORNERS);
/// The vertices of the large buffers, on the stack.
const LARGE_VERTICES: usize = MAX_DEFAULT_POINTS as usize + SPARE_VERTICES;
const LARGE_CORNERS: usize = max_corners(LARGE_VERTICES);
const LARGE_FACES: usize = max_faces(LARGE_CORNERS);
/// The vertices of the buffers that the caller lends.
const ARENA_VERTICES: usize = MAX_PROVEN_POINTS as usize + SPARE_VERTICES;
const ARENA_CORNERS: usize = 2 * ARENA_VERTICES;
const ARENA_FACES: usize = max_faces(ARENA_CORNERS);
/// Room for support calls beyond the limit, which holds only while the origin is inside.
const SPARE_VERTICES: usize = 8;
/// The entries that a first tetrahedron may add, for which there must be room.
const START_VERTICES: usize = 12;

/// Returns the corners for so many vertices. Known differences become corners without a callback: an
/// eighth more (measured, deep ellipsoids).
const fn max_corners(vertices: usize) -> usize {
    vertices + vertices / 8 + 5
}

/// Returns the faces for so many corners: a closed surface has 2 C − 4, and a fan is made before the faces
/// that it replaces are freed.
const fn max_faces(corners: usize) -> usize {
    (2 * corners).next_multiple_of(8)
}

const _: () = assert!(ARENA_CORNERS < 32768 && ARENA_FACES <= crate::epa::polytope::MAX_FACES);
const _: () = assert!(ARENA_VERTICES <= 1024 && START_VERTICES < SMALL_VERTICES);

/// The gap beyond the tolerance that still counts as converged where rounding ended the search, in support
/// epsilons. Derived: 20 for what a plane and a point above it round by where D is twice the reach, and as
/// much by which the face found there is closer than the closest.
const ROUNDING_GAP_EPS: f64 = 32.0;
/// The extent of D, in height epsilons, below which it counts as flat. Derived: as [`ROUNDING_GAP_EPS`].
const MIN_EXTENT_EPS: f64 = ROUNDING_GAP_EPS;
/// The share of the size that a known corner of a first tetrahedron must be away from the others. Without known
/// corners, or with any, more proofs end at the support limit (`campaign` in single precision, `wide` at tolerance 0).
const KNOWN_EXTENT_REL: f64 = 1e-3;
/// The support calls of a polytope after which D counts as round there.
const MAX_POLYTOPE_ITERATIONS: u64 = 3;

/// Memory for the largest polytopes. All bytes zero is a valid value.
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
    /// The difference of the centers that is trusted to lie in D.
    pub center: Option<&'a SupportPoint>,
    /// The unit direction of a cold start: from an interior point through the origin.
    pub ray: Vec3,
    /// The state of the last query; not that of a pair that was apart.
    pub warm: WarmStart,
    /// Limits of the expansion.
    pub limits: EpaLimits,
}

impl EpaRequest<'_> {
    /// Returns the direction to evaluate first, unit.
    #[inline(always)]
    pub fn first_dir(&self) -> Vec3 {
        if self.warm.kind == WarmKind::Overlap {
            self.warm.dir
        } else {
            self.ray
        }
    }
}

/// A tetrahedron to start the polytope from.
type Start = [Vertex; 4];

/// Reason why a polytope ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PolytopeEnd {
    /// The origin is shown inside, and the answer is written.
    Inside(Status),
    /// The origin is not shown inside.
    Outside,
    /// The buffers are full.
    NoRoom,
}

/// A query on its way.
struct Solver<'q, 'm, A, B> {
    query: &'q mut SupportQuery<'m, A, B>,
    limits: &'q EpaLimits,
    /// The interior point with the points of the objects that it is the difference of.
    interior: SupportPoint,
    fit: SphereFit,
    /// Support calls of the polytopes.
    iterations: u64,
    /// Gap between the depth in `hit` and its lower bound, metres; infinite before the first answer.
    gap: f64,
    hit: &'q mut Penetration,
}

/// Finds the global minimum of the penetration depth. `first`: the support point along
/// [`EpaRequest::first_dir`], which does not separate ([`SupportQuery::evaluate_first`]: most misses end
/// there, before this function's stack is in use). Without an `arena` the buffers on the stack are all
/// there is. The overlap in `hit` has no contact position. Returns the state for the next query; `set` holds the
/// vertices of the first support calls, for the contact position.
///
/// # Errors
/// [`Stop::Separated`]: apart, or touching within rounding. [`Fault::NonFinite`]; [`Fault::NoMemory`].
#[inline(always)]
pub fn penetration<A: SupportMap, B: SupportMap>(
    query: &mut SupportQuery<'_, A, B>,
    first: &SupportPoint,
    request: &EpaRequest<'_>,
    mut arena: Option<&mut dyn Arena>,
    set: &mut VertexSet<SMALL_VERTICES>,
    hit: &mut Penetration,
) -> Result<(Status, WarmStart), Stop> {
    let dir = &request.first_dir();
    set.push(dir, first);
    let warm = &request.warm;
    let is_warm = warm.kind == WarmKind::Overlap;
    // No start of its own: a guess, or one whose support value is far above the last depth; and of two round objects,
    // where its vertex is a poor corner of a portal. Negated for NaN.
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
        hit,
    };
    let mut center = request.center;
    let mut status = solver.run(set, center, &request.ray, is_warm, &mut arena)?;
    // A plane shows that the center is outside D, or callbacks contradict themselves: once more.
    let is_outside = center.is_some() && solver.query.interior.is_none();
    let is_inconsistent = solver.query.is_inconsistent;
    if is_outside || is_inconsistent {
        solver.gap = f64::INFINITY;
        if is_outside {
            center = None;
        }
        if is_inconsistent {
            set.truncate(0);
            solver.query.restart_inconsistent();
            solver.query.evaluate(set, dir)?;
        }
        status = solver.run(set, center, &request.ray, false, &mut arena)?;
        if is_inconsistent {
            solver.hit.depth_lower = 0.0;
            status = Status::InconsistentSupport;
        }
    }
    let UpperBound { dir, depth, .. } = solver.query.upper;
    let radius = solver.fit.confirmed_radius();
    let is_round = solver.iterations > MAX_POLYTOPE_ITERATIONS;
    Ok((status, WarmStart::hit(dir, depth, radius, is_round)))
}

impl<A: SupportMap, B: SupportMap> Solver<'_, '_, A, B> {
    /// Finds an interior point, a portal, a certificate, or expands polytopes.
    fn run(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        center: Option<&SupportPoint>,
        ray: &Vec3,
        is_warm: bool,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<Status, Stop> {
        let mut ray = *ray;
        let opposite = match center {
            Some(center) => {
                self.interior = *center;
                None
            }
            None => Some(self.find_interior(set, &mut ray)?),
        };
        let portal = self.find_portal(set, &ray)?;
        // A full set has no room for it: the last entry may be a corner.
        if let Some((dir, point)) = opposite.as_ref().filter(|_| !set.is_full()) {
            let index = set.push(dir, point);
            if self.query.upper.dir == *dir {
                self.query.upper.index = index;
            }
        }
        if let Some(portal) = &portal {
            if self.certify(set, portal, is_warm)? {
                return Ok(Status::Converged);
            }
        }
        self.expand_from(set, portal.as_ref(), is_warm, arena)
    }

    /// Takes the middle of the support points along the ray and against it for the interior point, and
    /// returns the opposite sample, which is removed from the set: it would be a corner of a wide portal.
    /// Turns the ray to start in that point.
    fn find_interior<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &mut Vec3,
    ) -> Result<(Vec3, SupportPoint), Stop> {
        let newest = set.point(VertexSet::<N>::pair_of_entry(set.len().saturating_sub(1)));
        let sample = self.query.evaluate(set, &-*ray)?;
        let index = usize::from(sample.pair.a);
        let opposite = (set.dir(index), set.point(sample.pair));
        set.truncate(index);
        if self.query.upper.index == index {
            self.query.upper.index = 0;
        }
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
        let tolerance = query.scale.tolerance(self.limits.gap.tolerance);
        let gap = self.limits.gap.allowed(query.upper.depth, tolerance);
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

    /// Proves the minimum from the tetrahedron of interior point and portal, if it can, and writes the
    /// answer.
    #[inline(always)]
    fn certify(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: &[Vertex; 3],
        is_warm: bool,
    ) -> Result<bool, Stop> {
        let [a, b, c] = portal.each_ref().map(|v| v.w);
        let scale = &self.query.scale;
        let ulp = f64::EPSILON * scale.size();
        let Some(tetrahedron) = Tetrahedron::new([self.interior.v, a, b, c], ulp) else {
            return Ok(false);
        };
        let lower = tetrahedron.inner_radius() - tetrahedron.error - scale.support_eps();
        let tolerance = scale.tolerance(self.limits.gap.tolerance);
        let allowed = self.limits.gap.allowed(self.query.upper.depth, tolerance);
        if !(lower > 0.0 && lower >= self.query.upper.depth - allowed) {
            return Ok(false);
        }
        if is_warm && self.query.upper.depth - lower > tolerance {
            let normal = (b - a).cross(&(c - a));
            self.refine_direction(set, portal, &normal)?;
        }
        self.write_result_on_face(set, *portal, lower, allowed);
        Ok(true)
    }

    /// Evaluates one more direction where a warm start has ended within the gap but not within the
    /// tolerance, so that directions of moving pairs follow them: the prediction of the sphere fits where
    /// they are confirmed, else the normal of the closest face.
    fn refine_direction<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
    ) -> Result<(), Stop> {
        let upper = self.query.upper;
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

    /// Expands polytopes from the starts there are, until one shows the origin inside.
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
            let start = match attempt {
                0 => portal.map(|[a, b, c]| [self.interior_vertex(), *a, *b, *c]),
                1 => self.find_farthest(set)?,
                _ => self.find_gjk_tetrahedron(set)?,
            };
            let Some(start) = start else { continue };
            let mut found = self.expand_small(set, &start, is_warm)?;
            if found == PolytopeEnd::NoRoom {
                // From the same tetrahedron: the known vertices rebuild the polytope without a callback.
                let mut buffers = None;
                found = self.expand_large(set, &start, arena, &mut buffers)?;
                if let Some(buffers) = buffers {
                    found = self.expand_in_arena(&start, buffers)?;
                }
            }
            // From another tetrahedron rounding may end the search later.
            if let PolytopeEnd::Inside(found) = found {
                status = found;
                if status != Status::Rounding {
                    return Ok(status);
                }
            }
        }
        if self.gap == f64::INFINITY {
            self.write_upper_bound(set);
            status = Status::Rounding;
        }
        Ok(status)
    }

    /// Expands a polytope in the small buffers.
    #[inline(never)]
    fn expand_small(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        start: &Start,
        is_warm: bool,
    ) -> Result<PolytopeEnd, Stop> {
        let mut corners = EpaCorners::<SMALL_CORNERS>::EMPTY;
        let mut polytope = EpaPolytope::<SMALL_FACES>::blank(self.query.scale.size());
        self.expand_in(set, &mut corners, &mut polytope, start, is_warm, true)
    }

    /// Expands a polytope in the large buffers. Where they are full and there is an arena, its buffers take
    /// the vertices.
    #[cold]
    #[inline(never)]
    fn expand_large<'m>(
        &mut self,
        small: &VertexSet<SMALL_VERTICES>,
        start: &Start,
        arena: &mut Option<&'m mut dyn Arena>,
        buffers: &mut Option<&'m mut EpaBuffers>,
    ) -> Result<PolytopeEnd, Stop> {
        let mut set = VertexSet::<LARGE_VERTICES>::EMPTY;
        let mut corners = EpaCorners::<LARGE_CORNERS>::EMPTY;
        let mut polytope = EpaPolytope::<LARGE_FACES>::BLANK;
        set.copy_from(small);
        let has_larger = arena.is_some();
        let found = self.expand_in(
            &mut set,
            &mut corners,
            &mut polytope,
            start,
            false,
            has_larger,
        )?;
        if let (PolytopeEnd::NoRoom, Some(arena)) = (found, arena.take()) {
            let large = arena.buffers()?;
            large.set.copy_from(&set);
            *buffers = Some(large);
        }
        Ok(found)
    }

    /// Expands a polytope in the buffers of an arena, which hold the vertices.
    #[cold]
    #[inline(never)]
    fn expand_in_arena(
        &mut self,
        start: &Start,
        buffers: &mut EpaBuffers,
    ) -> Result<PolytopeEnd, Stop> {
        let EpaBuffers {
            set,
            corners,
            polytope,
        } = buffers;
        self.expand_in(set, corners, polytope, start, false, false)
    }

    /// Expands a polytope from a tetrahedron and writes the answer, unless larger buffers are needed and
    /// there are any.
    #[inline(always)]
    fn expand_in<const N: usize, const C: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &mut EpaCorners<C>,
        polytope: &mut EpaPolytope<F>,
        start: &Start,
        is_warm: bool,
        has_larger: bool,
    ) -> Result<PolytopeEnd, Stop> {
        let ulp = f64::EPSILON * self.query.scale.size();
        let Some(tetrahedron) = Tetrahedron::new(start.map(|v| v.w), ulp) else {
            return Ok(PolytopeEnd::Outside);
        };
        let is_exact = self.limits.needs_exact_planes(&self.query.scale);
        polytope.start(&tetrahedron, is_exact);
        corners.start(start);
        let end = expand(
            self.query,
            set,
            &mut self.fit,
            &self.interior.v,
            corners,
            polytope,
            &mut self.iterations,
            self.limits,
            has_larger,
        )?;
        if end == ExpandEnd::NoRoom && has_larger {
            return Ok(PolytopeEnd::NoRoom);
        }
        self.compute_result(set, corners, polytope, end, is_warm)
    }

    /// Returns the interior point and the points farthest from it, from a line and from a plane, known or
    /// queried; `None` where D is flat within rounding.
    #[cold]
    #[inline(never)]
    fn find_farthest<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
    ) -> Result<Option<Start>, Stop> {
        let apex = self.interior_vertex();
        let mut found = [apex; 4];
        let c = apex.w;
        for i in 1..4 {
            let axes = match i {
                1 => [self.query.upper.dir, perpendicular(&self.query.upper.dir)],
                2 => {
                    let e = perpendicular(&(found[1].w - c));
                    [e, e.cross(&(found[1].w - c))]
                }
                _ => {
                    let n = (found[1].w - c).cross(&(found[2].w - c));
                    [n, n]
                }
            };
            let mut best = 0.0;
            // Known differences first; then queries along the axes, the second only where the first finds
            // nothing.
            for pass in 0..3 {
                let Some(n) = normalise_unscaled(&axes[usize::from(pass > 1)]) else {
                    continue;
                };
                for m in [n, -n] {
                    if pass > 0 {
                        self.query.evaluate(set, &m)?;
                    }
                    let v = set.farthest_vertex(&m);
                    let distance = m.dot(&(v.w - c));
                    if distance > best {
                        (best, found[i]) = (distance, v);
                    }
                }
                // A known difference need not be the farthest one, but it must not make a sliver.
                let scale = &self.query.scale;
                let known = if pass == 0 {
                    KNOWN_EXTENT_REL * scale.size()
                } else {
                    0.0
                };
                if best > larger(known, MIN_EXTENT_EPS * scale.height_eps()) {
                    break;
                }
            }
            if !(best > MIN_EXTENT_EPS * self.query.scale.height_eps()) {
                return Ok(None);
            }
        }
        Ok(Some(found))
    }

    /// Returns the tetrahedron of GJK, which decides whether the objects overlap where no polytope has come
    /// to hold the origin.
    #[cold]
    #[inline(never)]
    fn find_gjk_tetrahedron<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
    ) -> Result<Option<Start>, Stop> {
        let mut known = VertexSet::<CAPACITY>::EMPTY;
        let dir = self.query.upper.dir;
        let found = contains_origin(self.query, &mut known, None, &dir, false)?;
        // The points may be no support points: they have no direction.
        Ok(Some(found.corners.map(|point| {
            let pair = VertexSet::<N>::pair_of_entry(set.push(&Vec3::zeros(), &point));
            Vertex { w: point.v, pair }
        })))
    }

    /// Writes the answer of an expansion, unless an earlier one is as close to its lower bound.
    #[inline(never)]
    fn compute_result<const N: usize, const C: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        corners: &EpaCorners<C>,
        polytope: &EpaPolytope<F>,
        end: ExpandEnd,
        is_warm: bool,
    ) -> Result<PolytopeEnd, Stop> {
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
        let vertices = |f: usize| {
            polytope
                .corners(f)
                .map(|id| corners.vertex(set, &interior, id))
        };
        if is_warm && end == ExpandEnd::Converged && self.query.upper.depth - lower > tolerance {
            let face = vertices(closest.face);
            self.refine_direction(set, &face, &polytope.normal(closest.face))?;
        }
        let upper = self.query.upper;
        if self.gap == f64::INFINITY || upper.depth - lower < self.gap {
            let corner = |id: usize| corners.vertex(set, &interior, id).w;
            let (dir, depth) = (&upper.dir, upper.depth);
            let face = exit_face(polytope, &corner, closest.face, dir, depth, tolerance);
            let face = polytope
                .corners(face)
                .map(|id| corners.vertex(set, &interior, id));
            self.write_result_on_face(set, face, lower, tolerance);
        }
        // The bound as it is rounded down must be within the gap, whatever ended the search.
        let tolerance = larger(self.limits.gap.tolerance, tolerance);
        let allowed = self
            .limits
            .gap
            .allowed(upper.depth, tolerance + ROUNDING_GAP_EPS * support_eps);
        let status = match end {
            _ if upper.depth - lower <= allowed => Status::Converged,
            ExpandEnd::Converged | ExpandEnd::Rounding => Status::Rounding,
            ExpandEnd::SupportLimit | ExpandEnd::NoRoom => Status::SupportLimit,
            ExpandEnd::IterationLimit => Status::IterationLimit,
        };
        Ok(if is_inside {
            PolytopeEnd::Inside(status)
        } else {
            PolytopeEnd::Outside
        })
    }

    /// Writes the answer along the direction of the upper bound; `face`: where the ray along it leaves the
    /// polytope. The witness points are those of the closest point to the foot depth · dir: on the face, or
    /// where that is farther away than the gap, on a triangle of two of its corners and the support vertex
    /// of the direction or the interior point. (The ball of the lower bound is in the hull of these: a point
    /// of the ray between the bounds is.)
    #[inline(always)]
    fn write_result_on_face<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        mut face: [Vertex; 3],
        lower: f64,
        gap: f64,
    ) {
        let upper = self.query.upper;
        self.query.is_inconsistent |= self.query.has_contradiction(set);
        let foot = upper.dir * upper.depth;
        let closest = |[a, b, c]: &[Vertex; 3]| barycentric::triangle(&foot, &a.w, &b.w, &c.w);
        let mut best = closest(&face);
        if best.distance2 > gap * lesser(gap, upper.depth) {
            let pair = VertexSet::<N>::pair_of_entry(upper.index);
            let support = Vertex {
                w: set.difference(pair),
                pair,
            };
            let corners = face;
            for apex in [support, self.interior_vertex()] {
                for i in 0..3 {
                    let mut triangle = corners;
                    triangle[i] = apex;
                    let other = closest(&triangle);
                    if other.distance2 < best.distance2 {
                        (best, face) = (other, triangle);
                    }
                }
            }
        }
        let weights = best.weights;
        let mut points = [Vec3::zeros(); 2];
        for (weight, v) in weights.iter().zip(&face) {
            let point = if v.pair.is_interior() {
                self.interior
            } else {
                set.point(v.pair)
            };
            points[0] += point.v1 * *weight;
            points[1] += point.v2 * *weight;
        }
        self.write_result(lower, points);
    }

    /// Writes the answer where nothing is known but the upper bound.
    fn write_upper_bound<const N: usize>(&mut self, set: &VertexSet<N>) {
        let point = set.point(VertexSet::<N>::pair_of_entry(self.query.upper.index));
        self.write_result(0.0, [point.v1, point.v2]);
    }

    #[inline(always)]
    fn write_result(&mut self, lower: f64, [point1, point2]: [Vec3; 2]) {
        let upper = self.query.upper;
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
