// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What one query of a pair leaves for the next (W. Gao, Sec. III-D): one direction, its depth, the radii
//! of sphere fits, and a kind. A random, stale or foreign state costs time; it proves nothing.

use crate::gjk::separating_axis::SeparatingAxis;
use crate::math::{EPSILON, Vec3, ZERO, unit};

/// How the last query ended.
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
    /// How the last query ended.
    pub kind: WarmKind,
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

    /// Makes the state of a pair that is apart. `radius`: of the objects' spheres, metres.
    pub fn apart(axis: &SeparatingAxis, radius: [f64; 2]) -> Self {
        Self {
            dir: axis.dir,
            depth: axis.aim,
            radius,
            kind: WarmKind::Apart,
        }
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
        }
    }

    /// Packs the state into plain numbers. All zero is cold.
    pub fn pack(&self) -> ([f64; Self::REALS], u32) {
        let [x, y, z] = self.dir.into();
        let [radius1, radius2] = self.radius;
        let kind = match self.kind {
            WarmKind::Cold => 0,
            WarmKind::Apart => 1,
            WarmKind::Plain => 2,
            WarmKind::Round => 3,
        };
        ([x, y, z, self.depth, radius1, radius2], kind)
    }

    /// Unpacks a state; what [`WarmStart::pack`] did not make, and a direction that is not unit, is cold.
    pub fn unpack([x, y, z, depth, radius1, radius2]: [f64; Self::REALS], kind: u32) -> Self {
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
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_packed_is_the_same_unpacked() {
        for kind in [WarmKind::Apart, WarmKind::Plain, WarmKind::Round] {
            let state = WarmStart {
                dir: Vec3::new(0.6, 0.0, -0.8),
                depth: 0.25,
                radius: [1.0, 0.5],
                kind,
            };
            let (reals, packed) = state.pack();
            let again = WarmStart::unpack(reals, packed);
            assert_eq!((again.pack(), again.kind), (state.pack(), kind));
            let mut flipped = again;
            flipped.flip();
            assert_eq!((flipped.dir, flipped.radius), (-state.dir, [0.5, 1.0]));
            flipped.flip();
            assert_eq!(flipped.pack(), state.pack());
        }
    }

    #[test]
    fn foreign_numbers_are_cold() {
        let good = [1.0, 0.0, 0.0, 0.1, 0.0, 0.0];
        assert_eq!(WarmStart::unpack(good, 2).kind, WarmKind::Plain);
        assert_eq!(WarmStart::unpack(good, 4).kind, WarmKind::Cold);
        assert_eq!(WarmStart::unpack([0.0; 6], 0).kind, WarmKind::Cold);
        for (i, x) in [
            (0, 2.0),
            (0, f64::NAN),
            (3, -1.0),
            (4, f64::INFINITY),
            (5, f64::NAN),
        ] {
            let mut bad = good;
            bad[i] = x;
            assert_eq!(WarmStart::unpack(bad, 2).kind, WarmKind::Cold);
        }
    }
}
