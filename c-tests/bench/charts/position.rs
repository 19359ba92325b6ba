// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the contact position of a body that tips over is, by libccd, by this library and by
//! integration: what `extension/pressure.c` says of tilts.

use plotters::style::RGBColor;

use super::figure::{self, Curve, Look, Mark, Panel, Unit};
use super::{Bench, Page};
use crate::harness::Program;
use crate::lab::csv::table;
use crate::progress;

table! {
    /// How far off a body's middle its contact position is, metres.
    #[derive(Clone, Debug)]
    pub struct Position {
        pub body: String,
        pub degrees: f64,
        pub truth: f64,
        pub ours: f64,
        pub libccd: f64,
    }
}

pub fn measure(_: &Bench) -> Vec<Position> {
    let bar = progress::bar(1, "contact positions");
    let program = Program::c("pressure")
        .source("extension/pressure.c")
        .link_ours_renamed_and_system()
        .without_tools();
    let lines = program.build().run(["tilt"]).stdout;
    bar.finish_and_clear();
    let row = |line: &str| {
        let (body, numbers) = line.split_once(',')?;
        let mut numbers = numbers.split(',').map(str::parse);
        let mut next = || numbers.next()?.ok();
        Some(Position {
            body: body.to_owned(),
            degrees: next()?,
            truth: next()?,
            ours: next()?,
            libccd: next()?,
        })
    };
    let rows: Option<Vec<Position>> = lines.lines().map(row).collect();
    rows.filter(|rows| !rows.is_empty()).expect("positions")
}

pub fn draw(page: &Page, all: &[Position]) {
    let mut bodies: Vec<&str> = all.iter().map(|p| p.body.as_str()).collect();
    bodies.dedup();
    let look = |(r, g, b): (u8, u8, u8), mark, bold| Look {
        colour: RGBColor(r, g, b),
        mark,
        bold,
        dashed: false,
    };
    let curve = |label: &str, look, body: &str, value: &dyn Fn(&Position) -> f64| Curve {
        label: label.to_owned(),
        look,
        points: all
            .iter()
            .filter(|p| p.body == body)
            .map(|p| (p.degrees, value(p)))
            .collect(),
    };
    let panels: Vec<Panel> = bodies
        .iter()
        .map(|body| Panel {
            title: (*body).to_owned(),
            x: ("tilt", Unit::Degrees),
            y: ("off its middle", Unit::Metres),
            curves: vec![
                curve(
                    "libccd MPR",
                    look((239, 68, 68), Mark::Triangle, false),
                    body,
                    &|p| p.libccd,
                ),
                curve(
                    "warmccd MPR",
                    look((37, 99, 235), Mark::Triangle, true),
                    body,
                    &|p| p.ours,
                ),
                curve(
                    "integral",
                    look((107, 114, 128), Mark::Ring, false),
                    body,
                    &|p| p.truth,
                ),
            ],
            limit: None,
        })
        .collect();
    figure::grid(
        &page.file("position.svg"),
        "Contact position of a body of a quarter metre, 1 mm deep, that tips over",
        2,
        &panels,
        &[page.footer()],
    );
}
