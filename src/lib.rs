// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Penetration and distance queries for convex shapes that are given by support functions:
//! do they overlap, how deep, which way out, where; started warm from the last answer.
//!
//! (The package is called `warmccd`, the crate `ccd`, since it is also a `libccd.so`.)
//!
//! A [`Shape`] is a closure that answers a direction with the shape's point farthest along it, or
//! a type of the caller's. [`penetration`] is the call to begin with. A [`Warm`] state for each
//! pair, kept between frames, makes the next query cheap:
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
//! | you | call |
//! |---|---|
//! | want the depth | [`penetration`]: the least, within the larger of the tolerance and 0.1 % |
//! | need yes or no | [`intersect`] |
//! | need the distance, overlapping or not | [`signed_distance`] |
//! | need more than one contact point | [`contacts`] |
//! | follow one valley | [`penetration_local`] |
//! | need the minimum with its proof | [`penetration_proven`] |
//! | know the direction | [`penetration_along`] |
//! | live in a plane | [`penetration_planar`] |
//! | compare with the paper | [`penetration_incremental`] |
//! | wonder what is wrong with a shape | [`check`] |
//!
//! Lengths are metres. The names are those of the C header `ccd/warm.h`, in Rust's case, and the
//! answers the same bits; `include/README.md` says what each call guarantees. Nothing is global: a
//! query may run on any thread, and a shape may ask queries of its own.

#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison is how NaN ends a loop"
)]
#![allow(clippy::large_enum_variant, reason = "no heap")]
#![allow(
    clippy::unnecessary_cast,
    clippy::useless_conversion,
    reason = "conversions between Real and f64 are none in double precision"
)]

mod api;
mod contact;
#[allow(dead_code)]
mod contacts;
#[allow(dead_code)]
mod epa;
mod ffi;
mod gjk;
#[allow(dead_code)]
mod math;
#[allow(dead_code)]
mod minkowski;
#[allow(dead_code)]
mod mpr;
mod query;
#[cfg(test)]
#[path = "../c-tests/harness/shapes.rs"]
mod shapes;
#[allow(dead_code)]
mod state;

pub use api::{
    Check, Contact, Distance, DistanceOptions, Error, Manifold, Penetration, Real, Settings, Shape,
    Want, Warm, check, contacts, implementation, intersect, penetration, penetration_along,
    penetration_incremental, penetration_local, penetration_planar, penetration_proven,
    signed_distance,
};

/// What this package's own tests and benchmarks ask besides; may change in any version.
#[doc(hidden)]
pub mod internals {
    pub use crate::contact::Settings;
    pub use crate::math::Vec3;
    pub use crate::minkowski::support::MinkowskiDifference;
    pub use crate::mpr::gao::Until;
    pub use crate::mpr::gao::penetration as incremental;

    /// The exported functions, called as C calls them.
    pub mod ffi {
        pub use crate::ffi::{
            collide::*, paper::*, polytope::*, support::*, types::*, vec3::*, warm::*,
        };
    }
}

/// The program of a page is tested with the examples here.
#[cfg(doctest)]
#[doc = include_str!("../include/README.md")]
mod readme {}
