// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the time goes: instructions of a query, counted by callgrind on this very program, in the
//! callbacks and outside them: as a table, beside libccd's and Bullet's, and as a picture.

use clap::Args;
use comfy_table::{Table, presets::ASCII_MARKDOWN};
use plotters::style::RGBColor;
use serde::{Deserialize, Serialize};

use super::figure::{self, Bar};
use super::{Bench, Page};
use crate::lab::callgrind::{self, Count};
use crate::lab::libraries::Libraries;
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::scene::{Pair, Scene};
use crate::peers;

/// The rows of the table: a pair set, moved this far apart if it is.
const SCENES: [(&str, &str, Option<f64>); 13] = [
    ("boxes, shallow", "box_box_sh", None),
    ("boxes, deep", "box_box", None),
    ("hulls, shallow", "p162_p162_sh", None),
    ("hulls, deep", "p162_p162", None),
    ("capsules, shallow", "cap_cap_sh", None),
    ("capsules, deep", "cap_cap", None),
    ("boxes, 1 cm apart", "box_box_sh", Some(0.01)),
    ("hulls, 1 cm apart", "p162_p162_sh", Some(0.01)),
    ("capsules, 1 cm apart", "cap_cap_sh", Some(0.01)),
    ("boxes, 2 m apart", "box_box_sh", Some(2.0)),
    ("boxes in motion", "box_box_trajS", None),
    ("hulls in motion", "p162_p162_trajS", None),
    ("capsules in motion", "cap_cap_trajS", None),
];

/// The picture's: a cheap support function and a dear one, and their motions.
const CHARTED: [&str; 4] = ["box_box", "p642_p642", "box_box_trajS", "p642_cap_trajS"];

#[derive(Args, Clone)]
pub struct Options {
    /// Poses of a pair set.
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Only scenes whose name holds this.
    #[arg(long, default_value = "")]
    scene: String,
    /// The picture's, its first so many.
    #[arg(long, hide = true)]
    charted: Option<usize>,
    /// What callgrind watches.
    #[arg(long, hide = true)]
    watched: bool,
}

impl Options {
    /// What makes these options again.
    fn words(&self) -> Vec<String> {
        let mut words = vec!["instructions".to_owned(), "--watched".to_owned()];
        words.push(format!("--poses={}", self.poses));
        words.push(format!("--scene={}", self.scene));
        words.extend(self.charted.map(|n| format!("--charted={n}")));
        words
    }
}

struct Part {
    name: &'static str,
    scene: Scene,
}

fn parts(libraries: &Libraries, options: &Options) -> Vec<Part> {
    let load = |set| Scene::load(libraries, set, options.poses);
    if let Some(first) = options.charted {
        let part = |&name: &&'static str| Part {
            name,
            scene: load(name),
        };
        return CHARTED[..first].iter().map(part).collect();
    }
    let wanted = SCENES.iter().filter(|s| s.0.contains(&options.scene));
    let part = |&(name, set, gap): &(&'static str, _, Option<f64>)| {
        let mut scene = load(set);
        if let Some(gap) = gap {
            scene.part(libraries, gap);
        }
        Part { name, scene }
    };
    wanted.map(part).collect()
}

/// The methods of a part, in their order; the same in both processes.
fn asked<'a>(libraries: &'a Libraries, scene: &Scene, charted: bool) -> Vec<Method<'a>> {
    use Ask::{Gjk, Intersect, IntersectWarm, Local, Minimum, Mpr, MprWarm};
    use Ask::{SystemEpa, SystemIntersect, SystemMpr};
    use Start::{Five, Warm};
    let cold = |ask| (ask, Start::None);
    let asked = match (charted, scene.motion > 0) {
        (true, true) => vec![(Local, Warm), (Minimum, Warm)],
        (true, false) => {
            let [mpr, epa] = [SystemMpr, SystemEpa].map(cold);
            vec![mpr, epa, cold(Mpr), (Local, Five), cold(Minimum)]
        }
        (false, true) => {
            let warm = [MprWarm, Minimum, IntersectWarm].map(|ask| (ask, Warm));
            let all = [&[cold(Mpr)], &warm[..], &[cold(Intersect), cold(SystemMpr)]];
            all.concat()
        }
        (false, false) => {
            let ours = [Mpr, Gjk, Minimum, Intersect].map(cold);
            [
                &ours[..],
                &[SystemMpr, SystemEpa, SystemIntersect].map(cold),
            ]
            .concat()
        }
    };
    let of = |(ask, start)| methods::of(libraries, ask, start, 1e-6);
    let mut all: Vec<Method> = asked.into_iter().map(of).collect();
    if !charted && scene.motion == 0 {
        all.extend(peers::bullet(libraries));
    }
    all
}

/// The watched process: every method over every part, between a begin and an end.
fn watched(libraries: &Libraries, options: &Options) {
    for part in parts(libraries, options) {
        for method in &mut asked(libraries, &part.scene, options.charted.is_some()) {
            callgrind::watched(libraries, &part.scene, method);
        }
    }
}

/// Every method over every part with its count; why not, where callgrind does not count.
fn counted(
    libraries: &Libraries,
    options: &Options,
    mut each: impl FnMut(&Part, &mut Method, Count),
) -> Result<(), String> {
    let words = options.words();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let mut counts = callgrind::counts(&words)?.into_iter();
    for part in parts(libraries, options) {
        for method in &mut asked(libraries, &part.scene, options.charted.is_some()) {
            let count = counts.next().expect("a count for every method");
            assert!(count.callbacks > 0, "callgrind saw no {}", method.name);
            each(&part, method, count);
        }
    }
    assert!(counts.next().is_none(), "more counts than methods");
    Ok(())
}

/// The table.
pub fn run(options: &Options) {
    let libraries = Libraries::open();
    if options.watched {
        return watched(&libraries, options);
    }
    println!("{}\n", libraries.machine());
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN);
    let head = "pairs|query|supports|instructions|callbacks";
    table.set_header(head.split('|'));
    let counted = counted(&libraries, options, |part, method, count| {
        let queries = part.scene.pairs.len() as f64;
        // SAFETY: shapes of the scene.
        let calls = |p: &Pair| unsafe { (libraries.callbacks.calls)(p.a) };
        let all = || -> std::ffi::c_ulong { part.scene.pairs.iter().map(calls).sum() };
        let before = all();
        for pair in &part.scene.pairs {
            method.query(&part.scene, pair);
        }
        let each = |n: u64| format!("{:.0}", n as f64 / queries);
        table.add_row([
            part.name.to_owned(),
            super::name_of(method),
            format!("{:.1}", (all() - before) as f64 / queries),
            each(count.solver),
            each(count.callbacks),
        ]);
    });
    match counted {
        Ok(()) => {
            println!("Instructions a query, without callbacks but in the last column.\n\n{table}")
        }
        Err(why) => println!("instructions not counted: {why}"),
    }
}

/// Instructions per query.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Split {
    pub set: String,
    pub method: String,
    pub callbacks: f64,
    pub solver: f64,
}

pub fn measure(bench: &Bench) -> Vec<Split> {
    let options = Options {
        poses: 100,
        scene: String::new(),
        charted: Some(if bench.quick { 1 } else { CHARTED.len() }),
        watched: false,
    };
    let mut all = Vec::new();
    let counted = counted(bench.libraries, &options, |part, method, count| {
        let each = |n: u64| n as f64 / part.scene.pairs.len() as f64;
        all.push(Split {
            set: part.name.to_owned(),
            method: super::name_of(method),
            callbacks: each(count.callbacks),
            solver: each(count.solver),
        });
    });
    if let Err(why) = counted {
        let last = why.lines().last().unwrap_or("");
        println!("instructions not counted: {last}");
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
            bars.push((s.method.clone(), vec![s.callbacks, s.solver]));
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
