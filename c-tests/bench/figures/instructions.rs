// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the time goes: instructions of a query, counted by callgrind on this very program, in the
//! callbacks and outside them: a table, beside libccd's.

use clap::Args;
use serde::{Deserialize, Serialize};

use super::{Bench, results};
use crate::measuring::callgrind;
use crate::measuring::libraries::Libraries;
use crate::measuring::methods::{self, Ask, Method, Start};
use crate::measuring::scene::Scene;

/// The page's: a cheap support function and a dear one, and their motions.
const ON_THE_PAGE: [&str; 4] = ["box_box", "p642_p642", "box_box_trajS", "p642_cap_trajS"];

#[derive(Args, Clone)]
pub struct Options {
    /// Poses of a pair set.
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Every call over a pair set of c-tests/bench/pairs, in place of the page's.
    #[arg(long)]
    set: Option<String>,
    /// Set in the process that callgrind watches.
    #[arg(long, hide = true)]
    watched: bool,
}

fn scenes(libraries: &Libraries, options: &Options) -> Vec<Scene> {
    let sets = match &options.set {
        Some(set) => &[&**set][..],
        None => &ON_THE_PAGE,
    };
    let load = |set: &&str| Scene::load(libraries, set, options.poses);
    sets.iter().map(load).collect()
}

/// The methods over a scene, in their order; the same in both processes.
fn asked<'a>(libraries: &'a Libraries, scene: &Scene, of_the_page: bool) -> Vec<Method<'a>> {
    use Ask::{Gjk, Intersect, IntersectWarm, Local, Minimum, Mpr, MprWarm};
    use Ask::{SystemEpa, SystemIntersect, SystemMpr};
    use Start::{Five, Warm};
    let cold = |ask| (ask, Start::None);
    let (shown, more) = match scene.motion > 0 {
        true => (vec![(Local, Warm), (Minimum, Warm)], vec![(MprWarm, Warm), (IntersectWarm, Warm)]),
        false => {
            let [mpr, epa] = [SystemMpr, SystemEpa].map(cold);
            (
                vec![mpr, epa, cold(Mpr), (Local, Five), cold(Minimum)],
                [SystemIntersect, Gjk, Intersect].map(cold).to_vec(),
            )
        }
    };
    let more = more.into_iter().filter(|_| !of_the_page);
    let of = |(ask, start)| methods::of(libraries, ask, start, 1e-6);
    shown.into_iter().chain(more).map(of).collect()
}

/// Instructions per query.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Split {
    pub set: String,
    pub method: String,
    pub callbacks: f64,
    pub solver: f64,
}

/// Of every method over every scene; why not, where callgrind does not count.
fn counted(libraries: &Libraries, options: &Options) -> Result<Vec<Split>, String> {
    let mut words = vec!["instructions".to_owned(), "--watched".to_owned()];
    words.push(format!("--poses={}", options.poses));
    words.extend(options.set.iter().map(|set| format!("--set={set}")));
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let mut counts = callgrind::counts(&words)?.into_iter();
    let mut all = Vec::new();
    for scene in scenes(libraries, options) {
        for method in asked(libraries, &scene, options.set.is_none()) {
            let count = counts.next().expect("a count for every method");
            assert!(count.callbacks > 0, "callgrind saw no {}", method.name);
            let each = |n: u64| n as f64 / scene.pairs.len() as f64;
            all.push(Split {
                set: scene.name.clone(),
                method: super::name_of(&method),
                callbacks: each(count.callbacks),
                solver: each(count.solver),
            });
        }
    }
    assert!(counts.next().is_none(), "more counts than methods");
    Ok(all)
}

/// The table; or, in the process that callgrind watches, every method between a begin and an end.
pub fn run(options: &Options) {
    let libraries = Libraries::open();
    if !options.watched {
        println!("{}\n", libraries.machine());
        match counted(&libraries, options) {
            Ok(rows) => println!("{}", results::instructions(&rows)),
            Err(why) => println!("instructions not counted: {why}"),
        }
        return;
    }
    for scene in scenes(&libraries, options) {
        for method in &mut asked(&libraries, &scene, options.set.is_none()) {
            callgrind::watched(&libraries, &scene, method);
        }
    }
}

pub fn measure(bench: &Bench) -> Vec<Split> {
    let options = Options { poses: if bench.quick { 25 } else { 100 }, set: None, watched: false };
    counted(bench.libraries, &options).unwrap_or_else(|why| {
        let last = why.lines().last().unwrap_or("");
        println!("instructions not counted: {last}");
        Vec::new()
    })
}
