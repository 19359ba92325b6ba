// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tuned constants of the contact position and the contact manifold, with what was tried. Extent: the distance of
//! an object's center from the contact.

/// The factor in T = SLOPE_FACTOR · sqrt(depth / extent), a tangent. A curved surface whose radius is the extent has
/// a drop of one depth at that slope (R T²/2), and all corners are found of a face whose drop grows by 0.7 depths over its
/// width. Measured (`pos pressure`): with 1.6 the error of a lying cylinder is 6.9 mm in place of 6.0 mm.
pub const SLOPE_FACTOR: f64 = 1.4;
/// Largest slope, a tangent: 14°. T reaches it if the depth exceeds extent / 31, and the first directions of a face have it. With
/// a larger one surfaces beside a face are taken for it; a smaller one underestimates the size of curved objects.
pub const MAX_SLOPE: f64 = 0.25;
/// Drop above which a slope is lowered to the chord's, in depths: at T a surface whose radius is the extent has one. Measured
/// (`pos_flat axes 1000`): with 1.96 the position of a cone on its side jumps by 14 mm in place of 9 mm where the axes of the
/// contact change.
pub const MAX_DROP: f64 = 1.7;
/// Largest shift of the mean of an outline's corners by one that is not searched, relative to the size; an outline that is
/// smaller is a point. Measured: with 0.04 positions on faces of eight corners jump, for 0.2 support points less a recorded hit;
/// with 0.02 that hit takes 0.3 more.
pub const CORNER_SHIFT_REL: f64 = 0.03;
/// Largest drop that counts as none, in depths: an error of a third of this fraction of the half width. Insensitive: 0.01 to
/// 0.1 tried.
pub const DROP_TOL: f64 = CORNER_SHIFT_REL;
/// Fraction of the least drop of all evaluated vertices that is subtracted from each: with radius R the drop is R T²/2 all
/// around. Measured (`pos pressure`, `pos rounded`): with 0 lying capsules jump by 9 mm and the error of rounded edges is 1.08 mm
/// in place of 0.25 mm, with 0.9 the error of a lying capsule is 5.2 mm in place of 4.0 mm.
pub const COMMON_DROP_FACTOR: f64 = 0.75;
/// Distance by which vertices are moved outwards, in depths, so that an edge has an area and the deepest point is inside;
/// closer vertices are the same. Small compared with the flank of an edge ([`crate::contact::center_of_pressure`]).
pub const VERTEX_OFFSET_REL: f64 = 1.0 / 512.0;
/// The assumed slope of flanks. Insensitive: 1 to 8 tried; with 1000 the error of a brick on an edge is 7.6 mm in place of
/// 0.6 mm (`pos pressure`).
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
/// Least slop, in rounding errors of a coordinate: the slope must be well above the rounding error of the
/// directions in a callback.
pub const MIN_SLOP_ROUNDINGS: f64 = 4.0;
/// Distance, in slops, below which samples may be of one rounded corner. The samples of a ball are 8 slops apart.
pub const ROUND_CORNER_SLOPS: f64 = 16.0;
/// Largest distance of the vertex at three quarters of a slope from the middle of those at the whole and at half of it, on a
/// rounded corner, relative to their distance: 0 on a ball, 0.5 where it is one of two sharp corners.
pub const ROUND_CORNER_REL: f64 = 0.125;
/// Lean of the outward direction of a cached side towards its second corner: 3.6°, by which the face may rotate about the
/// normal. Insensitive: 1/64 to 1/8 tried.
pub const CACHED_LEAN: f64 = 1.0 / 16.0;
