// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Instructions of a query in the solver and in the callbacks, counted by callgrind on this program itself.

use std::process::Command;

use super::libraries::Libraries;
use super::methods::Method;
use super::scene::Scene;

/// Instructions of one method over one scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    pub solver: u64,
    pub callbacks: u64,
    /// Of this program itself.
    pub program: u64,
}

/// Sums the self cost in a callgrind file written without name compression.
fn parse(text: &str, program: &str) -> Count {
    let mut count = Count::default();
    let (mut object, mut is_callee) = ("", false);
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("ob=") {
            object = name;
        } else if line.starts_with("calls=") {
            // The next line repeats the cost of the callee.
            is_callee = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let cost = line.split_whitespace().nth(1);
            let cost = cost.and_then(|c| c.parse::<u64>().ok()).unwrap_or(0);
            match object {
                _ if std::mem::take(&mut is_callee) => (),
                _ if object == program => count.program += cost,
                _ if object.ends_with("callbacks.so") => count.callbacks += cost,
                _ => count.solver += cost,
            }
        }
    }
    count
}

/// Runs the method once over every n-th pair of the scene, for callgrind to count.
pub fn count(libraries: &Libraries, scene: &Scene, method: &mut Method, every: usize) {
    // SAFETY: does nothing.
    unsafe { (libraries.callbacks.begin)() };
    for pair in scene.pairs.iter().step_by(every) {
        std::hint::black_box((method.query)(pair));
    }
    // SAFETY: does nothing.
    unsafe { (libraries.callbacks.end)() };
}

/// Runs this program under callgrind with the words of a command and `--counting`. Returns the counts in their order.
pub fn counts(command: &[&str]) -> Result<Vec<Count>, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let mut plain = Command::new(&program);
    let dumps = ["--zero-before=bench_begin", "--dump-after=bench_end"];
    let (_, texts) = crate::harness::callgrind(plain.args(command).arg("--counting"), &dumps)?;
    let program = program.display().to_string();
    // The first is the end of the program.
    Ok(texts.iter().skip(1).map(|text| parse(text, &program)).collect())
}

#[cfg(test)]
mod tests {
    #[test]
    fn callgrind_self_cost() {
        let text = "ob=/t/callbacks.so\nfl=/t/shapes.h\nfn=f\n1 10\nob=/l/libccd.so\nfl=/w/a.rs\nfn=g\n1 5\n\
            fi=/rustc/b.rs\n2 7\ncob=/t/callbacks.so\ncfn=f\ncalls=2 1\n3 15\n6 2\n\
            ob=/bin/charts\nfl=/w/c-tests/bench.rs\nfn=run\n1 77\nob=/l/libccd.so\n8 1000\n";
        let expected = super::Count { solver: 1014, callbacks: 10, program: 77 };
        assert_eq!(super::parse(text, "/bin/charts"), expected);
    }
}
