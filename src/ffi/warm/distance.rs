// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Distance: gap or depth.

use core::ffi::{c_int, c_uint, c_ulong, c_void};

use super::super::arena::LargeBuffers;
use super::super::callbacks::{QueryArgs, QueryKind};
use super::super::run::code_of;
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_BAD_INPUT, CCD_HIT, CCD_LIMIT, CCD_MISS};
use super::penetration::{CCD_WANT_ALL, CCD_WANT_POINTS, point_if};
use super::state::{ccd_warm_t, read, store};
use crate::math::{Real, lower_to_real};
use crate::minkowski::support_query::Stop;
use crate::query::signed_distance::{Distance, Margins};
use crate::types::{Status, Want};

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

impl ccd_distance_t {
    fn new(distance: &Distance, want: c_uint, supports: u64) -> Self {
        Self {
            distance: lower_to_real(distance.lower),
            distance_upper: -lower_to_real(-distance.upper),
            normal: distance.normal.into(),
            point1: point_if(want & CCD_WANT_POINTS, &distance.point1),
            point2: point_if(want & CCD_WANT_POINTS, &distance.point2),
            support_points: supports as c_ulong,
            iterations: distance.iterations as c_ulong,
            status: distance.status as c_int,
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
/// `warm`: may be NULL. `want`: CCD_WANT_POINTS or 0.
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
    let is_valid = margin1 >= 0.0
        && margin2 >= 0.0
        && max_distance >= 0.0
        && margin1 + margin2 < Real::INFINITY;
    if out.is_null() || want & !CCD_WANT_ALL != 0 || !is_valid {
        return CCD_BAD_INPUT;
    }
    let margins = Margins {
        margin1: margin1.into(),
        margin2: margin2.into(),
        max_distance: max_distance.into(),
    };
    // SAFETY: the caller's guarantees are those of the callees; [outputs].
    unsafe {
        let args = QueryArgs { obj1, obj2, ccd };
        let wanted = Want {
            pos: false,
            points: want & CCD_WANT_POINTS != 0,
        };
        let kind = QueryKind::Distance;
        let settings = args.settings(kind);
        let Some(pair) = settings.and_then(|settings| args.pair(kind, settings, wanted)) else {
            return CCD_BAD_INPUT;
        };
        let (mut state, mut buffers) = (read(warm), LargeBuffers::default());
        let found = pair.signed_distance(&margins, &mut state, &mut buffers);
        buffers.free();
        let distance = match found {
            Ok(distance) => distance,
            Err(fault) => return code_of(&Stop::Fault(fault)),
        };
        store(warm, &state);
        *out = ccd_distance_t::new(&distance, want, pair.difference.supports());
        match (distance.status, distance.is_hit) {
            (Status::Converged, true) => CCD_HIT,
            (Status::Converged, false) => CCD_MISS,
            _ => CCD_LIMIT,
        }
    }
}
