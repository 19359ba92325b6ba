// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Witness points of the answer, and the support points asked for them.
//!
//! As the distance algorithm does it, on D less the point of the support plane below the origin:
//! they are where the hull of the samples is nearest to that point. The metric makes what a
//! witness may be off along the normal as long as what it may be off across. Where that is not
//! near enough, the samples' points count that R leads to: moved as R moves them when their
//! directions become that of the model's minimum. And where these are not certain, the next
//! support point is asked so that the point that R moves farthest becomes the objects' own.

use super::curvature::{BALL, Curvature, FORETOLD};
use super::model::{Model, Step};
use super::samples::{CUTS, Lanes, Samples};
use super::verdict::Next;
use crate::contact::Penetration;
use crate::contacts::pressure;
use crate::gjk::barycentric;
use crate::known::round::Symmetric;
use crate::math::{EPSILON, Real, Vec3, larger, unit};

/// What a witness point may be outside its object by where the tolerance is finer, as a share of the
/// objects' size: a quarter of what is promised.
pub const INSIDE: Real = if EPSILON > 1e-10 {
    16.0 * EPSILON
} else {
    2.5e-13
};

/// What bends by less than this share of what it bends by across is taken for an edge. Measured:
/// without it half as many again are outside (half balls, frusta).
const EDGE: Real = 0.05;

/// Witness points of the bundle's centre.
pub struct Witnesses {
    /// Of the samples' points.
    weights: [Real; CUTS],
    /// How far R moves these across b, in the chart.
    moved: [Lanes; 2],
    /// How much of that is obj1's part, about; …
    share: Real,
    /// … and how far each object's point moves, in the chart, where that is known.
    parts: Option<[[Real; 2]; 2]>,
    /// The way across b that is left to the point below the origin, in the chart.
    gap: [Real; 2],
    /// Little enough of the objects' own points is left, …
    pub own: bool,
    /// … or of points that R leads to and is certain enough of.
    pub believed: bool,
}

impl Witnesses {
    pub fn of(
        samples: &Samples,
        curvature: &Curvature,
        model: &Model,
        step: &Step,
        tolerance: Real,
    ) -> Self {
        let zero = Lanes::default();
        let mut own = Self::nearest(samples, model, [zero; 2], zero, tolerance);
        if own.own {
            return own;
        }
        own.share = curvature.share();
        if !curvature.known {
            return own;
        }
        let (x, y) = model.pull(step.x, step.y);
        let moved = [
            model.turned[0] + Lanes::all(x),
            model.turned[1] + Lanes::all(y),
        ];
        let mut led = Self::nearest(samples, model, moved, model.lift, tolerance);
        led.share = own.share;
        let parts = parts(samples, curvature, model, step);
        // Balls, where the samples showed them; of other round objects one piece, a little aside,
        // and each object's part of it: an edge bends along itself alone.
        let most = match parts {
            Some(_) => FORETOLD,
            None if curvature.round => BALL,
            None => 0.0,
        };
        let certain = |(i, w): (usize, &Real)| w * curvature.error_of(samples, i) <= most;
        if parts.is_some() {
            led.weights = core::array::from_fn(|i| Real::from(u8::from(i == samples.centre)));
            led.parts = parts;
        }
        let mut weights = led.weights.iter().enumerate().take(samples.len);
        let certain = weights.all(certain);
        led.believed = led.own && certain;
        led.own = false;
        led
    }

    /// Of samples moved and lifted by so much.
    fn nearest(
        samples: &Samples,
        model: &Model,
        moved: [Lanes; 2],
        lift: Lanes,
        tolerance: Real,
    ) -> Self {
        let across = allowed_across(samples, tolerance);
        let along = larger(tolerance, samples.rounding);
        let x = model.x - model.turned[0] + moved[0];
        let y = model.y - model.turned[1] + moved[1];
        let z = model.level - Lanes::all(samples.depth()) + lift;
        let stretch = across / along;
        let at = core::array::from_fn(|i| Vec3::new(x[i], y[i], z[i] * stretch));
        let (nearest, weights) = hull(&at, samples.len);
        let across2 = nearest.x * nearest.x + nearest.y * nearest.y;
        let near = across2 <= across * across && nearest.z >= -tolerance * stretch;
        Self {
            weights,
            moved,
            share: 0.5,
            parts: None,
            gap: [-nearest.x, -nearest.y],
            own: near,
            believed: near,
        }
    }

    /// The square of how far they are from meeting across b, m².
    pub fn apart2(&self) -> Real {
        let [x, y] = self.gap;
        x * x + y * y
    }

    /// The answer: the bundle's centre, with these witness points.
    pub fn answer(&self, samples: &Samples, model: &Model, iterations: u64) -> Penetration {
        let dir = model.b;
        let centre = samples.point(samples.centre);
        let seen: [_; CUTS] = core::array::from_fn(|i| samples.point(i));
        let (mut point1, mut point2) = barycentric::witnesses(&self.weights, seen);
        if samples.touch() && !self.own {
            // The proof of the overlap knows points that meet.
            (point1, point2) = (centre.v1, centre.v2);
        } else if !self.own {
            if let Some([one, two]) = &self.parts {
                point1 += model.e1 * one[0] + model.e2 * one[1];
                point2 += model.e1 * two[0] + model.e2 * two[1];
            } else {
                let [x, y] = self.moved.map(|moved| mean(&moved, &self.weights));
                let moved = model.e1 * (x + self.gap[0]) + model.e2 * (y + self.gap[1]);
                point1 += moved * self.share;
                point2 -= moved * (1.0 - self.share);
            }
            // Onto the support planes of both objects.
            point1 += dir * (centre.v1 - point1).dot(&dir);
            point2 += dir * (centre.v2 - point2).dot(&dir);
        }
        Penetration {
            depth: samples.depth(),
            depth_lower: 0.0,
            dir,
            normal: dir,
            point1,
            point2,
            pos: Vec3::zeros(),
            extent: pressure::extent(
                samples.known().iter().map(|p| [p.v1, p.v2]),
                [&point1, &point2],
            ),
            iterations,
        }
    }

    /// The witness query: where to ask so that the objects' own points take the place of those
    /// that R leads to.
    pub fn query(&self, samples: &Samples, model: &Model, tolerance: Real) -> Next {
        // Near the minimum, on the side of the sample that is off by most, and so near that it
        // is off by less than a witness may be. A point moves as the direction, what it lacks
        // in height as its square. Half of what is allowed, measured: ×2 +0.2 %, +3 %; ÷2 no
        // change.
        let across = allowed_across(samples, tolerance);
        let mut least = 1.0;
        let mut worst = None;
        for (i, w) in self.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            let [x, y] = self.moved.map(|moved| moved[i]);
            let share = (0.5 * across / (w * (x * x + y * y).sqrt()))
                .min((0.5 * tolerance / model.lift[i]).sqrt());
            if share < least {
                least = share;
                worst = Some(i);
            }
        }
        let [x, y] = self.gap;
        match (worst, unit(&(model.e1 * x + model.e2 * y))) {
            (Some(i), _) => Next::Beside(i, least),
            // A face shows one of its points: another one is found with the direction turned the
            // way that is left, by so little that it is still of that face.
            (None, Some(way)) => Next::Aside(way * (0.5 * tolerance / samples.size)),
            (None, None) => Next::Minimum,
        }
    }
}

/// How far each object's point moves across b to where one cut is least, in the chart. `None`: not
/// known well enough.
fn parts(
    samples: &Samples,
    curvature: &Curvature,
    model: &Model,
    step: &Step,
) -> Option<[[Real; 2]; 2]> {
    let here = step.count == 1 && step.set[0] == samples.centre && step.inside;
    let r1 = curvature
        .part()
        .filter(|_| here && curvature.known && curvature.even)?;
    let within = |r: &Symmetric| r.within(&model.e1, &model.e2);
    let (one, both) = (within(&r1), within(&curvature.r));
    let bends = |rho: Real, xx: Real, xy: Real| {
        let m = (xx * xx + xy * xy).sqrt();
        // All around, or not at all: a vertex.
        rho - m >= EDGE * (rho + m) || rho + m <= BALL * both.0
    };
    let bend = bends(one.0, one.1, one.2) && bends(both.0 - one.0, both.1 - one.1, both.2 - one.2);
    // The point below the origin moves, too, by so little that they still meet.
    let way = model.e1 * step.x + model.e2 * step.y;
    let moved = |r: &Symmetric| {
        let moved = r.times(&way);
        [moved.dot(&model.e1), moved.dot(&model.e2)]
    };
    let [one, both] = [moved(&r1), moved(&curvature.r)];
    bend.then(|| [one, [one[0] - both[0], one[1] - both[1]]])
}

/// The point of the hull of the first `len` that is nearest to the origin, and its weights.
pub fn hull(at: &[Vec3; CUTS], len: usize) -> (Vec3, [Real; CUTS]) {
    let origin = Vec3::zeros();
    let [a, b, c, d] = at;
    match len {
        0 | 1 => (*a, [1.0, 0.0, 0.0, 0.0]),
        2 => {
            let nearest = barycentric::segment(&origin, a, b);
            let [u, v] = nearest.weights;
            (nearest.point, [u, v, 0.0, 0.0])
        }
        3 => {
            let nearest = barycentric::triangle(&origin, a, b, c);
            let [u, v, w] = nearest.weights;
            (nearest.point, [u, v, w, 0.0])
        }
        _ => {
            let nearest = barycentric::tetrahedron(&origin, [a, b, c, d]);
            (nearest.point, nearest.weights)
        }
    }
}

fn mean(of: &Lanes, weights: &[Real; CUTS]) -> Real {
    (0..CUTS).map(|i| of[i] * weights[i]).sum()
}

/// How far across the normal the witness points may be apart: as far as keeps their
/// distance within the tolerance of the depth.
fn allowed_across(samples: &Samples, tolerance: Real) -> Real {
    larger((2.0 * samples.depth() * tolerance).sqrt(), samples.rounding)
}

#[cfg(test)]
mod tests {
    use super::super::samples::tests::{around, samples};
    use super::*;
    use crate::known::support::Known;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Rotation, Shape, capsule, corners, hull, placed};

    const TOLERANCE: Real = if EPSILON > 1e-10 { 1e-4 } else { 1e-6 };

    /// The witnesses that samples along these directions show, with this curvature, of which their
    /// own pairs told `own` relative error.
    fn told(
        known: &mut Known,
        shape: &Shape,
        dirs: &[Vec3],
        curvature: &Curvature,
        own: Real,
    ) -> (Witnesses, Penetration, Next) {
        let mut samples = samples(known, shape, dirs);
        samples.error = Lanes::all(own);
        let model = Model::new(&samples, curvature);
        let step = model.minimise(dirs.len() - 1, 0.1, samples.rounding);
        let witnesses = Witnesses::of(&samples, curvature, &model, &step, TOLERANCE);
        let answer = witnesses.answer(&samples, &model, 1);
        let next = witnesses.query(&samples, &model, TOLERANCE);
        (witnesses, answer, next)
    }

    /// The same of samples no pair of which has told.
    fn found(
        known: &mut Known,
        shape: &Shape,
        dirs: &[Vec3],
        curvature: &Curvature,
    ) -> (Witnesses, Penetration, Next) {
        told(known, shape, dirs, curvature, 1.0)
    }

    /// A box whose face z = 0.6 is the nearest, the origin below it aside of the middle.
    fn resting() -> Shape {
        let centre = Vec3::new(0.05, 0.03, 0.1);
        let half = corners(Vec3::repeat(0.5));
        hull(&placed(&half, &Rotation::identity(), centre))
    }

    #[test]
    fn what_is_left_is_the_way_from_where_the_weights_lead() {
        let mut r = Random::new(10);
        let mut near = 0;
        for round in 0..400 {
            let shape = hull(&corners(Vec3::new(0.5, 0.4, 0.3)));
            let dirs = around(&mut r, 1 + round % CUTS, 1.5);
            let mut known = Known::default();
            let samples = samples(&mut known, &shape, &dirs);
            let model = Model::new(&samples, &Curvature::new());
            let zero = Lanes::default();
            // As coarse a tolerance as an object.
            let witnesses = Witnesses::nearest(&samples, &model, [zero; 2], zero, 0.1);
            let of = |i: usize| samples.v.get(i) * witnesses.weights[i];
            let on: Vec3 = (0..CUTS).map(of).sum();
            let [x, y] = witnesses.gap;
            assert!((on.dot(&model.e1) + x).abs() + (on.dot(&model.e2) + y).abs() < 1e3 * EPSILON);
            assert!((witnesses.weights.iter().sum::<Real>() - 1.0).abs() < 8.0 * EPSILON);
            let low = samples.depth() - on.dot(&model.b);
            let allowed2 = 0.2 * samples.depth();
            assert_eq!(witnesses.own, witnesses.apart2() <= allowed2 && low <= 0.1);
            near += usize::from(witnesses.own);
        }
        assert!(near > 100 && near < 300, "{near}");
    }

    #[test]
    fn points_of_a_face_around_the_foot_are_the_objects_own() {
        let aside = [(1e-9, 1e-9), (-0.01, 0.01), (0.005, -0.01), (-0.005, -0.01)];
        let dirs = aside.map(|(x, y)| Vec3::new(x, y, 1.0).normalize());
        let mut known = Known::default();
        let (witnesses, answer, _) = found(&mut known, &resting(), &dirs, &Curvature::new());
        assert!(witnesses.own && witnesses.believed);
        let off = (2.0 * 0.6 * TOLERANCE).sqrt();
        assert!((answer.point1 - Vec3::z() * 0.6).norm() <= off);
        assert!(answer.point2 == Vec3::zeros());
    }

    #[test]
    fn of_a_face_that_shows_one_corner_another_is_asked() {
        let dirs = [Vec3::z()];
        let mut known = Known::default();
        let (witnesses, _, next) = found(&mut known, &resting(), &dirs, &Curvature::new());
        assert!(!witnesses.own && !witnesses.believed);
        let Next::Aside(by) = next else {
            panic!("not aside")
        };
        let corner = known.points()[0].v;
        let other = resting()(&(Vec3::z() + by).normalize());
        assert!(other != corner && (other.z - corner.z).abs() < 8.0 * EPSILON);
        // On the other side of the foot.
        assert!(other.xy().dot(&corner.xy()) < 0.0);
    }

    #[test]
    fn a_ball_is_believed_where_r_leads_to() {
        let (p, q) = (Vec3::new(0.1, 0.0, -0.4), Vec3::new(-0.15, 0.0, -0.4));
        let shape = capsule(p, q, 0.5);
        let mut curvature = Curvature::new();
        curvature.recall(Symmetric([0.5, 0.0, 0.0, 0.5, 0.0, 0.5]), None);
        let mut known = Known::default();
        // One end each, where the least depth of 0.1 is between.
        let dirs = [(0.0, 0.0), (-0.05, 0.02)].map(|(x, y)| Vec3::new(x, y, 1.0).normalize());
        let (guess, ..) = found(&mut known, &shape, &dirs, &curvature);
        assert!(!guess.own && !guess.believed);
        // As a pair tells that is wider apart.
        (curvature.error, curvature.span2) = (BALL, 0.01);
        // Of another piece.
        let mut known = Known::default();
        let (other, ..) = found(&mut known, &shape, &dirs, &curvature);
        assert!(!other.own && !other.believed);
        let mut known = Known::default();
        let (witnesses, answer, next) = told(&mut known, &shape, &dirs, &curvature, BALL);
        assert!(!witnesses.own && witnesses.believed);
        let off = (2.0 * 0.1 * TOLERANCE).sqrt();
        assert!((answer.point1 - answer.point2 - Vec3::z() * 0.1).norm() <= off);
        // The one that R moved is the one to ask.
        assert!(matches!(next, Next::Beside(1, share) if share > 0.0 && share < 1.0));
    }
}
