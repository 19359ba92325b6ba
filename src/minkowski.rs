// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Minkowski difference D = obj1 − obj2 of a pair, and its known vertices.
//!
//! Every support call returns one point of each object, its *vertex*. A [`VertexSet`](vertex_set::VertexSet)
//! keeps them, the *known vertices*: a_1 … a_k of obj1, b_1 … b_k of obj2. The *known differences* are all
//! k² differences a_i − b_j. They are points of D, so conv{a_i} − conv{b_j} is an *inner model* of D, whose
//! support function costs dot products and no callback. MPR, EPA and GJK need *a* point of D beyond their
//! current plane, not the farthest one: they take a known difference if one is far enough beyond the plane,
//! and otherwise evaluate the callbacks ([`SupportQuery`](support_query::SupportQuery)).
//!
//! | file | contents |
//! |---|---|
//! | [`support`] | support functions, D, support points |
//! | [`vertex_set`] | the known vertices and the support function of their differences |
//! | [`general_position`] | the tilt of the directions that are evaluated |
//! | [`support_query`] | evaluation, upper bound, separating-axis test |
//! | [`tolerance`] | effective tolerance, contact eps, rounding |
//! | [`sphere_fit`] | sphere fits of the two objects |
//! | [`newton`] | Newton's step to a minimum of a smooth D |
//! | [`predictor`] | proposes the next direction from models of D, and judges the last one |
//! | [`separating_axis`] | the axis test for pairs that stay separated |
//! | [`warm_start`] | the state of a pair from one query to the next |
//! | [`tuning`] | the tuned constants of the search |
//! | [`validate`] | tests of a support function and a center |

pub mod general_position;
pub mod newton;
pub mod predictor;
pub mod separating_axis;
pub mod sphere_fit;
pub mod support;
pub mod support_query;
pub mod tolerance;
pub mod tuning;
pub mod validate;
pub mod vertex_set;
pub mod warm_start;
