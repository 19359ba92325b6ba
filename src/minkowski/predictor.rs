// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The predictor: proposes the next direction to evaluate from models of D near the upper bound, and judges the last
//! proposal by its support value. It proves nothing.
//!
//! No reference is known to us. The *allowed gap* is the largest difference of the bounds at which a query stops.
//!
//! 1. *Sphere*: the least support value of the sphere fits ([`SphereFit`]).
//! 2. *Arc*, of a search for bounds: the direction of the upper bound is inclined towards a face until the chord of its support
//!    point and the new one is as close to the origin as the allowed gap permits: with the radius of a confirmed sphere fit,
//!    else with that of an *arc*, two samples between which e and f nearly agree, and which need be on no sphere.
//! 3. *Smooth D*, of a search for a minimum: Newton's step ([`newton_step`]).
//! 4. *Face*: the normal, without a prediction, and after one that found no point above the face.
//! 5. *Judgement*: a support value that is lower than predicted, or not much higher, confirms the model. Any other is a
//!    failure: it resets the radii of fits that are not exact, and after [`MAX_FAILURES`] no model is used any more.
//!
//! Outputs. A direction to evaluate; the support value decides.

use crate::math::{Vec3, larger, lesser, normalise_unscaled};
use crate::minkowski::newton::newton_step;
use crate::minkowski::sphere_fit::{MIN_ANGLE2, SphereFit};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportPlane, SupportQuery, SupportSample};
use crate::minkowski::tuning::{MAX_FAILURES, MAX_MISS_REL, MIN_GAIN_GAPS, SMOOTH_REL_TOL};
use crate::minkowski::vertex_set::{Vertex, VertexPair, VertexSet};

/// The largest ratio of the radii of two successive circles of corners. Measured: without it, proofs to 1e-10 m of shallow
/// round pairs take 14 % more support points, warm hits 1.5 % more instructions.
const MAX_CIRCLE_RATIO: f64 = 100.0;

/// The model from which a direction is proposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// None: the normal of the face.
    Face,
    /// The sphere fits.
    Sphere,
    /// An arc through the upper bound.
    Arc,
    /// A smooth D.
    Smooth,
}

/// A direction to evaluate.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// The model.
    pub model: Model,
    /// Unit.
    pub dir: Vec3,
    /// The predicted support value, metres; of a face the upper bound.
    pub value: f64,
}

/// The models of a pair, and how well they predicted so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Predictor {
    /// The sphere fits.
    pub fit: SphereFit,
    /// True if the last prediction of the sphere fits was confirmed.
    is_confirmed: bool,
    /// The number of failed predictions.
    failures: u32,
    /// The normal of the face above which the last prediction found no point.
    failed_normal: Vec3,
    /// The direction in which D is flattest, from the last Newton step, unit, perpendicular to that of the upper bound.
    pub flattest: Vec3,
    /// Newton's step from the first `newton_len` entries.
    newton: Option<Prediction>,
    newton_len: usize,
}

impl Predictor {
    /// Returns a predictor with the radii of a state, which count as confirmed, metres; 0 without a state.
    pub fn warm(radius: [f64; 2]) -> Self {
        Self {
            fit: SphereFit::from_radius(radius),
            is_confirmed: radius[0] + radius[1] > 0.0,
            ..Self::default()
        }
    }

    /// Returns a predictor whose sphere fits are exact.
    pub fn exact() -> Self {
        Self {
            fit: SphereFit::exact(),
            ..Self::default()
        }
    }

    /// Returns the radii of the sphere fits if a prediction has confirmed them, metres; else 0.
    pub fn confirmed_radius(&self) -> [f64; 2] {
        if self.is_confirmed {
            self.fit.radius
        } else {
            [0.0; 2]
        }
    }

    /// Notes that the last prediction found no point above the face with this normal: [`Model::Face`] is next there.
    #[inline(always)]
    pub fn fail_above(&mut self, normal: &Vec3) {
        self.failed_normal = *normal;
    }

    /// Returns whether the last prediction found no point above the face with this normal.
    #[inline(always)]
    pub fn has_failed_above(&self, normal: &Vec3) -> bool {
        self.failed_normal == *normal
    }

    /// Returns the minimum that the sphere fits predict near a face with this unit normal, else that of Newton's step: the
    /// first of them that `accepts`.
    pub fn minimum<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
        upper: &SupportPlane,
        accepts: impl Fn(&Prediction) -> bool,
    ) -> Option<Prediction> {
        if self.has_failed_above(normal) {
            return None;
        }
        let sphere = self.sphere(set, corners, normal, upper).filter(&accepts);
        sphere.or_else(|| self.smooth(set, upper).filter(accepts))
    }

    /// Returns the minimum that the sphere fits predict near a face with this unit normal.
    pub fn sphere<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: &Vec3,
        upper: &SupportPlane,
    ) -> Option<Prediction> {
        self.fit.update(set, upper);
        let has_interior = corners.iter().any(|v| v.pair.is_interior());
        if has_interior || self.failures >= MAX_FAILURES {
            return None;
        }
        let (dir, value) = self.fit.predict(set, corners, normal)?;
        let model = Model::Sphere;
        Some(Prediction { model, dir, value })
    }

    /// Returns the minimum that Newton's step predicts.
    fn smooth<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        upper: &SupportPlane,
    ) -> Option<Prediction> {
        if self.newton_len != set.len() {
            self.newton_len = set.len();
            self.newton = newton_step(set, upper).map(|step| {
                self.flattest = step.flattest;
                let (model, dir, value) = (Model::Smooth, step.dir, step.value);
                Prediction { model, dir, value }
            });
        }
        self.newton.filter(|_| self.failures < MAX_FAILURES)
    }

    /// Returns the direction of the upper bound, inclined towards the unit normal of a face, and the least support value that
    /// is predicted there, metres. `None` if the surface of D is no arc there, if the angle to the normal is less than the
    /// slope, or not acute. The interior point may be a corner.
    ///
    /// On a sphere of radius ρ, with the origin at the distance e = ρ − upper from its center, a chord between the
    /// angles α and γ from the direction of the upper bound is at least as far from the origin as the upper bound if
    /// (γ − α)² ρ <= (γ + α)² e: the next corner is at γ = r α, r = (1 + k) / (1 − k), k² = e / ρ. Corners at equal
    /// angles lie on a circle; the first circle is as wide as the gap allows. Without a confirmed fit ρ is that of an arc
    /// ([`arc_radius`]), the lowest point of which may be farther from the upper bound than the circle: then that is next.
    fn inclined_from_lowest<const N: usize>(
        &self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        upper: &SupportPlane,
        normal: &Vec3,
        gap: f64,
    ) -> Option<Prediction> {
        let is_sphere = self.is_confirmed && self.fit.sum() > 0.0;
        let lowest = &upper.dir;
        let along = normal.dot(lowest);
        if !(along > 0.0) {
            return None;
        }
        let perpendicular = normal - lowest * along;
        // The cosine of the corner closest to `lowest`, and the corner that reaches farthest towards the normal.
        let (mut near, mut far, mut far_corner) = (0.0, 0.0, VertexPair::INTERIOR);
        for v in corners.iter().filter(|v| !v.pair.is_interior()) {
            let products = |i: u16| {
                let dir = set.dir(i.into());
                (dir.dot(lowest), dir.dot(&perpendicular))
            };
            let (mut cosine, mut reach) = products(v.pair.a);
            if v.pair.b != v.pair.a {
                let other = products(v.pair.b);
                (cosine, reach) = (lesser(other.0, cosine), lesser(other.1, reach));
            }
            near = larger(near, cosine);
            if reach > far {
                (far, far_corner) = (reach, v.pair);
            }
        }
        let rho = if is_sphere {
            self.fit.sum()
        } else {
            arc_radius(set, far_corner, upper)?
        };
        if !(rho > upper.depth) {
            return None;
        }
        let least = (1.0 - near * near).max(0.0).sqrt();
        let sine = perpendicular.norm();
        let way = perpendicular / sine;
        let k = (1.0 - upper.depth / rho).sqrt();
        let ratio = lesser((1.0 + k) / (1.0 - k), MAX_CIRCLE_RATIO);
        // Faces as wide as the first circle are within the gap.
        let first = 2.0 * (gap / rho).sqrt();
        let (mut slope, mut value) = (larger(ratio * least, first), upper.depth);
        let shift = -upper.point.v.dot(&way) / (rho - upper.depth);
        if !is_sphere && shift > slope {
            (slope, value) = (shift, value - 0.5 * (rho - upper.depth) * shift * shift);
        }
        if !(sine > slope * along) {
            return None;
        }
        let dir = lowest + way * slope;
        let (model, dir) = (Model::Arc, dir / dir.norm());
        Some(Prediction { model, dir, value })
    }

    /// Returns the next direction to evaluate for a face with these corners and this unit normal. `gap`: the allowed
    /// difference of the bounds, metres.
    #[inline(never)]
    fn choose<const N: usize>(
        &mut self,
        set: &VertexSet<N>,
        corners: &[Vertex; 3],
        normal: Vec3,
        upper: &SupportPlane,
        gap: f64,
    ) -> Prediction {
        let sphere = self.sphere(set, corners, &normal, upper);
        if let Some(prediction) = sphere {
            if (prediction.value - upper.depth).abs() <= MIN_GAIN_GAPS * gap {
                // The upper bound is what the fit predicts.
                self.is_confirmed = true;
            }
            if prediction.value < upper.depth - MIN_GAIN_GAPS * gap {
                return prediction;
            }
        }
        let is_used = self.failures < MAX_FAILURES;
        let inclined =
            is_used.then(|| self.inclined_from_lowest(set, corners, upper, &normal, gap));
        inclined.flatten().unwrap_or(Prediction {
            model: Model::Face,
            dir: normal,
            value: upper.depth,
        })
    }

    /// Judges a proposal by the support value `h`. `upper`: the upper bound before it; `gap`: the allowed difference of the
    /// bounds; metres. Returns whether they agree.
    pub fn judge(&mut self, proposal: &Prediction, h: f64, upper: f64, gap: f64) -> bool {
        let gain = upper - proposal.value;
        let agrees = match proposal.model {
            Model::Face => return true,
            Model::Sphere | Model::Smooth => h < proposal.value + MAX_MISS_REL * larger(gain, gap),
            Model::Arc => !(upper - h > (1.0 + MAX_MISS_REL) * gain),
        };
        self.failures += u32::from(!agrees);
        match proposal.model {
            Model::Sphere => {
                self.is_confirmed = agrees;
                if !agrees {
                    self.fit.fail();
                }
            }
            // If D is this sphere, no direction near the one of the upper bound has a lower support value.
            Model::Arc => self.is_confirmed = !(h < upper),
            _ => {}
        }
        agrees
    }

    /// Evaluates the support function for a face with this normal, which need not be unit: along the direction that is
    /// proposed, or along the normal. `along_normal`: true if it must be the normal; `corners`, which returns the corners of
    /// the face, is then not called. `gap`: the allowed difference of the bounds, metres. Returns the model, too.
    ///
    /// # Errors
    /// As [`SupportQuery::evaluate`].
    #[inline(always)]
    pub fn evaluate_beyond<D: Difference, const N: usize>(
        &mut self,
        query: &mut SupportQuery<'_, D>,
        set: &mut VertexSet<N>,
        corners: impl FnOnce(&VertexSet<N>) -> [Vertex; 3],
        normal: &Vec3,
        gap: f64,
        along_normal: bool,
    ) -> Result<(SupportSample, Model), Stop> {
        let upper = query.upper.depth;
        let mut next = Prediction {
            model: Model::Face,
            dir: normalise_unscaled(normal).unwrap_or(query.upper.dir),
            value: upper,
        };
        let along_normal = along_normal || self.has_failed_above(normal);
        // Once more is known than three corners. (Measured: with fits at once shallow boxes take 9 % more instructions, with
        // fits from three points on 7 %.)
        if !along_normal && (set.len() > 3 || self.is_confirmed) {
            let corners = corners(set);
            let chosen = self.choose(set, &corners, next.dir, &query.upper, gap);
            // Number by number: codegen, see README.
            next.dir = Vec3::new(chosen.dir.x, chosen.dir.y, chosen.dir.z);
            (next.model, next.value) = (chosen.model, chosen.value);
        }
        let sample = query.evaluate(set, &next.dir)?;
        self.judge(&next, sample.h, upper, gap);
        Ok((sample, next.model))
    }
}

/// Returns the sum of the radii of two arcs, metres: that of obj1 and that of obj2, from the vertex of the upper bound to that
/// of a corner. `None` if there is no turn, or if e and f of an object differ by more than [`SMOOTH_REL_TOL`] of their sum. A
/// vertex that stays where it is is an arc of radius 0.
fn arc_radius<const N: usize>(
    set: &VertexSet<N>,
    pair: VertexPair,
    upper: &SupportPlane,
) -> Option<f64> {
    if pair.is_interior() {
        return None;
    }
    let lowest = [upper.point.v1, -upper.point.v2];
    let mut radius = 0.0;
    for (object, i) in [pair.a, pair.b].into_iter().enumerate() {
        let coords = set.coords(i.into());
        let change = Vec3::from(coords.map(|c| c[object])) - lowest[object];
        let turn = set.dir(i.into()) - upper.dir;
        // e + f and f.
        let (sum, f) = (turn.dot(&change), -upper.dir.dot(&change));
        let turn2 = turn.norm_squared();
        if !((sum - 2.0 * f).abs() <= SMOOTH_REL_TOL * sum && turn2 > MIN_ANGLE2) {
            return None;
        }
        radius += sum / turn2;
    }
    Some(radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::sphere_fit::tests::{ROUNDING, balls, corners_around_x};
    use crate::test_shapes::{Rotation, ball, difference, ellipsoid, hull};

    #[test]
    fn a_prediction_is_evaluated_and_confirmed() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        query.evaluate(&mut set, &Vec3::z()).unwrap();
        let mut predictor = Predictor::default();
        let normal = Vec3::new(1.0, 0.1, 0.1);
        let mut beyond = |predictor: &mut Predictor, along_normal| {
            let (query, set, corners) = (&mut query, &mut set, |_: &VertexSet<24>| corners);
            (predictor.evaluate_beyond(query, set, corners, &normal, 1e-6, along_normal)).unwrap()
        };
        let (sample, model) = beyond(&mut predictor, true);
        assert!(model == Model::Face && sample.h > 0.151 && predictor.fit.radius == [0.0; 2]);
        let (sample, model) = beyond(&mut predictor, false);
        assert!(model == Model::Sphere && (sample.h - 0.15).abs() < ROUNDING);
        assert!(predictor.confirmed_radius() == predictor.fit.radius);
        // The upper bound is what the fit predicts: a direction beside it is next.
        let (sample, model) = beyond(&mut predictor, false);
        assert!(model != Model::Sphere && sample.h > 0.15 - ROUNDING);
        // After a failure the normal of that face is next.
        predictor.fail_above(&normal);
        assert_eq!(beyond(&mut predictor, false).1, Model::Face);
    }

    #[test]
    fn wrong_predictions_reset_the_radii_and_end_the_fit() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        query.evaluate(&mut set, &Vec3::z()).unwrap();
        let mut predictor = Predictor::default();
        predictor.fit.refute();
        let mut evaluate = |predictor: &mut Predictor| {
            // The core points of these radii predict a lower support value than the balls have.
            predictor.fit.radius = [0.2, 0.2];
            let (query, set, corners) = (&mut query, &mut set, |_: &VertexSet<24>| corners);
            (predictor.evaluate_beyond(query, set, corners, &Vec3::x(), 1e-6, false)).unwrap()
        };
        for i in 0..MAX_FAILURES {
            let (_, model) = evaluate(&mut predictor);
            assert_eq!((model, predictor.failures), (Model::Sphere, i + 1));
            assert!(predictor.fit.radius == [0.0; 2] && predictor.confirmed_radius() == [0.0; 2]);
        }
        assert_eq!(evaluate(&mut predictor).1, Model::Face);
    }

    /// An ellipsoid fits no sphere. Between x, along which its support value is least, and a direction 0.1 rad towards y it is
    /// an arc of the radius 0.35² / 0.25.
    #[test]
    fn a_direction_is_inclined_along_an_arc_of_no_sphere() {
        let body = ellipsoid(
            Vec3::new(0.25, 0.35, 0.5),
            Rotation::identity(),
            Vec3::zeros(),
        );
        let md = difference(body, ball(Vec3::zeros(), 0.0));
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::<24>::EMPTY);
        let corners = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[y, z]| {
            let n = Vec3::new(1.0, y, z).normalize();
            query.evaluate(&mut set, &n).unwrap().vertex()
        });
        let radius = arc_radius(&set, corners[1].pair, &query.upper).unwrap();
        assert!((radius - 0.49).abs() < 0.01, "{radius}");
        let (gap, normal) = (1e-4, Vec3::new(1.0, 0.05, 0.0).normalize());
        let inclined = |upper: &SupportPlane| {
            Predictor::default().inclined_from_lowest(&set, &corners, upper, &normal, gap)
        };
        let Prediction { dir: n, value, .. } = inclined(&query.upper).unwrap();
        let first = 2.0 * (gap / radius).sqrt();
        assert!(
            (n.y / n.x - first).abs() < 1e-6 && n.z.abs() < ROUNDING && value == 0.25,
            "{n}"
        );
        // If the lowest point of the arc is farther from the upper bound, that is next.
        let mut upper = query.upper;
        upper.point.v.y -= 0.01;
        let Prediction { dir: n, value, .. } = inclined(&upper).unwrap();
        let shift = 0.01 / (radius - 0.25);
        assert!(
            (n.y / n.x - shift).abs() < 1e-6 && value < 0.25,
            "{n} {value}"
        );
        // A corner of a box is no arc.
        let md = difference(
            hull(&crate::test_shapes::corners(Vec3::repeat(1.0))),
            ball(Vec3::zeros(), 0.0),
        );
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::<24>::EMPTY);
        for n in [[1.0, 0.3, 0.2], [1.0, -0.1, 0.3]] {
            query
                .evaluate(&mut set, &Vec3::from(n).normalize())
                .unwrap();
        }
        let pairs = [0, 1].map(VertexSet::<24>::pair_of_entry);
        assert!(
            pairs
                .iter()
                .all(|pair| arc_radius(&set, *pair, &query.upper).is_none())
        );
    }

    #[test]
    fn an_inclined_direction_is_between_the_lowest_and_the_normal() {
        let md = balls();
        let (mut query, mut set) = (SupportQuery::new(&md, None, 0.0), VertexSet::EMPTY);
        let corners = corners_around_x(&mut query, &mut set);
        let predictor = Predictor::warm([0.5, 0.25]);
        let gap = 1e-4;
        let upper = query
            .evaluate(&mut set, &Vec3::x())
            .map(|_| query.upper)
            .unwrap();
        for (normal, expected) in [
            (Vec3::new(1.0, 1.0, 0.0), true),
            (Vec3::x(), false),
            (Vec3::y(), false),
        ] {
            let inclined =
                predictor.inclined_from_lowest(&set, &corners, &upper, &normal.normalize(), gap);
            assert!(
                inclined.is_none_or(|Prediction { dir: n, value, .. }| (n.norm() - 1.0).abs()
                    < ROUNDING
                    && n.x > normal.normalize().x
                    && n.y > 0.0
                    && value == upper.depth)
            );
            assert!(expected || inclined.is_none(), "{inclined:?}");
        }
        let near = [Vec3::x(); 3].map(|n| query.evaluate(&mut set, &n).unwrap().vertex());
        let n = Vec3::new(1.0, 1.0, 0.0).normalize();
        let inclined = predictor
            .inclined_from_lowest(&set, &near, &upper, &n, gap)
            .unwrap()
            .dir;
        // The first circle is as wide as the gap allows.
        let first = 2.0 * (gap / 0.75).sqrt();
        assert!((inclined.y / inclined.x - first).abs() < 1e-6, "{inclined}");
    }
}
