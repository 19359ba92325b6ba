// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum of the depth from start to end.
//!
//! 1. The first direction. Where its support point separates, that is the answer.
//! 2. The apex, the points that the last query's proof stood on, and a portal, on which a shallow
//!    contact is mostly proven without a hull ([`crate::hull::shallow`]). The apex is a trusted centre,
//!    else the middle of the first support point and the opposite one.
//! 3. The first tetrahedron: that portal and the apex, or another of the [`WAYS`] ([`crate::hull::start`]).
//! 4. The expansion ([`crate::hull::expansion`]), in rooms that grow. Where it does not show the
//!    origin inside, 3 and 4 are tried again in the next way.
//! 5. The answer ([`Search::conclude`]).
//!
//! *Rooms.* Points and faces live in a small room on the stack that most queries never leave;
//! where it is full they move to larger ones, each in a stack frame of its own that is entered
//! only then, and at last to a block that the caller lends ([`Arena`]), if it does.

use crate::contact::Penetration;
use crate::contacts::pressure;
use crate::contacts::seen::Seen;
use crate::gjk::barycentric;
use crate::gjk::overlap;
use crate::hull::expansion::{self, End, Limits, Progress, expand};
use crate::hull::polytope::Polytope;
use crate::hull::shallow::{Handed, Try};
use crate::hull::start;
use crate::known::mark;
use crate::known::support_set::{Inquiry, Lowest, Stop, SupportSet, beside};
use crate::math::{Vec3, larger, unit};
use crate::minkowski::support::{Fault, SupportMap, SupportPoint};

/// Points and faces of the first room, 5 KB (double): enough for shallow contacts and most polytopes.
///
/// In each room, a closed surface of V points has 2V − 4 faces, and some are left over for a
/// fan, which is made before the faces that it replaces are freed.
pub const FIRST: (usize, usize) = (26, 48);
/// Of the second, 33 KB: enough for the 160 support points of an MPR query and for what known points make
/// besides. Measured (`campaigns -- wide`): 162 end one query of nearly coincident plates in 10⁵, 2.5 % too deep.
const SECOND: (usize, usize) = (174, 344);
/// Of the one that is lent, 70 KB: enough for all that a query may ask.
const LENT: (usize, usize) = (376, 760);
/// Grains more than the tolerance that proven bounds may be apart, where rounding ended the search.
/// Derived: 20 for what a plane and a point above it round by where D is twice the reach, and as
/// much by which the face found there is nearer than the nearest.
const ROUNDED: f64 = 32.0;
/// Points beyond the answer's plane that are asked about, at most. Insensitive: mostly there is one.
const DOUBTS: usize = 4;
/// The share of the centres' distance that the first depth of a shallow contact is, at most. Measured: 0.5
/// changes no recorded contact by 0.1 %, and leaves deep pairs alone.
const FAR: f64 = 0.5;
/// Places in the first room that are kept free for the start's own points.
const START: usize = 9;

/// Memory for the largest polytopes. All bytes zero is a valid one.
pub struct Room {
    set: SupportSet<{ LENT.0 }>,
    hull: Polytope<{ LENT.1 }>,
}

/// Where a query gets a [`Room`] from, once and only if it needs it.
pub trait Arena {
    /// A room with any contents.
    ///
    /// # Errors
    /// [`Fault::NoMemory`].
    fn room(&mut self) -> Result<&mut Room, Fault>;
}

/// What is wanted, and where to start.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// A point that the caller says is in D, the difference of the centres; trusted.
    pub centre: Option<&'a SupportPoint>,
    /// The unit direction that was asked first.
    pub first: Vec3,
    /// Directions besides `first` that the last proof stood on; zero for none. Empty: cold.
    pub others: &'a [Vec3],
    /// The [`Basis::hint`] beside them; 0 for none.
    pub hint: u32,
    /// How far to go.
    pub limits: &'a Limits,
    /// Does anybody read the contact position?
    pub wants_pos: bool,
    /// The [`Basis::mark`] of when the pair's position was asked for last.
    pub mark: Option<u64>,
    /// Is the position wanted, and are the others those that it is asked by?
    pub stands: bool,
}

impl Request<'_> {
    /// Is nothing known but where to begin?
    fn cold(&self) -> bool {
        self.others.is_empty()
    }
}

/// The directions that a proof stands on, for the next query of the pair: unit, the minimum's
/// first, then those that found the corners of the polytope's nearest face.
#[derive(Clone, Copy, Debug, Default)]
pub struct Basis {
    /// The first so many of them.
    pub directions: [Vec3; Basis::ROOM],
    /// How many there are.
    pub len: u16,
    /// Of the portal of a proof without a hull, of each corner the numbers of the directions that find
    /// obj1's point and obj2's, two bits each, below a bit that is set ([`Basis::PORTAL`]); 0 of a hull's.
    pub hint: u32,
    /// The [`mark::of`] the points known, where the position was asked for.
    pub mark: u64,
    /// Has the pair not moved since the state was left?
    pub unmoved: bool,
}

impl Basis {
    /// How many there is room for: the minimum's and three corners'.
    pub const ROOM: usize = 4;
    /// The bit above those of a portal.
    pub const PORTAL: u32 = 1 << 12;

    /// The directions.
    pub fn directions(&self) -> &[Vec3] {
        &self.directions[..usize::from(self.len).min(Self::ROOM)]
    }

    /// Adds a direction, unless it is there, is zero, or there is no room.
    pub fn add(&mut self, n: &Vec3) {
        if *n != Vec3::zeros() && !self.directions().contains(n) {
            if let Some(free) = self.directions.get_mut(usize::from(self.len)) {
                *free = *n;
                self.len += 1;
            }
        }
    }
}

/// The global minimum penetration. `first`: the support point of the first direction;
/// `basis` takes the directions that the proof stands on, where somebody remembers them;
/// without an `arena` the rooms on the stack are all there is.
///
/// Writes the answer to `hit`, all zero before, and what the position can be read from to `seen`, and returns whether it is proven to within the
/// limits' gap; `depth_lower` is what the polytope proves. Where it is not, a cap or rounding
/// came first: the depth is sound, and the lower bound proven, but they are farther apart.
///
/// # Errors
/// [`Stop::Apart`]: apart, or touching within rounding. Else a callback's answer that is not
/// finite, or an arena without memory.
#[inline(always)]
pub fn minimum<'q, A: SupportMap, B: SupportMap>(
    inquiry: Inquiry<'q, A, B>,
    first: &SupportPoint,
    request: &'q Request<'q>,
    arena: Option<&'q mut dyn Arena>,
    basis: Option<&'q mut Basis>,
    (hit, seen): (&'q mut Penetration, &'q mut Seen),
) -> Result<bool, Stop> {
    let mut search = Search {
        inquiry,
        request,
        arena,
        basis,
        hit,
        seen,
        open: None,
    };
    search.run(first)
}

/// A way to a first tetrahedron.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// [`start::ring`], else the portal of the try without a hull, else [`start::known`].
    Known,
    /// [`start::solid`].
    Solid,
    /// The corners around the origin that the distance algorithm finds.
    Surround,
}

/// In the order in which they are tried: what costs least comes first.
const WAYS: [Way; 3] = [Way::Known, Way::Solid, Way::Surround];

/// A query on its way.
struct Search<'q, 'r, A, B> {
    inquiry: Inquiry<'q, A, B>,
    request: &'r Request<'r>,
    arena: Option<&'r mut dyn Arena>,
    basis: Option<&'r mut Basis>,
    /// The answer of the last expansion.
    hit: &'r mut Penetration,
    /// What the position can be read from, where it is wanted.
    seen: &'r mut Seen,
    /// Whether it is proven, where rounding has ended all expansions so far: the answer where it
    /// ends the last one too.
    open: Option<bool>,
}

impl<A: SupportMap, B: SupportMap> Search<'_, '_, A, B> {
    /// All that comes after the first support point.
    #[inline(never)]
    fn run(&mut self, first: &SupportPoint) -> Result<bool, Stop> {
        let mut start = None;
        if self.at_once(first, &mut start)? {
            return Ok(true);
        }
        let start = start.get_or_insert(Handed::EMPTY);
        loop {
            let known = start.known;
            if !known {
                self.begin(&mut start.set, first)?;
            }
            let proven = self.expanded(start)?;
            if !known || self.is_deepest(&start.set) {
                return Ok(proven);
            }
            // A callback contradicts itself: the pair is asked anew, once.
            self.forget(first);
            start.clear();
        }
    }

    /// Does no point that known ones make lie beyond the lowest plane?
    #[inline(never)]
    fn is_deepest(&self, set: &SupportSet<{ FIRST.0 }>) -> bool {
        let Lowest { depth, dir } = self.inquiry.lowest;
        set.extreme(&dir, 1).reach <= depth + self.inquiry.precision.tie()
    }

    /// All is as after the first support point.
    #[cold]
    #[inline(never)]
    fn forget(&mut self, first: &SupportPoint) {
        let dir = self.request.first;
        let depth = dir.dot(&first.v);
        self.inquiry.lowest = Lowest { depth, dir };
        (*self.hit, self.open) = (Penetration::default(), None);
        if let Some(basis) = &mut self.basis {
            **basis = Basis::default();
        }
    }

    /// Is there an answer of a proof without a hull ([`shallow`](crate::hull::shallow))? Else `start`
    /// takes what is known, if no callback contradicts itself.
    #[inline(never)]
    fn at_once(&mut self, first: &SupportPoint, start: &mut Option<Handed>) -> Result<bool, Stop> {
        let Request {
            centre,
            first: dir,
            others,
            hint,
            limits,
            ..
        } = self.request;
        let mut attempt = Try::new(dir, first);
        if !attempt.recall(&mut self.inquiry, others)? {
            self.forget(first);
            return Ok(false);
        }
        let (opposite, middle);
        let (apex, opposite) = match centre {
            Some(centre) => {
                self.inquiry.precision.note(centre);
                (*centre, None)
            }
            None => match attempt.opposite(&mut self.inquiry, self.request.cold())? {
                Some(point) => {
                    opposite = point;
                    middle = first.towards(&opposite, 0.5);
                    (&middle, Some(&opposite))
                }
                None => {
                    self.forget(first);
                    return Ok(false);
                }
            },
        };
        // Where the first plane is as far as that the contact is a deep one.
        let depth = self.inquiry.lowest.depth;
        let is_deep = !(depth * depth < FAR * FAR * apex.v.norm_squared());
        let cold = self.request.cold();
        // A warm hull from an apex in the middle is begun where the last one ended.
        let hull = is_deep || centre.is_none() && !cold;
        let known = attempt.run(&mut self.inquiry, &apex.v, limits, cold, hull, *hint)?;
        if let Some(least) = known {
            self.conclude_at_once(&attempt, apex, least);
            return Ok(true);
        }
        if !attempt.lies && attempt.is_honest(self.inquiry.precision.tie()) {
            attempt.hand_over(apex, opposite, start.insert(Handed::EMPTY));
        } else {
            self.forget(first);
        }
        Ok(false)
    }

    /// The first tetrahedron, in one of the ways.
    #[inline(always)]
    fn first_tetrahedron(
        &mut self,
        way: Way,
        start: &mut Handed,
    ) -> Result<Option<[usize; 4]>, Stop> {
        let Handed { set, names, .. } = start;
        Ok(match way {
            Way::Known => match start::ring(&mut self.inquiry, set, self.request.limits)? {
                Some(ring) => Some(ring),
                None if names[1] > 0 => Some(names.map(usize::from)),
                None => start::known(&set.v(0), set.len() - 1, |k| set.v(k + 1))
                    .map(|[a, b, c]| [0, a + 1, b + 1, c + 1]),
            },
            Way::Solid => start::solid(&mut self.inquiry, set)?,
            Way::Surround => Some(self.surround(set)?),
        })
    }

    /// The answer of the hulls that begin in the ways there are. (Of its own stack frame, which the try
    /// without a hull does without.)
    #[inline(never)]
    fn expanded(&mut self, start: &mut Handed) -> Result<bool, Stop> {
        let mut hull = Polytope::<{ FIRST.1 }>::blank(self.inquiry.precision.size());
        for way in WAYS {
            // What a try has handed over is named.
            if way != Way::Known && start.set.is_full() {
                start.set.truncate(START);
            }
            let names = self.first_tetrahedron(way, start)?;
            let Handed {
                set,
                rounds,
                opposite,
                ..
            } = &mut *start;
            // Of the hull from here on.
            if let Some((n, point)) = opposite.take() {
                set.push(&n, &point);
            }
            let Some(names) = names else {
                continue;
            };
            let precision = &self.inquiry.precision;
            let mut progress = Progress::new(self.request.limits, precision, set.len(), names);
            progress.iterations = u64::from(*rounds);
            let fine = expansion::exact(progress.tolerance, precision);
            let [i, j, k, l] = names;
            let points = [set.v(i), set.v(j), set.v(k), set.v(l)];
            // It may be flat.
            if !hull.tetrahedron(names, points, precision.size(), fine) {
                continue;
            }
            let end = expand(&mut self.inquiry, set, &mut hull, &mut progress)?;
            let proven = match end {
                End::NoRoom => self.widened(set, &hull, &mut progress)?,
                end => self.answer(set, &hull, &progress, end)?,
            };
            // Where an expansion stays open or is stuck, rounding had the last word: from another
            // tetrahedron it may not.
            if let Some(proven) = proven {
                return Ok(proven);
            }
        }
        Ok(self.open.unwrap_or_else(|| {
            let set = &start.set;
            // Nothing is known but the upper bound.
            let Lowest { depth, dir } = self.inquiry.lowest;
            let lowest = set.farther(&dir, f64::NEG_INFINITY).unwrap_or(1);
            self.put(depth, 0.0, set.witnesses(lowest), [0.0; 2], 0);
            false
        }))
    }

    /// The answer of a proof without a hull.
    #[inline(always)]
    fn conclude_at_once(&mut self, known: &Try, centre: &SupportPoint, lower: f64) {
        let (Some(portal), Some((names, weights))) = (&known.portal, known.exit) else {
            return;
        };
        let points = &known.points;
        let touch = mixed(&weights, names.map(|names| points.witnesses(names)));
        let extent = match self.request.wants_pos {
            true => points.extent([&touch[0], &touch[1]]),
            false => [0.0; 2],
        };
        let depth = self.inquiry.lowest.depth;
        self.put(depth, lower, touch, extent, known.rounds);
        if self.request.stands {
            let witnesses = |k| points.witnesses(points.names(k));
            let asked = |k: usize| (points.direction(k + 1), witnesses(k + 1));
            let count = points.asked() - 1;
            self.seen.stand(&asked, count, self.request.others);
        }
        if self.request.wants_pos {
            self.seen.rest(points, self.hit);
        }
        if let Some(basis) = &mut self.basis {
            known.basis(portal, basis);
            let asked = (0..points.asked()).map(|k| points.witnesses(points.names(k)));
            let all = asked.chain([[centre.v1, centre.v2]]);
            mark_rest(basis, self.request, all);
        }
    }

    /// Writes an answer along the lowest direction.
    #[inline(always)]
    fn put(
        &mut self,
        depth: f64,
        lower: f64,
        [point1, point2]: [Vec3; 2],
        extent: [f64; 2],
        iterations: u64,
    ) {
        let dir = self.inquiry.lowest.dir;
        *self.hit = Penetration {
            depth,
            depth_lower: lower,
            dir,
            normal: dir,
            point1,
            point2,
            extent,
            iterations,
            ..Penetration::default()
        };
    }

    /// No polytope has come to hold the origin, by rounding or by callbacks that contradict
    /// themselves: the distance algorithm decides whether the objects overlap, and its
    /// tetrahedron is the last start.
    #[cold]
    #[inline(never)]
    fn surround<const P: usize>(&mut self, set: &mut SupportSet<P>) -> Result<[usize; 4], Stop> {
        set.truncate(START);
        let dir = self.inquiry.lowest.dir;
        let mut around = SupportSet::<{ overlap::ROOM }>::EMPTY;
        let held = overlap::overlap(&mut self.inquiry, &mut around, None, None, &dir)?;
        let mut take = |i| set.push(&around.direction(i), &around.point(i));
        Ok(held.corners.map(&mut take))
    }

    /// The answer of an expansion: is it proven? `None` where the expansion has not shown the
    /// origin inside, or is stuck and may be tried from elsewhere.
    #[inline(always)]
    fn answer<const P: usize, const F: usize>(
        &mut self,
        set: &SupportSet<P>,
        hull: &Polytope<F>,
        progress: &Progress,
        end: End,
    ) -> Result<Option<bool>, Stop> {
        // Where its planes do not show that it is around anything, nor is the origin inside.
        let end = if hull.winds() { end } else { End::Open };
        let proven = self.conclude(set, hull, progress, end)?;
        // Of the first room: what needs a larger one rests on no floor.
        *self.seen = Seen::Nothing;
        if self.request.wants_pos && P == FIRST.0 {
            self.see(set);
        }
        let open = match end {
            End::Open => true,
            End::NoRoom => !(hull.nearest().key >= 0.0),
            // Of a larger room only what is no answer at all is worth another start.
            End::Stuck => {
                !proven && (P == FIRST.0 || !(self.hit.depth_lower > 0.9 * self.hit.depth))
            }
            End::Proven | End::Inside => false,
        };
        if open {
            self.open = Some(proven);
            return Ok(None);
        }
        Ok(Some(proven))
    }

    /// Keeps what the position can be read from. (Not in the frame of [`Search::conclude`].)
    #[inline(always)]
    fn see<const P: usize>(&mut self, set: &SupportSet<P>) {
        if self.request.stands {
            // They come after the apex and the first.
            let asked = |i: usize| (set.direction(i + 2), set.witnesses(i + 2));
            let count = set.len().saturating_sub(2);
            self.seen.stand(&asked, count, self.request.others);
        }
        let known = |k: usize| (k + 1 < set.len()).then(|| set.witnesses(k + 1));
        self.seen.rest(&known, self.hit);
    }

    /// Puts the apex into the set as point 0, `first` as point 1, and the points that the last
    /// proof stood on: for a pair that is asked anew.
    #[cold]
    #[inline(never)]
    fn begin<const P: usize>(
        &mut self,
        set: &mut SupportSet<P>,
        first: &SupportPoint,
    ) -> Result<(), Stop> {
        let Request {
            centre,
            first: dir,
            others,
            ..
        } = self.request;
        set.push(&Vec3::zeros(), centre.unwrap_or(first));
        set.push(dir, first);
        // A state may hold anything: made unit, and no more than there is room for.
        for n in others.iter().filter_map(unit) {
            if set.len() + START <= P {
                self.inquiry.ask(set, &n)?;
            }
        }
        Ok(())
    }

    /// The expansion goes on in a larger room, and in the one after it.
    #[cold]
    #[inline(never)]
    fn widened(
        &mut self,
        small: &SupportSet<{ FIRST.0 }>,
        polytope: &Polytope<{ FIRST.1 }>,
        progress: &mut Progress,
    ) -> Result<Option<bool>, Stop> {
        let mut set = SupportSet::<{ SECOND.0 }>::EMPTY;
        let mut hull = Polytope::<{ SECOND.1 }>::BLANK;
        set.take(small);
        polytope.moved_to(&mut hull);
        let end = expand(&mut self.inquiry, &mut set, &mut hull, progress)?;
        // It is lent once: an expansion that fills it stays open.
        if let (End::NoRoom, Some(arena)) = (end, self.arena.take()) {
            return self.lent(arena.room()?, &set, &hull, progress);
        }
        self.answer(&set, &hull, progress, end)
    }

    /// The expansion goes on in the room that is lent.
    #[cold]
    #[inline(never)]
    fn lent(
        &mut self,
        Room { set, hull }: &mut Room,
        small: &SupportSet<{ SECOND.0 }>,
        polytope: &Polytope<{ SECOND.1 }>,
        progress: &mut Progress,
    ) -> Result<Option<bool>, Stop> {
        set.take(small);
        polytope.moved_to(hull);
        let end = expand(&mut self.inquiry, set, hull, progress)?;
        self.answer(set, hull, progress, end)
    }

    /// How far along `dir` D reaches, where known points lie beyond `depth`, the support value there.
    ///
    /// Either the callback stopped short along `dir`, and they are right; or it erred where it
    /// found them, as one does that divides by how far the direction is off an axis. The first
    /// are found again from beside, and the others are not.
    #[cold]
    #[inline(never)]
    fn confirmed<const P: usize>(
        &mut self,
        set: &SupportSet<P>,
        dir: &Vec3,
        depth: f64,
    ) -> Result<f64, Fault> {
        let beyond = depth + self.inquiry.precision.tie();
        let mut doubted = [0; DOUBTS];
        for place in 0..DOUBTS {
            let mut farthest = (beyond, 0);
            for i in 1..set.len() {
                let reach = dir.dot(&set.v(i));
                if reach > farthest.0 && !doubted.contains(&i) && set.direction(i) != Vec3::zeros()
                {
                    farthest = (reach, i);
                }
            }
            let (reach, i) = farthest;
            if i == 0 {
                break;
            }
            let n = set.direction(i);
            let point = self.inquiry.point(&beside(&n))?;
            if dir.dot(&point.v) > beyond {
                return Ok(reach);
            }
            doubted[place] = i;
        }
        Ok(depth)
    }

    /// Writes the answer of an expansion, and tells whether it is proven: depth and direction
    /// are the upper bound's, lower bound and witness points the polytope's. An earlier one stays whose
    /// bounds are as close.
    #[inline(never)]
    fn conclude<const P: usize, const F: usize>(
        &mut self,
        set: &SupportSet<P>,
        hull: &Polytope<F>,
        progress: &Progress,
        end: End,
    ) -> Result<bool, Stop> {
        let Lowest { mut depth, dir } = self.inquiry.lowest;
        let top = hull.nearest();
        // The point that was asked for along dir; or a farther one, where a callback
        // contradicts itself.
        let lowest = set.farther(&dir, f64::NEG_INFINITY).unwrap_or(1);
        if dir.dot(&set.v(lowest)) > depth + self.inquiry.precision.tie() {
            depth = self.confirmed(set, &dir, depth)?;
        }
        let grain = self.inquiry.precision.grain();
        let lower = if end == End::Open {
            0.0
        } else {
            larger(hull.bound(&top) - grain, 0.0).min(depth)
        };
        if let Some(proven) = self.open {
            if self.hit.depth - self.hit.depth_lower <= depth - lower {
                return Ok(proven);
            }
        }
        let (face, nearest) = exit_face(set, hull, top.face, &dir, depth, progress.tolerance);
        let touch = mixed(
            &nearest.weights,
            hull.corners(face).map(|i| set.witnesses(i)),
        );
        let points = (1..set.len()).map(|i| set.witnesses(i));
        let extent = match self.request.wants_pos {
            true => pressure::extent(points, [&touch[0], &touch[1]]),
            false => [0.0; 2],
        };
        self.put(depth, lower, touch, extent, progress.iterations);
        if let Some(basis) = &mut self.basis {
            **basis = Basis::default();
            mark_rest(
                basis,
                self.request,
                (0..set.len()).map(|i| set.witnesses(i)),
            );
            basis.add(&dir);
            // What asking along dir has found it finds again: one of several that are as far.
            let found = (1..set.len()).find(|&i| set.direction(i) == dir);
            let found = set.v(found.unwrap_or(lowest));
            for i in hull.corners(top.face) {
                if set.v(i) != found {
                    basis.add(&set.direction(i));
                }
            }
        }
        // The bound as it is rounded down must meet the tolerance, why ever the search ended; one
        // that was asked for coarser than the one in force counts, and a share of the depth. (In
        // this order NaN is none.)
        let Limits { tolerance, gap, .. } = *self.request.limits;
        let asked = larger(tolerance, progress.tolerance);
        let close = larger(gap / (1.0 + gap) * depth, asked + ROUNDED * grain);
        Ok(depth - lower <= close)
    }
}

/// Has the pair moved since the state was left? Only where somebody reads the contact position.
#[inline(always)]
fn mark_rest(
    basis: &mut Basis,
    request: &Request<'_>,
    points: impl Iterator<Item = [Vec3; 2]> + Clone,
) {
    if request.wants_pos {
        basis.mark = mark::of(points.clone());
        basis.unmoved =
            request.mark == Some(basis.mark) && mark::pins(points, request.centre.is_some());
    }
}

/// The objects' points where these corners of a face have these weights.
#[inline(always)]
pub fn mixed(weights: &[f64; 3], corners: [[Vec3; 2]; 3]) -> [Vec3; 2] {
    let [a, b, c] = &corners;
    let point1 = barycentric::mix(weights, [&a[0], &b[0], &c[0]]);
    let point2 = barycentric::mix(weights, [&a[1], &b[1], &c[1]]);
    [point1, point2]
}

/// The face through which the ray along `dir` leaves the polytope, about, and its point
/// nearest to the foot depth · dir.
///
/// Mostly that is the nearest face, `top`. Where several lie in one plane it is the one nearest
/// to the foot, of all that the ray crosses no later than at the depth.
#[inline(always)]
fn exit_face<const P: usize, const F: usize>(
    set: &SupportSet<P>,
    hull: &Polytope<F>,
    top: usize,
    dir: &Vec3,
    depth: f64,
    tolerance: f64,
) -> (usize, barycentric::Nearest<3>) {
    let foot = dir * depth;
    let nearest = |f: usize| {
        let [a, b, c] = hull.corners(f).map(|i| set.v(i));
        barycentric::triangle(&foot, &a, &b, &c)
    };
    let mut best = (top, nearest(top));
    if best.1.distance2 <= tolerance * tolerance {
        return best;
    }
    for f in hull.faces() {
        let rise = hull.normal(f).dot(dir);
        if rise > 0.0 && hull.offset(f) <= rise * (depth + tolerance) {
            let other = nearest(f);
            if other.distance2 < best.1.distance2 {
                best = (f, other);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::shapes::{Random, capsule};

    struct Heap(Option<Box<Room>>);
    impl Arena for Heap {
        fn room(&mut self) -> Result<&mut Room, Fault> {
            Ok(self.0.get_or_insert_with(|| {
                Box::new(Room {
                    set: SupportSet::EMPTY,
                    hull: Polytope::BLANK,
                })
            }))
        }
    }

    /// The minimum of an overlap, and whether it is proven.
    fn ask<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        first: Vec3,
    ) -> Option<(bool, Penetration)> {
        let mut inquiry = Inquiry::new(md);
        let point = inquiry.first(&first, None).ok()?;
        let limits = Limits {
            tolerance: 1e-6,
            gap: 0.0,
            supports: 1500,
            iterations: 1000,
        };
        let request = Request {
            centre: None,
            first,
            others: &[],
            hint: 0,
            limits: &limits,
            wants_pos: true,
            mark: None,
            stands: false,
        };
        let mut hit = Penetration::default();
        let mut heap = Heap(None);
        let proven = minimum(
            inquiry,
            &point,
            &request,
            Some(&mut heap),
            None,
            (&mut hit, &mut Seen::Nothing),
        );
        Some((proven.ok()?, hit))
    }

    /// A box on a box, 1 cm deep along z, asked from a state whose second direction is `aside`.
    fn resting(upper: impl Fn(&Vec3) -> Vec3, aside: Vec3) -> (bool, Penetration) {
        let corner = |d: &Vec3, h: Vec3| Vec3::from_fn(|i, _| h[i].copysign(d[i]));
        let lower = move |d: &Vec3| corner(d, Vec3::new(1.0, 1.0, 0.5)) - Vec3::z() * 0.49;
        let md = MinkowskiDifference::new(lower, upper);
        let mut inquiry = Inquiry::new(&md);
        let first = Vec3::z();
        let point = inquiry.first(&first, None).unwrap();
        let limits = Limits {
            tolerance: 1e-6,
            gap: 1e-3,
            supports: 160,
            iterations: 500,
        };
        let v1 = -Vec3::z() * 0.49;
        let v2 = Vec3::z() * 0.25;
        let request = Request {
            centre: Some(&SupportPoint { v: v1 - v2, v1, v2 }),
            first,
            others: &[aside],
            hint: 0,
            limits: &limits,
            wants_pos: false,
            mark: None,
            stands: false,
        };
        let mut hit = Penetration::default();
        let proven = minimum(
            inquiry,
            &point,
            &request,
            None,
            None,
            (&mut hit, &mut Seen::Nothing),
        );
        (proven.unwrap(), hit)
    }

    fn small(d: &Vec3) -> Vec3 {
        let h = Vec3::new(0.25, 0.25, 0.25);
        Vec3::from_fn(|i, _| h[i].copysign(d[i])) + Vec3::z() * 0.25
    }

    /// As ODE's cylinder does, which errs within 1e-3 of its axis.
    #[test]
    fn a_point_that_is_not_found_again_from_beside_makes_nothing_deeper() {
        let aside = Vec3::new(0.3, 0.2, 1.0).normalize();
        let lies = |d: &Vec3| {
            let near = (d + aside).norm() < 1e-3;
            small(d) - Vec3::z() * if near { 0.05 } else { 0.0 }
        };
        let (_, hit) = resting(lies, aside);
        assert!((hit.depth - 0.01).abs() < 1e-6, "{hit:?}");
    }

    /// A hill climb that ends too early where the answer lies: what it found elsewhere holds.
    #[test]
    fn a_point_that_is_found_again_from_beside_does() {
        let aside = Vec3::new(0.3, 0.2, 1.0).normalize();
        let stops = |d: &Vec3| {
            let near = (d + Vec3::z()).norm() < 1e-3;
            small(d) + Vec3::z() * if near { 0.005 } else { 0.0 }
        };
        let (_, hit) = resting(stops, aside);
        assert!(hit.depth > 0.01 - 1e-6, "{hit:?}");
    }

    #[test]
    fn capsules_are_no_deeper_than_their_cores_tell() {
        let mut r = Random::new(1);
        for round in 0..3000 {
            let (a, b) = (r.direction() * 0.5, r.direction() * 0.5);
            let c = r.direction() * 0.6;
            let (pa, pb) = (capsule(-a, a, 0.5), capsule(c - b, c + b, 0.5));
            let md = MinkowskiDifference::new(pa, pb);
            // cores: parallelogram; exact: facets of segment difference + 1
            let n = a.cross(&b).normalize();
            let core = |n: &Vec3| n.dot(&-c) + n.dot(&a).abs() + n.dot(&b).abs();
            let exact = core(&n).min(core(&-n));
            let n = c.normalize();
            let Some((true, hit)) = ask(&md, n) else {
                continue;
            };
            let md_h = hit.dir.dot(&md.support(&hit.dir).unwrap().v);
            assert!((md_h - hit.depth).abs() < 1e-9);
            if exact > 0.0 {
                assert!(
                    hit.depth <= exact + 1.0 + 1e-5,
                    "{round} {hit:?} {}",
                    exact + 1.0
                );
            }
        }
    }

    #[test]
    fn a_cone_is_proven_from_any_direction() {
        let mut r = Random::new(1);
        let mut bad = 0;
        for round in 0..20000 {
            let rb = r.rotation();
            let (rad, h): (f64, f64) = (0.7046, 0.583);
            let pb = r.vector(0.3);
            let b = move |n: &Vec3| {
                let d: Vec3 = rb.inverse() * n;
                let l = d.x.hypot(d.y);
                let sin = rad / (rad * rad + 4.0 * h * h).sqrt();
                let p = if d.z > sin {
                    Vec3::z() * h
                } else if l > 0.0 {
                    Vec3::new(d.x / l * rad, d.y / l * rad, -h)
                } else {
                    -Vec3::z() * h
                };
                rb * p + pb
            };
            let md = MinkowskiDifference::new(|_: &Vec3| Vec3::zeros(), b);
            let n = if round % 2 == 0 {
                r.direction()
            } else {
                rb * Vec3::z()
            };
            if let Some((false, hit)) = ask(&md, n) {
                if hit.depth_lower == 0.0 {
                    bad += 1;
                    println!("{round} {hit:?}");
                }
            }
        }
        assert_eq!(bad, 0);
    }
}
