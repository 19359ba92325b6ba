// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's algorithms, as published: W. Gao, *Efficient Incremental Penetration Depth
//! Estimation between Convex Geometries*.
//!
//! [`portal`] is its portal (Sec. II-C), [`along`] Algorithm 1, [`incremental`] Algorithms 3
//! to 5, [`planar`] the case n = 2 (Sec. II-A).

pub mod along;
pub mod incremental;
#[cfg(test)]
mod planar;
pub mod portal;
