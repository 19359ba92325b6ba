// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A moving scene through FCL's broad phase, by FCL's narrow phase on either library and by
//! `<ccd/fcl.hpp>`: time, support points, and what is wrong with the answers.

// Each driver uses a part.
#![allow(dead_code)]

use crate::checks::cpp;
use crate::harness::{Executable, Program, fields};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// One way to collide the scene.
pub struct Way {
    name: &'static str,
    library: &'static str,
    contacts: &'static str,
    judged: Executable,
    /// The same without the judge, where times are asked for.
    timed: Option<Executable>,
}

/// What one way answered.
pub struct Scene {
    name: &'static str,
    frames: usize,
    /// Milliseconds a frame, the least of several runs.
    milliseconds: f64,
    judged: BTreeMap<String, f64>,
    watched: BTreeMap<String, f64>,
}

fn program() -> Program {
    cpp("fcl_scene").library("fcl").without_tools()
}

/// FCL on libccd, FCL on this library, the header with one contact a pair and with several.
pub fn ways(timed: bool) -> [Way; 4] {
    let bound = |p: Program| p.build().quiet();
    let header = || program().flag("-DBY_HEADER").flag("-DOURS_ALONE");
    let watched = bound(program().link_ours_renamed_and_system());
    let judged = watched.compared(&["--every", "1", "--no-times"]);
    let header_judged = bound(header().link_ours_shared());
    let swapped = judged.with_option("--swap");
    let [timed, header_timed] = match timed {
        false => [None, None],
        true => [
            Some(bound(program().flag("-DTIMED").link_system())),
            Some(bound(header().flag("-DTIMED").link_ours_shared())),
        ],
    };
    let swapped = (swapped, timed.as_ref().map(Executable::swapped));
    let way = |name, library, contacts, (judged, timed)| Way {
        name,
        library,
        contacts,
        judged,
        timed,
    };
    let by_header = (header_judged, header_timed);
    let ours = "library warmccd ";
    [
        way(
            "`fcl::collide` on libccd",
            "library libccd",
            "0",
            (judged, timed),
        ),
        way("`fcl::collide` on this library", ours, "0", swapped),
        way(
            "`ccd/fcl.hpp`, one contact a pair",
            ours,
            "1",
            by_header.clone(),
        ),
        way("`ccd/fcl.hpp`, up to 8 contacts", ours, "8", by_header),
    ]
}

impl Way {
    /// The lines after the first, which names the library that the process runs on.
    fn lines(&self, program: &Executable, args: &[&str]) -> Vec<String> {
        let said = program.run(args).stdout;
        let mut lines = said.lines().map(String::from);
        let name = lines.next().unwrap_or_default();
        assert!(
            name.starts_with(self.library),
            "{}: runs on `{name}`, not on `{}`",
            self.name,
            self.library
        );
        lines.collect()
    }
}

/// Every way over the same frames; one pair in `exact` is judged by exact truth too. Timed
/// `times` times, in turn.
pub fn scenes(frames: usize, bodies: usize, exact: usize, times: usize) -> Vec<Scene> {
    let ways = ways(times > 0);
    let numbers = [frames, bodies, exact].map(|n| n.to_string());
    let mut scenes: Vec<Scene> = ways
        .iter()
        .map(|way| {
            let args = [&*numbers[0], &numbers[1], way.contacts, &numbers[2]];
            let lines = way.lines(&way.judged, &args);
            Scene {
                name: way.name,
                frames,
                milliseconds: f64::INFINITY,
                judged: fields(&lines, "judged"),
                watched: fields(&lines, "watched"),
            }
        })
        .collect();
    for _ in 0..times {
        for (way, scene) in ways.iter().zip(&mut scenes) {
            let Some(program) = &way.timed else { continue };
            let args = [&*numbers[0], &numbers[1], way.contacts, "0"];
            let timed = fields(&way.lines(program, &args), "timed");
            let a_frame = 1e-6 * timed["nanoseconds"] / frames as f64;
            scene.milliseconds = scene.milliseconds.min(a_frame);
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
        wrong
            .map(|(key, n)| format!("{}: {n} {key}", self.name))
            .collect()
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
    let mut out = String::from(
        "| narrow phase | pairs a frame | hits | contacts | time a frame, ms (ratio) | put to the library | supports a pair put \
         | missed | spurious | depths beyond the promise | largest error of a depth, mm | by FCL's closed forms: missed, beyond, largest error, mm |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for s in scenes {
        let j = |key: &str| s.judged[key];
        let own = if j("pairs") > s.watched["queries"] {
            format!(
                "{}, {}, {:.3}",
                j("own_missed"),
                j("own_off"),
                1e3 * j("own_error")
            )
        } else {
            "–".to_owned()
        };
        let _ = writeln!(
            out,
            "| {} | {:.0} | {} | {} | {:.3} ({:.2}) | {} | {:.2} | {} | {} | {} | {:.3} | {own} |",
            s.name,
            j("pairs") / s.frames as f64,
            j("hits"),
            j("contacts"),
            s.milliseconds,
            s.milliseconds / scenes[0].milliseconds,
            s.watched["queries"],
            supports_a_query(s),
            j("missed"),
            j("spurious"),
            j("off"),
            1e3 * j("error"),
        );
    }
    out
}
