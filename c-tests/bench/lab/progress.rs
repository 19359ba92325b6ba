// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! What a run says of itself: progress while it lasts, the machine in its files.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::Command;

use indicatif::{ProgressBar, ProgressStyle};
use serde::{Serialize, de::DeserializeOwned};

use super::libraries::Libraries;

/// A progress bar on standard error.
pub fn bar(steps: u64, what: &str) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{prefix} [{elapsed_precise}] {wide_bar} {pos}/{len} {msg}")
            .expect("a fixed template");
    ProgressBar::new(steps)
        .with_style(style)
        .with_prefix(what.to_owned())
}

/// One line: libraries, processor, compiler and flags, date.
pub fn machine(libraries: &Libraries) -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|l| l.starts_with("model name"));
    let processor = line
        .and_then(|l| l.split_once(": "))
        .map_or("unknown processor", |l| l.1);
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let date = Command::new("date").args(["-u", "+%F"]).output().ok();
    let date = date
        .map(|d| String::from_utf8_lossy(&d.stdout).trim().to_owned())
        .unwrap_or_default();
    let version = Command::new("rustc").arg("--version").output().ok();
    let version = version
        .map(|d| String::from_utf8_lossy(&d.stdout).trim().to_owned())
        .unwrap_or_default();
    format!(
        "{date}, {processor}, {cores} cores; {} ({version}, release), beside {}; callbacks: {}",
        libraries.implementation, libraries.system_file, libraries.compiler
    )
}

/// The rows as CSV under one comment line, `origin`, that says where they come from.
pub fn write_csv<T: Serialize>(path: &Path, origin: &str, rows: &[T]) {
    let write = || -> Result<(), Box<dyn std::error::Error>> {
        let mut file = File::create(path)?;
        writeln!(file, "# {origin}")?;
        let mut csv = csv::Writer::from_writer(file);
        for row in rows {
            csv.serialize(row)?;
        }
        csv.flush()?;
        Ok(())
    };
    write().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// The comment line of such a file; empty where there is none.
pub fn origin(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    let line = text.lines().next().and_then(|l| l.strip_prefix("# "));
    line.unwrap_or_default().to_owned()
}

/// The rows of such a file; none where there is no file.
pub fn read_csv<T: DeserializeOwned>(path: &Path) -> Vec<T> {
    if !path.exists() {
        return Vec::new();
    }
    csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_path(path)
        .and_then(|mut r| r.deserialize().collect())
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}
