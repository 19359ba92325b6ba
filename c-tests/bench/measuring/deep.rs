// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! DEEP: the penetration depth of two convex polytopes with known adjacency, by a walk on the
//! surface of their Minkowski difference (Y. J. Kim, M. C. Lin, D. Manocha, "Incremental penetration
//! depth estimation between convex polytopes using dual-space expansion", IEEE TVCG 2004). The
//! baseline of W. Gao's paper (2023), Section IV.
//!
//! A vertex hub pair is a vertex a of the first polytope and b of the second whose normal cones,
//! b's turned around, overlap; a − b is then a vertex of D. The corners of the overlap are the
//! normals n of D's faces around that vertex, and n·(a − b) their distances from the origin. DEEP
//! moves to the hubs of the closest of these faces until none of them has a closer one: a local
//! minimum.
//!
//! Departure: cones are clipped with the planes n·(b' − b) ≥ 0, not projected to a plane.

use std::ffi::c_void;

use ccd::internals::ffi::{CCD_WANT_POINTS, ccd_penetration_t, ccd_vec3_t};
use nalgebra::{Matrix3, Vector3};

use super::libraries::{COLD, Libraries, zeroed};
use super::methods::{Answer, Method, Start};
use super::scene::{Pair, Scene};
use crate::harness;

type V = Vector3<f64>;

/// A vertex with its surroundings.
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
    fn new(vertices: &[V], triangles: &[[usize; 3]]) -> Self {
        let normal = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| vertices[i]);
            let n = (b - a).cross(&(c - a)).normalize();
            if n.dot(&a) < 0.0 { -n } else { n }
        };
        let corner = |v: usize| {
            // The fan of triangles around v, walked from one shared edge to the next.
            let around = triangles.iter().filter_map(|t| {
                let k = t.iter().position(|&i| i == v)?;
                Some((t[(k + 1) % 3], t[(k + 2) % 3], normal(t)))
            });
            let mut fan: Vec<(usize, usize, V)> = around.collect();
            let (mut neighbours, mut normals) = (Vec::new(), Vec::new());
            let mut edge = fan[0].0;
            while let Some(k) = fan.iter().position(|f| f.0 == edge || f.1 == edge) {
                let (p, q, n) = fan.swap_remove(k);
                neighbours.push(edge);
                normals.push(n);
                edge = if p == edge { q } else { p };
            }
            Corner { at: vertices[v], neighbours, normals }
        };
        Self {
            corners: (0..vertices.len()).map(corner).collect(),
            size: vertices.iter().map(|v| v.norm()).fold(0.0, f64::max),
        }
    }

    /// The two polytopes of a pair set (c-tests/bench/pairs/README.md); none where one is no polytope.
    pub fn of_set(name: &str) -> Option<[Self; 2]> {
        let path = harness::root().join(format!("c-tests/bench/pairs/{name}.bin"));
        let bytes = std::fs::read(path).ok()?;
        let words = |at: usize, n: usize| -> Option<Vec<usize>> {
            let of = |c: &[u8]| c.iter().rev().fold(0, |w, b| w << 8 | usize::from(*b));
            Some(bytes.get(at..at + 4 * n)?.chunks_exact(4).map(of).collect())
        };
        let reals = |at: usize, n: usize| -> Option<Vec<f64>> {
            let of = |c: &[u8]| c.try_into().map_or(f64::NAN, f64::from_le_bytes);
            Some(bytes.get(at..at + 8 * n)?.chunks_exact(8).map(of).collect())
        };
        let mut at = 16; // behind the magic and two counts
        let mut shape = || {
            let [_, corners, sides, _] = words(at, 4)?[..] else {
                return None;
            };
            let vertices = reals(at + 40, 3 * corners)?;
            let triangles = words(at + 40 + 24 * corners, 3 * sides)?;
            at += 40 + 24 * corners + 12 * sides;
            let vertices: Vec<V> = vertices.chunks_exact(3).map(V::from_column_slice).collect();
            let triangles = triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]);
            let triangles: Vec<[usize; 3]> = triangles.collect();
            (sides > 0).then(|| Self::new(&vertices, &triangles))
        };
        Some([shape()?, shape()?])
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

/// The second polytope in the first one's frame: x at `turn * x + shift`.
struct Placed<'a>(&'a Polytope, &'a Polytope, Matrix3<f64>, V);

/// Returns depth and the unit direction in which the second polytope leaves, in the first one's
/// frame; none when the vertices farthest along `start` have no common normal.
fn penetration(placed: &Placed, start: V, hub: &mut (usize, usize)) -> Option<(f64, V)> {
    let Placed(a, b, turn, _) = *placed;
    let back = turn.transpose() * -start;
    *hub = (a.extremal(&start, hub.0), b.extremal(&back, hub.1));
    let mut best = closest_face(placed, *hub)?;
    // The distance falls at every step, and faces are finite.
    loop {
        let (from, (depth, n)) = (*hub, best);
        // Vertices of the face: those that tie with the hub along n.
        let slack = 1e-10 * (a.size + b.size);
        let ties = |p: &Polytope, at: usize, along: V| -> Vec<usize> {
            let here = p.corners[at].at;
            let tied = |&i: &usize| along.dot(&(p.corners[i].at - here)) >= -slack;
            let near = p.corners[at].neighbours.iter().copied().filter(tied);
            std::iter::once(at).chain(near).collect()
        };
        let in_b = ties(b, from.1, turn.transpose() * -n);
        for i in ties(a, from.0, n) {
            for &j in &in_b {
                let face = closest_face(placed, (i, j));
                if let Some(face) = face.filter(|face| face.0 < best.0 - slack * 1e-3) {
                    (best, *hub) = (face, (i, j));
                }
            }
        }
        // Also where it is NaN.
        if best.0.partial_cmp(&depth) != Some(std::cmp::Ordering::Less) {
            return Some(best);
        }
    }
}

/// The face of D closest to the origin around a hub: the corners of the overlap of the two normal
/// cones.
fn closest_face(placed: &Placed, hub: (usize, usize)) -> Option<(f64, V)> {
    let Placed(a, of_b, turn, shift) = placed;
    let (a, b) = (&a.corners[hub.0], &of_b.corners[hub.1]);
    let (mut cone, mut clipped) = (a.normals.clone(), Vec::new());
    for &j in &b.neighbours {
        let e = turn * (of_b.corners[j].at - b.at);
        clipped.clear();
        for k in 0..cone.len() {
            let (u, w) = (cone[k], cone[(k + 1) % cone.len()]);
            let (du, dw) = (u.dot(&e), w.dot(&e));
            if du >= 0.0 {
                clipped.push(u);
            }
            if (du >= 0.0) != (dw >= 0.0) {
                clipped.push((w * du - u * dw) / (du - dw));
            }
        }
        std::mem::swap(&mut cone, &mut clipped);
    }
    let v = a.at - (turn * b.at + shift);
    let faces = cone.iter().map(|n| n.normalize()).map(|n| (n.dot(&v), n));
    faces.min_by(|x, y| x.0.total_cmp(&y.0))
}

/// A polytope with a pose, whose support function climbs from the last vertex.
struct Climber<'a> {
    of: &'a Polytope,
    rotation: Matrix3<f64>,
    position: V,
    last: usize,
}

/// `ccd_support_fn` of a `Climber`.
unsafe extern "C-unwind" fn climb(object: *const c_void, dir: *const ccd_vec3_t, out: *mut ccd_vec3_t) {
    // SAFETY: queries hand the pointers through that they are given, and no other refers to it.
    let (climber, dir, out) = unsafe { (&mut *object.cast_mut().cast::<Climber>(), &*dir, &mut *out) };
    let local = climber.rotation.transpose() * V::from(dir.v);
    climber.last = climber.of.extremal(&local, climber.last);
    let at = climber.rotation * climber.of.corners[climber.last].at + climber.position;
    *out = ccd_vec3_t { v: at.into() };
}

/// `ccd_center_fn` of a `Climber`.
unsafe extern "C-unwind" fn middle(object: *const c_void, out: *mut ccd_vec3_t) {
    // SAFETY: as above.
    unsafe { (*out).v = (*object.cast::<Climber>()).position.into() };
}

/// DEEP from a guess, and the local query over support functions that climb over the same edges: both
/// on meshes alone, so neither's support points are counted.
pub fn methods<'a>(libraries: &'a Libraries, meshes: &'a [Polytope; 2], start: Start) -> [Method<'a>; 2] {
    let [a, b] = meshes;
    let pose = |pair: &Pair| [pair.a, pair.b].map(|shape| libraries.pose(shape));
    let guess = move |pair: &Pair| start.direction(&pair.truth).unwrap_or(pair.truth.cold);
    let mut hub = (0, 0);
    let deep = move |_: &Scene, pair: &Pair| {
        let [(ra, pa), (rb, pb)] = pose(pair);
        let turn = ra.transpose() * rb;
        let shift = ra.transpose() * (pb - pa);
        let from = ra.transpose() * V::from(guess(pair));
        let (depth, n) = penetration(&Placed(a, b, turn, shift), from, &mut hub)?;
        Some(Answer { depth, dir: (ra * n).into() })
    };
    let mut last = (0, 0);
    let settings = ccd::internals::ffi::ccd_t {
        support1: Some(climb),
        support2: Some(climb),
        center1: Some(middle),
        center2: Some(middle),
        ..libraries.ours.settings(&libraries.callbacks, 1e-6)
    };
    let local = move |_: &Scene, pair: &Pair| {
        let [(ra, pa), (rb, pb)] = pose(pair);
        let climber = |of, rotation, position, last| Climber { of, rotation, position, last };
        let (mut one, mut two) = (climber(a, ra, pa, last.0), climber(b, rb, pb, last.1));
        let (one_at, two_at) = ((&raw mut one).cast(), (&raw mut two).cast());
        let (mut state, toward) = (COLD, ccd_vec3_t { v: guess(pair) });
        let calls = libraries.extension;
        // SAFETY: numbers; a query over the callbacks' own objects.
        let (code, out) = unsafe {
            let mut out: ccd_penetration_t = zeroed();
            (calls.guess)(&mut state, &toward);
            let code = (calls.local)(one_at, two_at, &settings, &mut state, CCD_WANT_POINTS, &mut out);
            (code, out)
        };
        last = (one.last, two.last);
        (code >= 0).then_some(Answer { depth: out.depth, dir: out.dir.v })
    };
    let [deep, local] = [Method::new("DEEP", deep), Method::new("local, climbing", local).of_ours()];
    [deep.from(start), local.from(start).within(1e-6)]
}
