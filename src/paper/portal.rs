// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where does the origin ray leave D? (Paper, Sec. II-C, Algorithm 1.)
//!
//! A *portal* is a triangle of support points v1, v2, v3 of D that the ray
//! {t d, t ≥ 0} crosses: d lies in the cone of the three. With
//! T(a, b) = d · (a × b) that is T(1,2), T(2,3), T(3,1) ≥ 0, and the triangle's
//! normal N = v1×v2 + v2×v3 + v3×v1 then has N · d = T(1,2) + T(2,3) + T(3,1) ≥ 0:
//! it points outwards along the ray. The ray meets the triangle at
//! |p| = (n · v1) / (n · d), a lower bound on how far D reaches along d, because the
//! triangle is inscribed; and the support plane of n meets the ray at
//! |q| = (n · s(n)) / (n · d), an upper bound. The new point s(n) splits the cone in
//! three; the part that holds d is the next portal.
//!
//! Departures from the published implementation: the direction returned is the
//! normal of the support plane, whose support value is a sound depth, not the ray;
//! tests are signs of triple products, none has an absolute epsilon; a support
//! plane that excludes the origin ends the search with a proof that the objects
//! are apart, wherever it is met; the best support plane seen is kept.

use crate::known::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{self, EPSILON, Real, Vec3, larger, largest, unit};

/// A support plane of D: unit normal, support point, support value.
#[derive(Clone, Copy, Debug)]
pub struct SupportPlane {
    /// Unit normal n.
    pub normal: Vec3,
    /// The support point s(n).
    pub point: SupportPoint,
    /// h(n) = n · s(n), a sound depth along n when it is not negative.
    pub depth: Real,
}

impl SupportPlane {
    /// Evaluates the support plane of the unit direction `normal`.
    #[inline]
    pub fn of<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        normal: Vec3,
    ) -> Result<Self, Fault> {
        let point = md.support(&normal)?;
        let depth = normal.dot(&point.v);
        Ok(Self {
            normal,
            point,
            depth,
        })
    }
}

/// Three support points whose triangle the ray along `ray` crosses.
#[derive(Clone, Copy)]
pub struct Portal {
    /// Unit direction of the origin ray.
    pub ray: Vec3,
    /// The support planes of v1, v2, v3, ordered so that the triangle's normal looks
    /// along the ray.
    pub planes: [SupportPlane; 3],
}

impl Portal {
    /// Outward unit normal of the triangle; `None` when it has no area.
    #[inline]
    pub fn normal(&self) -> Option<Vec3> {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point.v);
        unit(&math::normal(a, b, c))
    }

    /// The portal of three support planes, if the ray crosses their triangle from
    /// the origin's side, in either order of the vertices.
    pub fn of(ray: Vec3, planes: [SupportPlane; 3]) -> Option<Self> {
        let [a, b, c] = planes.map(|p| p.point.v);
        let t = [
            triple(&ray, &a, &b),
            triple(&ray, &b, &c),
            triple(&ray, &c, &a),
        ];
        if t.iter().all(|&t| t > 0.0) {
            Some(Self { ray, planes })
        } else if t.iter().all(|&t| t < 0.0) {
            let [a, b, c] = planes;
            Some(Self {
                ray,
                planes: [a, c, b],
            })
        } else {
            None
        }
    }

    /// Replaces one vertex by the point of `w`, beyond the triangle, so that the ray
    /// still crosses (paper, Algorithm 1, update_portal).
    #[inline]
    pub fn update(&mut self, w: SupportPlane) {
        let c = self.ray.cross(&w.point.v);
        // On which side of the plane through the ray and w each vertex is. With w the ray
        // crosses the triangle of two vertices on opposite sides, so w takes the place of the
        // third. The side of a vertex on that plane is rounding: the pair that is farthest on
        // its two sides counts.
        let [t1, t2, t3] = self.planes.each_ref().map(|p| c.dot(&p.point.v));
        let split = [t2.min(-t3), t3.min(-t1), t1.min(-t2)];
        let mut replaced = 2;
        for i in 0..2 {
            if split[i] > split[replaced] {
                replaced = i;
            }
        }
        self.planes[replaced] = w;
    }

    /// Where along the ray the triangle is: |p|, negative behind the origin. A mean of
    /// the vertices with weights T, which rounding does not move out of the triangle.
    pub fn reach(&self) -> Real {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point.v);
        let t = [
            triple(&self.ray, b, c),
            triple(&self.ray, c, a),
            triple(&self.ray, a, b),
        ];
        let along = t[0] * self.ray.dot(a) + t[1] * self.ray.dot(b) + t[2] * self.ray.dot(c);
        along / (t[0] + t[1] + t[2])
    }

    /// The points of obj1 and obj2 whose difference is where the ray crosses the
    /// triangle: both are convex combinations of the objects' own support points.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point);
        let weights = [
            triple(&self.ray, &b.v, &c.v),
            triple(&self.ray, &c.v, &a.v),
            triple(&self.ray, &a.v, &b.v),
        ]
        .map(|t| t.max(0.0));
        let sum: Real = weights.iter().sum();
        if !(sum > 0.0) {
            return (a.v1, a.v2);
        }
        let mut p1 = Vec3::zeros();
        let mut p2 = Vec3::zeros();
        for (p, t) in [a, b, c].into_iter().zip(weights) {
            p1 += p.v1 * (t / sum);
            p2 += p.v2 * (t / sum);
        }
        (p1, p2)
    }
}

#[inline]
fn triple(a: &Vec3, b: &Vec3, c: &Vec3) -> Real {
    a.dot(&b.cross(c))
}

/// Rounding of a support point of this size: below it a depth is zero, a gap a touch.
#[inline]
pub fn rounding(size: Real) -> Real {
    8.0 * EPSILON * size
}

/// What portal discovery came to.
pub enum Found {
    /// A portal.
    Portal(Portal),
    /// The ray passes through its own support point: it leaves D there, and its
    /// direction is the normal of a support plane there (stationary).
    Vertex,
    /// `best` has depth zero within rounding: no direction is shallower.
    Touch,
    /// This plane separates.
    Miss(SupportPlane),
    /// The iterations were used up.
    Limit,
}

/// Portal discovery (paper, Algorithm 1, find_portal; G. Snethen, "XenoCollide",
/// Game Programming Gems 7), for the ray along `first.normal`.
///
/// `behind` is the original algorithm's interior point, where one is known: a point of D
/// on the line of the ray, behind the origin. Else `v0 = -d`, scaled to the portal's size,
/// stands in for it.
/// `budget` counts iterations down; `best` keeps the lowest plane seen.
pub fn find_portal<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    first: &SupportPlane,
    behind: Option<&Vec3>,
    best: &mut SupportPlane,
    budget: &mut u64,
) -> Result<Found, Fault> {
    let d = first.normal;
    if first.depth < 0.0 {
        return Ok(Found::Miss(*first));
    }
    let size = first.point.magnitude();
    let side = first.point.v.cross(&d);
    // Also true for NaN: a ray whose own support point cannot be told from it.
    if !(side.norm() > rounding(size)) {
        return Ok(Found::Vertex);
    }
    let Some(side) = unit(&side) else {
        return Ok(Found::Vertex);
    };
    let second = match probe(md, side, best)? {
        Probe::Plane(p) => p,
        Probe::Miss(plane) => return Ok(Found::Miss(plane)),
    };
    if !(second.depth > rounding(size.max(second.point.magnitude()))) {
        return Ok(Found::Touch);
    }
    // T(v2, v1) = side · v2 · |v1 × d| > 0: with the two in this order a third
    // point beyond the plane (v0, v1, v2) closes the cone.
    let mut portal = Portal {
        ray: d,
        planes: [second, *first, *first],
    };
    while *budget > 0 {
        *budget -= 1;
        let [a, b, _] = portal.planes.each_ref().map(|p| p.point.v);
        let v0 = match behind {
            Some(inner) => *inner,
            None => -d * larger(largest(&a), largest(&b)),
        };
        let Some(n) = unit(&(a - v0).cross(&(b - v0))) else {
            return Ok(Found::Touch);
        };
        let third = match probe(md, n, best)? {
            Probe::Plane(p) => p,
            Probe::Miss(plane) => return Ok(Found::Miss(plane)),
        };
        let w = third.point.v;
        if triple(&d, &a, &w) > 0.0 {
            portal.planes[1] = third;
        } else if triple(&d, &w, &b) > 0.0 {
            portal.planes[0] = third;
        } else {
            portal.planes[2] = third;
            return Ok(Found::Portal(portal));
        }
    }
    Ok(Found::Limit)
}

enum Probe {
    Plane(SupportPlane),
    Miss(SupportPlane),
}

#[inline]
fn probe<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    n: Vec3,
    best: &mut SupportPlane,
) -> Result<Probe, Fault> {
    let plane = SupportPlane::of(md, n)?;
    if plane.depth < 0.0 {
        return Ok(Probe::Miss(plane));
    }
    if plane.depth < best.depth {
        *best = plane;
    }
    Ok(Probe::Plane(plane))
}

/// Where [`mpr`] stopped.
pub enum Exit {
    /// The ray leaves D between the portal and this support plane, which are no
    /// farther apart than the tolerance.
    Converged(Portal, SupportPlane),
    /// Algorithm 5's shortcut: the support value of this plane is no greater than
    /// the distance |p| to the portal along the ray.
    Shortcut(SupportPlane),
    /// See [`Found`].
    Vertex,
    /// See [`Found`].
    Touch,
    /// See [`Found`].
    Miss(SupportPlane),
    /// The iterations were used up; the last portal if there was one.
    Limit(Option<Portal>),
}

/// How the distance between portal and support plane is measured.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Along the normal (Algorithm 1).
    Normal,
    /// Along the ray (directed penetration).
    Ray,
}

/// Follows the origin ray along `first.normal` to the boundary of D: Algorithm 1,
/// and with `shortcut` Algorithm 5 of the paper.
pub fn mpr<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    first: &SupportPlane,
    tolerance: Real,
    shortcut: bool,
    best: &mut SupportPlane,
    budget: &mut u64,
) -> Result<Exit, Fault> {
    match find_portal(md, first, None, best, budget)? {
        Found::Portal(p) => refine(md, p, tolerance, Measure::Normal, shortcut, best, budget),
        Found::Vertex => Ok(Exit::Vertex),
        Found::Touch => Ok(Exit::Touch),
        Found::Miss(plane) => Ok(Exit::Miss(plane)),
        Found::Limit => Ok(Exit::Limit(None)),
    }
}

/// Portal refinement: the loop of Algorithms 1 and 5, from a portal on.
pub fn refine<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    mut portal: Portal,
    tolerance: Real,
    measure: Measure,
    shortcut: bool,
    best: &mut SupportPlane,
    budget: &mut u64,
) -> Result<Exit, Fault> {
    while *budget > 0 {
        *budget -= 1;
        // Three points on a line, or so near that rounding turns their triangle over:
        // the arithmetic cannot split it further.
        let Some(n) = portal.normal().filter(|n| n.dot(&portal.ray) > 0.0) else {
            return Ok(Exit::Limit(Some(portal)));
        };
        let along = n.dot(&portal.ray);
        let inner = n.dot(&portal.planes[0].point.v);
        let size = (portal.planes.iter()).fold(0.0, |m, p| larger(m, p.point.magnitude()));
        let floor = rounding(size);
        let plane = match probe(md, n, best)? {
            Probe::Plane(p) => p,
            // D holds the portal: a callback that answers less than it is wrong.
            Probe::Miss(_) if inner > floor => {
                let plane = SupportPlane {
                    normal: n,
                    point: portal.planes[0].point,
                    depth: inner,
                };
                return Ok(Exit::Converged(portal, plane));
            }
            Probe::Miss(plane) => return Ok(Exit::Miss(plane)),
        };
        let mut gap = plane.depth - inner;
        let mut least = floor;
        if measure == Measure::Ray {
            gap /= along;
            least /= along;
        }
        // Within the tolerance and the origin on the inner side of the portal beyond
        // doubt: a support plane that may still exclude the origin is no answer yet.
        // NaN (a plane that holds the ray) ends the loop.
        if !(gap > least) || (gap <= tolerance && inner > floor) {
            return Ok(Exit::Converged(portal, plane));
        }
        if shortcut && plane.depth * along <= inner {
            return Ok(Exit::Shortcut(plane));
        }
        portal.update(plane);
    }
    Ok(Exit::Limit(Some(portal)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, Rotation, corners, ellipsoid, hull, placed};

    const ULPS: Real = 100.0 * EPSILON;

    /// D itself, as the difference to a point.
    fn alone<A: SupportMap>(d: A) -> MinkowskiDifference<A, fn(&Vec3) -> Vec3> {
        MinkowskiDifference::new(d, |_| Vec3::zeros())
    }

    /// The three products T of a portal; none is negative by more than rounding.
    fn crosses(p: &Portal) -> bool {
        let [a, b, c] = p.planes.each_ref().map(|x| &x.point.v);
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(x, y)| triple(&p.ray, x, y) >= -ULPS)
    }

    /// Where the ray crosses the plane of the portal, and where the support plane.
    fn reaches(p: &Portal, plane: &SupportPlane) -> (Real, Real) {
        let along = plane.normal.dot(&p.ray);
        (
            plane.normal.dot(&p.planes[0].point.v) / along,
            plane.depth / along,
        )
    }

    /// Algorithm 1 for the ray `d`: the exit, with its invariants checked against the
    /// distance `exact` at which the ray leaves D.
    fn check<A: SupportMap>(support: A, d: Vec3, exact: Real, tolerance: Real) {
        let md = alone(support);
        let first = SupportPlane::of(&md, d).unwrap();
        let mut best = first;
        let mut budget = 1000;
        match find_portal(&md, &first, None, &mut best, &mut budget).unwrap() {
            Found::Portal(found) => {
                assert!(crosses(&found));
                // Each vertex is the support point of its own plane.
                for p in &found.planes {
                    assert_eq!(md.support(&p.normal).unwrap(), p.point);
                }
                // By hand: every update keeps the ray inside, and the portal only
                // moves on along it (it may begin behind the origin).
                let mut portal = found;
                let mut before = Real::NEG_INFINITY;
                for _ in 0..8 {
                    let Some(n) = portal.normal() else { break };
                    let plane = SupportPlane::of(&md, n).unwrap();
                    let (p, q) = reaches(&portal, &plane);
                    assert!(p <= exact + ULPS && q >= exact - ULPS, "{p} {exact} {q}");
                    assert!(p >= before - ULPS);
                    before = p;
                    if q - p <= ULPS {
                        break;
                    }
                    portal.update(plane);
                    assert!(crosses(&portal));
                }
                let exit = refine(
                    &md,
                    found,
                    tolerance,
                    Measure::Ray,
                    false,
                    &mut best,
                    &mut budget,
                );
                let Ok(Exit::Converged(portal, plane)) = exit else {
                    panic!("no exit");
                };
                let (p, q) = reaches(&portal, &plane);
                assert!(p <= exact + ULPS && exact <= q + ULPS && q - p <= tolerance + ULPS);
                // The witnesses: on the ray, at the portal.
                let (w1, w2) = portal.witnesses();
                assert!((w1 - w2 - d * p).norm() <= 10.0 * ULPS);
            }
            Found::Vertex => assert!((first.depth - exact).abs() <= ULPS),
            _ => panic!("no portal"),
        }
    }

    #[test]
    fn algorithm_1_on_an_ellipsoid() {
        let mut r = Random::new(1);
        for _ in 0..500 {
            let radii = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
            let d = r.direction();
            let exact = 1.0 / d.component_div(&radii).norm();
            let support = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
            check(support, d, exact, 1e-6);
        }
    }

    #[test]
    fn algorithm_1_on_a_box() {
        let mut r = Random::new(2);
        for round in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
            let turn = r.rotation();
            let at = half.map(|h| r.within(-0.9, 0.9) * h);
            // Off the centre; every tenth ray along an axis, through the middle of a face.
            let (at, d) = match round % 10 {
                0 => (Vec3::zeros(), Vec3::ith(round / 10 % 3, 1.0)),
                _ => (at, r.direction()),
            };
            // Slabs: the nearest of the three planes ahead.
            let exact = (0..3).fold(Real::INFINITY, |t, i| {
                t.min((half[i].copysign(d[i]) + at[i]) / d[i]).max(0.0)
            });
            let points = placed(&corners(half), &turn, turn * at);
            check(hull(&points), turn * d, exact, 1e-6);
        }
    }

    /// The origin outside: every search ends with a direction that separates, or has the
    /// ray pass D by (no portal on this side).
    #[test]
    fn outside_is_found_out() {
        let mut r = Random::new(3);
        for _ in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let way = r.direction();
            let points = placed(&corners(half), &r.rotation(), way * 3.0);
            let md = alone(hull(&points));
            // From the centre through the origin, as from the centres of two objects.
            let first = SupportPlane::of(&md, -way).unwrap();
            let mut best = first;
            let mut budget = 1000;
            match mpr(&md, &first, 1e-6, false, &mut best, &mut budget).unwrap() {
                Exit::Miss(plane) => {
                    let n = plane.normal;
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                _ => panic!("the origin is outside"),
            }
        }
    }

    /// A budget that is too small is told, and none is exceeded.
    #[test]
    fn budget() {
        let mut r = Random::new(4);
        for given in 0..20 {
            let radii = Vec3::new(1.0, 0.7, 0.5);
            let md = alone(ellipsoid(radii, r.rotation(), Vec3::zeros()));
            let first = SupportPlane::of(&md, r.direction()).unwrap();
            let mut best = first;
            let mut budget = given;
            let exit = mpr(&md, &first, 0.0, false, &mut best, &mut budget).unwrap();
            assert!(matches!(exit, Exit::Limit(_)));
            assert_eq!(budget, 0);
            assert!(md.supports() <= given + 2);
            assert!(best.depth <= first.depth);
        }
    }
}
