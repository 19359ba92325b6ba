// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The contract of libccd.so.2, line by line: symbols and ABI against the installed
//! library, headers against the installed headers, behaviour in C programs.

#[path = "../../harness/mod.rs"]
mod harness;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use harness::{Executable, Precision, Program};

const NO_ARGS: [&str; 0] = [];

/// The functions of the table in calls.h, and whether they are the extension's.
fn calls() -> Vec<(&'static str, bool)> {
    let rows = include_str!("../../harness/calls.h").lines();
    let rows = rows.filter_map(|line| line.trim_start().strip_prefix("X(")).filter(|row| row.starts_with("ccd"));
    rows.map(|row| {
        let name = row.split([',', ')']).next().unwrap_or_default();
        (name, row.contains("EXTENSION"))
    })
    .collect()
}

/// A program that includes everything it needs from this directory.
fn program(name: &str) -> Program {
    Program::c(name).source(format!("tests/contract/{name}.c")).flag("-pedantic").flag("-Werror")
}

/// A program that runs on this library alone.
fn alone(name: &str) -> Program {
    program(name).flag("-DOURS_ALONE").link_ours_shared()
}

/// Debian's libccd is double: comparisons with it are made in the double run. And on
/// x86-64: for other processors it is compiled to round otherwise than its headers say,
/// with fused operations or in 80 bits.
fn compared() -> bool {
    Precision::CURRENT == Precision::Double && cfg!(target_arch = "x86_64")
}

/// Output of a tool about a file.
fn output(command: &str, args: &[&str], file: &Path) -> String {
    let mut tool = harness::binutils(command);
    harness::must_succeed(tool.args(args).arg(file), command).stdout
}

fn ours(file: &str) -> PathBuf {
    harness::library(Precision::CURRENT).dir.join(file)
}

/// The installed libccd.so.2, as the dynamic linker finds it.
fn installed() -> PathBuf {
    program("objects")
        .precision(Precision::Double)
        .link_system()
        .build()
        .loaded_ccd()
        .expect("a program linked with the system's libccd loads it")
}

// --- symbols ------------------------------------------------------------------

/// Name, kind and size of a library's dynamic symbols; the size of data only.
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
fn shared_library_exports_libccd_s_symbols_and_the_extension() {
    let mut expected: BTreeSet<String> = dynamic_symbols(&installed());
    assert_eq!(expected.len(), 18 + 3);
    let function = |name: &str| format!("{name} FUNC DEFAULT ");
    for (name, is_extension) in calls() {
        assert_eq!(expected.contains(&function(name)), !is_extension, "{name}");
        expected.insert(function(name));
    }
    assert_eq!(dynamic_symbols(&ours("libccd.so")), expected);
}

/// Every call of the table is in C++ too, and called from Rust under Miri; those of the extension
/// are declared by its headers.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn every_call_is_everywhere() {
    let read = |file: &str| std::fs::read_to_string(harness::root().join(file)).expect(file);
    let headers = read("include/ccd/warm.h") + &read("include/ccd/paper.h");
    let places = [("api.rs", read("c-tests/tests/extension/api.rs")), ("ccd.hpp", read("include/ccd/ccd.hpp"))];
    assert!(calls().len() > 20);
    for (name, is_extension) in calls() {
        let call = format!("{name}(");
        assert_eq!(headers.contains(&call), is_extension, "{name}");
        for (place, text) in &places {
            // In C++ MPR's calls are their warm forms, with or without a state.
            let is_c_alone = !is_extension && !name.starts_with("ccdGJK");
            // Called, or handed over to be called.
            let ways = ["({})", "({},", ", {})", ", {},"].map(|way| way.replace("{}", name));
            let named = text.contains(&call) || ways.iter().any(|way| text.contains(way));
            assert!(named || *place == "ccd.hpp" && is_c_alone, "{place}: {name}");
        }
    }
}

#[test]
fn archive_defines_no_other_ccd_symbol() {
    let names = |symbols: String| -> BTreeSet<String> {
        symbols
            .lines()
            .filter_map(|line| line.split_whitespace().nth(2))
            .filter(|name| name.starts_with("ccd") || name.starts_with("__ccd"))
            .map(String::from)
            .collect()
    };
    let exported = output("nm", &["-D", "--defined-only"], &ours("libccd.so"));
    let archive = output("nm", &["-g", "--defined-only"], &ours("libccd.a"));
    assert_eq!(names(archive), names(exported));
}

/// No function of the library can panic. With the first that could, Rust's messages and
/// backtraces would be linked: 300 KB. Where a bound is not seen by the compiler, and which
/// function it stands in, the test tells.
#[test]
fn no_panic_is_linked() {
    let symbols = output("nm", &[], &ours("libccd.so"));
    assert!(symbols.contains(" t "), "no local symbols: nothing to see");
    if !symbols.contains("panicking") {
        return;
    }
    let code = output("objdump", &["-drC"], &ours("libccd.a"));
    let (mut ours, mut function, mut found) = (false, "", BTreeSet::new());
    for line in code.lines() {
        if line.contains("file format") {
            ours = line.starts_with("ccd");
        } else if line.ends_with(">:") {
            function = line.split_once(' ').map_or(line, |(_, name)| name);
        } else if line.contains("R_") && (line.contains("core::panick") || line.contains("_fail")) {
            let called = line.split_whitespace().last().unwrap_or_default();
            if ours {
                found.insert(format!("{function} {called}"));
            }
        }
    }
    panic!("Rust's panics are linked, or another linker than GNU ld is used: {found:#?}");
}

#[test]
fn soname_is_libccd_s() {
    for library in [ours("libccd.so"), installed()] {
        let dynamic = output("readelf", &["-d"], &library);
        assert!(dynamic.contains("Library soname: [libccd.so.2]"), "{dynamic}");
        assert!(!dynamic.contains("VERDEF"), "symbols have versions");
    }
}

#[cfg(target_arch = "x86_64")]
#[test]
fn executables_reach_the_data_by_copy_relocations() {
    let mut texts = BTreeSet::new();
    let compiler = harness::compiler(false).get_compiler();
    // clang reaches data of a library through a table of addresses unless told otherwise.
    let direct = if compiler.is_like_clang() { "-fdirect-access-external-data" } else { "" };
    for flags in [["-fPIE", "-pie"], ["-fno-pie", "-no-pie"]] {
        let build = |program: Program| {
            let flags = flags.into_iter().chain([direct]).filter(|flag| !flag.is_empty());
            flags.fold(program, Program::flag).build()
        };
        let mut programs = vec![build(program("objects").link_ours_shared())];
        if compared() {
            let system = build(program("objects").system_headers().link_system());
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
    assert_eq!(texts.len(), 1, "the same data whatever the library and the link");
}

// --- headers ------------------------------------------------------------------

/// All of libccd's headers in a directory, one after the other.
fn headers(include: &Path) -> String {
    let read = |name: &str| {
        let path = include.join(format!("ccd/{name}.h"));
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    ["ccd", "ccd_export", "compiler", "config", "quat", "vec3"].map(read).concat()
}

/// Every identifier of libccd's: types, tags, functions, macros. (That it stands in no comment alone
/// the compiler sees: each is in headers.c.)
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
fn headers_have_every_name_of_libccd_s_and_every_name_is_compared() {
    let theirs = headers(Path::new("/usr/include"));
    let ours = headers(&harness::root().join("include"));
    let (theirs, ours) = (names(&theirs), names(&ours));
    assert!(theirs.len() > 70, "{theirs:?}");
    assert_eq!(theirs.difference(&ours).next(), None, "missing");

    let path = harness::root().join("c-tests/tests/contract/headers.c");
    let program = std::fs::read_to_string(path).expect("headers.c can be read");
    let program = names(&program);
    let exported = dynamic_symbols(&installed());
    let exported: Vec<_> = exported.iter().filter_map(|s| s.split(' ').next()).collect();
    // Guards; and what who builds a libccd defines, not who includes it.
    let guard = |name: &str| name.ends_with("_H__") || name.ends_with("_H");
    let builders = ["ccd_EXPORTS", "CCD_STATIC_DEFINE"];
    let mut not_compared = theirs.difference(&program);
    let lacks = not_compared.find(|n| !guard(n) && !exported.contains(n) && !builders.contains(n));
    assert_eq!(lacks, None, "headers.c");
}

#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn headers_compute_what_libccd_s_do() {
    let single_config = harness::root().join("c-tests/tests/contract/single");
    for (program, theirs, ours) in [
        (Program::c("headers"), "c99", "c99"),
        (Program::c("headers"), "gnu17", "c11"),
        // A C++ compiler takes the same source for C++.
        (Program::cpp("headers"), "c++11", "c++11"),
    ] {
        let program = program.source("tests/contract/headers.c").without_tools();
        let double = program.precision(Precision::Double).link_system();
        for (single, program) in [(false, double.clone()), (true, double.flag("-DCCD_SINGLE"))] {
            let mut of_theirs = program.clone().system_headers().standard(theirs);
            if single {
                of_theirs = of_theirs.flag("-I").flag(&single_config);
            }
            let [theirs, ours] =
                [of_theirs, program.standard(ours)].map(|program| program.build().quiet().run(NO_ARGS).stdout);
            assert!(ours.lines().count() > 1_000_000);
            let different = ours.lines().zip(theirs.lines()).find(|(a, b)| a != b);
            assert_eq!(different, None, "ours and libccd's, single: {single}");
            assert_eq!(ours.len(), theirs.len());
        }
    }
}

/// No warning at all, so none that libccd's do not give.
#[test]
#[cfg_attr(feature = "single", ignore = "the same in both precisions")]
fn headers_compile_without_warnings() {
    let compilers = [
        (None, "c", &["c99", "c11", "gnu17"][..]),
        (None, "c++", &["c++11", "c++14", "c++20"][..]),
        (Some("clang"), "c", &["c99", "c11", "gnu17"][..]),
        (Some("clang++"), "c++", &["c++11", "c++20"][..]),
    ];
    for (named, language, standards) in compilers {
        let mut compiler = harness::compiler(language == "c++");
        if let Some(name) = named {
            if !harness::installed(name) {
                println!("skipped: {name} is not installed");
                continue;
            }
            compiler.compiler(name);
        }
        for standard in standards {
            for precision in ["-DCCD_DOUBLE", "-DCCD_SINGLE", "-DUNDECIDED"] {
                let mut compile = harness::compile_with(&compiler);
                compile.args(["-x", language, &format!("-std={standard}"), "-fsyntax-only"]);
                compile.args(["-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-I"]);
                compile.arg(harness::root().join("include")).arg(precision);
                compile.arg(harness::root().join("c-tests/tests/contract/headers.c"));
                harness::must_succeed(&mut compile, "the compiler");
            }
        }
    }
}

// --- behaviour ------------------------------------------------------------------

#[test]
fn nearest_points_of_segments_and_triangles() {
    let nearest = match compared() {
        true => program("point_distance").link_ours_renamed_and_system(),
        false => alone("point_distance"),
    };
    nearest.build().run([harness::rounds(20_000)]);
}

/// On this library, and where they are compared on libccd too: the same elements in the same order.
fn polytope(library: fn(Program) -> Program) -> Executable {
    let program = program("polytope").standard("gnu99");
    library(program).build()
}

#[test]
fn polytopes() {
    let rounds = [harness::rounds(200)];
    let ours = polytope(Program::link_ours_shared).run(&rounds).stdout;
    if compared() {
        let theirs = polytope(Program::link_system).run(&rounds).stdout;
        assert!(ours == theirs, "other polytopes than libccd's");
    }
}

/// FCL's EPA runs on the polytope functions: what the same calls take on both libraries.
/// Instructions are exact, time is not.
#[test]
fn polytope_functions_take_no_more_instructions_than_libccd_s() {
    if !compared() {
        println!("skipped: Debian's libccd is double, and this is compared on x86-64");
        return;
    }
    if !harness::installed("valgrind") || harness::emulated() {
        println!("skipped: valgrind is not installed, or not for this processor");
        return;
    }
    let counted = |library: fn(Program) -> Program| {
        let plain = library(program("polytope").standard("gnu99").without_tools());
        let mut plain = plain.build().command();
        let counted = harness::callgrind(plain.arg("20"), &[]);
        let (_, counts) = counted.unwrap_or_else(|why| panic!("{why}"));
        counts.concat()
    };
    // A call is three lines: `cfn=FUNCTION`, `calls=...`, and what it took at the end of one.
    let taken = |counts: &str, function: &str| -> u64 {
        let (lines, call) = (counts.lines(), format!("cfn={function}"));
        let costs = lines.clone().zip(lines.skip(2)).filter(|(first, _)| *first == call);
        let costs = costs.map(|(_, cost)| cost.rsplit(' ').next().unwrap_or_default());
        costs.map(|cost| cost.parse::<u64>().expect("a number")).sum()
    };
    let (theirs, ours) = (counted(Program::link_system), counted(Program::link_ours_shared));
    for name in ["AddVertex", "AddEdge", "AddFace", "Nearest", "RecomputeDistances"] {
        let [theirs, ours] = [&theirs, &ours].map(|counts| taken(counts, &format!("ccdPt{name}")));
        println!("ccdPt{name}: libccd {theirs}, this library {ours} instructions");
        assert!(0 < ours && ours <= theirs, "ccdPt{name}: libccd {theirs}, ours {ours}");
    }
}

#[test]
fn callbacks() {
    alone("callbacks").library("pthread").build().run(NO_ARGS);
}

#[test]
fn answers_to_any_input() {
    let questions = alone("arguments").build();
    questions.run([harness::rounds(100)]);
}

#[test]
fn memory() {
    alone("memory").without_tools().build().run(NO_ARGS);
}

#[test]
fn threads() {
    alone("threads").library("pthread").build().run(NO_ARGS);
}

#[test]
fn longjmp_out_of_callbacks() {
    alone("exceptions").build().run([harness::rounds(20)]);
    alone("exceptions").link_ours_static().build().run([harness::rounds(20)]);
}

#[test]
fn exceptions_out_of_callbacks() {
    let exceptions = Program::cpp("exceptions")
        .source("tests/contract/exceptions.c")
        .flag("-pedantic")
        .flag("-Werror")
        .flag("-DOURS_ALONE");
    exceptions.clone().link_ours_shared().build().run([harness::rounds(20)]);
    exceptions.link_ours_static().build().run([harness::rounds(20)]);
}
