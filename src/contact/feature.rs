// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The feature of an object in a contact: the vertices that its surface has around the deepest point.
//!
//! Wanted are the support vertices of four tilted normals, a right angle apart: n + T (±e1), n + T (±e2).
//! Of a face they are the corners that reach farthest, of a round surface they are evenly around.
//!
//! 1. *Project* the known vertices of both objects into the contact frame, in one pass. obj2 is mirrored
//!    (−b for b), so that the normal leaves both objects, and all that follows serves either.
//! 2. *Predict* of the four the known vertex that is farthest along each.
//! 3. *Polytope*, where two known directions found one vertex: a prediction holds where a known direction
//!    that found the vertex is tilted that way by [`MIN_COVER`] T; the least covered is queried first. (A
//!    vertex is the support vertex of a convex set of directions, and the contact normal is mostly one.)
//!    Beside an edge (the four are two vertices) a face may be that no direction has found: both sides are
//!    queried, unless a known direction that found an end is tilted across it.
//! 4. *Round* otherwise: opposite tilts are queried. Where two vertices are symmetric about the deepest
//!    point, so is the contact. A query that returns its prediction shows a polytope.
//! 5. *Fan*: the four in their order around the deepest point, with a fifth corner of a polytope, or the
//!    points between them of a disc.
//!
//! One file, because each step reads the same projection; projection, prediction, queries and fan are its parts.
//! No reference is known to us; the figures are from `c-tests/tests/extension/pressure.c` and recorded contacts.

use crate::contact::frame::ContactFrame;
use crate::contact::polygon::{Vec2, way};
use crate::math::{EPSILON, Vec3, ZERO, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};
use crate::minkowski::vertex_set::VertexSet;

/// The known vertices that are looked at: the last of more.
pub const MAX_KNOWN: usize = 16;
/// T, as a tangent, is this times the root of depth / extent, so that a round surface of that radius, or of
/// half of it, is seen no lower than half the depth, and of a flat one that leans by a depth over its
/// width all corners. Measured: ÷1.2 a corner of a leaning box is missed, ×1.2 a cone on its side steps by
/// 7 mm.
const TILT: f64 = 1.8;
/// T at most: 14°, for what is deeper than a fiftieth of its extent.
const MAX_TILT: f64 = 0.25;
/// The share of T that a known direction must be tilted by to find what T would. Measured: 0.4 errs by
/// 7.5 mm rms where 0.6 errs by 1.8.
const MIN_COVER: f64 = 0.6;
/// The cosine between the normal and a known direction that tells of a feature: others look at the object from
/// the side or from behind.
const MIN_COSINE: f64 = 0.1;
/// Largest sum of two opposite vertices that count as symmetric, as a share of the extent.
const SYMMETRY_REL_TOL: f64 = 0.004;
/// A feature that ends within this share of the extent is a point: the center of pressure is within a
/// quarter of that.
const POINT_REL: f64 = 0.016;
/// Vertices closer than this share of the extent are one.
const SAME_REL: f64 = 1e-7;
/// Largest distance of a fourth corner of the same face below the plane of three, in depths. Beyond it the
/// surface between is not as low as a line to the corner. Insensitive: 0.1 to 1 tried.
const SAME_FACE: f64 = 0.1;
/// The deepest point is beyond a side, and three corners are no line, by this share. Insensitive: 0.005 to
/// 0.08 tried.
const NARROW_REL: f64 = 0.02;
/// Largest distance of a rim's point from the rim, as a share of the radius: ten times the rounding of
/// callbacks in single precision.
const RIM_REL_TOL: f64 = if EPSILON < 1e-10 { 1e-4 } else { 1e-3 };
/// The part of what all vertices are lower by that is taken off: a round surface of radius R is lower by
/// R T²/2 all around. Measured: 0 lets a lying capsule step by 5 mm; 1, right for spheres, leaves it 7 mm off.
const LEVEL: f64 = 0.75;
/// Distance by which vertices are moved outwards, in depths, so that an edge has an area and the deepest
/// point is inside. Small beside the flank of an edge.
const MARGIN: f64 = 1.0 / 512.0;
/// Twice the area of a triangle that has none, as a share of the square of the margin.
const MIN_AREA_REL: f64 = f64::EPSILON;

/// The four tilts: the way of each, along the axes.
const WAYS: [Vec2; 4] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(0.0, 1.0),
    Vec2::new(-1.0, 0.0),
    Vec2::new(0.0, -1.0),
];
const H: f64 = core::f64::consts::FRAC_1_SQRT_2;
/// The ways between them.
const DIAGONALS: [Vec2; 4] = [
    Vec2::new(H, H),
    Vec2::new(-H, H),
    Vec2::new(-H, -H),
    Vec2::new(H, -H),
];

/// Returns whether two vertices are no farther apart than `distance` along either axis.
#[inline(always)]
fn is_within(a: &Vec3, b: &Vec3, distance: f64) -> bool {
    (a.x - b.x).abs() <= distance && (a.y - b.y).abs() <= distance
}

/// Returns twice the area of the triangle of the deepest point and two vertices, positive counterclockwise.
#[inline(always)]
pub fn area2(a: &Vec3, b: &Vec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Four vertices of an object around the deepest point, counterclockwise: the support vertices of the tilted
/// normals, predicted or queried, or those about an edge.
struct Feature {
    vertices: [Vec3; 4],
    /// The way outwards of each, unit.
    ways: [Vec2; 4],
    /// Position of each along its tilted normal, over T.
    scores: [f64; 4],
    /// Tilt, towards that way, of a known direction that found the vertex.
    cover: [f64; 4],
    /// They are vertices of a polytope: two known directions found the same one. Else each tilt found another
    /// vertex.
    is_polytope: bool,
}

/// The vertices of a feature, counterclockwise around the deepest point.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// `vertices[len]` is the first one again.
    pub vertices: [Vec3; Fan::CAPACITY],
    /// Twice the area of the triangle of the deepest point, each vertex and the next one.
    pub areas: [f64; Fan::CAPACITY],
    pub len: usize,
}

/// Returns how much lower the plane of three vertices is a metre along each axis, in depths.
#[inline(always)]
fn slope_of([a, b, c]: [&Vec3; 3]) -> Vec2 {
    let across = (b - a).cross(&(c - a));
    across.xy() / -across.z
}

/// The vertices of both objects around the deepest point of a contact: known ones and queries.
pub struct FeatureQuery<'q, A, B, const N: usize> {
    md: &'q MinkowskiDifference<A, B>,
    set: &'q VertexSet<N>,
    pub frame: ContactFrame,
    /// x, y and low of each known vertex; low in depths.
    known: &'q [[[f64; 2]; 3]],
    /// The index in the set of the first of them.
    first: usize,
    /// x and y of the center of each object; that of the witness points where none is known.
    centers: [[f64; 2]; 2],
    /// The object that is known to reach less far from the contact, 0 or 1.
    pub smaller: usize,
    /// Length of that extent, metres.
    extent: f64,
    /// The unit of lows, metres.
    pub depth: f64,
    /// Distance of the support planes from the frame's origin, metres.
    half: f64,
    /// T, a tangent.
    tilt: f64,
    /// Depth over T, metres.
    fall: f64,
    /// Distance by which vertices are moved outwards, metres.
    pub margin: f64,
}

impl<'q, A: SupportMap, B: SupportMap, const N: usize> FeatureQuery<'q, A, B, N> {
    /// Projects the known vertices, to `known`. The frame's origin is half-way between the support planes, which are
    /// `gap` apart; `depth`: that, or the tolerance where it is larger.
    #[inline(always)]
    pub fn new(
        md: &'q MinkowskiDifference<A, B>,
        set: &'q VertexSet<N>,
        known: &'q mut [[[f64; 2]; 3]; MAX_KNOWN],
        frame: ContactFrame,
        centers: Option<[Vec3; 2]>,
        [gap, depth]: [f64; 2],
    ) -> Self {
        let (half, share) = (0.5 * gap, 1.0 / depth);
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
                projected[2][k] = larger((half - height) * share, 0.0);
            }
            projected
        };
        let first = set.len().saturating_sub(MAX_KNOWN);
        let len = set.len() - first;
        for (i, projected) in known.iter_mut().enumerate().take(len) {
            *projected = project(set.coords(first + i));
        }
        let [c1, c2] = centers.unwrap_or([o; 2]);
        let [x, y, _] = project([[c1.x, -c2.x], [c1.y, -c2.y], [c1.z, -c2.z]]);
        let smaller = usize::from(far2[1] < far2[0]);
        let extent = far2[smaller].sqrt();
        let tilt = lesser(TILT * (depth / extent).sqrt(), MAX_TILT);
        Self {
            md,
            set,
            frame,
            known: known.get(..len).unwrap_or(&[]),
            first,
            centers: [x, y],
            smaller,
            extent,
            depth,
            half,
            tilt,
            fall: depth / tilt,
            margin: larger(depth * MARGIN, 64.0 * EPSILON * extent),
        }
    }

    /// Returns the known vertices of an object.
    #[inline(always)]
    pub fn known(&self, object: usize) -> impl Iterator<Item = Vec3> + '_ {
        let k = object % 2;
        self.known
            .iter()
            .map(move |[x, y, low]| Vec3::new(x[k], y[k], low[k]))
    }

    /// Queries an object along the normal with a tilt, as tangents.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(always)]
    fn query(&self, object: usize, tilt: Vec2) -> Result<Vec3, Fault> {
        let dir = self.frame.tilted_direction(1.0, tilt);
        let side = if object == 0 { 1.0 } else { -1.0 };
        let p = self
            .frame
            .project(&self.md.support_of_object(object, &dir))?
            * side;
        let low = larger((self.half - p.z) / self.depth, 0.0);
        Ok(Vec3::new(p.x, p.y, low))
    }

    /// Returns how far a vertex is along each of the tilted normals, over T.
    #[inline(always)]
    fn scores(&self, v: &Vec3) -> [f64; 4] {
        let low = v.z * self.fall;
        [v.x - low, v.y - low, -v.x - low, -v.y - low]
    }

    /// Returns the distance below which two vertices are one, metres.
    #[inline(always)]
    fn same(&self) -> f64 {
        SAME_REL * self.extent
    }

    /// Predicts the support vertices of the tilted normals.
    #[inline(always)]
    fn predict(&self, object: usize) -> Feature {
        let mut found = Feature {
            vertices: [Vec3::zeros(); 4],
            ways: WAYS,
            scores: [f64::NEG_INFINITY; 4],
            cover: [0.0; 4],
            is_polytope: false,
        };
        let mut is_found = [false; 4];
        let [e1, e2] = &self.frame.axes;
        let same = self.same();
        for (i, v) in self.known(object).enumerate() {
            let scores = self.scores(&v);
            let dir = self.set.dir(self.first + i);
            let is_facing = self.frame.normal.dot(&dir) > MIN_COSINE;
            let (x, y) = (e1.dot(&dir), e2.dot(&dir));
            for (k, tilt) in [x, y, -x, -y].into_iter().enumerate() {
                let gain = scores[k] - found.scores[k];
                if gain > same {
                    (found.scores[k], found.vertices[k]) = (scores[k], v);
                    (is_found[k], found.cover[k]) = (is_facing, 0.0);
                    if is_facing {
                        found.cover[k] = tilt;
                    }
                } else if gain >= -same && is_facing && is_within(&v, &found.vertices[k], same) {
                    found.is_polytope |= is_found[k];
                    is_found[k] = true;
                    found.cover[k] = larger(tilt, found.cover[k]);
                }
            }
        }
        found
    }

    /// Finds the feature of an object; None where opposite vertices are symmetric about the deepest point. `towards`:
    /// the way that is queried first of what may be round.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    fn find(&self, object: usize, towards: Vec2) -> Result<Option<Feature>, Fault> {
        let mut found = self.predict(object);
        let mut is_queried = [false; 4];
        let mut next = usize::from(towards.y.abs() > towards.x.abs());
        let (mut hits, mut misses) = (0, 0);
        // Each turn queries another one of the four.
        for _ in 0..4 {
            if found.is_polytope {
                let cover = &found.cover;
                next = (1..4).fold(0, |k, i| if cover[i] < cover[k] { i } else { k });
                if !(cover[next] < MIN_COVER * self.tilt) {
                    break;
                }
            }
            let v = self.query(object, WAYS[next % 4] * self.tilt)?;
            if is_within(&v, &found.vertices[next % 4], self.same()) {
                (found.is_polytope, hits) = (true, hits + 1);
            } else {
                misses += 1;
                // Directions that share a plane with the axis of a disc find one point of its rim.
                found.is_polytope &= hits > 0 || misses < 2;
            }
            is_queried[next % 4] = true;
            if found.is_polytope {
                found.consider(&v, &self.scores(&v), &is_queried);
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
            self.confirm(object, &mut found)?;
        }
        Ok(Some(found))
    }

    /// Looks beside a feature that is one vertex or an edge, where a face may be that no direction has found:
    /// queries across it, unless a known direction that found one of its vertices is tilted so.
    #[inline(always)]
    fn confirm(&self, object: usize, feature: &mut Feature) -> Result<(), Fault> {
        let [a, rest @ ..] = feature.vertices;
        let is_same = |p: &Vec3, q: &Vec3| is_within(p, q, self.same());
        let Some(&b) = rest.iter().find(|v| !is_same(v, &a)) else {
            return Ok(());
        };
        if !rest.iter().all(|v| is_same(v, &a) || is_same(v, &b)) {
            return Ok(());
        }
        let along = way(&a, &b) / way(&a, &b).norm();
        let left = Vec2::new(-along.y, along.x);
        feature.vertices = [a, a, b, b];
        feature.ways = [-along, -left, along, left];
        let [_, vertex1, _, vertex3] = &mut feature.vertices;
        for (vertex, out) in [(vertex1, -left), (vertex3, left)] {
            let is_covered = self.known(object).enumerate().any(|(i, p)| {
                let dir = self.set.dir(self.first + i);
                let cosine = self.frame.normal.dot(&dir);
                let tilt = Vec2::from(self.frame.axes.map(|e| e.dot(&dir) / cosine));
                let is_across =
                    tilt.dot(&out) - 2.0 * tilt.perp(&out).abs() >= MIN_COVER * self.tilt;
                cosine > MIN_COSINE && is_across && (is_same(&p, &a) || is_same(&p, &b))
            });
            if !is_covered {
                let p = self.query(object, out * self.tilt)?;
                if out.dot(&way(&a, &p)) > 2.0 * self.margin {
                    *vertex = p;
                }
            }
        }
        Ok(())
    }

    /// Returns the way from the deepest point to the center of an object.
    #[inline(always)]
    pub fn towards_center(&self, object: usize) -> Vec2 {
        self.centers.map(|xy| xy[object % 2]).into()
    }

    /// Returns whether two vertices are symmetric about the deepest point.
    fn is_symmetric(&self, a: &Vec3, b: &Vec3) -> bool {
        let most = SYMMETRY_REL_TOL * self.extent;
        (a + b).xy().norm_squared() < most * most && (a.z - b.z).abs() < SAME_FACE
    }

    fn is_point(&self, vertices: &[Vec3]) -> bool {
        vertices.iter().all(|v| {
            let most = POINT_REL * self.extent * larger(v.z, 1.0);
            v.xy().norm_squared() <= most * most
        })
    }

    /// Makes the fan of an object. `towards`: the way that is queried first of what may be round. Returns false
    /// where the deepest point is the center of pressure: the object is symmetric about it, or ends close to it as far
    /// as the depth goes.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn fan(&self, object: usize, towards: Vec2, fan: &mut Fan) -> Result<bool, Fault> {
        let Some(feature) = self.find(object, towards)? else {
            return Ok(false);
        };
        let vertices = &feature.vertices;
        let is_round = !feature.is_polytope;
        let between = is_round.then(|| self.rim(vertices)).flatten();
        fan.len = 0;
        for k in 0..4 {
            fan.push(self.moved(&vertices[k], feature.ways[k]));
            if let Some(between) = &between {
                fan.push(self.moved(&between[k], DIAGONALS[k]));
            }
        }
        if between.is_none() {
            if let Some((i, v)) = self.fifth(object, vertices)? {
                fan.insert(i, v);
            }
        }
        if self.is_point(fan.vertices.get(..fan.len).unwrap_or(&[])) {
            return Ok(false);
        }
        let lows = vertices.iter().chain(between.iter().flatten()).map(|v| v.z);
        let level = LEVEL * lows.fold(1.0, lesser);
        for v in fan.vertices.iter_mut().take(fan.len) {
            v.z -= level;
        }
        if !fan.close() {
            fan.enclose(self.margin);
        }
        Ok(true)
    }

    /// Returns a vertex moved outwards by the margin.
    #[inline(always)]
    fn moved(&self, v: &Vec3, way: Vec2) -> Vec3 {
        Vec3::new(v.x + self.margin * way.x, v.y + self.margin * way.y, v.z)
    }

    /// Returns the corner that a polytope has beyond a side of the four, moved outwards, and its place
    /// among them.
    ///
    /// Queries a fifth vertex: beyond the longest side of a triangle, where two tilts found one corner; or beyond
    /// the side that has the deepest point outside. The direction is the normal of the plane of three corners,
    /// tilted across that side.
    #[inline(always)]
    fn fifth(&self, object: usize, vertices: &[Vec3; 4]) -> Result<Option<(usize, Vec3)>, Fault> {
        let at = |i: usize| &vertices[i % 4];
        let lengths2 = [0, 1, 2, 3].map(|i| (at(i + 1) - at(i)).xy().norm_squared());
        let areas = [0, 1, 2, 3].map(|i| area2(at(i), at(i + 1)));
        let twice = (0..4).find(|i| is_within(at(*i), at(i + 1), 2.0 * self.margin));
        let (side, opposite) = if let Some(twice) = twice {
            let side = (1..4).fold(0, |k, i| if lengths2[i] > lengths2[k] { i } else { k });
            let is_next = (side + 1) % 4 == twice;
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
        // Beyond a side that is all too low nothing is shared.
        let is_wide = area > NARROW_REL * lengths2[side] && area > 2.0 * self.margin * length;
        if !(is_wide && (p.z < 1.0 || q.z < 1.0)) {
            return Ok(None);
        }
        let slope = slope_of([o, p, q]);
        let out = Vec2::new(q.y - p.y, p.x - q.x) / length;
        let v = self.query(object, slope * self.depth + out * self.tilt)?;
        let is_beyond = out.dot(&way(p, &v)) > 2.0 * self.margin;
        let is_in_plane = v.z <= o.z + slope.dot(&way(o, &v)) + SAME_FACE;
        Ok((is_beyond && is_in_plane).then(|| (side + 1, self.moved(&v, out))))
    }

    /// Returns the points between four vertices, where these are on the rim of a disc. A disc returns, for a
    /// direction, its middle and the radius that way; so may corners of a square, where it lies as the ways do
    /// to a ten thousandth of a radian.
    fn rim(&self, vertices: &[Vec3; 4]) -> Option<[Vec3; 4]> {
        let [a, b, c, d] = vertices;
        let slope = slope_of([a, b, c]);
        let lean = slope * self.depth;
        let share = 1.0 / (1.0 + lean.norm_squared());
        // The way in which a disc that leans so reaches farthest: the tilted normal without its part along the
        // axis of the disc.
        let outwards = |way: Vec2| {
            let tilt = way * self.tilt - lean;
            let down = lean.dot(&tilt) * share;
            let across = tilt - lean * down;
            across / (across.norm_squared() + down * down).sqrt()
        };
        let [first, second, third, fourth] = WAYS.map(outwards);
        let (whole, chord) = (first - third, way(c, a));
        let whole2 = whole.norm_squared();
        // Other faces' corners mostly lie in other directions.
        let cross = whole.perp(&chord);
        if !(cross * cross <= RIM_REL_TOL * whole2 * chord.norm_squared()) {
            return None;
        }
        let radius = whole.dot(&chord) / whole2;
        let on_rim = |out: Vec2| {
            let from_a = (out - first) * radius;
            a + Vec3::new(from_a.x, from_a.y, slope.dot(&from_a))
        };
        let is_there = |way, found: &Vec3| {
            let off = on_rim(way) - found;
            let most = RIM_REL_TOL * radius;
            off.xy().norm_squared() <= most * most && off.z.abs() <= SAME_FACE
        };
        // False for NaN.
        let is_rim = radius > 2.0 * self.margin
            && is_there(second, b)
            && is_there(third, c)
            && is_there(fourth, d);
        is_rim.then(|| DIAGONALS.map(|way| on_rim(outwards(way))))
    }
}

impl Feature {
    /// Takes a queried vertex for the prediction of the other tilts that it is farther along.
    #[inline(always)]
    fn consider(&mut self, v: &Vec3, scores: &[f64; 4], is_queried: &[bool; 4]) {
        for k in 0..4 {
            if !is_queried[k] && scores[k] > self.scores[k] {
                (self.scores[k], self.vertices[k], self.cover[k]) = (scores[k], *v, 0.0);
            }
        }
    }
}

impl Fan {
    /// Eight of a disc, or five corners, and the two that enclose the deepest point; the first one again.
    pub const CAPACITY: usize = 11;
    pub const EMPTY: Self = Self {
        vertices: [ZERO; Self::CAPACITY],
        areas: [0.0; Self::CAPACITY],
        len: 0,
    };

    /// Returns the vertex with an index that counts on from the first.
    #[inline(always)]
    fn around(&self, i: usize) -> Vec3 {
        self.vertices[(i % self.len.max(1)).min(Self::CAPACITY - 1)]
    }

    #[inline(always)]
    pub fn push(&mut self, v: Vec3) {
        if self.len < Self::CAPACITY - 1 {
            self.vertices[self.len] = v;
            self.len += 1;
        }
    }

    fn insert(&mut self, i: usize, v: Vec3) {
        self.push(v);
        let mut moved = v;
        for place in self.vertices.iter_mut().take(self.len).skip(i) {
            core::mem::swap(place, &mut moved);
        }
    }

    /// Closes the fan. Returns whether the deepest point is within.
    #[inline(always)]
    pub fn close(&mut self) -> bool {
        let len = self.len.min(Self::CAPACITY - 1);
        self.vertices[len] = self.vertices[0];
        let mut least = f64::INFINITY;
        for i in 0..len {
            self.areas[i] = area2(&self.vertices[i], &self.vertices[i + 1]);
            least = lesser(self.areas[i], least);
        }
        least > 0.0
    }

    /// Takes the deepest point, which is outside, in: the sides that it is beyond go, and a vertex `margin`
    /// behind it comes in their place.
    #[cold]
    #[inline(never)]
    fn enclose(&mut self, margin: f64) {
        let n = self.len.clamp(1, Self::CAPACITY - 1);
        let is_seen = |i: usize| !(self.areas[(i % n).min(Self::CAPACITY - 1)] > 0.0);
        let first = (0..n).find(|i| !is_seen(*i) && is_seen(i + n - 1));
        let first = first.unwrap_or(0);
        let mut fan = Self::EMPTY;
        let kept = (0..n).find(|k| is_seen(first + k)).unwrap_or(n);
        for k in 0..=kept {
            fan.push(self.around(first + k));
        }
        let (p, q) = (self.around(first + kept), self.around(first));
        // Across the bisector of the two, so that it is beyond the deepest point also where both are on one side.
        let [a, b] = [&p, &q].map(|v| 1.0 / (v.xy().norm_squared() + f64::MIN_POSITIVE).sqrt());
        let (x, y) = (q.y * b - p.y * a, p.x * a - q.x * b);
        let share = margin / (x * x + y * y + f64::MIN_POSITIVE).sqrt();
        fan.push(Vec3::new(x * share, y * share, 0.0));
        fan.close();
        let min_area = MIN_AREA_REL * margin * margin;
        for area in fan.areas.iter_mut().take(fan.len) {
            // Never 0: areas are divisors.
            *area = larger(*area, min_area);
        }
        *self = fan;
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

    /// A fan beside the deepest point, from a triangle to a sliver that points at it, contains that point
    /// afterwards: no triangle is turned over.
    #[test]
    fn an_enclosed_fan_contains_the_deepest_point() {
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
            assert!(!fan.close());
            fan.enclose(1e-3);
            assert!(
                fan.areas[..fan.len]
                    .iter()
                    .all(|a| *a > MIN_AREA_REL * 1e-6),
                "{round} {fan:?}"
            );
        }
    }
}
