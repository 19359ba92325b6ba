// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The warm state of a pair, from one query to the next (W. Gao, Sec. III-D): one direction, its depth, the
//! radii of sphere fits, and a kind; and, rounded, the direction between the centers, which shows a state of the
//! swapped pair. A random, stale or foreign state costs time; it proves nothing.

use crate::gjk::separating_axis::SeparatingAxis;
use crate::math::{EPSILON, Vec3, ZERO, unit};

/// Result of the last query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WarmKind {
    /// Nothing is known.
    #[default]
    Cold,
    /// The pair was apart: the direction is a separating axis.
    Apart,
    /// The pair overlapped: the direction is that of the least support value, or a guess.
    Plain,
    /// The pair overlapped, and D is round there: the vertex of the direction is a poor corner of a portal.
    Round,
}

/// The warm state of a pair.
#[derive(Clone, Copy, Debug)]
pub struct WarmStart {
    /// Unit.
    pub dir: Vec3,
    /// The depth, metres; of a pair that was apart the margin that the axis is to separate it by.
    pub depth: f64,
    /// The radii of obj1 and obj2 where a prediction of the sphere fits came true, metres; else 0.
    pub radius: [f64; 2],
    /// Result of the last query.
    pub kind: WarmKind,
    /// The direction of the difference of the centers, packed; 0 where they are not given.
    facing: u32,
}

/// The bits of a packed coordinate, and what 0 is packed as.
const COORDINATE_BITS: u32 = 10;
const COORDINATE_ZERO: u32 = 1 << (COORDINATE_BITS - 1);

/// Packs the direction of a vector into 30 bits; 0 for a vector without one.
fn pack_direction(v: &Vec3) -> u32 {
    let Some(n) = unit(v) else { return 0 };
    let scale = f64::from(COORDINATE_ZERO - 1);
    (0..3).fold(0, |packed, i| {
        // Rounded to the closest integer.
        let x = (n[i] * scale + f64::from(COORDINATE_ZERO) + 0.5) as u32;
        packed | x << (COORDINATE_BITS * i as u32)
    })
}

/// Unpacks a direction; not quite unit.
fn unpack_direction(packed: u32) -> Vec3 {
    let coordinate = |i: u32| {
        let x = packed >> (COORDINATE_BITS * i) & (2 * COORDINATE_ZERO - 1);
        f64::from(x) - f64::from(COORDINATE_ZERO)
    };
    Vec3::new(coordinate(0), coordinate(1), coordinate(2))
}

impl Default for WarmStart {
    fn default() -> Self {
        Self::COLD
    }
}

impl WarmStart {
    /// The numbers of a packed state.
    pub const REALS: usize = 6;

    /// Nothing is known.
    pub const COLD: Self = Self {
        dir: ZERO,
        depth: 0.0,
        radius: [0.0; 2],
        kind: WarmKind::Cold,
        facing: 0,
    };

    /// Makes the state of a pair that overlaps, and whose obj2 leaves along a unit direction.
    pub fn towards(dir: Vec3) -> Self {
        Self {
            dir,
            kind: WarmKind::Plain,
            ..Self::COLD
        }
    }

    /// Makes a state that starts from a guess of the direction in which obj2 leaves; cold where it is zero or
    /// not finite.
    pub fn guess(dir: &Vec3) -> Self {
        unit(dir).map_or(Self::COLD, Self::towards)
    }

    /// Makes the state of a pair that unit `dir` separates. `aim`: the margin that the axis is to separate it by,
    /// metres. `radius`: of the objects' spheres, metres.
    pub fn apart(dir: Vec3, aim: f64, radius: [f64; 2]) -> Self {
        Self {
            dir,
            depth: aim,
            radius,
            kind: WarmKind::Apart,
            facing: 0,
        }
    }

    /// Makes the state of a hit. `is_round`: D is round there.
    pub fn hit(dir: Vec3, depth: f64, radius: [f64; 2], is_round: bool) -> Self {
        Self {
            dir,
            depth,
            radius,
            kind: if is_round {
                WarmKind::Round
            } else {
                WarmKind::Plain
            },
            facing: 0,
        }
    }

    /// Stores the direction of the difference of the centers.
    pub fn set_facing(&mut self, center: &Vec3) {
        self.facing = pack_direction(center);
    }

    /// Returns whether the centers looked the other way when the state was left: it is that of the swapped
    /// pair.
    pub fn is_swapped(&self, center: &Vec3) -> bool {
        self.facing != 0 && unpack_direction(self.facing).dot(center) < 0.0
    }

    /// Returns whether the pair overlapped.
    pub fn is_overlap(&self) -> bool {
        matches!(self.kind, WarmKind::Plain | WarmKind::Round)
    }

    /// Returns the axis that separated the pair.
    pub fn separating_axis(&self) -> Option<SeparatingAxis> {
        (self.kind == WarmKind::Apart).then_some(SeparatingAxis {
            dir: self.dir,
            aim: self.depth,
        })
    }

    /// Returns the direction of the last answer. A pair that was apart and is no longer has just met there.
    pub fn direction(&self) -> Option<Vec3> {
        (self.kind != WarmKind::Cold).then_some(self.dir)
    }

    /// Makes the state of the pair (obj1, obj2) that of (obj2, obj1). Cold stays cold, bit for bit.
    pub fn flip(&mut self) {
        if self.kind != WarmKind::Cold {
            self.dir = -self.dir;
            self.radius.swap(0, 1);
            if self.facing != 0 {
                self.facing = pack_direction(&-unpack_direction(self.facing));
            }
        }
    }

    /// Packs the state into plain numbers. All zero is cold.
    pub fn pack(&self) -> ([f64; Self::REALS], [u32; 2]) {
        let [x, y, z] = self.dir.into();
        let [radius1, radius2] = self.radius;
        let kind = match self.kind {
            WarmKind::Cold => 0,
            WarmKind::Apart => 1,
            WarmKind::Plain => 2,
            WarmKind::Round => 3,
        };
        ([x, y, z, self.depth, radius1, radius2], [kind, self.facing])
    }

    /// Unpacks a state; what [`WarmStart::pack`] did not make, and a direction that is not unit, is cold.
    pub fn unpack(reals: [f64; Self::REALS], [kind, facing]: [u32; 2]) -> Self {
        let [x, y, z, depth, radius1, radius2] = reals;
        let dir = Vec3::new(x, y, z);
        let kind = match kind {
            1 => WarmKind::Apart,
            2 => WarmKind::Plain,
            3 => WarmKind::Round,
            _ => WarmKind::Cold,
        };
        let is_length = |x: f64| (0.0..f64::INFINITY).contains(&x);
        let is_unit = (dir.norm_squared() - 1.0).abs() <= 16.0 * EPSILON;
        if kind == WarmKind::Cold
            || !is_unit
            || ![depth, radius1, radius2]
                .map(is_length)
                .iter()
                .all(|is| *is)
        {
            return Self::COLD;
        }
        Self {
            dir,
            depth,
            radius: [radius1, radius2],
            kind,
            facing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_packed_is_the_same_unpacked() {
        for is_round in [false, true] {
            let mut state = WarmStart::hit(Vec3::new(0.6, 0.0, -0.8), 0.25, [1.0, 0.5], is_round);
            state.set_facing(&Vec3::new(3.0, -1.0, 2.0));
            let (reals, words) = state.pack();
            let again = WarmStart::unpack(reals, words);
            assert_eq!((again.pack(), again.kind), (state.pack(), state.kind));
            let mut flipped = again;
            flipped.flip();
            assert_eq!((flipped.dir, flipped.radius), (-state.dir, [0.5, 1.0]));
            flipped.flip();
            assert_eq!(flipped.pack(), state.pack());
        }
    }

    #[test]
    fn a_state_of_the_swapped_pair_is_noticed() {
        let mut r = crate::shapes::Random::new(3);
        for _ in 0..1000 {
            let n = r.direction();
            let mut state = WarmStart::towards(Vec3::x());
            assert!(!state.is_swapped(&n));
            state.set_facing(&(n * 0.001));
            assert!(!state.is_swapped(&n) && state.is_swapped(&-n));
            state.flip();
            assert!(state.is_swapped(&n) && !state.is_swapped(&-n));
        }
    }

    #[test]
    fn foreign_numbers_are_cold() {
        let good = [1.0, 0.0, 0.0, 0.1, 0.0, 0.0];
        let kind = |reals, kind| WarmStart::unpack(reals, [kind, 0]).kind;
        assert_eq!(kind(good, 2), WarmKind::Plain);
        assert_eq!(kind(good, 4), WarmKind::Cold);
        assert_eq!(kind([0.0; 6], 0), WarmKind::Cold);
        for (i, x) in [
            (0, 2.0),
            (0, f64::NAN),
            (3, -1.0),
            (4, f64::INFINITY),
            (5, f64::NAN),
        ] {
            let mut bad = good;
            bad[i] = x;
            assert_eq!(kind(bad, 2), WarmKind::Cold);
        }
    }
}
