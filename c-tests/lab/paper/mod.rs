// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The evaluation of the paper, W. Gao, "Efficient Incremental Penetration Depth Estimation between Convex Geometries", 2023,
//! Section IV, measured again: a file for each table and figure, the methods by the paper's names, and beside them this
//! library's calls. `cargo bench -p lab -- paper`; the page is README.md.
//!
//! | paper | here |
//! |---|---|
//! | Tables I, II, III | [`table1`], [`table2`], [`table3`], of the rows that [`primitives`] measures |
//! | Algorithms 1, 3, 4 and 5 | [`published`] |
//! | figure over numbers of vertices | [`vertices`] |
//! | figure beside DEEP | [`against_deep`], with the algorithm in [`deep`] and [`polygon`] |
//! | figure of the shortcut | [`shortcut`] |
//! | what the text says of them | [`claims`] |

pub mod against_deep;
pub mod claims;
pub mod deep;
pub mod polygon;
pub mod poses;
pub mod primitives;
pub mod published;
pub mod shortcut;
pub mod table1;
pub mod table2;
pub mod table3;
pub mod tolerances;
pub mod vertices;

use std::path::Path;
use std::time::Instant;

use crate::charts::figure::{Axis, Unit};
use crate::measuring::csv;
use crate::measuring::libraries::Libraries;
use crate::measuring::measure::{Row, Runner};
use crate::measuring::methods::{Method, Start, select};
use crate::pages::between_marks;
use poses::{Mesh, Poses, Shape};
use tolerances::Tolerances;

/// The paper's method as published, the same without its shortcut, and EPA: libccd's, as in the paper.
pub const ALGORITHM_4_5: &str = "Algorithm 4/5";
pub const ALGORITHM_3: &str = "Algorithm 3";
/// Algorithm 4/5, but every ray makes its portal anew, as in [`INCREMENTAL`].
pub const NEW_PORTALS: &str = "Algorithm 4/5, new portals";
pub const EPA: &str = "libccd ccdGJKPenetration";

/// The paper's method in this library.
pub const INCREMENTAL: &str = "ccdPenetrationIncremental";

/// Folder of the page with its figures.
pub const OUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/paper");

/// How often the edges of an icosahedron are halved: hulls of 12, 42, 162, 642 and 2,562 vertices.
const HALVINGS: [usize; 5] = [0, 1, 2, 3, 4];

/// What all tables and figures are measured with.
pub struct Evaluation<'a> {
    pub libraries: &'a Libraries,
    /// Of every time, of which the median counts.
    pub repetitions: usize,
    pub tolerances: Tolerances,
}

impl<'a> Evaluation<'a> {
    /// Returns methods by name and start, at their tolerances.
    pub fn methods(&self, list: &[(&'static str, Start)]) -> Vec<Method<'a>> {
        let Tolerances { gao, epa, ours } = self.tolerances;
        let method = |&(name, start): &(&'static str, Start)| match name {
            ALGORITHM_4_5 | ALGORITHM_3 | NEW_PORTALS => vec![published::method(self.libraries, name, start, gao)],
            EPA => select(self.libraries, &[(name, start, epa)]),
            INCREMENTAL => select(self.libraries, &[(name, start, gao)]),
            _ => select(self.libraries, &[(name, start, ours)]),
        };
        list.iter().flat_map(method).collect()
    }

    pub fn runner(&self) -> Runner<'a> {
        crate::charts::times::runner(self.libraries, self.repetitions)
    }
}

/// Files of figures by the names of the modules that measure them.
pub struct Results {
    pub primitives: Vec<Row>,
    pub vertices: Vec<Row>,
    pub deep: Vec<Row>,
    pub shortcut: Vec<Row>,
}

/// Returns random poses of every hull against a shape, or against itself.
fn hulls(libraries: &Libraries, number: usize, against: Option<&'static Shape>) -> Vec<Poses> {
    let poses = |halvings: usize| {
        let mesh = Mesh::icosphere(halvings);
        let corners = mesh.vertices.len();
        let hull: &'static Shape = Box::leak(Box::new(Shape::Hull(mesh)));
        let name = if against.is_some() { format!("p{corners}_cap") } else { format!("p{corners}_p{corners}") };
        poses::random(libraries, &name, [hull, against.unwrap_or(hull)], number)
    };
    HALVINGS.into_iter().map(poses).collect()
}

/// Measures everything, writes the figures, the pictures and the page. `is_quick`: 500 poses a row, beside what is published.
pub fn run(out: &Path, is_quick: bool) {
    let begin = Instant::now();
    let note = |what: &str| eprintln!("{:4.0} s: {what}", begin.elapsed().as_secs_f64());
    let mut libraries = Libraries::open();
    libraries.use_placed();
    println!("{}", libraries.machine);
    let number = if is_quick { 500 } else { 10_000 };
    note("tolerances");
    let primitives = primitives::poses(&libraries, number);
    let tolerances = Tolerances::find(&libraries, &primitives);
    let evaluation = Evaluation { libraries: &libraries, repetitions: 3, tolerances };
    let write = |name: &str, rows: Vec<Row>| {
        csv::write(&out.join(name).with_extension("csv"), &libraries.machine, &rows);
    };
    note("Tables I to III");
    write("primitives", primitives::measure(&evaluation, &primitives));
    note("poses of hulls");
    let with_capsule = hulls(&libraries, number, Some(&Shape::Capsule));
    note("figure over numbers of vertices");
    write("vertices", vertices::measure(&evaluation, &with_capsule));
    note("figure of the shortcut");
    write("shortcut", shortcut::measure(&evaluation, &with_capsule));
    drop(with_capsule);
    note("poses of two hulls");
    let hulls = hulls(&libraries, number, None);
    note("figure beside DEEP");
    write("deep", against_deep::measure(&evaluation, &hulls));
    redraw(out);
    note("done");
}

/// Draws the pictures and writes the page from the figures that are there.
pub fn redraw(out: &Path) {
    let read = |name: &str| csv::read::<Row>(&out.join(name).with_extension("csv"));
    let (machine, primitives) = read("primitives");
    let [vertices, deep, shortcut] = ["vertices", "deep", "shortcut"].map(|name| read(name).1);
    let results = Results { primitives, vertices, deep, shortcut };
    let notes = [format!("thick: this library; {}", crate::charts::short(&machine))];
    vertices::draw(&out.join("vertices.svg"), &results.vertices, &notes);
    against_deep::draw(&out.join("deep.svg"), &results.deep, &notes);
    shortcut::draw(&out.join("shortcut.svg"), &results.shortcut, &notes);
    let committed = Path::new(OUT).join("README.md");
    let mut text = std::fs::read_to_string(&committed).expect("the paper's page");
    for (name, table) in [
        ("MACHINE", machine),
        ("CLAIMS", claims::table(&results)),
        ("TOLERANCES", tolerances::sentence(&results.primitives)),
        ("TABLE 1", table1::table(&results.primitives)),
        ("TABLE 2", table2::table(&results.primitives)),
        ("TABLE 3", table3::table(&results.primitives)),
    ] {
        text = between_marks(&text, &format!("table {name}"), &format!("{table}\n"));
    }
    let path = out.join("README.md");
    std::fs::write(&path, text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// Returns the row of a method from a start on a set.
pub fn find<'a>(rows: &'a [Row], set: &str, method: &str, start: Start) -> &'a Row {
    let is_wanted = |row: &&Row| (&*row.set, &*row.method, row.start) == (set, method, start);
    rows.iter().find(is_wanted).unwrap_or_else(|| panic!("{set}, {method}: not measured"))
}

/// Returns a number with three digits.
pub fn number(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        v if v < 1e-3 => format!("{v:.0e}"),
        v => format!("{v:.*}", (2 - v.log10().floor() as i32).clamp(0, 3) as usize),
    }
}

/// The number of vertices of a hull, by the name of its set.
pub const VERTICES: Axis = Axis {
    title: "vertices",
    unit: Unit::Plain,
    value: |row| row.set.strip_prefix('p')?.split('_').next()?.parse().ok(),
    least: 0.0,
};
