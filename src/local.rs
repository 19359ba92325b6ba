// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum of the penetration depth in few support points: a bundle method with a trust
//! region, on what is known of each object.
//!
//! The question is the paper's (Sec. III): the unit n with the least support value
//! h(n) = max over D of n·p, near a start. The paper walks there by rays and
//! portals, whose update is the dual simplex step of a cutting-plane method and
//! knows nothing of curvature; a sphere costs it fifty support points. Here every
//! support point seen near the best direction so far stays in use.
//!
//! # Parts
//!
//! | file | part |
//! |---|---|
//! | `known/round.rs` | balls, discs and R: what a pair of points shows |
//! | `search.rs` | the loop: ask where the model is least, until that comes true |
//! | `object.rs` | what is known of one object: its points, and what is round of it |
//! | `learn.rs` | what a new point shows of its object |
//! | `curved.rs` | R of one object, learned from pairs of its points |
//! | `walk.rs`, `lowest.rs` | where the model of both is least, for no support point |
//! | `doubt.rs` | what is not certain there, and where to ask for it |
//! | `answer.rs` | the answer, its witness points, what is handed on |
//! | `trust_region.rs` | the trust radius, by actual and predicted reduction |
//! | `memory.rs` | what one search leaves behind for the next |
//!
//! # The model
//!
//! h is the sum of the two objects' support functions, and each of these is at least the maximum
//! over the points of its object seen so far: its *cuts*. So k support points of D are k² cuts, and
//! an edge across an edge is known from two samples. What is round is taken off the points:
//!
//! - A *ball* or a *disc* leaves exact cuts. Most round objects are a polytope and one of these.
//! - Of *anything else that is smooth* the second derivative R of the support function is learned.
//!   In the chart b + E x of a direction b a point p seen along n, at y in the chart, has with
//!   G = E'R E the cut p·b + ½ y'Gy + (E'p − G y)·x + ½ x'Gx: exact at y, elsewhere to second
//!   order. A smooth object is one such cut: of the points of one piece the nearest to b is kept.
//!   R is each object's own; pairs of D tell which points are of one smooth piece, since there what
//!   the excesses of both objects differ by is small (`search.rs`).
//!
//! Where objects show a kink in place of a piece, a vertex seen twice, or a value below a cut, what
//! was believed round is not: a refuted ball or disc is no more than a curvature, a refuted R
//! nothing, and points as they are remain: exact cuts, which hold of any convex object.
//!
//! # The end
//!
//! *Of exact cuts*: a model whose least value comes true at its minimum is a proof of a local
//! minimum, for the support function is convex, and nowhere below its cuts. *Of R*: the best
//! direction must be as deep as the model's minimum within the tolerance, with R measured in two
//! directions. A ball, disc or R that an active point rests on must have been seen from two
//! directions, or lift the cut by a hair only: else the next support point is asked beside, towards
//! that point (`doubt.rs`).
//!
//! *Witness points* are means of the active points, moved along a ball or disc to the answer's
//! direction, behind all planes seen. R moves none: what it leads to may lie beside the body. Where
//! they do not meet within the tolerance, the model's minimum itself is asked.
//!
//! *Level ground*: minima that form a curve or a surface are told by a model that is level over the
//! whole first trust region.
//!
//! *Bounds*: after [`search::MOST`] support points, the caller's cap, or four that were asked for what
//! they tell, the lowest direction met is returned, for the caller to go on from:
//! by this search as long as it gets lower, and then by the paper's method.
//!
//! # Memory
//!
//! A face that is still there is found again by three directions aside of
//! the last answer, each towards one active cut and farther than the pair moved, two edges by two
//! directions, and both proven by one more: without this search, where nothing round bends them by more than
//! the tolerance (`hull/face.rs`); what has been asked there in vain it begins with. A smooth contact is
//! found by the last direction and one step with R. The radii of balls stay; a disc's axis turns with its object, and a disc that has turned is
//! found anew. What no longer fits is forgotten where the model is above a
//! sample.
//!
//! # Constants
//!
//! Each stands beside its use, with its reason. Where that is "measured: ×2 …, ÷2 …", it is
//! what twice and half of it cost: support points in the mean and in the worst row of a table
//! of the pair sets from 5°, 25°, 45° beside the minimum, cold, and in motion with memory, of
//! recorded contacts, and of hulls of meshes from 10° and cold; and how many of the 2,600
//! answers that are no global minimum become more or fewer (a dozen is chance). Those of
//! `trust_region.rs`, and those that `curved.rs`, `object.rs` and `learn.rs` have from there, were
//! measured on the search before this one.
//!
//! *Left out*: a second search with one R for D as a whole (as many support points on ellipsoids, a
//! third fewer instructions there, 1,900 lines); starts beside a place where the search stalled
//! (nothing: within 0.01 support points on all sets); witness points that R moves (5 % fewer support
//! points on shallow ellipsoids, a fifth fewer on them in motion, 120 lines, depths there forty times less
//! exact, and four of the seven known points of the campaign that lie outside of their bodies).

mod answer;
mod curved;
mod doubt;
mod learn;
mod lowest;
mod memory;
mod object;
mod search;
mod trust_region;
mod walk;

pub use memory::Memory;

use crate::contact::{Penetration, Settings};
use crate::known::points::Points;
use crate::known::support_set::Stop;
use crate::math::Vec3;
use crate::minkowski::support::{Known, MinkowskiDifference, SupportMap};
use search::Search;

/// A local minimum of the depth near the remembered direction, else near the unit
/// vector that `start` gives.
///
/// Writes a `hit`, whose overlap is not proven; `true`: at a local minimum to within the
/// tolerance, `false`: at the lowest direction met. `inner`: any inner point of D; how far the
/// support points lie from it is what curvature is first guessed from. `known`: gains support
/// points for the proof, the active ones or else the best one first. `seen`: what was asked already, to
/// begin with.
///
/// # Errors
/// [`Stop::Apart`]; [`Stop::Fault`], where a support mapping answers no number.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    inner: Option<&Vec3>,
    start: impl Fn() -> Vec3,
    memory: &mut Memory,
    (seen, settings): (Option<&Points>, &Settings),
    (known, hit): (&mut Known, &mut Penetration),
) -> Result<bool, Stop> {
    let mut search = Search::default();
    let queue = match seen {
        None => search.recall(memory, &start),
        Some(_) => [None; 3],
    };
    let centre = inner.copied().unwrap_or_default();
    let found = search.run(md, &centre, (seen, queue), settings, known, hit)?;
    if found {
        search.leave(&hit.dir, memory);
    } else {
        *hit = search.lowest_met(known);
        *memory = Memory::towards(hit.dir);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{EPSILON, perpendicular};
    use crate::paper::incremental;
    use crate::paper::portal::Until;
    use crate::shapes::Random;
    use nalgebra::Rotation3;

    /// A support function, placed.
    type Shape = Box<dyn Fn(&Vec3) -> Vec3>;

    fn at(c: Vec3, f: impl Fn(&Vec3) -> Vec3 + 'static) -> Shape {
        Box::new(move |d| c + f(d))
    }

    fn at_turned(c: Vec3, turn: Rotation3<f64>, f: impl Fn(&Vec3) -> Vec3 + 'static) -> Shape {
        Box::new(move |d| c + turn * f(&(turn.inverse() * d)))
    }

    fn ball(c: Vec3, r: f64) -> Shape {
        at(c, move |d| d * r)
    }

    fn block(c: Vec3, half: Vec3) -> Shape {
        at(c, move |d| {
            Vec3::new(
                half.x.copysign(d.x),
                half.y.copysign(d.y),
                half.z.copysign(d.z),
            )
        })
    }

    fn capsule(c: Vec3, r: f64, half: f64) -> Shape {
        at(c, move |d| d * r + Vec3::z() * half.copysign(d.z))
    }

    fn cylinder(c: Vec3, r: f64, half: f64) -> Shape {
        at(c, move |d| {
            let t = (d.x * d.x + d.y * d.y).sqrt();
            let f = if t > 0.0 { r / t } else { 0.0 };
            Vec3::new(d.x * f, d.y * f, half.copysign(d.z))
        })
    }

    fn ellipsoid(c: Vec3, r: Vec3) -> Shape {
        at(c, move |d| {
            let w = r.component_mul(&r.component_mul(d));
            w / w.dot(d).sqrt()
        })
    }

    fn hull(points: Vec<Vec3>) -> Shape {
        Box::new(move |d| {
            points
                .iter()
                .copied()
                .max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)))
                .unwrap_or_default()
        })
    }

    fn icosahedron() -> Vec<Vec3> {
        let g = 0.5 * (1.0 + (5.0 as f64).sqrt());
        let mut points = Vec::new();
        for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
            points.push(Vec3::new(0.0, a, b).normalize());
            points.push(Vec3::new(a, b, 0.0).normalize());
            points.push(Vec3::new(b, 0.0, a).normalize());
        }
        points
    }

    const TOLERANCE: f64 = if EPSILON > 1e-10 { 1e-5 } else { 1e-8 };

    fn settings(tolerance: f64) -> Settings {
        Settings {
            tolerance,
            max_iterations: 500,
        }
    }

    fn solve(
        a: &Shape,
        b: &Shape,
        start: Vec3,
        memory: &mut Memory,
        tolerance: f64,
    ) -> (Result<Penetration, Stop>, u64) {
        let md = MinkowskiDifference::new(a, b);
        let mut known = Known::default();
        let mut hit = Penetration::default();
        let found = penetration(
            &md,
            None,
            || start.normalize(),
            memory,
            (None, &settings(tolerance)),
            (&mut known, &mut hit),
        );
        let answer = match found {
            Ok(true) => Ok(hit),
            // What every caller does with a search that did not end in a minimum.
            Ok(false) => {
                let until = Until::Shortcut;
                let rest = settings(tolerance);
                incremental::penetration(&md, hit.normal, None, until, &rest, |_| ())
            }
            Err(stop) => Err(stop),
        };
        (answer, md.supports())
    }

    fn hit(a: &Shape, b: &Shape, start: Vec3, tolerance: f64) -> Penetration {
        match solve(a, b, start, &mut Memory::default(), tolerance) {
            (Ok(p), supports) if !p.limit => {
                assert!(supports < 100, "{supports} support points");
                p
            }
            (other, supports) => panic!("{other:?} after {supports}"),
        }
    }

    fn h(a: &Shape, b: &Shape, n: &Vec3) -> f64 {
        n.dot(&(a(n) - b(&-n)))
    }

    /// Sound, witnessed, and nothing lower nearby: an answer must hold all of this.
    fn check(a: &Shape, b: &Shape, p: &Penetration, tolerance: f64, size: f64) {
        let slack = 64.0 * EPSILON * size;
        assert!((p.dir.norm() - 1.0).abs() < 8.0 * EPSILON);
        assert!((h(a, b, &p.dir) - p.depth).abs() <= slack);
        let difference = p.point1 - p.point2;
        // Where a touch meets is for the proof of the overlap to say.
        assert!(
            p.depth <= slack
                || (difference - p.dir * p.depth).norm()
                    <= (2.0 * p.depth * tolerance).sqrt() + tolerance + slack
        );
        for (point, reach) in [
            (p.point1, a(&p.dir).dot(&p.dir)),
            (p.point2, b(&-p.dir).dot(&p.dir)),
        ] {
            assert!((point.dot(&p.dir) - reach).abs() <= tolerance + slack);
        }
        let e1 = perpendicular(&p.dir);
        let e2 = p.dir.cross(&e1);
        for k in 0..16 {
            let (s, c) = (k as f64 * 0.39).sin_cos();
            for step in [1e-3, 1e-2] {
                let n = (p.dir + (e1 * c + e2 * s) * step).normalize();
                let there = h(a, b, &n);
                assert!(
                    there >= p.depth - 4.0 * tolerance - slack,
                    "{} lower at {step} rad",
                    p.depth - there
                );
            }
        }
    }

    /// Half discs, tilted to each other: round on one side of each, and a corner is a minimum. The witness
    /// points are theirs.
    #[test]
    fn half_discs() {
        let mut r = Random::new(12);
        let half_disc = |r: &mut Random, at: Vec3| {
            let (turn, radius) = (r.rotation(), r.within(0.5, 1.0));
            let shape: Shape = at_turned(at, turn, move |d| {
                let arc = Vec3::new(d.x, d.y, 0.0) * (radius / d.x.hypot(d.y));
                let end = Vec3::x() * radius.copysign(d.x);
                if d.y > 0.0 { arc } else { end }
            });
            let outside = move |p: &Vec3| {
                let p = turn.inverse() * (p - at);
                p.z.abs().max(-p.y).max(p.x.hypot(p.y) - radius)
            };
            (shape, outside)
        };
        for round in 0..3000 {
            let tolerance = if round % 2 == 0 { TOLERANCE } else { 1e-4 };
            let at = r.vector(0.4);
            let (a, outside1) = half_disc(&mut r, Vec3::zeros());
            let (b, outside2) = half_disc(&mut r, at);
            let start = r.direction();
            let (found, _) = solve(&a, &b, start, &mut Memory::default(), tolerance);
            if let Some(p) = found.ok().filter(|p| !p.limit) {
                check(&a, &b, &p, tolerance, 2.0);
                let out = outside1(&p.point1).max(outside2(&p.point2));
                assert!(out < tolerance + 64.0 * EPSILON, "round {round}: {out}");
            }
        }
    }

    /// Teardrops that nearly coincide: level ground, that falls all the same.
    #[test]
    fn level_ground_that_falls_is_no_minimum() {
        let mut r = Random::new(13);
        let tolerance = 10.0 * TOLERANCE;
        for round in 0..1000 {
            let (radius, tip) = (r.within(0.1, 0.3), Vec3::z() * r.within(0.4, 0.5));
            let teardrop = move |d: &Vec3| {
                if tip.dot(d) > radius { tip } else { d * radius }
            };
            let a = at_turned(Vec3::zeros(), r.rotation(), teardrop);
            let at = r.vector(1e4 * tolerance);
            let b = at_turned(at, r.rotation(), teardrop);
            let start = r.direction();
            let (found, _) = solve(&a, &b, start, &mut Memory::default(), tolerance);
            if let Some(p) = found.ok().filter(|p| !p.limit) {
                let e1 = perpendicular(&p.dir);
                let e2 = p.dir.cross(&e1);
                for k in 0..32 {
                    let (s, c) = (k as f64 * 0.197).sin_cos();
                    let there = h(&a, &b, &(p.dir + (e1 * c + e2 * s) * 0.02).normalize());
                    let lower = p.depth - there;
                    assert!(lower < 4.0 * tolerance, "round {round}: {lower}");
                }
            }
        }
    }

    #[test]
    fn a_stationary_start_is_not_an_answer() {
        // A ball on a capsule's axis: 1.3 along it is a maximum.
        let a = capsule(Vec3::zeros(), 0.5, 0.5);
        let b = ball(Vec3::z() * 0.2, 0.5);
        let p = hit(&a, &b, Vec3::z(), TOLERANCE);
        assert!((p.depth - 1.0).abs() < 2.0 * TOLERANCE, "{}", p.depth);
        check(&a, &b, &p, TOLERANCE, 3.0);
        // Icosahedra along a vertex: a maximum of the distance.
        let points = icosahedron();
        let start = points[0];
        let a = hull(points.clone());
        let b = hull(points);
        let p = hit(&a, &b, start, TOLERANCE);
        check(&a, &b, &p, TOLERANCE, 3.0);
        assert!(p.depth < 1.9);
    }

    #[test]
    fn balls_and_boxes_are_exact() {
        let c = Vec3::new(0.3, 0.2, 0.1);
        let (a, b) = (ball(Vec3::zeros(), 1.0), ball(c, 1.0));
        let p = hit(&a, &b, Vec3::new(1.0, 0.4, -0.3), TOLERANCE);
        assert!((p.depth - (2.0 - c.norm())).abs() < TOLERANCE);
        check(&a, &b, &p, TOLERANCE, 3.0);
        let (a, b) = (
            block(Vec3::zeros(), Vec3::repeat(1.0)),
            block(Vec3::new(0.1, 0.2, 1.9), Vec3::repeat(1.0)),
        );
        let p = hit(&a, &b, Vec3::new(0.1, -0.2, 1.0), TOLERANCE);
        assert!((p.depth - 0.1).abs() < 16.0 * EPSILON, "{}", p.depth);
        assert!((p.dir - Vec3::z()).norm() < 16.0 * EPSILON);
        check(&a, &b, &p, TOLERANCE, 3.0);
    }

    #[test]
    fn coincident_centres_end() {
        let unit_box = || block(Vec3::zeros(), Vec3::new(0.5, 0.4, 0.3));
        let pairs: [(Shape, Shape); 5] = [
            (ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.1)),
            (unit_box(), unit_box()),
            (
                capsule(Vec3::zeros(), 0.5, 0.5),
                capsule(Vec3::zeros(), 0.2, 0.7),
            ),
            (
                cylinder(Vec3::zeros(), 0.5, 0.5),
                cylinder(Vec3::zeros(), 0.5, 0.5),
            ),
            (
                ellipsoid(Vec3::zeros(), Vec3::new(0.5, 0.35, 0.25)),
                ellipsoid(Vec3::zeros(), Vec3::new(0.5, 0.35, 0.25)),
            ),
        ];
        for (i, (a, b)) in pairs.iter().enumerate() {
            for start in [
                Vec3::x(),
                Vec3::z(),
                Vec3::new(0.3, -0.8, 0.5),
                Vec3::new(1.0, 1.0, 1.0),
            ] {
                let p = hit(a, b, start, TOLERANCE);
                assert!(p.depth > 0.0, "{i}");
                check(a, b, &p, TOLERANCE, 2.0);
            }
        }
    }

    #[test]
    fn flat_and_thin_shapes_end() {
        // Beyond that the rounding errors of single precision are as large as the rest.
        let long = if EPSILON > 1e-10 { 1e3 } else { 1e6 };
        let flat: Vec<Shape> = vec![
            block(Vec3::zeros(), Vec3::new(0.5, 0.5, 0.0)),
            block(Vec3::zeros(), Vec3::new(0.5, 0.0, 0.0)),
            block(Vec3::zeros(), Vec3::zeros()),
            cylinder(Vec3::zeros(), 0.5, 0.0),
            block(Vec3::zeros(), Vec3::new(1.0, 1e-6, 1.0)),
            block(Vec3::zeros(), Vec3::new(long, 1.0, 1.0)),
            ellipsoid(Vec3::zeros(), Vec3::new(1.0, 0.05, 0.05)),
        ];
        for (i, a) in flat.iter().enumerate() {
            for (j, b) in flat.iter().enumerate() {
                for start in [
                    Vec3::z(),
                    Vec3::new(0.1, 0.2, 0.9),
                    Vec3::new(-0.7, 0.3, 0.5),
                ] {
                    let size = if i == 5 || j == 5 { 2.0 * long } else { 2.0 };
                    match solve(a, b, start, &mut Memory::default(), TOLERANCE) {
                        (Ok(p), _) if !p.limit => check(a, b, &p, TOLERANCE, size),
                        // In single precision the curvature of a needle is rounding:
                        // the search may stop at the minimum without knowing it.
                        (Ok(p), _) if EPSILON > 1e-10 => check(a, b, &p, TOLERANCE, size),
                        (Err(Stop::Apart(n)), _) => assert!(h(a, b, &n) < 0.0),
                        (other, supports) => panic!("{i} {j} {start:?} {other:?} after {supports}"),
                    }
                }
            }
        }
    }

    #[test]
    fn any_scale_place_and_tolerance() {
        for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for far in [0.0, 1e3] {
                for fine in [0.0, 1e-12, 1e-6] {
                    let o = Vec3::new(1.0, -0.7, 0.4) * (far * scale);
                    let c = |x, y, z| o + Vec3::new(x, y, z) * scale;
                    let pairs: [(Shape, Shape); 5] = [
                        (ball(o, scale), ball(c(0.9, 0.4, 0.2), 0.5 * scale)),
                        (
                            block(o, Vec3::new(0.5, 0.4, 0.3) * scale),
                            block(c(0.4, 0.2, 0.3), Vec3::repeat(0.3 * scale)),
                        ),
                        (
                            capsule(o, 0.5 * scale, 0.5 * scale),
                            ellipsoid(c(0.5, 0.3, 0.4), Vec3::new(0.5, 0.35, 0.25) * scale),
                        ),
                        (
                            cylinder(o, 0.5 * scale, 0.5 * scale),
                            block(c(0.7, 0.3, 0.4), Vec3::new(0.5, 0.4, 0.3) * scale),
                        ),
                        (
                            cylinder(o, 0.5 * scale, 0.5 * scale),
                            capsule(c(0.6, 0.2, 0.4), 0.2 * scale, 0.3 * scale),
                        ),
                    ];
                    for (i, (a, b)) in pairs.iter().enumerate() {
                        let tolerance = fine * scale;
                        let size = scale * (1.0 + far);
                        match solve(
                            a,
                            b,
                            Vec3::new(0.8, 0.4, 0.3),
                            &mut Memory::default(),
                            tolerance,
                        ) {
                            (Ok(p), supports) if !p.limit => {
                                assert!(supports < 100, "{i} {scale} {far} {fine}: {supports}");
                                check(a, b, &p, tolerance.max(64.0 * EPSILON * size), size);
                            }
                            other => panic!("{i} {scale} {far} {fine}: {other:?}"),
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn apart_is_seen_and_touching_is_free() {
        let a = ball(Vec3::zeros(), 1.0);
        let b = block(Vec3::new(1.7, 0.1, 0.2), Vec3::repeat(0.5));
        match solve(
            &a,
            &b,
            Vec3::new(0.2, 1.0, 0.1),
            &mut Memory::default(),
            TOLERANCE,
        ) {
            (Err(Stop::Apart(n)), supports) => {
                assert!(h(&a, &b, &n) < 0.0);
                assert!(supports < 20);
            }
            other => panic!("{other:?}"),
        }
        for (a, b) in [
            (ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 2.0, 1.0)),
            (
                block(Vec3::zeros(), Vec3::repeat(1.0)),
                block(Vec3::x() * 2.0, Vec3::repeat(1.0)),
            ),
        ] {
            match solve(
                &a,
                &b,
                Vec3::new(1.0, 0.1, 0.1),
                &mut Memory::default(),
                TOLERANCE,
            ) {
                (Ok(p), _) if !p.limit => assert!(p.depth <= TOLERANCE, "{}", p.depth),
                (Err(Stop::Apart(n)), _) => assert!(h(&a, &b, &n) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn any_memory_is_harmless() {
        // Bits of a linear congruential generator, and of another pair.
        let mut bits: u64 = 1;
        let mut next = || {
            bits = bits
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            bits
        };
        let a = cylinder(Vec3::zeros(), 0.5, 0.5);
        let b = block(Vec3::new(0.6, 0.3, 0.4), Vec3::new(0.5, 0.4, 0.3));
        for round in 0..2000 {
            let mut real = || {
                if round % 2 == 0 {
                    f64::from_bits(next() as _)
                } else {
                    (next() >> 40) as f64 / (1 << 23) as f64 - 1.0
                }
            };
            let mut v = || Vec3::new(real(), real(), real());
            let mut memory = Memory {
                dir: v(),
                slopes: [v(), v(), v()],
                ..Memory::default()
            };
            memory.curvature = [(); 6].map(|_| real());
            memory.drift = real();
            memory.count = (round % 5) as u32;
            memory.curved = (round % 3) as u32;
            match solve(&a, &b, Vec3::x(), &mut memory, TOLERANCE) {
                (Ok(p), _) if !p.limit => check(&a, &b, &p, TOLERANCE, 2.0),
                (other, supports) => panic!("{round}: {other:?} after {supports}"),
            }
        }
    }

    #[test]
    fn curvature_of_an_object_of_any_other_size_is_harmless() {
        let a = cylinder(Vec3::zeros(), 0.5, 0.5);
        let b = ellipsoid(Vec3::new(0.6, 0.3, 0.4), Vec3::new(0.5, 0.35, 0.25));
        // Balls, discs and R of one object or both.
        for curved in [1, 2, 3, 5, 10, 15] {
            for power in -12..13 {
                let r = (10.0 as f64).powi(3 * power);
                let mut memory = Memory {
                    dir: Vec3::new(0.8, 0.4, 0.5),
                    slopes: [Vec3::new(r, 0.0, 0.0), Vec3::new(r, 0.0, r), Vec3::zeros()],
                    curvature: [r, 0.1 * r, 0.0, r, 0.0, r],
                    curved,
                    ..Memory::default()
                };
                match solve(&a, &b, Vec3::x(), &mut memory, TOLERANCE) {
                    (Ok(p), supports) if !p.limit => {
                        check(&a, &b, &p, TOLERANCE, 2.0);
                        let at = format!("{curved} {power}: {supports} support points");
                        assert!(supports <= 40, "{at}");
                    }
                    (other, supports) => panic!("{curved} {power}: {other:?} after {supports}"),
                }
            }
        }
    }

    #[test]
    fn a_contact_that_stays_is_found_again_cheaply() {
        let still = |a: &Shape, b: &Shape, most: u64| {
            let mut memory = Memory::default();
            let mut last = 0;
            for _ in 0..4 {
                last = solve(a, b, Vec3::new(0.2, 0.1, 1.0), &mut memory, 1e-6).1;
            }
            assert!(last <= most, "{last} support points");
        };
        still(
            &block(Vec3::zeros(), Vec3::new(0.5, 0.4, 0.3)),
            &hull(
                icosahedron()
                    .iter()
                    .map(|p| p * 0.5 + Vec3::new(0.03, 0.02, 0.7))
                    .collect(),
            ),
            if EPSILON > 1e-10 { 6 } else { 4 },
        );
        // A cylinder on its rim, on its side, and upright, smaller and larger than the face.
        for up in [Vec3::new(0.3, 0.1, 1.0), Vec3::x(), Vec3::z()] {
            for radius in [0.2, 0.9] {
                let half = Vec3::new(0.6, 0.5, 0.3);
                let turn = Rotation3::rotation_between(&Vec3::z(), &up).unwrap_or_default();
                let shape = cylinder(Vec3::zeros(), radius, 0.5);
                let turned = move |d: &Vec3| turn * shape(&(turn.inverse() * d));
                let lowest = turned(&-Vec3::z()).z;
                let stands = at(Vec3::new(0.03, 0.02, 0.25 - lowest), turned);
                let most = if EPSILON > 1e-10 { 12 } else { 4 };
                still(&block(Vec3::zeros(), half), &stands, most);
            }
        }
        still(
            &ball(Vec3::zeros(), 0.5),
            &ball(Vec3::new(0.1, 0.2, 0.8), 0.5),
            2,
        );
    }

    /// A cylinder that rolls on its rim: the disc is found again where its axis has turned.
    #[test]
    #[cfg(not(feature = "single"))] // A disc is not told there: the rim rolls too little.
    fn a_rim_that_rolls_is_found_again_cheaply() {
        let floor = block(Vec3::zeros(), Vec3::new(2.0, 2.0, 0.5));
        let mut memory = Memory::default();
        let (mut supports, mut discs) = (0, 0);
        for frame in 0..50 {
            let (sin, cos) = (0.01 * frame as f64).sin_cos();
            let axis = Vec3::new(0.5 * cos, 0.5 * sin, 0.8).normalize();
            let turn = Rotation3::rotation_between(&Vec3::z(), &axis).unwrap_or_default();
            let shape = cylinder(Vec3::zeros(), 0.2, 0.3);
            let turned = move |d: &Vec3| turn * shape(&(turn.inverse() * d));
            let lowest = turned(&-Vec3::z()).z;
            let place = Vec3::new(0.3, 0.2, 0.49 - lowest);
            let rolls = at(place, turned);
            let (answer, count) = solve(&rolls, &floor, -Vec3::z(), &mut memory, 1e-6);
            let Ok(hit) = answer else {
                panic!("{answer:?}");
            };
            assert!((hit.depth - 0.01).abs() <= 1e-6, "{}", hit.depth);
            if frame > 1 {
                supports += count;
                discs += u32::from(matches!(memory.curved, 2 | 8));
            }
        }
        assert!(discs == 48 && supports <= 48 * 4, "{discs} {supports}");
    }
}
