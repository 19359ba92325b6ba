// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Sphere fits of the two objects, which choose where to query. They prove nothing.
//!
//! 1. *Fit.* Two samples (n, p) and (n′, p′) of a sphere of radius ρ lie beyond each other's planes by
//!    half of ρ |n′ − n|²: with e = n′·(p′ − p) and f = n·(p − p′), e = f and ρ = (e + f) / |n′ − n|². Each
//!    new entry of the vertex set is compared with the entry of the least support value.
//! 2. *Prediction.* With the spheres taken off, the corners of a face are corners of the core of D. The
//!    foot w of the origin on their triangle predicts the least support value ρ − |w| along −w / |w|, or
//!    ρ + |w| along w where the origin is on the inner side.
//! 3. *Confirmation.* A prediction that comes true confirms the fit; one that misses resets the radii, and
//!    after [`MAX_FAILED_PREDICTIONS`] of them the fit is not used any more.
//! 4. *Beside.* Where the fit is confirmed, the least direction tilted towards a face finds a corner as far
//!    from it as a face may lie within the gap.

use crate::gjk::barycentric;
use crate::math::{Vec3, lesser, normalise_unscaled};
use crate::minkowski::query::{Stop, SupportQuery, SupportSample, UpperBound};
use crate::minkowski::support::SupportMap;
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The differences allowed between two samples of one sphere.
struct FitTolerance {
    /// Of e and f, relative.
    relative: f64,
    /// The least square of the cosine between the moves of direction and vertex.
    cos2: f64,
}

/// Insensitive: 0.02 to 0.1.
const LOOSE: FitTolerance = FitTolerance {
    relative: 0.03,
    cos2: 0.999,
};
/// Far above the rounding of the callbacks.
const EXACT: FitTolerance = if cfg!(feature = "single") {
    FitTolerance {
        relative: 3e-4,
        cos2: 1.0 - 1e-5,
    }
} else {
    FitTolerance {
        relative: 1e-6,
        cos2: 1.0 - 1e-9,
    }
};
/// The share of the radius by which centers of exact fits may differ.
const EXACT_CENTER_REL: f64 = 1.0 - EXACT.cos2;
/// The least square of the angle between two samples that tell a radius or a curvature.
pub const MIN_ANGLE2: f64 = 1e-10;
/// The share of the radius below which a distance of the core from the origin is rounding.
pub const MIN_CORE_DISTANCE_REL: f64 = 1e-9;
/// The number of support calls before fits are made. Measured: without it 3 % more instructions for recorded hits,
/// and no support point less.
const MIN_SAMPLES: usize = 4;
/// The share of the gap that a prediction must gain to be queried. Insensitive: 0.2 to 0.5; 0 takes 7 % more
/// support points of proofs.
pub const MIN_GAIN: f64 = 0.3;
/// The share of a prediction's gain that may be missed. Insensitive: 0.2 to 0.5.
pub const PREDICTION_REL_TOL: f64 = 0.2;
/// The predictions of a model that miss before it is not used any more. Without a limit some walks take 60 support
/// points more, and a proof of `campaign` ("centre offset along a shared axis") ends at the support limit.
pub const MAX_FAILED_PREDICTIONS: u32 = 5;
/// The k below which a second ring is no wider than EPA's own; without it proofs of the same category end at the
/// support limit. Insensitive: 0.33 to 0.6.
const MIN_RING_K: f64 = 0.5;
/// The largest ratio of two rings around the least direction. Measured: without it 11 % more support points of
/// proofs to 1e-10 m of shallow round pairs.
const MAX_RING_RATIO: f64 = 100.0;

/// The source of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectionSource {
    /// The normal of the face.
    Normal,
    /// The prediction of the sphere fit.
    Prediction,
    /// The least direction, tilted towards the face.
    Tilted,
}

/// A direction to evaluate.
#[derive(Clone, Copy, Debug)]
struct QueryDirection {
    /// Unit.
    dir: Vec3,
    choice: DirectionSource,
    /// The support value that a prediction tells, metres.
    value: f64,
}

/// The sphere fits of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereFit {
    /// The radii of obj1 and obj2, metres; 0 without a fit.
    pub radius: [f64; 2],
    /// The last prediction was confirmed.
    pub is_confirmed: bool,
    /// Two samples must fit one sphere but for rounding; a prediction may then be an answer.
    is_exact: bool,
    /// The number of entries that were compared.
    compared: usize,
    misses: u32,
}

impl SphereFit {
    /// Returns the radius of the sphere of D, metres; 0 without a fit.
    #[inline(always)]
    pub fn sum(&self) -> f64 {
        self.radius[0] + self.radius[1]
    }

    /// Compares the new entries of the set with entry `lowest`, those of an exact fit with the one before too: of
    /// several spheres of an object it is the one at the least support value.
    pub fn update<const N: usize>(&mut self, set: &VertexSet<N>, lowest: usize) {
        let tolerance = if self.is_exact { &EXACT } else { &LOOSE };
        while self.compared < set.len() {
            let i = self.compared;
            self.compared += 1;
            let others = [i.saturating_sub(1), lowest];
            for k in others.into_iter().skip(usize::from(!self.is_exact)) {
                let found = fit_radii(set, k, i, tolerance);
                for (radius, found) in self.radius.iter_mut().zip(found) {
                    if found > 0.0 && (k == lowest || !(*radius > 0.0)) {
                        *radius = found;
                    }
                }
            }
        }
    }

    /// Compares with all entries anew: their indices have changed.
    pub fn restart(&mut self) {
        (self.compared, self.misses) = (0, 0);
    }

    /// Returns a fit that has compared nothing yet, with radii of an earlier one, metres.
    pub fn from_radius(radius: [f64; 2]) -> Self {
        Self {
            radius,
            ..Self::default()
        }
    }

    /// Returns a fit with the radii of a warm state, which count as confirmed, metres.
    pub fn warm(radius: [f64; 2]) -> Self {
        Self {
            is_confirmed: radius[0] + radius[1] > 0.0,
            ..Self::from_radius(radius)
        }
    }

    /// Returns a fit of samples that must fit one sphere but for rounding.
    pub fn exact() -> Self {
        Self {
            is_exact: true,
            ..Self::default()
        }
    }

    /// Returns the radii if a prediction has confirmed them, metres; else 0.
    pub fn confirmed_radius(&self) -> [f64; 2] {
        if self.is_confirmed {
            self.radius
        } else {
            [0.0; 2]
        }
    }

    /// Returns the corners with the spheres taken off.
    #[inline(always)]
    pub fn core<const N: usize>(&self, set: &VertexSet<N>, corners: &[Vertex; 3]) -> [Vec3; 3] {
        let [r1, r2] = self.radius;
        corners.map(|v| v.w - set.dir(v.pair.a.into()) * r1 - set.dir(v.pair.b.into()) * r2)
    }

    /// Returns the direction, unit, and the support value that the fit predicts to be the least near a
    /// face, of outward normal `normal`; `None` without a prediction.
    pub fn predict<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
    ) -> Option<(Vec3, f64)> {
        let rho = self.sum();
        if !(rho > 0.0) {
            return None;
        }
        let [a, b, c] = self.core(set, corners);
        let closest = barycentric::triangle(&Vec3::zeros(), &a, &b, &c);
        let foot = closest.point;
        let distance = foot.norm();
        if !(distance > MIN_CORE_DISTANCE_REL * rho) {
            return None;
        }
        let dir = foot / distance;
        if normal.dot(&foot) < 0.0 {
            Some((-dir, rho - distance))
        } else {
            let is_inside = closest.weights.iter().all(|weight| *weight > 0.0);
            is_inside.then_some((dir, rho + distance))
        }
    }

    /// Returns a direction beside the least one, `lowest`, towards the unit normal of a face; `None` where
    /// the face is as near.
    ///
    /// On a sphere of radius ρ, with the origin at e = ρ − upper from its center, a chord between the
    /// angles α and γ from the least direction is as far from the origin as the upper bound where
    /// (γ − α)² ρ <= (γ + α)² e: the next corner is at γ = r α, r = (1 + k) / (1 − k), k² = e / ρ.
    pub fn tilted_from_lowest<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        lowest: &Vec3,
        upper: f64,
        normal: &Vec3,
        gap: f64,
    ) -> Option<Vec3> {
        let rho = self.sum();
        let along = normal.dot(lowest);
        let across = normal - lowest * along;
        let sine = across.norm();
        let k = (1.0 - upper / rho).max(0.0).sqrt();
        // The sines of the corners' angles; the second is that of the inner edge.
        let sines = corners.each_ref().map(|v| {
            let cosine = |i: u16| set.dir(i.into()).dot(lowest);
            let c = lesser(cosine(v.pair.a), cosine(v.pair.b));
            if c > 0.0 {
                (1.0 - c * c).max(0.0).sqrt()
            } else {
                1.0
            }
        });
        let least = lesser(lesser(sines[0], sines[1]), sines[2]);
        let ratio = lesser((1.0 + k) / (1.0 - k), MAX_RING_RATIO);
        // The first ring is as wide as a face may be within the gap.
        let first = 2.0 * (gap / rho).sqrt();
        let tilt = (ratio * least).max(first);
        if !(sine > 1.5 * tilt) || along < 0.5 || k < MIN_RING_K && least > 0.5 * first {
            return None;
        }
        let dir = lowest + across * (tilt / sine);
        Some(dir / dir.norm())
    }

    /// Returns where to evaluate next about a face of these corners and this unit normal. `gap`: what the
    /// bounds may be apart, metres.
    #[inline(never)]
    fn choose<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
        upper: &UpperBound,
        gap: f64,
    ) -> QueryDirection {
        self.update(set, upper.index);
        let is_used = self.misses < MAX_FAILED_PREDICTIONS;
        let predicted = is_used.then(|| self.predict(set, corners, normal));
        if let Some((dir, value)) = predicted.flatten() {
            if (value - upper.depth).abs() <= MIN_GAIN * gap {
                // The least direction is what the fit predicts.
                self.is_confirmed = true;
            }
            if value < upper.depth - MIN_GAIN * gap {
                let choice = DirectionSource::Prediction;
                return QueryDirection { dir, choice, value };
            }
        }
        let tilted = if self.is_confirmed && self.sum() > 0.0 {
            self.tilted_from_lowest(set, corners, &upper.dir, upper.depth, normal, gap)
        } else {
            None
        };
        let (dir, choice) = match tilted {
            Some(dir) => (dir, DirectionSource::Tilted),
            None => (*normal, DirectionSource::Normal),
        };
        let value = upper.depth;
        QueryDirection { dir, choice, value }
    }
}

/// The exact fits of the local query, whose minimum a prediction may be: e = f and the moves parallel but for
/// rounding.
impl SphereFit {
    /// Returns whether the centers of the spheres of obj1's entry `a` and obj2's entry `b` were found along two
    /// directions each, as far apart as `tolerance`, metres, at most. The tip of a drop looks like the center of a
    /// sphere from one direction, and the rim of a thin disc nearly so from several.
    pub fn is_confirmed_twice<const N: usize>(
        &self,
        set: &VertexSet<N>,
        pair: VertexPair,
        tolerance: f64,
    ) -> bool {
        let [r1, r2] = self.radius;
        let most = lesser(EXACT_CENTER_REL * self.sum(), tolerance);
        let center1 = |i: usize| set.vertex1(i) - set.dir(i) * r1;
        let center2 = |i: usize| set.vertex2(i) + set.dir(i) * r2;
        let (a, b) = (usize::from(pair.a), usize::from(pair.b));
        let is_other =
            |i: usize, k: usize| k != i && (set.dir(k) - set.dir(i)).norm_squared() > 1e-8;
        let is_twice = |radius: f64, i: usize, center: &dyn Fn(usize) -> Vec3| {
            let at = center(i);
            !(radius > 0.0)
                || (0..set.len()).any(|k| is_other(i, k) && (center(k) - at).norm() <= most)
        };
        is_twice(r1, a, &center1) && is_twice(r2, b, &center2)
    }

    /// Returns whether the spheres that carry an answer were found twice: that of the upper bound's entry, and those of
    /// the corners that share in the witness points.
    pub fn are_spheres_confirmed<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        upper: &UpperBound,
        tolerance: f64,
    ) -> bool {
        let weights = self.weights(set, corners);
        self.is_confirmed_twice(set, VertexSet::<N>::pair_of_entry(upper.index), tolerance)
            && (weights.iter().zip(corners)).all(|(weight, v)| {
                !(*weight > 0.0) || self.is_confirmed_twice(set, v.pair, tolerance)
            })
    }

    /// Returns the shares of the corners' spheres in the point of their core that is closest to the origin.
    fn weights<const N: usize>(&self, set: &VertexSet<N>, corners: &[Vertex; 3]) -> [f64; 3] {
        let [a, b, c] = self.core(set, corners);
        barycentric::triangle(&Vec3::zeros(), &a, &b, &c).weights
    }

    /// Returns the witness points of unit `dir` on the spheres of the corners: where the line along it through the
    /// origin meets the triangle of the centers.
    pub fn witnesses<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        dir: &Vec3,
    ) -> [Vec3; 2] {
        let weights = self.weights(set, corners);
        let [r1, r2] = self.radius;
        let mut points = [dir * r1, -dir * r2];
        for (weight, v) in weights.iter().zip(corners) {
            let (a, b) = (usize::from(v.pair.a), usize::from(v.pair.b));
            points[0] += (set.vertex1(a) - set.dir(a) * r1) * *weight;
            points[1] += (set.vertex2(b) + set.dir(b) * r2) * *weight;
        }
        points
    }
}

/// Returns the radii of the spheres of obj1 and obj2 that two entries lie on, 0 where they do on none.
#[inline(always)]
fn fit_radii<const N: usize>(
    set: &VertexSet<N>,
    k: usize,
    i: usize,
    tolerance: &FitTolerance,
) -> [f64; 2] {
    let (m, n) = (set.dir(k), set.dir(i));
    // e + f and e − f are products of the move with these two.
    let (turn, sum) = (n - m, n + m);
    let turn2 = turn.norm_squared();
    let (from, to) = (set.coords(k), set.coords(i));
    let (mut along, mut length2) = ([0.0; 2], [0.0; 2]);
    for axis in 0..3 {
        for lane in 0..2 {
            let d = to[axis][lane] - from[axis][lane];
            along[lane] += turn[axis] * d;
            length2[lane] += d * d;
        }
    }
    [0, 1].map(|lane| {
        let is_parallel = along[lane] * along[lane] > tolerance.cos2 * turn2 * length2[lane];
        if !(is_parallel && along[lane] > 1e-9 * turn2 && turn2 > MIN_ANGLE2) {
            return 0.0;
        }
        let off = (0..3).fold(0.0, |off, axis| {
            off + sum[axis] * (to[axis][lane] - from[axis][lane])
        });
        if off.abs() <= tolerance.relative * along[lane] {
            along[lane] / turn2
        } else {
            0.0
        }
    })
}

/// Evaluates the support function for a face with these corners and this normal, which need not be unit:
/// where the fit predicts the least support value, else beside the least direction, else along the normal.
/// `along_normal`: along the normal. `gap` is what the bounds may be apart, metres.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(always)]
pub fn evaluate_beyond<A: SupportMap, B: SupportMap, const N: usize>(
    query: &mut SupportQuery<'_, A, B>,
    set: &mut VertexSet<N>,
    fit: &mut SphereFit,
    corners: &[Vertex; 3],
    normal: &Vec3,
    gap: f64,
    along_normal: bool,
) -> Result<(SupportSample, DirectionSource), Stop> {
    let unit_normal = normalise_unscaled(normal).unwrap_or(query.upper.dir);
    let has_samples = set.len() >= MIN_SAMPLES || fit.is_confirmed;
    if along_normal || !has_samples || corners.iter().any(|v| v.pair.is_interior()) {
        return Ok((query.evaluate(set, &unit_normal)?, DirectionSource::Normal));
    }
    let upper = query.upper;
    let aim = fit.choose(set, corners, &unit_normal, &upper, gap);
    let sample = query.evaluate(set, &aim.dir)?;
    match aim.choice {
        DirectionSource::Normal => {}
        DirectionSource::Prediction => {
            fit.is_confirmed =
                sample.h < aim.value + PREDICTION_REL_TOL * (upper.depth - aim.value);
            if !fit.is_confirmed {
                fit.misses += 1;
                fit.radius = [0.0; 2];
            }
        }
        // On a sphere the least direction was the least one.
        DirectionSource::Tilted => fit.is_confirmed = !(sample.h < upper.depth),
    }
    Ok((sample, aim.choice))
}
