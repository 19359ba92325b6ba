// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The C interface: the only module with raw pointers, `unsafe` and return codes.
//!
//! # Safety contract
//!
//! Guarantees of C callers and of this module. The comment of each `unsafe` names the clauses that it
//! uses; `polytope.rs`, which works on raw pointers only, names them once. In a function whose own
//! contract names a clause, "the caller's guarantees are those of the callee" means that it calls another
//! function of this module under the same clauses.
//!
//! - \[inputs\] An argument that is read points to a live, aligned, initialised object of
//!   its C type, which only the callbacks change during the call. Object pointers are passed
//!   to the callbacks and never dereferenced.
//! - \[ccd\] Only the fields of a [`ccd_t`](types::ccd_t) that the call needs are
//!   initialised, so fields are read one by one.
//! - \[callbacks\] A callback has its C signature. It may write through its object, call
//!   this library again, throw a C++ exception or longjmp out. So entry points and callback
//!   types are `extern "C-unwind"`, callbacks run on the calling thread, and while one runs
//!   no value with a destructor is alive, no lock is held and no Rust reference into the
//!   caller's memory exists.
//! - \[outputs\] An output pointer is NULL (where its function allows it) or points to
//!   writable memory of its type, or of an array as long as its function requires. It may
//!   alias an input: inputs are copied first, outputs are written last.
//! - \[heap\] malloc, calloc and free are C's. A block is used as a type whose size and
//!   alignment it has, and freed once, by its owner.
//! - \[polytope\] A [`ccd_pt_t`](types::ccd_pt_t) was initialised by `ccdPtInit`, its lists
//!   are circular, its links point to live elements, each element is a block of C's malloc, and
//!   during a call only that call accesses it, and only through raw pointers.

#![allow(unsafe_code)]
// The safety section of every function here is the contract above.
#![allow(clippy::missing_safety_doc)]

use core::ffi::c_void;

pub mod arena;
pub mod callbacks;
pub mod collide;
pub mod paper;
pub mod polytope;
pub mod run;
pub mod types;
pub mod vec3;
pub mod warm;

/// Writes an output unless its pointer is NULL.
///
/// # Safety
/// \[outputs\].
#[inline(always)]
unsafe fn write<T>(out: *mut T, value: T) {
    if !out.is_null() {
        // SAFETY: [outputs].
        unsafe { out.write(value) };
    }
}

unsafe extern "C" {
    fn malloc(size: usize) -> *mut c_void;
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(block: *mut c_void);
}
