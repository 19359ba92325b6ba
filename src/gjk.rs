// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Apart or not, how far, and the proof of an overlap: the distance algorithm (Gilbert,
//! Johnson and Keerthi 1988) and what stands on it.
//!
//! Called by the queries of [`crate::query`], and for a proof by [`crate::hull`] and
//! [`crate::local`]. [`barycentric`] serves all.

pub mod barycentric;
pub mod distance;
pub mod intersect;
pub mod proof;
pub mod separation;
pub mod signed_distance;
