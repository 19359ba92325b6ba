// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The contract of libccd.so.2: symbols and ABI against the installed library, headers against the
//! installed headers, behaviour in C programs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::harness::{self, Link, Precision, Program};
#[cfg(not(feature = "single"))]
use crate::measuring::callgrind;

const NO_ARGS: [&str; 0] = [];

/// Returns the functions of the table in calls.h, and whether they belong to the extension.
fn calls() -> Vec<(&'static str, bool)> {
    let rows = include_str!("../../harness/calls.h").lines();
    let rows = rows.filter_map(|line| line.trim_start().strip_prefix("X(")).filter(|row| row.starts_with("ccd"));
    rows.map(|row| {
        let name = row.split([',', ')']).next().unwrap_or_default();
        (name, row.contains("EXTENSION"))
    })
    .collect()
}

/// Returns a program of this directory.
fn program(name: &str) -> Program {
    Program::new(format!("tests/contract/{name}.c")).strict()
}

/// Returns a program that runs on this library alone.
fn on_this_library(name: &str) -> Program {
    program(name).flag("-DOURS_ALONE")
}

/// Returns whether results are compared with Debian's libccd: it is double, and for processors other
/// than x86-64 it is compiled to round differently, with fused operations or in 80 bits.
fn is_compared() -> bool {
    Precision::CURRENT == Precision::Double && cfg!(target_arch = "x86_64")
}

/// Runs a tool on a file and returns its output.
fn output(command: &str, args: &[&str], file: &Path) -> String {
    let mut tool = harness::binutils(command);
    harness::must_succeed(tool.args(args).arg(file), command).stdout
}

fn ours(file: &str) -> PathBuf {
    harness::library(Precision::CURRENT).dir.join(file)
}

/// Returns the installed libccd.so.2 that the dynamic linker finds.
fn installed() -> PathBuf {
    program("objects")
        .link(Link::System)
        .build()
        .loaded_ccd()
        .expect("a program linked with the system's libccd loads it")
}

// --- symbols ------------------------------------------------------------------

/// Returns name, kind and, of data, size of a library's dynamic symbols.
fn dynamic_symbols(library: &Path) -> BTreeSet<String> {
    let symbols = output("readelf", &["--dyn-syms", "-W"], library);
    let symbol = |line: &str| {
        let column: Vec<&str> = line.split_whitespace().collect();
        let &[_, _, size, kind, binding, visibility, section, name] = column.as_slice() else {
            return None;
        };
        let defined = section.parse::<u32>().is_ok() && binding == "GLOBAL";
        let size = if kind == "OBJECT" { size } else { "" };
        defined.then(|| format!("{name} {kind} {visibility} {size}"))
    };
    symbols.lines().filter_map(symbol).collect()
}

#[test]
fn symbols_are_those_of_libccd_and_the_extension() {
    let mut expected: BTreeSet<String> = dynamic_symbols(&installed());
    assert_eq!(expected.len(), 18 + 3);
    let function = |name: &str| format!("{name} FUNC DEFAULT ");
    for (name, is_extension) in calls() {
        assert_eq!(expected.contains(&function(name)), !is_extension, "{name}");
        expected.insert(function(name));
    }
    assert_eq!(dynamic_symbols(&ours("libccd.so")), expected);
}

/// Checks that every call of the table has a C++ form and is called by what Miri runs,
/// and that the extension's headers declare the calls of the extension.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn calls_are_in_every_interface() {
    let read = |file: &str| std::fs::read_to_string(harness::root().join(file)).expect(file);
    let headers = read("include/ccd/warm.h") + &read("include/ccd/paper.h");
    let miri = read("c-tests/tests/extension/api.rs") + &read("c-tests/lab/miri.rs");
    let places = [("Miri", miri), ("ccd.hpp", read("include/ccd/ccd.hpp"))];
    assert!(calls().len() > 20);
    for (name, is_extension) in calls() {
        let call = format!("{name}(");
        assert_eq!(headers.contains(&call), is_extension, "{name}");
        for (place, text) in &places {
            // The C++ forms of MPR's calls are the warm ones.
            let is_c_alone = !is_extension && !name.starts_with("ccdGJK");
            // Called, or passed as an argument.
            let arguments = ["({})", "({},", ", {})", ", {},"].map(|form| form.replace("{}", name));
            let is_used = text.contains(&call) || arguments.iter().any(|form| text.contains(form));
            assert!(is_used || *place == "ccd.hpp" && is_c_alone, "{place}: {name}");
        }
    }
}

#[test]
fn archive_defines_no_other_ccd_symbol() {
    let exported = output("nm", &["-D", "--defined-only"], &ours("libccd.so"));
    let archive = output("nm", &["-g", "--defined-only"], &ours("libccd.a"));
    assert_eq!(names(&archive), names(&exported));
}

/// Checks that no function of the library can panic: the first that could would link Rust's messages
/// and backtraces, 300 KB.
#[test]
fn no_panic_is_linked() {
    let symbols = output("nm", &[], &ours("libccd.so"));
    assert!(symbols.contains(" t "), "no local symbols");
    let archive = ours("libccd.a");
    assert!(
        !symbols.contains("panicking"),
        "a panic is linked, or the linker is not GNU ld: `objdump -drC {}` shows which function of ccd-* calls core::panicking",
        archive.display()
    );
}

/// Checks that the shared library runs on glibc 2.28, as `cmake/packages/linux.sh` says.
#[test]
#[cfg(target_env = "gnu")]
fn glibc_of_2018_is_enough() {
    let script = harness::root().join("cmake/packages/symbols.sh");
    let script = script.to_str().expect("a path in UTF-8");
    let checked = output("sh", &[script], &ours("libccd.so"));
    assert!(checked.contains(" GLIBC_2."), "{checked}");
}

/// Checks that the library needs no function of libm: from one C library to another their last bits differ, and with them
/// would answers.
#[test]
#[cfg(target_env = "gnu")]
fn no_function_of_libm_is_needed() {
    let needed = output("readelf", &["-d"], &ours("libccd.so"));
    assert!(needed.contains("libc.so"), "{needed}");
    assert!(!needed.contains("libm.so"), "{needed}");
}

/// Checks that no function of the library calls an exported one, and that the dynamic linker has none to bind: another libccd
/// in the process, or an object that is preloaded, would get the call.
#[test]
fn no_call_inside_the_library_is_bound_by_the_dynamic_linker() {
    for file in ["libccd.a", "libccd.so"] {
        let relocations = output("readelf", &["-rW"], &ours(file));
        assert!(relocations.contains("malloc"), "{file}: no relocations");
        // Offset, information, type, value, symbol.
        let mut symbols = relocations.lines().filter_map(|line| line.split_whitespace().nth(4));
        let ccd = symbols.find(|symbol| symbol.trim_start_matches('_').starts_with("ccd"));
        assert_eq!(ccd, None, "{file}");
    }
}

/// Checks that all 18 functions return the same with Debian's libccd in the process, loaded before or after, and with an
/// object preloaded that has functions of the same names.
#[test]
#[cfg_attr(feature = "single", ignore = "Debian's libccd is double; the linking is the same in both precisions")]
fn functions_are_this_librarys_own_beside_another_libccd() {
    // Linked to a library though it looks all functions up.
    let flags = ["-D_POSIX_C_SOURCE=200809L", "-Wl,--no-as-needed", "-ldl"];
    let program = flags.into_iter().fold(program("two_libraries"), Program::flag).without_tools();
    let on_ours = program.clone().build();
    let alone = on_ours.run([ours("libccd.so.2")]).stdout;
    let words = include_str!("functions.h").split(['(', ')']);
    let named = words.filter(|word| word.trim_start_matches('_').starts_with("ccd"));
    let exported = dynamic_symbols(&installed());
    let exported = exported.iter().filter_map(|symbol| symbol.split_once(" FUNC")).map(|(name, _)| name);
    assert_eq!(named.collect::<BTreeSet<_>>(), exported.collect::<BTreeSet<_>>(), "functions.h");

    let before = program.link(Link::System).build().run([ours("libccd.so")]);
    assert_eq!(before.stdout, alone, "libccd loaded before");
    let after = on_ours.run([ours("libccd.so.2"), installed()]);
    assert_eq!(after.stdout, alone, "libccd loaded after");
    if harness::emulated() {
        println!("skipped: the emulator would be preloaded too");
        return;
    }
    let dir = tempfile::tempdir().expect("a directory");
    let recorder = dir.path().join("recorder.so");
    let source = harness::root().join("c-tests/tests/contract/recorder.c");
    let mut compile = harness::compiler(false);
    compile.args(["-shared", "-fPIC", "-I"]).arg(harness::root().join("c-tests")).arg(source).arg("-o").arg(&recorder);
    harness::must_succeed(&mut compile, "the compiler");
    let mut preloaded = on_ours.command();
    preloaded.arg(ours("libccd.so.2")).env("LD_PRELOAD", &recorder);
    assert_eq!(harness::must_succeed(&mut preloaded, "the program").stdout, alone, "a recorder preloaded");
}

#[test]
fn soname_is_that_of_libccd() {
    for library in [ours("libccd.so"), installed()] {
        let dynamic = output("readelf", &["-d"], &library);
        assert!(dynamic.contains("Library soname: [libccd.so.2]"), "{dynamic}");
        assert!(!dynamic.contains("VERDEF"), "symbols have versions");
    }
}

/// Checks the page's command that tells a library's precision.
#[cfg(target_arch = "x86_64")]
#[test]
fn precision_of_a_library_is_told() {
    let page = include_str!("../../../include/README.md");
    let command = page.lines().find(|line| line.starts_with("objdump -d")).expect("a command");
    for (library, precision) in [(ours("libccd.so.2"), Precision::CURRENT), (installed(), Precision::Double)] {
        let command = command.replace("libccd.so.2", "\"$1\"");
        let told = harness::must_succeed(Command::new("sh").args(["-c", &command, "sh"]).arg(library), "sh").stdout;
        assert_eq!(told.trim(), precision.name());
    }
}

/// Checks that a program that was compiled for double does not fail silently on the float build.
#[cfg(feature = "single")]
#[test]
fn program_of_doubles_ends_on_the_float_build() {
    let program = program("wrong_precision").flag("-UCCD_SINGLE").flag("-DCCD_DOUBLE").without_tools().build();
    for call in ["0", "1", "2", "3", "4"] {
        let (status, written) = program.run_to_end([call]);
        assert!(!status.success() && written.stderr.contains("compiled for double"), "{call}: {status} {written:?}");
    }
}

#[cfg(target_arch = "x86_64")]
#[test]
fn data_is_linked_by_copy_relocations() {
    let mut texts = BTreeSet::new();
    // clang accesses data of a library through the global offset table by default.
    let direct =
        harness::compiler_builder(false).get_compiler().is_like_clang().then_some("-fdirect-access-external-data");
    for flags in [["-fPIE", "-pie"], ["-fno-pie", "-no-pie"]] {
        let build = |program| flags.into_iter().chain(direct).fold(program, Program::flag).build();
        let mut programs = vec![build(program("objects"))];
        if is_compared() {
            let system = build(program("objects").system_headers().link(Link::System));
            programs.push(system.swapped());
            programs.push(system);
        }
        for program in programs {
            let relocations = output("readelf", &["-rW"], &program.path);
            for object in ["ccd_vec3_origin", "ccd_points_on_sphere", "ccd_points_on_sphere_len"] {
                assert!(
                    relocations.lines().any(
                        |line| line.contains("R_X86_64_COPY") && line.split_whitespace().any(|word| word == object)
                    ),
                    "{flags:?}: no copy of {object}\n{relocations}"
                );
            }
            texts.insert(program.run(NO_ARGS).stdout);
        }
    }
    assert_eq!(texts.len(), 1, "other data in another library or link");
}

/// Includes libccd's headers, and prints what their macros and inline functions compute.
const HEADERS: &str = "tests/contract/headers.c";

// --- headers ------------------------------------------------------------------

/// Returns the concatenated text of libccd's headers in a directory.
fn headers(include: &Path) -> String {
    let read = |name: &str| {
        let path = include.join(format!("ccd/{name}.h"));
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    ["ccd", "ccd_export", "compiler", "config", "quat", "vec3"].map(read).concat()
}

/// Returns libccd's identifiers in a text.
fn names(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|word| {
            let word = word.trim_start_matches('_');
            word.len() > 3 && (word.starts_with("ccd") || word.starts_with("CCD"))
        })
        .collect()
}

#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn headers_have_all_names_of_libccd_and_all_are_compared() {
    let theirs = headers(Path::new("/usr/include"));
    let ours = headers(&harness::root().join("include"));
    let (theirs, ours) = (names(&theirs), names(&ours));
    assert!(theirs.len() > 70, "{theirs:?}");
    assert_eq!(theirs.difference(&ours).next(), None, "missing");

    let path = harness::root().join("c-tests").join(HEADERS);
    let program = std::fs::read_to_string(path).expect("headers.c can be read");
    let program = names(&program);
    let exported = dynamic_symbols(&installed());
    let exported: Vec<_> = exported.iter().filter_map(|s| s.split(' ').next()).collect();
    // Include guards, and macros that the build of libccd defines, not its users.
    let guard = |name: &str| name.ends_with("_H__") || name.ends_with("_H");
    let builders = ["ccd_EXPORTS", "CCD_STATIC_DEFINE"];
    let mut not_compared = theirs.difference(&program);
    let lacks = not_compared.find(|n| !guard(n) && !exported.contains(n) && !builders.contains(n));
    assert_eq!(lacks, None, "headers.c");
}

#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn headers_compute_the_same_as_libccd() {
    let single_config = harness::root().join("c-tests/tests/contract/single");
    for (program, theirs, ours) in [
        (Program::new(HEADERS), "c99", "c99"),
        (Program::new(HEADERS), "gnu17", "c11"),
        (Program::new(HEADERS).in_cpp(), "c++11", "c++11"),
    ] {
        let program = program.without_tools();
        let double = program.link(Link::System);
        for (single, program) in [(false, double.clone()), (true, double.flag("-DCCD_SINGLE"))] {
            let mut of_theirs = program.clone().system_headers().flag(format!("-std={theirs}"));
            if single {
                of_theirs = of_theirs.flag("-I").flag(&single_config);
            }
            let [theirs, ours] =
                [of_theirs, program.flag(format!("-std={ours}"))].map(|program| program.build().run(NO_ARGS).stdout);
            assert!(ours.lines().count() > 1_000_000);
            let different = ours.lines().zip(theirs.lines()).find(|(a, b)| a != b);
            assert_eq!(different, None, "ours and libccd's, single: {single}");
            assert_eq!(ours.len(), theirs.len());
        }
    }
}

#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn headers_compile_without_warnings() {
    let path = |file: &str| harness::root().join(file);
    for (is_cpp, clang, standards) in
        [(false, "clang", ["c99", "c11", "gnu17"]), (true, "clang++", ["c++11", "c++14", "c++20"])]
    {
        for (is_clang, standard) in [false, harness::installed(clang)].iter().flat_map(|c| standards.map(|s| (*c, s))) {
            for precision in ["-DCCD_DOUBLE", "-DCCD_SINGLE", "-DUNDECIDED"] {
                let mut compile = if is_clang { Command::new(clang) } else { harness::compiler(is_cpp) };
                compile.args(["-x", if is_cpp { "c++" } else { "c" }, &format!("-std={standard}"), "-fsyntax-only"]);
                compile.args(["-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", precision, "-I"]);
                compile.arg(path("include")).arg(path("c-tests").join(HEADERS));
                harness::must_succeed(&mut compile, "the compiler");
            }
        }
    }
}

// --- behaviour ------------------------------------------------------------------

fn polytope_program() -> Program {
    program("polytope").flag("-std=gnu99")
}

/// Checks the polytope functions, whose elements are the same in the same order on libccd.
#[test]
fn polytopes() {
    let rounds = [harness::rounds(200)];
    let ours = polytope_program().build().run(&rounds).stdout;
    if is_compared() {
        let theirs = polytope_program().link(Link::System).build().run(&rounds).stdout;
        assert!(ours == theirs, "other polytopes than libccd's");
    }
}

/// Compares the instructions of the polytope functions, which FCL's EPA calls, with libccd's. (Counts of
/// instructions are exact, times are not.)
#[test]
#[cfg(not(feature = "single"))]
fn polytope_functions_take_no_more_instructions_than_libccd() {
    if !is_compared() {
        println!("skipped: compared on x86-64");
        return;
    }
    if !harness::installed("valgrind") || harness::emulated() {
        println!("skipped: valgrind is not installed, or not for this processor");
        return;
    }
    let profile = |link: Link| {
        let mut command = polytope_program().without_tools().link(link).build().command();
        let (_, profiles) = callgrind::run(command.arg("20"), &[]).unwrap_or_else(|error| panic!("{error}"));
        profiles.concat()
    };
    // A call is three lines: `cfn=FUNCTION`, `calls=...`, and one that ends in its instructions.
    let instructions = |profile: &str, function: &str| -> u64 {
        let (lines, call) = (profile.lines(), format!("cfn={function}"));
        let costs = lines.clone().zip(lines.skip(2)).filter(|(first, _)| *first == call);
        let costs = costs.map(|(_, cost)| cost.rsplit(' ').next().unwrap_or_default());
        costs.map(|cost| cost.parse::<u64>().expect("a number")).sum()
    };
    let profiles = [profile(Link::System), profile(Link::Shared)];
    for name in ["AddVertex", "AddEdge", "AddFace", "Nearest", "RecomputeDistances"] {
        let [theirs, ours] = profiles.each_ref().map(|profile| instructions(profile, &format!("ccdPt{name}")));
        println!("ccdPt{name}: libccd {theirs}, this library {ours} instructions");
        assert!(0 < ours && ours <= theirs, "ccdPt{name}: libccd {theirs}, ours {ours}");
    }
}

run_programs! {
    distances_of_a_point_to_segments_and_triangles: on_this_library("point_distance"), [harness::rounds(200_000)];
    callbacks: on_this_library("callbacks").flag("-lpthread"), NO_ARGS;
    arguments: on_this_library("arguments"), [harness::rounds(100)];
    objects_that_touch_are_a_miss: on_this_library("touches"), [harness::rounds(20_000)];
    memory: on_this_library("memory").flag("-DCOUNT_BLOCKS").without_tools(), NO_ARGS;
    memory_of_polytopes: polytope_program().flag("-DCOUNT_BLOCKS").without_tools(), ["50"];
    threads: on_this_library("threads").flag("-lpthread"), NO_ARGS;
    longjmp_out_of_callbacks: on_this_library("exceptions"), [harness::rounds(20)];
    longjmp_out_of_callbacks_of_the_archive: on_this_library("exceptions").link(Link::Static), [harness::rounds(20)];
    exceptions_out_of_callbacks: on_this_library("exceptions").in_cpp(), [harness::rounds(20)];
    exceptions_out_of_callbacks_of_the_archive: on_this_library("exceptions").in_cpp().link(Link::Static), [harness::rounds(20)];
}

/// Compares the types of `src/ffi` with what bindgen reads: libccd's of the installed header, the others of `warm.h`.
#[cfg(not(feature = "single"))]
#[test]
fn types_are_laid_out_as_in_the_headers() {
    use std::mem::{align_of, offset_of, size_of};

    use ccd::internals::ffi as ours;
    use warmccd_bindings::{libccd, warmccd};
    macro_rules! same {
        ($($header:ident::$name:ident { $($field:ident),* })*) => { $(
            assert_eq!(size_of::<ours::$name>(), size_of::<$header::$name>(), stringify!($name));
            assert_eq!(align_of::<ours::$name>(), align_of::<$header::$name>(), stringify!($name));
            // Every field of the header's type, or this pattern does not compile.
            let _ = |x: $header::$name| { let $header::$name { $($field: _),* } = x; };
            $(assert_eq!(
                offset_of!(ours::$name, $field),
                offset_of!($header::$name, $field),
                concat!(stringify!($name), ".", stringify!($field)),
            );)*
        )* };
    }
    same! {
        libccd::ccd_vec3_t { v }
        libccd::ccd_t {
            first_dir, support1, support2, center1, center2, max_iterations, epa_tolerance, mpr_tolerance, dist_tolerance
        }
        warmccd::ccd_warm_t { reals, words }
        warmccd::ccd_penetration_t {
            depth, depth_lower, dir, normal, pos, point1, point2, support_points, iterations, status
        }
        warmccd::ccd_distance_t {
            distance, distance_upper, normal, point1, point2, support_points, iterations, status
        }
        warmccd::ccd_manifold_cache_t { reals, words, checksum }
        warmccd::ccd_contact_t { point1, point2, depth, id }
        warmccd::ccd_check_t { size, noise, change, center_outside, dir }
    }
}
