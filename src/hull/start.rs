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
//! a ball's distance to the tolerance. In a warm query the points of the last proof must tell of
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

use crate::known::support::SupportMap;
use crate::known::support_set::{Asked, Inquiry, Stop, SupportSet};
use crate::math::{Real, Vec3, larger, lesser, normalised, perpendicular, unit};

// Measured: support points of the MPR calls in the mean of sixteen pair sets and the recorded
// contacts (`cargo bench -p charts -- record`), when one number changes alone.

/// Steps on the ball. Measured: with 3 shallow ellipsoids take 11 % more, 10 change nothing.
const STEPS: usize = 6;
/// Steps on the ball that go no farther than the depth allows. Measured: with 1 misses take 5 %
/// more, without a bound the shallowest contacts of a random mix 20 %.
const ALLOWED: usize = 2;
/// A direction is tilted by this much of what leaves the known points no support value: at 1
/// itself a separation hardly shows. Measured: 1.05 to 1.3 are the same; without
/// the bound on a step to the ball's minimum contacts take 8 % more, misses 17 %.
const TILT: Real = 1.15;
/// |n′ − n|² above which a first direction has nothing to do with the way from the apex: 31
/// degrees. Measured for GJK: 0.6 costs hulls 2.5 % and contacts 1 %, 0.06 costs less than 1 %.
const AWAY: Real = 0.3;
/// Relative difference of e and e′ up to which two samples are of one ball. Measured: with
/// 0.03 shallow ellipsoids take 18 % more, with 0.3 the mean is 0.6 % more.
const ALIKE: Real = 0.1;
/// The square of the sine of the angle at one of three points below which they lie on a line.
/// Measured: warm ellipsoids take 20 % more without the ball, contacts 6 % with it for pairs
/// that it does not fit; 0.01 to 0.3 change neither by 0.3 %.
const BROAD: Real = 0.1;
/// The share of the size below which known points are no good measure of an extent. Insensitive: 0.01
/// and 0.2 tried, no pair set takes 0.1 % more.
const LITTLE: Real = 0.05;
/// What a tilt grows by each time that it was in vain; from then on the direction lies in the
/// plane. Measured: without the second and third misses take 4.6 % more, with a fourth the same.
const GROWTH: [Real; 3] = [1.0, 1.5, 2.25];
/// How wide a portal may be, for each unit of the origin's distance from its edge, and of the
/// edge's length. Measured: 2 and 3 for the first cost deep boxes and small motions 0.5 and
/// 2 %; 0.3 to 0.9 for the second change contacts by 0.7 %.
const WIDE: [Real; 2] = [2.5, 0.6];

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
pub fn radius([n, n_]: [&Vec3; 2], between: &Vec3, rounding: Real) -> Option<Real> {
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
    pub h: Real,
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
    radius: Real,
}

impl Ball {
    /// With this lowest sample.
    pub fn known<const P: usize>(set: &SupportSet<P>, low: usize, radius: Real) -> Self {
        let low = Sample::of(set.direction(low), set.v(low));
        Self { low, radius }
    }

    /// The lowest sample.
    pub fn low(&self) -> &Sample {
        &self.low
    }

    /// The radius, metres.
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Around the apex.
    #[inline(always)]
    pub fn around(apex: &Vec3, low: Sample) -> Self {
        let radius = low.n.dot(&(low.s - apex));
        Self { low, radius }
    }

    /// Do these samples tell of a ball too, as one does with the lowest? Not where they lie on a line with
    /// that: a capsule or an edge over an edge is round in one direction alone.
    #[inline(always)]
    pub fn is_known(&mut self, samples: impl Iterator<Item = Sample>, rounding: Real) -> bool {
        let mut first = None;
        let mut last = Vec3::zeros();
        for Sample { n, s, .. } in samples {
            last = s - self.low.s;
            first = first.or(Some(last));
            match radius([&self.low.n, &n], &last, rounding) {
                Some(radius) => self.radius = radius,
                None => return false,
            }
        }
        first.is_some_and(|a| {
            a.cross(&last).norm_squared() > BROAD * (a.norm_squared() * last.norm_squared())
        })
    }

    /// Is this sample of one ball with the lowest?
    #[inline(always)]
    pub fn is_of(&self, n: &Vec3, s: &Vec3, rounding: Real) -> bool {
        radius([&self.low.n, n], &(s - self.low.s), rounding).is_some()
    }

    /// Across the direction of the lowest sample, from the origin; and how far the origin is from the
    /// centre along it.
    #[inline(always)]
    fn aside(&self) -> (Vec3, Real) {
        let Self { low, radius } = self;
        (low.s - low.n * low.h, radius - low.h)
    }

    /// Is the ball's minimum no lower? It is by off² / 2 ahead, about.
    #[inline(always)]
    pub fn is_lowest(&self, within: Real) -> bool {
        let (across, ahead) = self.aside();
        !(across.norm_squared() > 0.5 * within * ahead)
    }

    /// Where to ask for the ball's minimum, in step number `step`; not unit.
    #[inline(always)]
    pub fn aim(&self, step: usize) -> Option<Vec3> {
        let (across, ahead) = self.aside();
        let off2 = across.norm_squared();
        // Samples 45 degrees apart are no neighbours.
        if step == 0 && off2 > ahead * ahead {
            return None;
        }
        // From the ball's centre through the origin; the first steps, which may tell a miss, as
        // far as the depth allows. (All: contacts of a micrometre take 20 % more.)
        let least = if step < ALLOWED {
            off2 / (TILT * self.low.h)
        } else {
            0.0
        };
        Some(self.low.n * larger(ahead, least) - across)
    }

    /// Goes to the minimum of the ball, and learns from where it is. `ask` answers along a direction,
    /// or beside it, with the rounding there. The ball, if D is one.
    #[inline(always)]
    pub fn followed(
        mut self,
        within: impl Fn(Real) -> Real,
        mut ask: impl FnMut(&Vec3) -> Result<Option<(Sample, Real)>, Stop>,
    ) -> Result<Option<Self>, Stop> {
        let mut smooth = false;
        for step in 0..STEPS {
            if self.is_lowest(within(self.low.h)) {
                smooth = true;
                break;
            }
            let Some(n) = self.aim(step).and_then(|way| normalised(&way)) else {
                break;
            };
            let Some((new, rounding)) = ask(&n)? else {
                return Ok(None);
            };
            let radius = radius([&self.low.n, &new.n], &(new.s - self.low.s), rounding);
            smooth = radius.is_some();
            self.radius = radius.unwrap_or(self.radius);
            if new.h < self.low.h {
                self.low = new;
            }
            if !(smooth && self.radius > 1.05 * self.low.h) {
                break;
            }
        }
        Ok(smooth.then_some(self))
    }
}

/// The apex and three points around the ball's direction: the known point farthest aside,
/// and two asked for; all three where none is known.
#[inline(always)]
pub fn ring<A: SupportMap, B: SupportMap, const P: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<P>,
    ball: &Ball,
    tolerance: Real,
) -> Result<[usize; 4], Stop> {
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
    let tie = inquiry.precision.tie();
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
    let (cos, sin) = (-0.5, 0.75_f64.sqrt() as Real);
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
    Ok(names)
}

/// How far the direction of the lowest support plane, of this depth, is tilted towards an origin that
/// is `off` the known points or an edge, as seen along the axis; `off` and `span` of the edge; `length`: from
/// the apex to where the axis leaves D, about.
#[inline(always)]
pub fn tilt(depth: Real, off: Real, wide: Real, span: Real, length: Real) -> Real {
    let wide = larger(WIDE[0] * wide, WIDE[1] * span);
    lesser(TILT * depth / off, wide / length)
}

/// What a tilt grows by after so many in vain; `None`: there is nothing wider to try but the plane.
#[inline(always)]
pub fn growth(vain: usize) -> Option<Real> {
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
    measure: impl Fn(&Vec3) -> Real,
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
