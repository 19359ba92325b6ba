// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Identity of the library.

use core::ffi::c_char;

/// The name, version and precision, terminated by a NUL.
#[cfg(not(feature = "single"))]
pub(crate) const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " double\0");
/// The name, version and precision, terminated by a NUL.
#[cfg(feature = "single")]
pub(crate) const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " single\0");

/// Returns name, version and precision of the library that the process runs:
/// "warmccd 0.2.0 double", a static string.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn ccdImplementation() -> *const c_char {
    NAME.as_ptr().cast()
}
