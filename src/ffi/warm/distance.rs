// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Distance: how far apart, or how deep.

use core::ffi::{c_int, c_uint, c_ulong, c_void};

use super::super::arena;
use super::super::callbacks::{Call, Query};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_BAD_INPUT, CCD_HIT, CCD_LIMIT, CCD_MISS};
use super::penetration::{CCD_WANT_ALL, CCD_WANT_POINTS, given};
use super::state::{ccd_warm_t, with_state};
use crate::contact::Settings;
use crate::gjk::signed_distance::{Distance, Wanted};
use crate::math::{Real, lower_to_real};
use crate::query::{Pair, warm_start::WarmStart};

/// What ccdSignedDistance answers. What was not wanted is zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_distance_t {
    /// Metres: the gap along normal where the objects are apart, minus the depth where they
    /// overlap. Never more than the true signed distance: obj2 may come nearer by it.
    pub distance: Real,
    /// Metres, never less than the true signed distance: apart |point1 - point2|, overlapping
    /// minus the least depth proven. distance_upper - distance <= dist_tolerance unless
    /// CCD_LIMIT was returned or distance > max_distance.
    pub distance_upper: Real,
    /// Unit, from obj1 to obj2: the way obj2 moves to be farther.
    pub normal: ccd_vec3_t,
    /// Witness point on the surface of obj1 with its margin; CCD_WANT_POINTS.
    pub point1: ccd_vec3_t,
    /// Witness point on the surface of obj2 with its margin; CCD_WANT_POINTS.
    pub point2: ccd_vec3_t,
    /// Half of the calls of support1 and support2 together, rounded up: a support point of the
    /// Minkowski difference is one call of each. Positions need further calls of one alone.
    pub support_calls: c_ulong,
    /// Iterations of the solver.
    pub iterations: c_ulong,
}

impl ccd_distance_t {
    fn new(distance: &Distance, want: c_uint, supports: u64) -> Self {
        Self {
            distance: lower_to_real(distance.lower),
            distance_upper: -lower_to_real(-distance.upper),
            normal: distance.normal.into(),
            point1: given(want & CCD_WANT_POINTS, &distance.point1),
            point2: given(want & CCD_WANT_POINTS, &distance.point2),
            support_calls: supports as c_ulong,
            iterations: distance.iterations as c_ulong,
        }
    }
}

/// How far apart, or how deep: one continuous function through the touch.
///
/// margin1, margin2, metres, >= 0: the objects are meant with a ball of that radius added all
/// around, and the support functions give the cores. (A sphere is a point with a margin, a
/// capsule a segment, a rounded box a box.) The signed distance is the cores' minus both
/// margins, overlapping cores included.
///
/// `max_distance`, metres, >= 0: the search ends as soon as the distance is known to be greater.
/// INFINITY: it is always refined. Reads dist_tolerance. center1, center2 and first_dir may
/// be NULL. `warm` may be NULL. `want`: CCD_WANT_POINTS; 0 saves support points where objects
/// overlap. Takes no memory from malloc while the cores are apart.
///
/// Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding, whose distance is
/// 0; *out is filled) or CCD_LIMIT (the bounds are still open); CCD_BAD_INPUT, or CCD_NO_MEMORY
/// (cores that overlap only).
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
    let margins = margin1 + margin2;
    // Negated for NaN.
    let given = margin1 >= 0.0 && margin2 >= 0.0 && max_distance >= 0.0 && margins < Real::INFINITY;
    if out.is_null() || want & !CCD_WANT_ALL != 0 || !given {
        return CCD_BAD_INPUT;
    }
    let query = Query { obj1, obj2, ccd };
    // SAFETY: [inputs], [outputs]; passed on.
    unsafe {
        let Some((pair, settings)) = query.ready(Call::Distance, !warm.is_null()) else {
            return CCD_BAD_INPUT;
        };
        let wanted = Wanted {
            margin1: margin1.into(),
            margin2: margin2.into(),
            max_distance: max_distance.into(),
            settings,
        };
        let points = want & CCD_WANT_POINTS != 0;
        let minimum =
            |pair: &Pair<_, _>, state: &mut WarmStart, settings: &Settings, hit: &mut _| {
                arena::with(|arena| pair.minimum(state, settings, arena, points, hit))
            };
        with_state(warm, |state| {
            let distance = pair.signed_distance(state, &wanted, minimum)?;
            *out = ccd_distance_t::new(&distance, want, pair.md.supports());
            Ok(match (distance.is_limited, distance.is_hit) {
                (true, _) => CCD_LIMIT,
                (false, true) => CCD_HIT,
                (false, false) => CCD_MISS,
            })
        })
    }
}
