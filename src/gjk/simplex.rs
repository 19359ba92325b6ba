// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A simplex of points of D, and its point nearest to the origin: one step of the distance
//! algorithm of Gilbert, Johnson and Keerthi (1988).
//!
//! The way from the nearest point to the origin, of unit length n, is asked next. The new
//! point lies beyond the simplex as seen along n, so that of the new simplex only the faces
//! with the newest point can hold the nearest: with w newest and the base abc wound such that
//! its normal is n, the origin is on the inner side of the face w a b when det(w, a, b) > 0,
//! and inside the tetrahedron when all three such are. No product but these decides, and none
//! is compared with an absolute epsilon.
//!
//! **Near the origin** the nearest point is mostly rounding error, and the way from it is
//! noise; the normal of a face is not. So the way from a face is its normal, outwards, and
//! an origin within rounding of an edge counts as one in the face.

use crate::gjk::barycentric;
use crate::known::support_set::SupportSet;
use crate::math::{EPSILON, Vec3, normal, perpendicular, unit};

/// A simplex of points of a set, seen from the origin.
///
/// A point stays in its place as long as it is a corner: what changes is the order.
#[derive(Clone, Copy)]
pub struct Simplex {
    /// The points' indices in their set, by place.
    ids: [usize; 4],
    /// The points less the target, by place.
    at: [Vec3; 4],
    /// The places of the corners, the last repeated where there are fewer. Of three the
    /// winding tells the way: outwards, where the target is.
    order: [usize; 3],
    len: usize,
    /// The place of a point that is well inside D, if one is a corner; else [`NOWHERE`].
    inner: usize,
}

/// No place.
const NOWHERE: usize = 4;

/// A face of a simplex that holds the point nearest to the target.
#[derive(Clone, Copy)]
struct Face {
    order: [usize; 3],
    len: usize,
    way: Vec3,
    distance2: f64,
}

/// What [`Simplex::add`] returns: the way to the target, and the square of the distance, m².
pub type Added = (Vec3, f64);

impl Simplex {
    /// No point.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            ids: [0; 4],
            at: [Vec3::zeros(); 4],
            order: [3; 3],
            len: 0,
            inner: NOWHERE,
        }
    }

    /// One point, well inside D.
    #[inline(always)]
    pub fn around(id: usize, at: &Vec3) -> Self {
        let mut simplex = Self::new();
        simplex.add(id, *at, 0.0, 0.0);
        Self {
            inner: 0,
            ..simplex
        }
    }

    /// The corners' indices, as many as there are corners.
    #[inline(always)]
    pub fn ids(&self) -> [usize; 3] {
        self.order.map(|p| self.ids[p & 3])
    }

    /// Is a point a corner that is well inside D?
    #[inline(always)]
    pub fn has_inner(&self) -> bool {
        self.inner != NOWHERE
    }

    /// Is this point a corner?
    #[inline(always)]
    pub fn has(&self, id: usize) -> bool {
        self.ids().iter().take(self.len).any(|i| *i == id)
    }

    /// A place where there is no corner.
    #[inline(always)]
    pub fn place(&self) -> usize {
        let [i, j, k] = self.order;
        (!(1_u32 << i | 1 << j | 1 << k)).trailing_zeros() as usize & 3
    }

    /// Adds a point, `at` from the target, and keeps the face that holds the point nearest
    /// to it. What is nearer than `touch`, metres, touches; `size2` is
    /// the square of a length that no corner is farther from the target than.
    ///
    /// Returns the way from there to the target, of any length, and the square of the
    /// distance, m². The way is zero where a triangle without area holds the target. `None`:
    /// the target is inside the tetrahedron, off its three new faces by more than a touch;
    /// its distance from the old one, the base, is not looked at.
    #[inline(always)]
    pub fn add(&mut self, id: usize, at: Vec3, touch: f64, size2: f64) -> Option<Added> {
        let w = self.place();
        self.ids[w] = id;
        self.at[w] = at;
        if w == self.inner {
            self.inner = NOWHERE;
        }
        let [i, j, _] = self.order;
        let face = match self.len {
            0 => self.corner(w),
            1 => self.line(i, w, touch),
            2 => {
                let [a, b] = [i, j].map(|p| self.at[p & 3]);
                let n = normal(&a, &b, &at);
                // Outwards is where the target is. NaN, or a flat D: either.
                if n.dot(&at) > 0.0 {
                    self.triangle([j, i, w], -n, a.cross(&at), at.cross(&b), touch)
                } else {
                    self.triangle([i, j, w], n, b.cross(&at), at.cross(&a), touch)
                }
            }
            _ => self.tetrahedron(w, touch, size2)?,
        };
        self.order = face.order;
        self.len = face.len;
        Some((face.way, face.distance2))
    }

    /// How many corners there are: at most three.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds a corner, one of at most three, wherever it is: [`Simplex::settle`] tells the rest.
    pub fn put(&mut self, id: usize, at: Vec3) {
        let w = self.place();
        self.ids[w] = id;
        self.at[w] = at;
        self.order = match (self.order, self.len) {
            ([i, ..], 1) => [i, w, w],
            ([i, j, _], 2) => [i, j, w],
            _ => [w; 3],
        };
        self.len = (self.len + 1).min(3);
    }

    /// As [`Simplex::add`] without a new point; and every face of the simplex counts, not
    /// only those with the newest point.
    pub fn settle(&mut self, touch: f64) -> (Vec3, f64) {
        let [i, j, k] = self.order;
        let at = self.order.map(|p| self.at[p & 3]);
        let face = match self.len {
            0 | 1 => self.corner(i),
            2 => self.line(i, j, touch),
            _ => {
                let [a, b, c] = &at;
                let weights = barycentric::triangle(&Vec3::zeros(), a, b, c).weights;
                match weights.map(|w| w > 0.0) {
                    [true, true, true] => {
                        let n = normal(a, b, c);
                        let height = n.dot(a);
                        let inner = height > 0.0;
                        Face {
                            order: if inner { [j, i, k] } else { [i, j, k] },
                            len: 3,
                            way: if inner { -n } else { n },
                            distance2: height / n.norm_squared() * height,
                        }
                    }
                    [true, true, _] => self.line(i, j, touch),
                    [true, _, true] => self.line(i, k, touch),
                    [_, true, true] => self.line(j, k, touch),
                    [_, _, true] => self.corner(k),
                    [_, true, _] => self.corner(j),
                    _ => self.corner(i),
                }
            }
        };
        (self.order, self.len) = (face.order, face.len);
        (face.way, face.distance2)
    }

    #[inline(always)]
    fn corner(&self, i: usize) -> Face {
        Face {
            order: [i; 3],
            len: 1,
            way: -self.at[i & 3],
            distance2: self.at[i & 3].norm_squared(),
        }
    }

    /// The nearest point of the segment from `i` to the newest point `w`.
    #[inline(always)]
    fn segment(&self, i: usize, w: usize) -> Face {
        let (a, b) = (&self.at[i & 3], &self.at[w & 3]);
        let ab = a - b;
        let t = -b.dot(&ab);
        let length2 = ab.norm_squared();
        // NaN and a segment without length end at a corner.
        if !(t > 0.0) {
            self.corner(w)
        } else if !(t < length2) {
            self.corner(i)
        } else {
            // Close to the target the sum is all rounding error: what of it lies along
            // the segment is taken away, so that the way stays perpendicular.
            let v = b + ab * (t / length2);
            let v = v - ab * (v.dot(&ab) / length2);
            Face {
                order: [i, w, w],
                len: 2,
                way: -v,
                distance2: v.norm_squared(),
            }
        }
    }

    /// The nearest point of two; where they hold the target, any way aside.
    #[inline(always)]
    fn line(&self, i: usize, w: usize, touch: f64) -> Face {
        let mut face = self.segment(i, w);
        if !(face.distance2 > touch * touch) {
            let along = unit(&(self.at[w & 3] - self.at[i & 3])).unwrap_or(Vec3::x());
            face.way = perpendicular(&along);
        }
        face
    }

    /// The part of a triangle that holds its nearest point: the triangle of `order` = i, j and
    /// the newest point w, or of its edges those with w, which alone can. Given are its outward
    /// normal `n`, and with the corners as vectors j × w and w × i.
    #[inline(always)]
    fn triangle(&self, order: [usize; 3], n: Vec3, jw: Vec3, wi: Vec3, touch: f64) -> Face {
        let [i, j, w] = order;
        // The weights of i and j, as multiples of n².
        let (beyond_i, beyond_j) = (!(n.dot(&jw) > 0.0), !(n.dot(&wi) > 0.0));
        let edge = match (beyond_i, beyond_j) {
            (false, false) => {
                let height = n.dot(&self.at[w & 3]);
                return Face {
                    order,
                    len: 3,
                    way: n,
                    distance2: height / n.norm_squared() * height,
                };
            }
            (true, false) => self.segment(j, w),
            (false, true) => self.segment(i, w),
            (true, true) => {
                let (one, other) = (self.segment(i, w), self.segment(j, w));
                if other.distance2 < one.distance2 {
                    other
                } else {
                    one
                }
            }
        };
        if edge.distance2 > touch * touch {
            return edge;
        }
        // On the edge within rounding.
        Face {
            order,
            len: 3,
            way: n,
            distance2: edge.distance2,
        }
    }

    /// The face nearest to the target; `None` where it is inside.
    #[inline(always)]
    fn tetrahedron(&self, place: usize, touch: f64, size2: f64) -> Option<Face> {
        let [i, j, k] = self.order;
        let [a, b, c, w] = [i, j, k, place].map(|p| &self.at[p & 3]);
        let (wa, wb, wc) = (w.cross(a), w.cross(b), w.cross(c));
        let heights = [wa.dot(b), wb.dot(c), wc.dot(a)];
        // The normal of a face is at most four squares of the farthest corner long: what is
        // higher is off it by more than twice the rounding.
        let least = 8.0 * size2 * touch;
        // A face that has the inner point for a corner is inside D, and so is the target where
        // rounding puts it on either side of that: what counts is the face opposite.
        let kept = [i, j, k].map(|p| p == self.inner);
        let inside = kept != [false; 3];
        // NaN is outside.
        let clear = |height: f64, p: &Vec3, q: &Vec3, opposite: bool| {
            let slack = if inside && !opposite { -touch } else { touch };
            height > least || height > -least && off(height, p, q, w, slack)
        };
        let mut best: Option<Face> = None;
        let corners = [i, j, k, i];
        let crosses = [wa, wb, wc, wa];
        for s in 0..3 {
            let (p, q) = (&self.at[corners[s] & 3], &self.at[corners[s + 1] & 3]);
            if clear(heights[s], p, q, kept[(s + 2) % 3]) {
                continue;
            }
            let order = [corners[s], corners[s + 1], place];
            let n = normal(p, q, w);
            let face = self.triangle(order, n, -crosses[s + 1], crosses[s], touch);
            if best.as_ref().is_none_or(|b| face.distance2 < b.distance2) {
                best = Some(face);
            }
        }
        best
    }

    /// The points of the objects whose difference is nearest to the origin; the fourth corner is
    /// `inside`, the newest point, where the origin is in the tetrahedron that it makes.
    pub fn witnesses<const N: usize>(
        &self,
        set: &SupportSet<N>,
        inside: Option<usize>,
    ) -> (Vec3, Vec3) {
        let origin = Vec3::zeros();
        let [a, b, c] = self.ids().map(|i| set.point(i));
        match (self.len, inside.map(|i| set.point(i))) {
            (3, Some(d)) => {
                let nearest = barycentric::tetrahedron(&origin, [&a.v, &b.v, &c.v, &d.v]);
                barycentric::witnesses(&nearest.weights, [&a, &b, &c, &d])
            }
            (3, None) => {
                let nearest = barycentric::triangle(&origin, &a.v, &b.v, &c.v);
                barycentric::witnesses(&nearest.weights, [&a, &b, &c])
            }
            (2, _) => {
                let nearest = barycentric::segment(&origin, &a.v, &b.v);
                barycentric::witnesses(&nearest.weights, [&a, &b])
            }
            _ => (a.v1, a.v2),
        }
    }
}

/// Is the target off the face of p, q and w by more than twice the slack, and by more than
/// rounding? For heights that [`Simplex::tetrahedron`]'s cheaper bound leaves open; `height` is
/// the distance times twice the face's area.
#[cold]
fn off(height: f64, p: &Vec3, q: &Vec3, w: &Vec3, slack: f64) -> bool {
    // The product itself is off by ulps of the corners' lengths, however small the face is.
    let lengths = p.norm() * q.norm() * w.norm();
    let error = if slack > 0.0 {
        8.0 * EPSILON * lengths
    } else {
        0.0
    };
    height > 2.0 * slack * normal(p, q, w).norm() + error
}

/// The unit vector along `way`, and `None` for none.
#[inline(always)]
pub fn direction(way: &Vec3) -> Option<Vec3> {
    let length2 = way.norm_squared();
    // Squares that are neither rounded to nothing nor beyond numbers.
    // (In single precision those of areas soon are.)
    let safe = length2 > f64::MIN_POSITIVE / EPSILON && length2 < f64::INFINITY;
    if safe && !cfg!(feature = "single") {
        Some(way / length2.sqrt())
    } else {
        unit(way)
    }
}

/// Where the next point goes: behind the others, or, in a set without room, in the place of
/// one that is no corner.
#[inline(always)]
pub fn room<const N: usize>(set: &SupportSet<N>, simplex: &Simplex) -> usize {
    if !set.is_full() {
        return set.len();
    }
    (0..N).find(|i| !simplex.has(*i)).unwrap_or(N - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Random;

    /// Corners that lie in a plane with the target, and near each other.
    #[test]
    fn rounding_of_a_small_face_is_no_height() {
        let mut r = Random::new(41);
        for round in 0..2000 {
            let apart = [1e-2, 1e-4, 1e-6][round % 3];
            let p = r.direction() * 1e-3;
            let q = p + r.vector(1e-3 * apart);
            let w = p * r.within(0.5, 2.0) + q * r.within(-1.0, 1.0);
            let height = p.cross(&q).dot(&w);
            // Of an object a thousand times as large.
            assert!(!off(height, &p, &q, &w, EPSILON));
            assert!(off(1e3 * EPSILON * 1e-9, &p, &q, &w, EPSILON));
        }
    }
}
