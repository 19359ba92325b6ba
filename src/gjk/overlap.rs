// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap? The distance algorithm ([`crate::gjk::simplex`]), ended by the first
//! support plane that separates, or by a simplex that holds the origin.
//!
//! D lies behind the support plane of the direction n that is asked: a support value h(n) <= 0
//! separates. Where the origin stays within rounding of the simplex's surface (it lies on an edge
//! between points of D, as in stacks of aligned boxes), a *portal* has the last word (G. Snethen,
//! "XenoCollide", Game Programming Gems 7): a ray from a point well inside D through the origin,
//! and a triangle of support points around it, moved outwards along its normals until the origin
//! lies on the inner side or a plane separates. Ties do no harm there.
//!
//! **A touch is a miss**: [`Inquiry::ask`] ends the search where a support value is no
//! greater than rounding. What is proven to overlap has the origin strictly inside; a flat
//! D has no inside, and its normal is asked for before a tetrahedron is believed.
//!
//! Departures from libccd: both its yes-or-no queries are this one, with the centres'
//! difference for a first corner where they are given and trusted; on a million pairs of the
//! kinds in use that is a sixth fewer support points than libccd's portal asks for.

use crate::gjk::simplex::{Simplex, direction, room};
use crate::known::support_set::{Inquiry, Stop, SupportSet};
use crate::math::{Vec3, larger, unit};
use crate::minkowski::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::paper::portal::{Exit, Search, SupportPlane, Until};

/// Do the objects overlap? `centre`, an interior point of D, is trusted. Without one, from the unit
/// vector that `first` gives.
#[inline]
pub fn cold<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&SupportPoint>,
    first: impl FnOnce() -> Vec3,
) -> Result<(), Stop> {
    // A centre at the origin is no corner to look from.
    let from_centre = centre.and_then(|c| direction(&-c.v));
    let centre = centre.filter(|_| from_centre.is_some());
    let dir = &from_centre.unwrap_or_else(first);
    let mut inquiry = Inquiry::new(md);
    // Most misses are told here, and pay for nothing more.
    let first = inquiry.first(dir, None)?;
    beyond_first(&mut inquiry, centre, dir, &first)
}

/// What is left where the first support point does not separate.
#[inline(never)]
fn beyond_first<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    centre: Option<&SupportPoint>,
    dir: &Vec3,
    first: &SupportPoint,
) -> Result<(), Stop> {
    let mut set = SupportSet::<ROOM>::EMPTY;
    let centre = centre.map(|centre| {
        inquiry.precision.note(centre);
        set.push(&Vec3::zeros(), centre)
    });
    let asked = set.push(dir, first);
    overlap(inquiry, &mut set, centre, Some(asked), dir).map(|_| ())
}

/// Room for a simplex and what is known besides.
pub const ROOM: usize = 8;

/// Support points after which the portal decides: of a hundred thousand pairs of every kind
/// in use none needs forty.
const STEPS: u32 = 64;

/// Steps within rounding of the simplex's surface before the portal decides. One finds the
/// other side of a face that the origin lies on.
const STALLS: u32 = 3;

/// Support points after which the portal's answer is its last one. It halves what is open
/// at each but few; what is open then is rounding.
const LAST: u64 = 200;

/// What shows that the origin is inside D, or that no direction asked separates.
pub struct Held {
    /// The indices of the corners in the set of the tetrahedron that holds the origin; of the last
    /// simplex, where none did, the last one repeated.
    pub corners: [usize; 4],
    /// Where a portal had the last word, and the corners need not hold it: two points that it
    /// lies between.
    pub between: Option<[SupportPoint; 2]>,
}

/// Shows that the objects overlap: the origin is strictly inside D, beyond rounding, or no
/// direction asked separates. Or [`Stop::Apart`].
///
/// `centre` is the index of a point of D that is trusted to be one, and need not be a
/// support point: the origin is looked for between it and others. `dir`, unit, is asked
/// first, unless it has found the point `asked`. Other points in the set stand in for a support
/// point where they do as well. The set has room for more than four points; where it is full, points
/// out of use give way.
#[inline(never)]
pub fn overlap<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<N>,
    centre: Option<usize>,
    asked: Option<usize>,
    dir: &Vec3,
) -> Result<Held, Stop> {
    let mut dir = *dir;
    let mut simplex = match centre {
        Some(c) => Simplex::around(c, &set.v(c)),
        None => Simplex::new(),
    };
    if let Some(w) = asked {
        let (touch, size2) = (inquiry.precision.touch(), inquiry.precision.size2());
        let way = simplex.add(w, set.v(w), touch, size2);
        dir = way.and_then(|(way, _)| direction(&way)).unwrap_or(dir);
    }
    // The square of the distance from the simplex; and whether points on the other side of
    // it, where it is a triangle, are known.
    let (mut nearest, mut backed) = (f64::INFINITY, false);
    let mut stalls = 0;
    // Points of the set that have not been corners yet.
    let mut known = set.len() - [centre, asked].iter().flatten().count();
    for _ in 0..STEPS {
        let touch = inquiry.precision.touch();
        let other = if known > 0 {
            set.farther(&dir, touch)
        } else {
            None
        };
        let (w, at, touch) = match other {
            // A corner, by rounding.
            Some(w) if simplex.has(w) => break,
            Some(w) => {
                known -= 1;
                (w, set.v(w), touch)
            }
            None => {
                let place = room(set, &simplex);
                match inquiry.ask_at(set, place, &dir)? {
                    Some((v, touch)) => (place, v, touch),
                    // A callback that contradicts itself.
                    None => break,
                }
            }
        };
        let solid = simplex.len() == 3;
        let size2 = inquiry.precision.size2();
        let Some((way, distance2)) = simplex.add(w, at, touch, size2) else {
            let inside = simplex.has_inner();
            if !(nearest > touch * touch || backed || inside) {
                // The origin is in the base's plane, within rounding: in one of the two
                // tetrahedra on either side of it, if there is another.
                inquiry.ask_at(set, room(set, &simplex), &-dir)?;
            }
            let [i, j, k] = simplex.ids();
            return Ok(Held {
                corners: [i, j, k, w],
                between: None,
            });
        };
        // Negated for NaN.
        if !(distance2 > touch * touch && distance2 < nearest) {
            stalls += 1;
            if stalls > STALLS {
                break;
            }
        }
        (nearest, backed) = (distance2, solid && simplex.len() == 3);
        match direction(&way) {
            Some(n) => dir = n,
            None => break,
        }
    }
    let corners = simplex.ids().map(|i| set.point(i));
    let corners = corners.get(..simplex.len()).unwrap_or(&corners);
    let farther = |n: &Vec3, h: f64| set.farther(n, h).is_some();
    let between = decide(inquiry, corners, &farther, &dir)?;
    let [i, j, k] = simplex.ids();
    Ok(Held {
        corners: [i, j, k, k],
        between,
    })
}

/// The last word where the origin is as good as on the surface of the simplex with these corners: a
/// portal. `farther`: does a known point lie farther along a direction than so far, metres? Returns
/// the inner point and where the ray from it crosses the last portal: the origin is between them.
///
/// It is compiled once for every room of the known points: 11 KB less, and it is rarely asked.
#[cold]
#[inline(never)]
fn decide<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    corners: &[SupportPoint],
    farther: &dyn Fn(&Vec3, f64) -> bool,
    dir: &Vec3,
) -> Result<Option<[SupportPoint; 2]>, Stop> {
    // The simplex may be as flat as touching faces: the middle between it and the far
    // side of D is well inside.
    let mut seen = SupportSet::<8>::EMPTY;
    for corner in corners {
        seen.push(&Vec3::zeros(), corner);
    }
    let last = seen.len();
    inquiry.ask_at(&mut seen, last, &-dir)?;
    // The mean of the corners, one after the other.
    let mut inner = seen.point(0);
    for (count, corner) in (1..).zip(corners).skip(1) {
        inner = inner.towards(corner, 1.0 / count as f64);
    }
    inner = inner.towards(&seen.point(last), 0.5);
    if !(inner.v.norm() > inquiry.precision.touch()) {
        inner = inner.towards(&seen.point(0), 0.5);
    }
    let ray = unit(&-inner.v).unwrap_or(*dir);
    let first = SupportPlane::of(inquiry.md, ray)?;
    let mut search = Search {
        md: inquiry.md,
        // Any portal that has the origin on its inner side decides.
        tolerance: f64::INFINITY,
        until: Until::Normal,
        flat: None,
        budget: LAST,
        best: first,
    };
    let exit = match search.find_portal(&first, Some(&inner.v)) {
        Ok(Ok(portal)) => search.refine(portal),
        Ok(Err(exit)) => Ok(exit),
        Err(stop) => Err(stop),
    };
    let between = match exit {
        Ok(Exit::Converged(last, _) | Exit::Limit(Some(last))) => {
            let (v1, v2) = last.witnesses();
            Some([inner, SupportPoint { v: v1 - v2, v1, v2 }])
        }
        Err(Stop::Fault(fault)) => return Err(Stop::Fault(fault)),
        _ => None,
    };
    let lowest = search.best;
    inquiry.precision.note(&lowest.point);
    let touch = inquiry.precision.touch();
    // A callback that contradicts itself separates nothing.
    let contradicted = |h: f64| farther(&lowest.normal, h);
    let grain = inquiry.precision.grain();
    if lowest.depth > touch || contradicted(larger(lowest.depth + grain, touch)) {
        Ok(between)
    } else {
        Err(Stop::Apart(lowest.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, ball, corners, hull, placed};

    /// The points that a portal's last word gives have the origin between them.
    #[test]
    fn a_portal_decides_between_two_points() {
        let mut r = Random::new(43);
        for _ in 0..200 {
            let half = Vec3::new(0.5, 0.4, 0.3);
            let turned = placed(&corners(half), &r.rotation(), r.vector(0.2));
            let md = MinkowskiDifference::new(hull(&corners(half)), hull(&turned));
            let mut inquiry = Inquiry::new(&md);
            let n = r.direction();
            let point = md.support(&n).unwrap();
            let between = decide(&mut inquiry, &[point], &|_, _| false, &n);
            let between = between.ok().flatten();
            let [p, q] = between.unwrap().map(|p| p.v);
            let apart = (q - p).norm();
            assert!(p.dot(&q) < 0.0 && p.cross(&q).norm() <= 64.0 * EPSILON * apart * apart);
        }
    }

    /// A cube turned anyhow and the same over it, aside, with this gap (less than zero: the depth).
    fn cubes(gap: f64, r: &mut Random) -> [Vec<Vec3>; 2] {
        let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
        let turn = r.rotation();
        let aside = Vec3::new(
            r.within(-0.5, 0.5) * half.x,
            r.within(-0.5, 0.5) * half.y,
            2.0 * half.z + gap,
        );
        [Vec3::zeros(), turn * aside].map(|at| placed(&corners(half), &turn, at))
    }

    /// The same bits at every power of two from a micrometre to 1000 km and beyond; a miss comes
    /// with a direction that separates, and swapped objects give the same answer.
    #[test]
    fn free_of_scale_and_order() {
        let mut r = Random::new(2);
        for _ in 0..1000 {
            let gap = r.within(-0.1, 0.1);
            let [a, b] = cubes(gap, &mut r);
            let dir = r.direction();
            let md = MinkowskiDifference::new(hull(&a), hull(&b));
            let one = cold(&md, None, || dir);
            assert_eq!(one.is_ok(), gap < 0.0, "{gap}");
            if let Err(Stop::Apart(n)) = one {
                assert!((n.norm() - 1.0).abs() < 8.0 * EPSILON);
                assert!(n.dot(&md.support(&n).unwrap().v) <= 0.0);
            }
            let swapped = MinkowskiDifference::new(hull(&b), hull(&a));
            assert_eq!(cold(&swapped, None, || -dir).is_ok(), one.is_ok());
            let asked = swapped.supports();
            assert!(asked < 300, "{asked}");
            for exponent in [-20, 20] {
                let scale = (2.0 as f64).powi(exponent);
                let [a, b] = [&a, &b].map(|of| of.iter().map(|p| p * scale).collect::<Vec<_>>());
                let other = MinkowskiDifference::new(hull(&a), hull(&b));
                assert_eq!(one, cold(&other, None, || dir));
            }
        }
    }

    /// Known points of D do not change the answer, and those all around the origin are a
    /// proof by themselves.
    #[test]
    fn known_points() {
        let mut r = Random::new(6);
        let mut without = 0;
        for _ in 0..3000 {
            let gap = r.within(-0.1, 0.1);
            let [a, b] = cubes(gap, &mut r);
            let md = MinkowskiDifference::new(hull(&a), hull(&b));
            let mut inquiry = Inquiry::new(&md);
            let mut set = SupportSet::<64>::EMPTY;
            for _ in 0..3 {
                let _ = inquiry.ask(&mut set, &r.direction());
            }
            let dir = r.direction();
            let mut before = 0;
            for again in [false, true] {
                before = if again { md.supports() } else { before };
                let held = super::overlap(&mut inquiry, &mut set, None, None, &dir);
                assert_eq!(held.is_ok(), gap < 0.0, "gap {gap}");
            }
            without += u32::from(gap < 0.0 && md.supports() == before);
        }
        assert!(without > 1000, "{without}");
    }

    /// From the centre, which is trusted: the same answers.
    #[test]
    fn from_centres() {
        let mut r = Random::new(7);
        for ulps in [100.0, 1e6, 1e13] {
            for _ in 0..300 {
                let size = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
                let turn = r.rotation();
                let cube = placed(&corners(size), &turn, Vec3::zeros());
                let mut gap = (ulps * EPSILON).min(0.2) * r.within(0.5, 1.0);
                gap *= if r.within(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
                let up = turn * Vec3::z();
                // On the line of the centres, beside it, and round.
                let aside = turn * Vec3::x() * (0.3 * size.x);
                for by in [Vec3::zeros(), aside] {
                    let at = up * (2.0 * size.z + gap) + by;
                    let other: Vec<_> = cube.iter().map(|p| p + at).collect();
                    let md = MinkowskiDifference::new(hull(&cube), hull(&other));
                    let centre = SupportPoint {
                        v: -at,
                        v1: Vec3::zeros(),
                        v2: at,
                    };
                    assert_eq!(
                        cold(&md, Some(&centre), Vec3::x).is_ok(),
                        gap < 0.0,
                        "{gap}"
                    );
                }
                let at = up * (1.5 + gap);
                let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(at, 0.5));
                let centre = SupportPoint {
                    v: -at,
                    v1: Vec3::zeros(),
                    v2: at,
                };
                assert_eq!(
                    cold(&md, Some(&centre), Vec3::x).is_ok(),
                    gap < 0.0,
                    "{gap}"
                );
            }
        }
        // The same centre.
        let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.5));
        assert_eq!(cold(&md, Some(&SupportPoint::default()), Vec3::x), Ok(()));
    }
}
