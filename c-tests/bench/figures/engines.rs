// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Compares this library with the penetration solvers of other engines over the overlapping pairs
//! of the recorded contacts: instructions, support points, time, wrong answers.

use std::process::Command;

use clap::Args;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::figure::{self, Bar};
use super::{Options as Charts, Page, results};
use crate::harness;
use crate::measuring::libraries::Libraries;
use crate::measuring::methods::{self, Ask, Method, Start};
use crate::measuring::scene::Scene;
use crate::measuring::{callgrind, csv, measure};
use crate::peers::{self, Compiled};

/// Asked of every engine whose tolerance is not built in, metres.
const TOLERANCE: f64 = 1e-6;

#[derive(Args, Clone)]
pub struct Options {
    /// Instructions are counted for every n-th contact; the rest is measured for all.
    #[arg(long, default_value_t = 5)]
    every: usize,
    /// Set in the process that callgrind watches.
    #[arg(long, hide = true)]
    watched: bool,
}

/// One engine on the recorded contacts.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Engine {
    pub engine: String,
    pub ours: bool,
    pub contacts: usize,
    pub supports: f64,
    /// Instructions of a query: of the support functions, and besides.
    pub callbacks: f64,
    pub solver: f64,
    pub ns: f64,
    /// Percent: overlaps answered by no hit or by a failure.
    pub missed: f64,
    /// Depths more than 1 % and two tolerances above, or below, the least.
    pub deep: f64,
    pub shallow: f64,
    /// Directions along which the depth is so much more than the least.
    pub astray: f64,
    /// Any of these.
    pub wrong: f64,
}

/// The recorded pairs that overlap by more than a nanometre, each asked cold.
fn contacts(libraries: &Libraries) -> Scene {
    let mut scene = Scene::recorded(libraries, usize::MAX);
    scene.pairs.retain(|pair| pair.truth.depth > 1e-9);
    scene
}

fn roster<'a>(libraries: &'a Libraries, compiled: &Compiled) -> Vec<Method<'a>> {
    let asked = [(Ask::Penetration, Start::None), (Ask::SystemMpr, Start::None), (Ask::SystemEpa, Start::None)];
    let own = asked.map(|(ask, start)| methods::of(libraries, ask, start, TOLERANCE));
    let peers = compiled.all(libraries).chain([peers::parry(libraries)]);
    own.into_iter().chain(peers).collect()
}

/// A call's name in full.
fn name(method: &str) -> String {
    match method {
        "penetration" => "warmccd `ccdPenetration`".to_owned(),
        "libccd MPR" => "libccd 2.1 `ccdMPRPenetration`".to_owned(),
        "libccd EPA" => "libccd 2.1 `ccdGJKPenetration`".to_owned(),
        other => other.to_owned(),
    }
}

/// Percent of the contacts answered wrongly: missed, too deep, too shallow, astray, any of these.
fn wrong(libraries: &Libraries, scene: &Scene, method: &mut Method) -> [f64; 5] {
    let mut counts = [0_usize; 5];
    for pair in &scene.pairs {
        let Some(answer) = method.query(scene, pair) else {
            counts[0] += 1;
            counts[4] += 1;
            continue;
        };
        let least = pair.truth.depth;
        let above = |depth: f64| depth > 1.01 * least + 2.0 * TOLERANCE || depth.is_nan();
        let unit = Vector3::from(answer.dir).normalize().into();
        let faults = [
            above(answer.depth),
            answer.depth < 0.99 * least - 2.0 * TOLERANCE,
            above(measure::support_value(libraries, pair, &unit)),
        ];
        for (count, fault) in counts[1..].iter_mut().zip(faults) {
            *count += usize::from(fault);
        }
        counts[4] += usize::from(faults.contains(&true));
    }
    counts.map(|n| 100.0 * n as f64 / scene.pairs.len() as f64)
}

fn measure_all(libraries: &Libraries, compiled: &Compiled, options: &Options) -> Vec<Engine> {
    let scene = contacts(libraries);
    let mut methods = roster(libraries, compiled);
    let words = format!("--every={}", options.every);
    let counts = callgrind::counts(&["engines", "--watched", &words]).unwrap_or_else(|why| {
        let last = why.lines().last().unwrap_or("");
        println!("instructions not counted: {last}");
        Vec::new()
    });
    let counted = scene.pairs.len().div_ceil(options.every) as f64;
    let times = measure::times(&scene, &mut methods, 5);
    let rows = methods.iter_mut().zip(times).enumerate().map(|(k, (method, ns))| {
        let count = counts.get(k).copied().unwrap_or_default();
        let solver = count.solver + if method.inside { count.program } else { 0 };
        let [missed, deep, shallow, astray, wrong] = wrong(libraries, &scene, method);
        Engine {
            engine: name(&method.name),
            ours: method.ours,
            contacts: scene.pairs.len(),
            supports: measure::judge(libraries, &scene, method).supports,
            callbacks: count.callbacks as f64 / counted,
            solver: solver as f64 / counted,
            ns,
            missed,
            deep,
            shallow,
            astray,
            wrong,
        }
    });
    let mut rows: Vec<Engine> = rows.collect();
    rows.sort_by(|a, b| (a.callbacks + a.solver).total_cmp(&(b.callbacks + b.solver)));
    rows
}

fn table(rows: &[Engine]) -> String {
    let base = rows.iter().find(|r| r.engine.starts_with("libccd 2.1 `ccdMPR"));
    let percent = |p: f64| {
        if p == 0.0 { "0".to_owned() } else { format!("{p:.2} %") }
    };
    let lines = rows.iter().map(|r| {
        [
            r.engine.clone(),
            format!("{:.0}", r.callbacks + r.solver),
            format!("{:.1}", r.supports),
            base.map_or("-".to_owned(), |b| format!("{:.2}", r.ns / b.ns)),
            percent(r.missed),
            percent(r.deep),
            percent(r.shallow),
            percent(r.astray),
        ]
    });
    let head = "solver|instructions|support points|time|missed|too deep|too shallow|wrong direction";
    results::markdown(head, lines)
}

fn draw(page: &Page, rows: &[Engine]) {
    let bar = |r: &Engine| Bar {
        label: r.engine.replace('`', ""),
        parts: [r.callbacks, r.solver],
        note: format!("{:.1} % wrong", r.wrong),
        bold: r.ours,
    };
    let bars: Vec<Bar> = rows.iter().map(bar).collect();
    let contacts = rows.first().map_or(0, |r| r.contacts);
    let notes = [
        format!("{contacts} recorded contacts of an ODE pile; pale: support functions, full: the solver."),
        "Wrong: overlap missed, depth off by more than 1 %, or a direction that is more than 1 % deeper.".to_owned(),
        page.footer(),
    ];
    figure::bars(&page.file("engines.svg"), "Instructions of a query", &bars, &notes);
}

/// Downloads what engines.sh can have, measures all, and writes the table, its numbers and the picture.
pub fn run(options: &Options) {
    let libraries = Libraries::open();
    if !options.watched {
        let script = harness::root().join("c-tests/bench/engines.sh");
        let downloaded = Command::new("sh").arg(script).arg(peers::engines()).status();
        if let Err(why) = downloaded {
            println!("nothing downloaded: {why}");
        }
    }
    let compiled = Compiled::build(&libraries);
    if options.watched {
        let mut scene = contacts(&libraries);
        let mut k = 0;
        scene.pairs.retain(|_| {
            k += 1;
            (k - 1) % options.every == 0
        });
        for method in &mut roster(&libraries, &compiled) {
            callgrind::watched(&libraries, &scene, method);
        }
        return;
    }
    for (name, why) in &compiled.missing {
        println!("not measured here: {name}: {}", why.lines().next().unwrap_or(""));
    }
    let rows = measure_all(&libraries, &compiled, options);
    let page = Page { out: Charts::default_out(), machine: libraries.machine() };
    csv::write(&page.file("engines.csv"), &page.machine, &rows);
    draw(&page, &rows);
    let table = table(&rows);
    println!("{table}");
    harness::write_between_marks("README.md", "table engines", &format!("{table}\n"));
}
