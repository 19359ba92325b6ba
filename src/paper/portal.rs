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

//!
//! **In a plane** (n = 2, Sec. II-A), for shapes that lie in one with unit normal m, the portal is a
//! segment from v1 to v2 with the ray between them. It is kept as the triangle v1, v2, v2 + m: that
//! has the segment's normal in the plane, and the ray crosses it on the segment.

use crate::gjk::barycentric;
use crate::known::support_set::Stop;
use crate::math::{self, EPSILON, Vec3, larger, largest, unit};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// A support plane of D: unit normal, support point, support value.
#[derive(Clone, Copy, Debug)]
pub struct SupportPlane {
    /// Unit normal n.
    pub normal: Vec3,
    /// The support point s(n).
    pub point: SupportPoint,
    /// h(n) = n · s(n), a sound depth along n when it is not negative.
    pub depth: f64,
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

    /// The weights of the vertices where the ray crosses, times six volumes.
    fn weights(&self) -> [f64; 3] {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point.v);
        [
            triple(&self.ray, b, c),
            triple(&self.ray, c, a),
            triple(&self.ray, a, b),
        ]
    }

    /// The portal of three support planes, if the ray crosses their triangle from
    /// the origin's side, in either order of the vertices.
    pub fn of(ray: Vec3, planes: [SupportPlane; 3]) -> Option<Self> {
        let [a, b, c] = planes;
        let orders = [planes, [a, c, b]].map(|planes| Self { ray, planes });
        let crossed = |portal: &Self| portal.weights().iter().all(|t| *t > 0.0);
        orders.into_iter().find(crossed)
    }

    /// The portal in the plane with normal m, from one side of the ray to the other.
    fn segment(ray: Vec3, left: SupportPlane, right: SupportPlane, m: &Vec3) -> Self {
        let mut beside = right;
        beside.point.v += m;
        beside.point.v1 += m;
        Self {
            ray,
            planes: [left, right, beside],
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
    pub fn reach(&self) -> f64 {
        let t = self.weights();
        let at = self.planes.each_ref().map(|p| self.ray.dot(&p.point.v));
        (t[0] * at[0] + t[1] * at[1] + t[2] * at[2]) / (t[0] + t[1] + t[2])
    }

    /// The points of obj1 and obj2 whose difference is where the ray crosses the
    /// triangle: both are convex combinations of the objects' own support points.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let points = self.planes.each_ref().map(|p| &p.point);
        let weights = self.weights().map(|t| t.max(0.0));
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0) {
            return (points[0].v1, points[0].v2);
        }
        barycentric::witnesses(&weights.map(|t| t / sum), points)
    }
}

#[inline]
fn triple(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    a.dot(&b.cross(c))
}

/// Rounding of a support point of this size: below it a depth is zero, a gap a touch.
#[inline]
pub fn rounding(size: f64) -> f64 {
    8.0 * EPSILON * size
}

/// Where a ray's search stopped.
pub enum Exit {
    /// The ray leaves D between the portal and this support plane, which are no
    /// farther apart than the tolerance.
    Converged(Portal, SupportPlane),
    /// Algorithm 5's shortcut: the support value of this plane is no greater than
    /// the distance |p| to the portal along the ray.
    Shortcut(SupportPlane),
    /// The ray passes through its own support point: it leaves D there, and its
    /// direction is the normal of a support plane there (stationary).
    Vertex,
    /// The lowest plane has depth zero within rounding: no direction is shallower.
    Touch,
    /// The iterations were used up; the last portal if there was one.
    Limit(Option<Portal>),
}

/// Where portal refinement ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// The bounds meet along the normal (Algorithm 1).
    Normal,
    /// The same, or Algorithm 5's shortcut.
    Shortcut,
    /// The bounds meet along the ray (directed penetration).
    Ray,
}

/// A query on its way from ray to ray. A direction that separates ends it: [`Stop::Apart`].
pub struct Search<'q, A, B> {
    /// Who is asked.
    pub md: &'q MinkowskiDifference<A, B>,
    /// Of the bounds, metres.
    pub tolerance: f64,
    /// Where they are to meet.
    pub until: Until,
    /// The normal of the plane that D lies in, if it is in one.
    pub flat: Option<Vec3>,
    /// Iterations that are left.
    pub budget: u64,
    /// The lowest support plane met, one that separates included.
    pub best: SupportPlane,
}

impl<A: SupportMap, B: SupportMap> Search<'_, A, B> {
    /// Counts an iteration, if one is left.
    pub fn spend(&mut self) -> bool {
        let left = self.budget > 0;
        self.budget = self.budget.saturating_sub(1);
        left
    }

    /// The support plane of unit `n`.
    #[inline]
    pub fn plane(&mut self, n: Vec3) -> Result<SupportPlane, Stop> {
        let plane = SupportPlane::of(self.md, n)?;
        if plane.depth < self.best.depth {
            self.best = plane;
        }
        if plane.depth < 0.0 {
            return Err(Stop::Apart(n));
        }
        Ok(plane)
    }

    /// Follows the origin ray along `first.normal` to the boundary of D: Algorithm 1,
    /// or Algorithm 5 of the paper.
    pub fn follow(&mut self, first: &SupportPlane) -> Result<Exit, Stop> {
        let found = match self.flat {
            Some(m) => self.find_segment(first, &m)?,
            None => self.find_portal(first, None)?,
        };
        match found {
            Ok(portal) => self.refine(portal),
            Err(exit) => Ok(exit),
        }
    }

    /// Portal discovery (paper, Algorithm 1, find_portal; G. Snethen, "XenoCollide",
    /// Game Programming Gems 7), for the ray along `first.normal`. `Err`: there is none.
    ///
    /// `behind` is the original algorithm's interior point, where one is known: a point of D
    /// on the line of the ray, behind the origin. Else `v0 = -d`, scaled to the portal's size,
    /// stands in for it.
    pub fn find_portal(
        &mut self,
        first: &SupportPlane,
        behind: Option<&Vec3>,
    ) -> Result<Result<Portal, Exit>, Stop> {
        let d = first.normal;
        if first.depth < 0.0 {
            return Err(Stop::Apart(d));
        }
        let size = first.point.magnitude();
        let side = first.point.v.cross(&d);
        // Negated for NaN: a ray whose own support point cannot be told from it.
        let side = match unit(&side) {
            Some(unit) if side.norm() > rounding(size) => unit,
            _ => return Ok(Err(Exit::Vertex)),
        };
        let second = self.plane(side)?;
        if !(second.depth > rounding(size.max(second.point.magnitude()))) {
            return Ok(Err(Exit::Touch));
        }
        // T(v2, v1) = side · v2 · |v1 × d| > 0: with the two in this order a third
        // point beyond the plane (v0, v1, v2) closes the cone.
        let mut portal = Portal {
            ray: d,
            planes: [second, *first, *first],
        };
        while self.spend() {
            let [a, b, _] = portal.planes.each_ref().map(|p| p.point.v);
            let v0 = match behind {
                Some(inner) => *inner,
                None => -d * larger(largest(&a), largest(&b)),
            };
            let Some(n) = unit(&(a - v0).cross(&(b - v0))) else {
                return Ok(Err(Exit::Touch));
            };
            let third = self.plane(n)?;
            let w = third.point.v;
            if triple(&d, &a, &w) > 0.0 {
                portal.planes[1] = third;
            } else if triple(&d, &w, &b) > 0.0 {
                portal.planes[0] = third;
            } else {
                portal.planes[2] = third;
                return Ok(Ok(portal));
            }
        }
        Ok(Err(Exit::Limit(None)))
    }

    /// The same in the plane with unit normal m. With side = m × d, T(d, v) = side · v: the left end
    /// has a negative one, the right end a positive.
    fn find_segment(
        &mut self,
        first: &SupportPlane,
        m: &Vec3,
    ) -> Result<Result<Portal, Exit>, Stop> {
        if first.depth < 0.0 {
            return Err(Stop::Apart(first.normal));
        }
        let side = m.cross(&first.normal);
        let off = side.dot(&first.point.v);
        if !(off.abs() > rounding(first.point.magnitude())) {
            return Ok(Err(Exit::Vertex));
        }
        let other = self.plane(side * -off.signum())?;
        let (left, right) = if off < 0.0 {
            (*first, other)
        } else {
            (other, *first)
        };
        Ok(Ok(Portal::segment(first.normal, left, right, m)))
    }

    /// Portal refinement: the loop of Algorithms 1 and 5, from a portal on.
    pub fn refine(&mut self, mut portal: Portal) -> Result<Exit, Stop> {
        while self.spend() {
            // Three points on a line, or so near that rounding turns their triangle over:
            // the arithmetic cannot split it further.
            let Some(n) = portal.normal().filter(|n| n.dot(&portal.ray) > 0.0) else {
                break;
            };
            let along = n.dot(&portal.ray);
            let inner = n.dot(&portal.planes[0].point.v);
            let size = (portal.planes.iter()).fold(0.0, |m, p| larger(m, p.point.magnitude()));
            let floor = rounding(size);
            let plane = match self.plane(n) {
                // D holds the portal: a callback that answers less than it is wrong.
                Err(Stop::Apart(_)) if inner > floor => SupportPlane {
                    normal: n,
                    point: portal.planes[0].point,
                    depth: inner,
                },
                answer => answer?,
            };
            let mut gap = plane.depth - inner;
            let mut least = floor;
            if self.until == Until::Ray {
                gap /= along;
                least /= along;
            }
            // Within the tolerance and the origin on the inner side of the portal beyond
            // doubt: a support plane that may still exclude the origin is no answer yet.
            // NaN (a plane that holds the ray) ends the loop.
            if !(gap > least) || (gap <= self.tolerance && inner > floor) {
                return Ok(Exit::Converged(portal, plane));
            }
            if self.until == Until::Shortcut && plane.depth * along <= inner {
                return Ok(Exit::Shortcut(plane));
            }
            match &self.flat {
                None => portal.update(plane),
                Some(m) => {
                    let [left, right, _] = portal.planes;
                    let (left, right) = if m.cross(&portal.ray).dot(&plane.point.v) < 0.0 {
                        (plane, right)
                    } else {
                        (left, plane)
                    };
                    portal = Portal::segment(portal.ray, left, right, m);
                }
            }
        }
        Ok(Exit::Limit(Some(portal)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, Rotation, corners, ellipsoid, hull, placed};

    const ULPS: f64 = 100.0 * EPSILON;

    /// D itself, as the difference to a point.
    fn alone<A: SupportMap>(d: A) -> MinkowskiDifference<A, fn(&Vec3) -> Vec3> {
        MinkowskiDifference::new(d, |_| Vec3::zeros())
    }

    /// A search that begins with this plane.
    fn search<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        best: SupportPlane,
        tolerance: f64,
        until: Until,
        budget: u64,
    ) -> Search<'_, A, B> {
        Search {
            md,
            tolerance,
            until,
            flat: None,
            budget,
            best,
        }
    }

    /// The three products T of a portal; none is negative by more than rounding.
    fn crosses(p: &Portal) -> bool {
        let [a, b, c] = p.planes.each_ref().map(|x| &x.point.v);
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(x, y)| triple(&p.ray, x, y) >= -ULPS)
    }

    /// Where the ray crosses the plane of the portal, and where the support plane.
    fn reaches(p: &Portal, plane: &SupportPlane) -> (f64, f64) {
        let along = plane.normal.dot(&p.ray);
        (
            plane.normal.dot(&p.planes[0].point.v) / along,
            plane.depth / along,
        )
    }

    /// Algorithm 1 for the ray `d`: the exit, with its invariants checked against the
    /// distance `exact` at which the ray leaves D.
    fn check<A: SupportMap>(support: A, d: Vec3, exact: f64, tolerance: f64) {
        let md = alone(support);
        let first = SupportPlane::of(&md, d).unwrap();
        let mut search = search(&md, first, tolerance, Until::Ray, 1000);
        match search.find_portal(&first, None).unwrap() {
            Ok(found) => {
                assert!(crosses(&found));
                // Each vertex is the support point of its own plane.
                for p in &found.planes {
                    assert_eq!(md.support(&p.normal).unwrap(), p.point);
                }
                // By hand: every update keeps the ray inside, and the portal only
                // moves on along it (it may begin behind the origin).
                let mut portal = found;
                let mut before = f64::NEG_INFINITY;
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
                let exit = search.refine(found);
                let Ok(Exit::Converged(portal, plane)) = exit else {
                    panic!("no exit");
                };
                let (p, q) = reaches(&portal, &plane);
                assert!(p <= exact + ULPS && exact <= q + ULPS && q - p <= tolerance + ULPS);
                // The witnesses: on the ray, at the portal.
                let (w1, w2) = portal.witnesses();
                assert!((w1 - w2 - d * p).norm() <= 10.0 * ULPS);
            }
            Err(Exit::Vertex) => assert!((first.depth - exact).abs() <= ULPS),
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
            let exact = (0..3).fold(f64::INFINITY, |t, i| {
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
            match search(&md, first, 1e-6, Until::Normal, 1000).follow(&first) {
                Err(Stop::Apart(n)) => {
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
            let mut search = search(&md, first, 0.0, Until::Normal, given);
            let exit = search.follow(&first).unwrap();
            assert!(matches!(exit, Exit::Limit(_)));
            assert_eq!(search.budget, 0);
            assert!(md.supports() <= given + 2);
            assert!(search.best.depth <= first.depth);
        }
    }
}
