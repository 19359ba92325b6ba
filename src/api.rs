// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The Rust interface: the queries of `ccd/warm.h` and `ccd/paper.h`, under the same names, for
//! shapes that are closures or types of the caller. Re-exported by the crate root.
//!
//! Departures from C: a query returns an [`Option`] instead of a code, and an [`Error`] for invalid
//! arguments. If a shape panics, the panic propagates; the state stays unchanged and memory is freed.

use core::fmt;

use crate::contact::face::MAX_CONTACTS;
use crate::contact::manifold;
use crate::contact::manifold_cache;
use crate::ffi::arena::LargeBuffers;
use crate::ffi::warm::NAME;
pub use crate::math::Real;
use crate::math::{Vec3, from_real, to_real};
pub use crate::minkowski::support::Fault as Error;
use crate::minkowski::support::{SupportMap, SupportPoint};
use crate::minkowski::support_query::if_overlapping;
use crate::minkowski::validate as check;
pub use crate::minkowski::validate::Check;
use crate::minkowski::warm_start::WarmStart;
pub use crate::query::signed_distance::DistanceOptions;
use crate::query::{Pair, Solver, unit_direction};
use crate::types::Solution;
pub use crate::types::{Contact, Distance, Penetration, Settings, Status};

/// A convex shape, given by its support function.
///
/// Closures implement it, and so do pairs of a closure and a center:
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
    /// Returns a point of the shape farthest along `dir` (unit, finite), metres.
    fn support(&self, dir: [Real; 3]) -> [Real; 3];

    /// Returns a center: a point inside the shape, metres, as deep as possible. If both shapes of a
    /// pair have one, queries need fewer calls of [`Shape::support`]. It must lie in the shape.
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

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Error::NonFinite => "a shape's point is not finite, or too large",
            Error::NoMemory => "out of memory",
            Error::Missing => "an argument is missing",
            Error::Tolerance => "the tolerance is negative or NaN",
            Error::Center => "a shape's center is not finite",
            Error::Direction => "a direction is zero or not finite",
            Error::DistanceOptions => {
                "a margin is negative or not finite, or max_distance is negative or NaN"
            }
            Error::ContactOptions => "the slop is negative or NaN, or there is no room",
        })
    }
}

impl std::error::Error for Error {}

/// Warm start state of one pair, kept between queries: a plain value. The default is cold.
///
/// A state belongs to one pair in one order. A stale, foreign or random state may cost time and may
/// lead [`penetration_local`] to another local minimum; every result stays sound.
#[derive(Clone, Copy, Debug, Default)]
pub struct Warm(WarmStart);

impl Warm {
    /// Returns a new state that starts from `dir`, a guess of the penetration direction, of any
    /// length; a cold state if `dir` is zero or not finite.
    pub fn guess(dir: [Real; 3]) -> Self {
        Warm(WarmStart::guess(&from_real(dir)))
    }

    /// Converts the state of (a, b) to one of (b, a).
    pub fn flip(&mut self) {
        self.0.flip();
    }
}

/// Warm-start data of [`contacts`] for one pair, in either order: a plain value. The default is
/// empty. Stale or random contents only cost time.
#[derive(Clone, Copy, Debug, Default)]
pub struct ManifoldCache(manifold_cache::ManifoldCache);

/// Runs a query with the state of `warm`, or a cold one without it, and stores the new state. A fault leaves the state
/// unchanged. Returns `None` if the shapes are separated.
fn run<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    settings: &Settings,
    warm: Option<&mut Warm>,
    solver: Solver,
) -> Result<Option<Solution>, Error> {
    let centers = match (a.center(), b.center()) {
        (Some(v1), Some(v2)) => Some(SupportPoint::new(from_real(v1), from_real(v2))),
        _ => None,
    };
    let pair = Pair::new((support_of(a), support_of(b)), centers, None, settings)?;
    let mut state = warm.as_ref().map_or(WarmStart::COLD, |warm| warm.0);
    let found = pair.run(solver, &mut state, &mut LargeBuffers::default());
    state.note_separation(&found);
    let found = if_overlapping(found)?;
    if let Some(warm) = warm {
        warm.0 = state;
    }
    Ok(found)
}

/// Returns a caller's shape as a support function of the solvers.
fn support_of<S: Shape + ?Sized>(shape: &S) -> impl SupportMap {
    |dir: &Vec3| from_real(shape.support(to_real(dir)))
}

/// Defines a penetration query by its name, its direction argument, if any, and its solver.
macro_rules! query {
    ($(#[$docs:meta])* $name:ident $(($dir:ident))?, $solver:expr) => {
        $(#[$docs])*
        pub fn $name<A: Shape + ?Sized, B: Shape + ?Sized>(
            a: &A,
            b: &B,
            $($dir: [Real; 3],)?
            settings: &Settings,
            warm: Option<&mut Warm>,
        ) -> Result<Option<Penetration>, Error> {
            Ok(run(a, b, settings, warm, $solver)?.map(Penetration::from))
        }
    };
}

query!(
    /// Computes the penetration depth: the least distance by which the second shape must move to
    /// separate the two. The default call.
    ///
    /// The depth exceeds the least depth by at most the tolerance or 0.1 % of the depth, the larger of
    /// the two; if [`Penetration::status`] is not converged, it is a sound upper bound.
    ///
    /// With a state, a pair that stays apart costs one support point, and an overlap fewer than a cold
    /// start. The overlap and `depth_lower` rely on the centers. Allocates nothing.
    ///
    /// Returns `None` if the shapes are apart or touch within rounding.
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
    /// A tolerance that is negative or NaN; a point of a shape that is not finite.
    penetration,
    Solver::Global
);

/// Reports whether the shapes overlap; shapes that touch within rounding do not.
///
/// With a state, a pair costs one support point while its last separating axis still separates.
/// Relies on the centers. Allocates nothing.
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
/// A point of a shape that is not finite.
pub fn intersect<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    warm: Option<&mut Warm>,
) -> Result<bool, Error> {
    Ok(run(a, b, &Settings::default(), warm, Solver::Intersect)?.is_some())
}

/// Computes the signed distance: the gap of shapes that are apart, minus the penetration depth of
/// shapes that overlap; continuous at contact, with both bounds proven.
///
/// A margin is a ball added to a shape; the result is exact for it. So a ball is a point with a
/// margin, a capsule a segment with a margin. Does not rely on the centers. Allocates only if the
/// shapes without their margins overlap and their least depth is (nearly) not unique, as for
/// concentric balls.
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
/// a point of a shape that is not finite; a failed allocation.
pub fn signed_distance<A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    settings: &Settings,
    options: &DistanceOptions,
    warm: Option<&mut Warm>,
) -> Result<Distance, Error> {
    // A distance has no position.
    let settings = Settings {
        pos: false,
        ..*settings
    };
    // A distance always has a result.
    let found = run(a, b, &settings, warm, Solver::Distance(*options))?.unwrap_or_default();
    Ok(found.into())
}

/// Computes the contact manifold: the overlap of the two faces along `normal`, projected along it
/// and reduced to at most `room.len()` contacts, the deepest first, the others in order around the
/// normal, chosen for the largest area. Stores the contacts in `room` and returns them, at least one.
///
/// `normal`: of a result for this pose, of any length. `slop`, metres: largest distance of a corner
/// below its support plane at which it still belongs to the face; a thousandth of the shapes' size
/// is good for resting contacts. If `normal` is off by an angle, the slop must be at least that
/// angle times the extent of the face, or only an edge or a corner is found. For normals of this
/// library 1 % of the depth is enough. The slop is therefore raised to 1 % of the depth along
/// `normal` and to 32 ulps of the largest coordinate.
///
/// With a cache, a shape whose face is that of the last call takes half the support calls, and
/// contacts keep their ids. Allocates nothing.
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
/// A normal that is zero or not finite, a slop that is negative or NaN, an empty `room`; a point of
/// a shape that is not finite.
pub fn contacts<'r, A: Shape + ?Sized, B: Shape + ?Sized>(
    a: &A,
    b: &B,
    normal: [Real; 3],
    slop: Real,
    cache: Option<&mut ManifoldCache>,
    room: &'r mut [Contact],
) -> Result<&'r [Contact], Error> {
    let normal = unit_direction(&from_real(normal))?;
    if !(slop >= 0.0) || room.is_empty() {
        return Err(Error::ContactOptions);
    }
    let max = room.len().min(MAX_CONTACTS);
    let cache = cache.map(|cache| &mut cache.0);
    let manifold = manifold::contacts(
        &support_of(a),
        &support_of(b),
        &normal,
        slop.into(),
        cache,
        max,
    )?;
    let room = &mut room[..manifold.len()];
    room.copy_from_slice(&manifold);
    Ok(room)
}

query!(
    /// Computes a local minimum of the depth by a local search from the state's direction. Faster than
    /// [`penetration`] if that direction is roughly right ([`Warm::guess`]); from a distant one it may
    /// find another minimum. If the search does not converge, the search of [`penetration`] follows.
    /// Allocates nothing.
    ///
    /// # Errors
    /// As [`penetration`].
    penetration_local,
    Solver::Local
);

query!(
    /// Computes the globally least depth with a certificate: `depth - depth_lower` is within the
    /// tolerance if [`Penetration::status`] is converged. Does not rely on the centers.
    ///
    /// Allocates, by C's calloc, only if the minimum is (nearly) not unique, as for coaxial cylinders
    /// and concentric balls; the bounds may then not meet, and [`Penetration::status`] says why.
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
    /// As [`penetration`]; a failed allocation.
    penetration_proven,
    Solver::Proven
);

query!(
    /// Computes the directional penetration depth: the least distance by which the second shape must
    /// move along `dir`, of any length, to separate the two. The tolerance is measured along `dir`.
    /// Allocates nothing.
    ///
    /// # Errors
    /// A `dir` that is zero or not finite, and as [`penetration`].
    penetration_along(dir),
    Solver::Along(from_real(dir))
);

query!(
    /// Computes a local minimum of the depth over the directions perpendicular to `plane_normal`, of
    /// any length, for shapes that lie in a common plane. Allocates nothing.
    ///
    /// # Errors
    /// A `plane_normal` that is zero or not finite, and as [`penetration`].
    penetration_planar(plane_normal),
    Solver::Planar(from_real(plane_normal))
);

query!(
    /// Computes a local minimum of the depth by a published method, for comparisons: W. Gao,
    /// *Efficient Incremental Penetration Depth Estimation between Convex Geometries* (2023),
    /// Algorithms 4 and 5. The result is sound. Allocates nothing.
    ///
    /// # Errors
    /// As [`penetration`].
    penetration_incremental,
    Solver::Incremental
);

/// Tests a shape's support function and center along 192 directions, each evaluated twice; for
/// debugging and tests. A reported fault is certain; a fault in few directions may be missed.
/// Allocates nothing.
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
    check::check(&support_of(shape), shape.center().map(from_real).as_ref())
}

/// Returns name, version and precision of the library: "warmccd 0.2.0 double".
pub fn implementation() -> &'static str {
    NAME.trim_end_matches('\0')
}
