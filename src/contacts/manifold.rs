// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where two objects touch: the region in which their faces lie over each other, as a few
//! points.
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
//! *Region.* Both faces are convex polygons in the plane across n, and so is what they
//! share. Each of its corners has a point on either face, whose heights along n differ by
//! the depth there. Segments that cross share a point. Nearly parallel ones share a strip
//! as wide as the slop makes of the roundness: sqrt(2 R slop) aside of the middle a surface
//! of radius R is as much as the slop low. Faces that share nothing have a nearest point
//! each; where these are no farther apart than the slop the middle of them is the contact, else the two are, though they do not lie over each other.
//!
//! *Reduction.* The deepest point stays; with it, those that span the largest area.

use crate::contacts::again::{Known, Motion, Ring, short};
use crate::contacts::memory::{Memory, Names};
use crate::contacts::polygon::{
    Corner, Flat, Polygon, between, cross, dot, length, nearest_to, side,
};
use crate::known::support::{Fault, SupportMap};
use crate::math::{EPSILON, Real, Vec3, axes, larger, largest};
use core::mem::swap;

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// On obj1, metres.
    pub point1: Vec3,
    /// On obj2: `point1 - depth * normal`, unless the faces share nothing.
    pub point2: Vec3,
    /// How deep the objects overlap there, metres; negative where they are apart.
    pub depth: Real,
    /// Its name, as long as it moves with either body; 0 without a memory.
    pub name: u32,
}

/// Support points of one object, at most: what its corners cost when there are eight, each
/// found twice, and the size.
const SUPPORTS: u32 = 24;
/// Corners of a face, at most. One more than eight: a face of eight is known to be one. A
/// curved face has as many, whether its points had to be asked again or not.
pub const CORNERS: usize = 9;
/// Corners of what two faces share: each side of the one adds at most one to the other's.
pub const ROOM: usize = 2 * CORNERS;
/// Tilt of the first directions: 14°. Less, and round objects seem to be smaller than the
/// circle that their points move on; more, and the flanks beside a face are taken for it.
const WIDE: Real = 0.25;
/// Points nearer than this, in units of tilt times size, may be one round corner: a ball's
/// are 4 apart.
const NEAR: Real = 8.0;
/// How far a direction across a side leans to its second corner, in tilts: what sticks out
/// by less than this angle may be overlooked, 0.01 % of the square of the side.
const BIAS: Real = 1.0 / 4096.0;
/// Sine of the angle up to which segments may share a strip: 10°.
const PARALLEL: Real = 0.17;
/// Cosine and sine of the first directions.
#[allow(clippy::excessive_precision)] // In single precision.
pub const CIRCLE: [Flat; 3] = [
    [1.0, 0.0],
    [-0.5, 0.866_025_403_784_438_6],
    [-0.5, -0.866_025_403_784_438_6],
];

/// The plane across the normal, and where its origin is.
#[derive(Clone, Copy)]
pub struct Plane {
    pub n: Vec3,
    pub e1: Vec3,
    e2: Vec3,
    origin: Vec3,
}

impl Plane {
    /// With axes that turn as little as `n` does.
    fn of(n: &Vec3) -> Self {
        let [e1, _] = axes(n);
        Self::with(n, &e1)
    }

    /// With this first axis.
    pub fn with(n: &Vec3, e1: &Vec3) -> Self {
        Self {
            n: *n,
            e1: *e1,
            e2: n.cross(e1),
            origin: Vec3::zeros(),
        }
    }

    pub fn flat(&self, p: &Vec3) -> Flat {
        let p = p - self.origin;
        [self.e1.dot(&p), self.e2.dot(&p)]
    }

    /// The support point of a face that looks along the normal (`sign` 1) or against it, in a
    /// direction that is tilted `aside`.
    pub fn ask<S: SupportMap>(&self, object: &S, sign: Real, aside: &Flat) -> Result<Vec3, Fault> {
        let d = self.n * sign + self.e1 * aside[0] + self.e2 * aside[1];
        let p = object.support(&(d / d.norm()));
        // NaN ends here too; beyond that squares of squares overflow.
        let q = p.norm_squared();
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        Ok(p)
    }

    pub fn height(&self, p: &Vec3) -> Real {
        self.n.dot(&(p - self.origin))
    }

    fn point(&self, [x, y]: &Flat, height: Real) -> Vec3 {
        self.origin + self.e1 * *x + self.e2 * *y + self.n * height
    }
}

/// A support point, and how it was found.
#[derive(Clone, Copy, Default)]
struct Sample {
    /// The point.
    found: Corner,
    /// Where it is without a tilt, once it is settled.
    corner: Corner,
    /// The tilt of its direction.
    aside: Flat,
    /// The tilt to find it by again, and how much farther it is found for each.
    again: Flat,
    radius: Real,
    /// Whether it is known where it is without a tilt.
    settled: bool,
    /// Whether nothing is beyond the side to the next sample, as far as can be asked.
    closed: bool,
}

impl Sample {
    /// By how much its point wins over the other's in its own direction.
    fn wins(&self, other: &Self) -> Real {
        dot(&self.aside, &side(&other.found.at, &self.found.at)) + other.found.low - self.found.low
    }
}

/// The face of one object.
pub struct Face {
    pub corners: Polygon<CORNERS>,
    /// Height of the support plane along n.
    pub top: Real,
    /// The slop in force.
    pub slop: Real,
    /// How far aside of a round corner the surface is as much as the slop low.
    pub round: Real,
    /// What rounding can do to a coordinate.
    pub rounding: Real,
    /// What is kept of it.
    pub ring: Ring,
}

impl Face {
    /// How far below its support plane it is at a place.
    fn low(&self, at: &Flat) -> Real {
        self.corners.low(at, self.rounding)
    }

    /// How far aside of its corners it is no more than half the slop away; as far as it is round
    /// for a line that is long for that: what looks round along a curved rim is not so across.
    fn reach(&self) -> Real {
        match self.corners.corners() {
            [a, b] if length(&side(&a.at, &b.at)) > 2.0 * self.round => {
                larger(self.round, 0.5 * self.slop)
            }
            _ => 0.5 * self.slop,
        }
    }
}

/// The points of a contact.
#[derive(Clone, Copy)]
pub struct Manifold {
    contacts: [Contact; ROOM],
    len: usize,
}

impl Manifold {
    /// The points, the deepest first.
    pub fn contacts(&self) -> &[Contact] {
        self.contacts.get(..self.len).unwrap_or(&[])
    }
}

/// The search for the corners of one face.
struct Search<'a, S> {
    object: &'a S,
    plane: &'a Plane,
    /// 1 where the face looks along n, -1 against it.
    sign: Real,
    /// Height of the support plane, along the way the face looks, and where it is met.
    top: Real,
    first: Flat,
    slop: Real,
    size: Real,
    /// Tilt that finds corners.
    tilt: Real,
    rounding: Real,
    asked: u32,
    ring: [Sample; CORNERS],
    len: usize,
    /// The largest radius of a corner.
    radius: Real,
}

impl<S: SupportMap> Search<'_, S> {
    fn point(&mut self, aside: Flat) -> Result<Vec3, Fault> {
        let p = self.plane.ask(self.object, self.sign, &aside)?;
        self.asked += 1;
        self.rounding = larger(self.rounding, 8.0 * EPSILON * largest(&p));
        Ok(p)
    }

    fn ask(&mut self, aside: Flat) -> Result<Sample, Fault> {
        let p = self.point(aside)?;
        let found = Corner {
            at: self.plane.flat(&p),
            low: self.top - self.sign * self.plane.height(&p),
        };
        Ok(Sample {
            found,
            corner: found,
            aside,
            again: aside,
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

    /// The support plane, the size, and the first corners. `first` is the support point
    /// along the face's own direction.
    fn start(&mut self, first: Vec3, slop: Real) -> Result<(), Fault> {
        self.rounding = 8.0 * EPSILON * largest(&first);
        self.top = self.sign * self.plane.height(&first);
        let at = self.plane.flat(&first);
        self.first = at;
        let mut wide = [Sample::default(); 3];
        for (sample, way) in wide.iter_mut().zip(CIRCLE) {
            *sample = self.ask(way.map(|x| WIDE * x))?;
            self.size = larger(self.size, length(&side(&at, &sample.found.at)));
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let apart = side(&wide[a].found.at, &wide[b].found.at);
            self.size = larger(self.size, length(&apart));
        }
        // No coarser than the face, no finer than what rounding does to it.
        self.slop = slop.min(self.size).max(self.rounding);
        let mut top = Sample {
            settled: true,
            ..Sample::default()
        };
        (top.found.at, top.corner.at) = (at, at);
        if self.size > self.rounding {
            self.tilt = (2.0 * self.slop / self.size).min(WIDE);
            for (sample, way) in wide.into_iter().zip(CIRCLE) {
                let found = if sample.found.low <= self.slop {
                    Some(sample)
                } else {
                    self.corner(way.map(|x| self.tilt * x))?
                };
                match found {
                    Some(new) if !self.known(&new) => self.put(self.len, new),
                    _ => {}
                }
            }
        }
        if self.len == 0 {
            (self.ring[0], self.len) = (top, 1);
        }
        self.known(&top);
        let [a, b, c] = [0, 1, 2].map(|i| self.ring[i].found.at);
        if self.len == 3 && cross(&side(&a, &b), &side(&a, &c)) < 0.0 {
            self.ring.swap(1, 2);
        }
        Ok(())
    }

    /// Puts a sample into the ring; those from there on move up.
    fn put(&mut self, i: usize, mut sample: Sample) {
        let places = self.ring.iter_mut().take(self.len + 1);
        places.skip(i).for_each(|p| swap(p, &mut sample));
        self.len = (self.len + 1).min(CORNERS);
    }

    /// Is the point one of those known? From another direction that tells it to be sharp.
    fn known(&mut self, new: &Sample) -> bool {
        for i in 0..self.len.min(CORNERS) {
            if self.same(&self.ring[i], new) {
                let turned = length(&side(&self.ring[i].aside, &new.aside));
                self.ring[i].settled |= turned >= 0.25 * self.tilt;
                return true;
            }
        }
        false
    }

    /// Finds the corners between those known, in passes around the face.
    fn refine(&mut self) -> Result<(), Fault> {
        loop {
            let before = self.len;
            let mut i = 0;
            while i < self.len {
                if self.ring.get(i).is_some_and(|s| !s.closed) {
                    let next = if i + 1 < self.len { i + 1 } else { 0 };
                    if let Some(new) = self.beyond(i, next)? {
                        self.put(i + 1, new);
                        i += 1;
                    } else if let Some(sample) = self.ring.get_mut(i) {
                        sample.closed = true;
                    }
                }
                i += 1;
            }
            if self.len == before {
                return Ok(());
            }
        }
    }

    /// The corner beyond the side from sample `i` to sample `j`, if there is one.
    fn beyond(&mut self, i: usize, j: usize) -> Result<Option<Sample>, Fault> {
        let (i, j) = (place(i), place(j));
        let apart = |s: &Self| length(&side(&s.ring[i].corner.at, &s.ring[j].corner.at));
        if apart(self) <= NEAR * self.tilt * self.size {
            self.settle(i)?;
            self.settle(j)?;
            if apart(self) <= self.slop {
                return Ok(None);
            }
        }
        // A new corner costs up to two, and one to settle it.
        let limit = SUPPORTS.saturating_sub(self.owed() + 1).min(self.limit());
        if self.len == CORNERS || self.asked + 2 > limit {
            return Ok(None);
        }
        let (a, b) = (self.ring[i].found, self.ring[j].found);
        let along = side(&a.at, &b.at);
        let whole = length(&along);
        let along = along.map(|x| x / whole);
        let out = [along[1], -along[0]];
        let level = ((b.low - a.low) / whole).max(-self.tilt).min(self.tilt);
        let bias = 2.0 * self.rounding / whole;
        let lean = level + bias.max(BIAS * self.tilt).min(self.tilt / 64.0);
        let aside = [0, 1].map(|k| out[k] * self.tilt + along[k] * lean);
        let Some(new) = self.corner(aside)? else {
            return Ok(None);
        };
        if self.known(&new) {
            return Ok(None);
        }
        let beyond = dot(&out, &side(&a.at, &new.found.at));
        Ok((beyond > self.flat()).then_some(new))
    }

    /// What sticks out by no more is no corner: rounding, and what is left of roundness.
    fn flat(&self) -> Real {
        self.rounding + self.tilt * self.slop
    }

    /// Support points that the face is worth: few corners, all of them sharp, are known
    /// before.
    fn limit(&self) -> u32 {
        if self.len > 4 || self.radius > 0.0 {
            SUPPORTS
        } else {
            SUPPORTS / 2
        }
    }

    /// Support points that it takes to settle the samples.
    fn owed(&self) -> u32 {
        let open = self.ring.iter().take(self.len).filter(|s| !s.settled);
        open.map(|s| 1 + u32::from(self.is_wide(s))).sum()
    }

    fn is_wide(&self, sample: &Sample) -> bool {
        length(&sample.aside) > 2.0 * self.tilt
    }

    /// Takes off what moves in proportion to the tilt.
    fn settle(&mut self, i: usize) -> Result<(), Fault> {
        let i = place(i);
        let mut full = self.ring[i];
        if full.settled {
            return Ok(());
        }
        let wide = self.is_wide(&full);
        if self.asked + 1 + u32::from(wide) > self.limit() {
            return Ok(());
        }
        self.ring[i].settled = true;
        if wide {
            let share = self.tilt / length(&full.aside);
            let near = self.ask(full.aside.map(|x| share * x))?;
            if self.same(&full, &near) || near.found.low > self.slop || self.known(&near) {
                return Ok(());
            }
            full = near;
        }
        self.ring[i].corner = full.found;
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
                (self.ring[i].again, self.ring[i].radius) = (full.aside, radius);
                self.ring[i].corner = self.inside(
                    Corner {
                        at: between(&full.found.at, &near.found.at, 2.0),
                        low: larger((4.0 * near.found.low - full.found.low) / 3.0, 0.0),
                    },
                    &near.found,
                );
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
        let t = nearest_to(&corner.at, &near.at, &self.first);
        let at = between(&near.at, &self.first, t);
        if length(&side(&at, &corner.at)) <= self.slop {
            return corner;
        }
        *near
    }

    fn face(mut self, first: Vec3, slop: Real) -> Result<Face, Fault> {
        self.start(first, slop)?;
        if self.len > 1 {
            self.refine()?;
        }
        for i in 0..self.len {
            self.settle(i)?;
        }
        let found = self.ring.map(|s| s.corner);
        let found = found.get(..self.len).unwrap_or(&[]);
        let corners = Polygon::hull(found, self.slop, self.flat());
        Ok(Face {
            ring: self.kept(&corners),
            top: self.top,
            slop: self.slop,
            round: (2.0 * self.roundness(&corners) * self.slop).sqrt(),
            corners,
            rounding: self.rounding,
        })
    }

    /// The largest radius of its corners; of a segment that of the less round end.
    fn roundness(&self, corners: &Polygon<CORNERS>) -> Real {
        let [a, b] = corners.corners() else {
            return self.radius;
        };
        let mut ends = [0.0; 2];
        for sample in self.ring.iter().take(self.len) {
            let [to_a, to_b] = [a, b].map(|end| length(&side(&sample.corner.at, &end.at)));
            let end = &mut ends[usize::from(to_b < to_a)];
            *end = larger(*end, sample.radius);
        }
        ends[0].min(ends[1])
    }

    /// What is kept of the face.
    fn kept(&self, corners: &Polygon<CORNERS>) -> Ring {
        let mut ring = Ring::NONE;
        let lows = corners.corners().iter().map(|c| c.low);
        (ring.tilt, ring.slop) = (short(self.tilt), short(self.slop));
        ring.excess = short(larger(lows.fold(Real::INFINITY, Real::min), 0.0));
        ring.radius = short(self.radius);
        ring.len = corners.corners().len() as f32;
        // Of a full ring nobody knows what is between its corners.
        ring.inscribed = f32::from(u8::from(self.len == CORNERS));
        for (known, corner) in ring.corners.iter_mut().zip(corners.corners()) {
            let samples = self.ring.iter().take(self.len);
            let sample = samples.into_iter().find(|s| s.corner == *corner);
            let sample = sample.copied().unwrap_or_default();
            *known = Known {
                at: corner.at.map(short),
                low: short(corner.low),
                aside: sample.again.map(short),
                radius: short(sample.radius),
            };
        }
        ring
    }
}

/// A face of an object by what is kept of it, else from nothing, and how it moved.
fn face<S: SupportMap>(
    object: &S,
    plane: &mut Plane,
    sign: Real,
    slop: Real,
    ring: Option<&Ring>,
) -> Result<(Face, Option<Motion>), Fault> {
    // The first point is the origin of the plane.
    let first = sign > 0.0;
    if let Some(ring) = ring {
        if let Some(asked) = ring.ask(object, plane, sign)? {
            if first {
                plane.origin = asked.first();
            }
            if let Some((face, motion)) = ring.recall(&asked, plane, sign) {
                return Ok((face, Some(motion)));
            }
        }
    }
    let top = search(object, plane, sign).point([0.0; 2])?;
    if first {
        plane.origin = top;
    }
    Ok((search(object, plane, sign).face(top, slop)?, None))
}

/// The points in which the objects touch, as their faces that look along the unit vector
/// `normal` and against it show, at most `max` of them. At most 24 support points of each, and
/// those that ask in vain for what the memory holds.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
pub fn contacts<A: SupportMap, B: SupportMap>(
    obj1: &A,
    obj2: &B,
    normal: &Vec3,
    slop: Real,
    memory: Option<&mut Memory>,
    max: usize,
) -> Result<Manifold, Fault> {
    let mut known = memory.as_deref().copied();
    let again = known.as_mut().and_then(|known| known.plane(normal, slop));
    let rings = known.as_ref().filter(|_| again.is_some());
    let [ring1, ring2] = [0, 1].map(|i| rings.map(|known| &known.rings()[i]));
    let mut plane = again.unwrap_or_else(|| Plane::of(normal));
    let (one, motion1) = face(obj1, &mut plane, 1.0, slop, ring1)?;
    let (two, motion2) = face(obj2, &mut plane, -1.0, slop, ring2)?;
    let (mut region, beside) = shared(&one, &two);
    for corner in region.corners_mut() {
        corner.low = one.low(&corner.at) + two.low(&corner.at);
    }
    let names = known.as_ref().map_or(Names::NONE, |known| {
        let slop = larger(one.slop, two.slop);
        known.names([motion1, motion2], region.corners(), slop)
    });
    let chosen = chosen(&region, &names, max, one.rounding + two.rounding);
    let mut manifold = Manifold {
        contacts: [Contact::default(); ROOM],
        len: 0,
    };
    let mut named = [([0.0; 2], 0); ROOM];
    let places = manifold.contacts.iter_mut().zip(&mut named);
    for ((contact, named), corner) in places.zip(chosen.corners()) {
        let [at1, at2] = beside.unwrap_or([corner.at; 2]);
        let lows = [one.low(&at1), two.low(&at2)];
        let point1 = plane.point(&at1, one.top - lows[0]);
        let depth = one.top + two.top - lows[0] - lows[1];
        let across = plane.point(&side(&at1, &at2), 0.0) - plane.origin;
        let mut all = region.corners().iter();
        let name = names.of(all.position(|c| c.at == corner.at).unwrap_or(ROOM));
        let name = match &mut known {
            Some(known) if name == 0 => known.name(),
            _ => name,
        };
        *named = (corner.at, name);
        *contact = Contact {
            point1,
            point2: point1 - plane.n * depth + across,
            depth,
            name,
        };
        manifold.len += 1;
    }
    if let (Some(memory), Some(mut known)) = (memory, known) {
        let named = named.get(..manifold.len).unwrap_or(&[]);
        known.keep(&plane, slop, [one.ring, two.ring], named);
        *memory = known;
    }
    Ok(manifold)
}

/// At most `max` corners of the region, the deepest first. Those that have names stay while
/// they span nine tenths of the largest area; differences by `tie` are rounding.
fn chosen(region: &Polygon<ROOM>, names: &Names, max: usize, tie: Real) -> Polygon<ROOM> {
    let corners = region.corners();
    // Rounding alone makes no corner the deepest.
    let (mut deepest, mut least) = (0, corners.first().map_or(0.0, |corner| corner.low));
    for (i, corner) in corners.iter().enumerate() {
        if corner.low < least - tie {
            (deepest, least) = (i, corner.low);
        }
    }
    if let Some(i) = names.first() {
        let still = corners.get(i).is_some_and(|c| c.low <= least + tie);
        deepest = if still { i } else { deepest };
    }
    let best = region.reduced(deepest, max);
    if corners.len() <= max || !names.has(deepest) {
        return best;
    }
    let mut kept = Polygon::default();
    for i in (deepest..corners.len()).chain(0..deepest) {
        if names.has(i) {
            kept.extend(corners.get(i..=i).unwrap_or(&[]));
        }
    }
    let size = |p: &Polygon<ROOM>| match p.corners() {
        [a, b] => length(&side(&a.at, &b.at)),
        _ => p.area(),
    };
    if kept.corners().len() == best.corners().len() && size(&kept) >= 0.9 * size(&best) {
        return kept;
    }
    best
}

/// A place in the ring that is in range whatever `i` is.
fn place(i: usize) -> usize {
    i.min(CORNERS - 1)
}

fn search<'a, S>(object: &'a S, plane: &'a Plane, sign: Real) -> Search<'a, S> {
    Search {
        object,
        plane,
        sign,
        top: 0.0,
        first: [0.0; 2],
        slop: 0.0,
        size: 0.0,
        tilt: 0.0,
        rounding: 0.0,
        // The point along the face's own direction.
        asked: 1,
        ring: [Sample::default(); CORNERS],
        len: 0,
        radius: 0.0,
    }
}

/// What the two faces share; where that is nothing within the slop, the point between them, and
/// the nearest point of each.
fn shared(one: &Face, two: &Face) -> (Polygon<ROOM>, Option<[Flat; 2]>) {
    let rounding = one.rounding + two.rounding;
    let reach = [one.reach(), two.reach()];
    let (mut small, mut large, mut own) = (&one.corners, &two.corners, reach[0]);
    let swapped = small.area() > large.area();
    if swapped {
        (small, large, own) = (large, small, reach[1]);
    }
    let slack = reach[0] + reach[1];
    // A point between the two is to be on both: the rounder one reaches farther.
    let share = own / slack;
    let beside = |sides: &[[Flat; 2]; 2]| strip(sides, slack, share, rounding);
    let mut region: Polygon<ROOM> = Polygon::default();
    match (small.corners(), large.corners()) {
        ([a, b], [c, d]) => {
            let sides = [[a.at, b.at], [c.at, d.at]];
            region.extend(crossing(&sides).as_slice());
            if region.corners().is_empty() {
                region.extend(beside(&sides).corners());
            }
        }
        (_, [_, _, _, ..]) => {
            region.extend(small.corners());
            region = region.inside(large, rounding);
        }
        _ => {}
    }
    if !region.corners().is_empty() {
        return (Polygon::hull(region.corners(), rounding, rounding), None);
    }
    let Some(near) = small.nearest(large) else {
        return (region, None);
    };
    if one.round + two.round > 0.0 {
        region.extend(beside(&near.sides).corners());
    }
    if !region.corners().is_empty() {
        return (region, None);
    }
    let [a, b] = near.points;
    region.push(Corner {
        at: between(&a, &b, 0.5),
        low: 0.0,
    });
    let far = near.apart > one.slop.min(two.slop);
    let points = if swapped { [b, a] } else { [a, b] };
    (region, far.then_some(points))
}

/// Where two segments cross, at more than an angle that makes them parallel.
fn crossing([[p, q], [r, s]]: &[[Flat; 2]; 2]) -> Option<Corner> {
    let (u, v, w) = (side(p, q), side(r, s), side(p, r));
    let whole = cross(&u, &v);
    if !(whole.abs() > PARALLEL * length(&u) * length(&v)) {
        return None;
    }
    let [t, k] = [cross(&w, &v), cross(&w, &u)].map(|x| x / whole);
    let on = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&k);
    on.then(|| Corner {
        at: between(p, q, t),
        low: 0.0,
    })
}

/// The ends of what two nearly parallel segments share, where they are no farther apart than
/// `slack`, moved by a `share` of the way to the second. None where they are not.
fn strip(
    [[p, q], [r, s]]: &[[Flat; 2]; 2],
    slack: Real,
    share: Real,
    rounding: Real,
) -> Polygon<2> {
    let mut ends = Polygon::default();
    let (u, v) = (side(p, q), side(r, s));
    let whole = length(&v);
    if !(cross(&u, &v).abs() <= PARALLEL * length(&u) * whole && length(&u) > 0.0 && whole > 0.0) {
        return ends;
    }
    let v = v.map(|x| x / whole);
    // Along the first segment, from 0 to 1: as long as it is beside the other.
    let (mut from, mut to) = (0.0, 1.0);
    let mut narrow = |start: Real, slope: Real, least: Real, most: Real| {
        let (a, b) = ((least - start) / slope, (most - start) / slope);
        if slope == 0.0 {
            if !(least <= start && start <= most) {
                to = Real::NEG_INFINITY;
            }
        } else {
            from = larger(from, a.min(b));
            to = to.min(larger(a, b));
        }
    };
    let w = side(r, p);
    narrow(cross(&v, &w), cross(&v, &u), -slack, slack);
    narrow(dot(&v, &w), dot(&v, &u), -rounding, whole + rounding);
    if from <= to {
        for t in [from, to] {
            let at = between(p, q, t);
            let other = between(r, s, nearest_to(&at, r, s));
            ends.push(Corner {
                at: between(&at, &other, share),
                low: 0.0,
            });
        }
    }
    Polygon::hull(ends.corners(), rounding, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Random, ball, capsule, corners, hull, placed};

    const SLOP: Real = if EPSILON < 1e-10 { 1e-6 } else { 1e-4 };

    /// A square plate's top face at z = 0, and a box on it, turned about z.
    fn stacked(angle: Real, max: usize) -> Manifold {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let turn = crate::shapes::Rotation::from_axis_angle(&Vec3::z_axis(), angle);
        let plate = placed(&plate, &turn, Vec3::z() * -0.5);
        let cube = corners(Vec3::new(1.0, 1.0, 0.5));
        let cube = placed(&cube, &turn.inverse(), Vec3::z() * 0.49);
        contacts(&hull(&plate), &hull(&cube), &Vec3::z(), SLOP, None, max).unwrap()
    }

    #[test]
    fn an_octagon_and_what_is_left_of_it() {
        let angle = core::f64::consts::FRAC_PI_8 as Real;
        let whole = stacked(angle, ROOM);
        assert_eq!(whole.contacts().len(), 8);
        for c in whole.contacts() {
            assert!((c.depth - 0.01).abs() < 64.0 * EPSILON);
            assert!(c.point1.z.abs() < 64.0 * EPSILON);
            let apart = c.point1 - c.point2 - Vec3::z() * c.depth;
            assert!(apart.norm() < 64.0 * EPSILON);
        }
        // In order around the normal.
        let area = |m: &Manifold| {
            let first = m.contacts()[0].point1;
            let spokes = m.contacts().iter().map(|c| c.point1 - first);
            let pairs = spokes.clone().zip(spokes.skip(1));
            pairs.map(|(a, b)| 0.5 * a.cross(&b).z).sum::<Real>()
        };
        let octagon = 8.0 * (2.0 as Real).sqrt() - 8.0;
        assert!((area(&whole) - octagon).abs() < 8.0 * SLOP);
        // Four of a regular octagon: a square, which has 1 / sqrt(2) of its area.
        let four = stacked(angle, 4);
        assert_eq!(four.contacts().len(), 4);
        assert!((area(&four) - octagon * (0.5 as Real).sqrt()).abs() < 8.0 * SLOP);
        let two = stacked(angle, 2);
        let long = (two.contacts()[0].point1 - two.contacts()[1].point1).norm();
        let angle = 2.0 * angle.cos();
        assert!(
            (long - 2.0 * (1.0 / (0.5 * angle))).abs() < 8.0 * SLOP,
            "{long}"
        );
        assert_eq!(stacked(0.3, 1).contacts().len(), 1);
    }

    #[test]
    fn the_deepest_is_first() {
        let mut r = Random::new(4);
        for _ in 0..200 {
            let plate = corners(Vec3::new(2.0, 2.0, 0.5));
            let turn = nalgebra::UnitQuaternion::from_scaled_axis(
                Vec3::new(
                    r.within(-0.2, 0.2),
                    r.within(-0.2, 0.2),
                    r.within(-3.0, 3.0),
                ) * 1.0,
            );
            let slop = 0.6;
            let cube = placed(&corners(Vec3::repeat(0.5)), &turn.into(), Vec3::z());
            let found = contacts(&hull(&plate), &hull(&cube), &Vec3::z(), slop, None, 4).unwrap();
            let deepest = found.contacts()[0].depth;
            assert!(
                found
                    .contacts()
                    .iter()
                    .all(|c| c.depth <= deepest + 64.0 * EPSILON)
            );
        }
    }

    #[test]
    fn round_objects_touch_in_points() {
        let plate = corners(Vec3::new(1.0, 1.0, 0.5));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let at = Vec3::new(r.within(-0.3, 0.3), r.within(-0.3, 0.3), 0.89);
            let found = contacts(&hull(&plate), &ball(at, 0.4), &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.contacts().len(), 1);
            let across = found.contacts()[0].point1 - at;
            assert!(across.xy().norm() < SLOP, "{across}");
            let way = Vec3::new(0.3, r.within(-0.3, 0.3), 0.0);
            let rod = capsule(at - way, at + way, 0.4);
            let found = contacts(&hull(&plate), &rod, &Vec3::z(), SLOP, None, 8).unwrap();
            assert_eq!(found.contacts().len(), 2);
            for c in found.contacts() {
                let across = (c.point1 - at).xy();
                let end = (across - way.xy()).norm().min((across + way.xy()).norm());
                assert!(end < 2.0 * SLOP, "{end:e}");
            }
        }
    }

    /// The axes in the plane turn no faster than the normal.
    #[test]
    fn the_plane_turns_with_its_normal() {
        let mut r = Random::new(6);
        for _ in 0..1000 {
            let n = r.direction();
            let m = (n + r.vector(1e-3)).normalize();
            let (p, q) = (Plane::of(&n), Plane::of(&m));
            assert!(p.e1.dot(&n).abs() + p.e2.dot(&n).abs() < 64.0 * EPSILON);
            assert!((p.e1.cross(&p.e2) - n).norm() < 64.0 * EPSILON);
            if n.dot(&Vec3::new(0.36, 0.48, 0.8)) > -0.9 {
                assert!((p.e1 - q.e1).norm() < 10.0 * (n - m).norm() + 64.0 * EPSILON);
            }
        }
    }
}
