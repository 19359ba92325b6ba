// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the order of the modules of `src`: each uses those before it, none behind it.

use std::fs;
use std::path::Path;

/// The modules, from the bottom to the top.
const MODULES: &str = "math types trace geometry minkowski portal gjk epa local along contact paper query ffi api shapes";

#[test]
fn no_module_uses_one_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    // The row of the module that a path begins with.
    let rank = |path: &str| {
        let module = path
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .next();
        MODULES.split(' ').position(|m| Some(m) == module)
    };
    let (mut folders, mut uses) = (vec![src.clone()], 0);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(&src).expect("in src").to_string_lossy();
            if name == "lib.rs" || !name.ends_with(".rs") {
                continue;
            }
            let own = rank(&name).unwrap_or_else(|| panic!("{name} is in no row"));
            let text = fs::read_to_string(&path).expect("a text");
            let product = text.split("#[cfg(test)]\nmod tests").next();
            let lines = product.unwrap_or_default().lines();
            for line in lines.filter(|line| !line.trim_start().starts_with("//")) {
                for other in line.split("crate::").skip(1).filter_map(rank) {
                    assert!(other <= own, "{name}: {line}");
                    uses += 1;
                }
            }
        }
    }
    assert!(uses > 100, "{uses} uses");
}
