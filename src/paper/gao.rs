// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The published method: W. Gao, "Efficient Incremental Penetration Depth Estimation between Convex
//! Geometries", 2023, <https://arxiv.org/abs/2304.07357>. Algorithm 3 and, with the shortcut, Algorithms 4
//! and 5, for n = 3 and n = 2 dimensions.
//!
//! 1. *Portal* (Sec. II-C, Algorithm 1): a triangle v1, v2, v3 of support points of D that the ray {t d, t >= 0}
//!    crosses. With T(a, b) = d · (a × b): T(1,2), T(2,3), T(3,1) >= 0, and its normal
//!    N = v1×v2 + v2×v3 + v3×v1 points along the ray, N · d >= 0. n = N / |N|.
//! 2. *Refinement*: the distance along the ray to the portal, |p| = (n · v1) / (n · d), is a lower bound of the
//!    distance at which the ray leaves D; that to the support plane of n, |q| = (n · s(n)) / (n · d), is an upper
//!    bound. s(n) replaces one vertex.
//! 3. *Next ray* (Sec. III-B, Algorithm 3): the point of the support plane of n that is closest to the origin is
//!    z = h(n) n. The ray along n leaves D at or before z, so |z| decreases until d and n agree within the
//!    tolerance: |q| − |z| <= tolerance.
//! 4. *Shortcut* (Sec. III-C, Algorithms 4 and 5): the ray is left as soon as |z| <= |p|.
//! 5. *n = 2* (Sec. II-A), for shapes in a plane with unit normal m: the portal is a segment from v1 to v2,
//!    kept as the triangle v1, v2, v2 + m, which has the segment's normal in the plane.
//!
//! Departures. The result is the support plane (n, h(n)) with the least support value, not the ray: it is sound, and
//! takes no further support call. Tests are signs of triple products; none has an absolute epsilon. A support
//! plane that excludes the origin ends the search: the objects are separated. The direction of a ray through its own
//! support point is stationary, but may be a maximum or a saddle: the search perturbs it once and continues. If an
//! earlier support plane is lower than the last one, in another valley (see [`crate::local`]), the search
//! continues there.
//!
//! Outputs. `depth`, `dir`: sound if the objects overlap, which is not proven here. `status`: not
//! converged if the iterations were used up, or rounding ended the search, before a local minimum was found. This is the
//! method on support calls only; the local search of this library, on known vertices, is [`crate::local`].

use crate::epa::buffers::MAX_PROVEN_POINTS;
use crate::math::{self, EPSILON, Vec3, larger, max_abs, perpendicular, unit};
use crate::minkowski::support::{self, Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::support_query::Stop;
use crate::types::{Penetration, Settings, Status};

/// The perturbation of a stationary direction, as tangents along two perpendicular vectors: 6 degrees in all, small
/// enough to stay in the valley and large enough to find a slope. The two have no simple ratio, so that no symmetry of
/// a shape hides the slope.
const PERTURBATION_TAN: (f64, f64) = (0.093, 0.041);

/// Finds a local minimum of the penetration depth from the unit direction `start`: Algorithm 3, or with
/// [`Until::Shortcut`] Algorithms 4 and 5. `plane_normal`: for a D that lies in a plane, the unit normal of that plane;
/// the search then starts along the component of `start` in the plane. `on_new_ray` is called with |z| whenever the ray
/// changes, for tests.
///
/// # Errors
/// `Stop::Separated`; `Stop::Fault` for a point that is not finite.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: Vec3,
    plane_normal: Option<Vec3>,
    until: Until,
    settings: &Settings,
    on_new_ray: impl FnMut(f64),
) -> Result<Penetration, Stop> {
    let start = match plane_normal {
        Some(m) => unit(&(start - m * m.dot(&start))).unwrap_or_else(|| perpendicular(&m)),
        None => start,
    };
    let ray = SupportPlane::of(md, start)?;
    let mut search = RaySearch {
        md,
        tolerance: settings.tolerance,
        until,
        plane_normal,
        budget: settings.max_iterations,
        best: ray,
    };
    let ended = run_algorithm_3(&mut search, ray, on_new_ray)?;
    Ok(Penetration {
        iterations: settings.max_iterations - search.budget,
        status: Status::of_early_end(search.budget, settings.max_iterations, MAX_PROVEN_POINTS)
            .unless(ended.is_some()),
        ..ended.unwrap_or_else(|| make_result(&search.best, None))
    })
}

/// Runs the loop of Algorithm 3. Returns `None` if the iterations are used up, or rounding ends a ray.
fn run_algorithm_3<A: SupportMap, B: SupportMap>(
    search: &mut RaySearch<'_, A, B>,
    mut ray: SupportPlane,
    mut on_new_ray: impl FnMut(f64),
) -> Result<Option<Penetration>, Stop> {
    // The stationary ray that was perturbed: its depth and witness points are exact.
    let mut perturbed_from: Option<SupportPlane> = None;
    loop {
        let next = match search.follow(&ray)? {
            RayEnd::Touch => return Ok(Some(make_result(&search.best, None))),
            RayEnd::Limit(_) => return Ok(None),
            RayEnd::Shortcut(plane) => plane,
            RayEnd::Vertex => match perturbed_from {
                None => {
                    perturbed_from = Some(ray);
                    let perturbation = match search.plane_normal {
                        Some(m) => m.cross(&ray.normal) * PERTURBATION_TAN.0,
                        None => {
                            let e1 = perpendicular(&ray.normal);
                            e1 * PERTURBATION_TAN.0 + ray.normal.cross(&e1) * PERTURBATION_TAN.1
                        }
                    };
                    let n = ray.normal + perturbation;
                    ray = search.plane(n / n.norm())?;
                    // No call of `on_new_ray`: the depth may rise.
                    continue;
                }
                // Stationary again: the result, unless an earlier plane is in a lower
                // valley.
                Some(_) if search.best.depth < ray.depth - search.tolerance => search.best,
                Some(first) => {
                    let lower = if first.depth < ray.depth { first } else { ray };
                    return Ok(Some(make_result(&lower, None)));
                }
            },
            RayEnd::Converged(last, plane) => {
                let along = plane.normal.dot(&ray.normal);
                let floor = search.tolerance.max(rounding(plane.point.magnitude()));
                // |q| − |z|. A gap that is NaN or infinite (a plane parallel to the ray) is not
                // stationary.
                let stationary = plane.depth / along - plane.depth <= floor;
                let lower_elsewhere = search.best.depth < plane.depth - floor;
                if stationary && !lower_elsewhere {
                    let hit = match &perturbed_from {
                        Some(first) if first.depth <= plane.depth => make_result(first, None),
                        _ => make_result(&plane, Some(&last)),
                    };
                    return Ok(Some(hit));
                }
                if lower_elsewhere { search.best } else { plane }
            }
        };
        if !search.take_iteration() {
            return Ok(None);
        }
        on_new_ray(next.depth);
        ray = next;
    }
}

/// Makes the result of a support plane. The witness points are those of the point at which the ray crosses
/// `portal`; without a portal, those of the support point.
pub fn make_result(plane: &SupportPlane, portal: Option<&Portal>) -> Penetration {
    let (point1, point2) = match portal {
        Some(p) => p.witnesses(),
        None => (plane.point.v1, plane.point.v2),
    };
    Penetration {
        depth: plane.depth,
        dir: plane.normal,
        normal: plane.normal,
        point1,
        point2,
        ..Penetration::default()
    }
}

/// A support plane of D: unit normal, support point, support value.
#[derive(Clone, Copy, Debug)]
pub struct SupportPlane {
    /// Unit normal n.
    pub normal: Vec3,
    /// The support point s(n).
    pub point: SupportPoint,
    /// The support value h(n) = n · s(n), a sound depth along n if it is not negative.
    pub depth: f64,
}

impl SupportPlane {
    /// Evaluates the support plane with the unit normal `normal`.
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

/// A portal: three support points whose triangle the ray crosses.
#[derive(Clone, Copy)]
pub struct Portal {
    /// Unit direction of the ray.
    pub ray: Vec3,
    /// The support planes of v1, v2, v3, in the order in which the triangle's normal points
    /// along the ray.
    pub planes: [SupportPlane; 3],
}

impl Portal {
    /// Returns the outward unit normal of the triangle; `None` if it has no area.
    #[inline]
    pub fn normal(&self) -> Option<Vec3> {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point.v);
        unit(&math::normal(a, b, c))
    }

    /// Returns the weights of the vertices in the point at which the ray crosses, not normalised: the three products
    /// T.
    fn weights(&self) -> [f64; 3] {
        let [a, b, c] = self.planes.each_ref().map(|p| &p.point.v);
        [
            triple(&self.ray, b, c),
            triple(&self.ray, c, a),
            triple(&self.ray, a, b),
        ]
    }

    /// Makes the portal for n = 2, in the plane with normal m: a segment from one side of the ray to the other.
    fn segment(ray: Vec3, left: SupportPlane, right: SupportPlane, m: &Vec3) -> Self {
        let mut third = right;
        third.point.v += m;
        third.point.v1 += m;
        Self {
            ray,
            planes: [left, right, third],
        }
    }

    /// Replaces one vertex by the point of `w`, beyond the triangle, so that the ray
    /// still crosses (paper, Algorithm 1, update_portal).
    #[inline]
    pub fn update(&mut self, w: SupportPlane) {
        let c = self.ray.cross(&w.point.v);
        // The signs are the sides of the vertices relative to the plane through the ray and w.
        // The ray crosses the triangle of w and two vertices on opposite sides, so w replaces the
        // third. The side of a vertex on that plane is rounding, so the pair that is farthest on
        // opposite sides is taken.
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

    /// Returns the parameter of the triangle along the ray: |p|, negative behind the origin. It is the mean of the
    /// vertices with the weights T, which rounding does not move out of the triangle.
    pub fn ray_parameter(&self) -> f64 {
        let t = self.weights();
        let v = self.planes.each_ref().map(|p| self.ray.dot(&p.point.v));
        (t[0] * v[0] + t[1] * v[1] + t[2] * v[2]) / (t[0] + t[1] + t[2])
    }

    /// Returns the points of obj1 and obj2 whose difference is the point at which the ray crosses the
    /// triangle. Both are convex combinations of the objects' own support points.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let points = self.planes.each_ref().map(|p| &p.point);
        let weights = self.weights().map(|t| t.max(0.0));
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0) {
            return (points[0].v1, points[0].v2);
        }
        support::witnesses(&weights.map(|t| t / sum), points)
    }
}

#[inline]
fn triple(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    a.dot(&b.cross(c))
}

/// Returns the rounding error of a support point whose largest coordinate is `size`, metres. A smaller depth or gap
/// counts as 0.
#[inline]
pub fn rounding(size: f64) -> f64 {
    8.0 * EPSILON * size
}

/// Reason why the search along a ray ended.
pub enum RayEnd {
    /// The ray leaves D between the portal and this support plane, at most the tolerance apart.
    Converged(Portal, SupportPlane),
    /// The shortcut of Algorithm 5: the support value of this plane is at most the
    /// distance |p| to the portal along the ray.
    Shortcut(SupportPlane),
    /// The ray passes through its own support point and leaves D there: its direction is
    /// stationary.
    Vertex,
    /// The least support value is 0 within rounding.
    Touch,
    /// The iterations are used up, or rounding prevents a refinement. The last portal, if there was one.
    Limit(Option<Portal>),
}

/// The stop criterion of portal refinement.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// The bounds meet along the normal (Algorithm 1).
    Normal,
    /// The bounds meet along the normal, or the shortcut of Algorithm 5 applies.
    Shortcut,
    /// The bounds meet along the ray (query `along`).
    Ray,
}

/// The state of a search from ray to ray. A separating direction ends it ([`Stop::Separated`]).
pub struct RaySearch<'q, A, B> {
    /// The Minkowski difference.
    pub md: &'q MinkowskiDifference<A, B>,
    /// The largest gap between the bounds, metres.
    pub tolerance: f64,
    /// The stop criterion.
    pub until: Until,
    /// For a D that lies in a plane, the unit normal of that plane.
    pub plane_normal: Option<Vec3>,
    /// The iterations left.
    pub budget: u64,
    /// The support plane with the least support value so far, which may be a separating one.
    pub best: SupportPlane,
}

impl<A: SupportMap, B: SupportMap> RaySearch<'_, A, B> {
    /// Counts an iteration. Returns `false` if none was left.
    pub fn take_iteration(&mut self) -> bool {
        let left = self.budget > 0;
        self.budget = self.budget.saturating_sub(1);
        left
    }

    /// Evaluates the support plane with the unit normal `n`.
    ///
    /// # Errors
    /// [`Stop::Separated`] for a negative support value; [`Stop::Fault`] for a point that is not finite.
    #[inline]
    pub fn plane(&mut self, n: Vec3) -> Result<SupportPlane, Stop> {
        let plane = SupportPlane::of(self.md, n)?;
        if plane.depth < self.best.depth {
            self.best = plane;
        }
        if plane.depth < 0.0 {
            return Err(Stop::Separated(n));
        }
        Ok(plane)
    }

    /// Follows the ray along `first.normal` to the boundary of D, by Algorithm 1 or
    /// Algorithm 5 of the paper.
    pub fn follow(&mut self, first: &SupportPlane) -> Result<RayEnd, Stop> {
        let found = match self.plane_normal {
            Some(m) => self.find_segment(first, &m)?,
            None => self.find_portal(first)?,
        };
        match found {
            Ok(portal) => self.refine(portal),
            Err(exit) => Ok(exit),
        }
    }

    /// Finds a portal of the ray along `first.normal` (paper, Algorithm 1, find_portal; G. Snethen, "XenoCollide",
    /// Game Programming Gems 7). The inner `Err` is the reason if there is none. The point v0 = −d, scaled to the
    /// portal's size, takes the place of the interior point.
    fn find_portal(&mut self, first: &SupportPlane) -> Result<Result<Portal, RayEnd>, Stop> {
        let d = first.normal;
        if first.depth < 0.0 {
            return Err(Stop::Separated(d));
        }
        let size = first.point.magnitude();
        let side = first.point.v.cross(&d);
        // Vertex: the support point is on the ray within rounding. The test is negated for NaN.
        let side = match unit(&side) {
            Some(unit) if side.norm() > rounding(size) => unit,
            _ => return Ok(Err(RayEnd::Vertex)),
        };
        let second = self.plane(side)?;
        if !(second.depth > rounding(size.max(second.point.magnitude()))) {
            return Ok(Err(RayEnd::Touch));
        }
        // T(v2, v1) = side · v2 · |v1 × d| > 0. With the two in this order, a third
        // point beyond the plane (v0, v1, v2) completes the portal.
        let mut portal = Portal {
            ray: d,
            planes: [second, *first, *first],
        };
        while self.take_iteration() {
            let [a, b, _] = portal.planes.each_ref().map(|p| p.point.v);
            let v0 = -d * larger(max_abs(&a), max_abs(&b));
            let Some(n) = unit(&(a - v0).cross(&(b - v0))) else {
                return Ok(Err(RayEnd::Touch));
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
        Ok(Err(RayEnd::Limit(None)))
    }

    /// Finds a segment that the ray along `first.normal` crosses, in the plane with unit normal m. With side = m × d,
    /// side · v is negative for the left end and positive for the right one. The inner `Err` is the reason if there is
    /// none.
    fn find_segment(
        &mut self,
        first: &SupportPlane,
        m: &Vec3,
    ) -> Result<Result<Portal, RayEnd>, Stop> {
        if first.depth < 0.0 {
            return Err(Stop::Separated(first.normal));
        }
        let side = unit(&m.cross(&first.normal)).unwrap_or_else(|| perpendicular(m));
        let off = side.dot(&first.point.v);
        if !(off.abs() > rounding(first.point.magnitude())) {
            return Ok(Err(RayEnd::Vertex));
        }
        let other = self.plane(side * -off.signum())?;
        let (left, right) = if off < 0.0 {
            (*first, other)
        } else {
            (other, *first)
        };
        Ok(Ok(Portal::segment(first.normal, left, right, m)))
    }

    /// Refines a portal: the loop of Algorithms 1 and 5.
    pub fn refine(&mut self, mut portal: Portal) -> Result<RayEnd, Stop> {
        while self.take_iteration() {
            // Without a normal along the ray the three points are on a line within rounding,
            // and the portal cannot be refined further.
            let Some(n) = portal.normal().filter(|n| n.dot(&portal.ray) > 0.0) else {
                break;
            };
            let along = n.dot(&portal.ray);
            let inner = n.dot(&portal.planes[0].point.v);
            let size = (portal.planes.iter()).fold(0.0, |m, p| larger(m, p.point.magnitude()));
            let floor = rounding(size);
            let plane = match self.plane(n) {
                // The portal is in D: a callback with a support value below it is wrong.
                Err(Stop::Separated(_)) if inner > floor => SupportPlane {
                    normal: n,
                    point: portal.planes[0].point,
                    depth: inner,
                },
                evaluated => evaluated?,
            };
            let mut gap = plane.depth - inner;
            let mut least = floor;
            let mut most = self.tolerance;
            if self.until == Until::Ray {
                gap /= along;
                least /= along;
                // The rounding error is subtracted from the lower bound.
                most -= least;
            }
            // Converged: the gap is within the tolerance, and the origin is on the inner side of the
            // portal by more than rounding, so that the support plane does not exclude the origin.
            // NaN (a plane parallel to the ray) ends the loop too.
            if !(gap > least) || (gap <= most && inner > floor) {
                return Ok(RayEnd::Converged(portal, plane));
            }
            if self.until == Until::Shortcut && plane.depth * along <= inner {
                return Ok(RayEnd::Shortcut(plane));
            }
            match &self.plane_normal {
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
        Ok(RayEnd::Limit(Some(portal)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, ball, capsule, corners, difference, ellipsoid, hull, placed};

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-7 } else { 1e-5 },
        max_iterations: 20_000,
    };

    fn solve<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        start: Vec3,
        shortcut: Until,
        switched: impl FnMut(f64),
    ) -> Penetration {
        let hit = penetration(md, start, None, shortcut, &SETTINGS, switched).unwrap();
        assert_eq!(hit.status, Status::Converged);
        hit
    }

    /// An ellipsoid with semi-axes `radii` about `center`, as a level set
    /// g(v) = Σ ((v − center)ᵢ / radiiᵢ)² − 1, so that planes and rays are at hand.
    struct Explicit {
        radii: Vec3,
        center: Vec3,
    }

    impl Explicit {
        /// Unit normal ∇g / |∇g| at a boundary point.
        fn normal(&self, v: &Vec3) -> Vec3 {
            let r2 = self.radii.component_mul(&self.radii);
            unit(&(v - self.center).component_div(&r2)).unwrap()
        }

        /// Returns the point at which the ray from the origin along `d` leaves the ellipsoid: the root t > 0 of g(t d).
        fn exit(&self, d: &Vec3) -> Vec3 {
            let d_ = d.component_div(&self.radii);
            let c = self.center.component_div(&self.radii);
            let (a, b) = (d_.dot(&d_), d_.dot(&c));
            d * ((b + (b * b - a * (c.dot(&c) - 1.0)).sqrt()) / a)
        }

        /// The paper's Algorithm 2 from the boundary point `v`: the plane at v, the
        /// origin's projection z on it, the boundary point along z. `each` is called with |z|.
        fn sqp(&self, mut v: Vec3, mut each: impl FnMut(f64)) -> Vec3 {
            for _ in 0..3000 {
                let n = self.normal(&v);
                let z = n * n.dot(&v);
                each(z.norm());
                v = self.exit(&unit(&z).unwrap());
            }
            v
        }
    }

    /// Algorithm 2 on an ellipsoid about the origin: |z| never rises, and the fixed point is the
    /// end of the shortest axis.
    #[test]
    fn algorithm_2_ends_on_the_shortest_axis() {
        let mut r = Random::new(1);
        for _ in 0..100 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                center: Vec3::zeros(),
            };
            let mut last = f64::INFINITY;
            let v = e.sqp(e.exit(&r.direction()), |z| {
                assert!(z <= last * (1.0 + 4.0 * EPSILON));
                last = z;
            });
            assert!((v.norm() - e.radii.x).abs() < 1e3 * EPSILON);
            assert!((e.normal(&v).x.abs() - 1.0).abs() < 1e3 * EPSILON);
        }
    }

    /// Algorithm 2 on an ellipsoid off the origin: at the fixed point v is parallel to its normal.
    /// Algorithm 3, which has only the support function, takes the same steps to it.
    #[test]
    fn algorithm_3_takes_the_steps_of_algorithm_2() {
        let mut r = Random::new(2);
        let tolerance = 1e-10;
        for _ in 0..50 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                center: r.vector(0.2),
            };
            let v = e.sqp(e.exit(&r.direction()), |_| ());
            assert!(e.normal(&v).cross(&v).norm() < 1e4 * EPSILON);

            let support = ellipsoid(e.radii, crate::shapes::Rotation::identity(), e.center);
            let md = difference(support, |_: &Vec3| Vec3::zeros());
            let mut ray = SupportPlane::of(&md, r.direction()).unwrap();
            for _ in 0..20 {
                let normal = e.normal(&e.exit(&ray.normal));
                let mut search = RaySearch {
                    md: &md,
                    tolerance,
                    until: Until::Normal,
                    plane_normal: None,
                    budget: 2000,
                    best: ray,
                };
                match search.follow(&ray) {
                    Ok(RayEnd::Converged(_, plane)) => {
                        // A gap of tol leaves an angle of sqrt(tol) to the normal.
                        let error = (plane.normal - normal).norm();
                        let room = 4.0 * tolerance.max(64.0 * EPSILON).sqrt();
                        assert!(error < room, "{error:e}");
                        ray = plane;
                    }
                    _ => panic!("no portal"),
                }
            }
        }
    }

    /// Returns whether no direction within 3 degrees is lower by more than the tolerance.
    fn is_local_minimum<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        hit: &Penetration,
        r: &mut Random,
    ) -> bool {
        (0..50).all(|_| {
            let n = unit(&(hit.dir + r.vector(0.03))).unwrap();
            SupportPlane::of(md, n).unwrap().depth >= hit.depth - 10.0 * SETTINGS.tolerance
        })
    }

    /// Algorithm 3 and Algorithms 4, 5 end in a local minimum each; started near a
    /// minimum, in no higher one. |z| falls strictly at each change of the ray.
    #[test]
    fn with_and_without_the_shortcut() {
        let mut r = Random::new(3);
        let mut supports = [0; 2];
        for _ in 0..200 {
            let turn = r.rotation();
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let (a, b) = (r.vector(0.5), r.vector(0.5));
            let cube = placed(&corners(half), &turn, r.vector(0.1));
            let md = difference(hull(&cube), capsule(a, b, 0.3));
            let start = r.direction();
            for (i, shortcut) in [Until::Normal, Until::Shortcut].into_iter().enumerate() {
                let before = md.supports();
                let mut last = SupportPlane::of(&md, start).unwrap().depth;
                let hit = solve(&md, start, shortcut, |z| {
                    assert!(z < last, "{z} after {last}");
                    last = z;
                });
                supports[i] += md.supports() - before;
                assert!(is_local_minimum(&md, &hit, &mut r));
                let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v);
                assert!((h - hit.depth).abs() < 32.0 * EPSILON);
                // From a nearby direction both return to it, or to a lower one.
                let near = unit(&(hit.dir + r.vector(0.01))).unwrap();
                for shortcut in [Until::Normal, Until::Shortcut] {
                    let again = solve(&md, near, shortcut, |_| ());
                    assert!(again.depth <= hit.depth + 4.0 * SETTINGS.tolerance);
                }
            }
        }
        // The paper's ablation: the shortcut saves about half.
        assert!(supports[1] < supports[0], "{supports:?}");
    }

    /// Started at a maximum, along its own support point, the search perturbs the direction.
    #[test]
    fn a_maximum_is_left() {
        // A ball on the axis of a capsule: depth 1.3 along the axis, 1.0 perpendicular to it.
        let md = difference(
            ball(Vec3::zeros(), 0.5),
            capsule(Vec3::z() * -0.5, Vec3::z() * 0.5, 0.5),
        );
        let shifted = difference(
            ball(Vec3::z() * 0.2, 0.5),
            capsule(Vec3::z() * -0.5, Vec3::z() * 0.5, 0.5),
        );
        for shortcut in [Until::Normal, Until::Shortcut] {
            for md in [&md, &shifted] {
                for start in [Vec3::z(), -Vec3::z()] {
                    let hit = solve(md, start, shortcut, |_| ());
                    assert!((hit.depth - 1.0).abs() <= 1e-4, "{}", hit.depth);
                    assert!(hit.dir.z.abs() < 0.02, "{}", hit.dir);
                }
            }
        }
    }

    /// Icosahedra started along a vertex: the minimum is a face of their difference.
    #[test]
    fn icosahedra_along_a_vertex() {
        let p = (1.0 + (5.0 as f64).sqrt()) / 2.0;
        let mut points = vec![];
        for (s, t) in [(1.0, p), (1.0, -p), (-1.0, p), (-1.0, -p)] {
            points.push(Vec3::new(0.0, s, t));
            points.push(Vec3::new(s, t, 0.0));
            points.push(Vec3::new(t, 0.0, s));
        }
        let md = difference(hull(&points), hull(&points));
        // The inradius of an icosahedron with edge 2.
        let inradius = (3.0 as f64).sqrt() * (3.0 + (5.0 as f64).sqrt()) / 6.0;
        for v in &points {
            let hit = solve(&md, unit(v).unwrap(), Until::Shortcut, |_| ());
            assert!((hit.depth - 2.0 * inradius).abs() <= 1e-5, "{}", hit.depth);
        }
    }

    /// A box on itself: the result is the depth of one of the three pairs of faces.
    #[test]
    fn a_box_on_itself() {
        let cube = corners(Vec3::new(0.5, 0.4, 0.3));
        let md = difference(hull(&cube), hull(&cube));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let hit = solve(&md, r.direction(), Until::Shortcut, |_| ());
            let face = [1.0, 0.8, 0.6].map(|d| (hit.depth - d).abs() < 1e-6);
            assert!(face.contains(&true), "{}", hit.depth);
        }
    }

    /// Checks that the result is sound, and has the status, for every iteration limit.
    #[test]
    fn the_iteration_limit_is_reported() {
        let mut r = Random::new(6);
        for max_iterations in 0..30 {
            let center = r.vector(0.3);
            let md = difference(ball(center, 0.5), ball(Vec3::zeros(), 0.4));
            let settings = Settings {
                max_iterations,
                tolerance: 1e-9,
            };
            let start = r.direction();
            let hit = penetration(&md, start, None, Until::Shortcut, &settings, |_| ()).unwrap();
            assert_eq!(hit.status, Status::IterationLimit);
            assert!(hit.iterations <= max_iterations);
            let h = hit.dir.dot(&md.support(&hit.dir).unwrap().v);
            assert!((h - hit.depth).abs() <= 8.0 * EPSILON);
            let apart = (hit.point1 - hit.point2).dot(&hit.dir);
            assert!((apart - hit.depth).abs() <= 8.0 * EPSILON);
        }
    }
}

#[cfg(test)]
mod portal_tests {
    use super::*;
    use crate::shapes::{Random, Rotation, Shape, corners, difference, ellipsoid, hull, placed};

    const ULPS: f64 = 100.0 * EPSILON;

    /// Returns the difference of `d` and the origin, which is `d`.
    fn alone<'a>(d: impl SupportMap + 'a) -> MinkowskiDifference<Shape<'a>, Shape<'a>> {
        difference(d, |_: &Vec3| Vec3::zeros())
    }

    /// Returns a search that begins with the plane `best`.
    fn search<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        best: SupportPlane,
        tolerance: f64,
        until: Until,
        budget: u64,
    ) -> RaySearch<'_, A, B> {
        RaySearch {
            md,
            tolerance,
            until,
            plane_normal: None,
            budget,
            best,
        }
    }

    /// Returns whether the ray crosses the portal: none of the three products T is negative by more than rounding.
    fn crosses(p: &Portal) -> bool {
        let [a, b, c] = p.planes.each_ref().map(|x| &x.point.v);
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(x, y)| triple(&p.ray, x, y) >= -ULPS)
    }

    /// Returns the parameters at which the ray crosses the plane of the portal and the support plane.
    fn reaches(p: &Portal, plane: &SupportPlane) -> (f64, f64) {
        let along = plane.normal.dot(&p.ray);
        (
            plane.normal.dot(&p.planes[0].point.v) / along,
            plane.depth / along,
        )
    }

    /// Checks Algorithm 1 for the ray `d`: its invariants and its result, against the distance
    /// `exact` at which the ray leaves D.
    fn check<A: SupportMap>(support: A, d: Vec3, exact: f64, tolerance: f64) {
        let md = alone(support);
        let first = SupportPlane::of(&md, d).unwrap();
        let mut search = search(&md, first, tolerance, Until::Ray, 1000);
        match search.find_portal(&first).unwrap() {
            Ok(found) => {
                assert!(crosses(&found));
                // Each vertex is the support point of its own plane.
                for p in &found.planes {
                    assert_eq!(md.support(&p.normal).unwrap(), p.point);
                }
                // Step by step: the ray crosses every updated portal, whose parameter along the
                // ray only grows (it may be negative at first).
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
                let Ok(RayEnd::Converged(portal, plane)) = exit else {
                    panic!("no exit");
                };
                let (p, q) = reaches(&portal, &plane);
                assert!(p <= exact + ULPS && exact <= q + ULPS && q - p <= tolerance + ULPS);
                // The witnesses: on the ray, at the portal.
                let (w1, w2) = portal.witnesses();
                assert!((w1 - w2 - d * p).norm() <= 10.0 * ULPS);
            }
            Err(RayEnd::Vertex) => assert!((first.depth - exact).abs() <= ULPS),
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
            // The origin is off the center; every tenth ray is along an axis, through the middle of a face.
            let (at, d) = match round % 10 {
                0 => (Vec3::zeros(), Vec3::ith(round / 10 % 3, 1.0)),
                _ => (at, r.direction()),
            };
            // The closest of the three planes along the ray.
            let exact = (0..3).fold(f64::INFINITY, |t, i| {
                t.min((half[i].copysign(d[i]) + at[i]) / d[i]).max(0.0)
            });
            let points = placed(&corners(half), &turn, turn * at);
            check(hull(&points), turn * d, exact, 1e-6);
        }
    }

    /// With the origin outside D the search ends with a direction that separates.
    #[test]
    fn an_origin_outside_is_separated() {
        let mut r = Random::new(3);
        for _ in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let way = r.direction();
            let points = placed(&corners(half), &r.rotation(), way * 3.0);
            let md = alone(hull(&points));
            // From the center through the origin, as from the centers of two objects.
            let first = SupportPlane::of(&md, -way).unwrap();
            match search(&md, first, 1e-6, Until::Normal, 1000).follow(&first) {
                Err(Stop::Separated(n)) => {
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                _ => panic!("the origin is outside"),
            }
        }
    }

    /// Checks that a budget that is too small is reported, and is not exceeded.
    #[test]
    fn budgets_are_kept_and_reported() {
        let mut r = Random::new(4);
        for given in 0..20 {
            let radii = Vec3::new(1.0, 0.7, 0.5);
            let md = alone(ellipsoid(radii, r.rotation(), Vec3::zeros()));
            let first = SupportPlane::of(&md, r.direction()).unwrap();
            let mut search = search(&md, first, 0.0, Until::Normal, given);
            let exit = search.follow(&first).unwrap();
            assert!(matches!(exit, RayEnd::Limit(_)));
            assert_eq!(search.budget, 0);
            assert!(md.supports() <= given + 2);
            assert!(search.best.depth <= first.depth);
        }
    }
}

/// The case n = 2.
#[cfg(test)]
mod planar_tests {
    use super::*;
    use crate::shapes::{Random, Rotation, difference, hull};

    const TAU: f64 = core::f64::consts::TAU as f64;

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-9 } else { 1e-5 },
        max_iterations: 2000,
    };

    /// Returns a random rotation, the axes x, y and the normal m of a plane, and a point of the plane.
    fn frame(r: &mut Random) -> (Rotation, Vec3, Vec3, Vec3, Vec3) {
        let turn = r.rotation();
        let [x, y, m] = [0, 1, 2].map(|i| turn * Vec3::ith(i, 1.0));
        let at = m * r.within(-3.0, 3.0);
        (turn, x, y, m, at)
    }

    fn penetration<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        m: &Vec3,
        start: Vec3,
        settings: &Settings,
    ) -> Result<Penetration, Stop> {
        super::penetration(md, start, Some(*m), Until::Shortcut, settings, |_| ())
    }

    fn solve<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        m: &Vec3,
        start: Vec3,
    ) -> Penetration {
        let hit = penetration(md, m, start, &SETTINGS).unwrap();
        let ulps = 100.0 * EPSILON;
        assert_eq!(hit.status, Status::Converged);
        assert!(hit.dir.dot(m).abs() < ulps, "leaves the plane");
        assert!((hit.dir.norm() - 1.0).abs() < ulps);
        // The depth is sound, and the witness points are on the two support planes.
        let s = md.support(&hit.dir).unwrap();
        assert!((hit.dir.dot(&s.v) - hit.depth).abs() < ulps);
        let room = SETTINGS.tolerance + ulps;
        assert!((hit.dir.dot(&(hit.point1 - s.v1))).abs() <= room);
        assert!((hit.dir.dot(&(hit.point2 - s.v2))).abs() <= room);
        hit
    }

    /// Discs: the depth is r1 + r2 − distance, along the centers.
    #[test]
    fn discs() {
        let mut r = Random::new(1);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let angle = r.within(0.0, TAU);
            let way = x * angle.cos() + y * angle.sin();
            let distance = r.within(0.1, 1.4);
            let disc = |center: Vec3, radius: f64| {
                move |d: &Vec3| {
                    let flat = d - m * m.dot(d);
                    center + unit(&flat).map_or(Vec3::zeros(), |f| f * radius)
                }
            };
            let md = difference(disc(at, 1.0), disc(at + way * distance, 0.5));
            let angle = r.within(0.0, TAU);
            let hit = solve(&md, &m, x * angle.cos() + y * angle.sin());
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // The same from the stationary direction that is a maximum.
            let hit = solve(&md, &m, -way);
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // Started at the minimum, the result is exact.
            let hit = solve(&md, &m, way);
            assert!((hit.depth - (1.5 - distance)).abs() < 100.0 * EPSILON);
        }
    }

    /// Polygons: the depth is the support value of an edge of one of the two, and no
    /// nearby direction is lower; the least depth from all edges is the least support value of them.
    #[test]
    fn polygons() {
        let mut r = Random::new(2);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let mut polygon = |center: Vec3| {
                let n = 3 + (r.within(0.0, 5.0) as usize);
                (0..n)
                    .map(|i| {
                        let angle = (i as f64 + r.within(0.1, 0.9)) * TAU / n as f64;
                        center + x * angle.cos() + y * (0.6 * angle.sin())
                    })
                    .collect::<Vec<_>>()
            };
            let a = polygon(at);
            let b = polygon(at + x * 0.3 + y * 0.1);
            let md = difference(hull(&a), hull(&b));
            let h = |n: &Vec3| n.dot(&md.support(n).unwrap().v);
            let mut edges = vec![];
            for (points, sign) in [(&a, 1.0), (&b, -1.0)] {
                for i in 0..points.len() {
                    let edge = points[(i + 1) % points.len()] - points[i];
                    let n = unit(&(edge.cross(&m) * sign)).unwrap();
                    edges.push((n, h(&n)));
                }
            }
            let least = edges.iter().fold(f64::INFINITY, |l, e| l.min(e.1));
            // Hulls of random polygons may overlap at a point only.
            if least < 1e-3 {
                continue;
            }
            let mut best = f64::INFINITY;
            for (start, _) in &edges {
                let hit = solve(&md, &m, unit(&(start + x * 0.05)).unwrap());
                let is = |e: f64| (e - hit.depth).abs() < 10.0 * SETTINGS.tolerance;
                assert!(edges.iter().any(|e| is(e.1)));
                for turn in [-1e-3, 1e-3] {
                    let n = unit(&(hit.dir + m.cross(&hit.dir) * turn)).unwrap();
                    assert!(h(&n) >= hit.depth - 10.0 * SETTINGS.tolerance);
                }
                best = best.min(hit.depth);
            }
            assert!(
                (best - least).abs() < 10.0 * SETTINGS.tolerance,
                "{best} {least}"
            );
        }
    }

    /// Squares with a gap of a hundredth: a direction in the plane separates them.
    #[test]
    fn separated_squares() {
        let mut r = Random::new(3);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let square = |c: Vec3| [c + x, c + y, c - x, c - y];
            let by = unit(&(x + y)).unwrap() * ((2.0 as f64).sqrt() + 0.01);
            let md = difference(hull(&square(at)), hull(&square(at + by)));
            let angle = r.within(0.0, TAU);
            let start = x * angle.cos() + y * angle.sin();
            match penetration(&md, &m, start, &SETTINGS) {
                Err(Stop::Separated(n)) => {
                    assert!(n.dot(&m).abs() < 100.0 * EPSILON);
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                // A local minimum on the far side of the other square: the overlap is not proven here.
                Ok(hit) => assert!(hit.status == Status::Converged && hit.dir.dot(&by) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}
