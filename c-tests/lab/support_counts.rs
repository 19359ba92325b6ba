// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests of what is measured exactly: support counts and errors that no later change may
//! lose, and the DEEP baseline.

#![cfg(not(feature = "single"))]

#[path = "../harness/mod.rs"]
mod harness;
#[path = "mod.rs"]
mod lab;

use lab::csv;
use lab::deep::{Deep, Polytope};
use lab::libraries::Libraries;
use lab::methods::Start;
use lab::recorded::{self, Recorded};
use lab::scene::{Mesh, Scene};
use nalgebra::{Matrix3, Vector3};

type V = Vector3<f64>;

/// No set needs more supports, or errs more, than `support_counts.csv` says.
/// `cargo bench -p charts -- record` writes the file anew.
#[test]
fn no_set_needs_more_supports_or_errs_more() {
    let libraries = Libraries::open();
    let recorded: Vec<Recorded> = csv::read(&recorded::file());
    assert!(recorded.len() > 50, "{} lines recorded", recorded.len());
    let mut lost = Vec::new();
    for now in recorded::measure(&libraries) {
        let then = recorded.iter().find(|h| {
            (&h.set, &h.method, &h.start) == (&now.set, &now.method, &now.start)
                && Some(h.tolerance) == now.tolerance
        });
        let then = then.unwrap_or_else(|| panic!("not recorded: {} {}", now.set, now.method));
        // Counts and errors repeat exactly; the slack is for another compiler's rounding
        // and for a valley more or less: one pose in 500 is 0.2 percent.
        let more = now.supports.is_none_or(|s| s > then.supports * 1.02 + 0.05)
            || now.mean_error_1mm > then.mean_error_1mm * 1.5 + 1e-7
            || now.nonminimal > then.nonminimal + 0.61
            || now.missed > 0.0
            || now.shallow > 0.0
            || now.unsound > 1e-12;
        if more {
            lost.push(format!("then {then:?}\nnow  {now:?}"));
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

/// Every facet of D = A − B as (unit normal, distance of its plane from the origin):
/// faces of A, faces of B turned round, and each pair of edges that is extremal along
/// the normal of both.
fn facets(a: &Mesh, b: &[V]) -> Vec<(V, f64)> {
    let support = |n: &V| {
        let far = |s: f64, v: &[V]| v.iter().map(|p| s * n.dot(p)).fold(f64::MIN, f64::max);
        (far(1.0, &a.vertices), far(-1.0, b))
    };
    let edges = |v: &[V], mesh: &Mesh| -> Vec<(V, V)> {
        let all = mesh
            .triangles
            .iter()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
        all.filter(|(i, j)| i < j)
            .map(|(i, j)| (v[i], v[j]))
            .collect()
    };
    let mut found = Vec::new();
    let mut add = |n: V, edge: Option<(V, V)>| {
        for n in [n.normalize(), -n.normalize()] {
            if !n.x.is_finite() {
                continue;
            }
            let (ha, hb) = support(&n);
            let touches = |p: &V, q: &V| ha - n.dot(p) < 1e-12 && hb + n.dot(q) < 1e-12;
            if edge.is_none_or(|(p, q)| touches(&p, &q)) {
                found.push((n, ha + hb));
            }
        }
    };
    for (v, _) in [(&a.vertices[..], 0), (b, 1)] {
        for t in &a.triangles {
            let n = (v[t[1]] - v[t[0]]).cross(&(v[t[2]] - v[t[0]]));
            add(n, None);
        }
    }
    let edges_b = edges(b, a);
    for (p, q) in edges(&a.vertices, a) {
        for (r, s) in &edges_b {
            // Both ends of both edges are extremal when one end of each is: n is across both.
            add((q - p).cross(&(s - r)), Some((p, *r)));
        }
    }
    found
}

/// DEEP's answers are facets of D whose distance no neighbour undercuts, the global
/// minimum where it starts there, and the enumeration agrees with the certified truth.
#[test]
fn deep_walks_to_facets() {
    let libraries = Libraries::open();
    for (name, poses) in [("box_box", 60), ("p12_p12", 60), ("p42_p42", 8)] {
        let scene = Scene::load(&libraries, name, poses);
        let mesh = &scene.meshes[0];
        let [a, b] = [0, 1].map(|k| Polytope::new(&scene.meshes[k]));
        let (mut deep, mut global) = (Deep::default(), 0);
        for pair in &scene.pairs {
            let ((ra, pa), (rb, pb)) = (pair.pose(&libraries, 0), pair.pose(&libraries, 1));
            let (turn, shift): (Matrix3<f64>, V) =
                (ra.transpose() * rb, ra.transpose() * (pb - pa));
            let placed: Vec<V> = scene.meshes[1]
                .vertices
                .iter()
                .map(|v| turn * v + shift)
                .collect();
            let facets = facets(mesh, &placed);
            let least = facets.iter().map(|f| f.1).fold(f64::MAX, f64::min);
            assert!(
                (least - pair.truth.depth).abs() < 1e-12,
                "{name}: {least} {:?}",
                pair.truth
            );
            let mut walk = |from: [f64; 3]| {
                deep.penetration(&a, &b, turn, shift, ra.transpose() * V::from(from))
                    .expect("a start that has hubs")
            };
            let (depth, n) = walk(pair.truth.normal);
            assert!(
                (depth - least).abs() < 1e-12,
                "{name}: {depth} from the truth, {least}"
            );
            assert!(
                (ra * n - V::from(pair.truth.normal)).norm() < 1e-6,
                "{name}"
            );
            for start in Start::GUESSES {
                let (depth, n) = walk(start.direction(&pair.truth).expect("a guess"));
                let facet = facets
                    .iter()
                    .any(|f| (f.0 - n).norm() < 1e-9 && (f.1 - depth).abs() < 1e-12);
                assert!(facet, "{name}: {depth} along {n} is no facet");
                assert!(depth >= least - 1e-12, "{name}: {depth} below {least}");
                // Nearer planes around would pass nearer than this one along nearby normals.
                let h = |n: V| {
                    let far = |v: &[V], n: V| v.iter().map(|p| n.dot(p)).fold(f64::MIN, f64::max);
                    far(&mesh.vertices, n) + far(&placed, -n)
                };
                for around in &facets {
                    let near = (n + (around.0 - n).cap_magnitude(1e-4)).normalize();
                    assert!(h(near) >= depth - 1e-12, "{name}: not a local minimum");
                }
                global += usize::from(start == Start::Five && depth < least + 1e-12);
            }
        }
        assert!(
            global * 100 >= scene.pairs.len() * 95,
            "{name}: {global} global from 5°"
        );
    }
}
