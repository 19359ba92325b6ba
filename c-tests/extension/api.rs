// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Rust interface: the same bits as the C calls, and every call with arguments that no query
//! can work with.

// Calls into the C interface.
#![allow(unsafe_code)]

use ccd::internals::ffi::*;
use ccd::{Contact, DistanceOptions, Error, Penetration, Real, Settings, Shape, Want, Warm};
use std::ffi::{c_int, c_uint, c_ulong, c_void};
use std::mem::MaybeUninit;

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
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
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

unsafe extern "C-unwind" fn support(
    obj: *const c_void,
    dir: *const ccd_vec3_t,
    out: *mut ccd_vec3_t,
) {
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
type Object = *const c_void;
type Answer = Result<Option<Penetration>, Error>;

/// A penetration query in Rust and in C.
struct Call {
    rust: fn(&Rounded, &Rounded, &Settings, Option<&mut Warm>) -> Answer,
    c: fn(Object, Object, &ccd_t, *mut ccd_warm_t, c_uint, *mut ccd_penetration_t) -> c_int,
}

macro_rules! call {
    ($rust:ident, $c:ident $(, $dir:ident)?) => {
        Call {
            rust: |a, b, settings, warm| ccd::$rust(a, b, $($dir,)? settings, warm),
            // SAFETY: live objects of their types, and room for an answer.
            c: |a, b, ccd, warm, want, out| unsafe { $c(a, b, ccd, $(&ccd_vec3_t { v: $dir },)? warm, want, out) },
        }
    };
}

const CALLS: [Call; 6] = [
    call!(penetration, ccdPenetration),
    call!(penetration_local, ccdPenetrationLocal),
    call!(penetration_proven, ccdPenetrationProven),
    call!(penetration_along, ccdPenetrationAlong, DIR),
    call!(penetration_planar, ccdPenetrationPlanar, DIR),
    call!(penetration_incremental, ccdPenetrationIncremental),
];

fn object(of: &Rounded) -> Object {
    (&raw const *of).cast()
}

/// What the call says in C.
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
    assert_eq!(
        [hit.pos, hit.point1, hit.point2],
        [c.pos.v, c.point1.v, c.point2.v]
    );
    assert_eq!(hit.support_calls as c_ulong, c.support_calls);
    assert_eq!(hit.iterations as c_ulong, c.iterations);
}

/// Every call, cold and with a state that all share, whatever is wanted, with and without centres.
#[test]
fn same_bits_as_c() {
    let mut r = Random(1);
    let (mut hits, mut misses) = (0, 0);
    for round in 0..200 {
        let centred = round % 2 == 0;
        let want = Want {
            pos: round % 3 != 0,
            points: round % 5 != 0,
        };
        let bits = [(want.pos, CCD_WANT_POS), (want.points, CCD_WANT_POINTS)];
        let bits = bits.iter().filter(|b| b.0).map(|b| b.1).sum();
        let settings = Settings {
            want,
            ..Settings::new(1e-5)
        };
        let (mut a, mut b) = (r.shape(0.5, centred), r.shape(0.8, centred));
        let c = in_c(&settings, centred);
        let mut warm = Warm::guess(DIR);
        let mut state = MaybeUninit::<ccd_warm_t>::zeroed();
        // SAFETY: a state, of which every byte was given.
        let state = unsafe {
            ccdWarmGuess(state.as_mut_ptr(), &ccd_vec3_t { v: DIR });
            state.assume_init_mut()
        };
        for frame in 0..3 {
            b.at[frame % 3] += 0.02;
            for call in &CALLS {
                let cold = in_c_of(call, &a, &b, &c, std::ptr::null_mut(), bits);
                match cold.0 {
                    CCD_MISS => misses += 1,
                    _ => hits += 1,
                }
                same((call.rust)(&a, &b, &settings, None), cold);
                let kept = in_c_of(call, &a, &b, &c, state, bits);
                same((call.rust)(&a, &b, &settings, Some(&mut warm)), kept);
            }
            yes_or_no_and_distance(&a, &b, &settings, &mut warm, &c, state, bits);
            warm.flip();
            // SAFETY: a state.
            unsafe { ccdWarmFlip(state) };
            (a, b) = (b, a);
        }
        contacts_as_in_c(&a, &b, &c);
    }
    assert!(hits > 500 && misses > 500, "{hits} hits, {misses} misses");
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
    let options = DistanceOptions {
        margin1: 0.1,
        margin2: 0.0,
        max_distance: 0.5,
    };
    let mut out = MaybeUninit::<ccd_distance_t>::zeroed();
    // SAFETY: live objects of their types; zero is a value of the struct.
    let (yes, code, out) = unsafe {
        let yes = ccdIntersect(pa, pb, c, state) == 1;
        let code = ccdSignedDistance(pa, pb, c, 0.1, 0.0, 0.5, state, want, out.as_mut_ptr());
        (yes, code, out.assume_init())
    };
    assert_eq!(ccd::intersect(a, b, Some(warm)), Ok(yes));
    let d = ccd::signed_distance(a, b, settings, &options, Some(warm)).expect("good input");
    assert_eq!(d.limit, code == CCD_LIMIT);
    assert_eq!(
        (d.distance, d.distance_upper),
        (out.distance, out.distance_upper)
    );
    assert_eq!(
        [d.normal, d.point1, d.point2],
        [out.normal.v, out.point1.v, out.point2.v]
    );
    assert_eq!(d.support_calls as c_ulong, out.support_calls);
}

fn contacts_as_in_c(a: &Rounded, b: &Rounded, c: &ccd_t) {
    let mut room = [Contact::default(); 4];
    let mut memory = ccd::Manifold::default();
    let found = ccd::contacts(a, b, DIR, 0.01, Some(&mut memory), &mut room).expect("good input");
    let (a, b) = (object(a), object(b));
    let dir = ccd_vec3_t { v: DIR };
    let mut out = [const { MaybeUninit::<ccd_contact_t>::uninit() }; 4];
    let mut manifold = MaybeUninit::<ccd_manifold_t>::zeroed();
    // SAFETY: live objects of their types, room for four.
    let count = unsafe {
        let (memory, room) = (manifold.as_mut_ptr(), out.as_mut_ptr().cast());
        ccdContacts(a, b, c, &dir, 0.01, memory, room, 4)
    };
    assert_eq!(found.len(), count as usize);
    for (contact, out) in found.iter().zip(out) {
        // SAFETY: among those that were written.
        let out = unsafe { out.assume_init() };
        assert_eq!(
            [contact.point1, contact.point2],
            [out.point1.v, out.point2.v]
        );
        assert_eq!((contact.depth, contact.id), (out.depth, out.id));
    }
}

const NOT_LENGTHS: [Real; 3] = [-1e-9, Real::NAN, Real::NEG_INFINITY];

/// A pair that overlaps, and a state that has seen it.
fn overlapping() -> (Rounded, Rounded, Warm) {
    let mut r = Random(7);
    let (mut a, mut b) = (r.shape(0.0, true), r.shape(0.0, true));
    (a.half, b.half) = ([1.0; 3], [0.5; 3]);
    b.at = [1.3, 0.1, 0.2];
    let mut warm = Warm::default();
    let hit = ccd::penetration(&a, &b, &Settings::default(), Some(&mut warm));
    assert!(hit.expect("good input").is_some());
    (a, b, warm)
}

fn is_bad<T: std::fmt::Debug>(answer: Result<T, Error>, warm: &Warm, before: &Warm, what: &str) {
    assert!(
        matches!(answer, Err(Error::BadInput(_))),
        "{what}: {answer:?}"
    );
    let (warm, before) = (format!("{warm:?}"), format!("{before:?}"));
    assert_eq!(warm, before, "{what}: the state was written");
}

#[test]
fn lengths_that_are_none() {
    let (a, b, before) = overlapping();
    let mut warm = before;
    for bad in NOT_LENGTHS {
        let settings = Settings::new(bad);
        for call in &CALLS {
            let answer = (call.rust)(&a, &b, &settings, Some(&mut warm));
            is_bad(answer, &warm, &before, "tolerance");
        }
        let options = DistanceOptions::default();
        let answer = ccd::signed_distance(&a, &b, &settings, &options, Some(&mut warm));
        is_bad(answer, &warm, &before, "tolerance of the distance");
        for field in 0..3 {
            let mut options = DistanceOptions::default();
            *[
                &mut options.margin1,
                &mut options.margin2,
                &mut options.max_distance,
            ][field] = bad;
            let settings = Settings::default();
            let answer = ccd::signed_distance(&a, &b, &settings, &options, Some(&mut warm));
            is_bad(answer, &warm, &before, "option of the distance");
        }
        let mut room = [Contact::default(); 2];
        let answer = ccd::contacts(&a, &b, DIR, bad, None, &mut room);
        assert!(matches!(answer, Err(Error::BadInput(_))), "slop");
        assert_eq!(room, [Contact::default(); 2]);
    }
    let endless = DistanceOptions {
        margin1: Real::INFINITY,
        ..Default::default()
    };
    let answer = ccd::signed_distance(&a, &b, &Settings::default(), &endless, Some(&mut warm));
    is_bad(answer, &warm, &before, "infinite margin");
    assert!(ccd::contacts(&a, &b, DIR, 0.0, None, &mut []).is_err());
    // Zero asks for the best there is, infinity for any answer.
    for call in &CALLS {
        for tolerance in [0.0, Real::INFINITY] {
            let answer = (call.rust)(&a, &b, &Settings::new(tolerance), None);
            assert!(answer.expect("good input").is_some(), "{tolerance}");
        }
    }
}

#[test]
fn directions_that_are_none() {
    let (a, b, before) = overlapping();
    let mut warm = before;
    let settings = Settings::default();
    let mut room = [Contact::default(); 2];
    for bad in [[0.0; 3], [0.0, Real::NAN, 1.0], [Real::INFINITY, 0.0, 0.0]] {
        let answer = ccd::penetration_along(&a, &b, bad, &settings, Some(&mut warm));
        is_bad(answer, &warm, &before, "along");
        let answer = ccd::penetration_planar(&a, &b, bad, &settings, Some(&mut warm));
        is_bad(answer, &warm, &before, "planar");
        let answer = ccd::contacts(&a, &b, bad, 0.01, None, &mut room);
        assert!(matches!(answer, Err(Error::BadInput(_))), "contacts");
        // A guess of nothing is cold.
        assert_eq!(
            format!("{:?}", Warm::guess(bad)),
            format!("{:?}", Warm::default())
        );
    }
}

#[test]
fn shapes_that_are_none() {
    let (a, b, before) = overlapping();
    let mut warm = before;
    let settings = Settings::default();
    let options = DistanceOptions::default();
    for bad in [Real::NAN, Real::INFINITY, Real::NEG_INFINITY] {
        for (point, centre) in [(true, false), (false, true), (true, true)] {
            let mut lost = b;
            lost.radius = if point { bad } else { 0.0 };
            lost.at[1] = if centre { bad } else { 0.0 };
            for call in &CALLS {
                let answer = (call.rust)(&a, &lost, &settings, Some(&mut warm));
                is_bad(answer, &warm, &before, "shape");
            }
            let answer = ccd::intersect(&a, &lost, Some(&mut warm));
            is_bad(answer, &warm, &before, "intersect");
            let cold = ccd::intersect(&a, &lost, None);
            is_bad(cold, &warm, &before, "intersect, cold");
            let answer = ccd::signed_distance(&a, &lost, &settings, &options, Some(&mut warm));
            is_bad(answer, &warm, &before, "distance");
            let mut room = [Contact::default(); 2];
            assert!(ccd::contacts(&a, &lost, DIR, 0.01, None, &mut room).is_err());
        }
    }
}

/// Errors go through `?`, and say what is wrong.
#[test]
fn errors_are_errors() {
    fn fails() -> Result<(), Box<dyn std::error::Error>> {
        let (a, b, _) = overlapping();
        ccd::penetration(&a, &b, &Settings::new(Real::NAN), None)?;
        Ok(())
    }
    let said = fails().expect_err("a NaN").to_string();
    assert_eq!(said, "the tolerance is negative or NaN");
}

/// A shape that panics: the query is left, the state is as it was.
#[test]
fn a_panic_leaves_the_state() {
    let (a, _, before) = overlapping();
    for left in 0..40 {
        let asked = std::cell::Cell::new(0);
        let tired = |d: [Real; 3]| {
            asked.set(asked.get() + 1);
            assert!(asked.get() <= left, "tired");
            d.map(|x| 0.1 * x)
        };
        let mut warm = before;
        let settings = Settings::default();
        let ask = || ccd::penetration_proven(&a, &tired, &settings, Some(&mut warm)).map(|_| ());
        let left = std::panic::catch_unwind(std::panic::AssertUnwindSafe(ask));
        let kept = format!("{warm:?}") == format!("{before:?}");
        assert_eq!(left.is_err(), kept, "after {} answers", asked.get());
    }
}

/// Shapes of different kinds in one list.
#[test]
fn shapes_behind_a_pointer() {
    let (a, b, _) = overlapping();
    let point = |_: [Real; 3]| [1.2, 0.1, 0.2];
    let all: [Box<dyn Shape>; 3] = [Box::new(a), Box::new(b), Box::new(point)];
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        assert_eq!(ccd::intersect(&*all[i], &*all[j], None), Ok(true));
        let hit = ccd::penetration(&*all[i], &*all[j], &Settings::default(), None);
        assert!(hit.expect("good input").is_some());
    }
    assert!(ccd::implementation().starts_with("warmccd "));
}
