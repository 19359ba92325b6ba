// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The proof that the answer of a search for the depth is an overlap, from the points of D that
//! the search came to know.
//!
//! A support value is a depth only if the origin is in D, and a search that is no polytope's
//! does not show that. Mostly the points it saw do, at once: the tetrahedron of a point inside D
//! and of three of them ([`is_around`]). Else the distance algorithm tells, which takes known
//! points wherever they do as well as new ones ([`proof`]).

use crate::distance::{Proof, Simplex, direction, room, search};
use crate::math::{EPSILON, Real, Vec3, larger, largest, unit};
use crate::support::{SupportMap, SupportPoint};
use crate::support_set::{Beyond, Inquiry, Stop, SupportSet};

/// Does a tetrahedron of `c`, the first of the points, and two others hold the origin, by more
/// than rounding? `reach`: about how far the objects' points lie from the world's origin.
///
/// With the first three it mostly does: the ray from the origin away from c meets their
/// triangle. Seen along that ray a triangle that holds it is one around a point, and of those
/// with the first point for a corner the widest is: its other corners are the points that lie
/// farthest round on either side.
#[inline]
pub fn is_around(c: &Vec3, points: &[SupportPoint], reach: Real) -> bool {
    let [p, q, r, ..] = points else {
        return false;
    };
    holds(c, &p.v, &q.v, &r.v, reach)
        || widest(c, &p.v, &points[1..]).is_some_and(|[q, r]| holds(c, &p.v, &q, &r, reach))
}

/// Does the tetrahedron hold the origin? With Cᵢ = vⱼ × vₖ that is c·Cᵢ < 0 for all i, where
/// v₀·C₀ > 0.
#[inline(always)]
fn holds(c: &Vec3, u: &Vec3, v: &Vec3, w: &Vec3, reach: Real) -> bool {
    let sides = [v.cross(w), w.cross(u), u.cross(v)];
    let sign = (1.0 as Real).copysign(-u.dot(&sides[0]));
    let size2 = larger(larger(u.norm_squared(), v.norm_squared()), w.norm_squared());
    let size2 = larger(larger(size2, c.norm_squared()), reach * reach);
    let rounding = 64.0 * EPSILON * size2 * size2.sqrt();
    sides.iter().all(|side| sign * c.dot(side) > rounding)
}

/// Of these points the farthest round from `first` on either side, seen along the line from `c`
/// through the origin.
fn widest(c: &Vec3, first: &Vec3, others: &[SupportPoint]) -> Option<[Vec3; 2]> {
    // Perpendicular to c: a point's two coordinates seen along it are its dot products with
    // `across` and, stretched by |c| |across|, with `up`. The first point lies where `up` points.
    let across = first.cross(c);
    let up = c.cross(&across);
    let mut sides: [Option<(Vec3, Real, Real)>; 2] = [None; 2];
    for point in others {
        let (x, y) = (across.dot(&point.v), up.dot(&point.v));
        let side = &mut sides[usize::from(x > 0.0)];
        // y / |x| is less.
        if side.is_none_or(|(_, a, b)| y * a.abs() < b * x.abs()) {
            *side = Some((point.v, x, y));
        }
    }
    let [(q, ..), (r, ..)] = [sides[0]?, sides[1]?];
    Some([q, r])
}

/// [`crate::distance::overlap`], where a search for the depth has left points of D in the set:
/// point 0, which a [`Proof::Centred`] trusts to be well inside, and others. A point of each object
/// makes a point of D as well, so these are put together anew wherever that reaches beyond the
/// origin: k support points of D are k² points of D. Returns the indices of the corners of what
/// holds the origin, the last one repeated where it is no tetrahedron.
///
/// `exit`: the point of the boundary where the origin leaves D. D is first asked beside it, on
/// the side of the origin that is open: at the angle where a ball of D's size falls back from
/// the support plane by a quarter of the depth. A distance algorithm asks far away, and halves
/// its way back to a thin overlap; to a deep one it does not need to.
///
/// # Errors
/// [`Stop::Apart`]: apart, or touching within rounding. Else a callback's answer that is not finite.
pub fn proof<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<N>,
    kind: Proof,
    exit: &Vec3,
) -> Result<[usize; 4], Stop> {
    let start = set.v(0);
    let simplex = match kind {
        Proof::Centred => Simplex::around(0, &start),
        Proof::Solid | Proof::Planar => Simplex::of(0, &start),
    };
    if kind != Proof::Solid && !(start.norm() > inquiry.precision.touch()) {
        // The point itself is the origin.
        return Ok([0; 4]);
    }
    let mut beside = beside(exit, &start);
    let dir = direction(&-start).unwrap_or(Vec3::x());
    search(
        inquiry,
        set,
        simplex,
        dir,
        kind,
        |inquiry, set, simplex, n| {
            let touch = inquiry.precision.touch();
            if let Some(i) = recombined(set, simplex, n, touch) {
                return Ok(Some(i));
            }
            let Some(d) = beside.take().and_then(|beside| beside(n)) else {
                return Ok(None);
            };
            let place = room(set, simplex);
            let i = match inquiry.ask_at(set, place, &d)? {
                Beyond::Put { .. } => place,
                Beyond::Known(i) => i,
            };
            Ok((n.dot(&set.v(i)) > touch).then_some(i))
        },
    )
}

/// The index of the point of D farthest along `n`, of all that the points of obj1 and those of
/// obj2 in the set make, if it reaches beyond `reach`; it is put into the set.
fn recombined<const N: usize>(
    set: &mut SupportSet<N>,
    simplex: &Simplex,
    n: &Vec3,
    reach: Real,
) -> Option<usize> {
    let (mut one, mut two) = ((0, Real::NEG_INFINITY), (0, Real::INFINITY));
    for i in 0..set.len() {
        let [v1, v2] = set.witnesses(i);
        let (a, b) = (n.dot(v1), n.dot(v2));
        if a > one.1 {
            one = (i, a);
        }
        if b < two.1 {
            two = (i, b);
        }
    }
    let (v1, v2) = (set.witnesses(one.0)[0], set.witnesses(two.0)[1]);
    let v = v1 - v2;
    if !(n.dot(&v) > reach) {
        return None;
    }
    if one.0 == two.0 {
        return Some(one.0);
    }
    let place = room(set, simplex);
    set.place(place, &Vec3::zeros(), &SupportPoint { v, v1, v2 });
    Some(place)
}

/// Where to ask beside the exit, on the side that a direction looks to; nowhere, if D there is
/// not thin.
fn beside(exit: &Vec3, start: &Vec3) -> Option<impl Fn(&Vec3) -> Option<Vec3> + use<>> {
    let b = unit(exit)?;
    let depth = exit.norm();
    let size = depth - b.dot(start);
    let tilt = (0.5 * depth / size).sqrt();
    let side = move |n: &Vec3| unit(&(b + unit(&(n - b * n.dot(&b)))? * tilt));
    // Also NaN.
    (tilt <= THIN).then_some(side)
}

/// The angle, radians, that tells a thin overlap by.
const THIN: Real = 0.2;

/// A lower bound on the depth, metres: the distance from the origin to the nearest face of the
/// tetrahedron of these points, which is inscribed in D. 0 where the origin is not strictly
/// inside, beyond rounding.
pub fn inner_distance(corners: [&SupportPoint; 4]) -> Real {
    let magnitude = corners.iter().fold(0.0, |m, p| larger(m, p.magnitude()));
    let rounding = 4.0 * EPSILON * magnitude;
    let [p, q, r, s] = corners.map(|p| &p.v);
    // The faces around s, and the base: all turned outwards or all inwards.
    let [sp, sq, sr] = [p - s, q - s, r - s];
    let [pr, pq] = [r - p, q - p];
    let [at_s, at_p] = [largest(s), largest(p)];
    let [p_, q_, r_] = [largest(&sp), largest(&sq), largest(&sr)];
    let faces = [
        (sp.cross(&sq), s, at_s * larger(p_, q_)),
        (sq.cross(&sr), s, at_s * larger(q_, r_)),
        (sr.cross(&sp), s, at_s * larger(r_, p_)),
        (pr.cross(&pq), p, at_p * larger(largest(&pr), largest(&pq))),
    ];
    let mut least = Real::INFINITY;
    let outwards = faces[0].0.dot(s) > 0.0;
    for (n, a, lever) in &faces {
        let origin = n.dot(a);
        let origin = if outwards { origin } else { -origin };
        // Less what the rounding of the corners may add, which a short edge
        // magnifies by the way to the origin.
        let distance = (origin - rounding * lever) / n.norm() - rounding;
        // Not on the inner side, or within rounding of it, or a face whose area
        // underflows (infinite or NaN): no bound.
        if !(distance > 0.0 && distance < Real::INFINITY) {
            return 0.0;
        }
        if distance < least {
            least = distance;
        }
    }
    least
}
