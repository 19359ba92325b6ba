// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the order of the modules of `src`: each uses those before it, none behind it; and that no files of `src`, and none of
//! a folder of `c-tests`, use each other in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The modules, from the bottom to the top.
const MODULES: &str = "math types trace geometry minkowski portal gjk epa local along contact paper query ffi api shapes";

/// The files that each file uses, all by their paths without the extension.
type Uses = BTreeMap<String, BTreeSet<String>>;

/// Returns the code of each file with one of these extensions below a folder of the repository, without tests and the lines
/// of comments, by its path in the folder.
fn files(folder: &str, extensions: &[&str]) -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let (mut folders, mut files) = (vec![root.clone()], BTreeMap::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let extension = path.extension().and_then(|e| e.to_str());
            if !extension.is_some_and(|e| extensions.contains(&e)) {
                continue;
            }
            let text = fs::read_to_string(&path).expect("a text");
            let name = path.strip_prefix(&root).expect("in the folder");
            let name = name.to_string_lossy().replace('\\', "/");
            let product = text.split("#[cfg(test)]\nmod tests").next();
            let lines = product.unwrap_or_default().lines();
            let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
            files.insert(name, lines.collect::<Vec<_>>().join("\n"));
        }
    }
    files
}

/// Returns the code of each Rust file below a folder by its path without the extension.
fn rust_files(folder: &str) -> BTreeMap<String, String> {
    let named = files(folder, &["rs"]).into_iter();
    named
        .map(|(name, code)| (name.trim_end_matches(".rs").to_owned(), code))
        .collect()
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Reads a path or a group of paths, `a::{b, c::d}`, at the start of the code; adds each to `paths`, behind `head`. Returns
/// the code behind it.
fn read_path<'a>(code: &'a str, head: &[&'a str], paths: &mut Vec<Vec<&'a str>>) -> &'a str {
    let code = code.trim_start();
    if let Some(mut rest) = code.strip_prefix('{') {
        loop {
            rest = read_path(rest, head, paths).trim_start();
            match rest.strip_prefix(',') {
                Some(next) => rest = next,
                None => return rest.strip_prefix('}').unwrap_or(rest),
            }
        }
    }
    let (name, rest) = code.split_at(code.find(|c| !is_name(c)).unwrap_or(code.len()));
    let path = [head, &[name]].concat();
    match rest.strip_prefix("::") {
        Some(rest) => read_path(rest, &path, paths),
        None => {
            paths.push(path);
            rest
        }
    }
}

/// Returns the paths of the code that begin with `crate` or `super`, without these, from the root of the crate. `own`: the
/// path of the code's module.
fn paths<'a>(own: &'a str, code: &'a str) -> Vec<Vec<&'a str>> {
    let mut found = Vec::new();
    for first in ["crate::", "super::"] {
        for (at, _) in code.match_indices(first) {
            // Inside of a path, or the end of another name.
            if !code[..at].ends_with(|c| is_name(c) || c == ':') {
                read_path(&code[at..], &[], &mut found);
            }
        }
    }
    for path in &mut found {
        let supers = path.iter().take_while(|name| **name == "super").count();
        let own: Vec<&str> = own.split('/').collect();
        let kept = if supers > 0 { own.len() - supers } else { 0 };
        let rest = path.iter().skip(supers.max(1)).copied();
        *path = own[..kept].iter().copied().chain(rest).collect();
    }
    found
}

/// Returns the uses of Rust files by their paths. The file of a path is the longest one that it begins with. A file may
/// continue in those of its own folder, as query.rs in query/: between these no use counts.
fn rust_uses(files: &BTreeMap<String, String>) -> Uses {
    let file = |path: &Vec<&str>| {
        let mut starts = (1..=path.len()).rev().map(|n| path[..n].join("/"));
        starts.find(|start| files.contains_key(start))
    };
    let uses = files.iter().map(|(name, code)| {
        let paths = paths(name, code);
        let is_within = |inner: &str, outer: &str| {
            inner
                .strip_prefix(outer)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let used = paths
            .iter()
            .filter_map(file)
            .filter(|used| !is_within(used, name) && !is_within(name, used));
        (name.clone(), used.collect())
    });
    uses.collect()
}

/// Returns the functions that C code defines for other files; not `__ccdSupport`, which a library and the tool both export.
fn defined(code: &str) -> impl Iterator<Item = &str> {
    let heads = code.lines().filter(|line| {
        line.starts_with(is_name) && !line.starts_with("static ") && !line.ends_with(';')
    });
    // A type and a name.
    let names = heads.filter_map(|line| Some(line.split_once('(')?.0.rsplit_once([' ', '*'])?.1));
    names.filter(|name| *name != "main" && !name.starts_with("__"))
}

/// Returns the uses of C and C++ files: what they include, and the files of their folder whose functions they call.
fn c_uses(files: &BTreeMap<String, String>) -> Uses {
    let folder = |name: &str| {
        name.rsplit_once('/')
            .map_or("", |(folder, _)| folder)
            .to_owned()
    };
    // Of each function all files of a folder that define it: programs may each have their own.
    let mut definitions: BTreeMap<(String, &str), Vec<&str>> = BTreeMap::new();
    for (name, code) in files.iter().filter(|(name, _)| !name.ends_with(".h")) {
        for function in defined(code) {
            definitions
                .entry((folder(name), function))
                .or_default()
                .push(name);
        }
    }
    let uses = files.iter().map(|(name, code)| {
        let included = code
            .lines()
            .filter_map(|line| line.strip_prefix("#include \"")?.split('"').next());
        let mut used: BTreeSet<String> = included
            .map(str::to_owned)
            .filter(|file| files.contains_key(file))
            .collect();
        if !name.ends_with(".h") {
            // Without comments.
            let parts = code.split("/*").enumerate();
            let code = parts.map(|(i, part)| {
                if i == 0 {
                    part
                } else {
                    part.split_once("*/").map_or("", |(_, code)| code)
                }
            });
            let words = code.flat_map(|code| code.split(|c| !is_name(c)));
            let called = words.filter_map(|word| {
                match definitions.get(&(folder(name), word)).map(Vec::as_slice) {
                    Some([file]) => Some((*file).to_owned()),
                    _ => None,
                }
            });
            used.extend(called);
        }
        used.remove(name);
        (name.clone(), used)
    });
    uses.collect()
}

/// Asserts that no files use each other in a circle. `least`: the number of uses that must be found.
fn assert_no_circle(mut uses: Uses, least: usize) {
    let count: usize = uses.values().map(BTreeSet::len).sum();
    assert!(count > least, "{count} uses: {uses:?}");
    // Files that use no other that is left are taken away; a circle stays.
    loop {
        let left: BTreeSet<String> = uses.keys().cloned().collect();
        uses.retain(|_, used| !used.is_disjoint(&left));
        if uses.len() == left.len() {
            break;
        }
    }
    assert!(uses.is_empty(), "in a circle, or above one: {uses:?}");
}

#[test]
fn paths_are_read_from_the_root() {
    let code = "use crate::a::{b::C, d};\nuse super::super::e; let x = super::f(crate::g::h());";
    let found: BTreeSet<String> = paths("x/y/z", code)
        .iter()
        .map(|path| path.join(" "))
        .collect();
    assert_eq!(
        found.into_iter().collect::<Vec<_>>(),
        ["a b C", "a d", "g h", "x e", "x y f"]
    );
}

#[test]
fn no_module_uses_one_above_it() {
    let mut files = rust_files("src");
    files.remove("lib");
    let rank = |module: &str| MODULES.split(' ').position(|m| m == module);
    let mut uses = 0;
    for (name, code) in &files {
        let own = rank(name.split('/').next().unwrap_or_default());
        let own = own.unwrap_or_else(|| panic!("{name} is in no row"));
        for path in paths(name, code) {
            if let Some(other) = path.first().and_then(|module| rank(module)) {
                assert!(other <= own, "{name}: {path:?}");
                uses += 1;
            }
        }
    }
    assert!(uses > 100, "{uses} uses");
}

#[test]
fn no_files_of_src_use_each_other_in_a_circle() {
    let mut files = rust_files("src");
    files.remove("lib");
    assert_no_circle(rust_uses(&files), 200);
}

#[test]
fn no_files_of_a_folder_of_the_tests_use_each_other_in_a_circle() {
    let mut files_of_rust = rust_files("c-tests");
    // The roots of programs and folders.
    files_of_rust.retain(|name, _| !name.ends_with("mod") && !name.ends_with("main"));
    assert_no_circle(rust_uses(&files_of_rust), 30);
    assert_no_circle(c_uses(&files("c-tests", &["c", "cpp", "h"])), 100);
}
