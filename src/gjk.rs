// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Apart or not, how far, and the proof of an overlap: the distance algorithm (Gilbert,
//! Johnson and Keerthi 1988) and what stands on it.
//!
//! [`simplex`] is its step, on [`barycentric`]; [`overlap`] asks for yes or no, [`distance`] for how
//! far; [`proof`] for the overlap behind a depth that another search found. [`separation`] and
//! [`intersect`] are these with memory, [`signed_distance`] is the query with margins.
//! Called by [`crate::query`], and for a proof by [`crate::hull`] and [`crate::local`].

pub mod barycentric;
pub mod distance;
pub mod intersect;
pub mod overlap;
pub mod proof;
pub mod separation;
pub mod signed_distance;
pub mod simplex;
