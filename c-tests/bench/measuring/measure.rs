// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Runs methods over a scene, judges their answers by the truth, and measures their cost.
//!
//! Support points and errors are exact and repeatable. (Times: `lab/charts/times.rs`.)

use std::vec;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::callgrind::{self, Count};
use super::libraries::Libraries;
use super::methods::{Answer, Method, Place, Start};
use super::scene::{Pair, Scene};

/// One method on one scene. Lengths in metres. A file may lack columns of newer measurements.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Row {
    pub set: String,
    pub method: String,
    pub start: Start,
    pub tolerance: Option<f64>,
    pub ours: bool,
    pub queries: usize,
    /// Of these, overlaps deeper than 1 nm: the ones that are judged.
    pub overlaps: usize,
    /// Support points of the Minkowski difference per query.
    pub supports: f64,
    /// Mean time of a query, of medians over repetitions.
    pub ns: Option<f64>,
    /// Instructions of a query in the support functions, and in the solver.
    pub callbacks: Option<f64>,
    pub solver: Option<f64>,
    /// Mispredicted branches of a query in both.
    pub mispredictions: Option<f64>,
    /// |depth - truth| over all overlaps; one that is missed counts as depth 0.
    pub mean_error: f64,
    pub median_error: f64,
    pub max_error: f64,
    /// Mean over the answers within 1 mm of the truth.
    pub mean_error_1mm: f64,
    /// Percent of the overlaps: depths that are not within 1 mm of the truth, or missing.
    pub beyond_1mm: f64,
    /// Of these, answers more than 1 mm too deep.
    pub nonminimal: f64,
    /// No hit, or a failure.
    pub missed: f64,
    /// Depths more than 1 % and two tolerances above, or below, the least.
    pub deep: f64,
    pub shallow: f64,
    /// Directions along which the depth is so much more than the least.
    pub wrong_direction: f64,
    /// Any of the last four.
    pub wrong: f64,
    /// Angle between dir and the true direction, milliradians, over all answers: mean, root of the mean square, 99 %, largest;
    /// none where the truth has no direction.
    pub direction_mean: Option<f64>,
    pub direction_rms: Option<f64>,
    pub direction_p99: Option<f64>,
    pub direction_max: Option<f64>,
    /// Mean over the answers whose depth is within 1 mm of the truth.
    pub direction_mean_1mm: Option<f64>,
    /// Of motions, milliradians a frame: the root of the mean square of the change of dir less the true change; and that of
    /// the true change alone.
    pub jitter: Option<f64>,
    pub true_turn: Option<f64>,
    /// Largest h(dir) - depth: overlap that may be left after the move.
    pub unsound: f64,
    /// Widest uncertainty of the truth itself.
    pub truth_gap: f64,
}

impl Row {
    /// Returns the method and its start, as in tables and pictures.
    pub fn label(&self) -> String {
        let start = match self.start {
            Start::None => "",
            Start::Guess5 => ", guess 5° off",
            Start::Guess25 => ", guess 25° off",
            Start::Guess45 => ", guess 45° off",
            Start::Cold => ", cold",
            Start::Warm => ", warm",
        };
        format!("{}{start}", self.method)
    }

    /// Returns all instructions of a query.
    pub fn instructions(&self) -> f64 {
        self.callbacks.unwrap_or_default() + self.solver.unwrap_or_default()
    }
}

/// Measures the mean time of a query of each method, ns.
pub type Times = Box<dyn Fn(&Scene, &mut [Method]) -> Vec<f64>>;

/// The one runner of all measurements.
pub struct Runner<'a> {
    pub libraries: &'a Libraries,
    /// None: no times.
    pub times: Option<Times>,
    /// Instructions are counted on every n-th pair.
    every: usize,
    /// Counts in the order of the methods, if instructions are counted.
    counts: Option<vec::IntoIter<Count>>,
}

impl<'a> Runner<'a> {
    pub fn new(libraries: &'a Libraries) -> Self {
        Self { libraries, times: None, every: 1, counts: None }
    }

    /// Also counts instructions on every n-th pair, for which it runs this program under callgrind with the words of a
    /// command that measures the same. Returns why it cannot.
    pub fn with_instructions(mut self, every: usize, command: &[&str]) -> Result<Self, String> {
        self.every = every;
        if !callgrind::is_counting() {
            self.counts = Some(callgrind::counts(command)?.into_iter());
        }
        Ok(self)
    }

    /// Measures methods on a scene; returns no rows in the process under callgrind, which only runs them.
    pub fn rows(&mut self, scene: &Scene, mut methods: Vec<Method>) -> Vec<Row> {
        if callgrind::is_counting() {
            methods.iter_mut().for_each(|method| callgrind::count(self.libraries, scene, method, self.every));
            return Vec::new();
        }
        let times = self.times.as_ref().map(|times| times(scene, &mut methods));
        let mut times = times.into_iter().flatten();
        let row = |method: &mut Method| {
            let mut row = judge(self.libraries, scene, method);
            row.ns = times.next();
            if let Some(counts) = &mut self.counts {
                let count = counts.next().expect("a count for every method");
                assert!(count.callbacks.instructions > 0, "callgrind counted nothing of {}", row.method);
                let pairs = scene.pairs.iter().step_by(self.every);
                let queries = pairs.filter(|pair| method.is_measured(pair)).count() as f64;
                let mut solver = count.solver;
                if matches!(method.entry.place, Place::PeerInside) {
                    solver += count.program;
                }
                row.callbacks = Some(count.callbacks.instructions as f64 / queries);
                row.solver = Some(solver.instructions as f64 / queries);
                let mispredictions = solver.mispredictions + count.callbacks.mispredictions;
                row.mispredictions = Some(mispredictions as f64 / queries);
            }
            row
        };
        methods.iter_mut().map(row).collect()
    }
}

/// Returns the support value of the Minkowski difference along `dir`.
pub fn support_value(libraries: &Libraries, pair: &Pair, dir: Vector3<f64>) -> f64 {
    let support = |shape, dir: Vector3<f64>| Vector3::from(libraries.callbacks.support_point(shape, dir.into()));
    dir.dot(&(support(pair.a, dir) - support(pair.b, -dir)))
}

/// Angles between the directions of answers and the true ones, milliradians.
#[derive(Default)]
struct Directions {
    angles: Vec<f64>,
    angles_1mm: Vec<f64>,
    /// Squares of the jitter and of the true change, a frame.
    jitter2: Vec<f64>,
    turn2: Vec<f64>,
    /// Answer and truth of the frame before.
    last: Option<[Vector3<f64>; 2]>,
}

impl Directions {
    /// Adds an answer, or none for a frame without one.
    fn add(&mut self, pair: &Pair, answer: Option<(Vector3<f64>, bool)>) {
        const MILLI: f64 = 1e3;
        let truth = Vector3::from(pair.truth.normal);
        let Some((dir, is_near)) = answer.filter(|_| truth.norm() > 0.5) else {
            self.last = None;
            return;
        };
        // Exact for small angles too.
        let angle = MILLI * 2.0 * (0.5 * (dir - truth).norm()).min(1.0).asin();
        self.angles.push(angle);
        if is_near {
            self.angles_1mm.push(angle);
        }
        if let Some([last_dir, last_truth]) = self.last.filter(|_| pair.frame > 0) {
            let turn = truth - last_truth;
            self.jitter2.push((MILLI * (dir - last_dir - turn).norm()).powi(2));
            self.turn2.push((MILLI * turn.norm()).powi(2));
        }
        self.last = Some([dir, truth]);
    }

    fn write(mut self, row: &mut Row) {
        let of = |values: &[f64], f: fn(&[f64]) -> f64| (!values.is_empty()).then(|| f(values));
        let rms = |squares: &[f64]| mean(squares).sqrt();
        self.angles.sort_unstable_by(f64::total_cmp);
        let squares: Vec<f64> = self.angles.iter().map(|a| a * a).collect();
        row.direction_mean = of(&self.angles, mean);
        row.direction_rms = of(&squares, rms);
        row.direction_p99 = of(&self.angles, |a| a[(99 * a.len()).div_ceil(100) - 1]);
        row.direction_max = self.angles.last().copied();
        row.direction_mean_1mm = of(&self.angles_1mm, mean);
        row.jitter = of(&self.jitter2, rms);
        row.true_turn = of(&self.turn2, rms);
    }
}

/// Returns the mean; 0 of none.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Returns the larger number; NaN if one is.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// Tolerance by which methods are judged whose own is built in.
const DEFAULT_TOLERANCE: f64 = 1e-6;

/// Runs the method over the scene and judges every answer. A warm method's first frame of each motion has no memory yet
/// and is left out.
fn judge(libraries: &Libraries, scene: &Scene, method: &mut Method) -> Row {
    let calls = |pair: &Pair| {
        // SAFETY: shapes of the scene.
        unsafe { (libraries.callbacks.calls)(pair.a) + (libraries.callbacks.calls)(pair.b) }
    };
    let mut row = Row {
        set: scene.name.clone(),
        method: method.entry.name.to_owned(),
        start: method.start,
        tolerance: method.tolerance,
        ours: method.entry.is_ours(),
        ..Row::default()
    };
    let margin = 2.0 * method.tolerance.unwrap_or(DEFAULT_TOLERANCE);
    let (mut errors, mut near, mut num_calls) = (vec![], vec![], 0);
    let mut directions = Directions::default();
    for pair in &scene.pairs {
        let before = calls(pair);
        let answer = (method.query)(pair);
        let after = calls(pair);
        if !method.is_measured(pair) {
            continue;
        }
        row.queries += 1;
        num_calls += after - before;
        row.truth_gap = row.truth_gap.max(pair.truth.gap);
        // Pairs apart or touching are queried, not judged.
        let truth = pair.truth.depth;
        if truth <= 1e-9 {
            directions.add(pair, None);
            continue;
        }
        row.overlaps += 1;
        let Some(Answer { depth, dir }) = answer else {
            directions.add(pair, None);
            // As if the depth had been 0.
            errors.push(truth);
            row.missed += 1.0;
            row.wrong += 1.0;
            continue;
        };
        let error = (depth - truth).abs();
        errors.push(error);
        directions.add(pair, Some((Vector3::from(dir).normalize(), error <= 1e-3)));
        row.unsound = larger(row.unsound, support_value(libraries, pair, dir.into()) - depth);
        if error <= 1e-3 {
            near.push(error);
        }
        // NaN counts as too deep.
        row.nonminimal += f64::from(depth - truth > 1e-3 || depth.is_nan());
        let is_deep = |depth: f64| depth > 1.01 * truth + margin || depth.is_nan();
        let faults = [
            is_deep(depth),
            depth < 0.99 * truth - margin,
            is_deep(support_value(libraries, pair, Vector3::from(dir).normalize())),
        ];
        row.deep += f64::from(faults[0]);
        row.shallow += f64::from(faults[1]);
        row.wrong_direction += f64::from(faults[2]);
        row.wrong += f64::from(faults.contains(&true));
    }
    for count in [
        &mut row.nonminimal,
        &mut row.missed,
        &mut row.deep,
        &mut row.shallow,
        &mut row.wrong_direction,
        &mut row.wrong,
    ] {
        *count = 100.0 * *count / row.overlaps.max(1) as f64;
    }
    row.supports = num_calls as f64 / 2.0 / row.queries as f64;
    row.mean_error = mean(&errors);
    errors.sort_unstable_by(f64::total_cmp);
    row.median_error = errors.get(errors.len() / 2).copied().unwrap_or_default();
    row.max_error = errors.into_iter().fold(0.0, larger);
    row.mean_error_1mm = mean(&near);
    row.beyond_1mm = 100.0 * (row.overlaps - near.len()) as f64 / row.overlaps.max(1) as f64;
    directions.write(&mut row);
    row
}

#[cfg(test)]
mod tests {
    /// A truth that turns by 1 mrad a frame, and answers that are 3 mrad off: always to the same side, or by turns to either.
    #[test]
    fn directions_and_jitter() {
        use super::*;
        use crate::measuring::scene::Truth;
        let unit = |mrad: f64| Vector3::new((1e-3 * mrad).sin(), (1e-3 * mrad).cos(), 0.0);
        let measured = |off: fn(usize) -> f64| {
            let (mut row, mut directions) = (Row::default(), Directions::default());
            for frame in 0..200 {
                let truth = Truth { normal: unit(frame as f64).into(), ..Truth::default() };
                let pair = Pair { a: std::ptr::null_mut(), b: std::ptr::null_mut(), truth, motion: 0, frame };
                directions.add(&pair, Some((unit(frame as f64 + off(frame)), true)));
            }
            directions.write(&mut row);
            [row.direction_rms, row.direction_p99, row.direction_max, row.jitter, row.true_turn]
                .map(|x| x.expect("measured"))
        };
        let is_near = |a: [f64; 5], b: [f64; 5]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.01);
        let steady = measured(|_| 3.0);
        assert!(is_near(steady, [3.0, 3.0, 3.0, 0.0, 1.0]), "{steady:?}");
        let restless = measured(|frame| if frame % 2 == 0 { 3.0 } else { -3.0 });
        assert!(is_near(restless, [3.0, 3.0, 3.0, 6.0, 1.0]), "{restless:?}");
        let once = measured(|frame| if frame == 100 { 50.0 } else { 0.0 });
        assert!(is_near([once[1], once[2], 0.0, 0.0, once[4]], [0.0, 50.0, 0.0, 0.0, 1.0]), "{once:?}");
    }
}
