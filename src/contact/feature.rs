// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds the feature of an object in a contact: the vertices of its surface around the deepest point.
//!
//! The feature consists of the support vertices along all directions tilted from the normal n by T, n + T out for unit
//! `out` perpendicular to n: all corners of a face, the ends of an edge, points around the deepest one of a curved
//! surface. The *drop* of a vertex is its distance below the support plane, in units of the depth. Its *height* along
//! `out` is its component along n + T out, divided by T.
//!
//! 1. *Project* the known vertices of both objects into the contact frame, in one pass. obj2 is mirrored (−b for b), so
//!    that the normal points out of both objects and all later steps serve either.
//! 2. *Polytope or curved*: an object is taken for a polytope if two different directions returned the same vertex, and
//!    for curved otherwise; for the other if the queries contradict.
//! 3. *Polytope* ([`FeatureQuery::find_polygon`]): begins with the known vertices of greatest height along ±e1 and ±e2.
//!    Beyond each side the direction is evaluated along which both of its ends have the same height, until no side has
//!    a corner beyond it. So the polygon is the same whatever was known. If four corners are a parallelogram and its
//!    longest side has no corner beyond it, neither has any other. A corner and an edge are known if evaluated
//!    directions around them returned them.
//! 4. *Curved* ([`FeatureQuery::find_curved`]): two opposite directions are evaluated, 45° from that to the center. The
//!    mirror images of both vertices in the plane of the normal and the center are the other two: right for bodies of
//!    revolution. If they cannot be, these directions are evaluated too. Of a disc the points between them on its rim
//!    are computed.
//!
//! Related: Bullet (`btConvexConvexAlgorithm`) and MuJoCo (`multiccd`) rotate an object by small angles and repeat
//! the whole query; here only the support function is evaluated along tilted normals. Errors are those of
//! `c-tests/tests/extension/faces.c` and `pressure.c`.

use crate::contact::frame::ContactFrame;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{EPSILON, Vec3, ZERO, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::vertex_set::VertexSet;

/// Number of most recent known vertices used. With 16 a hit takes 0.3 % fewer support points and 1 % more instructions.
pub const MAX_KNOWN: usize = 8;
/// The factor in T = TILT_FACTOR · sqrt(depth / extent), a tangent. A curved surface whose radius is the extent has
/// a drop of 1.6 depths at that tilt (R T²/2), and all corners are found of a face whose drop grows by a depth
/// over its width. Measured: with the factor divided by 1.2 a corner of a leaning box is missed; multiplied by
/// 1.2 the position of a cone on its side jumps by 7 mm.
const TILT_FACTOR: f64 = 1.8;
/// Largest T, 14°; reached if the depth exceeds extent / 52.
const MAX_TILT_TAN: f64 = 0.25;
/// Least tilt of an evaluated direction that replaces the query of a corner or an edge, relative to T. Measured: root
/// mean square error of 7.5 mm with 0.4, 1.8 mm with 0.6.
const MIN_COVER: f64 = 0.6;
/// Least cosine between the normal and an evaluated direction that is used. Others return vertices at the side or
/// at the back of the object.
const MIN_COSINE: f64 = 0.1;
/// Least difference of two directions that prove a vertex if both return it, relative to T. A curved surface returns
/// nearly the same vertex for nearly the same direction.
const MIN_TURN_REL: f64 = 0.05;
/// Least number of known vertices, none of them returned twice, of an object that mirror images are taken of. With 0
/// the corners of a box of which little is known are taken for a curved surface: error 14 mm.
const MIN_CURVED_KNOWN: usize = 4;
/// Largest distance of a vertex from the mirror plane, relative to T times the extent: the radius of curvature is at
/// most 1.1 times the extent. Corners of faces are farther away. Measured: with 1 a position is off the object in one
/// hit of 30,000, with 0.5 a hit takes 0.2 support points more.
const MAX_CURVED_ASIDE: f64 = 0.8;
/// Least height that such a vertex has lost by its drop, relative to that distance: 0.35 on a sphere, 0 on a face.
const MIN_CURVED_DROP: f64 = 0.3;
/// Largest such loss of the vertex away from the center, relative to that distance: 0.7 on a sphere.
const MAX_CURVED_DROP: f64 = 0.9;
/// Largest length of the sum of two opposite vertices that count as symmetric, relative to the extent.
const SYMMETRY_REL_TOL: f64 = 0.004;
/// Least length of a side beyond which a corner is searched, relative to the extent. Without it the root mean square error
/// grows by 2.5 %.
const MIN_SIDE_REL: f64 = 0.016;
/// Distance, relative to the extent, below which two vertices are the same.
const SAME_REL: f64 = 1e-7;
/// Largest drop, in depths, that counts as in the support plane: an error of a third of this fraction of the half
/// width. Insensitive: 0.01 to 0.05 tried.
pub const IN_PLANE_DROP_TOL: f64 = 0.02;
/// Largest difference of drops that count as equal, in depths. Insensitive: 0.1 to 1 tried.
const SAME_DROP_TOL: f64 = 0.1;
/// Largest distance of a vertex from the fitted rim of a disc, relative to the radius: ten times the rounding of
/// callbacks in single precision.
const RIM_REL_TOL: f64 = if EPSILON < 1e-10 { 1e-4 } else { 1e-3 };
/// Fraction of the smallest drop of all vertices that is subtracted from each: a curved surface of radius R has
/// the drop R T²/2 all around. Measured: with 0 the position of a lying capsule jumps by 5 mm; with 1, exact for
/// spheres, its error is 7 mm.
const COMMON_DROP_FACTOR: f64 = 0.75;
/// Distance by which vertices are moved outwards, in depths, so that an edge has an area and the deepest
/// point is inside. Small compared with the flank of an edge ([`crate::contact::center_of_pressure`]).
const VERTEX_OFFSET_REL: f64 = 1.0 / 512.0;
/// Largest number of corners of a polygon.
const MAX_CORNERS: usize = 10;
/// Largest number of steps of its search: each corner is found once and each side closed once.
const MAX_STEPS: usize = 2 * MAX_CORNERS + 4;
/// The coordinate of a diagonal unit vector.
const H: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Returns whether the distance of two vertices along each axis is at most `distance`.
#[inline(always)]
fn is_within(a: &Vec3, b: &Vec3, distance: f64) -> bool {
    (a.x - b.x).abs() <= distance && (a.y - b.y).abs() <= distance
}

/// Returns twice the area of the triangle of the deepest point and two vertices, positive if counterclockwise.
#[inline(always)]
pub fn area2(a: &Vec3, b: &Vec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns unit `out` and the directions at right angles to it, counterclockwise.
#[inline(always)]
fn four_directions(out: Vec2) -> [Vec2; 4] {
    let left = Vec2::new(-out.y, out.x);
    [out, left, -out, -left]
}

/// The vertices of both objects that the same evaluated direction returned, in the contact frame.
#[derive(Clone, Copy)]
pub struct KnownPair {
    x: [f64; 2],
    y: [f64; 2],
    /// In depths.
    drop: [f64; 2],
    /// The tilt of the direction, tangents.
    tilt: [f64; 2],
}

impl KnownPair {
    /// Two vertices at the deepest point.
    pub const ZERO: Self = Self {
        x: [0.0; 2],
        y: [0.0; 2],
        drop: [0.0; 2],
        tilt: [0.0; 2],
    };

    /// Returns the vertex of an object.
    #[inline(always)]
    fn vertex(&self, object: usize) -> Vec3 {
        let k = object % 2;
        Vec3::new(self.x[k], self.y[k], self.drop[k])
    }
}

/// The projected known vertices of both objects of a contact, and queries of further ones.
pub struct FeatureQuery<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    pub frame: ContactFrame,
    known: &'q [KnownPair],
    /// Whether different directions returned the same vertex of an object.
    is_polytope: [bool; 2],
    /// x and y of the center of each object; without centers, the mean of the known vertices.
    centers: [Vec2; 2],
    has_centers: bool,
    /// The object of smaller extent, as far as its vertices are known, 0 or 1.
    pub smaller: usize,
    /// Largest distance of its known vertices and center from the contact, metres.
    extent: f64,
    /// The reciprocal of the unit of drops, 1/metres.
    per_depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half_gap: f64,
    /// T, a tangent, and the cosine of that angle.
    tilt: f64,
    cosine: f64,
    /// Depth divided by T, metres.
    depth_over_tilt: f64,
    /// Distance by which vertices are moved outwards, metres.
    pub vertex_offset: f64,
}

impl<'q, A: SupportMap, B: SupportMap> FeatureQuery<'q, A, B> {
    /// Projects the known vertices and stores them in `known`. The frame's origin is midway between the support planes.
    /// `gap`: the distance of these, metres. `depth`: the larger of that and the tolerance, metres.
    #[inline(always)]
    pub fn new<const N: usize>(
        md: &'q MinkowskiDifference<A, B>,
        set: &'q VertexSet<N>,
        known: &'q mut [KnownPair; MAX_KNOWN],
        frame: ContactFrame,
        centers: Option<[Vec3; 2]>,
        [gap, depth]: [f64; 2],
    ) -> Self {
        let (half_gap, per_depth) = (0.5 * gap, 1.0 / depth);
        let (o, n, [e1, e2]) = (frame.origin, frame.normal, frame.axes);
        let origin = [[o.x, -o.x], [o.y, -o.y], [o.z, -o.z]];
        let mut far2 = [0.0; 2];
        let mut project = |[x, y, z]: [[f64; 2]; 3]| {
            let mut pair = KnownPair::ZERO;
            for k in 0..2 {
                let (x, y) = (x[k] - origin[0][k], y[k] - origin[1][k]);
                let z = z[k] - origin[2][k];
                far2[k] = larger(x * x + y * y + z * z, far2[k]);
                pair.x[k] = e1.x * x + e1.y * y + e1.z * z;
                pair.y[k] = e2.x * x + e2.y * y + e2.z * z;
                let height = n.x * x + n.y * y + n.z * z;
                pair.drop[k] = larger((half_gap - height) * per_depth, 0.0);
            }
            pair
        };
        let first_known = set.len().saturating_sub(MAX_KNOWN);
        let mut len = 0;
        let mut sum = KnownPair::ZERO;
        for (coords, dir) in set.coords_from(first_known).zip(set.dirs_from(first_known)) {
            let pair = project(coords);
            // A point that no call returned has no direction.
            let cosine = n.dot(dir);
            if cosine > MIN_COSINE {
                let tilt = [e1.dot(dir) / cosine, e2.dot(dir) / cosine];
                known[len % MAX_KNOWN] = KnownPair { tilt, ..pair };
                len += 1;
                for k in 0..2 {
                    sum.x[k] += pair.x[k];
                    sum.y[k] += pair.y[k];
                }
            }
        }
        let center = match &centers {
            Some([c1, c2]) => project([[c1.x, -c2.x], [c1.y, -c2.y], [c1.z, -c2.z]]),
            None => sum,
        };
        let smaller = usize::from(far2[1] < far2[0]);
        let extent = far2[smaller].sqrt();
        let tilt = lesser(TILT_FACTOR * (depth / extent).sqrt(), MAX_TILT_TAN);
        let known = known.get(..len).unwrap_or(&[]);
        Self {
            md,
            frame,
            known,
            is_polytope: have_repeated_vertex(known, SAME_REL * extent, MIN_TURN_REL * tilt),
            centers: [0, 1].map(|k| Vec2::new(center.x[k], center.y[k])),
            has_centers: centers.is_some(),
            smaller,
            extent,
            per_depth,
            half_gap,
            tilt,
            cosine: 1.0 / (1.0 + tilt * tilt).sqrt(),
            depth_over_tilt: depth / tilt,
            vertex_offset: larger(depth * VERTEX_OFFSET_REL, 64.0 * EPSILON * extent),
        }
    }

    /// Returns the known vertices of an object.
    #[inline(always)]
    fn known_of(&self, object: usize) -> ObjectVertices<'q> {
        ObjectVertices {
            known: self.known,
            object,
            queried: [ZERO; ObjectVertices::MAX_QUERIED],
            len: 0,
        }
    }

    /// Returns the known vertices of an object with the greatest height along ±e1 and ±e2.
    #[inline(always)]
    pub fn known_extremes(&self, object: usize) -> [Vec3; 4] {
        self.known_of(object).extremes(self.depth_over_tilt)
    }

    /// Evaluates an object along n + T `out`.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    fn query(&self, evaluated: &mut ObjectVertices, out: Vec2) -> Result<Vec3, Fault> {
        let [e1, e2] = &self.frame.axes;
        let aside = (e1 * out.x + e2 * out.y) * (self.tilt * self.cosine);
        let dir = self.frame.normal * self.cosine + aside;
        let p = self.md.support_of_object(evaluated.object, &dir);
        let p = self.frame.project(&p)? * if evaluated.object == 0 { 1.0 } else { -1.0 };
        let v = Vec3::new(
            p.x,
            p.y,
            larger((self.half_gap - p.z) * self.per_depth, 0.0),
        );
        evaluated.push(v);
        Ok(v)
    }

    /// Returns the height of a vertex along n + T `out`, divided by T.
    #[inline(always)]
    fn height(&self, v: &Vec3, out: &Vec2) -> f64 {
        out.dot(&v.xy()) - v.z * self.depth_over_tilt
    }

    /// Returns the distance below which two vertices are the same, metres.
    #[inline(always)]
    fn same_distance(&self) -> f64 {
        SAME_REL * self.extent
    }

    /// Finds the feature of an object and makes its fan. Returns false if the fan has no area: the deepest point is the
    /// center of pressure.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn build_fan(&self, object: usize, fan: &mut Fan) -> Result<bool, Fault> {
        let mut evaluated = self.known_of(object);
        let is_polytope = self.is_polytope[object % 2];
        if !(is_polytope && self.find_polygon(&mut evaluated, true, fan)?
            || self.find_curved(&mut evaluated, fan)?)
        {
            self.find_polygon(&mut evaluated, false, fan)?;
        }
        let vertices = fan.vertices.iter().take(fan.len);
        let least = vertices.fold(1.0, |least, v| lesser(v.z, least));
        for v in fan.vertices.iter_mut().take(fan.len) {
            v.z -= COMMON_DROP_FACTOR * least;
        }
        fan.close();
        Ok(fan.contains_deepest_point() || fan.enclose_deepest_point(self.vertex_offset))
    }

    /// Finds the polygon of a polytope and makes its fan. Returns false if `may_fail` and the first two queries return
    /// new vertices: two directions in a plane with a disc's axis return the same rim point, so a vertex returned twice
    /// does not prove a polytope.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    fn find_polygon(
        &self,
        evaluated: &mut ObjectVertices,
        may_fail: bool,
        fan: &mut Fan,
    ) -> Result<bool, Fault> {
        let same = self.same_distance();
        let mut polygon = Polygon::default();
        for v in &evaluated.extremes(self.depth_over_tilt) {
            polygon.push_distinct(v, same);
        }
        let least_side = MIN_SIDE_REL * self.extent;
        // The number of directions done around a corner or an edge, and that of queries that returned known vertices
        // and new ones.
        let (mut step, mut hits, mut misses) = (0, 0, 0);
        for _ in 0..MAX_STEPS {
            let n = polygon.len;
            let Some((side, out)) = self.next_direction(&polygon, step, least_side) else {
                break;
            };
            let ends = polygon.side(side);
            let [p, q] = ends.map(|end| self.height(end, &out));
            let least = larger(p, q) + 2.0 * self.vertex_offset;
            let mut found = evaluated.highest(out, self.depth_over_tilt, least);
            let is_side = n > 2 || n == 2 && step < 2;
            let is_covered =
                n < 3 && found.is_none() && self.is_covered(evaluated.object, out, ends, is_side);
            if found.is_none() && !is_covered {
                let v = self.query(evaluated, out)?;
                if self.height(&v, &out) > least {
                    (found, misses) = (Some(v), misses + 1);
                } else {
                    hits += 1;
                }
                if may_fail && n < 3 && hits == 0 && misses == 2 {
                    return Ok(false);
                }
            }
            step += 1;
            match found.filter(|v| !polygon.has(v, same)) {
                None => {
                    polygon.is_closed[side % MAX_CORNERS] = is_side && !is_covered;
                    if n == 4 && polygon.is_parallelogram(SYMMETRY_REL_TOL * self.extent) {
                        break;
                    }
                }
                // Beyond an end of an edge.
                Some(v) if !is_side && n == 2 => {
                    polygon.corners[usize::from(step == 3)] = v;
                    polygon.is_closed = [false; MAX_CORNERS];
                    step = 0;
                }
                Some(v) => {
                    polygon.insert(side, &v);
                    step = 0;
                    // A corner below the new one may now be lower in all directions.
                    for i in [side + 2, side] {
                        let corner = polygon.side(i)[0];
                        let lower = larger(corner.z - v.z, 0.0) * self.depth_over_tilt;
                        if lower * lower > offset(corner, &v).norm_squared() {
                            polygon.remove(i);
                        }
                    }
                }
            }
        }
        polygon.write_fan(fan, self.vertex_offset);
        Ok(true)
    }

    /// Returns the side of a polygon beyond which a corner is to be searched next, and the direction; None if the polygon
    /// is complete. Around a corner, directions are the axes; around an edge those to both sides and beyond both ends.
    #[inline(always)]
    fn next_direction(
        &self,
        polygon: &Polygon,
        step: usize,
        least_side: f64,
    ) -> Option<(usize, Vec2)> {
        match (polygon.len, step) {
            (1, 0..4) => Some((0, four_directions(Vec2::x())[step])),
            (2, 0..2) => Some((step, self.outwards(polygon.side(step)))),
            (2, 2..4) => {
                let [p, q] = polygon.side(step - 2);
                let along = offset(p, q);
                Some((0, along * (1.0 / along.norm())))
            }
            (0..3 | MAX_CORNERS, _) => None,
            _ => {
                let side = polygon.longest_open_side(least_side * least_side)?;
                Some((side, self.outwards(polygon.side(side))))
            }
        }
    }

    /// Returns the unit direction out of a side along which both of its ends have the same height.
    #[inline(always)]
    fn outwards(&self, [p, q]: [&Vec3; 2]) -> Vec2 {
        let side = offset(p, q);
        let per_length = 1.0 / side.norm();
        let along = side * per_length;
        let lean = (q.z - p.z) * self.depth_over_tilt * per_length;
        let lean = lesser(larger(lean, -1.0), 1.0);
        Vec2::new(along.y, -along.x) * (1.0 - lean * lean).sqrt() + along * lean
    }

    /// Returns whether an evaluated direction tilted towards `out` returned one of two vertices; `is_side`: towards it
    /// within 27°. (The directions that return a vertex form a convex set, which mostly contains the normal.)
    #[inline(always)]
    fn is_covered(&self, object: usize, out: Vec2, ends: [&Vec3; 2], is_side: bool) -> bool {
        let same = self.same_distance();
        self.known.iter().any(|pair| {
            let (v, tilt) = (pair.vertex(object), Vec2::from(pair.tilt));
            let aside = if is_side {
                2.0 * tilt.perp(&out).abs()
            } else {
                0.0
            };
            tilt.dot(&out) - aside >= MIN_COVER * self.tilt
                && ends.iter().any(|end| is_within(&v, end, same))
        })
    }

    /// Finds the points of a curved surface and makes their fan. Returns false if the surface is that of a polytope: a
    /// query returns a known vertex, or four points are in a plane with the deepest one and not of a disc.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    fn find_curved(&self, evaluated: &mut ObjectVertices, fan: &mut Fan) -> Result<bool, Fault> {
        let center = self.centers[evaluated.object % 2];
        let distance = center.norm();
        let has_axis = distance > self.same_distance();
        let axis = if has_axis {
            center / distance
        } else {
            Vec2::x()
        };
        let out = four_directions(Vec2::new(axis.x - axis.y, axis.x + axis.y) * H);
        let a = self.query(evaluated, out[0])?;
        let c = self.query(evaluated, out[2])?;
        if evaluated.has_repeated(2, self.same_distance()) {
            return Ok(false);
        }
        let tolerance = SYMMETRY_REL_TOL * self.extent;
        fan.is_symmetric = (a + c).xy().norm_squared() < tolerance * tolerance
            && (a.z - c.z).abs() < SAME_DROP_TOL;
        let mirror = |v: &Vec3| {
            let along = 2.0 * axis.dot(&v.xy());
            Vec3::new(along * axis.x - v.x, along * axis.y - v.y, v.z)
        };
        let (mut b, mut d) = (mirror(&c), mirror(&a));
        // The distance of each from the mirror plane, on the side to which its direction is tilted.
        let [aside_a, aside_c] = [axis.perp(&a.xy()), -axis.perp(&c.xy())];
        let is_round = |v: &Vec3, aside: f64| {
            let lost = v.z * self.depth_over_tilt;
            aside >= -self.vertex_offset
                && aside <= MAX_CURVED_ASIDE * self.tilt * self.extent
                && lost >= MIN_CURVED_DROP * aside
        };
        let may_be_mirrored = fan.is_symmetric
            || self.has_centers && has_axis && self.known.len() >= MIN_CURVED_KNOWN;
        let is_mirrored = may_be_mirrored
            && self.tilt < MAX_TILT_TAN
            && is_round(&a, aside_a)
            && is_round(&c, aside_c)
            && c.z * self.depth_over_tilt <= MAX_CURVED_DROP * aside_c
            && self.is_below_known_planes(evaluated.object, [&b, &d], tolerance);
        let mut between = None;
        if !is_mirrored {
            b = self.query(evaluated, out[1])?;
            d = self.query(evaluated, out[3])?;
            between = self.fit_disc_rim([&a, &b, &c, &d], &out);
            let normal = (b - a).cross(&(c - a));
            let drop_at_deepest = a.z + normal.xy().dot(&a.xy()) / normal.z;
            let is_face = between.is_none() && drop_at_deepest < IN_PLANE_DROP_TOL;
            if is_face || evaluated.has_repeated(2, self.same_distance()) {
                return Ok(false);
            }
        }
        fan.len = 0;
        for (k, v) in [a, b, c, d].iter().enumerate() {
            fan.push(moved(v, out[k], self.vertex_offset));
            if let Some(between) = &between {
                let out = (out[k] + out[(k + 1) % 4]) * H;
                fan.push(moved(&between[k], out, self.vertex_offset));
            }
        }
        Ok(true)
    }

    /// Returns whether two points of an object are at most `tolerance` beyond its known support planes. Measured: without
    /// this test positions are off the object in 4 of 1,200 hits of rims in single precision (category of meeting rims).
    #[inline(always)]
    fn is_below_known_planes(&self, object: usize, points: [&Vec3; 2], tolerance: f64) -> bool {
        let depth = self.tilt * self.depth_over_tilt;
        let mut is_below = true;
        for pair in self.known {
            let (v, tilt) = (pair.vertex(object), Vec2::from(pair.tilt));
            for p in points {
                let beyond = tilt.dot(&offset(&v, p)) - (p.z - v.z) * depth;
                is_below &= beyond <= tolerance * self.tilt;
            }
        }
        is_below
    }

    /// Returns the points midway between the four vertices on the rim of a disc; None if the vertices are not on
    /// such a rim. A disc returns its center plus the radius times the direction in its plane. (A square whose
    /// corners lie along the four tilt directions within 1e-4 rad is mistaken for a disc.)
    #[inline(always)]
    fn fit_disc_rim(&self, [a, b, c, d]: [&Vec3; 4], out: &[Vec2; 4]) -> Option<[Vec3; 4]> {
        let normal = (b - a).cross(&(c - a));
        let gradient = normal.xy() / -normal.z;
        let lean = gradient * (self.tilt * self.depth_over_tilt);
        let scale = 1.0 / (1.0 + lean.norm_squared());
        // The direction in the leaning disc's plane that is farthest along the tilted normal: that normal without
        // its part along the axis of the disc.
        let outwards = |out: Vec2| {
            let tilt = out * self.tilt - lean;
            let down = lean.dot(&tilt) * scale;
            let in_plane = tilt - lean * down;
            in_plane / (in_plane.norm_squared() + down * down).sqrt()
        };
        let [first, second, third, fourth] = out.map(outwards);
        let (span, chord) = (first - third, offset(c, a));
        let span2 = span.norm_squared();
        // For corners of other faces the chord mostly has another direction.
        let cross = span.perp(&chord);
        if !(cross * cross <= RIM_REL_TOL * span2 * chord.norm_squared()) {
            return None;
        }
        let radius = span.dot(&chord) / span2;
        let on_rim = |out: Vec2| {
            let from_a = (out - first) * radius;
            a + Vec3::new(from_a.x, from_a.y, gradient.dot(&from_a))
        };
        let is_there = |out, found: &Vec3| {
            let error = on_rim(out) - found;
            let tolerance = RIM_REL_TOL * radius;
            error.xy().norm_squared() <= tolerance * tolerance && error.z.abs() <= SAME_DROP_TOL
        };
        // False for NaN.
        let is_rim = radius > 2.0 * self.vertex_offset
            && is_there(second, b)
            && is_there(third, c)
            && is_there(fourth, d);
        is_rim.then(|| [0, 1, 2, 3].map(|k| on_rim(outwards((out[k % 4] + out[(k + 1) % 4]) * H))))
    }
}

/// Returns for both objects whether two directions that differ by more than `turned` returned the same vertex, within
/// `same`.
#[inline(always)]
fn have_repeated_vertex(known: &[KnownPair], same: f64, turned: f64) -> [bool; 2] {
    // The greatest excess over the limits in place of comparisons, for both objects in one operation.
    let mut excess = [0.0; 2];
    for (i, v) in known.iter().enumerate() {
        for w in known.iter().take(i) {
            let turn = (v.tilt[0] - w.tilt[0]).abs() + (v.tilt[1] - w.tilt[1]).abs() - turned;
            for k in 0..2 {
                let distance = (v.x[k] - w.x[k]).abs() + (v.y[k] - w.y[k]).abs();
                excess[k] = larger(lesser(turn, same - distance), excess[k]);
            }
        }
    }
    excess.map(|excess| excess > 0.0)
}

/// Returns a vertex moved along unit `out`.
#[inline(always)]
fn moved(v: &Vec3, out: Vec2, distance: f64) -> Vec3 {
    Vec3::new(v.x + distance * out.x, v.y + distance * out.y, v.z)
}

/// The evaluated vertices of one object: known ones and those queried for its feature.
struct ObjectVertices<'q> {
    known: &'q [KnownPair],
    object: usize,
    queried: [Vec3; ObjectVertices::MAX_QUERIED],
    len: usize,
}

impl ObjectVertices<'_> {
    /// Number of queried vertices that are kept; later ones are queried again if needed.
    const MAX_QUERIED: usize = 8;

    /// Appends a queried vertex.
    #[inline(always)]
    fn push(&mut self, v: Vec3) {
        if let Some(end) = self.queried.get_mut(self.len) {
            *end = v;
            self.len += 1;
        }
    }

    /// Returns the queried vertices.
    #[inline(always)]
    fn queried(&self) -> &[Vec3] {
        self.queried.get(..self.len).unwrap_or(&[])
    }

    /// Returns the vertices of greatest height along ±e1 and ±e2; the deepest point if none is known.
    #[inline(always)]
    fn extremes(&self, depth_over_tilt: f64) -> [Vec3; 4] {
        // The index of a vertex is in the low bits of its height, so that the maximum carries it.
        const MASK: u64 = (MAX_KNOWN + ObjectVertices::MAX_QUERIED).next_power_of_two() as u64 - 1;
        let mut best = [f64::NEG_INFINITY; 4];
        let mut compare = |i: usize, v: &Vec3| {
            let fall = v.z * depth_over_tilt;
            let heights = [v.x - fall, v.y - fall, -v.x - fall, -v.y - fall];
            for j in 0..4 {
                let height = f64::from_bits(heights[j].to_bits() & !MASK | i as u64);
                best[j] = larger(height, best[j]);
            }
        };
        for (i, pair) in self.known.iter().enumerate() {
            compare(i, &pair.vertex(self.object));
        }
        for (i, v) in self.queried().iter().enumerate() {
            compare(MAX_KNOWN + i, v);
        }
        best.map(|height| {
            let i = (height.to_bits() & MASK) as usize;
            match self.known.get(i) {
                Some(pair) => pair.vertex(self.object),
                None => *self.queried.get(i.wrapping_sub(MAX_KNOWN)).unwrap_or(&ZERO),
            }
        })
    }

    /// Returns the vertex of greatest height along `out`, if that is more than `least`.
    #[inline(always)]
    fn highest(&self, out: Vec2, depth_over_tilt: f64, least: f64) -> Option<Vec3> {
        let (mut highest, mut found) = (least, None);
        let mut compare = |v: Vec3| {
            let height = out.dot(&v.xy()) - v.z * depth_over_tilt;
            if height > highest {
                (highest, found) = (height, Some(v));
            }
        };
        for pair in self.known {
            compare(pair.vertex(self.object));
        }
        self.queried().iter().for_each(|v| compare(*v));
        found
    }

    /// Returns whether one of the newest `count` vertices was known before.
    #[inline(always)]
    fn has_repeated(&self, count: usize, same: f64) -> bool {
        let end = self.len.saturating_sub(count);
        let old = self.queried.get(..end).unwrap_or(&[]);
        let new = self.queried.get(end..self.len).unwrap_or(&[]);
        let is_new = |v: &Vec3| new.iter().any(|w| is_within(v, w, same));
        let mut known = self.known.iter();
        old.iter().any(is_new) || known.any(|pair| is_new(&pair.vertex(self.object)))
    }
}

/// The corners of a polytope found so far, counterclockwise.
#[derive(Default)]
struct Polygon {
    corners: [Vec3; MAX_CORNERS],
    /// Whether there is no corner beyond the side from each corner to the next.
    is_closed: [bool; MAX_CORNERS],
    len: usize,
}

impl Polygon {
    /// Appends a corner unless it is the last or the first one.
    #[inline(always)]
    fn push_distinct(&mut self, v: &Vec3, same: f64) {
        let n = self.len % MAX_CORNERS;
        let last = n.saturating_sub(1);
        let is_old =
            is_within(v, &self.corners[last], same) || is_within(v, &self.corners[0], same);
        if n == 0 || !is_old {
            self.corners[n] = *v;
            self.len = n + 1;
        }
    }

    /// Returns the ends of side `i`, modulo the number of corners, for `i` below twice that.
    #[inline(always)]
    fn side(&self, i: usize) -> [&Vec3; 2] {
        let i = if i < self.len { i } else { i - self.len };
        let next = if i + 1 < self.len { i + 1 } else { 0 };
        [i, next].map(|i| &self.corners[i.min(MAX_CORNERS - 1)])
    }

    /// Returns the longest side that is not closed and at least partly in the overlap.
    #[inline(always)]
    fn longest_open_side(&self, least2: f64) -> Option<usize> {
        let (mut longest, mut found) = (least2, None);
        for i in 0..self.len.min(MAX_CORNERS) {
            let [p, q] = self.side(i);
            let length2 = offset(p, q).norm_squared();
            if length2 > longest && !self.is_closed[i] && (p.z < 1.0 || q.z < 1.0) {
                (longest, found) = (length2, Some(i));
            }
        }
        found
    }

    /// Returns whether a vertex is a corner.
    #[inline(always)]
    fn has(&self, v: &Vec3, same: f64) -> bool {
        let mut corners = self.corners.iter().take(self.len);
        corners.any(|corner| is_within(corner, v, same))
    }

    /// Inserts a corner beyond a side.
    #[inline(always)]
    fn insert(&mut self, side: usize, v: &Vec3) {
        let mut i = self.len.min(MAX_CORNERS - 1);
        while i > side + 1 {
            (self.corners[i], self.is_closed[i]) = (self.corners[i - 1], self.is_closed[i - 1]);
            i -= 1;
        }
        (self.corners[i], self.is_closed[i]) = (*v, false);
        self.is_closed[side % MAX_CORNERS] = false;
        self.len += 1;
    }

    /// Removes a corner.
    #[cold]
    #[inline(never)]
    fn remove(&mut self, i: usize) {
        let removed = i % self.len.max(1);
        for i in 1..MAX_CORNERS {
            if i > removed {
                self.corners[i - 1] = self.corners[i];
                self.is_closed[i - 1] = self.is_closed[i];
            }
        }
        self.len -= 1;
        let last = (removed + self.len).saturating_sub(1) % self.len.max(1);
        self.is_closed[last % MAX_CORNERS] = false;
    }

    /// Returns whether four corners are a parallelogram.
    #[inline(always)]
    fn is_parallelogram(&self, tolerance: f64) -> bool {
        let [a, b, c, d, ..] = &self.corners;
        (a + c - b - d).xy().norm_squared() < tolerance * tolerance
    }

    /// Makes the fan of the corners, each moved outwards; of an edge, its ends also to both sides.
    #[inline(always)]
    fn write_fan(&self, fan: &mut Fan, distance: f64) {
        let corners = self.corners.get(..self.len).unwrap_or(&[]);
        fan.len = 0;
        if let [a, b] = corners {
            let along = offset(a, b);
            let out = four_directions(along * (1.0 / along.norm()));
            for (v, k) in [(a, 2), (a, 3), (b, 0), (b, 1)] {
                fan.push(moved(v, out[k], distance));
            }
            return;
        }
        let mean = corners.iter().sum::<Vec3>() * (1.0 / corners.len() as f64);
        for v in corners {
            let out = offset(&mean, v);
            let norm2 = larger(out.norm_squared(), f64::MIN_POSITIVE);
            fan.push(moved(v, out, distance / norm2.sqrt()));
        }
    }
}

/// The vertices of a feature, counterclockwise around the deepest point.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// `vertices[len]` repeats the first one.
    pub vertices: [Vec3; Fan::CAPACITY],
    pub len: usize,
    /// True if opposite vertices are symmetric about the deepest point.
    pub is_symmetric: bool,
}

impl Fan {
    /// Largest number of vertices: eight of a disc or a polygon, two that enclose the deepest point, and the
    /// repeated first one.
    pub const CAPACITY: usize = MAX_CORNERS + 3;
    /// The fan without vertices.
    pub const EMPTY: Self = Self {
        vertices: [ZERO; Self::CAPACITY],
        len: 0,
        is_symmetric: false,
    };

    /// Appends a vertex; a full fan ignores it.
    #[inline(always)]
    pub fn push(&mut self, v: Vec3) {
        if self.len < Self::CAPACITY - 1 {
            self.vertices[self.len] = v;
            self.len += 1;
        }
    }

    /// Repeats the first vertex.
    #[inline(always)]
    pub fn close(&mut self) {
        self.vertices[self.len.min(Self::CAPACITY - 1)] = self.vertices[0];
    }

    /// Returns twice the area of the triangle of the deepest point, vertex `i` and the next one.
    #[inline(always)]
    pub fn area(&self, i: usize) -> f64 {
        let i = i.min(Self::CAPACITY - 2);
        area2(&self.vertices[i], &self.vertices[i + 1])
    }

    /// Returns whether the vertices are once around the deepest point, counterclockwise.
    #[inline(always)]
    pub fn contains_deepest_point(&self) -> bool {
        let mut turns = 0;
        let mut is_inside = true;
        for i in 0..self.len.min(Self::CAPACITY - 1) {
            is_inside &= self.area(i) > 0.0;
            turns += usize::from(self.vertices[i].y < 0.0 && self.vertices[i + 1].y >= 0.0);
        }
        is_inside && turns == 1
    }

    /// Orders the vertices around the deepest point and, if it is outside, adds a vertex at `distance` behind it. Returns
    /// false if there is no area.
    ///
    /// The vertices are mostly in order, but not always around an edge: the vertex along a direction may be high, in
    /// place of one farther along it and lower.
    #[cold]
    #[inline(never)]
    fn enclose_deepest_point(&mut self, distance: f64) -> bool {
        let is_before = |a: &Vec3, b: &Vec3| {
            let half = |v: &Vec3| u8::from(v.y < 0.0 || v.y == 0.0 && v.x < 0.0);
            half(a) < half(b) || half(a) == half(b) && area2(a, b) > 0.0
        };
        let n = self.len.min(Self::CAPACITY - 2);
        // Insertion sort.
        for end in 1..n {
            let mut i = end;
            while i > 0 && i < Self::CAPACITY {
                if !is_before(&self.vertices[i], &self.vertices[i - 1]) {
                    break;
                }
                (self.vertices[i], self.vertices[i - 1]) = (self.vertices[i - 1], self.vertices[i]);
                i -= 1;
            }
        }
        self.len = n;
        self.close();
        let is_gap = |i: &usize| {
            let [p, q] = self.side(*i);
            let area = area2(p, q);
            area < 0.0 || area == 0.0 && p.xy().dot(&q.xy()) <= 0.0
        };
        if let Some(gap) = (0..n).find(is_gap) {
            let [p, q] = self.side(gap);
            // Opposite to the bisector of the directions to p and q, also if both are on one side.
            let [a, b] = [p, q].map(|v| 1.0 / (v.xy().norm_squared() + f64::MIN_POSITIVE).sqrt());
            let (x, y) = (q.y * b - p.y * a, p.x * a - q.x * b);
            let scale = distance / (x * x + y * y + f64::MIN_POSITIVE).sqrt();
            let mut behind = Vec3::new(x * scale, y * scale, 0.0);
            let places = self.vertices.iter_mut().skip(gap + 1);
            places.for_each(|place| core::mem::swap(place, &mut behind));
            self.len = n + 1;
            self.close();
        }
        let mut i = 0;
        while i < self.len && self.len > 2 {
            if self.is_dent(i) {
                for k in 1..Self::CAPACITY {
                    if k > i {
                        self.vertices[k - 1] = self.vertices[k];
                    }
                }
                self.len -= 1;
                self.close();
                i = 0;
            } else {
                i += 1;
            }
        }
        self.len > 2
    }

    /// Returns the ends of side `i`, below the length.
    #[inline(always)]
    fn side(&self, i: usize) -> [&Vec3; 2] {
        let i = i.min(Self::CAPACITY - 2);
        [&self.vertices[i], &self.vertices[i + 1]]
    }

    /// Returns whether a vertex is nearer than the line of its neighbours, and not higher than the plane of these and the
    /// deepest point. (The object is convex, so the surface extends to that line.)
    fn is_dent(&self, i: usize) -> bool {
        let [p, _] = self.side(if i > 0 { i - 1 } else { self.len - 1 });
        let [v, q] = self.side(i);
        let per_area = 1.0 / area2(p, q);
        let (weight_p, weight_q) = (area2(v, q) * per_area, area2(p, v) * per_area);
        per_area > 0.0
            && weight_p + weight_q < 1.0
            && weight_p * p.z + weight_q * q.z < v.z + SAME_DROP_TOL
    }

    /// Mirrors the fan through the deepest point.
    #[inline(always)]
    pub fn mirror(&mut self) {
        for v in self.vertices.iter_mut().take(self.len + 1) {
            (v.x, v.y) = (-v.x, -v.y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    /// Tests fans from a triangle to a sliver that points at the deepest point, and one in the wrong order: all areas
    /// are positive once the deepest point is enclosed. A point has none.
    #[test]
    fn enclosed_fan_contains_the_deepest_point() {
        let mut r = Random::new(1);
        for round in 0..1000 {
            let width = 10.0_f64.powf(-r.within(0.0, 4.0));
            let mut corners = vec![
                (2.0, width),
                (1.0, -width),
                (3.0, -width * r.within(-0.4, 0.9)),
            ];
            if round % 2 == 0 {
                corners.extend([(-0.25, -0.061), (-0.05, -0.3)]);
            }
            let (sin, cos) = r.within(0.0, core::f64::consts::TAU).sin_cos();
            let mut fan = Fan::EMPTY;
            for (x, y) in corners {
                let (x, y) = (x * cos - y * sin, x * sin + y * cos);
                fan.push(Vec3::new(x, y, 0.0));
            }
            fan.close();
            assert!(!fan.contains_deepest_point());
            assert!(fan.enclose_deepest_point(1e-3));
            assert!(fan.contains_deepest_point(), "{round} {fan:?}");
        }
        let mut point = Fan::EMPTY;
        point.push(Vec3::x());
        point.close();
        assert!(!point.enclose_deepest_point(1e-3));
    }
}
