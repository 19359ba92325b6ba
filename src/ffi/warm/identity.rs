// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Which library this is.

use core::ffi::c_char;

/// The name, version and precision, and a NUL.
#[cfg(not(feature = "single"))]
pub(crate) const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " double\0");
/// The name, version and precision, and a NUL.
#[cfg(feature = "single")]
pub(crate) const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " single\0");

/// Which library a process really runs, and in which precision: "warmccd 0.2.0 double", a
/// string that lives as long as the library.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn ccdImplementation() -> *const c_char {
    NAME.as_ptr().cast()
}
