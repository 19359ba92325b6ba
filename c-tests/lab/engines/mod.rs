// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Debian's FCL, ODE, MuJoCo and DART on both libraries, in the scenes that take minutes.

// The tests and the tables each use a part.
#![allow(dead_code)]

pub mod consumers;
pub mod price;
#[path = "../../engines/programs.rs"]
pub mod programs;
#[path = "../../engines/results.rs"]
pub mod results;
pub mod tables;
