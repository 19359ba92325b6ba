// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's Table III: times.

use super::primitives;
use crate::measuring::measure::Row;

/// Microseconds of a pair: Algorithm 4/5 from guesses 5°, 25° and 45° off, and EPA.
pub const PUBLISHED: [[f64; 4]; 3] = [[1.9, 2.1, 2.3, 85.1], [1.6, 1.9, 2.0, 39.5], [2.0, 2.2, 2.4, 61.5]];

pub fn table(rows: &[Row]) -> String {
    primitives::table(
        rows,
        PUBLISHED,
        &[("mean, µs", |row| 1e-3 * row.ns.unwrap_or(f64::NAN)), ("support points", |row| row.supports)],
    )
}
