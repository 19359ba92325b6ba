#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the commands of the pages that neither another test runs nor a root or a network needs, in a clone of the commit,
# on a machine with libfcl-dev, and so with libccd-dev. (LD_PRELOAD allows no blank in the path.)

set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git clone -q "$repository" "$work/clone"
cd "$work/clone"

# block PAGE LANGUAGE PATTERN: prints the page's first code block in a language that contains the pattern
block() {
    awk -v language="$2" -v pattern="$3" '
        $0 == "```" language { inside = 1; text = ""; next }
        /^```$/ && inside { inside = 0; if (text ~ pattern) { printf "%s", text; exit } }
        inside { text = text $0 "\n" }' "$1"
}

# run TITLE EXPECTED: runs the commands on stdin, whose output must contain the text
run() {
    echo "== $1"
    commands=$(cat)
    [ -n "$commands" ] || { echo "commands.sh: $1: not on its page" >&2; exit 1; }
    printf '%s\n' "$commands"
    printf 'set -e\n%s\n' "$commands" | sh >output 2>&1 || { cat output >&2; exit 1; }
    grep -q -e "$2" output || { echo "commands.sh: no '$2' in:" >&2; cat output >&2; exit 1; }
}

block README.md c ccd >program.c
block README.md sh 'cargo build' | run "a program with this library" "^depth 0.100"
cc program.c -Iinclude -lccd -lm -o program
block README.md sh target/swap | run "the swap" "^depth 0.100"
sed -n 's/^ \*     \(g++ .*\)/\1/p' c-tests/examples/fcl.cpp | run "the example for FCL" "3.0 mm deep"
block cmake/README.md sh CCD_FCL | run "FCL's signed distance" "^depth 0.100"
echo 'import ctypes; print(ctypes.CDLL(None).ccdImplementation)' >app.py
block cmake/README.md sh app.py | sed 's/ python / python3 /' | run "preloading in Python" "_FuncPtr"
ln -sf target/release/libccd.so libccd.so.2
block include/README.md sh objdump | grep objdump | run "the precision of a library" "^double"
