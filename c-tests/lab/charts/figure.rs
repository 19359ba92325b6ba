// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts as SVG: panels of curves over logarithmic axes, with one legend below.

use std::path::Path;

use plotters::prelude::*;

use crate::measuring::measure::Row;
use crate::measuring::methods::Entry;

/// Title of an axis, and the value of a row; none where it was not measured.
pub type Axis = (&'static str, fn(&Row) -> Option<f64>);

pub const SUPPORTS: Axis = ("support points per query", |row| Some(row.supports));
pub const TIME: Axis = ("time per query, s", |row| row.ns.map(|ns| ns * 1e-9));

/// A curve for each label of the rows, through its rows as they come; and a line across at an x.
pub struct Panel<'a> {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub rows: Vec<&'a Row>,
    pub limit: Option<f64>,
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Returns the line of a row's curve: a hue for each method, thick for this library's.
fn line(row: &Row) -> ShapeStyle {
    let number = Entry::number(&row.method);
    // With this step any two of the first 20 methods with the same lightness are a tenth of the circle apart.
    let (hue, lightness) = ((number as f64 * 0.15).fract(), [0.3, 0.45][number % 2]);
    HSLColor(hue, 0.8, lightness).stroke_width(if row.ours { 3 } else { 1 })
}

/// Draws the curves of a panel.
fn draw(panel: &Panel, legend: &[&Row], area: &DrawingArea<SVGBackend, plotters::coord::Shift>) -> Drawn {
    let point = |row: &&Row| (panel.x.1)(row).zip((panel.y.1)(row));
    let range = |value: fn((f64, f64)) -> f64| {
        let values = panel.rows.iter().filter_map(point).map(value).filter(|v| *v > 0.0);
        let (low, high) = values.fold((f64::MAX, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        low / 1.35..high * 1.35
    };
    let (xs, ys) = (range(|p| p.0), range(|p| p.1));
    let mut builder = ChartBuilder::on(area);
    builder.caption(&panel.title, ("sans-serif", 16)).margin(10).x_label_area_size(38).y_label_area_size(60);
    let mut chart = builder.build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale())?;
    let label = |v: &f64| if (0.99..1e5).contains(v) { format!("{v:.0}") } else { format!("{v:.0e}") };
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT).x_labels(5).y_labels(5).x_label_formatter(&label).y_label_formatter(&label);
    mesh.x_desc(panel.x.0).y_desc(panel.y.0).draw()?;
    if let Some(limit) = panel.limit.filter(|limit| xs.contains(limit)) {
        chart.draw_series(DashedLineSeries::new([(limit, ys.start), (limit, ys.end)], 4, 4, BLACK.into()))?;
    }
    for first in legend {
        let curve = panel.rows.iter().filter(|row| row.label() == first.label()).filter_map(point);
        chart.draw_series(LineSeries::new(curve, line(first).filled()).point_size(3))?;
    }
    Ok(())
}

/// Panels beside each other.
const COLUMNS: usize = 3;

/// Draws the panels, then the legend and the notes.
pub fn grid(path: &Path, title: &str, mut panels: Vec<Panel>, notes: &[String]) -> Drawn {
    panels.retain(|panel| !panel.rows.is_empty());
    let mut legend: Vec<&Row> = panels.iter().flat_map(|panel| panel.rows.iter().copied()).collect();
    legend.sort_by_key(|row| row.label());
    legend.dedup_by_key(|row| row.label());
    let rows = panels.len().div_ceil(COLUMNS);
    let (top, below) = (290 * rows as u32, 20 * legend.len().div_ceil(2));
    let root = SVGBackend::new(path, (900, 50 + top + (below + 20 * notes.len()) as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, foot) = root.titled(title, ("sans-serif", 20))?.split_vertically(top);
    head.split_evenly((rows, COLUMNS)).iter().zip(&panels).try_for_each(|(cell, panel)| draw(panel, &legend, cell))?;
    let cells = (0..).map(|k| (16 + 440 * (k % 2), 8 + 20 * (k / 2)));
    for (row, (x, y)) in legend.iter().zip(cells) {
        foot.draw(&PathElement::new([(x, y), (x + 28, y)], line(row)))?;
        foot.draw(&Text::new(row.label(), (x + 36, y - 6), ("sans-serif", 14)))?;
    }
    for (note, y) in notes.iter().zip((below as i32 + 8..).step_by(20)) {
        foot.draw(&Text::new(note.clone(), (16, y), ("sans-serif", 12)))?;
    }
    Ok(root.present()?)
}
