// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Queries with memory: what one query of a pair leaves behind for the next
//! (paper, Sec. III-D), and the order of steps that all of them share.
//!
//! 1. A pair that was apart is asked about the direction that separated it: while
//!    that still separates, one support point is the whole answer, and turns the
//!    direction for the next time.
//! 2. The solver starts from what the state holds, else from the centres, else from
//!    the caller's first direction.
//! 3. An overlap is proven. A local minimum of the support function can be positive
//!    though the objects are apart (a plate that an object has passed through, seen
//!    from the old side), so the origin must be shown to lie among points of D:
//!    [`gjk::intersect`] on the points the solver saw, the centres' difference among
//!    them, asks for more only where these leave a side open.
//!
//! 4. Witness points of a face that rests on another, or on an edge, are moved to the
//!    middle of where they touch ([`patch`]).
//!
//! Nothing in a state is trusted: it chooses where to look first, never what is true.

use crate::bundle::{self, Memory};
use crate::contact::{Answer, Penetration, Settings};
use crate::expansion::Limits;
use crate::gjk::{self, Overlap};
use crate::global::{self, Arena, Basis, Request};
use crate::local::{self, Shortcut};
use crate::math::{ITERATION_CAP, Real, Vec3, perpendicular, unit};
use crate::patch;
use crate::planar;
use crate::portal::{self, Exit, Found, Measure, Plane, Portal, rounding};
use crate::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};

/// [`State::padding`] of a pair that rested face on face.
const RESTED: u32 = 1;

/// What a query leaves behind. All zero is cold; any other bits are harmless.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct State {
    /// What the solvers remember. In a pair that was apart `dir` separated it, and its
    /// length, metres, is the margin to aim at; after a query along a direction `slopes` are the directions of the last portal.
    pub memory: Memory,
    /// One of the constants below; anything else is cold.
    pub kind: u32,
    /// Fills the last word, always 0.
    pub padding: u32,
}

/// The pair was apart.
const APART: u32 = 1;
/// The pair overlapped.
const OVERLAP: u32 = 2;
/// The pair overlapped, and was asked about along a direction.
const ALONG: u32 = 3;
/// The pair overlapped, and its minimum was proven: `slopes` are the directions of the
/// points that the proof stands on, besides the minimum's own.
const PROVEN: u32 = 4;
/// The pair overlapped, and was asked yes or no.
const SURROUNDED: u32 = 5;

impl State {
    /// A fresh state that starts from `dir`; cold when it is zero or not finite.
    pub fn guess(dir: &Vec3) -> Self {
        match unit(dir) {
            Some(n) => Self::of(OVERLAP, n),
            None => Self::default(),
        }
    }

    /// The state of a pair becomes that of the same objects in the other order, whose D is
    /// this one's mirror image in the origin: points, directions and slopes change sign,
    /// lengths and curvatures stay.
    pub fn flip(&mut self) {
        for v in self.memory.slopes.iter_mut().chain([&mut self.memory.dir]) {
            // Not -v: a cold state is one of plain zeros.
            *v = Vec3::zeros() - *v;
        }
    }

    fn overlap(memory: Memory) -> Self {
        Self {
            memory,
            kind: OVERLAP,
            padding: 0,
        }
    }

    fn of(kind: u32, dir: Vec3) -> Self {
        Self {
            memory: Memory {
                dir,
                ..Memory::default()
            },
            kind,
            padding: 0,
        }
    }

    /// The pair is apart: the length of `dir`, metres, is the margin to aim at.
    pub fn apart(dir: Vec3) -> Self {
        Self::of(APART, dir)
    }

    /// [`State::apart`], with the directions of up to three support points around the nearest
    /// one (zero for none), and the radius of a ball that rounds D there, metres.
    pub fn near(dir: Vec3, directions: [Vec3; 3], ball: Real) -> Self {
        let mut state = Self::apart(dir);
        state.memory.slopes = directions;
        state.memory.curvature[0] = ball;
        state
    }

    /// What [`State::near`] left.
    pub fn nearest(&self) -> ([Vec3; 3], Real) {
        match self.kind {
            APART => (self.memory.slopes, self.memory.curvature[0]),
            _ => ([Vec3::zeros(); 3], 0.0),
        }
    }

    /// The margin to aim at, metres, where the pair was apart.
    pub fn aim(&self) -> Real {
        self.memory.dir.norm()
    }

    /// Did the pair overlap when its depth was asked?
    pub fn overlapped(&self) -> bool {
        matches!(self.kind, OVERLAP | ALONG)
    }

    /// The pair overlaps: support points along these directions surround the origin. Zero
    /// for none.
    pub fn surrounded([a, b, c, d]: [Vec3; 4]) -> Self {
        let mut state = Self::of(SURROUNDED, a);
        state.memory.slopes = [b, c, d];
        state
    }

    /// The directions of [`State::surrounded`], where the pair was.
    pub fn surrounding(&self) -> [Vec3; 4] {
        let [b, c, d] = self.memory.slopes;
        match self.kind {
            SURROUNDED => [self.memory.dir, b, c, d],
            _ => [Vec3::zeros(); 4],
        }
    }

    /// The direction that separated the pair.
    pub fn separating(&self) -> Option<Vec3> {
        match self.kind {
            APART => unit(&self.memory.dir),
            _ => None,
        }
    }

    /// The direction in which obj2 left last time, or is guessed to leave. A pair that
    /// was apart and is no longer has just met there.
    fn leaving(&self) -> Option<Vec3> {
        match self.kind {
            APART | OVERLAP | ALONG | PROVEN => unit(&self.memory.dir),
            _ => None,
        }
    }

    /// What the local solver starts from.
    fn solver(&self) -> Memory {
        match self.kind {
            OVERLAP => self.memory,
            APART | ALONG | PROVEN => Self::of(OVERLAP, self.memory.dir).memory,
            _ => Memory::default(),
        }
    }

    /// The directions of the last portal.
    fn portal(&self) -> Option<[Vec3; 3]> {
        let [a, b, c] = &self.memory.slopes;
        match self.kind {
            ALONG => Some([unit(a)?, unit(b)?, unit(c)?]),
            _ => None,
        }
    }

    /// The directions that a proof starts from: `first`, and those of the last one.
    fn basis(&self, first: Vec3) -> Basis {
        let mut basis = Basis::default();
        basis.add(&first);
        if self.kind == PROVEN {
            for slope in &self.memory.slopes {
                if let Some(n) = unit(slope) {
                    basis.add(&n);
                }
            }
        }
        basis
    }

    fn proven(basis: &Basis) -> Self {
        let mut state = Self::default();
        if let Some((first, others)) = basis.directions().split_first() {
            state = Self::of(PROVEN, *first);
            for (slope, n) in state.memory.slopes.iter_mut().zip(others) {
                *slope = *n;
            }
        }
        state
    }

    /// The kind of the answer and its direction; a query without an answer leaves
    /// the state alone.
    fn remember(&mut self, answer: &Answer) {
        match answer {
            Answer::Miss(n) => *self = Self::of(APART, *n),
            Answer::Hit(hit) | Answer::Limit(hit) => *self = Self::of(OVERLAP, hit.normal),
            Answer::Undecided(_) => {}
        }
    }
}

/// A touch, within the tolerance, whose witness points do not meet? There the points that
/// meet at the origin of D, which a proof of the overlap knows, are witnesses.
fn unmet(hit: &Penetration, settings: &Settings) -> bool {
    let apart = (hit.point1 - hit.point2 - hit.dir * hit.depth).norm();
    hit.depth <= settings.tolerance && apart > settings.tolerance
}

/// Directions tried before a pair that was apart is asked about anew.
const TRIES: u32 = 2;
/// What a margin that was reached once is still worth at the next query.
const KEEP: Real = 0.95;
/// A share of the aim below which the separating direction is turned.
const ENOUGH: Real = 0.7;

/// A pair and what the caller knows of it besides the state.
pub struct Pair<A, B> {
    /// The Minkowski difference.
    pub md: MinkowskiDifference<A, B>,
    /// The difference of the centres, where the caller gives them.
    pub centre: Option<SupportPoint>,
    /// The caller's first direction, where it gives one.
    pub first_dir: Option<Vec3>,
    /// Whether the caller keeps the state: then a separating direction is worth a few
    /// support points more.
    pub lasting: bool,
}

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Step 1: the separating direction that still separates.
    ///
    /// The support point that shows it also tells how to turn the direction for the next
    /// time: h is to fall to -aim, its gradient is the tangential part g of s, and the
    /// step -g (h + aim) / g² is Polyak's. A pair whose contact turns is followed so, at
    /// one support point a query.
    fn still_apart(&self, state: &mut State) -> Result<Option<Vec3>, Fault> {
        let Some(mut n) = state.separating() else {
            return Ok(None);
        };
        let mut aim = state.memory.dir.norm();
        for _ in 0..TRIES {
            let s = self.md.support(&n)?.v;
            let margin = -n.dot(&s);
            aim = margin.max(KEEP * aim);
            let mut next = n;
            if margin < ENOUGH * aim {
                let g = s + n * margin;
                next = unit(&(n - g * ((aim - margin) / g.norm_squared()))).unwrap_or(n);
            }
            if margin > 0.0 {
                state.memory.dir = next * aim;
                return Ok(Some(n));
            }
            n = next;
        }
        Ok(None)
    }

    /// Leaves the answer behind for the next query.
    fn remember(&self, state: &mut State, answer: &Answer) -> Result<(), Fault> {
        match answer {
            Answer::Miss(n) if self.lasting => {
                let (n, margin) = gjk::widen(&self.md, *n)?;
                *state = State::of(APART, n * margin);
            }
            other => state.remember(other),
        }
        Ok(())
    }

    /// The way from the centre of D through the origin, or the caller's first
    /// direction, or any.
    pub fn cold_start(&self) -> Vec3 {
        let from_centre = self.centre.and_then(|c| unit(&-c.v));
        from_centre
            .or_else(|| self.first_dir.and_then(|d| unit(&d)))
            .unwrap_or(Vec3::x())
    }

    /// Step 3: the answer of a solver, with the overlap proven or refuted. `known` gains
    /// the points of the proof.
    fn proven(
        &self,
        hit: Penetration,
        limit: bool,
        known: &mut Known,
        settings: &Settings,
    ) -> Result<Answer, Fault> {
        let start = match (self.centre, known.points().first()) {
            (Some(c), _) => c,
            (None, Some(k)) => *k,
            (None, None) => self.md.support(&hit.normal)?,
        };
        // The proof has a budget of its own: a search cut short must still know
        // whether it has an answer.
        let overlap = gjk::intersect(
            &self.md,
            start,
            known.points(),
            Some(&(hit.normal * hit.depth)),
            settings.max_iterations,
        )?;
        Ok(match overlap {
            Overlap::Yes(simplex, inner) => {
                for p in simplex.points() {
                    known.add(p);
                }
                let mut hit = Penetration {
                    depth_lower: inner.min(hit.depth),
                    ..hit
                };
                if unmet(&hit, settings) {
                    (hit.point1, hit.point2) = simplex.witnesses();
                }
                if limit {
                    Answer::Limit(hit)
                } else {
                    Answer::Hit(hit)
                }
            }
            Overlap::No(n) => Answer::Miss(n),
            Overlap::Undecided => Answer::Undecided(hit),
        })
    }

    /// Step 4: the witness points of two faces that touch in the middle of where they do.
    pub fn settle(&self, answer: Answer, settings: &Settings) -> Result<Answer, Fault> {
        match answer {
            Answer::Hit(mut hit) => {
                patch::settle(&self.md, &mut hit, settings.tolerance)?;
                Ok(Answer::Hit(hit))
            }
            other => Ok(other),
        }
    }

    /// A local minimum of the depth.
    pub fn local(&self, state: &mut State, settings: &Settings) -> Result<Answer, Fault> {
        let answer = self.local_known(state, settings, &mut Known::default())?;
        self.settle(answer, settings)
    }

    /// [`Pair::local`], and the points it came to know.
    fn local_known(
        &self,
        state: &mut State,
        settings: &Settings,
        known: &mut Known,
    ) -> Result<Answer, Fault> {
        if let Some(n) = self.still_apart(state)? {
            return Ok(Answer::Miss(n));
        }
        let mut memory = state.solver();
        let answer = match self.descend(&mut memory, settings, known)? {
            Answer::Hit(hit) => self.proven(hit, false, known, settings)?,
            Answer::Limit(hit) => self.proven(hit, true, known, settings)?,
            other => other,
        };
        match answer {
            Answer::Hit(_) | Answer::Limit(_) => *state = State::overlap(memory),
            other => self.remember(state, &other)?,
        }
        Ok(answer)
    }

    /// A local minimum of the depth by the paper's method, shortcut on (Algorithms 4, 5): from
    /// the last direction, else from the centres.
    pub fn incremental(&self, state: &mut State, settings: &Settings) -> Result<Answer, Fault> {
        if let Some(n) = self.still_apart(state)? {
            return Ok(Answer::Miss(n));
        }
        let start = state.leaving().unwrap_or_else(|| self.cold_start());
        let found = local::penetration(&self.md, start, Shortcut::Always, settings, |_| ())?;
        let answer = match found {
            Answer::Hit(hit) => self.proven(hit, false, &mut Known::default(), settings)?,
            Answer::Limit(hit) => self.proven(hit, true, &mut Known::default(), settings)?,
            other => other,
        };
        self.remember(state, &answer)?;
        self.settle(answer, settings)
    }

    /// The minimum depth at MPR's price: within the tolerance or a thousandth of the depth,
    /// in at most [`MPR_SUPPORTS`] support points; trusts the centre.
    pub fn mpr(
        &self,
        state: &mut State,
        settings: &Settings,
        placed: bool,
    ) -> Result<Answer, Fault> {
        let limits = Limits {
            tolerance: settings.tolerance,
            gap: GAP,
            supports: MPR_SUPPORTS,
            iterations: settings.max_iterations,
        };
        self.global(self.centre, state, limits, None, placed)
    }

    /// The global minimum of the depth, proven by support points alone: from the state,
    /// else from the centres, else from the first direction.
    pub fn minimum(
        &self,
        state: &mut State,
        settings: &Settings,
        arena: &mut dyn Arena,
        placed: bool,
    ) -> Result<Answer, Fault> {
        let limits = Limits {
            tolerance: settings.tolerance,
            gap: 0.0,
            supports: MOST_SUPPORTS,
            iterations: settings.max_iterations,
        };
        self.global(None, state, limits, Some(arena), placed)
    }

    /// The global machine, from the state and with an apex that may be trusted.
    fn global(
        &self,
        apex: Option<SupportPoint>,
        state: &mut State,
        limits: Limits,
        arena: Option<&mut dyn Arena>,
        placed: bool,
    ) -> Result<Answer, Fault> {
        if let Some(n) = self.still_apart(state)? {
            return Ok(Answer::Miss(n));
        }
        let first = state.leaving().unwrap_or_else(|| self.cold_start());
        let known = state.basis(first);
        let request = Request {
            centre: apex,
            directions: known.directions(),
            limits,
            placed,
            rested: state.kind == PROVEN && state.padding == RESTED,
        };
        let mut basis = Basis::default();
        let kept = self.lasting.then_some(&mut basis);
        #[allow(clippy::needless_match, reason = "it shortens the lifetime")]
        let arena: Option<&mut dyn Arena> = match arena {
            Some(arena) => Some(arena),
            None => None,
        };
        let mut answer = global::minimum(&self.md, &request, arena, kept)?;
        match &mut answer {
            Answer::Hit(hit) => {
                let alone = hit.point1;
                patch::settle(&self.md, hit, limits.tolerance)?;
                self.keep(state, &basis, hit.point1 != alone);
            }
            Answer::Limit(hit) => {
                self.floor(hit, limits.tolerance)?;
                self.keep(state, &basis, false);
            }
            _ if self.lasting => self.remember(state, &answer)?,
            _ => {}
        }
        Ok(answer)
    }

    /// Leaves the basis of a proof behind, where somebody keeps the state.
    fn keep(&self, state: &mut State, basis: &Basis, rested: bool) {
        if self.lasting {
            *state = State::proven(basis);
            state.padding = u32::from(rested) * RESTED;
        }
    }

    /// Where minima form a curve or a surface no polytope proves them in the steps there
    /// are, and the least value it met need not be theirs to the tolerance. It is in the
    /// right valley, whose floor a local search finds: to a hundredth of the tolerance,
    /// since what falls so little over its first reach falls thirty times as much over the
    /// sphere.
    #[cold]
    #[inline(never)]
    fn floor(&self, hit: &mut Penetration, tolerance: Real) -> Result<(), Fault> {
        let level = Settings {
            tolerance: tolerance * 0.01,
            max_iterations: ITERATION_CAP,
        };
        let mut memory = State::of(OVERLAP, hit.normal).memory;
        if let Answer::Hit(floor) | Answer::Limit(floor) =
            self.stroll(&mut memory, PATIENCE, &level, &mut Known::default())?
        {
            if floor.depth < hit.depth {
                *hit = Penetration {
                    depth_lower: hit.depth_lower.min(floor.depth),
                    iterations: hit.iterations + floor.iterations,
                    ..floor
                };
            }
        }
        Ok(())
    }

    /// A local minimum, not yet a proven overlap: the few-supports solver, and where that
    /// does not end in time the paper's method from there on.
    ///
    /// A search that tires goes on from the lowest place it saw with a fresh view, for as
    /// long as that leads down: the floor of a long valley bends away from any straight
    /// step. Where it does not, the search looks around from beside that place.
    fn descend(
        &self,
        memory: &mut Memory,
        settings: &Settings,
        known: &mut Known,
    ) -> Result<Answer, Fault> {
        let mut found = self.stroll(memory, PATIENCE, settings, known)?;
        let mut left = settings.max_iterations;
        let mut lowest: Option<Penetration> = None;
        let mut asides = 0;
        // Ends: `left` falls.
        let tired = loop {
            let (hit, ended) = match found {
                Answer::Hit(hit) => (hit, true),
                Answer::Limit(hit) => (hit, false),
                other => return Ok(other),
            };
            let before = lowest.map_or(Real::INFINITY, |low| low.depth);
            if ended && hit.depth <= before + settings.tolerance {
                return Ok(found);
            }
            let start = match lowest {
                Some(low) if ended || !(hit.depth <= before - settings.tolerance) => {
                    let Some(way) = WAYS.get(asides) else {
                        break low;
                    };
                    asides += 1;
                    beside(&low.normal, *way)
                }
                _ => {
                    lowest = Some(hit);
                    asides = 0;
                    hit.normal
                }
            };
            left = left.saturating_sub(PATIENCE);
            if left == 0 {
                return Ok(lowest.map_or(found, Answer::Limit));
            }
            *memory = State::guess(&start).memory;
            found = self.stroll(memory, PATIENCE.min(left), settings, known)?;
        };
        let rest = Settings {
            max_iterations: left,
            ..*settings
        };
        let answer = local::penetration(&self.md, tired.normal, Shortcut::Always, &rest, |_| ())?;
        match &answer {
            // D reaches beyond that plane: a callback that errs must not separate.
            Answer::Miss(n) if gjk::farthest(known.points(), n, 0.0).is_some() => return Ok(found),
            Answer::Hit(hit) | Answer::Limit(hit) => {
                *memory = State::of(OVERLAP, hit.normal).memory;
            }
            _ => {}
        }
        Ok(answer)
    }

    /// The few-supports solver, for as long as `patience`.
    fn stroll(
        &self,
        memory: &mut Memory,
        patience: u64,
        settings: &Settings,
        known: &mut Known,
    ) -> Result<Answer, Fault> {
        let first = Settings {
            max_iterations: settings.max_iterations.min(patience),
            ..*settings
        };
        bundle::penetration(
            &self.md,
            self.centre.map(|c| c.v).as_ref(),
            &self.cold_start(),
            memory,
            &first,
            known,
        )
    }

    /// How far obj2 must move along the unit direction `dir` (Algorithm 1).
    pub fn along(
        &self,
        dir: Vec3,
        state: &mut State,
        settings: &Settings,
    ) -> Result<Answer, Fault> {
        if let Some(n) = self.still_apart(state)? {
            return Ok(Answer::Miss(n));
        }
        let mut budget = settings.max_iterations;
        let (exit, first) = self.along_ray(dir, state, settings, &mut budget)?;
        let itself = |plane: &Plane| (plane.normal, plane.depth, plane.point.v1, plane.point.v2);
        let (limit, portal, (normal, h, point1, point2)) = match &exit {
            Exit::Miss(n) => {
                let answer = Answer::Miss(*n);
                self.remember(state, &answer)?;
                return Ok(answer);
            }
            Exit::Converged(portal, plane) => {
                let (p1, p2) = portal.witnesses();
                (false, Some(portal), (plane.normal, plane.depth, p1, p2))
            }
            // The cap, or a portal without area: every support plane is sound, the one
            // that the ray meets first is the best of them.
            Exit::Limit(portal) => {
                let reach = |p: &Plane| p.depth / dir.dot(&p.normal);
                let mut best = first;
                for p in portal.iter().flat_map(|p| &p.planes) {
                    if dir.dot(&p.normal) > 0.0 && reach(p) < reach(&best) {
                        best = *p;
                    }
                }
                (true, portal.as_ref(), itself(&best))
            }
            Exit::Vertex | Exit::Touch | Exit::Shortcut(_) => (false, None, itself(&first)),
        };
        let depth = h / dir.dot(&normal);
        let hit = Penetration {
            depth,
            depth_lower: 0.0,
            dir,
            normal,
            point1,
            point2,
            width: 0.0,
            iterations: settings.max_iterations - budget,
        };
        let mut known = Known::default();
        for plane in portal.iter().flat_map(|p| &p.planes) {
            known.add(&plane.point);
        }
        let mut answer = self.proven(hit, limit, &mut known, settings)?;
        if let Answer::Hit(hit) | Answer::Limit(hit) = &mut answer {
            // The bound along dir: the portal is inscribed and the origin in D.
            let (lower, error) = match portal {
                Some(p) => {
                    let size = p
                        .planes
                        .iter()
                        .fold(0.0, |m: Real, plane| m.max(plane.point.magnitude()));
                    p.normal().map_or((0.0, 0.0), |n| {
                        let error = rounding(size) / n.dot(&dir);
                        (p.reach() - error, error)
                    })
                }
                None if matches!(exit, Exit::Vertex) => (depth, 0.0),
                None => (0.0, 0.0),
            };
            // max also drops NaN
            hit.depth_lower = lower.max(0.0).min(depth);
            // Where rounding ended the search the answer may yet be as good as asked for.
            if depth - hit.depth_lower <= settings.tolerance.max(2.0 * error) {
                answer = Answer::Hit(*hit);
            }
        }
        self.remember(state, &answer)?;
        if let (Some(p), Answer::Hit(_) | Answer::Limit(_)) = (portal, &answer) {
            state.kind = ALONG;
            state.memory.slopes = p.planes.map(|plane| plane.normal);
        }
        Ok(answer)
    }

    fn along_ray(
        &self,
        dir: Vec3,
        state: &State,
        settings: &Settings,
        budget: &mut u64,
    ) -> Result<(Exit, Plane), Fault> {
        let finish = |portal: Portal, best: &mut Plane, budget: &mut u64| {
            portal::refine(
                &self.md,
                portal,
                settings.tolerance,
                Measure::Ray,
                false,
                best,
                budget,
            )
        };
        // The last portal, found again by its three directions.
        if let Some([a, b, c]) = state.portal() {
            let planes = [
                Plane::of(&self.md, a)?,
                Plane::of(&self.md, b)?,
                Plane::of(&self.md, c)?,
            ];
            if let Some(out) = planes.iter().find(|p| p.depth < 0.0) {
                return Ok((Exit::Miss(out.normal), *out));
            }
            if let Some(portal) = Portal::of(dir, planes) {
                let mut best = planes[0];
                let exit = finish(portal, &mut best, budget)?;
                if matches!(exit, Exit::Converged(..) | Exit::Miss(_)) {
                    return Ok((exit, best));
                }
            }
        }
        let first = Plane::of(&self.md, dir)?;
        let mut best = first;
        let exit = match portal::find_portal(&self.md, &first, None, &mut best, budget)? {
            Found::Portal(portal) => finish(portal, &mut best, budget)?,
            Found::Vertex => Exit::Vertex,
            Found::Touch => Exit::Touch,
            Found::Miss(n) => Exit::Miss(n),
            Found::Limit => Exit::Limit(None),
        };
        Ok((exit, first))
    }

    /// A local minimum among the directions perpendicular to the unit vector `m`.
    pub fn planar(&self, m: Vec3, state: &mut State, settings: &Settings) -> Result<Answer, Fault> {
        if let Some(n) = self.still_apart(state)? {
            return Ok(Answer::Miss(n));
        }
        let start = state.leaving().unwrap_or_else(|| self.cold_start());
        let in_plane = |d: Vec3| unit(&(d - m * m.dot(&d)));
        let start = in_plane(start)
            .or_else(|| in_plane(Vec3::x()))
            .or_else(|| in_plane(Vec3::y()))
            .unwrap_or(Vec3::y());
        let answer = planar::penetration(&self.md, &m, start, settings)?;
        let answer = match answer {
            Answer::Hit(hit) => self.proven(hit, false, &mut Known::default(), settings)?,
            Answer::Limit(hit) => self.proven(hit, true, &mut Known::default(), settings)?,
            other => other,
        };
        self.remember(state, &answer)?;
        Ok(answer)
    }
}

/// Support points after which the few-supports solver has failed: it needs a dozen, on
/// the hardest pairs thirty.
const PATIENCE: u64 = 64;

/// Places beside the lowest one that a tired search looks from.
const ASIDES: usize = 4;

/// Cosine and sine of the ways there: the golden angle apart, never twice nearly the same
/// way. Written down, for the same bits in every build.
#[allow(clippy::excessive_precision)] // In single precision.
const WAYS: [[Real; 2]; ASIDES] = [
    [-0.7373937155412454, 0.675463180551151],
    [0.0874989834394464, -0.9961646088358407],
    [0.6083513145322552, 0.7936678638491527],
    [-0.984687855794127, -0.17432678122297965],
];

/// The unit vector `n` turned by a tenth of a radian, not normalised.
fn beside(n: &Vec3, [c, s]: [Real; 2]) -> Vec3 {
    let e1 = perpendicular(n);
    n + (e1 * c + n.cross(&e1) * s) * 0.1
}

/// Support points of an MPR query, at most.
const MPR_SUPPORTS: u64 = 160;
/// Of a proven minimum, which may take a local search more.
const MOST_SUPPORTS: u64 = 1_400;
/// Where an MPR query may stop: a gap of this share of the depth.
const GAP: Real = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, capsule, corners, hull, placed};

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-7 } else { 1e-4 },
        max_iterations: 1000,
    };

    /// What a query from this state costs and answers.
    fn ask<A: SupportMap, B: SupportMap>(a: A, b: B, mut state: State) -> (u64, Real, State) {
        let pair = Pair {
            md: MinkowskiDifference::new(a, b),
            centre: None,
            first_dir: None,
            lasting: true,
        };
        match pair.local(&mut state, &SETTINGS).unwrap() {
            Answer::Hit(hit) => (pair.md.supports(), hit.depth, state),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_flipped_state_serves_the_swapped_pair() {
        let mut r = Random::new(7);
        for _ in 0..100 {
            let points = placed(
                &corners(Vec3::new(0.5, 0.6, 0.7)),
                &r.rotation(),
                r.vector(0.2),
            );
            let (p, q) = (r.vector(0.5), r.vector(0.5));
            let (cube, rod) = (|| hull(&points), || capsule(p, q, 0.3));
            let start = State::guess(&r.direction());
            let (_, _, after) = ask(cube(), rod(), start);
            let (supports, depth, _) = ask(cube(), rod(), after);
            let mut flipped = after;
            flipped.flip();
            let (swapped_supports, swapped_depth, _) = ask(rod(), cube(), flipped);
            assert_eq!(supports, swapped_supports);
            assert!((depth - swapped_depth).abs() < 16.0 * EPSILON);
        }
    }

    #[test]
    fn flipped_twice_is_as_it_was() {
        let mut cold = State::default();
        cold.flip();
        assert!(cold.memory.dir.iter().all(|x| x.is_sign_positive()) && cold.kind == 0);
        let mut state = State::guess(&Vec3::new(1.0, -2.0, 3.0));
        let dir = state.memory.dir;
        state.flip();
        assert_eq!(state.memory.dir, -dir);
        state.flip();
        assert_eq!(state.memory.dir, dir);
    }
}
