// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the objects touch, once depth and direction are known.
//!
//! [`pressure`] finds the position of one contact: it asks for corners as [`view`] tells, leaves out
//! what the search has [`seen`], and integrates over a [`fan`] of them. [`manifold`] finds several
//! contacts; [`polygon`] clips and measures the faces of these, [`again`] finds them again by what
//! [`memory`] keeps.

pub mod again;
pub mod fan;
pub mod manifold;
pub mod memory;
pub mod polygon;
pub mod pressure;
pub mod seen;
pub mod view;
