// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Other libraries' solvers, called through the same C callbacks. Which of them
//! a run has depends on the machine; those that it lacks are named.

use std::ffi::c_void;
use std::path::PathBuf;

use ccd::internals::ffi::{ccd_support_fn, ccd_vec3_t};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

use crate::measuring::libraries::{Classic, Libraries, function};
use crate::measuring::methods::{Answer, Method, classic};

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
    let method = Method::new("parry EPA", |_, pair| {
        let convex = |shape: *mut c_void| Convex { shape, support: libraries.callbacks.support };
        let answer = contact_support_map_support_map_with_params(
            &Pose::IDENTITY,
            &convex(pair.a),
            &convex(pair.b),
            0.0,
            &mut VoronoiSimplex::new(),
            Some(Vector::from(pair.truth.cold)),
        );
        match answer {
            GJKResult::ClosestPoints(p, q, n) => Some(Answer { depth: (p - q).dot(n), dir: n.into() }),
            _ => None,
        }
    });
    method.of_this_program()
}

/// One solver of `peers.cpp`: what its part is compiled with.
struct Part {
    name: &'static str,
    define: &'static str,
    /// As it is asked for; none where it is built in.
    tolerance: Option<f64>,
    flags: Vec<String>,
    with: Vec<String>,
}

/// The solvers of Debian's packages, and of what `engines.sh` has downloaded.
fn parts() -> [Part; 5] {
    let engines = engines();
    let at = |path: &str| engines.join(path).display().to_string();
    let include = |path: &str| format!("-isystem{path}");
    let runs_in = |path: &str| format!("-Wl,-rpath,{}", at(path));
    let coal = "coal/cmeel.prefix/lib";
    let part = |name, define, tolerance, flags, with| Part { name, define, tolerance, flags, with };
    [
        part("Bullet EPA", "-DPEER_BULLET", None, vec![include("/usr/include/bullet")], vec![]),
        // Its own default: an assertion in it ends the process at others.
        part("FCL EPA", "-DPEER_FCL", Some(1e-6), vec![include("/usr/include/eigen3")], vec!["-lfcl".to_owned()]),
        part(
            "MuJoCo 3 ccd",
            "-DPEER_MUJOCO",
            Some(1e-6),
            vec![],
            vec![at("mujoco/mujoco/libmujoco.so.3.12.0"), runs_in("mujoco/mujoco")],
        ),
        part(
            "Coal 3 EPA",
            "-DPEER_COAL",
            Some(1e-6),
            vec![include(&at("coal/cmeel.prefix/include")), include(&at("coal/cmeel.prefix/include/eigen3"))],
            vec![format!("-L{}", at(coal)), "-lcoal".to_owned(), runs_in(coal)],
        ),
        part("Jolt 5 EPA", "-DPEER_JOLT", None, vec![include(&at("jolt/vendor/joltc-sys/JoltC/JoltPhysics"))], vec![]),
    ]
}

/// Where `engines.sh` downloads to.
pub fn engines() -> PathBuf {
    // The folder of the build: the program is in `release/deps` of it.
    let program = std::env::current_exe().expect("a program has a path");
    program.ancestors().nth(3).expect("a folder of the build").join("engines")
}

/// The solvers, compiled when the program starts.
pub struct Compiled {
    /// With their names and the tolerance that they are asked for.
    found: Vec<(&'static str, Option<f64>, Classic)>,
    /// Engines that are missing, and why.
    pub missing: Vec<(&'static str, String)>,
}

impl Compiled {
    pub fn build(libraries: &Libraries) -> Self {
        let (mut found, mut missing) = (Vec::new(), Vec::new());
        for part in parts() {
            let mut flags = vec!["-std=c++17", "-w", part.define];
            flags.extend(part.flags.iter().map(String::as_str));
            let with: Vec<&str> = part.with.iter().map(String::as_str).collect();
            let of = |library| Classic {
                // SAFETY: peer_penetration has the type of libccd's queries.
                gjk: unsafe { function(library, "peer_penetration") },
                ..libraries.system
            };
            match libraries.helper(part.define, "peers.cpp", &flags, &with).map(of) {
                Ok(of) => found.push((part.name, part.tolerance, of)),
                Err(why) => missing.push((part.name, why)),
            }
        }
        Self { found, missing }
    }

    pub fn all<'a>(&self, libraries: &Libraries) -> impl Iterator<Item = Method<'a>> {
        self.found.iter().map(|&(name, tolerance, of)| {
            let settings = of.settings(&libraries.callbacks, tolerance.unwrap_or(1e-6));
            let method = Method::new(name, classic(of.gjk, settings, true));
            match tolerance {
                Some(tolerance) => method.within(tolerance),
                None => method,
            }
        })
    }
}
