#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Searches for a pair of shapes whose answer is wrong, with clang's libFuzzer on libccd.a: fuzz.c says what the bytes of an
# input are. The corpus starts with the configurations of the stability tests, and is kept in target/c-tests/fuzz.
#   fuzz.sh [SECONDS]   600 by default; fails at the first wrong answer, and prints it and the file that repeats it
#   fuzz.sh FILE        repeats one input

set -eu
cd "$(dirname "$0")/../../.."
work=${CARGO_TARGET_DIR:-target}/c-tests/fuzz
mkdir -p "$work/corpus" "$work/configurations"
command -v clang >/dev/null && echo 'int LLVMFuzzerTestOneInput(void) { return 0; }' |
    clang -x c -fsanitize=fuzzer - -o "$work/tried" 2>/dev/null || apt-get install -y clang libclang-rt-dev >&2
# The crate itself counts which of its branches an input takes, as clang's -fsanitize=fuzzer-no-link makes C do.
cargo rustc --release --lib --crate-type staticlib --target-dir "$work/target" -- -Cpasses=sancov-module \
    -Cllvm-args=-sanitizer-coverage-level=4 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
    -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares >&2
library=$work/target/release/libccd.a
flags="-O1 -g -Iinclude -Ic-tests -DOURS_ALONE"
# shellcheck disable=SC2086  # one word each
{
    clang $flags -DCORPUS -fsanitize=fuzzer-no-link c-tests/lab/fuzz/fuzz.c -lm -o "$work/fuzz_corpus"
    clang $flags -fsanitize=fuzzer,undefined -fno-sanitize-recover=undefined c-tests/lab/fuzz/fuzz.c "$library" -lm -o "$work/fuzz"
}
"$work/fuzz_corpus" "$work/configurations"
if [ -f "${1:-}" ]; then
    exec "$work/fuzz" "$1"
fi
"$work/fuzz" -max_total_time="${1:-600}" -max_len=2048 -timeout=20 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix="$work/" "$work/corpus" "$work/configurations"
