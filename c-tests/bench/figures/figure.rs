// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts: panels of curves over logarithmic axes, with a legend in the
//! free cell or below, drawn by plotters as SVG; 900 units wide, as wide as a page shows
//! them.
//!
//! Ink and paper are two colours that nothing else uses; a style sheet in the file
//! turns them round where the reader's system is dark, and lightens two colours that are
//! hard to see there: the red of libccd's EPA, and the grey of other libraries.

use std::path::Path;

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Mark {
    Dot,
    Ring,
    Triangle,
    Cross,
}

/// How a method looks in every picture.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    colour: RGBColor,
    mark: Mark,
    /// Ours are drawn bolder.
    bold: bool,
}

impl Look {
    pub fn new((r, g, b): (u8, u8, u8), mark: Mark, bold: bool) -> Self {
        let colour = RGBColor(r, g, b);
        Self { colour, mark, bold }
    }

    fn line(&self) -> ShapeStyle {
        self.colour.stroke_width(if self.bold { 3 } else { 1 })
    }
}

#[derive(Clone, Debug)]
pub struct Curve {
    pub label: String,
    pub look: Look,
    pub points: Vec<(f64, f64)>,
}

/// The unit of an axis' labels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Unit {
    Metres,
    Seconds,
    Count,
}

impl Unit {
    fn show(self, v: f64) -> String {
        let scales: &[(f64, &str)] = match self {
            Unit::Metres => &METRES,
            Unit::Seconds => &[(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")],
            Unit::Count => return short(v),
        };
        // Ticks are powers of ten; this rounds what their logarithms lost.
        let fits = scales.iter().find(|(scale, _)| v >= scale * 0.999);
        let (scale, name) = fits.unwrap_or(&scales[scales.len() - 1]);
        format!("{} {name}", short(v / scale))
    }
}

const METRES: [(f64, &str); 6] = [(1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"), (1e-12, "pm"), (1e-15, "fm")];

/// Three digits at most, no trailing zeros.
fn short(v: f64) -> String {
    let digits = usize::from(v < 99.5) + usize::from(v < 9.95);
    let text = format!("{v:.digits$}");
    match digits {
        0 => text,
        _ => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
    }
}

/// Title of an axis and the unit of its labels.
pub type Axis = (&'static str, Unit);

#[derive(Clone, Debug)]
pub struct Panel {
    title: String,
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
    /// A line across at this x, where a value loses its meaning.
    pub limit: Option<f64>,
}

impl Panel {
    pub fn new(title: &str, x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        let title = title.to_owned();
        let limit = None;
        Self { title, x, y, curves, limit }
    }
}

/// A curve a label, each through its points as they come.
pub fn curves(points: impl IntoIterator<Item = (String, Look, (f64, f64))>) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for (label, look, point) in points {
        match curves.iter_mut().find(|c| c.label == label) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { label, look, points: vec![point] }),
        }
    }
    curves
}

/// Smallest and largest, opened by a margin; none without points.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.filter(|v| *v > 0.0).fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    if high > 0.0 { low / 1.35..high * 1.35 } else { 0.1..10.0 }
}

/// Ticks of a logarithmic axis: 1, 2, 5 a decade where they are few, else decades,
/// else every second or third.
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

/// A mark, in a chart's or the page's coordinates.
fn mark<'b, C: Clone + 'static>(look: Look, at: C) -> DynElement<'static, SVGBackend<'b>, C>
where
    Circle<C, i32>: IntoDynElement<'static, SVGBackend<'b>, C>,
    TriangleMarker<C, i32>: IntoDynElement<'static, SVGBackend<'b>, C>,
    Cross<C, i32>: IntoDynElement<'static, SVGBackend<'b>, C>,
{
    let Look { colour, mark, bold } = look;
    let size = if bold { 4 } else { 3 };
    match mark {
        Mark::Dot => Circle::new(at, size, colour.filled()).into_dyn(),
        Mark::Ring => Circle::new(at, size, colour.stroke_width(2)).into_dyn(),
        Mark::Triangle => TriangleMarker::new(at, size + 1, colour.filled()).into_dyn(),
        Mark::Cross => Cross::new(at, size, colour.stroke_width(2)).into_dyn(),
    }
}

/// One panel over logarithmic axes.
fn panel(area: &Cell, panel: &Panel) -> Result<(), Error> {
    let all = || panel.curves.iter().flat_map(|c| c.points.iter().copied());
    let (xs, ys) = (range(all().map(|p| p.0)), range(all().map(|p| p.1)));
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ink(16))
        .margin(6)
        // Half of the longest label that can stand under the last tick.
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
        .x_label_formatter(&|v| x.1.show(*v))
        .y_label_formatter(&|v| y.1.show(*v))
        .draw()?;
    if let Some(limit) = panel.limit.filter(|l| xs.contains(l)) {
        let line = vec![(limit, ys.start), (limit, ys.end)];
        chart.draw_series(DashedLineSeries::new(line, 4, 4, INK.stroke_width(1)))?;
    }
    for curve in &panel.curves {
        let points = curve.points.iter().copied();
        chart.draw_series(LineSeries::new(points, curve.look.line()))?;
        chart.draw_series(curve.points.iter().map(|&p| mark(curve.look, p)))?;
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

/// The names of the curves, in columns as wide as an area holds.
fn legend(area: &Cell, entries: &[(&str, Look)], columns: usize) -> Result<(), Error> {
    let width = area.dim_in_pixel().0 as i32 / columns as i32;
    for (k, (label, look)) in entries.iter().enumerate() {
        let x = 16 + width * (k % columns) as i32;
        let y = (LINE / 2 + LINE * (k / columns) as u32) as i32;
        let line = vec![(x, y), (x + 28, y)];
        area.draw(&PathElement::new(line, look.line()))?;
        area.draw(&mark(*look, (x + 14, y)))?;
        text(area, (x + 36, y), label, 14)?;
    }
    Ok(())
}

/// The lines under a picture.
fn notes_below(area: &Cell, notes: &[String]) -> Result<(), Error> {
    for (k, note) in notes.iter().enumerate() {
        let y = (LINE / 2 + LINE * k as u32) as i32;
        text(area, (16, y), note, 12)?;
    }
    Ok(())
}

/// Panels in rows of `columns`, the legend in the cell after the last or, where there is
/// none, below; then the notes.
pub fn grid(path: &Path, title: &str, columns: usize, panels: &[Panel], notes: &[String]) {
    let drawn = panels.iter().filter(|p| !p.curves.is_empty());
    let panels: Vec<&Panel> = drawn.collect();
    let mut entries: Vec<(&str, Look)> = Vec::new();
    for curve in panels.iter().flat_map(|p| &p.curves) {
        if !entries.iter().any(|(label, _)| *label == curve.label) {
            entries.push((&curve.label, curve.look));
        }
    }
    let rows = panels.len().div_ceil(columns) as u32;
    let cell = if columns == 2 { 320 } else { 270 };
    let longest = entries.iter().map(|(label, _)| label.chars().count()).max();
    let across = if longest > Some(34) { 2 } else { 3 };
    let strip = match panels.len().is_multiple_of(columns) {
        true => LINE * entries.len().div_ceil(across) as u32,
        false => 0,
    };
    let below = strip + LINE * notes.len() as u32;
    let top = cell * rows;
    write(path, (900, 40 + top + below), |root| {
        let (head, foot) = root.titled(title, ink(20))?.split_vertically(top);
        let cells = head.split_evenly((rows as usize, columns));
        for (cell, p) in cells.iter().zip(&panels) {
            panel(cell, p)?;
        }
        let (names, foot) = foot.split_vertically(strip + 4);
        match cells.get(panels.len()) {
            Some(cell) => legend(cell, &entries, 1)?,
            None => legend(&names, &entries, across)?,
        }
        notes_below(&foot, notes)
    });
}

/// A bar of a bar chart: its two parts, the first drawn pale, and what is written behind it.
pub struct Bar {
    pub label: String,
    pub parts: [f64; 2],
    pub note: String,
    /// Ours.
    pub bold: bool,
}

/// Draws bars from the left over a common scale, with their sums and notes; then the notes below.
pub fn bars(path: &Path, title: &str, bars: &[Bar], notes: &[String]) {
    const ROW: i32 = 26;
    const LEFT: i32 = 300;
    const ROOM: f64 = 430.0;
    let top = ROW as u32 * bars.len() as u32 + 8;
    let sum = |bar: &Bar| bar.parts.iter().sum::<f64>();
    let most = bars.iter().map(sum).fold(1.0, f64::max);
    write(path, (900, 40 + top + LINE * notes.len() as u32), |root| {
        let (area, foot) = root.titled(title, ink(20))?.split_vertically(top);
        for (k, bar) in bars.iter().enumerate() {
            let y = ROW * k as i32 + 4;
            let colour = if bar.bold { RGBColor(37, 99, 235) } else { RGBColor(107, 114, 128) };
            let at = |x: f64| LEFT + (ROOM * x / most) as i32;
            let rectangle = |from, to, style| Rectangle::new([(at(from), y), (at(to), y + ROW - 8)], style);
            area.draw(&rectangle(0.0, bar.parts[0], colour.mix(0.45).filled()))?;
            area.draw(&rectangle(bar.parts[0], sum(bar), colour.filled()))?;
            let middle = y + (ROW - 8) / 2;
            text(&area, (16, middle), &bar.label, 14)?;
            let behind = format!("{:.0}, {}", sum(bar), bar.note);
            text(&area, (at(sum(bar)) + 8, middle), &behind, 14)?;
        }
        notes_below(&foot, notes)
    });
}
