// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's penetration queries for convex objects given by support mappings:
//! overlap, depth, direction, position; started warm from the last answer.
//!
//! The C interface lives in [`ffi`]; everything else is safe Rust that never
//! allocates and never sees C.

#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison is how NaN ends a loop"
)]
#![allow(clippy::large_enum_variant, reason = "no heap")]

pub mod barycentric;
pub mod bundle;
pub mod contact;
pub mod contact_manifold;
pub mod distance;
pub mod expansion;
pub mod ffi;
pub mod gjk;
pub mod global;
pub mod intersect;
pub mod local;
pub mod math;
pub mod patch;
pub mod planar;
pub mod plane;
pub mod polygon;
pub mod polytope;
pub mod portal;
pub mod precision;
#[cfg(test)]
mod shapes;
pub mod signed_distance;
pub mod simplex;
pub mod start;
pub mod support;
pub mod support_set;
pub mod warm;
