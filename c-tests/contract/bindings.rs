// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The types of the C interface against bindgen's view of libccd's own headers, which
//! is committed: only renewing it takes libclang.

#[cfg(not(feature = "single"))]
use std::mem::{align_of, offset_of, size_of};
use std::panic::catch_unwind;
use std::path::Path;
use std::process::Command;

use super::harness;

#[allow(warnings, clippy::all)]
#[path = "libccd_bindings.rs"]
mod libccd;

#[cfg(not(feature = "single"))]
#[test]
fn types_are_laid_out_as_libccd_s() {
    use ccd::internals::ffi as ours;
    macro_rules! same {
        ($($name:ident { $($field:ident),* })*) => { $(
            assert_eq!(size_of::<ours::$name>(), size_of::<libccd::$name>());
            assert_eq!(align_of::<ours::$name>(), align_of::<libccd::$name>());
            $(assert_eq!(
                offset_of!(ours::$name, $field),
                offset_of!(libccd::$name, $field),
                concat!(stringify!($name), ".", stringify!($field)),
            );)*
        )* };
    }
    same! {
        ccd_vec3_t { v }
        ccd_quat_t { q }
        ccd_t {
            first_dir, support1, support2, center1, center2,
            max_iterations, epa_tolerance, mpr_tolerance, dist_tolerance
        }
    }
    assert_eq!(size_of::<ccd::Real>(), size_of::<libccd::ccd_real_t>());
}

/// Renews libccd_bindings.rs from the system's headers with `UPDATE_BINDINGS=1`; else
/// checks it, and that our headers give the very same: every type, every prototype.
#[test]
fn bindings_are_those_of_both_headers() {
    if catch_unwind(bindgen::clang_version).is_err() {
        println!("skipped: no libclang (Debian: libclang-dev)");
        return;
    }
    let dir = harness::root().join("c-tests/contract");
    let committed = dir.join("libccd_bindings.rs");
    let libccd = generate(&dir, None);
    if std::env::var_os("UPDATE_BINDINGS").is_some() {
        std::fs::write(&committed, &libccd).expect("libccd_bindings.rs can be written");
        let formatted = Command::new("rustfmt")
            .args(["--edition", "2024"])
            .arg(&committed)
            .status();
        assert!(formatted.is_ok_and(|status| status.success()), "rustfmt");
    }
    let text = std::fs::read_to_string(&committed).expect("libccd_bindings.rs can be read");
    assert!(
        items(&text) == items(&libccd),
        "libccd_bindings.rs is not what bindgen makes of libccd's headers: \
         UPDATE_BINDINGS=1 cargo test --test contract bindings"
    );
    let ours = items(&generate(&dir, Some(&harness::root().join("include"))));
    for item in items(&libccd) {
        assert!(ours.contains(&item), "our headers do not declare {item}");
    }
}

fn generate(dir: &Path, include: Option<&Path>) -> String {
    let mut builder = bindgen::Builder::default()
        .header(dir.join("bindings.h").display().to_string())
        .allowlist_item("_?ccd.*|CCD.*")
        .generate_comments(false)
        .rust_target(bindgen::RustTarget::stable(85, 0).expect("a version bindgen knows"))
        .rust_edition(bindgen::RustEdition::Edition2024)
        .disable_header_comment()
        .raw_line("// SPDX-FileCopyrightText: 2026 The warmccd developers")
        .raw_line("// SPDX-License-Identifier: BSD-3-Clause")
        .raw_line("")
        .raw_line("//! Made by bindgen from libccd's installed headers; see bindings.rs.")
        .formatter(bindgen::Formatter::None);
    // float.h and the like, where libclang is there without clang's own.
    let mut ask = harness::compile_with(&harness::compiler(false));
    let found = harness::must_succeed(ask.arg("-print-file-name=include"), "the C compiler");
    builder = builder.clang_args(["-idirafter", found.stdout.trim()]);
    if let Some(include) = include {
        builder = builder.clang_arg(format!("-I{}", include.display()));
    }
    builder
        .generate()
        .expect("bindgen reads the headers")
        .to_string()
}

/// Bindings item by item, sorted, free of formatting.
fn items(bindings: &str) -> Vec<String> {
    let code: String = bindings
        .lines()
        .filter(|line| !line.starts_with("//"))
        .flat_map(str::chars)
        .filter(|c| !c.is_whitespace() && *c != ',')
        .collect();
    let mut items = Vec::new();
    let (mut item, mut depth) = (String::new(), 0_i32);
    for c in code.chars() {
        item.push(c);
        depth += i32::from("{[(".contains(c)) - i32::from("}])".contains(c));
        if depth == 0 && (c == '}' || c == ';') {
            items.push(std::mem::take(&mut item));
        }
    }
    items.sort();
    items
}
