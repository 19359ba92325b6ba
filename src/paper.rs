// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's method as published: W. Gao, "Efficient Incremental Penetration Depth Estimation between Convex
//! Geometries", 2023, for comparison, and the query that runs it. [`gao`]: Algorithms 1 and 3 to 5, on support calls
//! only.

pub mod gao;

use crate::epa::buffers::MAX_PROVEN_POINTS;
use crate::math::Vec3;
use crate::minkowski::support::SupportMap;
use crate::minkowski::support_query::Stop;
use crate::minkowski::vertex_set::VertexSet;
use crate::minkowski::warm_start::WarmStart;
use crate::query::Pair;
use crate::types::{Penetration, Settings, Status};
use gao::Until;

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Finds a local minimum of the depth by W. Gao's method with the shortcut (Algorithms 4 and 5), from the
    /// last direction, else from the start direction of a cold query. `plane`: a unit normal; only directions
    /// perpendicular to it are searched.
    pub fn incremental(
        &self,
        plane: Option<Vec3>,
        state: &mut WarmStart,
    ) -> Result<Penetration, Stop> {
        let start = state.direction().unwrap_or_else(|| self.cold_start());
        // Each iteration takes one support point; the start, the overlap and the contact position take the rest of 400
        // (measured on a thousand pairs of each category of c-tests/tests/stability/categories.h: at most 56).
        let max_iterations = self.settings.max_iterations.min(MAX_PROVEN_POINTS);
        let settings = Settings {
            max_iterations,
            ..self.settings
        };
        let until = Until::Shortcut;
        let mut hit = gao::penetration(&self.difference, start, plane, until, &settings, |_| ())?;
        let mut set = VertexSet::EMPTY;
        self.prove_overlap(&mut hit, &mut set, plane.is_some())?;
        *state = WarmStart::towards(hit.normal);
        hit.pos = if self.want.pos && hit.status == Status::Converged && plane.is_none() {
            self.contact_position(&set, &hit)?
        } else {
            hit.middle()
        };
        Ok(hit)
    }
}
