// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap? The algorithm of Gilbert, Johnson and Keerthi (1988),
//! as a yes or no.
//!
//! The nearest point v of a simplex inscribed in D gives the next direction
//! n = −v/|v|. A support value n·s(n) < 0 is a plane with all of D on its far side:
//! apart, proven. A tetrahedron around the origin: overlap, proven. Where v becomes too
//! short to tell a direction a portal decides ([`portal`]). Departure from
//! libccd: nothing is compared with an absolute epsilon, so objects of a
//! micrometre and of a thousand kilometres are answered alike; objects that touch
//! within rounding (a few ulps of their coordinates) count as overlapping.

use crate::math::{EPSILON, Real, Vec3, unit};
use crate::portal::{self, Exit, Plane};
use crate::simplex::{Nearest, Simplex};
use crate::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// The yes or no of [`intersect`], with its proof.
pub enum Overlap {
    /// The simplex holds the origin (within rounding, when it is no tetrahedron).
    Yes(Simplex),
    /// This unit direction separates: n·s(n) < 0.
    No(Vec3),
    /// The iteration cap came first.
    Undecided,
}

/// Decides whether the origin is in D, starting from any point of D: a support
/// point is one, and so is the difference of two interior points.
///
/// `known` points of D are used wherever they do as well as a new support point: a
/// step needs only a point of D beyond the origin, so D is asked when none of them
/// is. A search that has points all around the origin is proven without a call.
pub fn intersect<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: SupportPoint,
    known: &[SupportPoint],
    max_iterations: u64,
) -> Result<Overlap, Fault> {
    search(md, start, known, max_iterations, |_, _| ())
}

/// [`intersect`], telling `seen` of each direction it asks and the support point there.
pub fn search<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: SupportPoint,
    known: &[SupportPoint],
    max_iterations: u64,
    mut seen: impl FnMut(&Vec3, &SupportPoint),
) -> Result<Overlap, Fault> {
    let mut simplex = Simplex::new(start);
    let mut v = start.v;
    let mut size = start.magnitude();
    for _ in 0..max_iterations {
        let distance = v.norm();
        // Scale-free zero; also ends on NaN.
        if !(distance > ROUNDING * size) {
            return Ok(Overlap::Yes(simplex));
        }
        let n = -v / distance;
        let w = match farthest(known, &n) {
            Some(w) => w,
            None => {
                let w = md.support(&n)?;
                if n.dot(&w.v) < 0.0 {
                    return Ok(Overlap::No(n));
                }
                seen(&n, &w);
                w
            }
        };
        size = size.max(w.magnitude());
        simplex.push(w);
        match simplex.reduce() {
            Nearest::Inside => return Ok(Overlap::Yes(simplex)),
            Nearest::Outside(next) => {
                // Each step comes nearer by at least a rounding error, or v is too
                // short to tell a direction.
                if !(next.norm() < distance * (1.0 - EPSILON)) {
                    return near_touch(md, simplex, max_iterations);
                }
                v = next;
            }
        }
    }
    Ok(Overlap::Undecided)
}

/// The last word where the objects nearly touch. There v is mostly rounding error, and
/// with it the direction −v/|v|; the normals of a portal's triangles are not. The ray
/// leaves from a point inside the simplex through the origin: if the origin is in D,
/// the ray ends beyond it.
fn near_touch<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    simplex: Simplex,
    max_iterations: u64,
) -> Result<Overlap, Fault> {
    let inner = simplex.mean();
    let Some(d) = unit(&-inner.v) else {
        return Ok(Overlap::Yes(simplex));
    };
    let first = Plane::of(md, d)?;
    let mut best = first;
    let mut budget = max_iterations;
    // Any portal that has the origin on its inner side decides.
    let tolerance = Real::INFINITY;
    Ok(
        match portal::mpr(md, &first, tolerance, false, &mut best, &mut budget)? {
            Exit::Miss(n) => Overlap::No(n),
            Exit::Converged(portal, _) | Exit::Limit(Some(portal)) if budget > 0 => {
                let [a, b, c] = portal.planes.map(|p| p.point);
                Overlap::Yes(Simplex::of([inner, a, b, c]))
            }
            Exit::Converged(..) | Exit::Limit(_) => Overlap::Undecided,
            Exit::Vertex | Exit::Touch | Exit::Shortcut(_) => Overlap::Yes(simplex),
        },
    )
}

/// The point farthest along `n`, if it lies beyond the origin.
#[inline]
fn farthest(known: &[SupportPoint], n: &Vec3) -> Option<SupportPoint> {
    let mut best = None;
    let mut reach = 0.0;
    for p in known {
        let d = n.dot(&p.v);
        if d > reach {
            reach = d;
            best = Some(*p);
        }
    }
    best
}

/// Distances below this many times the largest coordinate are rounding errors of
/// a difference of two points and of the nearest-point arithmetic.
const ROUNDING: Real = 4.0 * EPSILON;
