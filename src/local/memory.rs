// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a search leaves behind for the next one of the pair.

use super::trust_region::ASIDE;
use crate::contacts::polygon::{Flat, dot, length, side};
use crate::known::round::{Disc, Round, Symmetric};
use crate::math::{EPSILON, Real, Vec3, basis, unit};

/// What a query leaves behind for the next one of the pair: all zero is cold, and
/// any other bits are harmless, since they only choose where to look first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    /// The direction of the answer, or a guess of it.
    pub dir: Vec3,
    /// The gradients of the active cuts there, metres; of one cut, numbers for which there is no room
    /// in `curvature`.
    pub slopes: [Vec3; 3],
    /// What is round of obj1, and after that of obj2, metres: a ball's radius; a disc's axis times its
    /// radius; or R: xx, xy, xz, yy, yz, zz.
    pub curvature: [Real; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: Real,
    /// How many of `slopes` are in use.
    pub count: u32,
    /// What `curvature` is of obj1: 0 nothing, 1 a ball, 2 a disc, 3 R; and four times that of obj2.
    pub curved: u32,
}

/// Bits of [`Memory::curved`] for the kind of one object's round part: nothing, a ball, a disc, R.
const KIND: u32 = 2;
const DISC: u32 = 2;
const CURVED: usize = 3;
/// The numbers of each kind: nothing, a radius, an axis times a radius, a matrix.
const NUMBERS: [usize; 4] = [0, 1, 3, FEW];
/// Room for numbers in [`Memory::curvature`].
const FEW: usize = 6;

/// The kind of a round part, and its numbers.
fn numbers(round: &Round) -> (usize, [Real; FEW]) {
    match round {
        Round::None => (0, [0.0; FEW]),
        Round::Ball(radius) => (1, [*radius, 0.0, 0.0, 0.0, 0.0, 0.0]),
        Round::Disc(disc) => {
            let axis = disc.axis * disc.radius;
            (2, [axis.x, axis.y, axis.z, 0.0, 0.0, 0.0])
        }
        Round::Curved(Symmetric(r)) => (CURVED, *r),
    }
}

/// The round part of that kind with these numbers, if they make sense.
fn round(kind: usize, numbers: &[Real; FEW]) -> Round {
    let [x, y, z, ..] = *numbers;
    let axis = Vec3::new(x, y, z);
    let size: Real = numbers.iter().map(|number| number.abs()).sum();
    match (kind, unit(&axis)) {
        // Also NaN.
        _ if !(size > 0.0 && size < Real::INFINITY) => Round::None,
        (1, _) => Round::Ball(x),
        (2, Some(unit)) => Round::Disc(Disc {
            radius: axis.norm(),
            axis: unit,
        }),
        (CURVED, _) => Round::Curved(Symmetric(*numbers)),
        _ => Round::None,
    }
}

/// [`Memory::count`] where an edge of each object crosses the other's: the slopes at one end of both,
/// at the other end of the one, and of the other.
pub const EDGES: u32 = 4;
/// How much farther aside edges are asked for than corners. Measured: 1 +0.1 %, +4 % (boxes in
/// motion); 2 no change; …
const WIDER: Real = 1.4;
/// … and the second of the two directions, to the other side: not opposite to the first, where both
/// could show the same ends. Measured: ÷2 +0.1 %, +3 %; −1 +0.9 %, +12 % (boxes in motion).
const OPPOSITE: Real = -0.7;

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

    /// One direction.
    #[inline]
    pub fn of(n: Vec3) -> Self {
        let mut queue = Self::EMPTY;
        queue.push(n);
        queue
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

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
    /// many these are, and what is round of each object.
    #[inline]
    pub fn keep(&mut self, dir: &Vec3, slopes: &[Vec3; 3], count: usize, round: &[Round; 2]) {
        let drift = if self.count > 0 || self.curved != 0 {
            (dir - self.dir).norm()
        } else {
            0.0
        };
        // One cut has no others to be found again.
        let several = count > 1;
        *self = Self {
            dir: *dir,
            slopes: if several { *slopes } else { [Vec3::zeros(); 3] },
            curvature: [0.0; 6],
            drift,
            count: if several { count as u32 } else { 0 },
            curved: 0,
        };
        self.put(round);
    }

    /// Notes what is round of each object; of R what there is room for.
    fn put(&mut self, round: &[Round; 2]) {
        let [one, two] = round.map(|round| numbers(&round));
        let (mut kinds, mut at) = ([one.0, two.0], 0);
        if kinds == [0; 2] {
            return;
        }
        if self.count > 1 && NUMBERS[kinds[0] % 4] + NUMBERS[kinds[1] % 4] > FEW {
            let second = usize::from(kinds[1] == CURVED);
            kinds[second] = 0;
        }
        let mut all = [0.0; FEW + 9];
        for (kind, (_, own)) in kinds.into_iter().zip([one, two]) {
            for (place, number) in all.iter_mut().skip(at).zip(own).take(NUMBERS[kind % 4]) {
                *place = number;
            }
            at += NUMBERS[kind % 4];
        }
        let mut all = all.into_iter();
        self.curvature = self.curvature.map(|_| all.next().unwrap_or(0.0));
        if self.count < 2 {
            self.slopes = self.slopes.map(|v| v.map(|_| all.next().unwrap_or(0.0)));
        }
        self.curved = (kinds[0] | kinds[1] << KIND) as u32;
    }

    /// What was round of each object and still makes sense.
    #[inline]
    pub fn round(&self) -> [Round; 2] {
        // Of several cuts there is no room beside them.
        let slopes: &[Vec3] = if self.count < 2 { &self.slopes } else { &[] };
        let others = slopes.iter().flatten();
        let mut all = [0.0; FEW + 9];
        for (place, number) in all.iter_mut().zip(self.curvature.iter().chain(others)) {
            *place = *number;
        }
        let mut at = 0;
        [0, KIND].map(|shift| {
            let kind = (self.curved >> shift) as usize % 4;
            let mut own = [0.0; FEW];
            for (own, number) in own
                .iter_mut()
                .zip(all.iter().skip(at))
                .take(NUMBERS[kind % 4])
            {
                *own = *number;
            }
            at += NUMBERS[kind % 4];
            round(kind, &own)
        })
    }

    /// The memory of the same objects in the other order, whose D is this one's mirror image
    /// in the origin: directions and gradients change sign, lengths and R stay.
    pub fn flip(&mut self) {
        let [one, two] = self.round();
        // Not -v: a cold memory is one of plain zeros.
        self.dir = Vec3::zeros() - self.dir;
        self.slopes = self.slopes.map(|v| Vec3::zeros() - v);
        if self.curved != 0 {
            self.put(&[two, one]);
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
        let alone = self.curved != 0 && !self.has_disc();
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

    fn has_disc(&self) -> bool {
        self.curved & 3 == DISC || self.curved >> KIND & 3 == DISC
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
    use super::*;
    use crate::shapes::Random;

    /// Directions to ask are as far aside as said, each where its cut is above the others.
    #[test]
    fn each_remembered_cut_is_asked_where_it_is_highest() {
        let mut r = Random::new(9);
        for _ in 0..1000 {
            let dir = r.direction();
            let (e1, e2) = basis(&dir);
            // Three slopes around the origin.
            let turn = r.within(0.0, 6.0);
            let slopes = [0.0, 2.1, 4.2].map(|at: Real| {
                let (s, c) = (at + turn + r.within(-0.4, 0.4)).sin_cos();
                (e1 * c + e2 * s) * r.within(0.5, 1.0)
            });
            let mut memory = Memory::default();
            memory.keep(&dir, &slopes, 3, &[Round::None; 2]);
            let (mut queue, angle) = memory.recall(&dir);
            // Last one first.
            for i in (0..3).rev() {
                let n = queue.pop().unwrap();
                assert!((n.norm() - 1.0).abs() < 4.0 * EPSILON);
                let tangent = n - dir * dir.dot(&n);
                assert!((tangent.norm() - angle).abs() < 0.01 * angle);
                let slope = |k: usize| memory.slopes[k % 3].dot(&tangent);
                assert!(slope(i) > slope(i + 1) && slope(i) > slope(i + 2));
            }
            assert!(queue.pop().is_none());
        }
    }

    const R: Symmetric = Symmetric([0.5, 0.1, 0.0, 0.4, -0.1, 0.3]);
    const S: Symmetric = Symmetric([0.25, 0.0, 0.1, 0.2, 0.0, 0.7]);

    fn kept(count: usize, round: &[Round; 2]) -> Memory {
        let mut memory = Memory::default();
        memory.keep(&Vec3::z(), &[Vec3::x(); 3], count, round);
        memory
    }

    /// What is round changes sides with the objects, and the slopes their signs.
    #[test]
    fn round_parts_change_sides_with_the_objects() {
        let disc = Disc {
            radius: 0.5,
            axis: Vec3::z(),
        };
        let all = [
            Round::None,
            Round::Ball(0.25),
            Round::Disc(disc),
            Round::Curved(R),
            Round::Curved(S),
        ];
        for one in all {
            for two in all {
                let mut memory = kept(1, &[one, two]);
                assert_eq!(memory.round(), [one, two]);
                memory.flip();
                assert_eq!(memory.round(), [two, one]);
                assert_eq!((memory.dir, memory.count), (-Vec3::z(), 0));
            }
        }
        let mut memory = kept(2, &[Round::Disc(disc), Round::Ball(0.25)]);
        memory.flip();
        assert_eq!(memory.round(), [Round::Ball(0.25), Round::Disc(disc)]);
        assert_eq!((memory.dir, memory.slopes[1]), (-Vec3::z(), -Vec3::x()));
    }

    /// Several cuts need the room: of R one has it, if the other object has nothing.
    #[test]
    fn several_cuts_leave_room_for_one_matrix() {
        assert_eq!(
            kept(2, &[Round::None, Round::Curved(R)]).round(),
            [Round::None, Round::Curved(R)]
        );
        assert_eq!(
            kept(3, &[Round::Curved(R), Round::Curved(S)]).round(),
            [Round::Curved(R), Round::None]
        );
        assert_eq!(
            kept(2, &[Round::Curved(R), Round::Ball(0.5)]).round(),
            [Round::None, Round::Ball(0.5)]
        );
    }

    #[test]
    fn what_makes_no_sense_is_not_recalled() {
        let disc = Disc {
            radius: 0.5,
            axis: Vec3::new(0.0, 0.6, 0.8),
        };
        for (place, lost) in [(0, 0), (2, 0), (3, 1)] {
            let mut memory = kept(2, &[Round::Disc(disc), Round::Ball(0.5)]);
            memory.curvature[place] = Real::NAN;
            let round = memory.round();
            assert!(round[lost] == Round::None && round[1 - lost] != Round::None);
        }
        // An axis of no length is no disc's.
        let mut memory = kept(2, &[Round::Disc(disc), Round::None]);
        memory.curvature = [0.0; 6];
        assert_eq!(memory.round(), [Round::None; 2]);
        let memory = Memory {
            dir: Vec3::z(),
            slopes: [Vec3::repeat(Real::NAN), Vec3::zeros(), Vec3::z()],
            curvature: [Real::INFINITY, 1.0, Real::NAN, 0.0, 0.0, 0.0],
            drift: Real::NAN,
            count: 77,
            curved: u32::MAX,
        };
        let (mut queue, angle) = memory.recall(&Vec3::z());
        assert!(queue.pop().is_none() && memory.round() == [Round::None; 2]);
        assert!(angle > 0.0 && angle < ASIDE);
    }
}
