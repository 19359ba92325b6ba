// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The libraries under measurement, side by side in one process.
//!
//! System libccd and this library define the same symbols, so neither may be linked: both are opened with
//! `RTLD_LOCAL | RTLD_DEEPBIND`, which keeps the names of each from the other, and nothing of this executable is exported.
//! [`Libraries::open`] asserts all of that: otherwise the benchmark might compare a library with itself. The C callbacks
//! are a shared object of their own, compiled when the program starts, so that every method pays the same for them.

use std::ffi::{CStr, c_char, c_int, c_ulong, c_void};
use std::path::Path;
use std::process::Command;

use libloading::os::unix::{Library, RTLD_LAZY, RTLD_LOCAL};
use warmccd_bindings::libccd::{Libccd, ccd_t, ccd_vec3_t};
use warmccd_bindings::warmccd::{CCD_WARM_REALS, Warmccd, ccd_warm_t};

use super::pair::Pair;
use crate::harness;

/// glibc's flag; libloading does not name it.
const RTLD_DEEPBIND: c_int = 8;

/// A state that is cold.
pub const COLD: ccd_warm_t = ccd_warm_t { reals: [0.0; CCD_WARM_REALS as usize], words: [0; 2] };

pub type SupportFn = unsafe extern "C-unwind" fn(*const c_void, *const ccd_vec3_t, *mut ccd_vec3_t);
type CenterFn = unsafe extern "C-unwind" fn(*const c_void, *mut ccd_vec3_t);

/// The functions of `callbacks.c`.
#[derive(Clone, Copy)]
pub struct Callbacks {
    support: SupportFn,
    center: CenterFn,
    pub calls: unsafe extern "C-unwind" fn(*const c_void) -> c_ulong,
    pub scene: unsafe extern "C-unwind" fn(*const c_char, *mut *mut Pair) -> usize,
    pub random: unsafe extern "C-unwind" fn(c_int, c_int, usize, *mut *mut Pair) -> usize,
    support_placed: SupportFn,
    pub place: unsafe extern "C-unwind" fn(
        c_int,
        *const f64,
        *const [f64; 3],
        *const [f64; 9],
        *const f64,
        c_int,
        *const c_int,
        *const c_int,
    ) -> *mut c_void,
    pub truth: unsafe extern "C-unwind" fn(*const c_void, *const c_void, f64, *mut [f64; 3], *mut f64) -> f64,
    pub sliding: unsafe extern "C-unwind" fn(usize, *mut *mut Pair) -> usize,
    pub floor: unsafe extern "C-unwind" fn(c_int, f64, c_int, usize, *mut *mut Pair) -> usize,
    pub counted: unsafe extern "C-unwind" fn(unsafe extern "C-unwind" fn(*mut c_void), *mut c_void),
    pub end: unsafe extern "C-unwind" fn(),
}

impl Callbacks {
    /// Returns the point of a shape farthest along a unit direction.
    #[inline]
    pub fn support_point(&self, shape: *const c_void, dir: [f64; 3]) -> [f64; 3] {
        let (dir, mut out) = (ccd_vec3_t { v: dir }, ccd_vec3_t { v: [0.0; 3] });
        // SAFETY: a shape of a scene, a direction and room for a point.
        unsafe { (self.support)(shape, &dir, &mut out) };
        out.v
    }
}

/// Everything opened; lives as long as the process.
pub struct Libraries {
    pub callbacks: Callbacks,
    pub system: &'static Libccd,
    pub ours: &'static Warmccd,
    /// One line: date, system, processor, libraries, compiler and flags.
    pub machine: String,
    /// One line: what instructions of a query depend on besides the source: compilers, flags, processor family.
    pub toolchain: String,
    /// Folder of compiled helpers.
    work: tempfile::TempDir,
}

fn open(path: impl AsRef<Path>) -> Result<Library, libloading::Error> {
    // SAFETY: libccd, and the objects compiled here, run no code when loaded.
    unsafe { Library::open(Some(path.as_ref()), RTLD_LAZY | RTLD_LOCAL | RTLD_DEEPBIND) }
}

/// Keeps what is opened: every function pointer taken from it stays good.
fn leak<T>(opened: T) -> &'static T {
    Box::leak(Box::new(opened))
}

/// Finds a function of a library by name.
///
/// # Safety
/// `F` must be the type of that function.
pub unsafe fn function<F: Copy>(library: &Library, name: &str) -> F {
    // SAFETY: the caller's contract.
    let symbol = unsafe { library.get::<F>(name.as_bytes()) };
    *symbol.unwrap_or_else(|e| panic!("{name}: {e}"))
}

impl Libraries {
    /// Builds this library as shipped, compiles the callbacks, opens everything.
    pub fn open() -> Self {
        let work = tempfile::tempdir().expect("a temporary directory");
        let object = work.path().join("callbacks.so");
        let compiler = compile(false, &[], "bench/measuring/callbacks.c", &object, &[]);
        let compiler = compiler.unwrap_or_else(|e| panic!("the callbacks do not compile: {e}"));

        // The bare name: what the system's loader finds, which must not be this library. First, because both have that
        // name, and the loader takes the first, also for a peer that needs libccd.
        let system = open("libccd.so.2").expect("system libccd.so.2 (Debian: libccd2; without LD_LIBRARY_PATH)");
        let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
        let system_file = maps.split_whitespace().find(|word| word.contains("/libccd.so")).unwrap_or_default();
        let built = harness::library(harness::Precision::Double);
        let ours = open(built.dir.join("libccd.so.2")).expect("this library");
        // SAFETY: only looked up, never called.
        let absent = |library: &Library, name: &str| unsafe { library.get::<*const c_void>(name.as_bytes()).is_err() };
        assert!(absent(&system, "ccdImplementation"), "the system's libccd.so.2 is this library");
        assert!(
            absent(&Library::this(), "ccdMPRPenetration"),
            "a libccd is global in this process: libraries would call its functions, not their own"
        );
        // SAFETY: the libraries whose headers the tables are made of.
        let (system, ours) = unsafe { (Libccd::from_library(system), Warmccd::from_library(ours)) };
        let (system, ours) = (leak(system.expect("libccd's functions")), leak(ours.expect("this library's functions")));
        // SAFETY: returns a string of the library.
        let implementation = unsafe { CStr::from_ptr(ours.ccdImplementation()) }.to_string_lossy().into_owned();
        assert!(implementation.starts_with("warmccd "), "{implementation}");
        let object = leak(open(&object).expect("the callbacks"));
        // SAFETY: the types are those of callbacks.c.
        let callbacks = unsafe {
            Callbacks {
                support: function(object, "bench_support"),
                center: function(object, "bench_center"),
                calls: function(object, "bench_calls"),
                scene: function(object, "bench_scene"),
                random: function(object, "bench_random"),
                support_placed: function(object, "bench_support_placed"),
                place: function(object, "bench_place"),
                truth: function(object, "bench_truth"),
                sliding: function(object, "bench_sliding"),
                floor: function(object, "bench_floor"),
                counted: function(object, "bench_counted"),
                end: function(object, "bench_end"),
            }
        };
        let rustc = output_of(Command::new("rustc").arg("--version"));
        let machine = format!(
            "{}, {}, {} cores; {implementation} ({rustc}, release), beside {system_file}; callbacks: {compiler}",
            output_of(Command::new("date").args(["-u", "+%F"])),
            harness::machine(),
            std::thread::available_parallelism().map_or(0, usize::from),
        );
        let toolchain = format!("{rustc}; callbacks: {compiler}; {}", harness::processor_family());
        Self { callbacks, system, ours, machine, toolchain, work }
    }

    /// Returns the settings of a query of this library, or of system libccd, over the benchmark's callbacks.
    pub fn settings(&self, is_ours: bool, tolerance: f64) -> ccd_t {
        let first_dir = if is_ours { self.ours.ccdFirstDirDefault } else { self.system.ccdFirstDirDefault };
        let Callbacks { support, center, .. } = self.callbacks;
        ccd_t {
            first_dir: Some(first_dir),
            support1: Some(support),
            support2: Some(support),
            center1: Some(center),
            center2: Some(center),
            max_iterations: c_ulong::MAX,
            epa_tolerance: tolerance,
            mpr_tolerance: tolerance,
            dist_tolerance: tolerance,
        }
    }

    /// From here on all shapes are those that `place` returns: polytopes climb over their edges.
    pub fn use_placed(&mut self) {
        self.callbacks.support = self.callbacks.support_placed;
    }

    /// Compiles a part of `peers.cpp` and opens it; returns why not, if that fails.
    pub fn peer(&self, part: &str, flags: &[String], linked: &[String]) -> Result<&'static Library, String> {
        let object = self.work.path().join(format!("{part}.so"));
        compile(true, flags, "lab/charts/peers.cpp", &object, linked)?;
        open(&object).map(leak).map_err(|e| e.to_string())
    }
}

/// Compiles a source file of `c-tests` to a shared object: fast code, and on x86-64 that of every machine of the last ten years.
/// Returns the compiler and its usual flags.
fn compile(cpp: bool, flags: &[String], source: &str, object: &Path, linked: &[String]) -> Result<String, String> {
    let mut compiler = harness::compiler_builder(cpp);
    compiler.opt_level(3).debug(false).pic(true);
    if cfg!(target_arch = "x86_64") {
        compiler.flag("-march=x86-64-v2");
    }
    let mut compile = compiler.try_get_compiler().map_err(|e| e.to_string())?.to_command();
    let tool = compile.get_program().to_owned();
    let own = compile.get_args().map(|arg| arg.to_string_lossy());
    let shown = own.collect::<Vec<_>>().join(" ");
    let tests = harness::root().join("c-tests");
    compile.arg("-I").arg(harness::root().join("include")).arg("-I").arg(&tests).args(flags);
    compile.arg("-shared").arg(tests.join(source));
    compile.arg("-o").arg(object).args(linked).arg("-lm");
    let run = compile.output().map_err(|e| format!("{tool:?}: {e}"))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let version = output_of(Command::new(tool).arg("--version"));
    let version = version.lines().next().unwrap_or_default();
    Ok(format!("{version}, {shown}"))
}

/// Returns the output of a command, empty if it fails.
fn output_of(command: &mut Command) -> String {
    let output = command.output().map(|o| o.stdout).unwrap_or_default();
    String::from_utf8_lossy(&output).trim().to_owned()
}
