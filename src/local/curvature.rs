// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The curvature R of the smooth part of D, learned from pairs of samples.

use super::samples::{CUTS, Sample, Samples};
use crate::known::round::{ALIKE, BLUNT, Symmetric, TOLD, fits, is_smooth};
use crate::math::{EPSILON, Real, Vec3, larger, lesser};

/// How many times as far from where it was seen as the directions are apart that showed it what is
/// round is believed: the body may be cut off beyond. Measured: 1 +1.1 %, +8 % (cylinders); 2 −0.1 %,
/// and half a disc is taken for a disc half a radian beyond its end.
pub const FAR: Real = 1.4;
/// Relative residual of a pair that is parallel, a ball's. Measured: ×2, ÷2 nothing; 1e-9
/// +0.1 %, +3 %.
pub const BALL: Real = if EPSILON > 1e-10 { 3e-5 } else { 1e-6 };
/// Relative error of R up to which it leads to the witness points of one active cut, and up
/// to which the first pair that confirms a remembered R confirms all of it. Measured: ×2 −0.1 %,
/// 3 more; ÷2 +0.1 %, +3 % (ellipsoids), 25 fewer.
pub const FORETOLD: Real = 0.1;
/// How much more alike once a vertex was seen twice (a polytope, it seems). Measured: ×2, ÷2
/// nothing; 1 +0.1 %, +1.5 %; 0 one more of shallow hulls from 25°.
const FLAT: Real = 0.05;
/// Relative error up to which R moves cuts, and is only reduced when it is refuted; also that
/// of a remembered R, until a pair tells. Measured: ×2 +1.2 %, +19 % (hulls); ÷2 +0.2 %, +6 %.
pub const BELIEVED: Real = 0.5;
/// Squared sine of the angle from which on two pairs measure R in two directions. Measured: ×2
/// +0.1 %, +1.2 %, 15 fewer; ÷2 no change, 13 more.
const SPREAD: Real = 0.04;
/// The widest pair that tells the parts of R, radians: one of half balls .4 and .9 wide was alike
/// by chance. Measured: without +0.1 %.
const NARROW: Real = 0.3;
/// Relative error of obj1's part of R up to which it is believed. Measured: 0.04 +0.25 %, a witness
/// point in 100,000 of half discs less outside.
const PARTED: Real = 0.1;
/// Squared cosine of the angle between what a pair corrects and its direction from which on the
/// symmetric rank-one formula has a say. Measured: ×2, ÷2 no change, +1.6 %; 0 +4.3 %, +28 %.
const ALONG: Real = 0.0025;
/// Squared cosine of the angle between the first pair's differences up to which R is as large
/// along them as it was seen to be; beyond it, R is of rank one, and so large that it moves s
/// as far as it was seen to move. Measured: 1 +0.5 %, +7 % (ellipsoids); ÷2 −0.1 %, one more
/// of the cones from 5°.
const SQUARE: Real = 0.9;

/// How alike the excesses of a smooth pair must be. `flat`: a vertex was seen twice.
#[inline(always)]
pub fn alike(flat: bool) -> Real {
    if flat { ALIKE * FLAT } else { ALIKE }
}

/// R and what is known of it.
pub struct Curvature {
    pub r: Symmetric,
    /// Obj1's part of it.
    r1: Symmetric,
    /// Relative error of that, by the last smooth pair; 1 where it was a guess, infinite where there
    /// is none.
    error1: Real,
    /// Some pair measured it, or the memory remembers it.
    pub known: bool,
    /// Relative error, by the last smooth pair.
    pub error: Real,
    /// How far the points of the last smooth pair are apart along its directions' difference: those
    /// of D, and obj1's.
    apart: [Real; 2],
    /// In every smooth pair the points of each object moved along those of D, and less aside than
    /// [`BELIEVED`] of that.
    pub even: bool,
    /// The direction of the first smooth pair.
    pub line: Option<Vec3>,
    /// Measured along a second direction too.
    pub spread: bool,
    /// The square of the widest angle of a smooth pair.
    pub span2: Real,
    /// Every smooth pair so far was exactly parallel: a ball, which is part of every
    /// piece of D.
    pub round: bool,
    /// A vertex was seen from two directions.
    flat: bool,
    /// No longer looked for.
    given_up: bool,
}

/// Two samples of which one lies beyond the support plane of the other, so one is no support
/// point.
pub struct Contradiction;

/// What the samples kept say beside a new one.
struct Comparison {
    /// The nearest one that makes a smooth pair with it, and their squared angle.
    twin: Option<usize>,
    angle2: Real,
    /// What a kink between the new sample and the centre leaves for R.
    room: Real,
    contradicted: bool,
}

impl Curvature {
    #[inline]
    pub fn new() -> Self {
        Self {
            r: Symmetric::default(),
            r1: Symmetric::default(),
            error1: 1.0,
            known: false,
            error: 1.0,
            apart: [0.0; 2],
            even: true,
            line: None,
            spread: false,
            span2: 0.0,
            round: true,
            flat: false,
            given_up: false,
        }
    }

    /// R as an earlier search knew it: enough to look by, not to believe.
    #[inline]
    pub fn recall(&mut self, r: Symmetric, part: Option<Symmetric>) {
        self.r = r;
        self.r1 = part.unwrap_or_default();
        self.error1 = part.map_or(Real::INFINITY, |_| 1.0);
        self.known = true;
        self.error = BELIEVED;
    }

    /// R is no longer looked for.
    #[cold]
    pub fn give_up(&mut self) {
        self.given_up = true;
        self.known = false;
    }

    /// A remembered R beyond any object of that extent was another's.
    #[inline]
    pub fn forget_unless_fits(&mut self, size: Real) {
        let largest: Real = self.r.0.iter().map(|entry| entry.abs()).sum();
        self.known &= largest <= BLUNT * size;
    }

    /// R in the chart of the unit vectors e1 and e2: ρ, A's first entry, and the one across.
    #[inline]
    pub fn within(&self, e1: &Vec3, e2: &Vec3) -> (Real, Real, Real) {
        self.r.within(e1, e2)
    }

    /// Relative error of R between sample `i` and the centre: of R as a whole and, but for a
    /// ball, on that piece of D; all of it too far from where R was seen.
    #[inline]
    pub fn error_of(&self, samples: &Samples, i: usize) -> Real {
        let own = samples.error[i];
        let turned = (samples.n.get(i) - samples.dir()).norm_squared();
        // Half as far where no pair of its own has told.
        let far = if own < 1.0 { FAR } else { 0.5 * FAR };
        if !(turned <= far * far * self.span2) {
            1.0
        } else {
            larger(self.error, own)
        }
    }

    /// How much of R is obj1's, by the last smooth pair; half where none has told.
    pub fn share(&self) -> Real {
        let share = self.apart[1] / self.apart[0];
        // False for NaN.
        if share.abs() < Real::INFINITY {
            share.clamp(0.0, 1.0)
        } else {
            0.5
        }
    }

    /// Learns from a new sample, not yet kept. Returns the nearest sample that makes a smooth
    /// pair with it.
    ///
    /// # Errors
    /// [`Contradiction`], and nothing learnt, unless the sample is to be kept even so: then it
    /// is `trusted`.
    #[inline]
    pub fn learn(
        &mut self,
        samples: &mut Samples,
        new: &Sample,
        trusted: bool,
    ) -> Result<Option<usize>, Contradiction> {
        let seen = self.compare(samples, new);
        if seen.contradicted && !trusted {
            return Err(Contradiction);
        }
        if self.known && seen.room < Real::INFINITY {
            self.refute(&(new.n - samples.dir()), seen.room);
        }
        if let Some(twin) = seen.twin {
            self.learn_pair(samples, twin, new, seen.angle2);
        }
        Ok(seen.twin)
    }

    #[inline]
    fn compare(&mut self, samples: &Samples, new: &Sample) -> Comparison {
        let rounding = samples.rounding;
        let size2 = samples.size * samples.size;
        let mut seen = Comparison {
            twin: None,
            angle2: Real::INFINITY,
            room: Real::INFINITY,
            contradicted: false,
        };
        for i in 0..samples.len.min(CUTS) {
            let n = samples.n.get(i);
            let (dn, ds) = (new.n - n, new.p.v - samples.v.get(i));
            let (dn2, ds2) = (dn.norm_squared(), ds.norm_squared());
            let (ahead, behind) = (ds.dot(&new.n), -ds.dot(&n));
            // Also NaN.
            if !(dn2 > TOLD * TOLD) {
                continue;
            }
            let repeated = ds2 <= rounding * rounding;
            self.flat |= repeated;
            seen.contradicted |= ahead < -rounding || behind < -rounding;
            let smooth = !self.given_up
                && ahead + behind > rounding
                && is_smooth([ahead, behind], ds2, size2 * dn2, alike(self.flat));
            if repeated || smooth {
                if dn2 < seen.angle2 {
                    seen.twin = Some(i);
                    seen.angle2 = dn2;
                }
            } else if i == samples.centre {
                seen.room = 2.0 * ahead.min(behind);
            }
        }
        seen
    }

    /// A kink between the centre and a sample `dn` away leaves R no more than this `room`.
    #[inline]
    fn refute(&mut self, dn: &Vec3, room: Real) {
        let bend = self.r.times(dn).dot(dn);
        let room = room.max(0.0);
        if bend > room && self.error > BELIEVED {
            // Refuted before a second pair confirmed it.
            self.known = false;
        } else if bend > room {
            self.r.reduce(dn, room);
            self.error1 = 1.0;
            self.round &= bend - room <= BALL * bend;
        }
    }

    /// A smooth pair, this angle apart, squared.
    #[inline]
    fn learn_pair(&mut self, samples: &mut Samples, twin: usize, new: &Sample, dn2: Real) {
        let dn = new.n - samples.n.get(twin);
        let other = samples.point(twin);
        let (ds, ds1) = (new.p.v - other.v, new.p.v1 - other.v1);
        self.span2 = larger(dn2, self.span2);
        let ds2 = ds.norm_squared();
        // The first pair that confirms a remembered R confirms all of it.
        let remembered = self.known && self.line.is_none();
        match &self.line {
            None => self.line = Some(dn),
            Some(line) => {
                self.spread = self.spread
                    || line.cross(&dn).norm_squared() > SPREAD * dn2 * line.norm_squared();
            }
        }
        if ds2 <= samples.rounding * samples.rounding {
            self.flatten(&dn);
            return;
        }
        let bend = ds.dot(&dn);
        let slope = bend / dn2;
        let along = ds1.dot(&dn);
        self.apart = [bend, along];
        let least = BELIEVED * lesser(along, bend - along) + BALL * bend;
        self.even &= (ds1 * bend - ds * along).norm_squared() <= least * least * ds2;
        let measured = self.known;
        if !measured {
            self.known = true;
            let square = slope * bend > SQUARE * ds2;
            self.r = Symmetric::scaled_identity(if square { slope } else { ds2 / bend });
        }
        self.learn_part(&dn, dn2, &ds1, ds2, measured);
        let w = ds - self.r.times(&dn);
        let w2 = w.norm_squared();
        if measured {
            self.error = (w2 / ds2).sqrt();
            // By as much as this pair corrects it R is another for the other samples.
            samples.error = samples.error.map(|error| larger(self.error, error));
        }
        self.spread |= remembered && self.error < FORETOLD;
        // Exactly parallel: a ball, if the object has room for it.
        let size2 = samples.size * samples.size;
        if (ds - dn * slope).norm_squared() <= BALL * BALL * ds2 && fits(slope, size2) {
            self.spread = true;
            if self.error > BALL {
                self.r = Symmetric::scaled_identity(slope);
                self.error = BALL;
            }
            return;
        }
        self.round = false;
        update(&mut self.r, &dn, dn2, &w);
    }

    /// Obj1's part of R from its points of a smooth pair.
    fn learn_part(&mut self, dn: &Vec3, dn2: Real, ds1: &Vec3, ds2: Real, measured: bool) {
        let guess = !measured || self.error1 > 1.0;
        if guess {
            self.r1 = Symmetric(self.r.0.map(|r| r * self.share()));
        }
        let w1 = ds1 - self.r1.times(dn);
        self.error1 = if guess || !(dn2 <= NARROW * NARROW) {
            1.0
        } else {
            (w1.norm_squared() / ds2).sqrt()
        };
        update(&mut self.r1, dn, dn2, &w1);
    }

    /// A vertex of P seen along n and n + dn: no curvature between them.
    #[inline]
    fn flatten(&mut self, dn: &Vec3) {
        let rd = self.r.times(dn);
        let bend = rd.dot(dn);
        if self.error > BELIEVED {
            self.known = false;
        } else if bend > 0.0 {
            self.r.add_square(-1.0 / bend, &rd);
            self.error1 = 1.0;
        }
    }

    /// Obj1's part of R, if it is known.
    pub fn part(&self) -> Option<Symmetric> {
        (self.error1 <= PARTED).then_some(self.r1)
    }
}

/// Changes R so that R dn is what was seen: by `w` more than it was.
#[inline]
fn update(r: &mut Symmetric, dn: &Vec3, dn2: Real, w: &Vec3) {
    let along = w.dot(dn);
    if along * along > ALONG * w.norm_squared() * dn2 {
        // Symmetric rank-one.
        r.add_square(1.0 / along, w);
    } else {
        // Across: the least symmetric change (Powell's).
        r.add_least(w, dn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::support::Known;
    use crate::math::{perpendicular, unit};
    use crate::shapes::{Random, Rotation, Shape, ball, corners, ellipsoid, hull};

    use super::super::samples::tests::{ask, samples};

    /// What is learnt from these directions, one after the other.
    fn learn(shape: &Shape, dirs: &[Vec3]) -> Curvature {
        let mut curvature = Curvature::new();
        for k in 1..dirs.len() {
            let mut known = Known::default();
            let mut before = samples(&mut known, shape, &dirs[k.saturating_sub(CUTS)..k]);
            let new = ask(shape, &dirs[k]);
            before.size = 1.0;
            assert!(curvature.learn(&mut before, &new, false).is_ok());
        }
        curvature
    }

    /// b, and directions on a spiral around it, so many radians away.
    fn spiral(b: &Vec3, angle: Real, count: usize) -> Vec<Vec3> {
        let e1 = perpendicular(b);
        let e2 = b.cross(&e1);
        let aside = |k: usize| {
            let (s, c) = (1.9 * k as Real).sin_cos();
            unit(&(b + (e1 * c + e2 * s) * (angle * (0.7 + 0.1 * k as Real)))).unwrap()
        };
        core::iter::once(*b).chain((1..count).map(aside)).collect()
    }

    #[test]
    fn an_ellipsoid_shows_its_curvature() {
        let mut r = Random::new(4);
        let angle = if EPSILON > 1e-10 { 0.02 } else { 0.002 };
        let radii = Vec3::new(0.5, 0.35, 0.25);
        let shape = ellipsoid(radii, Rotation::identity(), Vec3::new(0.1, 0.2, -0.1));
        for _ in 0..50 {
            let b = r.direction();
            let curvature = learn(&shape, &spiral(&b, angle, 8));
            assert!(curvature.known && curvature.spread);
            // The support function is |S n| with S = diag(radii): its second derivative.
            let m = radii.component_mul(&radii);
            let mb = m.component_mul(&b);
            let h = b.dot(&mb).sqrt();
            for _ in 0..5 {
                let t = r.direction();
                let t = t - b * b.dot(&t);
                let truth = m.component_mul(&t) / h - mb * (mb.dot(&t) / (h * h * h));
                let error = (curvature.r.times(&t) - truth).norm();
                // It changes along the way by about the angle times the ratio of the axes.
                assert!(error < 10.0 * angle * m.x / h, "{error}");
            }
        }
    }

    #[test]
    fn two_samples_of_a_ball_are_enough() {
        let mut r = Random::new(5);
        let shape = ball(Vec3::new(0.2, 0.1, 0.3), 0.7);
        for _ in 0..50 {
            let curvature = learn(&shape, &spiral(&r.direction(), 0.4, 2));
            assert!(curvature.known && curvature.spread && curvature.error <= BALL);
            let (rho, a, c) = curvature.within(&Vec3::x(), &Vec3::z());
            assert!((rho - 0.7).abs() < 0.7 * BALL && a.abs() + c.abs() < BALL);
        }
    }

    #[test]
    fn an_edge_shows_none() {
        let shape = hull(&corners(Vec3::new(0.5, 0.4, 0.3)));
        // Across one edge, nearer to it on one side: a kink, and a vertex seen twice.
        let dirs = [
            Vec3::new(0.02, 0.5, 0.8),
            Vec3::new(-0.09, 0.5, 0.8),
            Vec3::new(0.03, 0.6, 0.8),
        ]
        .map(|d| d.normalize());
        assert!(!learn(&shape, &dirs).known);
    }

    #[test]
    fn a_point_beyond_a_support_plane_is_a_contradiction() {
        let shape = ball(Vec3::zeros(), 1.0);
        let mut known = Known::default();
        let mut before = samples(&mut known, &shape, &[Vec3::x()]);
        let mut wrong = ask(&shape, &Vec3::new(0.995, 0.1, 0.0).normalize());
        wrong.p.v *= 1.1;
        let mut curvature = Curvature::new();
        assert!(curvature.learn(&mut before, &wrong, false).is_err());
        assert!(!curvature.known);
        assert!(curvature.learn(&mut before, &wrong, true).is_ok());
    }

    #[test]
    fn a_kink_takes_away_what_it_refutes() {
        let shape = hull(&corners(Vec3::new(0.5, 0.4, 0.3)));
        let dirs = [Vec3::new(0.02, 0.5, 0.8), Vec3::new(-0.09, 0.5, 0.8)].map(|d| d.normalize());
        let mut known = Known::default();
        let mut before = samples(&mut known, &shape, &dirs[..1]);
        let new = ask(&shape, &dirs[1]);
        let dn = dirs[1] - dirs[0];
        let across = dn.cross(&dirs[0]);
        // Ten times as large as D may have it there.
        let large = 10.0 * (new.p.v - before.v.get(0)).norm() / dn.norm();
        let mut curvature = Curvature::new();
        curvature.recall(Symmetric::scaled_identity(large), None);
        assert!(curvature.learn(&mut before, &new, false).is_ok());
        assert!(curvature.known);
        let ahead = new.h - new.n.dot(&before.v.get(0));
        let behind = before.h[0] - dirs[0].dot(&new.p.v);
        let room = 2.0 * ahead.min(behind);
        assert!((curvature.r.times(&dn).dot(&dn) - room).abs() <= 1e-4 * room);
        assert!((curvature.r.times(&across) - across * large).norm() <= 1e-4 * large);
        // One that no pair has confirmed, and that is not remembered either, ends.
        let mut curvature = Curvature::new();
        curvature.recall(Symmetric::scaled_identity(large), None);
        curvature.error = 1.0;
        assert!(curvature.learn(&mut before, &new, false).is_ok());
        assert!(!curvature.known);
    }
}
