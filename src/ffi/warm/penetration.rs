// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The one call to begin with: do two objects overlap, how deep, which way out, where?

use core::ffi::{c_int, c_uint, c_ulong, c_void};

use super::super::callbacks::{Call, Object, Query};
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::{CCD_BAD_INPUT, CCD_HIT, CCD_LIMIT, CCD_MISS};
use super::state::{ccd_warm_t, with_state};
use crate::contact::{Penetration, Settings};
use crate::math::{Real, Vec3, lower_to_real};
use crate::minkowski::query::{Stop, if_overlapping};
use crate::query::{Pair, warm_start::WarmStart};

/// Wanted: pos. It costs 2 to 4 support points, 8 at most where a face has more than four corners, none
/// where a state shows that nothing has moved (ccdPenetration, ccdPenetrationProven). For it the objects
/// are asked one by one.
pub const CCD_WANT_POS: c_uint = 1;
/// Wanted: point1 and point2. They cost nothing.
pub const CCD_WANT_POINTS: c_uint = 2;
/// Everything.
pub const CCD_WANT_ALL: c_uint = 3;

/// What a penetration query answers. What was not wanted is zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_penetration_t {
    /// Metres, >= 0: moving obj2 by depth * dir separates the objects. It is the support
    /// value of normal, divided by dir . normal.
    pub depth: Real,
    /// Proven lower bound on the global minimum depth (in ccdPenetrationAlong: on the
    /// depth along dir), metres; 0 where none was proven.
    pub depth_lower: Real,
    /// Unit; the way obj2 moves.
    pub dir: ccd_vec3_t,
    /// Unit; normal of the separating plane. Equal to dir except in ccdPenetrationAlong.
    pub normal: ccd_vec3_t,
    /// Contact position, CCD_WANT_POS: the centre of pressure, which is the centroid of the volume
    /// that the objects share, but for its height along normal. It moves as the objects do, where
    /// a deepest point jumps from corner to corner. For objects of a quarter metre that are no deeper
    /// than a millimetre it is off by 3 mm (boxes) to 7 mm (round ones) at most, a cone on its side by
    /// 15 mm, root mean square; deeper, by 3 % of the smaller object's size where the depth is 3 % of
    /// that, 6 % at 10 %, 20 % at 30 %. Of CCD_LIMIT, and of ccdPenetrationAlong and
    /// ccdPenetrationPlanar, the middle of the witness points.
    pub pos: ccd_vec3_t,
    /// Witness point of obj1, CCD_WANT_POINTS, at the deepest place: a point of obj1, and of its
    /// supporting plane, each to within what the depth may be off, or 1e-12 of the size (in single
    /// precision 1e-5).
    pub point1: ccd_vec3_t,
    /// Witness point of obj2, the same.
    pub point2: ccd_vec3_t,
    /// Half of the calls of support1 and support2 together, rounded up: a support point of the
    /// Minkowski difference is one call of each. Positions need further calls of one alone.
    pub support_calls: c_ulong,
    /// Iterations of the solver.
    pub iterations: c_ulong,
}

/// A point where its flag is set, else zero.
pub(in crate::ffi) fn given(flag: c_uint, point: &Vec3) -> ccd_vec3_t {
    match flag {
        0 => ccd_vec3_t::default(),
        _ => (*point).into(),
    }
}

impl ccd_penetration_t {
    fn new(hit: &Penetration, want: c_uint, supports: u64) -> Self {
        Self {
            depth: hit.depth as Real,
            depth_lower: lower_to_real(hit.depth_lower),
            dir: hit.dir.into(),
            normal: hit.normal.into(),
            pos: given(want & CCD_WANT_POS, &hit.pos),
            point1: given(want & CCD_WANT_POINTS, &hit.point1),
            point2: given(want & CCD_WANT_POINTS, &hit.point2),
            support_calls: supports as c_ulong,
            iterations: hit.iterations as c_ulong,
        }
    }
}

/// A penetration query: runs `solve` with the caller's state, or with a cold one where there is none,
/// and tells `put` of an overlap, with the support points that it took. Returns the extension's code.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract; `solve` runs callbacks, so that nothing
/// with a destructor is alive here.
pub(in crate::ffi) unsafe fn run(
    query: Query,
    call: Call,
    warm: *mut ccd_warm_t,
    solve: impl FnOnce(
        &Pair<Object, Object>,
        &mut WarmStart,
        &Settings,
        &mut Penetration,
    ) -> Result<(), Stop>,
    put: impl FnOnce(&Penetration, u64),
) -> c_int {
    // SAFETY: [inputs]; `solve` runs callbacks, [callbacks].
    unsafe {
        let Some((pair, settings)) = query.ready(call, !warm.is_null()) else {
            return CCD_BAD_INPUT;
        };
        with_state(warm, |state| {
            let mut hit = Penetration::default();
            if if_overlapping(solve(&pair, state, &settings, &mut hit))?.is_none() {
                return Ok(CCD_MISS);
            }
            put(&hit, pair.md.supports());
            Ok(if hit.limit { CCD_LIMIT } else { CCD_HIT })
        })
    }
}

/// A penetration query of the extension: writes what comes of `solve`, which is told whether the
/// position is wanted.
///
/// # Safety
/// As [`run`].
pub(in crate::ffi) unsafe fn answer(
    query: Query,
    call: Call,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
    solve: impl FnOnce(
        &Pair<Object, Object>,
        &mut WarmStart,
        &Settings,
        bool,
        &mut Penetration,
    ) -> Result<(), Stop>,
) -> c_int {
    if out.is_null() || want & !CCD_WANT_ALL != 0 {
        return CCD_BAD_INPUT;
    }
    let wants_pos = want & CCD_WANT_POS != 0;
    // SAFETY: [outputs]; passed on.
    unsafe {
        run(
            query,
            call,
            warm,
            |pair, state, settings, hit| solve(pair, state, settings, wants_pos, hit),
            |hit, supports| *out = ccd_penetration_t::new(hit, want, supports),
        )
    }
}

/// The penetration depth: the least distance by which obj2 must move to separate the objects,
/// within the larger of mpr_tolerance and 0.1 % of it, in CCD_LIMIT's case a sound one.
/// The call to take unless one of those below says what is wanted better. From the state, else
/// from the centres, else from first_dir.
///
/// `warm`: NULL, or the pair's state: a pair that stays apart costs one call of each support
/// function, and one that overlaps fewer than without. `want`: CCD_WANT_ flags; 0 for depth,
/// bounds and directions alone. Reads mpr_tolerance. center1 and center2 may be NULL; where they
/// are given they must lie in their objects, and save calls; depth_lower leans on them too.
/// Allocates nothing.
///
/// Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetration(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe { answer(query, Call::Refined, warm, want, out, Pair::mpr) }
}
