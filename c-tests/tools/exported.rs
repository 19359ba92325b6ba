// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The exported functions called as C calls them, but from Rust: a program that
//! Miri can run, to find undefined behaviour behind the pointers
//! (`sh c-tests/tools/check.sh miri`). In the ordinary test run it is a small test.

// C names, and calls into the C interface.
#![allow(unsafe_code)]

use ccd::Real;
use ccd::internals::ffi::*;
use std::ffi::{CStr, c_int, c_void};
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
    let calls = 0;
    Object {
        shape,
        center,
        calls,
    }
}

const CORNERS: [[Real; 3]; 4] = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];

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
                let along = |c: &[Real; 3]| c.iter().zip(&d).map(|(c, d)| c * d).sum::<Real>();
                let farthest = CORNERS.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
                farthest.unwrap().map(|x| x * size)
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

/// Which fields of `ccd_t` a call reads besides the support functions and the cap.
#[derive(Clone, Copy, PartialEq)]
enum Reads {
    Mpr,
    Proven,
    Distance,
    Gjk,
    /// As MPR's yes or no.
    Centers,
}

const TOLERANCE: Real = 1e-4;

/// Settings with every field that the call must not read left uninitialised.
fn settings(reads: Reads, iterations: u32) -> MaybeUninit<ccd_t> {
    let mut settings = MaybeUninit::<ccd_t>::uninit();
    let ccd = settings.as_mut_ptr();
    unsafe {
        (&raw mut (*ccd).support1).write(Some(support));
        (&raw mut (*ccd).support2).write(Some(support));
        (&raw mut (*ccd).max_iterations).write(iterations.into());
        if reads != Reads::Gjk {
            (&raw mut (*ccd).center1).write(Some(center));
            (&raw mut (*ccd).center2).write(Some(center));
        }
        match reads {
            Reads::Mpr => (&raw mut (*ccd).mpr_tolerance).write(TOLERANCE),
            Reads::Proven => (&raw mut (*ccd).epa_tolerance).write(TOLERANCE),
            Reads::Distance => {
                (&raw mut (*ccd).first_dir).write(None);
                (&raw mut (*ccd).dist_tolerance).write(TOLERANCE);
            }
            Reads::Gjk => {
                (&raw mut (*ccd).first_dir).write(Some(ccdFirstDirDefault));
                (&raw mut (*ccd).epa_tolerance).write(TOLERANCE);
            }
            Reads::Centers => {}
        }
    }
    settings
}

fn pointer(object: &mut Object) -> *const c_void {
    (&raw mut *object).cast()
}

/// Overlapping pairs with their depths; the last is a miss.
fn pairs() -> Vec<(Shape, Shape, [Real; 3], Option<Real>)> {
    let half = Shape::Box([0.5, 1.0, 1.5]);
    let (ball, tetrahedron) = (Shape::Ball(1.0), Shape::Tetrahedron(1.0));
    vec![
        (ball, Shape::Ball(0.5), [1.2, 0.0, 0.0], Some(0.3)),
        (ball, half, [0.0, 0.0, 2.4], Some(0.1)),
        (half, half, [0.9, 0.1, 0.2], Some(0.1)),
        (tetrahedron, half, [-1.4, 0.0, 0.0], Some(0.1)),
        (half, tetrahedron, [5.0, 4.0, 3.0], None),
    ]
}

// --- the calls about two objects -----------------------------------------------------------

/// What a call is asked.
struct Ask {
    a: *const c_void,
    b: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
}

impl Ask {
    /// Of two objects; from no state.
    fn of(a: &mut Object, b: &mut Object, ccd: &MaybeUninit<ccd_t>) -> Ask {
        Ask {
            a: pointer(a),
            b: pointer(b),
            ccd: ccd.as_ptr(),
            warm: null_mut(),
        }
    }
}

/// What it says: depth, the way to move and the normal of the plane behind it.
struct Said {
    code: c_int,
    answer: Option<(Real, ccd_vec3_t, ccd_vec3_t)>,
}

impl Said {
    fn yes_or_no(code: c_int) -> Said {
        Said { code, answer: None }
    }

    /// From a struct that is written where there is an answer.
    fn full(code: c_int, out: MaybeUninit<ccd_penetration_t>) -> Said {
        let answer = (code == CCD_HIT || code == CCD_LIMIT).then(|| {
            let out = unsafe { out.assume_init() };
            (out.depth, out.dir, out.normal)
        });
        Said { code, answer }
    }
}

const UNTOUCHED: ccd_vec3_t = ccd_vec3_t { v: [7.0; 3] };
const ALONG: ccd_vec3_t = ccd_vec3_t { v: [1.0, 0.0, 0.0] };

/// A call that writes depth, direction and position, also without them.
macro_rules! depth {
    ($call:ident $(, $warm:ident)?) => {
        |q: &Ask| unsafe {
            let (mut depth, mut dir, mut pos) = (7.0, UNTOUCHED, UNTOUCHED);
            let code = $call(q.a, q.b, q.ccd, $(q.$warm,)? &mut depth, &mut dir, &mut pos);
            if code != 0 {
                assert_eq!((depth, dir, pos), (7.0, UNTOUCHED, UNTOUCHED));
            }
            let none = (null_mut(), null_mut(), null_mut());
            assert_eq!($call(q.a, q.b, q.ccd, $(q.$warm,)? none.0, none.1, none.2), code);
            Said { code, answer: (code == 0).then_some((depth, dir, dir)) }
        }
    };
}

/// A call that fills a struct, by itself or along a direction.
macro_rules! full {
    ($call:ident $(, $along:ident)?) => {
        |q: &Ask| {
            let mut out = MaybeUninit::uninit();
            let code = unsafe { $call(q.a, q.b, q.ccd, $(&$along,)? q.warm, CCD_WANT_ALL, out.as_mut_ptr()) };
            Said::full(code, out)
        }
    };
}

fn distance(q: &Ask) -> Said {
    let mut out = MaybeUninit::<ccd_distance_t>::uninit();
    let mut ask = |margin: Real| unsafe {
        let (far, out) = (Real::INFINITY, out.as_mut_ptr());
        ccdSignedDistance(q.a, q.b, q.ccd, 0.0, margin, far, q.warm, CCD_WANT_ALL, out)
    };
    assert_eq!(ask(-0.1), CCD_BAD_INPUT);
    let code = ask(0.0);
    if code == CCD_BAD_INPUT {
        return Said::yes_or_no(code);
    }
    // A distance is an answer too.
    let out = unsafe { out.assume_init() };
    assert_eq!(code == CCD_HIT, out.distance < 0.0);
    let answer = (code == CCD_HIT).then_some((-out.distance, out.normal, out.normal));
    Said { code, answer }
}

struct Call {
    name: &'static str,
    reads: Reads,
    /// What it returns of an overlap, of a miss and of points that are no numbers.
    codes: [c_int; 3],
    /// Whether the depth is the least: of the others it is sound.
    least: bool,
    ask: fn(&Ask) -> Said,
}

const YES: [c_int; 3] = [1, 0, 0];
const LIBCCD: [c_int; 3] = [0, -1, -1];
const FULL: [c_int; 3] = [CCD_HIT, CCD_MISS, CCD_BAD_INPUT];

#[rustfmt::skip]
const CALLS: [Call; 15] = [
    Call { name: "MPR", reads: Reads::Mpr, codes: LIBCCD, least: true, ask: depth!(ccdMPRPenetration) },
    Call { name: "GJK", reads: Reads::Gjk, codes: LIBCCD, least: true, ask: depth!(ccdGJKPenetration) },
    Call { name: "separate", reads: Reads::Gjk, codes: LIBCCD, least: true,
        ask: |q| Said::yes_or_no(unsafe { ccdGJKSeparate(q.a, q.b, q.ccd, &mut ccd_vec3_t::default()) }) },
    Call { name: "MPR, warm", reads: Reads::Mpr, codes: LIBCCD, least: false, ask: depth!(ccdMPRPenetrationWarm, warm) },
    Call { name: "local", reads: Reads::Mpr, codes: FULL, least: false, ask: full!(ccdPenetrationLocal) },
    Call { name: "penetration", reads: Reads::Mpr, codes: FULL, least: false, ask: full!(ccdPenetration) },
    Call { name: "incremental", reads: Reads::Mpr, codes: FULL, least: false, ask: full!(ccdPenetrationIncremental) },
    Call { name: "proven", reads: Reads::Proven, codes: FULL, least: true, ask: full!(ccdPenetrationProven) },
    Call { name: "along", reads: Reads::Mpr, codes: FULL, least: false, ask: full!(ccdPenetrationAlong, ALONG) },
    Call { name: "planar", reads: Reads::Mpr, codes: FULL, least: false, ask: full!(ccdPenetrationPlanar, ALONG) },
    Call { name: "distance", reads: Reads::Distance, codes: FULL, least: true, ask: distance },
    Call { name: "MPR intersect", reads: Reads::Centers, codes: YES, least: false,
        ask: |q| Said::yes_or_no(unsafe { ccdMPRIntersect(q.a, q.b, q.ccd) }) },
    Call { name: "GJK intersect", reads: Reads::Gjk, codes: YES, least: false,
        ask: |q| Said::yes_or_no(unsafe { ccdGJKIntersect(q.a, q.b, q.ccd) }) },
    Call { name: "MPR intersect, warm", reads: Reads::Centers, codes: YES, least: false,
        ask: |q| Said::yes_or_no(unsafe { ccdMPRIntersectWarm(q.a, q.b, q.ccd, q.warm) }) },
    Call { name: "intersect", reads: Reads::Centers, codes: YES, least: false,
        ask: |q| Said::yes_or_no(unsafe { ccdIntersect(q.a, q.b, q.ccd, q.warm) }) },
];

/// Every state that C can hand over: none, cold, a guess flipped twice, any bytes at all.
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
    let mut guess = bytes(&mut || 0);
    unsafe {
        ccdWarmGuess(&mut guess, &ccd_vec3_t { v: [0.0, 3.0, 0.0] });
        ccdWarmFlip(&mut guess);
        ccdWarmFlip(&mut guess);
    }
    let mut states = vec![
        None,
        Some(bytes(&mut || 0)),
        Some(bytes(&mut || 0xff)),
        Some(guess),
    ];
    let random_states = if cfg!(miri) { 1 } else { 8 };
    states.extend((0..random_states).map(|_| Some(bytes(&mut random_byte))));
    states
}

/// Whatever the state holds, hits are hits, misses misses, and the depth separates.
#[test]
fn every_call_answers_from_every_state() {
    for call in &CALLS {
        let ccd = settings(call.reads, 100);
        for (shape1, shape2, center2, truth) in pairs() {
            for (number, mut state) in states().into_iter().enumerate() {
                let (mut a, mut b) = (object(shape1, [0.0; 3]), object(shape2, center2));
                let mut ask = Ask::of(&mut a, &mut b, &ccd);
                ask.warm = state.as_mut().map_or(null_mut(), |state| &raw mut *state);
                // The second call starts from what the first one left.
                for _ in 0..2 {
                    let said = (call.ask)(&ask);
                    let what = format!("{}, state {number}", call.name);
                    assert_eq!(
                        said.code,
                        call.codes[usize::from(truth.is_none())],
                        "{what}"
                    );
                    let (Some(truth), Some((depth, dir, normal))) = (truth, said.answer) else {
                        continue;
                    };
                    let what = format!("{what}: {depth} along {dir:?}");
                    assert!((dot(&dir, &dir) - 1.0).abs() < 1e-5, "{what}");
                    let most = if call.least {
                        truth + 2.0 * TOLERANCE
                    } else {
                        10.0
                    };
                    assert!(depth >= truth - TOLERANCE && depth <= most, "{what}");
                    let separates = reach(&ask, &normal) / dot(&dir, &normal);
                    let off = (depth - separates).abs();
                    assert!(call.least || off <= 1e-5, "{what}: {separates}");
                }
                assert!(unsafe { (*ask.a.cast::<Object>()).calls } > 0);
            }
        }
    }
}

/// A point that is no number is refused. Nothing is leaked or left half done when a callback does
/// not return.
#[test]
fn no_call_answers_of_what_is_no_object() {
    for call in &CALLS {
        let ccd = settings(call.reads, 100);
        let mut ball = object(Shape::Ball(1.0), [0.0; 3]);
        let mut ask = |shape| {
            let mut other = object(shape, [0.5; 3]);
            (call.ask)(&Ask::of(&mut ball, &mut other, &ccd)).code
        };
        assert_eq!(ask(Shape::NotANumber), call.codes[2], "{}", call.name);
        let left = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| ask(Shape::Panics)));
        assert!(left.is_err(), "{}", call.name);
    }
}

/// How far obj2 has to move along `dir` until a plane with this normal separates.
fn reach(ask: &Ask, dir: &ccd_vec3_t) -> Real {
    let mut farthest = ccd_support_t::default();
    unsafe { __ccdSupport(ask.a, ask.b, dir, ask.ccd, &mut farthest) };
    dot(&farthest.v, dir)
}

fn dot(a: &ccd_vec3_t, b: &ccd_vec3_t) -> Real {
    a.v.iter().zip(&b.v).map(|(a, b)| a * b).sum()
}

/// A ball in the middle of another that is a hundredth too long: minima on a circle, and nearly
/// everywhere, and the proof outgrows the stack.
#[test]
fn memory_from_malloc() {
    for (name, code) in [("proven", CCD_LIMIT), ("GJK", 0)] {
        let call = CALLS.iter().find(|c| c.name == name).expect("a call");
        let mut obj1 = object(Shape::Ellipsoid([1.0, 1.0, 1.01]), [0.0; 3]);
        let mut obj2 = object(Shape::Ball(0.5), [0.0; 3]);
        let ccd = settings(call.reads, 200);
        let said = (call.ask)(&Ask::of(&mut obj1, &mut obj2, &ccd));
        assert_eq!(said.code, code);
        let (depth, ..) = said.answer.expect("a depth");
        assert!((depth - 1.5).abs() < TOLERANCE);
    }
}

// --- the others -----------------------------------------------------------------------------

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
    let ccd = settings(Reads::Mpr, 100);
    let ccd = ccd.as_ptr();
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
        let n = unsafe { ccdContacts(a, b, ccd, &normal, 1e-3, memory, room, max as c_int) };
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
        let bad = ccdContacts(a, strange, ccd, &normal, 0.0, null_mut(), one, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
        let bad = ccdContacts(a, b, ccd, null(), 0.0, null_mut(), one, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
        let bad = ccdContacts(a, b, ccd, &normal, 0.0, null_mut(), room, 1);
        assert_eq!(bad, CCD_BAD_INPUT);
    }
}

#[test]
fn support_may_alias() {
    let mut obj1 = object(Shape::Ball(1.0), [0.0; 3]);
    let mut obj2 = object(Shape::Ball(1.0), [3.0, 0.0, 0.0]);
    let mut out = ccd_support_t::default();
    out.v.v = [0.0, 1.0, 0.0];
    let (obj1, obj2) = (pointer(&mut obj1), pointer(&mut obj2));
    let ccd = settings(Reads::Mpr, 100);
    unsafe {
        let dir = &raw const out.v;
        __ccdSupport(obj1, obj2, dir, ccd.as_ptr(), &raw mut out);
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
    unsafe {
        ccdPtInit(pt);
        let vertex = CORNERS.map(|v| {
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
