// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the order of the modules of `src`: each uses those above it, none below.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules, from the bottom to the top.
const MODULES: [&str; 15] = [
    "math",
    "types",
    "trace",
    "geometry",
    "minkowski",
    "portal",
    "gjk",
    "epa",
    "local",
    "contact",
    "query",
    "paper",
    "solver",
    "ffi",
    "api",
];

/// Adds the Rust files below a folder.
fn add_files(dir: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            add_files(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

#[test]
fn no_module_uses_one_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    add_files(&src, &mut files);
    let rank = |module: &str| MODULES.iter().position(|m| *m == module);
    let mut uses = 0;
    for file in files.iter().filter(|file| !file.ends_with("lib.rs")) {
        let path = file
            .strip_prefix(&src)
            .expect("a file of src")
            .with_extension("");
        let module = path
            .iter()
            .next()
            .and_then(|name| name.to_str())
            .expect("a module");
        let own = rank(module).unwrap_or_else(|| panic!("{module} is in no row"));
        let text = fs::read_to_string(file).expect("a text");
        let product = text
            .split("#[cfg(test)]\nmod tests")
            .next()
            .expect("the product's code");
        for line in product
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
        {
            for used in line.split("crate::").skip(1) {
                let name = used
                    .split(|c: char| !c.is_alphanumeric() && c != '_')
                    .next();
                let other = name.and_then(rank);
                assert!(
                    other.is_none_or(|other| other <= own),
                    "{}: {line}",
                    file.display()
                );
                uses += usize::from(other.is_some());
            }
        }
    }
    assert!(
        files.len() > 40 && uses > 100,
        "{} files, {uses} uses",
        files.len()
    );
}
