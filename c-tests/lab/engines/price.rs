// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The price on the front page, one sentence and one table, and the sentence on the page of the engines: made of the pages' own
//! tables, so that they agree.

use crate::harness::root;
use crate::pages::{markdown, write_between_marks};

/// Cells of a table of a page, between its mark and the next end.
struct Table(Vec<Vec<String>>);

impl Table {
    fn read(page: &str, mark: &str) -> Table {
        let text = std::fs::read_to_string(root().join(page)).unwrap_or_else(|e| panic!("{page}: {e}"));
        let marked =
            text.split_once(&format!("<!-- {mark} -->\n")).and_then(|(_, rest)| rest.split_once("<!-- end -->"));
        let lines = marked.unwrap_or_else(|| panic!("{page}: no mark {mark}")).0.lines();
        let cells =
            |line: &str| Some(line.strip_prefix("| ")?.strip_suffix(" |")?.split(" | ").map(str::to_owned).collect());
        Table(lines.filter_map(cells).collect())
    }

    /// Returns the least and the largest number of a column, of the rows whose first cell begins so.
    fn range(&self, rows: &[&str], column: usize) -> [f64; 2] {
        let is_wanted = |line: &&Vec<String>| rows.iter().any(|row| line[0].starts_with(row));
        let number = |line: &Vec<String>| line[column].trim_end_matches(" %").parse::<f64>().expect("a number");
        let values: Vec<f64> = self.0.iter().filter(is_wanted).map(number).collect();
        assert!(values.len() >= rows.len(), "{rows:?}: {} rows", values.len());
        [f64::min, f64::max].map(|f| values.iter().copied().reduce(f).expect("a row"))
    }
}

/// Returns a number with one digit, halves upwards.
fn tenths(value: f64) -> String {
    format!("{:.1}", (10.0 * value).round() / 10.0)
}

fn times([low, high]: [f64; 2]) -> String {
    let [low, high] = [low, high].map(tenths);
    if low == high { low } else { format!("{low} to {high}") }
}

/// Returns pages with their text: the sentence and the table, and the sentence.
fn texts() -> [(&'static str, String); 2] {
    let steps = Table::read("include/README.md", "steps");
    let fcl = Table::read("c-tests/engines/README.md", "fcl");
    let calls = Table::read("README.md", "main.sh readme");
    let programs = steps.range(&["ODE", "MuJoCo", "DART"], 3);
    let several = ["contacts of touching", "contacts of bodies", "contacts in random"];
    let contacts = fcl.range(&several, 4);
    let [with_pos, without] = ["`ccdMPRPenetration` ", "`ccdMPRPenetration`, `pos` NULL"].map(|row| {
        let mut line = calls.0.iter().filter(|line| format!("{} ", line[0]).starts_with(row));
        tenths(line.next().expect("a call")[4].parse().expect("a number"))
    });
    let lines = [
        ("whole simulations: ODE, MuJoCo 2, DART", times(programs), String::new()),
        ("FCL, yes or no", times(fcl.range(&["yes or no"], 4)), percent(fcl.range(&["yes or no"], 2))),
        ("FCL, contacts of primitives and hulls", times(contacts), percent(fcl.range(&several, 2))),
        (
            "FCL, one contact on meshes and octrees",
            times(fcl.range(&["one contact"], 4)),
            percent(fcl.range(&["one contact"], 2)),
        ),
        ("FCL, up to 100 contacts on them", times(fcl.range(&["up to 100"], 4)), percent(fcl.range(&["up to 100"], 2))),
        ("contacts recorded in ODE, `ccdMPRPenetration` alone", with_pos.clone(), calls.0[1][1].clone()),
        ("the same, `pos` NULL", without.clone(), calls.0[1][1].clone()),
    ];
    let table = markdown(
        "use|time over libccd's|libccd's answers that are wrong",
        lines.map(|(a, b, c)| vec![a.to_owned(), b, c]),
    );
    let sentence = format!(
        "**The price.** Whole simulations take {} times their time on libccd, contacts in FCL {} times, and `ccdMPRPenetration` alone {with_pos} \
         times with the position and {without} times without.",
        times(programs),
        times(contacts),
    );
    let on_engines = format!(
        "Contacts in FCL take [{} times](#what-fcl-costs-by-use) their time on libccd, [whole programs](../../include/README.md#prices) {} times.",
        times(contacts),
        times(programs),
    );
    [("README.md", format!("{sentence}\n\n{table}\n")), ("c-tests/engines/README.md", format!("{on_engines}\n"))]
}

/// Writes them into the pages.
pub fn write() {
    texts().iter().for_each(|(page, text)| write_between_marks(page, "price", text));
}

fn percent(range: [f64; 2]) -> String {
    let [low, high] = range.map(|v| if v == 0.0 { "0".to_owned() } else { format!("{v}") });
    if low == high { low } else { format!("{low} to {high} %") }
}

/// The pages have the price of the tables as they are; `price` writes it anew.
#[test]
fn the_pages_have_it() {
    for (page, text) in texts() {
        let found = std::fs::read_to_string(root().join(page)).expect("a page");
        assert!(found.contains(&format!("<!-- price -->\n{text}<!-- end -->")), "{page}: {text}");
    }
}
