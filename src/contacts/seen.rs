// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What the search for a hit has seen that its position need not ask for again.

use crate::contact::Penetration;
use crate::contacts::plane::Plane;
use crate::contacts::polygon::{Corner, Flat, cross, side};
use crate::contacts::view::FOUR;
use crate::math::{EPSILON, Vec3};

/// How low a known point of a floor may be, as a share of the depth: taken for level, it turns a floor
/// by so little that the position moves by a third of that share of the face's half width. Insensitive:
/// 0.01 to 0.05 tried on recorded contacts.
const LEVEL: f64 = 0.01;
/// Unit vectors that are made unit again differ by less.
const ALIKE: f64 = 16.0 * EPSILON;
/// Directions of a state that stands besides the minimum's.
const OTHERS: usize = 3;

/// Points of the two objects, 0 and 1.
pub trait Known {
    /// Which points are at least `least` along a direction: a bit each.
    fn level(&self, object: usize, n: &Vec3, least: f64) -> u32;
    /// The point of that bit.
    fn point_of(&self, object: usize, i: usize) -> Vec3;
}

/// In any order.
impl<F: Fn(usize) -> Option<[Vec3; 2]>> Known for F {
    #[inline(always)]
    fn level(&self, object: usize, n: &Vec3, least: f64) -> u32 {
        let points = (0..u32::BITS).map_while(|i| Some((i, self(i as usize)?)));
        points.fold(0, |level, (i, p)| {
            level | u32::from(n.dot(&p[object % 2]) >= least) << i
        })
    }

    #[inline(always)]
    fn point_of(&self, object: usize, i: usize) -> Vec3 {
        self(i).map_or(Vec3::zeros(), |p| p[object % 2])
    }
}

/// What has been seen.
#[derive(Clone, Copy, Debug, Default)]
pub enum Seen {
    /// Nothing of use.
    #[default]
    Nothing,
    /// What the directions of a state that stands ([`crate::state::State::stand`]) found.
    Standing([[Vec3; 2]; OTHERS]),
    /// A face at the deepest place.
    Floor(Floor),
}

impl Seen {
    /// Keeps what the `others`, the directions of a state that stands, found, if they have been
    /// `asked`: so many directions after the first, and their points of the two objects.
    #[cold]
    #[inline(never)]
    pub fn stand(
        &mut self,
        asked: &dyn Fn(usize) -> (Vec3, [Vec3; 2]),
        count: usize,
        others: &[Vec3],
    ) {
        let mut found = [[Vec3::zeros(); 2]; OTHERS];
        let mut len = 0;
        for (i, (place, n)) in found.iter_mut().zip(others).enumerate().take(count) {
            let (dir, points) = asked(i);
            *place = points;
            len += usize::from((dir - n).amax() < ALIKE);
        }
        if len == OTHERS {
            *self = Self::Standing(found);
        }
    }

    /// Keeps the floor of a hit, if what is known of the object that reaches farther shows one. What
    /// stands stays.
    #[inline(never)]
    pub fn rest(&mut self, known: &impl Known, hit: &Penetration) {
        if matches!(self, Self::Standing(_)) {
            return;
        }
        let larger = usize::from(hit.extent[1] > hit.extent[0]);
        if let Some(floor) = Floor::of(larger, known, hit) {
            *self = Self::Floor(floor);
        }
    }
}

/// Points of one object in its support plane: of those known the farthest towards the plane's axes and
/// away from them, in that order.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// Whose: 0 or 1.
    pub object: usize,
    /// The hit's.
    pub plane: Plane,
    corners: [Flat; FOUR],
}

impl Floor {
    /// Of a hit, if there are three.
    #[inline(always)]
    fn of(object: usize, known: &impl Known, hit: &Penetration) -> Option<Self> {
        let n = if object == 0 { hit.normal } else { -hit.normal };
        let middle = hit.middle();
        let least = n.dot(&middle) + hit.depth * (0.5 - LEVEL);
        let mut level = known.level(object, &n, least);
        if level.count_ones() < 3 {
            return None;
        }
        let plane = Plane::upright(&hit.normal, &middle);
        let [e1, e2] = &plane.axes;
        let mut next = || {
            let p = known.point_of(object, level.trailing_zeros() as usize) - middle;
            level &= level - 1;
            (level != 0, [e1.dot(&p), e2.dot(&p)])
        };
        let (mut more, first) = next();
        let mut corners = [first; FOUR];
        while more {
            let at;
            (more, at) = next();
            widen(&mut corners, at);
        }
        Some(Self {
            object,
            plane,
            corners,
        })
    }

    /// Adds a corner that was found, if it is as high.
    pub fn add(&mut self, corner: &Corner) {
        if corner.low <= LEVEL {
            widen(&mut self.corners, corner.at);
        }
    }

    /// The first of these places that does not lie within, but for a `hair`, metres.
    #[inline(always)]
    pub fn lacks(&self, mut places: impl Iterator<Item = Flat>, hair: f64) -> Option<Flat> {
        let [a, b, c, d] = &self.corners;
        let sides = [(a, b), (b, c), (c, d), (d, a)].map(|(p, q)| {
            let along = side(p, q);
            let [x, y] = along.map(f64::abs);
            (along, cross(&along, p) - hair * (x + y))
        });
        // Of what is no wider than a hair all is beside it.
        let ([x, y], [u, v]) = (side(a, c), side(b, d));
        let is_line = !(x * v - y * u > hair * (x.abs() + y.abs() + u.abs() + v.abs()));
        let is_within = |at: &Flat| {
            sides
                .iter()
                .all(|(along, least)| cross(along, at) >= *least)
        };
        places.find(|at| is_line || !is_within(at))
    }
}

/// Takes in a place that lies farther towards an axis, or away from it.
#[inline(always)]
fn widen([a, b, c, d]: &mut [Flat; FOUR], at: Flat) {
    *a = if at[0] > a[0] { at } else { *a };
    *b = if at[1] > b[1] { at } else { *b };
    *c = if at[0] < c[0] { at } else { *c };
    *d = if at[1] < d[1] { at } else { *d };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_is_around_the_deepest_place() {
        let corner = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        let hit = Penetration {
            depth: 0.01,
            normal: Vec3::z(),
            point1: Vec3::zeros(),
            point2: Vec3::new(0.0, 0.0, -0.01),
            extent: [2.0, 1.0],
            ..Penetration::default()
        };
        let tip = Vec3::new(0.0, 0.0, -0.01);
        let outline = |points: &[Vec3]| {
            let mut seen = Seen::Nothing;
            seen.rest(&|k| Some([*points.get(k)?, tip]), &hit);
            match seen {
                Seen::Floor(floor) if floor.object == 0 => Some(floor),
                _ => None,
            }
        };
        let three = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(0.0, -1.0)];
        let [e1, e2] = Plane::upright(&hit.normal, &hit.middle()).axes;
        let at = |v: Vec3| [e1.dot(&v), e2.dot(&v)];
        let holds = |floor: &Floor, v: Vec3| floor.lacks([at(v)].into_iter(), 1e-6).is_none();
        let floor = outline(&three).unwrap();
        assert!(holds(&floor, corner(0.9, 0.95)));
        assert!(!holds(&floor, corner(0.9, 0.7)));
        // One is lower, or the place is beyond a side.
        let lower = Vec3::new(0.0, -1.0, -0.001);
        assert!(outline(&[three[0], three[1], lower]).is_none());
        let beyond = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(0.0, 0.5)];
        let floor = outline(&beyond).unwrap();
        assert!(!holds(&floor, Vec3::zeros()));
        let line = [corner(1.0, 0.0), corner(-1.0, 0.0), corner(0.0, 0.0)];
        assert!(!holds(&outline(&line).unwrap(), Vec3::zeros()));
    }
}
