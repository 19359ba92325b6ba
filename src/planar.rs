// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's method in the plane (n = 2 in Sec. II-A): the portal is a segment.
//!
//! For shapes that lie in a common plane, D lies in the plane through the origin with
//! the same normal m, and so do all directions asked for here. With
//! T(a, b) = m · (a × b), the segment from v1 to v2 is a portal of the ray d when d
//! lies between them: T(v1, d) ≥ 0 and T(d, v2) ≥ 0. Its outward normal is
//! (v2 − v1) × m. A new support point replaces the end on its own side of the ray.
//! The loop is that of [`crate::local`], with the shortcut (Algorithms 4 and 5).

use crate::contact::{Answer, Penetration, Settings};
use crate::math::{Real, Vec3, unit};
use crate::portal::{Plane, rounding};
use crate::support::{Fault, MinkowskiDifference, SupportMap};

/// Two support planes whose segment the ray crosses.
#[derive(Clone, Copy)]
struct Segment {
    left: Plane,
    right: Plane,
}

impl Segment {
    /// Where the segment meets the ray `d`, as points of obj1 and obj2.
    fn witnesses(&self, m: &Vec3, d: &Vec3) -> (Vec3, Vec3) {
        let (a, b) = (&self.left.point, &self.right.point);
        let s = m.dot(&a.v.cross(d)).max(0.0);
        let t = m.dot(&d.cross(&b.v)).max(0.0);
        let sum = s + t;
        if !(sum > 0.0) {
            return (a.v1, a.v2);
        }
        ((a.v1 * t + b.v1 * s) / sum, (a.v2 * t + b.v2 * s) / sum)
    }
}

/// A local minimum of the depth over the directions perpendicular to the unit vector
/// `m`, searched from the unit direction `start`, itself perpendicular to `m`.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    m: &Vec3,
    start: Vec3,
    settings: &Settings,
) -> Result<Answer, Fault> {
    let mut budget = settings.max_iterations;
    let mut ray = Plane::of(md, start)?;
    let mut best = ray;
    let mut stepped_aside = false;
    let finish = |plane: Plane, segment: Option<(Segment, Vec3)>, budget: u64| {
        let (point1, point2) = match segment {
            Some((s, d)) => s.witnesses(m, &d),
            None => (plane.point.v1, plane.point.v2),
        };
        Penetration {
            depth: plane.depth,
            depth_lower: 0.0,
            dir: plane.normal,
            normal: plane.normal,
            point1,
            point2,
            iterations: settings.max_iterations - budget,
        }
    };
    'rays: while budget > 0 {
        budget -= 1;
        if ray.depth < 0.0 {
            return Ok(Answer::Miss(ray.normal));
        }
        let d = ray.normal;
        let side = m.cross(&d);
        let off = side.dot(&ray.point.v);
        if !(off.abs() > rounding(ray.point.magnitude())) {
            // The ray passes through its own support point: stationary, perhaps a
            // maximum. Step aside once, then take it.
            if stepped_aside {
                return Ok(Answer::Hit(finish(best, None, budget)));
            }
            stepped_aside = true;
            let Some(n) = unit(&(d + side * ASIDE)) else {
                break;
            };
            ray = Plane::of(md, n)?;
            keep(&mut best, &ray);
            continue;
        }
        // The end on the other side of the ray.
        let other = Plane::of(md, side * -off.signum())?;
        if other.depth < 0.0 {
            return Ok(Answer::Miss(other.normal));
        }
        keep(&mut best, &other);
        // T(d, v) = side · v: the left end has a negative one, the right end a positive.
        let mut segment = if off < 0.0 {
            Segment {
                left: ray,
                right: other,
            }
        } else {
            Segment {
                left: other,
                right: ray,
            }
        };
        while budget > 0 {
            budget -= 1;
            let (a, b) = (segment.left.point.v, segment.right.point.v);
            let Some(n) = unit(&(b - a).cross(m)) else {
                return Ok(Answer::Hit(finish(best, Some((segment, d)), budget)));
            };
            let plane = Plane::of(md, n)?;
            if plane.depth < 0.0 {
                return Ok(Answer::Miss(n));
            }
            keep(&mut best, &plane);
            let along = n.dot(&d);
            let inner = n.dot(&a);
            let floor = rounding(plane.point.magnitude());
            let gap = plane.depth - inner;
            if !(gap > floor) || (gap <= settings.tolerance && inner >= 0.0) {
                let within = settings.tolerance.max(floor);
                if plane.depth / along - plane.depth <= within
                    && !(best.depth < plane.depth - within)
                {
                    return Ok(Answer::Hit(finish(best, Some((segment, d)), budget)));
                }
                ray = if best.depth < plane.depth - within {
                    best
                } else {
                    plane
                };
                continue 'rays;
            }
            if plane.depth * along <= inner {
                ray = plane;
                continue 'rays;
            }
            if side.dot(&plane.point.v) < 0.0 {
                segment.left = plane;
            } else {
                segment.right = plane;
            }
        }
    }
    // The cap may come before the newest plane is looked at.
    if best.depth < 0.0 {
        return Ok(Answer::Miss(best.normal));
    }
    Ok(Answer::Limit(finish(best, None, 0)))
}

/// Tan of the angle of a step aside from a stationary direction.
const ASIDE: Real = 0.1;

#[inline]
fn keep(best: &mut Plane, plane: &Plane) {
    if plane.depth < best.depth {
        *best = *plane;
    }
}
