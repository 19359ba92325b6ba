// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the depth: a polytope inscribed in D is expanded where it is
//! nearest to the origin, until the bounds meet.
//!
//! [`global`] is the query, and its head has the steps in order; [`shallow`] proves a shallow contact
//! without a polytope, from what is known of each object, and [`face`] finds a local minimum so; [`start`] makes the first
//! tetrahedron, [`expansion`] chooses where to ask, [`polytope`] and [`plane`] are the
//! polytope.

pub mod cores;
pub mod expansion;
pub mod face;
pub mod global;
pub mod plane;
pub mod polytope;
pub mod portal;
pub mod shallow;
pub mod start;
