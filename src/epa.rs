// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the penetration depth, with a certificate: an expanding polytope on known
//! vertices.
//!
//! [`penetration`] is the driver, and its head has the steps in order; [`expand`] is the loop of the
//! polytope; [`polytope`] and [`plane`] are its geometry, and know no query.

pub mod expand;
pub mod penetration;
pub mod plane;
pub mod polytope;
