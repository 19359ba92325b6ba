// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The intersection test, the closest points, and the proof that D contains the origin: the GJK algorithm
//! on known vertices ([`crate::minkowski`]).
//!
//! | file | contents |
//! |---|---|
//! | [`simplex`] | the simplex and its closest feature to the origin |
//! | [`overlap`] | the intersection test; the proof of an overlap from known vertices |
//! | [`closest_points`] | the distance, with a lower and an upper bound, and the closest points |

pub mod closest_points;
pub mod overlap;
pub mod simplex;
