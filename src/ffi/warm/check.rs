// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Check: tests an object's support function and center.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Object, center_of};
use super::super::types::{ccd_center_fn, ccd_support_fn, ccd_vec3_t};
use super::super::write;
use super::codes::CCD_BAD_INPUT;
use crate::math::{Real, Vec3};
use crate::minkowski::validate::check;

/// A point or the center is NaN or infinite. Nothing else is tested then.
pub const CCD_CHECK_NOT_FINITE: c_int = 1;
/// The points are the farthest *against* the direction: a sign is wrong.
pub const CCD_CHECK_OPPOSITE: c_int = 2;
/// A point is beyond the support plane of another direction by `noise`, more than rounding. If the
/// noise is of the order of single precision, use tolerances of several times the noise or more. A
/// greater noise shows a wrong frame (the direction must be rotated to the body's frame, the point
/// back), points of another object, or a search over the vertices that stops too early.
pub const CCD_CHECK_CONTRADICTS: c_int = 4;
/// The same direction returns another point later: the point depends on earlier calls.
pub const CCD_CHECK_CHANGES: c_int = 8;
/// The center is outside the object. Calls that rely on it may miss overlaps, and
/// report overlaps of objects that are apart.
pub const CCD_CHECK_CENTER_OUTSIDE: c_int = 16;
/// `center` is NULL. Calls with MPR in their name require it, others do not.
pub const CCD_CHECK_CENTER_MISSING: c_int = 32;

/// Result of ccdCheck. Lengths are metres.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_check_t {
    /// Greatest width of the object, approximately.
    pub size: Real,
    /// Greatest distance of a point beyond the support plane of another direction.
    pub noise: Real,
    /// Greatest change of a support value in the repeated calls.
    pub change: Real,
    /// Distance of the center from the object; negative inside, more negative if deeper. 0 without
    /// a center.
    pub center_outside: Real,
    /// Direction of the worst fault, unit; meaningless where there is none.
    pub dir: ccd_vec3_t,
}

/// Tests an object's support function and center along 192 directions, each evaluated twice. For
/// debugging and tests, too slow for every frame.
///
/// Detects faults that a query cannot distinguish from another object: a missing center, a wrong
/// sign, a wrong frame. A reported fault is certain; a fault in few directions may be missed.
///
/// `obj`: passed to the callbacks. `center`: may be NULL. `out`: may be NULL; else filled unless
/// CCD_BAD_INPUT is returned.
///
/// Reads no tolerance. Allocates nothing.
///
/// Returns 0 where no fault is found, CCD_CHECK_ flags where one is, or CCD_BAD_INPUT where
/// `support` is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdCheck(
    obj: *const c_void,
    support: Option<ccd_support_fn>,
    center: Option<ccd_center_fn>,
    out: *mut ccd_check_t,
) -> c_int {
    let Some(support) = support else {
        return CCD_BAD_INPUT;
    };
    // SAFETY: [callbacks].
    let center = center.map(|center| unsafe { center_of(center, obj) });
    let report = check(&Object(obj, support), center.as_ref());
    let flags = [
        (report.not_finite, CCD_CHECK_NOT_FINITE),
        (report.opposite, CCD_CHECK_OPPOSITE),
        (report.contradicts, CCD_CHECK_CONTRADICTS),
        (report.changes, CCD_CHECK_CHANGES),
        (report.center_outside, CCD_CHECK_CENTER_OUTSIDE),
        (center.is_none(), CCD_CHECK_CENTER_MISSING),
    ];
    let result = ccd_check_t {
        size: report.size as Real,
        noise: report.noise as Real,
        change: report.change as Real,
        center_outside: report.outside as Real,
        dir: Vec3::from(report.dir).into(),
    };
    // SAFETY: [outputs].
    unsafe { write(out, result) };
    flags.iter().map(|(is, flag)| c_int::from(*is) * flag).sum()
}
