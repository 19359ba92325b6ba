// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A pair that is apart, with memory: the direction that separated it is asked first, and
//! while it still separates, one support point is the whole answer.

use crate::gjk::distance::separate;
use crate::known::support_set::{Inquiry, SupportSet};
use crate::math::{EPSILON, Vec3, larger, unit};
use crate::minkowski::support::{Fault, SupportMap};
use crate::state::State;

/// Directions tried before a pair that was apart is asked about as if it were new.
pub const TRIES: usize = 2;
/// The share of the last aim that is aimed at next, where the margin is less. Insensitive: 0.8
/// to 0.99 tried, at most 0.3 % of the recorded contacts' support points.
const KEEP: f64 = 0.95;
/// The share of the aim below which a margin has the direction turned. Insensitive: 0.5 to 0.8 tried
/// on the recorded contacts, at most 0.3 %.
const ENOUGH: f64 = 0.7;
/// The share of the size that is aimed at, at least, where a direction has failed. Measured on
/// pairs that stay apart: with none 1.117 support points a query, 0.01 costs as much for a
/// cylinder over a box; contacts with 0.01 take 0.3 % more.
const HOPE: f64 = 0.0035;

/// The length, metres, of a direction with no margin to aim at: next to none beside objects of
/// any size, and its coordinates keep their digits. Zero would be no direction.
const UNSURE: f64 = f64::MIN_POSITIVE / EPSILON;

/// The state's direction, or what it is turned to, if that still separates, or touches within
/// rounding. The support points of directions that fail go into the set.
///
/// A support point s = s(n) also tells how to turn the direction n: h(n) = −margin is to
/// fall to −aim, its gradient is g, the part of s across n, and the step −g (h + aim) / g²
/// is Polyak's. Where n fails the turned one is asked in the same query, else in the next:
/// so a pair whose contact turns is followed at one support point a query.
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
        let point = inquiry.point(&n)?;
        let margin = -n.dot(&point.v);
        let apart = margin >= -inquiry.precision.touch();
        let least = if apart {
            UNSURE
        } else {
            HOPE * inquiry.precision.size()
        };
        aim = margin.max(KEEP * aim).max(least);
        let mut next = n;
        if margin < ENOUGH * aim {
            let g = point.v + n * margin;
            next = unit(&(n - g * ((aim - margin) / g.norm_squared()))).unwrap_or(n);
        }
        if apart {
            *state = State::apart(next * aim);
            return Ok(Some(n));
        }
        set.push(&n, &point);
        n = next;
    }
    Ok(None)
}

/// Leaves the separating direction `n` behind.
///
/// A pair that was not apart before pays nothing for the next time. One that `was_apart`,
/// and is so along another direction, is worth a better one than that.
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
        let (n, margin) = separate(inquiry, &n)?;
        State::apart(n * larger(margin, UNSURE))
    } else {
        State::apart(n * UNSURE)
    };
    Ok(())
}
