// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! R, the second derivative of one object's support function, where that is smooth and no ball's or
//! disc's: learned from pairs of its points.
//!
//! On one smooth piece two points satisfy p′ − p = R (n′ − n) to second order. A pair that R does not
//! foretell corrects it: by the symmetric rank-one formula, and where that has no say, because what
//! is missing lies across n′ − n, by Powell's symmetric Broyden formula (both in Nocedal and
//! Wright, Numerical Optimization, ch. 6). What it was off by is the error of R.

use crate::known::round::{BLUNT, Symmetric};
use crate::math::{Vec3, ZERO};

/// Relative error of R up to which the first pair that confirms a remembered R confirms all of it.
/// Insensitive: 0.1 to 0.4, within 0.1 %.
const FORETOLD: f64 = 0.2;
/// Relative error up to which R moves cuts; also that of a remembered R, until a pair tells.
/// Measured: ×2 +1.2 %, +19 % (hulls); ÷2 +0.2 %, +6 %.
const BELIEVED: f64 = 0.5;
/// Squared sine of the angle from which on two pairs measure R in two directions. Measured: ×2
/// +0.1 %, +1.2 %; ÷2 no change.
const SPREAD: f64 = 0.04;
/// Squared cosine of the angle between what a pair corrects and its direction from which on the
/// symmetric rank-one formula has a say. Measured: ×2, ÷2 no change, +1.6 %; 0 +4.3 %, +28 %.
const ALONG: f64 = 0.0025;

/// R of one object, and what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Curved {
    r: Symmetric,
    /// Relative error, by the last pair; 1 where one alone has told, meaningless where R is not there.
    error: f64,
    /// The direction of the first pair; zero where R is remembered, until one has told.
    line: Vec3,
    /// Measured along a second direction too.
    pub spread: bool,
}

impl Curved {
    pub const NONE: Self = Self {
        r: Symmetric([0.0; 6]),
        error: 0.0,
        line: ZERO,
        spread: false,
    };

    /// R as an earlier search knew it, or as a ball or disc that was refuted has it: enough to look
    /// by, not to believe.
    pub fn recall(r: Symmetric) -> Self {
        Self {
            r,
            error: BELIEVED,
            ..Self::NONE
        }
    }

    /// Does it move cuts?
    #[inline(always)]
    pub fn is_believed(&self) -> bool {
        self.error <= BELIEVED
    }

    pub fn r(&self) -> &Symmetric {
        &self.r
    }

    /// How large an object is at least that has it, metres.
    pub fn size(&self) -> f64 {
        self.r.0.iter().map(|entry| entry.abs()).sum::<f64>() / BLUNT
    }

    /// Of the first smooth pair: a point moved by `d` where its direction turned by `dn`.
    pub fn first(d: &Vec3, dn: &Vec3) -> Self {
        Self {
            r: Symmetric::first(d, dn),
            error: 1.0,
            line: *dn,
            ..Self::NONE
        }
    }

    /// Learns from another smooth pair.
    pub fn learn(&mut self, d: &Vec3, dn: &Vec3) {
        let w = d - self.r.times(dn);
        let dn2 = dn.norm_squared();
        self.error = (w.norm_squared() / d.norm_squared()).sqrt();
        let line2 = self.line.norm_squared();
        if line2 > 0.0 {
            self.spread |= self.line.cross(dn).norm_squared() > SPREAD * dn2 * line2;
        } else {
            self.line = *dn;
            self.spread |= self.error < FORETOLD;
        }
        let along = w.dot(dn);
        if along * along > ALONG * w.norm_squared() * dn2 {
            self.r.add_square(1.0 / along, &w);
        } else {
            // Across: the least symmetric change.
            self.r.add_least(&w, dn);
        }
    }

    /// A kink along `dn` leaves R no more than this `room`. What no second pair confirmed ends: `false`.
    pub fn refute(&mut self, dn: &Vec3, room: f64) -> bool {
        if !(self.r.times(dn).dot(dn) > room) {
            return true;
        }
        self.r.reduce(dn, room);
        self.is_believed()
    }

    /// What it was taken for ended at unit `n`, with a point that lies `aside`: what confirmed it lies
    /// on the other side, and that way R is to be seen again.
    pub fn end(&mut self, n: &Vec3, aside: &Vec3) {
        if self.spread {
            (self.line, self.spread) = (n.cross(aside), false);
        }
    }

    /// Across the one direction in which R was measured, and unit `n`.
    pub fn across(&self, n: &Vec3) -> Option<Vec3> {
        (!self.spread).then(|| self.line.cross(n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::round::Seen;
    use crate::math::{EPSILON, perpendicular};
    use crate::shapes::{Random, ellipsoid};

    /// R of an ellipsoid from a handful of pairs around one direction: it foretells the next one, and
    /// to second order it is |S n|'s second derivative, S the half axes.
    #[test]
    fn it_is_learned_from_pairs() {
        let mut r = Random::new(4);
        let step = if EPSILON > 1e-10 { 0.02 } else { 0.01 };
        for _ in 0..100 {
            let radii = Vec3::from_fn(|_, _| r.within(0.3, 0.6));
            let shape = ellipsoid(radii, r.rotation(), r.vector(0.1));
            let ask = |n: Vec3| {
                let n = n.normalize();
                Seen { n, p: shape(&n) }
            };
            let n = r.direction();
            let t = perpendicular(&n);
            let u = n.cross(&t);
            let at = ask(n);
            let first = ask(n + t * step);
            let mut curved = Curved::first(&(first.p - at.p), &(first.n - at.n));
            for way in [u, t + u, t, u, t - u] {
                let to = ask(n + way * step);
                curved.learn(&(to.p - at.p), &(to.n - at.n));
            }
            assert!(curved.is_believed() && curved.spread);
            assert!(curved.across(&n).is_none());
            let to = ask(n + (t * 0.6 - u * 0.3) * step);
            let (d, dn) = (to.p - at.p, to.n - at.n);
            assert!((d - curved.r().times(&dn)).norm() < 0.05 * d.norm());
        }
    }

    /// A kink leaves it no more than there is room; what no second pair confirmed ends there, and at a
    /// vertex.
    #[test]
    fn a_kink_refutes_it() {
        let dn = Vec3::x() * 0.1;
        let mut curved = Curved::recall(Symmetric::scaled_identity(1.0));
        assert!(curved.refute(&dn, 0.0025));
        assert!((curved.r().times(&dn).dot(&dn) - 0.0025).abs() < 8.0 * EPSILON);
        assert!((curved.r().times(&Vec3::y()) - Vec3::y()).norm() < 8.0 * EPSILON);
        let mut once = Curved::first(&dn, &dn);
        assert!(!once.is_believed() && once.across(&Vec3::z()).is_some());
        assert!(!once.refute(&dn, 0.0025));
    }
}
