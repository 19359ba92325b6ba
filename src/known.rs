// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is known of a pair: its support mappings, the points that they answered, and how
//! exact these are.
//!
//! Every solver asks here, and keeps what it was answered here: no other module calls a
//! support mapping.

#[doc(hidden)]
pub mod precision;
#[doc(hidden)]
pub mod round;
pub mod support;
#[doc(hidden)]
pub mod support_set;
