// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, from start to end.
//!
//! 1. *Separating axis*: evaluate the first direction: the warm state's or the *ray* (centers to origin, else
//!    `first_dir`). Most queries of separated objects end here.
//! 2. *Interior point*: the difference of the centers if they are given; else the middle of the
//!    support points along the ray and opposite to it, which is always in D.
//! 3. *Portal*: discovery and refinement ([`crate::portal`]); if the vertex of the first direction is near the ray, as
//!    that of a warm state is, a ring of three support points around the direction of the upper bound.
//! 4. *Certificate*: if the tetrahedron of interior point and portal contains the ball around the origin whose radius
//!    is the upper bound less the allowed gap ([`GapLimit`](crate::minkowski::tolerance::GapLimit)), the minimum is
//!    proven. Most shallow contacts end here.
//! 5. *Polytope*: EPA ([`crate::epa::expand`]) from that tetrahedron, or from one of four wide directions, in place of steps
//!    3 and 4, if the centers are close to each other; if the polytope does not come to contain the origin, or rounding ends
//!    it, from a tetrahedron of GJK, then from one of four wide directions. Full buffers are replaced by larger ones.
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

mod result;
mod start;

use crate::epa::buffers::{
    Arena, EpaBuffers, LARGE_FACES, LARGE_VERTICES, SMALL_FACES, SMALL_VERTICES, START_VERTICES,
};
use crate::epa::expand::{EpaLimits, Expansion, expand};
use crate::epa::global_minimum::result::Proof;
use crate::epa::polytope::EpaPolytope;
use crate::gjk::overlap::{CAPACITY, OverlapProof, contains_origin};
use crate::math::Vec3;
use crate::minkowski::predictor::Predictor;
use crate::minkowski::support::{Difference, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};
use crate::minkowski::warm_start::WarmStart;
use crate::portal::FAR_UPPER_REL;
use crate::types::{Solution, Status};

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

/// Result of the steps before a polytope is made.
enum Outcome {
    /// The minimum is proven.
    Proven(Proof),
    /// The tetrahedron from which the polytope starts; `None` if none was found.
    Open(Option<[VertexPair; 4]>),
}

/// The state of a query.
struct EpaSolver<'q, 'm, D> {
    query: &'q mut SupportQuery<'m, D>,
    request: &'q EpaRequest<'q>,
    /// The interior point, and the points of the objects whose difference it is.
    interior: SupportPoint,
    predictor: Predictor,
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
pub fn global_minimum<D: Difference>(
    query: &mut SupportQuery<'_, D>,
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
        predictor: Predictor::warm(radius),
        far_upper_rel: if is_warm && !is_guess {
            f64::INFINITY
        } else {
            FAR_UPPER_REL
        },
        iterations: 0,
    };
    let (proof, mut status) = match solver.run_without_polytope(set)? {
        Outcome::Proven(proof) => (proof, Status::Converged),
        Outcome::Open(start) => solver.expand_from(set, start, &mut arena)?,
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
        radius: solver.predictor.confirmed_radius(),
        ..Solution::default()
    })
}

impl<D: Difference> EpaSolver<'_, '_, D> {
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
        if self.is_central() {
            let dir = self.query.upper.dir;
            let apex = set.farthest(&dir);
            if let Some(start) = self.find_wide_tetrahedron(set, &dir, apex)? {
                return Ok(Outcome::Open(Some(start)));
            }
        }
        let portal = self.find_portal(set, &ray)?;
        // Not into a full set: it would replace the last entry, which may be a corner.
        if let Some((dir, point)) = opposite.as_ref().filter(|_| !set.is_full()) {
            set.push(dir, point);
        }
        let Some(portal) = portal else {
            return Ok(Outcome::Open(None));
        };
        if let Some(proof) = self.certify(set, &portal)? {
            return Ok(Outcome::Proven(proof));
        }
        let [a, b, c] = portal.corners.map(|v| v.pair);
        Ok(Outcome::Open(Some([VertexPair::INTERIOR, a, b, c])))
    }

    /// Returns the gap that is allowed below the upper bound, metres.
    #[inline(always)]
    fn allowed_gap(&self) -> f64 {
        let query = &*self.query;
        let gap = &self.request.limits.gap;
        gap.allowed(&query.scale, query.upper.depth)
    }

    /// Step 5. Expands polytopes from up to three starts, until one contains the origin and is not ended by rounding: the
    /// tetrahedron `first` of steps 2 to 4, that of GJK, and that of four wide directions. Measured (`judged hard 2000
    /// 18`, seeds 11 to 14): with GJK's from the other side in place of the last 3 of 8,000 nearly coincident pairs end
    /// up to 63 % too deep, because the same flat tetrahedron is found.
    #[inline(never)]
    fn expand_from(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        first: Option<[VertexPair; 4]>,
        arena: &mut Option<&mut dyn Arena>,
    ) -> Result<(Proof, Status), Stop> {
        // The proof with the least gap.
        let mut best: Option<Proof> = None;
        for attempt in 0..3 {
            if attempt > 0 {
                set.truncate(SMALL_VERTICES - START_VERTICES);
            }
            let dir = self.query.upper.dir;
            let start = match attempt {
                0 => first,
                1 => Some(self.find_gjk_tetrahedron(set, &-dir)?),
                _ => {
                    let apex = self.query.evaluate(set, &dir)?.pair;
                    self.find_wide_tetrahedron(set, &dir, apex)?
                }
            };
            let Some(start) = start else {
                continue;
            };
            let start = start.map(|pair| set.vertex(pair, &self.interior.v));
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

    /// Step 5. Expands a polytope from a tetrahedron in the small buffers, which stay blank if it is flat. Returns as [`expand`].
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

    /// Step 5. Continues an expansion in the large buffers and, if these become full, in those of the arena if there is one.
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

    /// Step 5. Continues an expansion in the buffers of an arena. Returns as [`EpaSolver::compute_result`].
    #[cold]
    #[inline(never)]
    fn expand_in_arena(&mut self, buffers: &mut EpaBuffers) -> Result<(Proof, Status), Stop> {
        let EpaBuffers { set, polytope } = buffers;
        let status = self.expand_in(set, polytope, false)?;
        self.compute_result(set, polytope, status.unwrap_or(Status::SupportLimit))
    }

    /// Step 5. Expands a polytope in these buffers. Returns as [`expand`].
    #[inline(always)]
    fn expand_in<const N: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        polytope: &mut EpaPolytope<F>,
        has_larger: bool,
    ) -> Result<Option<Status>, Stop> {
        let expansion = Expansion {
            query: self.query,
            predictor: &mut self.predictor,
            interior: &self.interior.v,
            limits: &self.request.limits,
            iterations: &mut self.iterations,
        };
        expand(expansion, set, polytope, has_larger)
    }

    /// Proves by GJK, from unit `dir`, that the objects overlap by more than the contact epsilon.
    ///
    /// # Errors
    /// As [`contains_origin`].
    #[cold]
    #[inline(never)]
    fn prove_overlap(&mut self, dir: &Vec3) -> Result<OverlapProof, Stop> {
        let mut known = VertexSet::<CAPACITY>::EMPTY;
        contains_origin(self.query, &mut known, None, dir, false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epa::buffers::{MAX_DEFAULT_POINTS, MAX_PROVEN_POINTS};
    use crate::math::{EPSILON, normalise_unscaled};
    use crate::minkowski::support::{Fault, SupportMap};
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
    fn run<D: Difference>(
        md: &D,
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
        global_minimum(&mut query, &first, &request, arena, &mut set, &cold)
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

    /// The face has the support point of the refined direction for a corner: the mean distance is 0.024 mm, and 0.058 mm without.
    #[test]
    fn witness_points_of_ellipsoids_are_apart_along_the_direction() {
        let mut r = Random::new(93);
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..500 {
            let radii = Vec3::from_fn(|_, _| r.within(0.1, 0.8));
            let at = r.direction() * r.within(0.05, 0.6);
            let body = ellipsoid(radii, r.rotation(), Vec3::zeros());
            let md = difference(body, ball(at, r.within(0.1, 0.6)));
            let center = center(-at);
            let settings = Settings::new(TOLERANCE.max(1e-6));
            let request = EpaRequest {
                center: Some(&center),
                ray: at.normalize(),
                limits: EpaLimits::new(&settings, 1e-3, MAX_DEFAULT_POINTS),
                wants_points: true,
            };
            let mut query = SupportQuery::new(&md, Some(&center), TOLERANCE.max(1e-6));
            let Ok(first) = query.evaluate_first(&Direction::exact(request.ray)) else {
                continue;
            };
            let mut set = VertexSet::EMPTY;
            let cold = WarmStart::COLD;
            let hit = global_minimum(&mut query, &first, &request, None, &mut set, &cold);
            if let Ok(hit) = hit {
                sum += (hit.point1 - hit.point2 - hit.dir * hit.depth).norm();
                count += 1.0;
            }
        }
        assert!(
            count > 300.0 && sum / count < TOLERANCE.max(4e-5),
            "{} {count}",
            sum / count
        );
    }
}
