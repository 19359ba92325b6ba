// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Minkowski portal refinement (MPR), and the searches for local minima of the depth that are based on it.
//!
//! | file | contents |
//! |---|---|
//! | [`portal`] | portal discovery and refinement on known vertices |
//! | [`local`] | the local search: from portal to portal on known vertices |
//! | [`newton`] | Newton's step of the local search on smooth bodies |
//! | [`gao`] | the published method (W. Gao), on support calls only |
//! | [`directional`] | the depth along a given direction, by the published method |

pub mod directional;
pub mod gao;
pub mod local;
pub mod newton;
pub mod portal;
