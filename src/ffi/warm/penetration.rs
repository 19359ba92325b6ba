// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Penetration: overlap, depth, direction, contact position. The default call.

use core::ffi::{c_int, c_uint, c_ulong, c_void};

use super::super::callbacks::QueryArgs;
use super::super::run::fill;
use super::super::types::{ccd_t, ccd_vec3_t};
use super::state::ccd_warm_t;
use crate::math::Real;
use crate::query::Solver;
use crate::types::{Penetration, Solution};

/// Result of a penetration query. A field that was not requested is zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_penetration_t {
    /// Penetration depth, metres, >= 0: moving obj2 by depth * dir separates the objects. The
    /// support value of normal, divided by dir . normal.
    pub depth: Real,
    /// Lower bound of the globally least depth (in ccdPenetrationAlong: of the depth along dir),
    /// metres; 0 if there is none. Proven if the centers lie in their objects; only
    /// ccdPenetrationProven does not rely on them.
    pub depth_lower: Real,
    /// Penetration direction, unit: obj2 moves along it.
    pub dir: ccd_vec3_t,
    /// Contact normal, unit: normal of the separating plane. Equal to dir except in
    /// ccdPenetrationAlong.
    pub normal: ccd_vec3_t,
    /// Contact position, CCD_WANT_POS: the center of pressure, an estimate of the centroid of the
    /// overlap volume, projected along normal to the plane midway between the two support planes; the
    /// deeper the overlap, the nearer it is instead to a point between the centers, beside that plane. At
    /// most half the depth from both objects, within the tolerance. Root mean square error for objects
    /// of a quarter metre and depths up to a millimetre: 0.2 mm for faces of 3 to 6 corners, and regular
    /// ones of up to 10, on a floor; 3 mm for other faces and for boxes in any pose; 8 mm for round
    /// objects and discs; 12 mm for flat bars with a curved underside; 15 mm for a cone on its side; in
    /// single precision 1 mm more. For greater depths 2 % of the smaller object's radius at a depth of 3 %
    /// of it, 6 % at 10 %, 20 % at 30 %. In a motion of 0.01 degrees pos of leaning discs jumps by at most
    /// 6 mm, of cones and half balls by 13 mm, of flat bars by up to 55 mm. With CCD_LIMIT, in
    /// ccdPenetrationAlong and ccdPenetrationPlanar, the middle of the witness points.
    pub pos: ccd_vec3_t,
    /// Witness point of obj1, CCD_WANT_POINTS: in obj1 and on its support plane, within the larger
    /// of the error of depth and 1e-12 of the size (1e-5 in single precision).
    pub point1: ccd_vec3_t,
    /// Witness point of obj2, CCD_WANT_POINTS: as point1.
    pub point2: ccd_vec3_t,
    /// Number of support points: half of the calls of support1 and support2 together, rounded up.
    pub support_points: c_ulong,
    /// Number of iterations of the solver.
    pub iterations: c_ulong,
    /// Why the search ended: a CCD_STATUS_ value.
    pub status: c_int,
}

impl From<Solution> for ccd_penetration_t {
    fn from(found: Solution) -> Self {
        let hit = Penetration::from(found);
        Self {
            depth: hit.depth,
            depth_lower: hit.depth_lower,
            dir: hit.dir.into(),
            normal: hit.normal.into(),
            pos: hit.pos.into(),
            point1: hit.point1.into(),
            point2: hit.point2.into(),
            support_points: hit.support_points as c_ulong,
            iterations: hit.iterations as c_ulong,
            status: hit.status as c_int,
        }
    }
}

/// Computes the penetration depth: the least distance by which obj2 must move to separate the
/// objects. The default call.
///
/// `warm`: the pair's state, may be NULL; with a state a pair that stays apart costs one support
/// point, and an overlap fewer than a cold start. `want`: CCD_WANT_ flags; 0 for only depth, bound
/// and directions. Centers save support points; overlap and depth_lower rely on them.
///
/// Reads mpr_tolerance: depth exceeds the least depth by at most mpr_tolerance or 0.1 % of the
/// depth, the larger of the two; with CCD_LIMIT it is a sound upper bound. Allocates nothing.
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
    let args = QueryArgs { obj1, obj2, ccd };
    // SAFETY: the caller's guarantees are those of the callee.
    unsafe { fill(args, Solver::Global, warm, want, out) }
}
