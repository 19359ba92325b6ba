#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs all tests of a commit after setup.sh: in double precision all, in single precision those of the library, the
# contract and stability, and C programs under sanitizers and valgrind. The last line counts the tests.
# lab/release.sh runs the others before a release.

set -eu
cd "$(dirname "$0")/.."

cat <<'END'
All tests of a commit, in 3 steps: 3 to 5 minutes on 2 cores, once packages and
crates are there; the first time some minutes more, to fetch them.
END
sh c-tests/setup.sh

log=$(mktemp)
trap 'rm -f "$log" "$log.address"' EXIT
start=$(date +%s)

# run TITLE COMMAND...: runs one step. A failure does not stop the others.
run() {
    printf '\n== %s s after the start: %s\n\n' "$(($(date +%s) - start))" "$1"
    shift
    if "$@"; then echo "this step passed"; else echo "this step failed"; fi | tee -a "$log"
}

# Without incremental builds and code units compilation takes a third less time.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_CODEGEN_UNITS=1

run "double precision" cargo test --no-fail-fast
# Runs the C programs under tools, except tests of headers and symbols, programs with their own
# malloc, and callgrind. In parallel: the sanitizers wait half a minute for one compilation.
tools() {
    skipped_tests="--skip headers_ --skip archive_defines --skip memory --skip take_no_more"
    wrong=0
    # shellcheck disable=SC2086  # one word each
    {
        sh c-tests/tools/check.sh address -- contract:: extension:: $skipped_tests >"$log.address" 2>&1 &
        sh c-tests/tools/check.sh memcheck -- contract:: $skipped_tests || wrong=1
    }
    sh c-tests/tools/check.sh helgrind contract::threads || wrong=1
    wait $! || wrong=1
    cat "$log.address"
    return "$wrong"
}
run "gcc's sanitizers; valgrind, memory and threads" tools
single() {
    wrong=0
    cargo test --no-fail-fast --features single --lib || wrong=1
    cargo test --no-fail-fast --features single --test integration -- contract:: stability:: || wrong=1
    return "$wrong"
}
# Last: the others run programs in double precision.
run "single precision: library, contract and stability" single

# A step whose tests do not compile, or crash, counts as a failed test.
awk '
    /^test result: / { for (i = 4; i < NF; i++) counts[$(i + 1)] += $i; wrong += $3 != "ok." }
    /^this step failed$/ { failed++; unseen += !wrong }
    /^this step / { wrong = 0 }
    END {
        printf "\n%d passed, %d failed, %d skipped\n", counts["passed;"], counts["failed;"] + unseen, counts["ignored;"]
        exit failed > 0
    }' "$log"
