// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A C caller's objects and settings, as the solvers want them.

use core::ffi::{c_ulong, c_void};

use super::types::{ccd_center_fn, ccd_support_fn, ccd_t, ccd_vec3_t};
use crate::contact::Settings;
use crate::math::{ITERATION_CAP, Real, Vec3, from_real};
use crate::minkowski::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::query::Pair;

/// One object behind libccd's support callback.
#[derive(Clone, Copy)]
pub struct Object {
    obj: *const c_void,
    support: ccd_support_fn,
}

impl Object {
    /// An object and its support function.
    pub fn new(obj: *const c_void, support: ccd_support_fn) -> Self {
        Self { obj, support }
    }
}

impl SupportMap for Object {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        // A whole-struct copy is stored in two packed moves, which a callee's
        // vector loads can be forwarded from; three scalar stores would stall it.
        let dir = ccd_vec3_t::from(*dir);
        let mut point = ccd_vec3_t::default();
        // SAFETY: [callbacks]; nothing with a destructor is alive here.
        unsafe { (self.support)(self.obj, &dir, &mut point) };
        load(&point)
    }
}

/// Reads a vector that a callback has just written, in three scalar loads: most callbacks store three
/// scalars, and a packed load would wait for two stores.
#[inline(always)]
fn load(written: &ccd_vec3_t) -> Vec3 {
    // SAFETY: a reference.
    from_real(
        written
            .v
            .each_ref()
            .map(|x| unsafe { core::ptr::read_volatile(x) }),
    )
}

/// What a call needs and reads of a [`ccd_t`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// libccd's MPR: the centres, mpr_tolerance.
    Mpr,
    /// libccd's GJK: first_dir, epa_tolerance; the centres are not asked for.
    Gjk,
    /// The extension's, from the centres, or where these are not given from first_dir, or from
    /// anywhere; mpr_tolerance.
    Refined,
    /// The same with epa_tolerance.
    Proven,
    /// The same with dist_tolerance.
    Distance,
}

impl Call {
    /// Is it one of libccd's?
    fn is_libccd(self) -> bool {
        matches!(self, Call::Mpr | Call::Gjk)
    }
}

/// Tolerance of a compatible call whose own is NaN or negative: what CCD_INIT sets.
const DEFAULT_TOLERANCE: Real = 1e-4;

/// A query as a C caller states it.
#[derive(Clone, Copy)]
pub struct Query {
    /// The caller's first object, passed through.
    pub obj1: *const c_void,
    /// The caller's second object, passed through.
    pub obj2: *const c_void,
    /// Callbacks and settings; read field by field, because callers leave the
    /// fields that a query does not use uninitialised.
    pub ccd: *const ccd_t,
}

impl Query {
    /// The two objects; `None` when `ccd` or a support callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn objects(&self) -> Option<(Object, Object)> {
        if self.ccd.is_null() {
            return None;
        }
        // SAFETY: [inputs]; only the two fields are read.
        let (support1, support2) = unsafe { ((*self.ccd).support1?, (*self.ccd).support2?) };
        Some((
            Object {
                obj: self.obj1,
                support: support1,
            },
            Object {
                obj: self.obj2,
                support: support2,
            },
        ))
    }

    /// The difference of the objects' centres, finite or not; `None` when a callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    unsafe fn centre(&self) -> Option<SupportPoint> {
        // SAFETY: [inputs]; only the two fields are read.
        let (center1, center2) = unsafe { ((*self.ccd).center1?, (*self.ccd).center2?) };
        // SAFETY: [callbacks].
        let (v1, v2) = unsafe { (centre_of(center1, self.obj1), centre_of(center2, self.obj2)) };
        Some(SupportPoint { v: v1 - v2, v1, v2 })
    }

    /// The direction of the caller's first_dir callback, as it is; `None` when the
    /// callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    unsafe fn first_dir(&self) -> Option<Vec3> {
        // SAFETY: [inputs]; only the field is read.
        let first_dir = unsafe { (*self.ccd).first_dir? };
        let mut dir = ccd_vec3_t::default();
        // SAFETY: [callbacks].
        unsafe { first_dir(self.obj1, self.obj2, &mut dir) };
        Some(dir.into())
    }

    /// The pair, and where to look first; `None` when `ccd` or a callback that the call needs is
    /// NULL, or a centre is not finite. `lasting`: whether the caller keeps a state.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn pair(&self, call: Call, lasting: bool) -> Option<Pair<Object, Object>> {
        // SAFETY: passed on.
        unsafe {
            let (obj1, obj2) = self.objects()?;
            let centre = match call {
                Call::Gjk => None,
                _ => self.centre(),
            };
            if centre.is_some_and(|c| !c.v.sum().is_finite())
                || call == Call::Mpr && centre.is_none()
            {
                return None;
            }
            let first_dir = match centre {
                Some(_) => None,
                None => self.first_dir(),
            };
            if call == Call::Gjk && first_dir.is_none() {
                return None;
            }
            Some(Pair {
                md: MinkowskiDifference::new(obj1, obj2),
                centre,
                first_dir,
                lasting,
            })
        }
    }

    /// The pair and the settings; `None` where there is no
    /// [`Query::pair`], or the tolerance is negative or NaN: libccd's calls then take their default.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn ready(
        &self,
        call: Call,
        lasting: bool,
    ) -> Option<(Pair<Object, Object>, Settings)> {
        if self.ccd.is_null() {
            return None;
        }
        // SAFETY: [inputs]; only the fields named are read.
        unsafe {
            let mut tolerance = match call {
                Call::Mpr | Call::Refined => (*self.ccd).mpr_tolerance,
                Call::Gjk | Call::Proven => (*self.ccd).epa_tolerance,
                Call::Distance => (*self.ccd).dist_tolerance,
            };
            // Negated for NaN.
            if !(tolerance >= 0.0) {
                if !call.is_libccd() {
                    return None;
                }
                tolerance = DEFAULT_TOLERANCE;
            }
            let pair = self.pair(call, lasting)?;
            let max: c_ulong = (*self.ccd).max_iterations;
            #[allow(clippy::unnecessary_cast)] // c_ulong has 32 bits on some platforms
            let max_iterations = ITERATION_CAP.min(max as u64);
            let settings = Settings {
                tolerance: tolerance.into(),
                max_iterations,
            };
            Some((pair, settings))
        }
    }
}

/// An object's centre, finite or not.
///
/// # Safety
/// \[callbacks\] of the module contract.
pub unsafe fn centre_of(center: ccd_center_fn, obj: *const c_void) -> Vec3 {
    let mut c = ccd_vec3_t::default();
    // SAFETY: [callbacks].
    unsafe { center(obj, &mut c) };
    load(&c)
}
