// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Shows the progress of a run.

use indicatif::{ProgressIterator, ProgressStyle};

/// The items one by one, with a bar on standard error.
pub fn over<'a, T>(items: &'a [T], what: &str) -> impl Iterator<Item = &'a T> + use<'a, T> {
    let template = format!("{what} [{{elapsed_precise}}] {{wide_bar}} {{pos}}/{{len}}");
    let style = ProgressStyle::with_template(&template).expect("a template");
    items.iter().progress_with_style(style)
}
