// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Lists the methods under measurement in one table, and runs each as a closure over one pair.

use std::ffi::{c_int, c_uint, c_void};
use std::ptr::null_mut;

use serde::{Deserialize, Serialize};

use warmccd_bindings::libccd::{ccd_t, ccd_vec3_t};
use warmccd_bindings::warmccd::{CCD_LIMIT, CCD_WANT_POINTS, ccd_distance_t, ccd_penetration_t, ccd_warm_t};

use super::libraries::{COLD, Libraries};
use super::scene::{Pair, Truth};

/// Where a method's solver is.
#[derive(Clone, Copy)]
pub enum Place {
    /// In one of the two libraries.
    Library,
    /// Another solver, with a closure of its own.
    Peer,
    /// A peer compiled into the measuring program, whose instructions are then the solver's.
    PeerInside,
}

/// A row of the table of methods.
pub struct Entry {
    /// In tables and pictures; the first word that begins with ccd is the function of a library's call.
    pub name: &'static str,
    pub place: Place,
}

impl Entry {
    /// A call of this library's interface.
    pub fn is_ours(&self) -> bool {
        self.name.starts_with("ccd")
    }

    /// Returns the position of a method in the table.
    pub fn number(name: &str) -> usize {
        METHODS.iter().position(|entry| entry.name == name).unwrap_or_else(|| panic!("no method {name}"))
    }

    pub fn find(name: &str) -> &'static Entry {
        &METHODS[Entry::number(name)]
    }
}

const fn entry(name: &'static str, place: Place) -> Entry {
    Entry { name, place }
}

/// Every method.
const METHODS: [Entry; 25] = [
    entry("libccd ccdMPRPenetration", Place::Library),
    entry("libccd ccdGJKPenetration", Place::Library),
    entry("libccd ccdMPRIntersect", Place::Library),
    entry("ccdMPRPenetration", Place::Library),
    entry("ccdMPRPenetration, pos", Place::Library),
    entry("ccdGJKPenetration", Place::Library),
    entry("ccdMPRPenetrationWarm", Place::Library),
    entry("ccdIntersect", Place::Library),
    entry("ccdSignedDistance", Place::Library),
    entry("ccdPenetration", Place::Library),
    entry("ccdPenetrationLocal", Place::Library),
    entry("ccdPenetrationProven", Place::Library),
    entry("ccdPenetrationIncremental", Place::Library),
    entry("Algorithm 4/5", Place::PeerInside),
    entry("Algorithm 4/5, new portals", Place::PeerInside),
    entry("Algorithm 3", Place::PeerInside),
    entry("DEEP", Place::PeerInside),
    entry("Bullet EPA", Place::Peer),
    entry("FCL EPA", Place::Peer),
    entry("parry EPA", Place::PeerInside),
    entry("MuJoCo 3 ccd", Place::Peer),
    entry("Coal 3 EPA", Place::Peer),
    entry("Jolt 5 EPA", Place::Peer),
    entry("ccdMPRPenetrationWarm, pos", Place::Library),
    entry("ccdMPRIntersect", Place::Library),
];

/// Start of a search; in files the degrees by which a guess is off the true direction, `cold` or `warm`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Start {
    /// The method has none.
    #[default]
    #[serde(rename = "")]
    None,
    #[serde(rename = "5")]
    Guess5,
    #[serde(rename = "25")]
    Guess25,
    #[serde(rename = "45")]
    Guess45,
    /// A state that is cold.
    #[serde(rename = "cold")]
    Cold,
    /// The state of the frame before.
    #[serde(rename = "warm")]
    Warm,
}

impl Start {
    /// Returns the guess, if the search starts from one.
    pub fn guess(self, truth: &Truth) -> Option<[f64; 3]> {
        match self {
            Start::Guess5 => Some(truth.init5),
            Start::Guess25 => Some(truth.init25),
            Start::Guess45 => Some(truth.init45),
            Start::None | Start::Cold | Start::Warm => None,
        }
    }
}

/// Result of a query.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    pub depth: f64,
    /// The direction in which obj2 moves.
    pub dir: [f64; 3],
}

/// A query of a method; warm ones expect the pairs of a motion in order.
pub type Query<'a> = Box<dyn FnMut(&Pair) -> Option<Answer> + 'a>;

/// A method with its start and tolerance.
pub struct Method<'a> {
    pub entry: &'static Entry,
    pub start: Start,
    /// None if it is built in.
    pub tolerance: Option<f64>,
    pub query: Query<'a>,
}

impl<'a> Method<'a> {
    pub fn new(name: &str, start: Start, tolerance: Option<f64>, query: Query<'a>) -> Self {
        Self { entry: Entry::find(name), start, tolerance, query }
    }

    pub fn is_warm(&self) -> bool {
        self.start == Start::Warm
    }

    /// Whether a pair is measured: the first frame of a motion has no memory yet.
    pub fn is_measured(&self, pair: &Pair) -> bool {
        !(self.is_warm() && pair.frame == 0)
    }
}

/// Returns methods of the table that are inside the two libraries, by name, start and tolerance.
pub fn select<'a>(libraries: &'a Libraries, list: &[(&str, Start, f64)]) -> Vec<Method<'a>> {
    let method = |&(name, start, tolerance): &(&str, Start, f64)| {
        let call = find_call(libraries, Entry::find(name));
        let settings = libraries.settings(Entry::find(name).is_ours(), tolerance);
        Method::new(name, start, Some(tolerance), run_call(libraries.ours.ccdWarmGuess, call, start, settings))
    };
    list.iter().map(method).collect()
}

pub type Object = *const c_void;
type Ccd = *const ccd_t;
type Point = *mut ccd_vec3_t;
type Warm = *mut ccd_warm_t;

/// The type of `ccdMPRPenetration`.
pub type Depth = unsafe extern "C-unwind" fn(Object, Object, Ccd, *mut f64, Point, Point) -> c_int;

/// A library's call, whatever its interface.
pub type Call = Box<dyn Fn(&Pair, &ccd_t, &mut ccd_warm_t, &mut ccd_penetration_t) -> c_int>;

/// Returns a call with the interface of `ccdMPRPenetration`.
pub fn depth_call(f: Depth, has_pos: bool) -> Call {
    Box::new(move |pair, ccd, _, out| {
        let pos = if has_pos { &raw mut out.pos } else { null_mut() };
        // SAFETY: a query over the callbacks' own shapes.
        unsafe { f(pair.a, pair.b, ccd, &mut out.depth, &mut out.dir, pos) }
    })
}

/// Returns a call that tells whether objects overlap: 1 or 0.
fn yes_no_call(f: unsafe extern "C-unwind" fn(Object, Object, Ccd) -> c_int) -> Call {
    // SAFETY: a query over the callbacks' own shapes.
    Box::new(move |pair, ccd, _, _| unsafe { f(pair.a, pair.b, ccd) } - 1)
}

/// The type of `ccdPenetration`.
pub type Full = unsafe extern "C-unwind" fn(Object, Object, Ccd, Warm, c_uint, *mut ccd_penetration_t) -> c_int;

/// Returns a call with the interface of `ccdPenetration`.
pub fn full_call(f: Full) -> Call {
    // SAFETY: a query over the callbacks' own shapes.
    Box::new(move |pair, ccd, warm, out| unsafe { f(pair.a, pair.b, ccd, warm, CCD_WANT_POINTS, out) })
}

/// Finds the call of a row of the table.
fn find_call(libraries: &Libraries, entry: &Entry) -> Call {
    let Libraries { system, ours, .. } = *libraries;
    match entry.name {
        "libccd ccdMPRPenetration" => depth_call(system.ccdMPRPenetration, true),
        "libccd ccdGJKPenetration" => depth_call(system.ccdGJKPenetration, true),
        "libccd ccdMPRIntersect" => yes_no_call(system.ccdMPRIntersect),
        "ccdMPRIntersect" => yes_no_call(ours.ccdMPRIntersect),
        "ccdMPRPenetration" => depth_call(ours.ccdMPRPenetration, false),
        "ccdMPRPenetration, pos" => depth_call(ours.ccdMPRPenetration, true),
        "ccdGJKPenetration" => depth_call(ours.ccdGJKPenetration, false),
        "ccdPenetration" => full_call(ours.ccdPenetration),
        "ccdPenetrationLocal" => full_call(ours.ccdPenetrationLocal),
        "ccdPenetrationProven" => full_call(ours.ccdPenetrationProven),
        "ccdPenetrationIncremental" => full_call(ours.ccdPenetrationIncremental),
        // SAFETY, here and below: a query over the callbacks' own shapes.
        "ccdMPRPenetrationWarm" => Box::new(|pair, ccd, warm, out| unsafe {
            ours.ccdMPRPenetrationWarm(pair.a, pair.b, ccd, warm, &mut out.depth, &mut out.dir, null_mut())
        }),
        "ccdMPRPenetrationWarm, pos" => Box::new(|pair, ccd, warm, out| unsafe {
            ours.ccdMPRPenetrationWarm(pair.a, pair.b, ccd, warm, &mut out.depth, &mut out.dir, &mut out.pos)
        }),
        "ccdIntersect" => Box::new(|pair, ccd, warm, _| unsafe { ours.ccdIntersect(pair.a, pair.b, ccd, warm) } - 1),
        // Of pairs that do not overlap the search ends as soon as they are known to be apart.
        "ccdSignedDistance" => Box::new(|pair, ccd, warm, out| unsafe {
            let mut distance: ccd_distance_t = std::mem::zeroed();
            let code = ours.ccdSignedDistance(pair.a, pair.b, ccd, 0.0, 0.0, 0.0, warm, 0, &mut distance);
            (out.depth, out.dir) = (-distance.distance, distance.normal);
            code
        }),
        name => panic!("{name} is no library's call"),
    }
}

/// The type of `ccdWarmGuess`.
pub type Guess = unsafe extern "C-unwind" fn(Warm, *const ccd_vec3_t);

/// Runs a library's call. Every guess is a fresh state, which `guess` makes, `Warm` one state a motion.
pub fn run_call(guess: Guess, call: Call, start: Start, settings: ccd_t) -> Query<'static> {
    let mut state = COLD;
    Box::new(move |pair| {
        if let Some(v) = start.guess(&pair.truth) {
            // SAFETY: a state and a direction.
            unsafe { guess(&mut state, &ccd_vec3_t { v }) };
        } else if start != Start::Warm || pair.frame == 0 {
            state = COLD;
        }
        // SAFETY: numbers, to be filled.
        let mut out: ccd_penetration_t = unsafe { std::mem::zeroed() };
        let code = call(pair, &settings, &mut state, &mut out);
        // A hit; CCD_LIMIT has a sound result too.
        (code == 0 || code == CCD_LIMIT as c_int).then_some(Answer { depth: out.depth, dir: out.dir.v })
    })
}
