// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The trust region: how far around the bundle's centre the model is believed.

use crate::math::{EPSILON, Vec3, larger, lesser, perpendicular};

/// First trust radius, radians: the error of a good guess. Measured: ×2 −2.5 %, 34 more, and 63
/// more of those from 5°; ÷2 +4.9 %, +68 % (spheres).
pub const FIRST: f64 = 0.1;
/// The radius grows by this when a reduction foretold on its border came true … Measured: ×2
/// +0.5 %, 12 more of the boxes from 45°; ÷2 +4 %, 100 more; 2 and 3 +0.5 %, +0.3 %.
pub const GROW: f64 = 2.5;
/// … to this share, … Measured: 0.9 −0.5 %, 6 more; ÷2 +0.7 %, +12 %, 10 more; never +13 %.
const TRUE: f64 = 0.7;
/// … and shrinks by this when there was none. Measured: 0.8 no change, +9 % (hulls from 45°),
/// 74 fewer; ÷2 +4.2 %, 93 more; never +3 %, +130 % (hulls), 220 fewer.
const SHRINK: f64 = 0.6;
/// Largest radius, in the chart: tan 45°. Derived: farther off it stretches more than it shows.
const LARGEST: f64 = 1.0;
/// A step aside, radians, that shows curvature and is still near: the smallest first step, the
/// step across the one direction known, the largest one towards a remembered cut. Measured: ×2
/// +0.2 %, +62 % (ellipsoids in motion); ÷2 +0.1 %, +4 % (hulls in motion).
pub const ASIDE: f64 = 0.03;

/// The trust radius, and what was foretold.
pub struct TrustRegion {
    /// Trust radius, radians.
    pub radius: f64,
    /// The depth foretold for the direction asked next, metres; NaN without a forecast.
    foretold: f64,
    /// Was that on the border?
    on_border: bool,
}

impl Default for TrustRegion {
    #[inline]
    fn default() -> Self {
        Self {
            radius: FIRST,
            foretold: f64::NAN,
            on_border: false,
        }
    }
}

impl TrustRegion {
    /// From the first sample (n, v), with nothing but the `size` of D to go by: down the
    /// gradient as on a ball, at least far enough to see curvature. Unit.
    #[inline]
    pub fn first_step(&mut self, n: &Vec3, v: &Vec3, size: f64) -> Vec3 {
        let h = n.dot(v);
        let gradient = v - n * h;
        let slope = gradient.norm();
        let core = h - size;
        let ball = -slope / core;
        let radius = self.radius;
        let length = if ball > 0.0 {
            lesser(ball, radius)
        } else {
            radius
        };
        let length = larger(length, ASIDE);
        let on_border = length == radius;
        let depth = (core - slope * length) / (1.0 + length * length).sqrt() + h - core;
        self.foretell(depth, on_border);
        // No gradient but rounding: one way is as good as another.
        let down = if slope > 4.0 * EPSILON * h {
            gradient * (-1.0 / slope)
        } else {
            perpendicular(n)
        };
        // A bold step goes a little aside, so that no symmetry of the start hides what
        // is across.
        let down = if on_border {
            down + n.cross(&down) * FIRST
        } else {
            down
        };
        let d = n + down * length;
        d * (1.0 / d.norm())
    }

    /// The next direction is asked for this depth.
    #[inline]
    pub fn foretell(&mut self, depth: f64, on_border: bool) {
        self.foretold = depth;
        self.on_border = on_border;
    }

    /// The next direction is asked for what it tells, not for its depth.
    #[inline]
    pub fn no_forecast(&mut self) {
        self.foretold = f64::NAN;
    }

    /// Is the depth `h` as low as foretold, but for the tolerance? False without a forecast.
    #[inline]
    pub fn came_true(&self, h: f64, tolerance: f64) -> bool {
        h - self.foretold <= tolerance
    }

    /// Compares the actual with the predicted reduction, from the least depth `before` to `h` in the
    /// direction asked since, metres.
    #[inline]
    pub fn compare(&mut self, h: f64, before: f64) {
        let (actual, predicted) = (before - h, before - self.foretold);
        if actual > 0.0 {
            // False for NaN: no forecast.
            if self.on_border && actual > TRUE * predicted {
                self.radius = lesser(self.radius * GROW, LARGEST);
            }
        } else if self.foretold.is_finite() {
            self.radius *= SHRINK;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The radius after a step, on the border or not, that foretold a reduction of 0.1 and brought so much
    /// of it.
    fn radius_after(came: f64, on_border: bool) -> f64 {
        let mut trust = TrustRegion::default();
        trust.foretell(0.9, on_border);
        trust.compare(1.0 - 0.1 * came, 1.0);
        trust.radius
    }

    #[test]
    fn a_reduction_as_foretold_on_the_border_widens_it() {
        assert_eq!(radius_after(1.0, true), FIRST * GROW);
        assert_eq!(radius_after(0.5, true), FIRST);
        assert_eq!(radius_after(1.0, false), FIRST);
    }

    #[test]
    fn no_reduction_narrows_it() {
        for came in [-0.1, -1.0, -10.0] {
            assert_eq!(radius_after(came, true), FIRST * SHRINK);
            assert_eq!(radius_after(came, false), FIRST * SHRINK);
        }
        // Less than was foretold is no failure.
        assert_eq!(radius_after(0.1, true), FIRST);
    }

    #[test]
    fn without_a_forecast_it_stays() {
        let mut trust = TrustRegion::default();
        trust.compare(2.0, 1.0);
        trust.foretell(0.9, true);
        trust.no_forecast();
        trust.compare(0.0, 1.0);
        assert_eq!(trust.radius, FIRST);
    }

    #[test]
    fn it_has_an_end_both_ways() {
        let mut trust = TrustRegion::default();
        for _ in 0..20 {
            trust.foretell(0.9, true);
            trust.compare(0.9, 1.0);
        }
        assert_eq!(trust.radius, LARGEST);
    }
}
