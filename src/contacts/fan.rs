// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Two fans of triangles about one place, and the centroid of what they share.
//!
//! # Derivation
//!
//! *A fan.* The points of an object, seen from the deepest place r*, are the corners of a fan of
//! triangles. In each of them low, how far the object is below its support plane, is linear, and so is w,
//! which is 0 at r* and 1 along the outer side, beyond which there is nothing. What a sector of the one fan
//! shares with a sector of the other is a cone, in which w1, w2 and f = low1 + low2 are linear, and the shared
//! region is where all three are at most 1 (low in units of d). A sector turns back where r* lies
//! beyond the corners that are seen. By more than rounding it is one of a rim itself, and the sector is none.
//! By no more it is beside the object, as witness points are, and the sector counts with a minus: what the
//! others have between r* and the outline goes.
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

use crate::contacts::polygon::{Corner, Flat, Polygon, between, cross, dot, side};
use crate::math::{larger, lesser};

/// Corners of a fan, at most.
const ROOM: usize = 8;
/// The deepest place may be beside the outline by so many hairs, as witness points are. Measured in single
/// precision: ÷2 a brick on an edge steps by 1.6 mm (`extension/pressure.c`), ×2 a corner on a rim has
/// its position outside (`campaign`).
const BESIDE: f64 = 16.0;

/// What is seen of one object from the deepest place: corners around it, low in units of the depth.
pub type Fan = Polygon<ROOM>;

/// A ray from the deepest place, and what is at most 1 in the region there: w of both fans, and f.
#[derive(Clone, Copy)]
struct Ray {
    at: Flat,
    most: [f64; 3],
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
            most: [0, 1, 2].map(|k| s[k] + (e[k] - s[k]) * t),
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
#[derive(Clone, Copy)]
pub struct Outer {
    pub at: Flat,
    depth: f64,
}

/// Volume and moment of the local depth, along the outline.
struct Sum {
    volume: f64,
    moment: Flat,
    /// d / 2 s.
    rim: f64,
}

impl Sum {
    fn new(rim: f64) -> Self {
        Self {
            volume: 0.0,
            moment: [0.0; 2],
            rim,
        }
    }

    /// The triangle from the deepest place to a piece of outline, times `sign`, and the rim beyond that.
    #[inline(always)]
    fn add(&mut self, sign: f64, v: &Outer, w: &Outer) {
        let (a, b) = (v.depth, w.depth);
        let area = sign * cross(&v.at, &w.at);
        // How long the piece is, to 4 %: the rim's width is not known better.
        let [x, y] = side(&v.at, &w.at).map(f64::abs);
        let k = 2.0 * self.rim * (larger(x, y) + 0.4 * lesser(x, y));
        let (aa, ab, bb) = (a * a, a * b, b * b);
        let both = area * (1.0 + a + b) + k * (aa + 2.0 * ab + bb);
        let one = both + area * a + 2.0 * k * aa;
        let two = both + area * b + 2.0 * k * bb;
        self.volume += 4.0 * (both - k * ab);
        self.moment[0] += one * v.at[0] + two * w.at[0];
        self.moment[1] += one * v.at[1] + two * w.at[1];
    }

    /// The outline in a cone, from one ray to another.
    #[inline(always)]
    fn cone(&mut self, sign: f64, s: &Ray, e: &Ray) {
        let (i, j) = (s.top(), e.top());
        let mut from = s.outer(i);
        let mut to = |next: Outer| {
            self.add(sign, &from, &next);
            from = next;
        };
        if i != j {
            let cut = s.between(e, i, j);
            let k = 3_usize.wrapping_sub(i + j).min(2);
            if cut.most[k] > cut.most[i.min(2)] {
                to(s.between(e, i, k).outer(k));
                to(s.between(e, k, j).outer(k));
            } else {
                to(cut.outer(i));
            }
        }
        to(e.outer(j));
    }

    /// NaN where nothing is shared.
    fn centroid(&self) -> Flat {
        let share = 1.0 / self.volume;
        self.moment.map(|m| m * share)
    }
}

/// The centre of pressure of a fan on a level plane that reaches farther, from the deepest place; `rim`:
/// d / 2 s, `hair`: what corners are moved by, metres. NaN where nothing is shared.
#[inline(never)]
pub fn pressed_on_plane(fan: &Fan, rim: f64, hair: f64) -> Flat {
    let mut sum = Sum::new(rim);
    let mut p = fan.at(fan.len().max(1) - 1);
    for q in fan.iter() {
        let mut from = p.outer();
        if whole(p, q, hair) == 0.0 {
            p = q;
            continue;
        }
        if (p.low > 1.0) != (q.low > 1.0) {
            let at = between(&p.at, &q.at, (1.0 - p.low) / (q.low - p.low));
            let cut = Outer { at, depth: 0.0 };
            sum.add(1.0, &from, &cut);
            from = cut;
        }
        sum.add(1.0, &from, &q.outer());
        p = q;
    }
    sum.centroid()
}

/// A corner q of the second fan, and how it lies to a sector of the first, from p to r.
#[derive(Clone, Copy, Default)]
struct Place {
    /// Twice the areas of the triangles p q and r q.
    areas: [f64; 2],
    /// One over that of the sector from the corner before; 0 where that is none.
    share: f64,
}

/// Twice the area of a sector, less than 0 where it turns back; 0 of none.
#[inline(always)]
fn whole(p: &Corner, q: &Corner, hair: f64) -> f64 {
    let whole = cross(&p.at, &q.at);
    if whole < 0.0 {
        let (way, most) = (side(&p.at, &q.at), BESIDE * hair);
        if whole * whole > most * most * dot(&way, &way) {
            return 0.0;
        }
    }
    whole
}

/// The same of two fans.
#[inline(never)]
pub fn pressed(one: &Fan, two: &Fan, rim: f64, hair: f64) -> Flat {
    let mut sum = Sum::new(rim);
    let share = |p: &Corner, r: &Corner| {
        let whole = whole(p, r, hair);
        if whole == 0.0 { 0.0 } else { 1.0 / whole }
    };
    let (Some(mut p), Some(mut q)) = (one.last(), two.last()) else {
        return [f64::NAN; 2];
    };
    let mut places = [Place::default(); ROOM];
    for (place, s) in places.iter_mut().zip(two.iter()) {
        place.areas[1] = cross(&p.at, &s.at);
        place.share = share(q, s);
        q = s;
    }
    for r in one.iter() {
        for (place, q) in places.iter_mut().zip(two.iter()) {
            place.areas = [place.areas[1], cross(&r.at, &q.at)];
        }
        let share = share(p, r);
        if share != 0.0 {
            shared(&mut sum, [p, r], share, two, &places);
        }
        p = r;
    }
    sum.centroid()
}

/// What a sector of the first fan shares with those of the second.
#[inline(always)]
fn shared(sum: &mut Sum, sector: [&Corner; 2], share: f64, two: &Fan, places: &[Place; ROOM]) {
    let back = usize::from(share < 0.0);
    let [p, r] = turned(share, sector);
    let share = share.abs();
    let sides = places.iter().zip(two.iter());
    let Some(mut last) = sides.clone().next_back() else {
        return;
    };
    for next in sides {
        // It is from q to s.
        let [(at_q, q), (at_s, s)] = turned(next.0.share, [last, next]);
        last = next;
        let (pq, rq) = (at_q.areas[back], at_q.areas[1 - back]);
        let (ps, rs) = (at_s.areas[back], at_s.areas[1 - back]);
        let is_p_within = pq <= 0.0 && ps > 0.0;
        let is_q_within = pq > 0.0 && rq < 0.0;
        if next.0.share == 0.0 || !(is_p_within || is_q_within) {
            continue;
        }
        let its = next.0.share.abs();
        // A corner of the first fan in a sector of the second, by its shares of that one's corners.
        let first = |c: &Corner, cq: f64, cs: f64| {
            let (one, two) = (cs * its, -cq * its);
            Ray {
                at: c.at,
                most: [1.0, one + two, c.low + one * q.low + two * s.low],
            }
        };
        let second = |c: &Corner, pc: f64, rc: f64| {
            let (one, two) = (-rc * share, pc * share);
            Ray {
                at: c.at,
                most: [one + two, 1.0, c.low + one * p.low + two * r.low],
            }
        };
        let start = if is_p_within {
            first(p, pq, ps)
        } else {
            second(q, pq, rq)
        };
        let end = if rq < 0.0 && rs >= 0.0 {
            first(r, rq, rs)
        } else {
            second(s, ps, rs)
        };
        let sign = if (back == 1) == (next.0.share < 0.0) {
            1.0
        } else {
            -1.0
        };
        sum.cone(sign, &start, &end);
    }
}

/// The two ends of a sector, in the order in which it turns ahead.
#[inline(always)]
fn turned<T>(share: f64, [a, b]: [T; 2]) -> [T; 2] {
    if share < 0.0 { [b, a] } else { [a, b] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::polygon::length;
    use crate::shapes::Random;

    fn fan(corners: &[(f64, f64, f64)]) -> Fan {
        let corner = |c: &(f64, f64, f64)| Corner {
            at: [c.0, c.1],
            low: c.2,
        };
        let mut fan = Fan::default();
        corners.iter().for_each(|c| fan.push(corner(c)));
        fan
    }

    /// Of a place in a sector: w and low.
    fn within(p: &Corner, q: &Corner, r: &Flat) -> Option<[f64; 2]> {
        let share = 1.0 / cross(&p.at, &q.at);
        let (one, two) = (cross(r, &q.at) * share, cross(&p.at, r) * share);
        (one >= 0.0 && two >= 0.0).then_some([one + two, one * p.low + two * q.low])
    }

    /// By sums over a grid: where w of both and the sum of lows are at most 1.
    fn by_grid(one: &Fan, two: &Fan) -> Flat {
        let mut sum = [0.0; 3];
        const N: i32 = 400;
        for x in -N..N {
            for y in -N..N {
                let r = [x, y].map(|x| (x as f64 + 0.5) * 1.5 / N as f64);
                let of = |f: &Fan| {
                    let mut found = f.sides().filter_map(|(p, q)| within(&p, &q, &r));
                    found.next().unwrap_or([9.0; 2])
                };
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
                        let angle = (k as f64 + r.within(0.0, 0.4)) * core::f64::consts::TAU as f64
                            / n as f64;
                        let far = r.within(0.5, 1.0);
                        (far * angle.cos(), far * angle.sin(), r.within(0.0, 1.2))
                    })
                    .collect();
                fan(&corners)
            });
            let [one, two] = &fans;
            let found = pressed(one, two, 1e-9, 1e-9);
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
        let h = 2e-6;
        let edge = fan(&[
            (0.5, h, 0.0),
            (0.5, h * 1.1, 0.0),
            (-0.5, -h, 0.0),
            (-0.5, -h * 0.5, 0.0),
        ]);
        let c = pressed(&edge, &plate, 1e-3, 2e-6);
        assert!(length(&c) < 1e-3, "{c:?} {edge:?}");
        let edge = fan(&[
            (1.0, h, 1.0),
            (1.0, h * 1.1, 1.0),
            (0.0, -h, 0.0),
            (0.0, -h * 0.5, 0.0),
        ]);
        let c = pressed(&edge, &plate, 1e-3, 2e-6);
        assert!((c[0] - 0.25).abs() < 1e-2, "{c:?} {edge:?}");
        // The deepest place is beside it.
        let edge = |y: f64| {
            fan(&[
                (1.0, y + h, 1.0),
                (1.0, y + h * 1.1, 1.0),
                (-0.3, y - h, 0.0),
                (-0.3, y - h * 0.5, 0.0),
            ])
        };
        let level = |fan: &Fan| pressed_on_plane(fan, 1e-5, h);
        let both = |fan: &Fan| pressed(fan, &plate, 1e-5, h);
        for of in [&level as &dyn Fn(&Fan) -> Flat, &both] {
            let on = of(&edge(0.0));
            for y in [12.0 * h, -12.0 * h] {
                let c = of(&edge(y));
                assert!((c[0] - on[0]).abs() < 1e-2, "{c:?} {on:?}");
            }
        }
    }
}
