// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The queries with a result by name: what C and Rust callers choose between.

use crate::epa::buffers::Arena;
use crate::math::Vec3;
use crate::minkowski::support::SupportMap;
use crate::minkowski::support_query::Stop;
use crate::minkowski::warm_start::WarmStart;
use crate::query::Pair;
use crate::query::signed_distance::Margins;
use crate::types::Penetration;

/// A query for the depth or the signed distance.
#[derive(Clone, Copy, Debug)]
pub enum Solver {
    /// [`Pair::penetration`]: the global minimum within 0.1 %.
    Global,
    /// [`Pair::proven`]: the global minimum within the tolerance, without the centers.
    Proven,
    /// [`Pair::local`]: a local minimum.
    Local,
    /// [`Pair::along`]: the depth along this unit direction.
    Along(Vec3),
    /// [`Pair::incremental`] in the plane with this unit normal.
    Planar(Vec3),
    /// [`Pair::incremental`]: the published method.
    Incremental,
    /// [`Pair::signed_distance`] of the objects with these margins.
    Distance(Margins),
}

impl Solver {
    /// Runs the query from the state of the last one. [`WarmStart::note_separation`] and [`Penetration::finish`] are to
    /// follow. `arena`: used by [`Solver::Proven`] and [`Solver::Distance`] alone.
    ///
    /// # Errors
    /// [`Stop::Separated`], not of [`Solver::Distance`]; [`Stop::Fault`]: the state is then not for use.
    #[inline(always)]
    pub fn run<A: SupportMap, B: SupportMap>(
        self,
        pair: &Pair<A, B>,
        state: &mut WarmStart,
        arena: &mut dyn Arena,
    ) -> Result<Penetration, Stop> {
        // A distance starts from the axis.
        if !matches!(self, Solver::Distance(_)) {
            pair.separate(state)?;
        }
        match self {
            Solver::Global => pair.penetration(state),
            Solver::Proven => pair.proven(state, arena),
            Solver::Local => pair.local(state),
            Solver::Along(dir) => pair.along(&dir, state),
            Solver::Planar(normal) => pair.incremental(Some(normal), state),
            Solver::Incremental => pair.incremental(None, state),
            Solver::Distance(margins) => pair.signed_distance(&margins, state, arena),
        }
    }
}
