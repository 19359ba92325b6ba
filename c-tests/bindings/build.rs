// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Writes libccd.rs and warmccd.rs, for lib.rs.

use std::env::var;
use std::path::Path;
use std::process::Command;

use bindgen::{Abi, Builder, Formatter};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let include = Path::new(&var("CARGO_MANIFEST_DIR").expect("cargo's")).join("../../include");
    println!("cargo::rerun-if-changed={}", include.display());
    let libccd = builder("#include <ccd/ccd.h>\n").dynamic_library_name("Libccd").allowlist_function("ccd.*");
    write(libccd, "libccd.rs");
    let warmccd =
        builder("#include <ccd/warm.h>\n#include <ccd/paper.h>\n").clang_arg(format!("-I{}", include.display()));
    let warmccd = warmccd.dynamic_library_name("Warmccd").allowlist_function("ccd.*").allowlist_var("CCD.*");
    // These are libccd's.
    write(warmccd.blocklist_type("_?ccd_(t|vec3_t|real_t|.*_fn)"), "warmccd.rs");
}

/// Returns a builder for the text of a header.
fn builder(header: &str) -> Builder {
    let builder = Builder::default()
        .header_contents("included.h", header)
        .dynamic_link_require_all(true)
        .override_abi(Abi::CUnwind, ".*")
        .generate_comments(false)
        .formatter(Formatter::None)
        // The headers of the machine that builds: what is written names types, and no sizes of them.
        .layout_tests(false)
        .clang_arg(format!("--target={}", var("HOST").expect("cargo's")));
    // float.h and the like, where libclang is installed without clang's own.
    let found = Command::new("cc").arg("-print-file-name=include").output();
    let found = found.map(|out| String::from_utf8_lossy(&out.stdout).trim().to_owned());
    builder.clang_args(found.map(|path| ["-idirafter".to_owned(), path]).into_iter().flatten())
}

fn write(builder: Builder, name: &str) {
    let bindings = builder.generate().unwrap_or_else(|e| panic!("{name}: {e}"));
    bindings.write_to_file(Path::new(&var("OUT_DIR").expect("cargo's")).join(name)).expect("room on the disk");
}
