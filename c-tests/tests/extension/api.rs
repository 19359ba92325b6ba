// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Rust interface: the same bits as the C calls, and errors for invalid arguments. The C tests check the results
//! themselves. (All exported functions from Rust, for Miri: `lab/miri.rs`.)

#![allow(unsafe_code, reason = "calls of the C interface")]

use ccd::internals::ffi::*;
use ccd::{Contact, DistanceOptions, Error, Penetration, Real, Settings, Shape, Status, Warm};
use std::ffi::{c_int, c_uint, c_ulong, c_void};
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::null_mut;

/// Box with a ball around it, turned about the z axis.
#[derive(Clone, Copy)]
pub struct Rounded {
    pub at: [Real; 3],
    pub half: [Real; 3],
    pub radius: Real,
    pub turn: [Real; 2],
    pub centred: bool,
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

pub unsafe extern "C-unwind" fn support(obj: *const c_void, dir: *const ccd_vec3_t, out: *mut ccd_vec3_t) {
    // SAFETY: `obj` is a Rounded, `dir` a direction, `out` memory for a point.
    unsafe { (*out).v = (*obj.cast::<Rounded>()).support((*dir).v) };
}

pub unsafe extern "C-unwind" fn center(obj: *const c_void, out: *mut ccd_vec3_t) {
    // SAFETY: `obj` is a Rounded, `out` memory for a point.
    unsafe { (*out).v = (*obj.cast::<Rounded>()).at };
}

/// Returns a box with a ball around it, parallel to the axes.
pub fn rounded(half: [Real; 3], radius: Real, at: [Real; 3]) -> Rounded {
    let (turn, centred) = ([1.0, 0.0], true);
    Rounded { at, half, radius, turn, centred }
}

pub fn in_c(settings: &Settings, centred: bool) -> ccd_t {
    let centre = centred.then_some(center as ccd_center_fn);
    ccd_t {
        first_dir: None,
        support1: Some(support),
        support2: Some(support),
        center1: centre,
        center2: centre,
        max_iterations: settings.max_iterations as _,
        epa_tolerance: settings.tolerance as Real,
        mpr_tolerance: settings.tolerance as Real,
        dist_tolerance: settings.tolerance as Real,
    }
}

const DIR: [Real; 3] = [1.0, 2.0, -2.0];
pub const C_DIR: ccd_vec3_t = ccd_vec3_t { v: DIR };
pub type Object = *const c_void;
/// Shape of any type, for which the library is compiled once.
pub type Body<'a> = &'a dyn Shape;

type Found = Result<Option<Penetration>, Error>;

/// Penetration query in Rust and in C, along DIR or in the plane across it where it takes a direction.
pub struct Call {
    pub name: &'static str,
    rust: fn(Body, Body, [Real; 3], &Settings, Option<&mut Warm>) -> Found,
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
            // SAFETY: live objects of their types, and memory for a result.
            c: |a, b, ccd, warm, want, out| unsafe { $c(a, b, ccd, $($vector,)? warm, want, out) },
        }
    };
}

pub const CALLS: [Call; 6] = [
    call!(penetration, ccdPenetration),
    call!(penetration_local, ccdPenetrationLocal),
    call!(penetration_proven, ccdPenetrationProven),
    call!(penetration_along, ccdPenetrationAlong, dir, &C_DIR),
    call!(penetration_planar, ccdPenetrationPlanar, dir, &C_DIR),
    call!(penetration_incremental, ccdPenetrationIncremental),
];

pub fn object(of: &Rounded) -> Object {
    (&raw const *of).cast()
}

/// Returns code and result of the call in C.
pub fn call_in_c(
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

fn assert_same(rust: Found, (code, c): (c_int, ccd_penetration_t)) {
    let Some(hit) = rust.expect("valid input") else {
        return assert_eq!(code, CCD_MISS);
    };
    assert_eq!(code, if hit.status == Status::Converged { CCD_HIT } else { CCD_LIMIT });
    assert_eq!(hit.status as c_int, c.status);
    assert_eq!((hit.depth, hit.depth_lower), (c.depth, c.depth_lower));
    assert_eq!((hit.dir, hit.normal), (c.dir.v, c.normal.v));
    assert_eq!([hit.pos, hit.point1, hit.point2], [c.pos.v, c.point1.v, c.point2.v]);
    assert_eq!(hit.support_points as c_ulong, c.support_points);
    assert_eq!(hit.iterations as c_ulong, c.iterations);
}

/// Compares every call with C, cold and with a state that all share, with every set of requested results,
/// with and without centers.
#[test]
fn results_are_bitwise_those_of_c() {
    let mut r = Random(1);
    let (mut hits, mut misses) = (0, 0);
    for round in 0..if cfg!(miri) { 1 } else { 200 } {
        let centred = round % 2 == 0;
        let (pos, points) = (round % 3 != 0, round % 5 != 0);
        let bits = [(pos, CCD_WANT_POS), (points, CCD_WANT_POINTS)];
        let bits = bits.iter().filter(|b| b.0).map(|b| b.1).sum();
        let settings = Settings { pos, points, ..Settings::new(1.0 / 65536.0) };
        let (mut a, mut b) = (r.shape(0.5, centred), r.shape(0.8, centred));
        let c = in_c(&settings, centred);
        let mut warm = Warm::guess(DIR);
        let mut state = MaybeUninit::<ccd_warm_t>::zeroed();
        // SAFETY: memory of a state, every byte of which is set.
        let state = unsafe {
            ccdWarmGuess(state.as_mut_ptr(), &C_DIR);
            state.assume_init_mut()
        };
        for frame in 0..3 {
            b.at[frame % 3] += 0.02;
            for call in &CALLS {
                let cold = call_in_c(call, &a, &b, &c, null_mut(), bits);
                match cold.0 {
                    CCD_MISS => misses += 1,
                    _ => hits += 1,
                }
                assert_same((call.rust)(&a, &b, DIR, &settings, None), cold);
                let from_state = call_in_c(call, &a, &b, &c, state, bits);
                assert_same((call.rust)(&a, &b, DIR, &settings, Some(&mut warm)), from_state);
            }
            compare_intersect_and_distance(&a, &b, &settings, &mut warm, &c, state, bits);
            warm.flip();
            // SAFETY: `state` is a state.
            unsafe { ccdWarmFlip(state) };
            (a, b) = (b, a);
        }
        compare_contacts(&a, &b, &c);
    }
    let many = hits > 500 && misses > 500;
    assert!(many || cfg!(miri), "{hits} hits, {misses} misses");
}

fn compare_intersect_and_distance(
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
    let d = ccd::signed_distance(a, b, settings, &options, Some(warm)).expect("valid input");
    assert_eq!((d.status != Status::Converged, d.status as c_int), (code == CCD_LIMIT, out.status));
    assert_eq!((d.distance, d.distance_upper), (out.distance, out.distance_upper));
    assert_eq!([d.normal, d.point1, d.point2], [out.normal.v, out.point1.v, out.point2.v]);
    assert_eq!(d.support_points as c_ulong, out.support_points);
}

fn compare_contacts(a: &Rounded, b: &Rounded, c: &ccd_t) {
    let mut room = [Contact::default(); 4];
    let mut cache = ccd::ManifoldCache::default();
    let found = ccd::contacts(a as Body, b as Body, DIR, 0.01, Some(&mut cache), &mut room).expect("valid input");
    let (a, b) = (object(a), object(b));
    let mut out = [const { MaybeUninit::<ccd_contact_t>::uninit() }; 4];
    let mut c_cache = MaybeUninit::<ccd_manifold_cache_t>::zeroed();
    // SAFETY: live objects of their types, memory for four contacts.
    let count = unsafe { ccdContacts(a, b, c, &C_DIR, 0.01, c_cache.as_mut_ptr(), out.as_mut_ptr().cast(), 4) };
    assert_eq!(found.len(), count as usize);
    for (contact, out) in found.iter().zip(out) {
        // SAFETY: one of the `count` contacts that were written.
        let out = unsafe { out.assume_init() };
        assert_eq!([contact.point1, contact.point2], [out.point1.v, out.point2.v]);
        assert_eq!((contact.depth, contact.id), (out.depth, out.id));
    }
}

/// Arguments of every call.
#[derive(Clone, Copy)]
struct Arguments {
    a: Rounded,
    b: Rounded,
    dir: [Real; 3],
    settings: Settings,
    options: DistanceOptions,
    slop: Real,
}

/// Returns valid arguments for a pair that overlaps.
fn valid() -> Arguments {
    let (half, options) = ([1.0; 3], DistanceOptions::default());
    let (a, b) = (rounded(half, 0.1, [0.0; 3]), rounded([0.5; 3], 0.0, [1.3, 0.1, 0.2]));
    Arguments { a, b, dir: DIR, settings: Settings::default(), options, slop: 0.01 }
}

impl Arguments {
    fn bodies(&self) -> [Body<'_>; 2] {
        [&self.a, &self.b]
    }

    /// Checks that the calls whose names contain one of these words, and only those, reject the
    /// arguments and leave the state and the outputs unchanged.
    fn assert_rejected_by(&self, words: &[&str], what: &str) {
        let (q, of) = (self, valid());
        let ([a, b], [of_a, of_b]) = (q.bodies(), of.bodies());
        let mut before = Warm::default();
        let hit = ccd::penetration(of_a, of_b, &of.settings, Some(&mut before));
        assert!(hit.expect("valid input").is_some());
        let is_rejected_by = |name: &str| words.iter().any(|word| name.contains(word));
        let check = |name: &str, call: &mut dyn FnMut(&mut Warm) -> Result<(), Error>| {
            let mut warm = before;
            let error = call(&mut warm).err();
            assert_eq!(error.is_some(), is_rejected_by(name), "{name}: {what}");
            assert_ne!(error, Some(Error::NoMemory), "{name}, {what}");
            assert!(error.is_none() || format!("{warm:?}") == format!("{before:?}"), "{name}, {what}");
        };
        for call in &CALLS {
            check(call.name, &mut |warm| (call.rust)(a, b, q.dir, &q.settings, Some(warm)).map(drop));
        }
        check("intersect", &mut |warm| ccd::intersect(a, b, Some(warm)).map(drop));
        check("distance", &mut |warm| ccd::signed_distance(a, b, &q.settings, &q.options, Some(warm)).map(drop));
        let mut room = [Contact::default(); 2];
        check("contacts", &mut |_| ccd::contacts(a, b, q.dir, q.slop, None, &mut room).map(drop));
        assert_eq!(room == [Contact::default(); 2], is_rejected_by("contacts"));
    }
}

#[test]
fn invalid_arguments_are_rejected() {
    let (infinite, nan) = (Real::INFINITY, Real::NAN);
    for tolerance in [-1e-9, f64::NAN, f64::NEG_INFINITY, 0.0, f64::INFINITY] {
        let length = tolerance as Real;
        // A length may be zero or infinite; a margin is finite.
        let is_invalid = length.is_nan() || length < 0.0;
        let if_invalid = |names: &'static [&str]| if is_invalid { names } else { &[] };
        let mut q = valid();
        q.settings.tolerance = tolerance;
        q.assert_rejected_by(if_invalid(&["penetration", "distance"]), "tolerance");
        Arguments { slop: length, ..valid() }.assert_rejected_by(if_invalid(&["contacts"]), "slop");
        for field in 0..3 {
            let mut q = valid();
            let DistanceOptions { margin1, margin2, max_distance } = &mut q.options;
            *[margin1, margin2, max_distance][field] = length;
            let is_rejected = is_invalid || field < 2 && length == infinite;
            q.assert_rejected_by(&["distance"][..usize::from(is_rejected)], "option of the distance");
        }
    }
    for dir in [[0.0; 3], [0.0, nan, 1.0], [infinite, 0.0, 0.0]] {
        Arguments { dir, ..valid() }.assert_rejected_by(&["along", "planar", "contacts"], "direction");
        assert_eq!(format!("{:?}", Warm::guess(dir)), format!("{:?}", Warm::default()), "an invalid guess is cold");
        // Also if the axis of the state separates the pair.
        let (mut apart, settings) = (Warm::default(), Settings::default());
        let far = Rounded { at: [9.0; 3], ..valid().b };
        let [a, b]: [Body; 2] = [&valid().a, &far];
        assert_eq!(ccd::penetration(a, b, &settings, Some(&mut apart)), Ok(None));
        let found = ccd::penetration_along(a, b, dir, &settings, Some(&mut apart));
        assert_eq!(found, Err(Error::Direction));
    }
    for bad in [nan, infinite, -infinite] {
        for (point, center) in [(true, false), (false, true), (true, true)] {
            let mut q = valid();
            q.b.radius = if point { bad } else { 0.0 };
            q.b.at[1] = if center { bad } else { 0.0 };
            q.assert_rejected_by(&[""], "shape");
        }
    }
    let q = valid();
    let [a, b] = q.bodies();
    assert!(ccd::contacts(a, b, DIR, 0.0, None, &mut []).is_err());
}

/// Checks that errors convert to `Box<dyn Error>` and name the invalid argument.
#[test]
fn errors_name_the_argument() {
    let q = valid();
    let [a, b] = q.bodies();
    let result = ccd::penetration(a, b, &Settings::new(f64::NAN), None);
    let error: Box<dyn std::error::Error> = result.expect_err("a NaN").into();
    assert_eq!(error.to_string(), "the tolerance is negative or NaN");
}

/// (`status.c` has a pair for each; the results above have those of C.)
#[test]
fn statuses_are_those_of_c() {
    let in_rust = [
        Status::Converged,
        Status::IterationLimit,
        Status::SupportLimit,
        Status::Rounding,
        Status::InconsistentSupport,
    ];
    let in_c = [
        CCD_STATUS_CONVERGED,
        CCD_STATUS_ITERATION_LIMIT,
        CCD_STATUS_SUPPORT_LIMIT,
        CCD_STATUS_ROUNDING,
        CCD_STATUS_INCONSISTENT_SUPPORT,
    ];
    assert_eq!(in_rust.map(|status| status as c_int), in_c);
}

/// Checks that a panic of a shape leaves the query, and the state unchanged.
#[test]
fn panics_of_a_shape_leave_the_state_unchanged() {
    let (Arguments { a, settings, .. }, before) = (valid(), Warm::guess(DIR));
    for limit in 0..40 {
        let count = std::cell::Cell::new(0);
        let panicking = |d: [Real; 3]| {
            count.set(count.get() + 1);
            assert!(count.get() <= limit, "the limit");
            d.map(|x| 0.1 * x)
        };
        let mut warm = before;
        let bodies: [Body; 2] = [&a, &panicking];
        let query = || ccd::penetration_proven(bodies[0], bodies[1], &settings, Some(&mut warm)).map(drop);
        let result = catch_unwind(AssertUnwindSafe(query));
        let is_unchanged = format!("{warm:?}") == format!("{before:?}");
        assert_eq!(result.is_err(), is_unchanged, "after {} calls", count.get());
    }
}
