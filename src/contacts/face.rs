// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The face of one object: its corners, by support points in directions that are tilted a little.
//!
//! # Derivation
//!
//! *Face.* The face of an object that looks along n is what lies within the slop below its
//! support plane. A support point in the direction n + a, a across n and small, is a corner
//! of it: it maximises a·r − low over the object, r the place along the plane and low the
//! depth below it. With |a| = 2 slop / size a corner half the slop low wins over all that
//! it is a quarter of the size farther aside than. One found that is more than the slop low
//! is not of the face, and half the tilt may show another. The size is how far apart three
//! directions [`WIDE`] aside find points; these reach as far in their directions as the
//! face, and where they are of it they are its first corners.
//!
//! *All corners.* Between two corners p and q the direction across their side decides: in it
//! both win alike and what lies beyond wins over both. (A lean along the side evens out p and
//! q of different height, so that this is true of tilted faces too.) So a face of k corners
//! is known after 3 + k + (k − 3) directions, and a curved one by an inscribed polygon, its
//! gaps halved in a fixed order, so that it moves as the object does and not as rounding
//! does. Each side is asked with a [`BIAS`] to its second corner, which is so found twice.
//!
//! *Roundness.* A corner found again from another direction is sharp. What is found once
//! alone is asked with half the tilt: where the surface is round the point has moved half
//! as far, p = c + R a, and c = 2 p(a/2) − p(a) is the place at no tilt. Points of a smooth
//! piece win over each other by equal amounts in their two directions (trapezoidal rule);
//! corners do not, and stay. So does a point that moves by more than sqrt(slop · size / 2):
//! along a circle as large as the object it would be taken off the surface by the slop.
//!
//! *Again.* Of a face that is known from the last query nothing is believed. It is asked once a
//! side, across it, with a [`LEAN`] to its second corner, which is to be found: so each corner is
//! found, and nothing sticks out of any side. A point is asked three times around, and is the mean:
//! roundness of any kind cancels. Each end of a line is asked beyond it too, which tells how round it is
//! along. A curved face, whose polygon is inscribed, is asked along the
//! directions that found it. Unless the corners are as far from each other as they were, and all of them on
//! the face, the search begins from nothing.

use crate::contacts::list::List;
use crate::contacts::memory::{Known, Memory, Motion, Ring, long, short};
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{
    Corner, Flat, Polygon, across, between, cross, dot, length, onto, side,
};
use crate::math::{EPSILON, larger, largest, lesser};
use crate::minkowski::support::{Fault, SupportMap};
use core::mem::swap;

/// Support points of one object, at most: what its corners cost when there are eight, each
/// found twice, and the size.
const SUPPORTS: u32 = 24;
/// Corners of a face, at most. One more than eight: a face of eight is known to be one. A
/// curved face has as many, whether its points had to be asked again or not.
pub const CORNERS: usize = 9;
/// Tilt of the first directions: 14°. Less, and round objects seem to be smaller than the
/// circle that their points move on; more, and the flanks beside a face are taken for it.
const WIDE: f64 = 0.25;
/// Points nearer than this, in units of tilt times size, may be one round corner: a ball's
/// are 4 apart.
const NEAR: f64 = 8.0;
/// How far a direction across a side leans to its second corner, in tilts: what sticks out
/// by less than this angle may be overlooked, 0.01 % of the square of the side.
const BIAS: f64 = 1.0 / 4096.0;
/// The same of a face that is asked again: 3.6°. By as much it may have turned about the normal
/// since. Insensitive: 1/64 to 1/8 tried.
const LEAN: f64 = 1.0 / 16.0;
/// Cosine and sine of the first directions.
#[allow(clippy::excessive_precision)] // In single precision.
const CIRCLE: [Flat; 3] = [
    [1.0, 0.0],
    [-0.5, 0.866_025_403_784_438_6],
    [-0.5, -0.866_025_403_784_438_6],
];

/// A support point, and how it was found.
#[derive(Clone, Copy, Default)]
struct Sample {
    /// The point.
    found: Corner,
    /// Where it is without a tilt, once it is settled.
    corner: Corner,
    /// The tilt of its direction.
    aside: Flat,
    /// How much farther it is found for each tilt.
    radius: f64,
    /// Whether it is known where it is without a tilt.
    settled: bool,
    /// Whether nothing is beyond the side to the next sample, as far as can be asked.
    closed: bool,
}

impl Sample {
    /// By how much its point wins over the other's in its own direction.
    fn wins(&self, other: &Self) -> f64 {
        dot(&self.aside, &side(&other.found.at, &self.found.at)) + other.found.low - self.found.low
    }
}

/// The face of one object.
pub struct Face {
    pub corners: Polygon<CORNERS>,
    /// How high its support plane is, along the way it looks.
    pub top: f64,
    /// The slop in force.
    pub slop: f64,
    /// What rounding can do to a coordinate.
    pub rounding: f64,
    /// What is kept of it.
    pub ring: Ring,
    /// How it moved, where it was known.
    pub motion: Option<Motion>,
}

/// The least slop of a normal, as a share of the depth. A normal whose depth is within 0.1 % of the minimum
/// leaves the corners of a face as unequal as that, times the extent of the face over the distance of the
/// deepest point from the middle of what is shared. Measured on 17,351 pairs of boxes and of a box and an
/// ellipsoid, 1 cm deep, without a slop of the caller's: a share of 0 takes a corner or an end of an edge for
/// the face in 212, 0.001 in 21, 0.002 in 12, 0.01 in 1.
const MIN_SLOP_REL: f64 = 0.01;
/// The same in units of what rounding can do to a coordinate: the tilt that finds corners is to be well above
/// what a callback rounds its direction by.
const MIN_SLOP_ROUNDINGS: f64 = 4.0;

/// Finds both faces, by what is kept of them, else from nothing, and how they moved; and the slop that they
/// have, which is the caller's or the least one of the depth. The first point of the first object becomes
/// the origin of the plane.
///
/// # Errors
/// [`Fault::NonFinite`].
pub fn faces<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    plane: &mut Plane,
    slop: f64,
    known: Option<&Memory>,
) -> Result<([Face; 2], f64), Fault> {
    let [ring1, ring2] = [0, 1].map(|i| known.map(|known| &known.rings()[i]));
    let mut one = Search::new(obj1, plane, 1.0, false);
    let found1 = one.again_or_plane(ring1)?;
    *plane = one.plane;
    let mut two = Search::new(obj2, plane, -1.0, true);
    let found2 = two.again_or_plane(ring2)?;
    let slop = larger(slop, MIN_SLOP_REL * (one.top + two.top));
    let has_slop = known.is_some_and(|known| known.has_slop(slop));
    let faces = [
        one.face_of(found1, has_slop, slop)?,
        two.face_of(found2, has_slop, slop)?,
    ];
    Ok((faces, slop))
}

impl Face {
    /// How far below its support plane it is at a place.
    pub fn low(&self, at: &Flat) -> f64 {
        self.corners.low(at, self.rounding)
    }

    /// How far aside of a round corner the surface is as much as the slop low; of a segment of the
    /// less round end.
    pub fn round(&self) -> f64 {
        let radii = || self.ring.corners().iter().map(|c| long(c.radius));
        let radius = match self.ring.corners() {
            [_, _] => radii().fold(f64::INFINITY, lesser),
            _ => radii().fold(0.0, larger),
        };
        (2.0 * radius * self.slop).sqrt()
    }

    /// How far aside of its corners it is no more than half the slop away; as far as it is round
    /// for a line that is long for that: what looks round along a curved rim is not so across.
    pub fn reach(&self) -> f64 {
        let round = self.round();
        match &*self.corners {
            [a, b] if length(&side(&a.at, &b.at)) > 2.0 * round => larger(round, 0.5 * self.slop),
            _ => 0.5 * self.slop,
        }
    }
}

/// The search for the corners of one face.
struct Search<'a, S> {
    object: &'a S,
    plane: Plane,
    /// Whether the plane has its origin, else the first point is it.
    has_origin: bool,
    sign: f64,
    /// How high the support plane is, and where it is met.
    top: f64,
    first: Sample,
    slop: f64,
    size: f64,
    /// Tilt that finds corners.
    tilt: f64,
    rounding: f64,
    asked: u32,
    ring: List<Sample, CORNERS>,
    /// The largest radius of a corner.
    radius: f64,
}

impl<'a, S: SupportMap> Search<'a, S> {
    fn new(object: &'a S, plane: &Plane, sign: f64, has_origin: bool) -> Self {
        Search {
            object,
            plane: *plane,
            has_origin,
            sign,
            top: 0.0,
            first: Sample::default(),
            slop: 0.0,
            size: 0.0,
            tilt: 0.0,
            rounding: 0.0,
            asked: 0,
            ring: List::default(),
            radius: 0.0,
        }
    }

    fn ask(&mut self, aside: Flat) -> Result<Sample, Fault> {
        let p = self
            .object
            .support(&self.plane.direction(self.sign, &aside));
        if !self.has_origin {
            (self.plane.origin, self.has_origin) = (p, true);
        }
        self.asked += 1;
        self.rounding = larger(self.rounding, 8.0 * EPSILON * largest(&p));
        let mut found = self.plane.corner(self.sign, &p)?;
        found.low += self.top;
        Ok(Sample {
            found,
            corner: found,
            aside,
            ..Sample::default()
        })
    }

    fn same(&self, a: &Sample, b: &Sample) -> bool {
        length(&side(&a.found.at, &b.found.at)) <= self.rounding
            && (a.found.low - b.found.low).abs() <= self.rounding
    }

    /// A corner of the face: with the tilt, else with half of it.
    fn corner(&mut self, aside: Flat) -> Result<Option<Sample>, Fault> {
        for share in [1.0, 0.5] {
            if self.asked >= SUPPORTS {
                break;
            }
            let p = self.ask(aside.map(|x| share * x))?;
            if p.found.low <= self.slop {
                return Ok(Some(p));
            }
        }
        Ok(None)
    }

    /// Finds the face that is known, or the support plane where it is another.
    fn again_or_plane(&mut self, ring: Option<&Ring>) -> Result<Option<Face>, Fault> {
        if let Some(ring) = ring {
            let found = self.again(ring)?;
            if found.is_some() {
                return Ok(found);
            }
        }
        self.find_plane()?;
        Ok(None)
    }

    /// Returns the face that is found, unless its slop was another, else finds it from nothing.
    fn face_of(mut self, found: Option<Face>, has_slop: bool, slop: f64) -> Result<Face, Fault> {
        if let Some(face) = found {
            if has_slop {
                return Ok(face);
            }
            self.find_plane()?;
        }
        self.anew(slop)
    }

    /// Begins the search: queries the support plane.
    fn find_plane(&mut self) -> Result<(), Fault> {
        (self.top, self.asked) = (0.0, 0);
        let mut first = self.ask([0.0; 2])?;
        self.top = -first.found.low;
        first.found.low = 0.0;
        first.corner.low = 0.0;
        first.settled = true;
        self.first = first;
        Ok(())
    }

    /// The size, and the first corners.
    fn start(&mut self, slop: f64) -> Result<(), Fault> {
        let top = self.first;
        let mut wide = [top; 3];
        for i in 0..3 {
            let new = self.ask(CIRCLE[i].map(|x| WIDE * x))?;
            for known in &wide {
                let apart = length(&side(&known.found.at, &new.found.at));
                self.size = larger(self.size, apart);
            }
            wide[i] = new;
        }
        // No coarser than the face, no finer than what rounding does to it.
        self.slop = slop.min(self.size).max(MIN_SLOP_ROUNDINGS * self.rounding);
        if self.size > self.rounding {
            self.tilt = (2.0 * self.slop / self.size).min(WIDE);
            for (sample, way) in wide.into_iter().zip(CIRCLE) {
                let found = if sample.found.low <= self.slop {
                    Some(sample)
                } else {
                    self.corner(way.map(|x| self.tilt * x))?
                };
                match found {
                    Some(new) if !self.known(&new) => self.ring.push(new),
                    _ => {}
                }
            }
        }
        if self.ring.is_empty() {
            self.ring.push(top);
        }
        self.known(&top);
        if let [a, b, c] = &mut *self.ring {
            if cross(
                &side(&a.found.at, &b.found.at),
                &side(&a.found.at, &c.found.at),
            ) < 0.0
            {
                swap(b, c);
            }
        }
        Ok(())
    }

    /// Is the point one of those known? From another direction that tells it to be sharp.
    fn known(&mut self, new: &Sample) -> bool {
        let known = (0..self.ring.len()).find(|i| self.same(self.ring.at(*i), new));
        if let Some(i) = known {
            let (least, known) = (0.25 * self.tilt, self.ring.at_mut(i));
            known.settled |= length(&side(&known.aside, &new.aside)) >= least;
        }
        known.is_some()
    }

    /// Finds the corners between those known, in passes around the face.
    fn refine(&mut self) -> Result<(), Fault> {
        loop {
            let before = self.ring.len();
            let mut i = 0;
            while i < self.ring.len() {
                if !self.ring.at(i).closed {
                    if let Some(new) = self.beyond(i)? {
                        self.ring.insert(i + 1, new);
                        i += 1;
                    } else {
                        self.ring.at_mut(i).closed = true;
                    }
                }
                i += 1;
            }
            if self.ring.len() == before {
                return Ok(());
            }
        }
    }

    /// The corner beyond the side from sample `i` to the next, if there is one.
    fn beyond(&mut self, i: usize) -> Result<Option<Sample>, Fault> {
        let ends = |s: &Self| [*s.ring.at(i), *s.ring.at(i + 1)];
        let apart = |s: &Self| {
            let [a, b] = ends(s);
            length(&side(&a.corner.at, &b.corner.at))
        };
        if apart(self) <= NEAR * self.tilt * self.size {
            self.settle(i)?;
            self.settle(i + 1)?;
            if apart(self) <= self.slop {
                return Ok(None);
            }
        }
        // A new corner costs up to two, and one to settle it.
        let limit = SUPPORTS.saturating_sub(self.owed() + 1).min(self.limit());
        if self.ring.len() == CORNERS || self.asked + 2 > limit {
            return Ok(None);
        }
        let [a, b] = ends(self).map(|sample| sample.found);
        let whole = length(&side(&a.at, &b.at));
        let bias = 2.0 * self.rounding / whole;
        let bias = bias.max(BIAS * self.tilt).min(self.tilt / 64.0);
        let Some(new) = self.corner(across(&a, &b, self.tilt, bias))? else {
            return Ok(None);
        };
        if self.known(&new) {
            return Ok(None);
        }
        let beyond = cross(&side(&a.at, &new.found.at), &side(&a.at, &b.at));
        Ok((beyond > self.flat() * whole).then_some(new))
    }

    /// What sticks out by no more is no corner: rounding, and what is left of roundness.
    fn flat(&self) -> f64 {
        self.rounding + self.tilt * self.slop
    }

    /// Support points that the face is worth: few corners, all of them sharp, are known
    /// before.
    fn limit(&self) -> u32 {
        if self.ring.len() > 4 || self.radius > 0.0 {
            SUPPORTS
        } else {
            SUPPORTS / 2
        }
    }

    /// Support points that it takes to settle the samples.
    fn owed(&self) -> u32 {
        let open = self.ring.iter().filter(|s| !s.settled);
        open.map(|s| 1 + u32::from(self.is_wide(s))).sum()
    }

    fn is_wide(&self, sample: &Sample) -> bool {
        length(&sample.aside) > 2.0 * self.tilt
    }

    /// Takes off what moves in proportion to the tilt.
    fn settle(&mut self, i: usize) -> Result<(), Fault> {
        let mut full = *self.ring.at(i);
        let wide = self.is_wide(&full);
        if full.settled || self.asked + 1 + u32::from(wide) > self.limit() {
            return Ok(());
        }
        self.ring.at_mut(i).settled = true;
        if wide {
            let share = self.tilt / length(&full.aside);
            let near = self.ask(full.aside.map(|x| share * x))?;
            if self.same(&full, &near) || near.found.low > self.slop || self.known(&near) {
                return Ok(());
            }
            full = near;
        }
        self.ring.at_mut(i).corner = full.found;
        let mut aside = full.aside.map(|x| 0.5 * x);
        for _ in 0..2 {
            if self.asked >= self.limit() {
                break;
            }
            let near = self.ask(aside)?;
            let way = side(&near.found.at, &full.found.at);
            let moved = length(&way);
            if self.same(&full, &near) {
                break;
            }
            let radius = moved / length(&side(&aside, &full.aside));
            let (there, back) = (full.wins(&near), near.wins(&full));
            let smooth = (there - back).abs() <= 0.5 * (there + back) + self.rounding;
            if moved * moved <= 0.5 * self.slop * self.size && smooth {
                self.radius = larger(self.radius, radius);
                let corner = self.inside(
                    Corner {
                        at: between(&full.found.at, &near.found.at, 2.0),
                        low: larger((4.0 * near.found.low - full.found.low) / 3.0, 0.0),
                    },
                    &near.found,
                );
                *self.ring.at_mut(i) = Sample {
                    aside: full.aside,
                    radius,
                    corner,
                    ..*self.ring.at(i)
                };
                break;
            }
            // Another corner; of two round ends of a line the half tilt finds the higher one.
            // With a lean that makes them level, and more, it finds this one.
            let lean = (0.125 * self.tilt + back / moved).min(self.tilt);
            aside = [0, 1].map(|k| aside[k] + way[k] / moved * lean);
        }
        Ok(())
    }

    /// The corner, if it is within the slop of the way from a point of the object to the highest;
    /// else that point.
    fn inside(&self, corner: Corner, near: &Corner) -> Corner {
        let at = onto(&corner.at, &near.at, &self.first.found.at);
        if length(&side(&at, &corner.at)) <= self.slop {
            return corner;
        }
        *near
    }

    /// The face, of which nothing is known.
    fn anew(mut self, slop: f64) -> Result<Face, Fault> {
        self.start(slop)?;
        if self.ring.len() > 1 {
            self.refine()?;
        }
        for i in 0..self.ring.len() {
            self.settle(i)?;
        }
        let samples = &self.ring;
        let mut corners = Polygon::default();
        samples.iter().for_each(|s| corners.push(s.corner));
        // One that was found twice is one, to the rounding of both.
        let corners = corners.tidy(larger(self.slop, 4.0 * self.rounding), self.flat());
        let least = corners.iter().map(|c| c.low);
        let least = least.fold(f64::INFINITY, lesser);
        let mut ring = Ring {
            tilt: short(self.tilt),
            slop: short(self.slop),
            len: corners.len() as f32,
            // Of a full ring nobody knows what is between its corners.
            inscribed: f32::from(u8::from(self.ring.len() == CORNERS)),
            own: f32::from(u8::from(self.radius > 0.0 || least > 0.0625 * self.slop)),
            ..Ring::default()
        };
        for (known, corner) in ring.corners.iter_mut().zip(&*corners) {
            let apart = |s: &Sample| length(&side(&s.corner.at, &corner.at));
            let here = || samples.iter().filter(|s| apart(s) <= self.slop);
            let asides = here().filter(|s| s.corner == *corner).map(|s| s.aside);
            let radius = match &*corners {
                [_] => self.radius,
                _ => here().map(|s| s.radius).fold(0.0, larger),
            };
            *known = Known {
                at: corner.at.map(short),
                low: short(corner.low),
                aside: asides.fold([0.0; 2], |_, aside| aside).map(short),
                radius: short(radius),
            };
        }
        Ok(self.face(corners, ring))
    }

    fn face(&self, corners: Polygon<CORNERS>, ring: Ring) -> Face {
        Face {
            corners,
            top: self.top,
            slop: self.slop,
            rounding: self.rounding,
            ring,
            motion: None,
        }
    }

    /// The face that is known, and how it moved; nothing where it is another.
    fn again(&mut self, ring: &Ring) -> Result<Option<Face>, Fault> {
        let count = ring.corners().len();
        let tilt = long(ring.tilt);
        if !(tilt > 0.0) || count == 0 {
            return Ok(None);
        }
        // The ends of a line are each the other's second corner.
        let inscribed = ring.inscribed != 0.0 && count > 2;
        let mut next = [Corner::default(); CORNERS];
        for i in 0..larger(count, if count == 1 { 3 } else { 0 }) {
            // Across a side its second corner is found.
            let j = if count == 1 || inscribed {
                i
            } else {
                (i + 1) % count
            };
            let (known, other) = (ring.corner(i % count), ring.corner(j % count));
            let mut aside = if count == 1 {
                CIRCLE[i % 3].map(|x| x * tilt)
            } else if inscribed {
                known.aside.map(long)
            } else {
                across(&known.corner(), &other.corner(), tilt, LEAN * tilt)
            };
            // NaN ends here too.
            if !(length(&aside) <= 0.5) {
                return Ok(None);
            }
            let mut found = self.ask(aside)?.found;
            let mut radius = long(other.radius);
            if count == 2 {
                // The end of a line may be as round along it as across, or sharp.
                let along = side(&known.corner().at, &other.corner().at);
                let whole = length(&along);
                let beyond = along.map(|x| x * tilt / whole);
                let end = self.ask(beyond)?.found;
                let (more, moved) = (side(&aside, &beyond), side(&found.at, &end.at));
                let slack = 0.25 * long(ring.slop) + self.rounding;
                let is_one = length(&moved) <= 2.0 * radius * tilt + slack;
                if !(is_one && (found.low - end.low).abs() <= slack) {
                    return Ok(None);
                }
                radius = dot(&moved, &beyond) / dot(&more, &beyond);
                (found, aside) = (end, beyond);
            }
            next[j % CORNERS] = Corner {
                at: [0, 1].map(|k| found.at[k] - radius * aside[k]),
                low: found.low - 0.5 * radius * dot(&aside, &aside),
            };
        }
        if ring.own != 0.0 {
            self.top = -self.ask([0.0; 2])?.found.low;
        } else {
            let lows = next.iter().take(count).map(|c| c.low);
            self.top = -lows.fold(f64::INFINITY, lesser);
        }
        self.slop = larger(long(ring.slop), self.rounding);
        let slack = 0.25 * self.slop + self.rounding;
        if let (1, [a, b, c, ..]) = (count, next) {
            let across = slack + long(ring.corner(0).radius) * tilt;
            match mean(&[a, b, c], across, slack) {
                Some(mean) => next[0] = mean,
                None => return Ok(None),
            }
        }
        let next = next.get(..count).unwrap_or(&[]);
        let Some(motion) = ring.motion(next, slack) else {
            return Ok(None);
        };
        let mut ring = *ring;
        let mut corners = Polygon::default();
        // In the order of the hull that they were.
        for (corner, known) in next.iter().zip(&mut ring.corners) {
            let low = corner.low + self.top;
            if !(low <= self.slop + self.rounding) {
                return Ok(None);
            }
            let low = larger(low, 0.0);
            corners.push(Corner { low, ..*corner });
            known.at = corner.at.map(short);
            known.low = short(low);
            known.aside = motion.turned(&known.aside.map(long)).map(short);
        }
        Ok(Some(Face {
            motion: Some(motion),
            ..self.face(corners, ring)
        }))
    }
}

/// The mean of three corners that are one but for this across and along.
fn mean(three: &[Corner; 3], across: f64, along: f64) -> Option<Corner> {
    let third = |of: &dyn Fn(&Corner) -> f64| three.iter().map(of).sum::<f64>() / 3.0;
    let mean = Corner {
        at: [third(&|c| c.at[0]), third(&|c| c.at[1])],
        low: third(&|c| c.low),
    };
    let is_one =
        |c: &Corner| length(&side(&c.at, &mean.at)) <= across && (c.low - mean.low).abs() <= along;
    three.iter().all(is_one).then_some(mean)
}
