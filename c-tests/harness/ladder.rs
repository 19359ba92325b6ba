// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the order of the modules of `src`: each uses those before it, none behind it.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules, from the bottom to the top.
const MODULES: &str = "math types trace geometry minkowski portal gjk epa local along contact query paper solver ffi api";

/// Returns the Rust files below a folder.
fn files(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let files = paths.flat_map(|path| {
        if path.is_dir() {
            files(&path)
        } else {
            vec![path]
        }
    });
    files
        .filter(|file| file.extension().is_some_and(|e| e == "rs"))
        .collect()
}

/// Returns the module that a path within the crate begins with.
fn module(path: &str) -> &str {
    path.split(|c: char| !c.is_alphanumeric() && c != '_')
        .next()
        .unwrap_or_default()
}

#[test]
fn no_module_uses_one_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let rank = |module: &str| MODULES.split(' ').position(|m| m == module);
    let mut uses = 0;
    for file in files(&src).iter().filter(|file| !file.ends_with("lib.rs")) {
        let name = file
            .strip_prefix(&src)
            .expect("a file of src")
            .to_string_lossy();
        let own = rank(module(&name)).unwrap_or_else(|| panic!("{name} is in no row"));
        let text = fs::read_to_string(file).expect("a text");
        let product = text
            .split("#[cfg(test)]\nmod tests")
            .next()
            .unwrap_or_default();
        for line in product
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
        {
            for other in line
                .split("crate::")
                .skip(1)
                .filter_map(|used| rank(module(used)))
            {
                assert!(other <= own, "{name}: {line}");
                uses += 1;
            }
        }
    }
    assert!(uses > 100, "{uses} uses");
}
