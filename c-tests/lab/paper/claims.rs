// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What the paper says of its tables and figures, what is measured here, and this library's own calls.

use super::primitives::{PAIRS, STARTS};
use super::{ALGORITHM_3, ALGORITHM_4_5, EPA, INCREMENTAL, NEW_PORTALS, Results, find, number, table1, table2, table3};
use crate::measuring::measure::Row;
use crate::measuring::methods::Start;
use crate::pages::markdown;

const LOCAL: &str = "ccdPenetrationLocal";
const PROVEN: &str = "ccdPenetrationProven";

/// Numbers of several sets, as the range that they span.
#[derive(Clone)]
struct Range(Vec<f64>);

impl Range {
    fn low(&self) -> f64 {
        self.0.iter().copied().fold(f64::MAX, f64::min)
    }

    fn high(&self) -> f64 {
        self.0.iter().copied().fold(f64::MIN, f64::max)
    }

    fn text(&self, unit: &str) -> String {
        let [low, high] = [self.low(), self.high()].map(number);
        if low == high { format!("{low}{unit}") } else { format!("{low} to {high}{unit}") }
    }

    /// Whether the numbers are at least these, of all sets, of some or of none.
    fn reaches(&self, least: f64) -> &'static str {
        match least {
            l if self.low() >= l => "yes",
            l if self.high() >= l => "in part",
            _ => "no",
        }
    }
}

/// Returns a value of one method over that of another for every set of the rows.
fn ratios(rows: &[Row], of: (&str, Start), over: (&str, Start), value: fn(&Row) -> f64) -> Range {
    let mut sets: Vec<&str> = rows.iter().map(|row| &*row.set).collect();
    sets.dedup();
    let ratio = |set: &&str| value(find(rows, set, of.0, of.1)) / value(find(rows, set, over.0, over.1));
    Range(sets.iter().map(ratio).collect())
}

fn join(ranges: impl IntoIterator<Item = Range>) -> Range {
    Range(ranges.into_iter().flat_map(|range| range.0).collect())
}

fn ns(row: &Row) -> f64 {
    row.ns.unwrap_or(f64::NAN)
}

/// Returns how many times faster than EPA a method is from guesses.
fn faster(rows: &[Row], method: &str, starts: &[Start]) -> Range {
    join(starts.iter().map(|start| ratios(rows, (EPA, Start::None), (method, *start), ns)))
}

/// Returns ratios of two columns of a published table.
fn published(table: [[f64; 4]; 3], of: usize, over: usize) -> Range {
    Range(table.map(|row| row[of] / row[over]).into())
}

/// Returns the values of a method from starts, of all pairs of the tables.
fn values(rows: &[Row], method: &str, starts: &[Start], value: fn(&Row) -> f64) -> Range {
    let of = |start: &Start| Range(PAIRS.map(|(set, _)| value(find(rows, set, method, *start))).into());
    join(starts.iter().map(of))
}

/// Returns a value of EPA over that of Algorithm 4/5 from starts.
fn epa_over(rows: &[Row], starts: &[Start], value: fn(&Row) -> f64) -> Range {
    join(starts.iter().map(|start| ratios(rows, (EPA, Start::None), (ALGORITHM_4_5, *start), value)))
}

fn either(is_so: bool, yes: &str, no: &str) -> String {
    if is_so { yes } else { no }.to_owned()
}

/// The two means of an error: over the answers whose depth is within 1 mm of the truth, and over all runs.
struct Mean {
    name: &'static str,
    micrometres: fn(&Row) -> f64,
    milliradians: fn(&Row) -> f64,
}

const MEANS: [Mean; 2] = [
    Mean {
        name: "of those within 1 mm",
        micrometres: |row| 1e6 * row.mean_error_1mm,
        milliradians: |row| row.direction_mean_1mm.unwrap_or(f64::NAN),
    },
    Mean {
        name: "of all runs, as the paper averages",
        micrometres: |row| 1e6 * row.mean_error,
        milliradians: |row| row.direction_mean.unwrap_or(f64::NAN),
    },
];

/// Claim, what the paper has, what is measured, whether it holds, this library's calls.
type Line = [String; 5];

/// Of Tables I and II, each with both means.
fn accuracy(rows: &[Row]) -> Vec<Line> {
    let depths = join(table1::PUBLISHED.map(|row| Range(row[..3].to_vec())));
    let epa_depths = Range(table1::PUBLISHED.map(|row| row[3]).into());
    let directions = join([0, 1, 2].map(|k| published(table2::PUBLISHED, 3, k)));
    let ours = |value| format!("`…Local` {}", values(rows, LOCAL, &STARTS, value).text(" µm"));
    let depth = |mean: &Mean| {
        let measured = values(rows, ALGORITHM_4_5, &STARTS, mean.micrometres);
        let holds = either(measured.high() <= 2.0 * depths.high(), "yes", "no");
        let claim = format!(
            "Its depths are accurate to about 1 µm (Table I; the tolerance is chosen for it): mean {}",
            mean.name
        );
        [claim, depths.text(" µm"), measured.text(" µm"), holds, ours(mean.micrometres)]
    };
    let epa = |mean: &Mean| {
        let measured = values(rows, EPA, &[Start::None], mean.micrometres);
        let holds = either(measured.high() <= 2.0 * epa_depths.high(), "yes", "no");
        let proven = values(rows, PROVEN, &[Start::None], mean.micrometres).text(" µm");
        let claim = format!("EPA's are too (Table I): mean {}", mean.name);
        [claim, epa_depths.text(" µm"), measured.text(" µm"), holds, format!("`…Proven` {proven}")]
    };
    let direction = |mean: &Mean| {
        let measured = epa_over(rows, &STARTS, mean.milliradians);
        let claim = format!(
            "Its directions are more accurate than EPA's (Table II): EPA's error over its own, mean {}",
            mean.name
        );
        let local = values(rows, LOCAL, &STARTS, mean.milliradians).text(" mrad");
        let holds = measured.reaches(1.0).to_owned();
        [claim, directions.text("×"), measured.text("×"), holds, format!("`…Local` {local}")]
    };
    let mut lines: Vec<Line> = MEANS.iter().map(depth).collect();
    let (near, far) = ((ALGORITHM_4_5, Start::Guess5), (ALGORITHM_4_5, Start::Guess45));
    let far_off = ratios(rows, far, near, |row| row.mean_error);
    let off = |method| values(rows, method, &[Start::Guess45], |row| row.beyond_1mm).text(" %");
    lines.push([
        "… despite the large error of the guess: depth error of all runs at 45° over that at 5° (Table I)".to_owned(),
        published(table1::PUBLISHED, 2, 0).text("×"),
        far_off.text("×"),
        either(far_off.high() <= 1.2, "yes", "no"),
        format!("more than 1 mm off from 45°: Algorithm 4/5 {}, `…Local` {}", off(ALGORITHM_4_5), off(LOCAL)),
    ]);
    lines.extend(MEANS.iter().map(epa));
    lines.extend(MEANS.iter().map(direction));
    lines
}

/// Of Table III, the figure over numbers of vertices, and the abstract.
fn speed(primitives: &[Row], vertices: &[Row]) -> Vec<Line> {
    let (near, far) = (Start::Guess5, Start::Guess45);
    let ours = |rows: &[Row], starts: &[Start]| {
        let [local, proven] = [faster(rows, LOCAL, starts), faster(rows, PROVEN, &[Start::None])];
        format!("`…Local` {}, `…Proven` {}", local.text("×"), proven.text("×"))
    };
    let line = |claim: &str, paper: String, measured: &Range, holds: &str, ours: String| -> Line {
        [claim.to_owned(), paper, measured.text("×"), holds.to_owned(), ours]
    };
    let on_primitives = faster(primitives, ALGORITHM_4_5, &STARTS);
    let on_hulls = faster(vertices, ALGORITHM_4_5, &[near, far]);
    let slower = ratios(primitives, (ALGORITHM_4_5, far), (ALGORITHM_4_5, near), ns);
    let published_slower = published(table3::PUBLISHED, 2, 0);
    let mut lines = vec![
        line(
            "\"20x-30x speed up compared to EPA\" (Table III)",
            join([0, 1, 2].map(|k| published(table3::PUBLISHED, 3, k))).text("×"),
            &on_primitives,
            on_primitives.reaches(20.0),
            ours(primitives, &STARTS),
        ),
        line(
            "The speed hardly depends on the guess: time from 45° over that from 5° (Table III)",
            published_slower.text("×"),
            &slower,
            &either(slower.high() <= 1.1 * published_slower.high(), "yes", "no"),
            format!("`…Local` {}", ratios(primitives, (LOCAL, far), (LOCAL, near), ns).text("×")),
        ),
        line(
            "\"6-10x speedup\" over EPA on hulls of 12 to 2,562 vertices (figure over vertices)",
            "6 to 10×".to_owned(),
            &on_hulls,
            on_hulls.reaches(6.0),
            ours(vertices, &[near, far]),
        ),
    ];
    let all = join([on_primitives, on_hulls]);
    for mean in &MEANS {
        let [of_primitives, of_hulls] = [(primitives, &STARTS[..]), (vertices, &[near, far])]
            .map(|(rows, starts)| epa_over(rows, starts, mean.micrometres));
        let worse = Range(join([of_primitives, of_hulls]).0.iter().map(|ratio| 1.0 / ratio).collect());
        let holds = if worse.high() <= 2.0 { all.reaches(5.0) } else { "in part" };
        lines.push([
            format!("\"5-30x speedup over EPA at a comparable accuracy\" (abstract; Table III and figure over vertices): mean error {}", mean.name),
            "5 to 30×".to_owned(),
            format!("{}, with {} EPA's depth error", all.text("×"), worse.text(" times")),
            holds.to_owned(),
            String::new(),
        ]);
    }
    lines
}

/// Of the other two figures, and of the proof that the shortcut converges.
fn parts(results: &Results) -> Vec<Line> {
    let (near, far) = (Start::Guess5, Start::Guess45);
    let walk = ratios(&results.deep, ("DEEP", near), (ALGORITHM_4_5, near), ns);
    let rows = &results.shortcut;
    let (with, without, local) = ((ALGORITHM_4_5, far), (ALGORITHM_3, far), (LOCAL, far));
    let supports = |row: &Row| row.supports;
    let halved = ratios(rows, without, with, supports);
    let saved = ratios(rows, without, with, ns);
    let of = |method: &str, value: fn(&Row) -> f64| {
        Range(rows.iter().filter(|row| row.method == method).map(value).collect())
    };
    let all = [&results.primitives, &results.vertices, &results.deep, rows].into_iter().flatten();
    let failed = Range(all.filter(|row| row.method == ALGORITHM_4_5).map(|row| row.missed).collect());
    let [ends, ends_without, ours] = [ALGORITHM_4_5, ALGORITHM_3, LOCAL].map(|method| of(method, |row| row.nonminimal));
    let converges = failed.high() == 0.0 && ends.high() <= ends_without.high();
    let line = |claim: &str, paper: &str, measured: String, holds: &str, ours: String| -> Line {
        [claim.to_owned(), paper.to_owned(), measured, holds.to_owned(), ours]
    };
    vec![
        line(
            "\"About 2x faster\" than DEEP (figure beside DEEP)",
            "2×",
            walk.text("×"),
            walk.reaches(1.8),
            format!("`…Local` {}", ratios(&results.deep, ("DEEP", near), (LOCAL, near), ns).text("×")),
        ),
        line(
            "The shortcut halves the support calls (figure of the shortcut)",
            "2×",
            halved.text("×"),
            halved.reaches(1.8),
            format!("fewer than Algorithm 4/5: `…Local` {}", ratios(rows, with, local, supports).text("×")),
        ),
        line(
            "… and saves \"2-3x\" of the time (the same figure)",
            "2 to 3×",
            saved.text("×"),
            saved.reaches(1.8),
            format!("faster than Algorithm 4/5: `…Local` {}", ratios(rows, with, local, ns).text("×")),
        ),
        line(
            "\"Despite the new shortcut mechanism … guaranteed to converge to a locally optimal solution\" (Section III-C): runs \
             without a result; hulls from 45° that end in a local minimum more than 1 mm deeper than the global one, with the \
             shortcut and without",
            "0",
            format!("{}; {}, {}", failed.text(" %"), ends.text(" %"), ends_without.text(" %")),
            &either(converges, "yes", "no"),
            format!("`…Local` {}", ours.text(" %")),
        ),
    ]
}

/// What this library's form of the method costs beside the published one.
fn incremental(rows: &[Row]) -> Line {
    let over = |method, value: fn(&Row) -> f64| {
        ratios(rows, (INCREMENTAL, Start::Guess5), (method, Start::Guess5), value).text("×")
    };
    let supports = |row: &Row| row.supports;
    [
        "`ccdPenetrationIncremental`, the method in this library, over Algorithm 4/5 from 5°: time, support points"
            .to_owned(),
        String::new(),
        format!("{}, {}", over(ALGORITHM_4_5, ns), over(ALGORITHM_4_5, supports)),
        String::new(),
        format!("over Algorithm 4/5 with new portals: {}, {}", over(NEW_PORTALS, ns), over(NEW_PORTALS, supports)),
    ]
}

pub fn table(results: &Results) -> String {
    let lines = [
        accuracy(&results.primitives),
        speed(&results.primitives, &results.vertices),
        parts(results),
        vec![incremental(&results.primitives)],
    ];
    markdown("claim|paper|measured here|holds here|this library's calls", lines.concat().into_iter().map(Vec::from))
}
