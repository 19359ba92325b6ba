// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's Table II: errors of the direction.

use super::primitives;
use crate::measuring::measure::Row;

/// Milliradians of a pair: Algorithm 4/5 from guesses 5°, 25° and 45° off, and EPA.
pub const PUBLISHED: [[f64; 4]; 3] = [[1.82, 1.38, 1.93, 8.84], [3.19, 3.42, 3.23, 10.39], [2.25, 2.31, 2.30, 10.72]];

pub fn table(rows: &[Row]) -> String {
    primitives::table(
        rows,
        PUBLISHED,
        &[
            ("mean of all runs, mrad", |row| row.direction_mean.unwrap_or(f64::NAN)),
            ("mean of those within 1 mm, mrad", |row| row.direction_mean_1mm.unwrap_or(f64::NAN)),
            ("99 % of all, mrad", |row| row.direction_p99.unwrap_or(f64::NAN)),
        ],
    )
}
