// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tolerances of the paper's algorithms and of EPA, which the paper does not state: "parameters are tuned such that all
//! algorithms have roughly the same accuracy". Here those at which the errors are closest to the paper's Table I: the mean of the
//! paper's algorithm; the median of EPA, which fails on a twentieth of the curved pairs here.

use super::poses::Poses;
use super::primitives::{PAIRS, STARTS};
use super::table1::PUBLISHED;
use super::{ALGORITHM_4_5, EPA, Evaluation};
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::Start;
use crate::measuring::scene::Scene;

#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Metres.
    pub gao: f64,
    /// Square metres.
    pub epa: f64,
    /// This library's calls, metres: the accuracy of the others.
    pub ours: f64,
}

/// Poses that decide.
const NUM_POSES: usize = 500;

impl Tolerances {
    pub fn find(libraries: &Libraries, poses: &[Poses]) -> Self {
        let gao = PUBLISHED.map(|row| row[..3].to_vec()).concat();
        let epa = PUBLISHED.map(|row| row[3]);
        Self {
            gao: closest(libraries, poses, (ALGORITHM_4_5, &STARTS), |row| row.mean_error_1mm, &gao, -7..=-5),
            epa: closest(libraries, poses, (EPA, &[Start::None]), |row| row.median_error, &epa, -12..=-10),
            ours: 1e-6,
        }
    }
}

/// Returns the one of 1, 2 and 5 times these powers of ten whose errors of the pairs and starts are closest to these, µm, by
/// their geometric means.
fn closest(
    libraries: &Libraries,
    poses: &[Poses],
    (method, starts): (&'static str, &[Start]),
    error: fn(&Row) -> f64,
    published: &[f64],
    powers: std::ops::RangeInclusive<i32>,
) -> f64 {
    let mean_log = |errors: &[f64]| errors.iter().map(|e| e.ln()).sum::<f64>() / errors.len() as f64;
    let away = |tolerance: f64| {
        let tolerances = Tolerances { gao: tolerance, epa: tolerance, ours: tolerance };
        let evaluation = Evaluation { libraries, repetitions: 1, tolerances };
        let list: Vec<_> = starts.iter().map(|start| (method, *start)).collect();
        let errors = poses.iter().flat_map(|poses| {
            let first = poses.scene.pairs.iter().take(NUM_POSES).copied().collect();
            let scene = Scene { name: String::new(), pairs: first };
            Runner::new(libraries).rows(&scene, evaluation.methods(&list))
        });
        let errors: Vec<f64> = errors.map(|row| 1e6 * error(&row)).collect();
        (mean_log(&errors) - mean_log(published)).abs()
    };
    let tolerances = powers.flat_map(|k| [1.0, 2.0, 5.0].map(|f| f * 10_f64.powi(k)));
    tolerances.map(|t| (away(t), t)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("some").1
}

/// Says at which tolerances rows were measured.
pub fn sentence(rows: &[Row]) -> String {
    let of = |method: &str, start| super::find(rows, PAIRS[0].0, method, start).tolerance.unwrap_or_default();
    format!(
        "Algorithm 4/5 and 3 at {:.0e} m, EPA at {:.0e} m² (libccd compares squares with it), this library's calls at {:.0e} m; \
         {} poses a row.",
        of(ALGORITHM_4_5, Start::Guess5),
        of(EPA, Start::None),
        of("ccdMPRPenetration", Start::None),
        rows[0].queries
    )
}
