// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Converts a C caller's objects and settings to the types of the solvers.

use core::ffi::{c_ulong, c_void};

use super::types::{ccd_center_fn, ccd_support_fn, ccd_t, ccd_vec3_t};
use crate::contact::Settings;
use crate::math::{ITERATION_CAP, Real, Vec3, from_real};
use crate::minkowski::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::query::Pair;

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
        // A copy of the whole struct is stored by two packed moves, which forward to the
        // vector loads of a callee; three scalar stores would stall them.
        let dir = ccd_vec3_t::from(*dir);
        let mut point = ccd_vec3_t::default();
        // SAFETY: [callbacks]; nothing with a destructor is alive here.
        unsafe { (self.support)(self.obj, &dir, &mut point) };
        load(&point)
    }
}

/// Reads a vector that a callback has just written, by three scalar loads: most callbacks store
/// three scalars, and a packed load would wait for two stores.
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

/// The callbacks that a query needs and the tolerance that it reads from a [`ccd_t`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// libccd's MPR: needs both centers; reads mpr_tolerance.
    Mpr,
    /// libccd's GJK: needs first_dir, calls no center; reads epa_tolerance.
    Gjk,
    /// The extension's: centers and first_dir are optional; reads mpr_tolerance.
    Penetration,
    /// The same; reads epa_tolerance.
    Proven,
    /// The same; reads dist_tolerance.
    Distance,
}

impl Kind {
    /// Returns whether the query is one of libccd's.
    fn is_libccd(self) -> bool {
        matches!(self, Kind::Mpr | Kind::Gjk)
    }
}

/// The tolerance of CCD_INIT, metres: used by libccd's calls where the caller's is negative or NaN.
const DEFAULT_TOLERANCE: Real = 1e-4;

/// The arguments that every query takes from a C caller.
#[derive(Clone, Copy)]
pub struct Query {
    /// The first object, passed to the callbacks.
    pub obj1: *const c_void,
    /// The second object, passed to the callbacks.
    pub obj2: *const c_void,
    /// Callbacks and settings; read field by field, because callers leave the
    /// fields that a query does not use uninitialised.
    pub ccd: *const ccd_t,
}

impl Query {
    /// Returns the two objects; `None` when `ccd` or a support callback is NULL.
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

    /// Returns the difference of the centers, finite or not; `None` when a callback is NULL.
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

    /// Returns the direction of the first_dir callback, not normalised; `None` when the
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

    /// Returns the pair with its centers or first direction; `None` when `ccd` or a callback that
    /// the query needs is NULL, or a center is not finite. `has_state`: the caller keeps a state.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn pair(&self, kind: Kind, has_state: bool) -> Option<Pair<Object, Object>> {
        // SAFETY: passed on.
        unsafe {
            let (obj1, obj2) = self.objects()?;
            let center = match kind {
                Kind::Gjk => None,
                _ => self.center(),
            };
            if center.is_some_and(|c| !c.v.sum().is_finite())
                || kind == Kind::Mpr && center.is_none()
            {
                return None;
            }
            let first_dir = match center {
                Some(_) => None,
                None => self.first_dir(),
            };
            if kind == Kind::Gjk && first_dir.is_none() {
                return None;
            }
            Some(Pair {
                difference: MinkowskiDifference::new(obj1, obj2),
                centers: center,
                first_dir,
                keeps_state: has_state,
            })
        }
    }

    /// Returns the pair and the settings; `None` where [`Query::pair`] does, or where the tolerance
    /// is negative or NaN. libccd's calls then take [`DEFAULT_TOLERANCE`].
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn prepare(
        &self,
        kind: Kind,
        has_state: bool,
    ) -> Option<(Pair<Object, Object>, Settings)> {
        if self.ccd.is_null() {
            return None;
        }
        // SAFETY: [inputs]; only the fields named are read.
        unsafe {
            let mut tolerance = match kind {
                Kind::Mpr | Kind::Penetration => (*self.ccd).mpr_tolerance,
                Kind::Gjk | Kind::Proven => (*self.ccd).epa_tolerance,
                Kind::Distance => (*self.ccd).dist_tolerance,
            };
            // Negated, so that NaN counts as negative.
            if !(tolerance >= 0.0) {
                if !kind.is_libccd() {
                    return None;
                }
                tolerance = DEFAULT_TOLERANCE;
            }
            let pair = self.pair(kind, has_state)?;
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
