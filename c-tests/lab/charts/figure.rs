// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Pictures of the charts as SVG: panels of at most eight lines over logarithmic axes. A name stands at the end of its line.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::measuring::measure::Row;
use crate::measuring::methods::Start;

/// How the numbers of an axis are written.
#[derive(Clone, Copy, PartialEq)]
pub enum Unit {
    /// As they are.
    Plain,
    /// With a prefix: 1 mm, 10 µrad.
    Prefixed(&'static str),
    /// Percent; at the left end stands what is 0.
    Share,
}

/// The place of 0 on an axis of shares, percent.
pub const NONE: f64 = 0.003;

/// An axis, and the value of a row; none where it was not measured. Smaller values than `least` stand there.
#[derive(Clone, Copy)]
pub struct Axis {
    pub title: &'static str,
    pub unit: Unit,
    pub value: fn(&Row) -> Option<f64>,
    pub least: f64,
}

impl Axis {
    fn of(&self, row: &Row) -> Option<f64> {
        (self.value)(row).map(|value| value.max(self.least))
    }
}

pub const SUPPORTS: Axis =
    Axis { title: "support points per query", unit: Unit::Plain, value: |row| Some(row.supports), least: 0.0 };
pub const TIME: Axis =
    Axis { title: "time per query, µs", unit: Unit::Plain, value: |row| row.ns.map(|ns| 1e-3 * ns), least: 0.0 };

/// A line for each method and start of the rows, through its rows as they come.
pub struct Panel<'a> {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub rows: Vec<&'a Row>,
}

type Drawn = Result<(), Box<dyn std::error::Error>>;
type Root<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Pixel = (i32, i32);

const MOST_LINES: usize = 8;

/// Returns the name of a method in pictures, with its start.
fn name(row: &Row) -> String {
    let method = match &*row.method {
        "ccdMPRPenetration, pos" => "warmccd ccdMPRPenetration, pos",
        "ccdPenetration" => "warmccd ccdPenetration",
        "libccd ccdMPRPenetration" => "libccd MPR",
        "libccd ccdGJKPenetration" => "libccd EPA",
        method => method,
    };
    let start = match row.start {
        Start::None => "",
        Start::Guess5 => " 5°",
        Start::Guess25 => " 25°",
        Start::Guess45 => " 45°",
        Start::Cold => " cold",
        Start::Warm if method.ends_with("Warm") => "",
        Start::Warm => " warm",
    };
    format!("{method}{start}")
}

/// Length of dashes and of gaps in pixels; none: a whole line.
type Dashes = Option<(i32, i32)>;

#[derive(Clone, Copy)]
enum Mark {
    Circle,
    Square,
    Triangle,
    Cross,
}

struct Style {
    color: RGBColor,
    width: u32,
    dashes: Dashes,
    mark: Mark,
}

/// Returns the style of a method's line: this library's are thick and blue, the others' have other colours of Okabe and Ito;
/// lightness, dashes, marks and width differ too, so that lines differ without colour.
fn style(row: &Row) -> Style {
    const NAVY: RGBColor = RGBColor(0, 52, 94);
    const BLUE: RGBColor = RGBColor(0, 114, 178);
    const SKY: RGBColor = RGBColor(86, 180, 233);
    const GREEN: RGBColor = RGBColor(0, 158, 115);
    const PURPLE: RGBColor = RGBColor(204, 121, 167);
    const ORANGE: RGBColor = RGBColor(230, 159, 0);
    const GREY: RGBColor = RGBColor(110, 110, 110);
    let (color, dashes, mark) = match &*row.method {
        "ccdMPRPenetration" | "ccdMPRPenetration, pos" => (BLUE, None, Mark::Circle),
        "ccdMPRPenetrationWarm" => (BLUE, Some((9, 4)), Mark::Square),
        "ccdPenetrationProven" | "ccdPenetration" | "ccdGJKPenetration" => (NAVY, None, Mark::Triangle),
        method if method.starts_with("ccdPenetrationLocal") => (SKY, None, Mark::Square),
        "libccd ccdMPRPenetration" => (ORANGE, Some((9, 4)), Mark::Triangle),
        "libccd ccdGJKPenetration" => (PURPLE, Some((4, 3)), Mark::Square),
        "Algorithm 3" => (GREEN, Some((9, 4)), Mark::Triangle),
        "ccdPenetrationIncremental" => (NAVY, Some((9, 4)), Mark::Circle),
        "Algorithm 4/5" => (GREEN, None, Mark::Circle),
        "DEEP" => (PURPLE, Some((4, 3)), Mark::Triangle),
        _ => (GREY, None, Mark::Cross),
    };
    let dashes = if row.start == Start::Guess45 && dashes.is_none() { Some((2, 3)) } else { dashes };
    Style { color, width: if row.ours { 3 } else { 1 }, dashes, mark }
}

/// Returns the numbers to be written along an axis: at least three where it spans a factor of ten.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let (low, high) = (range.start.log10().floor() as i32, range.end.log10().ceil() as i32);
    let spans = (range.end / range.start).log10();
    let factors = if spans < 2.1 { &[1.0, 2.0, 5.0][..] } else { &[1.0] };
    let of = |every: i32| -> Vec<f64> {
        let powers = (low..=high).filter(|k| k % every == 0);
        let values = powers.flat_map(|k| factors.iter().map(move |f| f * 10_f64.powi(k)));
        values.filter(|v| (0.999 * range.start..1.001 * range.end).contains(v)).collect()
    };
    // Of every fourth power of ten, or closer, where that is at least three numbers.
    let steps: &[i32] = if spans < 7.5 { &[1] } else { &[4, 3, 2] };
    steps.iter().map(|&every| of(every)).find(|values| values.len() > 2).unwrap_or_else(|| of(1))
}

/// Returns a number of an axis as text.
fn text(value: f64, unit: Unit) -> String {
    let plain = |v: f64| {
        let text = format!("{v:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let name = match unit {
        Unit::Plain => return plain(value),
        Unit::Share if value <= NONE => return "0".to_owned(),
        Unit::Share => return format!("{} %", plain(value)),
        Unit::Prefixed(name) => name,
    };
    const PREFIXES: [&str; 7] = ["", "m", "µ", "n", "p", "f", "a"];
    let k = (-(value.log10() + 1e-9).floor() / 3.0).ceil().clamp(0.0, 6.0);
    format!("{} {}{name}", plain(value * 1e3_f64.powf(k)), PREFIXES[k as usize])
}

/// Returns the range of numbers with room beside them, at least a factor of ten.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let values = values.filter(|v| *v > 0.0);
    let (low, high) = values.fold((f64::MAX, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = (low / 1.3, high * 1.3);
    let more = (10.0 / (high / low)).max(1.0).sqrt();
    low / more..high * more
}

const SMALL: i32 = 12;

/// Room for names on the right of a panel: of lines that end there, and of others.
const GUTTER: i32 = 176;
const NARROW: i32 = 84;

fn font<'a>(size: i32) -> TextStyle<'a> {
    ("sans-serif", size).into_font().into()
}

/// A rectangle: left, top, right, bottom.
type Box4 = [i32; 4];

/// What a panel has already: names, and lines as pixels.
struct Taken {
    names: Vec<Box4>,
    pixels: Vec<Pixel>,
    /// Where names may stand.
    within: Box4,
}

impl Taken {
    /// Returns the place of a name of this width that is free and closest to an end of its line, and that end.
    fn place(&self, width: i32, ends: &[Pixel]) -> (Pixel, Box4) {
        let height = SMALL + 1;
        let mut best = (f64::MAX, ends[0], [0; 4]);
        for (number, &(x, y)) in ends.iter().enumerate() {
            for dy in (-10..=10).map(|k| 7 * k) {
                for left in [x + 8, x - 8 - width, x - width / 2, x + 20, x - 20 - width] {
                    let at = [left, y + dy - height / 2, left + width, y + dy + height / 2];
                    let is_inside = at[0] >= self.within[0]
                        && at[1] >= self.within[1]
                        && at[2] <= self.within[2]
                        && at[3] <= self.within[3];
                    if !is_inside {
                        continue;
                    }
                    let overlaps = |b: &&Box4| at[0] < b[2] && b[0] < at[2] && at[1] < b[3] && b[1] < at[3];
                    let names = self.names.iter().filter(overlaps).count();
                    let covers =
                        |p: &&Pixel| (at[0] - 2..=at[2] + 2).contains(&p.0) && (at[1] - 1..=at[3] + 1).contains(&p.1);
                    let pixels = self.pixels.iter().filter(covers).count();
                    let middle = ((left - x).abs().min((left + width - x).abs()), dy.abs());
                    let far = f64::from(middle.1) + 0.5 * f64::from(middle.0) + 60.0 * number as f64;
                    let cost = far + 6.0 * pixels as f64 + 1e4 * names as f64;
                    if cost < best.0 {
                        best = (cost, (x, y), at);
                    }
                }
            }
        }
        (best.1, best.2)
    }
}

/// Draws a mark at a pixel.
fn draw_mark(root: &Root, at: Pixel, style: &Style) -> Drawn {
    let size = if style.width > 1 { 4 } else { 3 };
    let fill = style.color.filled();
    let (x, y) = at;
    match style.mark {
        Mark::Circle => root.draw(&Circle::new(at, size, fill))?,
        Mark::Square => root.draw(&Rectangle::new([(x - size, y - size), (x + size, y + size)], fill))?,
        Mark::Triangle => root.draw(&TriangleMarker::new(at, size + 1, fill))?,
        Mark::Cross => root.draw(&Cross::new(at, size + 1, style.color.stroke_width(2)))?,
    }
    Ok(())
}

/// Draws the lines of a panel, and their names.
fn draw(panel: &Panel, root: &Root, area: &Root) -> Drawn {
    let point = |row: &&Row| panel.x.of(row).zip(panel.y.of(row)).filter(|p| p.0 > 0.0 && p.1 > 0.0);
    let points = || panel.rows.iter().filter_map(point);
    let (xs, ys) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)));
    let gutter = if panel.x.unit == Unit::Plain { GUTTER } else { NARROW };
    let mut builder = ChartBuilder::on(area);
    builder.caption(&panel.title, font(15)).margin(8).margin_right(gutter).x_label_area_size(38).y_label_area_size(58);
    let (mut x_ticks, y_ticks) = (ticks(&xs), ticks(&ys));
    if panel.x.unit == Unit::Share {
        x_ticks.push(NONE);
    }
    let mut chart = builder.build_cartesian_2d(
        xs.clone().log_scale().with_key_points(x_ticks),
        ys.clone().log_scale().with_key_points(y_ticks),
    )?;
    let mut mesh = chart.configure_mesh();
    let (x_text, y_text) = (|v: &f64| text(*v, panel.x.unit), |v: &f64| text(*v, panel.y.unit));
    mesh.light_line_style(TRANSPARENT).bold_line_style(BLACK.mix(0.12)).label_style(font(SMALL));
    mesh.axis_desc_style(font(SMALL + 1)).x_label_formatter(&x_text).y_label_formatter(&y_text);
    mesh.x_desc(panel.x.title).y_desc(panel.y.title).draw()?;
    // From here on in pixels of the picture.
    let pixel = |p: (f64, f64)| chart.backend_coord(&p);
    let mut lines: Vec<(&Row, Vec<Pixel>)> = Vec::new();
    for row in &panel.rows {
        let Some(at) = point(row) else { continue };
        let p = pixel(at);
        match lines.iter_mut().find(|(first, _)| (&first.method, first.start) == (&row.method, row.start)) {
            // A line ends at its first point at the end of the axis.
            Some((_, line)) if at.0 <= panel.x.least && line.last().is_some_and(|last| last.0 == p.0) => {}
            Some((_, line)) => line.push(p),
            None => lines.push((row, vec![p])),
        }
    }
    let num_lines = lines.iter().filter(|(_, line)| line.len() > 1).count();
    assert!(num_lines <= MOST_LINES, "{}: {num_lines} lines", panel.title);
    let (left, top) = pixel((xs.start, ys.end));
    let (right, bottom) = pixel((xs.end, ys.start));
    let mut taken =
        Taken { names: Vec::new(), pixels: Vec::new(), within: [left + 2, top - 8, right + gutter - 6, bottom + 8] };
    // Thin lines first: thick ones are above them.
    lines.sort_by_key(|(row, _)| row.ours);
    for (row, line) in &lines {
        let style = style(row);
        let stroke = style.color.stroke_width(style.width);
        match style.dashes {
            None => root.draw(&PathElement::new(line.clone(), stroke))?,
            Some((dash, gap)) => root.draw(&DashedPathElement::new(line.clone(), dash, gap, stroke))?,
        }
        for &p in line {
            draw_mark(root, p, &style)?;
        }
        for ends in line.windows(2) {
            let steps = (ends[1].0 - ends[0].0).abs().max((ends[1].1 - ends[0].1).abs()) / 4 + 1;
            let along =
                |k| (ends[0].0 + (ends[1].0 - ends[0].0) * k / steps, ends[0].1 + (ends[1].1 - ends[0].1) * k / steps);
            taken.pixels.extend((0..steps).map(along));
        }
        taken.pixels.extend(line.last());
    }
    for (row, line) in &lines {
        let style = style(row);
        let name = name(row);
        let width = (5.6 * name.chars().count() as f64) as i32 + 4;
        let mut ends = vec![line[line.len() - 1], line[0]];
        ends.dedup();
        let ((x, y), at) = taken.place(width, &ends);
        let (middle_x, middle_y) = (x.clamp(at[0], at[2]), (at[1] + at[3]) / 2);
        if (y - middle_y).abs() > SMALL || (x - middle_x).abs() > SMALL {
            root.draw(&PathElement::new(
                [(x, y), (middle_x, middle_y.clamp(y.min(at[3]), y.max(at[1])))],
                style.color,
            ))?;
        }
        let text_style = font(SMALL).color(&style.color).pos(Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new(name, (at[0] + 2, middle_y), text_style))?;
        taken.names.push(at);
    }
    Ok(())
}

/// Draws panels side by side, so many in a row, and the notes below.
pub fn grid(path: &Path, title: &str, columns: usize, mut panels: Vec<Panel>, notes: &[String]) -> Drawn {
    panels.retain(|panel| panel.rows.iter().any(|row| panel.x.of(row).and(panel.y.of(row)).is_some()));
    let rows = panels.len().div_ceil(columns);
    let size = if columns == 1 { (900, 520) } else { (570, 320) };
    let (top, below) = (size.1 * rows as u32, 12 + 18 * notes.len() as u32);
    let root = SVGBackend::new(path, (size.0 * columns as u32, 34 + top + below)).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, foot) = root.titled(title, font(19))?.split_vertically(top);
    head.split_evenly((rows, columns)).iter().zip(&panels).try_for_each(|(cell, panel)| draw(panel, &root, cell))?;
    for (note, y) in notes.iter().zip((4..).step_by(18)) {
        foot.draw(&Text::new(note.clone(), (16, y), font(SMALL)))?;
    }
    Ok(root.present()?)
}
