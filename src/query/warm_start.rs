// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What one query of a pair leaves for the next (W. Gao, Sec. III-D): one direction, its depth, the radii
//! of sphere fits, and a kind. A random, stale or foreign one costs time; it proves nothing.

use crate::math::{Vec3, ZERO, unit};

/// How the last query ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WarmKind {
    /// Nothing is known.
    #[default]
    Cold,
    /// The pair was apart: the direction is a separating axis.
    Apart,
    /// The pair overlapped: the direction is that of the least support value.
    Plain,
    /// The pair overlapped, and D is round there: the vertex of the direction is a poor corner of a portal.
    Round,
}

/// The warm state of a pair.
#[derive(Clone, Copy, Debug)]
pub struct WarmStart {
    /// Unit.
    pub dir: Vec3,
    /// The depth, metres; 0 where the pair was apart.
    pub depth: f64,
    /// The radii of obj1 and obj2 where a prediction of the sphere fits came true, metres; else 0.
    pub radius: [f64; 2],
    /// How the last query ended.
    pub kind: WarmKind,
}

impl WarmStart {
    /// Nothing is known.
    pub const COLD: Self = Self {
        dir: ZERO,
        depth: 0.0,
        radius: [0.0; 2],
        kind: WarmKind::Cold,
    };

    /// Starts from a guess of the direction in which obj2 leaves; cold where it is zero or not finite.
    pub fn guess(dir: &Vec3) -> Self {
        unit(dir).map_or(Self::COLD, |dir| Self {
            dir,
            kind: WarmKind::Plain,
            ..Self::COLD
        })
    }

    /// Makes the state of the pair (obj1, obj2) that of (obj2, obj1).
    pub fn flip(&mut self) {
        self.dir = -self.dir;
        self.radius.swap(0, 1);
    }
}
