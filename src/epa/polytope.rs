// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The polytope of EPA: triangles with homogeneous planes, half-edges, insertion of points. It makes no support
//! calls.
//!
//! # Insertion by interpolation
//!
//! A new point p replaces the *visible* faces, whose planes it is above, by a fan over their *horizon*. A
//! horizon edge is between a visible face F, above whose plane the height of p is f > 0, and a hidden face G, for which
//! the height of p is g <= 0. Every plane through the edge is a combination of the two, and the one through p is
//!
//!   F′ = F + w (G − F),   w = f / (f − g):   f + w (g − f) = 0.
//!
//! (The double description of a polytope: Motzkin and others, 1953; Fukuda and Prodon, 1996.) It takes one
//! division, no coordinates of corners, no cross product and no root. Since 0 < w <= 1, errors are averaged,
//! not amplified, and the plane of a sliver lies between two well-conditioned ones. A point below both F and G is
//! below F′:
//!
//! - the *interior point*, the middle of the first tetrahedron, stays below every plane, by the least
//!   *interior clearance* of the planes that were computed from corners, and
//! - an origin below every plane (d > 0) stays there.
//!
//! If p is above G by less than the height at which points count as above a face, g is set to 0 (w = 1): the new face
//! has G's plane.
//!
//! # The bound
//!
//! *Invariant*: the corners v of a face have N·v >= d, within [`EpaPolytope::error`]. So the distance of its triangle
//! from the origin is at least d / |N|. The closed surface winds around the interior point once: it did as
//! a tetrahedron, and as long as that point is below every plane no triangle reaches it. If all d > 0, no
//! triangle meets the segment from it to the origin either, because both ends are below the plane and the
//! corners are not; so the surface winds around the origin once, and around every point closer to it than the closest
//! triangle. That ball is in the hull of the corners. The surface need not be convex for this: convexity
//! decides how fast the bound grows. If the interior clearance is less than the error
//! ([`EpaPolytope::encloses_interior_point`]), nothing is proven.
//!
//! # Repairs, all under that invariant
//!
//! - *Cancelled normals.* Between nearly opposite normals |N′| is nearly 0. The plane is then computed from
//!   its corners ([`EpaPolytope::recompute_plane`]). Since it has none of the inherited properties, it is used only if
//!   the interior point is below it, and d > 0 if that holds for F′. Otherwise F′ is normalised, which scales the
//!   error; or, if F′ is mostly rounding, the new face has F's plane, which its corners are on or above.
//! - *The horizon is not a single closed loop*, because of rounding, or has more edges than the last buffers have free faces.
//!   The insertion is reverted, and repeated with fewer visible faces ([`EpaPolytope::insert`]). With only the first face the
//!   horizon is always its three edges.
//!
//! # Layout
//!
//! A struct of arrays: one sweep over the keys finds the closest face, without a heap. A half-edge has the index
//! 4 · face + edge ([`half_edge`]); edge i leads from corner i to corner i + 1, counterclockwise seen from outside. Free faces have
//! the key +∞ and form a linked list.

use crate::geometry::plane::{MIN_EXTENT_ULPS, PLANE_ERROR_ULPS, Plane, Tetrahedron};
use crate::math::{Vec3, index_below, larger, lesser, normal};
use crate::minkowski::vertex_set::{PAIR_BITS, Vertex, VertexPair, VertexSet};

/// The mark of the bottom of the stack of half-edges in [`EpaPolytope::walk_visible`].
const STACK_BOTTOM: u16 = u16::MAX;
/// The edges of a face of a fan: on the horizon, from its end to the new point, and from there to its start.
const HORIZON: usize = 0;
const TO_APEX: usize = 1;
const FROM_APEX: usize = 2;
/// The steps to the next and the previous half-edge of a face, for each edge.
const NEXT: [i8; 4] = [1, 1, -2, 0];
const PREVIOUS: [i8; 4] = [2, -1, -1, 0];
/// The largest number of faces: the low bits of a key hold the index of its face.
pub const MAX_FACES: usize = 4096;
const FACE_MASK: u64 = MAX_FACES as u64 - 1;
/// An upper bound of the relative error of a key that is caused by the index bits. It affects the order of the faces,
/// not their planes.
const KEY_ERROR_REL: f64 = MAX_FACES as f64 * f64::EPSILON;
/// The |N|² below which an interpolated plane has lost a decimal digit and is computed from its corners: above it the
/// error is at most ten times that of the two parents. Below its square, another digit, the plane is not usable.
const MIN_N2: f64 = 0.01;
/// The error that an insertion adds, in ulps of the size. Derived: two products and their sum round to 2 ulps of the
/// size, which is ten times as much for the least |N|.
const INSERTION_ERROR_ULPS: f64 = 20.0;

/// Returns the half-edge at this edge of a face.
#[inline(always)]
const fn half_edge(face: usize, edge: usize) -> usize {
    4 * face + edge
}

/// Returns the face of a half-edge.
#[inline(always)]
const fn face_of(half_edge: usize) -> usize {
    half_edge >> 2
}

/// Returns the edge of its face at which a half-edge is.
#[inline(always)]
const fn edge_of(half_edge: usize) -> usize {
    half_edge & 3
}

/// A polytope with room for `F` faces.
#[repr(C)]
pub struct EpaPolytope<const F: usize> {
    planes: [[f64; 4]; F],
    /// An ulp of the size of D, metres. Here in the middle of the arrays: codegen, see README.
    ulp: f64,
    /// The key of each face: its signed squared distance d|d| / |N|², with the index of the face in the low bits.
    keys: [f64; F],
    /// The half-edge on the other side of each of the three edges. The fourth slot is used during an insertion, by
    /// [`EpaPolytope::replaced_mut`] for a new face and by [`EpaPolytope::below_mut`] for a visible one.
    twins: [[u16; 4]; F],
    /// The corners 0, 1 and 2 of each face, [`PAIR_BITS`] each, from the low bits on.
    corners: [u64; F],
    /// Two lists: the next free face for a free face, [`EpaPolytope::next_free`]; the next visible face for a visible one,
    /// [`EpaPolytope::next_visible`]. After an insertion the second list is the head of the first.
    next: [u16; F],
    /// The first free face.
    free: usize,
    /// All faces that were ever used have indices below this.
    used: usize,
    /// The number of points that were inserted, hidden ones included.
    num_corners: usize,
    interior: Vec3,
    /// A lower bound of d − N·interior for all faces, metres.
    interior_clearance: f64,
    /// The error of the distance of a plane, metres.
    error: f64,
    /// The |N|² below which planes are computed from their corners.
    min_n2: f64,
    /// [`KEY_ERROR_REL`], or 0 if planes are exact: the tolerance is finer than the error of keys.
    key_error: f64,
}

/// The closest face and its signed squared distance, m².
#[derive(Clone, Copy, Debug)]
pub struct ClosestFace {
    /// The index of the face.
    pub face: usize,
    /// Its key, d|d| / |N|² with a relative error of at most [`KEY_ERROR_REL`].
    pub key: f64,
}

impl<const F: usize> EpaPolytope<F> {
    /// A polytope without faces, to be filled by [`EpaPolytope::start`]. All bytes are zero: codegen, see README.
    pub const BLANK: Self = Self {
        planes: [[0.0; 4]; F],
        ulp: 0.0,
        keys: [0.0; F],
        twins: [[0; 4]; F],
        corners: [0; F],
        next: [0; F],
        free: 0,
        used: 0,
        num_corners: 0,
        interior: Vec3::new(0.0, 0.0, 0.0),
        interior_clearance: 0.0,
        error: 0.0,
        min_n2: 0.0,
        key_error: 0.0,
    };

    /// Returns a blank polytope whose `ulp`, that of this size in metres, is not zero: codegen, see README.
    #[inline(always)]
    pub fn blank(size: f64) -> Self {
        let mut blank = Self::BLANK;
        blank.ulp = f64::EPSILON * size;
        blank
    }

    #[inline(always)]
    fn in_range(i: usize) -> usize {
        const { assert!(F % 16 == 0 && F >= 16 && F <= MAX_FACES) };
        index_below(F, i)
    }

    #[inline(always)]
    fn plane(&self, f: usize) -> Plane {
        Plane::of(&self.planes[Self::in_range(f)])
    }

    #[inline(always)]
    fn twin(&self, h: usize) -> usize {
        usize::from(self.twins.as_flattened()[index_below(4 * F, h)])
    }

    #[inline(always)]
    fn set_twin(&mut self, h: usize, twin: usize) {
        self.twins.as_flattened_mut()[index_below(4 * F, h)] = twin as u16;
    }

    /// Returns the half-edge that edge 0 of a new face replaces, for [`EpaPolytope::revert`].
    #[inline(always)]
    fn replaced_mut(&mut self, new: usize) -> &mut u16 {
        &mut self.twins[Self::in_range(new)][3]
    }

    /// Returns the half-edge below that of a visible face on the stack of [`EpaPolytope::walk_visible`].
    #[inline(always)]
    fn below_mut(&mut self, visible: usize) -> &mut u16 {
        &mut self.twins[Self::in_range(visible)][3]
    }

    #[inline(always)]
    fn next_free(&self, free: usize) -> usize {
        usize::from(self.next[Self::in_range(free)])
    }

    #[inline(always)]
    fn next_visible(&self, visible: usize) -> usize {
        usize::from(self.next[Self::in_range(visible)])
    }

    #[inline(always)]
    fn set_next(&mut self, f: usize, next: usize) {
        self.next[Self::in_range(f)] = next as u16;
    }

    #[inline(always)]
    fn step(h: usize, by: &[i8; 4]) -> usize {
        h.wrapping_add_signed(isize::from(by[edge_of(h)]))
    }

    /// Returns the corners of a face.
    #[inline(always)]
    pub fn corners(&self, f: usize) -> [VertexPair; 3] {
        let corners = self.corners[Self::in_range(f)];
        [0, 1, 2].map(|i| VertexPair::from_bits(corners >> (PAIR_BITS * i)))
    }

    /// Returns the corners of a face with their coordinates. `interior`: the interior point of the query.
    #[inline(always)]
    pub fn face<const N: usize>(
        &self,
        set: &VertexSet<N>,
        interior: &Vec3,
        f: usize,
    ) -> [Vertex; 3] {
        self.corners(f).map(|pair| set.vertex(pair, interior))
    }

    /// Returns N of a face: outward, and at most 1 long, within rounding.
    #[inline(always)]
    pub fn normal(&self, f: usize) -> Vec3 {
        self.plane(f).normal()
    }

    /// Returns d of a face, which belongs to its [`EpaPolytope::normal`].
    #[inline(always)]
    pub fn offset(&self, f: usize) -> f64 {
        self.plane(f).offset()
    }

    /// Returns the error of the distance of a plane, metres.
    #[inline(always)]
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Scales the error to the size of D, metres, if that has grown.
    #[inline(always)]
    pub fn set_size(&mut self, size: f64) {
        let ulp = f64::EPSILON * size;
        if ulp > self.ulp {
            self.error *= ulp / self.ulp;
            self.ulp = ulp;
        }
    }

    /// Iterates over the faces.
    pub fn faces(&self) -> impl Iterator<Item = usize> + '_ {
        let keys = self.keys.iter().take(self.used).enumerate();
        keys.filter(|(_, key)| **key < f64::INFINITY)
            .map(|(f, _)| f)
    }

    /// Returns whether there is room for more than `count` corners: a closed surface of C corners has 2 C − 4 faces, and an
    /// insertion makes a few new faces before it frees the old ones. Corners that have become hidden count too.
    #[inline(always)]
    pub fn has_room(&self, count: usize) -> bool {
        self.num_corners + count < F / 2
    }

    #[inline(always)]
    fn key(f: usize, square: f64) -> f64 {
        // Faces in use have finite keys.
        let finite = if square < f64::MAX { square } else { f64::MAX };
        f64::from_bits(finite.to_bits() & !FACE_MASK | f as u64)
    }

    /// Makes the polytope a tetrahedron. Returns whether its volume is above the rounding of points of this size, metres;
    /// otherwise the polytope is unchanged. `is_exact`: true if all planes are to be computed from their corners, for
    /// tolerances that are too small for interpolated planes.
    #[inline(always)]
    pub fn start(&mut self, corners: &[Vertex; 4], size: f64, is_exact: bool) -> bool {
        let points = corners.each_ref().map(|v| v.w);
        let Some(tetrahedron) = Tetrahedron::new(points, f64::EPSILON * size) else {
            return false;
        };
        let [o, mut a, mut b, c] = corners.each_ref().map(|v| v.pair);
        if tetrahedron.is_flipped {
            (a, b) = (b, a);
        }
        let corners = [[o, b, a], [o, a, c], [a, b, c], [b, o, c]];
        let twins = [[12, 8, 4, 0], [2, 10, 13, 0], [1, 14, 5, 0], [0, 6, 9, 0]];
        self.clear();
        for (f, plane) in tetrahedron.planes.iter().enumerate() {
            let d = plane.offset();
            self.planes[f] = plane.array();
            self.keys[f] = Self::key(f, d * d.abs());
            let [i, j, k] = corners[f].map(VertexPair::to_bits);
            self.corners[f] = i | j << PAIR_BITS | k << (2 * PAIR_BITS);
            self.twins[f] = twins[f];
        }
        (self.used, self.free, self.num_corners) = (4, 4, 4);
        self.interior = tetrahedron.middle;
        self.interior_clearance = tetrahedron.interior_clearance;
        self.error = tetrahedron.error;
        self.ulp = tetrahedron.error / PLANE_ERROR_ULPS;
        (self.min_n2, self.key_error) = if is_exact {
            (f64::INFINITY, 0.0)
        } else {
            (MIN_N2, KEY_ERROR_REL)
        };
        true
    }

    /// Returns whether there is no polytope.
    pub fn is_blank(&self) -> bool {
        self.used == 0
    }

    /// Copies a polytope with less room. Its list of free faces ends with the index after its last face, so that it
    /// continues with the added ones.
    pub fn copy_from<const M: usize>(&mut self, other: &EpaPolytope<M>) {
        const { assert!(M <= F) };
        self.clear();
        self.planes[..M].copy_from_slice(&other.planes);
        self.keys[..M].copy_from_slice(&other.keys);
        self.twins[..M].copy_from_slice(&other.twins);
        self.corners[..M].copy_from_slice(&other.corners);
        self.next[..M].copy_from_slice(&other.next);
        (self.free, self.used) = (other.free, other.used);
        self.num_corners = other.num_corners;
        (self.interior, self.interior_clearance) = (other.interior, other.interior_clearance);
        (self.error, self.ulp) = (other.error, other.ulp);
        (self.min_n2, self.key_error) = (other.min_n2, other.key_error);
    }

    /// Returns whether the interior point is below all planes by at least the error, so that the surface winds around
    /// it; `false` for NaN.
    #[inline(always)]
    pub fn encloses_interior_point(&self) -> bool {
        self.interior_clearance >= self.error
    }

    /// Returns by how much the face with the least key may be farther than the closest face, metres, if its distance is
    /// `distance`.
    #[inline(always)]
    pub fn key_error(&self, distance: f64) -> f64 {
        self.key_error * distance
    }

    /// Returns the proven lower bound of the distance from the origin to all faces, metres.
    pub fn lower_bound(&self, closest: &ClosestFace) -> f64 {
        let max_key = closest.key + 2.0 * KEY_ERROR_REL * closest.key.abs();
        let tied = (0..self.used.min(F)).filter(|&f| self.keys[f] <= max_key);
        let distances = tied.map(|f| self.offset(f) / self.normal(f).norm());
        distances.fold(f64::INFINITY, |least, d| lesser(d, least)) - self.error
    }

    /// Frees all faces.
    #[inline(always)]
    fn clear(&mut self) {
        self.keys.fill(f64::INFINITY);
        for (next, i) in self.next.iter_mut().zip(1..) {
            *next = i;
        }
    }

    /// Returns the closest face, by one sweep over the keys.
    #[inline(always)]
    pub fn closest_face(&self) -> ClosestFace {
        let mut least = [f64::INFINITY; 8];
        let last = Self::in_range(self.used.wrapping_sub(1)) | 15;
        for row in self.keys[..=last].chunks_exact(16) {
            for (i, a) in least.iter_mut().enumerate() {
                *a = lesser(*a, lesser(row[i], row[i + 8]));
            }
        }
        let [a, b, c, d, e, f, g, h] = least;
        let (even, odd) = ([a, c, e, g], [b, d, f, h]);
        let least = |[a, b, c, d]: [f64; 4]| lesser(lesser(a, b), lesser(c, d));
        let key = lesser(least(even), least(odd));
        ClosestFace {
            face: (key.to_bits() & FACE_MASK) as usize,
            key,
        }
    }

    /// Inserts the corner `new`. `first`: a face that it is above by more than `level`, metres. `corner` returns the point
    /// of a corner. Returns `false` if there is no room for the new faces; the polytope is then unchanged. `has_larger`:
    /// true if the caller continues in larger buffers then.
    ///
    /// As long as the horizon is not a single closed loop, or without larger buffers has more edges than there are free
    /// faces, the height above which a face counts as visible is multiplied by eight, until only `first` is visible.
    #[inline(always)]
    pub fn insert(
        &mut self,
        first: usize,
        new: &Vertex,
        level: f64,
        corner: &impl Fn(VertexPair) -> Vec3,
        has_larger: bool,
    ) -> bool {
        let mut above = level;
        // Terminates: the horizon of only `first` is closed.
        loop {
            match self.walk_visible(first, new, above, corner) {
                Insertion::NoRoom if has_larger => return false,
                Insertion::HorizonNotSimple | Insertion::NoRoom if above < f64::INFINITY => {
                    let height = self.plane(first).height(&Plane::point(&new.w));
                    above = if 8.0 * above < height {
                        8.0 * above
                    } else {
                        f64::INFINITY
                    };
                }
                insertion => return insertion == Insertion::Done,
            }
        }
    }

    /// Inserts a point by a depth-first walk over the visible faces. The walk meets the edges of the horizon in their
    /// cyclic order, so that each new face is made and linked at once.
    #[inline(always)]
    fn walk_visible(
        &mut self,
        first: usize,
        new: &Vertex,
        level: f64,
        corner: &impl Fn(VertexPair) -> Vec3,
    ) -> Insertion {
        let point = Plane::point(&new.w);
        let mut tail = first;
        self.keys[Self::in_range(first)] = f64::INFINITY;
        let mut edge = half_edge(first, 0);
        // The top of the stack of half-edges from which the walk continues; its face stores the one below.
        let mut top = half_edge(first, 1);
        *self.below_mut(first) = half_edge(first, 2) as u16;
        let mut free = self.free;
        // The horizon edges of the fan's first face and of its last one.
        let begin = half_edge(free, HORIZON);
        let mut previous = begin;
        let mut met_again = false;
        loop {
            let twin = self.twin(edge);
            let neighbour = self.plane(face_of(twin));
            if neighbour.height(&point) > level {
                let face = Self::in_range(face_of(twin));
                if self.keys[face] != f64::INFINITY {
                    self.keys[face] = f64::INFINITY;
                    self.set_next(tail, face);
                    tail = face;
                    *self.below_mut(face) = top as u16;
                    top = Self::step(twin, &PREVIOUS);
                    edge = Self::step(twin, &NEXT);
                    continue;
                }
                met_again = true;
            } else {
                if free >= F {
                    self.revert(first, tail, free);
                    return Insertion::NoRoom;
                }
                self.add_face(free, [edge, twin], [neighbour, point], new.pair, corner);
                let (f, on_horizon) = (Self::in_range(free), half_edge(free, HORIZON));
                self.twins[f][FROM_APEX] = (previous | TO_APEX) as u16;
                self.set_twin(twin, on_horizon);
                self.set_twin(previous | TO_APEX, on_horizon | FROM_APEX);
                previous = on_horizon;
                free = self.next_free(free);
            }
            if top == usize::from(STACK_BOTTOM) {
                break;
            }
            edge = top;
            let below = self.below_mut(face_of(edge));
            top = usize::from(core::mem::replace(below, STACK_BOTTOM));
        }
        // The first case: no face was hidden.
        if begin == half_edge(free, HORIZON)
            || met_again && !self.is_horizon_closed(begin, previous)
        {
            self.revert(first, tail, free);
            return Insertion::HorizonNotSimple;
        }
        self.set_twin(begin | FROM_APEX, previous | TO_APEX);
        self.set_twin(previous | TO_APEX, begin | FROM_APEX);
        self.used = self.used.max(free.min(F));
        self.num_corners += 1;
        // The visible faces become free.
        self.set_next(tail, free);
        self.free = first;
        if self.min_n2 < f64::INFINITY {
            self.error += INSERTION_ERROR_ULPS * self.ulp;
        }
        Insertion::Done
    }

    /// Makes face `f` from a horizon edge and a new point, by interpolation. The half-edges: that of the visible face and
    /// that of the hidden one. The planes: that of the hidden face, and the point.
    #[inline(always)]
    fn add_face(
        &mut self,
        f: usize,
        [edge, twin]: [usize; 2],
        [hidden, point]: [Plane; 2],
        new: VertexPair,
        corner: &impl Fn(VertexPair) -> Vec3,
    ) {
        let visible = self.plane(face_of(edge));
        let above = visible.height(&point);
        let below = lesser(hidden.height(&point), 0.0);
        let plane = visible.towards(&hidden, above / (above - below));
        // The corners of the visible face, rotated so that the edge leads from the first to the second.
        let corners = self.corners[Self::in_range(face_of(edge))];
        let turn = PAIR_BITS * edge_of(edge) as u32;
        let rotated = corners >> turn | corners << (3 * PAIR_BITS - turn);
        let ends = rotated & ((1 << (2 * PAIR_BITS)) - 1);
        let f = Self::in_range(f);
        self.corners[f] = ends | new.to_bits() << (2 * PAIR_BITS);
        self.planes[f] = plane.array();
        let (mut square, n2) = plane.signed_square();
        if !(n2 >= self.min_n2) {
            square = self.recompute_plane(f, face_of(edge), corner);
        }
        self.keys[f] = Self::key(f, square);
        self.twins[f][HORIZON] = twin as u16;
        *self.replaced_mut(f) = edge as u16;
    }

    /// Returns whether the edges of a fan, from its first half-edge to its last one, are a closed loop. The first and
    /// the last face are not linked yet.
    #[cold]
    #[inline(never)]
    fn is_horizon_closed(&self, begin: usize, last: usize) -> bool {
        let ends = |h: usize| {
            let [from, to, _] = self.corners(face_of(h));
            (from, to)
        };
        let mut current = begin;
        // Bounded: a fan has at most F faces.
        for _ in 0..F {
            if current == last {
                break;
            }
            let next = half_edge(face_of(self.twin(current | TO_APEX)), HORIZON);
            if ends(current).1 != ends(next).0 {
                return false;
            }
            current = next;
        }
        ends(last).1 == ends(begin).0
    }

    /// Reverts an insertion: frees the new faces, up to the face `free`, restores the twins, and puts the visible
    /// faces, from `first` to `tail`, in use again.
    #[cold]
    #[inline(never)]
    fn revert(&mut self, first: usize, tail: usize, free: usize) {
        let mut f = self.free;
        while f != free && f < F {
            let replaced = usize::from(*self.replaced_mut(f));
            self.set_twin(self.twin(half_edge(f, HORIZON)), replaced);
            self.keys[f] = f64::INFINITY;
            f = self.next_free(f);
        }
        let mut f = first;
        for _ in 0..F {
            let i = Self::in_range(f);
            self.keys[i] = Self::key(f, self.plane(f).signed_square().0);
            if f == tail {
                break;
            }
            f = self.next_visible(f);
        }
    }

    /// Computes the plane of face `f` from its corners, with unit normal and d the least N·corner, and stores it if it
    /// has the properties that the bound needs; else repairs the interpolated plane (*Cancelled normals* at the head of
    /// this file). `parent`: the visible face from which the plane was interpolated. Returns the signed squared
    /// distance.
    #[cold]
    #[inline(never)]
    fn recompute_plane(
        &mut self,
        f: usize,
        parent: usize,
        corner: &impl Fn(VertexPair) -> Vec3,
    ) -> f64 {
        let f = Self::in_range(f);
        let (old, parent) = (self.plane(f), self.plane(parent));
        let (_, n2) = old.signed_square();
        let plane = match self.plane_through_corners(f, old.offset() > 0.0, corner) {
            Some((plane, interior_clearance)) => {
                self.interior_clearance = lesser(interior_clearance, self.interior_clearance);
                plane
            }
            None if n2 >= MIN_N2 => {
                self.error += INSERTION_ERROR_ULPS * self.ulp;
                old
            }
            None if n2 > MIN_N2 * MIN_N2 => {
                let k = 1.0 / n2.sqrt();
                self.error *= k;
                old.scaled(k)
            }
            // Also for NaN.
            None => parent,
        };
        self.planes[f] = plane.array();
        plane.signed_square().0
    }

    /// Returns the plane through a face's corners and the distance of the interior point below it, metres. `None` if
    /// the face has no area above rounding, if the interior point is not below the plane, or if the origin is not
    /// below the plane although it must be (`is_inside`).
    fn plane_through_corners(
        &self,
        f: usize,
        is_inside: bool,
        corner: &impl Fn(VertexPair) -> Vec3,
    ) -> Option<(Plane, f64)> {
        let [a, b, p] = self.corners(f).map(corner);
        let n = normal(&p, &a, &b);
        let long2 = larger((a - p).norm_squared(), (b - p).norm_squared());
        let n2 = n.norm_squared();
        let extent = MIN_EXTENT_ULPS * self.ulp;
        if !(n2 > extent * extent * long2) {
            return None;
        }
        let n = n / n2.sqrt();
        let d = lesser(lesser(n.dot(&a), n.dot(&b)), n.dot(&p));
        let interior_clearance = d - n.dot(&self.interior);
        let is_valid = interior_clearance >= larger(PLANE_ERROR_ULPS * self.ulp, self.error)
            && (d > 0.0 || !is_inside);
        is_valid.then(|| (Plane::new(&n, d), interior_clearance))
    }
}

/// Result of a walk over the visible faces.
#[derive(PartialEq, Eq)]
enum Insertion {
    Done,
    NoRoom,
    HorizonNotSimple,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Random;

    const F: usize = 1024;
    const EPSILON: f64 = f64::EPSILON;
    /// The height above which a point counts as above a face of a polytope of size 1.
    const LEVEL: f64 = 8.0 * EPSILON as f64;

    /// Returns the corner of point `i`.
    fn corner(points: &[Vec3], i: usize) -> Vertex {
        let (w, pair) = (points[i], VertexSet::<1>::pair_of_entry(i));
        Vertex { w, pair }
    }

    /// Returns the point of a corner.
    fn point(points: &[Vec3], pair: VertexPair) -> Vec3 {
        points[usize::from(pair.a)]
    }

    /// Starts with the tetrahedron of the first four points.
    fn start<const F: usize>(
        hull: &mut EpaPolytope<F>,
        points: &[Vec3],
        size: f64,
        exact: bool,
    ) -> bool {
        hull.start(&[0, 1, 2, 3].map(|i| corner(points, i)), size, exact)
    }

    /// Asserts the invariants: the surface is closed, and all planes are below or at their corners and above the
    /// interior point.
    pub fn check<const F: usize>(hull: &EpaPolytope<F>, points: &[Vec3]) {
        let mut edges = 0;
        for f in hull.faces() {
            let plane = hull.plane(f);
            let length = plane.normal().norm();
            for pair in hull.corners(f) {
                let below = -plane.height(&Plane::point(&point(points, pair))) / length;
                assert!(below <= hull.error, "{below} {}", hull.error);
            }
            assert!(plane.normal().dot(&hull.interior) < plane.offset());
            assert!(hull.keys[f] < f64::INFINITY);
            for e in 0..3 {
                let twin = hull.twin(half_edge(f, e));
                assert_eq!(hull.twin(twin), half_edge(f, e));
                assert!(hull.keys[face_of(twin)] < f64::INFINITY);
                let (mine, other) = (hull.corners(f), hull.corners(face_of(twin)));
                assert_eq!(mine[e], other[(edge_of(twin) + 1) % 3]);
                assert_eq!(mine[(e + 1) % 3], other[edge_of(twin)]);
                edges += 1;
            }
        }
        assert_eq!(edges % 2, 0);
    }

    /// Returns the face with the greatest height of a point above it; `None` if that is at most `rounding`, metres.
    fn farthest_below<const F: usize>(
        hull: &EpaPolytope<F>,
        p: &Plane,
        rounding: f64,
    ) -> Option<usize> {
        let mut best = (None, rounding);
        for f in hull.faces() {
            let height = hull.plane(f).height(p);
            if height > best.1 {
                best = (Some(f), height);
            }
        }
        best.0
    }

    /// Returns the polytope of the points, inserted in their order; the first four are the tetrahedron.
    fn insert_all(points: &[Vec3], exact: bool) -> Option<Box<EpaPolytope<F>>> {
        let mut hull = Box::new(EpaPolytope::<F>::BLANK);
        let size = points.iter().fold(0.0, |m: f64, p| m.max(p.norm()));
        let rounding = LEVEL * size;
        if !start(&mut hull, points, size, exact) {
            return None;
        }
        for (i, p) in points.iter().enumerate().skip(4) {
            if let Some(f) = farthest_below(&hull, &Plane::point(p), rounding) {
                let done = hull.insert(
                    f,
                    &corner(points, i),
                    rounding,
                    &|pair| point(points, pair),
                    true,
                );
                assert!(done);
            }
            check(&hull, points);
        }
        Some(hull)
    }

    /// Returns the distance from the origin to the boundary of the hull, negative outside: over all
    /// planes through three points that have all others on one side.
    fn exact_distance(points: &[Vec3]) -> f64 {
        let points: Vec<_> = points.to_vec();
        let mut least = f64::INFINITY;
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                for c in &points[j + 1..] {
                    let n = (b - a).cross(&(c - a));
                    let Some(n) = n.try_normalize(0.0) else {
                        continue;
                    };
                    for n in [n, -n] {
                        let h = points
                            .iter()
                            .fold(f64::NEG_INFINITY, |m, p| m.max(n.dot(p)));
                        if h <= n.dot(a) + 1e3 * EPSILON {
                            least = least.min(h);
                        }
                    }
                }
            }
        }
        least
    }

    fn closest<const F: usize>(hull: &EpaPolytope<F>) -> f64 {
        let plane = hull.plane(hull.closest_face().face);
        plane.offset() / plane.normal().norm() - hull.error
    }

    #[test]
    fn hulls_of_random_points_are_exact() {
        let mut r = Random::new(1);
        for round in 0..200 {
            let points: Vec<_> = (0..14).map(|_| r.vector(1.0)).collect();
            let Some(hull) = insert_all(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (closest(&hull), exact_distance(&points));
            assert!((found - exact).abs() <= 2.0 * hull.error + 64.0 * EPSILON);
        }
    }

    /// Equal, coplanar and collinear points: the bound is sound, and exact up to the height at which
    /// points count as on a face.
    #[test]
    fn hulls_of_grid_points_are_bounded() {
        let mut r = Random::new(2);
        for round in 0..2000 {
            let steps = [2.0, 3.0, 4.0][round % 3];
            let mut grid = || (r.within(0.0, steps + 1.0).floor() - 0.5 * steps) / steps;
            let points: Vec<_> = (0..16).map(|_| Vec3::new(grid(), grid(), grid())).collect();
            let Some(hull) = insert_all(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (closest(&hull), exact_distance(&points));
            assert!(found <= exact + 16.0 * EPSILON, "{found} {exact}");
            assert!(
                found >= exact - 2.0 * hull.error - 1e3 * EPSILON,
                "{round} {found} {exact}"
            );
        }
    }

    /// The first corner is the middle of two later corners.
    #[test]
    fn an_interior_point_on_a_segment() {
        let mut r = Random::new(3);
        for round in 0..2000 {
            let mut points: Vec<_> = (0..12).map(|_| r.vector(1.0)).collect();
            points[0] = (points[1] + points[4]) * 0.5;
            let Some(hull) = insert_all(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (closest(&hull), exact_distance(&points[1..]));
            assert!(found <= exact + 16.0 * EPSILON, "{round} {found} {exact}");
            assert!(
                found >= exact - 2.0 * hull.error - 1e3 * EPSILON,
                "{round} {found} {exact}"
            );
        }
    }

    /// Points on spheres and flat ellipsoids: slivers, thin wedges, many faces.
    #[test]
    fn thin_and_round_hulls_keep_the_invariant() {
        let mut r = Random::new(4);
        for thin in [1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
            for round in 0..20 {
                let mut points = r.points(120, 1.0);
                for p in &mut points {
                    p.z *= thin as f64;
                }
                insert_all(&points, round % 2 == 0);
            }
        }
    }

    /// A full polytope that is copied to larger buffers continues there as if it had been made in them.
    #[test]
    fn a_copied_polytope_continues() {
        let mut r = Random::new(6);
        let points = r.points(60, 1.0);
        let (mut small, mut large, mut whole) = (
            EpaPolytope::<32>::BLANK,
            EpaPolytope::<128>::BLANK,
            EpaPolytope::<128>::BLANK,
        );
        assert!(start(&mut small, &points, 1.0, false));
        assert!(start(&mut whole, &points, 1.0, false));
        let mut is_copied = false;
        for (i, p) in points.iter().enumerate().skip(4) {
            let (new, point) = (corner(&points, i), |pair| point(&points, pair));
            let Some(f) = farthest_below(&whole, &Plane::point(p), LEVEL) else {
                continue;
            };
            assert!(whole.insert(f, &new, LEVEL, &point, true));
            if !is_copied && !small.insert(f, &new, LEVEL, &point, true) {
                large.copy_from(&small);
                is_copied = true;
            }
            if is_copied {
                assert!(large.insert(f, &new, LEVEL, &point, true));
                check(&large, &points);
            }
        }
        assert!(is_copied);
        let faces = |p: &EpaPolytope<128>| p.faces().map(|f| p.corners(f)).collect::<Vec<_>>();
        assert_eq!(faces(&large), faces(&whole));
        assert_eq!(closest(&large), closest(&whole));
    }

    /// A polytope without room returns `false` and does not change.
    #[test]
    fn a_full_polytope_does_not_change() {
        let mut r = Random::new(5);
        let points = r.points(60, 1.0);
        let mut small = EpaPolytope::<32>::BLANK;
        assert!(start(&mut small, &points, 1.0, false));
        let mut refused = 0;
        for (i, p) in points.iter().enumerate().skip(4) {
            if let Some(f) = farthest_below(&small, &Plane::point(p), LEVEL) {
                let faces =
                    |p: &EpaPolytope<32>| p.faces().map(|f| p.corners(f)).collect::<Vec<_>>();
                let before = faces(&small);
                if !small.insert(
                    f,
                    &corner(&points, i),
                    LEVEL,
                    &|pair| point(&points, pair),
                    true,
                ) {
                    assert_eq!(before, faces(&small));
                    refused += 1;
                }
                check(&small, &points);
            }
        }
        assert!(refused > 0);
    }

    /// Two apices over a polygon, and a third that sees twelve faces: their fan has more faces than are free.
    #[test]
    fn without_larger_buffers_a_fan_of_too_many_faces_becomes_a_smaller_one() {
        let rim = |i: usize| {
            let (sin, cos) = (i as f64 * core::f64::consts::PI / 6.0).sin_cos();
            Vec3::new(cos, sin, 0.0)
        };
        let mut points = vec![rim(0), rim(4), rim(8), Vec3::z(), -Vec3::z()];
        points.extend([1, 2, 3, 5, 6, 7, 9, 10, 11].map(rim));
        points.push(Vec3::z() * 2.0);
        let mut hull = EpaPolytope::<32>::BLANK;
        assert!(start(&mut hull, &points, 2.0, false));
        for (i, p) in points.iter().enumerate().skip(4) {
            let p = Plane::point(p);
            let first = farthest_below(&hull, &p, LEVEL).expect("a face below a corner");
            let new = corner(&points, i);
            let point = |pair| point(&points, pair);
            let is_last = i + 1 == points.len();
            assert_eq!(hull.insert(first, &new, LEVEL, &point, true), !is_last);
            assert!(!is_last || hull.insert(first, &new, LEVEL, &point, false));
            check(&hull, &points);
        }
    }
}
