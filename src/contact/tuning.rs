// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants of the contact position and the contact manifold, with what was tried. Extent: the largest distance of
//! an object's known vertices and center from the contact. "Off the object": of a million hits of the test `pos.c`.

/// The factor in T = TILT_FACTOR · sqrt(depth / extent), a tangent. A curved surface whose radius is the extent has
/// a drop of 1.6 depths at that tilt (R T²/2), and all corners are found of a face whose drop grows by a depth
/// over its width. Measured: with the factor divided by 1.2 a corner of a leaning box is missed; multiplied by
/// 1.2 the position of a cone on its side jumps by 7 mm.
pub const TILT_FACTOR: f64 = 1.8;
/// Largest tilt, a tangent: 14°. T reaches it if the depth exceeds extent / 52; the first directions of a face have it, and
/// the sine between segments that count as parallel is less. With a larger one surfaces beside a face are taken for it; a
/// smaller one underestimates the size of curved objects.
pub const MAX_TILT_TAN: f64 = 0.25;
/// Least tilt of an evaluated direction that replaces the query of a corner or an edge, relative to T. Measured: root
/// mean square error of 7.5 mm with 0.4, 1.8 mm with 0.6.
pub const MIN_COVER: f64 = 0.6;
/// Number of most recent known vertices used. Measured: with 8 a hit takes 0.8 % fewer instructions and 0.1 % more support
/// points, and a position of nearly parallel frusta (`judged hard`) is outside.
pub const MAX_KNOWN: usize = 16;
/// Largest distance of a vertex from the mirror plane, relative to T times the extent: the radius of curvature is at
/// most 1.1 times the extent. Also the largest height lost by the drop, relative to the distance: 0.7 on a sphere. Corners
/// of faces are farther away. Measured: with 1, 2 positions are off the object, with 0.5 a hit takes 0.2 support points more.
pub const MAX_CURVED_REL: f64 = 0.8;
/// Least height that such a vertex has lost by its drop, relative to that distance: 0.35 on a sphere, 0 on a face. Measured:
/// with 0, 7 positions are off the object, by up to 7.5 mm.
pub const MIN_CURVED_DROP: f64 = 0.3;
/// Largest size, relative to the extent, that counts as none: of a feature that is a point, a side beyond which no corner is
/// searched, a gap between symmetric points or in a parallelogram, a distance from a disc's rim. The position is within a
/// quarter of it. Insensitive: 0.004 to 0.016 tried.
pub const POINT_REL: f64 = 0.008;
/// Largest drop, and difference of drops, that count as none, in depths: an error of a third of this fraction of the half
/// width. Insensitive: 0.01 to 0.1 tried.
pub const DROP_TOL: f64 = 0.05;
/// Fraction of the smallest drop of all vertices of a curved surface that is subtracted from each: with radius R the drop is
/// R T²/2 all around. Measured: with 0 the position of a lying capsule jumps by 5 mm; with 1, exact for spheres, its error
/// is 7 mm.
pub const COMMON_DROP_FACTOR: f64 = 0.75;
/// Distance by which vertices are moved outwards, in depths, so that an edge has an area and the deepest point is inside;
/// closer vertices are the same. Small compared with the flank of an edge ([`crate::contact::center_of_pressure`]).
pub const VERTEX_OFFSET_REL: f64 = 1.0 / 512.0;
/// The assumed slope of flanks. Insensitive: 2 to 8 tried.
pub const FLANK_SLOPE: f64 = 4.0;
/// Depths, relative to the sum of both objects' extents from their centers along n, from which on the deep position counts,
/// and from which on it alone does. Measured against the centroid of the overlap: at 0.2 the center of pressure is 4 % of
/// the size closer (root mean square, boxes, hulls, curved bodies), at 0.4 both are 9 to 14 % off, at 0.55 the deep position
/// is 3 % closer.
pub const DEEP_RANGE: [f64; 2] = [0.2, 0.4];

/// Least slop of a face, relative to the depth. Along a normal whose depth is 0.1 % above the minimum the corners of a face
/// differ in height by that error times the ratio of the corners' distance to the distance of the contact from the
/// closer corner. Measured on 17,351 pairs of boxes and of a box and an ellipsoid, 1 cm deep, with a requested slop
/// of 0: a corner is found instead of a face or an edge in 212 pairs with the value 0, in 21 with 0.001, in 12 with
/// 0.002, in 1 with 0.01.
pub const MIN_SLOP_REL: f64 = 0.01;
/// Least slop, in rounding errors of a coordinate: the tilt must be well above the rounding error of the
/// directions in a callback.
pub const MIN_SLOP_ROUNDINGS: f64 = 4.0;
/// Distance, in slops, below which samples may be of one rounded corner. The samples of a ball are 8 slops apart.
pub const ROUND_CORNER_SLOPS: f64 = 16.0;
/// Largest distance of the vertex at three quarters of a tilt from the middle of those at the whole and at half of it, on a
/// rounded corner, relative to their distance: 0 on a ball, 0.5 where it is one of two sharp corners.
pub const ROUND_CORNER_REL: f64 = 0.125;
/// Lean of the outward direction of a cached side towards its second corner: 3.6°, by which the face may rotate about the
/// normal. Insensitive: 1/64 to 1/8 tried.
pub const CACHED_LEAN: f64 = 1.0 / 16.0;
