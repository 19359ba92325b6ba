#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Downloads the engines that the benchmark compares with and that no Debian package has, into a
# folder of the build: MuJoCo and Coal as wheels, through pip; Jolt's source in the crate joltc-sys,
# through cargo. What cannot be had is left out, and the benchmark names it.
#   engines.sh FOLDER

set -u
mkdir -p "$1/mujoco" "$1/coal" "$1/jolt"
cd "$1" || exit 1

# wheels FOLDER PACKAGE...
wheels() {
    [ -e "$1/whole" ] && return
    to=$1
    shift
    python3 -m pip install --quiet --only-binary=:all: --target "$to" "$@" 2>"$to/why" && touch "$to/whole"
}
wheels mujoco --no-deps mujoco==3.12.0
wheels coal libcoal==3.0.3 cmeel-eigen

if [ ! -e jolt/whole ]; then
    printf '[workspace]\n[package]\nname = "jolt"\nversion = "0.0.0"\n[lib]\npath = "lib.rs"\n' >jolt/Cargo.toml
    printf '[dependencies]\njoltc-sys = "=0.3.1"\n' >>jolt/Cargo.toml
    touch jolt/lib.rs
    (cd jolt && cargo vendor --quiet >/dev/null 2>why) && touch jolt/whole
fi
for engine in mujoco coal jolt; do
    [ -e "$engine/whole" ] || printf '%s: not downloaded: %s\n' "$engine" "$(tail -n 1 "$engine/why" 2>/dev/null)"
done
