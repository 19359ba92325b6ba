// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Other libraries' solvers, called through the same C callbacks. A run lists those that the machine lacks.

use std::ffi::c_void;
use std::path::PathBuf;

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

use crate::measuring::libraries::{Callbacks, Libraries, function};
use crate::measuring::methods::{Answer, Depth, Method, Start, depth_call, run_call};
use crate::measuring::scene::Pair;

/// A shape of the callbacks as parry's trait, in world coordinates.
struct Convex {
    shape: *const c_void,
    callbacks: Callbacks,
}

impl SupportMap for Convex {
    #[inline]
    fn local_support_point(&self, dir: Vector) -> Vector {
        // parry may pass directions of any length; those of the callbacks are unit.
        self.local_support_point_toward(dir.try_normalize().unwrap_or(Vector::X))
    }

    #[inline]
    fn local_support_point_toward(&self, dir: Vector) -> Vector {
        Vector::from(self.callbacks.support_point(self.shape, dir.into()))
    }
}

/// Returns parry3d's GJK and EPA from the centre difference.
fn parry(libraries: &Libraries) -> Method<'_> {
    let query = |pair: &Pair| {
        let convex = |shape: *mut c_void| Convex { shape, callbacks: libraries.callbacks };
        let result = contact_support_map_support_map_with_params(
            &Pose::IDENTITY,
            &convex(pair.a),
            &convex(pair.b),
            0.0,
            &mut VoronoiSimplex::new(),
            Some(Vector::from(pair.truth.cold)),
        );
        match result {
            GJKResult::ClosestPoints(p, q, n) => Some(Answer { depth: (p - q).dot(n), dir: n.into() }),
            _ => None,
        }
    };
    Method::new("parry EPA", Start::None, None, Box::new(query))
}

/// Returns the folder to which `engines.sh` downloads.
pub fn engines() -> PathBuf {
    // The program is in `release/deps` of the build folder.
    let program = std::env::current_exe().expect("a program has a path");
    program.ancestors().nth(3).expect("a folder of the build").join("engines")
}

/// The solvers of `peers.cpp`, compiled when the program starts.
#[derive(Default)]
pub struct Peers {
    /// Name, tolerance if it is not built in, and function.
    found: Vec<(&'static str, Option<f64>, Depth)>,
    /// The reason for each that is missing.
    missing: Vec<(&'static str, String)>,
}

impl Peers {
    /// Compiles them with Debian's packages or with what `engines.sh` has downloaded.
    pub fn build(libraries: &Libraries) -> Self {
        let mut peers = Self::default();
        let mut add = |name, part: &str, tolerance, headers: &[&str], linked: &[String]| {
            let include = |path: &&str| format!("-isystem{}", engines().join(path).display());
            let mut flags: Vec<String> = headers.iter().map(include).collect();
            flags.extend(["-std=c++17".to_owned(), "-w".to_owned(), format!("-DPEER_{part}")]);
            match libraries.peer(part, &flags, linked) {
                // SAFETY: peer_penetration has the type of ccdMPRPenetration.
                Ok(library) => peers.found.push((name, tolerance, unsafe { function(library, "peer_penetration") })),
                Err(why) => peers.missing.push((name, why.lines().next().unwrap_or_default().to_owned())),
            }
        };
        let file = |path: &str| engines().join(path).display().to_string();
        let runs_in = |path: &str| format!("-Wl,-rpath,{}", file(path));
        add("Bullet EPA", "BULLET", None, &["/usr/include/bullet"], &[]);
        // Its default tolerance: an assertion in it ends the process at others.
        add("FCL EPA", "FCL", Some(1e-6), &["/usr/include/eigen3"], &["-lfcl".to_owned()]);
        let mujoco = [file("mujoco/mujoco/libmujoco.so.3.12.0"), runs_in("mujoco/mujoco")];
        add("MuJoCo 3 ccd", "MUJOCO", Some(1e-6), &[], &mujoco);
        let headers = ["coal/cmeel.prefix/include", "coal/cmeel.prefix/include/eigen3"];
        let lib = "coal/cmeel.prefix/lib";
        let coal = [format!("-L{}", file(lib)), "-lcoal".to_owned(), runs_in(lib)];
        add("Coal 3 EPA", "COAL", Some(1e-6), &headers, &coal);
        add("Jolt 5 EPA", "JOLT", None, &["jolt/vendor/joltc-sys/JoltC/JoltPhysics"], &[]);
        peers
    }

    pub fn print_missing(&self) {
        for (name, why) in &self.missing {
            println!("not measured here: {name}: {why}");
        }
    }

    pub fn methods<'a>(&self, libraries: &'a Libraries) -> Vec<Method<'a>> {
        let compiled = self.found.iter().map(|&(name, tolerance, query)| {
            let settings = libraries.settings(false, tolerance.unwrap_or(1e-6));
            let query = run_call(libraries.ours.ccdWarmGuess, depth_call(query, true), Start::None, settings);
            Method::new(name, Start::None, tolerance, query)
        });
        compiled.chain([parry(libraries)]).collect()
    }
}
