// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! libccd's penetration queries for convex objects given by support mappings:
//! overlap, depth, direction, position; started warm from the last answer.
//!
//! An object is any function that answers a direction with the object's point farthest
//! along it. A [`query::Pair`] of them is asked, and leaves what it learnt in a
//! [`state::State`] for the next query of the same pair:
//!
//! ```
//! use ccd::contact::{Answer, Settings};
//! use ccd::math::Vec3;
//! use ccd::query::Pair;
//! use ccd::state::State;
//! use ccd::known::support::MinkowskiDifference;
//!
//! let ball = |at: Vec3| move |dir: &Vec3| at + dir; // of radius 1
//! let pair = Pair {
//!     md: MinkowskiDifference::new(ball(Vec3::zeros()), ball(Vec3::new(1.5, 0.0, 0.0))),
//!     centre: None,
//!     first_dir: Some(Vec3::new(1.0, 0.5, 0.0)),
//!     lasting: true,
//! };
//! let settings = Settings { tolerance: 1e-5, max_iterations: 1000 };
//! let mut state = State::default(); // cold
//! match pair.local(&mut state, &settings, true) {
//!     Ok(Answer::Hit(hit)) => assert!((hit.depth - 0.5).abs() < 1e-4),
//!     other => panic!("the balls overlap by 0.5: {other:?}"),
//! }
//! ```
//!
//! The C interface is in `ffi`; everything else is safe Rust that never allocates and
//! never sees C. The modules that are not shown here are the solvers: `src/README.md`
//! says in which order to read them. They are public for this package's own tests and
//! may change in any version.

#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison is how NaN ends a loop"
)]
#![allow(clippy::large_enum_variant, reason = "no heap")]
#![allow(
    rustdoc::private_intra_doc_links,
    reason = "solvers are explained to who reads their source"
)]

pub mod contact;
#[doc(hidden)]
pub mod contacts;
#[doc(hidden)]
pub mod ffi;
#[doc(hidden)]
pub mod gjk;
#[doc(hidden)]
pub mod hull;
pub mod known;
#[doc(hidden)]
pub mod local;
pub mod math;
#[doc(hidden)]
pub mod paper;
pub mod query;
#[cfg(test)]
mod shapes;
pub mod state;
