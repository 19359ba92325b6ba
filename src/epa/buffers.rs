// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The buffers of the global query, in three sizes: the vertices of the objects, and the polytope. Full buffers are copied
//! to larger ones: from the small ones, on the stack, to the large ones, on the stack in a frame of their own, to those of
//! an [`Arena`].

use crate::epa::direction::MAX_REFINEMENTS;
use crate::epa::polytope::{EpaPolytope, MAX_FACES};
use crate::minkowski::support::Fault;
use crate::minkowski::vertex_set::VertexSet;

/// The limit of support points of a default query, up to the end of its polytope.
pub const MAX_DEFAULT_POINTS: u64 = 160;
/// The limit of support points of a query that proves the tolerance, up to the end of its polytope; of a ray; and of the
/// published method.
///
/// Derived: 400 support points in all, less 80. Measured (`cargo run --release -p lab --bin campaigns -- wide`): up to 80, on
/// nearly coincident bodies, are evaluated beyond this limit, for starts of the polytope that do not contain the origin yet
/// and in the local search that follows ([`MAX_WALK_POINTS`](crate::local::MAX_WALK_POINTS)). The tests fail at the numbers
/// of `call_limit` in c-tests/tests/stability/entries.h: 400 for a ray and the published method, 500 for proofs.
///
/// Minima that the limit leaves unproven, of round bodies that are nearly concentric: around the minimum of a ball of radius ρ
/// whose center is e from the origin, a face at the angle α may have a circumradius of at most α √(ρ e), so that a polytope that
/// proves it within a gap has at least 2.4 ρ / e · ln(π / √(2 gap / e)) corners: 270 at e = 0.1 ρ = 0.1 m and 1e-10 m. Measured:
/// the expansion takes 1.4 to 2.1 times as many (167 at e = 0.2 m and 1e-8 m), so that balls up to e = 0.11 ρ are not proven to
/// 1e-8 ρ, and up to 0.16 ρ not to 1e-10 ρ.
///
/// Queries without a polytope have
/// [`ITERATION_CAP`](crate::math::ITERATION_CAP).
pub const MAX_PROVEN_POINTS: u64 = 320;

/// The number of vertices of the small buffers, 6 KB on the stack with their faces: enough for shallow contacts and most
/// polytopes, and for the directions of a refinement. (Larger ones are full only at the limit, where none follows.)
pub const SMALL_VERTICES: usize = 24 + MAX_REFINEMENTS;
/// The number of faces of the small buffers.
pub const SMALL_FACES: usize = 64;
/// The number of vertices of the large buffers, on the stack.
pub const LARGE_VERTICES: usize = MAX_DEFAULT_POINTS as usize + START_VERTICES;
/// The number of faces of the large buffers: what 44 KB of stack leave (test `costs`), less some 800 bytes, because the
/// compiler's frames differ by about a hundred with the folder in which the library is built.
pub const LARGE_FACES: usize = 336;
/// The number of vertices of the buffers of an [`Arena`].
const ARENA_VERTICES: usize = MAX_PROVEN_POINTS as usize + START_VERTICES;
/// The number of faces of these buffers: for as many known differences as vertices, two faces a corner.
const ARENA_FACES: usize = (4 * ARENA_VERTICES).next_multiple_of(16);
/// The number of entries that a start of the polytope adds to the vertex set: the corners of a tetrahedron. So much room
/// is kept above the limit of support points too, which applies only while the origin is inside the polytope.
pub const START_VERTICES: usize = 4;

// See EpaPolytope::has_room.
const _: () = assert!(LARGE_FACES > 2 * LARGE_VERTICES && ARENA_FACES <= MAX_FACES);
const _: () = assert!(START_VERTICES < SMALL_VERTICES);

/// Buffers for the largest polytopes. All bytes zero is a valid value.
pub struct EpaBuffers {
    /// The vertices.
    pub set: VertexSet<ARENA_VERTICES>,
    /// The polytope.
    pub polytope: EpaPolytope<ARENA_FACES>,
}

/// A source of [`EpaBuffers`], used only if a query needs them.
pub trait Arena {
    /// Returns buffers with any contents.
    ///
    /// # Errors
    /// [`Fault::NoMemory`].
    fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault>;
}
