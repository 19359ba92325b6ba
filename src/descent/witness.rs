// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Witness points of the answer, and the support points asked for them.

use super::curvature::{BALL, BELIEVED, Curvature, FORETOLD};
use super::model::{Model, Step};
use super::samples::{CUTS, Lanes, OTHERS, Samples};
use super::verdict::Next;
use crate::contact::Penetration;
use crate::contact_patch;
use crate::math::{EPSILON, Real, Vec3, larger, unit};

/// Witness points of the bundle's centre.
pub struct Witnesses {
    point1: Vec3,
    point2: Vec3,
    /// How far across the normal they are from meeting, metres.
    pub across: Real,
    /// They are means of the objects' own points.
    pub own: bool,
}

impl Witnesses {
    pub fn of(
        samples: &Samples,
        curvature: &Curvature,
        model: &Model,
        step: &Step,
        tolerance: Real,
    ) -> Self {
        let depth = samples.depth();
        // Points of the objects themselves: a mean of support points that lie below the
        // origin, or as near to that as a depth within the tolerance allows, and no deeper
        // than the tolerance. First of the active cuts; but a direction that ties several
        // vertices shows one of them, which may leave the model fewer cuts than the search
        // has seen.
        let (x, y) = (samples.v.dot(&model.e1), samples.v.dot(&model.e2));
        let height = samples.v.dot(&model.b);
        let near = allowed_across(samples, tolerance).powi(2);
        let inside = |set: [usize; 3], w: [Real; 3]| {
            let mean = |l: &Lanes| l[set[0]] * w[0] + l[set[1]] * w[1] + l[set[2]] * w[2];
            let (x, y) = (mean(&x), mean(&y));
            let across2 = x * x + y * y;
            (across2 <= near && mean(&height) >= depth - tolerance).then_some((
                set,
                w,
                across2.sqrt(),
            ))
        };
        let active = inside(step.set, step.weights(&x, &y));
        let found = active.or_else(|| enclosing(&x, &y).find_map(|(set, w)| inside(set, w)));
        let Some((set, w, across)) = found else {
            return Self::foretold(samples, curvature, model, step);
        };
        let first = samples.point(set[0]);
        let (mut point1, mut point2) = (first.v1, first.v2);
        for (i, w) in set.into_iter().zip(w).skip(1) {
            point1 += (samples.point(i).v1 - first.v1) * w;
            point2 += (samples.point(i).v2 - first.v2) * w;
        }
        Self {
            point1,
            point2,
            across,
            own: true,
        }
    }

    /// The witness points that the model foretells: the support points of the active cuts,
    /// moved to where R takes them when their directions become b.
    fn foretold(samples: &Samples, curvature: &Curvature, model: &Model, step: &Step) -> Self {
        let centre = samples.point(samples.centre);
        let b = &model.b;
        let share = curvature.share;
        let (mut point1, mut point2) = (Vec3::zeros(), Vec3::zeros());
        let weights = step.weights(&model.x, &model.y);
        for (i, w) in step.active().zip(weights) {
            let p = samples.point(i);
            point1 += p.v1 * w;
            point2 += p.v2 * w;
            if model.lift[i] > 0.0 {
                let (x, y) = (
                    model.x[i] - p.v.dot(&model.e1),
                    model.y[i] - p.v.dot(&model.e2),
                );
                let moved = (model.e1 * x + model.e2 * y) * w;
                point1 += moved * share;
                point2 -= moved * (1.0 - share);
            }
        }
        // What is left across the normal is the distance to the model's minimum.
        let apart = point1 - point2;
        let apart = apart - b * apart.dot(b);
        let across = apart.norm();
        if samples.touch() {
            // Where these do not meet, the proof of the overlap knows points that do.
            (point1, point2) = (centre.v1, centre.v2);
        } else {
            point1 -= apart * share;
            point2 += apart * (1.0 - share);
            // Onto the support planes of both objects.
            point1 += b * (centre.v1 - point1).dot(b);
            point2 += b * (centre.v2 - point2).dot(b);
        }
        Self {
            point1,
            point2,
            across,
            own: false,
        }
    }

    /// Can they be believed? All of the objects' own points and of a ball's; of other smooth
    /// pairs those that are near to the one active cut's own. Three cuts must meet by
    /// themselves.
    pub fn believed(
        &self,
        samples: &Samples,
        curvature: &Curvature,
        step: &Step,
        tolerance: Real,
    ) -> bool {
        if self.own {
            return true;
        }
        let exact = |&i: &usize| curvature.error_of(samples, i) <= BALL;
        let ball = step.set.iter().all(exact);
        let meet = step.count < 3 || self.across <= allowed_across(samples, tolerance);
        let smooth = step.count == 1
            && curvature.spread
            && curvature.error <= FORETOLD
            && curvature.uneven <= BELIEVED;
        curvature.known && (ball || smooth) && meet
    }

    /// The answer: the bundle's centre, with these witness points.
    pub fn answer(&self, samples: &Samples, tolerance: Real, iterations: u64) -> Penetration {
        let dir = samples.dir();
        let seen = core::array::from_fn::<_, CUTS, _>(|i| *samples.point(i));
        Penetration {
            depth: samples.depth(),
            depth_lower: 0.0,
            dir,
            normal: dir,
            point1: self.point1,
            point2: self.point2,
            width: contact_patch::width(
                &seen,
                samples.point(samples.centre),
                &dir,
                tolerance,
                samples.size,
            ),
            iterations,
        }
    }
}

/// How far across the normal the witness points may be apart: as far as keeps their
/// distance within the tolerance of the depth.
fn allowed_across(samples: &Samples, tolerance: Real) -> Real {
    (2.0 * samples.depth() * tolerance)
        .sqrt()
        .max(samples.rounding)
}

/// Each three samples whose triangle the ray along b meets, and the weights of where it
/// does; x, y: the samples across b.
fn enclosing(x: &Lanes, y: &Lanes) -> impl Iterator<Item = ([usize; 3], [Real; 3])> {
    let area = |i: usize, j: usize| x[i] * y[j] - y[i] * x[j];
    OTHERS.into_iter().filter_map(move |[i, j, k, _]| {
        let w = [area(j, k), area(k, i), area(i, j)];
        let sum = w[0] + w[1] + w[2];
        let w = w.map(|w| w / sum);
        // False for NaN: three points on a line.
        w.iter().all(|&w| w >= 0.0).then_some(([i, j, k], w))
    })
}

/// The witness query: where to ask so that the objects' own points take the place of foretold
/// ones.
pub fn query(samples: &Samples, model: &Model, step: &Step, tolerance: Real) -> Next {
    if step.length2() <= EPSILON {
        // The minimum itself was asked, and showed one point of a face: another one is
        // found with the direction turned towards it, by so little that it is still of
        // that face.
        if let Some(t) = unit(&towards_foot(samples, model, tolerance)) {
            return Next::Aside(t * (0.5 * tolerance / samples.size));
        }
    }
    // At the minimum, unless its own point is near enough to where R takes it: then near
    // there, on the side of the active cut that is farthest off, and so near that it is
    // off by less than a witness may be. A point moves as the direction, what it lacks
    // in height as its square. Half of what is allowed, measured: ×2 +0.2 %, +3 %; ÷2 no change.
    let across = allowed_across(samples, tolerance);
    let weights = step.weights(&model.x, &model.y);
    let mut next = Next::Minimum;
    let mut least = 1.0;
    for (i, w) in step.active().zip(weights) {
        let (x, y) = model.moved(i, &samples.v.get(i), step.x, step.y);
        let share = (0.5 * across / (larger(w, 0.0) * (x * x + y * y).sqrt()))
            .min((0.5 * tolerance / model.lift[i]).sqrt());
        if i == samples.centre && share < 1.0 {
            return Next::Minimum;
        }
        if share < least {
            least = share;
            next = Next::Beside(i, share);
        }
    }
    next
}

/// The way across the normal from what is known of the touched face of D to the point
/// below the origin.
fn towards_foot(samples: &Samples, model: &Model, tolerance: Real) -> Vec3 {
    let least = samples.depth() - tolerance;
    let across = |i: usize| {
        let v = samples.v.get(i);
        let height = v.dot(&model.b);
        (height >= least).then(|| model.b * height - v)
    };
    let mut nearest = model.b * samples.depth() - samples.v.get(samples.centre);
    for p in (0..samples.len).filter_map(across) {
        for q in (0..samples.len).filter_map(across) {
            let side = q - p;
            let t = -p.dot(&side) / side.norm_squared();
            // NaN, of a side without length, is its end.
            let on = p + side * t.clamp(0.0, 1.0).max(0.0);
            if on.norm_squared() < nearest.norm_squared() {
                nearest = on;
            }
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::super::samples::tests::{around, samples};
    use super::*;
    use crate::shapes::{Random, Rotation, corners, hull, placed};
    use crate::support::Known;

    #[test]
    fn a_triangle_that_the_ray_meets_has_weights_that_say_where() {
        let cube = hull(&corners(Vec3::new(0.5, 0.4, 0.3)));
        let mut r = Random::new(10);
        let mut met = 0;
        for _ in 0..200 {
            let mut known = Known::default();
            let samples = samples(&mut known, &cube, &around(&mut r, CUTS, 1.5));
            let model = Model::new(&samples, &Curvature::new());
            let (x, y) = (samples.v.dot(&model.e1), samples.v.dot(&model.e2));
            for (set, w) in enclosing(&x, &y) {
                met += 1;
                let on = |l: &Lanes| l[set[0]] * w[0] + l[set[1]] * w[1] + l[set[2]] * w[2];
                assert!(on(&x).abs() + on(&y).abs() < 1e3 * EPSILON);
                assert!((w.iter().sum::<Real>() - 1.0).abs() < 8.0 * EPSILON);
            }
        }
        assert!(met > 20);
    }

    #[test]
    fn points_of_a_face_around_the_foot_are_the_objects_own() {
        let centre = Vec3::new(0.05, 0.03, 0.1);
        let cube = hull(&placed(
            &corners(Vec3::repeat(0.5)),
            &Rotation::identity(),
            centre,
        ));
        let aside = [(1e-9, 1e-9), (-0.01, 0.01), (0.005, -0.01), (-0.005, -0.01)];
        let dirs = aside.map(|(x, y)| Vec3::new(x, y, 1.0).normalize());
        let mut known = Known::default();
        let samples = samples(&mut known, &cube, &dirs);
        let curvature = Curvature::new();
        let model = Model::new(&samples, &curvature);
        let step = model.minimise(3, 0.1, samples.rounding);
        let witnesses = Witnesses::of(&samples, &curvature, &model, &step, 1e-6);
        assert!(witnesses.own && witnesses.believed(&samples, &curvature, &step, 1e-6));
        let answer = witnesses.answer(&samples, 1e-6, 4);
        assert!((answer.point1 - Vec3::z() * 0.6).norm() < 1e-3);
        assert!(answer.point2 == Vec3::zeros());
    }
}
