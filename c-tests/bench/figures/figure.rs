// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts: panels of curves over logarithmic axes, with a legend in the free cell or below, drawn by
//! plotters as SVG; 900 units wide, as wide as a page shows them.
//!
//! Ink and paper are two colours that nothing else uses; a style sheet in the file inverts them where the reader's system
//! is dark, and lightens two colours that are hard to see there: the red of libccd's EPA, and the grey of other libraries.

use std::path::Path;

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::measuring::measure::Row;
use crate::measuring::methods::{Entry, Mark, Start};

type Error = Box<dyn std::error::Error>;

const INK: RGBColor = RGBColor(31, 35, 41);
const FAINT: RGBColor = RGBColor(209, 213, 219);
const PAPER: RGBColor = RGBColor(254, 254, 253);
const STYLE: &str = "<style>@media (prefers-color-scheme: dark){\
    [fill=\"#1F2329\"]{fill:#E6EDF3}[stroke=\"#1F2329\"]{stroke:#E6EDF3}\
    [fill=\"#D1D5DB\"]{fill:#3A424D}[stroke=\"#D1D5DB\"]{stroke:#3A424D}\
    [fill=\"#FEFEFD\"]{fill:#0D1117}[stroke=\"#FEFEFD\"]{stroke:#0D1117}\
    [fill=\"#991B1B\"]{fill:#F9A8A8}[stroke=\"#991B1B\"]{stroke:#F9A8A8}\
    [fill=\"#6B7280\"]{fill:#9CA3AF}[stroke=\"#6B7280\"]{stroke:#9CA3AF}}</style>";

/// The look of a method, the same in every picture.
#[derive(Clone, Copy)]
struct Look {
    colour: RGBColor,
    mark: Mark,
    /// This library is drawn bolder.
    is_bold: bool,
}

impl Look {
    fn of(row: &Row) -> Self {
        let entry = Entry::find(&row.method);
        let (r, g, b) = entry.colour;
        let lighter = |c: u8| c + (255 - c) / 3;
        // The second guess of a method.
        let is_second = row.start == Start::Guess45 && entry.mark == Mark::Dot;
        let (colour, mark) = match is_second {
            true => (RGBColor(lighter(r), lighter(g), lighter(b)), Mark::Ring),
            false => (RGBColor(r, g, b), entry.mark),
        };
        Self { colour, mark, is_bold: entry.is_ours() }
    }

    fn line(&self) -> ShapeStyle {
        self.colour.stroke_width(if self.is_bold { 3 } else { 1 })
    }

    /// Returns the mark, around a point of a chart or of the page.
    fn mark<'b>(&self) -> DynElement<'static, SVGBackend<'b>, (i32, i32)> {
        let Self { colour, mark, is_bold } = *self;
        let size = if is_bold { 4 } else { 3 };
        match mark {
            Mark::Dot => Circle::new((0, 0), size, colour.filled()).into_dyn(),
            Mark::Ring => Circle::new((0, 0), size, colour.stroke_width(2)).into_dyn(),
            Mark::Triangle => TriangleMarker::new((0, 0), size + 1, colour.filled()).into_dyn(),
            Mark::Cross => Cross::new((0, 0), size, colour.stroke_width(2)).into_dyn(),
        }
    }
}

/// Title of an axis, the unit of its labels and the value of a row; none where it was not measured.
#[derive(Clone, Copy)]
pub struct Axis(&'static str, &'static str, fn(&Row) -> Option<f64>);

pub const SUPPORTS: Axis = Axis("support points per query", "", |row| Some(row.supports));
pub const TIME: Axis = Axis("time per query", "s", |row| row.ns.map(|ns| ns * 1e-9));
pub const VERTICES: Axis = Axis("vertices", "", |row| row.x);
/// The last digit of a metre is the finest error.
pub const ERROR: Axis = Axis("mean |depth error|", "m", |row| Some(row.mean_error.max(1e-16)));

impl Axis {
    /// Returns the label of a tick.
    fn label(&self, v: f64) -> String {
        const PREFIXES: [(f64, &str); 6] =
            [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f")];
        if self.1.is_empty() {
            return short(v);
        }
        // Ticks are powers of ten; 0.999 covers the rounding of their logarithms.
        let fitting = PREFIXES.iter().find(|(scale, _)| v >= scale * 0.999);
        let (scale, prefix) = fitting.unwrap_or(&PREFIXES[5]);
        format!("{} {prefix}{}", short(v / scale), self.1)
    }
}

/// Formats three digits at most, without trailing zeros.
fn short(v: f64) -> String {
    let digits = usize::from(v < 99.5) + usize::from(v < 9.95);
    let text = format!("{v:.digits$}");
    match digits {
        0 => text,
        _ => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
    }
}

struct Curve {
    label: String,
    look: Look,
    points: Vec<(f64, f64)>,
}

/// Curves of rows, one for each label, each through its points as they come.
pub struct Panel {
    title: String,
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
    /// A line across at this x, where a value loses its meaning.
    limit: Option<f64>,
}

impl Panel {
    pub fn new<'a>(title: &str, x: Axis, y: Axis, rows: impl Iterator<Item = &'a Row>, limit: Option<f64>) -> Self {
        let mut curves: Vec<Curve> = Vec::new();
        for row in rows {
            let Some(point) = x.2(row).zip(y.2(row)) else { continue };
            match curves.iter_mut().find(|curve| curve.label == row.label()) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve { label: row.label(), look: Look::of(row), points: vec![point] }),
            }
        }
        Self { title: title.to_owned(), x, y, curves, limit }
    }
}

/// Returns the range of positive values with a margin.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.filter(|v| *v > 0.0).fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    if high > 0.0 { low / 1.35..high * 1.35 } else { 0.1..10.0 }
}

/// Returns the ticks of a logarithmic axis: as many a decade as fit, else decades, else every second to fourth.
fn ticks(range: &std::ops::Range<f64>, most: usize) -> Vec<f64> {
    let decades = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let pick = |digits: &[f64], every: i32| -> Vec<f64> {
        let powers = decades.clone().filter(|k| k.rem_euclid(every) == 0);
        let all = powers.flat_map(|k| digits.iter().map(move |d| d * 10_f64.powi(k)));
        all.filter(|v| range.contains(v)).collect()
    };
    let fine = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];
    let one = &[1.0][..];
    let choices = [(&fine[..], 1), (&[1.0, 2.0, 5.0], 1), (one, 1), (one, 2), (one, 3)];
    let mut picks = choices.iter().map(|(digits, every)| pick(digits, *every));
    let fits = picks.find(|ticks| ticks.len() <= most);
    fits.unwrap_or_else(|| pick(one, 4))
}

type Cell<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn write(path: &Path, size: (u32, u32), draw: impl FnOnce(&Cell) -> Result<(), Error>) {
    let make = || -> Result<(), Error> {
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&PAPER)?;
            draw(&root)?;
            root.present()?;
        }
        let head = text.find("<rect").ok_or("no picture")?;
        text.insert_str(head, STYLE);
        std::fs::write(path, text)?;
        Ok(())
    };
    make().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

fn ink(size: u32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}

/// Draws one panel over logarithmic axes.
fn draw_panel(area: &Cell, panel: &Panel) -> Result<(), Error> {
    let all = || panel.curves.iter().flat_map(|curve| curve.points.iter().copied());
    let (xs, ys) = (range(all().map(|p| p.0)), range(all().map(|p| p.1)));
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ink(16))
        .margin(6)
        // Half of the longest label of the last tick.
        .margin_right(26)
        .x_label_area_size(38)
        .y_label_area_size(60)
        .build_cartesian_2d(
            LogCoord::from(xs.clone().log_scale()).with_key_points(ticks(&xs, 6)),
            LogCoord::from(ys.clone().log_scale()).with_key_points(ticks(&ys, 8)),
        )?;
    let (x, y) = (panel.x, panel.y);
    chart
        .configure_mesh()
        .axis_style(INK)
        .bold_line_style(FAINT)
        .light_line_style(TRANSPARENT)
        .label_style(ink(12))
        .axis_desc_style(ink(13))
        .x_desc(x.0)
        .y_desc(y.0)
        .x_label_formatter(&|v| x.label(*v))
        .y_label_formatter(&|v| y.label(*v))
        .draw()?;
    if let Some(limit) = panel.limit.filter(|l| xs.contains(l)) {
        let line = vec![(limit, ys.start), (limit, ys.end)];
        chart.draw_series(DashedLineSeries::new(line, 4, 4, INK.stroke_width(1)))?;
    }
    for Curve { look, points, .. } in &panel.curves {
        chart.draw_series(LineSeries::new(points.iter().copied(), look.line()))?;
        chart.draw_series(points.iter().map(|&point| EmptyElement::at(point) + look.mark()))?;
    }
    Ok(())
}

/// Height of a line of a legend or of the notes.
const LINE: u32 = 20;

fn text(area: &Cell, at: (i32, i32), what: &str, size: u32) -> Result<(), Error> {
    let style = ink(size).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(what.to_owned(), at, &style))?;
    Ok(())
}

/// Draws the labels of curves in columns.
fn legend(area: &Cell, entries: &[(&str, Look)], columns: usize) -> Result<(), Error> {
    let width = area.dim_in_pixel().0 as i32 / columns as i32;
    for (k, (label, look)) in entries.iter().enumerate() {
        let x = 16 + width * (k % columns) as i32;
        let y = (LINE / 2 + LINE * (k / columns) as u32) as i32;
        area.draw(&PathElement::new([(x, y), (x + 28, y)], look.line()))?;
        area.draw(&(EmptyElement::at((x + 14, y)) + look.mark()))?;
        text(area, (x + 36, y), label, 14)?;
    }
    Ok(())
}

/// Draws the lines below a picture.
fn notes_below(area: &Cell, notes: &[String]) -> Result<(), Error> {
    let mut lines = notes.iter().zip((LINE as i32 / 2..).step_by(LINE as usize));
    lines.try_for_each(|(note, y)| text(area, (16, y), note, 12))
}

/// Draws panels in rows of `columns`, the legend in the cell after the last or, if there is none, below; then the notes.
pub fn grid(path: &Path, title: &str, columns: usize, panels: &[Panel], notes: &[String]) {
    let panels: Vec<&Panel> = panels.iter().filter(|p| !p.curves.is_empty()).collect();
    let mut entries: Vec<(&str, Look)> = Vec::new();
    for Curve { label, look, .. } in panels.iter().flat_map(|p| &p.curves) {
        if !entries.iter().any(|(other, _)| other == label) {
            entries.push((label, *look));
        }
    }
    let rows = panels.len().div_ceil(columns);
    let top = rows as u32 * if columns == 2 { 320 } else { 270 };
    let has_free_cell = !panels.len().is_multiple_of(columns);
    let strip = if has_free_cell { 0 } else { LINE * entries.len().div_ceil(2) as u32 };
    write(path, (900, 40 + top + strip + LINE * notes.len() as u32), |root| {
        let (head, foot) = root.titled(title, ink(20))?.split_vertically(top);
        let cells = head.split_evenly((rows, columns));
        for (cell, panel) in cells.iter().zip(&panels) {
            draw_panel(cell, panel)?;
        }
        let (below, foot) = foot.split_vertically(strip + 4);
        match cells.get(panels.len()) {
            Some(cell) => legend(cell, &entries, 1)?,
            None => legend(&below, &entries, 2)?,
        }
        notes_below(&foot, notes)
    });
}

/// Draws a bar of instructions for each row, those in the support functions pale, with its sum and its wrong answers; then
/// the notes.
pub fn bars(path: &Path, title: &str, rows: &[Row], notes: &[String]) {
    const HEIGHT: i32 = 26;
    const LEFT: i32 = 300;
    const WIDTH: f64 = 430.0;
    let top = HEIGHT as u32 * rows.len() as u32 + 8;
    let most = rows.iter().map(Row::instructions).fold(1.0, f64::max);
    write(path, (900, 40 + top + LINE * notes.len() as u32), |root| {
        let (area, foot) = root.titled(title, ink(20))?.split_vertically(top);
        for (row, y) in rows.iter().zip((4..).step_by(HEIGHT as usize)) {
            let colour = if row.ours { RGBColor(37, 99, 235) } else { RGBColor(107, 114, 128) };
            let x = |instructions: f64| LEFT + (WIDTH * instructions / most) as i32;
            let [start, pale, end] = [0.0, row.callbacks.unwrap_or_default(), row.instructions()].map(x);
            let rectangle = |from, to, style| Rectangle::new([(from, y), (to, y + HEIGHT - 8)], style);
            area.draw(&rectangle(start, pale, colour.mix(0.45).filled()))?;
            area.draw(&rectangle(pale, end, colour.filled()))?;
            let middle = y + (HEIGHT - 8) / 2;
            text(&area, (16, middle), &row.method, 14)?;
            text(&area, (end + 8, middle), &format!("{:.0}, {:.1} % wrong", row.instructions(), row.wrong), 14)?;
        }
        notes_below(&foot, notes)
    });
}
