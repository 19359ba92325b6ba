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
//! takes no further support call. Tests are signs of triple products; none has an absolute epsilon. Only the corner that
//! a support point replaces is chosen by the products' sizes too ([`choose_corner`]). A support plane that excludes the
//! origin, or passes through it within the contact epsilon, ends the search: the objects are separated. The direction of a
//! ray through its own support point is stationary, but may be a maximum or a saddle: the search perturbs it once and
//! continues. If an earlier support plane is lower than the last one, in another valley (see [`crate::local`]), the search
//! continues there. For n = 3 directions are evaluated as they are, for n = 2 in general position within the plane
//! ([`general_position`](crate::minkowski::general_position)).
//!
//! Outputs. `depth`, `dir`: sound if the objects overlap, which is not proven here. `status`: not
//! converged if the iterations were used up, or rounding ended the search, before a local minimum was found. This is the
//! method on support calls only; the local search of this library, on known vertices, is [`crate::local`].

use crate::epa::buffers::MAX_PROVEN_POINTS;
use crate::math::{self, EPSILON, Vec3, larger, max_abs, perpendicular, tangents, unit};
use crate::minkowski::general_position::TiltRule;
use crate::minkowski::support::{self, Difference, Fault};
use crate::minkowski::support_query::{Stop, SupportPlane};
use crate::minkowski::tolerance::Scale;
use crate::portal::choose_corner;
use crate::types::{Direction, Settings, Solution, Status};

/// The perturbation of a stationary direction, as tangents along two perpendicular vectors: 6 degrees in all, small
/// enough to stay in the valley and large enough to find a slope. The two have no simple ratio, so that no symmetry of
/// a shape hides the slope.
const PERTURBATION_TAN: (f64, f64) = (0.093, 0.041);

/// Finds a local minimum of the penetration depth from the unit direction `start`: Algorithm 3, or with
/// [`Until::Shortcut`] Algorithms 4 and 5. `plane_normal`: for a D that lies in a plane, the unit normal of that plane;
/// the search then starts along the component of `start`, in general position, in the plane. `on_new_ray` is called with |z|
/// whenever the ray changes, for tests.
///
/// # Errors
/// `Stop::Separated`; `Stop::Fault` for a point that is not finite.
pub fn incremental_minimum<D: Difference>(
    md: &D,
    start: Vec3,
    plane_normal: Option<Vec3>,
    until: Until,
    settings: &Settings,
    on_new_ray: impl FnMut(f64),
) -> Result<Solution, Stop> {
    let start = match plane_normal {
        Some(m) => unit(&(start - m * m.dot(&start))).unwrap_or_else(|| perpendicular(&m)),
        None => start,
    };
    // In a plane the caller has tilted it.
    let Direction { tilt, .. } = Direction::remembered(start, plane_normal.is_some());
    let ray = SupportPlane {
        tilt,
        ..support_plane(md, start)?
    };
    let mut search = RaySearch {
        md,
        tolerance: settings.tolerance,
        until,
        plane_normal,
        scale: Scale::default(),
        budget: settings.max_iterations,
        best: ray,
    };
    let ended = run_algorithm_3(&mut search, ray, on_new_ray)?;
    Ok(Solution {
        iterations: settings.max_iterations - search.budget,
        status: Status::of_early_end(search.budget, settings.max_iterations, MAX_PROVEN_POINTS)
            .unless(ended.is_some()),
        ..ended.unwrap_or_else(|| make_result(&search.best, None))
    })
}

/// Runs the loop of Algorithm 3. Returns `None` if the iterations are used up, or rounding ends a ray.
fn run_algorithm_3<D: Difference>(
    search: &mut RaySearch<'_, D>,
    mut ray: SupportPlane,
    mut on_new_ray: impl FnMut(f64),
) -> Result<Option<Solution>, Stop> {
    // The stationary ray that was perturbed: its depth and witness points are exact.
    let mut perturbed_from: Option<SupportPlane> = None;
    loop {
        let next = match search.follow(&ray)? {
            RayEnd::Touch => return Ok(Some(make_result(&search.best, None))),
            RayEnd::Limit => return Ok(None),
            RayEnd::Shortcut(plane) => plane,
            RayEnd::Vertex => match perturbed_from {
                None => {
                    perturbed_from = Some(ray);
                    let perturbation = match search.plane_normal {
                        Some(m) => m.cross(&ray.dir) * PERTURBATION_TAN.0,
                        None => {
                            let [e1, e2] = tangents(&ray.dir);
                            e1 * PERTURBATION_TAN.0 + e2 * PERTURBATION_TAN.1
                        }
                    };
                    let n = ray.dir + perturbation;
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
                let along = plane.dir.dot(&ray.dir);
                let floor = search.tolerance.max(rounding(plane.point.magnitude()));
                // |q| − |z|. A gap that is NaN or infinite (a plane parallel to the ray) is not
                // stationary.
                let is_stationary = plane.depth / along - plane.depth <= floor;
                let is_lower = search.best.depth < plane.depth - floor;
                if is_stationary && !is_lower {
                    let hit = match &perturbed_from {
                        Some(first) if first.depth <= plane.depth => make_result(first, None),
                        _ => make_result(&plane, Some(&last)),
                    };
                    return Ok(Some(hit));
                }
                if is_lower { search.best } else { plane }
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
fn make_result(plane: &SupportPlane, portal: Option<&RayPortal>) -> Solution {
    let (point1, point2) = match portal {
        Some(p) => p.witnesses(),
        None => (plane.point.v1, plane.point.v2),
    };
    Solution {
        depth: plane.depth,
        dir: plane.dir,
        normal: plane.dir,
        point1,
        point2,
        is_general: plane.direction().is_general(),
        ..Solution::default()
    }
}

/// Evaluates the support plane along unit `dir`.
#[inline]
fn support_plane<D: Difference>(md: &D, dir: Vec3) -> Result<SupportPlane, Fault> {
    let point = md.support(&dir)?;
    let depth = dir.dot(&point.v);
    Ok(SupportPlane {
        dir,
        depth,
        point,
        tilt: 0.0,
    })
}

/// Returns whether a support plane separates the objects, or they touch it within the contact epsilon of its own point.
/// ([`Pair::prove_overlap`](crate::query::Pair::prove_overlap) tests that of the witness points only, which can be much
/// closer to the world's origin.)
#[inline]
fn is_separating(plane: &SupportPlane) -> bool {
    let mut scale = Scale::default();
    scale.note(&plane.point);
    !scale.is_depth(plane.depth)
}

/// A portal: three support points whose triangle the ray crosses.
#[derive(Clone, Copy)]
struct RayPortal {
    /// Unit direction of the ray.
    ray: Vec3,
    /// The support planes of v1, v2, v3, in the order in which the triangle's normal points
    /// along the ray.
    planes: [SupportPlane; 3],
}

impl RayPortal {
    /// Returns the outward unit normal of the triangle; `None` if it has no area.
    #[inline]
    fn normal(&self) -> Option<Vec3> {
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
    fn update(&mut self, w: SupportPlane) {
        let corners = self.planes.each_ref().map(|p| p.point.v);
        self.planes[choose_corner(corners, &self.ray, &w.point.v).min(2)] = w;
    }

    /// Returns the points of obj1 and obj2 whose difference is the point at which the ray crosses the
    /// triangle. Both are convex combinations of the objects' own support points.
    fn witnesses(&self) -> (Vec3, Vec3) {
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
fn rounding(size: f64) -> f64 {
    8.0 * EPSILON * size
}

/// Reason why the search along a ray ended.
enum RayEnd {
    /// The ray leaves D between the portal and this support plane, at most the tolerance apart.
    Converged(RayPortal, SupportPlane),
    /// The shortcut of Algorithm 5: the support value of this plane is at most the
    /// distance |p| to the portal along the ray.
    Shortcut(SupportPlane),
    /// The ray passes through its own support point and leaves D there: its direction is
    /// stationary.
    Vertex,
    /// The least support value is 0 within rounding.
    Touch,
    /// The iterations are used up, or rounding prevents a refinement.
    Limit,
}

/// The stop criterion of portal refinement.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// The bounds meet along the normal (Algorithm 1).
    Normal,
    /// The bounds meet along the normal, or the shortcut of Algorithm 5 applies.
    Shortcut,
}

/// The state of a search from ray to ray. A separating direction ends it ([`Stop::Separated`]).
struct RaySearch<'q, D> {
    /// The Minkowski difference.
    md: &'q D,
    /// The largest gap between the bounds, metres.
    tolerance: f64,
    /// The stop criterion.
    until: Until,
    /// For a D that lies in a plane, the unit normal of that plane.
    plane_normal: Option<Vec3>,
    /// The sizes of the points evaluated so far.
    scale: Scale,
    /// The iterations left.
    budget: u64,
    /// The support plane with the least support value so far, which may be a separating one.
    best: SupportPlane,
}

impl<D: Difference> RaySearch<'_, D> {
    /// Counts an iteration. Returns `false` if none was left.
    fn take_iteration(&mut self) -> bool {
        let left = self.budget > 0;
        self.budget = self.budget.saturating_sub(1);
        left
    }

    /// Evaluates the support plane with the unit normal `n`, for n = 2 in general position.
    ///
    /// # Errors
    /// [`Stop::Separated`] for a separating plane; [`Stop::Fault`] for a point that is not finite.
    #[inline]
    fn plane(&mut self, n: Vec3) -> Result<SupportPlane, Stop> {
        let plane = match self.plane_normal {
            Some(m) => self.tilted_plane(n, &m)?,
            None => support_plane(self.md, n)?,
        };
        if plane.depth < self.best.depth {
            self.best = plane;
        }
        if is_separating(&plane) {
            return Err(Stop::Separated(plane.direction()));
        }
        Ok(plane)
    }

    /// Evaluates unit `n`, turned into general position within the plane with unit normal `m`; as it is if the tolerance
    /// allows no tilt, or only n may separate.
    fn tilted_plane(&mut self, n: Vec3, m: &Vec3) -> Result<SupportPlane, Fault> {
        let rule = TiltRule {
            tolerance: self.tolerance,
            least: 0.0,
        };
        let dir = Direction::tilted_in_plane(&n, m, rule.tilt(&self.scale));
        let plane = SupportPlane {
            tilt: dir.tilt,
            ..support_plane(self.md, dir.n)?
        };
        self.scale.note(&plane.point);
        let may_separate = !self.scale.is_depth(n.dot(&plane.point.v));
        if may_separate && dir.is_general() && !is_separating(&plane) {
            let exact = support_plane(self.md, n)?;
            if exact.is_consistent(&plane, self.scale.tie_eps()) {
                return Ok(exact);
            }
        }
        Ok(plane)
    }

    /// Follows the ray along `first.dir` to the boundary of D, by Algorithm 1 or
    /// Algorithm 5 of the paper.
    fn follow(&mut self, first: &SupportPlane) -> Result<RayEnd, Stop> {
        let found = match self.plane_normal {
            Some(m) => self.find_segment(first, &m)?,
            None => self.find_portal(first)?,
        };
        match found {
            Ok(portal) => self.refine(portal),
            Err(exit) => Ok(exit),
        }
    }

    /// Finds a portal of the ray along `first.dir` (paper, Algorithm 1, find_portal; G. Snethen, "XenoCollide",
    /// Game Programming Gems 7). The inner `Err` is the reason if there is none. The point v0 = −d, scaled to the
    /// portal's size, takes the place of the interior point.
    fn find_portal(&mut self, first: &SupportPlane) -> Result<Result<RayPortal, RayEnd>, Stop> {
        let d = first.dir;
        if is_separating(first) {
            return Err(Stop::Separated(first.direction()));
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
        let mut portal = RayPortal {
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
        Ok(Err(RayEnd::Limit))
    }

    /// Finds a segment that the ray along `first.dir` crosses, in the plane with unit normal m. With side = m × d,
    /// side · v is negative for the left end and positive for the right one. The inner `Err` is the reason if there is
    /// none.
    fn find_segment(
        &mut self,
        first: &SupportPlane,
        m: &Vec3,
    ) -> Result<Result<RayPortal, RayEnd>, Stop> {
        if is_separating(first) {
            return Err(Stop::Separated(first.direction()));
        }
        let side = unit(&m.cross(&first.dir)).unwrap_or_else(|| perpendicular(m));
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
        Ok(Ok(RayPortal::segment(first.dir, left, right, m)))
    }

    /// Refines a portal: the loop of Algorithms 1 and 5.
    fn refine(&mut self, mut portal: RayPortal) -> Result<RayEnd, Stop> {
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
                    dir: n,
                    point: portal.planes[0].point,
                    depth: inner,
                    tilt: 0.0,
                },
                evaluated => evaluated?,
            };
            let gap = plane.depth - inner;
            // Converged: the gap is within the tolerance, and the origin is on the inner side of the
            // portal by more than rounding, so that the support plane does not exclude the origin.
            // NaN (a plane parallel to the ray) ends the loop too.
            if !(gap > floor) || (gap <= self.tolerance && inner > floor) {
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
                    portal = RayPortal::segment(portal.ray, left, right, m);
                }
            }
        }
        Ok(RayEnd::Limit)
    }
}

#[cfg(test)]
mod tests;
