// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap? The algorithm of Gilbert, Johnson and Keerthi (1988),
//! as a yes or no.
//!
//! The nearest point v of a simplex inscribed in D gives the next direction
//! n = −v/|v|. A support value n·s(n) < 0 is a plane with all of D on its far side:
//! apart, proven. A tetrahedron around the origin: overlap, proven. Departure from
//! libccd: nothing is compared with an absolute epsilon, so objects of a
//! micrometre and of a thousand kilometres are answered alike; objects that touch
//! within rounding (a few ulps of their coordinates) count as overlapping.

use crate::math::{EPSILON, Real, Vec3, unit};
use crate::portal::{self, Exit, Found, Measure, SupportPlane};
use crate::simplex::{Nearest, Simplex};
use crate::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// The yes or no of [`intersect`], with its proof.
pub enum Overlap {
    /// The simplex holds the origin (within rounding, when it is no tetrahedron).
    /// With it [`Simplex::inner_distance`], a lower bound on the depth.
    Yes(Simplex, Real),
    /// This unit direction separates: n·s(n) < 0.
    No(Vec3),
    /// The iteration cap came first.
    Undecided,
}

/// Decides whether the origin is in D, starting from any point of D: a support
/// point is one, and so is the difference of two interior points.
///
/// `known` points of D, and of each object, are used wherever they do as well as a new
/// support point: a step needs only a point of D beyond the origin, so D is asked when
/// none of them is. A search that has points all around the origin is proven without a
/// call.
///
/// `exit`: the point of the boundary where the origin leaves D, if that is known. D is
/// first asked beside it, on the side of the origin that is open: at the angle where a
/// ball of D's size falls back from the support plane by a quarter of the depth. A
/// distance algorithm asks far away, and halves its way back to a thin overlap; to a
/// deep one it does not need to.
pub fn intersect<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: SupportPoint,
    known: &[SupportPoint],
    exit: Option<&Vec3>,
    max_iterations: u64,
) -> Result<Overlap, Fault> {
    if let Some(simplex) = around(&start, known) {
        let inner = simplex.inner_distance();
        if inner > 0.0 {
            return Ok(Overlap::Yes(simplex, inner));
        }
    }
    let mut beside = exit;
    let mut near_exit = |n: &Vec3, reach: Real| {
        let w = beside.take().and_then(|exit| {
            let b = unit(exit)?;
            let side = unit(&(n - b * n.dot(&b)))?;
            let depth = exit.norm();
            let size = depth - b.dot(&start.v);
            let tilt = (0.5 * depth / size).sqrt();
            // Also NaN.
            if !(tilt <= THIN) {
                return None;
            }
            md.support(&unit(&(b + side * tilt))?).ok()
        })?;
        (n.dot(&w.v) > reach).then_some(w)
    };
    search(
        md,
        start,
        |n, reach| mixed(&start, known, n, reach).or_else(|| near_exit(n, reach)),
        max_iterations,
        |_, _| (),
    )
}

/// The tetrahedron of `start`, the first of the `known` points, and two more of them,
/// that holds the origin, if there is one and rounding does not hide it.
///
/// Seen along the line from `start` through the origin, that tetrahedron is a triangle
/// around a point, and of the triangles with the first point for a corner the widest
/// is: its other corners are the points that lie farthest round on either side.
#[inline]
fn around(start: &SupportPoint, known: &[SupportPoint]) -> Option<Simplex> {
    let (first, others) = known.split_first()?;
    let d = start.v;
    // Perpendicular to d: a point's two coordinates seen along it are its dot products
    // with `across` and, stretched by |d| |across|, with `up`.
    let across = first.v.cross(&d);
    let up = d.cross(&across);
    // The first point itself lies where `up` points.
    let (mut left, mut right): (Option<Side>, Option<Side>) = (None, None);
    for point in others {
        let x = across.dot(&point.v);
        let y = up.dot(&point.v);
        let side = if x > 0.0 { &mut left } else { &mut right };
        // Farther round from the first: y / |x| is less.
        if side.as_ref().is_none_or(|s| y * s.x.abs() < s.y * x.abs()) {
            *side = Some(Side { point, x, y });
        }
    }
    let (a, b) = (left?, right?);
    if a.y * b.x >= b.y * a.x {
        Some(Simplex::of([*start, *first, *a.point, *b.point]))
    } else {
        None
    }
}

/// A point as it is seen along the line from the start of a search through the origin.
struct Side<'a> {
    point: &'a SupportPoint,
    x: Real,
    y: Real,
}

/// [`intersect`], with `known` giving a known point of D farthest along a direction, if it
/// reaches beyond a length, and telling `seen` of each direction it asks and the support
/// point there.
pub fn search<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: SupportPoint,
    mut known: impl FnMut(&Vec3, Real) -> Option<SupportPoint>,
    max_iterations: u64,
    mut seen: impl FnMut(&Vec3, &SupportPoint),
) -> Result<Overlap, Fault> {
    let mut simplex = Simplex::new(start);
    let mut v = start.v;
    let mut size = start.magnitude();
    let mut stalls = 0;
    let mut distance = v.norm();
    // The way out through the base of a tetrahedron, on which the origin may lie.
    let mut out = None;
    for _ in 0..max_iterations {
        // Scale-free zero; also ends on NaN.
        if !(distance > ROUNDING * size) {
            return Ok(Overlap::Yes(simplex, 0.0));
        }
        if distance == Real::INFINITY {
            // Its square overflows: no direction to ask.
            return Ok(Overlap::Undecided);
        }
        let n = out.unwrap_or(-v / distance);
        let beyond = if out.is_some() { ROUNDING * size } else { 0.0 };
        let w = match known(&n, beyond) {
            Some(w) => w,
            None => {
                let w = md.support(&n)?;
                if n.dot(&w.v) < 0.0 {
                    return Ok(Overlap::No(n));
                }
                seen(&n, &w);
                w
            }
        };
        size = size.max(w.magnitude());
        simplex.push(w);
        match simplex.reduce() {
            Nearest::Inside => {
                // By more than the rounding of the corners, or in one of the two
                // tetrahedra on either side of their common base?
                let inner = simplex.inner_distance();
                if inner > 0.0 || out.is_some() {
                    return Ok(Overlap::Yes(simplex, inner));
                }
                out = simplex.out_of_base();
                if out.is_none() {
                    return near_touch(md, &n, simplex, max_iterations);
                }
            }
            Nearest::Outside(next) => {
                out = None;
                v = next;
                let nearer = v.norm();
                // Where the distance is hardly above rounding, a step that turns the
                // simplex the right way need not look nearer. NaN counts as no nearer.
                if !(nearer < distance * (1.0 - EPSILON)) {
                    stalls += 1;
                    if stalls > STALLS {
                        return near_touch(md, &n, simplex, max_iterations);
                    }
                }
                distance = nearer;
            }
        }
    }
    Ok(Overlap::Undecided)
}

/// The last word where the objects nearly touch. There v is mostly rounding error, and
/// on a curved object its direction with it; the normals of a portal's triangles are
/// not. The ray leaves from a point inside D through the origin: if the origin is in D, the
/// ray ends beyond it.
///
/// `n` is the last direction asked. The simplex may be as flat as the touching faces: the
/// middle between it and the far side of D is well inside.
fn near_touch<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    n: &Vec3,
    simplex: Simplex,
    max_iterations: u64,
) -> Result<Overlap, Fault> {
    let inner = simplex.mean().middle(&md.support(&-n)?);
    let Some(d) = unit(&-inner.v) else {
        return Ok(Overlap::Yes(simplex, 0.0));
    };
    let first = SupportPlane::of(md, d)?;
    let mut best = first;
    let mut budget = max_iterations;
    let found = portal::find_portal(md, &first, Some(&inner.v), &mut best, &mut budget)?;
    let portal = match found {
        Found::Portal(portal) => portal,
        Found::Miss(n) => return Ok(Overlap::No(n)),
        Found::Limit => return Ok(Overlap::Undecided),
        // Between the inner point and the ray's own support point.
        Found::Vertex => {
            let mut segment = Simplex::new(inner);
            segment.push(first.point);
            return Ok(Overlap::Yes(segment, 0.0));
        }
        Found::Touch => return Ok(Overlap::Yes(simplex, 0.0)),
    };
    // Any portal that has the origin on its inner side decides.
    let tolerance = Real::INFINITY;
    let exit = portal::refine(
        md,
        portal,
        tolerance,
        Measure::Normal,
        false,
        &mut best,
        &mut budget,
    )?;
    Ok(match exit {
        Exit::Miss(n) => Overlap::No(n),
        Exit::Converged(portal, _) | Exit::Limit(Some(portal)) if budget > 0 => {
            let [a, b, c] = portal.planes.map(|p| p.point);
            let simplex = Simplex::of([inner, a, b, c]);
            Overlap::Yes(simplex, simplex.inner_distance())
        }
        _ => Overlap::Undecided,
    })
}

/// The point farthest along `n`, if it reaches beyond `reach`.
#[inline]
pub fn farthest(known: &[SupportPoint], n: &Vec3, mut reach: Real) -> Option<SupportPoint> {
    let mut best = None;
    for p in known {
        let d = n.dot(&p.v);
        if d > reach {
            reach = d;
            best = Some(*p);
        }
    }
    best
}

/// The farthest along `n` of the differences of a known point of obj1 and one of obj2, if
/// it reaches beyond `reach`: with k support points of D come k² points of D.
fn mixed(
    start: &SupportPoint,
    known: &[SupportPoint],
    n: &Vec3,
    reach: Real,
) -> Option<SupportPoint> {
    let (mut v1, mut v2) = (start.v1, start.v2);
    let (mut d1, mut d2) = (n.dot(&v1), n.dot(&v2));
    for p in known {
        let (a, b) = (n.dot(&p.v1), n.dot(&p.v2));
        if a > d1 {
            (v1, d1) = (p.v1, a);
        }
        if b < d2 {
            (v2, d2) = (p.v2, b);
        }
    }
    let v = v1 - v2;
    (n.dot(&v) > reach).then_some(SupportPoint { v, v1, v2 })
}

/// The angle, radians, that tells a thin overlap by.
const THIN: Real = 0.2;

/// Distances below this many times the largest coordinate are rounding errors of
/// a difference of two points and of the nearest-point arithmetic.
const ROUNDING: Real = 4.0 * EPSILON;

/// Steps that bring the simplex no nearer before a portal has the last word.
const STALLS: u32 = 3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{self, KINDS, Random, Shape, hull, pair, scaled};

    /// Do they overlap? Also: a miss must come with a direction that separates, and
    /// swapped objects must give the same answer.
    fn overlap(a: &Shape, b: &Shape, dir: &Vec3) -> bool {
        let ask = |a: &Shape, b: &Shape, dir: Vec3| {
            let md = MinkowskiDifference::new(a, b);
            let start = md.support(&dir).unwrap();
            match intersect(&md, start, &[], None, 1000).unwrap() {
                Overlap::Yes(..) => true,
                Overlap::No(n) => {
                    assert!((n.norm() - 1.0).abs() < 8.0 * EPSILON);
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                    false
                }
                Overlap::Undecided => panic!("undecided"),
            }
        };
        let answer = ask(a, b, *dir);
        assert_eq!(answer, ask(b, a, -dir), "swapped");
        answer
    }

    /// Gaps and depths from 20 ulps to a tenth of the size: no false hit, no false miss.
    #[test]
    fn no_false_answer_down_to_a_few_ulps() {
        let mut r = Random::new(1);
        for ulps in [20.0, 100.0, 4500.0, 1e6, 1e10] {
            let gap = (ulps * EPSILON).min(0.1);
            for round in 0..200 {
                for kind in 0..KINDS {
                    for gap in [gap, -gap] {
                        let (a, b) = pair(kind, gap, &mut r);
                        assert_eq!(
                            overlap(&a, &b, &r.direction()),
                            gap < 0.0,
                            "kind {kind}, gap {gap:e}, round {round}"
                        );
                    }
                }
            }
        }
    }

    /// The same bits at every power of two from a micrometre to 1000 km and beyond.
    #[test]
    fn free_of_scale() {
        let mut r = Random::new(2);
        for _ in 0..100 {
            for kind in 0..KINDS {
                let gap = r.within(-0.1, 0.1);
                let (a, b) = pair(kind, gap, &mut r);
                let dir = r.direction();
                for exponent in [-20, 20] {
                    let scale = (2.0 as Real).powi(exponent);
                    let md = MinkowskiDifference::new(&a, &b);
                    let larger = [scaled(&a, scale), scaled(&b, scale)];
                    let other = MinkowskiDifference::new(&larger[0], &larger[1]);
                    let start = md.support(&dir).unwrap();
                    let there = other.support(&dir).unwrap();
                    let one = intersect(&md, start, &[], None, 1000).unwrap();
                    let two = intersect(&other, there, &[], None, 1000).unwrap();
                    assert_eq!(matches!(one, Overlap::Yes(..)), gap < 0.0);
                    match (one, two) {
                        (Overlap::No(n), Overlap::No(m)) => assert_eq!(n, m),
                        (Overlap::Yes(s, _), Overlap::Yes(t, _)) => {
                            assert_eq!(s.inner_distance() * scale, t.inner_distance());
                        }
                        _ => panic!("the answers differ"),
                    }
                    assert_eq!(md.supports(), other.supports());
                }
            }
        }
    }

    #[test]
    fn needles_and_plates() {
        shapes::needles_and_plates(overlap);
    }

    #[test]
    fn flat_shapes() {
        shapes::flat_shapes(overlap);
        let mut r = Random::new(5);
        for _ in 0..500 {
            // A point on itself is an overlap.
            let at = r.vector(3.0);
            assert!(overlap(&hull(&[at]), &hull(&[at]), &r.direction()));
        }
    }

    #[test]
    fn exact_touch_is_a_hit() {
        for (a, b, dir) in shapes::touching() {
            assert!(overlap(&a, &b, &dir));
        }
    }

    /// Known points of D do not change the answer, and points all around the origin are
    /// a proof by themselves.
    #[test]
    fn known_points() {
        let mut r = Random::new(6);
        for _ in 0..300 {
            for kind in 0..KINDS {
                let gap = r.within(-0.1, 0.1);
                let (a, b) = pair(kind, gap, &mut r);
                let md = MinkowskiDifference::new(&a, &b);
                let known = [0; 3].map(|_| md.support(&r.direction()).unwrap());
                let answer = intersect(&md, known[0], &known, None, 1000).unwrap();
                assert_eq!(matches!(answer, Overlap::Yes(..)), gap < 0.0);
                match answer {
                    Overlap::Yes(simplex, inner) if inner > 0.0 => {
                        let before = md.supports();
                        let points = simplex.points();
                        let again = intersect(&md, points[0], points, None, 1000);
                        assert!(matches!(again, Ok(Overlap::Yes(..))));
                        assert_eq!(md.supports(), before);
                    }
                    _ => {}
                }
            }
        }
    }
}
