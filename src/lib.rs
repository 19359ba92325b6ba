// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's penetration queries for convex objects given by support mappings:
//! overlap, depth, direction, position; started warm from the last answer.
//!
//! The C interface lives in [`ffi`]; everything else is safe Rust that never
//! allocates and never sees C.

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod contact;
pub mod ffi;
pub mod math;
pub mod nearest;
pub mod support;
