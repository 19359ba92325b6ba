#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Prints what four programs do on libccd and on this library, a minute: Debian's DART, MuJoCo and ODE, unmodified. Each run
# has 60 s. Fails where one of libccd's faults is gone, or here.
#   reasons.sh           ODE's source is fetched by `apt-get source`
#   ODE_SOURCE=DIR reasons.sh   it is there, ODE 0.16

set -eu
cd "$(dirname "$0")/../.."
mkdir -p target/c-tests/reasons
work=$(cd target/c-tests/reasons && pwd)

# shellcheck source=c-tests/lab/debian_source.sh
. c-tests/lab/debian_source.sh
sh c-tests/setup.sh lab >&2
cargo build --release --lib >&2
mkdir -p "$work/ours"
ln -sf "$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)/libccd.so" "$work/ours/libccd.so.2"
ode_demos "$work" convex
"${CC:-cc}" -O1 c-tests/lab/engines/ode_rows.c -lode -lccd -lm -o "$work/ode_rows"
"${CC:-cc}" -O1 -w -Ic-tests c-tests/lab/engines/mujoco_slide.c -lmujoco -lm -o "$work/mujoco_slide"
"${CXX:-c++}" -O1 -w -Ic-tests -I/usr/include/eigen3 c-tests/lab/engines/dart_sixteen.cpp -ldart -lfcl -lccd -o "$work/dart_sixteen"

# What the keys drop: v a hull, y a cylinder, c a capsule, b a box.
export DEMO_STEPS=1500 DEMO_KEYS=vyvcyvxbyvcyvcyvcyvcyvcyvcyvcyvccyy

# said LIBRARIES PROGRAM ARGUMENT...: runs it on the libccd.so.2 of a folder, and prints how it ended and its last line
said() {
    libraries=$1 program=$2
    shift 2
    code=0
    LD_LIBRARY_PATH=$libraries timeout -k 5 60 "$work/$program" "$@" >"$work/output" 2>&1 || code=$?
    last=$(sed -n 's/^slide drops \([0-9]*\) slid \([0-9]*\) fell \([0-9]*\).*/\2 of \1 slide away, \3 fall off/p; /^deepest/p' "$work/output" |
        tail -n 1)
    case $code in
    0) echo "${last:-ends}" ;;
    124 | 137) echo "no end in 60 s; before, $last" ;;
    *) echo "exit code $code: $(sed -n 's/.*\(assertion .*\)/\1/p' "$work/output" | tail -n 1)" ;;
    esac
}

failed=0
# reason TITLE EXPECTED_ON_LIBCCD EXPECTED_HERE PROGRAM ARGUMENT...
reason() {
    title=$1 fault=$2 right=$3
    shift 3
    on_libccd=$(said "" "$@")
    here=$(said "$work/ours" "$@")
    echo "| $title | $on_libccd | $here |"
    if ! printf '%s\n' "$on_libccd" | grep -q "$fault" || ! printf '%s\n' "$here" | grep -q "$right"; then failed=1; fi
}

echo "| program, unchanged | on libccd | here |"
echo "|---|---|---|"
reason "DART 6: 16 bodies of 0.2 m fall on a plate" "[1-9]\.[0-9]* m" "of 300 steps 0\.[01]" dart_sixteen 300
reason "MuJoCo 2, its issue 420: 40 cylinders are dropped on a table" "^39 of 40 slide" "^0 of 40 slide" mujoco_slide
reason "ODE: its own \`demo_convex\`" "exit code 134" "^ends" demo_convex
reason "ODE: cylinders in exact rows" "exit code 134" "^ends" ode_rows 500
[ $failed = 0 ] || echo "reasons.sh: not as before" >&2
exit $failed
