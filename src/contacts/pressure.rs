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
//! the other has there, no corner of that floor matters, and that object is not asked; where they leave
//! something out it is asked towards that, until they do. As corners they would not do: they lie where
//! the search came from, and would pull c there.
//!
//! *Fans.* The points of an object, seen from r*, are the corners of a fan of triangles, in each of
//! which low is linear. The integrals over two fans, or over one on a floor, are in closed form:
//! [`crate::contacts::fan`]. The position is half-way between the support planes there.
//!
//! *Roundness.* A round face is lower by ½ R t² where it is asked with the tilt t, all around: a part
//! of what all corners have in common is taken off, `LEVEL` of [`crate::contacts::view`]. All of it would be right for a sphere;
//! of the strip along which a cylinder lies the depth falls by the square, not linearly, and the rest
//! makes up for that.

use crate::contact::Penetration;
use crate::contacts::fan::{Fan, pressed, pressed_on_plane};
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{Flat, dot, side};
use crate::contacts::seen::Seen;
use crate::contacts::view::{FOUR, Four, View};
use crate::math::{EPSILON, Vec3, larger, lesser};
use crate::minkowski::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// The tilt of the directions asked, as a tangent, is this times the root of depth / extent: so a
/// round face of that radius, or half of it, is seen no lower than half the depth, and of a flat one
/// that leans by a depth over its width all corners. Measured (`extension/pressure.c`): ÷1.2 a corner of
/// a leaning box is missed, ×1.2 a cone on its side steps by 7 mm.
const TILT: f64 = 1.8;
/// At most: 14°, for what is deeper than a fiftieth of its extent.
const MOST: f64 = 0.25;
/// The slope of flanks that nothing is known of. Insensitive: 2 to 8 tried.
const FLANK: f64 = 4.0;
/// By how much, in units of the depth, corners are moved outwards, so that a fan has an area and the
/// deepest place is inside. Small beside 1 / [`FLANK`].
const HAIR: f64 = 1.0 / 512.0;
/// What ends within this share of the smaller object's extent is a point: the centre of pressure is
/// within a quarter of that.
const POINT: f64 = 0.016;
/// The four directions around a deepest place whose points all lie in the face of D there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Around {
    /// How low they may be, metres.
    pub low: f64,
    /// Unit; zero where one was lower, or not asked for.
    pub directions: [Vec3; FOUR],
    /// What they found, in the plane.
    pub points: [Flat; FOUR],
}

impl Around {
    /// Of the four corners of either object.
    #[inline(never)]
    fn fill<A: SupportMap, B: SupportMap>(
        &mut self,
        view: &View<A, B>,
        four: &[Four; 2],
        first: usize,
    ) {
        let (one, two) = (&four[first % 2], &four[1 - first % 2]);
        for k in 0..FOUR {
            let (p, q) = (&one[k], &two[(k + FOUR / 2) % FOUR]);
            if !((p.low + q.low) * view.depth <= self.low) {
                self.directions = [Vec3::zeros(); FOUR];
                return;
            }
            self.directions[k] = view.directions[k];
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

/// The centre of pressure of a hit, half-way between the support planes. Two support points where the search
/// has seen a floor that holds what is on it, else up to four, and a half more where a face has more than four corners.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
#[inline(never)]
pub fn centre<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    hit: &Penetration,
    tolerance: f64,
    aside: Aside,
) -> Result<Vec3, Fault> {
    let middle = hit.middle();
    let depth = larger(hit.depth, tolerance);
    let mut far2 = hit.extent;
    if let Some(c) = aside.centre {
        far2[0] = larger((c.v1 - hit.point1).norm_squared(), far2[0]);
        far2[1] = larger((c.v2 - hit.point2).norm_squared(), far2[1]);
    }
    let far = lesser(far2[0], far2[1]).sqrt();
    let hair = larger(depth * HAIR, 64.0 * EPSILON * far);
    let floor = match aside.seen {
        Seen::Floor(floor) => Some(floor),
        _ => None,
    };
    let upright;
    let plane = if let Some(floor) = floor {
        &floor.plane
    } else {
        upright = Plane::upright(&hit.normal, &middle);
        &upright
    };
    let tilt = lesser(TILT * (depth / far).sqrt(), MOST);
    let view = View {
        md,
        seen: aside.seen,
        others: aside.others,
        plane,
        half: 0.5 * hit.depth,
        depth,
        share: 1.0 / depth,
        tilt,
        directions: plane.around(tilt),
        hair,
    };
    // The smaller one first, or that on the floor.
    let first = match floor {
        Some(floor) => 1 - floor.object % 2,
        None => usize::from(far2[1] < far2[0]),
    };
    let point2 = POINT * POINT * far * far;
    let mut four = [Four::default(); 2];
    let [mine, its] = &mut four;
    view.look(first, mine)?;
    if is_point(mine, point2) {
        return Ok(middle);
    }
    let mut one = Fan::default();
    view.fan(first, mine, &mut one)?;
    let on_floor = match floor {
        Some(floor) => view.look_beyond(floor, &one, its)?,
        None => view.look(1 - first, its).map(|()| false)?,
    };
    let rim = depth * 0.5 / FLANK;
    let c = if on_floor {
        pressed_on_plane(&one, rim, hair)
    } else if is_point(its, point2) {
        return Ok(middle);
    } else {
        let mut two = Fan::default();
        view.fan(1 - first, its, &mut two)?;
        if let Some(around) = aside.around {
            around.fill(&view, &four, first);
        }
        pressed(&one, &two, rim, hair)
    };
    // NaN where nothing is shared.
    Ok(if dot(&c, &c).is_finite() {
        view.plane.point(&c, 0.0)
    } else {
        middle
    })
}

/// Does an object with these corners end within the root of `most2`, m², around the deepest place, as far as
/// the depth goes?
#[inline(always)]
fn is_point(four: &Four, most2: f64) -> bool {
    four.iter().all(|c| {
        let low = larger(c.low, 1.0);
        dot(&c.at, &c.at) <= most2 * low * low
    })
}

/// The squares of how far the objects are known to reach from their witness points, m².
#[inline(always)]
pub fn extent(points: impl Iterator<Item = [Vec3; 2]>, [p, q]: [&Vec3; 2]) -> [f64; 2] {
    let mut far2 = [0.0; 2];
    for [v1, v2] in points {
        far2[0] = larger((v1 - p).norm_squared(), far2[0]);
        far2[1] = larger((v2 - q).norm_squared(), far2[1]);
    }
    far2
}
