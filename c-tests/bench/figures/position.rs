// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the contact position of a body that tips over is, by libccd, by this library and by
//! integration: what `tests/extension/pressure.c` says of tilts.

use serde::{Deserialize, Serialize};

use super::figure::{self, Look, Mark, Panel, Unit};
use super::{Bench, GREY, Page};
use crate::harness::Program;
use crate::measuring::csv;

/// How far off a body's middle its contact position is, metres.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Position {
    pub body: String,
    pub degrees: f64,
    pub truth: f64,
    pub ours: f64,
    pub libccd: f64,
}

pub fn measure(_: &Bench) -> Vec<Position> {
    let program =
        Program::c("pressure").source("tests/extension/pressure.c").link_ours_renamed_and_system().without_tools();
    let lines = program.build().run(["tilt"]).stdout;
    csv::rows(&lines)
}

pub fn draw(page: &Page, all: &[Position]) {
    let mut bodies: Vec<&str> = all.iter().map(|p| p.body.as_str()).collect();
    bodies.dedup();
    type Value = fn(&Position) -> f64;
    let lines: [(&str, Look, Value); 3] = [
        ("libccd MPR", Look::new((239, 68, 68), Mark::Triangle, false), |p| p.libccd),
        ("warmccd MPR", Look::new((37, 99, 235), Mark::Triangle, true), |p| p.ours),
        ("integral", Look::new(GREY, Mark::Ring, false), |p| p.truth),
    ];
    let panel = |body: &&str| {
        let points = lines.iter().flat_map(|&(label, look, value)| {
            let of = all.iter().filter(|p| p.body == **body);
            of.map(move |p| (label.to_owned(), look, (p.degrees, value(p))))
        });
        let (x, y) = (("tilt", Unit::Degrees), ("off its middle", Unit::Metres));
        Panel::new(body, x, y, figure::curves(points))
    };
    let panels: Vec<Panel> = bodies.iter().map(panel).collect();
    figure::grid(
        &page.file("position.svg"),
        "Contact position of a body of a quarter metre, 1 mm deep, that tips over",
        2,
        &panels,
        &[page.footer()],
    );
}
