// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tables: one row a pair set, one column a method.

use std::io::Write as _;
use std::path::PathBuf;

use clap::Args;
use comfy_table::{Table, presets::ASCII_MARKDOWN};

use crate::harness;
use crate::lab::csv::{self, table};
use crate::lab::libraries::Libraries;
use crate::lab::measure::{self, Row};
use crate::lab::methods::{self, Method, Start};
use crate::lab::recorded::{MOTIONS, RANDOM, SHALLOW, ours};
use crate::lab::scene::Scene;
use crate::peers::{self, Compiled};
use crate::progress;

#[derive(Args)]
pub struct Options {
    /// Pair sets; default: the random ones, the shallow ones and the motions.
    #[arg(long, value_delimiter = ',')]
    sets: Vec<String>,
    /// Repetitions of each timing.
    #[arg(long, default_value_t = 9)]
    repetitions: usize,
    /// Poses of each set.
    #[arg(long, default_value_t = usize::MAX, hide_default_value = true)]
    poses: usize,
    /// Every figure, one line a set and method.
    #[arg(long)]
    csv: Option<PathBuf>,
}

table! {
    /// A figure of `published.csv`.
    pub struct Published {
        pub set: String,
        pub method: String,
        pub start: Option<String>,
        pub supports: f64,
        pub ns: f64,
        pub nonminimal: Option<f64>,
    }
}

/// Figures of the paper's own implementation and of MuJoCo, measured elsewhere.
pub fn published() -> Vec<Published> {
    csv::read(&harness::root().join("c-tests/bench/published.csv"))
}

fn roster<'a>(libraries: &'a Libraries, compiled: &Compiled, scene: &Scene) -> Vec<Method<'a>> {
    let mut all = vec![methods::mpr(libraries, &libraries.system, 1e-6)];
    all.extend([1e-4, 1e-6, 1e-10].map(|t| methods::libccd_epa(libraries, t)));
    all.extend(ours(libraries, scene));
    let motion = scene.motion > 0;
    let starts: &[Start] = if motion {
        &[Start::Centres, Start::Warm]
    } else {
        &[
            Start::Five,
            Start::TwentyFive,
            Start::FortyFive,
            Start::Centres,
        ]
    };
    for &start in starts {
        all.push(methods::paper(libraries, true, start, 1e-6));
    }
    all.push(methods::paper(libraries, false, starts[0], 1e-6));
    if !motion {
        all.extend(methods::deep(libraries, scene, Start::Five));
    }
    all.push(peers::parry(libraries));
    all.extend(compiled.bullet(libraries));
    all.extend(compiled.fcl(libraries, 1e-6));
    all.extend(compiled.coal(libraries, 1e-6));
    all
}

/// A column's heading.
fn label(row: &Row) -> String {
    let start = match row.start.as_str() {
        "" => String::new(),
        "5" | "25" | "45" => format!(" {}°", row.start),
        s => format!(" {s}"),
    };
    match row.tolerance {
        // 1e-6 is what every table is about.
        Some(1e-6) if !row.method.ends_with("EPA") && row.method != "minimum" => {
            format!("{}{start}", row.method)
        }
        Some(t) => format!("{}{start} {t:e}", row.method),
        None => format!("{}{start}", row.method),
    }
}

/// One table: a figure of every method (columns, in order of appearance) on every set.
fn table(
    title: &str,
    rows: &[Row],
    published: &[Published],
    figure: &dyn Fn(&Row) -> String,
    theirs: &dyn Fn(&Published) -> Option<String>,
) {
    let mut columns: Vec<String> = Vec::new();
    let mut sets: Vec<&str> = Vec::new();
    for row in rows {
        if !columns.contains(&label(row)) {
            columns.push(label(row));
        }
        if !sets.contains(&row.set.as_str()) {
            sets.push(&row.set);
        }
    }
    let name = |p: &Published| match p.start.as_deref() {
        Some(s @ ("5" | "25" | "45")) => format!("{} {s}°", p.method),
        Some(s) => format!("{} {s}", p.method),
        None => p.method.clone(),
    };
    let mut foreign: Vec<String> = Vec::new();
    for p in published.iter().filter(|p| sets.contains(&p.set.as_str())) {
        if theirs(p).is_some() && !foreign.contains(&name(p)) {
            foreign.push(name(p));
        }
    }
    let mut out = Table::new();
    out.load_style(ASCII_MARKDOWN);
    let head = ["set".to_owned()].into_iter();
    out.set_header(
        head.chain(columns.iter().cloned())
            .chain(foreign.iter().map(|f| format!("*{f}*"))),
    );
    for set in &sets {
        let mut line = vec![(*set).to_owned()];
        for column in &columns {
            let row = rows.iter().find(|r| r.set == *set && label(r) == *column);
            line.push(row.map(figure).unwrap_or_default());
        }
        for column in &foreign {
            let p = published
                .iter()
                .find(|p| p.set == *set && name(p) == *column);
            line.push(p.and_then(theirs).unwrap_or_default());
        }
        out.add_row(line);
    }
    println!("\n**{title}**\n\n{out}");
}

/// Ratios of geometric means over the random sets.
fn ratios(rows: &[Row]) {
    let mut columns: Vec<String> = Vec::new();
    for row in rows.iter().filter(|r| RANDOM.contains(&r.set.as_str())) {
        if !columns.contains(&label(row)) {
            columns.push(label(row));
        }
    }
    let over = |column: &str, without: &str, f: &dyn Fn(&Row) -> Option<f64>| {
        let of = rows
            .iter()
            .filter(|r| label(r) == column && RANDOM.contains(&r.set.as_str()) && r.set != without);
        let values: Option<Vec<f64>> = of.map(f).collect();
        values
            .filter(|v| !v.is_empty())
            .map(|v| measure::geometric_mean(&v))
    };
    let epa = over("libccd EPA 1e-6", "", &|r| r.ns);
    let mpr = over("libccd MPR", "sph_sph", &|r| r.ns);
    let mut out = Table::new();
    out.load_style(ASCII_MARKDOWN);
    out.set_header([
        "method",
        "supports",
        "ns",
        "times as fast as libccd EPA 1e-6",
        "time over libccd MPR's, without sph_sph",
    ]);
    let show =
        |x: Option<f64>, digits: usize| x.map(|x| format!("{x:.digits$}")).unwrap_or_default();
    for column in &columns {
        let ns = over(column, "", &|r| r.ns);
        let ns_but = over(column, "sph_sph", &|r| r.ns);
        out.add_row([
            column.clone(),
            show(over(column, "", &|r| r.supports), 2),
            show(ns, 0),
            show(epa.zip(ns).map(|(e, n)| e / n), 2),
            show(mpr.zip(ns_but).map(|(m, n)| n / m), 2),
        ]);
    }
    println!("\n**Geometric means over the random sets measured**\n\n{out}");
}

pub fn run(options: &Options) {
    let libraries = Libraries::open();
    let compiled = Compiled::build(&libraries);
    let sets: Vec<&str> = if options.sets.is_empty() {
        [&RANDOM[..], &SHALLOW, &MOTIONS].concat()
    } else {
        options.sets.iter().map(String::as_str).collect()
    };
    println!("{}", libraries.machine());
    for (name, why) in &compiled.missing {
        println!(
            "not measured here: {name}: {}",
            why.lines().next().unwrap_or("")
        );
    }
    let bar = progress::bar(sets.len() as u64, "tables");
    let mut rows = Vec::new();
    for set in sets {
        bar.set_message(set.to_owned());
        let scene = Scene::load(&libraries, set, options.poses);
        let mut methods = roster(&libraries, &compiled, &scene);
        let ns = measure::times(&scene, &mut methods, options.repetitions, || bar.tick());
        for (method, ns) in methods.iter_mut().zip(ns) {
            rows.push(Row {
                ns: Some(ns),
                ..measure::judge(&libraries, &scene, method)
            });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let published = published();
    let none = |_: &Published| None;
    table(
        "Support points of D per query",
        &rows,
        &published,
        &|r| r.supports.map_or("-".into(), |s| format!("{s:.1}")),
        &|p| Some(format!("{:.1}", p.supports)),
    );
    table(
        "Time per query, ns",
        &rows,
        &published,
        &|r| r.ns.map_or("-".into(), |n| format!("{n:.0}")),
        &|p| Some(format!("{:.0}", p.ns)),
    );
    table(
        "Mean |depth error| over the answers within 1 mm, m",
        &rows,
        &[],
        &|r| format!("{:.1e}", r.mean_error_1mm),
        &none,
    );
    table(
        "Mean |depth error| over all answers, m",
        &rows,
        &[],
        &|r| format!("{:.1e}", r.mean_error),
        &none,
    );
    table(
        "Largest |depth error|, m",
        &rows,
        &[],
        &|r| format!("{:.1e}", r.max_error),
        &none,
    );
    table(
        "More than 1 mm too deep / too shallow / not answered, percent",
        &rows,
        &published,
        &|r| format!("{:.1} / {:.1} / {:.1}", r.nonminimal, r.shallow, r.missed),
        &|p| p.nonminimal.map(|n| n.to_string()),
    );
    table(
        "Mean direction error over the answers within 1 mm, mrad",
        &rows,
        &[],
        &|r| format!("{:.2}", r.direction),
        &none,
    );
    table(
        "Unsound residual, largest h(dir) − depth, m",
        &rows,
        &[],
        &|r| format!("{:.1e}", r.unsound),
        &none,
    );
    table(
        "Proven gap, largest depth − depth_lower, m",
        &rows,
        &[],
        &|r| r.gap.map_or("-".into(), |g| format!("{g:.1e}")),
        &none,
    );
    ratios(&rows);
    println!(
        "\nColumns in italics come from `c-tests/bench/published.csv`: the paper's own implementation and MuJoCo's, \
         measured on another machine and day. Their supports compare, their times only roughly."
    );
    if let Some(path) = &options.csv {
        csv::write(path, &libraries.machine(), &rows);
    }
    std::io::stdout().flush().expect("standard output");
}
