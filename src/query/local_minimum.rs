// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum, its overlap not proven, and what it is good for in the other queries.

use super::Pair;
use crate::contact::{INSIDE, Penetration, Settings};
use crate::hull::expansion::Limits;
use crate::hull::shallow::Try;
use crate::known::points::{Points, ROOM};
use crate::known::support::{Fault, Known, SupportMap};
use crate::known::support_set::{Inquiry, Stop};
use crate::local::{self, Memory};
use crate::math::{Real, Vec3, larger};
use crate::paper::incremental;
use crate::paper::portal::{Until, rounding};

/// Iterations of one local search, at most: it needs a dozen, on the hardest pairs thirty. (64, after a proof
/// that met its cap, are 403 support points.)
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
        let most = settings.max_iterations;
        if let Some(directions) = memory
            .face(settings.tolerance)
            .filter(|_| most >= ROOM as u64)
        {
            return self.in_face(memory, &directions, settings, known, hit);
        }
        Ok(self.search(memory, None, most, settings, known, hit)?
            || self.search_on(memory, settings, known, hit)?)
    }

    /// The same from [`Memory::face`].
    #[inline(never)]
    fn in_face(
        &self,
        memory: &mut Memory,
        [dir, others @ .., last]: &[Vec3; 4],
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let mut inquiry = Inquiry::new(&self.md);
        let first = inquiry.first(dir, None)?;
        let mut face = Try::new(dir, &first);
        if face.recall(&mut inquiry, others)?
            && face.face(&mut inquiry, last, settings.tolerance)?
        {
            face.conclude(&inquiry.lowest, known, hit);
            memory.touch(&hit.dir, known.points());
            return Ok(true);
        }
        // A callback that contradicts itself is asked anew.
        let seen = Some(&face.points).filter(|_| !face.lies);
        let most = settings.max_iterations;
        Ok(self.search(memory, seen, most, settings, known, hit)?
            || self.search_on(memory, settings, known, hit)?)
    }

    /// Goes on from a search that stalled: from the lowest place it met, as long as that is lower than
    /// before; then by the paper's method.
    #[cold]
    #[inline(never)]
    fn search_on(
        &self,
        memory: &mut Memory,
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let most = settings.max_iterations;
        let mut left = most;
        let mut before = Real::INFINITY;
        // Ends: `left` falls.
        loop {
            left = left.saturating_sub(hit.iterations.max(1));
            // Depths that differ by less are the same.
            let reach = larger(hit.point1.norm(), hit.point2.norm());
            let lower = hit.depth < before - larger(settings.tolerance, rounding(reach));
            if !lower || left == 0 {
                break;
            }
            before = hit.depth;
            *memory = Memory::towards(hit.normal);
            if self.search(memory, None, left, settings, known, hit)? {
                hit.iterations += most - left;
                return Ok(true);
            }
        }
        hit.iterations = most - left;
        if left == 0 {
            return Ok(false);
        }
        let rest = Settings {
            max_iterations: left,
            ..*settings
        };
        let start = hit.normal;
        let until = Until::Shortcut;
        match incremental::penetration(&self.md, start, None, until, &rest, |_| ()) {
            // D reaches beyond that plane: a callback that errs must not separate.
            Err(Stop::Apart(n)) if known.farthest(&n).is_some() => return Ok(false),
            found => *hit = found?,
        }
        hit.iterations += most - left;
        *memory = Memory::towards(hit.normal);
        Ok(!hit.limit)
    }

    /// One local search, of so many iterations at most, or [`BUDGET`]; `seen`: what has been asked already.
    #[inline(never)]
    fn search(
        &self,
        memory: &mut Memory,
        seen: Option<&Points>,
        max_iterations: u64,
        settings: &Settings,
        known: &mut Known,
        hit: &mut Penetration,
    ) -> Result<bool, Stop> {
        let settings = Settings {
            max_iterations: max_iterations.min(BUDGET),
            ..*settings
        };
        local::penetration(
            &self.md,
            self.centre.as_ref().map(|c| &c.v),
            || self.cold_start(),
            memory,
            &settings,
            seen,
            (known, hit),
        )
    }

    /// Lowers a depth that the global search could not prove. Where minima form a curve or a
    /// surface, no polytope proves them in the steps there are, and the least depth met need
    /// not be theirs to the tolerance. But its direction is near them, and a local search from
    /// there finds one: to a hundredth of the tolerance, since what falls so little over the
    /// first trust radius falls thirty times as much over the sphere.
    /// It takes what is left of the iterations, and no more than one search's.
    #[cold]
    #[inline(never)]
    pub(super) fn floor(&self, hit: &mut Penetration, limits: &Limits) -> Result<(), Fault> {
        let left = limits.iterations.saturating_sub(hit.iterations);
        if left == 0 {
            return Ok(());
        }
        let level = Settings {
            tolerance: limits.tolerance * 0.01,
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
                let near = larger(limits.tolerance, INSIDE * reach);
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
