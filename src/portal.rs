// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Portal discovery and refinement on known vertices (G. Snethen, "XenoCollide", Game Programming
//! Gems 7, 2008; W. Gao, 2023, Algorithm 1, see [`crate::paper::gao`]).
//!
//! The origin ray runs from an interior point of D through the origin. A *portal* is a triangle of points of D that
//! the ray crosses.
//!
//! 1. *Discovery*: v1 is the known difference farthest along the ray. v2 is the point farthest along the
//!    perpendicular from v1 to the ray. Then the point farthest along the normal of the plane of ray direction and
//!    edge v1 v2, on the side of the ray, replaces v1 or v2, or completes the portal as v3.
//! 2. *Climb* ([`Portal::climb`]): the known difference farthest along the portal's normal replaces one corner, so that
//!    the ray crosses the new portal, until none is above it. Refinement, the ray of `along.rs`, the local search and the
//!    refinement of directions do so.
//! 3. *Refinement*: climbs and support calls in turn. It ends if the bounds meet, or if no point is above the portal.
//!
//! Departures. Both steps take a known difference if one is far enough, and evaluate the callbacks otherwise.
//! XenoCollide evaluates directions perpendicular to the ray. Here the direction of the upper bound is inclined
//! towards that perpendicular, by an angle of the order of upper bound / distance from the ray ([`SLOPE_GROWTH`]),
//! so that the portal of a shallow contact is small and close to the minimum; where the upper bound is large beside the
//! length of the ray, that perpendicular itself ([`FAR_UPPER_REL`]). If v1 is near the ray, the portal is a
//! *ring*: the support points of three directions around one that the caller chooses ([`NearRay`]). A caller whose ray
//! must cross the portal gets perpendicular directions there.
//!
//! Outputs. `Ok(None)` of [`discover`]: D is flat, vertices tie, or the set is full. The caller needs another start, such
//! as a tetrahedron of GJK. [`refine`] leaves a valid portal, whatever ended it. [`Stop::Separated`]: an evaluated
//! direction is a separating axis; this is the separation test.

use crate::math::{self, Vec3, lesser, normalise_unscaled, perpendicular, tangents};
use crate::minkowski::predictor::{Model, Predictor};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery};
use crate::minkowski::tolerance::GapLimit;
use crate::minkowski::tuning::{INSERT_HEIGHT_GAPS, MAX_FAILURES};
use crate::minkowski::vertex_set::{Vertex, VertexSet};
use crate::trace;

/// The iteration limit of portal discovery and refinement, of the local search and of GJK. Each step comes closer to
/// the surface of D, and few loops take forty; later steps only change rounding errors. Insensitive: 24 to 100.
pub const MAX_STEPS: u32 = 100;

/// The tangent of the angle between the axis and the directions of the widest ring: 60°.
pub const WIDEST_RING_TAN: f64 = 1.732_050_807_568_877_2;

/// The upper bound, in sizes of D, below which a contact is *shallow*: its portal is near the minimum, and is refined further
/// once the origin is on its inner side. So is one that is as close to the origin itself: it may lie on the face of the
/// minimum, while the upper bound is that of another direction. Measured: if every portal is refined so, deep overlaps take 4
/// to 13 % more instructions; with 0.15, boxes at medium depth take 11 % more, and spheres 8 % more support points; by
/// the upper bound alone, boxes and icosahedra of every depth take 4 % more.
const SHALLOW_REL: f64 = 0.25;
/// The first slope in discovery, in units of upper bound / distance from the ray, and the factor by which the slope grows
/// after each attempt that finds no point on the other side of the ray. Insensitive: 1.3 to 1.5; 1.15 takes 4 % more
/// support points in intersection tests. Without growth nearly touching spheres take up to 17 support points, not 15.
const SLOPE_GROWTH: f64 = 1.4;
/// The largest slope in discovery is the larger of this many distances of v1 from the ray and [`WIDEST_SLOPE_EDGES`] lengths of
/// the edge v1 v2, divided by the length of the ray in D. Measured: 4 in place of 3 takes 1 % fewer support points for the
/// global minimum, and 13 % more for a local one of hulls, whose portals then extend into other valleys.
const WIDEST_SLOPE_DISTANCES: f64 = 3.0;
/// See [`WIDEST_SLOPE_DISTANCES`]. Measured: without the edge 21 % more support points.
const WIDEST_SLOPE_EDGES: f64 = 0.25 * WIDEST_SLOPE_DISTANCES;
/// The upper bound, in lengths of the ray in D, above which [`discover`] evaluates the perpendicular to the ray at once, where
/// its caller allows that. Off the middle of a wide plate the line of the centers is nearly parallel to the plate, its
/// support value is as large as the plate, and its direction far from the minimum's. Measured (support points of boxes
/// 1 mm deep on plates of 20 m, and of icosahedra at every depth): 0.3 4.7 and 6.9, 0.35 4.7 and 6.9, 0.4 4.8 and
/// 6.9, without 7.5 and 6.8; proofs of the latter 7.6, 7.5, 7.5 and 7.4.
pub const FAR_UPPER_REL: f64 = 0.35;
/// The least progress towards the ray, relative to the size of D: above the rounding of products of points.
const MIN_PROGRESS_REL: f64 = 1e-12;
/// The least squared sine of the angle between two sides of a ring, 6°: a narrower one bounds no volume.
const MIN_RING_SINE2: f64 = 0.01;

/// How exactly the normal and the corners of a portal are chosen.
#[derive(Clone, Copy, PartialEq)]
pub enum Exact {
    /// Nothing: for callers that test afterwards what the portal proves.
    Nothing,
    /// The normals of slivers, and the choice of corners ([`choose_corner`]): for a bound that relies on the crossing.
    /// Measured: elsewhere as many support points, and at least 2 to 6 % more instructions of a search.
    Crossing,
}

/// A triangle of points of D that a ray crosses, unless it is a ring. Its normal points outward: along the ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct Portal {
    /// In the order that gives the normal its direction.
    pub corners: [Vertex; 3],
}

/// The plane N·x = d of a portal. Its heights are distances times the length of N: most need no division.
#[derive(Clone, Copy, Debug)]
pub struct PortalPlane {
    /// N, outward, of any length.
    pub normal: Vec3,
    /// The length of N, twice the area of the portal, m²; 0 if its corners lie on a line.
    pub length: f64,
    /// d, negative if the origin is on the outer side.
    pub offset: f64,
}

impl PortalPlane {
    /// Returns whether its distance from the origin is that of a shallow contact.
    #[inline(always)]
    fn is_shallow<D: Difference>(&self, query: &SupportQuery<'_, D>) -> bool {
        let largest2 = SHALLOW_REL * SHALLOW_REL * query.scale.size2();
        self.offset * self.offset < largest2 * self.length * self.length
    }

    /// Returns the height of `w` above the plane, times the length of N.
    #[inline(always)]
    pub fn height(&self, w: &Vec3) -> f64 {
        self.normal.dot(w) - self.offset
    }

    /// Returns the same plane with a unit normal; `None` if the corners lie on a line.
    #[inline(always)]
    pub fn unit(&self) -> Option<Self> {
        let normal = normalise_unscaled(&self.normal)?;
        let offset = self.offset / self.length;
        Some(Self {
            normal,
            length: 1.0,
            offset,
        })
    }
}

impl Portal {
    /// Returns the points of D that are its corners.
    #[inline(always)]
    pub fn points(&self) -> [Vec3; 3] {
        self.corners.each_ref().map(|v| v.w)
    }

    /// Returns the plane of the corners.
    #[inline(always)]
    pub fn plane(&self, exact: Exact) -> PortalPlane {
        let [a, b, c] = self.points();
        let normal = match exact {
            Exact::Nothing => (b - a).cross(&(c - a)),
            Exact::Crossing => math::normal(&a, &b, &c),
        };
        PortalPlane {
            normal,
            length: normal.norm(),
            offset: normal.dot(&a),
        }
    }

    /// Replaces corners by known differences, so that the ray still crosses the portal, as long as one is higher above it
    /// than `level` returns, a height as [`PortalPlane::height`]. Returns the last plane; `None` if `level` returns `None`,
    /// which ends the climb.
    #[inline(always)]
    pub fn climb<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        ray: &Vec3,
        exact: Exact,
        level: impl Fn(&PortalPlane) -> Option<f64>,
    ) -> Option<PortalPlane> {
        let mut steps = 0;
        loop {
            let plane = self.plane(exact);
            let level = level(&plane)?;
            let w = set.farthest_vertex(&plane.normal);
            if !(plane.height(&w.w) > level) || steps == MAX_STEPS {
                return Some(plane);
            }
            self.replace_corner(ray, w, exact);
            steps += 1;
        }
    }

    /// Replaces one corner by `w`, a point beyond the portal, so that the ray crosses the new portal.
    #[inline(always)]
    pub fn replace_corner(&mut self, ray: &Vec3, w: Vertex, exact: Exact) {
        if exact == Exact::Crossing {
            self.corners[choose_corner(self.points(), ray, &w.w).min(2)] = w;
            return;
        }
        // The side of the plane through the ray and w on which each corner lies.
        let normal = ray.cross(&w.w);
        let [side0, side1, side2] = self.corners.each_ref().map(|v| normal.dot(&v.w) > 0.0);
        // Constant indices keep the corners in registers.
        if side0 && !side1 {
            self.corners[2] = w;
        } else if side1 && !side2 {
            self.corners[0] = w;
        } else {
            self.corners[1] = w;
        }
    }

    /// Returns whether the ray crosses the portal, within `eps`, metres.
    pub fn is_crossed(&self, ray: &Vec3, eps: f64) -> bool {
        let is_inside = |i| {
            let (side, length2) = self.side(ray, i);
            side >= 0.0 || side * side <= eps * eps * length2
        };
        (0..3).all(is_inside)
    }

    /// Returns the least distance of unit `normal`, that of the portal, from an edge, metres; negative outside.
    pub fn foot_depth(&self, normal: &Vec3) -> f64 {
        (0..3).fold(f64::INFINITY, |least, i| {
            let (side, length2) = self.side(normal, i);
            lesser(side / length2.sqrt(), least)
        })
    }

    /// Returns the distance of the ray from the line of edge `i`, positive inside, times the length of the edge; and the
    /// square of that length.
    fn side(&self, ray: &Vec3, i: usize) -> (f64, f64) {
        let [p, q] = [i % 3, (i + 1) % 3].map(|i| self.corners[i].w);
        // The product with the edge, not with q, loses no digits for small portals.
        let edge = q - p;
        (ray.dot(&p.cross(&edge)), edge.norm_squared())
    }
}

/// Returns whether the upper bound is that of a shallow contact.
#[inline(always)]
pub fn is_shallow<D: Difference>(query: &SupportQuery<'_, D>) -> bool {
    let upper = query.upper.depth;
    upper * upper < SHALLOW_REL * SHALLOW_REL * query.scale.size2()
}

/// Directions that the discovery evaluates if v1 is near the ray.
#[derive(Clone, Copy)]
pub enum NearRay<'a> {
    /// A [`ring`] around this unit axis with the tangent `slope`; the ray need not cross the portal.
    Ring { axis: &'a Vec3, slope: f64 },
    /// Perpendicular to the ray: the ray must cross the portal, whose edges may be as short as the
    /// tolerance.
    Perpendicular,
}

/// The one or two corners that a discovery has found.
struct OpenPortal {
    v1: Vertex,
    v2: Option<Vertex>,
    /// Perpendicular to the ray, from v1 or from the edge v1 v2 to it, of any length.
    towards_ray: Vec3,
    /// The dot product of v1 and v2 with `towards_ray`, at most 0, m².
    height: f64,
    /// −1 if the order of the corners is v2, v1, else 1.
    side: f64,
    /// The number of evaluated directions whose point was not beyond the ray.
    failures: u32,
    /// The upper bound, metres, above which the perpendicular to the ray is evaluated at once.
    largest_upper: f64,
}

impl OpenPortal {
    #[inline(always)]
    fn new(v1: Vertex, ray: &Vec3, largest_upper: f64) -> Self {
        let towards_ray = ray * v1.w.dot(ray) - v1.w;
        Self {
            v1,
            v2: None,
            towards_ray,
            height: towards_ray.dot(&v1.w),
            side: 1.0,
            failures: 0,
            largest_upper,
        }
    }

    /// Prepares the search from a corner near the ray: along the perpendicular to the ray alone.
    fn leave_ray(&mut self, ray: &Vec3) {
        // Made perpendicular once more: a large part of the short vector is rounding.
        let way = self.towards_ray - ray * ray.dot(&self.towards_ray);
        self.towards_ray = normalise_unscaled(&way).unwrap_or_else(|| perpendicular(ray));
        self.height = 0.0;
        // A slope would be too small to find another point.
        self.failures = MAX_FAILURES;
    }

    /// Returns whether `w` is closer to the ray than the corners, or beyond it.
    #[inline(always)]
    fn is_closer(&self, w: &Vec3, least_progress: f64) -> bool {
        self.towards_ray.dot(w) > self.height + least_progress
    }

    /// Makes room for another entry: a full set keeps the corners and `next`.
    fn make_room<const N: usize>(&mut self, set: &mut VertexSet<N>, next: &mut Vertex) {
        let mut kept = [self.v1, self.v2.unwrap_or(self.v1), *next];
        set.make_room(&mut kept);
        self.v1 = kept[0];
        self.v2 = self.v2.map(|_| kept[1]);
        *next = kept[2];
    }

    /// Adds a point that is closer to the ray. Returns the portal if that completes it.
    #[inline(always)]
    fn add(&mut self, ray: &Vec3, next: Vertex) -> Option<Portal> {
        let v2 = match &mut self.v2 {
            None => self.v2.insert(next),
            Some(v2) => {
                let (a, b, w) = (&self.v1.w, &v2.w, &next.w);
                if self.side * ray.dot(&b.cross(w)) < 0.0 {
                    self.v1 = next;
                } else if self.side * ray.dot(&w.cross(a)) < 0.0 || !(self.towards_ray.dot(w) > 0.0)
                {
                    *v2 = next;
                } else {
                    let [first, second] = match self.side > 0.0 {
                        true => [self.v1, *v2],
                        false => [*v2, self.v1],
                    };
                    let corners = [first, second, next];
                    return Some(Portal { corners });
                }
                v2
            }
        };
        self.towards_ray = ray.cross(&(v2.w - self.v1.w));
        self.height = self.towards_ray.dot(&self.v1.w);
        self.side = 1.0;
        if self.height > 0.0 {
            (self.towards_ray, self.height, self.side) = (-self.towards_ray, -self.height, -1.0);
        }
        None
    }

    /// Returns the next direction, of any length: that of the upper bound, inclined towards the ray; of a large upper bound, and
    /// after [`MAX_FAILURES`] failures, the perpendicular to the ray. `length`: approximate length of the ray in D, metres.
    #[inline(always)]
    fn next_dir(&self, upper: &SupportPlane, length: f64) -> Vec3 {
        let edge = self.v2.map_or(0.0, |v2| (v2.w - self.v1.w).norm());
        let norm = self.towards_ray.norm();
        // The distance of the corners from the ray.
        let off = -self.height / norm;
        let mut slope = f64::INFINITY;
        if self.failures < MAX_FAILURES && !(upper.depth > self.largest_upper) {
            // One product, after the maximum: codegen. (Measured: with two a hit takes 30 instructions more.)
            let distances = WIDEST_SLOPE_DISTANCES / WIDEST_SLOPE_EDGES * off;
            let widest = WIDEST_SLOPE_EDGES * distances.max(edge) / length;
            slope = lesser(SLOPE_GROWTH * upper.depth / off, widest);
            for _ in 0..self.failures {
                slope *= SLOPE_GROWTH;
            }
        }
        if slope > 0.0 && slope < f64::INFINITY {
            upper.dir + self.towards_ray * (slope / norm)
        } else {
            self.towards_ray
        }
    }
}

/// Finds a portal of the ray along unit `ray` through the origin. `length`: approximate length of the ray in D,
/// metres. `largest_upper`: the upper bound, metres, above which directions are perpendicular to the ray, as XenoCollide's.
/// `near2`: the square of the distance up to which v1 counts as near the ray, m². The corners are in the order in
/// which the portal's normal points along the ray. A full set ends the discovery, `None`, if the ray need not cross the
/// portal: its caller goes on with all entries. Else it is compacted. Measured: rays out of ellipsoids at depths of 1e-13 to
/// 1e-3 of the size fill it once in 400.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn discover<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    ray: &Vec3,
    length: f64,
    largest_upper: f64,
    near2: f64,
    near_ray: NearRay<'_>,
) -> Result<Option<Portal>, Stop> {
    trace::stage("discovery");
    let mut open = OpenPortal::new(set.farthest_vertex(ray), ray, largest_upper);
    if !(-open.height > near2) {
        if let NearRay::Ring { axis, slope } = near_ray {
            if let Some(portal) = ring(query, set, axis, slope)? {
                return Ok(Some(portal));
            }
            (open.towards_ray, open.height) = (perpendicular(ray), 0.0);
        } else {
            open.leave_ray(ray);
        }
    }
    let mut least_progress = MIN_PROGRESS_REL * query.scale.size2();
    for _ in 0..MAX_STEPS {
        if let NearRay::Perpendicular = near_ray {
            least_progress = MIN_PROGRESS_REL * query.scale.size() * open.towards_ray.norm();
        }
        let mut next = set.farthest_vertex(&open.towards_ray);
        if !open.is_closer(&next.w, least_progress) {
            if let NearRay::Perpendicular = near_ray {
                open.make_room(set, &mut next);
            }
            let Some(best) = evaluate_towards_ray(query, set, &mut open, length, next)? else {
                return Ok(None);
            };
            if !open.is_closer(&best.w, least_progress) {
                continue;
            }
            next = best;
        }
        if let Some(portal) = open.add(ray, next) {
            return Ok(Some(portal));
        }
    }
    Ok(None)
}

/// Evaluates the next direction of a discovery. Returns its point, or `known` if that is farther towards the ray; `None`:
/// the set is full, or directions have failed [`MAX_FAILURES`] times before.
#[inline(always)]
fn evaluate_towards_ray<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    open: &mut OpenPortal,
    length: f64,
    known: Vertex,
) -> Result<Option<Vertex>, Stop> {
    if set.is_full() {
        return Ok(None);
    }
    let Some(dir) = normalise_unscaled(&open.next_dir(&query.upper, length)) else {
        return Ok(None);
    };
    let sample = query.evaluate(set, &dir)?;
    let height = open.towards_ray.dot(&sample.w);
    if !(height > 0.0) {
        if open.failures >= MAX_FAILURES {
            return Ok(None);
        }
        open.failures += 1;
    }
    let is_higher = height > open.towards_ray.dot(&known.w);
    Ok(Some(if is_higher { sample.vertex() } else { known }))
}

/// Evaluates three directions around unit `axis`, inclined by the tangent `slope`, at most [`WIDEST_RING_TAN`]. Returns their
/// points as a portal; `None` if the set is full, or if the three points are nearly on a line.
// Cold: codegen, see README.
#[cold]
#[inline(never)]
pub fn ring<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    axis: &Vec3,
    slope: f64,
) -> Result<Option<Portal>, Stop> {
    trace::stage("ring");
    let [e1, e2] = tangents(axis);
    let half = 0.75_f64.sqrt();
    // Also for NaN.
    let slope = lesser(slope, WIDEST_RING_TAN);
    let turns = [[-0.5, half], [-0.5, -half], [1.0, 0.0]];
    let mut corners = [Vertex::default(); 3];
    for (corner, turn) in corners.iter_mut().zip(turns) {
        if set.is_full() {
            return Ok(None);
        }
        let n = axis + (e1 * turn[0] + e2 * turn[1]) * slope;
        *corner = query.evaluate(set, &(n / n.norm()))?.vertex();
    }
    let (x, y) = (corners[0].w - corners[2].w, corners[1].w - corners[2].w);
    let normal = x.cross(&y);
    let is_wide = normal.norm_squared() > MIN_RING_SINE2 * x.norm_squared() * y.norm_squared();
    Ok(is_wide.then_some(Portal { corners }))
}

/// The weight of the area of the new portal in [`choose_corner`]: a few ulps.
const AREA_WEIGHT: f64 = 16.0 * f64::EPSILON;

/// Returns the index of the corner to be replaced by `w`, a point beyond the portal, so that the ray crosses the new
/// portal. Unlike [`Portal::replace_corner`] it decides by more than signs, which are rounding for rays close to an edge of D
/// and for small portals.
pub fn choose_corner(corners: [Vec3; 3], ray: &Vec3, w: &Vec3) -> usize {
    // From w, because differences lose no digits.
    let corners = corners.map(|v| v - w);
    // On which side of the plane through the ray and w a corner is.
    let normal = ray.cross(w);
    let side = corners.each_ref().map(|v| normal.dot(v));
    // The ray crosses the triangle of w and two corners on opposite sides. The two that are farthest on opposite sides
    // stay; of equals those of the larger triangle, seen along the ray.
    let score = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let area = ray.dot(&corners[j].cross(&corners[k]));
        lesser(side[j], -side[k]) + AREA_WEIGHT * area
    };
    let mut replaced = 0;
    for i in 1..3 {
        if score(i) > score(replaced) {
            replaced = i;
        }
    }
    replaced
}

/// Refines the portal outwards: with known differences as long as one is above it, and with support calls as long as
/// the origin is on its outer side or the contact is shallow.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn refine<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    predictor: &mut Predictor,
    ray: &Vec3,
    portal: &mut Portal,
    limit: &GapLimit,
) -> Result<(), Stop> {
    trace::stage("refinement");
    for _ in 0..MAX_STEPS {
        let upper = query.upper.depth;
        let gap = limit.allowed(&query.scale, upper);
        let is_far_enough = |plane: &PortalPlane| {
            plane.offset > 0.0 && !(is_shallow(query) || plane.is_shallow(query))
        };
        let level = |plane: &PortalPlane| {
            (!is_far_enough(plane)).then_some(INSERT_HEIGHT_GAPS * gap * plane.length)
        };
        let Some(plane) = portal.climb(set, ray, Exact::Nothing, level) else {
            return Ok(());
        };
        let has_closed = plane.offset > 0.0 && plane.offset >= (upper - gap) * plane.length;
        if has_closed || set.is_full() || !(plane.length > 0.0) {
            return Ok(());
        }
        let corners = |_: &_| portal.corners;
        let along_normal = plane.offset < 0.0;
        let (sample, model) =
            predictor.evaluate_beyond(query, set, corners, &plane.normal, gap, along_normal)?;
        if plane.height(&sample.w) > query.scale.height_eps() * plane.length {
            portal.replace_corner(ray, sample.vertex(), Exact::Nothing);
        } else if model == Model::Face {
            return Ok(());
        } else {
            predictor.fail_above(&plane.normal);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::{SupportMap, SupportPoint};
    use crate::minkowski::tolerance::GAP_REL;
    use crate::test_shapes::{Random, ball, capsule, corners, difference, hull, placed};

    const LIMIT: GapLimit = GapLimit::new(1e-6, GAP_REL);

    /// Returns the portals after discovery and after refinement, from the centers; `None` for a separated pair.
    fn solve<A: SupportMap, B: SupportMap>(
        a: A,
        b: B,
        center1: Vec3,
        center2: Vec3,
    ) -> Option<(Vec3, [Portal; 2], f64)> {
        let md = difference(a, b);
        let c = SupportPoint {
            v: center1 - center2,
            v1: center1,
            v2: center2,
        };
        let mut query = SupportQuery::new(&md, Some(&c), 0.0);
        let mut set = VertexSet::<64>::EMPTY;
        let ray = -c.v.normalize();
        query.evaluate(&mut set, &ray).ok()?;
        let length = query.upper.depth + c.v.norm();
        let gap = LIMIT.allowed(&query.scale, query.upper.depth);
        let found = discover(
            &mut query,
            &mut set,
            &ray,
            length,
            FAR_UPPER_REL * length,
            0.5 * gap * length,
            NearRay::Ring {
                axis: &ray,
                slope: (2.0 * gap / length).sqrt(),
            },
        )
        .ok()??;
        let mut portal = found;
        let mut predictor = Predictor::default();
        refine(
            &mut query,
            &mut set,
            &mut predictor,
            &ray,
            &mut portal,
            &LIMIT,
        )
        .ok()?;
        Some((ray, [found, portal], query.upper.depth))
    }

    #[test]
    fn the_ray_crosses_every_portal() {
        let mut r = Random::new(11);
        let mut found = 0;
        for round in 0..600 {
            let cube = corners(Vec3::new(0.5, 0.4, 0.3));
            let at = r.direction() * r.within(0.3, 0.9);
            let a = placed(&cube, &r.rotation(), Vec3::zeros());
            let solved = if round % 2 == 0 {
                let b = placed(&cube, &r.rotation(), at);
                solve(hull(&a), hull(&b), Vec3::zeros(), at)
            } else {
                let axis = r.vector(0.3);
                solve(
                    hull(&a),
                    capsule(at - axis, at + axis, 0.3),
                    Vec3::zeros(),
                    at,
                )
            };
            if let Some((ray, portals, _)) = solved {
                found += 1;
                assert!(
                    portals.iter().all(|portal| portal.is_crossed(&ray, 1e-12)),
                    "{round}"
                );
            }
        }
        assert!(found > 300, "{found}");
    }

    /// Symmetric pairs, whose first vertex is on the ray.
    #[test]
    fn symmetric_pairs_have_portals() {
        let cube = corners(Vec3::repeat(0.5));
        for at in [Vec3::x() * 0.9, Vec3::new(0.9, 0.9, 0.0), Vec3::repeat(0.8)] {
            let b = placed(&cube, &crate::test_shapes::Rotation::identity(), at);
            let (ray, portals, _) =
                solve(hull(&cube), hull(&b), Vec3::zeros(), at).expect("a portal");
            assert!(portals.iter().all(|portal| portal.is_crossed(&ray, 1e-12)));
            let at = at.normalize() * 0.9;
            let balls = [ball(Vec3::zeros(), 0.5), ball(at, 0.5)];
            let [a, b] = balls;
            let (ray, portals, depth) = solve(a, b, Vec3::zeros(), at).expect("a portal");
            assert!(portals.iter().all(|portal| portal.is_crossed(&ray, 1e-12)) && depth > 0.0);
        }
    }
}
