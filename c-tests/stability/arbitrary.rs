// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Properties of the exported functions over arbitrary objects, tolerances and states,
//! with failures shrunk to small ones: rounded hulls of points on nasty grids, and
//! objects that answer from a list whatever the direction.
//!
//! The seed is fixed. A longer look: `PROPTEST_CASES=200000 PROPTEST_RNG_SEED=7 cargo
//! test --release --test arbitrary`.

// C names, and calls into the C interface.
#![allow(unsafe_code)]

use std::cell::Cell;
use std::ffi::{c_int, c_void};
use std::mem::MaybeUninit;

use ccd::Real;
use ccd::internals::EPSILON;
use ccd::internals::ffi::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// More calls of one support function than any query may take.
const MOST_CALLS: u64 = 20_000;

/// The hull of the points, inflated, perhaps with answers that are no such object's.
#[derive(Clone, Debug)]
struct Object {
    points: Vec<[Real; 3]>,
    radius: Real,
    position: [Real; 3],
    lie: Option<Lie>,
    calls: Cell<u64>,
    /// Has answered with what is no number.
    nonsense: Cell<bool>,
}

/// Of the list one after the other, whatever the direction.
#[derive(Clone, Debug)]
enum Lie {
    Instead(Vec<[Real; 3]>),
    Added(Vec<[Real; 3]>),
    Times(Vec<[Real; 3]>),
    /// The point of the opposite direction.
    Opposite,
}

fn dot(a: &[Real; 3], b: &[Real; 3]) -> Real {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Object {
    fn support(&self, dir: &[Real; 3]) -> [Real; 3] {
        let calls = self.calls.get();
        self.calls.set(calls + 1);
        assert!(calls < MOST_CALLS, "endless");
        let sign = match self.lie {
            Some(Lie::Opposite) => -1.0,
            _ => 1.0,
        };
        let dir = dir.map(|x| sign * x);
        let farthest = (self.points.iter()).max_by(|a, b| dot(a, &dir).total_cmp(&dot(b, &dir)));
        let point = farthest.expect("an object has points");
        let length = dot(&dir, &dir).sqrt();
        let said = |list: &Vec<[Real; 3]>, i: usize| list[calls as usize % list.len()][i];
        let answer = std::array::from_fn(|i| {
            let x = point[i] + self.radius * dir[i] / length + self.position[i];
            match &self.lie {
                Some(Lie::Instead(list)) => said(list, i),
                Some(Lie::Added(list)) => x + said(list, i),
                Some(Lie::Times(list)) => x * said(list, i),
                _ => x,
            }
        });
        self.nonsense
            .set(self.nonsense.get() || !answer.iter().all(|x| x.is_finite()));
        answer
    }

    fn forget(&self) {
        self.calls.set(0);
        self.nonsense.set(false);
    }

    /// Largest coordinate it computes with.
    fn size(&self) -> Real {
        let coordinates = self.points.iter().flatten().chain(&self.position);
        self.radius + coordinates.fold(0.0, |m: Real, x| m + x.abs())
    }
}

/// h(dir) of the Minkowski difference, in the objects' own arithmetic.
fn support_value(a: &Object, b: &Object, dir: &[Real; 3]) -> Real {
    let (p, q) = (a.support(dir), b.support(&dir.map(|x| -x)));
    dot(dir, &std::array::from_fn(|i| p[i] - q[i]))
}

unsafe extern "C-unwind" fn support(
    obj: *const c_void,
    dir: *const ccd_vec3_t,
    vec: *mut ccd_vec3_t,
) {
    // SAFETY: the tests below hand in Objects, and the library its own vectors.
    unsafe { (*vec).v = (*obj.cast::<Object>()).support(&(*dir).v) };
}

unsafe extern "C-unwind" fn center(obj: *const c_void, center: *mut ccd_vec3_t) {
    // SAFETY: as above.
    unsafe {
        let obj = &*obj.cast::<Object>();
        let count = obj.points.len() as Real;
        (*center).v = std::array::from_fn(|i| {
            obj.position[i] + obj.points.iter().map(|p| p[i]).sum::<Real>() / count
        });
    }
}

fn settings(tolerance: Real) -> ccd_t {
    ccd_t {
        first_dir: Some(ccdFirstDirDefault),
        support1: Some(support),
        support2: Some(support),
        center1: Some(center),
        center2: Some(center),
        max_iterations: std::ffi::c_ulong::MAX,
        epa_tolerance: tolerance,
        mpr_tolerance: tolerance,
        dist_tolerance: tolerance,
    }
}

fn pointer(object: &Object) -> *const c_void {
    std::ptr::from_ref(object).cast()
}

/// What a state holds before the query.
#[derive(Clone, Debug)]
enum Start {
    Cold,
    Guess([Real; 3]),
    Bytes(Vec<u8>),
}

impl Start {
    fn state(&self) -> ccd_warm_t {
        let mut state = MaybeUninit::<ccd_warm_t>::zeroed();
        // SAFETY: a state is plain numbers: zero and any other bytes are one; the guess
        // is a live vector, and there are no more bytes than the state has.
        unsafe {
            match self {
                Start::Cold => (),
                Start::Guess(v) => ccdWarmGuess(state.as_mut_ptr(), &ccd_vec3_t { v: *v }),
                Start::Bytes(bytes) => std::ptr::copy_nonoverlapping(
                    bytes.as_ptr(),
                    state.as_mut_ptr().cast(),
                    bytes.len().min(size_of::<ccd_warm_t>()),
                ),
            }
            state.assume_init()
        }
    }
}

/// The queries that answer with a depth and a direction; of which the last is asked for one.
const MINIMUM: usize = 4;
const INCREMENTAL: usize = 5;
const DISTANCE: usize = 6;
const PENETRATION: usize = 7;
const ALONG: usize = 8;

/// Code, depth, direction and what is proven of the depth.
fn ask(
    query: usize,
    a: &Object,
    b: &Object,
    tolerance: Real,
    start: &Start,
) -> (c_int, Real, [Real; 3], Real) {
    let ccd = settings(tolerance);
    let zero = ccd_vec3_t { v: [0.0; 3] };
    let (mut depth, mut dir, mut pos) = (0.0, zero, zero);
    let mut warm = start.state();
    let mut out = MaybeUninit::<ccd_penetration_t>::zeroed();
    let (a, b) = (pointer(a), pointer(b));
    if query == DISTANCE {
        let (code, d) = distance(a, b, &ccd, &mut warm);
        return (code, -d.distance, d.normal.v, -d.distance_upper);
    }
    // SAFETY: every pointer is to a live object of its type; ccd_penetration_t is plain
    // numbers, for which zero is a value.
    unsafe {
        let code = match query {
            0 => ccdMPRPenetration(a, b, &ccd, &mut depth, &mut dir, &mut pos),
            1 => ccdMPRPenetrationWarm(a, b, &ccd, &mut warm, &mut depth, &mut dir, &mut pos),
            2 => ccdGJKPenetration(a, b, &ccd, &mut depth, &mut dir, &mut pos),
            3 => ccdPenetrationLocal(a, b, &ccd, &mut warm, CCD_WANT_ALL, out.as_mut_ptr()),
            MINIMUM => ccdPenetrationProven(a, b, &ccd, &mut warm, CCD_WANT_ALL, out.as_mut_ptr()),
            PENETRATION => ccdPenetration(a, b, &ccd, &mut warm, CCD_WANT_ALL, out.as_mut_ptr()),
            ALONG => {
                let way = ccd_vec3_t { v: [0.6, 0.0, 0.8] };
                let out = out.as_mut_ptr();
                ccdPenetrationAlong(a, b, &ccd, &way, &mut warm, CCD_WANT_ALL, out)
            }
            _ => ccdPenetrationIncremental(a, b, &ccd, &mut warm, CCD_WANT_ALL, out.as_mut_ptr()),
        };
        let out = out.assume_init();
        if query >= 3 {
            (code, out.depth, out.dir.v, out.depth_lower)
        } else {
            (code, depth, dir.v, 0.0)
        }
    }
}

/// What the calls say that ask no more than whether two objects overlap, or by which vector.
fn verdicts(a: &Object, b: &Object, tolerance: Real, start: &Start) -> [c_int; 5] {
    let ccd = settings(tolerance);
    let mut warm = start.state();
    let mut sep = ccd_vec3_t { v: [0.0; 3] };
    let (a, b) = (pointer(a), pointer(b));
    // SAFETY: every pointer is to a live object of its type.
    unsafe {
        [
            ccdMPRIntersect(a, b, &ccd),
            ccdGJKIntersect(a, b, &ccd),
            ccdMPRIntersectWarm(a, b, &ccd, &mut warm),
            ccdIntersect(a, b, &ccd, &mut warm),
            ccdGJKSeparate(a, b, &ccd, &mut sep),
        ]
    }
}

fn distance(
    a: *const c_void,
    b: *const c_void,
    ccd: &ccd_t,
    warm: &mut ccd_warm_t,
) -> (c_int, ccd_distance_t) {
    let mut out = MaybeUninit::<ccd_distance_t>::zeroed();
    // SAFETY: every pointer is to a live object of its type; ccd_distance_t is plain
    // numbers, for which zero is a value.
    unsafe {
        let code = ccdSignedDistance(
            a,
            b,
            ccd,
            0.0,
            0.0,
            Real::INFINITY,
            warm,
            CCD_WANT_ALL,
            out.as_mut_ptr(),
        );
        (code, out.assume_init())
    }
}

const MOST_CONTACTS: usize = 6;

#[derive(Debug)]
struct Contact {
    point1: [Real; 3],
    point2: [Real; 3],
    depth: Real,
}

impl From<ccd_contact_t> for Contact {
    fn from(c: ccd_contact_t) -> Self {
        Self {
            point1: c.point1.v,
            point2: c.point2.v,
            depth: c.depth,
        }
    }
}

/// Code, and the contacts along `normal`.
fn contacts(a: &Object, b: &Object, normal: &[Real; 3], slop: Real) -> (c_int, Vec<Contact>) {
    let ccd = settings(0.0);
    let normal = ccd_vec3_t { v: *normal };
    let mut out = [const { MaybeUninit::<ccd_contact_t>::zeroed() }; MOST_CONTACTS];
    // SAFETY: every pointer is to a live object of its type; ccd_contact_t is plain
    // numbers, for which zero is a value.
    unsafe {
        let (a, b, room) = (pointer(a), pointer(b), out.as_mut_ptr().cast());
        let code = ccdContacts(
            a,
            b,
            &ccd,
            &normal,
            slop,
            std::ptr::null_mut(),
            room,
            MOST_CONTACTS as c_int,
        );
        let count = usize::try_from(code).unwrap_or(0).min(MOST_CONTACTS);
        (
            code,
            out[..count]
                .iter()
                .map(|c| c.assume_init().into())
                .collect(),
        )
    }
}

/// Coordinates where ties, coincidences and tiny differences are common.
fn coordinate() -> impl Strategy<Value = Real> {
    prop_oneof![
        4 => -1.0..(1.0 as Real),
        4 => (-2i8..=2).prop_map(|x| Real::from(x) / 2.0),
        1 => (-2i8..=2).prop_map(|x| Real::from(x) * 4.0 * EPSILON),
        1 => (-2i8..=2, -1.0..(1.0 as Real)).prop_map(|(x, y)| Real::from(x) / 2.0 + y * 1e-6),
    ]
}

fn position() -> impl Strategy<Value = [Real; 3]> {
    prop_oneof![
        3 => proptest::array::uniform3(coordinate()),
        1 => Just([0.0; 3]),
    ]
}

/// The hull of up to nine points, perhaps inflated.
fn convex() -> impl Strategy<Value = Object> {
    (
        proptest::collection::vec(proptest::array::uniform3(coordinate()), 1..10),
        prop_oneof![Just(0.0), 0.0..(1.0 as Real)],
        position(),
    )
        .prop_map(|(points, radius, position)| Object {
            points,
            radius,
            position,
            lie: None,
            calls: Cell::new(0),
            nonsense: Cell::new(false),
        })
}

/// Answers of any size, and none.
fn wild() -> impl Strategy<Value = Real> {
    prop_oneof![
        4 => coordinate(),
        2 => proptest::num::f64::ANY.prop_map(|x| x as Real),
        1 => (-30.0..30.0f64).prop_map(|x| (10f64.powf(x)) as Real),
    ]
}

fn list(of: impl Strategy<Value = Real>) -> impl Strategy<Value = Vec<[Real; 3]>> {
    proptest::collection::vec(proptest::array::uniform3(of), 1..12)
}

fn lying() -> impl Strategy<Value = Object> {
    let near_one =
        (-9.0..0.0f64, -1.0..1.0f64).prop_map(|(e, x)| (1.0 + 10f64.powf(e) * x) as Real);
    let lie = prop_oneof![
        4 => list(wild()).prop_map(Lie::Instead),
        2 => list(prop_oneof![4 => Just(0.0), 1 => wild()]).prop_map(Lie::Added),
        1 => list(wild()).prop_map(Lie::Times),
        1 => list(near_one).prop_map(Lie::Times),
        1 => Just(Lie::Opposite),
    ];
    (convex(), lie).prop_map(|(object, lie)| Object {
        lie: Some(lie),
        ..object
    })
}

fn tolerance() -> impl Strategy<Value = Real> {
    prop_oneof![Just(0.0), Just(1e-6), Just(1e-4), Just(1e-2)]
}

/// Cold, a guess, or any bytes at all.
fn start() -> impl Strategy<Value = Start> {
    let bytes = proptest::collection::vec(any::<u8>(), size_of::<ccd_warm_t>());
    prop_oneof![
        2 => Just(Start::Cold),
        1 => bytes.prop_map(Start::Bytes),
        1 => proptest::array::uniform3(coordinate()).prop_map(Start::Guess),
    ]
}

fn config() -> ProptestConfig {
    let mut config = ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = 5_000;
    }
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(1);
    }
    config
}

proptest! {
    #![proptest_config(config())]

    /// Hits are sound and their direction unit; the proven minimum is the least of all
    /// answers and its bound below every support value; verdicts agree unless the objects
    /// touch.
    #[test]
    fn answers_about_convex_objects_are_sound(
        a in convex(),
        b in convex(),
        tolerance in tolerance(),
        start in start(),
        dirs in proptest::collection::vec(proptest::array::uniform3(-1.0..(1.0 as Real)), 8),
    ) {
        let noise = 64.0 * EPSILON * (a.size() + b.size());
        let answers: Vec<_> = (0..ALONG)
            .map(|query| {
                a.calls.set(0);
                b.calls.set(0);
                ask(query, &a, &b, tolerance, &start)
            })
            .collect();
        let (minimum, proven) = (answers[MINIMUM].1, answers[MINIMUM].3);
        let is_hit = |code: c_int| code == CCD_HIT || code == CCD_LIMIT;
        a.calls.set(0);
        b.calls.set(0);
        for (query, &(code, depth, dir, _)) in answers.iter().enumerate() {
            prop_assert!(is_hit(code) || code == CCD_MISS, "query {query}: code {code}");
            if query == DISTANCE {
                // The same answer with a sign, and a limit says nothing of overlap.
                let h = support_value(&a, &b, &dir);
                prop_assert!((depth - h).abs() <= noise, "distance {}, h {h}", -depth);
                prop_assert!(
                    code == CCD_LIMIT || depth - answers[DISTANCE].3 <= tolerance + noise,
                    "distance {} to {}", -depth, -answers[DISTANCE].3
                );
            }
            if !is_hit(code) {
                // Whoever says hit is at most touching then.
                for (other, &(code, depth, ..)) in answers.iter().enumerate() {
                    prop_assert!(
                        !is_hit(code) || depth <= noise || other == 3 || other == INCREMENTAL || minimum <= noise,
                        "query {query} misses, query {other} hits {depth} deep"
                    );
                }
                continue;
            }
            let length = dot(&dir, &dir).sqrt();
            prop_assert!((length - 1.0).abs() <= 4.0 * EPSILON, "query {query}: {dir:?}");
            let value = support_value(&a, &b, &dir);
            prop_assert!(
                (depth - value.max(0.0)).abs() <= noise,
                "query {query}: depth {depth}, support value {value}"
            );
            if is_hit(answers[MINIMUM].0) {
                prop_assert!(
                    minimum <= depth + tolerance + noise,
                    "the minimum {minimum} is deeper than query {query}'s {depth}"
                );
                prop_assert!(
                    proven <= depth + noise,
                    "proven {proven}, query {query} has {depth}"
                );
            }
        }
        for dir in &dirs {
            let length = dot(dir, dir).sqrt();
            if length > 0.1 {
                let value = support_value(&a, &b, &dir.map(|x| x / length));
                let most = answers[DISTANCE].3;
                prop_assert!(most <= value + noise, "depth at least {most}, h({dir:?}) = {value}");
            }
        }
        if is_hit(answers[MINIMUM].0) {
            for dir in &dirs {
                let length = dot(dir, dir).sqrt();
                if length > 0.1 {
                    let value = support_value(&a, &b, &dir.map(|x| x / length));
                    prop_assert!(proven <= value + noise, "proven {proven}, h({dir:?}) = {value}");
                }
            }
            prop_assert!(proven >= 0.0 && proven <= minimum + noise);
        }
    }

    /// Contacts along any direction, overlapping or not: between the support planes and no
    /// more than the slop below them, the deepest first, and as many as were asked for.
    #[test]
    fn contacts_lie_between_the_support_planes(
        a in convex(),
        b in convex(),
        slop in tolerance(),
        dir in proptest::array::uniform3(-1.0..(1.0 as Real)),
    ) {
        let length = dot(&dir, &dir).sqrt();
        prop_assume!(length > 0.1);
        let n = dir.map(|x| x / length);
        let (high, low) = (dot(&n, &a.support(&n)), dot(&n, &b.support(&n.map(|x| -x))));
        let noise = 256.0 * EPSILON * (a.size() + b.size());
        a.calls.set(0);
        b.calls.set(0);
        let (count, contacts) = contacts(&a, &b, &dir, slop);
        prop_assert!((1..=MOST_CONTACTS as c_int).contains(&count), "{count}");
        prop_assert!(a.calls.get() <= 24 && b.calls.get() <= 24);
        for c in &contacts {
            let (one, two) = (dot(&n, &c.point1), dot(&n, &c.point2));
            prop_assert!((one - two - c.depth).abs() <= noise, "{c:?}");
            prop_assert!(one <= high + slop + noise && one >= high - slop - noise, "{c:?}: {high}");
            prop_assert!(two >= low - slop - noise && two <= low + slop + noise, "{c:?}: {low}");
            prop_assert!(c.depth <= contacts[0].depth + noise, "{contacts:?}");
        }
    }

    /// Objects that answer anything: each query ends, with a documented code, and what it
    /// claims is finite; there is no answer from points that are not, and nothing written without
    /// an answer.
    #[test]
    fn any_answers_end(
        a in prop_oneof![lying(), convex()],
        b in prop_oneof![lying(), convex()],
        tolerance in tolerance(),
        start in start(),
    ) {
        for query in 0..=ALONG {
            a.forget();
            b.forget();
            let (code, depth, dir, proven) = ask(query, &a, &b, tolerance, &start);
            let nonsense = a.nonsense.get() || b.nonsense.get();
            prop_assert!(!nonsense || code != CCD_HIT, "query {query}: a hit from no numbers");
            let (least, most) = if query >= 3 {
                (CCD_BAD_INPUT, CCD_LIMIT)
            } else {
                (CCD_NO_MEMORY, CCD_HIT)
            };
            prop_assert!((least..=most).contains(&code), "query {query}: code {code}");
            if query == DISTANCE {
                let told = code == CCD_HIT || code == CCD_LIMIT || code == CCD_MISS;
                prop_assert!(!told || depth.is_finite() && proven.is_finite() && proven <= depth);
                prop_assert!(code != CCD_HIT || depth > 0.0, "a hit {depth} deep");
                continue;
            }
            if code == CCD_HIT || code == CCD_LIMIT {
                prop_assert!(depth >= 0.0 && depth.is_finite(), "query {query}: depth {depth}");
                prop_assert!(proven >= 0.0 && proven.is_finite(), "query {query}: {proven}");
                let length = dot(&dir, &dir).sqrt();
                prop_assert!((length - 1.0).abs() <= 4.0 * EPSILON, "query {query}: {dir:?}");
            } else {
                prop_assert!(depth == 0.0 && dir == [0.0; 3], "query {query}: written");
            }
        }
        a.forget();
        b.forget();
        let [yes @ .., separated] = verdicts(&a, &b, tolerance, &start);
        prop_assert!(yes.iter().all(|code| (0..=1).contains(code)), "{yes:?}");
        prop_assert!((CCD_NO_MEMORY..=CCD_HIT).contains(&separated), "{separated}");
        a.forget();
        b.forget();
        let (count, contacts) = contacts(&a, &b, &[1.0, -2.0, 0.5], 1e-3);
        let most = MOST_CONTACTS as c_int;
        prop_assert!(count == CCD_BAD_INPUT || (1..=most).contains(&count), "{count}");
        prop_assert!(contacts.iter().all(|c| c.depth.is_finite()), "{contacts:?}");
    }
}
