// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Prints the swap table, Debian's FCL, ODE, MuJoCo and DART on libccd and on this
//! library, as markdown; progress goes to stderr.
//!
//! `cargo run --example swap` the static queries of the test run, on more poses (a minute)
//! `cargo run --example swap -- world` ODE worlds collided by this library alone (3 minutes)
//! `cargo run --example swap -- scene` a scene through FCL's broad phase (half a minute)
//! `cargo run --example swap -- distance` FCL's signed distance with libwarmccd-fcl.so (half a minute)
//! `cargo run --example swap -- screens` compare.sh's screen of a program of each consumer's (a minute)
//! `cargo run --release --example swap -- steps` a step of whole programs on both libraries (2 minutes)
//! `cargo run --example swap -- long` whole simulations, longer and nastier (3 minutes)

#[path = "../harness/mod.rs"]
mod harness;

#[path = "checks.rs"]
mod checks;

#[path = "fcl_scene.rs"]
mod fcl_scene;

#[path = "fcl_distance.rs"]
mod fcl_distance;

use checks::{Piles, Swapped, piles};

fn table() {
    eprintln!("FCL and ODE: static queries");
    let fcl = checks::fcl_static().run("2 60");
    let ode = |callbacks: &str| checks::ode_static().run(&format!("2 200 {callbacks}"));
    let rows = [
        checks::judge_collide("FCL collide", &fcl),
        checks::judge_collide("ODE collide", &ode("asis")),
        checks::judge_collide("ODE collide, its cylinder corrected", &ode("corrected")),
    ];
    let (distances, differ, threw, wrong) = checks::judge_distances(&fcl);
    for line in &wrong {
        eprintln!("{line}");
    }
    println!("Static queries, on libccd, on this library:\n");
    for row in rows {
        println!("{row:?}\n");
    }
    println!("FCL's signed distance: {distances} queries, {differ} differ; FCL threw in {threw:?}");
}

fn long() {
    let ode = checks::ode_pile();
    let (mujoco, dart) = (checks::mujoco_pile(), checks::dart_pile());
    let towers = "towers of boxes and hulls";
    let rows: [(&Swapped, &'static str, usize, usize, &str); 10] = [
        (&ode, "pile", 8, 5000, "32 pile"),
        (&ode, "convex hulls", 8, 5000, "32 hulls"),
        (&ode, towers, 8, 10_000, "20 stack"),
        (&ode, "a tower that touches", 1, 3000, "6 tower"),
        (&ode, "rolling cylinders", 8, 5000, "12 roll"),
        (&mujoco, "pile", 8, 3000, "30 pile"),
        (&mujoco, "pile, several contacts a pair", 2, 5000, "30 multi"),
        (&mujoco, "on a height field", 8, 3000, "20 field"),
        (&dart, "over FCL", 8, 3000, "15 fcl"),
        (&dart, "over ODE", 8, 3000, "15 ode"),
    ];
    let row = |(program, scene, starts, steps, after)| piles(program, scene, starts, steps, after);
    let rows: Vec<Piles> = rows.into_iter().map(row).collect();
    println!("{}", checks::pile_table(&rows));
}

/// Prints the screens, and writes the first into this folder's page.
fn screens() {
    let screens = checks::screens();
    println!("{}", screens.join("\n\n"));
    let first = format!("\n```text\n{}\n```\n", screens[0]);
    harness::write_between_marks("c-tests/engines/README.md", "screens", &first);
}

/// Prints the processor time of a step on both libraries, which take turns, and writes it into the
/// front page.
fn steps() {
    let table = checks::step_table(5);
    let table = format!("{table}\n{}.\n", harness::machine());
    println!("{table}");
    harness::write_between_marks("README.md", "steps", &table);
}

fn world() {
    let rows = [("stack", 20), ("hulls", 32), ("roll", 12)].map(|(scene, bodies)| {
        let steps = if scene == "stack" { 10_000 } else { 3000 };
        let row = checks::worlds(checks::ode_pile(), scene, 10, steps, bodies);
        for line in &row.against {
            eprintln!("{scene}: {line}");
        }
        row
    });
    println!("{}", checks::pile_table(&rows));
}

fn scene() {
    let scenes = fcl_scene::scenes(300, 200, 100, 7);
    for line in scenes.iter().flat_map(fcl_scene::Scene::against) {
        eprintln!("{line}");
    }
    println!("{}", fcl_scene::table(&scenes));
    println!("{}", fcl_scene::header_table(&fcl_scene::header_costs(7)));
}

fn main() {
    eprintln!("On {}", harness::machine());
    match std::env::args().nth(1).as_deref() {
        None => table(),
        Some("long") => long(),
        Some("distance") => println!("{}", fcl_distance::table(&fcl_distance::distances(10_000))),
        Some("scene") => scene(),
        Some("screens") => screens(),
        Some("steps") => steps(),
        Some("world") => world(),
        Some(other) => {
            eprintln!("unknown: {other}; nothing, `distance`, `scene`, `screens`, `steps`, `world` or `long`");
            std::process::exit(2);
        }
    }
}
