// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The tests that run before a release (`release.sh`), in one program: `cargo test -p lab MODULE::` runs one module's.

#[path = "../tests/extension/api.rs"]
mod api;
#[path = "../harness/mod.rs"]
mod harness;
#[path = "../tests/packaging/install.rs"]
mod install;
#[cfg(not(feature = "single"))]
#[path = "../bench/measuring/mod.rs"]
mod measuring;

// The benchmark's parts, of which its test uses some.
#[cfg(not(feature = "single"))]
#[allow(dead_code)]
mod charts;
#[cfg(not(feature = "single"))]
#[path = "charts/test.rs"]
mod charts_test;
#[cfg(not(feature = "single"))]
mod compare;
#[cfg(not(feature = "single"))]
mod engines;
mod fcl;
mod miri;
mod packaging;
#[cfg(not(feature = "single"))]
#[allow(dead_code)]
mod pages;
#[cfg(not(feature = "single"))]
#[allow(dead_code)]
mod paper;
#[cfg(not(feature = "single"))]
#[path = "paper/test.rs"]
mod paper_test;
#[cfg(not(feature = "single"))]
#[path = "engines/simulations.rs"]
mod simulations;
