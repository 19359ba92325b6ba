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
                lower: 0.0,
            }),
            _ => None,
        }
    })
}

/// The solvers of Debian's packages, compiled when the program starts.
pub struct Compiled {
    bullet: Option<Classic>,
    fcl: Option<Classic>,
    coal: Option<Classic>,
    /// What is not here, and why.
    pub missing: Vec<(&'static str, String)>,
}

/// One part of peers.cpp, or why it does not compile.
fn peer(libraries: &Libraries, flags: &[&str], with: &[&str]) -> Result<Classic, String> {
    let flags = [&["-std=c++17", "-w"], flags].concat();
    let library = libraries.helper("peers.cpp", &flags, with)?;
    Ok(Classic {
        // SAFETY: peer_penetration has the type of libccd's queries.
        gjk: unsafe { function(library, "peer_penetration") },
        ..libraries.system
    })
}

const BULLET: [&str; 3] = ["-DPEER_BULLET", "-isystem", "/usr/include/bullet"];

/// Bullet's btGjkEpa3 alone, or why it is not here.
pub fn bullet<'a>(libraries: &Libraries) -> Result<Method<'a>, String> {
    peer(libraries, &BULLET, &[]).map(|of| bullet_of(libraries, of))
}

fn bullet_of<'a>(libraries: &Libraries, of: Classic) -> Method<'a> {
    Method::new(
        "Bullet EPA",
        classic(of.gjk, of.settings(&libraries.callbacks, 1e-4), true),
    )
}

impl Compiled {
    pub fn build(libraries: &Libraries) -> Self {
        let mut missing = Vec::new();
        let mut build = |name, flags: &[&str], with: &[&str]| match peer(libraries, flags, with) {
            Ok(of) => Some(of),
            Err(why) => {
                missing.push((name, why));
                None
            }
        };
        // Coal is in no Debian package: `pip install --target DIR coal-library`, then
        // COAL_PREFIX=DIR/cmeel.prefix names its headers and libraries.
        let prefix = std::env::var("COAL_PREFIX").unwrap_or_default();
        let [headers, folder, search] = [
            format!("-I{prefix}/include"),
            format!("-L{prefix}/lib"),
            format!("-Wl,-rpath,{prefix}/lib"),
        ];
        let eigen = "/usr/include/eigen3";
        Self {
            bullet: build("Bullet", &BULLET, &[]),
            fcl: build("FCL", &["-DPEER_FCL", "-isystem", eigen], &["-lfcl"]),
            coal: build(
                "Coal",
                &["-DPEER_COAL", &headers, "-isystem", eigen],
                &[&folder, &search, "-lcoal"],
            ),
            missing,
        }
    }

    /// Bullet's btGjkEpa3, double.
    pub fn bullet<'a>(&self, libraries: &Libraries) -> Option<Method<'a>> {
        Some(bullet_of(libraries, self.bullet?))
    }

    /// FCL's own EPA.
    pub fn fcl<'a>(&self, libraries: &Libraries, tolerance: f64) -> Option<Method<'a>> {
        let of = self.fcl?;
        let settings = of.settings(&libraries.callbacks, tolerance);
        Some(Method::new("FCL EPA", classic(of.gjk, settings, true)).within(tolerance))
    }

    /// Coal's EPA.
    pub fn coal<'a>(&self, libraries: &Libraries, tolerance: f64) -> Option<Method<'a>> {
        let of = self.coal?;
        let settings = of.settings(&libraries.callbacks, tolerance);
        Some(Method::new("Coal EPA", classic(of.gjk, settings, true)).within(tolerance))
    }
}
