// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The proof that the answer of a search for the depth is an overlap, from the points of D that
//! the search came to know.
//!
//! A support value is a depth only if the origin is in D, and a search that is no polytope's
//! does not show that. With c a point of D, a tetrahedron of c and three others holds the origin
//! where −c is in the cone of the three. The first three known mostly do; else the cone is turned
//! until it holds −c. Where rounding is all that tells, [`crate::gjk::overlap`] decides.

use crate::gjk::simplex::direction;
use crate::known::support_set::{Inquiry, Stop};
use crate::math::{EPSILON, Vec3, larger, perpendicular, unit};
use crate::minkowski::support::{Known, SupportMap, SupportPoint};

/// A point of D to look from.
pub struct Apex<'a> {
    /// The point.
    pub point: &'a SupportPoint,
    /// Is it well inside D, or D flat? Then a segment or a triangle with it that holds the origin is
    /// a proof as well.
    pub inside: bool,
}

/// Shows that D holds the origin, by more than rounding, from the apex c and the points known.
/// `exit`: the point of the boundary where the origin leaves D. `false`: nothing is shown.
///
/// −c is a sum of positive multiples of the three: it lies in their cone, inside the three planes
/// through the origin and two of them.
///
/// # Errors
/// [`Stop::Apart`]: apart, or touching within rounding. Else a callback's answer that is not finite.
#[inline(always)]
pub fn is_around<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    apex: &Apex<'_>,
    known: &mut Known,
    exit: &Vec3,
) -> Result<bool, Stop> {
    let point = apex.point;
    let face = match known.points() {
        [] => Cone::Empty,
        [p] => {
            // The exit from a ball, seen from its centre, is on the other side of the origin.
            let opposite = |m: Vec3| {
                p.v.dot(&m) < 0.0
                    && p.v.cross(&m).norm() <= inquiry.precision.touch() * (p.v - m).norm()
            };
            if apex.inside && (opposite(point.v1 - p.v2) || opposite(p.v1 - point.v2)) {
                return Ok(true);
            }
            Cone::Ray(p.v)
        }
        [p, q] => Cone::Side(p.v, q.v),
        [p, q, r, ..] => {
            match open_side(&point.v, [&p.v, &q.v, &r.v], inquiry.precision.reach2()) {
                None => return Ok(true),
                Some(0) => Cone::Side(q.v, r.v),
                Some(1) => Cone::Side(r.v, p.v),
                Some(_) => Cone::Side(p.v, q.v),
            }
        }
    };
    enclose(inquiry, apex, known, face, exit)
}

/// Corners of a cone, of which −c is nearest to a sum of positive multiples.
#[derive(Clone, Copy)]
enum Cone {
    /// None: −c is on no corner's side.
    Empty,
    Ray(Vec3),
    Side(Vec3, Vec3),
}

impl Cone {
    /// Without the corners that have no part in what is nearest to −c.
    fn reduced(self, c: &Vec3) -> Self {
        match self {
            Cone::Side(a, b) => {
                let (from_a, from_b) = (across(c, &a), across(c, &b));
                let (aside_a, aside_b) = (from_a.dot(&b) <= 0.0, from_b.dot(&a) <= 0.0);
                let nearer = from_b.norm_squared() < from_a.norm_squared();
                match (aside_a, aside_b) {
                    (false, false) => self,
                    (false, true) => Cone::Ray(b).reduced(c),
                    (true, true) if nearer => Cone::Ray(b).reduced(c),
                    _ => Cone::Ray(a).reduced(c),
                }
            }
            Cone::Ray(a) if c.dot(&a) > 0.0 => Cone::Empty,
            other => other,
        }
    }
}

/// [`is_around`], from two corners of a cone on, or fewer.
///
/// Beyond the corners, where −c is, the point of D farthest is the next corner: a known one, or of
/// those that points of obj1 and obj2 make anew (k support points of D are k² points of D), or else a
/// support point. Where the side of c and one corner, or the triangle of c and two, holds the
/// origin within rounding, that is a proof as well, if c is well inside.
#[inline(never)]
fn enclose<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    apex: &Apex<'_>,
    known: &mut Known,
    mut cone: Cone,
    exit: &Vec3,
) -> Result<bool, Stop> {
    let c = &apex.point.v;
    let mut exit = Some(exit);
    for _ in 0..STEPS {
        let touch = inquiry.precision.touch();
        cone = cone.reduced(c);
        let n = match &cone {
            Cone::Empty => -c,
            Cone::Ray(a) => across(c, a),
            Cone::Side(a, b) => {
                let side = a.cross(b);
                side * (1.0 as f64).copysign(-c.dot(&side))
            }
        };
        if matches!(cone, Cone::Ray(_)) && n.norm() <= touch {
            return Ok(apex.inside);
        }
        // None of a point at the origin, or of two on a line with it.
        let Some(n) = direction(&n) else {
            return Ok(false);
        };
        let new = match (known.made_beyond(apex.point, &n, touch), &cone) {
            (Some(made), _) => made,
            (None, Cone::Side(a, b)) if in_plane(c, a, b, touch) => return Ok(apex.inside),
            _ => {
                let beside = exit.take().and_then(|exit| beside(exit, c));
                ask_beyond(inquiry, known, &n, beside)?
            }
        };
        cone = match cone {
            Cone::Empty => Cone::Ray(new),
            Cone::Ray(a) => Cone::Side(a, new),
            Cone::Side(a, b) => match open_side(c, [&a, &b, &new], inquiry.precision.reach2()) {
                None => return Ok(true),
                Some(0) => Cone::Side(b, new),
                Some(1) => Cone::Side(a, new),
                // In the plane of a and b, within rounding.
                Some(_) if in_plane(c, &a, &b, touch) => return Ok(apex.inside),
                Some(_) => Cone::Ray(new),
            },
        };
    }
    Ok(false)
}

/// Where to ask for an apex, where none is given, unit: aslant against the exit's normal, since
/// the point opposite to the exit often is on one line with it and the origin.
pub fn behind(n: &Vec3) -> Vec3 {
    let aslant = perpendicular(n) * ASLANT - n;
    aslant / aslant.norm()
}

/// Tan of the angle of [`behind`]. Insensitive: 0.01 to 0.15 tried on the recorded pair sets without
/// centres, at most 0.7 % of a local minimum's support points; 0 takes 4 % more.
const ASLANT: f64 = 0.05;

/// Steps of [`enclose`] before the distance algorithm takes over. Insensitive: 3 to 18 tried on the
/// recorded contacts, where mostly it takes two.
const STEPS: usize = 9;

/// Is −c in the cone of these, by more than rounding? Else the one that it lies farthest beyond
/// the plane of the others from.
#[inline(always)]
fn open_side(c: &Vec3, [u, v, w]: [&Vec3; 3], reach2: f64) -> Option<usize> {
    let sides = [v.cross(w), w.cross(u), u.cross(v)];
    let sign = (1.0 as f64).copysign(u.dot(&sides[0]));
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

/// Of −c what is across `a`: what rounding leaves along it is taken away.
#[inline(always)]
fn across(c: &Vec3, a: &Vec3) -> Vec3 {
    let a2 = a.norm_squared();
    let way = a * (c.dot(a) / a2) - c;
    way - a * (way.dot(a) / a2)
}

/// Is the origin in the plane of these, within a touch?
fn in_plane(c: &Vec3, a: &Vec3, b: &Vec3, touch: f64) -> bool {
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
const THIN: f64 = 0.2;
