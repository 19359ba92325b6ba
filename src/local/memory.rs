// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a search leaves behind for the next one of the pair.

use super::trust_region::ASIDE;
use crate::math::{EPSILON, Vec3, ZERO, normalised, unit};
use crate::minkowski::support::SupportPoint;

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
    pub curvature: [f64; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: f64,
    /// How many of `slopes` are in use.
    pub count: u32,
    /// What `curvature` is of obj1: 0 nothing, 1 a ball, 2 a disc, 3 R; and four times that of obj2.
    pub curved: u32,
}

/// The kind of what is round of an object: nothing, a ball, a disc, R.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    #[default]
    None,
    Ball,
    Disc,
    Curved,
}

/// What is round of an object, in numbers: a ball's radius; a disc's axis times its radius; or R.
pub type Round = (Kind, [f64; FEW]);

/// Bits of [`Memory::curved`] for the kind of one object's round part.
const KIND: u32 = 2;
/// The kinds.
const KINDS: [Kind; 4] = [Kind::None, Kind::Ball, Kind::Disc, Kind::Curved];
/// Room for numbers in [`Memory::curvature`].
const FEW: usize = 6;

/// [`Memory::count`] where an edge of each object crosses the other's: the slopes at one end of both,
/// at the other end of the one, and of the other.
pub const EDGES: u32 = 4;
/// How much farther aside edges are asked for than corners. Measured: 1 +0.1 %, +4 % (boxes in
/// motion); 2 no change; …
const WIDER: f64 = 1.4;
/// … and the second of the two directions, to the other side: not opposite to the first, where both
/// could show the same ends. Measured: ÷2 +0.1 %, +3 %; −1 +0.9 %, +12 % (boxes in motion).
const OPPOSITE: f64 = -0.7;
/// How many times the tolerance a disc may lift D between the corners of a face: mostly it stands on its rim,
/// and lifts nothing. Measured: 1 +3 % (recorded contacts, 8 % more time); 1e4 +9 % (cylinders in motion at
/// 1e-10).
const RIM: f64 = 100.0;

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
        let moved = (dir - self.dir).norm();
        let known = self.count > 0 || self.curved != 0;
        *self = Self {
            drift: if known { moved } else { 0.0 },
            ..Self::towards(*dir)
        };
        // One cut has no others to be found again.
        if count > 1 {
            (self.slopes, self.count) = (*slopes, count as u32);
        }
        if round.iter().any(|(kind, _)| *kind != Kind::None) {
            self.put(round);
        }
    }

    /// Where the answer was in a face: the directions to ask first, and one to ask where these do not show
    /// it; zero for none. They are those of [`Memory::recall`]; where the face had not turned by the
    /// tolerance, the answer's own takes the place of one that shows a corner which it found itself.
    pub fn face(&self, tolerance: f64) -> Option<[Vec3; 4]> {
        if !matches!(self.count, 3 | EDGES) {
            return None;
        }
        // What is round lifts D between its corners.
        let turn2 = self.angle() * self.angle();
        let lifted = |(kind, numbers): &Round| {
            let size: f64 = numbers.iter().map(|x| x.abs()).sum();
            let times = if *kind == Kind::Disc { RIM } else { 1.0 };
            *kind != Kind::None && !(0.5 * size * turn2 <= times * tolerance)
        };
        if self.curved != 0 && self.round().iter().any(lifted) {
            return None;
        }
        let dir = unit(&self.dir)?;
        let [a, b, c] = self.recall(&dir);
        let (a, b, c) = (a?, b?, c.unwrap_or_default());
        let turned = |g: &Vec3| self.drift * g.norm() > tolerance;
        Some(if self.slopes.iter().any(turned) {
            [a, b, c, ZERO]
        } else if c == ZERO {
            [dir, a, ZERO, b]
        } else {
            [dir, a, b, c]
        })
    }

    /// Leaves behind the direction of a minimum in a face, its corners, and what was round before. Where an
    /// edge of each object crosses the other's the corner that is on both comes first.
    pub fn touch(&mut self, dir: &Vec3, corners: &[SupportPoint]) {
        let [a, b, c] = corners else { return };
        let one = |p: &SupportPoint, q: &SupportPoint| (p.v1 == q.v1) != (p.v2 == q.v2);
        let edges = [[a, b, c], [b, c, a], [c, a, b]];
        let mut edges = edges
            .into_iter()
            .filter(|[a, b, c]| one(a, b) && one(a, c) && !one(b, c));
        let (corners, count) = match edges.next() {
            Some(edges) => (edges, EDGES as usize),
            None => ([a, b, c], 3),
        };
        let slopes = corners.map(|p| p.v - dir * dir.dot(&p.v));
        let round = self.round();
        self.keep(dir, &slopes, count, &round);
    }

    /// Notes what is round of each object. Beside several cuts there is no room for R.
    fn put(&mut self, round: &[Round; 2]) {
        let [(mut one, p), (mut two, q)] = *round;
        if self.count < 2 {
            self.curvature = p;
            self.slopes = [
                Vec3::new(q[0], q[1], q[2]),
                Vec3::new(q[3], q[4], q[5]),
                ZERO,
            ];
        } else {
            one = if one == Kind::Curved { Kind::None } else { one };
            two = if two == Kind::Curved { Kind::None } else { two };
            self.curvature = [p[0], p[1], p[2], q[0], q[1], q[2]];
        }
        self.curved = one as u32 | (two as u32) << KIND;
    }

    /// What is round of obj1 and of obj2.
    fn kinds(&self) -> [Kind; 2] {
        [0, KIND].map(|shift| KINDS[(self.curved >> shift & 3) as usize])
    }

    /// What was round of each object.
    #[inline]
    pub fn round(&self) -> [Round; 2] {
        let [one, two] = self.kinds();
        let [a, b, c, d, e, f] = self.curvature;
        let [p, q] = if self.count < 2 {
            let [p, q, _] = self.slopes;
            [self.curvature, [p.x, p.y, p.z, q.x, q.y, q.z]]
        } else {
            [[a, b, c, 0.0, 0.0, 0.0], [d, e, f, 0.0, 0.0, 0.0]]
        };
        [(one, p), (two, q)]
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

    /// How far aside the directions of [`Memory::recall`] are, radians.
    fn angle(&self) -> f64 {
        // Farther aside than the pair moved, and not as far where R or balls alone are known, which
        // serve the better the nearer the samples are (in double precision); a disc's axis is told
        // by samples that are not as near. NaN becomes the least angle. Measured in motion: ×2, ÷2
        // of the factors up to 12 % and 4 % of one set, of the least angles 5 % and 2 %; the same
        // two numbers for both 10 to 23 %.
        let alone = self.curved != 0 && !self.kinds().contains(&Kind::Disc);
        let (times, least) = if alone && EPSILON < 1e-10 {
            (2.0, 0.0005)
        } else {
            (5.0, 0.004)
        };
        let drift = times * self.drift;
        if drift > least {
            drift.min(ASIDE)
        } else {
            least
        }
    }

    /// The directions to ask first, around the remembered unit vector `dir`: for each remembered cut
    /// where it is above the others by as much as it can; or two that show both ends of two edges,
    /// in the middle between their ways and opposite.
    #[inline]
    pub fn recall(&self, dir: &Vec3) -> [Option<Vec3>; 3] {
        let angle = self.angle();
        let [a, b, c] = self.slopes;
        // Across the line on which the other two are equal, and, since a face may have a
        // fourth vertex there, towards the vertex itself.
        let corner = |g: Vec3, h: Vec3, k: Vec3| {
            let across = dir.cross(&(k - h));
            let way = across * (1.0 as f64).copysign(across.dot(&(g - h)));
            way + g * (across.norm() / g.norm())
        };
        let aside = |way: Vec3, far: f64| {
            let way = normalised(&way)?;
            normalised(&(dir + way * (far * angle)))
        };
        match self.count {
            2 => [aside(b - a, 1.0), aside(a - b, 1.0), None],
            3 => [(c, a, b), (b, c, a), (a, b, c)].map(|(g, h, k)| aside(corner(g, h, k), 1.0)),
            EDGES => {
                let (e, f) = (b - a, c - a);
                let way = e + f * (e.norm() / f.norm()).copysign(e.dot(&f));
                [aside(way, WIDER), aside(way, OPPOSITE * WIDER), None]
            }
            _ => [None; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::object::Object;
    use super::*;
    use crate::shapes::Random;

    /// Directions to ask are as far aside as said, each where its cut is above the others.
    #[test]
    fn each_remembered_cut_is_asked_where_it_is_highest() {
        let mut r = Random::new(9);
        for _ in 0..1000 {
            let dir = r.direction();
            let (e1, e2) = crate::math::basis(&dir);
            // Three slopes around the origin.
            let turn = r.within(0.0, 6.0);
            let slopes = [0.0, 2.1, 4.2].map(|at: f64| {
                let (s, c) = (at + turn + r.within(-0.4, 0.4)).sin_cos();
                (e1 * c + e2 * s) * r.within(0.5, 1.0)
            });
            let mut memory = Memory::default();
            memory.keep(&dir, &slopes, 3, &[NOTHING; 2]);
            let dirs = memory.recall(&dir);
            // Last one first.
            for (i, n) in [2, 1, 0].into_iter().zip(dirs) {
                let n = n.unwrap();
                assert!((n.norm() - 1.0).abs() < 4.0 * EPSILON);
                let tangent = n - dir * dir.dot(&n);
                assert!((tangent.norm() - 0.004).abs() < 1e-4);
                let slope = |k: usize| memory.slopes[k % 3].dot(&tangent);
                assert!(slope(i) > slope(i + 1) && slope(i) > slope(i + 2));
            }
        }
    }

    const NOTHING: Round = (Kind::None, [0.0; FEW]);
    const BALL: Round = (Kind::Ball, [0.25, 0.0, 0.0, 0.0, 0.0, 0.0]);
    const DISC: Round = (Kind::Disc, [0.0, 0.3, 0.4, 0.0, 0.0, 0.0]);
    const R: Round = (Kind::Curved, [0.5, 0.1, 0.0, 0.4, -0.1, 0.3]);
    const S: Round = (Kind::Curved, [0.25, 0.0, 0.1, 0.2, 0.0, 0.7]);

    fn kept(count: usize, round: &[Round; 2]) -> Memory {
        let mut memory = Memory::default();
        memory.keep(&Vec3::z(), &[Vec3::x(); 3], count, round);
        memory
    }

    /// What is round changes sides with the objects, and the slopes their signs.
    #[test]
    fn round_parts_change_sides_with_the_objects() {
        let all = [NOTHING, BALL, DISC, R, S];
        for one in all {
            for two in all {
                let mut memory = kept(1, &[one, two]);
                assert_eq!(memory.round(), [one, two]);
                memory.flip();
                assert_eq!(memory.round(), [two, one]);
                assert_eq!((memory.dir, memory.count), (-Vec3::z(), 0));
            }
        }
        let mut memory = kept(2, &[DISC, BALL]);
        memory.flip();
        assert_eq!(memory.round(), [BALL, DISC]);
        assert_eq!((memory.dir, memory.slopes[1]), (-Vec3::z(), -Vec3::x()));
    }

    /// Several cuts need the room that R would take.
    #[test]
    fn several_cuts_leave_room_for_no_matrix() {
        for (round, rest) in [([R, S], [NOTHING; 2]), ([R, BALL], [NOTHING, BALL])] {
            let kinds = kept(2, &round).round().map(|(kind, _)| kind);
            assert_eq!(kinds, rest.map(|(kind, _)| kind));
        }
        assert_eq!(kept(2, &[DISC, BALL]).round(), [DISC, BALL]);
    }

    #[test]
    fn what_makes_no_sense_is_not_recalled() {
        for (place, lost) in [(0, 0), (2, 0), (3, 1)] {
            let mut memory = kept(2, &[DISC, BALL]);
            memory.curvature[place] = f64::NAN;
            let kinds = memory.round().map(|round| {
                let mut object = Object::default();
                object.recall(&round);
                object.kind
            });
            assert!(kinds[lost] == Kind::None && kinds[1 - lost] != Kind::None);
        }
        // An axis of no length is no disc's.
        let mut object = Object::default();
        object.recall(&(Kind::Disc, [0.0; FEW]));
        assert!(!object.is_round());
        let memory = Memory {
            dir: Vec3::z(),
            slopes: [Vec3::repeat(f64::NAN), Vec3::zeros(), Vec3::z()],
            curvature: [f64::INFINITY, 1.0, f64::NAN, 0.0, 0.0, 0.0],
            drift: f64::NAN,
            count: 77,
            curved: u32::MAX,
        };
        assert!(memory.recall(&Vec3::z()) == [None; 3]);
        let face = Memory {
            count: 3,
            curved: 0,
            ..memory
        };
        assert!(face.face(1e-6).is_none() && face.recall(&Vec3::z())[0].is_none());
        for round in memory.round() {
            object.recall(&round);
            assert!(!object.is_round());
        }
    }
}
