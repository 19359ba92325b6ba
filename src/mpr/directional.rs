// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The penetration depth along a direction.
//!
//! [`along`]: the origin ray of W. Gao, Algorithm 1, followed to where it leaves D. The support plane that the ray meets first is the upper bound; where it crosses the
//! portal, which is inscribed in D, less the rounding, is the lower bound once the origin is known to be in D.
//!
//! Departures: those of [`gao`]. The bounds are measured along the ray.
//!
//! Validity. `limit` is set wherever the bounds of [`along`] are farther apart than the tolerance in force,
//! whatever ended the search. The overlap is not proven here.

use crate::contact::{Penetration, Settings};
use crate::math::Vec3;
use crate::minkowski::query::Stop;
use crate::minkowski::support::{MinkowskiDifference, SupportMap};
use crate::mpr::gao::{Portal, RayEnd, RaySearch, SupportPlane, Until, answer, rounding};

/// Follows the ray along unit `dir` to where it leaves D, as long as the origin is in D. Returns the
/// answer with its lower bound, and the last portal, where there was one.
///
/// # Errors
/// [`Stop::Separated`]; a callback's answer that is not finite.
pub fn along<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    dir: &Vec3,
    settings: &Settings,
) -> Result<(Penetration, Option<Portal>), Stop> {
    let mut budget = settings.max_iterations;
    let first = SupportPlane::of(md, *dir)?;
    let mut search = RaySearch {
        md,
        tolerance: settings.tolerance,
        until: Until::Ray,
        plane_normal: None,
        budget,
        best: first,
    };
    let end = search.follow(&first)?;
    budget = search.budget;
    let (portal, plane) = match end {
        RayEnd::Converged(portal, plane) => (Some(portal), plane),
        RayEnd::Limit(portal) => (portal, first),
        RayEnd::Vertex | RayEnd::Touch | RayEnd::Shortcut(_) => (None, first),
    };
    let plane = first_met(dir, plane, portal.as_ref());
    let depth = plane.depth / dir.dot(&plane.normal);
    let lower = match &portal {
        Some(portal) => inscribed(dir, portal),
        None if matches!(end, RayEnd::Vertex) => depth,
        None => 0.0,
    };
    // `max` passes over NaN.
    let depth_lower = lower.max(0.0).min(depth);
    // The finest tolerance in force: what a portal that faces the ray rounds by.
    let floor = FLOOR_ROUNDINGS * rounding(plane.point.magnitude());
    let hit = Penetration {
        depth,
        depth_lower,
        dir: *dir,
        iterations: settings.max_iterations - budget,
        // Negated for NaN.
        limit: !(depth - depth_lower <= settings.tolerance.max(floor)),
        ..answer(&plane, portal.as_ref())
    };
    Ok((hit, portal))
}

/// The finest tolerance in force, in units of the rounding of a support point.
const FLOOR_ROUNDINGS: f64 = 8.0;

/// Returns the support plane that the ray meets first, of `plane` and those of the portal: all are sound.
fn first_met(dir: &Vec3, plane: SupportPlane, portal: Option<&Portal>) -> SupportPlane {
    let ray_parameter = |p: &SupportPlane| p.depth / dir.dot(&p.normal);
    let mut best = plane;
    for p in portal.iter().flat_map(|p| &p.planes) {
        if dir.dot(&p.normal) > 0.0 && ray_parameter(p) < ray_parameter(&best) {
            best = *p;
        }
    }
    best
}

/// Returns where the ray crosses the portal, less the rounding, metres.
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

    /// On an ellipsoid around the origin the ray along d leaves at 1 / |d / radii|; the
    /// bounds hold it, from every direction.
    #[test]
    fn the_bounds_hold_where_the_ray_leaves() {
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
                assert!(!hit.limit && hit.depth - hit.depth_lower <= 2e-4);
            }
        }
    }

    /// Cones and cylinders nearly coincident, along grazing directions, at tolerance 0: no answer within the tolerance
    /// has its bounds farther apart, and the depth is that of the least plane nearby.
    #[test]
    fn open_bounds_are_told() {
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
            closed += u32::from(!hit.limit);
            assert!(hit.limit || hit.depth - hit.depth_lower <= 256.0 * EPSILON);
            let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v) / hit.normal.dot(&d);
            assert!((h - hit.depth).abs() <= 64.0 * EPSILON);
        }
        assert!(closed > 0);
    }
}
