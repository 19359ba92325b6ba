// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Prints the swap tables, Debian's FCL, ODE, MuJoCo and DART on libccd and on this
//! library, as Markdown; progress goes to stderr. Exits with 1 if what is judged fails.
//!
//! `cargo run --release -p lab --bin engines` the single queries of the test, in more poses (a minute)
//! `cargo run --release -p lab --bin engines -- fcl` what FCL's collide costs, by use (3 minutes)
//! `cargo run --release -p lab --bin engines -- distance` FCL's signed distance with libwarmccd-fcl.so (half a minute)
//! `cargo run --release -p lab --bin engines -- screens` compare.sh's screen of a program of each consumer's (a minute)
//! `cargo run --release -p lab --bin engines -- steps` a step of whole programs on both libraries (2 minutes)
//! `cargo run --release -p lab --bin engines -- long` whole simulations, longer and harder (3 minutes)
//! `cargo run --release -p lab --bin engines -- price` the price on the front page and the engines', of the pages' tables, as `fcl` and `steps` too

#[path = "mod.rs"]
mod engines;
#[path = "../../harness/mod.rs"]
mod harness;
#[path = "../pages.rs"]
mod pages;

use engines::consumers::{self, CONSUMERS};
use engines::price;
use engines::programs::{compared, fcl_distance, program, run_all};
use engines::results;
use engines::tables::{self, Simulation, simulate};
use pages::write_between_marks;

/// Prints a table and the failures of its rows. Returns whether there is none.
fn print_judged(table: &str, failures: &[String]) -> bool {
    println!("{table}\n{}", failures.join("\n"));
    failures.is_empty()
}

fn single_queries() -> bool {
    let rows = [
        ("FCL collide", run_all(&compared(program("fcl_static.cpp"), "1"), "2 60")),
        ("ODE collide", run_all(&compared(program("ode_static.c"), "1"), "2 200")),
    ];
    // All are printed, also after one that fails.
    let judged = rows.map(|(title, outputs)| {
        print_judged(&tables::collide_table(title, &outputs), &results::collide_failures(&outputs))
    });
    judged == [true; 2]
}

/// Prints whole simulations and writes them into the page of the engines.
fn long() -> bool {
    let [ode, mujoco, dart] =
        ["ode_pile.c", "mujoco_pile.c", "dart_pile.cpp"].map(|file| compared(program(file), "10"));
    let rows = [
        simulate("ODE, pile", &ode, 8, 5000, "32 pile"),
        simulate("ODE, convex hulls", &ode, 8, 5000, "32 hulls"),
        simulate("ODE, towers of boxes and hulls", &ode, 8, 10_000, "20 stack"),
        simulate("ODE, a tower that touches", &ode, 1, 3000, "6 tower"),
        simulate("ODE, rolling cylinders", &ode, 8, 5000, "12 roll"),
        simulate("MuJoCo, pile", &mujoco, 8, 3000, "30"),
        simulate("DART over FCL, pile", &dart, 8, 3000, "15"),
    ];
    let table = tables::simulation_table(&rows);
    write_between_marks("c-tests/engines/README.md", "simulations", &format!("\n{table}\n"));
    let failures = |row: &Simulation| {
        let (scene, ours) = (row.scene, &row.runs[1]);
        let failures = match scene {
            _ if scene.contains("tower") => results::pile_failures(ours, 1.0, 5e-3),
            _ if scene.starts_with("ODE") => results::pile_failures(ours, f64::INFINITY, f64::INFINITY),
            _ => results::answer_failures(ours),
        };
        failures.into_iter().map(move |text| format!("{scene}: {text}"))
    };
    print_judged(&table, &rows.iter().flat_map(failures).collect::<Vec<_>>())
}

/// Prints the screens, and writes the first into the page of the engines.
fn screens() {
    let screens = CONSUMERS.map(|(_, file, arguments, _)| consumers::screen(file, &arguments.replace("START", "1")));
    println!("{}", screens.join("\n\n"));
    let first = format!("\n```text\n{}\n```\n", screens[0]);
    write_between_marks("c-tests/engines/README.md", "screens", &first);
}

/// Prints the processor time of a step on both libraries, which take turns, and writes it into the
/// front page.
fn steps() {
    let table = format!("{}\n\n{}.\n", tables::step_table(3, 8), harness::machine());
    println!("{table}");
    write_between_marks("include/README.md", "steps", &table);
    price::write();
}

/// Prints what FCL costs by use, and writes it into the page of the engines.
fn fcl() {
    let costs = tables::fcl_costs(9);
    let table = format!("\n{}\n\n{}.\n", tables::fcl_table(&costs), harness::machine());
    println!("{table}");
    write_between_marks("c-tests/engines/README.md", "fcl", &table);
    price::write();
}

fn main() {
    eprintln!("On {}", harness::machine());
    let mut passes = true;
    match std::env::args().nth(1).as_deref() {
        None => passes = single_queries(),
        Some("long") => passes = long(),
        Some("distance") => println!("{}", tables::distance_table(&fcl_distance().map(|m| m.run("10000")))),
        Some("fcl") => fcl(),
        Some("screens") => screens(),
        Some("steps") => steps(),
        Some("price") => price::write(),
        Some(other) => {
            eprintln!("unknown: {other}; nothing, `distance`, `fcl`, `screens`, `steps`, `price` or `long`");
            std::process::exit(2);
        }
    }
    if !passes {
        std::process::exit(1);
    }
}
