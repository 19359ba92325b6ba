// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Two fans of triangles about one place, and the centroid of what they share.
//!
//! # Derivation
//!
//! *A fan.* The points of an object, seen from the deepest place r*, are the corners of a fan of
//! triangles. In each of them low, how far the object is below its support plane, is linear, and so is w, which is 0 at r* and 1 along the outer side, beyond which there
//! is nothing. Where r* is itself a corner of the face a corner a hair beyond it closes the fan. The
//! rays of the corners of both fans part the plane into cones, in which w1, w2 and f = low1 + low2
//! are linear, and the shared region is where all three are at most 1 (low in units of d).
//!
//! *A cone.* The region's outline in a cone is the upper envelope of the three: two to four corners
//! v_i. With δ_i = 1 − f(v_i), in units of d, the triangle 0 v_i v_j, of twice the area a, has
//!
//! ```text
//! ∫ δ dA = a (1 + δ_i + δ_j) / 6,
//! ∫ δ r dA = a (v_i (1 + 2 δ_i + δ_j) + v_j (1 + δ_i + 2 δ_j)) / 24.
//! ```
//!
//! *A rim.* An edge, or a corner, has no area. What its flanks share with the other object has: they
//! fall away with some slope s, so that beyond a piece of outline of length L lies a prism as wide as
//! δ d / s:
//!
//! ```text
//! ∫ δ dA = k (δ_i² + δ_i δ_j + δ_j²) / 3,   k = L d / 2 s,
//! ∫ δ r dA = k (v_i (3 δ_i² + 2 δ_i δ_j + δ_j²) + v_j (δ_i² + 2 δ_i δ_j + 3 δ_j²)) / 12.
//! ```
//!
//! Where there is area it counts for little; where there is none it is all there is, and which slope
//! it is cancels out. Where the outline is at depth 0 it is nothing. So faces, edges and corners are
//! one case, and what is between them is between them.

use crate::contacts::list::List;
use crate::contacts::polygon::{Corner, Flat, Polygon, between, cross, dot, length, side};
use crate::math::{Real, larger, lesser};

/// Corners of a fan, at most: eight that are asked for, and those that close it.
const ROOM: usize = 11;
/// A corner within so many hairs, and more than the one it was moved by, is the deepest place itself:
/// as far as witness points are beside it. Measured
/// (`extension/pressure.c`): 1 leaves out half of a box that leans by less than its depth.
const HERE: Real = 32.0;
/// Part of a hair by which directions must differ, at the farther corner. Insensitive: 1/8 to 1/2 tried.
const PART: Real = 0.25;

/// What is seen of one object from the deepest place: corners around it, in order, low in units of the
/// depth. Without corners it is a level plane that reaches farther than all.
#[derive(Clone, Debug, Default)]
pub struct Fan {
    pub corners: Polygon<ROOM>,
    /// What is taken off all lows.
    level: Real,
}

impl Fan {
    /// Does it stand for a level plane?
    pub fn is_plane(&self) -> bool {
        self.corners.is_empty()
    }

    /// How far the object reaches towards its corners, as far as the depth goes.
    #[inline(always)]
    pub fn ends(&self) -> impl Iterator<Item = Flat> + '_ {
        self.corners.iter().map(|c| c.outer().at)
    }

    /// Does the object end within `far`, metres, around the deepest place, as far as the depth goes?
    #[inline(always)]
    pub fn is_point(&self, far: Real) -> bool {
        self.corners.iter().all(|c| {
            let most = far * larger(c.low, 1.0);
            dot(&c.at, &c.at) <= most * most
        })
    }

    /// Takes this share of what all corners are lower by off them, and puts them in order. `hair`,
    /// metres: what is nearer is the same.
    #[inline(never)]
    pub fn settle(&mut self, share: Real, hair: Real) {
        let low = self.corners.iter().map(|corner| corner.low);
        self.level = low.fold(1.0, lesser) * share;
        let part2 = PART * PART * hair * hair;
        // Mostly they lie around the deepest place, in the order in which they were asked for.
        let (mut p, mut is_around) = (self.corners.at(self.corners.len().max(1) - 1).at, true);
        for corner in self.corners.iter_mut() {
            corner.low -= self.level;
            let q = corner.at;
            let (area, way) = (cross(&p, &q), side(&p, &q));
            is_around &= area > 0.0 && area * area > part2 * dot(&way, &way);
            p = q;
        }
        if !is_around {
            self.corners = closed(&self.in_order(hair * hair, part2), hair);
        }
    }

    /// Its corners in order around the deepest place, of those in one direction the farthest.
    /// `part2`, m²: what is aside by less than its root is not.
    #[cold]
    #[inline(never)]
    fn in_order(&self, hair2: Real, part2: Real) -> List<(Real, Corner), ROOM> {
        // What is the deepest place, but beside it, has no direction.
        let is_here = |c: &Corner| {
            let far2 = dot(&c.at, &c.at);
            far2 > 4.0 * hair2 && far2 <= HERE * HERE * hair2
        };
        let is_same = |p: &Flat, q: &Flat| {
            let aside = cross(p, q);
            let most2 = part2 * larger(dot(p, p), dot(q, q));
            dot(p, q) > 0.0 && !(aside * aside > most2)
        };
        let mut order: List<(Real, Corner), ROOM> = List::default();
        let all = self.corners.iter().all(is_here);
        for corner in self.corners.iter().filter(|c| all || !is_here(c)) {
            let turn = turn(&corner.at);
            let i = order.iter().filter(|(t, _)| *t <= turn).count();
            let beside = [(i + order.len()).max(1) - 1, i];
            let mut same = beside
                .into_iter()
                .filter(|k| is_same(&order.at(*k).1.at, &corner.at));
            if let Some(k) = same.next() {
                let place = &mut order.at_mut(k).1;
                if dot(&corner.at, &corner.at) > dot(&place.at, &place.at) {
                    *place = *corner;
                }
            } else {
                order.insert(i, (turn, *corner));
            }
        }
        order
    }

    /// The sector from corner `i`, counted around, to the next.
    #[inline(always)]
    fn at(&self, i: usize) -> [&Corner; 2] {
        let i = if i < self.corners.len() {
            i
        } else {
            i - self.corners.len()
        };
        [self.corners.at(i), self.corners.at(i + 1)]
    }

    /// The sector that a ray is in.
    #[inline(always)]
    fn sector(&self, r: &Flat) -> Option<usize> {
        let mut last = self.corners.len().max(1) - 1;
        let mut left = cross(&self.corners.at(last).at, r);
        for (i, corner) in self.corners.iter().enumerate() {
            let next = cross(&corner.at, r);
            if left >= 0.0 && next < 0.0 {
                return Some(last);
            }
            (last, left) = (i, next);
        }
        None
    }

    /// The centre of pressure on a level plane, from the deepest place; `rim`: d / 2 s.
    #[inline(never)]
    fn pressed_on_plane(&self, rim: Real) -> Flat {
        let mut p = self.corners.at(self.corners.len().max(1) - 1);
        let mut sum = Sum {
            rim,
            last: p.outer(),
            ..Sum::default()
        };
        for q in self.corners.iter() {
            if (p.low > 1.0) != (q.low > 1.0) {
                let at = between(&p.at, &q.at, (1.0 - p.low) / (q.low - p.low));
                sum.to(Outer { at, depth: 0.0 });
            }
            sum.to(q.outer());
            p = q;
        }
        sum.centroid()
    }

    /// How far the object is below its plane at a place, in units of the depth; `None` where that is
    /// no place of the fan, but for a hundredth.
    #[inline(never)]
    pub fn low(&self, r: &Flat) -> Option<Real> {
        if self.is_plane() {
            return Some(0.0);
        }
        let [wall, low] = within(&self.at(self.sector(r)?), r);
        // Not where it is NaN.
        (wall <= 1.01).then_some(low + self.level * wall)
    }
}

/// Corners in order, closed where they leave out half a turn or more, because the deepest place is a
/// corner itself: by others a hair beyond it.
#[cold]
#[inline(never)]
fn closed(order: &List<(Real, Corner), ROOM>, hair: Real) -> Polygon<ROOM> {
    let mut fan = Polygon::default();
    for (i, (_, p)) in order.iter().enumerate() {
        let q = order.at(i + 1).1.at;
        fan.push(*p);
        if cross(&p.at, &q) > 0.0 {
            continue;
        }
        // A quarter of a turn from p, a half, three quarters, as far as q is.
        let share = hair / length(&p.at);
        let mut at = p.at.map(|x| x * share);
        for _ in 1..4 {
            at = [-at[1], at[0]];
            fan.push(Corner { at, low: 0.0 });
            let (across, along) = (cross(&at, &q), dot(&at, &q));
            // Not where the rest is nearly half a turn: it would be no region.
            if across > 0.0 && across > -along {
                break;
            }
        }
    }
    fan
}

/// Of a place in a sector: w and low.
#[inline(always)]
fn within([p, q]: &[&Corner; 2], r: &Flat) -> [Real; 2] {
    let share = 1.0 / cross(&p.at, &q.at);
    let (one, two) = (cross(r, &q.at) * share, cross(&p.at, r) * share);
    [one + two, one * p.low + two * q.low]
}

/// What grows with a direction's angle, around from the first axis: 0 to 4.
fn turn([x, y]: &Flat) -> Real {
    let along = x / larger(x.abs() + y.abs(), Real::MIN_POSITIVE);
    if *y < 0.0 { 3.0 + along } else { 1.0 - along }
}

/// The ray to a corner of either fan, and what is at most 1 in the region there: w of both, and f.
#[derive(Clone, Copy, Debug, Default)]
struct Ray {
    at: Flat,
    most: [Real; 3],
}

impl Ray {
    /// Which of the three is the largest.
    #[inline(always)]
    fn top(&self) -> usize {
        let [a, b, f] = self.most;
        let k = usize::from(b > a);
        if f > larger(a, b) { 2 } else { k }
    }

    /// Where the `k`th is 1.
    #[inline(always)]
    fn outer(&self, k: usize) -> Outer {
        let share = 1.0 / self.most[k.min(2)];
        Outer {
            at: self.at.map(|x| x * share),
            depth: larger(1.0 - self.most[2] * share, 0.0),
        }
    }

    /// The ray between two, on which the `i`th and the `j`th are equal, the `i`th being larger on the
    /// first and the `j`th on the second.
    #[inline(always)]
    fn between(&self, other: &Self, i: usize, j: usize) -> Self {
        let (i, j) = (i.min(2), j.min(2));
        let more = |ray: &Self| ray.most[i] - ray.most[j];
        let (a, b) = (more(self), more(other));
        let t = a / (a - b);
        let (s, e) = (&self.most, &other.most);
        Self {
            at: between(&self.at, &other.at, t),
            most: [
                s[0] + (e[0] - s[0]) * t,
                s[1] + (e[1] - s[1]) * t,
                s[2] + (e[2] - s[2]) * t,
            ],
        }
    }
}

impl Corner {
    /// How far the region reaches towards it, where it lies on a level plane.
    #[inline(always)]
    pub fn outer(&self) -> Outer {
        let share = 1.0 / larger(self.low, 1.0);
        Outer {
            at: self.at.map(|x| x * share),
            depth: larger(1.0 - self.low, 0.0),
        }
    }
}

/// A corner of the region's outline, and the local depth there in units of the depth.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outer {
    pub at: Flat,
    depth: Real,
}

/// Volume and moment of the local depth, along the outline.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    volume: Real,
    moment: Flat,
    /// d / 2 s.
    rim: Real,
    /// Where the outline has come to.
    last: Outer,
}

impl Sum {
    /// The triangle from the deepest place to the next piece of outline, and the rim beyond that.
    #[inline(always)]
    fn to(&mut self, w: Outer) {
        let v = self.last;
        let (a, b) = (v.depth, w.depth);
        let area = cross(&v.at, &w.at);
        // How long the piece is, to 4 %: the rim's width is not known better.
        let [x, y] = side(&v.at, &w.at).map(Real::abs);
        let k = 2.0 * self.rim * (larger(x, y) + 0.4 * lesser(x, y));
        let (aa, ab, bb) = (a * a, a * b, b * b);
        self.volume += 4.0 * (area * (1.0 + a + b) + k * (aa + ab + bb));
        let one = area * (1.0 + 2.0 * a + b) + k * (3.0 * aa + 2.0 * ab + bb);
        let two = area * (1.0 + a + 2.0 * b) + k * (aa + 2.0 * ab + 3.0 * bb);
        self.moment[0] += one * v.at[0] + two * w.at[0];
        self.moment[1] += one * v.at[1] + two * w.at[1];
        self.last = w;
    }

    /// NaN where nothing is shared.
    fn centroid(&self) -> Flat {
        let share = 1.0 / self.volume;
        self.moment.map(|m| m * share)
    }

    /// The outline from one ray, whose largest is the `i`th, to the next, whose largest is the `j`th.
    #[inline(always)]
    fn cone(&mut self, s: &Ray, i: usize, e: &Ray, j: usize) {
        if i != j {
            let cut = s.between(e, i, j);
            let k = 3_usize.wrapping_sub(i + j).min(2);
            if cut.most[k] > cut.most[i.min(2)] {
                self.to(s.between(e, i, k).outer(k));
                self.to(s.between(e, k, j).outer(k));
            } else {
                self.to(cut.outer(i));
            }
        }
        self.to(e.outer(j));
    }
}

/// The centre of pressure of two fans, from the deepest place; `rim`: d / 2 s. `None` where one does
/// not close.
#[inline(always)]
pub fn pressed(one: &Fan, two: &Fan, rim: Real) -> Option<Flat> {
    if two.is_plane() {
        return Some(one.pressed_on_plane(rim));
    }
    let ray = |corner: &Corner, sector: &[&Corner; 2], is_first: bool| {
        let [wall, low] = within(sector, &corner.at);
        let (a, b) = if is_first { (1.0, wall) } else { (wall, 1.0) };
        Ray {
            at: corner.at,
            most: [a, b, corner.low + low],
        }
    };
    // The sectors that the last ray is in: the second fan's are counted from the first ray's, and left in
    // order until that comes again.
    let (first, mut i, mut j) = (two.sector(&one.corners.at(0).at)?, 0, 0);
    let mut sectors = [one.at(0), two.at(first)];
    let start = ray(sectors[0][0], &sectors[1], true);
    let (mut last, mut top) = (start, start.top());
    let mut sum = Sum {
        rim,
        last: start.outer(top),
        ..Sum::default()
    };
    // Ends: each round takes a corner.
    while i < one.corners.len() {
        let [[_, p], [_, q]] = sectors;
        let next = if cross(&p.at, &q.at) > 0.0 || j == two.corners.len() {
            i += 1;
            sectors[0] = one.at(i);
            if i < one.corners.len() {
                ray(p, &sectors[1], true)
            } else {
                start
            }
        } else {
            j += 1;
            sectors[1] = two.at(first + j);
            ray(q, &sectors[0], false)
        };
        let next_top = next.top();
        sum.cone(&last, top, &next, next_top);
        (last, top) = (next, next_top);
    }
    Some(sum.centroid())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    const HAIR: Real = 2e-6;

    fn fan(corners: &[(Real, Real, Real)]) -> Fan {
        let corner = |c: &(Real, Real, Real)| Corner {
            at: [c.0, c.1],
            low: c.2,
        };
        let mut fan = Fan::default();
        for (i, c) in corners.iter().enumerate() {
            fan.corners.insert(i, corner(c));
        }
        fan.settle(0.0, HAIR);
        fan
    }

    /// By sums over a grid: where w of both and the sum of lows are at most 1.
    fn by_grid(one: &Fan, two: &Fan) -> Flat {
        let mut sum = [0.0; 3];
        const N: i32 = 400;
        for x in -N..N {
            for y in -N..N {
                let r = [x, y].map(|x| (x as Real + 0.5) * 1.5 / N as Real);
                let of = |f: &Fan| f.sector(&r).map_or([9.0; 2], |i| within(&f.at(i), &r));
                let ([w1, l1], [w2, l2]) = (of(one), of(two));
                let depth = 1.0 - l1 - l2;
                if w1 <= 1.0 && w2 <= 1.0 && depth > 0.0 {
                    sum[0] += depth;
                    sum[1] += depth * r[0];
                    sum[2] += depth * r[1];
                }
            }
        }
        [sum[1] / sum[0], sum[2] / sum[0]]
    }

    #[test]
    fn as_by_a_grid() {
        let mut r = Random::new(1);
        for round in 0..40 {
            let fans = [0, 1].map(|_| {
                let n = 3 + round % 4;
                let corners: Vec<_> = (0..n)
                    .map(|k| {
                        let angle = (k as Real + r.within(0.0, 0.4))
                            * core::f64::consts::TAU as Real
                            / n as Real;
                        let far = r.within(0.5, 1.0);
                        (far * angle.cos(), far * angle.sin(), r.within(0.0, 1.2))
                    })
                    .collect();
                fan(&corners)
            });
            let [one, two] = &fans;
            let found = pressed(one, two, 1e-9).unwrap();
            let truth = by_grid(one, two);
            let off = length(&side(&found, &truth));
            assert!(off < 3e-3, "{round}: {found:?} {truth:?} {one:?} {two:?}");
        }
    }

    #[test]
    fn an_edge_and_a_corner() {
        let plate = fan(&[
            (1.0, 1.0, 0.0),
            (-1.0, 1.0, 0.0),
            (-1.0, -1.0, 0.0),
            (1.0, -1.0, 0.0),
        ]);
        let h = HAIR;
        let edge = fan(&[
            (0.5, h, 0.0),
            (0.5, h * 1.1, 0.0),
            (-0.5, -h, 0.0),
            (-0.5, -h * 0.5, 0.0),
        ]);
        let c = pressed(&edge, &plate, 1e-3).unwrap();
        assert!(length(&c) < 1e-3, "{c:?} {edge:?}");
        let edge = fan(&[
            (1.0, h, 1.0),
            (1.0, h * 1.1, 1.0),
            (0.0, -h, 0.0),
            (0.0, -h * 0.5, 0.0),
        ]);
        let c = pressed(&edge, &plate, 1e-3).unwrap();
        assert!((c[0] - 0.25).abs() < 1e-2, "{c:?} {edge:?}");
    }
}
