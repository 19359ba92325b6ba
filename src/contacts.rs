// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the objects touch, once depth and direction are known.
//!
//! Both objects are seen in one [`plane`]. [`manifold`] finds several contacts: in what two [`face`]s share, as [`polygon`]s; what it
//! found is kept in a [`memory`].

pub mod face;
pub mod list;
pub mod manifold;
pub mod memory;
pub mod plane;
pub mod polygon;
