// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Lists the methods under measurement in one table, and runs each as a closure over one pair.

use std::ffi::{c_int, c_uint, c_void};
use std::ptr::null_mut;

use ccd::internals::ffi::{
    CCD_LIMIT, CCD_WANT_POINTS, ccd_distance_t, ccd_penetration_t, ccd_t, ccd_vec3_t, ccd_warm_t,
};
use ccd::internals::{MinkowskiDifference, Settings, Until, Vec3, incremental};
use serde::{Deserialize, Serialize};

use super::libraries::{COLD, Libraries, function};
use super::scene::{Pair, Truth};

/// Interface of a method: the arguments of a library's call behind the two objects and their settings.
#[derive(Clone, Copy)]
pub enum Interface {
    /// None; the call returns 1 or 0.
    YesNo,
    /// Warm state; the call returns 1 or 0.
    YesNoWarm,
    /// Depth, direction, position, which may be NULL.
    Depth { has_pos: bool },
    /// Warm state, depth, direction, position, which may be NULL.
    DepthWarm { has_pos: bool },
    /// Warm state, wanted outputs, result.
    Full,
    /// The distance of pairs that overlap; of others the search ends as soon as they are known to be apart.
    Distance,
    /// W. Gao's algorithms as published.
    Gao(Until),
    /// Another solver, with a closure of its own.
    Peer,
    /// A peer compiled into the measuring program, whose instructions are then the solver's.
    PeerInside,
}

/// A row of the table of methods.
pub struct Entry {
    /// In tables and pictures; the first word that begins with ccd is the function of a library's call.
    pub name: &'static str,
    pub interface: Interface,
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

const fn entry(name: &'static str, interface: Interface) -> Entry {
    Entry { name, interface }
}

/// Every method.
const METHODS: [Entry; 21] = [
    entry("libccd ccdMPRPenetration", Interface::Depth { has_pos: true }),
    entry("libccd ccdGJKPenetration", Interface::Depth { has_pos: true }),
    entry("libccd ccdMPRIntersect", Interface::YesNo),
    entry("ccdMPRPenetration", Interface::Depth { has_pos: false }),
    entry("ccdMPRPenetration, pos", Interface::Depth { has_pos: true }),
    entry("ccdGJKPenetration", Interface::Depth { has_pos: false }),
    entry("ccdMPRPenetrationWarm", Interface::DepthWarm { has_pos: false }),
    entry("ccdIntersect", Interface::YesNoWarm),
    entry("ccdSignedDistance", Interface::Distance),
    entry("ccdPenetration", Interface::Full),
    entry("ccdPenetrationLocal", Interface::Full),
    entry("ccdPenetrationProven", Interface::Full),
    entry("Gao 2023, Algorithm 4/5", Interface::Gao(Until::Shortcut)),
    entry("Gao 2023, Algorithm 3", Interface::Gao(Until::Normal)),
    entry("Bullet EPA", Interface::Peer),
    entry("FCL EPA", Interface::Peer),
    entry("parry EPA", Interface::PeerInside),
    entry("MuJoCo 3 ccd", Interface::Peer),
    entry("Coal 3 EPA", Interface::Peer),
    entry("Jolt 5 EPA", Interface::Peer),
    entry("ccdMPRPenetrationWarm, pos", Interface::DepthWarm { has_pos: true }),
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
    let method = |&(name, start, tolerance): &(&str, Start, f64)| match Entry::find(name).interface {
        Interface::Gao(until) => Method::new(name, start, Some(tolerance), gao(libraries, until, start, tolerance)),
        _ => {
            let call = find_call(libraries, Entry::find(name));
            let settings = libraries.settings(Entry::find(name).is_ours(), tolerance);
            Method::new(name, start, Some(tolerance), run_call(libraries, call, start, settings))
        }
    };
    list.iter().map(method).collect()
}

type Object = *const c_void;
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

/// Finds the call of a row of the table.
fn find_call(libraries: &Libraries, entry: &Entry) -> Call {
    type YesNo = unsafe extern "C-unwind" fn(Object, Object, Ccd) -> c_int;
    type YesNoWarm = unsafe extern "C-unwind" fn(Object, Object, Ccd, Warm) -> c_int;
    type DepthWarm = unsafe extern "C-unwind" fn(Object, Object, Ccd, Warm, *mut f64, Point, Point) -> c_int;
    type Full = unsafe extern "C-unwind" fn(Object, Object, Ccd, Warm, c_uint, *mut ccd_penetration_t) -> c_int;
    type Distance =
        unsafe extern "C-unwind" fn(Object, Object, Ccd, f64, f64, f64, Warm, c_uint, *mut ccd_distance_t) -> c_int;
    let library = if entry.is_ours() { libraries.ours } else { libraries.system };
    let symbol = entry.name.split([' ', ',']).find(|word| word.starts_with("ccd")).unwrap_or_default();
    // SAFETY: the table's interfaces are those of the C headers; queries over the callbacks' own shapes.
    unsafe {
        match entry.interface {
            Interface::YesNo => {
                let f: YesNo = function(library, symbol);
                Box::new(move |pair, ccd, _, _| f(pair.a, pair.b, ccd) - 1)
            }
            Interface::YesNoWarm => {
                let f: YesNoWarm = function(library, symbol);
                Box::new(move |pair, ccd, warm, _| f(pair.a, pair.b, ccd, warm) - 1)
            }
            Interface::Depth { has_pos } => depth_call(function(library, symbol), has_pos),
            Interface::DepthWarm { has_pos } => {
                let f: DepthWarm = function(library, symbol);
                Box::new(move |pair, ccd, warm, out| {
                    let pos = if has_pos { &raw mut out.pos } else { null_mut() };
                    f(pair.a, pair.b, ccd, warm, &mut out.depth, &mut out.dir, pos)
                })
            }
            Interface::Full => {
                let f: Full = function(library, symbol);
                Box::new(move |pair, ccd, warm, out| f(pair.a, pair.b, ccd, warm, CCD_WANT_POINTS, out))
            }
            Interface::Distance => {
                let f: Distance = function(library, symbol);
                Box::new(move |pair, ccd, warm, out| {
                    let mut distance = std::mem::zeroed();
                    let code = f(pair.a, pair.b, ccd, 0.0, 0.0, 0.0, warm, 0, &mut distance);
                    (out.depth, out.dir) = (-distance.distance, distance.normal);
                    code
                })
            }
            _ => panic!("{} is no library's call", entry.name),
        }
    }
}

/// Runs a library's call. Every guess is a fresh state, `Warm` one state a motion.
pub fn run_call(libraries: &Libraries, call: Call, start: Start, settings: ccd_t) -> Query<'static> {
    type WarmGuess = unsafe extern "C-unwind" fn(Warm, *const ccd_vec3_t);
    // SAFETY: the type is that of <ccd/warm.h>.
    let warm_guess: WarmGuess = unsafe { function(libraries.ours, "ccdWarmGuess") };
    let mut state = COLD;
    Box::new(move |pair| {
        if let Some(v) = start.guess(&pair.truth) {
            // SAFETY: a state and a direction.
            unsafe { warm_guess(&mut state, &ccd_vec3_t { v }) };
        } else if start != Start::Warm || pair.frame == 0 {
            state = COLD;
        }
        // SAFETY: numbers, to be filled.
        let mut out: ccd_penetration_t = unsafe { std::mem::zeroed() };
        let code = call(pair, &settings, &mut state, &mut out);
        // A hit; CCD_LIMIT has a sound result too.
        (code == 0 || code == CCD_LIMIT).then_some(Answer { depth: out.depth, dir: out.dir.v })
    })
}

/// Runs the paper's algorithms, which match the published implementation but return the portal's normal.
fn gao(libraries: &Libraries, until: Until, start: Start, tolerance: f64) -> Query<'static> {
    let settings = Settings { max_iterations: 10_000, ..Settings::new(tolerance) };
    let callbacks = libraries.callbacks;
    let mut last = None;
    Box::new(move |pair| {
        let object = |shape| move |dir: &Vec3| Vec3::from(callbacks.support_point(shape, (*dir).into()));
        let md = MinkowskiDifference::new(object(pair.a), object(pair.b));
        let memory = if pair.frame == 0 { None } else { last };
        let from = start.guess(&pair.truth).map(Vec3::from).or(memory);
        let from = from.unwrap_or_else(|| pair.truth.cold.into());
        let found = incremental(&md, from, None, until, &settings, |_| ()).ok()?;
        last = Some(found.dir);
        Some(Answer { depth: found.depth, dir: found.dir.into() })
    })
}
