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
//! *What is asked.* Of an object four points, [`TILT`] aside of n, a right angle apart: those that reach
//! farthest around. Of a box's face they are its corners, each the farthest over a right angle; of a
//! round one they lie evenly around, so that c leaves r* as little as the truth does. Where they are
//! not the whole face more is asked: [`crate::contacts::view`]. Other points enter only as a floor
//! ([`crate::contacts::seen`]): where known points of one object lie in its support plane all around what
//! the other has there, no corner of that floor matters, and that object is not asked. As corners they
//! would not do: they lie where the search came from, and would pull c there.
//!
//! *Fans.* The points of an object, seen from r*, are the corners of a fan of triangles, in each of
//! which low is linear. The integrals over two fans are in closed form: [`crate::contacts::fan`].
//!
//! *Roundness.* A round face is lower by ½ R t² where it is asked with the tilt t, all around: a part
//! of what all corners have in common is taken off, [`LEVEL`]. All of it would be right for a sphere;
//! of the strip along which a cylinder lies the depth falls by the square, not linearly, and the rest
//! makes up for that.

use crate::contact::Penetration;
use crate::contacts::fan::{Corner, Fan, pressed, pressed_on_plane};
use crate::contacts::polygon::{Flat, side};
use crate::contacts::seen::{Outline, Seen, across};
use crate::contacts::view::{CIRCLE, FOUR, Four, View, WAYS};
use crate::known::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::math::{EPSILON, Real, Vec3, larger, lesser};

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
/// A point that was found no farther aside of a direction than this, in tilts, is the one that would
/// be found there: less than the ÷1.2 and ×1.2 of [`TILT`] that are seen.
const SAME: Real = 0.1;

/// The four directions around a deepest place whose points all lie in the face of D there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Around {
    /// How low they may be, metres.
    pub low: Real,
    /// Unit; zero where one was lower, or not asked for.
    pub directions: [Vec3; FOUR],
    /// What they found, in the plane.
    pub points: [Flat; FOUR],
}

impl Around {
    /// Of the four corners of either object.
    #[inline(never)]
    fn fill(&mut self, view: &View, [one, two]: [&Four; 2]) {
        for k in 0..FOUR {
            let (p, q) = (&one[k], &two[(k + FOUR / 2) % FOUR]);
            if !((p.low + q.low) * view.depth <= self.low) {
                self.directions = [Vec3::zeros(); FOUR];
                return;
            }
            self.directions[k] = view.direction(&view.way(2 * k), view.cosine);
            self.points[k] = side(&q.at, &p.at);
        }
    }
}

/// What is known of a pair besides the hit, and for whom the directions are kept that are asked.
pub struct Aside<'a> {
    /// The centres of the objects, where they are given.
    pub centre: Option<&'a SupportPoint>,
    /// What the search has seen.
    pub seen: &'a Seen,
    /// The directions of a state that stands, which found [`Seen::Standing`].
    pub others: &'a [Vec3],
    /// For who keeps the four.
    pub around: Option<&'a mut Around>,
}

/// What has been found of both objects.
enum Found {
    /// One is a point.
    Point,
    /// This one is on the other's floor.
    On(usize),
    /// The corners of both.
    Both,
}

/// The objects as they are seen from the deepest place.
struct Faces<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    view: View,
    seen: &'q Seen,
    others: &'q [Vec3],
    fans: [Fan; 2],
    hair: Real,
    /// What ends within it is a point, metres.
    point: Real,
}

impl<A: SupportMap, B: SupportMap> Faces<'_, A, B> {
    /// What the search found about there.
    #[inline]
    fn found(&self, d: &Vec3) -> Option<[Vec3; 2]> {
        let Seen::Standing(found) = self.seen else {
            return None;
        };
        let near2 = SAME * SAME * self.view.tilt * self.view.tilt;
        let is_same = |n: &Vec3| (d - n).norm_squared() <= near2;
        found.get(self.others.iter().position(is_same)?).copied()
    }

    /// A corner a hair beyond its place, towards where it was asked for.
    fn moved(&self, corner: &Corner, k: usize) -> Corner {
        let [x, y] = CIRCLE[k % WAYS];
        Corner {
            at: [corner.at[0] + self.hair * x, corner.at[1] + self.hair * y],
            low: corner.low,
        }
    }

    fn put(&mut self, object: usize, four: &Four) {
        for (i, corner) in four.iter().enumerate() {
            self.fans[object % 2].put(i, self.moved(corner, 2 * i));
        }
    }

    fn interleave(&mut self, object: usize, mut four: Four) {
        for (i, corner) in four.iter_mut().enumerate() {
            *corner = self.moved(corner, 2 * i + 1);
        }
        self.fans[object % 2].interleave(&four);
    }

    /// Asks an object for its corners: the first four, and what else it has there; `false` of a point.
    #[inline(never)]
    fn look(&mut self, object: usize, four: &mut Four) -> Result<bool, Fault> {
        *four = self.view.four(self.md, object, 0, &|d| self.found(d))?;
        self.put(object, four);
        let fan = &self.fans[object % 2];
        if fan.is_point(self.point) {
            return Ok(false);
        }
        let is_beyond = fan.is_beyond(BEYOND);
        let face = match self.view.twice(four) {
            Some(twice) => self.view.fourth(self.md, object, four, twice)?,
            None => None,
        };
        if let Some(face) = face {
            self.put(object, &face);
        } else if is_beyond {
            let between = match self.view.rim(four) {
                Some(between) => between,
                None => self.view.four(self.md, object, 1, &|_| None)?,
            };
            self.interleave(object, between);
        }
        Ok(true)
    }

    /// Is all that an object shares on the floor?
    fn is_on(&self, object: usize, floor: &Outline) -> bool {
        let mut corners = self.fans[object % 2].corners().iter();
        // What is lower than the depth is on the way to it.
        corners.all(|c| {
            floor.holds(&if c.low > 1.0 {
                c.at.map(|x| x / c.low)
            } else {
                c.at
            })
        })
    }

    /// The same of an object with four corners that lie on a rim: it has eight.
    fn round_off(&mut self, object: usize, four: &Four) {
        if self.fans[object % 2].corners().len() == FOUR {
            if let Some(between) = self.view.rim(four) {
                self.interleave(object, between);
            }
        }
    }

    /// The corners of both objects, as far as they matter.
    fn look_at_both(
        &mut self,
        first: usize,
        floor: Option<&Outline>,
        around: Option<&mut Around>,
    ) -> Result<Found, Fault> {
        let other = (1 + first) % 2;
        let mut four = [Four::default(); 2];
        if !self.look(first, &mut four[0])? {
            return Ok(Found::Point);
        }
        if floor.is_some_and(|floor| self.is_on(first, floor)) {
            return Ok(Found::On(first));
        }
        if !self.look(other, &mut four[1])? {
            return Ok(Found::Point);
        }
        self.round_off(first, &four[0]);
        self.round_off(other, &four[1]);
        if let Some(around) = around {
            around.fill(&self.view, [&four[first % 2], &four[other % 2]]);
        }
        Ok(Found::Both)
    }
}

/// The centre of pressure of a hit, in the middle of the chord there. Two support points where the search
/// has seen a floor, else four, and one or two more where a face has more than four corners.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
#[inline(never)]
pub fn centre<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    hit: &Penetration,
    tolerance: Real,
    aside: Aside,
) -> Result<Vec3, Fault> {
    let n = hit.normal;
    let middle = hit.middle();
    let depth = larger(hit.depth, tolerance);
    let mut far2 = hit.extent;
    if let Some(c) = aside.centre {
        far2[0] = larger((c.v1 - hit.point1).norm_squared(), far2[0]);
        far2[1] = larger((c.v2 - hit.point2).norm_squared(), far2[1]);
    }
    let far = lesser(far2[0], far2[1]).sqrt();
    let tilt = lesser(TILT * (depth / far).sqrt(), MOST);
    let hair = larger(depth * HAIR, 64.0 * EPSILON * far);
    let mut faces = Faces {
        md,
        view: View {
            middle,
            depth,
            share: 1.0 / depth,
            half: 0.5 * hit.depth / depth,
            n,
            axes: across(&n),
            tilt,
            cosine: 1.0 / (1.0 + tilt * tilt).sqrt(),
            near: 2.0 * hair,
        },
        seen: aside.seen,
        others: aside.others,
        fans: [Fan::default(), Fan::default()],
        hair,
        point: POINT * far,
    };
    // The smaller one, or that on the floor.
    let smaller = usize::from(far2[1] < far2[0]);
    let (first, floor) = match aside.seen {
        Seen::Floor(floor) => (1 - floor.object, Some(floor.seen(&faces.view.axes))),
        _ => (smaller, None),
    };
    let rim = depth * 0.5 / FLANK;
    let found = faces.look_at_both(first, floor.as_ref(), aside.around)?;
    let [one, two] = &mut faces.fans;
    let (c, lows) = match found {
        Found::Point => return Ok(middle),
        Found::On(first) => {
            let fan = if first == 0 { one } else { two };
            fan.settle(LEVEL, hair);
            let c = pressed_on_plane(fan, rim);
            let low = fan.low(&c);
            (
                c,
                low.map(|low| if first == 0 { [low, 0.0] } else { [0.0, low] }),
            )
        }
        Found::Both => {
            one.settle(LEVEL, hair);
            two.settle(LEVEL, hair);
            let Some(c) = pressed(one, two, rim) else {
                return Ok(middle);
            };
            (c, one.low(&c).zip(two.low(&c)).map(<[Real; 2]>::from))
        }
    };
    // Rounding may have it elsewhere, where a fan is a line.
    let Some([low1, low2]) = lows else {
        return Ok(middle);
    };
    let rise = 0.5 * depth * (lesser(low2, 1.0) - lesser(low1, 1.0));
    let [e1, e2] = &faces.view.axes;
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
