// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The feature of an object in a contact: the vertices of its surface around the deepest point.
//!
//! Finds the support vertices along four directions tilted from the normal n by T: n + T (±e1), n + T (±e2).
//! They are the outermost corners of a face, and four evenly spaced points of a curved surface.
//!
//! Terms. The *drop* of a vertex is its distance below the support plane; here it is in units of the depth. The
//! *cover* of a tilted direction is the largest tilt towards it among the evaluated directions that returned
//! its predicted vertex.
//!
//! 1. *Project* the known vertices of both objects into the contact frame, in one pass. obj2 is mirrored
//!    (−b for b), so that the normal points out of both objects and all later steps serve either.
//! 2. *Predict* for each of the four directions the known vertex farthest along it.
//! 3. *Polytope*: if two evaluated directions returned the same vertex. A prediction is accepted if its cover is
//!    at least [`MIN_COVER`] T; otherwise it is queried, the least covered first. (The directions that return a
//!    vertex form a convex set, which mostly contains the contact normal.) If the four vertices are only two,
//!    the ends of an edge, a face beside it may be unknown: both sides are queried, unless an evaluated
//!    direction that returned an end is tilted to that side.
//! 4. *Curved* otherwise: opposite directions are queried. If the two opposite vertices are symmetric about the
//!    deepest point, that point is the center of pressure. If a query returns its predicted vertex, the object
//!    is taken for a polytope.
//! 5. *Fan*: the four vertices in their order around the deepest point, with a fifth corner of a polytope, or
//!    with the points between them on the rim of a disc.
//!
//! One file above 400 lines, because all steps use the same projection. Related: Bullet (`btConvexConvexAlgorithm`)
//! and MuJoCo (`multiccd`) rotate an object by small angles and repeat the whole query; here only the support
//! function is evaluated along tilted normals. Figures are from `c-tests/tests/extension/pressure.c` and recorded
//! contacts.

use crate::contact::frame::ContactFrame;
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{EPSILON, Vec3, ZERO, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::vertex_set::VertexSet;

/// Number of most recent known vertices used.
pub const MAX_KNOWN: usize = 16;
/// The factor in T = TILT_FACTOR · sqrt(depth / extent), a tangent. A curved surface whose radius is the extent has
/// a drop of 1.6 depths at that tilt (R T²/2), and all corners are found of a face whose drop grows by a depth
/// over its width. Measured: with the factor divided by 1.2 a corner of a leaning box is missed; multiplied by
/// 1.2 the position of a cone on its side jumps by 7 mm.
const TILT_FACTOR: f64 = 1.8;
/// Largest T, 14°; reached if the depth exceeds extent / 52.
const MAX_TILT_TAN: f64 = 0.25;
/// Least cover of an accepted prediction, relative to T. Measured: root mean square error of 7.5 mm with 0.4,
/// 1.8 mm with 0.6.
const MIN_COVER: f64 = 0.6;
/// Least cosine between the normal and an evaluated direction that is used. Others return vertices at the side or
/// at the back of the object.
const MIN_COSINE: f64 = 0.1;
/// Largest length of the sum of two opposite vertices that count as symmetric, relative to the extent.
const SYMMETRY_REL_TOL: f64 = 0.004;
/// A feature no larger than this, relative to the extent, counts as a point: the center of pressure is within a
/// quarter of that size.
const POINT_REL: f64 = 0.016;
/// Distance, relative to the extent, below which two vertices are the same.
const SAME_REL: f64 = 1e-7;
/// Largest difference of the drop, in depths, between a fourth corner and the plane of three for a common face.
/// Above it the surface between them is not flat. Insensitive: 0.1 to 1 tried.
const FACE_DROP_TOL: f64 = 0.1;
/// Relative area below which three corners count as collinear, and the deepest point as inside a side.
/// Insensitive: 0.005 to 0.08 tried.
const NARROW_REL: f64 = 0.02;
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
/// Least value of twice the area of a triangle, relative to the square of the vertex offset.
const MIN_AREA_REL: f64 = f64::EPSILON;

/// The four tilt directions, along the axes.
const TILT_DIRECTIONS: [Vec2; 4] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(0.0, 1.0),
    Vec2::new(-1.0, 0.0),
    Vec2::new(0.0, -1.0),
];
/// The coordinate of a diagonal unit vector.
const H: f64 = core::f64::consts::FRAC_1_SQRT_2;
/// The directions between them.
const DIAGONALS: [Vec2; 4] = [
    Vec2::new(H, H),
    Vec2::new(-H, H),
    Vec2::new(-H, -H),
    Vec2::new(H, -H),
];

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

/// Four vertices of an object around the deepest point, counterclockwise: the support vertices of the tilted
/// directions, predicted or queried, or those beside an edge.
struct Feature {
    vertices: [Vec3; 4],
    /// The outward direction of each, unit.
    outwards: [Vec2; 4],
    /// The height of each along its tilted direction, divided by T.
    scores: [f64; 4],
    /// The cover of each.
    cover: [f64; 4],
    /// True if two evaluated directions returned the same vertex: they are vertices of a polytope.
    is_polytope: bool,
}

/// The vertices of a feature, counterclockwise around the deepest point.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// `vertices[len]` repeats the first one.
    pub vertices: [Vec3; Fan::CAPACITY],
    /// For each vertex twice the area of the triangle of the deepest point, it and the next vertex.
    pub areas: [f64; Fan::CAPACITY],
    pub len: usize,
}

/// Returns the gradient of the drop in the plane of three vertices, depths per metre.
#[inline(always)]
fn drop_gradient([a, b, c]: [&Vec3; 3]) -> Vec2 {
    let normal = (b - a).cross(&(c - a));
    normal.xy() / -normal.z
}

/// The projected known vertices of both objects of a contact, and queries of further ones.
pub struct FeatureQuery<'q, A, B, const N: usize> {
    md: &'q MinkowskiDifference<A, B>,
    set: &'q VertexSet<N>,
    pub frame: ContactFrame,
    /// x, y and drop (in depths) of each known vertex.
    known: &'q [[[f64; 2]; 3]],
    /// The index of the first of them in the set.
    first_known: usize,
    /// x and y of the center of each object; without centers, of the middle of the witness points.
    centers: [[f64; 2]; 2],
    /// The object of smaller extent, as far as its vertices are known, 0 or 1.
    pub smaller: usize,
    /// Largest distance of its known vertices and center from the contact, metres.
    extent: f64,
    /// The unit of drops, metres.
    pub depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half_gap: f64,
    /// T, a tangent.
    tilt: f64,
    /// Depth divided by T, metres.
    depth_over_tilt: f64,
    /// Distance by which vertices are moved outwards, metres.
    pub vertex_offset: f64,
}

impl<'q, A: SupportMap, B: SupportMap, const N: usize> FeatureQuery<'q, A, B, N> {
    /// Projects the known vertices and stores them in `known`. The frame's origin is midway between the support
    /// planes. `gap`: the distance of these, metres. `depth`: the larger of that and the tolerance, metres.
    #[inline(always)]
    pub fn new(
        md: &'q MinkowskiDifference<A, B>,
        set: &'q VertexSet<N>,
        known: &'q mut [[[f64; 2]; 3]; MAX_KNOWN],
        frame: ContactFrame,
        centers: Option<[Vec3; 2]>,
        [gap, depth]: [f64; 2],
    ) -> Self {
        let (half_gap, per_depth) = (0.5 * gap, 1.0 / depth);
        let (o, n, [e1, e2]) = (frame.origin, frame.normal, frame.axes);
        let mut far2 = [0.0; 2];
        let mut project = |[x, y, z]: [[f64; 2]; 3]| {
            let mut projected = [[0.0; 2]; 3];
            for (k, side) in [1.0, -1.0].into_iter().enumerate() {
                let (x, y, z) = (x[k] - side * o.x, y[k] - side * o.y, z[k] - side * o.z);
                far2[k] = larger(x * x + y * y + z * z, far2[k]);
                projected[0][k] = e1.x * x + e1.y * y + e1.z * z;
                projected[1][k] = e2.x * x + e2.y * y + e2.z * z;
                let height = n.x * x + n.y * y + n.z * z;
                projected[2][k] = larger((half_gap - height) * per_depth, 0.0);
            }
            projected
        };
        let first_known = set.len().saturating_sub(MAX_KNOWN);
        let len = set.len() - first_known;
        for (i, projected) in known.iter_mut().enumerate().take(len) {
            *projected = project(set.coords(first_known + i));
        }
        let [c1, c2] = centers.unwrap_or([o; 2]);
        let [x, y, _] = project([[c1.x, -c2.x], [c1.y, -c2.y], [c1.z, -c2.z]]);
        let smaller = usize::from(far2[1] < far2[0]);
        let extent = far2[smaller].sqrt();
        let tilt = lesser(TILT_FACTOR * (depth / extent).sqrt(), MAX_TILT_TAN);
        Self {
            md,
            set,
            frame,
            known: known.get(..len).unwrap_or(&[]),
            first_known,
            centers: [x, y],
            smaller,
            extent,
            depth,
            half_gap,
            tilt,
            depth_over_tilt: depth / tilt,
            vertex_offset: larger(depth * VERTEX_OFFSET_REL, 64.0 * EPSILON * extent),
        }
    }

    /// Returns the known vertices of an object.
    #[inline(always)]
    pub fn known(&self, object: usize) -> impl Iterator<Item = Vec3> + '_ {
        let k = object % 2;
        self.known
            .iter()
            .map(move |[x, y, drop]| Vec3::new(x[k], y[k], drop[k]))
    }

    /// Evaluates an object along the tilted normal. `tilt`: tangents.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    fn query(&self, object: usize, tilt: Vec2) -> Result<Vec3, Fault> {
        let dir = self.frame.tilted_direction(1.0, tilt);
        let side = if object == 0 { 1.0 } else { -1.0 };
        let p = self.md.support_of_object(object, &dir);
        let p = self.frame.project(&p)? * side;
        let drop = larger((self.half_gap - p.z) / self.depth, 0.0);
        Ok(Vec3::new(p.x, p.y, drop))
    }

    /// Returns the height of a vertex along each of the tilted directions, divided by T.
    #[inline(always)]
    fn scores(&self, v: &Vec3) -> [f64; 4] {
        let drop = v.z * self.depth_over_tilt;
        [v.x - drop, v.y - drop, -v.x - drop, -v.y - drop]
    }

    /// Returns the distance below which two vertices are the same, metres.
    #[inline(always)]
    fn same_distance(&self) -> f64 {
        SAME_REL * self.extent
    }

    /// Predicts the support vertices of the tilted directions from the known vertices.
    #[inline(always)]
    fn predict(&self, object: usize) -> Feature {
        let mut found = Feature {
            vertices: [Vec3::zeros(); 4],
            outwards: TILT_DIRECTIONS,
            scores: [f64::NEG_INFINITY; 4],
            cover: [0.0; 4],
            is_polytope: false,
        };
        let mut is_returned = [false; 4];
        let [e1, e2] = &self.frame.axes;
        let same = self.same_distance();
        for (i, v) in self.known(object).enumerate() {
            let scores = self.scores(&v);
            let dir = self.set.dir(self.first_known + i);
            let is_facing = self.frame.normal.dot(&dir) > MIN_COSINE;
            let (x, y) = (e1.dot(&dir), e2.dot(&dir));
            for (k, tilt) in [x, y, -x, -y].into_iter().enumerate() {
                let gain = scores[k] - found.scores[k];
                if gain > same {
                    (found.scores[k], found.vertices[k]) = (scores[k], v);
                    (is_returned[k], found.cover[k]) = (is_facing, 0.0);
                    if is_facing {
                        found.cover[k] = tilt;
                    }
                } else if gain >= -same && is_facing && is_within(&v, &found.vertices[k], same) {
                    found.is_polytope |= is_returned[k];
                    is_returned[k] = true;
                    found.cover[k] = larger(tilt, found.cover[k]);
                }
            }
        }
        found
    }

    /// Finds the feature of an object; None if opposite vertices are symmetric about the deepest point. `towards`:
    /// selects the direction that is queried first if the object may be curved.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    fn find_feature(&self, object: usize, towards: Vec2) -> Result<Option<Feature>, Fault> {
        let mut found = self.predict(object);
        let mut is_queried = [false; 4];
        let mut next = usize::from(towards.y.abs() > towards.x.abs());
        let (mut hits, mut misses) = (0, 0);
        // Each iteration queries another one of the four directions.
        for _ in 0..4 {
            if found.is_polytope {
                let cover = &found.cover;
                next = (1..4).fold(0, |k, i| if cover[i] < cover[k] { i } else { k });
                if !(cover[next] < MIN_COVER * self.tilt) {
                    break;
                }
            }
            let v = self.query(object, TILT_DIRECTIONS[next % 4] * self.tilt)?;
            if is_within(&v, &found.vertices[next % 4], self.same_distance()) {
                (found.is_polytope, hits) = (true, hits + 1);
            } else {
                misses += 1;
                // Two directions in a plane with a disc's axis return the same rim point. So a vertex returned twice
                // does not prove a polytope; after two failed predictions and no correct one it is not one.
                found.is_polytope &= hits > 0 || misses < 2;
            }
            is_queried[next % 4] = true;
            if found.is_polytope {
                found.improve_predictions(&v, &self.scores(&v), &is_queried);
            }
            (found.vertices[next % 4], found.cover[next % 4]) = (v, f64::INFINITY);
            if !found.is_polytope {
                let opposite = (next + 2) % 4;
                if misses == 2 && is_queried[opposite] {
                    if self.is_symmetric(&v, &found.vertices[opposite]) {
                        return Ok(None);
                    }
                    next = (next + 1) % 4;
                } else {
                    next = opposite;
                }
                if is_queried[next % 4] {
                    next = is_queried.iter().position(|q| !*q).unwrap_or(0);
                }
            }
        }
        if found.is_polytope {
            self.query_sides_of_edge(object, &mut found)?;
        }
        Ok(Some(found))
    }

    /// Queries both sides of a feature that is an edge, because a face beside it may be unknown; not a side to
    /// which an evaluated direction that returned an end is tilted.
    #[inline(always)]
    fn query_sides_of_edge(&self, object: usize, feature: &mut Feature) -> Result<(), Fault> {
        let [a, rest @ ..] = feature.vertices;
        let is_same = |p: &Vec3, q: &Vec3| is_within(p, q, self.same_distance());
        let Some(&b) = rest.iter().find(|v| !is_same(v, &a)) else {
            return Ok(());
        };
        if !rest.iter().all(|v| is_same(v, &a) || is_same(v, &b)) {
            return Ok(());
        }
        let along = offset(&a, &b) / offset(&a, &b).norm();
        let left = Vec2::new(-along.y, along.x);
        feature.vertices = [a, a, b, b];
        feature.outwards = [-along, -left, along, left];
        let [_, vertex1, _, vertex3] = &mut feature.vertices;
        for (vertex, out) in [(vertex1, -left), (vertex3, left)] {
            let is_covered = self.known(object).enumerate().any(|(i, p)| {
                let dir = self.set.dir(self.first_known + i);
                let cosine = self.frame.normal.dot(&dir);
                let tilt = Vec2::from(self.frame.axes.map(|e| e.dot(&dir) / cosine));
                let is_tilted_out =
                    tilt.dot(&out) - 2.0 * tilt.perp(&out).abs() >= MIN_COVER * self.tilt;
                cosine > MIN_COSINE && is_tilted_out && (is_same(&p, &a) || is_same(&p, &b))
            });
            if !is_covered {
                let p = self.query(object, out * self.tilt)?;
                if out.dot(&offset(&a, &p)) > 2.0 * self.vertex_offset {
                    *vertex = p;
                }
            }
        }
        Ok(())
    }

    /// Returns the displacement from the deepest point to the center of an object.
    #[inline(always)]
    pub fn towards_center(&self, object: usize) -> Vec2 {
        self.centers.map(|xy| xy[object % 2]).into()
    }

    /// Returns whether two vertices are symmetric about the deepest point.
    fn is_symmetric(&self, a: &Vec3, b: &Vec3) -> bool {
        let tolerance = SYMMETRY_REL_TOL * self.extent;
        let distance2 = (a + b).xy().norm_squared();
        distance2 < tolerance * tolerance && (a.z - b.z).abs() < FACE_DROP_TOL
    }

    /// Returns whether the vertices, as far down as the depth, are within a point's size.
    fn is_point(&self, vertices: &[Vec3]) -> bool {
        vertices.iter().all(|v| {
            let size = POINT_REL * self.extent * larger(v.z, 1.0);
            v.xy().norm_squared() <= size * size
        })
    }

    /// Finds the feature of an object and makes its fan. `towards`: selects the direction that is queried first if
    /// the object may be curved. Returns false if the deepest point is the center of pressure: the feature is
    /// symmetric about it, or is a point.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn build_fan(&self, object: usize, towards: Vec2, fan: &mut Fan) -> Result<bool, Fault> {
        let Some(feature) = self.find_feature(object, towards)? else {
            return Ok(false);
        };
        let vertices = &feature.vertices;
        let is_curved = !feature.is_polytope;
        let between = is_curved.then(|| self.fit_disc_rim(vertices)).flatten();
        fan.len = 0;
        for k in 0..4 {
            fan.push(self.offset_outwards(&vertices[k], feature.outwards[k]));
            if let Some(between) = &between {
                fan.push(self.offset_outwards(&between[k], DIAGONALS[k]));
            }
        }
        if between.is_none() {
            if let Some((i, v)) = self.fifth_corner(object, vertices)? {
                fan.insert(i, v);
            }
        }
        if self.is_point(fan.vertices.get(..fan.len).unwrap_or(&[])) {
            return Ok(false);
        }
        let drops = vertices.iter().chain(between.iter().flatten()).map(|v| v.z);
        let common_drop = COMMON_DROP_FACTOR * drops.fold(1.0, lesser);
        for v in fan.vertices.iter_mut().take(fan.len) {
            v.z -= common_drop;
        }
        Ok(fan.compute_areas() || fan.enclose_deepest_point(self.vertex_offset))
    }

    /// Returns a vertex moved by the vertex offset along unit `out`.
    #[inline(always)]
    fn offset_outwards(&self, v: &Vec3, out: Vec2) -> Vec3 {
        let distance = self.vertex_offset;
        Vec3::new(v.x + distance * out.x, v.y + distance * out.y, v.z)
    }

    /// Queries a fifth corner of a polytope, beyond a side of the four vertices. Returns its index among them and
    /// the corner, moved outwards.
    ///
    /// If two of the four are the same corner, the side is the longest one of the triangle; else it is the side
    /// beyond which the deepest point lies, if any. The direction is the normal of the plane of three corners,
    /// tilted outwards over that side.
    #[inline(always)]
    fn fifth_corner(
        &self,
        object: usize,
        vertices: &[Vec3; 4],
    ) -> Result<Option<(usize, Vec3)>, Fault> {
        let at = |i: usize| &vertices[i % 4];
        let lengths2 = [0, 1, 2, 3].map(|i| (at(i + 1) - at(i)).xy().norm_squared());
        let areas = [0, 1, 2, 3].map(|i| area2(at(i), at(i + 1)));
        let repeated = (0..4).find(|i| is_within(at(*i), at(i + 1), 2.0 * self.vertex_offset));
        let (side, opposite) = if let Some(repeated) = repeated {
            let side = (1..4).fold(0, |k, i| if lengths2[i] > lengths2[k] { i } else { k });
            let is_next = (side + 1) % 4 == repeated;
            (side, side + if is_next { 3 } else { 2 })
        } else {
            let side = (1..4).fold(0, |k, i| if areas[i] < areas[k] { i } else { k });
            if !(areas[side] < -NARROW_REL * areas.iter().sum::<f64>()) {
                return Ok(None);
            }
            (side, side + 2)
        };
        let [o, p, q] = [opposite, side, side + 1].map(at);
        let area = area2(&(p - o), &(q - o));
        let length = lengths2[side].sqrt();
        // Sides whose drop exceeds the depth are outside the overlap.
        let is_wide =
            area > NARROW_REL * lengths2[side] && area > 2.0 * self.vertex_offset * length;
        if !(is_wide && (p.z < 1.0 || q.z < 1.0)) {
            return Ok(None);
        }
        let gradient = drop_gradient([o, p, q]);
        let out = Vec2::new(q.y - p.y, p.x - q.x) / length;
        let v = self.query(object, gradient * self.depth + out * self.tilt)?;
        let is_beyond = out.dot(&offset(p, &v)) > 2.0 * self.vertex_offset;
        let is_in_plane = v.z <= o.z + gradient.dot(&offset(o, &v)) + FACE_DROP_TOL;
        Ok((is_beyond && is_in_plane).then(|| (side + 1, self.offset_outwards(&v, out))))
    }

    /// Returns the points midway between the four vertices on the rim of a disc; None if the vertices are not on
    /// such a rim. A disc returns its center plus the radius times the direction in its plane. (A square whose
    /// corners lie along the four tilt directions within 1e-4 rad is mistaken for a disc.)
    fn fit_disc_rim(&self, vertices: &[Vec3; 4]) -> Option<[Vec3; 4]> {
        let [a, b, c, d] = vertices;
        let gradient = drop_gradient([a, b, c]);
        let lean = gradient * self.depth;
        let scale = 1.0 / (1.0 + lean.norm_squared());
        // The direction in the leaning disc's plane that is farthest along the tilted normal: that normal without
        // its part along the axis of the disc.
        let outwards = |out: Vec2| {
            let tilt = out * self.tilt - lean;
            let down = lean.dot(&tilt) * scale;
            let in_plane = tilt - lean * down;
            in_plane / (in_plane.norm_squared() + down * down).sqrt()
        };
        let [first, second, third, fourth] = TILT_DIRECTIONS.map(outwards);
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
            error.xy().norm_squared() <= tolerance * tolerance && error.z.abs() <= FACE_DROP_TOL
        };
        // False for NaN.
        let is_rim = radius > 2.0 * self.vertex_offset
            && is_there(second, b)
            && is_there(third, c)
            && is_there(fourth, d);
        is_rim.then(|| DIAGONALS.map(|out| on_rim(outwards(out))))
    }
}

impl Feature {
    /// Makes a queried vertex the prediction of each direction not yet queried along which it is farther.
    #[inline(always)]
    fn improve_predictions(&mut self, v: &Vec3, scores: &[f64; 4], is_queried: &[bool; 4]) {
        for k in 0..4 {
            if !is_queried[k] && scores[k] > self.scores[k] {
                (self.scores[k], self.vertices[k], self.cover[k]) = (scores[k], *v, 0.0);
            }
        }
    }
}

impl Fan {
    /// Largest number of vertices: eight of a disc or five corners, two that enclose the deepest point, and the
    /// repeated first one.
    pub const CAPACITY: usize = 11;
    /// The fan without vertices.
    pub const EMPTY: Self = Self {
        vertices: [ZERO; Self::CAPACITY],
        areas: [0.0; Self::CAPACITY],
        len: 0,
    };

    /// Returns vertex `i` modulo the number of vertices.
    #[inline(always)]
    fn cyclic_vertex(&self, i: usize) -> Vec3 {
        self.vertices[(i % self.len.max(1)).min(Self::CAPACITY - 1)]
    }

    /// Appends a vertex; a full fan ignores it.
    #[inline(always)]
    pub fn push(&mut self, v: Vec3) {
        if self.len < Self::CAPACITY - 1 {
            self.vertices[self.len] = v;
            self.len += 1;
        }
    }

    /// Inserts a vertex at index `i`.
    fn insert(&mut self, i: usize, v: Vec3) {
        self.push(v);
        let mut moved = v;
        for vertex in self.vertices.iter_mut().take(self.len).skip(i) {
            core::mem::swap(vertex, &mut moved);
        }
    }

    /// Repeats the first vertex and computes the areas. Returns whether the deepest point is inside.
    #[inline(always)]
    pub fn compute_areas(&mut self) -> bool {
        let len = self.len.min(Self::CAPACITY - 1);
        self.vertices[len] = self.vertices[0];
        let mut least = f64::INFINITY;
        for i in 0..len {
            self.areas[i] = area2(&self.vertices[i], &self.vertices[i + 1]);
            least = lesser(self.areas[i], least);
        }
        least > 0.0
    }

    /// Makes a fan contain the deepest point that does not: reverses it if it is clockwise, and else extends it.
    /// Returns false if it is neither.
    ///
    /// The support vertices of the four tilted directions are counterclockwise around a face, but not always around
    /// an edge: the vertex along an axis may be high, in place of one farther along it and lower.
    #[cold]
    #[inline(never)]
    fn enclose_deepest_point(&mut self, distance: f64) -> bool {
        let reversed = |fan: &mut Self| {
            if let Some(vertices) = fan.vertices.get_mut(..fan.len) {
                vertices.reverse();
            }
            fan.compute_areas()
        };
        if reversed(self) {
            return true;
        }
        reversed(self);
        self.extend_to_deepest_point(distance)
    }

    /// Extends the fan to contain the deepest point, which is outside: removes the sides visible from it and adds a
    /// vertex at `distance` behind it. Returns false if the result does not contain it.
    fn extend_to_deepest_point(&mut self, distance: f64) -> bool {
        let n = self.len.clamp(1, Self::CAPACITY - 1);
        let is_visible = |i: usize| !(self.areas[(i % n).min(Self::CAPACITY - 1)] > 0.0);
        let first = (0..n).find(|i| !is_visible(*i) && is_visible(i + n - 1));
        let first = first.unwrap_or(0);
        let mut fan = Self::EMPTY;
        let kept = (0..n).find(|k| is_visible(first + k)).unwrap_or(n);
        for k in 0..=kept {
            fan.push(self.cyclic_vertex(first + k));
        }
        let (p, q) = (self.cyclic_vertex(first + kept), self.cyclic_vertex(first));
        // Opposite to the bisector of the directions to p and q, also if both are on one side.
        let [a, b] = [&p, &q].map(|v| 1.0 / (v.xy().norm_squared() + f64::MIN_POSITIVE).sqrt());
        let (x, y) = (q.y * b - p.y * a, p.x * a - q.x * b);
        let scale = distance / (x * x + y * y + f64::MIN_POSITIVE).sqrt();
        fan.push(Vec3::new(x * scale, y * scale, 0.0));
        fan.compute_areas();
        let min_area = MIN_AREA_REL * distance * distance;
        let mut is_inside = fan.len > 2;
        for area in fan.areas.iter_mut().take(fan.len) {
            // Never 0, because areas are divisors.
            is_inside &= *area > -min_area;
            *area = larger(*area, min_area);
        }
        *self = fan;
        is_inside
    }

    /// Mirrors the fan through the deepest point.
    pub fn mirror(&mut self) {
        for v in &mut self.vertices {
            (v.x, v.y) = (-v.x, -v.y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    /// Tests that an extended fan contains the deepest point, from a triangle to a sliver that points at it: all
    /// areas are positive.
    #[test]
    fn extended_fan_contains_the_deepest_point() {
        let mut r = Random::new(1);
        for round in 0..1000 {
            let width = 10.0_f64.powf(-r.within(0.0, 4.0));
            let corners = [
                (2.0, width),
                (1.0, -width),
                (3.0, -width * r.within(-0.4, 0.9)),
            ];
            let (sin, cos) = r.within(0.0, core::f64::consts::TAU).sin_cos();
            let mut fan = Fan::EMPTY;
            for (x, y) in [corners[0], corners[1], corners[2]] {
                let (x, y) = (x * cos - y * sin, x * sin + y * cos);
                fan.push(Vec3::new(x, y, 0.0));
            }
            assert!(!fan.compute_areas());
            assert!(fan.extend_to_deepest_point(1e-3));
            assert!(
                fan.areas[..fan.len]
                    .iter()
                    .all(|a| *a > MIN_AREA_REL * 1e-6),
                "{round} {fan:?}"
            );
        }
    }

    /// Tests the fan of an edge whose middle is higher than its ends, a clockwise one, and one without area.
    #[test]
    fn clockwise_fan_is_reversed() {
        let ends = [
            (0.17, 0.074),
            (0.06, 0.014),
            (-0.25, -0.061),
            (-0.05, -0.011),
        ];
        let mut fan = Fan::EMPTY;
        for (x, y) in ends {
            fan.push(Vec3::new(x, y, 0.0));
        }
        assert!(!fan.compute_areas() && fan.enclose_deepest_point(1e-3));
        let areas = &fan.areas[..fan.len];
        assert!(
            areas.len() == 4 && areas.iter().all(|a| *a > 0.0),
            "{fan:?}"
        );
        let mut point = Fan::EMPTY;
        (0..4).for_each(|_| point.push(Vec3::x()));
        assert!(!point.compute_areas() && !point.enclose_deepest_point(1e-3));
    }
}
