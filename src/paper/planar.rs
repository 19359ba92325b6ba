// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's method in the plane (n = 2 in Sec. II-A): the loop of
//! [`crate::paper::incremental`], with the shortcut (Algorithms 4 and 5), on a portal that is a
//! segment ([`crate::paper::portal`]).
//!
//! For shapes that lie in a common plane, D lies in the plane through the origin with
//! the same normal m, and so do all directions asked for here.

#[cfg(test)]
mod tests {
    use crate::contact::{Penetration, Settings};
    use crate::known::support_set::Stop;
    use crate::math::{EPSILON, Vec3, unit};
    use crate::minkowski::support::{MinkowskiDifference, SupportMap};
    use crate::paper::incremental;
    use crate::paper::portal::Until;
    use crate::shapes::{Random, Rotation, hull};

    const TAU: f64 = core::f64::consts::TAU as f64;

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-9 } else { 1e-5 },
        max_iterations: 2000,
    };

    /// A frame of the plane: axes x, y, normal m, and a point of it off the origin.
    fn frame(r: &mut Random) -> (Rotation, Vec3, Vec3, Vec3, Vec3) {
        let turn = r.rotation();
        let [x, y, m] = [0, 1, 2].map(|i| turn * Vec3::ith(i, 1.0));
        let at = m * r.within(-3.0, 3.0);
        (turn, x, y, m, at)
    }

    fn penetration<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        m: &Vec3,
        start: Vec3,
        settings: &Settings,
    ) -> Result<Penetration, Stop> {
        incremental::penetration(md, start, Some(*m), Until::Shortcut, settings, |_| ())
    }

    fn solve<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        m: &Vec3,
        start: Vec3,
    ) -> Penetration {
        let hit = penetration(md, m, start, &SETTINGS).unwrap();
        let ulps = 100.0 * EPSILON;
        assert!(!hit.limit);
        assert!(hit.dir.dot(m).abs() < ulps, "leaves the plane");
        assert!((hit.dir.norm() - 1.0).abs() < ulps);
        // Sound, and the witnesses are on the two planes.
        let s = md.support(&hit.dir).unwrap();
        assert!((hit.dir.dot(&s.v) - hit.depth).abs() < ulps);
        let room = SETTINGS.tolerance + ulps;
        assert!((hit.dir.dot(&(hit.point1 - s.v1))).abs() <= room);
        assert!((hit.dir.dot(&(hit.point2 - s.v2))).abs() <= room);
        hit
    }

    /// Discs: the depth is r1 + r2 − distance, along the centres.
    #[test]
    fn discs() {
        let mut r = Random::new(1);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let angle = r.within(0.0, TAU);
            let way = x * angle.cos() + y * angle.sin();
            let distance = r.within(0.1, 1.4);
            let disc = |centre: Vec3, radius: f64| {
                move |d: &Vec3| {
                    let flat = d - m * m.dot(d);
                    centre + unit(&flat).map_or(Vec3::zeros(), |f| f * radius)
                }
            };
            let md = MinkowskiDifference::new(disc(at, 1.0), disc(at + way * distance, 0.5));
            let angle = r.within(0.0, TAU);
            let hit = solve(&md, &m, x * angle.cos() + y * angle.sin());
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // And from the stationary direction that is a maximum.
            let hit = solve(&md, &m, -way);
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // Started at the minimum: that, exactly.
            let hit = solve(&md, &m, way);
            assert!((hit.depth - (1.5 - distance)).abs() < 100.0 * EPSILON);
        }
    }

    /// Polygons: the answer is the support value of an edge of one of the two, and no
    /// other direction near it is lower; the best from all edges is the least of them.
    #[test]
    fn polygons() {
        let mut r = Random::new(2);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let mut polygon = |centre: Vec3| {
                let n = 3 + (r.within(0.0, 5.0) as usize);
                (0..n)
                    .map(|i| {
                        let angle = (i as f64 + r.within(0.1, 0.9)) * TAU / n as f64;
                        centre + x * angle.cos() + y * (0.6 * angle.sin())
                    })
                    .collect::<Vec<_>>()
            };
            let a = polygon(at);
            let b = polygon(at + x * 0.3 + y * 0.1);
            let md = MinkowskiDifference::new(hull(&a), hull(&b));
            let h = |n: &Vec3| n.dot(&md.support(n).unwrap().v);
            let mut edges = vec![];
            for (points, sign) in [(&a, 1.0), (&b, -1.0)] {
                for i in 0..points.len() {
                    let edge = points[(i + 1) % points.len()] - points[i];
                    let n = unit(&(edge.cross(&m) * sign)).unwrap();
                    edges.push((n, h(&n)));
                }
            }
            let least = edges.iter().fold(f64::INFINITY, |l, e| l.min(e.1));
            // Hulls of random polygons may overlap at a point only.
            if least < 1e-3 {
                continue;
            }
            let mut best = f64::INFINITY;
            for (start, _) in &edges {
                let hit = solve(&md, &m, unit(&(start + x * 0.05)).unwrap());
                let is = |e: f64| (e - hit.depth).abs() < 10.0 * SETTINGS.tolerance;
                assert!(edges.iter().any(|e| is(e.1)));
                for turn in [-1e-3, 1e-3] {
                    let n = unit(&(hit.dir + m.cross(&hit.dir) * turn)).unwrap();
                    assert!(h(&n) >= hit.depth - 10.0 * SETTINGS.tolerance);
                }
                best = best.min(hit.depth);
            }
            assert!(
                (best - least).abs() < 10.0 * SETTINGS.tolerance,
                "{best} {least}"
            );
        }
    }

    /// Polygons apart by a hundredth: a miss with a direction of the plane that separates.
    #[test]
    fn apart() {
        let mut r = Random::new(3);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let square = |c: Vec3| [c + x, c + y, c - x, c - y];
            let by = unit(&(x + y)).unwrap() * ((2.0 as f64).sqrt() + 0.01);
            let md = MinkowskiDifference::new(hull(&square(at)), hull(&square(at + by)));
            let angle = r.within(0.0, TAU);
            let start = x * angle.cos() + y * angle.sin();
            match penetration(&md, &m, start, &SETTINGS) {
                Err(Stop::Apart(n)) => {
                    assert!(n.dot(&m).abs() < 100.0 * EPSILON);
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                // A local minimum behind the other square: not yet a proven overlap.
                Ok(hit) => assert!(!hit.limit && hit.dir.dot(&by) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}
