// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the objects touch: the contact position and the contact manifold.
//!
//! | file | contents |
//! |---|---|
//! | [`frame`] | the frame of a contact |
//! | [`outline`] | the outline of an object around the deepest point |
//! | [`inclined_support`], [`outline_search`], [`flat_face`] | its search: inclined directions, sides, what a plane saves |
//! | [`tuning`] | the constants of these |
//! | [`center_of_pressure`] | the contact position |
//! | [`face`], [`face_search`] | the face of an object in a contact, and its search |
//! | [`manifold`], [`manifold_cache`] | the contact points of two faces, and what is kept of them |
//!
//! [`face_search`] and [`outline_search`] find corners at different slopes. A face has a largest drop, the slop, to which its
//! slope is proportional. The position weights by the drop, and reaches the drop of a curved surface, R T²/2, at a slope
//! proportional to the root of the depth. Measured with the other's slope: positions jump by 74 mm (1 mm), and 1,189 of
//! 370,224 checks of contacts fail (0).

pub mod center_of_pressure;
pub mod face;
pub mod face_search;
pub mod flat_face;
pub mod frame;
pub mod inclined_support;
pub mod manifold;
pub mod manifold_cache;
pub mod outline;
pub mod outline_search;
pub mod tuning;
