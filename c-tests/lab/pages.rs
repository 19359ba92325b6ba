// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tables of what is measured, and the repository's pages that have them.

use crate::harness::root;
use std::fs;

/// Replaces the text between the mark `<!-- NAME -->` and the next `<!-- end -->`.
pub fn between_marks(text: &str, name: &str, new: &str) -> String {
    let mark = format!("<!-- {name} -->\n");
    let parts = text.split_once(&mark).and_then(|(before, rest)| Some((before, rest.split_once("<!-- end -->")?.1)));
    let (before, after) = parts.unwrap_or_else(|| panic!("no mark {name}"));
    format!("{before}{mark}{new}<!-- end -->{after}")
}

/// Does the same in a page of the repository.
pub fn write_between_marks(page: &str, name: &str, new: &str) {
    let path = root().join(page);
    let written = fs::read_to_string(&path).and_then(|text| fs::write(&path, between_marks(&text, name, new)));
    written.unwrap_or_else(|e| panic!("{page}: {e}"));
}

/// Returns a table; `|` separates the cells of its head.
pub fn markdown(head: &str, lines: impl IntoIterator<Item = Vec<String>>) -> String {
    let head: Vec<_> = head.split('|').collect();
    let start = format!("| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()));
    let lines = lines.into_iter().map(|cells| format!("\n| {} |", cells.join(" | ")));
    std::iter::once(start).chain(lines).collect()
}
