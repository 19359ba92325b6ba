// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum in a face of D that is still there.
//!
//! What two polytopes touch in is mostly a face that they touched in before, a little turned. The directions
//! that found its corners find them again; the polytope P of all that is known has the face
//! ([`crate::hull::portal`], as seen along the lowest direction instead of from an apex); and one
//! question along its normal finds nothing above it, or none where it has not turned.
//!
//! *Why that is a minimum.* P is in D, so h(m) >= m·x for all directions m and points x of P. The search ends
//! where x, in the face, is the foot n h(n) of the origin in the lowest plane, to what the tolerance allows
//! ([`crate::hull::portal::Portal::touches`]): of a direction m at the angle θ from n, h(m) >= h(n) cos θ by x
//! alone, and more by the face's corners, which lie around x. What is round
//! counts as a polytope of the points that it shows, as far as the tolerance lets it.

use crate::contact::Penetration;
use crate::hull::global::mixed;
use crate::hull::portal::View;
use crate::hull::shallow::{LEVEL, STEPS, Sizes, Try};
use crate::known::support_set::{Inquiry, Lowest, Stop};
use crate::math::{Vec3, larger, normalised};
use crate::minkowski::support::{Known, SupportMap, SupportPoint};

/// Questions along normals. Measured on the recorded contacts: with 1 hits take 5 % more
/// instructions, with 2 1 %.
const QUESTIONS: usize = 3;

impl Try {
    /// Is there a local minimum near the lowest direction, in a face that few questions show? `last`: a
    /// direction to ask where those asked show none; zero for none.
    ///
    /// # Errors
    /// As [`Try::run`].
    #[inline(never)]
    pub fn face<A: SupportMap, B: SupportMap>(
        &mut self,
        inquiry: &mut Inquiry<'_, A, B>,
        last: &Vec3,
        tolerance: f64,
    ) -> Result<bool, Stop> {
        let sizes = Sizes::of(&inquiry.precision, tolerance);
        self.look_back(inquiry);
        if *last != Vec3::zeros() {
            self.portal = View::of(&self.points, self.from, &self.c).portal(&self.points, &self.c);
            if self.portal.is_none() {
                if self.ask(inquiry, last)?.is_none() {
                    return Ok(false);
                }
                self.look_back(inquiry);
            }
        }
        if self.portal.is_none() && !self.find(inquiry, false, sizes.tolerance)? {
            return Ok(false);
        }
        let mut questions = QUESTIONS;
        while let Some(portal) = &mut self.portal {
            let mut plane = portal.plane();
            for _ in 0..2 * STEPS {
                if !portal.advance(&self.points, &plane, &self.c, LEVEL * sizes.tolerance) {
                    break;
                }
                plane = portal.plane();
            }
            let lowest = &inquiry.lowest;
            let least = larger(lowest.depth - sizes.tolerance, 0.5 * lowest.depth);
            if let Some(weights) = portal.touches(&plane, lowest, least, sizes.tolerance) {
                self.exit = Some((portal.names, weights));
                return Ok(true);
            }
            if questions == 0 || self.points.is_full() {
                break;
            }
            questions -= 1;
            let asked = match normalised(&plane.n) {
                Some(n) => self.ask(inquiry, &n)?,
                None => None,
            };
            if asked.is_none() {
                break;
            }
            self.look_back(inquiry);
            self.portal = self
                .portal
                .and_then(|portal| portal.moved(&self.points, &self.c));
        }
        Ok(false)
    }

    /// Looks along the lowest direction, from far behind the origin.
    fn look_back<A, B>(&mut self, inquiry: &Inquiry<'_, A, B>) {
        self.c = -inquiry.lowest.dir * inquiry.precision.size();
        self.from = self.lowest;
    }

    /// Writes the answer in the face, and its corners to `known`: the one that the lowest direction itself has
    /// found comes first, if it has found one.
    pub fn conclude(&self, lowest: &Lowest, known: &mut Known, hit: &mut Penetration) {
        let Some((names, weights)) = self.exit else {
            return;
        };
        let points = &self.points;
        let corners = names.map(|names| points.witnesses(names));
        let [point1, point2] = mixed(&weights, corners);
        *hit = Penetration {
            depth: lowest.depth,
            dir: lowest.dir,
            normal: lowest.dir,
            point1,
            point2,
            extent: points.extent([&point1, &point2]),
            iterations: points.asked() as u64,
            ..Penetration::default()
        };
        let own = points.names(self.lowest);
        let first = names.iter().position(|corner| *corner == own).unwrap_or(0);
        for i in first..first + 3 {
            let [v1, v2] = corners[i % 3];
            known.push(&SupportPoint { v: v1 - v2, v1, v2 });
        }
    }
}
