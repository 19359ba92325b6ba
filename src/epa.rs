// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, with a certificate: the expanding polytope algorithm (EPA)
//! on known vertices.
//!
//! | file | contents |
//! |---|---|
//! | [`global_minimum`] | the driver; its head lists the steps of the global query |
//! | [`expand`] | the loop that expands the polytope |
//! | [`buffers`] | the buffers of both, in three sizes |
//! | [`direction`] | the last refinement of the direction of a result |
//! | [`witness`] | the witness points of the upper bound |
//! | [`polytope`] | the polytope: insertion of points, closest face, error bound; no support calls |

pub mod buffers;
pub mod direction;
pub mod expand;
pub mod global_minimum;
pub mod polytope;
pub mod witness;
