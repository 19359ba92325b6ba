// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Makes the contact manifold: the region in which the faces of two objects lie over each other, as a few points.
//!
//! Steps:
//! 1. *Faces.* Find the reference and the incident face ([`crate::contact::face`]), convex polygons in the
//!    contact frame.
//! 2. *Clipping.* Clip the smaller by the larger one (Sutherland and Hodgman). Each corner of the region has a
//!    point on either face, whose distance along the normal is the depth there. Segments that cross share a
//!    point. Nearly parallel ones share a strip as wide as the slop allows of their roundness: sqrt(2 R slop)
//!    beside its middle a surface of radius R is the slop low.
//! 3. *Beside each other.* Faces that share nothing have a closest point each. Their middle is the contact where
//!    they are no farther apart than the slop; else the two are, though one is not over the other.
//! 4. *Reduction.* The deepest point stays, and those that span the largest area with it; points that had ids
//!    stay while they span nine tenths of that.

use crate::contact::face::{Face, MAX_CORNERS, faces};
use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::{ContactIds, ManifoldCache};
use crate::contact::polygon::{Corner, FixedVec, Point2, Polygon, cross, dot, lerp, norm, vector};
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
    /// The contact id, not 0, while it moves with either object; 0 without a cache.
    pub id: u32,
}

/// Corners of a region at most: each side of one face adds at most one to those of the other.
pub const MAX_CONTACTS: usize = 2 * MAX_CORNERS;
/// The sine of the angle up to which segments share a strip: 10°.
const MAX_PARALLEL_SINE: f64 = 0.17;

/// A contact manifold.
#[derive(Clone, Copy, Default)]
pub struct Manifold(FixedVec<Contact, MAX_CONTACTS>);

impl Manifold {
    /// Returns the contacts, the deepest first.
    pub fn contacts(&self) -> &[Contact] {
        &self.0
    }
}

/// Returns the contacts of the faces along unit `normal` and against it, at most `max` of them. Takes at most 24
/// queries of each object, and those of a cache that no longer fits.
///
/// # Errors
/// [`Fault::NonFinite`] from a support function.
pub fn contacts<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    normal: &Vec3,
    slop: f64,
    out_cache: Option<&mut ManifoldCache>,
    max: usize,
) -> Result<Manifold, Fault> {
    let mut cache = out_cache.as_deref().copied();
    let again = cache.as_mut().and_then(|cache| cache.frame(normal));
    let cached = cache.as_ref().filter(|_| again.is_some());
    let mut frame = again.unwrap_or_else(|| ContactFrame::right_handed(normal));
    let ([one, two], slop) = faces(obj1, obj2, &mut frame, slop, cached)?;
    let (mut region, beside) = overlap(&one, &two);
    for corner in region.iter_mut() {
        corner.low = one.low(&corner.at) + two.low(&corner.at);
    }
    let ids = cache.as_ref().map_or(ContactIds::default(), |cache| {
        let slop = larger(one.slop, two.slop);
        cache.ids([one.motion, two.motion], &region, slop)
    });
    let reduced = reduced(&region, &ids, max, one.rounding + two.rounding);
    let mut manifold = Manifold::default();
    let mut stored_ids: FixedVec<(Point2, u32), MAX_CONTACTS> = FixedVec::default();
    for corner in reduced.iter() {
        let [at1, at2] = beside.unwrap_or([corner.at; 2]);
        let lows = [one.low(&at1), two.low(&at2)];
        let point1 = frame.point(at1[0], at1[1]) + frame.normal * (one.top - lows[0]);
        let depth = one.top + two.top - lows[0] - lows[1];
        let [x, y] = vector(&at1, &at2);
        let across = frame.axes[0] * x + frame.axes[1] * y;
        let mut all = region.iter();
        let id = ids.of(all.position(|c| c.at == corner.at).unwrap_or(MAX_CONTACTS));
        let id = match &mut cache {
            Some(cache) if id == 0 => cache.new_id(),
            _ => id,
        };
        stored_ids.push((corner.at, id));
        manifold.0.push(Contact {
            point1,
            point2: point1 - frame.normal * depth + across,
            depth,
            id,
        });
    }
    if let (Some(out_cache), Some(mut cache)) = (out_cache, cache) {
        cache.store(&frame, slop, [one.ring, two.ring], &stored_ids);
        *out_cache = cache;
    }
    Ok(manifold)
}

/// Returns at most `max` corners of the region, the deepest first. Those that have ids stay while they span nine
/// tenths of the largest area; differences of depth by `tie` are rounding.
fn reduced(
    region: &Polygon<MAX_CONTACTS>,
    ids: &ContactIds,
    max: usize,
    tie: f64,
) -> Polygon<MAX_CONTACTS> {
    let corners: &[Corner] = region;
    // Rounding alone makes no corner the deepest.
    let (mut deepest, mut least) = (0, corners.first().map_or(0.0, |corner| corner.low));
    for (i, corner) in corners.iter().enumerate() {
        if corner.low < least - tie {
            (deepest, least) = (i, corner.low);
        }
    }
    if let Some(i) = ids.first {
        let still = corners.get(i).is_some_and(|c| c.low <= least + tie);
        deepest = if still { i } else { deepest };
    }
    let best = region.reduced(deepest, max);
    if corners.len() <= max || ids.of(deepest) == 0 {
        return best;
    }
    let mut kept = Polygon::default();
    for i in (deepest..corners.len()).chain(0..deepest) {
        if ids.of(i) != 0 {
            kept.push(*region.at(i));
        }
    }
    let size = |p: &Polygon<MAX_CONTACTS>| match &**p {
        [a, b] => norm(&vector(&a.at, &b.at)),
        _ => p.area(),
    };
    if kept.len() == best.len() && size(&kept) >= 0.9 * size(&best) {
        return kept;
    }
    best
}

/// Returns the region that two faces share. Where they share nothing within the slop: the point between them, and
/// the closest point of each.
fn overlap(one: &Face, two: &Face) -> (Polygon<MAX_CONTACTS>, Option<[Point2; 2]>) {
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
    let mut region: Polygon<MAX_CONTACTS> = Polygon::default();
    let lines = match (&**small, &**large) {
        ([a, b], [c, d]) => Some([[a.at, b.at], [c.at, d.at]]),
        _ => None,
    };
    if let Some(sides) = &lines {
        region = crossing(sides).map_or(region, Polygon::point);
    } else if large.len() > 2 {
        small.iter().for_each(|corner| region.push(*corner));
        region = region.clipped_by(large, rounding);
    }
    if !region.is_empty() {
        return (region.tidied(rounding, rounding), None);
    }
    let Some((sides, [a, b])) = small.closest_sides(large) else {
        return (region, None);
    };
    if lines.is_some() || one.round() + two.round() > 0.0 {
        region = parallel_overlap(&sides, slack, share, rounding);
    }
    if !region.is_empty() {
        return (region, None);
    }
    region = Polygon::point(lerp(&a, &b, 0.5));
    let far = norm(&vector(&a, &b)) > one.slop.min(two.slop);
    let points = if swapped { [b, a] } else { [a, b] };
    (region, far.then_some(points))
}

/// Returns where two segments cross that are not nearly parallel.
fn crossing([[p, q], [r, s]]: &[[Point2; 2]; 2]) -> Option<Point2> {
    let (u, v, w) = (vector(p, q), vector(r, s), vector(p, r));
    let whole = cross(&u, &v);
    if !(whole.abs() > MAX_PARALLEL_SINE * norm(&u) * norm(&v)) {
        return None;
    }
    let [t, k] = [cross(&w, &v), cross(&w, &u)].map(|x| x / whole);
    let on = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&k);
    on.then(|| lerp(p, q, t))
}

/// Returns the ends of what two nearly parallel segments share, where they are no farther apart than `slack`,
/// moved by a `share` of the way to the second. These lie between the ends of both segments: across the
/// second one they may be moved beyond an end of the first. None where nothing is shared.
fn parallel_overlap(
    [[p, q], [r, s]]: &[[Point2; 2]; 2],
    slack: f64,
    share: f64,
    rounding: f64,
) -> Polygon<MAX_CONTACTS> {
    let mut ends = Polygon::default();
    let (u, v) = (vector(p, q), vector(r, s));
    let whole = norm(&u) * norm(&v);
    if !(cross(&u, &v).abs() <= MAX_PARALLEL_SINE * whole && whole > 0.0) {
        return ends;
    }
    let longer = slack / norm(&u);
    for at in [lerp(p, q, -longer), lerp(p, q, 1.0 + longer)] {
        ends.push(Corner { at, low: 0.0 });
    }
    let (left, right) = ([-v[1], v[0]], [v[1], -v[0]]);
    let mut ends = ends.clipped(r, &left, slack).clipped(r, &right, slack);
    for end in ends.iter_mut() {
        let t = dot(&v, &vector(r, &end.at)) / dot(&v, &v);
        end.at = lerp(&end.at, &lerp(r, s, t), share);
    }
    let [back_u, back_v] = [u, v].map(|way| way.map(|x| -x));
    let ends = ends.clipped(p, &u, rounding).clipped(q, &back_u, rounding);
    let ends = ends.clipped(r, &v, rounding).clipped(s, &back_v, rounding);
    ends.tidied(rounding, 0.0)
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
        let whole = stacked(angle, MAX_CONTACTS);
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

    /// Two rods side by side, without a slop: a contact is on both.
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
