// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the order of the modules of `src`: each uses those before it, none behind it; and no files of a folder use each other
//! in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The modules, from the bottom to the top.
const MODULES: &str = "math types trace geometry minkowski portal gjk epa local along contact paper query ffi api shapes";

/// Returns the code of each file of `src` but lib.rs, without tests and comments, by its path in `src` without the extension.
fn files() -> BTreeMap<String, String> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut files) = (vec![src.clone()], BTreeMap::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path
                .strip_prefix(&src)
                .expect("in src")
                .to_string_lossy()
                .replace('\\', "/");
            let Some(name) = name.strip_suffix(".rs").filter(|name| *name != "lib") else {
                continue;
            };
            let text = fs::read_to_string(&path).expect("a text");
            let product = text
                .split("#[cfg(test)]\nmod tests")
                .next()
                .unwrap_or_default();
            let lines = product
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            files.insert(name.to_owned(), lines.collect::<Vec<_>>().join("\n"));
        }
    }
    files
}

#[test]
fn no_module_uses_one_above_it() {
    // The row of the module that a path begins with.
    let rank = |path: &str| {
        let module = path
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .next();
        MODULES.split(' ').position(|m| Some(m) == module)
    };
    let mut uses = 0;
    for (name, code) in files() {
        let own = rank(&name).unwrap_or_else(|| panic!("{name} is in no row"));
        for line in code.lines() {
            for other in line.split("crate::").skip(1).filter_map(rank) {
                assert!(other <= own, "{name}: {line}");
                uses += 1;
            }
        }
    }
    assert!(uses > 100, "{uses} uses");
}

#[test]
fn no_files_of_a_folder_use_each_other_in_a_circle() {
    let files = files();
    let mut uses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, code) in &files {
        let Some((folder, _)) = name.rsplit_once('/') else {
            continue;
        };
        let path = format!("crate::{}::", folder.replace('/', "::"));
        let mut used = BTreeSet::new();
        for rest in code.split(path.as_str()).skip(1) {
            // `folder::file::…` or `folder::{file::…, file::…}`, over several lines.
            let group = rest
                .strip_prefix('{')
                .and_then(|rest| rest.split('}').next());
            for item in group
                .unwrap_or(rest.split(';').next().unwrap_or_default())
                .split(',')
            {
                let file = item.trim().split("::").next().unwrap_or_default();
                let other = format!("{folder}/{file}");
                used.extend(files.get_key_value(&other).map(|(other, _)| other.as_str()));
            }
        }
        used.remove(name.as_str());
        uses.insert(name, used);
    }
    assert!(
        uses.values().map(BTreeSet::len).sum::<usize>() > 50,
        "{uses:?}"
    );
    // Files that use no other that is left are taken away; a circle stays.
    loop {
        let left: BTreeSet<&str> = uses.keys().copied().collect();
        let count = uses.len();
        uses.retain(|_, used| used.iter().any(|other| left.contains(other)));
        if uses.len() == count {
            break;
        }
    }
    assert!(uses.is_empty(), "in a circle, or above one: {uses:?}");
}
