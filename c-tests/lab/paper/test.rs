// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests the baselines of the paper's evaluation, and that its quick figures are whole.

use crate::measuring::csv;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::Start;
use crate::paper::deep::{self, Polytope};
use crate::paper::poses::{self, Mesh, Shape};
use crate::paper::{ALGORITHM_3, ALGORITHM_4_5, polygon, published};

/// Checks that DEEP's depths are support values and local minima: no direction near its own has a lower one; and that from
/// 5° nearly all are the global one.
#[test]
fn deep_walks_to_local_minima() {
    let mut libraries = Libraries::open();
    libraries.use_placed();
    for halvings in 0..3 {
        let hull: &'static Shape = Box::leak(Box::new(Shape::Hull(Mesh::icosphere(halvings))));
        let polytope = Polytope::new(&Mesh::icosphere(halvings));
        let poses = poses::random(&libraries, "hulls", [hull, hull], 200);
        for (start, most) in [(Start::Guess5, 5.0), (Start::Guess45, 50.0)] {
            let mut method = deep::method(&poses, [&polytope, &polytope], start);
            for pair in &poses.scene.pairs {
                let answer = (method.query)(pair).expect("an overlap");
                let n = nalgebra::Vector3::from(answer.dir);
                let value = |n| crate::measuring::measure::support_value(&libraries, pair, n);
                assert!((value(n) - answer.depth).abs() < 1e-12, "{answer:?}");
                let e1 = n.cross(&nalgebra::Vector3::ith(n.iamin(), 1.0)).normalize();
                for k in 0..16 {
                    let (sin, cos) = (f64::from(k) * 0.4).sin_cos();
                    let beside = n + (e1 * cos + n.cross(&e1) * sin) * 1e-4;
                    assert!(value(beside.normalize()) >= answer.depth - 1e-12, "{answer:?} is no minimum");
                }
            }
            let method = deep::method(&poses, [&polytope, &polytope], start);
            for row in Runner::new(&libraries).rows(&poses.scene, vec![method]) {
                assert!(row.missed == 0.0 && row.shallow == 0.0 && row.nonminimal < most, "{row:?}");
            }
        }
    }
}

/// Checks that both published algorithms reach the global minimum of spheres and capsules from everywhere, within their
/// tolerance, and that the shortcut saves support points.
#[test]
fn published_algorithms_reach_the_minimum() {
    let mut libraries = Libraries::open();
    libraries.use_placed();
    for shapes in [[&Shape::Sphere, &Shape::Capsule], [&Shape::Capsule, &Shape::Capsule]] {
        let poses = poses::random(&libraries, "rounded", shapes, 200);
        let methods =
            [ALGORITHM_4_5, ALGORITHM_3].map(|name| published::method(&libraries, name, Start::Guess45, 1e-6));
        let rows = Runner::new(&libraries).rows(&poses.scene, methods.into());
        for row in &rows {
            assert!(row.missed == 0.0 && row.max_error < 1e-4, "{row:?}");
        }
        assert!(rows[0].supports < 0.6 * rows[1].supports, "{rows:?}");
    }
}

/// Checks that both end in local minima of hulls from 45°, despite the shortcut: no direction within 3 mrad, the error that
/// the tolerance allows, is lower by five tolerances.
#[test]
fn published_algorithms_end_in_local_minima() {
    let mut libraries = Libraries::open();
    libraries.use_placed();
    for halvings in 0..4 {
        let hull: &'static Shape = Box::leak(Box::new(Shape::Hull(Mesh::icosphere(halvings))));
        let poses = [hull, &Shape::Capsule].map(|other| poses::random(&libraries, "hulls", [hull, other], 300));
        for (pair, name) in poses.iter().flat_map(|p| &p.scene.pairs).zip([ALGORITHM_4_5, ALGORITHM_3].iter().cycle()) {
            let mut method = published::method(&libraries, name, Start::Guess45, 1e-6);
            let answer = (method.query)(pair).expect("an overlap");
            let n = nalgebra::Vector3::from(answer.dir);
            let e1 = n.cross(&nalgebra::Vector3::ith(n.iamin(), 1.0)).normalize();
            for (k, tangent) in (0..32).map(|k| (f64::from(k) * 0.4, [1e-3, 3e-3][k as usize % 2])) {
                let beside = n + (e1 * k.cos() + n.cross(&e1) * k.sin()) * tangent;
                let value = crate::measuring::measure::support_value(&libraries, pair, beside.normalize());
                assert!(
                    value >= answer.depth - 5e-6,
                    "{name}, {halvings}: {answer:?} is no minimum, {value} beside it"
                );
            }
        }
    }
}

/// Compares the intersection of two polygons with clipping one by the edges of the other, by area.
#[test]
fn polygons_intersect_as_by_clipping() {
    type Point = [f64; 2];
    let area = |p: &[Point]| -> f64 {
        let next = p.iter().cycle().skip(1);
        p.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
    };
    let clip = |polygon: &[Point], a: Point, b: Point| {
        let left = |p: Point| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut out = Vec::new();
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (dp, dq) = (left(p), left(q));
            if dp >= 0.0 {
                out.push(p);
            }
            if (dp >= 0.0) != (dq >= 0.0) {
                let t = dp / (dp - dq);
                out.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
            }
        }
        out
    };
    let polygon = |corners: usize, x: f64, turn: f64| -> Vec<Point> {
        let angle = |k| (k as f64 + turn) * std::f64::consts::TAU / corners as f64;
        (0..corners).map(|k| [x + angle(k).cos(), 0.7 * angle(k).sin()]).collect()
    };
    let mut found = Vec::new();
    for k in 0..3000 {
        let unit = |step: f64| (f64::from(k) * step).fract();
        let first = polygon(3 + k as usize % 6, 0.0, unit(0.618));
        let second = polygon(3 + k as usize % 5, 2.5 * unit(0.7548), unit(0.5698));
        polygon::intersection(&first, &second, &mut found);
        let ends = |k: usize| (second[k], second[(k + 1) % second.len()]);
        let expected = (0..second.len()).map(ends).fold(first.clone(), |p, (a, b)| clip(&p, a, b));
        assert!((area(&found) - area(&expected)).abs() < 1e-12, "{first:?} {second:?} {found:?} {expected:?}");
    }
}

#[test]
fn quick_figures_are_whole() {
    let out = tempfile::tempdir().expect("a temporary directory");
    crate::paper::run(out.path(), true);
    for (name, least) in [("primitives", 33), ("vertices", 40), ("deep", 30), ("shortcut", 20)] {
        let (_, rows) = csv::read::<Row>(&out.path().join(name).with_extension("csv"));
        assert!(rows.len() >= least, "{name}: {} rows", rows.len());
        for row in &rows {
            assert!(row.ns.is_some_and(|ns| ns > 0.0) && row.mean_error.is_finite(), "{row:?}");
            assert!(!row.ours || row.missed == 0.0 && row.unsound <= 1e-12, "{row:?}");
        }
    }
    let page = std::fs::read_to_string(out.path().join("README.md")).unwrap_or_default();
    assert!(page.contains("# The paper") && !page.contains("NaN"), "{page}");
}
