// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The buffers of the global query, in three sizes: the vertices of the objects, the corners of the polytope, its
//! faces. Full buffers are copied to larger ones: from the small ones, on the stack, to the large ones, on the stack in a
//! frame of their own, to those of an [`Arena`].

use crate::epa::polytope::{EpaPolytope, MAX_FACES};
use crate::geometry::plane::Tetrahedron;
use crate::math::Vec3;
use crate::minkowski::support::Fault;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The limit of support points of a default query, up to the end of its polytope.
pub const MAX_DEFAULT_POINTS: u64 = 160;
/// The limit of support points of a query that proves the tolerance, up to the end of its polytope, and of the published
/// method (along, incremental, planar).
///
/// No query is to take more than 400 support points in all. Derived: 400 − 80. Measured (`cargo run --release -p lab --bin
/// campaigns -- wide`): up to 80 more, on nearly coincident bodies, are evaluated beyond this limit, for starts of the
/// polytope that do not contain the origin yet and in the local search that follows
/// ([`MAX_WALK_POINTS`](crate::local::MAX_WALK_POINTS)). Queries without a polytope have
/// [`ITERATION_CAP`](crate::math::ITERATION_CAP).
pub const MAX_PROVEN_POINTS: u64 = 320;

/// The number of vertices of the small buffers, 6 KB on the stack with their corners and faces: enough for shallow
/// contacts and most polytopes.
pub const SMALL_VERTICES: usize = 24;
const SMALL_CORNERS: usize = 32;
const SMALL_FACES: usize = max_faces(SMALL_CORNERS);
/// The number of vertices of the large buffers, on the stack.
pub const LARGE_VERTICES: usize = MAX_DEFAULT_POINTS as usize + START_VERTICES;
/// The number of faces of the large buffers: what 44 KB of stack leave (test `costs`).
const LARGE_FACES: usize = 352;
/// The number of corners that these faces are enough for: a closed surface of C corners has 2 C − 4 faces, and an insertion
/// makes a few new faces before it frees the old ones. The corners above the number of vertices are known differences.
const LARGE_CORNERS: usize = LARGE_FACES / 2 - 2;
/// The number of vertices of the buffers of an [`Arena`].
const ARENA_VERTICES: usize = MAX_PROVEN_POINTS as usize + START_VERTICES;
const ARENA_CORNERS: usize = 2 * ARENA_VERTICES;
const ARENA_FACES: usize = max_faces(ARENA_CORNERS);
/// The number of entries that a start of the polytope adds to the vertex set: the corners of a tetrahedron. So much room
/// is kept above the limit of support points too, which applies only while the origin is inside the polytope.
pub const START_VERTICES: usize = 4;

/// Returns the number of faces for C corners: a closed surface has 2 C − 4 faces, and an insertion makes the new faces
/// before it frees the old ones.
const fn max_faces(corners: usize) -> usize {
    (2 * corners).next_multiple_of(16)
}

const _: () = assert!(LARGE_CORNERS > LARGE_VERTICES);
const _: () = assert!(ARENA_CORNERS < 32768 && ARENA_FACES <= MAX_FACES);
const _: () = assert!(ARENA_VERTICES <= 1024 && START_VERTICES < SMALL_VERTICES);

/// The corners of the polytope: the vertex pair of each corner index, or the mark of the interior point.
pub struct EpaCorners<const C: usize> {
    pairs: [VertexPair; C],
    len: usize,
}

impl<const C: usize> EpaCorners<C> {
    /// No corners. All bytes are zero: codegen, see README.
    pub const EMPTY: Self = Self {
        pairs: [VertexPair { a: 0, b: 0 }; C],
        len: 0,
    };

    /// Copies the corners of a smaller buffer.
    pub fn copy_from<const M: usize>(&mut self, other: &EpaCorners<M>) {
        const { assert!(M <= C) };
        self.pairs[..M].copy_from_slice(&other.pairs);
        self.len = other.len;
    }

    /// Begins with the corners of a tetrahedron.
    pub fn start(&mut self, corners: &[Vertex; 4]) {
        self.len = 0;
        for corner in corners {
            self.push(corner.pair);
        }
    }

    /// Returns the number of corners for which there is room.
    #[inline(always)]
    pub fn room(&self) -> usize {
        C - self.len
    }

    /// Removes the last corner.
    #[inline(always)]
    pub fn pop(&mut self) {
        self.len -= 1;
    }

    /// Returns whether there is no room for another corner.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.len >= C
    }

    /// Adds a corner and returns its index.
    #[inline(always)]
    pub fn push(&mut self, pair: VertexPair) -> usize {
        let id = self.len.min(C - 1);
        self.pairs[id] = pair;
        self.len = id + 1;
        id
    }

    /// Returns a corner. `interior`: the interior point.
    #[inline(always)]
    pub fn vertex<const N: usize>(&self, set: &VertexSet<N>, interior: &Vec3, id: usize) -> Vertex {
        let pair = self.pairs[id.min(C - 1)];
        let w = if pair.is_interior() {
            *interior
        } else {
            set.difference(pair)
        };
        Vertex { w, pair }
    }
}

/// The surface of a polytope: its corners and its faces.
pub struct EpaSurface<const C: usize, const F: usize> {
    /// The faces.
    pub polytope: EpaPolytope<F>,
    /// The corners.
    pub corners: EpaCorners<C>,
}

/// The surface of most polytopes.
pub type SmallSurface = EpaSurface<SMALL_CORNERS, SMALL_FACES>;
/// The surface of large polytopes, on the stack.
pub type LargeSurface = EpaSurface<LARGE_CORNERS, LARGE_FACES>;

impl<const C: usize, const F: usize> EpaSurface<C, F> {
    /// No corners and no faces, for [`EpaSurface::copy_from`].
    pub const BLANK: Self = Self {
        corners: EpaCorners::EMPTY,
        polytope: EpaPolytope::BLANK,
    };

    /// Returns a surface without faces, for points of this size, metres.
    #[inline(always)]
    pub fn blank(size: f64) -> Self {
        Self {
            corners: EpaCorners::EMPTY,
            polytope: EpaPolytope::blank(size),
        }
    }

    /// Returns whether there is no polytope.
    pub fn is_blank(&self) -> bool {
        self.corners.len == 0
    }

    /// Begins with a tetrahedron. Returns whether its volume is above the rounding of points of this size, metres;
    /// otherwise the surface is unchanged. `is_exact`: see [`EpaPolytope::start`].
    #[inline(always)]
    pub fn start(&mut self, corners: &[Vertex; 4], size: f64, is_exact: bool) -> bool {
        let points = corners.each_ref().map(|v| v.w);
        let Some(tetrahedron) = Tetrahedron::new(points, f64::EPSILON * size) else {
            return false;
        };
        self.polytope.start(&tetrahedron, is_exact);
        self.corners.start(corners);
        true
    }

    /// Copies a smaller surface.
    pub fn copy_from<const D: usize, const G: usize>(&mut self, other: &EpaSurface<D, G>) {
        self.corners.copy_from(&other.corners);
        self.polytope.copy_from(&other.polytope);
    }

    /// Returns the corners of a face. `interior`: the interior point.
    #[inline(always)]
    pub fn face<const N: usize>(
        &self,
        set: &VertexSet<N>,
        interior: &Vec3,
        face: usize,
    ) -> [Vertex; 3] {
        let ids = self.polytope.corners(face);
        ids.map(|id| self.corners.vertex(set, interior, id))
    }
}

/// Buffers for the largest polytopes. All bytes zero is a valid value.
pub struct EpaBuffers {
    /// The vertices.
    pub set: VertexSet<ARENA_VERTICES>,
    /// The polytope.
    pub surface: EpaSurface<ARENA_CORNERS, ARENA_FACES>,
}

/// A source of [`EpaBuffers`], used once and only if a query needs them.
pub trait Arena {
    /// Returns buffers with any contents.
    ///
    /// # Errors
    /// [`Fault::NoMemory`].
    fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault>;
}
