// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Distance: gap or depth.

use core::ffi::{c_int, c_uint, c_ulong, c_void};

use super::super::callbacks::QueryArgs;
use super::super::run::fill;
use super::super::types::{ccd_t, ccd_vec3_t};
use super::state::ccd_warm_t;
use crate::math::Real;
use crate::query::Solver;
use crate::query::signed_distance::DistanceOptions;
use crate::types::{Distance, Solution};

/// Result of ccdSignedDistance. A field that was not requested is zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_distance_t {
    /// Proven lower bound of the signed distance, metres: the gap along normal where the objects
    /// are apart, minus the depth where they overlap.
    pub distance: Real,
    /// Proven upper bound of the signed distance, metres: |point1 - point2| where the objects are
    /// apart, minus the lower bound of the depth where they overlap. distance_upper - distance <=
    /// dist_tolerance unless CCD_LIMIT was returned or distance > max_distance.
    pub distance_upper: Real,
    /// Unit, from obj1 to obj2: moving obj2 along it increases the distance.
    pub normal: ccd_vec3_t,
    /// Witness point on the surface of obj1 with its margin, CCD_WANT_POINTS.
    pub point1: ccd_vec3_t,
    /// Witness point on the surface of obj2 with its margin, CCD_WANT_POINTS.
    pub point2: ccd_vec3_t,
    /// Number of support points: half of the calls of support1 and support2 together, rounded up.
    pub support_points: c_ulong,
    /// Number of iterations of the solver.
    pub iterations: c_ulong,
    /// Why the search ended: a CCD_STATUS_ value.
    pub status: c_int,
}

impl From<Solution> for ccd_distance_t {
    fn from(found: Solution) -> Self {
        let found = Distance::from(found);
        Self {
            distance: found.distance,
            distance_upper: found.distance_upper,
            normal: found.normal.into(),
            point1: found.point1.into(),
            point2: found.point2.into(),
            support_points: found.support_points as c_ulong,
            iterations: found.iterations as c_ulong,
            status: found.status as c_int,
        }
    }
}

/// Computes the signed distance: the gap of objects that are apart, minus the penetration depth of
/// objects that overlap; continuous at contact.
///
/// `margin1`, `margin2`: metres, >= 0; radii of balls added all around the objects, whose support
/// functions return the cores (a sphere is a point with a margin, a capsule a segment, a rounded box
/// a box). The signed distance is that of the cores minus both margins, exactly. `max_distance`:
/// metres, >= 0; the search ends when the distance is proven to be greater, never with INFINITY.
/// `warm`: may be NULL. `want`: CCD_WANT_POINTS or 0; CCD_WANT_POS has no effect.
///
/// Reads dist_tolerance. Allocates only if the cores overlap and their least depth is (nearly) not
/// unique, as for concentric spheres.
///
/// Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding with distance 0; *out is
/// filled), CCD_LIMIT (the bounds have not met), CCD_BAD_INPUT or CCD_NO_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdSignedDistance(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    margin1: Real,
    margin2: Real,
    max_distance: Real,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_distance_t,
) -> c_int {
    let args = QueryArgs { obj1, obj2, ccd };
    let options = DistanceOptions {
        margin1,
        margin2,
        max_distance,
    };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { fill(args, Solver::Distance(options), warm, want, out) }
}
