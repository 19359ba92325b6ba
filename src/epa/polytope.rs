// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The polytope of EPA: triangles with homogeneous planes, half-edges, insertion of points. It knows no
//! query.
//!
//! # Insertion by interpolation
//!
//! A new point p replaces the *visible* faces, those that it is above, by a fan over their *horizon*. A
//! horizon edge is between a visible face F, which p is f > 0 above, and a hidden face G, which it is
//! g <= 0 above. Any plane through the edge is a combination of the two, and the one through p is
//!
//!   F′ = F + w (G − F),   w = f / (f − g):   f + w (g − f) = 0.
//!
//! (The double description of a polytope: Motzkin and others, 1953; Fukuda and Prodon, 1996.) It takes one
//! division, no coordinates of corners, no cross product and no root. Since 0 < w <= 1 errors are averaged,
//! not amplified, and a sliver's plane is between two good ones. A point below both F and G is below F′:
//!
//! - the *interior point*, the middle of the first tetrahedron, stays below every plane, by the least
//!   *interior_clearance* of the planes that were computed from corners, and
//! - an origin below every plane (d > 0) stays there.
//!
//! A point hardly above G counts as on it (g is taken as 0, w = 1): the new face has G's plane.
//!
//! # The bound
//!
//! *Invariant*: the corners v of a face have N·v >= d, within [`EpaPolytope::error`]. So its triangle is at
//! least d / |N| away from the origin. The closed surface winds around the interior point once: it did as
//! a tetrahedron, and while that point is below every plane no triangle reaches it. Where all d > 0, no
//! triangle meets the segment from it to the origin either, both ends being below the plane and the
//! corners not; so the surface winds around the origin once, and around every point nearer than its closest
//! triangle. That ball is in the hull of the corners. The surface need not be convex for this: convexity
//! decides how fast the bound grows. Where the interior_clearance is no more than the error
//! ([`EpaPolytope::encloses_interior_point`]) nothing is proven.
//!
//! # Repairs, all under that invariant
//!
//! - *Cancelled normals.* Between nearly opposite normals |N′| is nearly 0. There the plane is computed from
//!   its corners ([`EpaPolytope::recompute_plane`]), which inherits nothing: it is taken only where it turns
//!   no other way, has the interior point below it, and d > 0 where that was so. Else F′ is normalised, and
//!   the error with it; or, where nothing of it is left, the new face has F's plane, which its corners are
//!   on or above.
//! - *No single horizon.* Where rounding has made the visible faces no disc, nothing is changed, and fewer
//!   of them are taken for visible ([`EpaPolytope::insert`]); the first one alone always is a disc.
//!
//! # Layout
//!
//! Arrays, not structs: a sweep over the keys finds the closest face without a heap. A half-edge is
//! 4 · face + edge; edge i leads from corner i to corner i + 1, counter-clockwise seen from outside. Faces
//! outside use have the key +∞ and are chained.
//!
//! Above 400 lines, half of them the tests of these invariants.

use crate::epa::plane::{MIN_EXTENT_ULPS, PLANE_ERROR_ULPS, Plane, Tetrahedron};
use crate::math::{Vec3, larger, lesser, normal};

/// No half-edge: the bottom of the stack of half-edges in [`EpaPolytope::walk_visible`].
const STACK_BOTTOM: u16 = u16::MAX;
/// The steps to the next and the previous half-edge of a face, by the edge.
const NEXT: [i8; 4] = [1, 1, -2, 0];
const PREVIOUS: [i8; 4] = [2, -1, -1, 0];
/// The low bits of a key that hold the index of its face. They move a distance by 5e-13 of itself, in the
/// order of the faces alone.
const INDEX_MASK: u64 = 0xfff;
/// The share of a distance that the index may stand for, and more.
const KEY_ERROR_REL: f64 = 1e-12;
/// The most faces whose indices fit.
pub const MAX_FACES: usize = 4096;
/// |N|² below which a plane has lost a digit to interpolation and is computed from its corners. Derived:
/// the error stays within ten times that of its parents.
const MIN_INTERPOLATED_N2: f64 = 0.01;
/// |N|² below which nothing of an interpolated plane is left: two digits more.
const MIN_USABLE_N2: f64 = 1e-6;
/// The largest error that normalising a plane may lead to, in ulps of the size. Insensitive, 1e4 to 1e6 on
/// the recorded contacts: far below the tolerances that interpolated planes serve.
const MAX_SCALED_ERROR_ULPS: f64 = 1e5;
/// The error that an insertion adds, in ulps of the size. Derived: two products and their sum, an ulp of
/// the size each, ten times as much where |N| is a tenth.
const INSERTION_ERROR_ULPS: f64 = 20.0;

/// A polytope with room for `F` faces, whose corners have indices below 32768.
#[repr(C)]
pub struct EpaPolytope<const F: usize> {
    planes: [[f64; 4]; F],
    /// An ulp of the size of D, metres. (A number between two arrays has a small polytope zeroed one by
    /// one: a larger block is zeroed byte by byte.)
    ulp: f64,
    /// d|d| / |N|² with the index of the face in its low bits.
    keys: [f64; F],
    /// The half-edge on the other side of each of the three edges. The fourth is used while a fan is made:
    /// a new face keeps the half-edge there that its edge 0 takes the place of (for
    /// [`EpaPolytope::revert`]), and a visible face what is under its half-edge on the stack.
    twins: [[u16; 4]; F],
    /// Four corners of 16 bits: 0, 1, 2, and 0 again.
    corners: [u64; F],
    /// The next face outside use, or the next visible one.
    next: [u16; F],
    free: usize,
    used: usize,
    interior: Vec3,
    /// The least distance of the interior point from a plane, in units of its |N|, metres.
    interior_clearance: f64,
    error: f64,
    /// |N|² below which planes are computed from their corners.
    cancelled: f64,
    /// [`KEY_ERROR_REL`], or 0 where keys are made exact ([`EpaPolytope::refresh_keys`]).
    key_error: f64,
}

/// The closest face and its signed square distance, m².
#[derive(Clone, Copy, Debug)]
pub struct ClosestFace {
    /// The index of the face.
    pub face: usize,
    /// d|d| / |N|², to 1e-12 of itself.
    pub key: f64,
}

impl<const F: usize> EpaPolytope<F> {
    /// Not fit for use before [`EpaPolytope::start`]. All zero, so that no pattern is copied.
    pub const BLANK: Self = Self {
        planes: [[0.0; 4]; F],
        ulp: 0.0,
        keys: [0.0; F],
        twins: [[0; 4]; F],
        corners: [0; F],
        next: [0; F],
        free: 0,
        used: 0,
        interior: Vec3::new(0.0, 0.0, 0.0),
        interior_clearance: 0.0,
        error: 0.0,
        cancelled: 0.0,
        key_error: 0.0,
    };

    /// Returns a blank polytope for points of this size. See the field `ulp`.
    #[inline(always)]
    pub fn blank(size: f64) -> Self {
        Self {
            ulp: f64::EPSILON * size,
            ..Self::BLANK
        }
    }

    #[inline(always)]
    fn in_range(i: usize) -> usize {
        const { assert!(F % 8 == 0 && F >= 8 && F <= MAX_FACES) };
        if F.is_power_of_two() {
            i & (F - 1)
        } else {
            i.min(F - 1)
        }
    }

    #[inline(always)]
    fn plane(&self, f: usize) -> Plane {
        Plane::of(&self.planes[Self::in_range(f)])
    }

    #[inline(always)]
    fn edge_in_range(h: usize) -> usize {
        if F.is_power_of_two() {
            h & (4 * F - 1)
        } else {
            h.min(4 * F - 1)
        }
    }

    #[inline(always)]
    fn twin(&self, h: usize) -> usize {
        usize::from(self.twins.as_flattened()[Self::edge_in_range(h)])
    }

    #[inline(always)]
    fn set_twin(&mut self, h: usize, twin: usize) {
        self.twins.as_flattened_mut()[Self::edge_in_range(h)] = twin as u16;
    }

    #[inline(always)]
    fn step(h: usize, by: &[i8; 4]) -> usize {
        h.wrapping_add_signed(isize::from(by[h & 3]))
    }

    /// Returns the indices of a face's corners.
    #[inline(always)]
    pub fn corners(&self, f: usize) -> [usize; 3] {
        let c = self.corners[Self::in_range(f)];
        [c & 0xffff, c >> 16 & 0xffff, c >> 32 & 0xffff].map(|i| i as usize)
    }

    /// Returns N of a face: outward, and no longer than 1 by more than rounding.
    #[inline(always)]
    pub fn normal(&self, f: usize) -> Vec3 {
        self.plane(f).normal()
    }

    /// Returns d of a face, for its [`EpaPolytope::normal`].
    #[inline(always)]
    pub fn offset(&self, f: usize) -> f64 {
        self.plane(f).offset()
    }

    /// Returns the distance of a face's plane from the origin, metres, negative where the origin is
    /// outside, less the error.
    fn distance(&self, f: usize) -> f64 {
        let plane = self.plane(f);
        plane.offset() / plane.normal().norm() - self.error
    }

    /// Returns the error of the distance of a plane, metres.
    #[inline(always)]
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Takes the size of D into account, metres, where it has grown.
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

    #[inline(always)]
    fn key(f: usize, square: f64) -> f64 {
        // Live faces have finite keys.
        let finite = if square < f64::MAX { square } else { f64::MAX };
        f64::from_bits(finite.to_bits() & !INDEX_MASK | f as u64)
    }

    /// Begins with a tetrahedron whose points have the indices 0 to 3. `is_exact`: planes are computed from
    /// their corners throughout, for tolerances that interpolated planes are too coarse for.
    #[inline(always)]
    pub fn start(&mut self, tetrahedron: &Tetrahedron, is_exact: bool) {
        let (a, b) = if tetrahedron.is_flipped {
            (2, 1)
        } else {
            (1, 2)
        };
        let corners = [[0, b, a], [0, a, 3], [a, b, 3], [b, 0, 3]];
        let twins = [[12, 8, 4, 0], [2, 10, 13, 0], [1, 14, 5, 0], [0, 6, 9, 0]];
        self.clear();
        for (f, plane) in tetrahedron.planes.iter().enumerate() {
            let d = plane.offset();
            let [i, j, k] = corners[f];
            self.planes[f] = plane.array();
            self.keys[f] = Self::key(f, d * d.abs());
            self.corners[f] = i | j << 16 | k << 32 | i << 48;
            self.twins[f] = twins[f];
        }
        (self.used, self.free) = (4, 4);
        self.interior = tetrahedron.middle;
        self.interior_clearance = tetrahedron.interior_clearance;
        self.error = tetrahedron.error;
        self.ulp = tetrahedron.error / PLANE_ERROR_ULPS;
        (self.cancelled, self.key_error) = if is_exact {
            (f64::INFINITY, 0.0)
        } else {
            (MIN_INTERPOLATED_N2, KEY_ERROR_REL)
        };
    }

    /// Returns whether the interior point is below all planes for certain, so that the surface winds around
    /// it; `false` for NaN.
    #[inline(always)]
    pub fn encloses_interior_point(&self) -> bool {
        self.interior_clearance >= self.error
    }

    /// Returns what a face at this distance may be farther away than the closest, metres, because their
    /// keys tie.
    #[inline(always)]
    pub fn key_error(&self, distance: f64) -> f64 {
        self.key_error * distance
    }

    /// Returns the proven lower bound of the distance from the origin to all faces, metres.
    pub fn lower_bound(&self, closest: &ClosestFace) -> f64 {
        let most = closest.key + 4.0 * KEY_ERROR_REL * closest.key.abs();
        let tied = (0..self.used.min(F)).filter(|&f| self.keys[f] <= most);
        tied.fold(f64::INFINITY, |least, f| lesser(self.distance(f), least))
    }

    /// Takes all faces out of use.
    #[inline(always)]
    fn clear(&mut self) {
        self.keys.fill(f64::INFINITY);
        for (next, i) in self.next.iter_mut().zip(1..) {
            *next = i;
        }
    }

    /// Returns the closest face: one sweep over the keys, whose low bits hold the index.
    #[inline(always)]
    pub fn closest_face(&self) -> ClosestFace {
        let mut least = [f64::INFINITY; 8];
        let last = Self::in_range(self.used.wrapping_sub(1)) | 7;
        for row in self.keys[..=last].chunks_exact(8) {
            for (a, b) in least.iter_mut().zip(row) {
                *a = if *b < *a { *b } else { *a };
            }
        }
        let mut key = f64::INFINITY;
        for b in least {
            key = if b < key { b } else { key };
        }
        ClosestFace {
            face: (key.to_bits() & INDEX_MASK) as usize,
            key,
        }
    }

    /// Returns whether a face is closer than this key, where tolerances are finer than keys tell. Such a
    /// face gets a key that says so.
    #[inline(always)]
    pub fn refresh_keys(&mut self, key: f64) -> bool {
        !(self.key_error > 0.0) && self.sharpen_keys(key)
    }

    #[cold]
    #[inline(never)]
    fn sharpen_keys(&mut self, key: f64) -> bool {
        let mut refresh_keys = false;
        for f in 0..self.used.min(F) {
            let (square, _) = self.plane(f).signed_square();
            if self.keys[f] < f64::INFINITY && square < key {
                self.keys[f] = Self::key(f, square * (1.0 - KEY_ERROR_REL));
                refresh_keys = true;
            }
        }
        refresh_keys
    }

    /// Makes a point the corner with index `id`. `first` is a face that it is above by more than
    /// `level`, metres; `corner` returns the points by their indices. `false`: there is no room for its
    /// faces, and nothing has changed.
    ///
    /// Where the visible faces are no disc, the height that makes a face visible is raised eightfold, and again,
    /// until `first` alone is left.
    #[inline(always)]
    pub fn insert(
        &mut self,
        first: usize,
        id: usize,
        p: &Vec3,
        level: f64,
        corner: &impl Fn(usize) -> Vec3,
    ) -> bool {
        let mut above = level;
        // Terminates: `first` alone is a disc.
        loop {
            match self.walk_visible(first, id, p, above, corner) {
                Insertion::HorizonNotSimple if above < f64::INFINITY => {
                    let height = self.plane(first).height(&Plane::point(p));
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

    /// Walks through the visible faces depth first, which meets the edges of the horizon in their cyclic
    /// order: each new face is made and linked at once.
    #[inline(always)]
    fn walk_visible(
        &mut self,
        first: usize,
        id: usize,
        p: &Vec3,
        level: f64,
        corner: &impl Fn(usize) -> Vec3,
    ) -> Insertion {
        let lifted = Plane::point(p);
        let mut tail = first;
        self.keys[Self::in_range(first)] = f64::INFINITY;
        let mut edge = 4 * first;
        // The top of the stack of half-edges to go on from: its face holds the one below.
        let mut top = edge + 1;
        self.twins[Self::in_range(first)][3] = edge as u16 + 2;
        let mut free = self.free;
        let begin = 4 * free;
        let mut previous = begin;
        let mut met_again = false;
        loop {
            let twin = self.twin(edge);
            let hidden = self.plane(twin >> 2);
            if hidden.height(&lifted) > level {
                let beyond = Self::in_range(twin >> 2);
                if self.keys[beyond] != f64::INFINITY {
                    self.keys[beyond] = f64::INFINITY;
                    self.next[Self::in_range(tail)] = beyond as u16;
                    tail = beyond;
                    self.twins[beyond][3] = top as u16;
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
                self.add_face(free, edge, [hidden, lifted], id, corner);
                let (f, new) = (Self::in_range(free), 4 * free);
                self.twins[f][2] = (previous | 1) as u16;
                self.set_twin(twin, new);
                self.set_twin(previous | 1, new | 2);
                previous = new;
                free = usize::from(self.next[f]);
            }
            if top == usize::from(STACK_BOTTOM) {
                break;
            }
            edge = top;
            let below = &mut self.twins[Self::in_range(edge >> 2)][3];
            top = usize::from(core::mem::replace(below, STACK_BOTTOM));
        }
        // Also where no face was hidden.
        if begin == 4 * free || met_again && !self.is_horizon_closed(begin, previous) {
            self.revert(first, tail, free);
            return Insertion::HorizonNotSimple;
        }
        self.set_twin(begin | 2, previous | 1);
        self.set_twin(previous | 1, begin | 2);
        self.used = self.used.max(free.min(F));
        self.next[Self::in_range(tail)] = free as u16;
        self.free = first;
        if self.cancelled < f64::INFINITY {
            self.error += INSERTION_ERROR_ULPS * self.ulp;
        }
        Insertion::Done
    }

    /// Makes face `f` over a horizon edge and a new point, see the head of this file. `edge`: the half-edge
    /// of the visible face.
    #[inline(always)]
    fn add_face(
        &mut self,
        f: usize,
        edge: usize,
        [hidden, point]: [Plane; 2],
        id: usize,
        corner: &impl Fn(usize) -> Vec3,
    ) {
        let visible = self.plane(edge >> 2);
        let above = visible.height(&point);
        let below = lesser(hidden.height(&point), 0.0);
        let plane = visible.towards(&hidden, above / (above - below));
        let ends = self.corners[Self::in_range(edge >> 2)] >> (16 * (edge & 3)) & 0x7fff_ffff;
        let f = Self::in_range(f);
        self.corners[f] = ends | (id as u64) << 32 | (ends & 0xffff) << 48;
        self.planes[f] = plane.array();
        let (mut square, n2) = plane.signed_square();
        if !(n2 >= self.cancelled) {
            square = self.recompute_plane(f, edge >> 2, corner);
        }
        self.keys[f] = Self::key(f, square);
        self.twins[f][0] = self.twin(edge) as u16;
        self.twins[f][3] = edge as u16;
    }

    /// Returns whether the edges of a fan follow each other, and close. From its first half-edge to its
    /// last; the two are not linked yet.
    #[cold]
    #[inline(never)]
    fn is_horizon_closed(&self, begin: usize, last: usize) -> bool {
        let ends = |h: usize| {
            let [from, to, _] = self.corners(h >> 2);
            (from, to)
        };
        let mut at = begin;
        // Each face once.
        for _ in 0..F {
            if at == last {
                break;
            }
            let next = self.twin(at | 1) & !3;
            if ends(at).1 != ends(next).0 {
                return false;
            }
            at = next;
        }
        ends(last).1 == ends(begin).0
    }

    /// Takes back a fan that was begun, up to the face `free`: twins as they were, and the visible faces,
    /// from `first` to `tail`, in use again.
    #[cold]
    #[inline(never)]
    fn revert(&mut self, first: usize, tail: usize, free: usize) {
        let mut f = self.free;
        while f != free && f < F {
            let [twin, _, _, before] = self.twins[f];
            self.set_twin(usize::from(twin), usize::from(before));
            self.keys[f] = f64::INFINITY;
            f = usize::from(self.next[f]);
        }
        let mut f = first;
        for _ in 0..F {
            let i = Self::in_range(f);
            self.keys[i] = Self::key(f, self.plane(f).signed_square().0);
            if f == tail {
                break;
            }
            f = usize::from(self.next[i]);
        }
    }

    /// Computes the plane of face `f` from its corners, unit normal, with d the least N·corner; takes it
    /// where it inherits what the bound needs, see above. `parent` is the face it was interpolated from.
    /// Returns the signed square distance.
    #[cold]
    #[inline(never)]
    fn recompute_plane(&mut self, f: usize, parent: usize, corner: &impl Fn(usize) -> Vec3) -> f64 {
        let f = Self::in_range(f);
        let (old, parent) = (self.plane(f), self.plane(parent));
        let (square, n2) = old.signed_square();
        // Of a vanished plane neither side nor sign is known: its parent's sign counts.
        let is_side_known = n2 > MIN_USABLE_N2;
        let ancestor = if is_side_known { &old } else { &parent };
        let plane = match self.plane_through_corners(f, ancestor, is_side_known, corner) {
            Some((plane, interior_clearance)) => {
                self.interior_clearance = lesser(interior_clearance, self.interior_clearance);
                plane
            }
            None if n2 >= MIN_INTERPOLATED_N2 => {
                self.error += INSERTION_ERROR_ULPS * self.ulp;
                return square;
            }
            None if is_side_known && self.error <= MAX_SCALED_ERROR_ULPS * self.ulp * n2.sqrt() => {
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

    /// Returns the plane through a face's corners and the distance of the interior point below it, metres,
    /// if the face has an area and the plane inherits from `old` what the bound needs: the interior point
    /// below it, the origin if that was so, and the side if that is known.
    fn plane_through_corners(
        &self,
        f: usize,
        old: &Plane,
        is_side_known: bool,
        corner: &impl Fn(usize) -> Vec3,
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
        let inherits = (!is_side_known || n.dot(&old.normal()) > 0.0)
            && interior_clearance >= larger(PLANE_ERROR_ULPS * self.ulp, self.error)
            && (d > 0.0 || !(old.offset() > 0.0));
        inherits.then(|| (Plane::new(&n, d), interior_clearance))
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
    use crate::shapes::Random;

    const F: usize = 1024;
    const EPSILON: f64 = f64::EPSILON;
    /// A point is above a unit polytope by more than this.
    const LEVEL: f64 = 8.0 * EPSILON as f64;

    /// Asserts the invariants: a closed surface, all planes at or below their corners and above the
    /// interior point.
    pub fn check<const F: usize>(hull: &EpaPolytope<F>, points: &[Vec3]) {
        let mut edges = 0;
        for f in hull.faces() {
            let plane = hull.plane(f);
            let length = plane.normal().norm();
            for i in hull.corners(f) {
                let below = -plane.height(&Plane::point(&points[i])) / length;
                assert!(below <= hull.error, "{below} {}", hull.error);
            }
            assert!(plane.normal().dot(&hull.interior) < plane.offset());
            assert!(hull.keys[f] < f64::INFINITY);
            for e in 0..3 {
                let twin = hull.twin(4 * f + e);
                assert_eq!(hull.twin(twin), 4 * f + e);
                assert!(hull.keys[twin >> 2] < f64::INFINITY);
                let (mine, other) = (hull.corners(f), hull.corners(twin >> 2));
                assert_eq!(mine[e], other[((twin & 3) + 1) % 3]);
                assert_eq!(mine[(e + 1) % 3], other[twin & 3]);
                edges += 1;
            }
        }
        assert_eq!(edges % 2, 0);
    }

    /// Returns the face that a point is farthest above, if by more than `rounding`, metres.
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

    /// Returns the polytope of the points in their order; the first four are the tetrahedron.
    fn grown(points: &[Vec3], exact: bool) -> Option<Box<EpaPolytope<F>>> {
        let mut hull = Box::new(EpaPolytope::<F>::BLANK);
        let size = points.iter().fold(0.0, |m: f64, p| m.max(p.norm()));
        let rounding = LEVEL * size;
        let first = [0, 1, 2, 3].map(|i| points[i]);
        hull.start(&Tetrahedron::new(first, EPSILON * size)?, exact);
        for (i, p) in points.iter().enumerate().skip(4) {
            if let Some(f) = farthest_below(&hull, &Plane::point(p), rounding) {
                let done = hull.insert(f, i, p, rounding, &|i| points[i]);
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
            let Some(hull) = grown(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (closest(&hull), exact_distance(&points));
            assert!((found - exact).abs() <= 2.0 * hull.error + 64.0 * EPSILON);
        }
    }

    /// Ties, coplanar and collinear points, points twice: the bound holds, and is the
    /// distance to the level at which points count as on a face.
    #[test]
    fn hulls_of_grid_points_are_bounded() {
        let mut r = Random::new(2);
        for round in 0..2000 {
            let steps = [2.0, 3.0, 4.0][round % 3];
            let mut grid = || (r.within(0.0, steps + 1.0).floor() - 0.5 * steps) / steps;
            let points: Vec<_> = (0..16).map(|_| Vec3::new(grid(), grid(), grid())).collect();
            let Some(hull) = grown(&points, round % 2 == 0) else {
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

    /// The middle of two support points as the first corner, and both of them after it.
    #[test]
    fn an_apex_on_a_segment() {
        let mut r = Random::new(3);
        for round in 0..2000 {
            let mut points: Vec<_> = (0..12).map(|_| r.vector(1.0)).collect();
            points[0] = (points[1] + points[4]) * 0.5;
            let Some(hull) = grown(&points, round % 2 == 0) else {
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

    /// Spheres of points and flat discs: slivers, thin wedges, many faces.
    #[test]
    fn thin_and_round_hulls_keep_the_invariant() {
        let mut r = Random::new(4);
        for thin in [1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
            for round in 0..20 {
                let mut points = r.points(120, 1.0);
                for p in &mut points {
                    p.z *= thin as f64;
                }
                grown(&points, round % 2 == 0);
            }
        }
    }

    /// A polytope without room refuses a point and has not changed.
    #[test]
    fn a_full_polytope_is_left_whole() {
        let mut r = Random::new(5);
        let points = r.points(60, 1.0);
        let mut small = EpaPolytope::<32>::BLANK;
        let first = [0, 1, 2, 3].map(|i| points[i]);
        small.start(&Tetrahedron::new(first, EPSILON).unwrap(), false);
        let mut refused = 0;
        for (i, p) in points.iter().enumerate().skip(4) {
            if let Some(f) = farthest_below(&small, &Plane::point(p), LEVEL) {
                let faces =
                    |p: &EpaPolytope<32>| p.faces().map(|f| p.corners(f)).collect::<Vec<_>>();
                let before = faces(&small);
                if !small.insert(f, i, p, LEVEL, &|i| points[i]) {
                    assert_eq!(before, faces(&small));
                    refused += 1;
                }
                check(&small, &points);
            }
        }
        assert!(refused > 0);
    }
}
