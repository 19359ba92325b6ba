// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Penetration and distance queries for convex shapes that are given by support functions: overlap,
//! depth, direction, contact position; with warm starts from the last result.
//!
//! The package is called `warmccd`, the crate `ccd`, since it is also a `libccd.so`.
//!
//! A [`Shape`] is a support function: a closure that returns the shape's point farthest along a
//! direction, or a type of the caller's. [`penetration`] is the default call. A [`Warm`] state for
//! each pair, kept between frames, makes the next query cheap:
//!
//! ```
//! use ccd::{Real, Settings, Warm};
//!
//! // A ball of radius 1, and a point inside it.
//! let ball = |at: [Real; 3]| (move |d: [Real; 3]| [at[0] + d[0], at[1] + d[1], at[2] + d[2]], at);
//! let mut warm = Warm::default(); // cold
//! for frame in 0..3 {
//!     let (a, b) = (ball([0.0; 3]), ball([0.3 + 0.01 * frame as Real, 0.2, 0.1]));
//!     if let Some(hit) = ccd::penetration(&a, &b, &Settings::new(1e-6), Some(&mut warm))? {
//!         println!("move b by {} along {:?}", hit.depth, hit.dir);
//!     }
//! }
//! # Ok::<(), ccd::Error>(())
//! ```
//!
//! | result | call |
//! |---|---|
//! | least depth, within the larger of the tolerance and 0.1 % | [`penetration`] |
//! | overlap: yes or no | [`intersect`] |
//! | signed distance | [`signed_distance`] |
//! | several contact points | [`contacts`] |
//! | a local minimum of the depth, from a guess | [`penetration_local`] |
//! | least depth with a certificate | [`penetration_proven`] |
//! | depth along a given direction | [`penetration_along`] |
//! | depth of shapes in a common plane | [`penetration_planar`] |
//! | depth by W. Gao's method as published | [`penetration_incremental`] |
//! | faults of a shape's support function | [`check`] |
//!
//! Lengths are metres. The names are those of the C header `ccd/warm.h`, in Rust's case, and the
//! results the same bits; `include/README.md` lists the guarantees of each call. There is no global
//! state: queries may run on any threads, and a shape may run queries itself.

#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison ends a loop at NaN"
)]
#![allow(clippy::large_enum_variant, reason = "no heap")]
#![allow(
    clippy::unnecessary_cast,
    clippy::useless_conversion,
    reason = "Real is f64 in double precision"
)]

mod api;
mod contact;
mod epa;
mod ffi;
mod gjk;
mod math;
mod minkowski;
mod mpr;
mod query;
#[cfg(test)]
#[path = "../c-tests/harness/shapes.rs"]
mod shapes;

pub use api::{
    Check, Contact, Distance, DistanceOptions, Error, ManifoldCache, Penetration, Real, Settings,
    Shape, Want, Warm, check, contacts, implementation, intersect, penetration, penetration_along,
    penetration_incremental, penetration_local, penetration_planar, penetration_proven,
    signed_distance,
};

/// Exports internals to this package's own tests and benchmarks; may change in any version.
#[doc(hidden)]
pub mod internals {
    pub use crate::contact::Settings;
    pub use crate::math::Vec3;
    pub use crate::minkowski::support::MinkowskiDifference;
    pub use crate::mpr::gao::Until;
    pub use crate::mpr::gao::penetration as incremental;

    /// The exported C functions.
    pub mod ffi {
        pub use crate::ffi::{
            collide::*, paper::*, polytope::*, support::*, types::*, vec3::*, warm::*,
        };
    }
}

/// Tests the Rust program of that page.
#[cfg(doctest)]
#[doc = include_str!("../include/README.md")]
mod readme {}
