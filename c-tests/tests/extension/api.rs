// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Rust interface: the same bits as the C calls, and every call with arguments that no query
//! can work with. And every exported function called as C calls it, but from Rust: what Miri can
//! run, to find undefined behaviour behind the pointers (`sh c-tests/tools/check.sh miri`). What the
//! answers are worth is judged elsewhere, in C.

// Calls into the C interface.
#![allow(unsafe_code)]

use ccd::internals::ffi::*;
use ccd::{Contact, DistanceOptions, Error, Penetration, Real, Settings, Shape, Want, Warm};
use std::ffi::{CStr, c_int, c_uint, c_ulong, c_void};
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{null, null_mut};

/// A box with a ball around it, turned about the axis z.
#[derive(Clone, Copy)]
struct Rounded {
    at: [Real; 3],
    half: [Real; 3],
    radius: Real,
    turn: [Real; 2],
    centred: bool,
}

impl Shape for Rounded {
    fn support(&self, d: [Real; 3]) -> [Real; 3] {
        let [c, s] = self.turn;
        let local = [c * d[0] + s * d[1], c * d[1] - s * d[0], d[2]];
        let p: [Real; 3] = std::array::from_fn(|i| self.half[i].copysign(local[i]));
        let turned = [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]];
        std::array::from_fn(|i| self.at[i] + turned[i] + self.radius * d[i])
    }

    fn center(&self) -> Option<[Real; 3]> {
        self.centred.then_some(self.at)
    }
}

struct Random(u64);

impl Random {
    fn within(&mut self, size: Real) -> Real {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((self.0 >> 40) as Real / (1u64 << 23) as Real - 1.0) * size
    }

    fn shape(&mut self, spread: Real, centred: bool) -> Rounded {
        let angle = self.within(3.0);
        Rounded {
            at: std::array::from_fn(|_| self.within(spread)),
            half: std::array::from_fn(|_| self.within(1.0).abs()),
            radius: self.within(0.3).max(0.0),
            turn: [angle.cos(), angle.sin()],
            centred,
        }
    }
}

unsafe extern "C-unwind" fn support(obj: *const c_void, dir: *const ccd_vec3_t, out: *mut ccd_vec3_t) {
    // SAFETY: a Rounded, a direction, room for a point.
    unsafe { (*out).v = (*obj.cast::<Rounded>()).support((*dir).v) };
}

unsafe extern "C-unwind" fn center(obj: *const c_void, out: *mut ccd_vec3_t) {
    // SAFETY: a Rounded, room for a point.
    unsafe { (*out).v = (*obj.cast::<Rounded>()).at };
}

fn in_c(settings: &Settings, centred: bool) -> ccd_t {
    let centre = centred.then_some(center as ccd_center_fn);
    ccd_t {
        first_dir: None,
        support1: Some(support),
        support2: Some(support),
        center1: centre,
        center2: centre,
        max_iterations: settings.max_iterations as _,
        epa_tolerance: settings.tolerance,
        mpr_tolerance: settings.tolerance,
        dist_tolerance: settings.tolerance,
    }
}

const DIR: [Real; 3] = [1.0, 2.0, -2.0];
const WAY: ccd_vec3_t = ccd_vec3_t { v: DIR };
type Object = *const c_void;
/// Of whatever type a shape is, so that the library is compiled for one.
type Body<'a> = &'a dyn Shape;
type Answer = Result<Option<Penetration>, Error>;

/// A penetration query in Rust, along DIR or in its plane where it asks for one, and in C.
struct Call {
    name: &'static str,
    rust: fn(Body, Body, [Real; 3], &Settings, Option<&mut Warm>) -> Answer,
    c: fn(Object, Object, *const ccd_t, *mut ccd_warm_t, c_uint, *mut ccd_penetration_t) -> c_int,
}

macro_rules! call {
    ($rust:ident, $c:ident $(, $dir:ident, $vector:expr)?) => {
        Call {
            name: stringify!($rust),
            rust: |a, b, _dir, settings, warm| {
                $(let $dir = _dir;)?
                ccd::$rust(a, b, $($dir,)? settings, warm)
            },
            // SAFETY: live objects of their types, and room for an answer.
            c: |a, b, ccd, warm, want, out| unsafe { $c(a, b, ccd, $($vector,)? warm, want, out) },
        }
    };
}

const CALLS: [Call; 6] = [
    call!(penetration, ccdPenetration),
    call!(penetration_local, ccdPenetrationLocal),
    call!(penetration_proven, ccdPenetrationProven),
    call!(penetration_along, ccdPenetrationAlong, dir, &WAY),
    call!(penetration_planar, ccdPenetrationPlanar, dir, &WAY),
    call!(penetration_incremental, ccdPenetrationIncremental),
];

fn object(of: &Rounded) -> Object {
    (&raw const *of).cast()
}

/// Answer of the call in C.
fn in_c_of(
    call: &Call,
    a: &Rounded,
    b: &Rounded,
    ccd: &ccd_t,
    warm: *mut ccd_warm_t,
    want: c_uint,
) -> (c_int, ccd_penetration_t) {
    let mut out = MaybeUninit::<ccd_penetration_t>::zeroed();
    let code = (call.c)(object(a), object(b), ccd, warm, want, out.as_mut_ptr());
    // SAFETY: zero is a value of the struct.
    (code, unsafe { out.assume_init() })
}

fn same(rust: Result<Option<Penetration>, Error>, (code, c): (c_int, ccd_penetration_t)) {
    let Some(hit) = rust.expect("good input") else {
        return assert_eq!(code, CCD_MISS);
    };
    assert_eq!(code, if hit.limit { CCD_LIMIT } else { CCD_HIT });
    assert_eq!((hit.depth, hit.depth_lower), (c.depth, c.depth_lower));
    assert_eq!((hit.dir, hit.normal), (c.dir.v, c.normal.v));
    assert_eq!([hit.pos, hit.point1, hit.point2], [c.pos.v, c.point1.v, c.point2.v]);
    assert_eq!(hit.support_points as c_ulong, c.support_points);
    assert_eq!(hit.iterations as c_ulong, c.iterations);
}

/// Every call, cold and with a state that all share, whatever is wanted, with and without centres.
#[test]
fn same_bits_as_c() {
    let mut r = Random(1);
    let (mut hits, mut misses) = (0, 0);
    for round in 0..if cfg!(miri) { 1 } else { 200 } {
        let centred = round % 2 == 0;
        let want = Want { pos: round % 3 != 0, points: round % 5 != 0 };
        let bits = [(want.pos, CCD_WANT_POS), (want.points, CCD_WANT_POINTS)];
        let bits = bits.iter().filter(|b| b.0).map(|b| b.1).sum();
        let settings = Settings { want, ..Settings::new(1e-5) };
        let (mut a, mut b) = (r.shape(0.5, centred), r.shape(0.8, centred));
        let c = in_c(&settings, centred);
        let mut warm = Warm::guess(DIR);
        let mut state = MaybeUninit::<ccd_warm_t>::zeroed();
        // SAFETY: a state, of which every byte was given.
        let state = unsafe {
            ccdWarmGuess(state.as_mut_ptr(), &WAY);
            state.assume_init_mut()
        };
        for frame in 0..3 {
            b.at[frame % 3] += 0.02;
            for call in &CALLS {
                let cold = in_c_of(call, &a, &b, &c, null_mut(), bits);
                match cold.0 {
                    CCD_MISS => misses += 1,
                    _ => hits += 1,
                }
                same((call.rust)(&a, &b, DIR, &settings, None), cold);
                let kept = in_c_of(call, &a, &b, &c, state, bits);
                same((call.rust)(&a, &b, DIR, &settings, Some(&mut warm)), kept);
            }
            yes_or_no_and_distance(&a, &b, &settings, &mut warm, &c, state, bits);
            warm.flip();
            // SAFETY: a state.
            unsafe { ccdWarmFlip(state) };
            (a, b) = (b, a);
        }
        contacts_as_in_c(&a, &b, &c);
    }
    let many = hits > 500 && misses > 500;
    assert!(many || cfg!(miri), "{hits} hits, {misses} misses");
}

fn yes_or_no_and_distance(
    a: &Rounded,
    b: &Rounded,
    settings: &Settings,
    warm: &mut Warm,
    c: &ccd_t,
    state: &mut ccd_warm_t,
    want: c_uint,
) {
    let (pa, pb) = (object(a), object(b));
    let options = DistanceOptions { margin1: 0.1, margin2: 0.0, max_distance: 0.5 };
    let mut out = MaybeUninit::<ccd_distance_t>::zeroed();
    // SAFETY: live objects of their types; zero is a value of the struct.
    let (yes, code, out) = unsafe {
        let yes = ccdIntersect(pa, pb, c, state) == 1;
        let code = ccdSignedDistance(pa, pb, c, 0.1, 0.0, 0.5, state, want, out.as_mut_ptr());
        (yes, code, out.assume_init())
    };
    let (a, b): (Body, Body) = (a, b);
    assert_eq!(ccd::intersect(a, b, Some(warm)), Ok(yes));
    let d = ccd::signed_distance(a, b, settings, &options, Some(warm)).expect("good input");
    assert_eq!(d.limit, code == CCD_LIMIT);
    assert_eq!((d.distance, d.distance_upper), (out.distance, out.distance_upper));
    assert_eq!([d.normal, d.point1, d.point2], [out.normal.v, out.point1.v, out.point2.v]);
    assert_eq!(d.support_points as c_ulong, out.support_points);
}

fn contacts_as_in_c(a: &Rounded, b: &Rounded, c: &ccd_t) {
    let mut room = [Contact::default(); 4];
    let mut memory = ccd::ManifoldCache::default();
    let bodies: [Body; 2] = [a, b];
    let found = ccd::contacts(bodies[0], bodies[1], DIR, 0.01, Some(&mut memory), &mut room).expect("good input");
    let (a, b) = (object(a), object(b));
    let mut out = [const { MaybeUninit::<ccd_contact_t>::uninit() }; 4];
    let mut manifold = MaybeUninit::<ccd_manifold_cache_t>::zeroed();
    // SAFETY: live objects of their types, room for four.
    let count = unsafe {
        let (memory, room) = (manifold.as_mut_ptr(), out.as_mut_ptr().cast());
        ccdContacts(a, b, c, &WAY, 0.01, memory, room, 4)
    };
    assert_eq!(found.len(), count as usize);
    for (contact, out) in found.iter().zip(out) {
        // SAFETY: among those that were written.
        let out = unsafe { out.assume_init() };
        assert_eq!([contact.point1, contact.point2], [out.point1.v, out.point2.v]);
        assert_eq!((contact.depth, contact.id), (out.depth, out.id));
    }
}

/// A question to every call.
#[derive(Clone, Copy)]
struct Question {
    a: Rounded,
    b: Rounded,
    dir: [Real; 3],
    settings: Settings,
    options: DistanceOptions,
    slop: Real,
}

/// About a pair that overlaps.
fn good() -> Question {
    let mut r = Random(7);
    let (mut a, mut b) = (r.shape(0.0, true), r.shape(0.0, true));
    (a.half, b.half) = ([1.0; 3], [0.5; 3]);
    b.at = [1.3, 0.1, 0.2];
    Question { a, b, dir: DIR, settings: Settings::default(), options: DistanceOptions::default(), slop: 0.01 }
}

impl Question {
    fn bodies(&self) -> [Body<'_>; 2] {
        [&self.a, &self.b]
    }

    /// Asks every call, from the state that an overlap left: those whose names hold one of these
    /// words refuse, and write nothing.
    fn refused_by(&self, words: &[&str], what: &str) {
        let (q, of) = (self, good());
        let ([a, b], [of_a, of_b]) = (q.bodies(), of.bodies());
        let mut before = Warm::default();
        let hit = ccd::penetration(of_a, of_b, &of.settings, Some(&mut before));
        assert!(hit.expect("good input").is_some());
        let check = |name: &str, ask: &mut dyn FnMut(&mut Warm) -> Result<(), Error>| {
            let mut warm = before;
            let refuses = ask(&mut warm).err();
            let expected = words.iter().any(|word| name.contains(word));
            assert_eq!(refuses.is_some(), expected, "{name}: {what}");
            if let Some(said) = refuses {
                assert!(matches!(said, Error::BadInput(_)), "{name}, {what}: {said}");
                assert_eq!(format!("{warm:?}"), format!("{before:?}"), "{name}, {what}");
            }
        };
        for call in &CALLS {
            check(call.name, &mut |warm| (call.rust)(a, b, q.dir, &q.settings, Some(warm)).map(drop));
        }
        check("intersect", &mut |warm| ccd::intersect(a, b, Some(warm)).map(drop));
        check("distance", &mut |warm| ccd::signed_distance(a, b, &q.settings, &q.options, Some(warm)).map(drop));
        let mut room = [Contact::default(); 2];
        check("contacts", &mut |_| ccd::contacts(a, b, q.dir, q.slop, None, &mut room).map(drop));
        let written = room != [Contact::default(); 2];
        assert_eq!(written, !words.iter().any(|word| "contacts".contains(word)));
    }
}

#[test]
fn what_no_query_can_work_with_is_refused() {
    const ASKED_WITHIN: [&str; 2] = ["penetration", "distance"];
    let (infinite, nan) = (Real::INFINITY, Real::NAN);
    for length in [-1e-9, nan, Real::NEG_INFINITY, 0.0, infinite] {
        let (mut tolerance, mut slop) = (good(), good());
        tolerance.settings.tolerance = length;
        slop.slop = length;
        // Zero asks for the best there is, infinity for any answer.
        let none = length.is_nan() || length < 0.0;
        tolerance.refused_by(&ASKED_WITHIN[..2 * usize::from(none)], "tolerance");
        slop.refused_by(&["contacts"][..usize::from(none)], "slop");
        for field in 0..3 {
            let mut q = good();
            let DistanceOptions { margin1, margin2, max_distance } = &mut q.options;
            *[margin1, margin2, max_distance][field] = length;
            // No object has an infinite margin.
            let refused = none || field < 2 && length == infinite;
            q.refused_by(&["distance"][..usize::from(refused)], "option of the distance");
        }
    }
    for dir in [[0.0; 3], [0.0, nan, 1.0], [infinite, 0.0, 0.0]] {
        Question { dir, ..good() }.refused_by(&["along", "planar", "contacts"], "direction");
        // A guess of nothing is cold.
        let (guess, cold) = (Warm::guess(dir), Warm::default());
        assert_eq!(format!("{guess:?}"), format!("{cold:?}"));
    }
    for bad in [nan, infinite, -infinite] {
        for (point, centre) in [(true, false), (false, true), (true, true)] {
            let mut q = good();
            q.b.radius = if point { bad } else { 0.0 };
            q.b.at[1] = if centre { bad } else { 0.0 };
            q.refused_by(&[""], "shape");
        }
    }
    let q = good();
    let [a, b] = q.bodies();
    assert!(ccd::contacts(a, b, DIR, 0.0, None, &mut []).is_err());
}

/// Errors go through `?`, and say what is wrong.
#[test]
fn errors_are_errors() {
    fn fails() -> Result<(), Box<dyn std::error::Error>> {
        let q = good();
        let [a, b] = q.bodies();
        ccd::penetration(a, b, &Settings::new(Real::NAN), None)?;
        Ok(())
    }
    let said = fails().expect_err("a NaN").to_string();
    assert_eq!(said, "the tolerance is negative or NaN");
}

/// A shape that panics: the query is left, the state is as it was.
#[test]
fn a_panic_leaves_the_state() {
    let (Question { a, settings, .. }, before) = (good(), Warm::guess(DIR));
    for left in 0..40 {
        let asked = std::cell::Cell::new(0);
        let tired = |d: [Real; 3]| {
            asked.set(asked.get() + 1);
            assert!(asked.get() <= left, "tired");
            d.map(|x| 0.1 * x)
        };
        let mut warm = before;
        let bodies: [Body; 2] = [&a, &tired];
        let ask = || ccd::penetration_proven(bodies[0], bodies[1], &settings, Some(&mut warm)).map(|_| ());
        let left = catch_unwind(AssertUnwindSafe(ask));
        let kept = format!("{warm:?}") == format!("{before:?}");
        assert_eq!(left.is_err(), kept, "after {} answers", asked.get());
    }
}

/// Shapes of different kinds in one list.
#[test]
fn shapes_behind_a_pointer() {
    let Question { a, b, .. } = good();
    let point = |_: [Real; 3]| [1.2, 0.1, 0.2];
    let all: [Box<dyn Shape>; 3] = [Box::new(a), Box::new(b), Box::new(point)];
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        assert_eq!(ccd::intersect(&*all[i], &*all[j], None), Ok(true));
        let hit = ccd::penetration(&*all[i], &*all[j], &Settings::default(), None);
        assert!(hit.expect("good input").is_some());
    }
    assert!(ccd::implementation().starts_with("warmccd "));
}

// --- every exported function, as C calls it ---------------------------------------------------

/// Arguments of a call, and its answer.
type InC = fn(Object, Object, *const ccd_t, *mut ccd_warm_t) -> c_int;

/// A call that writes depth, direction and position.
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

/// Those that CALLS has not; what each returns of an overlap, of a miss and of points that are no numbers.
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

/// A box, or a ball, or both.
fn rounded(half: [Real; 3], radius: Real, at: [Real; 3]) -> Rounded {
    let (turn, centred) = ([1.0, 0.0], true);
    Rounded { at, half, radius, turn, centred }
}

/// Every state that C can hand over: cold, a guess, any bytes at all.
fn states() -> Vec<ccd_warm_t> {
    let bytes = |next: &mut dyn FnMut() -> u8| {
        let mut state = MaybeUninit::<ccd_warm_t>::uninit();
        let first = state.as_mut_ptr().cast::<u8>();
        for i in 0..size_of::<ccd_warm_t>() {
            // SAFETY: a byte of it.
            unsafe { first.add(i).write(next()) };
        }
        // SAFETY: every byte was written, and any will do.
        unsafe { state.assume_init() }
    };
    let mut random = Random(1);
    let mut states = vec![bytes(&mut || 0), bytes(&mut || 0), bytes(&mut || 0xff)];
    // SAFETY: a state.
    unsafe { ccdWarmGuess(&mut states[0], &WAY) };
    let random_states = if cfg!(miri) { 1 } else { 8 };
    let mut byte = || (128.0 + random.within(128.0)) as u8;
    states.extend((0..random_states).map(|_| bytes(&mut byte)));
    states
}

/// Whatever the state holds, hits are hits and misses misses; a point that is no number is refused.
#[test]
fn every_call_answers_in_c_from_every_state() {
    let (ball, brick) = (rounded([0.0; 3], 1.0, [0.0; 3]), [0.5, 1.0, 1.5]);
    let ccd = ccd_t { first_dir: Some(ccdFirstDirDefault), ..in_c(&Settings::default(), true) };
    for (a, b, expected) in [
        (ball, rounded([0.0; 3], 0.5, [1.2, 0.0, 0.0]), 0),
        (rounded(brick, 0.0, [0.9, 0.1, 0.2]), ball, 0),
        (rounded(brick, 0.0, [5.0, 4.0, 3.0]), ball, 1),
        (ball, rounded([0.0; 3], Real::NAN, [0.5; 3]), 2),
    ] {
        for (number, mut state) in states().into_iter().enumerate() {
            // The second call starts from what the first one left.
            for _ in 0..2 {
                for (name, codes, ask) in &IN_C {
                    let code = ask(object(&a), object(&b), &ccd, &mut state);
                    assert_eq!(code, codes[expected], "{name}, state {number}");
                }
                for call in &CALLS {
                    let code = in_c_of(call, &a, &b, &ccd, &mut state, CCD_WANT_ALL).0;
                    assert_eq!(code, FULL[expected], "{}, state {number}", call.name);
                }
            }
        }
    }
}

/// A ball in the middle of one that is a hundredth too long: minima on a circle, and nearly
/// everywhere. The proof outgrows the stack.
#[test]
fn memory_from_malloc() {
    let a = rounded([0.0, 0.0, 0.01], 1.0, [0.0; 3]);
    let b = rounded([0.0; 3], 0.5, [0.0; 3]);
    let ccd = in_c(&Settings::default(), true);
    let (code, out) = in_c_of(&CALLS[2], &a, &b, &ccd, null_mut(), CCD_WANT_ALL);
    assert_eq!(code, CCD_LIMIT);
    assert!((out.depth - 1.5).abs() < 1e-4 && out.support_points > 162);
}

/// What asks one object or none.
#[test]
fn what_asks_no_pair() {
    let ball = rounded([0.0; 3], 1.0, [0.5; 3]);
    let mut found = MaybeUninit::<ccd_check_t>::uninit();
    let mut dir = ccd_vec3_t::default();
    let point = |x, y, z| ccd_vec3_t { v: [x, y, z] };
    let (p, a) = (point(0.25, 0.25, 2.0), point(0.0, 0.0, 0.0));
    let (b, c, mut witness) = (point(1.0, 0.0, 0.0), point(0.0, 1.0, 0.0), a);
    let at = &raw mut witness;
    // SAFETY: a live object of its type, and room for what is found; a string that stays; points, and
    // the witness may be one of the inputs.
    unsafe {
        let faults = ccdCheck(object(&ball), Some(support), Some(center), found.as_mut_ptr());
        assert!(faults == 0 && (found.assume_init().size - 2.0).abs() < 0.1);
        ccdFirstDirDefault(null(), null(), &mut dir);
        assert_eq!(dir.v, [1.0, 0.0, 0.0]);
        let name = CStr::from_ptr(ccdImplementation());
        assert!(name.to_bytes().starts_with(b"warmccd "));
        assert_eq!(ccdVec3PointTriDist2(&p, at, &b, &c, at), 4.0);
        assert_eq!(*at, point(0.25, 0.25, 0.0));
        at.write(a);
        assert_eq!(ccdVec3PointSegmentDist2(&p, at, &b, at), 4.0625);
    }
}

/// `__ccdSupport` with its direction in its output; a tetrahedron around the origin, taken apart by
/// ccdPtDestroy.
#[test]
fn polytope_in_c() {
    let a = rounded([0.0; 3], 1.0, [0.0; 3]);
    let b = Rounded { at: [3.0, 0.0, 0.0], ..a };
    let (mut out, ccd) = (ccd_support_t::default(), in_c(&Settings::default(), true));
    out.v.v = [0.0, 1.0, 0.0];
    let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    let mut pt = MaybeUninit::<ccd_pt_t>::uninit();
    let pt = pt.as_mut_ptr();
    // SAFETY: live objects; a polytope of its own elements, which NULL is none of.
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
