// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A polytope that grows by points: triangles with homogeneous planes. It knows no query.
//!
//! # Insertion by interpolation
//!
//! A new point p replaces all faces that it is above, the *visible* ones, by a fan over
//! their *horizon*. A horizon edge lies between a visible face F, which p is f > 0 above,
//! and a hidden face G, which it is g <= 0 above. Any plane through the edge is a
//! combination of the two, and the one through p is
//!
//!   F′ = F + w (G − F),   w = f / (f − g):   f + w (g − f) = 0.
//!
//! (The double description of a polytope: Motzkin and others, 1953; Fukuda and Prodon,
//! 1996.) It takes one division, no coordinates of corners, no cross product and no root.
//! Since 0 < w <= 1 errors are averaged, not amplified; a sliver's plane lies between two
//! good ones; and what holds of F and G on one side holds of F′: a point below both is
//! below it. So
//!
//! - the *inner* point z, the middle of the first tetrahedron, stays below every plane, by the
//!   least *margin* of the planes that were computed from corners, and
//! - an origin below every plane (d > 0) stays there.
//!
//! A point hardly above G counts as on it (g is taken as 0, w = 1): the new face has G's
//! plane.
//!
//! # The bound
//!
//! *Invariant*: the corners v of a face have N·v >= d, within [`Polytope::error`].
//! So its triangle is at least d / |N| away from the origin. The closed surface winds
//! around z once: it did as a tetrahedron, and while z is below every plane no triangle
//! comes to z. Where all d > 0 no triangle meets the segment from z to the origin either,
//! both ends being below the plane and its corners not; so the surface winds around the
//! origin once, and so around every point nearer than its nearest triangle. That ball is
//! in the hull of the corners. The surface need not be convex for this: convexity decides
//! how fast the bound grows. That z is inside the first tetrahedron, and not beside a sliver, it
//! shows itself: the middle of four points is inside to rounding, and no triangle is within
//! rounding of it. Where the margin is no more than the error ([`Polytope::winds`]) nothing is
//! proven.
//!
//! # Repairs, all under that invariant
//!
//! - *Collapse.* Between nearly opposite normals |N′| is nearly 0. There the plane is
//!   computed from its corners ([`Polytope::renew`]), which inherits nothing: it is taken
//!   only where it turns no other way, has z below it, and d > 0 where that was so. Else
//!   F′ is normalised, and the error with it; or, where nothing of it is left, the new
//!   face has F's plane, which its corners are on or above.
//! - *No single horizon.* Where rounding has made the visible faces no disc, nothing is
//!   changed, and fewer of them are taken for visible ([`Polytope::insert`]); the first
//!   one alone always is a disc.
//!
//! # Double precision throughout
//!
//! Also where points are single: differences of their coordinates are exact or nearly, and
//! a needle or a plate a few ulps thick has an inside, two sides and honest normals. In
//! single precision z came to lie on the wrong side of slivers, and the polytope turned
//! inside out: a depth of 0.4 for 6e-6, proven.
//!
//! # Layout
//!
//! Arrays, not structs: a sweep over the keys finds the nearest face without a list. A
//! half-edge is 4 · face + edge; edge i leads from corner i to corner i + 1,
//! counter-clockwise seen from outside. Faces outside use have the key +∞ and are chained.

use crate::hull::plane::Plane;
use crate::math::{Vec3, larger, lesser};

/// No half-edge: the bottom of the stack of half-edges in [`Polytope::fan`]'s walk.
const BOTTOM: u16 = u16::MAX;
/// To the next and the previous half-edge of a face, by the edge.
const NEXT: [i8; 4] = [1, 1, -2, 0];
const PREVIOUS: [i8; 4] = [2, -1, -1, 0];
/// Low bits of a key that name its face. They move a distance by 5e-13 of itself, in the
/// order of the faces alone.
const NAME: u64 = 0xfff;
/// The share of a distance that the name may stand for, and more.
const UNTOLD: f64 = 1e-12;
/// Most faces that fit the name.
pub const MOST_FACES: usize = 4096;
/// |N|² below which a plane has lost a digit to interpolation, and is computed anew.
/// Derived: the error stays within ten times that of its parents.
const COLLAPSED: f64 = 0.01;
/// |N|² below which nothing of an interpolated plane is left: two digits more.
const NOTHING: f64 = 1e-6;
/// Ulps of the size that a plane's error may come to by being normalised. Insensitive, 1e4 to 1e6
/// tried on the recorded contacts: far below the tolerances that interpolated planes serve.
const WORN: f64 = 1e5;
/// Ulps of the size within which a triangle has no extent. Derived: twice what a plane through its
/// corners is off by.
const FLAT: f64 = 16.0;
/// Ulps of the cube of a tetrahedron's longest edge that its volume's six-fold is at least. Derived:
/// a face's normal is off by six ulps of the square of that edge, which is as much of its height
/// as its area is smaller; z is a quarter of that height below the face, and half of the
/// quarter is to remain.
const SIGNED: f64 = 64.0;
/// Ulps of the size that a plane computed from its corners is off by, and that z must be below it
/// by. Derived: of two products of a unit vector with a point, three each and their sums, and of
/// the unit vector's own length and z's coordinates.
const FRESH: f64 = 8.0;

/// The hull of points that are named by numbers below 32768.
#[repr(C)]
pub struct Polytope<const F: usize> {
    planes: [[f64; 4]; F],
    /// An ulp of the points' size, metres.
    ulp: f64,
    /// d|d| / |N|² with the face's number in its low bits.
    keys: [f64; F],
    /// The half-edge on the other side of each of the three edges. The fourth is used while a
    /// fan is made: a new face keeps the half-edge there that its edge 0 takes the place of
    /// (for [`Polytope::undo`]), and a visible face what lies under its half-edge on the
    /// stack of the walk.
    twins: [[u16; 4]; F],
    /// Four names of 16 bits: corners 0, 1, 2, and 0 again.
    corners: [u64; F],
    /// The next face outside use, or the next visible one.
    next: [u16; F],
    free: usize,
    used: usize,
    inner: Vec3,
    /// What every plane has z below it by, at least, in units of its |N|, metres.
    margin: f64,
    error: f64,
    /// |N|² below which planes are computed from their corners.
    collapsed: f64,
    /// [`UNTOLD`], or 0 where keys are made to tell ([`Polytope::is_nearer`]).
    untold: f64,
}

/// The nearest face and its signed square distance, m².
#[derive(Clone, Copy, Debug)]
pub struct Top {
    /// The face.
    pub face: usize,
    /// d|d| / |N|², to 1e-12 of itself.
    pub key: f64,
}

impl<const F: usize> Polytope<F> {
    /// Nothing, and not yet fit for use: [`Polytope::tetrahedron`] comes first. All zero, so that no
    /// pattern is copied.
    pub const BLANK: Self = Self {
        planes: [[0.0; 4]; F],
        ulp: 0.0,
        keys: [0.0; F],
        twins: [[0; 4]; F],
        corners: [0; F],
        next: [0; F],
        free: 0,
        used: 0,
        inner: Vec3::new(0.0, 0.0, 0.0),
        margin: 0.0,
        error: 0.0,
        collapsed: 0.0,
        untold: 0.0,
    };

    /// The same, for points of about this size, metres. A number between two arrays has a small
    /// hull's zeroed one by one: all at once, of 2 KB and more, they are byte by byte.
    #[inline(always)]
    pub fn blank(size: f64) -> Self {
        Self {
            ulp: f64::EPSILON * size,
            ..Self::BLANK
        }
    }

    #[inline(always)]
    fn at(i: usize) -> usize {
        const { assert!(F % 8 == 0 && F >= 8 && F <= MOST_FACES) };
        if F.is_power_of_two() {
            i & (F - 1)
        } else {
            i.min(F - 1)
        }
    }

    #[inline(always)]
    fn plane(&self, f: usize) -> Plane {
        Plane::of(&self.planes[Self::at(f)])
    }

    /// The place of a half-edge among all of them.
    #[inline(always)]
    fn at_edge(h: usize) -> usize {
        if F.is_power_of_two() {
            h & (4 * F - 1)
        } else {
            h.min(4 * F - 1)
        }
    }

    #[inline(always)]
    fn twin(&self, h: usize) -> usize {
        usize::from(self.twins.as_flattened()[Self::at_edge(h)])
    }

    #[inline(always)]
    fn set_twin(&mut self, h: usize, twin: usize) {
        self.twins.as_flattened_mut()[Self::at_edge(h)] = twin as u16;
    }

    #[inline(always)]
    fn turn(h: usize, by: &[i8; 4]) -> usize {
        h.wrapping_add_signed(isize::from(by[h & 3]))
    }

    /// The names of the corners.
    #[inline(always)]
    pub fn corners(&self, f: usize) -> [usize; 3] {
        let c = self.corners[Self::at(f)];
        [c & 0xffff, c >> 16 & 0xffff, c >> 32 & 0xffff].map(|i| i as usize)
    }

    /// N of a face, outward, no longer than 1 by more than rounding.
    #[inline(always)]
    pub fn normal(&self, f: usize) -> Vec3 {
        self.plane(f).normal()
    }

    /// d of a face, for its [`Polytope::normal`].
    #[inline(always)]
    pub fn offset(&self, f: usize) -> f64 {
        self.plane(f).offset() as f64
    }

    /// N·p − d of a face, for a [`Plane::point`].
    #[inline(always)]
    pub fn height(&self, f: usize, p: &Plane) -> f64 {
        self.plane(f).height(p) as f64
    }

    /// The distance of a face's plane from the origin, metres, negative where it is
    /// outside, less what rounding may have added.
    pub fn distance(&self, f: usize) -> f64 {
        let plane = self.plane(f);
        (plane.offset() / plane.normal().norm() - self.error) as f64
    }

    /// What the distance of a plane may be off by, metres.
    #[inline(always)]
    pub fn error(&self) -> f64 {
        self.error as f64
    }

    /// The points have turned out to be as large as this, metres.
    pub fn grow(&mut self, size: f64) {
        let ulp = f64::EPSILON * size;
        if ulp > self.ulp {
            self.error *= ulp / self.ulp;
            self.ulp = ulp;
        }
    }

    /// An interpolation more: two products and their sum, an ulp of the size each, ten
    /// times as much where |N| is a tenth.
    #[inline(always)]
    fn wear(&mut self) {
        self.error += 20.0 * self.ulp;
    }

    /// The faces that there are.
    pub fn faces(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.used.min(F)).filter(|&f| self.keys[f] < f64::INFINITY)
    }

    #[inline(always)]
    fn key(f: usize, square: f64) -> f64 {
        // Live faces have finite keys.
        let finite = if square < f64::MAX { square } else { f64::MAX };
        f64::from_bits(finite.to_bits() & !NAME | f as u64)
    }

    /// Begins with the tetrahedron of four points. `false`: it is flat within
    /// [`FLAT`]. `size`: of all points that are to come, about, metres.
    /// `exact`: planes are computed from their corners throughout, for tolerances that
    /// interpolation has no digits for.
    #[inline(always)]
    pub fn tetrahedron(
        &mut self,
        names: [usize; 4],
        [o, a, b, c]: [Vec3; 4],
        size: f64,
        exact: bool,
    ) -> bool {
        let (o, mut a, mut b, c) = (o, a, b, c);
        self.ulp = f64::EPSILON * size;
        let flat2 = FLAT * FLAT * self.ulp * self.ulp;
        let (e, f, g) = (a - o, b - o, c - o);
        let n = e.cross(&f);
        let volume = n.dot(&g);
        let long = larger(larger(e.norm_squared(), f.norm_squared()), g.norm_squared());
        let area2 = n.norm_squared();
        // Flat in itself, or so flat that of slivers the volume's sign is rounding, and with it
        // what is outside. Also for NaN.
        let least = SIGNED * f64::EPSILON * long;
        if !(area2 > flat2 * long && volume * volume > least * least * long) {
            return false;
        }
        let [io, mut ia, mut ib, ic] = names.map(|i| i as u64);
        let (mut x, mut y, mut base) = (e, f, -n);
        if volume < 0.0 {
            (x, y, base) = (f, e, n);
            (a, b, ia, ib) = (b, a, ib, ia);
        }
        // Not minus the sum of the others: of a thin tetrahedron that is rounding.
        let (one, three) = (x.cross(&g), g.cross(&y));
        let two = (y - x).cross(&(g - x));
        let face = |i: u64, j: u64, k: u64| i | j << 16 | k << 32 | i << 48;
        let faces = [
            (base, [o, b, a], face(io, ib, ia), [12, 8, 4, 0]),
            (one, [o, a, c], face(io, ia, ic), [2, 10, 13, 0]),
            (two, [a, b, c], face(ia, ib, ic), [1, 14, 5, 0]),
            (three, [b, o, c], face(ib, io, ic), [0, 6, 9, 0]),
        ];
        self.clear();
        let mut widest2 = 0.0;
        for (i, (n, [p, q, r], names, twins)) in faces.into_iter().enumerate() {
            let n2 = n.norm_squared();
            if !(n2 > flat2 * long) {
                return false;
            }
            let n = n / n2.sqrt();
            widest2 = larger(n2, widest2);
            let d = lesser(lesser(n.dot(&p), n.dot(&q)), n.dot(&r));
            self.planes[i] = Plane::new(&n, d).array();
            self.keys[i] = Self::key(i, d * d.abs());
            self.corners[i] = names;
            self.twins[i] = twins;
        }
        (self.used, self.free) = (4, 4);
        self.inner = (o + a + b + c) * 0.25;
        // z is a quarter of the opposite corner's height below a face.
        self.margin = 0.25 * volume.abs() / widest2.sqrt();
        self.error = FRESH * self.ulp;
        (self.collapsed, self.untold) = if exact {
            (f64::INFINITY, 0.0)
        } else {
            (COLLAPSED, UNTOLD)
        };
        self.winds()
    }

    /// Is z below all planes for certain, so that the surface winds around it? (`false` for NaN.)
    #[inline(always)]
    pub fn winds(&self) -> bool {
        self.margin >= self.error
    }

    /// What a face this far away, not behind the origin, may be farther away than the nearest,
    /// metres, because keys did not tell them apart.
    #[inline(always)]
    pub fn untold(&self, distance: f64) -> f64 {
        self.untold as f64 * distance
    }

    /// What is proven of the distance from the origin to all faces, metres.
    pub fn bound(&self, top: &Top) -> f64 {
        if self.untold > 0.0 {
            let near = self.distance(top.face);
            return near - self.untold(near);
        }
        let most = top.key + 4.0 * UNTOLD * top.key.abs();
        let tied = (0..self.used.min(F)).filter(|&f| self.keys[f] <= most);
        tied.fold(f64::INFINITY, |least, f| lesser(self.distance(f), least))
    }

    /// Takes all faces out of use.
    #[inline(always)]
    fn clear(&mut self) {
        self.keys.fill(f64::INFINITY);
        for (next, i) in self.next.iter_mut().zip(1..) {
            *next = i;
        }
    }

    /// The polytope in a larger room.
    pub fn moved_to<const G: usize>(&self, to: &mut Polytope<G>) {
        let used = self.used.min(F).min(G);
        to.clear();
        to.planes[..used].copy_from_slice(&self.planes[..used]);
        to.keys[..used].copy_from_slice(&self.keys[..used]);
        to.twins[..used].copy_from_slice(&self.twins[..used]);
        to.corners[..used].copy_from_slice(&self.corners[..used]);
        to.next[..used].copy_from_slice(&self.next[..used]);
        (to.free, to.used) = (self.free, self.used);
        (to.inner, to.margin) = (self.inner, self.margin);
        (to.error, to.ulp) = (self.error, self.ulp);
        (to.collapsed, to.untold) = (self.collapsed, self.untold);
    }

    /// The nearest face: one sweep over the keys, whose low bits name their faces.
    #[inline(always)]
    pub fn nearest(&self) -> Top {
        let mut least = [f64::INFINITY; 8];
        let last = Self::at(self.used.wrapping_sub(1)) | 7;
        for row in self.keys[..=last].chunks_exact(8) {
            for (a, b) in least.iter_mut().zip(row) {
                *a = if *b < *a { *b } else { *a };
            }
        }
        let mut key = f64::INFINITY;
        for b in least {
            key = if b < key { b } else { key };
        }
        Top {
            face: (key.to_bits() & NAME) as usize,
            key,
        }
    }

    /// Is a face nearer than this key, where tolerances are finer than keys tell? It gets a key
    /// that says so.
    #[inline(always)]
    pub fn is_nearer(&mut self, key: f64) -> bool {
        !(self.untold > 0.0) && self.sharpen(key)
    }

    #[cold]
    #[inline(never)]
    fn sharpen(&mut self, key: f64) -> bool {
        let mut nearer = false;
        for f in 0..self.used.min(F) {
            let (square, _) = self.plane(f).signed_square();
            if self.keys[f] < f64::INFINITY && square < key {
                self.keys[f] = Self::key(f, square * (1.0 - UNTOLD));
                nearer = true;
            }
        }
        nearer
    }

    /// Makes a point a corner: `first` is a face that it is above by more than `rounding`,
    /// metres; `corner` tells the points by their names. `false`: there is no room for its faces;
    /// nothing changed.
    ///
    /// Where the visible faces are no disc, only those count as visible that the point is
    /// eight times as high above, and so on, down to `first` alone.
    #[inline(always)]
    pub fn insert(
        &mut self,
        first: usize,
        name: usize,
        p: &Vec3,
        rounding: f64,
        corner: &impl Fn(usize) -> Vec3,
    ) -> bool {
        let mut above = rounding;
        // Ends: `first` alone is a disc.
        loop {
            match self.fan(first, name, p, above, corner) {
                Fan::NoDisc if above < f64::INFINITY => {
                    let height = self.plane(first).height(&Plane::point(p));
                    above = if 8.0 * above < height {
                        8.0 * above
                    } else {
                        f64::INFINITY
                    };
                }
                fan => return fan == Fan::Done,
            }
        }
    }

    /// One depth-first walk through the visible faces, which comes to the horizon's edges
    /// in their cyclic order: so each new face is made and linked at once.
    #[inline(always)]
    fn fan(
        &mut self,
        first: usize,
        name: usize,
        p: &Vec3,
        rounding: f64,
        corner: &impl Fn(usize) -> Vec3,
    ) -> Fan {
        let lifted = Plane::point(p);
        let mut tail = first;
        self.keys[Self::at(first)] = f64::INFINITY;
        let mut edge = 4 * first;
        // The top of the stack of half-edges to go on from: its face names the one below.
        let mut back = edge + 1;
        self.twins[Self::at(first)][3] = edge as u16 + 2;
        let mut free = self.free;
        let begin = 4 * free;
        let mut previous = begin;
        let mut met_again = false;
        loop {
            let twin = self.twin(edge);
            let hidden = self.plane(twin >> 2);
            let height = hidden.height(&lifted);
            if height > rounding {
                let beyond = Self::at(twin >> 2);
                if self.keys[beyond] != f64::INFINITY {
                    self.keys[beyond] = f64::INFINITY;
                    self.next[Self::at(tail)] = beyond as u16;
                    tail = beyond;
                    self.twins[beyond][3] = back as u16;
                    back = Self::turn(twin, &PREVIOUS);
                    edge = Self::turn(twin, &NEXT);
                    continue;
                }
                met_again = true;
            } else {
                if free >= F {
                    self.undo(first, tail, free);
                    return Fan::NoRoom;
                }
                self.cover(free, edge, [hidden, lifted], name, corner);
                let (f, new) = (Self::at(free), 4 * free);
                self.twins[f][2] = (previous | 1) as u16;
                self.set_twin(twin, new);
                self.set_twin(previous | 1, new | 2);
                previous = new;
                free = usize::from(self.next[f]);
            }
            if back == usize::from(BOTTOM) {
                break;
            }
            edge = back;
            let after = &mut self.twins[Self::at(edge >> 2)][3];
            back = usize::from(core::mem::replace(after, BOTTOM));
        }
        // Also where no face was hidden.
        if begin == 4 * free || met_again && !self.is_loop(begin, previous) {
            self.undo(first, tail, free);
            return Fan::NoDisc;
        }
        self.set_twin(begin | 2, previous | 1);
        self.set_twin(previous | 1, begin | 2);
        self.used = self.used.max(free.min(F));
        self.next[Self::at(tail)] = free as u16;
        self.free = first;
        if self.collapsed < f64::INFINITY {
            self.wear();
        }
        Fan::Done
    }

    /// Makes face `f` over a horizon edge, which it is beyond, and a new point: see the head of
    /// this file.
    #[inline(always)]
    fn cover(
        &mut self,
        f: usize,
        edge: usize,
        [hidden, point]: [Plane; 2],
        name: usize,
        corner: &impl Fn(usize) -> Vec3,
    ) {
        let visible = self.plane(edge >> 2);
        let above = visible.height(&point);
        let below = lesser(hidden.height(&point), 0.0);
        let plane = visible.towards(&hidden, above / (above - below));
        let names = self.corners[Self::at(edge >> 2)] >> (16 * (edge & 3)) & 0x7fff_ffff;
        let f = Self::at(f);
        self.corners[f] = names | (name as u64) << 32 | (names & 0xffff) << 48;
        self.planes[f] = plane.array();
        let (mut square, n2) = plane.signed_square();
        if !(n2 >= self.collapsed) {
            square = self.renew(f, edge >> 2, corner);
        }
        self.keys[f] = Self::key(f, square);
        self.twins[f][0] = self.twin(edge) as u16;
        self.twins[f][3] = edge as u16;
    }

    /// Do the edges of a fan follow each other, and close? From its first half-edge to its
    /// last; the two are not linked yet.
    #[cold]
    #[inline(never)]
    fn is_loop(&self, begin: usize, last: usize) -> bool {
        let ends = |h: usize| {
            let [from, to, _] = self.corners(h >> 2);
            (from, to)
        };
        let mut at = begin;
        // Each face once.
        for _ in 0..F {
            if at == last {
                break;
            }
            let next = self.twin(at | 1) & !3;
            if ends(at).1 != ends(next).0 {
                return false;
            }
            at = next;
        }
        ends(last).1 == ends(begin).0
    }

    /// Takes back a fan that was begun, up to the face `free`: twins as they were, and the
    /// visible faces, from `first` to `tail`, back in use.
    #[cold]
    #[inline(never)]
    fn undo(&mut self, first: usize, tail: usize, free: usize) {
        let mut f = self.free;
        while f != free && f < F {
            let [twin, _, _, before] = self.twins[f];
            self.set_twin(usize::from(twin), usize::from(before));
            self.keys[f] = f64::INFINITY;
            f = usize::from(self.next[f]);
        }
        let mut f = first;
        for _ in 0..F {
            let f_at = Self::at(f);
            self.keys[f_at] = Self::key(f, self.plane(f).signed_square().0);
            if f == tail {
                break;
            }
            f = usize::from(self.next[f_at]);
        }
    }

    /// The plane of face `f` computed from its corners, unit normal, with d the least
    /// N·corner: taken where it inherits what the bound needs, see above. `parent` is the
    /// face it was interpolated from. Returns the signed square distance.
    #[cold]
    #[inline(never)]
    fn renew(&mut self, f: usize, parent: usize, corner: &impl Fn(usize) -> Vec3) -> f64 {
        let f = Self::at(f);
        let (old, parent) = (self.plane(f), self.plane(parent));
        let (square, n2) = old.signed_square();
        // Of a vanished plane neither side nor sign is known: its parent's sign counts.
        let sided = n2 > NOTHING;
        let heir = if sided { &old } else { &parent };
        let plane = match self.through_corners(f, heir, sided, corner) {
            Some((plane, margin)) => {
                self.margin = lesser(margin, self.margin);
                plane
            }
            None if n2 >= COLLAPSED => {
                self.wear();
                return square;
            }
            None if sided && self.error <= WORN * self.ulp * n2.sqrt() => {
                let k = 1.0 / n2.sqrt();
                self.error *= k;
                old.scaled(k)
            }
            // Also for NaN.
            None => parent,
        };
        self.planes[f] = plane.array();
        plane.signed_square().0
    }

    /// The plane through a face's corners and what z is below it by, metres, if the face has an
    /// area and the plane inherits from `old` what the bound needs: z below it, the origin if that
    /// was so, and the side if that is known.
    fn through_corners(
        &self,
        f: usize,
        old: &Plane,
        sided: bool,
        corner: &impl Fn(usize) -> Vec3,
    ) -> Option<(Plane, f64)> {
        let [a, b, p] = self.corners(f).map(corner);
        // Of a sliver's two long edges the product is mostly rounding: a short edge is one.
        let n = crate::math::normal(&p, &a, &b);
        let long = larger((a - p).norm_squared(), (b - p).norm_squared());
        let n2 = n.norm_squared();
        let flat = FLAT * self.ulp;
        if !(n2 > flat * flat * long) {
            return None;
        }
        let n = n / n2.sqrt();
        let d = lesser(lesser(n.dot(&a), n.dot(&b)), n.dot(&p));
        let margin = d - n.dot(&self.inner);
        let inherits = (!sided || n.dot(&old.normal()) > 0.0)
            && margin >= larger(FRESH * self.ulp, self.error)
            && (d > 0.0 || !(old.offset() > 0.0));
        inherits.then(|| (Plane::new(&n, d), margin))
    }

    /// The direction to ask for the nearest face `top`: the sum of its normal, its three
    /// neighbours' and half of their neighbours', as far as they look the same way and are
    /// nearer than `target` (a signed square, m²). Not unit.
    ///
    /// Each face nearer than the target has to go, so a point above several of them
    /// saves support points: near a smooth minimum the corners are a Delaunay triangulation
    /// of the tangent plane, a point is above the faces whose circumcircles hold it, and a
    /// normal leads to the centre of one of them; a mean of normals leads to where they overlap
    /// (measured, the minimum to 1e-6: spheres 48.5 support points to 31.6, ellipsoids 38.6 to
    /// 29.3, 162-vertex polytopes 17.1 to 16.3; boxes pay 9.2 to 9.6).
    #[inline(always)]
    pub fn mean_normal(&self, top: usize, target: f64) -> Vec3 {
        let f = self.plane(top);
        let (mut first, mut second) = (f, None);
        for i in 0..3 {
            let twin = self.twin(4 * top + i);
            let g = self.plane(twin >> 2);
            if self.keys[Self::at(twin >> 2)] < target && g.along(&f) > 0.0 {
                first = first.plus(&g);
                for by in [&NEXT, &PREVIOUS] {
                    let other = self.twin(Self::turn(twin, by)) >> 2;
                    let k = self.plane(other);
                    if self.keys[Self::at(other)] < target && k.along(&f) > 0.0 {
                        second = Some(second.map_or(k, |s: Plane| s.plus(&k)));
                    }
                }
            }
        }
        let sum = second.map_or(first, |second| first.plus(&second.scaled(0.5)));
        sum.normal()
    }
}

#[derive(PartialEq, Eq)]
enum Fan {
    Done,
    NoRoom,
    NoDisc,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    const F: usize = 1024;
    const EPSILON: f64 = f64::EPSILON;
    /// A point is above a unit polytope by more than this.
    const LEVEL: f64 = 8.0 * EPSILON as f64;

    /// What must hold of every polytope, whatever went in: a closed surface, all planes at
    /// or below their corners and above the inner point.
    pub fn check<const F: usize>(hull: &Polytope<F>, points: &[Vec3]) {
        let mut edges = 0;
        for f in hull.faces() {
            let plane = hull.plane(f);
            let length = plane.normal().norm();
            for i in hull.corners(f) {
                let below = -plane.height(&Plane::point(&points[i])) / length;
                assert!(below <= hull.error, "{below} {}", hull.error);
            }
            assert!(plane.normal().dot(&hull.inner) < plane.offset());
            assert!(hull.keys[f] < f64::INFINITY);
            for e in 0..3 {
                let twin = hull.twin(4 * f + e);
                assert_eq!(hull.twin(twin), 4 * f + e);
                assert!(hull.keys[twin >> 2] < f64::INFINITY);
                let (mine, other) = (hull.corners(f), hull.corners(twin >> 2));
                assert_eq!(mine[e], other[((twin & 3) + 1) % 3]);
                assert_eq!(mine[(e + 1) % 3], other[twin & 3]);
                edges += 1;
            }
        }
        assert_eq!(edges % 2, 0);
    }

    /// The face that a point is farthest above, if by more than `rounding`, metres.
    fn farthest_below<const F: usize>(
        hull: &Polytope<F>,
        p: &Plane,
        rounding: f64,
    ) -> Option<usize> {
        let mut best = (None, rounding);
        for f in hull.faces() {
            let height = hull.plane(f).height(p);
            if height > best.1 {
                best = (Some(f), height);
            }
        }
        best.0
    }

    /// The hull of the points in their order; the first four are the tetrahedron.
    fn grown(points: &[Vec3], exact: bool) -> Option<Box<Polytope<F>>> {
        let mut hull = Box::new(Polytope::<F>::BLANK);
        let size = points.iter().fold(0.0, |m: f64, p| m.max(p.norm()));
        let rounding = LEVEL * size;
        let first = [0, 1, 2, 3].map(|i| points[i]);
        if !hull.tetrahedron([0, 1, 2, 3], first, size, exact) {
            return None;
        }
        for (i, p) in points.iter().enumerate().skip(4) {
            if let Some(f) = farthest_below(&hull, &Plane::point(p), rounding) {
                let done = hull.insert(f, i, p, rounding, &|i| points[i]);
                assert!(done);
            }
            check(&hull, points);
        }
        Some(hull)
    }

    /// The distance from the origin to the boundary of the hull, negative outside: over
    /// all planes through three points that have all others on one side.
    fn exact_distance(points: &[Vec3]) -> f64 {
        let points: Vec<_> = points.to_vec();
        let mut least = f64::INFINITY;
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                for c in &points[j + 1..] {
                    let n = (b - a).cross(&(c - a));
                    let Some(n) = n.try_normalize(0.0) else {
                        continue;
                    };
                    for n in [n, -n] {
                        let h = points
                            .iter()
                            .fold(f64::NEG_INFINITY, |m, p| m.max(n.dot(p)));
                        if h <= n.dot(a) + 1e3 * EPSILON {
                            least = least.min(h);
                        }
                    }
                }
            }
        }
        least
    }

    fn nearest<const F: usize>(hull: &Polytope<F>) -> f64 {
        let plane = hull.plane(hull.nearest().face);
        plane.offset() / plane.normal().norm() - hull.error
    }

    #[test]
    fn hulls_of_random_points_are_exact() {
        let mut r = Random::new(1);
        for round in 0..200 {
            let points: Vec<_> = (0..14).map(|_| r.vector(1.0)).collect();
            let Some(hull) = grown(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (nearest(&hull), exact_distance(&points));
            assert!((found - exact).abs() <= 2.0 * hull.error + 64.0 * EPSILON);
        }
    }

    /// Ties, coplanar and collinear points, points twice: the bound holds, and is the
    /// distance to the level at which points count as on a face.
    #[test]
    fn hulls_of_grid_points_are_bounded() {
        let mut r = Random::new(2);
        for round in 0..2000 {
            let steps = [2.0, 3.0, 4.0][round % 3];
            let mut grid = || (r.within(0.0, steps + 1.0).floor() - 0.5 * steps) / steps;
            let points: Vec<_> = (0..16).map(|_| Vec3::new(grid(), grid(), grid())).collect();
            let Some(hull) = grown(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (nearest(&hull), exact_distance(&points));
            assert!(found <= exact + 16.0 * EPSILON, "{found} {exact}");
            assert!(
                found >= exact - 2.0 * hull.error - 1e3 * EPSILON,
                "{round} {found} {exact}"
            );
        }
    }

    /// The middle of two support points as the first corner, and both of them after it.
    #[test]
    fn an_apex_on_a_segment() {
        let mut r = Random::new(3);
        for round in 0..2000 {
            let mut points: Vec<_> = (0..12).map(|_| r.vector(1.0)).collect();
            points[0] = (points[1] + points[4]) * 0.5;
            let Some(hull) = grown(&points, round % 2 == 0) else {
                continue;
            };
            let (found, exact) = (nearest(&hull), exact_distance(&points[1..]));
            assert!(found <= exact + 16.0 * EPSILON, "{round} {found} {exact}");
            assert!(
                found >= exact - 2.0 * hull.error - 1e3 * EPSILON,
                "{round} {found} {exact}"
            );
        }
    }

    /// Spheres of points and flat discs: slivers, thin wedges, many faces.
    #[test]
    fn thin_and_round_hulls_keep_the_invariant() {
        let mut r = Random::new(4);
        for thin in [1.0, 1e-3, 1e-6, 1e-9, 1e-12] {
            for round in 0..20 {
                let mut points = r.points(120, 1.0);
                for p in &mut points {
                    p.z *= thin as f64;
                }
                grown(&points, round % 2 == 0);
            }
        }
    }

    /// A room that is too small is told, and nothing has changed; the larger one goes on.
    #[test]
    fn a_full_room_is_left_whole() {
        let mut r = Random::new(5);
        let points = r.points(60, 1.0);
        let mut small = Polytope::<32>::BLANK;
        let first = [0, 1, 2, 3].map(|i| points[i]);
        assert!(small.tetrahedron([0, 1, 2, 3], first, 1.0, false));
        let mut large = Polytope::<256>::BLANK;
        let mut full = false;
        for (i, p) in points.iter().enumerate().skip(4) {
            let seen = Plane::point(p);
            if !full {
                if let Some(f) = farthest_below(&small, &seen, LEVEL) {
                    let before: Vec<_> = small.faces().map(|f| small.corners(f)).collect();
                    if !small.insert(f, i, p, LEVEL, &|i| points[i]) {
                        let after: Vec<_> = small.faces().map(|f| small.corners(f)).collect();
                        assert_eq!(before, after);
                        check(&small, &points);
                        small.moved_to(&mut large);
                        full = true;
                    }
                }
            }
            if full {
                if let Some(f) = farthest_below(&large, &seen, LEVEL) {
                    assert!(large.insert(f, i, p, LEVEL, &|i| points[i]));
                }
                check(&large, &points);
            }
        }
        assert!(full && large.faces().count() > 32);
    }

    #[test]
    fn flat_tetrahedra_are_refused() {
        let mut hull = Polytope::<32>::BLANK;
        let [o, x, y] = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        for d in [
            o,
            x,
            y * 0.5,
            x + y,
            Vec3::z() * EPSILON as f64,
            Vec3::repeat(f64::NAN),
        ] {
            assert!(!hull.tetrahedron([0, 1, 2, 3], [o, x, y, d], 1.0, false));
        }
        assert!(hull.tetrahedron([0, 1, 2, 3], [o, x, y, Vec3::z()], 1.0, false));
    }
}
