// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts' page: the pictures and the tables behind them, with what a reader
//! needs to judge them. The page is its own template: a table is written between its marks.

use comfy_table::{Table, presets::ASCII_MARKDOWN};

use super::Page;
use super::instructions::Split;
use super::paper::{AS_PUBLISHED, PAPER};
use crate::harness;
use crate::measuring::measure::Row;

/// The head's cells are between bars.
pub fn markdown<const N: usize>(head: &str, lines: impl IntoIterator<Item = [String; N]>) -> String {
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN);
    table.set_header(head.split('|'));
    for line in lines {
        table.add_row(line);
    }
    table.to_string()
}

fn find<'a>(rows: &'a [Row], set: &str, method: &str, start: &str, tolerance: f64) -> Option<&'a Row> {
    rows.iter()
        .find(|r| r.set == set && r.method == method && r.start == start && r.tolerance.is_none_or(|t| t == tolerance))
}

pub fn times_faster(rows: &[Row]) -> String {
    let lines = PAPER.iter().map(|(set, faster)| {
        let ns = |m: &str, s: &str, t: f64| find(rows, set, m, s, t).and_then(|r| r.ns);
        let ratio = |m: &str, s: &str, t: f64| {
            let own = if m.starts_with("Algorithm") { AS_PUBLISHED } else { 1e-6 };
            let (epa, mine) = (ns("libccd EPA", "", t), ns(m, s, own));
            epa.zip(mine).map_or("-".to_owned(), |(e, m)| format!("{:.1}", e / m))
        };
        [
            super::kind(set),
            ratio("local", "5", 1e-6),
            ratio("local", "5", 1e-10),
            ratio("minimum", "", 1e-6),
            ratio("Algorithm 4/5", "5", 1e-6),
            ratio("Algorithm 4/5", "5", 1e-10),
            faster.to_string(),
        ]
    });
    let head = "pair|local, EPA 1e-6|local, EPA 1e-10|minimum, EPA 1e-6|\
                Algorithm 4/5, EPA 1e-6|Algorithm 4/5, EPA 1e-10|*in the paper*";
    markdown(head, lines)
}

fn supports(row: Option<&Row>) -> String {
    row.map_or("-".to_owned(), |r| format!("{:.1}", r.supports))
}

pub fn coherent(rows: &[Row]) -> String {
    let at = |set: &str, method: &str, start: &str, x: f64| {
        supports(rows.iter().find(|r| r.set == set && r.method == method && r.start == start && r.x == Some(x)))
    };
    let lines = super::sets(rows).into_iter().map(|set| {
        [
            super::kind(set),
            at(set, "local", "warm", 0.1),
            at(set, "local", "warm", 0.5),
            at(set, "local", "warm", 2.0),
            at(set, "local", "centres", 0.5),
            at(set, "minimum", "warm", 0.1),
            at(set, "minimum", "warm", 0.5),
            at(set, "minimum", "warm", 2.0),
            at(set, "minimum", "", 0.5),
            at(set, "libccd EPA", "", 0.5),
        ]
    });
    let head = "pair|local, warm, 0.1°|0.5°|2°|local, cold|\
                minimum, warm, 0.1°|0.5°|2°|minimum, cold|libccd EPA";
    markdown(head, lines)
}

pub fn instructions(split: &[Split]) -> String {
    let lines = split.iter().map(|s| {
        let total = s.callbacks + s.solver;
        [
            super::kind(&s.set),
            s.method.clone(),
            format!("{total:.0}"),
            format!("{:.0}", s.callbacks),
            format!("{:.0}", s.solver),
            format!("{:.0}", 100.0 * s.callbacks / total),
        ]
    });
    let head = "pair|method|instructions|support functions|solver|support functions, %";
    markdown(head, lines)
}

/// Writes the page's tables between their marks.
pub fn write(page: &Page, tables: &[(&str, String)]) {
    let committed = harness::root().join("c-tests/bench/charts/README.md");
    let mut text = std::fs::read_to_string(&committed).expect("the charts' page");
    for (name, table) in tables {
        text = harness::between_marks(&text, &format!("table {name}"), &format!("{table}\n"));
    }
    let path = page.file("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
