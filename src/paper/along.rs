// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! How far obj2 must move along a given direction: where the ray from the origin leaves D
//! (paper, Algorithm 1), found by portal refinement, which the portal of the last query
//! may begin.
//!
//! The support plane that the ray meets is the upper bound. The portal is inscribed in D, so
//! where the ray crosses it is the lower bound, once the origin is known to be in D.

use crate::contact::{Penetration, Settings};
use crate::known::support_set::Stop;
use crate::math::Vec3;
use crate::minkowski::support::{MinkowskiDifference, SupportMap};
use crate::paper::incremental::answer;
use crate::paper::portal::{Exit, Portal, Search, SupportPlane, Until, rounding};

/// Follows the ray along unit `dir` to where it leaves D, as long as the origin is in D; `last` are the
/// normals of the portal to begin with. The answer with its lower bound, and the last portal, where
/// there was one.
///
/// # Errors
/// [`Stop::Apart`]; a callback's answer that is not finite.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    dir: &Vec3,
    last: Option<[Vec3; 3]>,
    settings: &Settings,
) -> Result<(Penetration, Option<Portal>), Stop> {
    let mut budget = settings.max_iterations;
    let (exit, first) = follow(md, dir, last, settings.tolerance, &mut budget)?;
    let (limit, portal, plane) = match exit {
        Exit::Converged(portal, plane) => (false, Some(portal), plane),
        Exit::Limit(portal) => (true, portal, nearest(dir, first, portal.as_ref())),
        Exit::Vertex | Exit::Touch | Exit::Shortcut(_) => (false, None, first),
    };
    let depth = plane.depth / dir.dot(&plane.normal);
    let (lower, error) = match &portal {
        Some(portal) => inscribed(dir, portal),
        None if matches!(exit, Exit::Vertex) => (depth, 0.0),
        None => (0.0, 0.0),
    };
    // `max` passes over NaN.
    let depth_lower = lower.max(0.0).min(depth);
    let hit = Penetration {
        depth,
        depth_lower,
        dir: *dir,
        iterations: settings.max_iterations - budget,
        // Where rounding ended the search the answer may yet be as good as asked for.
        limit: limit && !(depth - depth_lower <= settings.tolerance.max(2.0 * error)),
        ..answer(&plane, portal.as_ref().filter(|_| !limit))
    };
    Ok((hit, portal))
}

/// After the cap, or a portal without area: every support plane is sound, and the one that
/// the ray meets first is the best of them.
fn nearest(dir: &Vec3, first: SupportPlane, portal: Option<&Portal>) -> SupportPlane {
    let reach = |p: &SupportPlane| p.depth / dir.dot(&p.normal);
    let mut best = first;
    for p in portal.iter().flat_map(|p| &p.planes) {
        if dir.dot(&p.normal) > 0.0 && reach(p) < reach(&best) {
            best = *p;
        }
    }
    best
}

/// Where the ray crosses the portal less its error, and that error, metres.
fn inscribed(dir: &Vec3, portal: &Portal) -> (f64, f64) {
    let largest = |m: f64, plane: &SupportPlane| m.max(plane.point.magnitude());
    let size = portal.planes.iter().fold(0.0, largest);
    portal.normal().map_or((0.0, 0.0), |n| {
        let error = rounding(size) / n.dot(dir);
        (portal.reach() - error, error)
    })
}

/// The exit, and the first support plane.
fn follow<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    dir: &Vec3,
    last: Option<[Vec3; 3]>,
    tolerance: f64,
    budget: &mut u64,
) -> Result<(Exit, SupportPlane), Stop> {
    let first = SupportPlane::of(md, last.map_or(*dir, |[a, _, _]| a))?;
    let mut search = Search {
        md,
        tolerance,
        until: Until::Ray,
        flat: None,
        budget: *budget,
        best: first,
    };
    // The last portal, found again by its three directions.
    if let Some([_, b, c]) = last {
        if first.depth < 0.0 {
            return Err(Stop::Apart(first.normal));
        }
        let planes = [first, search.plane(b)?, search.plane(c)?];
        if let Some(portal) = Portal::of(*dir, planes) {
            let exit = search.refine(portal)?;
            *budget = search.budget;
            if matches!(exit, Exit::Converged(..)) {
                return Ok((exit, first));
            }
        }
        return follow(md, dir, None, tolerance, budget);
    }
    let exit = search.follow(&first)?;
    *budget = search.budget;
    Ok((exit, first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Rotation, ellipsoid};

    /// On an ellipsoid around the origin the ray along d leaves at 1 / |d / radii|; the
    /// bounds hold it, cold and from the portal that the last query left.
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
            let md = MinkowskiDifference::new(support, |_: &Vec3| Vec3::zeros());
            let mut last = None;
            for _ in 0..2 {
                let (hit, portal) =
                    penetration(&md, &d, last, &settings).expect("the origin is inside");
                let slack = 100.0 * EPSILON;
                assert!(hit.depth >= exact - slack && hit.depth_lower <= exact + slack);
                assert!(!hit.limit && hit.depth - hit.depth_lower <= 2e-4);
                last = portal.map(|p| p.planes.map(|plane| plane.normal));
            }
        }
    }
}
