#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# The tests under a tool that watches memory, undefined behaviour or threads.
#   check.sh address  [ARGUMENT...]   gcc's AddressSanitizer, LeakSanitizer and UBSan in the C programs
#   check.sh memcheck [ARGUMENT...]   valgrind, which sees the library's own code too
#   check.sh helgrind [ARGUMENT...]   valgrind's check for data races, likewise
#   check.sh miri     [ARGUMENT...]   Miri through the exported functions; needs
#                                     rustup component add --toolchain nightly miri rust-src
# The arguments are cargo test's: which tests to run, and --features single.

set -eu
cd "$(dirname "$0")/../.."

tool=${1:-}
[ $# -eq 0 ] || shift

case $tool in
address)
    # clang's runtime is another package, and another library.
    export CC=gcc CXX=g++
    # All of a program's undefined behaviour ends it: without that UBSan only writes.
    export C_TESTS_FLAGS="-O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
    exec cargo test --no-fail-fast "$@"
    ;;
memcheck)
    export C_TESTS_RUNNER="valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite,indirect"
    exec cargo test --no-fail-fast "$@"
    ;;
helgrind)
    export C_TESTS_RUNNER="valgrind --tool=helgrind --quiet --error-exitcode=99"
    exec cargo test --no-fail-fast "$@"
    ;;
miri)
    exec cargo +nightly miri test --test api "$@"
    ;;
*)
    echo "usage: check.sh address|memcheck|helgrind|miri [cargo test's arguments]" >&2
    exit 2
    ;;
esac
