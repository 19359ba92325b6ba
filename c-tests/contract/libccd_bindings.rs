// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Made by bindgen from libccd's installed headers; see bindings.rs.

pub type ccd_real_t = f64;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct _ccd_vec3_t {
    pub v: [ccd_real_t; 3usize],
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
const _: () = {
    ["Size of _ccd_vec3_t"][::std::mem::size_of::<_ccd_vec3_t>() - 24usize];
    ["Alignment of _ccd_vec3_t"][::std::mem::align_of::<_ccd_vec3_t>() - 8usize];
    ["Offset of field: _ccd_vec3_t::v"][::std::mem::offset_of!(_ccd_vec3_t, v) - 0usize];
};
pub type ccd_vec3_t = _ccd_vec3_t;
unsafe extern "C" {
    pub static mut ccd_vec3_origin: *mut ccd_vec3_t;
}
unsafe extern "C" {
    pub static mut ccd_points_on_sphere: *mut ccd_vec3_t;
}
unsafe extern "C" {
    pub static mut ccd_points_on_sphere_len: usize;
}
unsafe extern "C" {
    pub fn ccdVec3PointSegmentDist2(
        P: *const ccd_vec3_t,
        a: *const ccd_vec3_t,
        b: *const ccd_vec3_t,
        witness: *mut ccd_vec3_t,
    ) -> ccd_real_t;
}
unsafe extern "C" {
    pub fn ccdVec3PointTriDist2(
        P: *const ccd_vec3_t,
        a: *const ccd_vec3_t,
        b: *const ccd_vec3_t,
        c: *const ccd_vec3_t,
        witness: *mut ccd_vec3_t,
    ) -> ccd_real_t;
}
pub type ccd_support_fn = ::std::option::Option<
    unsafe extern "C" fn(
        obj: *const ::std::os::raw::c_void,
        dir: *const ccd_vec3_t,
        vec: *mut ccd_vec3_t,
    ),
>;
pub type ccd_first_dir_fn = ::std::option::Option<
    unsafe extern "C" fn(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        dir: *mut ccd_vec3_t,
    ),
>;
pub type ccd_center_fn = ::std::option::Option<
    unsafe extern "C" fn(obj1: *const ::std::os::raw::c_void, center: *mut ccd_vec3_t),
>;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct _ccd_t {
    pub first_dir: ccd_first_dir_fn,
    pub support1: ccd_support_fn,
    pub support2: ccd_support_fn,
    pub center1: ccd_center_fn,
    pub center2: ccd_center_fn,
    pub max_iterations: ::std::os::raw::c_ulong,
    pub epa_tolerance: ccd_real_t,
    pub mpr_tolerance: ccd_real_t,
    pub dist_tolerance: ccd_real_t,
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
const _: () = {
    ["Size of _ccd_t"][::std::mem::size_of::<_ccd_t>() - 72usize];
    ["Alignment of _ccd_t"][::std::mem::align_of::<_ccd_t>() - 8usize];
    ["Offset of field: _ccd_t::first_dir"][::std::mem::offset_of!(_ccd_t, first_dir) - 0usize];
    ["Offset of field: _ccd_t::support1"][::std::mem::offset_of!(_ccd_t, support1) - 8usize];
    ["Offset of field: _ccd_t::support2"][::std::mem::offset_of!(_ccd_t, support2) - 16usize];
    ["Offset of field: _ccd_t::center1"][::std::mem::offset_of!(_ccd_t, center1) - 24usize];
    ["Offset of field: _ccd_t::center2"][::std::mem::offset_of!(_ccd_t, center2) - 32usize];
    ["Offset of field: _ccd_t::max_iterations"]
        [::std::mem::offset_of!(_ccd_t, max_iterations) - 40usize];
    ["Offset of field: _ccd_t::epa_tolerance"]
        [::std::mem::offset_of!(_ccd_t, epa_tolerance) - 48usize];
    ["Offset of field: _ccd_t::mpr_tolerance"]
        [::std::mem::offset_of!(_ccd_t, mpr_tolerance) - 56usize];
    ["Offset of field: _ccd_t::dist_tolerance"]
        [::std::mem::offset_of!(_ccd_t, dist_tolerance) - 64usize];
};
pub type ccd_t = _ccd_t;
unsafe extern "C" {
    pub fn ccdFirstDirDefault(
        o1: *const ::std::os::raw::c_void,
        o2: *const ::std::os::raw::c_void,
        dir: *mut ccd_vec3_t,
    );
}
unsafe extern "C" {
    pub fn ccdGJKIntersect(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        ccd: *const ccd_t,
    ) -> ::std::os::raw::c_int;
}
unsafe extern "C" {
    pub fn ccdGJKSeparate(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        ccd: *const ccd_t,
        sep: *mut ccd_vec3_t,
    ) -> ::std::os::raw::c_int;
}
unsafe extern "C" {
    pub fn ccdGJKPenetration(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        ccd: *const ccd_t,
        depth: *mut ccd_real_t,
        dir: *mut ccd_vec3_t,
        pos: *mut ccd_vec3_t,
    ) -> ::std::os::raw::c_int;
}
unsafe extern "C" {
    pub fn ccdMPRIntersect(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        ccd: *const ccd_t,
    ) -> ::std::os::raw::c_int;
}
unsafe extern "C" {
    pub fn ccdMPRPenetration(
        obj1: *const ::std::os::raw::c_void,
        obj2: *const ::std::os::raw::c_void,
        ccd: *const ccd_t,
        depth: *mut ccd_real_t,
        dir: *mut ccd_vec3_t,
        pos: *mut ccd_vec3_t,
    ) -> ::std::os::raw::c_int;
}
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct _ccd_quat_t {
    pub q: [ccd_real_t; 4usize],
}
#[allow(clippy::unnecessary_operation, clippy::identity_op)]
const _: () = {
    ["Size of _ccd_quat_t"][::std::mem::size_of::<_ccd_quat_t>() - 32usize];
    ["Alignment of _ccd_quat_t"][::std::mem::align_of::<_ccd_quat_t>() - 8usize];
    ["Offset of field: _ccd_quat_t::q"][::std::mem::offset_of!(_ccd_quat_t, q) - 0usize];
};
pub type ccd_quat_t = _ccd_quat_t;
