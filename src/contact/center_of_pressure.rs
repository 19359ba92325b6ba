// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The center of pressure: the centroid of the overlap volume, projected along the contact normal.
//!
//! *Definition.* Let n be the contact normal, r a point of the plane perpendicular to n, and δ(r) the local
//! depth: the length of the segment that the line through r along n has in common with both objects. The center
//! of pressure is
//!
//! ```text
//! c = ∫ δ(r) r dA / ∫ δ(r) dA.
//! ```
//!
//! It is continuous in the pose, unlike a deepest point, which jumps from corner to corner. A force at c along n
//! has the sum and the moment of a pressure proportional to δ. No stiffness of the objects is modelled.
//!
//! *Local depth.* The depth d is the distance of the two support planes. Let drop(r) be the distance of an
//! object's surface below its support plane, a convex function; then δ = d − drop1 − drop2. Both drops are 0 at
//! the deepest point r*, and δ is concave along each ray from there.
//!
//! *Steps.*
//! 1. Find the outline of the object of smaller extent ([`crate::contact::outline_search`]). If it is a point, c = r*.
//! 2. If vertices of the other object in its support plane contain that outline, the other object is a plane.
//! 3. Else find the outline of the other object, as far as it cuts the first one.
//! 4. Integrate over one outline on a plane, or over both, in closed form.
//!
//! *Integrals.* In the triangle of r* and a side of an outline the drop is linear, and so is w, which is 0 at r* and 1 on
//! that side. Between two consecutive rays from r* through vertices of either outline, w1, w2 and drop1 + drop2
//! (in units of d) are linear, and the overlap is where all three are at most 1. So its outline between the rays
//! consists of one to three sides. Outside each side the surface is not known; it is assumed to be a plane of
//! slope s, the *flank*. With δ in units of d, a triangle from r* to a side v_i v_j of that outline, of twice the
//! area a and the length L of the side, together with its flank (k = L d / 2 s), has
//!
//! ```text
//! ∫ δ dA = a (1 + δ_i + δ_j) / 6 + k (δ_i² + δ_i δ_j + δ_j²) / 3
//! ∫ δ r dA = v_i (a (1 + 2 δ_i + δ_j) + k' (3 δ_i² + 2 δ_i δ_j + δ_j²)) / 24 + the same for j,  k' = 2 k.
//! ```
//!
//! For edges and corners the triangles vanish and only the flanks remain; then s cancels out. So faces, edges and
//! corners are one case, without a change of formula between them.
//!
//! *Accuracy.* The root mean square error of the linear model is 1 to 2 % of the smaller object's extent if the
//! depth is 1 % of it, 2 to 3 % at 3 %, 6 % at 10 %, and 12 to 18 % at 30 %. For comparison, the middle of the
//! witness points: 4 to 9, 8 to 17, 15 to 28 and 26 to 41 % (`c-tests/tests/extension/pos.c`).

use crate::contact::flat_face::FlatFace;
use crate::contact::frame::ContactFrame;
use crate::contact::inclined_support::InclinedSupport;
use crate::contact::outline::{Footprint, Outline, area2};
use crate::contact::tuning::{DEEP_RANGE, FLANK_SLOPE};
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, larger, lesser};
use crate::minkowski::support::{Difference, Fault, SupportPoint};
use crate::minkowski::vertex_set::VertexSet;
use crate::types::Solution;

/// Returns the contact position of a hit: the center of pressure of a shallow one, the deep position of a deep one, and a
/// mean of both between. `set`: the known vertices of the search. `tolerance`: metres.
///
/// # Errors
/// [`Fault::NonFinite`].
#[inline(never)]
pub fn contact_position<D: Difference, const N: usize>(
    md: &D,
    set: &VertexSet<N>,
    hit: &Solution,
    centers: Option<&SupportPoint>,
    tolerance: f64,
) -> Result<Vec3, Fault> {
    let (deep, share) = centers.map_or((Vec3::zeros(), 0.0), |c| deep_position(hit, c));
    if share == 1.0 {
        return Ok(deep);
    }
    let center = center_of_pressure(md, set, hit, centers, tolerance)?;
    Ok(center + (deep - center) * share)
}

/// Returns a position for deep hits, at no support point, and its share in the contact position.
///
/// The segment from the difference of the centers to the foot, depth · n, crosses the plane through the origin across n
/// at the parameter t = depth / (depth − n · center): the depth relative to the sum of both objects' extents from their
/// centers along n. The points at t of the segments from each center to its witness point lie in the objects; the
/// position is midway between them. It counts where these points are closer than the depth, so that it is at most half the
/// depth from both objects.
#[inline(always)]
fn deep_position(hit: &Solution, centers: &SupportPoint) -> (Vec3, f64) {
    let t = hit.depth / (hit.depth - hit.normal.dot(&centers.v));
    let [from, to] = DEEP_RANGE;
    // Negated for NaN.
    if !(t > from && t <= 1.0) {
        return (Vec3::zeros(), 0.0);
    }
    let one = hit.point1 + (centers.v1 - hit.point1) * t;
    let two = hit.point2 + (centers.v2 - hit.point2) * t;
    let apart = (one - two).norm() / hit.depth;
    let share = lesser(lesser((t - from) / (to - from), 1.0), 2.0 - 2.0 * apart);
    ((one + two) * 0.5, larger(share, 0.0))
}

/// Returns the center of pressure of a hit, midway between the support planes.
#[inline(always)]
fn center_of_pressure<D: Difference, const N: usize>(
    md: &D,
    set: &VertexSet<N>,
    hit: &Solution,
    centers: Option<&SupportPoint>,
    tolerance: f64,
) -> Result<Vec3, Fault> {
    let depth = larger(hit.depth, tolerance);
    let frame = ContactFrame::new(&hit.normal, &hit.middle());
    let extents = extents(set, &frame.origin, centers);
    let smaller = usize::from(extents[1] < extents[0]);
    let support = InclinedSupport::new(md, frame, extents[smaller], [hit.depth, depth]);
    let mut sum = PressureSum::new(depth, support.vertex_offset);
    let has_area = integrate(&support, smaller, set, &mut sum)?;
    let center = sum.center();
    // Negated for NaN: an empty overlap.
    if !(has_area && center.norm_squared() < f64::MAX) {
        return Ok(hit.middle());
    }
    Ok(frame.point(center))
}

/// Returns the extents of both objects: the distance of their centers from the contact; without centers that of
/// their farthest known vertices. Metres.
#[inline(always)]
fn extents<const N: usize>(
    set: &VertexSet<N>,
    contact: &Vec3,
    centers: Option<&SupportPoint>,
) -> [f64; 2] {
    if let Some(c) = centers {
        return [c.v1, c.v2].map(|center| (center - contact).norm());
    }
    let points = (0..set.len()).map(|i| set.point(VertexSet::<N>::pair_of_entry(i)));
    points.fold([0.0; 2], |[far1, far2], p| {
        let [d1, d2] = [p.v1, p.v2].map(|v| (v - contact).norm());
        [larger(d1, far1), larger(d2, far2)]
    })
}

/// Integrates the local depth of a contact. Returns false if the deepest point is the center of pressure.
#[inline(always)]
fn integrate<D: Difference, const N: usize>(
    support: &InclinedSupport<D>,
    smaller: usize,
    set: &VertexSet<N>,
    sum: &mut PressureSum,
) -> Result<bool, Fault> {
    let mut outline = Outline::EMPTY;
    if support.find_outline(smaller, None, &mut outline)? == Footprint::Point {
        return Ok(false);
    }
    let other = 1 - smaller % 2;
    let mut face = FlatFace::new(&outline, 2.0 * support.vertex_offset);
    support.for_each_flat(set, other, |v| _ = face.add(v));
    let mut other_outline = Outline::EMPTY;
    let footprint = match face.contains_outline() {
        true => Footprint::Plane,
        false => support.find_outline(other, Some(&mut face), &mut other_outline)?,
    };
    match footprint {
        Footprint::Plane => sum.add_on_plane(&outline),
        Footprint::Area => sum.add_both(&outline, &other_outline),
        Footprint::Point => return Ok(false),
    }
    Ok(true)
}

/// Returns the point of the outline on the ray through `at`; z: the local depth there, in depths. `bound`: the
/// largest bound at `at`. `drop`: the sum of the drops there.
#[inline(always)]
fn outline_at(at: Vec2, bound: f64, drop: f64) -> Vec3 {
    let scale = 1.0 / bound;
    Vec3::new(at.x * scale, at.y * scale, larger(1.0 - drop * scale, 0.0))
}

/// A ray from the deepest point through a vertex of an outline.
#[derive(Clone, Copy)]
struct OutlineRay {
    at: Vec2,
    /// The quantities that are at most 1 in the overlap, at the vertex: w of both outlines, and the sum of the drops.
    bounds: [f64; 3],
    /// The index of the largest bound.
    active_bound: usize,
    /// The point of the ray at which the largest bound is 1.
    end: Vec3,
}

impl OutlineRay {
    /// Returns the ray through a vertex above a plane.
    #[inline(always)]
    fn on_plane(v: &Vec3) -> Self {
        let active_bound = if v.z > 1.0 { 2 } else { 0 };
        Self {
            at: v.xy(),
            bounds: [1.0, 0.0, v.z],
            active_bound,
            end: outline_at(v.xy(), larger(v.z, 1.0), v.z),
        }
    }

    /// Returns the ray through vertex `v` of outline `own`, which passes between the vertices `p` and `q` of the
    /// other one. `pv`, `vq` and `pq`: the cross products of these vertices.
    #[inline(always)]
    fn new(v: &Vec3, own: usize, [p, q]: [&Vec3; 2], [pv, vq, pq]: [f64; 3]) -> Self {
        let scale = 1.0 / pq;
        let (weight_p, weight_q) = (larger(vq, 0.0) * scale, larger(pv, 0.0) * scale);
        let drop = v.z + weight_p * p.z + weight_q * q.z;
        let weight = weight_p + weight_q;
        // No array that is indexed by `own`: it would be stored, and its parts loaded together. Codegen, see README.
        let (one, two) = if own == 0 {
            (1.0, weight)
        } else {
            (weight, 1.0)
        };
        let largest = larger(two, one);
        let k = usize::from(two > one);
        Self {
            at: v.xy(),
            bounds: [one, two, drop],
            active_bound: if drop > largest { 2 } else { k },
            end: outline_at(v.xy(), larger(drop, largest), drop),
        }
    }

    /// Returns the outline point between this ray and `next` at which the bounds `i` and `j`, active on the one and on
    /// the other, are equal; the excess of the third bound there; and the part of the way to `next`, at least `from`.
    #[inline(always)]
    fn outline_crossing(&self, next: &Self, i: usize, j: usize, from: f64) -> (Vec3, f64, f64) {
        let k = 3_usize.wrapping_sub(i + j).min(2);
        let [i, j] = [i, j].map(|i| i.min(2));
        let (a, b) = (&self.bounds, &next.bounds);
        let t = (a[i] - a[j]) / ((a[i] - a[j]) - (b[i] - b[j]));
        // Between the rays whatever the rounding: the center is then a mean of points of both outlines. Bounds that are equal
        // all the way, within rounding, cross anywhere.
        let t = lesser(larger(t, from), 1.0);
        let bounds = [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t);
        let at = self.at + (next.at - self.at) * t;
        (
            outline_at(at, bounds[i], bounds[2]),
            bounds[k] - bounds[i],
            t,
        )
    }
}

/// The sums of the integrals of the local depth δ, in units of d, times 24.
struct PressureSum {
    /// The integral of δ.
    volume: f64,
    /// The integral of δ r.
    moment: Vec2,
    /// Width of a flank at the local depth d: d / s, metres.
    flank_width: f64,
    /// Least value of twice the area of a triangle, m²: areas are divisors.
    min_area: f64,
}

impl PressureSum {
    /// Makes empty sums.
    fn new(depth: f64, vertex_offset: f64) -> Self {
        Self {
            volume: 0.0,
            moment: Vec2::zeros(),
            flank_width: depth / FLANK_SLOPE,
            min_area: f64::EPSILON * vertex_offset * vertex_offset,
        }
    }

    /// Adds the triangle from the deepest point to a side of the outline, and its flank. The formulas are those of the
    /// head; `k` is its k'.
    #[inline(always)]
    fn add(&mut self, v: &Vec3, w: &Vec3) {
        let area = area2(v, w);
        // A negative area would be a negative weight. Negated for NaN.
        if !(area >= 0.0) {
            return;
        }
        let length = offset(v, w).norm();
        let (a, b) = (v.z, w.z);
        let k = self.flank_width * length;
        let common = area + (area + k * (a + b)) * (a + b);
        let weight_v = common + (area + 2.0 * k * a) * a;
        let weight_w = common + (area + 2.0 * k * b) * b;
        self.volume += 4.0 * (common - k * a * b);
        self.moment += v.xy() * weight_v + w.xy() * weight_w;
    }

    /// Adds an outline on a larger plane.
    #[inline(always)]
    fn add_on_plane(&mut self, outline: &Outline) {
        let local_depth = |v: &Vec3| Vec3::new(v.x, v.y, 1.0 - v.z);
        for (p, q) in outline.sides() {
            if p.z <= 1.0 && q.z <= 1.0 {
                self.add(&local_depth(p), &local_depth(q));
            } else {
                self.add_cone(&OutlineRay::on_plane(p), &OutlineRay::on_plane(q));
            }
        }
    }

    /// Adds the overlap of two outlines, once around, from vertex to vertex of either. The deepest point must be inside
    /// both.
    #[inline(always)]
    fn add_both(&mut self, one: &Outline, two: &Outline) {
        let outlines = [one, two];
        let vertex = |own: usize, i: usize| outlines[own % 2].vertex(i);
        let min_area = self.min_area;
        let area =
            |own: usize, i: usize| larger(area2(vertex(own, i), vertex(own, i + 1)), min_area);
        // The triangles of both that contain the last ray.
        let p = vertex(0, 0);
        let contains_ray =
            |i: &usize| area2(vertex(1, *i), p) >= 0.0 && area2(p, vertex(1, *i + 1)) > 0.0;
        let last = two.len() - 1;
        let mut at = [0, (0..last).find(contains_ray).unwrap_or(last)];
        let [q, r] = [vertex(1, at[1]), vertex(1, at[1] + 1)];
        let crosses = [area2(q, p), area2(p, r), area(1, at[1])];
        // The last ray and the next one, in turns: not copied. Codegen, see README.
        let mut rays = [OutlineRay::new(p, 0, [q, r], crosses); 2];
        for i in 0..one.len() + two.len() {
            let nexts = [vertex(0, at[0] + 1), vertex(1, at[1] + 1)];
            let turn = area2(nexts[0], nexts[1]);
            // The outline with the next vertex, counterclockwise.
            let own = usize::from(!(turn > 0.0));
            let other = 1 - own;
            let v = nexts[own];
            let p = vertex(other, at[other]);
            let crosses = [area2(p, v), turn.abs(), area(other, at[other])];
            rays[(i + 1) % 2] = OutlineRay::new(v, own, [p, nexts[other]], crosses);
            self.add_cone(&rays[i % 2], &rays[(i + 1) % 2]);
            let next = at[own] + 1;
            at[own] = if next < outlines[own].len() { next } else { 0 };
        }
    }

    /// Adds the overlap between two consecutive rays.
    #[inline(always)]
    fn add_cone(&mut self, last: &OutlineRay, next: &OutlineRay) {
        let (i, j) = (last.active_bound, next.active_bound);
        let mut start = last.end;
        if i != j {
            let k = 3_usize.wrapping_sub(i + j).min(2);
            let (mut middle, excess, _) = last.outline_crossing(next, i, j, 0.0);
            if excess > 0.0 {
                let (first, _, from) = last.outline_crossing(next, i, k, 0.0);
                self.add(&start, &first);
                start = first;
                (middle, _, _) = last.outline_crossing(next, k, j, from);
            }
            self.add(&start, &middle);
            start = middle;
        }
        self.add(&start, &next.end);
    }

    /// Returns the center of pressure, relative to the deepest point; NaN if the overlap is empty.
    fn center(&self) -> Vec2 {
        self.moment / self.volume
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Random, ball, corners, difference, hull, placed};
    use nalgebra::{Rotation3, Vector3};

    /// Makes an outline of vertices (x, y, drop).
    fn outline(corners: &[(f64, f64, f64)]) -> Outline {
        let mut outline = Outline::EMPTY;
        for &(x, y, drop) in corners {
            outline.push(Vec3::new(x, y, drop), 0.0);
        }
        assert_eq!(outline.close(0.0, 0.0, 0.0), Footprint::Area);
        outline
    }

    /// Returns w and the drop of an outline at a point.
    fn bounds(outline: &Outline, r: &Vec3) -> [f64; 2] {
        let mut found = (0..outline.len()).filter_map(|i| {
            let (p, q) = (outline.vertex(i), outline.vertex(i + 1));
            let (one, two) = (area2(r, q) / area2(p, q), area2(p, r) / area2(p, q));
            (one >= 0.0 && two >= 0.0).then_some([one + two, one * p.z + two * q.z])
        });
        found.next().unwrap_or([9.0; 2])
    }

    /// Returns the center of pressure of two outlines, by sums over a grid.
    fn center_by_grid(outlines: &[Outline; 2]) -> [f64; 2] {
        const N: i32 = 400;
        let mut sum = [0.0; 3];
        for (x, y) in (-N..N).flat_map(|x| (-N..N).map(move |y| (x, y))) {
            let [x, y] = [x, y].map(|x| (x as f64 + 0.5) * 1.5 / N as f64);
            let r = Vec3::new(x, y, 0.0);
            let [[w1, drop1], [w2, drop2]] = [0, 1].map(|i| bounds(&outlines[i], &r));
            let depth = 1.0 - drop1 - drop2;
            if w1 <= 1.0 && w2 <= 1.0 && depth > 0.0 {
                sum = [sum[0] + depth, sum[1] + depth * x, sum[2] + depth * y];
            }
        }
        [sum[1] / sum[0], sum[2] / sum[0]]
    }

    #[test]
    fn center_of_two_outlines_is_that_of_a_grid() {
        let mut r = Random::new(1);
        for round in 0..40 {
            let outlines = [0, 1].map(|_| {
                let n = 3 + round % 4;
                let corners: Vec<_> = (0..n)
                    .map(|k| {
                        let turn = (k as f64 + r.within(0.0, 0.4)) / n as f64;
                        let (y, x) = (turn * core::f64::consts::TAU).sin_cos();
                        let far = r.within(0.5, 1.0);
                        (far * x, far * y, r.within(0.0, 1.2))
                    })
                    .collect();
                outline(&corners)
            });
            let mut sum = PressureSum::new(1e-9, 1e-9);
            sum.add_both(&outlines[0], &outlines[1]);
            let ([x, y], [u, v]) = (sum.center().into(), center_by_grid(&outlines));
            assert!((x - u).hypot(y - v) < 3e-3, "{round}: {x} {y} {u} {v}");
        }
    }

    /// Tests an edge that lies across a slender face, whose bounds on the drop and on w are equal, within rounding, all the way
    /// between two rays: the center is on the edge.
    #[test]
    fn bounds_that_are_equal_all_the_way_cross_in_the_overlap() {
        let edge = outline(&[
            (0.051156761441547835, 0.06929711286863215, 0.0),
            (-0.10185937621243471, -0.13797900507875485, 0.0),
            (-0.11309091209911801, -0.1576502898022648, 1.0),
        ]);
        let face = outline(&[
            (
                -0.05560451311603841,
                0.1477806601813245,
                8.417640656259147e-7,
            ),
            (-0.0907078790524085, 0.17434792664456794, 0.5184544119205408),
            (-0.09785047221744633, 0.17822548222618612, 1.0),
            (0.13024501704762834, -0.3855998777456977, 1.0),
            (0.18854988924517846, -0.5011104574177705, 0.0),
            (0.1980463456798991, -0.5059758252809023, 1.0),
        ]);
        let mut sum = PressureSum::new(1e-3, 1.8e-6);
        sum.add_both(&edge, &face);
        let center = sum.center();
        let along = Vec2::new(0.153016, 0.207276).normalize();
        assert!(along.perp(&center).abs() < 1e-3, "{center:?}");
    }

    /// Returns the center of pressure of a body on a floor, at this depth, with the vertices that `dirs` return as
    /// known ones; and the number of support points.
    fn position(points: &[Vec3], depth: f64, dirs: &[Vec3]) -> (Vec3, u64) {
        let lowest = points.iter().fold(f64::INFINITY, |z, p| z.min(p.z));
        let body = placed(
            points,
            &Rotation3::identity(),
            Vec3::z() * (-depth - lowest),
        );
        let floor = placed(
            &corners(Vec3::new(2.0, 2.0, 1.0)),
            &Rotation3::identity(),
            -Vec3::z(),
        );
        let md = difference(hull(&floor), hull(&body));
        let mut set = VertexSet::<16>::EMPTY;
        for dir in dirs {
            set.push(dir, &md.support(dir).unwrap());
        }
        let found = md.support(&Vec3::z()).unwrap();
        let point1 = Vec3::new(found.v2.x, found.v2.y, 0.0);
        let hit = Solution {
            depth,
            dir: Vec3::z(),
            normal: Vec3::z(),
            point1,
            point2: found.v2,
            ..Solution::default()
        };
        let v2 = Vec3::z() * (-depth - lowest);
        let centers = SupportPoint {
            v: -Vec3::z() - v2,
            v1: -Vec3::z(),
            v2,
        };
        let before = md.supports();
        let pos = contact_position(&md, &set, &hit, Some(&centers), 1e-9).unwrap();
        (pos, md.supports() - before)
    }

    /// Returns the corners of a box rotated by this angle about y.
    fn leaning(half: Vec3, degrees: f64) -> Vec<Vec3> {
        let axis = Vector3::y_axis();
        let rotation = Rotation3::from_axis_angle(&axis, degrees.to_radians());
        placed(&corners(half), &rotation, Vec3::zeros())
    }

    /// Tests a box that leans by less than its depth over its width: the position is the centroid of the wedge, the
    /// same whatever is known; four corners and four sides are evaluated, of the floor nothing if its corners are known.
    #[test]
    fn known_vertices_save_queries_and_move_nothing() {
        let half = Vec3::new(0.125, 0.125, 0.1);
        let body = leaning(half, 0.1);
        // δ falls linearly from d by `fall` over the width: (d/2 − fall/3) / (d − fall/2) of it.
        let (depth, fall) = (1e-3, 0.25 * 0.1_f64.to_radians().sin());
        let share = (depth / 2.0 - fall / 3.0) / (depth - fall / 2.0);
        let (unaided, calls) = position(&body, depth, &[]);
        let found = (unaided.x.abs() - 0.25 * (0.5 - share)).abs();
        assert!(found < 1e-3, "{unaided:?} {share}");
        let slopes = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let dirs = |slope| slopes.map(|(x, y)| Vec3::new(slope * x, slope * y, 1.0).normalize());
        let all = [dirs(0.2), dirs(0.1)].concat();
        let (aided, aided_calls) = position(&body, depth, &all);
        assert!((aided - unaided).norm() < 1e-9, "{aided:?} {unaided:?}");
        assert_eq!((calls, aided_calls), (6, 4));
    }

    /// Tests a box, and a plate at depths of many thicknesses.
    #[test]
    fn position_is_continuous_in_the_depth() {
        for half in [Vec3::repeat(0.125), Vec3::new(0.125, 0.1, 0.005)] {
            let body = leaning(half, 1.0);
            let at = |depth| position(&body, depth, &[]).0;
            let (mut depth, mut last) = (1e-4, at(1e-4));
            while depth < 0.2 {
                let step = 0.002 * depth;
                depth += step;
                let next = at(depth);
                let (x, y) = (next.x - last.x, next.y - last.y);
                assert!(x.hypot(y) < 8e-4, "{half:?} {depth}: {last:?} {next:?}");
                last = next;
            }
        }
        // A plate at a depth of a tenth of its thickness has its center of pressure near its center.
        let plate = leaning(Vec3::new(0.125, 0.125, 0.005), 0.02);
        let (pos, _) = position(&plate, 1e-3, &[]);
        assert!(pos.x.abs() < 3e-3, "{pos:?}");
    }

    /// Tests two boxes whose centers differ along the normal: the position is at no support point from a certain depth on,
    /// and changes continuously up to there.
    #[test]
    fn deep_position_is_free() {
        let cube = corners(Vec3::repeat(0.5));
        let at = |depth: f64| {
            let offset = Vec3::new(0.1, 0.05, 1.0 - depth);
            let body = placed(&cube, &Rotation3::identity(), offset);
            let md = difference(hull(&cube), hull(&body));
            let mut set = VertexSet::<16>::EMPTY;
            set.push(&Vec3::z(), &md.support(&Vec3::z()).unwrap());
            let point = Vec3::new(0.05, 0.025, 0.5);
            let hit = Solution {
                depth,
                normal: Vec3::z(),
                point1: point,
                point2: point - Vec3::z() * depth,
                ..Solution::default()
            };
            let centers = SupportPoint {
                v: -offset,
                v1: Vec3::zeros(),
                v2: offset,
            };
            let before = md.supports();
            let pos = contact_position(&md, &set, &hit, Some(&centers), 1e-9).unwrap();
            (pos, md.supports() - before)
        };
        let mut last = at(0.1).0;
        for k in 0..1000 {
            let depth = 0.1 + 0.5 * k as f64 / 1000.0;
            let (pos, calls) = at(depth);
            assert!((pos - last).norm() < 2e-3, "{depth}: {last} {pos}");
            assert_eq!(calls == 0, depth >= 0.4, "{depth}");
            last = pos;
        }
    }

    /// Tests a cylinder on its rim whose center is nearly above it, with a deepest point beside its plane of symmetry.
    #[test]
    fn position_on_a_rim_is_on_its_axis_plane() {
        let (radius, half_height, depth) = (0.1_f64, 0.95, 1e-3);
        let lean: f64 = radius.atan2(half_height) - 0.003;
        let axis = Vec3::new(lean.sin(), 0.0, lean.cos());
        let rim = move |n: &Vec3| {
            let across = n - axis * n.dot(&axis);
            across * (radius / across.norm()) + axis * half_height.copysign(n.dot(&axis))
        };
        let lowest = rim(&-Vec3::z());
        let center = Vec3::new(-lowest.x, 0.0, -depth - lowest.z);
        let floor = corners(Vec3::new(2.0, 2.0, 1.0));
        let floor = placed(&floor, &Rotation3::identity(), -Vec3::z());
        let md = difference(hull(&floor), move |n: &Vec3| rim(n) + center);
        let mut set = VertexSet::<16>::EMPTY;
        for (x, y) in [(0.0, 0.0), (0.5, -0.2), (0.01, 0.02), (0.1, 0.3)] {
            let dir = Vec3::new(x, y, 1.0).normalize();
            set.push(&dir, &md.support(&dir).unwrap());
        }
        let hit = Solution {
            depth,
            normal: Vec3::z(),
            point1: Vec3::new(0.0, 0.003, 0.0),
            point2: Vec3::new(0.0, 0.003, -depth),
            ..Solution::default()
        };
        let centers = SupportPoint {
            v: -Vec3::z() - center,
            v1: -Vec3::z(),
            v2: center,
        };
        let pos = contact_position(&md, &set, &hit, Some(&centers), 1e-9).unwrap();
        assert!(pos.y.abs() < 1e-3 && pos.x.abs() < 5e-3, "{pos}");
    }

    #[test]
    fn non_finite_point_is_a_fault() {
        let calls = core::cell::Cell::new(0);
        let broken = |n: &Vec3| {
            calls.set(calls.get() + 1);
            n * if calls.get() > 1 { f64::NAN } else { 1.0 }
        };
        let md = difference(broken, ball(Vec3::z() * 1.9, 1.0));
        let mut set = VertexSet::<4>::EMPTY;
        set.push(&Vec3::z(), &md.support(&Vec3::z()).unwrap());
        let hit = Solution {
            depth: 0.1,
            normal: Vec3::z(),
            point1: Vec3::z(),
            point2: Vec3::z() * 0.9,
            ..Solution::default()
        };
        let pos = contact_position(&md, &set, &hit, None, 1e-9);
        assert_eq!(pos, Err(Fault::NonFinite));
    }
}
