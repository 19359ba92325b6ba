// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What the objects look like from the deepest place of a hit, in the plane across its normal.
//!
//! *Four corners.* Of an object four points are asked for, [`View::tilt`] aside of the normal and a right
//! angle apart. Three cases are known by what these found, and seen to:
//!
//! *Beyond a side.* Where two of the four directions look along the sides of a rectangle a corner
//! is found twice, and another not at all: it is beyond the longest side of the three. Where the deepest
//! place lies beyond a side of the four, the face has more corners there. Three corners span the face's
//! plane, whose own slope is taken off: so the direction across that side, outwards, finds what is beyond it.
//!
//! *A rim.* A disc answers a direction by its middle and the radius that way. Where four points do, to the
//! last bits, those between lie on the rim too, and are not asked for. (Corners of a square do where it
//! lies as the four directions do, to a ten thousandth of a radian.)

use crate::contacts::fan::Fan;
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{Corner, Flat, cross, dot, length, side};
use crate::contacts::seen::{Floor, Seen};
use crate::math::{EPSILON, Vec3, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap};

/// The corners that are asked for at first: towards the plane's axes, and away from them.
pub const FOUR: usize = 4;
/// Cosines and sines of those directions, and of four between them.
const CIRCLE: [Flat; 2 * FOUR] = {
    const H: f64 = core::f64::consts::FRAC_1_SQRT_2 as f64;
    [
        [1.0, 0.0],
        [H, H],
        [0.0, 1.0],
        [-H, H],
        [-1.0, 0.0],
        [-H, -H],
        [0.0, -1.0],
        [H, -H],
    ]
};
/// How far a point of a rim may be beside it, as a share of the radius: ten times what callbacks in single
/// precision round by.
const RIM: f64 = if EPSILON < 1e-10 { 1e-4 } else { 1e-3 };
/// How much lower than the plane of the others the fourth corner of a face may be, in units of the depth:
/// else it is another face's, and the space before it is not as low as a line to it would say.
/// Insensitive: 0.1 to 1 tried on recorded contacts, and 0.02 leaves a corner out.
const SAME_FACE: f64 = 0.1;
/// The deepest place is beyond a side where it is by this share of the area of four corners: rounding is
/// less. Insensitive: 0.005 to 0.08 tried (`extension/pressure.c`).
const BEYOND: f64 = 0.02;
/// A point that was found no farther aside of a direction than this, in tilts, is the one that would
/// be found there: less than the ÷1.2 and ×1.2 of the tilt that are seen.
const SAME: f64 = 0.1;
/// The least height of three corners above their longest side, as a share of that: else they are a line.
/// Insensitive: 0.005 to 0.08 tried (`extension/pressure.c`).
const NARROW: f64 = 0.02;

/// Share of what all four corners are lower by that is taken off. Measured: 0 lets a lying capsule step by 5 mm, 1
/// leaves it 7 mm off.
const LEVEL: f64 = 0.75;

/// Corners a right angle apart, in their order. At: from the deepest place; low: in units of the depth.
pub type Four = [Corner; FOUR];

/// The plane across the normal, at the deepest place, and who is seen in it.
pub struct View<'q, A, B> {
    pub md: &'q MinkowskiDifference<A, B>,
    /// What the search found, and the directions of a state that stands.
    pub seen: &'q Seen,
    pub others: &'q [Vec3],
    /// Half-way between the support planes.
    pub plane: &'q Plane,
    /// How far these are from there, metres.
    pub half: f64,
    /// The unit of lows, metres, and one over it.
    pub depth: f64,
    pub share: f64,
    /// Of the directions asked: the tangent of the angle to the normal.
    pub tilt: f64,
    /// Those of D in which obj1 is asked for its four corners; obj2 is for the opposite ones.
    pub directions: [Vec3; FOUR],
    /// By how much corners are moved outwards, metres: two that are nearer than twice that are one.
    pub hair: f64,
}

impl<A: SupportMap, B: SupportMap> View<'_, A, B> {
    /// What the search found about there.
    #[inline(always)]
    fn found(&self, d: &Vec3) -> Option<[Vec3; 2]> {
        let Seen::Standing(found) = self.seen else {
            return None;
        };
        let near2 = SAME * SAME * self.tilt * self.tilt;
        let is_same = |n: &Vec3| (d - n).norm_squared() <= near2;
        found.get(self.others.iter().position(is_same)?).copied()
    }

    /// The corner of an object in a direction of D.
    #[inline(always)]
    fn ask(&self, object: usize, d: &Vec3) -> Result<Corner, Fault> {
        let point = match self.found(d) {
            Some(points) => points[object % 2],
            None => self.md.point_of(object, d),
        };
        let mut corner = self.plane.corner(sign(object), &point)?;
        corner.low = larger((corner.low + self.half) * self.share, 0.0);
        Ok(corner)
    }

    /// The corner of an object in the `k`th of the four directions.
    #[inline(always)]
    fn corner(&self, object: usize, k: usize) -> Result<Corner, Fault> {
        self.ask(object, &self.directions[(k + FOUR / 2 * object) % FOUR])
    }

    /// Its corners in the four directions.
    #[inline(never)]
    pub fn look(&self, object: usize, four: &mut Four) -> Result<(), Fault> {
        for (k, corner) in four.iter_mut().enumerate() {
            *corner = self.corner(object, k)?;
        }
        Ok(())
    }

    /// The same of one of which a floor is known, no more than until that holds the other. Does it?
    #[inline(always)]
    pub fn look_beyond(&self, floor: &Floor, on: &Fan, four: &mut Four) -> Result<bool, Fault> {
        match floor.lacks(ends(on), 2.0 * self.hair) {
            Some(at) => self.look_towards(at, *floor, on, four),
            None => Ok(true),
        }
    }

    #[inline(never)]
    fn look_towards(
        &self,
        mut at: Flat,
        mut floor: Floor,
        on: &Fan,
        four: &mut Four,
    ) -> Result<bool, Fault> {
        let mut left = [0, 1, 2, 3];
        for asked in 0..FOUR {
            // Where it lacks most is asked first.
            let far = |i: usize| dot(&CIRCLE[2 * left[i % FOUR] % CIRCLE.len()], &at);
            let next = (asked + 1..FOUR).fold(asked, |k, i| if far(i) > far(k) { i } else { k });
            left.swap(asked, next % FOUR);
            let k = left[asked] % FOUR;
            four[k] = self.corner(floor.object, k)?;
            floor.add(&four[k]);
            match floor.lacks(ends(on), 2.0 * self.hair) {
                Some(lacks) => at = lacks,
                None => return Ok(true),
            }
        }
        Ok(false)
    }

    /// The fan of the four, and of what else the object has there: corners a hair beyond their places, towards
    /// where they were asked for.
    #[inline(never)]
    pub fn fan(&self, object: usize, four: &Four, fan: &mut Fan) -> Result<(), Fault> {
        let sides = [0, 1, 2, 3].map(|i| side(&four[i].at, &four[(i + 1) % FOUR].at));
        let lengths2 = sides.map(|s| dot(&s, &s));
        let least2 = 4.0 * self.hair * self.hair;
        let twice = lengths2.iter().position(|l| *l <= least2);
        let rim = if twice.is_none() {
            self.rim(four)
        } else {
            None
        };
        let lows = four.iter().chain(rim.iter().flatten()).map(|c| c.low);
        let level = lows.fold(1.0, lesser) * LEVEL;
        let seen = |corner: &Corner, way: &Flat| Corner {
            at: [0, 1].map(|i| corner.at[i] + self.hair * way[i]),
            low: corner.low - level,
        };
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| seen(&four[k], &CIRCLE[2 * k]));
        if let Some(rim) = rim {
            let [ab, bc, cd, da] = [0, 1, 2, 3].map(|k| seen(&rim[k], &CIRCLE[2 * k + 1]));
            fan.fill([a, ab, b, bc, c, cd, d, da]);
            return Ok(());
        }
        fan.fill([a, b, c, d]);
        if let Some((i, out, corner)) = self.beyond(object, four, &lengths2, twice)? {
            fan.insert(i, seen(&corner, &out));
        }
        Ok(())
    }

    /// The corner that an object has besides the four: its place among them, the way outwards, and itself.
    #[inline(always)]
    fn beyond(
        &self,
        object: usize,
        four: &Four,
        lengths2: &[f64; FOUR],
        twice: Option<usize>,
    ) -> Result<Option<(usize, Flat, Corner)>, Fault> {
        // The side beyond which there may be another, from corner `i` to the next, and a corner across from it.
        let (i, third) = if let Some(twice) = twice {
            // The longest of the three; across is what is neither of its ends.
            let longest = (1..FOUR).fold(0, |k, j| if lengths2[j] > lengths2[k] { j } else { k });
            (
                longest,
                longest + if (longest + 1) % FOUR == twice { 3 } else { 2 },
            )
        } else {
            let areas = [0, 1, 2, 3].map(|i| cross(&four[i].at, &four[(i + 1) % FOUR].at));
            let least = (1..FOUR).fold(0, |k, j| if areas[j] < areas[k] { j } else { k });
            if !(areas[least] < -BEYOND * areas.iter().sum::<f64>()) {
                return Ok(None);
            }
            (least, least + 2)
        };
        let [o, p, q] = [third, i, i + 1].map(|j| &four[j % FOUR]);
        let along = side(&p.at, &q.at);
        let whole = length(&along);
        let height = cross(&along, &side(&p.at, &o.at)) / whole;
        // Beyond a side that is all too low nothing is shared.
        if !(height > NARROW * whole && height > 2.0 * self.hair && lesser(p.low, q.low) < 1.0) {
            return Ok(None);
        }
        let slope = self.slope([o, p, q]);
        let out = [along[1] / whole, -along[0] / whole];
        let aside = [slope[0] + out[0] * self.tilt, slope[1] + out[1] * self.tilt];
        let sign = sign(object);
        let corner = self.ask(object, &(self.plane.direction(sign, &aside) * sign))?;
        let is_beyond = dot(&out, &side(&p.at, &corner.at)) > 2.0 * self.hair;
        if is_beyond && corner.low <= self.low(o, &slope, &corner.at) + SAME_FACE {
            return Ok(Some((i + 1, out, corner)));
        }
        Ok(None)
    }

    /// The slope of the plane of three corners: how much lower it is a metre along each axis.
    fn slope(&self, [a, b, c]: [&Corner; 3]) -> Flat {
        let (v, w) = (side(&a.at, &b.at), side(&a.at, &c.at));
        let share = self.depth / cross(&v, &w);
        let (dv, dw) = ((b.low - a.low) * share, (c.low - a.low) * share);
        [dv * w[1] - dw * v[1], dw * v[0] - dv * w[0]]
    }

    /// How low the plane through a corner is at a place.
    fn low(&self, corner: &Corner, slope: &Flat, at: &Flat) -> f64 {
        corner.low + dot(slope, &side(&corner.at, at)) / self.depth
    }

    /// The corners between, where the four lie on the rim of a disc.
    #[inline(never)]
    fn rim(&self, four: &Four) -> Option<Four> {
        let [a, b, c, _] = four;
        let slope = self.slope([a, b, c]);
        // Where a disc that leans so reaches farthest: the direction without its part along the disc's axis.
        let share = 1.0 / (1.0 + dot(&slope, &slope));
        let out = |k: usize| {
            let aside = side(&slope, &CIRCLE[k % CIRCLE.len()].map(|x| x * self.tilt));
            let down = dot(&slope, &aside) * share;
            let out = [aside[0] - slope[0] * down, aside[1] - slope[1] * down];
            let share = 1.0 / (dot(&out, &out) + down * down).sqrt();
            out.map(|x| x * share)
        };
        let first = out(0);
        let (across, chord) = (side(&out(4), &first), side(&c.at, &a.at));
        let whole2 = dot(&across, &across);
        // Other faces' corners mostly lie in other directions.
        if !(cross(&across, &chord).powi(2) <= RIM * whole2 * dot(&chord, &chord)) {
            return None;
        }
        let radius = dot(&chord, &across) / whole2;
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
        let is_rim = radius > 2.0 * self.hair && is_there(1) && is_there(3) && is_there(2);
        is_rim.then(|| [1, 3, 5, 7].map(on_rim))
    }
}

/// How far an object reaches towards its corners, as far as the depth goes.
#[inline(always)]
fn ends(fan: &Fan) -> impl Iterator<Item = Flat> + '_ {
    fan.iter().map(|c| c.outer().at)
}

/// 1 of the object whose face looks along the normal, -1 of the other.
fn sign(object: usize) -> f64 {
    if object == 0 { 1.0 } else { -1.0 }
}
