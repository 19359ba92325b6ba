// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Files of figures: a line of `#` that says where they come from, then CSV. Numbers are as
//! short as they can be read again to the bit.

use std::fs;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// The rows under one comment line, `origin`, that says where they come from.
pub fn write<T: Serialize>(path: &Path, origin: &str, rows: &[T]) {
    let mut writer = csv::Writer::from_writer(format!("# {origin}\n").into_bytes());
    let lines = rows.iter().try_for_each(|row| writer.serialize(row));
    lines.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let text = writer.into_inner().expect("memory has room");
    fs::write(path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// The comment line of such a file; empty where there is none.
pub fn origin(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    let line = text.lines().next().and_then(|l| l.strip_prefix("# "));
    line.unwrap_or_default().to_owned()
}

/// The rows of such a file; none where there is no file. Panics where a column is missing, or a
/// cell is none of its field's values.
pub fn read<T: DeserializeOwned>(path: &Path) -> Vec<T> {
    fs::read_to_string(path).map_or(Vec::new(), |text| rows(&text))
}

/// The rows of a text.
pub fn rows<T: DeserializeOwned>(text: &str) -> Vec<T> {
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.comment(Some(b'#')).from_reader(text.as_bytes());
    let rows: Result<Vec<T>, csv::Error> = reader.deserialize().collect();
    rows.unwrap_or_else(|e| panic!("{e} in {text:.200}"))
}
