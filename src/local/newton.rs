// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Newton's step to a minimum of the support function, from known support points.
//!
//! Reference: J. Nocedal, S. Wright, "Numerical Optimization", chapters 3 and 6 (a Newton step whose Hessian is
//! fitted to gradients).
//!
//! 1. *Gradient*: the support point of the upper bound, less its component along the direction.
//! 2. *Hessian*: from the two known support points with the closest directions for which D is smooth between them and
//!    the support point of the upper bound. Smooth: the distances e and f of two support points below each other's
//!    support planes ([`sphere_fit`](crate::minkowski::sphere_fit)) agree within [`SMOOTH_REL_TOL`].
//! 3. *Step*: to the minimum of the quadratic model; none if it has no minimum, or if the tangent of the step's angle
//!    is larger than [`MAX_TILT_TAN`].
//!
//! Outputs. The step is a direction to evaluate; it proves nothing.

use nalgebra::{Matrix2, Vector2};

use crate::local::{Model, Prediction};
use crate::math::{Vec3, normalise_unscaled, perpendicular};
use crate::minkowski::sphere_fit::MIN_ANGLE2;
use crate::minkowski::support_query::SupportPlane;
use crate::minkowski::tuning::{
    MAX_TILT_TAN, MIN_DETERMINANT_REL, MIN_NEWTON_WIDTH2, SMOOTH_REL_TOL,
};
use crate::minkowski::vertex_set::VertexSet;

/// Returns the minimum that Newton's step from the entry of the upper bound predicts; `None` if the curvature there
/// is unknown, or if the support function has no minimum near there.
///
/// For directions n + x, x perpendicular to n, the support function is h + g x + x R x / 2: g is the component of the
/// support point perpendicular to n, and R is its derivative. Divided by |n + x| it has the gradient g + (R − h) x.
pub fn newton_step<const N: usize>(set: &VertexSet<N>, upper: &SupportPlane) -> Option<Prediction> {
    let n = upper.dir;
    let at = upper.point.v;
    let first = closest_entry(set, upper, |_| true)?;
    let e1 = perpendicular(&n);
    let e2 = n.cross(&e1);
    let tangent = |v: &Vec3| Vector2::new(v.dot(&e1), v.dot(&e2));
    let dir_change = |k: usize| tangent(&set.dir(k)) / set.dir(k).dot(&n);
    let vertex_change =
        |k: usize| tangent(&(set.difference(VertexSet::<N>::pair_of_entry(k)) - at));
    let x1 = dir_change(first);
    // Not on a line with the first.
    let second = closest_entry(set, upper, |k| {
        let x = dir_change(k);
        x1.perp(&x).powi(2) > MIN_NEWTON_WIDTH2 * x.norm_squared() * x1.norm_squared()
    })?;
    let x2 = dir_change(second);
    let [y1, y2] = [first, second].map(vertex_change);
    let slope =
        Matrix2::from_columns(&[y1, y2]) * Matrix2::from_columns(&[x1, x2]).try_inverse()?;
    let curvature = (slope + slope.transpose()) * 0.5;
    let h = upper.depth;
    let hessian = curvature - Matrix2::identity() * h;
    let (a, c) = (hessian.m11, hessian.m22);
    let is_minimum = a > 0.0 && hessian.determinant() > MIN_DETERMINANT_REL * a * c;
    if !is_minimum {
        return None;
    }
    let g = tangent(&at);
    let x = -(hessian.try_inverse()? * g);
    let x2 = x.norm_squared();
    if !(x2 < MAX_TILT_TAN * MAX_TILT_TAN) {
        return None;
    }
    let value = (h + g.dot(&x) + 0.5 * x.dot(&(curvature * x))) / (1.0 + x2).sqrt();
    let dir = normalise_unscaled(&(n + e1 * x.x + e2 * x.y))?;
    let v = flattest_axis(&curvature);
    Some(Prediction {
        model: Model::Smooth(e1 * v.x + e2 * v.y),
        dir,
        value,
    })
}

/// Returns the entry with the direction closest to that of the upper bound, among the accepted entries that have
/// another direction and are on the same smooth part of D.
fn closest_entry<const N: usize>(
    set: &VertexSet<N>,
    upper: &SupportPlane,
    is_accepted: impl Fn(usize) -> bool,
) -> Option<usize> {
    let mut best = (None, 1.0 / (1.0 + MAX_TILT_TAN * MAX_TILT_TAN).sqrt());
    for k in 0..set.len() {
        let cosine = set.dir(k).dot(&upper.dir);
        let is_near = cosine > best.1 && cosine < 1.0 - 0.5 * MIN_ANGLE2;
        if is_near && is_smooth_between(upper, set, k) && is_accepted(k) {
            best = (Some(k), cosine);
        }
    }
    best.0
}

/// Returns whether D counts as smooth between the upper bound and entry `k`: e + f is positive, and e and f differ by
/// at most [`SMOOTH_REL_TOL`] of it.
fn is_smooth_between<const N: usize>(upper: &SupportPlane, set: &VertexSet<N>, k: usize) -> bool {
    let d = set.difference(VertexSet::<N>::pair_of_entry(k)) - upper.point.v;
    let (e, f) = (set.dir(k).dot(&d), -upper.dir.dot(&d));
    e + f > 0.0 && (e - f).abs() <= SMOOTH_REL_TOL * (e + f)
}

/// Returns the unit eigenvector of the least eigenvalue of a symmetric matrix. In closed form: nalgebra's
/// decomposition can panic.
fn flattest_axis(m: &Matrix2<f64>) -> Vector2<f64> {
    let (a, b, c) = (m.m11, m.m12, m.m22);
    let least = 0.5 * (a + c) - (0.5 * (a - c)).hypot(b);
    // Both are eigenvectors; the longer one is more exact.
    let (p, q) = (Vector2::new(b, least - a), Vector2::new(least - c, b));
    let longer = if p.norm_squared() > q.norm_squared() {
        p
    } else {
        q
    };
    let norm = longer.norm();
    if norm > 0.0 {
        longer / norm
    } else {
        Vector2::x()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::minkowski::support_query::SupportQuery;
    use crate::shapes::{Random, Rotation, difference, ellipsoid};

    #[test]
    fn the_flattest_axis_is_an_eigenvector() {
        let mut r = Random::new(3);
        for _ in 0..100 {
            let (a, b, c) = (r.within(0.1, 2.0), r.within(-1.0, 1.0), r.within(0.1, 2.0));
            let m = Matrix2::new(a, b, b, c);
            let v = flattest_axis(&m);
            let least = v.dot(&(m * v));
            assert!((m * v - v * least).norm() < 1e-12 && least <= a.min(c) + 1e-12);
        }
        assert_eq!(flattest_axis(&Matrix2::identity()), Vector2::x());
    }

    /// From directions near the shortest axis of an ellipsoid the step reaches it to second order.
    #[test]
    fn the_step_leads_to_the_shortest_axis() {
        let mut r = Random::new(4);
        for _ in 0..100 {
            let radii = Vec3::new(r.within(0.5, 0.6), r.within(0.8, 1.0), r.within(0.8, 1.0));
            let body = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
            let md = difference(body, |_: &Vec3| Vec3::zeros());
            let mut query = SupportQuery::new(&md, None, 0.0);
            let mut set = VertexSet::<8>::EMPTY;
            for y in [0.02, -0.03, 0.01] {
                for z in [0.03, -0.02] {
                    let n = Vec3::new(1.0, y, z).normalize();
                    query.evaluate(&mut set, &n).unwrap();
                }
            }
            let step = newton_step(&set, &query.upper).unwrap();
            assert!((step.dir - Vec3::x()).norm() < 2e-3, "{:?}", step.dir);
            assert!((step.value - radii.x).abs() < 1e-5, "{}", step.value);
            let Model::Smooth(flattest) = step.model else {
                panic!("a sphere");
            };
            assert!(flattest.x.abs() < 0.05);
        }
    }
}
