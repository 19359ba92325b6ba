// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The intersection test, and the proof that D contains the origin: by a portal from an interior point
//! (G. Snethen, "XenoCollide", Game Programming Gems 7), else by GJK ([`Simplex`]).
//!
//! 1. Evaluate the first direction: most separated pairs end here.
//! 2. The interior point is the difference of the centers; without centers, a point on the segment between
//!    two opposite support points. Find a portal of its origin ray, and move the portal outwards until the
//!    origin is on its inner side ([`crate::portal`]).
//! 3. If no such portal is found (several vertices are equally far): move a simplex towards the origin until
//!    the simplex contains it.
//! 4. If the origin stays on the surface of the simplex within rounding (it is on an edge of known vertices,
//!    as in stacks of aligned boxes), the case is resolved by a portal from an interior point.
//!
//! Departures. If a known difference is beyond the origin, the direction does not separate and is not
//! evaluated. The simplex starts from the difference of the centers if it is given. Objects that touch within the contact
//! epsilon do not intersect: the origin must be inside D by more. So flat Minkowski differences (both objects
//! in one plane) do not intersect, except with `is_planar`. A point between two support points may be on the
//! surface of D, and the origin with it: then a portal proves an overlap only if D has points on the outer side of
//! each face between the portal and that point ([`has_points_around`]).
//!
//! Outputs: `Err(Stop::Separated(n))`: n is a separating axis, or the support value of n is at most the contact
//! epsilon. `Ok`: D contains the origin, or ([`OverlapProof::Undecided`]) the origin is within rounding of the surface of a
//! simplex and no evaluated direction separates. Measured (`touches` of c-tests/tests/contract): of 2 million touches 5 are
//! undecided, objects that were turned and whose D has the origin on an edge.

use crate::geometry::barycentric;
use crate::gjk::simplex::Simplex;
use crate::math::{EPSILON, Vec3, larger, lesser, normal, perpendicular, unit};
use crate::minkowski::support::{self, Difference, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportQuery};
use crate::minkowski::tolerance::TRIPLE_PRODUCT_ULPS;
use crate::minkowski::tuning::MAX_FAILURES;
use crate::minkowski::vertex_set::{Vertex, VertexSet};
use crate::portal::{Exact, FAR_UPPER_REL, MAX_STEPS, NearRay, Portal, discover};
use crate::trace;
use crate::types::Direction;

/// Capacity of the vertex set of an intersection test and of the proof of an overlap. A full set is compacted.
pub const CAPACITY: usize = 16;
/// The least distance of an interior point from the ends of its segment, relative to the segment's length. Measured: with
/// 0.05, separated pairs take 7 % more support points; with 0.5, 10 %.
const MIN_END_FRACTION: f64 = 0.25;
/// Weight of the second of two points in a point between them that is in no plane of symmetry. Insensitive: 0.4 to
/// 0.48; with 0.5, the origin is on an edge of the tetrahedron more often, and the case stays undecided; with 0.25, 6 of 15
/// million touches of turned hulls count as hits.
const GENERIC_FRACTION: f64 = 0.44;

/// The proof that D contains the origin: four points of D whose hull contains it within rounding, the last one repeated if
/// there are fewer.
#[derive(Clone, Copy, Debug)]
pub enum OverlapProof {
    /// The origin is in this simplex.
    Simplex([SupportPoint; 4]),
    /// D lies in a plane, and the origin is in this triangle or on this segment.
    Planar([SupportPoint; 4]),
    /// The origin is between this point of D, the first one, and a portal.
    Portal([SupportPoint; 4]),
    /// Nothing: the origin is on the surface of this simplex within rounding, and no evaluated direction separates.
    Undecided([SupportPoint; 4]),
}

impl OverlapProof {
    /// Returns the points.
    pub fn corners(&self) -> &[SupportPoint; 4] {
        match self {
            Self::Simplex(corners)
            | Self::Planar(corners)
            | Self::Portal(corners)
            | Self::Undecided(corners) => corners,
        }
    }

    /// Returns a point of obj1 and a point of obj2 that coincide within rounding.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let corners = self.corners().each_ref();
        let origin = barycentric::tetrahedron(&Vec3::zeros(), corners.map(|p| &p.v));
        support::witnesses(&origin.weights, corners)
    }
}

/// Returns the points of the corners of a simplex, which are known differences or the center.
fn points_of<const N: usize>(
    set: &VertexSet<N>,
    corners: &[Vertex; 4],
    center: Option<&SupportPoint>,
) -> [SupportPoint; 4] {
    corners.each_ref().map(|corner| match center {
        Some(point) if corner.pair.is_interior() => *point,
        _ => set.point(corner.pair),
    })
}

/// Tests whether the objects intersect. Starts along `first`. `center`: the difference of trusted centers.
/// Returns the direction of the upper bound, in which the next query of the pair can start.
///
/// # Errors
/// [`Stop::Separated`]; [`Stop::Fault`] for a point that is not finite.
#[inline(always)]
pub fn overlap<D: Difference>(
    md: &D,
    center: Option<&SupportPoint>,
    first: &Direction,
) -> Result<Vec3, Stop> {
    let mut query = SupportQuery::new(md, center, f64::INFINITY);
    let point = query.evaluate_first(first)?;
    overlap_after_first(&mut query, center, &point)?;
    Ok(query.upper.dir)
}

/// Continues [`overlap`] if the first direction does not separate.
#[inline(never)]
fn overlap_after_first<D: Difference>(
    query: &mut SupportQuery<'_, D>,
    center: Option<&SupportPoint>,
    first: &SupportPoint,
) -> Result<(), Stop> {
    let mut set = VertexSet::<CAPACITY>::EMPTY;
    set.push(&query.upper.dir, first);
    let inner = match query.center {
        Some(point) => point.v,
        None => {
            let dir = unit(&-first.v).unwrap_or(-query.upper.dir);
            find_interior(query, &mut set, first, &dir)?.v
        }
    };
    let is_inside = query.center.is_some();
    let is_proven = find_enclosing_portal(query, &mut set, &inner, is_inside)?.is_some();
    let is_center_in = query.center.is_some() == center.is_some();
    if is_proven && is_center_in {
        return Ok(());
    }
    let dir = query.upper.dir;
    contains_origin(query, &mut set, center, &dir, false).map(|_| ())
}

/// Proves that D contains the origin by more than the contact epsilon (undecided cases: see the head): moves a simplex
/// towards the origin until the simplex contains it, with the known vertices of the set first, and with support calls where
/// these do not suffice. `center`: the difference of trusted centers, the first corner if the query still trusts it. `dir`:
/// unit, the first search direction. `is_planar`: D lies in a plane, and a triangle or a segment that contains the origin
/// suffices. A full set is compacted: indices change.
///
/// # Errors
/// As [`overlap`].
#[inline(never)]
pub fn contains_origin<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    center: Option<&SupportPoint>,
    dir: &Vec3,
    is_planar: bool,
) -> Result<OverlapProof, Stop> {
    trace::stage("GJK");
    let center = center.filter(|_| query.center.is_some());
    const { assert!(N >= CAPACITY) };
    let mut dir = *dir;
    let mut simplex = center.map_or(Simplex::EMPTY, |point| Simplex::of_interior(&point.v));
    // The square of the least distance of the simplex from the origin; and, for a triangle, whether a point
    // on the side away from the origin is known.
    let (mut closest2, mut has_point_behind) = (f64::INFINITY, false);
    let mut stalls = 0;
    for _ in 0..MAX_STEPS {
        let mut w = set.farthest_vertex(&dir);
        let is_corner = |w: &Vertex| simplex.corners().iter().any(|c| c.pair == w.pair);
        let is_beyond = dir.dot(&w.w) > query.scale.contact_eps();
        if set.len() == 0 || !is_beyond || is_corner(&w) {
            set.make_room(simplex.slots());
            w = query.evaluate(set, &dir)?.vertex();
        }
        let contact_eps = query.scale.contact_eps();
        let eps2 = contact_eps * contact_eps;
        let was_triangle = simplex.len() == 3;
        let Some((to, distance2)) = simplex.add(w, contact_eps, query.scale.size2()) else {
            if !(closest2 > eps2 || has_point_behind || simplex.has_interior()) {
                // The origin is in the plane of the old face within rounding: evaluate the other side of D.
                set.make_room(simplex.slots());
                query.evaluate(set, &-dir)?;
            }
            let corners = simplex.tetrahedron();
            if simplex.is_certain() {
                return Ok(OverlapProof::Simplex(points_of(set, &corners, center)));
            }
            return resolve_by_portal(query, set, corners, center, &dir);
        };
        // In a plane, a triangle that has the origin inside is a proof. Its normal is that of the plane: no direction.
        if is_planar && (simplex.len() == 3 || distance2 <= eps2) {
            let [a, b, c] = simplex.corners();
            let points = points_of(set, &[a, b, c, c], center);
            return Ok(OverlapProof::Planar(points));
        }
        // Negated for NaN.
        if !(distance2 > eps2 && distance2 < closest2) {
            stalls += 1;
            if stalls > MAX_FAILURES {
                break;
            }
        }
        (closest2, has_point_behind) = (distance2, was_triangle && simplex.len() == 3);
        let Some(n) = unit(&to) else { break };
        dir = n;
    }
    let [a, b, c] = simplex.corners();
    if is_planar {
        let points = points_of(set, &[a, b, c, c], center);
        return Ok(OverlapProof::Undecided(points));
    }
    resolve_by_portal(query, set, [a, b, c, c], center, &dir)
}

/// Returns a point of D, in its interior or on its surface: on the segment from `from` to the support point along
/// unit `dir`, as close to the origin as [`MIN_END_FRACTION`] allows. Evaluates `dir`, and the direction from the
/// point to the origin.
#[inline(never)]
fn find_interior<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    from: &SupportPoint,
    dir: &Vec3,
) -> Result<SupportPoint, Stop> {
    trace::stage("interior point");
    let far = query.evaluate(set, dir)?;
    let far = set.point(far.pair);
    let closest = barycentric::segment(&Vec3::zeros(), &from.v, &far.v).weights[1];
    let max = 1.0 - MIN_END_FRACTION;
    let t = lesser(larger(closest, MIN_END_FRACTION), max);
    let mut inner = from.towards(&far, t);
    if !(inner.v.norm() > query.scale.contact_eps()) {
        inner = inner.towards(&far, 0.5);
    }
    if let Some(ray) = unit(&-inner.v) {
        query.evaluate(set, &ray)?;
    }
    Ok(inner)
}

/// Returns a portal of the ray from a point of D, `inner`, through the origin that has the origin on its inner
/// side; `None` if none is found. `is_inside`: the point is in the interior of D; otherwise it may be on the surface.
#[inline(always)]
fn find_enclosing_portal<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    inner: &Vec3,
    is_inside: bool,
) -> Result<Option<Portal>, Stop> {
    trace::stage("enclosing portal");
    let distance = inner.norm();
    if !(distance > query.scale.contact_eps()) {
        return Ok(None);
    }
    let ray = -inner / distance;
    let length = distance + query.upper.depth;
    let gap = query.scale.contact_eps();
    let slope = (2.0 * gap / length).sqrt();
    let ring = NearRay::Ring { axis: &ray, slope };
    let near2 = 0.5 * gap * length;
    let Some(mut portal) = discover(
        query,
        set,
        &ray,
        length,
        FAR_UPPER_REL * length,
        near2,
        ring,
    )?
    else {
        return Ok(None);
    };
    // Each step replaces a corner by a point beyond the origin, or finds no point above the portal. No `Portal::climb`: a known
    // difference that is above the portal, but not beyond the origin, is not taken, because a support call may separate.
    for _ in 0..MAX_STEPS {
        let [a, b, d] = &portal.points();
        let n = normal(a, b, d);
        let length = n.norm();
        let contact_eps = query.scale.contact_eps() * length;
        let offset = n.dot(a);
        // The normal of a sliver is mostly rounding error.
        let edge2 = larger((b - a).norm_squared(), (d - a).norm_squared());
        let error = TRIPLE_PRODUCT_ULPS * EPSILON * query.scale.size() * edge2;
        if offset > larger(contact_eps, error) {
            let is_enclosing = n.dot(inner) < 0.0
                && portal.is_crossed(&ray, query.scale.height_eps())
                && (is_inside || has_points_around(query, set, &mut portal, inner)?);
            return Ok(is_enclosing.then_some(portal));
        }
        let mut w = set.farthest_vertex(&n);
        if !(n.dot(&w.w) > contact_eps) {
            if !(length > 0.0) {
                return Ok(None);
            }
            set.make_room(&mut portal.corners);
            w = query.evaluate(set, &(n / length))?.vertex();
        }
        if !(n.dot(&w.w) - offset > query.scale.height_eps() * length) {
            return Ok(None);
        }
        portal.replace_corner(&ray, w, Exact::Nothing);
    }
    Ok(None)
}

/// Returns whether D extends beyond the faces between a portal and `inner`, so that an origin on one of them is
/// inside D. Evaluates the normal of that face if no known difference is beyond it. Returns `false` if the origin is on
/// two faces, that is, on an edge.
///
/// # Errors
/// [`Stop::Separated`]: the normal separates; [`Stop::Fault`].
fn has_points_around<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    portal: &mut Portal,
    inner: &Vec3,
) -> Result<bool, Stop> {
    let [a, b, c] = portal.points();
    let mut is_on_face = false;
    for (p, q) in [(a, b), (b, c), (c, a)] {
        let outward = normal(inner, &q, &p);
        let eps = query.scale.contact_eps() * outward.norm();
        if outward.dot(inner) > eps {
            continue;
        }
        if core::mem::replace(&mut is_on_face, true) {
            return Ok(false);
        }
        if !(outward.dot(&set.farthest_vertex(&outward).w) > eps) {
            let Some(n) = unit(&outward) else {
                return Ok(false);
            };
            set.make_room(&mut portal.corners);
            query.evaluate(set, &n)?;
        }
    }
    Ok(true)
}

/// Resolves the case of an origin on the surface of a simplex within rounding, by a portal from a point
/// between the simplex and the opposite side of D: that point is well inside D however flat the simplex is.
/// [`OverlapProof::Undecided`], with the simplex, if no portal is found: D is not flat then.
#[cold]
#[inline(never)]
fn resolve_by_portal<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    mut corners: [Vertex; 4],
    center: Option<&SupportPoint>,
    dir: &Vec3,
) -> Result<OverlapProof, Stop> {
    set.compact(&mut corners);
    let simplex = points_of(set, &corners, center);
    let [a, b, c, d] = &simplex;
    let t = GENERIC_FRACTION;
    let middle = a.towards(b, t).towards(&c.towards(d, t), t);
    let inner = find_interior(query, set, &middle, &-dir)?;
    let Some(portal) = find_enclosing_portal(query, set, &inner.v, false)? else {
        evaluate_normals_of_flat(query, set, &inner.v)?;
        return Ok(OverlapProof::Undecided(simplex));
    };
    let [a, b, c] = portal.corners.map(|corner| set.point(corner.pair));
    Ok(OverlapProof::Portal([inner, a, b, c]))
}

/// Evaluates directions of which one separates if D is flat: one perpendicular to `inner`, a point of D, and both
/// normals of the plane through the origin, `inner` and the first one's support point.
fn evaluate_normals_of_flat<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    inner: &Vec3,
) -> Result<(), Stop> {
    let Some(inner) = unit(inner) else {
        return Ok(());
    };
    set.make_room(&mut []);
    let w = query.evaluate(set, &perpendicular(&inner))?.w;
    if let Some(n) = unit(&inner.cross(&w)) {
        for n in [n, -n] {
            set.make_room(&mut []);
            query.evaluate(set, &n)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::test_shapes::{Random, ball, corners, difference, hull, placed};

    fn test_cold<D: Difference>(md: &D, first: &Vec3) -> Result<Vec3, Stop> {
        overlap(md, None, &Direction::exact(*first))
    }

    /// Tests that the corners of the portal and the interior point enclose the origin.
    #[test]
    fn portal_and_interior_point_enclose_the_origin() {
        let mut r = Random::new(43);
        let mut found = 0;
        for _ in 0..200 {
            let half = Vec3::new(0.5, 0.4, 0.3);
            let turned = placed(&corners(half), &r.rotation(), r.vector(0.2));
            let md = difference(hull(&corners(half)), hull(&turned));
            let mut query = SupportQuery::new(&md, None, 0.0);
            let n = r.direction();
            let point = query.evaluate_first(&Direction::exact(n)).unwrap();
            let mut set = VertexSet::<16>::EMPTY;
            set.push(&n, &point);
            let corners = [set.farthest_vertex(&n); 4];
            let resolved = resolve_by_portal(&mut query, &mut set, corners, None, &n).unwrap();
            if let OverlapProof::Portal(_) = resolved {
                found += 1;
                let (p, q) = resolved.witnesses();
                assert!((p - q).norm() <= 64.0 * EPSILON);
            }
        }
        assert!(found > 190, "{found}");
    }

    /// Tests two frusta as thin as plates, 9e-12 apart at their rims. The corners of the first portal are nearly on
    /// a line with the origin: the rounding of its normal is larger than the gap.
    #[test]
    #[cfg(not(feature = "single"))]
    fn sliver_portal_does_not_enclose_the_origin() {
        // The radius and the height of either rim in the body's frame, and its rows.
        let frustum =
            |rims: [[f64; 2]; 2], rows: [f64; 9], at: Vec3| -> crate::test_shapes::Shape {
                let turn = nalgebra::Matrix3::from_row_slice(&rows);
                Box::new(move |d: &Vec3| {
                    let d = turn.transpose() * d;
                    let across = d.x.hypot(d.y);
                    let [p, q] =
                        rims.map(|[r, z]| Vec3::new(d.x / across * r, d.y / across * r, z));
                    at + turn * if p.dot(&d) > q.dot(&d) { p } else { q }
                })
            };
        let a = frustum(
            [
                [0.8786275032787598, -0.0002843202673790413],
                [0.25913346074803956, 0.0002843202673790413],
            ],
            [
                0.21294100782267,
                0.5637376790653463,
                -0.7980325534647583,
                -0.18332622349287447,
                -0.7792068774623,
                -0.5993564364343585,
                -0.9597122605069222,
                0.27392785787040597,
                -0.06257719804548989,
            ],
            Vec3::zeros(),
        );
        let at = Vec3::new(
            0.00681956379421302,
            -0.0034717682415307356,
            0.007940031448006585,
        );
        let b = frustum(
            [
                [0.11542272341614525, -0.003573951899109629],
                [0.33073523968066637, 0.003573951899109629],
            ],
            [
                0.2129410078256695,
                0.563737679075183,
                -0.7980325534570093,
                -0.18332622354359618,
                -0.7792068774397919,
                -0.5993564364481063,
                -0.9597122604965677,
                0.27392785791418817,
                -0.06257719801263713,
            ],
            at,
        );
        let md = difference(a, b);
        let c = SupportPoint {
            v: -at,
            v1: Vec3::zeros(),
            v2: at,
        };
        let first = at.normalize();
        let found = overlap(&md, Some(&c), &Direction::exact(first));
        assert!(matches!(found, Err(Stop::Separated(_))), "{found:?}");
    }

    /// Returns two equal, randomly rotated boxes, one above the other, offset sideways, with this gap (negative:
    /// the depth).
    fn cubes(gap: f64, r: &mut Random) -> [Vec<Vec3>; 2] {
        let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
        let turn = r.rotation();
        let offset = Vec3::new(
            r.within(-0.5, 0.5) * half.x,
            r.within(-0.5, 0.5) * half.y,
            2.0 * half.z + gap,
        );
        [Vec3::zeros(), turn * offset].map(|at| placed(&corners(half), &turn, at))
    }

    /// Tests that the results are the same bits at scales that are powers of two, that a miss has a separating
    /// axis, and that swapped objects give the same result.
    #[test]
    fn result_is_independent_of_scale_and_order() {
        let mut r = Random::new(2);
        for _ in 0..1000 {
            let gap = r.within(-0.1, 0.1);
            let [a, b] = cubes(gap, &mut r);
            let dir = r.direction();
            let md = difference(hull(&a), hull(&b));
            let one = test_cold(&md, &dir);
            assert_eq!(one.is_ok(), gap < 0.0, "{gap}");
            if let Err(Stop::Separated(Direction { n, .. })) = one {
                assert!((n.norm() - 1.0).abs() < 8.0 * EPSILON);
                assert!(n.dot(&md.support(&n).unwrap().v) <= 0.0);
            }
            let swapped = difference(hull(&b), hull(&a));
            assert_eq!(test_cold(&swapped, &-dir).is_ok(), one.is_ok());
            assert!(swapped.supports() < 100, "{}", swapped.supports());
            for exponent in [-20, 20] {
                let scale = (2.0 as f64).powi(exponent);
                let [a, b] = [&a, &b].map(|of| of.iter().map(|p| p * scale).collect::<Vec<_>>());
                let other = difference(hull(&a), hull(&b));
                assert_eq!(one, test_cold(&other, &dir));
            }
        }
    }

    /// Tests that known vertices do not change the result, that no call is made if they enclose the origin, and
    /// that the witness points coincide.
    #[test]
    fn known_vertices_prove_an_intersection() {
        let mut r = Random::new(6);
        let mut without = 0;
        for round in 0..3000 {
            let gap = r.within(-0.1, 0.1);
            let [a, b] = cubes(gap, &mut r);
            let md = difference(hull(&a), hull(&b));
            let mut query = SupportQuery::new(&md, None, 0.0);
            let mut set = VertexSet::<16>::EMPTY;
            for _ in 0..round % 17 {
                let n = r.direction();
                let point = query.evaluate_point(&n).unwrap();
                set.push(&n, &point);
            }
            let dir = r.direction();
            let mut before = 0;
            for again in [false, true] {
                before = if again { md.supports() } else { before };
                let found = contains_origin(&mut query, &mut set, None, &dir, false);
                assert_eq!(found.is_ok(), gap < 0.0, "gap {gap}");
                if let Ok(found) = found {
                    let (p, q) = found.witnesses();
                    assert!((p - q).norm() <= 1e3 * EPSILON, "{}", (p - q).norm());
                }
            }
            without += u32::from(gap < 0.0 && md.supports() == before);
        }
        assert!(without > 1000, "{without}");
    }

    /// Tests that the results with trusted centers are the same, also for gaps and depths of a few ulps.
    #[test]
    fn centers_do_not_change_the_result() {
        let mut r = Random::new(7);
        for ulps in [100.0, 1e6, 1e13] {
            for _ in 0..300 {
                let size = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
                let turn = r.rotation();
                let cube = placed(&corners(size), &turn, Vec3::zeros());
                let mut gap = (ulps * EPSILON).min(0.2) * r.within(0.5, 1.0);
                gap *= if r.within(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
                let up = turn * Vec3::z();
                let center = |at: Vec3| SupportPoint {
                    v: -at,
                    v1: Vec3::zeros(),
                    v2: at,
                };
                // Boxes exactly above each other, and offset sideways; below: balls.
                let offset = turn * Vec3::x() * (0.3 * size.x);
                for by in [Vec3::zeros(), offset] {
                    let at = up * (2.0 * size.z + gap) + by;
                    let other: Vec<_> = cube.iter().map(|p| p + at).collect();
                    let md = difference(hull(&cube), hull(&other));
                    let found = overlap(&md, Some(&center(at)), &Direction::exact(at.normalize()));
                    assert_eq!(found.is_ok(), gap < 0.0, "{gap}");
                    assert!(md.supports() < 100, "{}", md.supports());
                }
                let at = up * (1.5 + gap);
                let md = difference(ball(Vec3::zeros(), 1.0), ball(at, 0.5));
                let found = overlap(&md, Some(&center(at)), &Direction::exact(up));
                assert_eq!(found.is_ok(), gap < 0.0, "{gap}");
            }
        }
        // Concentric balls.
        let md = difference(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.5));
        let found = overlap(
            &md,
            Some(&SupportPoint::default()),
            &Direction::exact(Vec3::x()),
        );
        assert!(found.is_ok());
    }

    /// Tests that a center whose use the query has given up does not change the result.
    #[test]
    fn center_outside_is_not_used() {
        let mut r = Random::new(8);
        for _ in 0..500 {
            let gap = r.within(0.02, 0.3);
            let [a, b] = cubes(gap, &mut r);
            let v1 = r.vector(0.3);
            let center = SupportPoint {
                v: v1,
                v1,
                v2: Vec3::zeros(),
            };
            let md = difference(hull(&a), hull(&b));
            let mut query = SupportQuery::new(&md, Some(&center), 0.0);
            query.center = None;
            let mut set = VertexSet::<16>::EMPTY;
            let found = contains_origin(&mut query, &mut set, Some(&center), &r.direction(), false);
            assert!(matches!(found, Err(Stop::Separated(_))));
        }
    }
}
