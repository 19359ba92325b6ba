// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The intersection test, the distance, and the proof that D contains the origin: the GJK algorithm on
//! known vertices.
//!
//! | file | what it owns |
//! |---|---|
//! | [`simplex`] | the simplex and its closest feature |
//! | [`intersect`] | yes or no; the proof of an overlap from known vertices |
//! | [`separating_axis`] | the axis of a pair that stays apart |
//! | [`closest_points`] | the distance between bounds |
//! | [`signed_distance`] | margins, and one function through the touch |
//! | [`barycentric`] | the closest point of a segment, a triangle, a tetrahedron |

pub mod barycentric;
pub mod closest_points;
pub mod intersect;
pub mod separating_axis;
pub mod signed_distance;
pub mod simplex;
