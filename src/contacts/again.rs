// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A face that is known from the last query, asked again.
//!
//! Nothing of it is believed. Its corners are asked anew, along directions that also show what
//! lies beyond them; unless they are as far from each other as they were, and all of them on
//! the face, the search for corners begins from nothing.
//!
//! *A polygon* is asked once a side: across it, with a [`LEAN`] to its second corner, which is
//! to be found. So each corner is found, and nothing sticks out of any side.
//!
//! *A segment* is asked across, either way, and beyond each end. A round end answers two
//! directions across each other; what its radii along and across move it by is known then.
//!
//! *A point* is asked three times around, and is the mean: roundness of any kind cancels.
//!
//! *A curved face*, whose polygon is inscribed, is asked along the directions that found it.
//!
//! Where corners are round, or something is higher than all of them, the face's own direction
//! tells how high it is.

use crate::contacts::manifold::{CIRCLE, CORNERS, Face, Plane};
use crate::contacts::polygon::{Corner, Flat, Polygon, dot, length, side};
use crate::known::support::{Fault, SupportMap};
use crate::math::{EPSILON, Real, Vec3, larger, largest};

/// Directions that a face is asked along, at most: each corner's, and its own.
pub const ASKS: usize = CORNERS + 1;
/// How far a direction across a side leans to its second corner, in tilts: 3.6°. By as much a
/// face may have turned about the normal since. Insensitive: 1/64 to 1/8 tried.
const LEAN: Real = 1.0 / 16.0;
/// Places are kept as `f32`, and are known to this share of the size of the face.
const KEPT: Real = 4.0 * f32::EPSILON as Real;

/// What is kept as an `f32`.
#[allow(clippy::unnecessary_cast, reason = "it is one in double precision")]
pub fn short(x: Real) -> f32 {
    x as f32
}

/// What was kept as an `f32`.
#[allow(clippy::useless_conversion, reason = "it is none in double precision")]
pub fn long(x: f32) -> Real {
    Real::from(x)
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Known {
    /// Where in the plane.
    pub at: [f32; 2],
    /// How far below the support plane.
    pub low: f32,
    /// The tilt of a direction that found it.
    pub aside: [f32; 2],
    /// How much farther it is found for each tilt.
    pub radius: f32,
}

/// The corners of a face, counterclockwise; no tilt stands for none.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Ring {
    pub tilt: f32,
    pub slop: f32,
    /// How much higher than its highest corner the face is.
    pub excess: f32,
    /// The largest radius of its corners.
    pub radius: f32,
    /// How many corners, a whole number.
    pub len: f32,
    /// Not 0: a curved face, or one of more corners.
    pub inscribed: f32,
    pub corners: [Known; CORNERS],
}

/// What a face moved like from one query to the next, in the plane.
#[derive(Clone, Copy)]
pub struct Motion {
    /// Cosine and sine of the angle.
    turn: Flat,
    from: Flat,
    to: Flat,
}

impl Motion {
    /// Where a point that moved along is now.
    pub fn of(&self, at: &Flat) -> Flat {
        let [x, y] = turned(&side(&self.from, at), &self.turn);
        [self.to[0] + x, self.to[1] + y]
    }
}

fn turned([x, y]: &Flat, [c, s]: &Flat) -> Flat {
    [c * x - s * y, s * x + c * y]
}

/// Support points of a face that was asked again.
pub struct Asked {
    asides: [Flat; ASKS],
    points: [Vec3; ASKS],
    len: usize,
}

impl Asked {
    /// The first of them.
    pub fn first(&self) -> Vec3 {
        self.points[0]
    }

    /// Where each was found in the plane, and its height along the way the face looks.
    fn found(&self, plane: &Plane, sign: Real) -> [(Flat, Real); ASKS] {
        self.points
            .map(|p| (plane.flat(&p), sign * plane.height(&p)))
    }
}

impl Ring {
    /// None known.
    pub const NONE: Self = Self {
        tilt: 0.0,
        slop: 0.0,
        excess: 0.0,
        radius: 0.0,
        len: 0.0,
        inscribed: 0.0,
        corners: [Known {
            at: [0.0; 2],
            low: 0.0,
            aside: [0.0; 2],
            radius: 0.0,
        }; CORNERS],
    };

    fn count(&self) -> usize {
        // NaN and what is below 0 become 0.
        (self.len as usize).min(CORNERS)
    }

    fn at(&self, i: usize) -> Flat {
        self.corners[i.min(CORNERS - 1)].at.map(long)
    }

    /// The side from corner `i`: unit, and the tilt along it that evens out its ends.
    fn side(&self, i: usize, j: usize) -> (Flat, Real) {
        let along = side(&self.at(i), &self.at(j));
        let whole = length(&along);
        let lows = [i, j].map(|i| long(self.corners[i.min(CORNERS - 1)].low));
        let tilt = long(self.tilt);
        let level = ((lows[1] - lows[0]) / whole).max(-tilt).min(tilt);
        (along.map(|x| x / whole), level)
    }

    /// The tilts of the directions that ask for it again.
    fn asides(&self) -> ([Flat; ASKS], usize) {
        let tilt = long(self.tilt);
        let mut asides = [[0.0; 2]; ASKS];
        let count = self.count();
        let across = |i: usize, j: usize| {
            let (along, level) = self.side(i, j);
            let lean = level + LEAN * tilt;
            [
                along[1] * tilt + along[0] * lean,
                -along[0] * tilt + along[1] * lean,
            ]
        };
        match count {
            0 => return (asides, 0),
            1 => {
                for (aside, way) in asides.iter_mut().zip(CIRCLE) {
                    *aside = way.map(|x| x * tilt);
                }
            }
            2 => {
                for (i, pair) in asides.chunks_exact_mut(2).take(2).enumerate() {
                    let (along, _) = self.side(i, 1 - i);
                    if let [one, two] = pair {
                        *one = across(i, 1 - i);
                        *two = along.map(|x| x * tilt);
                    }
                }
            }
            _ if self.inscribed != 0.0 => {
                for (aside, corner) in asides.iter_mut().zip(&self.corners) {
                    *aside = corner.aside.map(long);
                }
            }
            _ => {
                for (i, aside) in asides.iter_mut().take(count).enumerate() {
                    *aside = across(i, if i + 1 < count { i + 1 } else { 0 });
                }
            }
        }
        (asides, self.asked() + usize::from(self.own()))
    }

    /// How many directions its corners are asked along.
    fn asked(&self) -> usize {
        match self.count() {
            1 => 3,
            2 => 4,
            count => count,
        }
    }

    /// Whether its own direction is asked too.
    fn own(&self) -> bool {
        self.radius > 0.0 || self.excess > 0.0625 * self.slop
    }

    /// Asks the object again; nothing where nothing is known.
    pub fn ask<S: SupportMap>(
        &self,
        object: &S,
        plane: &Plane,
        sign: Real,
    ) -> Result<Option<Asked>, Fault> {
        let (asides, len) = self.asides();
        let most = asides.iter().take(len).map(length).fold(0.0, larger);
        let sum: Real = asides.iter().take(len).map(|a| a[0] + a[1]).sum();
        // NaN ends here too.
        if !(self.tilt > 0.0 && most <= 0.5 && sum.is_finite() && len > 0) {
            return Ok(None);
        }
        let mut points = [Vec3::zeros(); ASKS];
        for (point, aside) in points.iter_mut().zip(&asides).take(len) {
            *point = plane.ask(object, sign, aside)?;
        }
        Ok(Some(Asked {
            asides,
            points,
            len,
        }))
    }

    /// The face that was asked again, and how it moved; nothing where it is another.
    pub fn recall(&self, asked: &Asked, plane: &Plane, sign: Real) -> Option<(Face, Motion)> {
        let found = asked.found(plane, sign);
        let points = asked.points.iter().take(asked.len);
        let rounding = 8.0 * EPSILON * points.map(largest).fold(0.0, larger);
        let slop = larger(long(self.slop), rounding);
        let mut next = Heights {
            corners: [(Flat::default(), 0.0, 0.0); CORNERS],
            slack: 0.25 * slop + rounding,
        };
        let count = self.count();
        let fits = match count {
            1 => self.point(asked, &found, &mut next),
            2 => self.segment(asked, &found, &mut next),
            _ => self.polygon(asked, &found, &mut next),
        };
        let motion = fits.then(|| self.motion(count, &next)).flatten()?;
        let corners = next.corners.get(..count)?;
        let mut top = corners.iter().map(|c| c.1).fold(Real::NEG_INFINITY, larger);
        let mut ring = *self;
        if self.own() {
            let own = found[self.asked().min(ASKS - 1)].1;
            ring.excess = short(larger(own - top, 0.0));
            top = own;
        } else {
            top += larger(long(self.excess), 0.0);
        }
        let mut face = Face {
            corners: Polygon::default(),
            top,
            slop,
            round: 0.0,
            rounding,
            ring,
        };
        let mut most = 0.0;
        for ((at, height, radius), known) in corners.iter().zip(&mut face.ring.corners) {
            let low = larger(top - height, 0.0);
            if !(top - height <= slop + rounding) {
                return None;
            }
            // In the order of the hull that they were.
            face.corners.push(Corner { at: *at, low });
            let aside = known.aside.map(long);
            *known = Known {
                at: at.map(short),
                low: short(low),
                aside: turned(&aside, &motion.turn).map(short),
                radius: short(*radius),
            };
            most = larger(most, *radius);
        }
        face.ring.radius = short(most);
        let least = corners.iter().map(|c| c.2).fold(most, Real::min);
        let round = if count == 2 { least } else { most };
        face.round = (2.0 * round * slop).sqrt();
        Some((face, motion))
    }

    /// Three directions around: where each found its point, roundness moved it along its own tilt.
    fn point(&self, asked: &Asked, found: &[(Flat, Real); ASKS], next: &mut Heights) -> bool {
        let tilt = long(self.tilt);
        let three = || found.iter().zip(&asked.asides).take(3);
        let third = |k: usize| three().map(|((at, _), _)| at[k]).sum::<Real>() / 3.0;
        let middle = [third(0), third(1)];
        let high = |((at, height), aside): (&(Flat, Real), &Flat)| {
            height + 0.5 * dot(aside, &side(&middle, at))
        };
        let height = three().map(high).sum::<Real>() / 3.0;
        let moved = three().map(|((at, _), _)| length(&side(&middle, at)));
        let moved = moved.fold(0.0, larger);
        next.corners[0] = (middle, height, moved / tilt);
        let known = 1.5 * long(self.radius) * tilt;
        moved <= known + next.slack && three().all(|f| (high(f) - height).abs() <= next.slack)
    }

    /// Each end by a direction across the segment and one beyond it.
    fn segment(&self, asked: &Asked, found: &[(Flat, Real); ASKS], next: &mut Heights) -> bool {
        let tilt = long(self.tilt);
        let mut fits = true;
        for i in 0..2 {
            // Asked from end i, both are points of the other.
            let (j, (along, _)) = (1 - i, self.side(i, 1 - i));
            let out = [along[1], -along[0]];
            let [(s, s_height), (l, l_height)] = [found[2 * i], found[2 * i + 1]];
            let apart = side(&l, &s);
            let across = dot(&apart, &out) / tilt;
            let lean = dot(&asked.asides[2 * i], &along);
            let beyond = -dot(&apart, &along) / (tilt - lean);
            let at = [0, 1].map(|k| l[k] - beyond * tilt * along[k]);
            let height = l_height + 0.5 * beyond * tilt * tilt;
            let other = s_height + 0.5 * (across * tilt * tilt + beyond * lean * lean);
            let known = 1.5 * long(self.radius) * tilt + next.slack;
            let (least, most) = (across.min(beyond) * tilt, across.max(beyond) * tilt);
            let round = if most > next.slack { most / tilt } else { 0.0 };
            next.corners[j] = (at, height, round);
            fits &= least >= -next.slack && most <= known && (height - other).abs() <= next.slack;
        }
        fits
    }

    /// Each corner by its own direction, of a full ring, else by that of the side before it.
    fn polygon(&self, asked: &Asked, found: &[(Flat, Real); ASKS], next: &mut Heights) -> bool {
        let count = self.count();
        let asked = found.iter().zip(&asked.asides).enumerate();
        for (i, ((at, height), aside)) in asked.take(count) {
            let j = if self.inscribed != 0.0 {
                i
            } else if i + 1 < count {
                i + 1
            } else {
                0
            };
            let radius = long(self.corners[j].radius);
            next.corners[j] = (
                [0, 1].map(|k| at[k] - radius * aside[k]),
                height + 0.5 * radius * dot(aside, aside),
                radius,
            );
        }
        true
    }

    /// How the corners moved, where they did as one body does.
    fn motion(&self, count: usize, next: &Heights) -> Option<Motion> {
        let (mut far, mut reach) = (0, 0.0);
        let spoke = |i: usize| side(&self.at(0), &self.at(i));
        for i in 1..count {
            let apart = length(&spoke(i));
            if apart > reach {
                (far, reach) = (i, apart);
            }
        }
        let root = next.corners[0].0;
        let now = |i: usize| side(&root, &next.corners[i.min(CORNERS - 1)].0);
        let slack = next.slack + KEPT * reach;
        let mut turn = [1.0, 0.0];
        // What is no longer than a round corner is wide does not tell how it turned.
        if reach > 64.0 * slack {
            let (a, b) = (spoke(far), now(far));
            turn = [dot(&a, &b), a[0] * b[1] - a[1] * b[0]];
            let whole = length(&turn);
            turn = turn.map(|x| x / whole);
        }
        let as_one = |i: usize| length(&side(&turned(&spoke(i), &turn), &now(i))) <= slack;
        (0..count).all(as_one).then_some(Motion {
            turn,
            from: self.at(0),
            to: root,
        })
    }

    /// All numbers in use.
    pub fn visit(&self, mix: &mut impl FnMut(f32)) {
        let all = [
            self.tilt,
            self.slop,
            self.excess,
            self.radius,
            self.len,
            self.inscribed,
        ];
        all.into_iter().for_each(&mut *mix);
        for known in self.corners.iter().take(self.count()) {
            known.at.into_iter().for_each(&mut *mix);
            known.aside.into_iter().for_each(&mut *mix);
            [known.low, known.radius].into_iter().for_each(&mut *mix);
        }
    }

    /// The same ring seen from the other side of the plane.
    pub fn mirror(&mut self) {
        let count = self.count();
        for known in &mut self.corners {
            known.at[1] = -known.at[1];
            known.aside[1] = -known.aside[1];
        }
        if let Some(corners) = self.corners.get_mut(..count) {
            corners.reverse();
        }
    }
}

/// Corners as they are found: where, how high, how round.
struct Heights {
    corners: [(Flat, Real, Real); CORNERS],
    /// How far two ways of finding one may be apart.
    slack: Real,
}
