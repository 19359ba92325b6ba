// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! python-fcl's wheel on the libccd that it carries, and with this library preloaded.

use crate::harness::{self, Precision, fields, output_dir, root, run_command};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// The interpreter of an environment with python-fcl in it; an error where pip cannot make one.
fn python() -> Result<PathBuf, String> {
    let dir = output_dir().join("wheel");
    let python = dir.join("bin/python");
    let try_to = |command: &mut Command| {
        let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        output.status.success().then_some(()).ok_or(said)
    };
    if try_to(Command::new(&python).args(["-c", "import fcl"])).is_err() {
        try_to(Command::new("python3").args(["-m", "venv"]).arg(&dir))?;
        let mut pip = Command::new(&python);
        pip.args(["-m", "pip", "install", "--only-binary=:all:", "python-fcl"]);
        try_to(&mut pip)?;
    }
    Ok(python)
}

/// On the wheel's own library and on this one, the depths of `pairs` pairs of upright cylinders;
/// an error where the wheel cannot be installed.
pub fn wheels(pairs: u32) -> Result<[BTreeMap<String, f64>; 2], String> {
    let python = python()?;
    Ok([("libccd", false), ("warmccd ", true)].map(|(name, preload)| {
        let mut command = Command::new(&python);
        command.arg(root().join("c-tests/engines/wheel.py"));
        command.arg(pairs.to_string());
        if preload {
            let library = harness::library(Precision::Double).dir.join("libccd.so");
            harness::preload(&mut command, &library);
        }
        let (status, written) = run_command(&mut command, Duration::from_secs(60));
        assert!(status.success(), "{}", written.stderr);
        assert!(written.stdout.starts_with(&format!("library {name}")), "on {}", written.stdout);
        fields(&written.stdout, "wheel")
    }))
}
