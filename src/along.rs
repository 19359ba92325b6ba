// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The penetration depth along a direction: the distance at which a ray from the origin leaves D.
//!
//! Reference: G. Snethen, W. Gao, see [`crate::portal`]. Here the ray starts at the origin, not at an interior point.
//!
//! Terms. The *parameter* of a plane is the distance from the origin at which the ray crosses it. The upper bound is
//! the least parameter of a support plane, the *exit plane*. The lower bound is the parameter of the portal, which is
//! inscribed in D, less rounding; it is valid once the origin is known to be in D.
//!
//! 1. *Vertex*: evaluate the direction of the ray. If its support point is on the ray, the ray leaves D there.
//! 2. *Discovery*: find a portal of the ray ([`discover`]).
//! 3. *Refinement*: replace a corner by the known difference farthest above the portal, without a callback. If none is
//!    far enough above, evaluate the normal of the portal. Ends if the bounds meet within the tolerance, or if no point
//!    is above the portal.
//!
//! Departures. Directions are evaluated in general position ([`general_position`](crate::minkowski::general_position)).
//! A tilt moves the parameter of a plane that is nearly parallel to the ray by more, so normals of the portal are tilted
//! by less the larger their angle to the ray. The ray itself keeps the caller's direction.
//!
//! Outputs. The bounds are valid for any status if the origin is in D, which is not proven here. [`Status::Converged`]: they
//! differ by at most the tolerance, along the ray.

use crate::epa::buffers::MAX_PROVEN_POINTS;
use crate::geometry::barycentric;
use crate::math::{Vec3, larger, lesser, normal};
use crate::minkowski::support::{self, Difference};
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery};
use crate::minkowski::tuning::INSERT_HEIGHT_GAPS;
use crate::minkowski::vertex_set::VertexSet;
use crate::portal::{Exact, NearRay, Portal, PortalPlane, discover};
use crate::trace;
use crate::types::{Direction, Settings, Solution, Status};

/// The smallest effective tolerance, in rounding errors of a height: twice the least gap of a portal that is
/// perpendicular to the ray.
const MIN_TOLERANCE_ROUNDINGS: f64 = 4.0;

/// The search along a ray.
struct Ray<'r, 'q, D, const N: usize> {
    query: SupportQuery<'q, D>,
    set: &'r mut VertexSet<N>,
    /// Unit.
    dir: Vec3,
    /// The support plane with the least parameter so far: the upper bound.
    exit_plane: SupportPlane,
    settings: &'r Settings,
    /// The number of support points after the discovery.
    iterations: u64,
}

/// Follows the ray along unit `dir` to the boundary of D, in at most [`MAX_PROVEN_POINTS`] iterations. Requires the
/// origin in D, which is not tested. The set must be empty; it then holds the corners of the last portal.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
pub fn depth_along<D: Difference, const N: usize>(
    md: &D,
    set: &mut VertexSet<N>,
    dir: &Vec3,
    settings: &Settings,
) -> Result<Solution, Stop> {
    trace::stage("ray");
    let mut query = SupportQuery::new(md, None, settings.tolerance);
    let first = query.evaluate_first(&Direction::exact(*dir))?;
    set.push(&query.upper.dir, &first);
    let corners = [set.farthest_vertex(dir); 3];
    let mut portal = Portal { corners };
    let mut ray = Ray {
        exit_plane: query.upper,
        query,
        set,
        dir: *dir,
        settings,
        iterations: 0,
    };
    let off = first.v - dir * dir.dot(&first.v);
    // If the support point is on the ray, the ray leaves D there: the bounds meet.
    let lower = if off.norm() > ray.query.scale.height_eps() {
        ray.find_lower_bound(&mut portal)?
    } else {
        ray.upper()
    };
    ray.query.upper = ray.exit_plane;
    ray.query.confirm_upper()?;
    Ok(ray.result(&portal, lower))
}

impl<D: Difference, const N: usize> Ray<'_, '_, D, N> {
    /// Returns the upper bound, metres.
    fn upper(&self) -> f64 {
        self.exit_plane.depth / self.dir.dot(&self.exit_plane.dir)
    }

    /// Returns the effective tolerance, metres.
    fn tolerance(&self) -> f64 {
        let scale = &self.query.scale;
        let least = MIN_TOLERANCE_ROUNDINGS * scale.height_eps();
        larger(least, scale.tolerance(self.settings.tolerance))
    }

    /// Returns the number of iterations that are left.
    fn budget(&self) -> u64 {
        let most = self.settings.max_iterations.min(MAX_PROVEN_POINTS);
        most - self.iterations
    }

    /// Finds a portal and refines it. Returns the lower bound, metres; 0 if there is no portal.
    fn find_lower_bound(&mut self, portal: &mut Portal) -> Result<f64, Stop> {
        let (length, tolerance) = (self.upper(), self.tolerance());
        let found = discover(
            &mut self.query,
            self.set,
            &self.dir,
            length,
            f64::INFINITY,
            0.5 * tolerance * length,
            NearRay::Perpendicular,
        )?;
        self.note_planes(0);
        let Some(found) = found else {
            return Ok(0.0);
        };
        trace::stage("ray");
        *portal = found;
        let mut lower = 0.0;
        loop {
            let (dir, tolerance) = (self.dir, self.tolerance());
            let rounding = self.query.scale.height_eps();
            let level = |plane: &PortalPlane| {
                let along = plane.normal.dot(&dir);
                Some(INSERT_HEIGHT_GAPS * tolerance * along + rounding * plane.length)
            };
            let climbed = portal.climb(self.set, &dir, Exact::Crossing, level);
            let Some(plane) = climbed
                .and_then(|plane| plane.unit())
                .filter(|plane| plane.normal.dot(&dir) > 0.0)
            else {
                return Ok(lower);
            };
            let along = plane.normal.dot(&dir);
            // The corners are on the plane within rounding: take the lowest.
            let [a, b, c] = portal.points().map(|v| plane.normal.dot(&v));
            let offset = lesser(lesser(a, b), c);
            lower = larger((offset - rounding) / along, lower);
            trace::lower_bound(lower);
            if self.upper() - lower <= tolerance || self.budget() == 0 {
                return Ok(lower);
            }
            self.iterations += 1;
            self.set.make_room(&mut portal.corners);
            self.query.tilt_rule.tolerance = self.settings.tolerance * along;
            let sample = self.query.evaluate(self.set, &plane.normal)?;
            self.note_planes(self.set.len() - 1);
            if !(plane.normal.dot(&sample.w) - offset > rounding) {
                return Ok(lower);
            }
            portal.replace_corner(&dir, sample.vertex(), Exact::Crossing);
        }
    }

    /// Updates the exit plane: of it and the planes of the entries from index `first` on, takes the one with the least
    /// parameter.
    fn note_planes(&mut self, first: usize) {
        for k in first..self.set.len() {
            let plane = self.query.plane(self.set, k);
            if plane.depth < self.upper() * self.dir.dot(&plane.dir) {
                self.exit_plane = plane;
            }
        }
    }

    /// Returns the result for a lower bound, metres. The witness points are those of the point of the portal at which
    /// the ray crosses it.
    fn result(&self, portal: &Portal, lower: f64) -> Solution {
        let (depth, max_iterations) = (self.upper(), self.settings.max_iterations);
        let status = Status::of_early_end(self.budget(), max_iterations, MAX_PROVEN_POINTS);
        let [a, b, c] = portal.points();
        let n = normal(&a, &b, &c);
        // Without a portal the parameter is NaN.
        let crossing = larger(lesser(n.dot(&a) / n.dot(&self.dir), depth), 0.0);
        let weights = barycentric::triangle(&(self.dir * crossing), &a, &b, &c).weights;
        let corners = portal.corners.map(|v| self.set.point(v.pair));
        let (point1, point2) = support::witnesses(&weights, corners.each_ref());
        Solution {
            depth,
            depth_lower: lesser(larger(lower, 0.0), depth),
            dir: self.dir,
            normal: self.exit_plane.dir,
            is_general: self.exit_plane.direction().is_general(),
            point1,
            point2,
            iterations: self.iterations,
            status: status.unless(depth - lower <= self.tolerance()),
            ..Solution::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::minkowski::support::{MinkowskiDifference, SupportMap};
    use crate::test_shapes::{
        Random, Rotation, Shape, ball, corners, difference, ellipsoid, hull, placed,
    };

    const ULPS: f64 = 256.0 * EPSILON;

    type Body<'a> = MinkowskiDifference<Shape<'a>, Shape<'a>>;

    /// Returns a D that is this shape.
    fn alone<'a>(shape: impl SupportMap + 'a) -> Body<'a> {
        difference(shape, |_: &Vec3| Vec3::zeros())
    }

    fn along(md: &Body, dir: &Vec3, tolerance: f64, max_iterations: u64) -> Solution {
        let settings = Settings {
            max_iterations,
            ..Settings::new(tolerance)
        };
        let mut set = VertexSet::<16>::EMPTY;
        depth_along(md, &mut set, dir, &settings).expect("the origin is inside")
    }

    /// Checks the bounds of a hit against the distance `exact` at which the ray leaves D; that the depth is the parameter
    /// of the support plane of `normal`; and that the witness points are on the ray.
    fn check(md: &Body, hit: &Solution, exact: f64, tolerance: f64) {
        let gap = hit.depth - hit.depth_lower;
        assert!(
            hit.depth >= exact - ULPS && hit.depth_lower <= exact + ULPS,
            "{exact} {hit:?}"
        );
        assert!(
            hit.status != Status::Converged || gap <= tolerance + ULPS,
            "{hit:?}"
        );
        let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v) / hit.normal.dot(&hit.dir);
        assert!((h - hit.depth).abs() <= ULPS, "{h} {hit:?}");
        let w = hit.point1 - hit.point2;
        let off = (w - hit.dir * w.dot(&hit.dir)).norm();
        assert!(off <= 1e-6_f64.max(ULPS) * exact, "{off} {hit:?}");
    }

    /// Returns the number of support points of a query.
    fn follow(shape: impl SupportMap, dir: &Vec3, exact: f64, tolerance: f64) -> u64 {
        let md = alone(shape);
        let hit = along(&md, dir, tolerance, 1000);
        check(&md, &hit, exact, tolerance);
        assert!(
            hit.status == Status::Converged || tolerance == 0.0,
            "{hit:?}"
        );
        md.supports()
    }

    /// The tolerances of the tests, metres.
    fn tolerances() -> impl Iterator<Item = f64> {
        [1e-3, 1e-6, 1e-10, 0.0]
            .into_iter()
            .filter(|t| EPSILON < 1e-10 || *t >= 1e-3)
    }

    /// The ray along d leaves an ellipsoid about the origin at 1 / |d / radii|.
    #[test]
    fn the_ray_leaves_an_ellipsoid() {
        let mut r = Random::new(1);
        for (tolerance, most) in tolerances().zip([30, 40, 60, 80]) {
            for _ in 0..300 {
                let radii = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
                let d = r.direction();
                let exact = 1.0 / d.component_div(&radii).norm();
                let shape = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
                let count = follow(shape, &d, exact, tolerance);
                assert!(count <= most, "{count}");
            }
        }
    }

    /// Rays in any direction from points close below the surface: x is the start and y the direction where the ellipsoid
    /// is the unit ball, so that |x + t y| = 1. The discovery of one in 400 takes more points than the set holds.
    #[test]
    fn the_ray_leaves_an_ellipsoid_from_close_below_its_surface() {
        let mut r = Random::new(5);
        let (tolerance, deepest) = if EPSILON < 1e-10 {
            (1e-6, -10.0)
        } else {
            (1e-3, -4.0)
        };
        for _ in 0..3000 {
            let radii = Vec3::from_fn(|_, _| r.within(0.2, 1.0));
            let x = r.direction() * (1.0 - 10.0_f64.powf(r.within(deepest, -3.0)));
            let turn = r.rotation();
            let d = r.direction();
            let y = (turn.inverse() * d).component_div(&radii);
            let (a, b, c) = (y.norm_squared(), x.dot(&y), x.norm_squared() - 1.0);
            let root = (b * b - a * c).sqrt();
            let exact = if b > 0.0 {
                -c / (b + root)
            } else {
                (root - b) / a
            };
            let shape = ellipsoid(radii, turn, turn * -x.component_mul(&radii));
            let hit = along(&alone(shape), &d, tolerance, 1000);
            assert_eq!(hit.status, Status::Converged, "{exact} {hit:?}");
            let error = hit.depth - exact;
            let noise = 1e6 * EPSILON;
            assert!(
                -noise <= error && error <= tolerance + noise,
                "{exact} {hit:?}"
            );
        }
    }

    /// Rays in any direction, and closer to an edge or to a corner than the tolerance.
    #[test]
    fn the_ray_leaves_a_box() {
        let mut r = Random::new(2);
        for tolerance in tolerances() {
            for round in 0..900 {
                let half = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
                let at = half.map(|h| r.within(-0.9, 0.9) * h);
                let exponent = r.within(-16.0, -1.0);
                let near = r.vector(10.0_f64.powf(exponent));
                let d = match round % 3 {
                    0 => r.direction(),
                    1 => half + at + near,
                    _ => half.component_mul(&Vec3::new(1.0, 1.0, r.within(-1.0, 1.0))) + at + near,
                };
                let d = d.normalize();
                let exact = (0..3).fold(f64::INFINITY, |t, i| {
                    t.min(((half[i].copysign(d[i]) + at[i]) / d[i]).max(0.0))
                });
                let turn = r.rotation();
                let points = placed(&corners(half), &turn, turn * at);
                let count = follow(hull(&points), &(turn * d), exact, tolerance);
                // One to confirm a direction that the tolerance does not allow to be tilted.
                let most = if tolerance < 1e-9 { 12 } else { 11 };
                assert!(count <= most, "{count}");
            }
        }
    }

    /// Rays in any direction, and close to the rim: the portals there are slivers.
    #[test]
    fn the_ray_leaves_a_cylinder() {
        let mut r = Random::new(3);
        for tolerance in tolerances() {
            for round in 0..1000 {
                let (radius, half) = (r.within(0.3, 2.0), r.within(0.3, 2.0));
                let turn = r.rotation();
                let disc = move |n: &Vec3| {
                    let across = n.xy().norm();
                    let end = Vec3::z() * half.copysign(n.z);
                    let scale = if across > 0.0 { radius / across } else { 0.0 };
                    Vec3::new(n.x * scale, n.y * scale, end.z)
                };
                let d = if round % 2 == 0 {
                    r.direction()
                } else {
                    let angle = r.within(0.0, 6.3);
                    let rim = Vec3::new(radius * angle.cos(), radius * angle.sin(), half);
                    let exponent = r.within(-16.0, -1.0);
                    (rim + r.vector(10.0_f64.powf(exponent))).normalize()
                };
                let exact = (radius / d.xy().norm()).min(half / d.z.abs());
                let turned = move |n: &Vec3| turn * disc(&(turn.inverse() * n));
                let count = follow(turned, &(turn * d), exact, tolerance);
                assert!(count <= 60, "{count}");
            }
        }
    }

    /// Nearly coincident cylinders, along directions nearly perpendicular to the axis, at tolerance 0: the status is not
    /// converged if the bounds have not met.
    #[test]
    fn unmet_bounds_are_not_converged() {
        let mut r = Random::new(2);
        let mut closed = 0;
        for _ in 0..300 {
            let disc = |n: &Vec3| {
                let across = n.xy().norm();
                let scale = if across > 0.0 { 0.86 / across } else { 0.0 };
                Vec3::new(n.x * scale, n.y * scale, 0.3_f64.copysign(n.z))
            };
            let (turn, at) = (r.rotation(), r.vector(1e-15));
            let turned = move |n: &Vec3| turn * disc(&(turn.inverse() * n));
            let md = difference(turned, move |n: &Vec3| turned(n) + at);
            let d = turn * (Vec3::x() + r.vector(1e-3)).normalize();
            let hit = along(&md, &d, 0.0, 340);
            closed += u32::from(hit.status == Status::Converged);
            check(&md, &hit, hit.depth, 0.0);
        }
        assert!(closed > 0);
    }

    #[test]
    fn an_origin_outside_is_separated() {
        let mut r = Random::new(3);
        let settings = Settings {
            max_iterations: 1000,
            ..Settings::new(1e-6)
        };
        for _ in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let way = r.direction();
            let md = alone(hull(&placed(&corners(half), &r.rotation(), way * 3.0)));
            let mut set = VertexSet::<16>::EMPTY;
            match depth_along(&md, &mut set, &-way, &settings) {
                Err(Stop::Separated(Direction { n, .. })) => {
                    assert!(n.dot(&md.support(&n).unwrap().v) <= 0.0)
                }
                found => panic!("{found:?}"),
            }
        }
    }

    #[test]
    fn limits_are_kept_and_reported() {
        let mut r = Random::new(4);
        // In single precision the bounds meet after 13.
        for limit in 0..if EPSILON < 1e-10 { 20 } else { 10 } {
            let md = alone(ellipsoid(
                Vec3::new(1.0, 0.7, 0.5),
                r.rotation(),
                Vec3::zeros(),
            ));
            let hit = along(&md, &r.direction(), 0.0, limit);
            assert_eq!(
                (hit.status, hit.iterations),
                (Status::IterationLimit, limit)
            );
        }
        let md = alone(ball(Vec3::x() * 0.1, 1.0));
        let hit = along(&md, &Vec3::x(), 0.0, 0);
        assert_eq!((hit.status, hit.depth), (Status::Converged, 1.1));
    }
}
