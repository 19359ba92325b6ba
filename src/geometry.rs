// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Plane and solid geometry: no callbacks, no tolerances of its own.
//!
//! | file | contents |
//! |---|---|
//! | [`barycentric`] | the closest point of a segment, a triangle or a tetrahedron |
//! | [`plane`] | planes and tetrahedra with their rounding errors |
//! | [`polygon`] | convex polygons in a plane: clipping, reduction |
//! | [`fixed_vec`] | a list of at most N elements, without heap |

pub mod barycentric;
pub mod fixed_vec;
pub mod plane;
pub mod polygon;
