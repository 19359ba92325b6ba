// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's penetration depth: sequential quadratic programming over portal
//! refinement (Sec. III, Algorithms 3, 4 and 5).
//!
//! The depth is the least |v| over the boundary of D. At a boundary point with
//! outward normal n the constraint "outside D" is linearised by the support plane
//! of n, and the nearest point of that plane to the origin is z = h(n) n: so one
//! step goes from the ray d, which leaves D through a face of normal n
//! ([`Search::follow`]), to the ray n. Since the ray n leaves D at or before z,
//! |z| falls strictly from step to step until d and n agree within the tolerance:
//! |q| − |z| ≤ tolerance, q the point where the ray meets the last support plane.
//!
//! With the shortcut (Algorithms 4 and 5) the ray is left as soon as the plane
//! found is at least as near as the portal: |z| ≤ |p|. Then the ray d cannot end
//! nearer than |z|, and the argument holds unchanged.
//!
//! Departures from the published implementation. The answer is the plane (n, h(n))
//! of the least support value seen, not the ray: sound, at no support more. A ray
//! through its own support point is stationary, yet may be a maximum (a vertex of
//! D) or a saddle: the search steps aside once and goes on. Planes below the last
//! one, met on the way in another valley, are searched as well.

use crate::contact::{Penetration, Settings};
use crate::contacts::pressure;
use crate::known::support_set::Stop;
use crate::math::{Vec3, perpendicular};
use crate::minkowski::support::{MinkowskiDifference, SupportMap};
use crate::paper::portal::{Exit, Portal, Search, SupportPlane, Until, rounding};

/// A step aside from a stationary direction: tan of about 6°, small enough to stay
/// in the valley, large enough to see a slope. The two parts have no simple ratio,
/// so that no symmetry of a shape hides the slope.
const ASIDE: (f64, f64) = (0.093, 0.041);

/// A local minimum of the penetration depth, searched from the unit direction
/// `start`: Algorithm 3, or with [`Until::Shortcut`] Algorithms 4 and 5. `flat`: the unit normal of the
/// plane that D and `start` lie in, where there is one. `switched` is told |z| at each switch of the ray.
///
/// # Errors
/// [`Stop::Apart`]; a callback's answer that is not finite.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    start: Vec3,
    flat: Option<Vec3>,
    until: Until,
    settings: &Settings,
    switched: impl FnMut(f64),
) -> Result<Penetration, Stop> {
    let ray = SupportPlane::of(md, start)?;
    let mut search = Search {
        md,
        tolerance: settings.tolerance,
        until,
        flat,
        budget: settings.max_iterations,
        best: ray,
    };
    let ended = from_ray_to_ray(&mut search, ray, switched)?;
    Ok(Penetration {
        iterations: settings.max_iterations - search.budget,
        limit: ended.is_none(),
        ..ended.unwrap_or_else(|| answer(&search.best, None))
    })
}

/// The loop of Algorithm 3. `None`: a cap came first.
fn from_ray_to_ray<A: SupportMap, B: SupportMap>(
    search: &mut Search<'_, A, B>,
    mut ray: SupportPlane,
    mut switched: impl FnMut(f64),
) -> Result<Option<Penetration>, Stop> {
    // The ray that was stepped aside from: stationary, its depth and witnesses exact.
    let mut aside: Option<SupportPlane> = None;
    loop {
        let next = match search.follow(&ray)? {
            Exit::Touch => return Ok(Some(answer(&search.best, None))),
            Exit::Limit(_) => return Ok(None),
            Exit::Shortcut(plane) => plane,
            Exit::Vertex => match aside {
                None => {
                    aside = Some(ray);
                    let across = match search.flat {
                        Some(m) => m.cross(&ray.normal) * ASIDE.0,
                        None => {
                            let e1 = perpendicular(&ray.normal);
                            e1 * ASIDE.0 + ray.normal.cross(&e1) * ASIDE.1
                        }
                    };
                    let n = ray.normal + across;
                    ray = search.plane(n / n.norm())?;
                    // No switch: the depth may rise.
                    continue;
                }
                // Stationary again: as good as it gets, unless a plane seen on the
                // way lies in a lower valley.
                Some(_) if search.best.depth < ray.depth - search.tolerance => search.best,
                Some(first) => {
                    let lower = if first.depth < ray.depth { first } else { ray };
                    return Ok(Some(answer(&lower, None)));
                }
            },
            Exit::Converged(last, plane) => {
                let along = plane.normal.dot(&ray.normal);
                let floor = search.tolerance.max(rounding(plane.point.magnitude()));
                // |q| − |z|; NaN and a plane that holds the ray go on to the next
                // ray only while the best plane falls.
                let stationary = plane.depth / along - plane.depth <= floor;
                let lower_elsewhere = search.best.depth < plane.depth - floor;
                if stationary && !lower_elsewhere {
                    let mut hit = match &aside {
                        Some(first) if first.depth <= plane.depth => answer(first, None),
                        _ => answer(&plane, Some(&last)),
                    };
                    let points = last
                        .planes
                        .iter()
                        .map(|plane| [plane.point.v1, plane.point.v2]);
                    hit.extent = pressure::extent(points, [&hit.point1, &hit.point2]);
                    return Ok(Some(hit));
                }
                if lower_elsewhere { search.best } else { plane }
            }
        };
        if !search.spend() {
            return Ok(None);
        }
        switched(next.depth);
        ray = next;
    }
}

/// The answer of a support plane. The witness points are where its portal's ray crosses
/// the portal; without one, the two of its support point.
pub fn answer(plane: &SupportPlane, portal: Option<&Portal>) -> Penetration {
    let (point1, point2) = match portal {
        Some(p) => p.witnesses(),
        None => (plane.point.v1, plane.point.v2),
    };
    Penetration {
        depth: plane.depth,
        dir: plane.normal,
        normal: plane.normal,
        point1,
        point2,
        ..Penetration::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{EPSILON, unit};
    use crate::shapes::{Random, ball, capsule, corners, ellipsoid, hull, placed};

    const SETTINGS: Settings = Settings {
        tolerance: if EPSILON < 1e-10 { 1e-7 } else { 1e-5 },
        max_iterations: 20_000,
    };

    fn solve<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        start: Vec3,
        shortcut: Until,
        switched: impl FnMut(f64),
    ) -> Penetration {
        let hit = penetration(md, start, None, shortcut, &SETTINGS, switched).unwrap();
        assert!(!hit.limit);
        hit
    }

    /// An ellipsoid with semi-axes `radii` about `centre`, as a level set
    /// g(v) = Σ ((v − centre)ᵢ / radiiᵢ)² − 1, so that planes and rays are at hand.
    struct Explicit {
        radii: Vec3,
        centre: Vec3,
    }

    impl Explicit {
        /// Unit normal ∇g / |∇g| at a boundary point.
        fn normal(&self, v: &Vec3) -> Vec3 {
            let r2 = self.radii.component_mul(&self.radii);
            unit(&(v - self.centre).component_div(&r2)).unwrap()
        }

        /// Where the ray from the origin along `d` leaves: the root t > 0 of g(t d).
        fn exit(&self, d: &Vec3) -> Vec3 {
            let d_ = d.component_div(&self.radii);
            let c = self.centre.component_div(&self.radii);
            let (a, b) = (d_.dot(&d_), d_.dot(&c));
            d * ((b + (b * b - a * (c.dot(&c) - 1.0)).sqrt()) / a)
        }

        /// The paper's Algorithm 2 from the boundary point `v`: the plane at v, the
        /// origin's projection z on it, the boundary on the way to z. `each` sees |z|.
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

    /// Algorithm 2 about the origin: |z| never rises, and the fixed point is the end of
    /// the shortest axis, whose normal is that axis.
    #[test]
    fn algorithm_2_ends_on_the_shortest_axis() {
        let mut r = Random::new(1);
        for _ in 0..100 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                centre: Vec3::zeros(),
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

    /// Algorithm 2 off the centre: at the fixed point v is parallel to its own normal, and
    /// Algorithm 3, which knows the support mapping alone, takes the same steps to it.
    #[test]
    fn algorithm_3_takes_the_steps_of_algorithm_2() {
        let mut r = Random::new(2);
        let tolerance = 1e-10;
        for _ in 0..50 {
            let e = Explicit {
                radii: Vec3::new(r.within(0.5, 0.7), r.within(0.8, 1.0), r.within(1.1, 1.5)),
                centre: r.vector(0.2),
            };
            let v = e.sqp(e.exit(&r.direction()), |_| ());
            assert!(e.normal(&v).cross(&v).norm() < 1e4 * EPSILON);

            let support = ellipsoid(e.radii, crate::shapes::Rotation::identity(), e.centre);
            let md = MinkowskiDifference::new(support, |_: &Vec3| Vec3::zeros());
            let mut ray = SupportPlane::of(&md, r.direction()).unwrap();
            for _ in 0..20 {
                let normal = e.normal(&e.exit(&ray.normal));
                let mut search = Search {
                    md: &md,
                    tolerance,
                    until: Until::Normal,
                    flat: None,
                    budget: 2000,
                    best: ray,
                };
                match search.follow(&ray) {
                    Ok(Exit::Converged(_, plane)) => {
                        // A gap of tol leaves an angle of sqrt(tol) to the normal.
                        let error = (plane.normal - normal).norm();
                        let room = 4.0 * tolerance.max(64.0 * EPSILON).sqrt();
                        assert!(error < room, "{error:e}");
                        ray = plane;
                    }
                    _ => panic!("no portal"),
                }
            }
        }
    }

    /// Is no direction within 3 degrees lower by more than the tolerance?
    fn is_local_minimum<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        hit: &Penetration,
        r: &mut Random,
    ) -> bool {
        (0..50).all(|_| {
            let n = unit(&(hit.dir + r.vector(0.03))).unwrap();
            SupportPlane::of(md, n).unwrap().depth >= hit.depth - 10.0 * SETTINGS.tolerance
        })
    }

    /// Algorithm 3 and Algorithms 4, 5 end in a local minimum each; started near the
    /// minimum, in none that is higher. |z| falls strictly at each switch of the ray.
    #[test]
    fn with_and_without_the_shortcut() {
        let mut r = Random::new(3);
        let mut supports = [0; 2];
        for _ in 0..200 {
            let turn = r.rotation();
            let half = Vec3::from_fn(|_, _| r.within(0.3, 1.0));
            let (a, b) = (r.vector(0.5), r.vector(0.5));
            let cube = placed(&corners(half), &turn, r.vector(0.1));
            let md = MinkowskiDifference::new(hull(&cube), capsule(a, b, 0.3));
            let start = r.direction();
            for (i, shortcut) in [Until::Normal, Until::Shortcut].into_iter().enumerate() {
                let before = md.supports();
                let mut last = SupportPlane::of(&md, start).unwrap().depth;
                let hit = solve(&md, start, shortcut, |z| {
                    assert!(z < last, "{z} after {last}");
                    last = z;
                });
                supports[i] += md.supports() - before;
                assert!(is_local_minimum(&md, &hit, &mut r));
                let h = hit.normal.dot(&md.support(&hit.normal).unwrap().v);
                assert!((h - hit.depth).abs() < 32.0 * EPSILON);
                // From a degree beside it both come back to it, or lower.
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

    /// Started along its own support point at a maximum: the search steps aside.
    #[test]
    fn steps_aside_from_a_maximum() {
        // A ball on the axis of a capsule: 1.3 along the axis, 1.0 across it.
        let md = MinkowskiDifference::new(
            ball(Vec3::zeros(), 0.5),
            capsule(Vec3::z() * -0.5, Vec3::z() * 0.5, 0.5),
        );
        let shifted = MinkowskiDifference::new(
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
        let md = MinkowskiDifference::new(hull(&points), hull(&points));
        // Of the icosahedron with edge 2: the distance between two opposite faces.
        let inradius = (3.0 as f64).sqrt() * (3.0 + (5.0 as f64).sqrt()) / 6.0;
        for v in &points {
            let hit = solve(&md, unit(v).unwrap(), Until::Shortcut, |_| ());
            assert!((hit.depth - 2.0 * inradius).abs() <= 1e-5, "{}", hit.depth);
        }
    }

    /// A box on itself: any of three faces is a local minimum, no less and no more.
    #[test]
    fn a_box_on_itself() {
        let cube = corners(Vec3::new(0.5, 0.4, 0.3));
        let md = MinkowskiDifference::new(hull(&cube), hull(&cube));
        let mut r = Random::new(5);
        for _ in 0..100 {
            let hit = solve(&md, r.direction(), Until::Shortcut, |_| ());
            let face = [1.0, 0.8, 0.6].map(|d| (hit.depth - d).abs() < 1e-6);
            assert!(face.contains(&true), "{}", hit.depth);
        }
    }

    /// The cap on iterations: a sound answer whatever it is, and it is told.
    #[test]
    fn the_cap_is_told() {
        let mut r = Random::new(6);
        for max_iterations in 0..30 {
            let centre = r.vector(0.3);
            let md = MinkowskiDifference::new(ball(centre, 0.5), ball(Vec3::zeros(), 0.4));
            let settings = Settings {
                max_iterations,
                tolerance: 1e-9,
            };
            let start = r.direction();
            let hit = penetration(&md, start, None, Until::Shortcut, &settings, |_| ()).unwrap();
            assert!(hit.limit && hit.iterations <= max_iterations);
            let h = hit.dir.dot(&md.support(&hit.dir).unwrap().v);
            assert!((h - hit.depth).abs() <= 8.0 * EPSILON);
            let apart = (hit.point1 - hit.point2).dot(&hit.dir);
            assert!((apart - hit.depth).abs() <= 8.0 * EPSILON);
        }
    }
}
