// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The libraries under measurement, side by side in one process.
//!
//! System libccd and this library define the same symbols, so neither may be
//! linked: both are opened with `RTLD_LOCAL | RTLD_DEEPBIND`, which keeps each
//! one's names from the other, and nothing of this executable is exported.
//! [`Libraries::open`] asserts all of that, since a mix-up would go unnoticed:
//! the benchmark would compare a library with itself. The C callbacks come from
//! a shared object of their own, compiled when the program starts, so that every
//! method pays the same for them.

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_ulong, c_void};
use std::mem::MaybeUninit;
use std::path::{Path, PathBuf};
use std::process::Command;

use ccd::internals::ffi::{
    CCD_WARM_REALS, ccd_center_fn, ccd_distance_t, ccd_first_dir_fn, ccd_penetration_t,
    ccd_support_fn, ccd_t, ccd_vec3_t, ccd_warm_t,
};
use libloading::os::unix::{Library, RTLD_LAZY, RTLD_LOCAL};

use crate::harness;

/// glibc's flag; libloading does not name it.
const RTLD_DEEPBIND: c_int = 8;

type Query = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    *mut f64,
    *mut ccd_vec3_t,
    *mut ccd_vec3_t,
) -> c_int;
type Yes = unsafe extern "C-unwind" fn(*const c_void, *const c_void, *const ccd_t) -> c_int;

/// A state that is cold.
pub const COLD: ccd_warm_t = ccd_warm_t {
    reals: [0.0; CCD_WARM_REALS],
    words: [0; 4],
};

/// An answer of the extension's, to be filled.
///
/// # Safety
/// All bytes zero must be a `T`.
pub unsafe fn zeroed<T>() -> T {
    // SAFETY: the caller's contract.
    unsafe { MaybeUninit::zeroed().assume_init() }
}

type WarmDistance = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    f64,
    f64,
    f64,
    *mut ccd_warm_t,
    c_uint,
    *mut ccd_distance_t,
) -> c_int;
type WarmQuery = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    *mut ccd_warm_t,
    c_uint,
    *mut ccd_penetration_t,
) -> c_int;
type WarmMpr = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    *mut ccd_warm_t,
    *mut f64,
    *mut ccd_vec3_t,
    *mut ccd_vec3_t,
) -> c_int;

type WarmYes = unsafe extern "C-unwind" fn(
    *const c_void,
    *const c_void,
    *const ccd_t,
    *mut ccd_warm_t,
) -> c_int;

/// What libccd's API offers, of either library.
#[derive(Clone, Copy)]
pub struct Classic {
    pub mpr: Query,
    pub gjk: Query,
    pub mpr_intersect: Yes,
    pub first_dir: ccd_first_dir_fn,
}

/// What `<ccd/warm.h>` adds.
#[derive(Clone, Copy)]
pub struct Extension {
    pub guess: unsafe extern "C-unwind" fn(*mut ccd_warm_t, *const ccd_vec3_t),
    pub mpr: WarmMpr,
    pub mpr_intersect: WarmYes,
    pub local: WarmQuery,
    pub minimum: WarmQuery,
    pub distance: WarmDistance,
}

/// `pair_truth_t` of `c-tests/pairs.h`.
#[repr(C)]
#[derive(Clone, Copy, Default, Debug)]
pub struct Truth {
    pub depth: f64,
    pub gap: f64,
    pub normal: [f64; 3],
    pub init5: [f64; 3],
    pub init25: [f64; 3],
    pub init45: [f64; 3],
    pub cold: [f64; 3],
}

/// The shared object of `callbacks.c`.
#[derive(Clone, Copy)]
pub struct Callbacks {
    pub support: ccd_support_fn,
    pub center: ccd_center_fn,
    pub shape_size: unsafe extern "C" fn() -> usize,
    pub calls: unsafe extern "C" fn(*const c_void) -> c_ulong,
    pub set_open: unsafe extern "C" fn(*const c_char, c_int) -> *mut c_void,
    pub set_close: unsafe extern "C" fn(*mut c_void),
    pub set_count: unsafe extern "C" fn(*const c_void, *mut c_int, *mut c_int),
    pub set_pose: unsafe extern "C" fn(*const c_void, c_int, *mut c_void, *mut c_void, *mut Truth),
    pub set_mesh: unsafe extern "C" fn(
        *const c_void,
        c_int,
        *mut c_int,
        *mut *const f64,
        *mut c_int,
        *mut *const c_int,
    ),
    pub shape: unsafe extern "C" fn(
        *mut c_void,
        c_int,
        *const f64,
        *const f64,
        c_int,
        *const c_int,
        *const f64,
        *const f64,
    ),
    pub graph: unsafe extern "C" fn(c_int, *const c_int, c_int, *mut c_int) -> c_int,
    pub recording_open: unsafe extern "C" fn(*const c_char) -> *mut c_void,
    pub recording_close: unsafe extern "C" fn(*mut c_void),
    pub recording_count: unsafe extern "C" fn(*const c_void, *mut c_uint, *mut c_uint),
    pub recording_frame: unsafe extern "C" fn(*const c_void, c_uint, *mut c_void, *mut c_uint),
    pub recording_pair: unsafe extern "C" fn(
        *const c_void,
        c_uint,
        c_uint,
        usize,
        *mut c_uint,
        *mut c_uint,
        *mut f64,
        *mut f64,
    ),
    pub shape_pose: unsafe extern "C" fn(*const c_void, *mut f64, *mut f64, *mut c_int, *mut f64),
    pub shape_shift: unsafe extern "C" fn(*mut c_void, *const f64),
    pub begin: unsafe extern "C" fn(),
    pub end: unsafe extern "C" fn(),
}

/// Everything opened; lives as long as the process.
pub struct Libraries {
    pub callbacks: Callbacks,
    pub system: Classic,
    pub ours: Classic,
    pub extension: Extension,
    /// What `ccdImplementation` of ours says.
    pub implementation: String,
    /// The system library's file.
    pub system_file: String,
    /// Compiler and flags of the callbacks.
    pub compiler: String,
    /// Where compiled helpers go.
    work: tempfile::TempDir,
}

fn open(path: impl AsRef<Path>) -> Result<&'static Library, libloading::Error> {
    // SAFETY: libccd, and the objects compiled here, run no code when loaded. The
    // handle is leaked: every function pointer taken from it stays good.
    let library =
        unsafe { Library::open(Some(path.as_ref()), RTLD_LAZY | RTLD_LOCAL | RTLD_DEEPBIND) }?;
    Ok(Box::leak(Box::new(library)))
}

/// A function of a library, by name.
///
/// # Safety
/// `F` must be the type of that function.
pub unsafe fn function<F: Copy>(library: &Library, name: &str) -> F {
    // SAFETY: the caller's contract.
    let symbol = unsafe { library.get::<F>(name) };
    *symbol.unwrap_or_else(|e| panic!("{name}: {e}"))
}

impl Classic {
    fn of(library: &Library) -> Self {
        // SAFETY: the types are those of <ccd/ccd.h>.
        unsafe {
            Self {
                mpr: function(library, "ccdMPRPenetration"),
                gjk: function(library, "ccdGJKPenetration"),
                mpr_intersect: function(library, "ccdMPRIntersect"),
                first_dir: function(library, "ccdFirstDirDefault"),
            }
        }
    }

    /// A query's settings over the benchmark's callbacks.
    pub fn settings(&self, callbacks: &Callbacks, tolerance: f64) -> ccd_t {
        ccd_t {
            first_dir: Some(self.first_dir),
            support1: Some(callbacks.support),
            support2: Some(callbacks.support),
            center1: Some(callbacks.center),
            center2: Some(callbacks.center),
            max_iterations: c_ulong::MAX,
            epa_tolerance: tolerance,
            mpr_tolerance: tolerance,
            dist_tolerance: tolerance,
        }
    }
}

impl Libraries {
    /// Builds this library as shipped, compiles the callbacks, opens everything.
    pub fn open() -> Self {
        let work = tempfile::tempdir().expect("a temporary directory");
        let tests = harness::root().join("c-tests");
        let object = work.path().join("callbacks.so");
        let source = tests.join("lab/callbacks.c");
        let compiler = compile(&compiler(false), &[], &source, &object, &[])
            .unwrap_or_else(|e| panic!("the callbacks do not compile: {e}"));

        // The bare name: what the system's loader finds, which must not be ours. First,
        // because both answer to that name, and the loader takes the first that does:
        // also for a peer that needs libccd.
        let system = open("libccd.so.2")
            .expect("system libccd.so.2 (Debian: libccd2; without LD_LIBRARY_PATH)");
        let built = harness::library(harness::Precision::Double);
        let ours = open(built.dir.join("libccd.so.2")).expect("this library");
        // SAFETY: the type is that of <ccd/warm.h>; absent from libccd.
        let implementation = unsafe {
            let identity: unsafe extern "C-unwind" fn() -> *const c_char =
                function(ours, "ccdImplementation");
            CStr::from_ptr(identity()).to_string_lossy().into_owned()
        };
        assert!(implementation.starts_with("warmccd "), "{implementation}");
        // SAFETY: only looked up, never called.
        let absent =
            |library: &Library, name: &str| unsafe { library.get::<*const c_void>(name).is_err() };
        assert!(
            absent(system, "ccdImplementation"),
            "the system's libccd.so.2 is this library"
        );
        assert!(
            absent(&Library::this(), "ccdMPRPenetration"),
            "a libccd is global in this process: libraries would call its functions, not their own"
        );
        let callbacks = open(&object).expect("the callbacks");
        // SAFETY: the types are those of callbacks.c and <ccd/warm.h>.
        unsafe {
            Self {
                callbacks: Callbacks {
                    support: function(callbacks, "bench_support"),
                    center: function(callbacks, "bench_center"),
                    shape_size: function(callbacks, "bench_shape_size"),
                    calls: function(callbacks, "bench_calls"),
                    set_open: function(callbacks, "bench_set_open"),
                    set_close: function(callbacks, "bench_set_close"),
                    set_count: function(callbacks, "bench_set_count"),
                    set_pose: function(callbacks, "bench_set_pose"),
                    set_mesh: function(callbacks, "bench_set_mesh"),
                    shape: function(callbacks, "bench_shape"),
                    graph: function(callbacks, "bench_graph"),
                    recording_open: function(callbacks, "bench_recording_open"),
                    recording_close: function(callbacks, "bench_recording_close"),
                    recording_count: function(callbacks, "bench_recording_count"),
                    recording_frame: function(callbacks, "bench_recording_frame"),
                    recording_pair: function(callbacks, "bench_recording_pair"),
                    shape_pose: function(callbacks, "bench_shape_pose"),
                    shape_shift: function(callbacks, "bench_shape_shift"),
                    begin: function(callbacks, "bench_begin"),
                    end: function(callbacks, "bench_end"),
                },
                system: Classic::of(system),
                ours: Classic::of(ours),
                extension: Extension {
                    guess: function(ours, "ccdWarmGuess"),
                    mpr: function(ours, "ccdMPRPenetrationWarm"),
                    mpr_intersect: function(ours, "ccdMPRIntersectWarm"),
                    local: function(ours, "ccdPenetrationLocal"),
                    minimum: function(ours, "ccdPenetrationProven"),
                    distance: function(ours, "ccdSignedDistance"),
                },
                implementation,
                system_file: file_of(function(system, "ccdMPRPenetration")),
                compiler,
                work,
            }
        }
    }

    /// Compiles another helper of `c-tests/bench`, in C++, and opens it; why not, where that fails.
    pub fn helper(
        &self,
        source: &str,
        flags: &[&str],
        libraries: &[&str],
    ) -> Result<&'static Library, String> {
        let object = self
            .work
            .path()
            .join(format!("{source}{}.so", flags.concat().replace('/', "_")));
        let source: PathBuf = harness::root().join("c-tests/bench").join(source);
        compile(&compiler(true), flags, &source, &object, libraries)?;
        open(&object).map_err(|e| e.to_string())
    }

    /// One line: libraries, processor, compiler and flags, date.
    pub fn machine(&self) -> String {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let line = info.lines().find(|l| l.starts_with("model name"));
        let processor = line
            .and_then(|l| l.split_once(": "))
            .map_or("unknown processor", |l| l.1);
        let cores = std::thread::available_parallelism().map_or(0, usize::from);
        let date = Command::new("date").args(["-u", "+%F"]).output().ok();
        let date = date
            .map(|d| String::from_utf8_lossy(&d.stdout).trim().to_owned())
            .unwrap_or_default();
        let version = Command::new("rustc").arg("--version").output().ok();
        let version = version
            .map(|d| String::from_utf8_lossy(&d.stdout).trim().to_owned())
            .unwrap_or_default();
        format!(
            "{date}, {processor}, {cores} cores; {} ({version}, release), beside {}; callbacks: {}",
            self.implementation, self.system_file, self.compiler
        )
    }

    /// A C string's worth of path.
    pub fn c_path(path: &Path) -> CString {
        CString::new(path.to_str().expect("a path in UTF-8")).expect("a path without NUL")
    }
}

/// The file an address was loaded from, as the kernel tells it.
fn file_of(address: *const c_void) -> String {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    maps.lines()
        .find_map(|line| {
            let mut words = line.split_whitespace();
            let (low, high) = words.next()?.split_once('-')?;
            let range =
                usize::from_str_radix(low, 16).ok()?..usize::from_str_radix(high, 16).ok()?;
            range
                .contains(&(address as usize))
                .then(|| words.nth(4).unwrap_or("").to_owned())
        })
        .unwrap_or_default()
}

/// The compiler that callbacks and peers are compiled with: fast code, and on x86-64 that
/// of every machine of the last ten years.
fn compiler(cpp: bool) -> cc::Build {
    let mut compiler = harness::compiler(cpp);
    compiler.opt_level(3).debug(false);
    if cfg!(target_arch = "x86_64") {
        compiler.flag("-march=x86-64-v2");
    }
    compiler
}

/// Compiles one source file to a shared object; answers the command's essence.
fn compile(
    compiler: &cc::Build,
    flags: &[&str],
    source: &Path,
    object: &Path,
    libraries: &[&str],
) -> Result<String, String> {
    let root = harness::root();
    let mut compile = harness::compile_with(compiler);
    let tool = compile.get_program().to_owned();
    let own = compile.get_args().map(|arg| arg.to_string_lossy());
    let shown: Vec<String> = own.map(String::from).collect();
    let run = compile
        .args(flags)
        .args(["-shared", "-fPIC"])
        .arg("-I")
        .arg(root.join("include"))
        .arg("-I")
        .arg(root.join("c-tests"))
        .arg(source)
        .arg("-o")
        .arg(object)
        .args(libraries)
        .arg("-lm")
        .output()
        .map_err(|e| format!("{tool:?}: {e}"))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let version = Command::new(tool).arg("--version").output().ok();
    let version = version.map(|v| String::from_utf8_lossy(&v.stdout).into_owned());
    let version = version
        .as_deref()
        .and_then(|v| v.lines().next())
        .unwrap_or("");
    Ok(format!("{version}, {}", shown.join(" ")))
}
