#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs before a release what is too long for every commit, hours in all, and prints one table. One failure does not
# stop the others; exit code 0: nothing failed.
#   release.sh LOGS          all; LOGS is the folder of their output
#   release.sh LOGS STEP...  only these steps, by their names in the table
# The steps named after Debian, a processor or a platform need root and the network: cmake/packages/chroot.sh says more.

set -eu
[ $# -ge 1 ] || { sed -n 's/^#   \(release.sh.*\)/usage: \1/p' "$0" >&2; exit 2; }
mkdir -p "$1"
logs=$(cd "$1" && pwd)
shift
wanted=" $* "
wanted_steps=$#
cd "$(dirname "$0")/../.."

table=$logs/table.md
printf '| step | seconds | tests | result |\n|---|---|---|---|\n' >"$table"
failed=0
ran=0

# step NAME COMMAND...: runs one step and adds its row
step() {
    name=$1
    shift
    case $wanted in "  " | *" $name "*) ran=$((ran + 1)) ;; *) return 0 ;; esac
    echo "== $name: $*" >&2
    start=$(date +%s)
    result=passed
    "$@" >"$logs/$name.log" 2>&1 || {
        result="failed: $logs/$name.log"
        failed=1
    }
    tests=$(awk '/^test result: / { for (i = 2; i <= NF; i++) if ($i ~ /^(passed|failed)/) n += $(i - 1) } END { print n }' "$logs/$name.log")
    echo "| $name | $(($(date +%s) - start)) | $tests | $result |" | tee -a "$table" >&2
}
campaign() {
    cargo run --release -p lab --bin campaigns -- "$@"
}
packages() {
    sh "cmake/packages/$1.sh" "$2"
}
prebuilt() {
    sh cmake/packages/prebuilt.sh "$1" "$logs/$1" && sh cmake/packages/try-linux.sh "$1" "$logs/$1"/*.tar.gz &&
        sh cmake/packages/try-wheel.sh "$1" "$logs/$1"/*.whl
}

sh c-tests/setup.sh lab
step charts cargo test --no-fail-fast -p lab charts_test::
step paper cargo test --no-fail-fast -p lab paper_test::
step compare cargo test --no-fail-fast -p lab compare::
step fcl cargo test -p lab fcl::
step fcl-single cargo test -p lab --features single fcl::
step fcl-address sh c-tests/tools/check.sh address -p lab --test lab fcl::
step fcl-tests sh c-tests/lab/fcl_tests.sh
step libccd-tests sh c-tests/lab/libccd_tests.sh
step price cargo test -p lab price::
step reasons sh c-tests/lab/reasons.sh
step ode-demos sh c-tests/lab/ode_demos.sh
step fuzz sh c-tests/lab/fuzz/fuzz.sh
step miri cargo test -p lab miri::
step simulations cargo test --no-fail-fast -p lab simulations::
step long cargo run --release -p lab --bin engines -- long
step packaging cargo test --no-fail-fast -p lab packaging::
step packaging-single cargo test --no-fail-fast -p lab --features single packaging::
# What test.sh leaves out in single precision: the extension, installing, the documentation's programs.
step single cargo test --no-fail-fast --features single
step commands sh c-tests/lab/commands.sh
step figures sh c-tests/lab/commands.sh figures
step rates campaign rates
step wide campaign wide
step states campaign states
step touches campaign touches
step positions campaign positions
step jumps campaign jumps
step truth campaign truth
step bookworm packages tests bookworm
step trixie packages tests trixie
step prebuilt-bookworm prebuilt bookworm
step prebuilt-trixie prebuilt trixie
step arm64 packages cross arm64
step i386 packages cross i386
step platforms sh cmake/packages/platforms.sh
step cargo-c sh cmake/packages/cargo-c.sh
step newcomer-bookworm packages newcomer bookworm
step newcomer-trixie packages newcomer trixie

[ "$wanted_steps" -eq 0 ] || [ "$ran" -eq "$wanted_steps" ] || { echo "release.sh: not all are names of steps:$wanted" >&2; failed=2; }
echo
cat "$table"
exit "$failed"
