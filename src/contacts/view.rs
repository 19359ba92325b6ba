// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The plane across the normal of a hit, at its deepest place, and how the objects are asked for what
//! they look like from there.
//!
//! *Four corners.* Of an object four points are asked for, [`View::tilt`] aside of the normal and a right
//! angle apart. Three cases are known by what these found, and seen to:
//!
//! *The fourth of a face.* Where two of the four directions look along the sides of a rectangle a corner
//! is found twice, and another not at all. Three corners span the face's plane, whose own slope is
//! taken off: so the direction across the longest side of the three, outwards, finds what is beyond it.
//!
//! *A rim.* A disc answers a direction by its middle and the radius that way. Where four points do, to the
//! last bits, those between lie on the rim too, and are not asked for. (Corners of a square do where it
//! lies as the four directions do, to a ten thousandth of a radian.)
//!
//! *More corners.* Else where the deepest place lies beyond a side of the four, the face has more of
//! them: another four directions, between the first.

use crate::contacts::fan::Corner;
use crate::contacts::polygon::{Flat, cross, dot, length, side};
use crate::known::support::{Fault, MinkowskiDifference, SupportMap};
use crate::math::{EPSILON, Real, Vec3, larger, lesser};

/// Directions: four a right angle apart at even places, and four between them.
pub const WAYS: usize = 8;
/// The corners that are asked for at first.
pub const FOUR: usize = WAYS / 2;
/// Their cosines and sines in the plane's axes. Of a box whose axes are the world's no two corners
/// are as far in any of the four.
pub const CIRCLE: [Flat; WAYS] = {
    const X: Real = 11.0 / 61.0;
    const Y: Real = 60.0 / 61.0;
    const H: Real = core::f64::consts::FRAC_1_SQRT_2 as Real;
    const U: Real = (X - Y) * H;
    const V: Real = (X + Y) * H;
    [
        [X, Y],
        [U, V],
        [-Y, X],
        [-V, U],
        [-X, -Y],
        [-U, -V],
        [Y, -X],
        [V, -U],
    ]
};
/// How far a point of a rim may be beside it, as a share of the radius: ten times what callbacks in single
/// precision round by.
const RIM: Real = if EPSILON < 1e-10 { 1e-4 } else { 1e-3 };
/// How much lower than the plane of the others the fourth corner of a face may be, in units of the depth:
/// else it is another face's, and the space before it is not as low as a line to it would say.
/// Insensitive: 0.1 to 1 tried on recorded contacts, and 0.02 leaves a corner out.
const SAME_FACE: Real = 0.1;
/// The least height of three corners above their longest side, as a share of that: else they are a line.
/// Insensitive.
const NARROW: Real = 0.02;

/// The plane across the normal, at the deepest place.
pub struct View {
    /// A point half-way between the support planes.
    pub middle: Vec3,
    /// The unit of lows, metres, and its inverse.
    pub depth: Real,
    pub share: Real,
    /// How far the support planes are from the middle, in units of that.
    pub half: Real,
    /// Unit.
    pub n: Vec3,
    /// Unit, across it and each other.
    pub axes: [Vec3; 2],
    /// Of the directions asked: the tangent of the angle to the normal, and its cosine.
    pub tilt: Real,
    pub cosine: Real,
    /// What is nearer is the same, metres.
    pub near: Real,
}

/// Corners a right angle apart, in their order.
pub type Four = [Corner; FOUR];

impl View {
    /// The unit direction of D that asks obj1 with this tilt in the plane; `cosine`: of its angle to the
    /// normal, about.
    #[inline(always)]
    pub fn direction(&self, aside: &Flat, cosine: Real) -> Vec3 {
        let [e1, e2] = &self.axes;
        let d = (self.n + (e1 * aside[0] + e2 * aside[1])) * cosine;
        // Unit to its last bits.
        d * (1.5 - 0.5 * d.norm_squared())
    }

    /// What the `k`th direction is tilted by.
    #[inline(always)]
    pub fn way(&self, k: usize) -> Flat {
        CIRCLE[k % WAYS].map(|x| x * self.tilt)
    }

    /// A point of an object, as seen.
    #[inline(always)]
    fn corner(&self, object: usize, p: &Vec3) -> Result<Corner, Fault> {
        let p = p - self.middle;
        let q = p.norm_squared();
        // As in D.
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        let [e1, e2] = &self.axes;
        let up = self.n.dot(&p) * self.share;
        let low = self.half - if object == 0 { up } else { -up };
        Ok(Corner {
            at: [e1.dot(&p), e2.dot(&p)],
            low: larger(low, 0.0),
        })
    }

    /// The corner of an object that is farthest along the normal with this tilt in the plane; `known`
    /// may have it.
    #[inline(always)]
    fn ask<A: SupportMap, B: SupportMap>(
        &self,
        md: &MinkowskiDifference<A, B>,
        object: usize,
        (aside, cosine): (&Flat, Real),
        known: &dyn Fn(&Vec3) -> Option<[Vec3; 2]>,
    ) -> Result<Corner, Fault> {
        let sign = if object == 0 { 1.0 } else { -1.0 };
        let d = self.direction(&aside.map(|x| sign * x), cosine);
        let point = match known(&d) {
            Some(points) => points[object % 2],
            None => md.point_of(object, &d),
        };
        self.corner(object, &point)
    }

    /// The corners of an object in the four directions from `first` on, 0 or 1. `known` may have them.
    #[inline(never)]
    pub fn four<A: SupportMap, B: SupportMap>(
        &self,
        md: &MinkowskiDifference<A, B>,
        object: usize,
        first: usize,
        known: &dyn Fn(&Vec3) -> Option<[Vec3; 2]>,
    ) -> Result<Four, Fault> {
        let mut four = Four::default();
        for (i, corner) in four.iter_mut().enumerate() {
            *corner = self.ask(md, object, (&self.way(2 * i + first), self.cosine), known)?;
        }
        Ok(four)
    }

    /// The slope of the plane of three corners: how much lower it is a metre along each axis.
    fn slope(&self, [a, b, c]: [&Corner; 3]) -> Flat {
        let (v, w) = (side(&a.at, &b.at), side(&a.at, &c.at));
        let share = self.depth / cross(&v, &w);
        let (dv, dw) = ((b.low - a.low) * share, (c.low - a.low) * share);
        [dv * w[1] - dw * v[1], dw * v[0] - dv * w[0]]
    }

    /// How low the plane through a corner is at a place.
    fn low(&self, corner: &Corner, slope: &Flat, at: &Flat) -> Real {
        corner.low + dot(slope, &side(&corner.at, at)) * self.share
    }

    /// The corners between, where the four lie on the rim of a disc.
    #[inline(never)]
    pub fn rim(&self, four: &Four) -> Option<Four> {
        let [a, b, c, _] = four;
        let slope = self.slope([a, b, c]);
        // Where a disc that leans so reaches farthest.
        let out = |k: usize| {
            let out = side(&slope, &self.way(k));
            let share = 1.0 / length(&out);
            out.map(|x| x * share)
        };
        let first = out(0);
        let across = side(&out(4), &first);
        let radius = dot(&side(&c.at, &a.at), &across) / dot(&across, &across);
        let on_rim = |k: usize| {
            let way = side(&first, &out(k));
            let at = [a.at[0] + radius * way[0], a.at[1] + radius * way[1]];
            let low = self.low(a, &slope, &at);
            Corner { at, low }
        };
        let most = RIM * radius;
        // False for NaN. Of other faces mostly the first is none.
        let is_there = |i: usize| {
            let (rim, found) = (on_rim(2 * i), &four[i % FOUR]);
            let off = side(&rim.at, &found.at);
            dot(&off, &off) <= most * most && (rim.low - found.low).abs() <= SAME_FACE
        };
        let is_rim = radius > self.near && [1, 3, 2].into_iter().all(is_there);
        is_rim.then(|| [1, 3, 5, 7].map(on_rim))
    }

    /// Which corner was found twice, in this direction and in the next.
    #[inline(always)]
    pub fn twice(&self, four: &Four) -> Option<usize> {
        let near2 = self.near * self.near;
        (0..FOUR).find(|i| apart2(&four[*i], &four[(i + 1) % FOUR]) <= near2)
    }

    /// A face of which three corners were found, that one `twice`, with the fourth in its place, if it has
    /// one.
    #[cold]
    #[inline(never)]
    pub fn fourth<A: SupportMap, B: SupportMap>(
        &self,
        md: &MinkowskiDifference<A, B>,
        object: usize,
        four: &Four,
        twice: usize,
    ) -> Result<Option<Four>, Fault> {
        // Around: the one that is there twice, and the others. The longest side's ends, and what is across.
        let three = [0, 2, 3].map(|j| &four[(twice + j) % FOUR]);
        let sides2 = [0, 1, 2].map(|j| apart2(three[(j + 1) % 3], three[(j + 2) % 3]));
        let longest = (1..3).fold(0, |k, j| if sides2[j] > sides2[k] { j } else { k });
        let [o, p, q] = [0, 1, 2].map(|j| three[(longest + j) % 3]);
        let along = side(&p.at, &q.at);
        let length = sides2[longest].sqrt();
        let height = cross(&along, &side(&p.at, &o.at)) / length;
        // Beyond a side that is all too low nothing is shared.
        if !(height > NARROW * length && height > self.near && lesser(p.low, q.low) < 1.0) {
            return Ok(None);
        }
        let slope = self.slope([o, p, q]);
        let out = [along[1] / length, -along[0] / length];
        let aside = [slope[0] + out[0] * self.tilt, slope[1] + out[1] * self.tilt];
        let cosine = 1.0 / (1.0 + dot(&aside, &aside)).sqrt();
        let corner = self.ask(md, object, (&aside, cosine), &|_| None)?;
        let is_new = dot(&out, &side(&p.at, &corner.at)) > self.near
            && corner.low <= self.low(o, &slope, &corner.at) + SAME_FACE;
        // In their order, each in the direction that is nearest to where it is.
        let around = [o, p, &corner, q];
        let face = |turn: usize| [0, 1, 2, 3].map(|i| *around[(i + turn) % FOUR]);
        let reach = |turn: usize| {
            let corners = face(turn).into_iter().enumerate();
            corners
                .map(|(i, c)| dot(&CIRCLE[2 * i % WAYS], &c.at))
                .sum::<Real>()
        };
        let best = (1..FOUR).fold(0, |k, j| if reach(j) > reach(k) { j } else { k });
        Ok(is_new.then(|| face(best)))
    }
}

/// The square of how far two corners are apart.
#[inline(always)]
fn apart2(p: &Corner, q: &Corner) -> Real {
    let way = side(&p.at, &q.at);
    dot(&way, &way)
}
