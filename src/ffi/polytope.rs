// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exports libccd's polytope: vertices, edges and faces in intrusive lists, and the element
//! closest to the origin (libccd's field `nearest`). No solver here uses it. FCL's EPA does, with
//! inline functions of its own that unlink and free() the nodes allocated here.
//!
//! Therefore a node is one block of C's malloc, the links are ordered as libccd orders them, and
//! `nearest` is updated by libccd's rule. [`crate::geometry::barycentric`] computes the distances.

#![allow(
    unsafe_op_in_unsafe_fn,
    reason = "a polytope consists of raw pointers: every function needs [polytope] as a whole"
)]

use core::ffi::{c_char, c_int, c_void};
use core::mem::offset_of;
use core::ptr::null_mut;

use super::types::{
    CCD_PT_EDGE, CCD_PT_FACE, CCD_PT_VERTEX, ccd_list_t, ccd_pt_edge_t, ccd_pt_el_t, ccd_pt_face_t,
    ccd_pt_t, ccd_pt_vertex_t, ccd_support_t,
};
use super::{free, malloc};
use crate::geometry::barycentric;
use crate::math::{Real, Vec3};

/// Makes `pt` an empty polytope.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtInit(pt: *mut ccd_pt_t) {
    for list in lists(pt) {
        list_init(list);
    }
    reset_nearest(pt);
}

/// Frees every element and empties the lists. An edge or vertex that an element outside of the
/// lists still refers to stays allocated and linked.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtDestroy(pt: *mut ccd_pt_t) {
    // An element is not read after it was deleted.
    for face in elements::<ccd_pt_face_t>(&raw mut (*pt).faces) {
        for edge in (*face).edge {
            if (*edge).faces[0] == face {
                (*edge).faces[0] = (*edge).faces[1];
            }
            (*edge).faces[1] = null_mut();
        }
        delete(pt, &raw mut (*face).el);
    }
    for edge in elements::<ccd_pt_edge_t>(&raw mut (*pt).edges) {
        if (*edge).faces[0].is_null() {
            list_remove(&raw mut (*edge).vertex_list[0]);
            list_remove(&raw mut (*edge).vertex_list[1]);
            delete(pt, &raw mut (*edge).el);
        }
    }
    for vertex in elements::<ccd_pt_vertex_t>(&raw mut (*pt).vertices) {
        if (*vertex).edges.next == &raw mut (*vertex).edges {
            delete(pt, &raw mut (*vertex).el);
        }
    }
}

/// Adds a vertex and returns it; NULL when malloc fails.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtAddVertex(
    pt: *mut ccd_pt_t,
    v: *const ccd_support_t,
) -> *mut ccd_pt_vertex_t {
    let list = &raw mut (*pt).vertices;
    add(pt, list, CCD_PT_VERTEX, |vertex: *mut ccd_pt_vertex_t| {
        (*vertex).id = 0;
        (*vertex).v = *v;
        list_init(&raw mut (*vertex).edges);
    })
}

/// Adds the edge between two vertices and returns it; NULL when either is NULL or malloc fails.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtAddEdge(
    pt: *mut ccd_pt_t,
    v1: *mut ccd_pt_vertex_t,
    v2: *mut ccd_pt_vertex_t,
) -> *mut ccd_pt_edge_t {
    if v1.is_null() || v2.is_null() {
        return null_mut();
    }
    let list = &raw mut (*pt).edges;
    add(pt, list, CCD_PT_EDGE, |edge: *mut ccd_pt_edge_t| {
        (*edge).vertex = [v1, v2];
        (*edge).faces = [null_mut(); 2];
        list_append(&raw mut (*v1).edges, &raw mut (*edge).vertex_list[0]);
        list_append(&raw mut (*v2).edges, &raw mut (*edge).vertex_list[1]);
    })
}

/// Adds the face between three edges and returns it; NULL when any is NULL or malloc fails.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtAddFace(
    pt: *mut ccd_pt_t,
    e1: *mut ccd_pt_edge_t,
    e2: *mut ccd_pt_edge_t,
    e3: *mut ccd_pt_edge_t,
) -> *mut ccd_pt_face_t {
    if e1.is_null() || e2.is_null() || e3.is_null() {
        return null_mut();
    }
    let list = &raw mut (*pt).faces;
    add(pt, list, CCD_PT_FACE, |face: *mut ccd_pt_face_t| {
        (*face).edge = [e1, e2, e3];
        for edge in [e1, e2, e3] {
            let free_side = usize::from(!(*edge).faces[0].is_null());
            (*edge).faces[free_side] = face;
        }
    })
}

/// Recomputes distance and witness of every element; leaves `nearest` unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtRecomputeDistances(pt: *mut ccd_pt_t) {
    for list in lists(pt) {
        for element in elements(list) {
            compute_distance(element);
        }
    }
}

/// Returns the element closest to the origin: `pt->nearest`, recomputed only where that is NULL.
/// NULL when the polytope is empty.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtNearest(pt: *mut ccd_pt_t) -> *mut ccd_pt_el_t {
    if (*pt).nearest.is_null() {
        reset_nearest(pt);
        for list in lists(pt) {
            for element in elements(list) {
                update_nearest(pt, element);
            }
        }
    }
    (*pt).nearest
}

/// Appends the dump of [`ccdPtDumpSVT2`] to the named file; no effect when it cannot be opened.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtDumpSVT(pt: *mut ccd_pt_t, filename: *const c_char) {
    // [inputs]: a zero-terminated name.
    let file = fopen(filename, c"a".as_ptr());
    if !file.is_null() {
        dump(pt, file);
        fclose(file);
    }
}

/// Writes the polytope to an open C stream as text: points, edges as two and faces as three indices
/// of points. Stores the index of each vertex in its `id`.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPtDumpSVT2(pt: *mut ccd_pt_t, file: *mut c_void) {
    dump(pt, file);
}

/// Writes the text of [`ccdPtDumpSVT2`].
unsafe fn dump(pt: *mut ccd_pt_t, file: *mut c_void) {
    // [inputs]: an open stream; the formats match what is passed.
    fputs(c"-----\nPoints:\n".as_ptr(), file);
    for (id, vertex) in (0..).zip(elements::<ccd_pt_vertex_t>(&raw mut (*pt).vertices)) {
        (*vertex).id = id;
        let [x, y, z] = (*vertex).v.v.v.map(f64::from);
        fprintf(file, c"%lf %lf %lf\n".as_ptr(), x, y, z);
    }
    fputs(c"Edges:\n".as_ptr(), file);
    for edge in elements::<ccd_pt_edge_t>(&raw mut (*pt).edges) {
        let [a, b] = (*edge).vertex;
        fprintf(file, c"%d %d\n".as_ptr(), (*a).id, (*b).id);
    }
    fputs(c"Faces:\n".as_ptr(), file);
    for face in elements::<ccd_pt_face_t>(&raw mut (*pt).faces) {
        let [a, b, c] = corners(face);
        fprintf(file, c"%d %d %d\n".as_ptr(), (*a).id, (*b).id, (*c).id);
    }
}

unsafe extern "C" {
    fn fopen(name: *const c_char, mode: *const c_char) -> *mut c_void;
    fn fclose(file: *mut c_void) -> c_int;
    fn fputs(text: *const c_char, file: *mut c_void) -> c_int;
    fn fprintf(file: *mut c_void, format: *const c_char, ...) -> c_int;
}

/// Unlinks an element from the polytope's list and frees it.
unsafe fn delete(pt: *mut ccd_pt_t, element: *mut ccd_pt_el_t) {
    list_remove(&raw mut (*element).list);
    if (*pt).nearest == element {
        (*pt).nearest = null_mut();
    }
    // [heap]; elements are blocks of malloc.
    free(element.cast());
}

/// Returns the lists of vertices, edges and faces.
unsafe fn lists(pt: *mut ccd_pt_t) -> [*mut ccd_list_t; 3] {
    [
        &raw mut (*pt).vertices,
        &raw mut (*pt).edges,
        &raw mut (*pt).faces,
    ]
}

/// Allocates an element, fills its own part by `fill`, links it and updates `nearest`. Returns NULL when malloc fails.
unsafe fn add<T>(
    pt: *mut ccd_pt_t,
    list: *mut ccd_list_t,
    kind: c_int,
    fill: impl FnOnce(*mut T),
) -> *mut T {
    // [heap]; a T begins with a ccd_pt_el_t.
    let node: *mut T = malloc(size_of::<T>()).cast();
    if !node.is_null() {
        fill(node);
        let element: *mut ccd_pt_el_t = node.cast();
        (*element).kind = kind;
        compute_distance(element);
        list_append(list, &raw mut (*element).list);
        update_nearest(pt, element);
    }
    node
}

/// Computes the point of an element closest to the origin and its squared distance.
#[inline(always)]
unsafe fn compute_distance(element: *mut ccd_pt_el_t) {
    let origin = Vec3::zeros();
    // An element's kind is that of its block.
    let witness = match (*element).kind {
        CCD_PT_VERTEX => Vec3::from((*element.cast::<ccd_pt_vertex_t>()).v.v),
        CCD_PT_EDGE => {
            let ends = (*element.cast::<ccd_pt_edge_t>()).vertex;
            let [a, b] = ends.map(|v| Vec3::from((*v).v.v));
            barycentric::segment(&origin, &a, &b).point
        }
        _ => {
            let [a, b, c] = corners(element.cast()).map(|v| Vec3::from((*v).v.v));
            barycentric::triangle(&origin, &a, &b, &c).point
        }
    };
    (*element).witness = witness.into();
    (*element).dist = super::vec3::distance2(&(*element).witness, &Vec3::zeros().into());
}

/// Sets `nearest` to none, as [`ccdPtInit`] does.
unsafe fn reset_nearest(pt: *mut ccd_pt_t) {
    (*pt).nearest = null_mut();
    (*pt).nearest_dist = Real::MAX;
    (*pt).nearest_type = CCD_PT_FACE;
}

/// Stores `element` as `nearest` if it is closer, or as close and of a lower type. An element at a
/// NaN distance is never stored.
unsafe fn update_nearest(pt: *mut ccd_pt_t, element: *mut ccd_pt_el_t) {
    let (dist, kind) = ((*element).dist, (*element).kind);
    let is_lower_type = kind < (*pt).nearest_type;
    // Equality is tested last: the first two comparisons decide most cases.
    let is_closer = if dist < (*pt).nearest_dist {
        is_lower_type || !equal((*pt).nearest_dist, dist)
    } else {
        is_lower_type && equal((*pt).nearest_dist, dist)
    };
    if is_closer {
        (*pt).nearest = element;
        (*pt).nearest_dist = dist;
        (*pt).nearest_type = kind;
    }
}

/// Returns whether two numbers are equal by ccdEq of `ccd/vec3.h`. Its absolute term is part of the
/// interface: it decides ties between elements, which FCL's EPA depends on.
fn equal(a: Real, b: Real) -> bool {
    let difference = (a - b).abs();
    let (a, b) = (a.abs(), b.abs());
    difference < Real::EPSILON || difference < Real::EPSILON * if b > a { b } else { a }
}

/// Returns the vertices of a face: those of its first edge, and the one of the second edge that is not
/// among them.
unsafe fn corners(face: *const ccd_pt_face_t) -> [*mut ccd_pt_vertex_t; 3] {
    let [a, b] = (*(*face).edge[0]).vertex;
    let [c, other] = (*(*face).edge[1]).vertex;
    [a, b, if c == a || c == b { other } else { c }]
}

/// Makes `head` an empty list.
unsafe fn list_init(head: *mut ccd_list_t) {
    (*head).next = head;
    (*head).prev = head;
}

/// Links `node` in front of `head`: at the end of the list.
unsafe fn list_append(head: *mut ccd_list_t, node: *mut ccd_list_t) {
    let last = (*head).prev;
    (*node).prev = last;
    (*node).next = head;
    (*last).next = node;
    (*head).prev = node;
}

/// Unlinks `node` from its list.
unsafe fn list_remove(node: *mut ccd_list_t) {
    (*(*node).prev).next = (*node).next;
    (*(*node).next).prev = (*node).prev;
}

/// Iterates over the elements of one of the polytope's lists, in order. The caller may delete the
/// current element.
unsafe fn elements<T>(head: *mut ccd_list_t) -> impl Iterator<Item = *mut T> {
    let mut next = (*head).next;
    core::iter::from_fn(move || {
        let node = next;
        if node == head {
            return None;
        }
        next = (*node).next;
        // Every element begins with a ccd_pt_el_t.
        Some(node.byte_sub(offset_of!(ccd_pt_el_t, list)).cast())
    })
}
