// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! DEEP: the penetration depth of two convex polytopes with known adjacency, by
//! walking on the surface of their Minkowski difference (Y. J. Kim, M. C. Lin,
//! D. Manocha, "Incremental penetration estimation between convex polytopes using
//! dual-space expansion", IEEE TVCG 2004). A baseline for the benchmark.
//!
//! A vertex hub pair is a vertex a of the first polytope and b of the second whose
//! normal cones, b's turned around, overlap; a − b is then a vertex of D. The
//! corners of the overlap are the normals n of D's faces around that vertex (a face
//! of one polytope against a vertex of the other, or an edge against an edge), and
//! n·(a − b) their distances from the origin. DEEP moves to the hubs of the nearest
//! of these faces until none of them has a nearer one: a local minimum.
//!
//! Departures: the overlap is found on the cones themselves, by clipping with the
//! planes n·(b' − b) ≥ 0, not by projecting both to a plane and intersecting convex
//! polygons (a cone has 5 or 6 sides here, so both take the same steps); extremal
//! vertices are found by climbing over the edges.

use nalgebra::{Matrix3, Vector3};

use super::scene::Mesh;

type V = Vector3<f64>;

/// A vertex's surroundings.
struct Corner {
    at: V,
    neighbours: Vec<usize>,
    /// Outward unit normals of its faces, in order around it.
    normals: Vec<V>,
}

/// A polytope with adjacency.
pub struct Polytope {
    corners: Vec<Corner>,
    size: f64,
}

impl Polytope {
    /// From a closed triangle mesh of a convex polytope around its origin.
    pub fn new(mesh: &Mesh) -> Self {
        let normal = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| mesh.vertices[i]);
            let n = (b - a).cross(&(c - a)).normalize();
            if n.dot(&a) < 0.0 { -n } else { n }
        };
        let corners = (0..mesh.vertices.len())
            .map(|v| {
                // The fan of triangles around v, walked from one shared edge to the next.
                let mut fan: Vec<(usize, usize, V)> = mesh
                    .triangles
                    .iter()
                    .filter_map(|t| {
                        let k = t.iter().position(|&i| i == v)?;
                        Some((t[(k + 1) % 3], t[(k + 2) % 3], normal(t)))
                    })
                    .collect();
                let mut neighbours = Vec::with_capacity(fan.len());
                let mut normals = Vec::with_capacity(fan.len());
                let mut edge = fan[0].0;
                while let Some(k) = fan.iter().position(|f| f.0 == edge || f.1 == edge) {
                    let (p, q, n) = fan.swap_remove(k);
                    neighbours.push(edge);
                    normals.push(n);
                    edge = if p == edge { q } else { p };
                }
                Corner {
                    at: mesh.vertices[v],
                    neighbours,
                    normals,
                }
            })
            .collect();
        let size = mesh.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max);
        Self { corners, size }
    }

    /// The vertex farthest along `dir`, climbing from `from`.
    fn extremal(&self, dir: &V, from: usize) -> usize {
        let (mut best, mut value) = (from, self.corners[from].at.dot(dir));
        loop {
            let here = best;
            for &i in &self.corners[here].neighbours {
                let x = self.corners[i].at.dot(dir);
                if x > value {
                    (best, value) = (i, x);
                }
            }
            if best == here {
                return best;
            }
        }
    }
}

/// One pair of polytopes; keeps its buffers between queries.
#[derive(Default)]
pub struct Deep {
    cone: Vec<V>,
    clipped: Vec<V>,
    hub: (usize, usize),
}

/// The second polytope in the first one's frame: x at `turn * x + shift`.
struct Placed<'a> {
    a: &'a Polytope,
    b: &'a Polytope,
    turn: Matrix3<f64>,
    shift: V,
}

impl Deep {
    /// Depth and the unit direction in which the second polytope leaves, in the
    /// first one's frame; none when the hubs of `start` have no common normal.
    pub fn penetration(
        &mut self,
        a: &Polytope,
        b: &Polytope,
        turn: Matrix3<f64>,
        shift: V,
        start: V,
    ) -> Option<(f64, V)> {
        let placed = Placed { a, b, turn, shift };
        let back = turn.transpose() * -start;
        self.hub = (
            a.extremal(&start, self.hub.0),
            b.extremal(&back, self.hub.1),
        );
        let mut best = self.nearest_face(&placed, self.hub)?;
        // A walk ends: the distance falls at every step, and faces are finite.
        loop {
            let (hub, (depth, n)) = (self.hub, best);
            // Vertices of the face: those that tie with the hub along n.
            let slack = 1e-10 * (a.size + b.size);
            let ties = |p: &Polytope, at: usize, along: V| -> Vec<usize> {
                let here = p.corners[at].at;
                let tied = |&i: &usize| along.dot(&(p.corners[i].at - here)) >= -slack;
                let near = p.corners[at].neighbours.iter().copied().filter(tied);
                std::iter::once(at).chain(near).collect()
            };
            let (in_a, in_b) = (ties(a, hub.0, n), ties(b, hub.1, turn.transpose() * -n));
            for &i in &in_a {
                for &j in &in_b {
                    if let Some(face) = self.nearest_face(&placed, (i, j))
                        && face.0 < best.0 - slack * 1e-3
                    {
                        best = face;
                        self.hub = (i, j);
                    }
                }
            }
            // Also where it is NaN.
            if best.0.partial_cmp(&depth) != Some(std::cmp::Ordering::Less) {
                return Some(best);
            }
        }
    }

    /// The face of D nearest to the origin around a hub: the corners of the overlap
    /// of the two normal cones.
    fn nearest_face(&mut self, placed: &Placed, hub: (usize, usize)) -> Option<(f64, V)> {
        let (a, b) = (&placed.a.corners[hub.0], &placed.b.corners[hub.1]);
        self.cone.clear();
        self.cone.extend_from_slice(&a.normals);
        for &j in &b.neighbours {
            let e = placed.turn * (placed.b.corners[j].at - b.at);
            self.clipped.clear();
            for k in 0..self.cone.len() {
                let (u, w) = (self.cone[k], self.cone[(k + 1) % self.cone.len()]);
                let (du, dw) = (u.dot(&e), w.dot(&e));
                if du >= 0.0 {
                    self.clipped.push(u);
                }
                if (du >= 0.0) != (dw >= 0.0) {
                    self.clipped.push((w * du - u * dw) / (du - dw));
                }
            }
            std::mem::swap(&mut self.cone, &mut self.clipped);
        }
        let v = a.at - (placed.turn * b.at + placed.shift);
        let faces = self.cone.iter().map(|n| {
            let n = n.normalize();
            (n.dot(&v), n)
        });
        faces.min_by(|x, y| x.0.total_cmp(&y.0))
    }
}
