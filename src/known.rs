// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is known of a pair: its support mappings, the points that they answered, and how
//! exact these are.
//!
//! Every solver asks here, and keeps what it was answered here. A support point tells a point of
//! each object, and D holds the difference of any two: k calls are worth k² points
//! ([`support_set::SupportSet::extreme`]).

pub mod check;
pub mod points;
pub mod precision;
#[doc(hidden)]
pub mod round;
#[doc(hidden)]
pub mod support_set;
