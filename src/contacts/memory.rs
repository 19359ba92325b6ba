// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What one query for the contacts of a pair leaves for the next: both faces, and the points
//! with their names.
//!
//! A point keeps its name as long as it moves with either of the bodies, or beside it by less
//! than a quarter of the region: the nearest of the old ones, carried along, is what it was.

use crate::contacts::face::CORNERS;
use crate::contacts::manifold::ROOM;
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{Corner, Flat, cross, dot, length, side};
use crate::math::{Vec3, larger};
use core::mem::swap;

/// Points whose names are kept.
const NAMED: usize = 8;
/// Places are kept as `f32`, and are known to this share of the size of the face.
const KEPT: f64 = 4.0 * f32::EPSILON as f64;

/// What is kept as an `f32`.
#[allow(clippy::unnecessary_cast, reason = "it is one in double precision")]
pub fn short(x: f64) -> f32 {
    x as f32
}

/// What was kept as an `f32`.
#[allow(clippy::useless_conversion, reason = "it is none in double precision")]
pub fn long(x: f32) -> f64 {
    f64::from(x)
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

impl Known {
    /// Its place.
    pub fn corner(&self) -> Corner {
        Corner {
            at: self.at.map(long),
            low: long(self.low),
        }
    }
}

/// The corners of a face, counterclockwise; no tilt stands for none.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Ring {
    pub tilt: f32,
    pub slop: f32,
    /// How many corners, a whole number.
    pub len: f32,
    /// Not 0: a curved face, or one of more corners.
    pub inscribed: f32,
    /// Not 0: the face is higher than its corners tell, its own direction is to be asked too.
    pub own: f32,
    pub corners: [Known; CORNERS],
}

impl Ring {
    /// The corners in use.
    pub fn corners(&self) -> &[Known] {
        // NaN and what is below 0 become 0.
        let len = (self.len as usize).min(CORNERS);
        self.corners.get(..len).unwrap_or(&[])
    }

    /// A corner.
    pub fn corner(&self, i: usize) -> &Known {
        &self.corners[i.min(CORNERS - 1)]
    }

    /// How the corners moved to where they are now, if they did as one body does, but for the slack.
    pub fn motion(&self, now: &[Corner], slack: f64) -> Option<Motion> {
        let (from, to) = (self.corner(0).at.map(long), now.first()?.at);
        let spokes = || {
            let ways = self.corners().iter().zip(now);
            ways.map(|(a, b)| (side(&from, &a.at.map(long)), side(&to, &b.at)))
        };
        let mut motion = Motion {
            turn: [1.0, 0.0],
            from,
            to,
        };
        let (mut reach, mut turn) = (0.0, motion.turn);
        for (a, b) in spokes() {
            if length(&a) > reach {
                (reach, turn) = (length(&a), [dot(&a, &b), cross(&a, &b)]);
            }
        }
        let slack = slack + KEPT * reach;
        // What is no longer than a round corner is wide does not tell how it turned.
        if reach > 64.0 * slack {
            let whole = length(&turn);
            motion.turn = turn.map(|x| x / whole);
        }
        let as_one = |(a, b): (Flat, Flat)| length(&side(&motion.turned(&a), &b)) <= slack;
        spokes().all(as_one).then_some(motion)
    }

    /// The same ring seen from the other side of the plane.
    fn mirror(&mut self) {
        let count = self.corners().len();
        for known in &mut self.corners {
            known.at[1] = -known.at[1];
            known.aside[1] = -known.aside[1];
        }
        if let Some(corners) = self.corners.get_mut(..count) {
            corners.reverse();
        }
    }
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
    /// A way, turned.
    pub fn turned(&self, [x, y]: &Flat) -> Flat {
        let [c, s] = self.turn;
        [c * x - s * y, s * x + c * y]
    }

    /// Where a point that moved along is now.
    fn of(&self, at: &Flat) -> Flat {
        let [x, y] = self.turned(&side(&self.from, at));
        [self.to[0] + x, self.to[1] + y]
    }
}

/// All zero is cold; any other bits are harmless: a [`Memory::sum`] that is not its own makes it cold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    normal: [f32; 3],
    /// The plane's first axis.
    axis: [f32; 3],
    /// As the faces were found with.
    slop: f32,
    rings: [Ring; 2],
    points: [[f32; 2]; NAMED],
    names: [u32; NAMED],
    count: u32,
    /// The name given last.
    last: u32,
    /// Of all that it holds.
    sum: u32,
}

/// Names of the corners of a region, 0 for none, and which of them was first.
#[derive(Default)]
pub struct Names {
    of: [u32; ROOM],
    pub first: Option<usize>,
}

impl Names {
    /// The name of corner `i`.
    pub fn of(&self, i: usize) -> u32 {
        self.of.get(i).copied().unwrap_or(0)
    }
}

impl Memory {
    /// The plane as it was, turned as little as the normal turned, and both faces; nothing where
    /// the memory is of another plane. Of the swapped pair it is turned round first.
    pub fn plane(&mut self, n: &Vec3) -> Option<Plane> {
        if self.sum != self.sum() {
            *self = Self::default();
        }
        let vector = |v: [f32; 3]| Vec3::from(v.map(long));
        let mut along = vector(self.normal).dot(n);
        if along < 0.0 {
            self.flip();
            along = -along;
        }
        let axis = vector(self.axis);
        let e1 = axis - n * n.dot(&axis);
        let length = e1.norm();
        // NaN is no plane.
        (along > 0.5 && along < 2.0 && length > 0.5 && length < 2.0).then(|| {
            let e1 = e1 / length;
            Plane {
                n: *n,
                axes: [e1, n.cross(&e1)],
                origin: Vec3::zeros(),
            }
        })
    }

    /// Returns whether the faces were found with a slop, or with one that is a little less: of a deep
    /// overlap it changes with the depth.
    pub fn has_slop(&self, slop: f64) -> bool {
        let (old, new) = (self.slop, short(slop));
        0.8 * new <= old && old <= new
    }

    /// A number that changed bits change: any odd factor makes it one.
    fn sum(&self) -> u32 {
        let mut sum = self.count ^ self.last.rotate_left(16);
        let mut mix = |x: f32| sum = (sum.rotate_left(5) ^ x.to_bits()).wrapping_mul(0x9e37_79b1);
        self.normal.into_iter().for_each(&mut mix);
        self.axis.into_iter().for_each(&mut mix);
        mix(self.slop);
        for ring in &self.rings {
            let head = [ring.tilt, ring.slop, ring.len, ring.inscribed, ring.own];
            head.into_iter().for_each(&mut mix);
            for known in &ring.corners {
                let ([x, y], [u, v]) = (known.at, known.aside);
                let all = [x, y, known.low, u, v, known.radius];
                all.into_iter().for_each(&mut mix);
            }
        }
        self.points.iter().flatten().copied().for_each(&mut mix);
        let names = self.names.map(f32::from_bits);
        names.into_iter().for_each(&mut mix);
        sum
    }

    fn flip(&mut self) {
        let [one, two] = &mut self.rings;
        swap(one, two);
        self.rings.iter_mut().for_each(Ring::mirror);
        self.points.iter_mut().for_each(|p| p[1] = -p[1]);
    }

    /// What is known of the faces.
    pub fn rings(&self) -> &[Ring; 2] {
        &self.rings
    }

    /// The names of what the faces share.
    pub fn names(&self, motions: [Option<Motion>; 2], corners: &[Corner], slop: f64) -> Names {
        let mut names = Names::default();
        let root = corners.first().map_or([0.0; 2], |c| c.at);
        let square = |a: &Flat, b: &Flat| dot(&side(a, b), &side(a, b));
        let reach = corners.iter().map(|c| square(&root, &c.at));
        let near = 0.25 * reach.fold(0.0, larger).sqrt() + slop;
        // The nearest of the old points to each corner, of which it is the nearest.
        let mut nearest = [(near * near, NAMED); ROOM];
        let count = (self.count as usize).min(NAMED);
        for (k, old) in self.points.iter().enumerate().take(count) {
            let old = old.map(long);
            let mut best = (near * near, ROOM);
            for now in motions.iter().flatten().map(|m| m.of(&old)) {
                for (i, corner) in corners.iter().enumerate() {
                    let apart = square(&now, &corner.at);
                    if apart < best.0 {
                        best = (apart, i);
                    }
                }
            }
            if let Some(nearest) = nearest.get_mut(best.1) {
                if best.0 < nearest.0 {
                    *nearest = (best.0, k);
                }
            }
        }
        for (i, ((_, k), name)) in nearest.iter().zip(&mut names.of).enumerate() {
            if let Some(old) = self.names.get(*k) {
                *name = (*old).max(1);
                if *k == 0 {
                    names.first = Some(i);
                }
            }
        }
        names
    }

    /// The next name.
    pub fn name(&mut self) -> u32 {
        self.last = self.last.wrapping_add(1).max(1);
        self.last
    }

    /// Keeps what the query found.
    pub fn keep(&mut self, plane: &Plane, slop: f64, rings: [Ring; 2], points: &[(Flat, u32)]) {
        self.normal = plane.n.map(short).into();
        self.axis = plane.axes[0].map(short).into();
        self.slop = short(slop);
        self.rings = rings;
        let places = self.points.iter_mut().zip(&mut self.names);
        for ((at, name), (place, old)) in points.iter().zip(places) {
            (*place, *old) = (at.map(short), *name);
        }
        self.count = points.len().min(NAMED) as u32;
        self.sum = self.sum();
    }
}
