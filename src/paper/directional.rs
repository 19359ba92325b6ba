// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The penetration depth along a direction.
//!
//! [`along`] follows the given ray to the boundary of D (W. Gao, 2023, Algorithm 1, see [`crate::paper::gao`]). Upper
//! bound: the first support plane on the ray. Lower bound: the intersection of the ray and the portal, which is
//! inscribed in D, minus the rounding error; it is valid once the origin is known to be in D.
//!
//! Departures: those of [`crate::paper::gao`]. The bounds are measured along the ray.
//!
//! Outputs. `status`: converged if the bounds differ by at most the effective tolerance, whatever ended the search. The
//! overlap is not proven here.

use crate::epa::buffers::MAX_PROVEN_POINTS;
use crate::math::Vec3;
use crate::minkowski::support::{MinkowskiDifference, SupportMap};
use crate::minkowski::support_query::{Stop, SupportPlane};
use crate::paper::gao::{Portal, RayEnd, RaySearch, Until, make_result, rounding, support_plane};
use crate::types::{Penetration, Settings, Status};

/// Follows the ray along unit `dir` to the boundary of D, in at most [`MAX_PROVEN_POINTS`] iterations. Requires the
/// origin in D, which is not tested. Returns the result with its lower bound, and the last portal if there was one.
///
/// # Errors
/// [`Stop::Separated`]; [`Stop::Fault`] for a point that is not finite.
pub fn along<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    dir: &Vec3,
    settings: &Settings,
) -> Result<(Penetration, Option<Portal>), Stop> {
    let budget = settings.max_iterations.min(MAX_PROVEN_POINTS);
    let first = support_plane(md, *dir)?;
    let mut search = RaySearch {
        md,
        tolerance: settings.tolerance,
        until: Until::Ray,
        plane_normal: None,
        budget,
        best: first,
    };
    let end = search.follow(&first)?;
    let (portal, plane) = match end {
        RayEnd::Converged(portal, plane) => (Some(portal), plane),
        RayEnd::Limit(portal) => (portal, first),
        RayEnd::Vertex | RayEnd::Touch | RayEnd::Shortcut(_) => (None, first),
    };
    let plane = first_met(dir, plane, portal.as_ref());
    let depth = plane.depth / dir.dot(&plane.dir);
    let lower = match &portal {
        Some(portal) => inscribed(dir, portal),
        None if matches!(end, RayEnd::Vertex) => depth,
        None => 0.0,
    };
    // `max` passes over NaN.
    let depth_lower = lower.max(0.0).min(depth);
    // The smallest effective tolerance: the rounding error for a portal perpendicular to the ray.
    let floor = FLOOR_ROUNDINGS * rounding(plane.point.magnitude());
    let status = Status::of_early_end(search.budget, settings.max_iterations, MAX_PROVEN_POINTS)
        .unless(depth - depth_lower <= settings.tolerance.max(floor));
    let hit = Penetration {
        depth,
        depth_lower,
        dir: *dir,
        iterations: budget - search.budget,
        status,
        ..make_result(&plane, portal.as_ref())
    };
    Ok((hit, portal))
}

/// The smallest effective tolerance, in units of the rounding error of a support point.
const FLOOR_ROUNDINGS: f64 = 8.0;

/// Returns the first of the support planes on the ray, among `plane` and those of the portal. All of them are sound
/// upper bounds.
fn first_met(dir: &Vec3, plane: SupportPlane, portal: Option<&Portal>) -> SupportPlane {
    let ray_parameter = |p: &SupportPlane| p.depth / dir.dot(&p.dir);
    let mut best = plane;
    for p in portal.iter().flat_map(|p| &p.planes) {
        if dir.dot(&p.dir) > 0.0 && ray_parameter(p) < ray_parameter(&best) {
            best = *p;
        }
    }
    best
}

/// Returns the distance along the ray to the portal minus the rounding error, metres: a lower bound of the depth.
fn inscribed(dir: &Vec3, portal: &Portal) -> f64 {
    let size = (portal.planes.iter()).fold(0.0, |m: f64, plane| m.max(plane.point.magnitude()));
    portal.normal().map_or(0.0, |n| {
        portal.ray_parameter() - rounding(size) / n.dot(dir)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Rotation, difference, ellipsoid};

    /// The ray along d leaves an ellipsoid about the origin at 1 / |d / radii|: the bounds enclose that distance, for
    /// every direction.
    #[test]
    fn the_bounds_enclose_the_exit_of_the_ray() {
        let mut r = Random::new(1);
        let settings = Settings {
            tolerance: 1e-4,
            max_iterations: 1000,
        };
        for _ in 0..300 {
            let radii = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
            let d = r.direction();
            let exact = 1.0 / d.component_div(&radii).norm();
            let support = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
            let md = difference(support, |_: &Vec3| Vec3::zeros());
            for _ in 0..2 {
                let (hit, _) = along(&md, &d, &settings).expect("the origin is inside");
                let slack = 100.0 * EPSILON;
                assert!(hit.depth >= exact - slack && hit.depth_lower <= exact + slack);
                assert_eq!(hit.status, Status::Converged);
                assert!(hit.depth - hit.depth_lower <= 2e-4);
            }
        }
    }

    /// Nearly coincident cylinders, along directions nearly perpendicular to the axis, at tolerance 0: the
    /// status is not converged if the bounds have not met, and the depth is that of the support plane of `normal`.
    #[test]
    fn unmet_bounds_are_not_converged() {
        let mut r = Random::new(2);
        let settings = Settings {
            tolerance: 0.0,
            max_iterations: 340,
        };
        let mut closed = 0;
        for _ in 0..300 {
            let disc = |n: &Vec3| {
                let r = n.x.hypot(n.y);
                let z = 0.3_f64.copysign(n.z);
                if r > 0.0 {
                    Vec3::new(n.x / r * 0.86, n.y / r * 0.86, z)
                } else {
                    Vec3::z() * z
                }
            };
            let (turn, at) = (r.rotation(), r.vector(1e-15));
            let turned = move |n: &Vec3| turn * disc(&(turn.inverse() * n));
            let other = move |n: &Vec3| turned(n) + at;
            let md = difference(turned, other);
            let d = turn * (Vec3::x() + r.vector(1e-3)).normalize();
            let Ok((hit, _)) = along(&md, &d, &settings) else {
                panic!("the centers coincide");
            };
            let is_converged = hit.status == Status::Converged;
            closed += u32::from(is_converged);
            assert!(!is_converged || hit.depth - hit.depth_lower <= 256.0 * EPSILON);
            let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v) / hit.normal.dot(&d);
            assert!((h - hit.depth).abs() <= 64.0 * EPSILON);
        }
        assert!(closed > 0);
    }
}
