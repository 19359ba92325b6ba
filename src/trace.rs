// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Prints how a query runs, on stderr: feature `trace`. Without it every function here does nothing.
//!
//! One line for each evaluated direction: the stage that chose it, the direction, its support value, and the bounds of
//! the depth so far, metres. The last line of a query has its status and bounds.

use crate::math::Vec3;
use crate::types::Solution;
use core::cell::Cell;

const IS_ON: bool = cfg!(feature = "trace");

thread_local! {
    static STAGE: Cell<&'static str> = const { Cell::new("start") };
    static LOWER: Cell<f64> = const { Cell::new(0.0) };
}

/// Names the stage that chooses the next directions.
#[inline(always)]
pub fn stage(name: &'static str) {
    if IS_ON {
        STAGE.set(name);
    }
}

/// Notes the lower bound of the depth, metres.
#[inline(always)]
pub fn lower_bound(lower: f64) {
    if IS_ON {
        LOWER.set(lower);
    }
}

/// Prints an evaluated direction with its support value and the upper bound after it, metres.
#[inline(always)]
pub fn direction(dir: &Vec3, h: f64, upper: f64) {
    if IS_ON {
        let (stage, lower) = (STAGE.get(), LOWER.get());
        eprintln!(
            "{stage:<16} dir {:+.9} {:+.9} {:+.9}  h {h:+.9e}  bounds {lower:.9e} to {upper:.9e}",
            dir.x, dir.y, dir.z
        );
    }
}

/// Prints the end of a query; `None`: it has no result.
#[inline(always)]
pub fn end(hit: Option<&Solution>) {
    if IS_ON {
        match hit {
            Some(hit) => eprintln!(
                "end              {:?}, bounds {:.9e} to {:.9e}",
                hit.status, hit.depth_lower, hit.depth
            ),
            None => eprintln!("end              separated, or an invalid argument or point"),
        }
        STAGE.set("start");
        LOWER.set(0.0);
    }
}
