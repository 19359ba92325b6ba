// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum below a depth that the global query could not prove.

use super::Pair;
use crate::contact::{Penetration, Settings, Status};
use crate::epa::expand::EpaLimits;
use crate::minkowski::query::{Stop, SupportQuery};
use crate::minkowski::round_fit::SphereFit;
use crate::minkowski::support::{Fault, SupportMap};
use crate::minkowski::vertex_set::VertexSet;
use crate::mpr::local;

/// The iterations by which an open depth is lowered, at most. Derived: no call takes more than 400 support
/// points.
const MAX_ITERATIONS: u64 = 48;

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// Lowers a depth that the global query could not prove. Where minima form a curve or a surface, no polytope
    /// proves them in the steps there are, and the least depth met need not be theirs to the tolerance. But its
    /// direction is near them, and a walk from there finds one, to a hundredth of the tolerance.
    /// Returns whether the depth is that of a local minimum, within the tolerance.
    #[cold]
    #[inline(never)]
    pub(super) fn floor(&self, hit: &mut Penetration, limits: &EpaLimits) -> Result<bool, Fault> {
        let left = limits.max_iterations.saturating_sub(hit.iterations);
        if left == 0 {
            return Ok(false);
        }
        let settings = Settings {
            tolerance: limits.gap.tolerance * 0.01,
            max_iterations: left.min(MAX_ITERATIONS),
        };
        let mut query = SupportQuery::new(&self.md, self.center.as_ref());
        let mut set = VertexSet::<{ local::MAX_SAMPLES }>::EMPTY;
        let mut fit = SphereFit::default();
        match local::penetration(&mut query, &mut set, &mut fit, &hit.normal, &settings) {
            Ok((floor, Status::Converged)) => {
                // A face is as far from its support plane as both are rounded.
                let tolerance =
                    query.scale.tolerance(limits.gap.tolerance) + query.scale.height_eps();
                if !floor.has_sound_witnesses(tolerance) {
                    return Ok(false);
                }
                let is_minimum =
                    floor.depth <= hit.depth + query.scale.tolerance(settings.tolerance);
                if is_minimum {
                    *hit = Penetration {
                        depth_lower: hit.depth_lower.min(floor.depth),
                        iterations: hit.iterations + floor.iterations,
                        limit: true,
                        ..floor
                    };
                }
                Ok(is_minimum)
            }
            Ok(_) | Err(Stop::Apart(_)) => Ok(false),
            Err(Stop::Fault(fault)) => Err(fault),
        }
    }
}
