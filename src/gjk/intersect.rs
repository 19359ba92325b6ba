// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Do two objects overlap, with memory: the yes or no of [`crate::gjk::overlap`], and what one
//! query of a pair leaves behind for the next.
//!
//! A pair that was apart is asked about its separating direction first
//! ([`crate::gjk::separation`]). A pair that overlapped is asked along the directions of the tetrahedron that proved
//! it: where those points still surround the origin, they are the whole answer. Whatever
//! fails is not lost: the points go into the search.

use crate::gjk::overlap::{ROOM, overlap};
use crate::gjk::separation::{leave, still_apart};
use crate::known::support_set::{Inquiry, Stop, SupportSet};
use crate::math::{Vec3, unit};
use crate::minkowski::support::{MinkowskiDifference, SupportMap, SupportPoint};
use crate::state::State;

/// Shows that the objects overlap. `centre`, an interior point of D, is trusted. Where there is none, the
/// search begins along `first`, unit.
///
/// # Errors
/// [`Stop::Apart`]; a callback's answer that is not finite.
pub fn intersect<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&SupportPoint>,
    first: impl FnOnce() -> Vec3,
    state: &mut State,
) -> Result<(), Stop> {
    let mut inquiry = Inquiry::new(md);
    let mut set = SupportSet::<ROOM>::EMPTY;
    // A centre at the origin is no corner to look from.
    let dir = centre.and_then(|c| unit(&-c.v));
    let inner = match (centre, dir) {
        (Some(centre), Some(_)) => Some(set.push(&Vec3::zeros(), centre)),
        _ => None,
    };
    if let Some(centre) = centre {
        inquiry.precision.note(centre);
    }
    let was_apart = state.separating().is_some();
    if let Some(n) = still_apart(&mut inquiry, &mut set, state)? {
        return Err(Stop::Apart(n));
    }
    let answer = surround(&mut inquiry, &mut set, state).and_then(|()| {
        overlap(
            &mut inquiry,
            &mut set,
            inner,
            None,
            &dir.unwrap_or_else(first),
        )
    });
    match &answer {
        // What a depth query left is worth more than this.
        Ok(held) if !state.overlapped() => {
            *state = State::surrounded(held.corners.map(|i| set.direction(i)));
        }
        Err(Stop::Apart(n)) => leave(&mut inquiry, state, was_apart, *n)?,
        _ => {}
    }
    answer.map(|_| ())
}

/// Asks along the directions of the state's last tetrahedron. `Err`: one separates.
fn surround<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<ROOM>,
    state: &State,
) -> Result<(), Stop> {
    for n in state.surrounding().iter().filter_map(unit) {
        let place = set.len();
        inquiry.ask_at(set, place, &n)?;
    }
    Ok(())
}
