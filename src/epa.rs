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
//! The nearest face nearer than upper − tolerance is taken from a heap, the support point
//! along its normal replaces all faces it sees, and the upper bound is the least h met.
//! Faces at least upper − tolerance away are never looked at again, so where the minimum
//! is isolated the surface stays coarse away from it. It ends when upper − lower is
//! within the tolerance.
//!
//! The start is [`gjk`]: it separates, or finds the origin in the hull of the points seen
//! (given ones are used before new ones are asked for), to rounding; yes or no never
//! depends on the tolerance. D flat in some direction, to rounding, is a touch.
//!
//! Departures from libccd: tolerances are depths (libccd compares squared metres), all
//! faces that the new point sees go (libccd splits one), no test is absolute, and an
//! origin on a face is no special case.

use crate::contact::{Answer, Penetration, Settings};
use crate::gjk::{self, Overlap};
use crate::math::{EPSILON, Real, Vec3, perpendicular, tolerance};
use crate::nearest;
use crate::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// Index of a point, a face, or a half-edge (4 · face + edge).
type Index = u16;
/// No face: ends a list.
const NONE: Index = Index::MAX;

/// Most points a polytope may have, so that half-edges fit an [`Index`].
pub const MAX_POINTS: usize = 5400;
/// Faces to have room for, per point. A closed surface of V points has 2V − 4; those that
/// wait dead in the heap and those a point replaces need room too.
pub const FACES_PER_POINT: usize = 3;

/// Most given points that are used.
pub const GIVEN: usize = 8;
/// Room for the points of a simplex, and for those that make a flat one solid.
const SIMPLEX: usize = 4;
const WIDEN: usize = 6;
/// Least points of an [`Arena`]: given ones, a few more, and that room.
pub const LEAST_POINTS: usize = 24;

/// Squares of the sizes whose faces' areas can be squared.
#[cfg(not(feature = "single"))]
const SIZES: (Real, Real) = (1e-120, 1e140);
#[cfg(feature = "single")]
const SIZES: (Real, Real) = (1e-13, 1e16);

/// A triangle of the polytope.
///
/// Corners run counter-clockwise seen from outside. Edge i leads from corner i to corner
/// i + 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Face {
    /// Unit, outward.
    normal: Vec3,
    /// Largest `normal · corner`: what lies above it is outside.
    offset: Real,
    /// Lower bound on the distance from the origin to the triangle; negative when the
    /// origin is outside.
    key: Real,
    /// (Four, so that the low bits of a half-edge are in range.)
    corners: [Index; 4],
    /// Half-edge on the other side of each edge.
    across: [Index; 4],
    /// Next in the list of free or of visible faces.
    next: Index,
    queued: bool,
    dead: bool,
    /// Its common direction with its neighbours was tried in vain.
    lone: bool,
    /// Number of the insertion that last looked at the face: 2 · insertion, + 1 if visible.
    seen: Index,
}

impl Face {
    /// A new face in an old one's place.
    #[inline]
    fn renew(&mut self, [a, b, c]: [Index; 3], [d, e, f]: [Index; 3]) {
        self.corners = [a, b, c, 0];
        self.across = [d, e, f, 0];
        self.next = NONE;
        self.queued = false;
        self.dead = false;
        self.lone = false;
        self.seen = 0;
    }

    /// Its three corners.
    #[inline]
    fn corners(&self) -> [Index; 3] {
        let [a, b, c, _] = self.corners;
        [a, b, c]
    }

    /// Sets normal, offset and distance bound from the corners.
    #[inline]
    fn measure(&mut self, a: &Vec3, b: &Vec3, c: &Vec3) {
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let mut normal = ab.cross(&ac);
        // A needle's two long edges would leave no normal but rounding. (Seldom: a choice
        // of the shorter one for each face would cost more in branches foretold wrong.)
        if ac.norm_squared() > 64.0 * bc.norm_squared() {
            normal = ab.cross(&bc);
        }
        let length = normal.norm();
        if !(length > 0.0) {
            // No area and no plane: the edges are the neighbours' too. Any point that sees
            // a neighbour sees it.
            self.normal = Vec3::zeros();
            self.offset = Real::NEG_INFINITY;
            self.key = Real::INFINITY;
            return;
        }
        let normal = normal * (1.0 / length);
        let (da, db, dc) = (normal.dot(a), normal.dot(b), normal.dot(c));
        self.normal = normal;
        self.offset = larger(larger(da, db), dc);
        self.key = lesser(lesser(da, db), dc);
    }
}

/// The memory of a query: a point, [`FACES_PER_POINT`] faces and as many heap slots for
/// each point.
pub struct Storage<'a> {
    /// Support points of D.
    pub points: &'a mut [SupportPoint],
    /// Faces, live and free.
    pub faces: &'a mut [Face],
    /// Heap of faces.
    pub heap: &'a mut [Entry],
}

/// A face in the heap.
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
    /// Known support points of this very D, such as those of a local solution.
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
    /// The support point along unit `dir`, and what it says of both bounds.
    ///
    /// A callback that errs must not lower the upper bound, nor separate: D reaches as far
    /// as all `known` points.
    #[inline]
    fn ask(&mut self, dir: &Vec3, known: &[SupportPoint]) -> Result<SupportPoint, Stop> {
        let mut point = self.md.support(dir).map_err(Stop::Fault)?;
        self.note(&point);
        let mut h = dir.dot(&point.v);
        if h < self.upper.depth {
            for p in known {
                let d = dir.dot(&p.v);
                if d > h {
                    (h, point) = (d, *p);
                }
            }
            if h < 0.0 {
                return Err(Stop::Miss(*dir));
            }
            self.lower_to(h, dir);
        }
        Ok(point)
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

    /// Faces at least so far away are proven, with room for the grain that is taken from
    /// the lower bound and for the roundings of the bounds themselves.
    #[inline]
    fn target(&self) -> Real {
        self.upper.depth - (self.tolerance - 2.0 * self.grain)
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
            iterations: self.iterations,
        }
    }
}

/// What a search over the polytope came to.
enum Outcome {
    /// Proven within the tolerance, or (`false`) at the end of means.
    Done(bool, Penetration),
    /// No room for one more point.
    Full,
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
    let mut query = Query {
        md,
        settings: *settings,
        upper: Upper {
            depth: Real::INFINITY,
            dir: seed.dir,
        },
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
    let mut polytope = Polytope::new(arena.storage());
    let given = &seed.points[..seed.points.len().min(GIVEN)];
    for point in given {
        query.note(point);
        polytope.push(*point);
    }
    if let Some((depth, dir)) = seed.upper {
        query.upper = Upper { depth, dir };
    }
    let start = match given.first() {
        Some(point) => *point,
        None => {
            let point = query.ask(&seed.dir, &[])?;
            polytope.push(point);
            point
        }
    };
    // A thin overlap takes many steps: the latest points are kept.
    let first = polytope.counts.points;
    let room = polytope.points.len() - SIMPLEX - WIDEN;
    let mut next = first;
    let overlap = gjk::search(
        query.md,
        start,
        given,
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
    // Squares of areas must be in range.
    if !(query.size2 > SIZES.0 && query.size2 < SIZES.1) && query.size2 > 0.0 {
        return Ok(Answer::Undecided(query.penetration(0.0, &start)));
    }
    if let Some(answer) = polytope.build(query, simplex.points())? {
        return Ok(answer);
    }
    loop {
        match polytope.expand(query)? {
            Outcome::Done(true, found) => return Ok(Answer::Hit(found)),
            Outcome::Done(false, found) => return Ok(Answer::Limit(found)),
            Outcome::Full => {
                let counts = polytope.counts;
                arena.grow().map_err(Stop::Fault)?;
                polytope = Polytope {
                    counts,
                    ..Polytope::new(arena.storage())
                };
            }
        }
    }
}

/// How much of the storage is in use.
#[derive(Clone, Copy)]
struct Counts {
    points: usize,
    faces: usize,
    heap: usize,
    /// Faces on the free list.
    free: usize,
    first_free: Index,
    insertions: Index,
    /// Common directions tried in vain, and the insertion until which none is tried.
    vain: Index,
    plain: Index,
    /// A point well inside the first tetrahedron, hence inside the polytope.
    inner: Vec3,
    /// Least key of the faces that were far enough to be left out of the heap.
    dropped: Real,
}

impl Counts {
    /// Takes a free face; there is one.
    #[inline]
    fn allocate(&mut self, faces: &[Face]) -> Index {
        let f = self.first_free;
        if f == NONE {
            self.faces += 1;
            return (self.faces - 1) as Index;
        }
        self.first_free = faces[usize::from(f)].next;
        self.free -= 1;
        f
    }

    #[inline]
    fn release(&mut self, faces: &mut [Face], f: Index) {
        let face = &mut faces[usize::from(f)];
        face.dead = true;
        face.next = self.first_free;
        self.first_free = f;
        self.free += 1;
    }
}

/// A closed surface of triangles.
struct Polytope<'a> {
    points: &'a mut [SupportPoint],
    faces: &'a mut [Face],
    heap: &'a mut [Entry],
    counts: Counts,
}

impl<'a> Polytope<'a> {
    fn new(storage: Storage<'a>) -> Self {
        Self {
            points: storage.points,
            faces: storage.faces,
            heap: storage.heap,
            counts: Counts {
                points: 0,
                faces: 0,
                heap: 0,
                free: 0,
                first_free: NONE,
                insertions: 0,
                vain: 0,
                plain: 0,
                inner: Vec3::zeros(),
                dropped: Real::INFINITY,
            },
        }
    }

    #[inline]
    fn v(&self, i: Index) -> Vec3 {
        self.points[usize::from(i)].v
    }

    #[inline]
    fn face(&self, f: Index) -> &Face {
        &self.faces[usize::from(f)]
    }

    #[inline]
    fn face_mut(&mut self, f: Index) -> &mut Face {
        &mut self.faces[usize::from(f)]
    }

    fn push(&mut self, point: SupportPoint) -> Index {
        let i = self.counts.points;
        self.points[i] = point;
        self.counts.points = i + 1;
        i as Index
    }

    /// The point before `end` that is first by `measure`, and its measure.
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

    /// The polytope of all points, made solid by new ones where they are flat; `simplex`,
    /// of some of them, holds the origin. Where D itself is flat the origin touches it:
    /// that answer ends the query.
    fn build<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
        simplex: &[SupportPoint],
    ) -> Result<Option<Answer>, Stop> {
        let mut triangle = [0; 3];
        for (i, point) in simplex.iter().enumerate() {
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
        let a = triangle[0];
        let va = self.v(a);
        let (mut b, far2) = self.farthest(|v| (v - va).norm_squared());
        if far2.sqrt() <= query.rounding {
            let Some(p) = self.widen(query, a, &Vec3::x())? else {
                return Ok(Some(self.touch(query, triangle)));
            };
            b = p;
        }
        let along = (self.v(b) - va).normalize();
        let (mut c, far2) = self.farthest(|v| (v - va).cross(&along).norm_squared());
        if far2.sqrt() <= query.rounding {
            let Some(p) = self.widen(query, a, &perpendicular(&along))? else {
                return Ok(Some(self.touch(query, triangle)));
            };
            c = p;
        }
        let ac = self.v(c) - va;
        let normal = along.cross(&(ac - along * along.dot(&ac))).normalize();
        let (mut d, far) = self.farthest(|v| (v - va).dot(&normal).abs());
        if far <= query.rounding {
            let Some(p) = self.widen(query, a, &normal)? else {
                return Ok(Some(self.touch(query, triangle)));
            };
            d = p;
        }
        // The first face has the fourth point on its inner side.
        if (self.v(d) - va).dot(&normal) > 0.0 {
            core::mem::swap(&mut b, &mut c);
        }
        self.counts.inner = (va + self.v(b) + self.v(c) + self.v(d)) * 0.25;
        let target = query.target();
        for (corners, across) in [
            ([a, b, c], [6, 10, 14]),
            ([a, d, b], [13, 8, 0]),
            ([b, d, c], [5, 12, 1]),
            ([c, d, a], [9, 4, 2]),
        ] {
            let f = self.counts.allocate(self.faces);
            let [x, y, z] = corners.map(|i| self.v(i));
            let face = self.face_mut(f);
            face.renew(corners, across);
            face.measure(&x, &y, &z);
            self.enqueue(f, target);
        }
        for i in 0..self.counts.points as Index {
            if ![a, b, c, d].contains(&i)
                && let Some(f) = self.lit(i, query.rounding)
            {
                self.insert(f, i, query);
            }
        }
        Ok(None)
    }

    /// The farther of the support points along `dir` and `-dir`, unless both are as far
    /// as point `from`, to rounding.
    fn widen<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
        from: Index,
        dir: &Vec3,
    ) -> Result<Option<Index>, Stop> {
        let base = self.v(from);
        let up = query.ask(dir, &self.points[..self.counts.points])?;
        let down = query.ask(&-dir, &self.points[..self.counts.points])?;
        let (up, down) = (self.push(up), self.push(down));
        let height = (self.v(up) - base).dot(dir);
        let drop = (base - self.v(down)).dot(dir);
        Ok(if height.max(drop) <= query.rounding {
            None
        } else if height >= drop {
            Some(up)
        } else {
            Some(down)
        })
    }

    /// The answer where D is flat: the origin lies on `triangle`.
    fn touch<A: SupportMap, B: SupportMap>(
        &self,
        query: &Query<'_, A, B>,
        triangle: [Index; 3],
    ) -> Answer {
        let [a, b, c] = triangle.map(|i| self.v(i));
        let w = nearest::on_triangle(&Vec3::zeros(), &a, &b, &c).0;
        Answer::Hit(query.penetration(0.0, &self.combine(triangle, weights(&w, &a, &b, &c))))
    }

    /// The face that point `i` is farthest above, if by more than `rounding`.
    fn lit(&self, i: Index, rounding: Real) -> Option<Index> {
        let p = self.v(i);
        let mut best = (NONE, rounding);
        for (f, face) in self.faces[..self.counts.faces].iter().enumerate() {
            let height = face.normal.dot(&p) - face.offset;
            if !face.dead && height > best.1 {
                best = (f as Index, height);
            }
        }
        (best.0 != NONE).then_some(best.0)
    }

    /// Replaces all faces that point `p` sees by the cone from p over their rim. `first`
    /// is one of them. `false`: rounding leaves the rim no single loop; nothing changed.
    ///
    /// A face sees p when p is above its plane by more than rounding. What decides is
    /// the cone: where it would fold back (the inner point on the outer side of a new
    /// face), the old face across that rim edge sees p after all, by less than rounding.
    /// So all faces keep the inner point on their inner side.
    fn insert<A, B>(&mut self, first: Index, p: Index, query: &Query<'_, A, B>) -> bool
    where
        A: SupportMap,
        B: SupportMap,
    {
        let vp = self.v(p);
        let rounding = query.rounding;
        let target = query.target();
        self.counts.insertions += 1;
        let visible = 2 * self.counts.insertions + 1;
        if self.room() < self.counts.points {
            self.purge();
        }

        let mut last = first;
        let seen = self.face_mut(first);
        seen.seen = visible;
        seen.next = NONE;
        let cone = loop {
            let (rim, start) = flood(self.faces, first, &mut last, &vp, rounding, visible);
            if rim < 3 || rim > self.room() {
                return false;
            }
            match self.cone(start, rim, p, visible) {
                Ok(cone) => break cone,
                Err(NONE) => return false,
                Err(folded) => {
                    self.face_mut(last).next = folded;
                    let seen = self.face_mut(folded);
                    seen.seen = visible;
                    seen.next = NONE;
                    last = folded;
                }
            }
        };
        let mut at = first;
        while at != NONE {
            let next = self.face(at).next;
            self.bury(at);
            at = next;
        }
        let mut at = cone;
        while at != NONE {
            let next = self.face(at).next;
            self.enqueue(at, target);
            at = next;
        }
        true
    }

    /// The faces from point `p` to the `rim` edges of the visible faces, the first to
    /// `start`, as a list. Otherwise nothing is changed: `Err` has the face across the
    /// rim that the cone folds back on, or [`NONE`] when the rim is no single loop.
    fn cone(&mut self, start: Index, rim: usize, p: Index, visible: Index) -> Result<Index, Index> {
        let (inner, vp) = (self.counts.inner, self.v(p));
        let Self {
            points,
            faces,
            counts,
            ..
        } = self;
        let faces = &mut **faces;
        let mut oldest = NONE;
        let mut previous = NONE;
        let mut made = 0;
        let mut folded = NONE;
        let mut at = start;
        let mut from = begin(faces, at);
        let mut va = points[usize::from(from)].v;
        loop {
            let outer = faces[face_of(at)].across[edge_of(at)];
            let next = next_rim(faces, at, visible);
            let to = begin(faces, next);
            let vb = points[usize::from(to)].v;
            let f = counts.allocate(faces);
            let face = &mut faces[usize::from(f)];
            face.renew([from, to, p], [outer, 0, previous.wrapping_mul(4) | 1]);
            face.measure(&va, &vb, &vp);
            let folds = face.offset < face.normal.dot(&inner) && face.key < Real::INFINITY;
            faces[face_of(outer)].across[edge_of(outer)] = 4 * f;
            if previous == NONE {
                oldest = f;
            } else {
                let before = &mut faces[usize::from(previous)];
                before.across[1] = 4 * f + 2;
                before.next = f;
            }
            previous = f;
            made += 1;
            if folds {
                folded = outer / 4;
                break;
            }
            (at, from, va) = (next, to, vb);
            if at == start || made == rim {
                break;
            }
        }
        if folded == NONE && made == rim && at == start {
            faces[usize::from(previous)].across[1] = 4 * oldest + 2;
            faces[usize::from(oldest)].across[2] = 4 * previous + 1;
            return Ok(oldest);
        }
        // Undo: back across each rim edge to the visible face, in the same order.
        let mut back = start;
        let mut f = oldest;
        while f != NONE {
            let Face { next, across, .. } = faces[usize::from(f)];
            faces[face_of(across[0])].across[edge_of(across[0])] = back;
            back = next_rim(faces, back, visible);
            counts.release(faces, f);
            f = next;
        }
        Err(folded)
    }

    /// Free faces.
    fn room(&self) -> usize {
        self.faces.len() - self.counts.faces + self.counts.free
    }

    /// Ends a face's life. Its place is free once the heap does not hold it.
    #[inline]
    fn bury(&mut self, f: Index) {
        self.face_mut(f).dead = true;
        if !self.face(f).queued {
            self.counts.release(self.faces, f);
        }
    }

    /// Puts a face nearer than `target` into the heap.
    #[inline]
    fn enqueue(&mut self, f: Index, target: Real) {
        let key = self.face(f).key;
        if key >= target {
            self.counts.dropped = lesser(self.counts.dropped, key);
            return;
        }
        if key >= 0.0 && self.aside(f) {
            return;
        }
        self.face_mut(f).queued = true;
        let mut hole = self.counts.heap;
        self.counts.heap += 1;
        while hole > 0 {
            let parent = (hole - 1) / 2;
            let above = self.heap[parent];
            if !(key < above.key) {
                break;
            }
            self.heap[hole] = above;
            hole = parent;
        }
        self.heap[hole] = Entry { key, face: f };
    }

    /// Does the origin project beyond an edge of the face, so that a neighbour is nearer?
    ///
    /// By more than a share of the edge and rounding: a projection onto an edge is inside
    /// of both faces.
    #[inline]
    fn aside(&self, f: Index) -> bool {
        let face = self.face(f);
        let [a, b, c] = face.corners().map(|i| self.v(i));
        // n·(a × b): twice the area of the edge and the projection.
        let least = lesser(
            lesser(face.normal.dot(&a.cross(&b)), face.normal.dot(&b.cross(&c))),
            face.normal.dot(&c.cross(&a)),
        );
        let slack = 1e-6 * larger((b - a).norm_squared(), (c - a).norm_squared())
            + 16.0 * EPSILON * larger(a.norm_squared(), c.norm_squared());
        least < -slack
    }

    /// Takes the nearest face, dead or alive, out of the heap.
    fn pop(&mut self) {
        let Some(end) = self.counts.heap.checked_sub(1) else {
            return;
        };
        self.counts.heap = end;
        let top = self.heap[0].face;
        self.face_mut(top).queued = false;
        self.sink(0, self.heap[end]);
        if self.face(top).dead {
            self.counts.release(self.faces, top);
        }
    }

    /// Puts `entry` into the hole at `hole` of the heap, or below.
    fn sink(&mut self, mut hole: usize, entry: Entry) {
        let heap = &mut self.heap[..self.counts.heap];
        loop {
            let mut child = 2 * hole + 1;
            if child >= heap.len() {
                break;
            }
            if child + 1 < heap.len() && heap[child + 1].key < heap[child].key {
                child += 1;
            }
            if !(heap[child].key < entry.key) {
                break;
            }
            heap[hole] = heap[child];
            hole = child;
        }
        if let Some(place) = heap.get_mut(hole) {
            *place = entry;
        }
    }

    /// Takes all dead faces out of the heap.
    fn purge(&mut self) {
        let mut kept = 0;
        for i in 0..self.counts.heap {
            let entry = self.heap[i];
            if self.face(entry.face).dead {
                self.face_mut(entry.face).queued = false;
                self.counts.release(self.faces, entry.face);
            } else {
                self.heap[kept] = entry;
                kept += 1;
            }
        }
        self.counts.heap = kept;
        for i in (0..kept / 2).rev() {
            self.sink(i, self.heap[i]);
        }
    }

    /// The nearest live face, and the lower bound that it and the faces out of the heap
    /// give.
    fn nearest(&mut self) -> (Option<Index>, Real) {
        while self.counts.heap > 0 {
            let Entry { key, face } = self.heap[0];
            if !self.face(face).dead {
                return (Some(face), lesser(key, self.counts.dropped));
            }
            self.pop();
        }
        (None, self.counts.dropped)
    }

    /// Expands the nearest face until the bounds meet.
    fn expand<A: SupportMap, B: SupportMap>(
        &mut self,
        query: &mut Query<'_, A, B>,
    ) -> Result<Outcome, Stop> {
        loop {
            let (top, lower) = self.nearest();
            let proven = lower >= query.target();
            let Some(top) = top.filter(|_| !proven) else {
                return Ok(Outcome::Done(proven, self.finish(query, lower, top)));
            };
            if query.iterations >= query.settings.max_iterations || self.counts.points >= MAX_POINTS
            {
                return Ok(Outcome::Done(false, self.finish(query, lower, Some(top))));
            }
            if self.counts.points >= self.points.len() {
                return Ok(Outcome::Full);
            }
            query.iterations += 1;

            let dir = self.aim(top, query.target());
            let point = query.ask(&dir, &self.points[..self.counts.points])?;
            if lower >= query.target() {
                return Ok(Outcome::Done(true, self.finish(query, lower, Some(top))));
            }
            // A point above by less than this would add faces and no distance.
            let least = larger(query.rounding, query.tolerance * 0.125);
            let face = self.face_mut(top);
            let height = face.normal.dot(&point.v) - face.offset;
            let vain = !(height > least) && !face.lone;
            if vain {
                face.lone = true;
                self.counts.vain += 1;
                self.counts.plain = self.counts.insertions + 2 * self.counts.vain;
            }
            let p = self.push(point);
            let lit = if height > least {
                Some(top)
            } else {
                self.lit(p, least)
            };
            let grown = lit.is_some_and(|f| self.insert(f, p, query));
            if !grown && !vain {
                // Rounding error has the last word.
                let close = query.upper.depth - lower <= 16.0 * query.grain;
                return Ok(Outcome::Done(close, self.finish(query, lower, Some(top))));
            }
        }
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
    /// and normals alone for some time.
    fn aim(&self, f: Index, target: Real) -> Vec3 {
        let face = self.face(f);
        if face.lone || self.counts.insertions < self.counts.plain {
            return face.normal;
        }
        let near = |f: Index| {
            let g = self.face(f);
            (g.key < target && g.normal.dot(&face.normal) > 0.0).then_some(g)
        };
        let mut sum = face.normal;
        for &edge in &face.across[..3] {
            let Some(neighbour) = near(edge / 4) else {
                continue;
            };
            sum += neighbour.normal;
            for other in [after(edge), after(after(edge))] {
                let beyond = neighbour.across[usize::from(other % 4)];
                if let Some(second) = near(beyond / 4) {
                    sum += second.normal * 0.5;
                }
            }
        }
        // At least as long as the face's own normal: all are on its side.
        sum / sum.norm()
    }

    /// The answer of the upper bound: its witnesses where the ray along its direction
    /// leaves the polytope.
    ///
    /// There t·dir is in D with lower <= t <= upper: the two witnesses are apart along
    /// dir alone, by the depth within the tolerance. `guess` is looked at first.
    fn finish<A: SupportMap, B: SupportMap>(
        &self,
        query: &Query<'_, A, B>,
        lower: Real,
        guess: Option<Index>,
    ) -> Penetration {
        #[cfg(test)]
        tests::check(self, query.rounding, lower);
        let dir = query.upper.dir;
        let shares = |f: &Face| {
            let [a, b, c] = f.corners().map(|i| self.v(i));
            let w = [
                dir.dot(&b.cross(&c)),
                dir.dot(&c.cross(&a)),
                dir.dot(&a.cross(&b)),
            ];
            let sum = w[0] + w[1] + w[2];
            (w.map(|x| x / sum), sum)
        };
        let mut best: Option<([Index; 3], [Real; 3], Real)> = None;
        for f in guess
            .map(|f| self.face(f))
            .into_iter()
            .chain(&self.faces[..self.counts.faces])
        {
            if f.dead {
                continue;
            }
            let (w, sum) = shares(f);
            let least = w[0].min(w[1]).min(w[2]);
            if sum > 0.0 && best.is_none_or(|b| least > b.2) {
                best = Some((f.corners(), w, least));
                if least >= 0.0 {
                    break;
                }
            }
        }
        let exit = best.map(|(corners, w, _)| {
            let w = w.map(|x| x.max(0.0));
            let sum = w[0] + w[1] + w[2];
            self.combine(corners, w.map(|x| x / sum))
        });
        let end = dir * query.upper.depth;
        let error = query.tolerance + query.rounding;
        let witness = match exit {
            Some(exit) if (exit.v - end).norm() <= error => exit,
            // The origin is on a face, to rounding: the ray crosses nothing clearly.
            _ => self.nearest_to(&end),
        };
        query.penetration(lower, &witness)
    }

    /// The point of the surface nearest to `p`.
    fn nearest_to(&self, p: &Vec3) -> SupportPoint {
        let mut best = (Real::INFINITY, [0; 3], [1.0, 0.0, 0.0]);
        for f in &self.faces[..self.counts.faces] {
            if f.dead {
                continue;
            }
            let [a, b, c] = f.corners().map(|i| self.v(i));
            let (w, distance2) = nearest::on_triangle(p, &a, &b, &c);
            if distance2 < best.0 {
                best = (distance2, f.corners(), weights(&w, &a, &b, &c));
            }
        }
        self.combine(best.1, best.2)
    }

    /// The convex combination of three points, from the first: far from the world's origin
    /// weights that miss 1 by a rounding would move it.
    fn combine(&self, corners: [Index; 3], weights: [Real; 3]) -> SupportPoint {
        let [a, b, c] = corners.map(|i| &self.points[usize::from(i)]);
        let mix = |a: &Vec3, b: &Vec3, c: &Vec3| a + (b - a) * weights[1] + (c - a) * weights[2];
        SupportPoint {
            v: mix(&a.v, &b.v, &c.v),
            v1: mix(&a.v1, &b.v1, &c.v1),
            v2: mix(&a.v2, &b.v2, &c.v2),
        }
    }
}

// One instruction each, unlike the methods, which sort out NaN.
#[inline]
fn larger(x: Real, y: Real) -> Real {
    if x > y { x } else { y }
}

#[inline]
fn lesser(x: Real, y: Real) -> Real {
    if x < y { x } else { y }
}

/// Finds all faces that see the point at `v`, from the ones listed at `first`, and lists
/// them to `last`. Their rim: how many edges, and one of them.
#[inline]
fn flood(
    faces: &mut [Face],
    first: Index,
    last: &mut Index,
    v: &Vec3,
    rounding: Real,
    visible: Index,
) -> (usize, Index) {
    let hidden = visible - 1;
    let (mut rim, mut start) = (0, 0);
    // The list is the queue.
    let mut at = first;
    while at != NONE {
        for edge in 0..3 {
            let other = face_of(faces[usize::from(at)].across[edge]);
            let face = &mut faces[other];
            if face.seen < hidden {
                if face.normal.dot(v) - face.offset > rounding {
                    face.seen = visible;
                    face.next = NONE;
                    faces[usize::from(*last)].next = other as Index;
                    *last = other as Index;
                    continue;
                }
                face.seen = hidden;
            }
            if face.seen == hidden {
                rim += 1;
                start = 4 * at + edge as Index;
            }
        }
        at = faces[usize::from(at)].next;
    }
    (rim, start)
}

/// The rim edge after `edge`: turns about its end through the visible faces.
#[inline]
fn next_rim(faces: &[Face], edge: Index, visible: Index) -> Index {
    let mut at = after(edge);
    // A bound that no closed surface comes to.
    for _ in 0..faces.len() {
        let other = faces[face_of(at)].across[edge_of(at)];
        if faces[face_of(other)].seen != visible {
            break;
        }
        at = after(other);
    }
    at
}

/// The corner where a half-edge begins.
#[inline]
fn begin(faces: &[Face], edge: Index) -> Index {
    faces[face_of(edge)].corners[edge_of(edge)]
}

#[inline]
fn face_of(edge: Index) -> usize {
    usize::from(edge / 4)
}

#[inline]
fn edge_of(edge: Index) -> usize {
    usize::from(edge % 4)
}

/// The half-edge after `edge` on its face.
#[inline]
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
    #[cfg_attr(feature = "single", allow(unused_imports, reason = "its test is not"))]
    use crate::shapes::{Random, corners, ellipsoid, placed};

    struct Vecs {
        points: Vec<SupportPoint>,
        faces: Vec<Face>,
        heap: Vec<Entry>,
    }

    impl Vecs {
        fn new() -> Self {
            let mut vecs = Self {
                points: vec![],
                faces: vec![],
                heap: vec![],
            };
            vecs.resize(LEAST_POINTS);
            vecs
        }

        fn resize(&mut self, n: usize) {
            self.points.resize(n, SupportPoint::default());
            self.faces.resize(n * FACES_PER_POINT, Face::default());
            self.heap.resize(n * FACES_PER_POINT, Entry::default());
        }
    }

    impl Arena for Vecs {
        fn storage(&mut self) -> Storage<'_> {
            Storage {
                points: &mut self.points,
                faces: &mut self.faces,
                heap: &mut self.heap,
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
            .filter(|&f| !polytope.face(f).dead)
            .collect();
        let mut corners = std::collections::BTreeSet::new();
        for &f in &live {
            let face = polytope.face(f);
            corners.extend(face.corners());
            for (i, other) in face.across.into_iter().take(3).enumerate() {
                let half = 4 * f + i as Index;
                let g = polytope.face(other / 4);
                assert!(!g.dead);
                assert_eq!(g.across[usize::from(other % 4)], half);
                assert_eq!(
                    begin(polytope.faces, other),
                    begin(polytope.faces, after(half))
                );
                assert_eq!(
                    begin(polytope.faces, after(other)),
                    begin(polytope.faces, half)
                );
            }
        }
        assert_eq!(live.len(), 2 * corners.len() - 4);
        for &f in &live {
            let face = polytope.face(f);
            let [a, b, c] = face.corners().map(|i| polytope.v(i));
            let (_, distance2) = nearest::on_triangle(&Vec3::zeros(), &a, &b, &c);
            assert!(face.key < 0.0 || lower <= distance2.sqrt() + rounding);
            for &i in &corners {
                let height = face.normal.dot(&polytope.v(i)) - face.offset;
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
    // Scales that single precision's squares cannot follow.
    #[cfg(not(feature = "single"))]
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
