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
use crate::contact::fixed_vec::FixedVec;
use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::ManifoldCache;
use crate::contact::polygon::{Polygon, Vec2, way};
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::support::{Fault, SupportMap};

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// On obj1, metres.
    pub point1: Vec3,
    /// On obj2: `point1 - depth * normal`, unless the faces share nothing.
    pub point2: Vec3,
    /// Depth of the overlap at the contact, metres; negative where the objects are apart.
    pub depth: f64,
    /// The contact id, not 0, while it moves with either object; 0 without a cache.
    pub id: u32,
}

/// Corners of a region at most: each side of one face adds at most one to those of the other.
pub const MAX_CONTACTS: usize = 2 * MAX_CORNERS;
/// The sine of the angle up to which segments share a strip: 10°.
const MAX_PARALLEL_SINE: f64 = 0.17;

/// A contact manifold: its contacts, the deepest first.
pub type Manifold = FixedVec<Contact, MAX_CONTACTS>;

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
    let mut cache = out_cache.as_deref().copied().unwrap_or_default();
    let followed = cache.frame(normal);
    let frame = followed.unwrap_or_else(|| ContactFrame::new(normal, &Vec3::zeros()));
    let ([one, two], slop) = faces(obj1, obj2, &frame, slop, followed.map(|_| &cache))?;
    let (mut region, beside) = overlap(&one, &two);
    for corner in region.iter_mut() {
        corner.z = one.corners.low(corner) + two.corners.low(corner);
    }
    let ids = cache.ids(
        [one.motion, two.motion],
        &region,
        larger(one.slop, two.slop),
    );
    let order = reduced(
        &region,
        &ids,
        cache.ids[0],
        max,
        one.rounding + two.rounding,
    );
    let mut manifold = Manifold::default();
    let mut stored_ids: FixedVec<(Vec3, u32), MAX_CONTACTS> = FixedVec::default();
    for i in order.iter() {
        let at = *region.at(*i);
        let [at1, at2] = beside.unwrap_or([at; 2]);
        let height1 = one.top - one.corners.low(&at1);
        let height2 = two.top - two.corners.low(&at2);
        let mut id = *ids.at(*i);
        if id == 0 {
            id = cache.new_id();
        }
        stored_ids.push((at, id));
        manifold.push(Contact {
            point1: frame.point(at1.xy()) + frame.normal * height1,
            point2: frame.point(at2.xy()) - frame.normal * height2,
            depth: height1 + height2,
            id: if out_cache.is_some() { id } else { 0 },
        });
    }
    if let Some(out_cache) = out_cache {
        cache.store(&frame, slop, [&one, &two], &stored_ids);
        *out_cache = cache;
    }
    // In order around the normal.
    if let ([_, others @ ..], false) = (&mut *manifold, frame.is_right_handed()) {
        others.reverse();
    }
    Ok(manifold)
}

/// Returns the indices of at most `max` corners of the region, the deepest first. Those that have ids stay while they
/// span nine tenths of the largest area; differences of depth by `tie` are rounding.
fn reduced(
    region: &Polygon<MAX_CONTACTS>,
    ids: &FixedVec<u32, MAX_CONTACTS>,
    first_id: u32,
    max: usize,
    tie: f64,
) -> FixedVec<usize, MAX_CONTACTS> {
    // Rounding alone makes no corner the deepest.
    let is_deeper = |i: usize, j: usize| region.at(i).z < region.at(j).z - tie;
    let mut deepest = (1..region.len()).fold(0, |k, i| if is_deeper(i, k) { i } else { k });
    let is_first = |i: &usize| first_id != 0 && *ids.at(*i) == first_id && !is_deeper(deepest, *i);
    deepest = (0..region.len()).find(is_first).unwrap_or(deepest);
    let best = region.reduced(deepest, max);
    if region.len() > max && *ids.at(deepest) != 0 {
        let kept = (deepest..deepest + region.len()).filter(|i| *ids.at(*i) != 0);
        let kept: FixedVec<usize, MAX_CONTACTS> = kept.collect();
        let size = |indices: &[usize]| {
            let corners: Polygon<MAX_CONTACTS> = indices.iter().map(|i| *region.at(*i)).collect();
            match &*corners {
                [a, b] => way(a, b).norm(),
                _ => corners.area(),
            }
        };
        if kept.len() == best.len() && size(&kept) >= 0.9 * size(&best) {
            return kept;
        }
    }
    best
}

/// Returns the region that two faces share. Where they share nothing within the slop: the point between them, and
/// the closest point of each.
fn overlap(one: &Face, two: &Face) -> (Polygon<MAX_CONTACTS>, Option<[Vec3; 2]>) {
    let rounding = larger(one.rounding, two.rounding);
    let is_swapped = one.corners.area() > two.corners.area();
    let [small, large] = if is_swapped { [two, one] } else { [one, two] };
    let mut region = Polygon::default();
    if large.corners.len() > 2 {
        region = small.corners.iter().copied().collect();
        region = region.clipped_by(&large.corners, rounding);
    }
    if !region.is_empty() {
        return (region.tidied(rounding, rounding), None);
    }
    let Some((sides, [a, b])) = small.corners.closest_sides(&large.corners) else {
        return (region, None);
    };
    if large.corners.len() == 2 || one.round + two.round > 0.0 {
        region = shared_by_segments(&sides, [small.reach(), large.reach()], rounding);
    }
    if !region.is_empty() {
        return (region, None);
    }
    region.push(a.lerp(&b, 0.5));
    let is_far = way(&a, &b).norm() > lesser(one.slop, two.slop);
    let points = if is_swapped { [b, a] } else { [a, b] };
    (region, is_far.then_some(points))
}

/// Returns the point at which two segments cross. Of nearly parallel ones the ends of what they share, where they are
/// no farther apart than both reach: on the way from the first to the second by the share of the first one's reach,
/// because the rounder one reaches farther. These lie between the ends of both segments: across the second one they
/// may be moved beyond an end of the first. None where nothing is shared.
fn shared_by_segments(
    [[p, q], [r, s]]: &[[Vec3; 2]; 2],
    reach: [f64; 2],
    rounding: f64,
) -> Polygon<MAX_CONTACTS> {
    let (u, v, slack) = (way(p, q), way(r, s), reach[0] + reach[1]);
    let (size, sine) = (u.norm() * v.norm(), u.perp(&v));
    if sine.abs() > MAX_PARALLEL_SINE * size {
        let [t, k] = [v, u].map(|along| way(p, r).perp(&along) / sine);
        let is_on_both = [t, k].iter().all(|t| (0.0..=1.0).contains(t));
        return is_on_both.then(|| p.lerp(q, t)).into_iter().collect();
    }
    if !(size > 0.0) {
        return Polygon::default();
    }
    let longer = slack / u.norm();
    let left = Vec2::new(-v.y, v.x);
    let ends = Polygon::from_iter([-longer, 1.0 + longer].map(|t| p.lerp(q, t)));
    let mut ends = ends.clipped(r, &left, slack).clipped(r, &-left, slack);
    for end in ends.iter_mut() {
        let t = v.dot(&way(r, end)) / v.norm_squared();
        *end = end.lerp(&r.lerp(s, t), reach[0] / slack);
    }
    for (from, inwards) in [(p, u), (q, -u), (r, v), (s, -v)] {
        ends = ends.clipped(from, &inwards, rounding);
    }
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
        assert_eq!(whole.len(), 8);
        for c in whole.iter() {
            assert!((c.depth - 0.01).abs() < 64.0 * EPSILON);
            assert!(c.point1.z.abs() < 64.0 * EPSILON);
            let apart = c.point1 - c.point2 - Vec3::z() * c.depth;
            assert!(apart.norm() < 64.0 * EPSILON);
        }
        // In order around the normal.
        let area = |m: &Manifold| {
            let first = m[0].point1;
            let spokes = m.iter().map(|c| c.point1 - first);
            let pairs = spokes.clone().zip(spokes.skip(1));
            pairs.map(|(a, b)| 0.5 * a.cross(&b).z).sum::<f64>()
        };
        let octagon = 8.0 * (2.0 as f64).sqrt() - 8.0;
        assert!((area(&whole) - octagon).abs() < 8.0 * SLOP);
        // Four of a regular octagon: a square, which has 1 / sqrt(2) of its area.
        let four = stacked(angle, 4);
        assert_eq!(four.len(), 4);
        assert!((area(&four) - octagon * (0.5 as f64).sqrt()).abs() < 8.0 * SLOP);
        let two = stacked(angle, 2);
        let long = (two[0].point1 - two[1].point1).norm();
        let angle = 2.0 * angle.cos();
        assert!(
            (long - 2.0 * (1.0 / (0.5 * angle))).abs() < 8.0 * SLOP,
            "{long}"
        );
        assert_eq!(stacked(0.3, 1).len(), 1);
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
            let deepest = found[0].depth;
            assert!(found.iter().all(|c| c.depth <= deepest + 64.0 * EPSILON));
        }
    }

    #[test]
    fn round_objects_touch_in_points() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let at = Vec3::new(r.within(-0.3, 0.3), r.within(-0.3, 0.3), 0.89);
            let found = contacts(&hull(&plate), &ball(at, 0.4), &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.len(), 1);
            let across = found[0].point1 - at;
            assert!(across.xy().norm() < SLOP, "{across}");
            let way = Vec3::new(0.3, r.within(-0.3, 0.3), 0.0);
            let rod = capsule(at - way, at + way, 0.4);
            let found = contacts(&hull(&plate), &rod, &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.len(), 2);
            for c in found.iter() {
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
            for c in found.iter() {
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
