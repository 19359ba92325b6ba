// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What this library adds to libccd's ccd.h: queries that start from a pair's last answer.
//! Made by cbindgen from src/ffi/warm/; edit there.
//!
//! To begin with: one ccd_warm_t a pair, kept between frames, all bytes zero at first, and
//! ccdPenetration. Then, from here to the end:
//!
//!   codes      what every call that fills a struct returns
//!   states     ccd_warm_t, ccdWarmGuess, ccdWarmFlip
//!   the one    ccdPenetration: do they overlap, how deep, which way out, where
//!   yes or no  ccdIntersect
//!   distance   ccdSignedDistance
//!   contacts   ccdContacts
//!   special    ccdPenetrationLocal, ...Proven, ...Along, ...Planar
//!   libccd's   ccdMPRPenetrationWarm, ccdMPRIntersectWarm
//!   is it odd? ccdCheck: what is wrong with a support function
//!
//! Lengths and tolerances are metres; the library floors tolerances at a few ulps of the objects'
//! size, so 0 asks for the best the precision can give. A call reads the one tolerance that it
//! names. Object pointers are handed to the callbacks and never looked at. A query is re-entrant
//! and keeps nothing but the state that the caller hands it.

use super::types::ccd_vec3_t;
use crate::math::{Vec3, unit};

pub mod check;
pub mod codes;
pub mod contacts;
pub mod distance;
pub mod identity;
pub mod intersect;
pub mod libccd;
pub mod penetration;
pub mod special;
pub mod state;

pub use {
    check::*, codes::*, contacts::*, distance::*, identity::*, intersect::*, libccd::*,
    penetration::*, special::*, state::*,
};

/// # Safety
/// \[inputs\] of the module contract.
unsafe fn unit_of(dir: *const ccd_vec3_t) -> Option<Vec3> {
    // SAFETY: [inputs].
    unit(&unsafe { *dir.as_ref()? }.into())
}
