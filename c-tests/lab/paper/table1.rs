// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's Table I: errors of the depth.

use super::primitives;
use crate::measuring::measure::Row;

/// Micrometres of a pair: Algorithm 4/5 from guesses 5°, 25° and 45° off, and EPA.
pub const PUBLISHED: [[f64; 4]; 3] = [[0.909, 1.018, 1.03, 1.58], [1.092, 1.12, 1.12, 0.39], [1.255, 1.31, 1.30, 1.72]];

pub fn table(rows: &[Row]) -> String {
    primitives::table(
        rows,
        PUBLISHED,
        &[
            ("mean of all runs, µm", |row| 1e6 * row.mean_error),
            ("mean of those within 1 mm, µm", |row| 1e6 * row.mean_error_1mm),
            ("median of all, µm", |row| 1e6 * row.median_error),
            ("more than 1 mm off, %", |row| row.beyond_1mm),
        ],
    )
}
