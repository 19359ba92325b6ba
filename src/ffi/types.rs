// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Defines the C types of libccd's exported functions with the names and the layout of libccd.so.2; sizes and offsets
//! are asserted below.

#![allow(non_camel_case_types, missing_docs)]

use core::ffi::{c_int, c_ulong, c_void};

use crate::math::{Real, Vec3, from_real, to_real};

/// A point (metres) or a direction.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ccd_vec3_t {
    pub v: [Real; 3],
}

impl From<Vec3> for ccd_vec3_t {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        Self { v: to_real(&v) }
    }
}

impl From<[Real; 3]> for ccd_vec3_t {
    #[inline(always)]
    fn from(v: [Real; 3]) -> Self {
        Self { v }
    }
}

impl From<ccd_vec3_t> for Vec3 {
    #[inline(always)]
    fn from(v: ccd_vec3_t) -> Self {
        from_real(v.v)
    }
}

/// Writes a point of `obj` farthest along `dir` to `vec`.
pub type ccd_support_fn =
    unsafe extern "C-unwind" fn(obj: *const c_void, dir: *const ccd_vec3_t, vec: *mut ccd_vec3_t);
/// Writes the first direction of a GJK query to `dir`.
pub type ccd_first_dir_fn =
    unsafe extern "C-unwind" fn(obj1: *const c_void, obj2: *const c_void, dir: *mut ccd_vec3_t);
/// Writes an interior point of `obj` to `center`.
pub type ccd_center_fn = unsafe extern "C-unwind" fn(obj: *const c_void, center: *mut ccd_vec3_t);

/// Callbacks and settings of a query. A callback that a query does not use may be NULL, and a
/// tolerance that it does not read may be uninitialised: never read the whole struct.
#[repr(C)]
pub struct ccd_t {
    pub first_dir: Option<ccd_first_dir_fn>,
    pub support1: Option<ccd_support_fn>,
    pub support2: Option<ccd_support_fn>,
    pub center1: Option<ccd_center_fn>,
    pub center2: Option<ccd_center_fn>,
    pub max_iterations: c_ulong,
    pub epa_tolerance: Real,
    pub mpr_tolerance: Real,
    pub dist_tolerance: Real,
}

/// A support point `v = v1 - v2` of the Minkowski difference, and the vertices of both objects.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ccd_support_t {
    pub v: ccd_vec3_t,
    pub v1: ccd_vec3_t,
    pub v2: ccd_vec3_t,
}

/// Node or head of a circular, doubly linked, intrusive list.
#[repr(C)]
pub struct ccd_list_t {
    pub next: *mut ccd_list_t,
    pub prev: *mut ccd_list_t,
}

/// [`ccd_pt_el_t::kind`] of a vertex.
pub const CCD_PT_VERTEX: c_int = 1;
/// [`ccd_pt_el_t::kind`] of an edge.
pub const CCD_PT_EDGE: c_int = 2;
/// [`ccd_pt_el_t::kind`] of a face.
pub const CCD_PT_FACE: c_int = 3;

/// The common first part of vertices, edges and faces.
#[repr(C)]
pub struct ccd_pt_el_t {
    /// C's field `type`.
    pub kind: c_int,
    /// Squared distance from the origin, m².
    pub dist: Real,
    /// The point of the element closest to the origin.
    pub witness: ccd_vec3_t,
    /// Link in the polytope's list of this kind.
    pub list: ccd_list_t,
}

#[repr(C)]
pub struct ccd_pt_vertex_t {
    pub el: ccd_pt_el_t,
    pub id: c_int,
    pub v: ccd_support_t,
    /// Head of the list of edges that end here, linked by [`ccd_pt_edge_t::vertex_list`].
    pub edges: ccd_list_t,
}

#[repr(C)]
pub struct ccd_pt_edge_t {
    pub el: ccd_pt_el_t,
    pub vertex: [*mut ccd_pt_vertex_t; 2],
    /// Adjacent faces, filled from the front; NULL if there is none.
    pub faces: [*mut ccd_pt_face_t; 2],
    /// Links in the edge lists of the two vertices.
    pub vertex_list: [ccd_list_t; 2],
}

#[repr(C)]
pub struct ccd_pt_face_t {
    pub el: ccd_pt_el_t,
    pub edge: [*mut ccd_pt_edge_t; 3],
}

/// A polytope: three lists and the element closest to the origin.
#[repr(C)]
pub struct ccd_pt_t {
    pub vertices: ccd_list_t,
    pub edges: ccd_list_t,
    pub faces: ccd_list_t,
    /// NULL until an element is added or after `nearest` was deleted.
    pub nearest: *mut ccd_pt_el_t,
    /// Squared, like [`ccd_pt_el_t::dist`].
    pub nearest_dist: Real,
    pub nearest_type: c_int,
}

/// Asserts sizes and offsets at compile time: `double / single` bytes, with the 8-byte
/// pointers and longs of LP64.
#[cfg(all(unix, target_pointer_width = "64"))]
macro_rules! layout {
    ($($type:ident: $double:literal / $single:literal {
        $($field:ident: $off_double:literal / $off_single:literal),* $(,)?
    })*) => { $(
        const _: () = {
            let double = size_of::<Real>() == 8;
            assert!(size_of::<$type>() == if double { $double } else { $single });
            $(assert!(core::mem::offset_of!($type, $field)
                == if double { $off_double } else { $off_single });)*
        };
    )* };
}

#[cfg(all(unix, target_pointer_width = "64"))]
layout! {
    ccd_vec3_t: 24 / 12 { v: 0 / 0 }
    ccd_t: 72 / 64 {
        first_dir: 0 / 0, support1: 8 / 8, support2: 16 / 16, center1: 24 / 24, center2: 32 / 32,
        max_iterations: 40 / 40,
        epa_tolerance: 48 / 48, mpr_tolerance: 56 / 52, dist_tolerance: 64 / 56,
    }
    ccd_support_t: 72 / 36 { v: 0 / 0, v1: 24 / 12, v2: 48 / 24 }
    ccd_list_t: 16 / 16 { next: 0 / 0, prev: 8 / 8 }
    ccd_pt_el_t: 56 / 40 { kind: 0 / 0, dist: 8 / 4, witness: 16 / 8, list: 40 / 24 }
    ccd_pt_vertex_t: 152 / 96 { el: 0 / 0, id: 56 / 40, v: 64 / 44, edges: 136 / 80 }
    ccd_pt_edge_t: 120 / 104 { el: 0 / 0, vertex: 56 / 40, faces: 72 / 56, vertex_list: 88 / 72 }
    ccd_pt_face_t: 80 / 64 { el: 0 / 0, edge: 56 / 40 }
    ccd_pt_t: 72 / 64 {
        vertices: 0 / 0, edges: 16 / 16, faces: 32 / 32,
        nearest: 48 / 48, nearest_dist: 56 / 56, nearest_type: 64 / 60,
    }
}
