// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The benchmark's parts: libraries side by side, scenes with truth, methods,
//! measurement.

// The benchmark and its test each use a part.
#![allow(dead_code)]

pub mod deep;
pub mod libraries;
pub mod measure;
pub mod methods;
pub mod peers;
pub mod progress;
pub mod scene;
