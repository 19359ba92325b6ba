// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Other libraries' solvers, called through the same C callbacks. Which of them
//! a run has depends on the machine; those it lacks are named, not skipped in silence.

use std::ffi::c_void;

use ccd::internals::ffi::{ccd_support_fn, ccd_vec3_t};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

use crate::lab::libraries::{Classic, Libraries, function};
use crate::lab::methods::{Answer, Method, classic};

/// A shape of the callbacks as parry's trait wants it, in world coordinates.
struct Convex {
    shape: *const c_void,
    support: ccd_support_fn,
}

impl SupportMap for Convex {
    #[inline]
    fn local_support_point(&self, dir: Vector) -> Vector {
        // parry may pass directions of any length; the callbacks are promised unit ones.
        let unit = dir.try_normalize().unwrap_or(Vector::X);
        let (dir, mut out) = (ccd_vec3_t { v: unit.into() }, ccd_vec3_t::default());
        // SAFETY: a shape of a scene, a direction and room for a point.
        unsafe { (self.support)(self.shape, &dir, &mut out) };
        Vector::from(out.v)
    }

    #[inline]
    fn local_support_point_toward(&self, dir: Vector) -> Vector {
        let (dir, mut out) = (ccd_vec3_t { v: dir.into() }, ccd_vec3_t::default());
        // SAFETY: as above; parry promises a unit direction here.
        unsafe { (self.support)(self.shape, &dir, &mut out) };
        Vector::from(out.v)
    }
}

/// parry3d's GJK and EPA from the centre difference, its tolerance built in.
pub fn parry<'a>(libraries: &'a Libraries) -> Method<'a> {
    Method::new("parry EPA", |_, pair| {
        let convex = |shape: *mut c_void| Convex {
            shape,
            support: libraries.callbacks.support,
        };
        let answer = contact_support_map_support_map_with_params(
            &Pose::IDENTITY,
            &convex(pair.a),
            &convex(pair.b),
            0.0,
            &mut VoronoiSimplex::new(),
            Some(Vector::from(pair.truth.cold)),
        );
        match answer {
            GJKResult::ClosestPoints(p, q, n) => Some(Answer {
                depth: (p - q).dot(n),
                dir: n.into(),
            }),
            _ => None,
        }
    })
}

/// The solvers of Debian's packages, compiled when the program starts.
pub struct Compiled {
    /// With their names and the tolerance that they are asked for.
    found: Vec<(&'static str, f64, Classic)>,
    /// What is not here, and why.
    pub missing: Vec<(&'static str, String)>,
}

impl Compiled {
    pub fn build(libraries: &Libraries) -> Self {
        let (mut found, mut missing) = (Vec::new(), Vec::new());
        for (name, tolerance, part, with) in [
            ("Bullet EPA", 1e-4, "-DPEER_BULLET", &[][..]),
            // Its own default: an assertion in it ends the process at others.
            ("FCL EPA", 1e-6, "-DPEER_FCL", &["-lfcl"]),
        ] {
            let [bullet, eigen] =
                ["bullet", "eigen3"].map(|dir| format!("-isystem/usr/include/{dir}"));
            let flags = ["-std=c++17", "-w", part, &bullet, &eigen];
            let of = |library| Classic {
                // SAFETY: peer_penetration has the type of libccd's queries.
                gjk: unsafe { function(library, "peer_penetration") },
                ..libraries.system
            };
            match libraries.helper("peers.cpp", &flags, with).map(of) {
                Ok(of) => found.push((name, tolerance, of)),
                Err(why) => missing.push((name, why)),
            }
        }
        Self { found, missing }
    }

    pub fn all<'a>(&self, libraries: &Libraries) -> impl Iterator<Item = Method<'a>> {
        self.found.iter().map(|&(name, tolerance, of)| {
            let settings = of.settings(&libraries.callbacks, tolerance);
            let method = Method::new(name, classic(of.gjk, settings, true));
            // Bullet's is built in.
            match name {
                "Bullet EPA" => method,
                _ => method.within(tolerance),
            }
        })
    }
}
