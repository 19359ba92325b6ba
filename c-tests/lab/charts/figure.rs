// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts as SVG: panels of curves over logarithmic axes with one legend below.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::measuring::measure::Row;
use crate::measuring::methods::Start;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Title of an axis, and the value of a row; none where it was not measured.
pub type Axis = (&'static str, fn(&Row) -> Option<f64>);

pub const SUPPORTS: Axis = ("support points per query", |row| Some(row.supports));
pub const TIME: Axis = ("time per query, s", |row| row.ns.map(|ns| ns * 1e-9));
pub const VERTICES: Axis = ("vertices", |row| row.x);
/// The last digit of a metre is the finest error.
pub const ERROR: Axis = ("mean |depth error|, m", |row| Some(row.mean_error.max(1e-16)));

/// A curve for each label of the rows, through its rows as they come; and a line across at an x.
pub struct Panel<'a> {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub rows: Vec<&'a Row>,
    pub limit: Option<f64>,
}

/// Marks of the points of a curve.
#[derive(Clone, Copy)]
enum Mark {
    Dot,
    Ring,
    Triangle,
    Cross,
}

const RED: RGBColor = RGBColor(239, 68, 68);
const DARK_RED: RGBColor = RGBColor(153, 27, 27);
const BLUE: RGBColor = RGBColor(37, 99, 235);
const AMBER: RGBColor = RGBColor(217, 119, 6);
const GREEN: RGBColor = RGBColor(22, 145, 70);
const PURPLE: RGBColor = RGBColor(147, 51, 234);
const PINK: RGBColor = RGBColor(219, 39, 119);
const TEAL: RGBColor = RGBColor(13, 148, 136);
const GREY: RGBColor = RGBColor(107, 114, 128);

/// Colour and mark of each method that is drawn.
const STYLES: [(&str, RGBColor, Mark); 15] = [
    ("libccd ccdMPRPenetration", RED, Mark::Triangle),
    ("libccd ccdGJKPenetration", DARK_RED, Mark::Dot),
    ("ccdMPRPenetration", BLUE, Mark::Triangle),
    ("ccdPenetrationLocal", AMBER, Mark::Dot),
    ("ccdPenetrationProven", GREEN, Mark::Dot),
    ("Gao 2023, Algorithm 4/5", PURPLE, Mark::Dot),
    ("Gao 2023, Algorithm 3", PURPLE, Mark::Cross),
    ("ccdPenetrationLocal, climbing", AMBER, Mark::Triangle),
    ("DEEP", PINK, Mark::Triangle),
    ("Bullet EPA", GREY, Mark::Dot),
    ("FCL EPA", GREY, Mark::Ring),
    ("parry EPA", GREY, Mark::Triangle),
    ("MuJoCo 3 ccd", TEAL, Mark::Dot),
    ("Coal 3 EPA", TEAL, Mark::Ring),
    ("Jolt 5 EPA", TEAL, Mark::Cross),
];

/// Returns colour and mark of a row's curve.
fn style(row: &Row) -> (RGBColor, Mark) {
    let style = STYLES.iter().find(|style| style.0 == row.method);
    style.map_or((BLACK, Mark::Dot), |&(_, colour, mark)| (colour, mark))
}

/// Returns the line of a row's curve.
fn line(row: &Row) -> ShapeStyle {
    let share = if row.start == Start::Guess45 { 0.5 } else { 1.0 };
    style(row).0.mix(share).stroke_width(if row.ours { 3 } else { 1 })
}

/// Returns the mark of a row's curve, around a point of a chart or of the page.
fn mark<'b>(row: &Row) -> DynElement<'static, SVGBackend<'b>, (i32, i32)> {
    let line = line(row);
    match style(row).1 {
        Mark::Dot => Circle::new((0, 0), 3, line.filled()).into_dyn(),
        Mark::Ring => Circle::new((0, 0), 4, line).into_dyn(),
        Mark::Triangle => TriangleMarker::new((0, 0), 5, line.filled()).into_dyn(),
        Mark::Cross => Cross::new((0, 0), 4, line).into_dyn(),
    }
}

/// Returns the first row of each label.
fn legend<'a>(rows: impl Iterator<Item = &'a Row>) -> Vec<&'a Row> {
    let mut seen = std::collections::BTreeSet::new();
    rows.filter(|row| seen.insert(row.label())).collect()
}

impl Panel<'_> {
    fn draw(&self, area: &Area) -> Drawn {
        let point = |row: &&Row| (self.x.1)(row).zip((self.y.1)(row));
        let points: Vec<_> = self.rows.iter().filter_map(point).collect();
        let range = |value: fn(&(f64, f64)) -> f64| {
            let all = points.iter().map(value).filter(|v| *v > 0.0);
            let (low, high) = all.fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
            low / 1.35..high * 1.35
        };
        let (xs, ys) = (range(|p| p.0), range(|p| p.1));
        let mut builder = ChartBuilder::on(area);
        builder.caption(&self.title, ("sans-serif", 16)).margin(6).margin_right(20);
        let builder = builder.x_label_area_size(38).y_label_area_size(60);
        let mut chart = builder.build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale())?;
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT).x_labels(5).y_labels(5).x_desc(self.x.0).y_desc(self.y.0);
        let label = |v: &f64| if (0.99..1e5).contains(v) { format!("{v:.0}") } else { format!("{v:.0e}") };
        mesh.x_label_formatter(&label).y_label_formatter(&label).draw()?;
        if let Some(limit) = self.limit.filter(|limit| xs.contains(limit)) {
            chart.draw_series(DashedLineSeries::new([(limit, ys.start), (limit, ys.end)], 4, 4, BLACK.into()))?;
        }
        for first in legend(self.rows.iter().copied().filter(|row| point(row).is_some())) {
            let curve = self.rows.iter().filter(|row| row.label() == first.label()).filter_map(point);
            chart.draw_series(LineSeries::new(curve.clone(), line(first)))?;
            chart.draw_series(curve.map(|point| EmptyElement::at(point) + mark(first)))?;
        }
        Ok(())
    }
}

/// Draws panels in rows of `columns`, then the legend and the notes.
pub fn grid(path: &Path, title: &str, columns: usize, mut panels: Vec<Panel>, notes: &[String]) {
    panels.retain(|panel| !panel.rows.is_empty());
    let legend = legend(panels.iter().flat_map(|panel| panel.rows.iter().copied()));
    let rows = panels.len().div_ceil(columns);
    let (top, under) = (rows as u32 * 290, 20 * legend.len().div_ceil(2) as i32 + 16);
    let make = || -> Drawn {
        let height = 50 + top + under as u32 + 20 * notes.len() as u32;
        let root = SVGBackend::new(path, (900, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let (head, below) = root.titled(title, ("sans-serif", 20))?.split_vertically(top);
        head.split_evenly((rows, columns)).iter().zip(&panels).try_for_each(|(cell, panel)| panel.draw(cell))?;
        for (k, row) in (0..).zip(&legend) {
            let (x, y) = (16 + 440 * (k % 2), 8 + 20 * (k / 2));
            below.draw(&PathElement::new([(x, y), (x + 28, y)], line(row)))?;
            below.draw(&(EmptyElement::at((x + 14, y)) + mark(row)))?;
            below.draw(&Text::new(row.label(), (x + 36, y - 6), ("sans-serif", 14)))?;
        }
        for (note, y) in notes.iter().zip((under..).step_by(20)) {
            below.draw(&Text::new(note.clone(), (16, y), ("sans-serif", 12)))?;
        }
        Ok(root.present()?)
    };
    make().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
