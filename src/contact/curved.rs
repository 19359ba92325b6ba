// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Finds points of a curved surface around the deepest one.
//!
//! The *mirror plane* contains the normal, the object's center and its own deepest vertex. Two opposite directions are
//! evaluated, 45° from that plane. The mirror images of both vertices are the other two: right for bodies of revolution. If
//! they cannot be, their directions are evaluated too. Of a disc the points between the four on its rim are computed.
//!
//! (A plane through the contact's deepest point, a mean of witness points, would be another one if the center is nearly
//! above that point.)

use crate::contact::fan::{Fan, moved};
use crate::contact::feature::{FeatureQuery, four_directions, is_within};
use crate::contact::tuning::{
    COMMON_DROP_FACTOR, DROP_TOL, MAX_CURVED_REL, MAX_TILT_TAN, MIN_CURVED_DROP, POINT_REL,
};
use crate::geometry::polygon::{Vec2, offset};
use crate::math::{Vec3, lesser};
use crate::minkowski::support::{Fault, SupportMap};
use core::f64::consts::FRAC_1_SQRT_2 as H;

impl<A: SupportMap, B: SupportMap> FeatureQuery<'_, A, B> {
    /// Finds the points of a curved surface and makes their fan. Returns false if the surface is that of a polytope: it is not
    /// a disc, and a query returns a known vertex or four points are in a plane with the deepest one; `extremes` then has the
    /// queried vertices too.
    ///
    /// # Errors
    /// [`Fault::NonFinite`].
    #[inline(never)]
    pub fn find_curved(
        &self,
        object: usize,
        extremes: &mut [Vec3; 4],
        fan: &mut Fan,
    ) -> Result<bool, Fault> {
        let (own, center) = match self.has_centers {
            true => (self.own_deepest(object), self.centers[object % 2]),
            false => (Vec2::zeros(), extremes.iter().sum::<Vec3>().xy()),
        };
        let distance = (center - own).norm();
        let has_axis = distance > self.vertex_offset;
        let axis = if has_axis {
            (center - own) / distance
        } else {
            Vec2::x()
        };
        let out = four_directions(Vec2::new(axis.x - axis.y, axis.x + axis.y) * H);
        let a = self.query(object, out[0])?;
        let c = self.query(object, out[2])?;
        let is_known = self.is_known(object, extremes, [&a, &c]);
        let tolerance = POINT_REL * self.extent;
        fan.is_symmetric =
            (a + c).xy().norm_squared() < tolerance * tolerance && (a.z - c.z).abs() < DROP_TOL;
        let mirror = |v: &Vec3| {
            let aside = axis.perp(&(v.xy() - own)) * 2.0;
            Vec3::new(v.x + aside * axis.y, v.y - aside * axis.x, v.z)
        };
        let (mut b, mut d) = (mirror(&c), mirror(&a));
        // The distance of each from the mirror plane, on the side to which its direction is tilted.
        let [aside_a, aside_c] = [axis.perp(&(a.xy() - own)), -axis.perp(&(c.xy() - own))];
        let is_round = |v: &Vec3, aside: f64| {
            let lost = v.z * self.depth_over_tilt;
            aside >= 0.0
                && aside <= MAX_CURVED_REL * self.tilt * self.extent
                && lost >= MIN_CURVED_DROP * aside
        };
        let may_be_mirrored = self.has_centers && (fan.is_symmetric || has_axis);
        let is_mirrored = may_be_mirrored
            && !is_known
            && self.tilt < MAX_TILT_TAN
            && is_round(&a, aside_a)
            && is_round(&c, aside_c)
            && c.z * self.depth_over_tilt <= MAX_CURVED_REL * aside_c;
        let mut between = None;
        if !is_mirrored {
            b = self.query(object, out[1])?;
            d = self.query(object, out[3])?;
            between = self.fit_disc_rim([&a, &b, &c, &d], &out);
            let normal = (b - a).cross(&(c - a));
            let drop_at_deepest = a.z + normal.xy().dot(&a.xy()) / normal.z;
            let is_face = between.is_none() && (is_known || drop_at_deepest < DROP_TOL);
            let is_corner = [&b, &d].iter().any(|v| {
                let same = self.vertex_offset;
                is_within(v, &a, same) || is_within(v, &c, same)
            });
            if is_face || is_corner {
                let found = [a, b, c, d];
                found.iter().for_each(|v| self.raise_extremes(extremes, v));
                return Ok(false);
            }
        }
        let points = [a, b, c, d]
            .into_iter()
            .chain(between.into_iter().flatten());
        let common = COMMON_DROP_FACTOR * points.fold(1.0, |least, v| lesser(v.z, least));
        fan.len = 0;
        for (k, v) in [a, b, c, d].iter().enumerate() {
            fan.push(moved(v, out[k], self.vertex_offset, common));
            if let Some(between) = &between {
                let out = (out[k] + out[(k + 1) % 4]) * H;
                fan.push(moved(&between[k], out, self.vertex_offset, common));
            }
        }
        Ok(true)
    }

    /// Returns the deepest point of an object itself: the known vertex of the direction of least tilt, x and y.
    #[inline(always)]
    fn own_deepest(&self, object: usize) -> Vec2 {
        let (mut own, mut least) = (Vec2::zeros(), f64::INFINITY);
        for pair in self.known {
            let tilt2 = Vec2::from(pair.tilt).norm_squared();
            if tilt2 < least {
                (own, least) = (pair.vertex(object).xy(), tilt2);
            }
        }
        own
    }

    /// Returns whether one of two queried vertices was known before, or found by the polygon search, which gave up.
    #[inline(always)]
    fn is_known(&self, object: usize, extremes: &[Vec3; 4], queried: [&Vec3; 2]) -> bool {
        let same = self.vertex_offset;
        let is_one = |v: &Vec3| is_within(v, queried[0], same) | is_within(v, queried[1], same);
        let mut is_known = false;
        for pair in self.known {
            is_known |= is_one(&pair.vertex(object));
        }
        for v in extremes {
            is_known |= is_one(v);
        }
        is_known
    }

    /// Returns the points midway between the four vertices on the rim of a disc; None if the vertices are not on
    /// such a rim. A disc returns its center plus the radius times the direction in its plane. (A square whose
    /// corners lie along the four tilt directions within 1e-4 rad is mistaken for a disc.)
    #[inline(always)]
    fn fit_disc_rim(&self, [a, b, c, d]: [&Vec3; 4], out: &[Vec2; 4]) -> Option<[Vec3; 4]> {
        let normal = (b - a).cross(&(c - a));
        let gradient = normal.xy() / -normal.z;
        let lean = gradient * (self.tilt * self.depth_over_tilt);
        let scale = 1.0 / (1.0 + lean.norm_squared());
        // The direction in the leaning disc's plane that is farthest along the tilted normal: that normal without
        // its part along the axis of the disc.
        let outwards = |out: Vec2| {
            let tilt = out * self.tilt - lean;
            let down = lean.dot(&tilt) * scale;
            let in_plane = tilt - lean * down;
            in_plane / (in_plane.norm_squared() + down * down).sqrt()
        };
        let [first, second, third, fourth] = out.map(outwards);
        let (span, chord) = (first - third, offset(c, a));
        let span2 = span.norm_squared();
        // For corners of other faces the chord mostly has another direction.
        let cross = span.perp(&chord);
        if !(cross * cross <= POINT_REL * span2 * chord.norm_squared()) {
            return None;
        }
        let radius = span.dot(&chord) / span2;
        let on_rim = |out: Vec2| {
            let from_a = (out - first) * radius;
            a + Vec3::new(from_a.x, from_a.y, gradient.dot(&from_a))
        };
        let is_there = |out, found: &Vec3| {
            let error = on_rim(out) - found;
            let tolerance = POINT_REL * radius;
            error.xy().norm_squared() <= tolerance * tolerance && error.z.abs() <= DROP_TOL
        };
        // False for NaN.
        let is_rim = radius > 2.0 * self.vertex_offset
            && is_there(second, b)
            && is_there(third, c)
            && is_there(fourth, d);
        is_rim.then(|| [0, 1, 2, 3].map(|k| on_rim(outwards((out[k % 4] + out[(k + 1) % 4]) * H))))
    }
}
