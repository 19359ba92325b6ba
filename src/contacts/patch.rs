// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The middle of the region in which two faces touch.
//!
//! Where a face of one object rests on a face or an edge of the other, the support
//! planes touch both along more than a point, and which points a solver happens to know
//! is no property of the contact: from frame to frame its witness points jump from corner
//! to corner. The middle of the touching region moves as the objects do.
//!
//! The region is the intersection of the two faces, one of them moved by the depth. Each
//! support point of D in a direction a little aside of the normal shows a corner of
//! either face; five of them, evenly around, show all corners of a rectangle, however it
//! is turned, since each is the farthest one over a right angle. Of faces with more
//! corners the region is an inscribed polygon, still inside both objects. Convex polygons
//! are intersected by the halfplanes of one of them ([`Polygon::inside`]).

use crate::contact::Penetration;
use crate::contacts::polygon::{Flat, Polygon, between, cross, dot, side};
use crate::known::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{self, EPSILON, Real, Vec3, larger, perpendicular};

/// Directions around the normal.
const AROUND: usize = 5;
/// Cosine and sine of their angles.
#[allow(clippy::excessive_precision)] // In single precision.
const CIRCLE: [[Real; 2]; AROUND] = [
    [1.0, 0.0],
    [0.309_016_994_374_947_4, 0.951_056_516_295_153_6],
    [-0.809_016_994_374_947_4, 0.587_785_252_292_473_1],
    [-0.809_016_994_374_947_4, -0.587_785_252_292_473_1],
    [0.309_016_994_374_947_4, -0.951_056_516_295_153_6],
];
/// Corners of an intersection, at most: each halfplane adds one.
const ROOM: usize = 2 * AROUND;

/// The length, metres, along which the objects touch, as far as the points known of a local
/// search tell; 0 where it is one pair of points. `top`: the support point along `n`.
///
/// The search asks around the minimum for no more than it needs: mostly all corners of a face
/// that touches, but of two objects that lie along each other it may have seen no more than one
/// end of one on the plane. The other end, seen a little lower, gives that away.
pub fn width(
    points: &[SupportPoint],
    top: &SupportPoint,
    n: &Vec3,
    tolerance: Real,
    size: Real,
) -> Real {
    let blur = blur(tolerance, size);
    // Mostly one of the two touches with a corner: none of its other points is as high, nor
    // a side's way off and hardly lower.
    let corner = |way: &dyn Fn(&SupportPoint) -> Vec3| {
        points.iter().all(|p| {
            let way = way(p);
            let far2 = way.norm_squared();
            far2 <= 0.25 * blur || {
                let drop = n.dot(&way);
                drop > tolerance && drop * drop > ALONG * ALONG * far2
            }
        })
    };
    if corner(&|p| p.v2 - top.v2) || corner(&|p| top.v1 - p.v1) {
        return 0.0;
    }
    let top = [top.v1, top.v2];
    let point = |i: usize| points.get(i).map_or(top, |p| [p.v1, p.v2]);
    match rest(point, points.len(), n, &top, tolerance, size) {
        Rest::Along(length) => length,
        Rest::Corner(side) if lies_along(point, points.len(), n, &top, &side) => side.norm(),
        _ => 0.0,
    }
}

/// The square of the length that is nothing, m²: what rounds within the tolerance.
#[inline(always)]
fn blur(tolerance: Real, size: Real) -> Real {
    8.0 * tolerance * size
}

/// Is of each object a point known that is a good part of this side away from its top one, along
/// it, and hardly lower?
fn lies_along(
    point: impl Fn(usize) -> [Vec3; 2],
    count: usize,
    n: &Vec3,
    top: &[Vec3; 2],
    side: &Vec3,
) -> bool {
    let side2 = side.norm_squared();
    (0..2).all(|object| {
        (0..count).any(|i| {
            let way = point(i)[object % 2] - top[object % 2];
            let far2 = way.norm_squared();
            let drop2 = n.dot(&way).powi(2);
            let aside2 = way.cross(side).norm_squared() / side2;
            far2 > 0.25 * side2 && larger(aside2, drop2) <= ALONG * ALONG * far2
        })
    })
}

/// Sine of the angle between a side and a way along it. Measured: ×2, ÷2 nothing.
const ALONG: Real = 0.005;

/// What the points that a query knows say of a resting face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rest {
    /// The objects touch in one pair of points.
    Point,
    /// One of them touches with a corner, as far as is known, the other with an edge or a face:
    /// its longest side.
    Corner(Vec3),
    /// An edge of each touches, across the other, as far as is known; the longer one's length,
    /// metres.
    Crossing(Real),
    /// They touch along a length, metres.
    Along(Real),
}

/// The points of one object that lie on its support plane along a normal.
struct Touch {
    /// One of them.
    first: Vec3,
    /// Points as high as this along the normal, or higher, are on the plane, metres.
    least: Real,
    /// The way from the first to the one farthest from it, and its square.
    side: Vec3,
    side2: Real,
    /// How many there are; one that comes again mostly counts once.
    count: u32,
}

impl Touch {
    #[inline(always)]
    fn of(first: Vec3, n: &Vec3, tolerance: Real) -> Self {
        Self {
            first,
            least: n.dot(&first) - tolerance,
            side: Vec3::zeros(),
            side2: 0.0,
            count: 1,
        }
    }

    #[inline(always)]
    fn add(&mut self, v: &Vec3, n: &Vec3) {
        if *v != self.first && n.dot(v) >= self.least {
            let side = v - self.first;
            let side2 = side.norm_squared();
            self.count += u32::from(side != self.side);
            if side2 > self.side2 {
                (self.side, self.side2) = (side, side2);
            }
        }
    }
}

/// How the objects touch along the normal `n`, as far as `count` support points of D tell,
/// whose witnesses `point` gives. A witness within `tolerance` of its own object's support
/// plane is on that object's face, whether the other one is on its own or not. `top` are the
/// witnesses of the support point along `n`.
#[inline(always)]
pub fn rest(
    point: impl Fn(usize) -> [Vec3; 2] + Copy,
    count: usize,
    n: &Vec3,
    top: &[Vec3; 2],
    tolerance: Real,
    size: Real,
) -> Rest {
    let opposite = -n;
    let mut one = Touch::of(top[0], n, tolerance);
    let mut two = Touch::of(top[1], &opposite, tolerance);
    for i in 0..count {
        let [v1, v2] = point(i);
        one.add(&v1, n);
        two.add(&v2, &opposite);
    }
    let blur = blur(tolerance, size);
    if !(one.side2 > blur) && !(two.side2 > blur) {
        return Rest::Point;
    }
    let longer = if one.side2 > two.side2 { &one } else { &two };
    if !(one.side2 > blur && two.side2 > blur) {
        return Rest::Corner(longer.side);
    }
    let length = longer.side2.sqrt();
    let on_1 = (0..count).map(|i| point(i)[0]);
    let on_2 = (0..count).map(|i| point(i)[1]);
    let on_1 = on_1.filter(|v| n.dot(v) >= one.least);
    let on_2 = on_2.filter(|v| opposite.dot(v) >= two.least);
    // Two edges that cross touch in a point.
    let crossing = one.side.cross(&two.side).norm_squared() > blur * length * length;
    let edge_1 = || one.count < 3 || dimensions(on_1.clone(), blur).0 < 2;
    let edge_2 = || two.count < 3 || dimensions(on_2.clone(), blur).0 < 2;
    if crossing && edge_1() && edge_2() {
        Rest::Crossing(length)
    } else {
        Rest::Along(length)
    }
}

/// How many dimensions a set of points in a plane has, and its length, metres; what is shorter
/// or narrower than the square root of `blur`, m², is nothing.
fn dimensions(points: impl Iterator<Item = Vec3> + Clone, blur: Real) -> (u32, Real) {
    let Some(first) = points.clone().next() else {
        return (0, 0.0);
    };
    let sides = points.map(|p| p - first);
    let longest = sides.clone().fold(Vec3::zeros(), |l, s| {
        if s.norm_squared() > l.norm_squared() {
            s
        } else {
            l
        }
    });
    let length2 = longest.norm_squared();
    if !(length2 > blur) {
        return (0, 0.0);
    }
    let across2 = sides.fold(0.0, |w, s| larger(w, longest.cross(&s).norm_squared()));
    (1 + u32::from(across2 > blur * length2), length2.sqrt())
}

/// Moves the witness points of a hit to the middle of the touching region, where it has
/// one. Five support points.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
#[inline(always)]
pub fn settle<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    hit: &mut Penetration,
    tolerance: Real,
) -> Result<(), Fault> {
    if hit.width > 0.0 {
        to_middle(md, hit, tolerance)?;
    }
    Ok(())
}

#[inline(never)]
fn to_middle<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    hit: &mut Penetration,
    tolerance: Real,
) -> Result<(), Fault> {
    let n = hit.normal;
    let e1 = perpendicular(&n);
    let e2 = n.cross(&e1);
    // The face's own normal is within tolerance / width of n, about: twice that finds its
    // corners.
    let tolerance = math::tolerance(tolerance, hit.width, 0.0);
    let tilt = larger(2.0 * tolerance / hit.width, 64.0 * EPSILON);
    let mut corners = [SupportPoint::default(); AROUND];
    let mut reach: Real = 0.0;
    for (corner, [c, s]) in corners.iter_mut().zip(CIRCLE) {
        let d = n + (e1 * c + e2 * s) * tilt;
        *corner = md.support(&(d / d.norm()))?;
        reach = larger(reach, corner.magnitude());
    }
    let slack = 0.5 * tilt * hit.width + 8.0 * EPSILON * reach;
    // Corners far from where the objects touch may lie a little lower.
    let least = hit.depth - 2.0 * slack;
    if corners.iter().any(|p| !(n.dot(&p.v) >= least)) {
        // A direction aside found another face: this one is not what it seemed.
        return Ok(());
    }
    let origin = hit.point1;
    let flat = |p: Vec3| {
        let p = p - origin;
        [e1.dot(&p), e2.dot(&p)]
    };
    let lift = n * hit.depth;
    let one = Polygon::<ROOM>::of(corners.map(|p| flat(p.v1)));
    let two = Polygon::<ROOM>::of(corners.map(|p| flat(p.v2 + lift)));
    let (small, large) = if one.area() > two.area() {
        (two, one)
    } else {
        (one, two)
    };
    let middle = if large.area() > 4.0 * slack * hit.width {
        small.inside(&large, slack).middle()
    } else {
        // No halfplanes: two edges, or less.
        shared(small.edge(), large.edge())
    };
    if let Some([x, y]) = middle {
        move_to(hit, &(origin + e1 * x + e2 * y));
    }
    Ok(())
}

/// The middle of what two edges share that lie along each other.
fn shared([a, b]: [Flat; 2], [p, q]: [Flat; 2]) -> Option<Flat> {
    let s = side(&a, &b);
    // How far a point is along the first edge and beside it, as shares of its length.
    let at = |c: &Flat| {
        let d = side(&a, c);
        [dot(&s, &d), cross(&s, &d)].map(|x| x / dot(&s, &s))
    };
    let [[from, one], [to, other]] = [at(&p), at(&q)];
    if !(larger(one.abs(), other.abs()) <= ASIDE) {
        return None;
    }
    let (from, to) = (larger(from.min(to), 0.0), from.max(to).min(1.0));
    // NaN, of an edge without length, is no share.
    (from <= to).then(|| between(&a, &b, 0.5 * (from + to)))
}

/// Edges that are aside of each other by no more than this share of their length lie along each
/// other. Free: more than the tilt moves the edge of a rounded object, less than shows.
const ASIDE: Real = 1e-3;

/// Moves the witness points of a hit, in their planes, to the middle of the touching region.
#[inline]
pub fn move_to(hit: &mut Penetration, middle: &Vec3) {
    let n = hit.normal;
    hit.point1 = middle + n * n.dot(&(hit.point1 - middle));
    hit.point2 = hit.point1 - n * hit.depth;
}

/// A number made of points of the two objects, in any order: that it is another one for other
/// points is as sure as 64 bits can make it.
pub fn mark(points: impl Iterator<Item = [Vec3; 2]>) -> u64 {
    points.fold(0, |sum: u64, p| {
        // Fowler, Noll and Vo's hash, a word at a time, its high bits brought down.
        let of_one = p
            .iter()
            .flatten()
            .fold(0xcbf2_9ce4_8422_2325, |hash: u64, x| {
                #[allow(clippy::unnecessary_cast)] // In double precision.
                let word = (*x as f64).to_bits();
                let mixed = (hash ^ word).wrapping_mul(0x0100_0000_01b3);
                mixed ^ mixed >> 29
            });
        sum.wrapping_add(of_one)
    })
}

/// Can neither object move while its points, these, stay where they are? Not so, where they lie
/// on one line.
pub fn pins(points: impl Iterator<Item = [Vec3; 2]> + Clone) -> bool {
    (0..2).all(|object| {
        let own = points.clone().map(|p| p[object % 2]);
        let longest = dimensions(own.clone(), 0.0).1;
        // Narrower than a millionth of its length is a line.
        dimensions(own, 1e-12 * longest * longest).0 == 2
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Answer, Settings};
    use crate::math::unit;
    use crate::shapes::{Random, Rotation, ball, corners, hull, placed};
    use crate::{query::Pair, state::State};

    const TOLERANCE: Real = if EPSILON < 1e-10 { 1e-7 } else { 1e-4 };

    /// A box turned about z, of half extents `h`.
    fn turned(centre: Vec3, h: Vec3, angle: Real) -> impl Fn(&Vec3) -> Vec3 {
        let rotation = Rotation::from_axis_angle(&Vec3::z_axis(), angle);
        hull(&placed(&corners(h), &rotation, centre))
    }

    /// The local search's answer.
    fn answer(a: impl SupportMap, b: impl SupportMap) -> Penetration {
        let pair = Pair {
            md: MinkowskiDifference::new(a, b),
            centre: None,
            first_dir: Some(Vec3::new(0.1, 0.2, 1.0)),
            lasting: false,
        };
        let settings = Settings {
            tolerance: TOLERANCE,
            max_iterations: 500,
        };
        match pair.local(&mut State::default(), &settings, true) {
            Ok(Answer::Hit(hit)) => hit,
            other => panic!("{other:?}"),
        }
    }

    /// The middle of the witness points, and the width of what touches.
    fn contact(a: impl SupportMap, b: impl SupportMap) -> (Vec3, Real) {
        let hit = answer(a, b);
        let apart = hit.point1 - hit.point2 - hit.dir * hit.depth;
        assert!(apart.norm() <= TOLERANCE, "{apart}");
        ((hit.point1 + hit.point2) * 0.5, hit.width)
    }

    #[test]
    fn a_box_rests_on_a_plate_at_its_middle() {
        let plate = || turned(Vec3::zeros(), Vec3::new(2.0, 3.0, 0.1), 0.0);
        for k in 0..40 {
            // Right angles among them: the corners tie.
            let angle = k as Real * core::f64::consts::FRAC_PI_8 as Real * 0.5;
            let centre = Vec3::new(0.3, -0.4, 0.39);
            let small = turned(centre, Vec3::new(0.5, 0.2, 0.3), angle);
            let (pos, width) = contact(plate(), small);
            assert!(width > 0.0);
            assert!(
                (pos - Vec3::new(0.3, -0.4, 0.095)).norm() < 4.0 * TOLERANCE,
                "{k}: {pos}"
            );
        }
    }

    #[test]
    fn what_hangs_over_does_not_count() {
        let a = turned(Vec3::zeros(), Vec3::repeat(1.0), 0.0);
        let b = turned(Vec3::new(1.5, 0.8, 1.9), Vec3::repeat(1.0), 0.0);
        // Of [-1, 1] and [0.5, 2.5]; of [-1, 1] and [-0.2, 1.8].
        let (pos, _) = contact(a, b);
        assert!(
            (pos - Vec3::new(0.75, 0.4, 0.95)).norm() < 4.0 * TOLERANCE,
            "{pos}"
        );
    }

    #[test]
    fn an_edge_on_a_face_is_a_segment() {
        let plate = turned(Vec3::zeros(), Vec3::new(1.0, 1.0, 0.5), 0.3);
        let bar = |d: &Vec3| {
            Vec3::new(
                0.2,
                0.1 + (0.6 as Real).copysign(d.y),
                0.45 + 0.2 * Real::from(d.z > 0.0),
            )
        };
        let (pos, width) = contact(plate, bar);
        assert!(width > 0.0);
        assert!(
            (pos - Vec3::new(0.2, 0.1, 0.475)).norm() < 4.0 * TOLERANCE,
            "{pos}"
        );
    }

    /// They touch along a line, of which no two halfplanes are left.
    #[test]
    fn a_cylinder_lies_along_another() {
        let cylinder = |centre: Vec3, axis: Vec3, radius: Real, half: Real| {
            move |d: &Vec3| {
                let along = axis * axis.dot(d);
                let aside = unit(&(d - along)).map_or(Vec3::zeros(), |n| n * radius);
                centre + axis * half.copysign(axis.dot(d)) + aside
            }
        };
        let mut r = Random::new(12);
        let (mut met, mut aside) = (0, 0);
        for _ in 0..200 {
            let axis = r.direction();
            let up = unit(&axis.cross(&r.direction())).unwrap();
            let a = cylinder(Vec3::zeros(), axis, 0.3, 1.0);
            let b = cylinder(axis * 0.4 + up * 0.49, axis, 0.2, 0.8);
            let hit = answer(a, b);
            if (hit.depth - 0.01).abs() > 10.0 * TOLERANCE {
                // A local minimum along the axis.
                continue;
            }
            met += 1;
            // Of [-1, 1] and [-0.4, 1.2]; between 0.29 and 0.3 up.
            let off = (hit.point1 + hit.point2) * 0.5 - axis * 0.3 - up * 0.295;
            aside += usize::from(!(off.norm() < 100.0 * TOLERANCE.sqrt()));
        }
        // Once no point asked has shown the other end.
        assert!(met > 100 && aside * 100 <= met, "{aside} of {met}");
    }

    #[test]
    fn a_contact_of_one_point_costs_nothing() {
        let plate = || turned(Vec3::zeros(), Vec3::new(1.0, 1.0, 0.5), 0.3);
        let ball = ball(Vec3::new(0.2, 0.1, 0.9), 0.5);
        let octahedron = |d: &Vec3| {
            let at = d.iamax();
            let mut p = Vec3::new(0.2, 0.1, 0.9);
            p[at] += (0.5 as Real).copysign(d[at]);
            p
        };
        let (at_ball, of_ball) = contact(plate(), ball);
        let (at_vertex, of_vertex) = contact(plate(), octahedron);
        assert_eq!((of_ball, of_vertex), (0.0, 0.0));
        for pos in [at_ball, at_vertex] {
            assert!((pos - Vec3::new(0.2, 0.1, 0.45)).norm() < 1e-2, "{pos}");
        }
    }
}
