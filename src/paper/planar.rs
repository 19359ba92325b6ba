// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The paper's method in the plane (n = 2 in Sec. II-A): the portal is a segment.
//!
//! For shapes that lie in a common plane, D lies in the plane through the origin with
//! the same normal m, and so do all directions asked for here. With
//! T(a, b) = m · (a × b), the segment from v1 to v2 is a portal of the ray d when d
//! lies between them: T(v1, d) ≥ 0 and T(d, v2) ≥ 0. Its outward normal is
//! (v2 − v1) × m. A new support point replaces the end on its own side of the ray.
//! The loop is that of [`crate::paper::incremental`], with the shortcut (Algorithms 4 and 5).

use crate::contact::{Answer, Penetration, Settings};
use crate::known::support::{Fault, MinkowskiDifference, SupportMap};
use crate::known::support_set::Stop;
use crate::math::{Real, Vec3, unit};
use crate::paper::portal::{SupportPlane, rounding};

/// Two support planes whose segment the ray crosses.
#[derive(Clone, Copy)]
struct Segment {
    left: SupportPlane,
    right: SupportPlane,
}

impl Segment {
    /// Where the segment meets the ray `d`, as points of obj1 and obj2.
    fn witnesses(&self, m: &Vec3, d: &Vec3) -> (Vec3, Vec3) {
        let (a, b) = (&self.left.point, &self.right.point);
        let s = m.dot(&a.v.cross(d)).max(0.0);
        let t = m.dot(&d.cross(&b.v)).max(0.0);
        let sum = s + t;
        if !(sum > 0.0) {
            return (a.v1, a.v2);
        }
        ((a.v1 * t + b.v1 * s) / sum, (a.v2 * t + b.v2 * s) / sum)
    }
}

/// A local minimum of the depth over the directions perpendicular to the unit vector
/// `m`, searched from the unit direction `start`, itself perpendicular to `m`.
///
/// # Errors
/// A callback's answer that is not finite.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    m: &Vec3,
    start: Vec3,
    settings: &Settings,
) -> Result<Answer, Fault> {
    let ray = SupportPlane::of(md, start)?;
    if ray.depth < 0.0 {
        return Ok(Answer::Miss(start));
    }
    let mut search = Search {
        md,
        m,
        settings,
        budget: settings.max_iterations,
        best: ray,
        aside: None,
    };
    match search.run(ray) {
        Ok(answer) => Ok(answer),
        Err(Stop::Apart(n)) => Ok(Answer::Miss(n)),
        Err(Stop::Fault(fault)) => Err(fault),
    }
}

/// A query on its way.
struct Search<'q, A, B> {
    md: &'q MinkowskiDifference<A, B>,
    m: &'q Vec3,
    settings: &'q Settings,
    /// Iterations that are left.
    budget: u64,
    /// The lowest support plane met.
    best: SupportPlane,
    /// The ray that was stepped aside from: stationary, its depth and witnesses exact.
    aside: Option<SupportPlane>,
}

/// What comes after a ray.
enum Next {
    Ray(SupportPlane),
    End(Answer),
}

impl<A: SupportMap, B: SupportMap> Search<'_, A, B> {
    /// From ray to ray.
    fn run(&mut self, mut ray: SupportPlane) -> Result<Answer, Stop> {
        while self.spend() {
            let side = self.m.cross(&ray.normal);
            let off = side.dot(&ray.point.v);
            if !(off.abs() > rounding(ray.point.magnitude())) {
                // The ray passes through its own support point: stationary, perhaps a
                // maximum. Step aside once, then take it.
                if let Some(first) = self.aside {
                    let lower = if first.depth < ray.depth { first } else { ray };
                    return Ok(Answer::Hit(self.answer(&lower)));
                }
                self.aside = Some(ray);
                let n = ray.normal + side * ASIDE;
                ray = self.plane(n / n.norm())?;
                continue;
            }
            // The end on the other side of the ray.
            let other = self.plane(side * -off.signum())?;
            // T(d, v) = side · v: the left end has a negative one, the right end a positive.
            let (left, right) = if off < 0.0 {
                (ray, other)
            } else {
                (other, ray)
            };
            match self.refine(&ray.normal, &side, Segment { left, right })? {
                Next::Ray(next) => ray = next,
                Next::End(answer) => return Ok(answer),
            }
        }
        Ok(Answer::Limit(self.answer(&self.best)))
    }

    /// Moves the segment outwards along the ray `d`, to its end or to a better ray. `side` is
    /// m × d.
    fn refine(&mut self, d: &Vec3, side: &Vec3, mut segment: Segment) -> Result<Next, Stop> {
        while self.spend() {
            let (a, b) = (segment.left.point.v, segment.right.point.v);
            let Some(n) = unit(&(b - a).cross(self.m)) else {
                // The two ends are on either side of the ray, so only an overflow comes here.
                break;
            };
            let plane = self.plane(n)?;
            let inner = n.dot(&a);
            let gap = plane.depth - inner;
            // Negated for NaN.
            if !(gap > rounding(plane.point.magnitude()))
                || (gap <= self.settings.tolerance && inner >= 0.0)
            {
                return Ok(self.ended(d, &segment, plane));
            }
            if plane.depth * n.dot(d) <= inner {
                return Ok(Next::Ray(plane));
            }
            if side.dot(&plane.point.v) < 0.0 {
                segment.left = plane;
            } else {
                segment.right = plane;
            }
        }
        Ok(Next::End(Answer::Limit(self.answer(&self.best))))
    }

    /// The ray `d` leaves D between the segment and the support plane: that is the answer
    /// where d is the plane's normal, within the tolerance, and no lower plane was met; else
    /// the lower of the two is the next ray.
    fn ended(&self, d: &Vec3, segment: &Segment, plane: SupportPlane) -> Next {
        let within = (self.settings.tolerance).max(rounding(plane.point.magnitude()));
        let stationary = plane.depth / plane.normal.dot(d) - plane.depth <= within;
        if self.best.depth < plane.depth - within {
            return Next::Ray(self.best);
        }
        if !stationary {
            return Next::Ray(plane);
        }
        let (point1, point2) = segment.witnesses(self.m, d);
        Next::End(Answer::Hit(match self.aside {
            Some(first) if first.depth <= plane.depth => self.answer(&first),
            _ => Penetration {
                point1,
                point2,
                ..self.answer(&plane)
            },
        }))
    }

    /// Counts an iteration, if one is left.
    fn spend(&mut self) -> bool {
        let left = self.budget > 0;
        self.budget = self.budget.saturating_sub(1);
        left
    }

    /// The support plane of unit `n`; the lowest is kept, and one that separates ends the
    /// search.
    fn plane(&mut self, n: Vec3) -> Result<SupportPlane, Stop> {
        let plane = SupportPlane::of(self.md, n)?;
        if plane.depth < 0.0 {
            return Err(Stop::Apart(n));
        }
        if plane.depth < self.best.depth {
            self.best = plane;
        }
        Ok(plane)
    }

    /// The answer of a support plane, with the points of its support point for witnesses.
    fn answer(&self, plane: &SupportPlane) -> Penetration {
        Penetration {
            depth: plane.depth,
            depth_lower: 0.0,
            dir: plane.normal,
            normal: plane.normal,
            point1: plane.point.v1,
            point2: plane.point.v2,
            pos: Vec3::zeros(),
            extent: [0.0; 2],
            iterations: self.settings.max_iterations - self.budget,
        }
    }
}

/// Tan of the angle of a step aside from a stationary direction.
const ASIDE: Real = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::EPSILON;
    use crate::shapes::{Random, Rotation, hull};

    const TAU: Real = core::f64::consts::TAU as Real;

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

    fn solve<A: SupportMap, B: SupportMap>(
        md: &MinkowskiDifference<A, B>,
        m: &Vec3,
        start: Vec3,
    ) -> Penetration {
        match penetration(md, m, start, &SETTINGS).unwrap() {
            Answer::Hit(hit) => {
                let ulps = 100.0 * EPSILON;
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
            other => panic!("{other:?}"),
        }
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
            let disc = |centre: Vec3, radius: Real| {
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
                        let angle = (i as Real + r.within(0.1, 0.9)) * TAU / n as Real;
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
            let least = edges.iter().fold(Real::INFINITY, |l, e| l.min(e.1));
            // Hulls of random polygons may overlap at a point only.
            if least < 1e-3 {
                continue;
            }
            let mut best = Real::INFINITY;
            for (start, _) in &edges {
                let hit = solve(&md, &m, unit(&(start + x * 0.05)).unwrap());
                let is = |e: Real| (e - hit.depth).abs() < 10.0 * SETTINGS.tolerance;
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
            let by = unit(&(x + y)).unwrap() * ((2.0 as Real).sqrt() + 0.01);
            let md = MinkowskiDifference::new(hull(&square(at)), hull(&square(at + by)));
            let angle = r.within(0.0, TAU);
            let start = x * angle.cos() + y * angle.sin();
            match penetration(&md, &m, start, &SETTINGS).unwrap() {
                Answer::Miss(n) => {
                    assert!(n.dot(&m).abs() < 100.0 * EPSILON);
                    assert!(n.dot(&md.support(&n).unwrap().v) < 0.0);
                }
                // A local minimum behind the other square: not yet a proven overlap.
                Answer::Hit(hit) => assert!(hit.dir.dot(&by) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}
