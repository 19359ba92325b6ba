// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The interior point, the portal, and the tetrahedra from which polytopes start: steps 2, 3 and 5 of the global query.

use crate::epa::buffers::SMALL_VERTICES;
use crate::epa::global_minimum::EpaSolver;
use crate::math::{Vec3, larger, lesser, normalise_unscaled};
use crate::minkowski::support::{Difference, SupportPoint};
use crate::minkowski::support_query::{Stop, SupportPlane};
use crate::minkowski::vertex_set::{VertexPair, VertexSet};
use crate::portal::{NearRay, Portal, WIDEST_RING_TAN, discover, refine, ring};
use crate::trace;

/// The largest slope of the ring of a contact that is not deep: 19°. Measured: without a limit, two spheres 0.3
/// of a diameter deep take 32 support points in place of 20, and hulls of 642 corners 5 % more; hulls of 162 corners take
/// 3 % more with 0.25, 8 % more with 0.15.
const WIDE_RING_TAN: f64 = 0.35;
/// The radius of that ring, in upper bounds. Measured: with 2, warm queries of ellipsoids take 6 % more support points; with
/// 4, proofs of them 3 %.
const WIDE_RING_DEPTHS: f64 = 3.0;
/// The distance from the ray, in radii of the ring, below which a vertex counts as near it and a ring is evaluated. Measured:
/// with 1 boxes take 15 % and hulls 7 to 26 % more support points; with 0.125 hulls of 162 corners 9 % and warm ellipsoids 21 %
/// more, bodies on plates of 20 m 3 to 9 % fewer.
const NEAR_RING_REL: f64 = 0.25;
/// The squared turn of the ray, radians, above which the new ray is evaluated too: 29 degrees. Measured: without that misses
/// of `ccdGJKPenetration` take 5.6 support points in place of 4.3; from 6 degrees on hulls without centers take 4 to 7 % more.
const MAX_RAY_TURN2: f64 = 0.25;

impl<D: Difference> EpaSolver<'_, '_, D> {
    /// Step 2. Sets the interior point to the middle of the support points along the ray and opposite to it, and `ray` to the
    /// direction from there to the origin. Returns the opposite direction and its point, which are removed from the
    /// set: as a corner the point would make the portal wide.
    pub(super) fn find_interior<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &mut Vec3,
    ) -> Result<(Vec3, SupportPoint), Stop> {
        trace::stage("interior point");
        let newest = set.point(VertexSet::<N>::pair_of_entry(set.len().saturating_sub(1)));
        let sample = self.query.evaluate(set, &-*ray)?;
        let index = usize::from(sample.pair.a);
        let opposite = (set.dir(index), set.point(sample.pair));
        set.truncate(index);
        self.interior = newest.towards(&opposite.1, 0.5);
        if let Some(n) = normalise_unscaled(&-self.interior.v) {
            let turn2 = (n - *ray).norm_squared();
            *ray = n;
            // Else the support point of the old ray is close enough for the start of a portal.
            if turn2 > MAX_RAY_TURN2 {
                self.query.evaluate(set, ray)?;
            }
        }
        Ok(opposite)
    }

    /// Step 5. Returns whether the centers are closer to each other than the extents of both objects, each from its center along
    /// the direction of the upper bound: the polytope will then reach all around the origin, and a regular tetrahedron
    /// needs fewer insertions than that of a portal. The upper bound alone does not tell: that of a body on a wide plate is as
    /// large as the plate, and bodies there take 6 to 9 % more support points with it.
    pub(super) fn is_central(&self) -> bool {
        let SupportPlane { dir, point, .. } = &self.query.upper;
        self.request.center.is_some_and(|center| {
            let extent1 = dir.dot(&(point.v1 - center.v1));
            let extent2 = dir.dot(&(center.v2 - point.v2));
            let extent = lesser(extent1, extent2);
            extent > 0.0 && center.v.norm_squared() < extent * extent
        })
    }

    /// Step 3. Finds a portal of the ray and refines it.
    #[inline(always)]
    pub(super) fn find_portal<const N: usize>(
        &mut self,
        set: &mut VertexSet<N>,
        ray: &Vec3,
    ) -> Result<Option<Portal>, Stop> {
        let gap = self.allowed_gap();
        let query = &mut *self.query;
        let length = query.upper.depth - self.interior.v.dot(ray);
        // As wide as the gap allows, or as the ball that the tetrahedron of a shallow contact has to contain.
        let wide = lesser(WIDE_RING_DEPTHS * query.upper.depth, WIDE_RING_TAN * length);
        let ring_radius = larger((2.0 * gap * length).sqrt(), wide);
        let near2 = NEAR_RING_REL * NEAR_RING_REL * ring_radius * ring_radius;
        // The vertex of the warm direction of two round objects is on a flat side of D, and a poor corner: the ray is evaluated
        // too, unless a ring is next.
        let [radius1, radius2] = self.predictor.fit.radius;
        if radius1 * radius2 > 0.0 && set.len() == 1 {
            let v1 = set.farthest_vertex(ray).w;
            if (ray * v1.dot(ray) - v1).norm_squared() > near2 {
                query.evaluate(set, ray)?;
            }
        }
        let lowest = query.upper.dir;
        let near_ray = NearRay::Ring {
            axis: &lowest,
            slope: ring_radius / length,
        };
        let Some(mut portal) = discover(
            query,
            set,
            ray,
            length,
            self.far_upper_rel * length,
            near2,
            near_ray,
        )?
        else {
            return Ok(None);
        };
        refine(
            query,
            set,
            &mut self.predictor,
            ray,
            &mut portal,
            &self.request.limits.gap,
        )?;
        Ok(Some(portal))
    }

    /// Step 5. Returns the tetrahedron with which GJK, from unit `dir`, proves the overlap.
    #[cold]
    #[inline(never)]
    pub(super) fn find_gjk_tetrahedron(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        dir: &Vec3,
    ) -> Result<[VertexPair; 4], Stop> {
        let found = self.prove_overlap(dir)?;
        // The points need not be support points, so they are stored without a direction.
        Ok(found.corners().map(|point| {
            VertexSet::<SMALL_VERTICES>::pair_of_entry(set.push(&Vec3::zeros(), &point))
        }))
    }

    /// Step 5. Returns the tetrahedron of `apex`, a point along unit `dir`, and the support points of a wide ring around the
    /// opposite direction; `None` if those of the ring are nearly on a line.
    pub(super) fn find_wide_tetrahedron(
        &mut self,
        set: &mut VertexSet<SMALL_VERTICES>,
        dir: &Vec3,
        apex: VertexPair,
    ) -> Result<Option<[VertexPair; 4]>, Stop> {
        let base = ring(self.query, set, &-dir, WIDEST_RING_TAN)?;
        Ok(base.map(|Portal { corners: [a, b, c] }| [apex, a.pair, b.pair, c.pair]))
    }
}
