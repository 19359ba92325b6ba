// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The point of a simplex nearest to the origin.
//!
//! Voronoi regions of vertex, edge, face as in C. Ericson, "Real-Time Collision
//! Detection", Sec. 5.1. Every test is the sign of a product of the simplex's own
//! vectors, so it is free of scale; a face whose area vanishes falls back to its
//! edges, an edge whose length vanishes to its ends.

use crate::barycentric;
use crate::math::{EPSILON, Real, Vec3, larger, largest, narrow3, normal, unit, wide3};
use crate::support::SupportPoint;

/// Up to four support points of D.
#[derive(Clone, Copy)]
pub struct Simplex {
    points: [SupportPoint; 4],
    len: usize,
}

/// The faces of a tetrahedron, all turned outwards or all inwards. The first three hold
/// the last vertex.
const FACES: [[usize; 3]; 4] = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 2]];

/// Where the origin lies, seen from a simplex.
pub enum Nearest {
    /// Inside the tetrahedron (or on it): the origin belongs to D.
    Inside,
    /// Outside; this point of the simplex is nearest to the origin.
    Outside(Vec3),
}

impl Simplex {
    /// A simplex of one point.
    #[inline]
    pub fn new(p: SupportPoint) -> Self {
        Self {
            points: [p; 4],
            len: 1,
        }
    }

    /// The points of the simplex.
    #[inline]
    pub fn points(&self) -> &[SupportPoint] {
        &self.points[..self.len.min(4)]
    }

    /// Adds a point; a fifth replaces the newest.
    #[inline]
    pub fn push(&mut self, p: SupportPoint) {
        let at = self.len.min(3);
        self.points[at] = p;
        self.len = at + 1;
    }

    /// A tetrahedron.
    pub fn of(points: [SupportPoint; 4]) -> Self {
        Self { points, len: 4 }
    }

    /// The mean of the points.
    pub fn mean(&self) -> SupportPoint {
        let mut mean = SupportPoint::default();
        let share = 1.0 / self.points().len() as Real;
        for p in self.points() {
            mean.v += p.v * share;
            mean.v1 += p.v1 * share;
            mean.v2 += p.v2 * share;
        }
        mean
    }

    /// Largest absolute coordinate of a witness.
    fn magnitude(&self) -> Real {
        self.points()
            .iter()
            .fold(0.0, |m, p| larger(m, p.magnitude()))
    }

    /// The distance from the origin to the nearest face of a tetrahedron that holds
    /// it: a lower bound on the penetration depth, since the tetrahedron is inscribed
    /// in D. Zero where the origin is not strictly inside a tetrahedron.
    pub fn inner_distance(&self) -> Real {
        if self.len != 4 {
            return 0.0;
        }
        let rounding = 4.0 * EPSILON * self.magnitude();
        let [p, q, r, s] = self.points.each_ref().map(|p| &p.v);
        // The faces around s, and the base: all turned outwards or all inwards.
        let [sp, sq, sr] = [p - s, q - s, r - s];
        let [pr, pq] = [r - p, q - p];
        let [at_s, at_p] = [largest(s), largest(p)];
        let [p_, q_, r_] = [largest(&sp), largest(&sq), largest(&sr)];
        let faces = [
            (sp.cross(&sq), s, at_s * larger(p_, q_)),
            (sq.cross(&sr), s, at_s * larger(q_, r_)),
            (sr.cross(&sp), s, at_s * larger(r_, p_)),
            (pr.cross(&pq), p, at_p * larger(largest(&pr), largest(&pq))),
        ];
        let mut least = Real::INFINITY;
        let outwards = faces[0].0.dot(s) > 0.0;
        for (n, a, lever) in &faces {
            let origin = n.dot(a);
            let origin = if outwards { origin } else { -origin };
            // Less what the rounding of the corners may add, which a short edge
            // magnifies by the way to the origin.
            let distance = (origin - rounding * lever) / n.norm() - rounding;
            // Not on the inner side, or within rounding of it, or a face whose area
            // underflows (infinite or NaN): no bound.
            if !(distance > 0.0 && distance < Real::INFINITY) {
                return 0.0;
            }
            if distance < least {
                least = distance;
            }
        }
        least
    }

    /// The point of obj1 and obj2 where they meet, for a simplex that holds the origin:
    /// within rounding a convex combination of either's own points.
    pub fn witnesses(&self) -> (Vec3, Vec3) {
        let origin = Vec3::zeros();
        let all = self.points.each_ref();
        let [a, b, c, d] = all.map(|p| &p.v);
        // The places outside use take a weight of 0.
        let mut weights = [1.0, 0.0, 0.0, 0.0];
        match self.len {
            0 | 1 => {}
            2 => weights[..2].copy_from_slice(&barycentric::segment(&origin, a, b).weights),
            3 => weights[..3].copy_from_slice(&barycentric::triangle(&origin, a, b, c).weights),
            _ => weights = barycentric::tetrahedron(&origin, [a, b, c, d]).weights,
        }
        let (p1, p2) = barycentric::witnesses(&weights, all);
        // What the rounding of the shares leaves between them.
        let rest = (p1 - p2) * 0.5;
        (p1 - rest, p2 + rest)
    }

    /// The unit normal of the face opposite to the newest vertex of a tetrahedron, away
    /// from it; `None` when the face has no area.
    pub fn out_of_base(&self) -> Option<Vec3> {
        let [a, b, c, newest] = self.points.each_ref().map(|p| &p.v);
        let n = unit(&normal(a, b, c))?;
        Some(if n.dot(newest) > n.dot(a) { -n } else { n })
    }

    /// Keeps so many of the points, these. (`% 4`: in range, and the compiler sees it.)
    #[inline]
    fn keep(&mut self, Indices(which, len): &Indices) {
        let old = self.points;
        for (to, from) in self.points.iter_mut().zip(which).take(*len) {
            *to = old[from % 4];
        }
        self.len = *len;
    }

    /// Reduces the simplex to the face that holds its point nearest to the origin.
    ///
    /// Seen from the nearest point v of the others, the newest point must lie on the
    /// origin's side (−v·w > −v·v): then that face has the newest point for a vertex, and
    /// the faces without it are not looked at. Near the origin, where the arithmetic could prefer one of
    /// them, that is what makes every new point count.
    #[inline]
    pub fn reduce(&mut self) -> Nearest {
        let [a, b, c, _] = self.points.each_ref().map(|p| p.v);
        match self.len {
            1 => Nearest::Outside(a),
            2 => {
                let (v, face) = nearest_on_segment(&a, &b);
                self.keep(&face.indices(&[0, 1, 0]));
                Nearest::Outside(v)
            }
            3 => {
                let (v, face) = nearest_on_triangle(&a, &b, &c);
                self.keep(&face.indices(&[0, 1, 2]));
                Nearest::Outside(v)
            }
            _ => self.reduce_tetrahedron(),
        }
    }

    fn reduce_tetrahedron(&mut self) -> Nearest {
        let mut best: Option<(Real, Vec3, Face, [usize; 3])> = None;
        let rounding = 4.0 * EPSILON * self.magnitude();
        // The last face lacks the newest vertex.
        for (f, opposite) in FACES[..3].iter().zip([2, 0, 1]) {
            let [a, b, c] = f.map(|i| self.points[i % 4].v);
            let n = (b - a).cross(&(c - a));
            let origin = -n.dot(&a);
            let inner = n.dot(&(self.points[opposite % 4].v - a));
            // The origin is on the inner side of this face only if both products
            // have one sign; a flat tetrahedron (0) or NaN examines the face. So does
            // an origin so near its plane that the rounding of the corners, which a
            // short edge magnifies by the way to the origin, could turn the sign.
            let edges = larger(largest(&(b - a)), largest(&(c - a)));
            if same_sign(origin, inner)
                && origin.abs() > rounding * (largest(&n) + edges * largest(&a))
            {
                continue;
            }
            let (v, face) = nearest_on_triangle(&a, &b, &c);
            let d = v.norm_squared();
            if best.as_ref().is_none_or(|x| d < x.0) {
                best = Some((d, v, face, *f));
            }
        }
        match best {
            None => Nearest::Inside,
            Some((_, v, face, f)) => {
                self.keep(&face.indices(&f));
                Nearest::Outside(v)
            }
        }
    }
}

/// Are both positive or both negative? Their product could underflow.
#[inline]
fn same_sign(a: Real, b: Real) -> bool {
    a > 0.0 && b > 0.0 || a < 0.0 && b < 0.0
}

/// Which of a triangle's vertices span the face that holds the nearest point.
#[derive(Clone, Copy)]
enum Face {
    Vertex(usize),
    Edge(usize, usize),
    All,
}

/// One to three indices, without a heap.
struct Indices([usize; 3], usize);

impl Face {
    #[inline]
    fn indices(self, of: &[usize; 3]) -> Indices {
        let at = |i: usize| of[i.min(2)];
        match self {
            Face::Vertex(i) => Indices([at(i), 0, 0], 1),
            Face::Edge(i, j) => Indices([at(i), at(j), 0], 2),
            Face::All => Indices(*of, 3),
        }
    }
}

#[inline]
fn nearest_on_segment(a: &Vec3, b: &Vec3) -> (Vec3, Face) {
    let ab = b - a;
    let t = -a.dot(&ab);
    let len2 = ab.norm_squared();
    // `!(t > 0)` and `!(t < len2)` send NaN and a segment without length to an end.
    if !(t > 0.0) {
        (*a, Face::Vertex(0))
    } else if !(t < len2) {
        (*b, Face::Vertex(1))
    } else {
        // Close to the origin the sum is all rounding error: what of it lies along
        // the segment is taken away, so that the direction stays perpendicular.
        let v = a + ab * (t / len2);
        (v - ab * (v.dot(&ab) / len2), Face::Edge(0, 1))
    }
}

/// As all of [`Simplex::reduce`], for a triangle whose newest vertex is `c`.
#[inline]
fn nearest_on_triangle(a: &Vec3, b: &Vec3, c: &Vec3) -> (Vec3, Face) {
    // In double throughout: of a sliver that looks at the origin these are rounding else.
    let [x, y, z] = [a, b, c].map(wide3);
    let n = (y - x).cross(&(z - x));
    let nn = n.norm_squared();
    // Twice the signed areas of the triangles that the projected origin makes
    // with the edges bc and ca, as multiples of n: positive on the inner side.
    let u = n.dot(&y.cross(&z));
    let v = n.dot(&z.cross(&x));
    if u > 0.0 && v > 0.0 && nn > 0.0 {
        return (narrow3(&(n * (x.dot(&n) / nn))), Face::All);
    }
    // Outside an edge, or without area.
    let (p, on_ac) = nearest_on_segment(a, c);
    let (q, on_bc) = nearest_on_segment(b, c);
    if q.norm_squared() < p.norm_squared() {
        let face = match on_bc {
            Face::Vertex(0) => Face::Vertex(1),
            Face::Vertex(_) => Face::Vertex(2),
            _ => Face::Edge(1, 2),
        };
        (q, face)
    } else {
        let face = match on_ac {
            Face::Vertex(0) => Face::Vertex(0),
            Face::Vertex(_) => Face::Vertex(2),
            _ => Face::Edge(0, 2),
        };
        (p, face)
    }
}
