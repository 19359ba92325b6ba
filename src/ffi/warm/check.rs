// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Something is odd? What is wrong with an object's support function and centre.

use core::ffi::{c_int, c_void};

use super::super::callbacks::{Object, centre_of};
use super::super::types::{ccd_center_fn, ccd_support_fn, ccd_vec3_t};
use super::codes::CCD_BAD_INPUT;
use crate::math::{Real, Vec3};
use crate::minkowski::validate::check;

/// A point, or the centre, is NaN or infinite. Nothing else is told.
pub const CCD_CHECK_NOT_FINITE: c_int = 1;
/// The points are the farthest *against* the direction: a sign is wrong.
pub const CCD_CHECK_OPPOSITE: c_int = 2;
/// Points contradict each other by `noise`, more than rounding: one answered along one direction
/// is farther along another than that one's own. By as little as single precision: ask for no
/// tolerance finer than some times the noise. By more: a wrong frame (the direction is to be
/// turned into the body's, the point back), points of another object, or a search over the
/// vertices that stops too early.
pub const CCD_CHECK_CONTRADICTS: c_int = 4;
/// The same direction asked again is answered otherwise: the answer depends on earlier calls.
pub const CCD_CHECK_CHANGES: c_int = 8;
/// The centre lies outside of the object. The MPR calls and ccdPenetration then miss overlaps, and
/// answer what is apart as deep.
pub const CCD_CHECK_CENTER_OUTSIDE: c_int = 16;
/// There is no centre: `center` is NULL. libccd's MPR calls need one; the extension's others do
/// not.
pub const CCD_CHECK_CENTER_MISSING: c_int = 32;

/// What ccdCheck found. Lengths are metres.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_check_t {
    /// The greatest width of the object, about: is it what you think it is?
    pub size: Real,
    /// How far a point lies beyond the support plane of another at most.
    pub noise: Real,
    /// How far the answer along one direction moved along it when asked again at most.
    pub change: Real,
    /// How far the centre lies outside; negative: how deep inside, the deeper the better. 0 without
    /// one.
    pub center_outside: Real,
    /// Unit: the direction in which the worst was found; of no meaning where nothing is wrong.
    pub dir: ccd_vec3_t,
}

/// What is wrong with an object's support function and centre, as far as 192 directions tell,
/// each asked twice. For when an answer is odd, and for tests; not for every frame.
///
/// It finds what the queries cannot tell from another object: a forgotten centre, a wrong sign, a
/// frame mixed up. What is found is wrong for certain; a fault that shows in few directions may
/// be missed. `obj` is handed to the callbacks. `center` may be NULL. `out` may be NULL; else it is
/// filled unless CCD_BAD_INPUT is returned.
///
/// Returns 0 where nothing is wrong, CCD_CHECK_ flags where something is, or CCD_BAD_INPUT: `support`
/// is NULL.
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
    let centre = center.map(|center| unsafe { centre_of(center, obj) });
    let report = check(&Object::new(obj, support), centre.as_ref());
    let flags = [
        (report.not_finite, CCD_CHECK_NOT_FINITE),
        (report.opposite, CCD_CHECK_OPPOSITE),
        (report.contradicts, CCD_CHECK_CONTRADICTS),
        (report.changes, CCD_CHECK_CHANGES),
        (report.center_outside, CCD_CHECK_CENTER_OUTSIDE),
        (centre.is_none(), CCD_CHECK_CENTER_MISSING),
    ];
    let found = ccd_check_t {
        size: report.size as Real,
        noise: report.noise as Real,
        change: report.change as Real,
        center_outside: report.outside as Real,
        dir: Vec3::from(report.dir).into(),
    };
    if !out.is_null() {
        // SAFETY: [outputs].
        unsafe { out.write(found) };
    }
    flags.iter().map(|(is, flag)| c_int::from(*is) * flag).sum()
}
