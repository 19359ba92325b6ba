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

use ccd::internals::ffi::{CCD_WARM_REALS, ccd_penetration_t, ccd_t, ccd_vec3_t, ccd_warm_t};
use libloading::os::unix::{Library, RTLD_LAZY, RTLD_LOCAL};
use nalgebra::{Matrix3, Vector3};

use crate::harness;

/// glibc's flag; libloading does not name it.
const RTLD_DEEPBIND: c_int = 8;

/// A state that is cold.
pub const COLD: ccd_warm_t = ccd_warm_t { reals: [0.0; CCD_WARM_REALS], words: [0; 2] };

/// An answer of the extension's, to be filled.
///
/// # Safety
/// All bytes zero must be a `T`.
pub unsafe fn zeroed<T>() -> T {
    // SAFETY: the caller's contract.
    unsafe { MaybeUninit::zeroed().assume_init() }
}

/// Functions of a library's, with the names and types that they have in C.
macro_rules! functions {
    ($(#[$about:meta])* $Name:ident {
        $($(#[$what:meta])* $field:ident: fn $symbol:ident($($arg:ty),*) $(-> $ret:ty)?;)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        pub struct $Name {
            $($(#[$what])* pub $field: unsafe extern "C-unwind" fn($($arg),*) $(-> $ret)?,)*
        }
        impl $Name {
            fn of(library: &Library) -> Self {
                // SAFETY: the types are those of the C headers.
                unsafe { Self { $($field: function(library, stringify!($symbol)),)* } }
            }
        }
    };
}

type Object = *const c_void;
type Settings = *const ccd_t;
type Vector = *const ccd_vec3_t;
type Point = *mut ccd_vec3_t;
type State = *mut ccd_warm_t;
type Full = *mut ccd_penetration_t;

/// `ccdMPRPenetration` and `ccdGJKPenetration`.
pub type Query = unsafe extern "C-unwind" fn(Object, Object, Settings, *mut f64, Point, Point) -> c_int;

functions! {
    /// libccd's calls, of either library.
    Classic {
        mpr: fn ccdMPRPenetration(Object, Object, Settings, *mut f64, Point, Point) -> c_int;
        gjk: fn ccdGJKPenetration(Object, Object, Settings, *mut f64, Point, Point) -> c_int;
        mpr_intersect: fn ccdMPRIntersect(Object, Object, Settings) -> c_int;
        first_dir: fn ccdFirstDirDefault(Object, Object, Point);
    }
}

functions! {
    /// What `<ccd/warm.h>` adds.
    Extension {
        guess: fn ccdWarmGuess(State, Vector);
        mpr: fn ccdMPRPenetrationWarm(Object, Object, Settings, State, *mut f64, Point, Point) -> c_int;
        mpr_intersect: fn ccdMPRIntersectWarm(Object, Object, Settings, State) -> c_int;
        local: fn ccdPenetrationLocal(Object, Object, Settings, State, c_uint, Full) -> c_int;
        penetration: fn ccdPenetration(Object, Object, Settings, State, c_uint, Full) -> c_int;
        minimum: fn ccdPenetrationProven(Object, Object, Settings, State, c_uint, Full) -> c_int;
    }
}

/// `pair_truth_t` of `c-tests/harness/pairs.h`.
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

/// `bench_recorded_t` of `callbacks.c`: two bodies in a frame, and bounds on their signed depth.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct Recorded {
    pub a: c_uint,
    pub b: c_uint,
    pub frame: c_uint,
    pub lower: f64,
    pub upper: f64,
}

functions! {
    /// The shared object of `callbacks.c`, which says what each does.
    Callbacks {
        support: fn bench_support(Object, Vector, Point);
        center: fn bench_center(Object, Point);
        shape_size: fn bench_shape_size() -> usize;
        calls: fn bench_calls(Object) -> c_ulong;
        pose: fn bench_pose(Object, *mut f64, *mut f64);
        set: fn bench_set(*const c_char, *mut c_int, *mut c_int) -> Object;
        set_pose: fn bench_set_pose(Object, c_int, *mut c_void, *mut c_void, *mut Truth);
        recording: fn bench_recording(*const c_char, c_uint, *mut c_void, *mut Recorded) -> usize;
        begin: fn bench_begin();
        end: fn bench_end();
    }
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
    let library = unsafe { Library::open(Some(path.as_ref()), RTLD_LAZY | RTLD_LOCAL | RTLD_DEEPBIND) }?;
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
        let source = tests.join("bench/measuring/callbacks.c");
        let compiler =
            compile(false, &[], &source, &object, &[]).unwrap_or_else(|e| panic!("the callbacks do not compile: {e}"));

        // The bare name: what the system's loader finds, which must not be ours. First,
        // because both answer to that name, and the loader takes the first that does:
        // also for a peer that needs libccd.
        let system = open("libccd.so.2").expect("system libccd.so.2 (Debian: libccd2; without LD_LIBRARY_PATH)");
        let built = harness::library(harness::Precision::Double);
        let ours = open(built.dir.join("libccd.so.2")).expect("this library");
        // SAFETY: the type is that of <ccd/warm.h>; absent from libccd.
        let implementation = unsafe {
            let identity: unsafe extern "C-unwind" fn() -> *const c_char = function(ours, "ccdImplementation");
            CStr::from_ptr(identity()).to_string_lossy().into_owned()
        };
        assert!(implementation.starts_with("warmccd "), "{implementation}");
        // SAFETY: only looked up, never called.
        let absent = |library: &Library, name: &str| unsafe { library.get::<*const c_void>(name).is_err() };
        assert!(absent(system, "ccdImplementation"), "the system's libccd.so.2 is this library");
        assert!(
            absent(&Library::this(), "ccdMPRPenetration"),
            "a libccd is global in this process: libraries would call its functions, not their own"
        );
        let callbacks = open(&object).expect("the callbacks");
        // SAFETY: only its address is used.
        let anywhere = unsafe { function(system, "ccdMPRPenetration") };
        Self {
            callbacks: Callbacks::of(callbacks),
            system: Classic::of(system),
            ours: Classic::of(ours),
            extension: Extension::of(ours),
            implementation,
            system_file: file_of(anywhere),
            compiler,
            work,
        }
    }

    /// Compiles another helper of `c-tests/bench`, in C++, and opens it; why not, where that fails.
    pub fn helper(
        &self,
        name: &str,
        source: &str,
        flags: &[&str],
        libraries: &[&str],
    ) -> Result<&'static Library, String> {
        let object = self.work.path().join(format!("{name}.so"));
        let source: PathBuf = harness::root().join("c-tests/bench").join(source);
        compile(true, flags, &source, &object, libraries)?;
        open(&object).map_err(|e| e.to_string())
    }

    /// Rotation (local to world) and position of a shape of the callbacks'.
    pub fn pose(&self, shape: *mut c_void) -> (Matrix3<f64>, Vector3<f64>) {
        let (mut position, mut rotation) = ([0.0; 3], [0.0; 9]);
        // SAFETY: a shape, and room for its numbers.
        unsafe { (self.callbacks.pose)(shape, position.as_mut_ptr(), rotation.as_mut_ptr()) };
        (Matrix3::from_row_slice(&rotation), position.into())
    }

    /// One line: date, system, processor, libraries, compiler and flags.
    pub fn machine(&self) -> String {
        let cores = std::thread::available_parallelism().map_or(0, usize::from);
        let date = said(Command::new("date").args(["-u", "+%F"]));
        let version = said(Command::new("rustc").arg("--version"));
        format!(
            "{date}, {}, {cores} cores; {} ({version}, release), beside {}; callbacks: {}",
            harness::machine(),
            self.implementation,
            self.system_file,
            self.compiler
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
    let file = |line: &str| {
        let mut words = line.split_whitespace();
        let (low, high) = words.next()?.split_once('-')?;
        let [low, high] = [low, high].map(|hex| usize::from_str_radix(hex, 16).ok());
        let here = (low?..high?).contains(&(address as usize));
        here.then(|| words.nth(4).unwrap_or_default().to_owned())
    };
    maps.lines().find_map(file).unwrap_or_default()
}

/// Compiles one source file to a shared object: fast code, and on x86-64 that of every machine of
/// the last ten years. Answers the command's essence.
fn compile(cpp: bool, flags: &[&str], source: &Path, object: &Path, libraries: &[&str]) -> Result<String, String> {
    let mut compiler = harness::compiler(cpp);
    compiler.opt_level(3).debug(false);
    if cfg!(target_arch = "x86_64") {
        compiler.flag("-march=x86-64-v2");
    }
    let mut compile = harness::compile_with(&compiler);
    let tool = compile.get_program().to_owned();
    let own = compile.get_args().map(|arg| arg.to_string_lossy());
    let shown = own.collect::<Vec<_>>().join(" ");
    let root = harness::root();
    for include in ["include", "c-tests"] {
        compile.arg("-I").arg(root.join(include));
    }
    compile.args(flags).args(["-shared", "-fPIC"]).arg(source);
    compile.arg("-o").arg(object).args(libraries).arg("-lm");
    let run = compile.output().map_err(|e| format!("{tool:?}: {e}"))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let version = said(Command::new(tool).arg("--version"));
    let version = version.lines().next().unwrap_or_default();
    Ok(format!("{version}, {shown}"))
}

/// Output of a command, empty where it fails.
fn said(command: &mut Command) -> String {
    let output = command.output().map(|o| o.stdout).unwrap_or_default();
    String::from_utf8_lossy(&output).trim().to_owned()
}
