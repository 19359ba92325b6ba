// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap? The algorithm of Gilbert, Johnson and Keerthi (1988),
//! as a yes or no.
//!
//! The nearest point v of a simplex inscribed in D gives the next direction
//! n = −v/|v|. A support value n·s(n) < 0 is a plane with all of D on its far side:
//! apart, proven. A tetrahedron around the origin: overlap, proven. Departure from
//! libccd: nothing is compared with an absolute epsilon, so objects of a
//! micrometre and of a thousand kilometres are answered alike; objects that touch
//! within rounding (a few ulps of their coordinates) count as overlapping.

use crate::math::{EPSILON, Real, Vec3};
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

/// Decides whether the origin is in D, starting from any point of D.
///
/// A support point of D is one; so is the difference of two interior points.
pub fn intersect<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: SupportPoint,
    max_iterations: u64,
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
        let w = md.support(&n)?;
        size = size.max(w.magnitude());
        let h = n.dot(&w.v);
        if h < 0.0 {
            return Ok(Overlap::No(n));
        }
        simplex.push(w);
        match simplex.reduce() {
            Nearest::Inside => return Ok(Overlap::Yes(simplex)),
            Nearest::Outside(next) => {
                // Each step comes nearer by at least a rounding error, or the
                // support plane through or beyond the origin is as near as the
                // arithmetic can tell: a touch.
                if !(next.norm() < distance * (1.0 - EPSILON)) {
                    return Ok(Overlap::Yes(simplex));
                }
                v = next;
            }
        }
    }
    Ok(Overlap::Undecided)
}

/// Distances below this many times the largest coordinate are rounding errors of
/// a difference of two points and of the nearest-point arithmetic.
const ROUNDING: Real = 4.0 * EPSILON;
