// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The proof that the answer of a search for the depth is an overlap, from the points of D that
//! the search came to know.
//!
//! A support value is a depth only if the origin is in D, and a search that is no polytope's
//! does not show that. Where a point well inside D is trusted, a tetrahedron of it and of three
//! others is looked for, which mostly are known ([`is_around`]). Else the distance algorithm
//! tells, which takes known points wherever they do as well as new ones ([`proof`]).

use crate::gjk::overlap::{Proof, search};
use crate::gjk::simplex::{Simplex, direction, room};
use crate::known::support::{Known, SupportMap, SupportPoint};
use crate::known::support_set::{Beyond, Inquiry, Stop, SupportSet};
use crate::math::{EPSILON, Real, Vec3, larger, largest, unit};

/// Shows that D holds the origin, by more than rounding, from the points known and the `centre`,
/// which is trusted to be well inside D. `exit`: the point of the boundary where the origin leaves
/// D. `false`: nothing is shown yet.
///
/// With c the centre, a tetrahedron of c and three points of D holds the origin where −c is a sum
/// of positive multiples of the three: where it lies in their cone, inside the three planes
/// through the origin and two of them. The first three known mostly do; else [`enclose`].
///
/// # Errors
/// [`Stop::Apart`]: apart, or touching within rounding. Else a callback's answer that is not finite.
#[inline(always)]
pub fn is_around<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    centre: &SupportPoint,
    known: &mut Known,
    exit: &Vec3,
) -> Result<bool, Stop> {
    let c = &centre.v;
    let face = match known.points() {
        [] => return Ok(false),
        [p] => {
            // The exit from a ball, seen from its centre, is on the other side of the origin.
            let opposite = |m: Vec3| {
                p.v.dot(&m) < 0.0
                    && p.v.cross(&m).norm() <= inquiry.precision.touch() * (p.v - m).norm()
            };
            if opposite(centre.v1 - p.v2) || opposite(p.v1 - centre.v2) {
                return Ok(true);
            }
            (p.v, None)
        }
        [p, q] => (p.v, Some(q.v)),
        [p, q, r, ..] => match open_side(c, [&p.v, &q.v, &r.v], inquiry.precision.reach2()) {
            None => return Ok(true),
            Some(0) => (q.v, Some(r.v)),
            Some(1) => (r.v, Some(p.v)),
            Some(_) => (p.v, Some(q.v)),
        },
    };
    enclose(inquiry, centre, known, face, exit)
}

/// [`is_around`], from one or two corners of a cone on.
///
/// Where −c is nearer to a multiple of one corner than to other sums, that corner goes on alone.
/// Across it, or beyond the plane of the two, where −c is, the point of D farthest is the next
/// corner: a known one, or of those that points of obj1 and obj2 make anew (k support points of D
/// are k² points of D), or else a support point. Where the side of c and the one corner, or the
/// triangle of c and the two, holds the origin within rounding, that is a proof as well.
#[inline(never)]
fn enclose<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    centre: &SupportPoint,
    known: &mut Known,
    mut face: (Vec3, Option<Vec3>),
    exit: &Vec3,
) -> Result<bool, Stop> {
    let c = &centre.v;
    let mut exit = Some(exit);
    for _ in 0..STEPS {
        let touch = inquiry.precision.touch();
        if let (a, Some(b)) = face {
            let (from_a, from_b) = (across(c, &a), across(c, &b));
            if larger(from_a.dot(&b), from_b.dot(&a)) <= 0.0 {
                let nearer = from_b.norm_squared() < from_a.norm_squared();
                face = (if nearer { b } else { a }, None);
            } else if from_a.dot(&b) <= 0.0 {
                face = (a, None);
            } else if from_b.dot(&a) <= 0.0 {
                face = (b, None);
            }
        }
        let n = match face {
            (a, None) => {
                let way = across(c, &a);
                if way.norm() <= touch {
                    return Ok(c.dot(&a) < 0.0);
                }
                way
            }
            (a, Some(b)) => {
                let side = a.cross(&b);
                side * (1.0 as Real).copysign(-c.dot(&side))
            }
        };
        // None of a point at the origin, or of two on a line with it.
        let Some(n) = direction(&n) else {
            return Ok(false);
        };
        let new = match (known.made_beyond(centre, &n, touch), face) {
            (Some(made), _) => made,
            (None, (a, Some(b))) if in_plane(c, &a, &b, touch) => return Ok(true),
            _ => {
                let beside = exit.take().and_then(|exit| beside(exit, c));
                ask_beyond(inquiry, known, &n, beside)?
            }
        };
        face = match face {
            (a, None) => (a, Some(new)),
            (a, Some(b)) => match open_side(c, [&a, &b, &new], inquiry.precision.reach2()) {
                None => return Ok(true),
                Some(0) => (b, Some(new)),
                Some(1) => (a, Some(new)),
                // In the plane of a and b, within rounding.
                Some(_) => return Ok(in_plane(c, &a, &b, touch)),
            },
        };
    }
    Ok(false)
}

/// Steps of [`enclose`] before the distance algorithm takes over. Insensitive: 3 to 18 tried on the
/// recorded contacts, where mostly it takes two.
const STEPS: usize = 9;

/// Is −c in the cone of these, by more than rounding? Else the one that it lies farthest beyond
/// the plane of the others from.
#[inline(always)]
fn open_side(c: &Vec3, [u, v, w]: [&Vec3; 3], reach2: Real) -> Option<usize> {
    let sides = [v.cross(w), w.cross(u), u.cross(v)];
    let sign = (1.0 as Real).copysign(u.dot(&sides[0]));
    let outside = sides.map(|side| sign * c.dot(&side));
    let most = larger(larger(outside[0], outside[1]), outside[2]);
    let size2 = larger(larger(u.norm_squared(), v.norm_squared()), w.norm_squared());
    let size2 = larger(larger(size2, c.norm_squared()), reach2);
    if most < -64.0 * EPSILON * size2 * size2.sqrt() {
        return None;
    }
    // No search over a range: where its bound is not seen, a panic is linked.
    if outside[0] >= most {
        return Some(0);
    }
    Some(if outside[1] >= most { 1 } else { 2 })
}

/// Of −c what is across `a`.
#[inline(always)]
fn across(c: &Vec3, a: &Vec3) -> Vec3 {
    a * (c.dot(a) / a.norm_squared()) - c
}

/// Is the origin in the plane of these, within a touch?
fn in_plane(c: &Vec3, a: &Vec3, b: &Vec3, touch: Real) -> bool {
    let side = a.cross(b);
    c.dot(&side).abs() <= touch * (side + b.cross(c) + c.cross(a)).norm()
}

/// Asks for a point of D beyond the origin along unit `n`: first beside the exit, if D is thin
/// there, else along n itself.
fn ask_beyond<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    known: &mut Known,
    n: &Vec3,
    beside: Option<impl Fn(&Vec3) -> Option<Vec3>>,
) -> Result<Vec3, Stop> {
    let aside = beside.and_then(|beside| beside(n));
    for d in aside.iter().chain([n]) {
        let point = inquiry.point(d)?;
        known.push(&point);
        if n.dot(&point.v) > inquiry.precision.touch() {
            return Ok(point.v);
        }
    }
    Err(Stop::Apart(*n))
}

/// [`crate::gjk::overlap::overlap`], where a search for the depth has left points of D in the set:
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
    let held = search(
        inquiry,
        set,
        simplex,
        dir,
        kind,
        Simplex::add_called,
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
    )?;
    let Some([p, q]) = held.between else {
        return Ok(held.corners);
    };
    set.place(0, &Vec3::zeros(), &p);
    set.place(1, &Vec3::zeros(), &q);
    Ok([0, 1, 1, 1])
}

/// The index of the point of D farthest along `n`, of all that the points of obj1 and those of
/// obj2 in the set make, if it reaches beyond `reach`; it is put into the set.
fn recombined<const N: usize>(
    set: &mut SupportSet<N>,
    simplex: &Simplex,
    n: &Vec3,
    reach: Real,
) -> Option<usize> {
    let farthest = set.extreme(n, 0);
    if !(farthest.reach > reach) {
        return None;
    }
    let [i, j] = farthest.names;
    if i == j {
        return Some(i);
    }
    let (v1, v2) = (set.witnesses(i)[0], set.witnesses(j)[1]);
    let place = room(set, simplex);
    let v = v1 - v2;
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
