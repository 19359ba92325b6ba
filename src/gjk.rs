// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The intersection test, the signed distance, and the proof that D contains the origin: the GJK algorithm
//! on known vertices ([`crate::minkowski`]).
//!
//! | file | contents |
//! |---|---|
//! | [`simplex`] | the simplex and its closest feature to the origin |
//! | [`intersect`] | the intersection test; the proof of an overlap from known vertices |
//! | [`separating_axis`] | the axis test for separated pairs |
//! | [`closest_points`] | the distance, with a lower and an upper bound, and the closest points |
//! | [`signed_distance`] | the signed distance of objects with margins |
//! | [`barycentric`] | the closest point of a segment, a triangle or a tetrahedron |

pub mod barycentric;
pub mod closest_points;
pub mod intersect;
pub mod separating_axis;
pub mod signed_distance;
pub mod simplex;
