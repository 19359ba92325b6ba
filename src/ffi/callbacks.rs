// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A C caller's objects and settings, as the solvers want them.

use core::ffi::{c_ulong, c_void};

use super::types::{ccd_center_fn, ccd_support_fn, ccd_t, ccd_vec3_t};
use crate::known::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{ITERATION_CAP, Real, Vec3};
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
        // And three scalar loads, because most callees store three scalars: a packed load cannot
        // be forwarded from two stores.
        // SAFETY: a local variable.
        unsafe { Vec3::from(point.v.each_ref().map(|x| core::ptr::read_volatile(x))) }
    }
}

/// The Minkowski difference of two C objects.
pub type Difference = MinkowskiDifference<Object, Object>;

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

    /// The Minkowski difference; `None` when `ccd` or a support callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn difference(&self) -> Option<Difference> {
        // SAFETY: passed on.
        let (obj1, obj2) = unsafe { self.objects()? };
        Some(MinkowskiDifference::new(obj1, obj2))
    }

    /// The difference of the objects' centres, an interior point of D; `None` when
    /// a centre callback is NULL or a centre not finite.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn centre(&self) -> Option<SupportPoint> {
        // SAFETY: passed on.
        unsafe { self.any_centre() }.filter(|c| c.v.sum().is_finite())
    }

    /// The same, finite or not.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    unsafe fn any_centre(&self) -> Option<SupportPoint> {
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
    pub unsafe fn first_dir(&self) -> Option<Vec3> {
        // SAFETY: [inputs]; only the field is read.
        let first_dir = unsafe { (*self.ccd).first_dir? };
        let mut dir = ccd_vec3_t::default();
        // SAFETY: [callbacks].
        unsafe { first_dir(self.obj1, self.obj2, &mut dir) };
        Some(dir.into())
    }

    /// Difference and centres; `None` when `ccd` or a callback for them is NULL or a centre is not
    /// finite. `lasting`: whether the caller keeps a state.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn pair(&self, lasting: bool) -> Option<Pair<Object, Object>> {
        // SAFETY: passed on.
        unsafe {
            Some(Pair {
                md: self.difference()?,
                centre: Some(self.centre()?),
                first_dir: None,
                lasting,
            })
        }
    }

    /// The difference, and where to look first: from the centres, or where these are not
    /// given from first_dir; `None` when `ccd` or a support callback is NULL or a centre not finite.
    /// `lasting`: whether the caller keeps a state.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn asked(&self, lasting: bool) -> Option<Pair<Object, Object>> {
        // SAFETY: passed on.
        unsafe {
            let md = self.difference()?;
            let centre = self.any_centre();
            if centre.is_some_and(|c| !c.v.sum().is_finite()) {
                return None;
            }
            let first_dir = match centre {
                Some(_) => None,
                None => self.first_dir(),
            };
            Some(Pair {
                md,
                centre,
                first_dir,
                lasting,
            })
        }
    }

    /// The caller's cap on iterations, or the library's own where that is lower.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn max_iterations(&self) -> u64 {
        // SAFETY: [inputs]; only the field is read.
        let max: c_ulong = unsafe { (*self.ccd).max_iterations };
        #[allow(clippy::unnecessary_cast)] // c_ulong has 32 bits on some platforms
        ITERATION_CAP.min(max as u64)
    }

    /// mpr_tolerance as the caller set it.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn mpr_tolerance(&self) -> Real {
        // SAFETY: [inputs]; only the field is read.
        unsafe { (*self.ccd).mpr_tolerance }
    }

    /// dist_tolerance as the caller set it.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn dist_tolerance(&self) -> Real {
        // SAFETY: [inputs]; only the field is read.
        unsafe { (*self.ccd).dist_tolerance }
    }

    /// epa_tolerance as the caller set it.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    pub unsafe fn epa_tolerance(&self) -> Real {
        // SAFETY: [inputs]; only the field is read.
        unsafe { (*self.ccd).epa_tolerance }
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
    c.into()
}
