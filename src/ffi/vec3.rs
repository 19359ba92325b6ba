// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exports libccd's distances of points from segments and triangles, and its three data objects.

use super::types::ccd_vec3_t;
use super::write;
use crate::geometry::barycentric::{self, ClosestPoint};
use crate::math::{Real, Vec3};

/// Returns the squared distance, m², of point `p` from segment `ab`, and writes the closest point
/// to `witness` unless that is NULL. Both cases return the same bits.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdVec3PointSegmentDist2(
    p: *const ccd_vec3_t,
    a: *const ccd_vec3_t,
    b: *const ccd_vec3_t,
    witness: *mut ccd_vec3_t,
) -> Real {
    // SAFETY: [inputs].
    let (p, a, b) = unsafe { (read(p), read(a), read(b)) };
    // SAFETY: [outputs].
    unsafe { write_closest(&p, barycentric::segment(&p, &a, &b), witness) }
}

/// Returns the squared distance, m², of point `p` from triangle `abc`, and writes the closest point
/// to `witness` unless that is NULL. Both cases return the same bits.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdVec3PointTriDist2(
    p: *const ccd_vec3_t,
    a: *const ccd_vec3_t,
    b: *const ccd_vec3_t,
    c: *const ccd_vec3_t,
    witness: *mut ccd_vec3_t,
) -> Real {
    // SAFETY: [inputs].
    let (p, a, b, c) = unsafe { (read(p), read(a), read(b), read(c)) };
    // SAFETY: [outputs].
    unsafe { write_closest(&p, barycentric::triangle(&p, &a, &b, &c), witness) }
}

/// Reads a vector of the caller.
#[inline(always)]
unsafe fn read(v: *const ccd_vec3_t) -> Vec3 {
    // SAFETY: [inputs].
    unsafe { *v }.into()
}

/// Writes the closest point to `witness` unless that is NULL, and returns its squared distance.
#[inline(always)]
unsafe fn write_closest<const N: usize>(
    p: &Vec3,
    at: ClosestPoint<N>,
    witness: *mut ccd_vec3_t,
) -> Real {
    let point = ccd_vec3_t::from(at.point);
    // SAFETY: [outputs]; the inputs were copied, so it may be one of them.
    unsafe { write(witness, point) };
    distance2(&(*p).into(), &point)
}

/// Returns the squared distance of two points, in the caller's precision, as `ccdVec3Dist2` does.
#[inline(always)]
pub(super) fn distance2(a: &ccd_vec3_t, b: &ccd_vec3_t) -> Real {
    let [x, y, z] = [0, 1, 2].map(|i| a.v[i] - b.v[i]);
    x * x + y * y + z * z
}

/// Points to the origin. Programs copy this object by relocation: its size is part of the ABI.
#[unsafe(no_mangle)]
pub static mut ccd_vec3_origin: *mut ccd_vec3_t = &raw mut ORIGIN;

/// Points to [`ccd_points_on_sphere_len`] unit vectors: the icosahedron subdivided
/// once, to libccd's six decimals.
#[unsafe(no_mangle)]
pub static mut ccd_points_on_sphere: *mut ccd_vec3_t = (&raw mut POINTS_ON_SPHERE).cast();

/// The number of vectors that [`ccd_points_on_sphere`] points to.
#[unsafe(no_mangle)]
pub static mut ccd_points_on_sphere_len: usize = 42;

static mut ORIGIN: ccd_vec3_t = ccd_vec3_t { v: [0.0; 3] };

#[rustfmt::skip]
static mut POINTS_ON_SPHERE: [[Real; 3]; 42] = [
    [0.0, -0.0, -1.0], [0.723608, -0.525725, -0.447219], [-0.276388, -0.850649, -0.447219],
    [-0.894426, -0.0, -0.447216], [-0.276388, 0.850649, -0.44722], [0.723608, 0.525725, -0.447219],
    [0.276388, -0.850649, 0.44722], [-0.723608, -0.525725, 0.447219], [-0.723608, 0.525725, 0.447219],
    [0.276388, 0.850649, 0.447219], [0.894426, 0.0, 0.447216], [-0.0, 0.0, 1.0],
    [0.425323, -0.309011, -0.850654], [-0.162456, -0.499995, -0.850654], [0.262869, -0.809012, -0.525738],
    [0.425323, 0.309011, -0.850654], [0.850648, -0.0, -0.525736], [-0.52573, -0.0, -0.850652],
    [-0.68819, -0.499997, -0.525736], [-0.162456, 0.499995, -0.850654], [-0.68819, 0.499997, -0.525736],
    [0.262869, 0.809012, -0.525738], [0.951058, 0.309013, 0.0], [0.951058, -0.309013, 0.0],
    [0.587786, -0.809017, 0.0], [0.0, -1.0, 0.0], [-0.587786, -0.809017, 0.0],
    [-0.951058, -0.309013, -0.0], [-0.951058, 0.309013, -0.0], [-0.587786, 0.809017, -0.0],
    [-0.0, 1.0, -0.0], [0.587786, 0.809017, -0.0], [0.68819, -0.499997, 0.525736],
    [-0.262869, -0.809012, 0.525738], [-0.850648, 0.0, 0.525736], [-0.262869, 0.809012, 0.525738],
    [0.68819, 0.499997, 0.525736], [0.52573, 0.0, 0.850652], [0.162456, -0.499995, 0.850654],
    [-0.425323, -0.309011, 0.850654], [-0.425323, 0.309011, 0.850654], [0.162456, 0.499995, 0.850654],
];
