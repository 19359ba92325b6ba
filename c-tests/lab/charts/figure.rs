// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts as SVG: panels of curves over logarithmic axes with one legend below, and bars.

use std::path::Path;

use plotters::prelude::*;

use crate::measuring::measure::Row;
use crate::measuring::methods::{Entry, Mark, Start};

type Cell<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Title of an axis, and the value of a row; none where it was not measured.
#[derive(Clone, Copy)]
pub struct Axis(&'static str, fn(&Row) -> Option<f64>);

pub const SUPPORTS: Axis = Axis("support points per query", |row| Some(row.supports));
pub const TIME: Axis = Axis("time per query, s", |row| row.ns.map(|ns| ns * 1e-9));
pub const VERTICES: Axis = Axis("vertices", |row| row.x);
/// The last digit of a metre is the finest error.
pub const ERROR: Axis = Axis("mean |depth error|, m", |row| Some(row.mean_error.max(1e-16)));

struct Curve {
    label: String,
    style: ShapeStyle,
    mark: Mark,
    points: Vec<(f64, f64)>,
}

impl Curve {
    /// Returns the mark, around a point of a chart or of the page.
    fn mark<'b>(&self) -> DynElement<'static, SVGBackend<'b>, (i32, i32)> {
        match self.mark {
            Mark::Dot => Circle::new((0, 0), 3, self.style.filled()).into_dyn(),
            Mark::Ring => Circle::new((0, 0), 4, self.style).into_dyn(),
            Mark::Triangle => TriangleMarker::new((0, 0), 5, self.style.filled()).into_dyn(),
            Mark::Cross => Cross::new((0, 0), 4, self.style).into_dyn(),
        }
    }
}

/// Curves of rows, one for each label, each through its points as they come; and a line across at an x.
pub struct Panel {
    title: String,
    axes: [Axis; 2],
    curves: Vec<Curve>,
    limit: Option<f64>,
}

impl Panel {
    pub fn new<'a>(title: &str, x: Axis, y: Axis, rows: impl Iterator<Item = &'a Row>, limit: Option<f64>) -> Self {
        let mut curves: Vec<Curve> = Vec::new();
        for row in rows {
            let Some(point) = x.1(row).zip(y.1(row)) else { continue };
            match curves.iter_mut().find(|curve| curve.label == row.label()) {
                Some(curve) => curve.points.push(point),
                None => {
                    let (entry, share) =
                        (Entry::find(&row.method), if row.start == Start::Guess45 { 0.5 } else { 1.0 });
                    let (r, g, b) = entry.colour;
                    let style = RGBColor(r, g, b).mix(share).stroke_width(if entry.is_ours() { 3 } else { 1 });
                    curves.push(Curve { label: row.label(), style, mark: entry.mark, points: vec![point] });
                }
            }
        }
        Self { title: title.to_owned(), axes: [x, y], curves, limit }
    }

    fn draw(&self, area: &Cell) -> Drawn {
        let range = |values: &dyn Fn(&(f64, f64)) -> f64| {
            let all = self.curves.iter().flat_map(|curve| curve.points.iter().map(values)).filter(|v| *v > 0.0);
            let (low, high) = all.fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
            low / 1.35..high * 1.35
        };
        let (xs, ys) = (range(&|p| p.0), range(&|p| p.1));
        let mut builder = ChartBuilder::on(area);
        builder.caption(&self.title, ("sans-serif", 16)).margin(6).margin_right(20);
        let builder = builder.x_label_area_size(38).y_label_area_size(60);
        let mut chart = builder.build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale())?;
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT).x_labels(5).y_labels(5).x_desc(self.axes[0].0).y_desc(self.axes[1].0);
        mesh.x_label_formatter(&|v| label(*v)).y_label_formatter(&|v| label(*v)).draw()?;
        if let Some(limit) = self.limit.filter(|limit| xs.contains(limit)) {
            chart.draw_series(DashedLineSeries::new([(limit, ys.start), (limit, ys.end)], 4, 4, BLACK.into()))?;
        }
        for curve in &self.curves {
            chart.draw_series(LineSeries::new(curve.points.iter().copied(), curve.style))?;
            chart.draw_series(curve.points.iter().map(|&point| EmptyElement::at(point) + curve.mark()))?;
        }
        Ok(())
    }
}

fn label(v: f64) -> String {
    if (0.99..1e5).contains(&v) { format!("{v:.0}") } else { format!("{v:.0e}") }
}

fn write(path: &Path, title: &str, height: u32, notes: &[String], draw: impl FnOnce(&Cell) -> Drawn) {
    let foot = 20 * notes.len() as u32 + 10;
    let make = || -> Drawn {
        let root = SVGBackend::new(path, (900, 40 + height + foot)).into_drawing_area();
        root.fill(&WHITE)?;
        let (area, below) = root.titled(title, ("sans-serif", 20))?.split_vertically(height);
        for (note, y) in notes.iter().zip((4..).step_by(20)) {
            below.draw(&Text::new(note.clone(), (16, y), ("sans-serif", 12)))?;
        }
        draw(&area)?;
        Ok(root.present()?)
    };
    make().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// Draws panels in rows of `columns`, then the legend and the notes.
pub fn grid(path: &Path, title: &str, columns: usize, panels: &[Panel], notes: &[String]) {
    let panels: Vec<&Panel> = panels.iter().filter(|panel| !panel.curves.is_empty()).collect();
    let mut legend: Vec<_> = panels.iter().flat_map(|panel| &panel.curves).collect();
    let mut seen = std::collections::BTreeSet::new();
    legend.retain(|curve| seen.insert(&curve.label));
    let rows = panels.len().div_ceil(columns);
    let top = rows as u32 * 290;
    write(path, title, top + 10 * legend.len() as u32 + 20, notes, |area| {
        let (head, below) = area.split_vertically(top);
        head.split_evenly((rows, columns)).iter().zip(&panels).try_for_each(|(cell, panel)| panel.draw(cell))?;
        for (k, curve) in (0..).zip(legend) {
            let (x, y) = (16 + 440 * (k % 2), 8 + 20 * (k / 2));
            below.draw(&PathElement::new([(x, y), (x + 28, y)], curve.style))?;
            below.draw(&(EmptyElement::at((x + 14, y)) + curve.mark()))?;
            below.draw(&Text::new(curve.label.clone(), (x + 36, y - 6), ("sans-serif", 14)))?;
        }
        Ok(())
    });
}

/// Draws a bar of instructions for each row, those in the support functions pale, with its sum and its wrong answers.
pub fn bars(path: &Path, title: &str, rows: &[Row], notes: &[String]) {
    let most = rows.iter().map(Row::instructions).fold(1.0, f64::max);
    write(path, title, 26 * rows.len() as u32 + 8, notes, |area| {
        for (row, y) in rows.iter().zip((4..).step_by(26)) {
            let colour = if row.ours { RGBColor(37, 99, 235) } else { RGBColor(107, 114, 128) };
            let [start, pale, end] = [0.0, row.callbacks.unwrap_or_default(), row.instructions()]
                .map(|instructions| 300 + (430.0 * instructions / most) as i32);
            area.draw(&Rectangle::new([(start, y), (pale, y + 18)], colour.mix(0.45).filled()))?;
            area.draw(&Rectangle::new([(pale, y), (end, y + 18)], colour.filled()))?;
            area.draw(&Text::new(row.method.clone(), (16, y + 2), ("sans-serif", 14)))?;
            let note = format!("{:.0}, {:.1} % wrong", row.instructions(), row.wrong);
            area.draw(&Text::new(note, (end + 8, y + 2), ("sans-serif", 14)))?;
        }
        Ok(())
    });
}
