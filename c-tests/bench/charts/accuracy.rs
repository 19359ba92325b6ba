// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Speed against accuracy: every method at every tolerance on every kind of pair.

use plotters::style::RGBColor;

use super::figure::{self, Curve, Look, Mark, Panel, Unit};
use super::{Bench, Page, look, name};
use crate::lab::measure::{self, Row};
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::recorded::{MOTIONS, RANDOM};
use crate::lab::scene::Scene;
use crate::{peers, progress};

/// Tolerances asked for, metres (libccd's EPA takes them as squares).
fn tolerances(quick: bool) -> Vec<f64> {
    let step = if quick { 2 } else { 1 };
    (2..=12).step_by(step).map(|k| 10_f64.powi(-k)).collect()
}

fn roster<'a>(bench: &Bench<'a>, scene: &Scene) -> Vec<Method<'a>> {
    let libraries = bench.libraries;
    let mut all = Vec::new();
    let frames = scene.motion > 0;
    for t in tolerances(bench.quick) {
        all.push(methods::mpr(libraries, &libraries.system, t));
        all.push(methods::libccd_epa(libraries, t));
        let start = if frames { Start::Warm } else { Start::Five };
        all.push(methods::paper(libraries, true, start, t));
        all.push(methods::paper(libraries, false, start, t));
        all.push(methods::mpr(libraries, &libraries.ours, t));
        all.push(methods::extension(libraries, Ask::Local, start, t));
        let start = if frames { Start::Warm } else { Start::None };
        all.push(methods::extension(libraries, Ask::Minimum, start, t));
    }
    if !frames {
        all.extend(methods::deep(libraries, scene, Start::Five));
    }
    all.extend(bench.compiled.bullet(libraries));
    all.extend(bench.compiled.coal(libraries, 1e-6));
    // Its own default: an assertion in it ends the process at others.
    all.extend(bench.compiled.fcl(libraries, 1e-6));
    all.push(peers::parry(libraries));
    all
}

/// Every method's cost on every scene, a curve a method through its tolerances.
pub fn curves(rows: &[&Row], cost: &dyn Fn(&Row) -> Option<f64>) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in rows {
        let Some(cost) = cost(row) else { continue };
        // Below the last digit of a metre there is nothing to see.
        let point = (row.mean_error.max(1e-16), cost);
        let label = name(row);
        match curves.iter_mut().find(|c| c.label == label) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve {
                label,
                look: look(row),
                points: vec![point],
            }),
        }
    }
    curves
}

const SUPPORTS: (&str, Unit) = ("support points per query", Unit::Count);
const TIME: (&str, Unit) = ("time per query", Unit::Seconds);

/// The four kinds of pairs, and the methods, of the picture in front.
const FRONT: [&str; 4] = ["box_box", "p642_p642", "cyl_box", "cap_cap"];
const IN_FRONT: [&str; 6] = [
    "libccd MPR",
    "libccd EPA",
    "Algorithm 4/5",
    "MPR",
    "local",
    "minimum",
];

fn seconds(row: &Row) -> Option<f64> {
    row.ns.map(|n| n * 1e-9)
}

/// A panel a set, a curve a method: what it costs against its error.
fn picture(
    page: &Page,
    file: &str,
    title: &str,
    rows: &[&Row],
    (sets, columns): (&[&str], usize),
    y: (&'static str, Unit),
    cost: &dyn Fn(&Row) -> Option<f64>,
) {
    let panels: Vec<Panel> = sets
        .iter()
        .map(|set| {
            let of: Vec<&Row> = rows.iter().copied().filter(|r| r.set == *set).collect();
            Panel {
                title: super::kind(set),
                x: ("mean |depth error|", Unit::Metres),
                y,
                limit: of.first().map(|r| r.truth_gap),
                curves: curves(&of, cost),
            }
        })
        .collect();
    let notes = [
        "left of the dashes the truth is not known".to_owned(),
        page.footer(),
    ];
    figure::grid(&page.file(file), title, columns, &panels, &notes);
}

pub fn measure(bench: &Bench) -> Vec<Row> {
    let sets = [&RANDOM[..], &MOTIONS].concat();
    let bar = progress::bar(sets.len() as u64, "speed against accuracy");
    let mut rows = Vec::new();
    for set in sets {
        bar.set_message(set);
        let scene = Scene::load(bench.libraries, set, bench.poses());
        let mut methods = roster(bench, &scene);
        let ns = measure::times(&scene, &mut methods, bench.repetitions(), || bar.tick());
        for (method, ns) in methods.iter_mut().zip(ns) {
            rows.push(Row {
                ns: Some(ns),
                ..measure::judge(bench.libraries, &scene, method)
            });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    rows
}

/// What a finer tolerance costs: a curve for each kind of pair.
fn tolerance(page: &Page, rows: &[Row]) {
    // Hues that are alike are next to each other, and have another mark.
    let marks = [Mark::Dot, Mark::Ring, Mark::Triangle, Mark::Cross];
    let palette = [
        (220, 38, 38),
        (234, 88, 12),
        (202, 138, 4),
        (101, 163, 13),
        (22, 145, 70),
        (13, 148, 136),
        (14, 165, 233),
        (37, 99, 235),
        (124, 58, 237),
        (192, 38, 211),
        (120, 113, 108),
    ];
    let curves = |method: &str, start: &str, cost: &dyn Fn(&Row) -> Option<f64>| {
        let of = |set: &str| -> Vec<(f64, f64)> {
            let mine = rows
                .iter()
                .filter(|r| r.set == set && r.method == method && r.start == start);
            mine.filter_map(|r| Some((r.tolerance?, cost(r)?)))
                .collect()
        };
        let curve = |((set, (r, g, b)), mark): ((&&str, (u8, u8, u8)), Mark)| Curve {
            label: super::kind(set),
            look: Look {
                colour: RGBColor(r, g, b),
                mark,
                bold: false,
                dashed: false,
            },
            points: of(set),
        };
        let marked = RANDOM.iter().zip(palette).zip(marks.into_iter().cycle());
        marked.map(curve).collect::<Vec<_>>()
    };
    let x = ("tolerance", Unit::Metres);
    let error = ("mean |depth error| within 1 mm", Unit::Metres);
    let exact = |r: &Row| Some(r.mean_error_1mm.max(1e-16));
    let panel = |title: &str, y, curves| Panel {
        title: title.to_owned(),
        x,
        y,
        curves,
        limit: None,
    };
    let panels = [
        panel(
            "local, guess 5° off: supports",
            SUPPORTS,
            curves("local", "5", &|r| r.supports),
        ),
        panel(
            "local, guess 5° off: time",
            TIME,
            curves("local", "5", &seconds),
        ),
        panel(
            "local, guess 5° off: error",
            error,
            curves("local", "5", &exact),
        ),
        panel(
            "minimum: supports",
            SUPPORTS,
            curves("minimum", "", &|r| r.supports),
        ),
        panel("minimum: time", TIME, curves("minimum", "", &seconds)),
        panel("minimum: error", error, curves("minimum", "", &exact)),
    ];
    figure::grid(
        &page.file("tolerance.svg"),
        "What a tolerance costs",
        3,
        &panels,
        &[page.footer()],
    );
}

pub fn draw(page: &Page, rows: &[Row]) {
    tolerance(page, rows);
    let all: Vec<&Row> = rows.iter().collect();
    let some = rows.iter().filter(|r| IN_FRONT.contains(&&*r.method));
    picture(
        page,
        "front.svg",
        "Time of a query against its error",
        &some.collect::<Vec<_>>(),
        (&FRONT, 2),
        TIME,
        &seconds,
    );
    for (sets, file, what) in [
        (&RANDOM[..], "accuracy", "independent poses, guesses 5° off"),
        (
            &MOTIONS[..],
            "frames",
            "motions of 0.1° and 0.1 mm a frame, warm",
        ),
    ] {
        picture(
            page,
            &format!("{file}_time.svg"),
            &format!("Time against error: {what}"),
            &all,
            (sets, 3),
            TIME,
            &seconds,
        );
        picture(
            page,
            &format!("{file}_supports.svg"),
            &format!("Support points against error: {what}"),
            &all,
            (sets, 3),
            SUPPORTS,
            &|r| r.supports,
        );
    }
}
