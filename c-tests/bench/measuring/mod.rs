// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Libraries side by side, scenes with truth, one table of methods, and one runner. The charts (`c-tests/lab/charts`) and
//! the test of the recorded counts (`support_counts.rs`) each use a part.

#![allow(dead_code)]

pub mod callgrind;
pub mod csv;
pub mod ledger;
pub mod libraries;
pub mod measure;
pub mod methods;
pub mod pair;
pub mod recorded;
pub mod scene;
