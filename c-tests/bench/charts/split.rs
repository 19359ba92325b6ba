// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the time goes: instructions of a query inside the callbacks and outside
//! them, counted by callgrind on this very program.

use clap::Args;
use plotters::style::RGBColor;

use super::figure::{self, Bar};
use super::{Bench, Page};
use crate::lab::callgrind;
use crate::lab::csv::table;
use crate::lab::libraries::Libraries;
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::scene::Scene;
use crate::progress;

/// A cheap support function and a dear one, and their motions.
const SETS: [&str; 4] = ["box_box", "p642_p642", "box_box_trajS", "p642_cap_trajS"];
const POSES: usize = 100;

/// What callgrind watches.
#[derive(Args)]
pub struct Watched {
    /// The first set alone.
    #[arg(long)]
    quick: bool,
}

fn sets(quick: bool) -> &'static [&'static str] {
    if quick { &SETS[..1] } else { &SETS }
}

/// The methods over a set; the same in both processes.
fn asked<'a>(libraries: &'a Libraries, scene: &Scene) -> Vec<Method<'a>> {
    let local = |start| methods::extension(libraries, Ask::Local, start, 1e-6);
    let minimum = |start| methods::extension(libraries, Ask::Minimum, start, 1e-6);
    if scene.motion > 0 {
        return vec![local(Start::Warm), minimum(Start::Warm)];
    }
    vec![
        methods::mpr(libraries, &libraries.system, 1e-6),
        methods::libccd_epa(libraries, 1e-6),
        methods::mpr(libraries, &libraries.ours, 1e-6),
        local(Start::Five),
        minimum(Start::None),
    ]
}

pub fn watched(options: &Watched) {
    let libraries = Libraries::open();
    for set in sets(options.quick) {
        let scene = Scene::load(&libraries, set, POSES);
        for method in &mut asked(&libraries, &scene) {
            callgrind::watched(&libraries, &scene, method);
        }
    }
}

table! {
    /// Instructions per query.
    #[derive(Clone, Debug)]
    pub struct Split {
        pub set: String,
        pub method: String,
        pub callbacks: f64,
        pub solver: f64,
    }
}

pub fn measure(bench: &Bench) -> Vec<Split> {
    let bar = progress::bar(1, "where the time goes");
    let quick: &[&str] = if bench.quick { &["--quick"] } else { &[] };
    let counts = callgrind::counts(&[&["watched"], quick].concat());
    bar.finish_and_clear();
    let mut counts = match counts {
        Ok(counts) => counts.into_iter(),
        Err(why) => {
            println!(
                "instructions not counted: {}",
                why.lines().last().unwrap_or("")
            );
            return Vec::new();
        }
    };
    let mut all = Vec::new();
    for set in sets(bench.quick) {
        let scene = Scene::load(bench.libraries, set, POSES);
        for method in asked(bench.libraries, &scene) {
            let count = counts.next().expect("a count for every method");
            assert!(count.callbacks > 0, "callgrind saw no {}", method.name);
            let each = |n: u64| n as f64 / scene.pairs.len() as f64;
            all.push(Split {
                set: (*set).to_owned(),
                method: super::name_of(&method),
                callbacks: each(count.callbacks),
                solver: each(count.solver()),
            });
        }
    }
    all
}

pub fn draw(page: &Page, all: &[Split]) {
    let mut groups: Vec<(String, Vec<Bar>)> = Vec::new();
    for s in all {
        let kind = super::kind(&s.set);
        let still = !s.method.ends_with("warm");
        let title = format!("{kind}{}", if still { "" } else { ", moving" });
        if groups.last().is_none_or(|(last, _)| *last != title) {
            groups.push((title, Vec::new()));
        }
        if let Some((_, bars)) = groups.last_mut() {
            bars.push(Bar {
                label: s.method.clone(),
                parts: vec![s.callbacks, s.solver],
            });
        }
    }
    figure::bars(
        &page.file("instructions.svg"),
        "Instructions of a query",
        &[
            ("in the support functions", RGBColor(148, 163, 184)),
            ("in the solver", RGBColor(37, 99, 235)),
        ],
        &groups,
        &["each group to a scale of its own".to_owned(), page.footer()],
    );
}
