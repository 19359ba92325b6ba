// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Portal discovery and refinement on known vertices (G. Snethen, "XenoCollide", Game Programming
//! Gems 7; W. Gao, "Efficient Incremental Penetration Depth Estimation", Algorithm 1).
//!
//! The origin ray runs from an interior point of D through the origin; its line holds the origin. A
//! *portal* is a triangle of points of D that the ray passes through.
//!
//! 1. *Discovery*: A is the known difference farthest along the ray, B the one farthest across, towards
//!    the ray. Then the point farthest across the line AB towards the ray replaces A or B, or closes the
//!    portal.
//! 2. *Refinement*: the point farthest along the portal's normal replaces one corner, so that the ray
//!    still passes through. It ends where the bounds meet, or where nothing is above the portal.
//!
//! Departures. Both steps take a known difference where one does, and query the callbacks where none is
//! far enough. XenoCollide's first portal is a quarter turn wide; here the direction of the least support
//! value is tilted across, no wider than the depth and the distance from the ray allow: shallow contacts
//! end with a small portal next to the minimum. A vertex on the ray itself starts from a ring of three
//! tilted directions.
//!
//! Outputs: `Ok(None)` of [`discover`]: D is flat or the vertices tie; use the initial simplex of the
//! polytope. [`refine`] leaves a valid portal in place, whatever ended it. `Stop::Separated`: a queried
//! direction is a separating axis; that is the separation test.

use crate::math::{Vec3, lesser, normalise_unscaled, perpendicular};
use crate::minkowski::query::{Stop, SupportQuery, UpperBound};
use crate::minkowski::round_fit::{DirectionSource, SphereFit, evaluate_beyond};
use crate::minkowski::support::SupportMap;
use crate::minkowski::tolerance::GapLimit;
use crate::minkowski::vertex_set::{Vertex, VertexSet};

/// The tilt of a query in discovery, in units of the upper bound over the distance from the ray, the angle at which
/// a plane of that depth passes through the ray; and its growth where it found nothing on the other side of the
/// ray. Insensitive: 1.3 to 1.5; 1.15 takes 4 % more support points of intersection tests.
const TILT_GROWTH: f64 = 1.4;
/// The widest such tilt: the width of the portal over the length of the ray in D, the width being this
/// times the distance from the ray. Measured: 4 takes 1 % fewer support points for the global minimum, and
/// 13 % more for a local one of hulls, whose portals then reach into other valleys.
const TILT_WIDTH_OFF: f64 = 2.75;
/// … or this times the length of AB.
const TILT_WIDTH_EDGE: f64 = 0.75;
/// The number of tilts that find nothing before the query is a quarter turn aside.
const MAX_TILTS: u32 = 3;
/// The steps of a portal, of a walk from portal to portal or of a simplex, at most. Each comes closer to the surface
/// of D, few take forty, and what is open after so many is rounding. Insensitive: 24 to 100.
pub const MAX_STEPS: u32 = 100;
/// The share of the gap that a known difference must lie above a plane to replace a query.
pub const KNOWN_LEVEL: f64 = 0.2;
/// The upper bound, as a share of the size, up to which a contact is shallow: a portal near the minimum pays there, and
/// the polytope is faster beyond for round objects (5 %). Without it a proof of `campaign` ("scale 1e-6 to 1e6") misses
/// the minimum.
const SHALLOW_REL: f64 = 0.3;

/// Returns whether the least support value is that of a shallow contact.
#[inline(always)]
fn is_shallow<A: SupportMap, B: SupportMap>(query: &SupportQuery<'_, A, B>) -> bool {
    let upper = query.upper.depth;
    upper * upper < SHALLOW_REL * SHALLOW_REL * query.scale.size2()
}

/// Finds a portal of the ray along unit `ray` through the origin. `length`: of the ray in D, about,
/// metres. `gap`: what the bounds may be apart, metres. The corners wind around the ray so that their
/// normal looks along it. A full set ends the discovery: `None`.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn discover<A: SupportMap, B: SupportMap, const N: usize>(
    query: &mut SupportQuery<'_, A, B>,
    set: &mut VertexSet<N>,
    ray: &Vec3,
    length: f64,
    gap: f64,
    ring_tilt: f64,
) -> Result<Option<[Vertex; 3]>, Stop> {
    let mut a = set.farthest_vertex(ray);
    let mut b: Option<Vertex> = None;
    // Across the ray, from A towards it.
    let mut across = ray * a.w.dot(ray) - a.w;
    let mut height = across.dot(&a.w);
    if !(-height > 0.5 * gap * length) {
        match ring(query, set, ray, ring_tilt)? {
            Ok(portal) => return Ok(Some(portal)),
            Err(axis) => (across, height) = (axis, 0.0),
        }
    }
    let tiny = 1e-12 * query.scale.size2();
    let mut side = 1.0;
    let mut failures = 0;
    for _ in 0..MAX_STEPS {
        // Closer to the ray than A and B are.
        let is_closer = |w: &Vec3| across.dot(w) > 0.999 * height + tiny;
        let mut p = set.farthest_vertex(&across);
        if !is_closer(&p.w) {
            if set.is_full() {
                return Ok(None);
            }
            let edge = b.map_or(0.0, |b| (b.w - a.w).norm());
            let n = discovery_dir(&query.upper, &across, height, edge, length, failures);
            let Some(n) = normalise_unscaled(&n) else {
                return Ok(None);
            };
            let sample = query.evaluate(set, &n)?;
            let ahead = across.dot(&sample.w);
            if !(ahead > 0.0) {
                if failures >= MAX_TILTS {
                    return Ok(None);
                }
                failures += 1;
            }
            if ahead > across.dot(&p.w) {
                p = sample.vertex();
            }
            if !is_closer(&p.w) {
                continue;
            }
        }
        let b = match &mut b {
            None => b.insert(p),
            Some(b) => {
                if side * ray.dot(&b.w.cross(&p.w)) < 0.0 {
                    a = p;
                } else if side * ray.dot(&p.w.cross(&a.w)) < 0.0 {
                    *b = p;
                } else {
                    let is_beyond = across.dot(&p.w) > 0.0;
                    let portal = if side > 0.0 { [a, *b, p] } else { [*b, a, p] };
                    return Ok(is_beyond.then_some(portal));
                }
                b
            }
        };
        across = ray.cross(&(b.w - a.w));
        height = across.dot(&a.w);
        side = 1.0;
        if height > 0.0 {
            (across, height, side) = (-across, -height, -1.0);
        }
    }
    Ok(None)
}

/// Returns the next direction of the discovery, of any length: the one of the least support value, tilted towards
/// `across`; or `across` itself after [`MAX_TILTS`] failures. `height`: of the corners along `across`, m². `edge`:
/// the distance of the two corners, 0 for one, and `length`: of the ray in D, about, metres.
#[inline(always)]
fn discovery_dir(
    upper: &UpperBound,
    across: &Vec3,
    height: f64,
    edge: f64,
    length: f64,
    failures: u32,
) -> Vec3 {
    let width = across.norm();
    let off = -height / width;
    let mut tilt = f64::INFINITY;
    if failures < MAX_TILTS {
        let widest = (TILT_WIDTH_OFF * off).max(TILT_WIDTH_EDGE * edge) / length;
        tilt = lesser(TILT_GROWTH * upper.depth / off, widest);
        for _ in 0..failures {
            tilt *= TILT_GROWTH;
        }
    }
    if tilt > 0.0 && tilt < f64::INFINITY {
        upper.dir + across * (tilt / width)
    } else {
        *across
    }
}

/// Queries three directions around a ray that passes through its own support vertex, tilted by the tangent `tilt`. The
/// inner error is an axis across the ray, where the three points are nearly on a line.
#[cold]
#[inline(never)]
fn ring<A: SupportMap, B: SupportMap, const N: usize>(
    query: &mut SupportQuery<'_, A, B>,
    set: &mut VertexSet<N>,
    ray: &Vec3,
    tilt: f64,
) -> Result<Result<[Vertex; 3], Vec3>, Stop> {
    let e1 = perpendicular(ray);
    let e2 = ray.cross(&e1);
    let half = 0.75_f64.sqrt();
    // At most 45 degrees; also for NaN.
    let tilt = lesser(tilt, 1.0);
    let turns = [[-0.5, half], [-0.5, -half], [1.0, 0.0]];
    let mut corners = [Vertex::default(); 3];
    for (corner, turn) in corners.iter_mut().zip(turns) {
        if set.is_full() {
            return Ok(Err(e1));
        }
        let n = ray + (e1 * turn[0] + e2 * turn[1]) * tilt;
        *corner = query.evaluate(set, &(n / n.norm()))?.vertex();
    }
    let (x, y) = (corners[0].w - corners[2].w, corners[1].w - corners[2].w);
    let normal = x.cross(&y);
    let is_wide = normal.norm_squared() > 0.01 * x.norm_squared() * y.norm_squared();
    Ok(if is_wide { Ok(corners) } else { Err(e1) })
}

/// Replaces one corner by `w`, a point beyond the portal, so that the ray still passes through.
#[inline(always)]
pub fn replace_corner(portal: &mut [Vertex; 3], ray: &Vec3, w: Vertex) {
    // On which side of the plane through the ray and w each corner lies.
    let across = ray.cross(&w.w);
    let [a, b, c] = portal.each_ref().map(|v| across.dot(&v.w) > 0.0);
    // Constant indices keep the corners in registers.
    if a && !b {
        portal[2] = w;
    } else if b && !c {
        portal[0] = w;
    } else {
        portal[1] = w;
    }
}

/// Returns whether the ray passes through a portal, within `eps`, metres. The first portal may be a ring
/// that it does not pass through.
pub fn is_crossed(portal: &[Vertex; 3], ray: &Vec3, eps: f64) -> bool {
    let [a, b, c] = portal.each_ref().map(|corner| &corner.w);
    [(a, b), (b, c), (c, a)].into_iter().all(|(p, q)| {
        // A product with the edge keeps the digits of small portals.
        let edge = q - p;
        let side = ray.dot(&p.cross(&edge));
        side >= 0.0 || side * side <= eps * eps * edge.norm_squared()
    })
}

/// Moves a portal outwards: to known differences as far as they go, to queried ones while the origin is
/// beyond it, and while the contact is shallow.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn refine<A: SupportMap, B: SupportMap, const N: usize>(
    query: &mut SupportQuery<'_, A, B>,
    set: &mut VertexSet<N>,
    fit: &mut SphereFit,
    ray: &Vec3,
    portal: &mut [Vertex; 3],
    limit: &GapLimit,
) -> Result<(), Stop> {
    let tolerance = query.scale.tolerance(limit.tolerance);
    let mut along_normal = false;
    for _ in 0..MAX_STEPS {
        let normal = (portal[1].w - portal[0].w).cross(&(portal[2].w - portal[0].w));
        let n2 = normal.norm_squared();
        let offset = normal.dot(&portal[0].w);
        if !(n2 > 0.0) || offset > 0.0 && !is_shallow(query) {
            return Ok(());
        }
        let length = n2.sqrt();
        let upper = query.upper.depth;
        let gap = limit.allowed(upper, tolerance);
        let mut w = set.farthest_vertex(&normal);
        if !(normal.dot(&w.w) - offset > KNOWN_LEVEL * gap * length) {
            if offset > 0.0 && offset >= (upper - gap) * length || set.is_full() {
                return Ok(());
            }
            let is_along_normal = along_normal || offset < 0.0;
            let (sample, choice) =
                evaluate_beyond(query, set, fit, portal, &normal, gap, is_along_normal)?;
            w = sample.vertex();
            let is_above = normal.dot(&w.w) - offset > query.scale.height_eps() * length;
            if !is_above {
                if choice == DirectionSource::Normal {
                    return Ok(());
                }
                along_normal = true;
                continue;
            }
        }
        along_normal = false;
        replace_corner(portal, ray, w);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::SupportPoint;
    use crate::minkowski::tolerance::GAP_REL;
    use crate::shapes::{Random, ball, capsule, corners, difference, hull, placed};

    const LIMIT: GapLimit = GapLimit {
        tolerance: 1e-6,
        share: GAP_REL,
    };

    /// Returns the portals after discovery and refinement from the centers, `None` for a pair apart.
    fn solve<A: SupportMap, B: SupportMap>(
        a: A,
        b: B,
        center1: Vec3,
        center2: Vec3,
    ) -> Option<(Vec3, [[Vertex; 3]; 2], f64)> {
        let md = difference(a, b);
        let c = SupportPoint {
            v: center1 - center2,
            v1: center1,
            v2: center2,
        };
        let mut query = SupportQuery::new(&md, Some(&c));
        let mut set = VertexSet::<64>::EMPTY;
        let ray = -c.v.normalize();
        query.evaluate(&mut set, &ray).ok()?;
        let length = query.upper.depth + c.v.norm();
        let gap = LIMIT.allowed(query.upper.depth, query.scale.tolerance(LIMIT.tolerance));
        let found = discover(
            &mut query,
            &mut set,
            &ray,
            length,
            gap,
            (2.0 * gap / length).sqrt(),
        )
        .ok()??;
        let mut portal = found;
        let mut fit = SphereFit::default();
        refine(&mut query, &mut set, &mut fit, &ray, &mut portal, &LIMIT).ok()?;
        Some((ray, [found, portal], query.upper.depth))
    }

    #[test]
    fn the_ray_passes_through_every_portal() {
        let mut r = Random::new(11);
        let mut found = 0;
        for round in 0..600 {
            let cube = corners(Vec3::new(0.5, 0.4, 0.3));
            let at = r.direction() * r.within(0.3, 0.9);
            let a = placed(&cube, &r.rotation(), Vec3::zeros());
            let solved = if round % 2 == 0 {
                let b = placed(&cube, &r.rotation(), at);
                solve(hull(&a), hull(&b), Vec3::zeros(), at)
            } else {
                let axis = r.vector(0.3);
                solve(
                    hull(&a),
                    capsule(at - axis, at + axis, 0.3),
                    Vec3::zeros(),
                    at,
                )
            };
            if let Some((ray, portals, _)) = solved {
                found += 1;
                assert!(
                    portals.iter().all(|portal| is_crossed(portal, &ray, 1e-12)),
                    "{round}"
                );
            }
        }
        assert!(found > 300, "{found}");
    }

    /// Symmetric pairs, whose first vertices tie with the ray.
    #[test]
    fn symmetric_pairs_have_portals() {
        let cube = corners(Vec3::repeat(0.5));
        for at in [Vec3::x() * 0.9, Vec3::new(0.9, 0.9, 0.0), Vec3::repeat(0.8)] {
            let b = placed(&cube, &crate::shapes::Rotation::identity(), at);
            let (ray, portals, _) =
                solve(hull(&cube), hull(&b), Vec3::zeros(), at).expect("a portal");
            assert!(portals.iter().all(|portal| is_crossed(portal, &ray, 1e-12)));
            let at = at.normalize() * 0.9;
            let balls = [ball(Vec3::zeros(), 0.5), ball(at, 0.5)];
            let [a, b] = balls;
            let (ray, portals, depth) = solve(a, b, Vec3::zeros(), at).expect("a portal");
            assert!(portals.iter().all(|portal| is_crossed(portal, &ray, 1e-12)) && depth > 0.0);
        }
    }
}
