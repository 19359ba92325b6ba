// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Types, constants and tables of functions of the C headers, as bindgen reads them: libccd's of the system, and this
//! library's extension, whose functions take libccd's types. A table is filled from a library that is opened at run time.

#![allow(non_camel_case_types, non_snake_case, clippy::all)]

/// `<ccd/ccd.h>` of the system.
pub mod libccd {
    include!(concat!(env!("OUT_DIR"), "/libccd.rs"));
}

/// `<ccd/warm.h>` and `<ccd/paper.h>` of this repository.
pub mod warmccd {
    use crate::libccd::*;
    include!(concat!(env!("OUT_DIR"), "/warmccd.rs"));
}
