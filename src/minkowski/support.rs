// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Support mappings, and the Minkowski difference D = obj1 − obj2 that every
//! solver works on (paper, Sec. II-A and II-B).

use core::cell::Cell;

use crate::math::{Vec3, larger, largest};

/// A convex object, known only by its support mapping.
pub trait SupportMap {
    /// A point of the object farthest along `dir` (unit, finite).
    fn support(&self, dir: &Vec3) -> Vec3;
}

impl<F: Fn(&Vec3) -> Vec3> SupportMap for F {
    #[inline]
    fn support(&self, dir: &Vec3) -> Vec3 {
        self(dir)
    }
}

/// A support point of D together with the two points it is the difference of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SupportPoint {
    /// `v1 - v2`, a boundary point of D.
    pub v: Vec3,
    /// The support point of obj1 in the queried direction.
    pub v1: Vec3,
    /// The support point of obj2 in the opposite direction.
    pub v2: Vec3,
}

impl SupportPoint {
    /// Largest absolute coordinate of the two witnesses: the size against which
    /// the rounding error of `v` is measured.
    #[inline]
    pub fn magnitude(&self) -> f64 {
        larger(largest(&self.v1), largest(&self.v2))
    }

    /// The point that share of the way to another.
    #[inline]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        Self {
            v: self.v.lerp(&other.v, share),
            v1: self.v1.lerp(&other.v1, share),
            v2: self.v2.lerp(&other.v2, share),
        }
    }
}

/// Points of D that a local search has come to know, each once: what the proof of the overlap
/// starts from.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    points: [SupportPoint; Known::ROOM],
    len: usize,
}

impl Known {
    /// How many points there is room for.
    pub const ROOM: usize = 8;

    /// The points.
    pub fn points(&self) -> &[SupportPoint] {
        self.points.get(..self.len).unwrap_or(&[])
    }

    /// Adds a point that is not there, if there is room.
    #[inline(always)]
    pub fn push(&mut self, p: &SupportPoint) {
        if let Some(place) = self.points.get_mut(self.len) {
            *place = *p;
            self.len += 1;
        }
    }

    /// Adds a point, unless it is there or there is no room.
    pub fn add(&mut self, p: &SupportPoint) {
        if !self.points().iter().any(|k| k.v == p.v) {
            self.push(p);
        }
    }
}

/// Why a query has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A support mapping returned a point that is not finite, or so large that the fourth
    /// power of its distance from the other object overflows.
    NonFinite,
    /// Memory was needed and not to be had.
    NoMemory,
}

/// D = obj1 − obj2, seen through its support mapping. Counts its evaluations.
pub struct MinkowskiDifference<A, B> {
    obj1: A,
    obj2: B,
    /// Calls of either object's mapping.
    calls: Cell<u64>,
}

impl<A: SupportMap, B: SupportMap> MinkowskiDifference<A, B> {
    /// The difference of two objects, nothing evaluated yet.
    pub fn new(obj1: A, obj2: B) -> Self {
        Self {
            obj1,
            obj2,
            calls: Cell::new(0),
        }
    }

    /// The support point of D along `dir` (unit, finite): obj1 is asked first,
    /// then obj2 along `-dir`.
    #[inline]
    pub fn support(&self, dir: &Vec3) -> Result<SupportPoint, Fault> {
        self.calls.set(self.calls.get() + 2);
        let v1 = self.obj1.support(dir);
        let v2 = self.obj2.support(&-dir);
        let v = v1 - v2;
        // Solvers multiply four lengths; a point beyond that is as good as infinite.
        // NaN and infinity, in v1 or in v2, end here too.
        let q = v.norm_squared();
        if !(q * q).is_finite() {
            return Err(Fault::NonFinite);
        }
        Ok(SupportPoint { v, v1, v2 })
    }

    /// The point of one object (0 or 1) in that direction of D: obj2 is asked along `-dir`. It may be
    /// not finite.
    #[inline]
    pub fn point_of(&self, object: usize, dir: &Vec3) -> Vec3 {
        self.calls.set(self.calls.get() + 1);
        match object {
            0 => self.obj1.support(dir),
            _ => self.obj2.support(&-dir),
        }
    }

    /// Support points evaluated so far (one = one call of each object's mapping, or two of one's).
    #[inline]
    pub fn supports(&self) -> u64 {
        self.calls.get().div_ceil(2)
    }
}
