// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The model of the depth around the bundle's centre, and its minimum within the trust radius.

use super::curvature::{BELIEVED, Curvature};
use super::samples::{Lanes, OTHERS, Samples, lane};
use crate::known::round::ALIKE;
use crate::math::{Real, Vec3};

/// The chart around the bundle's centre and the cuts α + β·x in it.
pub struct Model {
    pub b: Vec3,
    pub e1: Vec3,
    pub e2: Vec3,
    /// R in the chart is ρ I + A.
    pub rho: Real,
    /// A is [[axx, axy], [axy, −axx]].
    axx: Real,
    axy: Real,
    /// h(b) − ρ: K = A − core · I.
    core: Real,
    /// α − ρ.
    pub a: Lanes,
    /// β.
    pub x: Lanes,
    pub y: Lanes,
    /// The cuts without R: the heights of the support points along b, metres.
    pub level: Lanes,
    /// How far R lifts each cut at x = 0, metres, …
    pub lift: Lanes,
    /// … and how far it moves the support point across b, metres.
    pub turned: [Lanes; 2],
    len: usize,
    centre: usize,
}

/// α + β·x.
#[derive(Clone, Copy, Default)]
struct Cut {
    a: Real,
    x: Real,
    y: Real,
}

impl Cut {
    #[inline]
    fn at(&self, x: Real, y: Real) -> Real {
        self.a + self.x * x + self.y * y
    }

    #[inline]
    fn minus(&self, o: &Self) -> Self {
        Self {
            a: self.a - o.a,
            x: self.x - o.x,
            y: self.y - o.y,
        }
    }
}

/// A point of the chart that minimises the model, and the cuts active there.
#[derive(Clone, Copy)]
pub struct Step {
    pub x: Real,
    pub y: Real,
    /// The depth foretold there, metres.
    pub value: Real,
    /// The first is the centre or the newest; those beyond `count` repeat another.
    pub set: [usize; 3],
    pub count: usize,
    /// Within the trust radius, not on its border.
    pub inside: bool,
}

impl Step {
    /// The active cuts.
    #[inline(always)]
    pub fn active(&self) -> impl Iterator<Item = usize> {
        self.set.into_iter().take(self.count)
    }

    #[inline(always)]
    pub fn length2(&self) -> Real {
        self.x * self.x + self.y * self.y
    }

    /// Weights of one or two active cuts whose gradients (x, y) come nearest to balance.
    pub fn weights(&self, x: &Lanes, y: &Lanes) -> [Real; 2] {
        let [g, h, _] = self.set.map(|i| (x[i], y[i]));
        let d = (h.0 - g.0, h.1 - g.1);
        let t = -(g.0 * d.0 + g.1 * d.1) / (d.0 * d.0 + d.1 * d.1);
        // NaN, of one cut, becomes 0.
        let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
        [1.0 - t, t]
    }
}

/// Two unit vectors that make an orthonormal basis with the unit vector b, without a branch
/// (Duff et al., JCGT 6(1), 2017).
#[inline(always)]
pub fn basis(b: &Vec3) -> (Vec3, Vec3) {
    let sign = (1.0 as Real).copysign(b.z);
    let c = -1.0 / (sign + b.z);
    let d = b.x * b.y * c;
    (
        Vec3::new(1.0 + sign * b.x * b.x * c, sign * d, -sign * b.x),
        Vec3::new(d, sign + b.y * b.y * c, -b.y),
    )
}

impl Model {
    #[inline]
    pub fn new(samples: &Samples, curvature: &Curvature) -> Self {
        let b = samples.dir();
        let (e1, e2) = basis(&b);
        let (rho, axx, axy) = if curvature.known {
            curvature.within(&e1, &e2)
        } else {
            (0.0, 0.0, 0.0)
        };
        let level = samples.v.dot(&b);
        let mut model = Self {
            b,
            e1,
            e2,
            rho,
            axx,
            axy,
            core: samples.depth() - rho,
            a: level - Lanes::all(rho),
            x: samples.v.dot(&e1),
            y: samples.v.dot(&e2),
            level,
            lift: Lanes::default(),
            turned: [Lanes::default(); 2],
            len: samples.len,
            centre: samples.centre,
        };
        if rho > 0.0 && curvature.error <= BELIEVED && samples.len > 1 {
            model.curve_cuts(samples);
        }
        model
    }

    /// Makes cuts curved, those that R can be believed of.
    #[inline(always)]
    fn curve_cuts(&mut self, samples: &Samples) {
        let Self { rho, axx, axy, .. } = *self;
        let h = samples.depth();
        let z = samples.n.dot(&self.b);
        let (tx, ty) = (samples.n.dot(&self.e1), samples.n.dot(&self.e2));
        let (x, y) = (tx / z, ty / z);
        let (ax, ay) = (x * axx + y * axy, x * axy - y * axx);
        let lift = (Lanes::all(1.0) - z) * rho + (ax * x + ay * y) * 0.5;
        let behind = Lanes::all(h) - self.level;
        let ahead = samples.h - samples.n.dot(&samples.v.get(self.centre));
        let mut unlike = (ahead - behind).map(Real::abs) - (ahead + behind) * ALIKE;
        unlike[self.centre] = 0.0;
        // A smooth pair is one piece, which b itself represents; a lift above
        // h(b) is refuted. Both stay exact cuts.
        let curves = |i: usize| (lift[i] >= 0.0) & (lift[i] <= behind[i]) & (unlike[i] > 0.0);
        let curved = |l: Lanes| Lanes::from_fn(|i| if curves(i) { l[i] } else { 0.0 });
        self.lift = curved(lift);
        self.turned = [curved(tx * -rho - ax), curved(ty * -rho - ay)];
        self.a = self.a + self.lift;
        self.x = self.x + self.turned[0];
        self.y = self.y + self.turned[1];
    }

    /// Least model value within the trust radius: the lowest of the points where one cut has
    /// its minimum, two meet and have theirs, or three meet, among those that the
    /// centre or the newest cut is part of (the others were there before).
    #[inline]
    pub fn minimise(&self, newest: usize, radius: Real, rounding: Real) -> Step {
        let mut step = Step {
            x: 0.0,
            y: 0.0,
            value: Real::INFINITY,
            set: [self.centre; 3],
            count: 1,
            inside: false,
        };
        if self.len == 1 {
            (step.x, step.y, step.inside) = self.lowest_on(&self.cut(self.centre), radius);
        } else if !self.pivot(self.centre, radius, rounding, &mut step) && newest != self.centre {
            self.pivot(newest, radius, rounding, &mut step);
        }
        // The model's own value of the depth there, exact for P and for balls.
        let (x, y) = (step.x, step.y);
        let i = step.set[0];
        let v = self.a[i] + self.x[i] * x + self.y[i] * y;
        let bent = 0.5 * self.axx * (x * x - y * y) + self.axy * x * y;
        step.value = (v + bent) / (1.0 + x * x + y * y).sqrt() + self.rho;
        step
    }

    #[inline(always)]
    fn cut(&self, i: usize) -> Cut {
        Cut {
            a: self.a[i],
            x: self.x[i],
            y: self.y[i],
        }
    }

    /// The candidates of [`Self::minimise`] with cut `p`. True where one of them is the minimum:
    /// that of a cut whose own is within the trust radius, and below no other cut.
    #[inline]
    fn pivot(&self, p: usize, radius: Real, rounding: Real, step: &mut Step) -> bool {
        let c = self.cut(p);
        let (kxx, kxy, kyy) = (self.axx - self.core, self.axy, -self.axx - self.core);
        let radius2 = radius * radius;
        let others = &OTHERS[lane(p)];
        let len = self.len - 1;
        // How far c lies above each other cut.
        let above = [
            c.minus(&self.cut(others[0])),
            c.minus(&self.cut(others[1])),
            c.minus(&self.cut(others[2])),
        ];
        let mut offer = |x: Real, y: Real, i: usize, j: usize, count: usize, inside: bool| {
            let value = c.at(x, y) + 0.5 * (kxx * x * x + kyy * y * y) + kxy * x * y;
            let lowest = value < step.value
                && above[0].at(x, y) >= -rounding
                && above[1].at(x, y) >= -rounding
                && above[2].at(x, y) >= -rounding;
            if lowest {
                *step = Step {
                    x,
                    y,
                    value,
                    set: [p, i, j],
                    count,
                    inside,
                };
            }
            lowest
        };
        let (x, y, inside) = self.lowest_on(&c, radius);
        if offer(x, y, p, p, 1, inside) && inside {
            return true;
        }
        for k in 0..len.min(3) {
            let (d, i) = (&above[k], others[k]);
            if i == self.centre {
                // It was looked at with the centre.
                continue;
            }
            // On the line d = 0, from its point nearest to x = 0.
            let q = d.x * d.x + d.y * d.y;
            let f = -d.a / q;
            // Squared half chord of the line in the trust region; NaN for equal cuts.
            let room = radius2 + f * d.a;
            if room > 0.0 {
                let (x0, y0) = (f * d.x, f * d.y);
                let (tx, ty) = (-d.y, d.x);
                let (kx, ky) = (kxx * tx + kxy * ty, kxy * tx + kyy * ty);
                let slope = c.x * tx + c.y * ty + x0 * kx + y0 * ky;
                let bend = kx * tx + ky * ty;
                let mut t = -slope / bend;
                let inside = bend > 0.0 && t * t * q <= room;
                if !inside {
                    t = (room / q).sqrt().copysign(-slope);
                }
                offer(x0 + t * tx, y0 + t * ty, i, i, 2, inside);
            }
            for l in 0..k {
                let (e, j) = (&above[l], others[l]);
                if j == self.centre {
                    continue;
                }
                let w = 1.0 / (d.x * e.y - d.y * e.x);
                let (x, y) = ((e.a * d.y - d.a * e.y) * w, (e.x * d.a - d.x * e.a) * w);
                // Refuses NaN and infinity too.
                if x * x + y * y <= radius2 {
                    offer(x, y, i, j, 3, true);
                }
            }
        }
        false
    }

    /// Where one cut alone has its minimum within the trust radius, and whether that is inside.
    #[inline(always)]
    fn lowest_on(&self, c: &Cut, radius: Real) -> (Real, Real, bool) {
        let (kxx, kxy, kyy) = (self.axx - self.core, self.axy, -self.axx - self.core);
        let (mut x, mut y) = (-c.x, -c.y);
        let det = kxx * kyy - kxy * kxy;
        if det > 0.0 && kxx > 0.0 {
            let di = 1.0 / det;
            (x, y) = ((kyy * x - kxy * y) * di, (kxx * y - kxy * x) * di);
            if x * x + y * y <= radius * radius {
                return (x, y, true);
            }
        }
        let g = x * x + y * y;
        if g > 0.0 {
            let f = radius / g.sqrt();
            (x * f, y * f, false)
        } else {
            // No gradient: one way is as good as another.
            (radius, 0.0, false)
        }
    }

    /// How far R raises cut `i` at (x, y).
    #[inline]
    pub fn raise(&self, i: usize, x: Real, y: Real) -> Real {
        let turned = self.turned[0][i] * x + self.turned[1][i] * y;
        self.lift[i] + turned + 0.5 * self.curvature_along(x, y)
    }

    /// How far R moves a support point across b on the way to (x, y), as seen from the point below
    /// the origin.
    pub fn pull(&self, x: Real, y: Real) -> (Real, Real) {
        (
            (self.axx - self.core) * x + self.axy * y,
            self.axy * x - (self.axx + self.core) * y,
        )
    }

    /// x'Rx of the vector (x, y).
    #[inline]
    pub fn curvature_along(&self, x: Real, y: Real) -> Real {
        self.rho * (x * x + y * y) + self.axx * (x * x - y * y) + 2.0 * self.axy * x * y
    }

    #[inline]
    pub fn direction(&self, x: Real, y: Real) -> Vec3 {
        self.b + self.e1 * x + self.e2 * y
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::CUTS;
    use super::super::samples::tests::{around, samples};
    use super::*;
    use crate::known::round::Symmetric;
    use crate::known::support::Known;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Shape, capsule, corners, hull, placed};

    impl Model {
        /// The highest cut.
        fn top(&self, x: Real, y: Real) -> Real {
            let cuts = (0..self.len).map(|i| self.cut(i).at(x, y));
            cuts.fold(Real::NEG_INFINITY, Real::max)
        }

        /// The depth to second order.
        fn second_order(&self, x: Real, y: Real) -> Real {
            let bent = self.curvature_along(x, y) - (self.core + self.rho) * (x * x + y * y);
            self.top(x, y) + 0.5 * bent
        }

        /// Its least value on a fine grid of the trust region.
        fn least_on_grid(&self, radius: Real) -> Real {
            let mut least = Real::INFINITY;
            for i in 0..=40 {
                for k in 0..120 {
                    let (s, c) = (k as Real * (core::f64::consts::TAU as Real / 120.0)).sin_cos();
                    let r = radius * i as Real / 40.0;
                    least = least.min(self.second_order(r * c, r * s));
                }
            }
            least
        }
    }

    /// The minimum within the trust radius is no higher than any point of a fine grid, when
    /// each of the cuts is the newest once.
    fn compare_with_grid(shape: &Shape, curvature: &Curvature, r: &mut Random) {
        for count in 1..=CUTS {
            let dirs = around(r, count, 0.3);
            let mut known = Known::default();
            let samples = samples(&mut known, shape, &dirs);
            let model = Model::new(&samples, curvature);
            let slack = 16.0 * samples.rounding;
            for radius in [0.01, 0.1, 0.4] {
                let steps: Vec<_> = (0..count)
                    .map(|newest| model.minimise(newest, radius, samples.rounding))
                    .collect();
                let mut least = Real::INFINITY;
                for step in steps {
                    assert!(step.length2().sqrt() <= radius * (1.0 + 8.0 * EPSILON));
                    assert!(step.count <= count);
                    for i in step.active() {
                        let below = model.top(step.x, step.y) - model.cut(i).at(step.x, step.y);
                        assert!(below <= slack);
                    }
                    least = least.min(model.second_order(step.x, step.y));
                }
                let grid = model.least_on_grid(radius);
                assert!(least <= grid + slack, "{count} {radius}: {least} {grid}");
            }
        }
    }

    #[test]
    fn the_minimum_of_exact_cuts_is_no_higher_than_a_grid() {
        let mut r = Random::new(6);
        for _ in 0..40 {
            let points = placed(
                &corners(Vec3::new(0.5, 0.4, 0.3)),
                &r.rotation(),
                r.vector(0.2),
            );
            compare_with_grid(&hull(&points), &Curvature::new(), &mut r);
        }
    }

    #[test]
    fn the_minimum_of_curved_cuts_is_no_higher_than_a_grid() {
        let mut r = Random::new(7);
        for _ in 0..40 {
            let shape = capsule(r.vector(0.5), r.vector(0.5), 0.6);
            let mut curvature = Curvature::new();
            curvature.recall(Symmetric([0.6, 0.0, 0.0, 0.6, 0.0, 0.6]), None);
            compare_with_grid(&shape, &curvature, &mut r);
        }
    }

    #[test]
    fn balls_taken_off_the_cuts_of_a_capsule_are_exact() {
        let mut r = Random::new(8);
        let (p, q) = (Vec3::new(0.1, 0.0, 0.3), Vec3::new(-0.1, 0.05, -0.3));
        let shape = capsule(p, q, 0.5);
        let mut curvature = Curvature::new();
        curvature.recall(Symmetric([0.5, 0.0, 0.0, 0.5, 0.0, 0.5]), None);
        for _ in 0..200 {
            let dirs = around(&mut r, 2, 0.3);
            let mut known = Known::default();
            let samples = samples(&mut known, &shape, &dirs);
            let apart = (samples.v.get(0) - dirs[0] * 0.5) - (samples.v.get(1) - dirs[1] * 0.5);
            if apart.norm() < 0.1 {
                continue;
            }
            let model = Model::new(&samples, &curvature);
            let step = model.minimise(1, 0.2, samples.rounding);
            let n = model.direction(step.x, step.y).normalize();
            if model.lift[1 - samples.centre] > 0.0 {
                let slack = 32.0 * EPSILON;
                assert!((n.dot(&shape(&n)) - step.value).abs() <= slack);
            }
        }
    }
}
