// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Tests of the published method: the search from ray to ray, one ray, the case n = 2.

mod search {
    use super::super::*;
    use crate::test_shapes::{Random, ball, capsule, corners, difference, ellipsoid, hull, placed};

    const SETTINGS: Settings = Settings {
        max_iterations: 20_000,
        ..Settings::new(if EPSILON < 1e-10 { 1e-7 } else { 1e-5 })
    };

    fn solve<D: Difference>(
        md: &D,
        start: Vec3,
        shortcut: Until,
        switched: impl FnMut(f64),
    ) -> Solution {
        let hit = incremental_minimum(md, start, None, shortcut, &SETTINGS, switched).unwrap();
        assert_eq!(hit.status, Status::Converged);
        hit
    }

    /// Tests flat ellipses in a common plane, which only touch though they overlap in it: the support value of the normal
    /// of the plane is rounding, and separates.
    #[test]
    fn flat_bodies_are_separated() {
        let mut r = Random::new(10);
        for _ in 0..1000 {
            let turn = r.rotation();
            let mut flat = || {
                // Not 0, so that the support point along the normal of the plane is defined.
                let radii = Vec3::new(r.within(0.3, 1.0), r.within(0.3, 1.0), 1e-20);
                let at = Vec3::new(r.within(-0.2, 0.2), r.within(-0.2, 0.2), 0.0);
                ellipsoid(radii, turn, turn * at)
            };
            let md = difference(flat(), flat());
            let found =
                incremental_minimum(&md, Vec3::x(), None, Until::Shortcut, &SETTINGS, |_| ());
            assert!(matches!(found, Err(Stop::Separated(_))), "{found:?}");
        }
    }

    /// An ellipsoid with semi-axes `radii` about `center`, as a level set
    /// g(v) = Σ ((v − center)ᵢ / radiiᵢ)² − 1, so that planes and rays are at hand.
    struct Explicit {
        radii: Vec3,
        center: Vec3,
    }

    impl Explicit {
        /// Unit normal ∇g / |∇g| at a boundary point.
        fn normal(&self, v: &Vec3) -> Vec3 {
            let r2 = self.radii.component_mul(&self.radii);
            unit(&(v - self.center).component_div(&r2)).unwrap()
        }

        /// Returns the point at which the ray from the origin along `d` leaves the ellipsoid: the root t > 0 of g(t d).
        fn exit(&self, d: &Vec3) -> Vec3 {
            let d_ = d.component_div(&self.radii);
            let c = self.center.component_div(&self.radii);
            let (a, b) = (d_.dot(&d_), d_.dot(&c));
            d * ((b + (b * b - a * (c.dot(&c) - 1.0)).sqrt()) / a)
        }

        /// The paper's Algorithm 2 from the boundary point `v`: the plane at v, the
        /// origin's projection z on it, the boundary point along z. `each` is called with |z|.
        fn sqp(&self, mut v: Vec3, mut each: impl FnMut(f64)) -> Vec3 {
            for _ in 0..3000 {
                let n = self.normal(&v);
                let z = n * n.dot(&v);
                each(z.norm());
                v = self.exit(&unit(&z).unwrap());
            }
            v
        }
    }

    /// Algorithm 2 on an ellipsoid about the origin: |z| never rises, and the fixed point is the
    /// end of the shortest axis.
    #[test]
    fn algorithm_2_ends_on_the_shortest_axis() {
        let mut r = Random::new(1);
        for _ in 0..100 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                center: Vec3::zeros(),
            };
            let mut last = f64::INFINITY;
            let v = e.sqp(e.exit(&r.direction()), |z| {
                assert!(z <= last * (1.0 + 4.0 * EPSILON));
                last = z;
            });
            assert!((v.norm() - e.radii.x).abs() < 1e3 * EPSILON);
            assert!((e.normal(&v).x.abs() - 1.0).abs() < 1e3 * EPSILON);
        }
    }

    /// Algorithm 2 on an ellipsoid off the origin: at the fixed point v is parallel to its normal.
    /// Algorithm 3, which has only the support function, takes the same steps to it.
    #[test]
    fn algorithm_3_takes_the_steps_of_algorithm_2() {
        let mut r = Random::new(2);
        let tolerance = 1e-10;
        for _ in 0..50 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                center: r.vector(0.2),
            };
            let v = e.sqp(e.exit(&r.direction()), |_| ());
            assert!(e.normal(&v).cross(&v).norm() < 1e4 * EPSILON);

            let support = ellipsoid(e.radii, crate::test_shapes::Rotation::identity(), e.center);
            let md = difference(support, |_: &Vec3| Vec3::zeros());
            let mut ray = support_plane(&md, r.direction()).unwrap();
            for _ in 0..20 {
                let normal = e.normal(&e.exit(&ray.dir));
                let mut search = RaySearch {
                    md: &md,
                    tolerance,
                    until: Until::Normal,
                    plane_normal: None,
                    scale: Scale::default(),
                    budget: 2000,
                    best: ray,
                };
                match search.follow(&ray) {
                    Ok(RayEnd::Converged(_, plane)) => {
                        // A gap of tol leaves an angle of sqrt(tol) to the normal.
                        let error = (plane.dir - normal).norm();
                        let room = 4.0 * tolerance.max(64.0 * EPSILON).sqrt();
                        assert!(error < room, "{error:e}");
                        ray = plane;
                    }
                    _ => panic!("no portal"),
                }
            }
        }
    }

    /// Returns whether no direction within 3 degrees is lower by more than the tolerance.
    fn is_local_minimum<D: Difference>(md: &D, hit: &Solution, r: &mut Random) -> bool {
        (0..50).all(|_| {
            let n = unit(&(hit.dir + r.vector(0.03))).unwrap();
            support_plane(md, n).unwrap().depth >= hit.depth - 10.0 * SETTINGS.tolerance
        })
    }

    /// Algorithm 3 and Algorithms 4, 5 end in a local minimum each; started near a
    /// minimum, in no higher one. |z| falls strictly at each change of the ray.
    #[test]
    fn with_and_without_the_shortcut() {
        let mut r = Random::new(3);
        let mut supports = [0; 2];
        for _ in 0..200 {
            let turn = r.rotation();
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let (a, b) = (r.vector(0.5), r.vector(0.5));
            let cube = placed(&corners(half), &turn, r.vector(0.1));
            let md = difference(hull(&cube), capsule(a, b, 0.3));
            let start = r.direction();
            for (i, shortcut) in [Until::Normal, Until::Shortcut].into_iter().enumerate() {
                let before = md.supports();
                let mut last = support_plane(&md, start).unwrap().depth;
                let hit = solve(&md, start, shortcut, |z| {
                    assert!(z < last, "{z} after {last}");
                    last = z;
                });
                supports[i] += md.supports() - before;
                assert!(is_local_minimum(&md, &hit, &mut r));
                let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v);
                assert!((h - hit.depth).abs() < 32.0 * EPSILON);
                // From a nearby direction both return to it, or to a lower one.
                let near = unit(&(hit.dir + r.vector(0.01))).unwrap();
                for shortcut in [Until::Normal, Until::Shortcut] {
                    let again = solve(&md, near, shortcut, |_| ());
                    assert!(again.depth <= hit.depth + 4.0 * SETTINGS.tolerance);
                }
            }
        }
        // The paper's ablation: the shortcut saves about half.
        assert!(supports[1] < supports[0], "{supports:?}");
    }

    /// Started at a maximum, along its own support point, the search perturbs the direction.
    #[test]
    fn a_maximum_is_left() {
        // A ball on the axis of a capsule: depth 1.3 along the axis, 1.0 perpendicular to it.
        let md = difference(
            ball(Vec3::zeros(), 0.5),
            capsule(Vec3::z() * -0.5, Vec3::z() * 0.5, 0.5),
        );
        let shifted = difference(
            ball(Vec3::z() * 0.2, 0.5),
            capsule(Vec3::z() * -0.5, Vec3::z() * 0.5, 0.5),
        );
        for shortcut in [Until::Normal, Until::Shortcut] {
            for md in [&md, &shifted] {
                for start in [Vec3::z(), -Vec3::z()] {
                    let hit = solve(md, start, shortcut, |_| ());
                    assert!((hit.depth - 1.0).abs() <= 1e-4, "{}", hit.depth);
                    assert!(hit.dir.z.abs() < 0.02, "{}", hit.dir);
                }
            }
        }
    }

    /// Icosahedra started along a vertex: the minimum is a face of their difference.
    #[test]
    fn icosahedra_along_a_vertex() {
        let p = (1.0 + (5.0 as f64).sqrt()) / 2.0;
        let mut points = vec![];
        for (s, t) in [(1.0, p), (1.0, -p), (-1.0, p), (-1.0, -p)] {
            points.push(Vec3::new(0.0, s, t));
            points.push(Vec3::new(s, t, 0.0));
            points.push(Vec3::new(t, 0.0, s));
        }
        let md = difference(hull(&points), hull(&points));
        // The inradius of an icosahedron with edge 2.
        let inradius = (3.0 as f64).sqrt() * (3.0 + (5.0 as f64).sqrt()) / 6.0;
        for v in &points {
            let hit = solve(&md, unit(v).unwrap(), Until::Shortcut, |_| ());
            assert!((hit.depth - 2.0 * inradius).abs() <= 1e-5, "{}", hit.depth);
        }
    }

    /// A box on itself: the result is the depth of one of the three pairs of faces.
    #[test]
    fn a_box_on_itself() {
        let cube = corners(Vec3::new(0.5, 0.4, 0.3));
        let md = difference(hull(&cube), hull(&cube));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let hit = solve(&md, r.direction(), Until::Shortcut, |_| ());
            let face = [1.0, 0.8, 0.6].map(|d| (hit.depth - d).abs() < 1e-6);
            assert!(face.contains(&true), "{}", hit.depth);
        }
    }

    /// Checks that the result is sound, and has the status, for every iteration limit.
    #[test]
    fn the_iteration_limit_is_reported() {
        let mut r = Random::new(6);
        for max_iterations in 0..30 {
            let center = r.vector(0.3);
            let md = difference(ball(center, 0.5), ball(Vec3::zeros(), 0.4));
            let settings = Settings {
                max_iterations,
                ..Settings::new(1e-9)
            };
            let start = r.direction();
            let hit =
                incremental_minimum(&md, start, None, Until::Shortcut, &settings, |_| ()).unwrap();
            assert_eq!(hit.status, Status::IterationLimit);
            assert!(hit.iterations <= max_iterations);
            let h = hit.dir.dot(&md.support(&hit.dir).unwrap().v);
            assert!((h - hit.depth).abs() <= 8.0 * EPSILON);
            let apart = (hit.point1 - hit.point2).dot(&hit.dir);
            assert!((apart - hit.depth).abs() <= 8.0 * EPSILON);
        }
    }
}

mod portal {
    use super::super::*;
    use crate::minkowski::support::{MinkowskiDifference, SupportMap};
    use crate::test_shapes::{
        Random, Rotation, Shape, corners, difference, ellipsoid, hull, placed,
    };

    const ULPS: f64 = 100.0 * EPSILON;

    /// Returns the difference of `d` and the origin, which is `d`.
    fn alone<'a>(d: impl SupportMap + 'a) -> MinkowskiDifference<Shape<'a>, Shape<'a>> {
        difference(d, |_: &Vec3| Vec3::zeros())
    }

    /// Returns a search that begins with the plane `best`.
    fn search<D: Difference>(
        md: &D,
        best: SupportPlane,
        tolerance: f64,
        until: Until,
        budget: u64,
    ) -> RaySearch<'_, D> {
        RaySearch {
            md,
            tolerance,
            until,
            plane_normal: None,
            scale: Scale::default(),
            budget,
            best,
        }
    }

    /// Returns whether the ray crosses the portal: none of the three products T is negative by more than rounding.
    fn crosses(p: &RayPortal) -> bool {
        let [a, b, c] = p.planes.each_ref().map(|x| &x.point.v);
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(x, y)| triple(&p.ray, x, y) >= -ULPS)
    }

    /// Returns the parameters at which the ray crosses the plane of the portal and the support plane.
    fn reaches(p: &RayPortal, plane: &SupportPlane) -> (f64, f64) {
        let along = plane.dir.dot(&p.ray);
        (
            plane.dir.dot(&p.planes[0].point.v) / along,
            plane.depth / along,
        )
    }

    /// Checks Algorithm 1 for the ray `d`: its invariants and its result, against the distance
    /// `exact` at which the ray leaves D.
    fn check<A: SupportMap>(support: A, d: Vec3, exact: f64, tolerance: f64) {
        let md = alone(support);
        let first = support_plane(&md, d).unwrap();
        let mut search = search(&md, first, tolerance, Until::Normal, 1000);
        match search.find_portal(&first).unwrap() {
            Ok(found) => {
                assert!(crosses(&found));
                // Each vertex is the support point of its own plane.
                for p in &found.planes {
                    assert_eq!(md.support(&p.dir).unwrap(), p.point);
                }
                // Step by step: the ray crosses every updated portal, whose parameter along the
                // ray only grows (it may be negative at first).
                let mut portal = found;
                let mut before = f64::NEG_INFINITY;
                for _ in 0..8 {
                    let Some(n) = portal.normal() else { break };
                    let plane = support_plane(&md, n).unwrap();
                    let (p, q) = reaches(&portal, &plane);
                    assert!(p <= exact + ULPS && q >= exact - ULPS, "{p} {exact} {q}");
                    assert!(p >= before - ULPS);
                    before = p;
                    if q - p <= ULPS {
                        break;
                    }
                    portal.update(plane);
                    assert!(crosses(&portal));
                }
                let exit = search.refine(found);
                let Ok(RayEnd::Converged(portal, plane)) = exit else {
                    panic!("no exit");
                };
                let (p, q) = reaches(&portal, &plane);
                assert!(p <= exact + ULPS && exact <= q + ULPS);
                assert!((q - p) * plane.dir.dot(&d) <= tolerance + ULPS);
                // The witnesses: on the ray, at the portal.
                let (w1, w2) = portal.witnesses();
                assert!((w1 - w2 - d * p).norm() <= 10.0 * ULPS);
            }
            Err(RayEnd::Vertex) => assert!((first.depth - exact).abs() <= ULPS),
            _ => panic!("no portal"),
        }
    }

    #[test]
    fn algorithm_1_on_an_ellipsoid() {
        let mut r = Random::new(1);
        for _ in 0..500 {
            let radii = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
            let d = r.direction();
            let exact = 1.0 / d.component_div(&radii).norm();
            let support = ellipsoid(radii, Rotation::identity(), Vec3::zeros());
            check(support, d, exact, 1e-6);
        }
    }

    #[test]
    fn algorithm_1_on_a_box() {
        let mut r = Random::new(2);
        for round in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 2.0));
            let turn = r.rotation();
            let at = half.map(|h| r.within(-0.9, 0.9) * h);
            // The origin is off the center; every tenth ray is along an axis, through the middle of a face.
            let (at, d) = match round % 10 {
                0 => (Vec3::zeros(), Vec3::ith(round / 10 % 3, 1.0)),
                _ => (at, r.direction()),
            };
            // The closest of the three planes along the ray.
            let exact = (0..3).fold(f64::INFINITY, |t, i| {
                t.min((half[i].copysign(d[i]) + at[i]) / d[i]).max(0.0)
            });
            let points = placed(&corners(half), &turn, turn * at);
            check(hull(&points), turn * d, exact, 1e-6);
        }
    }

    /// With the origin outside D the search ends with a direction that separates.
    #[test]
    fn an_origin_outside_is_separated() {
        let mut r = Random::new(3);
        for _ in 0..500 {
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let way = r.direction();
            let points = placed(&corners(half), &r.rotation(), way * 3.0);
            let md = alone(hull(&points));
            // From the center through the origin, as from the centers of two objects.
            let first = support_plane(&md, -way).unwrap();
            match search(&md, first, 1e-6, Until::Normal, 1000).follow(&first) {
                Err(Stop::Separated(Direction { n, .. })) => {
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                _ => panic!("the origin is outside"),
            }
        }
    }

    /// Checks that a budget that is too small is reported, and is not exceeded.
    #[test]
    fn budgets_are_kept_and_reported() {
        let mut r = Random::new(4);
        for given in 0..20 {
            let radii = Vec3::new(1.0, 0.7, 0.5);
            let md = alone(ellipsoid(radii, r.rotation(), Vec3::zeros()));
            let first = support_plane(&md, r.direction()).unwrap();
            let mut search = search(&md, first, 0.0, Until::Normal, given);
            let exit = search.follow(&first).unwrap();
            assert!(matches!(exit, RayEnd::Limit));
            assert_eq!(search.budget, 0);
            assert!(md.supports() <= given + 2);
            assert!(search.best.depth <= first.depth);
        }
    }
}

/// The case n = 2.
mod planar {
    use super::super::*;
    use crate::test_shapes::{Random, Rotation, difference, hull};

    const TAU: f64 = core::f64::consts::TAU as f64;

    const SETTINGS: Settings = Settings {
        max_iterations: 2000,
        ..Settings::new(if EPSILON < 1e-10 { 1e-9 } else { 1e-5 })
    };

    /// Returns a random rotation, the axes x, y and the normal m of a plane, and a point of the plane.
    fn frame(r: &mut Random) -> (Rotation, Vec3, Vec3, Vec3, Vec3) {
        let turn = r.rotation();
        let [x, y, m] = [0, 1, 2].map(|i| turn * Vec3::ith(i, 1.0));
        let at = m * r.within(-3.0, 3.0);
        (turn, x, y, m, at)
    }

    fn incremental_minimum<D: Difference>(
        md: &D,
        m: &Vec3,
        start: Vec3,
        settings: &Settings,
    ) -> Result<Solution, Stop> {
        super::super::incremental_minimum(md, start, Some(*m), Until::Shortcut, settings, |_| ())
    }

    fn solve<D: Difference>(md: &D, m: &Vec3, start: Vec3) -> Solution {
        let hit = incremental_minimum(md, m, start, &SETTINGS).unwrap();
        let ulps = 100.0 * EPSILON;
        assert_eq!(hit.status, Status::Converged);
        assert!(hit.dir.dot(m).abs() < ulps, "leaves the plane");
        assert!((hit.dir.norm() - 1.0).abs() < ulps);
        // The depth is sound, and the witness points are on the two support planes.
        let s = md.support(&hit.dir).unwrap();
        assert!((hit.dir.dot(&s.v) - hit.depth).abs() < ulps);
        let room = SETTINGS.tolerance + ulps;
        assert!((hit.dir.dot(&(hit.point1 - s.v1))).abs() <= room);
        assert!((hit.dir.dot(&(hit.point2 - s.v2))).abs() <= room);
        hit
    }

    /// Discs: the depth is r1 + r2 − distance, along the centers.
    #[test]
    fn discs() {
        let mut r = Random::new(1);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let angle = r.within(0.0, TAU);
            let way = x * angle.cos() + y * angle.sin();
            let distance = r.within(0.1, 1.4);
            let disc = |center: Vec3, radius: f64| {
                move |d: &Vec3| {
                    let flat = d - m * m.dot(d);
                    center + unit(&flat).map_or(Vec3::zeros(), |f| f * radius)
                }
            };
            let md = difference(disc(at, 1.0), disc(at + way * distance, 0.5));
            let angle = r.within(0.0, TAU);
            let hit = solve(&md, &m, x * angle.cos() + y * angle.sin());
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // The same from the stationary direction that is a maximum.
            let hit = solve(&md, &m, -way);
            let error = hit.depth - (1.5 - distance);
            assert!(
                (-100.0 * EPSILON..10.0 * SETTINGS.tolerance).contains(&error),
                "{error:e}"
            );
            // Started at the minimum, the result is exact.
            let hit = solve(&md, &m, way);
            assert!((hit.depth - (1.5 - distance)).abs() < 100.0 * EPSILON);
        }
    }

    /// Polygons: the depth is the support value of an edge of one of the two, and no
    /// nearby direction is lower; the least depth from all edges is the least support value of them.
    #[test]
    fn polygons() {
        let mut r = Random::new(2);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let mut polygon = |center: Vec3| {
                let n = 3 + (r.within(0.0, 5.0) as usize);
                (0..n)
                    .map(|i| {
                        let angle = (i as f64 + r.within(0.1, 0.9)) * TAU / n as f64;
                        center + x * angle.cos() + y * (0.6 * angle.sin())
                    })
                    .collect::<Vec<_>>()
            };
            let a = polygon(at);
            let b = polygon(at + x * 0.3 + y * 0.1);
            let md = difference(hull(&a), hull(&b));
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

    /// Squares with a gap of a hundredth: a direction in the plane separates them.
    #[test]
    fn separated_squares() {
        let mut r = Random::new(3);
        for _ in 0..300 {
            let (_, x, y, m, at) = frame(&mut r);
            let square = |c: Vec3| [c + x, c + y, c - x, c - y];
            let by = unit(&(x + y)).unwrap() * ((2.0 as f64).sqrt() + 0.01);
            let md = difference(hull(&square(at)), hull(&square(at + by)));
            let angle = r.within(0.0, TAU);
            let start = x * angle.cos() + y * angle.sin();
            match incremental_minimum(&md, &m, start, &SETTINGS) {
                Err(Stop::Separated(Direction { n, .. })) => {
                    assert!(n.dot(&m).abs() < 100.0 * EPSILON);
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                // A local minimum on the far side of the other square: the overlap is not proven here.
                Ok(hit) => assert!(hit.status == Status::Converged && hit.dir.dot(&by) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}
