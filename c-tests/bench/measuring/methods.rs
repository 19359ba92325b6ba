// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The methods under measurement, each as a closure over one pair.

use std::ffi::c_void;
use std::ptr::null_mut;

use ccd::internals::ffi::{CCD_LIMIT, CCD_WANT_POINTS, ccd_penetration_t, ccd_t, ccd_vec3_t};
use ccd::internals::{MinkowskiDifference, Settings, Until, Vec3, incremental};

use super::libraries::{COLD, Classic, Libraries, Query, Truth, zeroed};
use super::scene::{Pair, Scene};

/// Answer of a query.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    pub depth: f64,
    /// The way obj2 moves.
    pub dir: [f64; 3],
}

/// Where a search starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// The method does not ask.
    None,
    /// A guess so many degrees off the true direction.
    Five,
    TwentyFive,
    FortyFive,
    /// The centre difference.
    Centres,
    /// The last frame's state.
    Warm,
}

impl Start {
    pub const GUESSES: [Start; 3] = [Start::Five, Start::TwentyFive, Start::FortyFive];

    pub fn name(self) -> &'static str {
        match self {
            Start::None => "",
            Start::Five => "5",
            Start::TwentyFive => "25",
            Start::FortyFive => "45",
            Start::Centres => "centres",
            Start::Warm => "warm",
        }
    }

    /// The start direction of a pair, where the pair knows it.
    pub fn direction(self, truth: &Truth) -> Option<[f64; 3]> {
        match self {
            Start::None | Start::Warm => None,
            Start::Five => Some(truth.init5),
            Start::TwentyFive => Some(truth.init25),
            Start::FortyFive => Some(truth.init45),
            Start::Centres => Some(truth.cold),
        }
    }
}

type Run<'a> = Box<dyn FnMut(&Scene, &Pair) -> Option<Answer> + 'a>;

pub struct Method<'a> {
    pub name: String,
    pub start: Start,
    /// As the method is given it; none where it is built in.
    pub tolerance: Option<f64>,
    /// A call of this library's interface.
    pub ours: bool,
    /// Compiled into the measuring program itself: callgrind counts what that spends for it.
    pub inside: bool,
    run: Run<'a>,
}

impl<'a> Method<'a> {
    pub fn new(name: &str, run: impl FnMut(&Scene, &Pair) -> Option<Answer> + 'a) -> Self {
        Self {
            name: name.to_owned(),
            start: Start::None,
            tolerance: None,
            ours: false,
            inside: false,
            run: Box::new(run),
        }
    }

    pub fn from(mut self, start: Start) -> Self {
        self.start = start;
        self
    }

    pub fn within(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    pub fn of_ours(mut self) -> Self {
        self.ours = true;
        self
    }

    pub fn of_this_program(mut self) -> Self {
        self.inside = true;
        self
    }

    pub fn is_warm(&self) -> bool {
        self.start == Start::Warm
    }

    #[inline]
    pub fn query(&mut self, scene: &Scene, pair: &Pair) -> Option<Answer> {
        (self.run)(scene, pair)
    }
}

/// A call of libccd's, without its position where it need not have one: `pos` of this library is
/// charted beside libccd's by the recorded contacts and the worlds.
pub fn classic(query: Query, settings: ccd_t, needs_pos: bool) -> impl FnMut(&Scene, &Pair) -> Option<Answer> {
    move |_, pair| {
        let (mut depth, mut dir, mut pos) = (0.0, ccd_vec3_t::default(), ccd_vec3_t::default());
        let pos = if needs_pos { &raw mut pos } else { null_mut() };
        // SAFETY: a query of <ccd/ccd.h> over the callbacks' own shapes.
        let code = unsafe { query(pair.a, pair.b, &settings, &mut depth, &mut dir, pos) };
        let dir = dir.v;
        (code == 0).then_some(Answer { depth, dir })
    }
}

/// Yes or no by MPR; the answer's numbers say nothing.
fn intersect(of: &Classic, settings: ccd_t) -> impl FnMut(&Scene, &Pair) -> Option<Answer> {
    let query = of.mpr_intersect;
    move |_, pair| {
        // SAFETY: a query of <ccd/ccd.h> over the callbacks' own shapes.
        let yes = unsafe { query(pair.a, pair.b, &settings) };
        (yes == 1).then(Answer::default)
    }
}

/// A call of the system's libccd, of this library, or the paper's method from inside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    SystemMpr,
    SystemEpa,
    SystemIntersect,
    Mpr,
    Gjk,
    Intersect,
    MprWarm,
    IntersectWarm,
    Local,
    Minimum,
    /// `ccdPenetration`, with witness points.
    Penetration,
    /// Algorithms 4 and 5, without later improvements.
    Paper,
    /// Algorithm 3: without the shortcut.
    PaperBare,
}

/// One query of these, from where it starts.
pub fn of<'a>(libraries: &'a Libraries, ask: Ask, start: Start, tolerance: f64) -> Method<'a> {
    let (system, ours) = (&libraries.system, &libraries.ours);
    let settings = |of: &Classic| of.settings(&libraries.callbacks, tolerance);
    let theirs = |query| classic(query, settings(system), true);
    let here = |query| classic(query, settings(ours), false);
    let extension = || extension(libraries, ask, start, settings(ours));
    let paper = |until| paper(libraries, until, start, tolerance);
    let method = match ask {
        Ask::SystemMpr => Method::new("libccd MPR", theirs(system.mpr)),
        Ask::SystemEpa => Method::new("libccd EPA", theirs(system.gjk)),
        Ask::SystemIntersect => Method::new("libccd MPR intersect", intersect(system, settings(system))),
        Ask::Mpr => Method::new("MPR", here(ours.mpr)).of_ours(),
        Ask::Gjk => Method::new("GJK", here(ours.gjk)).of_ours(),
        Ask::Intersect => Method::new("MPR intersect", intersect(ours, settings(ours))).of_ours(),
        Ask::MprWarm => Method::new("MPR warm", extension()).of_ours(),
        Ask::IntersectWarm => Method::new("MPR intersect", extension()).of_ours(),
        Ask::Local => Method::new("local", extension()).of_ours(),
        Ask::Minimum => Method::new("minimum", extension()).of_ours(),
        Ask::Penetration => Method::new("penetration", extension()).of_ours(),
        Ask::Paper => Method::new("Algorithm 4/5", paper(Until::Shortcut)),
        Ask::PaperBare => Method::new("Algorithm 3", paper(Until::Normal)),
    };
    method.from(start).within(tolerance)
}

/// A query of the extension. Guesses are a fresh state each, `Warm` one state a
/// motion, `Centres` a zero state.
fn extension<'a>(
    libraries: &'a Libraries,
    ask: Ask,
    start: Start,
    settings: ccd_t,
) -> impl FnMut(&Scene, &Pair) -> Option<Answer> + 'a {
    let calls = libraries.extension;
    let mut state = COLD;
    move |_, pair| {
        if let Some(guess) = start.direction(&pair.truth).filter(|_| start != Start::Centres) {
            let guess = ccd_vec3_t { v: guess };
            // SAFETY: a state and a direction.
            unsafe { (calls.guess)(&mut state, &guess) };
        } else if start != Start::Warm || pair.frame == 0 {
            state = COLD;
        }
        // SAFETY: numbers.
        let mut out: ccd_penetration_t = unsafe { zeroed() };
        let (a, b, ccd, warm) = (pair.a, pair.b, &settings, &mut state);
        // SAFETY: queries of <ccd/warm.h> over the callbacks' own shapes.
        let code = unsafe {
            match ask {
                Ask::Local => (calls.local)(a, b, ccd, warm, CCD_WANT_POINTS, &mut out),
                Ask::Penetration => (calls.penetration)(a, b, ccd, warm, CCD_WANT_POINTS, &mut out),
                Ask::Minimum => (calls.minimum)(a, b, ccd, warm, CCD_WANT_POINTS, &mut out),
                // 1 is yes, 0 no.
                Ask::IntersectWarm => (calls.mpr_intersect)(a, b, ccd, warm) - 1,
                _ => (calls.mpr)(a, b, ccd, warm, &mut out.depth, &mut out.dir, null_mut()),
            }
        };
        // CCD_HIT, or CCD_LIMIT: the best sound answer at the cap.
        (code == 0 || code == CCD_LIMIT).then_some(Answer { depth: out.depth, dir: out.dir.v })
    }
}

/// It falls short of the published implementation in nothing, but answers with the portal's normal.
fn paper<'a>(
    libraries: &'a Libraries,
    until: Until,
    start: Start,
    tolerance: f64,
) -> impl FnMut(&Scene, &Pair) -> Option<Answer> + 'a {
    let settings = Settings { tolerance, max_iterations: 10_000 };
    let support = libraries.callbacks.support;
    let mut last = None;
    move |_, pair| {
        let object = |shape: *mut c_void| {
            move |dir: &Vec3| {
                let (dir, mut out) = (ccd_vec3_t::from(*dir), ccd_vec3_t::default());
                // SAFETY: a shape of the scene, a direction and room for a point.
                unsafe { support(shape, &dir, &mut out) };
                Vec3::from(out)
            }
        };
        let md = MinkowskiDifference::new(object(pair.a), object(pair.b));
        let memory = if pair.frame == 0 { None } else { last };
        let from = start.direction(&pair.truth).map(Vec3::from).or(memory);
        let from = from.unwrap_or_else(|| pair.truth.cold.into());
        let answer = incremental(&md, from, None, until, &settings, |_| ());
        let found = answer.ok()?;
        last = Some(found.dir);
        Some(Answer { depth: found.depth, dir: found.dir.into() })
    }
}
