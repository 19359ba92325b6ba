// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The first tetrahedron of the global search: a point inside D, the *apex*, and three
//! support points where the minimum is likely to be.
//!
//! A small first polytope around the right place saves support points: faces far from
//! the origin never need to be expanded. Two kinds of places are told apart.
//!
//! *Round.* As long as D looks like a ball, with s(n) = m + ρn, the minimum of h is along
//! −m, of depth ρ − |m|. The apex is the first m; a pair of samples (n, s), (n′, s′) tells
//! the radius: e = n′·(s′ − s) and e′ = n·(s − s′) are what each exceeds the other's
//! support plane by, for a ball both are ½ρ|n′ − n|², and ρ = (e + e′) / |n′ − n|². Where
//! the next step promises less than a quarter of the tolerance, three points in a ring
//! around the last direction are the face; the ring is as wide as a face may be that bounds
//! a ball's distance to the tolerance. The lowest point and the two that were found nearest to it must tell of
//! one ball: else the pair is not round.
//!
//! *Else* a small portal ([`crate::hull::portal`]): seen along the axis from the apex through the
//! origin, D is flat and the origin a point of the plane, and a triangle around it is wanted. That is GJK
//! in the plane: from the point or edge nearest to the origin, ask towards the origin. A
//! direction that lies in the plane is MPR's first portal, a quarter turn wide; here the
//! direction of the lowest support plane is tilted that way. How wide a portal may be bounds
//! the tilt; and where it brings nothing it grows, up to the plane itself.
//!
//! *No tilt is wider than the depth allows.* Let n be a direction of the support value h, and
//! the known points no farther along it, and w short of the origin as seen along the axis, or
//! across n. Along n tilted by h / w they have no positive support value: if the minimum is
//! this side of there, it is what lies beyond those points that holds it back, and if nothing
//! does the objects are apart. That tilt is small where a contact is shallow, and where n is
//! near the minimum, as a state has it.

use crate::hull::expansion::Limits;
use crate::known::support_set::{Asked, Inquiry, Lowest, Stop, SupportSet};
use crate::math::{Vec3, larger, lesser, normalised, perpendicular, unit};
use crate::minkowski::support::SupportMap;

// Measured: support points of the MPR calls in the mean of sixteen pair sets and the recorded
// contacts (`cargo bench -p charts -- record`), when one number changes alone.

/// Steps on the ball. Measured: with 3 shallow ellipsoids take 5 % more.
const STEPS: usize = 6;
/// A direction is tilted by this much of what leaves the known points no support value: at 1
/// itself a separation hardly shows. Measured: with 1.3 contacts take 0.6 % more instructions.
const TILT: f64 = 1.15;
/// |n′ − n|² above which two directions have nothing to do with each other: 31 degrees. Measured for GJK: 0.6
/// costs hulls 2.5 % and contacts 1 %, 0.06 costs less than 1 %; for the ball 0.06 costs shallow
/// ellipsoids 3 %.
const AWAY: f64 = 0.3;
/// Relative difference of e and e′ up to which two samples are of one ball. Measured: with
/// 0.03 shallow ellipsoids take 5 % more, with 0.3 shallow capsules 7 %.
const ALIKE: f64 = 0.1;
/// The square of the sine of the angle at one of three points below which they lie on a line.
/// Measured: with 0.01 capsules in motion take 2 % more, with 0.3 ellipsoids 3 %.
const BROAD: f64 = 0.1;
/// The share of the size below which known points are no good measure of an extent. Insensitive: 0.01
/// and 0.2 tried, no pair set takes 0.1 % more.
const LITTLE: f64 = 0.05;
/// What a tilt grows by each time that it was in vain; from then on the direction lies in the
/// plane. Measured: without the second and third misses take 4.6 % more, with a fourth the same.
const GROWTH: [f64; 3] = [1.0, 1.5, 2.25];
/// How wide a portal may be, for each unit of the origin's distance from its edge, and of the
/// edge's length. Measured on the recorded contacts: 2 and 2.5 for the first cost hits 0.3 and 0.5 % of their
/// instructions; 0.45 and 0.8 for the second 0.5 and 0.7 %.
const WIDE: [f64; 2] = [3.0, 0.6];

/// Is a direction so far from another that samples along the two are no neighbours?
#[inline(always)]
pub fn is_far(n: &Vec3, other: &Vec3) -> bool {
    (n - other).norm_squared() > AWAY
}

/// The numbers of three points of the first `count`, whose triangle the axis from the apex goes through, if
/// there are such: in a warm query of a pair that has moved little, the corners of the last proof's
/// nearest face.
#[inline(always)]
pub fn known(apex: &Vec3, count: usize, point: impl Fn(usize) -> Vec3) -> Option<[usize; 3]> {
    const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    // The last corner is the greatest number.
    TRIANGLES
        .into_iter()
        .filter(|[_, _, k]| *k < count)
        .find(|names| {
            let [a, b, c] = names.map(&point);
            // The origin is on the same side of all planes through the apex and an edge. (Where two
            // points are one, it is on opposite sides of two.)
            let x = apex.dot(&a.cross(&b));
            let y = apex.dot(&b.cross(&c));
            let z = apex.dot(&c.cross(&a));
            x >= 0.0 && y >= 0.0 && z >= 0.0 || x <= 0.0 && y <= 0.0 && z <= 0.0
        })
}

/// The radius that two samples tell, from their directions and the way from one to the other, if they
/// are of one ball.
#[inline(always)]
pub fn radius([n, n_]: [&Vec3; 2], between: &Vec3, rounding: f64) -> Option<f64> {
    let (e, e_) = (n_.dot(between), -n.dot(between));
    let sum = e + e_;
    let alike = (e - e_).abs() <= ALIKE * sum && sum > rounding;
    alike.then(|| sum / (n_ - n).norm_squared())
}

/// A support point, the unit direction that found it, and its support value.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The direction.
    pub n: Vec3,
    /// The point.
    pub s: Vec3,
    /// n·s, metres.
    pub h: f64,
}

impl Sample {
    /// Of a point that `n` found.
    #[inline(always)]
    pub fn of(n: Vec3, s: Vec3) -> Self {
        Self { n, s, h: n.dot(&s) }
    }
}

/// A ball that D looks like: its centre is s − radius · n.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// The lowest sample.
    low: Sample,
    /// What the last two samples tell, metres.
    radius: f64,
}

impl Ball {
    /// The one that known points tell of: the lowest, and the two whose directions are nearest, not where
    /// these lie on a line: a capsule or an edge over an edge is round in one direction alone.
    #[inline(always)]
    pub fn seen(
        samples: impl Iterator<Item = Sample> + Clone,
        dir: &Vec3,
        rounding: f64,
    ) -> Option<Self> {
        let low = samples.clone().find(|sample| sample.n == *dir)?;
        let mut near = [(AWAY, Vec3::zeros(), 0.0); 2];
        for Sample { n, s, .. } in samples {
            let far2 = (n - low.n).norm_squared();
            let between = s - low.s;
            if far2 > 0.0 && far2 < near[1].0 {
                near[1] = (
                    far2,
                    between,
                    radius([&low.n, &n], &between, rounding).unwrap_or(0.0),
                );
                if far2 < near[0].0 {
                    near.swap(0, 1);
                }
            }
        }
        let [(_, a, radius), (_, b, other)] = near;
        let broad = a.cross(&b).norm_squared() > BROAD * (a.norm_squared() * b.norm_squared());
        (radius > 0.0 && other > 0.0 && broad).then_some(Self { low, radius })
    }

    /// The one around the apex.
    #[inline(always)]
    fn around(apex: &Vec3, low: Sample) -> Self {
        let radius = low.n.dot(&(low.s - apex));
        Self { low, radius }
    }

    /// Is the ball's minimum no lower? It is by off² / 2 ahead, about.
    #[inline(always)]
    fn is_lowest(&self, within: f64) -> bool {
        let (across, ahead) = self.aside();
        !(across.norm_squared() > 0.5 * within * ahead)
    }

    /// Across the direction of the lowest sample, from the origin; and how far the origin is from the
    /// centre along it.
    #[inline(always)]
    fn aside(&self) -> (Vec3, f64) {
        let Self { low, radius } = self;
        (low.s - low.n * low.h, radius - low.h)
    }
}

/// The apex and three points around the direction of the ball that D looks like, if it does: the known point
/// farthest aside, and two asked for; all three where none is known.
#[inline(always)]
pub fn ring<A: SupportMap, B: SupportMap, const P: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<P>,
    limits: &Limits,
) -> Result<Option<[usize; 4]>, Stop> {
    let tie = inquiry.precision.tie();
    let tolerance = inquiry.precision.tolerance(limits.tolerance);
    let within = |depth| larger(limits.gap * depth, tolerance);
    let Lowest { depth, dir } = inquiry.lowest;
    let sample = |i: usize| Sample::of(set.direction(i), set.v(i));
    let seen = match set.len() {
        2 => Some(Ball::around(&set.v(0), sample(1))).filter(|ball| ball.is_lowest(within(depth))),
        len => Ball::seen((1..len).map(sample), &dir, tie),
    };
    let Some(mut ball) = seen else {
        return Ok(None);
    };
    let mut smooth = true;
    for _ in 0..STEPS {
        if ball.is_lowest(within(ball.low.h)) {
            break;
        }
        let (across, ahead) = ball.aside();
        // From the ball's centre through the origin.
        let Some(n) = normalised(&(ball.low.n * ahead - across)).filter(|_| !set.is_full()) else {
            return Ok(None);
        };
        let Asked { h, v: s, .. } = inquiry.ask(set, &n)?;
        let radius = radius([&ball.low.n, &n], &(s - ball.low.s), tie);
        smooth = radius.is_some();
        ball.radius = radius.unwrap_or(ball.radius);
        if h < ball.low.h {
            ball.low = Sample { n, s, h };
        }
        if !(smooth && ball.radius > 1.05 * ball.low.h) {
            break;
        }
    }
    if !smooth {
        return Ok(None);
    }
    let tolerance = within(inquiry.lowest.depth);
    // The middle of a triangle with corners at this angle lies a tolerance below the ball.
    let tilt = (2.0 * tolerance / (ball.low.h + tolerance)).sqrt();
    let tilt = tilt.clamp(2e-4, 0.3);
    let (mut aside, mut farthest, mut old) = (Vec3::zeros(), 0.0, 0);
    for i in 1..set.len() {
        let v = set.v(i);
        let across = v - ball.low.n * ball.low.n.dot(&v);
        let far2 = across.norm_squared();
        if far2 > farthest && v != ball.low.s {
            (aside, farthest, old) = (across, far2, i);
        }
    }
    if !(farthest > tie * tie) {
        old = 0;
    }
    // A short way aside is only across to rounding: once more.
    let a = match unit(&(aside - ball.low.n * ball.low.n.dot(&aside))) {
        Some(a) if old > 0 => a,
        _ => perpendicular(&ball.low.n),
    };
    let b = ball.low.n.cross(&a);
    // A third of a turn apart.
    let (cos, sin) = (-0.5, 0.75_f64.sqrt() as f64);
    let by = 1.0 / (1.0 + tilt * tilt).sqrt();
    let mut names = [0, 0, 0, old];
    for (name, (x, y)) in names[1..]
        .iter_mut()
        .zip([(cos, sin), (cos, -sin), (1.0, 0.0)])
    {
        if *name == 0 {
            let n = (ball.low.n + (a * x + b * y) * tilt) * by;
            *name = inquiry.ask(set, &n)?.i;
        }
    }
    Ok(Some(names))
}

/// How far the direction of the lowest support plane, of this depth, is tilted towards an origin that
/// is `off` the known points or an edge, as seen along the axis; `off` and `span` of the edge; `length`: from
/// the apex to where the axis leaves D, about.
#[inline(always)]
pub fn tilt(depth: f64, off: f64, wide: f64, span: f64, length: f64) -> f64 {
    let wide = larger(WIDE[0] * wide, WIDE[1] * span);
    lesser(TILT * depth / off, wide / length)
}

/// What a tilt grows by after so many in vain; `None`: there is nothing wider to try but the plane.
#[inline(always)]
pub fn growth(vain: usize) -> Option<f64> {
    GROWTH.get(vain).copied()
}

/// Is there nothing wider to try, after so many tilts in vain?
#[inline(always)]
pub fn is_widest(vain: usize) -> bool {
    vain >= GROWTH.len()
}

/// A tetrahedron of known support points, the largest in sight, and of new ones where
/// these have no extent: for D that is thin, and for an apex that was no point of D.
///
/// `None` where D is flat to rounding and no direction that was asked has shown a touch.
#[cold]
#[inline(never)]
pub fn solid<A: SupportMap, B: SupportMap, const P: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<P>,
) -> Result<Option<[usize; 4]>, Stop> {
    let a = 1;
    let va = set.v(a);
    let b = extent(inquiry, set, a, &inquiry.lowest.dir.clone(), |v| {
        (v - va).norm()
    })?;
    let Some(along) = unit(&(set.v(b) - va)) else {
        return Ok(None);
    };
    let across = |v: &Vec3| (v - va) - along * along.dot(&(v - va));
    let c = extent(inquiry, set, a, &perpendicular(&along), |v| {
        across(v).norm()
    })?;
    let Some(normal) = unit(&along.cross(&across(&set.v(c)))) else {
        return Ok(None);
    };
    let d = extent(inquiry, set, a, &normal, |v| normal.dot(&(v - va)).abs())?;
    Ok(Some([a, b, c, d]))
}

/// The point that is farthest by `measure`: of the known ones, and where these measure
/// little of the support points along `n` and `-n`.
fn extent<A: SupportMap, B: SupportMap, const P: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<P>,
    from: usize,
    n: &Vec3,
    measure: impl Fn(&Vec3) -> f64,
) -> Result<usize, Stop> {
    let rounding = inquiry.precision.tie();
    let mut best = (from, rounding);
    for i in 1..set.len() {
        let m = measure(&set.v(i));
        if m > best.1 {
            best = (i, m);
        }
    }
    if !(best.1 > LITTLE * inquiry.precision.size()) {
        // Towards the origin first.
        let inward = if set.v(from).dot(n) > 0.0 { -n } else { *n };
        for n in [inward, -inward] {
            let Asked { i, v, .. } = inquiry.ask(set, &n)?;
            let m = measure(&v);
            if m > best.1 {
                best = (i, m);
            }
        }
    }
    // Where D is no wider than rounding that is `from`, and no tetrahedron comes of it.
    Ok(best.0)
}
