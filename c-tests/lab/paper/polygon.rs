// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Intersection of two convex polygons in linear time (J. O'Rourke, C.-B. Chien, T. Olson, D. Naddor, "A new linear
//! algorithm for intersecting convex polygons", Computer Graphics and Image Processing 19, 1982).
//!
//! 1. An edge of each polygon is current. Where the two cross, the crossing is a corner of the intersection, and the polygon
//!    whose edge ends inside the other is the inner one from there on.
//! 2. Of the two edges the one that points towards the other's line without reaching it advances; else the one that ends
//!    outside. The end of an edge that the inner polygon leaves is a corner of the intersection.
//! 3. It ends after both polygons were passed once, or one of them twice.
//! 4. Without a crossing one polygon contains the other, or they are apart.

type Point = [f64; 2];

/// Polygon of the current inner boundary.
#[derive(Clone, Copy, PartialEq)]
enum Inner {
    Unknown,
    First,
    Second,
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns twice the area of a triangle; positive where c is left of the line from a to b.
fn area(a: Point, b: Point, c: Point) -> f64 {
    cross(minus(b, a), minus(c, a))
}

/// Returns the point at which two segments cross.
fn crossing(a: [Point; 2], b: [Point; 2]) -> Option<Point> {
    let (u, v) = (minus(a[1], a[0]), minus(b[1], b[0]));
    let denominator = cross(u, v);
    let s = cross(minus(b[0], a[0]), v) / denominator;
    let t = cross(minus(b[0], a[0]), u) / denominator;
    let is_on = |x: f64| (0.0..=1.0).contains(&x);
    (is_on(s) && is_on(t)).then(|| [a[0][0] + s * u[0], a[0][1] + s * u[1]])
}

fn contains(polygon: &[Point], p: Point) -> bool {
    (0..polygon.len()).all(|k| area(polygon[k], polygon[(k + 1) % polygon.len()], p) >= 0.0)
}

/// Writes the corners of the intersection of two convex polygons, whose corners are counterclockwise; none if they are apart.
/// A corner that lies on both boundaries may be written twice.
pub fn intersection(first: &[Point], second: &[Point], out: &mut Vec<Point>) {
    out.clear();
    let (n, m) = (first.len(), second.len());
    let (mut a, mut b) = (0, 0);
    let (mut passed_a, mut passed_b) = (0, 0);
    let mut inner = Inner::Unknown;
    while (passed_a < n || passed_b < m) && passed_a < 2 * n && passed_b < 2 * m {
        let edge_a = [first[(a + n - 1) % n], first[a]];
        let edge_b = [second[(b + m - 1) % m], second[b]];
        let turn = cross(minus(edge_a[1], edge_a[0]), minus(edge_b[1], edge_b[0]));
        let a_left_of_b = area(edge_b[0], edge_b[1], edge_a[1]);
        let b_left_of_a = area(edge_a[0], edge_a[1], edge_b[1]);
        if let Some(p) = crossing(edge_a, edge_b) {
            if inner == Inner::Unknown {
                (passed_a, passed_b) = (0, 0);
            }
            out.push(p);
            if a_left_of_b > 0.0 {
                inner = Inner::First;
            } else if b_left_of_a > 0.0 {
                inner = Inner::Second;
            }
        }
        if turn == 0.0 && a_left_of_b < 0.0 && b_left_of_a < 0.0 {
            // Parallel edges that face away from each other.
            out.clear();
            return;
        }
        let advance_a = if turn >= 0.0 { b_left_of_a > 0.0 } else { a_left_of_b <= 0.0 };
        if advance_a {
            if inner == Inner::First {
                out.push(first[a]);
            }
            a = (a + 1) % n;
            passed_a += 1;
        } else {
            if inner == Inner::Second {
                out.push(second[b]);
            }
            b = (b + 1) % m;
            passed_b += 1;
        }
    }
    if inner == Inner::Unknown {
        if contains(second, first[0]) {
            out.extend_from_slice(first);
        } else if contains(first, second[0]) {
            out.extend_from_slice(second);
        }
    }
}
