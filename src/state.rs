// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What one query of a pair leaves behind for the next (paper, Sec. III-D).
//!
//! Nothing in a state is trusted: it chooses where to look first, never what is true.
//!
//! What it holds depends on the query that left it:
//!
//! | kind | left by | `dir` | `slopes` | `numbers` and `count` |
//! |---|---|---|---|---|
//! | cold: 0, or no other | | | | |
//! | `APART` | every query of a pair that is apart | the separating direction | | the radii of two spheres |
//! | `OVERLAP` | a guess, yes or no, the paper's method, the plane | the way obj2 leaves | | |
//! | `ALONG` | a query along a direction | the support plane's normal | the last portal's directions | |
//! | `PROVEN` | the global and the local query | the minimum's | | its [`WarmStart`] |
//!
//! A direction that is zero stands for none. What a query for the depth of an overlap leaves
//! behind also tells how the centres lay, where they are given ([`State::face`]).

use crate::gjk::separating_axis::SeparatingAxis;
use crate::math::{Vec3, as_unit, normalised, unit};
use crate::query::warm_start::{WarmKind, WarmStart};

/// The bits of [`State::marks`] for a coordinate of the direction of the centres' difference.
const COORDINATE: u32 = 10;
/// What a coordinate is greater by there: none is 0, and all bits 0 are no direction.
const OFFSET: u32 = 1 << (COORDINATE - 1);
/// Lengths in it are this many times as long.
const SCALE: f64 = (OFFSET - 1) as f64;

/// What a query leaves behind. All zero is cold; any other bits are harmless.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct State {
    /// See the table at the head of this file.
    dir: Vec3,
    slopes: [Vec3; 3],
    numbers: [f64; 6],
    /// Not in use.
    spare: f64,
    count: u32,
    /// Not in use.
    spare_word: u32,
    /// One of the constants below; anything else is cold.
    pub kind: u32,
    /// The direction of the centres' difference.
    marks: u32,
}

/// The pair was apart.
const APART: u32 = 1;
/// The pair overlapped.
const OVERLAP: u32 = 2;
/// The pair overlapped, and was asked about along a direction.
const ALONG: u32 = 3;
/// The pair overlapped, and its minimum was proven.
const PROVEN: u32 = 4;

impl State {
    /// A fresh state that starts from `dir`; cold when it is zero or not finite.
    pub fn guess(dir: &Vec3) -> Self {
        match unit(dir) {
            Some(n) => Self::towards(n),
            None => Self::default(),
        }
    }

    /// The pair overlaps, and obj2 leaves along this unit direction.
    pub fn towards(n: Vec3) -> Self {
        Self::of(OVERLAP, n)
    }

    /// The state of a pair becomes that of the same objects in the other order, whose D is
    /// this one's mirror image in the origin: points, directions and slopes change sign,
    /// lengths and curvatures stay, and the balls of the objects change places.
    pub fn flip(&mut self) {
        if self.kind == PROVEN {
            let (mut warm, facing) = (self.warm_start(), self.facing());
            warm.flip();
            self.store(&warm);
            if let Some(centre) = facing {
                self.face(&-centre);
            }
            return;
        }
        if self.kind == 0 {
            return;
        }
        self.dir = -self.dir;
        self.slopes = self.slopes.map(|n| -n);
        self.numbers.swap(1, 2);
        if let Some(centre) = self.facing() {
            self.face(&-centre);
        }
    }

    /// Keeps the direction of the centres' difference, obj1's less obj2's.
    pub fn face(&mut self, centre: &Vec3) {
        self.marks = 0;
        if let Some(n) = normalised(centre) {
            for (i, x) in (0..).zip(n.iter()) {
                // To the nearest whole number.
                let x = (x * SCALE + (OFFSET as f64 + 0.5)) as u32;
                self.marks |= x << (i * COORDINATE);
            }
        }
    }

    /// What [`State::face`] was given, about, unit length; `None` where it was not.
    pub fn facing(&self) -> Option<Vec3> {
        let coordinate = |i: u32| {
            let x = self.marks >> (i * COORDINATE) & (2 * OFFSET - 1);
            (x as i32 - OFFSET as i32) as f64 / SCALE
        };
        let given = self.marks != 0;
        given.then(|| Vec3::new(coordinate(0), coordinate(1), coordinate(2)))
    }

    fn of(kind: u32, dir: Vec3) -> Self {
        Self {
            dir,
            kind,
            ..Self::default()
        }
    }

    /// The pair is apart: what the next query asks first, and the radii of the objects' spheres, metres.
    pub fn apart(axis: &SeparatingAxis, radius: [f64; 2]) -> Self {
        let mut state = Self::of(APART, axis.dir);
        let [aim, radius1, radius2, ..] = &mut state.numbers;
        (*aim, [*radius1, *radius2]) = (axis.aim, radius);
        state
    }

    /// The radii of [`State::apart`].
    pub fn radius(&self) -> [f64; 2] {
        match self.kind {
            APART => [self.numbers[1], self.numbers[2]],
            _ => [0.0; 2],
        }
    }

    /// Did the pair overlap when its depth was asked?
    pub fn overlapped(&self) -> bool {
        matches!(self.kind, OVERLAP | ALONG | PROVEN)
    }

    /// Was the pair apart?
    pub fn was_apart(&self) -> bool {
        self.kind == APART
    }

    /// The axis that separated the pair.
    pub fn separating(&self) -> Option<SeparatingAxis> {
        let aim = self.numbers[0];
        match self.kind {
            APART => Some(SeparatingAxis {
                dir: unit(&self.dir)?,
                aim: if aim > 0.0 && aim < f64::INFINITY {
                    aim
                } else {
                    0.0
                },
            }),
            _ => None,
        }
    }

    /// The direction in which obj2 left last time, or is guessed to leave. A pair that
    /// was apart and is no longer has just met there.
    pub fn leaving(&self) -> Option<Vec3> {
        match self.kind {
            APART | OVERLAP | ALONG | PROVEN => as_unit(&self.dir),
            _ => None,
        }
    }

    /// The directions of the last portal.
    pub fn portal(&self) -> Option<[Vec3; 3]> {
        let [a, b, c] = &self.slopes;
        match self.kind {
            ALONG => Some([unit(a)?, unit(b)?, unit(c)?]),
            _ => None,
        }
    }

    /// Keeps the directions of a portal besides.
    pub fn keep_portal(&mut self, directions: [Vec3; 3]) {
        self.kind = ALONG;
        self.slopes = directions;
    }

    /// Returns what the global query starts from.
    pub fn warm_start(&self) -> WarmStart {
        let [depth, radius1, radius2, ..] = self.numbers;
        let off = (self.dir.norm_squared() - 1.0).abs();
        match self.kind {
            PROVEN if off <= 16.0 * crate::math::EPSILON => WarmStart {
                dir: self.dir,
                depth,
                radius: [radius1, radius2],
                kind: if self.count == 1 {
                    WarmKind::Round
                } else {
                    WarmKind::Plain
                },
            },
            APART => match WarmStart::guess(&self.dir) {
                guess if guess.kind == WarmKind::Plain => WarmStart {
                    kind: WarmKind::Apart,
                    ..guess
                },
                cold => cold,
            },
            OVERLAP | ALONG => WarmStart::guess(&self.dir),
            _ => WarmStart::COLD,
        }
    }

    /// Keeps what the global query left.
    pub fn store(&mut self, warm: &WarmStart) {
        *self = match warm.kind {
            WarmKind::Cold => Self::default(),
            WarmKind::Apart => {
                let axis = SeparatingAxis {
                    dir: warm.dir,
                    aim: warm.depth,
                };
                Self::apart(&axis, warm.radius)
            }
            _ => Self::of(PROVEN, warm.dir),
        };
        if self.kind == PROVEN {
            let [depth, radius1, radius2, ..] = &mut self.numbers;
            [*depth, *radius1, *radius2] = [warm.depth, warm.radius[0], warm.radius[1]];
            self.count = u32::from(warm.kind == WarmKind::Round);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    #[test]
    fn flipped_twice_is_as_it_was() {
        let mut cold = State::default();
        cold.flip();
        assert!(cold.dir.iter().all(|x| x.is_sign_positive()) && cold.kind == 0);
        let mut state = State::guess(&Vec3::new(1.0, -2.0, 3.0));
        let dir = state.dir;
        state.flip();
        assert_eq!(state.dir, -dir);
        state.flip();
        assert_eq!(state.dir, dir);
    }

    #[test]
    fn where_the_other_object_lay_is_kept() {
        let mut r = Random::new(3);
        let mut state = State::guess(&Vec3::y());
        assert!(state.facing().is_none());
        for _ in 0..1000 {
            let n = r.direction();
            state.face(&(n * 0.001));
            assert!((state.facing().unwrap() - n).norm() < 0.004);
            state.flip();
            assert!((state.facing().unwrap() + n).norm() < 0.007);
        }
        state.face(&Vec3::zeros());
        assert!(state.facing().is_none() && state.marks == 0);
    }
}
