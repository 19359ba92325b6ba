// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The centre of pressure: the one point that stands for all of a contact.
//!
//! # Derivation
//!
//! *What it is.* Let n be the contact's unit normal and r a place in the plane across n. Above
//! r the two objects share a chord of length δ(r), the local depth. The centre of pressure
//!
//! ```text
//! c = ∫ δ(r) r dA / ∫ δ(r) dA,   δ > 0,
//! ```
//!
//! is the centroid of the volume that they share, but for its height. It moves as the objects
//! do, where a deepest point jumps from corner to corner. A force in c, along n, as large as the
//! volume is the sum and the moment of a force δ(r) per area.
//!
//! *The local depth.* The depth is d = h1 + h2, the distance of the two support planes. An object
//! is lower than its plane by a convex function, low(r), and δ = d − low1 − low2. At the deepest
//! place r* both are 0, so along each ray from there δ falls from d, the steeper the farther.
//!
//! *What is asked.* Four support points of D, [`TILT`] aside of n, a right angle apart: of each
//! object the four points that reach farthest around. Of a box's face they are its corners, each
//! the farthest over a right angle; of a round one they lie evenly around, so that c leaves r* as
//! little as the truth does. Nothing else enters, though more points may be known: those lie where
//! the search came from, and would pull c there.
//!
//! *Fans.* The points of an object, seen from r*, are the corners of a fan of triangles, in each of
//! which low is linear. The integrals over two fans are in closed form: [`crate::contacts::fan`].
//!
//! *Roundness.* A round face is lower by ½ R t² where it is asked with the tilt t, all around: a part
//! of what all corners have in common is taken off, [`LEVEL`]. All of it would be right for a sphere;
//! of the strip along which a cylinder lies the depth falls by the square, not linearly, and the rest
//! makes up for that.

use crate::contact::Penetration;
use crate::contacts::fan::{Corner, Fan, pressed};
use crate::contacts::polygon::{Flat, side};
use crate::known::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{EPSILON, POLE, Real, Vec3, axes, larger, lesser};

/// The tilt of the directions asked, as a tangent, is this times the root of depth / extent: so a
/// round face of that radius, or half of it, is seen no lower than half the depth, and of a flat one
/// that leans by a depth over its width all corners. Measured (`extension/pressure.c`): ÷1.2 a corner of
/// a leaning box is missed, ×1.2 a cone on its side steps by 7 mm.
const TILT: Real = 1.8;
/// At most: 14°, for what is deeper than a fiftieth of its extent.
const MOST: Real = 0.25;
/// The slope of flanks that nothing is known of. Insensitive: 2 to 8 tried.
const FLANK: Real = 4.0;
/// By how much, in units of the depth, corners are moved outwards, so that a fan has an area and the
/// deepest place is inside. Small beside 1 / [`FLANK`].
const HAIR: Real = 1.0 / 512.0;
/// A face has more than four corners where the deepest place lies beyond a side of four by this share
/// of their area. Of a disc it is up to a tenth.
const BEYOND: Real = 0.02;
/// What ends within this share of the smaller object's extent is a point: the centre of pressure is
/// within a quarter of that.
const POINT: Real = 0.016;
/// Share of what all corners are lower by that is taken off. Measured: 0 lets a lying capsule step by 5 mm, 1
/// leaves it 7 mm off.
const LEVEL: Real = 0.75;

/// Directions: four a right angle apart at even places, and four between them.
const WAYS: usize = 8;
/// Their cosines and sines in the plane's axes. Of a box whose axes are the world's no two corners
/// are as far in any of the four.
const CIRCLE: [Flat; WAYS] = {
    const X: Real = 11.0 / 61.0;
    const Y: Real = 60.0 / 61.0;
    const H: Real = core::f64::consts::FRAC_1_SQRT_2 as Real;
    const U: Real = (X - Y) * H;
    const V: Real = (X + Y) * H;
    [
        [X, Y],
        [U, V],
        [-Y, X],
        [-V, U],
        [-X, -Y],
        [-U, -V],
        [Y, -X],
        [V, -U],
    ]
};

/// Directions and the points of both objects that were found along them.
pub type Asked<'a> = (&'a [Vec3], &'a [[Vec3; 2]]);
/// A point that was found no farther aside of a direction than this, in tilts, is the one that would
/// be found there: less than the ÷1.2 and ×1.2 of [`TILT`] that are seen.
const SAME: Real = 0.1;

/// The four directions around a deepest place whose points all lie in the face of D there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Around {
    /// How low they may be, metres.
    pub low: Real,
    /// Unit; zero where one was lower.
    pub directions: [Vec3; WAYS / 2],
    /// What they found, in the plane.
    pub points: [Flat; WAYS / 2],
}

/// The plane across the normal, at the deepest place.
struct View {
    /// A point half-way between the support planes.
    middle: Vec3,
    /// The unit of lows, metres, and its inverse.
    depth: Real,
    share: Real,
    /// How far the support planes are from the middle, in units of that.
    half: Real,
    n: Vec3,
    axes: [Vec3; 2],
    /// For unit directions: n, and the tilt.
    up: Vec3,
    tilt: Real,
}

impl View {
    /// Asks in the `k`th direction: obj1's corner there, and obj2's, which is asked the other way.
    #[inline(always)]
    fn ask<A: SupportMap, B: SupportMap>(
        &self,
        md: &MinkowskiDifference<A, B>,
        k: usize,
        known: Option<&Asked>,
    ) -> Result<[Corner; 2], Fault> {
        let [x, y] = CIRCLE[k % WAYS];
        let [e1, e2] = &self.axes;
        let d = self.direction(k);
        let [v1, v2] = match known.and_then(|known| self.seen(known, &d)) {
            Some(points) => points,
            None => {
                let point = md.support(&d)?;
                [point.v1, point.v2]
            }
        };
        let hair = self.depth * HAIR;
        let corner = |p: &Vec3, sign: Real| {
            let p = p - self.middle;
            let hair = sign * hair;
            Corner {
                at: [e1.dot(&p) + hair * x, e2.dot(&p) + hair * y],
                low: larger(self.half - sign * self.n.dot(&p) * self.share, 0.0),
            }
        };
        Ok([corner(&v1, 1.0), corner(&v2, -1.0)])
    }

    /// What was found about there.
    #[cold]
    #[inline(never)]
    fn seen(&self, (directions, points): &Asked, d: &Vec3) -> Option<[Vec3; 2]> {
        let near2 = SAME * SAME * self.tilt * self.tilt;
        let is_same = |n: &Vec3| (d - n).norm_squared() <= near2;
        points.get(directions.iter().position(is_same)?).copied()
    }

    /// The `k`th direction, unit to its last bits.
    #[inline(always)]
    fn direction(&self, k: usize) -> Vec3 {
        let [x, y] = CIRCLE[k % WAYS];
        let [e1, e2] = &self.axes;
        let d = self.up + (e1 * (x * self.tilt) + e2 * (y * self.tilt));
        d * (1.5 - 0.5 * d.norm_squared())
    }

    /// What the corners of both fans make in D, if all of them are level.
    #[inline(never)]
    fn around(&self, one: &Fan, two: &Fan, around: &mut Around) {
        let (ones, twos) = (one.corners(), two.corners().iter().cycle().skip(WAYS / 4));
        let is_level = |(p, q): (&Corner, &Corner)| (p.low + q.low) * self.depth <= around.low;
        if !ones.iter().zip(twos.clone()).all(is_level) {
            return;
        }
        let places = around.directions.iter_mut().zip(&mut around.points);
        for (k, ((direction, point), (p, q))) in places.zip(ones.iter().zip(twos)).enumerate() {
            (*direction, *point) = (self.direction(2 * k), side(&q.at, &p.at));
        }
    }
}

/// The centre of pressure of a hit, in the middle of the chord there. Four support points, and four more where a face
/// has more than four corners. `centre`: the centres of the objects, where they are given. `known`: what
/// the query has asked. `around`: for who keeps the four.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
#[inline(never)]
pub fn centre<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    hit: &Penetration,
    centre: Option<&SupportPoint>,
    tolerance: Real,
    known: Option<&Asked>,
    around: Option<&mut Around>,
) -> Result<Vec3, Fault> {
    let n = hit.normal;
    let middle = hit.middle();
    let depth = larger(hit.depth, tolerance);
    let mut far2 = hit.extent;
    if let Some(c) = centre {
        far2[0] = larger((c.v1 - hit.point1).norm_squared(), far2[0]);
        far2[1] = larger((c.v2 - hit.point2).norm_squared(), far2[1]);
    }
    let far = lesser(far2[0], far2[1]).sqrt();
    let tilt = lesser(TILT * (depth / far).sqrt(), MOST);
    let share = 1.0 / (1.0 + tilt * tilt).sqrt();
    let view = View {
        middle,
        depth,
        share: 1.0 / depth,
        half: 0.5 * hit.depth / depth,
        n,
        // The same for the objects swapped.
        axes: axes(&(if POLE.dot(&n) < 0.0 { -n } else { n })),
        up: n * share,
        tilt: tilt * share,
    };
    let (mut one, mut two) = (Fan::default(), Fan::default());
    const HALF: usize = WAYS / 2;
    for i in 0..HALF {
        let [p, q] = view.ask(md, 2 * i, known)?;
        one.put(i, p);
        two.put((i + HALF / 2) % HALF, q);
    }
    if let Some(around) = around {
        view.around(&one, &two, around);
    }
    if one.is_point(POINT * far) || two.is_point(POINT * far) {
        return Ok(middle);
    }
    let is_beyond = [&one, &two].map(|fan| fan.is_beyond(BEYOND));
    if is_beyond[0] || is_beyond[1] {
        let mut between = [[Corner::default(); HALF]; 2];
        for i in 0..HALF {
            let [p, q] = view.ask(md, 2 * i + 1, None)?;
            between[0][i] = p;
            between[1][(i + HALF / 2) % HALF] = q;
        }
        let fans = [&mut one, &mut two].into_iter().zip(&between);
        for ((fan, between), _) in fans.zip(is_beyond).filter(|(_, is)| *is) {
            fan.interleave(between);
        }
    }
    let hair = larger(depth * HAIR, 64.0 * EPSILON * far);
    one.settle(LEVEL, hair);
    two.settle(LEVEL, hair);
    let Some(c) = pressed(&one, &two, depth * 0.5 / FLANK) else {
        return Ok(middle);
    };
    // Rounding may have it elsewhere, where a fan is a line.
    let (Some(low1), Some(low2)) = (one.low(&c), two.low(&c)) else {
        return Ok(middle);
    };
    let rise = 0.5 * depth * (lesser(low2, 1.0) - lesser(low1, 1.0));
    let [e1, e2] = &view.axes;
    let centre = middle + e1 * c[0] + e2 * c[1] + n * rise;
    // NaN where nothing is shared.
    Ok(if centre.norm_squared() < Real::INFINITY {
        centre
    } else {
        middle
    })
}

/// The squares of how far the objects are known to reach from their witness points, m².
#[inline(always)]
pub fn extent(points: impl Iterator<Item = [Vec3; 2]>, [p, q]: [&Vec3; 2]) -> [Real; 2] {
    let mut far2 = [0.0; 2];
    for [v1, v2] in points {
        far2[0] = larger((v1 - p).norm_squared(), far2[0]);
        far2[1] = larger((v2 - q).norm_squared(), far2[1]);
    }
    far2
}
