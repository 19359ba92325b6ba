// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A pair that is apart, with memory: the direction that separated it is asked first, and
//! while it still separates, one support point is the whole answer.

use crate::distance::separate;
use crate::math::{EPSILON, Real, Vec3, unit};
use crate::state::State;
use crate::support::{Fault, SupportMap};
use crate::support_set::{Inquiry, SupportSet};

/// Directions tried before a pair that was apart is asked about anew.
const TRIES: u32 = 2;
/// What a margin that was reached once is still worth at the next query. Free: a pair that
/// comes closer loses its margin in any case.
const KEEP: Real = 0.95;
/// A share of the aim below which the separating direction is turned. Free.
const ENOUGH: Real = 0.7;

/// The state's direction, or what it is turned to, where that still separates. The points of
/// directions that do not go into the set.
///
/// The support point that shows it also tells how to turn the direction for the next
/// time: h is to fall to −aim, its gradient is the tangential part g of s, and the
/// step −g (h + aim) / g² is Polyak's. A pair whose contact turns is followed so, at
/// one support point a query.
///
/// # Errors
/// A callback's answer that is not finite.
#[inline(always)]
pub fn still_apart<A: SupportMap, B: SupportMap, const N: usize>(
    inquiry: &mut Inquiry<'_, A, B>,
    set: &mut SupportSet<N>,
    state: &mut State,
) -> Result<Option<Vec3>, Fault> {
    let Some(mut n) = state.separating() else {
        return Ok(None);
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
            return Ok(Some(n));
        }
        set.push(&n, &point);
        n = next;
    }
    Ok(None)
}

/// Leaves a separating direction behind.
///
/// A pair that is asked about once pays nothing for the next time; one that `was_apart`
/// and stays so while its direction fails is worth a better one.
///
/// # Errors
/// A callback's answer that is not finite.
pub fn leave<A: SupportMap, B: SupportMap>(
    inquiry: &mut Inquiry<'_, A, B>,
    state: &mut State,
    was_apart: bool,
    n: Vec3,
) -> Result<(), Fault> {
    *state = if was_apart {
        let (n, margin) = separate(inquiry, n)?;
        State::apart(n * margin)
    } else {
        // No margin to aim at.
        State::apart(n * EPSILON)
    };
    Ok(())
}
