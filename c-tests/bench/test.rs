// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The quick charts: their files are whole, and what they measure is sound.

// The benchmark's own parts; this test uses some.
#[allow(dead_code)]
mod charts;
#[path = "../harness/mod.rs"]
mod harness;
#[path = "../lab/mod.rs"]
mod lab;
#[allow(dead_code)]
mod peers;
mod poses;
mod progress;

use lab::csv;
use lab::measure::Row;
use lab::recorded::RANDOM;

/// What of an error can be seen: not less than the truth's own uncertainty, nor
/// than a few ulps of a metre.
fn visible(row: &Row) -> f64 {
    row.mean_error.max(row.truth_gap).max(1e-15)
}

/// Whether `a` is at least as good as `b` in supports and error.
fn beats(a: &Row, b: &Row) -> bool {
    let (Some(sa), Some(sb)) = (a.supports, b.supports) else {
        return false;
    };
    sa <= sb && visible(a) <= visible(b)
}

/// The rows of a set that no other method's row beats: the Pareto front.
fn front<'a>(rows: &'a [Row], set: &str) -> Vec<&'a Row> {
    let of = || rows.iter().filter(|r| r.set == set && r.supports.is_some());
    let mut front: Vec<&Row> = of()
        .filter(|b| !of().any(|a| beats(a, b) && !beats(b, a)))
        .collect();
    front.sort_by(|a, b| {
        a.supports
            .partial_cmp(&b.supports)
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    front
}

#[test]
fn quick_charts_are_whole_and_ours_on_the_front() {
    let out = tempfile::tempdir().expect("a temporary directory");
    charts::run(&charts::Options {
        only: None,
        quick: true,
        no_instructions: true,
        out: out.path().to_owned(),
    });
    let rows: Vec<Row> = ["accuracy", "paper", "vertices", "coherence", "recorded"]
        .iter()
        .flat_map(|name| csv::read::<Row>(&out.path().join(name).with_extension("csv")))
        .collect();
    assert!(rows.len() > 500, "{} rows", rows.len());
    for row in &rows {
        let numbers = [
            row.mean_error,
            row.median_error,
            row.max_error,
            row.mean_error_1mm,
            row.unsound,
            row.direction,
            row.ns.unwrap_or(0.0),
            row.supports.unwrap_or(0.0),
            row.gap.unwrap_or(0.0),
        ];
        assert!(numbers.iter().all(|x| x.is_finite()), "{row:?}");
        if row.ours {
            assert!(row.unsound <= 1e-12, "unsound: {row:?}");
            assert!(row.missed == 0.0 && row.shallow == 0.0, "{row:?}");
        }
    }
    // libccd's MPR starts two spheres at the answer: one support, exact.
    for set in RANDOM.iter().filter(|s| **s != "sph_sph") {
        let front = front(&rows, set);
        assert!(front.iter().any(|r| r.ours), "{set}: {front:#?}");
        let fewest = front.first().expect("a front");
        assert!(fewest.ours, "{set}: fewest supports: {fewest:?}");
    }
    for name in [
        "front",
        "accuracy_supports",
        "accuracy_time",
        "frames_supports",
        "frames_time",
        "tolerance",
        "vertices",
        "coherence_supports",
        "coherence_time",
        "models",
    ] {
        let path = out.path().join(name).with_extension("svg");
        let picture = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            picture.starts_with("<svg") && picture.ends_with("</svg>\n"),
            "{}",
            path.display()
        );
        assert!(!picture.contains("NaN"), "{}", path.display());
    }
    let page = std::fs::read_to_string(out.path().join("README.md")).unwrap_or_default();
    assert!(
        page.contains("# Speed against accuracy") && !page.contains("{{"),
        "{page}"
    );
}
