// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! include/ccd/warm.h is what cbindgen makes of src/ffi/warm.rs: no drift.
//!
//! `WRITE_HEADER=1 cargo test --test header` writes it anew.

use std::path::Path;

fn generated(root: &Path) -> String {
    let mut config = cbindgen::Config {
        language: cbindgen::Language::C,
        cpp_compat: true,
        include_guard: Some("__CCD_WARM_H__".into()),
        sys_includes: vec![],
        includes: vec![],
        after_includes: Some("#include <ccd/ccd.h>".into()),
        no_includes: true,
        documentation_style: cbindgen::DocumentationStyle::Doxy,
        usize_is_size_t: true,
        line_length: 100,
        style: cbindgen::Style::Both,
        header: Some(HEADER.into()),
        ..Default::default()
    };
    config.function.prefix = Some("CCD_EXPORT".into());
    config.function.args = cbindgen::Layout::Auto;
    config
        .export
        .rename
        .insert("Real".into(), "ccd_real_t".into());
    config
        .export
        .rename
        .insert("State".into(), "ccd_warm_t".into());
    let mut out = Vec::new();
    cbindgen::Builder::new()
        .with_config(config)
        .with_src(root.join("src/ffi/warm.rs"))
        .generate()
        .expect("cbindgen")
        .write(&mut out);
    String::from_utf8(out).expect("UTF-8")
}

const HEADER: &str = "/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What this library adds to libccd: penetration queries that start from the last answer,
 * along a direction and in a plane, with witness points and bounds. Made by cbindgen from
 * src/ffi/warm.rs; edit that.
 *
 * Tolerances are depths in metres; the library floors them at a few ulps of the objects'
 * size, so 0 asks for the best the precision can give. Object pointers are handed to the
 * callbacks and never looked at. A query is re-entrant and keeps nothing but the state that
 * the caller hands it. */";

#[test]
fn warm_h_is_what_the_source_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("include/ccd/warm.h");
    let fresh = generated(root);
    if std::env::var_os("WRITE_HEADER").is_some() {
        std::fs::write(&path, &fresh).expect("write the header");
    }
    let committed = std::fs::read_to_string(&path).expect("include/ccd/warm.h");
    assert!(
        committed == fresh,
        "include/ccd/warm.h is stale: WRITE_HEADER=1 cargo test --test header"
    );
}
