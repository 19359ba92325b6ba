// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Where the time goes: instructions of a query inside the callbacks and outside
//! them, counted by callgrind on this very program, run again with one method.

use std::process::Command;

use clap::Args;
use plotters::style::RGBColor;
use serde::{Deserialize, Serialize};

use super::figure::{self, Bar};
use super::{Bench, Page};
use crate::lab::libraries::Libraries;
use crate::lab::methods::{self, Ask, Method, Start};
use crate::lab::progress;
use crate::lab::scene::Scene;

/// A cheap support function and a dear one, and their motions.
const SETS: [&str; 4] = ["box_box", "p642_p642", "box_box_trajS", "p642_cap_trajS"];
const POSES: usize = 100;

/// One method over one set, once: what callgrind watches.
#[derive(Args)]
pub struct Once {
    set: String,
    method: usize,
}

/// Methods by number, and the function each spends its time in.
fn method<'a>(libraries: &'a Libraries, number: usize) -> Option<(&'static str, Method<'a>)> {
    let local = |start| methods::extension(libraries, Ask::Local, start, 1e-6);
    let minimum = |start| methods::extension(libraries, Ask::Minimum, start, 1e-6);
    Some(match number {
        0 => (
            "ccdMPRPenetration",
            methods::mpr(libraries, &libraries.system, 1e-6),
        ),
        1 => ("ccdGJKPenetration", methods::libccd_epa(libraries, 1e-6)),
        2 => (
            "ccdMPRPenetration",
            methods::mpr(libraries, &libraries.ours, 1e-6),
        ),
        3 => ("ccdPenetrationLocal", local(Start::Five)),
        4 => ("ccdPenetrationLocal", local(Start::Warm)),
        5 => ("ccdPenetrationMinimum", minimum(Start::None)),
        6 => ("ccdPenetrationMinimum", minimum(Start::Warm)),
        _ => return None,
    })
}

pub fn once(options: &Once) {
    let libraries = Libraries::open();
    let scene = Scene::load(&libraries, &options.set, POSES);
    let (_, mut method) = method(&libraries, options.method).expect("a method's number");
    for pair in &scene.pairs {
        std::hint::black_box(method.query(&scene, pair));
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

/// Self cost by object of a callgrind file written without name compression:
/// what is spent in the callbacks' shared object, and elsewhere.
fn parse(text: &str) -> (u64, u64) {
    let (mut callbacks, mut solver) = (0, 0);
    let (mut inside, mut called) = (false, false);
    for line in text.lines() {
        if let Some(object) = line.strip_prefix("ob=") {
            inside = object.ends_with("callbacks.so");
        } else if line.starts_with("calls=") {
            // The next line is the callee's cost, counted where it is spent.
            called = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit() || c == '+' || c == '-' || c == '*')
        {
            let cost = line
                .split_whitespace()
                .nth(1)
                .and_then(|c| c.parse::<u64>().ok());
            if !std::mem::take(&mut called) {
                *(if inside { &mut callbacks } else { &mut solver }) += cost.unwrap_or(0);
            }
        }
    }
    (callbacks, solver)
}

fn count(set: &str, number: usize, function: &str, queries: usize) -> Result<(f64, f64), String> {
    let work = tempfile::tempdir().map_err(|e| e.to_string())?;
    let out = work.path().join("out");
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let run = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            "--compress-strings=no",
            "--compress-pos=no",
        ])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(format!("--toggle-collect={function}"))
        .arg(program)
        .args(["once", set, &number.to_string()])
        .output()
        .map_err(|e| format!("valgrind: {e}"))?;
    if !run.status.success() {
        return Err(String::from_utf8_lossy(&run.stderr).into_owned());
    }
    let text = std::fs::read_to_string(&out).map_err(|e| e.to_string())?;
    let (callbacks, solver) = parse(&text);
    if callbacks == 0 {
        return Err(format!("callgrind saw no {function}"));
    }
    Ok((
        callbacks as f64 / queries as f64,
        solver as f64 / queries as f64,
    ))
}

pub fn measure(bench: &Bench) -> Vec<Split> {
    let sets: &[&str] = if bench.quick { &SETS[..1] } else { &SETS };
    let bar = progress::bar(4 * sets.len() as u64, "where the time goes");
    let mut all = Vec::new();
    for set in sets {
        let scene = Scene::load(bench.libraries, set, POSES);
        for number in 0.. {
            let Some((function, method)) = method(bench.libraries, number) else {
                break;
            };
            if method.is_warm() != (scene.motion > 0) {
                continue;
            }
            match count(set, number, function, scene.pairs.len()) {
                Ok((callbacks, solver)) => all.push(Split {
                    set: (*set).to_owned(),
                    method: super::name_of(&method),
                    callbacks,
                    solver,
                }),
                Err(why) => {
                    bar.finish_and_clear();
                    println!(
                        "instructions not counted: {}",
                        why.lines().last().unwrap_or("")
                    );
                    return all;
                }
            }
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
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

#[cfg(test)]
mod tests {
    #[test]
    fn callgrind_self_cost_by_object() {
        let text = "ob=/tmp/x/callbacks.so\nfn=f\n1 10\n2 5\nob=/lib/libccd.so.2\nfn=g\n3 7\ncob=/tmp/x/callbacks.so\ncfn=f\ncalls=2 1\n3 15\n4 1\n";
        assert_eq!(super::parse(text), (15, 8));
    }
}
