// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The charts' page: the pictures and the tables behind them, with what a reader
//! needs to judge them. The page is its own template: a table with a mark there is
//! written between its marks, the others are printed.

use comfy_table::{Table, presets::ASCII_MARKDOWN};

use super::Page;
use super::coherence;
use super::models::Model;
use super::paper::{AS_PUBLISHED, PAPER};
use super::position::Position;
use super::split::Split;
use crate::lab::measure::Row;

/// Everything a run has measured.
pub struct Results {
    pub accuracy: Vec<Row>,
    pub paper: Vec<Row>,
    pub vertices: Vec<Row>,
    pub coherence: Vec<Row>,
    pub recorded: Vec<Row>,
    pub models: Vec<Model>,
    pub split: Vec<Split>,
    pub position: Vec<Position>,
}

fn markdown<const N: usize>(
    head: [&str; N],
    lines: impl IntoIterator<Item = [String; N]>,
) -> String {
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN);
    table.set_header(head);
    for line in lines {
        table.add_row(line);
    }
    table.to_string()
}

fn find<'a>(
    rows: &'a [Row],
    set: &str,
    method: &str,
    start: &str,
    tolerance: f64,
) -> Option<&'a Row> {
    rows.iter().find(|r| {
        r.set == set
            && r.method == method
            && r.start == start
            && r.tolerance.is_none_or(|t| t == tolerance)
    })
}

/// One of Tables I to III: ours, the paper's algorithm here, the paper's own figure.
fn paper_table(
    rows: &[Row],
    figure: &dyn Fn(&Row) -> f64,
    paper: &dyn Fn(&super::paper::Published) -> [f64; 4],
) -> String {
    let show = |row: Option<&Row>| row.map_or("-".to_owned(), |r| format!("{:.3}", figure(r)));
    let lines = PAPER.iter().flat_map(|p| {
        let local = |start| show(find(rows, p.pair, "local", start, 1e-6));
        let paper_method = |start| show(find(rows, p.pair, "Algorithm 4/5", start, AS_PUBLISHED));
        let epa = |t| show(find(rows, p.pair, "libccd EPA", "", t));
        let [a, b, c, e] = paper(p).map(|v| v.to_string());
        let empty = String::new;
        [
            [
                p.pair.to_owned(),
                "`ccdPenetrationLocal`".to_owned(),
                local("5"),
                local("25"),
                local("45"),
                empty(),
                empty(),
            ],
            [
                empty(),
                "Algorithm 4/5".to_owned(),
                paper_method("5"),
                paper_method("25"),
                paper_method("45"),
                epa(1e-6),
                epa(1e-10),
            ],
            [
                empty(),
                "*in the paper*".to_owned(),
                a,
                b,
                c,
                e.clone(),
                empty(),
            ],
        ]
    });
    markdown(
        [
            "pair",
            "",
            "5°",
            "25°",
            "45°",
            "libccd EPA 1e-6",
            "libccd EPA 1e-10",
        ],
        lines,
    )
}

fn times_faster(rows: &[Row]) -> String {
    let lines = PAPER.iter().map(|p| {
        let ns = |m: &str, s: &str, t: f64| find(rows, p.pair, m, s, t).and_then(|r| r.ns);
        let ratio = |m: &str, s: &str, t: f64| {
            let own = if m.starts_with("Algorithm") {
                AS_PUBLISHED
            } else {
                1e-6
            };
            let (epa, mine) = (ns("libccd EPA", "", t), ns(m, s, own));
            epa.zip(mine)
                .map_or("-".to_owned(), |(e, m)| format!("{:.1}", e / m))
        };
        [
            p.pair.to_owned(),
            ratio("local", "5", 1e-6),
            ratio("local", "5", 1e-10),
            ratio("minimum", "", 1e-6),
            ratio("Algorithm 4/5", "5", 1e-6),
            ratio("Algorithm 4/5", "5", 1e-10),
            format!("{:.1}", p.time[3] / p.time[0]),
        ]
    });
    markdown(
        [
            "pair",
            "local, EPA 1e-6",
            "local, EPA 1e-10",
            "minimum, EPA 1e-6",
            "Algorithm 4/5, EPA 1e-6",
            "Algorithm 4/5, EPA 1e-10",
            "*in the paper*",
        ],
        lines,
    )
}

fn supports(row: Option<&Row>) -> String {
    row.and_then(|r| r.supports)
        .map_or("-".to_owned(), |s| format!("{s:.1}"))
}

fn time(row: Option<&Row>) -> String {
    row.and_then(|r| r.ns)
        .map_or("-".to_owned(), |n| format!("{:.2}", n * 1e-3))
}

fn ablation(rows: &[Row]) -> String {
    let lines = super::paper::VERTICES.iter().map(|n| {
        let of = |method: &str| find(rows, &format!("p{n}_cap"), method, "45", AS_PUBLISHED);
        let (on, off) = (of("Algorithm 4/5"), of("Algorithm 3"));
        [
            n.to_string(),
            supports(on),
            supports(off),
            time(on),
            time(off),
        ]
    });
    markdown(
        [
            "vertices",
            "supports, on",
            "supports, off",
            "µs, on",
            "µs, off",
        ],
        lines,
    )
}

fn deep(rows: &[Row]) -> String {
    let lines = super::paper::VERTICES.iter().map(|n| {
        let of = |method: &str| {
            let own = if method == "local" {
                1e-6
            } else {
                AS_PUBLISHED
            };
            find(rows, &format!("p{n}hc_p{n}hc"), method, "5", own)
        };
        [
            n.to_string(),
            time(of("DEEP")),
            time(of("Algorithm 4/5")),
            time(of("local")),
        ]
    });
    markdown(
        ["vertices", "DEEP, µs", "Algorithm 4/5, µs", "local, µs"],
        lines,
    )
}

fn coherent(rows: &[Row]) -> String {
    let mut sets: Vec<&str> = Vec::new();
    for row in rows {
        if !sets.contains(&row.set.as_str()) {
            sets.push(&row.set);
        }
    }
    let until = |set: &str, method: &str| match coherence::stops_paying(rows, set, method) {
        Some(step) => format!("{step}°"),
        None => "always pays".to_owned(),
    };
    let at = |set: &str, method: &str, start: &str, x: f64| {
        supports(
            rows.iter()
                .find(|r| r.set == set && r.method == method && r.start == start && r.x == Some(x)),
        )
    };
    let lines = sets.into_iter().map(|set| {
        [
            super::kind(set),
            at(set, "local", "warm", 0.1),
            at(set, "local", "warm", 1.0),
            at(set, "local", "warm", 10.0),
            at(set, "local", "centres", 1.0),
            at(set, "libccd EPA", "", 1.0),
            until(set, "local"),
            until(set, "minimum"),
        ]
    });
    markdown(
        [
            "pair",
            "local, warm, 0.1°",
            "1°",
            "10°",
            "local, cold",
            "libccd EPA",
            "local: warm costs as much as cold from",
            "minimum: from",
        ],
        lines,
    )
}

fn recorded(rows: &[Row]) -> String {
    let lines = rows.iter().map(|r| {
        [
            super::name(r),
            r.queries.to_string(),
            r.overlaps.to_string(),
            supports(Some(r)),
            r.ns.map_or("-".to_owned(), |n| format!("{n:.0}")),
            format!("{:.1e}", r.mean_error),
            format!("{:.1e}", r.max_error),
            format!("{:.2}", r.nonminimal + r.shallow + r.missed),
        ]
    });
    markdown(
        [
            "method",
            "queries",
            "overlaps",
            "supports",
            "ns",
            "mean error, m",
            "largest, m",
            "off by more than 1 mm, %",
        ],
        lines,
    )
}

fn models(models: &[Model]) -> String {
    // One line a model, in the order measured.
    let mut seen: Vec<&Model> = Vec::new();
    let same =
        |a: &Model, b: &Model| a.body == b.body && a.model == b.model && a.vertices == b.vertices;
    for m in models {
        if !seen.iter().any(|x| same(x, m)) {
            seen.push(m);
        }
    }
    let lines = seen.iter().map(|m| {
        let of = |method: &str| (models.iter()).find(|x| same(x, m) && x.method.contains(method));
        let us = |x: Option<&Model>| x.map_or("-".to_owned(), |x| format!("{:.2}", x.ns * 1e-3));
        let supports =
            |x: Option<&Model>| x.map_or("-".to_owned(), |x| format!("{:.1}", x.supports));
        [
            m.body.clone(),
            if m.vertices == 0 {
                m.model.clone()
            } else {
                format!("{}, {} vertices", m.model, m.vertices)
            },
            format!("{:.1e}", m.modelling_error),
            format!("{:.1e}", m.query_error),
            us(of("local")),
            us(of("minimum")),
            us(of("distance")),
            supports(of("distance")),
            us(of("EPA")),
        ]
    });
    markdown(
        [
            "body",
            "model",
            "modelling error, m",
            "query error (local; core: distance), m",
            "local, µs",
            "minimum, µs",
            "signed distance (cold), µs",
            "its supports",
            "libccd EPA, µs",
        ],
        lines,
    )
}

fn instructions(split: &[Split]) -> String {
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
    markdown(
        [
            "pair",
            "method",
            "instructions",
            "support functions",
            "solver",
            "support functions, %",
        ],
        lines,
    )
}

/// Which methods no other beats in both supports and error, by kind of pair.
fn front(rows: &[Row]) -> String {
    let lines = crate::lab::recorded::RANDOM.iter().map(|set| {
        let best = super::accuracy::front(rows, set);
        let mut names: Vec<String> = Vec::new();
        for row in &best {
            let name = super::name(row);
            if !names.contains(&name) {
                names.push(name);
            }
        }
        [super::kind(set), names.join("; ")]
    });
    markdown(["pair", "on the front of supports against error"], lines)
}

/// Writes the page's tables between their marks, and prints those that have none there.
pub fn write(page: &Page, results: &Results) {
    let committed = crate::harness::root().join("c-tests/charts/README.md");
    let mut text = std::fs::read_to_string(&committed).expect("the charts' page");
    let tables = [
        ("MACHINE", page.machine.clone()),
        ("FRONT", front(&results.accuracy)),
        (
            "TABLE I: mean |depth error|, µm, of answers within 1 mm",
            paper_table(&results.paper, &|r| r.mean_error_1mm * 1e6, &|p| p.depth),
        ),
        (
            "TABLE II: mean direction error, mrad",
            paper_table(&results.paper, &|r| r.direction, &|p| p.direction),
        ),
        (
            "TABLE III: µs a query",
            paper_table(&results.paper, &|r| r.ns.unwrap_or(f64::NAN) * 1e-3, &|p| {
                p.time
            }),
        ),
        ("FASTER", times_faster(&results.paper)),
        ("SHORTCUT on and off", ablation(&results.vertices)),
        ("DEEP", deep(&results.vertices)),
        ("COHERENCE", coherent(&results.coherence)),
        ("RECORDED", recorded(&results.recorded)),
        ("MODELS", models(&results.models)),
        ("INSTRUCTIONS", instructions(&results.split)),
    ];
    for (name, table) in &tables {
        match between_marks(&text, name) {
            Some(place) => text.replace_range(place, &format!("{table}\n")),
            None => println!("\n{name}\n\n{table}"),
        }
    }
    let path = page.file("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// What stands between `<!-- table NAME -->` and the next `<!-- end -->`.
fn between_marks(text: &str, name: &str) -> Option<std::ops::Range<usize>> {
    let mark = format!("<!-- table {name} -->\n");
    let start = text.find(&mark)? + mark.len();
    let end = start + text[start..].find("<!-- end -->")?;
    Some(start..end)
}
