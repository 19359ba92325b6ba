// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The C interface: the only module that knows raw pointers, `unsafe` and
//! return codes.

#![allow(unsafe_code)]

use core::ffi::c_char;

pub mod types;

/// Which library a process really runs, and in which precision, as a
/// zero-terminated string: `"warmccd 0.1.0 double"` (or `single`).
#[unsafe(no_mangle)]
pub extern "C-unwind" fn ccdImplementation() -> *const c_char {
    #[cfg(not(feature = "single"))]
    const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " double\0");
    #[cfg(feature = "single")]
    const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " single\0");
    NAME.as_ptr().cast()
}
