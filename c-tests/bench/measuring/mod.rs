// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Measuring: libraries side by side, scenes with truth, methods, measurement.
//! Each module uses those before it alone: `csv`, `libraries`, `scene`,
//! `methods`, `deep`, `measure`, `recorded`. The benchmark (`c-tests/bench`) and the test of
//! the figures that a change may not lose (`support_counts.rs`) are made of them.

// The benchmark and the test each use a part.
#![allow(dead_code)]

pub mod callgrind;
pub mod csv;
pub mod deep;
pub mod libraries;
pub mod measure;
pub mod methods;
pub mod recorded;
pub mod scene;
