// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Extends libccd's ccd.h by queries that start warm: from the result of the pair's last query.
//! cbindgen makes include/ccd/warm.h from src/ffi/warm/; edit there.
//!
//! Start with ccdPenetration and one ccd_warm_t for each pair, zeroed at first and kept between
//! frames. The sections:
//!
//!   codes        returned by every call that fills a struct
//!   states       ccd_warm_t, ccdWarmGuess, ccdWarmFlip
//!   flags        CCD_WANT_: outputs that are computed only if they are requested
//!   penetration  ccdPenetration: overlap, depth, direction, contact position
//!   overlap      ccdIntersect
//!   distance     ccdSignedDistance
//!   contacts     ccdContacts
//!   special      ccdPenetrationLocal, ...Proven, ...Along, ...Planar
//!   libccd       ccdMPRPenetrationWarm, ccdMPRIntersectWarm
//!   check        ccdCheck: tests a support function
//!   identity     ccdImplementation
//!
//! A support point is a boundary point of the Minkowski difference D = obj1 - obj2: one call of
//! support1 along a direction and one of support2 along its opposite. A depth is sound if moving obj2
//! by depth * dir separates the objects; it may exceed the least depth. A cold start begins along the
//! line of the centers if both are given, else along first_dir, else along (1, 0, 0): in this header
//! center1, center2 and first_dir may be NULL except where stated. A center that is given must lie
//! in its object.
//!
//! Lengths and tolerances are metres. Tolerances are raised to a few units in the last place of the
//! coordinates, so 0 selects the smallest, and lowered to 2.5e-4 of the size of D, which is max |p|
//! for p in D. A call reads only the tolerance that it names. max_iterations limits the support
//! points after the first tetrahedron or portal (in ccdPenetrationPlanar the portal steps). The
//! library's own limits are 160, 320 for ...Proven, ...Along and ...Planar, 380 for distances; no
//! query takes more than 500 support points in the tests. Object pointers are passed to the callbacks
//! and never dereferenced. Queries are re-entrant and keep no data except the caller's state.
//!
//! C++ exceptions and longjmp pass from a callback through every call. Out of a proof of more than some
//! 160 support points (ccdPenetrationProven, ccdSignedDistance, libccd's GJK penetration and separation)
//! they leak its one block of malloc, 99 KB.
//!
//! All statements assume convex objects and support functions that return a farthest point. If points
//! of a support function contradict each other, depth is sound only for the points that it returned,
//! and status may be CCD_STATUS_INCONSISTENT_SUPPORT; ccdCheck finds such faults.

use super::types::ccd_vec3_t;
use crate::math::Vec3;

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
pub mod want;

pub use {
    check::*, codes::*, contacts::*, distance::*, identity::*, intersect::*, libccd::*,
    penetration::*, special::*, state::*, want::*,
};

/// Returns the caller's direction; zero, which is no direction, where `dir` is NULL.
///
/// # Safety
/// \[inputs\] of the module contract.
unsafe fn direction(dir: *const ccd_vec3_t) -> Vec3 {
    // SAFETY: [inputs].
    unsafe { dir.as_ref() }.copied().unwrap_or_default().into()
}
