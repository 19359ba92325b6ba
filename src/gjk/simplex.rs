// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The simplex of the GJK algorithm: computes its closest feature to the origin after each new point
//! (E. Gilbert, D. Johnson and S. Keerthi, "A Fast Procedure for Computing the Distance between Complex
//! Objects in Three-Dimensional Space", IEEE J. Robotics and Automation 4(2), 1988).
//!
//! 1. Let n be the direction from the closest point of the simplex to the origin. The new point w is farther
//!    along n than the simplex, so the new closest feature contains w.
//! 2. Two or three points: the signs of the barycentric coordinates select the feature; the coordinates are
//!    the weights of the corners in the closest point.
//! 3. Four points: the origin is on the inner side of face w, a, b if det(w, a, b) > 0 (base abc wound so
//!    that its normal is n), and inside the tetrahedron if that holds for all three new faces.
//!
//! Departures from the paper:
//! - The old edge of a new face is tested too: in nearly flat simplices it can be the closest feature.
//! - The search direction of a face is its normal, not the direction from the closest point, which is mostly
//!   rounding error near the origin.
//! - An origin within the contact epsilon of an edge counts as inside the face.
//! - No length is compared with an absolute epsilon.
//! - The new point need not be a support point: step 1 holds for any known difference farther along n.

use crate::math::{EPSILON, Vec3, normal, perpendicular, unit};
use crate::minkowski::tolerance::TRIPLE_PRODUCT_ULPS;
use crate::minkowski::vertex_set::{Vertex, VertexPair};

/// A simplex of points of D: at most three corners, and a slot for the next point.
///
/// A corner keeps its slot: only the order changes.
#[derive(Clone, Copy)]
pub struct Simplex {
    slots: [Vertex; 4],
    /// The slots of the corners, the last one repeated if there are fewer than three. Three are wound so that
    /// their normal points to the origin.
    order: [usize; 3],
    len: usize,
    /// Barycentric coordinates of the closest point.
    weights: [f64; 3],
    /// The slot of the point added last.
    newest: usize,
}

/// The closest feature of a simplex.
#[derive(Clone, Copy)]
struct Feature {
    order: [usize; 3],
    len: usize,
    weights: [f64; 3],
    /// Search direction, towards the origin; of any length.
    dir: Vec3,
    /// Square of the distance from the origin, m².
    distance2: f64,
}

impl Simplex {
    /// The simplex without corners.
    pub const EMPTY: Self = Self {
        slots: [Vertex {
            w: crate::math::ZERO,
            pair: VertexPair::INTERIOR,
        }; 4],
        order: [3; 3],
        len: 0,
        weights: [1.0, 0.0, 0.0],
        newest: 0,
    };

    /// Returns the simplex whose only corner is a point in the interior of D.
    #[inline(always)]
    pub fn of_interior(c: &Vec3) -> Self {
        let mut simplex = Self::EMPTY;
        simplex.slots[0].w = *c;
        (simplex.order, simplex.len) = ([0; 3], 1);
        simplex
    }

    /// Returns the corners, the last one repeated if there are fewer than three.
    #[inline(always)]
    pub fn corners(&self) -> [Vertex; 3] {
        self.order.map(|i| self.slots[i & 3])
    }

    /// Returns the weights of [`Simplex::corners`] in the closest point.
    pub fn weights(&self) -> [f64; 3] {
        self.weights
    }

    /// Returns the number of corners, at most three.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns the corners and the point added last: the tetrahedron, if [`Simplex::add`] has returned `None`.
    #[inline(always)]
    pub fn tetrahedron(&self) -> [Vertex; 4] {
        let [a, b, c] = self.corners();
        [a, b, c, self.slots[self.newest & 3]]
    }

    /// Returns whether the origin is on the inner side of the old face by more than rounding, after
    /// [`Simplex::add`] has returned `None`. (The normal of a sliver may point to either side.) If the interior
    /// point is a corner, the old face contains that point and lies inside D, unless D is flat. Measured (campaign `touches`
    /// with 400,000 pairs): without this test a touch is a hit.
    pub fn is_certain(&self) -> bool {
        let [a, b, c, w] = self.tetrahedron().map(|corner| corner.w);
        let error = TRIPLE_PRODUCT_ULPS * EPSILON * a.norm() * b.norm() * c.norm();
        let volume = (a - w).cross(&(b - w)).dot(&(c - w));
        if self.has_interior() {
            let edges = (a - w).norm() * (b - w).norm() * (c - w).norm();
            return volume.abs() > TRIPLE_PRODUCT_ULPS * EPSILON * edges;
        }
        let height = a.cross(&b).dot(&c);
        if volume < 0.0 {
            height < -error
        } else {
            height > error
        }
    }

    /// Returns the storage: the corners and discarded ones.
    #[inline(always)]
    pub fn slots(&mut self) -> &mut [Vertex] {
        &mut self.slots
    }

    /// Returns whether the interior point is a corner.
    #[inline(always)]
    pub fn has_interior(&self) -> bool {
        self.len > 0
            && self
                .corners()
                .iter()
                .any(|corner| corner.pair.is_interior())
    }

    /// Adds a point and keeps the feature closest to the origin. `contact_eps`: distance below which the
    /// origin counts as on a feature, metres. `size2`: square of an upper bound of the corners' lengths, m².
    ///
    /// Returns the search direction, of any length, and the square of the distance, m². `None`: the origin is
    /// inside the tetrahedron, at least `contact_eps` from its three new faces; the distance from the old face
    /// is not tested.
    #[inline(always)]
    pub fn add(&mut self, point: Vertex, contact_eps: f64, size2: f64) -> Option<(Vec3, f64)> {
        let [i, j, k] = self.order;
        let free = (!(1_u32 << i | 1 << j | 1 << k)).trailing_zeros() as usize & 3;
        self.slots[free] = point;
        self.newest = free;
        let w = point.w;
        let feature = match self.len {
            0 => self.corner_feature(free, [1.0, 0.0, 0.0]),
            1 => self.first_segment(i, free, contact_eps),
            2 => {
                let [a, b] = [i, j].map(|slot| &self.slots[slot & 3].w);
                let n = normal(a, b, &w);
                // If n·w is NaN or D is flat, either side will do.
                if n.dot(&w) > 0.0 {
                    self.triangle([j, i, free], -n, contact_eps)
                } else {
                    self.triangle([i, j, free], n, contact_eps)
                }
            }
            _ => self.closest_new_face(free, contact_eps, size2)?,
        };
        (self.order, self.len, self.weights) = (feature.order, feature.len, feature.weights);
        Some((feature.dir, feature.distance2))
    }

    /// Returns a corner as a feature. `weights`: any with sum 1, since the feature repeats the corner three times.
    #[inline(always)]
    fn corner_feature(&self, i: usize, weights: [f64; 3]) -> Feature {
        let w = &self.slots[i & 3].w;
        Feature {
            order: [i; 3],
            len: 1,
            weights,
            dir: -w,
            distance2: w.norm_squared(),
        }
    }

    /// Returns the closest feature of a segment. Its weights are those of `i` and `j`.
    #[inline(always)]
    fn segment(&self, i: usize, j: usize) -> Feature {
        let (a, b) = (&self.slots[i & 3].w, &self.slots[j & 3].w);
        let ab = a - b;
        let t = -b.dot(&ab);
        let length2 = ab.norm_squared();
        // Negated, so that NaN and a segment of length 0 give a corner.
        if !(t > 0.0) {
            self.corner_feature(j, [0.0, 1.0, 0.0])
        } else if !(t < length2) {
            self.corner_feature(i, [1.0, 0.0, 0.0])
        } else {
            // Close to the origin v is mostly rounding error. Its part along the segment is subtracted, so that
            // the direction stays perpendicular to the segment.
            let t = t / length2;
            let v = b + ab * t;
            let rest = v.dot(&ab) / length2;
            let v = v - ab * rest;
            let weight = (t - rest).clamp(0.0, 1.0);
            Feature {
                order: [i, j, j],
                len: 2,
                weights: [weight, 1.0 - weight, 0.0],
                dir: -v,
                distance2: v.norm_squared(),
            }
        }
    }

    /// Returns the closest feature of a simplex of two points. If the origin is on the segment, the direction is
    /// an arbitrary perpendicular.
    #[inline(always)]
    fn first_segment(&self, i: usize, j: usize, contact_eps: f64) -> Feature {
        let mut feature = self.segment(i, j);
        if !(feature.distance2 > contact_eps * contact_eps) {
            let along = self.slots[j & 3].w - self.slots[i & 3].w;
            feature.dir = perpendicular(&unit(&along).unwrap_or(Vec3::x()));
        }
        feature
    }

    /// Returns the closest feature of a triangle. `n`: its normal, pointing to the origin.
    #[inline(always)]
    fn triangle(&self, order: [usize; 3], n: Vec3, contact_eps: f64) -> Feature {
        let [i, j, k] = order;
        let [a, b, c] = order.map(|slot| &self.slots[slot & 3].w);
        let face = |order, weights, distance2| Feature {
            order,
            len: 3,
            weights,
            dir: n,
            distance2,
        };
        // The barycentric coordinates, times n². If one is negative, the origin is beyond the opposite edge.
        let coordinates = [(b, c), (c, a), (a, b)].map(|(p, q)| n.dot(&p.cross(q)));
        let (edge, order) = match coordinates.map(|x| !(x > 0.0)) {
            [false, false, false] => {
                // The distance of the point, not of the plane: the normal of a sliver is inaccurate.
                let sum: f64 = coordinates.iter().sum();
                let weights = coordinates.map(|x| x / sum);
                let point = a * weights[0] + b * weights[1] + c * weights[2];
                return face(order, weights, point.norm_squared());
            }
            [false, false, true] => (self.segment(i, j), order),
            [true, false, _] => (self.segment(j, k), [j, k, i]),
            [false, true, _] => (self.segment(k, i), [k, i, j]),
            [true, true, _] => {
                let (one, other) = (self.segment(k, i), self.segment(j, k));
                if other.distance2 < one.distance2 {
                    (other, [j, k, i])
                } else {
                    (one, [k, i, j])
                }
            }
        };
        // If the plane is as far as the edge within rounding, its normal is the direction: close to the origin that of
        // the edge is mostly rounding error.
        let least = edge.distance2.sqrt() - contact_eps;
        let offset = n.dot(a);
        if least > 0.0 && !(offset * offset >= least * least * n.norm_squared()) {
            return edge;
        }
        face(order, edge.weights, edge.distance2)
    }

    /// Returns the closest feature of the three new faces; `None` if the origin is inside the tetrahedron.
    #[inline(always)]
    fn closest_new_face(&self, newest: usize, contact_eps: f64, size2: f64) -> Option<Feature> {
        let [i, j, k] = self.order;
        let [a, b, c, w] = [i, j, k, newest].map(|slot| &self.slots[slot & 3].w);
        let (wa, wb, wc) = (w.cross(a), w.cross(b), w.cross(c));
        let heights = [wa.dot(b), wb.dot(c), wc.dot(a)];
        // The length of a face's normal is at most 4 size2, so heights above this are at least 2 contact_eps.
        let clear_height = 8.0 * size2 * contact_eps;
        // Faces that contain the interior point lie inside D: a rounding error there does not affect the
        // result. Only the face opposite to that point matters.
        let interior = [i, j, k].map(|slot| self.slots[slot & 3].pair.is_interior());
        let has_interior = interior != [false; 3];
        // False for NaN: the origin then counts as outside.
        let is_clear = |height: f64, p: &Vec3, q: &Vec3, is_opposite: bool| {
            let slack = if has_interior && !is_opposite {
                -contact_eps
            } else {
                contact_eps
            };
            height > clear_height || height > -clear_height && is_clear_of(height, p, q, w, slack)
        };
        let mut best: Option<Feature> = None;
        let corners = [i, j, k, i];
        for s in 0..3 {
            let [p, q] = [corners[s], corners[s + 1]].map(|slot| &self.slots[slot & 3].w);
            if is_clear(heights[s], p, q, interior[(s + 2) % 3]) {
                continue;
            }
            let order = [corners[s], corners[s + 1], newest];
            let face = self.triangle(order, normal(p, q, w), contact_eps);
            if best.as_ref().is_none_or(|b| face.distance2 < b.distance2) {
                best = Some(face);
            }
        }
        best
    }
}

/// Returns whether the distance of the origin from the face of p, q and w exceeds twice the slack and the
/// rounding error. `height`: that distance times twice the area of the face.
#[cold]
fn is_clear_of(height: f64, p: &Vec3, q: &Vec3, w: &Vec3, slack: f64) -> bool {
    // The error of the product is proportional to the corners' lengths, however small the face is.
    let lengths = p.norm() * q.norm() * w.norm();
    let error = if slack > 0.0 {
        TRIPLE_PRODUCT_ULPS * EPSILON * lengths
    } else {
        0.0
    };
    height > 2.0 * slack * normal(p, q, w).norm() + error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::barycentric;
    use crate::minkowski::support_query::SupportQuery;
    use crate::minkowski::vertex_set::VertexSet;
    use crate::test_shapes::Random;

    /// Tests corners in a plane with the origin, and close to each other.
    #[test]
    fn small_coplanar_face_has_zero_height() {
        let mut r = Random::new(41);
        for round in 0..2000 {
            let distance = [1e-2, 1e-4, 1e-6][round % 3];
            let p = r.direction() * 1e-3;
            let q = p + r.vector(1e-3 * distance);
            let w = p * r.within(0.5, 2.0) + q * r.within(-1.0, 1.0);
            let height = p.cross(&q).dot(&w);
            // The object is a thousand times as large as the face.
            assert!(!is_clear_of(height, &p, &q, &w, EPSILON));
            assert!(is_clear_of(1e3 * EPSILON * 1e-9, &p, &q, &w, EPSILON));
        }
    }

    /// Adds points one after the other, each farther along the search direction than the simplex: the distance
    /// is that of all corners, and decreases.
    #[test]
    fn closest_feature_is_that_of_the_corners() {
        let mut r = Random::new(42);
        let mut met = [0; 4];
        for _ in 0..2000 {
            let at = r.direction() * r.within(0.0, 1.5);
            let points: Vec<Vec3> = (0..6).map(|_| at + r.vector(1.0)).collect();
            let mut simplex = Simplex::EMPTY;
            let mut dir = r.direction();
            let mut before = f64::INFINITY;
            for _ in 0..30 {
                let w = *points
                    .iter()
                    .max_by(|p, q| dir.dot(p).total_cmp(&dir.dot(q)))
                    .unwrap();
                if simplex.len() > 0 && dir.dot(&(w - simplex.corners()[0].w)) <= 1e-12 {
                    break;
                }
                let pair = VertexPair::default();
                let Some((to, distance2)) = simplex.add(Vertex { w, pair }, 1e-14, 100.0) else {
                    met[3] += 1;
                    let [a, b, c, d] = &simplex.tetrahedron().map(|v| v.w);
                    let inside = barycentric::tetrahedron(&Vec3::zeros(), [a, b, c, d]);
                    assert!(inside.distance2 <= 1e-24);
                    break;
                };
                assert!(distance2 <= before);
                (before, dir) = (distance2, to);
                let [a, b, c] = &simplex.corners().map(|v| v.w);
                let closest = barycentric::triangle(&Vec3::zeros(), a, b, c);
                assert!((closest.distance2.sqrt() - distance2.sqrt()).abs() < 1e-9);
                met[simplex.len() - 1] += 1;
            }
        }
        assert!(met.iter().all(|n| *n > 100), "{met:?}");
    }

    /// Adds corners of a plate thinner than the contact epsilon: the distance is that of the corners within the
    /// contact epsilon, though the side of a face on which the other corners lie is rounding.
    #[test]
    fn flat_simplex_has_the_distance_of_its_corners() {
        let mut r = Random::new(45);
        for _ in 0..5000 {
            let (turn, contact_eps) = (r.rotation(), 1e-6);
            let at = r.vector(1.0);
            let points: Vec<Vec3> = (0..8)
                .map(|_| {
                    turn * (at + r.vector(1.0)).component_mul(&Vec3::new(
                        1.0,
                        1.0,
                        0.5 * contact_eps,
                    ))
                })
                .collect();
            let mut simplex = Simplex::EMPTY;
            let mut dir = r.direction();
            for _ in 0..12 {
                let farthest = points
                    .iter()
                    .max_by(|p, q| dir.dot(p).total_cmp(&dir.dot(q)));
                let w = *farthest.unwrap();
                let pair = VertexPair::default();
                let Some((to, distance2)) = simplex.add(Vertex { w, pair }, contact_eps, 10.0)
                else {
                    break;
                };
                dir = to;
                let [a, b, c] = &simplex.corners().map(|v| v.w);
                let closest = barycentric::triangle(&Vec3::zeros(), a, b, c);
                let error = closest.distance2.sqrt() - distance2.sqrt();
                assert!(error <= 2.0 * contact_eps, "{error}");
            }
        }
    }

    #[test]
    fn compacted_set_keeps_corners() {
        let mut r = Random::new(44);
        let md = crate::test_shapes::difference(
            crate::test_shapes::ball(Vec3::zeros(), 1.0),
            crate::test_shapes::ball(Vec3::x() * 3.0, 1.0),
        );
        for _ in 0..100 {
            let mut query = SupportQuery::new(&md, None, 0.0);
            let mut set = VertexSet::<16>::EMPTY;
            while !set.is_full() {
                query
                    .evaluate_signed(&mut set, &r.direction(), 0.0)
                    .unwrap();
            }
            let mut simplex = Simplex::EMPTY;
            for _ in 0..3 {
                let pair = VertexPair {
                    a: r.within(0.0, 16.0) as u16,
                    b: r.within(0.0, 16.0) as u16,
                };
                let w = set.difference(pair);
                simplex.add(Vertex { w, pair }, 1e-14, 100.0);
            }
            set.compact(simplex.slots());
            assert!(set.len() < 9);
            for corner in simplex.corners() {
                assert_eq!(corner.w, set.difference(corner.pair));
            }
        }
    }
}
