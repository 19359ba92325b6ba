// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum of the model of both objects, for no support point: a walk.
//!
//! *Chart.* Around a unit direction b directions are d(x) = b + E x, E = (e1 e2) across b, not
//! normalised. There the known points c of an object are cuts, and its support value is at least
//! max over them of α + β·x, α = c·b, β = E'c. The model of D is the sum of the two objects'
//! maxima, so k support points make up to k² cuts of D, and its depth
//!
//!   φ(x) = L(x) / √(1 + x²),   L(x) = α₁ + α₂ + (β₁ + β₂)·x + ½ x'Gx,
//!
//! with the highest cut of each object, and G the bend of their discs (0 where there are none: then
//! φ is exact). Balls add their radii to φ, and are left to the caller.
//!
//! *Slope.* √(1+x²) ∇φ = M = g − x L/(1+x²), g = β₁ + β₂ + Gx.
//!
//! *Walk.* On one cut of each object: to where φ is least on these, if it has a minimum there, else
//! down its slope. Where another point of an object takes over (a *kink*): if the slope turns
//! round, along the kink, e·x constant, e = β′ − β; there φ is least at the root of its derivative,
//! which is linear in the way for exact cuts. Where a second kink is met, or the least point is
//! found, the weights of the points decide: M + S e₀ + T e₁ = 0 with weights that are none negative
//! is a minimum; else the point of negative weight is left, and the walk goes on.
//!
//! The walk ends at a minimum, on the border of the trust region, or, by rounding, nowhere.

use crate::contacts::polygon::{Flat, cross, dot, side};
use crate::math::larger;

/// Points of an object that a search keeps. Measured: ten take as many support points, from 45° too.
pub const ROOM: usize = 8;
/// Lanes that are computed together.
pub const LANES: usize = 4;
/// A number for each of them.
pub type Row = [f64; ROOM];
/// Steps of a walk: more than any takes that has an end. Insensitive: 16 to 64.
const STEPS: usize = 32;
/// A weight as negative as this is rounding. Insensitive: 0 to 1e-9 on the sets; at 0 some boxes take
/// four support points more.
const NEGATIVE: f64 = -1e-12;

/// Halvings of the way to the border, of which the first is taken where level ground falls. Derived: what
/// bends rises by the fourth order, by x⁴/32 of the depth, more than a slope s falls where x³ > 32 s; the
/// last x, of a first radius, shows a slope of some hundred ulps.
const NEARER: usize = 12;

/// Does this for each place that so many points take.
#[inline(always)]
pub fn each(len: usize, mut of: impl FnMut(usize)) {
    (0..LANES).for_each(&mut of);
    if len > LANES {
        (LANES..ROOM).for_each(of);
    }
}

/// The cuts of one object in the chart.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cuts {
    pub a: Row,
    pub x: Row,
    pub y: Row,
    /// How many there are, at least one.
    pub len: usize,
    /// The points that carry a disc, as bits, …
    pub carried: u32,
    /// … and how these bend: xx, xy, yy, metres.
    pub bend: [f64; 3],
}

impl Cuts {
    #[inline(always)]
    fn slope(&self, k: usize) -> Flat {
        [self.x[k % ROOM], self.y[k % ROOM]]
    }

    #[inline(always)]
    fn levels(&self, x: &Flat) -> Row {
        let mut levels = [0.0; ROOM];
        each(self.len, |k| {
            levels[k] = self.a[k] + self.x[k] * x[0] + self.y[k] * x[1]
        });
        levels
    }

    /// How fast each rises along u.
    #[inline(always)]
    fn rises(&self, u: &Flat, rises: &mut Row) {
        each(self.len, |k| rises[k] = self.x[k] * u[0] + self.y[k] * u[1]);
    }

    #[inline(always)]
    fn highest(&self, levels: &Row) -> usize {
        let (mut best, mut top) = (0, levels[0]);
        for (k, &level) in levels.iter().enumerate().take(self.len).skip(1) {
            if level > top {
                (best, top) = (k, level);
            }
        }
        best
    }

    #[inline(always)]
    pub fn carries(&self, k: usize) -> f64 {
        (self.carried >> k & 1) as f64
    }
}

/// A point of one object as high as that object's active one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Kink {
    /// Of obj1 (0) or of obj2 (1).
    pub object: usize,
    pub point: usize,
    /// Its slope less the active one's.
    e: Flat,
}

/// Where a walk ended.
#[derive(Clone, Copy, Debug, Default)]
pub struct End {
    pub x: Flat,
    /// φ there, metres.
    pub value: f64,
    /// On the border of the trust region, where φ goes on falling.
    pub on_border: bool,
    /// It found no end.
    pub lost: bool,
    /// Least straight down from a kink alone: beside that way φ may be lower.
    pub straight: bool,
    /// The highest point of each object.
    pub active: [usize; 2],
    /// Other points as high, …
    pub kinks: [Kink; 2],
    /// … how many of them, …
    pub count: usize,
    /// … and their weights.
    pub weights: [f64; 2],
}

impl End {
    /// The points that are active there, each after its object.
    #[inline(always)]
    pub fn points(&self) -> impl Iterator<Item = (usize, usize)> {
        let ([i, j], [p, q]) = (self.active, &self.kinks);
        let all = [(0, i), (1, j), (p.object, p.point), (q.object, q.point)];
        all.into_iter().take(2 + self.count)
    }

    /// Is φ nowhere lower within the radius, as far as the active points tell? Of two kinks: around
    /// it φ is φ₀ + max g·x − ½ φ₀ x² with the slopes g of the active points: max g·x is
    /// at least |x| times the distance from the origin to the nearest side of their hull, which
    /// must be ½ φ₀ times the radius.
    #[inline]
    pub fn is_lowest(&self, radius: f64) -> bool {
        if self.count < 2 || !(self.value > 0.0) {
            return !self.straight;
        }
        let least = 0.5 * self.value * radius;
        let least2 = least * least;
        let [p, q] = &self.kinks;
        let area = cross(&p.e, &q.e).abs();
        let far = |share: f64, side: &Flat| {
            let height = share * area;
            height * height >= least2 * dot(side, side)
        };
        let [s, t] = self.weights;
        if p.object == q.object {
            far(s, &q.e) && far(t, &p.e) && far(1.0 - s - t, &[p.e[0] - q.e[0], p.e[1] - q.e[1]])
        } else {
            far(s, &q.e) && far(1.0 - s, &q.e) && far(t, &p.e) && far(1.0 - t, &p.e)
        }
    }
}

/// The model of both objects in one chart.
#[derive(Debug, Default)]
pub struct Model {
    pub cuts: [Cuts; 2],
    /// By how much level ground may fall, metres.
    pub level: f64,
}

/// A way from x, and how far it goes, as a quotient: without an end, where that is infinite.
type Way = (Flat, f64, f64);

/// To where a fall of this rate, which rises by that, ends.
#[inline(always)]
fn to_the_least(u: Flat, fall: f64, rise: f64) -> Way {
    if rise > 0.0 {
        (u, fall, rise)
    } else {
        (u, f64::INFINITY, 1.0)
    }
}

/// φ at a place of the chart, on one cut of each object.
struct Place {
    /// Their height, and its slope.
    value: f64,
    slope: Flat,
    /// 1 + x².
    one: f64,
    /// (1 + x²) M.
    up: Flat,
}

impl Place {
    #[inline(always)]
    fn of<const BENT: bool>(x: &Flat, linear: f64, beta: &Flat, bend: &[f64; 3]) -> Self {
        let (mut value, mut slope) = (linear, *beta);
        if BENT {
            let gx = times(bend, x);
            value += 0.5 * dot(&gx, x);
            slope = [beta[0] + gx[0], beta[1] + gx[1]];
        }
        let one = 1.0 + dot(x, x);
        let up = [slope[0] * one - value * x[0], slope[1] * one - value * x[1]];
        Self {
            value,
            slope,
            one,
            up,
        }
    }
}

impl Model {
    /// From x within `radius` of `middle`, down.
    #[inline(always)]
    pub fn walk(&self, from: &Flat, middle: &Flat, radius: f64, end: &mut End) {
        if self.cuts[0].carried | self.cuts[1].carried != 0 {
            self.walk_on::<true>(from, middle, radius, end);
        } else {
            self.walk_on::<false>(from, middle, radius, end);
        }
    }

    #[inline(never)]
    fn walk_on<const BENT: bool>(&self, from: &Flat, middle: &Flat, radius: f64, end: &mut End) {
        let cuts = &self.cuts;
        let mut x = *from;
        let mut levels = [cuts[0].levels(&x), cuts[1].levels(&x)];
        (end.lost, end.count) = (true, 0);
        end.active = [0, 1].map(|o| cuts[o].highest(&levels[o]));
        let mut rises = [[0.0; ROOM]; 2];
        // The point just left, of which object.
        let mut left = (2, 0);
        for _ in 0..STEPS {
            let [i, j] = end.active;
            let linear = levels[0][i % ROOM] + levels[1][j % ROOM];
            let (g, h) = (cuts[0].slope(i), cuts[1].slope(j));
            let beta = [g[0] + h[0], g[1] + h[1]];
            let mut bend = [0.0; 3];
            if BENT {
                bend = self.bend(end, &x, &beta, linear);
            }
            let here = Place::of::<BENT>(&x, linear, &beta, &bend);
            end.value = here.value;
            let mut way = match end.count {
                0 => on_one::<BENT>(&x, linear, &beta, &bend, &here.up, middle, radius),
                1 => along::<BENT>(&end.kinks[0].e, &x, &bend, &here),
                _ => match weigh(end, &here, &mut left) {
                    true => break,
                    false => continue,
                },
            };
            end.straight = false;
            if BENT && end.count == 0 && left.0 < 2 {
                let of = &cuts[left.0 % 2];
                let (old, new) = (of.slope(left.1), of.slope(end.active[left.0 % 2]));
                if dot(&way.0, &old) > dot(&way.0, &new) {
                    // The valley is across the kink that was just left: straight down first.
                    end.straight = true;
                    let u = [-here.up[0], -here.up[1]];
                    let rise = dot(&times(&bend, &u), &u) - end.value * dot(&u, &u);
                    way = to_the_least(u, dot(&u, &u), rise);
                }
            }
            let (u, mut num, mut den) = way;
            cuts[0].rises(&u, &mut rises[0]);
            cuts[1].rises(&u, &mut rises[1]);
            let mut met = None;
            for o in 0..2 {
                let a = end.active[o] % ROOM;
                let mut skip = 1 << a;
                if end.count == 1 && end.kinks[0].object == o {
                    skip |= 1 << end.kinks[0].point;
                }
                if left.0 == o {
                    skip |= 1 << left.1;
                }
                let (top, fast) = (levels[o][a], rises[o][a]);
                for k in 0..cuts[o].len.min(ROOM) {
                    let rise = rises[o][k] - fast;
                    let below = larger(top - levels[o][k], 0.0);
                    if rise > 0.0 && below * den < num * rise && skip >> k & 1 == 0 {
                        (num, den, met) = (below, rise, Some((o, k)));
                    }
                }
            }
            left = (2, 0);
            let mut t = num / den;
            let off = [0, 1].map(|a| x[a] + t * u[a] - middle[a]);
            // Also where there is no end at all.
            end.on_border = !(dot(&off, &off) <= radius * radius);
            if end.on_border {
                let off = [x[0] - middle[0], x[1] - middle[1]];
                let (uu, xu) = (dot(&u, &u), dot(&off, &u));
                let room = larger(radius * radius - dot(&off, &off), 0.0);
                t = ((xu * xu + uu * room).sqrt() - xu) / uu;
            }
            if BENT && end.on_border {
                // On level ground what bends is known best near by: farther off the model is above it
                // by the fourth order, and may hide that it falls.
                let falls = |t: f64| {
                    let to = [x[0] + t * u[0], x[1] + t * u[1]];
                    let there = Place::of::<BENT>(&to, linear + t * dot(&beta, &u), &beta, &bend);
                    here.value / here.one.sqrt() - there.value / there.one.sqrt() > self.level
                };
                let mut nearer = core::iter::successors(Some(t), |t| Some(0.5 * t)).take(NEARER);
                t = nearer.find(|t| falls(*t)).unwrap_or(0.0);
            }
            // Not NaN, of no way.
            if t > 0.0 {
                x = [x[0] + t * u[0], x[1] + t * u[1]];
                for o in 0..2 {
                    each(cuts[o].len, |k| levels[o][k] += t * rises[o][k]);
                }
            }
            let linear = levels[0][i % ROOM] + levels[1][j % ROOM];
            let there = Place::of::<BENT>(&x, linear, &beta, &bend);
            end.value = there.value;
            if let (Some((o, k)), false) = (
                met.map(|(o, k): (usize, usize)| (o % 2, k % ROOM)),
                end.on_border,
            ) {
                let (new, old) = (cuts[o].slope(k), cuts[o].slope(end.active[o]));
                let e = [new[0] - old[0], new[1] - old[1]];
                if end.count == 0 && -dot(&there.up, &e) >= dot(&e, &e) * there.one {
                    // It goes down on the other side as well.
                    left = (o, core::mem::replace(&mut end.active[o], k));
                } else {
                    let kink = Kink {
                        object: o,
                        point: k,
                        e,
                    };
                    end.kinks[end.count % 2] = kink;
                    end.count += 1;
                }
                continue;
            }
            end.lost = false;
            if end.count == 0 {
                break;
            }
            // Least on a kink, of which both points must hold.
            let kink = end.kinks[0];
            let share = -dot(&there.up, &kink.e) / (dot(&kink.e, &kink.e) * there.one);
            end.weights[0] = share.clamp(0.0, 1.0);
            if end.on_border || share == end.weights[0] {
                break;
            }
            end.lost = true;
            left = (kink.object, kink.point);
            if share > 1.0 {
                left.1 = core::mem::replace(&mut end.active[kink.object % 2], kink.point);
            }
            end.count = 0;
        }
        end.x = x;
        end.value /= (1.0 + dot(&x, &x)).sqrt();
    }

    /// The bend of the active points; along a kink of its two as they share the slope.
    #[inline(always)]
    fn bend(&self, end: &End, x: &Flat, beta: &Flat, linear: f64) -> [f64; 3] {
        let mut of = [0, 1].map(|o: usize| self.cuts[o % 2].carries(end.active[o % 2]));
        if end.count == 1 {
            let Kink { object, point, e } = &end.kinks[0];
            let m = [0, 1].map(|a| beta[a] - linear * x[a]);
            let share = (-dot(&m, e) / dot(e, e)).clamp(0.0, 1.0);
            let o = object % 2;
            of[o] += share * (self.cuts[o].carries(*point) - of[o]);
        }
        let [p, q] = [&self.cuts[0].bend, &self.cuts[1].bend];
        [0, 1, 2].map(|i| p[i] * of[0] + q[i] * of[1])
    }
}

#[inline(always)]
fn times(a: &[f64; 3], x: &Flat) -> Flat {
    [a[0] * x[0] + a[1] * x[1], a[1] * x[0] + a[2] * x[1]]
}

/// On one cut of each object: where φ is least, else down.
#[inline(always)]
fn on_one<const BENT: bool>(
    x: &Flat,
    linear: f64,
    beta: &Flat,
    bend: &[f64; 3],
    up: &Flat,
    middle: &Flat,
    radius: f64,
) -> Way {
    let base = linear - dot(beta, x);
    if BENT {
        let to = valley(beta, bend, base, middle, radius);
        ([to[0] - x[0], to[1] - x[1]], 1.0, 1.0)
    } else if base < 0.0 {
        ([base * x[0] - beta[0], base * x[1] - beta[1]], 1.0, -base)
    } else if *up == [0.0; 2] {
        // One way is as good as another.
        ([1.0, 0.0], f64::INFINITY, 1.0)
    } else {
        ([-up[0], -up[1]], f64::INFINITY, 1.0)
    }
}

/// Along a kink, down, to where φ is least. With φ = L/√(1+x²) and x + t u its derivative is
/// proportional to (g·u)(1 + x²) − L x·u + t ((g·u)(x·u) − L u² + u'Gu (1 + x²)), exact where G = 0.
#[inline(always)]
fn along<const BENT: bool>(e: &Flat, x: &Flat, bend: &[f64; 3], here: &Place) -> Way {
    let mut u = [-e[1], e[0]];
    let mut fall = -dot(&here.up, &u);
    if fall < 0.0 {
        (u, fall) = ([e[1], -e[0]], -fall);
    }
    let mut rise = dot(&here.slope, &u) * dot(x, &u) - here.value * dot(&u, &u);
    if BENT {
        rise += dot(&times(bend, &u), &u) * here.one;
    }
    to_the_least(u, fall, rise)
}

/// At two kinks: are they a minimum? Else one is left.
#[inline(always)]
fn weigh(end: &mut End, here: &Place, left: &mut (usize, usize)) -> bool {
    let [p, q] = end.kinks;
    // All of them (1 + x²) times as large.
    let area = cross(&p.e, &q.e) * here.one;
    let (sign, area) = ((1.0 as f64).copysign(area), area.abs());
    let (s, t) = (-cross(&here.up, &q.e) * sign, -cross(&p.e, &here.up) * sign);
    let same = p.object == q.object;
    // Of the kinks, and of the active points of their objects.
    let weights = if same {
        [s, t, area - s - t, area]
    } else {
        [s, t, area - s, area - t]
    };
    let (mut least, mut out) = (NEGATIVE * area, weights.len());
    for (i, weight) in weights.into_iter().enumerate() {
        if weight < least {
            (least, out) = (weight, i);
        }
    }
    if out == weights.len() {
        end.weights = [s / area, t / area];
        end.lost = !(area > 0.0);
        return true;
    }
    let [gone, mut stays] = if out % 2 == 0 { [p, q] } else { [q, p] };
    *left = (gone.object, gone.point);
    if out >= 2 {
        left.1 = core::mem::replace(&mut end.active[gone.object % 2], gone.point);
        if same {
            stays.e = side(&gone.e, &stays.e);
        }
    }
    (end.kinks[0], end.count) = (stays, 1);
    false
}

/// Where α + β·x + ½ x'Kx, K = G − α I, is least within the radius: the minimum along what bends
/// up, and along what bends down the border.
#[inline(never)]
fn valley(beta: &Flat, bend: &[f64; 3], base: f64, middle: &Flat, radius: f64) -> Flat {
    let [xx, xy, yy] = *bend;
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let spread = (half * half + xy * xy).sqrt();
    let (high, low) = (mean + spread - base, mean - spread - base);
    // The direction of the high one.
    let cos2 = if spread > 0.0 { half / spread } else { 1.0 };
    let c = (0.5 * (1.0 + cos2)).sqrt();
    let s = (0.5 * (1.0 - cos2)).sqrt().copysign(xy);
    let turn = |v: &Flat| [c * v[0] + s * v[1], c * v[1] - s * v[0]];
    let (g, m) = (turn(beta), turn(middle));
    let mut to = [m[0], m[1]];
    if high > 0.0 {
        to[0] = -g[0] / high;
        if low > 0.0 {
            to[1] = -g[1] / low;
        } else {
            let off = (to[0] - m[0]) * (to[0] - m[0]);
            let room = larger(radius * radius - off, 0.0).sqrt() * 1.000_001;
            to[1] = m[1] - room.copysign(g[1] + low * m[1]);
        }
    } else {
        // Down the slope, over the border.
        let d = [g[0] + high * m[0], g[1] + low * m[1]];
        let length = dot(&d, &d).sqrt();
        let f = if length > 0.0 {
            1.000_001 * radius / length
        } else {
            0.0
        };
        to = [m[0] - f * d[0], m[1] - f * d[1]];
    }
    [c * to[0] - s * to[1], c * to[1] + s * to[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    /// What rounding leaves.
    const NEAR: f64 = if EPSILON > 1e-10 { 1e-4 } else { 1e-6 };

    /// Both objects' points of a pair that overlaps by about `depth` along b.
    fn model(r: &mut Random, len: [usize; 2], depth: f64, bend: f64) -> Model {
        let mut model = Model::default();
        for (cuts, len) in model.cuts.iter_mut().zip(len) {
            cuts.len = len;
            for k in 0..len {
                cuts.a[k] = 0.5 * depth - if k == 0 { 0.0 } else { r.within(0.0, 0.02) };
                cuts.x[k] = r.within(-0.3, 0.3);
                cuts.y[k] = r.within(-0.3, 0.3);
            }
        }
        model.cuts[0].carried = !0;
        model.cuts[0].bend = [bend, 0.3 * bend, 0.1 * bend];
        model
    }

    fn value(model: &Model, x: &Flat) -> f64 {
        let linear: f64 = [0, 1]
            .map(|o| {
                let cuts = &model.cuts[o];
                cuts.levels(x)[..cuts.len]
                    .iter()
                    .copied()
                    .fold(f64::NEG_INFINITY, f64::max)
            })
            .iter()
            .sum();
        let bent = 0.5 * dot(&times(&model.cuts[0].bend, x), x);
        (linear + bent) / (1.0 + dot(x, x)).sqrt()
    }

    /// A walk ends at a local minimum of the model, or on the border below where it began; and what
    /// it says of the weights is so.
    #[test]
    fn a_walk_ends_where_nothing_is_lower() {
        let mut r = Random::new(3);
        let mut ends = [0; 4];
        for round in 0..4000 {
            let depth = r.within(-0.3, 0.4);
            let bend = if round % 2 == 0 {
                0.0
            } else {
                r.within(0.1, 1.0)
            };
            let len = [1 + round % 5, 1 + round / 7 % ROOM];
            let model = model(&mut r, len, depth, bend);
            let radius = r.within(0.02, 0.5);
            let mut end = End::default();
            let start = [0.0; 2];
            if bend > 0.0 {
                model.walk_on::<true>(&start, &start, radius, &mut end);
            } else {
                model.walk_on::<false>(&start, &start, radius, &mut end);
            }
            let off = dot(&end.x, &end.x).sqrt();
            assert!(off <= radius * 1.000_01 && !end.lost, "{end:?}");
            assert!(value(&model, &end.x) <= value(&model, &start) + NEAR);
            if end.on_border {
                ends[3] += 1;
                continue;
            }
            ends[end.count] += 1;
            assert!(
                (end.value - value(&model, &end.x)).abs() < NEAR,
                "{} {end:?} {model:?}",
                value(&model, &end.x)
            );
            // The bent model's slope is right to second order about the start, its third
            // derivative no more than three times its slopes and bends.
            let slack = if bend > 0.0 { 3.0 * off * off } else { NEAR };
            for k in 0..24 {
                let (s, c) = (k as f64 * 0.2618).sin_cos();
                let beside = [end.x[0] + 1e-3 * c, end.x[1] + 1e-3 * s];
                let lower = end.value - value(&model, &beside);
                assert!(lower <= NEAR + 1e-3 * slack, "{lower} {end:?}");
            }
            if end.count == 2 && bend == 0.0 && end.is_lowest(radius - off) {
                for k in 0..240 {
                    let (s, c) = (k as f64 * 0.26).sin_cos();
                    let far = (radius - off) * (k as f64 / 240.0);
                    let there = value(&model, &[end.x[0] + far * c, end.x[1] + far * s]);
                    assert!(there >= end.value - 1e-4 * depth.abs() - NEAR);
                }
            }
        }
        assert!(ends.iter().all(|n| *n > 20), "{ends:?}");
    }

    /// Edges of both objects that are parallel are one kink.
    #[test]
    fn parallel_edges_are_walked_along() {
        let mut model = Model::default();
        for (cuts, scale) in model.cuts.iter_mut().zip([0.5, 0.2]) {
            (cuts.len, cuts.a) = (2, [-0.1; ROOM]);
            (cuts.x[0], cuts.x[1]) = (scale, -scale);
            (cuts.y[0], cuts.y[1]) = (0.1, 0.1);
        }
        let mut end = End::default();
        model.walk_on::<false>(&[0.0; 2], &[0.0; 2], 2.0, &mut end);
        assert!(!end.lost && !end.on_border && end.count == 1, "{end:?}");
        assert!(
            end.x[0].abs() < NEAR && (end.x[1] + 1.0).abs() < NEAR,
            "{end:?}"
        );
    }
}
