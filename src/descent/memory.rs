// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a search leaves behind for the next one of the pair.

use super::curvature::{Curvature, Symmetric};
use super::model::{Model, Step};
use super::search::ASIDE;
use crate::math::{EPSILON, Real, Vec3, unit};

/// What a query leaves behind for the next one of the pair: all zero is cold, and
/// any other bits are harmless, since they only choose where to look first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    /// The direction of the answer, or a guess of it.
    pub dir: Vec3,
    /// The gradients of the active cuts there, metres.
    pub slopes: [Vec3; 3],
    /// R, metres: xx, xy, xz, yy, yz, zz.
    pub curvature: [Real; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: Real,
    /// How many of `slopes` are in use.
    pub count: u32,
    /// 1 if `curvature` was measured.
    pub curved: u32,
}

/// Directions to ask before the first model, last one first.
pub struct Queue {
    dirs: [Vec3; 3],
    len: usize,
}

impl Queue {
    pub const EMPTY: Self = Self {
        dirs: [Vec3::new(0.0, 0.0, 0.0); 3],
        len: 0,
    };

    #[inline]
    fn push(&mut self, n: Vec3) {
        if let Some(place) = self.dirs.get_mut(self.len) {
            *place = n;
            self.len += 1;
        }
    }

    #[inline]
    pub fn pop(&mut self) -> Option<Vec3> {
        self.len = self.len.checked_sub(1)?;
        self.dirs.get(self.len).copied()
    }
}

impl Memory {
    /// Leaves behind what finds the same active cuts again.
    pub fn remember(&mut self, curvature: &Curvature, model: &Model, step: &Step) {
        let drift = if self.count > 0 || self.curved == 1 {
            (model.b - self.dir).norm()
        } else {
            0.0
        };
        let gradient = |i: usize| model.e1 * model.x[i] + model.e2 * model.y[i];
        let (slopes, count) = match step.count {
            1 => ([Vec3::zeros(); 3], 0),
            count => (step.set.map(gradient), count as u32),
        };
        *self = Self {
            dir: model.b,
            slopes,
            curvature: curvature.r.entries(),
            drift,
            count,
            curved: u32::from(curvature.known),
        };
    }

    /// Takes what still makes sense: the directions to ask first, around the remembered unit
    /// vector `dir`, the angle between them and it, and the curvature.
    pub fn recall(&self, dir: &Vec3, curvature: &mut Curvature) -> (Queue, Real) {
        // Farther aside than the pair moved, and not as far where R is known, which serves
        // the better the nearer the samples are (in double precision); NaN becomes the least
        // angle. Measured in motion: ×2, ÷2 of the factors up to 12 % and 4 % of one set, of the
        // least angles 5 % and 2 %; the same two numbers for both 10 to 23 %.
        let (times, least) = if self.curved == 1 && EPSILON < 1e-10 {
            (2.0, 0.0005)
        } else {
            (5.0, 0.004)
        };
        let drift = times * self.drift;
        let angle = if drift > least {
            drift.min(ASIDE)
        } else {
            least
        };
        if self.curved == 1 && self.curvature.iter().sum::<Real>().is_finite() {
            curvature.recall(Symmetric::of(self.curvature));
        }
        (self.towards_cuts(dir, angle), angle)
    }

    /// A direction for each remembered cut, where it is above the other two by as much as it
    /// can, this far aside.
    fn towards_cuts(&self, dir: &Vec3, angle: Real) -> Queue {
        let mut queue = Queue::EMPTY;
        let count = (self.count as usize).min(self.slopes.len());
        let at = |i: usize| self.slopes[(i % count).min(2)];
        for i in 0..count {
            let (g, h, k) = (at(i), at(i + 1), at(i + 2));
            // Across the line on which the other two are equal, and, since a face may have a
            // fourth vertex there, towards the vertex itself.
            let side = if count == 3 {
                let across = dir.cross(&(k - h));
                let up = across.dot(&(g - h));
                unit(&across)
                    .zip(unit(&g))
                    .map(|(a, g)| a * (1.0 as Real).copysign(up) + g)
            } else {
                Some(g - h)
            };
            let across = side.map(|s| s - dir * dir.dot(&s));
            if let Some(n) = across
                .and_then(|a| unit(&a))
                .and_then(|s| unit(&(dir + s * angle)))
            {
                queue.push(n);
            }
        }
        queue
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::tests::{around, samples};
    use super::*;
    use crate::shapes::{Random, corners, hull};
    use crate::support::Known;

    #[test]
    fn each_remembered_cut_is_asked_where_it_is_highest() {
        let mut r = Random::new(9);
        let mut met = 0;
        for _ in 0..1000 {
            let shape = hull(&corners(r.vector(1.0).abs() + Vec3::repeat(0.1)));
            let mut known = Known::default();
            let samples = samples(&mut known, &shape, &around(&mut r, 3, 0.9));
            let curvature = Curvature::new();
            let model = Model::new(&samples, &curvature);
            let step = (0..3).map(|i| model.minimise(i, 1.0, samples.rounding));
            let Some(step) = step.into_iter().find(|step| step.count == 3) else {
                continue;
            };
            met += 1;
            let mut memory = Memory::default();
            memory.remember(&curvature, &model, &step);
            let (mut queue, angle) = memory.recall(&model.b, &mut Curvature::new());
            // Last one first.
            for i in (0..3).rev() {
                let n = queue.pop().unwrap();
                assert!((n.norm() - 1.0).abs() < 4.0 * EPSILON);
                let tangent = n - model.b * model.b.dot(&n);
                assert!((tangent.norm() - angle).abs() < 0.01 * angle);
                let slope = |k: usize| memory.slopes[k % 3].dot(&tangent);
                assert!(slope(i) > slope(i + 1) && slope(i) > slope(i + 2));
            }
            assert!(queue.pop().is_none());
        }
        assert!(met > 20, "{met}");
    }

    #[test]
    fn what_makes_no_sense_is_not_recalled() {
        let memory = Memory {
            dir: Vec3::z(),
            slopes: [Vec3::repeat(Real::NAN), Vec3::zeros(), Vec3::z()],
            curvature: [Real::INFINITY, 1.0, Real::NAN, 0.0, 0.0, 0.0],
            drift: Real::NAN,
            count: 77,
            curved: 1,
        };
        let mut curvature = Curvature::new();
        let (mut queue, angle) = memory.recall(&Vec3::z(), &mut curvature);
        assert!(queue.pop().is_none() && !curvature.known);
        assert!(angle > 0.0 && angle < ASIDE);
    }
}
