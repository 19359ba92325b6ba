// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Has a pair moved since it was asked last? Not, where the same directions find the same points,
//! and these hold it.

use crate::math::{Vec3, larger};

/// A number made of points of the two objects, in any order, and the same for the objects swapped:
/// that it is another one for other points is as sure as 64 bits can make it.
pub fn of(points: impl Iterator<Item = [Vec3; 2]>) -> u64 {
    // Fowler, Noll and Vo's hash, a word at a time, its high bits brought down.
    let of_one = |p: &Vec3| {
        p.iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, x| {
            #[allow(clippy::unnecessary_cast)] // In double precision.
            let word = (*x as f64).to_bits();
            let mixed = (hash ^ word).wrapping_mul(0x0100_0000_01b3);
            mixed ^ mixed >> 29
        })
    };
    points.fold(0, |sum: u64, [p, q]| {
        sum.wrapping_add(of_one(&p).wrapping_mul(of_one(&q)))
    })
}

/// Can neither object move while its points, these, stay where they are? Not so, where they lie
/// on one line; but on one through its centre it could only spin, which nobody who looks at the
/// points can tell from rest.
pub fn pins(points: impl Iterator<Item = [Vec3; 2]> + Clone, with_centres: bool) -> bool {
    let least = if with_centres { 1 } else { 2 };
    (0..2).all(|object| {
        let own = points.clone().map(|p| p[object % 2]);
        let longest = dimensions(own.clone(), 0.0).1;
        // Narrower than a millionth of its length is a line.
        dimensions(own, 1e-12 * longest * longest).0 >= least
    })
}

/// How many dimensions a set of points in a plane has, and its length, metres; what is shorter
/// or narrower than the square root of `blur`, m², is nothing.
fn dimensions(points: impl Iterator<Item = Vec3> + Clone, blur: f64) -> (u32, f64) {
    let Some(first) = points.clone().next() else {
        return (0, 0.0);
    };
    let sides = points.map(|p| p - first);
    let longest = sides.clone().fold(Vec3::zeros(), |l, s| {
        if s.norm_squared() > l.norm_squared() {
            s
        } else {
            l
        }
    });
    let length2 = longest.norm_squared();
    if !(length2 > blur) {
        return (0, 0.0);
    }
    let across2 = sides.fold(0.0, |w, s| larger(w, longest.cross(&s).norm_squared()));
    (1 + u32::from(across2 > blur * length2), length2.sqrt())
}
