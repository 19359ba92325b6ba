// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The global minimum penetration, proven (expanding polytope).
//!
//! PD = min over unit n of h(n), h(n) = n·s(n) the support value of D. Two facts bound it:
//!
//! - *Upper*: h(n) of any n. Moving obj2 by h(n)·n separates the objects.
//! - *Lower*: take triangles whose corners are support points, closed as a surface and
//!   each with the origin on its inner side. Radial projection maps such a surface onto
//!   the sphere with all orientations alike, so it winds around the origin; so does
//!   every sphere around the origin that no triangle reaches, and that ball lies in the
//!   hull of the corners, hence in D. PD is at least the distance from the origin to the
//!   nearest *triangle*. The surface need not be convex: convexity decides how fast the
//!   bound rises, not whether it holds.
//!
//! The distance from the origin to a triangle is bounded from below by the least n·v of
//! its corners v, for any unit n; with n the normal that is the distance to its plane, and
//! it stays a bound when a sliver's normal is mostly rounding error. The nearest triangle
//! of a convex surface is one that the origin projects into: the others are passed over.
//!
//! The nearest face nearer than upper − tolerance is taken from a list, the support point
//! along its normal replaces all faces it sees, and the upper bound is the least h met.
//! Faces at least upper − tolerance away are never looked at again, so where the minimum
//! is isolated the surface stays coarse away from it. It ends when upper − lower is
//! within the tolerance.
//!
//! The start is a tetrahedron of given points, or of such as are asked for one after the
//! other towards the origin. It need not hold the origin: a face with the origin outside
//! is the nearest of all. That the objects overlap is proven when none is left. Where the
//! origin ends up hardly inside or not at all, [`gjk`] separates or finds it in the hull
//! of points, to rounding: yes or no never depends on the tolerance. D flat in some
//! direction, to rounding, is a touch.
//!
//! *Tried and left out*, on the pair sets of the benchmark: no adjacency, all faces packed
//! side by side and held against every point (shorter; a tenth faster on boxes, a quarter
//! slower on curved objects, whose polytopes have sixty faces); two new faces at a time in
//! packed arithmetic (the same time: each waits for its square root as long); expanding
//! the newest faces first (3 to 7 % more support points); leaving points out of the mean
//! direction by what they would see, not by adjacency (5 % fewer support points on boxes,
//! a third more on ellipsoids).
//!
//! Departures from libccd: tolerances are depths (libccd compares squared metres), all
//! faces that the new point sees go (libccd splits one), no test is absolute, and an
//! origin on a face is no special case.

use crate::barycentric;
use crate::contact::{Answer, Penetration, Settings};
use crate::gjk::{self, Overlap};
use crate::math::{EPSILON, Real, Vec3, larger, perpendicular, tolerance, unit};
use crate::patch;
use crate::simplex::Simplex;
use crate::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};

/// Index of a point, a face, or a half-edge (4 · face + edge).
type Index = u16;
/// No face: ends a list.
const NONE: Index = Index::MAX;

/// Most points a polytope may have, so that half-edges fit an [`Index`].
pub const MAX_POINTS: usize = 5400;
/// Faces to have room for, per point: a closed surface of V points has 2V − 4, and those
/// that a point replaces by at most V stay until that is done.
pub const FACES_PER_POINT: usize = 3;

/// Most given points that are used.
pub const GIVEN: usize = Known::ROOM;
/// Room for the points of a simplex, and for those that make a flat one solid.
const SIMPLEX: usize = 4;
const WIDEN: usize = 6;
/// Least points of an [`Arena`]: given ones, a few more, and that room.
pub const LEAST_POINTS: usize = 24;

/// So many roundings below a face, a point may see it where the cone would fold otherwise;
/// and a face no wider is a sliver.
const FOLD: Real = 1024.0;
/// In single precision a face need not be a sliver to be turned farther than that.
const TURNED: Real = if cfg!(feature = "single") {
    Real::INFINITY
} else {
    FOLD
};

/// A point above a face by less than this share of the gap hardly narrows it.
const LITTLE: Real = 0.1;

/// Squares of the sizes whose faces' areas can be squared.
#[cfg(not(feature = "single"))]
const SIZES: (Real, Real) = (1e-120, 1e140);
#[cfg(feature = "single")]
const SIZES: (Real, Real) = (1e-13, 1e16);

/// Roundings that a triangle is wider than.
const THIN: Real = 4.0;

/// A triangle of the polytope.
///
/// Corners run counter-clockwise seen from outside. Edge i leads from corner i to corner
/// i + 1. (Arrays of four, so that the low bits of a half-edge are in range.)
#[derive(Clone, Copy, Debug, Default)]
pub struct Face {
    plane: Plane,
    corners: [Index; 4],
    /// Half-edge on the other side of each edge.
    across: [Index; 4],
    /// Number of the insertion that last saw the face from outside, or [`DEAD`].
    mark: Index,
    /// Next in the list of free faces, or of those that an insertion sees.
    next: Index,
    /// Place in the list of open faces, if it is there.
    open: Index,
    /// Its common direction with its neighbours was tried in vain.
    lone: bool,
}

/// Mark of a face that is no more.
const DEAD: Index = Index::MAX;

/// The plane of a triangle.
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    /// The unit normal, outward, and minus the largest normal · corner: what lies above
    /// it is outside.
    lift: [Real; 4],
    /// Lower bound on the distance from the origin to the triangle; negative when the
    /// origin is outside.
    key: Real,
}

impl Plane {
    /// Of a triangle without area: the edges are the neighbours' too. Any point that sees
    /// a neighbour sees it.
    const NONE: Self = Self {
        lift: [0.0, 0.0, 0.0, Real::INFINITY],
        key: Real::INFINITY,
    };

    #[inline(always)]
    fn normal(&self) -> Vec3 {
        Vec3::new(self.lift[0], self.lift[1], self.lift[2])
    }

    #[inline(always)]
    fn offset(&self) -> Real {
        -self.lift[3]
    }

    /// How far `v` lies outside.
    #[inline(always)]
    fn height(&self, v: &Vec3) -> Real {
        let [x, y, z, w] = self.lift;
        (x * v.x + z * v.z) + (y * v.y + w)
    }
}

/// A triangle abp by the ways from p to a and b.
struct Wedge {
    a: Vec3,
    b: Vec3,
    /// Their cross product: outward, as long as twice the area.
    normal: Vec3,
    area2: Real,
    /// Its products with p, and the largest and the least of those with a − p, b − p and
    /// 0: rounding, but of a sliver.
    at: Real,
    above: Real,
    below: Real,
}

impl Wedge {
    /// `rounding`: of the points.
    #[inline(always)]
    fn new([va, vb, p]: [&Vec3; 3], a: Vec3, b: Vec3, rounding: Real) -> Self {
        let wedge = Self::of(a, b, a.cross(&b), p);
        let spread = wedge.above - wedge.below;
        if spread * spread > rounding * rounding * wedge.area2 {
            return Self::needle(a, b, &(vb - va), p);
        }
        wedge
    }

    #[inline(always)]
    fn of(a: Vec3, b: Vec3, normal: Vec3, p: &Vec3) -> Self {
        let (da, db) = (normal.dot(&a), normal.dot(&b));
        Self {
            a,
            b,
            normal,
            area2: normal.norm_squared(),
            at: normal.dot(p),
            above: larger(larger(da, db), 0.0),
            below: lesser(lesser(da, db), 0.0),
        }
    }

    /// Of two long edges, almost parallel, the product is rounding; not so of the short
    /// third one, from a to b, and the shorter of them.
    #[cold]
    fn needle(a: Vec3, b: Vec3, ab: &Vec3, p: &Vec3) -> Self {
        let shorter = if a.norm_squared() < b.norm_squared() {
            a
        } else {
            b
        };
        Self::of(a, b, shorter.cross(ab), p)
    }

    #[inline(always)]
    fn plane(&self) -> Plane {
        if !(self.area2 > 0.0) {
            return Plane::NONE;
        }
        let by = 1.0 / self.area2.sqrt();
        let n = &self.normal;
        Plane {
            lift: [n.x * by, n.y * by, n.z * by, -(self.at + self.above) * by],
            key: (self.at + self.below) * by,
        }
    }

    /// Is a point, seen from p, on the outer side?
    #[inline(always)]
    fn hides(&self, way: &Vec3) -> bool {
        self.normal.dot(way) > self.above
    }

    /// Is one corner on the line through the others, to `rounding`? A plane through these is
    /// as good as any.
    #[inline(always)]
    fn thin(&self, rounding: Real) -> bool {
        let edge2 = larger(self.a.norm_squared(), self.b.norm_squared());
        !(self.area2 > THIN * THIN * rounding * rounding * edge2)
    }

    /// Does the origin project beyond an edge, so that a neighbour is nearer?
    ///
    /// By more than a share of the edge and rounding: a projection onto an edge is inside
    /// of both faces. A sliver's plane is tilted by `rounding` over its width, and as much
    /// of the distance does the projection stray.
    #[inline(always)]
    fn aside(&self, p: &Vec3, rounding: Real) -> bool {
        // Areas times areas: of the projection and the edge across from each corner, twice.
        let turned = p.cross(&self.normal);
        let (a, b) = (self.b.dot(&turned), -self.a.dot(&turned));
        let edge2 = larger(self.a.norm_squared(), self.b.norm_squared());
        let p2 = p.norm_squared();
        let slack = 1e-6 * edge2 + 32.0 * EPSILON * (edge2 + p2);
        let stray = 4.0 * rounding * p2.sqrt() * edge2;
        let least = lesser(lesser(a, b), self.area2 - a - b);
        least < -(slack * self.area2.sqrt() + stray)
    }
}

/// The memory of a query: a point, [`FACES_PER_POINT`] faces, as many entries and an
/// edge for each point.
pub struct Storage<'a> {
    /// Support points of D.
    pub points: &'a mut [SupportPoint],
    /// Faces, live and free.
    pub faces: &'a mut [Face],
    /// Faces that may have to be expanded.
    pub open: &'a mut [Entry],
    /// Scratch.
    pub rim: &'a mut [Edge],
}

/// An open face and its distance.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    key: Real,
    face: Index,
}

/// Where a query gets its memory from.
pub trait Arena {
    /// What there is now. At least [`LEAST_POINTS`].
    fn storage(&mut self) -> Storage<'_>;
    /// Makes it larger and keeps what it holds; up to [`MAX_POINTS`] are asked for.
    fn grow(&mut self) -> Result<(), Fault>;
}

/// Where a query starts.
#[derive(Clone, Copy, Debug)]
pub struct Seed<'a> {
    /// The first direction asked, unit.
    pub dir: Vec3,
    /// Known points of this very D, such as those of a local solution.
    pub points: &'a [SupportPoint],
    /// A known support value and its unit direction.
    pub upper: Option<(Real, Vec3)>,
}

/// The least support value met, and its direction.
#[derive(Clone, Copy)]
struct Upper {
    depth: Real,
    dir: Vec3,
}

/// What a query asks and knows besides the polytope.
struct Query<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    settings: Settings,
    upper: Upper,
    /// Largest square of a witness's distance from the world's origin, and of a point of
    /// D from its own.
    reach2: Real,
    size2: Real,
    /// The tolerance in force.
    tolerance: Real,
    /// Differences of support values below this are rounding.
    rounding: Real,
    /// What coordinates so large cannot resolve.
    grain: Real,
    iterations: u64,
}

/// Why a step of the search ended the query.
enum Stop {
    Miss(Vec3),
    Fault(Fault),
}

impl<A: SupportMap, B: SupportMap> Query<'_, A, B> {
    /// Takes the sizes that rounding and tolerance follow from a point.
    #[inline]
    fn note(&mut self, point: &SupportPoint) {
        let v2 = point.v.norm_squared();
        let reach2 = larger(point.v1.norm_squared(), point.v2.norm_squared());
        if v2 > self.size2 || reach2 > self.reach2 {
            self.size2 = larger(self.size2, v2);
            self.reach2 = larger(self.reach2, reach2);
            self.grain = 2.0 * EPSILON * self.reach2.sqrt();
            self.rounding = 4.0 * EPSILON * self.size2.sqrt();
            self.tolerance = tolerance(
                self.settings.tolerance,
                self.size2.sqrt(),
                self.reach2.sqrt(),
            );
        }
    }

    /// Takes `h`, the support value along `dir`, as upper bound if it is lower.
    #[inline]
    fn lower_to(&mut self, h: Real, dir: &Vec3) {
        if h < self.upper.depth {
            self.upper = Upper {
                depth: h,
                dir: *dir,
            };
        }
    }

    /// Faces at least so far away are proven, with room for the grain that is taken from
    /// the lower bound and for the roundings of the bounds themselves.
    #[inline]
    fn target(&self) -> Real {
        self.upper.depth - (self.tolerance - 2.0 * self.grain)
    }

    /// A point above a face by less than this would add faces and no distance.
    #[inline]
    fn worth(&self) -> Real {
        larger(self.rounding, self.tolerance * 0.125)
    }

    fn penetration(&self, lower: Real, witness: &SupportPoint) -> Penetration {
        let depth = self.upper.depth.max(0.0);
        Penetration {
            depth,
            // The points themselves are rounded.
            depth_lower: (lower - self.grain).clamp(0.0, depth),
            dir: self.upper.dir,
            normal: self.upper.dir,
            point1: witness.v1,
            point2: witness.v2,
            width: 0.0,
            iterations: self.iterations,
        }
    }
}

/// What a search over the polytope came to.
struct Found {
    /// The bounds meet, within the tolerance. Otherwise means ended first.
    proven: bool,
    /// The origin is inside, by more than rounding.
    inside: bool,
    hit: Penetration,
}

/// The global minimum penetration of `md`, from `seed`, within `settings.tolerance`.
///
/// `Hit`: depth − depth_lower is within the tolerance (floored at 8 ulps of the largest
/// coordinate). `Limit`: the cap on iterations or points came first; depth is sound and
/// depth_lower proven all the same. `Miss`: strictly apart.
pub fn minimum<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    seed: &Seed<'_>,
    settings: &Settings,
    arena: &mut dyn Arena,
) -> Result<Answer, Fault> {
    let first;
    let mut seed = *seed;
    if seed.points.is_empty() {
        let point = md.support(&seed.dir)?;
        let h = seed.dir.dot(&point.v);
        if h < 0.0 {
            return Ok(Answer::Miss(seed.dir));
        }
        first = [point];
        seed.points = &first;
        if seed.upper.is_none_or(|(depth, _)| h < depth) {
            seed.upper = Some((h, seed.dir));
        }
    }
    // Squares of areas must be in range: what is too small or too large for that is
    // looked at through a lens.
    let square = |p: &SupportPoint| p.v.norm_squared();
    let mut size2 = (seed.points.iter()).fold(0.0, |m, p| larger(m, square(p)));
    if size2 > SIZES.0 && size2 < SIZES.1 {
        return measured(md, &seed, settings, arena);
    }
    // Points all near the origin, as a touch shows them, do not tell how large D is.
    let back = -seed.dir;
    let far = md.support(&back)?;
    if back.dot(&far.v) < 0.0 {
        return Ok(Answer::Miss(back));
    }
    size2 = larger(size2, square(&far));
    let in_range = size2 > SIZES.0 && size2 < SIZES.1 || !(size2 > 0.0);
    let scale = if in_range {
        1.0
    } else {
        (2.0 as Real).powi(-(0.5 * size2.log2()) as i32)
    };
    let mut points = [far.magnified(scale); GIVEN];
    let given = seed.points.len().min(GIVEN - 1);
    for (to, from) in points.iter_mut().zip(&seed.points[..given]) {
        *to = from.magnified(scale);
    }
    let magnified = Seed {
        dir: seed.dir,
        points: &points[..given + 1],
        upper: seed.upper.map(|(depth, dir)| (depth * scale, dir)),
    };
    let settings = Settings {
        tolerance: settings.tolerance * scale,
        ..*settings
    };
    md.magnify(scale);
    let answer = measured(md, &magnified, &settings, arena);
    md.magnify(1.0);
    let back = |hit: Penetration| Penetration {
        depth: hit.depth / scale,
        depth_lower: hit.depth_lower / scale,
        point1: hit.point1 / scale,
        point2: hit.point2 / scale,
        width: hit.width / scale,
        ..hit
    };
    answer.map(|answer| match answer {
        Answer::Hit(hit) => Answer::Hit(back(hit)),
        Answer::Limit(hit) => Answer::Limit(back(hit)),
        Answer::Undecided(hit) => Answer::Undecided(back(hit)),
        Answer::Miss(n) => Answer::Miss(n),
    })
}

/// [`minimum`] of objects whose areas can be squared.
fn measured<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    seed: &Seed<'_>,
    settings: &Settings,
    arena: &mut dyn Arena,
) -> Result<Answer, Fault> {
    let (depth, dir) = seed.upper.unwrap_or((Real::INFINITY, seed.dir));
    let mut query = Query {
        md,
        settings: *settings,
        upper: Upper { depth, dir },
        reach2: 0.0,
        size2: 0.0,
        tolerance: 0.0,
        rounding: 0.0,
        grain: 0.0,
        iterations: 0,
    };
    match run(&mut query, seed, arena) {
        Ok(answer) => Ok(answer),
        Err(Stop::Miss(dir)) => Ok(Answer::Miss(dir)),
        Err(Stop::Fault(fault)) => Err(fault),
    }
}

fn run<A: SupportMap, B: SupportMap>(
    query: &mut Query<'_, A, B>,
    seed: &Seed<'_>,
    arena: &mut dyn Arena,
) -> Result<Answer, Stop> {
    let answer = |query: &Query<'_, A, B>, found: Found| {
        // Where rounding ended the search the bounds may meet all the same: an overlap, proven
        // here, is no shallower than 0.
        let gap = found.hit.depth - found.hit.depth_lower;
        if found.proven || gap <= query.tolerance {
            Answer::Hit(found.hit)
        } else {
            Answer::Limit(found.hit)
        }
    };
    let mut polytope = Polytope::new(arena.storage());
    for point in seed.points.iter().take(GIVEN) {
        query.note(point);
        polytope.push(*point);
    }
    polytope.reach_out(query)?;
    // In range are the squares of areas.
    let mut found = None;
    if query.size2 > SIZES.0 && query.size2 < SIZES.1 && polytope.build(query)? {
        let counts = polytope.counts;
        let (end, counts) = search(query, counts, arena)?;
        if end.inside {
            return Ok(answer(query, end));
        }
        found = Some(end);
        polytope = Polytope::resume(arena.storage(), counts);
    }
    // Hardly inside or not at all: yes or no is the other algorithm's.
    polytope.clear();
    let start = polytope.points[0];
    let first = polytope.counts.points;
    let mut given = [start; GIVEN];
    given[..first].copy_from_slice(&polytope.points[..first]);
    // A thin overlap takes many steps: the latest points are kept.
    let room = polytope.points.len() - SIMPLEX - WIDEN;
    let mut next = first;
    let overlap = gjk::search(
        query.md,
        start,
        |n, reach| gjk::farthest(&given[..first], n, reach),
        query.settings.max_iterations,
        |n, w| {
            query.note(w);
            query.lower_to(n.dot(&w.v), n);
            polytope.points[next] = *w;
            polytope.counts.points = polytope.counts.points.max(next + 1);
            next = if next + 1 < room { next + 1 } else { first };
            query.iterations += 1;
        },
    );
    let simplex = match overlap.map_err(Stop::Fault)? {
        Overlap::Yes(simplex, _) => simplex,
        Overlap::No(n) => return Err(Stop::Miss(n)),
        Overlap::Undecided => {
            return Ok(Answer::Undecided(query.penetration(0.0, &start)));
        }
    };
    if let Some(found) = found.filter(|f| f.proven) {
        return Ok(answer(query, found));
    }
    if !(query.size2 > SIZES.0 && query.size2 < SIZES.1) && query.size2 > 0.0 {
        return Ok(Answer::Undecided(query.penetration(0.0, &start)));
    }
    let triangle = polytope.include(&simplex);
    if !polytope.build(query)? {
        return Ok(polytope.touch(query, triangle));
    }
    let counts = polytope.counts;
    let (found, _) = search(query, counts, arena)?;
    Ok(answer(query, found))
}

/// Expands the polytope of `counts` until the bounds meet or means end.
fn search<A: SupportMap, B: SupportMap>(
    query: &mut Query<'_, A, B>,
    mut counts: Counts,
    arena: &mut dyn Arena,
) -> Result<(Found, Counts), Stop> {
    loop {
        let mut polytope = Polytope::resume(arena.storage(), counts);
        let found = polytope.expand(query)?;
        counts = polytope.counts;
        match found {
            Some(found) => return Ok((found, counts)),
            None => arena.grow().map_err(Stop::Fault)?,
        }
    }
}

/// How much of the storage is in use.
#[derive(Clone, Copy)]
struct Counts {
    points: usize,
    /// Faces, with those on the free list.
    faces: usize,
    open: usize,
    /// First of the free list.
    free: Index,
    insertions: Index,
    /// Common directions tried in vain, and the insertion until which none is tried.
    vain: Index,
    plain: Index,
    /// A point well inside the first tetrahedron, hence inside the polytope.
    inner: Vec3,
    /// Least key of the faces that were far enough to be left out of the list.
    dropped: Real,
    /// Least bound of the faces that have lost their planes.
    flat: Real,
    /// The largest lower bound so far.
    lower: Real,
}

impl Counts {
    fn new(points: usize) -> Self {
        Self {
            points,
            faces: 0,
            open: 0,
            free: NONE,
            insertions: 0,
            vain: 0,
            plain: 0,
            inner: Vec3::zeros(),
            dropped: Real::INFINITY,
            flat: Real::INFINITY,
            lower: Real::NEG_INFINITY,
        }
    }
}

/// A new point of the polytope, and the faces that it sees.
struct View {
    p: Index,
    v: Vec3,
    /// A face that the point is above by more sees it.
    rounding: Real,
    /// Number of the insertion.
    stamp: Index,
    /// How many faces, and the latest of them.
    faces: usize,
    last: Index,
}

impl View {
    #[inline(always)]
    fn add(&mut self, faces: &mut [Face], f: Index) {
        let face = &mut faces[usize::from(f)];
        face.mark = self.stamp;
        face.next = self.last;
        self.last = f;
        self.faces += 1;
    }
}

/// An edge of the rim of what a point sees, from both sides.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edge {
    inner: Index,
    outer: Index,
}

/// The face that a new one would fold back on, or lie flat beside, no wider than rounding.
struct Fold {
    on: Index,
    thin: bool,
}

/// A closed surface of triangles.
struct Polytope<'a> {
    points: &'a mut [SupportPoint],
    faces: &'a mut [Face],
    open: &'a mut [Entry],
    rim: &'a mut [Edge],
    counts: Counts,
}

impl<'a> Polytope<'a> {
    fn new(storage: Storage<'a>) -> Self {
        Self::resume(storage, Counts::new(0))
    }

    fn resume(storage: Storage<'a>, counts: Counts) -> Self {
        Self {
            points: storage.points,
            faces: storage.faces,
            open: storage.open,
            rim: storage.rim,
            counts,
        }
    }

    /// Leaves but the latest points, as many as may be given.
    fn clear(&mut self) {
        let last = self.counts.points;
        let first = last.saturating_sub(GIVEN);
        self.points.copy_within(first..last, 0);
        self.counts = Counts::new(last - first);
    }

    #[inline(always)]
    fn v(&self, i: Index) -> Vec3 {
        self.points[usize::from(i)].v
    }

    #[inline(always)]
    fn face(&self, f: Index) -> &Face {
        &self.faces[usize::from(f)]
    }

    /// The faces that there are.
    fn live(&self) -> impl Iterator<Item = (Index, &Face)> {
        (0..)
            .zip(&self.faces[..self.counts.faces])
            .filter(|(_, face)| face.mark != DEAD)
    }

    fn push(&mut self, point: SupportPoint) -> Index {
        let i = self.counts.points;
        self.points[i] = point;
        self.counts.points = i + 1;
        i as Index
    }

    /// The support point along unit `dir` becomes the last point, unless there is a
    /// farther one; its index. What it says of both bounds is taken.
    ///
    /// A callback that errs must not lower the upper bound, nor separate: D reaches as far
    /// as all known points.
    #[inline]
    fn ask<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
        dir: &Vec3,
    ) -> Result<Index, Stop> {
        let at = self.counts.points;
        let point = query.md.support(dir).map_err(Stop::Fault)?;
        query.note(&point);
        query.iterations += 1;
        let mut h = dir.dot(&point.v);
        self.points[at] = point;
        self.counts.points = at + 1;
        if h < query.upper.depth {
            for i in 0..at {
                let d = dir.dot(&self.points[i].v);
                if d > h {
                    h = d;
                    self.points[at] = self.points[i];
                }
            }
            if h < 0.0 {
                return Err(Stop::Miss(*dir));
            }
            query.lower_to(h, dir);
        }
        Ok(at as Index)
    }

    /// Asks for the corners of a tetrahedron that may hold the origin, as far as there are
    /// not as many points: each from the nearest point of the last ones towards the origin.
    fn reach_out<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
    ) -> Result<(), Stop> {
        while self.counts.points < SIMPLEX {
            let [a, b, c] = [0, 1, 2].map(|i| self.points[i].v);
            let towards = match self.counts.points {
                0 | 1 => -a,
                2 => -barycentric::segment(&Vec3::zeros(), &a, &b).point,
                _ => {
                    let normal = (b - a).cross(&(c - a));
                    if normal.dot(&a) > 0.0 {
                        -normal
                    } else {
                        normal
                    }
                }
            };
            // A line through the origin leaves a side to choose.
            let Some(towards) = unit(&towards).or_else(|| Some(perpendicular(&unit(&(b - a))?)))
            else {
                break;
            };
            self.ask(query, &towards)?;
        }
        Ok(())
    }

    /// The points of `simplex` among the polytope's, as a triangle: three of them, or all
    /// with one repeated.
    fn include(&mut self, simplex: &Simplex) -> [Index; 3] {
        let mut triangle = [0; 3];
        for (i, point) in simplex.points().iter().enumerate() {
            let known = &self.points[..self.counts.points];
            let at = match known.iter().position(|p| p.v == point.v) {
                Some(at) => at as Index,
                None => self.push(*point),
            };
            // A simplex of less than three points is a triangle without area.
            for corner in triangle.iter_mut().skip(i) {
                *corner = at;
            }
        }
        triangle
    }

    /// The point that is first by `measure`, and its measure.
    fn farthest(&self, measure: impl Fn(&Vec3) -> Real) -> (Index, Real) {
        let mut best = (0, Real::NEG_INFINITY);
        for (i, point) in self.points[..self.counts.points].iter().enumerate() {
            let m = measure(&point.v);
            if m > best.1 {
                best = (i as Index, m);
            }
        }
        best
    }

    /// The polytope of all points, made solid by new ones where they are flat. `false`: D
    /// itself is flat.
    fn build<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
    ) -> Result<bool, Stop> {
        let a = 0;
        let va = self.v(a);
        let (mut b, far2) = self.farthest(|v| (v - va).norm_squared());
        if far2.sqrt() <= query.rounding {
            let Some(p) = self.widen(query, a, &Vec3::x())? else {
                return Ok(false);
            };
            b = p;
        }
        let along = (self.v(b) - va).normalize();
        let (mut c, far2) = self.farthest(|v| (v - va).cross(&along).norm_squared());
        if far2.sqrt() <= query.rounding {
            let Some(p) = self.widen(query, a, &perpendicular(&along))? else {
                return Ok(false);
            };
            c = p;
        }
        let ac = self.v(c) - va;
        let normal = along.cross(&(ac - along * along.dot(&ac))).normalize();
        let (mut d, far) = self.farthest(|v| (v - va).dot(&normal).abs());
        if far <= query.rounding {
            let Some(p) = self.widen(query, a, &normal)? else {
                return Ok(false);
            };
            d = p;
        }
        // The first face has the fourth point on its inner side.
        if (self.v(d) - va).dot(&normal) > 0.0 {
            core::mem::swap(&mut b, &mut c);
        }
        self.counts.inner = (va + self.v(b) + self.v(c) + self.v(d)) * 0.25;
        let target = query.target();
        for (f, (corners, [x, y, z])) in [
            ([a, b, c], [6, 10, 14]),
            ([a, d, b], [13, 8, 0]),
            ([b, d, c], [5, 12, 1]),
            ([c, d, a], [9, 4, 2]),
        ]
        .into_iter()
        .enumerate()
        {
            let [va, vb, vp] = corners.map(|i| self.v(i));
            let wedge = Wedge::new([&va, &vb, &vp], va - vp, vb - vp, query.rounding);
            let plane = wedge.plane();
            let [i, j, k] = corners;
            self.faces[f] = Face {
                plane,
                corners: [i, j, k, 0],
                across: [x, y, z, 0],
                ..Face::default()
            };
            self.counts.faces = f + 1;
            self.offer(f as Index, plane.key, &wedge, &vp, query.rounding, target);
        }
        // Known twice, a point differs from itself by rounding.
        let least = 4.0 * query.rounding;
        for i in 0..self.counts.points as Index {
            if ![a, b, c, d].contains(&i)
                && let Some(f) = self.lit(i, least)
            {
                self.insert(f, i, query.rounding, target);
            }
        }
        Ok(true)
    }

    /// The support point along `dir` or `-dir`, first towards the origin, unless both are
    /// as far as point `from`, to rounding.
    fn widen<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
        from: Index,
        dir: &Vec3,
    ) -> Result<Option<Index>, Stop> {
        let base = self.v(from);
        let inward = if base.dot(dir) > 0.0 { -dir } else { *dir };
        for dir in [inward, -inward] {
            let p = self.ask(query, &dir)?;
            if (self.v(p) - base).dot(&dir) > query.rounding {
                return Ok(Some(p));
            }
        }
        Ok(None)
    }

    /// The answer where D is flat: the origin lies on `triangle`.
    fn touch<A: SupportMap, B: SupportMap>(
        &self,
        query: &Query<'_, A, B>,
        triangle: [Index; 3],
    ) -> Answer {
        let [a, b, c] = triangle.map(|i| self.v(i));
        let w = barycentric::triangle(&Vec3::zeros(), &a, &b, &c).point;
        Answer::Hit(query.penetration(0.0, &self.combine(triangle, weights(&w, &a, &b, &c))))
    }

    /// The face that point `i` is farthest above, if by more than `rounding`.
    fn lit(&self, i: Index, rounding: Real) -> Option<Index> {
        let p = self.v(i);
        let mut best = (NONE, rounding);
        for (f, face) in self.live() {
            let height = face.plane.height(&p);
            if height > best.1 && height < Real::INFINITY {
                best = (f, height);
            }
        }
        (best.0 != NONE).then_some(best.0)
    }

    /// Replaces all faces that point `p` sees by the cone from p over their rim. `first`
    /// is one of them. `false`: rounding leaves the rim no single loop, or has turned
    /// `first`, whose neighbours are far from seeing p; nothing changed.
    ///
    /// A face sees p when p is above its plane by more than rounding. What decides is
    /// the cone: where it would fold back (the inner point on the outer side of a new
    /// face), the old face across that rim edge sees p after all, by less than rounding.
    /// So all faces keep the inner point on their inner side.
    fn insert(&mut self, first: Index, p: Index, rounding: Real, target: Real) -> bool {
        self.counts.insertions += 1;
        let mut view = View {
            p,
            v: self.v(p),
            rounding,
            stamp: self.counts.insertions,
            faces: 0,
            last: NONE,
        };
        view.add(self.faces, first);
        loop {
            let rim = match self.trace(4 * first, &mut view) {
                None => self.search_rim(&mut view),
                rim => rim,
            };
            let Some(rim) = rim else {
                return false;
            };
            match self.cone(rim, &view, target) {
                Ok(true) => return true,
                Ok(false) => return false,
                // One face more each time: it ends.
                Err(Fold { on, thin })
                    if thin || self.face(on).plane.height(&view.v) > -TURNED * rounding =>
                {
                    view.add(self.faces, on)
                }
                Err(_) => return false,
            }
        }
    }

    /// Finds the faces that the point of `view` sees, and their rim: how many edges.
    ///
    /// One walk along the rim, with the faces seen on its left: from the end of a rim edge
    /// it turns about that corner through the faces seen, up to the next edge whose other
    /// side is hidden. No corner of the hull is swallowed by a support point, so the faces
    /// seen form a tree, which the walk goes around.
    fn trace(&mut self, start: Index, view: &mut View) -> Option<usize> {
        let (faces, edges) = (&mut *self.faces, &mut *self.rim);
        let (mut rim, mut crossings, mut first) = (0, 0, NONE);
        let mut at = start;
        while at != first {
            let outer = faces[face_of(at)].across[edge_of(at)];
            let beyond = &faces[face_of(outer)];
            if beyond.mark != view.stamp {
                if !(beyond.plane.height(&view.v) > view.rounding) {
                    if rim == 0 {
                        (first, crossings) = (at, 0);
                    }
                    *edges.get_mut(rim)? = Edge { inner: at, outer };
                    rim += 1;
                    at = after(at);
                    continue;
                }
                view.add(faces, outer / 4);
            }
            crossings += 1;
            at = after(outer);
            // All around a swallowed corner; and a bound that no closed surface comes to.
            if rim == 0 && at == start || crossings > 3 * faces.len() {
                return None;
            }
        }
        // Else a corner was swallowed: not every edge was crossed both ways.
        let tree = 3 * view.faces == rim + crossings;
        (rim > 2 && (tree || self.enclose(rim, view))).then_some(rim)
    }

    /// Where the corner that the walk began at is swallowed: from one after the other of
    /// the edges of the faces seen.
    #[cold]
    fn search_rim(&mut self, view: &mut View) -> Option<usize> {
        loop {
            let before = view.faces;
            let mut at = view.last;
            while at != NONE {
                let next = self.face(at).next;
                for edge in 4 * at..4 * at + 3 {
                    let rim = self.trace(edge, view);
                    if rim.is_some() {
                        return rim;
                    }
                }
                at = next;
            }
            if view.faces == before {
                return None;
            }
        }
    }

    /// Finds the faces seen that do not touch the rim, and takes those for seen that only
    /// rounding hides among them. Is the rim all there is around them?
    #[cold]
    fn enclose(&mut self, rim: usize, view: &mut View) -> bool {
        loop {
            let before = view.faces;
            let mut at = view.last;
            while at != NONE {
                let Face { across, next, .. } = *self.face(at);
                for outer in across.into_iter().take(3) {
                    let beyond = self.face(outer / 4);
                    if beyond.mark == view.stamp || self.rim[..rim].iter().any(|e| e.outer == outer)
                    {
                        continue;
                    }
                    if !(beyond.plane.height(&view.v) > -4.0 * view.rounding) {
                        return false;
                    }
                    view.add(self.faces, outer / 4);
                }
                at = next;
            }
            if view.faces == before {
                return true;
            }
        }
    }

    /// Puts the cone from the point of `view` over the edges of the rim in the place of
    /// what it sees. `Err`: nothing changed, for it folds back on this face; `false`: for
    /// there is no room.
    fn cone(&mut self, rim: usize, view: &View, target: Real) -> Result<bool, Fold> {
        let vp = view.v;
        let inner = self.counts.inner - vp;
        let (mut free, mut fresh) = (self.counts.free, self.counts.faces as Index);
        let (mut first, mut previous) = (NONE, NONE);
        let mut from = self.begin(self.rim[0].inner);
        let mut va = self.v(from);
        let mut wa = va - vp;
        for i in 0..rim {
            let Edge { outer, .. } = self.rim[i];
            let beyond = &mut self.faces[face_of(outer)];
            let to = beyond.corners[edge_of(outer)];
            let f = if free == NONE { fresh } else { free };
            beyond.across[edge_of(outer)] = 4 * f;
            let vb = self.v(to);
            let wb = vb - vp;
            let wedge = Wedge::new([&va, &vb, &vp], wa, wb, view.rounding);
            let room = usize::from(f) < self.faces.len();
            let thin = wedge.thin(view.rounding);
            if !room || thin || wedge.hides(&inner) {
                self.undo(i);
                let on = outer / 4;
                return if room {
                    Err(Fold { on, thin })
                } else {
                    Ok(false)
                };
            }
            let face = &mut self.faces[usize::from(f)];
            if free == NONE {
                fresh += 1;
            } else {
                free = face.next;
            }
            let plane = wedge.plane();
            face.plane = plane;
            face.corners = [from, to, view.p, 0];
            face.across = [outer, 0, previous.wrapping_mul(4) | 1, 0];
            face.mark = 0;
            face.lone = false;
            if previous == NONE {
                first = f;
            } else {
                self.faces[usize::from(previous)].across[1] = 4 * f + 2;
            }
            self.offer(f, plane.key, &wedge, &vp, view.rounding, target);
            (previous, from, va, wa) = (f, to, vb, wb);
        }
        self.faces[usize::from(previous)].across[1] = 4 * first + 2;
        self.faces[usize::from(first)].across[2] = 4 * previous + 1;
        self.counts.faces = usize::from(fresh);
        // What was seen is free.
        self.counts.free = view.last;
        let mut at = view.last;
        loop {
            self.bury(at);
            let face = &mut self.faces[usize::from(at)];
            if face.next == NONE {
                face.next = free;
                return Ok(true);
            }
            at = face.next;
        }
    }

    /// Takes back the first faces of a cone, up to the one over edge `last`.
    #[cold]
    fn undo(&mut self, last: usize) {
        for i in 0..=last {
            let Edge { inner, outer } = self.rim[i];
            let across = &mut self.faces[face_of(outer)].across[edge_of(outer)];
            let new = core::mem::replace(across, inner) / 4;
            if i < last {
                self.bury(new);
            }
        }
    }

    /// The corner where a half-edge begins.
    #[inline(always)]
    fn begin(&self, edge: Index) -> Index {
        self.faces[face_of(edge)].corners[edge_of(edge)]
    }

    /// Lists a face if it is nearer than `target` and can be the nearest.
    #[inline(always)]
    fn offer(
        &mut self,
        f: Index,
        key: Real,
        wedge: &Wedge,
        p: &Vec3,
        rounding: Real,
        target: Real,
    ) {
        let open = key < target && (key < 0.0 || !wedge.aside(p, rounding));
        self.faces[usize::from(f)].open = self.counts.open as Index;
        // Written all the same, without a branch.
        self.open[self.counts.open] = Entry { key, face: f };
        self.counts.open += usize::from(open);
        if !open {
            self.faces[usize::from(f)].open = NONE;
        }
        let far = if key < target { Real::INFINITY } else { key };
        self.counts.dropped = lesser(self.counts.dropped, far);
    }

    /// Takes the plane from a face that rounding has turned, and the face from the list.
    /// What it bounds the distance by: the triangle's own, unless the origin is outside of
    /// more than a sliver.
    #[cold]
    fn flatten(&mut self, f: Index, rounding: Real) -> Real {
        self.close(f);
        let Face { plane, corners, .. } = *self.face(f);
        self.faces[usize::from(f)].plane = Plane::NONE;
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(|i| self.v(i));
        let (ab, ac) = (b - a, c - a);
        let edge2 = larger(ab.norm_squared(), ac.norm_squared());
        let sliver = ab.cross(&ac).norm_squared() <= (FOLD * rounding).powi(2) * edge2;
        let bound = if plane.key < 0.0 && !sliver {
            plane.key
        } else {
            barycentric::triangle(&Vec3::zeros(), &a, &b, &c)
                .distance2
                .sqrt()
        };
        self.counts.flat = lesser(self.counts.flat, bound);
        bound
    }

    /// Lists the faces that are no longer far enough.
    #[cold]
    fn reopen(&mut self, rounding: Real, target: Real) {
        self.counts.dropped = Real::INFINITY;
        for f in 0..self.counts.faces as Index {
            let Face {
                plane,
                corners,
                mark,
                open,
                ..
            } = *self.face(f);
            if mark != DEAD && open == NONE {
                let [va, vb, vp, _] = corners.map(|i| self.v(i));
                let wedge = Wedge::new([&va, &vb, &vp], va - vp, vb - vp, rounding);
                self.offer(f, plane.key, &wedge, &vp, rounding, target);
            }
        }
    }

    /// Ends the life of a face, but for its place in the list of free ones.
    #[inline(always)]
    fn bury(&mut self, f: Index) {
        self.faces[usize::from(f)].mark = DEAD;
        self.close(f);
    }

    /// Takes a face from the list, if it is there.
    #[inline(always)]
    fn close(&mut self, f: Index) {
        let at = usize::from(self.face(f).open);
        if at < self.counts.open {
            self.counts.open -= 1;
            let last = self.open[self.counts.open];
            self.open[at] = last;
            self.faces[usize::from(last.face)].open = at as Index;
            self.faces[usize::from(f)].open = NONE;
        }
    }

    /// The nearest of the listed faces, and the lower bound that it and all others give.
    #[inline(always)]
    fn nearest(&self) -> (Option<Index>, Real) {
        let mut best = Entry {
            key: Real::INFINITY,
            face: NONE,
        };
        for entry in &self.open[..self.counts.open] {
            if entry.key < best.key {
                best = *entry;
            }
        }
        let lower = lesser(best.key, lesser(self.counts.dropped, self.counts.flat));
        ((best.face != NONE).then_some(best.face), lower)
    }

    /// Expands the nearest face until the bounds meet. `None`: no room for one more point.
    fn expand<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
    ) -> Result<Option<Found>, Stop> {
        loop {
            let (mut top, mut nearest) = self.nearest();
            if top.is_none() && !(nearest >= query.target()) {
                // Larger coordinates than those known before leave less of the tolerance.
                self.reopen(query.rounding, query.target());
                (top, nearest) = self.nearest();
            }
            // What an earlier surface has proven is proven.
            let lower = larger(nearest, self.counts.lower);
            self.counts.lower = lower;
            // Bounds so close that rounding can show no more.
            let close = query.upper.depth - lower <= 16.0 * query.grain;
            let proven = lower >= query.target() || close && nearest < lower - query.rounding;
            let Some(top) = top.filter(|_| !proven) else {
                return Ok(Some(self.finish(query, lower, proven)));
            };
            if query.iterations >= query.settings.max_iterations || self.counts.points >= MAX_POINTS
            {
                return Ok(Some(self.finish(query, lower, false)));
            }
            if self.counts.points >= self.points.len() {
                return Ok(None);
            }
            let (dir, common) = self.aim(top, query.target());
            let p = self.ask(query, &dir)?;
            if lower >= query.target() {
                return Ok(Some(self.finish(query, lower, true)));
            }
            let least = query.worth();
            let vp = self.v(p);
            let face = &mut self.faces[usize::from(top)];
            let height = face.plane.height(&vp);
            let above = height > least;
            let vain = common && !(above && height > LITTLE * (query.upper.depth - lower));
            if vain {
                face.lone = true;
                self.counts.vain += 1;
                self.counts.plain = self.counts.insertions + 2 * self.counts.vain;
            }
            let lit = match above {
                true => Some(top),
                // What p is above beside is a sliver.
                false if close => None,
                false => self.lit(p, least),
            };
            let mut grown = lit.is_some_and(|f| self.insert(f, p, query.rounding, query.target()));
            if above && !grown {
                // What is around it can still grow.
                grown = self.flatten(top, query.rounding) >= query.target();
                if let Some(f) = self.lit(p, least) {
                    self.insert(f, p, query.rounding, query.target());
                }
            }
            if !grown && !vain && !self.measure(top, query.rounding) {
                // Rounding error has the last word.
                return Ok(Some(self.finish(query, lower, close)));
            }
        }
    }

    /// Bounds the distance to the listed face `f` by the normal of the plane through its point
    /// nearest to the origin: no sliver is too thin for that one. Is the bound better than the
    /// one there was, by more than `rounding`?
    #[cold]
    fn measure(&mut self, f: Index, rounding: Real) -> bool {
        let Face { corners, open, .. } = *self.face(f);
        let [a, b, c, _] = corners.map(|i| self.v(i));
        let Some(n) = unit(&barycentric::triangle(&Vec3::zeros(), &a, &b, &c).point) else {
            return false;
        };
        let key = lesser(lesser(n.dot(&a), n.dot(&b)), n.dot(&c));
        let old = self.face(f).plane.key;
        let at = usize::from(open);
        if !(at < self.counts.open && old >= 0.0 && key > old + rounding) {
            return false;
        }
        self.faces[usize::from(f)].plane.key = key;
        self.open[at].key = key;
        true
    }

    /// The direction to ask for face `f`.
    ///
    /// Its normal finds the point farthest above it. But each face nearer than `target`
    /// has to go, so a point that several of them see saves support points: near a smooth
    /// minimum the corners are a Delaunay triangulation of the tangent plane, faces see a
    /// point inside their circumcircles, and a normal leads to the centre of one of them;
    /// a mean of neighbouring normals leads to where they overlap. Measured from a local
    /// solution at 1e-6: spheres 51 → 30 support points a query, ellipsoids 45 → 25,
    /// 162-vertex polytopes 16.4 → 14.4, boxes 8.15 → 8.07 (neighbours alone: 34, 29,
    /// 14.8, 8.08; the order in which faces are taken changes less than 3 %). Where f
    /// does not see the point that the mean leads to (facets), its normal is asked next,
    /// and normals alone for some time. So where the point is above f by [`LITTLE`] alone:
    /// along a ridge the mean can lead back to it for ever, while the slivers between the
    /// ridge and a far corner want points beside that corner.
    ///
    /// `true`: the mean.
    #[inline]
    fn aim(&self, f: Index, target: Real) -> (Vec3, bool) {
        let face = self.face(f);
        let normal = face.plane.normal();
        if face.lone || self.counts.insertions < self.counts.plain {
            return (normal, false);
        }
        let near = |f: Index| {
            let g = self.face(f);
            (g.plane.key < target && g.plane.normal().dot(&normal) > 0.0).then_some(g)
        };
        let mut sum = normal;
        for &edge in &face.across[..3] {
            let Some(neighbour) = near(edge / 4) else {
                continue;
            };
            sum += neighbour.plane.normal();
            for other in [after(edge), after(after(edge))] {
                let beyond = neighbour.across[edge_of(other)];
                if let Some(second) = near(beyond / 4) {
                    sum += second.plane.normal() * 0.5;
                }
            }
        }
        // At least as long as the face's own normal: all are on its side.
        (sum / sum.norm(), true)
    }

    /// The answer of the upper bound: its witnesses where the ray along its direction
    /// leaves the polytope.
    ///
    /// There t·dir is in D with lower <= t <= upper: the two witnesses are apart along
    /// dir alone, by the depth within the tolerance.
    fn finish<A: SupportMap, B: SupportMap>(
        &self,
        query: &Query<'_, A, B>,
        lower: Real,
        proven: bool,
    ) -> Found {
        #[cfg(test)]
        tests::check(self, query.rounding, lower);
        let dir = query.upper.dir;
        let end = dir * query.upper.depth;
        let error = query.tolerance + query.rounding;
        // The ray leaves a convex surface where it crosses the first of the planes: by the
        // end, and of coplanar faces by the one that has the spot inside. The shares of the
        // corners of a sliver are rounding: what counts is where they lead.
        let mut best = (Real::INFINITY, [0; 3], [1.0, 0.0, 0.0]);
        for (_, Face { plane, corners, .. }) in self.live() {
            let rise = dir.dot(&plane.normal());
            if rise > 0.0 && plane.offset() <= rise * (query.upper.depth + error) {
                let [i, j, k, _] = *corners;
                let [a, b, c] = [i, j, k].map(|i| self.v(i));
                let w = [&b.cross(&c), &c.cross(&a), &a.cross(&b)].map(|x| larger(dir.dot(x), 0.0));
                let w = w.map(|x| x / (w[0] + w[1] + w[2]));
                let distance2 = (mix(&a, &b, &c, &w) - end).norm_squared();
                if distance2 < best.0 {
                    best = (distance2, [i, j, k], w);
                }
            }
        }
        if best.0 > error * error {
            // The origin is on a face, to rounding.
            best = self.nearest_to(&end);
        }
        let witness = self.combine(best.1, best.2);
        let face = best.1.map(|i| self.points[usize::from(i)]);
        Found {
            proven,
            inside: lower > 4.0 * query.rounding + 4.0 * query.grain,
            hit: Penetration {
                width: patch::width(&face, &dir, error, query.size2.sqrt()),
                ..query.penetration(lower, &witness)
            },
        }
    }

    /// The point of the surface nearest to `p`: its squared distance, a face's corners and
    /// their shares.
    fn nearest_to(&self, p: &Vec3) -> (Real, [Index; 3], [Real; 3]) {
        let mut best = (Real::INFINITY, [0; 3], [1.0, 0.0, 0.0]);
        for (_, face) in self.live() {
            let [i, j, k, _] = face.corners;
            let [a, b, c] = [i, j, k].map(|i| self.v(i));
            let w = barycentric::triangle(p, &a, &b, &c).point;
            let shares = weights(&w, &a, &b, &c);
            let distance2 = (mix(&a, &b, &c, &shares) - p).norm_squared();
            if distance2 < best.0 {
                best = (distance2, [i, j, k], shares);
            }
        }
        best
    }

    /// The convex combination of three points.
    fn combine(&self, corners: [Index; 3], weights: [Real; 3]) -> SupportPoint {
        let [a, b, c] = corners.map(|i| &self.points[usize::from(i)]);
        SupportPoint {
            v: mix(&a.v, &b.v, &c.v, &weights),
            v1: mix(&a.v1, &b.v1, &c.v1, &weights),
            v2: mix(&a.v2, &b.v2, &c.v2, &weights),
        }
    }
}

/// The convex combination of three points, from the first: far from the world's origin
/// weights that miss 1 by a rounding would move it.
#[inline]
fn mix(a: &Vec3, b: &Vec3, c: &Vec3, weights: &[Real; 3]) -> Vec3 {
    a + (b - a) * weights[1] + (c - a) * weights[2]
}

/// The smaller of two numbers, as [`larger`].
#[inline(always)]
fn lesser(x: Real, y: Real) -> Real {
    if x < y { x } else { y }
}

#[inline(always)]
fn face_of(edge: Index) -> usize {
    usize::from(edge / 4)
}

#[inline(always)]
fn edge_of(edge: Index) -> usize {
    usize::from(edge % 4)
}

/// The half-edge after `edge` on its face.
#[inline(always)]
fn after(edge: Index) -> Index {
    if edge % 4 == 2 { edge - 2 } else { edge + 1 }
}

/// Barycentric coordinates of `w`, a point of triangle abc.
fn weights(w: &Vec3, a: &Vec3, b: &Vec3, c: &Vec3) -> [Real; 3] {
    let n = (b - a).cross(&(c - a));
    let share = |x: &Vec3, y: &Vec3| n.dot(&(x - w).cross(&(y - w))).max(0.0);
    let shares = [share(b, c), share(c, a), share(a, b)];
    let sum = shares[0] + shares[1] + shares[2];
    if sum > 0.0 {
        return shares.map(|x| x / sum);
    }
    // No area: along the longest edge.
    let edges = [
        (0, 1, b - a, w - a),
        (1, 2, c - b, w - b),
        (2, 0, a - c, w - c),
    ];
    let mut best = ([1.0, 0.0, 0.0], 0.0);
    for (from, to, edge, at) in edges {
        let length2 = edge.norm_squared();
        if length2 > best.1 {
            let t = (at.dot(&edge) / length2).clamp(0.0, 1.0);
            let mut weights = [0.0; 3];
            weights[from] = 1.0 - t;
            weights[to] = t;
            best = (weights, length2);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, corners, ellipsoid, placed};

    struct Vecs {
        points: Vec<SupportPoint>,
        faces: Vec<Face>,
        open: Vec<Entry>,
        rim: Vec<Edge>,
    }

    impl Vecs {
        fn new() -> Self {
            let mut vecs = Self {
                points: vec![],
                faces: vec![],
                open: vec![],
                rim: vec![],
            };
            vecs.resize(LEAST_POINTS);
            vecs
        }

        fn resize(&mut self, n: usize) {
            self.points.resize(n, SupportPoint::default());
            self.faces.resize(n * FACES_PER_POINT, Face::default());
            self.open.resize(n * FACES_PER_POINT, Entry::default());
            self.rim.resize(n, Edge::default());
        }
    }

    impl Arena for Vecs {
        fn storage(&mut self) -> Storage<'_> {
            Storage {
                points: &mut self.points,
                faces: &mut self.faces,
                open: &mut self.open,
                rim: &mut self.rim,
            }
        }

        fn grow(&mut self) -> Result<(), Fault> {
            self.resize((2 * self.points.len()).min(MAX_POINTS));
            Ok(())
        }
    }

    /// The surface is closed and of one piece, and convex to rounding.
    pub fn check(polytope: &Polytope<'_>, rounding: Real, lower: Real) {
        let live: Vec<Index> = (0..polytope.counts.faces as Index)
            .filter(|&f| polytope.face(f).mark != DEAD)
            .collect();
        let mut corners = std::collections::BTreeSet::new();
        for &f in &live {
            let face = polytope.face(f);
            corners.extend(&face.corners[..3]);
            for (i, other) in face.across.into_iter().take(3).enumerate() {
                let half = 4 * f + i as Index;
                let g = polytope.face(other / 4);
                assert!(g.mark != DEAD);
                assert_eq!(g.across[usize::from(other % 4)], half);
                let begin = |edge| polytope.face(edge / 4).corners[edge_of(edge)];
                assert_eq!(begin(other), begin(after(half)));
                assert_eq!(begin(after(other)), begin(half));
            }
        }
        assert_eq!(live.len(), 2 * corners.len() - 4);
        for &f in &live {
            let face = polytope.face(f);
            if face.plane.key == Real::INFINITY {
                // Without a plane.
                continue;
            }
            let [a, b, c, _] = face.corners.map(|i| polytope.v(i));
            let distance2 = barycentric::triangle(&Vec3::zeros(), &a, &b, &c).distance2;
            // Both faces of an edge that rounding dents take the other for the nearer.
            assert!(face.plane.key < 0.0 || lower <= distance2.sqrt() + 2.0 * rounding);
            for &i in &corners {
                let height = face.plane.height(&polytope.v(i));
                // The plane of a face as small as rounding may tilt; what the surface
                // lacks there is the tilt times the width.
                let area = (b - a).cross(&(c - a)).norm();
                let reach = (b - a).norm().max((c - a).norm()).max((c - b).norm());
                let dent = height.min(height / (polytope.v(i) - a).norm() * (area / reach));
                assert!(
                    !(dent > 8.0 * rounding),
                    "dent {dent:e}, rounding {rounding:e}"
                );
            }
        }
    }

    fn solve<A: SupportMap, B: SupportMap>(a: A, b: B, tolerance: Real) -> Answer {
        let md = MinkowskiDifference::new(a, b);
        let settings = Settings {
            tolerance,
            max_iterations: 2000,
        };
        let seed = Seed {
            dir: Vec3::x(),
            points: &[],
            upper: None,
        };
        let answer = minimum(&md, &seed, &settings, &mut Vecs::new()).unwrap();
        if let Answer::Hit(hit) | Answer::Limit(hit) = &answer {
            let h = md.support(&hit.dir).unwrap().v.dot(&hit.dir);
            assert!((hit.dir.norm() - 1.0).abs() <= 4.0 * EPSILON);
            assert!(h <= hit.depth + 4.0 * EPSILON * h.abs(), "unsound");
            assert!(hit.depth_lower <= hit.depth);
        }
        answer
    }

    fn sphere(c: Vec3, r: Real) -> impl SupportMap {
        move |d: &Vec3| c + d * r
    }

    /// A box whose support point takes sign `tie` where the direction is flat.
    fn cuboid(c: Vec3, half: Vec3, tie: Real) -> impl SupportMap {
        move |d: &Vec3| c + half.zip_map(d, |h, x| h.copysign(if x == 0.0 { tie } else { x }))
    }

    fn hull(points: Vec<Vec3>) -> impl SupportMap {
        move |d: &Vec3| {
            *points
                .iter()
                .max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)))
                .unwrap()
        }
    }

    #[track_caller]
    fn expect(answer: Answer, truth: Real, tolerance: Real, size: Real) {
        let slack = tolerance + 64.0 * EPSILON * size;
        match answer {
            Answer::Hit(hit) => {
                assert!((hit.depth - truth).abs() <= slack, "{} {truth}", hit.depth);
                assert!(hit.depth - hit.depth_lower <= slack);
                assert!(hit.depth_lower <= truth + 64.0 * EPSILON * size);
                let apart = hit.point1 - hit.point2;
                assert!((apart.dot(&hit.dir) - hit.depth).abs() <= slack);
                let across = (apart - hit.dir * apart.dot(&hit.dir)).norm();
                assert!(across <= (2.0 * truth * slack).sqrt() + slack);
            }
            other => panic!("{other:?}, depth {truth}"),
        }
    }

    /// libccd answers 2e-16 for the first of these.
    #[test]
    fn spheres_at_every_scale() {
        for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for offset in [
                Vec3::new(0.3, 0.2, 0.1),
                Vec3::new(0.0, 0.0, 0.5),
                Vec3::new(1.9, 0.0, 0.0),
                Vec3::new(-1.1, 1.2, 1.1),
            ] {
                let c = offset * scale;
                let a = sphere(Vec3::zeros(), scale);
                let b = sphere(c, scale);
                let tolerance = 1e-6 * scale;
                expect(
                    solve(a, b, tolerance),
                    2.0 * scale - c.norm(),
                    tolerance,
                    3.0 * scale,
                );
            }
        }
    }

    /// All pairs of cubes on a grid, so that support points tie, faces are coplanar
    /// and the origin lies on vertices, edges and faces of D.
    #[test]
    fn cubes_on_a_grid() {
        for (tie1, tie2) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            for i in 0..1000 {
                let at = [i / 100, i / 10 % 10, i % 10].map(|k| k as Real * 0.125 - 0.5);
                let c = Vec3::from(at);
                let half1 = Vec3::new(0.5, 0.25, 0.375);
                let half2 = Vec3::new(0.25, 0.5, 0.125);
                let truth = (half1 + half2 - c.abs()).min();
                let a = cuboid(Vec3::zeros(), half1, tie1);
                let b = cuboid(c, half2, tie2);
                let answer = solve(a, b, 1e-9);
                if truth >= 0.0 {
                    expect(answer, truth, 1e-9, 1.0);
                } else {
                    assert!(matches!(answer, Answer::Miss(_)));
                }
            }
        }
    }

    #[test]
    fn flat_shapes_touch() {
        let triangle = || {
            hull(vec![
                Vec3::zeros(),
                Vec3::new(1.0, 0.0, 0.0),
                Vec3::new(0.0, 1.0, 0.0),
            ])
        };
        let across = hull(vec![Vec3::new(0.2, 0.2, -1.0), Vec3::new(0.3, 0.2, 2.0)]);
        let beside = hull(vec![Vec3::new(2.0, 0.2, 0.0), Vec3::new(1.0, 0.2, 0.0)]);
        let within = hull(vec![Vec3::new(2.0, 0.2, 0.0), Vec3::new(0.1, 0.2, 0.0)]);
        let point = |x| hull(vec![Vec3::new(x, 0.25, 0.0)]);
        // Crossing: the shortest way out is over an edge of the triangle.
        let Answer::Hit(hit) = solve(triangle(), across, 1e-9) else {
            panic!()
        };
        assert!(
            hit.depth > 0.1 && hit.depth - hit.depth_lower <= (1e-9 as Real).max(64.0 * EPSILON)
        );
        assert!(matches!(solve(triangle(), beside, 1e-9), Answer::Miss(_)));
        expect(solve(triangle(), within, 1e-9), 0.0, 1e-9, 1.0);
        expect(solve(triangle(), point(0.25), 1e-9), 0.0, 1e-9, 1.0);
        expect(solve(point(0.5), point(0.5), 1e-9), 0.0, 1e-9, 1.0);
        assert!(matches!(
            solve(point(0.5), point(0.75), 1e-9),
            Answer::Miss(_)
        ));
        let plate = cuboid(Vec3::zeros(), Vec3::new(1.0, 1.0, 0.0), 1.0);
        expect(
            solve(
                plate,
                cuboid(Vec3::zeros(), Vec3::new(0.5, 0.3, 0.4), 1.0),
                1e-9,
            ),
            0.4,
            1e-9,
            1.0,
        );
    }

    #[test]
    fn thin_overlaps_hit_and_thin_gaps_miss() {
        let n = Vec3::new(0.6, 0.48, 0.64);
        for exponent in 1..12 {
            let gap = (10.0 as Real).powi(-exponent);
            if gap < 64.0 * EPSILON {
                break;
            }
            let near = solve(
                sphere(Vec3::zeros(), 1.0),
                sphere(n * (2.0 - gap), 1.0),
                1e-4,
            );
            assert!(matches!(near, Answer::Hit(_)), "{gap}: {near:?}");
            let far = solve(
                sphere(Vec3::zeros(), 1.0),
                sphere(n * (2.0 + gap), 1.0),
                1e-4,
            );
            assert!(matches!(far, Answer::Miss(_)), "{gap}: {far:?}");
        }
    }

    /// Random pairs of hulls, boxes and ellipsoids at tolerances down to rounding: the
    /// bounds meet, no support value lies below the lower one, and the surface stays
    /// closed and convex to rounding (asserted by `check` at every end).
    #[test]
    fn bounds_hold_for_random_pairs() {
        type Shape = Box<dyn Fn(&Vec3) -> Vec3>;
        let mut random = Random::new(20);
        let shape = |random: &mut Random, at: Vec3| -> Shape {
            let rotation = random.rotation();
            let extent = |random: &mut Random| random.within(0.1, 1.0);
            let half = Vec3::new(extent(random), extent(random), extent(random));
            match random.within(0.0, 3.0) as u32 {
                0 => Box::new(ellipsoid(half, rotation, at)),
                1 => Box::new(crate::shapes::hull(&placed(&corners(half), &rotation, at))),
                _ => {
                    let n = random.within(4.0, 40.0) as usize;
                    let points = random.points(n, 1.0);
                    Box::new(crate::shapes::hull(&placed(&points, &rotation, at)))
                }
            }
        };
        let mut hits = 0;
        for i in 0..400 {
            let tolerance = [1e-3, 1e-6, 1e-10, 0.0][i % 4];
            let at = random.vector(0.8);
            let a = shape(&mut random, Vec3::zeros());
            let b = shape(&mut random, at);
            let rounding = 64.0 * EPSILON;
            match solve(&a, &b, tolerance) {
                Answer::Hit(hit) => {
                    hits += 1;
                    let gap = hit.depth - hit.depth_lower;
                    assert!(gap <= tolerance + rounding, "pair {i}: gap {gap:e}");
                    for k in 0..200 {
                        let near = hit.dir + random.direction() * (0.5 as Real).powi(k % 30);
                        let n = near.normalize();
                        let h = n.dot(&(a(&n) - b(&-n)));
                        assert!(h >= hit.depth_lower - rounding, "pair {i}: {h}");
                    }
                }
                Answer::Miss(n) => assert!(n.dot(&(a(&n) - b(&-n))) < 0.0),
                other => panic!("pair {i}: {other:?}"),
            }
        }
        assert!(hits > 200, "{hits}");
    }

    /// Points inside are swallowed by the ones that follow, in any order.
    #[test]
    fn given_points_need_not_be_support_points() {
        let half = Vec3::new(0.5, 0.4, 0.3);
        let mut random = Random::new(21);
        for i in 0..500 {
            let at = random.vector(0.3);
            let md =
                MinkowskiDifference::new(cuboid(Vec3::zeros(), half, 1.0), cuboid(at, half, 1.0));
            let mut points: Vec<_> = (0..GIVEN)
                .map(|_| md.support(&random.direction()).unwrap())
                .collect();
            for k in [i, i / 3, i / 7] {
                let other = points[(k + 1) % GIVEN];
                points[k % GIVEN] = points[k % GIVEN]
                    .middle(&other)
                    .middle(&points[(k + 3) % GIVEN]);
            }
            let seed = Seed {
                dir: Vec3::x(),
                points: &points,
                upper: None,
            };
            let settings = Settings {
                tolerance: 1e-9,
                max_iterations: 100,
            };
            let answer = minimum(&md, &seed, &settings, &mut Vecs::new()).unwrap();
            expect(answer, (half * 2.0 - at.abs()).min(), 1e-9, 1.0);
        }
    }

    /// The way out may cross a face no wider than rounding, on which it is anywhere.
    #[test]
    fn witnesses_are_not_those_of_a_sliver() {
        let mut random = Random::new(22);
        let half = Vec3::new(0.5, 0.4, 0.3);
        for _ in 0..2000 {
            let at = Vec3::new(0.0, 0.0, -random.within(0.4, 0.59));
            let md =
                MinkowskiDifference::new(cuboid(Vec3::zeros(), half, 1.0), cuboid(at, half, 1.0));
            let top = |x: Real, y: Real| {
                let v1 = Vec3::new(0.5 * x, 0.5 * y, -half.z);
                let v2 = at + Vec3::new(-0.5 * x, -0.5 * y, half.z);
                SupportPoint { v: v1 - v2, v1, v2 }
            };
            let (x, y) = (random.within(0.01, 0.1), random.within(0.01, 0.1));
            let tiny = 200.0 * EPSILON;
            let points = [
                top(-x, y),
                top(
                    -x + random.within(-tiny, tiny),
                    y + random.within(-tiny, tiny),
                ),
                top(9.0 * x, -9.0 * y),
                top(9.0 * x, 3.0 * y),
                top(-0.5 * x, -9.0 * y),
                md.support(&Vec3::new(1.0, 0.3, 0.5)).unwrap(),
                md.support(&Vec3::new(-1.0, -0.3, 0.5)).unwrap(),
            ];
            let seed = Seed {
                dir: Vec3::z(),
                points: &points,
                upper: None,
            };
            let settings = Settings {
                tolerance: 1e-9,
                max_iterations: 100,
            };
            let answer = minimum(&md, &seed, &settings, &mut Vecs::new()).unwrap();
            expect(answer, 2.0 * half.z + at.z, 1e-9, 1.0);
        }
    }

    /// A body of revolution about a line through the origin: at the cap the gap is that of
    /// a thousand points on each of its two edges, not of all on one.
    #[test]
    fn a_ridge_does_not_take_all_points() {
        let cone = |c: Vec3, r: Real, half: Real| {
            move |d: &Vec3| {
                let across = (d.x * d.x + d.y * d.y).sqrt();
                if d.z * 2.0 * half >= across * r {
                    c + Vec3::new(0.0, 0.0, half)
                } else {
                    let by = r / larger(across, Real::MIN_POSITIVE);
                    c + Vec3::new(d.x * by, d.y * by, -half)
                }
            }
        };
        let mut random = Random::new(23);
        for _ in 0..20 {
            let (r, half) = (random.within(0.1, 0.5), random.within(0.5, 1.0));
            let a = cone(Vec3::zeros(), r, half);
            let (r, half) = (random.within(0.1, 0.5), random.within(0.5, 1.0));
            let b = cone(Vec3::new(0.0, 0.0, random.within(-0.05, 0.05)), r, half);
            let hit = match solve(a, b, 1e-9) {
                Answer::Limit(hit) => hit,
                // The bounds meet to rounding before the points run out.
                Answer::Hit(hit) if cfg!(feature = "single") => hit,
                other => panic!("{other:?}"),
            };
            let gap = hit.depth - hit.depth_lower;
            assert!(gap < 1e-5, "{gap:e}");
        }
    }

    /// No inscribed polytope proves a sphere round in few points: sound, and no worse.
    #[test]
    fn concentric_spheres_come_to_the_limit() {
        let answer = solve(sphere(Vec3::zeros(), 1.0), sphere(Vec3::zeros(), 0.1), 1e-6);
        let Answer::Limit(hit) = answer else {
            panic!("{answer:?}")
        };
        assert!((hit.depth - 1.1).abs() <= 64.0 * EPSILON);
        assert!(hit.depth_lower > 1.09 && hit.depth_lower <= 1.1);
    }

    #[test]
    fn a_point_that_is_not_finite_is_refused() {
        let md = MinkowskiDifference::new(
            |_: &Vec3| Vec3::new(Real::NAN, 0.0, 0.0),
            sphere(Vec3::zeros(), 1.0),
        );
        let seed = Seed {
            dir: Vec3::x(),
            points: &[],
            upper: None,
        };
        let settings = Settings {
            tolerance: 1e-6,
            max_iterations: 100,
        };
        assert_eq!(
            minimum(&md, &seed, &settings, &mut Vecs::new()),
            Err(Fault::NonFinite)
        );
    }
}
