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
trap 'rm -f "$log" "$log.code" "$log.address"' EXIT
step=0
passed=0
failed=0
skipped=0

# sum KIND: sums the counts of the last step's "test result" lines
sum() {
    awk -v kind="$1" '/^test result: / {
        for (i = 2; i <= NF; i++) if ($i ~ "^" kind) n += $(i - 1)
    } END { print n + 0 }' "$log"
}

# run TITLE COMMAND...: runs one step. A failure does not stop the others.
run() {
    step=$((step + 1))
    printf '\n== step %s of 3, %s s after the start: %s\n\n' "$step" "$(($(date +%s) - start))" "$1"
    shift
    {
        code=0
        "$@" || code=$?
        echo "$code" >"$log.code"
    } | tee "$log"
    wrong=$(sum failed)
    # A test that does not compile, or crashes, is not counted.
    [ "$(cat "$log.code")" -eq 0 ] || [ "$wrong" -gt 0 ] || wrong=1
    passed=$((passed + $(sum passed)))
    failed=$((failed + wrong))
    skipped=$((skipped + $(sum ignored)))
}

# Without incremental builds and code units compilation takes a third less time.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_CODEGEN_UNITS=1

start=$(date +%s)
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

printf '\n%s passed, %s failed, %s skipped\n' "$passed" "$failed" "$skipped"
[ "$failed" -eq 0 ]
