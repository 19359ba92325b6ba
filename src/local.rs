// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's penetration depth: sequential quadratic programming over portal
//! refinement (Sec. III, Algorithms 3, 4 and 5).
//!
//! The depth is the least |v| over the boundary of D. At a boundary point with
//! outward normal n the constraint "outside D" is linearised by the support plane
//! of n, and the nearest point of that plane to the origin is z = h(n) n: so one
//! step goes from the ray d, which leaves D through a face of normal n
//! ([`portal::mpr`]), to the ray n. Since the ray n leaves D at or before z,
//! |z| falls strictly from step to step until d and n agree within the tolerance:
//! |q| − |z| ≤ tolerance, q the point where the ray meets the last support plane.
//!
//! With the shortcut (Algorithms 4 and 5) the ray is left as soon as the plane
//! found is at least as near as the portal: |z| ≤ |p|. Then the ray d cannot end
//! nearer than |z|, and the argument holds unchanged.
//!
//! Departures from the published implementation. The answer is the plane (n, h(n))
//! of the least support value seen, not the ray: sound, at no support more. A ray
//! through its own support point is stationary, yet may be a maximum (a vertex of
//! D) or a saddle: the search steps aside once and goes on. Planes below the last
//! one, met on the way in another valley, are searched as well.

use crate::contact::{Answer, Penetration, Settings};
use crate::math::{Real, Vec3, perpendicular, unit};
use crate::portal::{self, Exit, Plane, Portal, rounding};
use crate::support::{Fault, MinkowskiDifference, SupportMap};

/// When a ray may be left before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortcut {
    /// Never: Algorithm 3.
    Never,
    /// Whenever |z| ≤ |p|: Algorithms 4 and 5.
    Always,
    /// Not on the first ray, whose end is libccd's answer when it starts from the
    /// centres; whenever |z| ≤ |p| after it.
    AfterFirstRay,
}

/// A step aside from a stationary direction: tan of about 6°, small enough to stay
/// in the valley, large enough to see a slope. The two parts have no simple ratio,
/// so that no symmetry of a shape hides the slope.
const ASIDE: (Real, Real) = (0.093, 0.041);

/// A local minimum of the penetration depth, searched from the unit direction
/// `start`. `switched` is told |z| at each switch of the ray.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: Vec3,
    shortcut: Shortcut,
    settings: &Settings,
    mut switched: impl FnMut(Real),
) -> Result<Answer, Fault> {
    let mut budget = settings.max_iterations;
    let mut ray = Plane::of(md, start)?;
    let mut best = ray;
    let mut may_leave = shortcut == Shortcut::Always;
    let mut stepped_aside = false;
    // A portal that the ray `best.normal` crosses, for the witness points.
    let mut portal: Option<Portal> = None;
    let finish = |best: Plane, portal: Option<Portal>, budget: u64| {
        let (point1, point2) = match portal {
            Some(p) => p.witnesses(),
            None => (best.point.v1, best.point.v2),
        };
        Penetration {
            depth: best.depth,
            depth_lower: 0.0,
            dir: best.normal,
            normal: best.normal,
            point1,
            point2,
            iterations: settings.max_iterations - budget,
        }
    };
    loop {
        let exit = portal::mpr(
            md,
            &ray,
            settings.tolerance,
            may_leave,
            &mut best,
            &mut budget,
        )?;
        let next = match exit {
            Exit::Miss(n) => return Ok(Answer::Miss(n)),
            Exit::Touch => return Ok(Answer::Hit(finish(best, None, budget))),
            Exit::Limit(last) => {
                let last = last.filter(|p| p.ray == best.normal);
                return Ok(Answer::Limit(finish(best, last.or(portal), budget)));
            }
            Exit::Shortcut(plane) => plane,
            Exit::Vertex if !stepped_aside => {
                stepped_aside = true;
                let e1 = perpendicular(&ray.normal);
                let e2 = ray.normal.cross(&e1);
                match unit(&(ray.normal + e1 * ASIDE.0 + e2 * ASIDE.1)) {
                    Some(n) => Plane::of(md, n)?,
                    None => return Ok(Answer::Hit(finish(best, None, budget))),
                }
            }
            Exit::Vertex => {
                // Stationary again: as good as it gets, unless a plane seen on the
                // way lies in a lower valley.
                if !(best.depth < ray.depth - settings.tolerance) {
                    return Ok(Answer::Hit(finish(best, portal, budget)));
                }
                best
            }
            Exit::Converged(last, plane) => {
                let along = plane.normal.dot(&ray.normal);
                let floor = settings.tolerance.max(rounding(plane.point.magnitude()));
                // |q| − |z|; NaN and a plane that holds the ray go on to the next
                // ray only while the best plane falls.
                let stationary = plane.depth / along - plane.depth <= floor;
                let lower_elsewhere = best.depth < plane.depth - floor;
                if stationary && !lower_elsewhere {
                    return Ok(Answer::Hit(finish(best, Some(last), budget)));
                }
                portal = Some(last);
                if lower_elsewhere { best } else { plane }
            }
        };
        may_leave = shortcut != Shortcut::Never;
        if budget == 0 {
            return Ok(Answer::Limit(finish(best, portal, budget)));
        }
        budget -= 1;
        switched(next.depth);
        ray = next;
    }
}
