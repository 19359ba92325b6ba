// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The last refinement of a direction. The bounds of a default query meet within 0.1 % of the depth; the direction of such
//! an upper bound can be off by degrees on curved bodies.
//!
//! No reference is known to us. Term: the *ray* is the direction of the upper bound, from the origin.
//!
//! 1. *Face*: replace corners by known differences, so that the ray crosses the face, until none is above it.
//! 2. *Prediction* of the sphere fits, else of Newton's step ([`Predictor`]), between the bounds; without one the normal of
//!    the face.
//! 3. *Evaluation*, if that can lower the upper bound by more than the tolerance. The point replaces a corner. If the support
//!    value is what a model predicts, this is the end; otherwise step 1 is next, up to [`MAX_REFINEMENTS`] times.
//!
//! Outputs. The upper bound, which is sound, and a face of the inner model near it, for witness points. Nothing else is
//! proven.

use crate::minkowski::predictor::{Prediction, Predictor};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportQuery};
use crate::minkowski::tuning::INSERT_HEIGHT_GAPS;
use crate::minkowski::vertex_set::VertexSet;
use crate::portal::{Exact, Portal, PortalPlane};
use crate::trace;

/// The largest number of directions of a refinement. Measured on 20 pairs of primitives 0.3 m deep (`directions.c`): with 3
/// the largest error is 1.1° in place of 0.8°, and warm directions of moving pairs jitter by 0.12° in place of 0.09°; a
/// curved pair takes 0.1 to 0.5 support points fewer.
pub const MAX_REFINEMENTS: usize = 4;

/// Evaluates up to [`MAX_REFINEMENTS`] directions, by the steps at the head of this file. `predictor`: that of the search.
/// `face`: a triangle of points of D that the ray crosses, with an outward normal. `lower`: the lower bound of the depth,
/// metres. `tolerance`: metres. A full set ends the refinement.
///
/// # Errors
/// As [`SupportQuery::evaluate`].
#[inline(never)]
pub fn refine_direction<D: Difference, const N: usize>(
    query: &mut SupportQuery<'_, D>,
    set: &mut VertexSet<N>,
    predictor: &mut Predictor,
    face: &mut Portal,
    lower: f64,
    tolerance: f64,
) -> Result<(), Stop> {
    trace::stage("direction");
    for _ in 0..MAX_REFINEMENTS {
        let upper = query.upper;
        let target = upper.depth - tolerance;
        let level = query.scale.height_eps() + INSERT_HEIGHT_GAPS * tolerance;
        let climbed = face.climb(set, &upper.dir, Exact::Nothing, |plane| {
            Some(level * plane.length)
        });
        let Some(PortalPlane { normal, offset, .. }) = climbed.and_then(|plane| plane.unit())
        else {
            break;
        };
        let is_possible = |p: &Prediction| p.value >= lower && p.value <= upper.depth;
        let prediction = predictor.minimum(set, &face.corners, &normal, &upper, is_possible);
        let (dir, value) = prediction.map_or((normal, offset), |p| (p.dir, p.value));
        // The prediction is the upper bound, or there is no room.
        if !(value < target) || set.is_full() {
            break;
        }
        let sample = query.evaluate(set, &dir)?;
        if let Some(p) = prediction {
            predictor.judge(&p, sample.h, upper.depth, tolerance);
            if !(sample.h < target) {
                predictor.fail_above(&normal);
            }
        }
        face.replace_corner(&query.upper.dir, sample.vertex(), Exact::Nothing);
        if prediction.is_some() && (sample.h - value).abs() <= tolerance {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::minkowski::support::MinkowskiDifference;
    use crate::test_shapes::{Random, Rotation, Shape, ball, difference, ellipsoid};

    const TOLERANCE: f64 = 1e-6;

    /// Refines the face of three directions 0.3 rad from `shortest`, in which the support value is least. Returns the
    /// angle to it, radians, the upper bound, and the number of evaluated directions.
    fn refine(
        md: &MinkowskiDifference<Shape<'_>, Shape<'_>>,
        shortest: &Vec3,
        r: &mut Random,
    ) -> (f64, f64, u64) {
        let mut query = SupportQuery::new(md, None, TOLERANCE);
        let mut set = VertexSet::<16>::EMPTY;
        let e1 = crate::math::perpendicular(shortest);
        let e2 = shortest.cross(&e1);
        let turn = r.within(0.0, 2.0);
        let corners = [0.0, 2.0, 4.0].map(|angle| {
            let (sine, cosine) = (turn + angle * core::f64::consts::FRAC_PI_3).sin_cos();
            let n = (shortest + (e1 * cosine + e2 * sine) * r.within(0.2, 0.3)).normalize();
            query.evaluate(&mut set, &n).unwrap().vertex()
        });
        let mut face = Portal { corners };
        refine_direction(
            &mut query,
            &mut set,
            &mut Predictor::default(),
            &mut face,
            0.0,
            TOLERANCE,
        )
        .unwrap();
        let turn = (query.upper.dir - shortest).norm();
        (turn, query.upper.depth, query.support_points() - 3)
    }

    #[test]
    fn the_direction_of_balls_is_exact_after_one_prediction() {
        let mut r = Random::new(61);
        for _ in 0..100 {
            let way = r.direction();
            let md = difference(ball(Vec3::zeros(), 0.5), ball(way * 0.6, 0.25));
            let (turn, depth, count) = refine(&md, &way, &mut r);
            assert!(
                turn < 1e-4 && (depth - 0.15).abs() < TOLERANCE,
                "{turn} {depth}"
            );
            assert_eq!(count, 1);
        }
    }

    #[test]
    fn the_direction_of_an_ellipsoid_comes_closer() {
        let mut r = Random::new(62);
        let mut error2 = 0.0;
        for _ in 0..100 {
            let radii = Vec3::new(r.within(0.5, 0.6), r.within(0.8, 1.0), r.within(0.8, 1.0));
            let body = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
            let md = difference(body, ball(Vec3::zeros(), 0.0));
            let (turn, depth, count) = refine(&md, &Vec3::x(), &mut r);
            assert!(depth >= radii.x - TOLERANCE && count <= MAX_REFINEMENTS as u64);
            error2 += turn * turn;
        }
        // The corners' directions are off by 0.25 rad.
        assert!((error2 / 100.0).sqrt() < 0.02, "{error2}");
    }
}
