// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Converts a C caller's objects and settings to the types of the solvers.

use core::ffi::{c_uint, c_void};

use super::types::{ccd_center_fn, ccd_support_fn, ccd_t, ccd_vec3_t};
use super::warm::want::{CCD_WANT_ALL, CCD_WANT_POINTS, CCD_WANT_POS};
use crate::math::{Vec3, from_real};
use crate::minkowski::support::{Fault, SupportMap, SupportPoint};
use crate::query::{Pair, Solver};
use crate::types::Settings;

/// An object whose support function is a C callback.
#[derive(Clone, Copy)]
pub struct Object(pub *const c_void, pub ccd_support_fn);

impl SupportMap for Object {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        let Object(obj, support) = *self;
        // Copying the whole struct compiles to packed stores. Packed loads of a callee can be served
        // by store-to-load forwarding from these, but not from three scalar stores.
        let dir = ccd_vec3_t::from(*dir);
        let mut point = Output::default();
        // SAFETY: [callbacks]; nothing with a destructor is alive here.
        unsafe { support(obj, &dir, point.pointer()) };
        load(point.written())
    }
}

/// The vector that a callback writes. The float build has room for a vector of doubles behind it: the callbacks of a program
/// that was compiled for double would otherwise overwrite the stack, and the answers be wrong without an error.
#[repr(C)]
#[cfg_attr(feature = "single", repr(align(8)))]
#[derive(Default)]
struct Output {
    vector: ccd_vec3_t,
    #[cfg(feature = "single")]
    behind: [u32; 3],
}

impl Output {
    /// Returns what the callback gets.
    #[inline(always)]
    fn pointer(&mut self) -> *mut ccd_vec3_t {
        #[cfg(feature = "single")]
        {
            self.behind = [UNTOUCHED; 3];
        }
        (&raw mut *self).cast()
    }

    /// Returns the vector after the callback. Ends the process if it wrote doubles.
    #[inline(always)]
    fn written(&self) -> &ccd_vec3_t {
        #[cfg(feature = "single")]
        if self.behind != [UNTOUCHED; 3] {
            end_program_of_doubles();
        }
        &self.vector
    }
}

/// The bits behind a vector of floats before the callback: those of a NaN, which no finite double ends with.
#[cfg(feature = "single")]
const UNTOUCHED: u32 = 0x7ff5_a5a5;

/// Writes a line on stderr and ends the process.
#[cfg(feature = "single")]
#[cold]
fn end_program_of_doubles() -> ! {
    unsafe extern "C" {
        fn perror(text: *const core::ffi::c_char);
        fn abort() -> !;
    }
    // SAFETY: [inputs]: a zero-terminated text.
    unsafe {
        perror(
            c"warmccd: this libccd is the float build, but the program is compiled for double"
                .as_ptr(),
        );
        abort()
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
        Some((Object(self.obj1, support1), Object(self.obj2, support2)))
    }

    /// Returns the centers and their difference, finite or not; `None` if a callback is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    unsafe fn centers(&self) -> Option<SupportPoint> {
        // SAFETY: [inputs]; only the two fields are read.
        let (center1, center2) = unsafe { ((*self.ccd).center1?, (*self.ccd).center2?) };
        // SAFETY: [callbacks].
        let (v1, v2) = unsafe { (center_of(center1, self.obj1), center_of(center2, self.obj2)) };
        Some(SupportPoint::new(v1, v2))
    }

    /// Returns the direction of the first_dir callback, not normalised; `None` if the callback
    /// is NULL.
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    unsafe fn first_dir(&self) -> Option<Vec3> {
        // SAFETY: [inputs]; only the field is read.
        let first_dir = unsafe { (*self.ccd).first_dir? };
        let mut dir = Output::default();
        // SAFETY: [callbacks].
        unsafe { first_dir(self.obj1, self.obj2, dir.pointer()) };
        Some((*dir.written()).into())
    }

    /// Returns the caller's settings, with the tolerance that the solver reads. If that is negative or NaN, libccd's calls
    /// use CCD_INIT's. Of a solver that reads none, nothing is read. `want`: CCD_WANT_ flags.
    ///
    /// # Safety
    /// \[inputs\] of the module contract; `ccd` is not NULL.
    #[inline(always)]
    unsafe fn settings(&self, interface: Interface, solver: &Solver, want: c_uint) -> Settings {
        let default = Settings::default();
        // SAFETY: [inputs], [ccd]; only the fields named are read.
        let (tolerance, max_iterations) = unsafe {
            let tolerance = match solver {
                Solver::Intersect => return default,
                Solver::Proven => (*self.ccd).epa_tolerance,
                Solver::Distance(_) => (*self.ccd).dist_tolerance,
                _ => (*self.ccd).mpr_tolerance,
            };
            (tolerance, (*self.ccd).max_iterations)
        };
        Settings {
            // Negated, so that NaN counts as negative.
            tolerance: if interface != Interface::Extension && !(tolerance >= 0.0) {
                default.tolerance
            } else {
                tolerance.into()
            },
            max_iterations: max_iterations as u64,
            // A distance has no position.
            pos: want & CCD_WANT_POS != 0 && !matches!(solver, Solver::Distance(_)),
            points: want & CCD_WANT_POINTS != 0,
        }
    }

    /// Returns the pair with the caller's settings and its centers or first direction. `want`: CCD_WANT_ flags.
    ///
    /// # Errors
    /// [`Fault::Missing`]: `ccd` or a callback that the call requires is NULL, a flag is unknown, and as [`Pair::new`].
    ///
    /// # Safety
    /// \[inputs\] of the module contract.
    #[inline(always)]
    pub unsafe fn pair(
        &self,
        interface: Interface,
        solver: &Solver,
        want: c_uint,
    ) -> Result<Pair<Object, Object>, Fault> {
        if want & !CCD_WANT_ALL != 0 {
            return Err(Fault::Missing);
        }
        // SAFETY: the caller's guarantees are those of the callees; `objects` has found that ccd is not NULL.
        unsafe {
            let objects = self.objects().ok_or(Fault::Missing)?;
            let settings = self.settings(interface, solver, want);
            let (centers, first_dir) = match interface {
                Interface::Mpr => (Some(self.centers().ok_or(Fault::Missing)?), None),
                Interface::Gjk => (None, Some(self.first_dir().ok_or(Fault::Missing)?)),
                Interface::Extension => match self.centers() {
                    None => (None, self.first_dir()),
                    centers => (centers, None),
                },
            };
            Pair::new(objects, centers, first_dir, &settings)
        }
    }
}

/// Returns an object's center, finite or not.
///
/// # Safety
/// \[callbacks\] of the module contract.
pub unsafe fn center_of(center: ccd_center_fn, obj: *const c_void) -> Vec3 {
    let mut c = Output::default();
    // SAFETY: [callbacks].
    unsafe { center(obj, c.pointer()) };
    load(c.written())
}
