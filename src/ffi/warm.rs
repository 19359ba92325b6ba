// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The extension, `ccd/warm.h`: cbindgen makes that header from this file.

use core::ffi::{c_char, c_int, c_uint, c_ulong, c_void};

use super::arena;
use super::callbacks::{Object, Query};
use super::collide::{mpr_penetration, write};
use super::types::{ccd_t, ccd_vec3_t};
use crate::contact::{Answer, Penetration, Settings};
use crate::contacts::manifold;
use crate::gjk::intersect;
use crate::gjk::overlap;
use crate::gjk::signed_distance::{Distance, Wanted, signed_distance};
use crate::known::support::Fault;
use crate::math::{Real, Vec3, unit};
use crate::{query::Pair, state::State};

/// The objects overlap, by more than rounding.
pub const CCD_HIT: c_int = 0;
/// The objects are apart, or touch within rounding.
pub const CCD_MISS: c_int = -1;
/// Memory was needed and not to be had.
pub const CCD_NO_MEMORY: c_int = -2;
/// An argument or a callback's answer that no query can work with; nothing was written.
pub const CCD_BAD_INPUT: c_int = -3;
/// max_iterations came before the tolerance: the best sound answer was written.
pub const CCD_LIMIT: c_int = -4;

/// How many numbers a ccd_warm_t holds.
pub const CCD_WARM_REALS: usize = 19;

/// State of one pair between queries. Plain data, no pointers, nothing to free: all
/// bytes zero is cold, and it may be copied and stored freely.
///
/// One state is for one pair in one order: the state of (a, b) is a foreign one to a query of
/// (b, a), until ccdWarmFlip turns it round. Every call takes what any other call has left in
/// it. Two threads must not use one state at once.
///
/// A stale, foreign or random state may cost time and may lead ccdPenetrationLocal to
/// another local minimum; every answer stays sound. The fields are the library's own.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_warm_t {
    /// Private.
    pub reals: [Real; CCD_WARM_REALS],
    /// Private.
    pub words: [c_uint; 4],
}

const _: () = {
    assert!(size_of::<ccd_warm_t>() == size_of::<State>());
    assert!(align_of::<ccd_warm_t>() == align_of::<State>());
    assert!(size_of::<ccd_warm_t>() <= 256);
};

/// What a query of the extension answers.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_penetration_t {
    /// Metres, >= 0: moving obj2 by depth * dir separates the objects. It is the support
    /// value of normal, divided by dir . normal.
    pub depth: Real,
    /// Proven lower bound on the global minimum depth (in ccdPenetrationAlong: on the
    /// depth along dir), metres; 0 where none was proven.
    pub depth_lower: Real,
    /// Unit; the way obj2 moves.
    pub dir: ccd_vec3_t,
    /// Unit; normal of the separating plane. Equal to dir except in ccdPenetrationAlong.
    pub normal: ccd_vec3_t,
    /// Contact position: the middle of the witness points. Where a face rests on a face or
    /// an edge these are in the middle of where the two touch, and move as the objects do.
    pub pos: ccd_vec3_t,
    /// Witness point of obj1, within the tolerance of its supporting plane.
    pub point1: ccd_vec3_t,
    /// Witness point of obj2, within the tolerance of its supporting plane.
    pub point2: ccd_vec3_t,
    /// Support points of the Minkowski difference evaluated; one is one call of support1
    /// and one of support2.
    pub supports: c_ulong,
    /// Iterations of the solver.
    pub iterations: c_ulong,
}

impl ccd_penetration_t {
    fn new(hit: &Penetration, supports: u64) -> Self {
        Self {
            depth: hit.depth,
            depth_lower: hit.depth_lower,
            dir: hit.dir.into(),
            normal: hit.normal.into(),
            pos: ((hit.point1 + hit.point2) * 0.5).into(),
            point1: hit.point1.into(),
            point2: hit.point2.into(),
            supports: supports as c_ulong,
            iterations: hit.iterations as c_ulong,
        }
    }
}

/// A query of the extension: runs `solve` with the caller's state, or with a cold one
/// where there is none, and writes what comes of it.
///
/// # Safety
/// \[inputs\] and \[outputs\] of the module contract; `solve` runs callbacks, so that nothing
/// with a destructor is alive here.
unsafe fn answer(
    query: Query,
    tolerance: unsafe fn(&Query) -> Real,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
    solve: impl FnOnce(&Pair<Object, Object>, &mut State, &Settings) -> Result<Answer, Fault>,
) -> c_int {
    if query.ccd.is_null() || out.is_null() {
        return CCD_BAD_INPUT;
    }
    // SAFETY: [inputs], [outputs]; `solve` runs callbacks, [callbacks].
    unsafe {
        let tolerance = tolerance(&query);
        if !(tolerance >= 0.0) {
            return CCD_BAD_INPUT;
        }
        let Some(pair) = query.asked(!warm.is_null()) else {
            return CCD_BAD_INPUT;
        };
        let settings = Settings {
            tolerance,
            max_iterations: query.max_iterations(),
        };
        let mut state = read(warm);
        let result = solve(&pair, &mut state, &settings);
        let (code, hit) = match result {
            Ok(Answer::Hit(hit)) => (CCD_HIT, Some(hit)),
            Ok(Answer::Limit(hit)) => (CCD_LIMIT, Some(hit)),
            Ok(Answer::Miss(_)) => (CCD_MISS, None),
            Err(Fault::NoMemory) => return CCD_NO_MEMORY,
            Err(Fault::NonFinite) => return CCD_BAD_INPUT,
        };
        if let Some(hit) = hit {
            *out = ccd_penetration_t::new(&hit, pair.md.supports());
        }
        store(warm, &state);
        code
    }
}

/// The caller's state; cold where there is none.
///
/// # Safety
/// \[inputs\] of the module contract.
unsafe fn read(warm: *const ccd_warm_t) -> State {
    if warm.is_null() {
        State::default()
    } else {
        // SAFETY: [inputs]; every bit pattern is a State of the same layout.
        unsafe { *warm.cast::<State>() }
    }
}

/// # Safety
/// \[outputs\] of the module contract.
unsafe fn store(warm: *mut ccd_warm_t, state: &State) {
    if !warm.is_null() {
        // SAFETY: [outputs].
        unsafe { *warm.cast::<State>() = *state };
    }
}

/// Makes `warm` a fresh state that starts from `dir`, the caller's guess of the way obj2
/// leaves.
///
/// `dir` need not be unit; zero, not finite or NULL makes a cold state. `warm` NULL: nothing
/// happens.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmGuess(warm: *mut ccd_warm_t, dir: *const ccd_vec3_t) {
    // SAFETY: [inputs], [outputs].
    unsafe {
        let guess = match dir.as_ref() {
            Some(dir) => State::guess(&(*dir).into()),
            None => State::default(),
        };
        store(warm, &guess);
    }
}

/// Makes a state of the pair (obj1, obj2) one of (obj2, obj1): for a caller who keeps one
/// state a pair and meets its objects in either order.
///
/// Cold stays cold. `warm` NULL: nothing happens.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdWarmFlip(warm: *mut ccd_warm_t) {
    // SAFETY: [inputs], [outputs].
    unsafe {
        let mut state = read(warm);
        state.flip();
        store(warm, &state);
    }
}

/// ccdMPRPenetration with memory.
///
/// `warm` may be NULL (cold). Returns and outputs as ccdMPRPenetration.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRPenetrationWarm(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    depth: *mut Real,
    dir: *mut ccd_vec3_t,
    pos: *mut ccd_vec3_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let mut state = read(warm);
        let answer = mpr_penetration(
            Query { obj1, obj2, ccd },
            &mut state,
            !warm.is_null(),
            !pos.is_null(),
        );
        if answer.is_ok() {
            store(warm, &state);
        }
        match &answer {
            Ok(Answer::Hit(hit) | Answer::Limit(hit)) => {
                write(hit, depth, dir, pos);
                CCD_HIT
            }
            _ => CCD_MISS,
        }
    }
}

/// ccdMPRIntersect with memory: a pair that stays apart costs one support point while its
/// last separating direction still separates.
///
/// `warm` may be NULL (cold). Returns as ccdMPRIntersect: 1 or 0.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdMPRIntersectWarm(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe {
        let (Some(md), Some(centre)) = (query.difference(), query.centre()) else {
            return 0;
        };
        if warm.is_null() {
            return c_int::from(overlap::from_centre(&md, &centre).is_ok());
        }
        let mut state = read(warm);
        match intersect::intersect(&md, &centre, &mut state) {
            Ok(overlap) => {
                store(warm, &state);
                c_int::from(overlap)
            }
            Err(_) => 0,
        }
    }
}

/// A local minimum of the penetration depth, by the fastest search there is: cutting planes
/// with curvature, not the paper's method, which is ccdPenetrationIncremental. From the
/// state, else from the centres, else from first_dir.
///
/// Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
///
/// Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT and leaves it
/// alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationLocal(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe {
        answer(
            query,
            Query::mpr_tolerance,
            warm,
            out,
            |pair, state, settings| pair.local(state, settings),
        )
    }
}

/// A local minimum of the penetration depth by the paper's method as published (Algorithms
/// 4 and 5, the shortcut on), with a sound answer: the depth is that of the least support
/// plane met, and an overlap is proven. For comparisons; ccdPenetrationLocal answers the
/// same in fewer support points. From the state's direction, else from the centres, else
/// from first_dir.
///
/// Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
///
/// Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT and leaves it
/// alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationIncremental(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe {
        answer(
            query,
            Query::mpr_tolerance,
            warm,
            out,
            |pair, state, settings| pair.incremental(state, settings),
        )
    }
}

/// The global minimum of the penetration depth, proven: depth - depth_lower <=
/// epa_tolerance on CCD_HIT. From the state, else from the centres, else from first_dir.
///
/// Reads epa_tolerance. center1 and center2 may be NULL. `warm` may be NULL (cold).
/// Takes memory from malloc only where the minima (nearly) form a curve or a surface.
///
/// Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS, CCD_BAD_INPUT or CCD_NO_MEMORY
/// and leaves it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationMinimum(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
) -> c_int {
    let query = Query { obj1, obj2, ccd };
    // SAFETY: passed on.
    unsafe {
        answer(
            query,
            Query::epa_tolerance,
            warm,
            out,
            |pair, state, settings| arena::with(|arena| pair.minimum(state, settings, arena, true)),
        )
    }
}

/// How far obj2 must move along `dir` to separate: where the origin ray leaves the
/// Minkowski difference (the paper's Algorithm 1).
///
/// `dir` need not be unit. mpr_tolerance is measured along `dir`. `warm` may be NULL (cold).
///
/// Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT (also for a `dir`
/// that is zero, not finite or NULL) and leaves it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationAlong(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    dir: *const ccd_vec3_t,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let Some(dir) = unit_of(dir) else {
            return CCD_BAD_INPUT;
        };
        answer(
            Query { obj1, obj2, ccd },
            Query::mpr_tolerance,
            warm,
            out,
            |pair, state, settings| pair.along(dir, state, settings),
        )
    }
}

/// A local minimum of the penetration depth among the directions of a plane (the paper's
/// two-dimensional case), for shapes that lie in a common plane with this normal.
///
/// `plane_normal` need not be unit. Reads mpr_tolerance. `warm` may be NULL (cold).
///
/// Returns CCD_HIT or CCD_LIMIT and fills `out`; CCD_MISS or CCD_BAD_INPUT (also for a
/// `plane_normal` that is zero, not finite or NULL) and leaves it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdPenetrationPlanar(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    plane_normal: *const ccd_vec3_t,
    warm: *mut ccd_warm_t,
    out: *mut ccd_penetration_t,
) -> c_int {
    // SAFETY: passed on.
    unsafe {
        let Some(m) = unit_of(plane_normal) else {
            return CCD_BAD_INPUT;
        };
        answer(
            Query { obj1, obj2, ccd },
            Query::mpr_tolerance,
            warm,
            out,
            |pair, state, settings| pair.planar(m, state, settings),
        )
    }
}

/// One point of a contact manifold.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_contact_t {
    /// Within slop of the surface of obj1.
    pub point1: ccd_vec3_t,
    /// point1 - depth * normal; within slop of the surface of obj2.
    pub point2: ccd_vec3_t,
    /// Metres: at least the support value of normal less 2 slop; negative where the objects
    /// are apart.
    pub depth: Real,
}

/// Where two objects touch, not only how deep: the region in which the faces that look along
/// `normal` lie over each other, reduced to at most `max` points: the deepest first, the
/// others in order around the normal, spread to the largest area.
///
/// `normal`: of an answer for this pose (dir where there is no other), not necessarily unit.
/// `slop`, metres, >= 0: how far below its support plane a corner may lie and still belong to
/// the face; a thousandth of the objects' size is good for contacts that rest. Corners
/// between half the slop and the slop may be either. It is floored at a few ulps of the
/// coordinates and is no more than the size of the face.
///
/// Roundness is taken off: a sphere gives one point, a lying capsule or cylinder its two ends.
/// Faces of more than 8 corners are inscribed. Where the faces do not lie over each other:
/// one point, midway between them. The region moves as the objects do. Points carry no names:
/// match those of two frames by position. For objects that are meant with margins, move the
/// points by them along the normal.
///
/// Reads no tolerance, centre or max_iterations; at most 24 support points of each object, 12
/// of a box. Allocates nothing.
///
/// Returns how many points were written to `contacts`, at least 1; or CCD_BAD_INPUT (a normal
/// that is zero, not finite or NULL, a slop that is negative or NaN, max < 1, no contacts, a
/// callback's point that is not finite), and nothing was written.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdContacts(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    normal: *const ccd_vec3_t,
    slop: Real,
    contacts: *mut ccd_contact_t,
    max: c_int,
) -> c_int {
    if ccd.is_null() || contacts.is_null() || max < 1 || !(slop >= 0.0) {
        return CCD_BAD_INPUT;
    }
    // SAFETY: [inputs].
    let (normal, objects) = unsafe { (unit_of(normal), Query { obj1, obj2, ccd }.objects()) };
    let (Some(normal), Some((one, two))) = (normal, objects) else {
        return CCD_BAD_INPUT;
    };
    let max = (max as usize).min(manifold::ROOM);
    let Ok(manifold) = manifold::contacts(&one, &two, &normal, slop, max) else {
        return CCD_BAD_INPUT;
    };
    for (i, contact) in manifold.contacts().iter().enumerate() {
        let out = ccd_contact_t {
            point1: contact.point1.into(),
            point2: contact.point2.into(),
            depth: contact.depth,
        };
        // SAFETY: [outputs]; `contacts` has room for `max`.
        unsafe { contacts.add(i).write(out) };
    }
    manifold.contacts().len() as c_int
}

/// What ccdSignedDistance answers.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_distance_t {
    /// Metres: the gap along normal where the objects are apart, minus the depth where they
    /// overlap. Never more than the true signed distance: obj2 may come nearer by it.
    pub distance: Real,
    /// Metres, never less than the true signed distance: apart |point1 - point2|, overlapping
    /// minus the least depth proven. distance_upper - distance <= dist_tolerance unless
    /// CCD_LIMIT was returned or distance > beyond.
    pub distance_upper: Real,
    /// Unit, from obj1 to obj2: the way obj2 moves to be farther.
    pub normal: ccd_vec3_t,
    /// Witness point on the surface of obj1 with its margin.
    pub point1: ccd_vec3_t,
    /// Witness point on the surface of obj2 with its margin.
    pub point2: ccd_vec3_t,
    /// Support points of the Minkowski difference evaluated; one is one call of support1
    /// and one of support2.
    pub supports: c_ulong,
    /// Iterations of the solver.
    pub iterations: c_ulong,
}

impl ccd_distance_t {
    fn new(distance: &Distance, supports: u64) -> Self {
        Self {
            distance: distance.lower,
            distance_upper: distance.upper,
            normal: distance.normal.into(),
            point1: distance.point1.into(),
            point2: distance.point2.into(),
            supports: supports as c_ulong,
            iterations: distance.iterations as c_ulong,
        }
    }
}

/// How far apart, or how deep: one continuous function through the touch.
///
/// margin1, margin2, metres, >= 0: the objects are meant with a ball of that radius added all
/// around, and the support functions give the cores. (A sphere is a point with a margin, a
/// capsule a segment, a rounded box a box.) The signed distance is the cores' minus both
/// margins, overlapping cores included.
///
/// `beyond`, metres, >= 0: the search ends as soon as the distance is known to be greater.
/// INFINITY: it is always refined. Reads dist_tolerance. center1, center2 and first_dir may
/// be NULL. `warm` may be NULL (cold). Takes no memory from malloc while the cores are apart.
///
/// Returns CCD_HIT (overlap), CCD_MISS (apart, or a touch within rounding, whose distance is
/// 0) or CCD_LIMIT (the bounds are still open) and fills `out`; CCD_BAD_INPUT or
/// CCD_NO_MEMORY (cores that overlap only) and leaves it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdSignedDistance(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    margin1: Real,
    margin2: Real,
    beyond: Real,
    warm: *mut ccd_warm_t,
    out: *mut ccd_distance_t,
) -> c_int {
    let margins = margin1 + margin2;
    // Negated for NaN.
    let given = margin1 >= 0.0 && margin2 >= 0.0 && beyond >= 0.0 && margins < Real::INFINITY;
    if ccd.is_null() || out.is_null() || !given {
        return CCD_BAD_INPUT;
    }
    let query = Query { obj1, obj2, ccd };
    // SAFETY: [inputs], [outputs]; passed on.
    unsafe {
        let tolerance = query.dist_tolerance();
        if !(tolerance >= 0.0) {
            return CCD_BAD_INPUT;
        }
        let Some(pair) = query.asked(!warm.is_null()) else {
            return CCD_BAD_INPUT;
        };
        let wanted = Wanted {
            margin1,
            margin2,
            beyond,
            settings: Settings {
                tolerance,
                max_iterations: query.max_iterations(),
            },
        };
        let mut state = read(warm);
        let minimum = |pair: &Pair<Object, Object>, state: &mut State, settings: &Settings| {
            arena::with(|arena| pair.minimum(state, settings, arena, true))
        };
        let distance = match signed_distance(&pair, &mut state, &wanted, minimum) {
            Ok(distance) => distance,
            Err(Fault::NoMemory) => return CCD_NO_MEMORY,
            Err(Fault::NonFinite) => return CCD_BAD_INPUT,
        };
        *out = ccd_distance_t::new(&distance, pair.md.supports());
        store(warm, &state);
        match (distance.limit, distance.hit) {
            (true, _) => CCD_LIMIT,
            (false, true) => CCD_HIT,
            (false, false) => CCD_MISS,
        }
    }
}

/// # Safety
/// \[inputs\] of the module contract.
unsafe fn unit_of(dir: *const ccd_vec3_t) -> Option<Vec3> {
    // SAFETY: [inputs].
    unit(&unsafe { *dir.as_ref()? }.into())
}

/// Which library a process really runs, and in which precision: "warmccd 0.2.0 double", a
/// string that lives as long as the library.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn ccdImplementation() -> *const c_char {
    #[cfg(not(feature = "single"))]
    const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " double\0");
    #[cfg(feature = "single")]
    const NAME: &str = concat!("warmccd ", env!("CARGO_PKG_VERSION"), " single\0");
    NAME.as_ptr().cast()
}
