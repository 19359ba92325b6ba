// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants of the contact position, with what was tried.

use crate::math::EPSILON;

/// The factor in T = TILT_FACTOR · sqrt(depth / extent), a tangent. A curved surface whose radius is the extent has
/// a drop of 1.6 depths at that tilt (R T²/2), and all corners are found of a face whose drop grows by a depth
/// over its width. Measured: with the factor divided by 1.2 a corner of a leaning box is missed; multiplied by
/// 1.2 the position of a cone on its side jumps by 7 mm.
pub const TILT_FACTOR: f64 = 1.8;
/// Largest T, 14°; reached if the depth exceeds extent / 52.
pub const MAX_TILT_TAN: f64 = 0.25;
/// Least tilt of an evaluated direction that replaces the query of a corner or an edge, relative to T. Measured: root
/// mean square error of 7.5 mm with 0.4, 1.8 mm with 0.6.
pub const MIN_COVER: f64 = 0.6;
/// Least cosine between the normal and an evaluated direction that is used. Others return vertices at the side or
/// at the back of the object.
pub const MIN_COSINE: f64 = 0.1;
/// Least difference of two directions that prove a vertex if both return it, relative to T. A curved surface returns
/// nearly the same vertex for nearly the same direction.
pub const MIN_TURN_REL: f64 = 0.05;
/// Least number of known vertices, none of them returned twice, of an object that mirror images are taken of. With 0
/// the corners of a box of which little is known are taken for a curved surface: error 14 mm.
pub const MIN_CURVED_KNOWN: usize = 4;
/// Largest distance of a vertex from the mirror plane, relative to T times the extent: the radius of curvature is at
/// most 1.1 times the extent. Corners of faces are farther away. Measured: with 1 a position is off the object in one
/// hit of 30,000, with 0.5 a hit takes 0.2 support points more.
pub const MAX_CURVED_ASIDE: f64 = 0.8;
/// Least height that such a vertex has lost by its drop, relative to that distance: 0.35 on a sphere, 0 on a face.
pub const MIN_CURVED_DROP: f64 = 0.3;
/// Largest such loss of the vertex away from the center, relative to that distance: 0.7 on a sphere.
pub const MAX_CURVED_DROP: f64 = 0.9;
/// Largest length of the sum of two opposite vertices that count as symmetric, relative to the extent.
pub const SYMMETRY_REL_TOL: f64 = 0.004;
/// A feature no larger than this, relative to the extent, counts as a point: the center of pressure is within a
/// quarter of that size. No corner is searched beyond a shorter side.
pub const POINT_REL: f64 = 0.016;
/// Distance, relative to the extent, below which two vertices are the same.
pub const SAME_REL: f64 = 1e-7;
/// Largest drop, in depths, that counts as in the support plane: an error of a third of this fraction of the half
/// width. Insensitive: 0.01 to 0.05 tried.
pub const IN_PLANE_DROP_TOL: f64 = 0.02;
/// Largest difference of drops that count as equal, in depths. Insensitive: 0.1 to 1 tried.
pub const SAME_DROP_TOL: f64 = 0.1;
/// Largest distance of a vertex from the fitted rim of a disc, relative to the radius: ten times the rounding of
/// callbacks in single precision.
pub const RIM_REL_TOL: f64 = if EPSILON < 1e-10 { 1e-4 } else { 1e-3 };
/// Fraction of the smallest drop of all vertices that is subtracted from each: a curved surface of radius R has
/// the drop R T²/2 all around. Measured: with 0 the position of a lying capsule jumps by 5 mm; with 1, exact for
/// spheres, its error is 7 mm.
pub const COMMON_DROP_FACTOR: f64 = 0.75;
/// Distance by which vertices are moved outwards, in depths, so that an edge has an area and the deepest
/// point is inside. Small compared with the flank of an edge ([`crate::contact::center_of_pressure`]).
pub const VERTEX_OFFSET_REL: f64 = 1.0 / 512.0;
