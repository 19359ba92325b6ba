// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The exported functions called as C calls them, but from Rust: a program that
//! Miri can run, to find undefined behaviour behind the pointers
//! (`sh c-tests/tools/check.sh miri`). In the ordinary test run it is a small test.

// C names, and calls into the C interface.
#![allow(unsafe_code)]

use ccd::Real;
use ccd::internals::ffi::*;
use std::ffi::{CStr, c_int, c_uint, c_void};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

/// An object as a consumer has it; the callbacks count their calls in it.
struct Object {
    shape: Shape,
    center: [Real; 3],
    calls: usize,
}

#[derive(Clone, Copy)]
enum Shape {
    Ball(Real),
    /// Its half axes.
    Ellipsoid([Real; 3]),
    Box([Real; 3]),
    Tetrahedron(Real),
    NotANumber,
    Panics,
}

fn object(shape: Shape, center: [Real; 3]) -> Object {
    Object {
        shape,
        center,
        calls: 0,
    }
}

unsafe extern "C-unwind" fn support(
    obj: *const c_void,
    dir: *const ccd_vec3_t,
    vec: *mut ccd_vec3_t,
) {
    let obj = obj.cast::<Object>().cast_mut();
    unsafe {
        (*obj).calls += 1;
        let d = (*dir).v;
        let p = match (*obj).shape {
            Shape::Ball(radius) => {
                let length = d.iter().map(|x| x * x).sum::<Real>().sqrt();
                d.map(|x| x / length * radius)
            }
            Shape::Ellipsoid(half) => {
                let a: [Real; 3] = std::array::from_fn(|i| half[i] * d[i]);
                let length = a.iter().map(|x| x * x).sum::<Real>().sqrt();
                std::array::from_fn(|i| half[i] * a[i] / length)
            }
            Shape::Box(half) => std::array::from_fn(|i| half[i].copysign(d[i])),
            Shape::Tetrahedron(size) => {
                let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
                let along = |c: &[Real; 3]| c.iter().zip(&d).map(|(c, d)| c * d).sum::<Real>();
                let farthest = corners
                    .iter()
                    .max_by(|a, b| along(a).total_cmp(&along(b)))
                    .unwrap();
                farthest.map(|x| x * size)
            }
            Shape::NotANumber => [Real::NAN; 3],
            Shape::Panics => panic!("out of a callback"),
        };
        (*vec).v = std::array::from_fn(|i| p[i] + (*obj).center[i]);
    }
}

unsafe extern "C-unwind" fn center(obj: *const c_void, center: *mut ccd_vec3_t) {
    unsafe { (*center).v = (*obj.cast::<Object>()).center };
}

/// Settings with every field a call must not read left uninitialised.
struct Settings(MaybeUninit<ccd_t>);

impl Settings {
    /// What every call reads, and what `more` writes.
    fn with(centers: bool, more: impl FnOnce(*mut ccd_t)) -> Settings {
        let mut settings = MaybeUninit::<ccd_t>::uninit();
        let ccd = settings.as_mut_ptr();
        unsafe {
            (&raw mut (*ccd).support1).write(Some(support));
            (&raw mut (*ccd).support2).write(Some(support));
            (&raw mut (*ccd).max_iterations).write(100);
            if centers {
                (&raw mut (*ccd).center1).write(Some(center));
                (&raw mut (*ccd).center2).write(Some(center));
            }
        }
        more(ccd);
        Settings(settings)
    }

    /// What MPR's calls read.
    fn mpr() -> Settings {
        Settings::with(true, |ccd| unsafe {
            (&raw mut (*ccd).mpr_tolerance).write(TOLERANCE);
        })
    }

    /// What ccdPenetrationProven reads.
    fn minimum() -> Settings {
        Settings::with(true, |ccd| unsafe {
            (&raw mut (*ccd).epa_tolerance).write(TOLERANCE);
        })
    }

    /// What ccdSignedDistance reads.
    fn distance() -> Settings {
        Settings::with(true, |ccd| unsafe {
            (&raw mut (*ccd).first_dir).write(None);
            (&raw mut (*ccd).dist_tolerance).write(TOLERANCE);
        })
    }

    /// What GJK's calls read.
    fn gjk() -> Settings {
        Settings::with(false, |ccd| unsafe {
            (&raw mut (*ccd).first_dir).write(Some(ccdFirstDirDefault));
            (&raw mut (*ccd).epa_tolerance).write(TOLERANCE);
            (&raw mut (*ccd).dist_tolerance).write(TOLERANCE);
        })
    }

    fn at_most(mut self, iterations: u32) -> Settings {
        unsafe { (&raw mut (*self.0.as_mut_ptr()).max_iterations).write(iterations.into()) };
        self
    }

    fn get(&self) -> *const ccd_t {
        self.0.as_ptr()
    }
}

const TOLERANCE: Real = 1e-4;
/// `ccdMPRPenetration` and `ccdGJKPenetration`.
type Penetration = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    *mut Real,
    *mut ccd_vec3_t,
    *mut ccd_vec3_t,
) -> c_int;

fn pointer(object: &mut Object) -> *const c_void {
    (&raw mut *object).cast()
}

/// Overlapping pairs with their depths; the last is a miss.
fn pairs() -> Vec<(Shape, Shape, [Real; 3], Option<Real>)> {
    let half = Shape::Box([0.5, 1.0, 1.5]);
    vec![
        (
            Shape::Ball(1.0),
            Shape::Ball(0.5),
            [1.2, 0.0, 0.0],
            Some(0.3),
        ),
        (Shape::Ball(1.0), half, [0.0, 0.0, 2.4], Some(0.1)),
        (half, half, [0.9, 0.1, 0.2], Some(0.1)),
        (Shape::Tetrahedron(1.0), half, [-1.4, 0.0, 0.0], Some(0.1)),
        (half, Shape::Tetrahedron(1.0), [5.0, 4.0, 3.0], None),
    ]
}

fn without_outputs(
    call: Penetration,
    obj1: *const c_void,
    obj2: *const c_void,
    settings: &Settings,
) -> c_int {
    let none = null_mut();
    unsafe { call(obj1, obj2, settings.get(), none, null_mut(), null_mut()) }
}

fn penetrates(call: Penetration, settings: &Settings) {
    for (shape1, shape2, center2, truth) in pairs() {
        let mut obj1 = object(shape1, [0.0; 3]);
        let mut obj2 = object(shape2, center2);
        let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
        let untouched = ccd_vec3_t { v: [7.0; 3] };
        let (mut depth, mut dir, mut pos) = (7.0, untouched, untouched);
        let code = unsafe { call(obj1, obj2, settings.get(), &mut depth, &mut dir, &mut pos) };
        match truth {
            Some(truth) => {
                assert_eq!(code, 0);
                assert!((depth - truth).abs() <= 2.0 * TOLERANCE, "{depth} {truth}");
                assert!((dot(&dir, &dir) - 1.0).abs() < 1e-5, "{dir:?}");
            }
            None => {
                assert_eq!(code, -1);
                assert_eq!((depth, dir, pos), (7.0, untouched, untouched));
            }
        }
        assert_eq!(without_outputs(call, obj1, obj2, settings), code);
        assert!(unsafe { (*obj1.cast::<Object>()).calls } > 0);
    }
}

fn refuses_what_is_not_a_number(call: Penetration, settings: &Settings) {
    let mut obj1 = object(Shape::Ball(1.0), [0.0; 3]);
    let mut obj2 = object(Shape::NotANumber, [0.5; 3]);
    let mut depth = 7.0;
    let code = unsafe {
        call(
            pointer(&mut obj1),
            pointer(&mut obj2),
            settings.get(),
            &mut depth,
            null_mut(),
            null_mut(),
        )
    };
    assert_eq!((code, depth), (-1, 7.0));
}

/// Nothing is leaked or left half done when a callback does not return.
fn unwinds(call: Penetration, settings: &Settings) {
    let mut obj1 = object(Shape::Ball(1.0), [0.0; 3]);
    let mut obj2 = object(Shape::Panics, [0.5; 3]);
    let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
    let caught = std::panic::catch_unwind(|| without_outputs(call, obj1, obj2, settings));
    assert!(caught.is_err());
}

#[test]
fn mpr() {
    let settings = Settings::mpr();
    penetrates(ccdMPRPenetration, &settings);
    refuses_what_is_not_a_number(ccdMPRPenetration, &settings);
    unwinds(ccdMPRPenetration, &settings);
}

#[test]
fn gjk() {
    let settings = Settings::gjk();
    penetrates(ccdGJKPenetration, &settings);
    refuses_what_is_not_a_number(ccdGJKPenetration, &settings);
    unwinds(ccdGJKPenetration, &settings);
}

#[test]
fn separation() {
    let settings = Settings::gjk();
    for (shape1, shape2, center2, truth) in pairs() {
        let mut obj1 = object(shape1, [0.0; 3]);
        let mut obj2 = object(shape2, center2);
        let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
        let untouched = ccd_vec3_t { v: [7.0; 3] };
        let mut sep = untouched;
        let code = unsafe { ccdGJKSeparate(obj1, obj2, settings.get(), &mut sep) };
        assert_eq!(code, c_int::from(truth.is_some()) - 1);
        match truth {
            Some(truth) => assert!((dot(&sep, &sep).sqrt() - truth).abs() <= 2.0 * TOLERANCE),
            None => assert_eq!(sep, untouched),
        }
        let without = unsafe { ccdGJKSeparate(obj1, obj2, settings.get(), null_mut()) };
        assert_eq!(without, code);
    }
}

#[test]
fn overlap() {
    for (shape1, shape2, center2, truth) in pairs() {
        let mut obj1 = object(shape1, [0.0; 3]);
        let mut obj2 = object(shape2, center2);
        let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
        let expected = c_int::from(truth.is_some());
        unsafe {
            assert_eq!(ccdMPRIntersect(obj1, obj2, Settings::mpr().get()), expected);
            assert_eq!(ccdGJKIntersect(obj1, obj2, Settings::gjk().get()), expected);
        }
    }
}

/// A call of the extension that fills a struct, by itself or along a direction.
#[derive(Clone, Copy)]
enum Extended {
    Free(
        unsafe extern "C-unwind" fn(
            *const c_void,
            *const c_void,
            *const ccd_t,
            *mut ccd_warm_t,
            c_uint,
            *mut ccd_penetration_t,
        ) -> c_int,
    ),
    Along(
        unsafe extern "C-unwind" fn(
            *const c_void,
            *const c_void,
            *const ccd_t,
            *const ccd_vec3_t,
            *mut ccd_warm_t,
            c_uint,
            *mut ccd_penetration_t,
        ) -> c_int,
    ),
}

impl Extended {
    unsafe fn call(
        self,
        obj1: *const c_void,
        obj2: *const c_void,
        settings: &Settings,
        warm: *mut ccd_warm_t,
        out: *mut ccd_penetration_t,
    ) -> c_int {
        let (ccd, x) = (settings.get(), ccd_vec3_t { v: [1.0, 0.0, 0.0] });
        match self {
            Self::Free(call) => unsafe { call(obj1, obj2, ccd, warm, CCD_WANT_ALL, out) },
            Self::Along(call) => unsafe { call(obj1, obj2, ccd, &x, warm, CCD_WANT_ALL, out) },
        }
    }
}

/// Every state that C can hand over: none, cold, any bytes at all, the last answer's.
fn states() -> Vec<Option<ccd_warm_t>> {
    let bytes = |next: &mut dyn FnMut() -> u8| {
        let mut state = MaybeUninit::<ccd_warm_t>::uninit();
        let first = state.as_mut_ptr().cast::<u8>();
        for i in 0..size_of::<ccd_warm_t>() {
            unsafe { first.add(i).write(next()) };
        }
        unsafe { state.assume_init() }
    };
    let mut random = 1u32;
    let mut random_byte = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 24) as u8
    };
    let mut states = vec![None, Some(bytes(&mut || 0)), Some(bytes(&mut || 0xff))];
    let random_states = if cfg!(miri) { 1 } else { 8 };
    states.extend((0..random_states).map(|_| Some(bytes(&mut random_byte))));
    states
}

/// Whatever the state holds, hits are hits, misses misses, and the depth separates.
fn extended(call: Extended, settings: &Settings) {
    for (shape1, shape2, center2, truth) in pairs() {
        for mut state in states() {
            let mut obj1 = object(shape1, [0.0; 3]);
            let mut obj2 = object(shape2, center2);
            let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
            let warm = state.as_mut().map_or(null_mut(), |state| &raw mut *state);
            // The second call starts from what the first one left.
            for _ in 0..2 {
                let mut out = MaybeUninit::uninit();
                let code = unsafe { call.call(obj1, obj2, settings, warm, out.as_mut_ptr()) };
                let Some(truth) = truth else {
                    assert_eq!(code, CCD_MISS);
                    continue;
                };
                assert_eq!(code, CCD_HIT);
                let out = unsafe { out.assume_init() };
                assert!(out.depth >= truth - TOLERANCE && out.depth < 10.0);
                let along_normal = reach(obj1, obj2, settings.get(), &out.normal);
                let separates = along_normal / dot(&out.dir, &out.normal);
                assert!((out.depth - separates).abs() <= 1e-5, "{separates}");
            }
        }
    }
    let (mut obj1, mut obj2) = (
        object(Shape::Ball(1.0), [0.0; 3]),
        object(Shape::NotANumber, [0.5; 3]),
    );
    let mut out = MaybeUninit::uninit();
    let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
    let code = unsafe { call.call(obj1, obj2, settings, null_mut(), out.as_mut_ptr()) };
    assert_eq!(code, CCD_BAD_INPUT);
}

#[test]
fn local() {
    extended(Extended::Free(ccdPenetrationLocal), &Settings::mpr());
}

#[test]
fn penetration() {
    extended(Extended::Free(ccdPenetration), &Settings::mpr());
}

#[test]
fn incremental() {
    extended(Extended::Free(ccdPenetrationIncremental), &Settings::mpr());
}

#[test]
fn proven() {
    extended(Extended::Free(ccdPenetrationProven), &Settings::minimum());
}

/// A ball in the middle of another that is a hundredth too long: minima on a circle, and nearly
/// everywhere, and the proof outgrows the stack.
#[test]
fn memory_from_malloc() {
    let mut obj1 = object(Shape::Ellipsoid([1.0, 1.0, 1.01]), [0.0; 3]);
    let mut obj2 = object(Shape::Ball(0.5), [0.0; 3]);
    let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
    let mut out = MaybeUninit::uninit();
    let mut depth = 0.0;
    unsafe {
        let (minimum, gjk) = (
            Settings::minimum().at_most(200),
            Settings::gjk().at_most(200),
        );
        let code = ccdPenetrationProven(
            obj1,
            obj2,
            minimum.get(),
            null_mut(),
            CCD_WANT_ALL,
            out.as_mut_ptr(),
        );
        assert_eq!(code, CCD_LIMIT);
        assert!((out.assume_init().depth - 1.5).abs() < TOLERANCE);
        let code = ccdGJKPenetration(obj1, obj2, gjk.get(), &mut depth, null_mut(), null_mut());
        assert_eq!(code, 0);
        assert!((depth - 1.5).abs() < TOLERANCE);
    }
}

#[test]
fn along() {
    extended(Extended::Along(ccdPenetrationAlong), &Settings::mpr());
}

#[test]
fn planar() {
    extended(Extended::Along(ccdPenetrationPlanar), &Settings::mpr());
}

/// Balls: the distance of the centres less radii and margin, from every state; a point that is no
/// number and a margin below 0 are bad input.
#[test]
fn distance() {
    let settings = Settings::distance();
    for mut state in states() {
        let mut obj1 = object(Shape::Ball(1.0), [0.0; 3]);
        let mut strange = object(Shape::NotANumber, [0.5; 3]);
        let (obj1, strange) = (pointer(&mut obj1), pointer(&mut strange));
        let warm = state.as_mut().map_or(null_mut(), |state| &raw mut *state);
        for (apart, expected) in [(2.0, CCD_MISS), (1.2, CCD_HIT)] {
            let mut obj2 = object(Shape::Ball(0.5), [apart, 0.0, 0.0]);
            let obj2 = pointer(&mut obj2);
            let mut out = MaybeUninit::<ccd_distance_t>::uninit();
            let mut ask = |obj2, margin: Real| unsafe {
                let (ccd, far, out) = (settings.get(), Real::INFINITY, out.as_mut_ptr());
                ccdSignedDistance(obj1, obj2, ccd, 0.0, margin, far, warm, CCD_WANT_ALL, out)
            };
            assert_eq!(ask(obj2, 0.1), expected);
            assert_eq!(ask(strange, 0.1), CCD_BAD_INPUT);
            assert_eq!(ask(obj2, -0.1), CCD_BAD_INPUT);
            let out = unsafe { out.assume_init() };
            assert!((out.distance - (apart - 1.6)).abs() <= TOLERANCE);
        }
    }
}

/// A ball is right, one whose points are no numbers is not, and nothing need be written.
#[test]
fn check() {
    for (shape, right) in [(Shape::Ball(1.0), true), (Shape::NotANumber, false)] {
        let mut object = object(shape, [0.5; 3]);
        let object = pointer(&mut object);
        let mut out = MaybeUninit::<ccd_check_t>::uninit();
        let found = unsafe { ccdCheck(object, Some(support), Some(center), out.as_mut_ptr()) };
        let silent = unsafe { ccdCheck(object, Some(support), Some(center), null_mut()) };
        assert_eq!((found == 0, found == silent), (right, true));
        if right {
            assert!((unsafe { out.assume_init() }.size - 2.0).abs() < 0.1);
        }
        assert_eq!(
            unsafe { ccdCheck(object, None, None, null_mut()) },
            CCD_BAD_INPUT
        );
    }
}

/// A box on a box: four corners, and no more room than was asked for.
#[test]
fn contacts() {
    let mut obj1 = object(Shape::Box([1.0, 1.0, 0.5]), [0.0; 3]);
    let mut obj2 = object(Shape::Box([0.5, 0.4, 0.5]), [0.1, 0.2, 0.99]);
    let (a, b) = (pointer(&mut obj1), pointer(&mut obj2));
    let settings = Settings::mpr();
    let normal = ccd_vec3_t { v: [0.0, 0.0, 3.0] };
    let mut manifold = MaybeUninit::<ccd_manifold_t>::zeroed();
    let manifold = manifold.as_mut_ptr();
    // Without a memory, cold and warm.
    for (max, memory) in [
        (1, null_mut()),
        (4, null_mut()),
        (9, manifold),
        (4, manifold),
    ] {
        let mut out = vec![MaybeUninit::<ccd_contact_t>::uninit(); max];
        let room = out.as_mut_ptr().cast();
        let n = unsafe {
            ccdContacts(
                a,
                b,
                settings.get(),
                &normal,
                1e-3,
                memory,
                room,
                max as c_int,
            )
        };
        assert_eq!(n, max.min(4) as c_int);
        for contact in &out[..n as usize] {
            let contact = unsafe { contact.assume_init() };
            assert!((contact.depth - 0.01).abs() < TOLERANCE);
            assert_eq!(contact.id == 0, memory.is_null());
        }
    }
    let mut strange = object(Shape::NotANumber, [0.0; 3]);
    let (strange, room) = (pointer(&mut strange), null_mut());
    let mut contact = MaybeUninit::<ccd_contact_t>::uninit();
    unsafe {
        let one = contact.as_mut_ptr();
        let bad = ccdContacts(a, strange, settings.get(), &normal, 0.0, null_mut(), one, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
        let bad = ccdContacts(a, b, settings.get(), null(), 0.0, null_mut(), one, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
        let bad = ccdContacts(a, b, settings.get(), &normal, 0.0, null_mut(), room, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
    }
}

/// The compatible calls' warm forms, from a guess too.
#[test]
fn warm_forms() {
    for state in states() {
        let warm = std::cell::Cell::new(state);
        let pointer_to_state = || {
            let state = warm.as_ptr();
            unsafe { (*state).as_mut() }.map_or(null_mut(), |state| &raw mut *state)
        };
        let guess = ccd_vec3_t { v: [0.0, 3.0, 0.0] };
        for (shape1, shape2, center2, truth) in pairs() {
            let mut obj1 = object(shape1, [0.0; 3]);
            let mut obj2 = object(shape2, center2);
            let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
            let settings = Settings::mpr();
            let warm = pointer_to_state();
            let (mut depth, mut dir) = (7.0, guess);
            unsafe {
                let hit = c_int::from(truth.is_some());
                assert_eq!(ccdMPRIntersectWarm(obj1, obj2, settings.get(), warm), hit);
                assert_eq!(ccdIntersect(obj1, obj2, settings.get(), warm), hit);
                ccdWarmGuess(warm, &guess);
                // Twice is nothing.
                ccdWarmFlip(warm);
                ccdWarmFlip(warm);
                let code = ccdMPRPenetrationWarm(
                    obj1,
                    obj2,
                    settings.get(),
                    warm,
                    &mut depth,
                    &mut dir,
                    null_mut(),
                );
                assert_eq!(code, hit - 1);
            }
            match truth {
                Some(truth) => {
                    // Sound; not always the least depth, from a guess as far off as this.
                    let separates = reach(obj1, obj2, settings.get(), &dir);
                    assert!(depth >= truth - TOLERANCE);
                    assert!((depth - separates).abs() <= 1e-5, "{depth} {separates}");
                }
                None => assert_eq!((depth, dir), (7.0, guess)),
            }
        }
    }
}

/// How far obj2 has to move along `dir` until a plane with this normal separates.
fn reach(obj1: *const c_void, obj2: *const c_void, ccd: *const ccd_t, dir: &ccd_vec3_t) -> Real {
    let mut farthest = ccd_support_t::default();
    unsafe { __ccdSupport(obj1, obj2, dir, ccd, &mut farthest) };
    dot(&farthest.v, dir)
}

fn dot(a: &ccd_vec3_t, b: &ccd_vec3_t) -> Real {
    a.v.iter().zip(&b.v).map(|(a, b)| a * b).sum()
}

#[test]
fn support_may_alias() {
    let mut obj1 = object(Shape::Ball(1.0), [0.0; 3]);
    let mut obj2 = object(Shape::Ball(1.0), [3.0, 0.0, 0.0]);
    let mut out = ccd_support_t::default();
    out.v.v = [0.0, 1.0, 0.0];
    let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
    let settings = Settings::mpr();
    unsafe {
        let dir = &raw const out.v;
        __ccdSupport(obj1, obj2, dir, settings.get(), &raw mut out);
    }
    assert_eq!(out.v.v, [-3.0, 2.0, 0.0]);
}

#[test]
fn distances() {
    let point = |x, y, z| ccd_vec3_t { v: [x, y, z] };
    let (p, a, b, c) = (
        point(0.25, 0.25, 2.0),
        point(0.0, 0.0, 0.0),
        point(1.0, 0.0, 0.0),
        point(0.0, 1.0, 0.0),
    );
    let mut witness = point(7.0, 7.0, 7.0);
    unsafe {
        assert_eq!(ccdVec3PointTriDist2(&p, &a, &b, &c, &mut witness), 4.0);
        assert_eq!(witness, point(0.25, 0.25, 0.0));
        assert_eq!(ccdVec3PointTriDist2(&p, &a, &b, &c, null_mut()), 4.0);
        // The witness may be one of the inputs.
        let mut a = a;
        let at = &raw mut a;
        assert_eq!(ccdVec3PointSegmentDist2(&p, at, &b, at), 4.0625);
        assert_eq!(a, point(0.25, 0.0, 0.0));
    }
}

/// A tetrahedron around the origin, taken apart by ccdPtDestroy.
#[test]
fn polytope() {
    let mut pt = MaybeUninit::<ccd_pt_t>::uninit();
    let pt = pt.as_mut_ptr();
    let corners: [[Real; 3]; 4] = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    unsafe {
        ccdPtInit(pt);
        let vertex = corners.map(|v| {
            let mut support = ccd_support_t::default();
            support.v.v = v;
            ccdPtAddVertex(pt, &support)
        });
        assert_eq!((*ccdPtNearest(pt)).kind, CCD_PT_VERTEX);
        let edge = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
            .map(|(i, j)| ccdPtAddEdge(pt, vertex[i], vertex[j]));
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

#[test]
fn names_itself() {
    let name = unsafe { CStr::from_ptr(ccdImplementation()) };
    assert!(name.to_bytes().starts_with(b"warmccd "));
    let mut dir = ccd_vec3_t::default();
    unsafe { ccdFirstDirDefault(null(), null(), &mut dir) };
    assert_eq!(dir.v, [1.0, 0.0, 0.0]);
}
