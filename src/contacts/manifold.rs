// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where two objects touch: the region in which their faces lie over each other, as a few
//! points.
//!
//! # Derivation
//!
//! *Faces.* Each object shows one, [`crate::contacts::face`].
//!
//! *Region.* Both faces are convex polygons in the plane across n, and so is what they
//! share. Each of its corners has a point on either face, whose heights along n differ by
//! the depth there. Segments that cross share a point. Nearly parallel ones share a strip
//! as wide as the slop makes of the roundness: sqrt(2 R slop) aside of the middle a surface
//! of radius R is as much as the slop low. Faces that share nothing have a nearest point
//! each; where these are no farther apart than the slop the middle of them is the contact, else the two are, though they do not lie over each other.
//!
//! *Reduction.* The deepest point stays; with it, those that span the largest area.

use crate::contacts::face::{CORNERS, Face, faces};
use crate::contacts::list::List;
use crate::contacts::memory::{Memory, Names};
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{Corner, Flat, Polygon, between, cross, dot, length, side};
use crate::math::{Vec3, larger};
use crate::minkowski::support::{Fault, SupportMap};

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// On obj1, metres.
    pub point1: Vec3,
    /// On obj2: `point1 - depth * normal`, unless the faces share nothing.
    pub point2: Vec3,
    /// How deep the objects overlap there, metres; negative where they are apart.
    pub depth: f64,
    /// Its name, as long as it moves with either body; 0 without a memory.
    pub name: u32,
}

/// Corners of what two faces share: each side of the one adds at most one to the other's.
pub const ROOM: usize = 2 * CORNERS;
/// Sine of the angle up to which segments may share a strip: 10°.
const PARALLEL: f64 = 0.17;

/// The points of a contact.
#[derive(Clone, Copy, Default)]
pub struct Manifold(List<Contact, ROOM>);

impl Manifold {
    /// The points, the deepest first.
    pub fn contacts(&self) -> &[Contact] {
        &self.0
    }
}

/// The points in which the objects touch, as their faces that look along the unit vector
/// `normal` and against it show, at most `max` of them. At most 24 support points of each, and
/// those that ask in vain for what the memory holds.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
pub fn contacts<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    normal: &Vec3,
    slop: f64,
    memory: Option<&mut Memory>,
    max: usize,
) -> Result<Manifold, Fault> {
    let mut known = memory.as_deref().copied();
    let again = known.as_mut().and_then(|known| known.plane(normal));
    let cached = known.as_ref().filter(|_| again.is_some());
    let mut plane = again.unwrap_or_else(|| Plane::of(normal));
    let ([one, two], slop) = faces(obj1, obj2, &mut plane, slop, cached)?;
    let (mut region, beside) = shared(&one, &two);
    for corner in region.iter_mut() {
        corner.low = one.low(&corner.at) + two.low(&corner.at);
    }
    let names = known.as_ref().map_or(Names::default(), |known| {
        let slop = larger(one.slop, two.slop);
        known.names([one.motion, two.motion], &region, slop)
    });
    let chosen = chosen(&region, &names, max, one.rounding + two.rounding);
    let mut manifold = Manifold::default();
    let mut named: List<(Flat, u32), ROOM> = List::default();
    for corner in chosen.iter() {
        let [at1, at2] = beside.unwrap_or([corner.at; 2]);
        let lows = [one.low(&at1), two.low(&at2)];
        let point1 = plane.point(&at1, one.top - lows[0]);
        let depth = one.top + two.top - lows[0] - lows[1];
        let across = plane.point(&side(&at1, &at2), 0.0) - plane.origin;
        let mut all = region.iter();
        let name = names.of(all.position(|c| c.at == corner.at).unwrap_or(ROOM));
        let name = match &mut known {
            Some(known) if name == 0 => known.name(),
            _ => name,
        };
        named.push((corner.at, name));
        manifold.0.push(Contact {
            point1,
            point2: point1 - plane.n * depth + across,
            depth,
            name,
        });
    }
    if let (Some(memory), Some(mut known)) = (memory, known) {
        known.keep(&plane, slop, [one.ring, two.ring], &named);
        *memory = known;
    }
    Ok(manifold)
}

/// At most `max` corners of the region, the deepest first. Those that have names stay while
/// they span nine tenths of the largest area; differences by `tie` are rounding.
fn chosen(region: &Polygon<ROOM>, names: &Names, max: usize, tie: f64) -> Polygon<ROOM> {
    let corners: &[Corner] = region;
    // Rounding alone makes no corner the deepest.
    let (mut deepest, mut least) = (0, corners.first().map_or(0.0, |corner| corner.low));
    for (i, corner) in corners.iter().enumerate() {
        if corner.low < least - tie {
            (deepest, least) = (i, corner.low);
        }
    }
    if let Some(i) = names.first {
        let still = corners.get(i).is_some_and(|c| c.low <= least + tie);
        deepest = if still { i } else { deepest };
    }
    let best = region.reduced(deepest, max);
    if corners.len() <= max || names.of(deepest) == 0 {
        return best;
    }
    let mut kept = Polygon::default();
    for i in (deepest..corners.len()).chain(0..deepest) {
        if names.of(i) != 0 {
            kept.push(*region.at(i));
        }
    }
    let size = |p: &Polygon<ROOM>| match &**p {
        [a, b] => length(&side(&a.at, &b.at)),
        _ => p.area(),
    };
    if kept.len() == best.len() && size(&kept) >= 0.9 * size(&best) {
        return kept;
    }
    best
}

/// What the two faces share; where that is nothing within the slop, the point between them, and
/// the nearest point of each.
fn shared(one: &Face, two: &Face) -> (Polygon<ROOM>, Option<[Flat; 2]>) {
    let rounding = larger(one.rounding, two.rounding);
    let reach = [one.reach(), two.reach()];
    let (mut small, mut large, mut own) = (&one.corners, &two.corners, reach[0]);
    let swapped = small.area() > large.area();
    if swapped {
        (small, large, own) = (large, small, reach[1]);
    }
    let slack = reach[0] + reach[1];
    // A point between the two is to be on both: the rounder one reaches farther.
    let share = own / slack;
    let mut region: Polygon<ROOM> = Polygon::default();
    let lines = match (&**small, &**large) {
        ([a, b], [c, d]) => Some([[a.at, b.at], [c.at, d.at]]),
        _ => None,
    };
    if let Some(sides) = &lines {
        region = crossing(sides).map_or(region, Polygon::point);
    } else if large.len() > 2 {
        small.iter().for_each(|corner| region.push(*corner));
        region = region.inside(large, rounding);
    }
    if !region.is_empty() {
        return (region.tidy(rounding, rounding), None);
    }
    let Some((sides, [a, b])) = small.nearest(large) else {
        return (region, None);
    };
    if lines.is_some() || one.round() + two.round() > 0.0 {
        region = strip(&sides, slack, share, rounding);
    }
    if !region.is_empty() {
        return (region, None);
    }
    region = Polygon::point(between(&a, &b, 0.5));
    let far = length(&side(&a, &b)) > one.slop.min(two.slop);
    let points = if swapped { [b, a] } else { [a, b] };
    (region, far.then_some(points))
}

/// Where two segments cross, at more than an angle that makes them parallel.
fn crossing([[p, q], [r, s]]: &[[Flat; 2]; 2]) -> Option<Flat> {
    let (u, v, w) = (side(p, q), side(r, s), side(p, r));
    let whole = cross(&u, &v);
    if !(whole.abs() > PARALLEL * length(&u) * length(&v)) {
        return None;
    }
    let [t, k] = [cross(&w, &v), cross(&w, &u)].map(|x| x / whole);
    let on = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&k);
    on.then(|| between(p, q, t))
}

/// Returns the ends of what two nearly parallel segments share, where they are no farther apart than `slack`,
/// moved by a `share` of the way to the second. These lie between the ends of both segments: across the
/// second one they may be moved beyond an end of the first. None where nothing is shared.
fn strip(
    [[p, q], [r, s]]: &[[Flat; 2]; 2],
    slack: f64,
    share: f64,
    rounding: f64,
) -> Polygon<ROOM> {
    let mut ends = Polygon::default();
    let (u, v) = (side(p, q), side(r, s));
    let whole = length(&u) * length(&v);
    if !(cross(&u, &v).abs() <= PARALLEL * whole && whole > 0.0) {
        return ends;
    }
    let longer = slack / length(&u);
    for at in [between(p, q, -longer), between(p, q, 1.0 + longer)] {
        ends.push(Corner { at, low: 0.0 });
    }
    let (left, right) = ([-v[1], v[0]], [v[1], -v[0]]);
    let mut ends = ends.cut(r, &left, slack).cut(r, &right, slack);
    for end in ends.iter_mut() {
        let t = dot(&v, &side(r, &end.at)) / dot(&v, &v);
        end.at = between(&end.at, &between(r, s, t), share);
    }
    let [back_u, back_v] = [u, v].map(|way| way.map(|x| -x));
    let ends = ends.cut(p, &u, rounding).cut(q, &back_u, rounding);
    let ends = ends.cut(r, &v, rounding).cut(s, &back_v, rounding);
    ends.tidy(rounding, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, ball, capsule, corners, hull, placed};

    const SLOP: f64 = if EPSILON < 1e-10 { 1e-6 } else { 1e-4 };

    /// A square plate's top face at z = 0, and a box on it, turned about z.
    fn stacked(angle: f64, max: usize) -> Manifold {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let turn = crate::shapes::Rotation::from_axis_angle(&Vec3::z_axis(), angle);
        let plate = placed(&plate, &turn, Vec3::z() * -0.5);
        let cube = corners(Vec3::new(1.0, 1.0, 0.5));
        let cube = placed(&cube, &turn.inverse(), Vec3::z() * 0.49);
        contacts(&hull(&plate), &hull(&cube), &Vec3::z(), SLOP, None, max).unwrap()
    }

    #[test]
    fn an_octagon_and_what_is_left_of_it() {
        let angle = core::f64::consts::FRAC_PI_8 as f64;
        let whole = stacked(angle, ROOM);
        assert_eq!(whole.contacts().len(), 8);
        for c in whole.contacts() {
            assert!((c.depth - 0.01).abs() < 64.0 * EPSILON);
            assert!(c.point1.z.abs() < 64.0 * EPSILON);
            let apart = c.point1 - c.point2 - Vec3::z() * c.depth;
            assert!(apart.norm() < 64.0 * EPSILON);
        }
        // In order around the normal.
        let area = |m: &Manifold| {
            let first = m.contacts()[0].point1;
            let spokes = m.contacts().iter().map(|c| c.point1 - first);
            let pairs = spokes.clone().zip(spokes.skip(1));
            pairs.map(|(a, b)| 0.5 * a.cross(&b).z).sum::<f64>()
        };
        let octagon = 8.0 * (2.0 as f64).sqrt() - 8.0;
        assert!((area(&whole) - octagon).abs() < 8.0 * SLOP);
        // Four of a regular octagon: a square, which has 1 / sqrt(2) of its area.
        let four = stacked(angle, 4);
        assert_eq!(four.contacts().len(), 4);
        assert!((area(&four) - octagon * (0.5 as f64).sqrt()).abs() < 8.0 * SLOP);
        let two = stacked(angle, 2);
        let long = (two.contacts()[0].point1 - two.contacts()[1].point1).norm();
        let angle = 2.0 * angle.cos();
        assert!(
            (long - 2.0 * (1.0 / (0.5 * angle))).abs() < 8.0 * SLOP,
            "{long}"
        );
        assert_eq!(stacked(0.3, 1).contacts().len(), 1);
    }

    #[test]
    fn the_deepest_is_first() {
        let mut r = Random::new(4);
        for _ in 0..200 {
            let plate = corners(Vec3::new(2.0, 2.0, 0.5));
            let turn = nalgebra::UnitQuaternion::from_scaled_axis(
                Vec3::new(
                    r.within(-0.2, 0.2),
                    r.within(-0.2, 0.2),
                    r.within(-3.0, 3.0),
                ) * 1.0,
            );
            let slop = 0.6;
            let cube = placed(&corners(Vec3::repeat(0.5)), &turn.into(), Vec3::z());
            let found = contacts(&hull(&plate), &hull(&cube), &Vec3::z(), slop, None, 4).unwrap();
            let deepest = found.contacts()[0].depth;
            assert!(
                found
                    .contacts()
                    .iter()
                    .all(|c| c.depth <= deepest + 64.0 * EPSILON)
            );
        }
    }

    #[test]
    fn round_objects_touch_in_points() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let at = Vec3::new(r.within(-0.3, 0.3), r.within(-0.3, 0.3), 0.89);
            let found = contacts(&hull(&plate), &ball(at, 0.4), &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.contacts().len(), 1);
            let across = found.contacts()[0].point1 - at;
            assert!(across.xy().norm() < SLOP, "{across}");
            let way = Vec3::new(0.3, r.within(-0.3, 0.3), 0.0);
            let rod = capsule(at - way, at + way, 0.4);
            let found = contacts(&hull(&plate), &rod, &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.contacts().len(), 2);
            for c in found.contacts() {
                let across = (c.point1 - at).xy();
                let end = (across - way.xy()).norm().min((across + way.xy()).norm());
                assert!(end < 2.0 * SLOP, "{end:e}");
            }
        }
    }

    /// Two rods side by side, without a slop: where they touch is on both.
    #[test]
    fn without_a_slop_what_touches_lies_on_both() {
        let mut r = Random::new(6);
        for round in 0..2000 {
            let [a, b] = [0, 1].map(|_| Vec3::z() * r.within(0.1, 1.0));
            let [p, q] = [0, 1].map(|_| r.within(0.1, 0.5));
            // So little deep that the least slop of the depth is none.
            let at = Vec3::new((p + q) * (1.0 - 1e-7), 0.0, r.within(-0.2, 0.2));
            let (one, two) = (capsule(-a, a, p), capsule(at - b, at + b, q));
            let found = contacts(&one, &two, &Vec3::x(), 0.0, None, 4).unwrap();
            for c in found.contacts() {
                let near = EPSILON.sqrt();
                assert!(c.point1.z.abs() < a.z + near, "{round}: {}", c.point1);
                assert!(
                    (c.point2 - at).z.abs() < b.z + near,
                    "{round}: {}",
                    c.point2
                );
            }
        }
    }
}
