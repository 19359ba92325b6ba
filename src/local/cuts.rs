// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Exact cuts in the chart of the best direction, and where their maximum is least.
//!
//! A vertex u of a polytope gives, along the direction b + E x, a support value of at least
//! u·b + (E'u)·x. Divided by the direction's length that is a depth, to second order
//!
//!   m(x) = max over i of (aᵢ + βᵢ·x) + ½ x'Kx,   aᵢ = uᵢ·b, βᵢ = E'uᵢ, K = −h I,
//!
//! h the best cut's a. A disc that is taken off adds r m(b) to u, and its curvature to K; E is
//! along the principal directions, so K is two numbers.
//!
//! *Unknown*: the x with |x| ≤ Δ where m is least. *Condition* (Karush, Kuhn, Tucker): no
//! other cut lies above those that are active, and their gradients balance with weights
//! ≥ 0; on the border but for a part along x. *Solution*, an active-set method: from the
//! lowest point of the best cut alone, the cut that lies highest above enters, and the one
//! whose weight is negative leaves. One cut: x = −K⁻¹β where K > 0, else the border. Two meet
//! in a line, three in a point.
//!
//! h < 0 where balls have been taken off shallow objects: m is convex, and the minimum the
//! nearest point of the polytope. h > 0 inside a polytope: m has several minima, and of the
//! points that the method visits the lowest is the answer. An approximation is enough: it
//! chooses where to ask.

use super::lanes::{CUTS, Lanes};
use crate::math::{Real, larger, lesser};

/// Turns of the active-set method; mostly two or three. Derived: each cut enters and leaves once.
const TURNS: usize = 2 * CUTS;

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
    /// K along x and y, metres: −h where no disc is taken off.
    pub bend: [Real; 2],
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
        let [k, l] = self.bend;
        [self.x[i] + k * step.x, self.y[i] + l * step.y]
    }

    /// ½ x'Kx at a step.
    #[inline(always)]
    fn bent(&self, step: &Step) -> Real {
        let [k, l] = self.bend;
        0.5 * (k * step.x * step.x + l * step.y * step.y)
    }

    /// The weights of the active cuts whose gradients balance, or come nearest to it.
    pub fn weights(&self, step: &Step) -> [Real; 3] {
        let [g, o, p] = step.set.map(|i| self.slope(i, step));
        let weights = match step.count {
            3 => [cross(o, p), cross(p, g), cross(g, o)],
            2 => {
                let d = [g[0] - o[0], g[1] - o[1]];
                [-(o[0] * d[0] + o[1] * d[1]), g[0] * d[0] + g[1] * d[1], 0.0]
            }
            _ => [1.0, 0.0, 0.0],
        };
        let sum = weights[0] + weights[1] + weights[2];
        // max drops NaN.
        let weights = weights.map(|w| (w / sum).max(0.0));
        let sum = weights[0] + weights[1] + weights[2];
        if sum > 0.0 && sum < Real::INFINITY {
            weights.map(|w| w / sum)
        } else {
            [1.0, 0.0, 0.0]
        }
    }

    /// Of a step to where two cuts are least: is m nowhere lower within the radius of it?
    ///
    /// With the gradients g = w₁ d and −w₀ d, d = g − g′, m is higher by at least
    /// min w |d| |q| + ½ x'Kx, x = s t + q d/|d|, where K along t is not negative: no lower, if
    /// min w |d| is at least |t'K d/|d|| and half of what K is negative, times Δ.
    pub fn is_ridge(&self, step: &Step, radius: Real) -> bool {
        let [g, o, _] = step.set.map(|i| self.slope(i, step));
        let [w, v, _] = self.weights(step);
        let d = [g[0] - o[0], g[1] - o[1]];
        let d2 = d[0] * d[0] + d[1] * d[1];
        let [k, l] = self.bend;
        let twist = ((k - l) * d[0] * d[1]).abs() / d2;
        let falls = larger(-lesser(k, l), 0.0);
        lesser(w, v) * d2.sqrt() >= (twist + 0.5 * falls) * radius
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
            step.value = step.level + self.bent(&step);
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
            step.value = step.level + self.bent(&step);
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
        let [k, l] = self.bend;
        let mut step = Step {
            x: -x,
            y: -y,
            level: 0.0,
            value: 0.0,
            set: [i; 3],
            count: 1,
            inside: false,
        };
        // Convex: towards the minimum; else down the gradient.
        if k > 0.0 && l > 0.0 {
            (step.x, step.y) = (-x / k, -y / l);
            step.inside = step.length2() <= radius2;
        }
        if !step.inside {
            let length2 = step.length2();
            // No gradient: one way along the border is as good as another.
            (step.x, step.y) = if length2 > 0.0 {
                let f = (radius2 / length2).sqrt();
                (f * step.x, f * step.y)
            } else {
                (radius2.sqrt(), 0.0)
            };
        }
        step
    }

    /// The step to where cuts `i` and `j` are equally high and least, if they are in reach.
    #[inline(always)]
    fn two(&self, i: usize, j: usize, radius2: Real) -> Option<Step> {
        let (g, o) = (self.gradient(i), self.gradient(j));
        let d = [g[0] - o[0], g[1] - o[1]];
        let da = self.a[i] - self.a[j];
        let iq = 1.0 / (d[0] * d[0] + d[1] * d[1]);
        let f = -da * iq;
        // Squared half chord; NaN for equal cuts.
        let room = radius2 + f * da;
        if !(room > 0.0) {
            return None;
        }
        // Along the line, from its point nearest to x = 0, in parts of |d|.
        let [k, l] = self.bend;
        let slope = cross(d, g) + f * d[0] * d[1] * (l - k);
        let bend = k * d[1] * d[1] + l * d[0] * d[0];
        let mut t = -slope / bend;
        let inside = bend > 0.0 && t * t <= room * iq;
        if !inside {
            t = (room * iq).sqrt().copysign(-slope);
        }
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
            bend: [-h; 2],
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
        top + 0.5 * (cuts.bend[0] * x * x + cuts.bend[1] * y * y)
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

    /// With a disc taken off: stationary inside, and the least value where m is convex.
    #[test]
    fn the_least_value_where_a_disc_bends() {
        let mut random = Random::new(5);
        let (mut inside, mut least) = (0, 0);
        for round in 0..2000 {
            let h = random.within(0.0, 0.3);
            let mut c = cuts(&mut random, 1 + round % 4, h);
            c.bend = [random.within(0.1, 2.0) - h, random.within(0.0, 0.6) - h];
            let radius = random.within(0.02, 0.5);
            let step = c.lowest(radius);
            let there = value(&c, step.x, step.y);
            assert!(
                (there - step.value).abs() < 1e-6 && step.length2() <= radius * radius * 1.000_001
            );
            let best = grid(&c, radius);
            least += usize::from(there <= best + 1e-3 * h + 1e-5);
            let weights = c.weights(&step);
            assert!((weights.iter().sum::<Real>() - 1.0).abs() < 1e-5);
            let mean = |lanes: &Lanes, bend: Real, x: Real| -> Real {
                let terms = step.set.iter().zip(weights);
                terms.map(|(&i, w)| lanes[i] * w).sum::<Real>() + bend * x
            };
            let (x, y) = (mean(&c.x, c.bend[0], step.x), mean(&c.y, c.bend[1], step.y));
            // Gradients that balance, where m is convex.
            if step.inside && x.abs() + y.abs() < 1e-5 && c.bend[0] > 0.0 && c.bend[1] > 0.0 {
                inside += 1;
                assert!(there <= best + 1e-5, "{there} {best} {step:?}");
            }
            let ridge = step.inside && step.count == 2 && c.is_ridge(&step, radius);
            assert!(!ridge || there <= grid(&c, radius - step.length2().sqrt()) + 1e-5);
        }
        assert!(inside > 300, "{inside}");
        assert!(least > 1400, "{least} of 2000");
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
