// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! No more model than a scene needs: how far an icosphere is off the ball that it models, in
//! the poses against a capsule that the pair sets of both have.

use std::collections::HashMap;

use ccd::internals::ffi::ccd_vec3_t;
use serde::{Deserialize, Serialize};

use super::Bench;
use super::paper::VERTICES;
use crate::measuring::measure;
use crate::measuring::scene::{Pair, Scene};

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Model {
    pub vertices: usize,
    pub poses: usize,
    /// Mean of the ball's depth less the model's, metres: both are certified.
    pub off: f64,
}

pub fn measure(bench: &Bench) -> Vec<Model> {
    // Where the capsule is tells a pose.
    let place = |pair: &Pair| {
        let mut at = ccd_vec3_t::default();
        // SAFETY: a shape of a scene, and room for a point.
        unsafe { (bench.libraries.callbacks.center)(pair.b, &mut at) };
        at.v.map(f64::to_bits)
    };
    let ball = Scene::load(bench.libraries, "sph_cap", usize::MAX);
    let depths = ball
        .pairs
        .iter()
        .map(|pair| (place(pair), pair.truth.depth));
    let depths: HashMap<_, _> = depths.collect();
    let model = |vertices: usize| {
        let scene = Scene::load(bench.libraries, &format!("p{vertices}_cap"), usize::MAX);
        let off = |pair: &Pair| Some(depths.get(&place(pair))? - pair.truth.depth);
        let off: Vec<f64> = scene.pairs.iter().filter_map(off).collect();
        Model {
            vertices,
            poses: off.len(),
            off: measure::mean(&off),
        }
    };
    VERTICES.map(model).into()
}
