// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Structs as lines of a file: lines of `#` that say where it comes from, a line of the
//! fields' names, a line a struct, with commas between. A cell that holds a comma stands
//! in quotation marks.

use std::fs;
use std::path::Path;

/// A value in a line.
pub trait Cell: Sized {
    fn show(&self) -> String;
    fn parse(cell: &str) -> Option<Self>;
}

impl Cell for String {
    fn show(&self) -> String {
        self.clone()
    }
    fn parse(cell: &str) -> Option<Self> {
        Some(cell.to_owned())
    }
}

macro_rules! cell {
    ($($number:ty)*) => {$(
        impl Cell for $number {
            // As short as it can be read again to the bit.
            fn show(&self) -> String {
                format!("{self:?}")
            }
            fn parse(cell: &str) -> Option<Self> {
                cell.parse().ok()
            }
        }
    )*};
}
cell! { f64 usize bool }

/// An empty cell is none.
impl<T: Cell> Cell for Option<T> {
    fn show(&self) -> String {
        self.as_ref().map(T::show).unwrap_or_default()
    }
    fn parse(cell: &str) -> Option<Self> {
        if cell.is_empty() {
            Some(None)
        } else {
            T::parse(cell).map(Some)
        }
    }
}

/// A struct whose fields are a file's columns.
pub trait Line: Sized {
    const COLUMNS: &'static [&'static str];
    fn cells(&self) -> Vec<String>;
    /// None where a cell is missing or is none of its field's values.
    fn of<'a>(cells: impl Iterator<Item = &'a str>) -> Option<Self>;
}

/// Makes a struct of cells a [`Line`].
macro_rules! table {
    ($(#[$about:meta])* pub struct $Name:ident {
        $($(#[$what:meta])* pub $field:ident: $Type:ty,)*
    }) => {
        $(#[$about])*
        pub struct $Name {
            $($(#[$what])* pub $field: $Type,)*
        }
        impl $crate::lab::csv::Line for $Name {
            const COLUMNS: &'static [&'static str] = &[$(stringify!($field)),*];
            fn cells(&self) -> Vec<String> {
                vec![$($crate::lab::csv::Cell::show(&self.$field)),*]
            }
            fn of<'a>(mut cells: impl Iterator<Item = &'a str>) -> Option<Self> {
                Some(Self { $($field: $crate::lab::csv::Cell::parse(cells.next()?)?,)* })
            }
        }
    };
}
pub(crate) use table;

/// The rows under one comment line, `origin`, that says where they come from.
pub fn write<T: Line>(path: &Path, origin: &str, rows: &[T]) {
    let quoted = |cell: String| {
        if cell.contains(',') {
            format!("\"{cell}\"")
        } else {
            cell
        }
    };
    let mut text = format!("# {origin}\n{}\n", T::COLUMNS.join(","));
    for row in rows {
        let cells: Vec<String> = row.cells().into_iter().map(quoted).collect();
        text += &cells.join(",");
        text.push('\n');
    }
    fs::write(path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// The comment line of such a file; empty where there is none.
pub fn origin(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    let line = text.lines().next().and_then(|l| l.strip_prefix("# "));
    line.unwrap_or_default().to_owned()
}

/// The rows of such a file; none where there is no file. Panics where the columns are
/// others, or a cell is none of its field's values.
pub fn read<T: Line>(path: &Path) -> Vec<T> {
    let Ok(text) = fs::read_to_string(path) else {
        return Vec::new();
    };
    let mut lines = text.lines().filter(|l| !l.starts_with('#'));
    let head = lines.next().unwrap_or_default();
    assert_eq!(head, T::COLUMNS.join(","), "{}", path.display());
    let row = |line: &str| {
        // What stands between quotation marks, every other piece, is one cell's.
        let pieces: Vec<String> = (line.split('"').enumerate())
            .map(|(k, piece)| {
                if k % 2 == 1 {
                    piece.replace(',', "\0")
                } else {
                    piece.to_owned()
                }
            })
            .collect();
        let cells: Vec<String> = (pieces.concat().split(','))
            .map(|cell| cell.replace('\0', ","))
            .collect();
        let whole = cells.len() == T::COLUMNS.len();
        let read = T::of(cells.iter().map(String::as_str)).filter(|_| whole);
        read.unwrap_or_else(|| panic!("{}: {line}", path.display()))
    };
    lines.filter(|l| !l.is_empty()).map(row).collect()
}

#[cfg(test)]
mod tests {
    table! {
        #[derive(Debug, PartialEq)]
        pub struct One {
            pub name: String,
            pub size: Option<f64>,
            pub good: bool,
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let one = |name: &str, size| One {
            name: name.to_owned(),
            size,
            good: size.is_some(),
        };
        let rows = [one("a, b", Some(1e-6)), one("", None), one("°", Some(0.1))];
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        super::write(file.path(), "here", &rows);
        assert_eq!(super::read::<One>(file.path()), rows);
        assert_eq!(super::origin(file.path()), "here");
    }
}
