// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exact cuts in the chart of the best direction, and where their maximum is least.
//!
//! A vertex u of a polytope gives, along the direction b + E x, a support value of at least
//! u·b + (E'u)·x. Divided by the direction's length that is a depth, to second order
//!
//!   m(x) = max over i of (aᵢ + βᵢ·x) − ½ h x²,   aᵢ = uᵢ·b, βᵢ = E'uᵢ, h = the best cut's a.
//!
//! *Unknown*: the x with |x| ≤ Δ where m is least. *Condition* (Karush, Kuhn, Tucker): no
//! other cut lies above those that are active, and their gradients balance with weights
//! ≥ 0; on the border but for a part along x. *Solution*, an active-set method: from the
//! lowest point of the best cut alone, the cut that lies highest above enters, and the one
//! whose weight is negative leaves. One cut: x = β/h where h < 0, else the border. Two meet
//! in a line, three in a point.
//!
//! h < 0 where balls have been taken off shallow objects: m is convex, and the minimum the
//! nearest point of the polytope. h > 0 inside a polytope: m has several minima, and of the
//! points that the method visits the lowest is the answer. An approximation is enough: it
//! chooses where to ask.

use super::lanes::{CUTS, Lanes};
use crate::math::Real;

/// Turns of the active-set method; mostly two or three. Measured: ÷2 a fortieth more answers that
/// are not the least, ×2 nothing.
const TURNS: usize = 8;

/// Up to four cuts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cuts {
    /// The cuts at x = 0, metres.
    pub a: Lanes,
    /// Their gradients, metres a radian.
    pub x: Lanes,
    /// Their gradients, metres a radian.
    pub y: Lanes,
    /// How many there are. Lanes beyond repeat one of them.
    pub len: usize,
    /// h, metres.
    pub height: Real,
    /// The highest cut at x = 0, where the search for the least value begins.
    pub best: usize,
    /// Cuts that differ by no more are equally high, metres.
    pub rounding: Real,
}

/// A point of the chart and the cuts that are active there.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// In the chart, radians.
    pub x: Real,
    /// In the chart, radians.
    pub y: Real,
    /// The highest cut there, metres.
    pub level: Real,
    /// m there, metres.
    pub value: Real,
    /// The active cuts; the first one again beyond `count`.
    pub set: [usize; 3],
    /// How many are active.
    pub count: usize,
    /// Is it stationary there? Else it is on the border.
    pub inside: bool,
}

impl Step {
    /// Squared length, radians².
    #[inline(always)]
    pub fn length2(&self) -> Real {
        self.x * self.x + self.y * self.y
    }

    /// The active cuts.
    #[inline(always)]
    pub fn active(&self) -> &[usize] {
        &self.set[..self.count.min(3)]
    }

    /// The active cuts, as bits.
    #[inline(always)]
    pub fn bits(&self) -> u32 {
        1 << self.set[0] | 1 << self.set[1] | 1 << self.set[2]
    }
}

/// a × b.
#[inline(always)]
fn cross(a: [Real; 2], b: [Real; 2]) -> Real {
    a[0] * b[1] - a[1] * b[0]
}

impl Cuts {
    #[inline(always)]
    fn gradient(&self, i: usize) -> [Real; 2] {
        [self.x[i], self.y[i]]
    }

    /// The gradient of m on cut `i` at a step.
    #[inline(always)]
    fn slope(&self, i: usize, step: &Step) -> [Real; 2] {
        let h = self.height;
        [self.x[i] - h * step.x, self.y[i] - h * step.y]
    }

    /// Where m is least within the radius, in the end that the best cut leads to.
    #[inline]
    pub fn minimise(&self, radius: Real) -> Step {
        let radius2 = radius * radius;
        self.walk(self.one(self.best, radius2), radius2)
    }

    /// Where m is least within the radius: the lowest of all points where one cut is least,
    /// two are, or three meet, and no other lies above.
    #[cold]
    pub fn lowest(&self, radius: Real) -> Step {
        let radius2 = radius * radius;
        let mut lowest = self.one(self.best, radius2);
        lowest.value = Real::INFINITY;
        let mut offer = |step: Option<Step>| {
            let Some(mut step) = step else { return };
            let levels = self.a + self.x * step.x + self.y * step.y;
            step.level = levels[step.set[0]];
            step.value = step.level - 0.5 * self.height * step.length2();
            let above = Self::highest(&levels, levels[step.set[0]] + self.rounding);
            if step.value < lowest.value && above.is_none_or(|i| step.bits() & (1 << i) != 0) {
                lowest = step;
            }
        };
        for i in 0..self.len {
            offer(Some(self.one(i, radius2)));
            for j in 0..i {
                offer(self.two(i, j, radius2));
                for k in 0..j {
                    offer(self.three(i, j, k, radius2));
                }
            }
        }
        lowest
    }

    /// The active-set method from where one cut is least.
    fn walk(&self, mut step: Step, radius2: Real) -> Step {
        let mut lowest = step;
        lowest.value = Real::INFINITY;
        for _ in 0..TURNS {
            let levels = self.a + self.x * step.x + self.y * step.y;
            let top = levels[step.set[0]];
            let above =
                Self::highest(&levels, top + self.rounding).filter(|i| step.bits() & (1 << i) == 0);
            step.level = above.map_or(top, |i| levels[i]);
            step.value = step.level - 0.5 * self.height * step.length2();
            if step.value < lowest.value {
                lowest = step;
            }
            let next = match above {
                Some(i) => self.enter(&step, i, radius2),
                None => self.leave(&step, radius2),
            };
            match next {
                Some(next) => step = next,
                None => break,
            }
        }
        lowest
    }

    /// The highest cut, if it is above `top`.
    #[inline(always)]
    fn highest(levels: &Lanes, top: Real) -> Option<usize> {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| levels[i]);
        let (i, first) = if b > a { (1, b) } else { (0, a) };
        let (k, last) = if d > c { (3, d) } else { (2, c) };
        let (i, most) = if last > first { (k, last) } else { (i, first) };
        (most > top).then_some(i)
    }

    /// The step to where cut `i` alone is least.
    #[inline(always)]
    fn one(&self, i: usize, radius2: Real) -> Step {
        let [x, y] = self.gradient(i);
        let h = self.height;
        let g2 = x * x + y * y;
        let mut step = Step {
            x: radius2.sqrt(),
            y: 0.0,
            level: 0.0,
            value: 0.0,
            set: [i; 3],
            count: 1,
            inside: h < 0.0 && g2 <= h * h * radius2,
        };
        // No gradient: one way along the border is as good as another.
        if step.inside || g2 > 0.0 {
            let f = if step.inside {
                1.0 / h
            } else {
                -(radius2 / g2).sqrt()
            };
            (step.x, step.y) = (f * x, f * y);
        }
        step
    }

    /// The step to where cuts `i` and `j` are equally high and least, if they are in reach.
    #[inline(always)]
    fn two(&self, i: usize, j: usize, radius2: Real) -> Option<Step> {
        let (g, k) = (self.gradient(i), self.gradient(j));
        let d = [g[0] - k[0], g[1] - k[1]];
        let da = self.a[i] - self.a[j];
        let iq = 1.0 / (d[0] * d[0] + d[1] * d[1]);
        let f = -da * iq;
        // Squared half chord; NaN for equal cuts.
        let room = radius2 + f * da;
        if !(room > 0.0) {
            return None;
        }
        // Along the line, from its point nearest to x = 0, in parts of |d|.
        let slope = cross(d, g);
        let h = self.height;
        let inside = h < 0.0 && slope * slope * iq <= h * h * room;
        let t = if inside {
            slope * iq / h
        } else {
            (room * iq).sqrt().copysign(-slope)
        };
        Some(Step {
            x: f * d[0] - t * d[1],
            y: f * d[1] + t * d[0],
            level: 0.0,
            value: 0.0,
            set: [i, j, i],
            count: 2,
            inside,
        })
    }

    /// The step to where three cuts meet, if that is in reach.
    #[inline(always)]
    fn three(&self, i: usize, j: usize, k: usize, radius2: Real) -> Option<Step> {
        let (g, o, p) = (self.gradient(i), self.gradient(j), self.gradient(k));
        let (d, e) = ([g[0] - o[0], g[1] - o[1]], [g[0] - p[0], g[1] - p[1]]);
        let (da, ea) = (self.a[i] - self.a[j], self.a[i] - self.a[k]);
        let w = 1.0 / cross(d, e);
        let step = Step {
            x: (ea * d[1] - da * e[1]) * w,
            y: (da * e[0] - ea * d[0]) * w,
            level: 0.0,
            value: 0.0,
            set: [i, j, k],
            count: 3,
            inside: true,
        };
        // Refuses NaN and infinity too.
        (step.length2() <= radius2).then_some(step)
    }

    /// No cut lies above: the step without the cut whose weight is negative, `None` where
    /// there is none.
    #[inline(always)]
    fn leave(&self, step: &Step, radius2: Real) -> Option<Step> {
        let [i, j, k] = step.set;
        match step.count {
            1 => None,
            2 => {
                let (g, o) = (self.slope(i, step), self.slope(j, step));
                let [u, v] = if step.inside {
                    let d = [g[0] - o[0], g[1] - o[1]];
                    [-(o[0] * d[0] + o[1] * d[1]), g[0] * d[0] + g[1] * d[1]]
                } else {
                    // Across the way to the border they balance.
                    let x = [step.x, step.y];
                    let (s, t) = (cross(x, g), cross(x, o));
                    [t * (t - s), -s * (t - s)]
                };
                if u >= 0.0 && v >= 0.0 {
                    return None;
                }
                Some(self.one(if u < 0.0 { j } else { i }, radius2))
            }
            _ => {
                let [g, o, p] = step.set.map(|i| self.slope(i, step));
                let w = [cross(o, p), cross(p, g), cross(g, o)];
                let sign = (1.0 as Real).copysign(w[0] + w[1] + w[2]);
                let [u, v, w] = w.map(|w| w * sign);
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    None
                } else if u <= v && u <= w {
                    self.two(j, k, radius2)
                } else if v <= w {
                    self.two(i, k, radius2)
                } else {
                    self.two(i, j, radius2)
                }
            }
        }
    }

    /// The step with cut `n`, which lies above.
    #[inline(always)]
    fn enter(&self, step: &Step, n: usize, radius2: Real) -> Option<Step> {
        let [i, j, _] = step.set;
        match step.count {
            1 => Some(
                self.two(i, n, radius2)
                    .unwrap_or_else(|| self.one(n, radius2)),
            ),
            2 => self.three(i, j, n, radius2).or_else(|| {
                // Out of reach: along the border, with the cut across from the new one.
                let x = [step.x, step.y];
                let (t, s) = (cross(x, self.slope(i, step)), cross(x, self.slope(n, step)));
                let (first, second) = if t * s > 0.0 { (j, i) } else { (i, j) };
                self.two(first, n, radius2)
                    .or_else(|| self.two(second, n, radius2))
            }),
            _ => self.exchange(step, n, radius2),
        }
    }

    /// The step where cut `n` takes the place of one of three: of the one without which
    /// the weights can balance.
    #[inline(always)]
    fn exchange(&self, step: &Step, n: usize, radius2: Real) -> Option<Step> {
        let gradients = step.set.map(|i| self.slope(i, step));
        let new = self.slope(n, step);
        let with = gradients.map(|g| cross(new, g));
        let out = (0..3).find(|&i| {
            let (p, q) = ((i + 1) % 3, (i + 2) % 3);
            let other = cross(gradients[p], gradients[q]);
            (with[p] >= 0.0 && other >= 0.0 && with[q] <= 0.0)
                || (with[p] <= 0.0 && other <= 0.0 && with[q] >= 0.0)
        })?;
        let (p, q) = (step.set[(out + 1) % 3], step.set[(out + 2) % 3]);
        self.three(p, q, n, radius2)
            .or_else(|| self.two(p, n, radius2))
    }

    /// The cut to evict: the lowest at the step, of those whose bit is not in `kept`; else the
    /// lowest at x = 0 but the best.
    #[inline]
    pub fn least(&self, kept: u32, step: &Step) -> usize {
        let levels = self.a + self.x * step.x + self.y * step.y;
        levels
            .lowest(|i| kept & (1 << i) == 0)
            .or_else(|| self.a.lowest(|i| i != self.best))
            .unwrap_or((self.best + 1) % CUTS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    fn cuts(random: &mut Random, len: usize, h: Real) -> Cuts {
        let mut cuts = Cuts {
            len,
            height: h,
            ..Cuts::default()
        };
        for i in 0..4 {
            // The best is the highest at b; lanes beyond repeat it.
            let (repeats, below) = (
                i >= len,
                if i == 0 {
                    0.0
                } else {
                    random.within(0.0, 0.02)
                },
            );
            let slope = |random: &mut Random| random.within(-0.3, 0.3);
            cuts.a[i] = if repeats { h } else { h - below };
            cuts.x[i] = if repeats { cuts.x[0] } else { slope(random) };
            cuts.y[i] = if repeats { cuts.y[0] } else { slope(random) };
        }
        cuts
    }

    fn value(cuts: &Cuts, x: Real, y: Real) -> Real {
        let top = (0..cuts.len)
            .map(|i| cuts.a[i] + cuts.x[i] * x + cuts.y[i] * y)
            .fold(Real::NEG_INFINITY, Real::max);
        top - 0.5 * cuts.height * (x * x + y * y)
    }

    /// The least value on a fine grid of the disc.
    fn grid(cuts: &Cuts, radius: Real) -> Real {
        let mut least = Real::INFINITY;
        for i in 0..=40 {
            let r = radius * i as Real / 40.0;
            for k in 0..120 {
                let (s, c) = (k as Real * (core::f64::consts::TAU as Real / 120.0)).sin_cos();
                least = least.min(value(cuts, r * c, r * s));
            }
        }
        least
    }

    /// Convex: the least value. Else mostly: at least a stationary point, no higher than b. The
    /// walk from the best cut mostly leads there.
    #[test]
    fn the_least_value_of_the_model() {
        let mut random = Random::new(3);
        let (mut least, mut walked, mut all) = (0, 0, 0);
        for round in 0..2000 {
            let h = random.within(-0.5, 0.5);
            let c = cuts(&mut random, 1 + round % 4, h);
            let radius = random.within(0.02, 0.5);
            let step = c.lowest(radius);
            let there = value(&c, step.x, step.y);
            assert!(step.length2() <= radius * radius * 1.000_001);
            assert!((there - step.value).abs() < 1e-6, "{step:?}");
            assert!(there <= h + 1e-6);
            let best = grid(&c, radius);
            walked += usize::from(c.minimise(radius).value <= best + 1e-5);
            if h < 0.0 {
                assert!(there <= best + 1e-5, "{there} {best} {step:?}");
            } else {
                all += 1;
                least += usize::from(there <= best + 1e-5);
            }
        }
        assert!(least * 10 > all * 9, "{least} of {all}");
        assert!(walked > 1800, "{walked} of 2000");
    }

    #[test]
    fn the_lowest_cut_is_evicted() {
        let mut random = Random::new(4);
        let c = cuts(&mut random, 4, 0.3);
        let step = c.minimise(0.1);
        let out = c.least(step.bits() | 1, &step);
        assert!(out != 0 && step.bits() & (1 << out) == 0);
        assert_ne!(c.least(0b1111, &step), 0);
    }
}
