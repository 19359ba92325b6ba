// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The C interface: the only module that knows raw pointers, `unsafe` and
//! return codes.
//!
//! # Safety contract
//!
//! What C callers promise, and what this module promises in return. Each `unsafe` names
//! the clause it stands on.
//!
//! - \[inputs\] An argument that is read points to a live, aligned, initialised object of
//!   its C type, which nobody changes during the call but the callbacks. Object pointers
//!   are never looked at, only handed on.
//! - \[ccd\] Of a [`ccd_t`](types::ccd_t) only the fields that the call needs are
//!   initialised, so fields are read one by one.
//! - \[callbacks\] A callback has its C signature. It may write through its object, call
//!   this library again, throw a C++ exception or longjmp away. So entry points and callback
//!   types are `extern "C-unwind"`, callbacks run on the calling thread, and while one runs
//!   no value with a destructor is alive, no lock is held and no Rust reference into the
//!   caller's memory exists.
//! - \[outputs\] An output pointer is NULL (where its function says so) or points to
//!   writable memory of its type, or of as many as its function says. It may be an input too:
//!   inputs are copied first, outputs are written last.
//! - \[heap\] malloc, calloc and free are C's. A block is used for what it is large enough
//!   and aligned for, and freed once, by the one who took it.
//! - \[polytope\] A [`ccd_pt_t`](types::ccd_pt_t) went through `ccdPtInit`, its lists are
//!   circular, its links lead to live elements, each element is a block of C's malloc, and
//!   during a call only that call touches it. It is reached through raw pointers alone.

#![allow(unsafe_code)]
// The safety section of every function here is the contract above.
#![allow(clippy::missing_safety_doc)]

use core::ffi::c_void;

pub mod arena;
pub mod callbacks;
pub mod collide;
pub mod paper;
pub mod polytope;
pub mod support;
pub mod types;
pub mod vec3;
pub mod warm;

unsafe extern "C" {
    fn malloc(size: usize) -> *mut c_void;
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(block: *mut c_void);
}
