// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The proofs of a portal and of a polytope: steps 4, 6 and 7 of the global query.

use crate::epa::buffers::SMALL_VERTICES;
use crate::epa::direction::refine_direction;
use crate::epa::global_minimum::EpaSolver;
use crate::epa::polytope::EpaPolytope;
use crate::epa::witness::{exit_face, max_foot_distance2, witness_points};
use crate::geometry::plane::{PLANE_ERROR_ULPS, base_distance};
use crate::math::{Vec3, larger};
use crate::minkowski::support::Difference;
use crate::minkowski::support_query::{Stop, SupportPlane};
use crate::minkowski::vertex_set::{Vertex, VertexSet};
use crate::portal::Portal;
use crate::types::Status;

/// The gap above the tolerance that counts as converged if rounding ended the search, in support epsilons. Derived: 20
/// for the rounding of a plane and of a point above it if the size of D is twice the world extent; the rest is a
/// reserve.
const ROUNDING_GAP_EPS: f64 = 32.0;

/// The bounds and the witness points of a polytope or portal.
#[derive(Clone, Copy)]
pub struct Proof {
    /// The upper bound, metres.
    pub upper: f64,
    /// Its direction, unit.
    pub dir: Vec3,
    /// The lower bound of the depth, metres; 0 if none is proven.
    pub lower: f64,
    /// The witness points of the upper bound.
    pub points: [Vec3; 2],
    /// True if a support function contradicts the plane of the upper bound.
    pub is_inconsistent: bool,
}

impl<D: Difference> EpaSolver<'_, '_, D> {
    /// Steps 4 and 6. Tries to prove the minimum from the tetrahedron of interior point and portal. Returns the proof.
    #[inline(always)]
    pub(super) fn certify(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        portal: &Portal,
    ) -> Result<Option<Proof>, Stop> {
        let scale = &self.query.scale;
        let size = scale.size();
        let tolerance = scale.tolerance(self.request.limits.gap.tolerance);
        let allowed = self.allowed_gap();
        let error = PLANE_ERROR_ULPS * f64::EPSILON * size + scale.support_eps();
        // A lower bound of at most the contact epsilon proves no overlap.
        let least = larger(self.query.upper.depth - allowed, scale.contact_eps()) + error;
        let Some(distance) = base_distance(&self.interior.v, &portal.points(), least, size) else {
            return Ok(None);
        };
        let lower = distance - error;
        let mut face = *portal;
        if self.query.upper.depth - lower > tolerance {
            let (query, predictor) = (&mut *self.query, &mut self.predictor);
            refine_direction(query, set, predictor, &mut face, lower, tolerance)?;
        }
        Ok(Some(self.proof(
            set,
            &face.corners,
            || portal.corners,
            lower,
            allowed,
        )))
    }

    /// Steps 6 and 7. Returns the proof of an expansion that ended with `end`, and its status: [`Status::Rounding`] if the polytope does
    /// not provably contain the origin.
    #[inline(never)]
    pub(super) fn compute_result<const N: usize, const F: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        polytope: &EpaPolytope<F>,
        end: Status,
    ) -> Result<(Proof, Status), Stop> {
        let closest = polytope.closest_face();
        let support_eps = self.query.scale.support_eps();
        let gap_limit = &self.request.limits.gap;
        let tolerance = self.query.scale.tolerance(gap_limit.tolerance);
        let is_inside = polytope.encloses_interior_point() && closest.key >= 0.0;
        let lower = if is_inside {
            larger(polytope.lower_bound(&closest) - support_eps, 0.0)
        } else {
            0.0
        };
        let interior = self.interior.v;
        let exit_face = |upper: &SupportPlane, set: &VertexSet<N>, gap: f64| {
            exit_face(upper, &interior, set, polytope, closest.face, gap)
        };
        let mut refined = None;
        if end == Status::Converged && self.query.upper.depth - lower > tolerance {
            let corners = exit_face(&self.query.upper, set, self.allowed_gap());
            let mut face = Portal { corners };
            let (query, predictor) = (&mut *self.query, &mut self.predictor);
            refine_direction(query, set, predictor, &mut face, lower, tolerance)?;
            refined = Some(face.corners);
        }
        let upper = self.query.upper.depth;
        let gap = self.allowed_gap();
        let face = match refined {
            Some(face) => face,
            None if self.request.wants_points => exit_face(&self.query.upper, set, gap),
            None => [Vertex::default(); 3],
        };
        let other = || exit_face(&self.query.upper, set, gap);
        let proof = self.proof(set, &face, other, lower, gap);
        // Converged is decided by the lower bound as rounded down, whatever ended the expansion.
        let rounding = ROUNDING_GAP_EPS * support_eps;
        let allowed = larger(gap, larger(gap_limit.tolerance, tolerance) + rounding);
        let status = match end {
            _ if !is_inside => Status::Rounding,
            _ if upper - lower <= allowed => Status::Converged,
            Status::Converged => Status::Rounding,
            _ => end,
        };
        Ok((proof, status))
    }

    /// Step 7. Returns the proof of the upper bound. `face`: a face of the inner model near it, read for witness points alone.
    /// `other`: returns a second face, for a foot that is not close to the first; the ray of a refined direction may cross
    /// neither.
    #[inline(always)]
    fn proof<const N: usize>(
        &self,
        set: &VertexSet<N>,
        face: &[Vertex; 3],
        other: impl FnOnce() -> [Vertex; 3],
        lower: f64,
        gap: f64,
    ) -> Proof {
        let upper = &self.query.upper;
        let mut points = [Vec3::zeros(); 2];
        if self.request.wants_points {
            let closest =
                |face: &[Vertex; 3]| witness_points(upper, &self.interior, set, face, gap);
            let distance2;
            (points, distance2) = closest(face);
            if distance2 > max_foot_distance2(upper, gap) {
                let found = closest(&other());
                if found.1 < distance2 {
                    points = found.0;
                }
            }
        }
        Proof {
            upper: upper.depth,
            dir: upper.dir,
            lower,
            points,
            is_inconsistent: self.query.is_inconsistent(set),
        }
    }
}
