// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Makes the contact manifold: the region in which the faces of two objects overlap in projection along the normal,
//! as a few points.
//!
//! 1. *Faces.* Find the faces of both objects ([`crate::contact::face_search`]), convex polygons in the contact frame.
//! 2. *Clipping.* Clip the smaller face by the larger one (Sutherland and Hodgman). Each corner of the region has a
//!    point on both faces, whose distance along the normal is the depth there. Two segments have a crossing point
//!    or, if they are nearly parallel, a common part, for which a distance of sqrt(2 R slop) is allowed: there a
//!    rounded surface of radius R is the slop below its highest line.
//! 3. *Disjoint faces.* If the faces do not overlap in projection, there is one contact: at the midpoint of their
//!    closest points if these are within the slop of each other, else with the two closest points themselves.
//! 4. *Reduction.* Keep the deepest point and those that span the largest area with it. Points with old ids are kept
//!    instead if they span at least nine tenths of that area.

use crate::contact::face::{ContactFace, MAX_CONTACTS};
use crate::contact::face_search::faces;
use crate::contact::frame::ContactFrame;
use crate::contact::manifold_cache::ManifoldCache;
use crate::geometry::fixed_vec::FixedVec;
use crate::geometry::polygon::{Polygon, Vec2, offset};
use crate::math::{Real, Vec3, larger, lesser, to_real};
use crate::minkowski::support::{Fault, SupportMap};
use crate::types::Contact;

/// The sine between two segments up to which they count as parallel: 14°.
const PARALLEL_SINE: f64 = 0.25;

/// A contact manifold: a list of contacts, the deepest first.
pub type Manifold = FixedVec<Contact, MAX_CONTACTS>;

/// Returns at most `max` contacts of the face of obj1 along unit `normal` and of obj2 along its opposite. `slop`: metres.
/// `out_cache`: read and updated. Takes at most 24 support calls for each object, plus those for a cache that is out of date.
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
    let cached_frame = cache.frame(normal);
    let frame = cached_frame.unwrap_or_else(|| ContactFrame::new(normal, &Vec3::zeros()));
    let ([one, two], slop) = faces(obj1, obj2, &frame, slop, cached_frame.map(|_| &cache))?;
    let (mut region, closest) = overlap_of_faces(&one, &two);
    for corner in region.iter_mut() {
        corner.z = one.corners.drop_at(corner) + two.corners.drop_at(corner);
    }
    let ids = cache.ids(
        [one.motion, two.motion],
        &region,
        larger(one.slop, two.slop),
    );
    let order = reduced(&region, &ids, max, one.coord_eps + two.coord_eps);
    let mut manifold = Manifold::default();
    let mut stored_ids: FixedVec<(Vec3, u32), MAX_CONTACTS> = FixedVec::default();
    for i in order.iter() {
        let at = *region.cyclic(*i);
        let [at1, at2] = closest.unwrap_or([at; 2]);
        let height1 = one.support_height - one.corners.drop_at(&at1);
        let height2 = two.support_height - two.corners.drop_at(&at2);
        let mut id = *ids.cyclic(*i);
        if id == 0 {
            id = cache.new_id();
        }
        stored_ids.push((at, id));
        manifold.push(Contact {
            point1: to_real(&(frame.point(at1.xy()) + frame.normal * height1)),
            point2: to_real(&(frame.point(at2.xy()) - frame.normal * height2)),
            depth: (height1 + height2) as Real,
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

/// Returns the indices of at most `max` corners of the region, the deepest first. Keeps corners with ids while they
/// span at least nine tenths of the largest area. Depths that differ by at most `tie_eps` count as equal.
fn reduced(
    region: &Polygon<MAX_CONTACTS>,
    ids: &FixedVec<u32, MAX_CONTACTS>,
    max: usize,
    tie_eps: f64,
) -> FixedVec<usize, MAX_CONTACTS> {
    // A smaller sum of drops is deeper.
    let is_deeper = |i: usize, j: usize| region.cyclic(i).z < region.cyclic(j).z - tie_eps;
    let deepest = (1..region.len()).fold(0, |k, i| if is_deeper(i, k) { i } else { k });
    let best = region.reduced(deepest, max);
    if region.len() > max && *ids.cyclic(deepest) != 0 {
        let kept = (deepest..deepest + region.len()).filter(|i| *ids.cyclic(*i) != 0);
        let kept: FixedVec<usize, MAX_CONTACTS> = kept.collect();
        let size = |indices: &[usize]| {
            let corners: Polygon<MAX_CONTACTS> =
                indices.iter().map(|i| *region.cyclic(*i)).collect();
            match &*corners {
                [a, b] => offset(a, b).norm(),
                _ => corners.double_area(),
            }
        };
        if kept.len() == best.len() && size(&kept) >= 0.9 * size(&best) {
            return kept;
        }
    }
    best
}

/// Returns the overlap of two faces in projection. If they do not overlap: the midpoint of their closest points, and,
/// if these are farther apart than the slop, the two points.
fn overlap_of_faces(
    one: &ContactFace,
    two: &ContactFace,
) -> (Polygon<MAX_CONTACTS>, Option<[Vec3; 2]>) {
    let coord_eps = larger(one.coord_eps, two.coord_eps);
    let is_swapped = one.corners.double_area() > two.corners.double_area();
    let [small, large] = if is_swapped { [two, one] } else { [one, two] };
    let mut region = Polygon::default();
    if large.corners.len() > 2 {
        region = small.corners.iter().copied().collect();
        region = region.clipped_by(&large.corners, coord_eps);
    }
    if !region.is_empty() {
        return (region.simplified(coord_eps, coord_eps), None);
    }
    let Some((sides, [a, b])) = small.corners.closest_sides(&large.corners) else {
        return (region, None);
    };
    if large.corners.len() == 2 || one.rounded_halfwidth + two.rounded_halfwidth > 0.0 {
        let halfwidths = [small.contact_halfwidth(), large.contact_halfwidth()];
        region = overlap_of_segments(&sides, halfwidths, coord_eps);
    }
    if !region.is_empty() {
        return (region, None);
    }
    region.push(a.lerp(&b, 0.5));
    let is_far = offset(&a, &b).norm() > lesser(one.slop, two.slop);
    let points = if is_swapped { [b, a] } else { [a, b] };
    (region, is_far.then_some(points))
}

/// Returns the crossing point of the segments pq and rs or, if they are nearly parallel, the ends of their common
/// part; no point if there is none. `halfwidths`: the distance of a contact from each segment, at most.
///
/// Nearly parallel segments:
/// 1. Extend pq at both ends by the slack, the sum of the half-widths. Clip it to the strip of the slack on both
///    sides of the line rs.
/// 2. Move each end towards the line rs by the first half-width's fraction of the slack: the more rounded segment
///    gets the greater distance.
/// 3. Clip the result at the ends of both segments, because step 2 may have moved it beyond an end of pq.
fn overlap_of_segments(
    [[p, q], [r, s]]: &[[Vec3; 2]; 2],
    halfwidths: [f64; 2],
    coord_eps: f64,
) -> Polygon<MAX_CONTACTS> {
    let (u, v, slack) = (offset(p, q), offset(r, s), halfwidths[0] + halfwidths[1]);
    let (size, sine) = (u.norm() * v.norm(), u.perp(&v));
    if sine.abs() > PARALLEL_SINE * size {
        let [t, k] = [v, u].map(|along| offset(p, r).perp(&along) / sine);
        let is_on_both = [t, k].iter().all(|t| (0.0..=1.0).contains(t));
        return is_on_both.then(|| p.lerp(q, t)).into_iter().collect();
    }
    if !(size > 0.0) {
        return Polygon::default();
    }
    let extension = slack / u.norm();
    let left = Vec2::new(-v.y, v.x);
    let ends = Polygon::from_iter([-extension, 1.0 + extension].map(|t| p.lerp(q, t)));
    let mut ends = ends.clipped(r, &left, slack).clipped(r, &-left, slack);
    for end in ends.iter_mut() {
        let t = v.dot(&offset(r, end)) / v.norm_squared();
        *end = end.lerp(&r.lerp(s, t), halfwidths[0] / slack);
    }
    for (from, inwards) in [(p, u), (q, -u), (r, v), (s, -v)] {
        ends = ends.clipped(from, &inwards, coord_eps);
    }
    ends.simplified(coord_eps, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{EPSILON, from_real};
    use crate::test_shapes::{Random, ball, capsule, corners, hull, placed};

    const SLOP: f64 = if EPSILON < 1e-10 { 1e-6 } else { 1e-4 };

    /// Returns the manifold of a square plate with its top face at z = 0 and a box on it, rotated about z by `angle`
    /// in opposite directions.
    fn stacked(angle: f64, max: usize) -> Manifold {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let turn = crate::test_shapes::Rotation::from_axis_angle(&Vec3::z_axis(), angle);
        let plate = placed(&plate, &turn, Vec3::z() * -0.5);
        let cube = corners(Vec3::new(1.0, 1.0, 0.5));
        let cube = placed(&cube, &turn.inverse(), Vec3::z() * 0.49);
        contacts(&hull(&plate), &hull(&cube), &Vec3::z(), SLOP, None, max).unwrap()
    }

    #[test]
    fn octagon_is_reduced_to_the_largest_area() {
        let angle = core::f64::consts::FRAC_PI_8 as f64;
        let whole = stacked(angle, MAX_CONTACTS);
        assert_eq!(whole.len(), 8);
        for c in whole.iter() {
            assert!((f64::from(c.depth) - 0.01).abs() < 64.0 * EPSILON);
            assert!(from_real(c.point1).z.abs() < 64.0 * EPSILON);
            let error = from_real(c.point1) - from_real(c.point2) - Vec3::z() * f64::from(c.depth);
            assert!(error.norm() < 64.0 * EPSILON);
        }
        // In order around the normal.
        let area = |m: &Manifold| {
            let first = from_real(m[0].point1);
            let spokes = m.iter().map(|c| from_real(c.point1) - first);
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
        let long = (from_real(two[0].point1) - from_real(two[1].point1)).norm();
        let angle = 2.0 * angle.cos();
        assert!(
            (long - 2.0 * (1.0 / (0.5 * angle))).abs() < 8.0 * SLOP,
            "{long}"
        );
        assert_eq!(stacked(0.3, 1).len(), 1);
    }

    #[test]
    fn deepest_contact_is_first() {
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
            let deepest = f64::from(found[0].depth);
            assert!(
                found
                    .iter()
                    .all(|c| f64::from(c.depth) <= deepest + 64.0 * EPSILON)
            );
        }
    }

    #[test]
    fn rounded_objects_have_contacts_at_their_cores() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let at = Vec3::new(r.within(-0.3, 0.3), r.within(-0.3, 0.3), 0.89);
            let found = contacts(&hull(&plate), &ball(at, 0.4), &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.len(), 1);
            let across = from_real(found[0].point1) - at;
            assert!(across.xy().norm() < SLOP, "{across}");
            let half = Vec3::new(0.3, r.within(-0.3, 0.3), 0.0);
            let rod = capsule(at - half, at + half, 0.4);
            let found = contacts(&hull(&plate), &rod, &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.len(), 2);
            for c in found.iter() {
                let across = (from_real(c.point1) - at).xy();
                let end = (across - half.xy()).norm().min((across + half.xy()).norm());
                assert!(end < 2.0 * SLOP, "{end:e}");
            }
        }
    }

    /// Tests two rods side by side.
    #[test]
    fn contacts_lie_on_both_objects_without_slop() {
        let mut r = Random::new(6);
        for round in 0..2000 {
            let [a, b] = [0, 1].map(|_| Vec3::z() * r.within(0.1, 1.0));
            let [p, q] = [0, 1].map(|_| r.within(0.1, 0.5));
            // So shallow that the least slop for the depth is nearly 0.
            let at = Vec3::new((p + q) * (1.0 - 1e-7), 0.0, r.within(-0.2, 0.2));
            let (one, two) = (capsule(-a, a, p), capsule(at - b, at + b, q));
            let found = contacts(&one, &two, &Vec3::x(), 0.0, None, 4).unwrap();
            for c in found.iter() {
                let near = EPSILON.sqrt();
                assert!(
                    from_real(c.point1).z.abs() < a.z + near,
                    "{round}: {}",
                    from_real(c.point1)
                );
                assert!(
                    (from_real(c.point2) - at).z.abs() < b.z + near,
                    "{round}: {}",
                    from_real(c.point2)
                );
            }
        }
    }
}
