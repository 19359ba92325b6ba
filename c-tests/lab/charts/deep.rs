// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! DEEP: the penetration depth of two convex polytopes with known adjacency, by a walk on the
//! surface of their Minkowski difference (Y. J. Kim, M. C. Lin, D. Manocha, "Incremental penetration
//! depth estimation between convex polytopes using dual-space expansion", IEEE TVCG 2004). The
//! baseline of W. Gao's paper (2023), Section IV.
//!
//! A vertex hub pair is a vertex a of the first polytope and b of the second whose normal cones, that of b reversed,
//! overlap; a − b is then a vertex of the Minkowski difference D. The corners of the overlap are the normals n of the faces
//! of D around that vertex, and n·(a − b) their distances from the origin. DEEP moves to the hubs of the closest of these
//! faces until none of them has a closer one: a local minimum.
//!
//! Departure: cones are clipped with the planes n·(b' − b) ≥ 0, not projected to a plane.

use std::cell::Cell;

use ccd::{Settings, Want, Warm};
use nalgebra::{Matrix3, Vector3};

use crate::measuring::libraries::Libraries;
use crate::measuring::methods::{Answer, Method, Start};
use crate::measuring::scene::{Pair, Scene};

type V = Vector3<f64>;

/// A vertex with its neighbours and the outward unit normals of its faces, both in order around it.
struct Corner {
    at: V,
    neighbours: Vec<usize>,
    normals: Vec<V>,
}

/// A polytope with adjacency.
pub struct Polytope(Vec<Corner>);

impl Polytope {
    /// Makes a polytope from a closed, convex triangle mesh around its origin.
    fn new(vertices: &[V], triangles: &[[usize; 3]]) -> Self {
        let corner = |(v, at): (usize, &V)| {
            // The fan of triangles around v, in the order of shared edges.
            let around = triangles.iter().filter_map(|t| {
                let k = t.iter().position(|&i| i == v)?;
                let [p, q] = [t[(k + 1) % 3], t[(k + 2) % 3]];
                let n = (vertices[p] - at).cross(&(vertices[q] - at)).normalize();
                Some((p, q, n * n.dot(at).signum()))
            });
            let mut fan: Vec<(usize, usize, V)> = around.collect();
            let (mut neighbours, mut normals, mut edge) = (Vec::new(), Vec::new(), fan[0].0);
            while let Some(k) = fan.iter().position(|f| f.0 == edge || f.1 == edge) {
                let (p, q, n) = fan.swap_remove(k);
                neighbours.push(edge);
                normals.push(n);
                edge = if p == edge { q } else { p };
            }
            Corner { at: *at, neighbours, normals }
        };
        Self(vertices.iter().enumerate().map(corner).collect())
    }

    /// Reads the two polytopes of a pair set (c-tests/bench/pairs/README.md); none if one has no triangles.
    pub fn of_set(name: &str) -> Option<[Self; 2]> {
        let bytes = std::fs::read(Scene::file(name)).ok()?;
        let mut rest = bytes.get(16..)?; // behind the magic and two counts
        let mut take = |n: usize| rest.split_at_checked(n).map(|(taken, behind)| (rest = behind, taken).1);
        let real = |b: &[u8]| b.try_into().map_or(f64::NAN, f64::from_le_bytes);
        let index = |b: &[u8]| b.try_into().map_or(0, u32::from_le_bytes) as usize;
        let mut shape = || {
            let head = take(40)?;
            let vertices = take(24 * index(&head[4..8]))?.chunks_exact(24);
            let vertices: Vec<V> = vertices.map(|b| V::from_iterator(b.chunks_exact(8).map(real))).collect();
            let triangles = take(12 * index(&head[8..12]))?.chunks_exact(12);
            let triangles: Vec<_> = triangles.map(|b| [0, 4, 8].map(|at| index(&b[at..at + 4]))).collect();
            (!triangles.is_empty()).then(|| Self::new(&vertices, &triangles))
        };
        Some([shape()?, shape()?])
    }

    /// Returns the vertex farthest along `dir`, climbing from `from`.
    fn extremal(&self, dir: &V, from: usize) -> usize {
        let (mut best, mut value) = (from, self.0[from].at.dot(dir));
        loop {
            let here = best;
            for &i in &self.0[here].neighbours {
                let x = self.0[i].at.dot(dir);
                if x > value {
                    (best, value) = (i, x);
                }
            }
            if best == here {
                return best;
            }
        }
    }

    /// Returns the vertices of the face with normal `n` at a vertex: those that tie with it.
    fn face(&self, at: usize, n: V) -> impl Iterator<Item = usize> + Clone {
        let corner = &self.0[at];
        let is_tied = move |&i: &usize| n.dot(&(self.0[i].at - corner.at)) >= -SLACK;
        std::iter::once(at).chain(corner.neighbours.iter().copied().filter(is_tied))
    }
}

/// Distances that differ by less are equal, metres: the polytopes have a diameter of 1.
const SLACK: f64 = 1e-10;

/// Two polytopes; a point x of the second is at `turn * x + shift` in the frame of the first.
struct Placed<'a>(&'a Polytope, &'a Polytope, Matrix3<f64>, V);

/// Returns depth and the unit direction in which the second polytope moves, in the frame of the first; none if the
/// vertices farthest along `start` have no common normal.
fn penetration(placed: &Placed, start: V, hub: &mut (usize, usize)) -> Option<(f64, V)> {
    let Placed(a, b, turn, _) = *placed;
    *hub = (a.extremal(&start, hub.0), b.extremal(&(turn.transpose() * -start), hub.1));
    let mut best = closest_face(placed, *hub)?;
    // The distance falls at every step, and faces are finite.
    loop {
        let (from, (depth, n)) = (*hub, best);
        let in_b = b.face(from.1, turn.transpose() * -n);
        for hubs in a.face(from.0, n).flat_map(|i| in_b.clone().map(move |j| (i, j))) {
            if let Some(face) = closest_face(placed, hubs).filter(|face| face.0 < best.0 - SLACK * 1e-3) {
                (best, *hub) = (face, hubs);
            }
        }
        // Also where it is NaN.
        if best.0.partial_cmp(&depth) != Some(std::cmp::Ordering::Less) {
            return Some(best);
        }
    }
}

/// Returns the face of D closest to the origin around a hub, from the corners of the overlap of the two normal cones.
fn closest_face(placed: &Placed, hub: (usize, usize)) -> Option<(f64, V)> {
    let Placed(a, of_b, turn, shift) = placed;
    let (a, b) = (&a.0[hub.0], &of_b.0[hub.1]);
    let (mut cone, mut clipped) = (a.normals.clone(), Vec::new());
    for &j in &b.neighbours {
        let e = turn * (of_b.0[j].at - b.at);
        clipped.clear();
        for k in 0..cone.len() {
            let (u, w) = (cone[k], cone[(k + 1) % cone.len()]);
            let (du, dw) = (u.dot(&e), w.dot(&e));
            clipped.extend((du >= 0.0).then_some(u));
            clipped.extend(((du >= 0.0) != (dw >= 0.0)).then(|| (w * du - u * dw) / (du - dw)));
        }
        std::mem::swap(&mut cone, &mut clipped);
    }
    let v = a.at - (turn * b.at + shift);
    let faces = cone.iter().map(|n| n.normalize()).map(|n| (n.dot(&v), n));
    faces.min_by(|x, y| x.0.total_cmp(&y.0))
}

/// Returns DEEP from a guess, and the local query over support functions that climb over the same edges from the last
/// vertex: both on meshes, so the support points of neither are counted.
pub fn methods<'a>(libraries: &'a Libraries, [a, b]: &'a [Polytope; 2], start: Start) -> Vec<Method<'a>> {
    let pose = |pair: &Pair| [pair.a, pair.b].map(|shape| libraries.pose(shape));
    let guess = move |pair: &Pair| start.guess(&pair.truth).unwrap_or(pair.truth.cold);
    let mut hub = (0, 0);
    let deep = move |pair: &Pair| {
        let [(ra, pa), (rb, pb)] = pose(pair);
        let placed = Placed(a, b, ra.transpose() * rb, ra.transpose() * (pb - pa));
        let (depth, n) = penetration(&placed, ra.transpose() * V::from(guess(pair)), &mut hub)?;
        Some(Answer { depth, dir: (ra * n).into() })
    };
    let settings = Settings { want: Want { pos: false, points: true }, ..Settings::new(1e-6) };
    let last = [Cell::new(0), Cell::new(0)];
    let local = move |pair: &Pair| {
        let support = |of: &'a Polytope, (turn, at): (Matrix3<f64>, V), last: &'_ Cell<usize>, dir: [f64; 3]| {
            last.set(of.extremal(&(turn.transpose() * V::from(dir)), last.get()));
            (turn * of.0[last.get()].at + at).into()
        };
        let [one, two] = pose(pair);
        let bodies = (
            (|dir: [f64; 3]| support(a, one, &last[0], dir), one.1.into()),
            (|dir: [f64; 3]| support(b, two, &last[1], dir), two.1.into()),
        );
        let mut warm = Warm::guess(guess(pair));
        let hit = ccd::penetration_local(&bodies.0, &bodies.1, &settings, Some(&mut warm));
        hit.ok()?.map(|hit| Answer { depth: hit.depth, dir: hit.dir })
    };
    vec![
        Method::new("DEEP", start, None, Box::new(deep)),
        Method::new("ccdPenetrationLocal, climbing", start, Some(1e-6), Box::new(local)),
    ]
}
