// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts: panels of curves over logarithmic axes, a legend in a
//! panel of its own, and stacked bars, drawn by plotters as SVG.
//!
//! Ink and paper are two colours that nothing else uses; a style sheet in the file
//! turns them round where the reader's system is dark.

use std::path::Path;

use plotters::coord::combinators::LogCoord;
use plotters::coord::ranged1d::{IntoSegmentedCoord, SegmentValue};
use plotters::prelude::*;

type Error = Box<dyn std::error::Error>;

const INK: RGBColor = RGBColor(31, 35, 41);
const FAINT: RGBColor = RGBColor(209, 213, 219);
const PAPER: RGBColor = RGBColor(254, 254, 253);
const STYLE: &str = "<style>@media (prefers-color-scheme: dark){\
    [fill=\"#1F2329\"]{fill:#E6EDF3}[stroke=\"#1F2329\"]{stroke:#E6EDF3}\
    [fill=\"#D1D5DB\"]{fill:#3A424D}[stroke=\"#D1D5DB\"]{stroke:#3A424D}\
    [fill=\"#FEFEFD\"]{fill:#0D1117}[stroke=\"#FEFEFD\"]{stroke:#0D1117}}</style>";

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
    pub colour: RGBColor,
    pub mark: Mark,
    /// Ours are drawn bolder.
    pub bold: bool,
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
    Degrees,
}

impl Unit {
    fn show(self, v: f64) -> String {
        // Ticks are powers of ten; this rounds what their logarithms lost.
        let with = |scales: &[(f64, &str)]| {
            let (scale, name) = scales
                .iter()
                .find(|(s, _)| v >= s * 0.999)
                .or(scales.last())
                .copied()
                .unwrap_or((1.0, ""));
            format!("{} {name}", short(v / scale))
        };
        match self {
            Unit::Metres => with(&[
                (1.0, "m"),
                (1e-3, "mm"),
                (1e-6, "µm"),
                (1e-9, "nm"),
                (1e-12, "pm"),
                (1e-15, "fm"),
            ]),
            Unit::Seconds => with(&[(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")]),
            Unit::Count => short(v),
            Unit::Degrees => format!("{}°", short(v)),
        }
    }
}

/// Three digits at most, no trailing zeros.
fn short(v: f64) -> String {
    let digits = if v >= 99.5 {
        0
    } else if v >= 9.95 {
        1
    } else {
        2
    };
    let text = format!("{v:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    pub x: (&'static str, Unit),
    pub y: (&'static str, Unit),
    pub curves: Vec<Curve>,
    /// A line across at this x, where a value loses its meaning.
    pub limit: Option<f64>,
}

/// Smallest and largest, opened by a margin; none without points.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values
        .filter(|v| *v > 0.0)
        .fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    if high > 0.0 {
        low / 1.35..high * 1.35
    } else {
        0.1..10.0
    }
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
    let choices = [
        (&fine[..], 1),
        (&[1.0, 2.0, 5.0], 1),
        (&[1.0], 1),
        (&[1.0], 2),
        (&[1.0], 3),
    ];
    let fits = choices
        .iter()
        .map(|(d, e)| pick(d, *e))
        .find(|t| t.len() <= most);
    fits.unwrap_or_else(|| pick(&[1.0], 4))
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
        .caption(&panel.title, ink(17))
        .margin(8)
        .x_label_area_size(40)
        .y_label_area_size(62)
        .build_cartesian_2d(
            LogCoord::from(xs.clone().log_scale()).with_key_points(ticks(&xs, 7)),
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
        let Look { colour, bold, .. } = curve.look;
        let line = colour.stroke_width(if bold { 3 } else { 1 });
        chart.draw_series(LineSeries::new(curve.points.iter().copied(), line))?;
        chart.draw_series(curve.points.iter().map(|&p| mark(curve.look, p)))?;
    }
    Ok(())
}

/// A cell with the names of the curves, each once.
fn legend(area: &Cell, panels: &[Panel], notes: &[String]) -> Result<(), Error> {
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
    let mut seen: Vec<&str> = Vec::new();
    for curve in panels.iter().flat_map(|p| &p.curves) {
        if seen.contains(&curve.label.as_str()) {
            continue;
        }
        seen.push(&curve.label);
        let look = curve.look;
        chart
            .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
            .label(curve.label.clone())
            .legend(move |(x, y)| mark(look, (x + 8, y)));
    }
    for note in notes {
        chart
            .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
            .label(note.clone())
            .legend(|at| PathElement::new(vec![at], PAPER));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .label_font(ink(14))
        .legend_area_size(22)
        .draw()?;
    Ok(())
}

/// Panels in rows of `columns`, the legend in the cell after the last.
pub fn grid(path: &Path, title: &str, columns: usize, panels: &[Panel], notes: &[String]) {
    let panels: Vec<Panel> = panels
        .iter()
        .filter(|p| p.curves.iter().any(|c| !c.points.is_empty()))
        .cloned()
        .collect();
    let rows = (panels.len() + 1).div_ceil(columns);
    let size = (360 * columns as u32, 300 * rows as u32 + 40);
    write(path, size, |root| {
        let root = root.titled(title, ink(21))?;
        let cells = root.split_evenly((rows, columns));
        for (cell, p) in cells.iter().zip(&panels) {
            panel(cell, p)?;
        }
        cells
            .get(panels.len())
            .map_or(Ok(()), |cell| legend(cell, &panels, notes))
    });
}

/// Parts of a bar: how much, and of what.
#[derive(Clone, Debug)]
pub struct Bar {
    pub label: String,
    pub parts: Vec<f64>,
}

/// Bars side by side, their parts end to end, all to one scale.
pub fn bars(
    path: &Path,
    title: &str,
    x: &str,
    parts: &[(&str, RGBColor)],
    bars: &[Bar],
    notes: &[String],
) {
    if bars.is_empty() {
        return;
    }
    let longest = bars
        .iter()
        .map(|b| b.parts.iter().sum())
        .fold(0.0, f64::max);
    let head = 20 * (parts.len() + notes.len()) as u32 + 10;
    write(path, (1080, 100 + head + 28 * bars.len() as u32), |root| {
        let (top, below) = root.titled(title, ink(21))?.split_vertically(head);
        let mut chart = ChartBuilder::on(&below)
            .margin(10)
            .x_label_area_size(44)
            .y_label_area_size(390)
            .build_cartesian_2d(0.0..longest * 1.02, (0..bars.len() - 1).into_segmented())?;
        // The first bar on top.
        let name = |k: usize| bars[bars.len() - 1 - k].label.clone();
        chart
            .configure_mesh()
            .axis_style(INK)
            .bold_line_style(FAINT)
            .light_line_style(TRANSPARENT)
            .disable_y_mesh()
            .label_style(ink(13))
            .axis_desc_style(ink(14))
            .x_desc(x)
            .y_labels(bars.len())
            .x_label_formatter(&|v| short(*v))
            .y_label_formatter(&|v| match v {
                SegmentValue::CenterOf(k) if *k < bars.len() => name(*k),
                _ => String::new(),
            })
            .draw()?;
        for (part, (_, colour)) in parts.iter().enumerate() {
            let blocks = bars.iter().rev().enumerate().map(|(k, bar)| {
                let from: f64 = bar.parts[..part].iter().sum();
                let ends = [
                    (from, SegmentValue::Exact(k)),
                    (from + bar.parts[part], SegmentValue::Exact(k + 1)),
                ];
                let mut block = Rectangle::new(ends, colour.filled());
                block.set_margin(5, 5, 0, 0);
                block
            });
            chart.draw_series(blocks)?;
        }
        let mut names = ChartBuilder::on(&top).build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
        let nothing = std::iter::empty::<Circle<(f64, f64), i32>>;
        for (label, colour) in parts {
            let fill = colour.filled();
            let block = move |(x, y)| Rectangle::new([(x + 4, y - 6), (x + 16, y + 6)], fill);
            names.draw_series(nothing())?.label(*label).legend(block);
        }
        for note in notes {
            let blank = |at| PathElement::new(vec![at], PAPER);
            names
                .draw_series(nothing())?
                .label(note.clone())
                .legend(blank);
        }
        names
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .label_font(ink(14))
            .legend_area_size(22)
            .draw()?;
        Ok(())
    });
}
