// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum, its overlap not proven, and what it is good for in the other queries.

use super::Pair;
use crate::contact::{INSIDE, Penetration, Settings};
use crate::epa::expand::EpaLimits;
use crate::known::points::Points;
use crate::known::support_set::Stop;
use crate::local::{self, Memory};
use crate::math::larger;
use crate::minkowski::support::{Fault, Known, SupportMap};
use crate::paper::incremental;
use crate::paper::portal::{Until, rounding};

/// Iterations by which an open depth is lowered, at most: one local search needs a dozen, on the hardest
/// pairs thirty. (64, after a proof that met its cap, are 403 support points.)
const BUDGET: u64 = 48;

impl<A: SupportMap, B: SupportMap> Pair<A, B> {
    /// A local minimum, its overlap not proven: in the face that the pair touched in before, where that is
    /// still there; else mostly the first search ends at one.
    pub(super) fn local_minimum(
        &self,
        memory: &mut Memory,
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        self.search(memory, None, settings, known, hit)
    }

    /// Local searches, the first from what has been `seen` already, if anything: each from the lowest place
    /// that the one before met, as long as that is lower than before; then the paper's method.
    #[inline(never)]
    fn search(
        &self,
        memory: &mut Memory,
        mut seen: Option<&Points>,
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let mut rest = *settings;
        let mut before = f64::INFINITY;
        // Ends: what is left falls.
        loop {
            let centre = self.centre.as_ref().map(|c| &c.v);
            let start = || self.cold_start();
            let asked = (seen.take(), &rest);
            let found = local::penetration(&self.md, centre, start, memory, asked, (known, hit))?;
            let left = rest.max_iterations.saturating_sub(hit.iterations.max(1));
            hit.iterations += settings.max_iterations - rest.max_iterations;
            rest.max_iterations = left;
            if found || left == 0 {
                return Ok(found);
            }
            // Depths that differ by less are the same.
            let reach = larger(hit.point1.norm(), hit.point2.norm());
            if !(hit.depth < before - larger(settings.tolerance, rounding(reach))) {
                break;
            }
            before = hit.depth;
        }
        let until = Until::Shortcut;
        match incremental::penetration(&self.md, hit.normal, None, until, &rest, |_| ()) {
            // D reaches beyond that plane: a callback that errs must not separate.
            Err(Stop::Apart(n)) if known.farthest(&n).is_some() => return Ok(false),
            found => *hit = found?,
        }
        hit.iterations += settings.max_iterations - rest.max_iterations;
        *memory = Memory::towards(hit.normal);
        Ok(!hit.limit)
    }

    /// Lowers a depth that the global search could not prove. Where minima form a curve or a
    /// surface, no polytope proves them in the steps there are, and the least depth met need
    /// not be theirs to the tolerance. But its direction is near them, and a local search from
    /// there finds one: to a hundredth of the tolerance, since what falls so little over the
    /// first trust radius falls thirty times as much over the sphere.
    /// It takes what is left of the iterations, and no more than [`BUDGET`].
    #[cold]
    #[inline(never)]
    pub(super) fn floor(&self, hit: &mut Penetration, limits: &EpaLimits) -> Result<(), Fault> {
        let left = limits.max_iterations.saturating_sub(hit.iterations);
        if left == 0 {
            return Ok(());
        }
        let level = Settings {
            tolerance: limits.gap.tolerance * 0.01,
            max_iterations: left.min(BUDGET),
        };
        let mut memory = Memory::towards(hit.normal);
        let mut known = Known::default();
        let mut floor = Penetration::default();
        match self.local_minimum(&mut memory, &level, &mut known, &mut floor) {
            Ok(minimum) if floor.depth < hit.depth => {
                // The polytope's witness points are points of the objects, the local search's lie on
                // the planes, and beside their objects where it found no minimum.
                let reach = larger(floor.point1.norm(), floor.point2.norm());
                let near = larger(limits.gap.tolerance, INSIDE * reach);
                let [one, two] = [hit.point1 - floor.point1, hit.point2 - floor.point2];
                let n = &floor.normal;
                if one.dot(n).abs() <= near && two.dot(n).abs() <= near {
                    (floor.point1, floor.point2) = (hit.point1, hit.point2);
                } else if !minimum {
                    return Ok(());
                }
                *hit = Penetration {
                    depth_lower: hit.depth_lower.min(floor.depth),
                    iterations: hit.iterations + floor.iterations,
                    limit: true,
                    ..floor
                };
                Ok(())
            }
            Ok(_) | Err(Stop::Apart(_)) => Ok(()),
            Err(Stop::Fault(fault)) => Err(fault),
        }
    }
}
