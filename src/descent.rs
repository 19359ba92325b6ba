// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum of the penetration depth.

pub mod cuts;
pub mod flat;
mod lanes;
