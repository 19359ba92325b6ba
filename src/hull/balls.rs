// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What two balls prove, or what is between two balls: a bound where no polytope can have one.
//!
//! The minima of two balls about one centre form a sphere. To show a gap of g of the depth all
//! around, a polytope in it needs 2.4 / g points, two thousand for a thousandth. But where the
//! ball of radius r about c is part of obj1, and that of radius r′ about c′ of obj2, then
//!
//!   h(n) >= n·(c − c′) + r + r′ >= r + r′ − |c − c′|   for all unit n,
//!
//! and with two balls of each object, the ends of capsules, c − c′ may be any point of the
//! parallelogram of their differences: the nearest to the origin bounds best. It holds for what
//! is more than the balls as well, a teardrop.
//!
//! *What is believed.* That a ball is part of an object no finite number of support points
//! proves. It is believed where [`ROUND`] of them lie on it to rounding, none at all lies short of
//! it along its own direction, and the polytope has proven the bound to [`SHARE`] by itself: then
//! the directions asked lie so close, all around, that what is cut off the ball between them is no
//! higher than that share of the depth.
//!
//! Source: own derivation.

use crate::gjk::barycentric;
use crate::math::{Real, Vec3};

/// Points on a ball that show it. Free: three tell it.
const ROUND: usize = 8;
/// Points on the ball at the other end of a capsule, whose radius is known.
const END: usize = 4;
/// The least |n′ − n|² that tells a radius to rounding.
const WIDE: Real = 0.5;
/// The share of the depth that the polytope must have left. A smaller one asks more of two balls:
/// the points that this takes are 2.4 of its inverse, and about twice that many.
pub const SHARE: Real = 1.0 / 16.0;

/// Points below which no two balls can have come to that share. Derived: 2.4 of its inverse, less
/// some for a centre that is not the origin.
pub const FEWEST: usize = 32;

/// The balls of one object.
struct Balls {
    radius: Real,
    /// Twice the same where there is one.
    centres: [Vec3; 2],
}

impl Balls {
    /// The balls that its points show, asked along `directions` (zero: not asked for) times
    /// `sign`. The first one is where it reaches farthest along `n`.
    fn of(points: &[Vec3], directions: &[Vec3], sign: Real, n: &Vec3, noise: Real) -> Option<Self> {
        let asked = || {
            let signed = directions.iter().map(move |n| n * sign);
            signed.zip(points).filter(|(n, _)| n.norm_squared() > 0.5)
        };
        let mut first = (Vec3::zeros(), Vec3::zeros(), Real::NEG_INFINITY);
        for (m, p) in asked() {
            if m.dot(n) > first.2 {
                first = (m, *p, m.dot(n));
            }
        }
        let (m, p, _) = first;
        let mut told = (WIDE, -1.0);
        for (n, q) in asked() {
            let (d, dn) = (q - p, n - m);
            let turned = dn.norm_squared();
            let radius = d.dot(&dn) / turned;
            if turned > told.0 && (d - dn * radius).norm() <= noise {
                told = (turned, radius);
            }
        }
        let radius = told.1;
        // None was told.
        if !(radius > -noise) {
            return None;
        }
        let on = |centre: &Vec3| {
            let (mut on, mut farthest) = (0, (noise, *centre));
            for (n, q) in asked() {
                let core = q - n * radius;
                let beyond = n.dot(&(core - centre));
                // Short of it; also NaN.
                if !(beyond >= -noise) {
                    return (0, farthest.1);
                }
                on += usize::from((core - centre).norm() <= noise);
                if beyond > farthest.0 {
                    farthest = (beyond, core);
                }
            }
            (on, farthest.1)
        };
        let centre = p - m * radius;
        let (count, other) = on(&centre);
        if count < ROUND {
            return None;
        }
        let other = if on(&other).0 >= END { other } else { centre };
        Some(Self {
            radius,
            centres: [centre, other],
        })
    }

    /// Where the two have their ends: any point between the two centres.
    fn corner(&self, far: bool) -> &Vec3 {
        let [near, end] = &self.centres;
        if far { end } else { near }
    }
}

/// A bound on the depth, and the points that the balls touch with.
pub struct Bound {
    /// No depth is less, metres.
    pub lower: Real,
    /// Of the objects, along the direction asked for.
    pub points: [Vec3; 2],
}

/// The bound that the balls of two objects give, from their points along `directions`: obj1's
/// along each, obj2's against it. `n`: the direction of the least depth met; `noise`: what a point
/// is uncertain by, metres.
#[cold]
#[inline(never)]
pub fn bound(points: [&[Vec3]; 2], directions: &[Vec3], n: &Vec3, noise: Real) -> Option<Bound> {
    let one = Balls::of(points[0], directions, 1.0, n, noise)?;
    let two = Balls::of(points[1], directions, -1.0, &-n, noise)?;
    // The parallelogram, as two triangles.
    let [a, c] = [false, true].map(|far| (one.corner(far), two.corner(far)));
    let mut best: Option<(Real, [Vec3; 2])> = None;
    for b in [
        (one.corner(false), two.corner(true)),
        (one.corner(true), two.corner(false)),
    ] {
        let corners = [a, b, c].map(|(p, q)| p - q);
        let nearest = barycentric::triangle(&Vec3::zeros(), &corners[0], &corners[1], &corners[2]);
        let mixed = [
            barycentric::mix(&nearest.weights, [a.0, b.0, c.0]),
            barycentric::mix(&nearest.weights, [a.1, b.1, c.1]),
        ];
        let off = (mixed[0] - mixed[1]).norm();
        if best.is_none_or(|(least, _)| off < least) {
            best = Some((off, mixed));
        }
    }
    let (off, [p, q]) = best?;
    Some(Bound {
        // Of each object a radius and a centre are uncertain.
        lower: one.radius + two.radius - off - 4.0 * noise,
        points: [p + n * one.radius, q - n * two.radius],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::precision::Precision;
    use crate::known::support::MinkowskiDifference;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Shape, ball, capsule, corners, ellipsoid, hull};

    /// The bound that so many random directions give, and the points.
    fn told(shapes: [&Shape; 2], n: &Vec3, count: usize, r: &mut Random) -> Option<Bound> {
        let mut precision = Precision::default();
        let directions: Vec<Vec3> = (0..count)
            .map(|i| if i == 0 { *n } else { r.direction() })
            .collect();
        let md = MinkowskiDifference::new(shapes[0], shapes[1]);
        let mut points = [vec![], vec![]];
        for n in &directions {
            let point = md.support(n).unwrap();
            precision.note(&point);
            points[0].push(point.v1);
            points[1].push(point.v2);
        }
        bound([&points[0], &points[1]], &directions, n, precision.touch())
    }

    #[test]
    fn balls_and_capsules_have_their_own_depth() {
        let mut r = Random::new(1);
        for _ in 0..500 {
            let (p, q) = (r.within(0.3, 1.0), r.within(0.3, 1.0));
            let (at, by) = (r.vector(10.0), r.vector(0.1));
            let n = (-by).normalize();
            let tell = |a: &Shape, b: &Shape, n: &Vec3, r: &mut Random| {
                let found = told([a, b], n, 60, r).unwrap();
                for (shape, sign, p) in [(a, 1.0, found.points[0]), (b, -1.0, found.points[1])] {
                    let d = n * sign;
                    assert!((shape(&d) - p).dot(&d).abs() < 1000.0 * EPSILON);
                }
                found.lower
            };
            let round = (ball(at, p), ball(at + by, q));
            let depth = p + q - by.norm();
            let lower = tell(&round.0, &round.1, &n, &mut r);
            assert!(lower <= depth + 40.0 * EPSILON && lower > depth - 2000.0 * EPSILON);
            // Capsules along each other, moved across: the minima form an arc.
            let axis = r.direction();
            let side = axis.cross(&by);
            let rods = (
                capsule(at - axis, at + axis, p),
                capsule(at - axis * 0.8 + side, at + axis * 0.7 + side, q),
            );
            let depth = p + q - side.norm();
            let lower = tell(&rods.0, &rods.1, &(-side).normalize(), &mut r);
            assert!(lower <= depth + 40.0 * EPSILON && lower > depth - 2000.0 * EPSILON);
        }
    }

    /// A ball from which something is cut, what only looks like a ball, and what has corners: a
    /// vertex counts as a ball without extent.
    #[test]
    fn no_other_body_is_believed_to_be_a_ball() {
        let mut r = Random::new(2);
        let half = |d: &Vec3| {
            let rim = Vec3::new(d.x, d.y, 0.0);
            if d.z > 0.0 { rim.normalize() } else { *d }
        };
        let cut = |d: &Vec3| {
            let rim = Vec3::new(d.x, d.y, 0.0).normalize() * (0.36 as Real).sqrt();
            if d.z > 0.8 { rim + Vec3::z() * 0.8 } else { *d }
        };
        let off = if EPSILON > 1e-10 { 1e-3 } else { 1e-8 };
        let others: [Shape; 4] = [
            Box::new(half),
            Box::new(cut),
            ellipsoid(Vec3::new(1.0 + off, 1.0, 1.0), r.rotation(), Vec3::zeros()),
            hull(&corners(Vec3::repeat(1.0))),
        ];
        let round = ball(Vec3::zeros(), 1.0);
        for (least, other) in [1.0, 1.8, 2.0, 2.0].iter().zip(&others) {
            for _ in 0..200 {
                let n = r.direction();
                for pair in [[other, &round], [&round, other]] {
                    if let Some(found) = told(pair, &n, 200, &mut r) {
                        assert!(found.lower <= *least, "{} > {least}", found.lower);
                    }
                }
            }
        }
        // Nor is a ball from few points.
        assert!(told([&round, &round], &Vec3::x(), ROUND - 1, &mut r).is_none());
    }

    /// What has a ball and more is no less deep than the ball.
    #[test]
    fn a_tip_takes_nothing_from_a_ball() {
        let mut r = Random::new(3);
        let drop: Shape = Box::new(|d: &Vec3| {
            let tip = Vec3::z() * 2.0;
            if tip.dot(d) > 1.0 { tip } else { *d }
        });
        for _ in 0..200 {
            let found = told([&drop, &drop], &Vec3::x(), 60, &mut r).unwrap();
            assert!(
                (found.lower - 2.0).abs() < 200.0 * EPSILON,
                "{}",
                found.lower
            );
        }
    }
}
