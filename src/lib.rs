// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Penetration and distance queries for convex shapes given by support functions: overlap, depth,
//! direction and contact position, with warm starts from the last result of a pair.
//!
//! The package is called `warmccd`, the crate `ccd`, because it also builds `libccd.so`.
//!
//! A [`Shape`] has a support function, which returns a point of the shape farthest along a direction:
//! one of [`shapes`], a closure, or a type of the caller. [`penetration`] is the default call. With a [`Warm`] state for
//! each pair, kept between frames, the next query of the pair takes fewer support calls:
//!
//! ```
//! use ccd::{Real, Settings, Warm, shapes::Posed};
//!
//! let a = Posed::sphere(1.0);
//! let mut warm = Warm::default(); // cold
//! for frame in 0..3 {
//!     let b = a.at([0.3 + 0.01 * frame as Real, 0.2, 0.1]);
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
//! | whether the shapes overlap | [`intersect`] |
//! | signed distance | [`signed_distance`] |
//! | several contact points | [`contacts`] |
//! | a local minimum of the depth, from a guess | [`penetration_local`] |
//! | least depth with a certificate | [`penetration_proven`] |
//! | depth along a given direction | [`penetration_along`] |
//! | depth of shapes in a common plane | [`penetration_planar`] |
//! | depth by W. Gao's method as published | [`penetration_incremental`] |
//! | detected faults of a shape's support function and center | [`check`] |
//!
//! Lengths are metres. Names are those of the C header `ccd/warm.h`, in Rust's style, and results have
//! the same bits as in C; `include/README.md` lists the guarantees of each call. There is no global
//! state: queries may run on any thread, and a shape may run queries itself.

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

mod along;
mod api;
mod contact;
mod epa;
mod ffi;
mod geometry;
mod gjk;
#[cfg(test)]
#[path = "../c-tests/harness/ladder.rs"]
mod ladder;
mod local;
mod math;
mod minkowski;
mod paper {
    pub mod gao;
}
mod portal;
mod query;
pub mod shapes;
#[cfg(test)]
#[path = "../c-tests/harness/shapes.rs"]
mod test_shapes;
mod trace;
mod types;

pub use api::{
    Check, Contact, Distance, DistanceOptions, Error, ManifoldCache, Penetration, Real, Settings,
    Shape, Status, Warm, check, contacts, implementation, intersect, penetration,
    penetration_along, penetration_incremental, penetration_local, penetration_planar,
    penetration_proven, signed_distance,
};

/// Internals for this package's own tests and benchmarks; they may change in any version.
#[doc(hidden)]
pub mod internals {
    pub use crate::math::Vec3;
    pub use crate::minkowski::support::Difference;
    pub use crate::paper::gao::Until;
    pub use crate::paper::gao::incremental_minimum as incremental;
    pub use crate::types::Settings;

    /// The exported C functions.
    pub mod ffi {
        pub use crate::ffi::{collide::*, paper::*, polytope::*, types::*, vec3::*, warm::*};
    }
}

/// Runs the Rust program of `include/README.md` as a test.
#[cfg(doctest)]
#[doc = include_str!("../include/README.md")]
mod readme {}
