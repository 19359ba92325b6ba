#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job: one unmodified C program over a recorded contact sequence, first
# on the system's libccd where there is one, then on this library; then the same
# pairs through this library's extension, cold and warm. Sets itself up.

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh main
cargo build --release --lib

release=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)
work=$release/main-job
recording=c-tests/record/contacts.bin
mkdir -p "$work"
# LD_LIBRARY_PATH needs the file under the name that programs ask for.
ln -sf "$release/libccd.so" "$work/libccd.so.2"

compile() {
    cc -std=c99 -O2 -Iinclude -Ic-tests -DOURS_ALONE "c-tests/record/$1.c" -o "$work/$1" \
        "$work/libccd.so.2" -lm
}

# The libccd.so.2 that the dynamic linker gives the program.
libccd_of() {
    ldd "$1" | sed -n 's|.*libccd\.so\.2 => \(/[^ ]*\).*|\1|p'
}

run_on_ours() {
    export LD_LIBRARY_PATH="$work"
    if [ "$(libccd_of "$1")" != "$work/libccd.so.2" ]; then
        echo "main.sh: $1 does not run on this library" >&2
        exit 1
    fi
    "$1" "$recording"
    unset LD_LIBRARY_PATH
}

# A missing function would show at the start.
export LD_BIND_NOW=1
unset LD_LIBRARY_PATH
compile replay
compile warm
system=$(libccd_of "$work/replay")
# This library, where it is installed before libccd, is nothing to compare with.
if [ -n "$system" ] && grep -q ccdImplementation "$system"; then
    printf '\n== %s is this library, installed: no libccd to compare with\n' "$system"
elif [ -n "$system" ]; then
    printf '\n== The system'"'"'s libccd, %s\n\n' "$system"
    "$work/replay" "$recording"
else
    printf '\n== No libccd on this system: this library alone\n'
fi
printf '\n== This library under the same program\n\n'
run_on_ours "$work/replay"
printf '\n== The extension, without and with the state of the pair from the frame before\n\n'
run_on_ours "$work/warm"
