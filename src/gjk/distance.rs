// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap, and how far apart are they? The distance algorithm of Gilbert,
//! Johnson and Keerthi (1988) on D − target, for the target 0 or any other point.
//!
//! A simplex of up to four points of D, and its point nearest to the target. The way from
//! there to the target, of unit length n, is asked next. D lies behind the support plane of
//! n: a support value h(n) <= 0 separates. The new point lies beyond the simplex as seen
//! along n, so that of the new simplex only the faces with the newest point can hold the
//! nearest: with w newest and the base abc wound such that its normal is n, the target is
//! on the inner side of the face w a b when det(w, a, b) > 0, and inside the tetrahedron
//! when all three such are. No product but these decides, and none is compared with an
//! absolute epsilon.
//!
//! **Near the target** the nearest point is mostly rounding error, and the way from it is
//! noise; the normal of a face is not. So the way from a face is its normal, outwards, and
//! a target within rounding of an edge counts as one in the face. Where the target stays
//! within rounding of the simplex's surface (it lies on an edge between points of D, as in
//! stacks of aligned boxes), a *portal* has the last word (G. Snethen, "XenoCollide", Game
//! Programming Gems 7): a ray from a point well inside D through the origin, and a triangle
//! of support points around it, moved outwards along its normals until the origin lies on
//! the inner side or a plane separates. Ties do no harm there.
//!
//! **A touch is a miss**: [`Inquiry::ask`] ends the search where a support value is no
//! greater than rounding. What is proven to overlap has the origin strictly inside; a flat
//! D has no inside, and its normal is asked for before a tetrahedron is believed.
//!
//! Departures from libccd: both its yes-or-no queries are this one, with the centres'
//! difference for a first corner where they are given and trusted; on a million pairs of the
//! kinds in use that is a sixth fewer support points than libccd's portal asks for.

use crate::gjk::barycentric;
use crate::known::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::known::support_set::{Beyond, Inquiry, Stop, SupportSet};
use crate::math::{EPSILON, Real, Vec3, larger, normal, perpendicular, unit};
use crate::paper::portal::{Exit, Found, Measure, SupportPlane, find_portal, refine};

/// A simplex of points of a set, seen from the target.
///
/// A point stays in its place as long as it is a corner: what changes is the order.
#[derive(Clone, Copy)]
pub struct Simplex {
    /// The points' indices in their set, by place.
    ids: [usize; 4],
    /// The points less the target, by place.
    at: [Vec3; 4],
    /// The places of the corners, the last repeated where there are fewer. Of three the
    /// winding tells the way: outwards, where the target is.
    order: [usize; 3],
    len: usize,
    /// The place of a point that is well inside D, if one is a corner; else [`NOWHERE`].
    inner: usize,
}

/// No place.
const NOWHERE: usize = 4;

/// A face of a simplex that holds the point nearest to the target.
#[derive(Clone, Copy)]
struct Face {
    order: [usize; 3],
    len: usize,
    way: Vec3,
    distance2: Real,
}

impl Simplex {
    /// No point.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            ids: [0; 4],
            at: [Vec3::zeros(); 4],
            order: [3; 3],
            len: 0,
            inner: NOWHERE,
        }
    }

    /// One point.
    #[inline(always)]
    pub fn of(id: usize, at: &Vec3) -> Self {
        let mut simplex = Self::new();
        simplex.add(id, *at, 0.0, 0.0);
        simplex
    }

    /// One point, well inside D.
    #[inline(always)]
    pub fn around(id: usize, at: &Vec3) -> Self {
        Self {
            inner: 0,
            ..Self::of(id, at)
        }
    }

    /// The corners' indices, as many as there are corners.
    #[inline(always)]
    pub fn ids(&self) -> [usize; 3] {
        self.order.map(|p| self.ids[p & 3])
    }

    /// Is this point a corner?
    #[inline(always)]
    fn has(&self, id: usize) -> bool {
        self.ids().iter().take(self.len).any(|i| *i == id)
    }

    /// A place where there is no corner.
    #[inline(always)]
    pub fn place(&self) -> usize {
        let [i, j, k] = self.order;
        (!(1_u32 << i | 1 << j | 1 << k)).trailing_zeros() as usize & 3
    }

    /// Adds a point, `at` from the target, and keeps the face that holds the point nearest
    /// to it. What is nearer than `touch`, metres, touches; `size2` is
    /// the square of a length that no corner is farther from the target than.
    ///
    /// Returns the way from there to the target, of any length, and the square of the
    /// distance, m². The way is zero where a triangle without area holds the target. `None`:
    /// the target is inside the tetrahedron, off its three new faces by more than a touch;
    /// its distance from the old one, the base, is not looked at.
    #[inline(always)]
    pub fn add(&mut self, id: usize, at: Vec3, touch: Real, size2: Real) -> Option<(Vec3, Real)> {
        let w = self.place();
        self.ids[w] = id;
        self.at[w] = at;
        if w == self.inner {
            self.inner = NOWHERE;
        }
        let [i, j, _] = self.order;
        let face = match self.len {
            0 => self.corner(w),
            1 => self.line(i, w, touch),
            2 => {
                let [a, b] = [i, j].map(|p| self.at[p & 3]);
                let n = normal(&a, &b, &at);
                // Outwards is where the target is. NaN, or a flat D: either.
                if n.dot(&at) > 0.0 {
                    self.triangle([j, i, w], -n, a.cross(&at), at.cross(&b), touch)
                } else {
                    self.triangle([i, j, w], n, b.cross(&at), at.cross(&a), touch)
                }
            }
            _ => self.tetrahedron(w, touch, size2)?,
        };
        self.order = face.order;
        self.len = face.len;
        Some((face.way, face.distance2))
    }

    /// How many corners there are: at most three.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Does a simplex that holds the target, and is no tetrahedron, show that D does?
    #[inline(always)]
    fn proves(&self, kind: Proof) -> bool {
        match kind {
            Proof::Solid => false,
            Proof::Centred => self.order.contains(&self.inner),
            Proof::Planar => self.len > 1,
        }
    }

    /// Adds a corner, one of at most three, wherever it is: [`Simplex::settle`] tells the rest.
    pub fn put(&mut self, id: usize, at: Vec3) {
        let w = self.place();
        self.ids[w] = id;
        self.at[w] = at;
        self.order = match (self.order, self.len) {
            ([i, ..], 1) => [i, w, w],
            ([i, j, _], 2) => [i, j, w],
            _ => [w; 3],
        };
        self.len = (self.len + 1).min(3);
    }

    /// As [`Simplex::add`] without a new point; and every face of the simplex counts, not
    /// only those with the newest point.
    pub fn settle(&mut self, touch: Real) -> (Vec3, Real) {
        let [i, j, k] = self.order;
        let at = self.order.map(|p| self.at[p & 3]);
        let face = match self.len {
            0 | 1 => self.corner(i),
            2 => self.line(i, j, touch),
            _ => {
                let [a, b, c] = &at;
                let weights = barycentric::triangle(&Vec3::zeros(), a, b, c).weights;
                match weights.map(|w| w > 0.0) {
                    [true, true, true] => {
                        let n = normal(a, b, c);
                        let height = n.dot(a);
                        let (order, way) = if height > 0.0 {
                            ([j, i, k], -n)
                        } else {
                            ([i, j, k], n)
                        };
                        Face {
                            order,
                            len: 3,
                            way,
                            distance2: height / n.norm_squared() * height,
                        }
                    }
                    [true, true, _] => self.line(i, j, touch),
                    [true, _, true] => self.line(i, k, touch),
                    [_, true, true] => self.line(j, k, touch),
                    [_, _, true] => self.corner(k),
                    [_, true, _] => self.corner(j),
                    _ => self.corner(i),
                }
            }
        };
        (self.order, self.len) = (face.order, face.len);
        (face.way, face.distance2)
    }

    #[inline(always)]
    fn corner(&self, i: usize) -> Face {
        Face {
            order: [i; 3],
            len: 1,
            way: -self.at[i & 3],
            distance2: self.at[i & 3].norm_squared(),
        }
    }

    /// The nearest point of the segment from `i` to the newest point `w`.
    #[inline(always)]
    fn segment(&self, i: usize, w: usize) -> Face {
        let (a, b) = (&self.at[i & 3], &self.at[w & 3]);
        let ab = a - b;
        let t = -b.dot(&ab);
        let length2 = ab.norm_squared();
        // NaN and a segment without length end at a corner.
        if !(t > 0.0) {
            self.corner(w)
        } else if !(t < length2) {
            self.corner(i)
        } else {
            // Close to the target the sum is all rounding error: what of it lies along
            // the segment is taken away, so that the way stays perpendicular.
            let v = b + ab * (t / length2);
            let v = v - ab * (v.dot(&ab) / length2);
            Face {
                order: [i, w, w],
                len: 2,
                way: -v,
                distance2: v.norm_squared(),
            }
        }
    }

    /// The nearest point of two; where they hold the target, any way aside.
    #[inline(always)]
    fn line(&self, i: usize, w: usize, touch: Real) -> Face {
        let mut face = self.segment(i, w);
        if !(face.distance2 > touch * touch) {
            let along = unit(&(self.at[w & 3] - self.at[i & 3])).unwrap_or(Vec3::x());
            face.way = perpendicular(&along);
        }
        face
    }

    /// The part of a triangle that holds its nearest point: the triangle of `order` = i, j and
    /// the newest point w, or of its edges those with w, which alone can. Given are its outward
    /// normal `n`, and with the corners as vectors j × w and w × i.
    #[inline(always)]
    fn triangle(&self, order: [usize; 3], n: Vec3, jw: Vec3, wi: Vec3, touch: Real) -> Face {
        let [i, j, w] = order;
        // The weights of i and j, as multiples of n².
        let (beyond_i, beyond_j) = (!(n.dot(&jw) > 0.0), !(n.dot(&wi) > 0.0));
        let edge = match (beyond_i, beyond_j) {
            (false, false) => {
                let height = n.dot(&self.at[w & 3]);
                return Face {
                    order,
                    len: 3,
                    way: n,
                    distance2: height / n.norm_squared() * height,
                };
            }
            (true, false) => self.segment(j, w),
            (false, true) => self.segment(i, w),
            (true, true) => {
                let (one, other) = (self.segment(i, w), self.segment(j, w));
                if other.distance2 < one.distance2 {
                    other
                } else {
                    one
                }
            }
        };
        if edge.distance2 > touch * touch {
            return edge;
        }
        // On the edge within rounding.
        Face {
            order,
            len: 3,
            way: n,
            distance2: edge.distance2,
        }
    }

    /// The face nearest to the target; `None` where it is inside.
    #[inline(always)]
    fn tetrahedron(&self, place: usize, touch: Real, size2: Real) -> Option<Face> {
        let [i, j, k] = self.order;
        let [a, b, c, w] = [i, j, k, place].map(|p| &self.at[p & 3]);
        let (wa, wb, wc) = (w.cross(a), w.cross(b), w.cross(c));
        let heights = [wa.dot(b), wb.dot(c), wc.dot(a)];
        // The normal of a face is at most four squares of the farthest corner long: what is
        // higher is off it by more than twice the rounding.
        let least = 8.0 * size2 * touch;
        // A face that has the inner point for a corner is inside D, and so is the target where
        // rounding puts it on either side of that: what counts is the face opposite.
        let kept = [i, j, k].map(|p| p == self.inner);
        let inside = kept != [false; 3];
        // NaN is outside.
        let clear = |height: Real, p: &Vec3, q: &Vec3, opposite: bool| {
            let slack = if inside && !opposite { -touch } else { touch };
            height > least || height > -least && off(height, p, q, w, slack)
        };
        let mut best: Option<Face> = None;
        let corners = [i, j, k, i];
        let crosses = [wa, wb, wc, wa];
        for s in 0..3 {
            let (p, q) = (&self.at[corners[s] & 3], &self.at[corners[s + 1] & 3]);
            if clear(heights[s], p, q, kept[(s + 2) % 3]) {
                continue;
            }
            let order = [corners[s], corners[s + 1], place];
            let n = normal(p, q, w);
            let face = self.triangle(order, n, -crosses[s + 1], crosses[s], touch);
            if best.as_ref().is_none_or(|b| face.distance2 < b.distance2) {
                best = Some(face);
            }
        }
        best
    }

    /// The points of the objects whose difference is nearest to the target.
    pub fn witnesses<const N: usize>(&self, set: &SupportSet<N>, target: &Vec3) -> (Vec3, Vec3) {
        let [a, b, c] = self.ids().map(|i| set.point(i));
        match self.len {
            0 | 1 => (a.v1, a.v2),
            2 => {
                let nearest = barycentric::segment(target, &a.v, &b.v);
                barycentric::witnesses(&nearest.weights, [&a, &b])
            }
            _ => {
                let nearest = barycentric::triangle(target, &a.v, &b.v, &c.v);
                barycentric::witnesses(&nearest.weights, [&a, &b, &c])
            }
        }
    }
}

/// Is the target off the face of p, q and w by more than twice the slack, and by more than
/// rounding? For heights that [`Simplex::tetrahedron`]'s cheaper bound leaves open; `height` is
/// the distance times twice the face's area.
#[cold]
fn off(height: Real, p: &Vec3, q: &Vec3, w: &Vec3, slack: Real) -> bool {
    // The product itself is off by ulps of the corners' lengths, however small the face is.
    let lengths = p.norm() * q.norm() * w.norm();
    let error = if slack > 0.0 {
        8.0 * EPSILON * lengths
    } else {
        0.0
    };
    height > 2.0 * slack * normal(p, q, w).norm() + error
}

impl Default for Simplex {
    fn default() -> Self {
        Self::new()
    }
}

/// Do the objects overlap? `centre`, an interior point of D, is trusted.
#[inline]
pub fn from_centre<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: &SupportPoint,
) -> Result<(), Stop> {
    // A centre at the origin is no corner to look from.
    match direction(&-centre.v) {
        Some(dir) => from(md, Some(centre), &dir),
        None => from(md, None, &Vec3::x()),
    }
}

/// Do the objects overlap? From unit `dir`.
#[inline]
pub fn from_direction<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    dir: &Vec3,
) -> Result<(), Stop> {
    from(md, None, dir)
}

#[inline(always)]
fn from<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&SupportPoint>,
    dir: &Vec3,
) -> Result<(), Stop> {
    let mut inquiry = Inquiry::new(md);
    // Most misses are told here, and pay for nothing more.
    let first = inquiry.first(dir, None)?;
    beyond_first(&mut inquiry, centre, dir, &first)
}

/// What is left where the first support point does not separate.
#[inline(never)]
fn beyond_first<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    centre: Option<&SupportPoint>,
    dir: &Vec3,
    first: &SupportPoint,
) -> Result<(), Stop> {
    let mut set = SupportSet::<4>::EMPTY;
    let mut simplex = Simplex::new();
    if let Some(centre) = centre {
        let c = set.push(&Vec3::zeros(), centre);
        simplex = Simplex::around(c, &centre.v);
        inquiry.precision.note(centre);
    }
    let w = set.push(dir, first);
    let (touch, size2) = (inquiry.precision.touch(), inquiry.precision.size2());
    let way = simplex.add(w, first.v, touch, size2);
    let next = way.and_then(|(way, _)| direction(&way)).unwrap_or(*dir);
    search(
        inquiry,
        &mut set,
        simplex,
        next,
        Proof::Solid,
        |_, _, _, _| Ok(None),
    )?;
    Ok(())
}

/// Support points after which the portal decides: of a hundred thousand pairs of every kind
/// in use none needs forty.
const STEPS: u32 = 64;

/// Steps within rounding of the simplex's surface before the portal decides. One finds the
/// other side of a face that the origin lies on.
const STALLS: u32 = 3;

/// Support points after which the portal's answer is its last one. It halves what is open
/// at each but few; what is open then is rounding.
const LAST: u64 = 200;

/// Shows that the objects overlap: the origin is strictly inside D, beyond rounding, or no
/// direction asked separates. Or [`Stop::Apart`]. Returns the corners of the tetrahedron
/// that shows it, in the set; of the last simplex, where none did.
///
/// `centre` is the index of a point of D that is trusted to be one, and need not be a
/// support point: the origin is looked for between it and others. `dir`, unit, is asked
/// first. Other points in the set stand in for a support point where they do as well. The
/// set has room for four points or more; where it is full, points out of use give way.
#[inline]
pub fn overlap<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<N>,
    centre: Option<usize>,
    dir: &Vec3,
) -> Result<[usize; 4], Stop> {
    let simplex = match centre {
        Some(c) => Simplex::around(c, &set.v(c)),
        None => Simplex::new(),
    };
    let held = if set.len() > simplex.len {
        search(
            inquiry,
            set,
            simplex,
            *dir,
            Proof::Solid,
            |inquiry, set, _, dir| Ok(set.farther(dir, inquiry.precision.touch())),
        )?
    } else {
        search(inquiry, set, simplex, *dir, Proof::Solid, |_, _, _, _| {
            Ok(None)
        })?
    };
    Ok(held.corners)
}

/// What shows that the origin is inside D.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// A tetrahedron that holds it.
    Solid,
    /// Also a segment or triangle that does, with a corner well inside D: point 0 of the set.
    Centred,
    /// Any segment or triangle that does: D lies in a plane, and has no other inside.
    Planar,
}

/// What holds the origin.
pub struct Held {
    /// The indices of the corners in the set, the last one repeated where it is no tetrahedron.
    pub corners: [usize; 4],
    /// Where a portal had the last word, and the corners need not hold it: two points that it
    /// lies between.
    pub between: Option<[SupportPoint; 2]>,
}

impl Held {
    fn by(corners: [usize; 4]) -> Self {
        Self {
            corners,
            between: None,
        }
    }
}

/// [`overlap`], from a simplex and a direction to ask. `stand_in` may give the index of a point
/// of the set that lies beyond the origin along a direction, by more than a touch.
#[inline(always)]
pub fn search<'q, A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'q, A, B>,
    set: &mut SupportSet<N>,
    mut simplex: Simplex,
    mut dir: Vec3,
    kind: Proof,
    mut stand_in: impl FnMut(
        &mut Inquiry<'q, A, B>,
        &mut SupportSet<N>,
        &Simplex,
        &Vec3,
    ) -> Result<Option<usize>, Stop>,
) -> Result<Held, Stop> {
    // The square of the distance from the simplex; and whether points on the other side of
    // it, where it is a triangle, are known.
    let (mut nearest, mut backed) = (Real::INFINITY, false);
    let mut stalls = 0;
    for _ in 0..STEPS {
        let (w, at, touch) = match stand_in(inquiry, set, &simplex, &dir)? {
            // A corner, by rounding.
            Some(w) if simplex.has(w) => break,
            Some(w) => (w, set.v(w), inquiry.precision.touch()),
            None => {
                let place = room(set, &simplex);
                match inquiry.ask_at(set, place, &dir)? {
                    Beyond::Put { v, touch } => (place, v, touch),
                    // A callback that contradicts itself.
                    Beyond::Known(_) => break,
                }
            }
        };
        let solid = simplex.len == 3;
        let Some((way, distance2)) = simplex.add(w, at, touch, inquiry.precision.size2()) else {
            let inside = simplex.inner != NOWHERE;
            if !(nearest > touch * touch || backed || inside) {
                // The origin is in the base's plane, within rounding: in one of the two
                // tetrahedra on either side of it, if there is another.
                let place = room(set, &simplex);
                inquiry.ask_at(set, place, &-dir)?;
            }
            let [i, j, k] = simplex.ids();
            return Ok(Held::by([i, j, k, w]));
        };
        if distance2 <= touch * touch && simplex.proves(kind) {
            let [i, j, k] = simplex.ids();
            return Ok(Held::by([i, j, k, k]));
        }
        // Negated for NaN.
        if !(distance2 > touch * touch && distance2 < nearest) {
            stalls += 1;
            if stalls > STALLS {
                break;
            }
        }
        (nearest, backed) = (distance2, solid && simplex.len == 3);
        match direction(&way) {
            Some(n) => dir = n,
            None => break,
        }
    }
    let between = decide(inquiry, set, &simplex, &dir)?;
    let [i, j, k] = simplex.ids();
    Ok(Held {
        corners: [i, j, k, k],
        between,
    })
}

/// Points of the objects whose difference is within `tolerance` of `target`, a point of D
/// (for a penetration the foot depth · normal), or as near as `steps` support points bring
/// it; and how near that is, metres.
///
/// The points of the set come first, and those asked for go into it: what a query knows
/// of the face that the target lies in is often enough. A set without any is asked along
/// `dir`, unit.
pub fn witnesses<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<N>,
    target: &Vec3,
    dir: &Vec3,
    tolerance: Real,
    steps: usize,
) -> Result<(Vec3, Vec3, Real), Fault> {
    let mut simplex = Simplex::new();
    let mut left = steps;
    let far2 = |i: usize, set: &SupportSet<N>| (set.v(i) - target).norm_squared();
    let nearer = |a: usize, b: usize| if far2(b, set) < far2(a, set) { b } else { a };
    let mut id = match (0..set.len()).reduce(nearer) {
        Some(id) => id,
        None => {
            let point = inquiry.point(dir)?;
            set.push(dir, &point)
        }
    };
    // Each pass takes a known point or asks for one.
    for _ in 0..steps + N {
        let touch = inquiry.precision.touch();
        let size2 = 4.0 * larger(inquiry.precision.size2(), target.norm_squared());
        let corners = simplex.ids();
        let Some((mut way, distance2)) = simplex.add(id, set.v(id) - target, touch, size2) else {
            // D holds the target well inside.
            let [a, b, c] = corners.map(|i| set.point(i));
            let d = set.point(id);
            let weights = barycentric::tetrahedron(target, [&a.v, &b.v, &c.v, &d.v]).weights;
            let (p1, p2) = barycentric::witnesses(&weights, [&a, &b, &c, &d]);
            return Ok((p1, p2, (p1 - p2 - target).norm()));
        };
        if !(distance2 > tolerance * tolerance) {
            let (p1, p2) = simplex.witnesses(set, target);
            if (p1 - p2 - target).norm() <= tolerance {
                break;
            }
            // In the plane of a face the last point was no nearer than the others.
            (way, _) = simplex.settle(touch);
        }
        let Some(n) = direction(&way) else {
            break;
        };
        let least = n.dot(&set.v(simplex.ids()[0])) + touch;
        if let Some(known) = set.farther(&n, least) {
            id = known;
            continue;
        }
        if left == 0 {
            break;
        }
        left -= 1;
        let point = inquiry.point(&n)?;
        // As near as D comes.
        if !(n.dot(&point.v) > least) {
            break;
        }
        id = room(set, &simplex);
        set.place(id, &n, &point);
    }
    let (p1, p2) = simplex.witnesses(set, target);
    Ok((p1, p2, (p1 - p2 - target).norm()))
}

/// From a unit direction that separates to one that separates by a good part of the
/// distance, and so for longer while the objects move: the steps of the distance
/// algorithm, each at a support point, until the margin −n·s(n) is [`WIDE`] enough.
/// Returns n and its margin, metres.
pub fn separate<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    separating: Vec3,
) -> Result<(Vec3, Real), Fault> {
    let mut n = separating;
    let mut best = (n, 0.0);
    let mut simplex = Simplex::new();
    for i in 0..WIDENING {
        let point = inquiry.point(&n)?;
        let margin = -n.dot(&point.v);
        if margin > best.1 {
            best = (n, margin);
        }
        let precision = &inquiry.precision;
        let added = simplex.add(i, point.v, precision.touch(), precision.size2());
        // The distance is less than that of the simplex, and more than the margin.
        let Some((way, distance2)) = added else {
            break;
        };
        if !(best.1 < WIDE * distance2.sqrt()) {
            break;
        }
        match direction(&way) {
            Some(next) => n = next,
            None => break,
        }
    }
    Ok(best)
}

/// The share of the distance that is wide enough.
const WIDE: Real = 0.8;
/// Support points that [`separate`] may ask for.
const WIDENING: usize = 8;

/// The unit vector along `way`, and `None` for none.
#[inline(always)]
pub fn direction(way: &Vec3) -> Option<Vec3> {
    let length2 = way.norm_squared();
    // Squares that are neither rounded to nothing nor beyond numbers.
    // (In single precision those of areas soon are.)
    let safe = length2 > Real::MIN_POSITIVE / EPSILON && length2 < Real::INFINITY;
    if safe && !cfg!(feature = "single") {
        Some(way / length2.sqrt())
    } else {
        unit(way)
    }
}

/// Where the next point goes: behind the others, or, in a set without room, in the place of
/// one that is no corner.
#[inline(always)]
pub fn room<const N: usize>(set: &SupportSet<N>, simplex: &Simplex) -> usize {
    if N == 4 {
        // Indices and places are the same.
        return simplex.place();
    }
    if !set.is_full() {
        return set.len();
    }
    (0..N).find(|i| !simplex.has(*i)).unwrap_or(N - 1)
}

/// The last word where the origin is as good as on the surface of the simplex: a portal. Returns
/// the inner point and where the ray from it crosses the last portal: the origin is between them.
#[cold]
fn decide<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &SupportSet<N>,
    simplex: &Simplex,
    dir: &Vec3,
) -> Result<Option<[SupportPoint; 2]>, Stop> {
    // The simplex may be as flat as touching faces: the middle between it and the far
    // side of D is well inside.
    let mut seen = SupportSet::<8>::EMPTY;
    let corners = simplex.ids().map(|i| set.point(i));
    for corner in &corners[..simplex.len.min(3)] {
        seen.push(&Vec3::zeros(), corner);
    }
    let last = seen.len();
    inquiry.ask_at(&mut seen, last, &-dir)?;
    let mut inner = mean(&seen, last).middle(&seen.point(last));
    if !(inner.v.norm() > inquiry.precision.touch()) {
        inner = inner.middle(&seen.point(0));
    }
    let ray = unit(&-inner.v).unwrap_or(*dir);
    let first = SupportPlane::of(inquiry.md, ray)?;
    let (mut best, mut budget) = (first, LAST);
    let found = find_portal(inquiry.md, &first, Some(&inner.v), &mut best, &mut budget)?;
    let mut between = None;
    let lowest = match found {
        Found::Miss(plane) => plane,
        // Any portal that has the origin on its inner side decides.
        Found::Portal(portal) => {
            let beyond = Real::INFINITY;
            let normal = Measure::Normal;
            match refine(
                inquiry.md,
                portal,
                beyond,
                normal,
                false,
                &mut best,
                &mut budget,
            )? {
                Exit::Miss(plane) => plane,
                Exit::Converged(last, _) | Exit::Limit(Some(last)) => {
                    let (v1, v2) = last.witnesses();
                    between = Some([inner, SupportPoint { v: v1 - v2, v1, v2 }]);
                    best
                }
                _ => best,
            }
        }
        Found::Vertex | Found::Touch | Found::Limit => best,
    };
    inquiry.precision.note(&lowest.point);
    let touch = inquiry.precision.touch();
    // A callback that contradicts itself separates nothing.
    let contradicted = |h: Real| set.farther(&lowest.normal, h).is_some();
    let grain = inquiry.precision.grain();
    if lowest.depth > touch || contradicted(larger(lowest.depth + grain, touch)) {
        Ok(between)
    } else {
        Err(Stop::Apart(lowest.normal))
    }
}

/// The mean of the first points of a set.
fn mean<const N: usize>(set: &SupportSet<N>, count: usize) -> SupportPoint {
    let mut mean = SupportPoint::default();
    let share = 1.0 / larger(count as Real, 1.0);
    for i in 0..count {
        let p = set.point(i);
        mean.v1 += p.v1 * share;
        mean.v2 += p.v2 * share;
    }
    mean.v = mean.v1 - mean.v2;
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::precision::Precision;
    use crate::shapes::{self, KINDS, Random, Shape, ball, corners, hull, pair, placed, scaled};

    /// Corners that lie in a plane with the target, and near each other.
    #[test]
    fn rounding_of_a_small_face_is_no_height() {
        let mut r = Random::new(41);
        for round in 0..2000 {
            let apart = [1e-2, 1e-4, 1e-6][round % 3];
            let p = r.direction() * 1e-3;
            let q = p + r.vector(1e-3 * apart);
            let w = p * r.within(0.5, 2.0) + q * r.within(-1.0, 1.0);
            let height = p.cross(&q).dot(&w);
            // Of an object a thousand times as large.
            assert!(!off(height, &p, &q, &w, EPSILON));
            assert!(off(1e3 * EPSILON * 1e-9, &p, &q, &w, EPSILON));
        }
    }

    /// The points that a portal's last word gives have the origin between them.
    #[test]
    fn a_portal_decides_between_two_points() {
        let mut r = Random::new(43);
        for _ in 0..200 {
            let half = Vec3::new(0.5, 0.4, 0.3);
            let turned = placed(&corners(half), &r.rotation(), r.vector(0.2));
            let md = MinkowskiDifference::new(hull(&corners(half)), hull(&turned));
            let mut inquiry = Inquiry::new(&md);
            let mut set = SupportSet::<4>::EMPTY;
            let n = r.direction();
            let point = md.support(&n).unwrap();
            set.push(&n, &point);
            let simplex = Simplex::of(0, &point.v);
            let between = decide(&mut inquiry, &set, &simplex, &n).ok().flatten();
            let [p, q] = between.unwrap().map(|p| p.v);
            let apart = (q - p).norm();
            assert!(p.dot(&q) < 0.0 && p.cross(&q).norm() <= 64.0 * EPSILON * apart * apart);
        }
    }

    /// Do they overlap? Also: a miss must come with a direction that separates, and
    /// swapped objects must give the same answer.
    fn overlap(a: &Shape, b: &Shape, dir: &Vec3) -> bool {
        either(a, b, dir, false)
    }

    /// [`overlap`], where a touch may be either.
    fn either(a: &Shape, b: &Shape, dir: &Vec3, within_rounding: bool) -> bool {
        let ask = |a: &Shape, b: &Shape, dir: Vec3| {
            let md = MinkowskiDifference::new(a, b);
            let answer = from_direction(&md, &dir);
            assert!(md.supports() < 300, "{}", md.supports());
            match answer {
                Ok(()) => true,
                Err(Stop::Apart(n)) => {
                    assert!((n.norm() - 1.0).abs() < 8.0 * EPSILON);
                    let point = md.support(&n).unwrap();
                    let mut precision = Precision::default();
                    precision.note(&point);
                    // Other points may be farther off.
                    for dir in [Vec3::x(), Vec3::y(), Vec3::z()] {
                        precision.note(&md.support(&dir).unwrap());
                        precision.note(&md.support(&-dir).unwrap());
                    }
                    assert!(n.dot(&point.v) <= 2.0 * precision.touch());
                    false
                }
                Err(fault) => panic!("{fault:?}"),
            }
        };
        let answer = ask(a, b, *dir);
        if !within_rounding {
            assert_eq!(answer, ask(b, a, -dir), "swapped");
        }
        answer
    }

    /// Is the pair of that kind an overlap? Nothing is known of a touch within rounding.
    fn truth(kind: usize, gap: Real) -> Option<bool> {
        let touch = gap < 0.0 && (matches!(kind, 3 | 4) || gap > -50.0 * EPSILON);
        (!touch).then_some(gap < 0.0)
    }

    /// Gaps and depths from 20 ulps to a tenth of the size: no false hit, no false miss.
    #[test]
    fn no_false_answer_down_to_a_few_ulps() {
        let mut r = Random::new(1);
        for ulps in [20.0, 100.0, 4500.0, 1e6, 1e10] {
            let gap = (ulps * EPSILON).min(0.1);
            for round in 0..200 {
                for kind in 0..KINDS {
                    for gap in [gap, -gap] {
                        let (a, b) = pair(kind, gap, &mut r);
                        let truth = truth(kind, gap);
                        let answer = either(&a, &b, &r.direction(), truth.is_none());
                        if let Some(hit) = truth {
                            assert_eq!(answer, hit, "kind {kind}, gap {gap:e}, round {round}");
                        }
                    }
                }
            }
        }
    }

    /// The same bits at every power of two from a micrometre to 1000 km and beyond.
    #[test]
    fn free_of_scale() {
        let mut r = Random::new(2);
        for _ in 0..100 {
            for kind in 0..KINDS {
                let gap = r.within(-0.1, 0.1);
                let (a, b) = pair(kind, gap, &mut r);
                let dir = r.direction();
                for exponent in [-20, 20] {
                    let scale = (2.0 as Real).powi(exponent);
                    let md = MinkowskiDifference::new(&a, &b);
                    let larger = [scaled(&a, scale), scaled(&b, scale)];
                    let other = MinkowskiDifference::new(&larger[0], &larger[1]);
                    let one = from_direction(&md, &dir);
                    if let Some(hit) = truth(kind, gap) {
                        assert_eq!(one.is_ok(), hit);
                    }
                    assert_eq!(one, from_direction(&other, &dir));
                    assert_eq!(md.supports(), other.supports());
                }
            }
        }
    }

    #[test]
    fn needles_and_plates() {
        shapes::needles_and_plates(overlap);
    }

    #[test]
    fn flat_shapes() {
        shapes::flat_shapes(overlap);
        let mut r = Random::new(5);
        for _ in 0..500 {
            let (rot, at) = (r.rotation(), r.vector(3.0));
            // A point on itself is a touch; so is what is flat, whatever it shares.
            assert!(!overlap(&hull(&[at]), &hull(&[at]), &r.direction()));
            let triangle = [
                at,
                at + rot * Vec3::x(),
                at + rot * Vec3::new(0.3, 1.0, 0.0),
            ];
            let other = triangle.map(|p| p + rot * Vec3::x() * 0.2);
            assert!(!overlap(&hull(&triangle), &hull(&other), &r.direction()));
        }
    }

    #[test]
    fn exact_touch_is_a_miss() {
        for (a, b, dir) in shapes::touching() {
            assert!(!overlap(&a, &b, &dir));
        }
    }

    /// Known points of D do not change the answer, and those all around the origin are a
    /// proof by themselves.
    #[test]
    fn known_points() {
        let mut r = Random::new(6);
        let mut without = 0;
        for _ in 0..300 {
            for kind in 0..KINDS {
                let gap = r.within(-0.1, 0.1);
                let (a, b) = pair(kind, gap, &mut r);
                let md = MinkowskiDifference::new(&a, &b);
                let mut inquiry = Inquiry::new(&md);
                let mut set = SupportSet::<64>::EMPTY;
                for _ in 0..3 {
                    let _ = inquiry.ask(&mut set, &r.direction());
                }
                let dir = r.direction();
                let answer = super::overlap(&mut inquiry, &mut set, None, &dir);
                let before = md.supports();
                let again = super::overlap(&mut inquiry, &mut set, None, &dir);
                if let Some(hit) = truth(kind, gap) {
                    assert_eq!(answer.is_ok(), hit, "kind {kind} gap {gap}");
                    assert_eq!(again.is_ok(), hit, "kind {kind} gap {gap}");
                    without += u32::from(hit && md.supports() == before);
                }
            }
        }
        assert!(without > 1000, "{without}");
    }

    /// Witness points of known depths: points of the objects, the depth along the normal
    /// apart; a foot that the known points surround costs nothing.
    #[test]
    fn witnesses_of_a_foot() {
        let mut r = Random::new(8);
        let mut count = 0;
        for _ in 0..300 {
            for kind in 0..KINDS {
                let depth = r.within(1e-6, 0.1);
                let (a, b) = pair(kind, -depth, &mut r);
                let md = MinkowskiDifference::new(&a, &b);
                // Any point of D's surface has a foot: in the middle of three of its points.
                let n = r.direction();
                let mut set = SupportSet::<16>::EMPTY;
                let mut inquiry = Inquiry::new(&md);
                for _ in 0..3 {
                    let tilted = unit(&(n + r.direction() * 0.3)).unwrap();
                    let point = md.support(&tilted).unwrap();
                    inquiry.precision.note(&point);
                    set.push(&tilted, &point);
                }
                let target = (set.v(0) + set.v(1) + set.v(2)) / 3.0;
                let tolerance = 100.0 * EPSILON;
                let before = md.supports();
                let known =
                    super::witnesses(&mut inquiry, &mut set, &target, &n, tolerance, 50).unwrap();
                assert!(known.2 <= 20.0 * tolerance, "kind {kind}: {}", known.2);
                count += md.supports() - before;
                // From nothing.
                let mut empty = SupportSet::<8>::EMPTY;
                let mut inquiry = Inquiry::new(&md);
                let tolerance = 1e-3;
                let (p1, p2, distance) =
                    super::witnesses(&mut inquiry, &mut empty, &target, &n, tolerance, 50).unwrap();
                assert!(distance <= tolerance, "kind {kind}: {distance}");
                assert!((p1 - p2 - target).norm() <= tolerance);
            }
        }
        assert!(count < 300, "{count}");
    }

    /// From the centre, which is trusted: the same answers.
    #[test]
    fn from_centres() {
        let mut r = Random::new(7);
        for ulps in [100.0, 1e6, 1e13] {
            for _ in 0..300 {
                let size = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
                let turn = r.rotation();
                let cube = placed(&corners(size), &turn, Vec3::zeros());
                let mut gap = (ulps * EPSILON).min(0.2) * r.within(0.5, 1.0);
                gap *= if r.within(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
                let up = turn * Vec3::z();
                // On the line of the centres, beside it, and round.
                let aside = turn * Vec3::x() * (0.3 * size.x);
                for by in [Vec3::zeros(), aside] {
                    let at = up * (2.0 * size.z + gap) + by;
                    let other: Vec<_> = cube.iter().map(|p| p + at).collect();
                    let md = MinkowskiDifference::new(hull(&cube), hull(&other));
                    let centre = SupportPoint {
                        v: -at,
                        v1: Vec3::zeros(),
                        v2: at,
                    };
                    assert_eq!(from_centre(&md, &centre).is_ok(), gap < 0.0, "{gap}");
                }
                let at = up * (1.5 + gap);
                let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(at, 0.5));
                let centre = SupportPoint {
                    v: -at,
                    v1: Vec3::zeros(),
                    v2: at,
                };
                assert_eq!(from_centre(&md, &centre).is_ok(), gap < 0.0, "{gap}");
            }
        }
        // The same centre.
        let md = MinkowskiDifference::new(ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.5));
        assert_eq!(from_centre(&md, &SupportPoint::default()), Ok(()));
    }
}
