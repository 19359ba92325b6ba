// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Instructions of a query by phase, beside libccd's and Bullet's.

use clap::Args;
use comfy_table::{Table, presets::ASCII_MARKDOWN};

use crate::lab::callgrind;
use crate::lab::libraries::Libraries;
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::scene::{Pair, Scene};
use crate::peers;

/// What the rows are about: a pair set, moved this far apart if it is.
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

#[derive(Args)]
pub struct Options {
    /// Poses of a pair set.
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Only scenes whose name holds this.
    #[arg(long, default_value = "")]
    scene: String,
    /// What callgrind watches.
    #[arg(long, hide = true)]
    watched: bool,
}

struct Part {
    name: &'static str,
    scene: Scene,
}

fn parts(libraries: &Libraries, options: &Options) -> Vec<Part> {
    let wanted = SCENES.iter().filter(|s| s.0.contains(&options.scene));
    wanted
        .map(|&(name, set, gap)| {
            let mut scene = Scene::load(libraries, set, options.poses);
            if let Some(gap) = gap {
                scene.part(libraries, gap);
            }
            Part { name, scene }
        })
        .collect()
}

/// The methods of a part, in the order of the table; the same in both processes.
fn asked<'a>(libraries: &'a Libraries, part: &Part) -> Vec<Method<'a>> {
    let tolerance = 1e-6;
    let (ours, system) = (&libraries.ours, &libraries.system);
    let mut all = vec![methods::mpr(libraries, ours, tolerance)];
    if part.scene.motion > 0 {
        let warm = |ask| methods::extension(libraries, ask, Start::Warm, tolerance);
        all.push(warm(Ask::Mpr));
        all.push(warm(Ask::Minimum));
        all.push(methods::intersect(libraries, ours, tolerance));
        all.push(methods::intersect_warm(libraries, tolerance));
        all.push(methods::mpr(libraries, system, tolerance));
        return all;
    }
    let minimum = methods::extension(libraries, Ask::Minimum, Start::None, tolerance);
    all.push(methods::gjk(libraries, ours, tolerance));
    all.push(minimum);
    all.push(methods::intersect(libraries, ours, tolerance));
    all.push(methods::mpr(libraries, system, tolerance));
    all.push(methods::libccd_epa(libraries, tolerance));
    all.push(methods::intersect(libraries, system, tolerance));
    all
}

/// The part's methods and, where it is here, Bullet.
fn everyone<'a>(
    libraries: &'a Libraries,
    part: &Part,
    bullet: &mut Option<Method<'a>>,
    mut each: impl FnMut(&mut Method<'a>),
) {
    asked(libraries, part).iter_mut().for_each(&mut each);
    if part.scene.motion == 0 {
        bullet.iter_mut().for_each(each);
    }
}

/// The watched process: every method over every part, between a begin and an end.
fn watched(libraries: &Libraries, options: &Options) {
    let mut bullet = peers::bullet(libraries).ok();
    for part in parts(libraries, options) {
        everyone(libraries, &part, &mut bullet, |method| {
            callgrind::watched(libraries, &part.scene, method);
        });
    }
}

pub fn run(options: &Options) {
    let libraries = Libraries::open();
    if options.watched {
        return watched(&libraries, options);
    }
    println!("{}\n", libraries.machine());
    let mut bullet = match peers::bullet(&libraries) {
        Ok(bullet) => Some(bullet),
        Err(why) => {
            println!(
                "not measured here: Bullet: {}",
                why.lines().next().unwrap_or("")
            );
            None
        }
    };
    let poses = options.poses.to_string();
    let of = ["--poses", &poses, "--scene", &options.scene];
    let mut counts = match callgrind::counts(&[&["phases", "--watched"], &of[..]].concat()) {
        Ok(counts) => counts.into_iter(),
        Err(why) => {
            println!("instructions not counted: {why}");
            return;
        }
    };
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN);
    table.set_header([
        "pairs",
        "query",
        "supports",
        "instructions",
        "search",
        "proof",
        "patch",
        "rest",
        "callbacks",
    ]);
    for part in parts(&libraries, options) {
        let queries = part.scene.pairs.len() as f64;
        everyone(&libraries, &part, &mut bullet, |method| {
            let count = counts.next().expect("a count for every method");
            assert!(count.callbacks > 0, "callgrind saw no {}", method.name);
            // SAFETY: shapes of the scene.
            let calls = |p: &Pair| unsafe { (libraries.callbacks.calls)(p.a) };
            let before: std::ffi::c_ulong = part.scene.pairs.iter().map(calls).sum();
            for pair in &part.scene.pairs {
                method.query(&part.scene, pair);
            }
            let after: std::ffi::c_ulong = part.scene.pairs.iter().map(calls).sum();
            let each = |n: u64| format!("{:.0}", n as f64 / queries);
            // Others' phases are not told apart.
            let phase = |n: u64| {
                if method.ours { each(n) } else { String::new() }
            };
            table.add_row([
                part.name.to_owned(),
                super::name_of(method),
                format!("{:.1}", (after - before) as f64 / queries),
                each(count.solver()),
                phase(count.search),
                phase(count.proof),
                phase(count.patch),
                phase(count.rest),
                each(count.callbacks),
            ]);
        });
    }
    assert!(counts.next().is_none(), "more counts than methods");
    println!(
        "Instructions a query, without callbacks but in the last column; the solver's by phase.\n\n{table}"
    );
}
