// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! DEEP, the baseline of the paper's Section IV-B: Y. J. Kim, M. C. Lin, D. Manocha, "Incremental penetration depth estimation
//! between convex polytopes using dual-space expansion", IEEE TVCG 10, 2004. The penetration depth of two convex polytopes
//! with known adjacency, by a walk on the surface of their Minkowski difference D.
//!
//! 1. *Hub pair*: a vertex a of the first polytope and b of the second whose regions of the Gauss map, that of b reversed,
//!    overlap; a − b is then a vertex of D. The first pair are the vertices farthest along the guess.
//! 2. *Local Gauss map*: both regions, whose corners are the normals of the faces at the vertex, are projected from the center
//!    of the sphere to the plane that touches it at a common direction.
//! 3. The corners of the two polygons' intersection ([`polygon`](super::polygon)) are the normals n of the faces of D around
//!    a − b, and n · (a − b) their distances from the origin.
//! 4. The walk goes on to the hub pairs of the closest of these faces, until none of them has a closer one: a local minimum.
//!
//! Departure: the first pair is found by climbing over edges from the last one. Corners must be less than 90° from a common
//! direction of the regions, as those of icospheres are.

use nalgebra::{Matrix3, Vector3};

use super::polygon;
use super::poses::{Mesh, Poses};
use crate::measuring::methods::{Answer, Method, Start};
use crate::measuring::scene::Pair;

type V = Vector3<f64>;

/// A vertex with its neighbours and the outward unit normals of its faces, both counterclockwise around it.
struct Corner {
    at: V,
    neighbours: Vec<usize>,
    normals: Vec<V>,
}

/// A polytope with adjacency.
pub struct Polytope(Vec<Corner>);

impl Polytope {
    /// Makes a polytope from a closed, convex triangle mesh whose faces are counterclockwise from outside.
    pub fn new(mesh: &Mesh) -> Self {
        let mut fans = vec![Vec::new(); mesh.vertices.len()];
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.vertices[i]);
            let n = (b - a).cross(&(c - a)).normalize();
            for k in 0..3 {
                fans[t[k]].push((t[(k + 1) % 3], t[(k + 2) % 3], n));
            }
        }
        let corner = |(at, fan): (&V, Vec<(usize, usize, V)>)| {
            let (mut neighbours, mut normals, mut edge) = (Vec::new(), Vec::new(), fan[0].0);
            for _ in 0..fan.len() {
                let (p, q, n) = *fan.iter().find(|f| f.0 == edge).expect("a closed mesh");
                neighbours.push(p);
                normals.push(n);
                edge = q;
            }
            Corner { at: *at, neighbours, normals }
        };
        Self(mesh.vertices.iter().zip(fans).map(corner).collect())
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

/// A face of D: its distance from the origin and its unit normal.
type Face = (f64, V);

/// Two polytopes, a point x of the second at `turn * x + shift` in the frame of the first, and room for polygons.
struct Walk<'a> {
    a: &'a Polytope,
    b: &'a Polytope,
    turn: Matrix3<f64>,
    shift: V,
    room: &'a mut [Vec<[f64; 2]>; 3],
}

impl Walk<'_> {
    /// Returns the closest face around a hub pair, both of whose regions have the direction `u`; none if they do not overlap.
    fn closest_face(&mut self, hub: (usize, usize), u: V) -> Option<Face> {
        let (a, b) = (&self.a.0[hub.0], &self.b.0[hub.1]);
        let e1 = u.cross(&V::ith(u.iamin(), 1.0)).normalize();
        let e2 = u.cross(&e1);
        let project = |n: V| {
            let along = n.dot(&u);
            [n.dot(&e1) / along, n.dot(&e2) / along]
        };
        let [first, second, both] = self.room;
        first.clear();
        first.extend(a.normals.iter().map(|n| project(*n)));
        second.clear();
        // Reversal turns the order of corners around.
        second.extend(b.normals.iter().rev().map(|n| project(-(self.turn * n))));
        polygon::intersection(first, second, both);
        let v = a.at - (self.turn * b.at + self.shift);
        let faces = both.iter().map(|p| (u + e1 * p[0] + e2 * p[1]).normalize()).map(|n| (n.dot(&v), n));
        faces.min_by(|x, y| x.0.total_cmp(&y.0))
    }

    /// Returns depth and the unit direction in which the second polytope moves.
    fn penetration(&mut self, start: V, hub: &mut (usize, usize)) -> Option<Face> {
        let back = self.turn.transpose();
        let (a, b) = (self.a, self.b);
        *hub = (a.extremal(&start, hub.0), b.extremal(&(back * -start), hub.1));
        let mut best = self.closest_face(*hub, start)?;
        // The distance falls at every step, and faces are finite.
        loop {
            let (from, (depth, n)) = (*hub, best);
            let in_b = b.face(from.1, back * -n);
            for hubs in a.face(from.0, n).flat_map(|i| in_b.clone().map(move |j| (i, j))) {
                if hubs == from {
                    continue;
                }
                if let Some(face) = self.closest_face(hubs, n).filter(|face| face.0 < best.0 - SLACK * 1e-3) {
                    (best, *hub) = (face, hubs);
                }
            }
            // Also where it is NaN.
            if best.0.partial_cmp(&depth) != Some(std::cmp::Ordering::Less) {
                return Some(best);
            }
        }
    }
}

/// Returns DEEP from a guess, for poses of two polytopes.
pub fn method<'a>(poses: &'a Poses, [a, b]: [&'a Polytope; 2], start: Start) -> Method<'a> {
    let mut hub = (0, 0);
    let mut room = [const { Vec::new() }; 3];
    let query = move |pair: &Pair| {
        let guess = start.guess(&pair.truth).unwrap_or(pair.truth.cold);
        let [one, two] = &poses.placed[pair.motion];
        let (back, room) = (one.turn.transpose(), &mut room);
        let mut walk = Walk { a, b, turn: back * two.turn, shift: back * (two.at - one.at), room };
        let (depth, n) = walk.penetration(back * V::from(guess), &mut hub)?;
        Some(Answer { depth, dir: (one.turn * n).into() })
    };
    Method::new("DEEP", start, None, Box::new(query))
}
