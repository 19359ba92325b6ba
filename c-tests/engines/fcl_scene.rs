// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A moving scene through FCL's broad phase, by FCL's narrow phase on either library and by
//! `<ccd/fcl.hpp>`: time, support points, and what is wrong with the answers.

// Each driver uses a part.
#![allow(dead_code)]

use crate::checks::{Way, cpp, head};
use crate::harness::{self, Executable, fields};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Answers of one way to collide the scene.
#[derive(Clone)]
pub struct Scene {
    name: &'static str,
    frames: usize,
    /// Milliseconds a frame, the least of several runs.
    milliseconds: f64,
    judged: BTreeMap<String, f64>,
    watched: BTreeMap<String, f64>,
}

/// The scene through the header.
fn by_header(timed: bool) -> Executable {
    let program = cpp("fcl_scene").library("fcl").without_tools();
    let program = program.flag("-DBY_HEADER").flag("-DOURS_ALONE");
    let program = if timed { program.flag("-DTIMED") } else { program };
    program.link_ours_shared().build().quiet()
}

/// FCL on libccd, FCL on this library, the header with one contact a pair and with several;
/// judged, or timed without the judge.
fn ways(timed: bool) -> [Way; 4] {
    let program = || cpp("fcl_scene").library("fcl").without_tools();
    let program = || match timed {
        true => program().flag("-DTIMED"),
        false => program(),
    };
    let (theirs, ours) = if timed {
        let theirs = program().link_system().build().quiet();
        (theirs.clone(), theirs.swapped())
    } else {
        let both = program().link_ours_renamed_and_system().build().quiet();
        let theirs = both.compared(&["--every", "1", "--no-times"]);
        (theirs.clone(), theirs.with_options(&["--swap"]))
    };
    let header = by_header(timed);
    let by_header = |name| Way::new(name, "ours", header.clone());
    [
        Way::new("`fcl::collide` on libccd", "theirs", theirs).with("0"),
        Way::new("`fcl::collide` on this library", "ours", ours).with("0"),
        by_header("`ccd/fcl.hpp`, one contact a pair").with("1"),
        by_header("`ccd/fcl.hpp`, up to 8 contacts").with("8"),
    ]
}

/// Every way over the same frames; one pair in `exact` is judged by exact truth too. Timed
/// `times` times, in turn.
pub fn scenes(frames: usize, bodies: usize, exact: usize, times: usize) -> Vec<Scene> {
    let args = format!("{frames} {bodies} {exact}");
    let judge = |way: Way| {
        let said = way.said(&args);
        Scene {
            name: way.name,
            frames,
            milliseconds: f64::INFINITY,
            judged: fields(&said, "judged"),
            watched: fields(&said, "watched"),
        }
    };
    let mut scenes = ways(false).map(judge).to_vec();
    let timed = if times > 0 { Vec::from(ways(true)) } else { Vec::new() };
    for _ in 0..times {
        for (way, scene) in timed.iter().zip(&mut scenes) {
            let nanoseconds = fields(&way.said(&args), "timed")["nanoseconds"];
            scene.milliseconds = scene.milliseconds.min(1e-6 * nanoseconds / frames as f64);
        }
    }
    scenes
}

impl Scene {
    /// What this library answered otherwise than promised; FCL's own closed forms are not
    /// its answers.
    pub fn against(&self) -> Vec<String> {
        let wrong = ["missed", "spurious", "off"].map(|key| (key, self.judged[key]));
        let wrong = wrong.into_iter().filter(|(_, n)| *n != 0.0);
        wrong.map(|(key, n)| format!("{}: {n} {key}", self.name)).collect()
    }

    pub fn judged(&self, key: &str) -> f64 {
        self.judged[key]
    }
}

/// The program's own count, or compare.sh's of the library that FCL went on with.
fn supports_a_query(scene: &Scene) -> f64 {
    let of = |key: &str| scene.watched.get(key);
    let side = match scene.name.contains("libccd") {
        true => "theirs_supports",
        false => "ours_supports",
    };
    let queries = of("judged").unwrap_or(&scene.watched["queries"]);
    of(side).unwrap_or_else(|| &scene.watched["supports"]) / queries
}

/// Markdown; the times are told beside the first row's.
pub fn table(scenes: &[Scene]) -> String {
    let keys = "hits contacts missed spurious off own_missed own_off";
    let keys: Vec<&str> = keys.split(' ').collect();
    let first = ["narrow phase", "time a frame, ms", "ratio", "put to the library", "supports a pair put"];
    let last = ["largest error, mm", "of FCL's closed forms"];
    let mut out = head(&[&first[..], &keys, &last].concat());
    for s in scenes {
        let mut cells = vec![
            s.name.to_owned(),
            format!("{:.3}", s.milliseconds),
            format!("{:.2}", s.milliseconds / scenes[0].milliseconds),
            s.watched["queries"].to_string(),
            format!("{:.2}", supports_a_query(s)),
        ];
        cells.extend(keys.iter().map(|key| s.judged[*key].to_string()));
        cells.extend(["error", "own_error"].map(|key| format!("{:.3}", 1e3 * s.judged[key])));
        let _ = writeln!(out, "| {} |", cells.join(" | "));
    }
    out
}

/// Cost of the header itself in a scene.
pub struct HeaderCost {
    scene: &'static str,
    /// Of `fcl::collide` on libccd, with one contact a pair.
    time_ratio: f64,
    /// Instructions of a call of the header.
    instructions: f64,
    /// What is spent outside the library's calls, and so outside the solver and the callbacks.
    pub share: f64,
}

/// The cost of the header in scenes of 200 bodies, with one contact a pair; timed `times` times,
/// in turn with FCL on libccd.
pub fn header_costs(times: usize) -> Vec<HeaderCost> {
    let header = by_header(true);
    let plain = cpp("fcl_scene").library("fcl").without_tools();
    let plain = plain.flag("-DTIMED").link_system().build().quiet();
    let cost = |scene| {
        let arguments = |frames| [frames, "200", "1", "1", scene];
        let mut least = [f64::INFINITY; 2];
        for _ in 0..times {
            for (least, program) in least.iter_mut().zip([&plain, &header]) {
                let said = program.run(arguments("100")).stdout;
                *least = least.min(fields(&said, "timed")["nanoseconds"]);
            }
        }
        let (calls, all, library) = instructions_of(&header, &arguments("60"));
        HeaderCost { scene, time_ratio: least[1] / least[0], instructions: all / calls, share: 1.0 - library / all }
    };
    ["mixed", "round", "hulls"].map(cost).into()
}

/// Counts the calls of the header's callback for FCL's manager, their instructions, and those that the
/// library's calls take among them, by callgrind.
fn instructions_of(program: &Executable, arguments: &[&str]) -> (f64, f64, f64) {
    let mut plain = program.command();
    let toggle = "--toggle-collect=*ccd_fcl::CollisionFunction*";
    let counted = harness::callgrind(plain.args(arguments), &[toggle]);
    let (said, counts) = counted.unwrap_or_else(|why| panic!("{why}"));
    let text = counts.concat();
    let (mut all, mut library) = (0.0, 0.0);
    let (mut object, mut callee, mut is_call) = ("", "", false);
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("ob=") {
            object = name;
        } else if let Some(name) = line.strip_prefix("cob=") {
            callee = name;
        } else if line.starts_with("calls=") {
            is_call = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let cost = line.split(' ').nth(1).and_then(|n| n.parse().ok());
            let cost: f64 = cost.unwrap_or(0.0);
            // The callbacks call nothing of the library's. What a call costs is counted where it is
            // spent, too.
            if !is_call {
                all += cost;
            } else if callee.contains("libccd") && !object.contains("libccd") {
                library += cost;
            }
            (callee, is_call) = ("", false);
        }
    }
    (fields(&said.stdout, "timed")["pairs"], all, library)
}

/// Markdown.
pub fn header_table(costs: &[HeaderCost]) -> String {
    let mut out = head(&["scene", "time ratio", "instructions a pair", "of them the header"]);
    for c in costs {
        let share = 100.0 * c.share;
        let _ = writeln!(out, "| {} | {:.2} | {:.0} | {share:.1} % |", c.scene, c.time_ratio, c.instructions);
    }
    out
}
