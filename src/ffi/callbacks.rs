// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Converts a C caller's objects and settings to the types of the solvers.

use core::ffi::{c_ulong, c_void};

use super::types::{ccd_center_fn, ccd_support_fn, ccd_t, ccd_vec3_t};
use crate::math::{ITERATION_CAP, Real, Vec3, from_real};
use crate::minkowski::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::query::Pair;
use crate::solver::Solver;
use crate::types::{Settings, Want};

/// An object whose support function is a C callback.
#[derive(Clone, Copy)]
pub struct Object {
    obj: *const c_void,
    support: ccd_support_fn,
}

impl Object {
    /// Pairs an object with its support function.
    pub fn new(obj: *const c_void, support: ccd_support_fn) -> Self {
        Self { obj, support }
    }
}

impl SupportMap for Object {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        // Copying the whole struct compiles to packed stores. Packed loads of a callee can be served
        // by store-to-load forwarding from these, but not from three scalar stores.
        let dir = ccd_vec3_t::from(*dir);
        let mut point = ccd_vec3_t::default();
        // SAFETY: [callbacks]; nothing with a destructor is alive here.
        unsafe { (self.support)(self.obj, &dir, &mut point) };
        load(&point)
    }
}

/// Reads a vector that a callback has just written, by three scalar loads. Most callbacks store three
/// scalars, and a packed load of these could not be served by store-to-load forwarding.
#[inline(always)]
fn load(written: &ccd_vec3_t) -> Vec3 {
    // SAFETY: `x` is a valid reference.
    from_real(
        written
            .v
            .each_ref()
            .map(|x| unsafe { core::ptr::read_volatile(x) }),
    )
}

/// The interface of a call: the callbacks that it requires, and what it does with an invalid tolerance.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Interface {
    /// libccd's MPR: requires both centers.
    Mpr,
    /// libccd's GJK: requires first_dir, calls no center.
    Gjk,
    /// The extension: centers and first_dir are optional; an invalid tolerance is an error.
    Extension,
}

/// The tolerance of CCD_INIT, metres: used by libccd's calls if the caller's is negative or NaN.
const DEFAULT_TOLERANCE: Real = 1e-4;

/// The arguments that every query takes from a C caller.
#[derive(Clone, Copy)]
pub struct QueryArgs {
    /// The first object, passed to the callbacks.
    pub obj1: *const c_void,
    /// The second object, passed to the callbacks.
    pub obj2: *const c_void,
    /// Callbacks and settings; read field by field, because callers leave the
    /// fields that a query does not use uninitialised.
    pub ccd: *const ccd_t,
}

impl QueryArgs {
    /// Returns the two objects; `None` if `ccd` or a support callback is NULL.
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
            Object::new(self.obj1, support1),
            Object::new(self.obj2, support2),
        ))
    }

    /// Returns the difference of the centers, finite or not; `None` if a callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    unsafe fn center(&self) -> Option<SupportPoint> {
        // SAFETY: [inputs]; only the two fields are read.
        let (center1, center2) = unsafe { ((*self.ccd).center1?, (*self.ccd).center2?) };
        // SAFETY: [callbacks].
        let (v1, v2) = unsafe { (center_of(center1, self.obj1), center_of(center2, self.obj2)) };
        Some(SupportPoint { v: v1 - v2, v1, v2 })
    }

    /// Returns the direction of the first_dir callback, not normalised; `None` if the callback
    /// is NULL.
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

    /// Returns the caller's settings, with the tolerance that the solver reads; `None` if `ccd` is NULL. If the tolerance
    /// is negative or NaN, libccd's calls use [`DEFAULT_TOLERANCE`]; those of the extension return `None`.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn settings(&self, interface: Interface, solver: &Solver) -> Option<Settings> {
        if self.ccd.is_null() {
            return None;
        }
        // SAFETY: [inputs]; only the fields named are read.
        unsafe {
            let mut tolerance = match solver {
                Solver::Proven => (*self.ccd).epa_tolerance,
                Solver::Distance(_) => (*self.ccd).dist_tolerance,
                _ => (*self.ccd).mpr_tolerance,
            };
            // Negated, so that NaN counts as negative.
            if !(tolerance >= 0.0) {
                if interface == Interface::Extension {
                    return None;
                }
                tolerance = DEFAULT_TOLERANCE;
            }
            let max: c_ulong = (*self.ccd).max_iterations;
            #[allow(clippy::unnecessary_cast)] // c_ulong has 32 bits on some platforms
            let max_iterations = ITERATION_CAP.min(max as u64);
            Some(Settings {
                tolerance: tolerance.into(),
                max_iterations,
            })
        }
    }

    /// Returns the pair with its centers or first direction; `None` if `ccd` or a callback that the call requires is
    /// NULL, or a center is not finite.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn pair(
        &self,
        interface: Interface,
        settings: Settings,
        want: Want,
    ) -> Option<Pair<Object, Object>> {
        // SAFETY: the caller's guarantees are those of the callees.
        unsafe {
            let (obj1, obj2) = self.objects()?;
            let (centers, first_dir) = match interface {
                Interface::Mpr => (Some(self.center()?), None),
                Interface::Gjk => (None, Some(self.first_dir()?)),
                Interface::Extension => match self.center() {
                    None => (None, self.first_dir()),
                    centers => (centers, None),
                },
            };
            if centers.is_some_and(|c| !c.v.sum().is_finite()) {
                return None;
            }
            Some(Pair {
                difference: MinkowskiDifference::new(obj1, obj2),
                centers,
                first_dir,
                settings,
                want,
            })
        }
    }
}

/// Returns an object's center, finite or not.
///
/// # Safety
/// \[callbacks\] of the module contract.
pub unsafe fn center_of(center: ccd_center_fn, obj: *const c_void) -> Vec3 {
    let mut c = ccd_vec3_t::default();
    // SAFETY: [callbacks].
    unsafe { center(obj, &mut c) };
    load(&c)
}
