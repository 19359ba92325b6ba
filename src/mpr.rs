// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Minkowski portal refinement on known vertices.

pub mod directional;
pub mod gao;
pub mod local;
pub mod newton;
pub mod portal;
