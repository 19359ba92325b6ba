// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests that the files of the quick charts are whole, and that the results of this library are sound.

use crate::charts;
use crate::charts::deep::{self, Polytope};
use crate::measuring::csv;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::Start;
use crate::measuring::scene::Scene;

#[test]
fn quick_charts_are_whole_and_sound() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let figures = ["accuracy", "vertices", "coherence"];
    charts::run(&charts::Options { only: figures.map(str::to_owned).into(), quick: true, out: out.path().to_owned() });
    let read = |name: &&str| csv::read::<Row>(&out.path().join(name).with_extension("csv")).1;
    let rows: Vec<Row> = figures.iter().flat_map(read).collect();
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
    for name in ["front", "accuracy_supports", "accuracy_time", "frames_supports", "frames_time", "vertices"] {
        let path = out.path().join(name).with_extension("svg");
        let picture = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(picture.starts_with("<svg") && picture.ends_with("</svg>\n"), "{}", path.display());
        assert!(!picture.contains("NaN"), "{}", path.display());
    }
    let page = std::fs::read_to_string(out.path().join("README.md")).unwrap_or_default();
    assert!(page.contains("# Speed against accuracy") && !page.contains("{{"), "{page}");
}

/// Checks that DEEP's depths are support values, never below the certified minimum, and from 5° nearly always the minimum.
#[test]
fn deep_walks_to_local_minima() {
    let libraries = Libraries::open();
    for name in ["p12_p12", "p42_p42", "p162_p162"] {
        let scene = Scene::load(&libraries, name, 200);
        let meshes = Polytope::of_set(name).expect("two polytopes");
        for row in Runner::new(&libraries).rows(&scene, deep::methods(&libraries, &meshes, Start::Guess5)) {
            assert!(row.unsound < 1e-12 && row.missed == 0.0, "{row:?}");
            assert!(row.shallow == 0.0 && row.nonminimal < 5.0, "{row:?}");
        }
    }
}
