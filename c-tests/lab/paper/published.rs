// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's method as its published implementation runs it (<https://github.com/weigao95/mind-fcl>,
//! `mpr_incremental_penetration.hpp`): Algorithm 1 along a ray, Algorithm 3 from ray to ray, Algorithms 4 and 5 with the
//! shortcut of Section III-C.
//!
//! 1. A ray starts with its own support point. The first also needs two further points for a portal; later rays begin with
//!    the portal of the ray before.
//! 2. *find_portal*: while a face of the tetrahedron (−d, v1, v2, v3) separates its opposite corner from the ray, a support
//!    point along the face's normal replaces that corner.
//! 3. *Refinement*: along the ray the portal is a lower bound |p|, the support plane of its normal n an upper bound |q|, and
//!    |z| the support value of n. *Shortcut*: n is the next ray once |z| is below |p| by the tolerance.
//! 4. Portal and support plane within the tolerance end the ray; with the shortcut they end the search. Without it n is the
//!    next ray, until |q| changes by no more than the tolerance, or the direction by no more than 1e-3.
//!
//! Outputs: |q| and the ray's direction. The published code evaluates three support points again for its witness points, which
//! is left out here. This library's own implementation, which returns the portal's normal and its support value and makes
//! every portal anew, is `src/paper/gao.rs`.
//!
//! It is called as a library is: through a pointer to a C function with the arguments of `ccdPenetrationLocal`.

use std::ffi::{c_int, c_uint};
use std::hint::black_box;

use nalgebra::Vector3;
use warmccd_bindings::libccd::{ccd_t, ccd_vec3_t};
use warmccd_bindings::warmccd::{CCD_HIT, CCD_MISS, ccd_penetration_t, ccd_warm_t};

use crate::measuring::libraries::{Libraries, SupportFn};
use crate::measuring::methods::{Full, Method, Object, Start, full_call, run_call};

type V = Vector3<f64>;
type Portal = [V; 3];

const MAX_ITERATIONS: usize = 1000;
/// A change of the unit direction that ends Algorithm 3.
const SAME_DIRECTION: f64 = 1e-3;

/// D of two objects by their callbacks.
struct Difference {
    objects: [(Object, SupportFn); 2],
}

impl Difference {
    /// Returns a direction as a unit vector, and the support point along it.
    fn support(&self, dir: V) -> (V, V) {
        let n = dir.normalize();
        let point = |(object, support): (Object, SupportFn), n: V| {
            let mut out = ccd_vec3_t { v: [0.0; 3] };
            // SAFETY: an object with its callback, a direction and room for a point.
            unsafe { support(object, &ccd_vec3_t { v: n.into() }, &mut out) };
            V::from(out.v)
        };
        (n, point(self.objects[0], n) - point(self.objects[1], -n))
    }
}

/// The end of a ray.
enum End {
    /// The shortcut, with the next ray.
    Shortcut(V),
    /// Portal and support plane are within the tolerance: |q| and the portal's normal.
    Converged(f64, V),
    /// The ray passes through its own support point, at this distance.
    Degenerate(f64),
    /// No overlap, or the iterations are used up.
    Failed,
}

/// Replaces corners until the ray along d crosses the triangle; corners are then counterclockwise along it. Returns whether it
/// succeeds.
fn find_portal(md: &Difference, d: &V, portal: &mut Portal) -> bool {
    let sum = |v: &V| v.x.abs() + v.y.abs() + v.z.abs();
    let v0 = -d * portal.iter().map(V::norm).fold(0.0, f64::max);
    'search: for _ in 0..MAX_ITERATIONS {
        let [e1, e2, e3] = portal.map(|v| v - v0);
        if e1.dot(&e2.cross(&e3)) < 0.0 {
            portal.swap(1, 2);
        }
        // Each corner with its opposite face, whose normal points inwards.
        for k in [1, 2, 0] {
            let [i, j] = [portal[(k + 1) % 3] - v0, portal[(k + 2) % 3] - v0];
            let inwards = i.cross(&j);
            if v0.dot(&inwards) > f64::EPSILON * sum(&v0) * sum(&inwards) {
                let (n, point) = md.support(-inwards);
                if n.dot(&point) < 0.0 {
                    return false;
                }
                portal[k] = point;
                continue 'search;
            }
        }
        return true;
    }
    false
}

/// Follows the ray along unit d: Algorithm 1, or Algorithm 5. `portal` is that of the ray before, and then of this one.
fn follow(md: &Difference, d: V, portal: &mut Option<Portal>, tolerance: f64, has_shortcut: bool) -> End {
    let (_, first) = md.support(d);
    if d.dot(&first) < 0.0 {
        return End::Failed;
    }
    if portal.is_none() {
        let side = first.cross(&d);
        if side.norm() <= tolerance * first.norm() {
            return End::Degenerate(d.dot(&first));
        }
        let (n, second) = md.support(side);
        if n.dot(&second) < 0.0 {
            return End::Failed;
        }
        let normal = first.cross(&second);
        let (n, third) = md.support(normal * if normal.dot(&d) < 0.0 { -1.0 } else { 1.0 });
        if n.dot(&third) < 0.0 {
            return End::Failed;
        }
        *portal = Some([first, second, third]);
    }
    let Some(portal) = portal.as_mut() else { return End::Failed };
    if !find_portal(md, &d, portal) {
        return End::Failed;
    }
    for _ in 0..MAX_ITERATIONS {
        let mut normal = (portal[1] - portal[0]).cross(&(portal[2] - portal[0]));
        if normal.dot(&d) < 0.0 {
            portal.swap(1, 2);
            normal = -normal;
        }
        let (n, point) = md.support(normal);
        let (along, inner, z) = (n.dot(&d), n.dot(&portal[0]), n.dot(&point));
        if z < 0.0 {
            return End::Failed;
        }
        let (p, q) = (inner / along, z / along);
        if has_shortcut && p > z + tolerance {
            return End::Shortcut(n);
        }
        if z - inner <= tolerance {
            return End::Converged(q, n);
        }
        // update_portal: the ray crosses one of the triangles of the new point and an edge.
        let t = portal.map(|v| d.dot(&point.cross(&v)));
        let corner = if t[0] >= 0.0 && t[1] <= 0.0 {
            2
        } else if t[0] < 0.0 && t[2] >= 0.0 {
            1
        } else {
            0
        };
        portal[corner] = point;
    }
    End::Failed
}

/// Returns depth and direction of a local minimum from a unit direction. `keeps_portal`: a ray begins with that of the one
/// before.
fn penetration(md: &Difference, start: V, tolerance: f64, has_shortcut: bool, keeps_portal: bool) -> Option<(f64, V)> {
    let (mut d, mut portal, mut last_q) = (start, None, f64::NAN);
    for _ in 0..MAX_ITERATIONS {
        portal = portal.filter(|_| keeps_portal);
        d = match follow(md, d, &mut portal, tolerance, has_shortcut) {
            End::Shortcut(n) => n,
            End::Converged(q, n) => {
                let is_done = (q - last_q).abs() <= tolerance || (n - d).norm() < SAME_DIRECTION;
                if has_shortcut || is_done {
                    return Some((q, d));
                }
                last_q = q;
                n
            }
            End::Degenerate(depth) => return Some((depth, d)),
            End::Failed => return None,
        };
    }
    None
}

/// Computes a local minimum with the arguments of `ccdPenetrationLocal`, flags and witness points excepted. The state holds the
/// last direction, in which the search starts; a cold one is zero, and the search starts along the line of the centers.
unsafe extern "C-unwind" fn called<const HAS_SHORTCUT: bool, const KEEPS_PORTAL: bool>(
    obj1: Object,
    obj2: Object,
    ccd: *const ccd_t,
    warm: *mut ccd_warm_t,
    _want: c_uint,
    out: *mut ccd_penetration_t,
) -> c_int {
    // SAFETY: the settings, the state and the result of a query of `run_call`, which outlive it; callbacks of the objects.
    let (ccd, warm, out) = unsafe { (&*ccd, &mut *warm, &mut *out) };
    let (Some(support1), Some(support2)) = (ccd.support1, ccd.support2) else { return CCD_MISS };
    let mut start = V::from_column_slice(&warm.reals[..3]);
    if start == V::zeros() {
        let centers = [(obj1, ccd.center1), (obj2, ccd.center2)].map(|(object, center)| {
            let mut point = ccd_vec3_t { v: [0.0; 3] };
            if let Some(center) = center {
                // SAFETY: as above.
                unsafe { center(object, &mut point) };
            }
            V::from(point.v)
        });
        start = (centers[1] - centers[0]).normalize();
    }
    let md = Difference { objects: [(obj1, support1), (obj2, support2)] };
    let Some((depth, dir)) = penetration(&md, start, ccd.mpr_tolerance, HAS_SHORTCUT, KEEPS_PORTAL) else {
        return CCD_MISS;
    };
    warm.reals[..3].copy_from_slice(dir.as_slice());
    (out.depth, out.dir.v) = (depth, dir.into());
    CCD_HIT as c_int
}

/// Makes a state that starts from a unit direction.
unsafe extern "C-unwind" fn guess(warm: *mut ccd_warm_t, dir: *const ccd_vec3_t) {
    // SAFETY: a state and a direction.
    unsafe { (&mut (*warm).reals)[..3].copy_from_slice(&(*dir).v) };
}

/// Returns Algorithm 4/5, the same with new portals, or Algorithm 3, by name.
pub fn method(libraries: &Libraries, name: &'static str, start: Start, tolerance: f64) -> Method<'static> {
    let function: Full = match name {
        super::ALGORITHM_3 => called::<false, true>,
        super::NEW_PORTALS => called::<true, false>,
        _ => called::<true, true>,
    };
    let settings = libraries.settings(true, tolerance);
    // The compiler must not see which function it is.
    let query = run_call(guess, full_call(black_box(function)), start, settings);
    Method::new(name, start, Some(tolerance), query)
}
