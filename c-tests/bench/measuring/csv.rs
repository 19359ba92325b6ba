// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Files of figures: a line of `#` that says where they come from, then CSV. Numbers are the shortest that are exact.

use std::fs;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Writes rows under a comment line, `origin`, that says where they come from.
pub fn write<T: Serialize>(path: &Path, origin: &str, rows: &[T]) {
    let mut writer = csv::Writer::from_writer(format!("# {origin}\n").into_bytes());
    let lines = rows.iter().try_for_each(|row| writer.serialize(row));
    lines.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let text = writer.into_inner().expect("memory has room");
    fs::write(path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// Returns the comment line and the rows of a file; none if there is no file. Panics if a cell is none of its field's
/// values.
pub fn read<T: DeserializeOwned>(path: &Path) -> (String, Vec<T>) {
    let text = fs::read_to_string(path).unwrap_or_default();
    let origin = text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap_or_default();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let rows: Result<Vec<T>, csv::Error> = reader.deserialize().collect();
    (origin.to_owned(), rows.unwrap_or_else(|e| panic!("{}: {e}", path.display())))
}
