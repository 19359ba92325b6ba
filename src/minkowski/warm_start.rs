// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The warm start state of a pair, from one query to the next (W. Gao, Sec. III-D). A random, stale or foreign
//! state costs time, but no proof depends on it.
//!
//! | [`WarmKind`] | `dir` | `depth` | `radius` |
//! |---|---|---|---|
//! | `Cold` | zero | 0 | 0 |
//! | `Separated` | the separating axis ([`crate::minkowski::separating_axis`]) | 0 | sphere radii or 0 |
//! | `Overlap` | the direction of the upper bound, or a guess | the depth; 0 for a guess | sphere radii or 0 |
//!
//! A radius is 0 unless the sphere fits were confirmed.

use crate::math::{EPSILON, Vec3, ZERO, unit};
use crate::minkowski::support_query::Stop;
use crate::types::{Direction, Solution};

/// Result of the last query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WarmKind {
    /// Nothing is known.
    #[default]
    Cold,
    /// The objects were separated: the direction is a separating axis.
    Separated,
    /// The objects overlapped: the direction is that of the upper bound, or a guess.
    Overlap,
}

/// The warm start state of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct WarmStart {
    /// Direction of the last result; zero in a cold state.
    pub dir: Direction,
    /// The depth, metres; 0 for `Separated`.
    pub depth: f64,
    /// Radii of the sphere fits of obj1 and obj2, metres; 0 unless a prediction was confirmed.
    pub radius: [f64; 2],
    /// Result of the last query.
    pub kind: WarmKind,
}

/// The largest error of the squared length of a unit vector. Measured on 50 million vectors that were normalised:
/// 4 ulps.
const MAX_UNIT_ERROR: f64 = 4.0 * EPSILON;

impl WarmStart {
    /// Number of reals in a packed state.
    pub const REALS: usize = 6;
    /// Number of words in a packed state.
    pub const WORDS: usize = 2;

    /// The state of a pair without an earlier query.
    pub const COLD: Self = Self {
        dir: Direction::exact(ZERO),
        depth: 0.0,
        radius: [0.0; 2],
        kind: WarmKind::Cold,
    };

    /// Makes the state of an overlap with this penetration direction.
    pub fn towards(dir: Direction) -> Self {
        Self {
            dir,
            kind: WarmKind::Overlap,
            ..Self::COLD
        }
    }

    /// Makes a state from a guess of the penetration direction, of any length; cold if that is zero or not
    /// finite. The guess is tilted here, so that a query which is repeated from it does not turn.
    pub fn guess(dir: &Vec3) -> Self {
        unit(dir).map_or(Self::COLD, |n| Self::towards(Direction::exact(n).general()))
    }

    /// Makes the state of a pair that `dir` separates. `radius`: the radii of the sphere fits, metres.
    pub fn separated(dir: Direction, radius: [f64; 2]) -> Self {
        Self {
            dir,
            depth: 0.0,
            radius,
            kind: WarmKind::Separated,
        }
    }

    /// Makes this the state of separated objects if a query found them separated. (The query itself stores an overlap.)
    #[inline(always)]
    pub fn note_separation<R>(&mut self, found: &Result<R, Stop>) {
        if let Err(Stop::Separated(axis)) = found {
            *self = Self::separated(*axis, self.radius);
        }
    }

    /// Makes the state of a hit.
    pub fn hit(found: &Solution) -> Self {
        Self {
            dir: found.direction(),
            depth: found.depth,
            radius: found.radius,
            kind: WarmKind::Overlap,
        }
    }

    /// Returns whether the objects overlapped.
    pub fn is_overlap(&self) -> bool {
        self.kind == WarmKind::Overlap
    }

    /// Returns the separating axis; `None` if the objects were not separated.
    pub fn separating_axis(&self) -> Option<Direction> {
        (self.kind == WarmKind::Separated).then_some(self.dir)
    }

    /// Converts the state of the pair (obj1, obj2) to one of (obj2, obj1). A cold state is unchanged.
    pub fn flip(&mut self) {
        if self.kind != WarmKind::Cold {
            self.dir.n = -self.dir.n;
            self.radius.swap(0, 1);
        }
    }

    /// Packs the state into plain numbers. A cold state is all zeros.
    pub fn pack(&self) -> ([f64; Self::REALS], [u32; Self::WORDS]) {
        let [x, y, z] = self.dir.n.into();
        let [radius1, radius2] = self.radius;
        let kind = match self.kind {
            WarmKind::Cold => 0,
            WarmKind::Separated => 1,
            WarmKind::Overlap => 2,
        };
        let reals = [x, y, z, self.depth, radius1, radius2];
        (reals, [kind, self.dir.is_general().into()])
    }

    /// Unpacks a state; returns a cold one unless the kind is known, the direction unit, and the lengths such that
    /// solvers can multiply four of them. (Support points that are too large for this are a
    /// [`Fault`](crate::minkowski::support::Fault::NonFinite), so only bodies of more than 1e72 m have larger radii.)
    pub fn unpack(reals: [f64; Self::REALS], words: [u32; Self::WORDS]) -> Self {
        let [x, y, z, depth, radius1, radius2] = reals;
        let dir = Vec3::new(x, y, z);
        let [kind, general] = words;
        let kind = match kind {
            1 => WarmKind::Separated,
            2 => WarmKind::Overlap,
            _ => WarmKind::Cold,
        };
        let is_unit = (dir.norm_squared() - 1.0).abs() <= MAX_UNIT_ERROR;
        let is_positive = depth >= 0.0 && radius1 >= 0.0 && radius2 >= 0.0;
        let is_bounded = (depth + radius1 + radius2).powi(4) < f64::INFINITY;
        if kind == WarmKind::Cold || !(is_unit && is_positive && is_bounded) {
            return Self::COLD;
        }
        Self {
            dir: Direction::remembered(dir, general == 1),
            depth,
            radius: [radius1, radius2],
            kind,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_and_unpacking_preserves_a_state() {
        let state = WarmStart::hit(&Solution {
            normal: Vec3::new(0.6, 0.0, -0.8),
            is_general: true,
            depth: 0.25,
            radius: [1.0, 0.5],
            ..Solution::default()
        });
        let (reals, words) = state.pack();
        let again = WarmStart::unpack(reals, words);
        assert_eq!((again.pack(), again.kind), (state.pack(), state.kind));
        let mut flipped = again;
        flipped.flip();
        assert_eq!((flipped.dir.n, flipped.radius), (-state.dir.n, [0.5, 1.0]));
        flipped.flip();
        assert_eq!(flipped.pack(), state.pack());
    }

    #[test]
    fn invalid_numbers_give_a_cold_state() {
        let good = [1.0, 0.0, 0.0, 0.1, 0.0, 0.0];
        let kind = |reals, kind| WarmStart::unpack(reals, [kind, 1]).kind;
        assert_eq!(kind(good, 2), WarmKind::Overlap);
        assert_eq!(kind(good, 3), WarmKind::Cold);
        assert_eq!(kind([0.0; 6], 0), WarmKind::Cold);
        for (i, x) in [
            (0, 2.0),
            (0, f64::NAN),
            (3, -1.0),
            (3, 1e78),
            (4, f64::INFINITY),
            (4, 1e155),
            (5, f64::NAN),
        ] {
            let mut bad = good;
            bad[i] = x;
            assert_eq!(kind(bad, 2), WarmKind::Cold);
        }
    }
}
