// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a search leaves behind for the next one of the pair.

use super::model::basis;
use super::trust_region::ASIDE;
use crate::contacts::polygon::{Flat, dot, length, side};
use crate::known::round::{Disc, Symmetric};
use crate::math::{EPSILON, Real, Vec3, larger, unit};

/// What a query leaves behind for the next one of the pair: all zero is cold, and
/// any other bits are harmless, since they only choose where to look first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    /// The direction of the answer, or a guess of it.
    pub dir: Vec3,
    /// The gradients of the active cuts there, metres. Of one cut, if `curved` says so, obj1's part
    /// of R, six numbers.
    pub slopes: [Vec3; 3],
    /// R, metres: xx, xy, xz, yy, yz, zz. Or three numbers for each object: its ball's radius and
    /// zeros, or its disc's axis times its radius.
    pub curvature: [Real; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: Real,
    /// How many of `slopes` are in use.
    pub count: u32,
    /// 1 if `curvature` is R, and 16 more if obj1's part of it is known; 2 if it is balls and discs,
    /// and 4 more for a disc of obj1, 8 more for one of obj2; else nothing is known of it.
    pub curved: u32,
}

/// [`Memory::curved`] where R was known.
const CURVED: u32 = 1;
/// … and obj1's part of it.
const PARTED: u32 = 16;
const PARTED_R: u32 = CURVED + PARTED;
/// Where balls and discs were, …
const ROUND: u32 = 2;
/// … and whose these discs were.
const DISC: [u32; 2] = [4, 8];

/// [`Memory::count`] where an edge of each object crosses the other's: the slopes at one end of both,
/// at the other end of the one, and of the other.
pub const EDGES: u32 = 4;
/// How much farther aside edges are asked for than corners, …
const WIDER: Real = 1.4;
/// … and the second of the two directions, to the other side.
const OPPOSITE: Real = -0.7;

/// What is known of the smooth part of D.
#[derive(Clone, Copy, Debug)]
pub enum Smooth {
    /// Nothing.
    Unknown,
    /// R, metres, and, where it is known, obj1's part of it.
    Curved(Symmetric, Option<Symmetric>),
    /// The two objects' balls and discs.
    Round {
        /// Radii, metres; 0 for none.
        balls: [Real; 2],
        discs: [Disc; 2],
    },
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
    /// Nothing but a direction.
    pub fn towards(dir: Vec3) -> Self {
        Self {
            dir,
            ..Self::default()
        }
    }

    /// Leaves behind the direction of the minimum, the gradients of the active cuts and how
    /// many these are, and what is known of the smooth part.
    #[inline]
    pub fn keep(&mut self, dir: &Vec3, slopes: &[Vec3; 3], count: usize, smooth: Smooth) {
        let drift = if self.count > 0 || self.curved != 0 {
            (dir - self.dir).norm()
        } else {
            0.0
        };
        // One cut has no others to be found again.
        let several = count > 1;
        let mut slopes = if several { *slopes } else { [Vec3::zeros(); 3] };
        let (curved, curvature) = match smooth {
            Smooth::Unknown => (0, [0.0; 6]),
            Smooth::Curved(r, Some(Symmetric([a, b, c, d, e, f]))) if !several => {
                slopes = [Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::zeros()];
                (PARTED_R, r.0)
            }
            Smooth::Curved(r, _) => (CURVED, r.0),
            Smooth::Round { balls, discs } => {
                let mut curved = ROUND;
                let mut of = [0, 1].map(|o| Vec3::new(balls[o], 0.0, 0.0));
                for (o, disc) in discs.iter().enumerate() {
                    if disc.is_there() {
                        curved += DISC[o];
                        of[o] = disc.axis * disc.radius;
                    }
                }
                (
                    curved,
                    [of[0].x, of[0].y, of[0].z, of[1].x, of[1].y, of[1].z],
                )
            }
        };
        *self = Self {
            dir: *dir,
            slopes,
            curvature,
            drift,
            count: if several { count as u32 } else { 0 },
            curved,
        };
    }

    /// What was known of the smooth part and still makes sense.
    #[inline(always)]
    pub fn smooth(&self) -> Smooth {
        let [a, b, c, d, e, f] = self.curvature;
        if self.curved == 0 || !(a + b + c + d + e + f).is_finite() {
            return Smooth::Unknown;
        }
        match self.curved {
            CURVED => Smooth::Curved(Symmetric(self.curvature), None),
            PARTED_R => {
                let [a, b, _] = self.slopes;
                let part = [a.x, a.y, a.z, b.x, b.y, b.z];
                let known = part.iter().all(|x| x.is_finite());
                Smooth::Curved(Symmetric(self.curvature), known.then_some(Symmetric(part)))
            }
            _ if self.curved & ROUND != 0 => {
                let [x, y, z, p, q, r] = self.curvature;
                let of = [Vec3::new(x, y, z), Vec3::new(p, q, r)];
                let mut balls = [0.0; 2];
                let mut discs = [Disc::default(); 2];
                for (o, v) in of.iter().enumerate() {
                    if self.curved & DISC[o] == 0 {
                        balls[o] = larger(v.x, 0.0);
                    } else if let Some(axis) = unit(v) {
                        let radius = v.norm();
                        discs[o] = Disc { radius, axis };
                    }
                }
                Smooth::Round { balls, discs }
            }
            _ => Smooth::Unknown,
        }
    }

    /// Does the search begin with curvature? Three active cuts are mostly exact ones.
    #[inline]
    pub fn is_curved(&self) -> bool {
        self.count < 3 && matches!(self.smooth(), Smooth::Curved(..))
    }

    /// The memory of the same objects in the other order, whose D is this one's mirror image
    /// in the origin: directions and gradients change sign, lengths and R stay.
    pub fn flip(&mut self) {
        for v in self.slopes.iter_mut().chain([&mut self.dir]) {
            // Not -v: a cold memory is one of plain zeros.
            *v = Vec3::zeros() - *v;
        }
        if self.curved == PARTED_R {
            // The other part of it.
            let [a, b, _] = &mut self.slopes;
            for (x, r) in a.iter_mut().chain(b).zip(self.curvature) {
                *x += r;
            }
        }
        if self.curved & ROUND != 0 {
            self.curvature.rotate_left(3);
            let [a, b] = DISC.map(|disc| self.curved & disc != 0);
            self.curved = ROUND + u32::from(b) * DISC[0] + u32::from(a) * DISC[1];
        }
    }

    /// What still makes sense of the directions to ask first, around the remembered unit
    /// vector `dir`, and the angle between them and it.
    #[inline]
    pub fn recall(&self, dir: &Vec3) -> (Queue, Real) {
        // Farther aside than the pair moved, and not as far where R or balls alone are known, which
        // serve the better the nearer the samples are (in double precision); a disc's axis is told
        // by samples that are not as near. NaN becomes the least angle. Measured in motion: ×2, ÷2
        // of the factors up to 12 % and 4 % of one set, of the least angles 5 % and 2 %; the same
        // two numbers for both 10 to 23 %.
        let alone = self.curved & !PARTED == CURVED || self.curved == ROUND;
        let (times, least) = if alone && EPSILON < 1e-10 {
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
        (self.towards_cuts(dir, angle), angle)
    }

    /// Two directions that show both ends of the two edges: in the middle between their ways, and
    /// opposite.
    #[inline(never)]
    fn towards_edges(&self, dir: &Vec3, angle: Real) -> Queue {
        let mut queue = Queue::EMPTY;
        let [a, b, c] = self.slopes;
        if let (Some(e), Some(f)) = (unit(&(b - a)), unit(&(c - a))) {
            let way = if e.dot(&f) > 0.0 { e + f } else { e - f };
            if let Some(way) = unit(&(way - dir * dir.dot(&way))) {
                for share in [OPPOSITE, 1.0] {
                    let n = dir + way * (share * WIDER * angle);
                    queue.push(n * (1.0 / n.norm()));
                }
            }
        }
        queue
    }

    /// A direction for each remembered cut, where it is above the others by as much as it
    /// can, this far aside.
    fn towards_cuts(&self, dir: &Vec3, angle: Real) -> Queue {
        let mut queue = Queue::EMPTY;
        if self.count < 2 {
            return queue;
        }
        if self.count == EDGES {
            return self.towards_edges(dir, angle);
        }
        let (e1, e2) = basis(dir);
        let [a, b, c] = self.slopes.map(|g| [e1.dot(&g), e2.dot(&g)]);
        // All as long.
        let scale = 1.0 / (1.0 + angle * angle).sqrt();
        let (centre, e1, e2) = (dir * scale, e1 * (angle * scale), e2 * (angle * scale));
        let mut push = |side: Flat| {
            let length2 = dot(&side, &side);
            if length2 > Real::MIN_POSITIVE && length2 < Real::INFINITY {
                let [x, y] = side.map(|x| x * (1.0 / length2.sqrt()));
                queue.push(centre + e1 * x + e2 * y);
            }
        };
        if self.count == 2 {
            push(side(&b, &a));
            push(side(&a, &b));
            return queue;
        }
        // Across the line on which the other two are equal, and, since a face may have a
        // fourth vertex there, towards the vertex itself.
        for (g, h, k) in [(&a, &b, &c), (&b, &c, &a), (&c, &a, &b)] {
            let line = side(h, k);
            let across = [-line[1], line[0]];
            let sign = (1.0 as Real).copysign(dot(&across, &side(h, g)));
            let share = length(&line) / length(g);
            push([0, 1].map(|i| across[i] * sign + g[i] * share));
        }
        queue
    }
}

#[cfg(test)]
mod tests {
    use super::super::curvature::Curvature;
    use super::super::model::Model;
    use super::super::samples::tests::{around, samples};
    use super::*;
    use crate::known::support::Known;
    use crate::shapes::{Random, corners, hull};

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
            let gradient = |i: usize| model.e1 * model.x[i] + model.e2 * model.y[i];
            let slopes = step.set.map(gradient);
            memory.keep(&model.b, &slopes, step.count, Smooth::Unknown);
            let (mut queue, angle) = memory.recall(&model.b);
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
    fn balls_change_sides_with_the_objects() {
        let mut memory = Memory::default();
        memory.keep(
            &Vec3::z(),
            &[Vec3::x(); 3],
            2,
            Smooth::Round {
                balls: [0.5, 0.25],
                discs: Default::default(),
            },
        );
        memory.flip();
        assert!(matches!(
            memory.smooth(),
            Smooth::Round {
                balls: [0.25, 0.5],
                ..
            }
        ));
        assert_eq!((memory.dir, memory.slopes[1]), (-Vec3::z(), -Vec3::x()));
        memory.curvature[0] = Real::NAN;
        assert!(matches!(memory.smooth(), Smooth::Unknown));
    }

    #[test]
    fn the_other_part_of_r_is_obj2s() {
        let (r, part) = (
            Symmetric::scaled_identity(0.5),
            Symmetric::scaled_identity(0.125),
        );
        let mut memory = Memory::default();
        memory.keep(
            &Vec3::z(),
            &[Vec3::x(); 3],
            1,
            Smooth::Curved(r, Some(part)),
        );
        assert!(memory.is_curved());
        memory.flip();
        let other = Symmetric::scaled_identity(0.375);
        assert!(matches!(memory.smooth(), Smooth::Curved(s, Some(t)) if s == r && t == other));
        // Several cuts need the room.
        memory.keep(
            &Vec3::z(),
            &[Vec3::x(); 3],
            2,
            Smooth::Curved(r, Some(part)),
        );
        assert!(matches!(memory.smooth(), Smooth::Curved(_, None)));
    }

    #[test]
    fn discs_change_sides_with_the_objects() {
        let disc = Disc {
            radius: 0.5,
            axis: Vec3::new(0.0, 0.6, 0.8),
        };
        let mut memory = Memory::default();
        let smooth = Smooth::Round {
            balls: [0.0, 0.25],
            discs: [disc, Disc::default()],
        };
        memory.keep(&Vec3::z(), &[Vec3::x(); 3], 2, smooth);
        memory.flip();
        match memory.smooth() {
            Smooth::Round {
                balls: [ball, other],
                discs: [none, there],
            } => {
                assert_eq!((ball, other), (0.25, 0.0));
                assert!(!none.is_there() && (there.radius - 0.5).abs() < 4.0 * EPSILON);
                assert!((there.axis - disc.axis).norm() < 4.0 * EPSILON);
            }
            other => panic!("{other:?}"),
        }
        for i in 0..6 {
            let mut broken = memory;
            broken.curvature[i] = Real::NAN;
            assert!(matches!(broken.smooth(), Smooth::Unknown));
        }
        // An axis of no length is no disc's.
        memory.curvature = [0.0; 6];
        assert!(
            matches!(memory.smooth(), Smooth::Round { discs: [_, none], .. } if !none.is_there())
        );
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
        let (mut queue, angle) = memory.recall(&Vec3::z());
        assert!(queue.pop().is_none() && matches!(memory.smooth(), Smooth::Unknown));
        assert!(angle > 0.0 && angle < ASIDE);
    }
}
