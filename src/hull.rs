// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the depth: a polytope inscribed in D is expanded where it is
//! nearest to the origin, until the bounds meet.
//!
//! [`global`] is the query, and its head has the steps in order; [`start`] makes the first
//! tetrahedron, [`expansion`] chooses where to ask, [`polytope`] and [`plane`] are the
//! polytope.

pub mod expansion;
pub mod global;
pub mod plane;
pub mod polytope;
pub mod start;
