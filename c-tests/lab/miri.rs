// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Every exported function called from Rust as C calls it, so that Miri can find undefined behaviour behind the pointers:
//! `sh c-tests/tools/check.sh miri`. The C tests check the results themselves.

#![allow(unsafe_code, reason = "calls of the C interface")]

use crate::api::*;
use ccd::internals::ffi::*;
use ccd::{Real, Settings};
use std::ffi::{CStr, c_int};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

/// Call in C, without its own arguments and outputs.
type InC = fn(Object, Object, *const ccd_t, *mut ccd_warm_t) -> c_int;

/// Defines a call that writes depth, direction and position.
macro_rules! depth {
    ($call:ident $(, $warm:ident)?) => {
        |a, b, ccd, _warm| unsafe {
            $(let $warm = _warm;)?
            let (mut depth, mut dir, mut pos) = (0.0, Default::default(), Default::default());
            $call(a, b, ccd, $($warm,)? &mut depth, &mut dir, &mut pos)
        }
    };
}

const YES: [c_int; 3] = [1, 0, 0];
const LIBCCD: [c_int; 3] = [0, -1, -1];
const FULL: [c_int; 3] = [CCD_HIT, CCD_MISS, CCD_BAD_INPUT];

/// The other calls, with their codes for an overlap, a miss and points that are NaN.
#[rustfmt::skip]
const IN_C: [(&str, [c_int; 3], InC); 9] = [
    ("MPR", LIBCCD, depth!(ccdMPRPenetration)),
    ("GJK", LIBCCD, depth!(ccdGJKPenetration)),
    ("separate", LIBCCD, |a, b, ccd, _| unsafe { ccdGJKSeparate(a, b, ccd, &mut ccd_vec3_t::default()) }),
    ("MPR, warm", LIBCCD, depth!(ccdMPRPenetrationWarm, warm)),
    ("distance", FULL, |a, b, ccd, warm| unsafe {
        let mut out = MaybeUninit::uninit();
        ccdSignedDistance(a, b, ccd, 0.0, 0.0, Real::INFINITY, warm, CCD_WANT_ALL, out.as_mut_ptr())
    }),
    ("MPR intersect", YES, |a, b, ccd, _| unsafe { ccdMPRIntersect(a, b, ccd) }),
    ("GJK intersect", YES, |a, b, ccd, _| unsafe { ccdGJKIntersect(a, b, ccd) }),
    ("MPR intersect, warm", YES, |a, b, ccd, warm| unsafe { ccdMPRIntersectWarm(a, b, ccd, warm) }),
    ("intersect", YES, |a, b, ccd, warm| unsafe { ccdIntersect(a, b, ccd, warm) }),
];

/// Returns states as C may pass them: a guess, and memory filled with a byte, of which 0 is cold.
fn states() -> Vec<ccd_warm_t> {
    let filled = |byte| {
        let mut state = MaybeUninit::<ccd_warm_t>::uninit();
        // SAFETY: the state's own memory, of which every content is valid.
        unsafe {
            state.as_mut_ptr().write_bytes(byte, 1);
            state.assume_init()
        }
    };
    let mut states: Vec<_> = [0, 0, 1, 0x3f, 0x55, 0xff].into_iter().map(filled).collect();
    // SAFETY: `states[0]` is a state.
    unsafe { ccdWarmGuess(&mut states[0], &C_DIR) };
    states
}

/// Checks the codes of an overlap, a miss and a NaN point from every state.
#[test]
fn c_calls_from_every_state() {
    let (ball, brick) = (rounded([0.0; 3], 1.0, [0.0; 3]), [0.5, 1.0, 1.5]);
    let ccd = ccd_t { first_dir: Some(ccdFirstDirDefault), ..in_c(&Settings::default(), true) };
    for (a, b, expected) in [
        (ball, rounded([0.0; 3], 0.5, [1.2, 0.0, 0.0]), 0),
        (rounded(brick, 0.0, [0.9, 0.1, 0.2]), ball, 0),
        (rounded(brick, 0.0, [5.0, 4.0, 3.0]), ball, 1),
        (ball, rounded([0.0; 3], Real::NAN, [0.5; 3]), 2),
    ] {
        for (number, mut state) in states().into_iter().enumerate() {
            // The second round starts from the states of the first.
            for _ in 0..2 {
                for (name, codes, call) in &IN_C {
                    let code = call(object(&a), object(&b), &ccd, &mut state);
                    assert_eq!(code, codes[expected], "{name}, state {number}");
                }
                for call in &CALLS {
                    let code = call_in_c(call, &a, &b, &ccd, &mut state, CCD_WANT_ALL).0;
                    assert_eq!(code, FULL[expected], "{}, state {number}", call.name);
                }
            }
        }
    }
}

/// Queries a ball in the middle of one that is 1 % longer, with minima on a circle and nearly everywhere:
/// the proof allocates.
#[test]
fn c_call_that_allocates() {
    let a = rounded([0.0, 0.0, 0.01], 1.0, [0.0; 3]);
    let b = rounded([0.0; 3], 0.5, [0.0; 3]);
    let ccd = in_c(&Settings::default(), true);
    let (code, out) = call_in_c(&CALLS[2], &a, &b, &ccd, null_mut(), CCD_WANT_ALL);
    assert_eq!((code, out.status), (CCD_LIMIT, CCD_STATUS_SUPPORT_LIMIT));
    assert!((out.depth - 1.5).abs() < 1e-4 && out.support_points > 162);
}

#[test]
fn c_calls_without_a_pair() {
    let ball = rounded([0.0; 3], 1.0, [0.5; 3]);
    let mut found = MaybeUninit::<ccd_check_t>::uninit();
    let mut dir = ccd_vec3_t::default();
    let point = |x, y, z| ccd_vec3_t { v: [x, y, z] };
    let (p, a) = (point(0.25, 0.25, 2.0), point(0.0, 0.0, 0.0));
    let (b, c, mut witness) = (point(1.0, 0.0, 0.0), point(0.0, 1.0, 0.0), a);
    let at = &raw mut witness;
    // SAFETY: a live object of its type, and memory for the result; a static string; points, and the
    // witness point may be one of the inputs.
    unsafe {
        let faults = ccdCheck(object(&ball), Some(support), Some(center), found.as_mut_ptr());
        assert!(faults == 0 && (found.assume_init().size - 2.0).abs() < 0.1);
        ccdFirstDirDefault(null(), null(), &mut dir);
        assert_eq!(dir.v, [1.0, 0.0, 0.0]);
        let name = CStr::from_ptr(ccdImplementation());
        assert!(name.to_bytes().starts_with(b"warmccd "));
        assert_eq!(name.to_bytes(), ccd::implementation().as_bytes());
        assert_eq!(ccdVec3PointTriDist2(&p, at, &b, &c, at), 4.0);
        assert_eq!(*at, point(0.25, 0.25, 0.0));
        at.write(a);
        assert_eq!(ccdVec3PointSegmentDist2(&p, at, &b, at), 4.0625);
    }
}

/// Calls `__ccdSupport` with its direction in its output, and builds a tetrahedron around the origin.
#[test]
fn polytope_functions_in_c() {
    let a = rounded([0.0; 3], 1.0, [0.0; 3]);
    let b = Rounded { at: [3.0, 0.0, 0.0], ..a };
    let (mut out, ccd) = (ccd_support_t::default(), in_c(&Settings::default(), true));
    out.v.v = [0.0, 1.0, 0.0];
    let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    let mut pt = MaybeUninit::<ccd_pt_t>::uninit();
    let pt = pt.as_mut_ptr();
    // SAFETY: live objects; a polytope, its own elements, and NULL, which is rejected.
    unsafe {
        __ccdSupport(object(&a), object(&b), &raw const out.v, &ccd, &raw mut out);
        assert_eq!(out.v.v, [-3.0, 2.0, 0.0]);
        ccdPtInit(pt);
        let vertex = corners.map(|v| {
            out.v.v = v;
            ccdPtAddVertex(pt, &out)
        });
        assert_eq!((*ccdPtNearest(pt)).kind, CCD_PT_VERTEX);
        let edge =
            [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(i, j)| ccdPtAddEdge(pt, vertex[i], vertex[j]));
        for [i, j, k] in [[0, 1, 3], [0, 2, 4], [1, 2, 5], [3, 4, 5]] {
            assert!(!ccdPtAddFace(pt, edge[i], edge[j], edge[k]).is_null());
        }
        let nearest = ccdPtNearest(pt);
        assert_eq!((*nearest).kind, CCD_PT_FACE);
        assert!(((*nearest).dist - 1.0 / 3.0).abs() < 1e-6);
        ccdPtRecomputeDistances(pt);
        (*pt).nearest = null_mut();
        assert_eq!((*ccdPtNearest(pt)).kind, CCD_PT_FACE);
        assert!(ccdPtAddEdge(pt, vertex[0], null_mut()).is_null());
        assert!(ccdPtAddFace(pt, edge[0], edge[1], null_mut()).is_null());
        ccdPtDestroy(pt);
    }
}
