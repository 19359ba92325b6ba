// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Rust interface: what `ccd/warm.h` and `ccd/paper.h` have, under the same names, for shapes
//! that are closures or types of the caller's. Re-exported at the head of the crate.
//!
//! Departures from C: an answer is an [`Option`] and a bad argument an [`Error`] in place of codes;
//! a callback that panics leaves through the query, the state stays as it was, and the memory of a
//! proof is freed.

use core::fmt;

use crate::contact;
use crate::contacts::manifold;
use crate::contacts::memory::Memory;
use crate::ffi::arena::Heap;
use crate::ffi::warm::NAME;
use crate::gjk::signed_distance::Wanted;
pub use crate::math::Real;
use crate::math::{ITERATION_CAP, Vec3, from_real, lower_to_real, to_real, unit};
use crate::minkowski::query::{Stop, if_overlapping};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::minkowski::validate as check;
pub use crate::minkowski::validate::Check;
use crate::query::Pair;
use crate::query::warm_start::WarmStart;

/// A convex shape, known by its support function alone.
///
/// A closure is one, and so is a closure with a point inside, as a pair of the two:
///
/// ```
/// use ccd::{Real, Settings};
///
/// let ball = |at: [Real; 3]| move |d: [Real; 3]| [at[0] + d[0], at[1] + d[1], at[2] + d[2]];
/// let a = ball([0.0; 3]);
/// let b = (ball([1.5, 0.0, 0.0]), [1.5, 0.0, 0.0]);
/// let hit = ccd::penetration(&a, &b, &Settings::default(), None)?.expect("an overlap");
/// assert!((hit.depth - 0.5).abs() < 1e-3);
/// # Ok::<(), ccd::Error>(())
/// ```
pub trait Shape {
    /// A point of the shape farthest along `dir`, which is unit and finite.
    fn support(&self, dir: [Real; 3]) -> [Real; 3];

    /// A point inside the shape, the deeper the better: where both shapes of a pair have one, it
    /// saves calls of [`Shape::support`]. It must lie in the shape.
    fn center(&self) -> Option<[Real; 3]> {
        None
    }
}

impl<F: Fn([Real; 3]) -> [Real; 3]> Shape for F {
    fn support(&self, dir: [Real; 3]) -> [Real; 3] {
        self(dir)
    }
}

impl<F: Fn([Real; 3]) -> [Real; 3]> Shape for (F, [Real; 3]) {
    fn support(&self, dir: [Real; 3]) -> [Real; 3] {
        (self.0)(dir)
    }

    fn center(&self) -> Option<[Real; 3]> {
        Some(self.1)
    }
}

/// Why a query has no answer. What was handed in, the state included, is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// An argument, or a shape's answer, that no query can work with: which one.
    BadInput(&'static str),
    /// Memory was needed and not to be had.
    NoMemory,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::BadInput(what) => f.write_str(what),
            Error::NoMemory => f.write_str("out of memory"),
        }
    }
}

impl std::error::Error for Error {}

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::NonFinite => Error::BadInput("a shape's point is not finite, or too large"),
            Fault::NoMemory => Error::NoMemory,
        }
    }
}

/// A length that is neither negative nor NaN.
fn length(value: Real, what: &'static str) -> Result<f64, Error> {
    if value >= 0.0 {
        Ok(value.into())
    } else {
        Err(Error::BadInput(what))
    }
}

fn direction(dir: [Real; 3]) -> Result<Vec3, Error> {
    unit(&from_real(dir)).ok_or(Error::BadInput("a direction is zero or not finite"))
}

/// What is wanted of an answer besides depths, bounds and directions. What is not wanted is zero
/// and costs no support point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Want {
    /// The contact position: 2 to 4 support points, 8 at most where a face has more than four corners,
    /// none where a state shows that nothing has moved. For it the objects are asked one by one.
    pub pos: bool,
    /// The witness points, which cost nothing.
    pub points: bool,
}

impl Want {
    /// Everything.
    pub const ALL: Want = Want {
        pos: true,
        points: true,
    };
    /// Nothing besides.
    pub const NOTHING: Want = Want {
        pos: false,
        points: false,
    };
}

impl Default for Want {
    /// [`Want::ALL`].
    fn default() -> Self {
        Want::ALL
    }
}

/// How exact, with how much work, and what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest error of the depth or distance, metres, not negative; floored at a few ulps of the
    /// shapes' size, so that 0 asks for the best the precision can give.
    pub tolerance: Real,
    /// Cap on the iterations; the library has one of its own.
    pub max_iterations: u64,
    /// What is wanted.
    pub want: Want,
}

impl Settings {
    /// With this tolerance, and everything wanted.
    pub fn new(tolerance: Real) -> Self {
        Settings {
            tolerance,
            ..Settings::default()
        }
    }

    fn checked(&self) -> Result<contact::Settings, Error> {
        Ok(contact::Settings {
            tolerance: length(self.tolerance, "the tolerance is negative or NaN")?,
            max_iterations: ITERATION_CAP.min(self.max_iterations),
        })
    }
}

impl Default for Settings {
    /// A tenth of a millimetre, as much work as it takes, everything.
    fn default() -> Self {
        Settings {
            tolerance: 1e-4,
            max_iterations: u64::MAX,
            want: Want::ALL,
        }
    }
}

/// What one query of a pair leaves for the next: a plain value, cold at first.
///
/// One is for one pair in one order. A stale, foreign or random state costs time and may lead
/// [`penetration_local`] to another local minimum; every answer stays sound.
#[derive(Clone, Copy, Debug, Default)]
pub struct Warm(WarmStart);

impl Warm {
    /// A fresh state that starts from `dir`, a guess of the way the second shape leaves: of any
    /// length; zero or not finite is cold.
    pub fn guess(dir: [Real; 3]) -> Self {
        Warm(WarmStart::guess(&from_real(dir)))
    }

    /// For the same two shapes in the other order.
    pub fn flip(&mut self) {
        self.0.flip();
    }
}

/// What [`contacts`] of a pair leaves for the next: a plain value, cold at first, that serves either
/// order of the pair. A stale, foreign or random one costs time alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Manifold(Memory);

/// An overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Penetration {
    /// Metres, >= 0: moving the second shape by `depth * dir` separates the two.
    pub depth: Real,
    /// Proven lower bound on the least depth (of [`penetration_along`]: on the depth along its
    /// direction), metres; 0 where none was proven.
    pub depth_lower: Real,
    /// Unit; the way the second shape moves.
    pub dir: [Real; 3],
    /// Unit; normal of the separating plane. Equal to `dir` but in [`penetration_along`].
    pub normal: [Real; 3],
    /// Contact position, [`Want::pos`]: the centre of pressure, which is the centroid of the volume
    /// that the shapes share, but for its height along `normal`. It moves as the shapes do. Where
    /// `limit` is set, and of [`penetration_along`] and [`penetration_planar`], the middle of the
    /// witness points.
    pub pos: [Real; 3],
    /// Witness point of the first shape, [`Want::points`]: a point of it, and of its supporting
    /// plane, each to within what the depth may be off, or 1e-12 of the size (in single precision
    /// 1e-5).
    pub point1: [Real; 3],
    /// Witness point of the second shape, [`Want::points`]; the same.
    pub point2: [Real; 3],
    /// Half of the calls of both shapes' [`Shape::support`] together, rounded up: a support point of the
    /// Minkowski difference is one call of each. Positions need further calls of one alone.
    pub support_calls: u64,
    /// Iterations of the solver.
    pub iterations: u64,
    /// The answer is sound, but less exact than asked for: `max_iterations` or the library's own
    /// cap came first, or rounding.
    pub limit: bool,
}

/// What [`signed_distance`] takes besides the shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceOptions {
    /// Radius of a ball that is added all around the first shape, metres, not negative.
    pub margin1: Real,
    /// The same around the second shape.
    pub margin2: Real,
    /// What is farther apart than this, metres, is not refined.
    pub max_distance: Real,
}

impl Default for DistanceOptions {
    /// No margins, any distance.
    fn default() -> Self {
        DistanceOptions {
            margin1: 0.0,
            margin2: 0.0,
            max_distance: Real::INFINITY,
        }
    }
}

/// How far apart two shapes are, or how deep they overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Distance {
    /// Metres: the gap along `normal`, or minus the depth; negative is an overlap. Never more than
    /// the true signed distance.
    pub distance: Real,
    /// Metres, never less than the true signed distance; no more than the tolerance above
    /// `distance`, unless `limit` is set or `distance` is above `max_distance`.
    pub distance_upper: Real,
    /// Unit, from the first shape to the second.
    pub normal: [Real; 3],
    /// Witness point on the surface of the first shape with its margin, [`Want::points`].
    pub point1: [Real; 3],
    /// Witness point of the second shape, [`Want::points`].
    pub point2: [Real; 3],
    /// Half of the calls of both shapes' [`Shape::support`] together, rounded up: a support point of the
    /// Minkowski difference is one call of each. Positions need further calls of one alone.
    pub support_calls: u64,
    /// Iterations of the solver.
    pub iterations: u64,
    /// The bounds are still open.
    pub limit: bool,
}

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Within the slop of the surface of the first shape.
    pub point1: [Real; 3],
    /// `point1 - depth * normal`; within the slop of the surface of the second shape.
    pub point2: [Real; 3],
    /// Metres; negative where the shapes are apart.
    pub depth: Real,
    /// Its name, not 0, while it moves with either shape; 0 without a memory.
    pub id: u32,
}

/// A caller's shape as the solvers ask it.
struct Asked<'a, S: ?Sized>(&'a S);

impl<S: Shape + ?Sized> SupportMap for Asked<'_, S> {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        from_real(self.0.support(to_real(dir)))
    }
}

type Asking<'a, A, B> = Pair<Asked<'a, A>, Asked<'a, B>>;

fn pair<'a, A, B>(a: &'a A, b: &'a B, lasting: bool) -> Result<Asking<'a, A, B>, Error>
where
    A: Shape + ?Sized,
    B: Shape + ?Sized,
{
    let centre = match (a.center(), b.center()) {
        (Some(v1), Some(v2)) => {
            let [v1, v2] = [from_real(v1), from_real(v2)];
            Some(SupportPoint { v: v1 - v2, v1, v2 })
        }
        _ => None,
    };
    if centre.is_some_and(|c| !c.v.sum().is_finite()) {
        return Err(Error::BadInput("a shape's centre is not finite"));
    }
    Ok(Pair {
        md: MinkowskiDifference::new(Asked(a), Asked(b)),
        centre,
        first_dir: None,
        lasting,
    })
}

/// The state that `warm` holds, cold where there is none; what `ask` leaves in it stays unless
/// there is no answer.
fn with_state<R>(
    warm: Option<&mut Warm>,
    ask: impl FnOnce(&mut WarmStart) -> Result<R, Fault>,
) -> Result<R, Error> {
    let mut state = warm.as_ref().map_or(WarmStart::COLD, |warm| warm.0);
    let answer = ask(&mut state)?;
    if let Some(warm) = warm {
        warm.0 = state;
    }
    Ok(answer)
}

/// Runs a solver, which is told whether the position is wanted.
fn answer<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    settings: &Settings,
    warm: Option<&mut Warm>,
    solve: impl FnOnce(
        &Asking<'_, A, B>,
        &mut WarmStart,
        &contact::Settings,
        bool,
        &mut contact::Penetration,
    ) -> Result<(), Stop>,
) -> Result<Option<Penetration>, Error> {
    let checked = settings.checked()?;
    let want = settings.want;
    let pair = pair(a, b, warm.is_some())?;
    let mut hit = contact::Penetration::default();
    let found = with_state(warm, |state| {
        if_overlapping(solve(&pair, state, &checked, want.pos, &mut hit))
    })?;
    let given = |wanted: bool, point: Vec3| if wanted { to_real(&point) } else { [0.0; 3] };
    Ok(found.map(|()| Penetration {
        depth: hit.depth as Real,
        depth_lower: lower_to_real(hit.depth_lower),
        dir: to_real(&hit.dir),
        normal: to_real(&hit.normal),
        pos: given(want.pos, hit.pos),
        point1: given(want.points, hit.point1),
        point2: given(want.points, hit.point2),
        support_calls: pair.md.supports(),
        iterations: hit.iterations,
        limit: hit.limit,
    }))
}

/// A penetration query: its name, the direction that it takes, if any, and its solver.
macro_rules! query {
    ($(#[$about:meta])* $name:ident $(($dir:ident))?, $solve:expr) => {
        $(#[$about])*
        pub fn $name<A: Shape + ?Sized, B: Shape + ?Sized>(
            a: &A,
            b: &B,
            $($dir: [Real; 3],)?
            settings: &Settings,
            warm: Option<&mut Warm>,
        ) -> Result<Option<Penetration>, Error> {
            $(let $dir = direction($dir)?;)?
            answer(a, b, settings, warm, $solve)
        }
    };
}

query!(
    /// The penetration depth: the least distance by which the second shape must move to separate the
    /// two, within the larger of the tolerance and 0.1 % of it. The call to take unless one of the
    /// others says what is wanted better. `None`: apart, or a touch within rounding.
    ///
    /// With a state, a pair that stays apart costs one call of each shape's support function, and one
    /// that overlaps fewer than without. Centres are trusted; `depth_lower` leans on them too.
    /// Allocates nothing.
    ///
    /// ```
    /// use ccd::{Real, Settings, Warm};
    ///
    /// fn push(depth: Real, dir: [Real; 3], at: &mut [Real; 3]) {
    ///     at.iter_mut().zip(dir).for_each(|(x, d)| *x += depth * d);
    /// }
    ///
    /// let ball = |at: [Real; 3]| (move |d: [Real; 3]| [at[0] + d[0], at[1] + d[1], at[2] + d[2]], at);
    /// let (a, mut at) = (ball([0.0; 3]), [0.3, 0.2, 0.1]);
    /// let mut warm = Warm::default(); // one for each pair, kept between frames
    /// for frame in 0..3 {
    ///     if let Some(hit) = ccd::penetration(&a, &ball(at), &Settings::new(1e-6), Some(&mut warm))? {
    ///         assert!(frame == 0 || hit.depth < 1e-3);
    ///         push(hit.depth, hit.dir, &mut at);
    ///     }
    /// }
    /// # Ok::<(), ccd::Error>(())
    /// ```
    ///
    /// # Errors
    /// A tolerance that is negative or NaN; a shape's point that is not finite.
    penetration,
    |pair, state, settings, wants, hit| pair.mpr(state, settings, wants, hit)
);

/// Do the shapes overlap? (A touch within rounding is no overlap.) A pair that stays apart costs
/// one call of each shape's support function while its last separating direction still separates.
///
/// ```
/// use ccd::Real;
///
/// let ball = |x: Real| move |d: [Real; 3]| [x + d[0], d[1], d[2]];
/// assert!(ccd::intersect(&ball(0.0), &ball(1.5), None)?);
/// assert!(!ccd::intersect(&ball(0.0), &ball(2.5), None)?);
/// # Ok::<(), ccd::Error>(())
/// ```
///
/// # Errors
/// A shape's point that is not finite.
pub fn intersect<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    warm: Option<&mut Warm>,
) -> Result<bool, Error> {
    let pair = pair(a, b, warm.is_some())?;
    let overlap = match warm {
        None => if_overlapping(pair.intersect(None))?,
        warm => with_state(warm, |state| if_overlapping(pair.intersect(Some(state))))?,
    };
    Ok(overlap.is_some())
}

/// How far apart, or how deep: one continuous function through the touch, with bounds proven on
/// both sides.
///
/// With margins the shapes are meant with a ball of that radius added all around, exactly, on both
/// sides of the touch: a ball is a point with a margin, a capsule a segment. Takes no memory while
/// the shapes without their margins are apart.
///
/// ```
/// use ccd::{DistanceOptions, Real, Settings};
///
/// let point = |x: Real| move |_: [Real; 3]| [x, 0.0, 0.0];
/// let balls = DistanceOptions { margin1: 1.0, margin2: 1.0, ..Default::default() };
/// let d = ccd::signed_distance(&point(0.0), &point(1.5), &Settings::new(1e-6), &balls, None)?;
/// assert!((d.distance + 0.5).abs() < 1e-5);
/// # Ok::<(), ccd::Error>(())
/// ```
///
/// # Errors
/// A tolerance, a margin or a `max_distance` that is negative or NaN, margins that are not finite;
/// a shape's point that is not finite; no memory.
pub fn signed_distance<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    settings: &Settings,
    options: &DistanceOptions,
    warm: Option<&mut Warm>,
) -> Result<Distance, Error> {
    let margins = "a margin is negative, NaN or not finite";
    let wanted = Wanted {
        margin1: length(options.margin1, margins)?,
        margin2: length(options.margin2, margins)?,
        max_distance: length(options.max_distance, "max_distance is negative or NaN")?,
        settings: settings.checked()?,
    };
    if !(wanted.margin1 + wanted.margin2 < f64::from(Real::MAX)) {
        return Err(Error::BadInput(margins));
    }
    let points = settings.want.points;
    let pair = pair(a, b, warm.is_some())?;
    let minimum = |pair: &Asking<'_, A, B>, state: &mut WarmStart, settings: &_, hit: &mut _| {
        pair.minimum(state, settings, &mut Heap::default(), points, hit)
    };
    let d = with_state(warm, |state| pair.signed_distance(state, &wanted, minimum))?;
    let given = |point: Vec3| if points { to_real(&point) } else { [0.0; 3] };
    Ok(Distance {
        distance: lower_to_real(d.lower),
        distance_upper: -lower_to_real(-d.upper),
        normal: to_real(&d.normal),
        point1: given(d.point1),
        point2: given(d.point2),
        support_calls: pair.md.supports(),
        iterations: d.iterations,
        limit: d.is_limited,
    })
}

/// Where two shapes touch, not only how deep: the region in which the faces that look along
/// `normal` lie over each other, as the points of `room` that are returned: the deepest first, the
/// others in order around the normal, spread to the largest area. At least one.
///
/// `normal`: of an answer for this pose (`dir` where there is no other), of any length. `slop`,
/// metres: how far below its support plane a corner may lie and still belong to the face; a
/// thousandth of the shapes' size is good for contacts that rest. It is at least 1 % of the depth
/// along `normal`, which a normal that is good to 0.1 % of the depth needs, and 32 ulps of the
/// largest coordinate. With a memory a shape that has the same face as the last time is asked half
/// as often. Allocates nothing.
///
/// ```
/// use ccd::{Contact, Real};
///
/// let cube = |z: Real| move |d: [Real; 3]| {
///     let [x, y, h] = d.map(|d| (0.5 as Real).copysign(d));
///     [x, y, z + h]
/// };
/// let mut room = [Contact::default(); 8];
/// let contacts = ccd::contacts(&cube(0.0), &cube(0.99), [0.0, 0.0, 1.0], 1e-3, None, &mut room)?;
/// assert_eq!(contacts.len(), 4);
/// assert!((contacts[0].depth - 0.01).abs() < 1e-5);
/// # Ok::<(), ccd::Error>(())
/// ```
///
/// # Errors
/// A normal that is zero or not finite, a slop that is negative or NaN, no room; a shape's point
/// that is not finite.
pub fn contacts<'r, A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    normal: [Real; 3],
    slop: Real,
    memory: Option<&mut Manifold>,
    room: &'r mut [Contact],
) -> Result<&'r [Contact], Error> {
    let normal = direction(normal)?;
    let slop = length(slop, "the slop is negative or NaN")?;
    if room.is_empty() {
        return Err(Error::BadInput("no room for a contact"));
    }
    let most = room.len().min(manifold::ROOM);
    let memory = memory.map(|memory| &mut memory.0);
    let manifold = manifold::contacts(&Asked(a), &Asked(b), &normal, slop, memory, most)?;
    let mut count = 0;
    for (place, contact) in room.iter_mut().zip(manifold.contacts()) {
        *place = Contact {
            point1: to_real(&contact.point1),
            point2: to_real(&contact.point2),
            depth: contact.depth as Real,
            id: contact.name,
        };
        count += 1;
    }
    Ok(&room[..count])
}

query!(
    /// Returns a local minimum of the depth, by a walk on known vertices. Asks few support points with a
    /// direction that is roughly right ([`Warm::guess`]); from far off it may end in another minimum.
    /// Allocates nothing.
    ///
    /// # Errors
    /// As [`penetration`].
    penetration_local,
    |pair, state, settings, wants, hit| pair.local(state, settings, wants, hit)
);

query!(
    /// The least depth with its proof: `depth - depth_lower` is within the tolerance unless
    /// [`Penetration::limit`] is set. Trusts no centre.
    ///
    /// Takes memory, from C's allocator, only where the minima (nearly) form a curve or a surface.
    ///
    /// ```
    /// use ccd::{Real, Settings};
    ///
    /// let ball = |x: Real| move |d: [Real; 3]| [x + d[0], d[1], d[2]];
    /// let hit = ccd::penetration_proven(&ball(0.0), &ball(1.5), &Settings::new(1e-5), None)?;
    /// let hit = hit.expect("an overlap");
    /// assert!(hit.depth_lower <= hit.depth && hit.depth - hit.depth_lower <= 1.1e-5);
    /// # Ok::<(), ccd::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`penetration`]; no memory.
    penetration_proven,
    |pair, state, settings, wants, hit| pair.minimum(state, settings, &mut Heap::default(), wants, hit)
);

query!(
    /// How far the second shape must move along `dir`, of any length, to separate the two
    /// (directional penetration depth). The tolerance is measured along `dir`. Allocates nothing.
    ///
    /// # Errors
    /// A `dir` that is zero or not finite, and as [`penetration`].
    penetration_along(dir),
    |pair, state, settings, _, hit| pair.along(dir, state, settings, hit)
);

query!(
    /// A local minimum of the depth among the directions of a plane, for shapes that lie in a common
    /// plane with this normal, of any length. Allocates nothing.
    ///
    /// # Errors
    /// A `plane_normal` that is zero or not finite, and as [`penetration`].
    penetration_planar(plane_normal),
    |pair, state, settings, _, hit| pair.planar(plane_normal, state, settings, hit)
);

query!(
    /// A local minimum of the depth by the paper's method as published, for comparisons: W. Gao,
    /// *Efficient Incremental Penetration Depth Estimation between Convex Geometries*, Algorithms 4
    /// and 5, with a sound answer. Allocates nothing.
    ///
    /// # Errors
    /// As [`penetration`].
    penetration_incremental,
    |pair, state, settings, wants, hit| pair.incremental(state, settings, wants, hit)
);

/// What is wrong with a shape, as far as 192 directions tell, each asked twice: for when an answer
/// is odd, and for tests. What is found is wrong for certain; a fault that shows in few directions
/// may be missed.
///
/// ```
/// use ccd::Real;
///
/// let ball = |d: [Real; 3]| d.map(|x| x * 0.5);
/// assert!(ccd::check(&ball).is_fine());
/// let wrong = ccd::check(&(ball, [1.0, 0.0, 0.0]));
/// assert!(wrong.center_outside && wrong.outside > 0.4);
/// assert!(ccd::check(&|d: [Real; 3]| d.map(|x| x * -0.5)).opposite);
/// ```
pub fn check<S: Shape + ?Sized>(shape: &S) -> Check {
    check::check(&Asked(shape), shape.center().map(from_real).as_ref())
}

/// Which library this is, and in which precision: "warmccd 0.2.0 double".
pub fn implementation() -> &'static str {
    NAME.trim_end_matches('\0')
}
