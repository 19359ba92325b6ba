// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What one query for the contacts of a pair leaves for the next: both faces, and the points
//! with their names.
//!
//! A point keeps its name as long as it moves with either of the bodies, or beside it by less
//! than a quarter of the region: the nearest of the old ones, carried along, is what it was.

use crate::contacts::again::{Motion, Ring, long, short};
use crate::contacts::manifold::{Plane, ROOM};
use crate::contacts::polygon::{Corner, Flat, dot, side};
use crate::math::{Real, Vec3, larger};
use core::mem::swap;

/// Points whose names are kept.
const NAMED: usize = 8;

/// All zero is cold; any other bits are harmless: a [`Memory::sum`] that is not its own makes it cold.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Memory {
    normal: [f32; 3],
    /// The plane's first axis.
    axis: [f32; 3],
    /// As the caller gave it.
    slop: f32,
    rings: [Ring; 2],
    points: [[f32; 2]; NAMED],
    names: [u32; NAMED],
    count: u32,
    /// The name given last.
    last: u32,
    /// Of all that is in use.
    sum: u32,
}

impl Default for Memory {
    fn default() -> Self {
        Self {
            normal: [0.0; 3],
            axis: [0.0; 3],
            slop: 0.0,
            rings: [Ring::NONE; 2],
            points: [[0.0; 2]; NAMED],
            names: [0; NAMED],
            count: 0,
            last: 0,
            sum: 0,
        }
    }
}

/// Names of the corners of a region, 0 for none, and which of them was first.
pub struct Names {
    of: [u32; ROOM],
    first: Option<usize>,
}

impl Names {
    /// None.
    pub const NONE: Self = Self {
        of: [0; ROOM],
        first: None,
    };

    /// Whether corner `i` has one.
    pub fn has(&self, i: usize) -> bool {
        self.of.get(i).is_some_and(|name| *name != 0)
    }

    /// The corner that was the first point.
    pub fn first(&self) -> Option<usize> {
        self.first
    }

    /// The name of corner `i`.
    pub fn of(&self, i: usize) -> u32 {
        self.of.get(i).copied().unwrap_or(0)
    }
}

impl Memory {
    /// The plane as it was, turned as little as the normal turned, and both faces; nothing where
    /// the memory is of another plane. Of the swapped pair it is turned round first.
    pub fn plane(&mut self, n: &Vec3, slop: Real) -> Option<Plane> {
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
        let same = self.slop.to_bits() == short(slop).to_bits();
        (along > 0.5 && along < 2.0 && length > 0.5 && length < 2.0 && same)
            .then(|| Plane::with(n, &(e1 / length)))
    }

    /// A number that changed bits change: any odd factor makes it one.
    fn sum(&self) -> u32 {
        let mut sum = self.count ^ self.last.rotate_left(16);
        let mut mix = |x: f32| sum = (sum.rotate_left(5) ^ x.to_bits()).wrapping_mul(0x9e37_79b1);
        self.normal.into_iter().for_each(&mut mix);
        self.axis.into_iter().for_each(&mut mix);
        mix(self.slop);
        self.rings.iter().for_each(|ring| ring.visit(&mut mix));
        for (point, name) in self
            .points
            .iter()
            .zip(&self.names)
            .take(self.count as usize)
        {
            point.iter().copied().for_each(&mut mix);
            mix(f32::from_bits(*name));
        }
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
    pub fn names(&self, motions: [Option<Motion>; 2], corners: &[Corner], slop: Real) -> Names {
        let mut names = Names::NONE;
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
    pub fn keep(&mut self, plane: &Plane, slop: Real, rings: [Ring; 2], points: &[(Flat, u32)]) {
        self.normal = plane.n.map(short).into();
        self.axis = plane.e1.map(short).into();
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
