// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A small world: a box, a capsule and a pyramid fall on a table. One warm state for each pair.

use ccd::{Contact, DistanceOptions, ManifoldCache, Real, Settings, Shape, Warm};

/// Points, swept along x, y, z by `half`: the core; with a ball of `radius` around it.
struct Body {
    pos: [Real; 3],
    half: [Real; 3],
    radius: Real,
    speed: Real,
    points: Vec<[Real; 3]>,
}

impl Body {
    fn new(pos: [Real; 3], half: [Real; 3], radius: Real, points: &[[Real; 3]]) -> Self {
        Body { pos, half, radius, speed: 0.0, points: points.to_vec() }
    }
}

impl Shape for Body {
    fn support(&self, dir: [Real; 3]) -> [Real; 3] {
        let along = |p: &[Real; 3]| (0..3).map(|i| p[i] * dir[i]).sum::<Real>();
        let mut best = self.points[0];
        for p in &self.points {
            if along(p) > along(&best) {
                best = *p;
            }
        }
        std::array::from_fn(|i| self.pos[i] + best[i] + self.half[i].copysign(dir[i]))
    }
}

fn main() -> Result<(), ccd::Error> {
    let core = [[0.0; 3]];
    let pyramid = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bodies = [
        Body::new([0.0, 0.0, -1.0], [3.0, 3.0, 1.0], 0.0, &core), // the table
        Body::new([-1.0, 0.0, 2.0], [0.5, 0.5, 0.25], 0.0, &core),
        Body::new([1.0, 0.0, 2.0], [0.0, 0.5, 0.0], 0.25, &core),
        Body::new([1.0, 2.0, 3.0], [0.0; 3], 0.0, &pyramid),
    ];
    let mut states = [[(Warm::default(), ManifoldCache::default()); 4]; 4];
    for frame in 0..60 {
        let (mut count, mut closest) = (0, Real::INFINITY);
        for body in &mut bodies[1..] {
            body.speed -= 9.81 / 60.0;
            body.pos[2] += body.speed / 60.0;
        }
        for i in 0..bodies.len() {
            for j in i + 1..bodies.len() {
                let (warm, cache) = &mut states[i][j];
                let (a, b) = (&bodies[i], &bodies[j]);
                let margins = DistanceOptions { margin1: a.radius, margin2: b.radius, ..DistanceOptions::default() };
                let d = ccd::signed_distance(a, b, &Settings::new(1e-5), &margins, Some(warm))?;
                if d.distance_upper > 0.0 {
                    closest = closest.min(d.distance); // between d.point1 and d.point2
                    continue;
                }
                let mut room = [Contact::default(); 4]; // of the cores
                count += ccd::contacts(a, b, d.normal, 1e-3, Some(cache), &mut room)?.len();
                // In place of a contact solver.
                let b = &mut bodies[j];
                b.pos = std::array::from_fn(|k| b.pos[k] - d.distance * d.normal[k]);
                b.speed = 0.0;
            }
        }
        if frame % 10 == 9 {
            println!("frame {frame}: {count} contacts, other pairs are {closest:.2} m apart");
        }
    }
    Ok(())
}
