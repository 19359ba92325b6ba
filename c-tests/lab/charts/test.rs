// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests that the files of the quick charts are whole, and that the results of this library are sound.

use crate::charts;
use crate::measuring::csv;
use crate::measuring::measure::Row;

#[test]
fn quick_charts_are_whole_and_sound() {
    let out = tempfile::tempdir().expect("a temporary directory");
    charts::run(out.path(), true);
    let read = |name: &str| csv::read::<Row>(&out.path().join(name)).1;
    let motions = read("coherence.csv");
    assert_eq!(motions.len(), 18 * 10);
    assert!(motions.iter().all(|row| row.jitter.is_some() && row.direction_rms.is_some()));
    let local = read("local.csv");
    assert_eq!(local.len(), 14 * 2 * 2 * 4);
    let rows = [read("accuracy.csv"), motions, local].concat();
    assert!(rows.len() > 500, "{} rows", rows.len());
    for row in &rows {
        let numbers =
            [row.mean_error, row.max_error, row.mean_error_1mm, row.unsound, row.ns.unwrap_or(0.0), row.supports];
        assert!(numbers.iter().all(|x| x.is_finite()), "{row:?}");
        if row.ours {
            assert!(row.unsound <= 1e-12, "unsound: {row:?}");
            assert!(row.missed == 0.0 && row.shallow == 0.0, "{row:?}");
        }
    }
    for name in ["accuracy", "accuracy_supports", "accuracy_time", "frames_supports", "frames_time", "front", "local"] {
        let path = out.path().join(name).with_extension("svg");
        let picture = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(picture.starts_with("<svg") && picture.ends_with("</svg>\n"), "{}", path.display());
        assert!(!picture.contains("NaN"), "{}", path.display());
    }
    let page = std::fs::read_to_string(out.path().join("README.md")).unwrap_or_default();
    assert!(page.contains("# Speed against accuracy"), "{page}");
}
