// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a query knows of its pair: the Minkowski difference D = obj1 − obj2 and its known vertices.
//!
//! Every support call returns one vertex of each object. A [`VertexSet`](vertex_set::VertexSet) keeps
//! them: a_1 … a_k of obj1, b_1 … b_k of obj2. D contains all k² differences a_i − b_j, so
//! conv{a_i} − conv{b_j} is an inner model of D whose support function costs dot products and no
//! callback. MPR, EPA and GJK need *a* vertex beyond their current plane, not *the* support vertex:
//! they take a known difference where one is far enough beyond, and query the callbacks
//! ([`SupportQuery`](query::SupportQuery)) where none is.
//!
//! | file | what it owns |
//! |---|---|
//! | [`support`] | support functions, D, support points |
//! | [`vertex_set`] | the known vertices and the support function of their differences |
//! | [`query`] | evaluation, upper bound, separating-axis test, inconsistent support functions |
//! | [`tolerance`] | tolerance in force, contact epsilon, rounding |
//! | [`validate`] | what is wrong with a support function |
//! | [`round_fit`] | sphere fits, which choose where to query |

pub mod query;
pub mod round_fit;
pub mod support;
pub mod tolerance;
pub mod validate;
pub mod vertex_set;
