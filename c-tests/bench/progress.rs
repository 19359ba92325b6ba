// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a run shows while it lasts.

use indicatif::{ProgressBar, ProgressStyle};

/// A progress bar on standard error.
pub fn bar(steps: u64, what: &str) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{prefix} [{elapsed_precise}] {wide_bar} {pos}/{len} {msg}")
            .expect("a fixed template");
    ProgressBar::new(steps)
        .with_style(style)
        .with_prefix(what.to_owned())
}
