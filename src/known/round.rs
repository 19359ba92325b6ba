// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What is round of one object: how its support point moves while it stays on one piece.
//!
//! From the unit direction n to n′ the support point of an object moves by d. While it stays on
//! one piece of the surface, d tells what that piece is:
//!
//! | piece | d |
//! |---|---|
//! | a vertex | 0 |
//! | a *ball* of radius r around a vertex | r (n′ − n), exactly parallel |
//! | a *disc* of radius r across the unit axis a, around a vertex | r (m′ − m), m = n⊥ / \|n⊥\|, n⊥ = n − (n·a) a |
//! | anything else that is smooth | about R (n′ − n), R symmetric: the second derivative of its support function |
//!
//! A vertex with its ball or disc is exact wherever the support point stays on that piece; R is so
//! to second order. Nothing tells how far a piece goes: the hull of a ball and a tip is a ball on
//! one side, half a disc is a disc on one side. So a round part chooses where to ask, and *proves
//! nothing*; what is told by it holds between the directions that showed it.
//!
//! Source: own derivation. R is learned by Powell's symmetric Broyden formula (Nocedal and Wright,
//! Numerical Optimization, ch. 6).

use crate::math::{EPSILON, Vec3, ZERO, larger};

/// The least angle, radians, between two directions that tell a piece from another. Derived: the
/// difference of two points is known to some ulps of the object's size, so of a ball's move by
/// this angle, r times as long, about five digits are left (in single precision three).
pub const TOLD: f64 = if EPSILON > 1e-10 { 1e-2 } else { 1e-5 };
/// The relative difference up to which lengths of one smooth piece are alike: the two excesses of
/// a pair, a radius and the object's extent. Measured on the pair sets: ×2 +0.1 %, +7 % (hulls);
/// ÷2 +1.1 %, +82 % (ellipsoids in motion).
pub const ALIKE: f64 = 0.03;

/// A support point of one object, and the unit direction it was asked along.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Unit.
    pub n: Vec3,
    /// Metres.
    pub p: Vec3,
}

impl Seen {
    pub const NONE: Self = Self { n: ZERO, p: ZERO };
}

/// How far apart points of an object may be, metres, that are one.
#[derive(Clone, Copy, Debug)]
pub struct Same {
    /// What each coordinate may be off by.
    pub rounding: f64,
    /// Where a ball or disc was taken off: a radius is in error by more than rounding.
    pub round: f64,
    /// The square of the largest distance of D's points from an inner one, m²: how large an object is.
    pub extent2: f64,
}

/// How a point moved, where its direction turned.
pub struct Move {
    pub d: Vec3,
    /// Their squares, and their product.
    pub d2: f64,
    pub dn2: f64,
    pub along: f64,
    /// The direction it turned to.
    n: Vec3,
}

impl Move {
    #[inline(always)]
    pub fn of(old: &Seen, new: &Seen) -> Self {
        let (d, dn) = (new.p - old.p, new.n - old.n);
        Self {
            d,
            d2: d.norm_squared(),
            dn2: dn.norm_squared(),
            along: d.dot(&dn),
            n: new.n,
        }
    }

    /// By how much the old point is behind the new one's support plane, and the new one behind the
    /// old one's.
    #[inline(always)]
    pub fn excess(&self) -> [f64; 2] {
        let ahead = self.d.dot(&self.n);
        [ahead, self.along - ahead]
    }

    /// The radius of the ball, metres, if both points are a ball's around one vertex: exactly parallel.
    #[inline(always)]
    pub fn ball(&self, same: &Same) -> Option<f64> {
        const PARALLEL: f64 = 0.1 * TOLD;
        let aside2 = self.d2 * self.dn2 - self.along * self.along;
        let radius = self.along / self.dn2;
        // From an inner point near its border a ball seems smaller, until its far side is seen.
        (self.dn2 > TOLD * TOLD
            && self.d2 > 4.0 * same.rounding * same.rounding
            && aside2 <= PARALLEL * PARALLEL * self.d2 * self.dn2
            && fits(0.5 * radius, same.extent2))
        .then_some(radius)
    }

    /// Are both points of one smooth piece, as far as they can tell?
    ///
    /// Each exceeds the other's support plane, by e and e′. On one smooth piece the trapezoidal rule
    /// makes these equal, to the third order of the angle; a kink between the directions makes e : e′
    /// whatever it likes. So they must be equal within the relative difference `alike`, the nearer the
    /// farther the point moved; and farther than an object of that size can bend there the point did not
    /// move smoothly.
    #[inline(always)]
    pub fn is_smooth(&self, same: &Same, alike: f64) -> bool {
        let [ahead, behind] = self.excess();
        let limit = alike * (ahead + behind);
        let gap2 = (ahead - behind) * (ahead - behind);
        let (limit2, room2) = (limit * limit, same.extent2 * self.dn2);
        self.dn2 > TOLD * TOLD
            && self.along > same.rounding
            && gap2 <= limit2
            && self.d2 <= BLUNT * BLUNT * room2
            && gap2 * self.d2 <= limit2 * STEEP * STEEP * room2
    }
}

/// A pair whose slope is larger than this share of the object must be more alike. Measured: ×2 no
/// change, +4 %; ÷2 +0.9 %, +82 % (ellipsoids in motion).
const STEEP: f64 = 0.7;
/// A slope larger than so many times the object is a kink's, and a remembered R another object's.
/// Measured: ×2 +0.2 %, +4 %; ÷2 −0.1 %.
pub const BLUNT: f64 = 50.0;

/// May a round part of this radius, metres, be one of an object of that squared extent, m², of
/// which a little may not have been seen?
#[inline(always)]
pub fn fits(radius: f64, size2: f64) -> bool {
    radius > 0.0 && radius * radius <= (1.0 + ALIKE) * size2
}

/// A disc around a vertex; none with the radius 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    /// Metres.
    pub radius: f64,
    /// Unit; either sign.
    pub axis: Vec3,
}

impl Disc {
    pub const NONE: Self = Self {
        radius: 0.0,
        axis: ZERO,
    };

    /// What a vector has across the axis.
    #[inline(always)]
    pub fn across(&self, v: &Vec3) -> Vec3 {
        v - self.axis * self.axis.dot(v)
    }

    /// Is the unit vector `n` along the axis, within rounding? There all of it is farthest.
    #[inline(always)]
    pub fn is_along(&self, n: &Vec3) -> bool {
        !(self.across(n).norm_squared() > EPSILON)
    }

    /// Its farthest point along the unit vector `n`, from its middle; along the axis the middle.
    #[inline(always)]
    pub fn point(&self, n: &Vec3) -> Vec3 {
        let across = self.across(n);
        let l2 = across.norm_squared();
        if l2 > EPSILON {
            across * (self.radius / l2.sqrt())
        } else {
            Vec3::zeros()
        }
    }

    /// The disc of which `old` and `new` are points. Any two smooth points are some disc's: a third
    /// one must confirm it. `None`: no disc moves so, or by more than a quarter of a turn (the two
    /// ends of anything are opposite points of a disc).
    ///
    /// *Condition*: d is across the axis a, and m, m′ lie symmetric to the middle of the chord: with
    /// f₀ = d/|d|, p = n·f₀, q = n′·f₀, m·f₀ = −m′·f₀, or p² |n′⊥|² = q² |n⊥|².
    /// *Solution*: with f₁ along what n has across f₀, of length α, f₂ = f₀ × f₁, and
    /// a = c f₁ + s f₂, n·a = c α, n′·a = c β₁ + s β₂ that is A c² + B c s + C s² = 0 with
    /// A = p² (1 − β₁²) − q² (1 − α²), B = −2 p² β₁ β₂, C = p² (1 − β₂²) − q². One of the two
    /// roots has a nearly along n, where any move is some disc's; the other one is taken.
    pub fn of(old: &Seen, new: &Seen) -> Option<Self> {
        let d = new.p - old.p;
        let f0 = d * (1.0 / d.norm());
        let (p, q) = (old.n.dot(&f0), new.n.dot(&f0));
        let f1 = old.n - f0 * p;
        let alpha2 = f1.norm_squared();
        let f1 = f1 * (1.0 / alpha2.sqrt());
        let f2 = f0.cross(&f1);
        let (p2, q2) = (p * p, q * q);
        let (b1, b2) = (new.n.dot(&f1), new.n.dot(&f2));
        let a = p2 * (1.0 - b1 * b1) - q2 * (1.0 - alpha2);
        let b = -2.0 * p2 * b1 * b2;
        let c = p2 * (1.0 - b2 * b2) - q2;
        let root = (b * b - 4.0 * a * c).sqrt();
        let axis = f1 * c + f2 * (-0.5 * (b + root.copysign(b)));
        let axis = axis * (1.0 / axis.norm());
        let unit = Self { radius: 1.0, axis };
        let moved = unit.point(&new.n) - unit.point(&old.n);
        let moved2 = moved.norm_squared();
        let radius = d.dot(&moved) / moved2;
        // False for NaN.
        (moved2 < 2.0 && radius > 0.0 && radius < f64::INFINITY).then_some(Self { radius, axis })
    }
}

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Symmetric(pub [f64; 6]);

impl Symmetric {
    /// a I.
    pub fn scaled_identity(a: f64) -> Self {
        Self([a, 0.0, 0.0, a, 0.0, a])
    }

    #[inline(always)]
    pub fn times(&self, v: &Vec3) -> Vec3 {
        let [xx, xy, xz, yy, yz, zz] = self.0;
        Vec3::new(
            xx * v.x + xy * v.y + xz * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z,
        )
    }

    /// Adds a w w′.
    #[inline(always)]
    pub fn add_square(&mut self, a: f64, w: &Vec3) {
        let aw = w * a;
        let m = &mut self.0;
        m[0] += aw.x * w.x;
        m[1] += aw.x * w.y;
        m[2] += aw.x * w.z;
        m[3] += aw.y * w.y;
        m[4] += aw.y * w.z;
        m[5] += aw.z * w.z;
    }

    /// The matrix of the first smooth pair: as large along n′ − n as d is long.
    pub fn first(d: &Vec3, dn: &Vec3) -> Self {
        let along = d.dot(dn);
        let (d2, dn2) = (d.norm_squared(), dn.norm_squared());
        // What moves more aside than along is of rank one, as a disc's is.
        let slope = if along * along > SQUARE * d2 * dn2 {
            along / dn2
        } else {
            d2 / along
        };
        let mut r = Self::scaled_identity(slope);
        let w = d - r.times(dn);
        r.add_least(&w, dn);
        r
    }

    /// Makes R (n′ − n) more by `w`, by the least change in the sense of Powell's formula.
    #[inline]
    pub fn add_least(&mut self, w: &Vec3, dn: &Vec3) {
        let across = 1.0 / dn.norm_squared();
        self.add_square(across, &(w + dn));
        self.add_square(-across, w);
        self.add_square(-across - w.dot(dn) * across * across, dn);
    }

    /// In the chart of two unit vectors across each other, as ρ I + A, tr A = 0: ρ, A's first entry,
    /// and the one across. Positive semidefinite, as what is convex: a negative eigenvalue becomes
    /// zero.
    #[inline]
    pub fn within(&self, e1: &Vec3, e2: &Vec3) -> (f64, f64, f64) {
        let (r1, r2) = (self.times(e1), self.times(e2));
        let (rxx, rxy, ryy) = (r1.dot(e1), r1.dot(e2), r2.dot(e2));
        let (rho, axx) = (0.5 * (rxx + ryy), 0.5 * (rxx - ryy));
        let m = (axx * axx + rxy * rxy).sqrt();
        if m > rho {
            let half = 0.5 * larger(rho + m, 0.0);
            (half, axx * (half / m), rxy * (half / m))
        } else {
            (rho, axx, rxy)
        }
    }

    /// Reduces n′ − n's share of it so that it bends by no more than `room` along it.
    #[inline]
    pub fn reduce(&mut self, dn: &Vec3, room: f64) {
        let rd = self.times(dn);
        let bend = rd.dot(dn);
        let room = larger(room, 0.0);
        if bend > room {
            self.add_square((room - bend) / (bend * bend), &rd);
        }
    }
}

/// Squared cosine of the angle between the first pair's differences up to which R is as large
/// along them as it was seen to be. Measured: 1 +0.5 %, +7 % (ellipsoids); ÷2 −0.1 %.
const SQUARE: f64 = 0.9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::perpendicular;
    use crate::shapes::{Random, ball, capsule, corners, ellipsoid, hull};

    /// What the closed forms below may be off by.
    const NEAR: f64 = if EPSILON > 1e-10 { 3e-3 } else { 1e-7 };
    const SAME: Same = Same {
        rounding: 4.0 * EPSILON,
        round: NEAR,
        extent2: 1.0,
    };

    fn ask(shape: &impl Fn(&Vec3) -> Vec3, n: Vec3) -> Seen {
        let n = n.normalize();
        Seen { n, p: shape(&n) }
    }

    /// Two directions that far apart.
    fn two(r: &mut Random, angle: f64) -> [Vec3; 2] {
        let n = r.direction();
        let t = perpendicular(&n);
        let t = t * r.within(-1.0, 1.0) + n.cross(&t) * r.within(-1.0, 1.0);
        [n, (n + t.normalize() * angle).normalize()]
    }

    fn rim(d: &Vec3, radius: f64) -> Vec3 {
        Vec3::new(d.x, d.y, 0.0) * (radius / d.x.hypot(d.y))
    }

    fn cylinder(d: &Vec3) -> Vec3 {
        rim(d, 0.5) + Vec3::z() * (0.4 as f64).copysign(d.z)
    }

    fn cone(d: &Vec3) -> Vec3 {
        let (tip, base) = (Vec3::z() * 0.5, rim(d, 0.5) - Vec3::z() * 0.5);
        if tip.dot(d) > base.dot(d) { tip } else { base }
    }

    fn half_disc(d: &Vec3) -> Vec3 {
        if d.y > 0.0 {
            rim(d, 0.5)
        } else {
            Vec3::x() * (0.5 as f64).copysign(d.x)
        }
    }

    fn teardrop(d: &Vec3) -> Vec3 {
        let tip = Vec3::z() * 0.9;
        if tip.dot(d) > 0.3 { tip } else { d * 0.3 }
    }

    /// A pair along each shape, well off the places where pieces meet.
    #[test]
    fn balls_and_vertices_are_told_from_all_else() {
        let mut r = Random::new(1);
        let (sphere, rod) = (
            ball(Vec3::new(0.3, 0.2, 0.1), 0.4),
            capsule(-Vec3::x(), Vec3::x(), 0.3),
        );
        let cube = hull(&corners(Vec3::repeat(0.5)));
        for _ in 0..1000 {
            let angle = r.within(0.05, 0.4);
            let [m, n] = two(&mut r, angle);
            let radius = |a: &dyn Fn(&Vec3) -> Vec3, b: Vec3| {
                let by = Move::of(&ask(&a, m), &ask(&a, b));
                by.ball(&SAME).unwrap_or(0.0)
            };
            assert!((radius(&sphere, n) - 0.4).abs() < NEAR);
            let end = m.x * n.x > 0.0;
            assert!((radius(&rod, n) - if end { 0.3 } else { 0.0 }).abs() < NEAR);
            let (a, b) = (ask(&cube, m), ask(&cube, n));
            for by in [Move::of(&a, &b), Move::of(&a, &a)] {
                assert!(by.ball(&SAME).is_none());
                assert!(by.d2 > 0.0 || !by.is_smooth(&SAME, ALIKE));
            }
        }
    }

    /// The disc of two points of a rim, and that a third confirms it; no point of another surface
    /// does.
    #[test]
    fn two_points_of_a_rim_are_a_discs() {
        let mut r = Random::new(2);
        let mut met = [0; 3];
        let round = ellipsoid(Vec3::new(0.5, 0.4, 0.3), r.rotation(), Vec3::zeros());
        let shapes: [&dyn Fn(&Vec3) -> Vec3; 3] = [&cylinder, &cone, &round];
        for _ in 0..2000 {
            let angle = r.within(0.1, 0.4);
            let [m, n] = two(&mut r, angle);
            let third = (m + n + r.vector(0.4)).normalize();
            for (i, shape) in shapes.iter().enumerate() {
                let [a, b, c] = [m, n, third].map(|n| ask(shape, n));
                let one_end = a.p.z * b.p.z > 0.0 && b.p.z * c.p.z > 0.0 && a.p.z < 0.45;
                let steep = m.z.abs().max(n.z.abs()).max(third.z.abs()) > 0.9;
                if !Move::of(&a, &b).is_smooth(&SAME, ALIKE) || !one_end || steep {
                    continue;
                }
                let Some(disc) = Disc::of(&a, &b) else {
                    continue;
                };
                let core = |at: &Seen| at.p - disc.point(&at.n);
                let off = disc.across(&(core(&c) - core(&b))).norm();
                met[i] += 1;
                // The axis is told by the third order of the angle.
                let near = 30.0 * NEAR / angle.powi(3);
                if i < 2 {
                    assert!((disc.radius - 0.5).abs() < near, "{disc:?}");
                    assert!(disc.axis.z.abs() > 1.0 - near, "{disc:?}");
                    assert!(off < near, "{off}");
                }
            }
        }
        assert!(met.iter().all(|met| *met > 50), "{met:?}");
    }

    /// Where a piece ends, the next one shows none of it: a corner is a vertex, and its point
    /// carries neither the arc nor the ball.
    #[test]
    fn round_on_one_side_is_not_round_on_the_other() {
        let up = |x: f64, y: f64| ask(&half_disc, Vec3::new(x, y, 0.1));
        let disc = Disc::of(&up(0.5, 0.5), &up(0.3, 0.5)).unwrap();
        assert!((disc.radius - 0.5).abs() < 10.0 * NEAR, "{disc:?}");
        let core = |at: &Seen| (at.p - disc.point(&at.n)).norm();
        assert!(core(&up(0.4, 0.6)) < 10.0 * NEAR);
        assert!(core(&up(0.5, -0.5)) > 0.1);
        assert_eq!(Move::of(&up(0.5, -0.5), &up(0.5, -0.9)).d2, 0.0);
        let at = |x: f64, z: f64| ask(&teardrop, Vec3::new(x, 0.2, z));
        let radius = Move::of(&at(1.0, -0.2), &at(1.0, 0.1)).ball(&SAME);
        assert!(radius.is_some_and(|r| (r - 0.3).abs() < NEAR), "{radius:?}");
        let tip = at(0.1, 1.0);
        assert!((tip.p - tip.n * 0.3).norm() > 0.1);
        assert_eq!(Move::of(&at(0.1, 1.0), &at(0.2, 1.0)).d2, 0.0);
    }

    #[test]
    fn what_is_no_number_shows_nothing() {
        let bad = Seen {
            n: Vec3::repeat(f64::NAN),
            p: Vec3::zeros(),
        };
        let good = Seen {
            n: Vec3::x(),
            p: Vec3::x(),
        };
        let by = Move::of(&good, &bad);
        assert!(by.ball(&SAME).is_none() && !by.is_smooth(&SAME, ALIKE));
        assert!(Disc::of(&good, &good).is_none());
        let mut r = Symmetric::scaled_identity(1.0);
        r.reduce(&Vec3::x(), 0.25);
        assert!((r.times(&Vec3::x()) - Vec3::x() * 0.25).norm() < 4.0 * EPSILON);
    }

    #[test]
    fn no_disc_moves_so() {
        let two = |n: Vec3, other: Vec3, d: Vec3| {
            let old = Seen {
                n,
                p: Vec3::zeros(),
            };
            Disc::of(&old, &Seen { n: other, p: d })
        };
        let (x, y) = (Vec3::x(), Vec3::new(1.0, 0.1, 0.0).normalize());
        assert!(two(x, y, Vec3::zeros()).is_none());
        assert!(two(x, y, Vec3::repeat(f64::NAN)).is_none());
        assert!(two(x, x, Vec3::y()).is_none());
        // The ends of a line.
        let z = Vec3::new(1.0, -0.1, 0.0).normalize();
        assert!(two(z, y, Vec3::y()).is_none());
    }
}
