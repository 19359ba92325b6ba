// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap, with memory: the yes or no of [`crate::distance`], and what one
//! query of a pair leaves behind for the next.
//!
//! A pair that was apart is asked about its separating direction first. While that still
//! separates, one support point is the whole answer, and turns the direction for the next
//! time. A pair that overlapped is asked along the directions of the tetrahedron that proved
//! it: where those points still surround the origin, they are the whole answer. Whatever
//! fails is not lost: the points go into the search.

use crate::distance::{overlap, separate};
use crate::math::{EPSILON, Real, Vec3, unit};
use crate::state::State;
use crate::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};
use crate::support_set::{Inquiry, Stop, SupportSet};

/// Directions tried before a pair that was apart is asked about anew.
const TRIES: u32 = 2;
/// What a margin that was reached once is still worth at the next query.
const KEEP: Real = 0.95;
/// A share of the aim below which the separating direction is turned.
const ENOUGH: Real = 0.7;

/// Room for the points of a query: what the state's directions give, and a simplex.
const ROOM: usize = 8;

/// Do the objects overlap? `centre`, an interior point of D, is trusted.
pub fn intersect<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: &SupportPoint,
    state: &mut State,
) -> Result<bool, Fault> {
    let mut inquiry = Inquiry::new(md);
    let mut set = SupportSet::<ROOM>::EMPTY;
    let dir = unit(&-centre.v);
    // A centre at the origin is no corner to look from.
    let inner = dir.map(|_| set.push(&Vec3::zeros(), centre));
    inquiry.precision.note(centre);
    let was_apart = state.separating().is_some();
    let answer = if was_apart {
        still_apart(&mut inquiry, &mut set, state)
    } else {
        surround(&mut inquiry, &mut set, state)
    };
    let answer = match answer {
        Ok(false) => overlap(&mut inquiry, &mut set, inner, &dir.unwrap_or(Vec3::x())),
        Ok(true) => return Ok(false),
        Err(stop) => Err(stop),
    };
    match answer {
        Ok(corners) => {
            // What a depth query left is worth more than this.
            if !state.overlapped() {
                *state = State::surrounded(corners.map(|i| set.direction(i)));
            }
            Ok(true)
        }
        Err(Stop::Apart(n)) => {
            // A pair that is asked about once pays nothing for the next time; one that
            // stays apart while its direction fails is worth a better one.
            *state = if was_apart {
                let (n, margin) = separate(&mut inquiry, n)?;
                State::apart(n * margin)
            } else {
                // No margin to aim at.
                State::apart(n * EPSILON)
            };
            Ok(false)
        }
        Err(Stop::Fault(fault)) => Err(fault),
    }
}

/// Does the state's direction still separate? The points of directions that do not go into
/// the set.
///
/// The support point that shows it also tells how to turn the direction for the next
/// time: h is to fall to −aim, its gradient is the tangential part g of s, and the
/// step −g (h + aim) / g² is Polyak's. A pair whose contact turns is followed so, at
/// one support point a query.
fn still_apart<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<ROOM>,
    state: &mut State,
) -> Result<bool, Stop> {
    let Some(mut n) = state.separating() else {
        return Ok(false);
    };
    let mut aim = state.aim();
    for _ in 0..TRIES {
        let point = inquiry.md.support(&n)?;
        inquiry.precision.note(&point);
        let margin = -n.dot(&point.v);
        aim = margin.max(KEEP * aim);
        let mut next = n;
        if margin < ENOUGH * aim {
            let g = point.v + n * margin;
            next = unit(&(n - g * ((aim - margin) / g.norm_squared()))).unwrap_or(n);
        }
        if margin >= -inquiry.precision.touch() {
            *state = State::apart(next * aim);
            return Ok(true);
        }
        set.push(&n, &point);
        n = next;
    }
    Ok(false)
}

/// Asks along the directions of the state's last tetrahedron. `Err`: one separates.
fn surround<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<ROOM>,
    state: &State,
) -> Result<bool, Stop> {
    for n in state.surrounding().iter().filter_map(unit) {
        let place = set.len();
        inquiry.ask_at(set, place, &n)?;
    }
    Ok(false)
}
